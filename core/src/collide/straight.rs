//! The short way past scenery, for those who have little room for code: each path as the straight line between its ends.

use super::path::{Path, between};
use super::sweep::{LAIN, RESTING, let_go};
use super::tile::{Obstacles, Tile};
use crate::force::Friction;
use crate::material::{Mixed, Mixing};
use crate::math::{along, copied, dot, is_zero, length, max, minus, plus, scaled};
use crate::memory::Past;
use crate::observe::{Impact, Observer};
use crate::particles::Id;
use crate::reap::PendingDeath;
use crate::report::Report;
use crate::rows::BLOCKS;
use crate::shape::{Collider, Hit, Segment};
use crate::time::Time;
use glam::Vec3;

/// A row of a tile on its way, and what that may meet.
struct Straight<'s, 'a> {
    tile: &'s Tile<'a>,
    walls: &'s dyn Collider,
    row: usize,
    radius: f32,
    report: &'s mut Report,
    observer: &'s mut dyn Observer,
}

/// Sends every free particle of a tile along straight lines through the sub-step, past all others.
pub(super) fn follow(tile: &mut Tile<'_>, report: &mut Report, observer: &mut dyn Observer) {
    let work = core::mem::take(&mut tile.work);
    let past = tile.layout.past(work);
    for row in 0..tile.position.len() {
        if tile.is_under_way(row) {
            pass(tile, past, row, report, observer);
        }
    }
    tile.work = work;
}

/// Takes a row to where it comes to.
#[cfg_attr(one_by_one, inline(never))]
fn pass(tile: &mut Tile<'_>, past: Past<'_>, row: usize, report: &mut Report, observer: &mut dyn Observer) {
    let mut path = tile.path(past, row);
    if !path.is_finite() {
        return;
    }
    let (mut walls, mut radius, sinks) =
        (tile.obstacles.colliders, tile.attributes.lives.radius[row], tile.obstacles.sinks);
    // Constraints know nothing of the newborn.
    if row < tile.old
        && let Some((code, &mark)) = tile.obstacles.marks.zip(past.marks.get(row))
    {
        (walls, radius) = (code.0)(mark, &mut path, walls, radius);
    }
    if row >= tile.old && tile.attributes.lives.born[row] > tile.now {
        let_go(walls, Some(sinks), &mut path, tile.dt.seconds());
    }
    let Some(death) = (Straight { tile, walls, row, radius, report, observer }).go(&mut path) else { return };
    (tile.position[row], tile.velocity[row]) = (copied(path.x1), copied(path.v1));
    tile.pending_death[row] = death;
    if BLOCKS {
        tile.reached = tile.reached.and_then(|reached| reached.with(path.x1, path.v1));
    }
}

impl Straight<'_, '_> {
    /// Takes a path from hit to hit to its end, if it has any, and says what becomes of the row there.
    fn go(&mut self, path: &mut Path) -> Option<PendingDeath> {
        let (mut has_met, sinks) = (None, self.tile.obstacles.sinks);
        for _ in 0..self.tile.obstacles.max_bounces {
            let way = Segment { from: path.x0, to: path.x1, radius: self.radius, during: path.during };
            let (wall, sink) = (self.walls.first_hit(&way), sinks.first_hit(&way));
            if let Some(sink) = &sink
                && wall.as_ref().is_none_or(|wall| sink.time <= wall.time)
            {
                path.v1 = along(path.v0, minus(path.v1, path.v0), sink.time);
                path.x1 = way.at(sink.time);
                return Some(PendingDeath::Sink);
            }
            let Some(hit) = &wall else { return has_met };
            has_met = Some(PendingDeath::Lives);
            self.rebound(path, &way, hit);
        }
        self.report.caps.bounces += 1;
        path.x1 = self.walls.carry(path.x0, self.radius, path.during);
        path.v1 = path.v0;
        Some(PendingDeath::Lives)
    }

    /// The way on from a hit under the mean acceleration of the path so far. Whom that would bring back to the surface within a part of the
    /// step rests on it: then the surface bears what presses, and friction holds what drives along it.
    #[cfg_attr(one_by_one, inline(never))]
    fn rebound(&mut self, path: &mut Path, way: &Segment, hit: &Hit) {
        let Self { tile, row, .. } = *self;
        let (lives, normal) = (&tile.attributes.lives, hit.normal);
        let own = lives.material[row].checked_sub(1);
        let (elasticity, Obstacles { materials, mixing, .. }) = (tile.attributes.elasticity[row], tile.obstacles);
        let mixed = match mixing {
            Some(Mixing(on_surface)) => on_surface(materials, elasticity, own, hit.material),
            None => Mixed { elasticity: max(elasticity, 0.0), friction: Friction::NONE },
        };
        let during = [between(path.during, hit.time), path.during[1]];
        let (place, rest) = (way.at(hit.time), (during[1] - during[0]).seconds());

        let (acceleration, before) = (path.drive(), along(path.v0, minus(path.v1, path.v0), hit.time));
        let relative = minus(before, hit.velocity);
        let (incoming, pressing) = (dot(relative, normal), -dot(acceleration, normal));
        // Where velocities say that it leaves what the way meets, it has come back meanwhile, or rests.
        let bounced = if incoming < 0.0 { -incoming * mixed.elasticity } else { incoming };
        let rests = pressing > 0.0 && (incoming >= 0.0 || 2.0 * bounced < RESTING * tile.dt.seconds() * pressing);
        let outgoing = if rests { 0.0 } else { bounced };
        let came = along(relative, normal, -incoming);
        let slip = plus(came, mixed.friction.answer(came, outgoing - incoming));
        let after = along(plus(hit.velocity, slip), normal, outgoing);

        let (drive, held) =
            if rests { (along(acceleration, normal, pressing), pressing * rest) } else { (acceleration, 0.0) };
        let free = plus(after, scaled(drive, rest));
        let end = plus(free, mixed.friction.answer(minus(free, hit.velocity), held));

        self.report.hits += 1;
        let id = Id { slot: lives.slot[row], serial: lives.springs.serial[row] };
        let (mass, surface, time, closing) = (lives.mass[row], hit.velocity, during[0], max(-incoming, 0.0));
        self.observer.hit(&Impact {
            id,
            row: tile.first + row,
            other: None,
            mass,
            place,
            normal,
            closing,
            before,
            after,
            surface,
            time,
        });

        let x0 = self.set_off(way, hit, place, [path.during[0], during[0]]);
        // What lies there does not creep. Of what constraints have moved, speeds may show nothing that would press it on.
        let stays = is_zero(hit.velocity) && is_zero(after) && is_zero(end);
        let x0 = if stays && length(minus(x0, path.x0)) <= LAIN * hit.slack { path.x0 } else { x0 };
        (path.x0, path.v0, path.v1, path.during) = (x0, after, end, during);
        path.pull = rests.then_some(acceleration);
        path.x1 = along(x0, plus(after, end), 0.5 * rest);
    }

    /// A point beside the hit on the side that the way came from: off the surface by twice its slack, if the way there is free; else where
    /// the way began, or where that is carried to.
    fn set_off(&self, way: &Segment, hit: &Hit, place: Vec3, during: [Time; 2]) -> Vec3 {
        let aside = Segment { to: along(place, hit.normal, 2.0 * hit.slack), during, ..*way };
        if self.walls.first_hit(&aside).is_none() { aside.to } else { self.walls.carry(way.from, self.radius, during) }
    }
}
