//! One realised sea as a triangle mesh whose level of detail changes with the distance: at every vertex the waves longer
//! than two footprints are geometry ([`share`](crate::surface::share)), the shorter ones facets, and where crests break
//! is what the drawn waves say of Eqs. 53-54.

use super::grid::{CELLS, Grid, Layout, Ring, needed, split};
use crate::config::{Surface, Water};
use crate::error::Error;
use crate::numeric::root::bisect;
use crate::sea::whitecap;
use crate::statistics::Ensemble;
use crate::statistics::characteristic::variances;
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
    /// In order of rising wave numbers.
    pub components: Vec<Component>,
    foam: Option<Foam>,
}

/// Whitecaps by the waves' vertical acceleration.
#[derive(Debug, Clone, Copy)]
struct Foam {
    /// Standard deviation of the acceleration that gives Eq. 51's fraction, m/s^2; `None`: they are everywhere.
    deviation: Option<f64>,
    /// What a drawn wave's acceleration counts.
    gain: f64,
    /// So many of the components, the longest, have no more.
    waves: usize,
}

/// Where the waves longer than two such footprints have too little acceleration for Eq. 51's fraction, theirs counts more:
/// at this D, m, Eqs. 53-54 and Eq. 51 agree.
const BREAKING: f64 = 0.1;

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

impl Foam {
    fn new(water: &Water, fraction: f64, components: &[Component]) -> Self {
        let deviation = whitecap::deviation(water.wind.friction_velocity, fraction).map(|s| 0.01 * s);
        let wanted = deviation.unwrap_or_default().powi(2);
        let breaking = Water { footprint: BREAKING, ..*water };
        let [_, _, theirs] = variances(&breaking.waves());
        let gain = if theirs > 0.0 { (wanted / theirs).sqrt().max(1.0) } else { 1.0 };
        let mut sum = 0.0;
        let fits = |c: &&Component| {
            sum += gain * gain * c.acceleration_variance();
            sum <= wanted
        };
        let waves = components.iter().take_while(fits).count();
        Self { deviation, gain, waves }
    }
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
        let fraction = if water.parameters.whitecaps { water.whitecap_fraction } else { 0.0 };
        let foam = (fraction > 0.0).then(|| Foam::new(water, fraction, &components));
        Ok(Self { water: *water, grid, components, foam })
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
    /// what interpolation between vertices takes from the waves'.
    pub fn facets(&self, footprint: f64) -> f64 {
        let cell = footprint / CELLS;
        let lost: f64 = self
            .components
            .iter()
            .map(|c| c.seen_at(footprint).slope_variance() * (1.0 - interpolated(c.wave_number * cell)))
            .sum();
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
            whitecaps: zeros(usize::from(self.foam.is_some())),
        };
        let pieces =
            |array, width| split(array, self.grid.rings.iter().map(move |r| width * self.grid.on(r)));
        let positions = pieces(&mut all.positions, 3);
        let normals = pieces(&mut all.normals, 3);
        let whitecaps = pieces(&mut all.whitecaps, usize::from(self.foam.is_some()));
        let rings = self.grid.rings.par_iter().zip(positions).zip(normals).zip(whitecaps);
        rings.for_each(|(((ring, positions), normals), whitecaps)| {
            self.ring(ring, time, positions, normals, whitecaps);
        });
        all
    }

    fn ring(
        &self,
        ring: &Ring,
        time: f64,
        positions: &mut [f32],
        normals: &mut [f32],
        whitecaps: &mut [f32],
    ) {
        let seen = |waves: &[Component]| {
            let mut waves: Vec<_> = waves.iter().map(|c| c.seen_at(ring.footprint)).collect();
            waves.retain(|c| c.amplitude > 0.0);
            waves
        };
        let (breaking, rest) = self.components.split_at(self.foam.map_or(0, |foam| foam.waves));
        let (breaking, rest) = (seen(breaking), seen(rest));
        let resolved: f64 = breaking.iter().map(Component::acceleration_variance).sum();
        let places: Vec<_> = self.grid.places(ring).collect();
        let precise: Vec<_> = places.iter().map(|place| place.map(f64::from)).collect();
        let points = |waves: Vec<Component>| {
            let mut points = vec![Point::default(); places.len()];
            let surface = RealisedSurface::new(waves.into_iter(), time);
            WaveSums::new(&surface).points(&precise, &mut points);
            points
        };
        let sums = points(breaking).into_iter().zip(points(rest));

        let corners = positions.chunks_exact_mut(3).zip(normals.chunks_exact_mut(3));
        for (i, (([x, y], (mut point, other)), (position, normal))) in
            places.into_iter().zip(sums).zip(corners).enumerate()
        {
            point.height += other.height;
            point.slope = std::array::from_fn(|axis| point.slope[axis] + other.slope[axis]);
            position.copy_from_slice(&[x, y, point.height as f32]);
            normal.copy_from_slice(&point.normal().map(|x| x as f32));
            if let Some(foam) = self.foam {
                whitecaps[i] = self.whitecap(foam, point.acceleration, resolved) as f32;
            }
        }
    }

    /// Probability of a whitecap where the resolved waves have an acceleration in m/s^2 and all over the sea its variance.
    fn whitecap(&self, foam: Foam, acceleration: f64, resolved: f64) -> f64 {
        let Foam { deviation, gain, .. } = foam;
        let Some(all) = deviation else { return self.water.whitecap_fraction };
        let rest = (all * all - gain * gain * resolved).max(0.0).sqrt();
        let w = self.water.wind.friction_velocity;
        whitecap::mean_probability(w, 100.0 * gain * acceleration, 100.0 * rest)
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
