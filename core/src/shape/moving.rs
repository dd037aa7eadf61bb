//! Walls that move as a script says: mills, pistons, conveyors.

use super::collider::contacts_among;
use super::{Aabb, Affine, Collider, Contact, Facing, Hit, Hulls, Mapped, Marks, Ride, Segment};
use crate::math::{along, clamp, dot, high, largest, length, low, max, sqrt};
use crate::motion::{EVERYWHERE, Frame, Motion, Script};
use crate::time::Time;
use glam::Vec3;

/// How far the straight pieces of a path may stray from it in the frame of what turns \[m\], unless that takes more
/// than `MAX_PIECES` of them.
const PIECE_ERROR: f32 = 1e-4;

/// Into how many pieces a segment is cut at the most, as long as none of them turns by more than `TURN`. They stray by an eighth of the bend over its square: in a
/// step in which something turns by an angle a, by a² / 512 of the distance from its axis.
const MAX_PIECES: u32 = 8;
/// The angle by which what turns may do so in a piece, and into how many pieces a segment is cut for that at the most: they stray by a thousandth of the distance from
/// the axis where something turns no more than sixteen times in a step.
const TURN: f32 = 0.1;
const MAX_TURNING_PIECES: u32 = 1024;

/// The largest number of times that what is carried along is pushed off what rounding put it behind: in a corner of three
/// faces, off each, and once more.
const MAX_PUSHES: u32 = 4;

/// A collider that moves as a script says. What it consists of should stand still in it: what rests on that is taken along by this motion alone.
/// A particle that leans on something which turns by more than a radian or so in a step is driven along it too far, by the acceleration that it has there as it comes to
/// lean: such motions want shorter steps.
///
/// ```
/// use pointmass::motion::{Key, Motion};
/// use pointmass::shape::{Cuboid, Moving, Surface};
/// use pointmass::{Gravity, Heap, Particle, Scene, System, Time, Vec3};
///
/// // A lift, which goes up by two metres from the first to the third second.
/// let floor = Cuboid { min: Vec3::new(-1.0, -0.1, -1.0), max: Vec3::new(1.0, 0.0, 1.0) };
/// let keys = [Key { time: 1.0, ..Key::default() }, Key { time: 3.0, place: Vec3::Y * 2.0, ..Key::default() }];
/// let lift = Moving::new(floor, &floor.bounds(), Motion::with_keys(keys, 0.0));
/// let start = [Particle { position: Vec3::Y * 0.2, elasticity: 0.0, ..Particle::REST }];
/// let scene = Scene { start: &start, forces: &Gravity::EARTH, colliders: &lift, ..Scene::EMPTY };
/// let mut system = System::with(Heap::new(scene.size()));
/// system.start(&scene, 1)?;
/// (1..=240).for_each(|frame| drop(system.step_to(&scene, Time::frame(frame, 60))));
/// assert!((system.particles().position[0].y - 2.0).abs() < 1e-3);
/// # Ok::<(), pointmass::InsufficientMemory>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moving<C, M = Motion> {
    collider: C,
    /// None, if it stands still.
    motion: Option<M>,
    /// All that it ever reaches.
    reach: Aabb,
    /// All that it reaches but for its drift \[m/s\].
    around: Aabb,
    drift: Vec3,
}

impl<C> Moving<C> {
    /// Something that stands still.
    #[must_use]
    pub const fn still(collider: C) -> Self {
        Self { collider, motion: None, reach: EVERYWHERE, around: EVERYWHERE, drift: Vec3::ZERO }
    }
}

impl<C, M: Script> Moving<C, M> {
    /// Something that at time zero, before it has swung, lies within `bounds`, and moves like this.
    #[must_use]
    pub fn new(collider: C, bounds: &Aabb, motion: M) -> Self {
        if motion.is_still() {
            return Self { reach: *bounds, around: *bounds, drift: Vec3::ZERO, motion: None, collider };
        }
        let (around, drift) = (motion.reach(bounds), motion.drift());
        Self { reach: onward(around, drift), around, drift, motion: Some(motion), collider }
    }

    /// A box around all that it ever reaches.
    #[must_use]
    pub const fn reach(&self) -> Aabb {
        self.reach
    }
}

impl<C, M> Moving<C, M> {
    /// Tells whether it is far from a box all the time between two instants: then nobody need ask where it is, which takes longer.
    fn is_far(&self, bounds: &Aabb, during: [Time; 2]) -> bool {
        let [from, to] = during.map(|instant| self.drift * instant.seconds());
        let (least, most) = (self.around.min + low(from, to), self.around.max + high(from, to));
        // Rounding moves by a little, and who touches by no more than that may be hit.
        let size = largest(least) + largest(most) + largest(bounds.min) + largest(bounds.max);
        let room = 2e-5 + 128.0 * f32::EPSILON * size;
        let (least, most) = (least - room, most + room);
        (bounds.min.cmpgt(most) | bounds.max.cmplt(least)).any()
    }
}

