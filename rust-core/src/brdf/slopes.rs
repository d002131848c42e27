//! Slopes of the waves shorter than the footprint: variances (Eqs. 74-77), skewness and kurtosis (Eq. 78).

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

/// Measured statistics of the slopes of all waves.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum SlopeStatistics {
    /// Cox and Munk's of 1954, as the report has them.
    #[default]
    CoxMunk,
    /// Breon and Henriot's of 2006 (J. Geophys. Res. 111, C06005), from a satellite, of winds to 15 m/s at 10 m.
    BreonHenriot,
}

impl SlopeStatistics {
    /// Slope variances of all waves, upwind and crosswind: Eqs. 76-77, or Breon and Henriot's.
    pub fn total(self, wind: &WindProfile) -> [f64; 2] {
        match self {
            Self::CoxMunk => [0.003_16 * wind.w12_5, 0.003 + 0.001_92 * wind.w12_5],
            Self::BreonHenriot => [0.001 + 0.003_16 * wind.w10, 0.003 + 0.001_85 * wind.w10],
        }
    }

    /// Slope variances upwind and crosswind (Eqs. 74-77) of the waves shorter than a footprint in m: of all, the share that
    /// Eqs. 74-75 have.
    pub fn variances(self, wind: &WindProfile, footprint: f64) -> [f64; 2] {
        let ([u, c], [share_u, share_c]) = (self.total(wind), shares(wind, footprint));
        [(u * share_u).max(VARIANCE_FLOOR), (c * share_c).max(VARIANCE_FLOOR)]
    }

    /// Skewness coefficients c21, c03 of Eq. 78; the first index is crosswind's.
    pub fn skewness(self, wind: &WindProfile) -> [f64; 2] {
        match self {
            Self::CoxMunk => [0.01 - 0.0086 * wind.w12_5, 0.04 - 0.033 * wind.w12_5],
            Self::BreonHenriot => {
                let u = wind.w10.min(BREON_HENRIOT_END);
                [-9e-4 * u * u, -0.45 / (1.0 + (7.0 - u).exp())]
            }
        }
    }

    /// Kurtosis coefficients c40, c22, c04 of Eq. 78.
    pub fn kurtosis(self) -> [f64; 3] {
        match self {
            Self::CoxMunk => [0.40, 0.12, 0.23],
            Self::BreonHenriot => [0.30, 0.12, 0.40],
        }
    }
}

/// Wind speed at 10 m, m/s, with which Breon and Henriot's measurements end: their c21, a parabola, stays there beyond.
const BREON_HENRIOT_END: f64 = 15.0;

/// The share of the slope variances upwind and crosswind that waves shorter than a footprint in m have: the brackets of
/// Eqs. 74-75.
fn shares(wind: &WindProfile, footprint: f64) -> [f64; 2] {
    let w = wind.w10;
    // One of the two terms of Eqs. 74-75; an infinite footprint holds all waves, erfc(0) = 1.
    let share = |scale: f64, power: f64| libm::erfc((1.0 / (footprint * scale)).powf(power));
    let calm_u = (-w / 36.8188).exp();
    let calm_c = (-w / 35.1072).exp();
    let u = (1.0 - calm_u) * share(1.3261 * w + 6.2780, 0.0033 * w + 0.2666)
        + calm_u * share(7.0628 * w + 24.2598, 0.0240 * w + 0.4956);
    let c = (1.0 - calm_c) * share(1.2156 * w + 11.3065, 0.0021 * w + 0.2965)
        + calm_c * share(7.0596 * w + 24.4595, 0.0241 * w + 0.5021);
    [u, c]
}

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
    /// Of `1`, `u^2`, `c^2`, `u^4`, `u^2 c^2` and `c^4`: the kurtosis.
    even: [T; 6],
    /// Of `1` and `c^2`, of the c21 term as it stands in the report, without the factor U that Cox and Munk have.
    printed: Option<[T; 2]>,
}

/// Standard deviations in a width: `2^-u^2 = exp(-U^2/2)`.
pub const WIDTH: f64 = 1.177_410_022_515_474_7;

