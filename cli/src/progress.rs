//! A progress bar on standard error, for runs long enough to wonder.

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::sync::mpsc::{self, RecvTimeoutError, Sender};
use std::thread;
use std::time::Duration;

/// Shown once a run has lasted this long.
const PATIENCE: Duration = Duration::from_millis(700);

/// Progress through a known number of steps; invisible where standard error is no terminal, and gone when dropped.
pub(crate) struct Progress {
    bar: ProgressBar,
    /// Who shows the bar ends once this is gone.
    _until: Sender<()>,
}

impl Progress {
    pub(crate) fn new(steps: u64) -> Self {
        let bar = ProgressBar::with_draw_target(Some(steps), ProgressDrawTarget::hidden());
        if let Ok(style) = ProgressStyle::with_template("{bar:40} {pos}/{len} steps, {eta} left  {msg}") {
            bar.set_style(style);
        }
        let (_until, over) = mpsc::channel();
        let shown = bar.clone();
        let show = move || {
            // Also where the first step takes long.
            if over.recv_timeout(PATIENCE) == Err(RecvTimeoutError::Timeout) {
                shown.set_draw_target(ProgressDrawTarget::stderr());
                shown.enable_steady_tick(PATIENCE);
            }
        };
        // Without a thread there is no bar.
        let _ = thread::Builder::new().spawn(show);
        Self { bar, _until }
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
        self.bar.set_length(self.bar.position() + units + left);
        self.bar.inc(units);
        if !self.bar.is_hidden() {
            self.bar.set_message(crate::outcome::harmless(doing));
        }
    }

    /// So many of the units further.
    pub(crate) fn advance(&mut self, units: u64, doing: impl FnOnce() -> String) {
        self.bar.inc(units);
        if !self.bar.is_hidden() {
            self.bar.set_message(doing());
        }
    }

    /// One step further.
    pub(crate) fn step(&mut self, particles: usize) {
        self.advance(1, || format!("{particles} particles"));
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        // Before what is said next.
        self.bar.finish_and_clear();
    }
}
