//! Checked evaluation of many rows: every direction is looked at before the first is evaluated.

use crate::brdf::up;
use crate::real::{Vec3, dot};
use crate::{Error, Lobe, Real};

/// How far a unit vector's length may be from 1.
pub const UNIT_TOLERANCE: f64 = 1e-4;

/// Rows of directions: to the source, to the observer, and the wave normals (up where there are none).
#[derive(Debug, Clone, Copy)]
pub struct Rows<'a, T> {
    to_source: &'a [Vec3<T>],
    to_observer: &'a [Vec3<T>],
    normals: Option<&'a [Vec3<T>]>,
}

impl<'a, T: Real> Rows<'a, T> {
    /// Checks lengths of the arrays and of every vector; a normal must point up.
    pub fn new(
        to_source: &'a [Vec3<T>],
        to_observer: &'a [Vec3<T>],
        normals: Option<&'a [Vec3<T>]>,
    ) -> Result<Self, Error> {
        same_length("to_observer", to_observer.len(), to_source.len())?;
        check_units("to_source", to_source)?;
        check_units("to_observer", to_observer)?;
        if let Some(normals) = normals {
            same_length("normals", normals.len(), to_source.len())?;
            check_units("normals", normals)?;
            check_all("normals", normals, "a normal that points up", |v| v[2] > 0.0)?;
        }
        Ok(Self { to_source, to_observer, normals })
    }

    /// Writes f, 1/sr, of every row.
    pub fn eval(&self, lobe: &Lobe<T>, f: &mut [T]) -> Result<(), Error> {
        self.each(f, |_, i, o, n| lobe.eval(i, o, n))
    }

    /// Writes a value of every row: of its number from 0, its directions to source and observer and its normal.
    pub fn each(
        &self,
        out: &mut [T],
        value: impl Fn(usize, Vec3<T>, Vec3<T>, Vec3<T>) -> T,
    ) -> Result<(), Error> {
        same_length("the output", out.len(), self.to_source.len())?;
        for (row, out) in out.iter_mut().enumerate() {
            let n = self.normals.map_or_else(up, |n| n[row]);
            *out = value(row, self.to_source[row], self.to_observer[row], n);
        }
        Ok(())
    }

    /// Writes the density, 1/sr, with which [`Lobe::sample`] draws every row's observer.
    pub fn pdf(&self, lobe: &Lobe<T>, pdf: &mut [T]) -> Result<(), Error> {
        self.each(pdf, |_, i, o, n| lobe.pdf(i, o, n))
    }
}

fn same_length(what: &'static str, found: usize, expected: usize) -> Result<(), Error> {
    if found == expected { Ok(()) } else { Err(Error::Length { what, found, expected }) }
}

/// Refuses the first vector that is not finite or not of length 1.
pub fn check_units<T: Real>(column: &'static str, vectors: &[Vec3<T>]) -> Result<(), Error> {
    check_all(column, vectors, "a finite unit vector (to 1e-4)", |v| {
        (dot(v, v).sqrt() - 1.0).abs() <= UNIT_TOLERANCE
    })
}

fn check_all<T: Real>(
    column: &'static str,
    vectors: &[Vec3<T>],
    expected: &'static str,
    holds: impl Fn(Vec3<f64>) -> bool,
) -> Result<(), Error> {
    for (k, v) in vectors.iter().enumerate() {
        let v = v.map(Real::to_f64);
        if !holds(v) {
            return Err(Error::Row { row: k + 1, column, x: v[0], y: v[1], z: v[2], expected });
        }
    }
    Ok(())
}
