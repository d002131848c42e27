//! Throughput of the core on one thread, of scalars and of lanes, as lines of JSON; `validation/bench/run.py` runs it.
//!
//! `cargo run --release -p prob-water-measure --bin throughput [-- REPEATS]`: every figure is measured
//! `REPEATS` times (5 unless told), interleaved with the others.

use prob_water::batch::{Columns, SampleColumns, Sources};
use prob_water::real::Vec3;
use prob_water::simd::SimdLevel;
use prob_water::{Lobe, Parameters, Scalar, SlopeMeasure};
use rand::{Rng, SeedableRng, rngs::StdRng};
use std::hint::black_box;
use std::time::Instant;

/// Directions to take: they stay in the second-level cache.
const PAIRS: usize = 4096;
/// What lanes are called in the output, by level.
const LANES: [&str; 3] = ["lanes, portable", "lanes, avx2", "lanes, avx512"];
/// Passes over them per measurement.
const PASSES: usize = 50;
/// Seas configured per measurement.
const SEAS: usize = 100;

/// Source, observer and three uniform numbers.
type Row<T> = (Vec3<T>, Vec3<T>, [T; 3]);

/// Something to time: its name and precision, and a run that returns what it got through per second.
type Candidate = (String, &'static str, Box<dyn Fn() -> f64>);

fn main() {
    let repeats = std::env::args().nth(1).map_or(5, |n| n.parse().expect("REPEATS is a number"));
    let configure = || rate(SEAS, || _ = black_box(black_box(Parameters::default()).configure()));
    let mut candidates: Vec<Candidate> = vec![("configure".into(), "float64", Box::new(configure))];
    for (sea, slope_measure) in [("default", SlopeMeasure::Angle), ("slope", SlopeMeasure::Slope)] {
        let parameters = Parameters { slope_measure, ..Parameters::default() };
        let lobe = parameters.configure().expect("the parameters are valid").local_lobe();
        add::<f64>(&mut candidates, sea, "float64", lobe);
        add::<f32>(&mut candidates, sea, "float32", lobe.cast());
        add_lanes(&mut candidates, sea, lobe.cast());
    }

    // The first round warms up.
    let mut rates = vec![Vec::new(); candidates.len()];
    for round in 0..=repeats {
        for (rates, (_, _, run)) in rates.iter_mut().zip(&candidates) {
            let rate = run();
            if round > 0 {
                rates.push(rate);
            }
        }
    }
    for (rates, (name, precision, _)) in rates.into_iter().zip(candidates) {
        let rates: Vec<_> = rates.iter().map(|rate| rate.round()).collect();
        println!(r#"{{"name": "{name}", "precision": "{precision}", "per_s": {rates:?}}}"#);
    }
}

/// Adds eval, pdf and sample of a lobe in one precision.
fn add<T: Scalar + 'static>(to: &mut Vec<Candidate>, sea: &str, precision: &'static str, lobe: Lobe<T>) {
    let mut rng = StdRng::seed_from_u64(1);
    let rows: Vec<Row<T>> = (0..PAIRS)
        .map(|_| (direction(&mut rng), direction(&mut rng), [0; 3].map(|_| T::of(rng.random()))))
        .collect();
    let mut one = |operation: &str, run: fn(&Lobe<T>, &Row<T>)| {
        let rows = rows.clone();
        let pass = move || rows.iter().for_each(|row| run(black_box(&lobe), row));
        to.push((
            format!("{operation} {sea}"),
            precision,
            Box::new(move || rate(PASSES, &pass) * PAIRS as f64),
        ));
    };
    one("eval", |lobe, (i, o, _)| _ = black_box(lobe.eval(*i, *o, None)));
    one("pdf", |lobe, (i, o, _)| _ = black_box(lobe.pdf(*i, *o, None)));
    one("sample", |lobe, (i, _, u)| _ = black_box(lobe.sample(*i, None, *u)));
}

/// Adds eval, pdf and sample of a lobe in every kind of vector that the processor has.
fn add_lanes(to: &mut Vec<Candidate>, sea: &str, lobe: Lobe<f32>) {
    let mut rng = StdRng::seed_from_u64(1);
    let mut directions = || -> [Vec<f32>; 3] {
        let rows: Vec<Vec3<f32>> = (0..PAIRS).map(|_| direction(&mut rng)).collect();
        [0, 1, 2].map(|k| rows.iter().map(|v| v[k]).collect())
    };
    let (i, o) = (directions(), directions());
    let u = [0; 3].map(|_| (0..PAIRS).map(|_| rng.random::<f32>()).collect::<Vec<_>>());
    for level in SimdLevel::ALL.into_iter().filter(|level| level.is_available()) {
        for operation in ["eval", "pdf", "sample"] {
            let inputs = [&i, &o, &u].map(Clone::clone);
            let run = move || {
                let [i, o, u] = inputs.each_ref().map(|v| v.each_ref().map(Vec::as_slice));
                let columns = Columns::new(i, o, None).expect("they are unit vectors");
                let draws = Sources::new(i, u, None).expect("they are of [0, 1)");
                let mut out = [0; 5].map(|_| vec![0.0; PAIRS]);
                let mut whitecap = vec![false; PAIRS];
                let pass = || {
                    let lobe = black_box(&lobe);
                    let [x, y, z, pdf, f] = black_box(&mut out).each_mut().map(Vec::as_mut_slice);
                    let whitecap = black_box(&mut whitecap).as_mut_slice();
                    match operation {
                        "eval" => columns.eval_on(level, lobe, f),
                        "pdf" => columns.pdf_on(level, lobe, pdf),
                        _ => {
                            let to_observer = [x, y, z];
                            draws.sample_on(level, lobe, SampleColumns { to_observer, pdf, f, whitecap })
                        }
                    }
                    .expect("as many rows");
                };
                rate(PASSES, pass) * PAIRS as f64
            };
            to.push((format!("{operation} {sea}"), LANES[level as usize], Box::new(run)));
        }
    }
}

/// Runs per second over `count` of them.
fn rate(count: usize, mut run: impl FnMut()) -> f64 {
    let start = Instant::now();
    (0..count).for_each(|_| run());
    count as f64 / start.elapsed().as_secs_f64()
}

/// Random, uniform over the hemisphere down to an elevation of a degree.
fn direction<T: Scalar>(rng: &mut StdRng) -> Vec3<T> {
    let (z, phi) = (rng.random_range(0.02..1.0f64), rng.random_range(0.0..std::f64::consts::TAU));
    let s = (1.0 - z * z).sqrt();
    [s * phi.cos(), s * phi.sin(), z].map(T::of)
}
