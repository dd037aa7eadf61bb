//! All neighbours in ascending order of rows: what is near a group of points is put in order once for all of them.

use super::Room;
use super::domain::Image;
use super::near::{GROUP, Near, chunks};
use super::partition::Partition;
use super::search::{Reach, Search};
use super::sorted::{LANES, Sorted};
use crate::lanes::{self, COUNTS, Eight, HITS, Kernel};
use crate::math::largest;
use core::ops::Range;
use glam::Vec3;
use wide::f32x8;

/// The largest number of points near a group.
const MOST: usize = 1024;
/// The largest number of bits of a digit by which they are sorted.
const DIGIT: usize = 9;

/// The points near a group, in ascending order of their rows.
struct Crowd {
    len: usize,
    /// Their rows and slots, while they are put in order, and room for that.
    keys: [[u64; MOST]; 2],
    slots: [u32; MOST],
    x: [[f32; MOST]; 3],
    /// The room in which ways to them lead through the sides, if they do.
    room: Option<Room>,
    /// Where in this order the points of the group are.
    own: [usize; GROUP],
    /// The neighbours of one point of the group, by their numbers in this order, then by their slots.
    found: [u32; MOST + LANES],
}

impl<P: Partition> Search<'_, P> {
    /// Visits the points in some slots with the slots of all others within a radius, in ascending order of rows. False if more
    /// are near somebody than there is room for, or may be in two images: then not all have been visited.
    pub(super) fn in_order(&self, slots: Range<usize>, radius: f32, visit: &mut dyn FnMut(usize, &[u32])) -> bool {
        let Some(reach) = self.reach(radius) else { return true };
        let (mut near, mut crowd, mut fits) = (Near::new(), Crowd::new(), true);
        self.0.groups(&mut |group, frame| {
            for group in chunks(group.start.max(slots.start)..group.end.min(slots.end)) {
                fits = fits && self.group_in_order((group, frame), reach, (&mut near, &mut crowd), visit);
            }
        });
        fits
    }

    /// Visits a group, or one half of it and then the other: where many are near, fewer are near fewer.
    fn group_in_order(
        &self,
        (group, frame): (Range<usize>, u32),
        reach: Reach,
        (near, crowd): (&mut Near, &mut Crowd),
        visit: &mut dyn FnMut(usize, &[u32]),
    ) -> bool {
        let sorted = self.0.sorted();
        self.gather(&group, frame, 0, reach, near);
        if !near.full && is_met_once(sorted, &group, reach) && crowd.take(sorted, near, reach.square) {
            crowd.visit(sorted, group, reach.square, visit);
            return true;
        }
        let middle = group.start + group.len() / 2;
        let halves = [group.start..middle, middle..group.end];
        let mut is_visited = |half| self.group_in_order((half, frame), reach, (&mut *near, &mut *crowd), visit);
        group.len() > 1 && halves.into_iter().all(&mut is_visited)
    }
}

impl Crowd {
    fn new() -> Self {
        Self {
            len: 0,
            keys: [[0; MOST]; 2],
            slots: [0; MOST],
            x: [[0.0; MOST]; 3],
            room: None,
            own: [0; GROUP],
            found: [0; MOST + LANES],
        }
    }

    /// Takes what is near a group, in ascending order of rows, if there is room for it.
    fn take(&mut self, sorted: &Sorted<'_>, near: &Near, square: f32) -> bool {
        let Some(len) = self.collect(sorted, near, square) else { return false };
        let order = sorted.order();
        self.room = match sorted.domain.image_of_all() {
            Image::Nearest(sides) => Some(Room::new(Vec3::ZERO, sides)),
            _ => None,
        };
        for (key, &slot) in self.keys[0].iter_mut().zip(&self.found[..len]) {
            *key = u64::from(order[slot as usize]) << 32 | u64::from(slot);
        }
        let keys = put_in_order(&mut self.keys, len, sorted.rows);
        for (at, key) in keys.iter().enumerate() {
            let slot = *key as u32;
            let place = sorted.point(slot as usize);
            self.slots[at] = slot;
            (self.x[0][at], self.x[1][at], self.x[2][at]) = (place.x, place.y, place.z);
            if let Some(own) = self.own.get_mut((slot as usize).wrapping_sub(near.group.start)) {
                *own = at;
            }
        }
        // Nobody is near what is not a number.
        self.x[0][len..len.next_multiple_of(LANES)].fill(f32::NAN);
        self.len = len;
        true
    }

