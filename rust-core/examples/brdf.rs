//! The BRDF of a level surface in wind: a value, and a draw of the reflected direction.
//!
//! `cargo run --release -p prob-water --example brdf`

use prob_water::{Fresnel, Parameters, Wind};

fn main() -> Result<(), prob_water::Error> {
    let water = Parameters {
        wind: Wind::Speed { speed: 7.0, height: 10.0 },
        wind_direction: 90.0,
        wavelength: 0.532,
        fresnel: Fresnel::Exact,
        ..Parameters::default()
    }
    .configure()?;
    println!("{water}");

    // Unit vectors away from the surface, z up: to the source, to observers in the plane of incidence.
    let lobe = water.lobe()?;
    let direction = |theta: f64| [theta.to_radians().sin(), 0.0, theta.to_radians().cos()];
    let source = direction(-60.0);
    println!("source at 60 degrees of zenith angle\n{:>8}  {:>10}", "observer", "f, 1/sr");
    for theta in [0.0, 30.0, 50.0, 60.0, 70.0, 80.0] {
        println!("{theta:>8}  {:10.3e}", lobe.eval(source, direction(theta), None));
    }

    // A reflected direction from three uniform numbers of [0, 1), and what it weighs.
    let sample = lobe.sample(source, None, [0.3, 0.7, 0.2]);
    // No density: the draw is lost below the horizon.
    if sample.pdf > 0.0 {
        let [x, y, z] = sample.direction;
        println!("drawn: ({x:.3}, {y:.3}, {z:.3}), weight {:.3}", sample.f * z / sample.pdf);
    }
    Ok(())
}
