//! Death of age.

use super::{Cause, Verdicts};
use crate::lanes::widest;
use crate::rows::BLOCKS;
use crate::time::Time;

/// Instants that are looked at together: four registers, and few enough to go through where somebody of them dies.
const FEW: usize = 16;

/// The last instant at which anybody dies.
const BEFORE_NEVER: Time = Time::from_ticks(Time::NEVER.ticks() - 1);

/// Ends those whose time has come by now: these are the instants at which all die.
pub(crate) fn end_old(dies: &[Time], now: Time, verdicts: &mut Verdicts<'_>) {
    let last = now.min(BEFORE_NEVER);
    if !BLOCKS {
        return end_due(0, dies, last, verdicts);
    }
    let next = last + Time::from_ticks(1);
    widest(
        #[inline(always)]
        || {
            let (chunks, rest) = dies.as_chunks::<FEW>();
            for (nth, dies) in chunks.iter().enumerate() {
                if may_end(dies, next) {
                    end_due(FEW * nth, dies, last, verdicts);
                }
            }
            end_due(dies.len() - rest.len(), rest, last, verdicts);
        },
    );
}

/// Ends those of some rows from the first on whose time has come by `last`.
#[inline(always)]
fn end_due(first: usize, dies: &[Time], last: Time, verdicts: &mut Verdicts<'_>) {
    for (nth, &dies) in dies.iter().enumerate() {
        if dies <= last {
            verdicts.end(first + nth, Cause::Lifetime);
        }
    }
}

/// Tells whether any of these instants may have come before `next`. The difference to that has the highest bit where it is below zero,
/// or where what dies later than in 68 years does: that has the bit itself.
#[inline(always)]
fn may_end(dies: &[Time; FEW], next: Time) -> bool {
    let next = next.ticks();
    let came = |any: u64, dies: &Time| any | (dies.ticks().wrapping_sub(next) & !dies.ticks());
    let is_late = next >> 63 != 0;
    is_late | (dies.iter().fold(0, came) >> 63 != 0)
}
