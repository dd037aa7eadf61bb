//! How particles that have a radius answer each other.

use super::lists::Lists;
use super::sweep::each_by_itself;
use crate::index::Arrange;
use crate::observe::Observer;
use crate::report::Report;
use crate::scene::Scene;
use crate::step::View;
use crate::time::Time;
use glam::Vec3;

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

    /// Parts that the integrator's work on a step is cut into.
    #[doc(hidden)]
    fn substeps(&self) -> u32 {
        1
    }

    /// Before each.
    #[doc(hidden)]
    fn gather(&self, stage: &mut Stage<'_>, scratch: &mut [u32]) {
        let _ = (stage, scratch);
    }

    /// At the beginning of each: the state then, if it is kept.
    #[doc(hidden)]
    fn begin<'h>(&self, held: &'h mut [Vec3], position: &[Vec3], velocity: &[Vec3]) -> Option<[&'h [Vec3]; 2]> {
        let _ = (held, position, velocity);
        None
    }

    /// After each.
    #[doc(hidden)]
    fn project(&self, stage: &mut Stage<'_>) {
        let _ = stage;
    }

    /// Whether contacts have moved the particle in a row in this step.
    #[doc(hidden)]
    fn has_moved(&self, held: &[Vec3], row: usize) -> bool {
        let _ = (held, row);
        false
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

/// A sub-step whose particles have been moved by the integrator and are now to be moved apart.
#[allow(missing_debug_implementations)]
pub struct Stage<'a> {
    pub(crate) scene: &'a Scene<'a>,
    /// What is kept through the step.
    pub(crate) held: &'a mut [Vec3],
    pub(crate) lists: Lists,
    pub(crate) position: &'a mut [Vec3],
    pub(crate) velocity: &'a mut [Vec3],
    pub(crate) radius: &'a [f32],
    pub(crate) inverse_mass: &'a [f32],
    pub(crate) elasticity: &'a [f32],
    pub(crate) material: &'a [u16],
    /// When it begins, how long it is, how long the whole step is, and in how many that is cut.
    pub(crate) now: Time,
    pub(crate) h: Time,
    pub(crate) dt: Time,
    pub(crate) pieces: u32,
    /// The number of this one, from 0.
    pub(crate) piece: u32,
    pub(crate) report: &'a mut Report,
}
