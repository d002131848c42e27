//! `prob-water table`: tables of the empirical model, made and shown; and the table that other subcommands use.

mod axis;
mod build;
mod journal;
mod show;

use crate::Outcome;
use clap::{Arg, ArgMatches, Command, value_parser};
use prob_water::{EmpiricalLobe, Error, Table, Water};
use std::path::{Path, PathBuf};

/// The subcommand's own subcommands.
pub fn command() -> Command {
    Command::new("table")
        .about("Tables of the empirical model (surface = empirical): make one, or show what it holds")
        .subcommand_required(true)
        .disable_help_subcommand(true)
        .subcommands([build::command(), show::command()])
}

/// Makes a table, or shows one.
pub fn run(matches: &ArgMatches) -> Outcome {
    match matches.subcommand().expect("a subcommand is required") {
        ("build", matches) => build::run(matches),
        (_, matches) => show::run(matches),
    }
}

/// Why it may be refused.
pub const MEANINGLESS: &str = "--table has no meaning but with surface = empirical";

/// The flag of other subcommands that names a table.
pub const FLAG: &str = "table";

/// That flag.
pub fn flag() -> Arg {
    Arg::new(FLAG)
        .long(FLAG)
        .value_name("TABLE.npz")
        .value_parser(value_parser!(PathBuf))
        .help("with --surface empirical: the table to use [default: the built-in one]")
}

/// The table that the flag names.
pub fn given(matches: &ArgMatches) -> Option<&Path> {
    matches.get_one::<PathBuf>(FLAG).map(PathBuf::as_path)
}

/// A sea by a table, or by the built-in one.
pub fn lobe(water: &Water, table: Option<&Path>) -> Result<EmpiricalLobe, Error> {
    match table {
        Some(path) => EmpiricalLobe::new(water, &Table::open(path)?),
        None => EmpiricalLobe::new(water, Table::standard()),
    }
}
