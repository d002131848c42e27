//! The report's empirical model of a sea (Eqs. 83-91), from a table: evaluated in nanoseconds, with its uncertainty.
//!
//! Configured, it is the table at one wind and one footprint, on a grid so fine that straight lines do between its nodes:
//! even in the tangents of half the angles theta_i and theta_r, and in what stands for the wind's azimuth there, so that
//! no angle is computed but the one across the plane.
//!
//! Beyond the largest angle of incidence in the table it is what it is there, and beyond its angles theta_r the ratio to
//! the closed form is: [`Estimate::outside`] says so.

use crate::brdf::{Parts, up};
use crate::empirical::Moments;
use crate::real::Vec3;
use crate::reference_lobe::Reference;
use crate::table::Table;
use crate::waves::{Draws, Numbers};
use crate::{Across, Engagement, Error, Lobe, Real, Statistics, Water};
use rayon::prelude::*;
use std::f64::consts::TAU;
use std::num::NonZeroU32;

/// Steps of the fine grid: over theta_i, the wind's azimuth and theta_r.
const INCIDENCES: usize = 64;
const AZIMUTHS: usize = 32;
const THETAS: usize = 160;
/// What stands for the horizon, where the closed form ends; radians.
const LOWEST: f64 = 1.5690;
/// The logarithm of nothing.
const NOTHING: f64 = -87.0;

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
    /// With [`Across::Slopes`] the closed form.
    slopes: Option<Reference>,
    /// Tangents of half the angles theta_i and theta_r between which the table has nodes.
    incidences: [f64; 2],
    thetas: [f64; 2],
    /// By theta_i, azimuth and theta_r: the logarithm of the facets' f in the plane over rho, or with `slopes` of its ratio
    /// to the closed form; the share of whitecaps; the logarithm of the mean square of the facets' f over its squared mean,
    /// or with `slopes` of its ratio to the closed form's.
    in_plane: Vec<[f32; 3]>,
    /// By theta_i and azimuth: sigma, u_sigma, delta, u_delta, radians.
    widths: Vec<[f32; 4]>,
}

/// The fine grid as traced code reads it.
#[derive(Debug, Clone)]
pub struct FineGrid {
    /// Steps over tan(theta_i/2) from 0, over the stand-in of the azimuth from 0 to 2, and over tan(theta_r/2) from -1 to 1.
    pub steps: [u32; 3],
    /// The largest tan(theta_i/2).
    pub incidence: f64,
    /// By theta_i, by intervals of the azimuth and by theta_r, what the interval's two ends hold: logarithms, and with
    /// `whitecaps` their shares.
    pub in_plane: Vec<f32>,
    /// By theta_i and intervals of the azimuth: sigma of the two ends, then delta.
    pub widths: Vec<f32>,
    /// There are whitecaps.
    pub whitecaps: bool,
    /// `across = "slopes"`.
    pub slopes: bool,
}

/// Where a pair of directions lies in the fine grid.
struct Place<T> {
    /// Of the four rows about it, the first number of each and its weight.
    rows: [(usize, T); 4],
    /// In a row: the number of the first of two values, and how far towards the second.
    theta: (usize, T),
    /// theta_r and phi_r of Eq. 88 with the table's sign; sigma's factor of Eq. 89.
    phi: T,
    narrowing: T,
    outside: bool,
}

impl EmpiricalLobe {
    /// Of a sea that the table knows; others are refused as by [`Table::check`].
    pub fn new(water: &Water, table: &Table) -> Result<Self, Error> {
        let slice = table.slice(water)?;
        let reference = Reference::new(water);
        let slopes = water.parameters.across == Across::Slopes;
        let [incidences, thetas] = slice.ends().map(|ends| ends.map(|angle| (0.5 * angle).tan()));
        // A table for the vertical alone has a grid all the same.
        let incidences = [incidences[0], incidences[1].max(1e-3)];
        let half = |t: f64| 2.0 * t.atan();
        let theta = |k: usize| half(2.0 * k as f64 / THETAS as f64 - 1.0);
        let all: Vec<f64> = (0..=THETAS).map(|k| theta(k).clamp(-LOWEST, LOWEST)).collect();
        let rows: Vec<_> = (0..(INCIDENCES + 1) * (AZIMUTHS + 1))
            .into_par_iter()
            .map(|row| {
                let of_source = half(incidences[1] * (row / (AZIMUTHS + 1)) as f64 / INCIDENCES as f64);
                let azimuth = turn(2.0 * (row % (AZIMUTHS + 1)) as f64 / AZIMUTHS as f64);
                let (in_plane, widths) = slice.row(of_source, azimuth, &all);
                let reference = reference.turned(azimuth.to_degrees());
                let source = [-of_source.sin(), 0.0, of_source.cos()];
                let cells = in_plane.iter().zip(&all).map(|([ratio, whitecaps, square], theta)| {
                    let o = [theta.sin(), 0.0, theta.cos()];
                    let (closed, spread) = if slopes {
                        (reference.visible(source, o), 0.0)
                    } else {
                        (reference.in_plane(source, *theta), reference.ln_square(source, o))
                    };
                    [(ratio * closed).ln().max(NOTHING), *whitecaps, square + spread].map(|x| x as f32)
                });
                (cells.collect::<Vec<_>>(), widths.map(|x| x as f32))
            })
            .collect();
        let widths: Vec<[f32; 4]> = rows.iter().map(|(_, widths)| *widths).collect();
        let in_plane: Vec<[f32; 3]> = rows.into_iter().flat_map(|(cells, _)| cells).collect();
        let mut sampler = reference.lobe;
        // As many whitecaps as a source overhead meets.
        sampler.whitecap_fraction = f64::from(in_plane[THETAS / 2][1]);
        let slopes = slopes.then_some(reference);
        Ok(Self { sampler, slopes, incidences, thetas, in_plane, widths })
    }

