//! A root between two numbers.

/// First number at which `beyond` holds, between `low` where it does not and `high` where it does.
pub(crate) fn bisect(mut low: f64, mut high: f64, beyond: impl Fn(f64) -> bool) -> f64 {
    loop {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            return high;
        }
        if beyond(middle) { high = middle } else { low = middle }
    }
}
