//! Death of what is no longer a number.

use super::{CHUNK, Cause, Verdicts};
use crate::rows::{BLOCKS, are_finite};
use core::slice::from_ref;
use glam::Vec3;

/// Ends those whose place or velocity is not finite.
pub(crate) fn end_lost(position: &[Vec3], velocity: &[Vec3], verdicts: &mut Verdicts<'_>) {
    if !BLOCKS {
        return end_each(0, position, velocity, verdicts);
    }
    for (chunk, (x, v)) in position.chunks(CHUNK).zip(velocity.chunks(CHUNK)).enumerate() {
        if !(are_finite(x) && are_finite(v)) {
            end_each(CHUNK * chunk, x, v, verdicts);
        }
    }
}

/// The same of some rows from the first on, one by one.
fn end_each(first: usize, position: &[Vec3], velocity: &[Vec3], verdicts: &mut Verdicts<'_>) {
    for (nth, (x, v)) in position.iter().zip(velocity).enumerate() {
        if !(are_finite(from_ref(x)) && are_finite(from_ref(v))) {
            verdicts.end(first + nth, Cause::Nonfinite);
        }
    }
}
