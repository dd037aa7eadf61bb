//! The kd-tree: planes across the axes cut space, and the pieces with it.

use super::entries::{Entries, area};
use super::split::{Part, Split};
use crate::shape::Aabb;

/// A kd-tree (Bentley 1975) by the surface area heuristic (MacDonald and Booth 1990) over bins: of all places along all
/// axes the one where the surfaces of both parts, times what they hold, come to the least. Pieces that the plane cuts
/// are listed on both sides, each with what is left of its box there.
pub(super) struct Cheapest;

/// Places along an axis, and one more.
const BINS: usize = 16;
/// The share of a part's cost that a cut must not exceed.
const GAIN: f32 = 0.9;

impl Split for Cheapest {
    const CUTS: bool = true;
    const LEAF: usize = 16;
    type Cell = ();

    fn root(&self, _: &Aabb) {}

    fn cut(&self, part: &Part<()>, entries: &mut Entries<'_>, scale: f32) -> Option<[Part<()>; 2]> {
        let bounds = part.hull.bounds();
        let now = area(&bounds, scale) * part.range.len() as f32;
        let mut best = (GAIN * now, 0, 0.0);
        for axis in 0..3 {
            let (low, high) = (bounds.min[axis], bounds.max[axis]);
            let per_length = BINS as f32 / (high - low);
            if !(per_length > 0.0 && per_length.is_finite()) {
                continue;
            }
            let bin_of = |x: f32| (((x - low) * per_length) as u32 as usize).min(BINS - 1);
            let (mut begun, mut ended) = ([0_usize; BINS], [0_usize; BINS]);
            for entry in entries.of(part.range.clone()) {
                begun[bin_of(entry.low[axis])] += 1;
                ended[bin_of(entry.high[axis])] += 1;
            }
            let (mut below, mut above) = (0, part.range.len());
            for cut in 1..BINS {
                below += begun[cut - 1];
                above -= ended[cut - 1];
                let plane = low + (high - low) * (cut as f32 / BINS as f32);
                let side = |min: f32, max: f32| {
                    let mut side = bounds;
                    (side.min[axis], side.max[axis]) = (min, max);
                    area(&side, scale)
                };
                let cost = side(low, plane) * below as f32 + side(plane, high) * above as f32;
                if cost < best.0 {
                    best = (cost, axis, plane);
                }
            }
        }
        let (cost, axis, plane) = best;
        let inside = bounds.min[axis] < plane && plane < bounds.max[axis];
        if !(cost < GAIN * now && inside) {
            return None;
        }
        let len = part.range.len();
        if entries.sides(part.range.clone(), axis, plane).iter().any(|&side| side == 0 || side == len) {
            return None;
        }
        let cut = entries.cut(part.range.clone(), axis, plane)?;
        Some(cut.map(|range| Part::new(range, (), part.cuts + 1, entries)))
    }
}
