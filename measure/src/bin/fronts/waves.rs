//! Rays cast onto a drawn sea: the exact cast, and what a mesh of the same waves is compared with.

use crate::{point, rms, seconds, write};
use glam::DVec3;
use prob_water::surface::SurfaceRay as Ray;
use prob_water::{Draws, Ensemble, Parameters, RealisedSurface, Surface, Wind};
use rand::{Rng, SeedableRng, rngs::StdRng};
use std::hint::black_box;
use std::path::Path;

/// Rays from 10 m up, 10 to 60 degrees below the horizon; and places looked at from above, within 50 m.
const RAYS: usize = 2000;
const PLACES: usize = 20_000;

/// The front `cast`: seconds per ray. The sea is the shape's with its defaults but for w* = 8 cm/s. Writes the rays'
/// directions with where they hit and the normals there, and places with heights and slopes.
pub fn front(repeats: usize, directory: &Path) {
    let water = Parameters {
        wind: Wind::FrictionVelocity(8.0),
        surface: Surface::Instance,
        footprint: Some(0.15),
        components: 512,
        ..Parameters::default()
    };
    let water = water.configure().expect("the parameters are valid");
    let sea = Ensemble {
        draws: Draws::Stratified,
        waves: water.fading_waves(),
        ..Ensemble::new(&water).expect("the sea has drawn waves")
    };
    let waves = sea.components(0).1.map(|wave| wave.seen_at(0.15)).filter(|wave| wave.amplitude > 0.0);
    let sea = RealisedSurface::new(waves, 0.0);

    let mut rng = StdRng::seed_from_u64(1);
    let looks: Vec<_> = (0..RAYS)
        .map(|_| {
            let (down, turn) =
                (rng.random_range(10.0f64..60.0).to_radians(), rng.random_range(0.0..std::f64::consts::TAU));
            DVec3::new(down.cos() * turn.cos(), down.cos() * turn.sin(), -down.sin())
        })
        .collect();
    let origin = DVec3::new(0.0, 0.0, 10.0);
    let mut path = Ray::default();
    let mut rows = vec![];
    let times: Vec<_> = (0..=repeats)
        .map(|_| {
            rows.clear();
            let all = seconds(|| {
                for look in &looks {
                    let hit = path.first_hit(&sea, origin, black_box(*look)).expect("no wave is that high");
                    rows.push((*look, hit, sea.point([hit.x, hit.y])));
                }
            });
            all / RAYS as f64
        })
        .collect();
    // No tolerance can be set; what it leaves is how far above or below the waves a hit lies.
    let off = rms(rows.iter().map(|(_, hit, point)| hit.z - point.height));
    point("cast", "exact cast", "", off, &times[1..]);

    let hits = rows.iter().flat_map(|(look, hit, point)| {
        [look.to_array(), hit.to_array(), point.normal()].into_iter().flatten()
    });
    write(&directory.join("rays.f64"), hits.map(f64::to_le_bytes));
    let places = (0..PLACES).flat_map(|_| {
        let (r, turn): (f64, f64) =
            (50.0 * rng.random::<f64>().sqrt(), rng.random_range(0.0..std::f64::consts::TAU));
        let place = [r * turn.cos(), r * turn.sin()];
        let point = sea.point(place);
        [place[0], place[1], point.height, point.slope[0], point.slope[1]]
    });
    write(&directory.join("places.f64"), places.map(f64::to_le_bytes));
}
