//! The largest weight f cos/pdf of a lobe's draws, for winds from calm to the end of Table 1: the table of docs/model.md,
//! whose bounds `weights_are_bounded` holds.
//!
//! `cargo run --release -p prob-water-measure --bin weights [-- DRAWS]`: so many draws a cell (1,000,000 unless told).

use prob_water::brdf::up;
use prob_water::{Lobe, Parameters, SlopeMeasure, Wind};
use rand::{Rng, SeedableRng, rngs::StdRng};

/// Friction velocities, cm/s.
const WINDS: [f64; 12] = [0.0, 0.5, 1.31, 2.0, 4.0, 8.0, 24.0, 56.0, 97.0, 150.0, 190.0, 238.65];

fn main() {
    let draws: usize = std::env::args().nth(1).map_or(1_000_000, |n| n.parse().expect("DRAWS is a number"));
    println!(
        "| w*, cm/s | slope, Gaussian | slope, Gram-Charlier | angle, Gaussian | angle, Gram-Charlier |"
    );
    println!("| --- | --- | --- | --- | --- |");
    let mut rng = StdRng::seed_from_u64(9);
    for w in WINDS {
        print!("| {w} |");
        for slope_measure in [SlopeMeasure::Slope, SlopeMeasure::Angle] {
            for gram_charlier in [false, true] {
                let water = Parameters {
                    wind: Wind::FrictionVelocity(w),
                    ior: Some(1.33),
                    whitecaps: false,
                    slope_measure,
                    gram_charlier,
                    ..Parameters::default()
                };
                let lobe = water.configure().expect("the parameters are valid").local_lobe();
                print!(" {:.2} |", largest(&lobe, draws, &mut rng));
            }
        }
        println!();
    }
}

/// Half of the sources lie within 6 degrees of the horizon, down to 0.001 degrees.
fn largest(lobe: &Lobe<f64>, draws: usize, rng: &mut StdRng) -> f64 {
    let mut largest = 0.0f64;
    for _ in 0..draws {
        let theta: f64 = if rng.random() {
            90.0 * rng.random::<f64>()
        } else {
            90.0 - 6.0 * 10f64.powf(-4.0 * rng.random::<f64>())
        };
        let (sin, cos) = theta.to_radians().sin_cos();
        let (y, x) = (std::f64::consts::TAU * rng.random::<f64>()).sin_cos();
        let sample = lobe.sample([sin * x, sin * y, cos], up(), rng.random());
        if sample.pdf > 0.0 {
            largest = largest.max(sample.f * sample.direction[2] / sample.pdf);
        }
    }
    largest
}
