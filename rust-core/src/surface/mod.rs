//! Drawn seas: their waves, the surface that these make, and rays that meet it (Eqs. 23-50, 52).

mod component;
mod random;
mod ray;
mod realised;
mod wave_sums;
mod waves;

pub use crate::sea::spectrum::share;
pub use component::Component;
pub use random::{Draws, InstanceRng};
pub use ray::SurfaceRay;
pub(crate) use realised::mean_of_wave;
pub use realised::{Point, Surface, normal};
pub use wave_sums::WaveSums;
pub use waves::Waves;
