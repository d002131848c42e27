//! `--threads`: how many a subcommand works with.

use clap::{Arg, ArgMatches, value_parser};

/// The flag.
pub fn flag() -> Arg {
    Arg::new("threads")
        .long("threads")
        .value_name("N")
        .value_parser(value_parser!(u16).range(1..=1024))
        .help("threads, 1 to 1024; results do not depend on it [default: one for every core]")
}

/// So many, where the flag is given.
pub fn start(matches: &ArgMatches) -> Result<(), String> {
    let Some(threads) = matches.get_one::<u16>("threads") else { return Ok(()) };
    rayon::ThreadPoolBuilder::new()
        .num_threads(usize::from(*threads))
        .build_global()
        .map_err(|e| format!("cannot start {threads} threads: {e}"))
}
