//! The onset of whitecaps on waves that are drawn, so that on average they cover Eq. 51's fraction of the sea.
//!
//! Where waves break depends on the acceleration of all waves (Eqs. 53-54), and drawn ones are a part of them that D and M
//! decide about. A Gaussian acceleration of the whole sea has the standard deviation s for which Eqs. 53-54 come to Eq.
//! 51's fraction; what is missing from the drawn waves' variance is a Gaussian of the waves that are not drawn.
//! Drawn ones may have more than s, and are not Gaussian: so a shift of all accelerations makes the mean over the drawn
//! waves' distribution, known by its characteristic function, Eq. 51's fraction.

use super::characteristic::{Component, bessel};
use crate::config::Water;
use crate::numeric::root::bisect;
use crate::sea::whitecap::{Onset, WhitecapOnset, deviation};
use crate::surface::{Component as Wave, Waves};
use std::f64::consts::PI;

/// Fractions below this have no whitecaps.
const RAREST: f64 = 1e-7;
/// The whole sea's acceleration is that of this fraction at most: towards a half it would pass all bounds.
const MOST: f64 = 0.4;
/// Of the whole sea's standard deviation so much is not drawn at least: probabilities stay smooth where drawn waves have it all.
const LEAST_RESIDUAL: f64 = 0.02;
/// What a mean over accelerations needs.
const CALIBRATION: Resolution = Resolution { end: 10.0, highest: 40.0, negligible: 1e-10 };

/// How finely accelerations are resolved.
pub(crate) struct Resolution {
    /// Accelerations reach to so many standard deviations.
    pub end: f64,
    /// Frequencies reach to so many over the standard deviation,
    pub highest: f64,
    /// or to where the characteristic function is this small.
    pub negligible: f64,
}

/// The vertical acceleration of drawn waves, m/s^2: it is even.
pub(crate) struct Acceleration<F> {
    /// Its variance.
    pub variance: f64,
    /// It is never larger.
    pub bound: f64,
    /// Its characteristic function.
    pub characteristic: F,
}

/// The acceleration of a sum of waves that are drawn already, over places and times.
pub(crate) fn accelerations(waves: &[Wave]) -> Acceleration<impl Fn(&[f64]) -> Vec<f64>> {
    let amplitudes: Vec<f64> = waves.iter().map(|c| c.amplitude * c.frequency * c.frequency).collect();
    Acceleration {
        variance: waves.iter().map(Wave::acceleration_variance).sum(),
        bound: amplitudes.iter().sum(),
        characteristic: move |frequencies: &[f64]| {
            frequencies.iter().map(|r| amplitudes.iter().map(|a| bessel(a * r)).product()).collect()
        },
    }
}

/// Of a level sea.
fn none() -> Acceleration<impl Fn(&[f64]) -> Vec<f64>> {
    Acceleration {
        variance: 0.0,
        bound: 0.0,
        characteristic: |frequencies: &[f64]| vec![1.0; frequencies.len()],
    }
}

/// Amplitudes of the acceleration of a swell's waves, m/s^2, of what a footprint in m leaves of them.
fn swell_accelerations(waves: &Waves, footprint: f64) -> Vec<f64> {
    let amplitude = |c: Wave| c.amplitude * c.frequency.powi(2);
    waves.swell_nodes().map(|c| amplitude(c.seen_at(footprint))).collect()
}

/// The acceleration of a sum of as many waves.
pub(crate) fn sum_of_accelerations(
    component: &Component,
    count: f64,
) -> Acceleration<impl Fn(&[f64]) -> Vec<f64>> {
    Acceleration {
        variance: component.variances(count)[2],
        bound: component.bounds(count)[2],
        characteristic: move |frequencies: &[f64]| {
            let mut values = component.acceleration(frequencies);
            values.iter_mut().for_each(|c| *c = c.powi(count as i32));
            values
        },
    }
}

impl Water {
    /// The onset of whitecaps on drawn waves ([`Water::waves`]); `None` where there are none.
    pub fn whitecap_onset(&self) -> Option<Onset<f64>> {
        let waves = self.waves();
        self.onset_on(Component::new(&waves).as_ref(), &swell_accelerations(&waves, 0.0))
    }

    /// The same on waves that fade ([`Water::fading_waves`]), where the footprint in m is this one.
    pub fn fading_whitecap_onset(&self, footprint: f64) -> Option<Onset<f64>> {
        let waves = self.fading_waves();
        let component = Component::fading(&waves, footprint);
        self.onset_on(component.as_ref(), &swell_accelerations(&waves, footprint))
    }

