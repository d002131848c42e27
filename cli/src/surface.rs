//! `prob-water surface`: a drawn sea, as points of its surface, as the waves it is made of, or as their bounds.

use crate::input::{self, Columns, STRIDE};
use crate::progress::Progress;
use crate::table::{self, Cell, Table};
use crate::{Outcome, files, parameters};
use clap::{Arg, ArgAction, ArgGroup, ArgMatches, Command, value_parser};
use prob_water::config::LONGEST_TIME;
use prob_water::statistics::FARTHEST;
use prob_water::surface::Component;
use prob_water::{Draws, Ensemble, Error, RealisedSurface, Surface};
use std::f64::consts::TAU;
use std::path::PathBuf;

/// The subcommand's flags.
pub fn command() -> Command {
    Command::new("surface")
        .about("Points of a drawn sea, the waves it is made of, or their bounds")
        .arg(
            Arg::new("points")
                .long("points")
                .value_name("FILE.csv")
                .value_parser(value_parser!(PathBuf))
                .help("the surface at the points of a CSV file, header x,y (m) and optionally time (s); - is standard input"),
        )
        .arg(
            Arg::new("grid")
                .long("grid")
                .value_name("NX,NY,STEP")
                .value_parser(grid)
                .allow_hyphen_values(true)
                .help("the surface at NX by NY points STEP m apart, from the origin towards +x and +y"),
        )
        .arg(
            Arg::new("waves")
                .long("waves")
                .action(ArgAction::SetTrue)
                .help("the waves themselves"),
        )
        .arg(
            Arg::new("bounds")
                .long("bounds")
                .action(ArgAction::SetTrue)
                .help("height and slope that the waves nowhere exceed (Eqs. 42-45)"),
        )
        .group(ArgGroup::new("what").args(["points", "grid", "waves", "bounds"]).required(true))
        .arg(
            Arg::new("instance")
                .long("instance")
                .value_name("I")
                .value_parser(value_parser!(u64))
                .default_value("0")
                .help("which of the seas that the seed draws"),
        )
        .arg(
            Arg::new("draws")
                .long("draws")
                .value_name("HOW")
                .value_parser(["random", "sobol", "stratified"])
                .default_value("random")
                .help("how the random numbers are spread: over the instances (random, sobol), or evenly over the spectrum (stratified)"),
        )
        .arg(
            Arg::new("fade")
                .long("fade")
                .action(ArgAction::SetTrue)
                .help("waves fade out in an octave about two footprints instead of ending there, as on a mesh"),
        )
        .args(table::flags())
        .args(parameters::flags_and_from(Surface::Instance))
}

/// Points of a grid, row by row along x.
#[derive(Clone)]
struct Grid {
    size: [u64; 2],
    step: f64,
}

const MOST_POINTS: u64 = 100_000_000;

fn grid(text: &str) -> Result<Grid, String> {
    let fields: Vec<_> = text.split(',').map(str::trim).collect();
    let [nx, ny, step] = fields[..] else { return Err("expected NX,NY,STEP".into()) };
    let count = |text: &str| text.parse().map_err(|_| format!("{text} is not a whole number"));
    let size @ [nx, ny]: [u64; 2] = [count(nx)?, count(ny)?];
    let step: f64 = step.parse().map_err(|_| format!("{step} is not a number"))?;
    if !(1..=MOST_POINTS).contains(&nx.saturating_mul(ny)) {
        return Err(format!("allowed is 1 to {MOST_POINTS} points"));
    }
    if !(step > 0.0 && step * nx.max(ny) as f64 <= FARTHEST) {
        return Err(format!("allowed is a step above 0 m, and points at most {FARTHEST:e} m from 0"));
    }
    Ok(Grid { size, step })
}

