//! The characteristic function of the slope and the acceleration of one drawn wave at a point.
//!
//! The components are drawn independently and alike, so the characteristic function of their sum is that of one to the
//! power M. One component with a uniform phase has the slope `a k sin(Psi) e_phi` and the vertical acceleration
//! `-a omega^2 cos(Psi)`; its characteristic function is the mean of `J0(sqrt((a k q.e_phi)^2 + (a omega^2 r)^2))` over
//! the draws of k and phi. The amplitude is a function of k times the root of F(phi), so that mean is taken over k
//! once, for a table, and over phi for every (q, r): F and `(q.e_phi)^2` have the period pi of the azimuths drawn, and
//! equal weights at equal distances converge as fast as anything. Where F depends on k too, every azimuth has a table.
//!
//! Everything is even in both slopes (upwind and crosswind) and in the acceleration.

use crate::numeric::quadrature::{gauss_legendre, panels};
use crate::surface::{Component as Wave, Waves};
use rayon::prelude::*;
use std::f64::consts::{FRAC_PI_2, PI};
use std::sync::LazyLock;

/// Nodes in ln k for every piece of the spectrum, and azimuths of a half turn.
const WAVE_NUMBERS: usize = 16;
const AZIMUTHS: usize = 32;

/// Rare whitecaps need digits of the acceleration alone: its table has steps shorter by this.
const FINER: f64 = 0.4;

/// Draws of one component.
#[derive(Debug, Clone)]
pub(crate) struct Component {
    /// Share, slope amplitude over sqrt(F), and acceleration amplitude over sqrt(F) in m/s^2, of wave numbers.
    wave_numbers: Vec<[f64; 3]>,
    /// cos and sin from the wind's azimuth, and sqrt(F), of the first wave number.
    azimuths: Vec<[f64; 3]>,
    /// sqrt(F) of every wave number over the first's: a row for each azimuth to one side of the wind, or one for all where F is
    /// the same for all wave numbers.
    relative: Vec<Vec<f64>>,
    /// Of one component: slope upwind, slope crosswind, acceleration.
    variances: [f64; 3],
    /// No component has more: slope upwind, slope crosswind, acceleration.
    bounds: [f64; 3],
}

/// Variances of a drawn sea: slope upwind, crosswind, acceleration in m^2/s^4.
pub(crate) fn variances(waves: &Waves) -> [f64; 3] {
    let count = waves.components as f64;
    let wind = Component::new(waves).map_or([0.0; 3], |component| component.variances(count));
    // The swell's as if it all came from one direction.
    let nodes = waves.swell_nodes().count().max(1) as f64;
    waves.swell_nodes().fold(wind, |[upwind, crosswind, acceleration], wave| {
        let (sin, cos) = (wave.azimuth - waves.wind_azimuth).sin_cos();
        let [slope, accelerations] =
            [wave.slope_variance(), wave.acceleration_variance()].map(|v| count * v / nodes);
        [upwind + slope * cos * cos, crosswind + slope * sin * sin, acceleration + accelerations]
    })
}

/// No drawn sea is steeper.
pub(crate) fn steepest(waves: &Waves) -> f64 {
    let count = waves.components as f64;
    let wind = Component::new(waves).map_or(0.0, |component| {
        let [upwind, crosswind, _] = component.bounds(count);
        upwind.hypot(crosswind)
    });
    let swell = waves
        .swell
        .map_or(0.0, |swell| swell.amplitude(waves.components) * swell.wave_number(swell.frequency(1.0)));
    wind + count * swell
}

impl Component {
    /// `None` where there are no waves.
    pub fn new(waves: &Waves) -> Option<Self> {
        Self::seen(waves, &[], |wave| wave)
    }

    /// Of waves that fade, where the footprint in m is this one.
    pub fn fading(waves: &Waves, footprint: f64) -> Option<Self> {
        let starts = [-0.5f64, 0.5].map(|octave| 0.01 * PI / footprint * octave.exp2());
        Self::seen(waves, &starts, |wave| wave.seen_at(footprint))
    }

