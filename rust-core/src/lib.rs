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
//! One module, a folder, for each part of the work. A module uses only those above it in this list, checked by
//! `cargo xtask tidy`:
//!
//! | module | holds | equations |
//! | --- | --- | --- |
//! | [`numeric`] | number types, quadrature, roots, sine and cosine of many angles | |
//! | [`simd`] | the processor's vectors as a number type | |
//! | [`sea`] | wind, whitecaps, spectrum of the waves | 1-22, 51, 53-55 |
//! | [`brdf`] | facets at a point: slopes, reflectance, shadowing, sampling | 56-79 |
//! | [`config`] | parameters, their names, and the sea that follows | |
//! | [`surface`] | drawn waves, the surface they make, rays | 23-50, 52 |
//! | [`statistics`] | lasers and observers, over drawn surfaces and without draws | section 7 |
//! | [`render`] | a sea from afar, one drawn sea, meshes | |
//! | [`empirical`] | the empirical model and its tables | 80-91 |
//! | [`api`] | many rows at once, and C | |
//!
//! [`Error`] and [`Readings`] stand above them all.
//!
//! `docs/model.md` tells where the report's print is defective, how this crate reads it, and
//! which test shows it.

pub mod api;
pub mod brdf;
pub mod config;
pub mod empirical;
mod error;
pub mod numeric;
mod readings;
pub mod render;
pub mod sea;
pub mod simd;
pub mod statistics;
pub mod surface;

pub use api::batch;
pub use api::kernels::{self, Kernels};
pub use brdf::{
    Dispersion, Fresnel, Lobe, Reflectance, Sample, SlopeMeasure, SlopeStatistics, fresnel, sampling,
    shadowing, slopes,
};
pub use config::{
    Average, FootprintMeasure, Hiding, OffPlaneModel, Parameters, SlopeBudget, Surface, Water, vocabulary,
};
pub use empirical::{EmpiricalLobe, Estimate, FineGrid, Gridded, Table, planes, table, table_file};
pub use error::{Error, Warning};
pub use numeric::{Real, Scalar, real};
pub use readings::Readings;
pub use render::{
    EnsembleLobe, FacetTable, InstanceLobe, Layout, Mesh, OnsetTable, ensemble_lobe, grid, mesh,
};
pub use sea::{Salinity, SpectrumModel, Swell, Wind, WindProfile, foam, spectrum, whitecap, wind};
pub use statistics::{
    Aim, Beam, Engagement, Ensemble, Exact, Proposal, Spot, SpotShape, Statistics, WhitecapMode, ensemble,
};
pub use surface::{Draws, Surface as RealisedSurface, WaveSums};
