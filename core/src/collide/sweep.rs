//! Every particle by itself: rows whose boxes touch nothing are passed by, the others are followed.

use super::flight::Flight;
use super::grip::on_surface;
use super::packet::{Outcome, Paths, Riders};
use super::path::Path;
use crate::constrain::{SHIFTED, TOUCHING};
use crate::lanes::{LANES, Vectors};
use crate::memory::{Layout, Past};
use crate::observe::{Attention, Observer};
use crate::particles::Id;
use crate::reap::Fate;
use crate::report::Report;
use crate::shape::{Aabb, Face, Facing, Hulls, Marks};
use crate::step::Tile;
use crate::time::Time;
use glam::Vec3;
use wide::f32x8;

/// Whether what faces one flat wall alone is followed by code of its own: chips are spared that.
const SHORT_WAY: bool = !cfg!(target_os = "none");

/// Everything.
const EVERYWHERE: Aabb = Aabb { min: Vec3::NEG_INFINITY, max: Vec3::INFINITY };

/// Rows of a tile that are followed past walls.
struct Sweep<'s, 'a> {
    tile: &'s mut Tile<'a>,
    past: Past<'s>,
    facing: Facing,
    report: &'s mut Report,
    observer: Option<&'s mut dyn Observer>,
}

/// Rows that wait until there are eight.
#[derive(Clone, Copy, Default)]
struct Queue {
    rows: [usize; LANES],
    len: usize,
}

/// Sends every free particle of a tile along its path through the step, past all others.
pub(crate) fn each_by_itself(tile: &mut Tile<'_>, report: &mut Report, observer: &mut dyn Observer) {
    let work = core::mem::take(&mut tile.work);
    let past = Layout::of(tile.scene.plan(), tile.capacity).past(work);
    let facing = if SHORT_WAY { tile.scene.colliders.facing(&EVERYWHERE) } else { Facing::Several };
    let observer: Option<&mut dyn Observer> =
        if observer.attention() > Attention::Nothing { Some(observer) } else { None };
    let mut sweep = Sweep { tile: &mut *tile, past, facing, report, observer };
    match facing {
        Facing::Face(face) if sweep.goes_in_packets() => sweep.go_in_packets(&face),
        _ => sweep.go(),
    }
    tile.work = work;
}

impl Queue {
    /// Puts a row in; all eight, once there are so many.
    fn push(&mut self, row: usize) -> Option<[usize; LANES]> {
        self.rows[self.len] = row;
        self.len = (self.len + 1) % LANES;
        (self.len == 0).then_some(self.rows)
    }
}

/// Which bits of a packet are set.
fn ones(mut bits: u32) -> impl Iterator<Item = usize> {
    core::iter::from_fn(move || {
        let i = bits.trailing_zeros() as usize % u32::BITS as usize;
        let any = bits != 0;
        bits &= bits.wrapping_sub(1);
        any.then_some(i)
    })
}

impl Sweep<'_, '_> {
    /// Takes one row after the other.
    fn go(&mut self) {
        for first in (0..self.tile.position.len()).step_by(Hulls::MANY) {
            for (i, mark) in near(self.tile, &self.past, first).into_iter().enumerate() {
                if mark != 0 {
                    self.follow(first + i);
                }
            }
        }
    }

    /// Whether rows may go in another order: nobody asks, nothing removes them, and a hit may follow another.
    fn goes_in_packets(&self) -> bool {
        let Tile { scene, dt, .. } = *self.tile;
        self.observer.is_none()
            && scene.sinks.is_empty()
            && scene.max_bounces > 1
            && self.past.marks.is_empty()
            && dt > Time::ZERO
    }

    /// Takes those who were there before the step in packets of eight: first as if they lay on the face, then as if they bounced
    /// off it.
    fn go_in_packets(&mut self, face: &Face) {
        let (mut lying, mut bouncing) = (Queue::default(), Queue::default());
        for first in (0..self.tile.position.len()).step_by(Hulls::MANY) {
            for (i, mark) in near(self.tile, &self.past, first).into_iter().enumerate() {
                let row = first + i;
                if mark == 0 || self.tile.attributes.inverse_mass[row] == 0.0 {
                    continue;
                }
                if row >= self.tile.old {
                    self.follow(row);
                } else if let Some(rows) = lying.push(row) {
                    self.lie(&rows, face, &mut bouncing);
                }
            }
        }
        if lying.len > 0 {
            self.lie(&lying.rows[..lying.len], face, &mut bouncing);
        }
        if bouncing.len > 0 {
            self.bounce(&bouncing.rows[..bouncing.len], face);
        }
    }

    /// Lets those who lie on the face do so; the others bounce.
    #[inline(never)]
    fn lie(&mut self, rows: &[usize], face: &Face, bouncing: &mut Queue) {
        let (riders, paths) = self.packet(rows, face);
        for i in ones(self.settle(rows, &riders.lie(&paths, face))) {
            if let Some(rows) = bouncing.push(rows[i]) {
                self.bounce(&rows, face);
            }
        }
    }

    /// Lets those bounce off the face who do so once.
    #[inline(never)]
    fn bounce(&mut self, rows: &[usize], face: &Face) {
        let (riders, paths) = self.packet(rows, face);
        self.settle(rows, &riders.bounce(&paths, face, self.tile.dt));
    }

