//! Whitecaps with a lifetime: how many there are, how long they last, and where they lie.

use crate::common::water;
use prob_water::foam::Foam;
use prob_water::mesh::Vertices;
use prob_water::surface::Component;
use prob_water::whitecap::{Onset, WhitecapOnset};
use prob_water::{
    Aim, Average, Engagement, Ensemble, Exact, InstanceLobe, Layout, Mesh, Parameters, RealisedSurface,
    Surface, Water, whitecap,
};
use rayon::prelude::*;

/// Of salt water, s.
const SALT: f64 = 3.85;

fn sea(w: f64, footprint: f64, components: u32, lifetime: f64) -> Water {
    water(w, |p| {
        p.surface = Surface::Instance;
        p.footprint = Some(footprint);
        p.components = components;
        p.whitecaps = true;
        p.whitecap_lifetime = lifetime;
    })
}

/// Of instances at a time in s over the origin: slope towards +x, acceleration, and the probability of a whitecap.
fn drawn(sea: &Water, instances: u64, time: f64) -> Vec<[f64; 3]> {
    let ensemble = Ensemble::new(sea).unwrap();
    let of = |instance| {
        let surface = RealisedSurface::new(ensemble.components(instance).1, time);
        let point = surface.point([0.0; 2]);
        [point.slope[0], point.acceleration, ensemble.whitecap(&surface, [0.0; 2], &point)]
    };
    (0..instances).into_par_iter().map(of).collect()
}

/// A mean and its standard error.
fn mean(values: impl Iterator<Item = f64> + Clone) -> [f64; 2] {
    let count = values.clone().count() as f64;
    let mean = values.clone().sum::<f64>() / count;
    let variance = values.map(|x| (x - mean).powi(2)).sum::<f64>() / count;
    [mean, (variance / count).sqrt()]
}

/// Waves are stationary: whatever the lifetime, whitecaps cover Eq. 51's fraction.
#[test]
fn foam_covers_the_fraction() {
    for (w, footprint, components, lifetime, instances) in [
        (40.0, 0.15, 5, SALT, 20_000),
        (56.0, 0.15, 20, SALT, 10_000),
        (56.0, 1.0, 5, 0.5, 40_000),
        (62.9, 0.15, 5, 20.0, 4_000),
    ] {
        let sea = sea(w, footprint, components, lifetime);
        let all = drawn(&sea, instances, 0.3);
        let [found, error] = mean(all.iter().map(|x| x[2])).map(|x| x / whitecap::fraction(sea.wind.w10));
        println!("w* {w} D {footprint} M {components} {lifetime} s: {found:.4} +- {error:.4}");
        assert!((found - 1.0).abs() < 0.01 + 4.0 * error && error < 0.03, "{found} +- {error}");
    }
}

/// What stands is left after dt with a probability of at least exp(-dt/tau), the more so the longer it lives.
#[test]
fn whitecaps_last_for_their_lifetime() {
    const INSTANCES: u64 = 20_000;
    const LATER: [f64; 4] = [0.1, 0.5, 1.0, 3.0];
    let beam = |time: f64| {
        Engagement::new(time, [0.0, 0.0, 1e3], Aim::Target([0.0; 3]), &[[0.0, 0.0, 1e3]]).unwrap()
    };
    let engagements: Vec<_> = std::iter::once(0.0).chain(LATER).map(beam).collect();
    let mut last = [0.0; LATER.len()];
    for lifetime in [0.0, 0.5, SALT] {
        let mut water = sea(56.0, 0.15, 5, lifetime);
        water.parameters.instances = INSTANCES;
        let samples = Ensemble::new(&water).unwrap().sample(&engagements, &|_| ()).unwrap();
        let at = |time: usize| samples.of(time, 0).unwrap().map(|s| s.hit.whitecap);
        let first: f64 = at(0).sum();
        for (n, dt) in LATER.into_iter().enumerate() {
            let share = at(0).zip(at(n + 1)).map(|(a, b)| a * b).sum::<f64>() / first;
            let least = if lifetime == 0.0 { 0.0 } else { (-dt / lifetime).exp() };
            let error = (least * (1.0 - least) / first).sqrt();
            println!("{lifetime} s: {share:.3} are left after {dt} s, at least {least:.3} +- {error:.3}");
            assert!(share >= least - 4.0 * error && error < 0.03, "{lifetime} s, {dt} s: {share} {least}");
            assert!(share > last[n], "{lifetime} s, {dt} s: {share} after {}", last[n]);
            last[n] = share;
        }
    }
}

