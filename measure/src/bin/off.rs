//! What is off costs nothing: the same evaluations with a term, by code that looks at its switch and finds it off, and by
//! code compiled without it. `validation/bench/off.py` counts their instructions.
//!
//! `cargo run --release -p prob-water-measure --bin off -- CASE with|switched|without COUNT`

use prob_water::{Fresnel, Lobe, Parameters, Readings, SlopeMeasure, Wind};
use std::hint::black_box;

/// The lobe with switches that the compiler knows.
macro_rules! without {
    ($lobe:expr, whitecaps) => {{
        let mut lobe = $lobe;
        lobe = lobe.with_whitecaps(0.0);
        lobe
    }};
    ($lobe:expr, $switch:ident) => {{
        let mut lobe = $lobe;
        lobe.facets.$switch = false;
        // A bound belongs to shadowing.
        lobe.facets.bounded = false;
        lobe
    }};
}

fn run(count: usize, eval: impl Fn([f32; 3], [f32; 3]) -> f32) {
    let mut total = 0.0;
    for k in 0..count {
        let t = k as f32 / count as f32;
        let (i, o) =
            ([0.6 * t, 0.0, (1.0 - 0.36 * t * t).sqrt()], [-0.5 * t, 0.1, (0.99 - 0.25 * t * t).sqrt()]);
        total += eval(black_box(i), black_box(o));
    }
    black_box(total);
}

fn main() {
    let arguments: Vec<_> = std::env::args().skip(1).collect();
    let [case, code, count] = &arguments[..] else { panic!("CASE with|switched|without COUNT") };
    let count = count.parse().expect("COUNT is a number");
    // A wind in force whose bound is off.
    let mut parameters = Parameters { wind: Wind::FrictionVelocity(24.0), ..Parameters::default() };
    let on = code == "with";
    match case.as_str() {
        "whitecaps" => parameters.whitecaps = on,
        "no_wind_for_whitecaps" => parameters.wind = Wind::FrictionVelocity(0.0),
        "shadowing" => parameters.shadowing = on,
        "gram_charlier" => parameters.gram_charlier = on,
        // These are off unless asked for.
        "exact_fresnel" if on => parameters.fresnel = Fresnel::Exact,
        "as_printed" if on => parameters.readings = Readings::AsPrinted,
        "tilt_angles" if !on => parameters.slope_measure = SlopeMeasure::Slope,
        "visible_bound" => parameters.wind = Wind::FrictionVelocity(4.0),
        "oblique_wind" if on => parameters.wind_direction = 37.0,
        "exact_fresnel" | "as_printed" | "tilt_angles" | "oblique_wind" => {}
        _ => panic!("{case}"),
    }
    let mut lobe: Lobe<f32> = parameters.configure().expect("the parameters are valid").local_lobe().cast();
    if case == "visible_bound" && !on {
        assert!(lobe.facets.bounded);
        lobe.facets.bounded = false;
    }
    let lobe = black_box(lobe);
    if code != "without" {
        run(count, |i, o| lobe.eval(i, o, None));
        return;
    }
    match case.as_str() {
        "whitecaps" | "no_wind_for_whitecaps" => {
            run(count, |i, o| without!(lobe, whitecaps).eval(i, o, None));
        }
        "shadowing" => run(count, |i, o| without!(lobe, shadowing).eval(i, o, None)),
        _ => run(count, |i, o| without!(lobe, gram_charlier).eval(i, o, None)),
    }
}
