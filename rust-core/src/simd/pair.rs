//! Unevaluated sums of two float32 numbers: twice the digits of one, by arithmetic that keeps what rounding takes
//! (Dekker 1971, Knuth).

use super::real::Lanes;
use super::vector::Vector;
use crate::numeric::Real;
use crate::numeric::real::Wide;
use std::f64::consts::{FRAC_PI_2 as HALF_PI, PI};
use std::ops::{Add, Mul, Neg, Sub};

/// `high + low`, `low` within a few units of the last digit of `high`.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Pair<V: Vector> {
    high: Lanes<V>,
    low: Lanes<V>,
}

impl<V: Vector> Pair<V> {
    /// `c - a b`, to the last digit where the product is nearly `c`.
    #[inline(always)]
    fn residual(a: Lanes<V>, b: Lanes<V>, c: Lanes<V>) -> Lanes<V> {
        Lanes(a.0.residual(b.0, c.0))
    }

    /// `a + b` where `a` is not the smaller one.
    #[inline(always)]
    fn quick_sum(a: Lanes<V>, b: Lanes<V>, low: Lanes<V>) -> Self {
        let high = a + b;
        Self { high, low: (a - high) + b + low }
    }

    #[inline(always)]
    fn select(mask: V::Mask, a: Self, b: Self) -> Self {
        Self { high: Lanes::select(mask, a.high, b.high), low: Lanes::select(mask, a.low, b.low) }
    }

    /// With its sign turned where `sign` is negative.
    #[inline(always)]
    fn turn(self, sign: Lanes<V>) -> Self {
        Self { high: Lanes(self.high.0.turn(sign.0)), low: Lanes(self.low.0.turn(sign.0)) }
    }

    /// `whole - self`, not below 0.
    #[inline(always)]
    fn short_of(self, whole: f64) -> Self {
        let whole = Self::of(whole);
        Self::quick_sum(whole.high, -self.high, whole.low - self.low)
    }

    /// `self/other`.
    #[inline(always)]
    fn quotient(self, other: Self) -> Self {
        let inverse = Lanes::splat(1.0) / other.high;
        let high = self.high * inverse;
        let rest = Self::residual(high, other.high, self.high) + Self::residual(high, other.low, self.low);
        Self { high, low: rest * inverse }
    }
}

impl<V: Vector> Neg for Pair<V> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self { high: -self.high, low: -self.low }
    }
}

impl<V: Vector> Add for Pair<V> {
    type Output = Self;
    #[inline(always)]
    fn add(self, b: Self) -> Self {
        let sum = Self::sum(self.high, b.high);
        // Where the high parts cancel the low ones come to count.
        let low = sum.low + (self.low + b.low);
        let high = sum.high + low;
        Self { high, low: low - (high - sum.high) }
    }
}

impl<V: Vector> Sub for Pair<V> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, b: Self) -> Self {
        self + -b
    }
}

impl<V: Vector> Mul for Pair<V> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, b: Self) -> Self {
        let high = self.high * b.high;
        // What rounding took, negative.
        let taken = Self::residual(self.high, b.high, high);
        Self { high, low: self.high.mul_add(b.low, self.low.mul_add(b.high, -taken)) }
    }
}

impl<V: Vector> Wide<Lanes<V>> for Pair<V> {
    #[inline(always)]
    fn of(x: f64) -> Self {
        let high = x as f32;
        Self { high: Lanes::splat(high), low: Lanes::splat((x - f64::from(high)) as f32) }
    }
    #[inline(always)]
    fn widen(x: Lanes<V>) -> Self {
        Self { high: x, low: Lanes::splat(0.0) }
    }
    #[inline(always)]
    fn sum(a: Lanes<V>, b: Lanes<V>) -> Self {
        let high = a + b;
        let of_b = high - a;
        Self { high, low: (a - (high - of_b)) + (b - of_b) }
    }
    #[inline(always)]
    fn narrow(self) -> Lanes<V> {
        self.high + self.low
    }
    #[inline(always)]
    fn fine(self) -> Lanes<V> {
        self.narrow()
    }
    #[inline(always)]
    fn slope(self, other: Self) -> Self {
        let steep = other.high.lt(Lanes::TINY);
        let other = Self { high: Lanes::max(other.high, Lanes::TINY), low: other.low };
        Self::select(steep, Self::of(1e6), self.quotient(other))
    }
    #[inline(always)]
    fn atan2(self, other: Self) -> Self {
        let (y, x) = (self.turn(self.high), other.turn(other.high));
        let swapped = x.high.lt(y.high);
        let (most, least) = (Self::select(swapped, y, x), Self::select(swapped, x, y));
        let q = least.quotient(Self { high: Lanes::max(most.high, Lanes::TINY), low: most.low });
        // atan(q) = q - q^3/3 + ..., the cube as a pair too: half of a steep tilt's rounding would be its own.
        let q2 = q * q;
        let cube = q2 * q * Self::of(-1.0 / 3.0);
        let q4 = q2.high * q2.high;
        let rest = q4 * q.high * Lanes::atan_rest(q2.high);
        // What q's low part changes in it is about q^4/2 of that.
        let low = (q4 * Lanes::splat(0.5)).mul_add(q.low, q.low + cube.low);
        let most = Self::quick_sum(q.high, cube.high, low);
        let angle = Self::quick_sum(most.high, rest, most.low);
        let angle = Self::select(swapped, angle.short_of(HALF_PI), angle);
        let behind = other.high.lt(Lanes::splat(0.0));
        Self::select(behind, angle.short_of(PI), angle).turn(self.high)
    }
    #[inline(always)]
    fn exp(self) -> Lanes<V> {
        self.high.exp_sum(self.low)
    }
}
