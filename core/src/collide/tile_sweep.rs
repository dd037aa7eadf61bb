//! Every particle by itself: rows whose boxes touch nothing are passed by, the others are followed.

use super::near::{BLOCK, Balls};
use super::packet::{Outcome, Paths, Riders};
use super::path::Path;
use super::sweep::{Sweep, facing};
use crate::constrain::{SHIFTED, TOUCHING};
use crate::lanes::{Eight, Kernel, LANES, Vectors, run};
use crate::material::on_surface;
use crate::memory::{Layout, Past};
use crate::observe::{Attention, Observer};
use crate::particles::Id;
use crate::reap::PendingDeath;
use crate::report::Report;
use crate::shape::{Aabb, Face, Facing, Hulls, Marks};
use crate::step::Tile;
use crate::time::Time;
use glam::Vec3;

/// Whether what faces one flat wall alone is followed by code of its own: chips are spared that.
const SHORT_WAY: bool = !cfg!(target_os = "none");

/// Everything.
const EVERYWHERE: Aabb = Aabb { min: Vec3::NEG_INFINITY, max: Vec3::INFINITY };

/// Rows of a tile that are followed past walls.
struct TileSweep<'s, 'a> {
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

/// Rows that wait to go past a face: as if they lay on it, and as if they bounced off it.
struct Waiting {
    face: Face,
    lying: Queue,
    bouncing: Queue,
}

/// Sends every free particle of a tile along its path through the step, past all others.
pub(crate) fn each_by_itself(tile: &mut Tile<'_>, report: &mut Report, observer: &mut dyn Observer) {
    let work = core::mem::take(&mut tile.work);
    let past = Layout::of(tile.scene.plan(), tile.capacity).past(work);
    let facing = if SHORT_WAY { tile.scene.colliders.facing(&EVERYWHERE) } else { Facing::Several };
    let observer: Option<&mut dyn Observer> =
        if observer.attention() > Attention::Nothing { Some(observer) } else { None };
    let has_sinks = !tile.scene.sinks.is_empty();
    let mut tile_sweep = TileSweep { tile: &mut *tile, past, facing, report, observer };
    match facing {
        Facing::Face(face) if SHORT_WAY && !has_sinks => tile_sweep.go_past(&face),
        _ => tile_sweep.go(),
    }
    tile.work = work;
}

/// Rows that may lie on a face.
struct Lie<'t, 's, 'a> {
    of: &'t TileSweep<'s, 'a>,
    rows: &'t [usize],
    face: &'t Face,
}

/// Rows that may bounce off a face.
struct Bounce<'t, 's, 'a> {
    of: &'t TileSweep<'s, 'a>,
    rows: &'t [usize],
    face: &'t Face,
}

impl Kernel for Lie<'_, '_, '_> {
    type Output = Outcome;
    #[inline(always)]
    fn run<F: Eight>(self, like: F) -> Outcome {
        let (riders, paths) = self.of.packet(like, self.rows, self.face);
        riders.lie(&paths, self.face)
    }
}

impl Kernel for Bounce<'_, '_, '_> {
    type Output = Outcome;
    #[inline(always)]
    fn run<F: Eight>(self, like: F) -> Outcome {
        let (riders, paths) = self.of.packet(like, self.rows, self.face);
        riders.bounce(&paths, self.face, self.of.tile.dt, self.of.tile.scene.max_bounces)
    }
}

impl Waiting {
    fn before(face: Face) -> Self {
        Self { face, lying: Queue::default(), bouncing: Queue::default() }
    }
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

impl TileSweep<'_, '_> {
    /// Follows one row after the other; those who are near the same face alone go past it in packets.
    fn go(&mut self) {
        let in_packets = SHORT_WAY && self.goes_in_packets();
        let mut waiting = None;
        for first in (0..self.tile.position.len()).step_by(Hulls::MANY) {
            for (i, mark) in marked(self.tile, &self.past, first).into_iter().enumerate() {
                let row = first + i;
                if mark == 0 {
                    continue;
                }
                match if in_packets { self.face_of(row) } else { None } {
                    None => self.follow(row),
                    Some(face) => {
                        let waiting = waiting.get_or_insert_with(|| Waiting::before(face));
                        if waiting.face == face { self.queue(row, waiting) } else { self.follow(row) }
                    }
                }
            }
        }
        if let Some(waiting) = waiting {
            self.go_on(waiting);
        }
    }

