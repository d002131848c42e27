//! Speed of drawn and of exact statistics, as lines of JSON; `validation/bench/run.py` runs it.
//!
//! `cargo run --release -p prob-water-measure --bin engagements [-- REPEATS]`: every figure is the best of
//! `REPEATS` (5 unless told); of whole scenarios and of exact means every run is told.

use prob_water::surface::InstanceRng;
use prob_water::surface::SurfaceRay;
use prob_water::{Draws, Engagement, Ensemble, Exact, RealisedSurface, Surface, Water, WhitecapMode, Wind};
use prob_water::{Parameters, brdf::up};
use std::hint::black_box;
use std::time::Instant;

/// The report's base scenario but for what is told.
fn base(friction_velocity: f64, components: u32, instances: u64) -> Water {
    Parameters {
        wind: Wind::FrictionVelocity(friction_velocity),
        surface: Surface::Instance,
        footprint: Some(0.15),
        ior: Some(1.33),
        components,
        instances,
        ..Parameters::default()
    }
    .configure()
    .expect("the parameters are valid")
}

/// A fan of observers at 100 km in and beside the plane of incidence, around where the sea reflects a laser at 10 km.
fn fan(incidence: f64, observers: usize) -> Engagement {
    let side = (observers as f64).sqrt().ceil() as usize;
    let views: Vec<[f64; 3]> = (0..observers)
        .map(|n| {
            let part = |i: usize| if side > 1 { i as f64 / (side - 1) as f64 - 0.5 } else { 0.0 };
            let theta = (incidence + 30.0 * part(n % side)).to_radians();
            let phi = (40.0 * part(n / side)).to_radians();
            [theta.sin() * phi.cos(), phi.sin(), theta.cos() * phi.cos()]
        })
        .collect();
    Engagement::far(incidence, 10e3, &views, 100e3).expect("the engagement is valid")
}

/// Times of some runs, s.
fn times(repeats: usize, mut run: impl FnMut()) -> Vec<f64> {
    let time = |_| {
        let start = Instant::now();
        run();
        start.elapsed().as_secs_f64()
    };
    (0..repeats).map(time).collect()
}

/// Best time of some runs, s.
fn best(repeats: usize, run: impl FnMut()) -> f64 {
    least(&times(repeats, run))
}

fn least(times: &[f64]) -> f64 {
    times.iter().copied().fold(f64::INFINITY, f64::min)
}

fn main() {
    let repeats = std::env::args().nth(1).map_or(5, |n| n.parse().expect("REPEATS is a number"));
    stages(repeats);
    growth(repeats);
    for incidence in [30.0, 60.0] {
        for w in [8.0, 24.0] {
            race(repeats, w, incidence);
        }
    }
}

/// Time of each stage of one instance with one observer, on one thread, us.
fn stages(repeats: usize) {
    const RUNS: u64 = 20_000;
    for (w, incidence, view) in [(8.0, 30.0, 30.0), (24.0, 60.0, 60.0), (24.0, 85.0, 85.0)] {
        let water = base(w, 5, RUNS);
        let engagement = {
            let (sin, cos) = f64::to_radians(view).sin_cos();
            Engagement::far(incidence, 10e3, &[[sin, 0.0, cos]], 100e3).expect("the engagement is valid")
        };
        let waves = water.waves();
        let mut surface = RealisedSurface::default();
        let draw = best(repeats, || {
            for i in 0..RUNS {
                surface.draw(waves.components(InstanceRng::new(Draws::Random, 0, i)));
                surface.set_time(black_box(1.0));
            }
        });
        let surfaces: Vec<_> =
            (0..RUNS).map(|i| waves.surface(InstanceRng::new(Draws::Random, 0, i), 0.0)).collect();
        let mut path = SurfaceRay::default();
        let (laser, beam) = (engagement.laser().into(), engagement.direction().into());
        let mut hits = vec![];
        let cast = best(repeats, || {
            hits.clear();
            hits.extend(surfaces.iter().map(|s| path.first_hit(s, laser, beam).expect("a laser in the air")));
        });
        let point = best(repeats, || {
            for (s, hit) in surfaces.iter().zip(&hits) {
                black_box(s.point([hit.x, hit.y]));
            }
        });
        let observer = engagement.observers()[0].into();
        let hide = best(repeats, || {
            for (s, hit) in surfaces.iter().zip(&hits) {
                black_box(path.occludes(s, *hit, observer));
            }
        });
        let o = engagement.observers()[0].map(|x| x / 100e3);
        let i = engagement.direction().map(|x| -x);
        let facets = water.local_lobe().facets;
        let eval = best(repeats, || {
            for _ in 0..RUNS {
                black_box(facets.eval(black_box(i), o, up()));
            }
        });
        let us = |time: f64| time * 1e6 / RUNS as f64;
        println!(
            r#"{{"stages": {{"w": {w}, "incidence": {incidence}}}, "draw": {:.3}, "cast": {:.3}, "normal": {:.3}, "obscuration": {:.3}, "brdf": {:.3}}}"#,
            us(draw),
            us(cast),
            us(point),
            us(hide),
            us(eval)
        );
    }
}

