//! What a user may choose, and the sea configured from it.

use super::slope_split::{SlopeBudget, SlopeSplit};
use crate::brdf::{Fresnel, Lobe, SlopeMeasure, SlopeStatistics, WindAxes};
use crate::error::{Error, Warning};
use crate::readings::Readings;
use crate::sea::whitecap::WhitecapOnset;
use crate::sea::{Salinity, SpectrumModel, Swell, Wind, WindProfile};
use std::f64::consts::{LN_2, SQRT_2};

/// Which surface the facets lie on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Surface {
    /// The normal that the geometry gives.
    #[default]
    Flat,
    /// Drawn waves.
    Instance,
    /// The mean over all drawn waves.
    Ensemble,
    /// The report's empirical model of it, from a table.
    Empirical,
}

/// The surfaces that have drawn waves.
pub(crate) const DRAWN: [Surface; 3] = [Surface::Instance, Surface::Ensemble, Surface::Empirical];

impl Surface {
    /// The footprint D in m unless one is given: infinite on a flat surface, which has no waves, else 0.15 m.
    pub fn default_footprint(self) -> f64 {
        if DRAWN.contains(&self) { 0.15 } else { f64::INFINITY }
    }
}

/// What is measured as the footprint.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum FootprintMeasure {
    /// The report's D: the diameter at which a Gaussian beam's intensity is 1/e^2 of its middle's.
    #[default]
    OneOverE2,
    /// The diameter at 1/e, as laser safety has it.
    OneOverE,
    /// The full width at half the maximum.
    HalfMaximum,
    /// The side of a square that is looked at evenly, as a pixel's: D has the same variance.
    Side,
}

impl FootprintMeasure {
    /// D for a width of 1: a Gaussian `exp(-8 r^2/D^2)` has its half at `D sqrt(ln 2/8)`, the variance `D^2/16` along each axis; a
    /// square of side a has `a^2/12`.
    pub fn diameter(self) -> f64 {
        match self {
            Self::OneOverE2 => 1.0,
            Self::OneOverE => SQRT_2,
            Self::HalfMaximum => (2.0 / LN_2).sqrt(),
            Self::Side => 2.0 / 3f64.sqrt(),
        }
    }
}

/// What a sea from afar reflects on average, of what its waves do.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Average {
    /// Power: f times the local cosine. Reciprocal.
    #[default]
    Power,
    /// The report's mean of f, times the cosine to the vertical.
    Report,
}

/// Where waves are geometry, whose slopes the facets' shadowing has.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Hiding {
    /// The whole sea's, as the report: what waves hide is then counted partly twice.
    #[default]
    Report,
    /// The facets' own: what longer waves hide is theirs to hide.
    Once,
}

/// How the empirical model falls off across the plane of incidence.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum OffPlaneModel {
    /// As the report's Gaussian, Eq. 90.
    #[default]
    Report,
    /// As the density of all slopes, drawn waves' and facets', in closed form.
    Slopes,
}

/// Everything a user may choose. Units: m, m/s, degrees, micrometres; cm/s for the friction velocity.
///
/// ```
/// use prob_water::{Parameters, Wind};
///
/// let calm = Parameters { wind: Wind::Speed { speed: 0.0, height: 10.0 }, ..Parameters::default() };
/// assert_eq!(calm.configure()?.wind.friction_velocity, 0.0);
/// let storm = Parameters { wind: Wind::FrictionVelocity(239.0), ..calm };
/// let refused = storm.configure().unwrap_err().to_string();
/// assert_eq!(refused, "friction_velocity = 239 is out of range: allowed is 0 to 238.65 cm/s, the end of Table 1");
/// # Ok::<(), prob_water::Error>(())
/// ```
///
/// The fields, by the names that scene files, flags and C have too; `wind` is the first four:
///
#[doc = include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/docs/parameters.md"))]
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Parameters {
    /// The wind.
    pub wind: Wind,
    /// Azimuth the wind comes from, degrees counter-clockwise from +x.
    pub wind_direction: f64,
    /// Width of what is lit or looked at, m, which gives the report's D: waves shorter than 2 D are facets. Infinite: all waves are.
    /// `None`: the surface's [default](Surface::default_footprint).
    pub footprint: Option<f64>,
    /// Which width that is.
    pub footprint_measure: FootprintMeasure,
    /// Where the facets lie.
    pub surface: Surface,
    /// What the mean over all drawn waves is of; has no effect on other surfaces.
    pub average: Average,
    /// How the empirical model falls off across the plane; has no effect on other surfaces.
    pub across: OffPlaneModel,
    /// The report's M: waves of a drawn surface.
    pub components: u32,
    /// The report's N: drawn surfaces of an ensemble.
    pub instances: u64,
    /// Chooses the random numbers, below 2^53.
    pub seed: u64,
    /// Time at which waves are drawn, s.
    pub time: f64,
    /// Depth of the water, m.
    pub depth: f64,
    /// Distance to the shore the wind comes from, m: matters to 100 km.
    pub fetch: f64,
    /// Whose energy spectrum the waves have.
    pub spectrum: SpectrumModel,
    /// Significant height of a swell beside the wind's waves, m; 0: there is none.
    pub swell_height: f64,
    /// Period of its peak, s.
    pub swell_period: f64,
    /// Azimuth it comes from, degrees; else the wind's.
    pub swell_direction: Option<f64>,
    /// Measured statistics of the slopes of all waves.
    pub slopes: SlopeStatistics,
    /// How these are divided between drawn waves and facets.
    pub slope_budget: SlopeBudget,
    /// Micrometres.
    pub wavelength: f64,
    /// Refractive index; else that of water of a `salinity` at `wavelength` and `temperature`.
    pub ior: Option<f64>,
    /// Extinction coefficient k, the imaginary part of the index; else that of water at `wavelength`, or 0 with an `ior` or
    /// [`Readings::EQ_62`].
    pub extinction: Option<f64>,
    /// Salt or fresh.
    pub water: Salinity,
    /// Degrees Celsius: the index is then Quan and Fry's, in the visible; else Hale and Querry's, at 25 degrees.
    pub temperature: Option<f64>,
    /// Salt in per mille, for the index; else that of `water`.
    pub salinity: Option<f64>,
    /// Reflectance of a facet.
    pub fresnel: Fresnel,
    /// Measure of the slope density.
    pub slope_measure: SlopeMeasure,
    /// Which equations are taken as printed.
    pub readings: Readings,
    /// Whitecaps blended in.
    pub whitecaps: bool,
    /// Where on drawn waves they stand.
    pub whitecap_onset: WhitecapOnset,
    /// For how long their foam stays there, s: the time in which it falls to 1/e. 0: as long as the wave breaks, as in the report.
    pub whitecap_lifetime: f64,
    /// Shadowing function applied.
    pub shadowing: bool,
    /// Whose slopes it has.
    pub hiding: Hiding,
    /// Skewness and kurtosis applied.
    pub gram_charlier: bool,
}

