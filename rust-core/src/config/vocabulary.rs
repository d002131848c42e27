//! The one vocabulary of parameters: scene files, flags, C, Python and Rust all use these names.

use super::parameters::{
    Average, DRAWN, FootprintMeasure, Hiding, LONGEST_TIME, MOST_COMPONENTS, MOST_INSTANCES, OffPlaneModel,
    Parameters, SEEDS, Surface, Water,
};
use super::slope_split::SlopeBudget;
use crate::brdf::fresnel::WAVELENGTHS;
use crate::brdf::{Fresnel, SlopeMeasure, SlopeStatistics};
use crate::error::{Error, refuse};
use crate::sea::whitecap::WhitecapOnset;
use crate::sea::{Salinity, SpectrumModel, Wind, wind};

/// A parameter: what documentation and help show of it, and how it is read and written.
#[derive(Debug, Clone, Copy)]
pub struct Entry {
    /// Name, with underscores.
    pub name: &'static str,
    /// Unit, empty for none.
    pub unit: &'static str,
    /// Default, as text.
    pub default: &'static str,
    /// What is allowed, in the words of a refusal.
    pub allowed: &'static str,
    /// What it is, in one line; words of the vocabulary stand between backticks.
    pub help: &'static str,
    /// The surfaces it matters to.
    pub surfaces: &'static [Surface],
    /// What its values are.
    pub kind: Kind,
    access: Access,
}

/// What the values of a parameter are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// A number.
    Number,
    /// A whole number.
    Whole,
    /// True or false.
    Flag,
    /// One of several words.
    Word,
}

impl Kind {
    /// Its word in tables.
    pub fn name(self) -> &'static str {
        match self {
            Kind::Number => "number",
            Kind::Whole => "whole number",
            Kind::Flag => "true or false",
            Kind::Word => "word",
        }
    }
}

