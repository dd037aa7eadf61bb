//! Sheets of triangles that are kept apart from each other, from themselves and from the scenery.

mod blocks;
mod bounds;
mod closest;
mod contact;
mod eights;
mod listing;
mod lists;
mod look;
mod near;
mod pair;
mod renew;
mod rest;
mod scenery;
mod search;
mod settle;
mod solver;
mod taut;
mod tell;
mod tree;
mod waiting;
mod zones;

use super::{Bodies, Constraint, Demand, Share};
use lists::{Kept, Work};
use rest::Rest;

/// Keeps the triangles of sheets a thickness apart, those of one sheet as those of several, on both sides, with Coulomb's friction and the
/// elasticity of their particles and materials. It keeps particles half a thickness off the scenery as well.
///
/// Points are kept from triangles and edges from edges by equal and opposite pushes at their nearest places, which keep momentum to rounding. The
/// angular momentum that these lose is given back by turning all sheets together, but not where one is fixed or touches the scenery, nor where
/// that would turn them by more than 0.02 rad in a sub-step, as very fast hits would. Whatever comes near is found by a tree of boxes that the
/// order of the material makes: a triangle is wider than a touch reaches, and what is near in a sheet stays near. Pairs are listed that come near
/// each other where all go on as they do, within a skin, and last through the step's sub-steps; the triangles of whoever leaves its way by more
/// are sought anew. Lists change no bit of what happens. They are counted in [`Effort::lists`](crate::Effort::lists), and searches for which they
/// found no room in [`Effort::streamed`](crate::Effort::streamed).
///
/// **Nothing passes.** Paths are straight from the sub-step's beginning to its end. Two that are apart in some direction at both ends are so all
/// the way; others are followed by conservative advancement. Between searches nobody goes farther than a share below half of the distance to
/// all that it is no part of (Chen et al., "Offset Geometric Contact", SIGGRAPH 2025; Wu, Wang and Wang, "A Safe and Fast Repulsion
/// Method for GPU-based Cloth Self Collisions", ACM Transactions on Graphics 40, 2021). What would pass all the same moves as one
/// (rigid impact zones: Provot 1997; Harmon et al., "Robust Treatment of Simultaneous Collisions", SIGGRAPH 2008) and is counted in
/// [`Effort::capped`](crate::Effort::capped). That holds for what this constraint sees: it has to be the last, and what a script does to
/// particles after it can bring sheets through each other. So can the scenery's sweep, to which only those are left that something without
/// [`contacts`](crate::shape::Collider::contacts) stops in the step. Sheets that begin through each other stay so.
///
/// A push takes along what its corner hangs on: edges that pushes have lengthened are shortened between them, so that a push on a corner is one
/// on the sheet.
///
/// Friction is Coulomb's by all that presses, by position and by velocity, so that its coefficient is right with every method; with explicit
/// Euler and two sub-steps what should lie still creeps by millimetres all the same. What leans against a sheet (edges on edges, points beyond a
/// rim) pushes only where points over triangles leave it too near.
///
/// [`Observer`](crate::Observer)s are told of whatever comes together faster than what rests does in a step, once, as it begins
/// ([`touched`](crate::Observer::touched)): of both sides, for each of which that corner stands that touches most, and of a particle that this
/// keeps off the scenery.
///
/// Parts of one sheet that are nearer at rest than twice the thickness are kept only half as far apart as they are there, so that a mesh may be
/// as fine as it likes, and triangles with a common corner do not mind each other. Two sheets that begin nearer than they may be are let apart
/// slowly. What begins exactly in one place has no sides, and is not kept apart.
///
/// ```
/// use pointmass::constrain::SheetContacts;
/// use pointmass::{Heap, Particle, Scene, System, Time, Vec3};
///
/// // A triangle flies at another.
/// let corners = [Vec3::ZERO, Vec3::X, Vec3::Z];
/// let particle = |position, velocity| Particle { position, velocity, ..Particle::REST };
/// let start: Vec<_> = corners.iter().map(|&x| particle(x, Vec3::ZERO))
///     .chain(corners.iter().map(|&x| particle(x + Vec3::new(0.1, 0.5, 0.1), Vec3::NEG_Y * 30.0)))
///     .collect();
/// let contacts = SheetContacts {
///     particles: [0, 1, 2, 3, 4, 5],
///     triangles: [[0, 1, 2], [3, 4, 5]],
///     thickness: [0.01],
/// };
/// let scene = Scene { start: &start, constraints: &contacts, ..Scene::EMPTY };
/// let mut system = System::with(Heap::new(scene.size()));
/// system.start(&scene, 1)?;
/// for frame in 1..=30 {
///     system.step_to(&scene, Time::frame(frame, 60));
/// }
/// let height = |particle: usize| system.particles().position[particle].y;
/// assert!((0..3).all(|i| height(i + 3) > height(i))); // It is still above.
/// # Ok::<(), pointmass::InsufficientMemory>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SheetContacts<P, T, W> {
    /// The particles, by their place in the scene's start.
    pub particles: P,
    /// The triangles of all sheets, by places in `particles`.
    pub triangles: T,
    /// How thick each triangle is, in the same order \[m\]; the last holds for all further ones. Two keep half of both apart.
    pub thickness: W,
}

