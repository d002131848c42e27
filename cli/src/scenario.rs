//! `prob-water scenario`: statistics of the BRDF for the engagements of a file.

mod engagement;
mod file;
pub mod settings;
mod tables;

use crate::progress::Progress;
use crate::{Outcome, parameters, table};
use clap::{Arg, ArgMatches, Command, value_parser};
use file::{Method, Scenario};
use prob_water::exact::Exact;
use prob_water::{Ensemble, Surface};
use std::path::PathBuf;
use tables::Tables;

/// The subcommand's flags.
pub fn command() -> Command {
    let file = |name: &'static str| Arg::new(name).value_parser(value_parser!(PathBuf));
    Command::new("scenario")
        .about("Statistics of the BRDF over drawn surfaces, for the engagements of a TOML file")
        .arg(file("input").value_name("FILE.toml").required(true).help(
            "the sea ([model]) and who looks at it ([[engagement]]); parameters given as flags stand above [model]",
        ))
        .args(table::flags())
        .arg(
            file("instances_out")
                .long("instances-out")
                .value_name("FILE")
                .help("write what every observer saw of every instance to FILE, whole or not at all"),
        )
        .arg(
            Arg::new("threads")
                .long("threads")
                .value_name("N")
                .value_parser(value_parser!(u16).range(1..=1024))
                .help("threads, 1 to 1024; results do not depend on it [default: one for every core]"),
        )
        .args(parameters::flags(Surface::Instance))
}

/// Checks the whole file, then writes a row for every engagement and observer.
pub fn run(matches: &ArgMatches) -> Outcome {
    if let Some(threads) = matches.get_one::<u16>("threads") {
        rayon::ThreadPoolBuilder::new()
            .num_threads(usize::from(*threads))
            .build_global()
            .map_err(|e| format!("cannot start {threads} threads: {e}"))?;
    }
    let path = matches.get_one::<PathBuf>("input").expect("is required");
    let scenario = Scenario::read(path, &parameters::given(matches))?;
    let tables = Tables::open(matches, &scenario)?;
    match &scenario.method {
        Method::Draws(ensemble) => draws(&scenario, ensemble, tables),
        Method::Exact(exact) => integrals(&scenario, exact, tables),
    }
}

/// As many engagements at a time as fit into memory.
fn draws(scenario: &Scenario, ensemble: &Ensemble, mut tables: Tables) -> Outcome {
    let casts = scenario.engagements.len() as u64 * scenario.water.parameters.instances;
    let progress = Progress::new(casts, true);
    let mut rest = &scenario.engagements[..];
    while !rest.is_empty() {
        let samples = ensemble.sample(rest, &|casts| progress.add(casts))?;
        let (now, later) = rest.split_at(samples.engagements());
        progress.aside(|| tables.group(now, &samples, &scenario.limits))?;
        rest = later;
    }
    drop(progress);
    tables.end()
}

fn integrals(scenario: &Scenario, exact: &Exact, mut tables: Tables) -> Outcome {
    let progress = Progress::new(scenario.engagements.len() as u64, true);
    for engagement in &scenario.engagements {
        let all = exact.statistics(engagement, &scenario.limits);
        progress.add(1);
        progress.aside(|| {
            all.iter().enumerate().try_for_each(|(observer, s)| tables.statistics(engagement, observer, s))
        })?;
    }
    drop(progress);
    tables.end()
}
