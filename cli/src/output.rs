//! Rows out: CSV or JSON, to standard output or to a file that appears whole or not at all.

use crate::Outcome;
use clap::{Arg, ArgAction, ArgMatches, value_parser};
use serde_json::{Map, Value};
use std::fs::{self, File};
use std::io::{self, BufWriter, ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::sync::Mutex;

/// The flags that say where the rows go and how they look.
pub fn flags() -> [Arg; 2] {
    [
        Arg::new("json")
            .long("json")
            .action(ArgAction::SetTrue)
            .help("write a JSON array, one object per row; infinities are null"),
        Arg::new("output")
            .long("output")
            .value_name("FILE")
            .value_parser(value_parser!(PathBuf))
            .help("write to FILE, whole or not at all [default: standard output]"),
    ]
}

/// Where the rows go, if not to standard output.
pub fn path(matches: &ArgMatches) -> Option<&Path> {
    matches.get_one::<PathBuf>("output").map(PathBuf::as_path).filter(|path| *path != Path::new("-"))
}

/// Writes a table where the flags say: `rows` is handed the table and fills it.
pub fn write(
    matches: &ArgMatches,
    columns: &[&'static str],
    rows: impl FnOnce(&mut Table) -> io::Result<()>,
) -> Outcome {
    let fill = |out: &mut dyn Write| {
        let mut table = Table::new(BufWriter::new(out), columns, matches.get_flag("json"))?;
        rows(&mut table)?;
        table.end()
    };
    match path(matches) {
        None => fill(&mut io::stdout().lock()).or_else(ignore_broken_pipe),
        Some(path) => write_file(path, fill).map_err(|e| format!("cannot write {}: {e}", path.display())),
    }
}

/// Whoever reads standard output may stop early.
pub fn ignore_broken_pipe(error: io::Error) -> Outcome {
    match error.kind() {
        ErrorKind::BrokenPipe => Ok(()),
        _ => Err(format!("cannot write to standard output: {error}")),
    }
}

/// The file being written, which Ctrl-C removes.
static TEMPORARY: Mutex<Option<PathBuf>> = Mutex::new(None);

fn write_file(path: &Path, fill: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> io::Result<()> {
    // Through a link to the file itself, as an ordinary write would.
    let path = &fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
    let old = fs::metadata(path).ok();
    if old.as_ref().is_some_and(|old| !old.is_file()) {
        return fill(&mut File::options().write(true).open(path)?); // a device or a pipe
    }
    let _ = ctrlc::set_handler(|| {
        let temporary = TEMPORARY.lock().unwrap();
        if let Some(path) = temporary.as_deref() {
            let _ = fs::remove_file(path);
        }
        std::process::exit(130);
    });
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let mut temporary = {
        let mut slot = TEMPORARY.lock().unwrap();
        let file = temporary_file(folder)?;
        *slot = Some(file.path().to_owned());
        file
    };
    fill(&mut temporary)?;
    if let Some(old) = old {
        temporary.as_file().set_permissions(old.permissions())?;
    }
    temporary.persist(path).map_err(|e| e.error)?;
    Ok(())
}

/// In the folder of the final file, so that a rename suffices, with a new file's usual permissions.
fn temporary_file(folder: &Path) -> io::Result<tempfile::NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(".prob-water-");
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    builder.tempfile_in(folder)
}

/// One value of a row.
pub enum Cell<'a> {
    /// A computed number.
    Number(f64),
    /// A number with the text it was given as, which CSV repeats.
    Given(&'a str, f64),
    /// A whole number.
    Count(usize),
    /// A word.
    Text(&'a str),
}

impl Cell<'_> {
    fn csv(&self) -> String {
        match self {
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
pub struct Table<'w> {
    columns: Vec<&'static str>,
    format: Format<'w>,
}

type Out<'w> = BufWriter<&'w mut dyn Write>;

enum Format<'w> {
    Csv(Box<csv::Writer<Out<'w>>>),
    Json { out: Out<'w>, rows: usize },
}

impl<'w> Table<'w> {
    fn new(out: Out<'w>, columns: &[&'static str], json: bool) -> io::Result<Self> {
        let format = if json {
            Format::Json { out, rows: 0 }
        } else {
            let mut csv = csv::Writer::from_writer(out);
            csv.write_record(columns).map_err(io_error)?;
            Format::Csv(Box::new(csv))
        };
        Ok(Self { columns: columns.to_vec(), format })
    }

    /// Writes one row: a cell for every column.
    pub fn row(&mut self, cells: &[Cell]) -> io::Result<()> {
        assert_eq!(cells.len(), self.columns.len());
        match &mut self.format {
            Format::Csv(csv) => csv.write_record(cells.iter().map(Cell::csv)).map_err(io_error)?,
            Format::Json { out, rows } => {
                let object: Map<_, _> = self
                    .columns
                    .iter()
                    .zip(cells)
                    .map(|(name, cell)| ((*name).to_owned(), cell.json()))
                    .collect();
                out.write_all(if *rows == 0 { b"[\n" } else { b",\n" })?;
                serde_json::to_writer(&mut *out, &object)?;
                *rows += 1;
            }
        }
        Ok(())
    }

    fn end(self) -> io::Result<()> {
        match self.format {
            Format::Csv(mut csv) => csv.flush(),
            Format::Json { mut out, rows } => {
                out.write_all(if rows == 0 { b"[]\n" } else { b"\n]\n" })?;
                out.flush()
            }
        }
    }
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
        return scientific; // inf, NaN
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
    use super::number;

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
}
