//! The particles as a constraint sees and moves them.

use super::load::Load;
use crate::custom::CustomColumnsMut;
use crate::index::{IndexChoice, Room, between};
use crate::material::MaterialList;
use crate::memory::{Demand, Kept, take};
use crate::observe::{Attention, Impact, Observer};
use crate::particles::Id;
use crate::reap::PendingDeath;
use crate::report::Report;
use crate::shape::Collider;
use crate::time::Time;
use core::fmt;
use glam::Vec3;

/// A constraint has moved the particle: its path through the sub-step is no longer the method's.
pub(crate) const SHIFTED: u32 = 1;
/// A constraint keeps the particle from what it touches: the sweep only keeps its middle from passing through.
pub(crate) const TOUCHING: u32 = 2;
/// The particle belongs to a body that meets the scenery as a whole, or its way has been followed past that: the sweep looks
/// for sinks on its path, and for nothing else.
pub(crate) const CARRIED: u32 = 4;
/// The bits of a mark that say what constraints have done to its particle; the others are those of how far it is kept off scenery.
pub(crate) const DONE: u32 = SHIFTED | TOUCHING | CARRIED;

/// A part of a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Substep {
    /// When it begins and ends.
    pub during: [Time; 2],
    /// Its number in the step, from 0, and of how many.
    pub number: u32,
    /// In how many the step is cut.
    pub count: u32,
    /// How long the whole step is.
    pub step: Time,
}

impl Substep {
    /// How long it is \[s\].
    #[must_use]
    pub fn seconds(&self) -> f32 {
        (self.during[1] - self.during[0]).seconds()
    }

    /// Tells whether it is the last of its step.
    #[must_use]
    pub fn is_last(&self) -> bool {
        self.number + 1 == self.count
    }
}

/// The particles of a sub-step as constraints see and move them: one entry a row. Those born in this step are not among them.
#[allow(missing_debug_implementations)]
pub struct Bodies<'a> {
    /// Positions \[m\].
    pub position: &'a mut [Vec3],
    /// Velocities \[m/s\].
    pub velocity: &'a mut [Vec3],
    /// Positions and velocities when the sub-step began.
    pub before: [&'a [Vec3]; 2],
    /// Radii \[m\].
    pub radius: &'a [f32],
    /// Masses \[kg\].
    pub mass: &'a [f32],
    /// Inverse masses \[1/kg\]; zero for what is fixed.
    pub inverse_mass: &'a [f32],
    /// Shares of the normal speed that they keep in a hit.
    pub elasticity: &'a [f32],
    /// Numbers of their materials plus one; zero: none.
    pub material: &'a [u16],
    /// Columns of a user's own.
    pub custom: CustomColumnsMut<'a>,
    /// The sub-step.
    pub substep: Substep,
    /// The scene's colliders.
    pub colliders: &'a dyn Collider,
    /// The materials of them and of the colliders, by numbers.
    pub materials: &'a dyn MaterialList,
    /// The neighbours of each.
    pub near: Near<'a>,
    /// The report on the step, to count in.
    pub report: &'a mut Report,
    pub(crate) slot: &'a [u32],
    pub(crate) serial: &'a [u32],
    pub(crate) row_of: &'a [u32],
    pub(crate) pending_death: &'a [PendingDeath],
    /// Particles of the scene's start that found room.
    pub(crate) start: u32,
    pub(crate) marks: &'a mut [u32],
    /// For each the name of what it is bound in, zero for none; empty where nothing binds.
    pub(crate) bound: &'a mut [u32],
    /// How much faster each will be made as velocities are settled \[m/s\]; empty where nobody puts anything off.
    pub(crate) postponed: &'a mut [Vec3],
    /// The load of each; empty where nobody lays anything on others.
    pub(crate) loads: &'a mut [Load],
    pub(crate) observer: &'a mut dyn Observer,
}

