//! Every particle by itself: rows whose boxes touch nothing are passed by, the others are followed.

mod among;
mod beside;
pub(super) mod face;
mod follow;
mod packets;
mod seek;
mod ways;

use super::air::Air;
use super::near::{Balls, Marks as Bits};
use super::sweep::facing;
use super::waiting::{List, Queue, ones};
use crate::collide::tile::Tile;
use crate::constrain::CARRIED;
use crate::memory::Past;
use crate::observe::{Attention, Observer};
use crate::report::Report;
use crate::shape::{Aabb, Face, Facing, Hulls, Many, Marks};
use crate::time::Time;
use glam::Vec3;

/// True where what faces one flat wall alone is followed by code of its own: chips, and programs without optimisation, are spared that.
const SHORT_WAY: bool = !cfg!(one_by_one);

/// Everything.
const EVERYWHERE: Aabb = Aabb { min: Vec3::NEG_INFINITY, max: Vec3::INFINITY };

/// Rows of a tile that are followed past walls.
struct TileSweep<'s, 'a> {
    tile: &'s mut Tile<'a>,
    past: Past<'s>,
    /// The row with which those columns begin that say where rows were.
    first: usize,
    /// True if surfaces may have friction, or take more of a bounce than particles do by themselves.
    has_materials: bool,
    facing: Facing,
    /// The forces that brake them, as far as is known.
    air: Option<Air<'s>>,
    /// True if all that may wait are points for sure.
    are_points: bool,
    report: &'s mut Report,
    observer: Option<&'s mut dyn Observer>,
}

/// Places in the list of those who may lie: for some words of marks.
const LISTED: usize = 7 * u64::BITS as usize;

/// Rows that wait to go past a face: as if they lay on it, and as if they bounced off it.
struct Waiting {
    face: Face,
    lying: List<LISTED>,
    bouncing: Queue,
}

/// Sends every free particle of a tile along its path through the sub-step, past all others.
pub(crate) fn each_by_itself(tile: &mut Tile<'_>, report: &mut Report, observer: &mut dyn Observer) {
    let work = core::mem::take(&mut tile.work);
    let past = tile.layout.past(work);
    let many = if SHORT_WAY { tile.obstacles.colliders.many() } else { None };
    let outskirts = many.and_then(Many::outskirts);
    let facing = facing_all(tile, outskirts);
    let observer: Option<&mut dyn Observer> =
        if observer.attention() > Attention::Nothing { Some(observer) } else { None };
    let (has_sinks, has_materials) = (!tile.obstacles.sinks.is_empty(), tile.obstacles.materials.count() > 0);
    let air = Air::around(&tile.obstacles);
    let mut tile_sweep =
        TileSweep { tile: &mut *tile, past, first: 0, has_materials, facing, air, are_points: false, report, observer };
    match (facing, many.zip(outskirts)) {
        (Facing::Face(face), _) if SHORT_WAY && !has_sinks => tile_sweep.go_past(&face),
        (_, Some((many, (face, things)))) if tile_sweep.goes_in_packets() => tile_sweep.go_among(many, face, &things),
        _ => tile_sweep.go(),
    }
    tile.work = work;
}

/// The scenery as any particle may meet it, wherever it is.
fn facing_all(tile: &Tile<'_>, outskirts: Option<(Option<Face>, Aabb)>) -> Facing {
    match outskirts {
        Some((face, things)) if things == Aabb::EMPTY => face.map_or(Facing::Nothing, Facing::Face),
        None if SHORT_WAY && tile.obstacles.colliders.many().is_none() => tile.obstacles.colliders.facing(&EVERYWHERE),
        _ => Facing::Several,
    }
}

/// The only thing that is to be met, if that is a flat face.
fn lone_face(tile: &Tile<'_>) -> Option<Face> {
    let outskirts = if SHORT_WAY { tile.obstacles.colliders.many().and_then(Many::outskirts) } else { None };
    match facing_all(tile, outskirts) {
        Facing::Face(face) if SHORT_WAY && tile.obstacles.sinks.is_empty() => Some(face),
        _ => None,
    }
}

