//! `prob-water brdf`: the BRDF for rows of directions.

use crate::input::{self, Columns, STRIDE};
use crate::progress::Progress;
use crate::table::{self, Cell, Table};
use crate::{Outcome, empirical_table, files, parameters};
use clap::{Arg, ArgAction, ArgMatches, Command, value_parser};
use csv::ByteRecord;
use prob_water::batch::Rows;
use prob_water::brdf::{Parts, polarised};
use prob_water::statistics::FARTHEST;
use prob_water::{EnsembleLobe, Error, InstanceLobe, Surface};
use rayon::prelude::*;
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
                     and optionally nx,ny,nz (facing normals); with --surface instance also x,y (m); \
                     - is standard input [default: -]",
                ),
        )
        .arg(Arg::new("mueller").long("mueller").action(ArgAction::SetTrue).help(
            "append the Mueller matrix, m00 to m33, 1/sr (m00 is f): first axes in the planes of the vertical \
             and the directions, towards larger angles from the vertical",
        ))
        .arg(empirical_table::flag())
        .args(table::flags())
        .args(parameters::flags_and_from(Surface::Flat))
}

/// Checks every row, then writes them all with their `f`.
pub fn run(matches: &ArgMatches) -> Outcome {
    let surfaces = [Surface::Flat, Surface::Instance, Surface::Ensemble, Surface::Empirical];
    let path = matches.get_one::<PathBuf>("input").expect("has a default");
    files::apart(matches, [path.as_path()].into_iter().chain(empirical_table::given(matches)))?;
    let (water, of_file) = parameters::water_and_table(&surfaces, matches)?;
    let surface = water.parameters.surface;
    let by_table = surface == Surface::Empirical;
    let table = empirical_table::given(matches);
    if table.is_some() && !by_table {
        return Err(empirical_table::MEANINGLESS.to_owned().into());
    }
    let drawn = surface == Surface::Instance;
    let columns = if drawn { &PLACES } else { &COLUMNS };
    let input = input::read(path)?;
    let half = input.len() as u64;
    let progress = Progress::new(2 * half, table::to_file(matches));

    let directions = Directions::parse(columns, &input, |byte| progress.at(byte))?;
    let mut f = vec![0.0; directions.vectors[0].len()];
    let rows = directions.rows(drawn)?;
    if directions.with_normals() && matches!(surface, Surface::Ensemble | Surface::Empirical) {
        return Err(format!("normals have no meaning with surface = {}", surface.name()).into());
    }
    let mut estimates = Vec::new();
    // What whitecaps reflect of it, where matrices are asked for.
    let matrices = matches.get_flag("mueller");
    let mut foam = vec![0.0; if matrices { f.len() } else { 0 }];
    match surface {
        Surface::Flat => {
            let lobe = water.lobe()?;
            rows.eval(&lobe, &mut f)?;
            if matrices {
                rows.each(&mut foam, |_, i, o, n| lobe.eval_parts(i, o, n, Parts::WHITECAPS))?;
            }
        }
        Surface::Instance => {
            let lobe = InstanceLobe::new(&water)?;
            let f_of = |row: usize, i, o: [f64; 3], parts| {
                let [x, y, _] = directions.vectors[2][row];
                // The lobe's value has the cosine that whoever integrates f adds.
                let seen = lobe.eval_parts(i, o, [x, y], parts);
                if o[2] > 0.0 { seen / o[2] } else { seen }
            };
            rows.each(&mut f, |row, i, o, _| f_of(row, i, o, Parts::ALL))?;
            if matrices {
                rows.each(&mut foam, |row, i, o, _| f_of(row, i, o, Parts::WHITECAPS))?;
            }
        }
        Surface::Ensemble => {
            let lobe = EnsembleLobe::new(&water)?;
            rows.each(&mut f, |_, i, o, _| lobe.eval(i, o))?;
            if matrices {
                rows.each(&mut foam, |_, i, o, _| lobe.eval_parts(i, o, Parts::WHITECAPS))?;
            }
        }
        Surface::Empirical => {
            let lobe = empirical_table::lobe(&water, table.or(of_file.as_deref()))?;
            let [source, observer, _] = &directions.vectors;
            estimates = source.par_iter().zip(observer).map(|(i, o)| lobe.estimate(*i, *o)).collect();
            f = estimates.iter().map(|estimate| estimate.mean).collect();
            if matrices {
                rows.each(&mut foam, |_, i, o, _| lobe.eval_parts(i, o, Parts::WHITECAPS))?;
            }
        }
    }

    let more: &[&str] = if by_table { &["f", "u", "outside"] } else { &["f"] };
    let names = directions.columns.iter().map(|c| columns.known[*c]).chain(more.iter().copied());
    let names = names.chain(ELEMENTS.into_iter().filter(|_| matrices));
    let reflectance = water.local_lobe().facets.reflectance;
    let mut out = Table::new(matches, names)?;
    let mut reader = input::reader(&input);
    let mut record = ByteRecord::new();
    for (row, f) in f.iter().enumerate() {
        reader.read_byte_record(&mut record).map_err(|e| e.to_string())?;
        let given = record.iter().zip(&directions.columns).map(|(field, column)| {
            let text = str::from_utf8(field).expect("the text of a number");
            Cell::Given(text, directions.vectors[column / 3][row][column % 3])
        });
        let known = estimates.get(row).map(|e| [Cell::Number(e.std), Cell::Count(e.outside.into())]);
        let [i, o] = [0, 1].map(|k| directions.vectors[k][row]);
        let matrix = foam.get(row).map(|foam| polarised::mueller(&reflectance, i, o, [f - foam, *foam]));
        let matrix = matrix.iter().flatten().flatten().map(|m| Cell::Number(m + 0.0));
        let cells = given.chain([Cell::Number(*f)]).chain(known.into_iter().flatten()).chain(matrix);
        out.row(&cells.collect::<Vec<_>>())?;
        if row % STRIDE == 0 {
            progress.at(half + reader.position().byte());
        }
    }
    table::end([out])
}

