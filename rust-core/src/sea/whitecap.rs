//! Whitecaps: how much of the sea they cover and what they reflect. Eqs. 51 and 53-55.

use crate::numeric::Real;
use crate::numeric::root::bisect;
use std::f64::consts::{FRAC_1_SQRT_2, PI};

/// Acceleration of gravity, cm/s^2.
pub const GRAVITY: f64 = 981.0;

/// Fraction of the sea under whitecaps (Eq. 51) for a wind at 10 m in m/s.
pub fn fraction(w10: f64) -> f64 {
    (1.7e-6 * w10.powf(3.75)).min(1.0)
}

/// Where on drawn waves whitecaps stand.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum WhitecapOnset {
    /// By Eqs. 53-54 with the acceleration of the waves that are not drawn, so that they cover Eq. 51's fraction.
    #[default]
    Calibrated,
    /// Eqs. 53-54 of the drawn waves alone: below w* = 24.9 cm/s, where the ranges of Eq. 53 overlap, the first match, a
    /// step at -0.39 g.
    Ramp,
    /// The same with the other reading that falls everywhere: below w* = 24.9 cm/s a step at -alpha g.
    Step,
}

/// Accelerations in cm/s^2 between which the probability of a whitecap falls from 1 to 0 (Eqs. 53-54), at a friction
/// velocity in cm/s.
fn ends(friction_velocity: f64, onset: WhitecapOnset) -> [f64; 2] {
    let alpha = -0.0022 * friction_velocity + 0.4448;
    let [sure, none] = match onset {
        WhitecapOnset::Calibrated | WhitecapOnset::Ramp => [-0.39, (-alpha).max(-0.39)],
        WhitecapOnset::Step => [(-alpha).min(-0.39), -alpha],
    };
    [sure * GRAVITY, none * GRAVITY]
}

/// Probability of a whitecap (Eqs. 53-54, [`WhitecapOnset::Ramp`]) where the surface has a vertical acceleration in
/// cm/s^2, at a friction velocity in cm/s.
pub fn probability(friction_velocity: f64, acceleration: f64) -> f64 {
    let [sure, none] = ends(friction_velocity, WhitecapOnset::Ramp);
    if acceleration <= sure {
        1.0
    } else if acceleration > none {
        0.0
    } else {
        (none - acceleration) / (none - sure)
    }
}

/// The probability of a whitecap where drawn waves have a vertical acceleration a: the mean of Eqs. 53-54 over a + b + n,
/// with a shift b and a Gaussian n for the waves that are not drawn. Without a branch, for a renderer's numbers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Onset<T> {
    /// Vertical acceleration of the drawn waves above which there is none if n = 0, m/s^2.
    none: T,
    /// The fall of the probability per m/s^2 if n = 0.
    fall: T,
    /// 1/(sqrt(2) r) for n's standard deviation r; `None`: no n.
    sharpness: Option<T>,
}

/// A fall between ends closer than so many standard deviations of n is widened to that, by a part of n's variance: the
/// difference of two integrals keeps its digits in float32, and probabilities change by less than 3e-5.
const LEAST_WIDTH: f64 = 0.5;

impl Onset<f64> {
    /// Eqs. 53-54 at a friction velocity in cm/s, of the waves whose acceleration it is asked for.
    pub fn new(friction_velocity: f64, onset: WhitecapOnset) -> Self {
        let [sure, none] = ends(friction_velocity, onset);
        Self { none: 0.01 * none, fall: 1.0 / (0.01 * (none - sure)).max(1e-30), sharpness: None }
    }

    /// The same with waves that are not drawn, of a standard deviation in m/s^2.
    pub fn with_residual(friction_velocity: f64, residual: f64) -> Self {
        let sharp = Self::new(friction_velocity, WhitecapOnset::Ramp);
        if residual <= 0.0 {
            return sharp;
        }
        let width = 1.0 / sharp.fall;
        let wide = width.max(LEAST_WIDTH * residual);
        // A uniform distribution has a twelfth of its squared width as its variance.
        let rest = (residual * residual - (wide * wide - width * width) / 12.0).sqrt();
        Self {
            none: sharp.none + 0.5 * (wide - width),
            fall: 1.0 / wide,
            sharpness: Some(FRAC_1_SQRT_2 / rest),
        }
    }

    /// Accelerations of the drawn waves in m/s^2 between which the probability falls from 1 to 0 if n = 0.
    pub(crate) fn ends(&self) -> [f64; 2] {
        [self.none - 1.0 / self.fall, self.none]
    }

    /// n's standard deviation, m/s^2, beside [`Onset::ends`].
    pub(crate) fn residual(&self) -> f64 {
        self.sharpness.map_or(0.0, |sharpness| FRAC_1_SQRT_2 / sharpness)
    }

    /// Its numbers, for tables of onsets with waves that are not drawn.
    pub(crate) fn numbers(&self) -> [f64; 3] {
        [self.none, self.fall, self.sharpness.unwrap_or(f64::INFINITY)]
    }

