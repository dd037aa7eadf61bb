//! The links of a rope in a sub-step, and the copies of its particles that they move.

use super::super::{Bodies, SHIFTED};
use super::chain::Chain;
use crate::constrain::walls::{Pace, Pushed, Wall};
use crate::index::{Room, between};
use crate::math::{largest, length, max};
use crate::memory::take;
use glam::Vec3;

/// Words for each particle.
pub(super) const WORDS: usize = 20;

/// The links of a chain in a sub-step. Link i joins the particles i and i + 1, the last one of a closed chain its last and first. They move copies of
/// their particles, told from near, so that the shortest of paces loses nothing in rounding, wherever they are.
pub(super) struct Links<'m> {
    /// The chain, and the number of its links.
    pub(super) chain: Chain<'m>,
    pub(super) count: usize,
    /// True if some of its particles have been made heavier.
    pub(super) is_loaded: bool,
    /// How far it all goes wrong, summed over the links: nothing is moved farther than twice that.
    pub(super) reach: f32,
    /// The cosine of how far a link has turned in a pace, at the most.
    pub(super) turn: f32,
    /// The share of the sub-step that a pace is.
    pub(super) share: f32,
    /// How long it takes from where the copies are to where links are met, with the velocities of the copies \[s\].
    pub(super) time: f32,
    /// Where places are told from \[m\], and the room that they are in.
    pub(super) origin: Vec3,
    pub(super) room: Option<Room>,
    /// λ of each link, below zero where it pulls \[kg m\], or \[kg m/s\] where velocities are settled.
    pub(super) pull: &'m mut [f32],
    /// By how much the link has to get longer; when it has been solved, the change of its λ.
    pub(super) change: &'m mut [f32],
    /// What elimination has left beside the diagonal, and of the column of the link that closes the chain.
    pub(super) upper: &'m mut [f32],
    pub(super) border: &'m mut [f32],
    /// The inverse mass of each particle \[1/kg\].
    pub(super) weight: &'m mut [f32],
    /// The direction that each link has, to its first end; zero if it is not to act.
    pub(super) normal: &'m mut [Vec3],
    /// The direction along which it acts.
    pub(super) way: &'m mut [Vec3],
    /// Where each particle is \[m\], and how fast it goes \[m/s\].
    pub(super) place: &'m mut [Vec3],
    pub(super) velocity: &'m mut [Vec3],
    /// Velocities put by \[m/s\]; while links are met by walls, by how much they have made each particle faster, as it would be without these.
    pub(super) aside: &'m mut [Vec3],
    /// The walls of all of the rope's particles, or none.
    pub(super) walls: &'m mut [Wall],
    /// How much of the sub-step is left behind the pace \[s\].
    pub(super) left: f32,
}

/// A link as it lies at the end of a pace.
pub(super) struct Line {
    ends: [usize; 2],
    pub(super) distance: f32,
    pub(super) normal: Vec3,
    /// The direction that it has as the pace begins, how long it is then \[m\], and by how much longer it gets \[m\]: that is told to its own rounding.
    pub(super) first: Vec3,
    pub(super) before: f32,
    pub(super) longer: f32,
    /// How long it is to be \[m\].
    pub(super) rest: f32,
    /// The sum of its ends' inverse masses \[1/kg\].
    pub(super) weight: f32,
}

impl<'m> Links<'m> {
    /// Those of a chain, in which nothing acts yet, in so many words for each of its particles, which walls may press.
    pub(super) fn of(chain: Chain<'m>, mut words: &'m mut [u32], walls: &'m mut [Wall]) -> Self {
        let particles = chain.rows.len();
        let mut own = take(&mut words, WORDS * particles);
        own.fill(0);
        let [pull, change, upper, border, weight] =
            [(); 5].map(|()| bytemuck::cast_slice_mut(take(&mut own, particles)));
        let [normal, way, place, velocity, aside] =
            [(); 5].map(|()| bytemuck::cast_slice_mut(take(&mut own, 3 * particles)));
        let (count, origin, room) = (chain.links(), Vec3::ZERO, None);
        #[rustfmt::skip]
        let nothing = Self {
            chain, count, is_loaded: false, reach: 0.0, turn: 1.0, share: 1.0, time: 0.0, origin, room, pull, change, upper, border, weight, normal, way, place, velocity, aside, walls, left: 0.0,
        };
        nothing
    }

