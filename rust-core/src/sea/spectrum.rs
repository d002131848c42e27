//! The wave energy spectrum: Eqs. 3-22. Everything here is cgs, as in the report.

use super::bjerkaas_riedel::BjerkaasRiedel;
use super::dispersion::Dispersion;
use super::elfouhaily::Elfouhaily;
use super::jonswap::Jonswap;
use super::salinity::Salinity;
use super::wind::WindProfile;
use crate::numeric::quadrature::{gauss_legendre, panels};
use crate::readings::Readings;
use std::f64::consts::{FRAC_PI_2, PI};
use std::sync::LazyLock;

/// A of Eq. 19: the part of the energy that does not depend on direction.
const ISOTROPIC: f64 = 0.2;
/// f of Eq. 22: waves longer than this many footprints are drawn.
const FOOTPRINTS: f64 = 2.0;

/// Whose spectrum the waves have.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum SpectrumModel {
    /// Bjerkaas and Riedel's, as the report has it (Eqs. 3-22).
    #[default]
    Report,
    /// JONSWAP's: a sea with a short fetch.
    Jonswap,
    /// TMA's: JONSWAP's in water whose depth limits the waves.
    Tma,
    /// Elfouhaily et al.'s unified spectrum.
    Elfouhaily,
}

/// A wave energy spectrum S(k).
#[derive(Debug, Clone, Copy)]
pub struct Spectrum {
    dispersion: Dispersion,
    form: Form,
    /// The peak, rad/cm; of the report's S_1 (Eq. 7).
    pub k0: f64,
    /// End of the long waves' form, rad/cm: where the report's S_1 gives way to S_2 (Eq. 8), of JONSWAP's part; Elfouhaily's has one form up to k2.
    pub k1: f64,
    /// End of the spectrum, rad/cm: where omega = 20 pi; Elfouhaily's is ten times the wave number of the slowest waves.
    pub k2: f64,
    /// Smallest wave number drawn (Eq. 21), rad/cm; infinite in a calm.
    pub k_min: f64,
}

#[derive(Debug, Clone, Copy)]
enum Form {
    Report(BjerkaasRiedel),
    Jonswap(Jonswap),
    Elfouhaily(Elfouhaily),
}

impl Spectrum {
    /// The spectrum of a wind over water of a depth and with a fetch in m, both above 0, up to infinity.
    pub fn new(model: SpectrumModel, wind: &WindProfile, water: Salinity, depth: f64, fetch: f64) -> Self {
        let dispersion = Dispersion::new(water, depth);
        let open = |fetch| BjerkaasRiedel::new(wind, dispersion, fetch);
        let (form, k0, k1, k2, k_min) = match model {
            SpectrumModel::Report => {
                let s = open(fetch);
                (Form::Report(s), s.k0, s.k1, s.k2, s.k_min())
            }
            SpectrumModel::Jonswap | SpectrumModel::Tma => {
                let limits = if model == SpectrumModel::Tma { depth } else { f64::INFINITY };
                let s = Jonswap::new(wind, fetch, limits, open(f64::INFINITY));
                (Form::Jonswap(s), s.peak, s.k1(), s.open.k2, s.k_min())
            }
            SpectrumModel::Elfouhaily => {
                let s = Elfouhaily::new(wind, fetch);
                let [low, high] = s.range();
                (Form::Elfouhaily(s), s.peak, high, high, low)
            }
        };
        Self { dispersion, form, k0, k1, k2, k_min }
    }

    /// Largest wave number drawn (Eq. 22, read or as printed), rad/cm, for a footprint in m; `None` where the wind raises
    /// no waves as long as that: beyond k2 they have no energy.
    pub fn k_max(&self, footprint: f64, readings: Readings) -> Option<f64> {
        if self.k_min >= self.k2 {
            return None;
        }
        let shortest = shortest(footprint).max(10f64.sqrt() * self.k_min);
        let printed = readings.contains(Readings::EQ_22);
        Some(if printed { self.k2.max(shortest) } else { self.k2.min(shortest) })
    }

    /// Angular frequency, rad/s, of a wave number in rad/cm (Eq. 4).
    pub fn frequency(&self, k: f64) -> f64 {
        self.dispersion.frequency(k)
    }

    /// S(k), cm^3; 0 beyond k2.
    pub fn density(&self, k: f64) -> f64 {
        match &self.form {
            Form::Report(s) => s.density(k),
            Form::Jonswap(s) => s.density(k),
            Form::Elfouhaily(s) => s.density(k),
        }
    }

    /// F of a wave number in rad/cm, 1/rad, for an angle in radians from phi_W: 0 beyond a quarter turn.
    pub fn spreading(&self, k: f64, angle: f64) -> f64 {
        match &self.form {
            Form::Elfouhaily(s) if angle.abs() < FRAC_PI_2 => (1.0 + s.delta(k) * (2.0 * angle).cos()) / PI,
            Form::Elfouhaily(_) => 0.0,
            _ => spreading(angle),
        }
    }

