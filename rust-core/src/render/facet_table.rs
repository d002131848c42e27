//! Facets for any footprint, tabulated: for a footprint that changes from place to place.

use crate::brdf::Facets;
use crate::brdf::lobe::BOUND_SLACK;
use crate::config::{Hiding, Water};
use crate::numeric::packets::{Packets, Tabulated};
use crate::numeric::{Real, Scalar};
use rayon::prelude::*;

/// Natural logarithms of the footprints in m between which facets are tabulated: from a third of a millimetre, where the
/// floor of the variances is near, to 2000 km. The last node stands for an infinite one.
const RANGE: [f64; 2] = [-8.0, 14.5];
/// So fine that linear interpolation errs by 1e-4 of a standard deviation, 1e-3 below a centimetre.
const NODES: usize = 769;

/// What of the facets' lobe depends on the footprint, over the footprint's logarithm.
#[derive(Debug, Clone)]
pub struct FacetTable<T: Real> {
    /// Eq. 56's constant with the 2 pi of the density.
    scale: T,
    /// Whether the bound on what facets reflect is in force at any footprint.
    pub bounded: bool,
    /// [`Hiding::Once`].
    own_shadows: bool,
    /// sigma_u, sigma_c, steep_gain, bound and the proposal's two of [`Facets`], and what fills a packet.
    rows: Packets,
}

impl FacetTable<f64> {
    /// Tabulates the facets of a sea.
    pub fn new(water: &Water) -> Self {
        let facets = &water.lobe.facets;
        let row = |node: usize| {
            let last = node == NODES - 1;
            let footprint = if last { f64::INFINITY } else { (RANGE[0] + step() * node as f64).exp() };
            let f = water.parameters.facets(
                &water.wind,
                [water.ior, water.extinction],
                water.facet_variances(footprint),
            );
            // Where no bound is in force nothing reaches the slack.
            let bound = if f.bounded { f.bound } else { BOUND_SLACK };
            [f.sigma_u, f.sigma_c, f.steep_gain, bound, f.proposal[0], f.proposal[1], 0.0, 0.0]
        };
        let rows: Vec<[f64; 8]> = (0..NODES).into_par_iter().map(row).collect();
        Self {
            scale: facets.scale * facets.sigma_u * facets.sigma_c,
            bounded: rows.iter().any(|row| row[3] < BOUND_SLACK),
            own_shadows: water.parameters.hiding == Hiding::Once,
            rows: Packets {
                width: 8,
                half: false,
                numbers: rows.iter().flatten().map(|x| *x as f32).collect(),
            },
        }
    }
}

impl<S: Scalar> FacetTable<S> {
    /// The same in another number type.
    pub fn cast<T: Real>(&self) -> FacetTable<T> {
        let scale = T::coefficient(self.scale.to_f64());
        FacetTable { scale, bounded: self.bounded, own_shadows: self.own_shadows, rows: self.rows.clone() }
    }
}

/// Of the logarithm, between rows.
fn step() -> f64 {
    (RANGE[1] - RANGE[0]) / (NODES - 1) as f64
}

impl<T: Tabulated> FacetTable<T> {
    /// Gives the facets another footprint, in m, linearly between rows; infinite, or not a number, is the largest.
    #[inline(always)]
    pub fn set(&self, facets: &mut Facets<T>, footprint: T) {
        let (zero, last) = (T::of(0.0), T::of((NODES - 1) as f64));
        let [shortest, longest] = RANGE.map(|log| T::of(log.exp()));
        let footprint = T::max(T::min(footprint, longest), shortest);
        let place = (footprint.ln() - T::of(RANGE[0])) * T::of(1.0 / step());
        let (node, t) = T::max(T::min(place, last), zero).step(NODES as u32 - 1);
        let a = T::lookup::<8>(&self.rows, node, T::everywhere());
        let b = T::lookup::<8>(&self.rows, node + T::of(1.0), T::everywhere());
        let row = |k: usize| t.mul_add(b[k] - a[k], a[k]);
        facets.set_sigmas([row(0), row(1)], self.scale);
        facets.steep_gain = row(2);
        facets.bound = row(3);
        facets.bounded = self.bounded;
        facets.own_shadows = self.own_shadows;
        facets.proposal = [row(4), row(5)];
    }
}
