//! The direct solution for what links pull.

use super::links::{Line, Links};
use crate::constrain::walls::Wall;
use crate::math::{length, max, min, sqrt};
use glam::Vec3;

/// What a pivot is at the least for each link, a share of the first end's weight: chains that are stretched straight between two fixed ends
/// leave the system singular.
const RIDGE: f32 = 1e-6;

/// Rounds of a solution, at the most.
const ROUNDS: u32 = 8;
/// Rounds of one that has to go by the directions that links have, at the most.
const LAST_ROUNDS: u32 = 24;
/// Rounds of one that has to find which walls press, and how these brake, at the most; those after which what they brake by is taken for known, and those
/// after which none lets go any more. What presses shows within some rounds, and only then what brakes by that.
const WALLED_ROUNDS: u32 = 32;
const BRAKING_ROUNDS: u32 = 16;
const FREEING_ROUNDS: u32 = 20;
/// Rounds after which pulls are known well enough to tell how fast a particle swings across its links.
const TELLING_ROUNDS: u32 = 2;
/// The cosine of how far a link may turn in a pace: by 30°.
const COSINE: f32 = 0.866;
/// How much of what links were off as a solution began may be left before its last round, and of a rounding: what is heavy is thrown about by the least
/// of what rounding leaves of the pull of what is light.
const FINELY: f32 = 1e-3;
const FINE: f32 = 0.01;
/// How far a link may be off after all rounds, a share of its length: what is left is rounding.
const NEARLY: f32 = 1e-4;

/// The directions along which links act.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Way {
    /// Those that they have when the pace begins: that keeps angular momentum, and the energy of what swings no faster than the pace shows.
    First,
    /// Halfway between those and the ones at its end: that holds however fast it swings, and takes some of that.
    Middle,
    /// Those that they have at its end.
    Now,
}

impl Way {
    fn rounds(self) -> u32 {
        if self == Self::Now { LAST_ROUNDS } else { ROUNDS }
    }

    /// The direction of a link along which it acts.
    fn of(self, line: &Line) -> Vec3 {
        match self {
            Self::First => line.first,
            Self::Middle => {
                let middle = line.first + line.normal;
                middle / length(middle)
            }
            Self::Now => line.normal,
        }
    }
}

/// What all links are to do in a round.
struct Round {
    /// True if those that pull are off by no more than rounding.
    is_met: bool,
    /// True if one lets go of what it has pulled.
    lets_go: bool,
    /// True if those that pull are off by next to nothing.
    is_fine: bool,
    /// How far the worst is off, a share of its length.
    worst: f32,
}

