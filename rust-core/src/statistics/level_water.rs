//! What a table is interpolated relative to: what a sea's facets would reflect if those of all its drawn waves lay together
//! on level water. The mean over drawn waves is close to it, and their ratio changes slowly with wind, footprint and
//! directions, where the mean itself changes by orders of magnitude.

use super::characteristic::variances;
use super::exact::Exact;
use super::facet_density;
use crate::brdf::shadowing::cos_lambda;
use crate::brdf::{Facets, Lobe, Reflectance, WindAxes};
use crate::config::Water;
use crate::surface::normal;
use glam::{DVec2, DVec3};
use std::f64::consts::{SQRT_2, TAU};

/// The logarithm of next to nothing, in float32.
pub(crate) const NOTHING: f64 = -87.0;

/// Cosines to the normals of waves are at least this.
pub(crate) const MIN_COS: f64 = 1e-3;

/// What depends on the variances of the slopes alone.
#[derive(Debug, Clone, Copy)]
pub(crate) struct BaselineLobe {
    /// Facets with the slope variances of all waves; their reflectance is 1.
    all: Facets<f64>,
    /// Standard deviations of the drawn slopes, upwind and crosswind.
    drawn: DVec2,
}

impl BaselineLobe {
    /// Of a sea with drawn waves.
    pub fn new(water: &Water) -> Self {
        let [drawn_u, drawn_c, _] = variances(&water.waves());
        let [facets_u, facets_c] = water.variances;
        let all = water.parameters.facets(
            &water.wind,
            [water.ior, water.extinction],
            [facets_u + drawn_u, facets_c + drawn_c],
        );
        let reflectance =
            Reflectance { normal: 1.0, excess: 0.0, absorption: 0.0, exact: false, absorbing: false };
        let drawn = DVec2::new(drawn_u, drawn_c).powf(0.5);
        Self { all: Facets { reflectance, bounded: false, own_shadows: false, ..all }, drawn }
    }

    /// The same sea under a wind from another azimuth, in degrees.
    pub fn turned(mut self, degrees: f64) -> Self {
        self.all.wind = WindAxes::new(degrees);
        self
    }

    fn to_wind(self, v: DVec2) -> DVec2 {
        let wind = DVec2::new(self.all.wind.cos, self.all.wind.sin);
        DVec2::new(v.dot(wind), v.dot(wind.perp()))
    }

    /// Standard deviations of all slopes, upwind and crosswind.
    pub fn sigmas(&self) -> [f64; 2] {
        [self.all.sigma_u, self.all.sigma_c]
    }

    /// How much wider all slopes are than the facets', in both directions together.
    pub fn narrowness(&self) -> f64 {
        let all = DVec2::from(self.sigmas());
        let facets = (all * all - self.drawn * self.drawn).max(DVec2::splat(1e-9)).powf(0.5);
        (all / facets).element_product()
    }

    fn to_world(self, v: DVec2) -> DVec2 {
        let wind = DVec2::new(self.all.wind.cos, self.all.wind.sin);
        v.x * wind + v.y * wind.perp()
    }

    /// Draws directions roughly as the sea reflects, with its own reflectance and whitecaps.
    pub fn sampler(&self, water: &Water) -> Lobe<f64> {
        let reflectance = water.lobe.facets.reflectance;
        Lobe { facets: Facets { reflectance, ..self.all }, ..water.lobe }
    }

    /// Smith's term for a direction above the horizon: how much of what it sees drawn waves hide.
    pub fn lambda(&self, v: [f64; 3]) -> f64 {
        let cos = v[2].max(1e-9);
        cos_lambda(cos, SQRT_2 * (self.to_wind(DVec2::new(v[0], v[1])) * self.drawn).length()) / cos
    }

    /// Smith's share of what drawn waves leave visible to an observer, of what the source hits.
    pub fn share(&self, i: [f64; 3], o: [f64; 3]) -> f64 {
        let [lambda_i, lambda_o] = [i, o].map(|v| self.lambda(v));
        (1.0 + lambda_i) / (1.0 + lambda_i + lambda_o)
    }

