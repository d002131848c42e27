//! Whitecaps of drawn waves (Eqs. 52-54): how many there are against Eq. 51, and how long they last.

use crate::common::water;
use prob_water::brdf::Parts;
use prob_water::statistics::Samples;
use prob_water::surface::{Draws, InstanceRng};
use prob_water::whitecap::WhitecapOnset;
use prob_water::{
    Aim, Average, Engagement, Ensemble, EnsembleLobe, Exact, InstanceLobe, Layout, Mesh, OnsetTable,
    RealisedSurface, Surface, Water, WhitecapMode, whitecap,
};
use rayon::prelude::*;

fn sea(w: f64, footprint: f64, components: u32, onset: WhitecapOnset) -> Water {
    water(w, |p| {
        p.surface = Surface::Instance;
        p.footprint = Some(footprint);
        p.components = components;
        p.whitecaps = true;
        p.whitecap_onset = onset;
    })
}

/// The mean probability of a whitecap on drawn surfaces over Eq. 51's fraction, and its standard error.
fn over_eq_51(sea: &Water, instances: u64) -> [f64; 2] {
    let (waves, onset) = (sea.waves(), sea.whitecap_onset().unwrap());
    mean_over_eq_51(sea, instances, |numbers| {
        onset.probability(waves.surface(numbers, 0.0).point([0.0; 2]).acceleration)
    })
}

/// The same of a probability for random numbers.
fn mean_over_eq_51(sea: &Water, instances: u64, of: impl Fn(InstanceRng) -> f64 + Sync) -> [f64; 2] {
    const BATCH: u64 = 1000;
    let probability = |instance| {
        let mut numbers = InstanceRng::new(Draws::Random, 9, instance);
        numbers.next();
        of(numbers)
    };
    // Batches are summed in order, so that sums do not depend on threads.
    let batches: Vec<[f64; 2]> = (0..instances / BATCH)
        .into_par_iter()
        .map(|batch| {
            let all = (batch * BATCH..(batch + 1) * BATCH).map(probability);
            all.fold([0.0; 2], |[sum, square], p| [sum + p, square + p * p])
        })
        .collect();
    let [mean, square] = [0, 1].map(|m| batches.iter().map(|b| b[m]).sum::<f64>() / instances as f64);
    let expected = whitecap::fraction(sea.wind.w10);
    [mean / expected, ((square - mean * mean) / instances as f64).sqrt() / expected]
}

/// Shares of whitecaps seen from above under a source above, over Eq. 51's fraction: exact statistics, and the sea from afar.
fn from_above(sea: &Water) -> [f64; 2] {
    let overhead = Engagement::far(0.0, 10e3, &[[0.0, 0.0, 1.0]], 100e3).unwrap();
    let exact = Exact::new(sea).unwrap().means(&overhead)[0].whitecaps;
    let mut parameters = sea.parameters;
    (parameters.surface, parameters.average) = (Surface::Ensemble, Average::Report);
    let afar = EnsembleLobe::new(&parameters.configure().unwrap()).unwrap();
    let up = [0.0, 0.0, 1.0];
    let whitecaps = Parts::WHITECAPS;
    let afar = afar.eval_parts(up, up, whitecaps) / sea.local_lobe().whitecap_brdf;
    [exact, afar].map(|share| share / sea.whitecap_fraction)
}

/// Mean of the whitecaps' probability over Eq. 51's fraction on meshes of some seas, and its standard error.
fn on_meshes(sea: &Water, seas: u64) -> [f64; 2] {
    let layout = Layout { radius: 1e3, vertices: 4_000, opening: 0.01, ..Layout::default() };
    let ratio = |seed| {
        let mut sea = *sea;
        sea.parameters.seed = seed;
        let whitecaps = Mesh::new(&sea, &layout).unwrap().vertices(0.0).whitecaps;
        whitecaps.iter().map(|p| f64::from(*p)).sum::<f64>() / whitecaps.len() as f64 / sea.whitecap_fraction
    };
    let ratios: Vec<f64> = (0..seas).into_par_iter().map(ratio).collect();
    let mean = ratios.iter().sum::<f64>() / seas as f64;
    let error = ratios.iter().map(|x| (x - mean).powi(2)).sum::<f64>().sqrt() / seas as f64;
    [mean, error]
}

