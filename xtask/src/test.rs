//! Everything that must hold, one step after the other, with a table of the steps at the end.
//!
//! The style checks come last: a newer toolchain may warn of more, and that must not hide whether the numbers are right.

use crate::{
    build, c_api, cargo, compat, equations, errors, fuzz, parameters, sanitize, setup, stress, tidy, util,
};
use anyhow::{Result, bail};
use std::fs::{self, File};
use std::process::Child;
use std::sync::Mutex;
use std::time::{Duration, Instant};

struct Step {
    name: &'static str,
    run: fn() -> Result<Outcome>,
}

enum Outcome {
    Passed,
    Skipped(&'static str),
}
use Outcome::{Passed, Skipped};

const STEPS: [Step; 14] = [
    Step { name: "compile", run: compile },
    Step { name: "cargo test", run: cargo_test },
    Step { name: "examples", run: || examples().map(|()| Passed) },
    Step { name: "tidy", run: || tidy::tidy().map(|()| Passed) },
    Step { name: "header check", run: || c_api::header(true).map(|()| Passed) },
    Step { name: "parameters", run: || parameters::tables(true).map(|()| Passed) },
    Step { name: "equations", run: || equations::equations(true).map(|()| Passed) },
    Step { name: "C program", run: || c_api::c_test().map(|()| Passed) },
    Step { name: "valgrind", run: valgrind },
    Step { name: "stress", run: || stress::slice().map(|()| Passed) },
    Step { name: "plugin build", run: || plugin_build().map(|()| Passed) },
    Step { name: "pytest", run: || pytest(&[]).map(|()| Passed) },
    Step { name: "cargo fmt", run: cargo_fmt },
    Step { name: "cargo clippy", run: clippy_result },
];

/// Runs the steps up to the first that fails.
pub fn test() -> Result<()> {
    let start = Instant::now();
    let mut rows: Vec<(&str, String, Duration)> = Vec::new();
    let mut failure = None;
    *CLIPPY.lock().expect("no step panics") = start_clippy()?;
    for (number, step) in STEPS.iter().enumerate() {
        println!("\n== {}/{} {}", number + 1, STEPS.len(), step.name);
        let step_start = Instant::now();
        let result = match (step.run)() {
            Ok(Passed) => "passed".into(),
            Ok(Skipped(reason)) => format!("skipped: {reason}"),
            Err(error) => {
                failure = Some(format!("{}: {error:#}", step.name));
                "FAILED".into()
            }
        };
        rows.push((step.name, result, step_start.elapsed()));
        if failure.is_some() {
            break;
        }
    }

    if let Some(mut clippy) = CLIPPY.lock().expect("no step panics").take() {
        clippy.kill()?;
    }

    println!("\n{:<14} {:>9}  result", "step", "time");
    for (name, result, duration) in &rows {
        println!("{name:<14} {:>9}  {result}", util::seconds(*duration));
    }
    for step in &STEPS[rows.len()..] {
        println!("{:<14} {:>9}  not run", step.name, "-");
    }
    println!("{:<14} {:>9}", "total", util::seconds(start.elapsed()));
    match failure {
        Some(failure) => bail!("{failure}"),
        None => Ok(()),
    }
}

/// Clippy, which runs beside the compiler while that leaves a processor idle.
static CLIPPY: Mutex<Option<Child>> = Mutex::new(None);

/// What it writes.
const CLIPPY_LOG: &str = "target/clippy.log";

/// Whatever later steps run, once and together: the library, its tests, the command, the campaigns, the plugin's part of Rust.
/// Meanwhile the Python packages that later steps need are fetched.
fn compile() -> Result<Outcome> {
    std::thread::scope(|scope| {
        let setup = scope.spawn(setup::setup);
        util::run(util::cargo().arg("build").args(cargo::everything()), "cargo build")?;
        setup.join().expect("does not panic")
    })?;
    Ok(Passed)
}

fn cargo_test() -> Result<Outcome> {
    util::run(util::cargo().arg("test").args(cargo::USERS), "cargo test")?;
    util::run(util::cargo().args(["test", "--quiet", "-p", "xtask"]), "cargo test of xtask")?;
    Ok(Passed)
}

fn plugin_build() -> Result<()> {
    build::build_with(&build::default_out(), &cargo::everything(), &[])
}

/// Runs the examples of the library; each must succeed and print something.
pub fn examples() -> Result<()> {
    let programs = cargo::examples()?;
    if programs.is_empty() {
        bail!("there are no examples");
    }
    for program in programs {
        let name = util::shown(&program).to_string();
        let printed = util::output(&mut util::command(&program), &name)?;
        if printed.is_empty() {
            bail!("{name} prints nothing");
        }
        println!("examples: {name}: {} lines", printed.lines().count());
    }
    Ok(())
}

/// With the command and the campaigns as they were built, on all processors, four at most: each worker has a Mitsuba.
fn pytest(options: &[&str]) -> Result<()> {
    let workers = std::thread::available_parallelism().map_or(1, |n| n.get().min(4)).to_string();
    util::run(
        setup::module("pytest")
            .args(["validation", "-q", "-rs", "-p", "no:cacheprovider", "--dist", "loadfile", "-n", &workers])
            .args(options)
            .env("PYTHONDONTWRITEBYTECODE", "1"),
        "pytest",
    )
}

/// The campaigns that are too long for every change: the whole of the stress campaign, fuzzing and memory checkers; ray
/// casting and exact statistics against draws, the Python checks with many more samples and the live peer, other versions of
/// Mitsuba, and the error table of docs/float32.md.
pub fn verify() -> Result<()> {
    let ignored = [
        "test",
        "--release",
        "-p",
        "prob-water",
        "--tests",
        "--",
        "--ignored",
        "--nocapture",
        "--test-threads",
        "1",
    ];
    util::run(util::cargo().args(ignored), "the long Rust tests")?;
    stress::stress(&[])?;
    fuzz::fuzz(&[])?;
    c_api::c_test()?;
    sanitize::sanitize()?;
    compat::compat()?;
    setup::peer()?;
    compile()?;
    pytest(&["--full", "-s", "-n", "0"])?;
    util::run(&mut setup::module("validation.error_budget.float32"), "validation.error_budget.float32")?;
    errors::errors(&[])
}

fn valgrind() -> Result<Outcome> {
    Ok(if sanitize::valgrind()? { Passed } else { Skipped("valgrind is not installed") })
}

fn cargo_fmt() -> Result<Outcome> {
    if !util::succeeds(util::cargo().args(["fmt", "--version"])) {
        return Ok(Skipped("not installed"));
    }
    util::run(util::cargo().args(["fmt", "--all", "--check"]), "cargo fmt --check")?;
    Ok(Passed)
}

fn start_clippy() -> Result<Option<Child>> {
    if !util::succeeds(util::cargo().args(["clippy", "--version"])) {
        return Ok(None);
    }
    let log = util::root().join(CLIPPY_LOG);
    util::create_dir(log.parent().expect("a file lies in a directory"))?;
    let arguments =
        ["clippy", "--quiet", "--workspace", "--all-targets", "--all-features", "--", "-D", "warnings"];
    let mut command = util::cargo();
    command.args(arguments).stderr(File::create(&log)?);
    Ok(Some(command.spawn().map_err(|error| util::not_started(&command, error))?))
}

fn clippy_result() -> Result<Outcome> {
    let Some(mut clippy) = CLIPPY.lock().expect("no step panics").take() else {
        return Ok(Skipped("not installed"));
    };
    let status = clippy.wait()?;
    print!("{}", fs::read_to_string(util::root().join(CLIPPY_LOG))?);
    if !status.success() {
        bail!("cargo clippy failed ({status})");
    }
    Ok(Passed)
}
