//! The statistics of infinitely many draws, without a draw.
//!
//! A beam from `i` meets a slope `s` of the drawn surface in proportion to its density `p(s)` and to the area that it
//! shows, `A(s) = max(0, N.i)/N_z`. So the mean of f is `integral p A f ds/integral p A ds`, and the mean of its square,
//! of its product with the local cosine and its distribution follow alike. `p` comes from the characteristic
//! function of one component (modules `characteristic` and `slope_density`); so does
//! `W(s)`, the density times the probability of a whitecap at that slope, where whitecaps matter.
//!
//! Source and observers are taken to be far away compared with the waves: directions are those from the place where
//! the beam meets the mean surface. What waves hide is known on average only: the share of an observer's view is
//! Smith's for heights that source and observer see together, `(1 + L_i)/(1 + L_i + L_o)`, with the drawn slopes'
//! variance. The ray cast of [`crate::Ensemble`] is the reference for low views, where [`Statistics::mean_error`] and
//! [`Statistics::share_error`] tell how far off these may be.

use super::characteristic::Component;
use super::engagement::Engagement;
use super::facet_density::{Cell, FacetDensity};
use super::slope_density::{Point, Slopes, WindFrame};
use super::summary::{QUANTILES, Statistics};
use crate::brdf::polarised;
use crate::config::Water;
use crate::config::parameters::DRAWN;
use crate::error::Error;
use crate::numeric::quadrature::{gauss_legendre, midpoints, panels};
use crate::surface::normal;
use glam::{DVec2, DVec3};
use rayon::prelude::*;
use std::sync::Arc;

/// Stride over the table's nodes for smooth integrands.
const COARSE: usize = 4;
/// The same for integrands with a kink.
const FINE: usize = 2;
/// Gauss-Legendre nodes of a panel, where an integral is cut off.
const NODES: usize = 24;
/// A panel's length in steps of the table.
const PANEL: f64 = 14.0;
/// Nodes of a table of facets to either side of 0: this times the standard deviation of all slopes over the facets', clamped to
/// [`LEAST_NODES`] and [`MOST_NODES`].
const NODES_OVER_SIGMA: f64 = 12.0;
const LEAST_NODES: usize = 36;
const MOST_NODES: usize = 120;

/// The slope density of a drawn sea and what it reflects.
#[derive(Debug, Clone)]
pub struct Exact {
    water: Water,
    wind: WindFrame,
    /// Obscuration by Smith's share; off for what a point of the surface would reflect if nothing stood in the way.
    pub obscuration: bool,
    /// `None`: no waves, the surface is level.
    slopes: Option<Arc<Slopes>>,
    rule: Vec<(f64, f64)>,
}

/// Mean of f and of its relatives for one observer, 1/sr.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Means {
    /// Mean of f.
    pub f: f64,
    /// Mean of f times the local cosine of the angle of reflection.
    pub f_cos: f64,
    /// Mean of f squared, 1/sr^2.
    pub f_squared: f64,
    /// Share of draws in which a whitecap is seen: of those where the hit faces the observer and is not hidden.
    pub whitecaps: f64,
}

impl Exact {
    /// The density of the sea's slopes.
    ///
    /// # Errors
    /// [`Error::Surface`] where the surface is flat: it has no waves. [`Error::OutOfRange`] for fewer components than 4, and
    /// for footprints whose facets are finer than the drawn slopes by orders of magnitude, and where Eq. 70 is taken as
    /// printed: facets then do not move with the waves. And for whitecaps with a lifetime: foam lies on other slopes than
    /// those of the crest that made it. And for a swell.
    pub fn new(water: &Water) -> Result<Self, Error> {
        let water = &water.on(&DRAWN)?;
        water.parameters.refuse_drawn_seas("in exact statistics")?;
        let waves = water.waves();
        let component = Component::new(&waves);
        Ok(Self {
            water: *water,
            wind: WindFrame::new(waves.wind_azimuth),
            obscuration: true,
            slopes: component.map(|component| Slopes::new(&component, water).map(Arc::new)).transpose()?,
            rule: gauss_legendre(NODES),
        })
    }

    /// The same sea under a wind from another azimuth, in degrees: nothing is tabulated again.
    pub(crate) fn turned(&self, degrees: f64) -> Self {
        Self { water: self.water.turned(degrees), wind: WindFrame::new(degrees.to_radians()), ..self.clone() }
    }

