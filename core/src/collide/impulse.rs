//! Particles that meet, answered by impulses in the order in which they meet.

use super::melee::Melee;
use super::passage::Passage;
use super::queue::Queue;
use crate::memory::{Layout, Shares, Slices, Storage};

/// Vectors a particle for its clock and for where it was at the step's beginning.
pub(super) const COLUMNS: usize = 4;

/// Follows all through the step.
#[inline(never)]
pub(super) fn follow(passage: Passage<'_, '_>) {
    // Points meet nobody.
    if !passage.view.memory.radius[..passage.view.len()].iter().any(|&radius| radius > 0.0) {
        return passage.each_by_itself();
    }
    let Passage { view, scene, old, now, dt, report, observer } = passage;
    let (len, capacity) = (view.len(), view.capacity());
    let Slices {
        position,
        velocity,
        radius,
        mass,
        inverse_mass,
        elasticity,
        material,
        born,
        fate,
        slot,
        serial,
        work,
        ..
    } = view.memory.slices();
    let Shares { start: [start_x, start_v], scratch, .. } = Layout::of(scene.plan(), capacity).shares(work);
    let (clocks, home, index_memory) = scratch.meeting(len);
    let unit = (dt.ticks() >> 31).checked_ilog2().map_or(0, |bits| bits + 1);
    let mut melee = Melee {
        scene,
        dt,
        end: now + dt,
        unit,
        clocks: Queue::new(bytemuck::cast_slice_mut(clocks)),
        ends: [&mut position[..len], &mut velocity[..len]],
        starts: [&mut start_x[..len], &mut start_v[..len]],
        home: &[],
        fate: &mut fate[..len],
        radius: &radius[..len],
        mass,
        inverse_mass,
        elasticity,
        material,
        slot,
        serial,
        widest: 0.0,
        leash: 0.0,
        report,
        observer,
    };
    melee.prepare(&born[..len], old);
    home.copy_from_slice(melee.starts[0]);
    let home = &*home;
    melee.home = home;
    let reach = 2.0 * melee.widest + melee.leash;
    scene.index.arrange(index_memory, home, reach, &mut |index| melee.run(index));
}
