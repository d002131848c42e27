//! What the report's empirical model holds for one angle of incidence (section 9), from the full model: mean and spread of
//! the BRDF in the plane of incidence, and the width and the offset of the lobe across it, over drawn surfaces.
//!
//! Facets and whitecaps are kept apart and without the reflectance rho and the whitecaps' f_WC, which are all that depends
//! on the wavelength: directions fix rho. So the same numbers serve every wavelength and index.
//!
//! Means are those of [`Exact`] where waves hide next to nothing. Elsewhere they are multiplied by what is left visible,
//! which is found on drawn surfaces: a beam meets the points of a surface that it can reach in proportion to the area
//! they show it, so that, over points at random,
//!
//! `mean of f = E[A f V_i V_o]/cos theta_i`
//!
//! with the area A shown to the source per level area, and V whether a wave stands in the way (surface/ray.rs). Its ratio to
//! the same without V needs far fewer draws than the mean itself. Between, one passes into the other.

use super::planes::Planes;
use crate::config::Water;
use crate::error::Error;
use crate::numeric::gaussian_fit::Gaussian;
use crate::sea::whitecap::Onset;
use crate::statistics::characteristic::variances;
use crate::statistics::level_water::BaselineLobe;
use crate::statistics::{Engagement, Exact};
use crate::surface::{Draws, InstanceRng, Surface, SurfaceRay, Waves};
use glam::DVec3;
use rayon::prelude::*;
use std::f64::consts::FRAC_PI_2;

/// How far laser and observers are, m: the far field.
const LASER: f64 = 10e3;
const OBSERVERS: f64 = 100e3;
/// Nodes across the plane, to so many widths of the lobe at either side.
const ACROSS: i32 = 24;
const REACH: f64 = 3.0;
/// By Smith's terms: up to the first nothing is hidden, from the second on drawn surfaces say how much.
const HIDDEN: [f64; 2] = [1e-4, 1e-3];
/// So many instances are enough for the spreads of width and offset.
const FITS: u64 = 2048;
/// Smith's term of a low view, and how many times as many points are drawn for it at most.
const LOW: f64 = 0.2;
const MORE: f64 = 8.0;
/// Points drawn for an instance at most.
const MOST: f64 = 12.0;
/// Instances a thread takes at a time: sums are taken in this order, whatever the number of threads.
const CHUNK: u64 = 256;

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

    /// Each times a factor, which counts as much as `weight`, from 0 to 1.
    fn times(&self, factors: [f64; 3], weight: f64) -> Self {
        let [a, b, c] = factors.map(|factor| 1.0 + weight * (factor - 1.0));
        Self { facets: a * self.facets, facets2: b * self.facets2, whitecaps: c * self.whitecaps }
    }
}

/// The numbers for an angle of incidence.
#[derive(Debug, Clone, PartialEq)]
pub struct Node {
    /// For every angle theta_r in the plane that was asked for.
    pub in_plane: Vec<Moments>,
    /// There, the facets' f over rho, 1/sr, as if all of them lay on level water: their density along the half vector on
    /// all waves together, times shadowing and Smith's share of what drawn waves leave visible. The mean is near it.
    pub approximate: Vec<f64>,
    /// sigma(0) of Eq. 89, radians: the 1/e half width of the mean lobe across the plane, over cos theta_i; 0 where it
    /// has no peak.
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

/// The full model of a sea.
#[derive(Debug, Clone)]
pub struct ReferenceModel {
    /// Its parameters give the seed and the number of instances. Whitecaps reflect nothing: they are counted.
    water: Water,
    waves: Waves,
    onset: Option<Onset<f64>>,
    exact: Exact,
    baseline: BaselineLobe,
}

impl ReferenceModel {
    /// Of a sea with drawn waves; refused as by [`Exact::new`].
    pub fn new(water: &Water) -> Result<Self, Error> {
        let mut water = *water;
        water.lobe.whitecap_brdf = 0.0;
        let mut exact = Exact::new(&water)?;
        exact.obscuration = false;
        let onset = water.whitecap_onset();
        Ok(Self { water, waves: water.waves(), onset, exact, baseline: BaselineLobe::new(&water) })
    }

