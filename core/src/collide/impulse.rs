//! Particles that meet, answered by impulses in the order in which they meet.

use super::event_driven::EventDriven;
use super::passage::Passage;
use super::queue::Queue;
use crate::memory::{Layout, Shares, Slices, Storage};

/// Vectors a particle for its next event and for where it was at the step's beginning.
pub(super) const COLUMNS: usize = 4;

/// Follows all through the step.
#[inline(never)]
pub(super) fn follow(passage: Passage<'_, '_>) {
    // Points meet nobody.
    if !passage.workspace.memory.radius[..passage.workspace.len()].iter().any(|&radius| radius > 0.0) {
        return passage.each_by_itself();
    }
    let Passage { workspace, scene, old, now, dt, report, observer } = passage;
    let (len, capacity) = (workspace.len(), workspace.capacity());
    let Slices {
        position,
        velocity,
        radius,
        mass,
        inverse_mass,
        elasticity,
        material,
        born,
        pending_death,
        slot,
        serial,
        work,
        ..
    } = workspace.memory.slices();
    let Shares { start: [start_x, start_v], scratch, .. } = Layout::of(scene.plan(), capacity).shares(work);
    let (events, home, index_memory) = scratch.meeting(len);
    let unit = (dt.ticks() >> 31).checked_ilog2().map_or(0, |bits| bits + 1);
    let mut all = EventDriven {
        scene,
        dt,
        end: now + dt,
        unit,
        events: Queue::new(bytemuck::cast_slice_mut(events)),
        ends: [&mut position[..len], &mut velocity[..len]],
        starts: [&mut start_x[..len], &mut start_v[..len]],
        home: &[],
        room: scene.index.room(),
        pending_death: &mut pending_death[..len],
        radius: &radius[..len],
        mass: &mass,
        inverse_mass: &inverse_mass,
        elasticity: &elasticity,
        material: &material,
        slot,
        serial,
        widest: 0.0,
        max_travel: 0.0,
        report,
        observer,
    };
    all.prepare(&born[..len], old);
    home.copy_from_slice(all.starts[0]);
    let home = &*home;
    all.home = home;
    let (reach, room) = (2.0 * all.widest + all.max_travel, all.room);
    scene.index.with_index(index_memory, home, reach, room, &mut |index| all.run(index));
}
