//! What water reflects: refractive index and Eqs. 62-63.

use crate::numeric::Real;

/// Which reflectance of a smooth facet.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Fresnel {
    /// Schlick's approximation, Eq. 63.
    #[default]
    Schlick,
    /// Fresnel's equations for unpolarised light, with the complex index where water absorbs.
    Exact,
}

/// Hale and Querry (1973): wavelength in micrometres, n, k of pure water.
const HALE_QUERRY: &str = include_str!("../../data/water_nk_hale_querry_1973.csv");

/// First and last wavelength of the table, micrometres.
pub const WAVELENGTHS: [f64; 2] = [0.2, 200.0];

/// What salt adds to the index for every per mille of it: Friedman (1969), as 6S uses it.
const SALT_PER_MILLE: f64 = 0.000_174_927_11;

/// Wavelengths in micrometres at which salt's part of the index was measured: Friedman from 1.5 on, Quan and Fry in the visible,
/// where both agree to 10 % (`salt_agrees_with_quan_and_fry`); between the two it is taken as the same.
const SALT_MEASURED: [f64; 2] = [0.4, 14.0];

/// What a salinity in per mille adds to the index of pure water at a wavelength in micrometres; nothing where it was not
/// measured.
pub fn salt(wavelength: f64, salinity: f64) -> f64 {
    if (SALT_MEASURED[0]..=SALT_MEASURED[1]).contains(&wavelength) { SALT_PER_MILLE * salinity } else { 0.0 }
}

/// Wavelengths in micrometres for which [`quan_fry`] holds.
pub const QUAN_FRY: [f64; 2] = [0.4, 0.7];

/// Refractive index of sea water at a wavelength in micrometres, a temperature in degrees Celsius (0 to 30) and a salinity in
/// per mille (0 to 35): Quan and Fry, Appl. Opt. 34, 3477 (1995), Eq. 3.
pub fn quan_fry(wavelength: f64, temperature: f64, salinity: f64) -> f64 {
    let (l, t, s) = (1000.0 * wavelength, temperature, salinity);
    1.314_05 + (1.779e-4 - 1.05e-6 * t + 1.6e-8 * t * t) * s - 2.02e-6 * t * t
        + (15.868 + 0.011_55 * s - 0.004_23 * t) / l
        - 4382.0 / (l * l)
        + 1.1455e6 / (l * l * l)
}

/// Refractive index n and extinction coefficient k of pure water at a wavelength in micrometres, linear between the entries of
/// Hale and Querry; held at the ends of the table.
pub fn pure_water(wavelength: f64) -> [f64; 2] {
    let mut previous: Option<[f64; 3]> = None;
    for line in HALE_QUERRY.lines().skip(1) {
        let mut fields =
            line.split(',').map(|x| x.trim().parse::<f64>().expect("a number in the embedded table"));
        let entry @ [l, n, k] = std::array::from_fn(|_| fields.next().expect("three columns"));
        if wavelength <= l {
            return match previous {
                Some([l0, n0, k0]) => {
                    let t = (wavelength - l0) / (l - l0);
                    [n0 + (n - n0) * t, k0 + (k - k0) * t]
                }
                None => [n, k],
            };
        }
        previous = Some(entry);
    }
    let [_, n, k] = previous.expect("the embedded table has rows");
    [n, k]
}

/// Relative change of the normal reflectance below which absorption is left out.
const NEGLIGIBLE: f64 = 1e-7;

/// The extinction coefficient, or 0 where it does not matter to the reflectance: in the visible it changes not a digit.
pub fn relevant_extinction(ior: f64, extinction: f64) -> f64 {
    let transparent = normal_reflectance(ior, 0.0);
    let matters = normal_reflectance(ior, extinction) - transparent > NEGLIGIBLE * transparent;
    if matters { extinction } else { 0.0 }
}

/// Reflectance at normal incidence, Eq. 62, of the complex index `n + i k`.
pub fn normal_reflectance(ior: f64, extinction: f64) -> f64 {
    let k2 = extinction * extinction;
    if k2 == 0.0 {
        ((ior - 1.0) / (ior + 1.0)).powi(2)
    } else {
        ((ior - 1.0).powi(2) + k2) / ((ior + 1.0).powi(2) + k2)
    }
}

/// Reflectance of a facet under the angle zeta, unpolarised.
#[derive(Debug, Clone, Copy)]
#[repr(C)]
pub struct Reflectance<T> {
    /// rho_n, Eq. 62.
    pub normal: T,
    /// n^2 - k^2 - 1.
    pub excess: T,
    /// (2 n k)^2.
    pub absorption: T,
    /// Fresnel's equations instead of Schlick's.
    pub exact: bool,
    /// Whether k is not 0.
    pub absorbing: bool,
}

impl Reflectance<f64> {
    /// Of a complex refractive index `n + i k`.
    pub fn new([n, k]: [f64; 2], fresnel: Fresnel) -> Self {
        Self::of_index(n, (k > 0.0).then_some(k), fresnel == Fresnel::Exact)
    }

