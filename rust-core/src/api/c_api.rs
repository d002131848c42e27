//! The C interface: an opaque handle, status codes with a message, batch calls over arrays.
//!
//! Nothing panics across it. A configured `ProbWater` is immutable: any number of threads may use
//! the same one at the same time. Vectors are arrays of x, y, z triples, row after row.

use std::cell::RefCell;
use std::ffi::{CStr, CString, c_char, c_double, c_float};
use std::panic::{AssertUnwindSafe, catch_unwind};

use super::batch::{Batched, Columns, Coordinates, Quantity, Rows, check_units};
use crate::brdf::polarised::mueller;
use crate::brdf::{Lobe, Parts};
use crate::config::vocabulary::{Builder, Value};
use crate::config::{Surface, Water};
use crate::empirical::{EmpiricalLobe, Table};
use crate::error::Error;
use crate::numeric::Vec3;
use std::path::PathBuf;

/// What a call came to. Anything but OK leaves outputs untouched and a message in
/// `prob_water_last_error`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ProbWaterStatus {
    /// Done.
    Ok = 0,
    /// A parameter is unknown, of the wrong type, out of range, or excluded by another one; or a table is not to be used.
    Parameter = 1,
    /// A row's direction is not a finite unit vector, a normal does not point up, or a uniform number
    /// is outside [0, 1).
    Row = 2,
    /// A pointer is null where it must not be, or a text is not UTF-8.
    Argument = 3,
    /// A defect of this library; the handle stays usable.
    Internal = 4,
}

/// Parameters being collected.
pub struct ProbWaterOptions {
    builder: Builder,
    table: Option<PathBuf>,
}

/// A configured sea.
pub struct ProbWater {
    water: Water,
    /// A line each.
    warnings: CString,
    /// What draws directions; the BRDF itself on a flat surface.
    lobe: Lobe<f64>,
    single: Lobe<f32>,
    empirical: Option<EmpiricalLobe>,
}

/// What the wind and the parameters come to.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ProbWaterSummary {
    /// cm/s
    pub friction_velocity: c_double,
    /// Wind speed at 10 m, m/s.
    pub wind_speed_10: c_double,
    /// Slope variance of the facets along the wind.
    pub sigma_u2: c_double,
    /// Slope variance of the facets across the wind.
    pub sigma_c2: c_double,
    /// Fraction of the water under whitecaps, Eq. 51.
    pub whitecap_fraction: c_double,
    /// Refractive index.
    pub ior: c_double,
}

thread_local! {
    static LAST_ERROR: RefCell<CString> = RefCell::default();
}

fn report(status: ProbWaterStatus, message: &str) -> ProbWaterStatus {
    let text = CString::new(message.replace('\0', " ")).unwrap_or_default();
    LAST_ERROR.with(|last| *last.borrow_mut() = text);
    status
}

/// Runs `body`; an error or a panic becomes a status with a message.
fn guarded(body: impl FnOnce() -> Result<(), (ProbWaterStatus, String)>) -> ProbWaterStatus {
    match catch_unwind(AssertUnwindSafe(body)) {
        Ok(Ok(())) => report(ProbWaterStatus::Ok, ""),
        Ok(Err((status, message))) => report(status, &message),
        Err(_) => report(ProbWaterStatus::Internal, "internal error: a defect of prob-water"),
    }
}

fn refused(error: Error) -> (ProbWaterStatus, String) {
    let status = match error {
        Error::Row { .. } => ProbWaterStatus::Row,
        Error::Length { .. } => ProbWaterStatus::Argument,
        _ => ProbWaterStatus::Parameter,
    };
    (status, error.to_string())
}

fn null(what: &str) -> (ProbWaterStatus, String) {
    (ProbWaterStatus::Argument, format!("{what} is null"))
}

/// # Safety
/// `text` is null or a C string.
unsafe fn utf8<'a>(text: *const c_char, what: &str) -> Result<&'a str, (ProbWaterStatus, String)> {
    if text.is_null() {
        return Err(null(what));
    }
    // SAFETY: not null, and a C string by the caller's contract.
    let text = unsafe { CStr::from_ptr(text) };
    text.to_str().map_err(|_| (ProbWaterStatus::Argument, format!("{what} is not UTF-8")))
}

/// # Safety
/// `data` is null or points at `rows` triples.
unsafe fn triples<'a, T>(
    data: *const T,
    rows: usize,
    what: &str,
) -> Result<&'a [Vec3<T>], (ProbWaterStatus, String)> {
    if rows == 0 {
        return Ok(&[]);
    }
    if data.is_null() {
        return Err(null(what));
    }
    // SAFETY: not null, `rows` triples by the caller's contract; [T; 3] has the layout of three T.
    Ok(unsafe { std::slice::from_raw_parts(data.cast(), rows) })
}

