//! `prob-water parameters`: the vocabulary itself.

use crate::Outcome;
use crate::table::{self, Cell, Table};
use clap::{ArgMatches, Command};
use prob_water::vocabulary::ENTRIES;

/// The subcommand's flags.
pub fn command() -> Command {
    Command::new("parameters")
        .about("Every parameter: name, unit, default, what is allowed, the surfaces it matters to")
        .args(table::flags())
}

const COLUMNS: [&str; 7] = ["name", "unit", "default", "kind", "allowed", "surfaces", "meaning"];

/// One row for every parameter.
pub fn run(matches: &ArgMatches) -> Outcome {
    let mut out = Table::new(matches, COLUMNS)?;
    for entry in &ENTRIES {
        let surfaces: Vec<_> = entry.surfaces.iter().map(|surface| surface.name()).collect();
        out.row(&[
            Cell::Text(entry.name),
            Cell::Text(entry.unit),
            Cell::Text(entry.default),
            Cell::Text(entry.kind.name()),
            Cell::Text(entry.allowed),
            Cell::Text(&surfaces.join(" ")),
            Cell::Text(entry.help),
        ])?;
    }
    table::end([out])
}
