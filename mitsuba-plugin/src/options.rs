//! Parameters of a BSDF being collected, and the sea that follows.

use crate::ffi::{Number, Variant};
use crate::water::{Lanes, Varied, Water};
use prob_water::brdf::water_body::{MOST_CHLOROPHYLL, case_1_reflectance};
use prob_water::vocabulary::{Builder, ENTRIES, OPTICS, Value};
use prob_water::{Error, FootprintMeasure, Table};
use std::path::Path;
use std::sync::Arc;

/// Numbers that can be changed, where they are set and matter.
const EXPOSED: [&str; 10] = [
    "wind_speed",
    "wind_height",
    "friction_velocity",
    "beaufort",
    "wind_direction",
    "footprint",
    "time",
    "wavelength",
    "ior",
    "extinction",
];
/// Of these, on a shape, whose sea is the shape's.
const EXPOSED_WHEN_LENT: [&str; 3] = ["wavelength", "ior", "extinction"];

/// Beside the vocabulary.
const PIXEL_ANGLE: &str = "pixel_angle";
const TABLE: &str = "table";
const CHLOROPHYLL: &str = "chlorophyll";

/// First and last wavelength, nm, and their step, of [`Options::water_body`].
const WATER_BODY: [u32; 3] = [360, 830, 5];

type Refused = Box<dyn std::error::Error>;

/// Parameters being collected.
#[derive(Clone, Default)]
pub struct Options {
    sea: Builder,
    /// With the path it was read from.
    table: Option<(String, Arc<Table>)>,
    varied: Varied,
    whitecap_texture: bool,
    /// The index is a spectrum or a texture.
    ior_texture: bool,
    /// A wavelength is given: it is that of all lanes.
    one_wavelength: bool,
    /// Degrees.
    pixel_angle: f64,
    /// Of the water body, mg/m^3.
    chlorophyll: Option<f64>,
    /// Words that the BSDF was given itself.
    own: Vec<String>,
    /// Whether a shape lends the sea.
    lent: bool,
}

pub fn options() -> Box<Options> {
    Box::default()
}

pub fn vocabulary() -> Vec<String> {
    ENTRIES.iter().map(|e| e.name).chain([PIXEL_ANGLE, CHLOROPHYLL]).map(String::from).collect()
}

impl Options {
    pub fn set_number(&mut self, name: &str, value: f64) -> Result<(), Refused> {
        self.set(name, Value::Number(value))
    }

    pub fn set_flag(&mut self, name: &str, value: bool) -> Result<(), Refused> {
        self.set(name, Value::Flag(value))
    }

    /// A `table` is read from its path.
    pub fn set_text(&mut self, name: &str, value: &str) -> Result<(), Refused> {
        if name == TABLE {
            self.table = Some((value.into(), Arc::new(Table::open(Path::new(value))?)));
            return Ok(());
        }
        self.set(name, Value::Text(value.into()))
    }

    pub fn set_object(&mut self, name: &str) -> Result<(), Refused> {
        self.given(name)?;
        match name {
            "footprint" => self.varied = Varied::Texture,
            "whitecaps" => self.whitecap_texture = true,
            "ior" => self.ior_texture = true,
            _ => {
                let allowed = "a plain number, true or false, or a word";
                return Err(format!("{name} is an object or an array: allowed is {allowed}").into());
            }
        }
        Ok(())
    }

    /// Reflectances of the water body, in steps of [`WATER_BODY`]; none where its chlorophyll is not given.
    pub fn water_body(&self) -> Result<Vec<f64>, Refused> {
        let Some(chlorophyll) = self.chlorophyll else { return Ok(vec![]) };
        if !(0.0..=MOST_CHLOROPHYLL).contains(&chlorophyll) {
            let allowed = format!("0 to {MOST_CHLOROPHYLL} mg/m^3");
            let value = chlorophyll.to_string();
            return Err(Error::OutOfRange { parameter: CHLOROPHYLL, value, allowed }.into());
        }
        let [first, last, step] = WATER_BODY;
        let all = (0..).map(|k| first + step * k).take_while(|nm| *nm <= last);
        Ok(all.map(|nm| case_1_reflectance(1e-3 * f64::from(nm), chlorophyll)).collect())
    }

