//! The rows of a table in the making, in a file, so that a build which was stopped goes on where it was.
//!
//! The file begins with a text that tells which table it is. Then come the rows in the order in which they were made, each
//! in one piece and written at once: its number, its float32 numbers, and a check sum (CRC-32) of both, all little-endian.
//! Whatever stopped the build, rows that are whole are found again; a torn one can only be the last.

use std::fs::{self, File, TryLockError};
use std::io::{self, ErrorKind, Read, Seek, Write};
use std::path::{Path, PathBuf};

/// A file that rows are appended to; no other build may have it open.
pub struct Journal {
    path: PathBuf,
    file: File,
}

/// Of every row its numbers, where it has been made.
pub type Rows = Vec<Option<Vec<f32>>>;

impl Journal {
    /// The file of a table, and what it has: of so many rows, each with so many numbers.
    pub fn open(path: &Path, table: &str, [rows, row_len]: [usize; 2]) -> Result<(Self, Rows), String> {
        let cannot = |e: io::Error| format!("cannot write {}: {e}", path.display());
        let mut options = File::options();
        let mut file =
            options.read(true).write(true).create(true).truncate(false).open(path).map_err(cannot)?;
        // Where files cannot be locked, two builds of one table write the same rows.
        if let Err(TryLockError::WouldBlock) = file.try_lock() {
            return Err(format!("{}: another build is writing it", path.display()));
        }
        let mut start = Vec::new();
        (&file).take(table.len() as u64).read_to_end(&mut start).map_err(cannot)?;
        if !table.as_bytes().starts_with(&start) {
            let name = path.display();
            return Err(format!(
                "{name} was begun with other flags or by another version of prob-water: give the same flags to go on, or delete it"
            ));
        }
        let mut found = vec![None; rows];
        let mut end = table.len() as u64;
        if start.len() < table.len() {
            file.rewind().and_then(|()| file.write_all(table.as_bytes())).map_err(cannot)?;
        } else {
            let mut record = vec![0; 4 * row_len + 8];
            while read(&file, &mut record).map_err(cannot)? {
                end += record.len() as u64;
                if let Some((row, numbers)) = unpacked(&record).filter(|(row, _)| *row < rows) {
                    found[row] = Some(numbers);
                }
            }
        }
        file.set_len(end).and_then(|()| file.seek(io::SeekFrom::End(0))).map_err(cannot)?;
        Ok((Self { path: path.into(), file }, found))
    }

    /// Adds a row.
    pub fn append(&mut self, row: usize, numbers: &[f32]) -> Result<(), String> {
        let written = self.file.write_all(&packed(row, numbers));
        written.map_err(|e| format!("cannot write {}: {e}", self.path.display()))
    }

    /// The table is there: its rows are not needed any more.
    pub fn remove(self) -> Result<(), String> {
        match fs::remove_file(&self.path) {
            Err(e) if e.kind() != ErrorKind::NotFound => {
                Err(format!("cannot remove {}: {e}", self.path.display()))
            }
            _ => Ok(()),
        }
    }
}

/// The next record; `false` where no whole one is left.
fn read(mut file: &File, record: &mut [u8]) -> io::Result<bool> {
    match file.read_exact(record) {
        Err(e) if e.kind() == ErrorKind::UnexpectedEof => Ok(false),
        other => other.map(|()| true),
    }
}

fn packed(row: usize, numbers: &[f32]) -> Vec<u8> {
    let mut record = (row as u32).to_le_bytes().to_vec();
    record.extend(numbers.iter().flat_map(|x| x.to_le_bytes()));
    record.extend(crc32fast::hash(&record).to_le_bytes());
    record
}

fn unpacked(record: &[u8]) -> Option<(usize, Vec<f32>)> {
    let (content, sum) = record.split_last_chunk()?;
    let (row, numbers) = content.split_first_chunk()?;
    let whole = crc32fast::hash(content) == u32::from_le_bytes(*sum);
    let numbers = numbers.chunks_exact(4).map(|x| f32::from_le_bytes(x.try_into().expect("four bytes")));
    whole.then(|| (u32::from_le_bytes(*row) as usize, numbers.collect()))
}

#[cfg(test)]
mod tests {
    use super::*;

    const TABLE: &str = "a table\n";

    fn open(path: &Path) -> Result<(Journal, Rows), String> {
        Journal::open(path, TABLE, [3, 2])
    }

    #[test]
    fn whole_rows_are_found_again() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("rows");
        let (mut journal, rows) = open(&path).unwrap();
        assert_eq!(rows, [None, None, None]);
        assert!(open(&path).err().unwrap().contains("another build"));
        journal.append(2, &[1.0, 2.0]).unwrap();
        journal.append(0, &[3.0, -0.0]).unwrap();
        drop(journal);
        let whole = fs::read(&path).unwrap();
        let [first, second] = [Some(vec![1.0, 2.0]), Some(vec![3.0, -0.0])];
        for length in 0..=whole.len() {
            fs::write(&path, &whole[..length]).unwrap();
            let (mut journal, rows) = open(&path).unwrap();
            let has = |records: usize| length >= TABLE.len() + 16 * records;
            assert_eq!(rows[2].is_some(), has(1));
            assert_eq!(rows[0].is_some(), has(2));
            // What follows a torn row stands where it should.
            journal.append(1, &[5.0, 6.0]).unwrap();
            drop(journal);
            assert_eq!(open(&path).unwrap().1[1], Some(vec![5.0, 6.0]));
        }
        for at in TABLE.len()..whole.len() {
            let mut flipped = whole.clone();
            flipped[at] ^= 4;
            fs::write(&path, flipped).unwrap();
            let rows = open(&path).unwrap().1;
            let other = at < TABLE.len() + 16;
            assert_eq!(rows, [second.clone().filter(|_| other), None, first.clone().filter(|_| !other)]);
        }
        let zeros = [TABLE.as_bytes(), &[0; 64]].concat();
        fs::write(&path, zeros).unwrap();
        assert_eq!(open(&path).unwrap().1, [None, None, None]);
        fs::write(&path, "a chair\n").unwrap();
        assert!(open(&path).err().unwrap().contains("other flags"));
        open(&folder.path().join("other")).unwrap().0.remove().unwrap();
        assert_eq!(fs::read_dir(&folder).unwrap().count(), 1);
    }
}
