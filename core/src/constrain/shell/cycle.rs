//! A cycle through the coarser graphs of a shell: a guess at what solves its system, by which conjugate gradients are short.

use super::mesh::{Graph, LEVELS, Room};
use crate::constrain::walls::Wall;
use crate::lanes;
use crate::memory::take;
use glam::{Mat3, Vec3};
use wide::f32x4;

/// The numbers of a block: its columns one behind the other.
pub(super) const BLOCK: usize = 9;

/// So many times what the next graph finds do all of the finest go: groups that go as one are stiffer than what they stand for (over-correction:
/// Braess, Computing 55, 1995).
const FURTHER: f32 = 1.6;

/// One graph's part of the system.
#[derive(Default)]
pub(super) struct Level<'m> {
    pub(super) graph: Graph<'m>,
    /// The blocks of its links, and one number behind the last.
    pub(super) blocks: &'m mut [f32],
    /// Those of its rows with themselves; when all is known their inverses, zero for what does not move.
    pub(super) diagonal: &'m mut [f32],
    /// The same of the finest before walls press, not inverted, and without what bending adds.
    pub(super) whole: &'m mut [f32],
    pub(super) own: &'m mut [f32],
    /// The right-hand side and the solution, of all but the finest.
    r: &'m mut [Vec3],
    x: &'m mut [Vec3],
}

/// All of them, finest first.
pub(super) struct Levels<'m> {
    pub(super) all: [Level<'m>; LEVELS],
    count: usize,
}

/// Words for all of them.
pub(super) fn words(room: &Room) -> usize {
    let [rows, links] = [room.rows, room.links].map(|[fine, coarse]| fine + coarse);
    if rows == 0 { 0 } else { BLOCK * (links + rows + 2 * room.rows[0]) + 3 * LEVELS + 2 + 6 * room.rows[1] }
}

