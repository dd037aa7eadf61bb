//! The sorted copy of the points that every structure answers from, and the loops over it.

use super::domain::{Domain, Image, around};
use super::nearest::Nearest;
use core::ops::Range;
use glam::Vec3;
use wide::{f32x8, i32x8};

pub(super) use crate::lanes::LANES;

/// Rows that can be told apart: they are words, and the last one stands for none.
const ROWS: usize = u32::MAX as usize;

/// A point with its row.
#[derive(Clone, Copy, Debug, Default, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub struct Entry {
    pub(super) x: [f32; 3],
    pub(super) row: u32,
}

/// The points in the structure's order, coordinate by coordinate.
#[derive(Debug)]
pub(super) struct Sorted<'m> {
    /// x, y and z by slot, with `LANES` words of slack behind each.
    columns: [&'m mut [f32]; 3],
    /// Four words a point and `LANES` of slack: entries while sorting, rows by slot afterwards.
    work: &'m mut [u32],
    pub(super) len: usize,
    /// Rows that the index was built from, and those left out.
    pub(super) rows: usize,
    /// The box around all points.
    pub(super) low: Vec3,
    pub(super) high: Vec3,
    pub(super) domain: Domain,
}

impl<'m> Sorted<'m> {
    /// Words for so many points.
    pub(super) const fn words(points: usize) -> usize {
        points.saturating_mul(7).saturating_add(4 * LANES)
    }

    /// Points for which there is room in so many words.
    pub(super) fn capacity_of(words: usize) -> usize {
        words.saturating_sub(4 * LANES) / 7
    }

    /// Room for so many points, in the first words of `memory`; returns the rest of it.
    pub(super) fn new(memory: &'m mut [u32], capacity: usize, domain: Domain) -> (Self, &'m mut [u32]) {
        let mut rest = memory;
        let mut take = |words: usize| {
            let (taken, left) = core::mem::take(&mut rest).split_at_mut_checked(words).unwrap_or_default();
            rest = left;
            taken
        };
        let columns = core::array::from_fn(|_| bytemuck::cast_slice_mut(take(capacity + LANES)));
        let work = take(4 * capacity + LANES);
        (Self { columns, work, len: 0, rows: 0, low: Vec3::ZERO, high: Vec3::ZERO, domain }, rest)
    }

    /// The number of points that fit.
    pub(super) fn capacity(&self) -> usize {
        self.work.len().saturating_sub(LANES) / 4
    }

    /// Room for entries, unsorted.
    pub(super) fn entries(&mut self) -> &mut [Entry] {
        bytemuck::cast_slice_mut(self.work)
    }

    /// Sees how many points are finite and where they are; an error if there are too many.
    pub(super) fn survey(&mut self, points: &[Vec3]) -> Result<(), super::TooSmall> {
        (self.len, self.rows, self.low, self.high) = (0, 0, Vec3::ZERO, Vec3::ZERO);
        let room = self.capacity().min(ROWS);
        if points.len() > ROWS {
            return Err(super::TooSmall { points: points.len(), room });
        }
        self.domain.fit(points);
        let (domain, mut len) = (self.domain, 0);
        let [low, high] = around(points.iter().filter(|point| point.is_finite()).map(|point| {
            len += 1;
            domain.place(*point)
        }));
        if len > room {
            return Err(super::TooSmall { points: len, room });
        }
        (self.len, self.rows) = (len, points.len());
        if len > 0 {
            (self.low, self.high) = (low, high);
        }
        Ok(())
    }

    /// Takes the finite points in as entries.
    pub(super) fn take(&mut self, points: &[Vec3]) -> Result<(), super::TooSmall> {
        self.survey(points)?;
        let domain = self.domain;
        let sound = points.iter().enumerate().filter(|(_, point)| point.is_finite());
        for (entry, (row, point)) in self.entries().iter_mut().zip(sound) {
            *entry = Entry { x: domain.place(*point).to_array(), row: row as u32 };
        }
        Ok(())
    }

    /// Spreads the entries, sorted by now, over the columns.
    pub(super) fn spread(&mut self) {
        for slot in 0..self.len {
            let Entry { x, row } = bytemuck::cast_slice::<u32, Entry>(self.work)[slot];
            for (column, x) in self.columns.iter_mut().zip(x) {
                column[slot] = x;
            }
            self.work[slot] = row;
        }
    }

    /// Takes the points' places anew, each into the slot it has. False if they have to be sorted in anew: they are not
    /// the same points, or need another scale.
    pub(super) fn follow(&mut self, points: &[Vec3]) -> bool {
        let mut next = self.domain;
        next.fit(points);
        let sound = || points.iter().filter(|point| point.is_finite());
        if points.len() != self.rows || next != self.domain || sound().count() != self.len {
            return false;
        }
        let mut sound = true;
        let [low, high] = around((0..self.len).map(|slot| {
            let point = points[self.work[slot] as usize];
            sound &= point.is_finite();
            let point = self.domain.place(point);
            self.set(slot, point);
            point
        }));
        if self.len > 0 {
            (self.low, self.high) = (low, high);
        }
        sound
    }

