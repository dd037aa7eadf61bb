//! One particle's way through a step: hit by hit.

use super::air::Braked;
use super::lead::Lead;
use super::path::{Cubic, MAX_CHORDS, Path};
use super::slide::Slide;
use super::tile::Obstacles;
use crate::material::on_surface;
use crate::math::{along, dot, is_zero, largest, length, max, min, minus, plus, unit};
use crate::observe::{Impact, Observer, Sliding};
use crate::particles::Id;
use crate::reap::PendingDeath;
use crate::report::Report;
use crate::shape::{Aabb, Collider, Contact, Facing, Hit, Segment};
use glam::Vec3;

/// How far what rests may be from its surface \[slacks\]: it is set off by two, and from corners by more.
pub(super) const LAIN: f32 = 8.0;

/// The largest number of times that the instant of a hit is looked for on the path. Newton's method takes three to six;
/// halving, where it fails, comes within 10 µs of a step of a second.
pub(super) const MAX_LOOKS: u32 = 16;

/// The number of parts of a chord in which a hit is sought again that lies far along the surface from where the chord meets it.
const PARTS_OF_CHORD: u8 = 8;

/// A rebound that would be over within this part of a step is none: the particle rests on the surface.
pub(crate) const RESTING: f32 = 0.25;

/// How a path ends.
pub(super) struct Arrival {
    pub(super) position: Vec3,
    pub(super) velocity: Vec3,
    pub(super) pending_death: PendingDeath,
}

/// Where a path meets something.
pub(super) struct Meeting {
    /// The fraction of the whole path before it, and the place on the path \[m\].
    pub(super) time: f32,
    pub(super) place: Vec3,
    /// The chord along which it was found, and the fraction of the path before that.
    pub(super) chord: Segment,
    pub(super) begun: f32,
    pub(super) hit: Hit,
    /// True if what it meets removes it.
    pub(super) is_sink: bool,
}

/// The means to follow one particle past walls of a kind: any, or one that is known, for which the same is shorter.
pub(super) struct Sweep<'a, C: ?Sized = dyn Collider + 'a> {
    pub(super) obstacles: &'a Obstacles<'a>,
    /// The walls that it may run into, and the sinks that remove it, if there are any.
    pub(super) walls: &'a C,
    pub(super) sinks: Option<&'a dyn Collider>,
    pub(super) id: Id,
    pub(super) row: usize,
    pub(super) radius: f32,
    pub(super) mass: f32,
    pub(super) elasticity: f32,
    pub(super) material: Option<u16>,
    /// The velocity that constraints have left it \[m/s\], if they have moved it: such goes straight to where they have put it, and hits answer this
    /// velocity beside that of the way, which it keeps where it meets nothing.
    pub(super) left: Option<&'a mut Vec3>,
    /// It in the air, if forces may depend on its velocity.
    pub(super) air: Option<Braked<'a>>,
    /// The step \[s\].
    pub(super) dt: f32,
    pub(super) report: &'a mut Report,
    /// Whoever wants to know of hits.
    pub(super) observer: Option<&'a mut dyn Observer>,
}

impl Meeting {
    /// The end in a sink.
    pub(super) fn arrival(&self, path: &Path) -> Arrival {
        Arrival { position: self.place, velocity: path.velocity(self.time), pending_death: PendingDeath::Sink }
    }

    /// Puts it to where a piece of the path that spans such a part of it meets the surface, unless that is the plane by whose crossing it is there already.
    #[cfg_attr(one_by_one, inline(never))]
    pub(super) fn put_nearer(
        &mut self,
        path: &Path,
        cubic: &Cubic,
        near: Hit,
        piece: &Segment,
        [from, to]: [f32; 2],
        place: Vec3,
    ) {
        let hit = core::mem::replace(&mut self.hit, near);
        let drift = [&hit, &near].map(|hit| dot(hit.velocity, hit.normal) * path.duration());
        let (found, nearby) = (from + (to - from) * near.time, piece.at(near.time));
        let is_flat = near.normal == hit.normal && drift == [0.0; 2];
        if !(is_flat && dot(minus(nearby, place), hit.normal).abs() <= 0.5 * near.slack) {
            let time = crossing(cubic, drift[1], &near, nearby, [from, found, to]);
            (self.time, self.place) = (time, cubic.at(time));
        }
    }

    /// The same on a path of which that where it was found is the first `share`.
    pub(super) fn within(self, share: f32) -> Self {
        Self { time: self.time * share, begun: self.begun * share, ..self }
    }
}

