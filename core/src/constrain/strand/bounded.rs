//! The energy of strands that nothing holds, or that hang from what stands still.

use super::frame::{bring, strain};
use super::joint::{Begun, Joint};
use super::params::StrandParams;
use crate::constrain::Bodies;
use crate::constrain::budget::{self, Budget, Free};
use crate::constrain::turn::Turn;
use crate::constrain::whole::{self, Group, Owed, Whole};
use crate::math::{dot, length, min};
use glam::Vec3;

/// Words to work with, for each point.
pub(super) const WORDS: usize = 3;
/// Words for what its joints were, for each point.
pub(super) const BEGUN: usize = size_of::<Begun>() / 4;

/// Words kept for each strand.
pub(super) const PURSE: usize = budget::WORDS + whole::WORDS;

/// What is kept of a strand: the energy that it may have and, if nothing holds it, what rounding owes it.
pub(super) struct Purse<'m> {
    budget: Budget<'m>,
    owed: Owed<'m>,
}

impl<'m> Purse<'m> {
    /// That of a strand by its number.
    pub(super) fn of(all: &'m mut [u32], number: usize) -> Option<Self> {
        let own = all.get_mut(number.checked_mul(PURSE)?..)?.get_mut(..PURSE)?;
        let (budget, owed) = own.split_at_mut_checked(budget::WORDS)?;
        Some(Self { budget: Budget(budget), owed: Owed(owed) })
    }

    /// Forgets it: something holds the strand, or it is in parts.
    pub(super) fn forget(&mut self) {
        self.budget.forget();
        self.owed.forget();
    }
}

/// The most energy that a strand may have at the sub-step's end, that of the strain with which it begins \[J\], and how it moves as a whole before it is
/// solved.
#[derive(Clone, Copy)]
pub(super) struct Limits {
    most: f32,
    strained: f32,
    whole: Option<Whole>,
}

/// A strand in a sub-step: its points are in these rows.
pub(super) struct Bounded<'a> {
    pub(super) params: &'a StrandParams,
    pub(super) rows: &'a [u32],
    pub(super) inverse_mass: &'a [f32],
    /// How long the sub-step is \[s\], and the mean mass of its points \[kg\].
    pub(super) h: f32,
    pub(super) mass: f32,
    /// True if nothing holds it, else it hangs from what stands still.
    pub(super) is_free: bool,
}

/// What it does and works with in a sub-step.
pub(super) struct Course<'m> {
    pub(super) joints: &'m mut [Joint],
    /// The joints as the sub-step began.
    pub(super) before: &'m [Begun],
    pub(super) work: &'m mut [u32],
}

