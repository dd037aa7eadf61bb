//! Death of age.

use super::{CHUNK, Cause, FEW, Reaper, Verdicts};
use crate::force::State;
use crate::lanes::widest;
use crate::rows::BLOCKS;
use crate::time::Time;
use core::ops::Range;

/// The last instant at which anybody dies.
const BEFORE_NEVER: Time = Time::from_ticks(Time::NEVER.ticks() - 1);

/// Ends those whose time has come.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Lifetime;

impl Reaper for Lifetime {
    fn judge(&self, state: &State<'_>, rows: Range<usize>, verdicts: &mut Verdicts<'_>) {
        let last = state.time.min(BEFORE_NEVER);
        let (dies, next) = (&state.dies[rows], last + Time::from_ticks(1));
        widest(
            #[inline(always)]
            || {
                let (chunks, rest) = dies.as_chunks::<CHUNK>();
                for (nth, dies) in chunks.iter().enumerate() {
                    if !BLOCKS || may_end(dies, next) {
                        end_few(CHUNK * nth, dies, [last, next], verdicts);
                    }
                }
                end_few(dies.len() - rest.len(), rest, [last, next], verdicts);
            },
        );
    }
}

/// Ends those of some rows from the first on whose time has come by `last`, which is before `next`.
#[inline(always)]
fn end_few(first: usize, dies: &[Time], [last, next]: [Time; 2], verdicts: &mut Verdicts<'_>) {
    for (few, dies) in dies.chunks(FEW).enumerate().filter(|(_, dies)| !BLOCKS || may_end(dies, next)) {
        for (nth, &dies) in dies.iter().enumerate() {
            if dies <= last {
                verdicts.end(first + FEW * few + nth, Cause::Lifetime);
            }
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
