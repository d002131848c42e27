//! The hot path of the scalar variants, as plain C functions. The parts in `bits` are 1 facets, 2 whitecaps; values are
//! f cos(theta_o), 1/sr.

use crate::parts;
use crate::water::{Water, Waves};
use prob_water::brdf::Parts;
use prob_water::{Lobe, Reflectance, Sample};
use std::mem::MaybeUninit;

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

/// The water at a place, or anywhere.
#[repr(C)]
pub struct Local<'a> {
    water: &'a Water,
    /// The lobe and the wave normal of a place, where places differ.
    own: Option<(Lobe<f32>, Option<[f32; 3]>)>,
}

// The shim keeps it in as many bytes.
const _: () = assert!(size_of::<Local>() <= 256 && align_of::<Local>() <= 16);

/// Two numbers.
#[repr(C)]
pub struct Pair(f32, f32);

impl Water {
    fn local(&self, place: &Place) -> Local<'_> {
        if !self.differs() {
            return Local { water: self, own: None };
        }
        let mut lobe = self.lobe;
        let footprint = (!place.footprint.is_nan()).then(|| f64::from(place.footprint));
        if let (Some(table), Some(_)) = (&self.single_facets, footprint) {
            table.set(&mut lobe.facets, place.footprint);
        }
        let mut normal = None;
        if let Waves::Drawn(sea) = &self.waves {
            let local = sea.local(place.place, footprint);
            normal = Some(local.normal.map(|x| x as f32));
            lobe = lobe.with_whitecaps(local.whitecap as f32);
        }
        if !place.whitecaps.is_nan() {
            lobe = lobe.with_whitecaps(place.whitecaps.clamp(0.0, 1.0));
        }
        Local { water: self, own: Some((lobe, normal)) }
    }

    /// The value. The light is at `o` on a path that runs to it, else at `i`.
    fn eval(&self, i: [f32; 3], o: [f32; 3], parts: Parts, to_light: bool) -> f32 {
        let (light, observer) = if to_light { (o, i) } else { (i, o) };
        let f = match &self.waves {
            Waves::Ensemble(mean) => {
                mean.eval_parts(light.map(f64::from), observer.map(f64::from), parts) as f32
            }
            Waves::Empirical(mean) => mean.eval_parts(light, observer, parts),
            _ => self.lobe.eval_parts(i, o, None, parts),
        };
        f * o[2].max(0.0)
    }

    fn sample(&self, i: [f32; 3], u: [f32; 3], parts: Parts, to_light: bool) -> Sample<f32> {
        let mut sample = self.lobe.sample_parts(i, None, u, parts);
        sample.f = match self.waves {
            Waves::Ensemble(_) | Waves::Empirical(_) => self.eval(i, sample.direction, parts, to_light),
            _ => sample.f * sample.direction[2].max(0.0),
        };
        sample
    }
}

/// A draw whose value is the facets' where they are told apart, and then the value of the whitecaps.
#[repr(C)]
pub struct Apart(Sample<f32>, f32);

/// Lanes of a spectrum, at most.
const LANES: usize = 4;

impl Local<'_> {
    fn eval(&self, i: [f32; 3], o: [f32; 3], parts: Parts, to_light: bool) -> f32 {
        match &self.own {
            Some((lobe, normal)) => lobe.on_wave(i, o, *normal, parts),
            None => self.water.eval(i, o, parts, to_light),
        }
    }

    /// The value of whitecaps, as far as they take part.
    fn whitecaps(&self, i: [f32; 3], o: [f32; 3], parts: Parts, to_light: bool) -> f32 {
        if parts.whitecaps { self.eval(i, o, Parts::WHITECAPS, to_light) } else { 0.0 }
    }

    fn sample(&self, i: [f32; 3], u: [f32; 3], parts: Parts, to_light: bool) -> Sample<f32> {
        let Some((lobe, normal)) = &self.own else {
            return self.water.sample(i, u, parts, to_light);
        };
        let mut sample = lobe.sample_parts(i, *normal, u, parts);
        if sample.direction[2] <= 0.0 {
            sample.pdf = 0.0;
        }
        sample.f = lobe.on_wave(i, sample.direction, *normal, parts);
        sample
    }

    fn lobe(&self) -> &Lobe<f32> {
        self.own.as_ref().map_or(&self.water.lobe, |(lobe, _)| lobe)
    }

    /// For the index of a lane, where lanes differ.
    fn reflectance(&self, index: f32) -> Reflectance<f64> {
        match &self.water.single_dispersion {
            Some(dispersion) => dispersion.reflectance(index),
            None => self.lobe().facets.reflectance,
        }
    }
}

/// The water at a place.
#[unsafe(no_mangle)]
pub extern "C" fn prob_water_place<'a>(water: &'a Water, place: &Place, local: &mut MaybeUninit<Local<'a>>) {
    local.write(water.local(place));
}

