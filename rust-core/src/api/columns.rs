//! Rows coordinate by coordinate, in the processor's vectors.

use super::tasks::{TASK, UNIT_TOLERANCE, check_rows, in_tasks, same_length};
use crate::brdf::Lobe;
use crate::error::Error;
use crate::numeric::Vec3;
use crate::simd::{Kernel, Lanes, SimdLevel, Vector, WIDEST};
use rayon::prelude::*;

/// What is wanted of a row.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Quantity {
    /// f, 1/sr.
    Brdf,
    /// The density with which [`Lobe::sample`] draws, 1/sr.
    Density,
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
pub struct Columns<'a>(Inputs<'a>);

impl<'a> Columns<'a> {
    /// Checks lengths of the slices and of every vector; a normal must point up.
    pub fn new(
        to_source: Coordinates<'a>,
        to_observer: Coordinates<'a>,
        normals: Option<Coordinates<'a>>,
    ) -> Result<Self, Error> {
        let columns = Self::unchecked(to_source, to_observer, normals);
        columns.0.check("to_observer")?;
        check("to_observer", to_observer, false)?;
        Ok(columns)
    }

    /// Of vectors that have been checked.
    pub(crate) fn unchecked(
        to_source: Coordinates<'a>,
        to_observer: Coordinates<'a>,
        normals: Option<Coordinates<'a>>,
    ) -> Self {
        Self(Inputs { to_source, other: to_observer, normals })
    }

    /// Writes f, 1/sr, of every row, on all threads of the current pool.
    pub fn eval(&self, lobe: &Lobe<f32>, f: &mut [f32]) -> Result<(), Error> {
        self.eval_on(SimdLevel::detect(), lobe, f)
    }

    /// The same in the vectors of a certain kind: for comparisons. The portable ones stand in for what the processor lacks.
    pub fn eval_on(&self, level: SimdLevel, lobe: &Lobe<f32>, f: &mut [f32]) -> Result<(), Error> {
        self.in_tasks(level, lobe, Quantity::Brdf, f)
    }

    /// Writes the density, 1/sr, with which [`Lobe::sample`] draws every row's observer.
    pub fn pdf(&self, lobe: &Lobe<f32>, pdf: &mut [f32]) -> Result<(), Error> {
        self.pdf_on(SimdLevel::detect(), lobe, pdf)
    }

    /// The same in the vectors of a certain kind, as [`Columns::eval_on`].
    pub fn pdf_on(&self, level: SimdLevel, lobe: &Lobe<f32>, pdf: &mut [f32]) -> Result<(), Error> {
        self.in_tasks(level, lobe, Quantity::Density, pdf)
    }

    fn in_tasks(
        &self,
        level: SimdLevel,
        lobe: &Lobe<f32>,
        value: Quantity,
        out: &mut [f32],
    ) -> Result<(), Error> {
        in_tasks(out, self.0.len(), |first, out| {
            Self(self.0.rows(first, out.len())).values(level, lobe, value, out);
        })
    }

    /// Writes a value of every row, on this thread.
    pub(crate) fn values(&self, level: SimdLevel, lobe: &Lobe<f32>, value: Quantity, out: &mut [f32]) {
        let out = match value {
            Quantity::Brdf => Output::Brdf(out),
            Quantity::Density => Output::Density(out),
        };
        level.run(Task { inputs: self.0, lobe, out });
    }
}

/// Rows to draw an observer for, coordinate by coordinate: the direction to the source, three uniform numbers of [0, 1), and
/// the wave normal (up where there are none).
///
/// ```
/// use prob_water::{Parameters, batch::{Sources, SampleColumns}};
///
/// let lobe = Parameters::default().configure()?.lobe()?.cast();
/// let [x, y, z] = [[0.0f32, 0.6], [0.0, 0.0], [1.0, 0.8]];
/// let uniform = [[0.1f32, 0.2], [0.3, 0.4], [0.5, 0.6]];
/// let (mut to_observer, mut pdf, mut f, mut whitecap) = ([[0.0f32; 2]; 3], [0.0; 2], [0.0; 2], [false; 2]);
/// let draws = Sources::new([&x, &y, &z], uniform.each_ref().map(|u| &u[..]), None)?;
/// draws.sample(&lobe, SampleColumns {
///     to_observer: to_observer.each_mut().map(|x| &mut x[..]),
///     pdf: &mut pdf,
///     f: &mut f,
///     whitecap: &mut whitecap,
/// })?;
/// assert!(pdf.iter().all(|pdf| *pdf > 0.0));
/// # Ok::<(), prob_water::Error>(())
/// ```
#[derive(Debug, Clone, Copy)]
pub struct Sources<'a>(Inputs<'a>);

