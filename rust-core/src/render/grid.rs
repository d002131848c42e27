//! A sea's mesh as seen from above: rings about a centre, of cells that grow with the distance. Nothing is allocated
//! before the counts are known and within the budgets.

use crate::error::{Error, refuse};
use crate::numeric::root::bisect;
use rayon::prelude::*;
use std::f64::consts::{PI, TAU};

/// Cells on a footprint. Normals are interpolated between vertices, which takes slope from the shortest waves; with 3
/// the loss stays within 5 % of the slopes' variance, facets included (tests/model/mesh.rs).
pub const CELLS: f64 = 3.0;
/// Bytes that a vertex takes at the peak, while Mitsuba builds its tree over the triangles: 320 measured at
/// a million vertices, 290 at four (validation/bench/surface.py).
pub const BYTES: u64 = 350;
/// Ratio of a cell to its distance from which triangles are no longer square to the eye.
const STEEPEST: f64 = 0.3;
/// float32 tells places in a cell this many times finer.
const RESOLUTION: f64 = (1 << 20) as f64;
/// As many vertices as 32 bits can number the corners of triangles of.
const MOST_VERTICES: u64 = 500_000_000;

/// Which part of the sea, and how finely.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Layout {
    /// Where the cells are smallest, m.
    pub center: [f64; 2],
    /// Distance of the mesh's edge from there, m.
    pub radius: f64,
    /// The middle of the sector, degrees counter-clockwise from +x.
    pub azimuth: f64,
    /// The sector's angle, degrees; 360 is all around.
    pub opening: f64,
    /// Most vertices.
    pub vertices: u64,
    /// Most memory, MiB.
    pub memory: u64,
}

impl Default for Layout {
    fn default() -> Self {
        Self {
            center: [0.0; 2],
            radius: 20e3,
            azimuth: 0.0,
            opening: 360.0,
            vertices: 1_000_000,
            memory: 2048,
        }
    }
}

/// Vertices at one distance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ring {
    /// m.
    pub radius: f64,
    /// The report's D there, m.
    pub footprint: f64,
    /// Edges along the ring; 0 for the centre.
    pub segments: u32,
}

/// How cells follow each other outwards.
#[derive(Debug, Clone, Copy)]
struct Spacing {
    /// The smallest, m.
    cell: f64,
    /// Ratio of a larger one to its distance.
    growth: f64,
    radius: f64,
    /// Radians.
    opening: f64,
}

impl Spacing {
    fn full(&self) -> bool {
        self.opening >= TAU
    }

    fn cell_at(&self, radius: f64) -> f64 {
        self.cell.max(self.growth * radius)
    }

    /// The rings outside the centre: radii at equal steps of the integral of dr/c.
    fn rings(self) -> impl Iterator<Item = (f64, u32)> {
        let Self { cell, growth, radius, opening } = self;
        let all = if growth * radius <= cell {
            radius / cell
        } else {
            (1.0 + (growth * radius / cell).ln()) / growth
        };
        let count = all.ceil().max(1.0) as u64;
        (1..=count).map(move |j| {
            let s = all * j as f64 / count as f64;
            let r = if j == count {
                radius
            } else if growth * s <= 1.0 {
                s * cell
            } else {
                cell / growth * (growth * s - 1.0).exp()
            };
            // No edge may cut off so much of its arc that triangles turn over.
            let segments = (opening * r / self.cell_at(r)).max(3.0 * opening / PI).ceil();
            (r, segments as u32)
        })
    }

    /// Vertices and triangles, unless there are more than `most` vertices.
    fn count(self, most: u64) -> Option<[u64; 2]> {
        let [mut vertices, mut faces, mut last] = [1, 0, 0];
        for (_, segments) in self.rings() {
            let segments = u64::from(segments);
            vertices += segments + u64::from(!self.full());
            faces += last + segments;
            last = segments;
            if vertices > most {
                return None;
            }
        }
        Some([vertices, faces])
    }
}

/// The mesh as seen from above.
#[derive(Debug, Clone)]
pub struct Grid {
    /// What it was made from.
    pub layout: Layout,
    /// Ratio of a cell to its distance where cells grow; 0 where they are all of one size.
    pub growth: f64,
    /// From the centre outwards.
    pub rings: Vec<Ring>,
    /// Number of vertices.
    pub vertices: u64,
    /// Number of triangles.
    pub faces: u64,
}