    /// Whether F is the same for all wave numbers.
    pub(crate) fn spreads_alike(&self) -> bool {
        !matches!(self.form, Form::Elfouhaily(_))
    }

    /// The part of a wave's slope variance that lies along the wind, of a wave number in rad/cm: the mean of cos^2 over F.
    fn along(&self, k: f64) -> f64 {
        match &self.form {
            Form::Elfouhaily(s) => 0.5 + 0.25 * s.delta(k),
            _ => 0.75 - 0.25 * ISOTROPIC,
        }
    }

    /// Slope variances along and across the wind of the waves between some [pieces](Self::pieces)' ends, of each what `share` leaves.
    pub(crate) fn slope_variances(&self, pieces: &[f64], share: impl Fn(f64) -> f64) -> [f64; 2] {
        static RULE: LazyLock<Vec<(f64, f64)>> = LazyLock::new(|| gauss_legendre(16));
        let mut sums = [0.0; 2];
        for piece in pieces.windows(2) {
            let (start, end) = (piece[0].ln(), piece[1].ln());
            for (log_k, width) in panels(&RULE, start, end, 1.0) {
                let k = log_k.exp();
                let (variance, along) = (width * k.powi(3) * self.density(k) * share(k), self.along(k));
                sums[0] += variance * along;
                sums[1] += variance * (1.0 - along);
            }
        }
        sums
    }

    /// Between these wave numbers, in order, rad/cm, the spectrum is smooth, and as flat as a few polynomials: its peak,
    /// where its form changes, and the flanks of a narrow peak.
    pub(crate) fn pieces(&self, low: f64, high: f64) -> Vec<f64> {
        let mut ends = match &self.form {
            Form::Report(s) => s.breaks(low, high),
            Form::Jonswap(s) => s.breaks(low, high),
            Form::Elfouhaily(s) => s.breaks(),
        };
        ends.extend([low, high]);
        ends.retain(|k| (low..=high).contains(k));
        ends.sort_by(f64::total_cmp);
        ends.dedup();
        ends
    }
}

/// The wave number of the shortest waves that a footprint in m resolves, rad/cm: they are [`FOOTPRINTS`] footprints long.
pub(crate) fn shortest(footprint: f64) -> f64 {
    2.0 * PI / (FOOTPRINTS * 100.0 * footprint)
}

/// F of Eq. 19, 1/rad, for an angle in radians from phi_W.
pub fn spreading(angle: f64) -> f64 {
    if angle.abs() < FRAC_PI_2 {
        2.0 * (1.0 - ISOTROPIC) / PI * angle.cos().powi(2) + ISOTROPIC / PI
    } else {
        0.0
    }
}

