//! The report's empirical model of a sea (Eqs. 83-91), from a table: evaluated in nanoseconds, with its uncertainty.
//!
//! Configured, it is the table at one wind and one footprint, as a ratio to what the facets would reflect on level water, on
//! a grid so fine that straight lines do between its nodes: even in the tangents of half the angles theta_i and theta_r,
//! and in what stands for the wind's azimuth there; and the density of facets along the half vector, on a second grid.
//!
//! Beyond the largest angle of incidence in the table it is what it is there, and beyond its angles theta_r the ratio to
//! what level water would reflect is: [`Estimate::outside`] says so.
//!
//! ```
//! use prob_water::{EmpiricalLobe, Parameters, Surface, Table, Wind};
//!
//! # fn main() -> Result<(), prob_water::Error> {
//! let water = Parameters {
//!     wind: Wind::FrictionVelocity(8.0),
//!     wind_direction: 30.0,
//!     surface: Surface::Empirical,
//!     ..Parameters::default()
//! }
//! .configure()?;
//! let lobe = EmpiricalLobe::new(&water, Table::standard())?;
//! let [i, o] = [[-0.5, 0.0, 0.75f64.sqrt()], [0.5, 0.0, 0.75f64.sqrt()]];
//! let estimate = lobe.estimate(i, o);
//! println!("{} +- {} 1/sr", estimate.mean, estimate.std);
//! assert!(!estimate.outside);
//! let f: f32 = lobe.eval(i.map(|x| x as f32), o.map(|x| x as f32));
//! assert!((f64::from(f) / estimate.mean - 1.0).abs() < 1e-4);
//! # Ok(())
//! # }
//! ```

use super::reference::Moments;
use super::table::Table;
use crate::brdf::lobe::defined;
use crate::brdf::shadowing::hidden;
use crate::brdf::{Lobe, Parts};
use crate::config::{Across, Surface, Water};
use crate::error::Error;
use crate::numeric::{Real, Scalar, Vec3};
use crate::statistics::level_water::{LEANING, NOTHING, Spreads, ln_densities};
use crate::statistics::{Engagement, Exact, Statistics};
use crate::surface::{Draws, Numbers};
use rayon::prelude::*;
use std::f64::consts::TAU;
use std::num::NonZeroU32;

/// Steps of the fine grid: over theta_i, the wind's azimuth and theta_r.
const INCIDENCES: usize = 32;
const AZIMUTHS: usize = 16;
const THETAS: usize = 80;
/// Shares of whitecaps come to half precision in this part of 1, so that rare ones keep their digits.
const SHARES: f64 = 1024.0;
/// Nodes on a side of the density of facets.
const DENSITIES: usize = 257;
/// The area shown to both directions is at least this; and the cosine that stands for the horizon.
const GRAZING: f64 = 1e-6;
const LOWEST: f64 = 2e-3;

/// Relative error of a mean by the table, in its grid and in the plane of incidence or with [`Across::Slopes`].
const TABLE_ERROR: f64 = 0.05;

/// Logarithm of the largest mean square over the squared mean: far from the mirror in a light wind Gaussian slopes give
/// more than a number holds.
const LARGEST_SQUARE: f64 = 500.0;

/// f and what is known of it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimate {
    /// f, 1/sr: the mean over drawn surfaces (Eq. 90).
    pub mean: f64,
    /// Its standard uncertainty u(f): the standard deviation over them (Eq. 91).
    pub std: f64,
    /// The directions lie outside of the table's grid, whose nearest values these are.
    pub outside: bool,
}

/// A sea by a table of the empirical model, `surface = "empirical"`.
#[derive(Debug, Clone)]
pub struct EmpiricalLobe {
    /// Draws directions, and knows their density: the facets of all waves, and whitecaps in proportion to what they
    /// cover. Its `eval` is not this lobe's.
    pub sampler: Lobe<f64>,
    across: Across,
    spreads: Spreads,
    /// Tangents of half the angles theta_i and theta_r between which the table has nodes.
    incidences: [f64; 2],
    thetas: [f64; 2],
    /// By theta_i, azimuth and theta_r, in the plane: the logarithm of the ratio of the facets' f to what they would reflect
    /// on level water; the share of whitecaps; the logarithm of the mean square of the facets' f over its squared mean,
    /// less that of Gaussian slopes.
    in_plane: Vec<[f32; 3]>,
    /// By theta_i and azimuth: sigma, u_sigma, delta, u_delta, radians.
    widths: Vec<[f32; 4]>,
    /// What [`ln_densities`] gives.
    densities: Vec<f32>,
    steps: [f64; 2],
}

