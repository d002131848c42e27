//! Wind speed with height and the Beaufort scale: Eqs. 1-2 and Table 1.

use crate::error::{Error, refuse};
use crate::numeric::root::bisect;

/// End of Table 1: the largest wind speed at 10 m, m/s.
pub const WIND_SPEED_END: f64 = 36.0;
/// End of Table 1: the largest friction velocity, cm/s.
pub const FRICTION_VELOCITY_END: f64 = 238.65;
/// Lowest and highest anemometer, m.
pub const WIND_HEIGHTS: [f64; 2] = [0.1, 100.0];
/// Friction velocity of Beaufort 0 to 12, cm/s: section 3 of the report to 6, Table 1's nominal values from 7.
pub const BEAUFORT_FRICTION_VELOCITY: [f64; 13] =
    [2.0, 4.0, 8.0, 16.0, 24.0, 40.0, 56.0, 72.31, 95.66, 120.98, 152.42, 186.67, 223.89];

const VON_KARMAN: f64 = 0.4;

/// A row of the report's Table 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BeaufortRow {
    /// Name of the wind.
    pub description: &'static str,
    /// Wind speed at 10 m: low, high, nominal, m/s.
    pub wind_speed: [f64; 3],
    /// Friction velocity: low, high, nominal, cm/s.
    pub friction_velocity: [f64; 3],
}

const fn row(description: &'static str, w: [f64; 3], u: [f64; 3]) -> BeaufortRow {
    BeaufortRow { description, wind_speed: w, friction_velocity: u }
}

/// Table 1, Beaufort 0 to 12, as printed.
pub const TABLE_1: [BeaufortRow; 13] = [
    row("Calm", [0.0, 0.5, 0.25], [0.0, 2.40, 1.31]),
    row("Light air", [0.5, 1.5, 1.0], [2.40, 6.24, 4.40]),
    row("Light breeze", [2.0, 3.0, 2.5], [7.98, 11.20, 9.62]),
    row("Gentle breeze", [4.0, 5.0, 4.5], [14.18, 17.08, 15.62]),
    row("Moderate breeze", [6.0, 8.0, 7.0], [20.23, 28.80, 24.08]),
    row("Fresh breeze", [9.0, 11.0, 10.0], [34.02, 45.10, 39.47]),
    row("Strong breeze", [11.0, 14.0, 12.5], [45.10, 62.90, 53.83]),
    row("Near gale", [14.0, 17.0, 15.5], [62.90, 82.08, 72.31]),
    row("Gale", [17.0, 21.0, 19.0], [82.08, 109.88, 95.66]),
    row("Severe gale", [21.0, 24.0, 22.5], [109.88, 132.45, 120.98]),
    row("Storm", [25.0, 28.0, 26.5], [140.31, 164.93, 152.42]),
    row("Violent storm", [29.0, 32.0, 30.5], [173.49, 200.26, 186.67]),
    row("Hurricane", [33.0, 36.0, 34.5], [209.57, 238.65, 223.89]),
];

/// How the wind is given.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Wind {
    /// Wind speed at a height above the mean surface.
    Speed {
        /// m/s
        speed: f64,
        /// m
        height: f64,
    },
    /// Friction velocity, cm/s.
    FrictionVelocity(f64),
    /// Beaufort number.
    Beaufort(u8),
}

/// The wind as the model uses it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WindProfile {
    /// w*, cm/s; 0 is calm.
    pub friction_velocity: f64,
    /// m/s at 10 m.
    pub w10: f64,
    /// m/s at 12.5 m.
    pub w12_5: f64,
    /// m/s at 19.5 m.
    pub w19_5: f64,
}

/// Roughness height h0 in cm (Eq. 2) of a friction velocity in cm/s; infinite for 0.
pub fn roughness_height(friction_velocity: f64) -> f64 {
    0.684 / friction_velocity + 4.28e-5 * friction_velocity * friction_velocity - 0.0443
}