/// The value and 0, or where they are told apart that of facets and that of whitecaps. The path runs to the light, which is then at
/// `o`, or comes from it.
#[unsafe(no_mangle)]
pub extern "C" fn prob_water_place_eval(
    local: &Local,
    bits: u32,
    i: &[f32; 3],
    o: &[f32; 3],
    to_light: bool,
    apart: bool,
) -> Pair {
    let parts = parts(bits);
    if !apart {
        return Pair(local.eval(*i, *o, parts, to_light), 0.0);
    }
    let facets = if parts.facets { local.eval(*i, *o, Parts::FACETS, to_light) } else { 0.0 };
    Pair(facets, local.whitecaps(*i, *o, parts, to_light))
}

/// Density, 1/sr, with which [`prob_water_place_sample`] draws `o`.
#[unsafe(no_mangle)]
pub extern "C" fn prob_water_place_pdf(local: &Local, bits: u32, i: &[f32; 3], o: &[f32; 3]) -> f32 {
    match &local.own {
        Some((lobe, normal)) if i[2] > 0.0 && o[2] > 0.0 => lobe.pdf_parts(*i, *o, *normal, parts(bits)),
        Some(_) => 0.0,
        None => local.water.lobe.pdf_parts(*i, *o, None, parts(bits)),
    }
}

/// Draws a direction from three uniform numbers; the sample's `f` is the value.
#[unsafe(no_mangle)]
pub extern "C" fn prob_water_place_sample(
    local: &Local,
    bits: u32,
    i: &[f32; 3],
    u: &[f32; 3],
    to_light: bool,
    apart: bool,
) -> Apart {
    let parts = parts(bits);
    let mut sample = local.sample(*i, *u, parts, to_light);
    if !apart {
        return Apart(sample, 0.0);
    }
    let whitecaps = local.whitecaps(*i, sample.direction, parts, to_light);
    sample.f = if parts.facets { (sample.f - whitecaps).max(0.0) } else { 0.0 };
    Apart(sample, whitecaps)
}

/// The value of light from below for a reflectance of 1 and the index of a lane, where lanes differ, and the density of draws by
/// cosine.
#[unsafe(no_mangle)]
pub extern "C" fn prob_water_place_water_leaving(
    local: &Local,
    i: &[f32; 3],
    o: &[f32; 3],
    index: f32,
) -> Pair {
    let [value, density] = match &local.water.single_dispersion {
        Some(dispersion) => {
            let mut lobe = *local.lobe();
            lobe.facets.reflectance = dispersion.reflectance(index);
            lobe.water_leaving(*i, *o)
        }
        None => local.lobe().water_leaving(*i, *o),
    };
    Pair(value, density)
}

/// m01, m22 and m23 of the facets' Mueller matrix over m00.
#[unsafe(no_mangle)]
pub extern "C" fn prob_water_place_polarisation(
    local: &Local,
    i: &[f32; 3],
    o: &[f32; 3],
    index: f32,
    shares: &mut [f32; 3],
) {
    let [i, o] = [i, o].map(|v| v.map(f64::from));
    *shares = local.reflectance(index).polarised_between(i, o).map(|m| m as f32);
}

/// The indices at wavelengths in nm, and the whitecaps' BRDF over the sea's.
///
/// # Safety
/// The arrays hold `count` numbers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn prob_water_lanes(
    water: &Water,
    count: usize,
    wavelengths: *const f32,
    indices: *mut f32,
    whitecaps: *mut f32,
) {
    for k in 0..count {
        // SAFETY: by this function's contract.
        let wavelength = unsafe { *wavelengths.add(k) };
        let dispersion = water.single_dispersion.as_ref();
        let [index, foam] = dispersion.map_or([f32::NAN, 1.0], |dispersion| dispersion.at(wavelength));
        // SAFETY: by this function's contract.
        unsafe { (*indices.add(k), *whitecaps.add(k)) = (index, foam) };
    }
}

/// The facets' reflectance for the indices of lanes over the sea's.
///
/// # Safety
/// The arrays hold `count` numbers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn prob_water_place_lane_reflectances(
    local: &Local,
    i: &[f32; 3],
    o: &[f32; 3],
    count: usize,
    indices: *const f32,
    ratios: *mut f32,
) {
    // SAFETY: by this function's contract; there is no more than a spectrum's lanes.
    let given = unsafe { std::slice::from_raw_parts(indices, count.min(LANES)) };
    let mut all = [1.0; LANES];
    all[..given.len()].copy_from_slice(given);
    if let Some(dispersion) = &local.water.single_dispersion {
        all = dispersion.ratios(all, *i, *o);
    }
    // SAFETY: by this function's contract.
    unsafe { std::slice::from_raw_parts_mut(ratios, given.len()) }.copy_from_slice(&all[..given.len()]);
}

/// The share of draws for the light from below.
#[unsafe(no_mangle)]
pub extern "C" fn prob_water_place_water_leaving_share(
    local: &Local,
    bits: u32,
    i: &[f32; 3],
    reflectance: f32,
) -> f32 {
    local.lobe().water_leaving_share(*i, reflectance, parts(bits))
}

/// Diffuse reflectance of the whitecaps, and the share of water without any.
#[unsafe(no_mangle)]
pub extern "C" fn prob_water_place_diffuse(local: &Local) -> Pair {
    Pair(local.lobe().whitecap_albedo(), local.lobe().smooth_fraction)
}