    /// With amplitudes that change, smoothly but for some wave numbers in rad/cm.
    fn seen(waves: &Waves, kinks: &[f64], seen: impl Fn(Wave) -> Wave) -> Option<Self> {
        let [low, high] = waves.log_range?;
        let rule = gauss_legendre(WAVE_NUMBERS);
        let spectrum = &waves.spectrum;
        let (mut wave_numbers, mut nodes) = (vec![], vec![]);
        let mut pieces = spectrum.pieces(low.exp(), high.exp());
        pieces.extend(kinks.iter().filter(|k| (low.exp()..high.exp()).contains(*k)));
        pieces.sort_unstable_by(f64::total_cmp);
        for piece in pieces.windows(2) {
            let (start, end) = (piece[0].ln(), piece[1].ln());
            wave_numbers.extend(panels(&rule, start, end, end - start).into_iter().map(|(log_k, width)| {
                nodes.push(log_k.exp());
                let component = seen(waves.component(log_k.exp(), 0.0, waves.wind_azimuth));
                let amplitude = component.amplitude / spectrum.spreading(log_k.exp(), 0.0).sqrt();
                let acceleration = amplitude * component.frequency.powi(2);
                [width / (high - low), amplitude * component.wave_number, acceleration]
            }));
        }
        let angle = |i: usize| PI * ((i as f64 + 0.5) / AZIMUTHS as f64) - FRAC_PI_2;
        let root = |k: f64, i: usize| spectrum.spreading(k, angle(i)).sqrt();
        let azimuths: Vec<_> =
            (0..AZIMUTHS).map(|i| [angle(i).cos(), angle(i).sin(), root(nodes[0], i)]).collect();
        let rows = if spectrum.spreads_alike() { 1 } else { AZIMUTHS / 2 };
        let relative: Vec<Vec<f64>> =
            (0..rows).map(|i| nodes.iter().map(|k| root(*k, i) / azimuths[i][2]).collect()).collect();
        let mut component = Self { wave_numbers, azimuths, relative, variances: [0.0; 3], bounds: [0.0; 3] };
        component.sum();
        Some(component)
    }

    /// Fills in variances and bounds.
    fn sum(&mut self) {
        type Factor = fn(&[f64; 3]) -> f64;
        let of: [(usize, Factor); 3] =
            [(1, |[c, _, f]| (c * f).abs()), (1, |[_, s, f]| (s * f).abs()), (2, |[_, _, f]| *f)];
        for (m, (amplitude, factor)) in of.into_iter().enumerate() {
            for row in 0..self.relative.len() {
                let energy: f64 = self.nodes(row).map(|n| n[0] * n[amplitude] * n[amplitude]).sum();
                let most = self.nodes(row).map(|n| n[amplitude]).fold(0.0, f64::max);
                let azimuths = self.azimuths.iter().enumerate().filter(|(i, _)| self.row(*i) == row);
                let (mut share, mut widest) = (0.0, 0.0f64);
                for (_, azimuth) in azimuths {
                    share += factor(azimuth).powi(2);
                    widest = widest.max(factor(azimuth));
                }
                self.variances[m] += 0.5 * energy * (share / AZIMUTHS as f64);
                self.bounds[m] = self.bounds[m].max(most * widest);
            }
        }
    }

    /// The row of an azimuth.
    fn row(&self, azimuth: usize) -> usize {
        azimuth.min(AZIMUTHS - 1 - azimuth).min(self.relative.len() - 1)
    }

    /// Share and amplitudes, as [`Component::wave_numbers`], at the azimuths of a row.
    fn nodes(&self, row: usize) -> impl Iterator<Item = [f64; 3]> {
        let with = |([share, slope, acceleration], relative): (&[f64; 3], &f64)| {
            [*share, slope * relative, acceleration * relative]
        };
        self.wave_numbers.iter().zip(&self.relative[row]).map(with)
    }

