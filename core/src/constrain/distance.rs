//! Two particles at a distance from each other: rods, links of ropes and chains, tethers.

#[cfg(feature = "alloc")]
use super::declared::{Declared, inverse_mass};
use super::{Bodies, Constraint, Demand, SHIFTED, Share, Words};
use crate::index::between;
use crate::math::{dot, largest, length, max, min, sqrt};
#[cfg(feature = "alloc")]
use crate::particles::Particle;
#[cfg(feature = "alloc")]
use alloc::boxed::Box;
use glam::Vec3;

/// Keeps two particles at a distance: C = |x₁ − x₂| − length.
///
/// With a compliance α it stretches by α times the force through it, whatever the sub-steps: C = α Δλ / h² at the end of each (Macklin, Müller
/// and Chentanez, "XPBD", MIG 2016, section 4). A damping β takes from the speed v at which it stretches what a
/// force β v does, by an implicit step at the sub-step's end, so that it never drives.
///
/// It acts along the direction that it had when the sub-step began (SHAKE), and at the sub-step's end the velocities of its ends become
/// those at which it stretches, which is not at all for a rigid one (RATTLE; Andersen, J. Comput. Phys. 52, 1983). So linear and angular
/// momentum are kept to rounding. Rigid chains that fly freely gain no energy, nets of rods some 1e-4 of it at the most; a single rod keeps all of it.
/// Soft ones gain none where the square of the sub-step is a twentieth of α m or less. Where it turns by more than 60° in a
/// sub-step it acts along the direction that it has then, which takes from energy and angular momentum.
///
/// One iteration a sub-step: a chain of n links passes a pull on from link to link, and is as stiff as it says where the square
/// of the sub-step is a hundredth of α m or less; a rigid one sags, and takes energy out of the motion until it does not. What hangs still shows
/// no speed, whatever the method: each keeps the force that this takes, and what rounding has left of its ends' ways, five words, and four more through
/// a step.
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

/// A distance in a sub-step.
struct Line {
    rows: [usize; 2],
    /// The inverse masses of its ends \[1/kg\], the second one's below zero as all that acts on it is turned round.
    weights: [f32; 2],
    /// The way from the second end to the first, how long that is \[m\], and its direction.
    apart: Vec3,
    distance: f32,
    normal: Vec3,
    /// The direction and the length \[m\] when the sub-step began.
    first: Vec3,
    before: f32,
}

impl Line {
    /// The inverse mass of its ends against each other \[1/kg\].
    fn weight(&self) -> f32 {
        self.weights[0] - self.weights[1]
    }

    /// Moves its ends apart by so much \[kg m\] along a direction, and by what rounding has left of that before; their velocities stay.
    fn part(&self, bodies: &mut Bodies<'_>, by: f32, along: Vec3, left: &mut [u32]) {
        for ((row, weight), left) in self.rows.into_iter().zip(self.weights).zip(left) {
            if weight != 0.0 {
                let (from, by) = (bodies.position[row], along * (by * weight + f32::from_bits(*left)));
                let to = from + by;
                let lost = dot(by - (to - from), along);
                *left = if lost.is_finite() { lost.to_bits() } else { 0 };
                bodies.position[row] = to;
                bodies.marks[row] |= SHIFTED;
            }
        }
    }

    /// Drives its ends apart by an impulse \[kg m/s\].
    fn drive(&self, bodies: &mut Bodies<'_>, impulse: Vec3) {
        for (row, weight) in self.rows.into_iter().zip(self.weights) {
            bodies.velocity[row] += impulse * weight;
        }
    }

    /// The rounding of how much longer it gets in a sub-step \[m\].
    fn rounding(&self, bodies: &Bodies<'_>) -> f32 {
        let [x, y] = self.rows.map(|row| largest(bodies.position[row]));
        2.0 * f32::EPSILON * (max(x, y) + self.distance + self.before)
    }
}

/// The cosine of how far a link may turn in a sub-step to act along its first direction: by 60°.
const COSINE: f32 = 0.5;
/// How far the length of a direction may be off one for it to be told from rounding.
const ASKEW: f32 = 0.01;
/// The share of a speed within rounding that is believed.
const CAUTION: f32 = 0.125;

/// What a sub-step remembers of it: by how much it has let its ends go \[kg m\], and along which direction it took their speed.
#[derive(Clone, Copy)]
struct Gone {
    by: f32,
    along: Vec3,
}

