//! Numbers and what is done with them, of no equation of the report.

pub(crate) mod gaussian_fit;
pub mod packets;
pub(crate) mod quadrature;
pub mod real;
pub(crate) mod root;
pub(crate) mod trigonometry;

pub use real::{Real, Scalar, Vec3};
