//! From parameters to a sea: everything is checked once and turned into coefficients.

use super::parameters::{Hiding, Parameters, Surface, Water};
use super::slope_split::SlopeSplit;
use super::vocabulary::check;
use crate::brdf::lobe::steep_gain;
use crate::brdf::slopes::GramCharlier;
use crate::brdf::{Dispersion, Facets, Lobe, Reflectance, SlopeMeasure, WindAxes, fresnel, shadowing};
use crate::error::{Error, refuse};
use crate::readings::Readings;
use crate::sea::{Spectrum, SpectrumModel, WindProfile, whitecap};

impl Parameters {
    /// Checks everything and computes what depends on the parameters alone.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] with the parameter, its value and what is allowed.
    pub fn configure(&self) -> Result<Water, Error> {
        let wind = self.wind.profile()?;
        let footprint = self.footprint();
        check("wind_direction", self.wind_direction, self.wind_direction)?;
        check("footprint", self.width(), self.width())?;
        check("components", f64::from(self.components), self.components)?;
        check("instances", self.instances as f64, self.instances)?;
        check("seed", self.seed as f64, self.seed)?;
        check("time", self.time, self.time)?;
        check("depth", self.depth, self.depth)?;
        check("fetch", self.fetch, self.fetch)?;
        let needs_fetch = matches!(self.spectrum, SpectrumModel::Jonswap | SpectrumModel::Tma);
        if needs_fetch && self.fetch.is_infinite() {
            return refuse("fetch", self.fetch, "above 0 m, finite, with spectrum = jonswap or tma");
        }
        check("whitecap_lifetime", self.whitecap_lifetime, self.whitecap_lifetime)?;
        self.check_swell()?;
        if matches!(self.surface, Surface::Ensemble | Surface::Empirical) {
            self.refuse_drawn_seas("with surface = ensemble or empirical")?;
        }
        check("wavelength", self.wavelength, self.wavelength)?;
        let optional = [
            ("ior", self.ior),
            ("extinction", self.extinction),
            ("temperature", self.temperature),
            ("salinity", self.salinity),
        ];
        for (name, value) in optional {
            value.map_or(Ok(()), |x| check(name, x, x))?;
        }
        let [ior, extinction] = self.index()?;
        let spectrum = Spectrum::new(self.spectrum, &wind, self.water, self.depth, self.fetch);
        let slopes = SlopeSplit::new(self.slope_budget, &wind, spectrum, self.slopes, self.readings);
        let variances = slopes.facets(footprint);
        let whitecap_fraction = whitecap::fraction(wind.w10);
        Ok(Water {
            parameters: *self,
            footprint,
            wind,
            ior,
            extinction,
            variances,
            whitecap_fraction,
            slopes,
            lobe: Lobe {
                facets: self.facets(&wind, [ior, extinction], variances),
                whitecap_fraction: 0.0,
                smooth_fraction: 1.0,
                whitecap_brdf: whitecap::brdf(self.wavelength),
            }
            .with_whitecaps(if self.whitecaps { whitecap_fraction } else { 0.0 }),
        })
    }

    /// Refuses what drawn seas alone have, a past and a swell, in a place that has all seas at once.
    pub(crate) fn refuse_drawn_seas(&self, place: &str) -> Result<(), Error> {
        if self.whitecap_lifetime > 0.0 {
            let allowed = format!("0 s {place}: drawn seas alone have a past");
            return refuse("whitecap_lifetime", self.whitecap_lifetime, allowed);
        }
        if self.swell_height > 0.0 {
            return refuse(
                "swell_height",
                self.swell_height,
                format!("0 m {place}: drawn seas alone have a swell"),
            );
        }
        Ok(())
    }

    /// Refuses a swell that would break, and one that a footprint does not resolve where it is drawn.
    fn check_swell(&self) -> Result<(), Error> {
        check("swell_height", self.swell_height, self.swell_height)?;
        check("swell_period", self.swell_period, self.swell_period)?;
        self.swell_direction.map_or(Ok(()), |x| check("swell_direction", x, x))?;
        let Some(swell) = self.swell() else { return Ok(()) };
        let (period, depth) = (self.swell_period, self.depth);
        let (highest, largest) = (swell.highest(), swell.largest_footprint());
        if self.swell_height > highest {
            let allowed = format!("0 to {highest:.3} m with swell_period = {period} and depth = {depth}");
            return refuse("swell_height", self.swell_height, allowed);
        }
        if self.surface == Surface::Instance && self.footprint() > largest {
            let allowed = format!(
                "above 0 m, up to D = {largest:.3} m with swell_period = {period} and depth = {depth}"
            );
            return refuse("footprint", self.width(), allowed);
        }
        Ok(())
    }