impl Default for Parameters {
    fn default() -> Self {
        Self {
            wind: Wind::Speed { speed: 5.0, height: 10.0 },
            wind_direction: 0.0,
            footprint: None,
            footprint_measure: FootprintMeasure::OneOverE2,
            surface: Surface::Flat,
            average: Average::Power,
            across: OffPlaneModel::Report,
            components: 5,
            instances: 50,
            seed: 0,
            time: 0.0,
            depth: f64::INFINITY,
            fetch: f64::INFINITY,
            spectrum: SpectrumModel::Report,
            swell_height: 0.0,
            swell_period: 12.0,
            swell_direction: None,
            slopes: SlopeStatistics::CoxMunk,
            slope_budget: SlopeBudget::Report,
            wavelength: 0.55,
            ior: None,
            extinction: None,
            water: Salinity::Ocean,
            temperature: None,
            salinity: None,
            fresnel: Fresnel::Schlick,
            slope_measure: SlopeMeasure::Angle,
            readings: Readings::CORRECTED,
            whitecaps: true,
            whitecap_onset: WhitecapOnset::Calibrated,
            whitecap_lifetime: 0.0,
            shadowing: true,
            hiding: Hiding::Report,
            gram_charlier: true,
        }
    }
}

/// A configured sea: checked parameters, what follows from them once, and the coefficients to evaluate.
#[derive(Debug, Clone, Copy)]
pub struct Water {
    /// What it was made from.
    pub parameters: Parameters,
    /// The report's D in use, m.
    pub footprint: f64,
    /// The wind at every height the model needs.
    pub wind: WindProfile,
    /// Refractive index in use.
    pub ior: f64,
    /// Extinction coefficient in use; 0 where it changes nothing.
    pub extinction: f64,
    /// Slope variances of the facets, upwind and crosswind (Eqs. 74-77, or what drawn waves leave).
    pub variances: [f64; 2],
    /// F_WC (Eq. 51), whether or not whitecaps are blended in.
    pub whitecap_fraction: f64,
    /// Which waves are drawn, and what slopes they leave to facets, for every footprint.
    pub(crate) slopes: SlopeSplit,
    /// The BRDF at a point.
    pub(crate) lobe: Lobe<f64>,
}

/// More components than any surface needs: 512 fill a renderer's.
pub const MOST_COMPONENTS: u32 = 65_536;
/// More instances than any mean needs.
pub const MOST_INSTANCES: u64 = 1_000_000_000;
/// Times reach to this far from 0, s: beyond, phases would lose their last digits.
pub const LONGEST_TIME: f64 = 1e9;
/// Seeds are below it: float64 holds all of them.
pub(crate) const SEEDS: u64 = 1 << 53;

