//! The density of the slope of a drawn surface, and the share of it under whitecaps, as tables.
//!
//! The components of a surface are drawn independently and alike: the characteristic function of their sum is that of one
//! to the power M, and the density its inverse transform. With the acceleration as a third dimension the same gives W(s),
//! the density times the probability of a whitecap (Eq. 53) at that slope. Slopes have a part upwind and one
//! crosswind; everything is even in both.

use super::breaking::{Resolution, sum_of_accelerations, weights};
use super::characteristic::Component;
use crate::brdf::shadowing::cos_lambda;
use crate::config::Water;
use crate::error::{Error, refuse};
use crate::readings::Readings;
use glam::DVec2;
use rayon::prelude::*;
use std::f64::consts::{PI, SQRT_2, TAU};

/// Fewest components whose slope has a density smooth enough for a table.
const FEWEST_COMPONENTS: u32 = 4;
/// Densities are tabulated to so many standard deviations, in steps of at most this many.
const END: f64 = 8.5;
const STEP: f64 = 0.125;
/// The facets' lobe blurs what it is multiplied with: frequencies fade out between so many over its standard
/// deviation (or the drawn slopes', if that is less), or end where the characteristic function has become this small.
const FADE: [f64; 2] = [4.0, 14.0];
const NEGLIGIBLE: f64 = 1e-6;
/// Below this, frequencies need not be resolved by who integrates over the density.
const FAINT: f64 = 3e-4;
/// Whitecaps rarer than this are left out.
const RARE: f64 = 1e-5;
/// A standard deviation of the acceleration, m/s^2, so small that there is none.
const STILL: f64 = 1e-6;
/// Accelerations for a table.
const TABULATED: Resolution = Resolution { end: 7.0, highest: 10.0, negligible: NEGLIGIBLE };
/// Most frequencies and most slopes on an axis: up to there tables take a second.
const MOST: [usize; 2] = [800, 2400];
/// Integrals reach to so many standard deviations of the facets' lobe, and of its product with the drawn slopes', in
/// steps that resolve the density's frequencies together with the lobe's to so many over its standard deviation.
const LOBE_END: f64 = 4.5;
const PRODUCT_END: f64 = 5.0;
const LOBE_FREQUENCY: f64 = 4.5;
/// Points for distributions.
const POINTS: u32 = 8192;

/// Horizontal vectors in components upwind and crosswind.
#[derive(Debug, Clone, Copy)]
pub(crate) struct WindFrame(DVec2);

impl WindFrame {
    /// Of a wind from an azimuth in radians.
    pub fn new(azimuth: f64) -> Self {
        Self(DVec2::from_angle(azimuth))
    }

    /// The components of a vector in x and y.
    pub fn to_wind(self, v: DVec2) -> DVec2 {
        DVec2::new(v.dot(self.0), v.dot(self.0.perp()))
    }

    /// Back from [`WindFrame::to_wind`].
    pub fn to_world(self, v: DVec2) -> DVec2 {
        v.x * self.0 + v.y * self.0.perp()
    }
}

/// The slopes of a drawn surface.
#[derive(Debug, Clone)]
pub(crate) struct Slopes {
    /// Standard deviations upwind and crosswind.
    pub sigma: DVec2,
    /// Frequencies from which on the density has next to none.
    pub frequency: DVec2,
    /// p.
    pub density: SlopeTable,
    /// W; `None` where whitecaps are off or too rare to matter.
    pub whitecap_density: Option<SlopeTable>,
}

