//! Goals: particles led to places of a surface by a given time, held there, and let go.

use super::{Force, Perturbation, State};
use crate::math::max;
use crate::shape::{Shape, Surface};
use crate::time::Time;
use core::ops::Range;
use glam::Vec3;

/// Leads particles to places spread evenly over a surface, where they arrive softly, holds them there, and lets them go. Each has
/// one place, which its own random words choose, as long as it lives.
///
/// Until they are nearly there they are accelerated by 6 d⃗/T² − 4 v⃗/T, d⃗ being the way that is left and T the time: the way to be
/// there at rest with the least square of acceleration over time (Bryson and Ho, "Applied Optimal Control", 1975, section 5.3). The
/// last four times [`settle`](Goal::settle), and while they are held, T stays at that: a spring, nearly critically damped. What else acts
/// on them disturbs that less the shorter T is; a uniform gravity is made up for altogether by [`against`](Goal::against).
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Goal<M> {
    /// The surface.
    pub shape: Shape<M>,
    /// The group of a scene file whose transform applies to the surface; a `Model` has applied it.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Option::is_none"))]
    pub group: Option<u32>,
    /// When it begins to lead \[s\].
    #[cfg_attr(feature = "serde", serde(default))]
    pub start: f32,
    /// When they are there \[s\].
    pub arrive: f32,
    /// When it lets them go \[s\]; without it, never.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Option::is_none"))]
    pub release: Option<f32>,
    /// The time that is left at the least \[s\], for which a spring takes over; a step should be no longer than a third of it.
    #[cfg_attr(feature = "serde", serde(default = "settle"))]
    pub settle: f32,
    /// The acceleration that it makes up for, as that of gravity \[m/s²\]; without it, a scene file's own gravity.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Option::is_none"))]
    #[cfg_attr(feature = "schema", schemars(with = "Option<[f32; 3]>"))]
    pub against: Option<Vec3>,
    /// The material whose particles it leads; without it, all.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Option::is_none"))]
    pub material: Option<u16>,
}

/// The place of the random words by which particles choose theirs, beyond all that reapers claim and materials use.
const CHOICE: u32 = 0xc000_0000;

#[cfg(feature = "serde")]
fn settle() -> f32 {
    0.1
}

/// How particles are led at an instant.
struct Lead {
    /// For each metre that is left \[1/s²\], and each metre a second that they have \[1/s\].
    stiffness: f32,
    damping: f32,
}

impl<M> Goal<M> {
    /// One that leads all particles from the beginning, and never lets them go.
    pub const fn new(shape: Shape<M>, arrive: f32) -> Self {
        Self { shape, group: None, start: 0.0, arrive, release: None, settle: 0.1, against: None, material: None }
    }

    /// How it leads, if it does.
    fn lead(&self, State { time: now, since, .. }: &State<'_>) -> Option<Lead> {
        let (now, since) = (*now, *since);
        // At the instant itself those methods ask as well for whom a step ends there.
        let has_come = |seconds: f32| {
            let instant = Time::from_seconds(seconds);
            since >= instant || now > instant
        };
        if !has_come(self.start) || self.release.is_some_and(has_come) || !(self.settle > 0.0) {
            return None;
        }
        let left = (Time::from_seconds(self.arrive) - now).seconds() - 4.0 * self.settle;
        let left = max(left, self.settle);
        Some(Lead { stiffness: 6.0 / (left * left), damping: 4.0 / left })
    }

    /// Tells whether it leads the particle in a row.
    fn leads(&self, state: &State<'_>, row: usize) -> bool {
        self.material.is_none_or(|number| state.material.get(row) == Some(&number.saturating_add(1)))
    }
}

impl<M: Surface> Goal<M> {
    /// The place of the particle in a row.
    #[must_use]
    pub fn place(&self, state: &State<'_>, row: usize) -> Option<Vec3> {
        let unit = |place: u32| Some((state.word(row, CHOICE + place)? >> 8) as f32 * (1.0 / 16_777_216.0));
        Some(self.shape.sample([unit(0)?, unit(1)?, unit(2)?]).point)
    }

    /// The force on the particle in a row.
    fn pull(&self, state: &State<'_>, row: usize, lead: &Lead) -> Option<Vec3> {
        let place = self.place(state, row).filter(|_| self.leads(state, row))?;
        let acceleration = (place - state.position[row]) * lead.stiffness - state.velocity[row] * lead.damping;
        Some((acceleration - self.against.unwrap_or(Vec3::ZERO)) * state.mass[row])
    }
}

impl<M: Surface + Sync> Force for Goal<M> {
    fn is_local(&self) -> bool {
        true
    }

    fn add_to(&self, state: &State<'_>, rows: Range<usize>, total: &mut [Vec3]) {
        let Some(lead) = self.lead(state) else { return };
        for (total, row) in total.iter_mut().zip(rows) {
            *total += self.pull(state, row, &lead).unwrap_or(Vec3::ZERO);
        }
    }

    fn add_jacobian(&self, state: &State<'_>, change: &Perturbation<'_>, total: &mut [Vec3]) {
        let Some(Lead { stiffness, damping }) = self.lead(state) else { return };
        let factor = change.position * stiffness + change.velocity * damping;
        for (row, (total, &along)) in total.iter_mut().zip(change.along).enumerate() {
            if self.leads(state, row) {
                *total -= along * (factor * state.mass[row]);
            }
        }
    }

    fn add_stiffness(&self, state: &State<'_>, weights: [f32; 2], total: &mut [Vec3]) {
        let Some(Lead { stiffness, damping }) = self.lead(state) else { return };
        let factor = weights[0] * stiffness + weights[1] * damping;
        for (row, total) in total.iter_mut().enumerate() {
            if self.leads(state, row) {
                *total += Vec3::splat(factor * state.mass[row]);
            }
        }
    }

    /// All of its work: it has no potential.
    #[cfg(feature = "std")]
    fn power(&self, state: &State<'_>) -> f64 {
        let Some(lead) = self.lead(state) else { return 0.0 };
        let work = |row: usize| {
            let (pull, v) = (self.pull(state, row, &lead)?, state.velocity[row]);
            Some((0..3).map(|axis| f64::from(pull[axis]) * f64::from(v[axis])).sum::<f64>())
        };
        (0..state.position.len()).filter_map(work).sum()
    }

    #[cfg(feature = "std")]
    fn name(&self) -> &'static str {
        "goals"
    }
}
