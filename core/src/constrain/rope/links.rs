//! The links of a rope in a sub-step, and the direct solution for what they pull.

use super::super::Bodies;
use crate::math::{length, max, sqrt};
use crate::memory::take;
use glam::Vec3;

/// What a pivot is at the least for each link, a share of the first end's weight: chains that are stretched straight between two fixed ends
/// leave the system singular.
const RIDGE: f32 = 1e-6;

/// The row of a particle that is not there.
pub(super) const NOBODY: u32 = u32::MAX;

/// Moves a particle, and its velocity with it; puts one that is fixed to a place, and leaves its velocity.
pub(super) fn put(bodies: &mut Bodies<'_>, row: usize, by: Vec3, to: Vec3) {
    if bodies.inverse_mass[row] > 0.0 {
        bodies.shift(row, by);
    } else {
        bodies.position[row] = to;
    }
}

/// The links of a chain in a sub-step. Link i joins the particles i and i + 1, the last one of a closed chain its last and first.
pub(super) struct Links<'m> {
    /// The number of links.
    pub(super) count: usize,
    /// How far it all goes wrong, summed over the links: nothing is moved farther than twice that.
    pub(super) reach: f32,
    /// The row of each particle.
    pub(super) rows: &'m mut [u32],
    /// λ of each link, below zero where it pulls [kg m], or [kg m/s] where velocities are settled.
    pub(super) pull: &'m mut [f32],
    /// By how much the link has to get longer; when it has been solved, the change of its λ.
    pub(super) change: &'m mut [f32],
    /// What elimination has left beside the diagonal, and of the column of the link that closes the chain.
    pub(super) upper: &'m mut [f32],
    pub(super) border: &'m mut [f32],
    /// The direction that each link has, to its first end; zero if it is not to act.
    pub(super) normal: &'m mut [Vec3],
    /// The direction along which it acts.
    pub(super) way: &'m mut [Vec3],
    /// Where the method has moved each particle.
    pub(super) aim: &'m mut [Vec3],
}

/// A link as it lies.
pub(super) struct Line {
    pub(super) rows: [usize; 2],
    pub(super) apart: Vec3,
    pub(super) distance: f32,
    pub(super) normal: Vec3,
}

impl<'m> Links<'m> {
    /// Memory for them, in which nothing acts.
    pub(super) fn new(words: &'m mut [u32], particles: usize, links: usize) -> Self {
        let mut rest = words;
        let rows = take(&mut rest, particles);
        rows.fill(NOBODY);
        let mut floats = |count: usize| {
            let words = take(&mut rest, count);
            words.fill(0);
            words
        };
        let [pull, change, upper, border] = core::array::from_fn(|_| bytemuck::cast_slice_mut(floats(particles)));
        let [normal, way, aim] = core::array::from_fn(|_| bytemuck::cast_slice_mut(floats(3 * particles)));
        let count = links.min(aim.len());
        Self { count, reach: 0.0, rows, pull, change, upper, border, normal, way, aim }
    }

    /// The numbers of a link's ends among the particles.
    pub(super) fn ends(&self, link: usize) -> [usize; 2] {
        let next = link + 1;
        [link, if next == self.rows.len() { 0 } else { next }]
    }

    /// A link as it lies; none if it cannot act.
    pub(super) fn line(&self, bodies: &Bodies<'_>, link: usize) -> Option<Line> {
        let rows = self.ends(link).map(|end| self.rows[end] as usize);
        let [p, q] = rows;
        if p >= bodies.len() || q >= bodies.len() || !(bodies.inverse_mass[p] + bodies.inverse_mass[q] > 0.0) {
            return None;
        }
        let apart = bodies.between(q, p);
        let distance = length(apart);
        (distance > 0.0 && distance < f32::INFINITY).then(|| Line { rows, apart, distance, normal: apart / distance })
    }

    /// Asks a link to close what it is open by; one that is slack lets go of what it has pulled.
    pub(super) fn ask(&mut self, link: usize, slack: bool, normal: Vec3, open: f32, weight: f32) {
        let pull = self.pull[link];
        (self.normal[link], self.change[link]) = if slack { (Vec3::ZERO, -pull) } else { (normal, -open) };
        self.reach += if slack { pull.abs() * weight } else { open.abs() };
    }

