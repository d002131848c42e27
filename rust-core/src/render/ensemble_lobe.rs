//! The BRDF of a wavy sea seen from afar: the mean over the slopes of its drawn waves, as one lobe.
//!
//! A level surface that reflects as the waves do has
//!
//! `f = integral p f_N (N.i)+ (N.o)+/N_z ds / (i_z o_z (1 + L_i + L_o))`
//!
//! with the density `p` of the slope `s` of a drawn surface, the BRDF `f_N` of facets and whitecaps about its normal N,
//! and Smith's terms L for what waves hide. It is reciprocal.
//!
//! Facets reflect by their density along the half vector H times shadowing: of the two only shadowing depends on the
//! directions apart from H. So the integral is a table over H, of the density D of facets on all waves, times a mean of
//! the shadowing over the waves that carry them. Those waves' slopes have a mean and a variance, tabulated with D; the
//! mean of the shadowing is Gauss and Hermite's over five slopes in the plane of the two directions.
//!
//! With [`Average::Report`] f is the report's mean instead, without `(N.o)/o_z`. Then waves count most just before they
//! turn from the observer: the mean is Gauss and Legendre's over seven slopes up to there, in the observer's plane.

use crate::brdf::lobe::{alpha, cos_zeta, defined};
use crate::brdf::shadowing::cos_lambda;
use crate::brdf::{Lobe, Parts};
use crate::config::{Average, Surface, Water};
use crate::error::Error;
use crate::numeric::packets::{Packets, Tabulated};
use crate::numeric::{Real, Scalar, Vec3};
use crate::statistics::characteristic::Component;
use crate::statistics::facet_density::{Cell, FacetDensity};
use crate::statistics::slope_density::{Slopes, WindFrame};
use glam::DVec2;
use rayon::prelude::*;
use std::f64::consts::{FRAC_1_SQRT_2, TAU};

/// Nodes to either side of 0 of what is integrated, and of the table how many times as many, interpolated cubically: so fine that
/// linear interpolation errs by 1e-4 in the median.
const NODES: usize = 36;
const FINER: usize = 5;
/// Gauss and Hermite's rule: standard deviations and weights.
const RULE: [(f64, f64); 5] = [
    (0.0, 8.0 / 15.0),
    (1.355_626_179_974_266, 0.222_075_922_005_612_6),
    (-1.355_626_179_974_266, 0.222_075_922_005_612_6),
    (2.856_970_013_872_806, 0.011_257_411_327_720_69),
    (-2.856_970_013_872_806, 0.011_257_411_327_720_69),
];
/// Gauss and Legendre's, and to how many standard deviations it goes.
const CUT_RULE: [(f64, f64); 7] = [
    (0.0, 0.417_959_183_673_469_4),
    (0.405_845_151_377_397_2, 0.381_830_050_505_118_9),
    (-0.405_845_151_377_397_2, 0.381_830_050_505_118_9),
    (0.741_531_185_599_394_4, 0.279_705_391_489_276_7),
    (-0.741_531_185_599_394_4, 0.279_705_391_489_276_7),
    (0.949_107_912_342_758_5, 0.129_484_966_168_869_7),
    (-0.949_107_912_342_758_5, 0.129_484_966_168_869_7),
];
const CUT_END: f64 = 3.5;
/// Keeps quotients finite.
const TINY: f64 = 1e-12;

/// A sea seen from afar, `surface = "ensemble"`.
#[derive(Debug, Clone)]
pub struct EnsembleLobe {
    /// Draws directions, and knows their density: the facets' own proposal, widened by the waves' slopes, and whitecaps
    /// in proportion to what they cover. Its `eval` is not this lobe's.
    pub sampler: Lobe<f64>,
    /// `None`: no waves, the surface is level, and the sampler all there is.
    pub waves: Option<MeanLobe<f64>>,
}

/// The mean over drawn waves.
#[derive(Debug, Clone)]
pub struct MeanLobe<T: Real> {
    /// The facets on the waves; of whitecaps their BRDF.
    pub(crate) lobe: Lobe<T>,
    /// Nodes on a side of the table, the half vector's slope 0 in the middle.
    rows: u32,
    /// The inverse of the step between nodes, tilt angles upwind and crosswind.
    inv_step: [T; 2],
    /// Row by row (upwind) of every node: D, means and variances of the slopes upwind and crosswind, the second differences of D
    /// upwind and crosswind (which linear interpolation would miss), and a zero.
    cells: Packets,
    /// Standard deviations of the drawn slopes, upwind and crosswind.
    sigma: [T; 2],
    /// Mean of N_z under whitecaps, and of N_z times the squares of the slope; without N_z for [`Average::Report`].
    foam: [T; 3],
    /// [`Average::Report`]: the mean of f, not of power.
    report: bool,
}

