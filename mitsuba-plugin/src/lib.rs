//! What the Mitsuba shim calls: configuration and errors over a cxx bridge, the hot path as plain C functions.

mod evaluate;
mod surface;

use prob_water::kernels::{Mean, Places};
use prob_water::sampling::FACET_ALBEDO_FLOOR;
use prob_water::simd::recorded::{Instruction, Operation};
use prob_water::vocabulary::{Builder, ENTRIES, OPTICS, Value};
use prob_water::{
    EmpiricalLobe, EnsembleLobe, Error, FacetTable, InstanceLobe, Kernels, Lobe, Surface, Table, whitecap,
};
use std::f64::consts::{PI, TAU};
use std::path::Path;

#[cxx::bridge(namespace = "prob_water")]
mod ffi {
    /// What the light from below meets: the whitecaps of level water and what draws take of facets beside their reflectance.
    struct Cover {
        /// Whether whitecaps take part, wherever they are.
        whitecaps: bool,
        fraction: f32,
        /// BRDF of a whitecap, 1/sr.
        brdf: f32,
        facet_albedo_floor: f32,
    }

    /// Which surface the facets lie on.
    enum Kind {
        Flat,
        Instance,
        Ensemble,
        Empirical,
    }

    /// `prob_water::simd::recorded::Operation`.
    #[repr(u32)]
    enum Operation {
        Constant,
        Coefficient,
        Input,
        Add,
        Subtract,
        Multiply,
        Divide,
        Negate,
        Absolute,
        SquareRoot,
        Reciprocal,
        ReciprocalRoot,
        MultiplyAdd,
        Residual,
        Less,
        And,
        Or,
        Not,
        Select,
        Round,
        ScaleByPowerOf2,
        Exponent,
        FlipSign,
        Detach,
        Floor,
        Lookup,
        Element,
    }

    /// `prob_water::simd::recorded::Program`: operation and three operands of every instruction, and its outputs.
    struct Program {
        instructions: Vec<u32>,
        outputs: Vec<u32>,
    }

    /// `prob_water::numeric::packets::Packets`.
    struct Packets {
        width: u32,
        half: bool,
        numbers: Vec<f32>,
    }

    /// `prob_water::Kernels`.
    struct Kernels {
        coefficients: Vec<f32>,
        tables: Vec<Packets>,
        programs: Vec<Program>,
    }

    /// The waves of `surface = "instance"`: eight numbers each, as place.h reads them.
    struct DrawnWaves {
        drawn: bool,
        /// Vertical accelerations between which the probability of a whitecap falls from 1 to 0, m/s^2.
        onset: [f64; 2],
        cells: Vec<f64>,
    }

    extern "Rust" {
        /// Parameters being collected.
        type Options;
        fn options() -> Box<Options>;
        fn set_number(self: &mut Options, name: &str, value: f64) -> Result<()>;
        fn set_flag(self: &mut Options, name: &str, value: bool) -> Result<()>;
        fn set_text(self: &mut Options, name: &str, value: &str) -> Result<()>;
        /// Reads the table of the empirical model that is in force instead of the core's own.
        fn open_table(self: &mut Options, path: &str) -> Result<()>;
        /// The sea; `varied` is how the footprint changes from place to place, empty where it does not.
        fn configure(self: &Options, varied: &str) -> Result<Box<Water>>;
        /// Every name of the vocabulary.
        fn vocabulary() -> Vec<String>;
        /// Whether a word of it describes the sea, and not how its surface reflects.
        fn describes_sea(name: &str) -> bool;

        /// A configured sea.
        type Water;
        fn kind(self: &Water) -> Kind;
        fn cover(self: &Water) -> Cover;
        /// `whitecaps`: their probability comes with every place.
        fn kernels(self: &Water, whitecaps: bool) -> Kernels;
        fn drawn_waves(self: &Water) -> DrawnWaves;
        /// Value of a numeric parameter in force, by name; NaN for one that is not set.
        fn number(self: &Water, name: &str) -> f64;
        /// `name = value` lines of the parameters and of what follows from them.
        fn describe(self: &Water) -> String;
        /// Values that are allowed but hardly meant, a line each.
        fn warnings(self: &Water) -> Vec<String>;
        /// Changes what `describe` tells of the time.
        fn set_time(self: &mut Water, time: f64);
    }
}