    /// Minus what λ of a neighbour changes in a link, through the particle that both have.
    fn coupling(&self, bodies: &Bodies<'_>, link: usize, neighbour: usize, particle: usize) -> f32 {
        let row = self.rows[particle] as usize;
        if row < bodies.len() { bodies.inverse_mass[row] * self.normal[link].dot(self.way[neighbour]) } else { 0.0 }
    }

    /// What λ of a link changes in itself; one if it is not to act.
    fn diagonal(&self, bodies: &Bodies<'_>, link: usize, soft: f32) -> f32 {
        if self.normal[link] == Vec3::ZERO {
            return 1.0;
        }
        let [p, q] = self.ends(link).map(|end| bodies.inverse_mass[self.rows[end] as usize]);
        (p + q) * self.normal[link].dot(self.way[link]) * (1.0 + RIDGE) + soft
    }

    /// What elimination of the links before leaves of a link's λ in itself, through its first end alone.
    fn remains(&self, bodies: &Bodies<'_>, link: usize, left: f32, pivot: f32) -> f32 {
        if self.normal[link] == Vec3::ZERO {
            return 0.0;
        }
        let (own, weight) = (self.normal[link].dot(self.way[link]), bodies.inverse_mass[self.rows[link] as usize]);
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
    fn pivot(&self, bodies: &Bodies<'_>, link: usize, left: f32) -> f32 {
        if self.normal[link] == Vec3::ZERO {
            return 1.0;
        }
        let [first, second] = self.ends(link).map(|end| bodies.inverse_mass[self.rows[end] as usize]);
        let own = self.normal[link].dot(self.way[link]);
        let least = if second > 0.0 { 0.5 * second } else { RIDGE * self.count as f32 * first };
        max(own * second + left, least * own)
    }

    /// Solves for the changes of λ: elimination from the first link to the last, and back. Tells whether there is a solution.
    pub(super) fn solve(&mut self, bodies: &Bodies<'_>, soft: f32) -> bool {
        let closed = self.count == self.rows.len();
        let open = self.count - usize::from(closed);
        let last = self.count - 1;
        // What is left of a link's own pivot without its second end: no difference of what is nearly the same, which would lose a heavy bob.
        let mut left = 0.0;
        for link in 0..open {
            let lower = if link > 0 { -self.coupling(bodies, link, link - 1, link) } else { 0.0 };
            let upper = if link + 1 < open { -self.coupling(bodies, link, link + 1, link + 1) } else { 0.0 };
            let mut border = 0.0;
            if closed && link == 0 {
                border -= self.coupling(bodies, link, last, 0);
            }
            if closed && link + 1 == open {
                border -= self.coupling(bodies, link, last, last);
            }
            let [before, beside, pivot] = match link.checked_sub(1) {
                Some(i) => [self.change[i], self.border[i], self.pivot(bodies, i, left)],
                None => [0.0, 0.0, 1.0],
            };
            left = soft + self.remains(bodies, link, left, pivot);
            let pivot = self.pivot(bodies, link, left);
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
            let first = -self.coupling(bodies, last, 0, 0);
            let lower = -self.coupling(bodies, last, last - 1, last);
            let diagonal = self.diagonal(bodies, last, soft);
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
    fn movement(&self, bodies: &Bodies<'_>, particle: usize) -> Option<(usize, Vec3)> {
        let row = self.rows[particle] as usize;
        let weight = *bodies.inverse_mass.get(row)?;
        let mut sum = Vec3::ZERO;
        if particle < self.count {
            sum += self.way[particle] * self.change[particle];
        }
        let before = if particle > 0 { particle - 1 } else { self.rows.len() - 1 };
        if before < self.count {
            sum -= self.way[before] * self.change[before];
        }
        let by = sum * weight;
        (weight > 0.0 && by.is_finite()).then_some((row, by))
    }

    /// Lets the changes of λ act.
    pub(super) fn act(&mut self, bodies: &mut Bodies<'_>, act: &mut dyn FnMut(&mut Bodies<'_>, usize, Vec3)) {
        let mut farthest = 0.0;
        for particle in 0..self.rows.len() {
            farthest = self.movement(bodies, particle).map_or(farthest, |(_, by)| max(farthest, length(by)));
        }
        let share = if farthest > 2.0 * self.reach { 2.0 * self.reach / farthest } else { 1.0 };
        for (pull, change) in self.pull.iter_mut().zip(self.change.iter_mut()) {
            *change *= share;
            *pull += *change;
        }
        for particle in 0..self.rows.len() {
            if let Some((row, by)) = self.movement(bodies, particle) {
                act(bodies, row, by);
            }
        }
    }

    /// Remembers where all are to go.
    pub(super) fn aim_at(&mut self, bodies: &Bodies<'_>) {
        for (aim, &row) in self.aim.iter_mut().zip(self.rows.iter()) {
            *aim = bodies.position.get(row as usize).copied().unwrap_or(Vec3::ZERO);
        }
    }

    /// Puts all back to where they were as the sub-step began.
    pub(super) fn start_over(&mut self, bodies: &mut Bodies<'_>) {
        for row in self.rows.iter().map(|&row| row as usize) {
            if row < bodies.len() {
                let to = bodies.before[0][row];
                put(bodies, row, to - bodies.position[row], to);
            }
        }
    }

    /// Moves all by a share of the way; whoever is fixed is to be so far on his.
    pub(super) fn pace(&mut self, bodies: &mut Bodies<'_>, far: f32, share: f32) {
        for (&aim, row) in self.aim.iter().zip(self.rows.iter().map(|&row| row as usize)) {
            if row < bodies.len() {
                let from = bodies.before[0][row];
                let to = if far < 1.0 { from + (aim - from) * far } else { aim };
                put(bodies, row, (aim - from) * share, to);
            }
        }
    }

    /// The velocity that all of it has: that of whoever is fixed, else the mean by mass \[m/s\].
    fn drift(&self, bodies: &Bodies<'_>) -> Vec3 {
        let (mut sum, mut mass) = (Vec3::ZERO, 0.0);
        for row in self.rows.iter().map(|&row| row as usize).filter(|&row| row < bodies.len()) {
            if !(bodies.inverse_mass[row] > 0.0) {
                return bodies.velocity[row];
            }
            sum += bodies.velocity[row] * bodies.mass[row];
            mass += bodies.mass[row];
        }
        if mass > 0.0 { sum / mass } else { Vec3::ZERO }
    }

    /// Twice the kinetic energy beside that \[J\].
    pub(super) fn vigour(&self, bodies: &Bodies<'_>) -> f32 {
        let drift = self.drift(bodies);
        let rows = self.rows.iter().map(|&row| row as usize).filter(|&row| row < bodies.len());
        let moving = rows.filter(|&row| bodies.inverse_mass[row] > 0.0);
        moving.map(|row| (bodies.velocity[row] - drift).length_squared() * bodies.mass[row]).sum()
    }

    /// Slows all down to the kinetic energy that they had before: links that have turned too far for the sub-step must not drive.
    pub(super) fn calm(&self, bodies: &mut Bodies<'_>, before: f32) {
        let (drift, now) = (self.drift(bodies), self.vigour(bodies));
        if !(now > before) {
            return;
        }
        let share = sqrt(before / now);
        for row in self.rows.iter().map(|&row| row as usize) {
            if row < bodies.len() && bodies.inverse_mass[row] > 0.0 {
                bodies.velocity[row] = drift + (bodies.velocity[row] - drift) * share;
            }
        }
    }

    /// Takes back what links push.
    pub(super) fn let_go(&mut self, bodies: &mut Bodies<'_>, act: &mut dyn FnMut(&mut Bodies<'_>, usize, Vec3)) {
        let mut pushes = false;
        for (change, &pull) in self.change.iter_mut().zip(self.pull.iter()) {
            *change = if pull > 0.0 { -pull } else { 0.0 };
            pushes |= pull > 0.0;
        }
        self.reach = f32::MAX;
        if pushes {
            self.act(bodies, act);
        }
    }
}
