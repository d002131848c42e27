//! Tables that the closed forms look into.

use super::{Real, Scalar};
use std::sync::Arc;

/// Numbers in packets, those of a packet being needed together.
#[derive(Debug, Clone)]
pub struct Packets {
    /// Numbers in a packet: 4 or 8.
    pub width: u32,
    /// They are numbers of half precision.
    pub half: bool,
    /// One packet after the other.
    pub numbers: Arc<[f32]>,
}

/// A number type that can look into tables.
pub trait Tabulated: Real {
    /// A place on an axis of so many steps, from 0: the step, below `steps`, and how far along it.
    fn step(self, steps: u32) -> (Self, Self);

    /// The packet at an index; any numbers where `active` does not hold.
    fn lookup<const N: usize>(table: &Packets, index: Self, active: Self::Mask) -> [Self; N];

    /// The mask of lookups whose index is within the table whatever it comes from.
    #[inline(always)]
    fn everywhere() -> Self::Mask {
        Self::lt(Self::of(0.0), Self::of(1.0))
    }
}

impl<T: Scalar> Tabulated for T {
    fn step(self, steps: u32) -> (Self, Self) {
        let step = T::of(f64::from((self.to_f64() as u32).min(steps - 1)));
        (step, self - step)
    }

    fn lookup<const N: usize>(table: &Packets, index: Self, active: bool) -> [Self; N] {
        let first = if active { index.to_f64() as usize * N } else { 0 };
        std::array::from_fn(|k| T::of(table.numbers[first + k].into()))
    }
}
