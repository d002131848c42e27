//! Places of their own: a footprint that changes, and one drawn sea on a level surface.

use crate::common::worse;
use prob_water::brdf::up;
use prob_water::{EnsembleLobe, FacetTable, Hiding, InstanceLobe, Parameters, SlopeMeasure, Surface, Wind};
use std::f64::consts::PI;

fn direction(theta: f64, phi: f64) -> [f64; 3] {
    let (sin, cos) = theta.to_radians().sin_cos();
    [sin * phi.cos(), sin * phi.sin(), cos]
}

/// Facets from the table are those of a sea configured for the footprint.
#[test]
fn tabulated_facets() {
    let mut worst = 0.0f64;
    for w in [0.0, 2.0, 8.0, 24.0, 120.0] {
        for (slope_measure, hiding) in [
            (SlopeMeasure::Angle, Hiding::Report),
            (SlopeMeasure::Slope, Hiding::Report),
            (SlopeMeasure::Angle, Hiding::Once),
        ] {
            let wind = Wind::FrictionVelocity(w);
            let parameters =
                Parameters { wind, slope_measure, hiding, gram_charlier: false, ..Parameters::default() };
            let table = FacetTable::new(&parameters.configure().unwrap());

            for footprint in [3.1e-3, 0.0177, 0.15, 0.61, 4.7, 133.0, 2.2e4, f64::INFINITY] {
                // There `hiding` is the report's either way, unless the footprint varies.
                if hiding == Hiding::Once && footprint.is_infinite() {
                    continue;
                }
                let exact = Parameters { footprint: Some(footprint), ..parameters }
                    .configure()
                    .unwrap()
                    .local_lobe()
                    .facets;
                let mut found = parameters.configure().unwrap().local_lobe().facets;
                table.set(&mut found, footprint);
                let sigma = (found.sigma_u / exact.sigma_u - 1.0).abs();
                assert!(sigma < if footprint < 0.01 { 1e-3 } else { 1e-4 }, "{w} {footprint} {sigma}");
                for theta in [0.0, 30.0, 60.0, 80.0] {
                    for (to, phi) in [(0.0, 1.0), (30.0, 3.0), (60.0, 3.5), (80.0, 2.5)] {
                        let (i, o) = (direction(theta, 0.0), direction(to, phi));
                        let (a, b) = (exact.eval(i, o, up()), found.eval(i, o, up()));
                        // A relative error of sigma counts U^2 + C^2 times.
                        let h = [i[0] + o[0], i[1] + o[1], i[2] + o[2]];
                        let tilts = [h[0] / h[2] / exact.sigma_u, h[1] / h[2] / exact.sigma_c];
                        let far = tilts[0] * tilts[0] + tilts[1] * tilts[1];
                        if far < 25.0 {
                            worst = worse(worst, (b / a - 1.0).abs());
                        }
                    }
                }
            }
        }
    }
    assert!(worst < 2e-3, "{worst}");
}

/// The mean over places and seeds is the sea from afar, within 4 standard errors.
#[test]
fn instances_average_to_the_ensemble() {
    for (w, components) in [(8.0, 5), (24.0, 20)] {
        let parameters = Parameters {
            wind: Wind::FrictionVelocity(w),
            surface: Surface::Ensemble,
            footprint: Some(0.15),
            components,
            shadowing: false,
            wind_direction: 25.0,
            ..Parameters::default()
        };
        let ensemble = EnsembleLobe::new(&parameters.configure().unwrap()).unwrap();
        let cases = [(0.0, 20.0, 2.0), (30.0, 20.0, PI), (30.0, 45.0, 2.8), (50.0, 40.0, 3.3)];
        let (seeds, places) = (3000, 16);
        let mut sums = [[0.0; 2]; 4];
        for seed in 0..seeds {
            let water = Parameters { surface: Surface::Instance, seed, ..parameters }.configure().unwrap();
            let instance = InstanceLobe::new(&water).unwrap();
            for (sum, (theta, to, phi)) in sums.iter_mut().zip(cases) {
                let (i, o) = (direction(theta, 0.0), direction(to, phi));
                // Far from each other.
                let place = |k: i32| [f64::from(k % 4) * 317.3, f64::from(k / 4) * 173.9];
                let mean =
                    (0..places).map(|k| instance.eval(i, o, place(k))).sum::<f64>() / f64::from(places);
                sum[0] += mean;
                sum[1] += mean * mean;
            }
        }
        for ([sum, square], (theta, to, phi)) in sums.into_iter().zip(cases) {
            let n = seeds as f64;
            let mean = sum / n;
            let error = ((square / n - mean * mean) / n).sqrt();
            let (i, o) = (direction(theta, 0.0), direction(to, phi));
            let wanted = ensemble.eval(i, o) * o[2];
            let off = (mean - wanted) / error;
            assert!(
                off.abs() < 4.0 && error < 0.02 * mean,
                "w* {w} {theta} -> {to}: {mean} +- {error}, not {wanted}"
            );
        }
    }
}
