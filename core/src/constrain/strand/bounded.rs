//! The energy of strands that nothing holds.

use super::frame::{bring, strain};
use super::joint::Joint;
use super::params::StrandParams;
use crate::constrain::Bodies;
use crate::constrain::budget::{Budget, Free};
use crate::constrain::turn::Turn;
use crate::math::{dot, length};
use crate::memory::take;
use glam::Vec3;

/// Words to work with, for each point.
pub(super) const WORDS: usize = 10;

/// A strand that nothing holds in a sub-step: its points are in these rows.
pub(super) struct Bounded<'a> {
    pub(super) params: &'a StrandParams,
    pub(super) rows: &'a [u32],
    /// How long the sub-step is \[s\], and the mean mass of its points \[kg\].
    pub(super) h: f32,
    pub(super) mass: f32,
}

impl Bounded<'_> {
    /// The most energy that it may have at the sub-step's end.
    pub(super) fn most(&self, bodies: &Bodies<'_>, joints: &[Joint], budget: &Budget<'_>, work: &mut [u32]) -> f32 {
        let free = self.free([bodies.before[0], bodies.velocity], bodies, work);
        budget.most(free.moving() + self.stored(joints, free.place))
    }

    /// Takes out of it what is more than that, and keeps what there is.
    pub(super) fn keep_within(
        &self,
        most: f32,
        bodies: &mut Bodies<'_>,
        joints: &mut [Joint],
        budget: &mut Budget<'_>,
        work: &mut [u32],
    ) {
        let mut free = self.free([bodies.position, bodies.velocity], bodies, work);
        let mut now = free.moving() + self.stored(joints, free.place);
        if now > most {
            let (rows, before) = (self.rows, bodies.before[0]);
            free.hold_back(
                self.h,
                most,
                |number| before[rows[number] as usize],
                |places| self.stored(joints, places),
            );
            for ((&row, &x), &v) in self.rows.iter().zip(&*free.place).zip(&*free.velocity) {
                if x.is_finite() && v.is_finite() {
                    let row = row as usize;
                    bodies.shift(row, x - bodies.position[row]);
                    (bodies.position[row], bodies.velocity[row]) = (x, v);
                }
            }
            for (ends, joint) in free.place.windows(2).zip(&mut *joints) {
                joint.turn = turned(joint, ends[1] - ends[0]).0;
            }
            now = free.moving() + self.stored(joints, free.place);
        }
        budget.keep(now, most);
    }

    fn free<'w>(&self, columns: [&[Vec3]; 2], bodies: &Bodies<'_>, work: &'w mut [u32]) -> Free<'w> {
        let (mut rest, count) = (work, self.rows.len());
        let weight: &mut [f32] = bytemuck::cast_slice_mut(take(&mut rest, count));
        let [place, velocity, goal] = [(); 3].map(|()| bytemuck::cast_slice_mut(take(&mut rest, 3 * count)));
        for (number, &row) in self.rows.iter().enumerate() {
            let row = row as usize;
            weight[number] = bodies.inverse_mass[row];
            (place[number], velocity[number]) = (columns[0][row], columns[1][row]);
        }
        Free { weight, place, velocity, goal }
    }

    /// The energy of strain where its points are in these places \[J\]. What does not stretch is taken for as stiff as it takes to be brought to its
    /// length in a sub-step.
    fn stored(&self, joints: &[Joint], places: &[Vec3]) -> f32 {
        let StrandParams { stretch, bending: [first, second], twisting, .. } = *self.params;
        let (mut sum, mut last) = (0.0, None);
        for (ends, joint) in places.windows(2).zip(joints) {
            let way = ends[1] - ends[0];
            let stiff = stretch.map_or(0.5 * self.mass / (self.h * self.h), |stretch| stretch / joint.length);
            let long = length(way) - joint.length;
            let pulled = 0.5 * stiff * (long * long);
            sum += if pulled.is_finite() { pulled } else { 0.0 };
            let own = (turned(joint, way), joint.length);
            if let Some((turn, before)) = last.replace(own) {
                let bent = strain(turn, own.0) - joint.rest;
                let moment = bent * Vec3::new(first, second, twisting);
                let bent = dot(bent, moment) / (before + own.1);
                sum += if bent.is_finite() { bent } else { 0.0 };
            }
        }
        sum
    }
}

/// The frame of an edge that has got into this direction.
fn turned(joint: &Joint, way: Vec3) -> Turn {
    let direction = way / length(way);
    if direction.is_finite() { bring(Turn(joint.turn), direction) } else { Turn(joint.turn) }
}
