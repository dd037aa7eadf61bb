//! The particles that a sub-step moves, and how constraints are called upon to.

use super::{Bodies, Constraint, Near, Share, Substep};
use crate::custom::CustomColumnsMut;
use crate::force::Attributes;
use crate::index::{IndexChoice, ListMemory};
use crate::integrate::Integrator;
use crate::memory::{Layout, Scratch};
use crate::observe::{Observer, Phase};
use crate::reap::PendingDeath;
use crate::report::Report;
use crate::shape::Collider;
use crate::time::Time;
use glam::Vec3;

/// The function that constraints call for in a step. A program without constraints does not carry it about.
#[derive(Clone, Copy, Debug)]
pub struct ConstraintCode(pub(crate) fn(&mut Moved<'_>, Moment, Substep));

impl ConstraintCode {
    /// All of it.
    pub const ALL: Self = Self(constrain);
}

/// The phases of a sub-step in which constraints are called.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Moment {
    /// The one before the method moves everything.
    Before,
    /// The one after that.
    After,
}

/// The particles that a sub-step moves, and the memory for it.
pub(crate) struct Moved<'a> {
    pub(crate) constraints: &'a dyn Constraint,
    pub(crate) colliders: &'a dyn Collider,
    pub(crate) index: &'a dyn IndexChoice,
    pub(crate) integrator: &'a dyn Integrator,
    pub(crate) attributes: &'a Attributes<'a>,
    pub(crate) position: &'a mut [Vec3],
    pub(crate) velocity: &'a mut [Vec3],
    /// Places and velocities at the sub-step's beginning; empty where nobody asks.
    pub(crate) start: [&'a [Vec3]; 2],
    pub(crate) pending_death: &'a [PendingDeath],
    /// A mark for each of what constraints do to it, and the words that they keep through the step.
    pub(crate) marks: &'a mut [u32],
    pub(crate) lasting: &'a mut [u32],
    pub(crate) lists: ListMemory<'a>,
    /// The words kept from step to step, for writing where there are constraints.
    pub(crate) kept: &'a mut [u32],
    pub(crate) scratch: Scratch<'a>,
    pub(crate) layout: &'a Layout,
    pub(crate) report: &'a mut Report,
    pub(crate) observer: &'a mut dyn Observer,
}

impl Moved<'_> {
    /// Says that the sub-step has come so far.
    fn tell(&mut self, phase: Phase, time: Time) {
        let custom = self.attributes.custom(self.kept, self.layout.capacity());
        let state = self.attributes.state(custom, time, [self.position, self.velocity]);
        self.observer.after(phase, &state);
    }
}

/// Lets constraints move what the method has moved, or look on before, and says how far that has come.
fn constrain(moved: &mut Moved<'_>, moment: Moment, substep: Substep) {
    let [_, end] = substep.during;
    match moment {
        Moment::Before => lend(moved, substep, |constraints, bodies, share| constraints.prepare(bodies, share)),
        Moment::After => {
            moved.tell(Phase::Advance, end);
            moved.tell(Phase::Project, end);
            lend(moved, substep, |constraints, bodies, share| {
                constraints.begin(bodies, share);
                constraints.project(bodies, share);
                constraints.settle(bodies, share);
            });
            moved.tell(Phase::Constrain, end);
        }
    }
}

/// Lends the constraints what they move and the memory that they work in.
#[inline(never)]
fn lend(moved: &mut Moved<'_>, substep: Substep, go: fn(&dyn Constraint, &mut Bodies<'_>, &mut Share<'_>)) {
    let Moved { constraints, colliders, index, integrator, layout, .. } = *moved;
    let Attributes { lives, inverse_mass, elasticity, .. } = *moved.attributes;
    let len = moved.position.len();
    let [memory, scratch] = moved.scratch.constraining();
    let (custom, kept) = layout.kept(moved.kept);
    let mut bodies = Bodies {
        position: moved.position,
        velocity: moved.velocity,
        before: moved.start,
        radius: &lives.radius[..len],
        mass: &lives.mass[..len],
        inverse_mass: &inverse_mass[..len],
        elasticity: &elasticity[..len],
        material: &lives.material[..len],
        custom: CustomColumnsMut::new(lives.custom.list(), custom, layout.capacity(), len),
        substep,
        colliders,
        materials: lives.materials,
        near: Near { index, memory },
        report: moved.report,
        slot: &lives.slot[..len],
        serial: &lives.springs.serial[..len],
        row_of: lives.springs.row_of,
        pending_death: moved.pending_death,
        start: lives.springs.start,
        marks: moved.marks,
        lag: integrator.lag(),
        observer: moved.observer,
    };
    let mut share = Share { kept, step: moved.lasting, scratch, capacity: layout.capacity() };
    go(constraints, &mut bodies, &mut share);
}
