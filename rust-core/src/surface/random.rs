//! The random streams that waves are drawn from.
//!
//! **Streams.** Every instance has its own, so that it is the same whoever computes it and in whatever order: ChaCha8
//! with the seed as the first eight bytes of its key (little endian, the rest 0), no nonce, and the instance's number as
//! the stream. A uniform number is the upper 53 bits of the next 64, over 2^53. The first decides about the whitecap,
//! then every component takes three: wave number, phase, azimuth; after the wind's those of a swell. More components do not change the first ones.
//!
//! [`Draws::Sobol`] replaces the upper 23 bits of the first 256 numbers by Burley's hashed Sobol sequence, its 65536 points
//! by a new scramble for every 65536 instances.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{RngCore, SeedableRng};

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

/// The uniform numbers of one instance.
pub struct InstanceRng {
    pub(super) draws: Draws,
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

impl InstanceRng {
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
            let mut numbers = InstanceRng::new(Draws::Random, seed, instance);
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
                let mut numbers = InstanceRng::new(Draws::Sobol, 5, instance);
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
        assert_ne!(InstanceRng::new(Draws::Sobol, 5, 0).next(), InstanceRng::new(Draws::Sobol, 6, 0).next());
    }
}
