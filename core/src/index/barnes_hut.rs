//! Sums over all points in which far groups act as one.

use super::search::Region;
use super::sorted::{LANES, Sorted};
use super::tree::Node;
use super::{Cost, Octree, SpatialIndex, Stats, TooSmall};
use crate::lanes::{NOWHERE, Pull, splat};
use crate::math::max;
use core::ops::Range;
use glam::Vec3;
use wide::f32x8;

/// Points with weights in an octree, for sums of Σ w d⃗ / (d² + s²)^{3/2} (Barnes and Hut 1986): weights are masses, or
/// charges of both signs.
///
/// Nodes carry their weight, dipole and quadrupole about the centre of their absolute weights. Near points go through the
/// tree together (Barnes 1990): a node acts on all of a group as one if it is small compared to its distance from the
/// group's box, and what a group is to feel is put in one list and summed in lanes.
#[derive(Debug)]
pub struct BarnesHut<'m> {
    tree: Octree<'m>,
    /// By slot.
    weights: &'m mut [f32],
    /// By node.
    moments: &'m mut [Moments],
    /// The weights are divided by this power of two, so that their moments are within an `f32`.
    unit: f32,
}

/// What counts as far, and how far groups act.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Opening {
    /// A node acts as one if its longest side is less than this times its distance.
    pub theta: f32,
    /// Softening length s \[m\].
    pub softening: f32,
    /// Whether nodes act by their dipole and quadrupole as well; else by their weight alone.
    pub quadrupole: bool,
}

/// Of a node's weights: about their centre c, with d⃗ = x⃗ − c⃗.
#[derive(Clone, Copy, Debug, Default, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
struct Moments {
    /// c = Σ |w| x / Σ |w|.
    center: [f32; 3],
    /// Σ w.
    weight: f32,
    /// Σ |w|.
    absolute: f32,
    /// Σ w d.
    dipole: [f32; 3],
    /// Σ w d dᵀ: xx, yy, zz, xy, yz, zx.
    second: [f32; 6],
}

impl Moments {
    /// The moments of parts, or of points, together.
    fn of(parts: impl Iterator<Item = Self> + Clone) -> Self {
        let (mut sum, mut absolute, mut weight) = (Vec3::ZERO, 0.0, 0.0);
        for part in parts.clone() {
            sum += Vec3::from_array(part.center) * part.absolute;
            absolute += part.absolute;
            weight += part.weight;
        }
        let Some(first) = parts.clone().next() else { return Self::default() };
        let center = if absolute > 0.0 { sum / absolute } else { Vec3::from_array(first.center) };
        let (mut dipole, mut second) = (Vec3::ZERO, [0.0; 6]);
        for part in parts {
            let (e, d, w) = (Vec3::from_array(part.center) - center, Vec3::from_array(part.dipole), part.weight);
            dipole += d + e * w;
            for (k, (i, j)) in PAIRS.into_iter().enumerate() {
                second[k] += part.second[k] + d[i] * e[j] + d[j] * e[i] + w * e[i] * e[j];
            }
        }
        Self { center: center.to_array(), weight, absolute, dipole: dipole.to_array(), second }
    }
}

