//! Update: the method moves the old, in as many sub-steps as contacts ask for; the newborn fly on from their births.

use super::View;
use super::field::Field;
use crate::collide::{Lists, Stage};
use crate::force::Springs;
use crate::integrate::{Dynamics, Motion, Work};
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
        let Shares { start: [start_x, start_v], held, trees, near, scratch } =
            Layout::of(scene.demand(), capacity).moving(m.work);
        if scene.needs_start() {
            start_x[..len].copy_from_slice(&m.position[..len]);
            start_v[..len].copy_from_slice(&m.velocity[..len]);
        }
        let mut field = Field {
            scene,
            radius: m.radius,
            mass: m.mass,
            inverse_mass: m.inverse_mass,
            drag: m.drag,
            charge: m.charge,
            springs: Springs {
                springs: scene.springs,
                start: self.status.start,
                serial: &m.serial[..len],
                row_of: m.row_of,
                last_spring: m.last_spring,
                incident: m.incident,
            },
            needs: scene.forces.needs(),
            tree: trees,
            near,
            first: old,
            evaluations: 0,
            observer,
        };
        if old < len {
            let ends = [&mut m.position[..len], &mut m.velocity[..len]];
            fly(&mut field, ends, old..len, m.born, [now, now + dt], scratch);
        }
        (field.first, field.springs.serial) = (0, &m.serial[..old]);
        let pieces = scene.contacts.substeps();
        let mut stage = Stage {
            scene,
            held,
            lists: Lists::default(),
            position: &mut m.position[..old],
            velocity: &mut m.velocity[..old],
            radius: m.radius,
            inverse_mass: m.inverse_mass,
            elasticity: m.elasticity,
            material: m.material,
            now,
            h: dt,
            dt,
            pieces,
            piece: 0,
            report,
        };
        let start = if scene.needs_start() { [&start_x[..old], &start_v[..old]] } else { [&[][..]; 2] };
        for piece in 0..pieces {
            let end = now + dt.part(piece + 1, pieces);
            (stage.piece, stage.h) = (piece, end - stage.now);
            let work = Work { memory: scratch, stride: capacity, len: old };
            substep(&mut stage, start, work, &mut self.status.hint, &mut field);
            stage.now = end;
        }
        report.effort.evaluations += field.evaluations;
    }
}

/// One sub-step: the method moves all, then contacts by position move them apart.
fn substep(stage: &mut Stage<'_>, start: [&[Vec3]; 2], work: Work<'_>, hint: &mut Time, field: &mut Field<'_>) {
    let scene = stage.scene;
    scene.contacts.gather(stage, bytemuck::cast_slice_mut(work.memory));
    let start = scene.contacts.begin(stage.held, stage.position, stage.velocity).unwrap_or(start);
    let (position, velocity, effort) = (&mut *stage.position, &mut *stage.velocity, &mut stage.report.effort);
    let motion = Motion { position, velocity, start, work, hint, effort };
    scene.integrator.advance(motion, stage.now, stage.h, field);
    scene.contacts.project(stage);
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
