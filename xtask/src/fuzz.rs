//! Coverage-guided fuzzing with the stable toolchain: the package `fuzz/`, compiled with LLVM's instrumentation.

use crate::util;
use anyhow::{Context, Result, bail};
use std::fs;
use std::path::Path;

/// One fuzzer each, with the longest input in bytes.
const TARGETS: [(&str, &str); 4] = [("toml", "4096"), ("table", "16384"), ("c_abi", "2048"), ("csv", "4096")];

/// What cargo-fuzz passes to rustc, without the address sanitizer, which is not in the stable toolchain, and without dead
/// code, some of which does not compile.
const INSTRUMENTATION: &str = "-Cpasses=sancov-module -Cllvm-args=-sanitizer-coverage-level=4 \
                               -Cllvm-args=-sanitizer-coverage-inline-8bit-counters \
                               -Cllvm-args=-sanitizer-coverage-pc-table \
                               -Cllvm-args=-sanitizer-coverage-trace-compares -Ccodegen-units=1 \
                               --cfg fuzzing -Cdebug-assertions";

/// An input that takes longer, in seconds, or a single allocation of more, in MiB, is a failure.
const SLOWEST: &str = "60";
const LARGEST_ALLOCATION: &str = "512";
const MEMORY: &str = "4096";

/// Builds the fuzzers, lays out seeds, and runs those that are named (else all) for so many seconds each. Where they
/// cannot be built it says so in a line, which is no failure.
pub fn fuzz(arguments: &[String]) -> Result<()> {
    let (mut seconds, mut wanted) = ("60", vec![]);
    let mut words = arguments.iter().map(String::as_str);
    while let Some(word) = words.next() {
        match word {
            "--seconds" => seconds = words.next().context("--seconds needs a number")?,
            name if TARGETS.iter().any(|(known, _)| *known == name) => wanted.push(name),
            other => bail!(
                "{other} is unknown: known are {}, --seconds S",
                TARGETS.map(|(name, _)| name).join(", ")
            ),
        }
    }
    let seconds: u32 =
        seconds.parse().with_context(|| format!("--seconds {seconds} is not a whole number"))?;
    if seconds == 0 {
        bail!("--seconds 0 would never end: at least 1");
    }
    if let Err(reason) = can_instrument() {
        println!("fuzz: skipped: {reason:#}");
        return Ok(());
    }
    build()?;
    let seeds = util::root().join("target/fuzz-seeds");
    lay_out(&seeds)?;
    for (name, longest) in TARGETS.iter().filter(|(name, _)| wanted.is_empty() || wanted.contains(name)) {
        run(name, longest, seconds, &seeds.join(name))?;
    }
    Ok(())
}

fn host() -> Result<String> {
    let version = util::output(util::command(util::program("RUSTC", "rustc")).arg("-vV"), "rustc -vV")?;
    let host = version.lines().find_map(|line| line.strip_prefix("host: ")).context("rustc names no host")?;
    Ok(host.into())
}

/// Whether there is a C++ compiler, and a Rust one that passes the instrumentation on, tried on an empty library.
fn can_instrument() -> Result<()> {
    util::cxx()?;
    let directory = util::root().join("target/fuzz-probe");
    util::create_dir(&directory)?;
    let empty = directory.join("empty.rs");
    fs::write(&empty, "pub fn nothing() {}\n")
        .with_context(|| format!("cannot write {}", empty.display()))?;
    let mut rustc = util::command(util::program("RUSTC", "rustc"));
    rustc.args(INSTRUMENTATION.split_whitespace()).args(["--crate-type", "lib", "--out-dir"]);
    util::output(rustc.arg(&directory).arg(&empty), "instrumenting with this Rust compiler").map(drop)
}

fn build() -> Result<()> {
    println!("fuzz: building (some minutes the first time)");
    // With a target named, build scripts and macros are not instrumented.
    util::run(
        util::cargo()
            .args(["build", "--release", "--quiet", "--manifest-path", "fuzz/Cargo.toml"])
            .args(["--target", &host()?, "--target-dir", "target/fuzz"])
            .env("RUSTFLAGS", INSTRUMENTATION),
        "building the fuzzers with this toolchain",
    )
}