impl Bodies<'_> {
    /// The number of particles.
    #[must_use]
    pub fn len(&self) -> usize {
        self.position.len()
    }

    /// Tells whether there is none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.position.is_empty()
    }

    /// The id of the particle in a row.
    #[must_use]
    pub fn id(&self, row: usize) -> Option<Id> {
        Some(Id { slot: *self.slot.get(row)?, serial: *self.serial.get(row)? })
    }

    /// The row of a particle by its place in the scene's start, while it lives: who has met a sink in an earlier sub-step does not.
    #[must_use]
    pub fn row_of_start(&self, number: u32) -> Option<usize> {
        let row = *self.row_of.get(number as usize)? as usize;
        let lives = || self.pending_death.get(row).is_none_or(|death| *death == PendingDeath::Lives);
        (number < self.start && self.serial.get(row) == Some(&number) && lives()).then_some(row)
    }

    /// The way from one row to another \[m\]: the shortest, in a [periodic room](crate::index::Periodic). None to or from a row that there is not: zero.
    #[must_use]
    pub fn between(&self, from: usize, to: usize) -> Vec3 {
        match (self.position.get(from), self.position.get(to)) {
            (Some(&from), Some(&to)) => between(self.near.index.room(), from, to),
            _ => Vec3::ZERO,
        }
    }

    /// Moves a particle by `by` \[m\], and lets its velocity follow: by what that is over the sub-step. Whoever is
    /// fixed is moved as well: a constraint leaves out rows whose inverse mass is zero. A row that there is not is passed over.
    pub fn shift(&mut self, row: usize, by: Vec3) {
        let h = self.substep.seconds();
        let (x, v, mark) = (self.position.get_mut(row), self.velocity.get_mut(row), self.marks.get_mut(row));
        let (Some(x), Some(v), Some(mark)) = (x, v, mark) else { return };
        *x += by;
        if h > 0.0 {
            *v += by * (1.0 / h);
        }
        *mark |= SHIFTED;
    }

    /// Moves a particle as [`shift`](Self::shift) does, and by what rounding has left of its way before; keeps what it leaves of it now \[m\].
    pub(super) fn shift_on(&mut self, row: usize, by: Vec3, left: &mut Vec3) {
        let (from, way) = (self.position[row], by + *left);
        self.shift(row, by);
        self.position[row] = from + way;
        let lost = way - (self.position[row] - from);
        *left = if lost.is_finite() { lost } else { Vec3::ZERO };
    }

    /// Says that a particle will be made faster by so much \[m/s\] as velocities are settled; it is done when the same is said with its sign changed. Others
    /// can count that as a force meanwhile. All of it is forgotten as a sub-step begins.
    pub fn postpone(&mut self, row: usize, faster: Vec3) {
        if let Some(sum) = self.postponed.get_mut(row) {
            *sum += faster;
        }
    }

    /// How much faster a particle will yet be made as velocities are settled \[m/s\].
    #[must_use]
    pub fn postponed(&self, row: usize) -> Vec3 {
        self.postponed.get(row).copied().unwrap_or(Vec3::ZERO)
    }

    /// Moves a particle by `by` \[m\], or makes it faster by that \[m/s\].
    pub(super) fn change(&mut self, what: Change, row: usize, by: Vec3) {
        match what {
            Change::Place => self.shift(row, by),
            Change::Velocity => self.velocity[row] += by,
        }
    }

    /// How far the method has brought a particle beyond where its velocity leads in a sub-step of `h` \[m\].
    pub(crate) fn lead(&self, row: usize, h: f32) -> Vec3 {
        if self.inverse_mass[row] > 0.0 {
            self.position[row] - self.before[0][row] - self.velocity[row] * h
        } else {
            Vec3::ZERO
        }
    }

    /// Says that the particle in a row is kept so far off the scenery \[m\], to rounding, by a constraint that follows its way past that.
    pub(crate) fn keep_off(&mut self, row: usize, distance: f32) {
        if distance > 0.0 && distance < f32::INFINITY {
            self.marks[row] = self.marks[row] & DONE | distance.to_bits() & !DONE;
        }
    }

    /// How far off the scenery a constraint keeps the particle in a row \[m\]; zero: none does.
    pub(crate) fn clearance(&self, row: usize) -> f32 {
        f32::from_bits(self.marks[row] & !DONE)
    }

    /// Tells whether somebody watches who wants to be told.
    pub(crate) fn is_watched(&self) -> bool {
        self.observer.attention() > Attention::Nothing
    }

    /// Tells whoever watches that a particle is kept from another thing with which it came together.
    pub fn tell(&mut self, touch: &Impact) {
        self.observer.touched(touch);
    }

    /// Says that the particle in a row has not passed through the scenery on its way through the sub-step.
    pub(crate) fn mark_followed(&mut self, row: usize) {
        self.marks[row] |= SHIFTED | CARRIED;
    }

    /// Says that the particle in a row is kept from the surface it touches, and needs no other answer to it in this sub-step:
    /// the sweep then only sees that its inner half does not pass through. A row that there is not is passed over.
    pub fn mark_touching(&mut self, row: usize) {
        if let Some(mark) = self.marks.get_mut(row) {
            *mark |= SHIFTED | TOUCHING;
        }
    }

    /// Says that particles, by their places in the scene's start, are held in their places to each other through the step: contacts between them are
    /// none. Who is bound several times counts as bound by the last.
    pub fn bind(&mut self, particles: &[u32]) {
        let rows = |bodies: &Self, number: &u32| bodies.row_of_start(*number).filter(|&row| row < bodies.bound.len());
        // By a name that nobody else can have taken: the row of one whom nobody has bound.
        let free = particles.iter().filter_map(|number| rows(self, number)).find(|&row| self.bound[row] == 0);
        let Some(free) = free else { return };
        for number in particles {
            if let Some(row) = rows(self, number) {
                self.bound[row] = free as u32 + 1;
            }
        }
    }

    /// Tells whether two are held in their places to each other.
    #[must_use]
    pub fn are_bound(&self, row: usize, other: usize) -> bool {
        are_bound(self.bound, row, other)
    }

    /// Tells whether it has been said of the particle in a row that it is kept from a surface, in this sub-step.
    pub(crate) fn is_touching(&self, row: usize) -> bool {
        self.marks[row] & TOUCHING != 0
    }
}

