//! Speed of the empirical model beside the full one, as lines of JSON; `validation/bench/run.py` runs it.
//!
//! `cargo run --release -p prob-water-measure --bin empirical [-- REPEATS]`: every figure is measured `REPEATS` times (5
//! unless told), all in turn, on one thread.

use prob_water::batch::Rows;
use prob_water::{
    EmpiricalLobe, Engagement, Ensemble, Gridded, OffPlaneModel, Parameters, Scalar, Surface, Table, Wind,
};
use rand::{Rng, SeedableRng, rngs::StdRng};
use std::hint::black_box;
use std::num::NonZeroU32;
use std::time::Instant;

/// Directions of a batch, and queries of the full model.
const PAIRS: usize = 100_000;
const QUERIES: usize = 200;
/// The report's N.
const INSTANCES: u64 = 50;

/// What is timed: its name, how many values a run gives, and the run.
type Candidate = (&'static str, usize, Box<dyn FnMut()>);

fn main() {
    let repeats: usize = std::env::args().nth(1).map_or(5, |n| n.parse().expect("REPEATS is a number"));
    rayon::ThreadPoolBuilder::new().num_threads(1).build_global().expect("nothing has run in parallel yet");
    let table = Table::standard();
    for w in [8.0, 24.0] {
        let parameters = Parameters {
            wind: Wind::FrictionVelocity(w),
            surface: Surface::Empirical,
            footprint: Some(0.15),
            instances: INSTANCES,
            ..Parameters::default()
        };
        let slopes = Parameters { across: OffPlaneModel::Slopes, ..parameters };
        let [water, slopes] = [parameters, slopes].map(|p| p.configure().expect("the parameters are valid"));
        let [report_lobe, slopes_lobe] = [&water, &slopes]
            .map(|water| EmpiricalLobe::new(water, table).expect("the table knows this sea"));

        let mut rng = StdRng::seed_from_u64(1);
        let mut direction = || {
            let (z, phi): (f64, f64) =
                (rng.random_range(0.02..1.0), rng.random_range(0.0..std::f64::consts::TAU));
            let r = (1.0 - z * z).sqrt();
            [r * phi.cos(), r * phi.sin(), z]
        };
        let (i, o): (Vec<_>, Vec<_>) = (0..PAIRS).map(|_| (direction(), direction())).unzip();
        let single = |v: &[[f64; 3]]| v.iter().map(|v| v.map(|x| x as f32)).collect::<Vec<_>>();
        let (i32, o32) = (single(&i), single(&o));
        // Where a far observer looks into the reflection of a laser at 30 degrees.
        let views: Vec<_> = (0..QUERIES)
            .map(|n| {
                let theta = (10.0 + 40.0 * n as f64 / QUERIES as f64).to_radians();
                let seen = [theta.sin(), 0.0, theta.cos()];
                Engagement::far(30.0, 10e3, &[seen], 100e3).expect("the engagement is valid")
            })
            .collect();
        let ensemble = Ensemble::new(&water).expect("the sea has drawn waves");
        let draws = NonZeroU32::new(INSTANCES as u32).expect("is not 0");

        let mut candidates: Vec<Candidate> = vec![
            ("full, 50 instances", QUERIES, {
                let views = views.clone();
                Box::new(move || {
                    for view in &views {
                        let samples = ensemble.sample(std::slice::from_ref(view), &|_| ()).expect("it fits");
                        black_box(samples.statistics(0, 0, &[]).expect("they are there"));
                    }
                })
            }),
            ("eval, float32", PAIRS, batch(report_lobe.clone(), i32.clone(), o32.clone())),
            ("eval, float64", PAIRS, batch(report_lobe.clone(), i.clone(), o.clone())),
            ("eval, float32, slopes", PAIRS, batch(slopes_lobe, i32, o32)),
            ("estimate, float64", PAIRS, {
                let (lobe, i, o) = (report_lobe.clone(), i.clone(), o.clone());
                Box::new(move || i.iter().zip(&o).for_each(|(i, o)| _ = black_box(lobe.estimate(*i, *o))))
            }),
            ("Monte Carlo, 50 draws", QUERIES, {
                let (lobe, i, o) = (report_lobe, i, o);
                Box::new(move || {
                    for (i, o) in i.iter().zip(&o).take(QUERIES) {
                        black_box(lobe.monte_carlo(*i, *o, draws, 0, &[]));
                    }
                })
            }),
            ("configure", 1, Box::new(move || _ = black_box(EmpiricalLobe::new(&water, table)))),
            ("configure, slopes", 1, Box::new(move || _ = black_box(EmpiricalLobe::new(&slopes, table)))),
        ];
        // The first round warms up.
        let mut seconds = vec![vec![]; candidates.len()];
        for round in 0..=repeats {
            for (seconds, (_, count, run)) in seconds.iter_mut().zip(&mut candidates) {
                let start = Instant::now();
                run();
                if round > 0 {
                    seconds.push(start.elapsed().as_secs_f64() / *count as f64);
                }
            }
        }
        for ((name, ..), seconds) in candidates.iter().zip(seconds) {
            let seconds: Vec<_> = seconds.iter().map(|s| format!("{s:e}")).collect();
            println!(r#"{{"w": {w}, "name": "{name}", "seconds": [{}]}}"#, seconds.join(", "));
        }
    }
}

/// A checked batch.
fn batch<T: Scalar + Gridded + 'static>(
    lobe: EmpiricalLobe,
    i: Vec<[T; 3]>,
    o: Vec<[T; 3]>,
) -> Box<dyn FnMut()> {
    let mut f = vec![T::of(0.0); i.len()];
    Box::new(move || {
        let rows = Rows::new(&i, &o, None).expect("they are unit vectors");
        rows.each(&mut f, |_, i, o, _| lobe.eval(i, o)).expect("as many");
        black_box(&f);
    })
}