/// # Safety
/// `data` is null or points at three pointers, each null or to `rows` numbers.
unsafe fn coordinates<'a>(
    data: *const *const c_float,
    rows: usize,
    what: &str,
) -> Result<Coordinates<'a>, (ProbWaterStatus, String)> {
    if rows == 0 {
        return Ok([&[]; 3]);
    }
    // SAFETY: by the caller's contract.
    let pointers = unsafe { data.cast::<[*const c_float; 3]>().as_ref() }.ok_or_else(|| null(what))?;
    if pointers.iter().any(|x| x.is_null()) {
        return Err(null(what));
    }
    // SAFETY: not null, `rows` numbers by the caller's contract.
    Ok(pointers.map(|x| unsafe { std::slice::from_raw_parts(x, rows) }))
}

/// # Safety
/// `data` is null or points at `len` elements that nothing else refers to.
unsafe fn output<'a, T>(
    data: *mut T,
    len: usize,
    what: &str,
) -> Result<&'a mut [T], (ProbWaterStatus, String)> {
    if len == 0 {
        return Ok(&mut []);
    }
    if data.is_null() {
        return Err(null(what));
    }
    // SAFETY: not null, `len` elements by the caller's contract.
    Ok(unsafe { std::slice::from_raw_parts_mut(data, len) })
}

/// The message of this thread's last call that was not OK; empty after one that was. Valid until
/// this thread's next call.
#[unsafe(no_mangle)]
pub extern "C" fn prob_water_last_error() -> *const c_char {
    LAST_ERROR.with(|last| last.borrow().as_ptr())
}

/// New options, all at their defaults. Free with `prob_water_options_free`.
#[unsafe(no_mangle)]
pub extern "C" fn prob_water_options_new() -> *mut ProbWaterOptions {
    Box::into_raw(Box::new(ProbWaterOptions { builder: Builder::default(), table: None }))
}

/// Sets a parameter by its name to a value written out: "0.15", "inf", "true", "exact". A value outside of the parameter's own
/// range is refused here, and the earlier one stays. Beside the vocabulary's there is
/// "table", the path of a table of the empirical model for surface "empirical", instead of the library's own.
///
/// # Safety
/// `options` comes from `prob_water_options_new`; `name` and `value` are C strings.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn prob_water_options_set(
    options: *mut ProbWaterOptions,
    name: *const c_char,
    value: *const c_char,
) -> ProbWaterStatus {
    guarded(|| {
        // SAFETY: by this function's contract.
        let options = unsafe { options.as_mut() }.ok_or_else(|| null("options"))?;
        // SAFETY: by this function's contract.
        let (name, value) = unsafe { (utf8(name, "name")?, utf8(value, "value")?) };
        if name == "table" {
            options.table = Some(value.into());
            return Ok(());
        }
        options.builder.set(name, &Value::Text(value.into())).map_err(refused)
    })
}

/// Sets a numeric parameter by its name; refused as by `prob_water_options_set`, NaN among the rest.
///
/// # Safety
/// `options` comes from `prob_water_options_new`; `name` is a C string.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn prob_water_options_set_number(
    options: *mut ProbWaterOptions,
    name: *const c_char,
    value: c_double,
) -> ProbWaterStatus {
    guarded(|| {
        // SAFETY: by this function's contract.
        let options = unsafe { options.as_mut() }.ok_or_else(|| null("options"))?;
        // SAFETY: by this function's contract.
        let name = unsafe { utf8(name, "name")? };
        options.builder.set(name, &Value::Number(value)).map_err(refused)
    })
}

/// Frees options; null is allowed.
///
/// # Safety
/// `options` is null or comes from `prob_water_options_new` and is not used again.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn prob_water_options_free(options: *mut ProbWaterOptions) {
    if !options.is_null() {
        // SAFETY: made by Box::into_raw, and given back once.
        drop(unsafe { Box::from_raw(options) });
    }
}

