//! Heaps: contacts held by moving particles apart, in sub-steps.

use super::contacts::{Contacts, Stage};
use super::lists::{self, HELD};
use super::solver;
use crate::index::Arrange;
use glam::Vec3;

/// Contacts held by position, for heaps: the step is cut into sub-steps, and in each the integrator moves everything, then
/// whatever overlaps is moved apart, with friction and elasticity, and velocities follow.
///
/// Friction is Coulomb's: it takes up to the coefficient times the change of velocity by which the contact presses in the
/// sub-step, bounces counted in, whichever the method and however deep the overlap. What it holds at rest on scenery or on
/// something fixed stays where it is, to the bit.
///
/// XPBD with one iteration for each of many small steps (Macklin et al., "Small Steps in Physics Simulation", SCA 2019; Müller
/// et al., "Detailed Rigid Body Simulation with Extended Position Based Dynamics", SCA 2020). A softness in m/N is the same
/// however many sub-steps there are.
///
/// Of two that rest on each other the lower one gives way less (Macklin et al., "Unified Particle Physics for Real-Time
/// Applications", SIGGRAPH 2014, section 5.3), so that overlap hardly grows with the height of a heap; momentum is exact for all
/// that meet faster than gravity makes them in a step, and where nothing drives them. In a heap a contact therefore presses by
/// less than the weight above it; friction counts in what is missing, so that a stack slides as far as one ball does and what
/// can rest on others comes to stand still (six on each other, or steps of 1/24 s, ask for 12 sub-steps). Balls do not spin.
/// Hits and contacts of this kind are counted in every sub-step, and [`Observer`](crate::Observer)s are not told of them.
///
/// Contacts are gone through from the ground up, in the same order whatever index has found them: while no list is full
/// (`caps.contacts`), bits do not depend on it.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default, deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Projection {
    /// Sub-steps of a step, 1 to 1000.
    pub substeps: u32,
    /// How far a contact gives way to a force \[m/N\]: zero is hard.
    pub compliance: f32,
}

impl Default for Projection {
    fn default() -> Self {
        Self { substeps: 12, compliance: 0.0 }
    }
}

impl Contacts for Projection {
    fn held(&self, _: &dyn Arrange) -> usize {
        HELD
    }

    fn scratch(&self, index: &dyn Arrange) -> usize {
        index.columns()
    }

    fn substeps(&self) -> u32 {
        self.substeps.clamp(1, 1000)
    }

    #[inline(never)]
    fn gather(&self, stage: &mut Stage<'_>, scratch: &mut [u32]) {
        lists::gather(stage, scratch);
    }

    fn begin<'h>(&self, held: &'h mut [Vec3], position: &[Vec3], velocity: &[Vec3]) -> Option<[&'h [Vec3]; 2]> {
        Some(solver::begin(held, position, velocity))
    }

    #[inline(never)]
    fn project(&self, stage: &mut Stage<'_>) {
        solver::project(stage, self.compliance);
    }

    fn has_moved(&self, held: &[Vec3], row: usize) -> bool {
        lists::is_marked(held, row)
    }
}
