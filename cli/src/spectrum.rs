//! `prob-water spectrum`: the wave energy spectrum and its limits.

use crate::table::{self, Cell, Table};
use crate::{Outcome, parameters};
use clap::{Arg, ArgAction, ArgMatches, Command, value_parser};
use prob_water::Surface;
use prob_water::spectrum::Spectrum;
use std::f64::consts::TAU;

/// The subcommand's flags.
pub fn command() -> Command {
    Command::new("spectrum")
        .about("The wave energy spectrum S(k) of the sea, and the wave numbers at which its parts meet")
        .arg(
            Arg::new("points")
                .long("points")
                .value_name("N")
                .value_parser(value_parser!(u32).range(2..=10_000_000))
                .default_value("200")
                .help("so many wave numbers from k_min to k2, evenly on a logarithmic scale, 2 to 10000000"),
        )
        .arg(
            Arg::new("wave_number")
                .long("wave-number")
                .value_name("rad/cm")
                .value_parser(wave_number)
                .value_delimiter(',')
                .action(ArgAction::Append)
                .allow_hyphen_values(true)
                .help("these wave numbers instead, above 0, separated by commas"),
        )
        .args(table::flags())
        .args(parameters::flags_and_from(Surface::Instance))
}

fn wave_number(text: &str) -> Result<f64, String> {
    let k = text.trim().parse().map_err(|_| "it is not a number")?;
    if f64::is_finite(k) && k > 0.0 { Ok(k) } else { Err("allowed is finite, above 0 rad/cm".into()) }
}

const COLUMNS: [&str; 9] = [
    "k_rad_cm",
    "wavelength_m",
    "omega_rad_s",
    "S_cm3",
    "k0_rad_cm",
    "k1_rad_cm",
    "k2_rad_cm",
    "kmin_rad_cm",
    "kmax_rad_cm",
];

/// One row for every wave number.
pub fn run(matches: &ArgMatches) -> Outcome {
    let water = parameters::water_on(&[Surface::Instance], matches)?;
    let spectrum = water.waves().spectrum;
    let wave_numbers: Vec<f64> = match matches.get_many("wave_number") {
        Some(given) => given.copied().collect(),
        None => all(&spectrum, *matches.get_one::<u32>("points").expect("has a default"))?,
    };
    let k_max = spectrum.k_max(water.footprint, water.parameters.readings).unwrap_or(f64::NAN);
    let mut out = Table::new(matches, COLUMNS)?;
    for k in wave_numbers {
        out.row(
            &[
                k,
                0.01 * TAU / k,
                spectrum.frequency(k),
                spectrum.density(k),
                spectrum.k0,
                spectrum.k1,
                spectrum.k2,
                spectrum.k_min,
                k_max,
            ]
            .map(Cell::Number),
        )?;
    }
    table::end([out])
}

/// So many from k_min to k2, both included.
fn all(spectrum: &Spectrum, points: u32) -> Result<Vec<f64>, String> {
    let Spectrum { k_min, k2, .. } = *spectrum;
    let waves = k_min < k2;
    if !waves {
        return Err(format!(
            "the wind raises no waves: k_min = {k_min} is not below k2 = {k2} rad/cm; \
             --wave-number gives the spectrum where it is asked for"
        ));
    }
    let last = f64::from(points - 1);
    let mut all: Vec<_> = (0..points).map(|i| k_min * (k2 / k_min).powf(f64::from(i) / last)).collect();
    // Rounding must not lead beyond the end, where the spectrum is 0.
    all.iter_mut().for_each(|k| *k = k.min(k2));
    all[points as usize - 1] = k2;
    Ok(all)
}