impl<C: Collider, M: Script> Moving<C, M> {
    /// Visits the contacts of all faces, or of some.
    fn visit(&self, faces: Option<&[u32]>, (center, reach): (Vec3, f32), at: Time, visit: &mut dyn FnMut(&Contact)) {
        let Some(motion) = &self.motion else {
            return contacts_among(&self.collider, faces, (center, reach), at, visit);
        };
        if self.is_far(&Aabb { min: center - reach, max: center + reach }, [at; 2]) {
            return;
        }
        let frame = motion.frame(at);
        contacts_among(&self.collider, faces, (frame.local(center), reach), at, &mut |contact| {
            let normal = frame.turn * contact.normal;
            let point = center - normal * contact.distance;
            let velocity = frame.turn * contact.velocity + frame.velocity_at(point);
            visit(&Contact { point, normal, velocity, ..*contact });
        });
    }
}

/// A box that drifts on from where it is without end.
fn onward(around: Aabb, drift: Vec3) -> Aabb {
    let Aabb { mut min, mut max } = around;
    for axis in 0..3 {
        if drift[axis] > 0.0 {
            max[axis] = f32::INFINITY;
        } else if drift[axis] < 0.0 {
            min[axis] = f32::NEG_INFINITY;
        }
    }
    Aabb { min, max }
}

/// The number of pieces into which a segment has to be cut to be straight enough in a frame that moves so from one to the other: a
/// chord strays by at most |x''| / 8, and x'' is that of turning about the pivot, of moving while turning, and of the pivot's own way.
fn pieces(segment: &Segment, ends: &[Frame; 2]) -> u32 {
    let [start, end] = segment.during;
    let time = (end - start).seconds();
    let most = |of: fn(&Frame) -> f32| max(of(&ends[0]), of(&ends[1]));
    let (angle, bend) = (most(|frame| length(frame.spin)) * time, most(|frame| frame.bend) * (time * time));
    let far = max(length(segment.from - ends[0].place), length(segment.to - ends[1].place));
    let way = length(segment.step()) + most(|frame| length(frame.velocity)) * time + bend;
    let turning = angle * (angle * far + 2.0 * way) + most(|frame| length(frame.spin_up)) * (time * time) * far;
    let ratio = (turning + bend) / (8.0 * PIECE_ERROR);
    // Casts round down and saturate.
    let straight = if ratio > 1.0 { (sqrt(ratio) as u32).saturating_add(1).min(MAX_PIECES) } else { 1 };
    straight.max(((angle / TURN) as u32).min(MAX_TURNING_PIECES))
}

impl<C: Collider, M: Script> Collider for Moving<C, M> {
    fn moves(&self) -> bool {
        self.motion.is_some() || self.collider.moves()
    }

    /// Follows the segment in the frame of what moves, in as many straight pieces as that takes: they share their ends,
    /// and which side an end lies on is a pure function of it and the instant.
    fn first_hit(&self, segment: &Segment) -> Option<Hit> {
        let Some(motion) = &self.motion else { return self.collider.first_hit(segment) };
        if self.is_far(&segment.bounds(), segment.during) {
            return None;
        }
        let [start, end] = segment.during;
        let ends = [motion.frame(start), motion.frame(end)];
        let count = pieces(segment, &ends);
        let mut from = (ends[0].local(segment.from), start);
        for piece in 1..=count {
            let share = piece as f32 / count as f32;
            let to = if piece == count {
                (ends[1].local(segment.to), end)
            } else {
                let instant = between(segment.during, share);
                (motion.frame(instant).local(segment.at(share)), instant)
            };
            let local = Segment { from: from.0, to: to.0, radius: segment.radius, during: [from.1, to.1] };
            if let Some(hit) = self.collider.first_hit(&local) {
                let time = clamp(((piece - 1) as f32 + hit.time) / count as f32, 0.0, 1.0);
                return Some(in_world(motion, segment, &local, Hit { time, ..hit }, hit.time));
            }
            from = to;
        }
        None
    }

    #[cfg(feature = "alloc")]
    fn solid(&self) -> Option<super::Solid> {
        if self.motion.is_none() { self.collider.solid() } else { None }
    }

    fn may_touch(&self, bounds: &Aabb) -> bool {
        if self.motion.is_none() { self.collider.may_touch(bounds) } else { self.reach.with_slack().overlaps(bounds) }
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
        self.visit(None, (center, reach), at, visit);
    }

