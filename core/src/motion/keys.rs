//! Motion from key to key: smooth curves through places and rotations.

use super::Frame;
use crate::curve::{Curve, Over, Piece, inner_slope};
use crate::math::{divide, length, sin_cos_turns};
use crate::time::Time;
use core::f32::consts::TAU;
use glam::{Mat3, Vec3};

#[cfg(feature = "alloc")]
use alloc::vec::Vec;

/// An instant of a scripted motion: where something is then, and how it is turned.
///
/// Between two keys each number goes along a cubic that passes neither of them (Steffen, "A simple method for monotonic interpolation
/// in one dimension", A&A 239, 1990). Before the first and after the last key it stands still. Velocities have no jumps: it starts and
/// stops softly, and where the last key lies at the end of a period, goes on as it began.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Key {
    /// The instant \[s\].
    pub time: f32,
    /// The way from where it stood \[m\].
    #[cfg_attr(feature = "serde", serde(default))]
    #[cfg_attr(feature = "schema", schemars(with = "[f32; 3]"))]
    pub place: Vec3,
    /// The angles about x, then y, then z by which it is turned about the pivot, the axes standing still, of any size \[rad\].
    #[cfg_attr(feature = "serde", serde(default))]
    #[cfg_attr(feature = "schema", schemars(with = "[f32; 3]"))]
    pub rotation: Vec3,
}

/// The keys of a motion, in the order of their instants; `()` are none, for which nothing is linked.
pub trait Keys: Sync {
    /// All of them.
    fn all(&self) -> &[Key];

    /// Tells whether there is none.
    fn is_empty(&self) -> bool {
        self.all().is_empty()
    }
}

impl Keys for () {
    fn all(&self) -> &[Key] {
        &[]
    }
}

impl Keys for [Key] {
    fn all(&self) -> &[Key] {
        self
    }
}

impl<const N: usize> Keys for [Key; N] {
    fn all(&self) -> &[Key] {
        self
    }
}

impl<T: Keys + ?Sized> Keys for &T {
    fn all(&self) -> &[Key] {
        (**self).all()
    }
}

#[cfg(feature = "alloc")]
impl Keys for Vec<Key> {
    fn all(&self) -> &[Key] {
        self
    }
}

/// Why keys cannot be used, if they cannot.
pub(super) fn fault(keys: &[Key], period: f32) -> Option<&'static str> {
    let sound = |key: &Key| key.time.is_finite() && key.place.is_finite() && key.rotation.is_finite();
    if !keys.iter().all(sound) || !(0.0..f32::INFINITY).contains(&period) {
        Some("its keys have to be finite, and its period not to be below zero, in s")
    } else if keys.iter().any(|key| key.time < 0.0) || keys.windows(2).any(|two| two[1].time <= two[0].time) {
        Some("its keys have to be in the order of their times, from 0 on, no two at one time")
    } else if period > 0.0 && keys.last().is_some_and(|key| key.time > period) {
        Some("its keys have to lie within its period")
    } else {
        None
    }
}

/// A vector of curves at an instant: its value, its derivatives, and the largest of the second ones about there.
struct Led {
    value: Vec3,
    slope: Vec3,
    bend: Vec3,
    most: f32,
}

impl Led {
    /// Three pieces of curves.
    fn of([x, y, z]: [Piece; 3]) -> Self {
        let [[bend_x, from_x, to_x], [bend_y, from_y, to_y], [bend_z, from_z, to_z]] =
            [x.bends(), y.bends(), z.bends()];
        Self {
            value: Vec3::new(x.value(), y.value(), z.value()),
            slope: Vec3::new(x.slope(), y.slope(), z.slope()),
            bend: Vec3::new(bend_x, bend_y, bend_z),
            most: length(Vec3::new(from_x, from_y, from_z)).max(length(Vec3::new(to_x, to_y, to_z))),
        }
    }
}

/// The frame of what moves like `free` and is led by keys besides.
pub(super) fn led(free: &Frame, keys: &[Key], period: f32, at: Time) -> Frame {
    let at = match Time::from_seconds(period).ticks() {
        0 => at,
        period => Time::from_ticks(divide(u128::from(at.ticks()), period).1),
    };
    // Instants are compared and subtracted in ticks: late keys are as exact as early ones.
    let next = keys.partition_point(|key| Time::from_seconds(key.time) <= at);
    let since = next.checked_sub(1).map_or(0.0, |from| (at - Time::from_seconds(keys[from].time)).seconds());
    // A cubic between two keys hangs on one more on either side.
    let at = |place: usize| numbers(keys, period, next + place);
    let around = [at(0), at(1), at(2), at(3)];
    let piece = |number: usize| match next {
        0 => Piece::still(around[2][number]),
        _ if next == keys.len() => Piece::still(around[1][number]),
        _ => between(&around, number, since),
    };
    let (place, angles) = (Led::of([piece(1), piece(2), piece(3)]), Led::of([piece(4), piece(5), piece(6)]));
    let turning = Turning::of(&angles);
    let spin = turning.turn * free.spin;
    Frame {
        turn: turning.turn * free.turn,
        pivot: free.pivot,
        place: free.place + place.value,
        velocity: free.velocity + place.slope,
        acceleration: free.acceleration + place.bend,
        spin: turning.spin + spin,
        spin_up: turning.spin_up + turning.spin.cross(spin),
        bend: free.bend + place.most,
    }
}

