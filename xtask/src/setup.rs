//! The Python environments: `.venv` for the plugin, its tests and renders, `.venv-peer` for the renderer it is
//! compared with (both Mitsubas are a module named `mitsuba`, so they cannot share one).
//!
//! A stamp with the content of the requirements is written last; an environment is left alone while its stamp
//! agrees, and an interrupted installation is done again.

use crate::util;
use anyhow::{Context, Result, bail};
use std::fs;
use std::path::PathBuf;
use std::process::Command;

/// An environment and what pip is told to install in it: a file of requirements after `-r`, or packages.
struct Environment<'a> {
    directory: &'a str,
    packages: &'a [&'a str],
}

const MAIN: Environment =
    Environment { directory: ".venv", packages: &["-r", "validation/requirements.txt"] };
const PEER: Environment =
    Environment { directory: ".venv-peer", packages: &["-r", "validation/requirements-peer.txt"] };

/// Succeeds in a Python that the pinned packages support.
const SUPPORTED: &str = "import sys; sys.exit(sys.version_info < (3, 11))";
const INSTALL_PYTHON: &str = "install Python 3.11 or newer with its venv module (Debian, Ubuntu: apt-get install \
                              python3 python3-venv), or set PYTHON to such an interpreter";

/// Sets up `.venv`, after checking for the compiler that the plugin needs.
pub fn setup() -> Result<()> {
    util::cxx()?;
    MAIN.install()
}

/// Sets up `.venv-peer`.
pub fn peer() -> Result<()> {
    PEER.install()
}

/// Sets up `.venv-<version>` with this version of Mitsuba and nothing else; its interpreter.
pub fn mitsuba(version: &str) -> Result<PathBuf> {
    let (directory, package) = (format!(".venv-{version}"), format!("mitsuba=={version}"));
    let environment = Environment { directory: &directory, packages: &[&package] };
    environment.install()?;
    Ok(environment.python())
}

/// The version of a package in `.venv`.
pub fn version(package: &str) -> Result<String> {
    let code = format!("import importlib.metadata; print(importlib.metadata.version('{package}'))");
    util::output(util::command(python()).args(["-c", &code]), "asking for a version")
}

/// A module, run by the interpreter of `.venv`.
pub fn module(name: &str) -> Command {
    let mut command = util::command(python());
    command.args(["-m", name]);
    command
}

/// The interpreter of `.venv`.
pub fn python() -> PathBuf {
    MAIN.python()
}

/// The stamp of `.venv`: newer than everything installed there.
pub fn stamp() -> PathBuf {
    MAIN.stamp()
}

impl Environment<'_> {
    fn python(&self) -> PathBuf {
        util::root().join(self.directory).join("bin/python")
    }

    fn stamp(&self) -> PathBuf {
        util::root().join(self.directory).join("requirements.stamp")
    }

    fn install(&self) -> Result<()> {
        let named = self.packages.join(" ");
        let wanted = match self.packages {
            ["-r", file] => fs::read_to_string(util::root().join(file)),
            _ => Ok(named.clone()),
        }
        .with_context(|| format!("cannot read {named}"))?;
        if self.python().exists() && fs::read_to_string(self.stamp()).is_ok_and(|found| found == wanted) {
            println!("setup: {} is up to date", self.directory);
            return Ok(());
        }
        let _ = fs::remove_file(self.stamp());
        if !self.is_usable() {
            self.create()?;
        }
        println!("setup: installing {named} (a few minutes the first time)");
        // Wheels only: a package that has none for this Python is said at once, instead of half an hour of compiling.
        util::run(
            util::command(self.python())
                .args(["-m", "pip", "install", "--quiet", "--only-binary", ":all:"])
                .args(self.packages),
            &format!("pip install {named} in {}", self.directory),
        )?;
        fs::write(self.stamp(), wanted)
            .with_context(|| format!("cannot write {}", self.stamp().display()))?;
        println!("setup: {} is ready", self.directory);
        Ok(())
    }

    /// Whether the environment is there, complete enough to install into, and not too old.
    fn is_usable(&self) -> bool {
        util::succeeds(util::command(self.python()).args(["-c", &format!("import pip; {SUPPORTED}")]))
    }

    fn create(&self) -> Result<()> {
        let python = util::program("PYTHON", "python3");
        let says = |code: &str| util::succeeds(util::command(&python).args(["-c", code]));
        if !says("") {
            bail!("{python} does not start: {INSTALL_PYTHON}");
        }
        let version = util::output(
            util::command(&python).args(["-c", "import platform; print(platform.python_version())"]),
            &python,
        )?;
        if !says(SUPPORTED) {
            bail!("{python} is Python {version}, too old for the pinned packages: {INSTALL_PYTHON}");
        }
        if !says("import venv, ensurepip") {
            bail!("{python} has no venv module: install it (Debian, Ubuntu: apt-get install python3-venv)");
        }
        println!("setup: creating {} with {python} (Python {version})", self.directory);
        util::run(
            util::command(&python).args(["-m", "venv", "--clear", self.directory]),
            &format!("{python} -m venv {}", self.directory),
        )
    }
}