    /// The same on the sum of as many waves as are drawn and of a swell's with these amplitudes; of none the sea is level.
    pub(crate) fn onset_on(&self, component: Option<&Component>, swell: &[f64]) -> Option<Onset<f64>> {
        let count = f64::from(self.parameters.components);
        match component.filter(|component| component.variances(count)[2] > 0.0) {
            Some(component) => self.onset_of(&sum_of_accelerations(component, count).beside(swell, count)),
            None => self.onset_of(&none().beside(swell, count)),
        }
    }

    /// The same on waves with an acceleration.
    pub(crate) fn onset_of<F: Fn(&[f64]) -> Vec<f64>>(&self, drawn: &Acceleration<F>) -> Option<Onset<f64>> {
        let (w, reading) = (self.wind.friction_velocity, self.parameters.whitecap_onset);
        if !self.parameters.whitecaps {
            return None;
        }
        if reading != WhitecapOnset::Calibrated {
            return Some(Onset::new(w, reading));
        }
        let fraction = self.whitecap_fraction;
        (fraction >= RAREST).then(|| drawn.calibrated(w, fraction))
    }
}

impl<F: Fn(&[f64]) -> Vec<f64>> Acceleration<F> {
    /// That of these waves and of so many of a swell, whose amplitudes in m/s^2 are one of these, all equally probable; none: no swell.
    fn beside<'a>(
        self,
        swell: &'a [f64],
        count: f64,
    ) -> Acceleration<impl Fn(&[f64]) -> Vec<f64> + use<'a, F>> {
        let nodes = swell.len().max(1) as f64;
        let one = move |r: f64| swell.iter().map(|a| bessel(a * r)).sum::<f64>() / nodes;
        Acceleration {
            variance: self.variance + count * swell.iter().map(|a| 0.5 * a * a).sum::<f64>() / nodes,
            bound: self.bound + count * swell.iter().copied().fold(0.0, f64::max),
            characteristic: move |frequencies: &[f64]| {
                let mut values = (self.characteristic)(frequencies);
                if !swell.is_empty() {
                    values.iter_mut().zip(frequencies).for_each(|(c, r)| *c *= one(*r).powi(count as i32));
                }
                values
            },
        }
    }

    /// The onset whose mean is a fraction, at a friction velocity in cm/s.
    fn calibrated(&self, friction_velocity: f64, fraction: f64) -> Onset<f64> {
        let all = deviation(friction_velocity, fraction.min(MOST));
        let residual = (all * all - self.variance).max((LEAST_RESIDUAL * all).powi(2)).sqrt();
        let onset = Onset::with_residual(friction_velocity, residual);
        let (frequencies, values) = self.spectrum(onset.residual(), &CALIBRATION);
        // A shift by so much moves all accelerations past both ends.
        let [sure, none] = onset.ends();
        let reach = PI / frequencies[1] + sure.abs().max(none.abs());
        let few = |shift: f64| {
            let weights = weights(&onset.shifted(shift), &frequencies);
            weights.iter().zip(&values).map(|(w, c)| w * c).sum::<f64>() <= fraction
        };
        onset.shifted(bisect(-reach, reach, few))
    }

    /// Frequencies at equal steps from 0, and the characteristic function there; as many as are needed beside a Gaussian of
    /// a standard deviation.
    pub fn spectrum(&self, residual: f64, resolution: &Resolution) -> (Vec<f64>, Vec<f64>) {
        let Resolution { end, highest, negligible } = *resolution;
        let sigma = self.variance.sqrt().hypot(residual);
        let apart = PI / (1.05 * (end * sigma).min(self.bound + end * residual));
        let mut frequencies: Vec<f64> =
            (0..).map(|n| f64::from(n) * apart).take_while(|r| *r < highest / sigma).collect();
        let mut values = (self.characteristic)(&frequencies);
        let size = values.iter().zip(&frequencies).map(|(c, r)| c.abs() * gauss(residual * r));
        let used = size.collect::<Vec<_>>().iter().rposition(|c| *c > negligible).unwrap_or(0) + 2;
        frequencies.truncate(used);
        values.truncate(used);
        (frequencies, values)
    }
}

/// Weights of the cosines, at these equally spaced frequencies from 0, of the even part of an onset's probability over one
/// period of the first frequency after 0.
pub(crate) fn weights(onset: &Onset<f64>, frequencies: &[f64]) -> Vec<f64> {
    let mut weights = falling(onset.ends(), frequencies);
    weights.iter_mut().zip(frequencies).for_each(|(w, r)| *w *= gauss(onset.residual() * r));
    weights
}

