//! Sums of waves over many places in the vectors of the processor: phases in float64, what is summed in float32.
//!
//! [`Surface::point`] is the reference, to the last digits of float64. Here a phase is as exact, whatever its size, and its
//! sine and cosine are good to 1e-7: for meshes and pictures, whose numbers are float32.

use super::realised::{Point, Surface};
use crate::numeric::Real;
use crate::simd::{Kernel, Lanes, SimdLevel, Vector, WIDEST};
use std::f64::consts::TAU;

/// The waves of a surface at its time, by property, filled up to whole vectors with waves of amplitude 0.
#[derive(Debug, Clone, Default)]
pub struct WaveSums {
    /// Phases over the origin, turns.
    phase: Vec<f64>,
    /// Turns per metre along x and y.
    turns: [Vec<f64>; 2],
    /// a, m.
    amplitude: Vec<f32>,
    /// a k along x and y.
    slope: [Vec<f32>; 2],
    /// a omega^2, m/s^2.
    acceleration: Vec<f32>,
}

/// Waves of a lane that are summed in float32 before float64 takes their sum.
const BLOCK: usize = 32;

impl WaveSums {
    /// Of a surface.
    pub fn new(surface: &Surface) -> Self {
        let mut sums = Self::default();
        for [a, phase, kx, ky, omega] in surface.waves() {
            sums.phase.push(phase / TAU);
            sums.amplitude.push(a as f32);
            sums.acceleration.push((a * omega * omega) as f32);
            for (axis, k) in [kx, ky].into_iter().enumerate() {
                sums.turns[axis].push(k / TAU);
                sums.slope[axis].push((a * k) as f32);
            }
        }
        let whole = sums.phase.len().next_multiple_of(WIDEST);
        let [x, y] = &mut sums.turns;
        for array in [&mut sums.phase, x, y] {
            array.resize(whole, 0.0);
        }
        let [x, y] = &mut sums.slope;
        for array in [&mut sums.amplitude, x, y, &mut sums.acceleration] {
            array.resize(whole, 0.0);
        }
        sums
    }

    /// Waves that are summed, those of amplitude 0 at the end included.
    pub fn len(&self) -> usize {
        self.phase.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.phase.is_empty()
    }

    /// Writes the surface over every place in m, on this thread.
    ///
    /// # Panics
    /// If there are not as many points as places.
    pub fn points(&self, places: &[[f64; 2]], points: &mut [Point]) {
        self.points_on(SimdLevel::detect(), places, points);
    }

    /// The same in the vectors of a certain kind: for comparisons. The portable ones stand in for what the processor lacks.
    pub fn points_on(&self, level: SimdLevel, places: &[[f64; 2]], points: &mut [Point]) {
        assert_eq!(places.len(), points.len(), "a point for every place");
        level.run(Sums { waves: self, places, points });
    }
}

struct Sums<'a> {
    waves: &'a WaveSums,
    places: &'a [[f64; 2]],
    points: &'a mut [Point],
}

impl Kernel for Sums<'_> {
    #[inline(always)]
    fn run<V: Vector>(self) {
        for (place, point) in self.places.iter().zip(self.points) {
            let mut all = [0.0; 4];
            let mut first = 0;
            while first < self.waves.len() {
                let end = (first + BLOCK * V::WIDTH).min(self.waves.len());
                let block = self.waves.block::<V>(*place, first, end);
                all = [all[0] + block[0], all[1] + block[1], all[2] + block[2], all[3] + block[3]];
                first = end;
            }
            *point = Point { height: all[0], slope: [-all[1], -all[2]], acceleration: -all[3] };
        }
    }
}

impl WaveSums {
    /// Sums of `a cos`, `a k_x sin`, `a k_y sin` and `a omega^2 cos` over some waves.
    #[inline(always)]
    fn block<V: Vector>(&self, place: [f64; 2], first: usize, end: usize) -> [f64; 4] {
        let zero = Lanes::<V>::splat(0.0);
        let (mut height, mut x, mut y, mut acceleration) = (zero, zero, zero, zero);
        let mut at = first;
        while at < end {
            let phases = V::phases(&self.phase[at..], &self.turns[0][at..], &self.turns[1][at..], place);
            let (sin, cos) = Lanes(phases).sin_cos_turn();
            height = cos.mul_add(Lanes(V::load(&self.amplitude[at..])), height);
            x = sin.mul_add(Lanes(V::load(&self.slope[0][at..])), x);
            y = sin.mul_add(Lanes(V::load(&self.slope[1][at..])), y);
            acceleration = cos.mul_add(Lanes(V::load(&self.acceleration[at..])), acceleration);
            at += V::WIDTH;
        }
        [height.0.sum(), x.0.sum(), y.0.sum(), acceleration.0.sum()]
    }
}
