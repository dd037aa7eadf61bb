//! A row by itself: its path through the sub-step, followed to its first hit and on.

use super::{SHORT_WAY, TileSweep};
use crate::collide::path::Path;
use crate::collide::sweep::{Sweep, facing};
use crate::collide::tile::Tile;
use crate::constrain::{CARRIED, DONE, SHIFTED, TOUCHING};
use crate::observe::Observer;
use crate::particles::Id;
use crate::shape::{Collider, Facing};
use glam::Vec3;

impl TileSweep<'_, '_> {
    /// Where a row was when the sub-step began, and how fast.
    pub(super) fn start_of(&self, row: usize) -> [Vec3; 2] {
        let row = if SHORT_WAY { row - self.first } else { row };
        let [x, v] = self.past.start;
        [x[row], v[row]]
    }

    /// A row's path through the sub-step.
    pub(super) fn path(&self, row: usize) -> Path {
        self.tile.path_from(row, self.start_of(row))
    }

    /// Follows the particle in a row to its first hit and on, if its own box may touch anything.
    pub(super) fn follow(&mut self, row: usize) {
        self.follow_from(row, None, self.tile.obstacles.colliders, self.known());
    }

    /// All that is known of the scenery, if that is one thing or none.
    pub(super) fn known(&self) -> Option<Facing> {
        Some(self.facing).filter(|known| *known != Facing::Several)
    }

    /// The same past these, of which so much is known.
    pub(super) fn follow_past(&mut self, row: usize, walls: &dyn Collider, known: Option<Facing>) {
        self.follow_from(row, None, walls, known);
    }

    /// The means to follow the particle in a row, as large as this, past walls and to sinks.
    #[inline(always)]
    fn sweep<'s>(
        &'s mut self,
        row: usize,
        radius: f32,
        walls: &'s dyn Collider,
        sinks: Option<&'s dyn Collider>,
    ) -> Sweep<'s> {
        let Self { tile, air, report, observer, .. } = self;
        let observer: Option<&mut dyn Observer> = match observer {
            Some(observer) => Some(&mut **observer),
            None => None,
        };
        let Tile { ref obstacles, dt, attributes: ref m, .. } = **tile;
        let lives = &m.lives;
        Sweep {
            obstacles,
            walls,
            sinks,
            id: Id { slot: lives.slot[row], serial: lives.springs.serial[row] },
            row: tile.first + row,
            radius,
            mass: lives.mass[row],
            elasticity: m.elasticity[row],
            material: lives.material[row].checked_sub(1),
            left: None,
            air: air.map(|air| air.braking(m, row)),
            dt: dt.seconds(),
            report,
            observer,
        }
    }

    /// The same from where it was and as fast, if that is told here.
    #[inline(never)]
    pub(super) fn follow_from(
        &mut self,
        row: usize,
        start: Option<[Vec3; 2]>,
        walls: &dyn Collider,
        known: Option<Facing>,
    ) {
        if !self.tile.is_under_way(row) {
            return;
        }
        let path = match start.filter(|_| SHORT_WAY) {
            Some(start) => self.tile.path_from(row, start),
            None => self.path(row),
        };
        let Tile { ref obstacles, old, now, ref attributes, .. } = *self.tile;
        let (radius, born) = (attributes.lives.radius[row], attributes.lives.born[row]);
        // Constraints know nothing of the newborn.
        let mark = if row < old { self.past.marks.get(row).copied().unwrap_or(0) & DONE } else { 0 };
        // What constraints have moved goes straight. What they keep from what it touches is only kept from passing: half of it
        // may not touch anything.
        let (mut left, is_shifted) = (path.v1, mark & SHIFTED != 0);
        let path = if is_shifted { path.straightened() } else { path };
        let radius = if mark & TOUCHING != 0 { 0.5 * radius } else { radius };
        if !path.is_finite() {
            return;
        }
        let sinks = (!obstacles.sinks.is_empty()).then_some(obstacles.sinks);
        if mark & CARRIED != 0 && sinks.is_none() {
            return;
        }
        let (walls, known): (&dyn Collider, _) =
            if mark & CARRIED != 0 { (&(), Some(Facing::Nothing)) } else { (walls, known) };
        let may_lie = row < old && mark == 0 && sinks.is_none_or(|sinks| !sinks.may_touch(&path.hull(radius)));
        // Who is born where a sub-step ends is let go in that.
        let is_newborn = row >= old && born > now;
        let mut sweep = self.sweep(row, radius, walls, sinks);
        sweep.left = is_shifted.then_some(&mut left);
        // Whoever is near one face alone goes the short way, among however many things.
        let facing = match known {
            None if SHORT_WAY => facing(walls, &path, [radius, sweep.elasticity], sweep.dt),
            known => known.unwrap_or(Facing::Several),
        };
        let arrival = match facing {
            Facing::Face(face) if SHORT_WAY => sweep.past(&face).travel(&path, is_newborn, may_lie),
            _ => { sweep }.travel(&path, is_newborn, may_lie),
        };
        let Some(end) = arrival else { return };
        let tile = &mut *self.tile;
        (tile.position[row], tile.velocity[row], tile.pending_death[row]) =
            (end.position, end.velocity, end.pending_death);
        if SHORT_WAY {
            tile.reached = tile.reached.and_then(|reached| reached.with(end.position, end.velocity));
        }
    }
}