/// The bridge's number of an operation: one that the bridge lacks, or has under another name, does not compile.
macro_rules! numbered {
    ($($name:ident)*) => {
        fn number_of(operation: Operation) -> u32 {
            match operation {
                $(Operation::$name => ffi::Operation::$name.repr,)*
            }
        }
    };
}
numbered! {
    Constant Coefficient Input Add Subtract Multiply Divide Negate Absolute
    SquareRoot Reciprocal ReciprocalRoot MultiplyAdd Residual Less And Or Not Select Round
    ScaleByPowerOf2 Exponent FlipSign Detach Floor Lookup Element
}

/// Parameters being collected.
#[derive(Default)]
struct Options {
    sea: Builder,
    /// With the path it was read from.
    table: Option<(String, Table)>,
}

fn options() -> Box<Options> {
    Box::default()
}

fn vocabulary() -> Vec<String> {
    ENTRIES.iter().map(|e| e.name.to_string()).collect()
}

fn describes_sea(name: &str) -> bool {
    !OPTICS.contains(&name)
}

impl Options {
    fn set_number(&mut self, name: &str, value: f64) -> Result<(), Error> {
        self.sea.set(name, &Value::Number(value))
    }

    fn set_flag(&mut self, name: &str, value: bool) -> Result<(), Error> {
        self.sea.set(name, &Value::Flag(value))
    }

    fn set_text(&mut self, name: &str, value: &str) -> Result<(), Error> {
        self.sea.set(name, &Value::Text(value.into()))
    }

    fn open_table(&mut self, path: &str) -> Result<(), Error> {
        self.table = Some((path.into(), Table::open(Path::new(path))?));
        Ok(())
    }

    fn configure(&self, varied: &str) -> Result<Box<Water>, Error> {
        let surfaces = [Surface::Flat, Surface::Instance, Surface::Ensemble, Surface::Empirical];
        let water = self.sea.parameters()?.configure()?.on(&surfaces)?;
        let surface = water.parameters.surface;
        let from_afar = matches!(surface, Surface::Ensemble | Surface::Empirical);
        if from_afar && !varied.is_empty() {
            let name = water.parameters.get("surface").map_or(String::new(), |name| name.to_string());
            let allowed = format!("a number with surface = {name}");
            return Err(Error::OutOfRange { parameter: "footprint", value: varied.into(), allowed });
        }
        let table = match &self.table {
            Some((name, _)) if surface != Surface::Empirical => {
                let reason = "has no meaning but with surface = empirical".into();
                return Err(Error::Table { name: name.clone(), reason });
            }
            table => table.as_ref().map(|(_, table)| table),
        };
        let mut lobe = water.local_lobe();
        let waves = match surface {
            Surface::Flat => Waves::Level,
            Surface::Instance => {
                // Every place has its own.
                lobe = lobe.with_whitecaps(0.0);
                let new = if varied.is_empty() { InstanceLobe::new } else { InstanceLobe::fading };
                Waves::Drawn(new(&water)?)
            }
            Surface::Ensemble => {
                let afar = EnsembleLobe::new(&water)?;
                lobe = afar.sampler;
                Waves::Afar(afar)
            }
            Surface::Empirical => {
                let tabled = EmpiricalLobe::new(&water, table.unwrap_or_else(|| Table::standard()))?;
                lobe = tabled.sampler;
                Waves::Tabled(tabled)
            }
        };
        let facets = (!varied.is_empty()).then(|| FacetTable::new(&water));
        let single_facets = facets.as_ref().map(|table| table.cast());
        let table = self.table.as_ref().map(|(name, _)| name.clone());
        Ok(Box::new(Water { water, precise: lobe, lobe: lobe.cast(), waves, facets, single_facets, table }))
    }
}

