//! The binary space partition: planes of any orientation, chosen from the pieces.

use super::bvh::cut;
use super::entries::Entries;
use super::split::{Part, Split};
use crate::index::principal_axes;
use crate::shape::Aabb;

/// A binary space partition (Fuchs, Kedem and Naylor 1980): parts are cut across the principal axis (Pearson 1901) along
/// which the middles of their pieces spread most, at the plane that leaves the least surface on both sides.
///
/// A piece is on the side of its middle, so that none is listed twice; what is left of it on the other side is known by
/// its part's box, which is what the search goes by.
pub(super) struct Planes;

/// Pieces that are looked at to find the axes.
const SAMPLE: usize = 32;

impl Split for Planes {
    const CUTS: bool = false;
    type Cell = ();

    fn root(&self, _: &Aabb) {}

    fn cut(&self, part: &Part<()>, entries: &mut Entries<'_>, scale: f32) -> Option<[Part<()>; 2]> {
        let few = entries.of(part.range.clone());
        let step = few.len().div_ceil(SAMPLE);
        let axes = principal_axes(|| few.iter().step_by(step).map(|entry| entry.center() * scale));
        let spread = |axis: usize| {
            let normal = axes.col(axis) * scale;
            let heights = few.iter().map(|entry| normal.dot(entry.center()));
            heights.fold((f32::INFINITY, f32::NEG_INFINITY), |(low, high), h| {
                (if h < low { h } else { low }, if h > high { h } else { high })
            })
        };
        let spreads = [spread(0), spread(1), spread(2)];
        let width = |axis: usize| spreads[axis].1 - spreads[axis].0;
        let axis = if width(1) > width(0) { 1 } else { 0 };
        let axis = if width(2) > width(axis) { 2 } else { axis };
        let normal = axes.col(axis) * scale;
        cut(part, entries, scale, spreads[axis], |entry| normal.dot(entry.center()))
    }
}
