//! Tables of the empirical model (section 9): what [`super::reference`] finds, over wind, footprint, angle of incidence
//! and the wind's azimuth; how they are made and how they are looked into.
//!
//! Between nodes the mean in the plane is interpolated as the logarithm of its ratio to what the same facets would reflect
//! on level water ([`Node::approximate`]), which changes slowly; the spread as the logarithm of the mean of f squared
//! over the square of the mean, beside that of Gaussian slopes.
//! Cubics with parabolic slopes at the nodes (Catmull and Rom's on even grids) do it along every axis: smooth, and
//! positive whatever is done.
//!
//! ```
//! use prob_water::table::{Grid, Plan};
//! use prob_water::{EmpiricalLobe, Parameters, Surface, Wind};
//!
//! # fn main() -> Result<(), prob_water::Error> {
//! // Switches, components, seed and instances of a table come from here; wind, footprint and angles from the grid.
//! let sea = Parameters { surface: Surface::Empirical, instances: 256, ..Parameters::default() };
//! let grid = Grid {
//!     friction_velocity: vec![6.0, 8.0],
//!     footprint: vec![0.15],
//!     incidence: vec![20.0, 40.0],
//!     wind_azimuth: vec![0.0, 90.0, 180.0],
//!     ..Grid::default()
//! };
//! let table = Plan::new(&sea, &grid)?.table()?;
//!
//! let water = Parameters { wind: Wind::FrictionVelocity(7.0), ..sea }.configure()?;
//! let lobe = EmpiricalLobe::new(&water, &table)?;
//! let [i, o] = [[-0.5, 0.0, 0.75f64.sqrt()], [0.5, 0.0, 0.75f64.sqrt()]];
//! let estimate = lobe.estimate(i, o);
//! assert!(estimate.mean > 0.1 && estimate.std > 0.0 && !estimate.outside);
//! # Ok(())
//! # }
//! ```

use super::reference::{Moments, Node, ReferenceModel};
use crate::config::parameters::MOST_INSTANCES;
use crate::config::vocabulary::{Builder, Value};
use crate::config::{Parameters, Surface, Water};
use crate::error::{Error, refuse};
use crate::sea::Wind;
use crate::statistics::level_water::BaselineLobe;
use rayon::prelude::*;

/// Numbers of a node beside those in the plane: sigma, u_sigma, delta, u_delta (radians) and the share of fits.
pub(crate) const WIDTHS: usize = 5;
/// Numbers of a node for every angle theta_r.
pub(crate) const IN_PLANE: usize = 4;
/// What a table is made with, unless told.
pub const INSTANCES: u64 = 8192;
/// More numbers than any table needs.
const MOST: usize = 1 << 28;
/// Digits that are kept, in bits: a relative error of 1.2e-4, less than any table's own.
const DIGITS: u32 = 12;
/// How much nodes at other incidences are looked into along with the lobe: a power of cos theta_r.
const SHIFT: i32 = 2;
/// Ratios to what level water would reflect are between these.
const RATIOS: [f64; 2] = [1e-3, 1e3];

/// Where a table has its nodes, each list rising.
#[derive(Debug, Clone, PartialEq)]
pub struct Grid {
    /// w*, cm/s.
    pub friction_velocity: Vec<f64>,
    /// D, m.
    pub footprint: Vec<f64>,
    /// theta_i, degrees.
    pub incidence: Vec<f64>,
    /// The azimuth the wind comes from, counted from the plane of incidence, away from the source; degrees from 0 to 180
    /// (the other half mirrors it), or a single one for all.
    pub wind_azimuth: Vec<f64>,
    /// theta_r, degrees, within the horizons.
    pub theta_r: Vec<f64>,
}

impl Default for Grid {
    /// That of the table which comes with the crate.
    fn default() -> Self {
        Self {
            friction_velocity: geometric(2.0, 62.9, 15),
            footprint: geometric(0.02, 1.0, 6),
            incidence: [0, 10, 20, 30, 40, 50, 58, 65, 71, 76, 81, 85].map(f64::from).into(),
            wind_azimuth: (0..=8).map(|k| 22.5 * f64::from(k)).collect(),
            theta_r: (-22..=20).map(|k| 4.0 * f64::from(k)).chain([82.0, 84.0, 86.0, 88.0]).collect(),
        }
    }
}

