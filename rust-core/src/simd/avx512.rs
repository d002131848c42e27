//! AVX-512, the parts F and DQ.

use super::vector::{Arithmetic, INV_SQRT_2, Vector};
use std::arch::x86_64::*;
use std::mem::transmute;

/// Calls what [`super::SimdLevel::run`] has made sure of.
macro_rules! intrinsic {
    ($call:expr) => {
        // SAFETY: vectors are reached through `SimdLevel::run` only, which has asked the processor for their features.
        Self(unsafe { $call })
    };
}
/// Sixteen numbers.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Avx512(__m512);

const fn splat(x: f32) -> Avx512 {
    // SAFETY: sixteen float32 numbers have the same bytes as the vector of them.
    Avx512(unsafe { transmute::<[f32; 16], __m512>([x; 16]) })
}

/// A bit for the sign in every lane.
const SIGN: Avx512 = splat(-0.0);

impl Arithmetic for Avx512 {
    type Mask = __mmask16;
    const MAX: Self = splat(f32::MAX);
    const TINY: Self = splat(f32::MIN_POSITIVE);
    const SMALL: Self = splat(1e-9);

    #[inline(always)]
    fn splat(x: f32) -> Self {
        intrinsic!(_mm512_set1_ps(x))
    }
    #[inline(always)]
    fn add(self, b: Self) -> Self {
        intrinsic!(_mm512_add_ps(self.0, b.0))
    }
    #[inline(always)]
    fn sub(self, b: Self) -> Self {
        intrinsic!(_mm512_sub_ps(self.0, b.0))
    }
    #[inline(always)]
    fn mul(self, b: Self) -> Self {
        intrinsic!(_mm512_mul_ps(self.0, b.0))
    }
    #[inline(always)]
    fn div(self, b: Self) -> Self {
        intrinsic!(_mm512_div_ps(self.0, b.0))
    }
    #[inline(always)]
    fn neg(self) -> Self {
        intrinsic!(_mm512_xor_ps(self.0, SIGN.0))
    }
    #[inline(always)]
    fn abs(self) -> Self {
        intrinsic!(_mm512_andnot_ps(SIGN.0, self.0))
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        intrinsic!(_mm512_sqrt_ps(self.0))
    }
    #[inline(always)]
    fn min(self, b: Self) -> Self {
        intrinsic!(_mm512_min_ps(self.0, b.0))
    }
    #[inline(always)]
    fn max(self, b: Self) -> Self {
        intrinsic!(_mm512_max_ps(self.0, b.0))
    }
    #[inline(always)]
    fn mul_add(self, a: Self, b: Self) -> Self {
        intrinsic!(_mm512_fmadd_ps(self.0, a.0, b.0))
    }
    #[inline(always)]
    fn residual(self, a: Self, c: Self) -> Self {
        intrinsic!(_mm512_fnmadd_ps(self.0, a.0, c.0))
    }
    #[inline(always)]
    fn lt(self, b: Self) -> __mmask16 {
        // SAFETY: as above.
        unsafe { _mm512_cmp_ps_mask::<_CMP_LT_OQ>(self.0, b.0) }
    }
    #[inline(always)]
    fn select(mask: __mmask16, a: Self, b: Self) -> Self {
        intrinsic!(_mm512_mask_blend_ps(mask, b.0, a.0))
    }
    #[inline(always)]
    fn round(self) -> Self {
        intrinsic!(_mm512_roundscale_ps::<{ _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC }>(self.0))
    }
    #[inline(always)]
    fn ldexp(self, n: Self) -> Self {
        intrinsic!({
            let exponent = _mm512_add_epi32(_mm512_cvtps_epi32(n.0), _mm512_set1_epi32(127));
            _mm512_mul_ps(self.0, _mm512_castsi512_ps(_mm512_slli_epi32::<23>(exponent)))
        })
    }
    #[inline(always)]
    fn flip_sign_by(self, sign: Self) -> Self {
        intrinsic!(_mm512_xor_ps(self.0, _mm512_and_ps(sign.0, SIGN.0)))
    }
    #[inline(always)]
    fn exponent(self) -> Self {
        intrinsic!({
            let bits = _mm512_sub_epi32(_mm512_castps_si512(self.0), _mm512_set1_epi32(INV_SQRT_2));
            _mm512_cvtepi32_ps(_mm512_srai_epi32::<23>(bits))
        })
    }
}

impl Vector for Avx512 {
    const WIDTH: usize = 16;

    #[inline(always)]
    fn load(from: &[f32]) -> Self {
        intrinsic!(_mm512_loadu_ps(from[..16].as_ptr()))
    }
    #[inline(always)]
    fn store(self, to: &mut [f32]) {
        // SAFETY: as above; the slice has sixteen places.
        unsafe { _mm512_storeu_ps(to[..16].as_mut_ptr(), self.0) }
    }
    #[inline(always)]
    fn phases(phase: &[f64], k_x: &[f64], k_y: &[f64], [x, y]: [f64; 2]) -> Self {
        let half = |at: usize| {
            let [phase, k_x, k_y] = [phase, k_x, k_y].map(|s| s[at..at + 8].as_ptr());
            // SAFETY: as above; the slices were just seen to hold eight numbers there.
            unsafe {
                let t = _mm512_fmadd_pd(_mm512_loadu_pd(k_x), _mm512_set1_pd(x), _mm512_loadu_pd(phase));
                let t = _mm512_fmadd_pd(_mm512_loadu_pd(k_y), _mm512_set1_pd(y), t);
                let whole = _mm512_roundscale_pd::<{ _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC }>(t);
                _mm512_cvtpd_ps(_mm512_sub_pd(t, whole))
            }
        };
        intrinsic!(_mm512_insertf32x8::<1>(_mm512_castps256_ps512(half(0)), half(8)))
    }
    #[inline(always)]
    fn sum(self) -> f64 {
        // SAFETY: as above.
        unsafe {
            let [low, high] = [_mm512_castps512_ps256(self.0), _mm512_extractf32x8_ps::<1>(self.0)];
            _mm512_reduce_add_pd(_mm512_add_pd(_mm512_cvtps_pd(low), _mm512_cvtps_pd(high)))
        }
    }
}
