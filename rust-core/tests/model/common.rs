//! What several test files need.

use prob_water::{Lobe, Parameters, Water, Wind};

/// Rows of a file of reference vectors as texts.
pub fn texts(name: &str) -> Vec<csv::StringRecord> {
    let path = format!("{}/tests/data/{name}.csv", env!("CARGO_MANIFEST_DIR"));
    let rows: Vec<_> = csv::Reader::from_path(path).unwrap().records().map(Result::unwrap).collect();
    assert!(rows.len() > 10);
    rows
}

/// Rows of a file of reference vectors.
pub fn rows(name: &str) -> Vec<Vec<f64>> {
    texts(name).iter().map(|row| row.iter().map(|x| x.parse().unwrap()).collect()).collect()
}

/// The larger of two deviations; not a number counts as the largest, so that no bound takes it for small.
pub fn worse(a: f64, b: f64) -> f64 {
    if a.is_nan() || a > b { a } else { b }
}

pub const UP: [f64; 3] = [0.0, 0.0, 1.0];

/// Winds from calm to the end of Table 1, cm/s.
pub const WINDS: [f64; 9] = [0.0, 0.5, 1.31, 2.0, 4.0, 8.0, 24.0, 56.0, 97.0];
pub const HURRICANES: [f64; 3] = [150.0, 190.0, 238.65];

pub fn water(friction_velocity: f64, change: impl FnOnce(&mut Parameters)) -> Water {
    let mut p = Parameters {
        wind: Wind::FrictionVelocity(friction_velocity),
        ior: Some(1.33),
        whitecaps: false,
        ..Parameters::default()
    };
    change(&mut p);
    p.configure().unwrap()
}

pub fn direction(theta_degrees: f64, phi_degrees: f64) -> [f64; 3] {
    let ((s, c), (sp, cp)) = (theta_degrees.to_radians().sin_cos(), phi_degrees.to_radians().sin_cos());
    [s * cp, s * sp, c]
}

pub fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Integral over the observer's hemisphere of `g`, by Gauss-like midpoints in the half vector's tilts
/// along and across the wind from the wave normal `n`: fine where the lobe is.
pub fn integrate(
    lobe: &Lobe<f64>,
    i: [f64; 3],
    n: [f64; 3],
    steps: usize,
    g: impl Fn([f64; 3]) -> f64,
) -> f64 {
    let f = &lobe.facets;
    let along = [f.wind.cos, f.wind.sin];
    let (nu, nc) = (n[0] * along[0] + n[1] * along[1], n[1] * along[0] - n[0] * along[1]);
    // tilt angles of the normal; the half vector's span the upper hemisphere
    let (au, ac) = (nu.atan2(n[2]), nc.atan2(n[2]));
    // x in (-1, 1) to a tilt in (-pi/2, pi/2), finer by `sigma` about the normal's own tilt
    let nodes = |centre: f64, sigma: f64| -> Vec<(f64, f64)> {
        let half = std::f64::consts::FRAC_PI_2;
        let s = 4.0 * sigma;
        let (low, high) = (((-half - centre) / s).asinh(), ((half - centre) / s).asinh());
        (0..steps)
            .map(|k| {
                let y = low + (high - low) * (k as f64 + 0.5) / steps as f64;
                (centre + s * y.sinh(), s * y.cosh() * (high - low) / steps as f64)
            })
            .collect()
    };
    let (us, cs) = (nodes(au, f.sigma_u), nodes(ac, f.sigma_c));
    let mut sum = 0.0;
    for (a, wa) in &us {
        for (b, wb) in &cs {
            let (tu, tc) = (a.tan(), b.tan());
            let cos = 1.0 / (1.0 + tu * tu + tc * tc).sqrt();
            let h = [(tu * along[0] - tc * along[1]) * cos, (tu * along[1] + tc * along[0]) * cos, cos];
            let c = dot(i, h);
            let o = [2.0 * c * h[0] - i[0], 2.0 * c * h[1] - i[1], 2.0 * c * h[2] - i[2]];
            if c > 0.0 && dot(o, n) > 0.0 {
                sum += g(o) * 4.0 * c * cos.powi(3) * (1.0 + tu * tu) * (1.0 + tc * tc) * wa * wb;
            }
        }
    }
    sum
}
