//! The core against vectors of an independent float64 implementation: 1e-10 relative.

use prob_water::{Lobe, Parameters, Wind, slopes, whitecap, wind};

fn rows(name: &str) -> Vec<Vec<f64>> {
    let path = format!("{}/tests/data/{name}.csv", env!("CARGO_MANIFEST_DIR"));
    let mut reader = csv::Reader::from_path(path).unwrap();
    let rows: Vec<Vec<f64>> =
        reader.records().map(|r| r.unwrap().iter().map(|x| x.parse().unwrap()).collect()).collect();
    assert!(rows.len() > 10);
    rows
}

#[track_caller]
fn close(found: f64, expected: f64) {
    assert!((found - expected).abs() <= 1e-10 * expected.abs(), "{found} against {expected}");
}

fn water(friction_velocity: f64, footprint: f64, ior: f64, azimuth: f64) -> Parameters {
    Parameters {
        wind: Wind::FrictionVelocity(friction_velocity),
        wind_direction: azimuth.to_degrees(),
        footprint,
        ior: Some(ior),
        whitecaps: false,
        ..Parameters::default()
    }
}

#[test]
fn wind_profile() {
    for r in rows("wind") {
        let profile = Wind::FrictionVelocity(r[0]).profile().unwrap();
        for (found, expected) in
            [profile.roughness_height(), profile.w10, profile.w12_5, profile.w19_5].into_iter().zip(&r[1..])
        {
            close(found, *expected);
        }
        close(wind::friction_velocity(r[2], 10.0).unwrap(), r[0]);
        close(wind::friction_velocity(r[4], 19.5).unwrap(), r[0]);
    }
}

/// The floor of 1e-6 stands above the four smallest of the vectors.
#[test]
fn slope_variances() {
    for r in rows("slope_variance") {
        let wind = Wind::FrictionVelocity(r[0]).profile().unwrap();
        let found = slopes::variances(&wind, r[1]);
        close(found[0], r[2].max(slopes::VARIANCE_FLOOR));
        close(found[1], r[3].max(slopes::VARIANCE_FLOOR));
    }
}

#[test]
fn whitecaps() {
    for r in rows("whitecap") {
        let wind = Wind::FrictionVelocity(r[0]).profile().unwrap();
        close(whitecap::fraction(wind.w10), r[3]);
        assert!((whitecap::probability(r[0], r[1]) - r[2]).abs() <= 1e-10, "{r:?}");
    }
}

#[test]
fn facets_about_any_normal() {
    let rows = rows("facet");
    let mut worst = 0.0f64;
    for r in &rows {
        let lobe = water(r[0], r[2], r[3], r[1]).configure().unwrap().lobe;
        let f = lobe.eval([r[4], r[5], r[6]], [r[7], r[8], r[9]], [r[10], r[11], r[12]]);
        if r[13] > 0.0 {
            worst = worst.max((f / r[13] - 1.0).abs());
        }
        close(f, r[13]);
    }
    println!("{} facet rows, worst relative error {worst:.1e}", rows.len());
}

/// The same rows in float32 against float64 on the same float32 inputs, by the bound of the documentation.
#[test]
fn facets_in_float32() {
    let mut errors = Vec::new();
    for r in rows("facet") {
        let water = water(r[0], r[2], r[3], r[1]).configure().unwrap();
        let single: Lobe<f32> = water.lobe.cast();
        let v = |k: usize| [r[k] as f32, r[k + 1] as f32, r[k + 2] as f32];
        let wide = |v: [f32; 3]| v.map(f64::from);
        let (i, o, n) = (v(4), v(7), v(10));
        let mut gaussian = water.lobe;
        gaussian.facets.gram_charlier = false;
        let size = gaussian.eval(wide(i), wide(o), wide(n));
        let exact = water.lobe.eval(wide(i), wide(o), wide(n));
        if size > 1e-8 {
            errors.push((f64::from(single.eval(i, o, n)) - exact).abs() / size);
        }
    }
    errors.sort_by(f64::total_cmp);
    let (median, worst) = (errors[errors.len() / 2], errors[errors.len() - 1]);
    println!("{} rows: median {median:.1e}, worst {worst:.1e}", errors.len());
    assert!(median < 1e-5 && worst < 1e-4);
}
