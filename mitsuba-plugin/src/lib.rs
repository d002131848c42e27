//! What the Mitsuba shim calls: configuration and errors over a cxx bridge, the hot path as plain C functions.

mod surface;

use prob_water::brdf::{Parts, up};
use prob_water::real::IERFC;
use prob_water::vocabulary::{Builder, ENTRIES, Value};
use prob_water::{EnsembleLobe, Error, Lobe, Sample, Surface};

#[cxx::bridge(namespace = "prob_water")]
mod ffi {
    /// The coefficients that the traced variants evaluate: `prob_water::Lobe<f32>` and the polynomial of
    /// the shadowing function.
    struct Coefficients {
        cos_wind: f64,
        sin_wind: f64,
        sigma_u: f64,
        sigma_c: f64,
        scale: f32,
        c21: f32,
        c03: f32,
        steep_gain: f32,
        sigma_shadow: f32,
        bound: f32,
        proposal_u: f32,
        proposal_c: f32,
        normal_reflectance: f64,
        ior2: f64,
        whitecap_fraction: f32,
        whitecap_brdf: f32,
        exact: bool,
        slope_measure: bool,
        gram_charlier: bool,
        shadowing: bool,
        bounded: bool,
        as_printed: bool,
        ierfc: [f32; 7],
    }

    /// What `prob_water::ensemble_lobe::Table` holds, for `surface = "ensemble"`; no rows where the sea is level.
    struct Waves {
        rows: u32,
        steps: [f32; 2],
        cells: Vec<f32>,
        sigma: [f32; 2],
        foam: [f32; 3],
    }

    extern "Rust" {
        /// Parameters being collected.
        type Options;
        fn options() -> Box<Options>;
        fn set_number(self: &mut Options, name: &str, value: f64) -> Result<()>;
        fn set_flag(self: &mut Options, name: &str, value: bool) -> Result<()>;
        fn set_text(self: &mut Options, name: &str, value: &str) -> Result<()>;
        fn configure(self: &Options) -> Result<Box<Water>>;
        /// Every name of the vocabulary.
        fn vocabulary() -> Vec<String>;

        /// A configured sea.
        type Water;
        fn coefficients(self: &Water) -> Coefficients;
        fn waves(self: &Water) -> Waves;
        /// Value of a numeric parameter in force, by name; NaN for one that is not set.
        fn number(self: &Water, name: &str) -> f64;
        /// `name = value` lines of the parameters and of what follows from them.
        fn describe(self: &Water) -> String;
    }
}

/// Parameters being collected.
struct Options(Builder);

fn options() -> Box<Options> {
    Box::new(Options(Builder::default()))
}

fn vocabulary() -> Vec<String> {
    ENTRIES.iter().map(|e| e.name.to_string()).collect()
}

impl Options {
    fn set_number(&mut self, name: &str, value: f64) -> Result<(), Error> {
        self.0.set(name, &Value::Number(value))
    }

    fn set_flag(&mut self, name: &str, value: bool) -> Result<(), Error> {
        self.0.set(name, &Value::Flag(value))
    }

    fn set_text(&mut self, name: &str, value: &str) -> Result<(), Error> {
        self.0.set(name, &Value::Text(value.into()))
    }

    fn configure(&self) -> Result<Box<Water>, Error> {
        let water = self.0.parameters()?.configure()?.on(&[Surface::Flat, Surface::Ensemble])?;
        let afar = match water.parameters.surface {
            Surface::Ensemble => Some(EnsembleLobe::new(&water)?),
            _ => None,
        };
        let lobe = afar.as_ref().map_or(water.lobe, |afar| afar.sampler).cast();
        Ok(Box::new(Water { water, lobe, afar }))
    }
}

/// A configured sea.
pub struct Water {
    water: prob_water::Water,
    /// In Mitsuba's float32: the flat sea's, or what draws directions for the sea from afar.
    lobe: Lobe<f32>,
    /// `surface = "ensemble"`.
    afar: Option<EnsembleLobe>,
}

impl Water {
    fn coefficients(&self) -> ffi::Coefficients {
        let (f, lobe) = (&self.lobe.facets, &self.lobe);
        ffi::Coefficients {
            cos_wind: f.cos_wind,
            sin_wind: f.sin_wind,
            sigma_u: f.sigma_u,
            sigma_c: f.sigma_c,
            scale: f.scale,
            c21: f.c21,
            c03: f.c03,
            steep_gain: f.steep_gain,
            sigma_shadow: f.sigma_shadow,
            bound: f.bound,
            proposal_u: f.proposal_u,
            proposal_c: f.proposal_c,
            normal_reflectance: f.reflectance.normal,
            ior2: f.reflectance.ior2,
            whitecap_fraction: lobe.whitecap_fraction,
            whitecap_brdf: lobe.whitecap_brdf,
            exact: f.reflectance.exact,
            slope_measure: f.slope_measure,
            gram_charlier: f.gram_charlier,
            shadowing: f.shadowing,
            bounded: f.bounded,
            as_printed: f.as_printed,
            ierfc: IERFC,
        }
    }

    fn waves(&self) -> ffi::Waves {
        let single = |x: f64| x as f32;
        match self.afar.as_ref().and_then(EnsembleLobe::table) {
            Some(t) => ffi::Waves {
                rows: t.rows,
                steps: t.steps.map(single),
                cells: t.cells,
                sigma: t.sigma.map(single),
                foam: t.foam.map(single),
            },
            None => ffi::Waves { rows: 0, steps: [0.0; 2], cells: vec![], sigma: [0.0; 2], foam: [0.0; 3] },
        }
    }

    /// f of some of its parts, 1/sr.
    fn eval(&self, i: [f32; 3], o: [f32; 3], parts: Parts) -> f32 {
        match &self.afar {
            Some(afar) => afar.eval_parts(i.map(f64::from), o.map(f64::from), parts) as f32,
            None => self.lobe.eval_parts(i, o, up(), parts),
        }
    }

    fn number(&self, name: &str) -> f64 {
        match self.water.parameters.get(name) {
            Some(Value::Number(x)) => x,
            _ => f64::NAN,
        }
    }

    fn describe(&self) -> String {
        self.water.to_string()
    }
}

fn parts(bits: u32) -> Parts {
    Parts { facets: bits & 1 != 0, whitecaps: bits & 2 != 0 }
}

/// f cos(theta_o) of the parts in `bits` (1 facets, 2 whitecaps), about the normal (0, 0, 1).
#[unsafe(no_mangle)]
pub extern "C" fn prob_water_bsdf_eval(water: &Water, bits: u32, i: &[f32; 3], o: &[f32; 3]) -> f32 {
    water.eval(*i, *o, parts(bits)) * o[2].max(0.0)
}

/// Density, 1/sr, with which [`prob_water_bsdf_sample`] draws `o`.
#[unsafe(no_mangle)]
pub extern "C" fn prob_water_bsdf_pdf(water: &Water, bits: u32, i: &[f32; 3], o: &[f32; 3]) -> f32 {
    water.lobe.pdf_parts(*i, *o, up(), parts(bits))
}

/// Draws a direction from three uniform numbers.
#[unsafe(no_mangle)]
pub extern "C" fn prob_water_bsdf_sample(
    water: &Water,
    bits: u32,
    i: &[f32; 3],
    u: &[f32; 3],
    sample: &mut Sample<f32>,
) {
    *sample = water.lobe.sample_parts(*i, up(), *u, parts(bits));
    if water.afar.is_some() {
        sample.f = water.eval(*i, sample.direction, parts(bits));
    }
}