/// Instances per second, statistics included, over components, instances and observers, on all cores.
fn growth(repeats: usize) {
    let line = |components: u32, instances: u64, observers: usize| {
        let ensemble = Ensemble::new(&base(8.0, components, instances)).expect("the sea has drawn waves");
        let engagement = [fan(30.0, observers)];
        let times = times(repeats, || {
            let samples = ensemble.sample(&engagement, &|_| ()).expect("enough memory");
            for o in 0..observers {
                black_box(samples.statistics(0, o, &[]).expect("they are there"));
            }
        });
        println!(
            r#"{{"growth": {{"components": {components}, "instances": {instances}, "observers": {observers}}}, "seconds": {times:?}, "instances_per_s": {:.0}}}"#,
            instances as f64 / least(&times)
        );
    };
    line(5, 50, 1);
    for components in [5, 20, 80, 320] {
        line(components, 5000, 10);
    }
    for instances in [500, 50_000] {
        line(5, instances, 10);
    }
    for observers in [1, 100] {
        line(5, 5000, observers);
    }
}

/// Time for the means at 100 observers, each to 1 % and to 0.1 % (standard error), set-up included: the report's draws
/// against exact means. The time of draws is that of 20,000, scaled: it is proportional to their number.
fn race(repeats: usize, w: f64, incidence: f64) {
    let engagement = [fan(incidence, 100)];
    let water = base(w, 5, 20_000);
    let mut means = vec![];
    let exact_times = times(repeats, || {
        means = Exact::new(black_box(&water)).expect("enough components").means(&engagement[0]);
    });
    let exact = least(&exact_times);
    // Draws over the square of the relative error that they leave, for the observer who needs most.
    let mut needed = 0.0f64;
    let mut off = vec![];
    let draws = best(2, || {
        let ensemble = Ensemble {
            presence: WhitecapMode::Drawn,
            ..Ensemble::new(black_box(&water)).expect("the sea has drawn waves")
        };
        let samples = ensemble.sample(&engagement, &|_| ()).expect("enough memory");
        let statistics: Vec<_> =
            (0..100).map(|o| samples.statistics(0, o, &[]).expect("they are there")).collect();
        needed = statistics.iter().map(|s| (s.std / s.mean).powi(2)).fold(0.0, f64::max);
        off = statistics.iter().zip(&means).map(|(s, m)| ((m.f - s.mean) / s.sem).powi(2)).collect();
    });
    let per_draw = draws / 20_000.0;
    let (percent, tenth) = (needed * 1e4 * per_draw, needed * 1e6 * per_draw);
    println!(
        r#"{{"race": {{"w": {w}, "incidence": {incidence}}}, "exact": {exact_times:?}, "draws_1_percent": {percent:.4}, "draws_0.1_percent": {tenth:.3}, "ratio_1": {:.0}, "ratio_0.1": {:.0}, "draws": 20000, "off_in_standard_errors": {:.2}}}"#,
        percent / exact,
        tenth / exact,
        (off.iter().sum::<f64>() / 100.0).sqrt()
    );
}
