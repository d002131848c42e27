//! What an exact ray cast costs as the number of waves grows, one thread, as lines of JSON; `validation/bench/surface.py`
//! compares it with a mesh.

use glam::DVec3;
use prob_water::surface::SurfaceRay;
use prob_water::surface::{Draws, InstanceRng};
use prob_water::{Parameters, RealisedSurface, Surface, Wind};
use rand::{Rng, SeedableRng, rngs::StdRng};
use std::hint::black_box;
use std::time::Instant;

fn main() {
    const RAYS: usize = 2000;
    for components in [32, 128, 512] {
        let water = Parameters {
            wind: Wind::FrictionVelocity(8.0),
            surface: Surface::Instance,
            footprint: Some(0.15),
            components,
            ..Parameters::default()
        };
        let water = water.configure().expect("the parameters are valid");
        let sea =
            RealisedSurface::new(water.waves().components(InstanceRng::new(Draws::Stratified, 1, 0)), 0.0);
        // From 10 m, 2 to 60 degrees below the horizon.
        let mut rng = StdRng::seed_from_u64(1);
        let looks: Vec<[f64; 3]> = (0..RAYS)
            .map(|_| {
                let (down, turn) = (
                    rng.random_range(2.0f64..60.0).to_radians(),
                    rng.random_range(0.0..std::f64::consts::TAU),
                );
                let (sin, cos): (f64, f64) = f64::sin_cos(turn);
                [down.cos() * cos, down.cos() * sin, -down.sin()]
            })
            .collect();
        let mut path = SurfaceRay::default();
        let start = Instant::now();
        for look in &looks {
            let look = DVec3::from(black_box(*look));
            black_box(path.first_hit(&sea, DVec3::new(0.0, 0.0, 10.0), look));
        }
        let ns = start.elapsed().as_secs_f64() * 1e9 / RAYS as f64;
        println!(r#"{{"components": {components}, "ns_per_ray": {ns:.0}}}"#);
    }
}
