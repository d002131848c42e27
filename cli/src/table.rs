//! Tables out: CSV or JSON.

use crate::files::{self, Destination};
use crate::{Outcome, Stop};
use clap::{Arg, ArgAction, ArgMatches, value_parser};
use serde_json::{Map, Value};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

/// The flags that say where the rows go and how they look.
pub fn flags() -> [Arg; 2] {
    [
        Arg::new("json")
            .long("json")
            .action(ArgAction::SetTrue)
            .help("write a JSON array, one object per row; what is not finite is null"),
        Arg::new("output")
            .long("output")
            .value_name("FILE")
            .value_parser(value_parser!(PathBuf))
            .help("write to FILE, whole or not at all [default: standard output]"),
    ]
}

/// The file that a flag names; `None` is standard output.
pub fn path<'m>(matches: &'m ArgMatches, flag: &str) -> Option<&'m Path> {
    matches.get_one::<PathBuf>(flag).map(PathBuf::as_path).filter(|path| *path != Path::new("-"))
}

/// Whether `--output` names a file.
pub fn to_file(matches: &ArgMatches) -> bool {
    path(matches, "output").is_some()
}

/// One value of a row.
#[derive(Clone, Copy)]
pub enum Cell<'a> {
    /// A computed number; where there is none, not a number: an empty field.
    Number(f64),
    /// A number with the text it was given as, which CSV repeats.
    Given(&'a str, f64),
    /// A whole number.
    Count(u64),
    /// A word.
    Text(&'a str),
}

impl Cell<'_> {
    fn csv(&self) -> String {
        match self {
            Cell::Number(x) if x.is_nan() => String::new(),
            Cell::Number(x) => number(*x),
            Cell::Given(text, _) | Cell::Text(text) => (*text).to_owned(),
            Cell::Count(n) => n.to_string(),
        }
    }

    fn json(&self) -> Value {
        match self {
            Cell::Number(x) | Cell::Given(_, x) => (*x).into(), // null where not finite
            Cell::Count(n) => (*n).into(),
            Cell::Text(text) => (*text).into(),
        }
    }
}

/// Rows under named columns.
pub struct Table {
    columns: Vec<String>,
    format: Format,
}

enum Format {
    Csv(Box<csv::Writer<Destination>>),
    Json { out: BufWriter<Destination>, rows: usize },
}

impl Table {
    /// A table where the flags say.
    pub fn new<C: Into<String>>(
        matches: &ArgMatches,
        columns: impl IntoIterator<Item = C>,
    ) -> Result<Self, Stop> {
        Self::open(path(matches, "output"), matches.get_flag("json"), columns)
    }

    /// A table in a file, or on standard output.
    pub fn open<C: Into<String>>(
        path: Option<&Path>,
        json: bool,
        columns: impl IntoIterator<Item = C>,
    ) -> Result<Self, Stop> {
        let out = Destination::open(path)?;
        let columns: Vec<String> = columns.into_iter().map(Into::into).collect();
        let format = if json {
            Format::Json { out: BufWriter::new(out), rows: 0 }
        } else {
            let mut csv = Box::new(csv::Writer::from_writer(out));
            csv.write_record(&columns).map_err(|e| csv.get_ref().stop(io_error(e)))?;
            Format::Csv(csv)
        };
        Ok(Self { columns, format })
    }

    /// Writes one row: a cell for every column.
    pub fn row(&mut self, cells: &[Cell]) -> Outcome {
        assert_eq!(cells.len(), self.columns.len());
        match &mut self.format {
            Format::Csv(csv) => {
                csv.write_record(cells.iter().map(Cell::csv)).map_err(|e| csv.get_ref().stop(io_error(e)))
            }
            Format::Json { out, rows } => {
                let names = self.columns.iter().cloned();
                let object: Map<_, _> = names.zip(cells.iter().map(Cell::json)).collect();
                let before: &[u8] = if *rows == 0 { b"[\n" } else { b",\n" };
                *rows += 1;
                out.write_all(before)
                    .and_then(|()| Ok(serde_json::to_writer(&mut *out, &object)?))
                    .map_err(|e| out.get_ref().stop(e))
            }
        }
    }

    /// Writes what is left; the file does not appear yet.
    fn written(self) -> Result<Destination, Stop> {
        match self.format {
            Format::Csv(mut csv) => match csv.flush() {
                Ok(()) => Ok(csv.into_inner().unwrap_or_else(|_| unreachable!("all is written"))),
                Err(error) => Err(csv.get_ref().stop(error)),
            },
            Format::Json { mut out, rows } => {
                let end: &[u8] = if rows == 0 { b"[]\n" } else { b"\n]\n" };
                match out.write_all(end).and_then(|()| out.flush()) {
                    Ok(()) => Ok(out.into_parts().0),
                    Err(error) => Err(out.get_ref().stop(error)),
                }
            }
        }
    }
}

/// Ends tables that belong together: their files appear once every row of all of them is written.
pub fn end(tables: impl IntoIterator<Item = Table>) -> Outcome {
    let mut whole = Vec::new();
    for table in tables {
        match table.written() {
            Ok(destination) => whole.push(destination),
            Err(Stop::ReaderLeft) => (), // the files are still wanted
            Err(stop) => return Err(stop),
        }
    }
    files::keep(whole)
}

/// csv's own conversion hides the kind, and a broken pipe is known by it.
fn io_error(error: csv::Error) -> io::Error {
    match error.into_kind() {
        csv::ErrorKind::Io(error) => error,
        kind => io::Error::other(format!("{kind:?}")),
    }
}

/// A number to 17 significant digits, enough to read back the same bits, as C's `%.17g` writes it.
fn number(x: f64) -> String {
    let scientific = format!("{x:.16e}");
    let Some((_, exponent)) = scientific.split_once('e') else {
        return scientific; // inf
    };
    match exponent.parse::<i32>() {
        Ok(exponent @ -5..=16) => {
            let fixed = format!("{x:.*}", (16 - exponent) as usize);
            if fixed.contains('.') {
                fixed.trim_end_matches('0').trim_end_matches('.').to_owned()
            } else {
                fixed
            }
        }
        _ => scientific,
    }
}

#[cfg(test)]
mod tests {
    use super::{Cell, number};

    #[test]
    fn numbers_read_back() {
        for (x, text) in [
            (0.0, "0"),
            (8.0, "8"),
            (1e16, "10000000000000000"),
            (0.1308, "0.1308"),
            (0.1, "0.10000000000000001"),
            (-1.0 / 3.0, "-0.33333333333333331"),
            (1e-9, "1.0000000000000001e-9"),
            (f64::INFINITY, "inf"),
        ] {
            assert_eq!(number(x), text);
            assert_eq!(text.parse::<f64>().unwrap(), x);
        }
    }

    #[test]
    fn no_number_is_an_empty_field() {
        assert_eq!(Cell::Number(f64::NAN).csv(), "");
        for x in [f64::NAN, f64::INFINITY] {
            assert!(Cell::Number(x).json().is_null());
        }
    }
}
