//! Nodes and weights: equal steps, which are best for what fades out at both ends, and Gauss and Legendre's for the rest.

/// Middles and widths of equal parts of an interval, none wider than `step`.
pub(crate) fn midpoints(start: f64, end: f64, step: f64) -> Vec<(f64, f64)> {
    let count = ((end - start) / step).ceil().max(1.0);
    let width = (end - start) / count;
    (0..count as usize).map(|i| (start + (i as f64 + 0.5) * width, width)).collect()
}

/// A rule for (-1, 1) on every one of equal parts of an interval, none wider than `width`.
pub(crate) fn panels(rule: &[(f64, f64)], start: f64, end: f64, width: f64) -> Vec<(f64, f64)> {
    let on = |(middle, width): (f64, f64)| {
        rule.iter().map(move |(x, weight)| (middle + 0.5 * width * x, 0.5 * width * weight))
    };
    midpoints(start, end, width).into_iter().flat_map(on).collect()
}

/// `count` nodes in (-1, 1) with their weights: exact for polynomials to the degree 2 count - 1.
pub(crate) fn gauss_legendre(count: usize) -> Vec<(f64, f64)> {
    let n = count as f64;
    (0..count)
        .map(|i| {
            let mut x = (std::f64::consts::PI * (i as f64 + 0.75) / (n + 0.5)).cos();
            let mut slope = 1.0;
            // Newton's iteration on the Legendre polynomial, from a start close enough to its root.
            for _ in 0..6 {
                let (mut p, mut before) = (x, 1.0);
                for k in 2..=count {
                    let k = k as f64;
                    (p, before) = (((2.0 * k - 1.0) * x * p - (k - 1.0) * before) / k, p);
                }
                slope = n * (x * p - before) / (x * x - 1.0);
                x -= p / slope;
            }
            (x, 2.0 / ((1.0 - x * x) * slope * slope))
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_for_polynomials() {
        for count in [2, 5, 24, 48] {
            for power in 0..2 * count {
                let sum: f64 = gauss_legendre(count).iter().map(|(x, w)| w * x.powi(power as i32)).sum();
                let expected = if power % 2 == 0 { 2.0 / (power as f64 + 1.0) } else { 0.0 };
                assert!((sum - expected).abs() < 1e-13, "{count} {power}: {sum}");
            }
        }
    }
}
