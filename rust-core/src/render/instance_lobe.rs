//! The BRDF of a level surface that reflects, place by place, as one drawn sea does: `surface = "instance"`.

use super::OnsetTable;
use crate::brdf::lobe::{cosine, up};
use crate::brdf::{Lobe, Parts};
use crate::config::Water;
use crate::error::Error;
use crate::numeric::real::Extended;
use crate::numeric::{Real, Vec3};
use crate::sea::foam::Foam;
use crate::sea::whitecap::Onset;
use crate::statistics::Ensemble;
use crate::surface::{Component, Surface, Waves};
use std::f64::consts::{PI, TAU};

/// One drawn sea at one time, as the normals and whitecaps of a level surface.
#[derive(Debug, Clone)]
pub struct InstanceLobe {
    water: Water,
    components: Vec<Component>,
    surface: Surface,
    onset: Option<Onset<f64>>,
    onsets: Option<OnsetTable<f64>>,
    foam: Option<Foam>,
}

/// The sea at a place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LocalSea {
    /// The wave normal.
    pub normal: [f64; 3],
    /// Probability of a whitecap (Eqs. 53-54), with a lifetime its mean over the past.
    pub whitecap: f64,
}

impl InstanceLobe {
    /// The first of the seas that the seed draws, at the parameters' time.
    ///
    /// # Errors
    /// [`Error::Surface`] where the surface is not [`crate::Surface::Instance`].
    pub fn new(water: &Water) -> Result<Self, Error> {
        Self::of(water, water.waves(), water.whitecap_onset(), None)
    }

    /// The same for footprints that change from place to place, from the parameters' one upwards: with the waves that
    /// fade there.
    ///
    /// # Errors
    /// As [`InstanceLobe::new`].
    pub fn fading(water: &Water) -> Result<Self, Error> {
        let onset = water.fading_whitecap_onset(water.footprint);
        Self::of(water, water.fading_waves(), onset, OnsetTable::new(water))
    }

    fn of(
        water: &Water,
        waves: Waves,
        onset: Option<Onset<f64>>,
        onsets: Option<OnsetTable<f64>>,
    ) -> Result<Self, Error> {
        let water = water.on(&[crate::config::Surface::Instance])?;
        let sea = Ensemble { waves, onset, ..Ensemble::new(&water)? };
        let components: Vec<_> = sea.components(0).1.collect();
        let surface = Surface::new(components.iter().copied(), water.parameters.time);
        // None can stand where all crests together are not steep enough.
        let steepest: f64 = components.iter().map(|c| c.amplitude * c.frequency * c.frequency).sum();
        let onset = onset.filter(|onset| onset.probability(-steepest) > 0.0);
        let foam = waves.foam(water.parameters.whitecap_lifetime);
        Ok(Self { water, components, surface, onset, onsets, foam })
    }

    /// The waves that make the sea.
    pub fn components(&self) -> &[Component] {
        &self.components
    }

    /// The same for a renderer that sums them itself.
    pub fn terms(&self) -> impl Iterator<Item = WaveTerm<f64>> {
        let time = self.water.parameters.time;
        self.components.iter().map(move |c| WaveTerm::new(c, time))
    }

    /// The onset of whitecaps; `None` where none can stand anywhere.
    pub fn whitecap_onset(&self) -> Option<Onset<f64>> {
        self.onset
    }

    /// The onset for footprints that change from place to place, where it follows them.
    pub fn whitecap_onsets(&self) -> Option<&OnsetTable<f64>> {
        self.onsets.as_ref()
    }

    /// The sea at a place in m. With a footprint in m the waves too short for it are left to the facets.
    pub fn local(&self, place: [f64; 2], footprint: Option<f64>) -> LocalSea {
        let point = match footprint {
            None => self.surface.point(place),
            Some(footprint) => self.surface.point_within(place, footprint),
        };
        let onset = match (&self.onsets, footprint) {
            (Some(onsets), Some(footprint)) => Some(onsets.at(footprint.log2())),
            _ => self.onset,
        };
        let whitecap = onset.map_or(0.0, |onset| match self.foam {
            None => onset.probability(point.acceleration),
            Some(foam) => foam.mean(self.surface.time(), |before| {
                onset.probability(match footprint {
                    None => self.surface.acceleration_before(before, place),
                    Some(footprint) => self.surface.acceleration_before_within(before, place, footprint),
                })
            }),
        });
        LocalSea { normal: point.normal(), whitecap }
    }

