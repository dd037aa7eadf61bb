//! The energy of what nothing holds: a sub-step in which it is solved gives it none.

use super::Bodies;
use super::bisect::bisect;
use super::turn::{Turn, keeping_by, nearest, outer, solve_thin};
use super::whole::{Group, Whole, turn_on};
use crate::index::between;
use crate::math::{dot, max, min};
use glam::{Mat3, Vec3};

/// The least share of what is no motion of a rigid body that is left without that.
const LEAST: f32 = 0.5;
/// The share of the energy of turning that may be rounding.
const EVEN: f32 = 1e-6;
/// How many times what there is a budget is at the most.
const SLACK: f32 = 2.0;

/// Words that a budget is kept in.
pub(super) const WORDS: usize = 2;

/// What there is to spend: the energy of motion, beside that of the middle, and of strain, at the end of the last sub-step, and the most that it may
/// have been \[J\]. Nothing is known of it where both are zero.
///
/// Forces, contacts and other constraints give and take between two solutions, and the budget goes with that; a solution neither adds to it nor takes
/// from it. So what a method takes in one sub-step it may give back in another, and never more; of what it has taken long ago, as from a load that
/// solutions bear, as much as there is now.
pub(super) struct Budget<'m>(pub(super) &'m mut [u32]);

impl Budget<'_> {
    /// The most that there may be at the sub-step's end, where there was so much before it was solved.
    pub(super) fn most(&self, begin: f32) -> f32 {
        self.most_of(begin, begin)
    }

    /// The same, where `all` is what there was, with what a solution may set free that is not counted otherwise.
    pub(super) fn most_of(&self, begin: f32, all: f32) -> f32 {
        let kept = match *self.0 {
            [last, most, ..] if last | most != 0 => f32::from_bits(most) + (begin - f32::from_bits(last)),
            _ => begin,
        };
        min(kept, SLACK * all)
    }

    /// Keeps what there is now, and may be.
    pub(super) fn keep(&mut self, now: f32, most: f32) {
        // Which bits a NaN has depends on the machine, and these words are in the hash.
        let sound = now.is_finite() && most.is_finite();
        let words = if sound { [now.to_bits(), most.to_bits()] } else { [0; WORDS] };
        self.0.iter_mut().zip(words).for_each(|(kept, word)| *kept = word);
    }

    /// Forgets it: something holds what it is of.
    pub(super) fn forget(&mut self) {
        self.0.fill(0);
    }
}

/// Particles that nothing holds, in these rows.
pub(super) struct Free<'f, 'b> {
    pub(super) bodies: &'f mut Bodies<'b>,
    pub(super) rows: &'f [u32],
    /// The momenta that they are to have, if these are not those that they have.
    pub(super) due: Option<Whole>,
    /// Where each would be as part of a rigid body, from where a whole is told from \[m\].
    pub(super) goal: &'f mut [Vec3],
}