/// The way of one of the numbers from the second of four keys to the third, so long after the former.
#[inline]
fn between(around: &[[f32; 7]; 4], number: usize, since: f32) -> Piece {
    let width = |from: usize| around[from + 1][0] - around[from][0];
    let widths = [width(0), width(1), width(2)];
    if !widths.iter().all(|&width| width > 0.0) {
        // They are so late that a second more is lost in rounding.
        return Curve { keys: around, over: Over::Seconds, smooth: true }.piece(number, 2, since);
    }
    let [from, to] = [around[1][number], around[2][number]];
    if from == to {
        // Slopes beside a level line are level.
        return Piece::still(from);
    }
    let secant = |from: usize| ((around[from + 1][number] - around[from][number]) / widths[from], widths[from]);
    let (before, own, after) = (secant(0), secant(1), secant(2));
    let slopes = [inner_slope(before, own), inner_slope(own, after)];
    Piece::smooth([from, to], slopes, widths[1], since / widths[1])
}

/// The numbers of the key two before the `number`-th, and of those that there would be beyond the ends: what stands still before the
/// first and after the last, or what goes on as it began.
fn numbers(keys: &[Key], period: f32, number: usize) -> [f32; 7] {
    let row = |key: &Key| {
        let (Vec3 { x, y, z }, turned) = (key.place, key.rotation);
        [key.time, x, y, z, turned.x, turned.y, turned.z]
    };
    if let Some(key) = number.checked_sub(2).and_then(|number| keys.get(number)) {
        return row(key);
    }
    let (first, last) = (row(&keys[0]), row(&keys[keys.len() - 1]));
    let goes_on = period > 0.0 && last[0] - first[0] >= period;
    // What it gains in each round.
    let moved = |numbers: [f32; 7], rounds: f32| core::array::from_fn(|i| numbers[i] + rounds * (last[i] - first[i]));
    let later = |numbers: [f32; 7], by: f32| {
        [numbers[0] + by, numbers[1], numbers[2], numbers[3], numbers[4], numbers[5], numbers[6]]
    };
    match number.checked_sub(2) {
        Some(number) if goes_on => moved(row(&keys[(number + 1) % keys.len()]), 1.0),
        Some(_) => later(last, 1.0),
        None if goes_on => moved(row(&keys[keys.len() - 2]), -1.0),
        None => later(first, -1.0),
    }
}

/// A rotation by angles about x, then y, then z, and how it changes.
struct Turning {
    turn: Mat3,
    spin: Vec3,
    spin_up: Vec3,
}

