//! Swell beside the waves of the wind: its variances and directions, and what it leaves as it was.

use crate::common::water;
use prob_water::surface::{Component, InstanceRng};
use prob_water::{
    Aim, Draws, Engagement, Ensemble, Exact, Layout, Mesh, Parameters, Proposal, RealisedSurface, Spot,
    SpotShape, Surface, Water, whitecap,
};
use rayon::prelude::*;
use std::f64::consts::TAU;

fn parameters(w: f64, height: f64, period: f64) -> Parameters {
    water(w, |p| {
        p.surface = Surface::Instance;
        (p.footprint, p.components, p.whitecaps) = (Some(0.15), 5, true);
        (p.swell_height, p.swell_period, p.swell_direction) = (height, period, Some(70.0));
        p.wind_direction = 20.0;
    })
    .parameters
}

fn sea(w: f64, height: f64, period: f64) -> Water {
    parameters(w, height, period).configure().unwrap()
}

fn components(sea: &Water, draws: Draws, instance: u64) -> Vec<Component> {
    Ensemble { draws, ..Ensemble::new(sea).unwrap() }.components(instance).1.collect()
}

/// A mean and its standard error.
fn mean(values: &[f64]) -> [f64; 2] {
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    [mean, (values.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / count / count).sqrt()]
}

/// In a calm over deep water: every sea has the height's variance, H^2/16; over seas that of slopes is `k_p^2 H^2/16 beta/(lambda - 1)`, by the
/// fourth moment of the spectrum, and that of the acceleration alike; of slopes the share `1/2 + x/(2 sinh x)` with `x = pi/beta_d`
/// lies along the swell, whose mean direction is its own.
#[test]
fn variances_are_the_spectrums() {
    let (height, period) = (2.0f64, 10.0);
    let sea = sea(0.0, height, period);
    let (variance, peak) = (height * height / 16.0, TAU / period);
    let k = peak * peak / 9.81;
    let x = 12f64.sqrt() * (2.0f64 / 76.0).sqrt();
    let along = 0.5 + 0.5 * x / x.sinh();
    let fourth = 5.25 / 4.0;
    let expected = [
        k * k * variance * fourth * along,
        k * k * variance * fourth * (1.0 - along),
        peak.powi(4) * variance * fourth,
    ];
    for draws in [Draws::Random, Draws::Sobol, Draws::Stratified] {
        let rows: Vec<[f64; 5]> = (0..20_000u64)
            .into_par_iter()
            .map(|instance| {
                let all = components(&sea, draws, instance);
                let total = |of: &dyn Fn(&Component) -> f64| {
                    all.iter().map(|c| 0.5 * c.amplitude.powi(2) * of(c)).sum::<f64>()
                };
                assert!((total(&|_| 1.0) / variance - 1.0).abs() < 1e-12 && all.len() == 5);
                let off = |c: &Component| c.azimuth - 70f64.to_radians();
                [
                    total(&|c| (c.wave_number * off(c).cos()).powi(2)),
                    total(&|c| (c.wave_number * off(c).sin()).powi(2)),
                    total(&|c| c.frequency.powi(4)),
                    total(&|c| off(c).sin()),
                    RealisedSurface::new(all.iter().copied(), 3.0).height([5.0, 7.0]).powi(2),
                ]
            })
            .collect();
        let of = |column: usize| mean(&rows.iter().map(|row| row[column]).collect::<Vec<_>>());
        for (column, expected) in expected.into_iter().enumerate() {
            let [found, error] = of(column);
            println!("{draws:?}: {found:.4e} +- {error:.1e}, {expected:.4e}");
            assert!((found - expected).abs() < 4.0 * error && error < 0.02 * expected, "{found} {expected}");
        }
        let [sine, error] = of(3);
        assert!((sine / variance).abs() < 4.0 * error / variance && error < 0.01 * variance, "{sine}");
        let [found, error] = of(4);
        assert!((found - variance).abs() < 4.0 * error && error < 0.02 * variance, "{found} {variance}");
    }
}

/// One stratified sea of 256 components has the spectrum's slopes to 5 %: the last, of a 256th of the energy, has 3 to 6 % of them.
#[test]
fn a_stratified_sea_carries_the_swell() {
    let mut sea = sea(0.0, 3.0, 14.0);
    sea.parameters.components = 256;
    let k = (TAU / 14.0).powi(2) / 9.81;
    for instance in 0..20 {
        let all = components(&sea, Draws::Stratified, instance);
        let slopes: f64 = all.iter().map(|c| 0.5 * (c.amplitude * c.wave_number).powi(2)).sum();
        let expected = k * k * 9.0 / 16.0 * 5.25 / 4.0;
        assert!((slopes / expected - 1.0).abs() < 0.05, "{slopes} {expected}");
        assert!(all.windows(2).all(|pair| pair[0].frequency <= pair[1].frequency));
    }
}