/// Where draws are written to, a number of every row in each slice: what [`crate::Sample`] holds.
#[derive(Debug)]
pub struct SampleColumns<'a> {
    /// To the observer; zero where nothing could be drawn.
    pub to_observer: [&'a mut [f32]; 3],
    /// Its density, 1/sr, 0 where nothing could be drawn.
    pub pdf: &'a mut [f32],
    /// f, 1/sr.
    pub f: &'a mut [f32],
    /// Drawn from the whitecaps, not from the facets.
    pub whitecap: &'a mut [bool],
}

impl<'a> Sources<'a> {
    /// Checks lengths of the slices, every vector and every uniform number; a normal must point up.
    pub fn new(
        to_source: Coordinates<'a>,
        uniform: Coordinates<'a>,
        normals: Option<Coordinates<'a>>,
    ) -> Result<Self, Error> {
        let inputs = Inputs { to_source, other: uniform, normals };
        inputs.check("uniform")?;
        let rows = || uniform[0].iter().zip(uniform[1]).zip(uniform[2]).map(|((x, y), z)| [*x, *y, *z]);
        match rows().position(|u| u.iter().any(|u| !(0.0..1.0).contains(u))) {
            None => Ok(Self(inputs)),
            Some(row) => {
                let [x, y, z] = uniform.map(|u| f64::from(u[row]));
                Err(Error::Row { row: row + 1, column: "uniform", x, y, z, expected: "numbers of [0, 1)" })
            }
        }
    }

    /// Draws an observer for every row, as [`Lobe::sample`] does, on all threads of the current pool.
    pub fn sample(&self, lobe: &Lobe<f32>, out: SampleColumns<'_>) -> Result<(), Error> {
        self.sample_on(SimdLevel::detect(), lobe, out)
    }

    /// The same in the vectors of a certain kind, as [`Columns::eval_on`].
    pub fn sample_on(&self, level: SimdLevel, lobe: &Lobe<f32>, out: SampleColumns<'_>) -> Result<(), Error> {
        let SampleColumns { to_observer: [x, y, z], pdf, f, whitecap } = out;
        let rows = self.0.len();
        for found in [x.len(), y.len(), z.len(), pdf.len(), f.len(), whitecap.len()] {
            same_length("the output", found, rows)?;
        }
        let task = |first: usize, out: SampleColumns<'_>| {
            let inputs = self.0.rows(first, out.pdf.len());
            level.run(Task { inputs, lobe, out: Output::Sample(out) });
        };
        if rows <= TASK {
            task(0, SampleColumns { to_observer: [x, y, z], pdf, f, whitecap });
            return Ok(());
        }
        let [x, y, z, pdf, f] = [x, y, z, pdf, f].map(|column| column.par_chunks_mut(TASK));
        let parts = (x, y, z, pdf, f, whitecap.par_chunks_mut(TASK)).into_par_iter().enumerate();
        parts.for_each(|(number, (x, y, z, pdf, f, whitecap))| {
            task(number * TASK, SampleColumns { to_observer: [x, y, z], pdf, f, whitecap });
        });
        Ok(())
    }
}

/// What rows are given by: directions to the source, those to the observer or uniform numbers, and normals.
#[derive(Debug, Clone, Copy)]
struct Inputs<'a> {
    to_source: Coordinates<'a>,
    other: Coordinates<'a>,
    normals: Option<Coordinates<'a>>,
}

impl<'a> Inputs<'a> {
    fn len(&self) -> usize {
        self.to_source[0].len()
    }

    /// Checks all lengths, `other` by its name, and the vectors of the rest; a normal must point up.
    fn check(&self, other: &'static str) -> Result<(), Error> {
        let same = |column, vectors: Coordinates| {
            vectors.iter().try_for_each(|x| same_length(column, x.len(), self.len()))
        };
        same("to_source", self.to_source)?;
        same(other, self.other)?;
        check("to_source", self.to_source, false)?;
        self.normals.map_or(Ok(()), |n| same("normals", n).and_then(|()| check("normals", n, true)))
    }

    fn rows(&self, first: usize, count: usize) -> Self {
        let of = |columns: Coordinates<'a>| columns.map(|x| &x[first..first + count]);
        Self { to_source: of(self.to_source), other: of(self.other), normals: self.normals.map(of) }
    }
}