/// So many numbers from one to another, each by the same factor larger, to four digits.
pub fn geometric(first: f64, last: f64, count: u32) -> Vec<f64> {
    let steps = f64::from(count.max(2) - 1);
    let digits = |x: f64| format!("{x:.3e}").parse().expect("a number's own text");
    let between = |k: u32| match k {
        0 => first,
        k if k + 1 == count => last,
        k => digits(first * (last / first).powf(f64::from(k) / steps)),
    };
    (0..count).map(between).collect()
}

impl Grid {
    /// The lists by name, in the order in which they vary, with what each may hold.
    pub(crate) fn axes(&self) -> [(&'static str, &[f64], [f64; 2]); 5] {
        [
            ("friction_velocity", &self.friction_velocity, [0.1, 238.65]),
            ("footprint", &self.footprint, [1e-3, 1e3]),
            ("incidence", &self.incidence, [0.0, 89.0]),
            ("wind_azimuth", &self.wind_azimuth, [0.0, 180.0]),
            ("theta_r", &self.theta_r, [-89.9, 89.9]),
        ]
    }

    /// How many there are of each.
    pub fn shape(&self) -> [usize; 5] {
        self.axes().map(|(_, axis, _)| axis.len())
    }

    pub(crate) fn check(&self) -> Result<(), Error> {
        for (name, axis, [low, high]) in self.axes() {
            let allowed = || format!("rising numbers from {low} to {high}, at least one");
            let rising = axis.windows(2).all(|pair| pair[0] < pair[1]);
            if !(rising && axis.first().is_some_and(|x| *x >= low) && axis.last().is_some_and(|x| *x <= high))
            {
                return refuse(name, format!("{axis:?}"), allowed());
            }
        }
        let around = &self.wind_azimuth;
        if around.len() > 1 && (around[0], around[around.len() - 1]) != (0.0, 180.0) {
            return refuse("wind_azimuth", format!("{around:?}"), "from 0 to 180 degrees, or a single one");
        }
        if self.theta_r.len() < 4 {
            return refuse("theta_r", format!("{:?}", self.theta_r), "at least 4 angles");
        }
        let count = self.shape().iter().try_fold(1usize, |n, length| n.checked_mul(*length));
        match count.filter(|n| *n <= MOST) {
            Some(_) => Ok(()),
            None => refuse("theta_r", format!("{:?} nodes", self.shape()), format!("at most {MOST} in all")),
        }
    }
}

/// A table to be made, row by row: a row is a wind, a footprint and an angle of incidence. What is in a row depends on the
/// plan alone, not on when, where and after which others it is made.
#[derive(Debug, Clone)]
pub struct Plan {
    parameters: Parameters,
    grid: Grid,
}

impl Plan {
    /// Of a sea's switches, components, seed and instances, on a grid. Its wind and footprint do not matter.
    pub fn new(parameters: &Parameters, grid: &Grid) -> Result<Self, Error> {
        grid.check()?;
        let plan = Self { parameters: kept(|name| parameters.get(name))?, grid: grid.clone() };
        if !(1..=MOST_INSTANCES / 1000).contains(&parameters.instances) {
            return refuse("instances", parameters.instances, "1 to 1000000 for a table");
        }
        // What a node is refused for, the finest footprint under the strongest wind is.
        let last = |axis: &[f64]| axis[axis.len() - 1];
        ReferenceModel::new(&plan.sea(last(&grid.friction_velocity), grid.footprint[0])?)?;
        Ok(plan)
    }

    /// How many rows there are.
    pub fn rows(&self) -> usize {
        self.grid.shape()[..3].iter().product()
    }

    /// How many numbers a row has.
    pub fn row_len(&self) -> usize {
        self.grid.wind_azimuth.len() * (WIDTHS + IN_PLANE * self.grid.theta_r.len())
    }

    fn sea(&self, friction_velocity: f64, footprint: f64) -> Result<Water, Error> {
        let wind = Wind::FrictionVelocity(friction_velocity);
        let surface = Surface::Empirical;
        let footprint = Some(footprint);
        Parameters { wind, footprint, surface, wind_direction: 0.0, time: 0.0, ..self.parameters }.configure()
    }

