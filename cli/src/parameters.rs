//! The vocabulary of parameters as flags.

use clap::{Arg, ArgMatches};
use prob_water::vocabulary::{Builder, ENTRIES, Value};
use prob_water::{Surface, Water};

/// One flag per parameter: its name with dashes, its unit and its default on a surface.
pub fn flags(surface: Surface) -> impl Iterator<Item = Arg> {
    let defaults = Builder::on(surface).parameters().expect("defaults");
    ENTRIES.iter().map(move |entry| {
        let default = defaults.get(entry.name).map(|value| format!(" [default: {value}]"));
        Arg::new(entry.name)
            .long(entry.name.replace('_', "-"))
            .value_name(if entry.unit.is_empty() { "value" } else { entry.unit })
            .help(format!("{}{}", entry.help, default.unwrap_or_default()))
            .help_heading("Parameters")
            .allow_hyphen_values(true)
    })
}

/// The names of all flags, for what excludes them.
pub fn names() -> impl Iterator<Item = &'static str> {
    ENTRIES.iter().map(|entry| entry.name)
}

/// The parameters given as flags.
pub fn given(matches: &ArgMatches) -> Vec<(&'static str, Value)> {
    names().filter_map(|name| Some((name, Value::Text(matches.get_one::<String>(name)?.clone())))).collect()
}

/// The sea that the flags describe.
pub fn water(matches: &ArgMatches) -> Result<Water, String> {
    build(Builder::default(), matches).map_err(|e| e.to_string())
}

/// The same, on one of the surfaces that a subcommand knows: the first unless told.
pub fn water_on(surfaces: &[Surface], matches: &ArgMatches) -> Result<Water, String> {
    let water = build(Builder::on(surfaces[0]), matches).and_then(|water| water.on(surfaces));
    water.map_err(|e| e.to_string())
}

fn build(mut builder: Builder, matches: &ArgMatches) -> Result<Water, prob_water::Error> {
    for (name, value) in given(matches) {
        builder.set(name, &value)?;
    }
    builder.parameters()?.configure()
}
