//! A sub-step, and what strains count for that change in it.

/// A sub-step.
pub(super) struct Step {
    /// How long it is \[s\].
    pub(super) h: f32,
    /// The seconds of a strain's rate that count as strain.
    pub(super) lag: f32,
    /// How much stiffer that makes a change within the sub-step.
    pub(super) rate: f32,
}

impl Step {
    /// A strain that was another when the sub-step began, and what its rate adds: a strain that stands still is felt as it is.
    pub(super) fn felt(&self, now: f32, before: f32) -> f32 {
        now + self.lag / self.h * (now - before)
    }
}
