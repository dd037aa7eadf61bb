//! Death of age.

use super::{Cause, Reaper, Verdicts};
use crate::force::State;
use crate::time::Time;
use core::ops::Range;

/// The last instant at which anybody dies.
const BEFORE_NEVER: Time = Time::from_ticks(Time::NEVER.ticks() - 1);

/// Ends those whose time has come.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lifetime;

impl Reaper for Lifetime {
    fn judge(&self, state: &State<'_>, rows: Range<usize>, verdicts: &mut Verdicts<'_>) {
        let last = state.time.min(BEFORE_NEVER);
        for (nth, &dies) in state.dies[rows].iter().enumerate() {
            if dies <= last {
                verdicts.end(nth, Cause::Lifetime);
            }
        }
    }
}
