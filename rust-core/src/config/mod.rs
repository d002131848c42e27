//! What a user may choose, under which names, and the sea that follows from it.

mod configure;
pub(crate) mod parameters;
pub mod vocabulary;

pub use parameters::{
    Across, Average, LONGEST_TIME, MOST_COMPONENTS, MOST_INSTANCES, Parameters, Readings, Surface, Water,
};
