//! Update: the old go through the step's sub-steps; the newborn fly on from their births.

use super::View;
use super::field::{Attributes, Field};
use super::substeps::Moved;
use crate::force::{Springs, State};
use crate::integrate::Dynamics;
use crate::memory::{Layout, Shares, Storage};
use crate::observe::Observer;
use crate::report::Report;
use crate::scene::Scene;
use crate::time::Time;
use core::ops::Range;
use glam::Vec3;

impl View<'_> {
    /// Moves the `old` particles by the integrator. The newborn fly on from their places of birth with the acceleration
    /// they have there at the step's beginning; they act on the old from the next step on.
    pub(super) fn advance(
        &mut self,
        scene: &Scene<'_>,
        old: usize,
        dt: Time,
        report: &mut Report,
        observer: &mut dyn Observer,
    ) {
        let (len, now, capacity) = (self.status.len, self.status.time, self.capacity());
        let m = self.memory.slices();
        let Shares { start: [start_x, start_v], before, marks, step: kept, mut scratch } =
            Layout::of(scene.plan(), capacity).shares(m.work);
        if scene.needs_start() {
            start_x[..len].copy_from_slice(&m.position[..len]);
            start_v[..len].copy_from_slice(&m.velocity[..len]);
        }
        let springs = Springs {
            springs: scene.springs,
            start: self.status.start,
            serial: m.serial,
            row_of: m.row_of,
            last_spring: m.last_spring,
            incident: m.incident,
        };
        let (radius, mass, drag, charge) = (&*m.radius, &*m.mass, &*m.drag, &*m.charge);
        let (born, dies, slot, key) = (&*m.born, &*m.dies, &*m.slot, &*m.key);
        let lives = State { radius, mass, drag, charge, born, dies, slot, key, springs, ..State::EMPTY };
        let attributes =
            Attributes { lives, inverse_mass: m.inverse_mass, elasticity: m.elasticity, material: m.material };
        let needs = scene.forces.needs();
        if old < len {
            let ([tree, near], memory) = scratch.moving();
            let mut field = Field { scene, attributes, needs, tree, near, first: old, evaluations: 0, observer };
            let ends = [&mut m.position[..len], &mut m.velocity[..len]];
            fly(&mut field, ends, old..len, born, [now, now + dt], memory);
            report.effort.evaluations += field.evaluations;
        }
        let mut moved = Moved {
            scene,
            attributes,
            needs,
            position: &mut m.position[..old],
            velocity: &mut m.velocity[..old],
            start: [start_x, start_v].map(|column| &*first(column, old)),
            before: before.map(|column| first(column, old)),
            marks: first(marks, old),
            kept,
            scratch,
            capacity,
            report,
            observer,
        };
        moved.go(now, dt, &mut self.status.hint);
    }
}

/// The first so many, or none where there is no memory for them.
fn first<T>(column: &mut [T], len: usize) -> &mut [T] {
    let len = len.min(column.len());
    &mut column[..len]
}

/// Lets newborn rows fly from their births to the end of the step.
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
    for (row, &a) in newborn.zip(a.iter()) {
        let flight = (end - born[row]).seconds();
        position[row] += (velocity[row] + a * (0.5 * flight)) * flight;
        velocity[row] += a * flight;
    }
}