/// The mean over the past, summed in steps 16 times as short that end at the time itself.
fn fine(surface: &RealisedSurface, onset: &Onset<f64>, lifetime: f64, period: f64) -> f64 {
    let step = period / 256.0;
    let count = (12.0 * lifetime / step) as u64;
    let sums = (0..count).map(|n| {
        let before = (n as f64 + 0.5) * step;
        let weight = (-before / lifetime).exp();
        [weight, weight * onset.probability(surface.acceleration_before(before, [3.0, -2.0]))]
    });
    let [all, sum] = sums.fold([0.0; 2], |[a, b], [x, y]| [a + x, b + y]);
    sum / all
}

/// 16 steps in the shortest period are enough: far within what separates seas, for smooth and for sharp onsets.
#[test]
fn steps_resolve_the_shortest_waves() {
    for (w, footprint, reading, allowed) in
        [(56.0, 0.15, WhitecapOnset::Calibrated, 0.01), (56.0, 0.05, WhitecapOnset::Ramp, 0.04)]
    {
        let mut sea = sea(w, footprint, 20, SALT);
        sea.parameters.whitecap_onset = reading;
        let ensemble = Ensemble::new(&sea).unwrap();
        let onset = ensemble.onset.unwrap();
        let highest = 100.0 * sea.wave_numbers().unwrap()[1];
        let period = std::f64::consts::TAU / (9.81 * highest).sqrt();
        let pairs: Vec<[f64; 2]> = (0..200)
            .into_par_iter()
            .map(|instance| {
                let surface = RealisedSurface::new(ensemble.components(instance).1, 7.7);
                let point = surface.point([3.0, -2.0]);
                [ensemble.whitecap(&surface, [3.0, -2.0], &point), fine(&surface, &onset, SALT, period)]
            })
            .collect();
        let [average, error] = mean(pairs.iter().map(|[_, fine]| *fine));
        let spread = error * (pairs.len() as f64).sqrt();
        let off = mean(pairs.iter().map(|[found, fine]| (found - fine).powi(2)))[0].sqrt();
        println!("D {footprint}: {average:.4}, standard deviation {spread:.4}, off by {off:.2e}");
        assert!(off < allowed * spread, "D {footprint}: {off} of {spread}");
    }
}

/// A short lifetime is none: whitecaps stand as the acceleration has them. Without one they do exactly.
#[test]
fn a_short_lifetime_is_none() {
    let onset = sea(56.0, 0.15, 5, 0.0).whitecap_onset().unwrap();
    let off = |lifetime: f64| {
        let all = drawn(&sea(56.0, 0.15, 5, lifetime), 2_000, 1.7);
        mean(all.iter().map(|[_, a, q]| (q - onset.probability(*a)).abs()))[0]
    };
    let all = [0.0, 1e-3, 0.1, 1.0].map(off);
    println!("{all:?}");
    assert!(all[0] == 0.0 && all[1] < 0.1 * all[3] && all[2] < 0.8 * all[3], "{all:?}");
}

/// Foam is left behind the crest that made it, on the side that faces the wind the waves come from, here +x: on average over
/// foam the slope falls that way. Where the acceleration alone decides it is level. So means over slopes are not those
/// without a lifetime, and what has no past refuses one.
#[test]
fn foam_lies_behind_crests() {
    let lean = |lifetime: f64| {
        let all = drawn(&sea(56.0, 0.15, 20, lifetime), 20_000, 0.0);
        let [spread, _] = mean(all.iter().map(|x| x[0] * x[0]));
        let [share, _] = mean(all.iter().map(|x| x[2]));
        mean(all.iter().map(|x| x[0] * x[2])).map(|x| x / share / spread.sqrt())
    };
    let [[none, error], [behind, lasting]] = [0.0, 0.2].map(lean);
    println!(
        "slope under foam over its standard deviation: {none:.3} +- {error:.3}, {behind:.3} +- {lasting:.3}"
    );
    assert!(none.abs() < 4.0 * error && behind < -0.05 - 4.0 * lasting, "{none} {behind}");
    for surface in [Surface::Ensemble, Surface::Empirical] {
        let parameters =
            Parameters { surface, average: Average::Report, ..sea(40.0, 0.15, 5, SALT).parameters };
        let refused = parameters.configure().unwrap_err();
        assert_eq!(refused.parameters(), ["whitecap_lifetime"]);
        assert!(refused.to_string().contains("whitecap_lifetime = 3.85"), "{refused}");
    }
    assert_eq!(Exact::new(&sea(40.0, 0.15, 5, SALT)).unwrap_err().parameters(), ["whitecap_lifetime"]);
    assert!(Exact::new(&sea(40.0, 0.15, 5, 0.0)).is_ok());
}