/// What is computed of rows, and where it goes.
enum Output<'a> {
    Brdf(&'a mut [f32]),
    Density(&'a mut [f32]),
    Sample(SampleColumns<'a>),
}

/// Some rows of one sea.
struct Task<'a> {
    inputs: Inputs<'a>,
    lobe: &'a Lobe<f32>,
    out: Output<'a>,
}

impl Kernel for Task<'_> {
    #[inline(always)]
    fn run<V: Vector>(mut self) {
        let lobe: Lobe<Lanes<V>> = self.lobe.cast();
        let mut first = 0;
        while first < self.inputs.len() {
            self.vector::<V>(first, &lobe);
            first += V::WIDTH;
        }
    }
}

impl Task<'_> {
    /// As many rows as a vector has lanes, or those that are left.
    #[inline(always)]
    fn vector<V: Vector>(&mut self, first: usize, lobe: &Lobe<Lanes<V>>) {
        let (i, x) = (load(self.inputs.to_source, first), load(self.inputs.other, first));
        // Not `map`, whose closure would not be inlined.
        #[allow(clippy::manual_map)]
        let n = match self.inputs.normals {
            Some(n) => Some(load(n, first)),
            None => None,
        };
        match &mut self.out {
            Output::Brdf(f) => store(lobe.eval(i, x, n), &mut f[first..]),
            Output::Density(pdf) => store(lobe.pdf(i, x, n), &mut pdf[first..]),
            Output::Sample(out) => {
                let (direction, [pdf, f], whitecap) = lobe.sample_lanes(i, n, x);
                store(direction[0], &mut out.to_observer[0][first..]);
                store(direction[1], &mut out.to_observer[1][first..]);
                store(direction[2], &mut out.to_observer[2][first..]);
                store(pdf, &mut out.pdf[first..]);
                store(f, &mut out.f[first..]);
                let mut flags = [0.0; WIDEST];
                V::select(whitecap, V::splat(1.0), V::splat(0.0)).store(&mut flags);
                for (to, flag) in out.whitecap[first..].iter_mut().zip(&flags[..V::WIDTH]) {
                    *to = *flag != 0.0;
                }
            }
        }
    }
}

#[inline(always)]
fn load<V: Vector>(x: Coordinates, first: usize) -> Vec3<Lanes<V>> {
    [load_one(&x[0][first..]), load_one(&x[1][first..]), load_one(&x[2][first..])]
}

/// The first numbers of a slice that is not empty, filled up with its last.
#[inline(always)]
fn load_one<V: Vector>(x: &[f32]) -> Lanes<V> {
    if x.len() >= V::WIDTH {
        return Lanes(V::load(x));
    }
    let mut filled = [x[x.len() - 1]; WIDEST];
    filled[..x.len()].copy_from_slice(x);
    Lanes(V::load(&filled))
}

/// Into the first places of a slice, as many as there are.
#[inline(always)]
fn store<V: Vector>(x: Lanes<V>, to: &mut [f32]) {
    if to.len() >= V::WIDTH {
        return x.0.store(to);
    }
    let mut all = [0.0; WIDEST];
    x.0.store(&mut all);
    to.copy_from_slice(&all[..to.len()]);
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
    use crate::config::Parameters;
    use crate::readings::Readings;

    /// In the vectors of every kind a coordinate that is not a number gives none, wherever the others lie, and leaves the
    /// neighbouring lanes alone.
    #[test]
    fn no_number_gives_none() {
        let defaults = Parameters::default();
        let seas = [
            defaults,
            Parameters { slope_measure: SlopeMeasure::Slope, wind_direction: 30.0, ..defaults },
            Parameters { readings: Readings::AS_PRINTED, gram_charlier: false, shadowing: false, ..defaults },
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
                for level in SimdLevel::ALL.into_iter().filter(|level| level.is_available()) {
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
                    // Draws know no observer.
                    let u = [[0.3; 21]; 3];
                    let draws = Sources(Inputs { other: u.each_ref().map(|u| &u[..]), ..columns.0 });
                    let (mut to, mut pdf, mut f, mut whitecap) =
                        ([[0.0; 21]; 3], [0.0; 21], [0.0; 21], [true; 21]);
                    let out = SampleColumns {
                        to_observer: to.each_mut().map(|x| &mut x[..]),
                        pdf: &mut pdf,
                        f: &mut f,
                        whitecap: &mut whitecap,
                    };
                    draws.sample_on(level, &lobe, out).unwrap();
                    for (row, x) in pdf.into_iter().chain(f).enumerate() {
                        let none = vector != 1 && matches!(row % 21, 5 | 20);
                        let holds = if none { x.is_nan() } else { x > 0.0 };
                        assert!(holds, "{level:?} draws {sea:?} row {row} {vector} {axis}: {x}");
                    }
                }
            }
        }
    }
}
