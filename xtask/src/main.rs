//! The project's own commands, run as `cargo xtask <command>`. Each does what it needs first, so that on a fresh
//! machine with Rust, Python 3 and g++ a single one is enough.

mod bench;
mod build;
mod c_api;
mod cargo;
mod compat;
mod equations;
mod errors;
mod figures;
mod fuzz;
mod parameters;
mod render;
mod sanitize;
mod setup;
mod stress;
mod test;
mod tidy;
mod util;

use anyhow::{Result, bail};
use std::process::ExitCode;

const HELP: &str = "\
The commands of prob-water, each run as `cargo xtask <command>`:

  setup             create .venv and install validation/requirements.txt in it
  build [--out DIR] build the Mitsuba plugin into DIR/plugins (default: target/mitsuba)
  render [--quality preview|final] [--variant V] [--only NAME]
                    build, then render the review images into out/ (options of validation/render/review.py)
  figures [--quick] [--only NAME]
                    build the command and draw the report's figures into out/report/ (options of validation/figures/draw.py)
  errors [--quick]  write docs/error-budget.md: every stage in float64 and float32 against 50 digits
  test              run every check: Rust, C, plugin, Python, style
  verify            the long campaigns: more samples, the live peer, stress, fuzz, sanitize and
                    compat below, the tables docs/float32.md and docs/error-budget.md
  stress [--count N] [--seconds S] [--seed K]
                    adversarial and random seas and directions against every lobe (1e9 evaluations unless told)
  fuzz [TARGET] [--seconds S]
                    coverage-guided fuzzing of toml, table, c_abi and csv, a minute each unless told
  sanitize          the C programs under valgrind and with sanitizers, the plugin with the address sanitizer
  compat            load the plugin into other versions of Mitsuba (.venv-3.9.0, ...), which must refuse it
  header [--check]  write rust-core/include/prob_water.h, or only check that it is current
  parameters [--check]
                    write the tables of parameters in README.md, docs/ and the plugin's documentation from the one list in
                    rust-core, or only check that they are current
  equations [--check]
                    write the index of the report's equations in ARCHITECTURE.md from rust-core's comments, or only check it
  examples          run the examples of the library, rust-core/examples
  tidy              check rust-core's source: modules use only those above them, no circles, no public item without a comment;
                    validation's: folders use only those above them, no circles, no test is imported;
                    and that no file of the repository is long without a reason
  c-test            compile and run the C programs of rust-core/tests/c and rust-core/examples
  bench [OPTIONS]   build, set up the peers and measure: tables, and out/bench.html (options of validation/bench/run.py)
  bench fronts      only run time against error, the time to 1 % of rendering included
  bench compare A.json B.json
                    the ratio of every figure; fails where B is worse than the spreads explain
  bench off         what costs nothing: instructions and kernels of what is switched off
  bench surface     time and memory of the shape at 1, 4 and 16 million vertices (--vertices N ...)
  peer              create .venv-peer and install validation/requirements-peer.txt in it
  help              print this

The environment variables PYTHON (used when an environment is created), CXX and CC replace python3, g++ and cc.";

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    match dispatch(&arguments) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error:#}");
            ExitCode::FAILURE
        }
    }
}

fn dispatch(arguments: &[String]) -> Result<()> {
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    if words.first().is_some_and(|word| ["-h", "--help"].contains(word)) {
        println!("{HELP}");
        return Ok(());
    }
    match words[..] {
        [] | ["help"] => println!("{HELP}"),
        ["setup"] => setup::setup()?,
        ["peer"] => setup::peer()?,
        ["build"] => build::build(&build::default_out())?,
        ["build", "--out", directory] => build::build(&std::path::absolute(directory)?)?,
        ["render", ..] => render::render(&arguments[1..])?,
        ["figures", ..] => figures::figures(&arguments[1..])?,
        ["errors", ..] => errors::errors(&arguments[1..])?,
        ["bench", ..] => bench::bench(&arguments[1..])?,
        ["test"] => test::test()?,
        ["verify"] => test::verify()?,
        ["stress", ..] => stress::stress(&arguments[1..])?,
        ["fuzz", ..] => fuzz::fuzz(&arguments[1..])?,
        ["sanitize"] => sanitize::sanitize()?,
        ["compat"] => compat::compat()?,
        ["header"] => c_api::header(false)?,
        ["header", "--check"] => c_api::header(true)?,
        ["parameters"] => parameters::parameters(false)?,
        ["parameters", "--check"] => parameters::parameters(true)?,
        ["equations"] => equations::equations(false)?,
        ["equations", "--check"] => equations::equations(true)?,
        ["examples"] => test::examples()?,
        ["tidy"] => tidy::tidy()?,
        ["c-test"] => c_api::c_test()?,
        _ => bail!("`{}` is not understood; `cargo xtask help` lists the commands", words.join(" ")),
    }
    Ok(())
}
