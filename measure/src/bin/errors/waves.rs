//! The spectrum, drawn waves, their sums far out and late, rays, and the vertices of a mesh.

use crate::Lines;
use glam::DVec3;
use prob_water::spectrum::Spectrum;
use prob_water::surface::SurfaceRay;
use prob_water::surface::{Component, Draws, InstanceRng};
use prob_water::{
    Layout, Mesh, Parameters, Readings, RealisedSurface, Salinity, SpectrumModel, Surface, Water, WaveSums,
    Wind,
};
use serde_json::{Value, json};
use std::f64::consts::{PI, TAU};

/// Where and when sums of waves are taken: to 10 km and an hour from 0.
const FAR: f64 = 1e4;
const LATE: f64 = 3600.0;
/// Beyond it the sines of waves are not meant to be used, radians.
const LARGEST_PHASE: f64 = 2e8;

pub fn write(lines: &mut Lines) {
    for _ in 0..lines.rows {
        sine(lines);
    }
    for _ in 0..lines.rows / 2 {
        spectrum(lines);
    }
    for _ in 0..lines.rows / 6 {
        sums(lines);
    }
    for _ in 0..lines.rows / 12 {
        cast(lines);
    }
    mesh(lines);
}

/// A wave of height and wave number 1 gives sine and cosine of where it is.
fn sine(lines: &mut Lines) {
    let component = Component { wave_number: 1.0, phase: 0.0, azimuth: 0.0, amplitude: 1.0, frequency: 1.0 };
    let surface = RealisedSurface::new(std::iter::once(component), 0.0);
    let size =
        if lines.one(&[true, false]) { lines.decades(1e-9, LARGEST_PHASE) } else { lines.uniform(0.0, 1e4) };
    // Next to multiples of a quarter turn sine or cosine are small.
    let size = if lines.one(&[true, false, false]) { (size / PI).round() * 0.5 * PI } else { size };
    let angle = size * lines.one(&[-1.0, 1.0]);
    let point = surface.point([angle, 0.0]);
    lines.row("sine", json!([angle]), json!({"float64": [-point.slope[0], point.height]}));
}

fn spectrum(lines: &mut Lines) {
    // From 7.885 cm/s (fresh 7.934) on Eq. 8 has roots, two at once.
    let w =
        if lines.one(&[true, false, false]) { lines.uniform(7.87, 7.95) } else { lines.decades(0.5, 238.65) };
    let depth = if lines.one(&[true, false]) { f64::INFINITY } else { lines.decades(0.5, 100.0) };
    let fetch = if lines.one(&[true, false]) { f64::INFINITY } else { lines.decades(1e3, 1e5) };
    let (water, density) = lines.one(&[(Salinity::Ocean, 1.025), (Salinity::Fresh, 1.0)]);
    let profile = Wind::FrictionVelocity(w).profile().expect("within Table 1");
    let s = Spectrum::new(SpectrumModel::Report, &profile, water, depth, fetch);
    let footprint = lines.footprint();
    let k = lines.decades(s.k_min, s.k2);
    let k_max = s.k_max(footprint, Readings::CORRECTED).expect("there are waves from 0.5 cm/s");
    let x = json!([w, depth, fetch, density, footprint, k]);
    lines.row("wave_numbers", x.clone(), json!({"float64": [s.k0, s.k1, s.k2, s.k_min, k_max]}));
    lines.row("spectrum", x, json!({"float64": [s.density(k), s.frequency(k)]}));

    let parameters = Parameters { depth, fetch, water, components: 5, ..drawn(w, footprint) };
    let waves = parameters.configure().expect("the parameters are valid").waves();
    let (k, azimuth) = (lines.decades(s.k_min, k_max), lines.uniform(-1.57, 1.57));
    let c = waves.component(k, 0.0, azimuth);
    let x = json!([w, depth, fetch, density, footprint, k, azimuth]);
    lines.row("component", x, json!({"float64": [c.amplitude, c.frequency]}));
}

/// A sea of drawn waves.
fn drawn(w: f64, footprint: f64) -> Parameters {
    Parameters {
        wind: Wind::FrictionVelocity(w),
        surface: Surface::Instance,
        footprint: Some(footprint),
        whitecaps: false,
        ..Parameters::default()
    }
}