impl Gone {
    /// That of a string that is slack.
    const SLACK: Self = Self { by: f32::INFINITY, along: Vec3::ZERO };
    /// The words that it takes.
    const WORDS: usize = 4;

    fn read(words: &[u32]) -> Self {
        let [by, x, y, z] = [0, 1, 2, 3].map(|word| words.get(word).copied().map_or(0.0, f32::from_bits));
        Self { by, along: Vec3::new(x, y, z) }
    }

    fn write(self, words: &mut [u32]) {
        let Vec3 { x, y, z } = self.along;
        for (word, value) in words.iter_mut().zip([self.by, x, y, z]) {
            *word = value.to_bits();
        }
    }
}

impl Distance {
    /// It as it lies; none where it has no direction, or nothing to move.
    fn line(&self, bodies: &Bodies<'_>) -> Option<Line> {
        let rows = [bodies.row_of_start(self.ends[0])?, bodies.row_of_start(self.ends[1])?];
        let [a, b] = rows;
        let weights = [bodies.inverse_mass[a], -bodies.inverse_mass[b]];
        let apart = bodies.between(b, a);
        let distance = length(apart);
        if !(weights[0] - weights[1] > 0.0 && distance > 0.0 && distance < f32::INFINITY) {
            return None;
        }
        let normal = apart / distance;
        let begun = between(bodies.near.room(), bodies.before[0][b], bodies.before[0][a]);
        let before = length(begun);
        let first = if before > 0.0 && before < f32::INFINITY { begun / before } else { normal };
        Some(Line { rows, weights, apart, distance, normal, first, before })
    }

    /// What it gives way to an impulse within a sub-step of `h`, in units of what its ends do.
    fn softness(&self, line: &Line, h: f32) -> f32 {
        self.compliance / (h * h * line.weight())
    }

    /// How far its ends have to come nearer along a direction \[m\], |apart − way along| = length + soft way; none if that does not help.
    fn way(&self, line: &Line, along: Vec3, soft: f32) -> Option<f32> {
        let lean = dot(line.apart, along);
        let nearer = lean + soft * self.length;
        let open = (line.distance - self.length) * (line.distance + self.length);
        let root = nearer * nearer - (1.0 - soft) * (1.0 + soft) * open;
        let way = open / (nearer + sqrt(root));
        (lean >= COSINE * line.distance && way.is_finite()).then_some(way)
    }

    /// Moves its ends to where they belong, having let them go by so much \[kg m\].
    fn pull(&self, bodies: &mut Bodies<'_>, gone: f32, left: &mut [u32]) -> Option<Gone> {
        let (h, line) = (bodies.substep.seconds(), self.line(bodies)?);
        let soft = self.softness(&line, h);
        let way = self.way(&line, line.first, soft).filter(|_| h > 0.0);
        if let Some(way) = way.filter(|&way| !self.tether || way > 0.0) {
            let pull = way / line.weight();
            line.part(bodies, -pull, line.first, left);
            // Velocities follow the way that it has made in all; what takes their speed at the end acts along the direction that it has then.
            let last = (line.apart - line.first * way) / (self.length + soft * way);
            // That of what is much shorter than rounding of where its ends are tells nothing.
            let along = if (length(last) - 1.0).abs() < ASKEW { last } else { line.normal };
            line.drive(bodies, line.first * ((gone - pull) / h) - along * (gone / h));
            return Some(Gone { by: gone, along });
        }
        line.part(bodies, -gone, line.first, left);
        if way.is_some() || !(h > 0.0) {
            return None;
        }
        let line = self.line(bodies)?;
        let way = (line.distance - self.length) / (1.0 + soft);
        if !way.is_finite() || self.tether && way <= 0.0 {
            return None;
        }
        let pull = way / line.weight();
        line.part(bodies, -pull, line.normal, left);
        line.drive(bodies, line.normal * (-pull / h));
        Some(Gone { by: 0.0, along: line.normal })
    }