impl Slopes {
    /// The slopes of a sea's waves; refused where they are too few, where the facets are so much finer that tables would
    /// be huge, and with Eq. 70 as printed, by which facets do not move with the waves.
    pub fn new(component: &Component, water: &Water) -> Result<Self, Error> {
        if water.parameters.components < FEWEST_COMPONENTS {
            return Err(Error::OutOfRange {
                parameter: "components",
                value: water.parameters.components.to_string(),
                allowed: format!("at least {FEWEST_COMPONENTS} for the density of their slopes"),
            });
        }
        let readings = water.parameters.readings;
        if readings.contains(Readings::EQ_70) {
            return refuse("readings", readings, "without 70 where no waves are drawn one by one");
        }
        let components = f64::from(water.parameters.components);
        let [u, c, _] = component.variances(components).map(f64::sqrt);
        let [bound_u, bound_c, _] = component.bounds(components);
        let facets = &water.lobe.facets;
        let upwind = Axis::new(u, bound_u, facets.sigma_u, components, |q| component.slope(q, &[0.0]));
        let crosswind = Axis::new(c, bound_c, facets.sigma_c, components, |q| component.slope(&[0.0], q));
        let (Some(upwind), Some(crosswind)) = (upwind, crosswind) else {
            return Err(Error::OutOfRange {
                parameter: "footprint",
                value: water.footprint.to_string(),
                allowed: format!(
                    "one whose facets are not so much finer than the drawn slopes \
                     (standard deviations upwind {:.2e} and {u:.2e}); more components help too",
                    facets.sigma_u
                ),
            });
        };
        let transform = |mut spectrum: Vec<f64>, [along, across]: [usize; 2]| {
            let frequencies = [&upwind.frequencies[..along], &crosswind.frequencies[..across]];
            for (row, u) in spectrum.chunks_mut(across).zip(frequencies[0]) {
                for (value, c) in row.iter_mut().zip(frequencies[1]) {
                    *value *= fade(u * upwind.finest) * fade(c * crosswind.finest);
                }
            }
            let (steps, counts) = ([upwind.step, crosswind.step], [upwind.count, crosswind.count]);
            SlopeTable::transform(&spectrum, frequencies, steps, counts)
        };
        let all = [upwind.frequencies.len(), crosswind.frequencies.len()];
        let density = component.slope(&upwind.frequencies, &crosswind.frequencies);
        let density = density.into_iter().map(|c| c.powi(components as i32)).collect();
        // Whitecaps are a small part of the whole: they need fewer frequencies.
        let few = [upwind.resolved, crosswind.resolved];
        let whitecap_density =
            caps(component, water, &upwind.frequencies[..few[0]], &crosswind.frequencies[..few[1]]);
        Ok(Self {
            sigma: DVec2::new(u, c),
            frequency: DVec2::new(upwind.end(), crosswind.end()),
            density: transform(density, all),
            whitecap_density: whitecap_density.map(|spectrum| transform(spectrum, few)),
        })
    }

    /// Where the tables end.
    pub fn end(&self) -> DVec2 {
        let [u, c] = [0, 1].map(|axis| self.density.counts[axis] as f64 * self.density.steps[axis]);
        DVec2::new(u, c)
    }

    /// Standard deviation of the slope along a horizontal vector upwind and crosswind, times its length.
    pub fn deviation(&self, along: DVec2) -> f64 {
        (self.sigma * along).length()
    }

    /// Whether no slope in the tables turns from a direction, given by its horizontal part upwind and crosswind and its
    /// height.
    pub fn all_face(&self, horizontal: DVec2, height: f64) -> bool {
        height > END * self.deviation(horizontal)
    }

    /// Smith's term (Eq. 66) for a direction, given by its horizontal part upwind and crosswind and its height.
    pub fn lambda(&self, horizontal: DVec2, height: f64) -> f64 {
        let height = height.max(1e-9);
        cos_lambda(height, SQRT_2 * self.deviation(horizontal)) / height
    }

