//! Wave sums in lanes against the float64 reference, and phases against twice as many digits.

use crate::common::worse;
use prob_water::simd::SimdLevel;
use prob_water::surface::Component;
use prob_water::surface::Point;
use prob_water::{Draws, Ensemble, Parameters, RealisedSurface, Surface, WaveSums, Wind};
use std::f64::consts::TAU;

fn levels() -> impl Iterator<Item = SimdLevel> {
    SimdLevel::ALL.into_iter().filter(|level| level.is_available())
}

/// Places within 10 km.
fn places(count: usize) -> Vec<[f64; 2]> {
    (0..count).map(|n| [0.618_034, 0.754_878].map(|r| 2e4 * ((n as f64 * r).fract() - 0.5))).collect()
}

fn components(wind: f64, count: u32) -> Vec<Component> {
    let parameters = Parameters {
        wind: Wind::FrictionVelocity(wind),
        surface: Surface::Instance,
        footprint: Some(0.01),
        components: count,
        ..Parameters::default()
    };
    let sea =
        Ensemble { draws: Draws::Stratified, ..Ensemble::new(&parameters.configure().unwrap()).unwrap() };
    sea.components(0).1.collect()
}

/// Heights, slopes and accelerations are within 2e-6 of their standard deviations at 10 km and an hour.
#[test]
fn sums_follow_the_reference() {
    let places = places(300);
    for (wind, count) in [(2.0, 1), (8.0, 5), (24.0, 16), (24.0, 515), (97.0, 4000)] {
        let surface = RealisedSurface::new(components(wind, count).into_iter(), 3600.0);
        let sums = WaveSums::new(&surface);
        assert!(sums.len() >= count as usize && !sums.is_empty());
        let exact: Vec<_> = places.iter().map(|place| surface.point(*place)).collect();
        for level in levels() {
            let mut points = vec![Point::default(); places.len()];
            sums.points_on(level, &places, &mut points);
            for of in [
                |p: &Point| p.height,
                |p: &Point| p.slope[0],
                |p: &Point| p.slope[1],
                |p: &Point| p.acceleration,
            ] {
                let rms = (exact.iter().map(|p| of(p).powi(2)).sum::<f64>() / places.len() as f64).sqrt();
                let worst = exact.iter().zip(&points).map(|(a, b)| (of(a) - of(b)).abs()).fold(0.0, worse);
                assert!(worst < 2e-6 * rms, "{level:?}, {count} components: {:e}", worst / rms);
            }
        }
    }
}

/// A place has the same bits alone and among others.
#[test]
fn places_are_independent() {
    let sums = WaveSums::new(&RealisedSurface::new(components(24.0, 100).into_iter(), 5.0));
    let places = places(50);
    let mut all = vec![Point::default(); 50];
    sums.points(&places, &mut all);
    for (place, point) in places.iter().zip(&all) {
        let mut one = [Point::default()];
        sums.points(&[*place], &mut one);
        assert_eq!(one[0], *point);
    }
    let none = WaveSums::new(&RealisedSurface::new(std::iter::empty(), 0.0));
    none.points(&places, &mut all);
    assert!(none.is_empty() && all.iter().all(|p| *p == Point::default()));
}

/// An unevaluated sum of two float64 numbers.
#[derive(Clone, Copy)]
struct Double(f64, f64);

impl Double {
    fn add(self, b: Self) -> Self {
        let s = self.0 + b.0;
        let t = s - self.0;
        let e = (self.0 - (s - t)) + (b.0 - t) + self.1 + b.1;
        Self(s + e, e - ((s + e) - s))
    }

    /// Exactly.
    fn product(a: f64, b: f64) -> Self {
        let p = a * b;
        Self(p, a.mul_add(b, -p))
    }

    /// Modulo a turn, of 107 digits.
    fn turn(self) -> f64 {
        let n = (self.0 / TAU).round();
        let rest = self.add(Self::product(-n, TAU)).add(Self::product(-n, 2.449_293_598_294_706_4e-16));
        rest.0 + rest.1
    }
}

/// Phases are within 1e-4 rad, and far less, at 10 km and an hour, for wave numbers, frequencies and places taken as exact.
#[test]
fn phases_keep_their_digits() {
    let mut worst = [0.0f64; 2];
    for wave in components(24.0, 200) {
        let surface = RealisedSurface::new([wave].into_iter(), 3600.0);
        let sums = WaveSums::new(&surface);
        let (sin, cos) = wave.azimuth.sin_cos();
        for [x, y] in places(20) {
            let phase = Double(wave.phase, 0.0)
                .add(Double::product(wave.frequency, 3600.0))
                .add(Double::product(wave.wave_number * cos, x))
                .add(Double::product(wave.wave_number * sin, y));
            let exact = phase.turn();
            let error = |point: Point| {
                // Height and the slope along the wave are the cosine and the sine.
                let along = point.slope[0] * cos + point.slope[1] * sin;
                let found = (-along / wave.wave_number).atan2(point.height);
                (found - exact + TAU / 2.0).rem_euclid(TAU) - TAU / 2.0
            };
            let mut point = [Point::default()];
            sums.points(&[[x, y]], &mut point);
            let errors = [error(surface.point([x, y])), error(point[0])];
            worst = [0, 1].map(|m| worse(worst[m], errors[m].abs()));
        }
    }
    assert!(worst[0] < 1e-8 && worst[1] < 1e-6, "{worst:?}");
}
