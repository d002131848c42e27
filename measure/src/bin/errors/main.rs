//! What every stage of the model gives in float64 and float32 for random and extreme inputs, as lines of JSON:
//! `validation/error_budget/budget.py` compares them with the equations evaluated to 50 digits.
//!
//! `cargo run --release -p prob-water-measure --bin errors [-- ROWS]`: about so many rows a stage (2000 unless told), the same
//! in every run. A line has a `stage`, its inputs `x` and what came out, `y`, by number type; a `sea` describes the
//! parameters that later lines name by number. Numbers read back to the same bits; infinity is null.

mod lobe;
mod means;
mod scalars;
mod waves;

use rand::{Rng, SeedableRng, rngs::StdRng};
use serde_json::{Value, json};
use std::io::{BufWriter, StdoutLock, Write};

/// Degrees from the zenith that directions reach.
const GRAZING: f64 = 89.9999;

/// Random numbers, and where lines go.
struct Lines {
    rng: StdRng,
    rows: usize,
    seas: usize,
    out: BufWriter<StdoutLock<'static>>,
}

impl Lines {
    fn write(&mut self, line: &Value) {
        writeln!(self.out, "{line}").expect("standard output takes it");
    }

    /// A line of a stage.
    fn row(&mut self, stage: &str, x: Value, y: Value) {
        self.write(&json!({"stage": stage, "x": x, "y": y}));
    }

    /// Uniform.
    fn uniform(&mut self, low: f64, high: f64) -> f64 {
        self.rng.random_range(low..=high)
    }

    /// Uniform in the logarithm.
    fn decades(&mut self, low: f64, high: f64) -> f64 {
        self.uniform(low.ln(), high.ln()).exp().clamp(low, high)
    }

    /// One of some values.
    fn one<T: Copy>(&mut self, of: &[T]) -> T {
        of[self.rng.random_range(0..of.len())]
    }

    /// An angle from the zenith in radians, half of them within ten degrees of the horizon, to [`GRAZING`].
    fn zenith(&mut self) -> f64 {
        let degrees = if self.rng.random() {
            self.uniform(0.0, 90.0)
        } else {
            90.0 - self.decades(90.0 - GRAZING, 10.0)
        };
        degrees.min(GRAZING).to_radians()
    }

    /// A unit vector of two angles in radians.
    fn direction(&mut self) -> [f64; 3] {
        let ((s, c), (sp, cp)) =
            (self.zenith().sin_cos(), self.uniform(0.0, std::f64::consts::TAU).sin_cos());
        [s * cp, s * sp, c]
    }

    /// A friction velocity in cm/s: the ends, Beaufort's and any.
    fn wind(&mut self) -> f64 {
        const SOME: [f64; 10] = [0.0, 0.01, 0.5, 2.0, 8.0, 24.0, 56.0, 97.0, 223.89, 238.65];
        if self.rng.random() { self.one(&SOME) } else { self.uniform(0.0, 238.65) }
    }

    /// A footprint in m.
    fn footprint(&mut self) -> f64 {
        const SOME: [f64; 5] = [1e-3, 0.01, 0.15, 1.0, f64::INFINITY];
        if self.rng.random() { self.one(&SOME) } else { self.decades(1e-3, 100.0) }
    }
}

fn main() {
    let rows = std::env::args().nth(1).map_or(2000, |n| n.parse().expect("ROWS is a number"));
    let out = BufWriter::new(std::io::stdout().lock());
    let mut lines = Lines { rng: StdRng::seed_from_u64(1), rows, seas: 0, out };
    scalars::write(&mut lines);
    lobe::write(&mut lines);
    waves::write(&mut lines);
    means::write(&mut lines);
    scalars::absorption(&mut lines);
    lines.out.flush().expect("standard output takes it");
}
