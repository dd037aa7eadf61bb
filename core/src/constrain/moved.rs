//! The particles that a sub-step moves, and what constraints are lent of them.

use super::{Bodies, Near, Share, Substep};
use crate::custom::CustomColumnsMut;
use crate::force::Attributes;
use crate::index::{IndexChoice, ListMemory};
use crate::integrate::Integrator;
use crate::memory::{Layout, Scratch, take, take_vectors};
use crate::observe::{Observer, Phase};
use crate::reap::PendingDeath;
use crate::report::Report;
use crate::shape::Collider;
use crate::time::Time;
use glam::Vec3;

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
    pub(crate) colliders: &'a dyn Collider,
    pub(crate) index: &'a dyn IndexChoice,
    pub(crate) integrator: &'a dyn Integrator,
    pub(crate) attributes: &'a Attributes<'a>,
    pub(crate) position: &'a mut [Vec3],
    pub(crate) velocity: &'a mut [Vec3],
    /// Places and velocities at the sub-step's beginning; empty where nobody asks.
    pub(crate) start: [&'a mut [Vec3]; 2],
    /// The share of what constraints have done to velocities with which the method begins; zero: it need not know of it.
    pub(crate) lead: f32,
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
    pub(super) fn tell(&mut self, phase: Phase, time: Time) {
        let custom = self.attributes.custom(self.kept, self.layout.capacity());
        let state = self.attributes.state(custom, time, [self.position, self.velocity]);
        self.observer.after(phase, &state);
    }

    /// The bodies that constraints move, and the memory that they work in; searches among all pairs are counted.
    #[inline(never)]
    pub(super) fn lend<'s>(&'s mut self, substep: Substep, all_pairs: &'s mut u64) -> (Bodies<'s>, Share<'s>) {
        let Attributes { lives, inverse_mass, elasticity, .. } = *self.attributes;
        let (len, capacity) = (self.position.len(), self.layout.capacity());
        let [memory, scratch] = self.scratch.constraining();
        let (custom, kept) = self.layout.kept(self.kept);
        let mut step = &mut *self.lasting;
        let bound = take(&mut step, self.layout.names());
        let named = len.min(bound.len());
        let postponed = take_vectors(&mut step, self.layout.postponed());
        let loads = take(&mut step, self.layout.loads());
        let bodies = Bodies {
            position: self.position,
            velocity: self.velocity,
            before: self.start.each_ref().map(|column| &**column),
            radius: &lives.radius[..len],
            mass: &lives.mass[..len],
            inverse_mass: &inverse_mass[..len],
            elasticity: &elasticity[..len],
            material: &lives.material[..len],
            custom: CustomColumnsMut::new(lives.custom.list(), custom, capacity, len),
            substep,
            colliders: self.colliders,
            materials: lives.materials,
            near: Near { index: self.index, memory, all_pairs },
            report: self.report,
            slot: &lives.slot[..len],
            serial: &lives.springs.serial[..len],
            row_of: lives.springs.row_of,
            pending_death: self.pending_death,
            start: lives.springs.start,
            marks: self.marks,
            bound: &mut bound[..named],
            postponed,
            loads: bytemuck::cast_slice_mut(loads),
            observer: self.observer,
        };
        (bodies, Share { kept, step, scratch, capacity })
    }
}
