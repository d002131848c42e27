//! `prob-water table show`: what a table is, and what it says of a sea.

use super::axis::{self, Axis};
use crate::files::{self, Destination};
use crate::table::{self as rows, Cell};
use crate::{Outcome, parameters};
use clap::{Arg, ArgAction, ArgMatches, Command, value_parser};
use prob_water::brdf::Parts;
use prob_water::planes::Planes;
use prob_water::{EmpiricalLobe, Surface, Table, Water};
use serde_json::{Value, json};
use std::borrow::Cow;
use std::fmt::Write as _;
use std::io::Write as _;
use std::path::PathBuf;

/// The subcommand's flags.
pub fn command() -> Command {
    let parameters = parameters::flags_and_from(Surface::Empirical).map(|arg| match arg.get_id().as_str() {
        "wind_direction" => arg.visible_alias("wind-azimuth").help(
            "azimuth the wind comes from, counted from the plane of incidence, away from the source [default: 0]",
        ),
        _ => arg,
    });
    Command::new("show")
        .about("What a table of the empirical model is; with --incidence or --widths, what it says of a sea")
        .after_help(
            "Without --incidence and --widths: parameters, grid and units of the table, as text or, with --json, as one JSON \
             object. With --incidence: mean and standard uncertainty of f, 1/sr (Eqs. 90-91), the share of whitecaps in view, and \
             outside = 1 where the directions are beyond the table's grid. The source stands towards -x.",
        )
        .arg(
            Arg::new("npz")
                .value_name("TABLE.npz")
                .value_parser(value_parser!(PathBuf))
                .help("the table [default: the built-in one]"),
        )
        .arg(
            Arg::new("incidence")
                .long("incidence")
                .value_name("degrees")
                .value_parser(incidence)
                .allow_hyphen_values(true)
                .help("f in the plane of incidence, for a source at this angle of incidence, 0 to below 90"),
        )
        .arg(
            Arg::new("across_plane")
                .long("across-plane")
                .action(ArgAction::SetTrue)
                .requires("incidence")
                .help("f across the plane instead, through the specular direction"),
        )
        .arg(
            Arg::new("angles")
                .long("angles")
                .value_name(axis::VALUE)
                .value_parser(axis::even)
                .requires("incidence")
                .allow_hyphen_values(true)
                .help(
                    "angles theta_r, or phi_r with --across-plane, degrees between -90 and 90 \
                     [default: the table's theta_r; -60:60:61 across the plane]",
                ),
        )
        .arg(
            Arg::new("widths")
                .long("widths")
                .action(ArgAction::SetTrue)
                .conflicts_with("incidence")
                .help(
                    "sigma(0) and delta of the lobe across the plane with their uncertainties (Eqs. 89-91), by incidence and \
                     azimuth, at the table's friction velocity and footprint that are nearest to the sea's",
                ),
        )
        .args(rows::flags())
        .args(parameters)
}

fn incidence(text: &str) -> Result<f64, String> {
    let x: f64 = text.trim().parse().map_err(|_| "it is not a number")?;
    if (0.0..90.0).contains(&x) { Ok(x) } else { Err("allowed is 0 to below 90 degrees".into()) }
}

/// Writes what is asked for.
pub fn run(matches: &ArgMatches) -> Outcome {
    let npz = matches.get_one::<PathBuf>("npz");
    files::apart(matches, npz.map(PathBuf::as_path))?;
    let table = match npz {
        Some(path) => Cow::Owned(Table::open(path)?),
        None => Cow::Borrowed(Table::standard()),
    };
    let incidence = matches.get_one::<f64>("incidence");
    if incidence.is_none() && !matches.get_flag("widths") {
        let of_a_sea = parameters::names().chain([parameters::FROM]).find(|name| matches.contains_id(name));
        if let Some(name) = of_a_sea {
            let flag = name.replace('_', "-");
            return Err(
                format!("--{flag} tells of a sea: say with --incidence or --widths what to show").into()
            );
        }
        return describe(matches, &table);
    }
    let water = parameters::water_on(&[Surface::Empirical], matches)?;
    match incidence {
        Some(degrees) => slice(matches, &table, &water, *degrees),
        None => widths(matches, &table, &water),
    }
}

