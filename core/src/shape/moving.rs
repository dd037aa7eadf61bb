//! Walls that move as a script says: mills, pistons, conveyors.

use super::{Aabb, Affine, Collider, Contact, Facing, Hit, Hulls, Mapped, Marks, Ride, Segment};
use crate::math::{clamp, high, largest, length, low, max, sin_cos_turns, sqrt, unit};
use crate::time::Time;
use core::f32::consts::TAU;
use glam::{Mat3, Vec3};

/// How far the straight pieces of a path may stray from it in the frame of what turns \[m\], unless that takes more
/// than `MAX_PIECES` of them.
const PIECE_ERROR: f32 = 1e-4;

/// Into how many pieces a segment is cut at the most. They stray by an eighth of the bend over its square: in a step in
/// which something turns by an angle a, by a² / 512 of the distance from its axis.
const MAX_PIECES: u32 = 8;

/// How something moves that nothing stops: it turns about an axis, swings along a line and drifts, all at once.
///
/// Where it is is a closed form of the instant alone, as exact late as early: at time t the point x of it is at
/// pivot + R(x − pivot) + swing sin 2π(frequency t + phase) + drift t, where R turns by spin t about the axis.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default, deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Motion {
    /// A point of the axis that it turns about \[m\]; it swings and drifts along.
    #[cfg_attr(feature = "schema", schemars(with = "[f32; 3]"))]
    pub pivot: Vec3,
    /// The direction of that axis, of any length but zero.
    #[cfg_attr(feature = "schema", schemars(with = "[f32; 3]"))]
    pub axis: Vec3,
    /// Turns a second, counter-clockwise seen from where the axis points \[Hz\].
    pub spin: f32,
    /// How far it swings to either side, and along which line \[m\].
    #[cfg_attr(feature = "schema", schemars(with = "[f32; 3]"))]
    pub swing: Vec3,
    /// Swings a second \[Hz\].
    pub frequency: f32,
    /// Where in its swing it begins, in parts of a whole one: 0 in the middle, 0.25 at the far end.
    pub phase: f32,
    /// How it drifts \[m/s\].
    #[cfg_attr(feature = "schema", schemars(with = "[f32; 3]"))]
    pub drift: Vec3,
}

/// A collider that moves as a script says.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moving<C> {
    collider: C,
    /// None, if it stands still.
    motion: Option<Motion>,
    /// All that it ever reaches.
    reach: Aabb,
}

impl Motion {
    /// It stands still; its axis is y.
    pub const STILL: Self = Self {
        pivot: Vec3::ZERO,
        axis: Vec3::Y,
        spin: 0.0,
        swing: Vec3::ZERO,
        frequency: 0.0,
        phase: 0.0,
        drift: Vec3::ZERO,
    };

    /// Where it has moved everything by an instant.
    #[must_use]
    pub fn at(&self, instant: Time) -> Affine {
        let Pose { turn, pivot, place } = self.pose(instant);
        Affine { linear: turn, shift: place - turn * pivot }
    }

    /// Whether all its numbers are finite and it has an axis, if it turns.
    #[must_use]
    pub fn is_sound(&self) -> bool {
        let vectors = [self.pivot, self.axis, self.swing, self.drift];
        vectors.iter().all(|v| v.is_finite())
            && [self.spin, self.frequency, self.phase].iter().all(|x| x.is_finite())
            && (self.spin == 0.0 || unit(self.axis) != Vec3::ZERO)
    }

    /// Whether it never moves.
    #[must_use]
    pub fn is_still(&self) -> bool {
        self.spin == 0.0 && self.swing == Vec3::ZERO && self.drift == Vec3::ZERO
    }

    fn pose(&self, instant: Time) -> Pose {
        let (sway, _) = self.sway(instant);
        let place = self.pivot + self.swing * sway + self.drift * instant.seconds();
        let axis = unit(self.axis);
        if self.spin == 0.0 || axis == Vec3::ZERO {
            return Pose { turn: Mat3::IDENTITY, pivot: self.pivot, place };
        }
        // Rodrigues' formula, column by column.
        let (sin, cos) = sin_cos_turns(instant.turns(self.spin));
        let column = |v: Vec3| v * cos + axis.cross(v) * sin + axis * (axis.dot(v) * (1.0 - cos));
        let turn = Mat3::from_cols(column(Vec3::X), column(Vec3::Y), column(Vec3::Z));
        Pose { turn, pivot: self.pivot, place }
    }

    /// The sine and cosine of the swing.
    fn sway(&self, instant: Time) -> (f32, f32) {
        sin_cos_turns(instant.turns(self.frequency) + self.phase)
    }

