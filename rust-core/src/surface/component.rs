//! One drawn wave.

use crate::sea::spectrum::share;
use std::f64::consts::TAU;

/// One drawn wave, in metres and seconds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Component {
    /// k, rad/m.
    pub wave_number: f64,
    /// psi, radians.
    pub phase: f64,
    /// phi, radians from +x: the wave comes from there.
    pub azimuth: f64,
    /// a, m.
    pub amplitude: f64,
    /// omega, rad/s.
    pub frequency: f64,
}

impl Component {
    /// The wave that has this one's phase at a place in m and a time in s (Eq. 31) instead of at the origin at 0.
    pub fn with_phase_at(self, [x, y]: [f64; 2], time: f64) -> Self {
        if (x, y, time) == (0.0, 0.0, 0.0) {
            return self;
        }
        let (sin, cos) = self.azimuth.sin_cos();
        let since = self.frequency * time + self.wave_number * (x * cos + y * sin);
        Self { phase: (self.phase - since) % TAU, ..self }
    }

    /// The part of the wave that stays geometry at a footprint in m, see [`share`].
    pub fn seen_at(self, footprint: f64) -> Self {
        Self { amplitude: self.amplitude * share(self.wave_number, footprint).sqrt(), ..self }
    }

    /// Variance of its slope.
    pub(crate) fn slope_variance(&self) -> f64 {
        0.5 * (self.amplitude * self.wave_number).powi(2)
    }

    /// Variance of its vertical acceleration (Eq. 52), m^2/s^4.
    pub(crate) fn acceleration_variance(&self) -> f64 {
        0.5 * (self.amplitude * self.frequency * self.frequency).powi(2)
    }
}
