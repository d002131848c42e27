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
//! assert!((lobe.eval(i, o) / estimate.mean - 1.0).abs() < 1e-4);
//! # Ok(())
//! # }
//! ```

use super::fine_grid::{AZIMUTHS, DENSITIES, FineGrid, INCIDENCES, Place, SHARES, THETAS};
use super::reference::Moments;
use super::table::Table;
use crate::brdf::lobe::defined;
use crate::brdf::{Lobe, Parts, polarised};
use crate::config::{OffPlaneModel, Surface, Water};
use crate::error::Error;
use crate::numeric::Vec3;
use crate::numeric::packets::{Packets, Tabulated};
use crate::statistics::level_water::{BaselineLobe, ln_densities};
use crate::statistics::{Engagement, Exact, Statistics};
use crate::surface::{Draws, InstanceRng};
use rayon::prelude::*;
use std::f64::consts::TAU;
use std::num::NonZeroU32;

/// The cosine that stands for the horizon.
const LOWEST: f64 = 2e-3;

/// Relative error of a mean by the table, in its grid and in the plane of incidence or with [`OffPlaneModel::Slopes`].
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
    baseline: BaselineLobe,
    /// Tangents of half the angles theta_i and theta_r between which the table has nodes.
    incidences: [f64; 2],
    thetas: [f64; 2],
    /// By theta_i, azimuth and theta_r, in the plane: the logarithm of the ratio of the facets' f to what they would reflect
    /// on level water; the share of whitecaps; the logarithm of the mean square of the facets' f over its squared mean,
    /// less that of Gaussian slopes.
    in_plane: Vec<[f32; 3]>,
    /// By theta_i and azimuth: sigma, u_sigma, delta, u_delta, radians.
    widths: Vec<[f32; 4]>,
    /// The same laid out for evaluation.
    grid: FineGrid<f64>,
    single: FineGrid<f32>,
}

/// A number type in which the grid is at hand.
pub trait Gridded: Tabulated {
    /// It.
    fn grid(lobe: &EmpiricalLobe) -> &FineGrid<Self>;
}

impl Gridded for f64 {
    fn grid(lobe: &EmpiricalLobe) -> &FineGrid<Self> {
        &lobe.grid
    }
}

impl Gridded for f32 {
    fn grid(lobe: &EmpiricalLobe) -> &FineGrid<Self> {
        &lobe.single
    }
}

/// What a drawn surface shows.
#[derive(Clone, Copy, PartialEq)]
enum Part {
    Whitecap,
    Facets,
    /// A wave turned away, or one that hides it.
    Nothing,
}