    /// Copies how fast all go, how heavy they are and where they were so long ago \[s\] with these velocities.
    pub(super) fn take_up(&mut self, bodies: &Bodies<'_>, time: f32) {
        self.origin = self.chain.rows.first().map_or(Vec3::ZERO, |&row| bodies.position[row as usize]);
        self.room = bodies.near.room().copied();
        (self.time, self.share, self.left, self.is_loaded) = (time, 1.0, 0.0, false);
        for (particle, row) in self.chain.members() {
            let place = between(self.room.as_ref(), self.origin, bodies.position[row]);
            self.place[particle] = place - bodies.velocity[row] * time;
            self.velocity[particle] = bodies.velocity[row];
            self.weight[particle] = self.chain.weight(bodies, particle, row);
        }
    }

    /// Gives the velocities of the copies to those of whom they are, and moves these by as much as that is in a time \[s\].
    pub(super) fn hand_back(&self, bodies: &mut Bodies<'_>, time: f32) {
        for (particle, row) in self.chain.members().filter(|&(particle, _)| self.weight[particle] > 0.0) {
            let faster = self.velocity[particle] - bodies.velocity[row];
            bodies.velocity[row] = self.velocity[particle];
            if time > 0.0 {
                bodies.position[row] += faster * time;
                bodies.marks[row] |= SHIFTED;
            }
        }
    }

    /// Moves all to where the copies are, with their velocities; those that are fixed stay.
    pub(super) fn put_back(&self, bodies: &mut Bodies<'_>) {
        for (particle, row) in self.chain.members().filter(|&(particle, _)| self.weight[particle] > 0.0) {
            let (room, place) = (self.room.as_ref(), self.place[particle]);
            // The shortest way to there: the copy has gone through the sides on its own.
            bodies.position[row] += between(room, between(room, self.origin, bodies.position[row]), place);
            bodies.velocity[row] = self.velocity[particle];
            bodies.marks[row] |= SHIFTED;
        }
    }

    /// A link as it lies; none if it cannot act.
    pub(super) fn line(&self, link: usize) -> Option<Line> {
        let ends = self.chain.ends(link);
        let [p, q] = ends;
        if !(self.weight[p] + self.weight[q] > 0.0) {
            return None;
        }
        let from = between(self.room.as_ref(), self.place[q], self.place[p]);
        let by = (self.velocity[p] - self.velocity[q]) * self.time;
        let apart = from + by;
        let [before, distance] = [from, apart].map(length);
        let normal = apart / distance;
        let first = if before > 0.0 { from / before } else { normal };
        let longer = by.dot(from + apart) / (before + distance);
        let rest = self.chain.length(link);
        let [one, other] = ends.map(|end| self.own_weight(end, [normal; 2]));
        let weight = one + other;
        (distance > 0.0 && before + distance < f32::INFINITY).then_some(Line {
            ends,
            distance,
            normal,
            first,
            before,
            longer,
            rest,
            weight,
        })
    }

    /// The wall of a particle that is near one.
    pub(super) fn wall(&self, particle: usize) -> Option<&Wall> {
        let wall = if self.walls.is_empty() { None } else { self.walls.get(self.chain.number(particle)) };
        wall.filter(|wall| wall.is_near())
    }

    /// The wall that presses a particle.
    fn pressing(&self, particle: usize) -> Option<&Wall> {
        self.wall(particle).filter(|wall| wall.presses())
    }

    /// Tells whether any of its particles is near a wall.
    pub(super) fn is_by_walls(&self) -> bool {
        !self.walls.is_empty() && (0..self.weight.len()).any(|particle| self.wall(particle).is_some())
    }

    /// Tells whether any is near one, and none of these walls moves.
    pub(super) fn are_by_standing_walls(&self) -> bool {
        self.is_by_walls() && (0..self.weight.len()).all(|particle| self.wall(particle).is_none_or(Wall::stands))
    }

    /// The part of a direction in which a particle would go that its wall lets pass. What an end is joined to is told on its wall.
    pub(super) fn pass(&self, particle: usize, along: Vec3) -> Vec3 {
        if self.chain.held(particle).is_some() {
            return along;
        }
        self.wall(particle).map_or(along, |wall| wall.pass(along))
    }

