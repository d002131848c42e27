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

use crate::brdf::lobe::defined;
use crate::brdf::{Lobe, Parts};
use crate::config::{Average, Surface, Water};
use crate::error::Error;
use crate::statistics::characteristic::Component;
use crate::statistics::facet_density::{Cell, FacetDensity};
use crate::statistics::slope_density::{Slopes, WindFrame};
use crate::surface::normal;
use glam::{DVec2, DVec3};
use rayon::prelude::*;
use std::f64::consts::{SQRT_2, TAU};

/// Nodes of the table to either side of 0.
const NODES: usize = 36;
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
    water: Water,
    /// Draws directions, and knows their density: the facets' own proposal, widened by the waves' slopes, and whitecaps
    /// in proportion to what they cover. Its `eval` is not this lobe's.
    pub sampler: Lobe<f64>,
    wind: WindFrame,
    /// `None`: no waves, the surface is level.
    waves: Option<Waves>,
}

/// The table as traced code reads it, with linear interpolation and, of D, what second differences add to it.
#[derive(Debug, Clone)]
pub struct Table {
    /// Nodes on a side, the half vector's slope 0 in the middle.
    pub rows: u32,
    /// Between nodes, tilt angles upwind and crosswind.
    pub steps: [f64; 2],
    /// Row by row (upwind) of every node: D, means and variances of the slopes upwind and crosswind, the second differences of D
    /// upwind and crosswind (which linear interpolation would miss), and a zero.
    pub cells: Vec<f32>,
    /// Standard deviations of the drawn slopes, upwind and crosswind.
    pub sigma: [f64; 2],
    /// Mean of N_z under whitecaps, and of N_z times the squares of the slope; without N_z for [`Average::Report`].
    pub foam: [f64; 3],
    /// What the mean is of.
    pub average: Average,
}

#[derive(Debug, Clone)]
struct Waves {
    slopes: Slopes,
    facets: FacetDensity,
    /// Mean of N_z under whitecaps, and of N_z times the squares of the slope; without N_z for [`Average::Report`].
    foam: (f64, DVec2),
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
        let waves = slopes.map(|slopes| Waves::new(slopes, water, wind));
        let mut sampler = water.lobe;
        sampler = sampler.with_whitecaps(water.whitecap_probability(0.0));
        if let Some(waves) = &waves {
            let f = &mut sampler.facets;
            f.proposal_u = f.proposal_u.hypot(waves.slopes.sigma.x);
            f.proposal_c = f.proposal_c.hypot(waves.slopes.sigma.y);
            sampler = sampler.with_whitecaps(foam(&waves.slopes, Average::Power).0);
        }
        Ok(Self { water: *water, sampler, wind, waves })
    }

    /// f, 1/sr, for unit vectors to source and observer; 0 at or below the horizon, not a number where a coordinate is none.
    pub fn eval(&self, i: [f64; 3], o: [f64; 3]) -> f64 {
        self.eval_parts(i, o, Parts::ALL)
    }

    /// f of some of its parts, 1/sr.
    pub fn eval_parts(&self, i: [f64; 3], o: [f64; 3], parts: Parts) -> f64 {
        let f = if i[2] > 0.0 && o[2] > 0.0 { self.lit(i, o, parts) } else { 0.0 };
        defined(i, o, [i[2], o[2]], f)
    }

    /// The same for directions above the horizon.
    fn lit(&self, i: [f64; 3], o: [f64; 3], parts: Parts) -> f64 {
        let lobe = &self.water.lobe;
        let Some(waves) = &self.waves else {
            return self.sampler.eval_parts(i, o, None, parts);
        };
        let (i, o) = (DVec3::from(i), DVec3::from(o));
        let report = self.water.parameters.average == Average::Report;
        // Products of smaller cosines might be 0.
        let [i, o] = [i, o].map(|v| v.with_z(v.z.max(TINY)));
        let half = i + o;
        let cell = waves.facets.at(self.wind.to_wind(-half.truncate() / half.z));
        let mut reflected = 0.0;
        if parts.facets && cell.density > 0.0 {
            let visible =
                if report { self.visible_mean(&cell, i, o) } else { self.visible_power(&cell, i, o) };
            reflected = cell.density * visible;
        }
        let [i_wind, o_wind] = [i, o].map(|v| self.wind.to_wind(v.truncate()));
        if parts.whitecaps {
            let seen = if report { foam_mean } else { foam_power };
            reflected += lobe.whitecap_brdf * seen(waves.foam, (i_wind, i.z), (o_wind, o.z)).max(0.0);
        }
        if report {
            reflected *= o.z;
        }
        let hidden = waves.slopes.hidden(i_wind, i.z) + waves.slopes.hidden(o_wind, o.z);
        reflected / (i.z * o.z * (1.0 + hidden))
    }

    /// Mean of `rho G` over the waves that carry a half vector's facets.
    fn visible_power(&self, cell: &Cell, i: DVec3, o: DVec3) -> f64 {
        // Either way round the rule meets the same slopes.
        let across = (o - i).truncate().try_normalize().unwrap_or(DVec2::X);
        let along = self.wind.to_wind(across);
        let spread = cell.spread(along);
        let visible = |(x, weight): &(f64, f64)| {
            let slope = self.wind.to_world(cell.mean + along * spread * *x);
            weight * self.water.lobe.facets.shadowed_reflectance(i.into(), o.into(), normal(slope.into()))
        };
        RULE.iter().map(visible).sum()
    }

    /// Mean of `rho G/(N.o)` over them.
    fn visible_mean(&self, cell: &Cell, i: DVec3, o: DVec3) -> f64 {
        let o_wind = self.wind.to_wind(o.truncate());
        let along = o_wind.try_normalize().unwrap_or(DVec2::X);
        let spread = cell.spread(along);
        // Across the observer's plane slopes only make normals lean.
        let across = (cell.variance.element_sum() - spread * spread).max(0.0);
        let turns = (o.z - o_wind.dot(cell.mean)) / (o_wind.length() * spread).max(TINY);
        let half = 0.5 * (turns.clamp(-CUT_END, CUT_END) + CUT_END);
        let visible = |(x, weight): &(f64, f64)| {
            let x = half * (1.0 + x) - CUT_END;
            let slope = cell.mean + along * spread * x;
            let n = DVec3::from((-self.wind.to_world(slope), 1.0))
                / (1.0 + slope.length_squared() + across).sqrt();
            let g = self.water.lobe.facets.shadowed_reflectance(i.into(), o.into(), n.to_array());
            weight * gauss(x) * g / n.dot(o).max(TINY)
        };
        half * CUT_RULE.iter().map(visible).sum::<f64>()
    }

    /// For traced code; `None` where there are no waves and [`EnsembleLobe::sampler`] is all there is.
    pub fn table(&self) -> Option<Table> {
        // So fine that linear interpolation errs by 1e-4 in the median.
        const FINER: usize = 5;
        let waves = self.waves.as_ref()?;
        let rows = 2 * FINER * NODES + 1;
        let steps = waves.facets.steps / FINER as f64;
        let middle = (FINER * NODES) as f64;
        let cells: Vec<Cell> = (0..rows * rows)
            .into_par_iter()
            .map(|n| {
                let place = DVec2::new((n / rows) as f64 - middle, (n % rows) as f64 - middle);
                waves.facets.at_angles(place * steps)
            })
            .collect();
        let density = |n: Option<usize>| n.and_then(|n| cells.get(n)).map_or(0.0, |cell| cell.density);
        let packets = cells.iter().enumerate().flat_map(|(n, Cell { density: d, mean, variance })| {
            let [bend_u, bend_c] =
                [rows, 1].map(|m| density(n.checked_sub(m)) - 2.0 * d + density(Some(n + m)));
            [*d, mean.x, mean.y, variance.x, variance.y, bend_u, bend_c, 0.0].map(|x| x as f32)
        });
        let (level, tilted) = waves.foam;
        Some(Table {
            rows: rows as u32,
            steps: steps.into(),
            cells: packets.collect(),
            sigma: waves.slopes.sigma.into(),
            foam: [level, tilted.x, tilted.y],
            average: self.water.parameters.average,
        })
    }
}

