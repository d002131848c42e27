//! Whitecaps: how much of the sea they cover and what they reflect. Eqs. 51 and 53-55.

/// Acceleration of gravity, cm/s^2.
pub const GRAVITY: f64 = 981.0;

/// Fraction of the sea under whitecaps (Eq. 51) for a wind at 10 m in m/s.
pub fn fraction(w10: f64) -> f64 {
    (1.7e-6 * w10.powf(3.75)).min(1.0)
}

/// Probability of a whitecap (Eqs. 53-54) where the surface has a vertical acceleration in cm/s^2,
/// at a friction velocity in cm/s. The printed ranges overlap below w* = 24.9; the first match
/// counts, which is the only monotone reading.
pub fn probability(friction_velocity: f64, acceleration: f64) -> f64 {
    let alpha = -0.0022 * friction_velocity + 0.4448;
    let a = acceleration / GRAVITY;
    if a <= -0.39 {
        1.0
    } else if a > (-alpha).max(-0.39) {
        0.0
    } else {
        (a + alpha) / (alpha - 0.39)
    }
}

/// The Lambertian BRDF of a whitecap (Eq. 55), 1/sr, at a wavelength in micrometres.
pub fn brdf(wavelength: f64) -> f64 {
    0.22 * (-1.75 * (wavelength.max(0.6) - 0.6)).exp() / std::f64::consts::PI
}
