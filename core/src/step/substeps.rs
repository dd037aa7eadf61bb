//! A sub-step: the method moves everything, then constraints move it to where they are met.

use super::field::Field;
use crate::constrain::{DONE, Moment, Moved, Substep};
use crate::custom::CustomColumns;
use crate::force::Attributes;
use crate::index::Listed;
use crate::integrate::{Motion, Work};
use crate::observe::Phase;
use crate::report::Effort;
use crate::scene::Scene;
use crate::time::Time;

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
            (code.0)(self, Moment::Before, substep);
        }
        self.integrate(substep, hint);
        if let Some(code) = constraints {
            self.tell(Phase::Advance, to);
            self.tell(Phase::Project, to);
            (code.0)(self, Moment::After, substep);
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
