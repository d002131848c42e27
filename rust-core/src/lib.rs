//! The probabilistic water BRDF of AFRL-RH-FS-TR-2023-0002 ("the report").
//!
//! Two stages, always: [`Parameters`] are checked and turned into a [`Water`] once
//! ([`Parameters::configure`], where every error lives); a `Water` is then evaluated
//! billions of times and cannot fail.
//!
//! ```
//! use prob_water::{Parameters, Wind};
//!
//! let water = Parameters { wind: Wind::FrictionVelocity(8.0), ..Parameters::default() }
//!     .configure()
//!     .unwrap();
//! let up = [0.0, 0.0, 1.0];
//! let f = water.lobe().unwrap().eval(up, up, None); // 1/sr
//! // Flat sea seen from above: rho_n/(8 pi sigma_u sigma_c) p_ks(0).
//! assert!((f - 0.1382).abs() < 1e-4, "{f}");
//! ```
//!
//! One module per part of the report, each depending only on those above it:
//!
//! | module | equations |
//! | --- | --- |
//! | [`wind`] | 1-2, Table 1 |
//! | [`whitecap`] | 51, 53-55 |
//! | [`spectrum`] | 3-22 |
//! | [`waves`] | 23-27, 37-38: draws |
//! | [`surface`] | 31, 38-42, 52 |
//! | [`cast`] | 46-50 |
//! | [`optics`] | 62-63, refractive index |
//! | [`slopes`] | 72-79 |
//! | [`shadowing`] | 64-67 |
//! | [`brdf`] | 56-61, 68-71, and the mixture with whitecaps |
//! | [`sampling`] | importance sampling of the two lobes |
//! | [`scenario`] | 28: lasers, beams and observers |
//! | [`ensemble`] | section 7: statistics over drawn surfaces |
//! | [`Proposal`] | draws by importance, for narrow facets |
//! | [`statistics`] | mean, spread, quantiles, and how far to trust them |
//! | [`exact`] | the same for infinitely many, without draws |
//! | [`planes`] | 80-89: in the plane of incidence and across it |
//! | [`empirical`] | section 9: what the empirical model holds, from the full one |
//! | [`table`], [`table_file`] | its tables, made, read and written |
//! | [`EmpiricalLobe`] | 83-91: the empirical model, evaluated |
//! | [`EnsembleLobe`] | the BRDF of a wavy sea seen from afar |
//! | [`InstanceLobe`] | that of one drawn sea, place by place |
//! | [`FacetTable`] | facets where the footprint changes from place to place |
//! | [`grid`], [`mesh`] | a realised sea as triangles |
//!
//! Beside them, of no equation: [`real`], the number types of the closed form, [`lanes`], the processor's vectors as one of
//! them, [`batch`], many rows at once, and [`wave_sums`], many places.
//!
//! `docs/model.md` tells where the report's print is defective, how this crate reads it, and
//! which test shows it.

pub mod batch;
pub mod brdf;
#[cfg(feature = "c-api")]
mod c_api;
pub mod cast;
mod characteristic;
mod columns;
pub mod empirical;
mod empirical_lobe;
pub mod ensemble;
pub mod ensemble_lobe;
mod error;
pub mod exact;
mod facet_density;
mod facet_table;
mod gaussian_fit;
pub mod grid;
mod instance_lobe;
pub mod lanes;
mod level_water;
pub mod mesh;
pub mod optics;
pub mod packets;
mod parameters;
pub mod planes;
mod quadrature;
pub mod real;

pub mod sampling;
pub mod scenario;
pub mod shadowing;
mod slope_density;
mod slope_draws;
pub mod slopes;
pub mod spectrum;
pub mod statistics;
pub mod surface;
pub mod table;
pub mod table_file;
mod trigonometry;
pub mod vocabulary;
pub mod wave_sums;
pub mod waves;
pub mod whitecap;
pub mod wind;

pub use brdf::Lobe;
pub use empirical_lobe::{EmpiricalLobe, Estimate};
pub use ensemble::{Ensemble, Presence};
pub use ensemble_lobe::EnsembleLobe;
pub use error::{Error, Warning};
pub use exact::Exact;
pub use facet_table::FacetTable;
pub use grid::Layout;
pub use instance_lobe::InstanceLobe;
pub use mesh::Mesh;
pub use optics::Fresnel;
pub use parameters::{Across, Average, Body, Parameters, Readings, Surface, Water};
pub use real::{Real, Scalar};
pub use sampling::Sample;
pub use scenario::{Aim, Engagement};
pub use slope_draws::Proposal;
pub use slopes::SlopeMeasure;
pub use statistics::Statistics;
pub use surface::Surface as RealisedSurface;
pub use table::Table;
pub use wave_sums::WaveSums;
pub use waves::Draws;
pub use wind::{Wind, WindProfile};
