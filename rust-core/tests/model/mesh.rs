//! The mesh of a realised sea: its triangles, its vertices against the surface, and the statistics of what it shows.

use crate::common::{water, worse};
use prob_water::grid::{CELLS, Grid};
use prob_water::mesh::Vertices;
use prob_water::spectrum::spreading;
use prob_water::surface::Waves;
use prob_water::surface::share;
use prob_water::{Draws, Ensemble, Layout, Mesh, Parameters, RealisedSurface, SlopeBudget, Surface, Water};
use rayon::prelude::*;
use std::collections::HashMap;
use std::f64::consts::PI;

fn sea(w: f64, footprint: f64, seed: u64) -> Water {
    water(w, |p| {
        p.surface = Surface::Instance;
        p.footprint = Some(footprint);
        p.components = 512;
        p.seed = seed;
        p.whitecaps = true;
        p.wind_direction = 40.0;
    })
}

fn small(radius: f64, vertices: u64) -> Layout {
    Layout { radius, vertices, ..Layout::default() }
}

/// Every triangle has an area as seen from above, every inner edge belongs to two of them in opposite directions, the
/// outer ones together are the outline, and cells are about as wide as high.
#[test]
fn triangles_cover_the_plane_once() {
    let sector = |opening| Layout { azimuth: 70.0, opening, ..small(2e4, 30_000) };
    let at = Layout { center: [500.0, -200.0], ..small(300.0, 20_000) };
    for layout in [small(2e4, 40_000), small(3.0, 40_000), small(0.3, 100), at, sector(300.0), sector(40.0)] {
        let mesh = Mesh::new(&sea(8.0, 0.15, 0), &layout).unwrap();
        let level = mesh.level();
        let vertices = mesh.grid.vertices as usize;
        assert!(mesh.grid.vertices <= layout.vertices);
        assert_eq!(level.texcoords.len(), 2 * vertices);
        assert_eq!(level.footprints.len(), vertices);
        assert_eq!(level.faces.len(), 3 * mesh.grid.faces as usize);
        let place = |i: u32| [0, 1].map(|axis| f64::from(level.texcoords[2 * i as usize + axis]));
        let (mut edges, mut area, mut worst) = (HashMap::new(), 0.0, 0.0f64);
        for corners in level.faces.chunks(3) {
            let [a, b, c] = [0, 1, 2].map(|i| place(corners[i]));
            let twice = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
            assert!(twice > 0.0);
            area += 0.5 * twice;
            for side in 0..3 {
                let (from, to) = (corners[side], corners[(side + 1) % 3]);
                assert!(edges.insert((from, to), ()).is_none());
                let ([x, y], [u, v]) = (place(from), place(to));
                worst = worse(worst, (u - x).hypot(v - y).powi(2) / twice);
            }
        }
        let open: Vec<_> = edges.keys().filter(|(a, b)| !edges.contains_key(&(*b, *a))).collect();
        // Euler: as many outer edges as a disc has.
        assert_eq!(open.len(), 2 * vertices - 2 - mesh.grid.faces as usize);
        let expected = 0.5 * layout.opening.to_radians() * layout.radius.powi(2);
        assert!((area / expected - 1.0).abs() < 0.2 && area < expected);
        assert!(worst < 4.0, "{layout:?}: edge^2/area {worst}");
        let last = mesh.grid.rings.last().unwrap();
        assert_eq!(last.radius, layout.radius);
        for ring in &mesh.grid.rings[1..] {
            let expected = (CELLS * ring.radius * mesh.grid.growth).max(0.15);
            assert!((expected - ring.footprint).abs() < 1e-9);
        }
    }
}

/// The budget is used, and refusals come from counts alone.
#[test]
fn budgets() {
    for vertices in [3000, 100_000, 1_000_000, 30_000_000] {
        let grid = Grid::new(&Layout { memory: 1 << 20, ..small(2e4, vertices) }, 0.15).unwrap();
        assert!(
            (vertices * 9 / 10 + 1..=vertices).contains(&grid.vertices),
            "{} of {vertices}",
            grid.vertices
        );
    }
    for (parameter, layout, footprint) in [
        ("vertices", small(2e4, 100), 0.15),
        ("vertices", small(2e4, 1 << 40), 0.15),
        ("memory", Layout { memory: 100, ..small(2e4, 1_000_000) }, 0.15),
        ("memory", small(2e4, 400_000_000), 0.15),
        ("radius", small(f64::NAN, 10_000), 0.15),
        ("radius", small(2e7, 10_000), 0.15),
        ("footprint", small(2e4, 10_000), f64::INFINITY),
        ("opening", Layout { opening: 0.0, ..Layout::default() }, 0.15),
        ("opening", Layout { opening: 361.0, ..Layout::default() }, 0.15),
        ("azimuth", Layout { azimuth: f64::NAN, ..Layout::default() }, 0.15),
        ("center", Layout { center: [0.0, 1e6], ..Layout::default() }, 0.15),
    ] {
        let error = Grid::new(&layout, footprint).unwrap_err();
        assert_eq!(error.parameters(), [parameter], "{error}");
    }
}

