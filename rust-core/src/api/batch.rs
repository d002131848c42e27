//! Checked evaluation of many rows: every direction is looked at before the first is evaluated.

use crate::brdf::Lobe;
use crate::empirical::Gridded;
use crate::error::Error;
use crate::numeric::{Scalar, Vec3};
use crate::simd::SimdLevel;

pub use super::columns::{Columns, Coordinates, Quantity, SampleColumns, Sources};
pub use super::tasks::{UNIT_TOLERANCE, check_units};
use super::tasks::{check_rows, in_tasks, same_length};

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

    /// Writes a value of every row, on all threads of the current pool: of its number from 0, its directions to source and
    /// observer and its normal, if it has one.
    pub fn each(
        &self,
        out: &mut [T],
        value: impl Fn(usize, Vec3<T>, Vec3<T>, Option<Vec3<T>>) -> T + Sync,
    ) -> Result<(), Error> {
        self.tasks(out, |rows, first, out| {
            for (k, out) in out.iter_mut().enumerate() {
                let n = rows.normals.map(|n| n[k]);
                *out = value(first + k, rows.to_source[k], rows.to_observer[k], n);
            }
        })
    }

    /// Shares the rows out: a task gets some of them, the number of the first, and their part of the output.
    fn tasks(&self, out: &mut [T], task: impl Fn(Self, usize, &mut [T]) + Sync) -> Result<(), Error> {
        in_tasks(out, self.to_source.len(), |first, out| {
            let rows = first..first + out.len();
            let part = Self {
                to_source: &self.to_source[rows.clone()],
                to_observer: &self.to_observer[rows.clone()],
                normals: self.normals.map(|n| &n[rows]),
            };
            task(part, first, out);
        })
    }
}

impl<T: Batched> Rows<'_, T> {
    /// Writes f, 1/sr, of every row, on all threads of the current pool; float32 in the processor's vectors.
    pub fn eval(&self, lobe: &Lobe<T>, f: &mut [T]) -> Result<(), Error> {
        T::values(self, lobe, Quantity::Brdf, f)
    }

    /// Writes the density, 1/sr, with which [`Lobe::sample`] draws every row's observer.
    pub fn pdf(&self, lobe: &Lobe<T>, pdf: &mut [T]) -> Result<(), Error> {
        T::values(self, lobe, Quantity::Density, pdf)
    }
}

/// How rows of a number type are evaluated: one by one, or in lanes.
pub trait Batched: Scalar + Gridded {
    /// Writes a value of every row.
    fn values(rows: &Rows<Self>, lobe: &Lobe<Self>, value: Quantity, out: &mut [Self]) -> Result<(), Error>;
}

impl Batched for f64 {
    fn values(rows: &Rows<Self>, lobe: &Lobe<Self>, value: Quantity, out: &mut [Self]) -> Result<(), Error> {
        match value {
            Quantity::Brdf => rows.each(out, |_, i, o, n| lobe.eval(i, o, n)),
            Quantity::Density => rows.each(out, |_, i, o, n| lobe.pdf(i, o, n)),
        }
    }
}

impl Batched for f32 {
    fn values(rows: &Rows<Self>, lobe: &Lobe<Self>, value: Quantity, out: &mut [Self]) -> Result<(), Error> {
        rows.tasks(out, |rows, _, out| {
            let transposed = |v: &[Vec3<f32>]| [0, 1, 2].map(|k| v.iter().map(|v| v[k]).collect::<Vec<_>>());
            let (i, o) = (transposed(rows.to_source), transposed(rows.to_observer));
            let n = rows.normals.map(transposed);
            let [i, o] = [&i, &o].map(|v| v.each_ref().map(Vec::as_slice));
            let n = n.as_ref().map(|v| v.each_ref().map(Vec::as_slice));
            Columns::unchecked(i, o, n).values(SimdLevel::detect(), lobe, value, out);
        })
    }
}
