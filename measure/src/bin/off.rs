//! What is off costs nothing: the same evaluations with a term, by code that looks at its switch and finds it off, and by
//! code compiled without it. `validation/bench/off.py` counts their instructions.
//!
//! `cargo run --release -p prob-water-measure --bin off -- CASE with|switched|without COUNT`, and, for lanes, which take several
//! times as many where one function is not inlined, `off LEVEL eval|pdf|sample COUNT`.

use prob_water::batch::{Columns, SampleColumns, Sources};
use prob_water::simd::SimdLevel;
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

/// Rows to pass over in lanes.
const ROWS: usize = 1000;

/// `operation` of `count` rows in the vectors of a level.
fn run_lanes(level: SimdLevel, operation: &str, count: usize) {
    assert!(level.is_available());
    let lobe: Lobe<f32> =
        Parameters::default().configure().expect("the defaults are valid").local_lobe().cast();
    let t: Vec<_> = (0..ROWS).map(|k| k as f32 / ROWS as f32).collect();
    let (x, zero) = (t.iter().map(|t| 0.6 * t).collect::<Vec<_>>(), vec![0.0; ROWS]);
    let z: Vec<_> = x.iter().map(|x| (1.0 - x * x).sqrt()).collect();
    let columns = Columns::new([&x, &zero, &z], [&zero, &x, &z], None).expect("they are unit vectors");
    let sources = Sources::new([&x, &zero, &z], [&t, &x, &t], None).expect("they are of [0, 1)");
    let (mut out, mut whitecap) = ([0; 5].map(|_| vec![0.0; ROWS]), vec![false; ROWS]);
    for _ in 0..count / ROWS {
        let [x, y, z, pdf, f] = black_box(&mut out).each_mut().map(Vec::as_mut_slice);
        match operation {
            "eval" => columns.eval_on(level, black_box(&lobe), f),
            "pdf" => columns.pdf_on(level, black_box(&lobe), pdf),
            _ => {
                let out = SampleColumns { to_observer: [x, y, z], pdf, f, whitecap: &mut whitecap };
                sources.sample_on(level, black_box(&lobe), out)
            }
        }
        .expect("as many rows");
    }
}

fn main() {
    let arguments: Vec<_> = std::env::args().skip(1).collect();
    let [case, code, count] = &arguments[..] else { panic!("CASE with|switched|without COUNT") };
    let count = count.parse().expect("COUNT is a number");
    if let Some(level) = SimdLevel::ALL.into_iter().find(|level| level.name() == case) {
        return run_lanes(level, code, count);
    }
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
        "unsigned_angles" if on => parameters.readings = Readings::EQ_71_73,
        "tilt_angles" if !on => parameters.slope_measure = SlopeMeasure::Slope,
        "visible_bound" => parameters.wind = Wind::FrictionVelocity(4.0),
        "oblique_wind" if on => parameters.wind_direction = 37.0,
        "exact_fresnel" | "unsigned_angles" | "tilt_angles" | "oblique_wind" => {}
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
