//! A progress bar on standard error, for runs long enough to wonder.

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressFinish, ProgressStyle};
use std::time::{Duration, Instant};

/// Shown once a run has lasted this long.
const PATIENCE: Duration = Duration::from_millis(700);

/// Progress through a known number of steps; invisible where standard error is no terminal, and gone when dropped.
pub(crate) struct Progress {
    bar: ProgressBar,
    since: Instant,
    shown: bool,
}

impl Progress {
    pub(crate) fn new(steps: u64) -> Self {
        let bar = ProgressBar::with_draw_target(Some(steps), ProgressDrawTarget::hidden());
        let bar = bar.with_finish(ProgressFinish::AndClear);
        if let Ok(style) = ProgressStyle::with_template("{bar:40} {pos}/{len} steps, {eta} left  {msg}") {
            bar.set_style(style);
        }
        Self { bar, since: Instant::now(), shown: false }
    }

    /// Progress through work of which only the sum is known.
    pub(crate) fn of_work(units: u64) -> Self {
        let progress = Self::new(units);
        if let Ok(style) = ProgressStyle::with_template("{bar:40} {percent} %, {eta} left  {wide_msg}") {
            progress.bar.set_style(style);
        }
        progress
    }

    /// So many units further, and about so many left.
    pub(crate) fn work(&mut self, units: u64, left: u64, doing: &str) {
        self.show();
        self.bar.set_length(self.bar.position() + units + left);
        self.bar.inc(units);
        if self.shown {
            self.bar.set_message(crate::outcome::harmless(doing));
        }
    }

    fn show(&mut self) {
        if !self.shown && self.since.elapsed() > PATIENCE {
            self.bar.set_draw_target(ProgressDrawTarget::stderr());
            self.shown = true;
        }
    }

    /// One step further.
    pub(crate) fn step(&mut self, particles: usize) {
        self.show();
        self.bar.inc(1);
        if self.shown {
            self.bar.set_message(format!("{particles} particles"));
        }
    }
}
