//! `prob-water`: see the library beside it.

use std::process::ExitCode;

fn main() -> ExitCode {
    match prob_water_cli::run(std::env::args_os()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("prob-water: {message}");
            ExitCode::from(2)
        }
    }
}
