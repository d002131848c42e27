//! A drawn sea: heights and normals along a line, and a mesh.
//!
//! `cargo run --release -p prob-water --example surface`

use prob_water::surface::{Draws, InstanceRng};
use prob_water::{Layout, Mesh, Parameters, Surface, Wind};

fn main() -> Result<(), prob_water::Error> {
    let water = Parameters {
        wind: Wind::Beaufort(4),
        surface: Surface::Instance,
        components: 64,
        seed: 1,
        ..Parameters::default()
    }
    .configure()?;
    // Instance 0 of seed 1, at 2.5 s.
    let sea = water.waves().surface(InstanceRng::new(Draws::Stratified, 1, 0), 2.5);

    println!("{:>4}  {:>8}  normal", "x, m", "height, m");
    for step in 0..8 {
        let x = 5.0 * f64::from(step);
        let point = sea.point([x, 0.0]);
        println!("{x:>4}  {:>9.3}  {:.3?}", point.height, point.normal());
    }

    // Triangles as renderers take them, fine near the centre.
    let mesh = Mesh::new(&water, &Layout { radius: 200.0, vertices: 10_000, ..Layout::default() })?;
    let (level, vertices) = (mesh.level(), mesh.vertices(2.5));
    let (positions, faces) = (vertices.positions.len() / 3, level.faces.len() / 3);
    println!("{positions} vertices, {faces} triangles; the first vertex {:.2?} m", &vertices.positions[..3]);
    Ok(())
}
