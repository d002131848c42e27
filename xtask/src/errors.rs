//! The error budget: docs/error-budget.md written by `validation/error_budget/budget.py`, with the campaign just built.

use crate::{setup, util};
use anyhow::Result;

/// Builds the campaign and compares; the arguments are the script's own.
pub fn errors(arguments: &[String]) -> Result<()> {
    build_campaign()?;
    setup::setup()?;
    util::run(
        setup::module("validation.error_budget.budget").args(arguments),
        "validation.error_budget.budget",
    )
}

/// Builds `target/release/errors`, wherever else cargo is told to build.
pub fn build_campaign() -> Result<()> {
    println!("build: the campaign errors");
    util::build_in_target(&["-p", "prob-water-measure", "--bin", "errors"])
}