impl Free<'_, '_> {
    fn group(&self) -> Group<'_> {
        Group::of(self.bodies, self.rows)
    }

    /// Where they would be if they went through a sub-step as a rigid body, from where they were: by the rotation that keeps their angular momentum, as
    /// with [`ShapeMatching`](super::ShapeMatching). Tells how they turn, and the energy of that \[J\].
    fn aim(&mut self, whole: &Whole) -> Option<(Turn, f32)> {
        let h = self.bodies.substep.seconds();
        let begun = Group::begun(self.bodies, self.rows);
        let (_, rest, origin) = begun.middle()?;
        let (mut from, mut to, mut torque) = (Mat3::ZERO, Mat3::ZERO, Vec3::ZERO);
        for (was, now) in begun.from(origin).zip(self.group().from(whole.origin)) {
            let (q, x) = ((was.way - rest) * now.mass, now.way - whole.middle);
            let y = x - (now.velocity - whole.drift) * h;
            from += outer(y, q);
            to += outer(x, q);
            torque += y.cross(x) * now.mass;
        }
        let turn =
            keeping_by(solve_thin, Turn::NONE, (from, torque), None).unwrap_or_else(|| nearest(Turn::NONE, to, None));
        let turning = whole.turning_as(&begun.whole()?.turned(turn));
        let rotation = turn.matrix();
        for was in begun.from(origin) {
            if let Some(goal) = self.goal.get_mut(was.number) {
                *goal = whole.middle + rotation * (was.way - rest);
            }
        }
        Some((turn, turning))
    }

    /// The energy that they have at their goals on the straight way to these \[J\].
    fn straight(&self, whole: &Whole) -> f32 {
        let (h, mut sum) = (self.bodies.substep.seconds(), 0.0);
        for now in self.group().from(whole.origin) {
            let Some(&goal) = self.goal.get(now.number) else { continue };
            let fast = now.velocity - whole.drift + (goal - now.way) / h;
            sum += 0.5 * now.mass * dot(fast, fast);
        }
        sum
    }

    /// Leaves such a share of their ways from where they would be as a rigid body.
    fn stiffen(&mut self, origin: Vec3, share: f32) {
        let room = self.bodies.near.room();
        for (&row, &goal) in self.rows.iter().zip(&*self.goal) {
            let Some(&place) = self.bodies.position.get(row as usize) else { continue };
            let by = (goal - between(room, origin, place)) * (1.0 - share);
            if by.is_finite() {
                self.bodies.shift(row as usize, by);
            }
        }
    }

    /// Gives them the momenta that a whole has, as far as turning by these takes no more than `most` \[J\], and leaves as much of what is no motion of a
    /// rigid body as there is energy for then.
    fn slow(&mut self, momenta: &Whole, most: f32) {
        let Some(whole) = self.group().whole() else { return };
        let (omega, kept) = (whole.omega(), whole.with_momenta_of(momenta));
        let (turning, energy) = kept.turning_within(most);
        let share = self.group().energy(&whole).share(max(most - energy, 0.0));
        let room = self.bodies.near.room();
        for row in self.rows.iter().map(|&row| row as usize) {
            let Some(&place) = self.bodies.position.get(row) else { continue };
            let arm = between(room, whole.origin, place) - whole.middle;
            let beside = self.bodies.velocity[row] - whole.drift - omega.cross(arm);
            let to = kept.drift + turning.cross(arm) + beside * share;
            if to.is_finite() {
                self.bodies.velocity[row] = to;
            }
        }
        if turning == kept.omega() {
            turn_on(self.bodies, self.rows, momenta);
        }
    }

    /// Takes out of their velocities what they have more than `most` \[J\] on account of them: as much as is too much of what is no motion of a rigid
    /// body, so that both momenta stay, and what is rigid of them.
    pub(super) fn slow_down(&mut self, most: f32) {
        if let Some(whole) = self.group().whole() {
            self.slow(&self.due(whole), most);
        }
    }

    /// The momenta that those who move so are to have.
    fn due(&self, whole: Whole) -> Whole {
        self.due.map_or(whole, |due| whole.with_momenta_of(&due))
    }

    /// Takes through the sub-step as a rigid body who would have more than `most` \[J\] as one where they are: what comes nearer to its middle turns
    /// faster, and their angular momentum is to stay.
    pub(super) fn hold_form(&mut self, most: f32) {
        let Some(before) = self.group().whole().map(|whole| self.due(whole)) else { return };
        if before.turning_as(&before) <= most * (1.0 + EVEN) {
            return;
        }
        if self.aim(&before).is_some() {
            self.stiffen(before.origin, 0.0);
        }
        self.slow(&before, most);
    }

    /// Takes out of how they deform what they have more than `most` \[J\] on that account: as much as is too much of what is no motion of a rigid body;
    /// where that would be most of it, of the ways as well on which they deform in the sub-step. Both momenta stay, and as rigid bodies they
    /// have no more than they began with. `stored` tells the energy of strain where they are, and where they have been brought nearer to where a rigid
    /// body would be, how that has turned. That is told at the end as well.
    pub(super) fn hold_back(
        &mut self,
        most: f32,
        mut stored: impl FnMut(&[Vec3], Option<Turn>) -> f32,
    ) -> Option<Turn> {
        let whole = self.group().whole()?;
        let (before, energy) = (self.due(whole), self.group().energy(&whole));
        let left = most - stored(self.bodies.position, None) - before.turning_as(&whole);
        let mut turned = None;
        if !(left >= 0.0 && energy.share(left) >= LEAST) {
            // As a rigid body it has what it began with, but for rounding; what the straight way shows beyond turning, velocities alone can give back.
            let strained = stored(self.bodies.before[0], Some(Turn::NONE));
            let (aim, turning) = self.aim(&before)?;
            let most_still = max(most, strained + turning);
            let shown = most_still + max(self.straight(&before) - turning, 0.0);
            let mut fits = |free: &Self, aim: Option<Turn>| {
                let Some(whole) = free.group().whole() else { return true };
                let strained = stored(free.bodies.position, aim);
                let moving = free.group().energy(&whole).with(1.0);
                moving + strained <= shown && before.turning_as(&whole) + strained <= most_still
            };
            if !fits(self, None) {
                turned = Some(aim);
                self.halve(before.origin, |free| fits(free, turned));
            }
        }
        self.slow(&before, max(most - stored(self.bodies.position, turned), 0.0));
        turned
    }

    /// Leaves as much of their ways from their goals as fits, to a share of all of them.
    fn halve(&mut self, origin: Vec3, mut fits: impl FnMut(&Self) -> bool) {
        let mut now = 1.0;
        bisect(|share| {
            self.stiffen(origin, share / now);
            now = share;
            fits(self)
        });
    }
}
