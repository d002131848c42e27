//! The waves that are drawn: which components a sea may have (Eqs. 21-27, 37-38) and the random streams they come
//! from.
//!
//! **Streams.** Every instance has its own, so that it is the same whoever computes it and in whatever order: ChaCha8
//! with the seed as the first eight bytes of its key (little endian, the rest 0), no nonce, and the instance's number as
//! the stream. A uniform number is the upper 53 bits of the next 64, over 2^53. The first decides about the whitecap,
//! then every component takes three: wave number, phase, azimuth. More components do not change the first ones.
//!
//! [`Draws::Sobol`] replaces the upper 23 bits of the first 256 numbers by Burley's hashed Sobol sequence, its 65536 points
//! by a new scramble for every 65536 instances.
//!
//! [`Draws::Stratified`] takes the same numbers. Component j of M has its wave number at (j + u)/M of the range, and its
//! azimuth at the fraction of j golden ratios plus the first component's number; the other components' third number is
//! not used. So components come in order of rising wave number, and other M draw another sea.

use crate::spectrum::{Spectrum, spreading};
use crate::surface::{Surface, share};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{RngCore, SeedableRng};
use std::f64::consts::{PI, TAU};

/// How the random numbers of the instances are spread.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Draws {
    /// Independently, as in the report.
    #[default]
    Random,
    /// By an Owen-scrambled Sobol sequence: each instance by itself is distributed as in the report, and all of them
    /// cover the possible draws evenly. A mean over instances keeps its expectation and loses spread.
    Sobol,
    /// Evenly over the spectrum: every component by itself is distributed as one of the report's, and hundreds of them
    /// are, in each instance, a sea of the spectrum's variances.
    Stratified,
}

/// Its multiples' fractions spread most evenly.
const GOLDEN_RATIO: f64 = 0.618_033_988_749_894_9;

/// One drawn wave, in metres and seconds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Component {
    /// k, rad/m.
    pub wave_number: f64,
    /// psi, radians.
    pub phase: f64,
    /// phi, radians from +x: the wave comes from there.
    pub azimuth: f64,
    /// a, m.
    pub amplitude: f64,
    /// omega, rad/s.
    pub frequency: f64,
}

impl Component {
    /// The wave that has this one's phase at a place in m and a time in s (Eq. 31) instead of at the origin at 0.
    pub fn with_phase_at(self, [x, y]: [f64; 2], time: f64) -> Self {
        if (x, y, time) == (0.0, 0.0, 0.0) {
            return self;
        }
        let (sin, cos) = self.azimuth.sin_cos();
        let since = self.frequency * time + self.wave_number * (x * cos + y * sin);
        Self { phase: (self.phase - since) % TAU, ..self }
    }

    /// The part of the wave that stays geometry at a footprint in m, see [`share`].
    pub fn seen_at(self, footprint: f64) -> Self {
        Self { amplitude: self.amplitude * share(self.wave_number, footprint).sqrt(), ..self }
    }

    /// Variance of its slope.
    pub(crate) fn slope_variance(&self) -> f64 {
        0.5 * (self.amplitude * self.wave_number).powi(2)
    }

    /// Variance of its vertical acceleration (Eq. 52), m^2/s^4.
    pub(crate) fn acceleration_variance(&self) -> f64 {
        0.5 * (self.amplitude * self.frequency * self.frequency).powi(2)
    }
}

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
}

impl Waves {
    /// Number of components an instance really has: 0 where there are no waves.
    pub fn len(&self) -> usize {
        if self.log_range.is_some() { self.components } else { 0 }
    }

    /// Whether there are no waves.
    pub fn is_empty(&self) -> bool {
        self.log_range.is_none()
    }

    /// L, extent of the wave numbers (Eq. 25).
    pub fn extent(&self) -> f64 {
        self.log_range.map_or(0.0, |[low, high]| high - low)
    }

