//! Calls of the C interface, decoded from bytes: any order, null pointers, any text, any numbers. Each answers with a
//! status; none but OK writes, and none is Internal.
#![no_main]

mod abi;

use abi::*;
use libfuzzer_sys::arbitrary::{self, Arbitrary, Result, Unstructured};
use libfuzzer_sys::fuzz_target;
use prob_water::vocabulary::ENTRIES;
use std::ffi::{CStr, CString};
use std::ptr::{null, null_mut};

/// Seas and options that a sequence may hold at a time.
const HELD: usize = 4;
/// Rows of a batch.
const MOST_ROWS: usize = 8;
const OK: i32 = 0;
const INTERNAL: i32 = 4;

#[derive(Arbitrary, Debug)]
enum Call<'a> {
    NewOptions,
    FreeOptions(u8),
    Set(u8, u8, &'a [u8]),
    SetAny(u8, &'a [u8], &'a [u8]),
    SetNumber(u8, u8, f64),
    Configure(u8),
    FreeSea(u8),
    Summary(u8),
    Eval(u8, Rows),
    EvalSingle(u8, Rows),
    EvalColumns(u8, Rows),
    Pdf(u8, Rows),
    Sample(u8, Rows),
    Estimate(u8, Rows),
}

/// Rows of vectors, some of them made unit ones so that not all are refused, and which pointers are null.
#[derive(Debug)]
struct Rows {
    count: usize,
    vectors: [Vec<f64>; 3],
    nulls: u8,
}

impl<'a> Arbitrary<'a> for Rows {
    fn arbitrary(bytes: &mut Unstructured<'a>) -> Result<Self> {
        let (count, nulls) = (bytes.int_in_range(0..=MOST_ROWS)?, bytes.arbitrary::<u8>()?);
        let mut vectors: [Vec<f64>; 3] = Default::default();
        for vectors in &mut vectors {
            for _ in 0..count {
                let mut v: [f64; 3] = bytes.arbitrary()?;
                if bytes.ratio(7u8, 8u8)? {
                    v = v.map(|x| if x.is_finite() { x % 2.0 } else { 0.0 });
                    let length = (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt();
                    v = if length > 0.0 { v.map(|x| x / length) } else { [0.0, 0.0, 1.0] };
                }
                vectors.extend(v);
            }
        }
        // Null pointers now and then.
        Ok(Self { count, vectors, nulls: if nulls < 192 { 0 } else { nulls } })
    }
}

impl Rows {
    fn input(&self, at: usize) -> *const f64 {
        if self.nulls >> at & 1 == 1 { null() } else { self.vectors[at].as_ptr() }
    }

