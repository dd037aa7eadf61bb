//! Some neighbours of a row, side by side.

use super::Room;
use super::room::SideBySide;
use super::sorted::Entry;
use crate::lanes::{self, Eight, Kernel, LANES};
use core::array;
use glam::Vec3;

/// Neighbours that are handed over at once.
pub(super) const RUN: usize = 32;

/// Room for a run and for what follows it in the last eight.
const FOUND: usize = RUN + LANES;

/// Stands for no other: whatever it is held against, it is not near.
pub(super) const NOBODY: Entry = Entry { x: [f32::NAN; 3], row: u32::MAX };

/// Others that are near a row, with the ways to them.
#[derive(Clone, Debug)]
pub struct Nearby {
    rows: [u32; FOUND],
    toward: [[f32; FOUND]; 3],
    square: [f32; FOUND],
    len: usize,
}

impl Nearby {
    pub(super) const NOBODY: Self = Self { rows: [0; FOUND], toward: [[0.0; FOUND]; 3], square: [0.0; FOUND], len: 0 };

    /// Their rows, in ascending order.
    #[must_use]
    pub fn rows(&self) -> &[u32] {
        &self.rows[..self.len]
    }

    /// The ways to them \[m\], coordinate by coordinate. Behind the last there are zeros up to the next multiple of eight.
    #[must_use]
    pub fn toward(&self) -> [&[f32; RUN]; 3] {
        let [x, y, z] = &self.toward;
        [run_of(x), run_of(y), run_of(z)]
    }

    /// Their distances squared \[m²\], and zeros likewise.
    #[must_use]
    pub fn square(&self) -> &[f32; RUN] {
        run_of(&self.square)
    }

    /// Takes in those of eight others that are hits, one behind the other: the ways to them, their squares and what stands for their rows.
    #[inline(always)]
    fn take<F: Eight>(&mut self, [x, y, z, rows]: [F; 4], hits: u32) {
        // Eight are written, and those that are no hits are written over.
        let ([x, y, z, rows], more) = F::squeezed([x, y, z, rows], hits);
        let (len, [to_x, to_y, to_z]) = (self.len, &mut self.toward);
        put(to_x, len, x.to_array());
        put(to_y, len, y.to_array());
        put(to_z, len, z.to_array());
        put(&mut self.square, len, (x * x + y * y + z * z).to_array());
        put(&mut self.rows, len, bytemuck::cast(rows.to_array()));
        self.len = len + more;
    }

    /// Hands over a run, if there is one, and keeps what follows it.
    #[inline(always)]
    fn hand_over_run(&mut self, row: usize, visit: &mut dyn FnMut(usize, &Self)) {
        let Some(rest) = self.len.checked_sub(RUN) else { return };
        self.len = RUN;
        visit(row, self);
        self.len = rest;
        self.rows.copy_within(RUN.., 0);
        self.square.copy_within(RUN.., 0);
        self.toward.iter_mut().for_each(|toward| toward.copy_within(RUN.., 0));
    }

    /// Hands over the last ones, with zeros behind them.
    #[inline(always)]
    fn hand_over_rest(&mut self, row: usize, visit: &mut dyn FnMut(usize, &Self)) {
        if self.len == 0 {
            return;
        }
        let (len, zeros, [x, y, z]) = (self.len, [0.0; LANES], &mut self.toward);
        put(x, len, zeros);
        put(y, len, zeros);
        put(z, len, zeros);
        put(&mut self.square, len, zeros);
        visit(row, self);
    }

    /// Visits a row at a place with those of some others that are within `reach` of it, in their order, by the shortest of all ways. The
    /// others come eight by eight, each time with how many of them count.
    #[inline(always)]
    pub(super) fn gather<F: Eight>(
        &mut self,
        like: F,
        (row, place): (usize, Vec3),
        others: impl Iterator<Item = ([Entry; LANES], usize)>,
        (reach, sides): (f32, Option<SideBySide<F>>),
        visit: &mut dyn FnMut(usize, &Self),
    ) {
        let (center, square) = (
            place.to_array().map(
                #[inline(always)]
                |x| like.all(x),
            ),
            like.all(reach * reach),
        );
        self.len = 0;
        for (eight, left) in others {
            let [x, y, z, rows] = like.quads_of(bytemuck::cast(eight));
            let mut ways = [x - center[0], y - center[1], z - center[2]];
            if let Some(sides) = sides {
                ways = sides.nearest(ways);
            }
            let [x, y, z] = ways;
            let hits = (x * x + y * y + z * z).simd_le(square).to_bitmask() & (0xff >> (LANES - left.min(LANES)));
            self.take([x, y, z, rows], hits);
            self.hand_over_run(row, visit);
        }
        self.hand_over_rest(row, visit);
    }
}

/// As many as are handed over at once.
#[inline(always)]
fn run_of(column: &[f32; FOUND]) -> &[f32; RUN] {
    column.first_chunk().unwrap_or(&[0.0; RUN])
}

/// Puts eight numbers into a column.
#[inline(always)]
fn put<T: Copy>(column: &mut [T; FOUND], at: usize, eight: [T; LANES]) {
    if let Some(room) = column.get_mut(at..).and_then(<[T]>::first_chunk_mut) {
        *room = eight;
    }
}

/// A visit to a row at a place with those of some others that are within reach of it. In a room all are wrapped in, and ways lead through
/// its sides.
pub(super) struct Visit<'v, I> {
    pub(super) own: (usize, Vec3),
    pub(super) others: I,
    pub(super) reach: f32,
    pub(super) room: Option<&'v Room>,
    pub(super) nearby: &'v mut Nearby,
    pub(super) visit: &'v mut dyn FnMut(usize, &Nearby),
}

impl<I: Iterator<Item = Entry>> Visit<'_, I> {
    /// Makes it.
    pub(super) fn pay(self) {
        lanes::run(self);
    }
}

impl<I: Iterator<Item = Entry>> Kernel for Visit<'_, I> {
    type Output = ();
    #[inline(always)]
    fn run<F: Eight>(self, like: F) {
        let Self { own, mut others, reach, room, nearby, visit } = self;
        let sides = room.map(|room| room.side_by_side(like));
        let eights = core::iter::from_fn(
            #[inline(always)]
            || {
                let first = others.next()?;
                let eight = array::from_fn(|k| if k == 0 { first } else { others.next().unwrap_or(NOBODY) });
                Some((eight, LANES))
            },
        );
        nearby.gather(like, own, eights, (reach, sides), visit);
    }
}
