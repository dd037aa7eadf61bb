//! Some neighbours of a row, side by side.

use crate::lanes::LANES;
use glam::Vec3;

/// Neighbours that are handed over at once.
pub(super) const RUN: usize = 32;

/// Others that are near a row, with the ways to them.
#[derive(Clone, Debug)]
pub struct Nearby {
    rows: [u32; RUN],
    toward: [[f32; RUN]; 3],
    square: [f32; RUN],
    len: usize,
}

impl Nearby {
    const NOBODY: Self = Self { rows: [0; RUN], toward: [[0.0; RUN]; 3], square: [0.0; RUN], len: 0 };

    /// Their rows, in ascending order.
    #[must_use]
    pub fn rows(&self) -> &[u32] {
        &self.rows[..self.len]
    }

    /// The ways to them \[m\], coordinate by coordinate. Behind the last there are zeros up to the next multiple of eight.
    #[must_use]
    pub fn toward(&self) -> [&[f32; RUN]; 3] {
        self.toward.each_ref()
    }

    /// Their distances squared \[m²\], and zeros likewise.
    #[must_use]
    pub fn square(&self) -> &[f32; RUN] {
        &self.square
    }

    /// Puts another to a place, and says whether it stays there: it is near.
    #[inline(always)]
    fn put(&mut self, k: usize, other: u32, d: Vec3, most: f32) -> bool {
        let square = d.x * d.x + d.y * d.y + d.z * d.z;
        self.rows[k] = other;
        (self.toward[0][k], self.toward[1][k], self.toward[2][k]) = (d.x, d.y, d.z);
        self.square[k] = square;
        square <= most
    }

    /// Hands the first `len` over.
    #[inline]
    fn hand_over(&mut self, len: usize, row: usize, visit: &mut dyn FnMut(usize, &Self)) {
        if len > 0 {
            for k in len..len.next_multiple_of(LANES) {
                self.square[k] = 0.0;
                self.toward.iter_mut().for_each(|toward| toward[k] = 0.0);
            }
            self.len = len;
            visit(row, self);
        }
    }
}

/// Visits a row at a place with those of some others that are within `reach` of it, in their order.
#[inline]
pub(super) fn in_runs(
    (row, place): (usize, Vec3),
    others: impl Iterator<Item = (u32, Vec3)>,
    reach: f32,
    visit: &mut dyn FnMut(usize, &Nearby),
) {
    let (mut nearby, mut len, square) = (Nearby::NOBODY, 0, reach * reach);
    for (other, at) in others {
        // Written before it is known whether it stays, so that there is no branch to guess.
        len += usize::from(nearby.put(len % RUN, other, at - place, square));
        if len == RUN {
            nearby.hand_over(len, row, visit);
            len = 0;
        }
    }
    nearby.hand_over(len, row, visit);
}
