//! The BRDF at a point of the surface: facets, their slopes, reflectance and shadowing, the mixture with whitecaps, draws
//! from it (Eqs. 56-79), and light from below.

mod dispersion;
pub mod fresnel;
pub(crate) mod lobe;
pub mod polarised;
pub mod sampling;
pub mod shadowing;
pub mod slopes;
pub mod water_body;
mod water_leaving;

pub use dispersion::Dispersion;
pub use fresnel::{Fresnel, Reflectance};
pub use lobe::{Facets, Lobe, Parts, WindAxes, up};
pub use sampling::Sample;
pub use slopes::{SlopeMeasure, SlopeStatistics};
