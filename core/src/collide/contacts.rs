//! How particles that have a radius answer each other.

use super::each_by_itself;
use crate::index::Arrange;
use crate::observe::Observer;
use crate::report::Report;
use crate::scene::Scene;
use crate::time::Time;
use crate::view::View;

/// How particles that have a radius answer each other's touch: `()` not at all, [`Impulse`](crate::Impulse) when they
/// meet, [`Projection`](crate::Projection) by where they are. (By force: [`Penalty`](crate::Penalty) is one of the
/// scene's forces.)
pub trait Contacts: Sync {
    /// Whether particles pass through each other.
    #[doc(hidden)]
    fn is_empty(&self) -> bool {
        false
    }

    /// Vectors for each particle that it keeps through a step.
    #[doc(hidden)]
    fn held(&self, index: &dyn Arrange) -> usize {
        let _ = index;
        0
    }

    /// Vectors for each particle that it works with when the integrator has done its work.
    #[doc(hidden)]
    fn scratch(&self, index: &dyn Arrange) -> usize {
        let _ = index;
        0
    }

    /// Sends every free particle along its path.
    #[doc(hidden)]
    fn follow(&self, passage: Passage<'_, '_>) {
        each_by_itself(passage);
    }
}

impl Contacts for () {
    fn is_empty(&self) -> bool {
        true
    }
}

/// A step whose particles have been moved and are now to be held against colliders, sinks and each other.
#[allow(missing_debug_implementations)]
pub struct Passage<'p, 'v> {
    pub(crate) view: &'p mut View<'v>,
    pub(crate) scene: &'p Scene<'p>,
    /// Those from this row on are newborn.
    pub(crate) old: usize,
    pub(crate) dt: Time,
    pub(crate) end: Time,
    pub(crate) report: &'p mut Report,
    pub(crate) observer: &'p mut dyn Observer,
}