/// Tells whether two are bound by one name.
pub(super) fn are_bound(bound: &[u32], row: usize, other: usize) -> bool {
    matches!((bound.get(row), bound.get(other)), (Some(&a), Some(&b)) if a == b && a != 0)
}

/// The part of a particle that is changed: its place, with its velocity following, or its velocity alone.
#[derive(Clone, Copy)]
pub(super) enum Change {
    Place,
    Velocity,
}

/// Finds who is near whom, by the scene's index.
pub struct Near<'a> {
    pub(crate) index: &'a dyn IndexChoice,
    pub(crate) memory: &'a mut [u32],
    /// Counts searches that looked at all pairs.
    pub(crate) all_pairs: &'a mut u64,
}

impl fmt::Debug for Near<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Near").field("words", &self.memory.len()).finish_non_exhaustive()
    }
}

/// Visits the rows of those near a place.
pub type Around<'a> = dyn Fn(Vec3, &mut dyn FnMut(u32)) + 'a;

impl<'a> Near<'a> {
    /// The room that the particles are in, if there is one.
    pub(crate) fn room(&self) -> Option<&'a Room> {
        self.index.room()
    }

    /// Puts points into an index, and calls `then` with a function that visits those within `reach` \[m\] of any place, by their rows: in an order of
    /// the index's own. In a [periodic room](crate::index::Periodic) they are near through its sides.
    pub fn ask(&mut self, points: &[Vec3], reach: f32, then: &mut dyn FnMut(&Around<'_>)) {
        let words = (3 * self.index.columns() * points.len()).min(self.memory.len());
        let room = self.index.room();
        let farther = farther(room, reach);
        self.index.with_index(&mut self.memory[..words], points, farther, room, &mut |index| match index {
            Some(index) => then(&|place, visit| {
                index.within(place, farther, &mut |rows| {
                    // An index of somebody else's may hand out rows that there are not.
                    let sure = |&&row: &&u32| {
                        let point = points.get(row as usize);
                        point.is_some_and(|&point| room.is_none() || is_near(room, place, point, reach))
                    };
                    rows.iter().filter(sure).for_each(|&row| visit(row));
                });
            }),
            None => {
                *self.all_pairs += u64::from(!points.is_empty());
                then(&|place, visit| {
                    let near = |&(_, &point): &(usize, &Vec3)| is_near(room, place, point, reach);
                    points.iter().enumerate().filter(near).for_each(|(row, _)| visit(row as u32));
                });
            }
        });
    }

    /// Visits every two of the points within `reach` \[m\] of each other once, by their rows: in an order of the index's own. In a
    /// [periodic room](crate::index::Periodic) they are near through its sides.
    pub fn pairs(&mut self, points: &[Vec3], reach: f32, visit: &mut dyn FnMut(u32, u32)) {
        // No more memory than these points call for: more would make another structure.
        let words = (3 * self.index.columns() * points.len()).min(self.memory.len());
        let room = self.index.room();
        let farther = farther(room, reach);
        let near = |a: Vec3, b: Vec3| is_near(room, a, b, reach);
        self.index.with_index(&mut self.memory[..words], points, farther, room, &mut |index| match index {
            Some(index) => {
                index.pairs(farther, &mut |row, others| {
                    let Some(&point) = points.get(row as usize) else { return };
                    let sure = |&&other: &&u32| {
                        points.get(other as usize).is_some_and(|&other| room.is_none() || near(point, other))
                    };
                    others.iter().filter(sure).for_each(|&other| visit(row, other));
                });
            }
            None => {
                *self.all_pairs += u64::from(!points.is_empty());
                for (row, &point) in points.iter().enumerate() {
                    let others = points[..row].iter().enumerate().filter(|&(_, &other)| near(point, other));
                    others.for_each(|(other, _)| visit(row as u32, other as u32));
                }
            }
        });
    }
}

