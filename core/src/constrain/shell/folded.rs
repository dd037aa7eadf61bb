//! What comes of a shell's blocks: of each row with itself, of groups, and their inverses; eight rows side by side.

use super::finest::{Finest, Links, Own, WITHIN, eight_of};
use super::strips::{Entry, NONE};
use super::sweep::{BLOCK, Level, add};
use crate::constrain::walls::Wall;
use crate::lanes::{Eight, Kernel, LANES};
use crate::math::sqrt;
use glam::Mat3;

/// The share of what bending does to a particle that it does to its group: what goes on as one bends little.
const SHARE: f32 = 0.125;
/// Where the numbers of a symmetric block lie in a whole one.
const UPPER: [usize; 6] = [0, 3, 6, 4, 7, 8];
/// Where they lie if it is turned round.
const LOWER: [usize; 6] = [0, 1, 2, 4, 5, 8];
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
        let Finest { links: Links { strips, .. }, blocks, whole, mass, plate, bending, .. } = finest;
        mass.as_flattened_mut().fill(0.0);
        for (lane, weights) in weight.chunks(strips.len().max(1)).enumerate() {
            for (strip, &weight) in mass.iter_mut().zip(weights) {
                strip[lane] = if weight > 0.0 { 1.0 / weight } else { 0.0 };
            }
        }
        let (zero, bending) = (like.all(0.0), like.all(*bending));
        // Later strips have told earlier ones what is theirs when the turn of these comes.
        for (strip, mass) in mass.iter().enumerate().rev() {
            let mut sum = [zero; 6];
            let range = strips.all(strip);
            let near = plate.near.get(range.clone()).unwrap_or(&[]);
            for ((entry, block), near) in strips.each_mut(range, blocks).zip(near) {
                let (near, mut back) = (like.of(*near) * bending, [zero; 6]);
                for i in 0..6 {
                    sum[i] = entry.added(like, sum[i], zero - like.of(block[UPPER[i]]));
                    back[i] = like.of(block[LOWER[i]]);
                }
                for i in [0, 4, 8] {
                    block[i] = (like.of(block[i]) + near).to_array();
                }
                take_from(like, whole, &entry, back);
            }
            let (mass, edges) = (like.of(*mass), eight_of(like, plate.own, LANES * strip));
            for i in DIAGONAL {
                sum[i] = sum[i] + (mass + edges * bending);
            }
            for (to, sum) in whole.get_mut(strip).into_iter().flatten().zip(sum) {
                *to = ((like.of(*to) + sum) & mass.simd_gt(zero)).to_array();
            }
        }
    }
}

/// Takes numbers from those of the rows that an entry links with.
#[inline(always)]
fn take_from<F: Eight, const N: usize>(like: F, to: &mut [[[f32; LANES]; N]], entry: &Entry<'_>, parts: [F; N]) {
    if let Some(to) = entry.strip().and_then(|strip| to.get_mut(strip)) {
        for (to, part) in to.iter_mut().zip(parts) {
            *to = (like.of(*to) - part).to_array();
        }
        return;
    }
    for (i, part) in parts.into_iter().enumerate() {
        for (&slot, part) in entry.columns().iter().zip(part.to_array()) {
            if let Some(to) = to.get_mut(slot as usize / LANES) {
                to[i][slot as usize % LANES] -= part;
            }
        }
    }
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
        let Finest { links, blocks, whole, mass, plate, bending, into, .. } = finest;
        let bending = like.all(*bending);
        let (share, zero) = (like.all(SHARE - 1.0), like.all(0.0));
        for (strip, whole) in whole.iter().enumerate() {
            // What does not move has nothing that could be less.
            let moves = eight_of(like, mass.as_flattened(), LANES * strip).simd_gt(zero);
            let less = (eight_of(like, plate.own, LANES * strip) * share * bending) & moves;
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
            let (range, masses) = (links.strips.all(strip), mass.as_flattened());
            let (Some(near), Some(sums)) = (plate.near.get(range.clone()), links.sums.get(range.clone())) else {
                return;
            };
            for (((entry, block), near), sums) in links.strips.each(range, blocks).zip(near).zip(sums) {
                let (own, other) = (eight_of(like, masses, LANES * strip), entry.numbers(like, masses));
                let both = (entry.lent(like, own).simd_gt(zero) & other.simd_gt(zero)).to_bitmask();
                let near = like.of(*near) * bending;
                let [a, b, c, d, e, f, g, h, i] = block.map(
                    #[inline(always)]
                    |lanes| like.of(lanes),
                );
                let there = blocks_of([a - near, b, c, d, e - near, f, g, h, i - near]);
                let back = blocks_of([a - near, d, g, b, e - near, h, c, f, i - near]);
                for (sums, rows) in sums.iter().zip([there, back]) {
                    for (lane, (&to, block)) in sums.iter().zip(&rows).enumerate() {
                        if to != NONE && both & 1 << lane != 0 {
                            let blocks = if to & WITHIN == 0 { &mut *next.blocks } else { &mut *next.whole };
                            add(blocks, (to & !WITHIN) as usize, block);
                        }
                    }
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
        let all = self.inverse.iter_mut().zip(&mut *self.soft).zip(&*self.mass);
        for (strip, ((own, soft), mass)) in all.enumerate() {
            *soft = [0.0; LANES];
            for (entry, block) in self.links.strips.each(self.links.strips.mixed(strip), self.blocks) {
                let within = entry.within(strip);
                for lane in (0..LANES).filter(|lane| within & 1 << lane != 0) {
                    let held = 0.5 * sqrt(block.iter().map(|lanes| lanes[lane] * lanes[lane]).sum());
                    let rows = [entry.owner(lane), entry.columns()[lane] as usize % LANES];
                    if rows.iter().all(|&row| mass[row] > 0.0) {
                        for row in rows {
                            soft[row] += held;
                            DIAGONAL.into_iter().for_each(|i| own[i][row] += held);
                        }
                    }
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
