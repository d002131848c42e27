//! Light that comes back from below the surface: a Lambertian water body under level water, between the whitecaps.
//!
//! Not of the report, which stops at the surface. The water lets `1 - rho` in and out again, and a share `1 - W` is free of
//! whitecaps: `f = R (1 - rho(theta_i)) (1 - rho(theta_o)) (1 - W)/pi` for a reflectance `R` of the water body.

use super::lobe::{Lobe, Parts};
use super::sampling::FACET_ALBEDO_FLOOR;
use crate::numeric::{Real, Vec3};
use std::f64::consts::{FRAC_1_PI, PI};

impl<T: Real> Lobe<T> {
    /// `1 - rho` of a cosine, which is clamped to 0 and 1.
    #[inline(always)]
    fn transmittance(&self, cos: T) -> T {
        let cos = T::min(T::max(cos, T::of(0.0)), T::of(1.0));
        T::of(1.0) - T::from_density(self.facets.reflectance.eval(cos.to_density()))
    }

    /// `f cos(theta_o)` for a water body that reflects everything, 1/sr, and the density of draws by cosine, 1/sr; 0 below the
    /// horizon.
    #[inline(always)]
    pub fn water_leaving(&self, i: Vec3<T>, o: Vec3<T>) -> [T; 2] {
        let zero = T::of(0.0);
        let density = T::select(T::lt(zero, i[2]), T::max(o[2], zero) * T::of(FRAC_1_PI), zero);
        let through = self.transmittance(i[2]) * self.transmittance(o[2]);
        [through * self.smooth_fraction * density, density]
    }

    /// The share of draws for a water body of some reflectance, beside those for some parts of the surface: by what each
    /// reflects, roughly.
    #[inline(always)]
    pub fn water_leaving_share(&self, i: Vec3<T>, reflectance: T, parts: Parts) -> T {
        let through = self.transmittance(i[2]);
        let rho = T::of(1.0) - through;
        let below = reflectance * through * self.smooth_fraction;
        let mut all = below;
        if parts.facets {
            all = (rho + T::of(FACET_ALBEDO_FLOOR)).mul_add(self.smooth_fraction, all);
        }
        if parts.whitecaps {
            all = self.whitecap_albedo() + all;
        }
        below / T::max(all, T::of(1e-9))
    }

    /// Diffuse reflectance of the whitecaps, by the share that they cover.
    #[inline(always)]
    pub fn whitecap_albedo(&self) -> T {
        T::of(PI) * self.whitecap_brdf * self.whitecap_fraction
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Parameters;

    /// The mean of `f cos` over a hemisphere of directions is the water's transmittance both ways, and shares add up.
    #[test]
    fn energy_and_shares() {
        let lobe = Parameters::default().configure().unwrap().lobe().unwrap().with_whitecaps(0.25);
        let i = [0.6, 0.0, 0.8];
        let count = 20_000;
        let albedo: f64 = (0..count)
            .map(|k| {
                let z = (k as f64 + 0.5) / count as f64;
                2.0 * PI * lobe.water_leaving(i, [(1.0 - z * z).sqrt(), 0.0, z])[0] / count as f64
            })
            .sum();
        let transmittance = 1.0 - lobe.facets.reflectance.eval(0.8);
        let diffuse: f64 = (0..count)
            .map(|k| {
                (1.0 - lobe.facets.reflectance.eval(((k as f64 + 0.5) / count as f64).sqrt())) / count as f64
            })
            .sum();
        assert!((albedo / (0.75 * transmittance * diffuse) - 1.0).abs() < 1e-6, "{albedo}");

        let [value, density] = lobe.water_leaving(i, [0.0, 0.6, -0.8]);
        assert_eq!([value, density], [0.0, 0.0]);
        assert_eq!(lobe.water_leaving([0.6, 0.0, -0.8], i), [0.0, 0.0]);
        let share = |parts| lobe.water_leaving_share(i, 0.5, parts);
        let (facets, whitecaps, both) = (share(Parts::FACETS), share(Parts::WHITECAPS), share(Parts::ALL));
        // 1/share is 1 and what the others reflect over what the water body does.
        assert!((1.0 / facets + 1.0 / whitecaps - 1.0 - 1.0 / both).abs() < 1e-12);
        assert_eq!(lobe.water_leaving_share(i, 0.0, Parts::ALL), 0.0);
    }
}
