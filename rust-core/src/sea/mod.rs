//! What the wind does to the water: wind profile, whitecaps and the spectrum of the waves (Eqs. 1-22, 51, 53-55).

mod bjerkaas_riedel;
mod dispersion;
mod elfouhaily;
pub mod foam;
mod jonswap;
mod salinity;
pub mod spectrum;
pub mod swell;
pub mod whitecap;
pub mod wind;

pub use salinity::Salinity;
pub use spectrum::{Spectrum, SpectrumModel};
pub use swell::Swell;
pub use wind::{Wind, WindProfile};
