//! The clock that measurements are held against: what this thread had of the processor, where the system says so.
//!
//! On the wall, time goes on while another program has the processor, which on a busy machine is most of what a short
//! measurement sees.

use std::time::Duration;

/// The kind of time that the clock shows, for those who read a report.
pub(crate) const SHOWS: &str = if cfg!(any(target_os = "linux", target_os = "macos")) {
    "processor time of one thread, so that waiting for other programs does not count"
} else {
    "time on the wall, since this system has no exact clock of processor time"
};

/// A clock that runs.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stopwatch(Duration);

impl Stopwatch {
    pub(crate) fn start() -> Self {
        Self(now())
    }

    /// Time since the start.
    pub(crate) fn elapsed(self) -> Duration {
        now().saturating_sub(self.0)
    }
}

#[cfg(any(target_os = "linux", target_os = "macos"))]
fn now() -> Duration {
    let now = rustix::time::clock_gettime(rustix::time::ClockId::ThreadCPUTime);
    Duration::new(u64::try_from(now.tv_sec).unwrap_or(0), u32::try_from(now.tv_nsec).unwrap_or(0))
}

#[cfg(not(any(target_os = "linux", target_os = "macos")))]
fn now() -> Duration {
    use std::sync::OnceLock;
    use std::time::Instant;
    static START: OnceLock<Instant> = OnceLock::new();
    START.get_or_init(Instant::now).elapsed()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_runs_while_there_is_work() {
        let watch = Stopwatch::start();
        let mut last = Duration::ZERO;
        while last == Duration::ZERO {
            last = watch.elapsed();
        }
        assert!(watch.elapsed() >= last);
    }
}