impl Links<'_> {
    /// Changes velocities so that all links come to their lengths in a pace of so long \[s\], in a few rounds. Tells whether they have come near.
    pub(super) fn meet(&mut self, time: f32, along: Way) -> bool {
        let (soft, mut worst, mut begun) = (self.chain.compliance / (time * time), 0.0, 0.0);
        self.pull.fill(0.0);
        let by_walls = self.set_out_by_walls();
        for round in 0..if by_walls { WALLED_ROUNDS } else { along.rounds() } {
            let changed = by_walls && self.judge_walls(round);
            if by_walls && along == Way::First && round > TELLING_ROUNDS && self.is_stiff(1.0) {
                return false;
            }
            let Some(Round { is_met, lets_go, is_fine, worst: now }) = self.ask_all(soft, along) else { return false };
            worst = now;
            // Rounding of places is nothing to be made good at once.
            if !changed && !(self.reach > 0.0) || round == 0 && is_met && !lets_go && self.share == 1.0 && !by_walls {
                return true;
            }
            if by_walls && !changed && !lets_go && (is_met || worst < FINELY * begun) {
                return true;
            }
            begun = if round == 0 { worst } else { begun };
            if along == Way::Now {
                // Straight across a taut link it takes the root of that to close a gap.
                let longest = self.chain.lengths.iter().copied().fold(0.0, max);
                self.reach += sqrt(0.5 * self.reach * longest);
            }
            if !self.solve(soft) {
                return false;
            }
            self.act(time);
            self.note_faster(time);
            if !lets_go && !by_walls && (is_fine || round > 0 && worst < FINELY * begun) {
                return true;
            }
        }
        worst < NEARLY
    }

    /// Lets walls that have pressed do so from the beginning; tells whether any is near.
    fn set_out_by_walls(&mut self) -> bool {
        let any = self.is_by_walls();
        if any {
            self.aside.fill(Vec3::ZERO);
            self.by_walls(Wall::set_out);
        }
        any
    }

    /// Looks before a round which walls press, and in the first ones which let go and what friction does; tells whether that is other than in the round
    /// before.
    fn judge_walls(&mut self, round: u32) -> bool {
        let may = [round < FREEING_ROUNDS, round < BRAKING_ROUNDS];
        round == 0 || self.by_walls(|wall, pace, pushed| wall.judge_pace(pace, pushed, may))
    }

    /// Asks all links to come to their lengths. None, if one turns too far in the pace.
    fn ask_all(&mut self, soft: f32, along: Way) -> Option<Round> {
        let mut all = Round { is_met: true, lets_go: false, is_fine: true, worst: 0.0 };
        self.reach = 0.0;
        for link in 0..self.count {
            let Some(line) = self.line(link) else {
                self.pass_over(link);
                continue;
            };
            let rounding = self.rounding(&line);
            let open = line.longer + self.due(line.before - line.rest) + soft * self.pull[link];
            let slack = self.chain.tether && self.pull[link] * (line.weight + soft) >= open;
            self.way[link] = along.of(&line);
            let turn = self.way[link].dot(line.normal);
            if turn < COSINE {
                if !slack {
                    return None;
                }
                self.way[link] = line.normal;
            } else if !slack {
                self.turn = min(self.turn, turn);
            }
            self.ask(link, slack, line.normal, open, line.weight);
            if slack {
                all.lets_go |= self.pull[link] != 0.0;
            } else {
                all.is_met &= open.abs() <= rounding;
                all.is_fine &= open.abs() <= FINE * rounding;
                all.worst = max(all.worst, open.abs() / (line.distance + line.rest));
            }
        }
        Some(all)
    }

    /// By how much a link has to get shorter in a pace that is so much too long as the sub-step begins \[m\]. A rigid one gets so fast as to do it in
    /// the whole of it: what was drawn out would be shot about, and what is heavy be thrown about by rounding of places.
    fn due(&self, off: f32) -> f32 {
        let is_rigid = self.chain.compliance == 0.0 && !(self.chain.tether && off < 0.0);
        if is_rigid { off * self.share } else { off }
    }

    /// A link that has no direction does nothing in a round.
    fn pass_over(&mut self, link: usize) {
        (self.normal[link], self.way[link], self.change[link]) = (Vec3::ZERO, Vec3::ZERO, 0.0);
    }

    /// Takes out of velocities what makes links longer, or shorter if they push, as far as they are softened by so much.
    pub(super) fn brake(&mut self, soft: f32) {
        let by_walls = self.set_out_by_walls();
        let rounds = if self.chain.tether { ROUNDS } else { 1 };
        for round in 0..if by_walls { WALLED_ROUNDS } else { rounds } {
            let changed = by_walls && self.judge_walls(round);
            let mut is_met = true;
            self.reach = 0.0;
            for link in 0..self.count {
                let Some(line) = self.line(link) else {
                    self.pass_over(link);
                    continue;
                };
                let loose = self.chain.tether && line.distance < line.rest - 4.0 * self.rounding(&line);
                let open = self.parting(&line).dot(line.normal) + soft * self.pull[link];
                let slack = loose || self.chain.tether && self.pull[link] * (line.weight + soft) >= open;
                self.way[link] = line.normal;
                self.ask(link, slack, line.normal, open, line.weight);
                is_met &= slack && self.pull[link] == 0.0;
            }
            if is_met && !changed || by_walls && !changed && !self.chain.tether || !self.solve(soft) {
                break;
            }
            self.act(1.0);
            self.note_faster(1.0);
        }
        if self.chain.tether {
            self.let_go(1.0);
        }
    }

    /// Asks a link to close what it is open by; one that is slack lets go of what it has pulled.
    pub(super) fn ask(&mut self, link: usize, slack: bool, normal: Vec3, open: f32, weight: f32) {
        let pull = self.pull[link];
        (self.normal[link], self.change[link]) = if slack { (Vec3::ZERO, -pull) } else { (normal, -open) };
        self.reach += if slack { pull.abs() * weight } else { open.abs() };
    }

    /// Minus what λ of a neighbour changes in a link, through the particle that both have.
    fn coupling(&self, link: usize, neighbour: usize, particle: usize) -> f32 {
        let [normal, way] = [self.normal[link], self.way[neighbour]].map(|along| self.pass(particle, along));
        self.weight_at(particle, [normal, way]) * normal.dot(way)
    }

    /// The inverse masses of a link's ends, as far as walls let these go along it \[1/kg\].
    fn bearing(&self, link: usize) -> [f32; 2] {
        let (normal, way) = (self.normal[link], self.way[link]);
        self.chain.ends(link).map(|end| {
            let [one, other] = [normal, way].map(|along| self.pass(end, along));
            self.weight_at(end, [one, other]) * (one.dot(other) / normal.dot(way))
        })
    }

    /// What λ of a link changes in itself; one if it is not to act.
    fn diagonal(&self, link: usize, soft: f32) -> f32 {
        if self.normal[link] == Vec3::ZERO {
            return 1.0;
        }
        let [p, q] = self.bearing(link);
        (p + q) * self.normal[link].dot(self.way[link]) * (1.0 + RIDGE) + soft
    }

    /// What elimination of the links before leaves of a link's λ in itself, through its first end alone.
    fn remains(&self, link: usize, left: f32, pivot: f32) -> f32 {
        if self.normal[link] == Vec3::ZERO {
            return 0.0;
        }
        let pass = |along: Vec3| self.pass(link, along);
        let (normal, way) = (pass(self.normal[link]), pass(self.way[link]));
        let weight = self.weight_at(link, [normal, way]);
        let own = normal.dot(way);
        match link.checked_sub(1).filter(|&i| self.normal[i] != Vec3::ZERO) {
            // (n₁·w₁)(n₀·w₀) − (n₁·w₀)(n₀·w₁) = (n₁ × n₀)·(w₁ × w₀).
            Some(i) => {
                let bend = normal.cross(pass(self.normal[i])).dot(way.cross(pass(self.way[i])));
                // Who is drawn through the straight line between those beside him would be drawn the wrong way.
                weight * ((own * left + weight * max(bend, 0.0)) / pivot)
            }
            None => weight * own,
        }
    }

    /// The pivot of a link of whose own such a rest is left.
    fn pivot(&self, link: usize, left: f32) -> f32 {
        if self.normal[link] == Vec3::ZERO {
            return 1.0;
        }
        let [first, second] = self.bearing(link);
        let own = self.normal[link].dot(self.way[link]);
        let least = if second > 0.0 { 0.5 * second } else { RIDGE * self.count as f32 * first };
        max(own * second + left, least * own)
    }

    /// Solves for the changes of λ: elimination from the first link to the last, and back. Tells whether there is a solution.
    pub(super) fn solve(&mut self, soft: f32) -> bool {
        let closed = self.count == self.weight.len();
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

    /// The sum of a particle's links, along which they act, by such numbers.
    pub(super) fn sum_at(&self, particle: usize, of: &[f32]) -> Vec3 {
        let mut sum = Vec3::ZERO;
        if particle < self.count {
            sum += self.way[particle] * of[particle];
        }
        let before = self.chain.before(particle);
        if before < self.count {
            sum -= self.way[before] * of[before];
        }
        sum
    }

    /// By how much the changes of λ move a particle.
    fn movement(&self, particle: usize) -> Option<Vec3> {
        let by = self.faster_by_wall(particle, self.sum_at(particle, self.change));
        (self.weight[particle] > 0.0 && by.is_finite()).then_some(by)
    }

    /// Lets the changes of λ act, which change velocities by what they move over a time \[s\].
    pub(super) fn act(&mut self, time: f32) {
        let mut farthest = 0.0;
        for particle in 0..self.weight.len() {
            farthest = self.movement(particle).map_or(farthest, |by| max(farthest, length(by)));
        }
        let share = if farthest > 2.0 * self.reach { 2.0 * self.reach / farthest } else { 1.0 };
        for (pull, change) in self.pull.iter_mut().zip(self.change.iter_mut()) {
            *change *= share;
            *pull += *change;
        }
        for particle in 0..self.weight.len() {
            if let Some(by) = self.movement(particle) {
                self.velocity[particle] += by * (1.0 / time);
            }
        }
    }

    /// Notes by how much the changes of λ, which have acted, would have made particles by walls faster without these.
    fn note_faster(&mut self, time: f32) {
        for particle in 0..if self.walls.is_empty() { 0 } else { self.weight.len() } {
            if self.wall(particle).is_none() {
                continue;
            }
            self.aside[particle] += self.faster(particle, self.sum_at(particle, self.change)) * (1.0 / time);
        }
    }

    /// The impulse that links give a particle in the pace \[kg m/s\].
    pub(super) fn pulled(&self, particle: usize) -> Vec3 {
        self.sum_at(particle, self.pull) * (1.0 / self.time)
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
            self.note_faster(time);
        }
    }

    /// Takes out of velocities what makes links longer or shorter, but for those that are slack, and what leads through walls that press.
    pub(super) fn turn_only(&mut self) {
        for particle in 0..if self.walls.is_empty() { 0 } else { self.weight.len() } {
            self.velocity[particle] = self.along_wall(particle, self.velocity[particle]);
        }
        self.pull.fill(0.0);
        (self.reach, self.time) = (0.0, 0.0);
        for link in 0..self.count {
            let Some(line) = self.line(link) else {
                self.pass_over(link);
                continue;
            };
            self.way[link] = line.normal;
            let open = self.parting(&line).dot(line.normal);
            self.ask(link, self.is_slack(&line), line.normal, open, line.weight);
        }
        if self.reach > 0.0 && self.solve(0.0) {
            self.act(1.0);
        }
        self.pull.fill(0.0);
    }
}
