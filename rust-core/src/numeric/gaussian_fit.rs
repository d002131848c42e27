//! Least squares of `height exp(-((x - center)/width)^2)`, the form of Eq. 90.

use glam::{DMat3, DVec3};

/// A fitted Gaussian.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Gaussian {
    /// Its largest value.
    pub height: f64,
    /// Where that is.
    pub center: f64,
    /// Half width where it is 1/e of that.
    pub width: f64,
}

impl Gaussian {
    /// The value at x.
    pub fn at(&self, x: f64) -> f64 {
        self.height * (-((x - self.center) / self.width).powi(2)).exp()
    }

    /// The best Gaussian for values at places, by Levenberg's and Marquardt's iteration from their moments. `None` where
    /// there is no peak within the places, as for values that are 0.
    pub fn fit(places: &[f64], values: &[f64]) -> Option<Self> {
        const ITERATIONS: usize = 60;
        let range = places.last()? - places.first()?;
        let total: f64 = values.iter().sum();
        let height = values.iter().copied().fold(0.0, f64::max);
        if !(total > 0.0 && total.is_finite() && range > 0.0) {
            return None;
        }
        let moment =
            |f: &dyn Fn(f64) -> f64| places.iter().zip(values).map(|(x, y)| f(*x) * y).sum::<f64>() / total;
        let center = moment(&|x| x);
        let width = (2.0 * moment(&|x| (x - center).powi(2))).sqrt().max(0.5 * range / places.len() as f64);
        let mut best = Self { height, center, width };
        let error = |g: &Self| places.iter().zip(values).map(|(x, y)| (y - g.at(*x)).powi(2)).sum::<f64>();
        let (mut least, mut damping) = (error(&best), 1e-3);
        for _ in 0..ITERATIONS {
            // Normal equations, in parameters relative to their size.
            let (mut square, mut slope) = (DMat3::ZERO, DVec3::ZERO);
            for (x, y) in places.iter().zip(values) {
                let value = best.at(*x);
                let t = (x - best.center) / best.width;
                let gradient = DVec3::new(value, 2.0 * t * value, 2.0 * t * t * value);
                square +=
                    DMat3::from_cols(gradient * gradient.x, gradient * gradient.y, gradient * gradient.z);
                slope += gradient * (y - value);
            }
            let mut damped = square;
            damped.x_axis.x *= 1.0 + damping;
            damped.y_axis.y *= 1.0 + damping;
            damped.z_axis.z *= 1.0 + damping;
            let step = damped.inverse() * slope;
            let next = Self {
                height: best.height * (1.0 + step.x),
                center: best.center + best.width * step.y,
                width: best.width * (1.0 + step.z),
            };
            let found = if step.is_finite() && next.width > 0.0 { error(&next) } else { f64::INFINITY };
            if found <= least {
                let gain = least - found;
                (best, least, damping) = (next, found, damping * 0.2);
                if gain <= 1e-14 * least || step.length() < 1e-10 {
                    break;
                }
            } else {
                damping *= 10.0;
                if damping > 1e12 {
                    break;
                }
            }
        }
        let within = (places[0]..=*places.last()?).contains(&best.center) && best.width < 4.0 * range;
        (within && best.height > 0.0).then_some(best)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn recovers_what_it_was_given() {
        let places: Vec<f64> = (-40..=40).map(|i| f64::from(i) * 0.02).collect();
        for (height, center, width) in
            [(1.0, 0.0, 0.2), (3e-4, 0.31, 0.07), (50.0, -0.5, 0.5), (1.0, 0.013, 0.01)]
        {
            let truth = Gaussian { height, center, width };
            let values: Vec<f64> = places.iter().map(|x| truth.at(*x)).collect();
            let found = Gaussian::fit(&places, &values).unwrap();
            assert!((found.height / height - 1.0).abs() < 1e-6, "{found:?}");
            assert!((found.center - center).abs() < 1e-6 * width && (found.width / width - 1.0).abs() < 1e-6);
        }
    }

    #[test]
    fn no_peak_no_fit() {
        let places = [0.0, 0.1, 0.2, 0.3];
        assert_eq!(Gaussian::fit(&places, &[0.0; 4]), None);
        assert_eq!(Gaussian::fit(&places, &[0.0, 0.0, 1.0, f64::INFINITY]), None);
        assert_eq!(Gaussian::fit(&[], &[]), None);
        // Rising to the end: the peak is not among the places.
        assert_eq!(Gaussian::fit(&places, &[1.0, 2.0, 4.0, 8.0]), None);
    }

    /// Noise of a percent moves the width by about as much.
    #[test]
    fn stands_noise() {
        let places: Vec<f64> = (-30..=30).map(|i| f64::from(i) * 0.02).collect();
        let truth = Gaussian { height: 1.0, center: 0.05, width: 0.2 };
        let noise = |i: usize| 0.01 * ((i * 7919 % 101) as f64 / 50.0 - 1.0);
        let values: Vec<f64> = places.iter().enumerate().map(|(i, x)| truth.at(*x) + noise(i)).collect();
        let found = Gaussian::fit(&places, &values).unwrap();
        assert!((found.width / 0.2 - 1.0).abs() < 0.02 && (found.center - 0.05).abs() < 0.005, "{found:?}");
    }
}
