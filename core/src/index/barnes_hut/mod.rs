//! Sums over all points in which far groups act as one.

mod list;
mod local;
mod moments;
mod path;
mod sums;
mod target;

pub use moments::Opening;

use super::{Cost, Octree, SpatialIndex, Stats, TooSmall};
use crate::math::max;
use core::ops::Range;
use glam::Vec3;
use moments::Moments;
use path::Path;
use sums::{GROUP, Law, Sums, Wide};
use target::{Seen, Target, longest};

/// Points with weights in an octree, for sums of Σ w d⃗ / (d² + s²)^{3/2} (Barnes and Hut 1986): weights are masses, or
/// charges of both signs.
///
/// Nodes carry their weight, dipole and quadrupole about the centre of their absolute weights. Near points go through the
/// tree together (Barnes 1990): a node acts on all of a group as one if it is small compared to its distance from the
/// group's box, and what a group is to feel is put in one list and summed in lanes. What is far from a whole box of groups,
/// compared to the box's own size, acts by a Taylor series about its centre (Dehnen 2002).
#[derive(Debug)]
pub struct BarnesHut<'m> {
    tree: Octree<'m>,
    /// By slot.
    weights: &'m mut [f32],
    /// By node.
    moments: &'m mut [Moments],
    /// The weights are divided by this power of two, so that their moments are within an `f32`.
    unit: f32,
    /// True if there are weights of both signs, and so dipoles.
    signed: bool,
}

/// Slots that are worth a thread's while.
#[cfg(feature = "rayon")]
const SHARE: usize = 512;

/// The shares of a thread, that all may be done at about the same time.
#[cfg(feature = "rayon")]
const SHARES: usize = 8;

/// So many points are summed one by one as quickly as all their moments.
const FEW: usize = 2;

/// Words of a node's moments.
const MOMENTS: usize = size_of::<Moments>() / 4;

impl<'m> BarnesHut<'m> {
    /// Vectors for each of a system's particles that it takes, if they are at least `FEWEST`.
    pub(crate) const COLUMNS: usize = 5;
    /// For less, all pairs are summed as quickly.
    pub(crate) const FEWEST: usize = 128;

    /// Words of memory, four bytes each, that it takes for so many points; `usize::MAX` where it takes more.
    #[must_use]
    pub const fn words(points: usize) -> usize {
        let moments = Self::nodes(points).saturating_mul(MOMENTS);
        Octree::words(points).saturating_add(points).saturating_add(moments)
    }

    /// Nodes there is room for.
    const fn nodes(points: usize) -> usize {
        points / 4 + 4
    }

    /// An empty one in so much memory.
    #[must_use]
    pub fn new(memory: &'m mut [u32]) -> Self {
        // The inverse of `words`, rounded down.
        let (none, four) = (Self::words(0), Self::words(4));
        let mut capacity = memory.len().saturating_sub(none) * 4 / (four - none);
        while Self::words(capacity + 1) <= memory.len() {
            capacity += 1;
        }
        let (tree, rest) = memory.split_at_mut(Octree::words(capacity).min(memory.len()));
        let (weights, moments) = rest.split_at_mut(capacity.min(rest.len()));
        let whole = moments.len() / MOMENTS * MOMENTS;
        Self {
            tree: Octree::new(tree),
            weights: bytemuck::cast_slice_mut(weights),
            moments: bytemuck::cast_slice_mut(&mut moments[..whole]),
            unit: 1.0,
            signed: false,
        }
    }

