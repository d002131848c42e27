//! What the Mitsuba shim calls: configuration and errors over a cxx bridge, the hot path as plain C functions.

mod surface;

use prob_water::brdf::{Parts, up};
use prob_water::real::IERFC;
use prob_water::vocabulary::{Builder, ENTRIES, Value};
use prob_water::{Average, EnsembleLobe, Error, FacetTable, InstanceLobe, Lobe, Sample, Surface, whitecap};
use std::f64::consts::{PI, TAU};

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
        /// Whether whitecaps take part, wherever they are.
        whitecaps: bool,
        ierfc: [f32; 7],
    }

    /// Which surface the facets lie on.
    enum Kind {
        Flat,
        Instance,
        Ensemble,
    }

    /// What `prob_water::ensemble_lobe::Table` holds, for `surface = "ensemble"`; no rows where the sea is level.
    struct Waves {
        rows: u32,
        steps: [f32; 2],
        cells: Vec<f32>,
        sigma: [f32; 2],
        foam: [f32; 3],
        /// `average = "report"`.
        report: bool,
    }

    /// What `prob_water::FacetTable` holds, where the footprint changes from place to place; else no cells.
    struct FacetRows {
        first: f64,
        step: f64,
        scale: f64,
        bounded: bool,
        cells: Vec<f32>,
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
        /// The sea; `varied` is how the footprint changes from place to place, empty where it does not.
        fn configure(self: &Options, varied: &str) -> Result<Box<Water>>;
        /// Every name of the vocabulary.
        fn vocabulary() -> Vec<String>;

        /// A configured sea.
        type Water;
        fn kind(self: &Water) -> Kind;
        fn coefficients(self: &Water) -> Coefficients;
        fn waves(self: &Water) -> Waves;
        fn facet_rows(self: &Water) -> FacetRows;
        fn drawn_waves(self: &Water) -> DrawnWaves;
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

    fn configure(&self, varied: &str) -> Result<Box<Water>, Error> {
        let surfaces = [Surface::Flat, Surface::Instance, Surface::Ensemble];
        let water = self.0.parameters()?.configure()?.on(&surfaces)?;
        let mut lobe = water.lobe;
        let waves = match water.parameters.surface {
            Surface::Flat => Waves::Level,
            Surface::Instance => Waves::Drawn(InstanceLobe::new(&water)),
            Surface::Ensemble if varied.is_empty() => {
                let afar = EnsembleLobe::new(&water)?;
                lobe = afar.sampler;
                Waves::Afar(afar)
            }
            Surface::Ensemble => {
                let allowed = "a number with surface = ensemble".into();
                return Err(Error::OutOfRange { parameter: "footprint", value: varied.into(), allowed });
            }
        };
        let facets = (!varied.is_empty()).then(|| FacetTable::new(&water));
        Ok(Box::new(Water { water, lobe: lobe.cast(), waves, facets }))
    }
}

/// A configured sea.
pub struct Water {
    water: prob_water::Water,
    /// In Mitsuba's float32: the facets, or what draws directions for the sea from afar.
    lobe: Lobe<f32>,
    waves: Waves,
    /// Where the footprint changes from place to place.
    facets: Option<FacetTable>,
}

/// What the facets lie on.
enum Waves {
    Level,
    Drawn(InstanceLobe),
    Afar(EnsembleLobe),
}

/// What a place has of its own.
#[repr(C)]
pub struct Place {
    /// m, along s and t.
    place: [f64; 2],
    /// m; not a number: the sea's.
    footprint: f32,
    /// Probability of a whitecap; not a number: the sea's.
    whitecaps: f32,
}

/// The water at a place.
#[repr(C)]
pub struct Spot {
    lobe: Lobe<f32>,
    n: [f32; 3],
}

// The shim keeps a Spot in as many bytes.
const _: () = assert!(size_of::<Spot>() <= 256 && align_of::<Spot>() <= 16);