/// The fine grid as traced code reads it.
#[derive(Debug, Clone)]
pub struct FineGrid {
    /// Steps over tan(theta_i/2) from 0, over the stand-in of the azimuth from 0 to 2, and over tan(theta_r/2) from -1 to 1.
    pub steps: [u32; 3],
    /// The largest tan(theta_i/2).
    pub incidence: f64,
    /// By theta_i, by intervals of the azimuth and by those of theta_r, what the four corners hold, azimuths first:
    /// logarithms of the ratio to level water, and with `whitecaps` 1024 times their shares.
    pub in_plane: Vec<f32>,
    /// By intervals of theta_i and of the azimuth, of the four corners, azimuths first: sigma, then delta.
    pub widths: Vec<f32>,
    /// There are whitecaps.
    pub whitecaps: bool,
    /// `across = "slopes"`.
    pub slopes: bool,
    /// Of a half vector's slope, upwind and crosswind, the share of the waves that carry its facets.
    pub carried: [f64; 2],
    /// The density of facets along a half vector, over its tilt angles upwind and crosswind, 0 in the middle: steps on a
    /// side, the standard deviations of both angles in radians, and the steps in those.
    pub density_steps: u32,
    /// Radians.
    pub sigmas: [f64; 2],
    /// Standard deviations.
    pub density_step: [f64; 2],
    /// By cells, of the four corners, crosswind first, the logarithm of the ratio to Gauss's function of the angles.
    pub densities: Vec<f32>,
}

/// What a drawn surface shows.
#[derive(Clone, Copy, PartialEq)]
enum Part {
    Whitecap,
    Facets,
    /// A wave turned away, or one that hides it.
    Nothing,
}

/// Where a pair of directions lies in the fine grid.
struct Place<T> {
    /// Of the four rows about it, the first number of each and its weight.
    rows: [(usize, T); 4],
    /// In a row: the number of the first of two values, and how far towards the second.
    theta: (usize, T),
    /// Tangents of theta_i/2, not beyond the table, and theta_r/2.
    halves: [T; 2],
    /// Cosine and sine of the wind's azimuth from the plane.
    wind: [T; 2],
    /// Horizontal, in the plane, away from the source.
    forward: [T; 2],
    /// phi_r of Eq. 88 with the table's sign; sigma's factor of Eq. 89.
    phi: T,
    narrowing: T,
    outside: bool,
}

impl EmpiricalLobe {
    /// Of a sea that the table knows.
    ///
    /// # Errors
    /// [`Error::Surface`] where the surface is not [`Surface::Empirical`], and as [`Table::check`].
    pub fn new(water: &Water, table: &Table) -> Result<Self, Error> {
        let water = &water.on(&[Surface::Empirical])?;
        let slice = table.slice(water)?;
        let spreads = Spreads::new(water);
        let (densities, steps) = ln_densities(&Exact::new(water)?, &spreads, DENSITIES);
        let densities = densities.into_iter().map(half).collect();
        let [incidences, thetas] = slice.ends().map(|ends| ends.map(|angle| (0.5 * angle).tan()));
        // A table for the vertical alone has a grid all the same.
        let incidences = [incidences[0], incidences[1].max(1e-3)];
        let twice = |t: f64| 2.0 * t.atan();
        let all: Vec<f64> = (0..=THETAS).map(|k| twice(2.0 * k as f64 / THETAS as f64 - 1.0)).collect();
        let rows: Vec<_> = (0..(INCIDENCES + 1) * (AZIMUTHS + 1))
            .into_par_iter()
            .map(|row| {
                let of_source = twice(incidences[1] * (row / (AZIMUTHS + 1)) as f64 / INCIDENCES as f64);
                let azimuth = turn(2.0 * (row % (AZIMUTHS + 1)) as f64 / AZIMUTHS as f64);
                let (in_plane, widths) = slice.row(of_source, azimuth, &all);
                let spreads = spreads.turned(azimuth.to_degrees());
                let source = [-of_source.sin(), 0.0, of_source.cos()];
                let cells = in_plane.iter().zip(&all).map(|([ratio, whitecaps, square], theta)| {
                    // At the horizon all is hidden: a little above it stands for that.
                    let o = [theta.sin(), 0.0, theta.cos().max(LOWEST)];
                    let leaning = match water.parameters.across {
                        Across::Slopes => spreads.shadowing(source, o) / spreads.leaning(source, o),
                        Across::Report => 1.0,
                    };
                    let ratio = ratio * spreads.share(source, o) * leaning;
                    [half(ratio.ln()), half(SHARES * whitecaps) / SHARES as f32, *square as f32]
                });
                (cells.collect::<Vec<_>>(), widths.map(half))
            })
            .collect();
        let widths: Vec<[f32; 4]> = rows.iter().map(|(_, widths)| *widths).collect();
        let in_plane: Vec<[f32; 3]> = rows.into_iter().flat_map(|(cells, _)| cells).collect();
        let mut sampler = spreads.sampler(water);
        // As many whitecaps as a source overhead meets.
        sampler = sampler.with_whitecaps(f64::from(in_plane[THETAS / 2][1]));
        Ok(Self {
            sampler,
            across: water.parameters.across,
            spreads,
            incidences,
            thetas,
            in_plane,
            widths,
            densities,
            steps,
        })
    }

