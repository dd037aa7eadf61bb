//! A room whose opposite faces are one, and the shortest ways in it.

use super::SpatialIndex;
use crate::lanes::{Eight, negated};
use crate::math::{floor, largest, max, min};
use glam::Vec3;

/// A box whose opposite faces are one and the same: what leaves it at one comes in at the other, and ways between two points in it are the
/// shortest of those that lead through its sides (the minimum image).
///
/// ```
/// use pointmass::Vec3;
/// use pointmass::index::Room;
///
/// let room = Room::new(Vec3::ZERO, Vec3::new(10.0, 10.0, 0.0)); // It is open along z.
/// assert_eq!(room.wrap(Vec3::new(-1.0, 12.0, 99.0)), Vec3::new(9.0, 2.0, 99.0));
/// assert_eq!(room.nearest(Vec3::new(9.0, -4.0, 99.0)), Vec3::new(-1.0, -4.0, 99.0));
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Room {
    low: Vec3,
    /// Its sides \[m\]; zero where it is open.
    sides: Vec3,
    pub(super) code: RoomCode,
}

/// Counts the points within a distance \[m\] of a place, by an index of them if there is one. A function, so that a program without rooms does not
/// carry it about.
#[derive(Clone, Copy, Debug)]
pub(super) struct RoomCode(pub(super) fn(&Room, &Points<'_>, Vec3, f32) -> u64);

/// Points, and an index of them, if there is one.
pub(super) struct Points<'a> {
    pub(super) places: &'a [Vec3],
    pub(super) index: Option<&'a dyn SpatialIndex>,
}

impl PartialEq for Room {
    fn eq(&self, other: &Self) -> bool {
        (self.low, self.sides) == (other.low, other.sides)
    }
}

impl Room {
    /// All of space.
    pub const OPEN: Self = Self { low: Vec3::ZERO, sides: Vec3::ZERO, code: RoomCode(count_within) };

    /// A box from `low` on with these sides \[m\]. It is open along sides that are not positive and finite.
    #[must_use]
    pub fn new(low: Vec3, sides: Vec3) -> Self {
        let side = |low: f32, side: f32| if low.is_finite() && side > 0.0 && side.is_finite() { side } else { 0.0 };
        let sides = Vec3::new(side(low.x, sides.x), side(low.y, sides.y), side(low.z, sides.z));
        Self { low: Vec3::select(sides.cmpgt(Vec3::ZERO), low, Vec3::ZERO), sides, ..Self::OPEN }
    }

    /// Its lower corner \[m\]; zero along sides that are open.
    #[must_use]
    pub const fn low(&self) -> Vec3 {
        self.low
    }

    /// Its sides \[m\]; zero where it is open.
    #[must_use]
    pub const fn sides(&self) -> Vec3 {
        self.sides
    }

    /// Tells whether it is all of space.
    #[must_use]
    pub fn is_open(&self) -> bool {
        self.sides == Vec3::ZERO
    }

    /// Half of its shortest side \[m\], infinite if it is open: of two points nearer than that one way alone is the shortest.
    #[must_use]
    pub fn half(&self) -> f32 {
        let half = |side: f32| if side == 0.0 { f32::INFINITY } else { 0.5 * side };
        min(half(self.sides.x), min(half(self.sides.y), half(self.sides.z)))
    }

    /// How far a point lies from the lower corner once it is wrapped in.
    pub(super) fn offset(&self, point: Vec3) -> Vec3 {
        let side = |x: f32, low: f32, side: f32| {
            if side == 0.0 {
                return x;
            }
            let x = x - low;
            let x = x - side * floor(x / side);
            if x >= 0.0 && x < side { x } else { 0.0 }
        };
        let (low, sides) = (self.low, self.sides);
        Vec3::new(side(point.x, low.x, sides.x), side(point.y, low.y, sides.y), side(point.z, low.z, sides.z))
    }

    /// Where a point is in the room: itself, if it lies in it. What is no number stays so.
    #[must_use]
    #[inline]
    pub fn wrap(&self, point: Vec3) -> Vec3 {
        let side = |x: f32, low: f32, side: f32| {
            let is_there = side == 0.0 || x >= low && x < low + side;
            if is_there || !x.is_finite() { x } else { wrapped(x, low, side) }
        };
        let (low, sides) = (self.low, self.sides);
        Vec3::new(side(point.x, low.x, sides.x), side(point.y, low.y, sides.y), side(point.z, low.z, sides.z))
    }

    /// The shortest of the ways that a way from one point of the room to another stands for, and its opposite of the opposite.
    #[must_use]
    #[inline]
    pub fn nearest(&self, way: Vec3) -> Vec3 {
        let side = |d: f32, side: f32| match d {
            _ if side == 0.0 || d.abs() <= 0.5 * side => d,
            d if d > 0.0 => d - side,
            d => d + side,
        };
        Vec3::new(side(way.x, self.sides.x), side(way.y, self.sides.y), side(way.z, self.sides.z))
    }

    /// The shortest way from one point to another, wherever they are.
    #[must_use]
    #[inline]
    pub fn between(&self, from: Vec3, to: Vec3) -> Vec3 {
        self.nearest(self.wrap(to) - self.wrap(from))
    }

    /// How far the image of `to` that is nearest to `from` lies from it: by whole sides.
    #[must_use]
    pub(crate) fn image(&self, from: Vec3, to: Vec3) -> Vec3 {
        let side = |from: f32, to: f32, side: f32| {
            let turns = if side == 0.0 { 0.0 } else { floor((from - to) / side + 0.5) };
            if turns.is_finite() { turns * side } else { 0.0 }
        };
        let sides = self.sides;
        Vec3::new(side(from.x, to.x, sides.x), side(from.y, to.y, sides.y), side(from.z, to.z, sides.z))
    }

    /// More than what rounding may make of a distance \[m\] in it: points lie where they are, or beside a corner, or in an image.
    pub(crate) fn slack(&self) -> f32 {
        (largest(self.low) + largest(self.sides)) * (16.0 * f32::EPSILON)
    }

    /// The same for ways side by side.
    #[inline(always)]
    pub(super) fn side_by_side<F: Eight>(&self, like: F) -> SideBySide<F> {
        let half = |side: f32| if side == 0.0 { f32::INFINITY } else { 0.5 * side };
        let Vec3 { x, y, z } = self.sides;
        SideBySide {
            sides: [like.all(x), like.all(y), like.all(z)],
            half: [like.all(half(x)), like.all(half(y)), like.all(half(z))],
        }
    }
}

fn count_within(room: &Room, points: &Points<'_>, place: Vec3, radius: f32) -> u64 {
    let is_near = |point: &Vec3| {
        let d = between(Some(room), place, *point);
        radius >= 0.0 && d.x * d.x + d.y * d.y + d.z * d.z <= radius * radius
    };
    let Some(index) = points.index else { return points.places.iter().filter(|point| is_near(point)).count() as u64 };
    let mut count = 0;
    index.within(place, radius + room.slack(), &mut |rows| {
        let found = rows.iter().filter_map(|&row| points.places.get(row as usize));
        count += found.filter(|point| is_near(point)).count() as u64;
    });
    count
}

/// A coordinate that lies outside, wrapped in.
#[inline(never)]
fn wrapped(x: f32, low: f32, side: f32) -> f32 {
    let offset = (x - low) - side * floor((x - low) / side);
    let inside = low + max(offset, 0.0);
    if inside < low + side { inside } else { low }
}

/// A room, for eight ways at once.
#[derive(Clone, Copy)]
pub(super) struct SideBySide<F> {
    sides: [F; 3],
    half: [F; 3],
}

impl<F: Eight> SideBySide<F> {
    /// As [`Room::nearest`].
    #[inline(always)]
    pub(super) fn nearest(&self, [x, y, z]: [F; 3]) -> [F; 3] {
        [self.side(0, x), self.side(1, y), self.side(2, z)]
    }

    #[inline(always)]
    fn side(&self, axis: usize, d: F) -> F {
        let (side, half) = (self.sides[axis], self.half[axis]);
        d.simd_gt(half).select(d - side, d.simd_lt(negated(half)).select(d + side, d))
    }
}

/// A point in a room, if there is one.
#[inline(always)]
pub(crate) fn wrapped_in(room: Option<&Room>, point: Vec3) -> Vec3 {
    match room {
        Some(room) => room.wrap(point),
        None => point,
    }
}

/// The shortest way from one point to another, in a room if there is one.
#[inline(always)]
pub(crate) fn between(room: Option<&Room>, from: Vec3, to: Vec3) -> Vec3 {
    match room {
        Some(room) => room.between(from, to),
        None => to - from,
    }
}

/// The image of a point that is nearest to another, in a room if there is one.
pub(crate) fn image_beside(room: Option<&Room>, of: Vec3, point: Vec3) -> Vec3 {
    match room {
        Some(room) => of + room.between(of, point),
        None => point,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rng::Stream;
    use wide::f32x8;

    fn rooms() -> [Room; 4] {
        [
            Room::new(Vec3::ZERO, Vec3::splat(10.0)),
            Room::new(Vec3::new(-3.0, 1e3, 0.1), Vec3::new(0.7, 30.0, 0.0)),
            Room::new(Vec3::splat(-1e6), Vec3::splat(3.3)),
            Room::new(Vec3::splat(1e-20), Vec3::new(1e-15, 1e15, f32::NAN)),
        ]
    }

    #[test]
    fn points_are_wrapped_by_whole_sides_and_those_within_stay() {
        for (n, room) in (0..).zip(rooms()) {
            for i in 0..1000 {
                let ([x, y], [z, far]) = (Stream::new(1, n, i).units(0), Stream::new(1, n, i).units(1));
                let away = (Vec3::new(x, y, z) - 0.5) * (20.0 * far * far);
                let point = room.low() + (away + 0.5) * room.sides();
                let at = room.wrap(point);
                for axis in 0..3 {
                    let (side, low) = (room.sides()[axis], room.low()[axis]);
                    if side == 0.0 {
                        assert_eq!(at[axis], point[axis]);
                        continue;
                    }
                    assert!(at[axis] >= low && at[axis] < low + side || low + side == low, "{room:?}: {point} to {at}");
                    let turns = (f64::from(point[axis]) - f64::from(at[axis])) / f64::from(side);
                    let room = f64::from(point[axis].abs().max(low.abs()) / side + 1.0) * 4e-7;
                    assert!((turns - turns.round()).abs() <= room, "{turns} turns");
                }
                assert_eq!(room.wrap(at), at);
            }
        }
        assert!(rooms()[0].wrap(Vec3::NAN).is_nan() && rooms()[0].wrap(Vec3::INFINITY).x == f32::INFINITY);
    }

    #[test]
    fn ways_are_the_shortest_and_alike_both_ways_and_side_by_side() {
        for (n, room) in (0..).zip(rooms()) {
            for i in 0..1000 {
                let ([x, y], [z, _]) = (Stream::new(2, n, i).units(0), Stream::new(2, n, i).units(1));
                let way = (Vec3::new(x, y, z) * 2.0 - 1.0) * room.sides();
                let (there, back) = (room.nearest(way), room.nearest(-way));
                assert_eq!(there, -back);
                for axis in (0..3).filter(|&axis| room.sides()[axis] > 0.0) {
                    let side = room.sides()[axis];
                    let shortest = [-side, 0.0, side].map(|by| (way[axis] + by).abs()).into_iter().reduce(min);
                    assert_eq!(Some(there[axis].abs()), shortest);
                }
                let eight = room.side_by_side(f32x8::ZERO).nearest(way.to_array().map(f32x8::splat));
                assert_eq!(eight.map(|lanes| lanes.to_array()[2]), there.to_array());
            }
        }
    }
}
