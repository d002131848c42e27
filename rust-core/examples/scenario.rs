//! The BRDF of a drawn sea is random: its mean and spread for a laser and two observers.
//!
//! `cargo run --release -p prob-water --example scenario`

use prob_water::{Aim, Engagement, Ensemble, Exact, Parameters, Surface, Wind};

fn main() -> Result<(), prob_water::Error> {
    let water = Parameters {
        wind: Wind::FrictionVelocity(8.0), // cm/s
        surface: Surface::Instance,
        footprint: Some(0.15), // m
        instances: 1000,
        ..Parameters::default()
    }
    .configure()?;

    // A laser 10 km away at 30 degrees of incidence; m, s.
    let observers = [[5000.0, 0.0, 8660.0], [7000.0, 0.0, 7000.0]];
    let engagement = Engagement::new(0.0, [-5000.0, 0.0, 8660.0], Aim::Target([0.0; 3]), &observers)?;

    let ensemble = Ensemble::new(&water)?;
    ensemble.check(&engagement)?;
    let samples = ensemble.sample(std::slice::from_ref(&engagement), &|_casts| ())?;
    let exact = Exact::new(&water)?.means(&engagement);
    println!("{} drawn seas, 1/sr", samples.instances());
    for (observer, exact) in exact.iter().enumerate() {
        // The share of seas in which f is above 0.3 1/sr.
        let drawn = samples.statistics(0, observer, &[0.3])?;
        println!(
            "observer {observer}: mean {:.4} +- {:.4}, spread {:.4}, exact mean {:.4}, above 0.3 in {:.1} %",
            drawn.mean,
            drawn.sem,
            drawn.std,
            exact.f,
            100.0 * drawn.over[0]
        );
    }
    Ok(())
}