impl<'m> Levels<'m> {
    /// As many as there are graphs, in words: they hold anything.
    pub(super) fn of(graphs: [Graph<'m>; LEVELS], words: &'m mut [u32]) -> Self {
        let mut rest = words;
        let mut count = 0;
        let all = core::array::from_fn(|level| {
            let (graph, rows) = (graphs[level], graphs[level].rows());
            if rows == 0 {
                return Level::default();
            }
            let mut numbers = |len| bytemuck::cast_slice_mut(take(&mut rest, len));
            let blocks = numbers(BLOCK * graph.links.len() + 1);
            let diagonal = numbers(BLOCK * rows + 1);
            let [whole, own] = [0, 1].map(|_| numbers(if level > 0 { 0 } else { BLOCK * rows + 1 }));
            let [r, x] = [0, 1].map(|_| super::whole(take(&mut rest, if level > 0 { 3 * rows } else { 0 })));
            count = level + 1;
            Level { graph, blocks, diagonal, whole, own, r, x }
        });
        Self { all, count }
    }

    pub(super) fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// Sums up the blocks of each graph for the next, each group going as one, and inverts those of rows with themselves. What a wall presses hardly
    /// gives way, in the cycle too; conjugate gradients know that it does not at all. It is done anew where other walls press: a cycle
    /// that takes them for what they were costs several times the iterations.
    pub(super) fn fold(&mut self, walls: &[Wall]) {
        let [finest, ..] = &mut self.all;
        finest.diagonal.copy_from_slice(finest.whole);
        for (numbers, wall) in finest.diagonal.chunks_exact_mut(BLOCK).zip(walls).filter(|(_, wall)| wall.presses()) {
            let stiff = wall.stiffness(numbers[0] + numbers[4] + numbers[8]).to_cols_array();
            numbers.iter_mut().zip(stiff).for_each(|(number, stiff)| *number += stiff);
        }
        for level in 1..self.count {
            if let [fine, coarse, ..] = &mut self.all[level - 1..] {
                coarse.blocks.fill(0.0);
                coarse.diagonal.fill(0.0);
                lanes::widest(
                    #[inline(always)]
                    || fine.sum_into(coarse),
                );
            }
        }
        for level in &mut self.all[..self.count] {
            level.diagonal.chunks_exact_mut(BLOCK).for_each(invert);
        }
    }

    /// q = A p without what bending adds.
    pub(super) fn apply(&self, p: &[Vec3], q: &mut [Vec3]) {
        let [finest, ..] = &self.all;
        lanes::widest(
            #[inline(always)]
            || finest.apply(p, q),
        );
    }

    /// z ≈ A⁻¹ r: a sweep of Gauss and Seidel's method forth on the way to the coarsest graph, and one back on the way from there. So it is symmetric.
    pub(super) fn cycle(&mut self, r: &[Vec3], z: &mut [Vec3]) {
        lanes::widest(
            #[inline(always)]
            || {
                let [finest, others @ ..] = &mut self.all;
                let others = &mut others[..self.count.saturating_sub(1)];
                finest.forth(r, z);
                if let Some(next) = others.first_mut() {
                    finest.leave(z, next.r);
                }
                for i in 0..others.len() {
                    let (this, next) = others[i..].split_at_mut(1);
                    let Level { r, x, .. } = &mut this[0];
                    let (r, x) = (core::mem::take(r), core::mem::take(x));
                    this[0].forth(r, x);
                    if let Some(next) = next.first_mut() {
                        this[0].leave(x, next.r);
                    }
                    (this[0].r, this[0].x) = (r, x);
                }
                for i in (0..others.len()).rev() {
                    let (this, next) = others[i..].split_at_mut(1);
                    let Level { r, x, .. } = &mut this[0];
                    let (r, x) = (core::mem::take(r), core::mem::take(x));
                    this[0].back(r, x, next.first().map(|next| &*next.x));
                    (this[0].r, this[0].x) = (r, x);
                }
                finest.back(r, z, others.first().map(|next| &*next.x));
            },
        );
    }

    /// Takes from shifts what each piece that hangs together, and by nothing that is fixed, would go as a whole: Σ m Δx. Of those who are there, masses
    /// are given: infinite ones of what is fixed.
    pub(super) fn rid_of_drift(&mut self, masses: impl Iterator<Item = Option<f32>>, shift: &mut [Vec3]) {
        let [finest, others @ ..] = &mut self.all;
        let others = &mut others[..self.count.saturating_sub(1)];
        let Some(first) = others.first_mut() else { return };
        first.forget();
        for ((mass, &shift), &into) in masses.zip(&*shift).zip(finest.graph.into) {
            let Some(mass) = mass else { continue };
            first.gather(into, if mass < f32::INFINITY { shift * mass } else { Vec3::ZERO }, mass);
        }
        for i in 1..others.len() {
            let (this, next) = others.split_at_mut(i);
            let (Some(this), Some(next)) = (this.last(), next.first_mut()) else { return };
            next.forget();
            for ((&sum, mass), &into) in this.r.iter().zip(&*this.x).zip(this.graph.into) {
                next.gather(into, sum, mass.x);
            }
        }
        if let Some(last) = others.last_mut() {
            last.share_out();
        }
        for i in (1..others.len()).rev() {
            let (this, next) = others.split_at_mut(i);
            let (Some(this), Some(next)) = (this.last_mut(), next.first()) else { return };
            for (drift, &into) in this.r.iter_mut().zip(this.graph.into) {
                *drift = next.r.get(into as usize).copied().unwrap_or(Vec3::ZERO);
            }
        }
        let Some(first) = others.first() else { return };
        for (shift, &into) in shift.iter_mut().zip(finest.graph.into) {
            *shift -= first.r.get(into as usize).copied().unwrap_or(Vec3::ZERO);
        }
    }
}

impl Level<'_> {
    /// No momentum and no mass yet.
    fn forget(&mut self) {
        self.r.fill(Vec3::ZERO);
        self.x.fill(Vec3::ZERO);
    }

