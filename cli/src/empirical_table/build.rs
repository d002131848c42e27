//! `prob-water table build`: a table on a grid, row by row, in parallel; stopped, it goes on where it was.

use super::axis::{self, Axis};
use super::journal::{Journal, Rows};
use crate::files::{self, Destination};
use crate::progress::Progress;
use crate::{Outcome, parameters, threads};
use clap::{Arg, ArgMatches, Command, value_parser};
use prob_water::table::{Grid, INSTANCES, Plan};
use prob_water::vocabulary::{Builder, Value};
use prob_water::{Error, Parameters, Surface, Table};
use rayon::prelude::*;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::Mutex;

/// An axis of the grid: its flag, its name, how to read it, its default and its help.
type AxisFlag = (&'static str, &'static str, fn(&str) -> Result<Axis, String>, &'static str, &'static str);

/// In the order of the grid.
const AXES: [AxisFlag; 5] = [
    (
        "friction-velocities",
        "friction_velocity",
        axis::even_in_logarithm,
        "2:62.9:15",
        "w*, cm/s, 0.1 to 238.65; FIRST:LAST:COUNT is even in the logarithm",
    ),
    (
        "footprints",
        "footprint",
        axis::even_in_logarithm,
        "0.02:1:6",
        "D, m, 0.001 to 1000; FIRST:LAST:COUNT is even in the logarithm",
    ),
    (
        "incidences",
        "incidence",
        axis::even,
        "0,10,20,30,40,50,58,65,71,76,81,85",
        "angles of incidence theta_i, degrees, 0 to 89",
    ),
    (
        "wind-azimuths",
        "wind_azimuth",
        axis::even,
        "0:180:9",
        "azimuths the wind comes from, degrees, counted from the plane of incidence, away from the source: \
         from 0 to 180, which the other half mirrors, or a single one for all",
    ),
    (
        "angles",
        "theta_r",
        axis::even,
        "-88,-84,-80,-76,-72,-68,-64,-60,-56,-52,-48,-44,-40,-36,-32,-28,-24,-20,-16,-12,-8,-4,0,4,8,12,16,20,24,28,32,\
         36,40,44,48,52,56,60,64,68,72,76,80,82,84,86,88",
        "angles theta_r in the plane of incidence, degrees from the vertical, -89.9 to 89.9",
    ),
];

/// Parameters that a table has no single value of, and why.
const ELSEWHERE: [(&str, &str); 14] = [
    ("wind_speed", "a table's winds are --friction-velocities"),
    ("wind_height", "a table's winds are --friction-velocities"),
    ("friction_velocity", "a table's winds are --friction-velocities"),
    ("beaufort", "a table's winds are --friction-velocities"),
    ("wind_direction", "a table's winds come from --wind-azimuths"),
    ("footprint", "a table's footprints are --footprints"),
    ("surface", "a table is of the empirical surface"),
    ("average", "a table's mean is the report's, of f"),
    ("across", "it is chosen where the table is used"),
    ("time", "means over drawn waves are the same at all times"),
    ("whitecap_lifetime", "means over drawn waves are of one time"),
    ("swell_height", "drawn seas alone have a swell"),
    ("swell_period", "drawn seas alone have a swell"),
    ("swell_direction", "drawn seas alone have a swell"),
];

/// The subcommand's flags.
pub fn command() -> Command {
    let axes = AXES.map(|(flag, _, parse, default, help)| {
        Arg::new(flag)
            .long(flag)
            .value_name(axis::VALUE)
            .value_parser(parse)
            .default_value(default)
            .allow_hyphen_values(true)
            .help(help)
            .help_heading("Grid")
    });
    let parameters = parameters::flags(Surface::Empirical).map(|arg| {
        let name = arg.get_id().as_str();
        if name == "instances" {
            arg.help(format!("drawn surfaces for every node, 1 to 1000000 [default: {INSTANCES}]"))
        } else {
            let hidden = ELSEWHERE.iter().any(|(elsewhere, _)| *elsewhere == name);
            arg.hide(hidden)
        }
    });
    Command::new("build")
        .about("Makes a table of the empirical model, a NumPy npz file")
        .after_help(
            "Rows that are done are kept beside the output, in OUTPUT.npz.part: stopped in whatever way, the same command \
             goes on from there. The result is the same, byte for byte, whatever the number of threads and of stops, on one kind of processor. \
             The default grid with the default instances takes minutes.",
        )
        .arg(
            Arg::new("npz")
                .value_name("OUTPUT.npz")
                .required(true)
                .value_parser(value_parser!(PathBuf))
                .help("the file to write, whole or not at all"),
        )
        .arg(threads::flag())
        .args(axes)
        .args(parameters)
}

