//! Particles that are tied to a place on another body: buttons, patches, ropes on boxes, hair on cloth.

mod grip;
mod place;
mod rope;

use super::{Bodies, Constraint, Demand, Share, Words};
use crate::index::between;
use crate::math::{largest, length, max};
use glam::Vec3;
use grip::Grip;
pub use rope::TiedRope;

/// Ties a particle to a place on a body of other particles, such as a triangle of cloth or a box: C = x − Σ wᵢ xᵢ − offset n, all three numbers of it.
///
/// The place goes with the body: wᵢ are the shares that its particles have in it, and n is the normal of a triangle. Both are given, or learnt when
/// the constraint first acts: the place is then where the particle is. Of one particle the place is that itself; of two it is on the line through them, next to
/// where the particle is; of three it is anywhere; of more it is in the space that they span.
///
/// The force acts on the particle and, opposite, on the body's particles by their shares (and across a triangle, where there is an offset), so that linear and
/// angular momentum are kept to rounding. With a compliance α the particle is α times the force away from its place, whatever the sub-steps: ΔJ = −(C +
/// α/h² J) / (∇C M⁻¹ ∇Cᵀ + α/h²) (Macklin, Müller and Chentanez, "XPBD", MIG 2016, section 4). Where it is away both act at the particle, by a couple on the body: up to
/// half the body's radius of gyration, which a body of a single particle has not; farther out, and there, angular momentum fades. A damping β takes from the speed of
/// that what a force β times the speed does, by an implicit step at the sub-step's end. A rigid tie keeps nothing of that speed.
///
/// One iteration a sub-step, a few more where there is an offset: a tie that joins something light to what is n times as heavy, and is held by other
/// constraints, is off by about n g h² under its load. List it behind what it ties.
///
/// While one of the particles is dead it does nothing, and neither does one with an offset from a triangle without area. In a
/// [periodic room](crate::index::Periodic) it acts along the shortest way through the sides.
///
/// ```
/// use pointmass::constrain::Tie;
/// use pointmass::{Gravity, Heap, Particle, Scene, System, Time, Vec3};
///
/// // A button in the middle of a triangle, which is held at its corners.
/// let corner = |position: Vec3| Particle { position, fixed: true, ..Particle::REST };
/// let button = Particle { position: Vec3::new(0.25, 0.0, 0.25), ..Particle::REST };
/// let start = [corner(Vec3::ZERO), corner(Vec3::X), corner(Vec3::Z), button];
/// let tie = Tie { compliance: 1e-3, damping: 30.0, ..Tie::rigid(3, [0, 1, 2]) };
/// let scene = Scene { start: &start, forces: &Gravity::EARTH, constraints: &tie, substeps: 10, ..Scene::EMPTY };
/// let mut system = System::with(Heap::new(scene.size()));
/// system.start(&scene, 1)?;
/// for frame in 1..=60 {
///     system.step_to(&scene, Time::frame(frame, 60));
/// }
/// assert!((system.particles().position[3].y + 0.00980665).abs() < 1e-5);
/// # Ok::<(), pointmass::InsufficientMemory>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Tie<T, W = [f32; 0]> {
    /// The particle, by its place in the scene's start.
    pub particle: u32,
    /// The particles of the body that it is tied to, likewise.
    pub to: T,
    /// The share of each of these in the place, which have to add up to one and may be below zero; without them they are learnt.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Option::is_none"))]
    pub weights: Option<W>,
    /// With weights and three particles: how far the place is from their plane, along the normal from which they are seen anticlockwise \[m\].
    #[cfg_attr(feature = "serde", serde(default))]
    pub offset: f32,
    /// α: how far it gives way to a force \[m/N\]; zero is rigid.
    #[cfg_attr(feature = "serde", serde(default))]
    pub compliance: f32,
    /// β: the force against being drawn away, for the speed of that \[N s/m\].
    #[cfg_attr(feature = "serde", serde(default))]
    pub damping: f32,
}

/// Words kept before the weights: whose they are, whether they are known, and the offset.
const HEAD: usize = 3;
/// Rounds at the most where there is an offset, whose direction is not linear in the places.
const ROUNDS: u32 = 6;
/// How far a rigid tie may be off after all rounds, a share of the size of what it ties: what is left is rounding.
const NEARLY: f32 = 1e-4;
/// By how much the sum of weights may be off one.
const EVEN: f32 = 1e-3;

impl<T> Tie<T> {
    /// A rigid one, at the place where the particle is when it first acts.
    #[must_use]
    pub const fn rigid(particle: u32, to: T) -> Self {
        Self { particle, to, weights: None, offset: 0.0, compliance: 0.0, damping: 0.0 }
    }
}

