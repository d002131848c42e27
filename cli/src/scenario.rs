//! `prob-water scenario`: statistics of the BRDF for the engagements of a file.

mod engagement;
mod file;
mod part;
pub mod settings;
mod tables;

use crate::progress::Progress;
use crate::toml_file::Document;
use crate::{Outcome, Stop, empirical_table, files, parameters, table, threads};
use clap::{Arg, ArgMatches, Command, value_parser};
use file::Scenario;
use part::{Method, Part};
use prob_water::{
    EmpiricalLobe, Engagement, Ensemble, Estimate, Exact, OffPlaneModel, Parameters, Statistics, Surface,
    Table,
};
use rayon::prelude::*;
use std::num::NonZeroU32;
use std::path::{Path, PathBuf};
use tables::{By, Tables};

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
        .arg(threads::flag())
        .arg(empirical_table::flag())
        .args(parameters::flags(Surface::Instance))
}

/// Checks the whole file, then writes a row for every engagement and observer.
pub fn run(matches: &ArgMatches) -> Outcome {
    threads::start(matches)?;
    let path = matches.get_one::<PathBuf>("input").expect("is required");
    files::apart(matches, [path.as_path()].into_iter().chain(empirical_table::given(matches)))?;
    let scenario = Scenario::read(path, &parameters::given(matches), empirical_table::given(matches))?;
    files::apart(matches, scenario.table.as_deref())?;
    let mut tables = Tables::open(matches, &scenario)?;
    let progress = Progress::new(work(&scenario)?, true);
    for part in &scenario.parts {
        let run = Run { part, limits: &scenario.limits, progress: &progress };
        tables.footprint(part.water.footprint);
        match &part.method {
            Method::Draws(ensemble) => run.draws(ensemble, &mut tables)?,
            Method::Exact(exact) => run.integrals(exact, &mut tables)?,
            Method::Auto(exact, ensemble) => run.best(exact.as_deref(), ensemble, &mut tables)?,
            Method::Table(table) => {
                run.by_table(table.as_deref().unwrap_or_else(|| Table::standard()), &mut tables)?;
            }
        }
    }
    drop(progress);
    tables.end()
}

/// Reads the text of a scenario, without working it out.
pub fn check(document: &Document, path: &Path) -> Result<(), String> {
    Scenario::of(document, path, &[], None).map(|_| ())
}

/// Steps of all parts: casts where seas are drawn, else engagements.
fn work(scenario: &Scenario) -> Result<u64, Stop> {
    let steps = |part: &Part| match &part.method {
        Method::Draws(ensemble) => ensemble.casts(&part.engagements),
        _ => Ok(part.engagements.len() as u64),
    };
    Ok(scenario.parts.iter().map(steps).sum::<Result<u64, _>>()?)
}

/// The largest errors with which integrals stand in for draws: relative of a mean, and in probability.
const SMALL_ERROR: f64 = 0.02;
const SMALL_SHARE_ERROR: f64 = 0.05;
/// Engagements worked on at a time.
const GROUP: usize = 256;

/// A part that is worked out.
struct Run<'a> {
    part: &'a Part,
    /// 1/sr.
    limits: &'a [f64],
    progress: &'a Progress,
}

