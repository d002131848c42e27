//! Which of the report's equations are taken as printed, where docs/model.md reads them otherwise.

use crate::error::Error;
use std::fmt::{Debug, Display, Formatter};
use std::ops::BitOr;
use std::str::FromStr;

/// The equations that are taken as printed; the others are read with the corrections of docs/model.md.
///
/// As text a set is `corrected`, `as_printed` or a list of equations, in any order:
///
/// ```
/// use prob_water::{Parameters, Readings};
///
/// let factor_and_angles: Readings = "71-73, 56".parse()?;
/// assert_eq!(factor_and_angles, Readings::EQ_56 | Readings::EQ_71_73);
/// assert_eq!(factor_and_angles.to_string(), "56, 71-73");
/// let water = Parameters { readings: factor_and_angles, ..Parameters::default() }.configure()?;
/// let refused = "57".parse::<Readings>().unwrap_err().to_string();
/// assert!(refused.starts_with("readings = 57 is unknown: allowed is corrected, 22, 43-45,"));
/// # Ok::<(), prob_water::Error>(())
/// ```
#[derive(Clone, Copy, PartialEq, Eq, Hash, Default)]
pub struct Readings(u16);

impl Readings {
    /// All with the corrections of docs/model.md.
    pub const CORRECTED: Self = Self(0);
    /// The largest wave number drawn: waves down to k2, however large the footprint.
    pub const EQ_22: Self = Self(1);
    /// The steepest slope by signed sums: obscuration is missed where they cancel.
    pub const EQ_43_45: Self = Self(1 << 1);
    /// The factor pi/4.
    pub const EQ_56: Self = Self(1 << 2);
    /// The index alone, without the extinction of absorbing water.
    pub const EQ_62: Self = Self(1 << 3);
    /// `sqrt(1 - cos theta)` for the sine. Without the bound on shadowing by the facets' own roughness.
    pub const EQ_65: Self = Self(1 << 4);
    /// `sqrt(pi) nu^2`. Without that bound as well.
    pub const EQ_66: Self = Self(1 << 5);
    /// The vertical for the wave's normal. No part of [`Readings::AS_PRINTED`]: the report says that the wave's index is
    /// implicit there.
    pub const EQ_70: Self = Self(1 << 6);
    /// Unsigned angles. Without the bound of steep facets.
    pub const EQ_71_73: Self = Self(1 << 7);
    /// The c21 term without the factor U.
    pub const EQ_78: Self = Self(1 << 8);
    /// `cos theta_i sin phi_r`.
    pub const EQ_82: Self = Self(1 << 9);
    /// Unsigned theta_r and phi_r.
    pub const EQ_88: Self = Self(1 << 10);
    /// The whole print.
    pub const AS_PRINTED: Self = Self(0b111_1011_1111);

    /// Every reading by itself, with the numbers of its equations, in the report's order.
    pub fn equations() -> impl Iterator<Item = (&'static str, Self)> {
        EQUATIONS.into_iter()
    }

    /// Whether all equations of another set are taken as printed.
    pub const fn contains(self, other: Self) -> bool {
        self.0 & other.0 == other.0
    }

    /// Whether any equation of another set is taken as printed.
    pub const fn intersects(self, other: Self) -> bool {
        self.0 & other.0 != 0
    }
}

impl BitOr for Readings {
    type Output = Self;

    fn bitor(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }
}

const CORRECTED: &str = "corrected";
const AS_PRINTED: &str = "as_printed";

/// Every reading by its equations, in the report's order.
const EQUATIONS: [(&str, Readings); 11] = [
    ("22", Readings::EQ_22),
    ("43-45", Readings::EQ_43_45),
    ("56", Readings::EQ_56),
    ("62", Readings::EQ_62),
    ("65", Readings::EQ_65),
    ("66", Readings::EQ_66),
    ("70", Readings::EQ_70),
    ("71-73", Readings::EQ_71_73),
    ("78", Readings::EQ_78),
    ("82", Readings::EQ_82),
    ("88", Readings::EQ_88),
];

impl Debug for Readings {
    fn fmt(&self, f: &mut Formatter<'_>) -> std::fmt::Result {
        write!(f, "Readings({self})")
    }
}

impl Display for Readings {
    fn fmt(&self, f: &mut Formatter<'_>) -> std::fmt::Result {
        match *self {
            Self::CORRECTED => f.write_str(CORRECTED),
            Self::AS_PRINTED => f.write_str(AS_PRINTED),
            _ => {
                let printed = EQUATIONS.iter().filter(|(_, reading)| self.contains(*reading));
                f.write_str(&printed.map(|(name, _)| *name).collect::<Vec<_>>().join(", "))
            }
        }
    }
}

impl FromStr for Readings {
    type Err = Error;

    fn from_str(text: &str) -> Result<Self, Error> {
        let text = text.trim();
        if text.eq_ignore_ascii_case(CORRECTED) {
            return Ok(Self::CORRECTED);
        }
        text.split(',').try_fold(Self::CORRECTED, |all, word| {
            let word = word.trim();
            let known = EQUATIONS.iter().find(|(name, _)| *name == word).map(|(_, reading)| *reading);
            let printed = word.eq_ignore_ascii_case(AS_PRINTED).then_some(Self::AS_PRINTED);
            known.or(printed).map(|reading| all | reading).ok_or_else(|| {
                let names: Vec<_> = EQUATIONS.iter().map(|(name, _)| *name).collect();
                Error::UnknownChoice {
                    parameter: "readings",
                    value: word.into(),
                    allowed: format!("{CORRECTED}, {}, {AS_PRINTED}", names.join(", ")),
                }
            })
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every set of readings is read from what it is written as, in whatever order and letters.
    #[test]
    fn texts_round_trip() {
        for bits in 0..1 << EQUATIONS.len() {
            let readings = Readings(bits);
            let text = readings.to_string();
            assert_eq!(text.parse(), Ok(readings), "{text}");
            let turned = text.rsplit(", ").collect::<Vec<_>>().join(" ,");
            assert_eq!(turned.to_uppercase().parse(), Ok(readings), "{turned}");
        }
        assert_eq!(EQUATIONS.iter().fold(0, |all, (_, r)| all ^ r.0), (1 << EQUATIONS.len()) - 1);
        assert_eq!("as_printed, 70".parse(), Ok(Readings::AS_PRINTED | Readings::EQ_70));
    }

    #[test]
    fn as_printed_is_all_but_70() {
        for (name, reading) in EQUATIONS {
            assert_eq!(Readings::AS_PRINTED.contains(reading), name != "70", "{name}");
            assert!(!Readings::CORRECTED.intersects(reading));
        }
    }

    #[test]
    fn unknown_equations_are_refused() {
        for text in ["", "57", "71", "56 66", "56,", "corrected, 56", "all", "56-66", "eq. 56"] {
            let error = text.parse::<Readings>().unwrap_err().to_string();
            assert!(error.contains("readings = ") && error.contains("43-45, 56, 62"), "{error}");
        }
    }
}