    pub fn lend(&mut self) -> Result<(), Refused> {
        if self.lent {
            return Err("one BSDF cannot lie on two prob_water_surfaces, each has a sea of its own".into());
        }
        if let Some(name) = self.own.iter().find(|name| !OPTICS.contains(&name.as_str())) {
            return Err(given_twice(name));
        }
        self.lent = true;
        Ok(())
    }

    fn set(&mut self, name: &str, value: Value) -> Result<(), Refused> {
        if let Some(parameter) = [PIXEL_ANGLE, CHLOROPHYLL].into_iter().find(|own| *own == name) {
            let Value::Number(number) = value else {
                let (value, expected) = (value.to_string(), "a number");
                return Err(Error::WrongType { parameter, value, expected }.into());
            };
            match parameter {
                PIXEL_ANGLE => self.pixel_angle = number,
                _ => self.chlorophyll = Some(number),
            }
            return Ok(());
        }
        self.given(name)?;
        if name == "footprint" && matches!(&value, Value::Text(text) if text == "pixel") {
            self.varied = Varied::Pixel;
            return Ok(());
        }
        self.one_wavelength |= name == "wavelength";
        Ok(self.sea.set(name, &value)?)
    }

    /// One sea is described once.
    fn given(&mut self, name: &str) -> Result<(), Refused> {
        if !self.lent {
            self.own.push(name.into());
        } else if self.own.iter().any(|own| own == name) {
            return Err(given_twice(name));
        }
        Ok(())
    }

    pub fn configure(&self, variant: Variant) -> Result<Box<Water>, Refused> {
        let angle = self.pixel_angle;
        let is_pixel = self.varied == Varied::Pixel;
        if !(0.0..90.0).contains(&angle) || (angle > 0.0 && !is_pixel) {
            let allowed = "0 to 90 degrees, with footprint = pixel".into();
            return Err(
                Error::OutOfRange { parameter: PIXEL_ANGLE, value: angle.to_string(), allowed }.into()
            );
        }
        let follows = variant.spectral && !self.one_wavelength;
        let lanes = match (self.ior_texture, follows) {
            (false, false) => Lanes::Alike,
            (true, false) => Lanes::Indices,
            (_, true) => Lanes::Wavelengths,
        };
        let mut water = Water::new(&self.sea, self.varied, self.table.clone(), self.whitecap_texture, lanes)?;
        water.polarised = variant.polarised;
        let traced = variant.traced;
        water.pixel_angle = angle.to_radians();
        if is_pixel {
            water.measure = FootprintMeasure::Side;
        } else if self.lent {
            // A shape's vertices have D.
            water.measure = FootprintMeasure::OneOverE2;
        }
        water.exposed = if self.lent { &EXPOSED_WHEN_LENT } else { &EXPOSED };
        if traced && is_pixel && angle == 0.0 {
            return Err(
                "footprint = pixel needs pixel_angle here: traced variants have no ray differentials".into(),
            );
        }
        if traced {
            water.check_traced()?;
        }
        Ok(Box::new(water))
    }

    pub fn change(&mut self, numbers: &[Number], variant: Variant) -> Result<Box<Water>, Refused> {
        let mut changed = self.clone();
        let now = self.sea.parameters()?;
        for Number { name, value } in numbers {
            if now.get(name) != Some(Value::Number(*value)) {
                changed.sea.set(name, &Value::Number(*value))?;
            }
        }
        let water = changed.configure(variant)?;
        *self = changed;
        Ok(water)
    }
}

fn given_twice(name: &str) -> Refused {
    format!("{name} is given on the BSDF of a prob_water_surface: give it on the shape").into()
}
