//! Two particles at a distance from each other: rods, links of ropes and chains, tethers.

use super::{Bodies, Constraint, Share};
use crate::math::{length, max};
use glam::Vec3;

/// Keeps two particles at a distance: C = |x₁ − x₂| − length.
///
/// With a compliance α it stretches by α times the force through it, whatever the sub-steps: Δλ = −C / (w₁ + w₂ + α/h²)
/// (Macklin, Müller and Chentanez, "XPBD", MIG 2016, section 4). A damping β takes from the speed v at which it stretches what a
/// force β v does, by an implicit step at the sub-step's end, so that it never drives.
///
/// One iteration a sub-step: a chain of n links passes a pull on from link to link, and is as stiff as it says where the square
/// of the sub-step is a hundredth of α m or less; a rigid one sags. Linear momentum is kept to rounding.
///
/// Two that are in one place have no direction, and one that has lost an end does nothing. In a [periodic room](crate::index::Periodic) it acts
/// along the shortest way through the sides: `length` has to be less than half of each.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Distance {
    /// The particles, by their place in the scene's start.
    pub ends: [u32; 2],
    /// How far apart they are to be \[m\].
    pub length: f32,
    /// α: how far it gives way to a force \[m/N\]; zero is rigid.
    #[cfg_attr(feature = "serde", serde(default))]
    pub compliance: f32,
    /// β: the force against being stretched, for the speed of that \[N s/m\].
    #[cfg_attr(feature = "serde", serde(default))]
    pub damping: f32,
    /// True if it only pulls, as a string does.
    #[cfg_attr(feature = "serde", serde(default))]
    pub tether: bool,
}

impl Distance {
    /// A rigid rod.
    #[must_use]
    pub const fn rod(ends: [u32; 2], length: f32) -> Self {
        Self { ends, length, compliance: 0.0, damping: 0.0, tether: false }
    }

    /// A string that does not stretch.
    #[must_use]
    pub const fn string(ends: [u32; 2], length: f32) -> Self {
        Self { tether: true, ..Self::rod(ends, length) }
    }

    /// The first of its numbers that cannot be used, and what it has to be.
    #[must_use]
    pub fn fault(&self) -> Option<(&'static str, &'static str)> {
        let not_negative = |x: f32| (0.0..f32::INFINITY).contains(&x);
        [
            ("length", self.length, "must not be below zero, in m"),
            ("compliance", self.compliance, "must not be below zero, in m/N"),
            ("damping", self.damping, "must not be below zero, in N s/m"),
        ]
        .into_iter()
        .find(|&(_, value, _)| !not_negative(value))
        .map(|(name, _, message)| (name, message))
    }
}

impl Distance {
    /// The rows of its ends, the unit vector from the second to the first, and how far apart they are; none where it has no
    /// direction, or nothing to move.
    fn line(&self, bodies: &Bodies<'_>) -> Option<([usize; 2], Vec3, f32)> {
        let [a, b] = [bodies.row_of_start(self.ends[0])?, bodies.row_of_start(self.ends[1])?];
        let apart = bodies.between(b, a);
        let distance = length(apart);
        let moves = bodies.inverse_mass[a] + bodies.inverse_mass[b] > 0.0;
        (moves && distance > 0.0 && distance < f32::INFINITY).then(|| ([a, b], apart / distance, distance))
    }
}

impl Constraint for Distance {
    fn project(&self, bodies: &mut Bodies<'_>, _: &mut Share<'_>) {
        let h = bodies.substep.seconds();
        let Some(([a, b], normal, distance)) = self.line(bodies) else { return };
        let mut stretch = distance - self.length;
        if !(h > 0.0) || self.tether && stretch <= 0.0 {
            return;
        }
        let [wa, wb] = [a, b].map(|row| bodies.inverse_mass[row]);
        if self.compliance > 0.0 {
            // What hangs still would show speed where the method has not brought it to where its velocity leads.
            let lead = (bodies.lead(a, h) - bodies.lead(b, h)).dot(normal);
            let share = lead / (wa + wb);
            if share.is_finite() {
                bodies.position[a] -= normal * (share * wa);
                bodies.position[b] += normal * (share * wb);
                stretch -= lead;
                stretch = if self.tether { max(stretch, 0.0) } else { stretch };
            }
        }
        let pull = stretch / (wa + wb + self.compliance / (h * h));
        if pull.is_finite() {
            bodies.shift(a, normal * (-pull * wa));
            bodies.shift(b, normal * (pull * wb));
        }
    }

    fn settle(&self, bodies: &mut Bodies<'_>, _: &mut Share<'_>) {
        let brake = self.damping * bodies.substep.seconds();
        if !(brake > 0.0) {
            return;
        }
        let Some(([a, b], normal, distance)) = self.line(bodies) else { return };
        if self.tether && distance < self.length {
            return;
        }
        let [wa, wb] = [a, b].map(|row| bodies.inverse_mass[row]);
        let speed = (bodies.velocity[a] - bodies.velocity[b]).dot(normal);
        let taken = speed * (brake / (1.0 + brake * (wa + wb)));
        if taken.is_finite() {
            bodies.velocity[a] -= normal * (taken * wa);
            bodies.velocity[b] += normal * (taken * wb);
        }
    }
}