    /// The rectangle in which the drawn slopes and a lobe of facets, about a slope and so wide, meet.
    pub fn meeting(&self, about: DVec2, lobe: DVec2) -> Option<(DVec2, DVec2)> {
        // Were both Gaussian, their product would be one about here.
        let (drawn, needed) = (1.0 / (self.sigma * self.sigma), 1.0 / (lobe * lobe));
        let (middle, both) = (about * needed / (drawn + needed), (drawn + needed).powf(-0.5));
        let low = (middle - PRODUCT_END * both).min(about - LOBE_END * lobe).max(-self.end());
        let high = (middle + PRODUCT_END * both).max(about + LOBE_END * lobe).min(self.end());
        (low.x < high.x && low.y < high.y).then_some((low, high))
    }

    /// Steps that resolve the density together with a lobe of facets.
    pub fn step(&self, lobe: DVec2) -> DVec2 {
        TAU / (self.frequency + LOBE_FREQUENCY / lobe)
    }

    /// Density and W at a slope upwind and crosswind.
    #[inline]
    pub fn at(&self, slope: DVec2) -> (f64, f64) {
        (
            self.density.at(slope.into()),
            self.whitecap_density.as_ref().map_or(0.0, |table| table.at(slope.into())),
        )
    }

    /// Evenly spread points, of which sums are integrals over the slopes: half of them Gaussian as wide as the slopes and
    /// half four times as dense about 0, where few waves of many sizes often leave the surface.
    pub fn points(&self) -> Vec<Point> {
        const WIDTHS: [f64; 2] = [1.2, 0.3];
        // The steps of Roberts' sequence: powers of the root of x^3 = x + 1.
        const STEPS: [f64; 2] = [0.754_877_666_246_692_7, 0.569_840_290_998_053_3];
        let gauss = |r2: f64, width: f64| (-0.5 * r2 / (width * width)).exp() / (TAU * width * width);
        let point = |n: u32| {
            let [a, b] = STEPS.map(|step| (0.5 + step * f64::from(n)).fract());
            let width = WIDTHS[(n % 2) as usize];
            let place = DVec2::from_angle(TAU * b) * width * (-2.0 * (1.0 - a).ln()).sqrt();
            let r2 = place.length_squared();
            let crowd = 0.5 * (gauss(r2, WIDTHS[0]) + gauss(r2, WIDTHS[1])) / (self.sigma.x * self.sigma.y);
            let slope = place * self.sigma;
            let (density, whitecap_density) = self.at(slope);
            let share = 1.0 / (crowd * f64::from(POINTS));
            Point { slope, density: density * share, whitecap_density: whitecap_density * share }
        };
        (0..POINTS).map(point).collect()
    }

    /// Every `stride`th node of the tables with its mirror images: slope upwind and crosswind, density and W.
    pub fn nodes(&self, stride: usize, mut call: impl FnMut(DVec2, f64, f64)) {
        let [rows, columns] = self.density.counts;
        for i in (0..rows).step_by(stride) {
            for j in (0..columns).step_by(stride) {
                let slope = DVec2::new(i as f64, j as f64) * DVec2::from(self.density.steps);
                let density = self.density.node(i, j);
                let whitecap_density = self.whitecap_density.as_ref().map_or(0.0, |table| table.node(i, j));
                for u in if i == 0 { &[1.0][..] } else { &[1.0, -1.0] } {
                    for c in if j == 0 { &[1.0][..] } else { &[1.0, -1.0] } {
                        call(slope * DVec2::new(*u, *c), density, whitecap_density);
                    }
                }
            }
        }
    }
}

/// A point of the plane of slopes.
pub(crate) struct Point {
    /// Upwind and crosswind.
    pub slope: DVec2,
    /// p over the density of points.
    pub density: f64,
    /// W over the density of points.
    pub whitecap_density: f64,
}

/// Frequencies and slopes along the wind or across it.
struct Axis {
    frequencies: Vec<f64>,
    /// How many of them have to be resolved.
    resolved: usize,
    /// The smaller one of the standard deviations of facets and drawn slopes.
    finest: f64,
    /// Between slopes of the table.
    step: f64,
    count: usize,
}