    /// The numbers of a row: for every azimuth the [`WIDTHS`], and mean, standard deviation, whitecaps and what
    /// approximates the mean of all theta_r.
    pub fn row(&self, row: usize) -> Result<Vec<f32>, Error> {
        let [_, footprints, incidences, ..] = self.grid.shape();
        let g = &self.grid;
        let incidence = g.incidence[row % incidences].to_radians();
        let footprint = g.footprint[row / incidences % footprints];
        let full =
            ReferenceModel::new(&self.sea(g.friction_velocity[row / incidences / footprints], footprint)?)?;
        let thetas: Vec<f64> = g.theta_r.iter().map(|theta| theta.to_radians()).collect();
        let nodes: Vec<Node> = g
            .wind_azimuth
            .par_iter()
            .map(|azimuth| full.turned(*azimuth).node(incidence, &thetas))
            .collect::<Result<_, _>>()?;
        let mut numbers = Vec::with_capacity(self.row_len());
        for node in &nodes {
            numbers.extend([node.sigma, node.u_sigma, node.delta, node.u_delta, node.fitted]);
            numbers.extend(node.in_plane.iter().map(|m| m.facets));
            numbers.extend(node.in_plane.iter().map(|m| (m.facets2 - m.facets * m.facets).max(0.0).sqrt()));
            numbers.extend(node.in_plane.iter().map(|m| m.whitecaps));
            numbers.extend(&node.approximate);
        }
        Ok(numbers.into_iter().map(rounded).collect())
    }

    /// The table of all rows, in their order.
    pub fn assemble(&self, rows: &[Vec<f32>]) -> Result<Table, Error> {
        if rows.len() != self.rows() {
            return Err(Error::Length { what: "the table", found: rows.len(), expected: self.rows() });
        }
        let thetas = self.grid.theta_r.len();
        let mut table = Table {
            version: env!("CARGO_PKG_VERSION").into(),
            parameters: self.parameters,
            grid: self.grid.clone(),
            in_plane: std::array::from_fn(|_| vec![]),
            widths: std::array::from_fn(|_| vec![]),
        };
        for node in rows.iter().flat_map(|row| row.chunks(WIDTHS + IN_PLANE * thetas)) {
            let (widths, in_plane) = node.split_at(WIDTHS);
            table.widths.iter_mut().zip(widths).for_each(|(all, x)| all.push(*x));
            table.in_plane.iter_mut().zip(in_plane.chunks(thetas)).for_each(|(all, xs)| all.extend(xs));
        }
        Ok(table)
    }

