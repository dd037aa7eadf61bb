//! Chains of links that are solved as one: ropes, strings, necklaces.

mod bounded;
mod chain;
mod fallback;
mod held;
mod links;
mod paces;
mod solver;
mod vigour;

use super::walls::{self, Wall};
use super::{Bodies, Constraint, Demand, Share, Words};
#[cfg(feature = "alloc")]
use alloc::boxed::Box;
use bounded::Bounds;
use chain::Chain;
use glam::Vec3;
pub(super) use held::Held;
use links::Links;

/// Links between particles, each to the next, all solved at once: C = |x₁ − x₂| − length of every link.
///
/// A link of compliance α stretches by α times the force through it, and a rigid chain is as long as its links, however many there
/// are and whatever the sub-steps: in each the tridiagonal system (∇C M⁻¹ ∇Cᵀ + α/h²) Δλ = −C − (α/h²) λ is solved directly, link
/// by link there and back, until lengths are met to rounding (Macklin, Müller and Chentanez, "XPBD", MIG 2016, equation 18; Deul et
/// al., "Direct Position-Based Solver for Stiff Rods", Computer Graphics Forum 37, 2018, section 4). Two or three such rounds are the
/// rule, and eight the most, of which each takes time in proportion to the number of links; where the sub-step is gone through in paces (below) there may be
/// up to 256 of these.
///
/// A damping β takes from the speed at which a link stretches what a force β times that speed does, by an implicit step at the
/// sub-step's end. Rigid links keep nothing of that speed: with `Verlet` that is RATTLE (Andersen, J. Comput. Phys. 52, 1983).
/// The energy that this gives in one sub-step it takes in another; of a rope that nobody holds it takes what goes beyond at once, from how it
/// moves against a rigid motion with the same momenta, and from the ways of soft links too, so that it never gains any, nor does what is left of it
/// in parts.
///
/// Linear momentum is kept to rounding, and so is angular momentum, since links act along the directions that they had when the sub-step began.
/// Where one of them would turn by more than 30° in it (the end of a whip), or where links are so light for what pulls at
/// them that they would swing faster than the sub-step shows (a heavy bob), the sub-step is gone through in paces that are short enough for that, with the
/// forces that the method shows (as multiple time steps: Tuckerman, Berne and Martyna, J. Chem. Phys. 97, 1992): a pendulum swings in its time and as wide as
/// before, however heavy its bob is and however few the sub-steps are. The number of paces grows with that of links and with the root of how many times as heavy as the rope the
/// bob is; where 256 are too few (30 links of 0.3 m in all in one sub-step of 1/60 s that hold a thousand times their mass), links are made heavier meanwhile, which makes such a swing slower by
/// some hundredths, and is counted as capped in [`Effort`](crate::Effort). Rounding of what pulls makes light links swing: with a bob of a thousand times the rope's mass by up to some thousandths of the energy of the swing in half a minute.
/// A rope that does not come near its lengths even so goes by the directions that links have at the sub-step's end, which takes energy, or keeps the form that it had as
/// the sub-step began, if that was nearer, and is counted as capped in [`Effort`](crate::Effort).
///
/// What nobody holds is given back what rounding of its places takes of its angular momentum about its middle, wherever it is. What is straight, to eight
/// roundings of its coordinates, ε |x|, cannot have any about itself: until it bends it may be without a share of 2e-5 + 8 ε |x| / r of all, r being how far its
/// ends are from its middle. Far off, rounding strains soft links by α⁻¹ (2 ε |x|)² / 2 each, which counts for nothing in its energy; and it drives them: a soft rope
/// that has come to all the energy it may have turns slower for a while (in 50 sub-steps by up to 1 % 30 m off, by 5 % at 100 m; one of a single link so soft
/// that it is slack most of the time, by a third within a minute at 30 m).
///
/// The scenery presses particles while links are solved, and its friction brakes them by that: round a peg pulls grow as capstan's law has it, T₂ / T₁ =
/// exp(μ φ). Links then move a particle along its wall alone, as if it were so much heavier as friction brakes it; which walls press, and how hard, rounds
/// of the solution tell, 32 at the most. Where that does not come near the lengths in 256 paces, links act halfway between the directions that they have at the
/// beginning and at the end (the gradient of a discrete energy: Gonzalez, J. Nonlinear Sci. 6, 1996), which holds however fast particles swing, and takes
/// from the energy of a swing about half the square of the angle by which links turn in a sub-step. Loads of it, and bodies tied to
/// its ends, of up to a thousand times its mass go over a peg as that law says within 4 % in 20 sub-steps, and within a fifth in fewer; those that friction
/// holds may slip by some millimetres in the first half second. Of lighter ropes friction takes less, until from some hundred thousand times on they run as
/// if there was none, and rounding may take a point of theirs some millimetres into what it lies on. What the scenery is near has no bounds of energy of its own; where that stands, a sub-step of many paces does not end with a
/// twentieth more than there was and forces give. It takes 39 words for each particle through a step.
///
/// Whoever is fixed stays. Where a particle has died the chain is broken: both its links do nothing, and the parts are solved each by itself. A link whose ends are in one place
/// has no direction, and does nothing either. No particle may be named twice: a rope does not meet itself. In a
/// [periodic room](crate::index::Periodic) links act along the shortest way through the sides.
///
/// ```
/// use pointmass::constrain::Rope;
/// use pointmass::{Gravity, Heap, Particle, Scene, System, Time, Vec3};
///
/// // Half a metre of chain, held at one end.
/// let link = |i: usize| Particle { position: Vec3::X * (0.05 * i as f32), fixed: i == 0, ..Particle::REST };
/// let start: [Particle; 11] = core::array::from_fn(link);
/// let particles: [u32; 11] = core::array::from_fn(|i| i as u32);
/// let rope = Rope::rigid(particles, [0.05]);
/// let scene = Scene { start: &start, forces: &Gravity::EARTH, constraints: &rope, substeps: 5, ..Scene::EMPTY };
/// let mut system = System::with(Heap::new(scene.size()));
/// system.start(&scene, 1)?;
/// for frame in 1..=60 {
///     system.step_to(&scene, Time::frame(frame, 60));
/// }
/// let links = system.particles().position.windows(2).map(|ends| ends[0].distance(ends[1]));
/// assert!(links.into_iter().all(|length| (length - 0.05).abs() < 1e-6));
/// # Ok::<(), pointmass::InsufficientMemory>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Rope<P, L> {
    /// The particles, by their place in the scene's start, from one end to the other.
    pub particles: P,
    /// How long the links are, in the same order \[m\]; the last of the lengths holds for all further links.
    pub lengths: L,
    /// α: how far each link gives way to a force \[m/N\]; zero is rigid.
    #[cfg_attr(feature = "serde", serde(default))]
    pub compliance: f32,
    /// β: the force of each link against being stretched, for the speed of that \[N s/m\].
    #[cfg_attr(feature = "serde", serde(default))]
    pub damping: f32,
    /// True if links only pull, as those of a string do.
    #[cfg_attr(feature = "serde", serde(default))]
    pub tether: bool,
    /// True if one more link joins the last particle to the first.
    #[cfg_attr(feature = "serde", serde(default))]
    pub closed: bool,
}