/// Where the footprint is the centre's, vertices are those of the sea as the command draws it.
#[test]
fn vertices_are_the_surface() {
    let water = sea(16.0, 0.2, 3);
    let mesh = Mesh::new(&water, &small(4.0, 100_000)).unwrap();
    assert_eq!(mesh.grid.growth, 0.0);
    let all =
        Ensemble { draws: Draws::Stratified, waves: water.fading_waves(), ..Ensemble::new(&water).unwrap() };
    let truth = RealisedSurface::new(all.components(0).1.map(|c| c.seen_at(0.2)), 7.5);
    let Vertices { positions, normals, .. } = mesh.vertices(7.5);
    for (position, normal) in positions.chunks(3).zip(normals.chunks(3)) {
        let point = truth.point([position[0], position[1]].map(f64::from));
        assert!((f64::from(position[2]) - point.height).abs() < 1e-7 * (1.0 + point.height.abs()));
        for (found, expected) in normal.iter().zip(point.normal()) {
            assert!((f64::from(*found) - expected).abs() < 1e-7);
        }
    }
}

/// Variances of the height, m^2, and of the slopes upwind and crosswind that a footprint leaves to the waves.
fn integrals(waves: &Waves, footprint: f64) -> [f64; 3] {
    let Some([low, high]) = waves.log_range else { return [0.0; 3] };
    let n = 20_000;
    let step = (high - low) / f64::from(n);
    let mut sums = [0.0; 2];
    for i in 0..n {
        let k = (low + (f64::from(i) + 0.5) * step).exp();
        let energy = waves.spectrum.density(k) * k * step * share(100.0 * k, footprint);
        sums[0] += 1e-4 * energy;
        sums[1] += k * k * energy;
    }
    let turn = PI / 1000.0;
    let along = |i: i32| {
        let angle = -0.5 * PI + (f64::from(i) + 0.5) * turn;
        spreading(angle) * angle.cos().powi(2) * turn
    };
    let along: f64 = (0..1000).map(along).sum();
    [sums[0], sums[1] * along, sums[1] * (1.0 - along)]
}

/// One instance of 512 components has the spectrum's variances: within a few percent, and on average within 1.
#[test]
fn stratified_draws_carry_the_spectrum() {
    const SEEDS: u64 = 100;
    for w in [4.0, 8.0, 24.0, 56.0] {
        let water = sea(w, 0.15, 0);
        let waves = water.waves();
        let expected = integrals(&waves, 1e-9);
        let ratios = (0..SEEDS).map(|seed| {
            let mut found = [0.0; 3];
            let sea =
                Ensemble { draws: Draws::Stratified, ..Ensemble::new(&self::sea(w, 0.15, seed)).unwrap() };
            for c in sea.components(0).1 {
                let energy = 0.5 * c.amplitude.powi(2);
                let along = (c.azimuth - waves.wind_azimuth).cos().powi(2);
                let slope = energy * c.wave_number.powi(2);
                for (sum, term) in found.iter_mut().zip([energy, slope * along, slope * (1.0 - along)]) {
                    *sum += term;
                }
            }
            std::array::from_fn::<_, 3, _>(|m| found[m] / expected[m])
        });
        let ratios: Vec<_> = ratios.collect();
        for (m, name) in ["height", "upwind", "crosswind"].iter().enumerate() {
            let mean = ratios.iter().map(|r| r[m]).sum::<f64>() / SEEDS as f64;
            let worst = ratios.iter().map(|r| (r[m] - 1.0).abs()).fold(0.0, worse);
            assert!((mean - 1.0).abs() < 0.01 && worst < 0.08, "w* {w} {name}: {mean} {worst}");
        }
    }
}

/// Rows of (distance, variance of the interpolated normals' slopes, upwind and crosswind) averaged over seeds: at places
/// drawn evenly over the ring of each distance, normals are interpolated as a renderer does.
fn shown(sea: impl Fn(u64) -> Water + Sync, distances: &[f64], seeds: u64) -> Vec<[f64; 2]> {
    let sums: Vec<_> = (0..seeds)
        .into_par_iter()
        .map(|seed| {
            let mesh = Mesh::new(&sea(seed), &small(2e4, 50_000)).unwrap();
            let (level, vertices) = (mesh.level(), mesh.vertices(0.0));
            let (sin, cos) = 40f64.to_radians().sin_cos();
            let mut rows = vec![[0.0; 3]; distances.len()];
            for corners in level.faces.chunks(3) {
                let of = |array: &[f32], width: usize, weights: [f64; 3]| -> [f64; 3] {
                    std::array::from_fn(|m| {
                        let value =
                            |i: usize| f64::from(array[width * corners[i] as usize + m.min(width - 1)]);
                        (0..3).map(|i| weights[i] * value(i)).sum()
                    })
                };
                let [x, y, _] = of(&level.texcoords, 2, [1.0 / 3.0; 3]);
                let r = x.hypot(y);
                let Some(row) = distances.iter().position(|d| (0.7..1.4).contains(&(r / d))) else {
                    continue;
                };
                // The mean over a triangle of a quadratic: its edges' middles.
                for middle in [[0.5, 0.5, 0.0], [0.5, 0.0, 0.5], [0.0, 0.5, 0.5]] {
                    let [nx, ny, nz] = of(&vertices.normals, 3, middle);
                    let (sx, sy) = (nx / nz, ny / nz);
                    rows[row][0] += 1.0;
                    rows[row][1] += (sx * cos + sy * sin).powi(2);
                    rows[row][2] += (sy * cos - sx * sin).powi(2);
                }
            }
            rows
        })
        .collect();
    let mean = |row: usize, m: usize| {
        let total = |m: usize| sums.iter().map(|rows| rows[row][m]).sum::<f64>();
        total(m) / total(0)
    };
    (0..distances.len()).map(|row| [mean(row, 1), mean(row, 2)]).collect()
}

