//! The one vocabulary of parameters: scene files, flags, C, Python and Rust all use these names.

use super::parameters::{Across, Average, Parameters, Readings, Surface, Water, check};
use crate::brdf::{Fresnel, SlopeMeasure};
use crate::error::Error;
use crate::sea::{Body, Wind};

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
pub const ENTRIES: [Entry; 24] = [
    entry("wind_speed", "m/s", "5", "wind speed at wind_height; 0 is calm"),
    entry("wind_height", "m", "10", "height at which wind_speed is measured, 0.1 to 100"),
    entry("friction_velocity", "cm/s", "", "friction velocity w* instead of wind_speed, 0 to 238.65"),
    entry("beaufort", "", "", "Beaufort number instead of wind_speed, 0 to 12"),
    entry("wind_direction", "degrees", "0", "azimuth the wind comes from, counter-clockwise from +x"),
    entry(
        "footprint",
        "m",
        "inf",
        "footprint D: waves shorter than 2 D are facets; 0.15 unless surface is flat",
    ),
    entry(
        "surface",
        "",
        "flat",
        "which surface the facets lie on: flat, instance (drawn waves), ensemble (their mean) or empirical (a table's)",
    ),
    entry(
        "average",
        "",
        "power",
        "what an ensemble's mean is of: power, or the report's mean of f (times the flat cosine)",
    ),
    entry(
        "across",
        "",
        "report",
        "how the empirical model falls off across the plane: as the report's Gaussian, or as the slopes' density: \
         report or slopes",
    ),
    entry("components", "", "5", "the report's M: waves of a drawn surface, 1 to 65536"),
    entry("instances", "", "50", "the report's N: drawn surfaces of an ensemble"),
    entry("seed", "", "0", "chooses the random numbers of the drawn surfaces"),
    entry("time", "s", "0", "time at which waves are drawn"),
    entry("depth", "m", "inf", "depth of the water"),
    entry("fetch", "m", "inf", "distance to the shore the wind comes from; matters to 100 km"),
    entry("wavelength", "micrometres", "0.55", "wavelength, 0.2 to 200"),
    entry("ior", "", "", "refractive index, 1 to 4; else Hale and Querry's at the wavelength"),
    entry("water", "", "ocean", "ocean or fresh: sea salt raises the index by 0.006"),
    entry("fresnel", "", "schlick", "schlick (Eq. 63) or exact"),
    entry(
        "slope_measure",
        "",
        "angle",
        "slope density Gaussian in tilt angles (as printed) or in slopes: angle or slope",
    ),
    entry("readings", "", "corrected", "corrected or as_printed equations, see docs/model.md"),
    entry("whitecaps", "", "true", "blend in whitecaps (Eqs. 51, 55)"),
    entry("shadowing", "", "true", "apply the shadowing function (Eqs. 64-67)"),
    entry("gram_charlier", "", "true", "apply skewness and kurtosis (Eq. 78)"),
];

/// The parameters that tell the wind: one of them is enough, but for the height of a speed.
pub const WIND: [&str; 4] = ["wind_speed", "wind_height", "friction_velocity", "beaufort"];