    /// Makes all rows, on all cores.
    pub fn table(&self) -> Result<Table, Error> {
        let rows =
            (0..self.rows()).into_par_iter().map(|row| self.row(row)).collect::<Result<Vec<_>, _>>()?;
        self.assemble(&rows)
    }
}

/// To float32, and to [`DIGITS`], so that files become small.
fn rounded(x: f64) -> f32 {
    let drop = 23 - DIGITS;
    let bits = (x as f32).to_bits();
    let half = 1 << (drop - 1);
    let kept = f32::from_bits((bits + half) & !((1 << drop) - 1));
    if kept.is_finite() { kept } else { x as f32 }
}

/// A table of the empirical model.
#[derive(Debug, Clone, PartialEq)]
pub struct Table {
    /// Version of this crate that made it.
    pub version: String,
    /// What it was made with; the wind, the footprint and the angles are the grid's.
    pub parameters: Parameters,
    /// Where its nodes are.
    pub grid: Grid,
    /// Mean and standard deviation of the facets' f over rho, 1/sr, the share of whitecaps, and what approximates the mean
    /// ([`Node::approximate`]), by friction velocity, footprint, incidence, azimuth and theta_r.
    pub in_plane: [Vec<f32>; IN_PLANE],
    /// sigma(0), u_sigma, delta, u_delta, radians, and the share of surfaces whose lobe could be fitted, by friction
    /// velocity, footprint, incidence and azimuth.
    pub widths: [Vec<f32>; WIDTHS],
}

/// What a table says for a wind and a footprint, by incidence, azimuth and theta_r.
#[derive(Debug, Clone)]
pub(crate) struct Slice {
    incidence: Vec<f64>,
    azimuth: Vec<f64>,
    theta: Vec<f64>,
    /// Logarithm of the mean over what approximates it, fourth root of the share of whitecaps, and logarithm of the mean
    /// square over the squared mean, less that of Gaussian slopes.
    in_plane: Vec<[f64; 3]>,
    /// sigma, u_sigma, delta, u_delta.
    widths: Vec<[f64; 4]>,
}

/// Parameters that a table has only one value of.
pub(crate) const SHARED: [&str; 14] = [
    "spectrum",
    "slopes",
    "slope_budget",
    "components",
    "depth",
    "fetch",
    "water",
    "slope_measure",
    "readings",
    "whitecaps",
    "whitecap_onset",
    "shadowing",
    "hiding",
    "gram_charlier",
];

/// Those of them that were added later: a file tells them where they are not the defaults.
pub(crate) const ADDED: [&str; 4] = ["spectrum", "slopes", "slope_budget", "hiding"];

/// What else it was made with: how many points were drawn and which, and of which water the reflectance was that its numbers do
/// not have.
pub(crate) const MADE_WITH: [&str; 8] =
    ["instances", "seed", "wavelength", "ior", "extinction", "temperature", "salinity", "fresnel"];

/// The parameters that a table tells, by name; the others have no part in it.
pub(crate) fn kept(value: impl Fn(&str) -> Option<Value>) -> Result<Parameters, Error> {
    let mut builder = Builder::on(Surface::Empirical);
    for name in SHARED.iter().chain(&MADE_WITH) {
        if let Some(value) = value(name) {
            builder.set(name, &value)?;
        }
    }
    builder.parameters()
}

impl Table {
    /// A node, with its angles theta_r, in radians.
    pub fn node(&self, [w, d, incidence, azimuth]: [usize; 4]) -> Node {
        let [_, footprints, incidences, azimuths, thetas] = self.grid.shape();
        let at = ((w * footprints + d) * incidences + incidence) * azimuths + azimuth;
        let [mean, std, whitecaps, approximate] =
            self.in_plane.each_ref().map(|all| &all[at * thetas..(at + 1) * thetas]);
        let moments = |k: usize| {
            let facets = f64::from(mean[k]);
            let facets2 = facets * facets + f64::from(std[k]).powi(2);
            Moments { facets, facets2, whitecaps: f64::from(whitecaps[k]) }
        };
        let [sigma, u_sigma, delta, u_delta, fitted] = self.widths.each_ref().map(|all| f64::from(all[at]));
        let approximate = approximate.iter().map(|x| f64::from(*x)).collect();
        Node {
            in_plane: (0..thetas).map(moments).collect(),
            approximate,
            sigma,
            u_sigma,
            delta,
            u_delta,
            fitted,
        }
    }

    /// Refuses a sea that the table does not know: other switches, or a wind or a footprint outside of its grid.
    pub fn check(&self, water: &Water) -> Result<(), Error> {
        for name in SHARED {
            let [found, known] = [&water.parameters, &self.parameters].map(|p| p.get(name));
            if found != known {
                let text = |value: Option<Value>| value.map_or(String::new(), |v| v.to_string());
                return refuse(name, text(found), format!("{}, what the table was made with", text(known)));
            }
        }
        let p = &water.parameters;
        let within = |name: &'static str, shown: String, x: f64, axis: &[f64], unit: &str| {
            let [low, high] = [axis[0], axis[axis.len() - 1]];
            // A wind speed becomes a friction velocity by way of a root.
            if (low * (1.0 - 1e-9)..=high * (1.0 + 1e-9)).contains(&x) {
                return Ok(());
            }
            refuse(name, shown, format!("{low} to {high} {unit}, the table's"))
        };
        let w = water.wind.friction_velocity;
        let (name, shown) = match p.wind {
            Wind::FrictionVelocity(_) => ("friction_velocity", w.to_string()),
            Wind::Speed { speed, .. } => ("wind_speed", format!("{speed} (friction velocity {w:.3} cm/s)")),
            Wind::Beaufort(b) => ("beaufort", format!("{b} (friction velocity {w:.3} cm/s)")),
        };
        within(name, shown, w, &self.grid.friction_velocity, "cm/s")?;
        within("footprint", water.footprint.to_string(), water.footprint, &self.grid.footprint, "m")
    }

