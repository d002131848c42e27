//! A configured sea, as the plugin evaluates it.

use crate::ffi;
use crate::operation_number;
use prob_water::kernels::{Light, Mean, Places};
use prob_water::simd::recorded::Instruction;
use prob_water::vocabulary::{Builder, Value};
use prob_water::{
    Dispersion, EmpiricalLobe, EnsembleLobe, Error, FacetTable, FootprintMeasure, InstanceLobe, Kernels,
    Lobe, Surface, Table,
};
use std::sync::Arc;

/// How the footprint changes from place to place.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Varied {
    /// It does not.
    #[default]
    Nowhere,
    Texture,
    Pixel,
}

/// What differs between the lanes of a spectrum.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Lanes {
    /// Nothing.
    #[default]
    Alike,
    /// The index, which comes with them.
    Indices,
    /// The wavelength: whitecaps and, unless it comes with them, the index.
    Wavelengths,
}

/// A configured sea.
pub struct Water {
    water: prob_water::Water,
    /// The facets, or what draws directions for the sea with unresolved waves: traced code's numbers come from it.
    precise: Lobe<f64>,
    /// The same in Mitsuba's float32, for scalar variants.
    pub lobe: Lobe<f32>,
    pub waves: Waves,
    /// Where the footprint changes from place to place.
    facets: Option<FacetTable<f64>>,
    pub single_facets: Option<FacetTable<f32>>,
    /// The file of a table that is not the core's own.
    table: Option<String>,
    varied: Varied,
    whitecap_texture: bool,
    /// Where lanes differ.
    dispersion: Option<Dispersion<f64>>,
    pub single_dispersion: Option<Dispersion<f32>>,
    /// Light is polarised.
    pub polarised: bool,
    /// Radians.
    pub pixel_angle: f64,
    /// What is measured where the footprint varies.
    pub measure: FootprintMeasure,
    /// Names of the numbers that can be changed, where they are set and matter.
    pub exposed: &'static [&'static str],
}

/// What the facets lie on.
// A sea has one, whatever its size.
#[allow(clippy::large_enum_variant)]
pub enum Waves {
    Level,
    Drawn(InstanceLobe),
    Ensemble(EnsembleLobe),
    Empirical(EmpiricalLobe),
}

impl Water {
    pub fn new(
        sea: &Builder,
        varied: Varied,
        table: Option<(String, Arc<Table>)>,
        whitecap_texture: bool,
        lanes: Lanes,
    ) -> Result<Self, Error> {
        let surfaces = [Surface::Flat, Surface::Instance, Surface::Ensemble, Surface::Empirical];
        let water = sea.parameters()?.configure()?.on(&surfaces)?;
        let surface = water.parameters.surface;
        if matches!(surface, Surface::Ensemble | Surface::Empirical) {
            let name = water.parameters.get("surface").map_or(String::new(), |name| name.to_string());
            let refuse = |parameter, value: &str, allowed| {
                let allowed = format!("{allowed} with surface = {name}");
                Err(Error::OutOfRange { parameter, value: value.into(), allowed })
            };
            match varied {
                Varied::Nowhere => {}
                Varied::Texture => return refuse("footprint", "a texture", "a number"),
                Varied::Pixel => return refuse("footprint", "pixel", "a number"),
            }
            if whitecap_texture {
                return refuse("whitecaps", "a texture", "true or false");
            }
        }
        let varies = varied != Varied::Nowhere;
        let (name, table) = table.unzip();
        if let Some(name) = name.clone().filter(|_| surface != Surface::Empirical) {
            return Err(Error::Table { name, reason: "has no meaning but with surface = empirical".into() });
        }
        let mut lobe = water.local_lobe();
        let waves = match surface {
            Surface::Flat => Waves::Level,
            Surface::Instance => {
                // Every place has its own.
                lobe = lobe.with_whitecaps(0.0);
                Waves::Drawn(if varies { InstanceLobe::fading(&water)? } else { InstanceLobe::new(&water)? })
            }
            Surface::Ensemble => {
                let ensemble = EnsembleLobe::new(&water)?;
                lobe = ensemble.sampler;
                Waves::Ensemble(ensemble)
            }
            Surface::Empirical => {
                let empirical =
                    EmpiricalLobe::new(&water, table.as_deref().unwrap_or_else(|| Table::standard()))?;
                lobe = empirical.sampler;
                Waves::Empirical(empirical)
            }
        };
        let facets = varies.then(|| FacetTable::new(&water));
        let single_facets = facets.as_ref().map(|table| table.cast());
        let dispersion = (lanes != Lanes::Alike).then(|| water.dispersion(lanes == Lanes::Indices));
        let single_dispersion = dispersion.as_ref().map(|dispersion| dispersion.cast());
        Ok(Self {
            water,
            precise: lobe,
            lobe: lobe.cast(),
            waves,
            facets,
            single_facets,
            table: name,
            varied,
            whitecap_texture,
            dispersion,
            single_dispersion,
            polarised: false,
            pixel_angle: 0.0,
            measure: water.parameters.footprint_measure,
            exposed: &[],
        })
    }

