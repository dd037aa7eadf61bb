//! Some neighbours of a row, side by side.

use super::Room;
use super::sorted::Entry;
use crate::lanes::LANES;
use glam::Vec3;
use wide::f32x4;

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

    /// Takes the first `len` of some others than a row at a place, and hands them over, with the shortest ways to them.
    #[inline]
    fn hand_over(
        &mut self,
        (found, len): (&[f32x4; FOUND], usize),
        (row, place): (usize, Vec3),
        shortest: impl Fn([f32x4; 3]) -> [f32x4; 3],
        visit: &mut dyn FnMut(usize, &Self),
    ) {
        if len == 0 {
            return;
        }
        let ([to_x, to_y, to_z], center) = (&mut self.toward, place.to_array().map(f32x4::splat));
        for (k, four) in found.as_chunks().0.iter().enumerate().take(len.div_ceil(4)) {
            let (ways, rows) = ways(*four, center);
            let [x, y, z] = shortest(ways);
            put(to_x, k, x);
            put(to_y, k, y);
            put(to_z, k, z);
            put(&mut self.square, k, x * x + y * y + z * z);
            put(bytemuck::cast_mut(&mut self.rows), k, rows);
        }
        for k in len..len.next_multiple_of(LANES) {
            self.square[k] = 0.0;
            self.toward.iter_mut().for_each(|toward| toward[k] = 0.0);
        }
        self.len = len;
        visit(row, self);
    }
}

/// Puts four numbers into a column.
#[inline(always)]
fn put(column: &mut [f32; RUN], k: usize, lanes: f32x4) {
    if let Some(four) = column.as_chunks_mut().0.get_mut(k) {
        *four = lanes.to_array();
    }
}

/// The ways from a place to four others, and what their rows are, side by side.
#[inline(always)]
fn ways(four: [f32x4; 4], center: [f32x4; 3]) -> ([f32x4; 3], f32x4) {
    let [x, y, z, rows] = f32x4::transpose(four);
    ([x - center[0], y - center[1], z - center[2]], rows)
}

/// Stands for no other: whatever it is held against, it is not near.
pub(super) const NOBODY: Entry = Entry { x: [f32::NAN; 3], row: u32::MAX };

/// Room for a run and what follows it in the last four; a power of two, so that no place in it needs a check.
const FOUND: usize = 2 * RUN;

/// Room to bring neighbours together in.
pub(super) struct Runs {
    /// Places and rows of the near.
    found: [f32x4; FOUND],
    nearby: Nearby,
}

impl Runs {
    pub(super) const EMPTY: Self = Self { found: [f32x4::ZERO; FOUND], nearby: Nearby::NOBODY };

    /// Visits a row at a place with those of some others, four by four, that are within `reach` of it, in their order. In a room all are
    /// wrapped in, and ways lead through its sides.
    #[inline]
    pub(super) fn visit(
        &mut self,
        own: (usize, Vec3),
        others: impl Iterator<Item = [Entry; 4]>,
        reach: f32,
        room: Option<&Room>,
        visit: &mut dyn FnMut(usize, &Nearby),
    ) {
        match room.map(Room::side_by_side) {
            None => self.gather(own, others, reach, |ways| ways, visit),
            Some(room) => self.gather(own, others, reach, |ways| room.nearest(ways), visit),
        }
    }

    /// The same by the shortest of all ways.
    #[inline]
    fn gather(
        &mut self,
        (row, place): (usize, Vec3),
        others: impl Iterator<Item = [Entry; 4]>,
        reach: f32,
        shortest: impl Fn([f32x4; 3]) -> [f32x4; 3],
        visit: &mut dyn FnMut(usize, &Nearby),
    ) {
        let (center, square) = (place.to_array().map(f32x4::splat), f32x4::splat(reach * reach));
        let mut len = 0;
        for four in others {
            let four = four.map(bytemuck::cast);
            let [x, y, z] = shortest(ways(four, center).0);
            let hits = (x * x + y * y + z * z).simd_le(square).to_bitmask() as usize;
            for (k, other) in four.into_iter().enumerate() {
                // Written whether it is near or not, and then written over, so that there is no branch to guess.
                self.found[len % FOUND] = other;
                len += hits >> k & 1;
            }
            if len >= RUN {
                self.nearby.hand_over((&self.found, RUN), (row, place), &shortest, visit);
                self.found.copy_within(RUN..RUN + 4, 0);
                len -= RUN;
            }
        }
        self.nearby.hand_over((&self.found, len), (row, place), &shortest, visit);
    }
}
