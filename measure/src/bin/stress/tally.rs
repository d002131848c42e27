//! What a block found, and the sum of all.

use crate::rows::Row;
use prob_water::Parameters;
use std::collections::BTreeMap;
use std::time::Duration;

/// Steps of the histogram of errors in an octave.
const STEPS: f64 = 8.0;

/// Violations that are printed at length.
pub const SHOWN: usize = 10;

/// Finite and not negative.
pub fn fine(x: f64) -> bool {
    x.is_finite() && x >= 0.0
}

/// A row with its bits, and the values in question.
pub fn shown(row: &Row, values: &[f64]) -> String {
    let bits = row.map(|v| v.map(|x| format!("{:016x}", x.to_bits())).join(" ")).join(" | ");
    format!("{row:?} = {bits}, values {values:?}")
}

/// Relative errors: how many of each size, and the largest with its place.
#[derive(Default, Clone)]
pub struct Errors {
    /// By the logarithm of the error, in steps; exact zeros are the smallest.
    counts: BTreeMap<i32, u64>,
    worst: f64,
    place: String,
}

impl Errors {
    /// Takes an error; its place is asked for where it is the largest so far.
    pub fn take(&mut self, error: f64, place: impl FnOnce() -> String) {
        let step = (error.max(1e-20).log2() * STEPS).floor() as i32;
        *self.counts.entry(step).or_default() += 1;
        if error > self.worst {
            self.worst = error;
            self.place = place();
        }
    }

    fn add(&mut self, other: Self) {
        for (step, count) in other.counts {
            *self.counts.entry(step).or_default() += count;
        }
        if other.worst > self.worst {
            (self.worst, self.place) = (other.worst, other.place);
        }
    }

    fn count(&self) -> u64 {
        self.counts.values().sum()
    }

    /// To a step of the histogram, from above.
    fn median(&self) -> f64 {
        let (half, mut below) = (self.count().div_ceil(2), 0);
        let reached = self.counts.iter().find(|(_, count)| {
            below += **count;
            below >= half
        });
        reached.map_or(0.0, |(step, _)| (f64::from(step + 1) / STEPS).exp2())
    }
}

/// Evaluations by kind, errors by name, violations.
#[derive(Default)]
pub struct Tally {
    block: u64,
    kinds: Vec<(&'static str, u64)>,
    errors: Vec<(&'static str, Errors)>,
    violations: Vec<String>,
    more: u64,
}

impl Tally {
    /// Of a block.
    pub fn new(block: u64) -> Self {
        Self { block, ..Self::default() }
    }

    /// Counts evaluations of a kind.
    pub fn count(&mut self, kind: &'static str, evaluations: u64) {
        match self.kinds.iter_mut().find(|(known, _)| *known == kind) {
            Some((_, sum)) => *sum += evaluations,
            None => self.kinds.push((kind, evaluations)),
        }
    }

    /// The errors of a name, to take more.
    pub fn errors(&mut self, name: &'static str) -> &mut Errors {
        let at = self.errors.iter().position(|(known, _)| *known == name).unwrap_or_else(|| {
            self.errors.push((name, Errors::default()));
            self.errors.len() - 1
        });
        &mut self.errors[at].1
    }

    /// Keeps a violation with all that repeats it. Of one block the first few will do.
    pub fn violation(&mut self, sea: &Parameters, what: &str, row: &str) {
        if self.violations.len() >= 3 {
            self.more += 1;
            return;
        }
        self.violations.push(format!("block {}: {what}\n{row}\n{}", self.block, described(sea)));
    }

    /// A violation unless a condition holds.
    pub fn check(&mut self, holds: bool, sea: &Parameters, what: &str, row: impl FnOnce() -> String) {
        if !holds {
            self.violation(sea, what, &row());
        }
    }

    /// Adds what another block found.
    pub fn add(&mut self, other: Self) {
        for (kind, count) in other.kinds {
            self.count(kind, count);
        }
        for (name, errors) in other.errors {
            self.errors(name).add(errors);
        }
        self.violations.extend(other.violations);
        self.more += other.more;
    }

    /// Of all kinds.
    pub fn evaluations(&self) -> f64 {
        self.kinds.iter().filter(|(kind, _)| !kind.starts_with('(')).map(|(_, n)| *n as f64).sum()
    }

    /// How many there were.
    pub fn violations(&self) -> u64 {
        self.violations.len() as u64 + self.more
    }

    /// The part's lines of the table, and its violations.
    pub fn print(&self, part: &str, time: Duration) {
        let seconds = time.as_secs_f64();
        let (evaluations, violations) = (self.evaluations(), self.violations());
        println!("{part:<22}{evaluations:>16}{violations:>11}{seconds:>7.1} s");
        for (kind, count) in &self.kinds {
            println!("{:<22}{count:>16}{:>22}{kind}", "", "");
        }
        for (name, errors) in &self.errors {
            let (median, worst, count) = (errors.median(), errors.worst, errors.count());
            println!("  {name}: median below {median:.1e}, worst {worst:.2e}, of {count}");
            println!("    at {}", errors.place);
        }
        for violation in self.violations.iter().take(SHOWN) {
            println!("VIOLATION ({part}) {violation}");
        }
    }
}

/// The sea as TOML, or what it was drawn as where it is refused.
fn described(sea: &Parameters) -> String {
    sea.configure().map_or_else(|error| format!("{error}: {sea:?}"), |water| water.to_string())
}
