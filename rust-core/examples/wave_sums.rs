//! Speed of wave sums on one thread, as lines of JSON; `validation/bench.py` runs it.
//!
//! `cargo run --release -p prob-water --example wave_sums [-- REPEATS]`: components per second of height, slopes and
//! acceleration over random places within 10 km, by a plain loop with the platform's sine and cosine, by the float64
//! reference and in lanes; the best of `REPEATS` (5 unless told), all in turn.

use prob_water::lanes::Level;
use prob_water::surface::Point;
use prob_water::{Draws, Ensemble, Parameters, RealisedSurface, WaveSums};
use std::hint::black_box;
use std::time::Instant;

const WAVES: u32 = 512;
const PLACES: usize = 2000;
/// s.
const TIME: f64 = 3600.0;

/// What is timed: its name and the run.
type Candidate<'a> = (String, Box<dyn Fn(&mut [Point]) + 'a>);

fn main() {
    let repeats: usize = std::env::args().nth(1).map_or(5, |n| n.parse().expect("REPEATS is a number"));
    let water = Parameters { components: WAVES, ..Parameters::default() }.configure().expect("valid parameters");
    let sea = Ensemble { draws: Draws::Stratified, ..Ensemble::new(&water) };
    let waves: Vec<_> = sea.components(0).1.collect();
    let surface = RealisedSurface::new(waves.iter().copied(), TIME);
    let sums = WaveSums::new(&surface);
    let places: Vec<_> = (0..PLACES)
        .map(|n| [0.618_034, 0.754_878].map(|ratio| 10e3 * (n as f64 * ratio).fract()))
        .collect();

    // Amplitude, phase, wave numbers along x and y, frequency.
    let kept: Vec<[f64; 5]> = waves
        .iter()
        .map(|w| {
            let (sin, cos) = w.azimuth.sin_cos();
            let phase = w.phase + w.frequency * TIME;
            [w.amplitude, phase, w.wave_number * cos, w.wave_number * sin, w.frequency]
        })
        .collect();
    let platform = |points: &mut [Point]| {
        for (place, point) in places.iter().zip(points) {
            *point = plain_sum(&kept, *place);
        }
    };
    let reference = |points: &mut [Point]| {
        for (place, point) in places.iter().zip(points) {
            *point = surface.point(*place);
        }
    };

    let mut candidates: Vec<Candidate> = vec![
        ("platform, float64".into(), Box::new(platform)),
        ("reference, float64".into(), Box::new(reference)),
    ];
    for level in Level::ALL.into_iter().filter(|level| level.is_available()) {
        let (sums, places) = (&sums, &places);
        candidates.push((
            format!("lanes, {}", level.name()),
            Box::new(move |points| sums.points_on(level, places, points)),
        ));
    }

    let mut best = vec![f64::INFINITY; candidates.len()];
    let mut results = vec![vec![Point::default(); PLACES]; candidates.len()];
    for _ in 0..=repeats {
        for (k, (_, run)) in candidates.iter().enumerate() {
            let start = Instant::now();
            run(black_box(&mut results[k]));
            best[k] = best[k].min(start.elapsed().as_secs_f64());
        }
    }
    for (k, (name, _)) in candidates.iter().enumerate() {
        let rate = (WAVES as usize * PLACES) as f64 / best[k];
        let error = |of: fn(&Point) -> f64| {
            let pairs = || results[k].iter().zip(&results[1]);
            let worst = pairs().map(|(a, b)| (of(a) - of(b)).abs()).fold(0.0, f64::max);
            let size = (pairs().map(|(_, b)| of(b).powi(2)).sum::<f64>() / PLACES as f64).sqrt();
            worst / size
        };
        println!(
            r#"{{"name": "{name}", "waves": {WAVES}, "components_per_s": {rate:.0}, "height_error": {:.2e}, "slope_error": {:.2e}}}"#,
            error(|p| p.height),
            error(|p| p.slope[0]),
        );
    }
}

/// The sum in a plain loop.
fn plain_sum(waves: &[[f64; 5]], [x, y]: [f64; 2]) -> Point {
    let mut point = Point::default();
    for [a, phase, kx, ky, omega] in waves {
        let (sin, cos) = (phase + kx * x + ky * y).sin_cos();
        point.height += a * cos;
        point.slope[0] -= a * kx * sin;
        point.slope[1] -= a * ky * sin;
        point.acceleration -= a * omega * omega * cos;
    }
    point
}
