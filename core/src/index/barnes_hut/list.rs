//! Lists of what is to be added, to be read in lanes.

use super::moments::Moments;
use crate::lanes::{LANES, NOWHERE};
use wide::f32x8;

/// A node or a source column by column, the first of them its coordinates and its weight.
pub(super) struct List<const COLUMNS: usize, const ROWS: usize> {
    columns: [[f32; ROWS]; COLUMNS],
    len: usize,
}

/// Columns of a node's moments: x, y, z, weight, the second moments, and the dipole.
pub(super) const MOMENTS: usize = 13;

impl<const COLUMNS: usize, const ROWS: usize> List<COLUMNS, ROWS> {
    pub(super) const EMPTY: Self = Self { columns: [[0.0; ROWS]; COLUMNS], len: 0 };

    pub(super) fn is_full(&self) -> bool {
        self.len == ROWS
    }

    pub(super) fn clear(&mut self) {
        self.len = 0;
    }

    /// Appends a row, or its first numbers, if the others will not be read.
    #[inline(always)]
    pub(super) fn push<const N: usize>(&mut self, row: [f32; N]) {
        let at = self.len;
        if at < ROWS {
            for (column, x) in self.columns.iter_mut().zip(row) {
                column[at] = x;
            }
            self.len = at + 1;
        }
    }

    /// Appends as much of a run as there is room for; returns how much that is.
    #[inline(always)]
    pub(super) fn push_run(&mut self, run: [&[f32]; COLUMNS]) -> usize {
        let n = run[0].len().min(ROWS - self.len);
        for (column, run) in self.columns.iter_mut().zip(run) {
            column[self.len..self.len + n].copy_from_slice(&run[..n]);
        }
        self.len += n;
        n
    }

    /// Fills the last block up with what has no weight; returns how many blocks there are.
    pub(super) fn pad(&mut self) -> usize {
        while !self.len.is_multiple_of(LANES) {
            self.push::<COLUMNS>(core::array::from_fn(|column| if column < 3 { NOWHERE } else { 0.0 }));
        }
        (self.len / LANES).min(ROWS / LANES)
    }

    /// The first columns of a block.
    #[inline(always)]
    pub(super) fn block<const N: usize>(&self, block: usize) -> [f32x8; N] {
        core::array::from_fn(|column| f32x8::new(self.columns[column].as_chunks().0[block]))
    }
}

impl<const ROWS: usize> List<MOMENTS, ROWS> {
    /// Appends a node by all its moments, the dipole among them if it has one.
    #[inline(always)]
    pub(super) fn push_all(&mut self, moments: &Moments, dipole: bool) {
        let ([x, y, z], [dx, dy, dz]) = (moments.center, moments.dipole);
        let [xx, yy, zz, xy, yz, zx] = moments.second;
        if dipole {
            self.push([x, y, z, moments.weight, xx, yy, zz, xy, yz, zx, dx, dy, dz]);
        } else {
            self.push([x, y, z, moments.weight, xx, yy, zz, xy, yz, zx]);
        }
    }
}
