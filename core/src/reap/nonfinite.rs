//! Death of what is no longer a number.

use super::{CHUNK, Cause, Reaper, Verdicts};
use crate::force::State;
use crate::rows::{BLOCKS, are_finite};
use core::ops::Range;
use core::slice::from_ref;
use glam::Vec3;

/// Ends those whose place or velocity is not finite.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Nonfinite;

impl Reaper for Nonfinite {
    fn judge(&self, state: &State<'_>, rows: Range<usize>, verdicts: &mut Verdicts<'_>) {
        let (position, velocity) = (&state.position[rows.clone()], &state.velocity[rows]);
        if !BLOCKS {
            return end_lost(0, position, velocity, verdicts);
        }
        for (chunk, (x, v)) in position.chunks(CHUNK).zip(velocity.chunks(CHUNK)).enumerate() {
            if !(are_finite(x) && are_finite(v)) {
                end_lost(CHUNK * chunk, x, v, verdicts);
            }
        }
    }
}

/// Ends those of some rows from the first on whose place or velocity is not finite.
fn end_lost(first: usize, position: &[Vec3], velocity: &[Vec3], verdicts: &mut Verdicts<'_>) {
    for (nth, (x, v)) in position.iter().zip(velocity).enumerate() {
        if !(are_finite(from_ref(x)) && are_finite(from_ref(v))) {
            verdicts.end(first + nth, Cause::Nonfinite);
        }
    }
}
