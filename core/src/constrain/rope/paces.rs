//! Sub-steps that are gone through in paces: those in which links turn far, or particles swing fast across them.

use super::super::Bodies;
use super::links::Links;
use super::solver::Way;
use crate::index::between;
use crate::math::{length, max, min, sqrt};
use glam::Vec3;

/// Paces of a sub-step, at the most, and of all tries in it.
const PACES: u32 = 256;
const ALL_PACES: u32 = 4 * PACES;
/// The cosine of how far one may turn so that its energy is safe: by 15°.
const GENTLE: f32 = 0.966;
/// The energy that may be seen in what goes through paces by walls, a multiple of what is there: a rope that swings shows now more of it and now less.
const LIVELY: f32 = 1.05;
/// The square of how far a particle may swing across its links in a pace, in radians of its oscillation: half of what is stable for a long chain.
const STIFF: f32 = 1.0;
/// How much of what its neighbours are faster is given in a pace to a particle that has been made heavier.
const FOLLOWING: f32 = 0.125;

/// How a walk in paces has ended.
enum Walk {
    /// It has come to the end.
    Done,
    /// It has been given up after so many paces, in which particles swung so far across their links at the most, squared.
    GivenUp { paces: u32, stiff: f32 },
}

impl Links<'_> {
    /// Brings all links of the chain to their lengths.
    pub(super) fn close(&mut self, bodies: &mut Bodies<'_>) {
        // A leap tells directions from where all were less half of what forces have done since. A chain hardly shows that, but it is all that there is to a link which
        // swings about somebody who is fixed.
        let may_leap = self.chain.links() > 1 || self.shown(bodies) == 1.0 || self.chain.is_free(bodies);
        if !may_leap {
            self.take_up(bodies, bodies.substep.seconds());
        }
        let is_done = may_leap && self.leap(bodies, Way::First) || self.walk_through(bodies, Way::First);
        if is_done || self.is_by_walls() && (self.leap(bodies, Way::Middle) || self.walk_through(bodies, Way::Middle)) {
            return;
        }
        self.jump(bodies);
    }

    /// Goes through the sub-step in one pace; tells whether that will do.
    fn leap(&mut self, bodies: &mut Bodies<'_>, along: Way) -> bool {
        let h = bodies.substep.seconds();
        self.take_up(bodies, h);
        if !self.meet(h, along) || along == Way::First && self.is_stiff(self.shown(bodies)) {
            return false;
        }
        if self.chain.tether {
            self.let_go(h);
        }
        self.note_walls();
        if self.has_acted() || self.is_by_walls() {
            self.hand_back(bodies, h);
        }
        true
    }

    /// Tells whether a particle swings so fast across its links, which pull in all so many times what they have pulled, that the pace does not show it.
    pub(super) fn is_stiff(&self, shown: f32) -> bool {
        shown * self.stiffness() > STIFF
    }

    /// Goes through the sub-step in as few paces as will do. Where the most of them will not, who is too light for what pulls at him is made heavier. Tells
    /// whether that has come to an end.
    fn walk_through(&mut self, bodies: &mut Bodies<'_>, along: Way) -> bool {
        let (mut paces, mut gone, mut stiff) = (1, 0, self.stiffness());
        while gone < ALL_PACES {
            if paces == PACES {
                if self.is_by_walls() {
                    return false;
                }
                self.load(0.5 * STIFF);
            }
            // What has not come near tells little: no more than eight times as many.
            let wanted = paces as f32 * min(sqrt(stiff / STIFF), 8.0);
            paces *= 2;
            while (paces as f32) < wanted {
                paces *= 2;
            }
            paces = paces.min(PACES);
            match self.walk(bodies, paces, along) {
                Walk::Done => {
                    bodies.report.effort.capped += u64::from(self.is_loaded);
                    self.put_back(bodies);
                    return true;
                }
                Walk::GivenUp { stiff: next, .. } if paces == PACES && !(next > STIFF) => return false,
                Walk::GivenUp { paces, stiff: next } => (gone, stiff) = (gone + paces, next),
            }
        }
        false
    }

    /// Goes through the sub-step from where all were as it began, by the forces that the method shows, in so many paces, and keeps to the lengths at each.
    /// Gives up where links turn too far in a pace or do not come near their lengths, and where particles swing too far across them.
    fn walk(&mut self, bodies: &Bodies<'_>, paces: u32, along: Way) -> Walk {
        let share = 1.0 / paces as f32;
        let (h, time) = (bodies.substep.seconds(), bodies.substep.seconds() * share);
        self.forget_walls();
        self.set_out(bodies, paces as f32);
        let (before, mut hauled) = (self.vigour(bodies, 0.5 * share), 0.0);
        for pace in 1..=paces {
            self.kick(bodies, share);
            self.left = h - time * pace as f32;
            let met = self.meet(time, along);
            let stiff = self.stiffness();
            if !met || along == Way::First && stiff > STIFF {
                return Walk::GivenUp { paces: pace, stiff };
            }
            if self.chain.tether {
                self.let_go(time);
            }
            self.note_walls();
            hauled += self.hauled(bodies);
            self.go();
        }
        let (now, most) = (self.vigour(bodies, 0.5 * share), before + 2.0 * (self.work(bodies) + hauled));
        let is_wild = || self.are_by_standing_walls() && now > LIVELY * most + self.fallen(bodies);
        if self.turn < GENTLE || is_wild() {
            self.calm(bodies, now, most);
        }
        self.arrive(bodies, paces as f32);
        if self.is_loaded {
            self.keep_middle(bodies);
        }
        Walk::Done
    }

    /// Takes for velocities what the method has shown beyond them, if it had gone in so many paces: as fast as all would have to be for how far it has
    /// brought them beyond where velocities lead.
    fn take_up_leads(&mut self, bodies: &Bodies<'_>, paces: f32) {
        let h = bodies.substep.seconds();
        for (particle, row) in self.chain.members() {
            let [from, before] = bodies.before.map(|before| before[row]);
            let (way, gained) =
                (between(self.room.as_ref(), from, bodies.position[row]), bodies.velocity[row] - before);
            let moves = self.chain.weight(bodies, particle, row) > 0.0;
            self.velocity[particle] = if moves { way / h - before - gained * (0.5 + 0.5 / paces) } else { Vec3::ZERO };
        }
    }

    /// The number of times that links have to pull in all what they have pulled in one pace: methods of higher order go half as far by forces as velocities lead, and
    /// leave the other half to settling.
    pub(super) fn shown(&self, bodies: &Bodies<'_>) -> f32 {
        let h = bodies.substep.seconds();
        let lags = |(_, row): (usize, usize)| {
            let gained = bodies.velocity[row] - bodies.before[1][row];
            length(bodies.lead(row, h)) > 0.25 * h * length(gained)
        };
        if self.chain.members().any(lags) { 2.0 } else { 1.0 }
    }

    /// Takes out of places what the method shows beyond velocities: of all, if somebody is fixed, else what lengths show of it.
    pub(super) fn catch_up(&mut self, bodies: &mut Bodies<'_>) {
        if !self.chain.is_free(bodies) {
            return self.chain.members().for_each(|(_, row)| bodies.catch_up(row));
        }
        let h = bodies.substep.seconds();
        self.take_up(bodies, 0.0);
        self.take_up_leads(bodies, 1.0);
        self.aside.copy_from_slice(self.velocity);
        self.turn_only();
        for (particle, row) in self.chain.members() {
            let by = (self.aside[particle] - self.velocity[particle]) * h;
            if by.is_finite() {
                bodies.position[row] -= by;
            }
        }
    }

    /// Puts all back to where they were as the sub-step began, with the velocities with which they would go on from there in so many paces.
    pub(super) fn set_out(&mut self, bodies: &Bodies<'_>, paces: f32) {
        for (particle, row) in self.chain.members() {
            self.place[particle] = between(self.room.as_ref(), self.origin, bodies.before[0][row]);
        }
        self.turn = 1.0;
        self.take_up_leads(bodies, paces);
        self.turn_only();
        for (particle, row) in self.chain.members() {
            let moves = self.weight[particle] > 0.0;
            self.velocity[particle] =
                if moves { self.velocity[particle] + bodies.before[1][row] } else { self.led(bodies, row) };
        }
    }

    /// The velocity at which whoever is fixed goes evenly to where he is led in the sub-step \[m/s\].
    fn led(&self, bodies: &Bodies<'_>, row: usize) -> Vec3 {
        between(self.room.as_ref(), bodies.before[0][row], bodies.position[row]) / bodies.substep.seconds()
    }

    /// Lets forces act for a share of the sub-step, in which the next pace is to be made. Whoever is fixed goes evenly, and who has been made heavier
    /// follows those beside him, so that nothing of that comes to swing.
    pub(super) fn kick(&mut self, bodies: &Bodies<'_>, share: f32) {
        let h = bodies.substep.seconds();
        (self.time, self.share) = (h * share, share);
        for (particle, row) in self.chain.members() {
            if self.weight[particle] > 0.0 {
                if self.weight[particle] < bodies.inverse_mass[row] {
                    let beside = [self.chain.before(particle), self.chain.ends(particle)[1]];
                    let [before, next] = beside.map(|beside| self.velocity[beside]);
                    self.velocity[particle] += ((before + next) * 0.5 - self.velocity[particle]) * FOLLOWING;
                }
                self.velocity[particle] += (bodies.velocity[row] - bodies.before[1][row]) * share;
            } else {
                self.velocity[particle] = self.led(bodies, row);
            }
        }
    }

    /// Makes the pace.
    pub(super) fn go(&mut self) {
        for (place, velocity) in self.place.iter_mut().zip(self.velocity.iter()) {
            *place += *velocity * self.time;
        }
    }

    /// Takes out of velocities what they have been given as they set out.
    pub(super) fn arrive(&mut self, bodies: &Bodies<'_>, paces: f32) {
        self.aside.copy_from_slice(self.velocity);
        self.take_up_leads(bodies, paces);
        self.turn_only();
        for (velocity, aside) in self.velocity.iter_mut().zip(self.aside.iter()) {
            *velocity = *aside - *velocity;
        }
    }

    /// The largest square of how far a particle swings across its links in a pace, in radians of its oscillation.
    fn stiffness(&self) -> f32 {
        let square =
            |particle| if self.weight[particle] > 0.0 { self.swing(particle) * self.weight[particle] } else { 0.0 };
        (0..self.weight.len()).map(square).fold(0.0, max)
    }

    /// The force by its way that pulls a particle back which swings across its links: their pull over how long they are. Who is not pulled from both sides
    /// is pulled back by nothing \[kg\].
    fn swing(&self, particle: usize) -> f32 {
        let pull = |link: usize| {
            let distance = self.line(link).map_or(0.0, |line| line.distance);
            if self.pull[link] == 0.0 { 0.0 } else { self.pull[link].abs() / max(distance, self.chain.length(link)) }
        };
        let before = self.chain.before(particle);
        if before >= self.count || particle >= self.count {
            return 0.0;
        }
        let [one, other] = [before, particle].map(pull);
        if one > 0.0 && other > 0.0 { one + other } else { 0.0 }
    }

    /// Makes those heavier who would swing farther.
    pub(super) fn load(&mut self, most: f32) {
        for particle in 0..self.weight.len() {
            let heavy = self.swing(particle) / most;
            if heavy * self.weight[particle] > 1.0 && heavy < f32::INFINITY {
                (self.weight[particle], self.is_loaded) = (1.0 / heavy, true);
            }
        }
    }

    /// Gives all the velocity and the way in the middle that forces show, if nobody is fixed: that keeps the momentum where some have been made heavier.
    fn keep_middle(&mut self, bodies: &Bodies<'_>) {
        if !self.chain.is_free(bodies) {
            return;
        }
        let room = self.room.as_ref();
        let faster = self.mean(bodies, |particle, row| bodies.velocity[row] - self.velocity[particle]);
        let farther = self.mean(bodies, |particle, row| {
            between(room, self.place[particle], between(room, self.origin, bodies.position[row]))
        });
        if let (Some(faster), Some(farther)) = (faster, farther) {
            self.velocity.iter_mut().for_each(|velocity| *velocity += faster);
            self.place.iter_mut().for_each(|place| *place += farther);
        }
    }
}
