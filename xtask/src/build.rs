//! The Mitsuba plugins: Rust's static library and the C++ shim, linked by g++ against the headers and libraries in the
//! Python wheels. CMake and a source tree of Mitsuba are not needed.

use crate::{cargo, setup, util};
use anyhow::{Context, Result, bail};
use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::{Instant, SystemTime};

/// What is compiled for the plugins alone.
pub const ALONE: [&str; 3] = ["--release", "-p", "prob-water-mitsuba"];

/// Each is `mitsuba-plugin/cpp/<name>.cpp` and becomes `plugins/<name>.impl.so`, which `load.cpp` as `plugins/<name>.so` opens.
const PLUGINS: [&str; 2] = ["prob_water", "prob_water_surface"];

/// As the wheels were compiled: the layout of Dr.Jit's arrays depends on the instruction set, and a plugin compiled
/// without AVX2 and FMA loads and returns wrong numbers.
const COMPILE: &str = "-std=c++17 -O3 -DNDEBUG -march=x86-64-v3 -fno-strict-aliasing -fno-math-errno \
                       -fvisibility=hidden -fPIC -shared -Wall -Wextra";

/// Rust's symbols stay inside the plugin; whatever is missing is said now, and what another Mitsuba lacks when the plugin is
/// loaded, not in mid-frame.
const LINK: &str =
    "-lmitsuba -ldrjit-core -ldrjit-extra -lpthread -ldl -lm -Wl,--exclude-libs,ALL -Wl,-z,defs -Wl,-z,now";

/// Where the plugins go unless told otherwise; `mi.file_resolver().append` of it makes them loadable.
pub fn default_out() -> PathBuf {
    util::root().join("target/mitsuba")
}

/// Builds the plugins into `out/plugins`.
pub fn build(out: &Path) -> Result<()> {
    build_with(out, &ALONE, &[])
}

/// The same, from the selection of packages that cargo is told to compile, and by the C++ compiler with further flags.
pub fn build_with(out: &Path, selection: &[&str], flags: &[&str]) -> Result<()> {
    let start = Instant::now();
    check_processor()?;
    setup::setup()?;
    println!("build: the Rust core");
    let rust = cargo::static_library("mitsuba-plugin", &[&["build"], selection].concat())?;
    let bridge =
        rust.out_dir.context("the build script of prob-water-mitsuba did not run")?.join("cxxbridge/include");
    let packages = site_packages()?;
    let versions = [("MITSUBA", setup::version("mitsuba")?), ("DRJIT", setup::version("drjit")?)]
        .map(|(name, version)| format!("-DPROB_WATER_{name}=\"{version}\""));
    let sources = util::root().join("mitsuba-plugin/cpp");
    let directory = out.join("plugins");
    util::create_dir(&directory)?;
    let cxx = util::cxx()?;
    let newest_input = newest(&[&rust.library, &bridge, &sources, &setup::stamp()])?;

    let base = || {
        let mut compiler = util::command(&cxx);
        compiler.args(COMPILE.split_whitespace()).args(flags);
        compiler
    };
    let plugin = |name: &str| {
        let mut compiler = base();
        compiler.arg("-I").arg(&sources).arg("-I").arg(&bridge);
        for include in
            ["mitsuba/include", "drjit/include", "nanobind/include", "nanobind/ext/robin_map/include"]
        {
            compiler.arg("-isystem").arg(packages.join(include));
        }
        // Behind all others: a wheel that ships the header goes first.
        compiler.arg("-idirafter").arg(sources.join("compat"));
        compiler.arg(sources.join(name).with_extension("cpp")).arg(&rust.library);
        compiler.arg("-L").arg(packages.join("mitsuba")).arg("-L").arg(packages.join("drjit"));
        compiler.args(LINK.split_whitespace());
        compile(&mut compiler, &directory.join(name).with_extension("impl.so"), newest_input)?;

        let mut loader = base();
        loader.args(&versions).arg(sources.join("load.cpp")).args(["-ldl", "-Wl,-z,defs", "-Wl,-z,now"]);
        compile(&mut loader, &directory.join(name).with_extension("so"), newest_input)
    };
    std::thread::scope(|scope| {
        let plugins = PLUGINS.map(|name| scope.spawn(move || plugin(name)));
        plugins.into_iter().try_for_each(|plugin| plugin.join().expect("does not panic"))
    })?;
    println!("build: done in {}", util::seconds(start.elapsed()));
    Ok(())
}

/// Compiles one library unless it is newer than its inputs and was made by the same command.
fn compile(compiler: &mut Command, library: &Path, newest_input: SystemTime) -> Result<()> {
    let partial = library.with_extension("so.part");
    compiler.arg("-o").arg(&partial);
    let stamp = library.with_extension("command");
    let words: Vec<_> = std::iter::once(compiler.get_program())
        .chain(compiler.get_args())
        .map(|word| word.to_string_lossy())
        .collect();
    let line = words.join(" ");
    let is_newer =
        fs::metadata(library).and_then(|found| found.modified()).is_ok_and(|time| time >= newest_input);
    if is_newer && fs::read_to_string(&stamp).is_ok_and(|found| found == line) {
        println!("build: {} is up to date", util::shown(library));
        return Ok(());
    }
    println!("build: compiling {} (half a minute)", util::shown(library));
    let start = SystemTime::now();
    util::run(compiler, &format!("compiling {}", util::shown(library)))?;
    // Dated by the start, so that a source edited meanwhile is seen as newer.
    File::options().append(true).open(&partial)?.set_modified(start)?;
    fs::rename(&partial, library).with_context(|| format!("cannot write {}", library.display()))?;
    fs::write(&stamp, line).with_context(|| format!("cannot write {}", stamp.display()))
}

/// The wheels contain AVX2 and FMA code, and so does the plugin.
fn check_processor() -> Result<()> {
    #[cfg(all(target_arch = "x86_64", target_os = "linux"))]
    {
        if !(is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma")) {
            bail!("this processor lacks AVX2 or FMA, which Mitsuba's wheels and the plugin are compiled for");
        }
        Ok(())
    }
    #[cfg(not(all(target_arch = "x86_64", target_os = "linux")))]
    bail!(
        "the plugin is built on x86-64 Linux only; the Rust core, its C interface and the command build anywhere"
    )
}

fn site_packages() -> Result<PathBuf> {
    let code = "import sysconfig; print(sysconfig.get_path('platlib'))";
    Ok(util::output(util::command(setup::python()).args(["-c", code]), "asking for site-packages")?.into())
}

/// The latest modification of the files at these paths and below.
fn newest(paths: &[&Path]) -> Result<SystemTime> {
    let mut latest = SystemTime::UNIX_EPOCH;
    for path in paths {
        let metadata = fs::metadata(path).with_context(|| format!("cannot read {}", path.display()))?;
        // A directory's own date counts as well: it changes when a file is removed.
        latest = latest.max(metadata.modified()?);
        if metadata.is_dir() {
            for entry in fs::read_dir(path)? {
                latest = latest.max(newest(&[&entry?.path()])?);
            }
        }
    }
    Ok(latest)
}