    /// Follows all past a face, those who were there before the step in packets.
    fn go_past(&mut self, face: &Face) {
        let (old, in_packets) = (self.tile.old, self.goes_in_packets());
        let mut waiting = Waiting::before(*face);
        for first in (0..old).step_by(BLOCK) {
            let marks = self.balls().near(first..old.min(first + BLOCK), face);
            let words = marks.as_chunks().0.iter().map(|bytes| u32::from_le_bytes(*bytes));
            for (row, marks) in (first..old).step_by(u32::BITS as usize).zip(words) {
                for row in ones(marks).map(|i| row + i).take_while(|&row| row < old) {
                    let is_fixed = self.tile.attributes.inverse_mass[row] == 0.0;
                    if in_packets && !is_fixed { self.queue(row, &mut waiting) } else { self.follow(row) }
                }
            }
        }
        self.go_on(waiting);
        (old..self.tile.position.len()).for_each(|row| self.follow(row));
    }

    /// All rows on their ways.
    fn balls(&self) -> Balls<'_> {
        let Tile { dt, attributes: ref m, ref position, ref velocity, .. } = *self.tile;
        let ([x0, v0], rows) = (self.past.start, position.len());
        let ends = [&x0[..rows], &v0[..rows], &**position, &**velocity];
        Balls { ends, radius: &m.lives.radius[..rows], time: dt.seconds() }
    }

    /// The face that an old row is near, if that is all.
    fn face_of(&self, row: usize) -> Option<Face> {
        let Tile { scene, old, dt, attributes: ref m, .. } = *self.tile;
        let path = self.path(row);
        if row >= old || m.inverse_mass[row] == 0.0 || !path.is_finite() {
            return None;
        }
        match facing(scene.colliders, &path, [m.lives.radius[row], m.elasticity[row]], dt.seconds()) {
            Facing::Face(face) => Some(face),
            _ => None,
        }
    }

    /// Lets a row wait for others.
    #[inline(always)]
    fn queue(&mut self, row: usize, waiting: &mut Waiting) {
        if let Some(rows) = waiting.lying.push(row) {
            self.lie(&rows, waiting);
        }
    }

    /// Lets those go who still wait.
    fn go_on(&mut self, mut waiting: Waiting) {
        let lying = waiting.lying;
        if lying.len > 0 {
            self.lie(&lying.rows[..lying.len], &mut waiting);
        }
        let Waiting { face, bouncing, .. } = waiting;
        if bouncing.len > 0 {
            self.bounce(&bouncing.rows[..bouncing.len], &face);
        }
    }

    /// Whether rows may go in another order: nobody asks, nothing removes them, and a hit may follow another.
    fn goes_in_packets(&self) -> bool {
        let Tile { scene, dt, .. } = *self.tile;
        let alone = self.observer.is_none() && scene.sinks.is_empty() && self.past.marks.is_empty();
        alone && scene.max_bounces > 1 && dt > Time::ZERO
    }

    /// Lets those who lie on the face do so; the others bounce.
    #[inline(never)]
    fn lie(&mut self, rows: &[usize], Waiting { face, bouncing, .. }: &mut Waiting) {
        let outcome = run(Lie { of: self, rows, face });
        for i in ones(self.settle(rows, &outcome)) {
            if let Some(rows) = bouncing.push(rows[i]) {
                self.bounce(&rows, face);
            }
        }
    }

    /// Lets those bounce off the face who do so once.
    #[inline(never)]
    fn bounce(&mut self, rows: &[usize], face: &Face) {
        let outcome = run(Bounce { of: self, rows, face });
        self.settle(rows, &outcome);
    }

    /// Puts rows where they have come to, follows those who have to be, and says which are left: a bit each.
    #[inline(always)]
    fn settle(&mut self, rows: &[usize], outcome: &Outcome) -> u32 {
        let of_all = (1 << rows.len()) - 1;
        self.report.hits += outcome.hits.iter().map(|hits| u64::from((hits & of_all).count_ones())).sum::<u64>();
        let [[x, y, z], [u, v, w]] = &outcome.ends;
        let (position, velocity) = (&mut *self.tile.position, &mut *self.tile.velocity);
        for (i, &row) in rows.iter().enumerate().take(LANES) {
            let is_settled = outcome.settled >> i & 1 != 0;
            if let (true, Some(position), Some(velocity)) = (is_settled, position.get_mut(row), velocity.get_mut(row)) {
                (*position, *velocity) = (Vec3::new(x[i], y[i], z[i]), Vec3::new(u[i], v[i], w[i]));
            }
        }
        for i in ones(outcome.left & of_all) {
            self.follow(rows[i]);
        }
        of_all & !(outcome.settled | outcome.left)
    }

