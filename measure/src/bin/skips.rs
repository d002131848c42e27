//! Work that is left out where it makes no difference, and what that saves, one thread, as lines of JSON;
//! `validation/bench/off.py` makes a table of it.
//!
//! `cargo run --release -p prob-water-measure --bin skips [-- REPEATS]`: seconds with the work and without, in turns.

use glam::DVec3;
use prob_water::brdf::up;
use prob_water::surface::InstanceRng;
use prob_water::surface::SurfaceRay;
use prob_water::{Draws, Engagement, EnsembleLobe, Exact, InstanceLobe, Parameters, Surface, Water, Wind};
use std::hint::black_box;
use std::time::Instant;

fn main() {
    let repeats: usize = std::env::args().nth(1).map_or(9, |n| n.parse().expect("REPEATS is a number"));
    rayon::ThreadPoolBuilder::new().num_threads(1).build_global().expect("nothing has run in parallel yet");
    obscuration(repeats);
    let engagement =
        Engagement::far(30.0, 10e3, &[[0.5, 0.0, 0.75f64.sqrt()]; 25], 100e3).expect("it is valid");
    for w in [8.0, 24.0] {
        let time = |whitecaps| {
            let water = sea(w, Parameters { whitecaps, surface: Surface::Instance, ..Parameters::default() });
            let engagement = &engagement;
            move || _ = black_box(Exact::new(&water).expect("enough components").means(engagement))
        };
        race(&format!("whitecaps of exact means, w* = {w}"), repeats, 1, time(true), time(false));
    }
    let instance = |w| {
        let water =
            sea(w, Parameters { surface: Surface::Instance, components: 64, ..Parameters::default() });
        let lobe = InstanceLobe::new(&water).expect("the sea has drawn waves");
        let look = [0.6, 0.0, 0.8];
        move || (0..1000).for_each(|n| _ = black_box(lobe.eval(look, look, [0.37 * f64::from(n), 0.0])))
    };
    race("sum of 64 waves", repeats, 1000, instance(8.0), instance(0.0));
    let ensemble = |w| {
        let water = sea(w, Parameters { surface: Surface::Ensemble, ..Parameters::default() });
        move || _ = black_box(EnsembleLobe::new(&water).expect("enough components"))
    };
    race("table of the ensemble", repeats.min(3), 1, ensemble(8.0), ensemble(0.0));
    let lobe = sea(24.0, Parameters::default()).local_lobe();
    let view = |z: f64| {
        let direction = [(1.0 - z * z).sqrt(), 0.0, z];
        move || (0..1000).for_each(|_| _ = black_box(lobe.eval(black_box(direction), direction, up())))
    };
    race("exponential and erfc of shadowing, float64", repeats, 1000, view(0.3), view(0.97));
}

/// A friction velocity in cm/s, D = 0.15 m.
fn sea(w: f64, parameters: Parameters) -> Water {
    let parameters = Parameters { wind: Wind::FrictionVelocity(w), footprint: Some(0.15), ..parameters };
    parameters.configure().expect("the parameters are valid")
}

/// Whether waves hide an observer at 5 degrees of elevation, and one at 80, whom no slope can hide.
fn obscuration(repeats: usize) {
    let water = sea(8.0, Parameters { surface: Surface::Instance, ..Parameters::default() });
    let seas: Vec<_> =
        (0..1000).map(|n| water.waves().surface(InstanceRng::new(Draws::Random, 0, n), 0.0)).collect();
    let hide = |elevation: f64| {
        let (sin, cos) = elevation.to_radians().sin_cos();
        let (seas, mut path) = (&seas, SurfaceRay::default());
        let observer = 100e3 * DVec3::new(cos, 0.0, sin);
        move || {
            for sea in seas {
                let from = DVec3::new(0.0, 0.0, sea.height([0.0; 2]));
                black_box(path.occludes(sea, from, observer));
            }
        }
    };
    race("march to an observer", repeats, 1000, hide(5.0), hide(80.0));
}

/// Prints seconds of one of `count`, run by run.
fn race(name: &str, repeats: usize, count: usize, mut with: impl FnMut(), mut without: impl FnMut()) {
    let mut times = [vec![], vec![]];
    // The first round warms up.
    for round in 0..=repeats {
        for (times, run) in times.iter_mut().zip([&mut with as &mut dyn FnMut(), &mut without]) {
            let start = Instant::now();
            run();
            if round > 0 {
                times.push(format!("{:e}", start.elapsed().as_secs_f64() / count as f64));
            }
        }
    }
    let [with, without] = times.map(|times| times.join(", "));
    println!(r#"{{"name": "{name}", "with": [{with}], "without": [{without}]}}"#);
}
