//! The report's empirical model for one angle of incidence (section 9): the mean and the spread of the BRDF in the plane of
//! incidence, and the width and the offset of the lobe across it, over drawn surfaces; and the BRDF of any direction
//! from these few numbers (Eqs. 89-91).
//!
//! Facets and whitecaps are kept apart and without the reflectance rho and the whitecaps' f_WC, which are all that depends
//! on the wavelength: directions fix rho. So the same numbers serve every wavelength and index.

use crate::characteristic::variances;
use crate::gaussian_fit::Gaussian;
use crate::planes::{Planes, width};
use crate::{Engagement, Ensemble, Error, Presence, Water};
use std::f64::consts::FRAC_PI_2;

/// How far laser and observers are, m: the far field.
const LASER: f64 = 10e3;
const OBSERVERS: f64 = 100e3;
/// Nodes across the plane, to so many widths of the lobe at either side.
const ACROSS: i32 = 24;
const REACH: f64 = 3.0;

/// Means over drawn surfaces at one direction; 0 where the observer cannot see the hit.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Moments {
    /// Of the facets' f over rho, 1/sr, whitecaps counting as 0.
    pub facets: f64,
    /// Of its square.
    pub facets2: f64,
    /// Share of surfaces where a whitecap is seen.
    pub whitecaps: f64,
}

impl Moments {
    /// Mean and standard deviation of f, 1/sr, for a reflectance and a whitecap's BRDF. A surface shows one or the other.
    pub fn brdf(&self, rho: f64, whitecap: f64) -> [f64; 2] {
        let mean = rho * self.facets + whitecap * self.whitecaps;
        let square = rho * rho * self.facets2 + whitecap * whitecap * self.whitecaps;
        [mean, (square - mean * mean).max(0.0).sqrt()]
    }
}

/// The numbers for an angle of incidence.
#[derive(Debug, Clone, PartialEq)]
pub struct Node {
    /// Source, vertical and what follows from them.
    pub planes: Planes,
    /// Angles theta_r in the plane, rising, radians.
    pub thetas: Vec<f64>,
    /// At every one of them.
    pub in_plane: Vec<Moments>,
    /// sigma(0) of Eq. 89, radians: the 1/e half width of the mean lobe across the plane, over cos theta_i.
    pub sigma: f64,
    /// Its standard deviation over surfaces, each fitted by itself.
    pub u_sigma: f64,
    /// delta, radians: where the mean lobe across the plane peaks.
    pub delta: f64,
    /// Its standard deviation over surfaces.
    pub u_delta: f64,
    /// Share of surfaces whose lobe could be fitted.
    pub fitted: f64,
}

impl Node {
    /// Draws the surfaces of a sea (its wind's azimuth counts from the plane of incidence, away from the source) under a
    /// beam at an angle of incidence, and looks at them at the rising angles `thetas`; radians.
    pub fn new(water: &Water, incidence: f64, thetas: &[f64]) -> Result<Self, Error> {
        let source = [-incidence.sin(), 0.0, incidence.cos()];
        let planes = Planes::new(source, water.parameters.wind_direction.to_radians());
        // So far across as the lobe is wide, from the slopes' standard deviation across; refined once by its own fit.
        let [upwind, crosswind, _] = variances(&water.waves());
        let slopes = water.variances.iter().sum::<f64>() + upwind + crosswind;
        let mut reach = (REACH * 2.0 * slopes.sqrt() * incidence.cos().max(0.05)).min(0.95 * FRAC_PI_2);
        let mut node = Self::looked_at(water, &planes, thetas, reach)?;
        let wanted = REACH * width(node.sigma, incidence, incidence);
        if node.sigma > 0.0 && !(0.7..1.4).contains(&(wanted / reach)) {
            reach = wanted.min(0.95 * FRAC_PI_2);
            node = Self::looked_at(water, &planes, thetas, reach)?;
        }
        Ok(node)
    }

    /// Mean of f, 1/sr, and its standard uncertainty (Eqs. 90-91) towards a unit vector to the observer, for a reflectance
    /// between it and the source and a whitecap's BRDF. Whitecaps reflect evenly: only facets fall off across the plane.
    pub fn brdf(&self, to_observer: [f64; 3], rho: f64, whitecap: f64) -> [f64; 2] {
        if to_observer[2] <= 0.0 {
            return [0.0; 2];
        }
        let [theta, phi] = self.planes.angles(to_observer);
        let moments = self.at(theta);
        let sigma = width(self.sigma, self.planes.incidence, theta);
        let off = phi - self.delta;
        let fall = if sigma > 0.0 { (-(off / sigma).powi(2)).exp() } else { 0.0 };
        let [mean, std] =
            Moments { facets: fall * moments.facets, facets2: fall * fall * moments.facets2, ..moments }
                .brdf(rho, whitecap);
        // Of what facets reflect, by the spreads of the lobe's width and offset.
        let across = if sigma > 0.0 {
            let wider = 2.0 * (off / sigma).powi(2) * self.u_sigma / self.sigma;
            let aside = 2.0 * off * self.u_delta / (sigma * sigma);
            fall * rho * moments.facets * wider.hypot(aside)
        } else {
            0.0
        };
        [mean, std.hypot(across)]
    }

