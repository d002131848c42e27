//! `prob-water wind`: the wind at every height the model needs, and the report's Table 1.

use crate::table::{self, Cell, Table};
use crate::{Outcome, parameters};
use clap::{Arg, ArgAction, ArgMatches, Command};
use prob_water::Surface;
use prob_water::wind::{TABLE_1, friction_velocity};

/// The subcommand's flags.
pub fn command() -> Command {
    Command::new("wind")
        .about("The wind, the whitecaps and the slopes that follow from the parameters, or Table 1")
        .arg(
            Arg::new("table")
                .long("table")
                .action(ArgAction::SetTrue)
                .conflicts_with_all(parameters::names().chain([parameters::FROM]))
                .help("write the report's Table 1 instead: solved and printed friction velocities"),
        )
        .args(table::flags())
        .args(parameters::flags_and_from(Surface::Flat))
}

/// One row for the given parameters, or all of Table 1.
pub fn run(matches: &ArgMatches) -> Outcome {
    if matches.get_flag("table") { table_1(matches) } else { row(matches) }
}

const ROW: [&str; 11] = [
    "friction_velocity_cm_s",
    "roughness_height_cm",
    "W10_m_s",
    "W12_5_m_s",
    "W19_5_m_s",
    "beaufort",
    "description",
    "whitecap_fraction",
    "sigma_u2",
    "sigma_c2",
    "ior",
];

fn row(matches: &ArgMatches) -> Outcome {
    let all = [Surface::Flat, Surface::Instance, Surface::Ensemble, Surface::Empirical];
    let water = parameters::water_on(&all, matches)?;
    let wind = &water.wind;
    let beaufort = wind.beaufort();
    let mut out = Table::new(matches, ROW)?;
    out.row(&[
        Cell::Number(wind.friction_velocity),
        Cell::Number(wind.roughness_height()),
        Cell::Number(wind.w10),
        Cell::Number(wind.w12_5),
        Cell::Number(wind.w19_5),
        Cell::Count(beaufort as u64),
        Cell::Text(TABLE_1[beaufort].description),
        Cell::Number(water.whitecap_fraction),
        Cell::Number(water.variances[0]),
        Cell::Number(water.variances[1]),
        Cell::Number(water.ior),
    ])?;
    table::end([out])
}

const TABLE: [&str; 6] =
    ["beaufort", "description", "kind", "W10_m_s", "friction_velocity_cm_s", "printed_cm_s"];
const KINDS: [&str; 3] = ["low", "high", "nominal"];

fn table_1(matches: &ArgMatches) -> Outcome {
    let mut out = Table::new(matches, TABLE)?;
    for (beaufort, row) in TABLE_1.iter().enumerate() {
        for ((kind, speed), printed) in KINDS.into_iter().zip(row.wind_speed).zip(row.friction_velocity) {
            let solved = friction_velocity(speed, 10.0).expect("Table 1 is within its own range");
            out.row(&[
                Cell::Count(beaufort as u64),
                Cell::Text(row.description),
                Cell::Text(kind),
                Cell::Number(speed),
                Cell::Number(solved),
                Cell::Given(&format!("{printed:.2}"), printed),
            ])?;
        }
    }
    table::end([out])
}