impl Water {
    /// The BRDF of a flat surface: facets about the vertical, or about normals that the caller brings, and the whitecaps of
    /// Eq. 51.
    ///
    /// # Errors
    /// [`Error::Surface`] where the surface has drawn waves. They have BRDFs of their own, [`crate::InstanceLobe`],
    /// [`crate::EnsembleLobe`] and [`crate::EmpiricalLobe`]; what lies on them is [`Water::local_lobe`].
    pub fn lobe(&self) -> Result<Lobe<f64>, Error> {
        let own = match self.parameters.surface {
            Surface::Flat => return Ok(self.lobe),
            Surface::Instance => "InstanceLobe",
            Surface::Ensemble => "EnsembleLobe",
            Surface::Empirical => "EmpiricalLobe",
        };
        let value = self.parameters.surface.name();
        Err(Error::Surface { value, allowed: format!("flat; {own} is the BRDF of {value}") })
    }

    /// The BRDF at a point of any surface about that point's own normal: the facets, of waves shorter than two footprints,
    /// and the whitecaps of Eq. 51. For callers who bring the normals of the longer waves, as those of a mesh. By itself it
    /// is not the BRDF of a surface with drawn waves.
    pub fn local_lobe(&self) -> Lobe<f64> {
        self.lobe
    }

    /// Values that are allowed but hardly meant, as a mistaken unit makes them.
    pub fn warnings(&self) -> Vec<Warning> {
        let p = &self.parameters;
        let unusual = |parameter, value: f64, holds: bool, usual| {
            (!holds).then(|| Warning { parameter, value: value.to_string(), usual })
        };
        let (d, azimuth) = (self.footprint, p.wind_direction);
        let w = if let Wind::FrictionVelocity(w) = p.wind { w } else { 0.0 };
        [
            unusual("friction_velocity", w, w == 0.0 || w >= 1.0, "0, or from 1 cm/s (not m/s)"),
            unusual("wind_direction", azimuth, azimuth.abs() <= 360.0, "-360 to 360 degrees"),
            unusual("footprint", d, d.is_infinite() || (1e-3..=100.0).contains(&d), "0.001 to 100 m, or inf"),
        ]
        .into_iter()
        .flatten()
        .collect()
    }

    /// Smallest and largest wave number drawn (Eqs. 21-22, or by the slope budget), rad/cm; `None`: there are no waves.
    pub fn wave_numbers(&self) -> Option<[f64; 2]> {
        self.slopes.range(self.footprint)
    }

    /// Slope variances, upwind and crosswind, of the facets of places with another footprint in m, beside waves that fade out
    /// in an octave about two footprints.
    pub fn facet_variances(&self, footprint: f64) -> [f64; 2] {
        self.slopes.facets_beside_fading(footprint)
    }

    /// The same sea with other slope variances of the facets, upwind and crosswind.
    pub(crate) fn with_variances(mut self, variances: [f64; 2]) -> Self {
        self.variances = variances;
        self.lobe.facets = self.parameters.facets(&self.wind, [self.ior, self.extinction], variances);
        self
    }

    /// The same sea under a wind from another azimuth, in degrees.
    pub(crate) fn turned(mut self, degrees: f64) -> Self {
        self.parameters.wind_direction = degrees;
        self.lobe.facets.wind = WindAxes::new(degrees);
        self
    }
}

impl Parameters {
    /// The footprint in m by its measure: as given, or the surface's [default](Surface::default_footprint).
    pub(crate) fn width(&self) -> f64 {
        self.footprint.unwrap_or_else(|| self.surface.default_footprint())
    }

    /// The swell; `None` where it has no height.
    pub fn swell(&self) -> Option<Swell> {
        let azimuth = self.swell_direction.unwrap_or(self.wind_direction).to_radians();
        (self.swell_height > 0.0)
            .then(|| Swell::new(self.swell_height, self.swell_period, azimuth, self.depth))
    }

    /// The report's D in m.
    pub fn footprint(&self) -> f64 {
        self.width() * self.footprint_measure.diameter()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A beam `exp(-8 r^2/D^2)` has the intensity that the measure names where the width of 1 ends, or a square's variance.
    #[test]
    fn diameters_are_of_one_beam() {
        let at_edge = |measure: FootprintMeasure| (-8.0 * 0.25 / measure.diameter().powi(2)).exp();
        assert!((at_edge(FootprintMeasure::OneOverE2) - (-2f64).exp()).abs() < 1e-15);
        assert!((at_edge(FootprintMeasure::OneOverE) - (-1f64).exp()).abs() < 1e-15);
        assert!((at_edge(FootprintMeasure::HalfMaximum) - 0.5).abs() < 1e-15);
        assert!((FootprintMeasure::Side.diameter().powi(2) / 16.0 - 1.0 / 12.0).abs() < 1e-15);
        let wide = Parameters {
            footprint: Some(0.2),
            footprint_measure: FootprintMeasure::OneOverE,
            ..Parameters::default()
        };
        let same = Parameters { footprint: Some(0.2 * SQRT_2), ..Parameters::default() };
        assert_eq!(wide.configure().unwrap().variances, same.configure().unwrap().variances);
        assert_eq!(wide.configure().unwrap().footprint, same.footprint());
    }
}
