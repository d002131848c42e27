//! Unevaluated sums of two float32 numbers: twice the digits of one, by arithmetic that keeps what rounding takes
//! (Dekker 1971, Knuth).

use super::real::Lanes;
use super::vector::Arithmetic;
use crate::numeric::Real;
use crate::numeric::real::Extended;
use std::f64::consts::FRAC_PI_2 as RIGHT;
use std::ops::Neg;

/// `high + low`: a number and what rounding took from it, itself to some digits only. `low` has no derivative; where the
/// number is not `FINE` it has no value either.
#[derive(Debug, Clone, Copy)]
pub(crate) struct DoubleFloat<V, const FINE: bool> {
    high: Lanes<V>,
    low: Lanes<V>,
}

/// `c - a b`, to the last digit where the product is nearly `c`.
#[inline(always)]
fn residual<V: Arithmetic>(a: Lanes<V>, b: Lanes<V>, c: Lanes<V>) -> Lanes<V> {
    Lanes(a.0.residual(b.0, c.0))
}

impl<V: Arithmetic, const FINE: bool> DoubleFloat<V, FINE> {
    /// A number of which rounding took nothing.
    #[inline(always)]
    fn exact(high: Lanes<V>) -> Self {
        Self { high, low: Lanes::splat(0.0) }
    }

    /// `a + b + low`, where `a` is 0 or not the smaller one.
    #[inline(always)]
    fn quick_sum(a: Lanes<V>, b: Lanes<V>, low: Lanes<V>) -> Self {
        let high = a + b;
        let low = if FINE { low + (b.detach() - (high.detach() - a.detach())) } else { low };
        Self { high, low }
    }

    /// `self/other`, for the inverse of `other` in any number of digits.
    #[inline(always)]
    fn quotient(self, other: Self, inverse: Lanes<V>) -> Self {
        let high = self.high * inverse;
        if !FINE {
            return Self::exact(high);
        }
        let q = high.detach();
        let rest = residual(q, other.high.detach(), self.high.detach());
        let low = q.mul_add(-other.low, rest + self.low) * inverse.detach();
        Self { high, low }
    }

    /// The angle of the point (x, y) = (`other`, `self`), for x > 0, or `anywhere`.
    #[inline(always)]
    fn angle(self, other: Self, anywhere: bool) -> Self {
        let zero = Lanes::splat(0.0);
        // From the axis that is nearer.
        let across = if anywhere { other.high.abs() } else { other.high };
        let steep = across.lt(self.high.abs());
        let a = Self::select(steep, -other, self);
        let mut b = Self::select(steep, self, other);
        let right = Lanes::splat(RIGHT as f32).flip_sign_by(self.high.detach());
        let mut base = Lanes::select(steep, right, zero);
        if anywhere {
            base = Lanes::select(!steep & other.high.lt(zero), right + right, base);
            b.high = Lanes::select(b.high.abs().lt(Lanes::TINY), Lanes::TINY, b.high);
        }
        let t = a.quotient(b, b.high.recip());
        // atan t = t - t^3/4 + t^3 rest(t^2).
        let t2 = t.high * t.high;
        let t3 = t.high * t2;
        let quarter = Lanes::splat(-0.25) * t3;
        let rest = Lanes::atan_rest(t2);
        let more = t3.mul_add(rest, quarter);
        let mut low = zero;
        if FINE {
            // d atan(t)/dt to some percent, and what rounding took from t^3 and from `more`.
            let [t1, t2, t3] = [t.high.detach(), t2.detach(), t3.detach()];
            let derivative = Lanes::splat(-0.5).mul_add(t2, Lanes::splat(0.957));
            let right_low = (RIGHT - f64::from(RIGHT as f32)) / RIGHT;
            low = t.low.mul_add(derivative, base * Lanes::splat(right_low as f32));
            low = residual(t1, t2, t3).mul_add(Lanes::splat(0.3), low);
            low = low + t3.mul_add(rest.detach(), quarter.detach() - more.detach());
        }
        let sum = Self::quick_sum(base, t.high, low);
        Self::quick_sum(sum.high, more, sum.low)
    }
}

impl<V: Arithmetic, const FINE: bool> Neg for DoubleFloat<V, FINE> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self { high: -self.high, low: -self.low }
    }
}

