//! Measurements: `validation/bench/run.py` times this plugin and, from their own environment, its peers; the others look at one
//! question each.

use crate::{build, setup, util};
use anyhow::Result;

/// Builds the plugin, sets up what the topic needs and measures; further arguments are the script's own.
pub fn bench(arguments: &[String]) -> Result<()> {
    if let Some((topic, rest)) = arguments.split_first()
        && topic == "compare"
    {
        setup::setup()?;
        return util::run(setup::module("validation.bench.compare").args(rest), "bench compare");
    }
    build::build(&build::default_out())?;
    let (module, arguments) = match arguments.split_first() {
        Some((topic, rest)) if topic == "off" => ("validation.bench.off", rest),
        Some((topic, rest)) if topic == "surface" => ("validation.bench.surface", rest),
        _ => {
            setup::peer()?;
            ("validation.bench.run", arguments)
        }
    };
    util::run(setup::module(module).args(arguments), module)
}
