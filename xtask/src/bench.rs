//! Measurements: `validation/bench.py` times this plugin and, from their own environment, its peers; the others look at one
//! question each.

use crate::{build, setup, util};
use anyhow::Result;

/// Builds the plugin, sets up what the topic needs and measures; further arguments are the script's own.
pub fn bench(arguments: &[String]) -> Result<()> {
    if let Some((topic, rest)) = arguments.split_first()
        && topic == "compare"
    {
        setup::setup()?;
        let script = "validation/bench_compare.py";
        return util::run(util::command(setup::python()).arg(script).args(rest), "bench compare");
    }
    build::build(&build::default_out())?;
    let (script, arguments) = match arguments.split_first() {
        Some((topic, rest)) if topic == "off" => ("validation/bench_off.py", rest),
        Some((topic, rest)) if topic == "surface" => ("validation/bench_surface.py", rest),
        _ => {
            setup::peer()?;
            ("validation/bench.py", arguments)
        }
    };
    util::run(util::command(setup::python()).arg(script).args(arguments), script)
}