    /// Probability that an observer sees nothing of what the source hits: the wave there turns from the observer, were
    /// drawn slopes Gaussian and met in proportion to the area they show the source, or another hides it (Smith's share).
    pub fn unseen(&self, i: [f64; 3], o: [f64; 3]) -> f64 {
        let [i_wind, o_wind] = [i, o].map(|v| self.to_wind(DVec2::new(v[0], v[1])));
        let spread = (o_wind * self.drawn).length();
        if spread * 40.0 < o[2] {
            return 1.0 - self.share(i, o);
        }
        let limit = o[2] / spread;
        let facing = 0.5 * libm::erfc(-limit / SQRT_2);
        let along = (i_wind * self.drawn).dot(o_wind * self.drawn) / spread;
        let density = (-0.5 * limit * limit).exp() / TAU.sqrt();
        (1.0 - self.share(i, o) * (facing + along / i[2].max(MIN_COS) * density)).clamp(0.0, 1.0)
    }

    /// `G/(cos theta_i cos theta_r)` on level water.
    pub fn shadowing(&self, i: [f64; 3], o: [f64; 3]) -> f64 {
        if i[2] <= 0.0 || o[2] <= 0.0 {
            return 0.0;
        }
        self.all.shadowed_reflectance(i, o, None) / (i[2] * o[2])
    }

    /// Of a half vector's slope, upwind and crosswind, the share that the waves which carry its facets have, on average.
    pub fn carried(&self) -> [f64; 2] {
        (self.drawn * self.drawn / DVec2::from(self.sigmas()).powf(2.0)).into()
    }

    /// The same as [`BaselineLobe::shadowing`], towards the observer about the normal of those waves.
    pub fn leaning(&self, i: [f64; 3], o: [f64; 3]) -> f64 {
        let [i, o] = [i, o].map(DVec3::from);
        let half = i + o;
        let slope = self.to_wind(-half.truncate() / half.z) * DVec2::from(self.carried());
        let lean = slope.length_squared();
        let cos = ((o.z - slope.dot(self.to_wind(o.truncate()))) / (1.0 + lean).sqrt()).max(MIN_COS);
        let mut area = i.z * cos;
        if self.all.shadowing {
            let sigma_sin = |cos: f64| self.all.sigma_shadow * (1.0 - cos * cos).max(0.0).sqrt();
            let part = |cos: f64| self.all.masked(cos, sigma_sin(cos));
            area += cos * part(i.z) + i.z * part(cos);
        }
        1.0 / area
    }

    /// Logarithm of the mean square of f over its squared mean, if facets' and drawn waves' slopes are Gaussian.
    pub fn ln_square(&self, i: [f64; 3], o: [f64; 3]) -> f64 {
        let [x, y, z] = [0, 1, 2].map(|k| i[k] + o[k]);
        let axis = |h: f64, all: f64, drawn: f64| {
            // Variances of all slopes, of the facets' alone, and as wide as f squared is once drawn.
            let (all, drawn) = (all * all, drawn * drawn);
            let (facets, twice) = ((all - drawn).max(1e-9), all + drawn);
            let tilt = h.atan2(z);
            (all / (facets * twice).sqrt()).ln() + tilt * tilt * (1.0 / all - 1.0 / twice)
        };
        let h = self.to_wind(DVec2::new(x, y));
        axis(h.x, self.all.sigma_u, self.drawn.x) + axis(h.y, self.all.sigma_c, self.drawn.y)
    }
}

/// The density of facets along a half vector, with the 1/4 of Eq. 56, over its tilt angles upwind and crosswind, 0 in the
/// middle: so many nodes on a side, row by row of those upwind, the logarithm of its ratio to Gauss's function of the two
/// angles, of all slopes' variances; and the steps between nodes in standard deviations.
pub(crate) fn ln_densities(exact: &Exact, baseline: &BaselineLobe, rows: usize) -> (Vec<f64>, [f64; 2]) {
    let table = exact.facet_density();
    let middle = 0.5 * (rows - 1) as f64;
    let sigmas = DVec2::from(baseline.sigmas());
    let steps = sigmas.map(|sigma| facet_density::end(sigma) / sigma) / middle;
    let at = |n: usize| {
        let place = (DVec2::new((n / rows) as f64, (n % rows) as f64) - middle) * steps;
        let slope = (place * sigmas).map(f64::tan);
        let density = match &table {
            Some(table) => table.at(slope).density,
            None => baseline.all.density_along(normal(baseline.to_world(slope).into()), None),
        };
        density.ln().max(NOTHING) + 0.5 * place.length_squared()
    };
    ((0..rows * rows).map(at).collect(), steps.into())
}