/// Wind speed in m/s at a height in m (Eq. 1) of a friction velocity in cm/s. Where the roughness
/// height exceeds `height` (w* < 7e-4 cm/s at 10 m) Eq. 1 turns negative; that is calm, 0.
pub fn wind_speed(friction_velocity: f64, height: f64) -> f64 {
    if friction_velocity <= 0.0 {
        return 0.0;
    }
    let ratio = 100.0 * height / roughness_height(friction_velocity);
    (friction_velocity / VON_KARMAN * ratio.ln() / 100.0).max(0.0)
}

/// Friction velocity in cm/s of a wind speed in m/s at a height in m: the inverse of Eqs. 1-2,
/// bisected to the last bit. `None` beyond the end of Table 1. Calm, 0, for no wind.
pub fn friction_velocity(speed: f64, height: f64) -> Option<f64> {
    if speed == 0.0 {
        return Some(0.0);
    }
    if !(speed > 0.0 && speed <= highest_wind_speed(height)) {
        return None;
    }
    Some(bisect(calm_end(height), rising_end(height), |w| wind_speed(w, height) >= speed))
}

/// The wind speed in m/s at a height in m with which Table 1 ends: 36 m/s at 10 m.
pub fn highest_wind_speed(height: f64) -> f64 {
    wind_speed(rising_end(height), height)
}

/// A friction velocity at which Eq. 1 is not yet positive.
fn calm_end(height: f64) -> f64 {
    0.5 * 0.684 / (100.0 * height + 0.0443)
}

/// The friction velocity up to which the wind speed rises, at most the end of Table 1: close to the
/// water Eq. 1 falls again at high wind, and the root lies before its maximum.
fn rising_end(height: f64) -> f64 {
    let slope = |w: f64| {
        let h0 = roughness_height(w);
        (100.0 * height / h0).ln() - (8.56e-5 * w * w - 0.684 / w) / h0
    };
    // 36 m/s and 238.65 cm/s are the same to the printed digits: the larger one is the end.
    let end = bisect(FRICTION_VELOCITY_END - 0.01, FRICTION_VELOCITY_END + 0.01, |w| {
        wind_speed(w, 10.0) >= WIND_SPEED_END
    });
    if slope(end) < 0.0 { bisect(calm_end(height), end, |w| slope(w) < 0.0) } else { end }
}

/// Refuses a number outside of its parameter's own range, whatever the others are: of a wind speed the range at the greatest
/// height. `shown` is the value as it was given.
pub(crate) fn check(parameter: &'static str, x: f64, shown: impl ToString) -> Result<(), Error> {
    let [lowest, highest] = WIND_HEIGHTS;
    let (holds, allowed) = match parameter {
        "wind_speed" => {
            let [end, farthest] = [10.0, highest].map(highest_wind_speed);
            let allowed =
                format!("0 to {end:.2} m/s at 10 m, {farthest:.2} m/s at {highest} m, the end of Table 1");
            ((0.0..=farthest).contains(&x), allowed)
        }
        "wind_height" => ((lowest..=highest).contains(&x), "0.1 to 100 m".into()),
        "friction_velocity" => {
            ((0.0..=FRICTION_VELOCITY_END).contains(&x), "0 to 238.65 cm/s, the end of Table 1".into())
        }
        "beaufort" => ((0.0..=12.0).contains(&x) && x.fract() == 0.0, "a whole number from 0 to 12".into()),
        _ => unreachable!("{parameter} has no range"),
    };
    if holds { Ok(()) } else { refuse(parameter, shown, allowed) }
}

