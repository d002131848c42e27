//! `prob-water brdf`: the BRDF for rows of directions.

use crate::input::{self, Columns, STRIDE};
use crate::progress::Progress;
use crate::table::{self, Cell, Table};
use crate::{Outcome, parameters};
use clap::{Arg, ArgMatches, Command, value_parser};
use csv::ByteRecord;
use prob_water::batch::Rows;
use prob_water::{EnsembleLobe, Error, Surface};
use std::path::PathBuf;

/// The subcommand's flags.
pub fn command() -> Command {
    Command::new("brdf")
        .about("The BRDF f, 1/sr, of the rows of a CSV file")
        .arg(
            Arg::new("input")
                .value_name("INPUT.csv")
                .value_parser(value_parser!(PathBuf))
                .default_value("-")
                .hide_default_value(true)
                .help(
                    "CSV with header ix,iy,iz,ox,oy,oz (unit vectors to source and observer, z up) \
                     and optionally nx,ny,nz (facing normals); - is standard input [default: -]",
                ),
        )
        .args(table::flags())
        .args(parameters::flags_and_from(Surface::Flat))
}

/// Checks every row, then writes them all with their `f`.
pub fn run(matches: &ArgMatches) -> Outcome {
    let water = parameters::water_on(&[Surface::Flat, Surface::Ensemble], matches)?;
    let input = input::read(matches.get_one::<PathBuf>("input").expect("has a default"))?;
    let half = input.len() as u64;
    let progress = Progress::new(2 * half, table::to_file(matches));

    let directions = Directions::parse(&input, |byte| progress.at(byte))?;
    let mut f = vec![0.0; directions.vectors[0].len()];
    let rows = directions.rows()?;
    if water.parameters.surface == Surface::Ensemble {
        if directions.with_normals() {
            return Err("normals have no meaning with surface = ensemble".to_owned().into());
        }
        let lobe = EnsembleLobe::new(&water)?;
        rows.each(&mut f, |i, o, _| lobe.eval(i, o))?;
    } else {
        rows.eval(&water.lobe, &mut f)?;
    }

    let columns = directions.columns.iter().map(|c| COLUMNS.known[*c]).chain(["f"]);
    let mut out = Table::new(matches, columns)?;
    let mut reader = input::reader(&input);
    let mut record = ByteRecord::new();
    for (row, f) in f.iter().enumerate() {
        reader.read_byte_record(&mut record).map_err(|e| e.to_string())?;
        let given = record.iter().zip(&directions.columns).map(|(field, column)| {
            let text = str::from_utf8(field).expect("the text of a number");
            Cell::Given(text, directions.vectors[column / 3][row][column % 3])
        });
        out.row(&given.chain([Cell::Number(*f)]).collect::<Vec<_>>())?;
        if row % STRIDE == 0 {
            progress.at(half + reader.position().byte());
        }
    }
    table::end([out])
}

const COLUMNS: Columns = Columns {
    known: &["ix", "iy", "iz", "ox", "oy", "oz", "nx", "ny", "nz"],
    // Normals are optional, but not by halves.
    needed: |columns| if columns.iter().any(|c| *c >= 6) { 9 } else { 6 },
    expected: "expected ix,iy,iz,ox,oy,oz and optionally nx,ny,nz",
};

/// The directions of a file: to the source, to the observer and, where given, the normals.
struct Directions {
    /// For every field of a row its place in [`COLUMNS`].
    columns: Vec<usize>,
    vectors: [Vec<[f64; 3]>; 3],
}

impl Directions {
    fn parse(input: &[u8], progress: impl Fn(u64)) -> Result<Self, String> {
        let mut vectors = [vec![], vec![], vec![]];
        let columns = COLUMNS.parse(input, progress, |values| {
            for (vectors, value) in vectors.iter_mut().zip(values.chunks_exact(3)) {
                vectors.push([value[0], value[1], value[2]]);
            }
            Ok(())
        })?;
        Ok(Self { columns, vectors })
    }

    fn with_normals(&self) -> bool {
        self.columns.len() == COLUMNS.known.len()
    }

    /// All rows, checked; what is refused is named by the file's columns.
    fn rows(&self) -> Result<Rows<'_, f64>, Error> {
        let [source, observer, normals] = &self.vectors;
        let normals = self.with_normals().then_some(normals.as_slice());
        Rows::new(source, observer, normals).map_err(|error| match error {
            Error::Row { row, column, x, y, z, expected } => {
                let column = match column {
                    "to_source" => "ix,iy,iz",
                    "to_observer" => "ox,oy,oz",
                    _ => "nx,ny,nz",
                };
                Error::Row { row, column, x, y, z, expected }
            }
            other => other,
        })
    }
}