/// Of a film in steps of dt no vertex changes by more than dt/tau; without a lifetime many do.
#[test]
fn a_film_does_not_flicker() {
    const FRAME: f64 = 1.0 / 24.0;
    let layout = Layout { radius: 30.0, vertices: 1_000, opening: 40.0, ..Layout::default() };
    let largest = |lifetime: f64| {
        let mut sea = sea(56.0, 0.3, 128, lifetime);
        sea.parameters.seed = 4;
        let mesh = Mesh::new(&sea, &layout).unwrap();
        let frames: Vec<Vertices> = (0..6).map(|n| mesh.vertices(60.0 + FRAME * f64::from(n))).collect();
        let change = |a: &Vertices, b: &Vertices| {
            a.whitecaps.iter().zip(&b.whitecaps).map(|(a, b)| f64::from((a - b).abs())).fold(0.0, f64::max)
        };
        frames.windows(2).map(|pair| change(&pair[0], &pair[1])).fold(0.0, f64::max)
    };
    let [without, lasting] = [0.0, SALT].map(largest);
    println!(
        "from frame to frame: {without:.3} without a lifetime, {lasting:.4}, at most {:.4}",
        FRAME / SALT
    );
    assert!(lasting <= FRAME / SALT + 2e-4 && without > 5.0 * FRAME / SALT, "{lasting} {without}");
}

/// Meshes and the level surface have the mean over the past of the waves they show, summed in float64 one by one.
#[test]
fn every_surface_has_the_same_past() {
    const TIME: f64 = 2.5;
    let mut sea = sea(62.9, 0.1, 32, SALT);
    // Then the onset is the same on every ring.
    (sea.parameters.whitecap_onset, sea.parameters.time) = (WhitecapOnset::Ramp, TIME);
    let mesh = Mesh::new(&sea, &Layout { radius: 4.0, vertices: 100_000, ..Layout::default() }).unwrap();
    assert_eq!(mesh.grid.growth, 0.0);
    let (level, vertices) = (mesh.level(), mesh.vertices(TIME));
    let onset = sea.whitecap_onset().unwrap();
    let slow = |waves: &[Component], highest: f64, place| {
        let surface = RealisedSurface::new(waves.iter().copied(), TIME);
        let foam = Foam::new(SALT, highest).unwrap();
        foam.mean(TIME, |before| onset.probability(surface.acceleration_before(before, place)))
    };
    let seen = |waves: &[Component], footprint: f64| -> Vec<Component> {
        waves.iter().map(|c| c.seen_at(footprint)).filter(|c| c.amplitude > 0.0).collect()
    };
    let on_mesh = seen(&mesh.components, 0.1);
    let highest = on_mesh.iter().map(|c| c.frequency).fold(0.0, f64::max);
    let instance = InstanceLobe::fading(&sea).unwrap();
    let on_level = [0.1, 0.7].map(|footprint| (footprint, seen(instance.components(), footprint)));
    let fastest = sea.fading_waves().log_range.unwrap()[1].exp();
    let fastest = sea.fading_waves().spectrum.frequency(fastest);
    let mut most = 0.0f64;
    for (place, found) in level.texcoords.chunks(2).zip(&vertices.whitecaps).step_by(997) {
        let place = [place[0], place[1]].map(f64::from);
        let expected = slow(&on_mesh, highest, place);
        assert!((f64::from(*found) - expected).abs() < 1e-5, "{found} {expected}");
        most = most.max(expected);
        for (footprint, waves) in &on_level {
            let local = instance.local(place, Some(*footprint)).whitecap;
            let expected = slow(waves, fastest, place);
            assert!((local - expected).abs() < 1e-12, "{local} {expected}");
        }
    }
    assert!(most > 0.03, "{most}");
}
