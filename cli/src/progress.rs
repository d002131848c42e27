//! A bar on a terminal, for what takes over a second.

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::io::{self, IsTerminal};
use std::time::{Duration, Instant};

/// How far a run has come; silent for a second, and wherever standard error is not a terminal.
pub struct Progress {
    bar: ProgressBar,
    start: Instant,
    wanted: bool,
}

impl Progress {
    /// A run of so many steps. Rows that scroll by on the terminal show progress enough.
    pub fn new(steps: u64, to_file: bool) -> Self {
        let bar = ProgressBar::with_draw_target(Some(steps), ProgressDrawTarget::hidden())
            .with_style(ProgressStyle::with_template("{wide_bar} {percent:>3} %").expect("a valid template"));
        Self { bar, start: Instant::now(), wanted: to_file || !io::stdout().is_terminal() }
    }

    /// So many steps are done.
    pub fn at(&self, step: u64) {
        if self.wanted && self.bar.is_hidden() && self.start.elapsed() > Duration::from_secs(1) {
            self.bar.set_draw_target(ProgressDrawTarget::stderr());
        }
        self.bar.set_position(step);
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}
