//! f, density and draws of the closed form: finite, not negative, nothing from below the horizon, and float32 beside
//! float64.

use crate::draw::Draw;
use crate::rows::{Block, ROWS, Row};
use crate::tally::{Tally, fine, shown};
use prob_water::batch::{Columns, Rows, UNIT_TOLERANCE};
use prob_water::real::{Vec3, dot};
use prob_water::{Lobe, Parameters, Scalar, SlopeMeasure, Water};

/// A way of evaluating a block in float32, each beside float64.
type Single = fn(&Block, &Lobe<f32>, &mut [f32]);

/// All of them, with the names of their errors on level water and about tilted normals. Whatever else evaluates rows in
/// float32 takes its place here, and is held to float64.
const SINGLE: [([&str; 2], Single); 2] = [
    (["float32, row by row", "float32, row by row, tilted normals"], row_by_row),
    (["float32, in lanes", "float32, in lanes, tilted normals"], in_lanes),
];

fn row_by_row(block: &Block, lobe: &Lobe<f32>, f: &mut [f32]) {
    for ([i, o, n], f) in block.single.iter().zip(f) {
        *f = lobe.eval(*i, *o, *n);
    }
}

fn in_lanes(block: &Block, lobe: &Lobe<f32>, f: &mut [f32]) {
    let [i, o, n] = block.columns.each_ref().map(|v| v.each_ref().map(Vec::as_slice));
    Columns::new(i, o, Some(n)).expect("normals point up").eval(lobe, f).expect("as many numbers as rows");
    // Rows on level water once more, as a flat sea's.
    let level: Vec<_> = (0..ROWS).filter(|row| block.single[*row][2] == [0.0, 0.0, 1.0]).collect();
    let of = |columns: [&[f32]; 3]| columns.map(|x| level.iter().map(|row| x[*row]).collect::<Vec<_>>());
    let [i, o] = [of(i), of(o)];
    let [i, o] = [&i, &o].map(|v| v.each_ref().map(Vec::as_slice));
    let mut found = vec![f32::NAN; level.len()];
    Columns::new(i, o, None).expect("unit vectors").eval(lobe, &mut found).expect("as many numbers as rows");
    level.into_iter().zip(found).for_each(|(row, found)| f[row] = found);
}

/// Relative error of float32 that is allowed.
const BOUND: f64 = 1e-4;
/// U^2 + C^2 up to which it holds.
const REACH: f64 = 55.0;
/// Cosines to the normal from which on it holds: to 89.9999 degrees.
const GRAZING: f64 = 1.7e-6;
/// Vertical components of normals from which on it holds: to 89.9 degrees. Beyond, tilts are quotients of what hardly differs
/// from 0.
const LYING: f64 = 1.7e-3;
/// Indices from which on it holds; water's are, from 0.2 to 200 micrometres. Next to 1 rounding decides what is left of
/// 1 - cos zeta, and so of rho.
const INDEX: f64 = 1.1;
/// Values that float32 holds to four digits, and not yet cut off at its end.
const RANGE: std::ops::Range<f64> = 1e-34..1e37;

/// One sea and its rows.
pub fn block(draw: &mut Draw, tally: &mut Tally) {
    let sea = draw.flat_sea();
    let water = sea.configure().expect("within the ranges of the vocabulary");
    let block = Block::new(draw, &water);
    let lobe = water.local_lobe();
    let single = lobe.cast::<f32>();

    let f: Vec<f64> = block.wide.iter().map(|[i, o, n]| lobe.eval(*i, *o, *n)).collect();
    tally.count("f, float64", ROWS as u64);
    values(tally, &sea, "f of float64", &block, &f);
    let gaussian = Parameters { gram_charlier: false, ..sea }.configure().expect("as the sea").local_lobe();
    let size = |row: &Row| gaussian.eval(row[0], row[1], row[2]);
    for (names, way) in SINGLE {
        let mut found = vec![f32::NAN; ROWS];
        way(&block, &single, &mut found);
        let name = names[0];
        tally.count(name, ROWS as u64);
        let found: Vec<f64> = found.into_iter().map(f64::from).collect();
        values(tally, &sea, name, &block, &found);
        if block.alike && water.ior >= INDEX {
            compare(tally, &sea, &water, names, &block, size, &f, &found);
        }
    }
    // Rows are what a caller may give: none of them is refused.
    if draw.pick(64) == 0 {
        let [i, o, n] = [0, 1, 2].map(|k| block.single.iter().map(|row| row[k]).collect::<Vec<_>>());
        let checked = Rows::new(&i, &o, Some(&n)).map(|_| ());
        tally.check(checked.is_ok(), &sea, "rows refused", || format!("{checked:?}"));
    }
    densities(draw, tally, &sea, &block, &lobe, &single);
}

/// Every value finite and not negative, and 0 where a direction lies below the horizon.
fn values(tally: &mut Tally, sea: &Parameters, name: &str, block: &Block, f: &[f64]) {
    for (row, f) in block.wide.iter().zip(f) {
        tally.check(fine(*f), sea, name, || shown(row, &[*f]));
        tally.check(*f == 0.0 || !below(row), sea, "light from below", || {
            format!("{name}: {}", shown(row, &[*f]))
        });
    }
}

/// Surely below the horizon of the normal, whatever the rounding; on a level surface also where just on it.
fn below([i, o, n]: &Row) -> bool {
    let behind = |v: &[f64; 3]| {
        if *n == [0.0, 0.0, 1.0] { v[2] <= 0.0 } else { dot(*v, *n) < -1e-6 }
    };
    behind(i) || behind(o)
}

