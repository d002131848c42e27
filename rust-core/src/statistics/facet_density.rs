//! The density of facets along a half vector, on all drawn waves together: what of a wavy sea's reflection depends on that
//! vector alone, tabulated over it, with mean and variance of the slopes of the waves that carry these facets.

use super::slope_density::{Slopes, WindFrame, cubic};
use crate::config::Water;
use crate::numeric::quadrature::midpoints;
use crate::surface::normal;
use glam::DVec2;
use rayon::prelude::*;

/// The table is over the half vector's tilt angles, to so many standard deviations of all slopes, or to the widest
/// angle in radians.
const END: f64 = 6.0;
const WIDEST: f64 = 1.5;

/// Where the table ends, in tilt angles, for a standard deviation of all slopes.
pub(crate) fn end(sigma: f64) -> f64 {
    (END * sigma).min(WIDEST)
}

/// Facets along a half vector.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Cell {
    /// D: their density with the 1/4 of Eq. 56, all waves together, where there is no whitecap.
    pub density: f64,
    /// Mean slope of the waves that carry them.
    pub mean: DVec2,
    /// Variance of those slopes.
    pub variance: DVec2,
}

/// A table of [`Cell`]s.
#[derive(Debug, Clone)]
pub(crate) struct FacetDensity {
    /// Between nodes, tilt angles upwind and crosswind.
    pub steps: DVec2,
    /// Nodes to either side of 0.
    nodes: usize,
    /// Row by row.
    cells: Vec<Cell>,
}

impl FacetDensity {
    /// Of a sea with drawn slopes, with so many nodes to either side of 0.
    pub fn new(slopes: &Slopes, water: &Water, wind: WindFrame, nodes: usize) -> Self {
        let facets = DVec2::from(water.variances.map(f64::sqrt));
        let all = (facets * facets + slopes.sigma * slopes.sigma).powf(0.5);
        let steps = all.map(end) / nodes as f64;
        let rows = 2 * nodes + 1;
        let cells = (0..rows * rows)
            .into_par_iter()
            .map(|n| {
                let node = DVec2::new((n / rows) as f64, (n % rows) as f64) - nodes as f64;
                Cell::new(slopes, water, wind, (node * steps).map(f64::tan))
            })
            .collect();
        Self { steps, nodes, cells }
    }

    /// Facets along a half vector of a slope upwind and crosswind; none beyond the table.
    pub fn at(&self, slope: DVec2) -> Cell {
        self.at_angles(slope.map(f64::atan))
    }

    /// The same for tilt angles.
    pub fn at_angles(&self, angles: DVec2) -> Cell {
        let place = angles / self.steps + self.nodes as f64;
        let rows = 2 * self.nodes + 1;
        let (x, y) = (place.x.floor(), place.y.floor());
        if !(x >= 1.0 && y >= 1.0 && x < (rows - 2) as f64 && y < (rows - 2) as f64) {
            return Cell::default();
        }
        let (along, across) = (cubic(place.x - x), cubic(place.y - y));
        let mut cell = Cell::default();
        for (i, wx) in along.iter().enumerate() {
            let row = (x as usize + i - 1) * rows + y as usize - 1;
            for (node, wy) in self.cells[row..row + 4].iter().zip(across) {
                let weight = wx * wy;
                cell.density += weight * node.density;
                cell.mean += weight * node.mean;
                cell.variance += weight * node.variance;
            }
        }
        cell.density = cell.density.max(0.0);
        cell
    }
}

impl Cell {
    /// For a half vector of a slope upwind and crosswind.
    pub fn new(slopes: &Slopes, water: &Water, wind: WindFrame, half: DVec2) -> Self {
        let facets = &water.lobe.facets;
        let in_world = |v: DVec2| normal(wind.to_world(v).into());
        let lobe = facets.slope_width(half);
        let mut cell = Self::default();
        let Some((low, high)) = slopes.meeting(half, lobe) else { return cell };
        let step = slopes.step(lobe);
        for (x, width) in midpoints(low.x, high.x, step.x) {
            for (y, height) in midpoints(low.y, high.y, step.y) {
                let slope = DVec2::new(x, y);
                let (density, whitecap_density) = slopes.at(slope);
                let n = in_world(slope);
                let share =
                    (density - whitecap_density) * width * height * facets.density_along(in_world(half), n)
                        / n[2];
                cell.density += share;
                cell.mean += share * slope;
                cell.variance += share * slope * slope;
            }
        }
        if cell.density > 0.0 {
            cell.mean /= cell.density;
            cell.variance = (cell.variance / cell.density - cell.mean * cell.mean).max(DVec2::ZERO);
        } else {
            cell = Self::default();
        }
        cell
    }
}
