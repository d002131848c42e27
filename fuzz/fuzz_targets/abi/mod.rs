//! The C interface as `rust-core/include/prob_water.h` declares it. The functions are the core's, which is linked in.

use prob_water as _;
use std::ffi::{c_char, c_double, c_float};

/// Opaque.
#[repr(C)]
pub struct Options([u8; 0]);
/// Opaque.
#[repr(C)]
pub struct Sea([u8; 0]);

unsafe extern "C" {
    pub fn prob_water_last_error() -> *const c_char;
    pub fn prob_water_options_new() -> *mut Options;
    pub fn prob_water_options_set(options: *mut Options, name: *const c_char, value: *const c_char) -> i32;
    pub fn prob_water_options_set_number(options: *mut Options, name: *const c_char, value: c_double) -> i32;
    pub fn prob_water_options_free(options: *mut Options);
    pub fn prob_water_configure(options: *const Options, sea: *mut *mut Sea) -> i32;
    pub fn prob_water_free(sea: *mut Sea);
    pub fn prob_water_summary(sea: *const Sea, summary: *mut [c_double; 6]) -> i32;
    pub fn prob_water_warnings(sea: *const Sea) -> *const c_char;
    pub fn prob_water_eval(
        sea: *const Sea,
        rows: usize,
        to_source: *const c_double,
        to_observer: *const c_double,
        normals: *const c_double,
        f: *mut c_double,
    ) -> i32;
    pub fn prob_water_eval_f32(
        sea: *const Sea,
        rows: usize,
        to_source: *const c_float,
        to_observer: *const c_float,
        normals: *const c_float,
        f: *mut c_float,
    ) -> i32;
    pub fn prob_water_eval_columns(
        sea: *const Sea,
        rows: usize,
        to_source: *const *const c_float,
        to_observer: *const *const c_float,
        normals: *const *const c_float,
        f: *mut c_float,
    ) -> i32;
    pub fn prob_water_pdf(
        sea: *const Sea,
        rows: usize,
        to_source: *const c_double,
        to_observer: *const c_double,
        normals: *const c_double,
        pdf: *mut c_double,
    ) -> i32;
    pub fn prob_water_sample(
        sea: *const Sea,
        rows: usize,
        to_source: *const c_double,
        uniforms: *const c_double,
        to_observer: *mut c_double,
        pdf: *mut c_double,
        f: *mut c_double,
    ) -> i32;
    pub fn prob_water_estimate(
        sea: *const Sea,
        rows: usize,
        to_source: *const c_double,
        to_observer: *const c_double,
        mean: *mut c_double,
        std: *mut c_double,
        outside: *mut u8,
    ) -> i32;
}