impl Waves {
    fn new(slopes: Slopes, water: &Water, wind: WindFrame) -> Self {
        let facets = FacetDensity::new(&slopes, water, wind, NODES);
        let foam = foam(&slopes, water.parameters.average);
        Self { slopes, facets, foam }
    }
}

/// Mean of N_z, or of 1, under whitecaps, and of the same times the squares of the slope.
fn foam(slopes: &Slopes, average: Average) -> (f64, DVec2) {
    let mut foam = (0.0, DVec2::ZERO);
    for point in slopes.capped.iter().flat_map(|_| slopes.points()) {
        let share = match average {
            Average::Power => point.capped / (1.0 + point.slope.length_squared()).sqrt(),
            Average::Report => point.capped,
        };
        foam.0 += share;
        foam.1 += share * point.slope * point.slope;
    }
    foam
}

/// Mean of `(N.i)(N.o)/N_z` under whitecaps, for directions' horizontal parts upwind and crosswind and their heights.
fn foam_power((level, tilted): (f64, DVec2), (i, i_z): (DVec2, f64), (o, o_z): (DVec2, f64)) -> f64 {
    level * i_z * o_z + (tilted * i).dot(o)
}

/// Mean of `(N.i)/N_z` under whitecaps where they face `o`, if their slopes are Gaussian.
fn foam_mean((level, tilted): (f64, DVec2), (i, i_z): (DVec2, f64), (o, o_z): (DVec2, f64)) -> f64 {
    let spread = ((tilted * o).dot(o) / level.max(TINY)).sqrt().max(TINY);
    let turns = (o_z / spread).min(1.0 / TINY);
    level * i_z * 0.5 * libm::erfc(-turns / SQRT_2) + (tilted * i).dot(o) / spread * gauss(turns)
}

/// Gauss's density.
fn gauss(x: f64) -> f64 {
    (-0.5 * x * x).exp() / TAU.sqrt()
}