impl<V: Arithmetic, const FINE: bool> Extended<Lanes<V>> for DoubleFloat<V, FINE> {
    #[inline(always)]
    fn coefficient(x: f64) -> Self {
        let high = Lanes::coefficient(x);
        if FINE { Self { high, low: Lanes::coefficient(x - f64::from(x as f32)) } } else { Self::exact(high) }
    }
    #[inline(always)]
    fn from_real(x: Lanes<V>) -> Self {
        Self::exact(x)
    }
    #[inline(always)]
    fn truncate(x: DoubleFloat<V, true>) -> Self {
        if FINE { Self { high: x.high, low: x.low } } else { Self::exact(x.high) }
    }
    #[inline(always)]
    fn sum(a: Lanes<V>, b: Lanes<V>) -> Self {
        let high = a + b;
        if !FINE {
            return Self::exact(high);
        }
        let [a, b, s] = [a.detach(), b.detach(), high.detach()];
        let of_b = s - a;
        Self { high, low: (a - (s - of_b)) + (b - of_b) }
    }
    #[inline(always)]
    fn sum_of_products(a: Self, b: Self, c: Self, d: Self) -> Self {
        if !FINE {
            return Self::exact(a.high.mul_add(b.high, c.high * d.high));
        }
        let (first, second) = (a.high * b.high, c.high * d.high);
        let sum = Self::sum(first, second);
        let [a1, b1, c1, d1] = [a.high.detach(), b.high.detach(), c.high.detach(), d.high.detach()];
        let taken = residual(a1, b1, first.detach()) + residual(c1, d1, second.detach());
        let low = c1.mul_add(d.low, d1.mul_add(c.low, sum.low - taken));
        Self { high: sum.high, low: a1.mul_add(b.low, b1.mul_add(a.low, low)) }
    }
    #[inline(always)]
    fn normalize(self) -> Self {
        if !FINE {
            return self;
        }
        let high = self.high + self.low;
        Self { high, low: self.low - (high.detach() - self.high.detach()) }
    }
    #[inline(always)]
    fn times(self, coefficient: Self) -> Self {
        let high = self.high * coefficient.high;
        if !FINE {
            return Self::exact(high);
        }
        let [a, b] = [self.high.detach(), coefficient.high.detach()];
        let low = self.low.mul_add(b, a.mul_add(coefficient.low, -residual(a, b, high.detach())));
        Self { high, low }
    }
    #[inline(always)]
    fn at_least(self, bound: Lanes<V>) -> Self {
        Self { high: Lanes::max(self.high, bound), ..self }
    }
    #[inline(always)]
    fn clamp(self, bound: f64) -> Self {
        let bound = Lanes::of(bound);
        let high = Lanes::max(Lanes::min(self.high, bound), -bound);
        let low =
            if FINE { Lanes::select(high.abs().lt(bound), self.low, Lanes::splat(0.0)) } else { self.low };
        Self { high, low }
    }
    #[inline(always)]
    fn select(mask: V::Mask, a: Self, b: Self) -> Self {
        let high = Lanes::select(mask, a.high, b.high);
        if FINE { Self { high, low: Lanes::select(mask, a.low, b.low) } } else { Self::exact(high) }
    }
    #[inline(always)]
    fn over(self, other: Self) -> Self {
        self.quotient(other, other.high.recip())
    }
    #[inline(always)]
    fn atan(self, other: Self) -> Self {
        self.angle(other, false)
    }
    #[inline(always)]
    fn atan2(self, other: Self) -> Self {
        self.angle(other, true)
    }
    #[inline(always)]
    fn to_real(self) -> Lanes<V> {
        self.high
    }
    #[inline(always)]
    fn to_density(self) -> Lanes<V> {
        self.high
    }
    #[inline(always)]
    fn gauss(u: Self, c: Self) -> Lanes<V> {
        let (u2, c2) = (u.high * u.high, c.high * c.high);
        if !FINE {
            return (u2 + c2).exp2_neg();
        }
        // What is left of the squares beside integers loses no digits.
        let n = (u2 + c2).detach().round();
        let n_c = c2.detach().round();
        let low = u.high.detach().mul_add(u.low, c.high.detach() * c.low);
        let rest = residual(u.high, u.high, n - n_c) + residual(c.high, c.high, n_c);
        Lanes::exp2_split(Lanes::splat(-2.0).mul_add(low, rest), n)
    }
    #[inline(always)]
    fn corrected(self, value: Lanes<V>, derivative: Lanes<V>) -> Lanes<V> {
        if FINE { derivative.detach().mul_add(self.low, value) } else { value }
    }
}
