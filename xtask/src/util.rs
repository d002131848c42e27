//! What every command needs: the root of the checkout, child processes in a clean environment, and failures that
//! read as one line.

use anyhow::{Context, Result, bail};
use std::ffi::OsStr;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::LazyLock;
use std::time::Duration;

/// The root of the checkout. Cargo says at run time where this package lies; what was true when it was compiled may
/// not be so any more after the checkout was moved with its `target/`.
pub fn root() -> &'static Path {
    static ROOT: LazyLock<PathBuf> = LazyLock::new(|| {
        let package =
            std::env::var_os("CARGO_MANIFEST_DIR").unwrap_or_else(|| env!("CARGO_MANIFEST_DIR").into());
        Path::new(&package).parent().expect("xtask/ lies in the root").into()
    });
    &ROOT
}

/// A child process that starts at the root. Another Python or Mitsuba that is active in the caller's shell stays
/// out of it, and nothing is cached outside the checkout.
pub fn command(program: impl AsRef<OsStr>) -> Command {
    let cache = root().join("target/cache");
    let mut command = Command::new(program);
    command.current_dir(root());
    for inherited in ["VIRTUAL_ENV", "PYTHONPATH", "PYTHONHOME", "PYTHONSAFEPATH"] {
        command.env_remove(inherited);
    }
    command
        .env("PYTHONNOUSERSITE", "1")
        .env("PIP_DISABLE_PIP_VERSION_CHECK", "1")
        .env("PIP_NO_CACHE_DIR", "1")
        .env("DRJIT_CACHE_DIR", cache.join("drjit"))
        .env("MPLCONFIGDIR", cache.join("matplotlib"));
    command
}

/// The cargo that runs this program.
pub fn cargo() -> Command {
    command(program("CARGO", "cargo"))
}

/// The program that the environment variable names, or the usual one.
pub fn program(variable: &str, usual: &str) -> String {
    std::env::var(variable).ok().filter(|name| !name.is_empty()).unwrap_or_else(|| usual.into())
}

/// The C++ compiler (`CXX`, else `g++`), once it is known to start.
pub fn cxx() -> Result<String> {
    let name = program("CXX", "g++");
    if !succeeds(command(&name).arg("--version")) {
        bail!(
            "{name} does not start: install a C++17 compiler (Debian, Ubuntu: apt-get install g++), or set CXX"
        );
    }
    Ok(name)
}

/// Builds something with optimisation into this directory's `target`, wherever else cargo is told to build.
pub fn build_in_target(what: &[&str]) -> Result<()> {
    run(
        cargo().args(["build", "--release", "--quiet", "--target-dir", "target"]).args(what),
        &format!("cargo build {}", what.join(" ")),
    )
}

/// Whether the command starts and succeeds; its output is dropped.
pub fn succeeds(command: &mut Command) -> bool {
    command
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .status()
        .is_ok_and(|status| status.success())
}

/// Whether a compiler makes a program of nothing in a language, `c` or `c++`, with these flags.
pub fn compiles(compiler: &str, language: &str, flags: &[&str]) -> Result<bool> {
    let directory = root().join("target/compiles");
    create_dir(&directory)?;
    let source = directory.join("nothing.c");
    std::fs::write(&source, "int main(void) { return 0; }\n")
        .with_context(|| format!("cannot write {}", source.display()))?;
    let mut command = command(compiler);
    command.args(["-x", language]).args(flags).arg(&source).arg("-o").arg(directory.join("nothing"));
    Ok(succeeds(&mut command))
}

/// Runs the command with the caller's terminal; a failure reads "`what` failed".
pub fn run(command: &mut Command, what: &str) -> Result<()> {
    let status = command.status().map_err(|error| not_started(command, error))?;
    if !status.success() {
        bail!("{what} failed ({status})");
    }
    Ok(())
}

/// What the command prints, without the white space around it.
pub fn output(command: &mut Command, what: &str) -> Result<String> {
    let output = command.stderr(Stdio::inherit()).output().map_err(|error| not_started(command, error))?;
    if !output.status.success() {
        bail!("{what} failed ({})", output.status);
    }
    Ok(String::from_utf8(output.stdout).with_context(|| format!("{what}: not UTF-8"))?.trim().into())
}

/// The error for a program that could not be started.
pub fn not_started(command: &Command, error: std::io::Error) -> anyhow::Error {
    let name = command.get_program().to_string_lossy();
    match error.kind() {
        ErrorKind::NotFound => anyhow::anyhow!("{name} not found"),
        _ => anyhow::anyhow!("{name} does not start: {error}"),
    }
}

/// Creates the directory with its parents.
pub fn create_dir(directory: &Path) -> Result<()> {
    std::fs::create_dir_all(directory).with_context(|| format!("cannot create {}", directory.display()))
}

/// The files of the directory with this extension, sorted.
pub fn files_with_extension(directory: &Path, extension: &str) -> Result<Vec<PathBuf>> {
    let entries =
        std::fs::read_dir(directory).with_context(|| format!("cannot read {}", directory.display()))?;
    let mut files = Vec::new();
    for entry in entries {
        let path = entry?.path();
        if path.extension().is_some_and(|found| found == extension) {
            files.push(path);
        }
    }
    files.sort();
    Ok(files)
}

/// The path as seen from the root, for messages.
pub fn shown(path: &Path) -> std::path::Display<'_> {
    path.strip_prefix(root()).unwrap_or(path).display()
}

/// A duration as `12.3 s`.
pub fn seconds(duration: Duration) -> String {
    format!("{:.1} s", duration.as_secs_f64())
}
