//! A sub-step among those of its step.

use crate::math::max;

/// The square of an angle by which who turns in a sub-step has turned far.
pub(super) const FAR: f32 = 0.1;

/// The number of sub-steps' worth of driving within which two that come together count as at rest on each other, at least: what rests comes with
/// that of one, and in stacks with what rounding and their neighbours add to it.
const CALM: f32 = 4.0;

/// A sub-step \[s\], and the step it is a part of.
#[derive(Clone, Copy)]
pub(super) struct Span {
    pub(super) h: f32,
    pub(super) step: f32,
}

impl Span {
    /// The speed below which two come together by their weight, not by a blow, as a multiple of that which forces give them in a sub-step.
    #[inline(always)]
    pub(super) fn calm(self) -> f32 {
        max(self.step / self.h, CALM)
    }
}
