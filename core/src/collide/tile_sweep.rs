//! Every particle by itself: rows whose boxes touch nothing are passed by, the others are followed.

mod among;
mod follow;

use super::near::{BLOCK, Balls, Marks as Bits, Near};
use super::packet::{Outcome, Paths, Riders};
use super::sweep::facing;
use super::waiting::{Packet, Queue, ones};
use crate::constrain::CARRIED;
use crate::lanes::{Eight, Kernel, LANES, Vectors, not, run, widest};
use crate::material::on_surface;
use crate::math::max;
use crate::memory::Past;
use crate::observe::{Attention, Observer};
use crate::report::Report;
use crate::shape::{Aabb, Face, Facing, Hulls, Many, Marks};
use crate::step::Tile;
use crate::time::Time;
use glam::Vec3;

/// True where what faces one flat wall alone is followed by code of its own: chips are spared that.
const SHORT_WAY: bool = !cfg!(target_os = "none");

/// A bit for each row of a packet.
const ALL: u32 = (1 << LANES) - 1;

/// Everything.
const EVERYWHERE: Aabb = Aabb { min: Vec3::NEG_INFINITY, max: Vec3::INFINITY };

/// Rows of a tile that are followed past walls.
struct TileSweep<'s, 'a> {
    tile: &'s mut Tile<'a>,
    past: Past<'s>,
    /// True if surfaces may have friction, or take more of a bounce than particles do by themselves.
    has_materials: bool,
    /// True if there are springs.
    has_springs: bool,
    facing: Facing,
    /// True if all that may wait are points for sure.
    are_points: bool,
    report: &'s mut Report,
    observer: Option<&'s mut dyn Observer>,
}

/// Rows that wait to go past a face: as if they lay on it, and as if they bounced off it.
struct Waiting {
    face: Face,
    lying: Queue,
    bouncing: Queue,
}

/// Sends every free particle of a tile along its path through the sub-step, past all others.
pub(crate) fn each_by_itself(tile: &mut Tile<'_>, report: &mut Report, observer: &mut dyn Observer) {
    let work = core::mem::take(&mut tile.work);
    let past = tile.layout.past(work);
    let many = if SHORT_WAY { tile.scene.colliders.many() } else { None };
    let outskirts = many.and_then(Many::outskirts);
    let facing = match outskirts {
        Some((face, things)) if things == Aabb::EMPTY => face.map_or(Facing::Nothing, Facing::Face),
        None if SHORT_WAY && many.is_none() => tile.scene.colliders.facing(&EVERYWHERE),
        _ => Facing::Several,
    };
    let observer: Option<&mut dyn Observer> =
        if observer.attention() > Attention::Nothing { Some(observer) } else { None };
    let (has_sinks, has_materials) = (!tile.scene.sinks.is_empty(), tile.scene.materials.count() > 0);
    let has_springs = !tile.scene.springs.list().is_empty();
    let mut tile_sweep =
        TileSweep { tile: &mut *tile, past, has_materials, has_springs, facing, are_points: false, report, observer };
    match (facing, many.zip(outskirts)) {
        (Facing::Face(face), _) if SHORT_WAY && !has_sinks => tile_sweep.go_past(&face),
        (_, Some((many, (face, things)))) if tile_sweep.goes_in_packets() => tile_sweep.go_among(many, face, &things),
        _ => tile_sweep.go(),
    }
    tile.work = work;
}

/// Rows that may lie on a face.
struct Lie<'t, 's, 'a, const POINTS: bool> {
    of: &'t mut TileSweep<'s, 'a>,
    packet: &'t Packet,
    face: &'t Face,
}

/// Rows that may bounce off a face.
struct Bounce<'t, 's, 'a, const POINTS: bool> {
    of: &'t mut TileSweep<'s, 'a>,
    packet: &'t Packet,
    face: &'t Face,
}

/// The rows of a packet that are to be followed alone, and those that neither are nor have come to the end of the step: a bit each.
struct Unsettled {
    left: u32,
    others: u32,
}

