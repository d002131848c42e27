//! The probabilistic BRDF: what observers of a laser's reflection may see, by draws and without (section 7).

mod beam;
pub(crate) mod breaking;
pub(crate) mod characteristic;
mod engagement;
pub mod ensemble;
mod exact;
pub(crate) mod facet_density;
pub(crate) mod level_water;
mod samples;
pub(crate) mod slope_density;
mod slope_draws;
mod spot;
mod summary;

pub use beam::Beam;
pub use engagement::{Aim, Engagement, FARTHEST, FLATTEST_BEAM};
pub use ensemble::{Ensemble, Hit, Observation, Proposal, WhitecapMode};
pub use exact::{Exact, Means};
pub use samples::{MEMORY, Samples, Sighting};
pub use slope_draws::FEWEST_COMPONENTS;
pub use spot::{Spot, SpotShape};
pub use summary::{CONFIDENCE, FEWEST_EFFECTIVE, QUANTILES, Statistics};
