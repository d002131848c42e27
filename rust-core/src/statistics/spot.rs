//! The spot that a beam lights on the water: its diameters, the circle that stands for it, and means over it.
//!
//! **Means.** The intensity `exp(-8 r^2/D^2)` is a Gaussian of variance D^2/16 along each axis. Its mean of a wave is the wave
//! times the Gaussian's Fourier transform, `exp(-k^2 D^2/32)`, or `exp(-(k_a^2 a^2 + k_b^2 b^2)/32)` over an ellipse of the
//! diameters a and b.
//!
//! **Slopes within.** What a mean over the spot takes from the variance of drawn slopes is still there: the facets get it, so
//! that all slopes together keep theirs, and f its mean.
//!
//! **The circle for an ellipse.** Waves are drawn down to `k = pi/D`, whatever their direction. To an ellipse a wave from an
//! azimuth phi from the longer axis is as long as to a circle of `D(phi) = sqrt(a^2 cos^2 phi + b^2 sin^2 phi)`. Where every
//! octave of waves has the same slope variance, the variance drawn down to `pi/D(phi)` is that drawn down to `pi/D` if ln D is
//! the mean of ln D(phi), which is `ln((a + b)/2)`.

use super::engagement::Engagement;
use crate::config::{Parameters, Water};
use crate::error::{Error, refuse};
use crate::numeric::quadrature::{gauss_legendre, midpoints, panels};
use crate::surface::{Point, Surface, Waves, mean_of_wave};
use glam::DVec2;
use std::f64::consts::{FRAC_PI_2, PI};

/// The longest ellipse, in widths of the beam: a flatter beam is met by faces of waves, whose slopes are about a tenth.
const LONGEST: f64 = 10.0;
/// Azimuths of a half turn, for slopes within a spot.
const AZIMUTHS: f64 = 128.0;
/// Nodes for one unit of ln k.
const NODES: usize = 16;

/// What a beam is taken to light of the mean surface.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum SpotShape {
    /// A circle of the beam's own diameter, whatever the incidence: the report's.
    #[default]
    Circle,
    /// The ellipse that the beam cuts out of the mean surface, at most ten times as long as it is wide.
    Ellipse,
}

/// A spot on the water, lit as a Gaussian.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spot {
    /// Unit vector along the longer axis.
    axis: DVec2,
    /// Diameters at 1/e^2 along that axis and across it, m.
    diameters: [f64; 2],
}

impl Spot {
    /// The spot of an engagement's beam, or of the parameters' footprint where the engagement has none.
    ///
    /// # Errors
    /// [`Error::Conflict`] where a footprint is given beside a beam.
    pub fn new(engagement: &Engagement, parameters: &Parameters, shape: SpotShape) -> Result<Self, Error> {
        let across = match (engagement.beam(), parameters.footprint) {
            (None, _) => parameters.footprint(),
            (Some(beam), None) => beam.width(engagement.range()) * parameters.footprint_measure.diameter(),
            (Some(beam), Some(footprint)) => {
                return Err(Error::Conflict {
                    first: "footprint",
                    first_value: footprint.to_string(),
                    second: "divergence",
                    second_value: beam.divergence().to_string(),
                    allowed: "footprint, divergence (with aperture)",
                });
            }
        };
        let [x, y, z] = engagement.direction();
        Ok(match shape {
            SpotShape::Circle => Self { axis: DVec2::X, diameters: [across; 2] },
            SpotShape::Ellipse => Self {
                axis: DVec2::new(x, y).try_normalize().unwrap_or(DVec2::X),
                diameters: [across * (1.0 / -z).min(LONGEST), across],
            },
        })
    }

    /// Unit vector along the longer axis.
    pub fn axis(&self) -> [f64; 2] {
        self.axis.into()
    }

    /// Diameters along that axis and across it, m, at 1/e^2 of the intensity in the middle.
    pub fn diameters(&self) -> [f64; 2] {
        self.diameters
    }

    /// D of the circle that stands for the spot where waves are divided into geometry and facets, m: the mean of the diameters.
    pub fn footprint(&self) -> f64 {
        0.5 * (self.diameters[0] + self.diameters[1])
    }

    /// The sea with that D.
    ///
    /// # Errors
    /// As [`Parameters::configure`].
    pub fn sea(&self, parameters: &Parameters) -> Result<Water, Error> {
        let footprint_measure = Default::default();
        Parameters { footprint: Some(self.footprint()), footprint_measure, ..*parameters }.configure()
    }

    /// Variances along x and y, and covariance, of the intensity about the middle, m^2: D^2/16 of a circle.
    pub(super) fn covariance(&self) -> [f64; 3] {
        let [along, across] = self.diameters.map(|d| d * d / 16.0);
        let DVec2 { x, y } = self.axis;
        [along * x * x + across * y * y, along * y * y + across * x * x, (along - across) * x * y]
    }

    /// The mean of a drawn surface over the spot about a place in m.
    pub fn mean(&self, surface: &Surface, place: [f64; 2]) -> Point {
        surface.mean(place, self.covariance())
    }

    /// Slope variances, upwind and crosswind, about their mean over the spot, of all that may be drawn.
    pub(super) fn slope_variances(&self, waves: &Waves) -> [f64; 2] {
        let mut sums = DVec2::ZERO;
        // A swell comes from one direction, nearly.
        let nodes = waves.swell_nodes().count();
        for wave in waves.swell_nodes() {
            let k = wave.wave_number * DVec2::from_angle(wave.azimuth);
            let left = mean_of_wave(self.covariance(), k.into()).powi(2);
            let slope = DVec2::from_angle(wave.azimuth - waves.wind_azimuth);
            let share = waves.of_swell() as f64 / nodes as f64;
            sums += share * wave.slope_variance() * (1.0 - left) * slope * slope;
        }
        let Some([low, high]) = waves.log_range else { return sums.into() };
        let (rule, s) = (gauss_legendre(NODES), &waves.spectrum);
        let azimuths = midpoints(-FRAC_PI_2, FRAC_PI_2, PI / AZIMUTHS);
        for piece in s.pieces(low.exp(), high.exp()).windows(2) {
            for (log_k, width) in panels(&rule, piece[0].ln(), piece[1].ln(), 1.0) {
                let k = log_k.exp();
                for (azimuth, turn) in &azimuths {
                    let wave = 100.0 * k * DVec2::from_angle(waves.wind_azimuth + azimuth);
                    let left = mean_of_wave(self.covariance(), wave.into()).powi(2);
                    let variance = k.powi(3) * s.density(k) * s.spreading(k, *azimuth) * (1.0 - left);
                    let slope = DVec2::from_angle(*azimuth);
                    sums += width * turn * variance * slope * slope;
                }
            }
        }
        sums.into()
    }

    /// The sea whose facets have the slopes within the spot beside their own.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] for an infinite footprint: there is no mean over all water.
    pub(super) fn averaged(&self, water: &Water) -> Result<Water, Error> {
        if !self.footprint().is_finite() {
            return refuse("footprint", self.footprint(), "finite, for a mean over the spot");
        }
        let within = DVec2::from(self.slope_variances(&water.waves()));
        let facets = DVec2::from(water.slopes.facets(water.footprint));
        Ok(water.with_variances((facets + within).into()))
    }
}
