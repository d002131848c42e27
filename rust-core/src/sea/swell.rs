//! Swell: waves of a storm far away, beside those of the wind. SI units.
//!
//! **Frequencies.** Ochi and Hubble's spectrum of one wave system (Proc. 15th Coastal Engineering Conference, 301, 1976) with the
//! significant height H, the peak omega_p and the shape lambda:
//!
//! `S(omega) = 4 beta^lambda/Gamma(lambda) H^2/16 omega_p^(4 lambda)/omega^(4 lambda + 1) exp(-beta (omega_p/omega)^4)`,
//! `beta = lambda + 1/4`.
//!
//! The share of the variance below a frequency is an incomplete gamma function, for a whole lambda a sum of lambda terms, and
//! moments are gamma functions. Long-travelled swell is as narrow as JONSWAP's spectrum with a peak enhanced 8 to 9 times (Goda,
//! Report of the Port and Harbour Research Institute 22(1), 3, 1983); lambda = 5 has about that peakedness.
//!
//! **Directions.** `beta_d/2 sech^2(beta_d phi)` about the swell's own (the form is Donelan, Hamilton and Hui's, Phil. Trans. R.
//! Soc. A 315, 509, 1985), with the standard deviation of Goda and Suzuki's `cos^2s(phi/2)` for swell from far away, s = 75 (Goda,
//! Random Seas and Design of Maritime Structures): `sqrt(2/(s + 1))`, 9.3 degrees.

use super::dispersion::wave_number;
use super::whitecap::GRAVITY;
use crate::numeric::root::bisect;
use std::f64::consts::{PI, SQRT_2, TAU};

/// lambda.
const SHAPE: u32 = 5;
/// lambda + 1/4.
const BETA: f64 = SHAPE as f64 + 0.25;
/// Frequencies over the peak's: beyond is less than 1e-7 of the variance.
const RANGE: [f64; 2] = [0.5, 3.0];
/// The frequency over the peak's above which there is less than 3e-5 of the variance.
const SHORTEST: f64 = 2.0;
/// Goda and Suzuki's s.
const CONCENTRATION: f64 = 75.0;
/// Steepest swell: significant height over the length of the peak's waves. A wind's own seas are as steep.
const STEEPEST: f64 = 0.05;

/// A swell.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Swell {
    /// Significant height, m: four standard deviations.
    pub height: f64,
    /// omega_p, rad/s.
    pub peak: f64,
    /// Radians from +x: it comes from there.
    pub azimuth: f64,
    /// Depth of the water, m.
    pub depth: f64,
}

impl Swell {
    /// Of a significant height in m, a period of the peak in s and an azimuth in radians, over a depth in m.
    pub fn new(height: f64, period: f64, azimuth: f64, depth: f64) -> Self {
        Self { height, peak: TAU / period, azimuth, depth }
    }

    /// Variance of the height, m^2.
    pub fn variance(&self) -> f64 {
        (0.25 * self.height).powi(2)
    }

    /// Amplitude in m of each of so many components of equal energy.
    pub fn amplitude(&self, components: usize) -> f64 {
        (2.0 * self.variance() / components as f64).sqrt()
    }

    /// The angular frequency in rad/s below which this share of the variance is.
    pub fn frequency(&self, share: f64) -> f64 {
        let [low, high] = RANGE;
        self.peak * bisect(low, high, |ratio| share_below(ratio) >= share)
    }

    /// The azimuth in radians to whose right this share of the variance comes from.
    pub fn direction(&self, share: f64) -> f64 {
        let turn = (2.0 * share - 1.0).atanh() / narrowness();
        self.azimuth + turn.clamp(-PI, PI)
    }

    /// Wave number of a frequency in rad/s, rad/m: of gravity waves in water of the depth.
    pub fn wave_number(&self, frequency: f64) -> f64 {
        wave_number(frequency * frequency / (0.01 * GRAVITY), self.depth)
    }

    /// Largest footprint in m beside which the swell's waves are geometry: from 2.8 footprints on waves are, also where they fade.
    pub fn largest_footprint(&self) -> f64 {
        PI / (SQRT_2 * self.wave_number(SHORTEST * self.peak))
    }

    /// Largest significant height in m of its period.
    pub fn highest(&self) -> f64 {
        STEEPEST * TAU / self.wave_number(self.peak)
    }
}

/// The share of the variance below a ratio of frequencies to the peak's.
fn share_below(ratio: f64) -> f64 {
    let x = BETA / ratio.powi(4);
    // exp(-x) times the first terms of exp(x).
    let (mut term, mut sum) = (1.0, 1.0);
    for n in 1..SHAPE {
        term *= x / f64::from(n);
        sum += term;
    }
    (-x).exp() * sum
}

