//! The BRDF and its draws. What a lobe does not show is isolated by parameters: without shadowing and Gram-Charlier f is
//! the Gaussian of the tilts, with and without shadowing their ratio is G.

use crate::Lines;
use crate::scalars::REACH;
use prob_water::batch::Columns;
use prob_water::brdf::up;
use prob_water::real::{Vec3, dot};
use prob_water::{Fresnel, Lobe, Parameters, SlopeMeasure, Water, Wind};
use serde_json::{Value, json};
use std::f64::consts::{FRAC_PI_2, TAU};

/// Pairs of directions of every sea.
const PAIRS: usize = 20;

/// A sea and the number that lines know it by.
struct Sea {
    id: usize,
    water: Water,
}

pub fn write(lines: &mut Lines) {
    let tilted = |lines: &mut Lines| {
        let (slope, azimuth) = (lines.uniform(0.0, 0.6), lines.uniform(0.0, TAU));
        let z = 1.0 / (1.0 + slope * slope).sqrt();
        [slope * azimuth.cos() * z, slope * azimuth.sin() * z, z]
    };
    let level = |_: &mut Lines| up();
    for _ in 0..lines.rows.div_ceil(PAIRS) {
        let all = any(lines);
        let gaussian = Parameters { gram_charlier: false, shadowing: false, ..all };
        let shadowed = Parameters { gram_charlier: false, ..all };
        let foamy = Parameters { whitecaps: true, ..all };
        f_rows(lines, "gaussian", &[gaussian], level);
        f_rows(lines, "shadowing", &[shadowed, gaussian], level);
        f_rows(lines, "f", &[all], level);
        f_rows(lines, "f_tilted", &[all], tilted);
        f_rows(lines, "f_foamy", &[foamy], level);
        draws(lines, all);
        steep(lines);
    }
}

/// Any sea, without whitecaps.
fn any(lines: &mut Lines) -> Parameters {
    Parameters {
        wind: Wind::FrictionVelocity(lines.wind()),
        wind_direction: lines.uniform(0.0, 360.0),
        footprint: Some(lines.footprint()),
        ior: Some(lines.uniform(1.2, 1.6)),
        fresnel: lines.one(&[Fresnel::Schlick, Fresnel::Exact]),
        slope_measure: lines.one(&[SlopeMeasure::Angle, SlopeMeasure::Slope]),
        whitecaps: false,
        ..Parameters::default()
    }
}

/// Configures and describes a sea.
fn sea(lines: &mut Lines, p: Parameters) -> Sea {
    let water = p.configure().expect("the parameters are valid");
    let id = lines.seas;
    lines.seas += 1;
    lines.write(&json!({
        "sea": id, "friction_velocity": water.wind.friction_velocity, "footprint": water.footprint,
        "wind_direction": p.wind_direction, "ior": water.ior, "exact": p.fresnel == Fresnel::Exact,
        "slope": p.slope_measure == SlopeMeasure::Slope, "gram_charlier": p.gram_charlier, "shadowing": p.shadowing,
        "whitecaps": p.whitecaps, "wavelength": p.wavelength,
        "stretch": water.local_lobe().facets.proposal[0] / water.local_lobe().facets.sigma_u,
    }));
    Sea { id, water }
}

/// Rows of f by every one of some seas that differ in switches.
fn f_rows(lines: &mut Lines, stage: &str, of: &[Parameters], normal: impl Fn(&mut Lines) -> Vec3<f64>) {
    let seas: Vec<Sea> = of.iter().map(|p| sea(lines, *p)).collect();
    let ids: Vec<_> = seas.iter().map(|sea| sea.id).collect();
    for _ in 0..PAIRS {
        let n = normal(lines);
        let [i, o] = pair(lines, &seas[0].water, n);
        let f: Vec<_> = seas.iter().map(|sea| sea.water.local_lobe().eval(i, o, n)).collect();
        lines.row(stage, json!([ids, i, o, n]), json!({"float64": f}));
        let [i, o, n] = [i, o, n].map(single);
        let mut y = json!({});
        for (name, f) in singles(&seas, i, o, n) {
            y[name] = f;
        }
        lines.row(stage, json!([ids, double(i), double(o), double(n)]), y);
    }
}

/// f in every kind of float32, by its name: scalars, and the best lanes that this processor has. Level normals are left out,
/// as a flat sea leaves them.
fn singles(seas: &[Sea], i: Vec3<f32>, o: Vec3<f32>, n: Vec3<f32>) -> Vec<(&'static str, Value)> {
    let scalar: Vec<_> =
        seas.iter().map(|sea| f64::from(sea.water.local_lobe().cast::<f32>().eval(i, o, n))).collect();
    let normals = (n != up::<f32>()).then_some(&n);
    let columns = [&i, &o].map(|v| v.each_ref().map(std::slice::from_ref));
    let normals = normals.map(|n| n.each_ref().map(std::slice::from_ref));
    let columns = Columns::new(columns[0], columns[1], normals).expect("unit vectors");
    let lanes = |sea: &Sea| {
        let mut f = [0.0];
        columns.eval(&sea.water.local_lobe().cast(), &mut f).expect("one row");
        f64::from(f[0])
    };
    let lanes: Vec<_> = seas.iter().map(lanes).collect();
    vec![("float32", json!(scalar)), ("lanes", json!(lanes))]
}

