//! Elfouhaily, Chapron, Katsaros and Vandemark's unified spectrum (J. Geophys. Res. 102, 15781, 1997), cgs. "E" stands before
//! the numbers of its equations.

use super::whitecap::GRAVITY;
use super::wind::WindProfile;

/// The wave number of the slowest waves, rad/cm, where short waves have a peak,
const K_M: f64 = 3.70;
/// and their phase speed, cm/s.
const C_M: f64 = 23.0;
/// Inverse wave age of a fully developed sea,
const DEVELOPED: f64 = 0.84;
/// and the fetch, over U^2/g, that leads there (E37).
const DEVELOPED_FETCH: f64 = 2.2e4;
/// From here to [`ENDS`], over the wave number of the peak and over k_m, the spectrum has all but 0.2 % of its energy and all
/// its slopes.
const STARTS: f64 = 0.45;
const ENDS: f64 = 10.0;

/// The unified spectrum of a wind and its fetch.
#[derive(Debug, Clone, Copy)]
pub(super) struct Elfouhaily {
    /// Omega_c, the inverse wave age.
    inverse_age: f64,
    /// k_p, rad/cm.
    pub(super) peak: f64,
    /// c_p, cm/s.
    peak_speed: f64,
    /// gamma of the peak enhancement (E3), and the variance of its width (E2's sigma^2).
    enhancement: [f64; 2],
    /// alpha_p and alpha_m: long and short waves' equilibrium.
    equilibrium: [f64; 2],
    /// a_m, the spreading of the short waves.
    short_spreading: f64,
}

impl Elfouhaily {
    /// Of a wind with a fetch in m.
    pub(super) fn new(wind: &WindProfile, fetch: f64) -> Self {
        let (w, u) = (wind.friction_velocity, 100.0 * wind.w10);
        let developed = (100.0 * fetch * GRAVITY / (u * u) / DEVELOPED_FETCH).powf(0.4).tanh();
        let inverse_age = DEVELOPED * developed.powf(-0.75);
        let peak = inverse_age.powi(2) * GRAVITY / (u * u);
        let ratio = w / C_M;
        // E44; no short waves where it is negative, below 8.5 cm/s.
        let short = 1e-2 * (1.0 + ratio.ln() * if ratio <= 1.0 { 1.0 } else { 3.0 });
        Self {
            inverse_age,
            peak,
            peak_speed: (GRAVITY / peak).sqrt(),
            enhancement: [
                1.7 + 6.0 * inverse_age.max(1.0).log10(),
                (0.08 * (1.0 + 4.0 * inverse_age.powi(-3))).powi(2),
            ],
            equilibrium: [6e-3 * inverse_age.sqrt(), short.max(0.0)],
            short_spreading: 0.13 * ratio,
        }
    }

    /// Smallest and largest wave number, rad/cm; both infinite in a calm.
    pub(super) fn range(&self) -> [f64; 2] {
        [STARTS * self.peak, ENDS * K_M]
    }

    /// Phase speed of deep water, cm/s.
    fn speed(k: f64) -> f64 {
        (GRAVITY / k * (1.0 + (k / K_M).powi(2))).sqrt()
    }

    /// B(k), the curvature spectrum: long and short waves (E30-E32, E40-E41), both with the fall below the peak, as McDaniel (Waves
    /// in Random Media 11, 2001) has it: E41 as printed leaves short waves' energy there.
    pub(super) fn curvature(&self, k: f64) -> f64 {
        let (speed, from_peak) = (Self::speed(k), (k / self.peak).sqrt() - 1.0);
        let [gamma, variance] = self.enhancement;
        // E2-E3: Pierson and Moskowitz's fall below the peak, JONSWAP's enhancement at it.
        let fall = (-1.25 * (self.peak / k).powi(2)).exp();
        let enhanced = gamma.powf((-from_peak * from_peak / (2.0 * variance)).exp());
        let long = self.peak_speed * enhanced * (-self.inverse_age / 10f64.sqrt() * from_peak).exp();
        let short = C_M * (-0.25 * (k / K_M - 1.0).powi(2)).exp();
        let [alpha_p, alpha_m] = self.equilibrium;
        0.5 * (alpha_p * long + alpha_m * short) / speed * fall
    }

