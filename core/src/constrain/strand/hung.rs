//! The energy of strands that hang from what stands still.
//!
//! An implicit step leaves no more energy than it begins with, whatever forces have done before. One that is worked out in one or two steps of
//! Newton's method may, where a whip cracks or a wire between two hooks is plucked: that is taken out again.

use super::bounded::{Bounded, Course, frame};
use super::joint::{Begun, Joint};
use crate::constrain::Bodies;
use crate::constrain::bisect::bisect;
use crate::constrain::turn::Turn;
use crate::math::{clamp, max, min, sqrt};

/// The least share of the speeds that is left without that.
const LEAST: f32 = 0.5;
/// The share of the strain with which a sub-step begins that it may give beside: what is wound up begins to writhe with far less than two steps of Newton's
/// method leave undecided of that. Such shares of shares add up to a third of what there may be.
const UNDECIDED: f32 = 0.25;
/// The share of it that is taken for rounding in a sub-step, and stays.
const ROUNDING: f32 = 1e-5;

impl Bounded<'_> {
    /// The energy of all that moves \[J\].
    pub(super) fn moving(&self, bodies: &Bodies<'_>) -> f32 {
        let moving = self.rows.iter().map(|&row| row as usize).filter(|&row| bodies.inverse_mass[row] > 0.0);
        moving.map(|row| 0.5 * bodies.mass[row] * bodies.velocity[row].length_squared()).sum()
    }

    /// Takes out of a strand that hangs, and began with a strain, what it has more than `most` and a share of that \[J\]: out of its speeds; where that is
    /// most of them, it goes a part of its way only, to where its strain leaves something to move with. Tells what it has then, and may have from then on.
    pub(super) fn hang_within(&self, [kept, begun]: [f32; 2], bodies: &mut Bodies<'_>, course: Course<'_>) -> [f32; 2] {
        let now = self.hang_back(kept + UNDECIDED * begun, bodies, course);
        [now, max(kept, min(now, kept + ROUNDING * begun))]
    }

    fn hang_back(&self, most: f32, bodies: &mut Bodies<'_>, course: Course<'_>) -> f32 {
        let Course { joints, before, .. } = course;
        let (mut moving, mut strained) = (self.moving(bodies), self.stored(joints, None, bodies.position));
        if moving + strained <= most {
            return moving + strained;
        }
        if !(most - strained >= LEAST * LEAST * moving) {
            let begun = Some((Turn::NONE, before));
            self.halve(bodies, (joints, before), |bodies, joints| {
                self.moving(bodies) + self.stored(joints, begun, bodies.position) <= most
            });
            for number in 0..self.rows.len() - 1 {
                joints[number].turn = frame(joints, begun, number, self.way(number, joints, bodies.position)).0;
            }
            (moving, strained) = (self.moving(bodies), self.stored(joints, None, bodies.position));
        }
        let share = sqrt(clamp((most - strained) / moving, 0.0, 1.0));
        if share < 1.0 {
            self.rows.iter().for_each(|&row| bodies.velocity[row as usize] *= share);
            moving = self.moving(bodies);
        }
        moving + strained
    }

    /// Leaves as much of the ways from where all were as fits.
    fn halve(
        &self,
        bodies: &mut Bodies<'_>,
        (joints, before): (&mut [Joint], &[Begun]),
        fits: impl Fn(&Bodies<'_>, &[Joint]) -> bool,
    ) {
        let mut now = 1.0;
        bisect(|share| {
            self.go_back(bodies, joints, before, share / now);
            now = share;
            fits(bodies, joints)
        });
    }

    /// Leaves such a share of the ways from where all were.
    fn go_back(&self, bodies: &mut Bodies<'_>, joints: &mut [Joint], before: &[Begun], share: f32) {
        for ((&row, joint), begun) in self.rows.iter().zip(joints).zip(before) {
            let row = row as usize;
            let way = bodies.before[0][row] - bodies.position[row] + (begun.left - joint.left);
            let by = way * (1.0 - share);
            if bodies.inverse_mass[row] > 0.0 && by.is_finite() {
                bodies.shift_on(row, by, &mut joint.left);
            }
        }
    }
}
