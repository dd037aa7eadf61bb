//! A sub-step: the method moves everything, then constraints move it to where they are met.

use crate::constrain::{DONE, Moment, Moved, Substep};
use crate::custom::CustomColumns;
use crate::force::{Attributes, Finder};
use crate::index::{Lasting, ListMemory, Listed, StateIndex};
use crate::integrate::{Field, Motion, Work};
use crate::observe::Observer;
use crate::report::Finding;
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

impl Scene<'_> {
    /// Its forces over the masses of rows from one on, with memory for trees, an index and lists.
    #[cfg_attr(one_by_one, inline(never))]
    pub(super) fn field<'f>(
        &'f self,
        attributes: &'f Attributes<'f>,
        custom: CustomColumns<'f>,
        first: usize,
        ([tree, near], lasting): ([&'f mut [u32]; 2], Lasting<'f>),
        lists: Option<ListMemory<'f>>,
        observer: &'f mut dyn Observer,
    ) -> Field<'f> {
        let (needs, finding) = (self.forces.needs(), Finding::default());
        let index = StateIndex::new(self.index, near, lasting);
        let finder = Finder { attributes, custom, needs, tree, index, lists, first, finding };
        let springs = self.springs.code().map(|code| code.force);
        let linearising = self.integrator.linearising();
        Field { forces: self.forces, springs, steady: self.steady(), finder, observer, linearising }
    }
}

impl Moved<'_> {
    /// Moves all through a sub-step.
    pub(super) fn go(&mut self, scene: &Scene<'_>, substep: Substep, hint: &mut Time) {
        let constraints = scene.constraints.code().filter(|_| !self.marks.is_empty());
        // How far constraints keep particles off the scenery is told once a step.
        let lasts = if substep.number == 0 { 0 } else { !DONE };
        self.marks.iter_mut().for_each(|mark| *mark &= lasts);
        if let Some(code) = constraints {
            (code.0)(scene.constraints, self, Moment::Before, substep);
        }
        self.integrate(scene, substep, hint);
        if let Some(code) = constraints {
            (code.0)(scene.constraints, self, Moment::After, substep);
        }
    }

    /// Lets the method move all by the forces.
    fn integrate(&mut self, scene: &Scene<'_>, substep: Substep, hint: &mut Time) {
        let [from, to] = substep.during;
        let (len, stride) = (self.position.len(), self.layout.capacity());
        let (words, memory, lasting) = self.scratch.moving();
        let custom = self.attributes.custom(self.kept, stride);
        let lists = Some(self.lists.again());
        let mut field = scene.field(self.attributes, custom, 0, (words, lasting), lists, self.observer);
        let motion = Motion {
            position: self.position,
            velocity: self.velocity,
            start: self.start.each_ref().map(|column| &**column),
            work: Work { memory, stride, len },
            hint,
            effort: &mut self.report.effort,
        };
        self.integrator.advance(motion, from, to - from, &mut field);
        let finding = field.finder.finding;
        self.report.effort.found(&finding);
    }
}