impl<T: AsRef<[u32]>, W: AsRef<[f32]>> Tie<T, W> {
    /// The first of its numbers that cannot be used, and what it has to be.
    #[must_use]
    pub fn fault(&self) -> Option<(&'static str, &'static str)> {
        let not_negative = |x: f32| (0.0..f32::INFINITY).contains(&x);
        let (to, weights) = (self.to.as_ref(), self.given());
        let sum: f32 = weights.iter().sum();
        let has_place = self.weights.is_some();
        let faults = [
            (to.is_empty(), "to", "has to name a particle at least"),
            (to.contains(&self.particle), "to", "must not name the particle that is tied"),
            (has_place && weights.len() != to.len(), "weights", "has to hold one for each particle of to, or none"),
            (has_place && !((sum - 1.0).abs() < EVEN), "weights", "have to add up to one"),
            (!self.offset.is_finite(), "offset", "has to be finite, in m"),
            (self.offset != 0.0 && !(has_place && to.len() == 3), "offset", "needs weights, and three particles in to"),
            (!not_negative(self.compliance), "compliance", "must not be below zero, in m/N"),
            (!not_negative(self.damping), "damping", "must not be below zero, in N s/m"),
        ];
        faults.into_iter().find(|&(wrong, ..)| wrong).map(|(_, name, message)| (name, message))
    }

    /// The words that it keeps.
    fn words(&self) -> usize {
        self.to.as_ref().len().saturating_add(HEAD)
    }

    /// The weights that are given.
    fn given(&self) -> &[f32] {
        self.weights.as_ref().map_or(&[], AsRef::as_ref)
    }

    /// Brings the particle to its place, or so near that the compliance is met.
    fn close(&self, bodies: &mut Bodies<'_>, place: &[u32]) -> Option<()> {
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
        let offset = place::offset(place);
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
            if offset == 0.0 {
                return Some(());
            }
        }
        let open = self.open(bodies, place, rows)?;
        if soft == 0.0 && !(length(open) <= NEARLY * (grip.size() + offset.abs())) {
            bodies.report.effort.capped += 1;
        }
        Some(())
    }

    /// Takes from velocities what draws the particle away from its place.
    fn brake(&self, bodies: &mut Bodies<'_>, place: &[u32]) -> Option<()> {
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
    fn act(
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
        self.push(bodies, place, grip, [-pull, Vec3::ZERO], |bodies, row, [moved, _]| by(bodies, row, moved));
        by(bodies, tied, own);
    }

    /// Moves the body's particles by what two impulses at its place do.
    fn push(
        &self,
        bodies: &mut Bodies<'_>,
        place: &[u32],
        grip: &Grip,
        pulls: [Vec3; 2],
        mut by: impl FnMut(&mut Bodies<'_>, usize, [Vec3; 2]),
    ) {
        let (back, turns) = (grip.back, pulls.map(|pull| grip.turn(pull)));
        let first = self.to.as_ref().first().and_then(|&number| bodies.row_of_start(number));
        let Some(first) = first else { return };
        let origin = bodies.position[first] - bodies.velocity[first] * back;
        for (number, weight) in place::weights(place).enumerate() {
            let row = self.to.as_ref().get(number).and_then(|&number| bodies.row_of_start(number));
            let Some(row) = row else { return };
            let from = bodies.position[row] - bodies.velocity[row] * back;
            let arm = between(bodies.near.room(), origin, from) - grip.center;
            let of = (number, f32::from_bits(weight), bodies.inverse_mass[row]);
            let moved = [0, 1].map(|i| grip.moved(of, pulls[i], [turns[i], arm]));
            if moved != [Vec3::ZERO; 2] {
                by(bodies, row, moved);
            }
        }
    }
}

impl<T: AsRef<[u32]> + Sync, W: AsRef<[f32]> + Sync> Constraint for Tie<T, W> {
    fn demand(&self) -> Demand {
        Demand { kept: Words { per_row: 0, fixed: self.words() }, ..Demand::NONE }
    }

    fn is_empty(&self) -> bool {
        self.to.as_ref().is_empty()
    }

    fn prepare(&self, bodies: &mut Bodies<'_>, share: &mut Share<'_>) {
        if share.claim(*b"tie ", &[self.to.as_ref().len(), self.given().len()]) {
            self.learn(bodies, share.kept.fixed);
        }
    }

    fn project(&self, bodies: &mut Bodies<'_>, share: &mut Share<'_>) {
        let _ = self.close(bodies, share.kept.fixed);
    }

    fn settle(&self, bodies: &mut Bodies<'_>, share: &mut Share<'_>) {
        let _ = self.brake(bodies, share.kept.fixed);
    }
}
