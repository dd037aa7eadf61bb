//! Boxes by the cells of a grid that they reach into: what a small box meets is told by a few lists.

use super::{Aabb, Few};
use alloc::vec;
use alloc::vec::Vec;
use core::ops::Range;
use glam::Vec3;
use wide::f32x4;

/// Cells for each box, at the most.
const CELLS: usize = 16;

/// Places in the lists for each box, at the most.
const ENTRIES: usize = 16;

/// Cells along an axis, at the most: so few that their product has room in a number.
const MOST: u32 = 1 << 10;

/// Cells that a box is looked for in, at the most: larger ones are better asked for in a tree.
const LOOKS: u32 = 12;

/// The numbers of those that meet a box, in their order.
pub(super) type Found = heapless::Vec<u32, 16>;

/// A grid around boxes.
#[derive(Clone, Debug, Default)]
pub(super) struct Cells {
    origin: Vec3,
    /// Cells to a metre, and how many there are along each axis.
    scale: f32,
    counts: [u32; 3],
    /// The last one's number along each axis.
    last: Vec3,
    /// Where each cell's list begins in the numbers of all, and where the last one ends.
    starts: Vec<u32>,
    numbers: Vec<u32>,
}

impl Cells {
    /// The boxes of a list that `are_in` says, which are all in another. Takes time in proportion to their number.
    pub(super) fn new(boxes: &[Aabb], all: &Aabb, are_in: &dyn Fn(usize) -> bool) -> Self {
        let numbers: Vec<u32> = (0..boxes.len()).filter(|&i| are_in(i)).filter_map(|i| u32::try_from(i).ok()).collect();
        if numbers.is_empty() {
            return Self::default();
        }
        let mut side = (all.max - all.min).max_element();
        let mut cells = Self::divided(all, side);
        // As fine as there is use for.
        for _ in 0..16 {
            side *= 0.5;
            let finer = Self::divided(all, side);
            let entries: usize = numbers.iter().map(|&i| finer.range(&boxes[i as usize]).len() as usize).sum();
            if finer.len() > CELLS * numbers.len() || entries > ENTRIES * numbers.len() {
                break;
            }
            cells = finer;
        }
        cells.fill(boxes, &numbers);
        cells
    }

    fn divided(all: &Aabb, side: f32) -> Self {
        let extent = all.max - all.min;
        let is_divisible = extent.is_finite() && side > 0.0 && (1.0 / side).is_finite();
        let scale = if is_divisible { 1.0 / side } else { 0.0 };
        let counts = [0, 1, 2].map(|axis| ((extent[axis] * scale) as u32).min(MOST - 1) + 1);
        let last = Vec3::from_array(counts.map(|count| (count - 1) as f32));
        Self { origin: all.min, scale, counts, last, ..Self::default() }
    }

    fn len(&self) -> usize {
        self.counts.iter().fold(1, |all, &count| all.saturating_mul(count as usize))
    }

    fn fill(&mut self, boxes: &[Aabb], numbers: &[u32]) {
        let mut ends = vec![0; self.len() + 1];
        for &number in numbers {
            self.range(&boxes[number as usize]).visit(self.counts, |cell| ends[cell + 1] += 1);
        }
        (1..ends.len()).for_each(|cell| ends[cell] += ends[cell - 1]);
        self.starts.clone_from(&ends);
        self.numbers = vec![0; ends.last().map_or(0, |&end: &u32| end as usize)];
        for &number in numbers {
            self.range(&boxes[number as usize]).visit(self.counts, |cell| {
                self.numbers[ends[cell] as usize] = number;
                ends[cell] += 1;
            });
        }
    }

    /// The cells that a box reaches into: rounding keeps coordinates in order, and so none is missed.
    #[inline]
    fn range(&self, bounds: &Aabb) -> CellRange {
        let four = |v: Vec3| f32x4::new([v.x, v.y, v.z, 0.0]);
        let (origin, last) = (four(self.origin), four(self.last));
        let cells = |corner: Vec3| {
            let cell = (four(corner) - origin) * self.scale;
            // Counts have room in 24 bits; what is no number is in some cell.
            let [x, y, z, _] = cell.fast_max(f32x4::ZERO).fast_min(last).fast_trunc_int().to_array();
            let [columns, rows, layers] = self.counts;
            [(x as u32).min(columns - 1), (y as u32).min(rows - 1), (z as u32).min(layers - 1)]
        };
        CellRange { first: cells(bounds.min), last: cells(bounds.max) }
    }

    /// Those of the boxes that meet another; several, if they are too far apart.
    #[inline]
    pub(super) fn few(&self, boxes: &[Aabb], bounds: &Aabb) -> Few {
        if self.starts.is_empty() {
            return Few::Nothing;
        }
        let range = self.range(bounds);
        if range.len() > LOOKS {
            return Few::Several;
        }
        let mut few = Few::Nothing;
        range.lines(self.counts, |cells| {
            for &number in self.numbers_in(cells) {
                if boxes.get(number as usize).is_some_and(|one| meet(one, bounds)) {
                    few = few.and(number as usize);
                }
            }
        });
        few
    }