/// How a parameter is read and written.
#[derive(Debug, Clone, Copy)]
struct Access {
    /// Whether a number is in the parameter's own range, whatever the others are.
    holds: fn(f64) -> bool,
    get: fn(&Parameters) -> Option<Value>,
    set: fn(&mut Builder, &'static str, &Value) -> Result<(), Error>,
}

/// The access to a field of [`Parameters`]: what it holds, its name, and the range of a number or the choices of a word.
macro_rules! field {
    (number, $field:ident, $holds:expr) => {
        Access {
            holds: $holds,
            get: |p| Some(Value::Number(p.$field)),
            set: |b, name, value| in_range(name, value).map(|x| b.parameters.$field = x),
        }
    };
    (whole, $field:ident, $holds:expr) => {
        Access {
            holds: $holds,
            get: |p| Some(Value::Number(p.$field as f64)),
            set: |b, name, value| whole_in_range(name, value).map(|n| b.parameters.$field = n),
        }
    };
    (optional, $field:ident, $holds:expr) => {
        Access {
            holds: $holds,
            get: |p| p.$field.map(Value::Number),
            set: |b, name, value| in_range(name, value).map(|x| b.parameters.$field = Some(x)),
        }
    };
    (flag, $field:ident) => {
        Access {
            holds: |_| true,
            get: |p| Some(Value::Flag(p.$field)),
            set: |b, name, value| flag(name, value).map(|x| b.parameters.$field = x),
        }
    };
    (word, $field:ident, $choices:ident) => {
        Access {
            holds: |_| true,
            get: |p| word(&p.$field, &$choices),
            set: |b, name, value| choice(name, value, &$choices).map(|x| b.parameters.$field = x),
        }
    };
}

/// The access to one of the forms in which [`Wind`] is given: the wind checks its own range, also where no word is used.
macro_rules! wind {
    ($name:literal, $pattern:pat => $value:expr, $make:expr) => {
        Access {
            holds: |x| wind::check($name, x, x).is_ok(),
            get: |p| if let $pattern = p.wind { Some(Value::Number($value)) } else { None },
            set: |b, name, value| in_range(name, value).and_then(|x| b.wind(name, value, $make(x))),
        }
    };
}

const ALL: &[Surface] = &[Surface::Flat, Surface::Instance, Surface::Ensemble, Surface::Empirical];

/// Every parameter, a row each.
pub const ENTRIES: [Entry; 37] = [
    Entry {
        name: "wind_speed",
        unit: "m/s",
        default: "5",
        allowed: "0 to 36.00 m/s at 10 m, 46.93 m/s at 100 m, the end of Table 1",
        help: "wind speed at `wind_height`; 0 is calm",
        surfaces: ALL,
        kind: Kind::Number,
        access: wind!("wind_speed", Wind::Speed { speed, .. } => speed, |speed| Wind::Speed { speed, height: 10.0 }),
    },
    Entry {
        name: "wind_height",
        unit: "m",
        default: "10",
        allowed: "0.1 to 100 m",
        help: "height at which `wind_speed` is measured",
        surfaces: ALL,
        kind: Kind::Number,
        access: Access {
            holds: |h| wind::check("wind_height", h, h).is_ok(),
            get: |p| if let Wind::Speed { height, .. } = p.wind { Some(Value::Number(height)) } else { None },
            // The speed may come later.
            set: |b, name, value| in_range(name, value).map(|h| b.wind_height = Some(h)),
        },
    },
    Entry {
        name: "friction_velocity",
        unit: "cm/s",
        default: "",
        allowed: "0 to 238.65 cm/s, the end of Table 1",
        help: "friction velocity w* instead of `wind_speed`",
        surfaces: ALL,
        kind: Kind::Number,
        access: wind!("friction_velocity", Wind::FrictionVelocity(w) => w, Wind::FrictionVelocity),
    },
    Entry {
        name: "beaufort",
        unit: "",
        default: "",
        allowed: "a whole number from 0 to 12",
        help: "Beaufort number instead of `wind_speed`",
        surfaces: ALL,
        kind: Kind::Whole,
        access: wind!("beaufort", Wind::Beaufort(number) => f64::from(number), |number| Wind::Beaufort(number as u8)),
    },
    Entry {
        name: "wind_direction",
        unit: "degrees",
        default: "0",
        allowed: "any finite angle, degrees",
        help: "azimuth the wind comes from, counter-clockwise from +x (in Mitsuba: dp_du)",
        surfaces: ALL,
        kind: Kind::Number,
        access: field!(number, wind_direction, f64::is_finite),
    },
    Entry {
        name: "footprint",
        unit: "m",
        default: "inf",
        allowed: "above 0 m, up to inf",
        help: "footprint D: waves shorter than 2 D are facets; 0.15 unless `surface` is `flat`",
        surfaces: ALL,
        kind: Kind::Number,
        access: Access {
            holds: |d| d > 0.0,
            get: |p| Some(Value::Number(p.width())),
            set: |b, name, value| in_range(name, value).map(|d| b.parameters.footprint = Some(d)),
        },
    },
    Entry {
        name: "footprint_measure",
        unit: "",
        default: "1/e2",
        allowed: "1/e2, 1/e, fwhm, side",
        help: "what the footprint is of a beam: its diameter at `1/e2` of the intensity in its middle (the report's D), at `1/e`, at half of it (`fwhm`), or the `side` of a pixel",
        surfaces: ALL,
        kind: Kind::Word,
        access: field!(word, footprint_measure, FOOTPRINTS),
    },
    Entry {
        name: "surface",
        unit: "",
        default: "flat",
        allowed: "flat, instance, ensemble, empirical",
        help: "which surface the facets lie on: the one given (`flat`), drawn waves (`instance`), \
               their mean, the sea from afar (`ensemble`), or the report's model of that mean, from \
               a table (`empirical`)",
        surfaces: ALL,
        kind: Kind::Word,
        access: field!(word, surface, SURFACES),
    },
    Entry {
        name: "average",
        unit: "",
        default: "power",
        allowed: "power, report",
        help: "what an ensemble's mean is of: `power`, or the `report`'s mean of f (times the flat \
               cosine)",
        surfaces: &[Surface::Ensemble],
        kind: Kind::Word,
        access: field!(word, average, AVERAGES),
    },
    Entry {
        name: "across",
        unit: "",
        default: "report",
        allowed: "report, slopes",
        help: "how the empirical model falls off across the plane of incidence: as the `report`'s \
               Gaussian (Eq. 90), or as the `slopes`' density, which follows the full model",
        surfaces: &[Surface::Empirical],
        kind: Kind::Word,
        access: field!(word, across, ACROSS),
    },
    Entry {
        name: "components",
        unit: "",
        default: "5",
        allowed: "1 to 65536",
        help: "the report's M: waves of a drawn surface",
        surfaces: &DRAWN,
        kind: Kind::Whole,
        access: field!(whole, components, |m| (1.0..=f64::from(MOST_COMPONENTS)).contains(&m)),
    },
    Entry {
        name: "instances",
        unit: "",
        default: "50",
        allowed: "1 to 1000000000",
        help: "the report's N: drawn surfaces of an ensemble",
        surfaces: &[Surface::Instance, Surface::Empirical],
        kind: Kind::Whole,
        access: field!(whole, instances, |n| (1.0..=MOST_INSTANCES as f64).contains(&n)),
    },
    Entry {
        name: "seed",
        unit: "",
        default: "0",
        allowed: "0 to 9007199254740991",
        help: "chooses the random numbers of the drawn surfaces",
        surfaces: &[Surface::Instance, Surface::Empirical],
        kind: Kind::Whole,
        access: field!(whole, seed, |seed| (0.0..SEEDS as f64).contains(&seed)),
    },
    Entry {
        name: "time",
        unit: "s",
        default: "0",
        allowed: "finite, at most 1e9 s from 0",
        help: "time at which waves are drawn",
        surfaces: &[Surface::Instance],
        kind: Kind::Number,
        access: field!(number, time, |t| t.abs() <= LONGEST_TIME),
    },
    Entry {
        name: "depth",
        unit: "m",
        default: "inf",
        allowed: "above 0 m, up to inf",
        help: "depth of the water",
        surfaces: &DRAWN,
        kind: Kind::Number,
        access: field!(number, depth, |d| d > 0.0),
    },
    Entry {
        name: "fetch",
        unit: "m",
        default: "inf",
        allowed: "above 0 m, up to inf",
        help: "distance to the shore the wind comes from; matters to 100 km",
        surfaces: &DRAWN,
        kind: Kind::Number,
        access: field!(number, fetch, |d| d > 0.0),
    },
    Entry {
        name: "spectrum",
        unit: "",
        default: "report",
        allowed: "report, jonswap, tma, elfouhaily",
        help: "wave energy spectrum: the `report`'s (Eqs. 3-20), `jonswap`'s of a short `fetch`, the same where `depth` limits \
               the waves (`tma`), or Elfouhaily's (`elfouhaily`)",
        surfaces: &DRAWN,
        kind: Kind::Word,
        access: field!(word, spectrum, SPECTRA),
    },
    Entry {
        name: "swell_height",
        unit: "m",
        default: "0",
        allowed: "0 to 30 m",
        help: "significant height of a swell beside the wind's waves, at most a 20th of its waves' length; 0 is none",
        surfaces: &[Surface::Instance],
        kind: Kind::Number,
        access: field!(number, swell_height, |h| (0.0..=30.0).contains(&h)),
    },
    Entry {
        name: "swell_period",
        unit: "s",
        default: "12",
        allowed: "2 to 30 s",
        help: "period of the swell's peak",
        surfaces: &[Surface::Instance],
        kind: Kind::Number,
        access: field!(number, swell_period, |s| (2.0..=30.0).contains(&s)),
    },
    Entry {
        name: "swell_direction",
        unit: "degrees",
        default: "",
        allowed: "any finite angle, degrees",
        help: "azimuth the swell comes from, as `wind_direction`; else the wind's",
        surfaces: &[Surface::Instance],
        kind: Kind::Number,
        access: field!(optional, swell_direction, f64::is_finite),
    },
    Entry {
        name: "slopes",
        unit: "",
        default: "cox_munk",
        allowed: "cox_munk, breon_henriot",
        help: "measured slopes of all waves: Cox and Munk's (Eqs. 76-78, `cox_munk`) or Breon and Henriot's \
               (`breon_henriot`)",
        surfaces: ALL,
        kind: Kind::Word,
        access: field!(word, slopes, STATISTICS),
    },
    Entry {
        name: "slope_budget",
        unit: "",
        default: "report",
        allowed: "report, closed",
        help: "slope variance of the facets: the `report`'s of the footprint, or what drawn waves leave of that of all \
               waves (`closed`)",
        surfaces: ALL,
        kind: Kind::Word,
        access: field!(word, slope_budget, BUDGETS),
    },
    Entry {
        name: "wavelength",
        unit: "micrometres",
        default: "0.55",
        allowed: "0.2 to 200 micrometres",
        help: "wavelength of the refractive index and the whitecaps; spectral variants of Mitsuba take their own unless it is given",
        surfaces: ALL,
        kind: Kind::Number,
        access: field!(number, wavelength, |x| (WAVELENGTHS[0]..=WAVELENGTHS[1]).contains(&x)),
    },
    Entry {
        name: "ior",
        unit: "",
        default: "",
        allowed: "1 to 4",
        help: "refractive index; else Hale and Querry's at the wavelength, and what the salt adds",
        surfaces: ALL,
        kind: Kind::Number,
        access: field!(optional, ior, |n| (1.0..=4.0).contains(&n)),
    },
    Entry {
        name: "extinction",
        unit: "",
        default: "",
        allowed: "0 to 10",
        help: "imaginary part k of the index; else Hale and Querry's at the wavelength, or 0 with an `ior` or `readings` as printed",
        surfaces: ALL,
        kind: Kind::Number,
        access: field!(optional, extinction, |k| (0.0..=10.0).contains(&k)),
    },
    Entry {
        name: "water",
        unit: "",
        default: "ocean",
        allowed: "ocean, fresh",
        help: "sea or fresh water: salt raises the index by 0.006, from 0.4 to 14 micrometres",
        surfaces: ALL,
        kind: Kind::Word,
        access: field!(word, water, WATERS),
    },
    Entry {
        name: "temperature",
        unit: "degrees Celsius",
        default: "",
        allowed: "0 to 30 degrees Celsius",
        help: "of the water, in the visible: the index is then Quan and Fry's",
        surfaces: ALL,
        kind: Kind::Number,
        access: field!(optional, temperature, |t| (0.0..=30.0).contains(&t)),
    },
    Entry {
        name: "salinity",
        unit: "per mille",
        default: "",
        allowed: "0 to 45 per mille",
        help: "salt, for the index; else 34.3 in the ocean and none in fresh water",
        surfaces: ALL,
        kind: Kind::Number,
        access: field!(optional, salinity, |s| (0.0..=45.0).contains(&s)),
    },
    Entry {
        name: "fresnel",
        unit: "",
        default: "schlick",
        allowed: "schlick, exact",
        help: "reflectance of a facet: `schlick` (Eq. 63) or `exact`",
        surfaces: ALL,
        kind: Kind::Word,
        access: field!(word, fresnel, FRESNELS),
    },
    Entry {
        name: "slope_measure",
        unit: "",
        default: "angle",
        allowed: "angle, slope",
        help: "slope density Gaussian in tilt angles (`angle`, as printed) or in slopes (`slope`)",
        surfaces: ALL,
        kind: Kind::Word,
        access: field!(word, slope_measure, MEASURES),
    },
    Entry {
        name: "readings",
        unit: "",
        default: "corrected",
        allowed: "corrected, 22, 43-45, 56, 62, 65, 66, 70, 71-73, 78, 82, 88, as_printed",
        help: "equations taken as printed: none (`corrected`), the whole print (`as_printed`), or a list, such as `56, 71-73`",
        surfaces: ALL,
        kind: Kind::Word,
        access: Access {
            holds: |_| true,
            get: |p| Some(Value::Text(p.readings.to_string())),
            // An equation by itself may come as a number.
            set: |b, name, value| match value {
                Value::Flag(_) => Err(wrong_type(name, value, "a word")),
                _ => value.to_string().parse().map(|readings| b.parameters.readings = readings),
            },
        },
    },
    Entry {
        name: "whitecaps",
        unit: "",
        default: "true",
        allowed: "true or false",
        help: "blend in whitecaps (Eqs. 51, 55)",
        surfaces: ALL,
        kind: Kind::Flag,
        access: field!(flag, whitecaps),
    },
    Entry {
        name: "whitecap_onset",
        unit: "",
        default: "calibrated",
        allowed: "calibrated, ramp, step",
        help: "where on drawn waves whitecaps stand: so that they cover the fraction of Eq. 51 (`calibrated`), or by Eqs. 53-54 of \
               the drawn waves alone, below w* = 24.9 cm/s with a step at -0.39 g (`ramp`) or at -alpha g (`step`)",
        surfaces: &DRAWN,
        kind: Kind::Word,
        access: field!(word, whitecap_onset, WHITECAP_ONSETS),
    },
    Entry {
        name: "whitecap_lifetime",
        unit: "s",
        default: "0",
        allowed: "0 to 60 s",
        help: "for how long the foam of a whitecap stays where a drawn wave broke: the time in which it falls to 1/e, 3.85 s in salt \
               water and 2.54 s in fresh; 0 is as long as the wave breaks, as in the report",
        surfaces: &[Surface::Instance],
        kind: Kind::Number,
        access: field!(number, whitecap_lifetime, |s| (0.0..=60.0).contains(&s)),
    },
    Entry {
        name: "shadowing",
        unit: "",
        default: "true",
        allowed: "true or false",
        help: "apply the shadowing function (Eqs. 64-67)",
        surfaces: ALL,
        kind: Kind::Flag,
        access: field!(flag, shadowing),
    },
    Entry {
        name: "hiding",
        unit: "",
        default: "report",
        allowed: "report, once",
        help: "slopes in the shadowing function: the whole sea's, as the `report`, or the facets' own, so \
               that what longer waves hide counts `once`; the same for an infinite footprint",
        surfaces: ALL,
        kind: Kind::Word,
        access: field!(word, hiding, HIDINGS),
    },
    Entry {
        name: "gram_charlier",
        unit: "",
        default: "true",
        allowed: "true or false",
        help: "apply skewness and kurtosis (Eq. 78)",
        surfaces: ALL,
        kind: Kind::Flag,
        access: field!(flag, gram_charlier),
    },
];

/// Refuses a number outside of its parameter's own range, whatever the others are; `shown` is the value as it was given.
pub(crate) fn check(parameter: &'static str, x: f64, shown: impl ToString) -> Result<(), Error> {
    let entry = ENTRIES.iter().find(|e| e.name == parameter).expect("a word of the vocabulary");
    if (entry.access.holds)(x) { Ok(()) } else { refuse(parameter, shown, entry.allowed) }
}

/// The parameters that tell the wind: one of them is enough, but for the height of a speed.
pub const WIND: [&str; 4] = ["wind_speed", "wind_height", "friction_velocity", "beaufort"];

/// The parameters that do not describe the sea, but how its surface reflects.
pub const OPTICS: [&str; 13] = [
    "average",
    "across",
    "wavelength",
    "ior",
    "extinction",
    "temperature",
    "salinity",
    "fresnel",
    "slope_measure",
    "readings",
    "shadowing",
    "hiding",
    "gram_charlier",
];

/// A value as scene files, flags and C hand it over.
#[derive(Debug, Clone, PartialEq)]
pub enum Value {
    /// A number.
    Number(f64),
    /// True or false.
    Flag(bool),
    /// A word, or any of the above written out.
    Text(String),
}

impl std::fmt::Display for Value {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Value::Number(x) => write!(f, "{x}"),
            Value::Flag(x) => write!(f, "{x}"),
            Value::Text(x) => write!(f, "{x}"),
        }
    }
}

