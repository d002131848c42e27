//! What [`super::Lanes`] needs of a processor.

use std::ops::BitAnd;

/// A vector of [`Vector::WIDTH`] float32 numbers. Every operation is one instruction or a few.
pub(crate) trait Vector: Copy + std::fmt::Debug {
    /// Outcomes of comparisons.
    type Mask: Copy + BitAnd<Output = Self::Mask>;

    /// How many numbers.
    const WIDTH: usize;
    /// The largest finite value in every lane.
    const MAX: Self;
    /// The smallest positive normal value in every lane.
    const TINY: Self;
    /// 1e-9 in every lane.
    const SMALL: Self;

    /// `x` in every lane.
    fn splat(x: f32) -> Self;
    /// The first numbers of a slice, which has enough of them.
    fn load(from: &[f32]) -> Self;
    /// Into the first places of a slice, which has enough of them.
    fn store(self, to: &mut [f32]);
    fn add(self, b: Self) -> Self;
    fn sub(self, b: Self) -> Self;
    fn mul(self, b: Self) -> Self;
    fn div(self, b: Self) -> Self;
    fn neg(self) -> Self;
    fn abs(self) -> Self;
    fn sqrt(self) -> Self;
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
    /// Nearest whole number.
    fn round(self) -> Self;
    /// `self 2^n` for whole `n` from -126 to 127.
    fn scale(self, n: Self) -> Self;
    /// `self` with its sign turned where `sign` is negative.
    fn turn(self, sign: Self) -> Self;
    /// The fraction of a turn, -1/2 to 1/2, of phases in turns: `phase + k_x x + k_y y` in float64, of the first numbers of
    /// slices which have enough of them.
    fn phases(phase: &[f64], k_x: &[f64], k_y: &[f64], place: [f64; 2]) -> Self;
    /// The sum of the lanes in float64, in a fixed order.
    fn sum(self) -> f64;
}
