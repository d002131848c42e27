//! One realised sea as a triangle mesh whose level of detail changes with the distance: at every vertex the waves longer
//! than two footprints are geometry ([`share`](crate::surface::share)), the shorter ones facets, and crests break by Eqs.
//! 53-54 so that Eq. 51's fraction of every ring of vertices is covered.

use super::grid::{CELLS, Grid, Layout, Ring, needed, split};
use crate::config::{Surface, Water};
use crate::error::Error;
use crate::numeric::root::bisect;
use crate::sea::foam::Foam;
use crate::sea::whitecap::Onset;
use crate::statistics::Ensemble;
use crate::statistics::breaking::accelerations;
use crate::surface::{Component, Draws, Point, Surface as RealisedSurface, WaveSums};
use rayon::prelude::*;
use std::fmt;

/// A sea on a grid, ready to be computed at any time.
///
/// ```
/// use prob_water::{Layout, Mesh, Parameters, Surface};
///
/// let water = Parameters { surface: Surface::Instance, components: 64, ..Parameters::default() }.configure()?;
/// let mesh = Mesh::new(&water, &Layout { radius: 50.0, vertices: 10_000, ..Layout::default() })?;
/// let (geometry, waves) = (mesh.level(), mesh.vertices(2.5)); // at 2.5 s
/// // x, y, z of every vertex, and its footprint.
/// assert_eq!(waves.positions.len(), 3 * geometry.footprints.len());
/// assert!(geometry.footprints.len() <= 10_000);
/// # Ok::<(), prob_water::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct Mesh {
    /// The sea. Its footprint is the one at the centre.
    pub water: Water,
    /// Where the vertices are.
    pub grid: Grid,
    /// In order of rising wave numbers, those of a swell after the wind's.
    pub components: Vec<Component>,
    /// Of whitecaps, on every ring; empty where there are none.
    onsets: Vec<Onset<f64>>,
}

/// What does not change with time.
#[derive(Debug, Clone)]
pub struct StaticGeometry {
    /// x and y of every vertex, m: the sea's own coordinates.
    pub texcoords: Vec<f32>,
    /// D of the facets at every vertex, m: [`Mesh::facets`].
    pub footprints: Vec<f32>,
    /// Three corners of every triangle, counter-clockwise from above.
    pub faces: Vec<u32>,
}

/// What the waves do.
#[derive(Debug, Clone)]
pub struct Vertices {
    /// x, y, z of every vertex, m.
    pub positions: Vec<f32>,
    /// The unit normal of the waves at every vertex.
    pub normals: Vec<f32>,
    /// Probability of a whitecap at every vertex; empty where there are none.
    pub whitecaps: Vec<f32>,
}

impl Mesh {
    /// A sea within the layout's budgets: one instance, its draws stratified.
    ///
    /// # Errors
    /// [`Error::Surface`] where the surface is not [`Surface::Instance`], and as [`Grid::new`].
    pub fn new(water: &Water, layout: &Layout) -> Result<Self, Error> {
        let water = &water.on(&[Surface::Instance])?;
        let grid = Grid::new(layout, water.footprint)?;
        let sea = Ensemble { draws: Draws::Stratified, waves: water.fading_waves(), ..Ensemble::new(water)? };
        let components: Vec<_> = sea.components(0).1.collect();
        let mut mesh = Self { water: *water, grid, components, onsets: vec![] };
        // Rings of one footprint have the same waves.
        let alike: Vec<&[Ring]> = mesh.grid.rings.chunk_by(|a, b| a.footprint == b.footprint).collect();
        let onsets = |rings: &&[Ring]| {
            water.onset_of(&accelerations(&mesh.seen(&rings[0]))).map(|onset| vec![onset; rings.len()])
        };
        mesh.onsets = alike.par_iter().filter_map(onsets).flatten_iter().collect();
        Ok(mesh)
    }

    /// What does not change with time.
    pub fn level(&self) -> StaticGeometry {
        let grid = &self.grid;
        let places = grid.rings.iter().flat_map(|ring| grid.places(ring));
        let facets: Vec<f64> = grid.rings.par_iter().map(|ring| self.facets(ring.footprint)).collect();
        let footprints = grid
            .rings
            .iter()
            .zip(facets)
            .flat_map(|(ring, footprint)| std::iter::repeat_n(footprint as f32, grid.on(ring)));
        let vertices = grid.vertices as usize;
        let mut level = StaticGeometry {
            texcoords: Vec::with_capacity(2 * vertices),
            footprints: Vec::with_capacity(vertices),
            faces: grid.triangles(),
        };
        level.texcoords.extend(places.flatten());
        level.footprints.extend(footprints);
        level
    }