    /// Adds to the momentum and the mass of a row.
    fn gather(&mut self, row: u32, sum: Vec3, mass: f32) {
        if let (Some(to), Some(of)) = (self.r.get_mut(row as usize), self.x.get_mut(row as usize)) {
            *to += sum;
            of.x += mass;
        }
    }

    /// Makes of sums and masses how far each piece has gone: of each row, or of all, if some are linked still.
    fn share_out(&mut self) {
        if !self.graph.links.is_empty() {
            let (sum, mass) = (self.r.iter().copied().sum(), self.x.iter().map(|mass| mass.x).sum());
            self.r.fill(sum);
            self.x.fill(Vec3::splat(mass));
        }
        for (sum, mass) in self.r.iter_mut().zip(&*self.x) {
            let drift = *sum / mass.x;
            *sum = if drift.is_finite() { drift } else { Vec3::ZERO };
        }
    }

    #[inline(always)]
    fn sum_into(&self, coarse: &mut Level<'_>) {
        for (row, &into) in self.graph.into.iter().enumerate() {
            add(coarse.diagonal, into as usize, block(self.diagonal, row));
            for link in self.graph.range(row) {
                let Some(&other) = self.graph.links.get(link).and_then(|&other| self.graph.into.get(other as usize))
                else {
                    continue;
                };
                let numbers = block(self.blocks, link);
                if other == into {
                    add(coarse.diagonal, into as usize, numbers);
                } else if let Some(link) = coarse.graph.link(into as usize, other) {
                    add(coarse.blocks, link, numbers);
                }
            }
        }
    }

    /// q = A p without what bending adds.
    #[inline(always)]
    pub(super) fn apply(&self, p: &[Vec3], q: &mut [Vec3]) {
        for ((row, (&own, q)), range) in p.iter().zip(q).enumerate().zip(self.graph.ranges()) {
            let (links, blocks) = self.row(range);
            let others = less(f32x4::ZERO, links, blocks, p, |_| false);
            *q = vector(times(block(self.own, row), own) - others);
        }
    }

    /// x = (D + L)⁻¹ r.
    #[inline(always)]
    fn forth(&self, r: &[Vec3], x: &mut [Vec3]) {
        for ((row, &r), range) in r.iter().enumerate().take(x.len()).zip(self.graph.ranges()) {
            let (links, blocks) = self.row(range);
            let sum = less(quad(r), links, blocks, x, |other| other > row);
            x[row] = self.solved(row, sum);
        }
    }

    /// The residual after that, summed up for the next graph.
    #[inline(always)]
    fn leave(&self, x: &[Vec3], into: &mut [Vec3]) {
        into.fill(Vec3::ZERO);
        for ((row, &group), range) in self.graph.into.iter().enumerate().zip(self.graph.ranges()) {
            let (links, blocks) = self.row(range);
            let before = links.iter().take_while(|&&other| (other as usize) < row).count();
            let (links, blocks) = (&links[before..], blocks.get(BLOCK * before..).unwrap_or(&[]));
            let sum = less(f32x4::ZERO, links, blocks, x, |_| false);
            if let Some(into) = into.get_mut(group as usize) {
                *into += vector(sum);
            }
        }
    }

    /// Adds the next graph's solution, and sweeps back.
    #[inline(always)]
    fn back(&self, r: &[Vec3], x: &mut [Vec3], next: Option<&[Vec3]>) {
        let times = if self.own.is_empty() { 1.0 } else { FURTHER };
        if let Some(next) = next {
            for (x, &into) in x.iter_mut().zip(self.graph.into) {
                *x += next.get(into as usize).copied().unwrap_or(Vec3::ZERO) * times;
            }
        }
        for ((row, &r), range) in r.iter().enumerate().zip(self.graph.ranges()).rev() {
            let (links, blocks) = self.row(range);
            let sum = less(quad(r), links, blocks, x, |_| false);
            if let Some(x) = x.get_mut(row) {
                *x = self.solved(row, sum);
            }
        }
    }