impl GramCharlier<f64> {
    /// Of the skewness c21, c03 and the kurtosis c40, c22, c04 of Eq. 78.
    pub fn new([c21, c03]: [f64; 2], [c40, c22, c04]: [f64; 3], as_printed: bool) -> Self {
        let [cubic, printed] = if as_printed { [0.0, c21] } else { [c21, 0.0] };
        let (w, w2, w3) = (WIDTH, WIDTH * WIDTH, WIDTH.powi(3));
        Self {
            odd: [-0.5 * (cubic + c03) * w, c03 / 6.0 * w3, 0.5 * cubic * w3],
            even: [
                1.0 + (c40 + c04) / 8.0 + c22 / 4.0,
                -(c22 + c04) / 4.0 * w2,
                -(c22 + c40) / 4.0 * w2,
                c04 / 24.0 * w2 * w2,
                c22 / 4.0 * w2 * w2,
                c40 / 24.0 * w2 * w2,
            ],
            printed: as_printed.then_some([0.5 * printed, -0.5 * printed * w * w]),
        }
    }

    /// The same coefficients as another number type.
    pub fn cast<T: Real>(&self) -> GramCharlier<T> {
        GramCharlier {
            odd: self.odd.map(T::coefficient),
            even: self.even.map(T::coefficient),
            printed: self.printed.map(|terms| terms.map(T::coefficient)),
        }
    }
}

