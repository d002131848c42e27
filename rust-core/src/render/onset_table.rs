//! The onset of whitecaps for any footprint, tabulated: for waves that fade where the footprint is larger.

use crate::config::Water;
use crate::numeric::packets::{Packets, Tabulated};
use crate::numeric::{Real, Scalar};
use crate::sea::whitecap::{Onset, WhitecapOnset};
use rayon::prelude::*;

/// Rows for a doubling of the footprint: the fraction between them is within 1 % of that at rows.
const ROWS: u32 = 8;
/// From the sea's footprint on it is doubled so often: no drawn wave accelerates beyond.
const DOUBLINGS: u32 = 14;

/// Onsets over the logarithm of the footprint.
#[derive(Debug, Clone)]
pub struct OnsetTable<T: Real> {
    /// log2 of the sea's footprint in m.
    first: T,
    /// [`Onset::numbers`] and a zero.
    rows: Packets,
}

impl OnsetTable<f64> {
    /// For the waves of a sea that fade ([`Water::fading_waves`]); `None` where there are no whitecaps, or where they follow
    /// from the drawn waves alone.
    pub fn new(water: &Water) -> Option<Self> {
        if water.parameters.whitecap_onset != WhitecapOnset::Calibrated || water.footprint.is_infinite() {
            return None;
        }
        let first = water.footprint.log2();
        let row = |row: u32| {
            let footprint = (first + f64::from(row) / f64::from(ROWS)).exp2();
            let [none, fall, sharpness] = water.fading_whitecap_onset(footprint)?.numbers();
            Some([none as f32, fall as f32, sharpness as f32, 0.0])
        };
        let rows: Option<Vec<_>> = (0..=ROWS * DOUBLINGS).into_par_iter().map(row).collect();
        Some(Self { first, rows: Packets { width: 4, half: false, numbers: rows?.as_flattened().into() } })
    }
}

impl<S: Scalar> OnsetTable<S> {
    /// The same in another number type.
    pub fn cast<T: Real>(&self) -> OnsetTable<T> {
        OnsetTable { first: T::coefficient(self.first.to_f64()), rows: self.rows.clone() }
    }
}

impl<T: Tabulated> OnsetTable<T> {
    /// The onset where the footprint in m has this log2, linearly between rows.
    #[inline(always)]
    pub fn at(&self, log2_footprint: T) -> Onset<T> {
        let last = T::of(f64::from(ROWS * DOUBLINGS));
        let place = (log2_footprint - self.first) * T::of(f64::from(ROWS));
        let (row, t) = T::max(T::min(place, last), T::of(0.0)).step(ROWS * DOUBLINGS);
        let a = T::lookup::<4>(&self.rows, row, T::everywhere());
        let b = T::lookup::<4>(&self.rows, row + T::of(1.0), T::everywhere());
        let between = |k: usize| t.mul_add(b[k] - a[k], a[k]);
        Onset::of_numbers([between(0), between(1), between(2)])
    }
}