/// beta_d: the variance of the angle is pi^2/(12 beta_d^2).
fn narrowness() -> f64 {
    let deviation = (2.0 / (CONCENTRATION + 1.0)).sqrt();
    PI / (12f64.sqrt() * deviation)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// S(omega) of a variance of 1 and a peak of 1 rad/s.
    fn density(omega: f64) -> f64 {
        let gamma: f64 = (1..SHAPE).map(f64::from).product();
        4.0 * BETA.powi(SHAPE as i32) / gamma / omega.powi(4 * SHAPE as i32 + 1)
            * (-BETA / omega.powi(4)).exp()
    }

    fn integral(f: impl Fn(f64) -> f64) -> f64 {
        let step = 1e-4;
        (0..100_000).map(|n| (f64::from(n) + 0.5) * step).map(|omega| f(omega) * step).sum()
    }

    /// The share is the density's integral, which has its peak at 1 and the moments of gamma functions; draws leave out nothing that
    /// counts.
    #[test]
    fn shares_are_the_spectrums() {
        assert!((integral(density) - 1.0).abs() < 1e-6);
        for ratio in [0.8, 0.9, 1.0, 1.1, 1.3, 1.8] {
            let sum = integral(|omega| if omega < ratio { density(omega) } else { 0.0 });
            assert!((share_below(ratio) - sum).abs() < 1e-3, "{ratio}: {sum}");
            assert!(density(ratio) <= density(1.0));
        }
        assert!(share_below(RANGE[0]) < 1e-20 && 1.0 - share_below(RANGE[1]) < 1e-7);
        assert!(1.0 - share_below(SHORTEST) < 3e-5);
        // Of omega^4: beta/(lambda - 1).
        let fourth = integral(|omega| density(omega) * omega.powi(4));
        assert!((fourth / (BETA / f64::from(SHAPE - 1)) - 1.0).abs() < 1e-4, "{fourth}");
        let swell = Swell::new(2.0, 10.0, 0.3, f64::INFINITY);
        for share in [0.001, 0.3, 0.5, 0.97] {
            assert!((share_below(swell.frequency(share) / swell.peak) - share).abs() < 1e-12);
        }
    }

    /// Goda's peakedness `2 integral of omega S^2 over the squared variance`: `8 Gamma(2 lambda)/(Gamma(lambda)^2 4^lambda)` = 4.92, within
    /// a tenth of that of JONSWAP's spectrum with its peak enhanced 8 to 9 times; 2 of a wind sea.
    #[test]
    fn as_narrow_as_long_travelled_swell() {
        let peakedness =
            |s: &dyn Fn(f64) -> f64| 2.0 * integral(|omega| omega * s(omega).powi(2)) / integral(s).powi(2);
        let jonswap = |gamma: f64| {
            move |omega: f64| {
                let width: f64 = if omega < 1.0 { 0.07 } else { 0.09 };
                let peak = gamma.powf((-0.5 * ((omega - 1.0) / width).powi(2)).exp());
                (-1.25 / omega.powi(4)).exp() / omega.powi(5) * peak
            }
        };
        let own = peakedness(&density);
        let [wind, eight, nine] = [1.0, 8.0, 9.0].map(|gamma| peakedness(&jonswap(gamma)));
        println!("{own} {wind} {eight} {nine}");
        assert!((own - 4.921_875).abs() < 1e-3 && (wind - 2.0).abs() < 1e-3, "{own} {wind}");
        assert!((own / eight - 1.0).abs() < 0.1 && (own / nine - 1.0).abs() < 0.1, "{own} {eight} {nine}");
    }

    /// Directions have the mean cosines of sech^2 and nearly those of `cos^2s(phi/2)`: s/(s + 1), s (s - 1)/((s + 1)(s + 2)).
    #[test]
    fn directions_are_spread_as_swell() {
        let swell = Swell::new(2.0, 10.0, 0.7, f64::INFINITY);
        let count = 100_000;
        let mean = |f: &dyn Fn(f64) -> f64| -> f64 {
            (0..count).map(|n| f(swell.direction((f64::from(n) + 0.5) / f64::from(count)) - 0.7)).sum::<f64>()
                / f64::from(count)
        };
        let s = CONCENTRATION;
        let cosines = [(1.0, s / (s + 1.0)), (2.0, s * (s - 1.0) / ((s + 1.0) * (s + 2.0)))];
        for (order, goda) in cosines {
            let found = mean(&|angle| (order * angle).cos());
            let x = 0.5 * PI * order / narrowness();
            assert!((found - x / x.sinh()).abs() < 1e-5 && (found - goda).abs() < 5e-3, "{found} {goda}");
        }
        assert!(mean(&f64::sin).abs() < 1e-9);
        assert_eq!(swell.direction(0.0), 0.7 - PI);
    }

    /// Waves of the swell's frequencies follow Eq. 4 in any depth, surface tension aside.
    #[test]
    fn waves_feel_the_bottom() {
        for depth in [f64::INFINITY, 30.0, 2.0] {
            let swell = Swell::new(1.0, 12.0, 0.0, depth);
            for share in [0.01, 0.5, 0.99] {
                let frequency = swell.frequency(share);
                let k = swell.wave_number(frequency);
                assert!(
                    (9.81 * k * (k * depth).tanh() / frequency.powi(2) - 1.0).abs() < 1e-9,
                    "{depth} {k}"
                );
            }
        }
        let deep = Swell::new(1.0, 12.0, 0.0, f64::INFINITY);
        assert!((deep.highest() - 0.05 * 9.81 * 144.0 / TAU).abs() < 1e-9);
    }
}
