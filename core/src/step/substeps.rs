//! A sub-step: the method moves everything, then constraints move it to where they are met.

use super::field::{Attributes, Field};
use crate::constrain::{Bodies, ConstraintCode, DONE, Moment, Near, Share, Substep};
use crate::custom::{CustomColumns, CustomColumnsMut};
use crate::force::Needs;
use crate::index::{ListMemory, Listed};
use crate::integrate::{Motion, Work};
use crate::memory::{Layout, Scratch};
use crate::observe::{Observer, Phase};
use crate::reap::PendingDeath;
use crate::report::{Effort, Report};
use crate::scene::Scene;
use crate::time::Time;
use glam::Vec3;

/// The particles that a sub-step moves, and the memory for it.
pub(crate) struct Moved<'a> {
    pub(super) scene: &'a Scene<'a>,
    pub(super) attributes: &'a Attributes<'a>,
    pub(super) needs: Needs,
    pub(super) position: &'a mut [Vec3],
    pub(super) velocity: &'a mut [Vec3],
    /// Places and velocities at the sub-step's beginning; empty where nobody asks.
    pub(super) start: [&'a [Vec3]; 2],
    pub(super) pending_death: &'a [PendingDeath],
    /// A mark for each of what constraints do to it, and the words that they keep through the step.
    pub(super) marks: &'a mut [u32],
    pub(super) lasting: &'a mut [u32],
    pub(super) lists: ListMemory<'a>,
    /// The words kept from step to step, for writing where there are constraints.
    pub(super) kept: &'a mut [u32],
    pub(super) scratch: Scratch<'a>,
    pub(super) capacity: usize,
    pub(super) report: &'a mut Report,
    pub(super) observer: &'a mut dyn Observer,
}

/// The memory that goes on from step to step beside the particles, in tiles nothing.
pub(super) struct Carried<'a> {
    /// The words kept of particles, for constraints to change.
    pub(super) kept: &'a mut [u32],
    /// The step that a method which chooses its own goes on with.
    pub(super) hint: &'a mut Time,
    /// The facts known of lists of neighbours, and the number of particles that have come and gone.
    pub(super) listed: &'a mut Listed,
    pub(super) changes: u32,
}

impl Moved<'_> {
    /// Moves all through a sub-step.
    pub(super) fn go(&mut self, substep: Substep, hint: &mut Time) {
        let ([_, to], constraints) = (substep.during, self.scene.constraints.code());
        let constraints = constraints.filter(|_| !self.marks.is_empty());
        // How far constraints keep particles off the scenery is told once a step.
        let lasts = if substep.number == 0 { 0 } else { !DONE };
        self.marks.iter_mut().for_each(|mark| *mark &= lasts);
        if let Some(code) = constraints {
            self.ask(code, Moment::Before, substep);
        }
        self.integrate(substep, hint);
        if let Some(code) = constraints {
            self.tell(Phase::Advance, to);
            self.tell(Phase::Project, to);
            self.ask(code, Moment::After, substep);
            self.tell(Phase::Constrain, to);
        }
    }

    /// Lets the method move all by the forces.
    fn integrate(&mut self, substep: Substep, hint: &mut Time) {
        let [from, to] = substep.during;
        let len = self.position.len();
        let ([tree, near], memory) = self.scratch.moving();
        let (scene, attributes, needs) = (self.scene, self.attributes, self.needs);
        let custom = custom(scene, attributes, self.kept, self.capacity);
        let mut field = Field {
            scene,
            attributes,
            custom,
            needs,
            tree,
            near,
            lists: Some(self.lists.again()),
            first: 0,
            effort: Effort::NONE,
            observer: self.observer,
        };
        let motion = Motion {
            position: self.position,
            velocity: self.velocity,
            start: self.start,
            work: Work { memory, stride: self.capacity, len },
            hint,
            effort: &mut self.report.effort,
        };
        scene.integrator.advance(motion, from, to - from, &mut field);
        let effort = field.effort;
        self.report.effort.found(&effort);
    }

    /// Says that the sub-step has come so far.
    fn tell(&mut self, phase: Phase, time: Time) {
        let custom = custom(self.scene, self.attributes, self.kept, self.capacity);
        let state = self.attributes.state(custom, time, [self.position, self.velocity]);
        self.observer.after(phase, &state);
    }

    /// Lends the constraints what they move and the memory that they work in.
    #[inline(never)]
    fn ask(&mut self, code: ConstraintCode, moment: Moment, substep: Substep) {
        let scene = self.scene;
        let Attributes { lives, inverse_mass, elasticity, .. } = *self.attributes;
        let len = self.position.len();
        let [memory, scratch] = self.scratch.constraining();
        let (custom, kept) = Layout::of(scene.plan(), self.capacity).kept(self.kept);
        let mut bodies = Bodies {
            position: self.position,
            velocity: self.velocity,
            before: self.start,
            radius: &lives.radius[..len],
            mass: &lives.mass[..len],
            inverse_mass: &inverse_mass[..len],
            elasticity: &elasticity[..len],
            material: &lives.material[..len],
            custom: CustomColumnsMut::new(scene.custom, custom, self.capacity, len),
            substep,
            colliders: scene.colliders,
            materials: scene.materials,
            near: Near { index: scene.index, memory },
            report: self.report,
            slot: &lives.slot[..len],
            serial: &lives.springs.serial[..len],
            row_of: lives.springs.row_of,
            pending_death: self.pending_death,
            start: lives.springs.start,
            marks: self.marks,
            lag: scene.integrator.lag(),
            observer: self.observer,
        };
        let mut share = Share { kept, step: self.lasting, scratch, capacity: self.capacity };
        (code.0)(scene.constraints, moment, &mut bodies, &mut share);
    }
}

/// Columns of a user's own as they are now: where constraints may change them, those that are lent for it.
pub(super) fn custom<'a>(
    scene: &'a Scene<'a>,
    attributes: &Attributes<'a>,
    kept: &'a [u32],
    capacity: usize,
) -> CustomColumns<'a> {
    if kept.is_empty() { attributes.lives.custom } else { CustomColumns::kept(scene.custom, kept, capacity, capacity) }
}