    /// f, 1/sr (Eq. 90), for unit vectors to source and observer; 0 at or below the horizon, not a number where a coordinate
    /// is none.
    pub fn eval<T: Scalar>(&self, i: Vec3<T>, o: Vec3<T>) -> T {
        self.eval_parts(i, o, Parts::ALL)
    }

    /// f of some of its parts, 1/sr.
    #[inline]
    pub fn eval_parts<T: Scalar>(&self, i: Vec3<T>, o: Vec3<T>, parts: Parts) -> T {
        let zero = T::of(0.0);
        if !(zero.below(i[2]) && zero.below(o[2])) {
            return defined(i, o, [i[2], o[2]], zero);
        }
        let place = self.place(i, o);
        let [ratio, whitecaps] = place.in_plane(&self.in_plane, |cell| [cell[0], cell[1]]);
        let mut f = zero;
        if parts.facets {
            let (density, visible) = self.level(i, o, &place);
            let mut exponent = ratio + density;
            if self.across == Across::Report {
                let [sigma, delta] = place.around(&self.widths, |cell| [cell[0], cell[2]]);
                let x = (place.phi - delta) / (sigma * place.narrowing);
                exponent = exponent - x * x;
            }
            f = self.reflectance(i, o) * visible * exponent.exp();
        }
        if parts.whitecaps {
            f = f + T::of(self.sampler.whitecap_brdf) * whitecaps;
        }
        defined(i, o, [i[2], o[2]], f)
    }

    /// What the facets would reflect on level water, over rho, as the logarithm of their density and the rest: towards the
    /// observer with [`Across::Slopes`], else towards what is in the plane of it.
    fn level<T: Scalar>(&self, i: Vec3<T>, o: Vec3<T>, place: &Place<T>) -> (T, T) {
        let one = T::of(1.0);
        let facets = &self.sampler.facets;
        let (slope, cos, sin) = match self.across {
            Across::Slopes => {
                let [x, y, z] = [i[0] + o[0], i[1] + o[1], i[2] + o[2]];
                let [c, s] = [facets.wind.cos, facets.wind.sin].map(T::of);
                let lean = -one / T::max(z, T::of(1e-12));
                let slope = [lean * (x * c + y * s), lean * (y * c - x * s)];
                // The waves that carry these facets lean with them, and show the observer more than level water does.
                let carried = self.spreads.carried();
                let [u, v] = [0, 1].map(|k| slope[k] * T::of(carried[k]));
                let across = u * (o[0] * c + o[1] * s) + v * (o[1] * c - o[0] * s);
                let cos = T::max((o[2] - across) / (one + u * u + v * v).sqrt(), T::of(LEANING));
                let sine = |z: T| T::max(one - z * z, T::of(0.0)).sqrt();
                (slope, [i[2], cos], [sine(i[2]), sine(cos)])
            }
            Across::Report => {
                // By half angles: the half vector leans by half the difference of theta_r and theta_i.
                let [a, b] = place.halves;
                let lean = (a - b) / (one + a * b);
                let over = place.halves.map(|t| one / (one + t * t));
                let cos =
                    [0, 1].map(|k| T::max((one - place.halves[k] * place.halves[k]) * over[k], T::of(0.0)));
                let sin = [0, 1].map(|k| T::of(2.0) * place.halves[k].abs() * over[k]);
                ([lean * place.wind[0], -lean * place.wind[1]], cos, sin)
            }
        };
        let mut area = cos[0] * cos[1];
        if facets.shadowing {
            let sigma = T::of(facets.sigma_shadow);
            area = area + cos[1] * hidden(cos[0], sigma * sin[0]) + cos[0] * hidden(cos[1], sigma * sin[1]);
        }
        (self.ln_density(slope), one / T::max(area, T::of(GRAZING)))
    }