    /// Puts a point into a slot.
    #[inline(always)]
    pub(super) fn set(&mut self, slot: usize, point: Vec3) {
        for (column, x) in self.columns.iter_mut().zip(point.to_array()) {
            column[slot] = x;
        }
    }

    /// Puts a row into a slot.
    #[inline(always)]
    pub(super) fn put(&mut self, slot: usize, point: Vec3, row: u32) {
        self.set(slot, point);
        self.work[slot] = row;
    }

    /// A word of those to work with.
    #[inline(always)]
    pub(super) fn scratch(&self, i: usize) -> u32 {
        self.work[self.columns[0].len() + i]
    }

    /// The rows, and words to work with.
    pub(super) fn rows_and_scratch(&mut self) -> (&mut [u32], &mut [u32]) {
        let (rows, scratch) = self.work.split_at_mut(self.columns[0].len());
        (&mut rows[..self.len], scratch)
    }

    pub(super) fn stats(&self) -> super::Stats {
        let bytes = 4 * Self::words(self.len);
        super::Stats { points: self.len, skipped: self.rows - self.len, bytes, ..super::Stats::default() }
    }

    pub(super) fn order(&self) -> &[u32] {
        &self.work[..self.len]
    }

    #[inline(always)]
    pub(super) fn point(&self, slot: usize) -> Vec3 {
        Vec3::new(self.columns[0][slot], self.columns[1][slot], self.columns[2][slot])
    }

    /// The coordinates of some slots.
    #[inline(always)]
    pub(super) fn run(&self, slots: &Range<usize>) -> [&[f32]; 3] {
        core::array::from_fn(|axis| &self.columns[axis][slots.clone()])
    }

    /// The box around some slots.
    pub(super) fn bounds(&self, slots: Range<usize>) -> [Vec3; 2] {
        let side = |column: &[f32]| {
            let (mut low, mut high) = (f32::INFINITY, f32::NEG_INFINITY);
            for &x in &column[slots.clone()] {
                low = if x < low { x } else { low };
                high = if x > high { x } else { high };
            }
            [low, high]
        };
        let [x, y, z] = [side(self.columns[0]), side(self.columns[1]), side(self.columns[2])];
        [Vec3::new(x[0], y[0], z[0]), Vec3::new(x[1], y[1], z[1])]
    }

    /// Squared distances of the probe to the points of a run, eight at a time: `each` gets the first slot, how many of
    /// the eight belong to the run, and the squares.
    #[inline(always)]
    fn blocks(&self, run: &Range<usize>, probe: &Probe, mut each: impl FnMut(usize, usize, f32x8)) {
        match probe.image {
            Image::Itself => self.blocks_with(run, |x| probe.squares(x), &mut each),
            Image::Moved(by) => self.blocks_with(run, |x| probe.squares_moved(x, by), &mut each),
            Image::Nearest(sides) => self.blocks_with(run, |x| probe.squares_nearest(x, sides), &mut each),
        }
    }

    /// The same by squares of distances to anything.
    #[inline(always)]
    pub(super) fn blocks_with(
        &self,
        run: &Range<usize>,
        squares: impl Fn([f32x8; 3]) -> f32x8,
        each: &mut impl FnMut(usize, usize, f32x8),
    ) {
        let whole = run.len() / LANES * LANES;
        let blocks = |axis: usize| self.columns[axis][run.start..run.start + whole].as_chunks::<LANES>().0;
        let mut slot = run.start;
        for ((x, y), z) in blocks(0).iter().zip(blocks(1)).zip(blocks(2)) {
            each(slot, LANES, squares([f32x8::new(*x), f32x8::new(*y), f32x8::new(*z)]));
            slot += LANES;
        }
        if slot < run.end {
            // The slack behind the columns lets the last block reach beyond the last point.
            let last = |axis: usize| f32x8::new(*self.columns[axis][slot..].first_chunk().unwrap_or(&[0.0; LANES]));
            each(slot, run.end - slot, squares([last(0), last(1), last(2)]));
        }
    }

    /// Counts the points of a run that are within the probe's radius.
    #[inline(always)]
    pub(super) fn count(&self, run: &Range<usize>, probe: &Probe, counter: &mut Counter) {
        self.blocks(run, probe, |_, left, square| {
            let hits = square.simd_le(probe.square);
            let hits = if left < LANES { hits & FIRST[left] } else { hits };
            counter.0 -= bytemuck::cast::<f32x8, i32x8>(hits);
        });
    }