/// One way in float32 beside float64: within [`BOUND`] of the lobe without Gram-Charlier, in its domain.
#[allow(clippy::too_many_arguments)]
fn compare(
    tally: &mut Tally,
    sea: &Parameters,
    water: &Water,
    names: [&'static str; 2],
    block: &Block,
    size: impl Fn(&Row) -> f64,
    exact: &[f64],
    found: &[f64],
) {
    for ((row, exact), found) in block.wide.iter().zip(exact).zip(found) {
        let [i, o, n] = row;
        let (ci, cr) = (dot(*i, *n), dot(*o, *n));
        if ci < GRAZING || cr < GRAZING || deviations(water, row) >= REACH {
            continue;
        }
        let size = size(row);
        if !RANGE.contains(&size) {
            continue;
        }
        let level = *n == [0.0, 0.0, 1.0];
        if n[2] < LYING {
            continue;
        }
        let name = names[usize::from(!level)];
        let error = (found - exact).abs() / size;
        let place = || {
            format!(
                "{} sigma2 {:.1}\n      {}",
                shown(row, &[*exact, *found]),
                deviations(water, row),
                in_short(sea)
            )
        };
        tally.check(error <= BOUND, sea, name, || {
            format!("error {error:.2e}, allowed {BOUND:.2e}: {}", place())
        });
        tally.errors(name).take(error, place);
    }
}

/// U^2 + C^2 of the facet that mirrors the source to the observer.
fn deviations(water: &Water, [i, o, n]: &Row) -> f64 {
    let f = &water.local_lobe().facets;
    let h = [0, 1, 2].map(|k| i[k] + o[k]);
    let tilt = |axis: [f64; 2]| {
        let along = |v: &[f64; 3]| v[0] * axis[0] + v[1] * axis[1];
        let (sin, cos) = (along(&h) * n[2] - h[2] * along(n), h[2] * n[2] + along(&h) * along(n));
        match water.parameters.slope_measure {
            SlopeMeasure::Angle => sin.atan2(cos),
            SlopeMeasure::Slope if cos > 0.0 => sin / cos,
            SlopeMeasure::Slope => f64::INFINITY,
        }
    };
    let u = tilt([f.wind.cos, f.wind.sin]) / f.sigma_u;
    let c = tilt([-f.wind.sin, f.wind.cos]) / f.sigma_c;
    u * u + c * c
}

/// Density and draws of both precisions.
fn densities(
    draw: &mut Draw,
    tally: &mut Tally,
    sea: &Parameters,
    block: &Block,
    wide: &Lobe<f64>,
    single: &Lobe<f32>,
) {
    // Every other row, and every fourth: they cost more than f.
    let start = draw.pick(4) as usize;
    for at in (start % 2..ROWS).step_by(2) {
        let (row, [i, o, n]) = (&block.wide[at], block.single[at]);
        let found = [wide.pdf(row[0], row[1], row[2]), single.pdf(i, o, n).into()];
        let fine = found.iter().all(|x| x.is_finite() && *x >= 0.0);
        tally.check(fine, sea, "density", || shown(row, &found));
    }
    tally.count("(density, float64)", ROWS as u64 / 2);
    tally.count("(density, float32)", ROWS as u64 / 2);
    for at in (start..ROWS).step_by(4) {
        let u = draw.uniforms();
        let ([i, _, n], [i32, _, n32]) = (block.wide[at], block.single[at]);
        sampled(tally, sea, "draw of float64", wide, i, n, u);
        // The largest below 1 of float32.
        let u32 = u.map(|x| (x as f32).min(1.0 - f32::EPSILON / 2.0));
        sampled(tally, sea, "draw of float32", single, i32, n32, u32);
    }
    tally.count("(draws, float64)", ROWS as u64 / 4);
    tally.count("(draws, float32)", ROWS as u64 / 4);
}

/// A draw has a direction of unit length above the horizon with a finite weight, or is lost: all zero.
fn sampled<T: Scalar + PartialEq>(
    tally: &mut Tally,
    sea: &Parameters,
    name: &str,
    lobe: &Lobe<T>,
    i: Vec3<T>,
    n: Vec3<T>,
    u: Vec3<T>,
) {
    let s = lobe.sample(i, n, u);
    let direction = s.direction.map(T::to_f64);
    let (pdf, f) = (s.pdf.to_f64(), s.f.to_f64());
    let fine = if pdf == 0.0 {
        direction == [0.0; 3] && f == 0.0
    } else {
        let length = dot(direction, direction).sqrt();
        let unit = (length - 1.0).abs() < 20.0 * UNIT_TOLERANCE;
        let weight = f * dot(direction, n.map(T::to_f64)) / pdf;
        unit && fine(pdf) && fine(f) && weight.is_finite()
    };
    tally.check(fine, sea, name, || {
        let row = [i, n, u].map(|v| v.map(T::to_f64));
        format!("{}\n  {s:?} (source, normal, uniform numbers)", shown(&row, &[pdf, f]))
    });
}

/// The sea in a line.
fn in_short(sea: &Parameters) -> String {
    let wind = sea.wind.profile().map_or(f64::NAN, |wind| wind.friction_velocity);
    format!(
        "w* {wind} cm/s, D {:e} m, wavelength {}, ior {:?}, {:?}, {:?}, {:?}, whitecaps {}, shadowing {}, gram_charlier {}",
        sea.footprint(),
        sea.wavelength,
        sea.ior,
        sea.fresnel,
        sea.slope_measure,
        sea.readings,
        sea.whitecaps,
        sea.shadowing,
        sea.gram_charlier
    )
}