    /// The density of facets along the half vector of two directions, with the 1/4 of Eq. 56, on all waves together.
    pub(crate) fn facets_along(&self, i: DVec3, o: DVec3) -> f64 {
        let half = i + o;
        match &self.slopes {
            Some(slopes) => {
                let slope = self.wind.to_wind(-half.truncate() / half.z);
                Cell::new(slopes, &self.water, self.wind, slope).density
            }
            None => self.water.lobe.facets.density_along(half.normalize().into(), None),
        }
    }

    /// The same as a table; `None` where there are no waves.
    pub(crate) fn facet_density(&self) -> Option<FacetDensity> {
        let slopes = self.slopes.as_ref()?;
        // Facets blur what the table is to resolve.
        let facets = DVec2::from(self.water.variances.map(f64::sqrt));
        let all = (facets * facets + slopes.sigma * slopes.sigma).powf(0.5);
        let nodes = (NODES_OVER_SIGMA * all / facets).max_element() as usize;
        Some(FacetDensity::new(slopes, &self.water, self.wind, nodes.clamp(LEAST_NODES, MOST_NODES)))
    }

    /// Means of f for every observer of an engagement.
    pub fn means(&self, engagement: &Engagement) -> Vec<Means> {
        let source = self.source(engagement);
        self.each(engagement, |o| self.mean(&source, o))
    }

    /// The mean of the Stokes vector that every observer of an engagement sees of its beam, 1/sr.
    pub fn stokes(&self, engagement: &Engagement) -> Vec<[f64; 4]> {
        let (lobe, source) = (&self.water.lobe, self.source(engagement));
        self.each(engagement, |o| {
            let means = self.mean(&source, o);
            let (i, foam) = (source.direction.into(), lobe.whitecap_brdf * means.whitecaps);
            polarised::seen(&lobe.facets.reflectance, i, o.into(), [means.f, foam], engagement.stokes())
        })
    }

    /// Everything for every observer of an engagement, with the error of the method.
    pub fn statistics(&self, engagement: &Engagement, limits: &[f64]) -> Vec<Statistics> {
        let source = self.source(engagement);
        let points = self.slopes.as_ref().map_or(vec![], |slopes| slopes.points());
        self.each(engagement, |o| {
            let means = self.mean(&source, o);
            let (distribution, whitecaps) = self.distribution(&points, &source, o);
            let over: Vec<f64> = limits.iter().map(|limit| distribution.over(*limit)).collect();
            let errors = self.errors(&source, distribution.nothing());
            Statistics {
                mean: means.f,
                std: (means.f_squared - means.f * means.f).max(0.0).sqrt(),
                sem: 0.0,
                min: f64::NAN,
                quantiles: QUANTILES.map(|level| distribution.quantile(level)),
                max: f64::NAN,
                mean_f_cos: means.f_cos,
                obscured: distribution.nothing(),
                // Where there is nothing but whitecaps a quadrature passes 1 by a few millionths.
                whitecap: whitecaps.min(1.0),
                effective: f64::NAN,
                mean_upper: means.f * (1.0 + errors.mean),
                over_upper: over.iter().map(|p| (p + errors.share).min(1.0)).collect(),
                over,
                mean_error: errors.mean,
                share_error: errors.share,
            }
        })
    }

    /// Directions to the observers, in parallel where there are many.
    fn each<T: Send>(&self, engagement: &Engagement, of: impl Fn(DVec3) -> T + Sync) -> Vec<T> {
        let place = DVec3::from(engagement.target());
        let to = |observer: &[f64; 3]| of((DVec3::from(*observer) - place).normalize());
        engagement.observers().par_iter().with_min_len(8).map(to).collect()
    }

    fn source(&self, engagement: &Engagement) -> Source {
        let direction = -DVec3::from(engagement.direction());
        let area = self.slopes.as_ref().map_or(direction.z, |slopes| {
            // Slopes have no mean: where all face the source the area shown is that of the level surface.
            if slopes.all_face(self.wind.to_wind(direction.truncate()), direction.z) {
                direction.z
            } else {
                let [area] = self.sum(slopes, FINE, |s, p, _| [p * shown(s, direction)]);
                area
            }
        });
        Source { direction, area }
    }

    /// What waves leave visible of the hits to an observer above them, on average.
    fn visible(&self, source: &Source, o: DVec3) -> f64 {
        let Some(slopes) = self.slopes.as_ref().filter(|_| self.obscuration) else { return 1.0 };
        let lambda = |v: DVec3| slopes.lambda(self.wind.to_wind(v.truncate()), v.z);
        let (i, o) = (lambda(source.direction), lambda(o));
        (1.0 + i) / (1.0 + i + o)
    }

