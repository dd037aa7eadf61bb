//! What comes of a shell's blocks: of each row with itself, of groups, and their inverses; eight rows side by side.

use super::finest::{Finest, Own, WITHIN, eight_of};
use super::strips::NONE;
use super::sweep::{BLOCK, Level, add};
use crate::constrain::walls::Wall;
use crate::lanes::{Eight, Kernel, LANES, not};
use crate::math::sqrt;
use glam::Mat3;

/// The share of what bending does to a particle that it does to its group: what goes on as one bends little.
const SHARE: f32 = 0.125;
/// Where the numbers of a symmetric block lie in a whole one.
const UPPER: [usize; 6] = [0, 3, 6, 4, 7, 8];
/// Those on its diagonal.
const DIAGONAL: [usize; 3] = [0, 3, 5];

/// Each row's block with itself: its mass, and against what others feel of it. What does not move has none at all.
pub(super) struct Settle<'a, 'm> {
    pub(super) finest: &'a mut Finest<'m>,
    /// Inverse masses; zero for what does not move.
    pub(super) weight: &'a [f32],
}

impl Kernel for Settle<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn run<F: Eight>(self, like: F) {
        let Self { finest, weight } = self;
        let Finest { links, blocks, whole, alone, plate, bending, x, .. } = finest;
        x.fill(0.0);
        for (lane, weights) in weight.chunks(links.strips.len().max(1)).enumerate() {
            for (strip, &weight) in x.as_chunks_mut::<LANES>().0.iter_mut().zip(weights) {
                strip[lane] = weight;
            }
        }
        let (weight, zero, one, bending) = (&**x, like.all(0.0), like.all(1.0), like.all(*bending));
        for (strip, (whole, alone)) in whole.iter_mut().zip(&mut **alone).enumerate() {
            let own = eight_of(like, weight, LANES * strip);
            let moves = own.simd_gt(zero);
            let (mut sum, mut left) = ([zero; 6], [zero; 9]);
            let range = links.strips.range(strip);
            for (entry, block) in range.clone().zip(blocks.get_mut(range).unwrap_or(&mut [])) {
                let both = moves & links.strips.numbers(like, weight, entry).simd_gt(zero);
                for (i, &number) in UPPER.iter().enumerate() {
                    sum[i] = sum[i] - like.of(block[number]);
                }
                let near = plate.near_of(like, entry) * bending;
                for (i, number) in block.iter_mut().enumerate() {
                    left[i] = left[i] - settled(like, number, i, near, both);
                }
            }
            for entry in links.strips.mixed(strip) {
                let (Some(block), owners) = (blocks.get_mut(entry), links.strips.owners(entry)) else { return };
                let both = links.strips.numbers(like, weight, entry).simd_gt(zero)
                    & owners.lent_number(like, own).simd_gt(zero);
                for (i, &number) in UPPER.iter().enumerate() {
                    sum[i] = owners.add_number(like, sum[i], zero - like.of(block[number]));
                }
                let near = plate.near_of(like, entry) * bending;
                for (i, number) in block.iter_mut().enumerate() {
                    left[i] = owners.add_number(like, left[i], zero - settled(like, number, i, near, both));
                }
            }
            let mass = one / own;
            let [edges, all] = plate.of_strip(like, strip);
            for i in 0..3 {
                sum[DIAGONAL[i]] = sum[DIAGONAL[i]] + (mass + edges * bending);
                left[4 * i] = left[4 * i] + (mass + all * bending);
            }
            for (whole, sum) in whole.iter_mut().zip(sum) {
                *whole = ((like.of(*whole) + sum) & moves).to_array();
            }
            for (alone, left) in alone.iter_mut().zip(left) {
                *alone = (left & moves).to_array();
            }
        }
    }
}

/// Adds to a number of blocks what bends along edges, zero where one of both does not move, and tells what it was there.
#[inline(always)]
fn settled<F: Eight>(like: F, number: &mut [f32; LANES], i: usize, near: F, both: F) -> F {
    let own = like.of(*number);
    *number = ((own + if i.is_multiple_of(4) { near } else { like.all(0.0) }) & both).to_array();
    own & not(both)
}

/// Sums up the finest's blocks for the next graph. Groups that go as one would bend sharply between each other: how they do is left out, and
/// what each does to itself is less.
pub(super) struct Sum<'a, 'm> {
    pub(super) finest: &'a Finest<'m>,
    pub(super) next: &'a mut Level<'m>,
}