    /// The complex refractive index, n and k.
    fn index(&self) -> Result<[f64; 2], Error> {
        let [pure, absorption] = fresnel::pure_water(self.wavelength);
        let salinity = self.salinity.unwrap_or(self.water.per_mille());
        let ior = match (self.ior, self.temperature) {
            (Some(ior), _) => ior,
            (None, None) => pure + fresnel::salt(self.wavelength, salinity),
            (None, Some(_)) if !(fresnel::QUAN_FRY[0]..=fresnel::QUAN_FRY[1]).contains(&self.wavelength) => {
                let allowed = "0.4 to 0.7 micrometres with a temperature (Quan and Fry)";
                return refuse("wavelength", self.wavelength, allowed);
            }
            (None, Some(temperature)) => fresnel::quan_fry(self.wavelength, temperature, salinity),
        };
        let transparent = self.ior.is_some() || self.readings.contains(Readings::EQ_62);
        let extinction = self.extinction.unwrap_or(if transparent { 0.0 } else { absorption });
        Ok([ior, fresnel::relevant_extinction(ior, extinction)])
    }

    /// The index n at a wavelength in micrometres that is not the parameters' own: an `ior` is that of all; Quan and Fry's law is
    /// held beyond its range.
    fn index_at(&self, wavelength: f64) -> f64 {
        let [first, last] = fresnel::QUAN_FRY;
        let own = Self {
            wavelength: if self.temperature.is_some() { wavelength.clamp(first, last) } else { wavelength },
            ..*self
        };
        own.index().map_or(f64::NAN, |[n, _]| n)
    }

    /// The facets of a wind, an index and slope variances.
    pub(crate) fn facets(&self, wind: &WindProfile, index: [f64; 2], variances: [f64; 2]) -> Facets<f64> {
        let [sigma_u, sigma_c] = variances.map(f64::sqrt);
        let eq_56 = if self.readings.contains(Readings::EQ_56) { std::f64::consts::FRAC_PI_4 } else { 0.25 };
        let slope_measure = self.slope_measure == SlopeMeasure::Slope;
        let mut facets = Facets {
            sigma_u,
            sigma_c,
            inv_width_u: 1.0,
            inv_width_c: 1.0,
            scale: 1.0,
            steep_gain: steep_gain(sigma_u.max(sigma_c)),
            // In tilt angles facets show up to (8 sigma_i^2 + 3 sigma_j^2)/3 more area than their slopes' Lambda.
            // A percent is left to quadratures and rounding, so that "at most 1" can be checked.
            bound: 0.99 / if slope_measure { 1.0 } else { 1.0 + 3.0 * (variances[0] + variances[1]) },
            proposal: [sigma_u, sigma_c],
            bounded: false,
            wind: WindAxes::new(self.wind_direction),
            correction: GramCharlier::new(
                self.slopes.skewness(wind),
                self.slopes.kurtosis(),
                self.readings.contains(Readings::EQ_78),
            ),
            sigma_shadow: shadowing::sigma(wind.w10),
            own_shadows: self.hiding == Hiding::Once && self.footprint().is_finite(),
            reflectance: Reflectance::new(index, self.fresnel),
            slope_measure,
            gram_charlier: self.gram_charlier,
            shadowing: self.shadowing,
            readings: self.readings,
        };
        facets.set_sigmas([sigma_u, sigma_c], eq_56 / std::f64::consts::TAU);
        let stretch = facets.proposal_stretch();
        facets.proposal = facets.proposal.map(|sigma| sigma * stretch);
        // The bound is one of the corrected shadowing. That of the facets' own slopes needs it wherever angles gain.
        let needs_bound = facets.own_shadows || facets.needs_bound();
        facets.bounded = self.shadowing && !facets.printed_shadowing() && needs_bound;
        facets
    }
}

impl Water {
    /// Index and whitecaps by wavelength, for light that is seen, beside the lobe at the parameters' wavelength. The extinction
    /// coefficient is the lobe's; by itself it is 0 in the visible. With `fixed` whitecaps are the lobe's as well.
    pub fn dispersion(&self, fixed: bool) -> Dispersion<f64> {
        let whitecaps = |wavelength| {
            if fixed { 1.0 } else { whitecap::brdf(wavelength) / self.lobe.whitecap_brdf }
        };
        Dispersion::new(self.lobe.facets.reflectance, self.extinction, |wavelength| {
            [self.parameters.index_at(wavelength), whitecaps(wavelength)]
        })
    }
}