    /// Bounds of what Smith's share leaves in mean and shares, for the share of the hits that an observer does not see.
    /// Found on ray casts of 200 seas (`errors_are_bounded`): the slopes and heights of M waves know of each other.
    fn errors(&self, source: &Source, unseen: f64) -> Errors {
        let i = source.direction;
        let lambda_i = self.slopes.as_ref().map_or(0.0, |s| s.lambda(self.wind.to_wind(i.truncate()), i.z));
        let dark = lambda_i / (1.0 + lambda_i);
        // Without waves there is one surface, and nothing to integrate.
        let resolution = if self.slopes.is_some() { 0.01 } else { 0.0 };
        Errors {
            mean: 0.5 * unseen + 1.1 * dark * unseen / (1.0 - unseen).max(1e-3) + 1.6 * dark * dark,
            share: resolution + 0.8 * unseen * (1.0 - unseen) + 0.3 * dark,
        }
    }

    fn mean(&self, source: &Source, o: DVec3) -> Means {
        let lobe = &self.water.lobe;
        let i = source.direction;
        let Some(slopes) = &self.slopes else {
            let f = if o.z > 0.0 { lobe.facets.eval(i.into(), o.into(), [0.0, 0.0, 1.0]) } else { 0.0 };
            return Means { f, f_cos: f * o.z.max(0.0), f_squared: f * f, whitecaps: 0.0 };
        };
        let mut means = Means::default();
        self.integrate(slopes, i, o, |s, weight, density, whitecap_density| {
            let n = DVec3::from(normal(s.into()));
            let f = lobe.facets.eval(i.into(), o.into(), n.to_array());
            let weight = weight * (density - whitecap_density) * shown(s, i);
            means.f += weight * f;
            means.f_cos += weight * f * n.dot(o);
            means.f_squared += weight * f * f;
        });
        if slopes.whitecap_density.is_some() {
            let f = lobe.whitecap_brdf;
            let [share, share_cos] = self.sum(slopes, COARSE, |s, _, whitecap_density| {
                if shown(s, o) <= 0.0 {
                    return [0.0; 2];
                }
                let share = whitecap_density * shown(s, i);
                [share, share * DVec3::from(normal(s.into())).dot(o)]
            });
            means.f += f * share;
            means.f_squared += f * f * share;
            means.f_cos += f * share_cos;
            means.whitecaps = share;
        }
        let scale = self.visible(source, o) / source.area;
        // Far out, where the density is nothing but ripples, sums may fall below 0.
        let sums = [means.f, means.f_cos, means.f_squared, means.whitecaps];
        let [f, f_cos, f_squared, whitecaps] = sums.map(|sum| (scale * sum).max(0.0));
        Means { f, f_cos, f_squared, whitecaps }
    }

    /// Calls `add` with slope, area, density and W at the nodes of a rectangle that holds where the drawn slopes and
    /// the facets' lobe meet.
    fn integrate(&self, slopes: &Slopes, i: DVec3, o: DVec3, mut add: impl FnMut(DVec2, f64, f64, f64)) {
        let h = i + o;
        // The slope that mirrors the source to the observer, and how far facets let the wave's slope be from it.
        let specular = self.wind.to_wind(-h.truncate() / h.z);
        let lobe = self.water.lobe.facets.slope_width(specular);
        let Some((low, high)) = slopes.meeting(specular, lobe) else { return };

        // Along the view's azimuth slopes end where they turn away from the observer, or from a source in line.
        let along = if o.truncate().length() > 1e-6 { o.truncate() } else { i.truncate() };
        let along = along.try_normalize().unwrap_or(DVec2::X);
        let (e, f) = (self.wind.to_wind(along), self.wind.to_wind(along.perp()));
        let (centre, half) = (0.5 * (low + high), 0.5 * (high - low));
        let reach = |axis: DVec2| {
            let extent = (axis.x * half.x).hypot(axis.y * half.y);
            [axis.dot(centre) - extent, axis.dot(centre) + extent]
        };
        let in_line = i.truncate().perp_dot(along).abs() < 1e-3 * i.truncate().length();
        let [start, end] = reach(e);
        let (mut first, mut last) = (start, end);
        for v in [Some(o), in_line.then_some(i)].into_iter().flatten() {
            let tip = v.z / along.dot(v.truncate());
            if tip >= 0.0 { last = last.min(tip) } else { first = first.max(tip) }
        }
        let [left, right] = reach(f);
        let step = slopes.step(lobe);
        if first >= last {
            return;
        }
        let columns = if first > start || last < end {
            panels(&self.rule, first, last, PANEL * (e * step).length())
        } else {
            midpoints(start, end, (e * step).length())
        };
        for (y, height) in midpoints(left, right, (f * step).length()) {
            for (x, width) in &columns {
                let slope = e * *x + f * y;
                let (density, whitecap_density) = slopes.at(slope);
                add(self.wind.to_world(slope), width * height, density, whitecap_density);
            }
        }
    }

