//! The command `prob-water` as a function: the probabilistic water BRDF on files and pipes. One file per subcommand;
//! the model itself is the library `prob_water`.
//!
//! A library only so that fuzzing can call the command within its own process; it promises nothing to anybody else.

mod brdf;
mod empirical_table;
mod files;
mod image;
mod input;
mod model;
mod parameters;
mod parameters_table;
mod progress;
mod scenario;
mod spectrum;
mod surface;
mod table;
mod threads;
mod toml_file;
mod wind;

use clap::{ArgMatches, Command};
use model::Model;
use prob_water::{Surface, Water};
use std::ffi::OsString;
use std::io::ErrorKind;
use std::path::Path;
use toml_file::Document;

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

const SUBCOMMANDS: [Subcommand; 7] = [
    (wind::command, wind::run),
    (spectrum::command, spectrum::run),
    (surface::command, surface::run),
    (brdf::command, brdf::run),
    (scenario::command, scenario::run),
    (empirical_table::command, empirical_table::run),
    (parameters_table::command, parameters_table::run),
];

/// Runs the command with the words of its line, its own name first. A refusal is one line.
pub fn run<Word: Into<OsString> + Clone>(words: impl IntoIterator<Item = Word>) -> Result<(), String> {
    match dispatch(words) {
        Ok(()) | Err(Stop::ReaderLeft) => Ok(()),
        Err(Stop::Refused(message)) => Err(one_line(&message)),
    }
}

/// The sea that the text of a file describes, as `--from` reads it.
pub fn read_sea(text: Vec<u8>) -> Result<Water, String> {
    let document = Document::new("text".into(), text)?;
    let root = document.parse()?;
    let surfaces = [Surface::Flat, Surface::Instance, Surface::Ensemble, Surface::Empirical];
    Model::alone(&document, &root)?.for_surface(&[], &surfaces)?.water(&[], &surfaces)
}

/// Refuses the text of a scenario as `prob-water scenario` does, without working it out.
pub fn check_scenario(text: Vec<u8>) -> Result<(), String> {
    let document = Document::new("text".into(), text)?;
    scenario::check(&document, Path::new("text"))
}

fn dispatch<Word: Into<OsString> + Clone>(words: impl IntoIterator<Item = Word>) -> Outcome {
    let command = Command::new("prob-water")
        .version(env!("CARGO_PKG_VERSION"))
        .about("The probabilistic water BRDF of AFRL-RH-FS-TR-2023-0002")
        .subcommand_required(true)
        .disable_help_subcommand(true)
        .subcommands(SUBCOMMANDS.map(|(command, _)| command()));
    let matches = match command.try_get_matches_from(words) {
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