    /// One over points with weights; none if the memory is too small for them.
    #[must_use]
    pub fn over<'a>(memory: &'a mut [u32], points: &[Vec3], weights: &[f32]) -> Option<BarnesHut<'a>> {
        let mut grown = BarnesHut::new(memory);
        grown.build(points, weights).ok()?;
        Some(grown)
    }

    /// Sorts the points in. Those that are not finite, or have no finite weight, do not act; the former are left out.
    ///
    /// # Errors
    /// If the memory is too small.
    #[inline(never)]
    pub fn build(&mut self, points: &[Vec3], weights: &[f32]) -> Result<(), TooSmall> {
        self.tree.build(points, 0.0)?;
        let given = |row: u32| weights.get(row as usize).copied().filter(|weight| weight.is_finite()).unwrap_or(0.0);
        let most = self.tree.order().iter().fold(0.0, |most, &row| max(given(row).abs(), most));
        self.unit = f32::from_bits((most.to_bits() >> 23).clamp(7, 247) << 23);
        for (weight, &row) in self.weights.iter_mut().zip(self.tree.order()) {
            *weight = given(row) / self.unit;
        }
        let of_sign = |negative| {
            self.weights[..self.tree.order().len()].iter().any(|&w| if negative { w < 0.0 } else { w > 0.0 })
        };
        self.signed = of_sign(true) && of_sign(false);
        let (tree, weights) = (&self.tree, &*self.weights);
        for node in (0..tree.nodes().len().saturating_sub(1)).rev() {
            let moments = if tree.is_leaf(node) {
                Moments::of(tree.slots(node).map(|slot| Moments {
                    center: tree.points().point(slot).to_array(),
                    weight: weights[slot],
                    absolute: weights[slot].abs(),
                    ..Moments::default()
                }))
            } else {
                let (moments, children) = (&*self.moments, tree.children(node));
                Moments::of(children.map(|child| moments[child]))
            };
            self.moments[node] =
                Moments { side: longest(tree.nodes()[node].high() - tree.nodes()[node].low()), ..moments };
        }
        Ok(())
    }

    /// Tells how large the tree has become.
    #[must_use]
    pub fn stats(&self) -> Stats {
        let stats = self.tree.stats();
        Stats { bytes: stats.bytes + 4 * (stats.points + MOMENTS * stats.nodes), ..stats }
    }

    /// Visits each of `rows` that is in the tree with the sum there, without what it does to itself.
    ///
    /// Which rows are asked for together makes no difference to any sum. With the feature `rayon` all threads of the pool that
    /// this one belongs to take their part of the groups, whose sums are put on the heap meanwhile.
    pub fn field(&self, law: Opening, rows: Range<usize>, visit: &mut dyn FnMut(usize, Vec3)) -> Cost {
        let slots = 0..self.tree.order().len();
        #[cfg(feature = "rayon")]
        if rayon::current_thread_index().is_some() && rows.len().min(slots.len()) >= 2 * SHARE {
            return self.field_side_by_side(law, slots, &rows, visit);
        }
        self.field_among(law, slots, &rows, visit)
    }

    /// The same by many threads, a share of the slots each.
    #[cfg(feature = "rayon")]
    fn field_side_by_side(
        &self,
        law: Opening,
        slots: Range<usize>,
        rows: &Range<usize>,
        visit: &mut dyn FnMut(usize, Vec3),
    ) -> Cost {
        use rayon::prelude::*;
        // Each share goes into the tree anew, so a thread gets a few large ones rather than many.
        let most = (slots.end / (SHARES * rayon::current_num_threads())).max(SHARE);
        let share = |i: usize| i * most..((i + 1) * most).min(slots.end);
        let part = |i: usize| {
            let mut sums = std::vec::Vec::with_capacity(most);
            let cost = self.field_among(law, share(i), rows, &mut |row, sum| sums.push((row, sum)));
            (cost, sums)
        };
        let parts: std::vec::Vec<_> = (0..slots.end.div_ceil(most)).into_par_iter().map(part).collect();
        let mut cost = Cost::default();
        for (part, sums) in parts {
            cost += part;
            sums.into_iter().for_each(|(row, sum)| visit(row, sum));
        }
        cost
    }

    /// The same for the groups that begin in some of the slots. It takes some 20 kB of stack, which is why it is never part of
    /// another function.
    #[inline(never)]
    fn field_among(
        &self,
        law: Opening,
        among: Range<usize>,
        rows: &Range<usize>,
        visit: &mut dyn FnMut(usize, Vec3),
    ) -> Cost {
        let law = Law::new(law, self.tree.points(), self.signed);
        let (order, mut cost, mut sums, mut wide) =
            (self.tree.order(), Cost::default(), Sums::new(law), Wide::new(law));
        let nodes = self.tree.nodes();
        let mut path = Path::new(nodes.len().saturating_sub(1));
        let mut node = 0;
        while node + 1 < nodes.len() {
            let slots = self.tree.all_slots(node);
            if slots.len() > GROUP && !self.tree.is_leaf(node) {
                node += 1;
                continue;
            }
            for start in slots.clone().step_by(GROUP) {
                let group = start..slots.end.min(start + GROUP);
                if among.contains(&start) && group.clone().any(|slot| rows.contains(&(order[slot] as usize))) {
                    cost += self.approach(node, law, &mut path, &mut wide);
                    cost += self.sum(group.clone(), law, &path, &mut wide, &mut sums);
                    for (slot, sum) in group.zip(&sums.sums) {
                        let row = order[slot] as usize;
                        if rows.contains(&row) {
                            cost.found += 1;
                            visit(row, *sum * law.scale * self.unit * law.scale);
                        }
                    }
                }
            }
            node = nodes[node].next();
        }
        cost
    }

    /// Goes into the boxes that hold a node, but for itself.
    fn approach(&self, node: usize, law: Law, path: &mut Path, wide: &mut Wide) -> Cost {
        let mut cost = Cost::default();
        path.leave(node);
        while path.node() != node && !path.is_full() {
            let holds = |&child: &usize| node < self.tree.nodes()[child].next();
            match self.tree.children(path.node()).find(holds) {
                Some(child) if child != node && self.enter(child, law, path, wide, &mut cost) => {}
                _ => break,
            }
        }
        cost
    }

    /// Goes into a box: nodes that are far from it add to its series, those that are as small are left to what is in it.
    /// False if there is no room for them.
    fn enter(&self, inner: usize, law: Law, path: &mut Path, wide: &mut Wide, cost: &mut Cost) -> bool {
        let nodes = self.tree.nodes();
        let target = Target::new([nodes[inner].low(), nodes[inner].high()], self.tree.all_slots(inner), law);
        let (given, first) = (path.nodes_left(), path.nodes_left().end);
        wide.begin(&target.region);
        let mut room = true;
        for i in given {
            cost.visits += self.walk(path.at(i), |node, moments| {
                let seen = target.sees(moments, || self.tree.all_slots(node));
                if seen == Seen::ByAll {
                    wide.push(moments);
                    cost.tests += 1;
                } else if seen == Seen::Near && moments.side >= target.side && !self.tree.is_leaf(node) {
                    return true;
                } else {
                    room = room && path.push(node);
                }
                false
            });
        }
        if !room {
            path.truncate(first);
            return false;
        }
        let series = wide.finish().and(path.series());
        path.enter(inner..nodes[inner].next(), first, series);
        true
    }

    /// Visits a node and all below it, down to where it is told not to go into; returns how many that were.
    #[inline(always)]
    fn walk(&self, from: usize, mut into: impl FnMut(usize, &Moments) -> bool) -> u64 {
        let nodes = self.tree.nodes();
        let (mut node, end, mut visits) = (from, nodes[from].next(), 0);
        while node < end {
            visits += 1;
            node = if into(node, &self.moments[node]) { node + 1 } else { nodes[node].next() };
        }
        visits
    }

    /// The places and weights of some slots.
    #[inline(always)]
    fn sources(&self, slots: Range<usize>) -> [&[f32]; 4] {
        let [x, y, z] = self.tree.points().run(&slots);
        [x, y, z, &self.weights[slots]]
    }

    /// Takes the sums at the points of a group, of what the way to it has left and of its series.
    fn sum(&self, group: Range<usize>, law: Law, path: &Path, wide: &mut Wide, sums: &mut Sums) -> Cost {
        let (points, mut cost) = (self.tree.points(), Cost::default());
        let target = Target::new(points.bounds(group.clone()), group.clone(), law);
        wide.begin(&target.region);
        sums.begin(group.clone().map(|slot| points.point(slot)));
        for i in path.nodes_left() {
            cost.visits += self.walk(path.at(i), |node, moments| {
                let slots = self.tree.all_slots(node);
                let (seen, pairs) = (target.sees(moments, || slots.clone()), group.len() as u64);
                match seen {
                    Seen::ByAll => {
                        wide.push(moments);
                        cost.tests += 1;
                    }
                    Seen::ByEach if !law.quadrupole || slots.len() > FEW => {
                        sums.push_far(moments);
                        cost.tests += pairs;
                    }
                    Seen::Near if !self.tree.is_leaf(node) => return true,
                    _ => {
                        cost.tests += pairs * slots.len() as u64;
                        sums.push(self.sources(slots));
                    }
                }
                false
            });
        }
        sums.finish(&wide.finish().and(path.series()));
        cost
    }
}

