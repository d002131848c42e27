//! Lanes as a number of the closed form, with elementary functions written once for all vectors.

use super::pair::Pair;
use super::vector::Vector;
use crate::numeric::Real;
use crate::numeric::real::{polynomial, sealed, single_ierfc};
use std::fmt;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// A float32 number in every lane.
#[derive(Clone, Copy)]
pub(crate) struct Lanes<V>(pub V);

impl<V> sealed::Sealed for Lanes<V> {}

impl<V: Vector> fmt::Debug for Lanes<V> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut numbers = [0.0; 16];
        self.0.store(&mut numbers);
        numbers[..V::WIDTH].fmt(f)
    }
}

macro_rules! operator {
    ($trait:ident, $function:ident) => {
        impl<V: Vector> $trait for Lanes<V> {
            type Output = Self;
            #[inline(always)]
            fn $function(self, b: Self) -> Self {
                Self(self.0.$function(b.0))
            }
        }
    };
}
operator!(Add, add);
operator!(Sub, sub);
operator!(Mul, mul);
operator!(Div, div);

impl<V: Vector> Neg for Lanes<V> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self(self.0.neg())
    }
}

/// Coefficients of `(exp(r) - 1 - r)/r^2` within half of ln 2, minimax for the relative error of exp: 3e-9.
const EXP: [f32; 5] = [0.499_999_94, 0.166_665_21, 0.041_668_39, 0.008_368_716, 0.001_381_460_2];
/// ln 2 in two parts, the first with so few digits that its products with exponents are exact.
const LN_2: [f32; 2] = [0.693_359_4, -2.121_944_4e-4];
/// exp of less is below the smallest normal number and taken for 0.
const EXP_LOW: f32 = -87.3;

/// Coefficients of `(atan(x) - x + x^3/3)/x^5` in x^2 up to x = 1, minimax for the relative error of atan: 4e-9.
const ATAN: [f32; 8] = [
    0.199_994_43,
    -0.142_728,
    0.109_933_64,
    -0.085_157_95,
    0.059_773_874,
    -0.032_901_663,
    0.011_802_068,
    -0.001_984_900_3,
];

/// Coefficients of `sin(2 pi t)/t` in t^2 up to a quarter turn, minimax for the relative error: 5e-9.
const SINE: [f32; 5] = [6.283_185_5, -41.341_68, 81.602_234, -76.575, 39.710_934];

impl<V: Vector> Lanes<V> {
    /// `x` in every lane.
    #[inline(always)]
    pub fn splat(x: f32) -> Self {
        Self(V::splat(x))
    }

    /// exp of the unevaluated sum `self + low`, for what is at most 88.
    #[inline(always)]
    pub fn exp_sum(self, low: Self) -> Self {
        let x = Self(self.0.max(V::splat(EXP_LOW)));
        let n = Self((x * Self::splat(std::f32::consts::LOG2_E)).0.round());
        let r = x.mul_sub(n, LN_2[0]).mul_sub(n, LN_2[1]) + low;
        let value = (r * r).mul_add(polynomial(&EXP, r), r) + Self::splat(1.0);
        Self::select(self.lt(Self::splat(EXP_LOW)), Self::splat(0.0), Self(value.0.scale(n.0)))
    }

    /// `self - n a`.
    #[inline(always)]
    fn mul_sub(self, n: Self, a: f32) -> Self {
        n.mul_add(Self::splat(-a), self)
    }

    /// What atan(x) adds to x - x^3/3, over x^5, for x^2 up to 1.
    #[inline(always)]
    pub fn atan_rest(x2: Self) -> Self {
        polynomial(&ATAN, x2)
    }

    /// Sine and cosine of an angle in turns between -1/2 and 1/2, to 1e-7.
    #[inline(always)]
    pub fn sin_cos_turn(self) -> (Self, Self) {
        // Both are sines of angles within a quarter turn.
        let quarter = Self::splat(0.25);
        let of_cosine = quarter - self.abs();
        let of_sine = quarter - of_cosine.abs();
        let sine = |t: Self| t * polynomial(&SINE, t * t);
        (Self(sine(of_sine).0.turn(self.0)), sine(of_cosine))
    }
}

impl<V: Vector> Real for Lanes<V> {
    type Mask = V::Mask;
    type Wide = Pair<V>;
    type Fine = Self;
    const MAX: Self = Self(V::MAX);
    const TINY: Self = Self(V::TINY);
    const SMALL: Self = Self(V::SMALL);

    #[inline(always)]
    fn of(x: f64) -> Self {
        Self::splat(x as f32)
    }
    #[inline(always)]
    fn rounded(fine: Self) -> Self {
        fine
    }
    #[inline(always)]
    fn fine(self) -> Self {
        self
    }
    #[inline(always)]
    fn lt(self, other: Self) -> V::Mask {
        self.0.lt(other.0)
    }
    #[inline(always)]
    fn select(mask: V::Mask, a: Self, b: Self) -> Self {
        Self(V::select(mask, a.0, b.0))
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        Self(self.0.min(other.0))
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        Self(self.0.max(other.0))
    }
    #[inline(always)]
    fn abs(self) -> Self {
        Self(self.0.abs())
    }
    #[inline(always)]
    fn mul_add(self, a: Self, b: Self) -> Self {
        Self(self.0.mul_add(a.0, b.0))
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        Self(self.0.sqrt())
    }
    #[inline(always)]
    fn exp(self) -> Self {
        self.exp_sum(Self::splat(0.0))
    }
    #[inline(always)]
    fn atan2(self, other: Self) -> Self {
        use crate::numeric::real::Wide;
        Pair::widen(self).atan2(Pair::widen(other)).narrow()
    }
    #[inline(always)]
    fn ierfc(self) -> Self {
        single_ierfc(self)
    }
}