    /// f, 1/sr (Eq. 90), for unit vectors to source and observer; 0 at or below the horizon.
    pub fn eval<T: Real>(&self, i: Vec3<T>, o: Vec3<T>) -> T {
        self.eval_parts(i, o, Parts::ALL)
    }

    /// f of some of its parts, 1/sr.
    #[inline]
    pub fn eval_parts<T: Real>(&self, i: Vec3<T>, o: Vec3<T>, parts: Parts) -> T {
        let zero = T::of(0.0);
        if !(zero.below(i[2]) && zero.below(o[2])) {
            return zero;
        }
        let place = self.place(i, o);
        let [level, whitecaps] = place.in_plane(&self.in_plane, |cell| [cell[0], cell[1]]);
        let mut f = zero;
        if parts.facets {
            f = if self.slopes.is_some() {
                T::of(self.closed(i, o)) * level.exp()
            } else {
                let [sigma, delta] = place.around(&self.widths, |cell| [cell[0], cell[2]]);
                let x = (place.phi - delta) / (sigma * place.narrowing);
                T::of(self.reflectance(i, o)) * (level - x * x).exp()
            };
        }
        if parts.whitecaps {
            f = f + T::of(self.sampler.whitecap_brdf) * whitecaps;
        }
        f
    }

    /// f with its standard uncertainty (Eqs. 90-91), for unit vectors to source and observer.
    pub fn estimate(&self, i: [f64; 3], o: [f64; 3]) -> Estimate {
        if i[2] <= 0.0 || o[2] <= 0.0 {
            return Estimate { mean: 0.0, std: 0.0, outside: false };
        }
        let place = self.place(i, o);
        let [level, whitecaps, square] = place.in_plane(&self.in_plane, |cell| *cell);
        let rho = self.reflectance(i, o);
        let brdf = |facets: f64, ln_square: f64| {
            let facets2 = facets * facets * ln_square.max(0.0).exp();
            Moments { facets, facets2, whitecaps }.brdf(rho, self.sampler.whitecap_brdf)
        };
        let [mean, std] = match &self.slopes {
            Some(reference) => {
                let facets = level.exp() * self.closed(i, o) / rho;
                brdf(facets, square + reference.ln_square(i, o))
            }
            None => {
                let [sigma, u_sigma, delta, u_delta] = place.around(&self.widths, |cell| *cell);
                let (sigma, u_sigma) = (sigma * place.narrowing, u_sigma * place.narrowing);
                let x = (place.phi - delta) / sigma;
                let facets = (level - x * x).exp();
                let [mean, std] = brdf(facets, square);
                // Of what facets reflect, by the spreads of the lobe's width and offset.
                let (wider, aside) = (2.0 * x * x * u_sigma / sigma, 2.0 * x * u_delta / sigma);
                [mean, std.hypot(rho * facets * wider.hypot(aside))]
            }
        };
        Estimate { mean, std, outside: place.outside }
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
            return Statistics { whitecap: 0.0, ..Statistics::of(values, limits) };
        }
        let place = self.place(i, o);
        let [level, whitecaps, square] = place.in_plane(&self.in_plane, |cell| *cell);
        let (rho, foam) = (self.reflectance(i, o), self.sampler.whitecap_brdf);
        let open = (1.0 - whitecaps).max(1e-6);
        // Where the lobe peaks: the mean of the facets' f over rho, and of its square over the squared mean.
        let (mean, square, lobe) = match &self.slopes {
            Some(reference) => {
                (level.exp() * self.closed(i, o) / rho, square + reference.ln_square(i, o), None)
            }
            None => {
                let [sigma, u_sigma, delta, u_delta] = place.around(&self.widths, |cell| *cell);
                let (sigma, u_sigma) = (sigma * place.narrowing, u_sigma * place.narrowing);
                let single = (sigma * sigma - 2.0 * u_delta * u_delta).max(0.04 * sigma * sigma).sqrt();
                (level.exp(), square, Some(([single, u_sigma], [place.phi - delta, u_delta])))
            }
        };
        let draw = |instance: u64| {
            let mut numbers = Numbers::new(Draws::Sobol, seed, instance);
            let chance = numbers.next();
            let [[height, wide], [aside, _]] = [(); 2].map(|()| normals(numbers.next(), numbers.next()));
            // Off the peak of its own lobe, and how far from that the mean's peak is.
            let falls = lobe.map(|([single, u_sigma], [off, u_delta])| {
                let sigma = (single + u_sigma * wide).max(0.2 * single);
                [off - u_delta * aside, -u_delta * aside].map(|x| (-(x / sigma).powi(2)).exp())
            });
            (chance < whitecaps, height, falls.unwrap_or([1.0; 2]))
        };
        let count = f64::from(draws.get());
        let all: Vec<_> = (0..u64::from(draws.get())).map(draw).collect();
        let [first, second] =
            [1, 2].map(|power| all.iter().map(|(_, _, falls)| falls[1].powi(power)).sum::<f64>() / count);
        let height = mean / (open * first.max(f64::MIN_POSITIVE));
        let spread =
            (square.max(0.0).exp() * open * first * first / second.max(f64::MIN_POSITIVE)).max(1.0).ln();
        for (value, (foamy, normal, falls)) in values.iter_mut().zip(&all) {
            let facets = || rho * height * (spread.sqrt() * normal - 0.5 * spread).exp() * falls[0];
            *value = if *foamy { foam } else { facets() };
        }
        let foamy = all.iter().filter(|(foamy, ..)| *foamy).count() as f64 / count;
        Statistics { whitecap: foamy, ..Statistics::of(values, limits) }
    }

    /// [`EmpiricalLobe::estimate`] for every observer of an engagement: directions are those from where its beam meets the mean surface
    /// (Eqs. 83, 86).
    pub fn estimates(&self, engagement: &Engagement) -> Vec<Estimate> {
        engagement.ways().map(|[i, o]| self.estimate(i, o)).collect()
    }

    fn reflectance<T: Real>(&self, i: Vec3<T>, o: Vec3<T>) -> f64 {
        let [i, o] = [i, o].map(|v| v.map(Real::to_f64));
        let half = 0.5 * (0..3).map(|k| (i[k] + o[k]).powi(2)).sum::<f64>().sqrt();
        self.sampler.facets.reflectance.eval(half.min(1.0))
    }

    fn closed<T: Real>(&self, i: Vec3<T>, o: Vec3<T>) -> f64 {
        self.sampler.facets.eval(i.map(Real::to_f64), o.map(Real::to_f64), up())
    }

    #[inline]
    fn place<T: Real>(&self, i: Vec3<T>, o: Vec3<T>) -> Place<T> {
        let [zero, one] = [0.0, 1.0].map(T::of);
        let facets = &self.sampler.facets;
        let [cos_wind, sin_wind] = [facets.cos_wind, facets.sin_wind].map(T::of);
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
            (0..=THETAS).flat_map(move |theta| {
                let at = |n: usize| rows.map(|row| self.in_plane[row * (THETAS + 1) + theta][n]);
                let shares = whitecaps.then(|| at(1));
                at(0).into_iter().chain(shares.into_iter().flatten())
            })
        });
        let widths = ends.clone().flat_map(|rows| [0, 2].map(|n| rows.map(|row| self.widths[row][n])));
        FineGrid {
            steps: [INCIDENCES as u32, AZIMUTHS as u32, THETAS as u32],
            incidence: self.incidences[1],
            in_plane: in_plane.collect(),
            widths: widths.flatten().collect(),
            whitecaps,
            slopes: self.slopes.is_some(),
        }
    }
}

/// Two independent normal deviates of two uniform ones (Box and Muller's).
fn normals(a: f64, b: f64) -> [f64; 2] {
    let (sin, cos) = (TAU * b).sin_cos();
    let radius = (-2.0 * (1.0 - a).ln()).sqrt();
    [radius * cos, radius * sin]
}

/// A place on an axis of so many steps: the step and how far along it.
fn split<T: Real>(x: T, steps: usize) -> (usize, T) {
    let k = (x.to_f64() as usize).min(steps - 1);
    (k, T::min(x - T::of(k as f64), T::of(1.0)))
}

/// The angle from 0 to pi for which this stands, from 0 to 2.
fn turn(around: f64) -> f64 {
    let cos = 1.0 - around;
    (1.0 - cos.abs()).atan2(cos)
}

impl<T: Real> Place<T> {
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
