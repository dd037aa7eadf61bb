//! A sub-step among those of its step.

/// A sub-step \[s\], and the step it is a part of.
#[derive(Clone, Copy)]
pub(super) struct Span {
    pub(super) h: f32,
    pub(super) step: f32,
}
