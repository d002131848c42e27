//! Many numbers at once: the closed form and the sums of waves in the vectors of the processor at hand.
//!
//! [`Lanes`] is a [`Real`], so the model's one text is compiled for each [`Vector`]; [`SimdLevel::run`] chooses among them when
//! the program runs. Tilts are [`DoubleFloat`]s: float64 would halve the lanes.

#[cfg(target_arch = "x86_64")]
mod avx2;
#[cfg(target_arch = "x86_64")]
mod avx512;
mod double_float;
mod portable;
mod real;
pub mod recorded;
mod vector;

pub(crate) use real::Lanes;
pub(crate) use vector::Vector;

/// Lanes of the widest vector.
pub(crate) const WIDEST: usize = 16;

/// What vectors a processor has.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum SimdLevel {
    /// Arrays of 8 that the compiler makes of them what it can.
    Portable,
    /// 8 lanes: x86-64 with AVX2 and FMA.
    Avx2,
    /// 16 lanes: x86-64 with AVX-512 F and DQ as well.
    Avx512,
}

/// Work to be compiled for every kind of vector. `run` must be `#[inline(always)]`, and all it calls.
pub(crate) trait Kernel {
    /// Does it.
    fn run<V: Vector>(self);
}

impl SimdLevel {
    /// Every one, the plainest first.
    pub const ALL: [Self; 3] = [Self::Portable, Self::Avx2, Self::Avx512];

    /// Whether this processor has it.
    pub fn is_available(self) -> bool {
        match self {
            Self::Portable => true,
            #[cfg(target_arch = "x86_64")]
            Self::Avx2 => is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma"),
            #[cfg(target_arch = "x86_64")]
            Self::Avx512 => {
                Self::Avx2.is_available()
                    && is_x86_feature_detected!("avx512f")
                    && is_x86_feature_detected!("avx512dq")
            }
            #[cfg(not(target_arch = "x86_64"))]
            _ => false,
        }
    }

    /// The best that this processor has.
    pub fn detect() -> Self {
        Self::ALL.into_iter().rev().find(|level| level.is_available()).unwrap_or(Self::Portable)
    }

    /// Its name in messages and benchmarks.
    pub fn name(self) -> &'static str {
        match self {
            Self::Portable => "portable",
            Self::Avx2 => "avx2",
            Self::Avx512 => "avx512",
        }
    }

    /// Runs a kernel in the vectors of this level, or, where the processor lacks them, in the portable ones.
    pub(crate) fn run<K: Kernel>(self, kernel: K) {
        match self {
            // SAFETY: the processor has these features, as was just asked.
            #[cfg(target_arch = "x86_64")]
            Self::Avx512 if self.is_available() => unsafe { in_avx512(kernel) },
            // SAFETY: likewise.
            #[cfg(target_arch = "x86_64")]
            Self::Avx2 if self.is_available() => unsafe { in_avx2(kernel) },
            _ => kernel.run::<portable::Portable>(),
        }
    }
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,fma")]
fn in_avx2<K: Kernel>(kernel: K) {
    kernel.run::<avx2::Avx2>();
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,fma,avx512f,avx512dq")]
fn in_avx512<K: Kernel>(kernel: K) {
    kernel.run::<avx512::Avx512>();
}
