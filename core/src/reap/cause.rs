//! Why particles die, and what becomes of them at a step's end.

/// Why a particle died. Of several causes in one step the last in this list counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize), serde(rename_all = "snake_case"))]
pub enum Cause {
    /// By age.
    Lifetime,
    /// By a rule of the program's own, or by `System::remove`; several rules count for themselves what is whose.
    Other,
    /// Where too many were.
    Density,
    /// By chance.
    Chance,
    /// It touched a sink.
    Sink,
    /// A number of its was no longer finite.
    Nonfinite,
}

/// The fate of a particle at the end of the step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, bytemuck::NoUninit)]
#[repr(u8)]
pub enum PendingDeath {
    /// It lives on.
    #[default]
    Lives,
    /// It dies of age.
    Lifetime,
    /// It dies by a rule of the program's own.
    Other,
    /// It dies where too many are.
    Density,
    /// It dies by chance.
    Chance,
    /// It touched a sink.
    Sink,
    /// A number of its is no longer finite.
    Nonfinite,
}

impl PendingDeath {
    /// Why it has to go, if it has.
    #[must_use]
    pub const fn cause(self) -> Option<Cause> {
        match self {
            Self::Lives => None,
            Self::Lifetime => Some(Cause::Lifetime),
            Self::Other => Some(Cause::Other),
            Self::Density => Some(Cause::Density),
            Self::Chance => Some(Cause::Chance),
            Self::Sink => Some(Cause::Sink),
            Self::Nonfinite => Some(Cause::Nonfinite),
        }
    }
}

impl From<Cause> for PendingDeath {
    fn from(cause: Cause) -> Self {
        match cause {
            Cause::Lifetime => Self::Lifetime,
            Cause::Other => Self::Other,
            Cause::Density => Self::Density,
            Cause::Chance => Self::Chance,
            Cause::Sink => Self::Sink,
            Cause::Nonfinite => Self::Nonfinite,
        }
    }
}
