//! Motion that rounding swallows: steps so short, so far from the origin, that positions stay where they are.

use crate::math::min;
use crate::rows::{BLOCKS, flat};
use glam::Vec3;

/// A speed from which on motion counts \[m/s\], wherever it is.
const NOTABLE: f32 = 1.0 / 128.0;
/// The same as a share of the coordinate \[1/s\]: for worlds of small things.
const SHARE: f32 = 1.0 / 4096.0;
/// Rows that are looked at together.
const BLOCK: usize = 16;

/// Tells whether any particle may stall, if no coordinate is beyond `farthest` \[m\]: one that moves at a speed that
/// counts goes less than half the distance of two numbers, at most 2^-24 of the coordinate, in no step that is longer
/// than that share of it at `SHARE`, and shorter than that at `NOTABLE`. Room of a factor of two is for rounding.
pub(crate) fn may_be(farthest: f32, h: f32) -> bool {
    const LEAST: f32 = 2.0 / (SHARE * 16_777_216.0);
    const FARTHEST: f32 = 0.5 * NOTABLE * 16_777_216.0;
    !(h > LEAST && farthest < FARTHEST * h)
}

/// Counts those of these particles that stall in steps of `h` \[s\]: one of their coordinates would move at a notable
/// speed and stays where it is, as the step's way is less than half the distance of two numbers there.
pub(crate) fn count(position: &[Vec3], velocity: &[Vec3], h: f32) -> u64 {
    if !BLOCKS {
        return count_singly(position, velocity, h);
    }
    let mut stalled = 0;
    for (x, v) in position.chunks(BLOCK).zip(velocity.chunks(BLOCK)) {
        if may_hold_one(x, v, h) {
            stalled += count_singly(x, v, h);
        }
    }
    stalled
}

/// The same, looking at each.
fn count_singly(position: &[Vec3], velocity: &[Vec3], h: f32) -> u64 {
    let stalls = |(x, v): &(&Vec3, &Vec3)| flat_one(x).iter().zip(flat_one(v)).any(|(&x, &v)| is_swallowed(x, v, h));
    position.iter().zip(velocity).filter(stalls).count() as u64
}

fn flat_one(v: &Vec3) -> &[f32] {
    flat(core::slice::from_ref(v))
}

/// Tells whether any of a block may stall: hardly ever does one, so whole blocks are passed by, in a loop that
/// compilers make vectors of.
#[inline(always)]
fn may_hold_one(x: &[Vec3], v: &[Vec3], h: f32) -> bool {
    let any = |any: u32, (&x, &v): (&f32, &f32)| any | u32::from(may_be_swallowed(x, v, h));
    flat(x).iter().zip(flat(v)).fold(0, any) > 0
}

/// Tells whether a coordinate moves, at a speed that counts, and is where it was after a step: without shortcuts, so
/// that the loop has no branches.
#[inline(always)]
fn may_be_swallowed(x: f32, v: f32, h: f32) -> bool {
    (x + v * h == x) & (v.abs() > min(x.abs() * SHARE, NOTABLE))
}

/// The same of what is somewhere, in steps that take time.
#[cfg_attr(one_by_one, inline(never))]
fn is_swallowed(x: f32, v: f32, h: f32) -> bool {
    let is_motion = v.abs() > f32::MIN_POSITIVE && v.abs() < f32::INFINITY && x.abs() < f32::INFINITY;
    may_be_swallowed(x, v, h) && h > 0.0 && is_motion
}

#[cfg(test)]
mod tests {
    use super::*;

    fn stalls(x: f32, v: f32, h: f32) -> bool {
        count(&[Vec3::new(0.0, x, 0.0)], &[Vec3::new(0.0, v, 0.0)], h) == 1
    }

    #[test]
    fn what_rounding_swallows_stalls_and_nothing_else_does() {
        for (x, v, h) in
            [(1e3, 1.0, 2e-5), (-1e3, 1.0, 2e-5), (1e6, -1.0, 1.0 / 60.0), (1e-3, 1e-6, 2e-5), (2e11, 3e4, 0.1)]
        {
            assert!(stalls(x, v, h), "{x} {v} {h}");
        }
        // At rest, hardly moving, far beyond the next number, in no time, nowhere.
        for (x, v, h) in [
            (1e3, 0.0, 2e-5),
            (0.0, 0.0, 2e-5),
            (1e3, 1e-3, 1.0 / 60.0),
            (1.0, 1e-5, 1.0 / 720.0),
            (1e3, 10.0, 1.0 / 60.0),
            (1e3, 1.0, 0.0),
            (0.0, 1e-44, 0.01),
            (f32::INFINITY, 1.0, 0.01),
            (1e3, f32::NAN, 0.01),
            (f32::NAN, 1.0, 0.01),
        ] {
            assert!(!stalls(x, v, h), "{x} {v} {h}");
        }
    }

    /// A particle that is passed by unseen does not stall, up to the very edges of what is passed by.
    #[test]
    fn nobody_stalls_where_nobody_may() {
        let (mut seen, mut passed) = (0, 0);
        for i in 0..400 {
            let x = exp2(i % 40 - 15) * (1.0 + (i % 7) as f32 / 7.0);
            for h in [1e-5, 4.8e-4, 4.9e-4, 1e-3, 1.0 / 60.0, 0.3] {
                for v in [x * SHARE, NOTABLE, x * h, 1.0, 100.0] {
                    let fast = f32::from_bits(v.to_bits() + 1);
                    assert!(may_be(x, h) || !stalls(x, fast, h), "{x} {fast} {h}");
                    (seen, passed) = (seen + u32::from(stalls(x, fast, h)), passed + u32::from(!may_be(x, h)));
                }
            }
        }
        assert!(seen > 100 && passed > 100, "{seen} {passed}");
        assert!(may_be(f32::INFINITY, 0.01) && may_be(f32::NAN, 0.01) && may_be(1.0, 0.0));
    }

    fn exp2(power: i32) -> f32 {
        f32::from_bits(((127 + power) as u32) << 23)
    }

    #[test]
    fn each_particle_counts_once_wherever_its_row() {
        for len in 0..3 * BLOCK {
            let position: std::vec::Vec<Vec3> =
                (0..len).map(|i| Vec3::splat(if i % 3 == 0 { 1e3 } else { 1.0 })).collect();
            assert_eq!(count(&position, &std::vec![Vec3::ONE; len], 2e-5), len.div_ceil(3) as u64);
        }
    }
}