    fn singles(&self) -> [Vec<f32>; 3] {
        self.vectors.each_ref().map(|v| v.iter().map(|x| *x as f32).collect())
    }
}

/// What a batch wrote: untouched by a refusal, finite and not negative else.
fn written(status: i32, out: &[f64]) {
    for x in out {
        match status {
            OK => assert!(x.is_finite() && *x >= 0.0, "{x}"),
            _ => assert!(*x == UNTOUCHED, "{x}"),
        }
    }
}

const UNTOUCHED: f64 = -7.0;

/// A status that may be, with a message where it is not OK.
fn answered(status: i32) -> i32 {
    assert!((OK..INTERNAL).contains(&status), "status {status}");
    // SAFETY: the message is valid until the next call.
    let message = unsafe { CStr::from_ptr(prob_water_last_error()) };
    assert_eq!(message.is_empty(), status == OK);
    status
}

/// The words that values are mostly made of.
const WORDS: [&str; 12] = [
    "inf",
    "NaN",
    "true",
    "false",
    "exact",
    "slope",
    "as_printed",
    "empirical",
    "fresh",
    "slopes",
    "1e-3",
    "-0",
];

fuzz_target!(|calls: Vec<Call>| {
    let mut options = [null_mut(); HELD];
    let mut seas = [null_mut(); HELD];
    for call in calls.iter().take(64) {
        // SAFETY: handles are null or alive, arrays as long as the counts say.
        unsafe { run(call, &mut options, &mut seas) };
    }
    for (options, sea) in options.into_iter().zip(seas) {
        // SAFETY: as above; neither is used again.
        unsafe {
            prob_water_options_free(options);
            prob_water_free(sea);
        }
    }
});

unsafe fn run(call: &Call, options: &mut [*mut Options; HELD], seas: &mut [*mut Sea; HELD]) {
    let at = |which: &u8| usize::from(*which) % HELD;
    // SAFETY: by this function's contract.
    unsafe {
        match call {
            Call::NewOptions => {
                let place = options.iter().position(|o| o.is_null()).unwrap_or(0);
                prob_water_options_free(options[place]);
                options[place] = prob_water_options_new();
            }
            Call::FreeOptions(which) => {
                prob_water_options_free(std::mem::replace(&mut options[at(which)], null_mut()));
            }
            Call::Set(which, name, value) => {
                let name = CString::new(ENTRIES[usize::from(*name) % ENTRIES.len()].name).expect("no zeros");
                let value = match value {
                    [word] => CString::new(WORDS[usize::from(*word) % WORDS.len()]).expect("no zeros"),
                    other => text(other),
                };
                answered(prob_water_options_set(options[at(which)], name.as_ptr(), value.as_ptr()));
            }
            Call::SetAny(which, name, value) => {
                let (name, value) = (text(name), text(value));
                // A path might be anything.
                if name.as_bytes() != b"table" {
                    answered(prob_water_options_set(options[at(which)], name.as_ptr(), value.as_ptr()));
                }
            }
            Call::SetNumber(which, name, value) => {
                let name = CString::new(ENTRIES[usize::from(*name) % ENTRIES.len()].name).expect("no zeros");
                answered(prob_water_options_set_number(options[at(which)], name.as_ptr(), *value));
            }
            Call::Configure(which) => {
                let place = seas.iter().position(|s| s.is_null()).unwrap_or(0);
                prob_water_free(std::mem::replace(&mut seas[place], null_mut()));
                let status = answered(prob_water_configure(options[at(which)], &mut seas[place]));
                assert_eq!(seas[place].is_null(), status != OK);
            }
            Call::FreeSea(which) => prob_water_free(std::mem::replace(&mut seas[at(which)], null_mut())),
            Call::Summary(which) => {
                let mut summary = [UNTOUCHED; 6];
                written(answered(prob_water_summary(seas[at(which)], &mut summary)), &summary);
                let warnings = prob_water_warnings(seas[at(which)]);
                assert_eq!(warnings.is_null(), seas[at(which)].is_null());
                assert!(warnings.is_null() || CStr::from_ptr(warnings).to_str().is_ok());
            }
            Call::Eval(which, rows) => {
                let mut f = vec![UNTOUCHED; rows.count];
                let [i, o, n] = [0, 1, 2].map(|k| rows.input(k));
                written(answered(prob_water_eval(seas[at(which)], rows.count, i, o, n, f.as_mut_ptr())), &f);
            }
            Call::EvalSingle(which, rows) => {
                let mut f = vec![UNTOUCHED as f32; rows.count];
                let [i, o, n] = rows.singles();
                let n = if rows.nulls & 4 != 0 { null() } else { n.as_ptr() };
                let (i, o, out) = (i.as_ptr(), o.as_ptr(), f.as_mut_ptr());
                let status = answered(prob_water_eval_f32(seas[at(which)], rows.count, i, o, n, out));
                written(status, &f.into_iter().map(f64::from).collect::<Vec<_>>());
            }
            Call::EvalColumns(which, rows) => {
                let mut f = vec![UNTOUCHED as f32; rows.count];
                let columns = rows.singles().map(|v| [0, 1, 2].map(|k| v.iter().skip(k).step_by(3).copied().collect()));
                let pointers = columns.each_ref().map(|v| v.each_ref().map(|x: &Vec<f32>| x.as_ptr()));
                let [i, o, mut n] = pointers;
                if rows.nulls & 8 != 0 {
                    n[1] = null();
                }
                let normals = if rows.nulls & 4 != 0 { null() } else { n.as_ptr() };
                let (i, o, out) = (i.as_ptr(), o.as_ptr(), f.as_mut_ptr());
                let status = answered(prob_water_eval_columns(seas[at(which)], rows.count, i, o, normals, out));
                written(status, &f.into_iter().map(f64::from).collect::<Vec<_>>());
            }
            Call::Pdf(which, rows) => {
                let mut pdf = vec![UNTOUCHED; rows.count];
                let [i, o, n] = [0, 1, 2].map(|k| rows.input(k));
                written(
                    answered(prob_water_pdf(seas[at(which)], rows.count, i, o, n, pdf.as_mut_ptr())),
                    &pdf,
                );
            }
            Call::Sample(which, rows) => {
                let uniforms: Vec<f64> = rows.vectors[1].iter().map(|x| x.abs()).collect();
                let (mut o, mut pdf, mut f) = (
                    vec![UNTOUCHED; 3 * rows.count],
                    vec![UNTOUCHED; rows.count],
                    vec![UNTOUCHED; rows.count],
                );
                let (i, u) = (rows.input(0), if rows.nulls & 2 != 0 { null() } else { uniforms.as_ptr() });
                let (o_out, pdf_out, f_out) = (o.as_mut_ptr(), pdf.as_mut_ptr(), f.as_mut_ptr());
                let status =
                    answered(prob_water_sample(seas[at(which)], rows.count, i, u, o_out, pdf_out, f_out));
                written(status, &pdf);
                written(status, &f);
                assert!(o.iter().all(|x| x.is_finite()), "{o:?}");
            }
            Call::Estimate(which, rows) => {
                let (mut mean, mut std) = (vec![UNTOUCHED; rows.count], vec![UNTOUCHED; rows.count]);
                let mut outside = vec![7u8; rows.count];
                let (i, o) = (rows.input(0), rows.input(1));
                let (m, s, out) = (mean.as_mut_ptr(), std.as_mut_ptr(), outside.as_mut_ptr());
                let status = answered(prob_water_estimate(seas[at(which)], rows.count, i, o, m, s, out));
                written(status, &mean);
                written(status, &std);
            }
        }
    }
}

/// A C string of any bytes but zeros.
fn text(bytes: &[u8]) -> CString {
    CString::new(bytes.iter().copied().filter(|byte| *byte != 0).collect::<Vec<_>>())
        .expect("no zeros are left")
}
