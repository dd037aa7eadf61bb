//! Eight triangles, folds or particles taken side by side from where they lie one behind the other.

use super::membrane::Cell;
use crate::cloth::Hinge;
pub(super) use crate::lanes::gathered;
use crate::lanes::{Eight, LANES};
use glam::Vec3;

/// Chips without an operating system go one by one, as what is written for eight would be in their flash besides, and so do programs without
/// optimisation.
pub(super) const WIDE: bool = cfg!(not(one_by_one));

/// One number of each of eight structs, side by side.
macro_rules! column {
    ($like:ident, $all:ident, |$one:ident| $number:expr) => {{
        let [a, b, c, d, e, f, g, h] = $all;
        $like.of([
            column!(@of a, $one, $number),
            column!(@of b, $one, $number),
            column!(@of c, $one, $number),
            column!(@of d, $one, $number),
            column!(@of e, $one, $number),
            column!(@of f, $one, $number),
            column!(@of g, $one, $number),
            column!(@of h, $one, $number),
        ])
    }};
    (@of $this:ident, $one:ident, $number:expr) => {{
        let $one = $this;
        $number
    }};
}

/// One vector of each of eight structs, side by side.
macro_rules! vectors {
    ($like:ident, $all:ident, |$one:ident| $vector:expr) => {
        Vectors([
            column!($like, $all, |$one| $vector.x),
            column!($like, $all, |$one| $vector.y),
            column!($like, $all, |$one| $vector.z),
        ])
    };
}
pub(super) use {column, vectors};

/// How eight triangles are at rest: the numbers of their inverses, and areas.
#[inline(always)]
pub(super) fn at_rest<F: Eight>(like: F, cells: &[Cell; LANES]) -> ([F; 4], F) {
    let inverse = [
        column!(like, cells, |cell| cell.inverse[0]),
        column!(like, cells, |cell| cell.inverse[1]),
        column!(like, cells, |cell| cell.inverse[2]),
        column!(like, cells, |cell| cell.inverse[3]),
    ];
    (inverse, column!(like, cells, |cell| cell.area))
}

/// Eight of them, if there are as many from there on.
#[inline(always)]
pub(super) fn eight<T>(all: &[T], first: usize) -> Option<&[T; LANES]> {
    all.get(first..first + LANES)?.try_into().ok()
}

#[inline(always)]
pub(super) fn eight_mut<T>(all: &mut [T], first: usize) -> Option<&mut [T; LANES]> {
    all.get_mut(first..first + LANES)?.try_into().ok()
}

#[inline(always)]
pub(super) fn vector([x, y, z, _]: [f32; 4]) -> Vec3 {
    Vec3::new(x, y, z)
}

#[inline(always)]
pub(super) fn all_corners(hinges: &[Hinge; LANES]) -> [[u32; 4]; LANES] {
    let [a, b, c, d, e, f, g, h] = hinges;
    [a.corners(), b.corners(), c.corners(), d.corners(), e.corners(), f.corners(), g.corners(), h.corners()]
}
