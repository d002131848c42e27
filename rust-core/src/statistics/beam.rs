//! A laser's beam: how wide it is on its way to the water.

use crate::error::{Error, refuse};

/// The widest beam, mrad: up to there an angle and twice its half's tangent are the same to 2 %.
const WIDEST: f64 = 500.0;
/// The widest exit, m.
const WIDEST_APERTURE: f64 = 100.0;

/// A Gaussian beam with its waist at the exit of the laser.
///
/// ```
/// use prob_water::Beam;
///
/// let beam = Beam::new(0.5, 0.02)?; // mrad, m
/// assert_eq!(beam.width(0.0), 0.02);
/// assert!((beam.width(1e3) - 0.5004).abs() < 1e-6);
/// # Ok::<(), prob_water::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Beam {
    divergence: f64,
    aperture: f64,
}

impl Beam {
    /// The full angle far from the laser, mrad, and the width at its exit, m. Both are of the width that
    /// [`footprint_measure`](crate::FootprintMeasure) names, by default the diameter at 1/e^2 of the intensity in the middle.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] for a divergence that is not from 0 to 500 mrad, an aperture that is not from 0 to 100 m, and where
    /// both are 0.
    pub fn new(divergence: f64, aperture: f64) -> Result<Self, Error> {
        if !(0.0..=WIDEST).contains(&divergence) {
            return refuse("divergence", divergence, format!("0 to {WIDEST} mrad"));
        }
        if !(0.0..=WIDEST_APERTURE).contains(&aperture) {
            return refuse("aperture", aperture, format!("0 to {WIDEST_APERTURE} m"));
        }
        if divergence == 0.0 && aperture == 0.0 {
            return refuse("divergence", divergence, "above 0 mrad where the aperture is 0");
        }
        Ok(Self { divergence, aperture })
    }

    /// Full angle, mrad.
    pub fn divergence(&self) -> f64 {
        self.divergence
    }

    /// Width at the exit, m.
    pub fn aperture(&self) -> f64 {
        self.aperture
    }

    /// Width across the beam at a range in m, m: `sqrt(aperture^2 + (divergence range)^2)`, the hyperbola of a Gaussian beam.
    pub fn width(&self, range: f64) -> f64 {
        self.aperture.hypot(1e-3 * self.divergence * range)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::FootprintMeasure;
    use std::f64::consts::PI;

    /// `w = w_0 sqrt(1 + (z/z_R)^2)`, `z_R = pi w_0^2/(M^2 lambda)` (Siegman, Lasers, 1986), near the waist and far from it; the
    /// intensity at the width's edge is the measure's.
    #[test]
    fn width_is_that_of_a_gaussian_beam() {
        let mut worst = 0.0f64;
        for (waist, wavelength, quality) in
            [(5e-3, 1.064e-6, 1.0), (0.4e-3, 532e-9, 1.7), (0.05, 10.6e-6, 3.0)]
        {
            let rayleigh = PI * waist * waist / (quality * wavelength);
            for measure in
                [FootprintMeasure::OneOverE2, FootprintMeasure::OneOverE, FootprintMeasure::HalfMaximum]
            {
                let width = |radius: f64| 2.0 * radius / measure.diameter();
                // The full angle of the asymptote.
                let beam = Beam::new(1e3 * width(waist / rayleigh), width(waist)).unwrap();
                for z in [0.0, 0.1, 1.0, 3.0, 1e4].map(|z| z * rayleigh) {
                    let expected = waist * (1.0 + (z / rayleigh).powi(2)).sqrt();
                    let found = 0.5 * beam.width(z) * measure.diameter();
                    worst = worst.max((found / expected - 1.0).abs());
                }
            }
        }
        println!("worst deviation from the hyperbola {worst:.1e}");
        assert!(worst < 1e-14, "{worst}");
    }

    #[test]
    fn what_is_no_beam_is_refused() {
        for (name, divergence, aperture) in [
            ("divergence", -1.0, 0.1),
            ("divergence", f64::NAN, 0.1),
            ("divergence", 501.0, 0.1),
            ("divergence", 0.0, 0.0),
            ("aperture", 1.0, -0.1),
            ("aperture", 1.0, f64::INFINITY),
            ("aperture", 1.0, f64::NAN),
        ] {
            assert_eq!(Beam::new(divergence, aperture).unwrap_err().parameters(), [name]);
        }
        assert_eq!(Beam::new(0.0, 0.1).unwrap().width(1e6), 0.1);
        assert_eq!(Beam::new(500.0, 0.0).unwrap().width(2.0), 1.0);
    }
}
