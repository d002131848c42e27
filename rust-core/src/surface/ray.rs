//! Rays and a realised surface: where a beam first meets it (Eqs. 28-29, 46-47) and whether it hides the way to an
//! observer (Eqs. 48-50).
//!
//! Along a ray the gap between ray and water is a line minus a sum of cosines, so its second derivative is bounded.
//! From a point with a known gap and its derivative, a parabola with that bound lies below the gap; up to the
//! parabola's first root there is no crossing. Marching from root to root can therefore not step over a crest. It
//! closes in on a crossing quadratically, as Newton's method would from the safe side, and on a near miss it passes by.

use super::realised::{Surface, sum};
use crate::config::Water;
use crate::numeric::trigonometry::{LANES, sin_cos};
use crate::readings::Readings;
use glam::{DVec2, DVec3};

/// Gap and derivative are known to about this, m and 1.
const RESOLUTION: f64 = 1e-13;

/// A surface as a ray meets it; kept by the caller for its memory.
#[derive(Debug, Default)]
pub struct SurfaceRay {
    /// Amplitude, m, phase at the start, radians, and wave number along the ray, rad/m, lane by lane.
    waves: Vec<[[f64; LANES]; 3]>,
    /// Height of the ray at its start, m.
    height: f64,
    /// Its slope by distance.
    slope: f64,
    /// Bound of the gap's second derivative, 1/m.
    curvature_bound: f64,
    /// Bound of the surface's slope by distance along the ray.
    slope_bound: f64,
}

impl Water {
    /// Whether Eqs. 43-45 and 49 let a wave stand in a way off the surface. As read they always do: a march finds out. As
    /// printed only where the way is not steeper than signed sums, which cancel.
    pub(crate) fn may_occlude(&self, surface: &Surface, way: DVec3) -> bool {
        !self.parameters.readings.contains(Readings::EQ_43_45)
            || way.z <= surface.signed_steepest() * way.truncate().length()
    }
}

impl SurfaceRay {
    /// Where a beam from `origin`, in m, along a unit `direction` that points down first meets the surface. `None` if
    /// the origin itself lies under a wave.
    pub fn first_hit(&mut self, surface: &Surface, origin: DVec3, direction: DVec3) -> Option<DVec3> {
        // Nothing happens above the highest crest.
        let start = if origin.z > surface.highest() {
            let entry = origin + (surface.highest() - origin.z) / direction.z * direction;
            entry.truncate().extend(surface.highest())
        } else {
            origin
        };
        self.set(surface, start, direction);
        let (gap, _) = self.gap(0.0);
        if gap <= 0.0 && start == origin {
            return None;
        }
        let end = (start.z + surface.highest()) / -direction.z;
        Some(start + self.crossing(0.0, end).unwrap_or(end) * direction)
    }

    /// Whether the surface hides `observer`, in m, from a point `from` on it: the way there dips under the water, or
    /// the observer is under it.
    pub fn occludes(&mut self, surface: &Surface, from: DVec3, observer: DVec3) -> bool {
        let way = observer - from;
        let distance = way.length();
        self.set(surface, from, way / distance);
        if self.slope >= self.slope_bound {
            return false;
        }
        let (_, opening) = self.gap(0.0);
        if opening <= 0.0 {
            return true;
        }
        let above = if self.slope > 0.0 { (surface.highest() - from.z) / self.slope } else { f64::INFINITY };
        // The parabola's vertex: the start itself has no gap to begin with.
        self.crossing(opening / self.curvature_bound, distance.min(above)).is_some()
    }

    fn set(&mut self, surface: &Surface, start: DVec3, direction: DVec3) {
        let (place, horizontal): (DVec2, DVec2) = (start.truncate(), direction.truncate());
        self.waves.clear();
        self.waves.extend(surface.along(place.into(), horizontal.into()));
        self.height = start.z;
        self.slope = direction.z;
        self.curvature_bound = self.total(|a, k| a * k * k);
        self.slope_bound = self.total(|a, k| a * k.abs());
    }

    fn total(&self, of: impl Fn(f64, f64) -> f64) -> f64 {
        self.waves.iter().map(|[a, _, k]| sum(std::array::from_fn(|l| of(a[l], k[l])))).sum()
    }

    /// Height of the ray over the water at a distance from its start, m, and its derivative.
    #[inline]
    fn gap(&self, distance: f64) -> (f64, f64) {
        let (mut gap, mut opening) = ([0.0; LANES], [0.0; LANES]);
        for [a, phase, k] in &self.waves {
            let (sin, cos) = sin_cos(std::array::from_fn(|l| phase[l] + k[l] * distance));
            for l in 0..LANES {
                gap[l] -= a[l] * cos[l];
                opening[l] += a[l] * k[l] * sin[l];
            }
        }
        (self.height + self.slope * distance + sum(gap), self.slope + sum(opening))
    }

    /// First distance after `start` and before `end` at which the ray is not above the water.
    fn crossing(&self, start: f64, end: f64) -> Option<f64> {
        let mut distance = start;
        while distance < end {
            let (gap, opening) = self.gap(distance);
            if gap <= 0.0 {
                return Some(distance);
            }
            let root = (opening * opening + 2.0 * self.curvature_bound * gap).sqrt();
            let step = if opening < 0.0 {
                2.0 * gap / (root - opening)
            } else {
                (root + opening) / self.curvature_bound
            };
            distance += step;
            if step <= RESOLUTION * (1.0 + distance) {
                return Some(distance);
            }
        }
        None
    }
}
