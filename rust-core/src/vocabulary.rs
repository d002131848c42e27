//! The one vocabulary of parameters: scene files, flags, C, Python and Rust all use these names.

use crate::optics::Fresnel;
use crate::wind::Wind;
use crate::{Body, Error, Parameters, Readings, SlopeMeasure, Surface};

/// A parameter as documentation and help show it.
#[derive(Debug, Clone, Copy)]
pub struct Entry {
    /// Name, with underscores.
    pub name: &'static str,
    /// Unit, empty for none.
    pub unit: &'static str,
    /// Default, as text.
    pub default: &'static str,
    /// What it is, in one line.
    pub help: &'static str,
}

const fn entry(name: &'static str, unit: &'static str, default: &'static str, help: &'static str) -> Entry {
    Entry { name, unit, default, help }
}

/// Every parameter.
pub const ENTRIES: [Entry; 16] = [
    entry("wind_speed", "m/s", "5", "wind speed at wind_height; 0 is calm"),
    entry("wind_height", "m", "10", "height at which wind_speed is measured, 0.1 to 100"),
    entry("friction_velocity", "cm/s", "", "friction velocity w* instead of wind_speed, 0 to 238.65"),
    entry("beaufort", "", "", "Beaufort number instead of wind_speed, 0 to 12"),
    entry("wind_direction", "degrees", "0", "azimuth the wind comes from, counter-clockwise from +x"),
    entry("footprint", "m", "inf", "footprint D; shorter waves are facets; or inf"),
    entry("surface", "", "flat", "which surface the facets lie on: flat"),
    entry("wavelength", "micrometres", "0.55", "wavelength, 0.2 to 200"),
    entry("ior", "", "", "refractive index, 1 to 10; else Hale and Querry's at the wavelength"),
    entry("water", "", "ocean", "ocean or fresh: sea salt raises the index by 0.006"),
    entry("fresnel", "", "schlick", "schlick (Eq. 63) or exact"),
    entry("slope_measure", "", "angle", "slope density Gaussian in tilt angles (as printed) or in slopes: angle or slope"),
    entry("readings", "", "corrected", "corrected or as_printed equations, see docs/model.md"),
    entry("whitecaps", "", "true", "blend in whitecaps (Eqs. 51, 55)"),
    entry("shadowing", "", "true", "apply the shadowing function (Eqs. 64-67)"),
    entry("gram_charlier", "", "true", "apply skewness and kurtosis (Eq. 78)"),
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

fn flag(parameter: &'static str, value: &Value) -> Result<bool, Error> {
    match value {
        Value::Flag(x) => Ok(*x),
        Value::Text(x) => x.trim().parse().map_err(|_| wrong_type(parameter, value, "true or false")),
        Value::Number(_) => Err(wrong_type(parameter, value, "true or false")),
    }
}

fn choice<C: Copy>(parameter: &'static str, value: &Value, choices: &[(&str, C)]) -> Result<C, Error> {
    let Value::Text(text) = value else {
        return Err(wrong_type(parameter, value, "a word"));
    };
    match choices.iter().find(|(name, _)| name == text) {
        Some((_, choice)) => Ok(*choice),
        None => Err(Error::OutOfRange {
            parameter,
            value: text.clone(),
            allowed: choices.iter().map(|(name, _)| *name).collect::<Vec<_>>().join(", "),
        }),
    }
}

/// Fills [`Parameters`] from named values; what is not named keeps its default.
#[derive(Debug, Clone, Default)]
pub struct Builder {
    parameters: Parameters,
    wind_from: Option<&'static str>,
    wind_height: Option<f64>,
}

const WINDS: &str = "wind_speed (with wind_height), friction_velocity, beaufort";

impl Builder {
    /// Sets one parameter by its name.
    pub fn set(&mut self, name: &str, value: &Value) -> Result<(), Error> {
        let Some(entry) = ENTRIES.iter().find(|e| e.name == name) else {
            let known = ENTRIES.map(|e| e.name).join(", ");
            return Err(Error::UnknownParameter { name: name.into(), known });
        };
        let name = entry.name;
        let p = &mut self.parameters;
        match name {
            "wind_speed" => {
                let speed = number(name, value)?;
                self.wind(name, Wind::Speed { speed, height: 10.0 })?;
            }
            "wind_height" => self.wind_height = Some(number(name, value)?),
            "friction_velocity" => {
                let w = number(name, value)?;
                self.wind(name, Wind::FrictionVelocity(w))?;
            }
            "beaufort" => {
                let b = number(name, value)?;
                if !(0.0..=12.0).contains(&b) || b.fract() != 0.0 {
                    let allowed = "a whole number from 0 to 12".into();
                    return Err(Error::OutOfRange { parameter: name, value: value.to_string(), allowed });
                }
                self.wind(name, Wind::Beaufort(b as u8))?;
            }
            "wind_direction" => p.wind_direction = number(name, value)?,
            "footprint" => p.footprint = number(name, value)?,
            "surface" => p.surface = choice(name, value, &[("flat", Surface::Flat)])?,
            "wavelength" => p.wavelength = number(name, value)?,
            "ior" => p.ior = Some(number(name, value)?),
            "water" => p.water = choice(name, value, &[("ocean", Body::Ocean), ("fresh", Body::Fresh)])?,
            "fresnel" => p.fresnel = choice(name, value, &[("schlick", Fresnel::Schlick), ("exact", Fresnel::Exact)])?,
            "slope_measure" => {
                p.slope_measure = choice(name, value, &[("angle", SlopeMeasure::Angle), ("slope", SlopeMeasure::Slope)])?
            }
            "readings" => {
                p.readings = choice(name, value, &[("corrected", Readings::Corrected), ("as_printed", Readings::AsPrinted)])?
            }
            "whitecaps" => p.whitecaps = flag(name, value)?,
            "shadowing" => p.shadowing = flag(name, value)?,
            "gram_charlier" => p.gram_charlier = flag(name, value)?,
            _ => unreachable!("{name} is in the vocabulary but cannot be set"),
        }
        Ok(())
    }

    fn wind(&mut self, name: &'static str, wind: Wind) -> Result<(), Error> {
        if let Some(first) = self.wind_from.filter(|first| *first != name) {
            return Err(Error::Conflict { first, second: name, allowed: WINDS });
        }
        self.wind_from = Some(name);
        self.parameters.wind = wind;
        Ok(())
    }

    /// The parameters, once all have been named.
    pub fn parameters(&self) -> Result<Parameters, Error> {
        let mut p = self.parameters;
        if let Some(h) = self.wind_height {
            match &mut p.wind {
                Wind::Speed { height, .. } => *height = h,
                _ => {
                    let first = self.wind_from.unwrap_or("wind_speed");
                    return Err(Error::Conflict { first, second: "wind_height", allowed: WINDS });
                }
            }
        }
        Ok(p)
    }
}