impl<P, L> Rope<P, L> {
    /// A chain of rigid links.
    #[must_use]
    pub const fn rigid(particles: P, lengths: L) -> Self {
        Self { particles, lengths, compliance: 0.0, damping: 0.0, tether: false, closed: false }
    }

    /// A string that does not stretch, and does not push.
    #[must_use]
    pub const fn string(particles: P, lengths: L) -> Self {
        Self { particles, lengths, compliance: 0.0, damping: 0.0, tether: true, closed: false }
    }
}

impl<P: AsRef<[u32]>, L: AsRef<[f32]>> Rope<P, L> {
    /// The first of its numbers that cannot be used, and what it has to be.
    #[must_use]
    pub fn fault(&self) -> Option<(&'static str, &'static str)> {
        let not_negative = |x: f32| (0.0..f32::INFINITY).contains(&x);
        let (particles, lengths) = (self.particles.as_ref(), self.lengths.as_ref());
        let faults = [
            (particles.len() < 2, "particles", "has to name two particles or more"),
            (self.closed && particles.len() < 3, "particles", "has to name three particles or more where it is closed"),
            (lengths.is_empty(), "lengths", "has to hold the length of a link at least, in m"),
            (lengths.len() > self.links(), "lengths", "must not hold more lengths than there are links"),
            (!lengths.iter().all(|&x| not_negative(x)), "lengths", "must not be below zero, in m"),
            (!not_negative(self.compliance), "compliance", "must not be below zero, in m/N"),
            (!not_negative(self.damping), "damping", "must not be below zero, in N s/m"),
        ];
        faults.into_iter().find(|&(wrong, ..)| wrong).map(|(_, name, message)| (name, message))
    }