fn wrong_type(parameter: &'static str, value: &Value, expected: &'static str) -> Error {
    Error::WrongType { parameter, value: value.to_string(), expected }
}

fn number(parameter: &'static str, value: &Value) -> Result<f64, Error> {
    match value {
        Value::Number(x) => Ok(*x),
        Value::Text(x) => x.trim().parse().map_err(|_| wrong_type(parameter, value, "a number")),
        Value::Flag(_) => Err(wrong_type(parameter, value, "a number")),
    }
}

/// A number within its parameter's own range.
fn in_range(parameter: &'static str, value: &Value) -> Result<f64, Error> {
    let x = number(parameter, value)?;
    check(parameter, x, value)?;
    Ok(x)
}

/// A whole number within its parameter's own range.
fn whole_in_range<T: TryFrom<u64>>(parameter: &'static str, value: &Value) -> Result<T, Error> {
    in_range(parameter, value).and_then(|_| whole(parameter, value))
}

/// A whole number within what `T` holds, of a parameter by its name.
pub fn whole<T: TryFrom<u64>>(parameter: &'static str, value: &Value) -> Result<T, Error> {
    let x = number(parameter, value)?;
    // Beyond 2^53 not every whole number is one of float64.
    let whole = (x.fract() == 0.0 && (0.0..9_007_199_254_740_992.0).contains(&x)).then_some(x as u64);
    whole.and_then(|x| T::try_from(x).ok()).ok_or_else(|| {
        let allowed = format!("a whole number from 0 to {}", u64::MAX >> (64 - 8 * size_of::<T>()).max(11));
        Error::OutOfRange { parameter, value: value.to_string(), allowed }
    })
}

