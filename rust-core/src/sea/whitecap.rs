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

/// Accelerations in cm/s^2 between which the probability of a whitecap falls from 1 to 0 (Eqs. 53-54), at a friction
/// velocity in cm/s.
pub fn onset(friction_velocity: f64) -> [f64; 2] {
    let alpha = -0.0022 * friction_velocity + 0.4448;
    [-0.39 * GRAVITY, GRAVITY * (-alpha).max(-0.39)]
}

/// Probability of a whitecap (Eqs. 53-54) where the surface has a vertical acceleration in cm/s^2,
/// at a friction velocity in cm/s. The printed ranges overlap below w* = 24.9; there the first match
/// counts: a step at -0.39 g. A step at -alpha g would be as monotone; the report leaves it open.
pub fn probability(friction_velocity: f64, acceleration: f64) -> f64 {
    let [sure, none] = onset(friction_velocity);
    if acceleration <= sure {
        1.0
    } else if acceleration > none {
        0.0
    } else {
        (none - acceleration) / (none - sure)
    }
}

/// [`probability`] for a renderer's numbers: without a branch, of accelerations in m/s^2.
#[derive(Debug, Clone, Copy)]
pub struct Onset<T> {
    /// Vertical acceleration above which there is none, m/s^2.
    none: T,
    /// The probability's fall per m/s^2.
    fall: T,
}

impl Onset<f64> {
    /// At a friction velocity in cm/s.
    pub fn new(friction_velocity: f64) -> Self {
        let [sure, none] = onset(friction_velocity).map(|cm| 0.01 * cm);
        Self { none, fall: 1.0 / (none - sure).max(1e-30) }
    }

    /// In another number type.
    pub fn cast<T: Real>(&self) -> Onset<T> {
        Onset { none: T::coefficient(self.none), fall: T::coefficient(self.fall) }
    }
}

impl<T: Real> Onset<T> {
    /// Probability of a whitecap at a vertical acceleration in m/s^2.
    pub fn probability(&self, acceleration: T) -> T {
        T::min(T::max((self.none - acceleration) * self.fall, T::of(0.0)), T::of(1.0))
    }
}

/// The mean of [`probability`] over vertical accelerations in cm/s^2 that are Gaussian with a mean and a standard
/// deviation.
pub fn mean_probability(friction_velocity: f64, mean: f64, deviation: f64) -> f64 {
    if deviation <= 0.0 {
        return probability(friction_velocity, mean);
    }
    let [sure, none] = onset(friction_velocity);
    // P(x < limit), and the mean of max(0, limit - x): the ramp is a difference of two of those.
    let below = |limit: f64| 0.5 * libm::erfc((mean - limit) / deviation * FRAC_1_SQRT_2);
    let depth = |limit: f64| {
        let z = (limit - mean) / deviation;
        (limit - mean) * below(limit) + deviation * (-0.5 * z * z).exp() / (2.0 * PI).sqrt()
    };
    let ramp = none - sure;
    let p = if ramp > 1e-6 * GRAVITY { (depth(none) - depth(sure)) / ramp } else { below(sure) };
    p.clamp(0.0, 1.0)
}

/// The standard deviation in cm/s^2 of a Gaussian vertical acceleration that makes whitecaps (Eqs. 53-54) as frequent as
/// `fraction`; `None` where no sea does, from nearly a half on.
pub fn deviation(friction_velocity: f64, fraction: f64) -> Option<f64> {
    const MOST: f64 = 100.0 * GRAVITY;
    let reaches = |s: f64| mean_probability(friction_velocity, 0.0, s) >= fraction;
    reaches(MOST).then(|| bisect(0.0, MOST, reaches))
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
            let onset = Onset::new(friction_velocity);
            for k in -600..=600 {
                // Not on the step itself, below w* = 24.9.
                let acceleration = 1.001 * f64::from(k);
                let expected = probability(friction_velocity, acceleration);
                assert!((onset.probability(0.01 * acceleration) - expected).abs() < 1e-12);
            }
        }
    }
}
