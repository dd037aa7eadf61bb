//! How fast strains change between the solutions of what resists them.

use crate::lanes::{Lanes, Vectors};
use crate::math::{dot, min, sqrt};
use glam::Vec3;

/// The share of an edge's length by which others may move its ends against each other after it has been solved for that to be left out of its rate:
/// directions that others turn by more say nothing of those to come, and damping would drive what is heavy to and fro along them.
const LITTLE: f32 = 1.0 / 8.0;

/// The edges from which their change since counts as motion that damping brakes: as their own solution had `left` them. What others have made of
/// them, until the sub-step had `begun`, a solution takes back: that is no motion. Of what is not little against the edges (the root of the mean
/// square) less is left out, and in the end nothing, nor where nothing had been left. What moves all ends alike changes nothing.
pub(super) fn braked_from<const N: usize>(begun: [Vec3; N], left: [Vec3; N]) -> [Vec3; N] {
    let (mut others, mut turns) = (begun, 0.0);
    for (other, (&begun, left)) in others.iter_mut().zip(begun.iter().zip(left)) {
        *other = begun - left;
        turns += dot(*other, *other) / dot(begun, begun);
    }
    let share = 2.0 - sqrt(turns / N as f32) / LITTLE;
    if !(share > 0.0) {
        return begun;
    }
    let share = min(share, 1.0);
    core::array::from_fn(|i| begun[i] - others[i] * share)
}

/// As [`braked_from`], side by side. The first way of all is that of a corner to itself, and zero.
#[inline(always)]
pub(super) fn all_braked_from<F: Lanes, const N: usize>(
    like: F,
    begun: [Vectors<F>; N],
    left: [Vectors<F>; N],
) -> [Vectors<F>; N] {
    let (mut others, mut turns) = (begun, like.all(0.0));
    for ((other, &begun), left) in others.iter_mut().zip(&begun).zip(left).skip(1) {
        *other = begun - left;
        turns = turns + other.dot(*other) / begun.dot(begun);
    }
    let share = like.all(2.0) - (turns / like.all((N - 1) as f32)).sqrt() / like.all(LITTLE);
    let some = share.simd_gt(like.all(0.0));
    let share = share.lesser(like.all(1.0));
    let mut from = begun;
    for (from, other) in from.iter_mut().zip(others) {
        *from = Vectors::select(some, *from - other * share, *from);
    }
    from
}