fn flag(parameter: &'static str, value: &Value) -> Result<bool, Error> {
    match value {
        Value::Flag(x) => Ok(*x),
        Value::Text(x) => x.trim().parse().map_err(|_| wrong_type(parameter, value, "true or false")),
        Value::Number(_) => Err(wrong_type(parameter, value, "true or false")),
    }
}

const SURFACES: [(&str, Surface); 4] = [
    ("flat", Surface::Flat),
    ("instance", Surface::Instance),
    ("ensemble", Surface::Ensemble),
    ("empirical", Surface::Empirical),
];
const ACROSS: [(&str, OffPlaneModel); 2] =
    [("report", OffPlaneModel::Report), ("slopes", OffPlaneModel::Slopes)];
const FOOTPRINTS: [(&str, FootprintMeasure); 4] = [
    ("1/e2", FootprintMeasure::OneOverE2),
    ("1/e", FootprintMeasure::OneOverE),
    ("fwhm", FootprintMeasure::HalfMaximum),
    ("side", FootprintMeasure::Side),
];
const AVERAGES: [(&str, Average); 2] = [("power", Average::Power), ("report", Average::Report)];
const HIDINGS: [(&str, Hiding); 2] = [("report", Hiding::Report), ("once", Hiding::Once)];
const WATERS: [(&str, Salinity); 2] = [("ocean", Salinity::Ocean), ("fresh", Salinity::Fresh)];
const FRESNELS: [(&str, Fresnel); 2] = [("schlick", Fresnel::Schlick), ("exact", Fresnel::Exact)];
const MEASURES: [(&str, SlopeMeasure); 2] = [("angle", SlopeMeasure::Angle), ("slope", SlopeMeasure::Slope)];
const SPECTRA: [(&str, SpectrumModel); 4] = [
    ("report", SpectrumModel::Report),
    ("jonswap", SpectrumModel::Jonswap),
    ("tma", SpectrumModel::Tma),
    ("elfouhaily", SpectrumModel::Elfouhaily),
];
const BUDGETS: [(&str, SlopeBudget); 2] = [("report", SlopeBudget::Report), ("closed", SlopeBudget::Closed)];
const STATISTICS: [(&str, SlopeStatistics); 2] =
    [("cox_munk", SlopeStatistics::CoxMunk), ("breon_henriot", SlopeStatistics::BreonHenriot)];