    /// The wave of a wave number in rad/cm, a phase and an azimuth: amplitude as in Eq. 38, frequency of Eq. 4.
    pub fn component(&self, k: f64, phase: f64, azimuth: f64) -> Component {
        let energy = self.spectrum.density(k) * spreading(azimuth - self.wind_azimuth) * k;
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

    /// The components that these numbers draw.
    pub fn components(&self, mut numbers: Numbers) -> impl Iterator<Item = Component> {
        let range = self.log_range.unwrap_or_default();
        let mut shift = None;
        (0..self.len()).map(move |j| {
            let mut u: [f64; 3] = std::array::from_fn(|_| numbers.next());
            if numbers.draws == Draws::Stratified {
                let shift = *shift.get_or_insert(u[2]);
                u[0] = (j as f64 + u[0]) / self.len() as f64;
                u[2] = (shift + j as f64 * GOLDEN_RATIO).fract();
            }
            self.draw(range, u)
        })
    }

    /// Their surface at a time in s.
    pub fn surface(&self, numbers: Numbers, time: f64) -> Surface {
        Surface::new(self.components(numbers), time)
    }
}

/// The uniform numbers of one instance.
pub struct Numbers {
    draws: Draws,
    stream: ChaCha8Rng,
    sobol: Option<Point>,
}

/// A point of a Sobol sequence.
struct Point {
    index: u32,
    scramble: u32,
    dimension: u32,
}

/// Points of a sequence, as a power of 2.
const SEQUENCE: u32 = 16;

impl Numbers {
    /// The numbers of an instance.
    pub fn new(draws: Draws, seed: u64, instance: u64) -> Self {
        let mut key = [0; 32];
        key[..8].copy_from_slice(&seed.to_le_bytes());
        let mut stream = ChaCha8Rng::from_seed(key);
        stream.set_stream(instance);
        let sobol = (draws == Draws::Sobol).then(|| Point {
            index: instance as u32 & ((1 << SEQUENCE) - 1),
            scramble: mix(seed ^ mix(instance >> SEQUENCE)) as u32,
            dimension: 0,
        });
        Self { draws, stream, sobol }
    }

    /// The next number, of [0, 1).
    #[allow(clippy::should_implement_trait)]
    pub fn next(&mut self) -> f64 {
        let u = (self.stream.next_u64() >> 11) as f64 / (1u64 << 53) as f64;
        let Some(point) = self.sobol.as_mut().filter(|p| p.dimension < sobol_burley::NUM_DIMENSIONS) else {
            return u;
        };
        let upper = f64::from(sobol_burley::sample(point.index, point.dimension, point.scramble));
        point.dimension += 1;
        (upper + u / f64::from(1 << 23)).min(1.0 - f64::EPSILON / 2.0)
    }
}

/// Stafford's variant 13 of the finaliser of MurmurHash3.
fn mix(x: u64) -> u64 {
    let x = x.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    x ^ (x >> 31)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The documented stream: whoever breaks this changes every user's numbers. The first is ChaCha8's published test
    /// vector for the key 0, 3e 00 ef 2f 89 5f 40 d6.
    #[test]
    fn streams_are_stable() {
        let first = |seed, instance| {
            let mut numbers = Numbers::new(Draws::Random, seed, instance);
            [numbers.next(), numbers.next(), numbers.next()]
        };
        assert_eq!(first(0, 0)[0], (0xd640_5f89_2fef_003e_u64 >> 11) as f64 / (1u64 << 53) as f64);
        assert_eq!(first(0, 0), [0.836_919_756_882_647_2, 0.631_424_494_066_523_1, 0.232_415_843_466_748_48]);
        assert_eq!(first(7, 3), [0.662_921_773_426_872_6, 0.504_500_465_857_356_2, 0.736_051_825_523_653_7]);
    }

    /// Every 256th of every number's range holds one of 256 instances, and so does every cell of 16 x 16.
    #[test]
    fn sobol_points_fill_cells_evenly() {
        for first in [0, 1 << SEQUENCE] {
            let mut rows = vec![];
            for instance in first..first + 256 {
                let mut numbers = Numbers::new(Draws::Sobol, 5, instance);
                rows.push([(); 300].map(|()| numbers.next()));
            }
            for d in 0..256 {
                let mut cells: Vec<_> = rows.iter().map(|r| (r[d] * 256.0) as u64).collect();
                cells.sort();
                assert!(cells.into_iter().eq(0..256), "dimension {d}");
            }
            let mut pairs: Vec<_> =
                rows.iter().map(|r| (r[0] * 16.0) as u64 * 16 + (r[1] * 16.0) as u64).collect();
            pairs.sort();
            assert!(pairs.into_iter().eq(0..256));
            // The rest is random.
            let mean = rows.iter().map(|r| r[290]).sum::<f64>() / 256.0;
            assert!((mean - 0.5).abs() < 0.1);
        }
        assert_ne!(Numbers::new(Draws::Sobol, 5, 0).next(), Numbers::new(Draws::Sobol, 6, 0).next());
    }
}