impl Waiting {
    #[inline(always)]
    fn before(face: Face) -> Self {
        Self { face, lying: List::empty(), bouncing: Queue::empty() }
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
        self.tile.obstacles.sinks.is_empty() && marks.is_some_and(are_carried)
    }

    /// All rows on their ways of which it is known where they were.
    fn balls(&self) -> Balls<'_> {
        let Tile { dt, attributes: ref m, ref position, ref velocity, .. } = *self.tile;
        let ([x0, v0], all) = (self.past.start, self.first..position.len());
        let rows = all.len().min(x0.len());
        let ends = [x0, v0, &position[all.clone()], &velocity[all.clone()]].map(|column| &column[..rows]);
        Balls { ends, radius: &m.lives.radius[all][..rows], common: m.common.radius(), time: dt.seconds() }
    }

    /// The face that an old row is near, if that is all.
    fn face_of(&self, row: usize) -> Option<Face> {
        let Tile { ref obstacles, old, dt, attributes: ref m, .. } = *self.tile;
        let path = self.path(row);
        if row >= old || m.inverse_mass[row] == 0.0 || !path.is_finite() {
            return None;
        }
        match facing(obstacles.colliders, &path, [m.lives.radius[row], m.elasticity[row]], dt.seconds()) {
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
        let first = first as u32;
        waiting.lying.add(first, lying);
        ones(touching & !lying).for_each(|nth| self.wait(first + nth as u32, &waiting.face, &mut waiting.bouncing));
        if waiting.lying.is_full() {
            self.go_listed(waiting);
        }
    }

    /// Lets those lie who may and are listed.
    #[inline(never)]
    fn go_listed(&mut self, Waiting { face, lying, bouncing }: &mut Waiting) {
        let (eights, len) = lying.take_eights();
        self.lie(eights, len, face, bouncing);
    }

    /// Lets those go who still wait.
    fn go_on(&mut self, waiting: &mut Waiting) {
        self.go_listed(waiting);
        self.bounce(&waiting.face, &mut waiting.bouncing);
    }

    /// Tells whether rows may go in another order: nobody asks, nothing removes them, and a hit may follow another.
    fn goes_in_packets(&self) -> bool {
        let Tile { ref obstacles, dt, .. } = *self.tile;
        let alone = self.observer.is_none() && obstacles.sinks.is_empty() && self.past.marks.is_empty();
        alone && obstacles.max_bounces > 1 && dt > Time::ZERO
    }
}

/// The marks of 64 rows after the other.
#[inline(always)]
fn words(marks: &Bits) -> impl Iterator<Item = u64> + '_ {
    marks.as_chunks().0.iter().map(|bytes| u64::from_le_bytes(*bytes))
}

/// Marks those from a row on that may touch anything in the step. Its hulls are off the stack when anybody is followed.
#[inline(never)]
fn marked(tile: &Tile<'_>, past: &Past<'_>, first: usize) -> Marks {
    let Tile { ref obstacles, old, dt, .. } = *tile;
    let rows = first..tile.position.len().min(first + Hulls::MANY);
    let [start_x, start_v] = past.start;
    let ends = [start_x, start_v, tile.position, tile.velocity].map(|column| &column[rows.clone()]);
    let hulls = Hulls::of_paths(ends, &tile.attributes.lives.radius[rows.clone()], dt.seconds());
    let mut marks = [0; Hulls::MANY];
    obstacles.colliders.mark_near(&hulls, &mut marks);
    obstacles.sinks.mark_near(&hulls, &mut marks);
    // Newborns have come only part of the way: their cubics are others.
    marks[old.clamp(rows.start, rows.end) - first..].fill(u32::MAX);
    marks[rows.len()..].fill(0);
    marks
}
