//! Statistics of f over draws that may carry weights: mean, spread, quantiles, and how far they can be trusted.

/// The levels of [`Statistics::quantiles`].
pub const QUANTILES: [f64; 4] = [0.05, 0.50, 0.95, 0.99];
/// Fewer effective draws than this leave a mean and its standard error unsettled.
pub const FEWEST_EFFECTIVE: f64 = 10.0;
/// Upper bounds hold with this confidence.
pub const CONFIDENCE: f64 = 0.95;
/// The normal deviate of [`CONFIDENCE`], one-sided.
const DEVIATE: f64 = 1.644_853_626_951_472_7;

/// Mean, spread and quantiles of f, 1/sr, over instances.
#[derive(Debug, Clone, PartialEq)]
pub struct Statistics {
    /// Mean.
    pub mean: f64,
    /// Standard deviation over N, not N - 1.
    pub std: f64,
    /// Standard error of the mean, std/sqrt(N) for draws without weights (an overestimate for Sobol draws); 0 for
    /// infinitely many, not a number for a single draw.
    pub sem: f64,
    /// Smallest; not a number for infinitely many.
    pub min: f64,
    /// Quantiles 0.05, 0.50, 0.95, 0.99, linear between neighbours.
    pub quantiles: [f64; 4],
    /// Largest; not a number for infinitely many.
    pub max: f64,
    /// Mean of f times the local cosine of the angle of reflection.
    pub mean_f_cos: f64,
    /// Share of instances in which the observer is obscured.
    pub obscured: f64,
    /// Share of instances in which the hit is a whitecap.
    pub whitecap: f64,
    /// Share of instances in which f exceeds each of the limits asked for.
    pub over: Vec<f64>,
    /// Effective number of draws that carry the mean, `(sum w f)^2/sum (w f)^2`: below [`FEWEST_EFFECTIVE`] neither the
    /// mean nor its standard error is settled. Not a number for infinitely many.
    pub effective: f64,
    /// Upper bound of the true mean with [`CONFIDENCE`]: `mean + 1.645 sem`, or where too few draws are effective,
    /// Hoeffding's bound by the largest f there can be; of a mean of 0 over N equal weights that is about 3/N of it.
    pub mean_upper: f64,
    /// Upper bounds of `over`, alike.
    pub over_upper: Vec<f64>,
    /// Relative error that the method itself may leave in the mean (and in the mean of f times the cosine); 0 for draws.
    pub mean_error: f64,
    /// Error in probability that the method itself may leave in the levels of quantiles, in `over` and in `obscured`; 0 for
    /// draws.
    pub share_error: f64,
}

/// One draw.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Draw {
    /// 1/sr.
    pub f: f64,
    /// 1 where all are equally likely.
    pub weight: f64,
}

/// The largest that a [`Draw`] can be.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Bounds {
    /// No weight is larger.
    pub weight: f64,
    /// No f is larger, 1/sr.
    pub f: f64,
}

impl Statistics {
    /// Statistics of at least one value of f, all of them equally likely, none of them above `largest`.
    pub(crate) fn of_values(values: Vec<f64>, limits: &[f64], largest: f64) -> Self {
        let draws = values.into_iter().map(|f| Draw { f, weight: 1.0 }).collect();
        Self::of(draws, limits, || Bounds { weight: 1.0, f: largest })
    }

    /// Statistics of at least one draw of f, with the bounds that are asked for where few draws count; of what is not f
    /// nothing is known.
    pub(crate) fn of(mut draws: Vec<Draw>, limits: &[f64], bounds: impl FnOnce() -> Bounds) -> Self {
        let n = draws.len() as f64;
        draws.sort_unstable_by(|a, b| a.f.total_cmp(&b.f));
        let (min, max) = (draws[0].f, draws[draws.len() - 1].f);
        // In units of the largest value: squares of next to nothing would be 0.
        let unit = power_of_two(max);
        let sum = |of: &dyn Fn(&Draw) -> f64| draws.iter().map(of).sum::<f64>();
        let mean = sum(&|d| d.weight * d.f) / n;
        let share = |of: &dyn Fn(&Draw) -> f64| {
            let square = sum(&|d| of(d) / unit * (of(d) / unit));
            if square > 0.0 { (n * mean / unit).powi(2) / square } else { 0.0 }
        };
        let effective = share(&|d| d.weight * d.f);
        let spread = |of: &dyn Fn(&Draw) -> f64| unit * (sum(of) / n).max(0.0).sqrt();
        let std = spread(&|d| d.weight * ((d.f - mean) / unit).powi(2));
        let sem =
            if n > 1.0 { spread(&|d| ((d.weight * d.f - mean) / unit).powi(2)) / n.sqrt() } else { f64::NAN };
        let total = sum(&|d| d.weight).max(f64::MIN_POSITIVE);
        let above = |limit: &f64| sum(&|d| if d.f > *limit { d.weight } else { 0.0 }) / total;
        let over: Vec<f64> = limits.iter().map(above).collect();
        let settled = effective >= FEWEST_EFFECTIVE && n > 1.0;
        let weighted = draws.iter().any(|d| d.weight != 1.0);
        let largest = if settled && (limits.is_empty() || !weighted) {
            Bounds { weight: 1.0, f: max }
        } else {
            bounds()
        };
        let top = largest.weight * largest.f.max(max);
        let mean_upper = if settled {
            mean + DEVIATE * sem
        } else {
            top * upper_bound(mean / top.max(f64::MIN_POSITIVE), n)
        };
        let over_upper =
            over.iter().map(|p| (largest.weight * upper_bound(p / largest.weight, n)).min(1.0)).collect();
        Self {
            mean,
            std,
            sem,
            min,
            quantiles: quantiles(&draws),
            max,
            mean_f_cos: f64::NAN,
            obscured: f64::NAN,
            whitecap: f64::NAN,
            over,
            effective,
            mean_upper,
            over_upper,
            mean_error: 0.0,
            share_error: 0.0,
        }
    }
}