    /// Variances of a sum of `count`: slope upwind, crosswind, acceleration in m^2/s^4.
    pub fn variances(&self, count: f64) -> [f64; 3] {
        self.variances.map(|v| count * v)
    }

    /// Bounds of a sum of `count`.
    pub fn bounds(&self, count: f64) -> [f64; 3] {
        self.bounds.map(|b| count * b)
    }

    /// Characteristic function of the slope at the products of these frequencies upwind and crosswind, row by row.
    pub fn slope(&self, upwind: &[f64], crosswind: &[f64]) -> Vec<f64> {
        let end = self.reach(upwind, crosswind);
        let tables =
            self.tables(|row| Table::new(end, self.finest(row, 1), |x| self.mean(row, |n| bessel(n[1] * x))));
        let mut values = Vec::with_capacity(upwind.len() * crosswind.len());
        for u in upwind {
            for c in crosswind {
                let of = |(i, [cos, sin, f]): (usize, &[f64; 3])| {
                    tables[self.row(i)].at(f * (u * cos + c * sin).abs())
                };
                values.push(self.azimuths.iter().enumerate().map(of).sum::<f64>() / AZIMUTHS as f64);
            }
        }
        values
    }

    /// Characteristic function of the acceleration at these frequencies.
    pub fn acceleration(&self, frequencies: &[f64]) -> Vec<f64> {
        let widest = self.azimuths.iter().map(|a| a[2]).fold(0.0, f64::max);
        let end = widest * frequencies.iter().fold(0.0, |a: f64, b| a.max(*b));
        let tables = self.tables(|row| {
            Table::new(end, FINER * self.finest(row, 2), |y| self.mean(row, |n| bessel(n[2] * y)))
        });
        let of = |r: &f64| {
            let of = |(i, a): (usize, &[f64; 3])| tables[self.row(i)].at(a[2] * r);
            self.azimuths.iter().enumerate().map(of).sum::<f64>() / AZIMUTHS as f64
        };
        frequencies.iter().map(of).collect()
    }

    /// Characteristic function of slope and acceleration: for every pair as in [`Component::slope`] a row over
    /// the frequencies of the acceleration.
    pub fn slope_and_acceleration(
        &self,
        upwind: &[f64],
        crosswind: &[f64],
        acceleration: &[f64],
    ) -> Vec<f64> {
        let end = self.reach(upwind, crosswind);
        // Azimuths to both sides of the wind share a table for every frequency of the acceleration.
        let half = &self.azimuths[..AZIMUTHS / 2];
        let pairs: Vec<_> = half
            .iter()
            .enumerate()
            .flat_map(|(i, a)| acceleration.iter().map(move |r| (i, a[2] * r)))
            .collect();
        let table = |(azimuth, y): (usize, f64)| {
            let row = self.row(azimuth);
            Table::new(end, self.finest(row, 1), |x| {
                self.mean(row, |n| bessel((n[1] * x * n[1] * x + n[2] * y * n[2] * y).sqrt()))
            })
        };
        let tables: Vec<Table> = pairs.into_par_iter().map(table).collect();
        let row = |(u, c): (&f64, &f64)| {
            let mut values = vec![0.0; acceleration.len()];
            for (tables, [cos, sin, f]) in tables.chunks(acceleration.len()).zip(half) {
                for x in [f * (u * cos + c * sin).abs(), f * (u * cos - c * sin).abs()] {
                    for (value, table) in values.iter_mut().zip(tables) {
                        *value += table.at(x) / AZIMUTHS as f64;
                    }
                }
            }
            values
        };
        let pairs: Vec<_> = upwind.iter().flat_map(|u| crosswind.iter().map(move |c| (u, c))).collect();
        pairs.into_par_iter().flat_map_iter(row).collect()
    }

