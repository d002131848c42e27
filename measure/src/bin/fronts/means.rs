//! Means of f over drawn seas at some observers: draws, evenly spread draws, and none.

use crate::{point, rms, seconds};
use prob_water::{Draws, Engagement, Ensemble, Exact, Parameters, Surface, Water, WhitecapMode, Wind};

/// Draws of a mean, as powers of 4 from 64; each error is over so many seeds.
const DRAWS: [u64; 5] = [64, 256, 1024, 4096, 16_384];
const SEEDS: u64 = 16;
/// Seeds and draws that the exact means are checked by.
const CHECK: (u64, u64) = (8, 65_536);

fn sea(seed: u64, instances: u64) -> Water {
    Parameters {
        wind: Wind::FrictionVelocity(8.0),
        surface: Surface::Instance,
        footprint: Some(0.15),
        seed,
        instances,
        ..Parameters::default()
    }
    .configure()
    .expect("the parameters are valid")
}

/// The front `means`: 25 observers within 10 degrees of where a laser at 30 degrees is reflected. Errors are relative, root
/// mean squares over observers and seeds, of draws against exact means.
pub fn front(repeats: usize) {
    let views: Vec<[f64; 3]> = (0..25)
        .map(|n| {
            let part = |i: i32| (f64::from(i) - 2.0) / 2.0;
            let theta = (30.0 + 10.0 * part(n % 5)).to_radians();
            let phi = (10.0 * part(n / 5)).to_radians();
            [theta.sin() * phi.cos(), phi.sin(), theta.cos() * phi.cos()]
        })
        .collect();
    let engagement = Engagement::far(30.0, 10e3, &views, 100e3).expect("the engagement is valid");

    let mut exact = vec![];
    let times: Vec<_> = (0..=repeats)
        .map(|_| {
            seconds(|| {
                let means = Exact::new(&sea(0, 1)).expect("enough components").means(&engagement);
                exact = means.iter().map(|mean| mean.f).collect();
            })
        })
        .collect();
    let mean_of = |ensemble: Ensemble| -> Vec<f64> {
        let samples = ensemble.sample(std::slice::from_ref(&engagement), &|_| ()).expect("enough memory");
        (0..views.len()).map(|o| samples.statistics(0, o, &[]).expect("they are there").mean).collect()
    };
    let expected = |seed, draws| Ensemble {
        presence: WhitecapMode::Expected,
        ..Ensemble::new(&sea(seed, draws)).expect("the sea has drawn waves")
    };
    let off = |means: &[f64]| means.iter().zip(&exact).map(|(a, b)| a / b - 1.0).collect::<Vec<_>>();

    for (family, around) in [("plain draws", false), ("Sobol draws", true)] {
        for draws in DRAWS {
            let (mut errors, mut times) = (vec![], vec![]);
            for seed in 0..SEEDS {
                let plain = expected(seed, draws);
                let ensemble = if around { plain.around(&engagement) } else { plain };
                assert_eq!(ensemble.draws == Draws::Sobol, around);
                times.push(seconds(|| errors.extend(off(&mean_of(ensemble)))));
            }
            point("means", family, &draws.to_string(), rms(errors.into_iter()), &times);
        }
    }
    // How far the exact means are from all evenly spread draws together: at most their own error and that of those.
    let mut all = vec![0.0; views.len()];
    let (seeds, draws) = CHECK;
    for seed in 0..seeds {
        let means = mean_of(expected(100 + seed, draws).around(&engagement));
        all.iter_mut().zip(means).for_each(|(sum, mean)| *sum += mean / seeds as f64);
    }
    point("means", "exact, at most", "", rms(off(&all).into_iter()), &times[1..]);
}