impl Wind {
    /// The wind at every height.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] with the parameter, its value and what is allowed.
    pub fn profile(self) -> Result<WindProfile, Error> {
        let w = match self {
            Wind::Speed { speed, height } => {
                check("wind_height", height, height)?;
                match friction_velocity(speed, height) {
                    Some(w) => w,
                    None => {
                        let end = highest_wind_speed(height);
                        let allowed = format!("0 to {end:.2} m/s at {height} m, the end of Table 1");
                        return refuse("wind_speed", speed, allowed);
                    }
                }
            }
            Wind::FrictionVelocity(w) => {
                check("friction_velocity", w, w)?;
                w.abs() // -0 is a calm like 0
            }
            Wind::Beaufort(number) => {
                check("beaufort", f64::from(number), number)?;
                BEAUFORT_FRICTION_VELOCITY[usize::from(number)]
            }
        };
        Ok(WindProfile {
            friction_velocity: w,
            w10: wind_speed(w, 10.0),
            w12_5: wind_speed(w, 12.5),
            w19_5: wind_speed(w, 19.5),
        })
    }
}

impl WindProfile {
    /// Roughness height, cm (Eq. 2); infinite in a calm.
    pub fn roughness_height(&self) -> f64 {
        roughness_height(self.friction_velocity)
    }

    /// The Beaufort number whose Table 1 range of w10 holds this wind; where the ranges leave a
    /// gap, the one whose end is nearest.
    pub fn beaufort(&self) -> usize {
        let distance =
            |r: &BeaufortRow| (r.wind_speed[0] - self.w10).max(self.w10 - r.wind_speed[1]).max(0.0);
        let mut best = 0;
        for (i, row) in TABLE_1.iter().enumerate() {
            if distance(row) < distance(&TABLE_1[best]) {
                best = i;
            }
        }
        best
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The inverse reproduces all 33 distinct values of Table 1 to its printed digits.
    #[test]
    fn table_1() {
        let mut seen = std::collections::BTreeSet::new();
        for row in TABLE_1 {
            for (speed, printed) in row.wind_speed.into_iter().zip(row.friction_velocity) {
                let w = friction_velocity(speed, 10.0).unwrap();
                assert!((w - printed).abs() < 0.00501, "{speed} m/s: {w} against {printed}");
                if speed > 0.0 {
                    seen.insert((speed * 100.0) as i64);
                }
            }
        }
        assert_eq!(seen.len(), 33);
    }

    #[test]
    fn inverse_is_exact_at_every_height() {
        for height in [0.1, 0.5, 2.0, 10.0, 12.5, 19.5, 100.0] {
            let mut inverted = 0;
            for i in 1..400 {
                let w = f64::from(i) * 0.59;
                let speed = wind_speed(w, height);
                // Below the maximum of Eq. 1 near the water the inverse returns where it came from.
                if wind_speed(w * 1.001, height) > speed && speed > 0.0 {
                    let back = friction_velocity(speed, height).unwrap();
                    assert!((back / w - 1.0).abs() < 1e-12, "{w} at {height} m: {back}");
                    inverted += 1;
                }
            }
            // At 0.1 m Eq. 1 has a maximum at w* = 175.
            assert!(inverted > if height < 0.5 { 290 } else { 398 }, "{inverted} at {height} m");
        }
    }

    #[test]
    fn calm_and_the_end() {
        assert_eq!(Wind::Speed { speed: 0.0, height: 10.0 }.profile().unwrap().w10, 0.0);
        assert_eq!(Wind::FrictionVelocity(1e-4).profile().unwrap().w10, 0.0);
        assert!(friction_velocity(WIND_SPEED_END, 10.0).is_some());
        assert!(friction_velocity(36.01, 10.0).is_none());
        assert!(Wind::FrictionVelocity(FRICTION_VELOCITY_END).profile().is_ok());
        for bad in [-1.0, f64::NAN, f64::INFINITY] {
            assert!(Wind::Speed { speed: bad, height: 10.0 }.profile().is_err());
            assert!(Wind::FrictionVelocity(bad).profile().is_err());
        }
        assert!(Wind::Beaufort(13).profile().is_err());
    }

    #[test]
    fn beaufort_of_the_nominal_winds() {
        for (number, row) in TABLE_1.iter().enumerate() {
            let wind = Wind::Speed { speed: row.wind_speed[2], height: 10.0 };
            assert_eq!(wind.profile().unwrap().beaufort(), number);
        }
    }
}