/// The characteristic function of a Gaussian of variance 1.
fn gauss(r: f64) -> f64 {
    (-0.5 * r * r).exp()
}

/// Weights of the cosines, at these equally spaced frequencies from 0, of the even part of a function that falls
/// linearly from 1 at `ends[0]` to 0 at `ends[1]`, over one period of the first frequency after 0.
fn falling(ends: [f64; 2], frequencies: &[f64]) -> Vec<f64> {
    // A mean over steps from 1 to 0, at places evenly spread between the ends; one beyond the period is 1 or 0 all over.
    let half_period = PI / frequencies[1];
    let [a, b] = ends.map(|x| x.clamp(-half_period, half_period));
    let middle = 0.5 * (a + b);
    let width = ends[1] - ends[0];
    let inside = if width > 0.0 { (b - a) / width } else { f64::from(a.abs() < half_period) };
    let beyond = if width > 0.0 {
        (ends[1] - ends[0].max(half_period)).max(0.0) / width
    } else {
        f64::from(a >= half_period)
    };
    let weight = |r: &f64| {
        if *r == 0.0 {
            return beyond + inside * 0.5 * (1.0 + middle / half_period);
        }
        // The mean of sin(r x) over [a, b].
        let spread = 0.5 * r * (b - a);
        let narrow = if spread.abs() < 1e-6 { 1.0 } else { spread.sin() / spread };
        inside * narrow * (r * middle).sin() / (r * half_period)
    };
    frequencies.iter().map(weight).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::{Parameters, Surface};
    use crate::sea::Wind;
    use crate::surface::{Draws, InstanceRng};
    use std::f64::consts::TAU;

    /// On waves that are drawn already, as a mesh has them, whitecaps cover the fraction over all phases.
    #[test]
    fn drawn_waves_have_the_fraction_over_their_phases() {
        for (w, footprint, components) in
            [(24.0, 0.3, 5), (40.0, 0.05, 5), (56.0, 0.02, 20), (62.9, 0.15, 100)]
        {
            let sea = Parameters {
                wind: Wind::FrictionVelocity(w),
                surface: Surface::Instance,
                footprint: Some(footprint),
                components,
                ..Parameters::default()
            };
            let water = sea.configure().unwrap();
            let waves: Vec<_> = water.waves().components(InstanceRng::new(Draws::Stratified, 3, 0)).collect();
            let onset = water.onset_of(&accelerations(&waves)).unwrap();
            let mut numbers = InstanceRng::new(Draws::Random, 5, 1);
            let count = 4_000_000 / waves.len();
            let (mut sum, mut square) = (0.0, 0.0);
            for _ in 0..count {
                let a: f64 = waves
                    .iter()
                    .map(|c| c.amplitude * c.frequency.powi(2) * (TAU * numbers.next()).cos())
                    .sum();
                let p = onset.probability(a);
                sum += p;
                square += p * p;
            }
            let mean = sum / count as f64;
            let error =
                ((square / count as f64 - mean * mean) / count as f64).sqrt() / water.whitecap_fraction;
            let ratio = mean / water.whitecap_fraction;
            println!("w* {w} D {footprint} M {components}: {ratio:.4} +- {error:.4}");
            assert!(
                (ratio - 1.0).abs() < 0.005 + 4.0 * error && error < 0.06,
                "w* {w} D {footprint}: {ratio} +- {error}"
            );
        }
    }

    #[test]
    fn falling_is_its_cosine_series() {
        let frequencies: Vec<f64> = (0..4000).map(|i| f64::from(i) * 0.5).collect();
        for ends in [[-3.0, -1.5], [-3.0, -3.0], [-2.0, 1.0], [-9.0, 3.0], [-20.0, -5.0], [-8.0, 11.0]] {
            let weights = falling(ends, &frequencies);
            for x in [-5.0, -2.5, -1.7, 0.3, 0.9, 2.2, 5.5] {
                let at = |x: f64| {
                    if x <= ends[0] {
                        1.0
                    } else if x >= ends[1] {
                        0.0
                    } else {
                        (ends[1] - x) / (ends[1] - ends[0])
                    }
                };
                let series: f64 = frequencies.iter().zip(&weights).map(|(r, w)| w * (r * x).cos()).sum();
                assert!((series - 0.5 * (at(x) + at(-x))).abs() < 1e-3, "{ends:?} {x}: {series}");
            }
        }
    }
}