impl Axis {
    /// For drawn slopes of a standard deviation, none beyond a bound, and facets; `of` is one component's
    /// characteristic function on this axis. `None` where too many would be needed.
    fn new(
        sigma: f64,
        bound: f64,
        facet: f64,
        components: f64,
        of: impl Fn(&[f64]) -> Vec<f64>,
    ) -> Option<Self> {
        let half_period = (END * sigma).min(1.05 * bound);
        let apart = PI / half_period;
        let finest = sigma.min(facet);
        // Beyond these no table would have room; one component's function shows whether that matters.
        let count = ((FADE[1] / finest / apart) as usize + 2).min(2 * MOST[0]);
        let mut frequencies: Vec<f64> = (0..count).map(|n| n as f64 * apart).collect();
        let size: Vec<f64> = of(&frequencies)
            .iter()
            .zip(&frequencies)
            .map(|(c, q)| c.abs().powf(components) * fade(q * finest))
            .collect();
        let to = |least: f64| size.iter().rposition(|s| *s > least).unwrap_or(0) + 2;
        let (used, resolved) = (to(NEGLIGIBLE).min(count), to(FAINT).min(count));
        frequencies.truncate(used);
        let step = (STEP * sigma).min(1.0 / frequencies[used - 1]);
        let axis = Self { frequencies, resolved, finest, step, count: (half_period / step) as usize };
        (used <= MOST[0] && axis.count <= MOST[1]).then_some(axis)
    }

    fn end(&self) -> f64 {
        self.frequencies[self.resolved - 1]
    }
}

/// 1 falling to 0 between the ends of [`FADE`], so smoothly that the transform has no ripples.
fn fade(x: f64) -> f64 {
    let [start, end] = FADE;
    let t = ((x - start) / (end - start)).clamp(0.0, 1.0);
    1.0 / (1.0 + (1.0 / (1.0 - t) - 1.0 / t).exp())
}

/// The transform of W over the slope's frequencies; `None` where whitecaps are off or too rare to matter.
fn caps(component: &Component, water: &Water, upwind: &[f64], crosswind: &[f64]) -> Option<Vec<f64>> {
    let onset = water.onset_on(Some(component), &[])?;
    let count = f64::from(water.parameters.components);
    let acceleration = sum_of_accelerations(component, count);
    if onset.probability(-acceleration.bound) <= 0.0 {
        return None;
    }
    if acceleration.variance.sqrt() < STILL {
        let probability = onset.probability(0.0);
        let power = |c: f64| probability * c.powi(count as i32);
        return (probability > RARE)
            .then(|| component.slope(upwind, crosswind).into_iter().map(power).collect());
    }
    let (frequencies, level) = acceleration.spectrum(onset.residual(), &TABULATED);
    let weights = weights(&onset, &frequencies);
    if level.iter().zip(&weights).map(|(c, w)| w * c).sum::<f64>() < RARE {
        return None;
    }
    let sum = |row: &[f64]| row.iter().zip(&weights).map(|(c, w)| w * c.powi(count as i32)).sum::<f64>();
    let joint = component.slope_and_acceleration(upwind, crosswind, &frequencies);
    Some(joint.chunks(frequencies.len()).map(sum).collect())
}

/// What is less than this beside the largest value is taken for a ripple of the transform, and for 0. Larger ripples,
/// about a spike sharper than the frequencies, stay, for they sum up to nothing.
const RIPPLE: f64 = 1e-6;

/// A density of the slope, even in both of its parts, as a table with bicubic interpolation.
#[derive(Debug, Clone)]
pub(crate) struct SlopeTable {
    /// Of one step, upwind and crosswind.
    pub steps: [f64; 2],
    /// Values from 0, upwind and crosswind.
    pub counts: [usize; 2],
    /// Row by row, a line and a column before 0 included.
    values: Vec<f64>,
}

