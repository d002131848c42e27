//! The throughput table: `validation/bench.py` times this plugin and, from their own environment, its peers.

use crate::{build, setup, util};
use anyhow::Result;

/// Builds the plugin, sets up the peers and measures; the arguments are the script's own.
pub fn bench(arguments: &[String]) -> Result<()> {
    build::build(&build::default_out())?;
    setup::peer()?;
    util::run(
        util::command(setup::python()).arg("validation/bench.py").args(arguments),
        "validation/bench.py",
    )
}
