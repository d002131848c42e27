//! The review renders: `out/` filled by `validation/render/review.py`, with the plugin just built.

use crate::{build, setup, util};
use anyhow::Result;

/// Builds the plugin and renders; the arguments are the script's own.
pub fn render(arguments: &[String]) -> Result<()> {
    build::build(&build::default_out())?;
    println!("render: into out/");
    util::run(
        setup::module("validation.render.review").args(["--out", "out"]).args(arguments),
        "validation.render.review",
    )
}