    /// The same in another number type.
    pub fn cast<T: Real>(&self) -> Reflectance<T> {
        Reflectance {
            normal: T::coefficient(self.normal),
            excess: T::coefficient(self.excess),
            absorption: T::coefficient(self.absorption),
            exact: self.exact,
            absorbing: self.absorbing,
        }
    }
}

impl<T: Real> Reflectance<T> {
    /// Of an index n and, where water absorbs, an extinction coefficient k.
    #[inline(always)]
    pub(crate) fn of_index(n: T, k: Option<T>, exact: bool) -> Self {
        let (zero, one) = (T::of(0.0), T::of(1.0));
        let [less, more] = [n - one, n + one];
        let (mut normal, mut excess, mut absorption) = (less / more, n * n, zero);
        normal = normal * normal;
        if let Some(k) = k {
            let (k2, twice) = (k * k, T::of(2.0) * n * k);
            normal = (less * less + k2) / (more * more + k2);
            excess = excess - k2;
            absorption = twice * twice;
        }
        Self { normal, excess: excess - one, absorption, exact, absorbing: k.is_some() }
    }

    /// rho(zeta) for the cosine of zeta.
    #[inline(always)]
    pub fn eval(&self, cos: T) -> T {
        match (self.exact, self.absorbing) {
            (false, _) => self.schlick(cos),
            (true, false) => self.exact(cos),
            (true, true) => self.absorbing(cos),
        }
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

impl<T: Real> Reflectance<T> {
    /// Fresnel's equations of the complex index: `a + i b` is the square root of `n^2 - sin^2` (Born and Wolf, section 14.2).
    #[inline(always)]
    fn absorbing(&self, cos: T) -> T {
        let (zero, one, half) = (T::of(0.0), T::of(1.0), T::of(0.5));
        let p = cos.mul_add(cos, self.excess);
        // a^2 and b^2 are (q + p)/2 and (q - p)/2; their product is known, so neither is a difference.
        let larger = half * (p.mul_add(p, self.absorption).sqrt() + p.abs());
        let smaller = T::of(0.25) * self.absorption / T::max(larger, T::TINY);
        let backwards = T::lt(p, zero);
        let a = T::select(backwards, smaller, larger).sqrt();
        let b2 = T::select(backwards, larger, smaller);
        let sin2 = T::max((-cos).mul_add(cos, one), zero);
        let square = |x: T, y: T| x.mul_add(x, y);
        let rs = square(a - cos, b2) / square(a + cos, b2);
        let (ac, b2c2) = (a * cos, b2 * cos * cos);
        let rp = rs * square(ac - sin2, b2c2) / T::max(square(ac + sin2, b2c2), T::TINY);
        half * (rs + rp)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sea::Salinity;

    #[test]
    fn index_is_the_table_at_its_entries_and_linear_between() {
        assert_eq!(pure_water(0.2), [1.396, 1.1e-7]);
        assert_eq!(pure_water(200.0), [2.130, 0.504]);
        assert!((pure_water(0.55)[0] - 1.333).abs() < 1e-15);
        let [n, k] = pure_water(0.2125);
        assert!((n - 0.5 * (1.396 + 1.373)).abs() < 1e-12 && (k - 0.5 * (1.1e-7 + 4.9e-8)).abs() < 1e-18);
    }

    /// Salt by Friedman is what it was, and is left out where nobody measured it.
    #[test]
    fn salt_counts_where_it_was_measured() {
        let sea = Salinity::Ocean.per_mille();
        for (wavelength, expected) in
            [(0.3, 0.0), (0.4, 0.006_004), (3.0, 0.006_004), (14.0, 0.006_004), (15.0, 0.0)]
        {
            assert!((salt(wavelength, sea) - expected).abs() < 1e-6);
        }
        assert_eq!(salt(0.55, Salinity::Fresh.per_mille()), 0.0);
    }

    /// Published values of sea and pure water, the table of Hale and Querry (which is 0.004 lower in the violet), and the two laws
    /// of salt.
    #[test]
    fn salt_agrees_with_quan_and_fry() {
        assert!((quan_fry(0.55, 20.0, 35.0) - 1.340_79).abs() < 5e-6, "{}", quan_fry(0.55, 20.0, 35.0));
        // The D line of sodium.
        assert!((quan_fry(0.5893, 20.0, 0.0) - 1.332_99).abs() < 5e-5);
        for k in 0..=30 {
            let wavelength = 0.4 + 0.01 * f64::from(k);
            let [table, _] = pure_water(wavelength);
            assert!((quan_fry(wavelength, 25.0, 0.0) - table).abs() < 4e-3, "{wavelength}");
            let added = quan_fry(wavelength, 20.0, 35.0) - quan_fry(wavelength, 20.0, 0.0);
            assert!((added / salt(wavelength, 35.0) - 1.0).abs() < 0.1, "{wavelength}: {added}");
        }
        // Warmer water and longer waves refract less.
        assert!(quan_fry(0.5, 25.0, 35.0) < quan_fry(0.5, 5.0, 35.0));
        assert!(quan_fry(0.7, 20.0, 35.0) < quan_fry(0.4, 20.0, 35.0));
    }

    #[test]
    fn exact_reflectance_is_fresnels() {
        let n = 1.34f64;
        let r = Reflectance::new([n, 0.0], Fresnel::Exact);
        for degrees in [0.0f64, 10.0, 45.0, 53.26, 80.0, 89.9] {
            let (c, s) = (degrees.to_radians().cos(), degrees.to_radians().sin());
            let g = (1.0 - (s / n) * (s / n)).sqrt();
            let (rs, rp) = ((c - n * g) / (c + n * g), (n * c - g) / (n * c + g));
            assert!((r.eval(c) - 0.5 * (rs * rs + rp * rp)).abs() < 1e-14);
        }
        assert!((r.eval(1.0) - normal_reflectance(n, 0.0)).abs() < 1e-16);
        assert!((r.eval(0.0) - 1.0).abs() < 1e-15);
        assert!((r.schlick(0.0) - 1.0).abs() < 1e-15);
        assert_eq!(Reflectance::new([1.0, 0.0], Fresnel::Exact).eval(0.5), 0.0);
    }

    /// docs/model.md: Schlick against exact is -19 % at 45 degrees, -14 % at 60, +15 % at 80.
    #[test]
    fn schlick_errs_as_documented() {
        let (s, e) =
            (Reflectance::new([1.33, 0.0], Fresnel::Schlick), Reflectance::new([1.33, 0.0], Fresnel::Exact));
        for (degrees, error) in [(45.0f64, -0.194), (60.0, -0.14), (80.0, 0.15)] {
            let c = degrees.to_radians().cos();
            assert!((s.eval(c) / e.eval(c) - 1.0 - error).abs() < 0.006);
        }
    }

    /// Against the square root and the quotients of complex numbers, multiplied out.
    #[test]
    fn absorbing_reflectance_is_fresnels() {
        type Complex = [f64; 2];
        let times = |[a, b]: Complex, [c, d]: Complex| [a * c - b * d, a * d + b * c];
        let norm2 = |[a, b]: Complex| a * a + b * b;
        for (n, k) in [(1.371, 0.272), (1.142, 0.2), (1.111, 0.199), (2.13, 0.504), (1.05, 3.0), (1.33, 1e-6)]
        {
            let r = Reflectance::new([n, k], Fresnel::Exact);
            for degrees in [0.0f64, 20.0, 53.0, 70.0, 85.0, 89.9] {
                let (sin, cos) = degrees.to_radians().sin_cos();
                let index2 = times([n, k], [n, k]);
                let below = [index2[0] - sin * sin, index2[1]];
                let magnitude = norm2(below).sqrt().sqrt();
                let angle = 0.5 * below[1].atan2(below[0]);
                let root = [magnitude * angle.cos(), magnitude * angle.sin()];
                let rs = norm2([cos - root[0], -root[1]]) / norm2([cos + root[0], root[1]]);
                let p = times(index2, [cos, 0.0]);
                let rp = norm2([p[0] - root[0], p[1] - root[1]]) / norm2([p[0] + root[0], p[1] + root[1]]);
                let expected = 0.5 * (rs + rp);
                assert!(
                    (r.eval(cos) / expected - 1.0).abs() < 1e-12,
                    "{n} {k} {degrees}: {} {expected}",
                    r.eval(cos)
                );
                let single = f64::from(r.cast::<f32>().eval(cos as f32));
                assert!((single / expected - 1.0).abs() < 1e-5);
            }
            assert!((r.eval(1.0) / r.normal - 1.0).abs() < 1e-13 && (r.eval(0.0) - 1.0).abs() < 1e-15);
        }
        // Without absorption it is the other formula.
        let (transparent, faint) =
            (Reflectance::new([1.34, 0.0], Fresnel::Exact), Reflectance::new([1.34, 1e-12], Fresnel::Exact));
        for k in 0..=100 {
            let cos = f64::from(k) / 100.0;
            assert!((transparent.eval(cos) / faint.eval(cos) - 1.0).abs() < 1e-13);
        }
    }

    /// What leaving k out makes of the normal reflectance, in percent, by micrometres: docs/model.md. In the visible nothing.
    #[test]
    fn absorption_matters_in_the_infrared() {
        for (wavelength, percent) in
            [(2.8, -39.0), (2.95, -50.0), (3.0, -34.0), (10.5, -11.0), (12.0, -76.0), (12.5, -81.0)]
        {
            let [n, k] = pure_water(wavelength);
            let change = 100.0 * (normal_reflectance(n, 0.0) / normal_reflectance(n, k) - 1.0);
            assert!((change - percent).abs() < 1.0, "{wavelength}: {change}");
            assert_eq!(relevant_extinction(n, k), k);
        }
        for wavelength in [0.3, 0.4, 0.55, 0.7, 0.8, 1.064] {
            let [n, k] = pure_water(wavelength);
            assert!(k > 0.0 && relevant_extinction(n, k) == 0.0, "{wavelength}");
        }
    }
}