impl Run<'_> {
    /// As many engagements at a time as fit into memory.
    fn draws(&self, ensemble: &Ensemble, tables: &mut Tables) -> Outcome {
        let mut rest = &self.part.engagements[..];
        while !rest.is_empty() {
            let samples = ensemble.sample(rest, &|casts| self.progress.add(casts))?;
            let (now, later) = rest.split_at(samples.engagements());
            self.progress.aside(|| tables.group(now, &samples, self.limits))?;
            rest = later;
        }
        Ok(())
    }

    fn integrals(&self, exact: &Exact, tables: &mut Tables) -> Outcome {
        for engagement in &self.part.engagements {
            let all = exact.statistics(engagement, self.limits);
            let stokes = tables.polarised().then(|| exact.stokes(engagement));
            self.progress.add(1);
            self.progress.aside(|| {
                let mut all = all.iter().enumerate();
                all.try_for_each(|(observer, s)| {
                    let stokes = stokes.as_ref().map(|stokes| stokes[observer]);
                    tables.statistics(engagement, observer, s, By::Integrals, stokes)
                })
            })?;
        }
        Ok(())
    }

    /// Integrals for the observers whom they serve, draws for the others.
    fn best(&self, exact: Option<&Exact>, ensemble: &Ensemble, tables: &mut Tables) -> Outcome {
        let serves = |s: &Statistics| s.mean_error <= SMALL_ERROR && s.share_error <= SMALL_SHARE_ERROR;
        for engagement in &self.part.engagements {
            let integrals: Vec<Option<Statistics>> = match exact {
                Some(exact) => {
                    let all = exact.statistics(engagement, self.limits);
                    all.into_iter().map(|s| Some(s).filter(serves)).collect()
                }
                None => vec![None; engagement.observers().len()],
            };
            let stokes = exact.filter(|_| tables.polarised()).map(|exact| exact.stokes(engagement));
            let others = engagement.with_observers(|observer| integrals[observer].is_none());
            let samples = match others.observers() {
                [] => None,
                _ => Some(ensemble.sample(&[others], &|_| ())?),
            };
            self.progress.add(1);
            self.progress.aside(|| -> Outcome {
                let mut drawn = 0..;
                for (observer, integrals) in integrals.iter().enumerate() {
                    match (integrals, &samples) {
                        (Some(s), _) => {
                            let stokes = stokes.as_ref().map(|stokes| stokes[observer]);
                            tables.statistics(engagement, observer, s, By::Integrals, stokes)?;
                        }
                        (None, Some(samples)) => {
                            let place = [0, drawn.next().unwrap_or_default()];
                            tables.sample(engagement, observer, samples, place, self.limits)?;
                        }
                        (None, None) => unreachable!("whom integrals do not serve has draws"),
                    }
                }
                Ok(())
            })?;
        }
        Ok(())
    }

    /// Eqs. 90-91, and draws through the table's spreads for all that they do not give.
    fn by_table(&self, table: &Table, tables: &mut Tables) -> Outcome {
        let p = &self.part.water.parameters;
        let lobe = EmpiricalLobe::new(&self.part.water, table)?;
        let slopes = (p.across == OffPlaneModel::Report)
            .then(|| Parameters { across: OffPlaneModel::Slopes, ..*p }.configure())
            .transpose()?
            .map(|water| EmpiricalLobe::new(&water, table))
            .transpose()?;
        let draws = u32::try_from(p.instances).ok().and_then(NonZeroU32::new).expect("is checked");
        let seen = |engagement: &Engagement| -> Vec<(Estimate, Statistics)> {
            let statistics = |[i, o]: [[f64; 3]; 2]| {
                let (mut found, estimate) = lobe.statistics(i, o, draws, p.seed, self.limits);
                // How far the report's Gaussian across the plane is from the slopes' density.
                if let Some(slopes) = &slopes {
                    let off = estimate.mean / slopes.estimate(i, o).mean.max(f64::MIN_POSITIVE) - 1.0;
                    found.mean_error += off.abs();
                    found.mean_upper =
                        found.mean_upper.max(slopes.estimate(i, o).mean * (1.0 + found.mean_error));
                }
                (estimate, found)
            };
            let ways: Vec<_> = engagement.ways().collect();
            ways.into_par_iter().map(statistics).collect()
        };
        for group in self.part.engagements.chunks(GROUP) {
            let all: Vec<_> = group
                .par_iter()
                .map(|engagement| {
                    let row = seen(engagement);
                    self.progress.add(1);
                    row
                })
                .collect();
            for (engagement, all) in group.iter().zip(&all) {
                for ((observer, (estimate, s)), [i, o]) in all.iter().enumerate().zip(engagement.ways()) {
                    let by = By::Table { outside: estimate.outside };
                    let stokes = tables.polarised().then(|| lobe.stokes(i, o, engagement.stokes()));
                    self.progress.aside(|| tables.statistics(engagement, observer, s, by, stokes))?;
                }
            }
        }
        Ok(())
    }
}