/// The share of a wave's energy, for a wave number in rad/m, that stays geometry where the footprint in m changes from
/// place to place: 1 for waves longer than 2.8 D, 1/2 at 2 D, 0 below 1.4 D, linear in the logarithm, so that no wave ends
/// at a line. The rest is facets there.
pub fn share(wave_number: f64, footprint: f64) -> f64 {
    (0.5 - (wave_number * footprint / PI).log2()).clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sea::Wind;
    use crate::sea::whitecap::GRAVITY;

    fn spectrum(w: f64) -> Spectrum {
        let wind = Wind::FrictionVelocity(w).profile().unwrap();
        Spectrum::new(SpectrumModel::Report, &wind, Salinity::Ocean, f64::INFINITY, f64::INFINITY)
    }

    #[test]
    fn spreading_is_normalised() {
        let n = 100_000;
        let h = 2.0 * PI / f64::from(n);
        let sum: f64 = (0..n).map(|i| spreading(-PI + (f64::from(i) + 0.5) * h) * h).sum();
        assert!((sum - 1.0).abs() < 1e-9);
    }

    /// Fetch adds energy at its peak and nowhere else; beyond 100 km it is forgotten. Depth slows long waves.
    #[test]
    fn fetch_and_depth() {
        let wind = Wind::FrictionVelocity(16.0).profile().unwrap();
        let of = |depth, fetch| Spectrum::new(SpectrumModel::Report, &wind, Salinity::Ocean, depth, fetch);
        let (open, near) = (of(f64::INFINITY, f64::INFINITY), of(f64::INFINITY, 5e3));
        let mut most = 0.0f64;
        for i in 0..2000 {
            let k = open.k_min * (open.k2 / open.k_min).powf(f64::from(i) / 2000.0);
            let gain = near.density(k) / open.density(k);
            assert!(gain >= 1.0);
            most = most.max(gain);
            assert_eq!(of(f64::INFINITY, 100_001.0).density(k), open.density(k));
        }
        assert!((most - 3.3).abs() < 0.01, "{most}");
        let shallow = of(0.5, f64::INFINITY);
        let k = 1e-4;
        assert!((shallow.frequency(k) / (GRAVITY * 50.0 * k * k).sqrt() - 1.0).abs() < 1e-4);
        assert_eq!(shallow.density(k), open.density(k));
    }

    #[test]
    fn no_waves_in_a_calm() {
        assert_eq!(spectrum(0.0).k_max(0.15, Readings::CORRECTED), None);
        assert_eq!(spectrum(0.471).k_max(0.15, Readings::CORRECTED), None);
        assert!(spectrum(0.473).k_max(0.15, Readings::CORRECTED).is_some());
        let calm = Wind::FrictionVelocity(0.0).profile().unwrap();
        for fetch in [100.0, f64::INFINITY] {
            let s = Spectrum::new(SpectrumModel::Report, &calm, Salinity::Ocean, f64::INFINITY, fetch);
            assert!([1e-3, 0.1, s.k2, 10.0].iter().all(|k| s.density(*k) == 0.0));
        }
        for w in [0.473, 2.0, 8.0, 56.0, 238.65] {
            for footprint in [1e-3, 0.15, 100.0, f64::INFINITY] {
                let s = spectrum(w);
                let k_max = s.k_max(footprint, Readings::CORRECTED).unwrap();
                assert!(s.k_min < k_max && k_max <= s.k2);
            }
        }
    }

    fn every(w: f64) -> Vec<Spectrum> {
        let wind = Wind::FrictionVelocity(w).profile().unwrap();
        let of = |model, fetch| Spectrum::new(model, &wind, Salinity::Ocean, f64::INFINITY, fetch);
        vec![
            of(SpectrumModel::Report, f64::INFINITY),
            of(SpectrumModel::Report, 5e3),
            of(SpectrumModel::Jonswap, 800.0),
            of(SpectrumModel::Jonswap, 1e5),
            Spectrum::new(SpectrumModel::Tma, &wind, Salinity::Ocean, 0.5, 2e4),
            of(SpectrumModel::Elfouhaily, f64::INFINITY),
            of(SpectrumModel::Elfouhaily, 1e4),
        ]
    }

    /// Slope variances against sums at equal steps of ln k and of the angle, for every spectrum.
    #[test]
    fn slope_variances_are_the_integrals() {
        for s in [2.0, 8.0, 24.0, 56.0].into_iter().flat_map(every) {
            for (low, high) in [(s.k_min, s.k2), (s.k_min, 3.0 * s.k_min), (s.k_min, 0.5 * s.k2)] {
                let share = |k: f64| 1.0 / (1.0 + k);
                let (n, m) = (4000, 64);
                let step = (high / low).ln() / f64::from(n);
                let turn = PI / f64::from(m);
                let mut sums = [0.0; 2];
                for i in 0..n {
                    let k = low * ((f64::from(i) + 0.5) * step).exp();
                    let variance = s.density(k) * k.powi(3) * step * share(k);
                    for j in 0..m {
                        let angle = (f64::from(j) + 0.5) * turn - FRAC_PI_2;
                        let spread = variance * s.spreading(k, angle) * turn;
                        sums[0] += spread * angle.cos().powi(2);
                        sums[1] += spread * angle.sin().powi(2);
                    }
                }
                let found = s.slope_variances(&s.pieces(low, high), share);
                for (found, sum) in found.into_iter().zip(sums) {
                    assert!((found / sum - 1.0).abs() < 1e-3, "{s:?} to {high}: {found} {sum}");
                }
            }
        }
    }

    /// F has the integral 1 over the half turn before the wind for every wave number, is not negative, and 0 beyond.
    #[test]
    fn every_spreading_is_normalised() {
        for s in [2.0, 24.0].into_iter().flat_map(every) {
            for k in [s.k_min, s.k0, 0.1, 3.7] {
                let turn = PI / 1000.0;
                let all: Vec<_> =
                    (0..1000).map(|i| s.spreading(k, (f64::from(i) + 0.5) * turn - FRAC_PI_2)).collect();
                let sum: f64 = all.iter().map(|f| f * turn).sum();
                assert!((sum - 1.0).abs() < 1e-9 && all.iter().all(|f| *f >= 0.0));
                assert_eq!(s.spreading(k, 1.6), 0.0);
            }
        }
    }

    /// In a calm no spectrum has waves.
    #[test]
    fn every_calm_is_flat() {
        for s in every(0.0) {
            assert!(s.k_min.is_infinite() && s.k_max(0.15, Readings::CORRECTED).is_none());
            assert!([1e-3, 0.1, s.k2].iter().all(|k| s.density(*k) == 0.0));
        }
    }
}
