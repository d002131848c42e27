//! What a renderer asks of a sea: its BRDF from afar, that of one drawn sea place by place, and meshes.

pub mod ensemble_lobe;
mod facet_table;
pub mod grid;
mod instance_lobe;
pub mod mesh;
mod onset_table;

pub use ensemble_lobe::EnsembleLobe;
pub use facet_table::FacetTable;
pub use grid::{Grid, Layout};
pub use instance_lobe::{InstanceLobe, LocalSea, WaveTerm};
pub use mesh::Mesh;
pub use onset_table::OnsetTable;
