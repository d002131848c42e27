//! What water reflects: refractive index and Eqs. 62-63.

use crate::numeric::Real;

/// Which reflectance of a smooth facet.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Fresnel {
    /// Schlick's approximation, Eq. 63.
    #[default]
    Schlick,
    /// Fresnel's equations for unpolarised light and the same index.
    Exact,
}

/// Hale and Querry (1973): wavelength in micrometres, n, k of pure water.
const HALE_QUERRY: &str = include_str!("../../data/water_nk_hale_querry_1973.csv");

/// First and last wavelength of the table, micrometres.
pub const WAVELENGTHS: [f64; 2] = [0.2, 200.0];

/// What sea salt adds to the index: Friedman (1969) as 6S uses it, chlorinity 19 g/kg.
pub const SEA_SALT: f64 = 0.000_174_927_11 * (0.03 + 1.805 * 19.0);

/// Refractive index of pure water at a wavelength in micrometres, linear between the entries of
/// Hale and Querry; held at the ends of the table.
pub fn pure_water(wavelength: f64) -> f64 {
    let mut previous: Option<(f64, f64)> = None;
    for line in HALE_QUERRY.lines().skip(1) {
        let mut fields =
            line.split(',').map(|x| x.trim().parse::<f64>().expect("a number in the embedded table"));
        let (l, n) = (fields.next().expect("wavelength"), fields.next().expect("n"));
        if wavelength <= l {
            return match previous {
                Some((l0, n0)) => n0 + (n - n0) * (wavelength - l0) / (l - l0),
                None => n,
            };
        }
        previous = Some((l, n));
    }
    previous.expect("the embedded table has rows").1
}

/// Reflectance at normal incidence, Eq. 62.
pub fn normal_reflectance(ior: f64) -> f64 {
    ((ior - 1.0) / (ior + 1.0)).powi(2)
}

/// Reflectance of a facet under the angle zeta, unpolarised.
#[derive(Debug, Clone, Copy)]
#[repr(C)]
pub struct Reflectance<T> {
    /// rho_n, Eq. 62.
    pub normal: T,
    /// n^2 - 1.
    pub excess: T,
    /// Fresnel's equations instead of Schlick's.
    pub exact: bool,
}

impl Reflectance<f64> {
    /// Of a refractive index.
    pub fn new(ior: f64, fresnel: Fresnel) -> Self {
        Self { normal: normal_reflectance(ior), excess: ior * ior - 1.0, exact: fresnel == Fresnel::Exact }
    }

    /// The same in another number type.
    pub fn cast<T: Real>(&self) -> Reflectance<T> {
        Reflectance {
            normal: T::coefficient(self.normal),
            excess: T::coefficient(self.excess),
            exact: self.exact,
        }
    }
}

impl<T: Real> Reflectance<T> {
    /// rho(zeta) for the cosine of zeta.
    #[inline(always)]
    pub fn eval(&self, cos: T) -> T {
        if self.exact { self.exact(cos) } else { self.schlick(cos) }
    }

    /// Schlick's approximation, Eq. 63.
    #[inline(always)]
    pub fn schlick(&self, cos: T) -> T {
        let m = T::max(T::of(1.0) - cos, T::of(0.0));
        let m2 = m * m;
        (m2 * m2 * m).mul_add(T::of(1.0) - self.normal, self.normal)
    }

    /// Fresnel's equations; the differences of near-equal numbers are multiplied out.
    #[inline(always)]
    fn exact(&self, cos: T) -> T {
        let (one, excess) = (T::of(1.0), self.excess);
        let g = T::sqrt(cos.mul_add(cos, excess));
        let s = cos + g;
        let p = excess.mul_add(cos, s);
        let rs = excess / T::max(s * s, T::TINY);
        let rp = excess * (excess + one + one).mul_add(cos * cos, -one) / T::max(p * p, T::TINY);
        T::of(0.5) * rs.mul_add(rs, rp * rp)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn index_is_the_table_at_its_entries_and_linear_between() {
        assert_eq!(pure_water(0.2), 1.396);
        assert_eq!(pure_water(200.0), 2.130);
        assert!((pure_water(0.55) - 1.333).abs() < 1e-15);
        assert!((pure_water(0.2125) - 0.5 * (1.396 + 1.373)).abs() < 1e-12);
        assert!((SEA_SALT - 0.006_004).abs() < 1e-6);
    }

    #[test]
    fn exact_reflectance_is_fresnels() {
        let n = 1.34f64;
        let r = Reflectance::new(n, Fresnel::Exact);
        for degrees in [0.0f64, 10.0, 45.0, 53.26, 80.0, 89.9] {
            let (c, s) = (degrees.to_radians().cos(), degrees.to_radians().sin());
            let g = (1.0 - (s / n) * (s / n)).sqrt();
            let (rs, rp) = ((c - n * g) / (c + n * g), (n * c - g) / (n * c + g));
            assert!((r.eval(c) - 0.5 * (rs * rs + rp * rp)).abs() < 1e-14);
        }
        assert!((r.eval(1.0) - normal_reflectance(n)).abs() < 1e-16);
        assert!((r.eval(0.0) - 1.0).abs() < 1e-15);
        assert!((r.schlick(0.0) - 1.0).abs() < 1e-15);
        assert_eq!(Reflectance::new(1.0, Fresnel::Exact).eval(0.5), 0.0);
    }

    /// docs/model.md: Schlick against exact is -19 % at 45 degrees, -14 % at 60, +15 % at 80.
    #[test]
    fn schlick_errs_as_documented() {
        let (s, e) = (Reflectance::new(1.33, Fresnel::Schlick), Reflectance::new(1.33, Fresnel::Exact));
        for (degrees, error) in [(45.0f64, -0.194), (60.0, -0.14), (80.0, 0.15)] {
            let c = degrees.to_radians().cos();
            assert!((s.eval(c) / e.eval(c) - 1.0 - error).abs() < 0.006);
        }
    }
}
