//! Particles that are tied to a place on another body: buttons, patches, ropes on boxes, hair on cloth.

mod grip;
mod hold;
mod laden;
mod place;
mod pull;
mod rope;

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
/// One iteration a sub-step, a few more where there is an offset, and as often as others move apart what one [bears](crate::constrain::Bodies::bear) of the other: a [`Shell`](super::Shell) is solved with what is
/// tied to it rigidly, unless that is solved with others apart (another shell, strands, a rope); and rigid ties of a list are met again after each other. Elsewhere a tie that joins something light to what is n times as heavy, and is held by other constraints, is off by
/// about n g h² under its load, and a seam of two that are solved apart opens by some n² g h² where n rows of particles hang below it. List it behind what it ties.
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
}
