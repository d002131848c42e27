//! Drawn surfaces against the integrals of their spectrum.

use crate::common::water;
use prob_water::spectrum::spreading;
use prob_water::surface::{Draws, InstanceRng, Waves};
use prob_water::{Surface, Water};
use rayon::prelude::*;
use std::f64::consts::PI;

fn sea(w: f64, footprint: f64, components: u32) -> Water {
    water(w, |p| {
        p.surface = Surface::Instance;
        p.footprint = Some(footprint);
        p.components = components;
        p.wind_direction = 40.0;
    })
}

/// Variances of the height, m^2, and of the slopes along and across the wind: integrals of the spectrum over
/// the wave numbers that are drawn.
fn integrals(waves: &Waves) -> [f64; 3] {
    let [low, high] = waves.log_range.unwrap();
    let n = 20_000;
    let step = (high - low) / f64::from(n);
    let mut sums = [0.0; 2];
    for i in 0..n {
        let k = (low + (f64::from(i) + 0.5) * step).exp();
        let energy = waves.spectrum.density(k) * k * step;
        sums[0] += 1e-4 * energy;
        sums[1] += k * k * energy;
    }
    let turn = PI / 1000.0;
    let along: f64 = (0..1000)
        .map(|i| {
            let angle = -0.5 * PI + (f64::from(i) + 0.5) * turn;
            spreading(angle) * angle.cos().powi(2) * turn
        })
        .sum();
    [sums[0], sums[1] * along, sums[1] * (1.0 - along)]
}

/// The mean of something over instances, at the place and time at which phases are drawn.
fn mean<const N: usize>(
    water: &Water,
    draws: Draws,
    instances: u64,
    of: impl Fn(prob_water::surface::Point) -> [f64; N] + Sync,
) -> [f64; N] {
    let waves = water.waves();
    let values: Vec<[f64; N]> = (0..instances)
        .into_par_iter()
        .map(|i| {
            let mut numbers = InstanceRng::new(draws, 9, i);
            numbers.next();
            of(waves.surface(numbers, 0.0).point([0.0; 2]))
        })
        .collect();
    std::array::from_fn(|m| values.iter().map(|v| v[m]).sum::<f64>() / instances as f64)
}

fn moments(point: prob_water::surface::Point) -> [f64; 3] {
    let (sin, cos) = 40f64.to_radians().sin_cos();
    let [x, y] = point.slope;
    [point.height.powi(2), (x * cos + y * sin).powi(2), (y * cos - x * sin).powi(2)]
}

/// Within 1 % at 100,000 draws, however the draws are spread.
#[test]
fn variances_of_height_and_slope() {
    for (w, footprint, components) in [(4.0, 0.05, 5), (8.0, 0.15, 5), (24.0, 0.3, 20), (56.0, 0.15, 10)] {
        let water = sea(w, footprint, components);
        let expected = integrals(&water.waves());
        for draws in [Draws::Random, Draws::Sobol] {
            let found = mean(&water, draws, 100_000, moments);
            for (name, (found, expected)) in
                ["height", "upwind", "crosswind"].iter().zip(found.iter().zip(expected))
            {
                let off = found / expected - 1.0;
                assert!(off.abs() < 0.01, "w* {w} {draws:?} {name}: {found} against {expected}");
            }
        }
    }
}

/// From w* = 16 on the resolved slopes' variance and the facets' together are 1.0 to 1.25 of Cox and Munk's, nearly
/// whatever the footprint.
#[test]
fn variance_is_shared_between_waves_and_facets() {
    for w in [16.0, 24.0, 40.0, 56.0] {
        let mut shares = vec![];
        for footprint in [0.05, 0.1, 0.15, 0.2, 0.3, 0.5] {
            let water = sea(w, footprint, 5);
            let [_, u, c] = integrals(&water.waves());
            let all = water.parameters.slopes.total(&water.wind);
            shares.push((u + c + water.variances[0] + water.variances[1]) / (all[0] + all[1]));
        }
        assert!(shares.iter().all(|s| (1.0..1.25).contains(s)), "w* {w}: {shares:?}");
        let (low, high) = shares.iter().fold((f64::MAX, 0.0f64), |(l, h), s| (l.min(*s), h.max(*s)));
        assert!(high - low < 0.1, "w* {w}: {shares:?}");
    }
}

/// Bounds hold, and slopes, acceleration and normal belong to the height.
#[test]
fn derivatives_and_bounds() {
    let water = sea(24.0, 0.15, 20);
    let waves = water.waves();
    for instance in 0..50 {
        let at = |time| waves.surface(InstanceRng::new(Draws::Random, 2, instance), time);
        let surface = at(3.0);
        let [x, y] = [17.0 + instance as f64, -40.0];
        let point = surface.point([x, y]);
        let h = 1e-4;
        let dx = (surface.height([x + h, y]) - surface.height([x - h, y])) / (2.0 * h);
        let dy = (surface.height([x, y + h]) - surface.height([x, y - h])) / (2.0 * h);
        assert!((point.slope[0] - dx).abs() < 1e-7 && (point.slope[1] - dy).abs() < 1e-7);
        let (before, after) = (at(3.0 - 1e-3).height([x, y]), at(3.0 + 1e-3).height([x, y]));
        let acceleration = (before + after - 2.0 * point.height) / 1e-6;
        assert!((point.acceleration - acceleration).abs() < 1e-3, "{acceleration} {}", point.acceleration);
        let n = point.normal();
        assert!(
            (n[0] + point.slope[0] * n[2]).abs() < 1e-15 && (crate::common::dot(n, n) - 1.0).abs() < 1e-14
        );
        for i in 0..2000 {
            let p = surface.point([f64::from(i) * 0.37, f64::from(i) * -0.11]);
            assert!(p.height.abs() <= surface.highest());
            assert!(p.slope[0].hypot(p.slope[1]) <= surface.steepest());
        }
    }
}

/// Eq. 31 with + omega t: crests travel away from where the wind comes from.
#[test]
fn waves_run_before_the_wind() {
    let waves = sea(8.0, 0.15, 1).waves();
    let wave = waves.component(0.01, 0.0, waves.wind_azimuth);
    let phase_speed = wave.frequency / wave.wave_number;
    let crest = |time: f64| {
        let surface = prob_water::RealisedSurface::new(std::iter::once(wave), time);
        let away = -phase_speed * time;
        let (sin, cos) = waves.wind_azimuth.sin_cos();
        surface.height([away * cos, away * sin])
    };
    for time in [0.0, 1.0, 100.0] {
        assert!((crest(time) - wave.amplitude).abs() < 1e-9);
    }
}

/// Components are the first of more components; no wind, no waves.
#[test]
fn instances_are_nested_and_calm_is_flat() {
    let list = |m| -> Vec<_> {
        let waves = sea(8.0, 0.15, m).waves();
        waves.components(InstanceRng::new(Draws::Random, 1, 4)).collect()
    };
    let (few, many) = (list(5), list(7));
    for (a, b) in few.iter().zip(&many) {
        assert_eq!((a.wave_number, a.phase, a.azimuth), (b.wave_number, b.phase, b.azimuth));
        assert!((a.amplitude / b.amplitude - (7f64 / 5.0).sqrt()).abs() < 1e-12);
    }
    for w in [0.0, 0.3] {
        let waves = sea(w, 0.15, 5).waves();
        assert!(waves.is_empty());
        let point = waves.surface(InstanceRng::new(Draws::Random, 1, 0), 5.0).point([3.0, 4.0]);
        assert_eq!((point.height, point.normal()), (0.0, [0.0, 0.0, 1.0]));
    }
}