impl EmpiricalLobe {
    /// Of a sea that the table knows.
    ///
    /// # Errors
    /// [`Error::Surface`] where the surface is not [`Surface::Empirical`], and as [`Table::check`].
    pub fn new(water: &Water, table: &Table) -> Result<Self, Error> {
        let water = &water.on(&[Surface::Empirical])?;
        let slice = table.slice(water)?;
        let baseline = BaselineLobe::new(water);
        let (densities, steps) = ln_densities(&Exact::new(water)?, &baseline, DENSITIES);
        let densities: Vec<f32> = densities.into_iter().map(half).collect();
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
                let baseline = baseline.turned(azimuth.to_degrees());
                let source = [-of_source.sin(), 0.0, of_source.cos()];
                let cells = in_plane.iter().zip(&all).map(|([ratio, whitecaps, square], theta)| {
                    // At the horizon all is hidden: a little above it stands for that.
                    let o = [theta.sin(), 0.0, theta.cos().max(LOWEST)];
                    let leaning = match water.parameters.across {
                        OffPlaneModel::Slopes => baseline.shadowing(source, o) / baseline.leaning(source, o),
                        OffPlaneModel::Report => 1.0,
                    };
                    let ratio = ratio * baseline.share(source, o) * leaning;
                    [half(ratio.ln()), half(SHARES * whitecaps) / SHARES as f32, *square as f32]
                });
                (cells.collect::<Vec<_>>(), widths.map(half))
            })
            .collect();
        let widths: Vec<[f32; 4]> = rows.iter().map(|(_, widths)| *widths).collect();
        let in_plane: Vec<[f32; 3]> = rows.into_iter().flat_map(|(cells, _)| cells).collect();
        let mut sampler = baseline.sampler(water);
        // As many whitecaps as a source overhead meets.
        sampler = sampler.with_whitecaps(f64::from(in_plane[THETAS / 2][1]));
        let across = water.parameters.across;
        let grid =
            fine_grid(sampler, across, &baseline, incidences[1], &in_plane, &widths, &densities, steps);
        Ok(Self { sampler, baseline, incidences, thetas, in_plane, widths, single: grid.cast(), grid })
    }

    /// What is evaluated; in any other number type by its `cast`.
    pub fn fine_grid(&self) -> &FineGrid<f64> {
        &self.grid
    }

    /// f, 1/sr (Eq. 90), for unit vectors to source and observer; 0 at or below the horizon, NaN in, NaN out.
    pub fn eval<T: Gridded>(&self, i: Vec3<T>, o: Vec3<T>) -> T {
        self.eval_parts(i, o, Parts::ALL)
    }

    /// f of some of its parts, 1/sr.
    pub fn eval_parts<T: Gridded>(&self, i: Vec3<T>, o: Vec3<T>, parts: Parts) -> T {
        T::grid(self).eval(i, o, parts)
    }

    /// The Stokes vector that is seen of another one, 1/sr, with f of [`EmpiricalLobe::estimate`].
    pub fn stokes(&self, i: [f64; 3], o: [f64; 3], stokes: [f64; 4]) -> [f64; 4] {
        let parts = [self.estimate(i, o).mean, self.eval_parts(i, o, Parts::WHITECAPS)];
        polarised::seen(&self.sampler.facets.reflectance, i, o, parts, stokes)
    }

    /// f with its standard uncertainty (Eqs. 90-91), for unit vectors to source and observer.
    pub fn estimate(&self, i: [f64; 3], o: [f64; 3]) -> Estimate {
        if !(i[2] > 0.0 && o[2] > 0.0) {
            let f = defined(i, o, [i[2], o[2]], 0.0);
            return Estimate { mean: f, std: f, outside: false };
        }
        let place = self.grid.place(i, o);
        let (moments, rho) = self.moments(i, o, &place);
        let [mean, std] = match self.grid.across {
            OffPlaneModel::Slopes => moments.brdf(rho, self.sampler.whitecap_brdf),
            OffPlaneModel::Report => {
                let [sigma, u_sigma, delta, u_delta] = place.around(&self.widths);
                let (sigma, u_sigma) = (sigma * place.narrowing, u_sigma * place.narrowing);
                let x = (place.phi - delta) / sigma;
                let fall = (-x * x).exp();
                let facets = fall * moments.facets;
                let moments = Moments { facets, facets2: fall * fall * moments.facets2, ..moments };
                let [mean, std] = moments.brdf(rho, self.sampler.whitecap_brdf);
                // Eq. 91: of what facets reflect, by the spreads of the lobe's width and offset.
                let (wider, aside) = (2.0 * x * x * u_sigma / sigma, 2.0 * x * u_delta / sigma);
                [mean, std.hypot(rho * facets * wider.hypot(aside))]
            }
        };
        let [mean, std] = [mean, std].map(|f| defined(i, o, [i[2], o[2]], f));
        Estimate { mean, std, outside: self.outside(&place) }
    }

    /// Where the lobe across the plane peaks, or with [`OffPlaneModel::Slopes`] towards the observer itself; and rho.
    fn moments(&self, i: [f64; 3], o: [f64; 3], place: &Place<f64>) -> (Moments, f64) {
        let [ratio, whitecaps, square] = place.in_plane(&self.in_plane);
        let (density, visible) = self.grid.level(i, o, place);
        let seen = if self.grid.across == OffPlaneModel::Report { place.view() } else { o };
        let facets = visible * (ratio + density).exp();
        let square = (square + self.baseline.ln_square(i, seen)).clamp(0.0, LARGEST_SQUARE).exp();
        let moments = Moments { facets, facets2: facets * facets * square, whitecaps };
        (moments, self.grid.reflectance(i, o))
    }

    /// f drawn through the table's spreads, as single surfaces would show it: a whitecap, or facets whose lobe across the
    /// plane has a height, a width and an offset of its own. The mean lobe is as wide as single ones with their offsets
    /// make it, so that of these the width is less; their heights have mean and spread in the plane of the table. So the
    /// mean of the draws is Eq. 90's, and nothing is diluted twice. With [`OffPlaneModel::Slopes`] there are no lobes to draw:
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
        let place = self.grid.place(i, o);
        let (Moments { facets, facets2, whitecaps }, rho) = self.moments(i, o, &place);
        let foam = self.sampler.whitecap_brdf;
        let unseen = self.baseline.unseen(i, o).min(1.0 - whitecaps);
        let open = (1.0 - whitecaps - unseen).max(1e-6);
        let lobe = (self.grid.across == OffPlaneModel::Report).then(|| {
            let [sigma, u_sigma, delta, u_delta] = place.around(&self.widths);
            let (sigma, u_sigma) = (sigma * place.narrowing, u_sigma * place.narrowing);
            let single = (sigma * sigma - 2.0 * u_delta * u_delta).max(0.04 * sigma * sigma).sqrt();
            ([single, u_sigma], [place.phi - delta, u_delta])
        });
        let draw = |instance: u64| {
            let mut numbers = InstanceRng::new(Draws::Sobol, seed, instance);
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

    /// Whether directions lie outside of the table's grid.
    fn outside(&self, place: &Place<f64>) -> bool {
        let beyond = |x: f64, [low, high]: [f64; 2]| !(low - 1e-6..=high + 1e-6).contains(&x);
        beyond(place.half_i, self.incidences) || beyond(place.halves[1], self.thetas)
    }
}