/// f at angles in the plane of incidence, or across it.
fn slice(matches: &ArgMatches, table: &Table, water: &Water, incidence: f64) -> Outcome {
    let lobe = EmpiricalLobe::new(water, table)?;
    let (sin, cos) = incidence.to_radians().sin_cos();
    let planes = Planes::new([-sin, 0.0, cos], water.parameters.wind_direction.to_radians())
        .with_readings(water.parameters.readings);
    let across = matches.get_flag("across_plane");
    let angles = match matches.get_one::<Axis>("angles") {
        Some(given) => given.values.clone(),
        None if across => (-30..=30).map(|k| 2.0 * f64::from(k)).collect(),
        None => table.grid.theta_r.clone(),
    };
    if let Some(angle) = angles.iter().find(|angle| angle.abs() >= 90.0) {
        return Err(
            format!("--angles: {angle} is out of range: allowed is between -90 and 90 degrees").into()
        );
    }
    let angle = if across { "phi_r_deg" } else { "theta_r_deg" };
    let mut out = rows::Table::new(matches, [angle, "mean", "std", "whitecap", "outside"])?;
    for angle in angles {
        let to = if across { Planes::across } else { Planes::in_plane };
        let (i, o) = (planes.source(), to(&planes, angle.to_radians()));
        let estimate = lobe.estimate(i, o);
        let whitecaps = Parts::WHITECAPS;
        let whitecap = lobe.eval_parts(i, o, whitecaps) / lobe.sampler.whitecap_brdf;
        let numbers = [angle, estimate.mean, estimate.std, whitecap].map(Cell::Number);
        out.row(&[&numbers[..], &[Cell::Count(estimate.outside.into())]].concat())?;
    }
    rows::end([out])
}

const WIDTHS: [&str; 9] = [
    "friction_velocity_cm_s",
    "footprint_m",
    "incidence_deg",
    "wind_azimuth_deg",
    "sigma_deg",
    "u_sigma_deg",
    "delta_deg",
    "u_delta_deg",
    "fitted",
];

/// The lobe's width and offset at the nodes nearest to a sea.
fn widths(matches: &ArgMatches, table: &Table, water: &Water) -> Outcome {
    table.check(water)?;
    let grid = &table.grid;
    let w = nearest(&grid.friction_velocity, water.wind.friction_velocity);
    let d = nearest(&grid.footprint, water.footprint);
    let mut out = rows::Table::new(matches, WIDTHS)?;
    for (i, incidence) in grid.incidence.iter().enumerate() {
        for (a, azimuth) in grid.wind_azimuth.iter().enumerate() {
            let node = table.node([w, d, i, a]);
            let place = [grid.friction_velocity[w], grid.footprint[d], *incidence, *azimuth];
            let widths = [node.sigma, node.u_sigma, node.delta, node.u_delta].map(f64::to_degrees);
            out.row(
                &[&place[..], &widths, &[node.fitted]]
                    .concat()
                    .into_iter()
                    .map(Cell::Number)
                    .collect::<Vec<_>>(),
            )?;
        }
    }
    rows::end([out])
}

/// By ratio.
fn nearest(axis: &[f64], x: f64) -> usize {
    let far = |node: &f64| (node / x).ln().abs();
    let order = |a: &(usize, &f64), b: &(usize, &f64)| far(a.1).total_cmp(&far(b.1));
    axis.iter().enumerate().min_by(order).map_or(0, |(k, _)| k)
}

/// Parameters, grid and units.
fn describe(matches: &ArgMatches, table: &Table) -> Outcome {
    let mut metadata: Value = serde_json::from_str(&table.metadata()).expect("is JSON");
    let g = &table.grid;
    metadata["grid"] = json!({
        "friction_velocity": g.friction_velocity,
        "footprint": g.footprint,
        "incidence": g.incidence,
        "wind_azimuth": g.wind_azimuth,
        "theta_r": g.theta_r,
    });
    let text = if matches.get_flag("json") {
        format!("{metadata:#}\n")
    } else {
        readable(&metadata, g.shape().iter().product())
    };
    let mut out = Destination::open(rows::path(matches, "output"))?;
    out.write_all(text.as_bytes()).and_then(|()| out.flush()).map_err(|e| out.stop(e))?;
    files::keep(vec![out])
}

fn readable(metadata: &Value, nodes: usize) -> String {
    let word = |value: &Value| value.as_str().map_or(value.to_string(), str::to_owned);
    let entries = |name: &str| metadata[name].as_object().expect("is an object").iter();
    let mut text = format!(
        "{}, format version {}, made by prob-water {}\n",
        word(&metadata["format"]),
        metadata["format_version"],
        word(&metadata["prob_water"])
    );
    let mut line = |line: String| writeln!(text, "{line}").expect("a string takes all");
    line(format!("\ngrid, {nodes} nodes:"));
    for (name, axis) in entries("grid") {
        let axis: Vec<_> = axis
            .as_array()
            .expect("is a list")
            .iter()
            .map(|x| x.as_f64().unwrap_or(f64::NAN).to_string())
            .collect();
        line(format!("  {name} ({}): {}", word(&metadata["units"][name]), axis.join(", ")));
    }
    line("\nmade with:".into());
    for (name, value) in entries("parameters") {
        line(format!("  {name} = {}", word(value)));
    }
    line("\nat every node:".into());
    for (name, unit) in entries("units").filter(|(name, _)| metadata["grid"].get(name).is_none()) {
        line(format!("  {name}: {}", word(unit)));
    }
    text
}
