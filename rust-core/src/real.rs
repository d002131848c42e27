//! The number types the closed form is written over: one text for float64, float32 and, later, lanes.

use std::ops::{Add, BitAnd, Div, Mul, Neg, Sub};

mod sealed {
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

    /// A type with digits to spare for the tilts, whose rounding errors the Gaussian and the
    /// Gram-Charlier polynomial magnify a thousandfold.
    type Wide: Real<Wide = Self::Wide, Mask = Self::Mask>;

    /// The largest finite value.
    const MAX: Self;
    /// The smallest positive normal value.
    const TINY: Self;

    /// The number nearest to `x`.
    fn of(x: f64) -> Self;
    /// `self < other`.
    fn lt(self, other: Self) -> Self::Mask;
    /// `self < other`, as a branch: for decisions that scalars take.
    fn below(self, other: Self) -> bool;
    /// For messages.
    fn to_f64(self) -> f64;
    /// `a` where `mask` holds, else `b`.
    fn select(mask: Self::Mask, a: Self, b: Self) -> Self;
    /// The smaller one; `other` if `self` is not a number.
    fn min(self, other: Self) -> Self;
    /// The larger one; `other` if `self` is not a number.
    fn max(self, other: Self) -> Self;
    /// Magnitude.
    fn abs(self) -> Self;
    /// Square root.
    fn sqrt(self) -> Self;
    /// Natural exponential.
    fn exp(self) -> Self;
    /// Natural logarithm.
    fn ln(self) -> Self;
    /// Sine and cosine of an angle in radians.
    fn sin_cos(self) -> (Self, Self);
    /// Angle of the point (x, y) = (`other`, `self`), radians.
    fn atan2(self, other: Self) -> Self;
    /// `exp(-x^2)/sqrt(pi) - x erfc(x)` for `x >= 0`: the integral of erfc from x to infinity.
    fn ierfc(self) -> Self;
    /// In the type that tilts are computed in.
    fn wide(self) -> Self::Wide;
    /// Rounded from that type.
    fn narrow(wide: Self::Wide) -> Self;
}

macro_rules! forward {
    () => {
        fn lt(self, other: Self) -> bool {
            self < other
        }
        fn below(self, other: Self) -> bool {
            self < other
        }
        fn to_f64(self) -> f64 {
            self.into()
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
        fn sqrt(self) -> Self {
            self.sqrt()
        }
        fn exp(self) -> Self {
            self.exp()
        }
        fn ln(self) -> Self {
            self.ln()
        }
        fn sin_cos(self) -> (Self, Self) {
            self.sin_cos()
        }
        fn atan2(self, other: Self) -> Self {
            self.atan2(other)
        }
    };
}

impl Real for f64 {
    type Mask = bool;
    type Wide = f64;
    const MAX: Self = f64::MAX;
    const TINY: Self = f64::MIN_POSITIVE;
    forward!();

    fn of(x: f64) -> Self {
        x
    }
    fn ierfc(self) -> Self {
        // Most directions are this steep: 1e-30 of what it is added to.
        if self > 8.0 {
            return 0.0;
        }
        (-self * self).exp() * std::f64::consts::FRAC_2_SQRT_PI / 2.0 - self * libm::erfc(self)
    }
    fn wide(self) -> f64 {
        self
    }
    fn narrow(wide: f64) -> f64 {
        wide
    }
}

/// Coefficients of `ierfc(x) = (b_0 + b_1 x + ... + b_9 x^9)^2` up to [`IERFC_END`], minimax for the error relative to
/// `x + ierfc(x)/2`, which is what the shadowing function passes on: 1.6e-7, and 4e-7 evaluated in float32. Neither an
/// exponential nor a quotient is needed. The Dr.Jit twin reads the same numbers.
pub const IERFC: [f32; 10] = [
    0.751_125_57,
    -0.665_670_75,
    0.080_643_877,
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

impl Real for f32 {
    type Mask = bool;
    type Wide = f64;
    const MAX: Self = f32::MAX;
    const TINY: Self = f32::MIN_POSITIVE;
    forward!();

    fn of(x: f64) -> Self {
        x as f32
    }
    fn ierfc(self) -> Self {
        let x = Real::min(self, IERFC_END);
        let root = IERFC.iter().rev().fold(0.0, |sum, &b| sum * x + b);
        root * root
    }
    fn wide(self) -> f64 {
        self.into()
    }
    fn narrow(wide: f64) -> f32 {
        wide as f32
    }
}

/// A direction or normal, `[x, y, z]`.
pub type Vec3<T> = [T; 3];

/// Scalar product.
pub fn dot<T: Real>(a: Vec3<T>, b: Vec3<T>) -> T {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
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
