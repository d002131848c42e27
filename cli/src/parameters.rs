//! The vocabulary of parameters as flags.

use clap::{Arg, ArgMatches};
use prob_water::Water;
use prob_water::vocabulary::{Builder, ENTRIES, Entry, Value};

/// One flag per parameter: its name with dashes, its unit and its default.
pub fn flags() -> impl Iterator<Item = Arg> {
    ENTRIES.iter().map(|entry| {
        let default = match entry.default {
            "" => String::new(),
            default => format!(" [default: {default}]"),
        };
        Arg::new(entry.name)
            .long(entry.name.replace('_', "-"))
            .value_name(if entry.unit.is_empty() { "value" } else { entry.unit })
            .help(format!("{}{default}", entry.help))
            .help_heading("Parameters")
            .allow_hyphen_values(true)
    })
}

/// The names of all flags, for what excludes them.
pub fn names() -> impl Iterator<Item = &'static str> {
    ENTRIES.iter().map(|entry| entry.name)
}

/// The sea that the flags describe.
pub fn water(matches: &ArgMatches) -> Result<Water, String> {
    let mut builder = Builder::default();
    let given = |entry: &Entry| Some((entry.name, matches.get_one::<String>(entry.name)?.clone()));
    for (name, text) in ENTRIES.iter().filter_map(given) {
        builder.set(name, &Value::Text(text)).map_err(|e| e.to_string())?;
    }
    builder.parameters().and_then(|p| p.configure()).map_err(|e| e.to_string())
}
