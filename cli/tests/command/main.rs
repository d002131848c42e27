//! The command as users run it: the real binary, its streams and its exit status.

mod any_bytes;
mod beam;
mod brdf;
mod empirical;
mod files;
mod from;
#[cfg(unix)]
mod guide;
mod polarised;
mod refusals;
mod scenario;
mod scenario_refusals;
mod spectrum;
mod surface;
mod table;
mod warnings;
mod wind;

use std::fs;
use std::io::{Read, Write};
use std::path::PathBuf;
use std::process::{Command, Output, Stdio};

fn command() -> Command {
    Command::new(env!("CARGO_BIN_EXE_prob-water"))
}

/// Runs `prob-water` with arguments separated by blanks.
fn run(arguments: &str, input: impl AsRef<[u8]>) -> Output {
    let mut child = command()
        .args(arguments.split_whitespace())
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    // A command that refuses its flags does not read its input.
    let _ = child.stdin.take().unwrap().write_all(input.as_ref());
    child.wait_with_output().unwrap()
}

/// Runs a command whose reader leaves early, which is no failure.
#[track_caller]
fn leave_early(command: &mut Command) {
    let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    child.stdout.take().unwrap().read_exact(&mut [0; 10]).unwrap();
    let output = child.wait_with_output().unwrap();
    assert!(output.status.success() && only_warns(&output), "{output:?}");
}

/// Standard output of a run that has to succeed in silence.
#[track_caller]
fn succeed(arguments: &str, input: &str) -> String {
    let output = run(arguments, input);
    assert!(output.status.success(), "{arguments}: {}", String::from_utf8_lossy(&output.stderr));
    assert!(only_warns(&output), "{arguments}: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}

/// The one line on standard error of a run that has to fail.
#[track_caller]
fn refuse(arguments: &str, input: &str) -> String {
    let output = run(arguments, input);
    let message = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{arguments}: {message}");
    assert!(output.stdout.is_empty(), "{arguments}");
    assert_eq!(message.lines().count(), 1, "{arguments}: {message}");
    assert!(message.starts_with("prob-water: ") && message.ends_with('\n'), "{message}");
    message
}

/// Whether nothing is on standard error but warnings, which statistics of few draws give.
fn only_warns(output: &Output) -> bool {
    String::from_utf8_lossy(&output.stderr).lines().all(|line| line.starts_with("prob-water: warning: "))
}

/// Header and rows of CSV text.
fn table(text: &str) -> Vec<Vec<&str>> {
    text.lines().map(|line| line.split(',').collect()).collect()
}

/// Reference vectors of the library, as text.
fn vectors(name: &str) -> String {
    let path: PathBuf = [env!("CARGO_MANIFEST_DIR"), "../rust-core/tests/data", name].iter().collect();
    fs::read_to_string(path).unwrap()
}

/// One column of CSV text.
#[track_caller]
fn column<'t>(text: &'t str, name: &str) -> Vec<&'t str> {
    let rows = table(text);
    let at = rows[0].iter().position(|column| *column == name).expect(name);
    rows[1..].iter().map(|row| row[at]).collect()
}

#[track_caller]
fn floats(text: &str, name: &str) -> Vec<f64> {
    column(text, name).into_iter().map(float).collect()
}

#[track_caller]
fn float(text: &str) -> f64 {
    text.parse().expect(text)
}

/// The same number, but for the last bit, which this reader of JSON may miss.
fn same(read: f64, expected: f64) -> bool {
    (read - expected).abs() <= f64::EPSILON * expected.abs()
}

#[track_caller]
fn close(found: &str, expected: &str) {
    let [found, expected] = [found, expected].map(float);
    assert!((found - expected).abs() <= 1e-10 * expected.abs(), "{found} against {expected}");
}
