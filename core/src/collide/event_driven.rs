//! The step of particles that meet, worked through in the order of time.

use super::air::{Air, Until};
use super::borne::Borne;
use super::images::first_touch_of_images;
use super::meeting::{Answer, Touch};
use super::path::{Path, between};
use super::queue::{GONE, NEVER, NOBODY, NextEvent, Queue, WALL};
use super::sweep::{LAIN, Meeting, Sweep};
use super::tile::Obstacles;
use crate::force::Attributes;
use crate::index::{Room, SpatialIndex, between as shortest};
use crate::material::{Mixed, of_two};
use crate::math::{high, largest, length, max};
use crate::observe::{Impact, Observer};
use crate::particles::Id;
use crate::reap::PendingDeath;
use crate::report::Report;
use crate::shape::Segment;
use crate::time::Time;
use glam::Vec3;

/// The number of others that a particle may find near it in one step, each time that it looks what comes next, for
/// every bounce that the scene allows it: by default some hundred times what a heap takes. After as many again nobody is looked
/// for where it waits.
const FOUND_A_BOUNCE: u32 = 1 << 8;

/// How many times as far as they overlap two may be moved along walls to be apart.
const MOST_ASIDE: f32 = 64.0;

/// A step whose meetings are worked through one after the other.
pub(super) struct EventDriven<'a> {
    pub(super) obstacles: Obstacles<'a>,
    /// The forces that brake them, as far as is known.
    pub(super) air: Option<Air<'a>>,
    pub(super) attributes: &'a Attributes<'a>,
    pub(super) dt: Time,
    pub(super) end: Time,
    /// Events count in 2 to this power ticks.
    pub(super) unit: u32,
    pub(super) events: Queue<'a>,
    /// Positions and velocities at the present paths' beginnings and ends.
    pub(super) starts: [&'a mut [Vec3]; 2],
    pub(super) ends: [&'a mut [Vec3]; 2],
    /// Accelerations that drive those who go along a surface, whatever that bears of them \[m/s²\]; not a number: it goes along none.
    pub(super) pull: &'a mut [Vec3],
    /// Positions at the step's beginning, which the index sorts.
    pub(super) home: &'a [Vec3],
    /// The room through whose sides they meet, if there is one.
    pub(super) room: Option<&'a Room>,
    pub(super) pending_death: &'a mut [PendingDeath],
    pub(super) radius: &'a [f32],
    pub(super) mass: &'a [f32],
    pub(super) inverse_mass: &'a [f32],
    pub(super) elasticity: &'a [f32],
    pub(super) material: &'a [u16],
    pub(super) slot: &'a [u32],
    pub(super) serial: &'a [u32],
    /// The largest radius.
    pub(super) widest: f32,
    /// Nobody goes farther than this from home, or all are looked at instead of the index.
    pub(super) max_travel: f32,
    pub(super) report: &'a mut Report,
    pub(super) observer: &'a mut dyn Observer,
}

impl EventDriven<'_> {
    /// Sets the events, and finds how far anybody goes.
    pub(super) fn prepare(&mut self, born: &[Time], old: usize) {
        let mut farthest = 0.0;
        for (row, &born) in born.iter().enumerate() {
            let start = self.end - (self.end - born).min(self.dt);
            let since = self.units(start);
            self.events.set(row, NextEvent { since, until: NEVER, partner: NOBODY, ..NextEvent::default() });
            let path = self.path(row);
            let (now, is_newborn) = (self.end - self.dt, row >= old);
            let is_there = self.pending_death[row] == PendingDeath::Lives && !(is_newborn && born > self.end);
            if !(is_there && path.is_finite()) {
                self.events.set(row, NextEvent { partner: GONE, until: NEVER, ..NextEvent::default() });
                continue;
            }
            // Who is born where a sub-step ends is let go in that.
            if is_newborn && born > now {
                let path = self.sweep(row).let_go(&path);
                self.go(row, &path);
            } else if let Some(along) = if is_newborn { None } else { self.lying(row, &path) } {
                self.go(row, &along);
            } else if path.lags() {
                let path = self.sweep(row).pressed_on(&path);
                self.go(row, &path);
            }
            let hull = self.path(row).hull(0.0);
            farthest = max(farthest, length(hull.max - hull.min));
            if self.radius[row] < f32::INFINITY {
                self.widest = max(self.radius[row], self.widest);
            }
        }
        self.max_travel = 2.0 * farthest;
    }

    /// Works through the meetings. Each particle has a bounded number of them, and so the work is bounded.
    pub(super) fn run(&mut self, index: Option<&dyn SpatialIndex>) {
        let mut near = index;
        for row in 0..self.home.len() {
            self.foresee(row, near);
        }
        while let Some(row) = self.events.first() {
            let event = *self.events.event(row);
            if event.partner == WALL {
                self.meet_wall(row);
                near = near.filter(|_| !self.strays(row));
                self.foresee(row, near);
                continue;
            }
            let other = event.partner as usize;
            if self.events.event(other).turns != event.partner_turns {
                self.foresee(row, near);
                continue;
            }
            self.meet(row, other, event.until);
            near = near.filter(|_| !self.strays(row) && !self.strays(other));
            self.foresee(row, near);
            self.foresee(other, near);
        }
        (0..self.home.len()).for_each(|row| self.turn_at_end(row));
        self.report.effort.all_pairs += u64::from(near.is_none());
    }

    /// The way of what lies on scenery, along that.
    fn lying(&mut self, row: usize, path: &Path) -> Option<Path> {
        let hull = path.hull(self.radius[row]);
        let Obstacles { colliders, sinks, .. } = self.obstacles;
        let may_lie = self.inverse_mass[row] != 0.0 && colliders.may_touch(&hull) && !sinks.may_touch(&hull);
        may_lie.then(|| self.sweep(row).lying(path)).flatten().map(|(along, _)| along)
    }

    /// Turns the velocity of what has gone along a surface which curves to where that leads on.
    fn turn_at_end(&mut self, row: usize) {
        let event = *self.events.event(row);
        if event.partner == GONE || event.waits != 0 || self.pull[row].is_nan() {
            return;
        }
        let (path, reach) = (self.path(row), LAIN * self.slack(row, row));
        let sweep = self.sweep(row);
        if let (_, Some(seat)) = sweep.faces(path.x1, reach, path.during[1]) {
            self.ends[1][row] = sweep.turned_at_end(&path, seat.slack);
        }
    }

    /// Tells whether a particle's present path leads where the index is not asked to look for it.
    fn strays(&self, row: usize) -> bool {
        let path = self.path(row);
        let (hull, home) = (path.hull(0.0), self.home[row]);
        path.is_finite() && length(high(hull.max - home, home - hull.min)) > self.max_travel
    }

    /// Finds out what happens first to a particle on its present path.
    fn foresee(&mut self, row: usize, near: Option<&dyn SpatialIndex>) {
        let event = *self.events.event(row);
        if self.inverse_mass[row] == 0.0 || event.partner == GONE {
            self.events.set(row, NextEvent { until: NEVER, ..event });
            return;
        }
        // What slides within a curve bounces off it often: half as many meetings, each in its turn, are enough.
        let most = self.obstacles.max_bounces.div_ceil(2);
        let most_found = self.obstacles.max_bounces.saturating_mul(FOUND_A_BOUNCE);
        if (event.turns > most || event.found > most_found) && event.waits == 0 {
            self.wait(row);
        }
        if event.found > most_found.saturating_mul(2) {
            self.events.set(row, NextEvent { until: NEVER, ..*self.events.event(row) });
            return;
        }
        let (event, path) = (*self.events.event(row), self.path(row));
        let hull = path.hull(self.radius[row]);
        let mut next = NextEvent { until: NEVER, partner: NOBODY, ..event };
        let moves = event.waits == 0;
        let near_walls = moves && (self.obstacles.colliders.may_touch(&hull) || self.obstacles.sinks.may_touch(&hull));
        let meeting = if near_walls { self.sweep(row).first_meeting(&path) } else { None };
        if let Some(meeting) = meeting {
            (next.until, next.partner) = (self.units(path.instant(meeting.time)), WALL);
        }
        let (middle, reach) = (hull.center(), hull.radius() + self.widest + self.max_travel);
        let (mut curved, mut found) = (false, 0_u32);
        let (home, room) = (self.home, self.room);
        let mut consider = |other: usize| {
            // As an index defines who is near, whether there is one or not; rows that one makes up are nobody's.
            let Some(&place) = home.get(other) else { return };
            let offset = shortest(room, middle, place);
            found += u32::from(offset.dot(offset) <= reach * reach);
            // A wall comes first of several at one instant, then the lowest row: whatever order they are looked at in.
            // Nobody is met before the path begins.
            if next.until <= event.since && (next.partner == WALL || next.partner <= other as u32) {
                return;
            }
            let (until, bent) = self.first_touch(row, other, &path);
            curved |= bent;
            let earlier =
                until < next.until || (until == next.until && next.partner != WALL && (other as u32) < next.partner);
            if until != NEVER && earlier {
                (next.until, next.partner) = (until, other as u32);
                next.partner_turns = self.events.event(other).turns;
            }
        };
        match near {
            Some(index) => {
                index.within(middle, reach + room.map_or(0.0, Room::slack), &mut |others| {
                    others.iter().for_each(|&other| consider(other as usize));
                });
            }
            None => (0..self.home.len()).for_each(&mut consider),
        }
        // How a path bends after a meeting at its very beginning is nobody's concern.
        self.report.caps.chords += u64::from(curved && next.until > event.since);
        next.found = event.found.saturating_add(found);
        self.events.set(row, next);
    }

    /// When a particle on its path touches another.
    fn first_touch(&self, row: usize, other: usize, path: &Path) -> (u32, bool) {
        let (own, its) = (self.events.event(row), self.events.event(other));
        let reach = self.radius[row] + self.radius[other];
        let yielding = self.inverse_mass[row] + self.inverse_mass[other];
        // A particle without a size or a mass that an answer could be reckoned with meets nobody.
        let is_sound = |x: f32| x > 0.0 && x < f32::INFINITY;
        if other == row || its.partner == GONE || !is_sound(reach) || !is_sound(yielding) {
            return (NEVER, false);
        }
        let from = self.instant(own.since.max(its.since));
        let (touch, curved) = self.touch(row, other, [&from_on(path, from), &from_on(&self.path(other), from)]);
        let end = self.end;
        (touch.map_or(NEVER, |(at, _)| self.units(between([from, end], at))), curved)
    }

    /// When on their paths two touch, and by how much that image of the other is off which is touched.
    fn touch(&self, row: usize, other: usize, [path, its]: [&Path; 2]) -> (Option<(f32, Vec3)>, bool) {
        let reach = self.radius[row] + self.radius[other];
        first_touch_of_images(self.room, &path.seen_from(its), reach, self.slack(row, other))
    }

    /// By how much the image of the second is off that the first touches, or if none is that which is nearest.
    fn image(&self, touch: Option<(f32, Vec3)>, [first, second]: &[Path; 2]) -> Vec3 {
        let nearest = || self.room.map_or(Vec3::ZERO, |room| room.image(first.x0, second.x0));
        touch.map_or_else(nearest, |(_, image)| image)
    }

    /// The error that rounding may make in the distance of two particles.
    fn slack(&self, row: usize, other: usize) -> f32 {
        let size = max(largest(self.starts[0][row]), largest(self.starts[0][other]));
        4.0 * f32::EPSILON * (size + self.radius[row] + self.radius[other])
    }

    fn meet_wall(&mut self, row: usize) {
        let path = self.path(row);
        if let Some(mut meeting) = self.sweep(row).first_meeting(&path) {
            self.answer_wall(row, &path, &mut meeting);
        } else {
            // A collider that answers otherwise the second time: it must not be asked for ever.
            let event = *self.events.event(row);
            self.events.set(row, NextEvent { turns: event.turns + 1, ..event });
        }
    }

    /// Tells whether a wall is in the way of a particle to where it is to meet another, and lets it meet that first. Chords may have missed it on
    /// the whole path, within their error; who was stopped by another just there would be beyond it for good.
    fn is_stopped(&mut self, row: usize, place: Vec3, now: Time) -> bool {
        let path = self.path(row);
        let [start, end] = path.during;
        let share = if end > start { (now - start).seconds() / (end - start).seconds() } else { 0.0 };
        let part = Path { x1: place, v1: path.velocity(share), during: [start, now], ..path };
        let hull = part.hull(self.radius[row]);
        let near_walls = self.obstacles.colliders.may_touch(&hull) || self.obstacles.sinks.may_touch(&hull);
        if !near_walls || self.events.event(row).waits != 0 || self.inverse_mass[row] == 0.0 {
            return false;
        }
        let Some(meeting) = self.sweep(row).first_meeting(&part) else { return false };
        self.answer_wall(row, &path, &mut meeting.within(share));
        true
    }

    /// Lets a particle on its present path meet a wall.
    fn answer_wall(&mut self, row: usize, path: &Path, meeting: &mut Meeting) {
        let event = *self.events.event(row);
        let turns = event.turns + 1;
        if meeting.is_sink {
            let end = meeting.arrival(path);
            (self.ends[0][row], self.ends[1][row], self.pending_death[row]) =
                (end.position, end.velocity, end.pending_death);
            self.events.set(row, NextEvent { turns, partner: GONE, ..event });
            return;
        }
        let onward = self.sweep(row).rebound(path, meeting);
        // Which may be earlier than it was foreseen: the chord had met something else first.
        let since = self.units(onward.during[0]);
        self.events.set(row, NextEvent { turns, since, partner: NOBODY, ..event });
        self.go(row, &onward);
    }

    /// The rest of the paths of two from where they meet, and by how much that image of the second is off which the first touches; none where
    /// a wall is in the way of one, which has met that first.
    fn arrival(&mut self, rows: [usize; 2], now: Time) -> Option<([Path; 2], Vec3)> {
        let [row, other] = rows;
        let from = self.instant(self.events.event(row).since.max(self.events.event(other).since));
        let whole = rows.map(|row| from_on(&self.path(row), from));
        let touch = self.touch(row, other, [&whole[0], &whole[1]]).0;
        let mut paths = whole.map(|path| from_on(&path, now));
        if let Some((at, _)) = touch {
            for (path, whole) in paths.iter_mut().zip(&whole) {
                path.x0 = whole.at(at);
            }
        }
        let is_stopped = self.is_stopped(row, paths[0].x0, now) || self.is_stopped(other, paths[1].x0, now);
        (!is_stopped).then(|| (paths, self.image(touch, &whole)))
    }

    /// Two particles meet.
    fn meet(&mut self, row: usize, other: usize, until: u32) {
        let (now, rows) = (self.instant(until), [row, other]);
        let Some((mut paths, image)) = self.arrival(rows, now) else { return };
        let waits = rows.map(|row| self.events.event(row).waits != 0);
        let velocity = [0, 1].map(|i| if waits[i] { self.ends[1][rows[i]] } else { paths[i].v0 });
        let offset = paths[0].x0 - paths[1].x0 - image;
        let normal = Touch::along(offset, velocity);
        let (inverse_mass, borne) = (rows.map(|row| self.inverse_mass[row]), self.borne_along(rows, &paths));
        let (acceleration, free) = (paths.map(|path| path.acceleration()), paths.map(|path| path.drive()));
        let ways = paths; // Before they are set apart, which is no motion.
        let overlap = self.radius[row] + self.radius[other] - length(offset);
        if overlap > self.slack(row, other) {
            self.set_apart(rows, waits, &mut paths, normal * overlap);
        }
        let (mixed, slack) = (self.mixed(rows), self.slack(row, other));
        let touch = Touch { normal, velocity, acceleration, free, inverse_mass, mixed, slack, borne };
        let Answer { velocity: after, way, ends, slid } = self.answer(rows, waits, &ways, &touch, now);
        if let Some(slid) = &slid {
            self.observer.slid(slid);
        }
        self.report.contacts += 1;
        let closing = max((velocity[1] - velocity[0]).dot(normal), 0.0);
        for i in 0..2 {
            let (row, event) = (rows[i], *self.events.event(rows[i]));
            if inverse_mass[i] == 0.0 {
                continue;
            }
            let normal = if i == 0 { normal } else { -normal };
            self.observer.hit(&Impact {
                id: self.id(row),
                row,
                other: Some(self.id(rows[1 - i])),
                mass: self.mass[row],
                place: paths[i].x0,
                normal,
                closing,
                before: velocity[i],
                after: after[i],
                surface: Vec3::ZERO,
                time: now,
            });
            let turns = event.turns + 1;
            if waits[i] {
                // It stays or goes with a wall as before: only since it began to wait does its place say where that takes it.
                self.events.set(row, NextEvent { turns, ..event });
                (self.starts[1][row], self.ends[1][row]) = (after[i], after[i]);
                continue;
            }
            self.events.set(row, NextEvent { turns, since: until, ..event });
            let Path { x0, during, pull, .. } = paths[i];
            // Two that stay in touch go on along what bears them; whoever is knocked away may have left it.
            let pull = pull.filter(|_| slid.is_some());
            let onward = Path { x0, v0: after[i], x1: x0 + way[i], v1: ends[i], during, pull };
            self.go(row, &onward);
            // Where one waits and does not get away, the other cannot go on either.
            if waits[1 - i] && after[i].dot(normal) < 0.0 {
                self.wait(row);
            }
        }
    }

    /// The walls along which two go on their paths.
    fn borne_along(&self, rows: [usize; 2], paths: &[Path; 2]) -> [Borne; 2] {
        [0, 1].map(|i| paths[i].pull.map_or(Borne::NOT, |_| self.borne(rows[i], &paths[i])))
    }

    /// The walls that something lies on where its path begins; of those that move nothing is known.
    fn borne(&self, row: usize, path: &Path) -> Borne {
        let mut borne = Borne::NOT;
        let reach = self.radius[row] + LAIN * self.slack(row, row);
        self.obstacles.colliders.contacts(path.x0, reach, path.during[0], &mut |contact| {
            if contact.velocity == Vec3::ZERO {
                borne.add(contact.normal);
            }
        });
        borne
    }

    /// The elasticity and friction between two.
    fn mixed(&self, rows: [usize; 2]) -> Mixed {
        let material = rows.map(|row| self.material[row].checked_sub(1));
        of_two(self.obstacles.materials, rows.map(|row| self.elasticity[row]), material)
    }

    /// The motions that a touch leaves two, from when they touch to the step's end, in which those are braked as fast as they are then that do not wait.
    fn answer(&self, rows: [usize; 2], waits: [bool; 2], paths: &[Path; 2], touch: &Touch, now: Time) -> Answer {
        let [dt, rest] = [self.dt, self.end - now].map(Time::seconds);
        let mut answer = touch.answer(dt, rest);
        let Some(air) = self.air else { return answer };
        // Whether they stay in touch may change with that.
        for _ in 0..2 {
            let stays = answer.slid.is_some();
            let acceleration = [0, 1].map(|i| {
                if waits[i] {
                    return touch.acceleration[i];
                }
                let (path, acceleration) = (&paths[i], if stays { touch.acceleration[i] } else { touch.free[i] });
                let until = Until { path, place: path.x0, now, acceleration };
                let onward = air.braking(self.attributes, rows[i]).onward(&until, answer.velocity[i]);
                if stays { onward.held(touch.normal) } else { onward.mean }
            });
            let all = if stays { [acceleration, touch.free] } else { [touch.acceleration, acceleration] };
            answer = Touch { acceleration: all[0], free: all[1], ..*touch }.answer(dt, rest);
            if answer.slid.is_some() == stays {
                break;
            }
        }
        answer
    }

    /// Moves two that overlap apart, each by its share or one for both, where no wall is in the way: what walls have set
    /// off may have been put a little into its neighbour, and would creep on and on. Two between walls give way along these.
    fn set_apart(&self, rows: [usize; 2], waits: [bool; 2], paths: &mut [Path; 2], way: Vec3) {
        let [a, b] = [0, 1].map(|i| if waits[i] { 0.0 } else { self.inverse_mass[rows[i]] });
        if a + b == 0.0 {
            return;
        }
        let is_free = |i: usize, change: Vec3| {
            let Path { x0, during: [now, _], .. } = paths[i];
            let radius = self.radius[rows[i]];
            let there = Segment { from: x0, to: x0 + change, radius, during: [now; 2] };
            change == Vec3::ZERO || self.obstacles.colliders.first_hit(&there).is_none()
        };
        let shares = [[a / (a + b), -b / (a + b)], [1.0, 0.0], [0.0, -1.0]];
        let moving =
            shares.into_iter().filter(|&[first, second]| (first == 0.0 || a > 0.0) && (second == 0.0 || b > 0.0));
        let straight = moving.map(|shares| shares.map(|share| way * share));
        let along = || {
            let left = [0, 1].map(|i| self.borne(rows[i], &paths[i]).left_of(way * shares[0][i]));
            let apart = (left[0] - left[1]).dot(way);
            let far = way.dot(way) / apart;
            (far > 0.0 && far < MOST_ASIDE).then(|| left.map(|left| left * far))
        };
        let mut all = straight.chain(core::iter::once_with(along).flatten());
        if let Some([first, second]) = all.find(|&[first, second]| is_free(0, first) && is_free(1, second)) {
            paths[0].x0 += first;
            paths[1].x0 += second;
        }
    }

    /// It stays where it is until the step is over, unless a wall that moves takes it along, and keeps its velocity.
    fn wait(&mut self, row: usize) {
        let event = *self.events.event(row);
        if event.waits == 0 {
            self.report.caps.bounces += 1;
        }
        let during = [self.instant(event.since), self.end];
        self.ends[0][row] = self.obstacles.colliders.carry(self.starts[0][row], self.radius[row], during);
        self.ends[1][row] = self.starts[1][row];
        self.events.set(row, NextEvent { waits: 1, ..event });
    }

    /// Takes a new path.
    fn go(&mut self, row: usize, path: &Path) {
        (self.starts[0][row], self.starts[1][row]) = (path.x0, path.v0);
        (self.ends[0][row], self.ends[1][row]) = (path.x1, path.v1);
        self.pull[row] = path.pull.unwrap_or(Vec3::NAN);
    }

    /// The present path.
    fn path(&self, row: usize) -> Path {
        let event = self.events.event(row);
        let during = [self.instant(event.since), self.end];
        let (x0, v0) = (self.starts[0][row], self.starts[1][row]);
        if event.waits != 0 || self.inverse_mass[row] == 0.0 {
            return Path { x0, v0: Vec3::ZERO, x1: x0, v1: Vec3::ZERO, during, pull: None };
        }
        let pull = Some(self.pull[row]).filter(|pull| !pull.is_nan());
        Path { x0, v0, x1: self.ends[0][row], v1: self.ends[1][row], during, pull }
    }

    fn id(&self, row: usize) -> Id {
        Id { slot: self.slot[row], serial: self.serial[row] }
    }

    fn sweep(&mut self, row: usize) -> Sweep<'_> {
        Sweep {
            obstacles: &self.obstacles,
            walls: self.obstacles.colliders,
            sinks: Some(self.obstacles.sinks),
            id: self.id(row),
            row,
            radius: self.radius[row],
            mass: self.mass[row],
            elasticity: self.elasticity[row],
            material: self.material[row].checked_sub(1),
            left: None,
            air: self.air.map(|air| air.braking(self.attributes, row)),
            dt: self.dt.seconds(),
            report: self.report,
            observer: Some(self.observer),
        }
    }

    /// An instant of the step as events have it: never later than it is.
    fn units(&self, instant: Time) -> u32 {
        let ticks = (instant + self.dt - self.end).ticks();
        // Below 2^31, as the unit was chosen.
        (ticks >> self.unit) as u32
    }

    fn instant(&self, units: u32) -> Time {
        (self.end - self.dt + Time::from_ticks(u64::from(units) << self.unit)).min(self.end)
    }
}

/// The rest of a path from an instant on.
fn from_on(path: &Path, instant: Time) -> Path {
    let [start, end] = path.during;
    if instant <= start || end <= start {
        return Path { during: [instant.max(start), end], ..*path };
    }
    path.rest((instant - start).seconds() / (end - start).seconds())
}