const WHITECAP_ONSETS: [(&str, WhitecapOnset); 3] =
    [("calibrated", WhitecapOnset::Calibrated), ("ramp", WhitecapOnset::Ramp), ("step", WhitecapOnset::Step)];

fn word<C: PartialEq>(choice: &C, choices: &[(&str, C)]) -> Option<Value> {
    choices.iter().find(|(_, c)| c == choice).map(|(name, _)| Value::Text((*name).into()))
}

fn choice<C: Copy>(parameter: &'static str, value: &Value, choices: &[(&str, C)]) -> Result<C, Error> {
    let Value::Text(text) = value else {
        return Err(wrong_type(parameter, value, "a word"));
    };
    match choices.iter().find(|(name, _)| name == text) {
        Some((_, choice)) => Ok(*choice),
        None => Err(Error::UnknownChoice {
            parameter,
            value: text.clone(),
            allowed: choices.iter().map(|(name, _)| *name).collect::<Vec<_>>().join(", "),
        }),
    }
}

impl Parameters {
    /// The value of a parameter by its name; `None` for one that is not set or not known.
    pub fn get(&self, name: &str) -> Option<Value> {
        ENTRIES.iter().find(|e| e.name == name).and_then(|e| (e.access.get)(self))
    }
}

impl Surface {
    /// Its word in the vocabulary.
    pub fn name(self) -> &'static str {
        SURFACES.iter().find(|(_, surface)| *surface == self).map_or("", |(name, _)| name)
    }
}

impl Water {
    /// The same, if its surface is one of those that the caller serves.
    ///
    /// # Errors
    /// [`Error::Surface`] where it is not.
    pub fn on(self, surfaces: &[Surface]) -> Result<Self, Error> {
        let surface = self.parameters.surface;
        if surfaces.contains(&surface) {
            return Ok(self);
        }
        let allowed = surfaces.iter().map(|surface| surface.name()).collect::<Vec<_>>().join(", ");
        Err(Error::Surface { value: surface.name(), allowed })
    }
}

/// The parameters in force as TOML, a `name = value` a line, and as comments what follows from them.
impl std::fmt::Display for Water {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        for entry in &ENTRIES {
            match self.parameters.get(entry.name) {
                Some(Value::Number(x)) => writeln!(f, "{} = {}", entry.name, toml_number(x))?,
                Some(Value::Flag(x)) => writeln!(f, "{} = {x}", entry.name)?,
                Some(Value::Text(word)) => writeln!(f, "{} = \"{word}\"", entry.name)?,
                None => {}
            }
        }
        writeln!(f, "# friction_velocity = {} cm/s", self.wind.friction_velocity)?;
        writeln!(f, "# sigma_u2 = {:.6}, sigma_c2 = {:.6}", self.variances[0], self.variances[1])?;
        write!(f, "# whitecap_fraction = {:.6}, ior = {:.6}", self.whitecap_fraction, self.ior)
    }
}

/// Digits that TOML reads back to the same number: an integer only where it fits TOML's.
fn toml_number(x: f64) -> String {
    let integer = x.fract() == 0.0 && x.abs() < 1e15 && !(x == 0.0 && x.is_sign_negative());
    if integer { format!("{x}") } else { format!("{x:?}") }
}