/// The power of 2 at or below a number; 1 for 0.
fn power_of_two(x: f64) -> f64 {
    if x > 0.0 { f64::from_bits(x.max(f64::MIN_POSITIVE).to_bits() & f64::INFINITY.to_bits()) } else { 1.0 }
}

/// Hoeffding's upper bound, with [`CONFIDENCE`], of the expectation of a variable between 0 and 1 whose mean over n
/// draws is `mean`: the u above it with `n KL(mean, u) = -ln(1 - CONFIDENCE)`. For a mean of 0 it is that of Clopper
/// and Pearson, `1 - (1 - CONFIDENCE)^(1/n)`.
pub(crate) fn upper_bound(mean: f64, n: f64) -> f64 {
    let allowed = -(1.0 - CONFIDENCE).ln() / n;
    let mean = mean.clamp(0.0, 1.0);
    let term = |p: f64, q: f64| if p > 0.0 { p * (p / q).ln() } else { 0.0 };
    let divergence = |u: f64| term(mean, u) + term(1.0 - mean, 1.0 - u);
    let (mut low, mut high) = (mean, 1.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if divergence(middle) > allowed { high = middle } else { low = middle }
    }
    high
}

/// Quantiles of sorted draws, linear between neighbours: of equal weights those of N - 1 intervals.
fn quantiles(sorted: &[Draw]) -> [f64; 4] {
    let total: f64 = sorted.iter().map(|d| d.weight).sum();
    let end = total - 0.5 * (sorted[0].weight + sorted[sorted.len() - 1].weight);
    QUANTILES.map(|level| {
        let at = level * end;
        // The place of a draw: half its weight and all before it, counted from the middle of the first.
        let mut below = 0.0;
        for pair in sorted.windows(2) {
            let step = 0.5 * (pair[0].weight + pair[1].weight);
            if below + step > at {
                return pair[0].f + (at - below) / step * (pair[1].f - pair[0].f);
            }
            below += step;
        }
        sorted[sorted.len() - 1].f
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn draws(values: &[f64]) -> Vec<Draw> {
        values.iter().map(|f| Draw { f: *f, weight: 1.0 }).collect()
    }

    fn of(values: &[f64], largest: f64) -> Statistics {
        Statistics::of(draws(values), &[0.5], || Bounds { weight: 1.0, f: largest })
    }

    #[test]
    fn quantiles_lie_between_neighbours() {
        let [low, middle, _, high] = quantiles(&draws(&[1.0, 2.0, 4.0, 8.0, 16.0]));
        assert_eq!(middle, 4.0);
        assert!((low - 1.2).abs() < 1e-12 && (high - 15.68).abs() < 1e-12);
        assert_eq!(quantiles(&draws(&[3.0])), [3.0; 4]);
        // Twice the weight counts as much as two draws.
        let weighted = [Draw { f: 1.0, weight: 3.0 }, Draw { f: 9.0, weight: 1.0 }];
        assert_eq!(quantiles(&weighted)[1], 5.0);
    }

    /// A mean of next to nothing keeps its standard error, and a mean of nothing its upper bound.
    #[test]
    fn nothing_has_an_upper_bound() {
        let mut values = vec![0.0; 50];
        let zero = of(&values, 20.0);
        assert_eq!((zero.mean, zero.sem, zero.effective), (0.0, 0.0, 0.0));
        let expected = 1.0 - 0.05f64.powf(1.0 / 50.0);
        assert!((zero.mean_upper / (20.0 * expected) - 1.0).abs() < 1e-12, "{zero:?}");
        assert!((zero.over_upper[0] / expected - 1.0).abs() < 1e-12);
        values[7] = 1e-200;
        let faint = of(&values, 20.0);
        assert!((faint.sem / (1e-200 * 49f64.sqrt() / 50.0 / 50f64.sqrt()) - 1.0).abs() < 1e-12, "{faint:?}");
        assert!((faint.effective - 1.0).abs() < 1e-12 && faint.mean_upper > 1.0);
        assert!(of(&[0.3], 20.0).sem.is_nan());
    }

    /// The bound of a share of successes covers the true one as often as it says.
    #[test]
    fn bounds_hold() {
        let mut numbers = crate::surface::InstanceRng::new(crate::surface::Draws::Random, 5, 0);
        for p in [0.003, 0.03, 0.3, 0.9] {
            let mut held = 0;
            for _ in 0..2000 {
                let n = 100;
                let successes = (0..n).filter(|_| numbers.next() < p).count();
                held += usize::from(upper_bound(successes as f64 / f64::from(n), f64::from(n)) >= p);
            }
            assert!(held >= 1900 - 30, "{p}: {held} of 2000");
        }
        assert!(upper_bound(1.0, 5.0) == 1.0);
    }
}
