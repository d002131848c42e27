//! Draws by importance where facets are too narrow for plain ones, and what statistics say of themselves.

use crate::common::{UP, direction};
use prob_water::{
    Engagement, Ensemble, Error, Exact, Parameters, Proposal, Surface, Water, WhitecapMode, Wind,
};

fn sea(speed: f64, footprint: f64, change: impl FnOnce(&mut Parameters)) -> Water {
    let mut p = Parameters {
        wind: Wind::Speed { speed, height: 10.0 },
        wind_direction: 20.0,
        surface: Surface::Instance,
        footprint: Some(footprint),
        instances: 4000,
        ..Parameters::default()
    };
    change(&mut p);
    p.configure().unwrap()
}

/// The laser at 30 degrees of incidence; observers at the mirror's place, to either side of it, and out of the plane.
fn observers() -> Engagement {
    let views = [direction(30.0, 0.0), direction(20.0, 0.0), direction(42.0, 0.0), direction(30.0, 15.0)];
    Engagement::far(30.0, 10e3, &views, 1e5).unwrap()
}

/// Footprints from half a millimetre to the default, winds from 2 to 15 m/s: means within 4 standard errors of the exact ones,
/// more than 10 effective draws, and no standard error of 0.
#[test]
fn narrow_facets_are_met() {
    let engagement = observers();
    for speed in [2.0, 5.0, 9.0, 15.0] {
        for footprint in [0.0005, 0.001, 0.003, 0.005, 0.02, 0.15] {
            let water = sea(speed, footprint, |_| ());
            let exact = Exact::new(&water).unwrap().means(&engagement);
            let ensemble = Ensemble { proposal: Proposal::Auto, ..Ensemble::new(&water).unwrap() };
            let samples = ensemble.sample(std::slice::from_ref(&engagement), &|_| ()).unwrap();
            for (o, exact) in exact.iter().enumerate() {
                let found = samples.statistics(0, o, &[]).unwrap();
                let deviation = (found.mean - exact.f).abs() / found.sem;
                let at = format!("{speed} m/s, D {footprint}, observer {o}: {found:?} against {}", exact.f);
                assert!(found.sem > 0.0 && found.effective > 10.0, "{at}");
                assert!(deviation < 4.0 && found.mean_upper > exact.f - 2.0 * found.sem, "{at}");
                assert_eq!(samples.by_slopes(0, o).unwrap(), footprint < 0.01, "{at}");
            }
        }
    }
}

/// Over many seeds the means of draws by importance scatter about the exact one as their standard errors say, whatever the
/// number of components, with whitecaps drawn or expected, and for an odd number of draws.
#[test]
fn importance_is_unbiased() {
    let engagement = observers();
    for (components, presence) in
        [(4, WhitecapMode::Drawn), (5, WhitecapMode::Expected), (12, WhitecapMode::Drawn)]
    {
        let sea = |seed| {
            sea(9.0, 0.003, |p| {
                (p.components, p.seed, p.instances) = (components, seed, 501);
            })
        };
        let exact = Exact::new(&sea(0)).unwrap().means(&engagement)[0].f;
        let mut sums = [0.0; 2];
        for seed in 0..40 {
            let water = sea(seed);
            let ensemble =
                Ensemble { proposal: Proposal::Slopes, presence, ..Ensemble::new(&water).unwrap() };
            let found = ensemble
                .sample(std::slice::from_ref(&engagement), &|_| ())
                .unwrap()
                .statistics(0, 0, &[])
                .unwrap();
            sums[0] += found.mean / 40.0;
            sums[1] += (found.sem / 40.0).powi(2);
        }
        let deviation = (sums[0] - exact) / sums[1].sqrt();
        assert!(deviation.abs() < 4.0, "M {components}: {} against {exact}", sums[0]);
    }
}

/// Where both can be drawn, every figure agrees: moments, quantiles, exceedances, obscuration and whitecaps.
#[test]
fn importance_agrees_with_plain_draws() {
    let water = sea(10.0, 0.05, |p| p.instances = 40_000);
    let views = [direction(60.0, 0.0), direction(84.0, 0.0)];
    let engagement = Engagement::far(65.0, 10e3, &views, 1e5).unwrap();
    let limits = [0.01, 0.1, 1.0];
    let [plain, slopes] = [Proposal::Plain, Proposal::Slopes].map(|proposal| {
        let ensemble = Ensemble { proposal, ..Ensemble::new(&water).unwrap() };
        let samples = ensemble.sample(std::slice::from_ref(&engagement), &|_| ()).unwrap();
        [0, 1].map(|o| samples.statistics(0, o, &limits).unwrap())
    });
    for (plain, slopes) in plain.iter().zip(&slopes) {
        let close = |name: &str, a: f64, b: f64, error: f64| {
            assert!((a - b).abs() < 4.0 * error, "{name}: {a} and {b}");
        };
        let error = plain.sem.hypot(slopes.sem);
        close("mean", plain.mean, slopes.mean, error);
        close("mean_f_cos", plain.mean_f_cos, slopes.mean_f_cos, error * plain.mean_f_cos / plain.mean);
        close("std", plain.std, slopes.std, 2.0 * error);
        // Shares over 40,000 draws, with weights that vary.
        let share = |p: f64| 2.0 * (p * (1.0 - p) / 40_000.0).sqrt() + 1e-6;
        close("obscured", plain.obscured, slopes.obscured, share(plain.obscured));
        close("whitecap", plain.whitecap, slopes.whitecap, share(plain.whitecap));
        for (a, b) in plain.over.iter().zip(&slopes.over) {
            close("over", *a, *b, share(*a));
        }
        for (a, b) in plain.quantiles.iter().zip(&slopes.quantiles) {
            close("quantile", *a, *b, 0.02 * plain.std + 0.02 * a);
        }
    }
}

