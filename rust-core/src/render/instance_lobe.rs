//! The BRDF of a level surface that reflects, place by place, as one drawn sea does: `surface = "instance"`.

use crate::brdf::lobe::{cosine, up};
use crate::brdf::{Lobe, Parts};
use crate::config::Water;
use crate::error::Error;
use crate::numeric::real::Extended;
use crate::numeric::{Real, Vec3};
use crate::statistics::Ensemble;
use crate::surface::{Component, Surface, Waves};

/// One drawn sea at one time, as the normals and whitecaps of a level surface.
#[derive(Debug, Clone)]
pub struct InstanceLobe {
    water: Water,
    components: Vec<Component>,
    surface: Surface,
}

/// The sea at a place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spot {
    /// The wave normal.
    pub normal: [f64; 3],
    /// Probability of a whitecap (Eqs. 53-54).
    pub whitecap: f64,
}

impl InstanceLobe {
    /// The first of the seas that the seed draws, at the parameters' time.
    ///
    /// # Errors
    /// [`Error::Surface`] where the surface is not [`crate::Surface::Instance`].
    pub fn new(water: &Water) -> Result<Self, Error> {
        Self::of(water, water.waves())
    }

    /// The same for footprints that change from place to place, from the parameters' one upwards: with the waves that
    /// fade there.
    ///
    /// # Errors
    /// As [`InstanceLobe::new`].
    pub fn fading(water: &Water) -> Result<Self, Error> {
        Self::of(water, water.fading_waves())
    }

    fn of(water: &Water, waves: Waves) -> Result<Self, Error> {
        let water = water.on(&[crate::config::Surface::Instance])?;
        let sea = Ensemble { waves, ..Ensemble::new(&water)? };
        let components: Vec<_> = sea.components(0).1.collect();
        let surface = Surface::new(components.iter().copied(), water.parameters.time);
        Ok(Self { water, components, surface })
    }

    /// The waves that make the sea.
    pub fn components(&self) -> &[Component] {
        &self.components
    }

    /// The sea at a place in m. With a footprint in m the waves too short for it are left to the facets.
    pub fn spot(&self, place: [f64; 2], footprint: Option<f64>) -> Spot {
        let point = match footprint {
            None => self.surface.point(place),
            Some(footprint) => self.surface.point_within(place, footprint),
        };
        Spot { normal: point.normal(), whitecap: self.water.whitecap_probability(point.acceleration) }
    }

    /// Whether a whitecap can stand anywhere: none can where all crests together are not steep enough.
    pub fn has_whitecaps(&self) -> bool {
        let steepest: f64 = self.components.iter().map(|c| c.amplitude * c.frequency * c.frequency).sum();
        self.water.whitecap_probability(-steepest) > 0.0
    }

    /// `f cos(theta_o)`, 1/sr, at a place in m, for unit vectors to source and observer; 0 at or below the horizon,
    /// not a number where a coordinate is none.
    pub fn eval(&self, i: [f64; 3], o: [f64; 3], place: [f64; 2]) -> f64 {
        let spot = self.spot(place, None);
        let lobe = self.water.lobe.with_whitecaps(spot.whitecap);
        lobe.on_wave(i, o, spot.normal, Parts::ALL)
    }
}

impl<T: Real> Lobe<T> {
    /// `f cos(theta_o)` of some of its parts, of a level surface whose waves have the normal `n` here:
    /// `f_N (N.i)(N.o)/(N_z cos theta_i)`, 1/sr; 0 at or below the horizon.
    pub fn on_wave(&self, i: Vec3<T>, o: Vec3<T>, n: impl Into<Option<Vec3<T>>>, parts: Parts) -> T {
        let n = n.into();
        let f = self.eval_parts(i, o, n, parts);
        self.shown_by_wave::<T::Extended>(f, i, o, n.unwrap_or_else(up))
    }

    /// `f cos(theta_o)` of a level surface for f about the normal `n` of its waves.
    pub(crate) fn shown_by_wave<E: Extended<T>>(&self, f: T, i: Vec3<T>, o: Vec3<T>, n: Vec3<T>) -> T {
        let zero = T::of(0.0);
        let seen = cosine::<T, E>(i, n) * cosine::<T, E>(o, n) / T::max(n[2] * i[2], T::TINY);
        let value = T::min(f * T::max(seen, zero), T::MAX);
        // What is not a number in f is none here, also below the level horizon.
        zero.mul_add(f, T::select(T::lt(zero, i[2]) & T::lt(zero, o[2]), value, zero))
    }
}