    /// The logarithm of the facets' density along a half vector of a slope upwind and crosswind.
    fn ln_density<T: Scalar>(&self, slope: [T; 2]) -> T {
        let middle = 0.5 * (DENSITIES - 1) as f64;
        let sigmas = self.spreads.sigmas();
        let tilt = [0, 1].map(|k| Real::atan2(slope[k], T::of(1.0)) * T::of(1.0 / sigmas[k]));
        let [u, c] = [0, 1].map(|k| tilt[k] * T::of(1.0 / self.steps[k]) + T::of(middle));
        let end = T::of(2.0 * middle);
        let inside = T::of(0.0).below(u) && u.below(end) && T::of(0.0).below(c) && c.below(end);
        if !inside {
            return T::of(NOTHING);
        }
        let ((j, s), (k, t)) = (split(u, DENSITIES - 1), split(c, DENSITIES - 1));
        let node = |n: usize| T::of(f64::from(self.densities[n]));
        let at = |n: usize| node(n) + t * (node(n + 1) - node(n));
        let (near, far) = (at(j * DENSITIES + k), at((j + 1) * DENSITIES + k));
        let gauss = T::of(0.5) * (tilt[0] * tilt[0] + tilt[1] * tilt[1]);
        near + s * (far - near) - gauss
    }

    /// f with its standard uncertainty (Eqs. 90-91), for unit vectors to source and observer.
    pub fn estimate(&self, i: [f64; 3], o: [f64; 3]) -> Estimate {
        if !(i[2] > 0.0 && o[2] > 0.0) {
            let f = defined(i, o, [i[2], o[2]], 0.0);
            return Estimate { mean: f, std: f, outside: false };
        }
        let place = self.place(i, o);
        let (moments, rho) = self.moments(i, o, &place);
        let [mean, std] = match self.across {
            Across::Slopes => moments.brdf(rho, self.sampler.whitecap_brdf),
            Across::Report => {
                let [sigma, u_sigma, delta, u_delta] = place.around(&self.widths, |cell| *cell);
                let (sigma, u_sigma) = (sigma * place.narrowing, u_sigma * place.narrowing);
                let x = (place.phi - delta) / sigma;
                let fall = (-x * x).exp();
                let facets = fall * moments.facets;
                let moments = Moments { facets, facets2: fall * fall * moments.facets2, ..moments };
                let [mean, std] = moments.brdf(rho, self.sampler.whitecap_brdf);
                // Of what facets reflect, by the spreads of the lobe's width and offset.
                let (wider, aside) = (2.0 * x * x * u_sigma / sigma, 2.0 * x * u_delta / sigma);
                [mean, std.hypot(rho * facets * wider.hypot(aside))]
            }
        };
        let [mean, std] = [mean, std].map(|f| defined(i, o, [i[2], o[2]], f));
        Estimate { mean, std, outside: place.outside }
    }

    /// Where the lobe across the plane peaks, or with [`Across::Slopes`] towards the observer itself; and rho.
    fn moments(&self, i: [f64; 3], o: [f64; 3], place: &Place<f64>) -> (Moments, f64) {
        let [ratio, whitecaps, square] = place.in_plane(&self.in_plane, |cell| *cell);
        let (density, visible) = self.level(i, o, place);
        let seen = if self.across == Across::Report { place.view() } else { o };
        let facets = visible * (ratio + density).exp();
        let square = (square + self.spreads.ln_square(i, seen)).clamp(0.0, LARGEST_SQUARE).exp();
        let moments = Moments { facets, facets2: facets * facets * square, whitecaps };
        (moments, self.reflectance(i, o))
    }

