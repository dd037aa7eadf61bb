//! The bounding-volume hierarchy: every node is cut where the boxes of both parts become small.

use super::frames::Frames;
use super::kd::longest;
use super::sorted::Entry;
use super::split::{CHILDREN, Split, partition};
use super::tree::Tree;
use crate::math;
use glam::Vec3;

/// A hierarchy of boxes split by the surface area heuristic (Goldsmith and Salmon 1987) over bins (Wald 2007).
pub type Bvh<'m> = Tree<'m, Areas>;

/// Splits the longest side where areas times numbers of points are least.
#[derive(Clone, Copy, Debug, Default)]
pub struct Areas;

/// Places where a node may be cut, and one more.
const BINS: usize = 8;

/// Some points' box and number.
#[derive(Clone, Copy)]
struct Bin {
    low: Vec3,
    high: Vec3,
    len: usize,
}

impl Bin {
    const EMPTY: Self = Self { low: Vec3::splat(f32::INFINITY), high: Vec3::splat(f32::NEG_INFINITY), len: 0 };

    fn with(self, other: Self) -> Self {
        let (low, high) = (math::low(other.low, self.low), math::high(other.high, self.high));
        Self { low, high, len: self.len + other.len }
    }

    /// The cost of a query, but for a factor: how likely it meets the box, times the number of points that it finds
    /// there.
    fn cost(&self) -> f32 {
        if self.len == 0 {
            return 0.0;
        }
        let side = self.high - self.low;
        (side.x * side.y + side.y * side.z + side.z * side.x) * self.len as f32
    }
}

impl Split for Areas {
    const LEAF: usize = 16;
    const BYTES: usize = 8;
    type Cell = ();

    fn root(&mut self, _: Vec3, _: Vec3) {}

    fn split(
        &self,
        (): (),
        [low, high]: [Vec3; 2],
        entries: &mut [Entry],
        _: &Frames<'_>,
        children: &mut heapless::Vec<(usize, ()), CHILDREN>,
    ) {
        let axis = longest(high - low);
        let per_length = BINS as f32 / (high[axis] - low[axis]);
        if !per_length.is_finite() {
            return;
        }
        let bin_of = |entry: &Entry| (((entry.x[axis] - low[axis]) * per_length) as u32 as usize).min(BINS - 1);
        let mut bins = [Bin::EMPTY; BINS];
        for entry in entries.iter() {
            let (bin, at) = (&mut bins[bin_of(entry)], Vec3::from_array(entry.x));
            *bin = bin.with(Bin { low: at, high: at, len: 1 });
        }
        let cut = cheapest(&bins);
        let n = partition(entries, |entry| bin_of(entry) < cut);
        let _ = children.push((n, ()));
        let _ = children.push((entries.len(), ()));
    }
}

/// Returns the number of the bin before which a cut is cheapest. The first and the last bin hold points, so neither
/// part is empty.
fn cheapest(bins: &[Bin; BINS]) -> usize {
    let mut above = [Bin::EMPTY; BINS + 1];
    for i in (0..BINS).rev() {
        above[i] = above[i + 1].with(bins[i]);
    }
    let (mut below, mut best, mut least) = (Bin::EMPTY, 1_usize, f32::INFINITY);
    for cut in 1..BINS {
        below = below.with(bins[cut - 1]);
        let cost = below.cost() + above[cut].cost();
        // The middle one of equal cuts is taken: points on a line have no surface anywhere.
        if cost < least || (cost == least && cut.abs_diff(BINS / 2) < best.abs_diff(BINS / 2)) {
            (best, least) = (cut, cost);
        }
    }
    best
}
