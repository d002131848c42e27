//! The error budget: docs/error-budget.md written by `validation/error_budget/budget.py`, with the example just built.

use crate::{setup, util};
use anyhow::Result;

/// Builds the example and compares; the arguments are the script's own.
pub fn errors(arguments: &[String]) -> Result<()> {
    build_example()?;
    setup::setup()?;
    util::run(
        setup::module("validation.error_budget.budget").args(arguments),
        "validation.error_budget.budget",
    )
}

/// Builds `target/release/examples/errors`, wherever else cargo is told to build.
pub fn build_example() -> Result<()> {
    println!("build: the example errors");
    util::build_in_target(&["-p", "prob-water", "--example", "errors"])
}
