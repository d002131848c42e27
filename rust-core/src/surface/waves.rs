//! The waves that are drawn: which components a sea may have (Eqs. 21-27, 37-38), and after them those of a swell.
//!
//! [`Draws::Stratified`] takes the same random numbers as [`Draws::Random`]. Component j of M has its wave number at
//! (j + u)/M of the range, and its azimuth at the fraction of j golden ratios plus the first component's number; the other components' third number is
//! not used. So components come in order of rising wave number, and other M draw another sea.

use super::component::Component;
use super::random::{Draws, InstanceRng};
use super::realised::Surface;
use crate::config::Water;
use crate::sea::foam::Foam;
use crate::sea::{Spectrum, Swell};
use std::f64::consts::{PI, SQRT_2, TAU};

/// Its multiples' fractions spread most evenly.
const GOLDEN_RATIO: f64 = 0.618_033_988_749_894_9;
/// Frequencies of a swell in means.
const NODES: u32 = 128;

/// What the components of a sea are drawn from.
#[derive(Debug, Clone, Copy)]
pub struct Waves {
    /// The energy.
    pub spectrum: Spectrum,
    /// Logarithms of the smallest and the largest wave number in rad/cm (Eqs. 21-23); `None`: there are no waves.
    pub log_range: Option<[f64; 2]>,
    /// M, components of an instance.
    pub components: usize,
    /// phi_W, radians.
    pub wind_azimuth: f64,
    /// It has M components of its own, of equal energy.
    pub swell: Option<Swell>,
}

impl Waves {
    /// Number of components an instance really has: 0 where there are no waves.
    pub fn len(&self) -> usize {
        self.of_wind() + self.of_swell()
    }

    /// Whether there are no waves.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Those that the wind raises, which come first.
    pub fn of_wind(&self) -> usize {
        if self.log_range.is_some() { self.components } else { 0 }
    }

    /// Those of the swell.
    pub fn of_swell(&self) -> usize {
        if self.swell.is_some() { self.components } else { 0 }
    }

    /// Foam on them with a lifetime in s; `None` where it does not last.
    pub fn foam(&self, lifetime: f64) -> Option<Foam> {
        if lifetime == 0.0 {
            return None;
        }
        let wind = self.log_range.map_or(0.0, |[_, high]| self.spectrum.frequency(high.exp()));
        let swell = self.swell.map_or(0.0, |swell| swell.frequency(1.0));
        Foam::new(lifetime, wind.max(swell))
    }

    /// L, extent of the wave numbers (Eq. 25).
    pub fn extent(&self) -> f64 {
        self.log_range.map_or(0.0, |[low, high]| high - low)
    }

    /// The wave of a wave number in rad/cm, a phase and an azimuth: amplitude as in Eq. 38, frequency of Eq. 4.
    pub fn component(&self, k: f64, phase: f64, azimuth: f64) -> Component {
        let energy = self.spectrum.density(k) * self.spectrum.spreading(k, azimuth - self.wind_azimuth) * k;
        Component {
            wave_number: 100.0 * k,
            phase,
            azimuth,
            amplitude: 0.01 * (TAU * self.extent() / self.components as f64 * energy).sqrt(),
            frequency: self.spectrum.frequency(k),
        }
    }

    /// The wave of three uniform numbers (Eqs. 23-27).
    fn draw(&self, [low, high]: [f64; 2], u: [f64; 3]) -> Component {
        let k = (low + u[0] * (high - low)).exp();
        self.component(k, TAU * u[1], self.wind_azimuth + PI * (u[2] - 0.5))
    }

    /// The swell's of three uniform numbers: the shares of its energy at lower frequencies and to the right, and the phase.
    fn draw_swell(&self, swell: &Swell, u: [f64; 3]) -> Component {
        let frequency = swell.frequency(u[0]);
        Component {
            wave_number: swell.wave_number(frequency),
            phase: TAU * u[1],
            azimuth: swell.direction(u[2]),
            amplitude: swell.amplitude(self.components),
            frequency,
        }
    }

    /// Components of the swell whose mean is that of its draws over frequencies; none without one.
    pub(crate) fn swell_nodes(&self) -> impl Iterator<Item = Component> {
        let node = move |n: u32| (f64::from(n) + 0.5) / f64::from(NODES);
        let nodes = self.swell.map_or(0, |_| NODES);
        (0..nodes).filter_map(move |n| Some(self.draw_swell(self.swell.as_ref()?, [node(n), 0.0, 0.5])))
    }

    /// The components that these numbers draw.
    pub fn components(&self, mut numbers: InstanceRng) -> impl Iterator<Item = Component> {
        let range = self.log_range.unwrap_or_default();
        let mut shift = None;
        (0..self.len()).map(move |j| {
            let mut u: [f64; 3] = std::array::from_fn(|_| numbers.next());
            if numbers.draws == Draws::Stratified {
                let shift = *shift.get_or_insert(u[2]);
                u[0] = ((j % self.components) as f64 + u[0]) / self.components as f64;
                u[2] = (shift + j as f64 * GOLDEN_RATIO).fract();
            }
            match &self.swell {
                Some(swell) if j >= self.of_wind() => self.draw_swell(swell, u),
                _ => self.draw(range, u),
            }
        })
    }

    /// Their surface at a time in s.
    pub fn surface(&self, numbers: InstanceRng, time: f64) -> Surface {
        Surface::new(self.components(numbers), time)
    }
}

impl Water {
    /// What the waves longer than two footprints are drawn from.
    pub fn waves(&self) -> Waves {
        self.waves_down_to(self.footprint)
    }

    /// What waves are drawn from that fade out in an octave about two footprints, as [`crate::surface::share`] has it.
    pub fn fading_waves(&self) -> Waves {
        self.waves_down_to(self.footprint / SQRT_2)
    }

    fn waves_down_to(&self, footprint: f64) -> Waves {
        let p = &self.parameters;
        Waves {
            spectrum: self.slopes.spectrum,
            log_range: self.slopes.range(footprint).map(|[low, high]| [low.ln(), high.ln()]),
            components: p.components as usize,
            wind_azimuth: p.wind_direction.to_radians(),
            swell: p.swell(),
        }
    }
}