/// Whitecaps cover Eq. 51's fraction of every surface to 1 %, but for what draws leave open.
fn cover(w: f64, footprint: f64, components: u32, draws: u64, seas: u64) {
    let sea = sea(w, footprint, components, WhitecapOnset::Calibrated);
    let [drawn, error] = over_eq_51(&sea, draws);
    let [exact, afar] = from_above(&sea);
    let [mesh, mesh_error] = on_meshes(&sea, seas);
    println!(
        "| {w} | {footprint} | {components} | {drawn:.3} +- {error:.3} | {exact:.3} | {afar:.3} | {mesh:.3} +- {mesh_error:.3} |"
    );
    let shares = [(drawn, error), (exact, 0.0), (afar, 0.0), (mesh, mesh_error)];
    for (found, error) in shares {
        assert!((found - 1.0).abs() < 0.01 + 4.0 * error, "w* {w} D {footprint} M {components}: {shares:?}");
    }
}

/// A few of the seas of the next test.
#[test]
fn calibrated_whitecaps_cover_the_fraction() {
    for (w, footprint, components, draws) in [
        (24.0, 0.3, 5, 200_000),
        (40.0, 0.15, 20, 100_000),
        (56.0, 0.02, 5, 100_000),
        (56.0, 10.0, 5, 100_000),
        (62.9, 0.1, 100, 20_000),
    ] {
        cover(w, footprint, components, draws, 8);
    }
}

#[test]
#[ignore = "long: `cargo xtask verify` runs it"]
fn calibrated_whitecaps_cover_the_fraction_everywhere() {
    println!("| w*, cm/s | D, m | M | draws | exact | ensemble | mesh |");
    println!("| --- | --- | --- | --- | --- | --- | --- |");
    for w in [12.0, 24.0, 40.0, 56.0, 62.9] {
        for footprint in [0.02, 0.05, 0.1, 0.15, 0.3, 1.0, 10.0] {
            for components in [5, 20, 100] {
                cover(w, footprint, components, 4_000_000 / u64::from(components), 32);
            }
        }
    }
}

/// Where the footprint changes from place to place they cover the fraction at every footprint, also between the rows of the
/// table of onsets and beyond.
#[test]
fn whitecaps_of_fading_waves_cover_the_fraction() {
    for w in [24.0, 56.0] {
        let sea = sea(w, 0.1, 20, WhitecapOnset::Calibrated);
        let (waves, onsets) = (sea.fading_waves(), OnsetTable::new(&sea).unwrap());
        let instance = InstanceLobe::fading(&sea).unwrap();
        for footprint in [0.1f64, 0.137, 3.0, 1e4] {
            let onset = onsets.at(footprint.log2());
            let [ratio, error] = mean_over_eq_51(&sea, 300_000, |numbers| {
                let seen = waves.components(numbers).map(|c| c.seen_at(footprint));
                onset.probability(RealisedSurface::new(seen, 0.0).point([0.0; 2]).acceleration)
            });
            println!("w* {w} D {footprint}: {ratio:.3} +- {error:.3}");
            assert!(
                (ratio - 1.0).abs() < 0.01 + 4.0 * error && error < 0.04,
                "w* {w} D {footprint}: {ratio} +- {error}"
            );
            let local = instance.local([3.0, 4.0], Some(footprint)).whitecap;
            let seen = instance.components().iter().map(|c| c.seen_at(footprint));
            let acceleration = RealisedSurface::new(seen, 0.0).point([3.0, 4.0]).acceleration;
            assert!((local - onset.probability(acceleration)).abs() < 1e-6, "{local}");
        }
    }
    // Eqs. 53-54 of the drawn waves alone are the same everywhere.
    assert!(OnsetTable::new(&sea(24.0, 0.1, 20, WhitecapOnset::Ramp)).is_none());
}

/// What whitecaps alone reflect, seen at 75 degrees under a source overhead, is within 10 % the same whatever the footprint.
#[test]
fn whitecaps_alone_do_not_follow_the_footprint() {
    let mut found = vec![];
    for footprint in [0.02, 0.05, 0.1, 0.15, 0.3, 1.0, 10.0] {
        let mut parameters = sea(56.0, footprint, 5, WhitecapOnset::Calibrated).parameters;
        parameters.surface = Surface::Ensemble;
        let lobe = EnsembleLobe::new(&parameters.configure().unwrap()).unwrap();
        let (sin, cos) = 75.0f64.to_radians().sin_cos();
        let f = |parts| lobe.eval_parts([0.0, 0.0, 1.0], [sin, 0.0, cos], parts);
        let [all, whitecaps] = [Parts::ALL, Parts::WHITECAPS].map(f);
        println!("D {footprint}: f {all:.3e}, of whitecaps {whitecaps:.3e}");
        found.push(whitecaps);
    }
    let [low, high] =
        [found.iter().fold(f64::MAX, |a, b| a.min(*b)), found.iter().fold(0.0, |a: f64, b| a.max(*b))];
    assert!(high < 1.1 * low, "{found:?}");
}

