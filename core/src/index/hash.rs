//! Cells of one size in all of space, found by hashing.

use super::cells::{self, sort_by_cell};
use super::domain::{Domain, Image, constructors};
use super::grid::Layout;
use super::partition::Partition;
use super::region::{Region, Run, widened};
use super::search::{Search, answers};
use super::sorted::Sorted;
use super::{Cost, Facts, Neighbour, SpatialIndex, Stats, TooSmall};
use crate::math::{floor, largest, max, min};
use core::ops::Range;
use glam::Vec3;

/// A hashed grid (Teschner et al. 2003): memory by the number of points, however far apart they are.
///
/// Only y and z are hashed, x is added: cells that follow each other along x are neighbours in memory, as in the grid.
/// Cells that share a bucket cost time, nothing else. A radius of more than five times the reach the index was built with
/// looks at every point, and so does the search for the nearest where they are so far away.
#[derive(Debug)]
pub struct Hash<'m> {
    sorted: Sorted<'m>,
    /// Where each bucket begins, and one more.
    starts: &'m mut [u32],
    reach: f32,
    buckets: Buckets,
}

/// Which bucket a point goes into.
#[derive(Clone, Copy, Debug, Default)]
struct Buckets {
    /// A power of two, or zero.
    len: usize,
    cell: f32,
    inverse: f32,
}

/// Tells its facts from those of other structures.
const NAME: u32 = u32::from_le_bytes(*b"hash");

/// Rows of cells that a query can tell apart; if it needs more, it looks at everything.
const ROWS: usize = 128;

impl<'m> Hash<'m> {
    constructors!();

    fn in_domain(memory: &'m mut [u32], domain: Domain) -> Self {
        let (sorted, starts) = cells::divide(memory, domain);
        Self { sorted, starts, reach: 0.0, buckets: Buckets::default() }
    }
}

impl Buckets {
    /// Which cell along an axis: never falls as the coordinate grows.
    #[inline(always)]
    fn along(&self, x: f32) -> i32 {
        floor(x * self.inverse) as i32
    }

    /// The bucket of a row's cell at x = 0.
    #[inline(always)]
    fn row(y: i32, z: i32) -> u32 {
        let mixed = (y as u32).wrapping_mul(0x9e37_79b1) ^ (z as u32).wrapping_mul(0x85eb_ca6b);
        (mixed ^ mixed >> 15).wrapping_mul(0x2c1b_3c6d) >> 3
    }

    #[inline(always)]
    fn bucket(&self, point: Vec3) -> usize {
        let row = Self::row(self.along(point.y), self.along(point.z));
        row.wrapping_add(self.along(point.x) as u32) as usize & (self.len - 1)
    }

    /// The buckets of all rows, sorted, without overlaps; none if there are too many.
    fn stretches(
        &self,
        [[x0, x1], [y0, y1], [z0, z1]]: [[i32; 2]; 3],
    ) -> Option<heapless::Vec<[u32; 2], { 2 * ROWS }>> {
        let side = |from: i32, to: i32| i64::from(to) - i64::from(from) + 1;
        let (length, rows) = (side(x0, x1), side(y0, y1).saturating_mul(side(z0, z1)));
        if length >= self.len as i64 || rows > ROWS as i64 {
            return None;
        }
        let mut stretches = heapless::Vec::<[u32; 2], { 2 * ROWS }>::new();
        let last = self.len as u32;
        for z in z0..=z1 {
            for y in y0..=y1 {
                let from = Self::row(y, z).wrapping_add(x0 as u32) & (last - 1);
                let to = from + length as u32;
                let _ = stretches.push([from, to.min(last)]);
                if to > last {
                    let _ = stretches.push([0, to - last]);
                }
            }
        }
        stretches.sort_unstable();
        let mut kept = 0;
        for i in 1..stretches.len() {
            let [from, to] = stretches[i];
            if from <= stretches[kept][1] {
                stretches[kept][1] = stretches[kept][1].max(to);
            } else {
                kept += 1;
                stretches[kept] = [from, to];
            }
        }
        stretches.truncate(kept + 1);
        Some(stretches)
    }
}

