//! Polarised reflection: the Mueller matrix of facets.
//!
//! Not of the report, whose light is unpolarised. All facets that reflect from `i` to `o` have the same normal, the half vector of
//! the two: whatever their slopes, shadows and the mean over them are, f times one matrix of Fresnel's reflection, over that
//! matrix's first element, is their polarised BRDF. Whitecaps depolarise.
//!
//! A Stokes vector (I, Q, U, V) is seen against the light, from where it goes to: Q counts along a first axis, U along 45 degrees
//! counter-clockwise from there, and the second axis is the direction of travel times the first one.

use super::fresnel::Reflectance;
use super::lobe::cos_zeta;
use crate::numeric::real::dot;
use crate::numeric::{Real, Vec3};

impl<T: Real> Reflectance<T> {
    /// Fresnel's reflection of polarised light for the cosine of zeta: m01, m22 and m23 of the Mueller matrix over m00,
    ///
    /// `[[1, m01, 0, 0], [m01, 1, 0, 0], [0, 0, m22, m23], [0, 0, -m23, m22]]`
    ///
    /// whose first axes are perpendicular to the plane of incidence. With the amplitudes `r_s` and `r_p` for an index `n - i k`
    /// they are `(R_s - R_p)/2`, `Re(r_s r_p*)` and `Im(r_s r_p*)` over `(R_s + R_p)/2`. Since `r_p/r_s` is `(s^2 - c q)/(s^2 + c q)`,
    /// with `c` and `s` cosine and sine of zeta and `q^2 = (n - i k)^2 - s^2` (Born and Wolf, sections 1.5.2 and 14.2), nothing
    /// cancels and nothing is left of `R_s`. Times rho, by Schlick or exact, this is the matrix of a facet.
    #[inline(always)]
    pub fn polarised(&self, cos: T) -> [T; 3] {
        let (zero, one, two) = (T::of(0.0), T::of(1.0), T::of(2.0));
        let (c2, s2) = (cos * cos, T::max((-cos).mul_add(cos, one), T::of(0.0)));
        let p = cos.mul_add(cos, self.excess);
        // |q|^2, and real and minus imaginary part of q.
        let mut norm = p;
        let (mut real, mut imaginary) = (T::max(p, zero), zero);
        if self.absorbing {
            let half = T::of(0.5);
            norm = p.mul_add(p, self.absorption).sqrt();
            let larger = half * (norm + p.abs());
            let smaller = T::of(0.25) * self.absorption / T::max(larger, T::TINY);
            let backwards = T::lt(p, zero);
            real = T::select(backwards, smaller, larger);
            imaginary = T::select(backwards, larger, smaller).sqrt();
        }
        let (s4, c2q2) = (s2 * s2, c2 * norm);
        let over = T::max(s4 + c2q2, T::TINY).recip();
        let twice = two * s2 * cos * over;
        [twice * real.sqrt(), (s4 - c2q2) * over, zero - twice * imaginary]
    }
}

impl<T: Real> Reflectance<T> {
    /// [`Reflectance::polarised`] of unit vectors to source and observer.
    #[inline(always)]
    pub fn polarised_between(&self, i: Vec3<T>, o: Vec3<T>) -> [T; 3] {
        let h = [i[0] + o[0], i[1] + o[1], i[2] + o[2]];
        self.polarised(cos_zeta(h))
    }
}

/// A Mueller matrix, row by row.
pub type Mueller = [[f64; 4]; 4];

