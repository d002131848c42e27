//! The stress campaign: adversarial and random seas and directions, and whatever may not happen to any of them.
//!
//! `cargo run --release -p prob-water-measure --bin stress -- [--count N] [--seconds S] [--seed K]`, or
//! `cargo xtask stress`. The closed form gets `--count` evaluations of f (1e9 unless told); what costs more gets fewer of
//! its own ([`PARTS`]). With `--seconds` every part stops after its share of them.
//!
//! Work is cut into blocks, each drawn from the seed and its own number: what is found does not depend on the number of
//! threads. A violation tells its block, the sea and the bits of the row; `--part NAME --block B` runs one block again.
//! The exit status is 1 if there was any.

mod closed_form;
mod draw;
mod means;
mod rows;
mod surfaces;
mod tally;

use draw::Draw;
use rayon::prelude::*;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::process::ExitCode;
use std::time::{Duration, Instant};
use tally::{SHOWN, Tally};

/// A kind of evaluation, drawn and checked block by block.
struct Part {
    name: &'static str,
    /// Its evaluations for one of the closed form's.
    share: f64,
    /// Of the time that `--seconds` allows.
    time: f64,
    /// Blocks that are drawn before the next look at the clock.
    batch: u64,
    block: fn(&mut Draw, &mut Tally),
}

const PARTS: [Part; 7] = [
    Part { name: "closed form", share: 1.0, time: 0.55, batch: 16, block: closed_form::block },
    Part {
        name: "facets by footprint",
        share: 1e-2,
        time: 0.1,
        batch: 16,
        block: means::facets_by_footprint,
    },
    Part { name: "empirical", share: 1e-2, time: 0.1, batch: 16, block: means::empirical },
    Part { name: "ensemble", share: 1e-3, time: 0.1, batch: 2, block: means::ensemble },
    Part { name: "instance", share: 1e-3, time: 0.05, batch: 16, block: surfaces::instance },
    Part { name: "ray casts", share: 1e-4, time: 0.05, batch: 16, block: surfaces::casts },
    Part { name: "statistics", share: 1e-5, time: 0.05, batch: 2, block: surfaces::statistics },
];

struct Options {
    count: f64,
    seconds: f64,
    seed: u64,
    part: Option<String>,
    block: Option<u64>,
}

fn main() -> ExitCode {
    let options = match options() {
        Ok(options) => options,
        Err(message) => {
            eprintln!("stress: {message}");
            return ExitCode::from(2);
        }
    };
    let start = Instant::now();
    println!("seed {}, {} threads", options.seed, rayon::current_num_threads());
    println!("{:<22}{:>16}{:>11}{:>9}  what", "part", "evaluations", "violations", "time");
    let mut failed = false;
    for part in &PARTS {
        if options.part.as_ref().is_some_and(|name| name != part.name) {
            continue;
        }
        let start = Instant::now();
        let tally = run(part, &options);
        failed |= tally.violations() > 0;
        tally.print(part.name, start.elapsed());
    }
    let verdict = if failed { "VIOLATIONS, see above" } else { "no violation" };
    println!("{verdict}; {:.1} s", start.elapsed().as_secs_f64());
    ExitCode::from(u8::from(failed))
}

fn options() -> Result<Options, String> {
    let mut options = Options { count: 1e9, seconds: f64::INFINITY, seed: 1, part: None, block: None };
    let mut words = std::env::args().skip(1);
    while let Some(flag) = words.next() {
        let value = words.next().ok_or(format!("{flag} needs a value"))?;
        let number = || {
            let number = value.parse().ok().filter(|x: &f64| *x > 0.0);
            number.ok_or(format!("{flag} {value} is not a number above 0"))
        };
        let whole = || value.parse::<u64>().map_err(|_| format!("{flag} {value} is not a whole number"));
        match flag.as_str() {
            "--count" => options.count = number()?,
            "--seconds" => options.seconds = number()?,
            "--seed" => options.seed = whole()?,
            "--part" => options.part = Some(value),
            "--block" => options.block = Some(whole()?),
            _ => {
                return Err(format!(
                    "{flag} is unknown: known are --count, --seconds, --seed, --part, --block"
                ));
            }
        }
    }
    if let Some(name) = options.part.as_ref().filter(|name| PARTS.iter().all(|part| part.name != *name)) {
        let known = PARTS.map(|part| part.name).join(", ");
        return Err(format!("--part {name} is unknown: known are {known}"));
    }
    Ok(options)
}

/// As many blocks as the count or the time allows, summed in their order.
fn run(part: &Part, options: &Options) -> Tally {
    let mut all = Tally::default();
    let mut next = 0;
    let (count, limit) = (options.count * part.share, options.seconds * part.time);
    let limit = if limit.is_finite() { Duration::from_secs_f64(limit) } else { Duration::MAX };
    let start = Instant::now();
    if let Some(block) = options.block {
        return one(part, options.seed, block);
    }
    while all.evaluations() < count && start.elapsed() < limit && all.violations() < SHOWN as u64 {
        let batch: Vec<Tally> =
            (next..next + part.batch).into_par_iter().map(|block| one(part, options.seed, block)).collect();
        next += part.batch;
        batch.into_iter().for_each(|tally| all.add(tally));
    }
    all
}

/// One block; a panic in it is a violation too.
fn one(part: &Part, seed: u64, block: u64) -> Tally {
    let mut tally = Tally::new(block);
    let mut draw = Draw::new(seed, part.name, block);
    if catch_unwind(AssertUnwindSafe(|| (part.block)(&mut draw, &mut tally))).is_err() {
        tally.violation(&draw.sea(), "panicked", "");
    }
    tally
}