    /// Rows side by side, the first of them where there are fewer than eight.
    #[inline(always)]
    fn packet<F: Eight>(&self, like: F, rows: &[usize], face: &Face) -> (Riders<F>, Paths<F>) {
        let Tile { scene, attributes: ref m, .. } = *self.tile;
        let (mut all, mut radius, mut elasticity) = ([rows[0]; LANES], [0.0; LANES], [0.0; LANES]);
        let (mut at_rest, mut kinetic) = ([0.0; LANES], [0.0; LANES]);
        all[..rows.len()].copy_from_slice(rows);
        for (i, &row) in all.iter().enumerate() {
            (radius[i], elasticity[i]) = (m.lives.radius[row], m.elasticity[row]);
        }
        if scene.materials.count() > 0 {
            for (i, &row) in all.iter().enumerate() {
                let own = m.lives.material[row].checked_sub(1);
                let mixed = on_surface(scene.materials, elasticity[i], own, face.material());
                (elasticity[i], at_rest[i], kinetic[i]) =
                    (mixed.elasticity, mixed.friction.static_, mixed.friction.kinetic);
            }
        }
        let (radius, elasticity) = (like.of(radius), like.of(elasticity));
        let (at_rest, kinetic) = (like.of(at_rest), like.of(kinetic));
        let [start_x, start_v] = self.past.start;
        let (x0, v0) = (Vectors::gather(like, start_x, &all), Vectors::gather(like, start_v, &all));
        let x1 = Vectors::gather(like, self.tile.position, &all);
        let v1 = Vectors::gather(like, self.tile.velocity, &all);
        let time = like.all(self.tile.dt.seconds());
        (Riders { radius, elasticity, at_rest, kinetic }, Paths { x0, v0, x1, v1, time })
    }

    /// A row's path through the step.
    fn path(&self, row: usize) -> Path {
        let (Tile { dt, attributes, .. }, end) = (&*self.tile, self.tile.end());
        // A newborn has come only part of the way.
        let start = end - (end - attributes.lives.born[row]).min(*dt);
        let [x0, v0] = self.past.start;
        let (x1, v1) = (self.tile.position[row], self.tile.velocity[row]);
        Path { x0: x0[row], v0: v0[row], x1, v1, during: [start, end] }
    }

    /// Follows the particle in a row to its first hit and on, if its own box may touch anything.
    #[inline(never)]
    fn follow(&mut self, row: usize) {
        let path = self.path(row);
        let Self { tile, past, facing: known, report, observer } = self;
        let observer: Option<&mut dyn Observer> = match observer {
            Some(observer) => Some(&mut **observer),
            None => None,
        };
        let Tile { scene, old, dt, attributes: ref m, .. } = **tile;
        if m.inverse_mass[row] == 0.0 {
            return;
        }
        let lives = &m.lives;
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
        let sweep = Sweep {
            scene,
            walls: scene.colliders,
            sinks,
            id: Id { slot: lives.slot[row], serial: lives.springs.serial[row] },
            row: tile.first + row,
            radius,
            mass: lives.mass[row],
            elasticity: m.elasticity[row],
            material: m.lives.material[row].checked_sub(1),
            dt: dt.seconds(),
            report,
            observer,
        };
        let may_lie = row < old && mark == 0 && sinks.is_none_or(|sinks| !sinks.may_touch(&path.hull(radius)));
        let is_newborn = row >= old;
        // Whoever is near one face alone goes the short way, among however many things.
        let facing = match *known {
            Facing::Several if SHORT_WAY => facing(scene.colliders, &path, [radius, sweep.elasticity], sweep.dt),
            known => known,
        };
        let arrival = match facing {
            Facing::Face(face) if SHORT_WAY => sweep.past(&face).travel(&path, is_newborn, may_lie),
            _ => { sweep }.travel(&path, is_newborn, may_lie),
        };
        let Some(end) = arrival else { return };
        if is_kept && end.pending_death == PendingDeath::Lives && report.hits == before {
            return;
        }
        (tile.position[row], tile.velocity[row], tile.pending_death[row]) =
            (end.position, end.velocity, end.pending_death);
    }
}

/// Marks those from a row on that may touch anything in the step. Its hulls are off the stack when anybody is followed.
#[inline(never)]
fn marked(tile: &Tile<'_>, past: &Past<'_>, first: usize) -> Marks {
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