/// Crests break: where whitecaps are calibrated they are where the drawn waves accelerate downwards, the more so the more
/// of the sea is drawn.
#[test]
fn calibrated_whitecaps_stand_on_crests() {
    for (footprint, least) in [(0.15, 3.0), (1.0, 1.3)] {
        let onset = sea(40.0, footprint, 20, WhitecapOnset::Calibrated).whitecap_onset().unwrap();
        let [crest, trough] = [-1.0, 1.0].map(|acceleration| onset.probability(acceleration));
        assert!(crest > least * trough, "D {footprint}: {crest} {trough}");
    }
}

/// The two readings of Eq. 53 that fall everywhere: alike from w* = 24.9 on, steps at -0.39 g and -alpha g below.
#[test]
fn both_readings_of_the_onset() {
    let at = |w: f64, reading, g: f64| {
        let onset = sea(w, 0.1, 5, reading).whitecap_onset().unwrap();
        onset.probability(0.01 * g * whitecap::GRAVITY)
    };
    for w in [12.0, 20.0, 24.0] {
        let alpha = 0.4448 - 0.0022 * w;
        for (reading, step) in [(WhitecapOnset::Ramp, 0.39), (WhitecapOnset::Step, alpha)] {
            assert_eq!([at(w, reading, -step - 1e-9), at(w, reading, -step + 1e-9)], [1.0, 0.0]);
        }
    }
    for g in [-0.5, -0.38, -0.35, -0.2] {
        let [ramp, step] = [WhitecapOnset::Ramp, WhitecapOnset::Step].map(|reading| at(56.0, reading, g));
        assert!((ramp - step).abs() < 1e-12);
    }
    assert!(at(56.0, WhitecapOnset::Step, -0.35) > 0.0 && at(56.0, WhitecapOnset::Step, -0.35) < 1.0);
}

/// Where D and M do not matter a calibrated onset is found whatever they are; where Eq. 51 has none there is none.
#[test]
fn onset_where_there_are_no_waves() {
    assert!(sea(0.4, 0.15, 5, WhitecapOnset::Calibrated).whitecap_onset().is_none());
    let off = water(40.0, |p| (p.surface, p.whitecaps) = (Surface::Instance, false));
    assert!(off.whitecap_onset().is_none());
}

/// Fig. 3: the mean of Eq. 53 over drawn surfaces follows Eq. 51 within 20 % from w* = 24 to 56, D = 0.10 m.
#[test]
fn whitecap_fraction() {
    for w in [24.0, 32.0, 40.0, 48.0, 56.0] {
        let [ratio, error] = over_eq_51(&sea(w, 0.10, 5, WhitecapOnset::Ramp), 400_000);
        assert!((ratio - 1.0).abs() + 4.0 * error < 0.2, "w* {w}: {ratio} +- {error}");
    }
}

/// Regression pins, not what ought to be: Eqs. 53-54 meet Eq. 51 at D = 0.10 m only, since the acceleration of drawn waves
/// depends on the shortest of them. Pins are of 8,000,000 draws (M = 100: 4,000,000). Who mends this changes them and the
/// table in docs/model.md.
#[test]
fn whitecaps_follow_the_footprint() {
    const FOOTPRINTS: [f64; 7] = [0.02, 0.05, 0.10, 0.15, 0.30, 1.0, 10.0];
    let of_five = [
        (24.0, [6.821, 2.214, 0.982, 0.621, 0.239, 0.0148, 0.0]),
        (40.0, [4.550, 1.940, 0.957, 0.619, 0.292, 0.0630, 0.0]),
        (56.0, [3.216, 1.710, 1.001, 0.711, 0.383, 0.1317, 0.0009]),
    ];
    let mut pins = vec![];
    for (w, ratios) in of_five {
        pins.extend(FOOTPRINTS.into_iter().zip(ratios).map(|(footprint, ratio)| (w, footprint, 5, ratio)));
    }
    pins.extend([(16.0, 0.15, 5, 0.891), (16.0, 0.15, 20, 1.378), (16.0, 0.15, 100, 1.541)]);
    for (w, footprint, components, pin) in pins {
        let [found, error] = over_eq_51(
            &sea(w, footprint, components, WhitecapOnset::Ramp),
            if pin > 0.5 { 200_000 } else { 400_000 },
        );
        let allowed = 4.0 * error + 0.01 * pin;
        assert!(
            (found - pin).abs() <= allowed,
            "regression pin: w* {w} D {footprint} M {components}: {found} +- {error} instead of {pin}"
        );
        // Rare ones excepted, a change by two fifths shows.
        assert!(pin < 0.02 || allowed < 0.4 * pin, "w* {w} D {footprint} M {components}: {allowed}");
    }
}

