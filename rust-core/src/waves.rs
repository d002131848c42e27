//! The waves that are drawn: which components a sea may have (Eqs. 21-27, 37-38) and the random streams they come
//! from.
//!
//! **Streams.** Every instance has its own, so that it is the same whoever computes it and in whatever order: ChaCha8
//! with the seed as the first eight bytes of its key (little endian, the rest 0), no nonce, and the instance's number as
//! the stream. A uniform number is the upper 53 bits of the next 64, over 2^53. The first decides about the whitecap,
//! then every component takes three: wave number, phase, azimuth. More components do not change the first ones.

use crate::spectrum::{Spectrum, spreading};
use crate::surface::Surface;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{RngCore, SeedableRng};
use std::f64::consts::{PI, TAU};

/// How the random numbers of the instances are spread.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Draws {
    /// Independently, as in the report.
    #[default]
    Random,
    /// In a Latin hypercube over the instances: each instance by itself is distributed as in the report, and every
    /// number is spread evenly over all of them. A mean over instances keeps its expectation and loses spread.
    Stratified,
}

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

    /// The components of an instance.
    pub fn components(&self, numbers: &mut Numbers) -> impl Iterator<Item = Component> {
        let range = self.log_range.unwrap_or_default();
        (0..self.len()).map(move |_| self.draw(range, std::array::from_fn(|_| numbers.next())))
    }

    /// The surface of an instance at a time in s.
    pub fn surface(&self, numbers: &mut Numbers, time: f64) -> Surface {
        Surface::new(self.components(numbers), time)
    }
}

/// The uniform numbers of one instance.
pub struct Numbers {
    stream: ChaCha8Rng,
    strata: Option<Strata>,
}

/// One cell of a Latin hypercube.
struct Strata {
    seed: u64,
    instance: u64,
    instances: u64,
    dimension: u64,
}

impl Numbers {
    /// The independent numbers of an instance.
    pub fn new(seed: u64, instance: u64) -> Self {
        let mut key = [0; 32];
        key[..8].copy_from_slice(&seed.to_le_bytes());
        let mut stream = ChaCha8Rng::from_seed(key);
        stream.set_stream(instance);
        Self { stream, strata: None }
    }

    /// The numbers of an instance that is one of many.
    pub fn of(draws: Draws, seed: u64, instance: u64, instances: u64) -> Self {
        let mut numbers = Self::new(seed, instance);
        if draws == Draws::Stratified {
            numbers.strata = Some(Strata { seed, instance, instances, dimension: 0 });
        }
        numbers
    }

    /// The next number, of [0, 1).
    #[allow(clippy::should_implement_trait)]
    pub fn next(&mut self) -> f64 {
        let u = (self.stream.next_u64() >> 11) as f64 / (1u64 << 53) as f64;
        let Some(s) = &mut self.strata else { return u };
        let key = mix(s.seed ^ mix(s.dimension));
        s.dimension += 1;
        let u = (shuffled(s.instance, s.instances, key) as f64 + u) / s.instances as f64;
        u.min(1.0 - f64::EPSILON / 2.0)
    }
}

/// The place of `index` in a random order of `length` things: a Feistel network, walked until it falls among them.
fn shuffled(index: u64, length: u64, key: u64) -> u64 {
    let half = (u64::BITS - (length - 1).leading_zeros()).div_ceil(2).max(1);
    let mask = (1 << half) - 1;
    let mut at = index;
    loop {
        for round in 0..4 {
            let (left, right) = (at >> half, at & mask);
            at = (right << half) | (left ^ (mix(key ^ mix(right ^ (round << 56))) & mask));
        }
        if at < length {
            return at;
        }
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

    #[test]
    fn shuffling_is_a_permutation() {
        for length in [1, 2, 3, 7, 50, 64, 1000, 1025] {
            for key in [0, 1, u64::MAX] {
                let mut seen = vec![false; length as usize];
                for i in 0..length {
                    seen[shuffled(i, length, key) as usize] = true;
                }
                assert!(seen.into_iter().all(|s| s), "{length}");
            }
        }
    }

    /// The documented stream: whoever breaks this changes every user's numbers. The first is ChaCha8's published test
    /// vector for the key 0, 3e 00 ef 2f 89 5f 40 d6.
    #[test]
    fn streams_are_stable() {
        let first = |seed, instance| {
            let mut numbers = Numbers::new(seed, instance);
            [numbers.next(), numbers.next(), numbers.next()]
        };
        assert_eq!(first(0, 0)[0], (0xd640_5f89_2fef_003e_u64 >> 11) as f64 / (1u64 << 53) as f64);
        assert_eq!(first(0, 0), [0.836_919_756_882_647_2, 0.631_424_494_066_523_1, 0.232_415_843_466_748_48]);
        assert_eq!(first(7, 3), [0.662_921_773_426_872_6, 0.504_500_465_857_356_2, 0.736_051_825_523_653_7]);
    }

    /// Every stratum of every dimension holds one instance, and dimensions are shuffled apart.
    #[test]
    fn strata_hold_one_instance_each() {
        let n = 97;
        let mut columns = vec![vec![]; 16];
        for instance in 0..n {
            let mut numbers = Numbers::of(Draws::Stratified, 5, instance, n);
            for column in &mut columns {
                column.push(numbers.next());
            }
        }
        let mean = |v: &[f64]| v.iter().sum::<f64>() / v.len() as f64;
        for (a, column) in columns.iter().enumerate() {
            let mut strata: Vec<_> = column.iter().map(|u| (u * n as f64) as u64).collect();
            strata.sort();
            assert!(strata.into_iter().eq(0..n));
            for other in &columns[..a] {
                let product: Vec<_> = column.iter().zip(other).map(|(x, y)| (x - 0.5) * (y - 0.5)).collect();
                assert!(12.0 * mean(&product).abs() < 5.0 / (n as f64).sqrt());
            }
        }
    }
}