    /// Appends the rows of a run that are within the probe's radius to `found`, which hands them over when it is full.
    /// One slot is left out.
    #[inline(always)]
    pub(super) fn gather(
        &self,
        run: &Range<usize>,
        probe: &Probe,
        except: usize,
        found: &mut Found,
        mut hand_over: impl FnMut(&[u32]),
    ) {
        let mut len = found.len;
        self.blocks(run, probe, |slot, left, square| {
            let hits = square.simd_le(probe.square).to_bitmask();
            let hits = if left < LANES { hits & ((1 << left) - 1) } else { hits };
            let hits = hits & !(1 << except.wrapping_sub(slot).min(31));
            if len > found.rows.len() - LANES {
                found.len = len;
                found.flush(&mut hand_over);
                len = 0;
            }
            let rows: Option<&[u32; LANES]> = self.work[slot..].first_chunk();
            let free: Option<&mut [u32; LANES]> = found.rows[len..].first_chunk_mut();
            if let (Some(rows), Some(free)) = (rows, free) {
                // Every lane is written, and the next one over it unless it was a hit: no branch to mispredict.
                let mut n = 0;
                for (lane, row) in rows.iter().enumerate() {
                    free[n % LANES] = *row;
                    n += (hits >> lane & 1) as usize;
                }
                len += n;
            }
        });
        found.len = len;
    }

    /// Offers the points of a run to a list of the nearest.
    #[inline(always)]
    pub(super) fn offer(&self, run: &Range<usize>, probe: &Probe, nearest: &mut Nearest<'_>) {
        self.blocks(run, probe, |slot, left, square| {
            let mut hits = square.simd_le(f32x8::splat(nearest.bound())).to_bitmask() & ((1 << left) - 1);
            let square = square.to_array();
            while hits != 0 {
                let lane = hits.trailing_zeros() as usize;
                nearest.offer(self.work[slot + lane], square[lane]);
                hits &= hits - 1;
            }
        });
    }
}

/// The first n lanes of a block.
const FIRST: [f32x8; LANES + 1] = {
    let mut masks = [[0.0; LANES]; LANES + 1];
    let mut n = 0;
    while n <= LANES {
        let mut lane = 0;
        while lane < n {
            masks[n][lane] = f32::from_bits(u32::MAX);
            lane += 1;
        }
        n += 1;
    }
    let [a, b, c, d, e, f, g, h, i] = masks;
    [
        f32x8::new(a),
        f32x8::new(b),
        f32x8::new(c),
        f32x8::new(d),
        f32x8::new(e),
        f32x8::new(f),
        f32x8::new(g),
        f32x8::new(h),
        f32x8::new(i),
    ]
};

/// The number of points found, lane by lane.
#[derive(Clone, Copy, Default)]
pub(super) struct Counter(i32x8);

impl Counter {
    #[inline(always)]
    pub(super) fn total(self) -> u32 {
        self.0.to_array().iter().map(|&lane| lane as u32).sum()
    }
}

/// Rows on their way to who asked for them.
pub(super) struct Found {
    rows: [u32; 128],
    len: usize,
    pub(super) total: u64,
}

impl Default for Found {
    fn default() -> Self {
        Self { rows: [0; 128], len: 0, total: 0 }
    }
}

impl Found {
    /// Hands over what there is.
    pub(super) fn flush(&mut self, mut hand_over: impl FnMut(&[u32])) {
        if self.len > 0 {
            self.total += self.len as u64;
            hand_over(&self.rows[..self.len]);
            self.len = 0;
        }
    }
}

/// A place and a radius to hold points against.
#[derive(Clone, Copy)]
pub(super) struct Probe {
    center: [f32x8; 3],
    image: Image,
    pub(super) square: f32x8,
}

impl Probe {
    #[inline(always)]
    pub(super) fn new(center: Vec3, image: Image, square: f32) -> Self {
        Self { center: center.to_array().map(f32x8::splat), image, square: f32x8::splat(square) }
    }

    /// The same for another image of the points.
    #[inline(always)]
    pub(super) fn of(self, image: Image) -> Self {
        Self { image, ..self }
    }

    /// d² of eight points.
    #[inline(always)]
    fn squares(&self, [x, y, z]: [f32x8; 3]) -> f32x8 {
        square([x - self.center[0], y - self.center[1], z - self.center[2]])
    }

    /// d² of eight points, moved.
    #[inline(always)]
    fn squares_moved(&self, at: [f32x8; 3], by: Vec3) -> f32x8 {
        square(core::array::from_fn(|axis| at[axis] - self.center[axis] + f32x8::splat(by[axis])))
    }

    /// d² of eight points, each in the image that is nearest.
    #[inline(always)]
    fn squares_nearest(&self, at: [f32x8; 3], sides: Vec3) -> f32x8 {
        square(core::array::from_fn(|axis| {
            let (side, whole, half) =
                (at[axis] - self.center[axis], f32x8::splat(sides[axis]), f32x8::splat(sides[axis] * 0.5));
            side - (side.simd_gt(half) & whole) + (side.simd_le(-half) & whole)
        }))
    }
}

#[inline(always)]
fn square([x, y, z]: [f32x8; 3]) -> f32x8 {
    x * x + y * y + z * z
}
