//! Bytes as a table of the empirical model: read whole or refused in words.
//!
//! Damage hardly gets past the check sums of a zip, so bytes that do not begin like one are edits instead, four bytes each:
//! to the arrays of a small table, which are sealed anew.
#![no_main]

use libfuzzer_sys::fuzz_target;
use prob_water::table::{Grid, Plan};
use prob_water::{Parameters, Surface, Table};
use std::io::{Cursor, Read, Write};
use std::sync::LazyLock;
use zip::write::SimpleFileOptions;
use zip::{ZipArchive, ZipWriter};

/// Names and contents of a small table's arrays.
static ARRAYS: LazyLock<Vec<(String, Vec<u8>)>> = LazyLock::new(|| {
    let sea = Parameters { surface: Surface::Empirical, instances: 2, ..Parameters::default() };
    let grid = Grid {
        friction_velocity: vec![8.0, 9.0],
        footprint: vec![0.15],
        incidence: vec![0.0, 80.0],
        wind_azimuth: vec![0.0, 180.0],
        theta_r: vec![-60.0, 0.0, 30.0, 80.0],
    };
    let table = Plan::new(&sea, &grid).and_then(|plan| plan.table()).expect("a small grid");
    let mut zip = ZipArchive::new(Cursor::new(table.to_bytes())).expect("a whole table");
    let array = |k: usize| {
        let mut file = zip.by_index(k).expect("one of its files");
        let mut content = vec![];
        file.read_to_end(&mut content).expect("a whole file");
        (file.name().expect("plain").to_string(), content)
    };
    (0..15).map(array).collect()
});

fuzz_target!(|bytes: &[u8]| {
    if bytes.starts_with(b"PK") {
        return read(bytes);
    }
    let mut arrays = ARRAYS.clone();
    for edit in bytes.chunks_exact(4) {
        let count = arrays.len();
        let content = &mut arrays[usize::from(edit[0] & 63) % count].1;
        let at = usize::from(u16::from_le_bytes([edit[1], edit[2]])) % (content.len() + 1);
        match edit[0] >> 6 {
            0 | 1 if at < content.len() => content[at] = edit[3],
            2 => content.insert(at, edit[3]),
            _ => content.truncate(at),
        }
    }
    let mut zip = ZipWriter::new(Cursor::new(vec![]));
    for (name, content) in arrays {
        zip.start_file(name, SimpleFileOptions::default().compression_method(zip::CompressionMethod::Stored))
            .and_then(|()| Ok(zip.write_all(&content)?))
            .expect("memory takes whatever it is given");
    }
    read(zip.finish().expect("memory takes whatever it is given").get_ref());
});

fn read(bytes: &[u8]) {
    if let Ok(table) = Table::read(bytes, "fuzz") {
        // What was read can be written, and read again.
        let written = table.to_bytes();
        assert!(Table::read(&written, "again").expect("its own bytes") == table);
    }
}
