//! Means over drawn surfaces: exact ones, the sea from afar, and the empirical table.

use crate::Lines;
use prob_water::{EmpiricalLobe, Engagement, EnsembleLobe, Exact, Parameters, Surface, Table, Wind};
use serde_json::json;

/// Laser and observers are so far away, m, that directions do not depend on where a wave is met.
const DISTANCE: f64 = 1e6;

pub fn write(lines: &mut Lines) {
    exact(lines);
    ensemble(lines);
    empirical(lines);
}

fn sea(surface: Surface, w: f64, footprint: f64) -> Parameters {
    Parameters {
        wind: Wind::FrictionVelocity(w),
        wind_direction: 25.0,
        surface,
        footprint: Some(footprint),
        whitecaps: false,
        ..Parameters::default()
    }
}

/// A laser at an angle of incidence and observers in the plane of incidence, degrees.
fn views(incidence: f64, thetas: impl Iterator<Item = f64>) -> Engagement {
    let directions: Vec<_> = thetas
        .map(|theta| {
            let (s, c) = theta.to_radians().sin_cos();
            [s, 0.0, c]
        })
        .collect();
    Engagement::far(incidence, DISTANCE, &directions, DISTANCE).expect("the engagement is valid")
}

/// Means without obscuration, whose integral can be done otherwise.
fn exact(lines: &mut Lines) {
    let seas = (lines.rows / 200).clamp(1, 3);
    for (w, footprint, incidence) in
        [(8.0, 0.15, 30.0), (24.0, 0.15, 60.0), (56.0, 0.05, 45.0)].into_iter().take(seas)
    {
        let water = sea(Surface::Instance, w, footprint).configure().expect("the parameters are valid");
        let mut exact = Exact::new(&water).expect("M is 5");
        exact.obscuration = false;
        let engagement = views(incidence, (0..4).map(|k| incidence - 20.0 + 12.0 * f64::from(k)));
        for (mean, [i, o]) in exact.means(&engagement).into_iter().zip(engagement.ways()) {
            let x = json!([w, footprint, 25.0, water.ior, i, o]);
            lines.row("exact", x, json!({"float64": [mean.f]}));
        }
    }
}

/// The lobe from afar and the exact mean that it stands for, both as f cos theta_r; where the mean is above 1 % of its peak.
fn ensemble(lines: &mut Lines) {
    let seas = (lines.rows / 200).clamp(1, 4);
    for (w, footprint) in [(8.0, 0.15), (24.0, 0.3), (56.0, 0.15), (4.0, 0.15)].into_iter().take(seas) {
        let water = sea(Surface::Ensemble, w, footprint).configure().expect("the parameters are valid");
        let lobe = EnsembleLobe::new(&water).expect("M is 5");
        let exact = Exact::new(&water).expect("M is 5");
        for incidence in [0.0, 30.0, 60.0, 75.0] {
            let engagement = views(incidence, (-17..=17).map(|k| 5.0 * f64::from(k)));
            let means = exact.means(&engagement);
            let peak = means.iter().map(|m| m.f_cos).fold(0.0, f64::max);
            for (mean, [i, o]) in
                means.into_iter().zip(engagement.ways()).filter(|(m, _)| m.f_cos > 0.01 * peak)
            {
                let x = json!([incidence, o[2].acos().to_degrees(), mean.f_cos]);
                lines.row("ensemble", x, json!({"float64": [lobe.eval(i, o) * o[2]]}));
            }
        }
    }
}

/// The table between its nodes, in the plane of incidence, where waves hide nothing and the exact mean is what the nodes
/// hold.
fn empirical(lines: &mut Lines) {
    let table = Table::standard();
    let seas = (lines.rows / 150).clamp(1, 20);
    for _ in 0..seas {
        let parameters = Parameters {
            whitecaps: true,
            whitecap_onset: Table::standard().parameters.whitecap_onset,
            wind_direction: lines.uniform(0.0, 360.0),
            ..sea(Surface::Empirical, lines.decades(2.0, 24.0), lines.decades(0.05, 0.5))
        };
        let water = parameters.configure().expect("the parameters are valid");
        let lobe = EmpiricalLobe::new(&water, table).expect("the table knows this sea");
        let mut exact = Exact::new(&water).expect("M is 5");
        exact.obscuration = false;
        let incidence = lines.uniform(1.0, 50.0);
        let engagement = views(incidence, (-10..=11).map(|k| 5.0 * f64::from(k)));
        let means = exact.means(&engagement);
        let peak = means.iter().map(|m| m.f).fold(0.0, f64::max);
        for (mean, [i, o]) in means.into_iter().zip(engagement.ways()).filter(|(m, _)| m.f > 0.01 * peak) {
            let (estimate, f32) = (lobe.estimate(i, o), lobe.eval(i.map(|x| x as f32), o.map(|x| x as f32)));
            let y = json!({"float64": [estimate.mean], "float32": [f64::from(f32)]});
            lines.row("empirical", json!([incidence, mean.f]), y);
        }
    }
}
