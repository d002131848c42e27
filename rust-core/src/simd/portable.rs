//! Arrays, for any processor.

use super::vector::{Arithmetic, INV_SQRT_2, Vector};
use std::array::from_fn;
use std::ops::{BitAnd, BitOr, Not};

/// Eight numbers.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Portable([f32; 8]);

/// Eight outcomes: all bits of a number are set, or none.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Mask([u32; 8]);

impl BitAnd for Mask {
    type Output = Self;
    #[inline(always)]
    fn bitand(self, b: Self) -> Self {
        Self(from_fn(|l| self.0[l] & b.0[l]))
    }
}

impl BitOr for Mask {
    type Output = Self;
    #[inline(always)]
    fn bitor(self, b: Self) -> Self {
        Self(from_fn(|l| self.0[l] | b.0[l]))
    }
}

impl Not for Mask {
    type Output = Self;
    #[inline(always)]
    fn not(self) -> Self {
        Self(from_fn(|l| !self.0[l]))
    }
}

impl Portable {
    #[inline(always)]
    fn map(self, f: impl Fn(f32) -> f32) -> Self {
        Self(from_fn(|l| f(self.0[l])))
    }
    #[inline(always)]
    fn zip(self, b: Self, f: impl Fn(f32, f32) -> f32) -> Self {
        Self(from_fn(|l| f(self.0[l], b.0[l])))
    }
}

/// Adding and subtracting it rounds a float32 of at most 2^22 to a integer, which then stands in the last bits.
const ROUND: f32 = 12_582_912.0;
/// And a float64.
const ROUND_WIDE: f64 = 6_755_399_441_055_744.0;

impl Arithmetic for Portable {
    type Mask = Mask;
    const MAX: Self = Self([f32::MAX; 8]);
    const TINY: Self = Self([f32::MIN_POSITIVE; 8]);
    const SMALL: Self = Self([1e-9; 8]);

    #[inline(always)]
    fn splat(x: f32) -> Self {
        Self([x; 8])
    }
    #[inline(always)]
    fn add(self, b: Self) -> Self {
        self.zip(b, |a, b| a + b)
    }
    #[inline(always)]
    fn sub(self, b: Self) -> Self {
        self.zip(b, |a, b| a - b)
    }
    #[inline(always)]
    fn mul(self, b: Self) -> Self {
        self.zip(b, |a, b| a * b)
    }
    #[inline(always)]
    fn div(self, b: Self) -> Self {
        self.zip(b, |a, b| a / b)
    }
    #[inline(always)]
    fn neg(self) -> Self {
        self.map(|a| -a)
    }
    #[inline(always)]
    fn abs(self) -> Self {
        self.map(f32::abs)
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        self.map(f32::sqrt)
    }
    #[inline(always)]
    fn min(self, b: Self) -> Self {
        self.zip(b, |a, b| if a < b { a } else { b })
    }
    #[inline(always)]
    fn max(self, b: Self) -> Self {
        self.zip(b, |a, b| if a > b { a } else { b })
    }
    #[inline(always)]
    fn mul_add(self, a: Self, b: Self) -> Self {
        Self(from_fn(|l| self.0[l] * a.0[l] + b.0[l]))
    }
    #[inline(always)]
    fn residual(self, a: Self, c: Self) -> Self {
        // The product of two float32 numbers is exact.
        Self(from_fn(|l| (f64::from(c.0[l]) - f64::from(self.0[l]) * f64::from(a.0[l])) as f32))
    }
    #[inline(always)]
    fn lt(self, b: Self) -> Mask {
        Mask(from_fn(|l| u32::from(self.0[l] < b.0[l]).wrapping_neg()))
    }
    #[inline(always)]
    fn select(mask: Mask, a: Self, b: Self) -> Self {
        Self(from_fn(|l| f32::from_bits((a.0[l].to_bits() & mask.0[l]) | (b.0[l].to_bits() & !mask.0[l]))))
    }
    #[inline(always)]
    fn round(self) -> Self {
        self.map(|a| (a + ROUND) - ROUND)
    }
    #[inline(always)]
    fn ldexp(self, n: Self) -> Self {
        // The number stands in the last bits of the sum; 127 more is an exponent.
        self.zip(n, |a, n| a * f32::from_bits(((n + ROUND).to_bits().wrapping_add(127)) << 23))
    }
    #[inline(always)]
    fn flip_sign_by(self, sign: Self) -> Self {
        self.zip(sign, |a, sign| f32::from_bits(a.to_bits() ^ (sign.to_bits() & (1 << 31))))
    }
    #[inline(always)]
    fn exponent(self) -> Self {
        self.map(|a| ((a.to_bits() as i32 - INV_SQRT_2) >> 23) as f32)
    }
}

impl Vector for Portable {
    const WIDTH: usize = 8;

    #[inline(always)]
    fn load(from: &[f32]) -> Self {
        Self(from[..8].try_into().expect("eight numbers"))
    }
    #[inline(always)]
    fn store(self, to: &mut [f32]) {
        to[..8].copy_from_slice(&self.0);
    }
    #[inline(always)]
    fn phases(phase: &[f64], k_x: &[f64], k_y: &[f64], [x, y]: [f64; 2]) -> Self {
        let [phase, k_x, k_y] =
            [phase, k_x, k_y].map(|s| -> [f64; 8] { s[..8].try_into().expect("eight numbers") });
        Self(from_fn(|l| {
            let t = phase[l] + k_x[l] * x + k_y[l] * y;
            (t - ((t + ROUND_WIDE) - ROUND_WIDE)) as f32
        }))
    }
    #[inline(always)]
    fn sum(self) -> f64 {
        let four: [f64; 4] = from_fn(|l| f64::from(self.0[l]) + f64::from(self.0[l + 4]));
        (four[0] + four[2]) + (four[1] + four[3])
    }
}