/// Of unit vectors to source and observer, what facets and whitecaps reflect (f of each, 1/sr, with its share of the surface) as a
/// polarised BRDF, 1/sr.
///
/// The first axis of a Stokes vector, of the light that arrives and of the light that leaves, lies in the plane of its direction
/// and the vertical, towards larger angles from the vertical; of vertical light along x (against x where it goes down).
pub fn mueller(
    reflectance: &Reflectance<f64>,
    i: Vec3<f64>,
    o: Vec3<f64>,
    [facets, foam]: [f64; 2],
) -> Mueller {
    let [m01, m22, m23] = reflectance.polarised_between(i, o).map(|m| m * facets);
    // About the normal of the plane of incidence; where there is none, any axis will do.
    let down = i.map(|x| -x);
    let s = unit(cross(o, i)).unwrap_or_else(|| along_meridian(o));
    let [[ci, si], [co, so]] = [turn(down, s, along_meridian(down)), turn(o, s, along_meridian(o))];
    // Turned on the right, for the light that arrives, and on the left.
    let q = [m01, facets * ci, -facets * si, 0.0];
    let u = [0.0, m22 * si, m22 * ci, m23];
    let row = |x: f64, y: f64| [0, 1, 2, 3].map(|k| x * q[k] + y * u[k]);
    [[facets + foam, m01 * ci, -m01 * si, 0.0], row(co, so), row(-so, co), [0.0, -m23 * si, -m23 * ci, m22]]
}

/// A Stokes vector after a matrix.
pub fn reflected(mueller: &Mueller, stokes: [f64; 4]) -> [f64; 4] {
    mueller.map(|row| (0..4).map(|k| row[k] * stokes[k]).sum())
}

/// What is seen of a Stokes vector, 1/sr, where f of the whole is the first number, and of whitecaps alone the second.
pub fn seen(
    reflectance: &Reflectance<f64>,
    i: Vec3<f64>,
    o: Vec3<f64>,
    [f, foam]: [f64; 2],
    stokes: [f64; 4],
) -> [f64; 4] {
    let foam = foam.min(f);
    reflected(&mueller(reflectance, i, o, [f - foam, foam]), stokes)
}

/// Degree of polarisation of a Stokes vector, from 0 to 1, and its angle: of the plane of linear polarisation to the first axis,
/// degrees counter-clockwise from above -90 to 90, as whom the light reaches sees it.
pub fn degree_and_angle([i, q, u, v]: [f64; 4]) -> [f64; 2] {
    let degree = if i > 0.0 { q.hypot(u).hypot(v) / i } else { 0.0 };
    [degree.min(1.0), 0.5 * u.atan2(q).to_degrees()]
}

/// The unit vector across a direction in the plane of it and the vertical, towards larger angles from the vertical.
fn along_meridian([x, y, z]: Vec3<f64>) -> Vec3<f64> {
    let flat = x.hypot(y);
    if flat == 0.0 { [z.signum(), 0.0, 0.0] } else { [x * z / flat, y * z / flat, -flat] }
}

/// Cosine and sine of twice the angle about a direction of travel from one axis to another.
fn turn(forward: Vec3<f64>, from: Vec3<f64>, to: Vec3<f64>) -> [f64; 2] {
    let (cos, sin) = (dot(from, to), dot(forward, cross(from, to)));
    [cos * cos - sin * sin, 2.0 * sin * cos]
}