impl Kernel for Sum<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn run<F: Eight>(self, like: F) {
        let Self { finest, next } = self;
        let Finest { links, blocks, whole, plate, bending, into, .. } = finest;
        let bending = like.all(*bending);
        let share = like.all(SHARE - 1.0);
        for (strip, whole) in whole.iter().enumerate() {
            let [own, _] = plate.of_strip(like, strip);
            let less = own * share * bending;
            let [xx, xy, xz, yy, yz, zz] = whole.map(
                #[inline(always)]
                |lanes| like.of(lanes),
            );
            let rows = blocks_of([xx + less, xy, xz, xy, yy + less, yz, xz, yz, zz + less]);
            for (row, block) in links.strips.rows(strip).into_iter().zip(&rows) {
                if let Some(&group) = into.get(row) {
                    add(next.whole, group as usize, block);
                }
            }
            for entry in links.strips.all(strip) {
                let (Some(block), Some(sums)) = (blocks.get(entry), links.sums.get(entry)) else { return };
                let near = plate.near_of(like, entry) * bending;
                let [a, b, c, d, e, f, g, h, i] = block.map(
                    #[inline(always)]
                    |lanes| like.of(lanes),
                );
                let rows = blocks_of([a - near, b, c, d, e - near, f, g, h, i - near]);
                for (&to, block) in sums.iter().zip(&rows).filter(|(to, _)| **to != NONE) {
                    let blocks = if to & WITHIN == 0 { &mut *next.blocks } else { &mut *next.whole };
                    add(blocks, (to & !WITHIN) as usize, block);
                }
            }
        }
    }
}

/// Eight blocks one after the other.
#[inline(always)]
fn blocks_of<F: Eight>([a, b, c, d, e, f, g, h, i]: [F; 9]) -> [[f32; BLOCK]; LANES] {
    let (first, second, last) = (F::rows_of([a, b, c, d]), F::rows_of([e, f, g, h]), i.to_array());
    let mut rows = [[0.0; BLOCK]; LANES];
    for (lane, row) in rows.iter_mut().enumerate() {
        let ([a, b, c, d], [e, f, g, h]) = (first[lane], second[lane]);
        *row = [a, b, c, d, e, f, g, h, last[lane], 0.0];
    }
    rows
}

impl Finest<'_> {
    /// Adds the stiffness of a wall to that of its particle, and tells it.
    pub(super) fn stiffen(&mut self, row: usize, wall: &Wall) -> Mat3 {
        let (strip, lane) = self.links.strips.at(row);
        let Some(own) = self.inverse.get_mut(strip) else { return Mat3::ZERO };
        let stiff = wall.stiffness(own[0][lane] + own[3][lane] + own[5][lane]);
        let numbers = stiff.to_cols_array();
        for (own, number) in own.iter_mut().zip(UPPER) {
            own[lane] += numbers[number];
        }
        stiff
    }
}

impl Finest<'_> {
    /// Adds to the blocks of rows with themselves a half of how hard others of their strips hold them, which sweeps take as they were: so that a
    /// sweep forth and one back never go too far.
    pub(super) fn soften(&mut self) {
        for (strip, (own, soft)) in self.inverse.iter_mut().zip(&mut *self.soft).enumerate() {
            *soft = [0.0; LANES];
            for entry in self.links.strips.all(strip) {
                let within = self.links.strips.within(entry);
                if within == 0 {
                    continue;
                }
                let Some(block) = self.blocks.get(entry) else { return };
                for lane in (0..LANES).filter(|lane| within & 1 << lane != 0) {
                    let held = 0.5 * sqrt(block.iter().map(|lanes| lanes[lane] * lanes[lane]).sum());
                    let row = self.links.strips.owner(entry, lane);
                    soft[row] += held;
                    DIAGONAL.into_iter().for_each(|i| own[i][row] += held);
                }
            }
        }
    }
}

/// Puts the inverses of symmetric blocks in their places, as `sweep::invert`.
pub(super) struct Invert<'a> {
    pub(super) all: &'a mut [Own],
}

impl Kernel for Invert<'_> {
    type Output = ();

    #[inline(always)]
    fn run<F: Eight>(self, like: F) {
        let (zero, one, most, least) = (like.all(0.0), like.all(1.0), like.all(f32::INFINITY), like.all(1e-6));
        for own in self.all {
            let [xx, xy, xz, yy, yz, zz] = own.map(
                #[inline(always)]
                |lanes| like.of(lanes),
            );
            // L D Lᵀ.
            let (l, m) = (xy / xx, xz / xx);
            let second = pivot(yy - l * xy, yy * least);
            let n = (yz - l * xz) / second;
            let third = pivot(zz - m * xz - n * n * second, zz * least);
            // The rows of L⁻¹.
            let (p, q) = (zero - l, l * n - m);
            let (i, j, k) = (one / xx, one / second, one / third);
            let (qk, nk) = (q * k, n * k);
            let inverse = [i + p * p * j + q * qk, p * j - q * nk, qk, j + n * nk, zero - nk, k];
            let mut sound = xx.simd_gt(zero) & j.simd_gt(zero) & k.simd_gt(zero);
            for number in inverse {
                sound = sound & number.abs().simd_lt(most);
            }
            for (own, number) in own.iter_mut().zip(inverse) {
                *own = (number & sound).to_array();
            }
        }
    }
}

#[inline(always)]
fn pivot<F: Eight>(left: F, least: F) -> F {
    left.simd_gt(least).select(left, least)
}
