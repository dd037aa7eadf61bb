//! The nearest points found so far: as many as there is room for.

use crate::math::sqrt;

/// A point that was found.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct Neighbour {
    /// Its row.
    pub row: u32,
    /// How far it is \[m\].
    pub distance: f32,
}

/// While it is filled, the distances are squares.
#[derive(Debug)]
pub(super) struct Nearest<'a> {
    found: &'a mut [Neighbour],
    len: usize,
    bound: f32,
    /// A row that is not wanted.
    pub(super) skip: u32,
}

impl Neighbour {
    const NONE: Self = Self { row: u32::MAX, distance: f32::INFINITY };

    /// Orders by distance, and equally far ones by row: the bits of floats from zero up are ordered as they are.
    #[inline(always)]
    fn key(self) -> u64 {
        u64::from(self.distance.to_bits()) << 32 | u64::from(self.row)
    }

    #[inline(always)]
    fn of_key(key: u64) -> Self {
        Self { row: key as u32, distance: f32::from_bits((key >> 32) as u32) }
    }
}

/// Up to so many are kept sorted; more are kept as a heap, the farthest on top.
const FEW: usize = 24;

impl<'a> Nearest<'a> {
    /// None yet.
    pub(super) fn new(found: &'a mut [Neighbour]) -> Self {
        Self { found, len: 0, bound: -1.0, skip: u32::MAX }
    }

    /// Forgets what was found, and from now on takes none farther than the root of `bound`.
    pub(super) fn restart(&mut self, bound: f32) {
        self.bound = if self.found.is_empty() { -1.0 } else { bound };
        self.len = 0;
        if self.found.len() <= FEW {
            self.found.fill(Neighbour::NONE);
        }
    }

    /// The largest square that is still of interest.
    #[inline(always)]
    pub(super) fn bound(&self) -> f32 {
        self.bound
    }

    pub(super) fn is_full(&self) -> bool {
        self.len == self.found.len()
    }

    /// Takes a point in if it is one of the nearest so far; its square is within the bound.
    #[inline]
    pub(super) fn offer(&mut self, row: u32, square: f32) {
        if row == self.skip {
            return;
        }
        let new = Neighbour { row, distance: square }.key();
        let farthest = if self.found.len() <= FEW { self.insert(new) } else { self.heap(new) };
        if self.is_full() && farthest < self.bound {
            self.bound = farthest;
        }
    }

    /// Moves all that are farther up by one: whatever the order, the same instructions. Returns the farthest.
    #[inline]
    fn insert(&mut self, new: u64) -> f32 {
        self.len = (self.len + 1).min(self.found.len());
        let mut new = new;
        for place in self.found.iter_mut() {
            let old = place.key();
            *place = Neighbour::of_key(old.min(new));
            new = old.max(new);
        }
        self.found[self.found.len() - 1].distance
    }

    /// Adds it below what is farther, or lets it take the place of the farthest. Returns the farthest.
    fn heap(&mut self, new: u64) -> f32 {
        if self.len < self.found.len() {
            let mut at = self.len;
            self.len += 1;
            while at > 0 && new > self.found[(at - 1) / 2].key() {
                self.found[at] = self.found[(at - 1) / 2];
                at = (at - 1) / 2;
            }
            self.found[at] = Neighbour::of_key(new);
        } else if new < self.found[0].key() {
            self.sink(new);
        }
        self.found[0].distance
    }

    /// Replaces the top and moves down.
    fn sink(&mut self, new: u64) {
        let heap = &mut *self.found;
        let mut at = 0;
        while let Some(left) = heap.get(2 * at + 1) {
            let right = heap.get(2 * at + 2).map_or(0, |right| right.key());
            let (child, farthest) = if right > left.key() { (2 * at + 2, right) } else { (2 * at + 1, left.key()) };
            if farthest < new {
                break;
            }
            heap[at] = Neighbour::of_key(farthest);
            at = child;
        }
        heap[at] = Neighbour::of_key(new);
    }

    /// Sorts those found, puts distances in the place of squares, and returns their number.
    pub(super) fn finish(self, length: impl Fn(f32) -> f32) -> usize {
        let sorted = self.found.len() <= FEW;
        let found = &mut self.found[..self.len];
        if !sorted {
            found.sort_unstable_by_key(|neighbour| neighbour.key());
        }
        for neighbour in found {
            neighbour.distance = length(sqrt(neighbour.distance));
        }
        self.len
    }
}
