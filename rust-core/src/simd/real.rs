//! Lanes as a number of the closed form, with elementary functions written once for all vectors.

use super::double_float::DoubleFloat;
use super::vector::Arithmetic;
use crate::numeric::Real;
use crate::numeric::real::{Extended, polynomial, sealed, single_ierfc};
use std::f32::consts::LN_2;
use std::fmt;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// A float32 number in every lane.
#[derive(Clone, Copy)]
pub(crate) struct Lanes<V>(pub V);

impl<V> sealed::Sealed for Lanes<V> {}

impl<V: fmt::Debug> fmt::Debug for Lanes<V> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}

macro_rules! operator {
    ($trait:ident, $function:ident) => {
        impl<V: Arithmetic> $trait for Lanes<V> {
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

impl<V: Arithmetic> Neg for Lanes<V> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self(self.0.neg())
    }
}

/// Coefficients of `(exp(r) - 1 - r)/r^2` within half of ln 2, minimax for the relative error of exp: 3e-9.
const EXP: [f32; 5] = [0.499_999_94, 0.166_665_21, 0.041_668_39, 0.008_368_716, 0.001_381_460_2];
/// ln 2 in two parts, the first with so few digits that its products with exponents are exact.
const LN_2_SPLIT: [f32; 2] = [0.693_359_4, -2.121_944_4e-4];
/// exp of less is below the smallest normal number and taken for 0.
const EXP_LOW: f32 = -87.3;

/// Coefficients of `(atan(x)/x - 1 + x^2/4)/x^2` in x^2 up to x = 1, minimax for the relative error of atan: 3e-9.
const ATAN: [f32; 9] = [
    -0.083_332_99,
    0.199_985_53,
    -0.142_642_87,
    0.109_523_93,
    -0.084_039_94,
    0.057_966_128,
    -0.031_185_76,
    0.010_918_605,
    -0.001_794_471,
];

/// Coefficients of `2^x` up to |x| = 1/2: relative error 3e-9.
const EXP2: [f32; 7] =
    [1.0, LN_2, 0.240_226_48, 0.055_503_294, 0.009_618_45, 0.001_340_017, 0.000_153_523_17];

/// Coefficients of `ln(1 + t)/t` for `1 + t` within sqrt 2 of 1: relative error of the logarithm 3e-8.
const LN: [f32; 9] = [
    1.0,
    -0.499_999_88,
    0.333_341_87,
    -0.250_020_74,
    0.199_568_33,
    -0.165_623_93,
    0.149_522_66,
    -0.143_668_44,
    0.087_223_57,
];

/// Coefficients of `sin(x)/x` and `cos x` in x^2 up to a quarter turn: 5e-8.
const SINC: [f32; 5] = [1.0, -0.166_666_57, 0.008_333_017, -0.000_198_066_15, 2.600_054_6e-6];
const COSINE: [f32; 5] = [1.0, -0.499_999_3, 0.041_663_99, -0.001_385_592_7, 2.319_438_5e-5];

/// Coefficients of `sin(2 pi t)/t` in t^2 up to a quarter turn, minimax for the relative error: 5e-9.
const SINE: [f32; 5] = [6.283_185_5, -41.341_68, 81.602_234, -76.575, 39.710_934];

impl<V: Arithmetic> Lanes<V> {
    /// `x` in every lane.
    #[inline(always)]
    pub fn splat(x: f32) -> Self {
        Self(V::splat(x))
    }

    /// `self - n a`.
    #[inline(always)]
    fn mul_sub(self, n: Self, a: f32) -> Self {
        n.mul_add(Self::splat(-a), self)
    }

    /// What atan(x)/x adds to 1 - x^2/4, over x^2, for x^2 up to 1.
    #[inline(always)]
    pub fn atan_rest(x2: Self) -> Self {
        polynomial(&ATAN, x2)
    }

    /// `2^(x - n)` for integer n >= 0 and |x| up to 1/2; 0 from n = 127 on.
    #[inline(always)]
    pub fn exp2_split(x: Self, n: Self) -> Self {
        let n = Self::min(n, Self::splat(127.0));
        Self(polynomial(&EXP2, x).0.ldexp((-n).0))
    }

    /// Nearest integer.
    #[inline(always)]
    pub fn round(self) -> Self {
        Self(self.0.round())
    }

    /// The same number without a derivative.
    #[inline(always)]
    pub fn detach(self) -> Self {
        Self(self.0.detach())
    }

    /// With the sign flipped where `sign` is negative.
    #[inline(always)]
    pub fn flip_sign_by(self, sign: Self) -> Self {
        Self(self.0.flip_sign_by(sign.0))
    }

    /// Sine and cosine of an angle in turns between -1/2 and 1/2, to 1e-7.
    #[inline(always)]
    pub fn sin_cos_turn(self) -> (Self, Self) {
        // Both are sines of angles within a quarter turn.
        let quarter = Self::splat(0.25);
        let of_cosine = quarter - self.abs();
        let of_sine = quarter - of_cosine.abs();
        let sine = |t: Self| t * polynomial(&SINE, t * t);
        (sine(of_sine).flip_sign_by(self), sine(of_cosine))
    }
}

impl<V: Arithmetic> Real for Lanes<V> {
    type Mask = V::Mask;
    type Extended = DoubleFloat<V, true>;
    type Plain = DoubleFloat<V, false>;
    type Density = Self;
    const MAX: Self = Self(V::MAX);
    const TINY: Self = Self(V::TINY);
    const SMALL: Self = Self(V::SMALL);

    #[inline(always)]
    fn of(x: f64) -> Self {
        Self::splat(x as f32)
    }
    #[inline(always)]
    fn coefficient(x: f64) -> Self {
        Self(V::coefficient(x as f32))
    }
    #[inline(always)]
    fn from_density(x: Self) -> Self {
        x
    }
    #[inline(always)]
    fn to_density(self) -> Self {
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
    fn may_hold(_mask: V::Mask) -> bool {
        true
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
    fn recip(self) -> Self {
        Self(self.0.recip())
    }
    #[inline(always)]
    fn rsqrt(self) -> Self {
        Self(self.0.rsqrt())
    }
    #[inline(always)]
    fn exp(self) -> Self {
        let x = Self::max(self, Self::splat(EXP_LOW));
        let n = (x * Self::splat(std::f32::consts::LOG2_E)).detach().round();
        let r = x.mul_sub(n, LN_2_SPLIT[0]).mul_sub(n, LN_2_SPLIT[1]);
        let value = (r * r).mul_add(polynomial(&EXP, r), r) + Self::splat(1.0);
        Self::select(self.lt(Self::splat(EXP_LOW)), Self::splat(0.0), Self(value.0.ldexp(n.0)))
    }
    #[inline(always)]
    fn exp2_neg(self) -> Self {
        let x = Self::min(self, Self::splat(127.0));
        let n = x.detach().round();
        Self::exp2_split(n - x, n)
    }
    #[inline(always)]
    fn ln(self) -> Self {
        let n = Self(self.detach().0.exponent());
        let t = Self(self.0.ldexp((-n).0)) - Self::splat(1.0);
        n.mul_add(Self::splat(LN_2), t * polynomial(&LN, t))
    }
    #[inline(always)]
    fn atan2(self, other: Self) -> Self {
        let plain = |x| <DoubleFloat<V, false> as Extended<Self>>::from_real(x);
        plain(self).atan(plain(other)).to_real()
    }
    #[inline(always)]
    fn atan_over(self) -> Self {
        let one = Self::splat(1.0);
        let inverse = Self::max(self, Self::TINY).rsqrt();
        let steep = one.lt(self);
        let x2 = Self::select(steep, inverse * inverse, self);
        let over = x2.mul_add(Self::atan_rest(x2) - Self::splat(0.25), one);
        let right = Self::splat(std::f32::consts::FRAC_PI_2);
        Self::select(steep, right.mul_add(inverse, -(over * x2)), over)
    }
    #[inline(always)]
    fn sin_cos_turns(self) -> (Self, Self) {
        let w = self - Self::splat(0.5);
        let x = Self::splat(std::f32::consts::TAU) * (Self::splat(0.25) - w.abs());
        let (sinc, cos) = (x * x).sinc_cos();
        (Self::select(w.lt(Self::splat(0.0)), cos, -cos), -(x * sinc))
    }
    #[inline(always)]
    fn sinc_cos(self) -> (Self, Self) {
        (polynomial(&SINC, self), polynomial(&COSINE, self))
    }
    #[inline(always)]
    fn ierfc(self) -> Self {
        single_ierfc(self)
    }
}
