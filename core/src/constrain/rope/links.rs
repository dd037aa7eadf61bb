//! The links of a rope in a sub-step, and the direct solution for what they pull.

use super::super::{Bodies, SHIFTED};
use crate::index::{Room, between};
use crate::math::{largest, length, max, sqrt};
use crate::memory::take;
use glam::Vec3;

/// What a pivot is at the least for each link, a share of the first end's weight: chains that are stretched straight between two fixed ends
/// leave the system singular.
const RIDGE: f32 = 1e-6;

/// How much of what its neighbours are faster is given in a pace to a particle that has been made heavier.
const FOLLOWING: f32 = 0.125;

/// The row of a particle that is not there.
pub(super) const NOBODY: u32 = u32::MAX;

/// Words for each particle.
pub(super) const WORDS: usize = 21;

/// The links of a chain in a sub-step. Link i joins the particles i and i + 1, the last one of a closed chain its last and first. They move copies of
/// their particles, told from near, so that the shortest of paces loses nothing in rounding, wherever they are.
pub(super) struct Links<'m> {
    /// The number of links.
    pub(super) count: usize,
    /// How far it all goes wrong, summed over the links: nothing is moved farther than twice that.
    pub(super) reach: f32,
    /// The cosine of how far a link has turned in a pace, at the most.
    pub(super) turn: f32,
    /// The share of the sub-step that a pace is.
    pub(super) share: f32,
    /// How long it takes from where the copies are to where links are met, with the velocities of the copies \[s\].
    time: f32,
    /// Where places are told from \[m\], and the room that they are in.
    origin: Vec3,
    room: Option<Room>,
    /// The row of each particle.
    pub(super) rows: &'m mut [u32],
    /// λ of each link, below zero where it pulls \[kg m\], or \[kg m/s\] where velocities are settled.
    pub(super) pull: &'m mut [f32],
    /// By how much the link has to get longer; when it has been solved, the change of its λ.
    change: &'m mut [f32],
    /// What elimination has left beside the diagonal, and of the column of the link that closes the chain.
    upper: &'m mut [f32],
    border: &'m mut [f32],
    /// The inverse mass of each particle \[1/kg\].
    weight: &'m mut [f32],
    /// The direction that each link has, to its first end; zero if it is not to act.
    normal: &'m mut [Vec3],
    /// The direction along which it acts.
    pub(super) way: &'m mut [Vec3],
    /// Where each particle is \[m\], and how fast it goes \[m/s\].
    place: &'m mut [Vec3],
    pub(super) velocity: &'m mut [Vec3],
    /// Velocities put by \[m/s\].
    aside: &'m mut [Vec3],
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
    /// The sum of its ends' inverse masses \[1/kg\].
    pub(super) weight: f32,
}

/// The particles that are there, and their rows.
fn living(rows: &[u32]) -> impl DoubleEndedIterator<Item = (usize, usize)> + Clone + use<'_> {
    rows.iter().map(|&row| row as usize).enumerate().filter(|&(_, row)| row != NOBODY as usize)
}

impl<'m> Links<'m> {
    /// Memory for them, in which nothing acts, and what is left of it.
    pub(super) fn new(words: &'m mut [u32], particles: usize, links: usize) -> (Self, &'m mut [u32]) {
        let mut rest = words;
        let mut own = take(&mut rest, WORDS * particles);
        own.fill(0);
        let rows = take(&mut own, particles);
        rows.fill(NOBODY);
        let [pull, change, upper, border, weight] =
            [(); 5].map(|()| bytemuck::cast_slice_mut(take(&mut own, particles)));
        let [normal, way, place, velocity, aside] =
            [(); 5].map(|()| bytemuck::cast_slice_mut(take(&mut own, 3 * particles)));
        let (count, origin, room) = (links.min(aside.len()), Vec3::ZERO, None);
        #[rustfmt::skip]
        let nothing = Self {
            count, reach: 0.0, turn: 1.0, share: 1.0, time: 0.0, origin, room, rows, pull, change, upper, border, weight, normal, way, place, velocity, aside,
        };
        (nothing, rest)
    }