    /// The same of accelerations to which a shift in m/s^2 is added.
    pub fn shifted(self, shift: f64) -> Self {
        Self { none: self.none - shift, ..self }
    }

    /// In another number type.
    pub fn cast<T: Real>(&self) -> Onset<T> {
        Onset {
            none: T::coefficient(self.none),
            fall: T::coefficient(self.fall),
            sharpness: self.sharpness.map(T::coefficient),
        }
    }
}

impl<T: Real> Onset<T> {
    /// From [`Onset::numbers`].
    pub(crate) fn of_numbers([none, fall, sharpness]: [T; 3]) -> Self {
        Self { none, fall, sharpness: Some(sharpness) }
    }

    /// Probability of a whitecap at a vertical acceleration of the drawn waves in m/s^2.
    pub fn probability(&self, acceleration: T) -> T {
        let (zero, one) = (T::of(0.0), T::of(1.0));
        let below = (self.none - acceleration) * self.fall;
        let Some(sharpness) = self.sharpness else { return T::min(T::max(below, zero), one) };
        // The mean of max(0, x + n) grows from nothing to x; the fall is a difference of two of those.
        let scale = sharpness / self.fall;
        let (far, near) = (below * scale, (below - one) * scale);
        let depth = |x: T| T::of(0.5).mul_add(x.abs().ierfc(), T::max(x, zero));
        T::min(T::max((depth(far) - depth(near)) / scale, zero), one)
    }
}

/// The standard deviation in m/s^2 of a Gaussian vertical acceleration of all waves that makes whitecaps (Eqs. 53-54)
/// as frequent as `fraction`, at a friction velocity in cm/s.
pub fn deviation(friction_velocity: f64, fraction: f64) -> f64 {
    // More than any sea's: GRAVITY is in cm/s^2, so this is 100 g.
    bisect(0.0, GRAVITY, |s| Onset::with_residual(friction_velocity, s).probability(0.0) >= fraction)
}

/// The Lambertian BRDF of a whitecap (Eq. 55), 1/sr, at a wavelength in micrometres.
pub fn brdf(wavelength: f64) -> f64 {
    0.22 * (-1.75 * (wavelength.max(0.6) - 0.6)).exp() / PI
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn onset_is_the_probability() {
        for friction_velocity in [2.0, 12.0, 24.0, 25.0, 56.0, 120.0] {
            let onset = Onset::new(friction_velocity, WhitecapOnset::Ramp);
            for k in -600..=600 {
                // Not on the step itself, below w* = 24.9.
                let acceleration = 1.001 * f64::from(k);
                let expected = probability(friction_velocity, acceleration);
                assert!((onset.probability(0.01 * acceleration) - expected).abs() < 1e-12);
            }
        }
    }

    /// The onset with a residual is the mean of the sharp one's probability over a Gaussian, and float32 keeps its digits.
    #[test]
    fn residual_is_the_mean_over_a_gaussian() {
        for (friction_velocity, residual) in
            [(12.0, 0.5), (24.0, 2.0), (25.0, 1.0), (40.0, 0.05), (56.0, 0.6), (120.0, 3.0), (238.0, 6.0)]
        {
            let sharp = Onset::new(friction_velocity, WhitecapOnset::Ramp);
            let onset = Onset::with_residual(friction_velocity, residual);
            let single: Onset<f32> = onset.cast();
            let widened = 1.0 < LEAST_WIDTH * residual * sharp.fall;
            for k in -40..=40 {
                let acceleration = 0.25 * f64::from(k);
                let count = 100_000;
                let mean: f64 = (0..count)
                    .map(|i| {
                        let z = 16.0 * ((f64::from(i) + 0.5) / f64::from(count) - 0.5);
                        let density = (-0.5 * z * z).exp() / (2.0 * PI).sqrt() * 16.0 / f64::from(count);
                        density * sharp.probability(acceleration + residual * z)
                    })
                    .sum();
                let found = onset.probability(acceleration);
                // Nodes are 1.6e-4 apart: steps are summed to 3e-5.
                let allowed = if widened { 6e-5 } else { 1e-8 };
                assert!(
                    (found - mean).abs() < allowed,
                    "{friction_velocity} {residual} {acceleration}: {found} {mean}"
                );
                let single = f64::from(single.probability(acceleration as f32));
                assert!(
                    (found - single).abs() < 4e-6,
                    "{friction_velocity} {acceleration}: {found} {single}"
                );
            }
        }
    }

    #[test]
    fn a_sea_of_this_deviation_has_the_fraction() {
        for friction_velocity in [3.0, 12.0, 24.0, 56.0, 120.0, 160.0] {
            for fraction in [1e-6, 1e-3, 0.1, 0.4] {
                let deviation = deviation(friction_velocity, fraction);
                let found = Onset::with_residual(friction_velocity, deviation).probability(0.0);
                assert!((found / fraction - 1.0).abs() < 1e-9, "{friction_velocity} {fraction}: {found}");
            }
        }
    }
}