    /// f drawn through the table's spreads, as single surfaces would show it: a whitecap, or facets whose lobe across the
    /// plane has a height, a width and an offset of its own. The mean lobe is as wide as single ones with their offsets
    /// make it, so that of these the width is less; their heights have mean and spread in the plane of the table. So the
    /// mean of the draws is Eq. 90's, and nothing is diluted twice. With [`Across::Slopes`] there are no lobes to draw:
    /// f is, with the mean and the spread of [`EmpiricalLobe::estimate`].
    pub fn monte_carlo(
        &self,
        i: [f64; 3],
        o: [f64; 3],
        draws: NonZeroU32,
        seed: u64,
        limits: &[f64],
    ) -> Statistics {
        let mut values = vec![0.0; draws.get() as usize];
        if i[2] <= 0.0 || o[2] <= 0.0 {
            return Statistics { whitecap: 0.0, ..Statistics::of_values(values, limits, 0.0) };
        }
        let place = self.place(i, o);
        let (Moments { facets, facets2, whitecaps }, rho) = self.moments(i, o, &place);
        let foam = self.sampler.whitecap_brdf;
        let unseen = self.spreads.unseen(i, o).min(1.0 - whitecaps);
        let open = (1.0 - whitecaps - unseen).max(1e-6);
        let lobe = (self.across == Across::Report).then(|| {
            let [sigma, u_sigma, delta, u_delta] = place.around(&self.widths, |cell| *cell);
            let (sigma, u_sigma) = (sigma * place.narrowing, u_sigma * place.narrowing);
            let single = (sigma * sigma - 2.0 * u_delta * u_delta).max(0.04 * sigma * sigma).sqrt();
            ([single, u_sigma], [place.phi - delta, u_delta])
        });
        let draw = |instance: u64| {
            let mut numbers = Numbers::new(Draws::Sobol, seed, instance);
            let chance = numbers.next();
            let [[height, wide], [aside, _]] = [(); 2].map(|()| normals(numbers.next(), numbers.next()));
            // Off the peak of its own lobe, and how far from that the mean's peak is.
            let falls = lobe.map(|([single, u_sigma], [off, u_delta])| {
                let sigma = (single + u_sigma * wide).max(0.2 * single);
                [off - u_delta * aside, -u_delta * aside].map(|x| (-(x / sigma).powi(2)).exp())
            });
            let part = match chance {
                chance if chance < whitecaps => Part::Whitecap,
                chance if chance < 1.0 - unseen => Part::Facets,
                _ => Part::Nothing,
            };
            (part, height, falls.unwrap_or([1.0; 2]))
        };
        let count = f64::from(draws.get());
        let all: Vec<_> = (0..u64::from(draws.get())).map(draw).collect();
        let [first, second] =
            [1, 2].map(|power| all.iter().map(|(_, _, falls)| falls[1].powi(power)).sum::<f64>() / count);
        let height = facets / (open * first.max(f64::MIN_POSITIVE));
        // Log-normal heights with the mean square that the table wants.
        let square = if facets > 0.0 { facets2 / (facets * facets) } else { 1.0 };
        let spread = (square * open * first * first / second.max(f64::MIN_POSITIVE)).max(1.0).ln();
        for (value, (part, normal, falls)) in values.iter_mut().zip(&all) {
            *value = match part {
                Part::Whitecap => foam,
                Part::Facets => rho * height * (spread.sqrt() * normal - 0.5 * spread).exp() * falls[0],
                Part::Nothing => 0.0,
            };
        }
        let foamy = all.iter().filter(|(part, ..)| *part == Part::Whitecap).count() as f64 / count;
        Statistics { whitecap: foamy, ..Statistics::of_values(values, limits, f64::INFINITY) }
    }

    /// What [`EmpiricalLobe::estimate`] and [`EmpiricalLobe::monte_carlo`] say together, with the error of the method. Where f
    /// spreads widely, single surfaces are far from log-normal, and draws place quantiles at levels that are off by
    /// `share_error` in nine rows of ten (`quantiles_by_the_table`).
    pub fn statistics(
        &self,
        i: [f64; 3],
        o: [f64; 3],
        draws: NonZeroU32,
        seed: u64,
        limits: &[f64],
    ) -> (Statistics, Estimate) {
        let estimate = self.estimate(i, o);
        let drawn = self.monte_carlo(i, o, draws, seed, limits);
        let spread = if estimate.mean > 0.0 { estimate.std / estimate.mean } else { 0.0 };
        let share_error = (0.1 + 0.15 * spread).min(1.0);
        let statistics = Statistics {
            mean: estimate.mean,
            std: estimate.std,
            sem: 0.0,
            effective: f64::NAN,
            mean_upper: estimate.mean * (1.0 + TABLE_ERROR),
            over_upper: drawn.over.iter().map(|p| (p + share_error).min(1.0)).collect(),
            mean_error: TABLE_ERROR,
            share_error,
            ..drawn
        };
        (statistics, estimate)
    }

