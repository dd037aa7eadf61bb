//! Update: the old go through a sub-step; the newborn fly on from their births.

use super::substeps::Carried;
use crate::collide::Tile;
use crate::constrain::{Moved, SHIFTED, Substep};
use crate::force::Steady;
use crate::index::ListMemory;
use crate::integrate::{Drift, Dynamics, Field};
use crate::math::{along, copied};
use crate::memory::{Past, Shares};
use crate::observe::Observer;
use crate::reap::PendingDeath;
use crate::report::Report;
use crate::rows::BLOCKS;
use crate::scene::Scene;
use crate::time::Time;
use core::ops::Range;
use glam::Vec3;

impl Tile<'_> {
    /// Moves the old by the integrator. The newborn fly on from their places of birth, and from where the sub-step finds them, with the
    /// acceleration they have there at its beginning; they act on the old from the next step on.
    pub(super) fn advance(
        &mut self,
        scene: &Scene<'_>,
        substep: Substep,
        Carried { kept, hint, listed, changes }: Carried<'_>,
        report: &mut Report,
        observer: &mut dyn Observer,
    ) {
        let [now, end] = substep.during;
        (self.now, self.dt, self.attributes.lives.since) = (now, end - now, now);
        if let Some(leap) = scene.leap().filter(|_| self.old == self.position.len()) {
            return self.leap(leap, report);
        }
        let Self { old, layout, ref attributes, .. } = *self;
        let len = self.position.len();
        let Shares { mut start, marks, step: lasting, mut scratch, lists } = layout.shares(self.work);
        if scene.needs_start() || scene.telling(observer).is_some() {
            keep([&*self.position, &*self.velocity], &mut start);
        }
        if old < len {
            let (words, memory, lasting) = scratch.moving();
            let custom = attributes.custom(kept, layout.capacity());
            let mut field = scene.field(attributes, custom, old, (words, lasting), None, observer);
            let ends = [&mut *self.position, &mut *self.velocity];
            fly(&mut field, ends, old..len, attributes.lives.born, substep.during, memory);
            report.effort.found(&field.finder.finding);
        }
        let mut moved = Moved {
            colliders: scene.colliders,
            index: scene.index,
            integrator: scene.integrator,
            attributes,
            position: &mut self.position[..old],
            velocity: &mut self.velocity[..old],
            start: start.map(|column| first(column, old)),
            lead: scene.lead(),
            pending_death: &self.pending_death[..old],
            marks: first(marks, old),
            lasting,
            lists: ListMemory::new(lists, listed, changes, substep.step.seconds(), scene.index.room()),
            kept,
            scratch,
            layout,
            report,
            observer,
        };
        moved.go(scene, substep, hint);
        if substep.number > 0 && !scene.sinks.is_empty() {
            self.hold_doomed();
        }
    }

    /// Lets those stay where they are who have vanished in an earlier sub-step of the step, at the end of which they go. Whom constraints
    /// move goes on with what they bind him to.
    #[inline(never)]
    fn hold_doomed(&mut self) {
        let Past { start: [x, v], marks } = self.layout.past(self.work);
        for (row, death) in self.pending_death.iter().enumerate() {
            let is_bound = row < self.old && marks.get(row).is_some_and(|mark| mark & SHIFTED != 0);
            if *death != PendingDeath::Lives && !is_bound {
                self.position[row] = copied(x[row]);
                self.velocity[row] = copied(v[row]);
            }
        }
    }

    /// Moves the rows, none of them newborn, in one pass.
    #[inline(never)]
    fn leap(&mut self, (steady, drift): (Steady, Drift), report: &mut Report) {
        let (len, inertia) = (self.old, self.attributes.inertia(0..self.old));
        let Shares { start, .. } = self.layout.shares(self.work);
        let start = start.map(|column| first(column, len));
        let ends = [&mut *self.position, &mut *self.velocity];
        report.effort.evaluations += u64::from(len > 0);
        self.reached = steady.leap(inertia, ends, start, self.dt.seconds(), drift);
    }
}

/// The first so many, or none where there is no memory for them.
fn first<T>(column: &mut [T], len: usize) -> &mut [T] {
    let len = len.min(column.len());
    &mut column[..len]
}

/// Copies where all are, and how fast.
fn keep([x, v]: [&[Vec3]; 2], [kept_x, kept_v]: &mut [&mut [Vec3]; 2]) {
    if BLOCKS {
        kept_x[..x.len()].copy_from_slice(x);
        kept_v[..v.len()].copy_from_slice(v);
    } else {
        for ((x, v), (kept_x, kept_v)) in x.iter().zip(v).zip(kept_x.iter_mut().zip(&mut **kept_v)) {
            (*kept_x, *kept_v) = (copied(*x), copied(*v));
        }
    }
}

/// Lets newborn rows fly from their births, or from the sub-step's beginning, to its end.
fn fly(
    field: &mut Field<'_>,
    [position, velocity]: [&mut [Vec3]; 2],
    newborn: Range<usize>,
    born: &[Time],
    [now, end]: [Time; 2],
    scratch: &mut [Vec3],
) {
    let a = &mut scratch[..newborn.len()];
    field.accelerations(now, position, velocity, a);
    let ends = position[newborn.clone()].iter_mut().zip(&mut velocity[newborn.clone()]);
    for (((x, v), &born), &a) in ends.zip(&born[newborn]).zip(&*a) {
        let flight = (end - born).min(end - now).seconds();
        *x = along(*x, along(*v, a, 0.5 * flight), flight);
        *v = along(*v, a, flight);
    }
}