/// Fills [`Parameters`] from named values; what is not named keeps its default.
#[derive(Debug, Clone, Default)]
pub struct Builder {
    parameters: Parameters,
    /// Which wind was given, and as what.
    wind_from: Option<(&'static str, String)>,
    wind_height: Option<f64>,
}

fn conflict(
    (first, first_value): &(&'static str, String),
    (second, second_value): (&'static str, String),
) -> Error {
    Error::Conflict {
        first,
        first_value: first_value.clone(),
        second,
        second_value,
        allowed: "wind_speed (with wind_height), friction_velocity, beaufort",
    }
}

impl Builder {
    /// With another surface than the flat one, unless it is told.
    pub fn on(surface: Surface) -> Self {
        Self { parameters: Parameters { surface, ..Parameters::default() }, ..Self::default() }
    }

    /// Sets one parameter by its name; one that is refused leaves all as it was.
    ///
    /// # Errors
    /// [`Error::UnknownParameter`], [`Error::WrongType`], [`Error::UnknownChoice`], [`Error::OutOfRange`] for a number that is
    /// out of the parameter's range whatever the others are, and [`Error::Conflict`] for a second wind.
    pub fn set(&mut self, name: &str, value: &Value) -> Result<(), Error> {
        let Some(entry) = ENTRIES.iter().find(|e| e.name == name) else {
            let known = ENTRIES.map(|e| e.name).join(", ");
            return Err(Error::UnknownParameter { name: name.into(), known });
        };
        (entry.access.set)(self, entry.name, value)
    }

    fn wind(&mut self, name: &'static str, value: &Value, wind: Wind) -> Result<(), Error> {
        if let Some(first) = self.wind_from.as_ref().filter(|(first, _)| *first != name) {
            return Err(conflict(first, (name, value.to_string())));
        }
        self.wind_from = Some((name, value.to_string()));
        self.parameters.wind = wind;
        Ok(())
    }

    /// The parameters, once all have been named.
    ///
    /// # Errors
    /// [`Error::Conflict`] for a `wind_height` without a `wind_speed`.
    pub fn parameters(&self) -> Result<Parameters, Error> {
        let mut p = self.parameters;
        if let Some(h) = self.wind_height {
            match &mut p.wind {
                Wind::Speed { height, .. } => *height = h,
                _ => {
                    let first = self.wind_from.clone().unwrap_or_default();
                    return Err(conflict(&first, ("wind_height", h.to_string())));
                }
            }
        }
        Ok(p)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::readings::Readings;

    #[test]
    fn what_is_set_can_be_read() {
        let values = [
            ("wind_speed", Value::Number(7.0)),
            ("wind_height", Value::Number(19.5)),
            ("friction_velocity", Value::Number(8.0)),
            ("beaufort", Value::Number(4.0)),
            ("wind_direction", Value::Number(-30.0)),
            ("footprint", Value::Number(0.15)),
            ("footprint_measure", Value::Text("fwhm".into())),
            ("surface", Value::Text("instance".into())),
            ("average", Value::Text("report".into())),
            ("across", Value::Text("slopes".into())),
            ("components", Value::Number(20.0)),
            ("instances", Value::Number(1e6)),
            ("seed", Value::Number(12345.0)),
            ("time", Value::Number(-3.5)),
            ("depth", Value::Number(2.0)),
            ("fetch", Value::Number(5e3)),
            ("spectrum", Value::Text("elfouhaily".into())),
            ("slopes", Value::Text("breon_henriot".into())),
            ("slope_budget", Value::Text("closed".into())),
            ("wavelength", Value::Number(1.064)),
            ("ior", Value::Number(1.33)),
            ("extinction", Value::Number(0.25)),
            ("water", Value::Text("fresh".into())),
            ("temperature", Value::Number(12.5)),
            ("salinity", Value::Number(7.0)),
            ("fresnel", Value::Text("exact".into())),
            ("slope_measure", Value::Text("slope".into())),
            ("readings", Value::Text("56, 71-73".into())),
            ("whitecaps", Value::Flag(false)),
            ("whitecap_onset", Value::Text("step".into())),
            ("whitecap_lifetime", Value::Number(2.54)),
            ("swell_height", Value::Number(1.5)),
            ("swell_period", Value::Number(8.0)),
            ("swell_direction", Value::Number(-20.0)),
            ("shadowing", Value::Flag(false)),
            ("hiding", Value::Text("once".into())),
            ("gram_charlier", Value::Flag(false)),
        ];
        assert_eq!(values.len(), ENTRIES.len());
        for (name, value) in values {
            for given in [value.clone(), Value::Text(value.to_string())] {
                let mut builder = Builder::default();
                builder.set(name, &given).unwrap();
                let p = builder.parameters().unwrap();
                p.configure().unwrap();
                assert_eq!(p.get(name), Some(value.clone()));
            }
        }
    }

    /// A reader of no more TOML than is written.
    fn read(text: &str) -> Parameters {
        let mut builder = Builder::default();
        for line in text.lines().filter(|line| !line.starts_with('#')) {
            let (name, value) = line.split_once(" = ").unwrap();
            let value = match value.strip_prefix('"') {
                Some(word) => Value::Text(word.strip_suffix('"').unwrap().into()),
                None => match value.parse() {
                    Ok(flag) => Value::Flag(flag),
                    Err(_) => Value::Number(value.parse().unwrap()),
                },
            };
            builder.set(name, &value).unwrap();
        }
        builder.parameters().unwrap()
    }

    #[test]
    fn what_is_shown_can_be_read() {
        let winds =
            [Wind::Speed { speed: 7.1, height: 19.5 }, Wind::FrictionVelocity(0.1 + 0.2), Wind::Beaufort(4)];
        let mut named = std::collections::BTreeSet::new();
        for wind in winds {
            let given = Parameters {
                wind,
                wind_direction: -1.0 / 3.0,
                footprint: Some(1e-7),
                footprint_measure: FootprintMeasure::Side,
                surface: Surface::Instance,
                average: Average::Report,
                across: OffPlaneModel::Slopes,
                components: 20,
                instances: 1_000_000,
                seed: 9_007_199_254_740_991,
                time: -0.0,
                depth: 1e23,
                fetch: 5e15,
                spectrum: SpectrumModel::Elfouhaily,
                swell_height: 0.7,
                swell_period: 9.5,
                swell_direction: Some(100.0 / 3.0),
                slopes: SlopeStatistics::BreonHenriot,
                slope_budget: SlopeBudget::Closed,
                wavelength: 1.064,
                ior: Some(4.0 / 3.0),
                extinction: Some(1.0 / 7.0),
                water: Salinity::Fresh,
                temperature: Some(20.0 / 3.0),
                salinity: Some(0.1),
                fresnel: Fresnel::Exact,
                slope_measure: SlopeMeasure::Slope,
                readings: Readings::EQ_66 | Readings::EQ_22,
                whitecaps: false,
                whitecap_onset: WhitecapOnset::Ramp,
                whitecap_lifetime: 3.85,
                shadowing: false,
                hiding: Hiding::Once,
                gram_charlier: false,
            };
            let text = given.configure().unwrap().to_string();
            let found = read(&text);
            named.extend(ENTRIES.iter().filter_map(|entry| {
                assert_eq!(found.get(entry.name), given.get(entry.name));
                given.get(entry.name).map(|_| entry.name)
            }));
            assert!(found.time.is_sign_negative() && found.configure().unwrap().to_string() == text);
            // Whole numbers without a point must fit TOML's integers.
            assert!(text.contains("\ndepth = 1e23\n") && text.contains("\ncomponents = 20\n"), "{text}");
        }
        assert_eq!(named.len(), ENTRIES.len());
        let text = Parameters::default().configure().unwrap().to_string();
        assert!(
            text.contains("\nfootprint = inf\nfootprint_measure = \"1/e2\"\nsurface = \"flat\"\n")
                && !text.contains("\nior"),
            "{text}"
        );
        assert!(
            text.contains("\n# friction_velocity = ") && text.contains("\n# whitecap_fraction = "),
            "{text}"
        );
    }

    #[test]
    fn defaults_are_as_documented() {
        for entry in ENTRIES {
            let found = Parameters::default().get(entry.name).map_or(String::new(), |v| v.to_string());
            assert_eq!(found, entry.default, "{}", entry.name);
        }
    }

    /// What a refusal says is allowed is the row's text, and each of a row's words is one.
    #[test]
    fn allowed_is_as_documented() {
        for entry in ENTRIES {
            let refused = match entry.kind {
                Kind::Number | Kind::Whole => Value::Number(f64::NAN),
                Kind::Flag => Value::Number(1.0),
                Kind::Word => Value::Text("nonsense".into()),
            };
            let allowed = match Builder::default().set(entry.name, &refused).unwrap_err() {
                Error::OutOfRange { allowed, .. } | Error::UnknownChoice { allowed, .. } => allowed,
                Error::WrongType { expected, .. } => expected.into(),
                error => panic!("{error}"),
            };
            assert_eq!(allowed, entry.allowed, "{}", entry.name);
            if entry.kind == Kind::Word {
                for word in entry.allowed.split(", ") {
                    Builder::default().set(entry.name, &Value::Text(word.into())).unwrap();
                }
            }
        }
        let error = Wind::Speed { speed: f64::NAN, height: 100.0 }.profile().unwrap_err().to_string();
        let (_, farthest) = ENTRIES[0].allowed.split_once("m at 10 m, ").unwrap_or(("", ""));
        assert!(error.contains(farthest), "{error}");
    }

    /// A parameter changes what the surfaces of its row reflect, and nothing of the others.
    #[test]
    fn parameters_matter_where_they_are_said_to() {
        let f = |surface: Surface, (name, value): (&str, Value)| {
            let mut builder = Builder::on(surface);
            for (name, x) in
                [("friction_velocity", 60.0), ("footprint", 0.1), ("components", 8.0), ("time", 0.5)]
            {
                builder.set(name, &Value::Number(x)).unwrap();
            }
            if surface == Surface::Instance {
                builder.set("swell_height", &Value::Number(0.1)).unwrap();
            }
            builder.set(name, &value).unwrap();
            let water = builder.parameters().unwrap().configure().unwrap();
            let [i, o, steep] = [[0.6, 0.0, 0.8], [-0.36, 0.48, 0.8], [-0.8, 0.0, 0.6]];
            match surface {
                Surface::Flat => water.lobe().map(|lobe| [lobe.eval(i, o, None), lobe.eval(i, steep, None)]),
                Surface::Instance => crate::InstanceLobe::new(&water).map(|lobe| {
                    let sum = |o| (0..999).map(|n| lobe.eval(i, o, [f64::from(n), 0.3])).sum::<f64>();
                    [o, steep].map(sum)
                }),
                _ => crate::EnsembleLobe::new(&water).map(|lobe| [lobe.eval(i, o), lobe.eval(i, steep)]),
            }
            .unwrap()
        };
        // The wind is given as its friction velocity; the number of draws matters to statistics alone.
        let others = ["wind_speed", "wind_height", "friction_velocity", "beaufort", "surface", "instances"];
        for surface in [Surface::Flat, Surface::Instance, Surface::Ensemble] {
            let usual = f(surface, ("seed", Value::Number(0.0)));
            // What drawn seas alone have is refused there.
            let refused =
                if surface == Surface::Ensemble { &["whitecap_lifetime", "swell_height"][..] } else { &[] };
            for entry in ENTRIES.iter().filter(|e| !others.contains(&e.name) && !refused.contains(&e.name)) {
                let value = match (entry.name, entry.kind) {
                    ("wind_direction", _) => Value::Number(60.0),
                    ("fetch", _) => Value::Number(3e4),
                    (_, Kind::Number) => Value::Number(2.0),
                    (_, Kind::Whole) => Value::Number(7.0),
                    (_, Kind::Flag) => Value::Flag(false),
                    (_, Kind::Word) => Value::Text(entry.allowed.rsplit(", ").next().unwrap().into()),
                };
                let matters = f(surface, (entry.name, value.clone())) != usual;
                assert_eq!(
                    matters,
                    entry.surfaces.contains(&surface),
                    "{} = {value} on {surface:?}",
                    entry.name
                );
            }
        }
    }

    #[test]
    fn refusals_name_parameter_value_and_range() {
        let number = |x: f64| Value::Number(x);
        let text = |x: &str| Value::Text(x.into());
        for (name, value) in [
            ("wind_speed", number(-1.0)),
            ("wind_speed", number(f64::NAN)),
            ("wind_speed", number(36.1)),
            ("wind_height", number(0.0)),
            ("friction_velocity", number(239.0)),
            ("friction_velocity", text("fast")),
            ("beaufort", number(13.0)),
            ("beaufort", number(2.5)),
            ("wind_direction", number(f64::INFINITY)),
            ("footprint", number(0.0)),
            ("footprint", number(-1.0)),
            ("footprint", number(f64::NAN)),
            ("surface", text("lumpy")),
            ("average", text("median")),
            ("across", text("diagonal")),
            ("footprint_measure", text("1/e3")),
            ("components", number(0.0)),
            ("components", number(1e5)),
            ("components", number(2.5)),
            ("components", number(1e300)),
            ("instances", number(0.0)),
            ("instances", number(1e10)),
            ("instances", number(-1.0)),
            ("seed", number(-1.0)),
            ("seed", number(1e16)),
            ("time", number(f64::NAN)),
            ("time", number(f64::INFINITY)),
            ("depth", number(0.0)),
            ("depth", number(f64::NAN)),
            ("fetch", number(-5.0)),
            ("wavelength", number(0.1)),
            ("ior", number(0.99)),
            ("extinction", number(-1e-9)),
            ("extinction", number(10.1)),
            ("ior", number(f64::INFINITY)),
            ("temperature", number(-0.5)),
            ("whitecap_lifetime", number(-0.1)),
            ("swell_height", number(-0.1)),
            ("swell_height", number(31.0)),
            ("swell_period", number(1.9)),
            ("swell_direction", number(f64::INFINITY)),
            ("whitecap_lifetime", number(61.0)),
            ("salinity", number(45.5)),
            ("whitecaps", number(1.0)),
            ("fresnel", Value::Flag(true)),
        ] {
            let mut builder = Builder::default();
            let set = builder.set(name, &value);
            // The height decides how much of a wind speed is too much.
            assert_eq!(set.is_ok(), (name, &value) == ("wind_speed", &number(36.1)), "{name} {value}");
            let error = set
                .and_then(|()| builder.parameters())
                .and_then(|p| p.configure())
                .expect_err(name)
                .to_string();
            assert!(error.contains(name) && error.contains(&value.to_string()), "{error}");
        }
    }

    /// A value that is refused is so by the setter, and leaves the earlier one; numbers and texts alike.
    #[test]
    fn setters_refuse() {
        let far = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, -1e300, 1e300, -1.0, 0.0, 0.05, 1e5, 1e10];
        for entry in &ENTRIES {
            let [mut before, mut builder] = [Builder::default(), Builder::default()];
            for builder in [&mut before, &mut builder] {
                // Some value that every range has.
                _ = builder.set(entry.name, &Value::Number(1.0));
            }
            for x in far {
                for value in [Value::Number(x), Value::Text(x.to_string())] {
                    let Err(error) = builder.set(entry.name, &value) else {
                        // Then it is good by itself.
                        let mut alone = Builder::default();
                        alone.set(entry.name, &value).unwrap();
                        let parameters = alone.parameters().unwrap();
                        parameters.configure().unwrap();
                        builder.set(entry.name, &Value::Number(1.0)).unwrap();
                        continue;
                    };
                    assert_eq!(error.parameters(), [entry.name]);
                    assert!(error.to_string().contains(&value.to_string()), "{error}");
                    assert_eq!(builder.parameters(), before.parameters());
                }
            }
        }
        let mut high = Builder::default();
        high.set("wind_speed", &Value::Number(40.0)).unwrap();
        high.set("wind_height", &Value::Number(100.0)).unwrap();
        high.parameters().unwrap().configure().unwrap();
        let error = high.set("wind_speed", &Value::Number(60.0)).unwrap_err().to_string();
        assert!(error.contains("0 to 36.00 m/s at 10 m") && error.contains("at 100 m"), "{error}");
    }

    #[test]
    fn what_is_hardly_meant_is_told() {
        let warnings = |set: &[(&str, f64)]| {
            let mut builder = Builder::default();
            for (name, x) in set {
                builder.set(name, &Value::Number(*x)).unwrap();
            }
            let warnings = builder.parameters().unwrap().configure().unwrap().warnings();
            warnings.iter().map(|warning| warning.to_string()).collect::<Vec<_>>()
        };
        for usual in [
            ("wind_direction", 360.0),
            ("wind_direction", -360.0),
            ("footprint", 1e-3),
            ("footprint", 100.0),
            ("footprint", f64::INFINITY),
            ("friction_velocity", 0.0),
            ("friction_velocity", 1.0),
            ("wind_speed", 0.0),
            ("seed", 9e15),
        ] {
            assert_eq!(warnings(&[usual]), [""; 0], "{usual:?}");
        }
        assert_eq!(
            warnings(&[("friction_velocity", 0.3), ("wind_direction", -1e9), ("footprint", 2e-4)]),
            [
                "friction_velocity = 0.3 is allowed but unusual: usual is 0, or from 1 cm/s (not m/s)",
                "wind_direction = -1000000000 is allowed but unusual: usual is -360 to 360 degrees",
                "footprint = 0.0002 is allowed but unusual: usual is 0.001 to 100 m, or inf",
            ]
        );
        assert_eq!(warnings(&[("footprint", 175.0)]).len(), 1);
    }

    #[test]
    fn footprint_follows_the_surface() {
        let mut builder = Builder::default();
        let configured = |builder: &Builder| builder.parameters().unwrap().configure().unwrap();
        assert_eq!(configured(&builder).footprint, f64::INFINITY);
        builder.set("surface", &Value::Text("instance".into())).unwrap();
        let water = configured(&builder);
        // The same in Rust, whatever else is given.
        assert_eq!(water.footprint, 0.15);
        let by_hand = Parameters { surface: Surface::Instance, ..Parameters::default() };
        assert_eq!(by_hand.configure().unwrap().to_string(), water.to_string());
        builder.set("footprint", &Value::Text("inf".into())).unwrap();
        let water = configured(&builder);
        assert_eq!(water.footprint, f64::INFINITY);
        let refused = water.on(&[Surface::Flat, Surface::Ensemble]).unwrap_err().to_string();
        assert_eq!(refused, "surface = instance is not served here: allowed is flat, ensemble");
        assert!(water.on(&[Surface::Instance]).is_ok());
    }

    #[test]
    fn short_seas_need_a_fetch() {
        for word in ["jonswap", "tma"] {
            let mut builder = Builder::default();
            builder.set("spectrum", &Value::Text(word.into())).unwrap();
            let refused = builder.parameters().unwrap().configure().unwrap_err();
            assert_eq!(refused.parameters(), ["fetch"]);
            assert_eq!(
                refused.to_string(),
                "fetch = inf is out of range: allowed is above 0 m, finite, with spectrum = jonswap or tma"
            );
            builder.set("fetch", &Value::Number(5e3)).unwrap();
            builder.parameters().unwrap().configure().unwrap();
        }
    }

    #[test]
    fn one_wind_only() {
        for (first, second) in
            [("wind_speed", "beaufort"), ("beaufort", "friction_velocity"), ("beaufort", "wind_height")]
        {
            let mut builder = Builder::default();
            builder.set(first, &Value::Number(3.0)).unwrap();
            let error =
                builder.set(second, &Value::Number(7.0)).and_then(|()| builder.parameters()).unwrap_err();
            assert!(matches!(error, Error::Conflict { .. }), "{error}");
            assert!(error.to_string().contains("3") && error.to_string().contains("7"));
        }
        assert!(matches!(
            Builder::default().set("waves", &Value::Number(1.0)),
            Err(Error::UnknownParameter { .. })
        ));
    }
}