    /// The number of links.
    fn links(&self) -> usize {
        let particles = self.particles.as_ref().len();
        if self.closed && particles > 2 { particles } else { particles.saturating_sub(1) }
    }

    /// The chain that it is, with the rows of its particles, and the words for its links and for its bounds; none, if these are too few.
    fn chain_of<'m>(
        &'m self,
        bodies: &Bodies<'_>,
        held: &'m [Option<Held>],
        words: &'m mut [u32],
    ) -> Option<(Chain<'m>, [&'m mut [u32]; 2])> {
        let Self { compliance, tether, .. } = *self;
        let (names, lengths) = (self.particles.as_ref(), self.lengths.as_ref());
        let (particles, closed) = (names.len(), self.closed && names.len() > 2);
        let (rows, rest) = words.split_at_mut_checked(particles)?;
        let (links, rest) = rest.split_at_mut_checked(links::WORDS * particles)?;
        let nobody = Chain { rows: &[], first: 0, particles, lengths, compliance, tether, closed, held };
        Some((nobody.filled(bodies, names, rows), [links, rest]))
    }

    /// What it asks for where something holds it: nothing is kept of it.
    pub(super) fn demand_held(&self) -> Demand {
        let fixed = (1 + links::WORDS).saturating_mul(self.particles.as_ref().len());
        let step = walls::WORDS.saturating_mul(self.particles.as_ref().len());
        let words = |fixed| Words { per_row: 0, fixed };
        Demand { step: words(step), scratch: words(fixed), ..Demand::NONE }
    }
}

/// The bounds that solving a chain keeps to; none where the scenery may press it, which changes its momenta: what was kept of them is forgotten.
fn bounds_of<'m>(
    chain: Chain<'m>,
    bodies: &Bodies<'_>,
    walls: &[Wall],
    (kept, words): (&'m mut [u32], &'m mut [u32]),
) -> Option<Bounds<'m>> {
    if walls.iter().any(Wall::is_near) {
        kept.iter_mut().skip(1).for_each(|word| *word = 0);
        return None;
    }
    Bounds::of(chain, bodies, kept, words)
}

/// Settles what walls have pressed, which they do as if all were as heavy in each direction; what an end is joined to is not.
fn settle_walls(bodies: &mut Bodies<'_>, walls: &mut [Wall], held: &[Option<Held>]) {
    let ends = [walls.first(), walls.last()].map(|wall| wall.and_then(Wall::row));
    let before = ends.map(|row| row.map(|row| bodies.velocity[row]));
    let normals = [walls.first(), walls.last()].map(|wall| wall.map_or(Vec3::ZERO, |wall| wall.normals()[0]));
    walls::settle(walls, bodies);
    for (end, held) in held.iter().enumerate().filter_map(|(end, held)| Some((end, held.as_ref()?))) {
        if let Some((row, before)) = ends[end].zip(before[end]) {
            let off = (bodies.velocity[row] - before).dot(normals[end]);
            bodies.velocity[row] += held.lean(normals[end]) * off;
        }
    }
}

impl<P: AsRef<[u32]> + Sync, L: AsRef<[f32]> + Sync> Constraint for Rope<P, L> {
    fn demand(&self) -> Demand {
        let (bounds, held) = (bounded::demand(self.particles.as_ref().len()), self.demand_held());
        Demand { step: held.step, scratch: bounds.scratch.and(held.scratch), ..bounds }
    }

    fn is_empty(&self) -> bool {
        self.links() == 0
    }

    fn prepare(&self, bodies: &mut Bodies<'_>, share: &mut Share<'_>) {
        share.claim(*b"rope", &[]);
        bodies.join_all(self.particles.as_ref());
    }

    fn project(&self, bodies: &mut Bodies<'_>, share: &mut Share<'_>) {
        self.close(bodies, share, &[]);
    }

    fn settle(&self, bodies: &mut Bodies<'_>, share: &mut Share<'_>) {
        self.settle_held(bodies, share, &[]);
    }
}

