//! Rows of a batch: checked, and shared out to threads.

use crate::error::Error;
use crate::numeric::{Scalar, Vec3};
use rayon::prelude::*;

/// How far a unit vector's length may be from 1.
pub const UNIT_TOLERANCE: f64 = 1e-4;

/// Rows that a task takes: few enough to stay in the cache.
pub(super) const TASK: usize = 1 << 13;

/// Shares an output of as many numbers as there are rows out to the threads of the current pool: a task gets the number of
/// its first row, and its part.
pub(crate) fn in_tasks<T: Send>(
    out: &mut [T],
    rows: usize,
    task: impl Fn(usize, &mut [T]) + Sync,
) -> Result<(), Error> {
    same_length("the output", out.len(), rows)?;
    if rows <= TASK {
        task(0, out);
    } else {
        out.par_chunks_mut(TASK).enumerate().for_each(|(number, out)| task(number * TASK, out));
    }
    Ok(())
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
        if length.is_nan() || (length - 1.0).abs() > UNIT_TOLERANCE {
            return refuse("a finite unit vector (to 1e-4)");
        }
        if normals && z <= 0.0 {
            return refuse("a normal that points up");
        }
    }
    Ok(())
}
