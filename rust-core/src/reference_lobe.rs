//! The closed form of a sea whose drawn waves are facets as well: what a table is interpolated relative to.
//!
//! The mean over drawn waves is close to the lobe of facets with the slope variances of both together, and their ratio
//! changes slowly with wind, footprint and directions, where the mean itself changes by orders of magnitude.

use crate::brdf::{Facets, up};
use crate::characteristic::variances;
use crate::optics::Reflectance;
use crate::shadowing::hidden;
use crate::{Lobe, Water};
use std::f64::consts::SQRT_2;

/// What is left of the Gaussian where Eq. 78 would be less: quotients by this lobe stay finite.
const LEAST_CORRECTION: f64 = 0.1;

/// All waves as facets.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Reference {
    /// The lobe, with the sea's reflectance; its share of whitecaps is that of the sea.
    pub lobe: Lobe<f64>,
    /// The same without a reflectance.
    bare: Facets<f64>,
    /// Standard deviations of the drawn slopes, upwind and crosswind.
    pub drawn: [f64; 2],
}

impl Reference {
    /// Of a sea with drawn waves.
    pub fn new(water: &Water) -> Self {
        let [drawn_u, drawn_c, _] = variances(&water.waves());
        let [facets_u, facets_c] = water.variances;
        let all = [facets_u + drawn_u, facets_c + drawn_c];
        let mut facets = water.parameters.facets(&water.wind, water.ior, all);
        // Drawn slopes are symmetric: third moments are the facets' alone.
        let [u, c] = [facets_u / all[0], facets_c / all[1]].map(f64::sqrt);
        facets.c21 *= u * c * c;
        facets.c03 *= u * u * u;
        facets.least_correction = LEAST_CORRECTION;
        facets.bounded = false;
        let bare = Facets { reflectance: Reflectance { normal: 1.0, ior2: 1.0, exact: false }, ..facets };
        Self { lobe: Lobe { facets, ..water.lobe }, bare, drawn: [drawn_u.sqrt(), drawn_c.sqrt()] }
    }

    /// The same sea under a wind from another azimuth, in degrees.
    pub fn turned(mut self, degrees: f64) -> Self {
        let (sin, cos) = degrees.to_radians().sin_cos();
        for facets in [&mut self.lobe.facets, &mut self.bare] {
            (facets.sin_wind, facets.cos_wind) = (sin, cos);
        }
        self
    }

    /// Logarithm of the mean square of f over its squared mean, if facets' and drawn waves' slopes are Gaussian.
    pub fn ln_square(&self, i: [f64; 3], o: [f64; 3]) -> f64 {
        let f = &self.bare;
        let [x, y, z] = [0, 1, 2].map(|k| i[k] + o[k]);
        let axis = |h: f64, all: f64, drawn: f64| {
            // Variances of all slopes, of the facets' alone, and as wide as f squared is once drawn.
            let (all, drawn) = (all * all, drawn * drawn);
            let (facets, twice) = ((all - drawn).max(1e-9), all + drawn);
            let tilt = h.atan2(z);
            (all / (facets * twice).sqrt()).ln() + tilt * tilt * (1.0 / all - 1.0 / twice)
        };
        axis(x * f.cos_wind + y * f.sin_wind, f.sigma_u, self.drawn[0])
            + axis(y * f.cos_wind - x * f.sin_wind, f.sigma_c, self.drawn[1])
    }

    /// f over rho of level water, 1/sr, for unit vectors to source and observer.
    pub fn eval(&self, i: [f64; 3], o: [f64; 3]) -> f64 {
        self.bare.eval(i, o, up())
    }

    /// Smith's term for a direction above the horizon: how much of what it sees drawn waves hide.
    pub fn hidden(&self, v: [f64; 3]) -> f64 {
        let f = &self.bare;
        let [u, c] = [v[0] * f.cos_wind + v[1] * f.sin_wind, v[1] * f.cos_wind - v[0] * f.sin_wind];
        let cos = v[2].max(1e-9);
        hidden(cos, SQRT_2 * (u * self.drawn[0]).hypot(c * self.drawn[1])) / cos
    }

    /// What drawn waves leave visible to an observer, of what the source hits.
    pub fn visible(&self, i: [f64; 3], o: [f64; 3]) -> f64 {
        let [i, o] = [i, o].map(|v| self.hidden(v));
        (1.0 + i) / (1.0 + i + o)
    }

    /// f over rho in the plane of incidence that is x and z's, at an angle theta_r, with what is hidden.
    pub fn in_plane(&self, source: [f64; 3], theta: f64) -> f64 {
        let o = [theta.sin(), 0.0, theta.cos()];
        self.eval(source, o) * self.visible(source, o)
    }
}
