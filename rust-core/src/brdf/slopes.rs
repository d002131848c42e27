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

/// The Gram-Charlier correction p_ks (Eq. 78) as a polynomial of tilts in widths, a width being `sqrt(2 ln 2)` standard deviations:
/// then the Gaussian beside it is a power of 2.
///
/// With U and C in standard deviations, U rising towards upwind, against the tilt u, Eq. 78 is
///
/// `p_ks = 1 - c21/2 (C^2 - 1) U - c03/6 (U^3 - 3 U) + c40/24 (C^4 - 6 C^2 + 3) + c22/4 (C^2 - 1)(U^2 - 1)
///       + c04/24 (U^4 - 6 U^2 + 3)`.
#[derive(Debug, Clone, Copy)]
pub struct GramCharlier<T> {
    /// Of `u`, `u^3` and `u c^2`: the skewness, which depends on the wind.
    odd: [T; 3],
    /// Of `1` and `c^2`, of the c21 term as it stands in the report, without the factor U that Cox and Munk have.
    printed: Option<[T; 2]>,
}

/// Standard deviations in a width: `2^-u^2 = exp(-U^2/2)`.
pub const WIDTH: f64 = 1.177_410_022_515_474_7;

/// Coefficients of the kurtosis terms: of 1, u^2, c^2, u^4, u^2 c^2, c^4.
const EVEN: [f64; 6] = {
    const W2: f64 = WIDTH * WIDTH;
    [
        1.0 + (C40 + C04) / 8.0 + C22 / 4.0,
        -(C22 + C04) / 4.0 * W2,
        -(C22 + C40) / 4.0 * W2,
        C04 / 24.0 * W2 * W2,
        C22 / 4.0 * W2 * W2,
        C40 / 24.0 * W2 * W2,
    ]
};

impl GramCharlier<f64> {
    /// Of the skewness of Eq. 78.
    pub fn new([c21, c03]: [f64; 2], as_printed: bool) -> Self {
        let [cubic, printed] = if as_printed { [0.0, c21] } else { [c21, 0.0] };
        let (w, w3) = (WIDTH, WIDTH.powi(3));
        Self {
            odd: [-0.5 * (cubic + c03) * w, c03 / 6.0 * w3, 0.5 * cubic * w3],
            printed: as_printed.then_some([0.5 * printed, -0.5 * printed * w * w]),
        }
    }

    /// The same coefficients as another number type.
    pub fn cast<T: Real>(&self) -> GramCharlier<T> {
        GramCharlier {
            odd: self.odd.map(T::coefficient),
            printed: self.printed.map(|terms| terms.map(T::coefficient)),
        }
    }
}

impl<T: Real> GramCharlier<T> {
    /// The correction, without its clamp to what is not negative, for tilts in widths.
    #[inline(always)]
    pub fn eval(&self, u: T, c: T) -> T {
        let [one, uu, cc] = [T::of(EVEN[0]), T::of(EVEN[1]), T::of(EVEN[2])];
        let [u4, uucc, c4] = [T::of(EVEN[3]), T::of(EVEN[4]), T::of(EVEN[5])];
        let (u2, c2) = (u * u, c * c);
        let mut even = c2.mul_add(c4.mul_add(c2, uucc.mul_add(u2, cc)), u2.mul_add(u4.mul_add(u2, uu), one));
        let [linear, cubic, mixed] = self.odd;
        let mut odd = cubic.mul_add(u2, linear);
        match self.printed {
            Some([constant, crosswind]) => even = even + crosswind.mul_add(c2, constant),
            None => odd = mixed.mul_add(c2, odd),
        }
        u.mul_add(odd, even)
    }

    /// Its derivative by u, of the highest powers alone.
    #[inline(always)]
    pub fn steepest(&self, u: T) -> T {
        (T::of(4.0 * EVEN[3]).mul_add(u, T::of(3.0) * self.odd[1])) * (u * u)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Eq. 78 as it stands, U rising towards upwind.
    fn eq_78(c21: f64, c03: f64, u: f64, c: f64, printed: bool) -> f64 {
        let skew_c = (c * c - 1.0) * if printed { 1.0 } else { u };
        1.0 - c21 / 2.0 * skew_c - c03 / 6.0 * (u.powi(3) - 3.0 * u)
            + C40 / 24.0 * (c.powi(4) - 6.0 * c * c + 3.0)
            + C22 / 4.0 * (c * c - 1.0) * (u * u - 1.0)
            + C04 / 24.0 * (u.powi(4) - 6.0 * u * u + 3.0)
    }

    #[test]
    fn polynomial_is_eq_78() {
        for printed in [false, true] {
            let polynomial = GramCharlier::new([-0.08, -0.3], printed);
            for (u, c) in [(0.0, 0.0), (1.3, -0.4), (-2.5, 3.0), (4.0, 1.0), (-0.3, -5.0)] {
                let found = polynomial.eval(-u / WIDTH, c / WIDTH);
                let expected = eq_78(-0.08, -0.3, u, c, printed);
                assert!(
                    (found - expected).abs() < 1e-14 * (1.0 + u.powi(4) + c.powi(4)),
                    "{found} {expected}"
                );
            }
        }
        assert_eq!(WIDTH, (2.0 * 2f64.ln()).sqrt());
    }

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
                let p = p0 * GramCharlier::new([-0.08, -0.3], false).eval(-u / WIDTH, c / WIDTH);
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
