//! Run time against error of the core, one thread, as lines of JSON: the fronts that `validation/bench/fronts.py` draws.
//!
//! `cargo run --release -p prob-water-measure --bin fronts -- REPEATS DIRECTORY`: every time is measured `REPEATS` times. What
//! others are to compute too (pairs of directions, rays) is written into the directory, with what comes out.

mod brdf;
mod means;
mod waves;

use std::path::Path;
use std::time::Instant;

fn main() {
    let arguments: Vec<_> = std::env::args().skip(1).collect();
    let [repeats, directory] = &arguments[..] else { panic!("REPEATS DIRECTORY") };
    let repeats = repeats.parse().expect("REPEATS is a number");
    let directory = Path::new(directory);
    rayon::ThreadPoolBuilder::new().num_threads(1).build_global().expect("nothing has run in parallel yet");
    brdf::front(repeats, directory);
    means::front(repeats);
    waves::front(repeats, directory);
}

/// Prints a point of a front: what it is, its settings, its error and the seconds that each result took, run by run.
fn point(front: &str, family: &str, setting: &str, error: f64, seconds: &[f64]) {
    let seconds: Vec<_> = seconds.iter().map(|s| format!("{s:e}")).collect();
    println!(
        r#"{{"front": "{front}", "family": "{family}", "setting": "{setting}", "error": {error:e}, "seconds": [{}]}}"#,
        seconds.join(", ")
    );
}

/// Seconds of a run.
fn seconds(run: impl FnOnce()) -> f64 {
    let start = Instant::now();
    run();
    start.elapsed().as_secs_f64()
}

/// Writes numbers as a file of little-endian float64, or float32 where `N` is 4.
fn write<const N: usize>(path: &Path, bytes: impl Iterator<Item = [u8; N]>) {
    let all: Vec<u8> = bytes.flatten().collect();
    std::fs::write(path, all).expect("the directory can be written");
}

/// Root mean square.
fn rms(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0.0, 0.0), |(sum, count), x| (sum + x * x, count + 1.0));
    (sum / count).sqrt()
}