impl<const POINTS: bool> Kernel for Lie<'_, '_, '_, POINTS> {
    type Output = Unsettled;
    #[inline(always)]
    fn run<F: Eight>(self, like: F) -> Unsettled {
        let (riders, paths) = self.of.packet::<F, true, POINTS>(like, self.packet.rows, self.face);
        let outcome = riders.lie(&paths, self.face, self.packet.present());
        self.of.settle(self.packet, &outcome)
    }
}

impl<const POINTS: bool> Kernel for Bounce<'_, '_, '_, POINTS> {
    type Output = Unsettled;
    #[inline(always)]
    fn run<F: Eight>(self, like: F) -> Unsettled {
        let (riders, paths) = self.of.packet::<F, false, POINTS>(like, self.packet.rows, self.face);
        let Tile { dt, scene, .. } = *self.of.tile;
        let outcome = riders.bounce(&paths, self.face, self.packet.present(), dt, scene.max_bounces);
        self.of.settle(self.packet, &outcome)
    }
}

impl Waiting {
    fn before(face: Face) -> Self {
        Self { face, lying: Queue::EMPTY, bouncing: Queue::EMPTY }
    }
}

impl TileSweep<'_, '_> {
    /// Follows one row after the other; those who are near the same face alone go past it in packets.
    fn go(&mut self) {
        if !SHORT_WAY {
            return (0..self.tile.position.len()).for_each(|row| self.follow(row));
        }
        let in_packets = self.goes_in_packets();
        let mut waiting: Option<Waiting> = None;
        for first in (0..self.tile.position.len()).step_by(Hulls::MANY) {
            let mut in_packet = 0;
            if self.are_carried(first, Hulls::MANY) {
                continue;
            }
            for (i, mark) in marked(self.tile, &self.past, first).into_iter().enumerate() {
                let row = first + i;
                if mark == 0 {
                    continue;
                }
                match if in_packets { self.face_of(row) } else { None } {
                    Some(face) if waiting.get_or_insert_with(|| Waiting::before(face)).face == face => {
                        in_packet |= 1_u64 << i;
                    }
                    _ => self.follow(row),
                }
            }
            if let Some(waiting) = &mut waiting {
                self.queue(first, [in_packet; 2], waiting);
            }
        }
        if let Some(waiting) = &mut waiting {
            self.go_on(waiting);
        }
    }

    /// Tells whether constraints have taken all of so many rows past the scenery, and nothing is left to meet.
    fn are_carried(&self, first: usize, most: usize) -> bool {
        let rows = first..self.tile.position.len().min(first + most);
        let marks = self.past.marks.get(rows.clone()).filter(|_| rows.end <= self.tile.old);
        let are_carried = |marks: &[u32]| marks.iter().fold(CARRIED, |all, mark| all & mark) != 0;
        self.tile.scene.sinks.is_empty() && marks.is_some_and(are_carried)
    }

    /// Follows all past a face, those who were there before the step in packets.
    fn go_past(&mut self, face: &Face) {
        let (old, in_packets) = (self.tile.old, self.goes_in_packets());
        let mut waiting = Waiting::before(*face);
        self.are_points = true;
        for first in (0..old).step_by(BLOCK) {
            if self.are_carried(first, BLOCK) {
                continue;
            }
            let block = self.balls().block(first..old.min(first + BLOCK), self.tile.reached);
            let (Near { touching, lying }, are_points) = (block.near(face), block.are_points());
            self.are_points &= are_points;
            let marks = (first..old).step_by(u64::BITS as usize).zip(words(&touching).zip(words(&lying)));
            if !in_packets {
                marks.for_each(|(row, (touching, _))| ones(touching).for_each(|i| self.follow(row + i)));
                continue;
            }
            // Not for wide vectors, but for the instructions that find the bits of a word.
            widest(
                #[inline(always)]
                || {
                    for (row, (touching, lying)) in marks {
                        self.queue(row, [touching, lying], &mut waiting);
                    }
                },
            );
        }
        self.go_on(&mut waiting);
        self.let_go_past(face);
    }