    /// Makes the velocities of its ends those at which it stretches, and brakes that. Tells what steady force that takes \[N\].
    fn calm(&self, bodies: &mut Bodies<'_>, gone: Gone) -> Option<f32> {
        let (h, line) = (bodies.substep.seconds(), self.line(bodies)?);
        let (weight, [a, b]) = (line.weight(), line.rows);
        let steady = gone.by / h;
        let turned = (gone.along - line.normal) * steady;
        let speed = dot(bodies.velocity[a] - bodies.velocity[b] + turned * weight, line.normal);
        // The less it shows of its oscillation in a sub-step, the less it keeps of that.
        let shown = self.softness(&line, h);
        let rate = (line.distance - line.before) / h / (1.0 + 1.0 / (shown * shown));
        let lack = speed - rate;
        // Differences of places would heat what hangs still by their rounding.
        let is_rounding = rate != 0.0 && lack.abs() * h <= line.rounding(bodies);
        let taken = lack * (if is_rounding { CAUTION } else { 1.0 }) / weight;
        let taken = if self.tether { max(taken, -steady) } else { taken };
        let brake = self.damping * h;
        let impulse = turned - line.normal * (taken + rate * (brake / (1.0 + brake * weight)));
        if !(impulse.is_finite() && taken.is_finite()) {
            return None;
        }
        line.drive(bodies, impulse);
        Some((steady + taken) / h)
    }
}

/// The words that it keeps: whose they are, the force that settling took in the last two sub-steps, and what rounding has left of its ends' ways.
const KEPT: usize = 5;

impl Constraint for Distance {
    fn demand(&self) -> Demand {
        let fixed = |fixed| Words { per_row: 0, fixed };
        Demand { kept: fixed(KEPT), step: fixed(Gone::WORDS), ..Demand::NONE }
    }

    /// The steady force that velocities show at a sub-step's end, beyond what takes the ends to their places: that of what turns, and that of what hangs
    /// by methods that move it by half of that. So much it lets go, to take it with the rest, which alone tells what the links of a chain bear
    /// together. A jolt is no steady force: of the last two the lesser counts.
    fn begin(&self, bodies: &mut Bodies<'_>, share: &mut Share<'_>) {
        share.claim(*b"dist", &[]);
        let [_, last, before, left @ ..] = &mut *share.kept.fixed else { return };
        let (h, [last, before]) = (bodies.substep.seconds(), [*last, *before].map(f32::from_bits));
        let steady = max(min(last, before), 0.0) + min(max(last, before), 0.0);
        let by = steady * (h * h);
        let line = self.line(bodies).filter(|_| by != 0.0 && by.is_finite());
        if let Some(line) = &line {
            line.part(bodies, by, line.first, left);
        }
        Gone { by: line.map_or(0.0, |_| by), along: Vec3::ZERO }.write(share.step);
    }

    fn project(&self, bodies: &mut Bodies<'_>, share: &mut Share<'_>) {
        let [_, _, _, left @ ..] = &mut *share.kept.fixed else { return };
        let gone = self.pull(bodies, Gone::read(share.step).by, left);
        gone.unwrap_or(Gone::SLACK).write(share.step);
    }

    fn settle(&self, bodies: &mut Bodies<'_>, share: &mut Share<'_>) {
        let [_, last, before, ..] = &mut *share.kept.fixed else { return };
        let gone = Some(Gone::read(share.step)).filter(|gone| gone.by.is_finite());
        let steady = gone.and_then(|gone| self.calm(bodies, gone)).filter(|force| force.is_finite());
        (*before, *last) = (*last, steady.unwrap_or(0.0).to_bits());
    }
}

#[cfg(feature = "alloc")]
impl Declared for Distance {
    fn name(&self) -> &'static str {
        "distance"
    }

    fn solved(&self) -> &'static str {
        "one after the other"
    }

    fn fault(&self) -> Option<(&'static str, &'static str)> {
        Self::fault(self)
    }

    fn ends(&self) -> [&[u32]; 3] {
        [&self.ends, &[], &[]]
    }

    fn links(&self) -> Box<dyn Iterator<Item = [u32; 2]> + '_> {
        Box::new(core::iter::once(self.ends))
    }

    fn lengths(&self) -> &[f32] {
        core::slice::from_ref(&self.length)
    }

    fn compliance(&self) -> f32 {
        self.compliance
    }

    fn is_tether(&self) -> bool {
        self.tether
    }

    fn inverse_mass(&self, start: &[Particle]) -> f64 {
        self.ends.iter().map(|&end| inverse_mass(start, end)).sum()
    }
}
