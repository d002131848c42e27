//! The number types the closed form is written over: one text for float64, float32 and lanes of float32.

use std::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Not, Sub};

pub(crate) mod sealed {
    /// Keeps [`super::Real`] to this crate's number types.
    pub trait Sealed {}
    impl Sealed for f32 {}
    impl Sealed for f64 {}
}

/// A real number of the closed form. Decisions are masks and selections, so that lanes and recorded kernels fit.
pub trait Real:
    sealed::Sealed
    + Copy
    + std::fmt::Debug
    + Neg<Output = Self>
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
{
    /// The outcome of a comparison.
    type Mask: Copy + BitAnd<Output = Self::Mask> + BitOr<Output = Self::Mask> + Not<Output = Self::Mask>;

    /// Extended precision, for tilts.
    type Extended: Extended<Self>;

    /// Tilts where their last digits do not matter.
    type Plain: Extended<Self>;

    /// The type of the factors of the slopes' density: Gram-Charlier's polynomial passes 100, and float64 costs a scalar little.
    type Density: Real<Density = Self::Density, Mask = Self::Mask>;

    /// The largest finite value.
    const MAX: Self;
    /// The smallest positive normal value.
    const TINY: Self;
    /// A value whose inverse has a finite fourth power.
    const SMALL: Self;

    /// The number nearest to `x`, a constant of the formula.
    fn of(x: f64) -> Self;
    /// The number nearest to `x`, which differs from sea to sea.
    fn coefficient(x: f64) -> Self;
    /// Rounded from the type of the density's factors.
    fn from_density(x: Self::Density) -> Self;
    /// In that type.
    fn to_density(self) -> Self::Density;
    /// `self < other`.
    fn lt(self, other: Self) -> Self::Mask;
    /// `a` where `mask` holds, else `b`.
    fn select(mask: Self::Mask, a: Self, b: Self) -> Self;
    /// Whether a mask may hold: where not, scalars leave out what depends on it. Always for lanes.
    fn may_hold(mask: Self::Mask) -> bool;
    /// The smaller one; `other` if `self` is not a number.
    fn min(self, other: Self) -> Self;
    /// The larger one; `other` if `self` is not a number.
    fn max(self, other: Self) -> Self;
    /// Magnitude.
    fn abs(self) -> Self;
    /// `self * a + b`, rounded once or twice, whichever is faster.
    fn mul_add(self, a: Self, b: Self) -> Self;
    /// Square root.
    fn sqrt(self) -> Self;
    /// `1/self`.
    fn recip(self) -> Self;
    /// `1/sqrt(self)`.
    fn rsqrt(self) -> Self;
    /// Natural exponential.
    fn exp(self) -> Self;
    /// `2^-self` of what is not negative.
    fn exp2_neg(self) -> Self;
    /// Natural logarithm of a positive number.
    fn ln(self) -> Self;
    /// Angle of the point (x, y) = (`other`, `self`), radians, for positive x.
    fn atan2(self, other: Self) -> Self;
    /// `atan(t)/t` of `self = t^2`.
    fn atan_over(self) -> Self;
    /// Sine and cosine of so many turns, from 0 to 1.
    fn sin_cos_turns(self) -> (Self, Self);
    /// `sin(x)/x` and `cos x` of `self = x^2`, up to a quarter turn's.
    fn sinc_cos(self) -> (Self, Self);
    /// `exp(-x^2)/sqrt(pi) - x erfc(x)` for `x >= 0`: the integral of erfc from x to infinity.
    fn ierfc(self) -> Self;
}