    /// Follows the newborn past a face. The control points of paths that take only part of the step lie between those that a whole one
    /// would have, and so do their boxes.
    fn let_go_past(&mut self, face: &Face) {
        let len = self.tile.position.len();
        for first in (self.tile.old..len).step_by(BLOCK) {
            let marks = self.balls().block(first..len.min(first + BLOCK), None).near(face);
            let eights = (first..len).step_by(LANES).zip(marks.touching);
            eights.for_each(|(row, marks)| ones(marks).for_each(|i| self.follow(row + i)));
        }
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

    /// Lets those of some rows from the first on that are marked wait for others: who may touch a face, and who of them may lie on it. A
    /// tile's last row goes alone, as none is behind it to be read with it.
    #[inline(always)]
    fn queue(&mut self, first: usize, [mut touching, mut lying]: [u64; 2], waiting: &mut Waiting) {
        let last = self.tile.position.len() - 1;
        if let Some(bit) = 1_u64.checked_shl((last - first) as u32).filter(|bit| touching & bit != 0) {
            (touching, lying) = (touching ^ bit, lying & !bit);
            self.follow(last);
        }
        // There are fewer than 2³² slots, and so fewer rows.
        waiting.lying.push_all(first as u32, lying);
        waiting.bouncing.push_all(first as u32, touching & !lying);
        while let Some(packet) = waiting.lying.pop() {
            self.lie(&packet, waiting);
        }
        while let Some(packet) = waiting.bouncing.pop() {
            self.bounce(&packet, &waiting.face);
        }
    }

    /// Lets those go who still wait.
    fn go_on(&mut self, waiting: &mut Waiting) {
        if let Some(packet) = waiting.lying.rest() {
            self.lie(&packet, waiting);
        }
        if let Some(packet) = waiting.bouncing.rest() {
            self.bounce(&packet, &waiting.face);
        }
    }

    /// Tells whether rows may go in another order: nobody asks, nothing removes them, and a hit may follow another.
    fn goes_in_packets(&self) -> bool {
        let Tile { scene, dt, .. } = *self.tile;
        let alone = self.observer.is_none() && scene.sinks.is_empty() && self.past.marks.is_empty();
        alone && scene.max_bounces > 1 && dt > Time::ZERO
    }

    /// Lets those who lie on the face do so; the others bounce.
    #[inline(never)]
    fn lie(&mut self, packet: &Packet, Waiting { face, bouncing, .. }: &mut Waiting) {
        let unsettled = match self.are_points {
            true => run(Lie::<true> { of: self, packet, face }),
            false => run(Lie::<false> { of: self, packet, face }),
        };
        if unsettled.left | unsettled.others == 0 {
            return;
        }
        ones(unsettled.left).for_each(|i| self.follow(packet.rows[i % LANES] as usize));
        ones(unsettled.others).for_each(|i| bouncing.push(packet.rows[i % LANES]));
        while let Some(packet) = bouncing.pop() {
            self.bounce(&packet, face);
        }
    }

    /// Lets those bounce off the face who do so a few times.
    #[inline(never)]
    fn bounce(&mut self, packet: &Packet, face: &Face) {
        let unsettled = match self.are_points {
            true => run(Bounce::<true> { of: self, packet, face }),
            false => run(Bounce::<false> { of: self, packet, face }),
        };
        ones(unsettled.left).for_each(|i| self.follow(packet.rows[i % LANES] as usize));
    }

    /// Puts rows where they have come to, and says which are left.
    #[inline(always)]
    fn settle<F: Eight>(&mut self, packet: &Packet, outcome: &Outcome<F>) -> Unsettled {
        let present = packet.present();
        self.report.hits += u64::from(outcome.hits);
        if let Some(reached) = &mut self.tile.reached {
            reached.place = max(reached.place, outcome.farthest);
        }
        let (position, velocity) = (&mut *self.tile.position, &mut *self.tile.velocity);
        let velocity = &mut velocity[..position.len()];
        let [places, velocities] = outcome.ends.map(Vectors::rows);
        let lanes = packet.rows.iter().zip(&places).zip(&velocities);
        if outcome.settled == ALL {
            for ((row, place), speed) in lanes {
                put(position, velocity, *row, [place, speed]);
            }
        } else {
            for (i, ((row, place), speed)) in lanes.enumerate() {
                // Who is missing is the first over again.
                if outcome.settled >> i & 1 != 0 {
                    put(position, velocity, *row, [place, speed]);
                }
            }
        }
        Unsettled { left: outcome.left & present, others: present & !(outcome.settled | outcome.left) }
    }

    /// Rows side by side, none of which is the tile's last. Of those who may lie on a face, only what that takes is read.
    #[inline(always)]
    fn packet<F: Eight, const LIES: bool, const POINTS: bool>(
        &self,
        like: F,
        [a, b, c, d, e, f, g, h]: [u32; LANES],
        face: &Face,
    ) -> (Riders<F, POINTS>, Paths<F>) {
        let rows = &[a as usize, b as usize, c as usize, d as usize, e as usize, f as usize, g as usize, h as usize];
        let Tile { attributes: ref m, ref position, ref velocity, .. } = *self.tile;
        let (last, [start_x, start_v]) = (position.len() - 1, self.past.start);
        let column = |column: &[f32]| {
            let mut lanes = [0.0; LANES];
            lanes.iter_mut().zip(rows).for_each(|(lane, &row)| *lane = column[..last][row]);
            lanes
        };
        // Rows that have leapt are finite, and such as are held have stayed as they were, which is not how something falls onto a face.
        let have_leapt = self.tile.reached.is_some();
        let time = self.tile.dt.seconds();
        let are_close = self.tile.reached.is_some_and(|to| to.place + 100.0 * to.speed * time <= Paths::<F>::CLOSE);
        let gathered = |column: &[Vec3]| Vectors::gather(like, column, last, rows);
        let (x0, v0, v1) = (gathered(start_x), gathered(start_v), gathered(velocity));
        let x1 = if LIES && have_leapt { x0 } else { gathered(position) };
        let paths = Paths { x0, v0, x1, v1, time: like.all(time) };
        let mut are_free = like.all(f32::from_bits(u32::MAX));
        if !(LIES && have_leapt) {
            are_free = paths.are_finite() & not(like.of(column(m.inverse_mass)).simd_eq(like.all(0.0)));
        }
        let (mut elasticity, mut at_rest, mut kinetic) = ([0.0; LANES], [0.0; LANES], [0.0; LANES]);
        if !LIES || self.has_materials {
            elasticity = column(m.elasticity);
        }
        if self.has_materials {
            [elasticity, at_rest, kinetic] = self.mixed(rows, face, &elasticity);
        }
        let riders = Riders {
            are_free,
            are_close,
            swing: self.has_springs,
            radius: if POINTS { like.all(0.0) } else { like.of(column(m.lives.radius)) },
            elasticity: like.of(elasticity),
            at_rest: like.of(at_rest),
            kinetic: like.of(kinetic),
        };
        (riders, paths)
    }

    /// The elasticities of rows on a face, and the coefficients of friction at rest and in motion.
    #[inline(never)]
    fn mixed(&self, rows: &[usize; LANES], face: &Face, elasticity: &[f32; LANES]) -> [[f32; LANES]; 3] {
        let mut mixed = [[0.0; LANES]; 3];
        let [bounces, at_rest, kinetic] = &mut mixed;
        for (i, (&row, &elasticity)) in rows.iter().zip(elasticity).enumerate() {
            let own = self.tile.attributes.lives.material[row].checked_sub(1);
            let mixed = on_surface(self.tile.scene.materials, elasticity, own, face.material());
            (bounces[i], at_rest[i], kinetic[i]) = (mixed.elasticity, mixed.friction.static_, mixed.friction.kinetic);
        }
        mixed
    }
}

/// Puts a row to a place, with a velocity: three numbers of each.
#[inline(always)]
fn put(position: &mut [Vec3], velocity: &mut [Vec3], row: u32, [[x, y, z, _], [u, v, w, _]]: [&[f32; 4]; 2]) {
    let row = row as usize;
    (position[row], velocity[row]) = (Vec3::new(*x, *y, *z), Vec3::new(*u, *v, *w));
}

/// The marks of 64 rows after the other.
#[inline(always)]
fn words(marks: &Bits) -> impl Iterator<Item = u64> + '_ {
    marks.as_chunks().0.iter().map(|bytes| u64::from_le_bytes(*bytes))
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