impl<P: AsRef<[u32]>, T: AsRef<[[u32; 3]]>, W: AsRef<[f32]>> SheetContacts<P, T, W> {
    /// The numbers of its particles and triangles.
    fn counts(&self) -> [usize; 2] {
        [self.particles.as_ref().len(), self.triangles.as_ref().len()]
    }

    /// The first of its numbers that cannot be used, and what it has to be.
    #[must_use]
    pub fn fault(&self) -> Option<(&'static str, &'static str)> {
        let [particles, triangles] = self.counts();
        let thickness = self.thickness.as_ref();
        let above_zero = |x: f32| x > 0.0 && x < f32::INFINITY;
        let stranger = self.triangles.as_ref().iter().flatten().any(|&corner| corner as usize >= particles);
        let faults = [
            (stranger, "triangles", "have to name places in particles, from 0"),
            (thickness.is_empty() && triangles > 0, "thickness", "has to hold that of a triangle at least, in m"),
            (!thickness.iter().all(|&x| above_zero(x)), "thickness", "has to be above zero, in m"),
        ];
        faults.into_iter().find(|&(wrong, ..)| wrong).map(|(_, name, message)| (name, message))
    }
}

impl<P, T, W> Constraint for SheetContacts<P, T, W>
where
    P: AsRef<[u32]> + Sync,
    T: AsRef<[[u32; 3]]> + Sync,
    W: AsRef<[f32]> + Sync,
{
    fn demand(&self) -> Demand {
        if self.is_empty() { Demand::NONE } else { lists::demand(self.counts()) }
    }

    fn is_empty(&self) -> bool {
        self.triangles.as_ref().is_empty()
    }

    fn prepare(&self, bodies: &mut Bodies<'_>, share: &mut Share<'_>) {
        share.claim(*b"shee", &self.counts());
        let Some(mut rest) = Rest::of(share.kept.fixed, self.counts()) else { return };
        if !rest.is_known() && !self.is_empty() && self.fault().is_none() {
            let (particles, triangles) = (self.particles.as_ref(), self.triangles.as_ref());
            rest.learn(particles, triangles, self.thickness.as_ref(), bodies, share.scratch);
        }
        if rest.is_known() && rest.bury(self.particles.as_ref(), bodies, share.scratch) {
            // Lists know of no edges and corners that have come to others.
            if let Some(mut near) = Kept::of(share.step, self.counts()).and_then(|kept| kept.near) {
                near.forget(&rest);
            }
        }
        if rest.is_known() && bodies.substep.number == 0 {
            for (&particle, &half) in self.particles.as_ref().iter().zip(&*rest.half) {
                if let Some(row) = bodies.row_of_start(particle) {
                    bodies.keep_off(row, half);
                }
            }
        }
    }

    fn project(&self, bodies: &mut Bodies<'_>, share: &mut Share<'_>) {
        let Some(mut kept) = Kept::of(share.step, self.counts()) else { return };
        let Some(rest) = Rest::of(share.kept.fixed, self.counts()).filter(Rest::is_known) else { return };
        let Some(mut work) = Work::of(share.scratch, self.counts()) else { return };
        if bodies.substep.seconds() > 0.0 {
            work.gather(bodies, self.particles.as_ref(), &mut kept);
            solver::project(&rest, &mut kept, &mut work, bodies);
        }
    }

    fn settle(&self, bodies: &mut Bodies<'_>, share: &mut Share<'_>) {
        let Some(rest) = Rest::of(share.kept.fixed, self.counts()).filter(Rest::is_known) else { return };
        let Some(mut kept) = Kept::of(share.step, self.counts()).filter(|_| !rest.faces.is_empty()) else { return };
        let Some(mut work) = Work::of(share.scratch, self.counts()) else { return };
        if bodies.substep.seconds() > 0.0 {
            settle::settle(&rest, &mut kept, &mut work, bodies);
        }
    }
}
