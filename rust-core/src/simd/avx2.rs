//! AVX2 and FMA.

use super::vector::{Arithmetic, INV_SQRT_2, Vector};
use std::arch::x86_64::*;
use std::mem::transmute;
use std::ops::{BitAnd, BitOr, Not};

/// Calls what [`super::SimdLevel::run`] has made sure of.
macro_rules! intrinsic {
    ($call:expr) => {
        // SAFETY: vectors are reached through `SimdLevel::run` only, which has asked the processor for their features.
        Self(unsafe { $call })
    };
}
/// Eight numbers.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Avx2(__m256);

impl BitAnd for Avx2 {
    type Output = Self;
    #[inline(always)]
    fn bitand(self, b: Self) -> Self {
        intrinsic!(_mm256_and_ps(self.0, b.0))
    }
}

impl BitOr for Avx2 {
    type Output = Self;
    #[inline(always)]
    fn bitor(self, b: Self) -> Self {
        intrinsic!(_mm256_or_ps(self.0, b.0))
    }
}

impl Not for Avx2 {
    type Output = Self;
    #[inline(always)]
    fn not(self) -> Self {
        intrinsic!(_mm256_xor_ps(self.0, ALL.0))
    }
}

const fn splat(x: f32) -> Avx2 {
    // SAFETY: eight float32 numbers have the same bytes as the vector of them.
    Avx2(unsafe { transmute::<[f32; 8], __m256>([x; 8]) })
}

/// A bit for the sign in every lane.
const SIGN: Avx2 = splat(-0.0);
/// Every bit.
const ALL: Avx2 = splat(f32::from_bits(u32::MAX));

impl Arithmetic for Avx2 {
    type Mask = Self;
    const MAX: Self = splat(f32::MAX);
    const TINY: Self = splat(f32::MIN_POSITIVE);
    const SMALL: Self = splat(1e-9);

    #[inline(always)]
    fn splat(x: f32) -> Self {
        intrinsic!(_mm256_set1_ps(x))
    }
    #[inline(always)]
    fn add(self, b: Self) -> Self {
        intrinsic!(_mm256_add_ps(self.0, b.0))
    }
    #[inline(always)]
    fn sub(self, b: Self) -> Self {
        intrinsic!(_mm256_sub_ps(self.0, b.0))
    }
    #[inline(always)]
    fn mul(self, b: Self) -> Self {
        intrinsic!(_mm256_mul_ps(self.0, b.0))
    }
    #[inline(always)]
    fn div(self, b: Self) -> Self {
        intrinsic!(_mm256_div_ps(self.0, b.0))
    }
    #[inline(always)]
    fn neg(self) -> Self {
        intrinsic!(_mm256_xor_ps(self.0, SIGN.0))
    }
    #[inline(always)]
    fn abs(self) -> Self {
        intrinsic!(_mm256_andnot_ps(SIGN.0, self.0))
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        intrinsic!(_mm256_sqrt_ps(self.0))
    }
    #[inline(always)]
    fn min(self, b: Self) -> Self {
        intrinsic!(_mm256_min_ps(self.0, b.0))
    }
    #[inline(always)]
    fn max(self, b: Self) -> Self {
        intrinsic!(_mm256_max_ps(self.0, b.0))
    }
    #[inline(always)]
    fn mul_add(self, a: Self, b: Self) -> Self {
        intrinsic!(_mm256_fmadd_ps(self.0, a.0, b.0))
    }
    #[inline(always)]
    fn residual(self, a: Self, c: Self) -> Self {
        intrinsic!(_mm256_fnmadd_ps(self.0, a.0, c.0))
    }
    #[inline(always)]
    fn lt(self, b: Self) -> Self {
        intrinsic!(_mm256_cmp_ps::<_CMP_LT_OQ>(self.0, b.0))
    }
    #[inline(always)]
    fn select(mask: Self, a: Self, b: Self) -> Self {
        intrinsic!(_mm256_blendv_ps(b.0, a.0, mask.0))
    }
    #[inline(always)]
    fn round(self) -> Self {
        intrinsic!(_mm256_round_ps::<{ _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC }>(self.0))
    }
    #[inline(always)]
    fn ldexp(self, n: Self) -> Self {
        intrinsic!({
            let exponent = _mm256_add_epi32(_mm256_cvtps_epi32(n.0), _mm256_set1_epi32(127));
            _mm256_mul_ps(self.0, _mm256_castsi256_ps(_mm256_slli_epi32::<23>(exponent)))
        })
    }
    #[inline(always)]
    fn flip_sign_by(self, sign: Self) -> Self {
        intrinsic!(_mm256_xor_ps(self.0, _mm256_and_ps(sign.0, SIGN.0)))
    }
    #[inline(always)]
    fn exponent(self) -> Self {
        intrinsic!({
            let bits = _mm256_sub_epi32(_mm256_castps_si256(self.0), _mm256_set1_epi32(INV_SQRT_2));
            _mm256_cvtepi32_ps(_mm256_srai_epi32::<23>(bits))
        })
    }
}

impl Vector for Avx2 {
    const WIDTH: usize = 8;

    #[inline(always)]
    fn load(from: &[f32]) -> Self {
        intrinsic!(_mm256_loadu_ps(from[..8].as_ptr()))
    }
    #[inline(always)]
    fn store(self, to: &mut [f32]) {
        // SAFETY: as above; the slice has eight places.
        unsafe { _mm256_storeu_ps(to[..8].as_mut_ptr(), self.0) }
    }
    #[inline(always)]
    fn phases(phase: &[f64], k_x: &[f64], k_y: &[f64], [x, y]: [f64; 2]) -> Self {
        let half = |at: usize| {
            let [phase, k_x, k_y] = [phase, k_x, k_y].map(|s| s[at..at + 4].as_ptr());
            // SAFETY: as above; the slices were just seen to hold four numbers there.
            unsafe {
                let t = _mm256_fmadd_pd(_mm256_loadu_pd(k_x), _mm256_set1_pd(x), _mm256_loadu_pd(phase));
                let t = _mm256_fmadd_pd(_mm256_loadu_pd(k_y), _mm256_set1_pd(y), t);
                let whole = _mm256_round_pd::<{ _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC }>(t);
                _mm256_cvtpd_ps(_mm256_sub_pd(t, whole))
            }
        };
        intrinsic!(_mm256_set_m128(half(4), half(0)))
    }
    #[inline(always)]
    fn sum(self) -> f64 {
        // SAFETY: as above.
        unsafe {
            let [low, high] = [_mm256_castps256_ps128(self.0), _mm256_extractf128_ps::<1>(self.0)];
            let four = _mm256_add_pd(_mm256_cvtps_pd(low), _mm256_cvtps_pd(high));
            let two = _mm_add_pd(_mm256_castpd256_pd128(four), _mm256_extractf128_pd::<1>(four));
            _mm_cvtsd_f64(_mm_add_sd(two, _mm_unpackhi_pd(two, two)))
        }
    }
}