    /// [`EmpiricalLobe::estimate`] for every observer of an engagement: directions are those from where its beam meets the mean surface
    /// (Eqs. 83, 86).
    pub fn estimates(&self, engagement: &Engagement) -> Vec<Estimate> {
        engagement.ways().map(|[i, o]| self.estimate(i, o)).collect()
    }

    /// rho between two directions (Eqs. 61-63).
    fn reflectance<T: Scalar>(&self, i: Vec3<T>, o: Vec3<T>) -> T {
        let half = T::of(0.5) * (0..3).fold(T::of(0.0), |sum, k| sum + (i[k] + o[k]) * (i[k] + o[k])).sqrt();
        let facets = &self.sampler.facets.reflectance;
        T::of(facets.eval(half.to_f64().min(1.0)))
    }

    #[inline]
    fn place<T: Scalar>(&self, i: Vec3<T>, o: Vec3<T>) -> Place<T> {
        let [zero, one] = [0.0, 1.0].map(T::of);
        let facets = &self.sampler.facets;
        let [cos_wind, sin_wind] = [facets.wind.cos, facets.wind.sin].map(T::of);
        // Away from the source; with the wind where the source is overhead.
        let flat = (i[0] * i[0] + i[1] * i[1]).sqrt();
        let overhead = flat.below(T::of(1e-6));
        let inverse = one / T::max(flat, T::of(1e-6));
        let [x, y] = if overhead { [cos_wind, sin_wind] } else { [-i[0] * inverse, -i[1] * inverse] };
        let half_i = flat / (one + i[2]);
        let last = T::of(self.incidences[1]);
        let tan_i = T::min(half_i, last);
        // The wind's azimuth from there, to either side.
        let cos = cos_wind * x + sin_wind * y;
        let sin = if overhead { zero } else { sin_wind * x - cos_wind * y };
        let around = one - cos / (cos.abs() + sin.abs());
        let [forward, aside] = [o[0] * x + o[1] * y, o[1] * x - o[0] * y];
        let tan_r = forward / ((forward * forward + o[2] * o[2]).sqrt() + o[2]);
        let along = T::of(INCIDENCES as f64) * (tan_i / last);
        let (a, s) = split(along, INCIDENCES);
        let (b, t) = split(T::of(0.5 * AZIMUTHS as f64) * around, AZIMUTHS);
        let row = a * (AZIMUTHS + 1) + b;
        let (near, left) = (one - s, one - t);
        // Eqs. 87-89 by half angles.
        let tan2 = tan_i * tan_i;
        let specular = (T::of(2.0) * tan_i * forward + (one - tan2) * o[2]) / (one + tan2);
        let phi = Real::atan2(aside, specular.abs());
        let lower = T::min(tan_i, tan_r);
        let beyond = |x: T, [low, high]: [f64; 2]| {
            let slack = 1e-6;
            !(low - slack..=high + slack).contains(&x.to_f64())
        };
        Place {
            halves: [tan_i, tan_r],
            wind: [cos, sin],
            forward: [x, y],
            rows: [
                (row, near * left),
                (row + 1, near * t),
                (row + AZIMUTHS + 1, s * left),
                (row + AZIMUTHS + 2, s * t),
            ],
            theta: split(T::of(0.5 * THETAS as f64) * (tan_r + one), THETAS),
            phi: if sin.below(zero) { -phi } else { phi },
            narrowing: (one - tan_i * lower) / ((one + tan2) * (one + lower * lower)).sqrt(),
            outside: beyond(half_i, self.incidences) || beyond(tan_r, self.thetas),
        }
    }