    /// S(k), cm^3: 0 outside of its range.
    pub(super) fn density(&self, k: f64) -> f64 {
        let [low, high] = self.range();
        if (low..=high).contains(&k) { self.curvature(k) / k.powi(3) } else { 0.0 }
    }

    /// Delta (E57): how much more energy runs along the wind than across it.
    pub(super) fn delta(&self, k: f64) -> f64 {
        let speed = Self::speed(k);
        let long = 4.0 * (speed / self.peak_speed).powf(2.5);
        let short = self.short_spreading * (C_M / speed).powf(2.5);
        (0.25 * 2f64.ln() + long + short).tanh()
    }

    /// Wave numbers between which it is as flat as a few polynomials.
    pub(super) fn breaks(&self) -> Vec<f64> {
        let peak = [0.6, 0.8, 1.0, 1.3, 1.8, 2.6, 4.5, 10.0, 30.0, 100.0].map(|off| off * self.peak);
        let short = [0.03, 0.1, 0.3, 0.6, 1.0, 1.5, 2.2, 3.0, 4.0, 5.5].map(|off| off * K_M);
        peak.into_iter().chain(short).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sea::Wind;

    fn spectrum(w: f64, fetch: f64) -> (WindProfile, Elfouhaily) {
        let wind = Wind::FrictionVelocity(w).profile().unwrap();
        (wind, Elfouhaily::new(&wind, fetch))
    }

    /// The integral of S k^power up to a wave number.
    fn moment(s: &Elfouhaily, power: i32, end: f64) -> f64 {
        let [low, high] = s.range();
        let (n, end) = (20_000, end.min(high));
        let step = (end / low).ln() / f64::from(n);
        let k = |i: i32| low * ((f64::from(i) + 0.5) * step).exp();
        (0..n).map(|i| s.density(k(i)) * k(i).powi(power + 1) * step).sum()
    }

    /// S in cm^3 and Delta as another program has them, in SI from the paper's equations.
    #[test]
    fn an_independent_implementation() {
        for (w, fetch, rows) in [
            (
                8.0,
                f64::INFINITY,
                [
                    (2.0, 244.013_143_938_758, 0.998_120_190_718_836),
                    (370.0, 1.491_225_390_949_26e-5, 0.225_943_199_467_306),
                ],
            ),
            (
                24.0,
                f64::INFINITY,
                [
                    (0.3, 153_760.621_677_240, 0.940_724_283_202_326),
                    (900.0, 3.878_948_375_561_83e-6, 0.255_412_317_127_978),
                ],
            ),
            (
                24.0,
                1e4,
                [
                    (0.3, 462.461_949_626_270, 0.999_999_998_474_985),
                    (5.0, 37.580_253_442_781_5, 0.447_371_916_760_868),
                ],
            ),
            (
                56.0,
                1e5,
                [
                    (5.0, 34.800_731_708_367_1, 0.206_857_334_066_594),
                    (370.0, 3.617_924_053_469_01e-4, 0.453_600_414_175_147),
                ],
            ),
        ] {
            let (_, s) = spectrum(w, fetch);
            for (k, density, delta) in rows {
                let (a, b) = (s.density(0.01 * k) / density - 1.0, s.delta(0.01 * k) / delta - 1.0);
                assert!(a.abs() < 1e-9 && b.abs() < 1e-9, "w* {w} fetch {fetch} k {k}: {a:e} {b:e}");
            }
        }
    }

    /// The mean square slope is about Cox and Munk's of a clean sea, 0.003 + 0.00512 U, where it was made for: within 13 % from 7
    /// to 14 m/s. Waves longer than 1.7 cm have 0.86 to 0.92 of that.
    #[test]
    fn mean_square_slope() {
        for w in [24.0, 40.0, 62.9] {
            let (wind, s) = spectrum(w, f64::INFINITY);
            let munk = 0.003 + 0.005_12 * wind.w12_5;
            let [all, long] = [f64::INFINITY, K_M].map(|end| moment(&s, 2, end) / munk);
            assert!((all - 1.06).abs() < 0.09 && (0.8..0.95).contains(&long), "w* {w}: {all} {long}");
        }
    }

    /// A developed sea has waves of 0.25 U^2/g, 5 % higher than Pierson and Moskowitz's 0.24; a fetch leaves less, and the
    /// peak at Omega_c^2 g/U^2.
    #[test]
    fn height_and_peak() {
        let mut last = 0.0;
        for fetch in [1e3, 1e4, 1e5, 1e6, f64::INFINITY] {
            let (wind, s) = spectrum(24.0, fetch);
            let height = 0.04 * moment(&s, 0, f64::INFINITY).sqrt() * 9.81 / wind.w10.powi(2);
            assert!(height > last, "{fetch}: {height}");
            last = height;
            // In S the peak is shifted to longer waves, at most as Pierson and Moskowitz's, sqrt(2.5/3).
            let at = |x: f64| s.density(x * s.peak);
            let top = (0..4000)
                .map(|i| 0.7 + 1e-4 * f64::from(i))
                .max_by(|a, b| at(*a).total_cmp(&at(*b)))
                .unwrap();
            assert!((0.9..1.0).contains(&top), "{fetch}: {top}");
        }
        assert!((last - 0.255).abs() < 0.005, "{last}");
        let (wind, s) = spectrum(24.0, f64::INFINITY);
        assert!((100.0 * s.peak / (0.84f64.powi(2) * 9.81 / wind.w10.powi(2)) - 1.0).abs() < 1e-12);
        // JONSWAP's peak, at 22 (g/U) (g X/U^2)^(-1/3), for a short fetch, within a tenth.
        for fetch in [1e3, 1e4] {
            let (wind, s) = spectrum(24.0, fetch);
            let jonswap = 22.0 * (9.81 * fetch / wind.w10.powi(2)).powf(-1.0 / 3.0);
            assert!((s.inverse_age / jonswap - 1.0).abs() < 0.1, "{fetch}: {} {jonswap}", s.inverse_age);
        }
    }

    /// Short waves have a peak of curvature at 370 rad/m, which a wind below 8.5 cm/s does not raise.
    #[test]
    fn short_waves() {
        for w in [16.0, 24.0, 56.0] {
            let (_, s) = spectrum(w, f64::INFINITY);
            let k = |i: u32| 1.5 * 1.002f64.powi(i as i32);
            let top = (0..700).map(k).max_by(|a, b| s.curvature(*a).total_cmp(&s.curvature(*b))).unwrap();
            assert!((top / K_M - 1.0).abs() < 0.05, "w* {w}: {top}");
            let without = Elfouhaily { equilibrium: [s.equilibrium[0], 0.0], ..s };
            let peak = s.curvature(K_M) - without.curvature(K_M);
            // B is half of alpha_m there.
            let alpha = 1e-2 * (1.0 + (w / 23.0).ln() * if w <= 23.0 { 1.0 } else { 3.0 });
            assert!((peak / (0.5 * alpha) - 1.0).abs() < 0.01, "w* {w}");
        }
        assert_eq!(spectrum(8.4, f64::INFINITY).1.equilibrium[1], 0.0);
        assert!(spectrum(8.5, f64::INFINITY).1.equilibrium[1] > 0.0);
    }

    /// The range leaves out less than 0.2 % of the height's variance and 1e-4 of the slopes'.
    #[test]
    fn range_holds_the_waves() {
        let (_, s) = spectrum(40.0, f64::INFINITY);
        let [low, high] = s.range();
        let sum = |a: f64, b: f64, power: i32| -> f64 {
            let step = (b / a).ln() / 20_000.0;
            let k = |i: i32| a * ((f64::from(i) + 0.5) * step).exp();
            (0..20_000).map(|i| s.curvature(k(i)) * k(i).powi(power - 2) * step).sum()
        };
        assert!(sum(0.1 * low, low, 0) < 2e-3 * sum(low, high, 0));
        assert!(sum(high, 10.0 * high, 2) < 1e-4 * sum(low, high, 2));
    }
}
