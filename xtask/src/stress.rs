//! The stress campaign: `measure/src/bin/stress`.

use crate::util;
use anyhow::Result;

/// Seconds of it in every test.
const SLICE: &str = "12";

/// Builds and runs it; the arguments are its own.
pub fn stress(arguments: &[String]) -> Result<()> {
    util::run(
        util::cargo()
            .args(["run", "--release", "--quiet", "-p", "prob-water-measure", "--bin", "stress", "--"])
            .args(arguments),
        "the stress campaign",
    )
}

/// As much as every test has time for, with the campaign as it was built.
pub fn slice() -> Result<()> {
    let campaign = util::root().join("target/release/stress");
    util::run(util::command(campaign).args(["--seconds", SLICE]), "the stress campaign")
}