    /// Finds the slots of what is within a distance of the box around a group, and says how many they are.
    fn collect(&mut self, sorted: &Sorted<'_>, near: &Near, square: f32) -> Option<usize> {
        let [low, high] = sorted.bounds(near.group.clone()).map(lanes::splat);
        let (square, mut len, mut fits) = (f32x8::splat(square), 0, true);
        // As rounding keeps order, no point of the group is nearer than that.
        let to_box = |x: [f32x8; 3]| {
            let gap = |axis: usize| (low[axis] - x[axis]).fast_max(x[axis] - high[axis]).fast_max(f32x8::ZERO);
            let [x, y, z] = [gap(0), gap(1), gap(2)];
            x * x + y * y + z * z
        };
        for (run, moved) in near.runs() {
            let moved = lanes::splat(moved);
            let to_box = |x: [f32x8; 3]| to_box([x[0] + moved[0], x[1] + moved[1], x[2] + moved[2]]);
            sorted.blocks_with(&run, to_box, &mut |slot, left, squares| {
                let hits = squares.simd_le(square).to_bitmask() & ((1 << left) - 1);
                fits &= put_hits(&mut self.found, &mut len, hits, slot as u32);
            });
        }
        (fits && len <= MOST).then_some(len)
    }

    /// Visits each point of the group with those within a distance.
    fn visit(&mut self, sorted: &Sorted<'_>, group: Range<usize>, square: f32, visit: &mut dyn FnMut(usize, &[u32])) {
        for (i, slot) in group.enumerate() {
            let center = sorted.point(slot);
            // It is none of its own neighbours.
            self.x[0][self.own[i]] = f32::NAN;
            let len = lanes::run(Find { crowd: self, center, square });
            self.x[0][self.own[i]] = center.x;
            visit(slot, &self.found[..len]);
        }
    }
}

/// Finds the slots of those of a crowd that are within a distance of a place, and says how many they are.
struct Find<'c> {
    crowd: &'c mut Crowd,
    center: Vec3,
    square: f32,
}

impl Kernel for Find<'_> {
    type Output = usize;
    #[inline(always)]
    fn run<F: Eight>(self, like: F) -> usize {
        let Self { crowd, center, square } = self;
        let [x, y, z] = [0, 1, 2].map(|axis| crowd.x[axis].as_chunks::<LANES>().0);
        let (center, square) = ([like.all(center.x), like.all(center.y), like.all(center.z)], like.all(square));
        let sides = crowd.room.as_ref().map(|room| room.side_by_side(like));
        let (mut first, mut len) = (0, 0);
        for ((x, y), z) in x.iter().zip(y).zip(z).take(crowd.len.div_ceil(LANES)) {
            let ways = [like.of(*x) - center[0], like.of(*y) - center[1], like.of(*z) - center[2]];
            let [x, y, z] = sides.map_or(
                ways,
                #[inline(always)]
                |sides| sides.nearest(ways),
            );
            let hits = (x * x + y * y + z * z).simd_le(square).to_bitmask();
            put_hits(&mut crowd.found, &mut len, hits, first);
            first += LANES as u32;
        }
        crowd.found[..len].iter_mut().for_each(|found| *found = crowd.slots[*found as usize % MOST]);
        len
    }
}

/// Appends the numbers of those of eight that are hits; false if there is no room.
#[inline(always)]
fn put_hits(found: &mut [u32], len: &mut usize, hits: u32, first: u32) -> bool {
    let Some(free) = found.get_mut(*len..).and_then(<[u32]>::first_chunk_mut::<LANES>) else { return false };
    let hits = hits as usize % HITS.len();
    // Eight are written, and those that are no hits are written over.
    *free = HITS[hits].map(|lane| first + lane);
    *len += usize::from(COUNTS[hits]);
    true
}

/// Tells whether all that is within reach of a group of points is met in one image only.
fn is_met_once(sorted: &Sorted<'_>, group: &Range<usize>, reach: Reach) -> bool {
    let half = sorted.domain.half();
    half == f32::INFINITY || {
        let [low, high] = sorted.bounds(group.clone());
        largest(high - low) + reach.radius < 0.99 * half
    }
}

/// Puts the first so many keys in ascending order of their upper halves, digit by digit, the lowest first.
fn put_in_order(keys: &mut [[u64; MOST]; 2], len: usize, rows: usize) -> &[u64] {
    let [mut from, mut to] = keys.each_mut().map(|keys| &mut keys[..len]);
    let bits = (usize::BITS - rows.leading_zeros()) as usize;
    // As few digits as are enough, and these no longer than they have to be.
    let width = bits.div_ceil(bits.div_ceil(DIGIT).max(1));
    for shift in (0..bits).step_by(width.max(1)) {
        let digit = |key: u64| ((key >> (32 + shift)) as usize % (1 << DIGIT)) & ((1 << width) - 1);
        let mut next = [0_u16; 1 << DIGIT];
        from.iter().for_each(|&key| next[digit(key)] += 1);
        let mut sum = 0;
        for next in &mut next[..1 << width] {
            sum += core::mem::replace(next, sum);
        }
        for &key in &*from {
            let next = &mut next[digit(key)];
            to[usize::from(*next)] = key;
            *next += 1;
        }
        core::mem::swap(&mut from, &mut to);
    }
    from
}
