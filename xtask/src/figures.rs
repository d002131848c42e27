//! The report's figures: `out/report/` filled by `validation/figures/draw.py`, with the command just built.

use crate::{setup, util};
use anyhow::Result;

/// Builds the command and draws; the arguments are the script's own.
pub fn figures(arguments: &[String]) -> Result<()> {
    build_command()?;
    setup::setup()?;
    println!("figures: into out/report/");
    util::run(
        setup::module("validation.figures.draw").args(["--out", "out/report"]).args(arguments),
        "validation.figures.draw",
    )
}

/// Builds `target/release/prob-water`, wherever else cargo is told to build.
pub fn build_command() -> Result<()> {
    println!("build: the command prob-water");
    util::build_in_target(&["-p", "prob-water-cli"])
}