    /// How what is at `point` at an instant moves \[m/s\].
    fn velocity(&self, point: Vec3, instant: Time) -> Vec3 {
        let (_, cos) = self.sway(instant);
        self.around(point - self.pose(instant).place) + self.swing * (TAU * self.frequency * cos) + self.drift
    }

    /// How its velocity changes there: toward the axis about which it turns, and toward the middle of its swing \[m/s²\].
    fn acceleration(&self, point: Vec3, instant: Time) -> Vec3 {
        let ((sin, _), pace) = (self.sway(instant), TAU * self.frequency);
        self.around(self.around(point - self.pose(instant).place)) - self.swing * (pace * pace * sin)
    }

    /// The axis' turning crossed with a vector \[1/s\].
    fn around(&self, v: Vec3) -> Vec3 {
        unit(self.axis).cross(v) * (TAU * self.spin)
    }

    /// Into how many pieces a segment has to be cut to be straight enough where the motion is none: a chord strays by
    /// at most |x''| / 8, and x'' is that of turning about the axis, of moving while turning, and of swinging.
    fn pieces(&self, segment: &Segment) -> u32 {
        let [start, end] = segment.during;
        let time = (end - start).seconds();
        let (angle, swung) = (TAU * self.spin.abs() * time, TAU * self.frequency * time);
        let place = self.pose(start).place;
        let far = max(length(segment.from - place), length(segment.to - self.pose(end).place));
        let way = length(segment.step()) + length(self.drift) * time + length(self.swing) * swung.abs();
        let bend = angle * (angle * far + 2.0 * way) + swung * swung * length(self.swing);
        let ratio = bend / (8.0 * PIECE_ERROR);
        // The cast rounds down and saturates.
        if ratio > 1.0 { (sqrt(ratio) as u32).saturating_add(1).min(MAX_PIECES) } else { 1 }
    }
}

impl Default for Motion {
    fn default() -> Self {
        Self::STILL
    }
}

/// Where it is at an instant: turned about the pivot, which has come to `place`.
struct Pose {
    turn: Mat3,
    pivot: Vec3,
    place: Vec3,
}

impl Pose {
    /// A point in the frame of what moves.
    fn local(&self, point: Vec3) -> Vec3 {
        self.turn.transpose() * (point - self.place) + self.pivot
    }

    /// A point of that frame in the world.
    fn world(&self, point: Vec3) -> Vec3 {
        self.turn * (point - self.pivot) + self.place
    }
}

impl<C> Moving<C> {
    /// Something that at time zero, before it has swung, lies within `bounds`, and moves like this.
    #[must_use]
    pub fn new(collider: C, bounds: &Aabb, motion: Motion) -> Self {
        let moves = !motion.is_still();
        Self { collider, motion: moves.then_some(motion), reach: if moves { reach(bounds, &motion) } else { *bounds } }
    }

    /// Something that stands still.
    #[must_use]
    pub const fn still(collider: C) -> Self {
        Self { collider, motion: None, reach: EVERYWHERE }
    }

    /// A box around all that it ever reaches.
    #[must_use]
    pub const fn reach(&self) -> Aabb {
        self.reach
    }
}

const EVERYWHERE: Aabb = Aabb { min: Vec3::NEG_INFINITY, max: Vec3::INFINITY };

/// All that something within `bounds` ever reaches.
fn reach(bounds: &Aabb, motion: &Motion) -> Aabb {
    let Aabb { min, max } = *bounds;
    let (min, max) = if motion.spin == 0.0 {
        (min, max)
    } else {
        let corner = high((min - motion.pivot).abs(), (max - motion.pivot).abs());
        (motion.pivot - length(corner), motion.pivot + length(corner))
    };
    let swing = motion.swing.abs();
    let (mut min, mut max) = (min - swing, max + swing);
    for axis in 0..3 {
        if motion.drift[axis] > 0.0 {
            max[axis] = f32::INFINITY;
        } else if motion.drift[axis] < 0.0 {
            min[axis] = f32::NEG_INFINITY;
        }
    }
    // Rounding turns and moves by a little; what is endless is everywhere.
    let room =
        (high(low(max.abs(), Vec3::MAX), low(min.abs(), Vec3::MAX)) + motion.pivot.abs()) * (16.0 * f32::EPSILON);
    let (min, max) = (min - room, max + room);
    if min.is_nan() || max.is_nan() { EVERYWHERE } else { Aabb { min, max } }
}