impl Grid {
    /// The finest grid within the layout's budgets whose cells fit the footprint in m at the centre.
    pub fn new(layout: &Layout, footprint: f64) -> Result<Self, Error> {
        let Layout { center: [x, y], radius, azimuth, opening, vertices, memory } = *layout;
        if !(radius > 0.0 && radius <= 1e6) {
            return refuse("radius", radius, "above 0 m, up to 1e6 m");
        }
        if !(footprint >= 1e-6 && footprint <= radius) {
            return refuse("footprint", footprint, "1e-6 m up to the radius");
        }
        if !azimuth.is_finite() {
            return refuse("azimuth", azimuth, "any finite angle, degrees");
        }
        if !(0.001..=360.0).contains(&opening) {
            return refuse("opening", opening, "0.001 to 360 degrees");
        }
        if vertices > MOST_VERTICES {
            return refuse("vertices", vertices, format!("up to {MOST_VERTICES}"));
        }
        let cell = footprint / CELLS;
        let farthest = cell * RESOLUTION;
        if !(x.abs() <= farthest && y.abs() <= farthest) {
            let allowed =
                format!("at most {farthest:.0} m from 0, as far as float32 tells such small cells apart");
            return refuse("center", format!("{x}, {y}"), allowed);
        }

        let spacing = |growth| Spacing { cell, growth, radius, opening: opening.to_radians() };
        let fits = |growth: f64| spacing(growth).count(vertices).is_some();
        if !fits(STEEPEST) {
            let least = spacing(STEEPEST).count(u64::MAX).map_or(0, |[vertices, _]| vertices);
            let allowed = format!("at least {least} for footprint = {footprint} and radius = {radius}");
            return refuse("vertices", vertices, allowed);
        }
        let growth = if fits(0.0) { 0.0 } else { bisect(0.0, STEEPEST, fits) };
        let spacing = spacing(growth);
        let [vertices, faces] = spacing.count(u64::MAX).expect("has no limit");
        let needed = needed(vertices);
        if needed > memory {
            return refuse("memory", memory, format!("at least {needed} MiB for {vertices} vertices"));
        }
        let ring = |(radius, segments)| Ring { radius, footprint: CELLS * spacing.cell_at(radius), segments };
        let rings = std::iter::once((0.0, 0)).chain(spacing.rings()).map(ring).collect();
        Ok(Self { layout: *layout, growth, rings, vertices, faces })
    }

    /// Vertices on a ring: an arc has one more than edges, and so has the centre.
    pub fn on(&self, ring: &Ring) -> usize {
        ring.segments as usize + usize::from(self.layout.opening < 360.0 || ring.segments == 0)
    }

    /// Where the vertices of a ring are, m, rounded to float32.
    pub fn places(&self, ring: &Ring) -> impl Iterator<Item = [f32; 2]> {
        let Layout { center: [x, y], azimuth, opening, .. } = self.layout;
        let start = (azimuth % 360.0 - 0.5 * opening).to_radians();
        let step = opening.to_radians() / f64::from(ring.segments.max(1));
        let radius = ring.radius;
        (0..self.on(ring)).map(move |i| {
            let (sin, cos) = (start + step * i as f64).sin_cos();
            [(x + radius * cos) as f32, (y + radius * sin) as f32]
        })
    }

    /// The corners of the triangles, counter-clockwise from above: between two rings each triangle has an edge on one of
    /// them, taken in order of the edges' middles.
    pub fn triangles(&self) -> Vec<u32> {
        let mut corners = vec![0; 3 * self.faces as usize];
        let bands = self.rings.windows(2).map(|b| 3 * (b[0].segments + b[1].segments) as usize);
        let pieces = split(&mut corners, bands);
        let firsts = self.rings.iter().scan(0, |first, ring| {
            let this = *first;
            *first += self.on(ring) as u32;
            Some(this)
        });
        let firsts: Vec<u32> = firsts.collect();
        self.rings.par_windows(2).zip(firsts.par_windows(2)).zip(pieces).for_each(
            |((rings, firsts), out)| {
                let count = [0, 1].map(|side| self.on(&rings[side]) as u32);
                let edges = [0, 1].map(|side| u64::from(rings[side].segments));
                let vertex = |side: usize, i: u64| firsts[side] + i as u32 % count[side];
                let [mut a, mut b] = [0, 0];
                for corners in out.chunks_exact_mut(3) {
                    let inner =
                        b == edges[1] || a < edges[0] && (2 * a + 1) * edges[1] <= (2 * b + 1) * edges[0];
                    let third = if inner { vertex(0, a + 1) } else { vertex(1, b + 1) };
                    corners.copy_from_slice(&[vertex(0, a), vertex(1, b), third]);
                    if inner { a += 1 } else { b += 1 }
                }
            },
        );
        corners
    }
}

/// Memory that so many vertices take, MiB.
pub fn needed(vertices: u64) -> u64 {
    (vertices * BYTES).div_ceil(1 << 20)
}

/// An array as consecutive pieces of given lengths.
pub(crate) fn split<T>(mut array: &mut [T], lengths: impl Iterator<Item = usize>) -> Vec<&mut [T]> {
    lengths.map(|length| array.split_off_mut(..length).expect("lengths add up")).collect()
}