/// The axes of the six second moments.
const PAIRS: [(usize, usize); 6] = [(0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (2, 0)];

/// Words of a node's moments.
const MOMENTS: usize = size_of::<Moments>() / 4;
/// Points that share one list.
const GROUP: usize = 64;
/// Sources that are summed at once.
const LIST: usize = 512;
/// Far nodes that are summed at once, if they act by all their moments.
const FAR: usize = 128;

impl<'m> BarnesHut<'m> {
    /// Vectors for each of a system's particles that it takes, if they are at least `FEWEST`.
    pub(crate) const COLUMNS: usize = 5;
    /// For less, all pairs are summed as quickly.
    pub(crate) const FEWEST: usize = 128;

    /// Words of memory, four bytes each, that it takes for so many points.
    #[must_use]
    pub const fn words(points: usize) -> usize {
        Octree::words(points) + points + Self::nodes(points) * MOMENTS
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
        }
    }

    /// One over points with weights; none if the memory is too small for them.
    #[must_use]
    pub fn grow<'a>(memory: &'a mut [u32], points: &[Vec3], weights: &[f32]) -> Option<BarnesHut<'a>> {
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
            self.moments[node] = moments;
        }
        Ok(())
    }

    /// What has been built.
    #[must_use]
    pub fn stats(&self) -> Stats {
        let stats = self.tree.stats();
        Stats { bytes: stats.bytes + 4 * (stats.points + MOMENTS * stats.nodes), ..stats }
    }

    /// Visits each of `rows` that is in the tree with the sum there, without what it does to itself.
    ///
    /// Which rows are asked for together makes no difference to any sum. It takes some 20 kB of stack, which is why it is
    /// never part of another function.
    #[inline(never)]
    pub fn field(&self, law: Opening, rows: Range<usize>, visit: &mut dyn FnMut(usize, Vec3)) -> Cost {
        let (order, mut cost, mut sums) = (self.tree.order(), Cost::default(), Sums::new(law, self.tree.points()));
        let mut node = 0;
        while node + 1 < self.tree.nodes().len() {
            let slots = self.tree.all_slots(node);
            if slots.len() > GROUP && !self.tree.is_leaf(node) {
                node += 1;
                continue;
            }
            node = self.tree.nodes()[node].next();
            for start in slots.clone().step_by(GROUP) {
                let group = start..slots.end.min(start + GROUP);
                if group.clone().any(|slot| rows.contains(&(order[slot] as usize))) {
                    cost += self.group(group, &rows, &mut sums, visit);
                }
            }
        }
        cost
    }

    /// The sums at the points of a group.
    fn group(
        &self,
        group: Range<usize>,
        rows: &Range<usize>,
        sums: &mut Sums,
        visit: &mut dyn FnMut(usize, Vec3),
    ) -> Cost {
        let (points, order, nodes) = (self.tree.points(), self.tree.order(), self.tree.nodes());
        let region = Region::new(points.bounds(group.clone()));
        sums.begin(group.clone().map(|slot| points.point(slot)));
        let (mut node, mut cost) = (0, Cost::default());
        while node + 1 < nodes.len() {
            cost.visits += 1;
            let moments = &self.moments[node];
            let center = Vec3::from_array(moments.center);
            let square = region.square_to(center, center, Vec3::ZERO);
            let side = nodes[node].side();
            let slots = self.tree.all_slots(node);
            let itself = slots.start < group.end && group.start < slots.end;
            if !itself && side * side < sums.theta_squared * square {
                sums.push_far(moments);
                cost.tests += group.len() as u64;
                node = nodes[node].next();
                continue;
            }
            if self.tree.is_leaf(node) {
                for slot in self.tree.slots(node) {
                    sums.push(points.point(slot), self.weights[slot]);
                }
                cost.tests += (group.len() * self.tree.slots(node).len()) as u64;
            }
            node += 1;
        }
        sums.flush();
        sums.flush_far();
        for (slot, sum) in group.zip(&sums.sums) {
            let row = order[slot] as usize;
            if rows.contains(&row) {
                cost.found += 1;
                visit(row, *sum * sums.scale * self.unit * sums.scale);
            }
        }
        cost
    }
}

impl Node {
    /// The longest side of its box.
    #[inline(always)]
    fn side(&self) -> f32 {
        let side = self.high() - self.low();
        max(side.x, max(side.y, side.z))
    }
}

/// The sums at the places of a group, and what is still to be added to them.
struct Sums {
    theta_squared: f32,
    softening_squared: f32,
    /// That of the tree against the points.
    scale: f32,
    quadrupole: bool,
    len: usize,
    places: [Vec3; GROUP],
    sums: [Vec3; GROUP],
    /// x, y, z and weight of the sources to be added.
    list: Columns<4, LIST>,
    /// The moments of the nodes to be added.
    far: Columns<13, FAR>,
}

/// Some columns of numbers, to be read in lanes.
struct Columns<const COLUMNS: usize, const ROWS: usize> {
    columns: [[f32; ROWS]; COLUMNS],
    len: usize,
}

impl<const COLUMNS: usize, const ROWS: usize> Columns<COLUMNS, ROWS> {
    const EMPTY: Self = Self { columns: [[0.0; ROWS]; COLUMNS], len: 0 };

    #[inline(always)]
    fn push(&mut self, row: [f32; COLUMNS]) {
        for (column, x) in self.columns.iter_mut().zip(row) {
            column[self.len] = x;
        }
        self.len += 1;
    }

    /// Fills the last block up with what has no weight; returns how many blocks there are.
    fn pad(&mut self) -> usize {
        while !self.len.is_multiple_of(LANES) {
            self.push(core::array::from_fn(|column| if column < 3 { NOWHERE } else { 0.0 }));
        }
        self.len / LANES
    }

    #[inline(always)]
    fn block(&self, block: usize) -> [f32x8; COLUMNS] {
        core::array::from_fn(|column| f32x8::new(self.columns[column].as_chunks().0[block]))
    }
}