impl<C: Collider> Collider for Moving<C> {
    /// Follows the segment in the frame of what moves, in as many straight pieces as that takes: they share their ends,
    /// and which side an end lies on is a pure function of it and the instant.
    fn first_hit(&self, segment: &Segment) -> Option<Hit> {
        let Some(motion) = &self.motion else { return self.collider.first_hit(segment) };
        let count = motion.pieces(segment);
        let [start, end] = segment.during;
        let mut from = (motion.pose(start).local(segment.from), start);
        for piece in 1..=count {
            let share = piece as f32 / count as f32;
            let (there, instant) =
                if piece == count { (segment.to, end) } else { (segment.at(share), between(segment.during, share)) };
            let to = (motion.pose(instant).local(there), instant);
            let local = Segment { from: from.0, to: to.0, radius: segment.radius, during: [from.1, to.1] };
            if let Some(hit) = self.collider.first_hit(&local) {
                let time = clamp(((piece - 1) as f32 + hit.time) / count as f32, 0.0, 1.0);
                return Some(in_world(motion, segment, &local, Hit { time, ..hit }, hit.time));
            }
            from = to;
        }
        None
    }

    fn may_touch(&self, bounds: &Aabb) -> bool {
        if self.motion.is_none() { self.collider.may_touch(bounds) } else { self.reach.overlaps(bounds) }
    }

    fn mark_near(&self, hulls: &Hulls, marks: &mut Marks) {
        if self.motion.is_none() { self.collider.mark_near(hulls, marks) } else { hulls.near_box(&self.reach, marks) }
    }

    fn facing(&self, bounds: &Aabb) -> Facing {
        match self.motion {
            None => self.collider.facing(bounds),
            Some(_) if self.may_touch(bounds) => Facing::Several,
            Some(_) => Facing::Nothing,
        }
    }

    fn contacts(&self, center: Vec3, reach: f32, at: Time, visit: &mut dyn FnMut(&Contact)) {
        let Some(motion) = &self.motion else { return self.collider.contacts(center, reach, at, visit) };
        let pose = motion.pose(at);
        self.collider.contacts(pose.local(center), reach, at, &mut |contact| {
            let normal = pose.turn * contact.normal;
            let point = center - normal * contact.distance;
            let velocity = pose.turn * contact.velocity + motion.velocity(point, at);
            visit(&Contact { point, normal, velocity, ..*contact });
        });
    }

    fn carry(&self, point: Vec3, radius: f32, during: [Time; 2]) -> Vec3 {
        let Some(motion) = &self.motion else { return self.collider.carry(point, radius, during) };
        if self.first_hit(&Segment { from: point, to: point, radius, during }).is_none() {
            return point;
        }
        let [start, end] = during.map(|instant| motion.pose(instant));
        end.world(start.local(point))
    }

    fn ride(&self, seat: &Segment) -> Option<Ride> {
        let Some(motion) = &self.motion else { return self.collider.ride(seat) };
        let [start, end] = seat.during;
        let (pose, then) = (motion.pose(start), motion.pose(end));
        let from = pose.local(seat.from);
        let local = Segment { from, to: pose.local(seat.to), radius: seat.radius, during: [start; 2] };
        self.collider.first_hit(&local)?;
        let place = then.world(from);
        let velocity = [motion.velocity(seat.from, start), motion.velocity(place, end)];
        let acceleration = motion.acceleration(seat.from, start);
        Some(Ride { place, velocity, acceleration })
    }

    fn is_empty(&self) -> bool {
        self.collider.is_empty()
    }
}

impl<C: Mapped> Mapped for Moving<C> {
    /// Of what stands still.
    fn image(&self, map: &Affine, bounds: &Aabb, visit: &mut dyn FnMut(u32, &dyn Collider)) {
        if self.motion.is_none() {
            self.collider.image(map, bounds, visit);
        }
    }
}

/// A hit on a piece, told in the world. Its time is that of the segment.
fn in_world(motion: &Motion, segment: &Segment, piece: &Segment, hit: Hit, time: f32) -> Hit {
    let instant = between(piece.during, time);
    let pose = motion.pose(instant);
    let normal = pose.turn * hit.normal;
    let center = segment.at(hit.time);
    let velocity = motion.velocity(center - normal * segment.radius, instant);
    // How far the piece strays from the path toward the surface, and what turning and moving round.
    let strays = (pose.local(center) - piece.at(time)).dot(hit.normal).abs();
    let rounding = segment.slack(largest(motion.pivot) + largest(pose.place));
    Hit { normal, velocity: pose.turn * hit.velocity + velocity, slack: hit.slack + strays + rounding, ..hit }
}

/// The instant at a share of a span.
fn between([start, end]: [Time; 2], share: f32) -> Time {
    let ticks = ((end - start).ticks() as f32 * share) as u64;
    (start + Time::from_ticks(ticks)).min(end)
}
