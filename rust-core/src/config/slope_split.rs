//! How the variance of a sea's slopes is divided between drawn waves and facets.

use crate::brdf::SlopeStatistics;
use crate::brdf::slopes::VARIANCE_FLOOR;
use crate::numeric::root::bisect;
use crate::readings::Readings;
use crate::sea::spectrum::{share, shortest};
use crate::sea::{Spectrum, WindProfile};
use std::f64::consts::SQRT_2;

/// How the variance of the slopes is divided between drawn waves and facets.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum SlopeBudget {
    /// Facets have what Eqs. 74-75 give to their footprint, drawn waves what Eqs. 21-22 leave of the spectrum.
    #[default]
    Report,
    /// Facets have what drawn waves leave of the measured variance of all.
    Closed,
}

/// The part of the slope variance of either axis that a closed budget keeps for the facets, so that they stay smooth beside
/// the drawn waves.
const FACETS: f64 = 0.1;

/// Which waves of a sea are drawn, and the slope variances of the facets beside them, for every footprint.
#[derive(Debug, Clone, Copy)]
pub struct SlopeSplit {
    /// The energy.
    pub spectrum: Spectrum,
    wind: WindProfile,
    statistics: SlopeStatistics,
    readings: Readings,
    /// With a closed budget, the wave number in rad/cm up to which the waves leave the facets their part.
    limit: Option<f64>,
}

impl SlopeSplit {
    /// Of a wind, its spectrum and the statistics of its slopes.
    pub(super) fn new(
        budget: SlopeBudget,
        wind: &WindProfile,
        spectrum: Spectrum,
        statistics: SlopeStatistics,
        readings: Readings,
    ) -> Self {
        let limit = (budget == SlopeBudget::Closed).then(|| {
            let most = statistics.total(wind).map(|total| (1.0 - FACETS) * total);
            let (low, high) = (spectrum.k_min, spectrum.k2);
            if low >= high {
                return high; // no waves
            }
            let pieces = spectrum.pieces(low, high);
            let exceeds = |k: f64| {
                let ends: Vec<f64> = pieces.iter().copied().filter(|end| *end < k).chain([k]).collect();
                let drawn = spectrum.slope_variances(&ends, |_| 1.0);
                drawn[0] > most[0] || drawn[1] > most[1]
            };
            if exceeds(high) { bisect(low, high, exceeds) } else { high }
        });
        Self { spectrum, wind: *wind, statistics, readings, limit }
    }

    /// Smallest and largest wave number drawn (Eqs. 21-22), rad/cm, for a footprint in m; `None`: there are no waves.
    pub fn range(&self, footprint: f64) -> Option<[f64; 2]> {
        let s = &self.spectrum;
        let k_max = match self.limit {
            None => s.k_max(footprint, self.readings)?,
            Some(limit) => limit.min(shortest(footprint)),
        };
        (s.k_min < k_max).then_some([s.k_min, k_max])
    }

    /// Slope variances of the facets, upwind and crosswind, beside waves that are drawn down to two footprints in m: Eqs. 74-77,
    /// or what drawn waves leave.
    pub fn facets(&self, footprint: f64) -> [f64; 2] {
        self.beside(footprint, self.range(footprint), |_| 1.0)
    }

    /// The same beside waves that fade out in an octave about two footprints, as [`share`] has it.
    pub fn facets_beside_fading(&self, footprint: f64) -> [f64; 2] {
        self.beside(footprint, self.range(footprint / SQRT_2), |k| share(100.0 * k, footprint))
    }

    fn beside(&self, footprint: f64, range: Option<[f64; 2]>, share: impl Fn(f64) -> f64) -> [f64; 2] {
        if self.limit.is_none() {
            return self.statistics.variances(&self.wind, footprint);
        }
        let [total_u, total_c] = self.statistics.total(&self.wind);
        let [u, c] = range.map_or([0.0; 2], |[low, high]| {
            let s = &self.spectrum;
            s.slope_variances(&s.pieces(low, high), share)
        });
        [(total_u - u).max(VARIANCE_FLOOR), (total_c - c).max(VARIANCE_FLOOR)]
    }
}