/// Writes the points asked for, the waves or the bounds.
pub fn run(matches: &ArgMatches) -> Outcome {
    let file = matches.get_one::<PathBuf>("points");
    files::apart(matches, file.map(PathBuf::as_path))?;
    let water = parameters::water_on(&[Surface::Instance], matches)?;
    let fade = matches.get_flag("fade");
    let draws = match matches.get_one::<String>("draws").expect("has a default").as_str() {
        "stratified" => Draws::Stratified,
        "sobol" => Draws::Sobol,
        _ => Draws::Random,
    };
    let (waves, onset) = if fade {
        (water.fading_waves(), water.fading_whitecap_onset(water.footprint))
    } else {
        (water.waves(), water.whitecap_onset())
    };
    let sea = Sea {
        all: Ensemble { waves, onset, draws, ..Ensemble::new(&water)? },
        instance: *matches.get_one("instance").expect("has a default"),
        fade,
    };
    if let Some(Grid { size: [nx, ny], step }) = matches.get_one("grid") {
        let time = sea.all.water.parameters.time;
        let rows = (0..*ny).flat_map(|j| (0..*nx).map(move |i| (i, j)));
        sea.write(matches, nx * ny, rows.map(|(i, j)| [i as f64 * step, j as f64 * step, time]))
    } else if let Some(path) = file {
        let points = points(&input::read(path)?, sea.all.water.parameters.time)?;
        sea.write(matches, points.len() as u64, points.into_iter())
    } else if matches.get_flag("waves") {
        sea.write_waves(matches)
    } else {
        sea.write_bounds(matches)
    }
}

const POINTS: Columns =
    Columns { known: &["x", "y", "time"], needed: |_| 2, expected: "expected x,y and optionally time" };

/// How far from 0 each column may be.
const MOST: [(f64, &str); 3] = [(FARTHEST, "m"), (FARTHEST, "m"), (LONGEST_TIME, "s")];

/// x, y, m, and time, s, of every row; `now` where the file gives no time.
fn points(input: &[u8], now: f64) -> Result<Vec<[f64; 3]>, String> {
    let mut points = Vec::new();
    let check = |values: &[f64]| {
        let point = [values[0], values[1], values.get(2).copied().unwrap_or(now)];
        for ((parameter, value), (most, unit)) in POINTS.known.iter().zip(point).zip(MOST) {
            if value.is_nan() || value.abs() > most {
                let allowed = format!("finite, at most {most:e} {unit} from 0");
                return Err(Error::OutOfRange { parameter, value: value.to_string(), allowed }.to_string());
            }
        }
        points.push(point);
        Ok(())
    };
    POINTS.parse(input, |_| (), check)?;
    Ok(points)
}

/// One of the seas that a seed draws.
struct Sea {
    all: Ensemble,
    instance: u64,
    fade: bool,
}

const COLUMNS: [&str; 11] =
    ["time", "x", "y", "height", "slope_x", "slope_y", "nx", "ny", "nz", "acceleration", "whitecap"];
const WAVES: [&str; 6] =
    ["wave_number_rad_m", "wavelength_m", "phase_rad", "azimuth_rad", "amplitude_m", "frequency_rad_s"];

impl Sea {
    fn components(&self) -> impl Iterator<Item = Component> {
        let footprint = self.all.water.footprint;
        let components = self.all.components(self.instance).1;
        components.map(move |c| if self.fade { c.seen_at(footprint) } else { c })
    }

    /// A row for every x, y, m, and time, s.
    fn write(&self, matches: &ArgMatches, count: u64, points: impl Iterator<Item = [f64; 3]>) -> Outcome {
        let mut now = self.all.water.parameters.time;
        let mut surface = RealisedSurface::new(self.components(), now);
        let progress = Progress::new(count, table::to_file(matches));
        let mut out = Table::new(matches, COLUMNS)?;
        for (row, [x, y, time]) in points.enumerate() {
            if time != now {
                now = time;
                surface.set_time(now);
            }
            let point = surface.point([x, y]);
            let ([slope_x, slope_y], [nx, ny, nz]) = (point.slope, point.normal());
            let whitecap = self.all.whitecap(&surface, [x, y], &point);
            let row_cells =
                [time, x, y, point.height, slope_x, slope_y, nx, ny, nz, point.acceleration, whitecap];
            out.row(&row_cells.map(Cell::Number))?;
            if row % STRIDE == 0 {
                progress.at(row as u64);
            }
        }
        table::end([out])
    }

    fn write_bounds(&self, matches: &ArgMatches) -> Outcome {
        let surface = RealisedSurface::new(self.components(), 0.0);
        let mut out = Table::new(matches, ["highest", "steepest"])?;
        out.row(&[surface.highest(), surface.steepest()].map(Cell::Number))?;
        table::end([out])
    }

    fn write_waves(&self, matches: &ArgMatches) -> Outcome {
        let mut out = Table::new(matches, WAVES)?;
        for wave in self.components() {
            let k = wave.wave_number;
            let cells = [k, TAU / k, wave.phase, wave.azimuth, wave.amplitude, wave.frequency];
            out.row(&cells.map(Cell::Number))?;
        }
        table::end([out])
    }
}
