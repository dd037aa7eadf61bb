//! Particles that meet, answered by impulses in the order in which they meet.

use super::air::Air;
use super::event_driven::EventDriven;
use super::queue::Queue;
use super::swept::Swept;
use super::tile::Tile;
use crate::force::Attributes;
use crate::memory::Shares;
use glam::Vec3;

/// Vectors a particle for its next event, for where it was at the step's beginning, and for what drives it along a surface.
pub(super) const COLUMNS: usize = 5;

/// Follows all through the step.
#[inline(never)]
pub(super) fn follow(swept: Swept<'_, '_>) {
    let Swept { tile: Tile { attributes, .. }, .. } = &swept;
    // Points meet nobody.
    if !attributes.lives.radius.iter().any(|&radius| radius > 0.0) {
        return swept.each_by_itself();
    }
    let Swept { tile, index, report, observer, .. } = swept;
    let (len, room) = (tile.position.len(), index.room());
    let Attributes { lives, inverse_mass, elasticity, .. } = tile.attributes;
    let Shares { start: [start_x, start_v], scratch, .. } = tile.layout.shares(tile.work);
    let (events, [home, pull], index_memory) = scratch.meeting(len);
    pull.fill(Vec3::NAN);
    let unit = (tile.dt.ticks() >> 31).checked_ilog2().map_or(0, |bits| bits + 1);
    let mut all = EventDriven {
        obstacles: tile.obstacles,
        air: Air::around(&tile.obstacles),
        attributes: &tile.attributes,
        dt: tile.dt,
        end: tile.now + tile.dt,
        unit,
        events: Queue::new(bytemuck::cast_slice_mut(events)),
        ends: [&mut *tile.position, &mut *tile.velocity],
        starts: [&mut start_x[..len], &mut start_v[..len]],
        pull,
        home: &[],
        room,
        pending_death: &mut *tile.pending_death,
        radius: lives.radius,
        mass: lives.mass,
        inverse_mass,
        elasticity,
        material: lives.material,
        slot: lives.slot,
        serial: lives.springs.serial,
        widest: 0.0,
        max_travel: 0.0,
        report,
        observer,
    };
    all.prepare(lives.born, tile.old);
    home.copy_from_slice(all.starts[0]);
    let home = &*home;
    all.home = home;
    let reach = 2.0 * all.widest + all.max_travel;
    index.with_index(index_memory, home, reach, room, &mut |index| all.run(index));
}