    fn contacts_of(&self, faces: &[u32], center: Vec3, reach: f32, at: Time, visit: &mut dyn FnMut(&Contact)) {
        self.visit(Some(faces), (center, reach), at, visit);
    }

    fn carry(&self, point: Vec3, radius: f32, during: [Time; 2]) -> Vec3 {
        let Some(motion) = &self.motion else { return self.collider.carry(point, radius, during) };
        let way = Segment::waiting(point, radius, during);
        if self.first_hit(&way).is_none() {
            return point;
        }
        let [start, end] = during.map(|instant| motion.frame(instant));
        let from = start.local(point);
        self.pushed_off(&way, from, &end, end.world(from))
    }

    fn carry_on(&self, way: &Segment) -> Option<Vec3> {
        let Some(motion) = &self.motion else { return self.collider.carry_on(way) };
        let [start, end] = way.during.map(|instant| motion.frame(instant));
        let from = start.local(way.from);
        // Whom something else takes along goes as that goes, and not straight: it counts where it begins and ends.
        let taken = Segment { from, to: end.local(way.to), radius: way.radius, during: [way.during[1]; 2] };
        let Some(hit) = self.collider.first_hit(&taken) else { return Some(way.to) };
        // What leads along the surface is left to it.
        let normal = end.turn * hit.normal;
        let across = max(dot(end.world(from) - way.to, normal), 0.0);
        Some(self.pushed_off(way, from, &end, along(way.to, normal, across)))
    }

    fn ride(&self, seat: &Segment) -> Option<Ride> {
        let Some(motion) = &self.motion else { return self.collider.ride(seat) };
        let [start, end] = seat.during;
        let (frame, then) = (motion.frame(start), motion.frame(end));
        let from = frame.local(seat.from);
        let local = Segment { from, to: frame.local(seat.to), radius: seat.radius, during: [start; 2] };
        self.collider.first_hit(&local)?;
        let place = then.world(from);
        let velocity = [frame.velocity_at(seat.from), then.velocity_at(place)];
        let acceleration = frame.acceleration_at(seat.from);
        Some(Ride {
            place,
            velocity,
            acceleration,
            spin: [frame.spin, then.spin],
            turn: then.turn * frame.turn.transpose(),
        })
    }

    fn is_empty(&self) -> bool {
        self.collider.is_empty()
    }
}

impl<C: Mapped, M: Script> Mapped for Moving<C, M> {
    /// Answers only where it stands still.
    fn image(&self, map: &Affine, bounds: &Aabb, visit: &mut dyn FnMut(u32, &dyn Collider)) {
        if self.motion.is_none() {
            self.collider.image(map, bounds, visit);
        }
    }
}

impl<C: Collider, M> Moving<C, M> {
    /// A place on the side that a ball has been on, `from` in the frame, of which rounding may have put it behind what it was nearer to than that.
    fn pushed_off(&self, way: &Segment, from: Vec3, end: &Frame, mut place: Vec3) -> Vec3 {
        let Segment { radius, during, .. } = *way;
        for _ in 0..MAX_PUSHES {
            let moved = Segment { from, to: end.local(place), radius, during: [during[1]; 2] };
            let Some(hit) = self.collider.first_hit(&moved) else { break };
            let rounding = Segment { to: place, ..*way }.slack(size(end));
            place += end.turn * hit.normal * (2.0 * (hit.slack + rounding));
        }
        place
    }
}

/// A hit on a piece, told in the world. Its time is that of the segment.
fn in_world(motion: &impl Script, segment: &Segment, piece: &Segment, hit: Hit, time: f32) -> Hit {
    let instant = between(piece.during, time);
    let frame = motion.frame(instant);
    let normal = frame.turn * hit.normal;
    let center = segment.at(hit.time);
    let velocity = frame.velocity_at(center - normal * segment.radius);
    // How far the piece strays from the path toward the surface, and what turning and moving round.
    let strays = (frame.local(center) - piece.at(time)).dot(hit.normal).abs();
    let rounding = segment.slack(size(&frame));
    Hit { normal, velocity: frame.turn * hit.velocity + velocity, slack: hit.slack + strays + rounding, ..hit }
}

/// How far from the origin a frame's numbers are \[m\], which says what rounding does to places in it.
fn size(frame: &Frame) -> f32 {
    largest(frame.pivot) + largest(frame.place)
}

/// The instant at a share of a span.
fn between([start, end]: [Time; 2], share: f32) -> Time {
    let ticks = ((end - start).ticks() as f32 * share) as u64;
    (start + Time::from_ticks(ticks)).min(end)
}