    /// The table at the wind and the footprint of a sea that it knows.
    pub(crate) fn slice(&self, water: &Water) -> Result<Slice, Error> {
        self.check(water)?;
        let g = &self.grid;
        let ln = |axis: &[f64]| axis.iter().map(|x| x.ln()).collect::<Vec<_>>();
        let (w, d) = (water.wind.friction_velocity, water.footprint);
        let plan = Plan { parameters: self.parameters, grid: g.clone() };
        let mut parts = vec![];
        for (a, wa) in weights(&ln(&g.friction_velocity), w.ln()) {
            for (b, wb) in weights(&ln(&g.footprint), d.ln()) {
                if wa * wb != 0.0 {
                    let sea = plan.sea(g.friction_velocity[a], g.footprint[b])?;
                    parts.push((wa * wb, [a, b], BaselineLobe::new(&sea)));
                }
            }
        }
        let [.., incidences, azimuths, thetas] = g.shape();
        let radians = |axis: &[f64]| axis.iter().map(|x| x.to_radians()).collect::<Vec<_>>();
        let (incidence, theta) = (radians(&g.incidence), radians(&g.theta_r));
        let nodes: Vec<(Vec<[f64; 3]>, [f64; 4])> = (0..incidences * azimuths)
            .into_par_iter()
            .map(|n| {
                let (i, a) = (n / azimuths, n % azimuths);
                let (sin, cos) = incidence[i].sin_cos();
                let mut in_plane = vec![[0.0; 3]; thetas];
                let mut widths = [0.0; 4];
                for (weight, [w, d], baseline) in &parts {
                    let baseline = baseline.turned(g.wind_azimuth[a]);
                    let node = self.node([*w, *d, i, a]);
                    for (k, sums) in in_plane.iter_mut().enumerate() {
                        let (m, near) = (&node.in_plane[k], node.approximate[k]);
                        // Where both have faded the ratio is not known, and does not matter.
                        let ratio =
                            if near > 0.0 { (m.facets / near).clamp(RATIOS[0], RATIOS[1]) } else { 1.0 };
                        let square = if m.facets > 0.0 { m.facets2 / (m.facets * m.facets) } else { 1.0 };
                        let gaussian =
                            baseline.ln_square([-sin, 0.0, cos], [theta[k].sin(), 0.0, theta[k].cos()]);
                        sums[0] += weight * ratio.ln();
                        sums[1] += weight * m.whitecaps.max(0.0).sqrt().sqrt();
                        sums[2] += weight * (square.max(1.0).ln() - gaussian);
                    }
                    let fitted = [node.sigma, node.u_sigma, node.delta, node.u_delta];
                    widths.iter_mut().zip(fitted).for_each(|(sum, x)| *sum += weight * x);
                }
                (in_plane, widths)
            })
            .collect();
        Ok(Slice {
            incidence,
            azimuth: radians(&g.wind_azimuth),
            theta,
            widths: nodes.iter().map(|(_, widths)| *widths).collect(),
            in_plane: nodes.into_iter().flat_map(|(in_plane, _)| in_plane).collect(),
        })
    }
}

impl Slice {
    /// The angles of incidence and theta_r between which there are nodes, radians.
    pub fn ends(&self) -> [[f64; 2]; 2] {
        [&self.incidence, &self.theta].map(|axis| [axis[0], axis[axis.len() - 1]])
    }

    /// For an incidence and an azimuth of the wind, radians: ratios to what approximates the mean, shares of whitecaps
    /// and logarithms of the mean square over the squared mean, less that of Gaussian slopes, at angles theta_r; and sigma, u_sigma,
    /// delta and u_delta.
    pub fn row(&self, incidence: f64, azimuth: f64, thetas: &[f64]) -> (Vec<[f64; 3]>, [f64; 4]) {
        let (count, azimuths) = (self.theta.len(), self.azimuth.len());
        let mut row = vec![[0.0; 3]; thetas.len()];
        let mut widths = [0.0; 4];
        let mut nodes = vec![[0.0; 3]; count];
        for (i, wi) in weights(&self.incidence, incidence) {
            if wi == 0.0 {
                continue;
            }
            nodes.fill([0.0; 3]);
            for (a, wa) in weights_around(&self.azimuth, azimuth) {
                let at = i * azimuths + a;
                for (sums, node) in nodes.iter_mut().zip(&self.in_plane[at * count..]) {
                    sums.iter_mut().zip(node).for_each(|(sum, x)| *sum += wa * x);
                }
                widths.iter_mut().zip(self.widths[at]).for_each(|(sum, x)| *sum += wi * wa * x);
            }
            for (sums, theta) in row.iter_mut().zip(thetas) {
                // The lobe moves with the specular direction, what waves hide stays at the horizon.
                let theta = theta + (self.incidence[i] - incidence) * theta.cos().powi(SHIFT);
                for (t, weight) in weights(&self.theta, theta) {
                    sums.iter_mut().zip(nodes[t]).for_each(|(sum, x)| *sum += wi * weight * x);
                }
            }
        }
        for [ratio, whitecaps, _] in &mut row {
            *ratio = ratio.exp().clamp(RATIOS[0], RATIOS[1]);
            *whitecaps = whitecaps.max(0.0).powi(4).min(1.0);
        }
        let [sigma, u_sigma, delta, u_delta] = widths;
        (row, [sigma.max(1e-4), u_sigma.max(0.0), delta, u_delta.max(0.0)])
    }
}

