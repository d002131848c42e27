//! Blocks of rows for one sea: directions and normals, in float64, in float32 and as columns.

use crate::draw::{Draw, Vec3};
use prob_water::Water;
use prob_water::brdf::WindAxes;
use prob_water::real::dot;

/// Rows of a block.
pub const ROWS: usize = 4096;

/// To the source, to the observer, the wave normal.
pub type Row = [Vec3; 3];

/// The rows of one sea.
pub struct Block {
    /// In float64; the float32 numbers themselves where `alike`.
    pub wide: Vec<Row>,
    /// In float32.
    pub single: Vec<[[f32; 3]; 3]>,
    /// The same, component by component.
    pub columns: [[Vec<f32>; 3]; 3],
    /// float64 and float32 rows are the same numbers.
    pub alike: bool,
}

impl Block {
    /// Draws rows for a sea. In three blocks of four both precisions get the same numbers, so that they can be compared.
    pub fn new(draw: &mut Draw, water: &Water) -> Self {
        let alike = draw.pick(4) > 0;
        let mut block = Self {
            wide: Vec::with_capacity(ROWS),
            single: Vec::with_capacity(ROWS),
            columns: Default::default(),
            alike,
        };
        for _ in 0..ROWS {
            let row = row(draw, water);
            let mut single = row.map(|v| v.map(|x| x as f32));
            if single[2][2] <= 0.0 {
                single[2] = [0.0, 0.0, 1.0]; // a normal points up
            }
            block.wide.push(if alike { single.map(|v| v.map(f64::from)) } else { row });
            block.single.push(single);
            for (columns, v) in block.columns.iter_mut().zip(single) {
                columns.iter_mut().zip(v).for_each(|(column, x)| column.push(x));
            }
        }
        block
    }
}

fn row(draw: &mut Draw, water: &Water) -> Row {
    let i = draw.direction();
    let n = normal(draw, water, i);
    let o = match draw.pick(16) {
        0..=4 => draw.direction(),
        5 => i,
        6 => i.map(|x| -x),
        7 => [-i[0], -i[1], i[2]],
        8 => normalized(add(i, draw.at(90.0), draw.log_between(1e-9, 1e-1))),
        _ => specular(draw, water, i, n),
    };
    [i, o, n].map(|v| {
        // As far from unit length as rows may be, with room for the rounding to float32.
        let length = if draw.pick(8) == 0 { draw.between(1.0 - 9.9e-5, 1.0 + 9.9e-5) } else { 1.0 };
        v.map(|x| x * length)
    })
}

/// Up, or of a wave: tilted as facets are, steeply, or so that a view just grazes it or lies behind it.
fn normal(draw: &mut Draw, water: &Water, i: Vec3) -> Vec3 {
    let n = match draw.pick(16) {
        0..=7 => return [0.0, 0.0, 1.0],
        8..=11 => {
            let [u, c] = water.variances.map(f64::sqrt);
            normalized([u * draw.between(-4.0, 4.0), c * draw.between(-4.0, 4.0), 1.0])
        }
        12 => {
            let tilt = draw.between(0.0, 89.9);
            draw.at(tilt)
        }
        13 if draw.pick(4) == 0 => {
            // Upright water, facing the wind or anywhere.
            let WindAxes { cos: cos_wind, sin: sin_wind, .. } = water.local_lobe().facets.wind;
            let [x, y, _] = if draw.flag() { draw.at(90.0) } else { [cos_wind, sin_wind, 0.0] };
            [x, y, draw.one_of(&[1e-45, 1e-38, 1e-20, 1e-9])]
        }
        13 => {
            let tilt = 90.0 - draw.log_between(1e-5, 1.0);
            draw.at(tilt)
        }
        14 => {
            // At a right angle to the source, or a little to either side.
            let way = draw.one_of(&[0.0, 1e-9, -1e-9, 1e-6, -1e-6, 1e-3, -1e-3]);
            let along = dot(i, [0.0, 0.0, 1.0]) + way;
            normalized(add([0.0, 0.0, 1.0], i, -along))
        }
        _ => {
            let tilt = draw.between(60.0, 89.0);
            draw.at(tilt)
        }
    };
    if n[2] > 0.0 && n.iter().all(|x| x.is_finite()) { n } else { [0.0, 0.0, 1.0] }
}

/// Where the source is mirrored by a facet some standard deviations from the wave normal.
fn specular(draw: &mut Draw, water: &Water, i: Vec3, n: Vec3) -> Vec3 {
    let f = &water.local_lobe().facets;
    let reach = match draw.pick(8) {
        0 => draw.log_between(1e-6, 1e-1),
        1 => draw.log_between(1.0, 1e3),
        _ => 7.5 * draw.between(0.0, 1.0).sqrt(),
    };
    let (sin, cos) = draw.between(0.0, std::f64::consts::TAU).sin_cos();
    let along = |x: f64, y: f64| [x * f.wind.cos + y * f.wind.sin, y * f.wind.cos - x * f.wind.sin];
    let [nu, nc] = along(n[0], n[1]);
    let (u, c) = ((nu.atan2(n[2]) + reach * sin * f.sigma_u), (nc.atan2(n[2]) + reach * cos * f.sigma_c));
    let (u, c) = (u.clamp(-1.57, 1.57).tan(), c.clamp(-1.57, 1.57).tan());
    let h = normalized([u * f.wind.cos - c * f.wind.sin, u * f.wind.sin + c * f.wind.cos, 1.0]);
    let twice = 2.0 * dot(i, h);
    normalized([0, 1, 2].map(|k| twice * h[k] - i[k]))
}

fn add(a: Vec3, b: Vec3, by: f64) -> Vec3 {
    [0, 1, 2].map(|k| a[k] + by * b[k])
}

fn normalized(v: Vec3) -> Vec3 {
    let length = dot(v, v).sqrt();
    v.map(|x| x / length)
}
