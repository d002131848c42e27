//! The wave energy spectrum: Eqs. 3-22. Everything here is cgs, as in the report.

use super::salinity::Salinity;
use super::whitecap::GRAVITY;
use super::wind::WindProfile;
use crate::numeric::root::bisect;
use crate::readings::Readings;
use std::f64::consts::{FRAC_PI_2, PI};

/// Surface tension tau, dyne/cm.
const TENSION: f64 = 76.3;
const ALPHA: f64 = 8.1e-3;
const BETA: f64 = 0.74;
/// A of Eq. 19: the part of the energy that does not depend on direction.
const ISOTROPIC: f64 = 0.2;
/// f of Eq. 22: waves longer than this many footprints are drawn.
const FOOTPRINTS: f64 = 2.0;
/// The fetch up to which it matters, m.
const LONGEST_FETCH: f64 = 100e3;
/// Stacey's spectrum takes part from this friction velocity beside Pierson and Moskowitz (Eq. 15), cm/s,
const STACEY_LOW: f64 = 35.8;
/// and from this one beside Kitaigorodskii (Eq. 17).
const STACEY_HIGH: f64 = 75.76;

/// A wave energy spectrum S(k): Bjerkaas and Riedel's as the report has it.
#[derive(Debug, Clone, Copy)]
pub struct Spectrum {
    /// tau/rho, cm^3/s^2.
    tension: f64,
    /// Depth of the water, cm.
    depth: f64,
    fetch: Option<Fetch>,
    friction_velocity: f64,
    /// The peak of S_1 (Eq. 7), up to which Pierson and Moskowitz's form holds, rad/cm.
    pub k0: f64,
    /// End of Stacey's range (Eq. 8), rad/cm.
    pub k1: f64,
    /// End of Kitaigorodskii's range and of the spectrum, where omega = 20 pi, rad/cm.
    pub k2: f64,
    /// k_m^2 of Eq. 5, where surface tension and gravity are equal, (rad/cm)^2.
    km2: f64,
    /// Smallest wave number drawn (Eq. 21), rad/cm; infinite in a calm.
    pub k_min: f64,
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

impl Spectrum {
    /// The spectrum of a wind over water of a depth and with a fetch in m, both above 0, up to infinity.
    pub fn new(wind: &WindProfile, water: Salinity, depth: f64, fetch: f64) -> Self {
        let density = match water {
            Salinity::Ocean => 1.025,
            Salinity::Fresh => 1.0,
        };
        let tension = TENSION / density;
        let km2 = GRAVITY / tension;
        let w = wind.friction_velocity;
        // Eq. 4 for deep water at 10 Hz; it rises with k.
        let rate = (20.0 * PI).powi(2);
        let k2 = bisect(0.0, rate / GRAVITY, |k| (GRAVITY + tension * k * k) * k >= rate);
        let p = 5.0 - w.log10();
        let shoulder = k2 * (1.0 + k2 * k2 / km2);
        let scale_2 = 0.4375 * (2.0 * PI / GRAVITY.sqrt()).powf(p - 1.0) * shoulder.powf(0.5 * (4.0 - p));
        let scale_1 =
            (ALPHA / 0.875).powi(2) * (GRAVITY / (4.0 * PI * PI)).powf(p - 1.0) * shoulder.powf(p - 4.0);
        let fetch = (fetch <= LONGEST_FETCH && wind.w10 > 0.0)
            .then(|| Fetch { peak: 22.0 * (GRAVITY * GRAVITY / (100.0 * fetch * 100.0 * wind.w10)).cbrt() });
        Self {
            tension,
            depth: 100.0 * depth,
            fetch,
            friction_velocity: w,
            k0: (2.0 * BETA / 3.0).sqrt() * GRAVITY / (100.0 * wind.w19_5).powi(2),
            k1: meeting(scale_1, k2, km2),
            k2,
            km2,
            k_min: 10f64.powf(-2.108 * w.log10() - 0.267),
            scale_2,
        }
    }