fn run(name: &str, longest: &str, seconds: u32, seeds: &Path) -> Result<()> {
    let corpus = util::root().join("target/fuzz-corpus").join(name);
    let found = util::root().join("target/fuzz-found").join(name);
    for directory in [&corpus, &found] {
        util::create_dir(directory)?;
    }
    println!("fuzz: {name} for {seconds} s");
    let program = util::root().join("target/fuzz").join(host()?).join("release").join(name);
    let log = found.with_extension("log");
    let mut command = util::command(program);
    command
        .arg(&corpus)
        .arg(seeds)
        .arg(format!("-max_total_time={seconds}"))
        .arg(format!("-artifact_prefix={}/", found.display()))
        .arg(format!("-max_len={longest}"))
        .args([format!("-timeout={SLOWEST}"), format!("-malloc_limit_mb={LARGEST_ALLOCATION}")])
        .arg(format!("-rss_limit_mb={MEMORY}"))
        .args(["-print_final_stats=1", "-verbosity=0"])
        .stderr(fs::File::create(&log).with_context(|| format!("cannot write {}", log.display()))?);
    let result =
        util::run(&mut command, &format!("fuzzing {name} (the input is in {})", util::shown(&found)));
    let said = String::from_utf8_lossy(&read(&log)?).into_owned();
    let lines: Vec<&str> = said.lines().collect();
    if result.is_err() {
        // The message of a panic comes early, the end is the stack.
        let first =
            lines.iter().position(|line| line.contains("panicked") || line.contains("ERROR")).unwrap_or(0);
        println!("{}", lines[first..lines.len().min(first + 40)].join("\n"));
    }
    let told = |name: &str| lines.iter().find_map(|line| line.strip_prefix(name)).unwrap_or_default().trim();
    let (runs, added) = (told("stat::number_of_executed_units:"), told("stat::new_units_added:"));
    println!("fuzz: {name}: {runs} inputs, {added} of them new to the corpus");
    result
}

/// Seeds of the project's own examples: scenarios, scene files, tables and rows.
fn lay_out(seeds: &Path) -> Result<()> {
    let root = util::root();
    let mut files: Vec<(&str, String, Vec<u8>)> = Vec::new();
    for path in util::files_with_extension(&root.join("scenes/engagements"), "toml")? {
        files.push(("toml", util::shown(&path).to_string(), read(&path)?));
    }
    for (name, text) in SEAS {
        files.push(("toml", name.into(), text.into()));
    }
    for (name, rows) in ROWS {
        files.push(("csv", name.into(), rows.into()));
    }
    for (name, bytes) in CALLS {
        files.push(("c_abi", name.into(), bytes.into()));
    }
    files.push(("table", "empty_zip".into(), [b"PK\x05\x06".as_slice(), &[0; 18]].concat()));
    for (target, name, bytes) in files {
        let directory = seeds.join(target);
        util::create_dir(&directory)?;
        let path = directory.join(name.replace(['/', '\\'], "_"));
        fs::write(&path, bytes).with_context(|| format!("cannot write {}", path.display()))?;
    }
    table_seed(&seeds.join("table"))
}

fn read(path: &Path) -> Result<Vec<u8>> {
    fs::read(path).with_context(|| format!("cannot read {}", path.display()))
}

/// A whole table of a few nodes, made by the command.
fn table_seed(directory: &Path) -> Result<()> {
    let file = directory.join("small.npz");
    if file.exists() {
        return Ok(());
    }
    let axes = "--friction-velocities 8,9 --footprints 0.15 --incidences 0,80 --wind-azimuths 0,180 \
                --angles=-60,0,30,80 --instances 16";
    util::run(
        util::cargo()
            .args(["run", "--release", "--quiet", "-p", "prob-water-cli", "--", "table", "build"])
            .arg(&file)
            .args(axes.split_whitespace()),
        "making a small table",
    )
}

const SEAS: [(&str, &str); 4] = [
    ("flat", "friction_velocity = 8\nfootprint = 0.15\nwhitecaps = false\nslope_measure = \"slope\"\n"),
    ("model", "[model]\nwind_speed = 7.5\nwind_height = 19.5\nior = 1.33\nsurface = \"ensemble\"\n"),
    (
        "track",
        "[model]\nbeaufort = 4\nseed = 7\n[[engagement]]\ntimes = [0, 1]\nlaser = [[-5.0, 0, 9], [-6, 0, 9]]\n\
         direction = [1, 0, -1]\nobservers = [[5.0, 0, 9], [[1, 2, 3], [4, 5, 6]]]\n",
    ),
    (
        "exact",
        "statistics = \"exact\"\nlimits = [0.1]\n[model]\nwind_speed = 0\n[[engagement]]\nlaser = [0, 0, 9]\n\
         target = [1, 0, 0]\nobservers = [[0, 0, 9]]\n",
    ),
];

const ROWS: [(&str, &str); 3] = [
    ("flat", "\0ix,iy,iz,ox,oy,oz\n0,0,1,0,0,1\n-0.6,0,0.8,0.6,0,0.8\n"),
    ("normals", "\x02nx,ny,nz,ix,iy,iz,ox,oy,oz\n0,0.6,0.8,0,0,1,0,0,1\n0,0,1,1,0,0,\"1\",0,-0\n"),
    ("places", "\x01ix,iy,iz,ox,oy,oz,x,y\r\n0,0,1,0,0,1,1e3,-7\r\n"),
];

/// New options, a wind, a sea, rows: what the bytes mean is up to the fuzzer, which finds the rest.
const CALLS: [(&str, &[u8]); 2] = [("empty", b""), ("some", &[0; 256])];
