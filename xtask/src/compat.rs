//! Other versions of Mitsuba than the plugin is built for, each in an environment of its own: they must refuse it in a sentence.

use crate::{build, setup, util};
use anyhow::Result;

const OTHERS: [&str; 3] = ["3.9.0", "3.8.0", "3.7.1"];

/// Loads the plugin into each.
pub fn compat() -> Result<()> {
    build::build(&build::default_out())?;
    let built = setup::version("mitsuba")?;
    for version in OTHERS {
        let python = setup::mitsuba(version)?;
        util::run(
            util::command(python)
                .args(["-m", "validation.tests.compat", &built])
                .env("PYTHONDONTWRITEBYTECODE", "1"),
            &format!("validation.tests.compat with Mitsuba {version}"),
        )?;
    }
    Ok(())
}