    /// Puts rows where they have come to, follows those who have to be, and says which are left: a bit each.
    #[inline(always)]
    fn settle(&mut self, rows: &[usize], outcome: &Outcome) -> u32 {
        let of_all = (1 << rows.len()) - 1;
        self.report.hits += u64::from((outcome.hit & of_all).count_ones());
        let columns = [outcome.position.columns(), outcome.velocity.columns()];
        for i in ones(outcome.settled & of_all) {
            let [x, v] = columns.each_ref().map(|[x, y, z]| Vec3::new(x[i], y[i], z[i]));
            (self.tile.position[rows[i]], self.tile.velocity[rows[i]]) = (x, v);
        }
        for i in ones(outcome.left & of_all) {
            self.follow(rows[i]);
        }
        of_all & !(outcome.settled | outcome.left)
    }

    /// Rows side by side, the first of them where there are fewer than eight.
    #[inline(always)]
    fn packet(&self, rows: &[usize], face: &Face) -> (Riders, Paths) {
        let Tile { scene, attributes: ref m, .. } = *self.tile;
        let (mut all, mut radius, mut elasticity) = ([rows[0]; LANES], [0.0; LANES], [0.0; LANES]);
        let (mut at_rest, mut sliding) = ([0.0; LANES], [0.0; LANES]);
        all[..rows.len()].copy_from_slice(rows);
        for (i, &row) in all.iter().enumerate() {
            let own = m.material[row].checked_sub(1);
            let feel = on_surface(scene.grips, m.elasticity[row], own, face.material());
            (radius[i], elasticity[i]) = (m.lives.radius[row], feel.elasticity);
            (at_rest[i], sliding[i]) = (feel.friction.resting, feel.friction.sliding);
        }
        let [radius, elasticity, at_rest, sliding] = [radius, elasticity, at_rest, sliding].map(f32x8::new);
        let [x0, v0] = self.past.start.map(|column| Vectors::gather(column, &all));
        let (x1, v1) = (Vectors::gather(self.tile.position, &all), Vectors::gather(self.tile.velocity, &all));
        let time = f32x8::splat(self.tile.dt.seconds());
        (Riders { radius, elasticity, at_rest, sliding }, Paths { x0, v0, x1, v1, time })
    }

    /// Follows the particle in a row to its first hit and on, if its own box may touch anything.
    #[inline(never)]
    fn follow(&mut self, row: usize) {
        let Self { tile, past, facing, report, observer } = self;
        let observer: Option<&mut dyn Observer> = match observer {
            Some(observer) => Some(&mut **observer),
            None => None,
        };
        let Tile { scene, old, dt, attributes: ref m, .. } = **tile;
        if m.inverse_mass[row] == 0.0 {
            return;
        }
        let (lives, end) = (&m.lives, tile.end());
        // A newborn has come only part of the way.
        let start = end - (end - lives.born[row]).min(dt);
        let [[x0, v0], [x1, v1]] = [past.start.map(|column| column[row]), [tile.position[row], tile.velocity[row]]];
        let path = Path { x0, v0, x1, v1, during: [start, end] };
        // Constraints know nothing of the newborn.
        let mark = if row < old { past.marks.get(row).copied().unwrap_or(0) } else { 0 };
        // What constraints have moved goes straight. What they keep from what it touches is only kept from passing: half of it
        // may not touch anything.
        let path = if mark & SHIFTED != 0 { path.straightened() } else { path };
        let is_kept = mark & TOUCHING != 0;
        let radius = if is_kept { 0.5 * lives.radius[row] } else { lives.radius[row] };
        if !path.is_finite() {
            return;
        }
        let sinks = (!scene.sinks.is_empty()).then_some(scene.sinks);
        let before = report.hits;
        let flight = Flight {
            scene,
            walls: scene.colliders,
            sinks,
            id: Id { slot: lives.slot[row], serial: lives.springs.serial[row] },
            row: tile.first + row,
            radius,
            mass: lives.mass[row],
            elasticity: m.elasticity[row],
            material: m.material[row].checked_sub(1),
            dt: dt.seconds(),
            report,
            observer,
        };
        let may_lie = row < old && mark == 0 && sinks.is_none_or(|sinks| !sinks.may_touch(&path.hull(radius)));
        let is_newborn = row >= old;
        let arrival = match facing {
            Facing::Face(face) if SHORT_WAY => flight.past(face).travel(&path, is_newborn, may_lie),
            _ => { flight }.travel(&path, is_newborn, may_lie),
        };
        let Some(end) = arrival else { return };
        if is_kept && end.fate == Fate::Lives && report.hits == before {
            return;
        }
        (tile.position[row], tile.velocity[row], tile.fate[row]) = (end.position, end.velocity, end.fate);
    }
}

/// Marks those from a row on that may touch anything in the step. Its hulls are off the stack when anybody is followed.
#[inline(never)]
fn near(tile: &Tile<'_>, past: &Past<'_>, first: usize) -> Marks {
    let Tile { scene, old, dt, .. } = *tile;
    let rows = first..tile.position.len().min(first + Hulls::MANY);
    let [start_x, start_v] = past.start;
    let ends = [start_x, start_v, tile.position, tile.velocity].map(|column| &column[rows.clone()]);
    let hulls = Hulls::of_paths(ends, &tile.attributes.lives.radius[rows.clone()], dt.seconds());
    let mut marks = [0; Hulls::MANY];
    scene.colliders.mark_near(&hulls, &mut marks);
    scene.sinks.mark_near(&hulls, &mut marks);
    // Newborns have come only part of the way: their cubics are others.
    marks[old.clamp(rows.start, rows.end) - first..].fill(u32::MAX);
    marks[rows.len()..].fill(0);
    marks
}