impl EnsembleLobe {
    /// Tabulates a sea.
    ///
    /// # Errors
    /// [`Error::Surface`] where the surface is not [`Surface::Ensemble`], and as [`crate::Exact::new`].
    pub fn new(water: &Water) -> Result<Self, Error> {
        let water = &water.on(&[Surface::Ensemble])?;
        let waves = water.waves();
        let wind = WindFrame::new(waves.wind_azimuth);
        let slopes = Component::new(&waves).map(|component| Slopes::new(&component, water)).transpose()?;
        let level = water.whitecap_onset().map_or(0.0, |onset| onset.probability(0.0));
        let mut sampler = water.lobe.with_whitecaps(level);
        if let Some(slopes) = &slopes {
            let f = &mut sampler.facets;
            f.proposal = [f.proposal[0].hypot(slopes.sigma.x), f.proposal[1].hypot(slopes.sigma.y)];
            sampler = sampler.with_whitecaps(foam(slopes, Average::Power).0);
        }
        Ok(Self { sampler, waves: slopes.map(|slopes| MeanLobe::new(&slopes, water, wind)) })
    }

    /// f, 1/sr, for unit vectors to source and observer; 0 at or below the horizon, NaN in, NaN out.
    pub fn eval(&self, i: [f64; 3], o: [f64; 3]) -> f64 {
        self.eval_parts(i, o, Parts::ALL)
    }

    /// f of some of its parts, 1/sr.
    pub fn eval_parts(&self, i: [f64; 3], o: [f64; 3], parts: Parts) -> f64 {
        match &self.waves {
            Some(waves) => waves.eval(i, o, parts),
            None => self.sampler.eval_parts(i, o, None, parts),
        }
    }
}

impl MeanLobe<f64> {
    fn new(slopes: &Slopes, water: &Water, wind: WindFrame) -> Self {
        let average = water.parameters.average;
        let facets = FacetDensity::new(slopes, water, wind, NODES);
        let rows = 2 * FINER * NODES + 1;
        let steps = facets.steps / FINER as f64;
        let middle = (FINER * NODES) as f64;
        let cells: Vec<Cell> = (0..rows * rows)
            .into_par_iter()
            .map(|n| {
                let place = DVec2::new((n / rows) as f64 - middle, (n % rows) as f64 - middle);
                let cell = facets.at_angles(place * steps);
                Cell { density: cell.density.min(STEEPEST_DENSITY), ..cell }
            })
            .collect();
        let density = |n: Option<usize>| n.and_then(|n| cells.get(n)).map_or(0.0, |cell| cell.density);
        let packets = cells.iter().enumerate().flat_map(|(n, Cell { density: d, mean, variance })| {
            let [bend_u, bend_c] =
                [rows, 1].map(|m| density(n.checked_sub(m)) - 2.0 * d + density(Some(n + m)));
            [*d, mean.x, mean.y, variance.x, variance.y, bend_u, bend_c, 0.0].map(|x| x as f32)
        });
        let (level, tilted) = foam(slopes, average);
        Self {
            lobe: water.lobe,
            rows: rows as u32,
            inv_step: [1.0 / steps.x, 1.0 / steps.y],
            cells: Packets { width: 8, half: false, numbers: packets.collect() },
            sigma: slopes.sigma.into(),
            foam: [level, tilted.x, tilted.y],
            report: average == Average::Report,
        }
    }
}

impl<S: Scalar> MeanLobe<S> {
    /// The same in another number type.
    pub fn cast<T: Real>(&self) -> MeanLobe<T> {
        let of = |x: S| T::coefficient(x.to_f64());
        MeanLobe {
            lobe: self.lobe.cast(),
            rows: self.rows,
            inv_step: self.inv_step.map(of),
            cells: self.cells.clone(),
            sigma: self.sigma.map(of),
            foam: self.foam.map(of),
            report: self.report,
        }
    }
}

/// Densities of facets are clamped to this: as printed, with Eqs. 71-73, they have no bound where facets stand upright.
const STEEPEST_DENSITY: f64 = 1e18;

/// A direction along the wind, across it and upwards.
type Local<T> = Vec3<T>;

