//! Nakajima and Tanaka's shadowing function, Eqs. 64-67, in a form without singularities.
//!
//! With `nu = cos/(sigma sin)` Eq. 66 is `F = ierfc(nu)/(2 nu)`, Smith's Lambda of Gaussian slopes. The BRDF needs
//! `G/(cos_i cos_r) = 1/(cos_i cos_r + cos_r a_i + cos_i a_r)` with [`cos_lambda`],
//! `a = cos F = sigma sin ierfc(nu)/2`, finite at grazing angles.

use crate::numeric::Real;

/// sigma of Eq. 64 for a wind at 10 m in m/s.
pub fn sigma(w10: f64) -> f64 {
    (5.34e-3 * w10).sqrt()
}

/// `cos Lambda` (F of Eq. 66) of an angle to the normal, where `sigma_sin` is sqrt 2 times the slope's standard deviation along the direction
/// times the sine.
#[inline(always)]
pub fn cos_lambda<T: Real>(cos: T, sigma_sin: T) -> T {
    let nu = cos / T::max(sigma_sin, T::SMALL);
    T::of(0.5) * sigma_sin * nu.ierfc()
}

/// What `cos F` is more with `sqrt(pi) nu^2` in Eq. 66, as printed: `cos exp(-nu^2) (1 - nu)/(2 sqrt(pi) nu^2)`.
#[inline(always)]
pub(crate) fn printed_excess<T: Real>(cos: T, sigma_sin: T) -> T {
    let nu = cos / T::max(sigma_sin, T::SMALL);
    let gauss = (-(nu * nu)).exp() * T::of(0.5 * FRAC_1_SQRT_PI);
    sigma_sin * gauss * (sigma_sin / T::max(cos, T::SMALL) - T::of(1.0))
}

/// `1/sqrt(pi)`.
const FRAC_1_SQRT_PI: f64 = 0.564_189_583_547_756_3;

#[cfg(test)]
mod tests {
    use super::*;

    /// Against Eqs. 65-67 as read in the table of readings, and Eq. 66 as printed.
    #[test]
    fn follows_the_equations() {
        let sigma = sigma(7.0);
        let f = |cos: f64| {
            let nu = cos / (sigma * (1.0 - cos * cos).sqrt());
            0.5 * ((-nu * nu).exp() / (std::f64::consts::PI.sqrt() * nu) - libm::erfc(nu))
        };
        for degrees in [20.0f64, 60.0, 80.0, 85.0, 89.0, 89.99] {
            let (s, c) = degrees.to_radians().sin_cos();
            assert!((cos_lambda(c, sigma * s) / c - f(c)).abs() < 1e-12 * (1.0 + f(c)));
            let (printed, nu) = (cos_lambda(c, sigma * s) + printed_excess(c, sigma * s), c / (sigma * s));
            let nu2_f = 0.5 * ((-nu * nu).exp() / (std::f64::consts::PI.sqrt() * nu * nu) - libm::erfc(nu));
            assert!((printed / c - nu2_f).abs() < 1e-12 * (1.0 + nu2_f));
        }
        assert_eq!(cos_lambda(1.0, 0.0), 0.0);
        assert_eq!(cos_lambda(0.0, 0.0), 0.0);
    }
}
