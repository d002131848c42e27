//! `prob-water`: the probabilistic water BRDF on files and pipes. One file per subcommand; the
//! model itself is the library `prob_water`.

mod brdf;
mod empirical_table;
mod files;
mod image;
mod input;
mod model;
mod parameters;
mod progress;
mod scenario;
mod spectrum;
mod surface;
mod table;
mod threads;
mod toml_file;
mod wind;

use clap::{ArgMatches, Command};
use std::io::ErrorKind;
use std::process::ExitCode;

/// Why a subcommand ended early.
enum Stop {
    /// The message becomes one line on standard error.
    Refused(String),
    /// Whoever reads standard output has read enough.
    ReaderLeft,
}

impl From<String> for Stop {
    fn from(message: String) -> Self {
        Stop::Refused(message)
    }
}

impl From<prob_water::Error> for Stop {
    fn from(error: prob_water::Error) -> Self {
        Stop::Refused(error.to_string())
    }
}

/// What every subcommand returns.
type Outcome = Result<(), Stop>;

/// A subcommand: its flags, and what it does with them.
type Subcommand = (fn() -> Command, fn(&ArgMatches) -> Outcome);

const SUBCOMMANDS: [Subcommand; 6] = [
    (wind::command, wind::run),
    (spectrum::command, spectrum::run),
    (surface::command, surface::run),
    (brdf::command, brdf::run),
    (scenario::command, scenario::run),
    (empirical_table::command, empirical_table::run),
];

fn main() -> ExitCode {
    match run() {
        Ok(()) | Err(Stop::ReaderLeft) => ExitCode::SUCCESS,
        Err(Stop::Refused(message)) => {
            eprintln!("prob-water: {}", one_line(&message));
            ExitCode::from(2)
        }
    }
}

fn run() -> Outcome {
    let command = Command::new("prob-water")
        .version(env!("CARGO_PKG_VERSION"))
        .about("The probabilistic water BRDF of AFRL-RH-FS-TR-2023-0002")
        .subcommand_required(true)
        .disable_help_subcommand(true)
        .subcommands(SUBCOMMANDS.map(|(command, _)| command()));
    let matches = match command.try_get_matches() {
        Ok(matches) => matches,
        Err(error) if error.use_stderr() => return Err(condense(&error).into()),
        // --help and --version.
        Err(error) => {
            return error.print().map_err(|e| match e.kind() {
                ErrorKind::BrokenPipe => Stop::ReaderLeft,
                _ => Stop::Refused(format!("cannot write to standard output: {e}")),
            });
        }
    };
    let (name, matches) = matches.subcommand().expect("a subcommand is required");
    let (_, run) =
        SUBCOMMANDS.iter().find(|(command, _)| command().get_name() == name).expect("a known subcommand");
    run(matches)
}

/// clap's first paragraph says what is wrong; usage and tips follow it.
fn condense(error: &clap::Error) -> String {
    let text = error.to_string();
    let first = text.split("\n\n").next().unwrap_or_default();
    first.trim_start_matches("error: ").to_owned()
}

fn one_line(message: &str) -> String {
    message.split_whitespace().collect::<Vec<_>>().join(" ")
}
