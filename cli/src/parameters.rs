//! The vocabulary of parameters as flags, and as a file that they stand above.

use crate::model::{self, Flag, Model};
use crate::scenario::settings;
use crate::toml_file::Document;
use crate::{files, image};
use clap::{Arg, ArgMatches, value_parser};
use prob_water::vocabulary::{Builder, ENTRIES, Value};
use prob_water::{Surface, Water};
use std::fs::File;
use std::io::{BufReader, Read};
use std::path::{Path, PathBuf};

/// One flag per parameter, as its row of the vocabulary has it: its name with dashes, its unit, what it is, what is allowed
/// and its default on a surface.
pub fn flags(surface: Surface) -> impl Iterator<Item = Arg> {
    let defaults = Builder::on(surface).parameters().expect("defaults");
    ENTRIES.iter().map(move |entry| {
        let default = defaults.get(entry.name).map(|value| format!(" [default: {value}]"));
        Arg::new(entry.name)
            .long(entry.name.replace('_', "-"))
            .value_name(if entry.unit.is_empty() { "value" } else { entry.unit })
            .help(format!(
                "{}: {}{}",
                entry.help.replace('`', ""),
                entry.allowed,
                default.unwrap_or_default()
            ))
            .help_heading("Parameters")
            .allow_hyphen_values(true)
    })
}

/// The flag that names a file with a sea.
pub const FROM: &str = "from";

/// The flags, and `--from` before them.
pub fn flags_and_from(surface: Surface) -> impl Iterator<Item = Arg> {
    let from = Arg::new(FROM)
        .long(FROM)
        .value_name("FILE")
        .value_parser(value_parser!(PathBuf))
        .help("the sea of a TOML file, a scenario or a rendered OpenEXR image; parameters given as flags stand above it")
        .help_heading("Parameters");
    [from].into_iter().chain(flags(surface))
}

/// The names of all flags, for what excludes them.
pub fn names() -> impl Iterator<Item = &'static str> {
    ENTRIES.iter().map(|entry| entry.name)
}

/// The parameters given as flags.
pub fn given(matches: &ArgMatches) -> Vec<Flag> {
    names().filter_map(|name| Some((name, Value::Text(matches.get_one::<String>(name)?.clone())))).collect()
}

/// The sea that flags and `--from` describe, on one of the surfaces that a subcommand knows: the first unless told.
pub fn water_on(surfaces: &[Surface], matches: &ArgMatches) -> Result<Water, String> {
    Ok(water_and_table(surfaces, matches)?.0)
}

/// The same, and the table of the empirical model that the file of `--from` names.
pub fn water_and_table(
    surfaces: &[Surface],
    matches: &ArgMatches,
) -> Result<(Water, Option<PathBuf>), String> {
    let flags = given(matches);
    match matches.get_one::<PathBuf>(FROM) {
        Some(path) => {
            files::apart(matches, Some(path.as_path()))?;
            let document = open(path)?;
            let root = document.parse()?;
            let model = Model::alone(&document, &root)?.for_surface(&flags, surfaces)?;
            let table = model.table.as_ref().map(|item| settings::table(item, path)).transpose()?;
            files::apart(matches, table.as_deref())?;
            Ok((model.water(&flags, surfaces)?, table))
        }
        None => of_flags(&flags, surfaces).map(|water| (water, None)).map_err(|e| e.to_string()),
    }
}

fn of_flags(flags: &[Flag], surfaces: &[Surface]) -> Result<Water, prob_water::Error> {
    let mut builder = Builder::on(surfaces[0]);
    for (name, value) in flags {
        builder.set(name, value)?;
    }
    model::configure(&builder, surfaces)
}

/// The text of a file, or of a rendered image's attribute.
fn open(path: &Path) -> Result<Document, String> {
    let name = path.display().to_string();
    let refuse = |e: std::io::Error| format!("{name}: cannot be read: {e}");
    let mut file = BufReader::new(File::open(path).map_err(refuse)?);
    let mut start = Vec::new();
    file.by_ref().take(image::MAGIC.len() as u64).read_to_end(&mut start).map_err(refuse)?;
    if start == image::MAGIC {
        let text = image::sea(start.as_slice().chain(file)).map_err(|e| format!("{name}: {e}"))?;
        return Document::new(format!("{name}: {}", image::ATTRIBUTE), text);
    }
    file.read_to_end(&mut start).map_err(refuse)?;
    Document::new(name, start)
}
