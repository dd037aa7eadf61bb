//! The bounding-volume hierarchy: parts are cut where the boxes of both become small.

use super::entries::{Entries, Entry, Hull};
use super::split::{Part, Split, longest};
use crate::shape::Aabb;
use core::ops::Range;
use wide::f32x4;

/// Splits by the surface area heuristic (Goldsmith and Salmon 1987) over bins (Wald 2007).
pub(super) struct Areas;

/// Places where a part may be cut, and one more.
const BINS: usize = 16;
/// So few are cut exactly, so that leaves fill whole nodes.
const FEW: usize = 64;

impl Split for Areas {
    const CUTS: bool = false;
    type Cell = ();

    fn root(&self, _: &Aabb) {}

    fn cut(&self, part: &Part<()>, entries: &mut Entries<'_>, scale: f32) -> Option<[Part<()>; 2]> {
        let centers = centers(entries.of(part.range.clone()));
        let axis = longest(&centers);
        let span = (centers.min[axis], centers.max[axis]);
        cut(part, entries, scale, span, |entry| entry.middle(axis))
    }
}

/// The box around the middles.
pub(super) fn centers(entries: &[Entry]) -> Aabb {
    let mut hull = Hull::EMPTY;
    for entry in entries {
        let [low, high] = bytemuck::cast::<Entry, [f32x4; 2]>(*entry);
        hull.add_point(low * f32x4::HALF + high * f32x4::HALF);
    }
    hull.bounds()
}

/// Cuts across a direction, along which the middles have heights from the lowest to the highest.
pub(super) fn cut<C: Clone>(
    part: &Part<C>,
    entries: &mut Entries<'_>,
    scale: f32,
    (lowest, highest): (f32, f32),
    height: impl Fn(&Entry) -> f32,
) -> Option<[Part<C>; 2]> {
    let per_height = BINS as f32 / (highest - lowest);
    if !(per_height > 0.0 && per_height.is_finite()) {
        return None;
    }
    let (range, cuts) = (part.range.clone(), part.cuts + 1);
    let halves = |middle, hulls: [Hull; 2]| {
        let [below, above] = hulls;
        let cell = || part.cell.clone();
        Some([
            Part { range: range.start..middle, hull: below, cell: cell(), cuts },
            Part { range: middle..range.end, hull: above, cell: cell(), cuts },
        ])
    };
    if range.len() <= FEW {
        let (middle, hulls) = cut_few(range.clone(), entries, scale, height)?;
        return halves(middle, hulls);
    }
    let bin_of = |entry: &Entry| (((height(entry) - lowest) * per_height) as u32 as usize).min(BINS - 1);
    let mut bins = [(Hull::EMPTY, 0_usize); BINS];
    for entry in entries.of(range.clone()) {
        let bin = &mut bins[bin_of(entry)];
        bin.0.add(entry);
        bin.1 += 1;
    }
    let (before, hulls) = cheapest(&bins, scale);
    let middle = entries.part(range.clone(), |entry| bin_of(entry) < before);
    // Where heights round to one bin after all.
    if middle == range.start || middle == range.end { None } else { halves(middle, hulls) }
}

/// Returns the number of the bin before which a cut is cheapest, and the hulls of both sides. The first and the last
/// bin hold something.
fn cheapest(bins: &[(Hull, usize); BINS], scale: f32) -> (usize, [Hull; 2]) {
    let mut above = [(Hull::EMPTY, 0); BINS + 1];
    for i in (0..BINS).rev() {
        above[i] = (above[i + 1].0.join(bins[i].0), above[i + 1].1 + bins[i].1);
    }
    let (mut below, mut count) = (Hull::EMPTY, 0);
    let mut best = (f32::INFINITY, 1_usize, [Hull::EMPTY; 2]);
    for cut in 1..BINS {
        below = below.join(bins[cut - 1].0);
        count += bins[cut - 1].1;
        let cost = below.area(scale) * count as f32 + above[cut].0.area(scale) * above[cut].1 as f32;
        // The middle one of equal cuts is taken: pieces on a line have no surface anywhere.
        if cost < best.0 || (cost == best.0 && cut.abs_diff(BINS / 2) < best.1.abs_diff(BINS / 2)) {
            best = (cost, cut, [below, above[cut].0]);
        }
    }
    (best.1, best.2)
}

/// Sorts a few by height, and cuts where both sides are small among the places that leave full nodes.
fn cut_few(
    range: Range<usize>,
    entries: &mut Entries<'_>,
    scale: f32,
    height: impl Fn(&Entry) -> f32,
) -> Option<(usize, [Hull; 2])> {
    let few = entries.of_mut(range.clone());
    few.sort_unstable_by(|a, b| height(a).total_cmp(&height(b)).then(a.piece.cmp(&b.piece)));
    let mut above = [Hull::EMPTY; FEW + 1];
    for (i, entry) in few.iter().enumerate().rev() {
        above[i] = above[i + 1];
        above[i].add(entry);
    }
    let (mut below, mut best) = (Hull::EMPTY, None);
    let mut least = f32::INFINITY;
    for (i, entry) in few.iter().enumerate() {
        if i > 0 && i.is_multiple_of(super::tree::WIDE) {
            let cost = below.area(scale) * i as f32 + above[i].area(scale) * (few.len() - i) as f32;
            if cost < least {
                (least, best) = (cost, Some((range.start + i, [below, above[i]])));
            }
        }
        below.add(entry);
    }
    best
}