/// The parameters that do not describe the sea, but how its surface reflects.
pub const OPTICS: [&str; 9] = [
    "average",
    "across",
    "wavelength",
    "ior",
    "fresnel",
    "slope_measure",
    "readings",
    "shadowing",
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
const ACROSS: [(&str, Across); 2] = [("report", Across::Report), ("slopes", Across::Slopes)];
const AVERAGES: [(&str, Average); 2] = [("power", Average::Power), ("report", Average::Report)];
const WATERS: [(&str, Body); 2] = [("ocean", Body::Ocean), ("fresh", Body::Fresh)];
const FRESNELS: [(&str, Fresnel); 2] = [("schlick", Fresnel::Schlick), ("exact", Fresnel::Exact)];
const MEASURES: [(&str, SlopeMeasure); 2] = [("angle", SlopeMeasure::Angle), ("slope", SlopeMeasure::Slope)];
const READINGS: [(&str, Readings); 2] =
    [("corrected", Readings::Corrected), ("as_printed", Readings::AsPrinted)];

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
        let number = |x: f64| Some(Value::Number(x));
        match (name, self.wind) {
            ("wind_speed", Wind::Speed { speed, .. }) => number(speed),
            ("wind_height", Wind::Speed { height, .. }) => number(height),
            ("friction_velocity", Wind::FrictionVelocity(w)) => number(w),
            ("beaufort", Wind::Beaufort(b)) => number(f64::from(b)),
            ("wind_direction", _) => number(self.wind_direction),
            ("footprint", _) => number(self.footprint()),
            ("surface", _) => word(&self.surface, &SURFACES),
            ("average", _) => word(&self.average, &AVERAGES),
            ("across", _) => word(&self.across, &ACROSS),
            ("components", _) => number(f64::from(self.components)),
            ("instances", _) => number(self.instances as f64),
            ("seed", _) => number(self.seed as f64),
            ("time", _) => number(self.time),
            ("depth", _) => number(self.depth),
            ("fetch", _) => number(self.fetch),
            ("wavelength", _) => number(self.wavelength),
            ("ior", _) => self.ior.and_then(number),
            ("water", _) => word(&self.water, &WATERS),
            ("fresnel", _) => word(&self.fresnel, &FRESNELS),
            ("slope_measure", _) => word(&self.slope_measure, &MEASURES),
            ("readings", _) => word(&self.readings, &READINGS),
            ("whitecaps", _) => Some(Value::Flag(self.whitecaps)),
            ("shadowing", _) => Some(Value::Flag(self.shadowing)),
            ("gram_charlier", _) => Some(Value::Flag(self.gram_charlier)),
            _ => None,
        }
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
        let name = entry.name;
        let p = &mut self.parameters;
        match name {
            "wind_speed" => {
                let speed = in_range(name, value)?;
                self.wind(name, value, Wind::Speed { speed, height: 10.0 })?;
            }
            "wind_height" => self.wind_height = Some(in_range(name, value)?),
            "friction_velocity" => {
                let w = in_range(name, value)?;
                self.wind(name, value, Wind::FrictionVelocity(w))?;
            }
            "beaufort" => {
                let b = in_range(name, value)?;
                self.wind(name, value, Wind::Beaufort(b as u8))?;
            }
            "wind_direction" => p.wind_direction = in_range(name, value)?,
            "footprint" => p.footprint = Some(in_range(name, value)?),
            "surface" => p.surface = choice(name, value, &SURFACES)?,
            "average" => p.average = choice(name, value, &AVERAGES)?,
            "across" => p.across = choice(name, value, &ACROSS)?,
            "components" => p.components = whole_in_range(name, value)?,
            "instances" => p.instances = whole_in_range(name, value)?,
            "seed" => p.seed = whole_in_range(name, value)?,
            "time" => p.time = in_range(name, value)?,
            "depth" => p.depth = in_range(name, value)?,
            "fetch" => p.fetch = in_range(name, value)?,
            "wavelength" => p.wavelength = in_range(name, value)?,
            "ior" => p.ior = Some(in_range(name, value)?),
            "water" => p.water = choice(name, value, &WATERS)?,
            "fresnel" => p.fresnel = choice(name, value, &FRESNELS)?,
            "slope_measure" => p.slope_measure = choice(name, value, &MEASURES)?,
            "readings" => p.readings = choice(name, value, &READINGS)?,
            "whitecaps" => p.whitecaps = flag(name, value)?,
            "shadowing" => p.shadowing = flag(name, value)?,
            "gram_charlier" => p.gram_charlier = flag(name, value)?,
            _ => unreachable!("{name} is in the vocabulary but cannot be set"),
        }
        Ok(())
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

    #[test]
    fn what_is_set_can_be_read() {
        let values = [
            ("wind_speed", Value::Number(7.0)),
            ("wind_height", Value::Number(19.5)),
            ("friction_velocity", Value::Number(8.0)),
            ("beaufort", Value::Number(4.0)),
            ("wind_direction", Value::Number(-30.0)),
            ("footprint", Value::Number(0.15)),
            ("surface", Value::Text("instance".into())),
            ("average", Value::Text("report".into())),
            ("across", Value::Text("slopes".into())),
            ("components", Value::Number(20.0)),
            ("instances", Value::Number(1e6)),
            ("seed", Value::Number(12345.0)),
            ("time", Value::Number(-3.5)),
            ("depth", Value::Number(2.0)),
            ("fetch", Value::Number(5e3)),
            ("wavelength", Value::Number(1.064)),
            ("ior", Value::Number(1.33)),
            ("water", Value::Text("fresh".into())),
            ("fresnel", Value::Text("exact".into())),
            ("slope_measure", Value::Text("slope".into())),
            ("readings", Value::Text("as_printed".into())),
            ("whitecaps", Value::Flag(false)),
            ("shadowing", Value::Flag(false)),
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
                surface: Surface::Instance,
                average: Average::Report,
                across: Across::Slopes,
                components: 20,
                instances: 1_000_000,
                seed: 9_007_199_254_740_991,
                time: -0.0,
                depth: 1e23,
                fetch: 5e15,
                wavelength: 1.064,
                ior: Some(4.0 / 3.0),
                water: Body::Fresh,
                fresnel: Fresnel::Exact,
                slope_measure: SlopeMeasure::Slope,
                readings: Readings::AsPrinted,
                whitecaps: false,
                shadowing: false,
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
            text.contains("\nfootprint = inf\nsurface = \"flat\"\n") && !text.contains("\nior"),
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
            ("ior", number(f64::INFINITY)),
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
