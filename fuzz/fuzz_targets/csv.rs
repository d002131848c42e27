//! Bytes as the rows of `prob-water brdf`: written with their f, or refused in words.
//!
//! The first byte chooses the surface and the format of what is written.
#![no_main]
use libfuzzer_sys::fuzz_target;
use std::path::PathBuf;
use std::sync::LazyLock;

/// Where the rows lie for the command: beside the fuzzer itself, one file for every process.
static FILE: LazyLock<PathBuf> = LazyLock::new(|| {
    let fuzzer = std::env::current_exe().expect("the fuzzer knows where it lies");
    fuzzer.with_extension("csv")
});

fuzz_target!(|bytes: &[u8]| {
    let Some((choice, rows)) = bytes.split_first() else { return };
    std::fs::write(&*FILE, rows).expect("the fuzzer's folder can be written");
    let file = FILE.to_str().expect("a plain name");
    let mut arguments = vec!["prob-water", "brdf", file, "--output", "/dev/null"];
    // The surfaces that are quick to configure.
    arguments.extend(if choice & 1 == 0 { ["--surface", "flat"] } else { ["--surface", "instance"] });
    if choice & 2 != 0 {
        arguments.push("--json");
    }
    if let Err(message) = prob_water_cli::run(arguments) {
        assert!(!message.is_empty() && message.lines().count() == 1, "{message:?}");
    }
});