/// Of four nodes of a rising axis their weights in a cubic with parabolic slopes at the nodes; beyond the axis its ends.
fn weights(axis: &[f64], x: f64) -> [(usize, f64); 4] {
    let last = axis.len() - 1;
    if last == 0 {
        return [(0, 1.0), (0, 0.0), (0, 0.0), (0, 0.0)];
    }
    let x = x.clamp(axis[0], axis[last]);
    let k = axis.partition_point(|node| *node <= x).clamp(1, last) - 1;
    let before = k.checked_sub(1).map(|k| axis[k]);
    let w = hermite([before, Some(axis[k]), Some(axis[k + 1]), axis.get(k + 2).copied()], x);
    [(k.max(1) - 1, w[0]), (k, w[1]), (k + 1, w[2]), ((k + 2).min(last), w[3])]
}

/// The same on an axis from 0 to pi whose other half mirrors it.
fn weights_around(axis: &[f64], x: f64) -> [(usize, f64); 4] {
    let last = axis.len() - 1;
    if last == 0 {
        return weights(axis, x);
    }
    let x = x.clamp(axis[0], axis[last]);
    let k = axis.partition_point(|node| *node <= x).clamp(1, last) - 1;
    let (before, first) = if k == 0 { (1, -axis[1]) } else { (k - 1, axis[k - 1]) };
    let (after, end) =
        if k + 2 > last { (last - 1, 2.0 * axis[last] - axis[last - 1]) } else { (k + 2, axis[k + 2]) };
    let w = hermite([Some(first), Some(axis[k]), Some(axis[k + 1]), Some(end)], x);
    [(before, w[0]), (k, w[1]), (k + 1, w[2]), (after, w[3])]
}