impl<'a, C: Collider + ?Sized> Sweep<'a, C> {
    /// The same past other walls.
    pub(super) fn past<W: Collider>(self, walls: &'a W) -> Sweep<'a, W> {
        let Self {
            obstacles, sinks, id, row, radius, mass, elasticity, material, left, air, dt, report, observer, ..
        } = self;
        Sweep { obstacles, walls, sinks, id, row, radius, mass, elasticity, material, left, air, dt, report, observer }
    }

    /// Its way through the step, if it may touch anything.
    #[inline(always)]
    pub(super) fn travel(&mut self, path: &Path, is_newborn: bool, may_lie: bool) -> Option<Arrival> {
        let lying = if may_lie { self.lying(path) } else { None };
        let (path, slack) = match lying {
            Some(along) => along,
            None if !self.may_touch(&path.hull(self.radius)) => return None,
            None if is_newborn => (self.let_go(path), 0.0),
            None if path.lags() => (self.pressed_on(path), 0.0),
            None => (*path, 0.0),
        };
        Some(self.follow(path, slack))
    }

    /// Tells whether a path inside a box may meet anything.
    fn may_touch(&self, hull: &Aabb) -> bool {
        self.walls.may_touch(hull) || self.sinks.is_some_and(|sinks| sinks.may_touch(hull))
    }

    /// A newborn's path without the surface of its source.
    #[cfg_attr(one_by_one, inline(never))]
    pub(super) fn let_go(&self, path: &Path) -> Path {
        let mut path = *path;
        let_go(self.walls, self.sinks, &mut path, self.dt);
        path
    }

    /// A path whose end lags behind its velocities, as these tell it where it begins on a surface: it would go on freely
    /// past what it is pressed onto, and meet that only a step later.
    #[cfg_attr(one_by_one, inline(never))]
    pub(super) fn pressed_on(&mut self, path: &Path) -> Path {
        let pressed = path.caught_up();
        match self.first_meeting(&pressed) {
            Some(meeting) if !meeting.is_sink && has_touched(&pressed, &meeting) => pressed,
            _ => *path,
        }
    }

    /// The way of what lies on one surface that stands still, and is pressed on to it: along that, from its own place; and the slack of that.
    #[inline(never)]
    pub(super) fn lying(&mut self, path: &Path) -> Option<(Path, f32)> {
        let acceleration = path.acceleration();
        let (seat, faces) = self.seat(path, acceleration)?;
        if faces > 1 {
            return self.lying_in_crease(path, &seat).map(|along| (along, seat.slack));
        }
        let mixed = on_surface(self.obstacles.materials, self.elasticity, self.material, seat.material);
        let (normal, time) = (seat.normal, path.during[0]);
        let (incoming, pressing) = (dot(path.v0, normal), -dot(acceleration, normal));
        let (slip, drive) = (along(path.v0, normal, -incoming), along(acceleration, normal, pressing));
        let (way, end) = Slide { velocity: slip, drive, pressing, friction: mixed.friction }.after(path.duration());
        let (place, before, after, surface) = (path.x0, path.v0, slip, Vec3::ZERO);
        let (id, row, mass, closing) = (self.id, self.row, self.mass, max(-incoming, 0.0));
        self.report.hits += 1;
        let along = [drive, way, slip, end];
        if let Some(observer) = &mut self.observer {
            observer.hit(&Impact { id, row, other: None, mass, place, normal, closing, before, after, surface, time });
            let world = [acceleration, way, slip, end];
            observer.slid(&Sliding { mass, raised: Vec3::ZERO, world, along });
        }
        let mut onward =
            Path { x0: place, v0: slip, x1: plus(place, way), v1: end, during: path.during, pull: Some(acceleration) };
        self.lead_on(&self.lead(path, 0.0, normal), &mut onward, Some(&along));
        Some((onward, seat.slack))
    }

    /// By how much a method leads beyond a parabola along a surface that a path meets, if there are springs.
    #[cfg_attr(one_by_one, inline(never))]
    pub(super) fn lead(&self, path: &Path, time: f32, normal: Vec3) -> Option<Lead> {
        self.obstacles.lead.and_then(|code| (code.of)(path, time, normal))
    }

    /// Leads the way on from a surface farther, as the method does: one that flies, or slides so.
    #[cfg_attr(one_by_one, inline(never))]
    pub(super) fn lead_on(&self, lead: &Option<Lead>, onward: &mut Path, slides: Option<&[Vec3; 4]>) {
        if let (Some(lead), Some(code)) = (lead, self.obstacles.lead) {
            onward.x1 = (code.beyond)(lead, onward, slides);
        }
    }

    /// The surface that a path begins on, if it leaves that only to come back to it within the step. The place is within rounding
    /// of it, but not within that of being behind it.
    fn seat(&self, path: &Path, acceleration: Vec3) -> Option<(Contact, u32)> {
        let time = path.duration();
        let fall = |acceleration: f32| 0.5 * acceleration * time * time;
        let (mut faces, mut seat) = (0, None);
        let reach = self.radius + fall(length(acceleration));
        self.walls.contacts(path.x0, reach, path.during[0], &mut |contact| {
            faces += 1;
            seat = Some(*contact);
        });
        let seat = seat.filter(|seat| is_zero(seat.velocity))?;
        if faces > 1 {
            return Some((seat, faces));
        }
        let (gap, slack) = (seat.distance - self.radius, seat.slack);
        let (leaving, pressing) = (dot(path.v0, seat.normal).abs(), -dot(acceleration, seat.normal));
        let is_there = gap >= 0.5 * slack && gap <= LAIN * slack && fall(pressing) > gap;
        let rests = leaving * time <= LAIN * slack && 2.0 * leaving < RESTING * self.dt * pressing;
        (is_there && rests).then_some((seat, faces))
    }

    /// On a path, past as many hits as there may be; the slack is that of the surface along which it goes, if it goes along one.
    pub(super) fn follow(&mut self, mut path: Path, mut slack: f32) -> Arrival {
        for _ in 0..self.obstacles.max_bounces {
            let Some(mut meeting) = self.first_meeting(&path) else {
                let (position, velocity) = (path.x1, self.left_or(self.turned_at_end(&path, slack)));
                return Arrival { position, velocity, pending_death: PendingDeath::Lives };
            };
            self.tell_cut(&path, meeting.time, meeting.hit.slack);
            if meeting.is_sink {
                let end = meeting.arrival(&path);
                return Arrival { velocity: self.left_or(end.velocity), ..end };
            }
            slack = meeting.hit.slack;
            path = self.rebound(&path, &mut meeting);
        }
        self.report.caps.bounces += 1;
        self.tell_cut(&path, 0.0, slack);
        let position = self.walls.carry(path.x0, self.radius, path.during);
        Arrival { position, velocity: self.left_or(path.v0), pending_death: PendingDeath::Lives }
    }

    /// The velocity that constraints have left it, after all hits; that of its path, if they have not moved it.
    fn left_or(&self, of_path: Vec3) -> Vec3 {
        self.left.as_deref().copied().unwrap_or(of_path)
    }

    /// The first hit along the path's chords, at its instant on the path itself.
    pub(super) fn first_meeting(&mut self, path: &Path) -> Option<Meeting> {
        let cubic = path.cubic();
        let chords = cubic.chords();
        if chords > MAX_CHORDS {
            self.report.caps.chords += 1;
        }
        let count = chords.min(MAX_CHORDS) as u8;
        let (whole, mut from) = (f32::from(count), 0.0);
        (0..count).find_map(|i| {
            let end = f32::from(i + 1) / whole;
            let begun = core::mem::replace(&mut from, end);
            let chord = path.piece(&cubic, [begun, end], self.radius);
            let (hit, is_sink) = self.first_hit(&chord)?;
            let (time, place) = ((f32::from(i) + hit.time) / whole, chord.at(hit.time));
            let mut meeting = Meeting { time, place, chord, begun, hit, is_sink };
            self.put_on_path(path, &cubic, &mut meeting, end);
            Some(meeting)
        })
    }

    /// The first hit of a straight piece, and whether that is a sink's, which wins over a collider's in the same place.
    fn first_hit(&self, piece: &Segment) -> Option<(Hit, bool)> {
        let (wall, sink) = (self.walls.first_hit(piece), self.sinks.and_then(|sinks| sinks.first_hit(piece)));
        match (wall, sink) {
            (wall, Some(sink)) if wall.is_none_or(|wall| sink.time <= wall.time) => Some((sink, true)),
            (wall, _) => wall.map(|hit| (hit, false)),
        }
    }

    /// Puts a meeting that a chord has found before `end` to its instant on the path: where that crosses the plane that touches the
    /// surface. A place far along the surface from that on the chord asks for the surface there, and where that is another plane, for the
    /// crossing of it.
    #[cfg_attr(one_by_one, inline(never))]
    fn put_on_path(&self, path: &Path, cubic: &Cubic, meeting: &mut Meeting, end: f32) {
        let Meeting { begun, hit, place, .. } = *meeting;
        let drift = dot(hit.velocity, hit.normal) * path.duration();
        let time = crossing(cubic, drift, &hit, place, [begun, meeting.time, end]);
        (meeting.time, meeting.place) = (time, cubic.at(time));
        if !(length(minus(meeting.place, place)) > 16.0 * hit.slack) {
            return;
        }
        // Around it first; where what it grazes bends away from the plane there, part by part along the chord, whatever that meets first.
        let part = (end - begun) * (1.0 / f32::from(PARTS_OF_CHORD));
        let mut span = [max(time - 0.5 * part, begun), min(time + 0.5 * part, end)];
        for i in 0..=PARTS_OF_CHORD {
            let piece = path.piece(cubic, span, self.radius);
            match self.first_hit(&piece) {
                Some((near, is_sink)) if i > 0 || is_sink == meeting.is_sink && dot(near.normal, hit.normal) > 0.0 => {
                    meeting.is_sink = is_sink;
                    return meeting.put_nearer(path, cubic, near, &piece, span, place);
                }
                _ => span = [begun + part * f32::from(i), begun + part * f32::from(i + 1)],
            }
        }
    }
}

/// Takes the surface out of a newborn's path that it meets within rounding of its birth, in a step of `dt` \[s\]: it lies on that of its
/// source, on whichever side rounding put it, and leaves it the way its velocity points.
pub(super) fn let_go<C>(walls: &C, sinks: Option<&dyn Collider>, path: &mut Path, dt: f32)
where
    C: Collider + ?Sized,
{
    let [start, _] = path.during;
    let to = along(path.x0, path.v0, dt);
    let ahead = Segment { from: path.x0, to, radius: 0.0, during: [start; 2] };
    let hits = [walls.first_hit(&ahead), sinks.and_then(|sinks| sinks.first_hit(&ahead))];
    let step = ahead.step();
    let far = length(step);
    let near = |hit: &&Hit| {
        let off_surface = -dot(step, hit.normal) * hit.time <= 2.0 * hit.slack;
        // A graze farther away is no birth on the surface.
        off_surface && far * hit.time <= 40.0 * hit.slack
    };
    if let Some(hit) = hits.iter().flatten().find(near) {
        path.x0 = along(ahead.at(hit.time), unit(step), 4.0 * hit.slack);
    }
    if !(path.duration() > 0.0) {
        path.x1 = path.x0;
    }
}

/// A box around a ball in a step of `dt` \[s\] wherever a path may lead it on which it is followed on after hits.
pub(super) fn facing(walls: &dyn Collider, path: &Path, [radius, elasticity]: [f32; 2], dt: f32) -> Facing {
    let within = |size: f32| surroundings(path, [radius, elasticity], dt, size).map(|bounds| walls.facing(&bounds));
    match within(0.0) {
        Some(Facing::Face(face)) => within(face.size()),
        other => other,
    }
    .unwrap_or(Facing::Several)
}

/// The box that holds it meanwhile, among things as far away from the origin as `size` \[m\]. Of elasticities up to one hits take no
/// speed from it but by what they set it off; of others nothing is known.
pub(super) fn surroundings(path: &Path, [radius, elasticity]: [f32; 2], dt: f32, size: f32) -> Option<Aabb> {
    let hull = path.hull(radius);
    let size = max(max(largest(hull.min), largest(hull.max)), size);
    let speed = max(length(path.v0), length(path.v1));
    // Newborns look ahead as far as they would go in a whole step; in the middle of one a path may be faster than at its ends.
    let room = dt * (speed + 4.0 * length(path.v1 - path.v0)) + length(path.x1 - path.x0) + 128.0 * f32::EPSILON * size;
    (0.0..=1.0).contains(&elasticity).then_some(Aabb { min: hull.min - room, max: hull.max + room })
}

/// Tells whether a path begins within rounding of the surface that it hits, and hardly leaves it before.
fn has_touched(path: &Path, meeting: &Meeting) -> bool {
    let Hit { normal, velocity: surface, slack, .. } = meeting.hit;
    let elapsed = path.duration() * meeting.time;
    let off = dot(minus(along(path.x0, surface, elapsed), meeting.place), normal);
    let left = dot(minus(path.v0, surface), normal) * elapsed;
    max(off.abs(), left.abs()) <= LAIN * slack
}

/// When a path crosses the plane that touches the surface at a place where it would be hit after a fraction of the path,
/// from the side of the normal to the other, between two others. It begins at the end: where the path bends toward the
/// surface, Newton's method comes from there to the crossing and never to where the path has left the surface before.
fn crossing(cubic: &Cubic, drift: f32, hit: &Hit, place: Vec3, [begun, found, end]: [f32; 3]) -> f32 {
    let [c1, c2, c3] = cubic.coefficients.map(|c| dot(c, hit.normal));
    let (c0, c1) = (dot(minus(cubic.start, place), hit.normal) + drift * found, c1 - drift);
    let (mut low, mut high, mut s) = (begun, end, end);
    for _ in 0..MAX_LOOKS {
        let height = c0 + (c1 + (c2 + c3 * s) * s) * s;
        let slope = c1 + (2.0 * c2 + 3.0 * c3 * s) * s;
        if height > 0.0 {
            low = s;
        } else {
            high = s;
        }
        let newton = s - height / slope;
        let next = if newton >= low && newton <= high { newton } else { 0.5 * (low + high) };
        let moved = (next - s).abs();
        s = next;
        if !(moved > f32::EPSILON * end) {
            break;
        }
    }
    s
}
