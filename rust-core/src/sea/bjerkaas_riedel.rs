//! Bjerkaas and Riedel's spectrum as the report has it: Eqs. 6-17 and 21, cgs.

use super::dispersion::Dispersion;
use super::whitecap::GRAVITY;
use super::wind::WindProfile;
use crate::numeric::root::bisect;
use std::f64::consts::PI;

const ALPHA: f64 = 8.1e-3;
const BETA: f64 = 0.74;
/// The fetch up to which it matters, m.
const LONGEST_FETCH: f64 = 100e3;
/// The friction velocity from which Stacey's form takes part beside Pierson and Moskowitz's (Eq. 15), cm/s.
const STACEY_LOW: f64 = 35.8;
/// The friction velocity from which it takes part beside Kitaigorodskii's (Eq. 17), cm/s.
const STACEY_HIGH: f64 = 75.76;

/// The report's spectrum.
#[derive(Debug, Clone, Copy)]
pub(super) struct BjerkaasRiedel {
    dispersion: Dispersion,
    fetch: Option<Fetch>,
    friction_velocity: f64,
    /// The peak of S_1 (Eq. 7), rad/cm; above it Stacey's form may exceed Pierson and Moskowitz's.
    pub(super) k0: f64,
    /// Where S_1 gives way to Kitaigorodskii's S_2 (Eq. 8), rad/cm.
    pub(super) k1: f64,
    /// End of Kitaigorodskii's range and of the spectrum, where omega = 20 pi, rad/cm.
    pub(super) k2: f64,
    /// The factors of Eq. 16 that do not depend on k, with p of Eq. 6.
    scale_2: f64,
}

/// The parts of the spectrum.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Form {
    PiersonMoskowitz,
    Stacey,
    Kitaigorodskii,
    Nothing,
}

/// Eqs. 11-13.
#[derive(Debug, Clone, Copy)]
struct Fetch {
    /// omega_p, rad/s.
    peak: f64,
}

impl BjerkaasRiedel {
    /// Of a wind with a fetch in m.
    pub(super) fn new(wind: &WindProfile, dispersion: Dispersion, fetch: f64) -> Self {
        let w = wind.friction_velocity;
        let (k2, km2) = (dispersion.ten_hertz(), dispersion.km2);
        // Eq. 6.
        let p = 5.0 - w.log10();
        let shoulder = k2 * (1.0 + k2 * k2 / km2);
        let scale_2 = 0.4375 * (2.0 * PI / GRAVITY.sqrt()).powf(p - 1.0) * shoulder.powf(0.5 * (4.0 - p));
        // Of k1's equation, Eq. 8.
        let k1_scale =
            (ALPHA / 0.875).powi(2) * (GRAVITY / (4.0 * PI * PI)).powf(p - 1.0) * shoulder.powf(p - 4.0);
        // Eq. 13.
        let fetch = (fetch <= LONGEST_FETCH && wind.w10 > 0.0)
            .then(|| Fetch { peak: 22.0 * (GRAVITY * GRAVITY / (100.0 * fetch * 100.0 * wind.w10)).cbrt() });
        Self {
            dispersion,
            fetch,
            friction_velocity: w,
            k0: (2.0 * BETA / 3.0).sqrt() * GRAVITY / (100.0 * wind.w19_5).powi(2),
            k1: meeting(k1_scale, k2, km2),
            k2,
            scale_2,
        }
    }

    /// Smallest wave number drawn (Eq. 21), rad/cm; infinite in a calm.
    pub(super) fn k_min(&self) -> f64 {
        10f64.powf(-2.108 * self.friction_velocity.log10() - 0.267)
    }

    /// S(k), cm^3 (Eqs. 10, 15, 17); 0 beyond k2.
    pub(super) fn density(&self, k: f64) -> f64 {
        self.form(k).1
    }

    /// Which form the spectrum has at k, and its value.
    fn form(&self, k: f64) -> (Form, f64) {
        let w = self.friction_velocity;
        let (form, s, stacey) = if k <= self.k1.min(self.k2) {
            (Form::PiersonMoskowitz, self.pierson_moskowitz(k), k > self.k0 && w >= STACEY_LOW)
        } else if k <= self.k2 {
            (Form::Kitaigorodskii, self.kitaigorodskii(k), w >= STACEY_HIGH)
        } else {
            return (Form::Nothing, 0.0);
        };
        let other = if stacey { self.stacey(k) } else { 0.0 };
        if other > s { (Form::Stacey, other) } else { (form, s) }
    }