/// Checks the options and configures a sea. The options stay with the caller. Free the sea with
/// `prob_water_free`.
///
/// # Safety
/// `options` comes from `prob_water_options_new`; `sea` points at a place for the handle.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn prob_water_configure(
    options: *const ProbWaterOptions,
    sea: *mut *mut ProbWater,
) -> ProbWaterStatus {
    guarded(|| {
        // SAFETY: by this function's contract.
        let options = unsafe { options.as_ref() }.ok_or_else(|| null("options"))?;
        // SAFETY: by this function's contract.
        let sea = unsafe { sea.as_mut() }.ok_or_else(|| null("sea"))?;
        let configured = options.builder.parameters().and_then(|p| p.configure());
        let surfaces = [Surface::Flat, Surface::Empirical];
        let water = configured.and_then(|water| water.on(&surfaces)).map_err(refused)?;
        let empirical = match (water.parameters.surface, &options.table) {
            (Surface::Empirical, None) => Some(EmpiricalLobe::new(&water, Table::standard())),
            (Surface::Empirical, Some(path)) => {
                Some(Table::open(path).and_then(|table| EmpiricalLobe::new(&water, &table)))
            }
            (_, Some(path)) => {
                let reason = "has no meaning but with surface = empirical".into();
                return Err(refused(Error::Table { name: path.display().to_string(), reason }));
            }
            _ => None,
        };
        let empirical = empirical.transpose().map_err(refused)?;
        let lobe = match &empirical {
            Some(empirical) => empirical.sampler,
            None => water.lobe().map_err(refused)?,
        };
        let warnings: Vec<_> = water.warnings().iter().map(ToString::to_string).collect();
        let warnings = CString::new(warnings.join("\n")).unwrap_or_default();
        *sea = Box::into_raw(Box::new(ProbWater { water, warnings, lobe, single: lobe.cast(), empirical }));
        Ok(())
    })
}

/// Frees a sea; null is allowed.
///
/// # Safety
/// `sea` is null or comes from `prob_water_configure` and is not used again.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn prob_water_free(sea: *mut ProbWater) {
    if !sea.is_null() {
        // SAFETY: made by Box::into_raw, and given back once.
        drop(unsafe { Box::from_raw(sea) });
    }
}

/// Values of a sea that are allowed but hardly meant, as a mistaken unit makes them: a line each in UTF-8, empty where there
/// are none. Valid as long as the sea; null for a null sea.
///
/// # Safety
/// `sea` is null or comes from `prob_water_configure`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn prob_water_warnings(sea: *const ProbWater) -> *const c_char {
    // SAFETY: by this function's contract.
    unsafe { sea.as_ref() }.map_or(std::ptr::null(), |sea| sea.warnings.as_ptr())
}

/// What the parameters came to.
///
/// # Safety
/// `sea` comes from `prob_water_configure`; `summary` points at a place for the result.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn prob_water_summary(
    sea: *const ProbWater,
    summary: *mut ProbWaterSummary,
) -> ProbWaterStatus {
    guarded(|| {
        // SAFETY: by this function's contract.
        let water = &unsafe { sea.as_ref() }.ok_or_else(|| null("sea"))?.water;
        // SAFETY: by this function's contract.
        let summary = unsafe { summary.as_mut() }.ok_or_else(|| null("summary"))?;
        *summary = ProbWaterSummary {
            friction_velocity: water.wind.friction_velocity,
            wind_speed_10: water.wind.w10,
            sigma_u2: water.variances[0],
            sigma_c2: water.variances[1],
            whitecap_fraction: water.whitecap_fraction,
            ior: water.ior,
        };
        Ok(())
    })
}

/// # Safety
/// The pointers are null or hold `rows` triples, `out` `rows` numbers.
unsafe fn batch<T: Batched>(
    sea: &ProbWater,
    lobe: &Lobe<T>,
    quantity: Quantity,
    rows: usize,
    [to_source, to_observer, normals]: [*const T; 3],
    out: *mut T,
) -> Result<(), (ProbWaterStatus, String)> {
    // SAFETY: by this function's contract.
    let (i, o, out) = unsafe {
        (
            triples(to_source, rows, "to_source")?,
            triples(to_observer, rows, "to_observer")?,
            output(out, rows, "out")?,
        )
    };
    // SAFETY: by this function's contract.
    let n = if normals.is_null() { None } else { Some(unsafe { triples(normals, rows, "normals")? }) };
    let checked = Rows::new(i, o, n).map_err(refused)?;
    let table = sea.empirical.as_ref();
    if table.is_some() && n.is_some() {
        return Err((ProbWaterStatus::Argument, "normals have no meaning with surface = empirical".into()));
    }
    match (quantity, table) {
        (Quantity::Brdf, Some(table)) => checked.each(out, |_, i, o, _| table.eval(i, o)),
        (Quantity::Brdf, None) => checked.eval(lobe, out),
        (Quantity::Density, _) => checked.pdf(lobe, out),
    }
    .map_err(refused)
}