impl Partition for Hash<'_> {
    const BOXED: bool = false;

    fn sorted(&self) -> &Sorted<'_> {
        &self.sorted
    }

    /// Buckets, or what of them is of one cell: others can be anywhere.
    fn groups(&self, visit: &mut impl FnMut(Range<usize>, u32)) {
        let starts = self.starts.get(..=self.buckets.len).unwrap_or_default();
        for bucket in starts.windows(2) {
            let mut slots = bucket[0] as usize..bucket[1] as usize;
            if slots.is_empty() {
                continue;
            }
            let [low, high] = self.sorted.bounds(slots.clone());
            if largest(high - low) <= self.buckets.cell {
                visit(slots, 0);
                continue;
            }
            let cell = |slot: usize| self.sorted.point(slot).to_array().map(|x| self.buckets.along(x));
            while let Some(start) = slots.next() {
                let end = (start..slots.end).find(|&slot| cell(slot) != cell(start)).unwrap_or(slots.end);
                visit(start..end, 0);
                slots.start = end;
            }
        }
    }

    #[inline(always)]
    fn near(&self, region: &Region, image: Image, radius: f32, visit: &mut impl FnMut(Run) -> bool) -> u64 {
        let moved = image.moved();
        let mut cells = [[0; 2]; 3];
        for axis in 0..3 {
            let (low, high) = (region.low[axis] - moved[axis], region.high[axis] - moved[axis]);
            let reach = widened(radius, low, high, moved[axis]);
            let low = max(low - reach, self.sorted.low[axis]);
            let high = min(high + reach, self.sorted.high[axis]);
            if !(low <= high) {
                return 0;
            }
            cells[axis] = [self.buckets.along(low), self.buckets.along(high)];
        }
        let all = |slots| Run { slots, low: self.sorted.low, high: self.sorted.high, frame: 0 };
        let Some(stretches) = self.buckets.stretches(cells) else {
            visit(all(0..self.sorted.len));
            return 1;
        };
        let mut visits = 0;
        for [from, to] in stretches {
            let slots = self.starts[from as usize] as usize..self.starts[to as usize] as usize;
            visits += 1;
            if !slots.is_empty() && !visit(all(slots)) {
                break;
            }
        }
        visits
    }

    fn stride(&self) -> f32 {
        self.buckets.cell
    }
}

impl SpatialIndex for Hash<'_> {
    fn build(&mut self, points: &[Vec3], reach: f32) -> Result<(), TooSmall> {
        (self.reach, self.buckets) = (reach, Buckets::default());
        self.sorted.survey(points)?;
        let (sorted, room) = (&mut self.sorted, self.starts.len().saturating_sub(2));
        if sorted.len == 0 {
            return Ok(());
        }
        let cell = match sorted.domain.length(reach) {
            reach if reach > 0.0 => reach * 1.000_01,
            _ => Layout::by_density([sorted.low, sorted.high], sorted.len, room).cell,
        };
        // Not so small that a coordinate's cell is beyond an i32.
        let cell = max(max(cell, max(largest(sorted.low), largest(sorted.high)) * 1e-9), f32::MIN_POSITIVE);
        let len = 1 << sorted.len.next_power_of_two().min(room.max(1)).ilog2();
        let buckets = Buckets { len, cell, inverse: 1.0 / cell };
        sort_by_cell(sorted, &mut self.starts[..len + 2], points, |point| buckets.bucket(point));
        self.buckets = buckets;
        Ok(())
    }

    fn refit(&mut self, points: &[Vec3]) -> Result<(), TooSmall> {
        self.build(points, self.reach)
    }

    fn facts(&self) -> Option<Facts> {
        let Buckets { len, cell, inverse } = self.buckets;
        let [reach, cell, inverse] = [self.reach, cell, inverse].map(f32::to_bits);
        self.sorted.facts(NAME, [reach, cell, inverse, len as u32, 0, 0, 0, 0, 0])
    }

    fn take_up(&mut self, facts: &Facts, points: &[Vec3], row_of: &mut dyn FnMut(u32) -> Option<u32>) -> bool {
        let Some([reach, cell, inverse, len, ..]) = self.sorted.restore(NAME, facts) else { return false };
        let [reach, cell, inverse] = [reach, cell, inverse].map(f32::from_bits);
        (self.reach, self.buckets) = (reach, Buckets { len: len as usize, cell, inverse });
        let starts = self.starts.get_mut(..=self.buckets.len).unwrap_or_default();
        self.sorted.renumber(points, row_of, starts.iter_mut())
    }

    fn stats(&self) -> Stats {
        let counts =
            self.starts.get(..self.buckets.len + 1).unwrap_or_default().windows(2).map(|pair| pair[1] - pair[0]);
        let stats = self.sorted.stats();
        // Two of the words that each point has to be sorted in go unused.
        let bytes = stats.bytes - 8 * stats.points + 4 * self.buckets.len;
        Stats { nodes: self.buckets.len, fullest: counts.max().unwrap_or(0) as usize, bytes, ..stats }
    }

    answers!();
}
