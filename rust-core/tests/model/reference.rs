//! The core against vectors of an independent float64 implementation: 1e-10 relative.

use crate::common::{rows, texts};
use prob_water::spectrum::Spectrum;
use prob_water::{
    Fresnel, Lobe, Parameters, Readings, RealisedSurface, Salinity, SlopeMeasure, SlopeStatistics,
    SpectrumModel, Surface, Wind, slopes, whitecap, wind,
};

#[track_caller]
fn close(found: f64, expected: f64) {
    assert!((found - expected).abs() <= 1e-10 * expected.abs(), "{found} against {expected}");
}

fn water(friction_velocity: f64, footprint: f64, ior: f64, azimuth: f64) -> Parameters {
    Parameters {
        wind: Wind::FrictionVelocity(friction_velocity),
        wind_direction: azimuth.to_degrees(),
        footprint: Some(footprint),
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
        let found = SlopeStatistics::CoxMunk.variances(&wind, r[1]);
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
fn spectra() {
    for r in rows("spectrum") {
        let wind = Wind::FrictionVelocity(r[0]).profile().unwrap();
        let water = if r[1] == 1.0 { Salinity::Fresh } else { Salinity::Ocean };
        let s = Spectrum::new(SpectrumModel::Report, &wind, water, r[2], r[3]);
        for (found, expected) in
            [s.frequency(r[4]), s.density(r[4]), s.k0, s.k1, s.k2, s.k_min].into_iter().zip(&r[5..])
        {
            close(found, *expected);
        }
    }
}

/// The rows come by the components of an instance.
#[test]
fn surfaces() {
    let rows = rows("surface");
    for instance in rows.chunk_by(|a, b| a[..5] == b[..5]) {
        let r = &instance[0];
        let parameters = Parameters {
            depth: r[2],
            components: instance.len() as u32,
            surface: Surface::Instance,
            ..water(r[0], r[1], 1.33, r[3])
        };
        let waves = parameters.configure().unwrap().waves();
        let components = instance.iter().map(|r| {
            let c = waves.component(r[5], r[6], r[7]);
            close(100.0 * c.amplitude, r[8]);
            close(c.frequency, r[9]);
            c
        });
        let point = RealisedSurface::new(components, r[12]).point([0.01 * r[10], 0.01 * r[11]]);
        let found = [100.0 * point.height, point.slope[0], point.slope[1], 100.0 * point.acceleration];
        for (found, expected) in found.into_iter().zip(&r[13..]) {
            close(found, *expected);
        }
    }
}

#[test]
fn facets_about_any_normal() {
    let rows = rows("facet");
    let mut worst = 0.0f64;
    for r in &rows {
        let lobe = water(r[0], r[2], r[3], r[1]).configure().unwrap().local_lobe();
        let f = lobe.eval([r[4], r[5], r[6]], [r[7], r[8], r[9]], [r[10], r[11], r[12]]);
        if r[13] > 0.0 {
            worst = worst.max((f / r[13] - 1.0).abs());
        }
        close(f, r[13]);
    }
    assert!(worst < 4e-13, "regression pin 4e-13, of 2e-13 measured: {worst:e}");
}

/// The whole print and every equation of the facets by itself as printed, for both reflectances and slope measures, level
/// and tilted normals, winds along x and oblique. The rows are those of `validation/error_budget/printed_rows.py`, which
/// evaluates the printed equations to 50 digits. Each set of readings moves most of its rows, and none reads another's.
#[test]
fn facets_as_printed() {
    let (mut kinds, mut tilted, mut oblique) = ([0; 4], 0, 0);
    let mut moved = std::collections::BTreeMap::<_, [usize; 2]>::new();
    for row in texts("facet_as_printed") {
        let r: Vec<f64> = row.iter().take(16).map(|x| x.parse().unwrap()).collect();
        let readings: Readings = row[16].parse().unwrap();
        let printed = Parameters {
            wind_direction: r[1],
            fresnel: if r[4] == 1.0 { Fresnel::Exact } else { Fresnel::Schlick },
            slope_measure: if r[5] == 1.0 { SlopeMeasure::Slope } else { SlopeMeasure::Angle },
            readings,
            ..water(r[0], r[2], r[3], 0.0)
        };
        let [i, o, n] = [6, 9, 12].map(|k| [r[k], r[k + 1], r[k + 2]]);
        let f = |parameters: Parameters| parameters.configure().unwrap().local_lobe().eval(i, o, n);
        close(f(printed), r[15]);
        let changed = (f(Parameters { readings: Readings::CORRECTED, ..printed }) / r[15] - 1.0).abs() > 1e-6;
        let [rows, changes] = moved.entry(row[16].to_owned()).or_default();
        (*rows, *changes) = (*rows + 1, *changes + usize::from(changed));
        kinds[2 * r[4] as usize + r[5] as usize] += 1;
        tilted += usize::from(n[2] < 1.0);
        oblique += usize::from(r[1] != 0.0);
    }
    assert!(kinds == [120; 4] && tilted > 200 && oblique > 280, "{kinds:?} {tilted} {oblique}");
    assert_eq!(moved.len(), 7);
    for (readings, [rows, changes]) in moved {
        assert!(rows >= 40 && 4 * changes > rows, "{readings} changes {changes} of {rows} rows");
    }
}

/// The rows of `facet.csv` in float32 against float64 on the same float32 inputs, by the bound of the documentation: what
/// float32 has to keep, and not what was found, which is 3.5e-6 at worst on these rows.
#[test]
fn facets_in_float32() {
    let mut errors = Vec::new();
    for r in rows("facet") {
        let water = water(r[0], r[2], r[3], r[1]).configure().unwrap();
        let single: Lobe<f32> = water.local_lobe().cast();
        let v = |k: usize| [r[k] as f32, r[k + 1] as f32, r[k + 2] as f32];
        let wide = |v: [f32; 3]| v.map(f64::from);
        let (i, o, n) = (v(4), v(7), v(10));
        let mut gaussian = water.local_lobe();
        gaussian.facets.gram_charlier = false;
        let size = gaussian.eval(wide(i), wide(o), wide(n));
        let exact = water.local_lobe().eval(wide(i), wide(o), wide(n));
        if size > 1e-8 {
            errors.push((f64::from(single.eval(i, o, n)) - exact).abs() / size);
        }
    }
    errors.sort_by(f64::total_cmp);
    let (median, worst) = (errors[errors.len() / 2], errors[errors.len() - 1]);
    assert!(median < 1e-5 && worst < 1e-4, "median {median:e}, worst {worst:e}");
}