/// A configured sea.
pub struct Water {
    water: prob_water::Water,
    /// The facets, or what draws directions for the sea from afar: traced code's numbers come from it.
    precise: Lobe<f64>,
    /// The same in Mitsuba's float32, for scalar variants.
    lobe: Lobe<f32>,
    waves: Waves,
    /// Where the footprint changes from place to place.
    facets: Option<FacetTable<f64>>,
    single_facets: Option<FacetTable<f32>>,
    /// The file of a table that is not the core's own.
    table: Option<String>,
}

/// What the facets lie on.
// A sea has one, whatever its size.
#[allow(clippy::large_enum_variant)]
enum Waves {
    Level,
    Drawn(InstanceLobe),
    Afar(EnsembleLobe),
    Tabled(EmpiricalLobe),
}

impl Water {
    fn kind(&self) -> ffi::Kind {
        match self.waves {
            Waves::Level => ffi::Kind::Flat,
            Waves::Drawn(_) => ffi::Kind::Instance,
            Waves::Afar(_) => ffi::Kind::Ensemble,
            Waves::Tabled(_) => ffi::Kind::Empirical,
        }
    }

    fn cover(&self) -> ffi::Cover {
        ffi::Cover {
            whitecaps: match &self.waves {
                Waves::Drawn(sea) => sea.has_whitecaps(),
                _ => self.precise.whitecap_fraction > 0.0,
            },
            fraction: self.precise.whitecap_fraction as f32,
            brdf: self.precise.whitecap_brdf as f32,
            facet_albedo_floor: FACET_ALBEDO_FLOOR as f32,
        }
    }

    fn kernels(&self, whitecaps: bool) -> ffi::Kernels {
        let mean = match &self.waves {
            Waves::Afar(EnsembleLobe { waves: Some(waves), .. }) => Mean::Ensemble(waves),
            Waves::Tabled(tabled) => Mean::Empirical(tabled.fine_grid()),
            _ => Mean::Facets,
        };
        let normal = matches!(self.waves, Waves::Drawn(_));
        let places = Places { normal, whitecap: whitecaps || normal, footprint: self.facets.as_ref() };
        let Kernels { recording, programs } = Kernels::new(&self.precise, mean, places);
        let word = |(operation, [a, b, c]): &Instruction| [number_of(*operation), *a, *b, *c];
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

    fn drawn_waves(&self) -> ffi::DrawnWaves {
        let Waves::Drawn(sea) = &self.waves else {
            return ffi::DrawnWaves { drawn: false, onset: [0.0; 2], cells: vec![] };
        };
        let time = self.water.parameters.time;
        let wave = |c: &prob_water::surface::Component| {
            let (sin, cos) = c.azimuth.sin_cos();
            let (k, omega) = (c.wave_number / TAU, c.frequency);
            let turns = ((c.phase + omega * time) / TAU).fract();
            [k * cos, k * sin, turns, c.amplitude, omega * omega, (c.wave_number / PI).log2(), 0.0, 0.0]
        };
        ffi::DrawnWaves {
            drawn: true,
            onset: whitecap::onset(self.water.wind.friction_velocity).map(|a| 0.01 * a),
            cells: sea.components().iter().flat_map(wave).collect(),
        }
    }

    fn number(&self, name: &str) -> f64 {
        match self.water.parameters.get(name) {
            Some(Value::Number(x)) => x,
            _ => f64::NAN,
        }
    }

    fn describe(&self) -> String {
        let mut text = self.water.to_string();
        if self.facets.is_some() {
            // A word that is refused unless one says for which footprint.
            let own = format!("\nfootprint = {}\n", self.water.footprint);
            text = text.replacen(&own, "\nfootprint = \"varies\"\n", 1);
        }
        if let Waves::Tabled(_) = self.waves {
            text += &format!("\n# table = {}", self.table.as_deref().unwrap_or("the standard one"));
        }
        text
    }

    fn warnings(&self) -> Vec<String> {
        self.water.warnings().iter().map(ToString::to_string).collect()
    }

    fn set_time(&mut self, time: f64) {
        self.water.parameters.time = time;
    }
}