impl<P: AsRef<[u32]>, L: AsRef<[f32]>> Rope<P, L> {
    /// Brings links to their lengths, while the ends are joined to something, or to nothing.
    pub(super) fn close(&self, bodies: &mut Bodies<'_>, share: &mut Share<'_>, held: &[Option<Held>]) {
        let h = bodies.substep.seconds();
        if !(h > 0.0) {
            return;
        }
        let Some((chain, [own, words])) = self.chain_of(bodies, held, share.scratch) else { return };
        if self.compliance > 0.0 {
            // Soft links answer forces by what they do in a whole sub-step, along the directions of its beginning, as a method of first order shows it:
            // with others what hangs still would show speed, and what swings would be driven.
            chain.parts().for_each(|part| Links::of(part, own, &mut []).catch_up(bodies));
        }
        let walls = walls::of(share.step, self.particles.as_ref().len());
        walls::gather(walls, self.particles.as_ref(), bodies);
        let mut bounds = bounds_of(chain, bodies, walls, (share.kept.fixed, words));
        if let Some(bounds) = &mut bounds {
            bounds.limit(bodies);
        }
        chain.parts().for_each(|part| Links::of(part, own, walls).close(bodies));
        if let Some(bounds) = &mut bounds {
            bounds.keep_within(bodies);
        }
    }

    /// Settles velocities, likewise.
    pub(super) fn settle_held(&self, bodies: &mut Bodies<'_>, share: &mut Share<'_>, held: &[Option<Held>]) {
        let h = bodies.substep.seconds();
        // In no time nobody has looked for any.
        let walls = if h > 0.0 { walls::of(share.step, self.particles.as_ref().len()) } else { &mut [] };
        let is_by_walls = walls.iter().any(Wall::is_near);
        if is_by_walls {
            settle_walls(bodies, walls, held);
        }
        let brake = self.damping * h;
        let soft = if self.compliance > 0.0 { 1.0 / brake } else { 0.0 };
        if soft < f32::INFINITY {
            self.brake(bodies, (share.kept.fixed, share.scratch), walls, (held, soft));
        }
        if is_by_walls {
            walls::follow(walls, bodies);
        }
    }

    /// Takes out of velocities what makes links longer, or shorter, as far as they are softened by so much.
    fn brake(
        &self,
        bodies: &mut Bodies<'_>,
        (kept, scratch): (&mut [u32], &mut [u32]),
        walls: &mut [Wall],
        (held, soft): (&[Option<Held>], f32),
    ) {
        let Some((chain, [own, words])) = self.chain_of(bodies, held, scratch) else { return };
        let mut bounds = bounds_of(chain, bodies, walls, (kept, words));
        if let Some(bounds) = &mut bounds {
            bounds.limit_settled(bodies);
        }
        for part in chain.parts() {
            let mut links = Links::of(part, own, walls);
            links.take_up(bodies, 0.0);
            links.brake(soft);
            links.hand_back(bodies, 0.0);
        }
        if let Some(bounds) = &mut bounds {
            bounds.keep_settled(bodies);
        }
    }
}

#[cfg(feature = "alloc")]
impl<P: AsRef<[u32]> + Sync, L: AsRef<[f32]> + Sync> super::declared::Declared for Rope<P, L> {
    fn name(&self) -> &'static str {
        "rope"
    }

    fn solved(&self) -> &'static str {
        "link by link, directly"
    }

    fn fault(&self) -> Option<(&'static str, &'static str)> {
        Self::fault(self).or_else(|| super::declared::twice(self.particles.as_ref()))
    }

    fn ends(&self) -> [&[u32]; 3] {
        [self.particles.as_ref(), &[], &[]]
    }

    fn links(&self) -> Box<dyn Iterator<Item = [u32; 2]> + '_> {
        let list = self.particles.as_ref();
        let back = list.last().zip(list.first()).filter(|_| self.closed).map(|(&last, &first)| [last, first]);
        Box::new(list.windows(2).map(|pair| [pair[0], pair[1]]).chain(back))
    }

    fn lengths(&self) -> &[f32] {
        self.lengths.as_ref()
    }

    fn compliance(&self) -> f32 {
        self.compliance
    }

    fn is_tether(&self) -> bool {
        self.tether
    }
}
