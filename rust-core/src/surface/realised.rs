//! A realised surface: heights, slopes, normals and accelerations of a drawn sea at a time (Eqs. 31, 38-42, 52), and
//! the bounds by which a ray is cast onto it.

use super::component::Component;
use crate::numeric::trigonometry::{LANES, sin_cos};
use crate::sea::spectrum::share;
use std::f64::consts::TAU;

/// A drawn sea at one time: a sum of cosines, kept by property so that the sums vectorise. Metres and seconds. The
/// arrays are filled up to whole lanes with waves of amplitude 0.
#[derive(Debug, Clone, Default)]
pub struct Surface {
    /// k cos phi, rad/m.
    k_x: Vec<[f64; LANES]>,
    /// k sin phi, rad/m.
    k_y: Vec<[f64; LANES]>,
    /// psi at time 0, radians.
    psi: Vec<[f64; LANES]>,
    /// psi + omega t, radians, within a turn.
    phase: Vec<[f64; LANES]>,
    /// a, m.
    amplitude: Vec<[f64; LANES]>,
    /// omega, rad/s.
    frequency: Vec<[f64; LANES]>,
    /// k, rad/m.
    wave_number: Vec<[f64; LANES]>,
    /// No crest is higher (Eq. 42), m.
    highest: f64,
    /// s.
    time: f64,
}

/// The surface over a place.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Point {
    /// eta, m (Eq. 38).
    pub height: f64,
    /// Derivatives of eta by x and y (Eqs. 39-40).
    pub slope: [f64; 2],
    /// Second derivative of eta by time, m/s^2 (Eq. 52).
    pub acceleration: f64,
}

impl Point {
    /// The unit normal (Eq. 41).
    pub fn normal(&self) -> [f64; 3] {
        normal(self.slope)
    }
}

/// The unit normal of a surface with a slope (Eq. 41).
pub fn normal([sx, sy]: [f64; 2]) -> [f64; 3] {
    let z = 1.0 / (1.0 + sx * sx + sy * sy).sqrt();
    [-sx * z, -sy * z, z]
}

impl Surface {
    /// The sum of some components at a time in s.
    pub fn new(components: impl Iterator<Item = Component>, time: f64) -> Self {
        let mut surface = Self::default();
        surface.draw(components);
        surface.set_time(time);
        surface
    }

    /// Replaces the components, keeping the memory; the time is to be set afterwards.
    pub fn draw(&mut self, components: impl Iterator<Item = Component>) {
        for array in self.arrays() {
            array.clear();
        }
        let mut highest = 0.0;
        for (j, c) in components.enumerate() {
            let lane = j % LANES;
            if lane == 0 {
                for array in self.arrays() {
                    array.push([0.0; LANES]);
                }
            }
            let at = j / LANES;
            let (sin, cos) = c.azimuth.sin_cos();
            self.k_x[at][lane] = c.wave_number * cos;
            self.k_y[at][lane] = c.wave_number * sin;
            self.psi[at][lane] = c.phase;
            self.amplitude[at][lane] = c.amplitude;
            self.frequency[at][lane] = c.frequency;
            self.wave_number[at][lane] = c.wave_number;
            highest += c.amplitude;
        }
        self.highest = highest;
    }

    /// What the components are kept in.
    fn arrays(&mut self) -> [&mut Vec<[f64; LANES]>; 6] {
        [
            &mut self.k_x,
            &mut self.k_y,
            &mut self.psi,
            &mut self.amplitude,
            &mut self.frequency,
            &mut self.wave_number,
        ]
    }

    /// Moves the waves to a time in s.
    pub fn set_time(&mut self, time: f64) {
        self.time = time;
        self.phase.clear();
        self.phase.extend(
            self.psi
                .iter()
                .zip(&self.frequency)
                .map(|(psi, omega)| std::array::from_fn(|l| (psi[l] + omega[l] * time) % TAU)),
        );
    }

    /// Every wave's amplitude, m, phase over the origin, radians, wave numbers along x and y, rad/m, and frequency, rad/s.
    pub(crate) fn waves(&self) -> impl Iterator<Item = [f64; 5]> {
        (0..self.amplitude.len() * LANES).map(|wave| {
            let (at, l) = (wave / LANES, wave % LANES);
            [&self.amplitude, &self.phase, &self.k_x, &self.k_y, &self.frequency].map(|array| array[at][l])
        })
    }

    /// The time of the waves, s.
    pub fn time(&self) -> f64 {
        self.time
    }

    /// No crest is higher and no trough deeper, m (Eq. 42).
    pub fn highest(&self) -> f64 {
        self.highest
    }

    /// No slope is steeper: the sum of a k (Eqs. 43-45, as bounds).
    pub fn steepest(&self) -> f64 {
        let lanes = self.k_x.iter().zip(&self.k_y).zip(&self.amplitude);
        lanes.flat_map(|((kx, ky), a)| (0..LANES).map(move |l| a[l] * kx[l].hypot(ky[l]))).sum()
    }

    /// Eqs. 43-45 as printed: sums with their signs, which cancel. Slopes may be steeper.
    pub fn signed_steepest(&self) -> f64 {
        let along = |k: &[[f64; LANES]]| -> f64 {
            let lanes = k.iter().zip(&self.amplitude);
            lanes.flat_map(|(k, a)| (0..LANES).map(move |l| a[l] * k[l])).sum()
        };
        along(&self.k_x).hypot(along(&self.k_y))
    }