/// How far an index looks for what is within reach: in a room a rounding farther, as ways are others there.
fn farther(room: Option<&Room>, reach: f32) -> f32 {
    reach + room.map_or(0.0, Room::slack)
}

/// Tells whether one place is within reach of another, in a room if there is one.
#[inline]
fn is_near(room: Option<&Room>, from: Vec3, to: Vec3, reach: f32) -> bool {
    let d = between(room, from, to);
    d.x * d.x + d.y * d.y + d.z * d.z <= reach * reach
}

/// A constraint's own memory.
#[derive(Debug)]
pub struct Share<'a> {
    /// The words that it keeps from step to step.
    pub kept: Kept<'a>,
    /// The words that it keeps through the step: at the first sub-step they hold anything.
    pub step: &'a mut [u32],
    /// The words that it works with while it is called.
    pub scratch: &'a mut [u32],
    /// Particles there is room for.
    pub capacity: usize,
}

impl Share<'_> {
    /// Makes the kept words those of a constraint of a kind and of such sizes; tells whether they have to be learnt anew.
    pub(super) fn claim(&mut self, kind: [u8; 4], sizes: &[usize]) -> bool {
        let mix = |name: u32, &size: &usize| (name ^ size as u32).wrapping_mul(0x9e37_79b1).rotate_left(13);
        self.kept.claim(sizes.iter().fold(u32::from_le_bytes(kind), mix) | 1)
    }

    /// The shares of its parts, one after the other.
    pub(super) fn parts(&mut self) -> Parts<'_> {
        let Share { kept, step, scratch, capacity } = self;
        Parts { kept: kept.again(), step, scratch, capacity: *capacity }
    }
}

/// A share that is being cut into those of parts.
pub(super) struct Parts<'a> {
    kept: Kept<'a>,
    step: &'a mut [u32],
    scratch: &'a mut [u32],
    capacity: usize,
}

impl Parts<'_> {
    /// The next one's.
    pub(super) fn next(&mut self, demand: Demand) -> Share<'_> {
        let step = take(&mut self.step, demand.step.of(self.capacity));
        let rows = take(&mut self.kept.rows, demand.kept.per_row * self.capacity);
        let kept = Kept { rows, fixed: take(&mut self.kept.fixed, demand.kept.fixed) };
        Share { kept, step, scratch: self.scratch, capacity: self.capacity }
    }
}
