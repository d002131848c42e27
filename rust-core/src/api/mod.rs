//! Ways in for callers with many rows or from C: every row is checked before the first is evaluated.

pub mod batch;
#[cfg(feature = "c-api")]
mod c_api;
mod columns;
pub mod kernels;
mod tasks;