    /// The phase functions (Eq. 31) over a place in m, lane by lane.
    fn phases(&self, [x, y]: [f64; 2], lanes: usize) -> [f64; LANES] {
        let (kx, ky, phase) = (&self.k_x[lanes], &self.k_y[lanes], &self.phase[lanes]);
        std::array::from_fn(|l| phase[l] + kx[l] * x + ky[l] * y)
    }

    /// Height over a place in m.
    pub fn height(&self, place: [f64; 2]) -> f64 {
        let mut height = 0.0;
        for (lanes, a) in self.amplitude.iter().enumerate() {
            let (_, cos) = sin_cos(self.phases(place, lanes));
            height += sum(std::array::from_fn(|l| a[l] * cos[l]));
        }
        height
    }

    /// Everything over a place in m.
    pub fn point(&self, place: [f64; 2]) -> Point {
        self.total(place, |lanes| self.amplitude[lanes])
    }

    /// Vertical acceleration (Eq. 52), m/s^2, over a place in m, so many seconds before the surface's time.
    pub fn acceleration_before(&self, before: f64, place: [f64; 2]) -> f64 {
        self.past_acceleration(before, place, |lanes| self.amplitude[lanes])
    }

    /// The same without the waves that are too short for a footprint in m ([`share`]).
    pub fn acceleration_before_within(&self, before: f64, place: [f64; 2], footprint: f64) -> f64 {
        self.past_acceleration(before, place, self.within(footprint))
    }

    /// The same without the waves that are too short for a footprint in m ([`share`]).
    pub fn point_within(&self, place: [f64; 2], footprint: f64) -> Point {
        self.total(place, self.within(footprint))
    }

    /// Amplitudes, m, of what a footprint in m leaves of the waves, by lanes.
    #[inline(always)]
    fn within(&self, footprint: f64) -> impl Fn(usize) -> [f64; LANES] {
        move |lanes| {
            let (a, k) = (&self.amplitude[lanes], &self.wave_number[lanes]);
            std::array::from_fn(|l| if a[l] > 0.0 { a[l] * share(k[l], footprint).sqrt() } else { 0.0 })
        }
    }

    /// The mean of everything under a Gaussian weight about a place in m, which has these variances along x and y and this
    /// covariance in m^2.
    pub(crate) fn mean(&self, place: [f64; 2], covariance: [f64; 3]) -> Point {
        self.total(place, |lanes| {
            let (a, kx, ky) = (&self.amplitude[lanes], &self.k_x[lanes], &self.k_y[lanes]);
            std::array::from_fn(|l| a[l] * mean_of_wave(covariance, [kx[l], ky[l]]))
        })
    }

    /// The waves with these amplitudes, m, by lanes.
    #[inline(always)]
    fn total(&self, place: [f64; 2], amplitudes: impl Fn(usize) -> [f64; LANES]) -> Point {
        let mut point = Point::default();
        for lanes in 0..self.amplitude.len() {
            let a = amplitudes(lanes);
            let (sin, cos) = sin_cos(self.phases(place, lanes));
            let (kx, ky, omega) = (&self.k_x[lanes], &self.k_y[lanes], &self.frequency[lanes]);
            point.height += sum(std::array::from_fn(|l| a[l] * cos[l]));
            point.slope[0] -= sum(std::array::from_fn(|l| a[l] * kx[l] * sin[l]));
            point.slope[1] -= sum(std::array::from_fn(|l| a[l] * ky[l] * sin[l]));
            point.acceleration -= sum(std::array::from_fn(|l| a[l] * omega[l] * omega[l] * cos[l]));
        }
        point
    }

    /// The acceleration of the waves with these amplitudes, m, by lanes.
    #[inline(always)]
    fn past_acceleration(
        &self,
        before: f64,
        place: [f64; 2],
        amplitudes: impl Fn(usize) -> [f64; LANES],
    ) -> f64 {
        let mut acceleration = 0.0;
        for lanes in 0..self.amplitude.len() {
            let (a, omega, phase) = (amplitudes(lanes), &self.frequency[lanes], self.phases(place, lanes));
            let (_, cos) = sin_cos(std::array::from_fn(|l| phase[l] - omega[l] * before));
            acceleration -= sum(std::array::from_fn(|l| a[l] * omega[l] * omega[l] * cos[l]));
        }
        acceleration
    }

    /// The waves as met along a line over a place in m: for every lane amplitude, phase at the start and wave number
    /// along the unit (or shorter) horizontal `direction`, rad/m.
    pub(crate) fn along(
        &self,
        place: [f64; 2],
        direction: [f64; 2],
    ) -> impl Iterator<Item = [[f64; LANES]; 3]> {
        self.amplitude.iter().enumerate().map(move |(lanes, a)| {
            let (kx, ky) = (&self.k_x[lanes], &self.k_y[lanes]);
            let k = std::array::from_fn(|l| kx[l] * direction[0] + ky[l] * direction[1]);
            [*a, self.phases(place, lanes), k]
        })
    }
}

/// The Fourier transform of a Gaussian with these variances along x and y and this covariance in m^2, at wave numbers in rad/m:
/// what its mean leaves of a wave.
pub(crate) fn mean_of_wave([xx, yy, xy]: [f64; 3], [kx, ky]: [f64; 2]) -> f64 {
    (-0.5 * (xx * kx * kx + yy * ky * ky) - xy * kx * ky).exp()
}

/// Sum of the lanes, in a fixed order.
pub(crate) fn sum(lanes: [f64; LANES]) -> f64 {
    (lanes[0] + lanes[1]) + (lanes[2] + lanes[3])
}
