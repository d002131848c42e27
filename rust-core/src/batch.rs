//! Checked evaluation of many rows: every direction is looked at before the first is evaluated.

use crate::real::Vec3;
pub use crate::columns::{Columns, Coordinates};
use crate::{Error, Lobe, Scalar};

/// How far a unit vector's length may be from 1.
pub const UNIT_TOLERANCE: f64 = 1e-4;

/// Rows of directions: to the source, to the observer, and the wave normals (up where there are none).
#[derive(Debug, Clone, Copy)]
pub struct Rows<'a, T> {
    to_source: &'a [Vec3<T>],
    to_observer: &'a [Vec3<T>],
    normals: Option<&'a [Vec3<T>]>,
}

impl<'a, T: Scalar> Rows<'a, T> {
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
            check_rows("normals", normals.iter().copied(), true)?;
        }
        Ok(Self { to_source, to_observer, normals })
    }

    /// Writes f, 1/sr, of every row.
    pub fn eval(&self, lobe: &Lobe<T>, f: &mut [T]) -> Result<(), Error> {
        self.each(f, |_, i, o, n| lobe.eval(i, o, n))
    }

    /// Writes a value of every row: of its number from 0, its directions to source and observer and its normal, if
    /// it has one.
    pub fn each(
        &self,
        out: &mut [T],
        value: impl Fn(usize, Vec3<T>, Vec3<T>, Option<Vec3<T>>) -> T,
    ) -> Result<(), Error> {
        same_length("the output", out.len(), self.to_source.len())?;
        for (row, out) in out.iter_mut().enumerate() {
            let n = self.normals.map(|n| n[row]);
            *out = value(row, self.to_source[row], self.to_observer[row], n);
        }
        Ok(())
    }

    /// Writes the density, 1/sr, with which [`Lobe::sample`] draws every row's observer.
    pub fn pdf(&self, lobe: &Lobe<T>, pdf: &mut [T]) -> Result<(), Error> {
        self.each(pdf, |_, i, o, n| lobe.pdf(i, o, n))
    }
}

pub(crate) fn same_length(what: &'static str, found: usize, expected: usize) -> Result<(), Error> {
    if found == expected { Ok(()) } else { Err(Error::Length { what, found, expected }) }
}

/// Refuses the first vector that is not finite or not of length 1.
pub fn check_units<T: Scalar>(column: &'static str, vectors: &[Vec3<T>]) -> Result<(), Error> {
    check_rows(column, vectors.iter().copied(), false)
}

/// Refuses the first vector that is not finite, not of length 1 or, for `normals`, does not point up.
pub(crate) fn check_rows<T: Scalar>(
    column: &'static str,
    vectors: impl Iterator<Item = Vec3<T>>,
    normals: bool,
) -> Result<(), Error> {
    for (k, v) in vectors.enumerate() {
        let [x, y, z] = v.map(Scalar::to_f64);
        let refuse = |expected| Err(Error::Row { row: k + 1, column, x, y, z, expected });
        let length = (x * x + y * y + z * z).sqrt();
        // What is not a number fails this as well.
        if !((length - 1.0).abs() <= UNIT_TOLERANCE) {
            return refuse("a finite unit vector (to 1e-4)");
        }
        if normals && z <= 0.0 {
            return refuse("a normal that points up");
        }
    }
    Ok(())
}
