//! How fast waves run: Eqs. 4-5, cgs.

use super::salinity::Salinity;
use super::whitecap::GRAVITY;
use crate::numeric::root::bisect;
use std::f64::consts::PI;

/// Surface tension tau, dyne/cm.
const TENSION: f64 = 76.3;

/// The dispersion relation of a water.
#[derive(Debug, Clone, Copy)]
pub(super) struct Dispersion {
    /// tau/rho, cm^3/s^2.
    tension: f64,
    /// Depth of the water, cm.
    depth: f64,
    /// k_m^2 of Eq. 5, where surface tension and gravity are equal, (rad/cm)^2.
    pub(super) km2: f64,
}

impl Dispersion {
    /// Of a water as deep as that in m.
    pub(super) fn new(water: Salinity, depth: f64) -> Self {
        let density = match water {
            Salinity::Ocean => 1.025,
            Salinity::Fresh => 1.0,
        };
        let tension = TENSION / density;
        Self { tension, depth: 100.0 * depth, km2: GRAVITY / tension }
    }

    /// Angular frequency, rad/s, of a wave number in rad/cm (Eq. 4).
    pub(super) fn frequency(&self, k: f64) -> f64 {
        ((GRAVITY + self.tension * k * k) * k * (k * self.depth).tanh()).sqrt()
    }

    /// The wave number of waves of 10 Hz in deep water, rad/cm.
    pub(super) fn ten_hertz(&self) -> f64 {
        let rate = (20.0 * PI).powi(2);
        // Eq. 4 rises with k.
        bisect(0.0, rate / GRAVITY, |k| (GRAVITY + self.tension * k * k) * k >= rate)
    }
}

/// The wave number of gravity waves of a squared frequency over g, both in rad/cm, in water of a depth in cm, or in rad/m and m: the root of `k tanh(k d) =
/// square`.
pub(super) fn wave_number(square: f64, depth: f64) -> f64 {
    if !square.is_finite() || depth.is_infinite() {
        return square;
    }
    // tanh x is at least x/(1 + x).
    let high = 0.5 * square + (0.25 * square * square + square / depth).sqrt();
    bisect(0.0, high * (1.0 + 1e-9), |k| k * (k * depth).tanh() >= square)
}