/// The density of draws, and draws.
fn draws(lines: &mut Lines, p: Parameters) {
    let sea = sea(lines, p);
    let lobe: Lobe<f64> = sea.water.local_lobe();
    let lobe32: Lobe<f32> = lobe.cast();
    for _ in 0..PAIRS {
        let n = up();
        let [i, o] = pair(lines, &sea.water, n);
        let u = [(); 3].map(|()| lines.uniform(0.0, 1.0 - 1e-9));
        lines.row("pdf", json!([[sea.id], i, o, n]), json!({"float64": [lobe.pdf(i, o, n)]}));
        let drawn = lobe.sample(i, n, u);
        lines.row("draw", json!([sea.id, i, u]), json!({"float64": drawn.direction}));
        let (i, o, u) = (single(i), single(o), u.map(|u| (u as f32).min(1.0 - f32::EPSILON / 2.0)));
        let pdf = f64::from(lobe32.pdf(i, o, up()));
        lines.row("pdf", json!([[sea.id], double(i), double(o), n]), json!({"float32": [pdf]}));
        let drawn = lobe32.sample(i, up(), u);
        let x = json!([sea.id, double(i), double(u)]);
        lines.row("draw", x, json!({"float32": double(drawn.direction)}));
    }
}

/// Steep facets of rough seas, seen from where the light comes from: rho is constant there.
fn steep(lines: &mut Lines) {
    let p = Parameters {
        wind: Wind::FrictionVelocity(lines.uniform(60.0, 238.65)),
        footprint: Some(lines.one(&[0.15, 1.0, f64::INFINITY])),
        gram_charlier: false,
        shadowing: false,
        slope_measure: SlopeMeasure::Angle,
        ..any(lines)
    };
    let sea = sea(lines, p);
    let lobe32: Lobe<f32> = sea.water.local_lobe().cast();
    for _ in 0..PAIRS {
        let ((s, c), (sp, cp)) = (lines.zenith().sin_cos(), lines.uniform(0.0, TAU).sin_cos());
        let i = [s * cp, s * sp, c];
        let f = sea.water.local_lobe().eval(i, i, up());
        lines.row("steep", json!([[sea.id], i, i, up::<f64>()]), json!({"float64": [f]}));
        let i = single(i);
        let f = f64::from(lobe32.eval(i, i, up()));
        lines.row("steep", json!([[sea.id], double(i), double(i), up::<f64>()]), json!({"float32": [f]}));
    }
}

/// Directions about a normal whose half vector is tilted by up to sqrt([`REACH`]) standard deviations.
fn pair(lines: &mut Lines, water: &Water, n: Vec3<f64>) -> [Vec3<f64>; 2] {
    let f = &water.local_lobe().facets;
    loop {
        let i = lines.direction();
        // A quarter close to the specular direction, where both may be at the horizon.
        let r = if lines.one(&[true, false, false, false]) {
            lines.decades(1e-5, 1.0)
        } else {
            lines.uniform(0.0, REACH).sqrt()
        };
        let psi = lines.uniform(0.0, TAU);
        let tilts = [r * psi.cos() * f.sigma_u, r * psi.sin() * f.sigma_c];
        let tilts = if f.slope_measure { tilts.map(f64::atan) } else { tilts };
        let normal = [n[0] * f.wind.cos + n[1] * f.wind.sin, n[1] * f.wind.cos - n[0] * f.wind.sin];
        let angles = [0, 1].map(|axis| normal[axis].atan2(n[2]) + tilts[axis]);
        if angles.iter().any(|angle| angle.abs() >= FRAC_PI_2) {
            continue;
        }
        let [tu, tc] = angles.map(f64::tan);
        let z = 1.0 / (1.0 + tu * tu + tc * tc).sqrt();
        let h = [(tu * f.wind.cos - tc * f.wind.sin) * z, (tu * f.wind.sin + tc * f.wind.cos) * z, z];
        let c = dot(i, h);
        let o = [0, 1, 2].map(|k| 2.0 * c * h[k] - i[k]);
        let lowest = crate::GRAZING.to_radians().cos();
        if c > 0.0 && dot(i, n) > lowest && dot(o, n) > lowest && o[2] > 0.0 {
            return [i, o];
        }
    }
}

fn single(v: Vec3<f64>) -> Vec3<f32> {
    v.map(|x| x as f32)
}

fn double(v: Vec3<f32>) -> Vec3<f64> {
    v.map(f64::from)
}