fn cross(a: Vec3<f64>, b: Vec3<f64>) -> Vec3<f64> {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn unit(v: Vec3<f64>) -> Option<Vec3<f64>> {
    let length = dot(v, v).sqrt();
    (length > 0.0).then(|| v.map(|x| x / length))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::brdf::Fresnel;

    type Complex = [f64; 2];

    fn times([a, b]: Complex, [c, d]: Complex) -> Complex {
        [a * c - b * d, a * d + b * c]
    }

    fn over(a: Complex, b: Complex) -> Complex {
        let n = b[0] * b[0] + b[1] * b[1];
        times(a, [b[0] / n, -b[1] / n])
    }

    /// Against the quotients of complex amplitudes, for what is transparent and what is not; and a matrix of one amplitude keeps a
    /// pure state pure.
    #[test]
    fn shares_are_those_of_the_amplitudes() {
        for (n, k) in [(1.34, 0.0), (1.0, 0.0), (1.371, 0.272), (1.142, 0.2), (1.05, 3.0), (2.13, 0.504)] {
            let r = Reflectance::new([n, k], Fresnel::Exact);
            for degrees in [0.01f64, 20.0, 53.267, 70.0, 85.0, 89.99] {
                let (sin, cos) = degrees.to_radians().sin_cos();
                let square = times([n, -k], [n, -k]);
                let below = [square[0] - sin * sin, square[1]];
                let (length, angle) = (below[0].hypot(below[1]).sqrt(), 0.5 * below[1].atan2(below[0]));
                let q = [length * angle.cos(), length * angle.sin()];
                let p = times(square, [cos, 0.0]);
                let amplitude = |a: Complex| over([a[0] - q[0], a[1] - q[1]], [a[0] + q[0], a[1] + q[1]]);
                let [rs, rp] = [amplitude([cos, 0.0]), amplitude(p)];
                let norm = |a: Complex| a[0] * a[0] + a[1] * a[1];
                let product = times(rs, [rp[0], -rp[1]]);
                let m00 = 0.5 * (norm(rs) + norm(rp));
                let [m01, m22, m23] = r.polarised(cos);
                if m00 > 1e-15 {
                    let expected = [0.5 * (norm(rs) - norm(rp)) / m00, product[0] / m00, product[1] / m00];
                    for (found, expected) in [m01, m22, m23].into_iter().zip(expected) {
                        assert!((found - expected).abs() < 1e-11, "{n} {k} {degrees}: {found} {expected}");
                    }
                    assert!((r.eval(cos) / m00 - 1.0).abs() < 1e-11);
                }
                assert!((m01 * m01 + m22 * m22 + m23 * m23 - 1.0).abs() < 1e-14);
                let single = r.cast::<f32>().polarised(cos as f32);
                for (a, b) in single.into_iter().zip([m01, m22, m23]) {
                    assert!((f64::from(a) - b).abs() < 2e-6, "{n} {k} {degrees}");
                }
            }
            assert_eq!(r.polarised(1.0)[..2], [0.0, -1.0]);
            assert_eq!(r.polarised(0.0)[..2], [0.0, 1.0]);
        }
    }

    /// At Brewster's angle what is reflected is polarised across the plane of incidence, all of it.
    #[test]
    fn brewster() {
        for n in [1.1, 1.34, 2.0] {
            let cos = 1.0 / f64::hypot(1.0, n);
            let [m01, m22, _] = Reflectance::new([n, 0.0], Fresnel::Schlick).polarised(cos);
            assert!((m01 - 1.0).abs() < 1e-15 && m22.abs() < 1e-15, "{n}: {m01} {m22}");
        }
    }

    fn direction(theta: f64, phi: f64) -> Vec3<f64> {
        let ((s, c), (sp, cp)) = (theta.to_radians().sin_cos(), phi.to_radians().sin_cos());
        [s * cp, s * sp, c]
    }

    /// Eradiate's ocean_mishchenko (f times the light's cosine, in frames with the meridian's axis first), all digits that are printed: isotropic
    /// facets of the mean square slope 0.003 + 0.00512 W, shadowed by 1/(1 + L_i + L_o). Its lobe in a line, our matrix.
    #[test]
    fn printed_matrices() {
        let cases = [
            (2.0, 1.33, [15.0, 0.0], [15.0, 180.0], [0.125_155, -0.013_268_9, -0.124_450], 1e-6),
            (10.0, 1.39, [40.0, 0.0], [60.0, 180.0], [0.073_392_4, -0.071_338_5, -0.017_241_2], 1e-7),
        ];
        for (wind, n, [ti, pi], [to, po], expected, digit) in cases {
            let (i, o) = (direction(ti, pi), direction(to, po));
            let reflectance = Reflectance::new([n, 0.0], Fresnel::Exact);
            let mss: f64 = 0.003 + 0.005_12 * wind;
            let h = [0, 1, 2].map(|k| i[k] + o[k]);
            let length = dot(h, h).sqrt();
            let cos2 = (h[2] / length).powi(2);
            let density = (-(1.0 - cos2) / cos2 / mss).exp() / (std::f64::consts::PI * mss * cos2 * cos2);
            let hidden = |v: Vec3<f64>| {
                let sigma_sin = (0.5 * mss * (1.0 - v[2] * v[2])).sqrt();
                crate::brdf::shadowing::cos_lambda(v[2], std::f64::consts::SQRT_2 * sigma_sin) / v[2]
            };
            let f_cos =
                density * reflectance.eval(0.5 * length) / (1.0 + hidden(i) + hidden(o)) / (4.0 * o[2]);
            let m = mueller(&reflectance, i, o, [f_cos, 0.0]);
            let found = [[m[0][0], m[1][1]], [m[0][1], m[1][0]], [m[2][2], m[3][3]]];
            println!("W {wind}: {:.7} {:.7} {:.7}", m[0][0], m[0][1], m[2][2]);
            for (pair, expected) in found.into_iter().zip(expected) {
                for value in pair {
                    assert!((value - expected).abs() < 0.5 * digit + 1e-12, "{wind}: {value} {expected}");
                }
            }
            let rest =
                [m[0][2], m[0][3], m[1][2], m[1][3], m[2][0], m[2][1], m[2][3], m[3][0], m[3][1], m[3][2]];
            assert!(rest.iter().all(|x| x.abs() < 1e-15), "{m:?}");
        }
    }

    /// With source and observer exchanged the matrix is transposed, but for signs of what 45 degrees and circles bring: reciprocity
    /// of polarised light. And the matrix does not jump where directions pass the vertical or each other.
    #[test]
    fn reciprocal_and_continuous() {
        let reflectance = Reflectance::new([1.371, 0.272], Fresnel::Exact);
        let sign = [1.0, 1.0, -1.0, 1.0];
        for (ti, to, phi) in [(20.0, 60.0, 35.0), (80.0, 5.0, -110.0), (45.0, 45.0, 179.0)] {
            let (i, o) = (direction(ti, 10.0), direction(to, phi));
            let (there, back) =
                (mueller(&reflectance, i, o, [1.0, 0.1]), mueller(&reflectance, o, i, [1.0, 0.1]));
            for (r, row) in there.iter().enumerate() {
                for (c, value) in row.iter().enumerate() {
                    assert!(
                        (value - sign[r] * sign[c] * back[c][r]).abs() < 1e-13,
                        "{r} {c}: {there:?} {back:?}"
                    );
                }
            }
        }
        let mut before: Option<Mueller> = None;
        for k in 0..=3600 {
            let m =
                mueller(&reflectance, direction(40.0, 77.0), direction(52.0, 0.1 * f64::from(k)), [1.0, 0.0]);
            for (row, old) in m.iter().zip(before.unwrap_or(m)) {
                assert!(row.iter().zip(old).all(|(a, b)| (a - b).abs() < 0.02), "{k}");
            }
            before = Some(m);
        }
    }

    #[test]
    fn degrees_and_angles() {
        assert_eq!(degree_and_angle([2.0, 0.0, 1.0, 0.0]), [0.5, 45.0]);
        assert_eq!(degree_and_angle([1.0, -1.0, 0.0, 0.0]), [1.0, 90.0]);
        assert_eq!(degree_and_angle([0.0; 4]), [0.0, 0.0]);
        let turned = reflected(
            &mueller(
                &Reflectance::new([1.34, 0.0], Fresnel::Exact),
                [0.6, 0.0, 0.8],
                [-0.6, 0.0, 0.8],
                [1.0, 0.0],
            ),
            [1.0, 0.0, 0.0, 0.0],
        );
        assert!(turned[1] < 0.0 && turned[2].abs() < 1e-15);
    }
}