    /// The moments at an angle theta_r: between nodes on a straight line, nothing beyond them.
    fn at(&self, theta: f64) -> Moments {
        let Some(last) = self.thetas.len().checked_sub(1) else { return Moments::default() };
        let above = self.thetas.partition_point(|t| *t <= theta);
        if above == 0 || above > last {
            let exact = above > last && theta == self.thetas[last];
            return if exact { self.in_plane[last] } else { Moments::default() };
        }
        let [a, b] = [above - 1, above];
        let t = (theta - self.thetas[a]) / (self.thetas[b] - self.thetas[a]);
        let (low, high) = (&self.in_plane[a], &self.in_plane[b]);
        let mix = |x: f64, y: f64| x + t * (y - x);
        Moments {
            facets: mix(low.facets, high.facets),
            facets2: mix(low.facets2, high.facets2),
            whitecaps: mix(low.whitecaps, high.whitecaps),
        }
    }

    fn looked_at(water: &Water, planes: &Planes, thetas: &[f64], reach: f64) -> Result<Self, Error> {
        let phis: Vec<f64> = (-ACROSS..=ACROSS).map(|i| reach * f64::from(i) / f64::from(ACROSS)).collect();
        let directions: Vec<[f64; 3]> = thetas
            .iter()
            .map(|theta| planes.in_plane(*theta))
            .chain(phis.iter().map(|phi| planes.across(*phi)))
            .collect();
        let above: Vec<[f64; 3]> = directions.iter().copied().filter(|d| d[2] > 0.0).collect();
        let engagement = Engagement::far(planes.incidence.to_degrees(), LASER, &above, OBSERVERS)?;

        // Facets alone, and how likely a whitecap is.
        let mut facets = *water;
        facets.lobe.whitecap_brdf = 0.0;
        let sea = Ensemble { presence: Presence::Expected, ..Ensemble::new(&facets) }.around(&engagement);
        let samples = sea.sample(std::slice::from_ref(&engagement), &|_| ())?;
        let instances = samples.instances();
        let source = [-planes.incidence.sin(), 0.0, planes.incidence.cos()];
        let mut columns = vec![vec![[0.0; 2]; instances]; above.len()];
        for (observer, column) in columns.iter_mut().enumerate() {
            let rho = reflectance(water, source, above[observer]);
            for ((_, hit, seen), cell) in samples.of(0, observer).zip(column) {
                let open = 1.0 - hit.whitecap;
                let value = if open > 0.0 && !seen.obscured { seen.f / (open * rho) } else { 0.0 };
                *cell = [value, if seen.obscured { 0.0 } else { hit.whitecap }];
            }
        }
        // For every direction its column; below the horizon there is none.
        let mut left = columns.into_iter();
        let columns: Vec<Option<Vec<[f64; 2]>>> =
            directions.iter().map(|d| if d[2] > 0.0 { left.next() } else { None }).collect();
        let n = instances as f64;
        let moments = |column: &Option<Vec<[f64; 2]>>| {
            let mut m = Moments::default();
            for ([value, capped], (_, hit, _)) in column.iter().flatten().zip(samples.of(0, 0)) {
                let open = 1.0 - hit.whitecap;
                m.facets += open * value / n;
                m.facets2 += open * value * value / n;
                m.whitecaps += capped / n;
            }
            m
        };
        let (level, across) = columns.split_at(thetas.len());
        let in_plane = level.iter().map(moments).collect();

        let mean: Vec<f64> = across.iter().map(|c| moments(c).facets).collect();
        let cos = planes.incidence.cos();
        let mean = Gaussian::fit(&phis, &mean);
        let mut fits = Vec::with_capacity(instances);
        let mut curve = vec![0.0; phis.len()];
        for i in 0..instances {
            for (value, column) in curve.iter_mut().zip(across) {
                *value = column.as_ref().map_or(0.0, |c| c[i][0]);
            }
            fits.extend(Gaussian::fit(&phis, &curve));
        }
        let spread = |f: &dyn Fn(&Gaussian) -> f64| {
            let count = fits.len().max(1) as f64;
            let average = fits.iter().map(f).sum::<f64>() / count;
            (fits.iter().map(|g| (f(g) - average).powi(2)).sum::<f64>() / count).sqrt()
        };
        Ok(Self {
            planes: *planes,
            thetas: thetas.into(),
            in_plane,
            sigma: mean.map_or(0.0, |g| g.width / cos),
            u_sigma: spread(&|g| g.width / cos),
            delta: mean.map_or(0.0, |g| g.center),
            u_delta: spread(&|g| g.center),
            fitted: fits.len() as f64 / n,
        })
    }
}

/// rho between two directions (Eqs. 61-63).
fn reflectance(water: &Water, i: [f64; 3], o: [f64; 3]) -> f64 {
    let half = 0.5 * (0..3).map(|k| (i[k] + o[k]).powi(2)).sum::<f64>().sqrt();
    water.lobe.facets.reflectance.eval(half.min(1.0))
}