    /// For traced code.
    pub fn fine_grid(&self) -> FineGrid {
        let whitecaps = self.in_plane.iter().any(|cell| cell[1] > 0.0);
        // What is needed together lies together, so that a look into memory finds it.
        let ends = (0..(INCIDENCES + 1) * AZIMUTHS).map(|k| {
            let row = k / AZIMUTHS * (AZIMUTHS + 1) + k % AZIMUTHS;
            [row, row + 1]
        });
        let in_plane = ends.clone().flat_map(|rows| {
            (0..THETAS).flat_map(move |theta| {
                let at = |n: usize, unit: f32| {
                    let cell = |row: usize, t: usize| unit * self.in_plane[row * (THETAS + 1) + t][n];
                    [theta, theta + 1].map(|t| rows.map(|row| cell(row, t))).concat()
                };
                let shares = if whitecaps { at(1, SHARES as f32) } else { vec![] };
                at(0, 1.0).into_iter().chain(shares)
            })
        });
        let ends = (0..INCIDENCES * AZIMUTHS).map(|k| {
            let row = k / AZIMUTHS * (AZIMUTHS + 1) + k % AZIMUTHS;
            [row, row + 1, row + AZIMUTHS + 1, row + AZIMUTHS + 2]
        });
        let widths = ends.flat_map(|rows| [0, 2].map(|n| rows.map(|row| self.widths[row][n])).concat());
        let cells = (0..(DENSITIES - 1) * (DENSITIES - 1))
            .map(|k| k / (DENSITIES - 1) * DENSITIES + k % (DENSITIES - 1));
        let densities =
            cells.flat_map(|n| [n, n + 1, n + DENSITIES, n + DENSITIES + 1].map(|n| self.densities[n]));
        FineGrid {
            steps: [INCIDENCES as u32, AZIMUTHS as u32, THETAS as u32],
            incidence: self.incidences[1],
            in_plane: in_plane.collect(),
            widths: widths.collect(),
            whitecaps,
            slopes: self.across == Across::Slopes,
            carried: self.spreads.carried(),
            density_steps: DENSITIES as u32 - 1,
            sigmas: self.spreads.sigmas(),
            density_step: self.steps,
            densities: densities.collect(),
        }
    }
}

/// Two independent normal deviates of two uniform ones (Box and Muller's).
fn normals(a: f64, b: f64) -> [f64; 2] {
    let (sin, cos) = (TAU * b).sin_cos();
    let radius = (-2.0 * (1.0 - a).ln()).sqrt();
    [radius * cos, radius * sin]
}

/// Rounded to half precision, in which traced code keeps its grid: 11 bits, or 2^-24 near 0.
fn half(x: f64) -> f32 {
    let unit = 2f64.powi((x.abs().log2().floor() as i32).max(-14) - 10);
    ((x / unit).round_ties_even() * unit) as f32
}

/// A place on an axis of so many steps: the step and how far along it.
fn split<T: Scalar>(x: T, steps: usize) -> (usize, T) {
    let k = (x.to_f64() as usize).min(steps - 1);
    (k, T::min(x - T::of(k as f64), T::of(1.0)))
}

/// The angle from 0 to pi for which this stands, from 0 to 2.
fn turn(around: f64) -> f64 {
    let cos = 1.0 - around;
    (1.0 - cos.abs()).atan2(cos)
}

impl Place<f64> {
    /// The unit vector in the plane at theta_r.
    fn view(&self) -> [f64; 3] {
        let t = self.halves[1];
        let (sin, cos) = (2.0 * t / (1.0 + t * t), (1.0 - t * t) / (1.0 + t * t));
        [sin * self.forward[0], sin * self.forward[1], cos]
    }
}

impl<T: Scalar> Place<T> {
    /// Values between nodes over all three axes.
    fn in_plane<const N: usize>(&self, cells: &[[f32; 3]], of: impl Fn(&[f32; 3]) -> [f32; N]) -> [T; N] {
        let (k, t) = self.theta;
        let mut sums = [T::of(0.0); N];
        for (row, weight) in self.rows {
            let at = row * (THETAS + 1) + k;
            let (low, high) = (of(&cells[at]), of(&cells[at + 1]));
            for n in 0..N {
                let [low, high] = [low[n], high[n]].map(|x| T::of(x.into()));
                sums[n] = sums[n] + weight * (low + t * (high - low));
            }
        }
        sums
    }

    /// Values between nodes over theta_i and the azimuth.
    fn around<const N: usize>(&self, cells: &[[f32; 4]], of: impl Fn(&[f32; 4]) -> [f32; N]) -> [T; N] {
        let mut sums = [T::of(0.0); N];
        for (row, weight) in self.rows {
            for (sum, x) in sums.iter_mut().zip(of(&cells[row])) {
                *sum = *sum + weight * T::of(x.into());
            }
        }
        sums
    }
}
