//! Checked evaluation of many rows: every direction is looked at before the first is evaluated.

use crate::brdf::Lobe;
use crate::empirical::Gridded;
use crate::error::Error;
use crate::numeric::{Scalar, Vec3};
use crate::simd::{Kernel, Lanes, Level, Vector};
use rayon::prelude::*;

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

/// What is wanted of a row.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Quantity {
    /// f, 1/sr.
    Brdf,
    /// The density with which [`Lobe::sample`] draws, 1/sr.
    Density,
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
            Columns::unchecked(i, o, n).values(Level::detect(), lobe, value, out);
        })
    }
}

/// Rows that a task takes: few enough to stay in the cache.
const TASK: usize = 1 << 13;

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

/// The coordinates of many vectors, one slice for each.
pub type Coordinates<'a> = [&'a [f32]; 3];

/// Rows of directions, coordinate by coordinate: to the source, to the observer, and the wave normals (up where there are
/// none).
///
/// ```
/// use prob_water::{Parameters, batch::Columns};
///
/// let lobe = Parameters::default().configure()?.lobe()?.cast();
/// let [x, y, z] = [[0.0f32, 0.6], [0.0, 0.0], [1.0, 0.8]];
/// let back = [0.0f32, -0.6];
/// let mut f = [0.0f32; 2];
/// Columns::new([&x, &y, &z], [&back, &y, &z], None)?.eval(&lobe, &mut f)?;
/// assert!(f.iter().all(|f| *f > 0.01));
/// # Ok::<(), prob_water::Error>(())
/// ```
#[derive(Debug, Clone, Copy)]
pub struct Columns<'a> {
    to_source: Coordinates<'a>,
    to_observer: Coordinates<'a>,
    normals: Option<Coordinates<'a>>,
}

impl<'a> Columns<'a> {
    /// Checks lengths of the slices and of every vector; a normal must point up.
    pub fn new(
        to_source: Coordinates<'a>,
        to_observer: Coordinates<'a>,
        normals: Option<Coordinates<'a>>,
    ) -> Result<Self, Error> {
        let rows = to_source[0].len();
        let check = |column, vectors: Coordinates, normals| {
            vectors.iter().try_for_each(|x| same_length(column, x.len(), rows))?;
            check(column, vectors, normals)
        };
        check("to_source", to_source, false)?;
        check("to_observer", to_observer, false)?;
        normals.map_or(Ok(()), |normals| check("normals", normals, true))?;
        Ok(Self::unchecked(to_source, to_observer, normals))
    }

    /// Of vectors that have been checked.
    pub(crate) fn unchecked(
        to_source: Coordinates<'a>,
        to_observer: Coordinates<'a>,
        normals: Option<Coordinates<'a>>,
    ) -> Self {
        Self { to_source, to_observer, normals }
    }

    /// Writes f, 1/sr, of every row, on all threads of the current pool.
    pub fn eval(&self, lobe: &Lobe<f32>, f: &mut [f32]) -> Result<(), Error> {
        self.eval_on(Level::detect(), lobe, f)
    }

    /// The same in the vectors of a certain kind: for comparisons. The portable ones stand in for what the processor lacks.
    pub fn eval_on(&self, level: Level, lobe: &Lobe<f32>, f: &mut [f32]) -> Result<(), Error> {
        self.in_tasks(level, lobe, Quantity::Brdf, f)
    }

    /// Writes the density, 1/sr, with which [`Lobe::sample`] draws every row's observer.
    pub fn pdf(&self, lobe: &Lobe<f32>, pdf: &mut [f32]) -> Result<(), Error> {
        self.pdf_on(Level::detect(), lobe, pdf)
    }

    /// The same in the vectors of a certain kind, as [`Columns::eval_on`].
    pub fn pdf_on(&self, level: Level, lobe: &Lobe<f32>, pdf: &mut [f32]) -> Result<(), Error> {
        self.in_tasks(level, lobe, Quantity::Density, pdf)
    }

    fn in_tasks(
        &self,
        level: Level,
        lobe: &Lobe<f32>,
        value: Quantity,
        out: &mut [f32],
    ) -> Result<(), Error> {
        in_tasks(out, self.to_source[0].len(), |first, out| {
            self.rows(first, out.len()).values(level, lobe, value, out);
        })
    }

    /// Writes a value of every row, on this thread.
    pub(crate) fn values(&self, level: Level, lobe: &Lobe<f32>, value: Quantity, out: &mut [f32]) {
        level.run(Task { columns: *self, lobe, out, value });
    }

    fn rows(&self, first: usize, count: usize) -> Self {
        let of = |columns: Coordinates<'a>| columns.map(|x| &x[first..first + count]);
        Self {
            to_source: of(self.to_source),
            to_observer: of(self.to_observer),
            normals: self.normals.map(of),
        }
    }
}

/// Some rows of one sea.
struct Task<'a> {
    columns: Columns<'a>,
    lobe: &'a Lobe<f32>,
    out: &'a mut [f32],
    value: Quantity,
}

