//! Files and folders that are to be gone when the program is, however it ends.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// How the names of temporary files and folders begin.
pub(crate) const PREFIX: &str = ".pointmass-";

/// All that there are. Who ends the program locks it for ever.
static ALL: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());

/// Keeps the program from being interrupted as long as it is held.
pub(crate) fn uninterrupted() -> MutexGuard<'static, BTreeSet<PathBuf>> {
    ALL.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A file or folder that is gone when this is dropped or the program interrupted, unless it has another name by then. A
/// folder that is not our own has to be empty.
#[derive(Debug)]
pub(crate) struct Temporary(PathBuf);

impl Temporary {
    /// The value that `make` makes, and its path.
    pub(crate) fn new<T, E>(make: impl FnOnce() -> Result<(T, PathBuf), E>) -> Result<(T, Self), E> {
        let mut all = uninterrupted();
        let (made, path) = make()?;
        all.insert(path.clone());
        Ok((made, Self(path)))
    }

    pub(crate) fn path(&self) -> &Path {
        &self.0
    }
}

impl Drop for Temporary {
    fn drop(&mut self) {
        remove(&self.0);
        uninterrupted().remove(&self.0);
    }
}

/// Whether its name says that it is temporary; folders made for files that are to stay have names of their own.
fn is_ours(path: &Path) -> bool {
    path.file_name().is_some_and(|name| name.to_string_lossy().starts_with(PREFIX))
}

/// Nobody is left to be told if that fails, and what has been given another name is not there.
fn remove(path: &Path) {
    let _ = match path.is_dir() {
        true if is_ours(path) => fs::remove_dir_all(path),
        true => fs::remove_dir(path),
        false => fs::remove_file(path),
    };
}

/// From now on, an interrupt removes what is temporary, lets `tell` say so, if there was any, and ends the program with 128 plus the signal's number.
#[cfg(unix)]
pub fn clean_up_when_interrupted(tell: impl FnOnce() + Send + 'static) {
    use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
    // What `nohup` starts outlives its terminal.
    let wanted = [SIGINT, SIGTERM, SIGHUP].into_iter().filter(|&signal| signal != SIGHUP || !is_ignored(SIGHUP));
    // Without signals, or a thread to wait for them, an interrupt leaves what it leaves.
    let Ok(mut signals) = signal_hook::iterator::Signals::new(wanted) else { return };
    let wait = move || {
        if let Some(signal) = signals.forever().next() {
            let all = uninterrupted();
            // What is in a folder goes before it.
            let (ours, folders): (Vec<_>, Vec<_>) = all.iter().partition(|path| is_ours(path));
            ours.into_iter().chain(folders).for_each(|path| remove(path));
            if !all.is_empty() {
                in_passing(tell);
            }
            std::process::exit(128 + signal);
        }
    };
    let _ = std::thread::Builder::new().name("interrupts".into()).spawn(wait);
}

/// Without signals there is nothing to wait for.
#[cfg(not(unix))]
pub fn clean_up_when_interrupted(_: impl FnOnce() + Send + 'static) {}

/// Lets somebody say something, but waits for him no longer than a second: who is to hear it may have stopped reading.
#[cfg(unix)]
fn in_passing(tell: impl FnOnce() + Send + 'static) {
    let (done, told) = std::sync::mpsc::channel();
    let say = move || {
        tell();
        let _ = done.send(());
    };
    if std::thread::Builder::new().spawn(say).is_ok() {
        let _ = told.recv_timeout(std::time::Duration::from_secs(1));
    }
}

/// Whether the program was started with a signal turned off; only Linux tells without unsafe code.
#[cfg(unix)]
fn is_ignored(signal: i32) -> bool {
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    let mask = mask.and_then(|digits| u64::from_str_radix(digits.trim(), 16).ok()).unwrap_or(0);
    mask >> (signal - 1) & 1 == 1
}