    /// The numbers in the lists of cells side by side, which follow one another.
    #[inline]
    fn numbers_in(&self, cells: Range<u32>) -> &[u32] {
        let ends = [self.starts.get(cells.start as usize), self.starts.get(cells.end as usize)];
        let [Some(&start), Some(&end)] = ends else { return &[] };
        self.numbers.get(start as usize..end as usize).unwrap_or_default()
    }

    /// Adds those that meet a box to the numbers in `found`; false, if they may be more than there is room for, or are too far apart.
    #[inline]
    pub(super) fn near(&self, boxes: &[Aabb], bounds: &Aabb, found: &mut Found) -> bool {
        if self.starts.is_empty() {
            return true;
        }
        let range = self.range(bounds);
        if range.len() > LOOKS {
            return false;
        }
        let mut has_room = true;
        range.lines(self.counts, |cells| {
            for &number in self.numbers_in(cells) {
                if boxes.get(number as usize).is_some_and(|one| meet(one, bounds)) {
                    has_room &= insert(found, number);
                }
            }
        });
        has_room
    }
}

/// Cells from one to another along each axis.
struct CellRange {
    first: [u32; 3],
    last: [u32; 3],
}

impl CellRange {
    #[inline]
    fn len(&self) -> u32 {
        let count = |axis: usize| self.last[axis].saturating_sub(self.first[axis]) + 1;
        count(0) * count(1) * count(2)
    }

    /// Visits the cells, those side by side together.
    #[inline(always)]
    fn lines(&self, [columns, rows, _]: [u32; 3], mut visit: impl FnMut(Range<u32>)) {
        for z in self.first[2]..self.last[2] + 1 {
            for y in self.first[1]..self.last[1] + 1 {
                let line = columns * (rows * z + y);
                visit(line + self.first[0]..line + self.last[0] + 1);
            }
        }
    }

    #[inline]
    fn visit(&self, counts: [u32; 3], mut visit: impl FnMut(usize)) {
        self.lines(counts, |cells| cells.for_each(|cell| visit(cell as usize)));
    }
}

/// Tells whether two boxes share a point.
#[inline]
pub(super) fn meet(a: &Aabb, b: &Aabb) -> bool {
    let meets = |axis: usize| (a.min[axis] <= b.max[axis]) & (a.max[axis] >= b.min[axis]);
    meets(0) & meets(1) & meets(2)
}

/// Puts a number in its place, unless it is there already; false, if there is no room.
#[inline]
pub(super) fn insert(found: &mut Found, number: u32) -> bool {
    if found.last().is_none_or(|&last| last < number) {
        return found.push(number).is_ok();
    }
    let place = found.iter().position(|&other| other >= number).unwrap_or(found.len());
    found.get(place) == Some(&number) || found.insert(place, number).is_ok()
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::rng::Stream;

    /// The `i`-th of the `k`-th random vectors, in a cube of side 1 about the origin.
    pub(in crate::shape) fn vector(i: u32, k: u64) -> Vec3 {
        let ([x, y], [z, _]) = (Stream::new(k, 0, i).units(0), Stream::new(k, 1, i).units(0));
        Vec3::new(x, y, z) - 0.5
    }

    fn around(middle: Vec3, half: Vec3) -> Aabb {
        Aabb { min: middle - half.abs(), max: middle + half.abs() }
    }

    /// How many boxes, how large, and how they are spread: one, some that overlap, and many that are small, in a slab.
    pub(in crate::shape) const SPREADS: [(u32, f32, Vec3); 3] =
        [(1, 0.1, Vec3::ONE), (40, 0.3, Vec3::ONE), (300, 0.02, Vec3::new(8.0, 0.1, 5.0))];

    /// So many boxes, and the one around all.
    pub(in crate::shape) fn spread((count, size, shape): (u32, f32, Vec3)) -> (Vec<Aabb>, Aabb) {
        let boxes = (0..count).map(|i| around(vector(i, 1) * shape + 30.0, vector(i, 2) * size));
        let boxes: Vec<Aabb> = boxes.collect();
        let all = boxes.iter().fold(Aabb::EMPTY, |all, one| all.join(*one));
        (boxes, all)
    }

    #[test]
    fn whatever_meets_a_box_is_found() {
        for (count, size, shape) in SPREADS {
            let (boxes, all) = spread((count, size, shape));
            let cells = Cells::new(&boxes, &all, &|i| i != 7);
            assert!(cells.len() <= CELLS * boxes.len());
            let mut told = 0;
            for i in 0..500 {
                let bounds = around(vector(i, 3) * shape + 30.0, vector(i, 4) * 0.1);
                let mut found = Found::new();
                if !cells.near(&boxes, &bounds, &mut found) {
                    continue;
                }
                told += 1;
                let met = (0..boxes.len()).filter(|&k| k != 7 && meet(&boxes[k], &bounds));
                let few = match *met.clone().collect::<Vec<_>>() {
                    [] => Few::Nothing,
                    [number] => Few::One(number),
                    [one, other] => Few::Two([one, other]),
                    _ => Few::Several,
                };
                assert_eq!(cells.few(&boxes, &bounds), few, "{i}");
                assert!(met.eq(found.iter().map(|&number| number as usize)), "{i}");
            }
            assert!(told > 400, "{told}");
        }
    }
}