/// The grid from its nodes: what is needed together lies together, so that a look into memory finds it.
#[allow(clippy::too_many_arguments)]
fn fine_grid(
    sampler: Lobe<f64>,
    across: OffPlaneModel,
    baseline: &BaselineLobe,
    last: f64,
    in_plane: &[[f32; 3]],
    widths: &[[f32; 4]],
    densities: &[f32],
    steps: [f64; 2],
) -> FineGrid<f64> {
    let whitecaps = in_plane.iter().any(|cell| cell[1] > 0.0);
    let left = |k: usize| k / AZIMUTHS * (AZIMUTHS + 1) + k % AZIMUTHS;
    let corners = (0..(INCIDENCES + 1) * AZIMUTHS).flat_map(|k| {
        let rows = [left(k), left(k) + 1];
        (0..THETAS).flat_map(move |theta| {
            let at = |n: usize, unit: f32| {
                let cell = |row: usize, t: usize| unit * in_plane[row * (THETAS + 1) + t][n];
                [theta, theta + 1].map(|t| rows.map(|row| cell(row, t))).concat()
            };
            let shares = if whitecaps { at(1, SHARES as f32) } else { vec![] };
            at(0, 1.0).into_iter().chain(shares)
        })
    });
    let around = (0..INCIDENCES * AZIMUTHS).flat_map(|k| {
        let rows = [left(k), left(k) + 1, left(k) + AZIMUTHS + 1, left(k) + AZIMUTHS + 2];
        [0, 2].map(|n| rows.map(|row| widths[row][n])).concat()
    });
    let cells = (0..(DENSITIES - 1) * (DENSITIES - 1))
        .map(|k| k / (DENSITIES - 1) * DENSITIES + k % (DENSITIES - 1))
        .flat_map(|n| [n, n + 1, n + DENSITIES, n + DENSITIES + 1].map(|n| densities[n]));
    FineGrid {
        lobe: sampler,
        across,
        whitecaps,
        last,
        inv_step: INCIDENCES as f64 / last,
        carried: baseline.carried(),
        inv_sigma: baseline.sigmas().map(f64::recip),
        inv_density_step: steps.map(f64::recip),
        in_plane: Packets { width: if whitecaps { 8 } else { 4 }, half: true, numbers: corners.collect() },
        widths: Packets { width: 8, half: true, numbers: around.collect() },
        densities: Packets { width: 4, half: true, numbers: cells.collect() },
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

impl Place<f64> {
    /// Of the four rows about it, the number of each and its weight.
    fn rows(&self) -> [(usize, f64); 4] {
        let ((a, s), (b, t)) = (self.incidence, self.azimuth);
        let row = a as usize * (AZIMUTHS + 1) + b as usize;
        let (near, left) = (1.0 - s, 1.0 - t);
        [(row, near * left), (row + 1, near * t), (row + AZIMUTHS + 1, s * left), (row + AZIMUTHS + 2, s * t)]
    }

    /// Values between nodes over all three axes.
    fn in_plane(&self, cells: &[[f32; 3]]) -> [f64; 3] {
        let (k, t) = self.theta;
        let mut sums = [0.0; 3];
        for (row, weight) in self.rows() {
            let at = row * (THETAS + 1) + k as usize;
            for (n, sum) in sums.iter_mut().enumerate() {
                let [low, high] = [cells[at][n], cells[at + 1][n]].map(f64::from);
                *sum += weight * (low + t * (high - low));
            }
        }
        sums
    }

    /// Values between nodes over theta_i and the azimuth.
    fn around(&self, cells: &[[f32; 4]]) -> [f64; 4] {
        let mut sums = [0.0; 4];
        for (row, weight) in self.rows() {
            for (sum, x) in sums.iter_mut().zip(cells[row]) {
                *sum += weight * f64::from(x);
            }
        }
        sums
    }
}
