//! What a user may choose, under which names, and the sea that follows from it.

mod configure;
pub(crate) mod parameters;
mod slope_split;
pub mod vocabulary;

pub use parameters::{
    Average, FootprintMeasure, Hiding, LONGEST_TIME, MOST_COMPONENTS, MOST_INSTANCES, OffPlaneModel,
    Parameters, Surface, Water,
};
pub use slope_split::SlopeBudget;
