//! Where cargo put what it built, as its own messages tell: a target directory set elsewhere, or a changed layout of
//! it, does not matter.

use crate::util;
use anyhow::{Context, Result, bail};
use serde_json::Value;
use std::io::{BufRead, BufReader};
use std::path::PathBuf;
use std::process::Stdio;

/// What users get, with optimisation. Cargo unifies the features of dependencies over what one call selects: each other selection
/// would compile the library once more.
pub const USERS: [&str; 6] = ["--target-dir", "target", "--release", "--workspace", "--exclude", "xtask"];

/// All of it, with its tests.
pub fn everything() -> Vec<&'static str> {
    [&USERS[..], &["--lib", "--bins", "--tests", "--examples"]].concat()
}

/// The output of one package.
pub struct Built {
    /// Its static library.
    pub library: PathBuf,
    /// Where its build script wrote, if it has one.
    pub out_dir: Option<PathBuf>,
}

/// Runs cargo (`build` or `rustc` with these arguments) for a package that makes a static library; the package is told
/// from others by the directory of its manifest.
pub fn static_library(package_directory: &str, arguments: &[&str]) -> Result<Built> {
    let manifest = util::root().join(package_directory).join("Cargo.toml");
    let messages = messages(arguments, package_directory)?;
    let is = |message: &Value, reason: &str| message["reason"] == reason;
    let (artifact, library) = messages
        .iter()
        .filter(|message| {
            is(message, "compiler-artifact")
                && message["manifest_path"].as_str().is_some_and(|path| manifest.as_os_str() == path)
        })
        .find_map(|message| {
            let mut names = message["filenames"].as_array()?.iter().filter_map(Value::as_str);
            Some((message, PathBuf::from(names.find(|name| name.ends_with(".a"))?)))
        })
        .with_context(|| format!("{package_directory} makes no static library"))?;
    let out_dir = messages
        .iter()
        .find(|message| {
            is(message, "build-script-executed") && message["package_id"] == artifact["package_id"]
        })
        .and_then(|message| message["out_dir"].as_str())
        .map(PathBuf::from);
    Ok(Built { library, out_dir })
}

/// The programs of all examples of the library.
pub fn examples() -> Result<Vec<PathBuf>> {
    let arguments = [&["build", "--quiet", "--examples"], &USERS[..]].concat();
    let messages = messages(&arguments, "the examples")?;
    let mut programs: Vec<PathBuf> = messages
        .iter()
        .filter(|message| message["target"]["kind"][0] == "example")
        .filter_map(|message| message["executable"].as_str())
        .map(PathBuf::from)
        .collect();
    programs.sort();
    Ok(programs)
}

/// What cargo says of a build of `what`, message for message.
fn messages(arguments: &[&str], what: &str) -> Result<Vec<Value>> {
    let mut command = util::cargo();
    let (verb, arguments) = arguments.split_first().context("no cargo command")?;
    command.arg(verb).arg("--message-format=json-render-diagnostics").args(arguments);
    let mut child =
        command.stdout(Stdio::piped()).spawn().map_err(|error| util::not_started(&command, error))?;

    let mut messages: Vec<Value> = Vec::new();
    for line in BufReader::new(child.stdout.take().expect("stdout is piped")).lines() {
        // A build script's own prints do not reach this stream, but a tool around rustc may write to it.
        messages.extend(serde_json::from_str::<Value>(&line?));
    }
    let status = child.wait()?;
    if !status.success() {
        bail!("cargo {verb} of {what} failed ({status})");
    }
    Ok(messages)
}
