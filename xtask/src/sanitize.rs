//! Memory checkers: the C programs under valgrind and compiled with sanitizers, and the plugin with the address sanitizer.
//! A tool that is not there is named in a line, and what needs it is left out.

use crate::{build, c_api, setup, util};
use anyhow::Result;
use std::path::PathBuf;

/// All of it.
pub fn sanitize() -> Result<()> {
    valgrind()?;
    sanitized_c()?;
    plugin()
}

/// The C programs under valgrind: leaks and invalid reads fail. True if it was there.
pub fn valgrind() -> Result<bool> {
    if !util::succeeds(util::command("valgrind").arg("--version")) {
        println!(
            "sanitize: valgrind is missing (Debian, Ubuntu: apt-get install valgrind); its checks are left out"
        );
        return Ok(false);
    }
    let check = |program: PathBuf| -> Result<()> {
        let name = util::shown(&program).to_string();
        util::run(
            util::command("valgrind")
                .args([
                    "--quiet",
                    "--error-exitcode=99",
                    "--leak-check=full",
                    "--errors-for-leak-kinds=definite,indirect",
                ])
                .args(["--show-leak-kinds=definite,indirect", "--fair-sched=yes"])
                .arg(&program),
            &format!("{name} under valgrind"),
        )?;
        println!("sanitize: {name} under valgrind: no error, no leak");
        Ok(())
    };
    let programs = c_api::programs("c-test", &[])?;
    std::thread::scope(|scope| {
        let checks: Vec<_> = programs.into_iter().map(|program| scope.spawn(|| check(program))).collect();
        checks.into_iter().try_for_each(|check| check.join().expect("does not panic"))
    })?;
    Ok(true)
}

/// The C programs compiled with the sanitizers of addresses and undefined behaviour. The library itself, Rust, is not
/// instrumented; its allocations and what C does with them are seen.
fn sanitized_c() -> Result<()> {
    const FLAGS: [&str; 3] = ["-g", "-fsanitize=address,undefined", "-fno-sanitize-recover=all"];
    if !util::compiles(&util::program("CC", "cc"), "c", &FLAGS)? {
        println!(
            "sanitize: this C compiler has no libasan or libubsan; the C programs with sanitizers are left out"
        );
        return Ok(());
    }
    for program in c_api::programs("c-sanitized", &FLAGS)? {
        let name = util::shown(&program).to_string();
        util::run(&mut util::command(&program), &name)?;
        println!(
            "sanitize: {name} with the sanitizers of addresses and undefined behaviour: no error, no leak"
        );
    }
    Ok(())
}

/// The plugin with the address sanitizer, loaded by a Python that is not instrumented.
fn plugin() -> Result<()> {
    const FLAGS: [&str; 2] = ["-g", "-fsanitize=address"];
    let compiler = util::cxx()?;
    if !util::compiles(&compiler, "c++", &FLAGS)? {
        println!("sanitize: {compiler} has no libasan; the plugin with it is left out");
        return Ok(());
    }
    // The second one so that the first finds what it wraps of C++'s exceptions.
    let libraries = ["libasan.so", "libstdc++.so.6"].map(|name| {
        util::output(util::command(&compiler).arg(format!("-print-file-name={name}")), "asking for libraries")
    });
    let [sanitizer, exceptions] = libraries;
    let preloaded = format!("{} {}", sanitizer?, exceptions?);
    let out = util::root().join("target/mitsuba-sanitized");
    build::build_with(&out, &build::ALONE, &FLAGS)?;
    util::run(
        setup::module("validation.tests.sanitized")
            .env("PROB_WATER_PLUGINS", &out)
            .env("LD_PRELOAD", preloaded)
            // Python and Mitsuba keep what they allocate.
            .env("ASAN_OPTIONS", "detect_leaks=0:halt_on_error=1:exitcode=99:handle_segv=0")
            .env("PYTHONDONTWRITEBYTECODE", "1")
            .env("PYTHONMALLOC", "malloc"),
        "validation.tests.sanitized with the address sanitizer",
    )
}