    /// The same sea under a wind from another azimuth, in degrees, counted from the plane of incidence, away from the
    /// source.
    pub fn turned(&self, degrees: f64) -> Self {
        let water = self.water.turned(degrees);
        let exact = self.exact.turned(degrees);
        Self {
            water,
            waves: water.waves(),
            onset: self.onset,
            exact,
            baseline: self.baseline.turned(degrees),
        }
    }

    /// The numbers for an angle of incidence, looked at from angles theta_r; radians. The source stands towards -x,
    /// and the plane is that of x and z at normal incidence as well.
    pub fn node(&self, incidence: f64, thetas: &[f64]) -> Result<Node, Error> {
        let source = [-incidence.sin(), 0.0, incidence.cos()];
        let planes = Planes::new(source, 0.0).with_readings(self.water.parameters.readings);
        // So far across as the lobe is wide, from the slopes' standard deviation across; refined once by its own fit.
        let [upwind, crosswind, _] = variances(&self.waves);
        let slopes = self.water.variances.iter().sum::<f64>() + upwind + crosswind;
        let mut reach = (REACH * 2.0 * slopes.sqrt() * incidence.cos().max(0.05)).min(0.95 * FRAC_PI_2);
        let mut across = self.across(&planes, reach)?;
        if let Some(fit) = across.fit {
            let wanted = REACH * fit.width;
            if !(0.7..1.4).contains(&(wanted / reach)) {
                reach = wanted.min(0.95 * FRAC_PI_2);
                across = self.across(&planes, reach)?;
            }
        }
        let fits = self.fits(&planes, &across.phis);
        // From angles of Eq. 82 to those of Eq. 88; widths by Eq. 89.
        let scale = planes.scale_across();
        let cos = incidence.cos();
        let total: f64 = fits.iter().map(|(weight, _)| weight).sum();
        let fitted: Vec<(f64, Gaussian)> =
            fits.iter().filter_map(|(w, fit)| fit.map(|fit| (*w, fit))).collect();
        let known: f64 = fitted.iter().map(|(weight, _)| weight).sum();
        let spread = |f: &dyn Fn(&Gaussian) -> f64| {
            let average = fitted.iter().map(|(w, g)| w * f(g)).sum::<f64>() / known.max(f64::MIN_POSITIVE);
            let square = fitted.iter().map(|(w, g)| w * (f(g) - average).powi(2)).sum::<f64>();
            (square / known.max(f64::MIN_POSITIVE)).sqrt()
        };
        let directions: Vec<_> = thetas.iter().map(|theta| planes.in_plane(*theta)).collect();
        let approximate = |o: &[f64; 3]| {
            let level =
                self.exact.facets_along(source.into(), (*o).into()) * self.baseline.shadowing(source, *o);
            level * self.baseline.share(source, *o)
        };
        Ok(Node {
            in_plane: self.moments(&planes, &directions)?,
            approximate: directions.iter().map(approximate).collect(),
            sigma: across.fit.map_or(0.0, |g| scale * g.width / cos),
            u_sigma: spread(&|g| scale * g.width / cos),
            delta: across.fit.map_or(0.0, |g| g.center * scale),
            u_delta: spread(&|g| g.center * scale),
            fitted: if total > 0.0 { known / total } else { 0.0 },
        })
    }