    /// Wave numbers between two where its form changes, its peak, and the flanks of the peak that a fetch adds.
    pub(super) fn breaks(&self, low: f64, high: f64) -> Vec<f64> {
        const SCAN: i32 = 512;
        let at = |i: i32| low * (high / low).powf(f64::from(i) / f64::from(SCAN));
        let mut ends = vec![self.k0];
        for i in 0..SCAN {
            let (a, b) = (at(i), at(i + 1));
            let form = self.form(a).0;
            if self.form(b).0 != form {
                ends.push(bisect(a, b, |k| self.form(k).0 != form));
            }
        }
        let frequency = |k| self.dispersion.frequency(k);
        for off in
            self.fetch.iter().flat_map(|fetch| [0.75, 0.88, 1.0, 1.15, 1.32].map(|off| off * fetch.peak))
        {
            if frequency(low) < off && off < frequency(high) {
                ends.push(bisect(low, high, |k| frequency(k) >= off));
            }
        }
        ends
    }

    /// Eq. 10 with the correction for fetch, Eq. 11.
    pub(super) fn pierson_moskowitz(&self, k: f64) -> f64 {
        let s = ALPHA / (2.0 * k.powi(3)) * (-1.5 * (self.k0 / k).powi(2)).exp();
        let Some(Fetch { peak }) = self.fetch else { return s };
        let off = (self.dispersion.frequency(k) - peak) / peak;
        let width = if off <= 0.0 { 0.0098 } else { 0.0162 };
        s * 3.3f64.powf((-off * off / width).exp())
    }

    /// Eq. 14.
    fn stacey(&self, k: f64) -> f64 {
        let wind = 271.5 + 13.585 * self.friction_velocity;
        wind * (GRAVITY / k).sqrt() * (2.53 * (0.4 * PI - (GRAVITY * k).sqrt())).exp()
    }

    /// Eq. 16.
    pub(super) fn kitaigorodskii(&self, k: f64) -> f64 {
        let x = k * k / self.dispersion.km2;
        let steep = k * (1.0 + x);
        self.scale_2 * (1.0 + 3.0 * x) / (steep * steep * steep.sqrt())
    }
}

/// k1 of Eq. 8: the smallest root of `scale (1 + x)^5/(1 + 3 x)^2 = k`, `x = k^2/k_m^2`, up to k2; k2 where there is
/// none. The difference falls up to a single minimum and rises after it.
fn meeting(scale: f64, k2: f64, km2: f64) -> f64 {
    let excess = |k: f64| {
        let x = k * k / km2;
        scale * (1.0 + x).powi(5) / (1.0 + 3.0 * x).powi(2) - k
    };
    let rises = |k: f64| {
        let x = k * k / km2;
        scale * 2.0 * k / km2 * (9.0 * x - 1.0) * (1.0 + x).powi(4) / (1.0 + 3.0 * x).powi(3) > 1.0
    };
    let lowest = if rises(k2) { bisect(0.0, k2, rises) } else { k2 };
    if excess(lowest) > 0.0 { k2 } else { bisect(0.0, lowest, |k| excess(k) <= 0.0) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sea::{Salinity, Wind};

    fn spectrum(w: f64) -> BjerkaasRiedel {
        let wind = Wind::FrictionVelocity(w).profile().unwrap();
        BjerkaasRiedel::new(&wind, Dispersion::new(Salinity::Ocean, f64::INFINITY), f64::INFINITY)
    }

    #[test]
    fn k2_is_a_wave_of_ten_hertz() {
        for (water, k2) in [(Salinity::Fresh, 2.6221), (Salinity::Ocean, 2.6354)] {
            let dispersion = Dispersion::new(water, f64::INFINITY);
            let found = dispersion.ten_hertz();
            assert!((dispersion.frequency(found) - 20.0 * PI).abs() < 1e-12);
            assert!((found - k2).abs() < 5e-5, "{found}");
        }
    }

    /// Below w* = 7.885 Eq. 8 has no root; above, k1 is where S1 without its exponential meets S2.
    #[test]
    fn k1_is_the_first_meeting_of_two_spectra() {
        assert_eq!(spectrum(7.88).k1, spectrum(7.88).k2);
        let mut last = f64::INFINITY;
        for w in [7.9, 8.0, 10.0, 16.0, 24.0, 56.0, 120.0, 238.65] {
            let s = spectrum(w);
            let without_exponential = ALPHA / (2.0 * s.k1.powi(3));
            assert!((s.kitaigorodskii(s.k1) / without_exponential - 1.0).abs() < 1e-9, "w* = {w}");
            assert!(s.k1 < last, "w* = {w}");
            // It is the first: S2 lies below all the way.
            for i in 1..200 {
                let k = s.k1 * f64::from(i) / 200.0;
                assert!(s.kitaigorodskii(k) < ALPHA / (2.0 * k.powi(3)));
            }
            last = s.k1;
        }
    }

    #[test]
    fn k0_is_the_peak() {
        for w in [2.0, 8.0, 56.0, 200.0] {
            let s = spectrum(w);
            let peak = s.pierson_moskowitz(s.k0);
            assert!(s.pierson_moskowitz(s.k0 * 1.001) < peak && s.pierson_moskowitz(s.k0 / 1.001) < peak);
        }
    }
}
