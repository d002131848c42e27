//! Facets for any footprint, tabulated: for a footprint that changes from place to place.

use crate::brdf::lobe::BOUND_SLACK;
use crate::brdf::{Facets, slopes};
use crate::config::Water;
use crate::numeric::Scalar;
use rayon::prelude::*;

/// Natural logarithms of the footprints in m between which facets are tabulated: from a third of a millimetre, where the
/// floor of the variances is near, to 2000 km. The last node stands for an infinite one.
const RANGE: [f64; 2] = [-8.0, 14.5];
/// So fine that linear interpolation errs by 1e-4 of a standard deviation, 1e-3 below a centimetre.
const NODES: usize = 769;

/// What of the facets' lobe depends on the footprint, over the footprint's logarithm.
#[derive(Debug, Clone)]
pub struct FacetTable {
    /// Eq. 56's constant with the 2 pi of the density.
    scale: f64,
    /// Whether the bound on what facets reflect is in force at any footprint.
    pub bounded: bool,
    rows: Vec<Row>,
}

/// sigma_u, sigma_c, steep_gain, bound, proposal_u, proposal_c of [`Facets`], and what fills a packet.
type Row = [f64; 8];

impl FacetTable {
    /// Tabulates the facets of a sea.
    pub fn new(water: &Water) -> Self {
        let facets = &water.lobe.facets;
        let row = |node: usize| {
            let last = node == NODES - 1;
            let footprint = if last { f64::INFINITY } else { (RANGE[0] + Self::step() * node as f64).exp() };
            let f =
                water.parameters.facets(&water.wind, water.ior, slopes::variances(&water.wind, footprint));
            // Where no bound is in force nothing reaches the slack.
            let bound = if f.bounded { f.bound } else { BOUND_SLACK };
            [f.sigma_u, f.sigma_c, f.steep_gain, bound, f.proposal[0], f.proposal[1], 0.0, 0.0]
        };
        let rows: Vec<Row> = (0..NODES).into_par_iter().map(row).collect();
        Self {
            scale: facets.scale * facets.sigma_u * facets.sigma_c,
            bounded: rows.iter().any(|row| row[3] < BOUND_SLACK),
            rows,
        }
    }

    /// Of the logarithm, between rows.
    fn step() -> f64 {
        (RANGE[1] - RANGE[0]) / (NODES - 1) as f64
    }

    /// Gives the facets another footprint, in m; infinite, or not a number, is the largest.
    pub fn set<T: Scalar>(&self, facets: &mut Facets<T>, footprint: f64) {
        let place = ((footprint.ln() - RANGE[0]) / Self::step()).clamp(0.0, (NODES - 1) as f64);
        let place = if place.is_nan() { (NODES - 1) as f64 } else { place };
        let node = (place as usize).min(NODES - 2);
        let (a, b, t) = (&self.rows[node], &self.rows[node + 1], place - node as f64);
        let [sigma_u, sigma_c, gain, bound, u, c, ..]: Row =
            std::array::from_fn(|k| a[k] + t * (b[k] - a[k]));
        facets.set_sigmas([sigma_u, sigma_c].map(T::of), T::of(self.scale));
        facets.steep_gain = T::of(gain);
        facets.bound = T::of(bound);
        facets.bounded = self.bounded;
        facets.proposal = [u, c].map(T::of);
    }

    /// For traced code, linear between rows: the first row's logarithm and the step, the constant over
    /// `sigma_u sigma_c`, and the rows one after the other.
    pub fn table(&self) -> ([f64; 2], f64, Vec<f32>) {
        let cells = self.rows.iter().flatten().map(|x| *x as f32).collect();
        ([RANGE[0], Self::step()], self.scale, cells)
    }
}