/// Without a height its other parameters do nothing, and with one the wind's waves are the same, bit by bit.
#[test]
fn the_winds_waves_stay() {
    for draws in [Draws::Random, Draws::Sobol, Draws::Stratified] {
        for instance in 0..50 {
            let mut plain = parameters(8.0, 0.0, 12.0);
            plain.swell_direction = None;
            let plain = components(&plain.configure().unwrap(), draws, instance);
            assert_eq!(components(&sea(8.0, 0.0, 7.0), draws, instance), plain);
            let both = components(&sea(8.0, 1.5, 7.0), draws, instance);
            assert_eq!((&both[..5], both.len()), (&plain[..], 10));
        }
    }
}

/// Of a spot of 15 m the facets get the swell's slopes within, in a calm too: what the mean over the spot takes from drawn seas, along
/// the wind's axes, as if all its waves came from one direction. To 4 %: this is the eighth moment of the spectrum, of whose tail the
/// means' 128 frequencies leave out so much.
#[test]
fn facets_get_the_swells_slopes_within_a_spot() {
    let wide = Parameters { footprint: Some(15.0), ..parameters(0.0, 2.0, 12.0) };
    let sea = wide.configure().unwrap();
    let engagement =
        Engagement::new(0.0, [0.0, 0.0, 1e3], Aim::Target([0.0; 3]), &[[0.0, 0.0, 1e3]]).unwrap();
    let spot = Spot::new(&engagement, &wide, SpotShape::Circle).unwrap();
    let after = Ensemble::new(&sea).unwrap().over(spot).unwrap().water;
    let within = [0, 1].map(|axis| after.variances[axis] - sea.variances[axis]);
    let lost: Vec<f64> = (0..20_000)
        .map(|instance| {
            let taken = |c: &Component| 1.0 - (-(c.wave_number * 15.0).powi(2) / 16.0).exp();
            let slope = |c: &Component| 0.5 * (c.amplitude * c.wave_number).powi(2);
            components(&sea, Draws::Stratified, instance).iter().map(|c| slope(c) * taken(c)).sum()
        })
        .collect();
    let [expected, error] = mean(&lost);
    println!("{within:?}, together {expected:.3e} +- {error:.1e}");
    assert!(
        (within[0] + within[1] - expected).abs() < 4.0 * error + 0.04 * expected,
        "{within:?} {expected}"
    );
    // The swell comes 50 degrees from the wind.
    let share = within[0] / (within[0] + within[1]);
    assert!((share - 50f64.to_radians().cos().powi(2)).abs() < 1e-3, "{share}");
}

/// Whitecaps cover Eq. 51's fraction beside a swell, whose acceleration counts; a wind's onset alone would have more.
#[test]
fn whitecaps_cover_the_fraction_beside_a_swell() {
    let mut steep = parameters(40.0, 4.0, 8.0);
    (steep.footprint, steep.components) = (Some(1.0), 20);
    let sea = steep.configure().unwrap();
    let ensemble = Ensemble::new(&sea).unwrap();
    let alone = Parameters { swell_height: 0.0, ..steep }.configure().unwrap().whitecap_onset().unwrap();
    let rows: Vec<[f64; 2]> = (0..150_000u64)
        .into_par_iter()
        .map(|instance| {
            let surface = RealisedSurface::new(ensemble.components(instance).1, 0.0);
            let point = surface.point([0.0; 2]);
            [ensemble.whitecap(&surface, [0.0; 2], &point), alone.probability(point.acceleration)]
        })
        .collect();
    let of = |column: usize| {
        mean(&rows.iter().map(|row| row[column]).collect::<Vec<_>>())
            .map(|x| x / whitecap::fraction(sea.wind.w10))
    };
    let [[found, error], [naive, other]] = [of(0), of(1)];
    println!("{found:.4} +- {error:.4}, with the wind's onset {naive:.4} +- {other:.4}");
    assert!((found - 1.0).abs() < 0.01 + 4.0 * error && error < 0.02, "{found} +- {error}");
    assert!(naive > 1.05 + 4.0 * other, "{naive}");
    let fading = sea.fading_whitecap_onset(1.0).unwrap();
    let waves = sea.fading_waves();
    let values: Vec<f64> = (0..150_000u64)
        .into_par_iter()
        .map(|instance| {
            let mut numbers = InstanceRng::new(Draws::Random, 0, instance);
            numbers.next();
            let seen = waves.components(numbers).map(|c| c.seen_at(1.0));
            fading.probability(RealisedSurface::new(seen, 0.0).point([0.0; 2]).acceleration)
        })
        .collect();
    let [found, error] = mean(&values).map(|x| x / whitecap::fraction(sea.wind.w10));
    assert!((found - 1.0).abs() < 0.01 + 4.0 * error && error < 0.02, "fading: {found} +- {error}");
}