impl<T: Tabulated> MeanLobe<T> {
    /// f of some of its parts, 1/sr, for unit vectors to source and observer.
    #[inline(always)]
    pub fn eval(&self, i: Vec3<T>, o: Vec3<T>, parts: Parts) -> T {
        let zero = T::of(0.0);
        let upper = T::lt(zero, i[2]) & T::lt(zero, o[2]);
        if !T::may_hold(upper) {
            return defined(i, o, [i[2], o[2]], zero);
        }
        let wind = &self.lobe.facets.wind;
        // Products of smaller cosines might be 0.
        let above = |v: Vec3<T>| [v[0], v[1], T::max(v[2], T::of(TINY))];
        let (local_i, local_o) = (wind.vector_to_wind(above(i)), wind.vector_to_wind(above(o)));
        let mut reflected = zero;
        if parts.facets {
            reflected = self.facets(local_i, local_o, upper);
        }
        if parts.whitecaps {
            let foam = if self.report {
                self.foam_mean(local_i, local_o)
            } else {
                self.foam_power(local_i, local_o)
            };
            reflected = self.lobe.whitecap_brdf.mul_add(T::max(foam, zero), reflected);
        }
        if self.report {
            reflected = reflected * local_o[2];
        }
        // Over cos theta_i cos theta_r (1 + L_i + L_o).
        let masked = |v: Local<T>| cos_lambda(v[2], alpha([v[0], v[1]], self.sigma));
        let area = local_o[2].mul_add(masked(local_i), local_i[2] * masked(local_o));
        let area = local_i[2].mul_add(local_o[2], area);
        defined(i, o, [i[2], o[2]], T::select(upper, reflected / T::max(area, T::TINY), zero))
    }

    /// What facets reflect: their density along the half vector times the mean of the rest over the waves that carry them.
    #[inline(always)]
    fn facets(&self, i: Local<T>, o: Local<T>, upper: T::Mask) -> T {
        let h = [0, 1, 2].map(|k| i[k] + o[k]);
        let lean = -T::max(h[2], T::SMALL).recip();
        let cell = self.cell([h[0] * lean, h[1] * lean], upper);
        let [density, mean_u, mean_c, variance_u, variance_c, ..] = cell;
        if !T::may_hold(T::lt(T::of(0.0), density)) {
            return T::of(0.0);
        }
        // The vertical plane of the slopes: of the two directions, or of the observer. Either way round they are the same.
        let across = if self.report { [o[0], o[1]] } else { [o[0] - i[0], o[1] - i[1]] };
        let inverse = T::max(across[0].mul_add(across[0], across[1] * across[1]), T::of(1e-20)).rsqrt();
        let [d_u, d_c] = across.map(|x| x * inverse);
        let variance = T::max((d_u * d_u).mul_add(variance_u, d_c * d_c * variance_c), T::of(0.0));
        let sigma = variance.sqrt();
        let cos_zeta = cos_zeta(h);
        let rho = T::from_density(self.lobe.facets.reflectance.eval(cos_zeta.to_density()));
        let slope = |step: T| [d_u.mul_add(step, mean_u), d_c.mul_add(step, mean_c)];
        let mut visible = T::of(0.0);
        if !self.report {
            for (x, weight) in RULE {
                let g = self.visible(rho, i, o, slope(sigma * T::of(x)), T::of(0.0));
                visible = g.mul_add(T::of(weight), visible);
            }
            return density * rho * visible;
        }
        // Up to where waves turn from the observer; across the plane slopes only make normals lean.
        let across = T::max(variance_u + variance_c - variance, T::of(0.0));
        let level = o[0].mul_add(d_u, o[1] * d_c);
        let turns = (o[2] - o[0].mul_add(mean_u, o[1] * mean_c)) / T::max(level * sigma, T::of(TINY));
        let end = T::of(CUT_END);
        let half = T::of(0.5) * (T::max(T::min(turns, end), -end) + end);
        for (x, weight) in CUT_RULE {
            let x = half.mul_add(T::of(1.0 + x), -end);
            let g = self.visible(rho, i, o, slope(sigma * x), across);
            visible = g.mul_add(T::of(weight) * gauss(x), visible);
        }
        density * rho * visible * half
    }

    /// G about the normal of a slope, held to what the facets leave visible, and for the report's mean over its cosine to the
    /// observer; 0 where it turns from one of the two. There normals lean across as well, by slopes of a variance.
    #[inline(always)]
    fn visible(&self, rho: T, i: Local<T>, o: Local<T>, slope: [T; 2], across: T) -> T {
        let (zero, one, facets) = (T::of(0.0), T::of(1.0), &self.lobe.facets);
        let mut lean = slope[0].mul_add(slope[0], slope[1] * slope[1]);
        if self.report {
            lean = lean + across;
        }
        let n_z = (one + lean).rsqrt();
        let cosine = |v: Local<T>| (v[2] - v[0].mul_add(slope[0], v[1] * slope[1])) * n_z;
        let (cos_i, cos_o) = (cosine(i), cosine(o));
        let upper = T::lt(zero, cos_i) & T::lt(zero, cos_o);
        if !T::may_hold(upper) {
            return zero;
        }
        let tangential = |v: Local<T>| [0, 1].map(|k| v[2].mul_add(slope[k], v[k]) * n_z);
        let sigmas = [facets.sigma_u, facets.sigma_c];
        let mut alphas = [zero; 2];
        if facets.needs_spreads() {
            alphas = [alpha(tangential(i), sigmas), alpha(tangential(o), sigmas)];
        }
        let area = facets.masked_area(rho, [cos_i, cos_o], alphas);
        let seen = if self.report { cos_i } else { cos_i * cos_o };
        T::select(upper, seen / T::max(area, T::TINY), zero)
    }

