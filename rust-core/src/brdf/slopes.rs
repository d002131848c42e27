//! Slopes of the waves shorter than the footprint: variances (Eqs. 74-77) and density (Eqs. 72-73, 78-79).

use crate::numeric::Real;
use crate::sea::WindProfile;

/// In which measure the density is Gaussian.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum SlopeMeasure {
    /// Tilt angles, as printed.
    #[default]
    Angle,
    /// Slopes, Cox and Munk's measure: tangents of the tilt angles.
    Slope,
}

/// Smallest slope variance: 0.06 degrees, so that a calm sea is valid.
pub const VARIANCE_FLOOR: f64 = 1e-6;

/// Slope variances upwind and crosswind (Eqs. 74-77) of the waves shorter than a footprint in m.
pub fn variances(wind: &WindProfile, footprint: f64) -> [f64; 2] {
    let w = wind.w10;
    // One of the two terms of Eqs. 74-75; an infinite footprint holds all waves, erfc(0) = 1.
    let share = |scale: f64, power: f64| libm::erfc((1.0 / (footprint * scale)).powf(power));
    let calm_u = (-w / 36.8188).exp();
    let calm_c = (-w / 35.1072).exp();
    let u = (1.0 - calm_u) * share(1.3261 * w + 6.2780, 0.0033 * w + 0.2666)
        + calm_u * share(7.0628 * w + 24.2598, 0.0240 * w + 0.4956);
    let c = (1.0 - calm_c) * share(1.2156 * w + 11.3065, 0.0021 * w + 0.2965)
        + calm_c * share(7.0596 * w + 24.4595, 0.0241 * w + 0.5021);
    [
        (0.003_16 * wind.w12_5 * u).max(VARIANCE_FLOOR),
        ((0.003 + 0.001_92 * wind.w12_5) * c).max(VARIANCE_FLOOR),
    ]
}

/// Skewness coefficients c21, c03 of Eq. 78.
pub fn skewness(wind: &WindProfile) -> [f64; 2] {
    [0.01 - 0.0086 * wind.w12_5, 0.04 - 0.033 * wind.w12_5]
}

const C40: f64 = 0.40;
const C22: f64 = 0.12;
const C04: f64 = 0.23;

/// The Gram-Charlier correction p_ks (Eq. 78) without its clamp. `printed` takes the c21 term as
/// it stands in the report, without the factor U that Cox and Munk have.
#[inline(always)]
pub fn gram_charlier<T: Real>(c21: T, c03: T, u: T, c: T, printed: bool) -> T {
    let (one, three, six) = (T::of(1.0), T::of(3.0), T::of(6.0));
    let (u2, c2) = (u * u, c * c);
    let skew_c = (c2 - one) * if printed { one } else { u };
    let mut p = skew_c.mul_add(T::of(-0.5) * c21, one);
    p = (u * (u2 - three)).mul_add(T::of(-1.0 / 6.0) * c03, p);
    p = c2.mul_add(c2 - six, three).mul_add(T::of(C40 / 24.0), p);
    p = ((c2 - one) * (u2 - one)).mul_add(T::of(C22 / 4.0), p);
    u2.mul_add(u2 - six, three).mul_add(T::of(C04 / 24.0), p)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Eq. 78 leaves the density's normalisation, mean and variances as they are.
    #[test]
    fn gram_charlier_keeps_the_low_moments() {
        let (n, end) = (400, 9.0);
        let h = 2.0 * end / f64::from(n);
        let mut moments = [0.0; 5];
        for i in 0..n {
            for j in 0..n {
                let (u, c) = (-end + (f64::from(i) + 0.5) * h, -end + (f64::from(j) + 0.5) * h);
                let p0 = (-0.5 * (u * u + c * c)).exp() / (2.0 * std::f64::consts::PI) * h * h;
                let p = p0 * gram_charlier(-0.08, -0.3, u, c, false);
                for (sum, m) in moments.iter_mut().zip([1.0, u, c, u * u, c * c]) {
                    *sum += p * m;
                }
            }
        }
        for (found, expected) in moments.into_iter().zip([1.0, 0.0, 0.0, 1.0, 1.0]) {
            assert!((found - expected).abs() < 1e-10, "{moments:?}");
        }
    }

    #[test]
    fn variance_grows_with_the_footprint_to_cox_and_munks() {
        let wind = crate::sea::Wind::FrictionVelocity(24.0).profile().unwrap();
        let mut last = [0.0; 2];
        for footprint in [1e-3, 0.01, 0.1, 1.0, 10.0, 1e3, f64::INFINITY] {
            let now = variances(&wind, footprint);
            assert!(now[0] >= last[0] && now[1] >= last[1]);
            last = now;
        }
        assert_eq!(last, [0.003_16 * wind.w12_5, 0.003 + 0.001_92 * wind.w12_5]);
    }
}
