//! Symmetric systems of equations with a narrow band, several side by side: factors and solutions without pivots.

use crate::lanes::widest;
use crate::memory::take;
use bytemuck::Pod;
use glam::Vec3;

/// How many numbers to either side of the diagonal are not zero.
pub(super) const REACH: usize = 14;
/// The numbers that are kept of a column: its diagonal and what is below it.
const COLUMN: usize = REACH + 1;

/// As many systems as lanes, each of as many equations as the largest; those that a lane does not need say that a number is zero.
pub(super) struct Band<'m, const LANES: usize> {
    /// The columns, one after the other; behind the last there are as many empty ones as the band reaches.
    entries: &'m mut [[f32; LANES]],
    /// The right side, and then the solution.
    right: &'m mut [[f32; LANES]],
    /// The number of equations.
    count: usize,
}

/// The words that systems of so many equations take.
pub(super) const fn words(equations: usize, lanes: usize) -> usize {
    equations.saturating_add(REACH).saturating_mul((COLUMN + 1) * lanes)
}

impl<'m, const LANES: usize> Band<'m, LANES>
where
    [f32; LANES]: Pod,
{
    /// Systems of so many equations, or of as many as there is memory for, that all say that a number is zero.
    pub(super) fn new(words: &'m mut [u32], equations: usize) -> Self {
        let mut rest = words;
        let columns = (rest.len() / ((COLUMN + 1) * LANES)).min(equations.saturating_add(REACH));
        let entries: &mut [[f32; LANES]] = bytemuck::cast_slice_mut(take(&mut rest, columns * COLUMN * LANES));
        let right: &mut [[f32; LANES]] = bytemuck::cast_slice_mut(take(&mut rest, columns * LANES));
        entries.fill([0.0; LANES]);
        right.fill([0.0; LANES]);
        entries.iter_mut().step_by(COLUMN).for_each(|diagonal| *diagonal = [1.0; LANES]);
        Self { entries, right, count: columns.saturating_sub(REACH) }
    }

    /// The number at a row and a column of one of the systems, which it has at the mirrored place as well.
    fn entry(&mut self, lane: usize, row: usize, column: usize) -> Option<&mut f32> {
        let (low, high) = if row < column { (row, column) } else { (column, row) };
        let below = high - low;
        if below > REACH || high >= self.count {
            return None;
        }
        self.entries.get_mut(low * COLUMN + below)?.get_mut(lane)
    }

    /// Sets it.
    pub(super) fn set(&mut self, lane: usize, row: usize, column: usize, to: f32) {
        if let Some(entry) = self.entry(lane, row, column) {
            *entry = to;
        }
    }

    /// Adds to it.
    pub(super) fn add(&mut self, lane: usize, row: usize, column: usize, more: f32) {
        if let Some(entry) = self.entry(lane, row, column) {
            *entry += more;
        }
    }

    /// Tells whether an equation says what pulls, bends or twists: what it is solved for is then below zero, solved or not.
    pub(super) fn is_strain(&self, lane: usize, row: usize) -> bool {
        self.entries.get(row * COLUMN).and_then(|pivot| pivot.get(lane)).is_some_and(|pivot| *pivot < 0.0)
    }

    /// Sets the right side of an equation.
    pub(super) fn ask(&mut self, lane: usize, row: usize, to: f32) {
        if let Some(right) = self.right.get_mut(row).and_then(|right| right.get_mut(lane)) {
            *right = to;
        }
    }

    /// A number of the solution.
    pub(super) fn answer(&self, lane: usize, row: usize) -> f32 {
        self.right.get(row).and_then(|right| right.get(lane)).copied().unwrap_or(0.0)
    }

    /// Three numbers of the solution, from this one on.
    pub(super) fn vector(&self, lane: usize, row: usize) -> Vec3 {
        Vec3::new(self.answer(lane, row), self.answer(lane, row + 1), self.answer(lane, row + 2))
    }

    /// Finds the factors L D Lᵀ of all of them, column by column.
    pub(super) fn factor(&mut self) {
        let Self { entries, count, .. } = self;
        widest(
            #[inline(always)]
            || {
                for first in 0..*count {
                    eliminate(&mut entries[first * COLUMN..]);
                }
            },
        );
    }

    /// Solves them for their right sides, once their factors are known.
    pub(super) fn solve(&mut self) {
        let Self { entries, right, count } = self;
        widest(
            #[inline(always)]
            || {
                for first in 0..*count {
                    go_on(column(entries, first), &mut right[first..]);
                }
                for first in (0..*count).rev() {
                    go_back(column(entries, first), &mut right[first..]);
                }
            },
        );
    }
}

/// The numbers that are kept of a column.
#[inline(always)]
fn column<const LANES: usize>(entries: &[[f32; LANES]], first: usize) -> &[[f32; LANES]] {
    &entries[first * COLUMN..][..COLUMN]
}

/// Takes the first column out of the others; leaves the column of L in its place and on the diagonal one over the pivot, which has its sign.
#[inline(always)]
fn eliminate<const LANES: usize>(entries: &mut [[f32; LANES]]) {
    let (column, others) = entries.split_at_mut(COLUMN);
    let pivot = column[0].map(|pivot| 1.0 / pivot);
    let full: [[f32; LANES]; COLUMN] = core::array::from_fn(|i| column[i]);
    for step in 1..COLUMN {
        let factor: [f32; LANES] = core::array::from_fn(|lane| full[step][lane] * pivot[lane]);
        let other = &mut others[(step - 1) * COLUMN..][..COLUMN];
        for (entry, from) in other.iter_mut().zip(&full[step..]) {
            for lane in 0..LANES {
                entry[lane] -= factor[lane] * from[lane];
            }
        }
        column[step] = factor;
    }
    column[0] = pivot;
}

/// Takes the first number out of the right side below it, and is left with that number over the pivot.
#[inline(always)]
fn go_on<const LANES: usize>(column: &[[f32; LANES]], right: &mut [[f32; LANES]]) {
    let (own, below) = right.split_at_mut(1);
    for (factor, below) in column[1..].iter().zip(below) {
        for lane in 0..LANES {
            below[lane] -= factor[lane] * own[0][lane];
        }
    }
    for lane in 0..LANES {
        own[0][lane] *= column[0][lane];
    }
}

/// Takes what is known by then out of the first number.
#[inline(always)]
fn go_back<const LANES: usize>(column: &[[f32; LANES]], right: &mut [[f32; LANES]]) {
    let (own, below) = right.split_at_mut(1);
    for (factor, known) in column[1..].iter().zip(&*below) {
        for lane in 0..LANES {
            own[0][lane] -= factor[lane] * known[lane];
        }
    }
}
