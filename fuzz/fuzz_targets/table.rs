//! Bytes as a table of the empirical model: read whole or refused in words.
#![no_main]

use libfuzzer_sys::fuzz_target;
use prob_water::Table;

fuzz_target!(|bytes: &[u8]| {
    if let Ok(table) = Table::read(bytes, "fuzz") {
        // What was read can be written, and read again.
        let written = table.to_bytes();
        assert!(Table::read(&written, "again").expect("its own bytes") == table);
        table.metadata();
    }
});