    /// The velocity of a particle without what leads through its wall.
    pub(super) fn along_wall(&self, particle: usize, fast: Vec3) -> Vec3 {
        let Some(wall) = self.pressing(particle) else { return fast };
        let (normal, held) = (wall.normals()[0], self.chain.held(particle));
        held.map_or(wall.pass(fast), |held| wall.pass(fast) - held.lean(normal) * fast.dot(normal))
    }

    /// The inverse mass of a particle, with what it is joined to, for an impulse one way, of which another way counts \[1/kg\].
    fn own_weight(&self, particle: usize, ways: [Vec3; 2]) -> f32 {
        self.chain.held(particle).map_or(self.weight[particle], |held| held.weight(ways))
    }

    /// The same, on the wall that presses it, and with what brakes it along that \[1/kg\].
    pub(super) fn weight_at(&self, particle: usize, ways: [Vec3; 2]) -> f32 {
        let Some(wall) = self.pressing(particle) else { return self.own_weight(particle, ways) };
        let held = self.chain.held(particle).filter(|held| !held.is_fixed());
        held.map_or_else(|| self.own_weight(particle, ways), |held| held.on(wall.normals()[0]).weight(ways))
            / wall.heavier()
    }

    /// How much faster an impulse makes a particle \[m/s\].
    pub(super) fn faster(&self, particle: usize, impulse: Vec3) -> Vec3 {
        self.chain.held(particle).map_or(impulse * self.weight[particle], |held| held.inverse * impulse)
    }

    /// The same, as far as its wall lets it go, and with what brakes it there.
    pub(super) fn faster_by_wall(&self, particle: usize, impulse: Vec3) -> Vec3 {
        let Some(wall) = self.pressing(particle) else { return self.faster(particle, impulse) };
        let faster = match self.chain.held(particle).filter(|held| !held.is_fixed()) {
            Some(held) => held.on(wall.normals()[0]).inverse * impulse,
            None => wall.pass(self.faster(particle, wall.pass(impulse))),
        };
        faster / wall.heavier()
    }

    /// Lets the walls of all that are near some look at them in the pace, and at by how much links have made them faster; who is told to goes as fast as
    /// they say. Tells whether anybody is.
    pub(super) fn by_walls(&mut self, look: impl Fn(&mut Wall, Pace, Pushed) -> Option<Vec3>) -> bool {
        let mut changed = false;
        for particle in 0..if self.walls.is_empty() { 0 } else { self.weight.len() } {
            let (faster, fast, held) = (self.aside[particle], self.velocity[particle], self.chain.held(particle));
            let (time, left, share, number) = (self.time, self.left, self.share, self.chain.number(particle));
            let Some(wall) = self.walls.get_mut(number).filter(|wall| wall.is_near()) else { continue };
            let from = wall.image(self.room.as_ref(), self.origin + self.place[particle]);
            let pace = if time > 0.0 { Pace::Way { from, time, left, share } } else { Pace::Settled };
            let lean = held.map(|held| held.lean(wall.normals()[0]));
            let Some(led) = look(wall, pace, Pushed { fast, faster, lean }) else { continue };
            if self.weight[particle] > 0.0 && led.is_finite() {
                (self.velocity[particle], changed) = (led, true);
            }
        }
        changed
    }

    /// Forgets what walls have given in the sub-step, which is gone through again.
    pub(super) fn forget_walls(&mut self) {
        self.by_walls(|wall, _, _| {
            wall.forget_paces();
            None
        });
    }

    /// Counts what walls have given in the pace that has been solved.
    pub(super) fn note_walls(&mut self) {
        self.by_walls(|wall, pace, pushed| {
            wall.note_pace(pace, pushed);
            None
        });
    }

    /// How fast a link's ends go apart \[m/s\].
    pub(super) fn parting(&self, line: &Line) -> Vec3 {
        let [p, q] = line.ends;
        self.velocity[p] - self.velocity[q]
    }

    /// Tells whether a link does not pull where it is.
    pub(super) fn is_slack(&self, line: &Line) -> bool {
        self.chain.tether && line.distance <= line.rest
    }

    /// The rounding of a link's length, from where its ends are \[m\].
    pub(super) fn rounding(&self, line: &Line) -> f32 {
        let [p, q] = line.ends.map(|end| largest(self.place[end]));
        f32::EPSILON * (largest(self.origin) + max(p, q) + line.distance + line.rest)
    }
}