/// A laser below the crests: seas that cover it count as obscured, by importance as plainly.
#[test]
fn a_covered_laser_sees_nothing() {
    let aim = prob_water::Aim::Direction([0.5, 0.0, -1.0]);
    let low = Engagement::new(0.0, [0.0, 0.0, 0.4], aim, &[[0.0, 0.0, 500.0]]).unwrap();
    let water = sea(12.0, 0.05, |p| p.instances = 20_000);
    let [plain, slopes] = [Proposal::Plain, Proposal::Slopes].map(|proposal| {
        let ensemble = Ensemble { proposal, ..Ensemble::new(&water).unwrap() };
        ensemble.sample(std::slice::from_ref(&low), &|_| ()).unwrap().statistics(0, 0, &[]).unwrap()
    });
    let found = format!("{plain:?} and {slopes:?}");
    assert!(plain.obscured > 0.1 && (plain.obscured - slopes.obscured).abs() < 0.02, "{found}");
    assert!((plain.mean - slopes.mean).abs() < 4.0 * plain.sem.hypot(slopes.sem), "{found}");
}

/// Plain draws of a narrow lobe, the report's, say that they know nothing: no 0 without a bound above the true mean.
#[test]
fn a_false_zero_has_an_upper_bound() {
    let engagement = observers();
    for speed in [5.0, 10.0] {
        let water = sea(speed, 0.001, |p| (p.instances, p.whitecaps) = (50, false));
        let exact = Exact::new(&water).unwrap().means(&engagement);
        let samples =
            Ensemble::new(&water).unwrap().sample(std::slice::from_ref(&engagement), &|_| ()).unwrap();
        for (o, exact) in exact.iter().enumerate() {
            let found = samples.statistics(0, o, &[1e-3]).unwrap();
            assert!(found.mean < 1e-6 && found.effective < 10.0, "{found:?}");
            assert!(
                found.mean_upper > exact.f && found.mean_upper.is_finite(),
                "{found:?} against {exact:?}"
            );
            assert!(found.over_upper[0] > 0.05 && found.over_upper[0] < 0.07, "{found:?}");
        }
    }
}

#[test]
fn numbers_of_what_is_not_there_are_refused() {
    let water = sea(5.0, 0.15, |p| p.instances = 10);
    let engagement = observers();
    for proposal in [Proposal::Plain, Proposal::Slopes] {
        let ensemble = Ensemble { proposal, ..Ensemble::new(&water).unwrap() };
        let samples = ensemble.sample(&[engagement.clone(), engagement.clone()], &|_| ()).unwrap();
        assert!(samples.statistics(1, 3, &[]).is_ok());
        let refused = samples.statistics(0, 4, &[]).unwrap_err();
        assert_eq!(refused, Error::Index { what: "observer", index: 4, count: 4 });
        assert_eq!(refused.to_string(), "observer 4 does not exist: there are 4, from 0");
        assert!(matches!(samples.of(2, 0), Err(Error::Index { what: "engagement", index: 2, count: 2 })));
    }
    let few = sea(5.0, 0.15, |p| p.components = 3);
    let ensemble = Ensemble { proposal: Proposal::Slopes, ..Ensemble::new(&few).unwrap() };
    let refused = ensemble.check(&engagement).unwrap_err().to_string();
    assert_eq!(refused, "components = 3 is out of range: allowed is at least 4 to draw slopes");
    assert!(ensemble.sample(std::slice::from_ref(&engagement), &|_| ()).is_err());
    let auto = Ensemble { proposal: Proposal::Auto, ..ensemble };
    assert!(auto.sample(&[engagement], &|_| ()).is_ok());
}

/// Every observer's sea is the same whatever the threads, and whoever else looks.
#[test]
fn importance_is_determined_by_the_seed() {
    let water = sea(9.0, 0.002, |p| p.instances = 333);
    let ensemble = Ensemble { proposal: Proposal::Slopes, ..Ensemble::new(&water).unwrap() };
    let engagement = observers();
    let run = |threads: usize, engagement: &Engagement, o: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let samples = pool.install(|| ensemble.sample(std::slice::from_ref(engagement), &|_| ())).unwrap();
        let rows = samples.of(0, o).unwrap();
        rows.map(|s| [s.weight, s.seen.f, s.hit.position[0]].map(f64::to_bits)).collect::<Vec<_>>()
    };
    let all = run(1, &engagement, 2);
    assert!(all == run(7, &engagement, 2));
    assert!(all == run(2, &engagement.with_observers(|o| o == 2), 0));
    let rows = all.iter().filter(|row| f64::from_bits(row[1]) > 0.0).count();
    assert!(rows > 30, "{rows}");
}

/// A level sea has no slopes to choose: one value, without error.
#[test]
fn a_calm_needs_no_importance() {
    let water = sea(0.0, 0.001, |p| p.instances = 20);
    let ensemble = Ensemble { proposal: Proposal::Slopes, ..Ensemble::new(&water).unwrap() };
    let engagement = Engagement::far(0.0, 10e3, &[UP], 1e5).unwrap();
    let found = ensemble.sample(&[engagement], &|_| ()).unwrap().statistics(0, 0, &[]).unwrap();
    assert!(found.std < 1e-12 * found.mean && found.mean > 1.0 && (found.effective - 20.0).abs() < 1e-9);
}