impl Bounded<'_> {
    /// What solving it must not change.
    pub(super) fn limits(&self, bodies: &Bodies<'_>, joints: &[Joint], purse: &Purse<'_>) -> Limits {
        let strained = self.stored(joints, None, bodies.before[0]);
        if !self.is_free {
            let (moving, all) = (self.moving(bodies), self.strained(joints, None, bodies.before[0], f32::INFINITY));
            let most = purse.budget.most_of(moving + strained, moving + all);
            return Limits { most, strained, whole: None };
        }
        let begun = Group::begun(bodies, self.rows).moving() + strained;
        Limits { most: purse.budget.most(begun), strained, whole: Group::of(bodies, self.rows).whole() }
    }

    /// Gives it back what rounding has taken, takes out of it what is too much, and keeps what there is.
    pub(super) fn keep_within(
        &self,
        limits: Limits,
        bodies: &mut Bodies<'_>,
        course: Course<'_>,
        purse: &mut Purse<'_>,
    ) {
        if !self.is_free {
            let [now, most] = self.hang_within([limits.most, limits.strained], bodies, course);
            return purse.budget.keep(now, most);
        }
        let due = purse.owed.give_back(bodies, self.rows, limits.whole);
        let (most, Course { joints, before, work }) = (limits.most, course);
        let energy = |bodies: &Bodies<'_>, joints: &[Joint]| {
            Group::of(bodies, self.rows).moving() + self.stored(joints, None, bodies.position)
        };
        let mut now = energy(bodies, joints);
        if now > most {
            let frames = |turned: Option<Turn>| turned.map(|turned| (turned, before));
            let goal: &mut [Vec3] = bytemuck::cast_slice_mut(&mut work[..WORDS * self.rows.len()]);
            let mut free = Free { bodies, rows: self.rows, due, goal };
            let turned = free.hold_back(most, |places, turned| self.stored(joints, frames(turned), places));
            for number in 0..self.rows.len() - 1 {
                let way = self.way(number, joints, bodies.position);
                joints[number].turn = frame(joints, frames(turned), number, way).0;
            }
            now = energy(bodies, joints);
        }
        purse.owed.note(bodies, self.rows, due);
        purse.budget.keep(now, most);
    }

    /// The way from a point to the next, with what rounding has left of where they are.
    pub(super) fn way(&self, number: usize, joints: &[Joint], places: &[Vec3]) -> Vec3 {
        let [from, to] = [number, number + 1].map(|point| places[self.rows[point] as usize]);
        to - from + (joints[number + 1].left - joints[number].left)
    }

    /// The energy of strain where its points are in these places \[J\]. What is stiffer than it takes to be brought to its shape in a
    /// sub-step is taken for so stiff: of the rest of its strain no motion comes. Where something holds it, that is so of how it stretches; all of it
    /// bends as one.
    pub(super) fn stored(&self, joints: &[Joint], turned: Option<(Turn, &[Begun])>, places: &[Vec3]) -> f32 {
        self.strained(joints, turned, places, 0.5 * self.mass / (self.h * self.h))
    }

    /// The same, where edges are no stiffer than is shown \[N/m\].
    fn strained(&self, joints: &[Joint], turned: Option<(Turn, &[Begun])>, places: &[Vec3], shown: f32) -> f32 {
        let StrandParams { stretch, bending: [first, second], twisting, .. } = *self.params;
        let (mut sum, mut last) = (0.0, None);
        for (number, joint) in joints.iter().enumerate().take(self.rows.len() - 1) {
            let way = self.way(number, joints, places);
            let stiff = stretch.map_or(f32::INFINITY, |stretch| stretch / joint.length);
            let stiff = min(stiff, shown);
            let long = length(way) - joint.length;
            let pulled = 0.5 * stiff * (long * long);
            sum += if pulled.is_finite() { pulled } else { 0.0 };
            // Of what is embedded nothing bends.
            let is_embedded =
                [number, number + 1].into_iter().all(|end| !(self.inverse_mass[self.rows[end] as usize] > 0.0));
            let own = (frame(joints, turned, number, way), if is_embedded { 0.0 } else { joint.length });
            if let Some((turn, before)) = last.replace(own) {
                let bent = strain(turn, own.0) - joint.rest;
                let stiff = |stiffness: f32| {
                    let whole = stiffness / (before + own.1);
                    if self.is_free { min(whole, 0.5 * shown * (before * own.1)) } else { whole }
                };
                let moment = bent * Vec3::new(stiff(first), stiff(second), stiff(twisting));
                let bent = dot(bent, moment);
                sum += if bent.is_finite() { bent } else { 0.0 };
            }
        }
        sum
    }
}

/// The frame of an edge that has got into this direction: from where it is, or from where it was, turned as a rigid body.
pub(super) fn frame(joints: &[Joint], turned: Option<(Turn, &[Begun])>, number: usize, way: Vec3) -> Turn {
    let from = match turned {
        Some((turn, before)) => turn.after(Turn(before[number].turn)),
        None => Turn(joints[number].turn),
    };
    let direction = way / length(way);
    if direction.is_finite() { bring(from, direction) } else { from }
}
