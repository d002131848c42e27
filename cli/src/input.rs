//! Rows in: CSV with a header, its columns in any order.

use csv::ByteRecord;
use std::fs;
use std::io::{self, Read};
use std::path::Path;

/// Rows between two looks at the clock.
pub const STRIDE: usize = 1024;

/// The bytes of a file, or of standard input for `-`.
pub fn read(path: &Path) -> Result<Vec<u8>, String> {
    if path == Path::new("-") {
        let mut bytes = Vec::new();
        io::stdin().read_to_end(&mut bytes).map_err(|e| format!("cannot read standard input: {e}"))?;
        return Ok(bytes);
    }
    fs::read(path).map_err(|e| format!("cannot read {}: {e}", path.display()))
}

/// Rows of any length: that they are too short or too long is ours to say.
pub fn reader(input: &[u8]) -> csv::Reader<&[u8]> {
    csv::ReaderBuilder::new().flexible(true).from_reader(input)
}

/// What a file's columns may be.
pub struct Columns {
    /// Every name.
    pub known: &'static [&'static str],
    /// How many of them, from the first on, have to be there, given the places of those that are.
    pub needed: fn(&[usize]) -> usize,
    /// All that in words.
    pub expected: &'static str,
}

impl Columns {
    /// Hands the numbers of every row, in the order of the known columns up to the last one there, to `row`, which
    /// may refuse them. Returns for every field of a row its place among the known columns. `progress` is told which
    /// byte has been reached.
    pub fn parse(
        &self,
        input: &[u8],
        progress: impl Fn(u64),
        mut row: impl FnMut(&[f64]) -> Result<(), String>,
    ) -> Result<Vec<usize>, String> {
        let mut reader = reader(input);
        let columns = self.header(reader.byte_headers().map_err(|e| e.to_string())?)?;
        let mut values = vec![0.0; columns.iter().max().map_or(0, |last| last + 1)];
        let mut record = ByteRecord::new();
        let mut number = 0;
        while reader.read_byte_record(&mut record).map_err(|e| e.to_string())? {
            number += 1;
            self.numbers(&columns, &record, &mut values)
                .and_then(|()| row(&values))
                .map_err(|message| format!("row {number}: {message}"))?;
            if number % STRIDE == 0 {
                progress(reader.position().byte());
            }
        }
        Ok(columns)
    }

    fn numbers(&self, columns: &[usize], record: &ByteRecord, values: &mut [f64]) -> Result<(), String> {
        if let Some(missing) = columns.get(record.len()) {
            return Err(format!("column {} is missing", self.known[*missing]));
        }
        if let Some(surplus) = record.get(columns.len()) {
            let last = self.known[columns[columns.len() - 1]];
            return Err(format!("{} follows the last column, {last}", shown(surplus)));
        }
        for (field, column) in record.iter().zip(columns) {
            values[*column] = number(field)
                .ok_or_else(|| format!("{} = {} is not a number", self.known[*column], shown(field)))?;
        }
        Ok(())
    }

    /// Where each column of the header belongs among the known ones.
    fn header(&self, names: &ByteRecord) -> Result<Vec<usize>, String> {
        let Self { known, needed, expected } = self;
        let mut columns = Vec::new();
        for name in names {
            if number(name).is_some() {
                return Err(format!(
                    "the header is missing: the first row holds {}, {expected}",
                    shown(name)
                ));
            }
            let Some(column) = known.iter().position(|known| known.as_bytes() == name.trim_ascii()) else {
                return Err(format!("header: column {} is unknown, {expected}", shown(name)));
            };
            if columns.contains(&column) {
                return Err(format!("header: column {} is there twice", known[column]));
            }
            columns.push(column);
        }
        match (0..needed(&columns)).find(|c| !columns.contains(c)) {
            Some(missing) => Err(format!("header: column {} is missing, {expected}", known[missing])),
            None => Ok(columns),
        }
    }
}

fn number(field: &[u8]) -> Option<f64> {
    str::from_utf8(field).ok()?.trim().parse().ok()
}

/// A field as a message shows it: not all of it, where a quote swallowed half the file.
fn shown(field: &[u8]) -> String {
    format!("\"{}\"", String::from_utf8_lossy(field).chars().take(40).collect::<String>())
}
