//! `prob-water brdf`: the BRDF for rows of directions.

use crate::output::{self, Cell};
use crate::progress::Progress;
use crate::{Outcome, parameters};
use clap::{Arg, ArgMatches, Command, value_parser};
use csv::ByteRecord;
use prob_water::Error;
use prob_water::batch::Rows;
use std::fs;
use std::io::{self, Read};
use std::path::{Path, PathBuf};

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
        .args(output::flags())
        .args(parameters::flags())
}

/// Checks every row, then writes them all with their `f`.
pub fn run(matches: &ArgMatches) -> Outcome {
    let water = parameters::water(matches)?;
    let input = read(matches.get_one::<PathBuf>("input").expect("has a default"))?;
    let half = input.len() as u64;
    let progress = Progress::new(2 * half, output::path(matches).is_some());

    let directions = Directions::parse(&input, |byte| progress.at(byte))?;
    let mut f = vec![0.0; directions.vectors[0].len()];
    directions.rows().and_then(|rows| rows.eval(&water.lobe, &mut f)).map_err(|e| e.to_string())?;

    let columns: Vec<_> = directions.columns.iter().map(|c| COLUMNS[*c]).chain(["f"]).collect();
    output::write(matches, &columns, |out| {
        let mut reader = reader(&input);
        let mut record = ByteRecord::new();
        for (row, f) in f.iter().enumerate() {
            reader.read_byte_record(&mut record)?;
            let given = record.iter().zip(&directions.columns).map(|(field, column)| {
                let text = str::from_utf8(field).expect("the text of a number");
                Cell::Given(text, directions.vectors[column / 3][row][column % 3])
            });
            out.row(&given.chain([Cell::Number(*f)]).collect::<Vec<_>>())?;
            if row % STRIDE == 0 {
                progress.at(half + reader.position().byte());
            }
        }
        Ok(())
    })
}

/// Rows between two looks at the clock.
const STRIDE: usize = 1024;

fn read(path: &Path) -> Result<Vec<u8>, String> {
    if path == Path::new("-") {
        let mut bytes = Vec::new();
        io::stdin().read_to_end(&mut bytes).map_err(|e| format!("cannot read standard input: {e}"))?;
        return Ok(bytes);
    }
    fs::read(path).map_err(|e| format!("cannot read {}: {e}", path.display()))
}

/// Rows of any length: that they are too short or too long is ours to say.
fn reader(input: &[u8]) -> csv::Reader<&[u8]> {
    csv::ReaderBuilder::new().flexible(true).from_reader(input)
}

const COLUMNS: [&str; 9] = ["ix", "iy", "iz", "ox", "oy", "oz", "nx", "ny", "nz"];
const EXPECTED: &str = "expected ix,iy,iz,ox,oy,oz and optionally nx,ny,nz";

/// The directions of a file: to the source, to the observer and, where given, the normals.
struct Directions {
    /// For every field of a row its place in [`COLUMNS`].
    columns: Vec<usize>,
    vectors: [Vec<[f64; 3]>; 3],
}

impl Directions {
    fn parse(input: &[u8], progress: impl Fn(u64)) -> Result<Self, String> {
        let mut reader = reader(input);
        let columns = header(reader.byte_headers().map_err(|e| e.to_string())?)?;
        let mut vectors = [vec![], vec![], vec![]];
        let mut record = ByteRecord::new();
        let mut row = 0;
        while reader.read_byte_record(&mut record).map_err(|e| e.to_string())? {
            row += 1;
            if let Some(missing) = columns.get(record.len()) {
                return Err(format!("row {row}: column {} is missing", COLUMNS[*missing]));
            }
            if record.len() > columns.len() {
                let last = COLUMNS[columns[columns.len() - 1]];
                return Err(format!(
                    "row {row}: {} follows the last column, {last}",
                    shown(&record[columns.len()])
                ));
            }
            let mut values = [[0.0; 3]; 3];
            for (field, column) in record.iter().zip(&columns) {
                values[column / 3][column % 3] = number(field).ok_or_else(|| {
                    format!("row {row}: {} = {} is not a number", COLUMNS[*column], shown(field))
                })?;
            }
            for (vectors, value) in vectors.iter_mut().zip(values).take(columns.len() / 3) {
                vectors.push(value);
            }
            if row % STRIDE == 0 {
                progress(reader.position().byte());
            }
        }
        Ok(Self { columns, vectors })
    }

    /// All rows, checked; what is refused is named by the file's columns.
    fn rows(&self) -> Result<Rows<'_, f64>, Error> {
        let [source, observer, normals] = &self.vectors;
        let normals = (self.columns.len() == COLUMNS.len()).then_some(normals.as_slice());
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

/// Where each column of the header belongs in [`COLUMNS`].
fn header(names: &ByteRecord) -> Result<Vec<usize>, String> {
    let mut columns = Vec::new();
    for name in names {
        if number(name).is_some() {
            return Err(format!("the header is missing: the first row holds {}, {EXPECTED}", shown(name)));
        }
        let Some(column) = COLUMNS.iter().position(|known| known.as_bytes() == name.trim_ascii()) else {
            return Err(format!("header: column {} is unknown, {EXPECTED}", shown(name)));
        };
        if columns.contains(&column) {
            return Err(format!("header: column {} is there twice", COLUMNS[column]));
        }
        columns.push(column);
    }
    // Normals are optional, but not by halves.
    let needed = if columns.iter().any(|c| *c >= 6) { 9 } else { 6 };
    match (0..needed).find(|c| !columns.contains(c)) {
        Some(missing) => Err(format!("header: column {} is missing, {EXPECTED}", COLUMNS[missing])),
        None => Ok(columns),
    }
}

fn number(field: &[u8]) -> Option<f64> {
    str::from_utf8(field).ok()?.trim().parse().ok()
}

/// A field as a message shows it: not all of it, where a quote swallowed half the file.
fn shown(field: &[u8]) -> String {
    format!("\"{}\"", String::from_utf8_lossy(field).chars().take(40).collect::<String>())
}
