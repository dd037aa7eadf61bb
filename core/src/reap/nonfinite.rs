//! Death of what is no longer a number.

use super::{CHUNK, Cause, Reaper, Verdicts};
use crate::force::State;
use crate::rows::are_finite;
use core::ops::Range;
use core::slice::from_ref;

/// Ends those whose place or velocity is not finite.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Nonfinite;

impl Reaper for Nonfinite {
    fn judge(&self, state: &State<'_>, rows: Range<usize>, verdicts: &mut Verdicts<'_>) {
        let moving = state.position[rows.clone()].chunks(CHUNK).zip(state.velocity[rows].chunks(CHUNK));
        for (chunk, (x, v)) in moving.enumerate().filter(|(_, (x, v))| !(are_finite(x) && are_finite(v))) {
            for (nth, (x, v)) in x.iter().zip(v).enumerate() {
                if !(are_finite(from_ref(x)) && are_finite(from_ref(v))) {
                    verdicts.end(CHUNK * chunk + nth, Cause::Nonfinite);
                }
            }
        }
    }
}