impl Turning {
    fn of(angles: &Led) -> Self {
        let trig = |angle: f32| if angle == 0.0 { (angle, 1.0) } else { sin_cos_turns(angle * (1.0 / TAU)) };
        let Vec3 { x, y, z } = angles.value;
        let ((sx, cx), (sy, cy), (sz, cz)) = (trig(x), trig(y), trig(z));
        // The axes about which x and y turn what is turned about them already, as those after them have turned these.
        let y = Vec3::new(-sz, cz, 0.0);
        let x = Vec3::new(cz * cy, sz * cy, -sy);
        let turn = Mat3::from_cols(
            x,
            Vec3::new(cz * sy * sx - sz * cx, sz * sy * sx + cz * cx, cy * sx),
            Vec3::new(cz * sy * cx + sz * sx, sz * sy * cx - cz * sx, cy * cx),
        );
        let [about_x, about_y, about_z] = [x * angles.slope.x, y * angles.slope.y, Vec3::Z * angles.slope.z];
        let carried = about_z.cross(about_y) + (about_z + about_y).cross(about_x);
        Self {
            turn,
            spin: about_x + about_y + about_z,
            spin_up: x * angles.bend.x + y * angles.bend.y + Vec3::Z * angles.bend.z + carried,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Motion, Script};
    use super::*;

    const KEYS: [Key; 4] = [
        Key { time: 0.5, place: Vec3::ZERO, rotation: Vec3::ZERO },
        Key { time: 1.0, place: Vec3::new(1.0, 2.0, 0.0), rotation: Vec3::new(0.3, -1.0, 7.0) },
        Key { time: 2.0, place: Vec3::new(1.0, 3.0, -4.0), rotation: Vec3::new(0.3, 2.0, 9.0) },
        Key { time: 2.5, place: Vec3::new(0.0, 0.0, -1.0), rotation: Vec3::new(-1.0, 0.0, 20.0) },
    ];

    fn motion(period: f32) -> Motion<[Key; 4]> {
        let steady =
            Motion { pivot: Vec3::new(1.0, -2.0, 0.5), spin: 0.4, axis: Vec3::new(1.0, 1.0, 0.0), ..Motion::STILL };
        let Motion { pivot, axis, spin, .. } = steady;
        Motion { pivot, axis, spin, swing: Vec3::X * 0.3, frequency: 0.7, ..Motion::with_keys(KEYS, period) }
    }

    #[test]
    fn keys_are_met_and_kept_at_both_ends() {
        let plain = Motion::with_keys(KEYS, 0.0);
        for (at, key) in [(0.0, 0), (0.5, 0), (1.0, 1), (2.0, 2), (2.5, 3), (1e6, 3)] {
            let frame = plain.frame(Time::from_seconds(at));
            assert_eq!(frame.place, KEYS[key].place, "at {at}");
            let Vec3 { x, y, z } = KEYS[key].rotation;
            let turn = Mat3::from_rotation_z(z) * Mat3::from_rotation_y(y) * Mat3::from_rotation_x(x);
            for column in 0..3 {
                assert!((frame.turn.col(column) - turn.col(column)).length() < 3e-6, "at {at}");
            }
        }
        assert_eq!(plain.frame(Time::from_seconds(9.0)).velocity, Vec3::ZERO);
    }

    #[test]
    fn velocities_and_accelerations_are_derivatives() {
        let motion = motion(0.0);
        let h = 1.0 / 1024.0;
        // Away from keys, where accelerations jump.
        for at in [0.7f32, 0.83, 1.2, 1.625, 2.125, 2.375, 3.0] {
            let frames = [at - h, at, at + h].map(|at| motion.frame(Time::from_seconds(at)));
            for point in [Vec3::ZERO, Vec3::new(3.0, 1.0, -2.0)] {
                let [before, here, after] = frames.each_ref().map(|frame| frame.world(point));
                let there = &frames[1];
                let velocity = (after - before) / (2.0 * h);
                let off = length(there.velocity_at(here) - velocity) / (1.0 + length(velocity));
                assert!(off < 2e-3, "at {at}: {velocity} against {}", there.velocity_at(here));
                let [before, _, after] = frames.each_ref().map(|frame| frame.velocity_at(frame.world(point)));
                let acceleration = (after - before) / (2.0 * h);
                let off = length(there.acceleration_at(here) - acceleration) / (1.0 + length(acceleration));
                assert!(off < 5e-3, "at {at}: {acceleration} against {}", there.acceleration_at(here));
                assert!(length(there.local(here) - point) < 1e-5);
            }
            assert!(length(frames[1].acceleration) <= frames[1].bend * 1.0001, "at {at}");
        }
    }

    #[test]
    fn keys_begin_again_after_their_period_however_late() {
        let motion = Motion::with_keys(KEYS, 3.0);
        for at in [0.25f32, 0.75, 1.5, 2.25, 2.875] {
            for round in [1, 1000, 1 << 20] {
                let late = Time::from_seconds(at) + Time::from_ticks(Time::from_seconds(3.0).ticks() * round);
                assert_eq!(motion.frame(late), motion.frame(Time::from_seconds(at)), "{round} rounds later");
            }
        }
    }

    #[test]
    fn velocities_have_no_jumps_at_keys_nor_where_a_period_begins_again() {
        let around =
            [0.0, 0.75, 1.5, 3.0].map(|time| Key { time, rotation: Vec3::Y * (TAU * time / 3.0), ..Key::default() });
        let swings = [(0.0, 1.0), (1.0, 2.0), (2.0, -1.0), (3.0, 1.0)];
        let swings = swings.map(|(time, x)| Key { time, place: Vec3::X * x, ..Key::default() });
        for (keys, period) in [(KEYS, 0.0), (KEYS, 2.75), (KEYS, 2.5), (around, 3.0), (swings, 3.0), (swings, 0.0)] {
            let motion = Motion::with_keys(keys, period);
            let h = Time::from_ticks(1 << 14);
            for at in keys.iter().map(|key| key.time).chain([period]).filter(|&at| at > 0.0) {
                // Where it is put back at a period's end, it may start anew.
                if at == period && keys[0].place != keys[3].place {
                    continue;
                }
                let at = Time::from_seconds(at);
                let [before, after] = [at - h, at + h].map(|at| motion.frame(at));
                assert!(length(before.velocity - after.velocity) < 1e-2, "{at:?} of {period}");
                assert!(length(before.spin - after.spin) < 1e-2, "{at:?} of {period}");
            }
        }
        // Evenly spread keys of a whole turn turn evenly.
        let frame = Motion::with_keys(around, 3.0).frame(Time::from_seconds(2.9));
        assert!((frame.spin.y - TAU / 3.0).abs() < 1e-4, "{}", frame.spin);
    }

    #[test]
    fn faulty_keys_are_told_apart() {
        assert_eq!(motion(0.0).fault(), None);
        assert_eq!(motion(2.5).fault(), None);
        assert!(motion(2.0).fault().is_some_and(|why| why.contains("period")));
        let mut swapped = KEYS;
        swapped.swap(1, 2);
        assert!(Motion::with_keys(swapped, 0.0).fault().is_some_and(|why| why.contains("order")));
        let endless = [Key { place: Vec3::INFINITY, ..KEYS[0] }];
        assert!(Motion::with_keys(endless, 0.0).fault().is_some_and(|why| why.contains("finite")));
    }
}
