//! What [`super::Lanes`] needs: the arithmetic of a float32 number, and of a processor's vector how it is loaded and stored.

use std::ops::{BitAnd, BitOr, Not};

/// The bits of 1/sqrt 2: numbers from there to sqrt 2 have the exponent 0.
pub(super) const INV_SQRT_2: i32 = 0x3f35_04f3;

/// The operations of which the elementary functions and the closed form in single precision are made. Each is one
/// instruction or a few.
pub(crate) trait Arithmetic: Copy + std::fmt::Debug {
    /// Outcomes of comparisons.
    type Mask: Copy + BitAnd<Output = Self::Mask> + BitOr<Output = Self::Mask> + Not<Output = Self::Mask>;

    /// The largest finite value.
    const MAX: Self;
    /// The smallest positive normal value.
    const TINY: Self;
    /// 1e-9.
    const SMALL: Self;

    /// `x` in every lane.
    fn splat(x: f32) -> Self;
    /// `x`, which differs from sea to sea: data, where a literal may become part of a kernel.
    #[inline(always)]
    fn coefficient(x: f32) -> Self {
        Self::splat(x)
    }
    fn add(self, b: Self) -> Self;
    fn sub(self, b: Self) -> Self;
    fn mul(self, b: Self) -> Self;
    fn div(self, b: Self) -> Self;
    fn neg(self) -> Self;
    fn abs(self) -> Self;
    fn sqrt(self) -> Self;
    /// `1/self`.
    #[inline(always)]
    fn recip(self) -> Self {
        Self::splat(1.0).div(self)
    }
    /// `1/sqrt(self)`.
    #[inline(always)]
    fn rsqrt(self) -> Self {
        Self::splat(1.0).div(self.sqrt())
    }
    /// `self < b ? self : b`.
    fn min(self, b: Self) -> Self;
    /// `self > b ? self : b`.
    fn max(self, b: Self) -> Self;
    /// `self a + b`, rounded once or twice.
    fn mul_add(self, a: Self, b: Self) -> Self;
    /// `c - self a`, rounded once, or to the digits of float64 first.
    fn residual(self, a: Self, c: Self) -> Self;
    fn lt(self, b: Self) -> Self::Mask;
    fn select(mask: Self::Mask, a: Self, b: Self) -> Self;
    /// Nearest integer.
    fn round(self) -> Self;
    /// `self 2^n` for integer `n` from -127, which gives 0, to 127.
    fn ldexp(self, n: Self) -> Self;
    /// The integer `n` for which a positive normal number is `2^n` times what lies within sqrt 2 of 1.
    fn exponent(self) -> Self;
    /// `self` with its sign flipped where `sign` is negative.
    fn flip_sign_by(self, sign: Self) -> Self;
    /// The same number without a derivative.
    #[inline(always)]
    fn detach(self) -> Self {
        self
    }
}

/// A vector of [`Vector::WIDTH`] float32 numbers in a processor.
pub(crate) trait Vector: Arithmetic {
    /// How many numbers.
    const WIDTH: usize;

    /// The first numbers of a slice, which has enough of them.
    fn load(from: &[f32]) -> Self;
    /// Into the first places of a slice, which has enough of them.
    fn store(self, to: &mut [f32]);
    /// The fraction of a turn, -1/2 to 1/2, of phases in turns: `phase + k_x x + k_y y` in float64, of the first numbers of
    /// slices which have enough of them.
    fn phases(phase: &[f64], k_x: &[f64], k_y: &[f64], place: [f64; 2]) -> Self;
    /// The sum of the lanes in float64, in a fixed order.
    fn sum(self) -> f64;
}