    /// The moments towards unit vectors, for a source in the plane x-z; nothing below the horizon.
    pub fn moments(&self, planes: &Planes, directions: &[[f64; 3]]) -> Result<Vec<Moments>, Error> {
        let source = planes.source();
        let above: Vec<usize> = (0..directions.len()).filter(|k| directions[*k][2] > 0.0).collect();
        let mut moments = vec![Moments::default(); directions.len()];
        if above.is_empty() {
            return Ok(moments);
        }
        let seen: Vec<[f64; 3]> = above.iter().map(|k| directions[*k]).collect();
        let engagement = Engagement::far(planes.incidence.to_degrees(), LASER, &seen, OBSERVERS)?;
        let open = self.exact.means(&engagement).into_iter().zip(&seen).map(|(m, o)| {
            let rho = self.reflectance(source, *o);
            Moments { facets: m.f / rho, facets2: m.f_squared / (rho * rho), whitecaps: m.whitecaps }
        });
        for (k, open) in above.iter().zip(open) {
            moments[*k] = open;
        }
        // How much drawn surfaces matter: by the direction that sees least.
        let [start, end] = HIDDEN.map(f64::ln);
        let of_source = self.baseline.lambda(source);
        let weight = |o: [f64; 3]| {
            let t = (of_source.max(self.baseline.lambda(o)).max(1e-30).ln() - start) / (end - start);
            let t = t.clamp(0.0, 1.0);
            t * t * (3.0 - 2.0 * t)
        };
        let weights: Vec<f64> = seen.iter().map(|o| weight(*o)).collect();
        // Of narrow facets few draws count, and of low views few are seen: both together take more of them.
        let [high, low]: [Vec<usize>; 2] = [false, true].map(|low| {
            let matters = |k: &usize| weights[*k] > 0.0 && (self.baseline.lambda(seen[*k]) > LOW) == low;
            (0..seen.len()).filter(matters).collect()
        });
        for (group, more) in [(high, 1.0), (low, self.baseline.narrowness().clamp(1.0, MORE))] {
            if group.is_empty() {
                continue;
            }
            let instances = self.instances(source, more);
            let ways: Vec<[f64; 3]> = group.iter().map(|k| seen[*k]).collect();
            // The area that level water shows the source.
            let level = instances as f64 * source[2];
            for (k, sums) in group.iter().zip(self.drawn(source, &ways, instances)) {
                let at = &mut moments[above[*k]];
                *at = at.times(sums.visible(level), weights[*k]);
            }
        }
        Ok(moments)
    }

    /// How many points are drawn, so that the source reaches so many times as many as there are instances; at most
    /// [`MOST`] times more.
    fn instances(&self, source: [f64; 3], more: f64) -> u64 {
        let some = self.water.parameters.instances.min(CHUNK);
        let mut lit = 0;
        for instance in 0..some {
            self.point(instance, source, |point, _, _| lit += u64::from(point.lit));
        }
        let times = more * some as f64 / lit.max(1) as f64;
        (self.water.parameters.instances as f64 * times.min(MOST)).ceil() as u64
    }

    /// Sums over points of drawn surfaces, for every direction.
    fn drawn(&self, source: [f64; 3], ways: &[[f64; 3]], instances: u64) -> Vec<Sums> {
        let empty = || vec![Sums::default(); ways.len()];
        let chunks: Vec<Vec<Sums>> = (0..instances.div_ceil(CHUNK))
            .into_par_iter()
            .map(|chunk| {
                let mut sums = empty();
                for instance in chunk * CHUNK..instances.min((chunk + 1) * CHUNK) {
                    self.point(instance, source, |point, surface, ray| {
                        for (sums, way) in sums.iter_mut().zip(ways) {
                            self.add(sums, point, source, *way, || {
                                self.sees(surface, ray, point.position, *way)
                            });
                        }
                    });
                }
                sums
            })
            .collect();
        let mut all = empty();
        for sums in chunks {
            all.iter_mut().zip(&sums).for_each(|(all, sums)| all.add(sums));
        }
        all
    }

    /// Whether nothing stands between a point and an observer in a direction, far away.
    fn sees(&self, surface: &Surface, ray: &mut SurfaceRay, from: DVec3, way: [f64; 3]) -> bool {
        let way = DVec3::from(way);
        !(self.water.may_occlude(surface, way) && ray.occludes(surface, from, way * OBSERVERS))
    }

    /// Shows a drawn surface's point at the origin, if it faces the source.
    fn point(
        &self,
        instance: u64,
        source: [f64; 3],
        mut look: impl FnMut(&SeaPoint, &Surface, &mut SurfaceRay),
    ) {
        let mut numbers = InstanceRng::new(Draws::Sobol, self.water.parameters.seed, instance);
        // The first number decides about whitecaps, where they are drawn.
        numbers.next();
        let surface = self.waves.surface(numbers, 0.0);
        let at = surface.point([0.0; 2]);
        let area = source[2] - at.slope[0] * source[0] - at.slope[1] * source[1];
        if area <= 0.0 {
            return;
        }
        let position = DVec3::new(0.0, 0.0, at.height);
        let mut ray = SurfaceRay::default();
        let lit = !ray.occludes(&surface, position, DVec3::from(source) * LASER);
        let whitecap = self.onset.map_or(0.0, |onset| onset.probability(at.acceleration));
        let point = SeaPoint { position, normal: at.normal(), area, lit, whitecap };
        look(&point, &surface, &mut ray);
    }

