//! What a scenario writes: statistics and, where asked for, instances.

use super::file::Scenario;
use super::part::Method;
use crate::table::{self, Cell, Table};
use crate::{Outcome, Stop, files};
use clap::ArgMatches;
use prob_water::brdf::polarised::degree_and_angle;
use prob_water::statistics::FEWEST_EFFECTIVE;
use prob_water::statistics::{Samples, Sighting};
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
const TRUST: [&str; 5] = ["effective", "mean_upper", "method", "mean_error", "share_error"];
/// Of what is seen of a polarised beam: from 0 to 1, and degrees from the plane of the vertical and the observer's direction.
const POLARISATION: [&str; 2] = ["degree_of_polarisation", "angle_of_polarisation"];
const INSTANCES: [&str; 14] = [
    "time", "observer", "instance", "f", "cos_r", "obscured", "whitecap", "x", "y", "z", "nx", "ny", "nz",
    "weight",
];
/// Errors of a method that a warning tells of: relative ones of means, and those in probability.
const LARGE_ERROR: f64 = 0.1;
const LARGE_SHARE_ERROR: f64 = 0.2;
const ORIGIN: [&str; 3] = ["version", "readings", "seed"];

/// The tables in the making, and what ends every row.
pub struct Tables {
    /// `None` once whoever reads standard output has left.
    statistics: Option<Table>,
    instances: Option<Table>,
    readings: String,
    seed: u64,
    /// D of the rows that come, m, where rows tell it.
    footprint: Option<f64>,
    /// A beam is polarised.
    polarised: bool,
    rows: u64,
    few: Notice,
    wrong: Notice,
    outside: Notice,
}

/// Where a row comes from.
#[derive(Clone, Copy, PartialEq)]
pub enum By {
    /// Seas drawn as the wind draws them.
    Draws,
    /// Seas drawn by importance.
    Slopes,
    /// Integrals over all seas.
    Integrals,
    /// A table of the empirical model.
    Table {
        /// The directions are beyond its angles.
        outside: bool,
    },
}

impl By {
    fn name(self) -> &'static str {
        match self {
            Self::Draws => "draws",
            Self::Slopes => "slopes",
            Self::Integrals => "exact",
            Self::Table { .. } => "table",
        }
    }
}

/// Rows that something is to be said about, and the first of them.
#[derive(Default)]
struct Notice {
    rows: u64,
    first: String,
}

impl Notice {
    fn add(&mut self, holds: bool, engagement: &Engagement, observer: usize) {
        if holds {
            if self.rows == 0 {
                self.first = format!("time {}, observer {observer}", engagement.time());
            }
            self.rows += 1;
        }
    }

    fn say(&self, all: u64, about: &str, advice: &str) {
        if self.rows > 0 {
            let Self { rows, first } = self;
            eprintln!("prob-water: warning: {rows} of {all} rows {about}, the first at {first}: {advice}");
        }
    }
}

