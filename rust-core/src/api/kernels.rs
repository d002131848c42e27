//! The closed forms as programs for a renderer that compiles its own code: recorded from the same text that everything else runs.

use crate::brdf::{Lobe, Parts};
use crate::empirical::FineGrid;
use crate::numeric::Real;
use crate::numeric::real::Extended;
use crate::render::FacetTable;
use crate::render::ensemble_lobe::MeanLobe;
use crate::simd::recorded::{Program, Recording, Traced};

/// What the inputs of a program are, by their numbers.
pub mod inputs {
    /// Unit vector to the source; where the order matters, to the light.
    pub const SOURCE: usize = 0;
    /// Unit vector to the observer.
    pub const OBSERVER: usize = 3;
    /// Three uniform numbers of [0, 1).
    pub const RANDOM: usize = 6;
    /// The wave normal.
    pub const NORMAL: usize = 9;
    /// The footprint, m.
    pub const FOOTPRINT: usize = 12;
    /// The probability of a whitecap.
    pub const WHITECAP: usize = 13;
    /// The cosine that f is multiplied by; of a reflectance that of its angle.
    pub const COSINE: usize = 14;
    /// How many.
    pub const COUNT: usize = 15;
}

/// What differs from place to place.
#[derive(Debug, Clone, Copy, Default)]
pub struct Places<'a> {
    /// The normal is a wave's.
    pub normal: bool,
    /// So is the probability of a whitecap.
    pub whitecap: bool,
    /// Facets for a footprint.
    pub footprint: Option<&'a FacetTable<f64>>,
}

/// What is evaluated.
#[derive(Debug, Clone, Copy)]
pub enum Mean<'a> {
    /// The lobe itself.
    Facets,
    /// A sea from afar.
    Ensemble(&'a MeanLobe<f64>),
    /// The same by a table of the empirical model.
    Empirical(&'a FineGrid<f64>),
}

/// The programs of a sea.
#[derive(Debug, Clone, Default)]
pub struct Kernels {
    /// Coefficients and tables.
    pub recording: Recording,
    /// For facets alone, whitecaps alone and both: f times a cosine; the same where its last digits do not matter; the density of
    /// draws; and a direction with 1 where it comes from the whitecaps. Last rho
    /// (Eqs. 61-63) and sine and cosine of so many turns, both of the last input.
    pub programs: Vec<Program>,
}

impl Kernels {
    /// Of a lobe; where there is another mean than its own, it draws for this one.
    pub fn new(lobe: &Lobe<f64>, mean: Mean, places: Places) -> Self {
        let mut recording = Recording::default();
        let mut programs = Vec::new();
        let mut record = |program: &mut dyn FnMut(&Sea, &[Traced]) -> Vec<Traced>| {
            let program = recording.record(inputs::COUNT, |x| program(&Sea::new(lobe, mean, places, x), x));
            programs.push(program);
        };
        for parts in [(true, false), (false, true), (true, true)] {
            let parts = Parts { facets: parts.0, whitecaps: parts.1 };
            for last_digits in [true, false] {
                record(&mut |sea, x| vec![sea.eval(x, parts, last_digits)]);
            }
            record(&mut |sea, x| vec![sea.pdf(x, parts)]);
            record(&mut |sea, x| sea.draw(x, parts));
        }
        record(&mut |sea, x| vec![sea.lobe.facets.reflectance.eval(x[inputs::COSINE])]);
        record(&mut |_, x| {
            let (sin, cos) = x[inputs::COSINE].sin_cos_turns();
            vec![sin, cos]
        });
        Self { recording, programs }
    }
}

/// [`Mean`] as it is recorded.
enum TracedMean {
    Facets,
    Ensemble(MeanLobe<Traced>),
    Empirical(FineGrid<Traced>),
}

/// A sea at a place, as it is recorded.
struct Sea {
    lobe: Lobe<Traced>,
    mean: TracedMean,
    normal: Option<[Traced; 3]>,
}

fn vector(x: &[Traced], first: usize) -> [Traced; 3] {
    [x[first], x[first + 1], x[first + 2]]
}

impl Sea {
    fn new(lobe: &Lobe<f64>, mean: Mean, places: Places, x: &[Traced]) -> Self {
        let mut lobe: Lobe<Traced> = lobe.cast();
        // Means need no digits that turning takes: where the wind comes from is data.
        let mean = match mean {
            Mean::Facets => TracedMean::Facets,
            Mean::Ensemble(mean) => {
                let mut mean: MeanLobe<Traced> = mean.cast();
                mean.lobe.facets.wind.quadrant = None;
                lobe.facets.wind.quadrant = None;
                TracedMean::Ensemble(mean)
            }
            Mean::Empirical(grid) => {
                let mut grid: FineGrid<Traced> = grid.cast();
                grid.lobe.facets.wind.quadrant = None;
                lobe.facets.wind.quadrant = None;
                TracedMean::Empirical(grid)
            }
        };
        if let Some(table) = places.footprint {
            table.cast().set(&mut lobe.facets, x[inputs::FOOTPRINT]);
        }
        if places.whitecap {
            lobe.whitecap_fraction = x[inputs::WHITECAP];
            lobe.smooth_fraction = Traced::of(1.0) - x[inputs::WHITECAP];
        }
        Self { lobe, mean, normal: places.normal.then(|| vector(x, inputs::NORMAL)) }
    }

    fn eval(&self, x: &[Traced], parts: Parts, last_digits: bool) -> Traced {
        let (i, o) = (vector(x, inputs::SOURCE), vector(x, inputs::OBSERVER));
        let cosine = x[inputs::COSINE];
        match &self.mean {
            TracedMean::Ensemble(mean) => mean.eval(i, o, parts) * cosine,
            TracedMean::Empirical(grid) => grid.eval(i, o, parts) * cosine,
            TracedMean::Facets if last_digits && self.lobe.facets.needs_extended(self.normal.is_none()) => {
                self.eval_in::<<Traced as Real>::Extended>(i, o, parts, cosine)
            }
            TracedMean::Facets => self.eval_in::<<Traced as Real>::Plain>(i, o, parts, cosine),
        }
    }

    fn eval_in<E: Extended<Traced>>(
        &self,
        i: [Traced; 3],
        o: [Traced; 3],
        parts: Parts,
        cosine: Traced,
    ) -> Traced {
        let f = self.lobe.eval_in::<E>(i, o, self.normal, parts);
        match self.normal {
            Some(n) => self.lobe.shown_by_wave::<E>(f, i, o, n),
            None => f * cosine,
        }
    }

    fn pdf(&self, x: &[Traced], parts: Parts) -> Traced {
        let (i, o, zero) = (vector(x, inputs::SOURCE), vector(x, inputs::OBSERVER), Traced::of(0.0));
        if !matches!(self.mean, TracedMean::Facets) {
            return self.lobe.pdf_in::<<Traced as Real>::Plain>(i, o, None, parts);
        }
        let pdf = self.lobe.pdf_parts(i, o, self.normal, parts);
        if self.normal.is_none() {
            return pdf;
        }
        Traced::select(Traced::lt(zero, i[2]) & Traced::lt(zero, o[2]), pdf, zero)
    }

    fn draw(&self, x: &[Traced], parts: Parts) -> Vec<Traced> {
        let (i, u) = (vector(x, inputs::SOURCE), vector(x, inputs::RANDOM));
        let (direction, whitecap) = self.lobe.draw(i, self.normal, u, parts);
        let whitecap = Traced::select(whitecap, Traced::of(1.0), Traced::of(0.0));
        vec![direction[0], direction[1], direction[2], whitecap]
    }
}
