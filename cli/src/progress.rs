//! A bar on a terminal, for what takes over a second.

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::io::{self, IsTerminal};
use std::sync::Once;
use std::time::{Duration, Instant};

/// How far a run has come; silent for a second, and wherever standard error is not a terminal.
pub struct Progress {
    bar: ProgressBar,
    start: Instant,
    wanted: bool,
    shown: Once,
}

impl Progress {
    /// A run of so many steps. Rows that scroll by on the terminal show progress enough.
    pub fn new(steps: u64, to_file: bool) -> Self {
        let bar = ProgressBar::with_draw_target(Some(steps), ProgressDrawTarget::hidden()).with_style(
            ProgressStyle::with_template("{wide_bar} {percent:>3} %, {eta} left").expect("a valid template"),
        );
        let wanted = to_file || !io::stdout().is_terminal();
        Self { bar, start: Instant::now(), wanted, shown: Once::new() }
    }

    /// So many steps were done by an earlier run, which tells nothing of how long the rest takes.
    pub fn resumed(self, steps: u64) -> Self {
        self.bar.set_position(steps);
        self.bar.reset_eta();
        self
    }

    /// So many steps are done.
    pub fn at(&self, step: u64) {
        self.show();
        self.bar.set_position(step);
    }

    /// So many more steps are done; any thread may say so.
    pub fn add(&self, steps: u64) {
        self.show();
        self.bar.inc(steps);
    }

    /// Takes the bar off the terminal for as long as something else is written there.
    pub fn aside<R>(&self, write: impl FnOnce() -> R) -> R {
        self.bar.suspend(write)
    }

    fn show(&self) {
        if self.wanted && self.start.elapsed() > Duration::from_secs(1) {
            self.shown.call_once(|| self.bar.set_draw_target(ProgressDrawTarget::stderr()));
        }
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}