/// Makes what is missing, then writes the table.
pub fn run(matches: &ArgMatches) -> Outcome {
    threads::start(matches)?;
    let (plan, description) = plan(matches)?;
    let given = matches.get_one::<PathBuf>("npz").expect("is required");
    let output = files::resolve(given);
    if given == Path::new("-") || output.exists() && !output.is_file() {
        return Err(format!("OUTPUT.npz = {} is not a file, which a table needs", given.display()).into());
    }
    let mut part = output.clone().into_os_string();
    part.push(".part");
    let part = PathBuf::from(part);
    let (journal, found) = Journal::open(&part, &description, [plan.rows(), plan.row_len()])?;
    files::on_interrupt(format!("stopped; {} has the rows so far: the same command goes on", part.display()));
    let journal = Mutex::new(journal);
    let rows = rows(&plan, &journal, found)?;
    let mut out = Destination::open(Some(&output))?;
    out.write_all(&plan.assemble(&rows)?.to_bytes()).map_err(|e| out.stop(e))?;
    files::keep(vec![out])?;
    journal.into_inner().expect("no thread has panicked").remove()?;
    Ok(())
}

/// All rows: those found, and the others, made in parallel.
fn rows(plan: &Plan, journal: &Mutex<Journal>, found: Rows) -> Result<Vec<Vec<f32>>, String> {
    let done = found.iter().flatten().count();
    let progress = Progress::new(found.len() as u64, true).resumed(done as u64);
    let make = |(row, found)| match found {
        Some(numbers) => Ok(numbers),
        None => {
            let numbers = plan.row(row).map_err(|e| e.to_string())?;
            journal.lock().unwrap().append(row, &numbers)?;
            progress.add(1);
            Ok(numbers)
        }
    };
    found.into_par_iter().enumerate().map(make).collect()
}

/// What the flags describe, and the text that tells it from other tables.
fn plan(matches: &ArgMatches) -> Result<(Plan, String), String> {
    let mut builder = Builder::on(Surface::Empirical);
    let given = parameters::given(matches);
    if let Some((name, why)) = ELSEWHERE.iter().find(|(name, _)| given.iter().any(|(flag, _)| flag == name)) {
        return Err(format!("--{} has no meaning here: {why}", name.replace('_', "-")));
    }
    let instances = [("instances", Value::Number(INSTANCES as f64))];
    for (name, value) in instances.iter().chain(&given) {
        builder.set(name, value).map_err(|e| e.to_string())?;
    }
    let parameters = builder.parameters().map_err(|e| e.to_string())?;
    let [friction_velocity, footprint, incidence, wind_azimuth, theta_r] =
        AXES.map(|(flag, ..)| axis(matches, flag).values.clone());
    let grid = Grid { friction_velocity, footprint, incidence, wind_azimuth, theta_r };
    let plan = Plan::new(&parameters, &grid).map_err(|error| refusal(matches, error))?;
    let description = description(parameters, grid);
    Ok((plan, description))
}

fn axis<'m>(matches: &'m ArgMatches, flag: &str) -> &'m Axis {
    matches.get_one(flag).expect("has a default")
}

/// A refusal by the name of the flag, with what it was given.
fn refusal(matches: &ArgMatches, error: Error) -> String {
    match &error {
        Error::OutOfRange { parameter, allowed, .. } => {
            match AXES.iter().find(|(_, name, ..)| name == parameter) {
                Some((flag, ..)) => {
                    let given = &axis(matches, flag).text;
                    format!("--{flag} = {given} is out of range: allowed is {allowed}")
                }
                None => error.to_string(),
            }
        }
        _ => error.to_string(),
    }
}

/// Two tables with the same description have the same rows.
fn description(parameters: Parameters, grid: Grid) -> String {
    let axes = format!("{grid:?}");
    let version = env!("CARGO_PKG_VERSION").into();
    let empty = Table { version, parameters, grid, in_plane: Default::default(), widths: Default::default() };
    format!("rows of a prob-water table in the making\n{}\n{axes}\n", empty.metadata())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn defaults_are_the_librarys() {
        let defaults = AXES.map(|(_, _, parse, default, _)| parse(default).unwrap().values);
        let Grid { friction_velocity, footprint, incidence, wind_azimuth, theta_r } = Grid::default();
        assert_eq!(defaults, [friction_velocity, footprint, incidence, wind_azimuth, theta_r]);
    }
}