    /// A table for every row.
    fn tables(&self, of: impl Fn(usize) -> Table + Sync + Send) -> Vec<Table> {
        (0..self.relative.len()).into_par_iter().map(of).collect()
    }

    /// The mean over wave numbers at the azimuths of a row.
    fn mean(&self, row: usize, of: impl Fn([f64; 3]) -> f64) -> f64 {
        self.nodes(row).map(|n| n[0] * of(n)).sum()
    }

    /// The largest argument that these frequencies need.
    fn reach(&self, upwind: &[f64], crosswind: &[f64]) -> f64 {
        let largest = |of: &[f64]| of.iter().fold(0.0, |a: f64, b| a.max(*b));
        let (u, c) = (largest(upwind), largest(crosswind));
        self.azimuths.iter().map(|[cos, sin, f]| f * (u * cos.abs() + c * sin.abs())).fold(0.0, f64::max)
    }

    /// A step of a row's table that resolves the Bessel function of the largest amplitude.
    fn finest(&self, row: usize, of: usize) -> f64 {
        0.25 / self.nodes(row).map(|n| n[of]).fold(0.0, f64::max)
    }
}

/// An even function at equal steps from 0, with interpolation by polynomials of the fifth degree.
struct Table {
    per_step: f64,
    values: Vec<f64>,
}

impl Table {
    fn new(end: f64, step: f64, of: impl Fn(f64) -> f64) -> Self {
        // Two values before 0, where the function is even, and three after the end.
        let count = (end / step) as usize + 7;
        Self { per_step: 1.0 / step, values: (0..count).map(|i| of((i as f64 - 2.0).abs() * step)).collect() }
    }

    #[inline]
    fn at(&self, x: f64) -> f64 {
        let x = x * self.per_step;
        let i = x as usize;
        let v = &self.values[i..i + 6];
        quintic(x - i as f64).iter().zip(v).map(|(weight, value)| weight * value).sum()
    }
}

/// Lagrange's weights of the values at -2, -1, 0, 1, 2 and 3.
#[inline]
fn quintic(x: f64) -> [f64; 6] {
    let (a, b, c, d, e, f) = (x + 2.0, x + 1.0, x, x - 1.0, x - 2.0, x - 3.0);
    let (ab, ef, cd) = (a * b, e * f, c * d);
    [
        -b * cd * ef / 120.0,
        a * cd * ef / 24.0,
        -ab * d * ef / 12.0,
        ab * c * ef / 12.0,
        -ab * cd * f / 24.0,
        ab * cd * e / 120.0,
    ]
}