/// Draws by importance have the mean of plain ones, with a wind and in a calm, whose sea is not level any more.
#[test]
fn draws_by_importance_know_the_swell() {
    for w in [0.0, 4.0] {
        let mut sea = sea(w, 1.5, 9.0);
        sea.parameters.instances = 200_000;
        let (sin, cos) = 33f64.to_radians().sin_cos();
        let engagement =
            Engagement::new(0.0, [-5e3, 0.0, 8.66e3], Aim::Target([0.0; 3]), &[[1e4 * sin, 0.0, 1e4 * cos]])
                .unwrap();
        let of = |proposal| {
            let ensemble = Ensemble { proposal, ..Ensemble::new(&sea).unwrap() };
            let samples = ensemble.sample(std::slice::from_ref(&engagement), &|_| ()).unwrap();
            let statistics = samples.statistics(0, 0, &[]).unwrap();
            [statistics.mean, statistics.sem]
        };
        let [[plain, a], [slopes, b]] = [Proposal::Plain, Proposal::Slopes].map(of);
        println!("w* {w}: {plain:.4} +- {a:.4} plain, {slopes:.4} +- {b:.4} by importance");
        assert!((plain - slopes).abs() < 4.0 * a.hypot(b) && b < 0.05 * slopes, "{plain} {slopes}");
    }
}

/// On a mesh the swell's slopes that are not resolved any more are facets', as far as these have room: of all slopes less than a
/// fiftieth is missing anywhere for 2 m and 12 s.
#[test]
fn what_fades_joins_the_facets() {
    let mut parameters = parameters(8.0, 2.0, 12.0);
    parameters.components = 256;
    let water = parameters.configure().unwrap();
    let mesh = Mesh::new(&water, &Layout { vertices: 20_000, ..Layout::default() }).unwrap();
    let swell: f64 = mesh.components[256..].iter().map(|c| 0.5 * (c.amplitude * c.wave_number).powi(2)).sum();
    let sum = |d: f64| water.facet_variances(d).iter().sum::<f64>();
    let all = sum(f64::INFINITY) + swell;
    for footprint in [0.2, 5.0, 20.0, 50.0, 150.0, 1e3] {
        let lost: f64 = mesh
            .components
            .iter()
            .enumerate()
            .map(|(j, c)| {
                let (p, seen) = (c.wave_number * footprint / 3.0, c.seen_at(footprint));
                let kept = (3.0 + 2.0 * libm::j0(p) + libm::j0(std::f64::consts::SQRT_2 * p)) / 6.0;
                let of = |c: &Component| 0.5 * (c.amplitude * c.wave_number).powi(2);
                if j < 256 { of(&seen) * (1.0 - kept) } else { of(c) - of(&seen) * kept }
            })
            .sum();
        let missing = (sum(footprint) + lost - sum(mesh.facets(footprint))) / all;
        println!("D {footprint}: lost {:.4}, missing {missing:.4} of all slopes", lost / all);
        assert!((-1e-6..0.02).contains(&missing), "D {footprint}: {missing}");
    }
    // Near by every vertex has it.
    let near = Mesh::new(&water, &Layout { radius: 400.0, vertices: 20_000, ..Layout::default() }).unwrap();
    let heights: Vec<f64> = near.vertices(0.0).positions.chunks(3).map(|p| f64::from(p[2])).collect();
    assert!(mean(&heights.iter().map(|z| z * z).collect::<Vec<_>>())[0] > 0.1);
}

/// What is refused, by the parameter's name.
#[test]
fn refusals_name_the_swell() {
    let base = parameters(8.0, 2.0, 12.0);
    let refused = |p: Parameters, name: &str| {
        let error = p.configure().unwrap_err();
        assert_eq!(error.parameters(), [name], "{error}");
        println!("{error}");
    };
    refused(Parameters { surface: Surface::Ensemble, ..base }, "swell_height");
    refused(Parameters { surface: Surface::Empirical, ..base }, "swell_height");
    refused(Parameters { swell_height: 12.0, ..base }, "swell_height");
    refused(Parameters { depth: 3.0, swell_height: 4.0, ..base }, "swell_height");
    refused(Parameters { footprint: Some(25.0), ..base }, "footprint");
    refused(Parameters { footprint: Some(f64::INFINITY), ..base }, "footprint");
    assert_eq!(Exact::new(&base.configure().unwrap()).unwrap_err().parameters(), ["swell_height"]);
    assert!(Parameters { footprint: Some(15.0), ..base }.configure().is_ok());
    assert!(Parameters { surface: Surface::Flat, footprint: None, ..base }.configure().is_ok());
}