impl Water {
    fn kind(&self) -> ffi::Kind {
        match self.waves {
            Waves::Level => ffi::Kind::Flat,
            Waves::Drawn(_) => ffi::Kind::Instance,
            Waves::Afar(_) => ffi::Kind::Ensemble,
        }
    }

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
            whitecaps: match &self.waves {
                Waves::Drawn(sea) => sea.has_whitecaps(),
                _ => lobe.whitecap_fraction > 0.0,
            },
            ierfc: IERFC,
        }
    }

    fn waves(&self) -> ffi::Waves {
        let single = |x: f64| x as f32;
        let afar = if let Waves::Afar(afar) = &self.waves { afar.table() } else { None };
        match afar {
            Some(t) => ffi::Waves {
                rows: t.rows,
                steps: t.steps.map(single),
                cells: t.cells,
                sigma: t.sigma.map(single),
                foam: t.foam.map(single),
                report: t.average == Average::Report,
            },
            None => ffi::Waves {
                rows: 0,
                steps: [0.0; 2],
                cells: vec![],
                sigma: [0.0; 2],
                foam: [0.0; 3],
                report: false,
            },
        }
    }

    fn facet_rows(&self) -> ffi::FacetRows {
        let Some(table) = &self.facets else {
            return ffi::FacetRows { first: 0.0, step: 1.0, scale: 0.0, bounded: false, cells: vec![] };
        };
        let ([first, step], scale, cells) = table.table();
        ffi::FacetRows { first, step, scale, bounded: table.bounded(), cells }
    }

    fn drawn_waves(&self) -> ffi::DrawnWaves {
        let Waves::Drawn(_) = self.waves else {
            return ffi::DrawnWaves { drawn: false, onset: [0.0; 2], cells: vec![] };
        };
        let time = self.water.parameters.time;
        let wave = |c: prob_water::waves::Component| {
            let (sin, cos) = c.azimuth.sin_cos();
            let (k, omega) = (c.wave_number / TAU, c.frequency);
            let turns = ((c.phase + omega * time) / TAU).fract();
            [k * cos, k * sin, turns, c.amplitude, omega * omega, (c.wave_number / PI).log2(), 0.0, 0.0]
        };
        ffi::DrawnWaves {
            drawn: true,
            onset: whitecap::onset(self.water.wind.friction_velocity).map(|a| 0.01 * a),
            cells: InstanceLobe::components(&self.water).into_iter().flat_map(wave).collect(),
        }
    }

    /// f cos(theta_o) of some of its parts.
    fn eval(&self, i: [f32; 3], o: [f32; 3], parts: Parts) -> f32 {
        let f = match &self.waves {
            Waves::Afar(afar) => afar.eval_parts(i.map(f64::from), o.map(f64::from), parts) as f32,
            _ => self.lobe.eval_parts(i, o, up(), parts),
        };
        f * o[2].max(0.0)
    }

    fn at(&self, place: &Place) -> Spot {
        let mut lobe = self.lobe;
        let footprint = (!place.footprint.is_nan()).then(|| f64::from(place.footprint));
        if let (Some(table), Some(footprint)) = (&self.facets, footprint) {
            table.set(&mut lobe.facets, footprint);
        }
        let mut n = up();
        if let Waves::Drawn(sea) = &self.waves {
            let spot = sea.spot(place.place, footprint);
            n = spot.normal.map(|x| x as f32);
            lobe.whitecap_fraction = spot.whitecap as f32;
        }
        if !place.whitecaps.is_nan() {
            lobe.whitecap_fraction = place.whitecaps.clamp(0.0, 1.0);
        }
        Spot { lobe, n }
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

/// f cos(theta_o) of the parts in `bits` (1 facets, 2 whitecaps), about the normal (0, 0, 1), where all places are alike.
#[unsafe(no_mangle)]
pub extern "C" fn prob_water_bsdf_eval(water: &Water, bits: u32, i: &[f32; 3], o: &[f32; 3]) -> f32 {
    water.eval(*i, *o, parts(bits))
}

/// Density, 1/sr, with which [`prob_water_bsdf_sample`] draws `o`.
#[unsafe(no_mangle)]
pub extern "C" fn prob_water_bsdf_pdf(water: &Water, bits: u32, i: &[f32; 3], o: &[f32; 3]) -> f32 {
    water.lobe.pdf_parts(*i, *o, up(), parts(bits))
}

/// Draws a direction from three uniform numbers; the sample's `f` is f cos(theta_o).
#[unsafe(no_mangle)]
pub extern "C" fn prob_water_bsdf_sample(
    water: &Water,
    bits: u32,
    i: &[f32; 3],
    u: &[f32; 3],
    sample: &mut Sample<f32>,
) {
    *sample = water.lobe.sample_parts(*i, up(), *u, parts(bits));
    sample.f = match water.waves {
        Waves::Afar(_) => water.eval(*i, sample.direction, parts(bits)),
        _ => sample.f * sample.direction[2].max(0.0),
    };
}

/// The water at a place, whose BRDF the functions below are.
#[unsafe(no_mangle)]
pub extern "C" fn prob_water_spot(water: &Water, place: &Place, spot: &mut std::mem::MaybeUninit<Spot>) {
    spot.write(water.at(place));
}

/// The share of whitecaps.
#[unsafe(no_mangle)]
pub extern "C" fn prob_water_spot_whitecaps(spot: &Spot) -> f32 {
    spot.lobe.whitecap_fraction
}

/// As [`prob_water_bsdf_eval`].
#[unsafe(no_mangle)]
pub extern "C" fn prob_water_spot_eval(spot: &Spot, bits: u32, i: &[f32; 3], o: &[f32; 3]) -> f32 {
    spot.lobe.on_wave(*i, *o, spot.n, parts(bits))
}

/// As [`prob_water_bsdf_pdf`].
#[unsafe(no_mangle)]
pub extern "C" fn prob_water_spot_pdf(spot: &Spot, bits: u32, i: &[f32; 3], o: &[f32; 3]) -> f32 {
    if o[2] > 0.0 { spot.lobe.pdf_parts(*i, *o, spot.n, parts(bits)) } else { 0.0 }
}

/// As [`prob_water_bsdf_sample`].
#[unsafe(no_mangle)]
pub extern "C" fn prob_water_spot_sample(
    spot: &Spot,
    bits: u32,
    i: &[f32; 3],
    u: &[f32; 3],
    sample: &mut Sample<f32>,
) {
    *sample = spot.lobe.sample_parts(*i, spot.n, *u, parts(bits));
    if sample.direction[2] <= 0.0 {
        sample.pdf = 0.0;
    }
    sample.f = spot.lobe.on_wave(*i, sample.direction, spot.n, parts(bits));
}