/// Some waves of some sea.
fn some_waves(lines: &mut Lines, footprints: [f64; 2], w: [f64; 2]) -> Vec<Component> {
    let parameters = Parameters {
        components: lines.one(&[3, 5, 20]),
        wind_direction: lines.uniform(0.0, 360.0),
        ..drawn(lines.decades(w[0], w[1]), lines.decades(footprints[0], footprints[1]))
    };
    let waves = parameters.configure().expect("the parameters are valid").waves();
    let numbers = InstanceRng::new(Draws::Random, lines.rows as u64, (lines.uniform(0.0, 1e9)) as u64);
    waves.components(numbers).collect()
}

fn listed(waves: &[Component]) -> Value {
    waves.iter().map(|c| json!([c.wave_number, c.phase, c.azimuth, c.amplitude, c.frequency])).collect()
}

fn sums(lines: &mut Lines) {
    let waves = some_waves(lines, [0.01, 1.0], [1.0, 120.0]);
    let (azimuth, time) = (lines.uniform(0.0, TAU), lines.uniform(0.0, LATE));
    let place = [FAR * azimuth.cos(), FAR * azimuth.sin()];
    let surface = RealisedSurface::new(waves.iter().copied(), time);
    let mut points = [surface.point(place); 2];
    WaveSums::new(&surface).points(&[place], &mut points[1..]);
    let [float64, lanes] = points.map(|p| [p.height, p.slope[0], p.slope[1], p.acceleration]);
    let y = json!({"float64": float64, "lanes": lanes});
    lines.row("sum", json!([listed(&waves), place, time]), y);
}

/// Rays from 20 m and from 10 km to the neighbourhood of the origin.
fn cast(lines: &mut Lines) {
    let waves = some_waves(lines, [0.05, 0.3], [2.0, 100.0]);
    let surface = RealisedSurface::new(waves.iter().copied(), 0.0);
    let (theta, phi) = (lines.uniform(0.0, 89.5f64.to_radians()), lines.uniform(0.0, TAU));
    let direction = DVec3::new(theta.sin() * phi.cos(), theta.sin() * phi.sin(), -theta.cos());
    let aim = DVec3::new(lines.uniform(-5.0, 5.0), lines.uniform(-5.0, 5.0), 0.0);
    let origin = aim - lines.one(&[20.0, FAR]) / theta.cos().max(0.02) * direction;
    let Some(hit) = SurfaceRay::default().first_hit(&surface, origin, direction) else { return };
    let x = json!([listed(&waves), origin.to_array(), direction.to_array()]);
    lines.row("cast", x, json!({"float64": hit.to_array()}));
}

/// Vertices of a mesh of 512 waves, to 10 km, after an hour: as many as a median needs.
fn mesh(lines: &mut Lines) {
    let parameters = Parameters { components: 512, ..drawn(24.0, 0.1) };
    let water: Water = parameters.configure().expect("the parameters are valid");
    let layout = Layout { radius: FAR, vertices: 20_000, ..Layout::default() };
    let mesh = Mesh::new(&water, &layout).expect("20,000 vertices are enough");
    let (level, vertices) = (mesh.level(), mesh.vertices(LATE));
    lines.write(&json!({"waves": listed(&mesh.components)}));
    let mut first = 0;
    for ring in &mesh.grid.rings {
        let count = mesh.grid.on(ring);
        if lines.uniform(0.0, 1.0) < (0.025 * lines.rows as f64).max(60.0) / mesh.grid.rings.len() as f64 {
            let v = first + lines.uniform(0.0, count as f64 - 1.0) as usize;
            let place = [0, 1].map(|k| f64::from(level.texcoords[2 * v + k]));
            let corner = |of: &[f32], k: usize| f64::from(of[3 * v + k]);
            let y = [
                corner(&vertices.positions, 2),
                corner(&vertices.normals, 0),
                corner(&vertices.normals, 1),
                corner(&vertices.normals, 2),
            ];
            lines.row("mesh_vertex", json!([place, LATE, ring.footprint]), json!({"float32": y}));
        }
        first += count;
    }
}
