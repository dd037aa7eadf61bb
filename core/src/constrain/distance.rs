//! Two particles at a distance from each other: rods, links of ropes and chains, tethers.

use super::{Bodies, Constraint, Demand, Share, Words};
use crate::math::{length, max, min};
use glam::Vec3;

/// Keeps two particles at a distance: C = |x₁ − x₂| − length.
///
/// With a compliance α it stretches by α times the force through it, whatever the sub-steps: Δλ = −C / (w₁ + w₂ + α/h²)
/// (Macklin, Müller and Chentanez, "XPBD", MIG 2016, section 4). A damping β takes from the speed v at which it stretches what a
/// force β v does, by an implicit step at the sub-step's end, so that it never drives.
///
/// One iteration a sub-step: a chain of n links passes a pull on from link to link, and is as stiff as it says where the square
/// of the sub-step is a hundredth of α m or less; a rigid one sags. Linear momentum is kept to rounding. What hangs still shows no speed, whatever
/// the method: each keeps the force through it for that, three words.
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

    /// Lets its ends go by so much of the pull that it is about to answer with (× h²) \[kg m\] as what hangs still would else show as speed.
    fn let_go(bodies: &mut Bodies<'_>, pull: f32, ([a, b], normal): ([usize; 2], Vec3)) {
        if pull.is_finite() {
            bodies.position[a] += normal * (pull * bodies.inverse_mass[a]);
            bodies.position[b] -= normal * (pull * bodies.inverse_mass[b]);
        }
    }

    /// Moves its ends to where they belong, and tells the force that it takes \[N\].
    fn pull(&self, bodies: &mut Bodies<'_>) -> Option<f32> {
        let (h, ([a, b], normal, distance)) = (bodies.substep.seconds(), self.line(bodies)?);
        let mut stretch = distance - self.length;
        if !(h > 0.0) || self.tether && stretch <= 0.0 {
            return None;
        }
        let [wa, wb] = [a, b].map(|row| bodies.inverse_mass[row]);
        if bodies.lag == 0.0 {
            // The way by which the method has not brought them to where velocities lead.
            let lead = (bodies.lead(a, h) - bodies.lead(b, h)).dot(normal);
            Self::let_go(bodies, -lead / (wa + wb), ([a, b], normal));
            stretch -= if lead.is_finite() { lead } else { 0.0 };
            stretch = if self.tether { max(stretch, 0.0) } else { stretch };
        }
        let pull = stretch / (wa + wb + self.compliance / (h * h));
        if !pull.is_finite() {
            return None;
        }
        bodies.shift(a, normal * (-pull * wa));
        bodies.shift(b, normal * (pull * wb));
        Some(pull / (h * h))
    }
}

/// The words that it keeps: whose they are, and the force through it in the last two sub-steps.
const KEPT: usize = 3;

impl Constraint for Distance {
    fn demand(&self) -> Demand {
        Demand { kept: Words { per_row: 0, fixed: KEPT }, ..Demand::NONE }
    }

    /// A steady force goes into places as late as all forces do by the method: so does the force of before, which alone tells what the links of a
    /// chain bear together. A jolt is no steady force: of the last two the lesser counts.
    fn begin(&self, bodies: &mut Bodies<'_>, share: &mut Share<'_>) {
        share.claim(*b"dist", &[]);
        let ([_, last, before], true) = (&*share.kept.fixed, bodies.lag > 0.0) else { return };
        let [last, before] = [last, before].map(|word| f32::from_bits(*word));
        let steady = max(min(last, before), 0.0) + min(max(last, before), 0.0);
        if steady == 0.0 {
            return;
        }
        if let Some((rows, normal, _)) = self.line(bodies) {
            let h = bodies.substep.seconds();
            Self::let_go(bodies, steady * (bodies.lag * h * h), (rows, normal));
        }
    }

    fn project(&self, bodies: &mut Bodies<'_>, share: &mut Share<'_>) {
        let pull = self.pull(bodies).filter(|pull| pull.is_finite()).unwrap_or(0.0);
        if let [_, last, before] = share.kept.fixed {
            (*before, *last) = (*last, pull.to_bits());
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