impl Sums {
    fn new(law: Opening, points: &Sorted<'_>) -> Self {
        let (scale, softening) = (points.domain.length(1.0), points.domain.length(law.softening));
        Self {
            theta_squared: law.theta * law.theta,
            softening_squared: softening * softening,
            scale,
            quadrupole: law.quadrupole,
            len: 0,
            places: [Vec3::ZERO; GROUP],
            sums: [Vec3::ZERO; GROUP],
            list: Columns::EMPTY,
            far: Columns::EMPTY,
        }
    }

    fn begin(&mut self, places: impl Iterator<Item = Vec3>) {
        self.sums = [Vec3::ZERO; GROUP];
        self.len = 0;
        for (to, place) in self.places.iter_mut().zip(places) {
            *to = place;
            self.len += 1;
        }
    }

    #[inline(always)]
    fn push(&mut self, at: Vec3, weight: f32) {
        self.list.push([at.x, at.y, at.z, weight]);
        if self.list.len == LIST {
            self.flush();
        }
    }

    #[inline(always)]
    fn push_far(&mut self, moments: &Moments) {
        if !self.quadrupole {
            return self.push(Vec3::from_array(moments.center), moments.weight);
        }
        let ([x, y, z], [dx, dy, dz]) = (moments.center, moments.dipole);
        let [xx, yy, zz, xy, yz, zx] = moments.second;
        self.far.push([x, y, z, moments.weight, dx, dy, dz, xx, yy, zz, xy, yz, zx]);
        if self.far.len == FAR {
            self.flush_far();
        }
    }

    /// Adds the sources in the list.
    fn flush(&mut self) {
        let (blocks, square) = (self.list.pad(), f32x8::splat(self.softening_squared));
        for (sum, place) in self.sums.iter_mut().zip(&self.places[..self.len]) {
            let (mut pull, place) = (Pull::default(), splat(*place));
            for block in 0..blocks {
                let [x, y, z, w] = self.list.block(block);
                pull.add(place, [x, y, z], w, square);
            }
            *sum += pull.total();
        }
        self.list.len = 0;
    }

    /// Adds the far nodes.
    fn flush_far(&mut self) {
        let (blocks, square) = (self.far.pad(), f32x8::splat(self.softening_squared));
        for (sum, place) in self.sums.iter_mut().zip(&self.places[..self.len]) {
            let (mut total, place) = ([f32x8::ZERO; 3], splat(*place));
            for block in 0..blocks {
                add_far(&mut total, place, self.far.block(block), square);
            }
            *sum += Vec3::from_array(total.map(crate::lanes::total));
        }
        self.far.len = 0;
    }
}

/// Adds the first three terms of w (R + d) / |R + d|³ in powers of d, R being the way to a node's centre and u² = R² +
/// s²: w R/u³ + D/u³ − 3 R (R·D)/u⁵ − 3 S R/u⁵ − 3/2 R tr S/u⁵ + 15/2 R (R·S R)/u⁷.
#[inline(always)]
fn add_far(sum: &mut [f32x8; 3], place: [f32x8; 3], node: [f32x8; 13], square: f32x8) {
    let [x, y, z, w, dx, dy, dz, xx, yy, zz, xy, yz, zx] = node;
    let r = [x - place[0], y - place[1], z - place[2]];
    let dot = |a: [f32x8; 3], b: [f32x8; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let u2 = dot(r, r) + square;
    let inverse = (f32x8::ONE / crate::lanes::sqrt(u2)) & u2.simd_gt(f32x8::ZERO);
    // From here on the way is a unit vector, or less by softening, and each moment is over its power of the distance.
    let r = r.map(|r| r * inverse);
    let over = |moment: f32x8| moment * inverse;
    let [xx, yy, zz, xy, yz, zx] = [xx, yy, zz, xy, yz, zx].map(|moment| over(over(moment)));
    let d = [over(dx), over(dy), over(dz)];
    let s = [xx * r[0] + xy * r[1] + zx * r[2], xy * r[0] + yy * r[1] + yz * r[2], zx * r[0] + yz * r[1] + zz * r[2]];
    let trace = xx + yy + zz;
    let along = w - f32x8::splat(3.0) * dot(r, d) - f32x8::splat(1.5) * trace + f32x8::splat(7.5) * dot(r, s);
    for axis in 0..3 {
        sum[axis] += over(over(r[axis] * along + d[axis] - f32x8::splat(3.0) * s[axis]));
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
