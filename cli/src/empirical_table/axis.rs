//! Lists of numbers as flags: `FIRST:LAST:COUNT`, or the numbers themselves, separated by commas.

use prob_water::table::geometric;

/// How a flag's help calls them.
pub const VALUE: &str = "FIRST:LAST:COUNT or LIST";
/// More from one flag is a slip.
const MOST: u32 = 1000;

/// The numbers, with the text that gave them.
#[derive(Clone)]
pub struct Axis {
    /// As given.
    pub text: String,
    /// In the order given.
    pub values: Vec<f64>,
}

/// Evenly from the first to the last.
pub fn even(text: &str) -> Result<Axis, String> {
    parse(text, |first, last, count| {
        let step = (last - first) / f64::from(count - 1);
        (0..count).map(|k| if k + 1 == count { last } else { first + step * f64::from(k) }).collect()
    })
}

/// Each by the same factor larger.
pub fn even_in_logarithm(text: &str) -> Result<Axis, String> {
    parse(text, geometric)
}

fn parse(text: &str, between: impl Fn(f64, f64, u32) -> Vec<f64>) -> Result<Axis, String> {
    let number = |text: &str| match text.trim().parse::<f64>() {
        Ok(x) if x.is_finite() => Ok(x),
        _ => Err(format!("\"{text}\" is not a finite number")),
    };
    let values = match text.split(':').collect::<Vec<_>>()[..] {
        [list] => list.split(',').map(number).collect::<Result<_, _>>()?,
        [first, last, count] => {
            let whole = count.trim().parse().ok().filter(|n| (2..=MOST).contains(n));
            let count =
                whole.ok_or(format!("COUNT = {count}: allowed is a whole number from 2 to {MOST}"))?;
            between(number(first)?, number(last)?, count)
        }
        _ => return Err("expected FIRST:LAST:COUNT or numbers separated by commas".into()),
    };
    Ok(Axis { text: text.into(), values })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ends_are_met() {
        assert_eq!(even("0:180:9").unwrap().values[3], 67.5);
        assert_eq!(even("-0.3:0.6:4").unwrap().values[3], 0.6);
        assert_eq!(even("1, -2.5").unwrap().values, [1.0, -2.5]);
        assert_eq!(even_in_logarithm("1:100:3").unwrap().values, [1.0, 10.0, 100.0]);
        for wrong in ["", "1:2", "1:2:1", "1:2:1001", "1:2:2.5", "a:2:3", "1,,2", "nan", "1:inf:3", "1:2:3:4"]
        {
            assert!(even(wrong).is_err(), "{wrong}");
        }
    }
}