/// # Safety
/// As [`batch`]; `sea` is null or a handle.
unsafe fn with_sea(
    sea: *const ProbWater,
    body: impl FnOnce(&ProbWater) -> Result<(), (ProbWaterStatus, String)>,
) -> ProbWaterStatus {
    // SAFETY: by this function's contract.
    guarded(|| body(unsafe { sea.as_ref() }.ok_or_else(|| null("sea"))?))
}

/// The BRDF f, 1/sr, of every row in float64: unit vectors to the source and to the observer, and
/// wave normals, or null for a flat sea, as an empirical one always is. A direction below the horizon gives 0.
///
/// # Safety
/// `sea` comes from `prob_water_configure`; the vectors hold `rows` triples, `f` `rows` numbers.
/// Outputs overlap neither inputs nor each other.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn prob_water_eval(
    sea: *const ProbWater,
    rows: usize,
    to_source: *const c_double,
    to_observer: *const c_double,
    normals: *const c_double,
    f: *mut c_double,
) -> ProbWaterStatus {
    // SAFETY: by this function's contract.
    unsafe {
        with_sea(sea, |s| batch(s, &s.lobe, Quantity::Brdf, rows, [to_source, to_observer, normals], f))
    }
}

/// The Mueller matrix of every row, 1/sr, 16 numbers row by row, of which the first is f: the BRDF of polarised light. The first axes
/// of Stokes vectors lie in the planes of the vertical and the directions, towards larger angles from the vertical; Q counts along
/// them, U along 45 degrees counter-clockwise for whom the light reaches. Facets reflect by Fresnel's equations, scaled to
/// the parameters' reflectance; whitecaps depolarise.
///
/// # Safety
/// As `prob_water_eval`, but that `matrices` holds `16 rows` numbers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn prob_water_mueller(
    sea: *const ProbWater,
    rows: usize,
    to_source: *const c_double,
    to_observer: *const c_double,
    normals: *const c_double,
    matrices: *mut c_double,
) -> ProbWaterStatus {
    let body = |sea: &ProbWater| {
        let mut f = vec![0.0; rows];
        let inputs = [to_source, to_observer, normals];
        // SAFETY: by this function's contract.
        unsafe { batch(sea, &sea.lobe, Quantity::Brdf, rows, inputs, f.as_mut_ptr())? };
        // SAFETY: by this function's contract.
        let (i, o, out) = unsafe {
            (
                triples(to_source, rows, "to_source")?,
                triples(to_observer, rows, "to_observer")?,
                output(matrices, 16 * rows, "matrices")?,
            )
        };
        // SAFETY: by this function's contract.
        let n = if normals.is_null() { None } else { Some(unsafe { triples(normals, rows, "normals")? }) };
        for (k, (f, out)) in f.iter().zip(out.chunks_exact_mut(16)).enumerate() {
            let foam = match &sea.empirical {
                Some(table) => table.eval_parts(i[k], o[k], Parts::WHITECAPS),
                None => sea.lobe.eval_parts(i[k], o[k], n.map(|n| n[k]), Parts::WHITECAPS),
            };
            let matrix = mueller(&sea.lobe.facets.reflectance, i[k], o[k], [f - foam, foam]);
            out.copy_from_slice(matrix.as_flattened());
        }
        Ok(())
    };
    // SAFETY: by this function's contract.
    unsafe { with_sea(sea, body) }
}

/// `prob_water_eval` in float32.
///
/// # Safety
/// As `prob_water_eval`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn prob_water_eval_f32(
    sea: *const ProbWater,
    rows: usize,
    to_source: *const c_float,
    to_observer: *const c_float,
    normals: *const c_float,
    f: *mut c_float,
) -> ProbWaterStatus {
    // SAFETY: by this function's contract.
    unsafe {
        with_sea(sea, |s| batch(s, &s.single, Quantity::Brdf, rows, [to_source, to_observer, normals], f))
    }
}