impl Tables {
    /// Both, so that neither is found impossible after the work is done.
    pub fn open(matches: &ArgMatches, scenario: &Scenario) -> Result<Self, Stop> {
        let instances_out = matches.contains_id("instances_out");
        let without_instances = match scenario.parts[0].method {
            Method::Draws(_) => None,
            Method::Auto(..) => Some("statistics = auto"),
            Method::Exact(_) => Some("statistics = exact"),
            Method::Table(..) => Some("surface = empirical"),
        };
        if let Some(with) = without_instances.filter(|_| instances_out) {
            let message = format!("--instances-out has no meaning with {with}: not every row has instances");
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
        let outside = matches!(scenario.parts[0].method, Method::Table(..)).then(|| "outside".to_owned());
        let footprint = scenario.own_footprints.then(|| "footprint".to_owned());
        let polarisation = POLARISATION.into_iter().filter(|_| scenario.polarised).map(String::from);
        let upper = scenario.limits.iter().map(|limit| format!("p_over_{limit}_upper"));
        let parameters = &scenario.water.parameters;
        Ok(Self {
            statistics: Some(open(
                path,
                names(&STATISTICS)
                    .into_iter()
                    .chain(limits)
                    .chain(outside)
                    .chain(upper)
                    .chain(names(&TRUST))
                    .chain(footprint)
                    .chain(polarisation)
                    .collect(),
            )?),
            instances: instances_out.then(|| open(other, names(&INSTANCES))).transpose()?,
            readings: parameters.get("readings").map(|value| value.to_string()).unwrap_or_default(),
            seed: parameters.seed,
            footprint: scenario.own_footprints.then_some(scenario.water.footprint),
            polarised: scenario.polarised,
            rows: 0,
            few: Notice::default(),
            wrong: Notice::default(),
            outside: Notice::default(),
        })
    }

    /// D of the rows that come, m.
    pub fn footprint(&mut self, footprint: f64) {
        self.footprint = self.footprint.map(|_| footprint);
    }

    /// The rows of some engagements.
    pub fn group(&mut self, engagements: &[Engagement], samples: &Samples, limits: &[f64]) -> Outcome {
        for (i, engagement) in engagements.iter().enumerate() {
            for observer in 0..engagement.observers().len() {
                self.sample(engagement, observer, samples, [i, observer], limits)?;
            }
        }
        Ok(())
    }

    /// The rows of an observer who has these numbers among the samples: of an engagement and of its observers.
    pub fn sample(
        &mut self,
        engagement: &Engagement,
        observer: usize,
        samples: &Samples,
        [i, o]: [usize; 2],
        limits: &[f64],
    ) -> Outcome {
        let by = if samples.by_slopes(i, o)? { By::Slopes } else { By::Draws };
        let position = engagement.observers()[observer];
        let stokes = self.polarised.then(|| samples.stokes(i, o, engagement, position)).transpose()?;
        self.statistics(engagement, observer, &samples.statistics(i, o, limits)?, by, stokes)?;
        self.instances(engagement, observer, samples.of(i, o)?)
    }

    /// Whether the Stokes vectors of rows are asked for.
    pub fn polarised(&self) -> bool {
        self.polarised
    }

    /// What an observer sees of all instances, with the mean Stokes vector where that is asked for.
    pub fn statistics(
        &mut self,
        engagement: &Engagement,
        observer: usize,
        s: &Statistics,
        by: By,
        stokes: Option<[f64; 4]>,
    ) -> Outcome {
        self.rows += 1;
        self.few.add(s.effective < FEWEST_EFFECTIVE, engagement, observer);
        let wrong = s.mean_error > LARGE_ERROR || s.share_error > LARGE_SHARE_ERROR;
        self.wrong.add(wrong, engagement, observer);
        self.outside.add(by == By::Table { outside: true }, engagement, observer);
        let Some(table) = &mut self.statistics else { return Ok(()) };
        let mut row = vec![Cell::Number(engagement.time()), Cell::Count(observer as u64)];
        row.extend([s.mean, s.std, s.sem, s.min].map(Cell::Number));
        row.extend(s.quantiles.map(Cell::Number));
        row.extend([s.max, s.mean_f_cos, s.obscured, s.whitecap].map(Cell::Number));
        row.extend(s.over.iter().copied().map(Cell::Number));
        if let By::Table { outside } = by {
            row.push(Cell::Count(outside.into()));
        }
        row.extend(s.over_upper.iter().copied().map(Cell::Number));
        row.extend([s.effective, s.mean_upper].map(Cell::Number));
        row.push(Cell::Text(by.name()));
        row.extend([s.mean_error, s.share_error].map(Cell::Number));
        row.extend(self.footprint.map(Cell::Number));
        row.extend(stokes.into_iter().flat_map(degree_and_angle).map(Cell::Number));
        row.extend(origin(&self.readings, self.seed));
        match table.row(&row) {
            Err(Stop::ReaderLeft) if self.instances.is_some() => self.statistics = None,
            outcome => outcome?,
        }
        Ok(())
    }

    /// What an observer sees of each.
    fn instances<'a>(
        &mut self,
        engagement: &Engagement,
        observer: usize,
        all: impl Iterator<Item = Sighting<'a>>,
    ) -> Outcome {
        let Some(table) = &mut self.instances else { return Ok(()) };
        for Sighting { instance, weight, hit, seen } in all {
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
            row.extend([x, y, z, nx, ny, nz, weight].map(Cell::Number));
            row.extend(origin(&self.readings, self.seed));
            table.row(&row)?;
        }
        Ok(())
    }

    /// Both files appear.
    /// And all that is to be said about their rows.
    pub fn end(self) -> Outcome {
        table::end(self.statistics.into_iter().chain(self.instances))?;
        self.few.say(
            self.rows,
            "rest on fewer than 10 effective draws (column effective)",
            "their mean and sem are not settled, and mean_upper is all that is known; take draws = auto or more instances",
        );
        self.wrong.say(
            self.rows,
            "may be off by their method, means by more than 10 % or quantiles by more than 0.2 in probability \
             (columns mean_error, share_error)",
            "statistics = auto of surface = instance takes draws there",
        );
        self.outside.say(
            self.rows,
            "are outside of the table's grid (column outside)",
            "they are its nearest values",
        );
        Ok(())
    }
}

fn origin(readings: &str, seed: u64) -> [Cell<'_>; 3] {
    [Cell::Text(env!("CARGO_PKG_VERSION")), Cell::Text(readings), Cell::Count(seed)]
}