    fn add(
        &self,
        sums: &mut Sums,
        point: &SeaPoint,
        source: [f64; 3],
        way: [f64; 3],
        visible: impl FnOnce() -> bool,
    ) {
        sums.shown += point.area;
        if DVec3::from(way).dot(point.normal.into()) <= 0.0 {
            return;
        }
        let f = self.water.lobe.facets.eval(source, way, point.normal) / self.reflectance(source, way);
        let open = point.area * (1.0 - point.whitecap);
        let areas = [open * f, open * f * f, point.area * point.whitecap, point.area];
        let visible = point.lit && visible();
        for (k, x) in areas.into_iter().enumerate() {
            sums.facing[k] += x;
            if visible {
                sums.seen[k] += x;
            }
        }
    }

    /// The mean lobe across the plane.
    fn across(&self, planes: &Planes, reach: f64) -> Result<MeanAcross, Error> {
        let phis: Vec<f64> = (-ACROSS..=ACROSS).map(|i| reach * f64::from(i) / f64::from(ACROSS)).collect();
        let directions: Vec<_> = phis.iter().map(|phi| planes.across(*phi)).collect();
        let values: Vec<f64> = self.moments(planes, &directions)?.iter().map(|m| m.facets).collect();
        Ok(MeanAcross { fit: Gaussian::fit(&phis, &values), phis })
    }

    /// Fits of single surfaces' lobes across the plane, with their weights.
    fn fits(&self, planes: &Planes, phis: &[f64]) -> Vec<(f64, Option<Gaussian>)> {
        let source = planes.source();
        let ways: Vec<_> = phis.iter().map(|phi| planes.across(*phi)).collect();
        let rho: Vec<f64> = ways.iter().map(|way| self.reflectance(source, *way)).collect();
        let fit = |instance: u64| {
            let mut found = (0.0, None);
            self.point(instance, source, |point, surface, ray| {
                if !point.lit {
                    return;
                }
                let curve: Vec<f64> = ways
                    .iter()
                    .zip(&rho)
                    .map(|(way, rho)| {
                        let f = self.water.lobe.facets.eval(source, *way, point.normal) / rho;
                        let seen = f > 0.0 && way[2] > 0.0 && self.sees(surface, ray, point.position, *way);
                        if seen { f } else { 0.0 }
                    })
                    .collect();
                found = (point.area, Gaussian::fit(phis, &curve));
            });
            found
        };
        (0..self.water.parameters.instances.min(FITS)).into_par_iter().map(fit).collect()
    }

    /// rho between two directions (Eqs. 61-63).
    fn reflectance(&self, i: [f64; 3], o: [f64; 3]) -> f64 {
        let half = 0.5 * (0..3).map(|k| (i[k] + o[k]).powi(2)).sum::<f64>().sqrt();
        self.water.lobe.facets.reflectance.eval(half.min(1.0))
    }
}

/// The mean lobe across the plane.
struct MeanAcross {
    phis: Vec<f64>,
    fit: Option<Gaussian>,
}

/// A point of a drawn surface that faces the source.
struct SeaPoint {
    position: DVec3,
    normal: [f64; 3],
    /// Shown to the source, per level area.
    area: f64,
    /// No wave stands between it and the source.
    lit: bool,
    /// Probability of a whitecap there.
    whitecap: f64,
}

/// Sums of [`Moments`] and of 1, times the area shown to the source.
#[derive(Debug, Clone, Copy, Default)]
struct Sums {
    /// Of the area alone, wherever it faces the source.
    shown: f64,
    /// Where the surface faces both.
    facing: [f64; 4],
    /// And nothing stands in the way of either.
    seen: [f64; 4],
}

impl Sums {
    fn add(&mut self, other: &Self) {
        self.shown += other.shown;
        for k in 0..4 {
            self.facing[k] += other.facing[k];
            self.seen[k] += other.seen[k];
        }
    }

    /// What hiding makes of each of the moments, for the area that as many level surfaces show the source.
    fn visible(&self, level: f64) -> [f64; 3] {
        let share = |k: usize| (self.facing[k] > 0.0).then(|| self.seen[k] / self.facing[k]);
        [0, 1, 2].map(|k| self.shown / level * share(k).or(share(3)).unwrap_or(0.0))
    }
}