impl<T: Real> GramCharlier<T> {
    /// The series of Eq. 78, not clamped to 0, for tilts in widths.
    #[inline(always)]
    pub fn eval(&self, u: T, c: T) -> T {
        let [one, uu, cc, u4, uucc, c4] = self.even;
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
        ((T::of(4.0) * self.even[3]).mul_add(u, T::of(3.0) * self.odd[1])) * (u * u)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sea::Wind;

    const EVERY: [SlopeStatistics; 2] = [SlopeStatistics::CoxMunk, SlopeStatistics::BreonHenriot];

    /// Eq. 78 as it stands, U rising towards upwind.
    fn eq_78([c21, c03]: [f64; 2], [c40, c22, c04]: [f64; 3], [u, c]: [f64; 2], printed: bool) -> f64 {
        let skew_c = (c * c - 1.0) * if printed { 1.0 } else { u };
        1.0 - c21 / 2.0 * skew_c - c03 / 6.0 * (u.powi(3) - 3.0 * u)
            + c40 / 24.0 * (c.powi(4) - 6.0 * c * c + 3.0)
            + c22 / 4.0 * (c * c - 1.0) * (u * u - 1.0)
            + c04 / 24.0 * (u.powi(4) - 6.0 * u * u + 3.0)
    }

    #[test]
    fn polynomial_is_eq_78() {
        let skewness = [-0.08, -0.3];
        for (statistics, printed) in EVERY.into_iter().flat_map(|s| [(s, false), (s, true)]) {
            let kurtosis = statistics.kurtosis();
            let polynomial = GramCharlier::new(skewness, kurtosis, printed);
            for (u, c) in [(0.0, 0.0), (1.3, -0.4), (-2.5, 3.0), (4.0, 1.0), (-0.3, -5.0)] {
                let found = polynomial.eval(-u / WIDTH, c / WIDTH);
                let expected = eq_78(skewness, kurtosis, [u, c], printed);
                assert!(
                    (found - expected).abs() < 1e-14 * (1.0 + u.powi(4) + c.powi(4)),
                    "{found} {expected}"
                );
            }
        }
        assert_eq!(WIDTH, (2.0 * 2f64.ln()).sqrt());
    }

    /// Sums over U and C of the density times the values that `of` gives, the factor of Eq. 78 passed to it.
    fn moments<const N: usize>(
        correction: &GramCharlier<f64>,
        of: impl Fn(f64, f64, f64) -> [f64; N],
    ) -> [f64; N] {
        let (n, end) = (400, 9.0);
        let h = 2.0 * end / f64::from(n);
        let mut sums = [0.0; N];
        for i in 0..n {
            for j in 0..n {
                let (u, c) = (-end + (f64::from(i) + 0.5) * h, -end + (f64::from(j) + 0.5) * h);
                let p0 = (-0.5 * (u * u + c * c)).exp() / (2.0 * std::f64::consts::PI) * h * h;
                for (sum, m) in sums.iter_mut().zip(of(correction.eval(-u / WIDTH, c / WIDTH), u, c)) {
                    *sum += p0 * m;
                }
            }
        }
        sums
    }

    /// Eq. 78 leaves the density's normalisation, mean and variances as they are. Its third moments are the skewness, with the
    /// sign turned, and its fourth exceed a Gaussian's by the kurtosis.
    #[test]
    fn gram_charlier_keeps_the_low_moments() {
        for statistics in EVERY {
            let ([c21, c03], [c40, c22, c04]) = ([-0.08, -0.3], statistics.kurtosis());
            let found = moments(&GramCharlier::new([c21, c03], [c40, c22, c04], false), |p, u, c| {
                [1.0, u, c, u * u, c * c, u * c * c, u.powi(3), c.powi(4), u * u * c * c, u.powi(4)]
                    .map(|m| m * p)
            });
            let expected = [1.0, 0.0, 0.0, 1.0, 1.0, -c21, -c03, 3.0 + c40, 1.0 + c22, 3.0 + c04];
            for (found, expected) in found.into_iter().zip(expected) {
                assert!((found - expected).abs() < 1e-10, "{found} {expected}");
            }
        }
    }

    /// What the clamp of Eq. 79 adds to the density: below 1/1000 to 15 m/s; at 36 m/s Cox and Munk's gain 1.3 %, Breon and
    /// Henriot's no more than at 15.
    #[test]
    fn clamp_adds_little() {
        for (speed, limits) in
            [(3.0, [1e-12, 1e-12]), (10.0, [1e-4, 1e-4]), (15.0, [1e-3, 1e-4]), (36.0, [0.014, 1e-4])]
        {
            let wind = Wind::Speed { speed, height: 10.0 }.profile().unwrap();
            for (statistics, limit) in EVERY.into_iter().zip(limits) {
                let correction = GramCharlier::new(statistics.skewness(&wind), statistics.kurtosis(), false);
                let [sum] = moments(&correction, |p, _, _| [p.max(0.0)]);
                assert!((1.0 - 1e-12..1.0 + limit).contains(&sum), "{statistics:?} at {speed} m/s: {sum}");
            }
        }
    }

    /// Breon and Henriot's coefficients as printed, by the wind at 10 m; upwind's skewness has the sign of Cox and Munk's.
    #[test]
    fn breon_and_henriots_numbers() {
        let of = SlopeStatistics::BreonHenriot;
        for (speed, variances, skewness) in [
            (0.0, [0.001, 0.003], [0.0, -0.000_410_353]),
            (7.0, [0.02312, 0.01595], [-0.0441, -0.225]),
            (10.0, [0.0326, 0.0215], [-0.09, -0.428_658]),
            (15.0, [0.0484, 0.03075], [-0.2025, -0.449_849]),
        ] {
            let wind = Wind::Speed { speed, height: 10.0 }.profile().unwrap();
            let found = of.total(&wind).into_iter().chain(of.skewness(&wind));
            for (found, printed) in found.zip(variances.into_iter().chain(skewness)) {
                assert!((found - printed).abs() < 1e-6, "{speed} m/s: {found} {printed}");
            }
            if speed > 2.0 {
                let munk = SlopeStatistics::CoxMunk.skewness(&wind);
                assert!(of.skewness(&wind).into_iter().zip(munk).all(|(a, b)| a * b > 0.0));
            }
        }
        // Beyond the measurements the parabola stays.
        let storm = Wind::Speed { speed: 30.0, height: 10.0 }.profile().unwrap();
        assert!((of.skewness(&storm)[0] + 0.2025).abs() < 1e-12);
        assert_eq!(of.kurtosis(), [0.30, 0.12, 0.40]);
    }

    #[test]
    fn variance_grows_with_the_footprint_to_that_of_all_waves() {
        let wind = Wind::FrictionVelocity(24.0).profile().unwrap();
        for statistics in EVERY {
            let mut last = [0.0; 2];
            for footprint in [1e-3, 0.01, 0.1, 1.0, 10.0, 1e3, f64::INFINITY] {
                let now = statistics.variances(&wind, footprint);
                assert!(now[0] >= last[0] && now[1] >= last[1]);
                last = now;
            }
            assert_eq!(last, statistics.total(&wind));
            // The share of a footprint is the same for both.
            let [munk, now] = [SlopeStatistics::CoxMunk, statistics].map(|s| {
                let ([u, c], [all_u, all_c]) = (s.variances(&wind, 0.15), s.total(&wind));
                [u / all_u, c / all_c]
            });
            assert!(munk.into_iter().zip(now).all(|(a, b)| (a / b - 1.0).abs() < 1e-14));
        }
        assert_eq!(
            SlopeStatistics::CoxMunk.total(&wind),
            [0.003_16 * wind.w12_5, 0.003 + 0.001_92 * wind.w12_5]
        );
    }
}