    /// Sums of `of(slope, density, W)` over the nodes of the table, every `stride`th, times their area.
    fn sum<const N: usize>(
        &self,
        slopes: &Slopes,
        stride: usize,
        of: impl Fn(DVec2, f64, f64) -> [f64; N],
    ) -> [f64; N] {
        let table = &slopes.density;
        let mut sums = [0.0; N];
        slopes.nodes(stride, |slope, density, whitecap_density| {
            let values = of(self.wind.to_world(slope), density, whitecap_density);
            sums.iter_mut().zip(values).for_each(|(sum, value)| *sum += value);
        });
        sums.map(|sum| sum * table.steps[0] * table.steps[1] * (stride * stride) as f64)
    }

    /// The distribution of f over the hits, and the share of whitecaps among them.
    fn distribution(&self, points: &[Point], source: &Source, o: DVec3) -> (Distribution, f64) {
        let lobe = &self.water.lobe;
        let i = source.direction;
        if self.slopes.is_none() {
            return (Distribution::new(vec![(self.mean(source, o).f, 1.0)]), 0.0);
        }
        let visible = self.visible(source, o);
        let (mut area, mut foam) = (0.0, 0.0);
        let mut values = vec![];
        for point in points {
            let s = self.wind.to_world(point.slope);
            let shown_to_source = shown(s, i);
            area += point.density * shown_to_source;
            foam += point.whitecap_density * shown_to_source;
            if shown(s, o) > 0.0 && point.density * shown_to_source > 0.0 {
                let f = lobe.facets.eval(i.into(), o.into(), normal(s.into()));
                values
                    .push((f, visible * (point.density - point.whitecap_density).max(0.0) * shown_to_source));
                if point.whitecap_density > 0.0 {
                    values.push((lobe.whitecap_brdf, visible * point.whitecap_density * shown_to_source));
                }
            }
        }
        values.iter_mut().for_each(|(_, weight)| *weight /= area);
        (Distribution::new(values), foam / area)
    }
}

/// Relative error of a mean, and error of shares in probability.
struct Errors {
    mean: f64,
    share: f64,
}

/// The source's direction and the area that the surface shows it, per level area.
struct Source {
    direction: DVec3,
    area: f64,
}

/// The area that a slope shows a direction, per level area: `max(0, N.v)/N_z`.
fn shown(slope: DVec2, v: DVec3) -> f64 {
    (v.z - slope.dot(v.truncate())).max(0.0)
}

/// A distribution of values not below 0, the rest of the probability at 0.
struct Distribution {
    /// Values in order, each with the probability of all up to and half its own.
    steps: Vec<(f64, f64)>,
    total: f64,
}

impl Distribution {
    fn new(mut values: Vec<(f64, f64)>) -> Self {
        values.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
        let total = values.iter().map(|v| v.1).sum();
        let mut below = 1.0 - total;
        let steps = values
            .into_iter()
            .map(|(value, weight)| {
                below += weight;
                (value, below - 0.5 * weight)
            })
            .collect();
        Self { steps, total }
    }

    /// Probability of nothing at all.
    fn nothing(&self) -> f64 {
        (1.0 - self.total).max(0.0)
    }

    fn quantile(&self, level: f64) -> f64 {
        if level <= self.nothing() {
            return 0.0;
        }
        let next = self.steps.partition_point(|(_, probability)| *probability < level);
        match (next.checked_sub(1).map(|i| self.steps[i]), self.steps.get(next)) {
            (None, Some((first, _))) => *first,
            (Some((a, p)), Some((b, q))) => a + (b - a) * (level - p) / (q - p),
            (last, None) => last.map_or(0.0, |(value, _)| value),
        }
    }

    /// Probability of more than a limit.
    fn over(&self, limit: f64) -> f64 {
        let next = self.steps.partition_point(|(value, _)| *value <= limit);
        let up_to = match (next.checked_sub(1).map(|i| self.steps[i]), self.steps.get(next)) {
            (None, _) => return self.total.min(1.0),
            (Some((a, p)), Some((b, q))) => p + (q - p) * (limit - a) / (b - a),
            (Some(_), None) => 1.0,
        };
        (1.0 - up_to).clamp(0.0, 1.0)
    }
}
