//! Foam that outlives the crest that made it: a whitecap's lifetime.
//!
//! Foam decays exponentially once its wave has broken (Monahan and Zietlow, J. Geophys. Res. 74, 6961, 1969: with 3.85 s in
//! salt water, 2.54 s in fresh). With the probability p of a whitecap by the acceleration a alone (Eqs. 53-54), that of foam
//! with the lifetime tau is the mean of p over the past,
//!
//! `q(t) = integral over s from 0 to infinity of p(a(t - s)) exp(-s/tau) ds/tau`, or `dq/dt = (p - q)/tau`.
//!
//! Waves are stationary: over all seas q has the mean of p. It changes by at most 1/tau in a second, and what stood at a time
//! is left after dt with a probability of at least exp(-dt/tau).
//!
//! Of p the middles of equal steps of time are known, counted from time 0 and not from t: so q is exact for a p that is
//! constant in every step, and has all these properties.

use std::f64::consts::TAU;

/// Steps in the period of the shortest waves: p is the function of a sum of waves that it follows.
const STEPS: f64 = 16.0;
/// What is older has less than this share of the mean, and is left out.
const FORGOTTEN: f64 = 1e-4;

/// The past of a whitecap.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Foam {
    /// tau, s.
    lifetime: f64,
    /// s.
    step: f64,
}

impl Foam {
    /// Foam with a lifetime in s on waves whose highest angular frequency is this, rad/s; `None` where the past does not matter:
    /// without a lifetime, or on level water.
    pub fn new(lifetime: f64, highest_frequency: f64) -> Option<Self> {
        let matters = lifetime > 0.0 && highest_frequency > 0.0;
        matters.then(|| Self { lifetime, step: TAU / (STEPS * highest_frequency) })
    }

    /// For a time in s, how many seconds before it p counts, and its weight there, from the latest on. Weights have the sum 1. The
    /// middle of the step that goes on may come after the time.
    pub fn past(&self, time: f64) -> impl Iterator<Item = [f64; 2]> + use<> {
        let Self { lifetime, step } = *self;
        let elapsed = time - (time / step).floor() * step;
        let count = (-FORGOTTEN.ln() * lifetime / step).ceil() as u64;
        // The shares of the mean that are later than the starts of steps.
        let since = move |start: f64| -(-start / lifetime).exp_m1();
        let all = since(elapsed + count as f64 * step);
        (0..=count).map(move |n| {
            let start = elapsed + n as f64 * step;
            [start - 0.5 * step, (since(start) - since((start - step).max(0.0))) / all]
        })
    }

    /// q at a time in s, for p so many seconds before.
    pub fn mean(&self, time: f64, mut p: impl FnMut(f64) -> f64) -> f64 {
        self.past(time).map(|[before, weight]| weight * p(before)).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Weights are those of the exponential: their sum is 1, and their mean age the lifetime.
    #[test]
    fn weights_are_the_exponentials() {
        for (lifetime, frequency) in [(0.05, 40.0), (2.54, 14.0), (3.85, 14.0), (3.85, 0.5), (60.0, 3.0)] {
            let foam = Foam::new(lifetime, frequency).unwrap();
            for time in [-7.3, 0.0, 0.01, 12.345, 1e6] {
                let sum = foam.mean(time, |_| 1.0);
                assert!((sum - 1.0).abs() < 1e-12, "{sum}");
                assert!(foam.past(time).all(|[before, weight]| weight >= 0.0 && before >= -0.5 * foam.step));
                let age = foam.mean(time, |before| before);
                // The step's middle is not its own mean: off by up to a step's half, and in the mean over phases not at all.
                assert!(
                    (age - lifetime).abs() < 2e-3 * lifetime + 0.5 * foam.step,
                    "{lifetime} {frequency}: {age}"
                );
            }
        }
        assert_eq!(Foam::new(0.0, 10.0), None);
        assert_eq!(Foam::new(3.85, 0.0), None);
    }

    /// Of `p = 1/2 + 1/2 cos(omega t)` the mean is known: `1/2 + 1/2 Re exp(i omega t)/(1 + i omega tau)`. It is found to a sixth of
    /// the squared angle of a step, of its size: an eighth by the step that goes on, a 24th by all others.
    #[test]
    fn a_cosine_is_low_passed() {
        const HIGHEST: f64 = 14.0;
        for lifetime in [0.3, 3.85] {
            let foam = Foam::new(lifetime, HIGHEST).unwrap();
            for frequency in [HIGHEST, 0.25 * HIGHEST] {
                let (x, allowed) = (frequency * lifetime, (frequency * foam.step).powi(2) / 6.0);
                for n in 0..100 {
                    let time = 0.037 * f64::from(n);
                    let found = foam.mean(time, |before| 0.5 + 0.5 * (frequency * (time - before)).cos());
                    let (sin, cos) = (frequency * time).sin_cos();
                    let expected = 0.5 + 0.5 * (cos + x * sin) / (1.0 + x * x);
                    let size = 0.5 / x.hypot(1.0);
                    assert!(
                        (found - expected).abs() < allowed * size + 2.0 * FORGOTTEN,
                        "{found} {expected}"
                    );
                }
            }
        }
    }

    /// A whitecap that stands on and off: q rises towards 1 and falls exponentially, by at most dt/tau in dt.
    #[test]
    fn foam_decays_with_its_lifetime() {
        let foam = Foam::new(3.85, 14.0).unwrap();
        // Breaks for a second, from a start of a step on.
        let start = 100.0 * foam.step;
        let at =
            |time: f64| foam.mean(time, |before| f64::from((start..start + 1.0).contains(&(time - before))));
        let dt = 0.01;
        let mut last = at(start - 1.0);
        for n in 1..1000 {
            let time = start - 1.0 + f64::from(n) * dt;
            let now = at(time);
            assert!((now - last).abs() <= dt / 3.85 + 2.0 * FORGOTTEN, "{time}");
            last = now;
        }
        let [a, b] = [at(start + 2.0), at(start + 4.0)];
        assert!((b / a - (-2.0f64 / 3.85).exp()).abs() < 1e-3, "{a} {b}");
    }
}