    /// Largest wave number drawn (Eq. 22, read or as printed), rad/cm, for a footprint in m; `None` where the wind raises
    /// no waves as long as that: beyond k2 they have no energy.
    pub fn k_max(&self, footprint: f64, readings: Readings) -> Option<f64> {
        if self.k_min >= self.k2 {
            return None;
        }
        let shortest = (2.0 * PI / (FOOTPRINTS * 100.0 * footprint)).max(10f64.sqrt() * self.k_min);
        let printed = readings.contains(Readings::EQ_22);
        Some(if printed { self.k2.max(shortest) } else { self.k2.min(shortest) })
    }

    /// Angular frequency, rad/s, of a wave number in rad/cm (Eq. 4).
    pub fn frequency(&self, k: f64) -> f64 {
        ((GRAVITY + self.tension * k * k) * k * (k * self.depth).tanh()).sqrt()
    }

    /// S(k), cm^3 (Eqs. 10, 15, 17); 0 beyond k2.
    pub fn density(&self, k: f64) -> f64 {
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

    /// Between these wave numbers, in order, rad/cm, the spectrum is smooth, and as flat as a few polynomials: its peak,
    /// where its form changes, and the flanks of the peak that a fetch adds.
    pub(crate) fn pieces(&self, low: f64, high: f64) -> Vec<f64> {
        const SCAN: i32 = 512;
        let at = |i: i32| low * (high / low).powf(f64::from(i) / f64::from(SCAN));
        let mut ends = vec![low, high, self.k0];
        for i in 0..SCAN {
            let (a, b) = (at(i), at(i + 1));
            let form = self.form(a).0;
            if self.form(b).0 != form {
                ends.push(bisect(a, b, |k| self.form(k).0 != form));
            }
        }
        for off in
            self.fetch.iter().flat_map(|fetch| [0.75, 0.88, 1.0, 1.15, 1.32].map(|off| off * fetch.peak))
        {
            if self.frequency(low) < off && off < self.frequency(high) {
                ends.push(bisect(low, high, |k| self.frequency(k) >= off));
            }
        }
        ends.retain(|k| (low..=high).contains(k));
        ends.sort_by(f64::total_cmp);
        ends.dedup();
        ends
    }

    /// Eq. 10 with the correction for fetch, Eq. 11.
    fn pierson_moskowitz(&self, k: f64) -> f64 {
        let s = ALPHA / (2.0 * k.powi(3)) * (-1.5 * (self.k0 / k).powi(2)).exp();
        let Some(Fetch { peak }) = self.fetch else { return s };
        let off = (self.frequency(k) - peak) / peak;
        let width = if off <= 0.0 { 0.0098 } else { 0.0162 };
        s * 3.3f64.powf((-off * off / width).exp())
    }

    /// Eq. 14.
    fn stacey(&self, k: f64) -> f64 {
        let wind = 271.5 + 13.585 * self.friction_velocity;
        wind * (GRAVITY / k).sqrt() * (2.53 * (0.4 * PI - (GRAVITY * k).sqrt())).exp()
    }

    /// Eq. 16.
    fn kitaigorodskii(&self, k: f64) -> f64 {
        let x = k * k / self.km2;
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

/// F of Eq. 19, 1/rad, for an angle in radians from phi_W.
pub fn spreading(angle: f64) -> f64 {
    if angle.abs() < FRAC_PI_2 {
        2.0 * (1.0 - ISOTROPIC) / PI * angle.cos().powi(2) + ISOTROPIC / PI
    } else {
        0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sea::Wind;

    fn spectrum(w: f64) -> Spectrum {
        let wind = Wind::FrictionVelocity(w).profile().unwrap();
        Spectrum::new(&wind, Salinity::Ocean, f64::INFINITY, f64::INFINITY)
    }

    #[test]
    fn k2_is_a_wave_of_ten_hertz() {
        for (water, k2) in [(Salinity::Fresh, 2.6221), (Salinity::Ocean, 2.6354)] {
            let wind = Wind::FrictionVelocity(8.0).profile().unwrap();
            let s = Spectrum::new(&wind, water, f64::INFINITY, f64::INFINITY);
            assert!((s.frequency(s.k2) - 20.0 * PI).abs() < 1e-12);
            assert!((s.k2 - k2).abs() < 5e-5, "{}", s.k2);
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
        let of = |depth, fetch| Spectrum::new(&wind, Salinity::Ocean, depth, fetch);
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
            let s = Spectrum::new(&calm, Salinity::Ocean, f64::INFINITY, fetch);
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
}