    /// Copies how fast all go, how heavy they are and where they were so long ago \[s\] with these velocities.
    pub(super) fn take_up(&mut self, bodies: &Bodies<'_>, time: f32) {
        let first = living(self.rows).next();
        self.origin = first.map_or(Vec3::ZERO, |(_, row)| bodies.position[row]);
        self.room = bodies.near.room().copied();
        (self.time, self.share) = (time, 1.0);
        for (particle, row) in living(self.rows) {
            let place = between(self.room.as_ref(), self.origin, bodies.position[row]);
            self.place[particle] = place - bodies.velocity[row] * time;
            self.velocity[particle] = bodies.velocity[row];
            self.weight[particle] = bodies.inverse_mass[row];
        }
    }

    /// Gives the velocities of the copies to those of whom they are, and moves these by as much as that is in a time \[s\].
    pub(super) fn hand_back(&self, bodies: &mut Bodies<'_>, time: f32) {
        for (particle, row) in living(self.rows).filter(|&(particle, _)| self.weight[particle] > 0.0) {
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
        for (particle, row) in living(self.rows).filter(|&(particle, _)| self.weight[particle] > 0.0) {
            let (room, place) = (self.room.as_ref(), self.place[particle]);
            // The shortest way to there: the copy has gone through the sides on its own.
            bodies.position[row] += between(room, between(room, self.origin, bodies.position[row]), place);
            bodies.velocity[row] = self.velocity[particle];
            bodies.marks[row] |= SHIFTED;
        }
    }

    /// The numbers of a link's ends among the particles.
    pub(super) fn ends(&self, link: usize) -> [usize; 2] {
        let next = link + 1;
        [link, if next == self.rows.len() { 0 } else { next }]
    }

    /// The numbers of those beside a particle.
    fn beside(&self, particle: usize) -> [usize; 2] {
        let before = if particle > 0 { particle - 1 } else { self.rows.len() - 1 };
        [before, self.ends(particle)[1]]
    }

    /// A link as it lies; none if it cannot act.
    pub(super) fn line(&self, link: usize) -> Option<Line> {
        let ends = self.ends(link);
        let [p, q] = ends;
        let weight = self.weight[p] + self.weight[q];
        if ends.iter().any(|&end| self.rows[end] == NOBODY) || !(weight > 0.0) {
            return None;
        }
        let from = between(self.room.as_ref(), self.place[q], self.place[p]);
        let by = (self.velocity[p] - self.velocity[q]) * self.time;
        let apart = from + by;
        let [before, distance] = [from, apart].map(length);
        let normal = apart / distance;
        let first = if before > 0.0 { from / before } else { normal };
        let longer = by.dot(from + apart) / (before + distance);
        (distance > 0.0 && before + distance < f32::INFINITY).then_some(Line {
            ends,
            distance,
            normal,
            first,
            before,
            longer,
            weight,
        })
    }

    /// How fast a link's ends go apart \[m/s\].
    pub(super) fn parting(&self, line: &Line) -> Vec3 {
        let [p, q] = line.ends;
        self.velocity[p] - self.velocity[q]
    }

    /// The rounding of a link's length, from where its ends are \[m\].
    pub(super) fn rounding(&self, line: &Line, rest: f32) -> f32 {
        let [p, q] = line.ends.map(|end| largest(self.place[end]));
        f32::EPSILON * (largest(self.origin) + max(p, q) + line.distance + rest)
    }

    /// Asks a link to close what it is open by; one that is slack lets go of what it has pulled.
    pub(super) fn ask(&mut self, link: usize, slack: bool, normal: Vec3, open: f32, weight: f32) {
        let pull = self.pull[link];
        (self.normal[link], self.change[link]) = if slack { (Vec3::ZERO, -pull) } else { (normal, -open) };
        self.reach += if slack { pull.abs() * weight } else { open.abs() };
    }

    /// Minus what λ of a neighbour changes in a link, through the particle that both have.
    fn coupling(&self, link: usize, neighbour: usize, particle: usize) -> f32 {
        self.weight[particle] * self.normal[link].dot(self.way[neighbour])
    }

    /// What λ of a link changes in itself; one if it is not to act.
    fn diagonal(&self, link: usize, soft: f32) -> f32 {
        if self.normal[link] == Vec3::ZERO {
            return 1.0;
        }
        let [p, q] = self.ends(link).map(|end| self.weight[end]);
        (p + q) * self.normal[link].dot(self.way[link]) * (1.0 + RIDGE) + soft
    }

    /// What elimination of the links before leaves of a link's λ in itself, through its first end alone.
    fn remains(&self, link: usize, left: f32, pivot: f32) -> f32 {
        if self.normal[link] == Vec3::ZERO {
            return 0.0;
        }
        let (own, weight) = (self.normal[link].dot(self.way[link]), self.weight[link]);
        match link.checked_sub(1).filter(|&i| self.normal[i] != Vec3::ZERO) {
            // (n₁·w₁)(n₀·w₀) − (n₁·w₀)(n₀·w₁) = (n₁ × n₀)·(w₁ × w₀).
            Some(i) => {
                let bend = self.normal[link].cross(self.normal[i]).dot(self.way[link].cross(self.way[i]));
                weight * ((own * left + weight * bend) / pivot)
            }
            None => weight * own,
        }
    }

    /// The pivot of a link of whose own such a rest is left.
    fn pivot(&self, link: usize, left: f32) -> f32 {
        if self.normal[link] == Vec3::ZERO {
            return 1.0;
        }
        let [first, second] = self.ends(link).map(|end| self.weight[end]);
        let own = self.normal[link].dot(self.way[link]);
        let least = if second > 0.0 { 0.5 * second } else { RIDGE * self.count as f32 * first };
        max(own * second + left, least * own)
    }

    /// Solves for the changes of λ: elimination from the first link to the last, and back. Tells whether there is a solution.
    pub(super) fn solve(&mut self, soft: f32) -> bool {
        let closed = self.count == self.rows.len();
        let open = self.count - usize::from(closed);
        let last = self.count - 1;
        // What is left of a link's own pivot without its second end: no difference of what is nearly the same, which would lose a heavy bob.
        let mut left = 0.0;
        for link in 0..open {
            let lower = if link > 0 { -self.coupling(link, link - 1, link) } else { 0.0 };
            let upper = if link + 1 < open { -self.coupling(link, link + 1, link + 1) } else { 0.0 };
            let mut border = 0.0;
            if closed && link == 0 {
                border -= self.coupling(link, last, 0);
            }
            if closed && link + 1 == open {
                border -= self.coupling(link, last, last);
            }
            let [before, beside, pivot] = match link.checked_sub(1) {
                Some(i) => [self.change[i], self.border[i], self.pivot(i, left)],
                None => [0.0, 0.0, 1.0],
            };
            left = soft + self.remains(link, left, pivot);
            let pivot = self.pivot(link, left);
            self.upper[link] = upper / pivot;
            self.change[link] = (self.change[link] - lower * before) / pivot;
            self.border[link] = (border - lower * beside) / pivot;
        }
        for link in (0..open.saturating_sub(1)).rev() {
            let upper = self.upper[link];
            self.change[link] -= upper * self.change[link + 1];
            self.border[link] -= upper * self.border[link + 1];
        }
        if closed {
            let first = -self.coupling(last, 0, 0);
            let lower = -self.coupling(last, last - 1, last);
            let diagonal = self.diagonal(last, soft);
            let pivot = diagonal - first * self.border[0] - lower * self.border[last - 1];
            let rest = self.change[last] - first * self.change[0] - lower * self.change[last - 1];
            let closing = rest / max(pivot, diagonal * RIDGE);
            self.change[last] = closing;
            for link in 0..last {
                self.change[link] -= self.border[link] * closing;
            }
        }
        self.change[..self.count].iter().all(|change| change.is_finite())
    }

    /// By how much the changes of λ move a particle.
    fn movement(&self, particle: usize) -> Option<Vec3> {
        let weight = self.weight[particle];
        let mut sum = Vec3::ZERO;
        if particle < self.count {
            sum += self.way[particle] * self.change[particle];
        }
        let before = if particle > 0 { particle - 1 } else { self.rows.len() - 1 };
        if before < self.count {
            sum -= self.way[before] * self.change[before];
        }
        let by = sum * weight;
        (weight > 0.0 && by.is_finite()).then_some(by)
    }

    /// Lets the changes of λ act, which change velocities by what they move over a time \[s\].
    pub(super) fn act(&mut self, time: f32) {
        let mut farthest = 0.0;
        for particle in 0..self.rows.len() {
            farthest = self.movement(particle).map_or(farthest, |by| max(farthest, length(by)));
        }
        let share = if farthest > 2.0 * self.reach { 2.0 * self.reach / farthest } else { 1.0 };
        for (pull, change) in self.pull.iter_mut().zip(self.change.iter_mut()) {
            *change *= share;
            *pull += *change;
        }
        for particle in 0..self.rows.len() {
            if let Some(by) = self.movement(particle) {
                self.velocity[particle] += by * (1.0 / time);
            }
        }
    }

    /// Tells whether any of them pulls or pushes.
    pub(super) fn has_acted(&self) -> bool {
        self.pull.iter().any(|&pull| pull != 0.0)
    }

    /// Takes back what links push.
    pub(super) fn let_go(&mut self, time: f32) {
        let mut pushes = false;
        for (change, &pull) in self.change.iter_mut().zip(self.pull.iter()) {
            *change = if pull > 0.0 { -pull } else { 0.0 };
            pushes |= pull > 0.0;
        }
        self.reach = f32::MAX;
        if pushes {
            self.act(time);
        }
    }

    /// Takes out of velocities what makes links longer or shorter, but for those that are slack.
    pub(super) fn turn_only(&mut self, is_slack: impl Fn(usize, &Line) -> bool) {
        self.pull.fill(0.0);
        (self.reach, self.time) = (0.0, 0.0);
        for link in 0..self.count {
            let Some(line) = self.line(link) else { continue };
            self.way[link] = line.normal;
            let open = self.parting(&line).dot(line.normal);
            self.ask(link, is_slack(link, &line), line.normal, open, line.weight);
        }
        if self.reach > 0.0 && self.solve(0.0) {
            self.act(1.0);
        }
        self.pull.fill(0.0);
    }

    /// Takes for velocities what the method has shown beyond them, if it had gone in so many paces: as fast as all would have to be for how far it has
    /// brought them beyond where velocities lead.
    fn take_up_leads(&mut self, bodies: &Bodies<'_>, paces: f32) {
        let h = bodies.substep.seconds();
        for (particle, row) in living(self.rows) {
            let [from, before] = bodies.before.map(|before| before[row]);
            let (way, gained) =
                (between(self.room.as_ref(), from, bodies.position[row]), bodies.velocity[row] - before);
            let moves = bodies.inverse_mass[row] > 0.0;
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
        if living(self.rows).any(lags) { 2.0 } else { 1.0 }
    }

    /// Takes out of places what the method shows beyond velocities: of all, if somebody is fixed, else what lengths show of it.
    pub(super) fn catch_up(&mut self, bodies: &mut Bodies<'_>, is_slack: impl Fn(usize, &Line) -> bool) {
        if living(self.rows).any(|(_, row)| !(bodies.inverse_mass[row] > 0.0)) {
            return living(self.rows).for_each(|(_, row)| bodies.catch_up(row));
        }
        let h = bodies.substep.seconds();
        self.take_up(bodies, 0.0);
        self.take_up_leads(bodies, 1.0);
        self.aside.copy_from_slice(self.velocity);
        self.turn_only(is_slack);
        for (particle, row) in living(self.rows) {
            let by = (self.aside[particle] - self.velocity[particle]) * h;
            if by.is_finite() {
                bodies.position[row] -= by;
            }
        }
    }

    /// Puts all back to where they were as the sub-step began, with the velocities with which they would go on from there in so many paces.
    pub(super) fn set_out(&mut self, bodies: &Bodies<'_>, paces: f32, is_slack: impl Fn(usize, &Line) -> bool) {
        for (particle, row) in living(self.rows) {
            self.place[particle] = between(self.room.as_ref(), self.origin, bodies.before[0][row]);
        }
        self.turn = 1.0;
        self.take_up_leads(bodies, paces);
        self.turn_only(is_slack);
        for (particle, row) in living(self.rows) {
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
        for (particle, row) in living(self.rows) {
            if self.weight[particle] > 0.0 {
                if self.weight[particle] < bodies.inverse_mass[row] {
                    let [before, next] = self.beside(particle).map(|beside| self.velocity[beside]);
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
    pub(super) fn arrive(&mut self, bodies: &Bodies<'_>, paces: f32, is_slack: impl Fn(usize, &Line) -> bool) {
        self.aside.copy_from_slice(self.velocity);
        self.take_up_leads(bodies, paces);
        self.turn_only(is_slack);
        for (velocity, aside) in self.velocity.iter_mut().zip(self.aside.iter()) {
            *velocity = *aside - *velocity;
        }
    }

    /// The largest square of how far a particle swings across its links in a pace, in radians of its oscillation.
    pub(super) fn stiffness(&self, rest: impl Fn(usize) -> f32) -> f32 {
        let square = |particle| self.swing(particle, &rest) * self.weight[particle];
        (0..self.rows.len()).map(square).fold(0.0, max)
    }

    /// The force by its way that pulls a particle back which swings across its links: their pull over how long they are. Past the end of an open chain nothing does \[kg\].
    fn swing(&self, particle: usize, rest: impl Fn(usize) -> f32) -> f32 {
        let before = if particle > 0 { particle - 1 } else { self.rows.len() - 1 };
        let pull = |link: usize| {
            let distance = self.line(link).map_or(0.0, |line| line.distance);
            if self.pull[link] == 0.0 { 0.0 } else { self.pull[link].abs() / max(distance, rest(link)) }
        };
        if before < self.count && particle < self.count { pull(before) + pull(particle) } else { 0.0 }
    }

    /// Makes those heavier who would swing farther.
    pub(super) fn load(&mut self, most: f32, rest: impl Fn(usize) -> f32) {
        for particle in 0..self.rows.len() {
            let heavy = self.swing(particle, &rest) / most;
            if heavy * self.weight[particle] > 1.0 && heavy < f32::INFINITY {
                self.weight[particle] = 1.0 / heavy;
            }
        }
    }

    /// Takes all to where they were as the sub-step began, in the middle of all of their masses if nobody is fixed: that keeps their momentum.
    pub(super) fn keep_form(&mut self, bodies: &Bodies<'_>) {
        let h = bodies.substep.seconds();
        let room = bodies.near.room();
        let way = |row: usize| between(room, bodies.before[0][row], bodies.position[row]);
        let moves = |row: usize| bodies.inverse_mass[row] > 0.0;
        let (mut sum, mut mass) = (Vec3::ZERO, 0.0);
        for (_, row) in living(self.rows) {
            sum += way(row) * bodies.mass[row];
            mass += bodies.mass[row];
        }
        let is_free = living(self.rows).all(|(_, row)| moves(row));
        // One that is no number keeps nobody else from being one.
        let together = Some(sum / mass).filter(|mean| is_free && mean.is_finite()).unwrap_or(Vec3::ZERO);
        for (particle, row) in living(self.rows).filter(|&(_, row)| moves(row)) {
            self.velocity[particle] = bodies.velocity[row] + (together - way(row)) * (1.0 / h);
        }
        // Nothing pulls that could be taken back.
        self.pull.fill(0.0);
    }

    /// The velocity that all of it has: that of whoever is fixed, else the mean by mass \[m/s\].
    fn drift(&self, bodies: &Bodies<'_>) -> Vec3 {
        let (mut sum, mut mass) = (Vec3::ZERO, 0.0);
        for (particle, row) in living(self.rows) {
            if !(self.weight[particle] > 0.0) {
                return self.velocity[particle];
            }
            sum += self.velocity[particle] * bodies.mass[row];
            mass += bodies.mass[row];
        }
        if mass > 0.0 { sum / mass } else { Vec3::ZERO }
    }

    /// Twice the kinetic energy beside that, after so much more of what forces do in the sub-step \[J\].
    pub(super) fn vigour(&self, bodies: &Bodies<'_>, share: f32) -> f32 {
        let drift = self.drift(bodies);
        let moving = living(self.rows).filter(|&(particle, _)| self.weight[particle] > 0.0);
        let twice = moving.map(|(particle, row)| {
            let gained = bodies.velocity[row] - bodies.before[1][row];
            (self.velocity[particle] + gained * share - drift).length_squared() * bodies.mass[row]
        });
        twice.sum()
    }

    /// The work of forces on the way to where all are from where they were as the sub-step began, beside what all of it moves \[J\].
    pub(super) fn work(&self, bodies: &Bodies<'_>) -> f32 {
        let (h, drift) = (bodies.substep.seconds(), self.drift(bodies));
        let moving = living(self.rows).filter(|&(particle, _)| self.weight[particle] > 0.0);
        let work = moving.map(|(particle, row)| {
            let from = between(self.room.as_ref(), self.origin, bodies.before[0][row]);
            let (way, gained) = (self.place[particle] - from - drift * h, bodies.velocity[row] - bodies.before[1][row]);
            way.dot(gained) * (bodies.mass[row] / h)
        });
        work.sum()
    }

    /// Slows all down so that twice their kinetic energy is no more than `most`, where it is `now` \[J\].
    pub(super) fn calm(&mut self, bodies: &Bodies<'_>, now: f32, most: f32) {
        let drift = self.drift(bodies);
        if now > most {
            let share = sqrt(max(most, 0.0) / now);
            self.velocity.iter_mut().for_each(|velocity| *velocity = drift + (*velocity - drift) * share);
        }
    }
}
