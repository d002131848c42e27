//! What a scenario writes: statistics and, where asked for, instances.

use super::file::{Method, Scenario};
use crate::table::{self, Cell, Table};
use crate::{Outcome, Stop, files};
use clap::ArgMatches;
use prob_water::ensemble::Samples;
use prob_water::{Engagement, Statistics};

const STATISTICS: [&str; 14] = [
    "time",
    "observer",
    "mean",
    "std",
    "sem",
    "min",
    "p05",
    "p50",
    "p95",
    "p99",
    "max",
    "mean_f_cos",
    "obscured",
    "whitecap",
];
const INSTANCES: [&str; 13] =
    ["time", "observer", "instance", "f", "cos_r", "obscured", "whitecap", "x", "y", "z", "nx", "ny", "nz"];
const ORIGIN: [&str; 3] = ["version", "readings", "seed"];

/// The tables in the making, and what ends every row.
pub struct Tables {
    /// `None` once whoever reads standard output has left.
    statistics: Option<Table>,
    instances: Option<Table>,
    readings: String,
    seed: u64,
}

impl Tables {
    /// Both, so that neither is found impossible after the work is done.
    pub fn open(matches: &ArgMatches, scenario: &Scenario) -> Result<Self, Stop> {
        let instances_out = matches.contains_id("instances_out");
        let without_instances = match scenario.method {
            Method::Draws(_) => None,
            Method::Exact(_) => Some("statistics = exact"),
            Method::Table(_) => Some("surface = empirical"),
        };
        if let Some(with) = without_instances.filter(|_| instances_out) {
            let message = format!("--instances-out has no meaning with {with}: there are no instances");
            return Err(Stop::Refused(message));
        }
        let [path, other] = ["output", "instances_out"].map(|flag| table::path(matches, flag));
        if instances_out && path.map(files::resolve) == other.map(files::resolve) {
            return Err(Stop::Refused("--output and --instances-out are the same".into()));
        }
        let json = matches.get_flag("json");
        let open = |path, columns: Vec<String>| {
            Table::open(path, json, columns.into_iter().chain(ORIGIN.map(String::from)))
        };
        let names = |names: &[&str]| names.iter().map(|name| (*name).to_owned()).collect::<Vec<_>>();
        let limits = scenario.limits.iter().map(|limit| format!("p_over_{limit}"));
        let outside = matches!(scenario.method, Method::Table(_)).then(|| "outside".to_owned());
        let parameters = &scenario.water.parameters;
        Ok(Self {
            statistics: Some(open(
                path,
                names(&STATISTICS).into_iter().chain(limits).chain(outside).collect(),
            )?),
            instances: instances_out.then(|| open(other, names(&INSTANCES))).transpose()?,
            readings: parameters.get("readings").map(|value| value.to_string()).unwrap_or_default(),
            seed: parameters.seed,
        })
    }

    /// The rows of some engagements.
    pub fn group(&mut self, engagements: &[Engagement], samples: &Samples, limits: &[f64]) -> Outcome {
        for (i, engagement) in engagements.iter().enumerate() {
            for observer in 0..engagement.observers().len() {
                self.statistics(engagement, observer, &samples.statistics(i, observer, limits), None)?;
                self.instances(engagement, observer, samples, i)?;
            }
        }
        Ok(())
    }

    /// What an observer sees of all instances; by a table, whether that is outside of its grid.
    pub fn statistics(
        &mut self,
        engagement: &Engagement,
        observer: usize,
        s: &Statistics,
        outside: Option<bool>,
    ) -> Outcome {
        let Some(table) = &mut self.statistics else { return Ok(()) };
        let mut row = vec![Cell::Number(engagement.time()), Cell::Count(observer as u64)];
        row.extend([s.mean, s.std, s.sem, s.min].map(Cell::Number));
        row.extend(s.quantiles.map(Cell::Number));
        row.extend([s.max, s.mean_f_cos, s.obscured, s.whitecap].map(Cell::Number));
        row.extend(s.over.iter().copied().map(Cell::Number));
        row.extend(outside.map(|outside| Cell::Count(outside.into())));
        row.extend(origin(&self.readings, self.seed));
        match table.row(&row) {
            Err(Stop::ReaderLeft) if self.instances.is_some() => self.statistics = None,
            outcome => outcome?,
        }
        Ok(())
    }

    /// What an observer sees of each.
    fn instances(
        &mut self,
        engagement: &Engagement,
        observer: usize,
        samples: &Samples,
        i: usize,
    ) -> Outcome {
        let Some(table) = &mut self.instances else { return Ok(()) };
        for (instance, hit, seen) in samples.of(i, observer) {
            let ([x, y, z], [nx, ny, nz]) = (hit.position, hit.normal);
            let mut row = vec![
                Cell::Number(engagement.time()),
                Cell::Count(observer as u64),
                Cell::Count(instance),
                Cell::Number(seen.f),
                Cell::Number(seen.cos_r),
                Cell::Count(seen.obscured.into()),
                Cell::Number(hit.whitecap),
            ];
            row.extend([x, y, z, nx, ny, nz].map(Cell::Number));
            row.extend(origin(&self.readings, self.seed));
            table.row(&row)?;
        }
        Ok(())
    }

    /// Both files appear.
    pub fn end(self) -> Outcome {
        table::end(self.statistics.into_iter().chain(self.instances))
    }
}

fn origin(readings: &str, seed: u64) -> [Cell<'_>; 3] {
    [Cell::Text(env!("CARGO_PKG_VERSION")), Cell::Text(readings), Cell::Count(seed)]
}