    /// The links of a row, and their blocks with the number behind.
    #[inline(always)]
    fn row(&self, range: core::ops::Range<usize>) -> (&[u32], &[f32]) {
        let blocks = self.blocks.get(BLOCK * range.start..BLOCK * range.end + 1);
        (self.graph.links.get(range).unwrap_or(&[]), blocks.unwrap_or(&[]))
    }

    #[inline(always)]
    fn solved(&self, row: usize, sum: f32x4) -> Vec3 {
        vector(times(block(self.diagonal, row), vector(sum)))
    }
}

/// A sum less the blocks of links times what they lead to, up to where it ends.
#[inline(always)]
fn less(mut sum: f32x4, links: &[u32], blocks: &[f32], x: &[Vec3], ends: impl Fn(usize) -> bool) -> f32x4 {
    let mut rest = blocks;
    for &other in links {
        let (Some(block), Some(&x)) = (rest.first_chunk(), x.get(other as usize)) else { break };
        if ends(other as usize) {
            break;
        }
        sum -= times(block, x);
        rest = &rest[BLOCK..];
    }
    sum
}

/// A block, and the number behind it.
#[inline(always)]
fn block(blocks: &[f32], number: usize) -> &[f32; BLOCK + 1] {
    let at = BLOCK * number;
    blocks.get(at..at + BLOCK + 1).and_then(|block| block.first_chunk()).unwrap_or(&[0.0; BLOCK + 1])
}

/// Adds to a block.
#[inline(always)]
fn add(blocks: &mut [f32], number: usize, numbers: &[f32; BLOCK + 1]) {
    if let Some(block) = blocks.get_mut(BLOCK * number..BLOCK * (number + 1)) {
        block.iter_mut().zip(numbers).for_each(|(sum, number)| *sum += number);
    }
}

#[inline(always)]
fn quad(v: Vec3) -> f32x4 {
    f32x4::new([v.x, v.y, v.z, 0.0])
}

#[inline(always)]
fn vector(quad: f32x4) -> Vec3 {
    let [x, y, z, _] = quad.to_array();
    Vec3::new(x, y, z)
}

/// A block times a vector; the last number is any.
#[inline(always)]
fn times(block: &[f32; BLOCK + 1], v: Vec3) -> f32x4 {
    // Four numbers from where each column begins on: the last one is not its own.
    let columns = [0, 3, 6].map(|i| f32x4::new(*block[i..].first_chunk().unwrap_or(&[0.0; 4])));
    columns[0] * f32x4::splat(v.x) + columns[1] * f32x4::splat(v.y) + columns[2] * f32x4::splat(v.z)
}

/// Puts the inverse of a symmetric block in its place. What rounding has made indefinite is taken for a little more than singular, and
/// what is no block, or zero, has an inverse of zero.
fn invert(numbers: &mut [f32]) {
    let [xx, xy, xz, _, yy, yz, _, _, zz] = *numbers else { return };
    let pivot = |left: f32, whole: f32| if left > 1e-6 * whole { left } else { 1e-6 * whole };
    // L D Lᵀ.
    let first = xx;
    let (l, m) = (xy / first, xz / first);
    let second = pivot(yy - l * xy, yy);
    let n = (yz - l * xz) / second;
    let third = pivot(zz - m * xz - n * n * second, zz);
    // The rows of L⁻¹.
    let (p, q) = (-l, l * n - m);
    let [i, j, k] = [first, second, third].map(|pivot| 1.0 / pivot);
    let column = |x, y, z| Vec3::new(x, y, z);
    let inverse = Mat3::from_cols(
        column(i + p * p * j + q * q * k, p * j - q * n * k, q * k),
        column(p * j - q * n * k, j + n * n * k, -n * k),
        column(q * k, -n * k, k),
    );
    let sound = first > 0.0 && j > 0.0 && k > 0.0 && inverse.is_finite();
    let inverse = if sound { inverse } else { Mat3::ZERO };
    numbers.copy_from_slice(&inverse.to_cols_array());
}
