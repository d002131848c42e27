//! Stages that are functions of a few numbers: wind, slopes, reflectance, shadowing, whitecaps.

use crate::Lines;
use prob_water::SlopeStatistics;
use prob_water::brdf::{Fresnel, Reflectance, fresnel::pure_water};
use prob_water::real::{IERFC, IERFC_END};
use prob_water::shadowing::cos_lambda;
use prob_water::slopes::{GramCharlier, WIDTH};
use prob_water::wind::{friction_velocity, highest_wind_speed, wind_speed};
use prob_water::{Real, Wind, whitecap};
use serde_json::json;
use std::f64::consts::TAU;

/// U^2 + C^2 to which tilts are drawn.
pub const REACH: f64 = 55.0;

pub fn write(lines: &mut Lines) {
    for _ in 0..lines.rows {
        wind(lines);
        slopes(lines);
        reflectance(lines);
        shadowing(lines);
        whitecaps(lines);
    }
}

fn wind(lines: &mut Lines) {
    let (w, height) = (lines.decades(0.05, 238.65), lines.decades(0.1, 100.0));
    lines.row("wind", json!([w, height]), json!({"float64": [wind_speed(w, height)]}));
    let speed = lines.decades(0.05, 1.0) * highest_wind_speed(height);
    let w = friction_velocity(speed, height).expect("below the highest");
    lines.row("inverse", json!([speed, height]), json!({"float64": [w]}));
}

fn slopes(lines: &mut Lines) {
    let (w, footprint) = (lines.wind(), lines.footprint());
    let profile = Wind::FrictionVelocity(w).profile().expect("within Table 1");
    let munk = SlopeStatistics::CoxMunk;
    lines.row("variances", json!([w, footprint]), json!({"float64": munk.variances(&profile, footprint)}));
    let [c21, c03] = munk.skewness(&profile);
    lines.row("skewness", json!([w]), json!({"float64": [c21, c03]}));

    let (r, psi) = (lines.uniform(0.0, REACH).sqrt(), lines.uniform(0.0, TAU));
    let x = [c21, c03, r * psi.cos(), r * psi.sin()];
    let polynomial = |[c21, c03, ..]: [f64; 4]| GramCharlier::new([c21, c03], munk.kurtosis(), false);
    let p = polynomial(x).eval(-x[2] / WIDTH, x[3] / WIDTH);
    lines.row("gram_charlier", json!(x), json!({"float64": [p]}));
    // In float32, of tilts that are float32 numbers in widths.
    let [u, c] = [-x[2] / WIDTH, x[3] / WIDTH].map(|tilt| tilt as f32);
    let rounded = [x[0], x[1], -f64::from(u) * WIDTH, f64::from(c) * WIDTH];
    let p = polynomial(rounded).cast::<f32>().eval(u, c);
    lines.row("gram_charlier", json!(rounded), json!({"float32": [f64::from(p)]}));
}

fn reflectance(lines: &mut Lines) {
    let ior = lines.uniform(1.1, 2.0);
    let cos = lines.zenith().cos();
    for (stage, fresnel) in [("schlick", Fresnel::Schlick), ("fresnel", Fresnel::Exact)] {
        let rho = Reflectance::new([ior, 0.0], fresnel).eval(cos);
        lines.row(stage, json!([ior, cos]), json!({"float64": [rho]}));
        let single = cos as f32;
        let rho = Reflectance::new([ior, 0.0], fresnel).cast::<f32>().eval(single);
        lines.row(stage, json!([ior, f64::from(single)]), json!({"float32": [f64::from(rho)]}));
    }
    let wavelength = lines.decades(0.2, 200.0);
    let [n, _] = pure_water(wavelength);
    lines.row("index", json!([wavelength]), json!({"float64": [n]}));
}

/// Fresnel's equations of a complex index.
pub fn absorption(lines: &mut Lines) {
    for _ in 0..lines.rows {
        let (n, k) = (lines.uniform(1.1, 2.0), lines.decades(1e-3, 3.0));
        let absorbing = Reflectance::new([n, k], Fresnel::Exact);
        let cos = lines.zenith().cos();
        lines.row("absorbing", json!([n, k, cos]), json!({"float64": [absorbing.eval(cos)]}));
        let single = cos as f32;
        let rho = absorbing.cast::<f32>().eval(single);
        lines.row("absorbing", json!([n, k, f64::from(single)]), json!({"float32": [f64::from(rho)]}));
    }
}

fn shadowing(lines: &mut Lines) {
    let x = if lines.one(&[true, false]) { lines.uniform(0.0, 9.0) } else { lines.decades(1e-8, 9.0) };
    lines.row("ierfc", json!([x]), json!({"float64": [x.ierfc()]}));
    let single = x as f32;
    // The polynomial of float32 without its rounding.
    let bounded = f64::from(single.min(IERFC_END));
    let polynomial = IERFC.iter().rev().fold(0.0, |sum, b| sum * bounded + f64::from(*b)).powi(2);
    let y = json!({"float32": [f64::from(single.ierfc())], "approximation": [polynomial]});
    lines.row("ierfc", json!([f64::from(single)]), y);

    let (theta, sigma) = (lines.zenith(), lines.decades(1e-3, 0.45));
    let (cos, spread) = (theta.cos(), sigma * theta.sin());
    lines.row("hidden", json!([cos, spread]), json!({"float64": [cos_lambda(cos, spread)]}));
    let (cos, spread) = (cos as f32, spread as f32);
    let x = json!([f64::from(cos), f64::from(spread)]);
    lines.row("hidden", x, json!({"float32": [f64::from(cos_lambda(cos, spread))]}));
}

fn whitecaps(lines: &mut Lines) {
    let w10 = lines.decades(0.01, 40.0);
    lines.row("foam", json!([w10]), json!({"float64": [whitecap::fraction(w10)]}));
    let (w, a) = (lines.wind(), lines.uniform(-1000.0, 1000.0));
    lines.row("breaking", json!([w, a]), json!({"float64": [whitecap::probability(w, a)]}));
    let wavelength = lines.decades(0.2, 20.0);
    lines.row("foam_brdf", json!([wavelength]), json!({"float64": [whitecap::brdf(wavelength)]}));
}
