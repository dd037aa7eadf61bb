//! A coarser graph's part of a shell's system: sweeps of Gauss and Seidel's method.

use super::mesh::Graph;
use glam::{Mat3, Vec3};
use wide::f32x4;

/// The numbers of a block: its columns one behind the other, and one more, so that four can be taken from where the last column begins.
pub(super) const BLOCK: usize = 10;

/// A vector, and some number behind it.
pub(super) type Quad = [f32; 4];

/// A coarser graph's part of the system.
#[derive(Default)]
pub(super) struct Level<'m> {
    pub(super) graph: Graph<'m>,
    /// The blocks of its links.
    pub(super) blocks: &'m mut [f32],
    /// Those of its rows with themselves before walls press; with these their inverses, zero for what does not move.
    pub(super) whole: &'m mut [f32],
    pub(super) inverse: &'m mut [f32],
    /// The right-hand side and the solution.
    pub(super) r: &'m mut [Quad],
    pub(super) x: &'m mut [Quad],
}

impl Level<'_> {
    /// Sums up blocks for the next graph.
    #[inline(always)]
    pub(super) fn sum_into(&self, coarse: &mut Level<'_>) {
        let blocks = self.blocks.as_chunks::<BLOCK>().0;
        for (row, &into) in self.graph.into.iter().enumerate() {
            add(coarse.whole, into as usize, block(self.whole, row));
            for link in self.graph.range(row) {
                let (Some(&other), Some(numbers)) = (self.graph.links.get(link), blocks.get(link)) else { continue };
                let Some(&other) = self.graph.into.get(other as usize) else { continue };
                if other == into {
                    add(coarse.whole, into as usize, numbers);
                } else if let Some(link) = coarse.graph.link(into as usize, other) {
                    add(coarse.blocks, link, numbers);
                }
            }
        }
    }

    /// x = (D + L)⁻¹ r.
    #[inline(always)]
    pub(super) fn forth(&mut self) {
        let x = core::mem::take(&mut self.x);
        let inverse = self.inverse.as_chunks::<BLOCK>().0;
        for (((row, &r), inverse), (links, blocks)) in self.r.iter().enumerate().zip(inverse).zip(self.rows()) {
            let mut left = f32x4::new(r);
            for (&other, block) in links.iter().zip(blocks) {
                let Some(&x) = x.get(other as usize).filter(|_| (other as usize) < row) else { break };
                left -= times(block, x);
            }
            if let Some(x) = x.get_mut(row) {
                *x = times(inverse, left.to_array()).to_array();
            }
        }
        self.x = x;
    }

    /// The residual after that, summed up for the next graph.
    #[inline(always)]
    pub(super) fn leave(&self, into: &mut [Quad]) {
        into.fill([0.0; 4]);
        for ((row, &group), (links, blocks)) in self.graph.into.iter().enumerate().zip(self.rows()) {
            let Some(into) = into.get_mut(group as usize) else { continue };
            let mut left = f32x4::new(*into);
            for (&other, block) in links.iter().zip(blocks).rev() {
                let Some(&x) = self.x.get(other as usize).filter(|_| other as usize > row) else { break };
                left -= times(block, x);
            }
            *into = left.to_array();
        }
    }

    /// Adds the next graph's solution, and sweeps back.
    #[inline(always)]
    pub(super) fn back(&mut self, next: Option<&[Quad]>) {
        let x = core::mem::take(&mut self.x);
        if let Some(next) = next {
            for (x, &into) in x.iter_mut().zip(self.graph.into) {
                let next = next.get(into as usize).copied().unwrap_or_default();
                *x = (f32x4::new(*x) + f32x4::new(next)).to_array();
            }
        }
        let inverse = self.inverse.as_chunks::<BLOCK>().0;
        for (((row, &r), inverse), (links, blocks)) in self.r.iter().enumerate().zip(inverse).zip(self.rows()).rev() {
            let mut left = f32x4::new(r);
            for (&other, block) in links.iter().zip(blocks) {
                let Some(&x) = x.get(other as usize) else { break };
                left -= times(block, x);
            }
            if let Some(x) = x.get_mut(row) {
                *x = times(inverse, left.to_array()).to_array();
            }
        }
        self.x = x;
    }

    /// The links of each row, and their blocks.
    #[inline(always)]
    fn rows(&self) -> impl DoubleEndedIterator<Item = (&[u32], &[[f32; BLOCK]])> + ExactSizeIterator {
        let (links, blocks) = (self.graph.links, self.blocks.as_chunks::<BLOCK>().0);
        self.graph.ranges().map(move |range| {
            let links = links.get(range.clone()).unwrap_or(&[]);
            (links, blocks.get(range).unwrap_or(&[]))
        })
    }
}

/// Adds to a block.
#[inline(always)]
pub(super) fn add(blocks: &mut [f32], number: usize, numbers: &[f32; BLOCK]) {
    if let Some(block) = blocks.get_mut(BLOCK * number..BLOCK * (number + 1)) {
        block.iter_mut().zip(numbers).for_each(|(sum, number)| *sum += number);
    }
}

/// A block of so many.
#[inline(always)]
fn block(blocks: &[f32], number: usize) -> &[f32; BLOCK] {
    blocks.as_chunks().0.get(number).unwrap_or(&[0.0; BLOCK])
}

/// A block times a vector; the last number is any.
#[inline(always)]
fn times(block: &[f32; BLOCK], [x, y, z, _]: Quad) -> f32x4 {
    // Four numbers from where each column begins on: the last one is not its own.
    let columns = [0, 3, 6].map(|i| f32x4::new(*block[i..].first_chunk().unwrap_or(&[0.0; 4])));
    columns[0] * f32x4::splat(x) + columns[1] * f32x4::splat(y) + columns[2] * f32x4::splat(z)
}

/// Puts the inverse of a symmetric block in its place. What rounding has made indefinite is taken for a little more than singular, and
/// what is no block, or zero, has an inverse of zero.
pub(super) fn invert(numbers: &mut [f32]) {
    let [xx, xy, xz, _, yy, yz, _, _, zz, _] = *numbers else { return };
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
    numbers.iter_mut().zip(inverse.to_cols_array()).for_each(|(number, inverse)| *number = inverse);
}