/// A number in more digits than `T` has, for tilts, whose rounding errors the Gaussian and the Gram-Charlier polynomial magnify
/// a thousandfold; or in as many, where that does not matter.
pub trait Extended<T: Real>: Copy + std::fmt::Debug + Neg<Output = Self> {
    /// `x`, which differs from sea to sea.
    fn coefficient(x: f64) -> Self;
    /// `x` exactly.
    fn from_real(x: T) -> Self;
    /// In as many digits as this type has.
    fn truncate(x: T::Extended) -> Self;
    /// `a + b`.
    fn sum(a: T, b: T) -> Self;
    /// `a b + c d`.
    fn sum_of_products(a: Self, b: Self, c: Self, d: Self) -> Self;
    /// The same number with its digits in order again, where large terms may have cancelled.
    fn normalize(self) -> Self;
    /// `self * coefficient`.
    fn times(self, coefficient: Self) -> Self;
    /// The larger one of `self` and a number.
    fn at_least(self, bound: T) -> Self;
    /// Clamped to `-bound` and `bound`.
    fn clamp(self, bound: f64) -> Self;
    /// `a` where `mask` holds, else `b`.
    fn select(mask: T::Mask, a: Self, b: Self) -> Self;
    /// `self/other` for a positive `other`.
    fn over(self, other: Self) -> Self;
    /// Angle of the point (x, y) = (`other`, `self`), radians, for positive x.
    fn atan(self, other: Self) -> Self;
    /// Angle of any point (x, y) = (`other`, `self`), radians.
    fn atan2(self, other: Self) -> Self;
    /// Rounded.
    fn to_real(self) -> T;
    /// In the type of the density's factors.
    fn to_density(self) -> T::Density;
    /// `2^-(u^2 + c^2)`.
    fn gauss(u: Self, c: Self) -> T::Density;
    /// `value` of a function at `self`, taken at the rounded `self`, corrected by the function's derivative there.
    fn corrected(self, value: T::Density, derivative: T::Density) -> T::Density;
}

/// One number: what lanes are not.
pub trait Scalar: Real<Mask = bool, Extended = f64, Plain = f64, Density = f64> + Send + Sync {
    /// `self < other`, as a branch.
    fn below(self, other: Self) -> bool;
    /// As float64, exactly.
    fn to_f64(self) -> f64;
}

macro_rules! scalar {
    ($float:ident, $small:expr) => {
        impl Real for $float {
            type Mask = bool;
            type Extended = f64;
            type Plain = f64;
            type Density = f64;
            const MAX: Self = $float::MAX;
            const TINY: Self = $float::MIN_POSITIVE;
            const SMALL: Self = $small;

            fn of(x: f64) -> Self {
                x as Self
            }
            fn coefficient(x: f64) -> Self {
                x as Self
            }
            fn from_density(x: f64) -> Self {
                x as Self
            }
            fn to_density(self) -> f64 {
                self.into()
            }
            fn lt(self, other: Self) -> bool {
                self < other
            }
            fn select(mask: bool, a: Self, b: Self) -> Self {
                if mask { a } else { b }
            }
            fn may_hold(mask: bool) -> bool {
                mask
            }
            fn min(self, other: Self) -> Self {
                if self < other { self } else { other }
            }
            fn max(self, other: Self) -> Self {
                if self > other { self } else { other }
            }
            fn abs(self) -> Self {
                self.abs()
            }
            fn mul_add(self, a: Self, b: Self) -> Self {
                self * a + b
            }
            fn sqrt(self) -> Self {
                self.sqrt()
            }
            fn recip(self) -> Self {
                self.recip()
            }
            fn rsqrt(self) -> Self {
                self.sqrt().recip()
            }
            fn exp(self) -> Self {
                self.exp()
            }
            fn exp2_neg(self) -> Self {
                (-self).exp2()
            }
            fn ln(self) -> Self {
                self.ln()
            }
            fn atan2(self, other: Self) -> Self {
                self.atan2(other)
            }
            fn atan_over(self) -> Self {
                let t = Real::max(self, $float::MIN_POSITIVE).sqrt();
                t.atan() / t
            }
            fn sin_cos_turns(self) -> (Self, Self) {
                ($float::of(std::f64::consts::TAU) * self).sin_cos()
            }
            fn sinc_cos(self) -> (Self, Self) {
                let x = Real::max(self, $float::MIN_POSITIVE).sqrt();
                let (sin, cos) = x.sin_cos();
                (sin / x, cos)
            }
            fn ierfc(self) -> Self {
                ierfc::$float(self)
            }
        }

        impl Extended<$float> for f64 {
            fn coefficient(x: f64) -> Self {
                x
            }
            fn from_real(x: $float) -> Self {
                x.into()
            }
            fn truncate(x: f64) -> Self {
                x
            }
            fn sum(a: $float, b: $float) -> Self {
                f64::from(a) + f64::from(b)
            }
            fn sum_of_products(a: Self, b: Self, c: Self, d: Self) -> Self {
                a * b + c * d
            }
            fn normalize(self) -> Self {
                self
            }
            fn times(self, coefficient: Self) -> Self {
                self * coefficient
            }
            fn at_least(self, bound: $float) -> Self {
                Real::max(self, bound.into())
            }
            fn clamp(self, bound: f64) -> Self {
                Real::max(Real::min(self, bound), -bound)
            }
            fn select(mask: bool, a: Self, b: Self) -> Self {
                if mask { a } else { b }
            }
            fn over(self, other: Self) -> Self {
                self / other
            }
            fn atan(self, other: Self) -> Self {
                self.atan2(other)
            }
            fn atan2(self, other: Self) -> Self {
                // Nothing over a zero of whatever sign is no tilt, not half a turn.
                self.atan2(other + 0.0)
            }
            fn to_real(self) -> $float {
                self as $float
            }
            fn to_density(self) -> f64 {
                self
            }
            fn gauss(u: Self, c: Self) -> f64 {
                (-(u * u + c * c)).exp2()
            }
            fn corrected(self, value: f64, _derivative: f64) -> f64 {
                value
            }
        }

        impl Scalar for $float {
            fn below(self, other: Self) -> bool {
                self < other
            }
            fn to_f64(self) -> f64 {
                self.into()
            }
        }
    };
}

