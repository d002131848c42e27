//! Statistics over drawn surfaces against an independent implementation and against what must hold of any.

use crate::common::{direction, rows, water};
use prob_water::statistics::Sighting;
use prob_water::whitecap::WhitecapOnset;
use prob_water::{Engagement, Ensemble, Statistics, Surface, Water, WhitecapMode};

/// The base scenario of the report's section 8, with a number of instances.
fn base(friction_velocity: f64, instances: u64) -> Water {
    water(friction_velocity, |p| {
        p.surface = Surface::Instance;
        p.footprint = Some(0.15);
        p.instances = instances;
        p.whitecaps = true;
        p.whitecap_onset = WhitecapOnset::Ramp;
        p.wavelength = 1.0;
    })
}

/// In-plane views at angles of reflection in degrees, laser at 10 km, observers at 100 km.
fn in_plane(incidence: f64, angles: &[f64]) -> Engagement {
    let views: Vec<_> = angles.iter().map(|a| direction(*a, 0.0)).collect();
    Engagement::far(incidence, 10e3, &views, 100e3).unwrap()
}

fn statistics(ensemble: &Ensemble, engagement: &Engagement) -> Vec<Statistics> {
    let samples = ensemble.sample(std::slice::from_ref(engagement), &|_| ()).unwrap();
    (0..engagement.observers().len()).map(|o| samples.statistics(0, o, &[]).unwrap()).collect()
}

/// Mean, standard deviation and mean_f_cos within 4 combined standard errors at every angle, for both winds.
#[test]
fn base_scenario_of_the_reference() {
    for rows in rows("scenario_base").chunk_by(|a, b| a[0] == b[0]) {
        let mut ensemble = Ensemble::new(&base(rows[0][0], 100_000)).unwrap();
        ensemble.presence = WhitecapMode::Expected;
        let angles: Vec<f64> = rows.iter().map(|r| r[5]).collect();
        let engagement = in_plane(rows[0][4], &angles);
        let samples = ensemble.sample(std::slice::from_ref(&engagement), &|_| ()).unwrap();
        for (o, r) in rows.iter().enumerate() {
            let found = samples.statistics(0, o, &[]).unwrap();
            let n = samples.instances() as f64;
            let moment = |power: i32| {
                samples.of(0, o).unwrap().map(|s| (s.seen.f - found.mean).powi(power)).sum::<f64>() / n
            };
            let sem_of_std = ((moment(4) - found.std.powi(4)) / n).sqrt() / (2.0 * found.std);
            // The reference does not give the error of mean_f_cos: it is the mean's, times the same factor.
            let cos = r[10] / r[6];
            for (name, found, error, expected, other) in [
                ("mean", found.mean, found.sem, r[6], r[7]),
                ("std", found.std, sem_of_std, r[8], r[9]),
                ("mean_f_cos", found.mean_f_cos, cos * found.sem, r[10], cos * r[7]),
            ] {
                let deviation = (found - expected).abs() / error.hypot(other);
                assert!(deviation < 4.0, "w* {} theta_r {} {name}: {found} against {expected}", r[0], r[5]);
            }
            assert!((found.whitecap - r[11]).abs() < 0.02 * r[11] + 1e-9, "{} {}", found.whitecap, r[11]);
        }
    }
}

/// model.md's converged maxima, within 1 %.
#[test]
fn converged_maxima() {
    let peak = |water: &Water, incidence: f64, angles: &[f64]| {
        let mut ensemble = Ensemble::new(water).unwrap();
        ensemble.presence = WhitecapMode::Expected;
        let means = statistics(&ensemble, &in_plane(incidence, angles));
        let best = (0..angles.len()).max_by(|a, b| means[*a].mean.total_cmp(&means[*b].mean)).unwrap();
        (means[best].mean, means[best].sem, angles[best])
    };
    let angles: Vec<f64> = (10..=22).map(|a| 2.5 * f64::from(a)).collect();
    let check = |what: String, (found, sem, at): (f64, f64, f64), expected: f64| {
        let off = (found / expected - 1.0).abs();
        assert!(off < 0.01, "{what}: {found} +- {sem} at {at} against {expected}");
    };
    let winds = [2.0, 4.0, 8.0, 16.0, 24.0, 40.0, 56.0];
    for (w, expected) in winds.into_iter().zip([0.904, 0.354, 0.1413, 0.0723, 0.0536, 0.0409, 0.0340]) {
        check(format!("w* {w}"), peak(&base(w, 100_000), 30.0, &angles), expected);
    }
    for (i, expected) in [0.1346, 0.1376, 0.1413, 0.1449, 0.1485, 0.1518].into_iter().enumerate() {
        let mut p = base(8.0, 100_000).parameters;
        p.footprint = Some(0.05 * (i + 1) as f64);
        check(format!("D {:.2}", p.footprint()), peak(&p.configure().unwrap(), 30.0, &angles), expected);
    }
    for (incidence, expected) in [(0.0, 0.1056), (15.0, 0.1132), (45.0, 0.2423), (60.0, 1.48)] {
        let all: Vec<f64> = (0..=36).map(|a| 2.5 * f64::from(a)).filter(|a| *a < 89.0).collect();
        check(format!("theta_i {incidence}"), peak(&base(8.0, 100_000), incidence, &all), expected);
    }
}

