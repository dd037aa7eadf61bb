//! Death of age.

use super::{CHUNK, Cause, FEW, Verdicts};
use crate::lanes::widest;
use crate::rows::BLOCKS;
use crate::time::Time;

/// The last instant at which anybody dies.
const BEFORE_NEVER: Time = Time::from_ticks(Time::NEVER.ticks() - 1);

/// Ends those whose time has come by now: these are the instants at which all die.
pub(crate) fn end_old(dies: &[Time], now: Time, verdicts: &mut Verdicts<'_>) {
    let last = now.min(BEFORE_NEVER);
    if !BLOCKS {
        return end_due(0, dies, last, verdicts);
    }
    let next = last + Time::from_ticks(1);
    let mut end_few = |first: usize, dies: &[Time]| {
        for (few, dies) in dies.chunks(FEW).enumerate().filter(|(_, dies)| may_end(dies, next)) {
            end_due(first + FEW * few, dies, last, verdicts);
        }
    };
    widest(
        #[inline(always)]
        || {
            let (chunks, rest) = dies.as_chunks::<CHUNK>();
            for (nth, dies) in chunks.iter().enumerate() {
                if may_end(dies, next) {
                    end_few(CHUNK * nth, dies);
                }
            }
            end_few(dies.len() - rest.len(), rest);
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
fn may_end(dies: &[Time], next: Time) -> bool {
    let next = next.ticks();
    let came = |any: u64, dies: &Time| any | (dies.ticks().wrapping_sub(next) & !dies.ticks());
    let is_late = next >> 63 != 0;
    is_late | (dies.iter().fold(0, came) >> 63 != 0)
}