/// A strong wind's whitecaps under a vertical beam, at times in s.
fn under_a_beam(times: &[f64], presence: WhitecapMode, instances: u64) -> Samples {
    let mut water = sea(56.0, 0.15, 5, WhitecapOnset::Ramp);
    water.parameters.instances = instances;
    let ensemble = Ensemble { presence, ..Ensemble::new(&water).unwrap() };
    let beam = |time: &f64| {
        Engagement::new(*time, [0.0, 0.0, 1e3], Aim::Target([0.0; 3]), &[[0.0, 0.0, 1e3]]).unwrap()
    };
    ensemble.sample(&times.iter().map(beam).collect::<Vec<_>>(), &|_| ()).unwrap()
}

/// An instance has a whitecap at exactly those times at which the probability there exceeds a number of its own: none of
/// its times without one has a higher probability than one with it.
#[test]
fn one_random_number_serves_an_instance_at_all_times() {
    let times: Vec<f64> = (0..200).map(|t| 0.25 * f64::from(t)).collect();
    let [drawn, expected] =
        [WhitecapMode::Drawn, WhitecapMode::Expected].map(|p| under_a_beam(&times, p, 2000));
    // The lowest probability with a whitecap and the highest without, of every instance; and how often each was seen.
    let (mut lowest, mut highest, mut seen) = (vec![1.0f64; 2000], vec![0.0f64; 2000], [0, 0]);
    for time in 0..times.len() {
        for (drawn, expected) in drawn.of(time, 0).unwrap().zip(expected.of(time, 0).unwrap()) {
            let (i, hit, same) = (drawn.instance as usize, drawn.hit, expected.hit);
            assert_eq!(hit.position, same.position);
            if hit.whitecap == 1.0 {
                lowest[i] = lowest[i].min(same.whitecap);
                seen[0] += usize::from(same.whitecap < 1.0);
            } else {
                highest[i] = highest[i].max(same.whitecap);
                seen[1] += usize::from(same.whitecap > 0.0);
            }
        }
    }
    assert!(lowest.iter().zip(&highest).all(|(low, high)| high < low));
    // Probabilities between 0 and 1 came out both ways often enough for another number at another time to show.
    assert!(seen.iter().all(|n| *n > 500), "{seen:?}");
}

/// The number stays, the wave does not: of the whitecaps under a beam (w* = 56 cm/s, D = 0.15 m) 9 of 100 are there half a
/// second later, hardly more than with another number then. Regression pins, of 2,000,000 draws.
#[test]
fn whitecaps_do_not_last() {
    let times = [0.0, 0.1, 0.2, 0.5, 1.0];
    let [drawn, expected] =
        [WhitecapMode::Drawn, WhitecapMode::Expected].map(|p| under_a_beam(&times, p, 100_000));
    let at = |samples: &Samples, time: usize| -> Vec<f64> {
        samples.of(time, 0).unwrap().map(|s| s.hit.whitecap).collect()
    };
    let (first, chance) = (at(&drawn, 0), at(&expected, 0));
    for (time, pin) in [(1, 0.415f64), (2, 0.134), (3, 0.092), (4, 0.032)] {
        let both: f64 = first.iter().zip(at(&drawn, time)).map(|(a, b)| a * b).sum();
        let count: f64 = first.iter().sum();
        let (share, error) = (both / count, (pin * (1.0 - pin) / count).sqrt());
        assert!((share - pin).abs() < 4.0 * error, "regression pin: {share} +- {error} instead of {pin}");
        // With a number drawn anew at the second time.
        let anew: f64 = chance.iter().zip(at(&expected, time)).map(|(a, b)| a * b).sum();
        let anew = anew / chance.iter().sum::<f64>();
        assert!((share - anew).abs() < 0.03 + 4.0 * error, "{share} {anew}");
    }
}