/// The slopes' variance between vertices, facets included, is the sea's within 5 %, whatever interpolation takes.
#[test]
fn variance_is_complete_at_every_distance() {
    let distances = [2.0, 10.0, 50.0, 300.0, 2e3, 1e4];
    for (w, slope_budget) in
        [(4.0, SlopeBudget::Report), (24.0, SlopeBudget::Report), (8.0, SlopeBudget::Closed)]
    {
        let sea = |seed| Parameters { slope_budget, ..sea(w, 0.15, seed).parameters }.configure().unwrap();
        let water = sea(0);
        let mesh = Mesh::new(&water, &small(2e4, 50_000)).unwrap();
        for (r, found) in distances.iter().zip(shown(sea, &distances, 16)) {
            let at = (CELLS * mesh.grid.growth * r).max(0.15);
            let facets = water.facet_variances(at);
            let [_, u, c] = integrals(&water.fading_waves(), at);
            let more = water.facet_variances(mesh.facets(at));
            let expected = match slope_budget {
                SlopeBudget::Report => [u + facets[0], c + facets[1]],
                SlopeBudget::Closed => water.parameters.slopes.total(&water.wind),
            };
            let lost = [1.0 - (found[0] + more[0]) / expected[0], 1.0 - (found[1] + more[1]) / expected[1]];
            let worst = worse(lost[0].abs(), lost[1].abs());
            assert!(worst < 0.05, "w* {w} r {r} D {at}: lost {lost:?} of {expected:?}");
        }
    }
}

/// Mean of the whitecaps' probability over Eq. 51's fraction in many seas, and its standard error.
fn whitecaps(w: f64, footprint: f64, layout: Layout, seeds: u64) -> [f64; 2] {
    let expected = sea(w, footprint, 0).whitecap_fraction;
    let ratios = (0..seeds).into_par_iter().map(|seed| {
        let mesh = Mesh::new(&sea(w, footprint, seed), &layout).unwrap();
        let whitecaps = mesh.vertices(0.0).whitecaps;
        assert!(whitecaps.iter().all(|p| (0.0..=1.0).contains(p)));
        whitecaps.iter().map(|p| f64::from(*p)).sum::<f64>() / whitecaps.len() as f64 / expected
    });
    let ratios: Vec<f64> = ratios.collect();
    let mean = ratios.iter().sum::<f64>() / seeds as f64;
    let error = ratios.iter().map(|x| (x - mean).powi(2)).sum::<f64>().sqrt() / seeds as f64;
    println!("w* {w} D {footprint}: {mean:.3} +- {error:.3}");
    [mean, error]
}

/// A line from the centre, all of smallest cells.
fn line(length: f64) -> Layout {
    Layout { opening: 0.01, ..small(length, 100_000) }
}

/// The mean of the whitecaps' probability is Eq. 51's fraction, far and near.
#[test]
fn whitecap_fraction() {
    for w in [24.0, 40.0, 56.0] {
        let [mean, _] = whitecaps(w, 20.0, small(2e4, 20_000), 4);
        assert!((mean - 1.0).abs() < 0.02);
        let [mean, error] = whitecaps(w, 0.6, line(300.0), 64);
        assert!((mean - 1.0).abs() < 0.02 + 4.0 * error && error < 0.1);
    }
    // None in a calm, none where they are switched off.
    let off = water(24.0, |p| {
        p.surface = Surface::Instance;
        p.whitecaps = false;
    });
    for water in [sea(0.0, 0.15, 0), off] {
        let mesh = Mesh::new(&water, &small(100.0, 10_000)).unwrap();
        assert!(mesh.vertices(0.0).whitecaps.is_empty());
    }
}

/// The same near: no bias beyond 2 %, and what the draws leave open.
#[test]
#[ignore = "long: `cargo xtask verify` runs it"]
fn whitecap_fraction_of_small_cells() {
    for w in [24.0, 40.0, 56.0] {
        for (footprint, seeds) in [(0.15, 200), (0.6, 600)] {
            let [mean, error] = whitecaps(w, footprint, line(1e3), seeds);
            assert!((mean - 1.0).abs() < 0.02 + 3.0 * error && error < 0.035);
        }
    }
}