/// `prob_water_eval_f32` of directions that lie coordinate by coordinate: three arrays of `rows` numbers each, x, y and z.
/// The fastest form: nothing has to be rearranged for the processor's vectors. Not for a sea with surface "empirical".
///
/// # Safety
/// `sea` comes from `prob_water_configure`; the vectors are three pointers to `rows` numbers, `f` holds `rows` numbers.
/// Outputs overlap neither inputs nor each other.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn prob_water_eval_columns(
    sea: *const ProbWater,
    rows: usize,
    to_source: *const *const c_float,
    to_observer: *const *const c_float,
    normals: *const *const c_float,
    f: *mut c_float,
) -> ProbWaterStatus {
    // SAFETY: by this function's contract.
    unsafe {
        with_sea(sea, |s| {
            let i = coordinates(to_source, rows, "to_source")?;
            let o = coordinates(to_observer, rows, "to_observer")?;
            let n = if normals.is_null() { None } else { Some(coordinates(normals, rows, "normals")?) };
            let f = output(f, rows, "f")?;
            if s.empirical.is_some() {
                let message = "surface = empirical is evaluated row by row: `prob_water_eval_f32`";
                return Err((ProbWaterStatus::Argument, message.into()));
            }
            Columns::new(i, o, n).and_then(|columns| columns.eval(&s.single, f)).map_err(refused)
        })
    }
}

/// The mean of f, 1/sr, of every row by the empirical model, its standard uncertainty, and whether the directions lie
/// outside of the table's grid (1), whose nearest values these are, or not (0).
///
/// # Safety
/// As `prob_water_eval`; `outside` holds `rows` bytes. The sea's surface is "empirical".
#[unsafe(no_mangle)]
pub unsafe extern "C" fn prob_water_estimate(
    sea: *const ProbWater,
    rows: usize,
    to_source: *const c_double,
    to_observer: *const c_double,
    mean: *mut c_double,
    std: *mut c_double,
    outside: *mut u8,
) -> ProbWaterStatus {
    // SAFETY: by this function's contract.
    unsafe {
        with_sea(sea, |s| {
            let Some(table) = &s.empirical else {
                let message = "the surface of this sea is not empirical: nothing else has an estimate";
                return Err((ProbWaterStatus::Argument, message.into()));
            };
            let (i, o) = (triples(to_source, rows, "to_source")?, triples(to_observer, rows, "to_observer")?);
            let (mean, std) = (output(mean, rows, "mean")?, output(std, rows, "std")?);
            let outside = output(outside, rows, "outside")?;
            Rows::new(i, o, None).map_err(refused)?;
            for row in 0..rows {
                let estimate = table.estimate(i[row], o[row]);
                (mean[row], std[row], outside[row]) = (estimate.mean, estimate.std, estimate.outside.into());
            }
            Ok(())
        })
    }
}

/// The density, 1/sr, with which `prob_water_sample` draws every row's observer for its source.
///
/// # Safety
/// As `prob_water_eval`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn prob_water_pdf(
    sea: *const ProbWater,
    rows: usize,
    to_source: *const c_double,
    to_observer: *const c_double,
    normals: *const c_double,
    pdf: *mut c_double,
) -> ProbWaterStatus {
    // SAFETY: by this function's contract.
    unsafe {
        with_sea(sea, |s| batch(s, &s.lobe, Quantity::Density, rows, [to_source, to_observer, normals], pdf))
    }
}

/// Draws an observer's direction for every row's source from three uniform numbers of [0, 1) a
/// row, about a flat sea; writes it with its density and f. A density of 0 marks a draw without a
/// direction.
///
/// # Safety
/// `sea` comes from `prob_water_configure`; `to_source`, `uniforms` and `to_observer` hold `rows`
/// triples, `pdf` and `f` `rows` numbers. Outputs overlap neither inputs nor each other.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn prob_water_sample(
    sea: *const ProbWater,
    rows: usize,
    to_source: *const c_double,
    uniforms: *const c_double,
    to_observer: *mut c_double,
    pdf: *mut c_double,
    f: *mut c_double,
) -> ProbWaterStatus {
    // SAFETY: by this function's contract.
    unsafe {
        with_sea(sea, |s| {
            let (i, u) = (triples(to_source, rows, "to_source")?, triples(uniforms, rows, "uniforms")?);
            let o = output(to_observer.cast::<Vec3<f64>>(), rows, "to_observer")?;
            let (pdf, f) = (output(pdf, rows, "pdf")?, output(f, rows, "f")?);
            check_units("to_source", i).map_err(refused)?;
            if let Some(row) = u.iter().position(|u| !u.iter().all(|x| (0.0..1.0).contains(x))) {
                let message = format!("row {}: uniforms = {:?} are not in [0, 1)", row + 1, u[row]);
                return Err((ProbWaterStatus::Row, message));
            }
            for row in 0..rows {
                let sample = s.lobe.sample(i[row], None, u[row]);
                let value = match &s.empirical {
                    Some(table) if sample.pdf > 0.0 => table.eval(i[row], sample.direction),
                    _ => sample.f,
                };
                (o[row], pdf[row], f[row]) = (sample.direction, sample.pdf, value);
            }
            Ok(())
        })
    }
}