scalar!(f32, 1e-9);
scalar!(f64, 1e-70);

/// Coefficients of `ierfc(x) = (b_0 + b_1 x + ... + b_9 x^9)^2` up to [`IERFC_END`], minimax for the error relative to
/// `x + ierfc(x)/2`, which is what the shadowing function passes on: 1.6e-7, and 4e-7 evaluated in float32. Neither an
/// exponential nor a quotient is needed. The Dr.Jit twin reads the same numbers.
pub const IERFC: [f32; 10] = [
    0.751_125_6,
    -0.665_670_75,
    0.080_643_88,
    0.071_178_935,
    -0.003_090_579_8,
    -0.011_186_989,
    -0.000_645_788_27,
    0.002_451_421_7,
    -0.000_692_992_6,
    6.223_532_5e-5,
];
/// Beyond it ierfc is taken for constant: below 1.4e-6.
pub const IERFC_END: f32 = 3.2;

mod ierfc {
    /// By the library's erfc.
    pub fn f64(x: f64) -> f64 {
        // Most directions are this steep: 1e-30 of what it is added to.
        if x > 8.0 {
            return 0.0;
        }
        (-x * x).exp() * std::f64::consts::FRAC_2_SQRT_PI / 2.0 - x * libm::erfc(x)
    }

    /// By the polynomial that lanes use too.
    pub fn f32(x: f32) -> f32 {
        super::single_ierfc(x)
    }
}

/// [`Real::ierfc`] in single precision.
#[inline(always)]
pub(crate) fn single_ierfc<T: Real>(x: T) -> T {
    let root = polynomial(&IERFC, T::min(x, T::of(IERFC_END.into())));
    root * root
}

/// A polynomial with coefficients of rising order.
#[inline(always)]
pub(crate) fn polynomial<const N: usize, T: Real>(coefficients: &[f32; N], x: T) -> T {
    let mut sum = T::of(coefficients[N - 1].into());
    let mut k = N - 1;
    while k > 0 {
        k -= 1;
        sum = sum.mul_add(x, T::of(coefficients[k].into()));
    }
    sum
}

/// A direction or normal, `[x, y, z]`.
pub type Vec3<T> = [T; 3];

/// Scalar product.
#[inline(always)]
pub fn dot<T: Real>(a: Vec3<T>, b: Vec3<T>) -> T {
    a[2].mul_add(b[2], a[1].mul_add(b[1], a[0] * b[0]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ierfc_of_float32_follows_float64() {
        for i in 0..=6000 {
            let x = f64::from(i) * 1e-3;
            let error = (f64::from((x as f32).ierfc()) - x.ierfc()).abs() / (x + x.ierfc() / 2.0);
            assert!(error < 6e-7, "x = {x}: {error}");
        }
    }

    #[test]
    fn ierfc_is_the_integral_of_erfc() {
        let (a, b, n) = (0.3f64, 1.1f64, 2000);
        let h = (b - a) / f64::from(n);
        let sum: f64 = (0..n).map(|i| libm::erfc(a + (f64::from(i) + 0.5) * h) * h).sum();
        assert!((a.ierfc() - b.ierfc() - sum).abs() < 1e-7);
    }
}