/// Everything about a run as bits.
fn bits(ensemble: &Ensemble, engagements: &[Engagement]) -> Vec<u64> {
    let samples = ensemble.sample(engagements, &|_| ()).unwrap();
    assert_eq!(samples.engagements(), engagements.len());
    let mut bits = vec![];
    for (e, engagement) in engagements.iter().enumerate() {
        for o in 0..engagement.observers().len() {
            let s = samples.statistics(e, o, &[0.01, 0.1]).unwrap();
            bits.extend(
                [s.mean, s.std, s.min, s.max, s.mean_f_cos, s.obscured, s.whitecap].map(f64::to_bits),
            );
            bits.extend(s.quantiles.iter().chain(&s.over).map(|x| x.to_bits()));
            bits.extend(samples.of(e, o).unwrap().flat_map(|Sighting { instance: i, hit, seen, .. }| {
                let [x, y, z] = hit.position;
                [i, x.to_bits(), y.to_bits(), z.to_bits(), seen.f.to_bits(), seen.cos_r.to_bits()]
            }));
        }
    }
    bits
}

/// The same bits for 1, 2 and 7 threads; engagements do not disturb each other; another seed is another sea.
#[test]
fn determined_by_the_seed_alone() {
    let engagements: Vec<_> =
        [10.0, 80.0, 30.0].iter().map(|i| in_plane(*i, &[0.0, 30.0, 60.0, 85.0])).collect();
    for draws in [prob_water::Draws::Random, prob_water::Draws::Sobol] {
        let mut ensemble = Ensemble::new(&base(40.0, 333)).unwrap();
        ensemble.draws = draws;
        let all = [1, 2, 7].map(|threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| bits(&ensemble, &engagements))
        });
        assert!(all[0] == all[1] && all[0] == all[2]);
        let third = bits(&ensemble, &engagements[2..]);
        assert!(all[0].ends_with(&third));
        ensemble.water.parameters.seed = 1;
        assert!(all[0] != bits(&ensemble, &engagements));
    }
}

/// Sobol draws and expected whitecaps keep the means, and lose spread; how much depends on the sea.
#[test]
fn the_options_agree_on_the_mean() {
    for w in [8.0, 56.0] {
        compare_options(w);
    }
}

fn compare_options(w: f64) {
    let engagement = in_plane(30.0, &[10.0, 30.0, 50.0]);
    let runs = |even: bool, presence| {
        let mut means = vec![[0.0; 3]; 40];
        for (seed, mean) in means.iter_mut().enumerate() {
            let mut water = base(w, 1024);
            water.parameters.seed = seed as u64;
            let ensemble = Ensemble { presence, ..Ensemble::new(&water).unwrap() };
            let ensemble = if even { ensemble.around(&engagement) } else { ensemble };
            let found = statistics(&ensemble, &engagement);
            *mean = [found[0].mean, found[1].mean, found[2].mean];
        }
        let n = means.len() as f64;
        let mean = |o: usize| means.iter().map(|m| m[o]).sum::<f64>() / n;
        let variance = |o: usize| means.iter().map(|m| (m[o] - mean(o)).powi(2)).sum::<f64>() / (n - 1.0);
        [0, 1, 2].map(|o| (mean(o), variance(o)))
    };
    let plain = runs(false, WhitecapMode::Drawn);
    let calm = runs(true, WhitecapMode::Expected);
    for (plain, calm) in plain.iter().zip(calm) {
        let error = ((plain.1 + calm.1) / 40.0).sqrt();
        assert!((plain.0 - calm.0).abs() < 4.0 * error, "w* {w}: {plain:?} and {calm:?}");
        assert!(calm.1 < plain.1, "w* {w}: {plain:?} and {calm:?}");
    }
}

/// A crest over the laser or the observer, and a view from below the wave's horizon, are obscured; without wind nothing
/// is.
#[test]
fn what_waves_cover_is_obscured() {
    let low = Engagement::new(
        0.0,
        [0.0, 0.0, 0.05],
        prob_water::Aim::Direction([0.1, 0.0, -1.0]),
        &[[5.0, 0.0, 0.05], [0.0, 0.0, 500.0]],
    )
    .unwrap();
    let found = statistics(&Ensemble::new(&base(24.0, 2000)).unwrap(), &low);
    // Half of the water stands above the mean surface: there both are covered.
    assert!(found[0].obscured > 0.5 && found[1].obscured > 0.35 && found[1].obscured < 0.5, "{found:?}");
    let calm = statistics(&Ensemble::new(&base(0.0, 10)).unwrap(), &low);
    assert!(calm.iter().all(|s| s.obscured == 0.0 && s.std == 0.0));
}

#[test]
fn memory_is_asked_for_before_it_is_taken() {
    let engagement = in_plane(30.0, &[0.0; 20]);
    let error = Ensemble::new(&base(8.0, 1_000_000_000)).unwrap().check(&engagement).unwrap_err().to_string();
    assert!(
        error.contains("instances") && error.contains("20 observers") && error.contains("GiB"),
        "{error}"
    );
    assert!(Ensemble::new(&base(8.0, 1_000_000)).unwrap().check(&engagement).is_ok());
    assert!(Ensemble::new(&base(8.0, 5)).unwrap().sample(&[], &|_| ()).is_err());
}
