//! The empirical model: Gaussians in the plane of incidence and across it, from tables of what the full model gives
//! (section 9, Eqs. 80-91).

mod fine_grid;
mod lobe;
pub mod planes;
mod reference;
pub mod table;
pub mod table_file;

pub use fine_grid::FineGrid;
pub use lobe::{EmpiricalLobe, Estimate, Gridded};
pub use planes::Planes;
pub use reference::{Moments, Node, ReferenceModel};
pub use table::Table;
