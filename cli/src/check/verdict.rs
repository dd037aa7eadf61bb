//! How a method stands the step that is judged.

use super::study::Stand;
use pointmass::stability::Limit;
use serde::{Serialize, Serializer};

/// How a method stands the step that is judged.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Verdict {
    /// The method chooses its own.
    Own,
    /// Nothing grows.
    Stable,
    /// Nothing grows of what was looked at, and there are forces that were not.
    NotKnown,
    /// Nothing grows where the scene starts, but in other poses of its springs something may.
    NotInEveryPose,
    /// Oscillations that nothing damps grow, as at any step.
    Grows,
    /// Something grows.
    Unstable,
}

impl Verdict {
    /// The verdict on steps of so long \[s\], once all limits are known, and whether all forces were looked at.
    pub(crate) fn on(stand: &Stand, h: f64, is_whole: bool) -> Self {
        let others = stand.drag.and(stand.contact).and(stand.goal).and(stand.gas);
        match stand.every_pose {
            _ if stand.chooses_steps => Self::Own,
            Limit::Never if stand.growth_across > 0.0 => Self::Grows,
            _ if !stand.stable && stand.at_rest.and(others).admits(h) => Self::NotInEveryPose,
            _ if !stand.stable => Self::Unstable,
            _ if !is_whole => Self::NotKnown,
            _ => Self::Stable,
        }
    }

    /// Its name in files.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Own => "chooses_its_own_steps",
            Self::Stable => "stable",
            Self::NotKnown => "not_known",
            Self::NotInEveryPose => "not_in_every_pose",
            Self::Grows => "grows",
            Self::Unstable => "unstable",
        }
    }
}

impl Serialize for Verdict {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.name())
    }
}
