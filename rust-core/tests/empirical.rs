//! The report's empirical model at single engagements, against the full one.

use prob_water::empirical::Node;
use prob_water::{Engagement, Ensemble, Parameters, Presence, Surface, Water, Wind};

fn sea(w: f64, wind_direction: f64, instances: u64) -> Water {
    let parameters = Parameters {
        wind: Wind::FrictionVelocity(w),
        wind_direction,
        surface: Surface::Instance,
        footprint: 0.15,
        instances,
        ior: Some(1.33),
        ..Parameters::default()
    };
    parameters.configure().unwrap()
}

fn degrees(first: i32, last: i32, step: usize) -> Vec<f64> {
    (first..=last).step_by(step).map(|t| f64::from(t).to_radians()).collect()
}

/// Widths across the plane, reduced to normal incidence, as an independent implementation found them: for a wind along the
/// plane and across it. At normal incidence the plane is the wind's.
#[test]
fn widths() {
    for (w, along, across) in [(8.0, 12.9, 15.7), (40.0, 25.0, 33.0)] {
        for (azimuth, expected) in [(0.0, along), (90.0, across)] {
            for incidence in [0.0f64, 30.0, 60.0] {
                let expected = if incidence == 0.0 { along } else { expected };
                let node = Node::new(&sea(w, azimuth, 2000), incidence.to_radians(), &[]).unwrap();
                let found = node.sigma.to_degrees();
                println!("w* {w} wind {azimuth} incidence {incidence}: {found:.2} deg, expected {expected}");
                // Eq. 89: over the cosine of the incidence it stays nearly the same.
                assert!((found / expected - 1.0).abs() < if incidence == 60.0 { 0.15 } else { 0.03 });
                assert!(node.fitted > 0.97 && node.u_sigma > 0.0 && node.u_delta > node.u_sigma);
            }
        }
    }
}

/// In the plane the numbers are the scenario engine's, at any wavelength.
#[test]
fn in_plane() {
    for (w, wavelength) in [(8.0, 0.55), (56.0, 1.064)] {
        let water = Parameters { wavelength, ior: None, ..sea(w, 0.0, 4000).parameters }.configure().unwrap();
        let thetas = degrees(-60, 80, 10);
        let node = Node::new(&water, 0.5, &thetas).unwrap();
        let directions: Vec<_> = thetas.iter().map(|t| node.planes.in_plane(*t)).collect();
        let engagement = Engagement::far(0.5f64.to_degrees(), 10e3, &directions, 100e3).unwrap();
        let full = Ensemble { presence: Presence::Drawn, ..Ensemble::new(&water).around(&engagement) };
        let samples = full.sample(&[engagement], &|_| ()).unwrap();
        let source = [-0.5f64.sin(), 0.0, 0.5f64.cos()];
        for (k, o) in directions.iter().enumerate() {
            let half = (0..3).map(|m| (source[m] + o[m]).powi(2)).sum::<f64>().sqrt() / 2.0;
            let rho = water.lobe.facets.reflectance.eval(half);
            let [mean, spread] = node.brdf(*o, rho, water.lobe.whitecap_brdf);
            let wanted = samples.statistics(0, k, &[]);
            let limit = 4.0 * wanted.sem + 1e-3 * wanted.mean;
            assert!((mean - wanted.mean).abs() < limit, "{w} {k}: {mean} {} {}", wanted.mean, wanted.sem);
            assert!(
                (spread - wanted.std).abs() < 0.1 * wanted.std + limit,
                "{w} {k}: {spread} {}",
                wanted.std
            );
        }
    }
}

/// Across the plane through the specular direction, against the full model to 1.5 sigma: Eq. 90 within 10 % of the mean and
/// Eq. 91 within 25 % of the relative spread for a wind along the plane. A wind across it skews the lobe, which the report's
/// Gaussian cannot follow: there that holds to 1 sigma alone.
#[test]
fn across_the_plane() {
    let mut worst = [0.0f64; 2];
    for (w, azimuth, incidence) in
        [(8.0, 0.0, 30.0f64), (8.0, 90.0, 30.0), (24.0, 0.0, 30.0), (24.0, 0.0, 50.0), (40.0, 90.0, 10.0)]
    {
        let water = Parameters { whitecaps: false, ..sea(w, azimuth, 6000).parameters }.configure().unwrap();
        let node = Node::new(&water, incidence.to_radians(), &degrees(-90, 90, 1)).unwrap();
        let steps = [-1.5, -1.0, -0.5, 0.0, 0.5, 1.0, 1.5];
        let sigma = node.sigma * incidence.to_radians().cos();
        let directions: Vec<_> = steps.iter().map(|s| node.planes.across(node.delta + s * sigma)).collect();
        let engagement = Engagement::far(incidence, 10e3, &directions, 100e3).unwrap();
        let samples = Ensemble::new(&water).around(&engagement).sample(&[engagement], &|_| ()).unwrap();
        let (sin, cos) = incidence.to_radians().sin_cos();
        for (k, (o, step)) in directions.iter().zip(steps).enumerate() {
            let source = [-sin, 0.0, cos];
            let half = (0..3).map(|m| (source[m] + o[m]).powi(2)).sum::<f64>().sqrt() / 2.0;
            let [mean, spread] = node.brdf(*o, water.lobe.facets.reflectance.eval(half), 0.0);
            let wanted = samples.statistics(0, k, &[]);
            let off = [mean / wanted.mean - 1.0, spread / mean / (wanted.std / wanted.mean) - 1.0];
            println!(
                "w* {w} wind {azimuth} incidence {incidence} at {step:+.1} sigma: mean {:+.3}, relative spread {:.2} of {:.2}",
                off[0],
                spread / mean,
                wanted.std / wanted.mean
            );
            if azimuth == 0.0 || step.abs() < 1.25 {
                worst = [0, 1].map(|m| worst[m].max(off[m].abs()));
            }
        }
    }
    println!("worst: mean {:.3}, relative spread {:.3}", worst[0], worst[1]);
    assert!(worst[0] < 0.1 && worst[1] < 0.25);
}
