//! Sums of waves over places, one thread, as lines of JSON; `validation/bench/run.py` runs it.
//!
//! `cargo run --release -p prob-water-measure --bin wave_sums [-- REPEATS]`: components per second, heights, slopes and
//! accelerations of every place included, all candidates in turn, each `REPEATS` times (5 unless told).

use prob_water::simd::SimdLevel;
use prob_water::surface::Point;
use prob_water::surface::{Component, Draws, InstanceRng};
use prob_water::{Parameters, RealisedSurface, Surface, WaveSums, Wind};
use std::hint::black_box;
use std::time::Instant;

/// Places of a pass.
const PLACES: usize = 2000;

/// What is timed: its name, and a pass over all places that returns the sum of the heights.
type Candidate<'a> = (String, Box<dyn Fn() -> f64 + 'a>);

fn main() {
    let repeats: usize = std::env::args().nth(1).map_or(5, |n| n.parse().expect("REPEATS is a number"));
    for components in [32, 512] {
        let water = Parameters {
            wind: Wind::FrictionVelocity(8.0),
            surface: Surface::Instance,
            footprint: Some(0.15),
            components,
            ..Parameters::default()
        };
        let water = water.configure().expect("the parameters are valid");
        let waves: Vec<_> = water.waves().components(InstanceRng::new(Draws::Stratified, 1, 0)).collect();
        let sea = RealisedSurface::new(waves.iter().copied(), 0.0);
        let places: Vec<[f64; 2]> =
            (0..PLACES).map(|n| [0.731 * n as f64 % 97.0, 0.419 * n as f64 % 89.0]).collect();

        let lanes = WaveSums::new(&sea);
        // Another way to sum the same waves is one more line here, and `validation/bench/core.py` holds it against its
        // gate.
        let mut candidates: Vec<Candidate> = vec![
            ("libm".into(), {
                let (waves, places) = (plain(&waves), &places);
                Box::new(move || places.iter().map(|place| libm_sum(&waves, black_box(*place))[0]).sum())
            }),
            (
                "point".into(),
                Box::new(|| places.iter().map(|place| black_box(sea.point(*place)).height).sum()),
            ),
        ];

        for level in SimdLevel::ALL.into_iter().filter(|level| level.is_available()) {
            let (lanes, places) = (&lanes, &places);
            candidates.push((
                format!("lanes, {}", level.name()),
                Box::new(move || {
                    let mut points = vec![Point::default(); PLACES];
                    lanes.points_on(level, black_box(places), &mut points);
                    points.iter().map(|point| point.height).sum()
                }),
            ));
        }

        let mut seconds = vec![vec![]; candidates.len()];
        let mut sums = vec![0.0; candidates.len()];
        // The first round warms up.
        for round in 0..=repeats {
            for (n, (_, pass)) in candidates.iter().enumerate() {
                let start = Instant::now();
                sums[n] = black_box(pass());
                if round > 0 {
                    seconds[n].push(start.elapsed().as_secs_f64());
                }
            }
        }
        // Of lanes: 1e-7 of a height of some centimetres, many times.
        let scale = sums[0].abs() + 1.0;
        for (n, (name, _)) in candidates.iter().enumerate() {
            let bound = if name.starts_with("lanes") { 1e-4 } else { 1e-9 };
            assert!((sums[n] - sums[0]).abs() < bound * scale, "{name} sums other waves");
            let rates: Vec<_> =
                seconds[n].iter().map(|s| (PLACES as f64 * f64::from(components) / s).round()).collect();
            println!(r#"{{"name": "{name}", "components": {components}, "per_s": {rates:?}}}"#);
        }
    }
}

/// Wave numbers along x and y, phase, amplitude and squared frequency of every component.
fn plain(waves: &[Component]) -> Vec<[f64; 5]> {
    let one = |c: &Component| {
        let (sin, cos) = c.azimuth.sin_cos();
        [c.wave_number * cos, c.wave_number * sin, c.phase, c.amplitude, c.frequency * c.frequency]
    };
    waves.iter().map(one).collect()
}

/// Height, slopes and acceleration as one would write them first: a loop with the platform's sine and cosine.
fn libm_sum(waves: &[[f64; 5]], [x, y]: [f64; 2]) -> [f64; 4] {
    let mut point = [0.0; 4];
    for [kx, ky, phase, a, omega2] in waves {
        let (sin, cos) = (kx * x + ky * y + phase).sin_cos();
        point[0] += a * cos;
        point[1] -= a * kx * sin;
        point[2] -= a * ky * sin;
        point[3] -= a * omega2 * cos;
    }
    black_box(point)
}