/// How far sums over groups are from those over all pairs.
#[cfg(feature = "std")]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FieldError {
    /// Root mean square of |Δa| / |a|.
    pub rms: f64,
    /// The largest |Δa| / |a|.
    pub largest: f64,
}

#[cfg(feature = "std")]
impl BarnesHut<'_> {
    /// Holds the sums at every `stride`-th slot against those over all pairs, in double precision. Costs N² / `stride`.
    #[must_use]
    pub fn error(&self, law: Opening, stride: usize) -> FieldError {
        let points = self.tree.points();
        let (mut sum, mut count, mut largest) = (0.0, 0, 0.0f64);
        for slot in (0..points.len).step_by(stride.max(1)) {
            let (row, exact) = (self.tree.order()[slot] as usize, self.exact(law, slot));
            self.field(law, row..row + 1, &mut |_, field| {
                let wrong: f64 = exact.iter().zip(field.to_array()).map(|(a, b)| (f64::from(b) - a).powi(2)).sum();
                let square = wrong / exact.iter().map(|a| a * a).sum::<f64>().max(f64::MIN_POSITIVE);
                sum += square;
                count += 1;
                largest = largest.max(square.sqrt());
            });
        }
        FieldError { rms: (sum / f64::from(count.max(1))).sqrt(), largest }
    }

    /// The sum at a slot over all pairs.
    fn exact(&self, law: Opening, slot: usize) -> [f64; 3] {
        let points = self.tree.points();
        let wide = |slot: usize| points.point(slot).to_array().map(f64::from);
        let (place, square) = (wide(slot), f64::from(points.domain.length(law.softening)).powi(2));
        let unscale = f64::from(points.domain.length(1.0)).powi(2) * f64::from(self.unit);
        let mut sum = [0.0; 3];
        for (other, &weight) in self.weights[..points.len].iter().enumerate() {
            let at = wide(other);
            let d: [f64; 3] = core::array::from_fn(|axis| at[axis] - place[axis]);
            let r2 = d.iter().map(|d| d * d).sum::<f64>() + square;
            if r2 > 0.0 {
                let weight = f64::from(weight) * unscale / (r2 * r2.sqrt());
                (0..3).for_each(|axis| sum[axis] += d[axis] * weight);
            }
        }
        sum
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_systems_columns_are_enough() {
        for points in BarnesHut::FEWEST..10_000 {
            assert!(BarnesHut::words(points) <= 3 * BarnesHut::COLUMNS * points, "{points}");
        }
    }
}