    /// D of the facets where the waves have a footprint in m: so much larger that the facets' slope variance makes up for
    /// what interpolation between vertices takes from the waves', and for the swell that is too short for the footprint.
    pub fn facets(&self, footprint: f64) -> f64 {
        let cell = footprint / CELLS;
        // Of a swell, whose waves are nobody's facets, also what the footprint does not resolve.
        let of_wind = self.water.fading_waves().of_wind();
        let lost = |(j, c): (usize, &Component)| {
            let seen = c.seen_at(footprint).slope_variance();
            let unseen = if j < of_wind { 0.0 } else { c.slope_variance() - seen };
            seen * (1.0 - interpolated(c.wave_number * cell)) + unseen
        };
        let lost: f64 = self.components.iter().enumerate().map(lost).sum();
        let total = |d: f64| self.water.facet_variances(d).iter().sum::<f64>();
        let wanted = total(footprint) + lost;
        // No facets are rougher than those of a thousand times the footprint, for what interpolation takes.
        bisect(footprint.ln(), (1e3 * footprint).ln(), |ln| total(ln.exp()) >= wanted).exp()
    }

    /// The waves at a time in s.
    pub fn vertices(&self, time: f64) -> Vertices {
        let vertices = self.grid.vertices as usize;
        let zeros = |width: usize| vec![0.0; width * vertices];
        let mut all = Vertices {
            positions: zeros(3),
            normals: zeros(3),
            whitecaps: zeros(usize::from(!self.onsets.is_empty())),
        };
        let pieces =
            |array, width| split(array, self.grid.rings.iter().map(move |r| width * self.grid.on(r)));
        let positions = pieces(&mut all.positions, 3);
        let normals = pieces(&mut all.normals, 3);
        let whitecaps = pieces(&mut all.whitecaps, usize::from(!self.onsets.is_empty()));
        let rings = self.grid.rings.par_iter().zip(positions).zip(normals).zip(whitecaps);
        rings.enumerate().for_each(|(n, (((ring, positions), normals), whitecaps))| {
            self.ring(ring, self.onsets.get(n), time, positions, normals, whitecaps);
        });
        all
    }

    /// The waves that are geometry on a ring.
    fn seen(&self, ring: &Ring) -> Vec<Component> {
        let mut waves: Vec<_> = self.components.iter().map(|c| c.seen_at(ring.footprint)).collect();
        waves.retain(|c| c.amplitude > 0.0);
        waves
    }

    fn ring(
        &self,
        ring: &Ring,
        onset: Option<&Onset<f64>>,
        time: f64,
        positions: &mut [f32],
        normals: &mut [f32],
        whitecaps: &mut [f32],
    ) {
        let waves = self.seen(ring);
        let places: Vec<_> = self.grid.places(ring).collect();
        let precise: Vec<_> = places.iter().map(|place| place.map(f64::from)).collect();
        let mut points = vec![Point::default(); places.len()];
        let mut surface = RealisedSurface::new(waves.iter().copied(), time);
        WaveSums::new(&surface).points(&precise, &mut points);

        let corners = positions.chunks_exact_mut(3).zip(normals.chunks_exact_mut(3));
        for (([x, y], point), (position, normal)) in places.iter().copied().zip(&points).zip(corners) {
            position.copy_from_slice(&[x, y, point.height as f32]);
            normal.copy_from_slice(&point.normal().map(|x| x as f32));
        }
        let Some(onset) = onset else { return };
        let highest = waves.iter().map(|c| c.frequency).fold(0.0, f64::max);
        let Some(foam) = Foam::new(self.water.parameters.whitecap_lifetime, highest) else {
            for (whitecap, point) in whitecaps.iter_mut().zip(&points) {
                *whitecap = onset.probability(point.acceleration) as f32;
            }
            return;
        };
        let mut means = vec![0.0; places.len()];
        for [before, weight] in foam.past(time) {
            surface.set_time(time - before);
            WaveSums::new(&surface).points(&precise, &mut points);
            for (mean, point) in means.iter_mut().zip(&points) {
                *mean += weight * onset.probability(point.acceleration);
            }
        }
        for (whitecap, mean) in whitecaps.iter_mut().zip(means) {
            *whitecap = mean as f32;
        }
    }
}

/// The share of a wave's variance that is left between the vertices of triangles, linear interpolation of a cosine, for a
/// wave number times a cell: edges are a cell long, but for one in three, its diagonal.
fn interpolated(phase: f64) -> f64 {
    (3.0 + 2.0 * libm::j0(phase) + libm::j0(std::f64::consts::SQRT_2 * phase)) / 6.0
}

/// The mesh and the sea, a `name = value` a line.
impl fmt::Display for Mesh {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (grid, layout) = (&self.grid, &self.grid.layout);
        let edge = grid.rings.last().map_or(0.0, |ring| ring.footprint);
        let center = self.water.footprint;
        writeln!(f, "vertices = {}", grid.vertices)?;
        writeln!(f, "faces = {}", grid.faces)?;
        writeln!(f, "center = {}, {}", layout.center[0], layout.center[1])?;
        writeln!(f, "radius = {}", layout.radius)?;
        writeln!(f, "azimuth = {}", layout.azimuth)?;
        writeln!(f, "opening = {}", layout.opening)?;
        writeln!(f, "[cell at center = {:.4}, at edge = {:.4}]", center / CELLS, edge / CELLS)?;
        writeln!(f, "[footprint at center = {center:.4}, at edge = {edge:.4}]")?;
        writeln!(f, "[memory = {} MiB]", needed(grid.vertices))?;
        write!(f, "{}", self.water)
    }
}
