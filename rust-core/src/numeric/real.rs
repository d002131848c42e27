//! The number types the closed form is written over: one text for float64, float32 and lanes of float32.

use std::ops::{Add, BitAnd, Div, Mul, Neg, Sub};

pub(crate) mod sealed {
    pub trait Sealed {}
    impl Sealed for f32 {}
    impl Sealed for f64 {}
}

/// A real number of the closed form. Decisions are masks and selections, so that lanes fit.
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
    type Mask: Copy + BitAnd<Output = Self::Mask>;

    /// A type with digits to spare for the tilts.
    type Wide: Wide<Self>;

    /// The type of the factors beside Gram-Charlier's polynomial, which passes 100, and of itself: one with digits to spare
    /// where that costs little.
    type Fine: Real<Fine = Self::Fine>;

    /// The largest finite value.
    const MAX: Self;
    /// The smallest positive normal value.
    const TINY: Self;
    /// A value whose inverse has a finite fourth power.
    const SMALL: Self;

    /// The number nearest to `x`.
    fn of(x: f64) -> Self;
    /// Rounded from the type of the density's factors.
    fn rounded(fine: Self::Fine) -> Self;
    /// In that type.
    fn fine(self) -> Self::Fine;
    /// `self < other`.
    fn lt(self, other: Self) -> Self::Mask;
    /// `a` where `mask` holds, else `b`.
    fn select(mask: Self::Mask, a: Self, b: Self) -> Self;
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
    /// Natural exponential.
    fn exp(self) -> Self;
    /// Angle of the point (x, y) = (`other`, `self`), radians.
    fn atan2(self, other: Self) -> Self;
    /// `exp(-x^2)/sqrt(pi) - x erfc(x)` for `x >= 0`: the integral of erfc from x to infinity.
    fn ierfc(self) -> Self;
}

/// A number with digits to spare beyond those of `T`: for the tilts, whose rounding errors the Gaussian and the
/// Gram-Charlier polynomial magnify a thousandfold.
pub trait Wide<T: Real>:
    Copy + std::fmt::Debug + Neg<Output = Self> + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self>
{
    /// The number nearest to `x`.
    fn of(x: f64) -> Self;
    /// `x`, with digits to spare.
    fn widen(x: T) -> Self;
    /// `a + b`, with digits to spare.
    fn sum(a: T, b: T) -> Self;
    /// Rounded.
    fn narrow(self) -> T;
    /// In the type of the density's factors.
    fn fine(self) -> T::Fine;
    /// `self/other`, or 1e6 where `other` is not positive.
    fn slope(self, other: Self) -> Self;
    /// Angle of the point (x, y) = (`other`, `self`), radians.
    fn atan2(self, other: Self) -> Self;
    /// Natural exponential of a number that is not positive.
    fn exp(self) -> T::Fine;
}

/// One number: what lanes are not.
pub trait Scalar: Real<Wide = f64, Fine = f64> + Send + Sync {
    /// `self < other`, as a branch.
    fn below(self, other: Self) -> bool;
    /// As float64, exactly.
    fn to_f64(self) -> f64;
    /// Natural logarithm.
    fn ln(self) -> Self;
    /// Sine and cosine of an angle in radians.
    fn sin_cos(self) -> (Self, Self);
}

macro_rules! scalar {
    ($float:ident, $small:expr) => {
        impl Real for $float {
            type Mask = bool;
            type Wide = f64;
            type Fine = f64;
            const MAX: Self = $float::MAX;
            const TINY: Self = $float::MIN_POSITIVE;
            const SMALL: Self = $small;

            fn of(x: f64) -> Self {
                x as Self
            }
            fn rounded(fine: f64) -> Self {
                fine as Self
            }
            fn fine(self) -> f64 {
                self.into()
            }
            fn lt(self, other: Self) -> bool {
                self < other
            }
            fn select(mask: bool, a: Self, b: Self) -> Self {
                if mask { a } else { b }
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
            fn exp(self) -> Self {
                self.exp()
            }
            fn atan2(self, other: Self) -> Self {
                self.atan2(other)
            }
            fn ierfc(self) -> Self {
                ierfc::$float(self)
            }
        }

        impl Wide<$float> for f64 {
            fn of(x: f64) -> Self {
                x
            }
            fn widen(x: $float) -> Self {
                x.into()
            }
            fn sum(a: $float, b: $float) -> Self {
                f64::from(a) + f64::from(b)
            }
            fn narrow(self) -> $float {
                self as $float
            }
            fn fine(self) -> f64 {
                self
            }
            fn slope(self, other: Self) -> Self {
                if other > 0.0 { self / Real::max(other, f64::MIN_POSITIVE) } else { 1e6 }
            }
            fn atan2(self, other: Self) -> Self {
                // Nothing over a zero of whatever sign is no tilt, not half a turn.
                self.atan2(other + 0.0)
            }
            fn exp(self) -> f64 {
                self.exp()
            }
        }

        impl Scalar for $float {
            fn below(self, other: Self) -> bool {
                self < other
            }
            fn to_f64(self) -> f64 {
                self.into()
            }
            fn ln(self) -> Self {
                self.ln()
            }
            fn sin_cos(self) -> (Self, Self) {
                self.sin_cos()
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
    pub fn f64(x: f64) -> f64 {
        // Most directions are this steep: 1e-30 of what it is added to.
        if x > 8.0 {
            return 0.0;
        }
        (-x * x).exp() * std::f64::consts::FRAC_2_SQRT_PI / 2.0 - x * libm::erfc(x)
    }

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

/// A function of every coordinate. Unlike an array's own `map` it is inlined into lanes whatever the function.
#[inline(always)]
pub(crate) fn each<T: Copy, U>(v: [T; 3], f: impl Fn(T) -> U) -> [U; 3] {
    [f(v[0]), f(v[1]), f(v[2])]
}

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