/// Hermite's cubic between the second and the third node, its slopes those of the parabolas through each and its
/// neighbours (of the one parabola there is where one is missing).
fn hermite(nodes: [Option<f64>; 4], x: f64) -> [f64; 4] {
    let [before, first, second, after] = nodes;
    let (first, second) = (first.unwrap_or_default(), second.unwrap_or_default());
    let h = second - first;
    let t = (x - first) / h;
    let (rise_first, rise_second) = (t * (1.0 - t) * (1.0 - t) * h, -t * t * (1.0 - t) * h);
    let level = t * t * (3.0 - 2.0 * t);
    let mut w = [0.0, 1.0 - level, level, 0.0];
    // Slope at the middle one of three nodes, or at an end, by their weights.
    let slope = |x: [f64; 3], at: f64| {
        let over = |a: usize, b: usize, c: usize| (2.0 * at - x[b] - x[c]) / ((x[a] - x[b]) * (x[a] - x[c]));
        [over(0, 1, 2), over(1, 0, 2), over(2, 0, 1)]
    };
    let mut add = |rise: f64, at: f64, left: bool| {
        let three = match (before, after) {
            (Some(a), _) if left || after.is_none() => Some((0, [a, first, second])),
            (_, Some(b)) => Some((1, [first, second, b])),
            _ => None,
        };
        match three {
            Some((start, x)) => {
                slope(x, at).iter().enumerate().for_each(|(k, s)| w[start + k] += rise * s);
            }
            None => {
                w[1] -= rise / h;
                w[2] += rise / h;
            }
        }
    };
    add(rise_first, first, true);
    add(rise_second, second, false);
    w
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::vocabulary;

    /// Parabolas come out exact, inside and in the intervals at the ends; nodes are met.
    #[test]
    fn cubics_follow_parabolas() {
        let axis = [0.0, 1.0, 1.5, 3.0, 3.5];
        for k in 0..=35 {
            let x = 0.1 * f64::from(k);
            let at =
                |f: &dyn Fn(f64) -> f64| weights(&axis, x).iter().map(|(n, w)| w * f(axis[*n])).sum::<f64>();
            for f in [|_: f64| 1.0, |x: f64| x, |x: f64| x * x - 2.0 * x] {
                assert!((at(&f) - f(x)).abs() < 1e-12, "{x}");
            }
        }
        for (n, x) in axis.iter().enumerate() {
            let met: f64 = weights(&axis, *x).iter().filter(|(k, _)| *k == n).map(|(_, w)| w).sum();
            assert!((met - 1.0).abs() < 1e-12);
        }
        assert_eq!(weights(&[4.0], 7.0)[0], (0, 1.0));
        let line: f64 = weights(&[1.0, 2.0], 1.25).iter().map(|(n, w)| w * *n as f64).sum();
        assert!((line - 0.25).abs() < 1e-12);
    }

    #[test]
    fn azimuths_are_mirrored() {
        let axis: Vec<f64> = (0..=8).map(|k| (22.5 * f64::from(k)).to_radians()).collect();
        for k in 0..=180 {
            let x = f64::from(k).to_radians();
            let sum: f64 = weights_around(&axis, x).iter().map(|(n, w)| w * (2.0 * axis[*n]).cos()).sum();
            assert!((sum - (2.0 * x).cos()).abs() < 0.03, "{k}: {sum}");
        }
        // Level at both ends.
        let slope = |x: f64| weights_around(&axis, x).iter().map(|(n, w)| w * axis[*n].cos()).sum::<f64>();
        assert!((slope(0.0) - slope(1e-4)).abs() < 1e-7);
    }

    #[test]
    fn grids_are_checked() {
        let sea = Parameters { surface: Surface::Empirical, ..Parameters::default() };
        let good = Grid { friction_velocity: vec![8.0], footprint: vec![0.15], ..Grid::default() };
        assert!(Plan::new(&sea, &good).is_ok());
        for (name, grid) in [
            ("friction_velocity", Grid { friction_velocity: vec![], ..good.clone() }),
            ("friction_velocity", Grid { friction_velocity: vec![8.0, 300.0], ..good.clone() }),
            ("footprint", Grid { footprint: vec![0.2, 0.1], ..good.clone() }),
            ("footprint", Grid { footprint: vec![f64::NAN], ..good.clone() }),
            ("incidence", Grid { incidence: vec![0.0, 90.0], ..good.clone() }),
            ("wind_azimuth", Grid { wind_azimuth: vec![0.0, 90.0], ..good.clone() }),
            ("theta_r", Grid { theta_r: vec![0.0, 10.0, 20.0], ..good.clone() }),
        ] {
            let error = Plan::new(&sea, &grid).unwrap_err();
            assert_eq!(error.parameters(), [name], "{error}");
        }
        let none = Parameters { instances: 2_000_000, ..sea };
        assert_eq!(Plan::new(&none, &good).unwrap_err().parameters(), ["instances"]);
    }

    /// A table's sea is compared by every parameter, but for those of its axes, what does not change its numbers and what may
    /// differ knowingly. A new parameter needs a decision.
    #[test]
    fn every_parameter_is_compared_or_known_to_differ() {
        const AXES: [&str; 3] = ["wind_direction", "footprint", "footprint_measure"];
        const WITHOUT_EFFECT: [&str; 4] = ["surface", "average", "across", "time"];
        // Refused with surface = empirical.
        const DRAWN: [&str; 4] = ["whitecap_lifetime", "swell_height", "swell_period", "swell_direction"];
        for entry in vocabulary::ENTRIES {
            let lists = [&SHARED[..], &MADE_WITH, &vocabulary::WIND, &AXES, &WITHOUT_EFFECT, &DRAWN];
            let count = lists.iter().filter(|list| list.contains(&entry.name)).count();
            assert_eq!(count, 1, "{}", entry.name);
        }
    }

    #[test]
    fn rounding_keeps_twelve_bits() {
        for x in [1.0f64, 0.1, 3.3e-5, 1234.567, 1e-30] {
            let y = f64::from(rounded(x));
            assert!((y / x - 1.0).abs() < 1.3e-4);
            assert_eq!((y as f32).to_bits() & 0x7ff, 0);
        }
        assert_eq!(rounded(0.0), 0.0);
        assert!(rounded(3.4e38).is_finite());
    }
}
