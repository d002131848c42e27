//! Reflection at many wavelengths at once: index and whitecaps by wavelength, beside a lobe at one.
//!
//! Not of the report, whose light has one wavelength. The reflectance rho of facets is a factor of every f and every mean of f, as
//! all facets that reflect from `i` to `o` meet the light under one angle. So what a lobe of one index reflects, times the ratio of two
//! reflectances, is what that of another index does; but for `Facets::masked_area`'s bound, which has rho as well: what is at it, on
//! calm seas near the horizon, is off by what dispersion makes of rho there.

use super::fresnel::Reflectance;
use super::lobe::cos_zeta;
use crate::numeric::packets::{Packets, Tabulated};
use crate::numeric::{Real, Scalar, Vec3};

/// First wavelength of the table, its step and their number, nm: of light that is seen.
const FIRST: f64 = 350.0;
const STEP: f64 = 5.0;
const STEPS: u32 = 100;

/// What follows the wavelength.
#[derive(Debug, Clone)]
pub struct Dispersion<T: Real> {
    /// Of the lobe.
    base: Reflectance<T::Density>,
    /// Of all wavelengths.
    extinction: T::Density,
    /// By intervals of the wavelength, at both ends: the index, and the whitecaps' BRDF over the lobe's.
    intervals: Packets,
}

impl Dispersion<f64> {
    /// Beside a lobe of this reflectance, for one extinction coefficient; `at` gives the index n and the whitecaps' BRDF over
    /// the lobe's at a wavelength in micrometres.
    pub fn new(base: Reflectance<f64>, extinction: f64, at: impl Fn(f64) -> [f64; 2]) -> Self {
        let intervals = (0..STEPS).flat_map(|k| {
            let start = FIRST + STEP * f64::from(k);
            // A step of the index, where the law of the salt begins, belongs to the interval behind it.
            let [[n0, foam0], [n1, foam1]] = [start, start + STEP * (1.0 - 1e-12)].map(|nm| at(1e-3 * nm));
            [n0, n1, foam0, foam1].map(|x| x as f32)
        });
        Self { base, extinction, intervals: Packets { width: 4, half: false, numbers: intervals.collect() } }
    }
}

impl<S: Scalar> Dispersion<S> {
    /// The same in another number type.
    pub fn cast<T: Real>(&self) -> Dispersion<T> {
        Dispersion {
            base: self.base.cast(),
            extinction: T::Density::coefficient(self.extinction.to_f64()),
            intervals: self.intervals.clone(),
        }
    }
}

impl<T: Tabulated> Dispersion<T> {
    /// The index n, and the whitecaps' BRDF over the lobe's, at a wavelength in nm; held beyond 350 and 850 nm.
    #[inline(always)]
    pub fn at(&self, wavelength: T) -> [T; 2] {
        let place = (wavelength - T::of(FIRST)) * T::of(1.0 / STEP);
        let (k, t) = T::min(T::max(place, T::of(0.0)), T::of(f64::from(STEPS))).step(STEPS);
        let [n0, n1, foam0, foam1] = T::lookup::<4>(&self.intervals, k, T::everywhere());
        [t.mul_add(n1 - n0, n0), t.mul_add(foam1 - foam0, foam0)]
    }

    /// Of an index n.
    #[inline(always)]
    pub fn reflectance(&self, n: T) -> Reflectance<T::Density> {
        let k = self.base.absorbing.then_some(self.extinction);
        Reflectance::of_index(n.to_density(), k, self.base.exact)
    }

    /// rho for indices n over the lobe's, between two directions.
    #[inline(always)]
    pub fn ratios<const N: usize>(&self, n: [T; N], i: Vec3<T>, o: Vec3<T>) -> [T; N] {
        let h = [i[0] + o[0], i[1] + o[1], i[2] + o[2]];
        let cos = cos_zeta(h).to_density();
        let over = T::Density::max(self.base.eval(cos), T::Density::TINY).recip();
        n.map(|n| T::from_density(self.reflectance(n).eval(cos) * over))
    }
}
