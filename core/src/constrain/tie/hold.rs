//! How a tie holds what it ties.

#[cfg(feature = "alloc")]
use super::super::declared::{Declared, inverse_mass, twice};
use super::super::{Bodies, Constraint, Demand, Share, Words};
use super::grip::Grip;
use super::place::{offset, weights};
use super::{NEARLY, Tie, laden};
use crate::index::between;
use crate::math::{largest, length, max};
#[cfg(feature = "alloc")]
use crate::particles::Particle;
use glam::Vec3;

/// Rounds at the most where there is an offset, whose direction is not linear in the places.
const ROUNDS: u32 = 6;
impl<T: AsRef<[u32]>, W: AsRef<[f32]>> Tie<T, W> {
    /// Learns where the place is, if that is not known.
    pub(super) fn know(&self, bodies: &Bodies<'_>, share: &mut Share<'_>) {
        if share.claim(*b"tie ", &[self.to.as_ref().len(), self.given().len()]) {
            self.learn(bodies, share.kept.fixed);
        }
    }

    /// Brings the particle to its place, or so near that the compliance is met.
    pub(super) fn close(&self, bodies: &mut Bodies<'_>, place: &[u32]) -> Option<()> {
        let h = bodies.substep.seconds();
        if !(h > 0.0) {
            return None;
        }
        let (rows, mut grip) = self.grip(bodies, place, h)?;
        let soft = self.compliance / (h * h);
        if soft > 0.0 {
            // The method's own way beyond where velocities lead is no stretch: what hangs still would show speed.
            let lead = |row: usize| bodies.lead(row, h);
            let whole = grip.as_one();
            let pull = whole.answer(0.0, -(lead(rows[0]) - self.mean(bodies, place, rows[1], lead)))?;
            self.act(bodies, place, &whole, pull, |bodies, row, by| bodies.position[row] += by);
            grip = self.grip(bodies, place, h)?.1;
        }
        let aside = offset(place);
        let mut total = Vec3::ZERO;
        for round in 0..ROUNDS {
            let open = self.open(bodies, place, rows)?;
            let size = max(largest(bodies.position[rows[0]]), grip.size());
            if round > 0 && length(open + total * soft) <= 4.0 * f32::EPSILON * size {
                return Some(());
            }
            let pull = grip.answer(soft, -(open + total * soft))?;
            total += pull;
            self.act(bodies, place, &grip, pull, |bodies, row, by| {
                bodies.shift(row, by);
            });
            if aside == 0.0 {
                return Some(());
            }
        }
        let open = self.open(bodies, place, rows)?;
        if soft == 0.0 && !(length(open) <= NEARLY * (grip.size() + aside.abs())) {
            bodies.report.effort.capped += 1;
        }
        Some(())
    }

    /// Takes from velocities what draws the particle away from its place.
    pub(super) fn brake(&self, bodies: &mut Bodies<'_>, place: &[u32]) -> Option<()> {
        let brake = self.damping * bodies.substep.seconds();
        let soft = if self.compliance > 0.0 { 1.0 / brake } else { 0.0 };
        if !(soft < f32::INFINITY) {
            return None;
        }
        let (rows, grip) = self.grip(bodies, place, 0.0)?;
        let pull = grip.answer(soft, -self.parting(bodies, place, rows)?)?;
        self.act(bodies, place, &grip, pull, |bodies, row, by| bodies.velocity[row] += by);
        Some(())
    }

    /// Moves all by what an impulse on the particle, and its opposite on the body, does.
    pub(super) fn act(
        &self,
        bodies: &mut Bodies<'_>,
        place: &[u32],
        grip: &Grip,
        pull: Vec3,
        mut by: impl FnMut(&mut Bodies<'_>, usize, Vec3),
    ) {
        let Some(tied) = bodies.row_of_start(self.particle) else { return };
        let own = pull * grip.own;
        // Before the particle moves: arms are those of where all were.
        self.push(bodies, place, grip, -pull, &mut by);
        by(bodies, tied, own);
    }

    /// Moves the body's particles by what an impulse at its place does.
    pub(super) fn push(
        &self,
        bodies: &mut Bodies<'_>,
        place: &[u32],
        grip: &Grip,
        pull: Vec3,
        mut by: impl FnMut(&mut Bodies<'_>, usize, Vec3),
    ) {
        let (back, turn) = (grip.back, grip.turn(pull));
        let first = self.to.as_ref().first().and_then(|&number| bodies.row_of_start(number));
        let Some(first) = first else { return };
        let origin = bodies.position[first] - bodies.velocity[first] * back;
        for (number, weight) in weights(place).enumerate() {
            let row = self.to.as_ref().get(number).and_then(|&number| bodies.row_of_start(number));
            let Some(row) = row else { return };
            let from = bodies.position[row] - bodies.velocity[row] * back;
            let arm = between(bodies.near.room(), origin, from) - grip.center;
            let of = (number, f32::from_bits(weight), bodies.inverse_mass[row]);
            let moved = grip.moved(of, pull, [turn, arm]);
            if moved != Vec3::ZERO {
                by(bodies, row, moved);
            }
        }
    }
}

impl<T: AsRef<[u32]> + Sync, W: AsRef<[f32]> + Sync> Constraint for Tie<T, W> {
    fn demand(&self) -> Demand {
        let words = |fixed| Words { per_row: 0, fixed };
        Demand { kept: words(self.words()), step: words(laden::STEP), loads: true, ..Demand::NONE }
    }

    fn is_empty(&self) -> bool {
        self.to.as_ref().is_empty()
    }

    fn prepare(&self, bodies: &mut Bodies<'_>, share: &mut Share<'_>) {
        self.know(bodies, share);
        self.hold_both(bodies);
    }

    fn begin(&self, bodies: &mut Bodies<'_>, share: &mut Share<'_>) {
        self.lay_on_both(bodies, share.kept.fixed, share.step);
    }

    fn project(&self, bodies: &mut Bodies<'_>, share: &mut Share<'_>) {
        let _ = self.follow(bodies, share.kept.fixed, share.step);
        let _ = self.close(bodies, share.kept.fixed);
    }

    fn repeats(&self) -> bool {
        self.compliance == 0.0
    }

    fn project_again(&self, bodies: &mut Bodies<'_>, share: &mut Share<'_>) -> bool {
        self.close_again(bodies, share.kept.fixed, share.step).unwrap_or(false)
    }

    fn settle(&self, bodies: &mut Bodies<'_>, share: &mut Share<'_>) {
        let _ = self.brake(bodies, share.kept.fixed);
    }
}

#[cfg(feature = "alloc")]
impl<T: AsRef<[u32]> + Sync, W: AsRef<[f32]> + Sync> Declared for Tie<T, W> {
    fn name(&self) -> &'static str {
        "tie"
    }

    fn solved(&self) -> &'static str {
        "one after the other, to places on other bodies"
    }

    fn fault(&self) -> Option<(&'static str, &'static str)> {
        Self::fault(self).or_else(|| twice(self.to.as_ref()).map(|(_, why)| ("to", why)))
    }

    fn ends(&self) -> [&[u32]; 3] {
        [core::slice::from_ref(&self.particle), self.to.as_ref(), &[]]
    }

    fn compliance(&self) -> f32 {
        self.compliance
    }

    // The place gives way less than the lightest of what it is on.
    fn inverse_mass(&self, start: &[Particle]) -> f64 {
        self.to.as_ref().iter().chain([&self.particle]).map(|&end| inverse_mass(start, end)).sum()
    }
}
