//! The hot path of the scalar variants, as plain C functions.

use crate::{Water, Waves};
use prob_water::brdf::Parts;
use prob_water::{Lobe, Sample};

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
    n: Option<[f32; 3]>,
}

// The shim keeps a Spot in as many bytes.
const _: () = assert!(size_of::<Spot>() <= 256 && align_of::<Spot>() <= 16);

impl Water {
    /// f cos(theta_o) of some of its parts; the light is at `o` where the path runs `to_light`, else at `i`.
    fn eval(&self, i: [f32; 3], o: [f32; 3], parts: Parts, to_light: bool) -> f32 {
        let (light, observer) = if to_light { (o, i) } else { (i, o) };
        let f = match &self.waves {
            Waves::Afar(afar) => afar.eval_parts(light.map(f64::from), observer.map(f64::from), parts) as f32,
            Waves::Tabled(tabled) => tabled.eval_parts(light, observer, parts),
            _ => self.lobe.eval_parts(i, o, None, parts),
        };
        f * o[2].max(0.0)
    }

    fn at(&self, place: &Place) -> Spot {
        let mut lobe = self.lobe;
        let footprint = (!place.footprint.is_nan()).then(|| f64::from(place.footprint));
        if let (Some(table), Some(_)) = (&self.single_facets, footprint) {
            table.set(&mut lobe.facets, place.footprint);
        }
        let mut n = None;
        if let Waves::Drawn(sea) = &self.waves {
            let spot = sea.spot(place.place, footprint);
            n = Some(spot.normal.map(|x| x as f32));
            lobe = lobe.with_whitecaps(spot.whitecap as f32);
        }
        if !place.whitecaps.is_nan() {
            lobe = lobe.with_whitecaps(place.whitecaps.clamp(0.0, 1.0));
        }
        Spot { lobe, n }
    }
}

fn parts(bits: u32) -> Parts {
    Parts { facets: bits & 1 != 0, whitecaps: bits & 2 != 0 }
}

/// f cos(theta_o) of the parts in `bits` (1 facets, 2 whitecaps), about the normal (0, 0, 1), where all places are alike.
/// The path runs to the light, which is then at `o`, or comes from it.
#[unsafe(no_mangle)]
pub extern "C" fn prob_water_bsdf_eval(
    water: &Water,
    bits: u32,
    i: &[f32; 3],
    o: &[f32; 3],
    to_light: bool,
) -> f32 {
    water.eval(*i, *o, parts(bits), to_light)
}

/// Density, 1/sr, with which [`prob_water_bsdf_sample`] draws `o`.
#[unsafe(no_mangle)]
pub extern "C" fn prob_water_bsdf_pdf(water: &Water, bits: u32, i: &[f32; 3], o: &[f32; 3]) -> f32 {
    water.lobe.pdf_parts(*i, *o, None, parts(bits))
}

/// Draws a direction from three uniform numbers; the sample's `f` is f cos(theta_o).
#[unsafe(no_mangle)]
pub extern "C" fn prob_water_bsdf_sample(
    water: &Water,
    bits: u32,
    i: &[f32; 3],
    u: &[f32; 3],
    to_light: bool,
    sample: &mut Sample<f32>,
) {
    *sample = water.lobe.sample_parts(*i, None, *u, parts(bits));
    sample.f = match water.waves {
        Waves::Afar(_) | Waves::Tabled(_) => water.eval(*i, sample.direction, parts(bits), to_light),
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

/// rho of Eqs. 61-63.
#[unsafe(no_mangle)]
pub extern "C" fn prob_water_reflectance(water: &Water, cos: f32) -> f32 {
    water.lobe.facets.reflectance.eval(f64::from(cos)) as f32
}

/// As [`prob_water_bsdf_eval`].
#[unsafe(no_mangle)]
pub extern "C" fn prob_water_spot_eval(spot: &Spot, bits: u32, i: &[f32; 3], o: &[f32; 3]) -> f32 {
    spot.lobe.on_wave(*i, *o, spot.n, parts(bits))
}

/// As [`prob_water_bsdf_pdf`].
#[unsafe(no_mangle)]
pub extern "C" fn prob_water_spot_pdf(spot: &Spot, bits: u32, i: &[f32; 3], o: &[f32; 3]) -> f32 {
    if i[2] > 0.0 && o[2] > 0.0 { spot.lobe.pdf_parts(*i, *o, spot.n, parts(bits)) } else { 0.0 }
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