    /// `f cos(theta_o)`, 1/sr, at a place in m, for unit vectors to source and observer; 0 at or below the horizon,
    /// NaN in, NaN out.
    pub fn eval(&self, i: [f64; 3], o: [f64; 3], place: [f64; 2]) -> f64 {
        self.eval_parts(i, o, place, Parts::ALL)
    }

    /// The same of some of its parts, 1/sr.
    pub fn eval_parts(&self, i: [f64; 3], o: [f64; 3], place: [f64; 2], parts: Parts) -> f64 {
        let local = self.local(place, None);
        let lobe = self.water.lobe.with_whitecaps(local.whitecap);
        lobe.on_wave(i, o, local.normal, parts)
    }
}

/// One wave at a time, as a renderer sums it over a place.
#[derive(Debug, Clone, Copy)]
pub struct WaveTerm<T> {
    /// Its phase, turns: of the origin in [`InstanceLobe::terms`], of a place where it is summed.
    pub turns: T,
    /// Wave numbers along x and y, turns per m.
    pub wave_number: [T; 2],
    /// a, m.
    pub amplitude: T,
    /// omega^2, 1/s^2.
    pub frequency_squared: T,
    /// log2(k D/pi) for a footprint D of 1 m.
    pub log2_fading: T,
}

impl WaveTerm<f64> {
    fn new(c: &Component, time: f64) -> Self {
        let (sin, cos) = c.azimuth.sin_cos();
        let k = c.wave_number / TAU;
        Self {
            turns: ((c.phase + c.frequency * time) / TAU).fract(),
            wave_number: [k * cos, k * sin],
            amplitude: c.amplitude,
            frequency_squared: c.frequency * c.frequency,
            log2_fading: (c.wave_number / PI).log2(),
        }
    }
}

impl<T: Real> WaveTerm<T> {
    /// Adds the wave to the sums of `a k_x sin`, `a k_y sin` (the negative slopes, Eqs. 39-40) and `a omega^2 cos` (the negative
    /// vertical acceleration, Eq. 52, m/s^2). With the log2 of a footprint in m its share ([`crate::surface::share`]) alone.
    pub fn add_to(&self, [x, y, acceleration]: [T; 3], log2_footprint: Option<T>) -> [T; 3] {
        let (sin, cos) = self.turns.sin_cos_turns();
        let mut a = self.amplitude;
        if let Some(log2_footprint) = log2_footprint {
            let share = T::of(0.5) - (self.log2_fading + log2_footprint);
            a = a * T::min(T::max(share, T::of(0.0)), T::of(1.0)).sqrt();
        }
        let steep = T::of(TAU) * a * sin;
        let [kx, ky] = self.wave_number;
        [steep.mul_add(kx, x), steep.mul_add(ky, y), (a * self.frequency_squared).mul_add(cos, acceleration)]
    }
}

impl<T: Real> Lobe<T> {
    /// `f cos(theta_o)` of some of its parts, of a level surface whose waves have the normal `n` here:
    /// `f_N (N.i)(N.o)/(N_z cos theta_i)`, 1/sr; 0 at or below the horizon.
    pub fn on_wave(&self, i: Vec3<T>, o: Vec3<T>, n: impl Into<Option<Vec3<T>>>, parts: Parts) -> T {
        let n = n.into();
        let f = self.eval_parts(i, o, n, parts);
        self.projected_from_wave::<T::Extended>(f, i, o, n.unwrap_or_else(up))
    }

    /// `f cos(theta_o)` of a level surface for f about the normal `n` of its waves.
    pub(crate) fn projected_from_wave<E: Extended<T>>(&self, f: T, i: Vec3<T>, o: Vec3<T>, n: Vec3<T>) -> T {
        let zero = T::of(0.0);
        let seen = cosine::<T, E>(i, n) * cosine::<T, E>(o, n) / T::max(n[2] * i[2], T::TINY);
        let value = T::min(f * T::max(seen, zero), T::MAX);
        // What is not a number in f is none here, also below the level horizon.
        zero.mul_add(f, T::select(T::lt(zero, i[2]) & T::lt(zero, o[2]), value, zero))
    }
}