/// Of a Mueller matrix, row by row.
const ELEMENTS: [&str; 16] = [
    "m00", "m01", "m02", "m03", "m10", "m11", "m12", "m13", "m20", "m21", "m22", "m23", "m30", "m31", "m32",
    "m33",
];

const COLUMNS: Columns = Columns {
    known: &["ix", "iy", "iz", "ox", "oy", "oz", "nx", "ny", "nz"],
    // Normals are optional, but not by halves.
    needed: |columns| if columns.iter().any(|c| *c >= 6) { 9 } else { 6 },
    expected: "expected ix,iy,iz,ox,oy,oz and optionally nx,ny,nz",
};

/// On a drawn sea: directions and places, m.
const PLACES: Columns = Columns {
    known: &["ix", "iy", "iz", "ox", "oy", "oz", "x", "y"],
    needed: |_| 8,
    expected: "expected ix,iy,iz,ox,oy,oz,x,y",
};

/// The directions of a file: to the source, to the observer and, where given, the normals, or the places.
struct Directions {
    /// For every field of a row its place among the known columns.
    columns: Vec<usize>,
    vectors: [Vec<[f64; 3]>; 3],
}

impl Directions {
    fn parse(known: &Columns, input: &[u8], progress: impl Fn(u64)) -> Result<Self, String> {
        let mut vectors = [vec![], vec![], vec![]];
        let columns = known.parse(input, progress, |values| {
            for (vectors, value) in vectors.iter_mut().zip(values.chunks(3)) {
                let [x, y] = [value[0], value[1]];
                match value.get(2) {
                    Some(z) => vectors.push([x, y, *z]),
                    None if x.abs() <= FARTHEST && y.abs() <= FARTHEST => vectors.push([x, y, 0.0]),
                    None => return Err(format!("x,y = {x},{y}: allowed is at most {FARTHEST:e} m from 0")),
                }
            }
            Ok(())
        })?;
        Ok(Self { columns, vectors })
    }

    fn with_normals(&self) -> bool {
        self.columns.len() == COLUMNS.known.len()
    }

    /// All rows, checked; what is refused is named by the file's columns.
    fn rows(&self, drawn: bool) -> Result<Rows<'_, f64>, Error> {
        let [source, observer, normals] = &self.vectors;
        let normals = (self.with_normals() && !drawn).then_some(normals.as_slice());
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