/// J0 of a number not below 0, to 1e-7: a table, beyond it the leading asymptotic terms.
pub(super) fn bessel(x: f64) -> f64 {
    static J0: LazyLock<Table> = LazyLock::new(|| Table::new(64.0, 0.125, libm::j0));
    if x < 64.0 {
        return J0.at(x);
    }
    let phase = x - 0.25 * PI;
    (2.0 / (PI * x)).sqrt() * (phase.cos() + phase.sin() / (8.0 * x))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sea::SpectrumModel;
    use crate::surface::{Draws, InstanceRng};

    /// Variances of slope and acceleration against sums over 100,000 wave numbers, with fetch, depth and every form of
    /// the spectrum.
    #[test]
    fn variances_are_the_spectrums() {
        for (w, footprint) in
            [(2.0, 0.05), (8.0, 0.15), (24.0, 0.15), (56.0, 0.15), (120.0, 0.02), (238.0, 0.05)]
        {
            let places = [(f64::INFINITY, f64::INFINITY), (300.0, 4.0), (800.0, 0.2), (5e3, 1e3), (5e4, 1e3)];
            let models = [
                SpectrumModel::Report,
                SpectrumModel::Jonswap,
                SpectrumModel::Tma,
                SpectrumModel::Elfouhaily,
            ];
            for (spectrum, (fetch, depth)) in models.into_iter().flat_map(|m| places.map(|place| (m, place)))
            {
                let short = matches!(spectrum, SpectrumModel::Jonswap | SpectrumModel::Tma);
                if short && fetch.is_infinite() {
                    continue;
                }
                let waves = crate::config::Parameters {
                    spectrum,
                    wind: crate::sea::Wind::FrictionVelocity(w),
                    footprint: Some(footprint),
                    fetch,
                    depth,
                    ..crate::config::Parameters::default()
                }
                .configure()
                .unwrap()
                .waves();
                if waves.is_empty() {
                    continue;
                }
                let found = Component::new(&waves).unwrap().variances;
                let [low, high] = waves.log_range.unwrap();
                let n = 100_000;
                let mut sums = [0.0; 2];
                for i in 0..n {
                    let k = (low + (high - low) * (f64::from(i) + 0.5) / f64::from(n)).exp();
                    let c = waves.component(k, 0.0, waves.wind_azimuth);
                    let energy = c.amplitude.powi(2) / waves.spectrum.spreading(k, 0.0) / f64::from(n);
                    sums[0] += energy * c.wave_number.powi(2);
                    sums[1] += energy * c.frequency.powi(4);
                }
                // F has the mean 1/pi over the azimuths drawn.
                for (found, sum) in [(found[0] + found[1], sums[0]), (found[2], sums[1])] {
                    let off = found / (0.5 * sum / PI) - 1.0;
                    assert!(
                        off.abs() < 1e-4,
                        "{spectrum:?} w* {w} D {footprint} fetch {fetch} depth {depth}: {off:e}"
                    );
                }
            }
        }
    }

    /// Where F depends on k: the characteristic functions against means over a million drawn waves, within 5 standard errors.
    #[test]
    fn follows_drawn_waves() {
        let parameters = crate::config::Parameters {
            spectrum: SpectrumModel::Elfouhaily,
            wind: crate::sea::Wind::FrictionVelocity(24.0),
            footprint: Some(0.05),
            components: 1,
            ..crate::config::Parameters::default()
        };
        let waves = parameters.configure().unwrap().waves();
        let component = Component::new(&waves).unwrap();
        let (upwind, crosswind, acceleration) = ([0.0, 8.0, 25.0], [0.0, 10.0], [0.0, 0.4]);
        let slope = component.slope(&upwind, &crosswind);
        let both = component.slope_and_acceleration(&upwind, &crosswind, &acceleration);
        let along = component.acceleration(&acceleration);
        let count = 1_000_000;
        let mut sums = vec![0.0; both.len()];
        for instance in 0..count {
            let mut numbers = InstanceRng::new(Draws::Random, 4, instance);
            numbers.next();
            let point = waves.surface(numbers, 0.0).point([0.0; 2]);
            let mut row = sums.iter_mut();
            for q in upwind.iter().flat_map(|u| crosswind.map(|c| u * point.slope[0] + c * point.slope[1])) {
                for r in acceleration {
                    *row.next().unwrap() += (q + r * point.acceleration).cos();
                }
            }
        }
        let error = 5.0 / (count as f64).sqrt();
        for (m, sum) in sums.iter().enumerate() {
            let (mean, expected) = (sum / count as f64, both[m]);
            assert!((mean - expected).abs() < error, "{m}: {mean} {expected}");
            if m % 2 == 0 {
                assert!((slope[m / 2] - expected).abs() < 1e-6, "{m}: {} {expected}", slope[m / 2]);
            }
        }
        assert!((along[1] - both[1]).abs() < 1e-6 && both.iter().any(|c| *c < 0.9));
    }

    #[test]
    fn bessel_follows_libm() {
        for i in 0..20_000 {
            let x = f64::from(i) * 0.01;
            assert!((bessel(x) - libm::j0(x)).abs() < if x < 64.0 { 1e-8 } else { 2e-6 }, "{x}");
        }
    }
}