    /// Facets along a half vector of a slope upwind and crosswind; none beyond the table.
    #[inline(always)]
    fn cell(&self, slope: [T; 2], upper: T::Mask) -> [T; 8] {
        let (zero, end) = (T::of(0.0), T::of(f64::from(self.rows - 1)));
        let middle = T::of(0.5 * f64::from(self.rows - 1));
        let place =
            [0, 1].map(|k| (slope[k] * (slope[k] * slope[k]).atan_over()).mul_add(self.inv_step[k], middle));
        let within = |x: T| !T::lt(x, zero) & T::lt(x, end);
        let inside = upper & within(place[0]) & within(place[1]);
        let [(row, u), (column, c)] = place.map(|x| T::select(inside, x, zero).step(self.rows - 1));
        let rows = f64::from(self.rows);
        let index = row.mul_add(T::of(rows), column);
        let node = |offset: f64| T::lookup::<8>(&self.cells, index + T::of(offset), inside);
        let (corner, right, far, opposite) = (node(0.0), node(1.0), node(rows), node(rows + 1.0));
        let between = |t: T, a: T, b: T| t.mul_add(b - a, a);
        let cell = |k: usize| between(u, between(c, corner[k], right[k]), between(c, far[k], opposite[k]));
        // What a straight line misses of D, by its second differences.
        let bow = |t: T| (-t).mul_add(t, t);
        let bend = bow(c).mul_add(corner[6] + opposite[6], bow(u) * (corner[5] + opposite[5]));
        let density = T::max(T::of(-0.25).mul_add(bend, cell(0)), zero);
        [T::select(inside, density, zero), cell(1), cell(2), cell(3), cell(4), zero, zero, zero]
    }

    /// Mean of `(N.i)(N.o)/N_z` under whitecaps.
    #[inline(always)]
    fn foam_power(&self, i: Local<T>, o: Local<T>) -> T {
        let [level, u, c] = self.foam;
        (level * i[2]).mul_add(o[2], (u * i[0]).mul_add(o[0], c * i[1] * o[1]))
    }

    /// Mean of `(N.i)/N_z` under whitecaps where they face `o`, if their slopes are Gaussian.
    #[inline(always)]
    fn foam_mean(&self, i: Local<T>, o: Local<T>) -> T {
        let [level, u, c] = self.foam;
        let variance = (u * o[0]).mul_add(o[0], c * o[1] * o[1]) / T::max(level, T::TINY);
        let inverse = T::max(variance, T::of(TINY)).rsqrt();
        let turns = o[2] * inverse;
        let tilted = (u * i[0]).mul_add(o[0], c * i[1] * o[1]) * inverse * gauss(turns);
        (level * i[2]).mul_add(below(turns), tilted)
    }
}

/// Gauss's density.
#[inline(always)]
fn gauss<T: Real>(x: T) -> T {
    (T::of(-0.5) * x * x).exp() * T::of(1.0 / TAU.sqrt())
}

/// Its integral up to an x that is not negative, to 1e-7 (Abramowitz and Stegun 1964, 7.1.26).
#[inline(always)]
fn below<T: Real>(x: T) -> T {
    let t = T::of(0.327_591_1 * FRAC_1_SQRT_2).mul_add(x, T::of(1.0)).recip();
    let coefficients = [0.254_829_592, -0.284_496_736, 1.421_413_741, -1.453_152_027, 1.061_405_429];
    let sum = coefficients.iter().rev().fold(T::of(0.0), |sum, c| sum.mul_add(t, T::of(*c)));
    (T::of(-0.5) * sum * t).mul_add((T::of(-0.5) * x * x).exp(), T::of(1.0))
}

/// Mean of N_z, or of 1, under whitecaps, and of the same times the squares of the slope.
fn foam(slopes: &Slopes, average: Average) -> (f64, DVec2) {
    let mut foam = (0.0, DVec2::ZERO);
    for point in slopes.whitecap_density.iter().flat_map(|_| slopes.points()) {
        let share = match average {
            Average::Power => point.whitecap_density / (1.0 + point.slope.length_squared()).sqrt(),
            Average::Report => point.whitecap_density,
        };
        foam.0 += share;
        foam.1 += share * point.slope * point.slope;
    }
    foam
}
