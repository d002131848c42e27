//! The library's tests, of its public items: one program, which is compiled and linked once.

mod casting;
mod common;
mod empirical;
mod energy;
mod ensemble;
mod ensemble_lobe;
mod exact;
mod foam;
mod hiding;
mod importance;
mod lanes;
mod mesh;
mod nan;
mod places;
mod properties;
mod readings;
mod reference;
mod sampling;
mod slope_budget;
mod spot;
mod surfaces;
mod swell;
mod threads;
mod wave_sums;
mod waves;
mod whitecaps;