    /// Refuses what traced code does not sum: the waves of earlier times.
    pub fn check_traced(&self) -> Result<(), Error> {
        let lifetime = self.water.parameters.whitecap_lifetime;
        if lifetime == 0.0 || !matches!(self.waves, Waves::Drawn(_)) {
            return Ok(());
        }
        let allowed =
            "0 s with surface = instance in traced variants; scalar ones and prob_water_surface have others";
        Err(Error::OutOfRange {
            parameter: "whitecap_lifetime",
            value: lifetime.to_string(),
            allowed: allowed.into(),
        })
    }

    pub fn traits(&self) -> ffi::Traits {
        let whitecaps = match &self.waves {
            Waves::Drawn(sea) => sea.whitecap_onset().is_some(),
            _ => self.precise.whitecap_fraction > 0.0,
        };
        ffi::Traits {
            drawn: matches!(self.waves, Waves::Drawn(_)),
            ordered: matches!(self.waves, Waves::Ensemble(_) | Waves::Empirical(_)),
            whitecaps: whitecaps || self.whitecap_texture,
            varying_footprint: self.facets.is_some(),
            whitecap_texture: self.whitecap_texture,
            lanes: self.dispersion.is_some(),
            pixel: self.varied == Varied::Pixel,
            pixel_angle: self.pixel_angle as f32,
            diameter: self.measure.diameter() as f32,
            footprint: self.water.footprint as f32,
        }
    }

    /// Whether places differ.
    pub fn differs(&self) -> bool {
        self.facets.is_some() || self.whitecap_texture || matches!(self.waves, Waves::Drawn(_))
    }

    pub fn exposed(&self) -> Vec<ffi::Number> {
        let matters = |name: &str| match name {
            "footprint" => self.facets.is_none(),
            "time" => matches!(self.waves, Waves::Drawn(_)),
            "wavelength" => self.dispersion.is_none(),
            _ => true,
        };
        let number = |name: &&str| match self.water.parameters.get(name) {
            Some(Value::Number(value)) => Some(ffi::Number { name: name.to_string(), value }),
            _ => None,
        };
        self.exposed.iter().filter(|name| matters(name)).filter_map(number).collect()
    }

    pub fn kernels(&self) -> ffi::Kernels {
        let mean = match &self.waves {
            Waves::Ensemble(EnsembleLobe { waves: Some(waves), .. }) => Mean::Ensemble(waves),
            Waves::Empirical(empirical) => Mean::Empirical(empirical.fine_grid()),
            _ => Mean::Facets,
        };
        let drawn = match &self.waves {
            Waves::Drawn(sea) => Some(sea),
            _ => None,
        };
        let places = Places {
            normal: drawn.is_some(),
            onset: drawn.and_then(|sea| sea.whitecap_onset()),
            onsets: drawn.and_then(|sea| sea.whitecap_onsets()),
            whitecap: self.whitecap_texture || drawn.is_some(),
            footprint: self.facets.as_ref(),
        };
        let light = Light { polarised: self.polarised, dispersion: self.dispersion.as_ref() };
        let Kernels { recording, programs } = Kernels::new(&self.precise, mean, places, light);
        let word = |(operation, [a, b, c]): &Instruction| [operation_number(*operation), *a, *b, *c];
        ffi::Kernels {
            coefficients: recording.coefficients,
            tables: recording
                .tables
                .iter()
                .map(|t| ffi::Packets { width: t.width, half: t.half, numbers: t.numbers.to_vec() })
                .collect(),
            programs: programs
                .iter()
                .map(|p| ffi::Program {
                    instructions: p.instructions.iter().flat_map(word).collect(),
                    outputs: p.outputs.clone(),
                })
                .collect(),
        }
    }

    pub fn drawn_waves(&self) -> Vec<f64> {
        let Waves::Drawn(sea) = &self.waves else { return vec![] };
        sea.terms()
            .flat_map(|w| {
                let [kx, ky] = w.wave_number;
                [w.turns, kx, ky, w.amplitude, w.frequency_squared, w.log2_fading, 0.0, 0.0]
            })
            .collect()
    }

    pub fn describe(&self) -> String {
        let mut text = self.water.to_string();
        if self.facets.is_some() {
            // A word that is refused unless one says for which footprint.
            let own = self.water.parameters.get("footprint").map_or(String::new(), |own| own.to_string());
            let own = format!("\nfootprint = {own}\n");
            text = text.replacen(&own, "\nfootprint = \"varies\"\n", 1);
        }
        if let Waves::Empirical(_) = self.waves {
            text += &format!("\n# table = {}", self.table.as_deref().unwrap_or("the standard one"));
        }
        if self.whitecap_texture {
            text += "\n# whitecaps = a texture";
        }
        text
    }

    pub fn warnings(&self) -> Vec<String> {
        self.water.warnings().iter().map(ToString::to_string).collect()
    }

    pub fn set_time(&mut self, time: f64) {
        self.water.parameters.time = time;
    }
}
