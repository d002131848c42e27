//! Draws of seas, directions and uniform numbers, with more than their share of corners.

use prob_water::{Fresnel, Hiding, Parameters, Readings, Salinity, SlopeMeasure, SlopeStatistics, Wind};
use rand::rngs::StdRng;
use rand::{Rng, RngCore, SeedableRng};
use std::f64::consts::TAU;

/// A direction or normal.
pub type Vec3 = [f64; 3];

/// The random numbers of one block.
pub struct Draw {
    rng: StdRng,
    sea: Parameters,
}

impl Draw {
    /// Of a part's block; every one has its own.
    pub fn new(seed: u64, part: &str, block: u64) -> Self {
        let mut key = [0; 32];
        key[..8].copy_from_slice(&seed.to_le_bytes());
        key[8..16].copy_from_slice(&block.to_le_bytes());
        for (place, byte) in key[16..].iter_mut().zip(part.bytes()) {
            *place = byte;
        }
        Self { rng: StdRng::from_seed(key), sea: Parameters::default() }
    }

    /// The sea that the block is about, for messages.
    pub fn sea(&self) -> Parameters {
        self.sea
    }

    /// Tells it.
    pub fn about(&mut self, sea: Parameters) -> Parameters {
        self.sea = sea;
        sea
    }

    /// One of so many, evenly.
    pub fn pick(&mut self, of: u32) -> u32 {
        ((u64::from(self.rng.next_u32()) * u64::from(of)) >> 32) as u32
    }

    /// Uniform between two numbers.
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.rng.random::<f64>()
    }

    /// Uniform in the logarithm.
    pub fn log_between(&mut self, low: f64, high: f64) -> f64 {
        self.between(low.ln(), high.ln()).exp().clamp(low, high)
    }

    /// One of some.
    pub fn one_of<T: Copy>(&mut self, some: &[T]) -> T {
        some[self.pick(some.len() as u32) as usize]
    }

    /// True or false.
    pub fn flag(&mut self) -> bool {
        self.rng.random()
    }

    /// Any bits.
    pub fn bits(&mut self) -> u64 {
        self.rng.next_u64()
    }

    /// Winds, cm/s: log-uniform, the calm, and the end of Table 1.
    pub fn wind(&mut self) -> Wind {
        match self.pick(16) {
            0 => Wind::FrictionVelocity(0.0),
            1 => Wind::FrictionVelocity(238.65),
            2 => Wind::Beaufort(self.pick(13) as u8),
            3 => Wind::Speed { speed: self.between(0.0, 25.0), height: self.log_between(5.0, 100.0) },
            _ => Wind::FrictionVelocity(self.log_between(0.01, 223.9)),
        }
    }

    /// The corrected equations, the print, or some of it; not Eq. 70, which seas of many surfaces refuse.
    fn readings(&mut self) -> Readings {
        match self.pick(4) {
            0 | 1 => Readings::CORRECTED,
            2 => Readings::AS_PRINTED,
            _ => Readings::equations()
                .map(|(_, reading)| reading)
                .filter(|reading| *reading != Readings::EQ_70 && self.flag())
                .fold(Readings::CORRECTED, |all, reading| all | reading),
        }
    }

    /// Any sea of the closed form: every switch, and every range to its ends.
    pub fn flat_sea(&mut self) -> Parameters {
        let sea = Parameters {
            wind: self.wind(),
            wind_direction: match self.pick(8) {
                0 => self.one_of(&[0.0, -0.0, 90.0, 180.0, -270.0, 1e15, 5e-324, -1e300]),
                _ => self.between(-360.0, 360.0),
            },
            footprint: Some(match self.pick(8) {
                0 | 1 => f64::INFINITY,
                2 => 1e-3,
                3 => self.one_of(&[5e-324, 1e-12, 1e12, f64::MAX]),
                _ => self.log_between(1e-3, 1e4),
            }),
            wavelength: match self.pick(4) {
                0 => self.one_of(&[0.2, 200.0]),
                _ => self.log_between(0.2, 200.0),
            },
            ior: match self.pick(4) {
                0 => Some(self.one_of(&[1.0, 1.0 + f64::EPSILON, 4.0])),
                1 => Some(self.between(1.0, 4.0)),
                _ => None,
            },
            water: self.one_of(&[Salinity::Ocean, Salinity::Fresh]),
            fresnel: self.one_of(&[Fresnel::Schlick, Fresnel::Exact]),
            slope_measure: self.one_of(&[SlopeMeasure::Angle, SlopeMeasure::Slope]),
            slopes: self.one_of(&[SlopeStatistics::CoxMunk, SlopeStatistics::BreonHenriot]),
            readings: self.readings(),
            hiding: self.one_of(&[Hiding::Report, Hiding::Once]),
            whitecaps: self.flag(),
            shadowing: self.flag(),
            gram_charlier: self.flag(),
            ..Parameters::default()
        };
        self.about(sea)
    }

    /// Three uniform numbers of [0, 1), often at its ends.
    pub fn uniforms(&mut self) -> Vec3 {
        [0; 3].map(|_| match self.pick(8) {
            0 => 0.0,
            1 => 1.0 - f64::EPSILON / 2.0,
            2 => self.one_of(&[5e-324, 1e-300, 1e-45, 0.5]),
            _ => self.rng.random(),
        })
    }

    /// A unit vector at a zenith angle in degrees, any azimuth.
    pub fn at(&mut self, theta: f64) -> Vec3 {
        let ((s, c), (sp, cp)) = (theta.to_radians().sin_cos(), self.between(0.0, TAU).sin_cos());
        [s * cp, s * sp, c]
    }

    /// Any direction: over the whole hemisphere, grazing to 89.9999 degrees, on the horizon, overhead, from below.
    pub fn direction(&mut self) -> Vec3 {
        match self.pick(16) {
            0..=4 => {
                let z = self.between(0.0, 1.0);
                self.at(z.acos().to_degrees())
            }
            5..=8 => {
                let elevation = self.log_between(1e-4, 10.0);
                self.at(90.0 - elevation)
            }
            9 => {
                let [x, y, _] = self.at(90.0);
                let z =
                    self.one_of(&[0.0, -0.0, 5e-324, 1e-310, 1e-45, 1e-40, 1.2e-38, -1e-45, -1e-38, 1e-20]);
                [x, y, z]
            }
            10 => {
                let zero = self.one_of(&[0.0, -0.0]);
                self.one_of(&[[1.0, zero, zero], [-1.0, zero, zero], [zero, 1.0, zero], [zero, -1.0, zero]])
            }
            11 => [self.one_of(&[0.0, -0.0]), self.one_of(&[0.0, -0.0]), 1.0],
            12 => {
                let theta = self.log_between(1e-12, 1e-2);
                self.at(theta)
            }
            13 => {
                let below = self.log_between(1e-4, 90.0);
                self.at(90.0 + below)
            }
            14 => {
                let theta = self.one_of(&[45.0, 60.0, 80.0, 89.0, 89.9, 89.99, 89.999, 89.9999]);
                self.at(theta)
            }
            _ => {
                let theta = self.between(0.0, 60.0);
                self.at(theta)
            }
        }
    }
}
