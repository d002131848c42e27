//! `prob-water`: the probabilistic water BRDF on files and pipes. One file per subcommand; the
//! model itself is the library `prob_water`.

mod brdf;
mod output;
mod parameters;
mod progress;
mod wind;

use clap::{ArgMatches, Command};
use std::process::ExitCode;

/// What every subcommand returns; the message becomes one line on standard error.
type Outcome = Result<(), String>;

/// A subcommand: its flags, and what it does with them.
type Subcommand = (fn() -> Command, fn(&ArgMatches) -> Outcome);

const SUBCOMMANDS: [Subcommand; 2] = [(wind::command, wind::run), (brdf::command, brdf::run)];

fn main() -> ExitCode {
    match run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
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
        Err(error) if error.use_stderr() => return Err(condense(&error)),
        // --help and --version; whoever closed the pipe has read enough.
        Err(error) => return error.print().or_else(output::ignore_broken_pipe),
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