impl SlopeTable {
    /// The inverse transform of values at the products of frequencies upwind and crosswind (equal steps from 0), at
    /// `counts` slopes at `steps` from 0.
    pub fn transform(
        spectrum: &[f64],
        frequencies: [&[f64]; 2],
        steps: [f64; 2],
        counts: [usize; 2],
    ) -> Self {
        // Sums over positive and negative frequencies are sums of cosines; 0 counts once.
        let cosines = |axis: usize| -> Vec<Vec<f64>> {
            let q = frequencies[axis];
            let weight = |i: usize| (q[1] - q[0]) / PI * if i == 0 { 0.5 } else { 1.0 };
            let at = |s: f64| (0..q.len()).map(|i| weight(i) * (q[i] * s).cos()).collect();
            (0..counts[axis] + 3).map(|n| at((n as f64 - 1.0) * steps[axis])).collect()
        };
        let (upwind, crosswind) = (cosines(0), cosines(1));
        let width = frequencies[1].len();
        let row = |row: &Vec<f64>| {
            let mut line = vec![0.0; width];
            for (weight, part) in row.iter().zip(spectrum.chunks(width)) {
                line.iter_mut().zip(part).for_each(|(sum, x)| *sum += weight * x);
            }
            let value = |c: &Vec<f64>| c.iter().zip(&line).map(|(a, b)| a * b).sum::<f64>();
            crosswind.iter().map(value).collect::<Vec<_>>()
        };
        let mut values: Vec<f64> = upwind.par_iter().flat_map_iter(row).collect();
        let floor = RIPPLE * values.iter().fold(0.0, |a: f64, b| a.max(*b));
        values.iter_mut().filter(|x| x.abs() < floor).for_each(|x| *x = 0.0);
        Self { steps, counts, values }
    }

    /// At a node.
    pub fn node(&self, upwind: usize, crosswind: usize) -> f64 {
        self.values[(upwind + 1) * (self.counts[1] + 3) + crosswind + 1]
    }

    /// At a slope upwind and crosswind; 0 beyond the table.
    #[inline]
    pub fn at(&self, slope: [f64; 2]) -> f64 {
        let (u, c) = (slope[0].abs() / self.steps[0], slope[1].abs() / self.steps[1]);
        let (i, j) = (u as usize, c as usize);
        if i >= self.counts[0] || j >= self.counts[1] {
            return 0.0;
        }
        let (along, across) = (cubic(u - i as f64), cubic(c - j as f64));
        let width = self.counts[1] + 3;
        let line = |n: usize| {
            let v = &self.values[(i + n) * width + j..][..4];
            across[0] * v[0] + across[1] * v[1] + across[2] * v[2] + across[3] * v[3]
        };
        along[0] * line(0) + along[1] * line(1) + along[2] * line(2) + along[3] * line(3)
    }
}

/// Lagrange's weights of the values at -1, 0, 1 and 2.
#[inline]
pub(crate) fn cubic(x: f64) -> [f64; 4] {
    let (a, b, c, d) = (x + 1.0, x, x - 1.0, x - 2.0);
    [-b * c * d / 6.0, a * c * d / 2.0, -a * b * d / 2.0, a * b * c / 6.0]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_gaussian_transforms_into_one() {
        let q: Vec<f64> = (0..60).map(|i| f64::from(i) * 0.15).collect();
        let spectrum: Vec<f64> =
            q.iter().flat_map(|u| q.iter().map(move |c| (-0.5 * (u * u + 0.49 * c * c)).exp())).collect();
        let table = SlopeTable::transform(&spectrum, [&q, &q], [0.125, 0.1], [50, 40]);
        for (u, c) in [(0.0f64, 0.0f64), (0.3, -0.44), (-2.07, 1.1), (4.01, 2.03)] {
            let expected = (-0.5 * (u * u + c * c / 0.49)).exp() / (TAU * 0.7);
            assert!((table.at([u, c]) - expected).abs() < 1e-5, "{u} {c}");
        }
        assert_eq!(table.at([7.0, 0.0]), 0.0);
    }
}