impl Kernel for Task<'_> {
    #[inline(always)]
    fn run<V: Vector>(self) {
        let lobe: Lobe<Lanes<V>> = self.lobe.cast();
        let rows = self.out.len();
        let mut first = 0;
        while first + V::WIDTH <= rows {
            self.columns.vector::<V>(first, &lobe, self.value).store(&mut self.out[first..]);
            first += V::WIDTH;
        }
        if first < rows {
            // What is left, filled up with its last row.
            let last = |x: &[f32]| -> [f32; 16] { std::array::from_fn(|l| x[(first + l).min(rows - 1)]) };
            let of = |columns: Coordinates| columns.map(last);
            let (i, o) = (of(self.columns.to_source), of(self.columns.to_observer));
            let n = self.columns.normals.map(of);
            let columns = Columns {
                to_source: i.each_ref().map(|x| &x[..]),
                to_observer: o.each_ref().map(|x| &x[..]),
                normals: n.as_ref().map(|n| n.each_ref().map(|x| &x[..])),
            };
            let mut values = [0.0; 16];
            columns.vector::<V>(0, &lobe, self.value).store(&mut values);
            self.out[first..].copy_from_slice(&values[..rows - first]);
        }
    }
}

impl Columns<'_> {
    /// The values of as many rows as a vector has lanes.
    #[inline(always)]
    fn vector<V: Vector>(&self, first: usize, lobe: &Lobe<Lanes<V>>, value: Quantity) -> V {
        let (i, o) = (load(self.to_source, first), load(self.to_observer, first));
        // Not `map`, whose closure would not be inlined.
        #[allow(clippy::manual_map)]
        let n = match self.normals {
            Some(n) => Some(load(n, first)),
            None => None,
        };
        match value {
            Quantity::Brdf => lobe.eval(i, o, n).0,
            Quantity::Density => lobe.pdf(i, o, n).0,
        }
    }
}

#[inline(always)]
fn load<V: Vector>(x: Coordinates, first: usize) -> Vec3<Lanes<V>> {
    [Lanes(V::load(&x[0][first..])), Lanes(V::load(&x[1][first..])), Lanes(V::load(&x[2][first..]))]
}

/// Refuses the first vector that is not finite, not of length 1 or, for `normals`, does not point up.
fn check(column: &'static str, [x, y, z]: Coordinates, normals: bool) -> Result<(), Error> {
    let rows = || x.iter().zip(y).zip(z).map(|((x, y), z)| [*x, *y, *z]);
    // All at once and without branches, a little stricter; if one fails, row by row.
    let strict = 1.9 * UNIT_TOLERANCE as f32;
    let good = rows().fold(true, |good, [x, y, z]| {
        let excess = x * x + y * y + z * z - 1.0;
        good & (excess.abs() < strict) & (!normals | (z > 0.0))
    });
    if good { Ok(()) } else { check_rows(column, rows(), normals) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::brdf::SlopeMeasure;
    use crate::config::{Parameters, Readings};

    /// In the vectors of every kind a coordinate that is not a number gives none, wherever the others lie, and leaves the
    /// neighbouring lanes alone.
    #[test]
    fn no_number_gives_none() {
        let defaults = Parameters::default();
        let seas = [
            defaults,
            Parameters { slope_measure: SlopeMeasure::Slope, wind_direction: 30.0, ..defaults },
            Parameters { readings: Readings::AsPrinted, gram_charlier: false, shadowing: false, ..defaults },
        ];
        let (up, below) = ([0.0, 0.6, 0.8], [0.0, 0.6, -0.8]);
        for sea in seas {
            let lobe = sea.configure().unwrap().lobe.cast();
            for (observer, normals, vector, axis) in (0..36).map(|k| (k % 2, k / 2 % 2, k / 4 % 3, k / 12)) {
                if vector == 2 && normals == 0 {
                    continue;
                }
                // The rows after the fifth do not fill a vector.
                let mut rows = [[up, if observer == 0 { up } else { below }, [0.0, 0.0, 1.0]]; 21];
                rows[5][vector][axis] = f32::NAN;
                rows[20][vector][axis] = f32::NAN;
                let of = |v: usize| [0, 1, 2].map(|k| rows.iter().map(|row| row[v][k]).collect::<Vec<_>>());
                let (i, o, n) = (of(0), of(1), of(2));
                let columns = Columns::unchecked(
                    i.each_ref().map(|x| &x[..]),
                    o.each_ref().map(|x| &x[..]),
                    (normals == 1).then(|| n.each_ref().map(|x| &x[..])),
                );
                for level in Level::ALL.into_iter().filter(|level| level.is_available()) {
                    for quantity in [Quantity::Brdf, Quantity::Density] {
                        let mut found = [0.0; 21];
                        columns.values(level, &lobe, quantity, &mut found);
                        for (row, x) in found.into_iter().enumerate() {
                            let holds = if row == 5 || row == 20 {
                                x.is_nan()
                            } else if observer == 0 {
                                x > 0.0
                            } else {
                                x == 0.0
                            };
                            assert!(holds, "{level:?} {quantity:?} {sea:?} row {row} {vector} {axis}: {x}");
                        }
                    }
                }
            }
        }
    }
}
