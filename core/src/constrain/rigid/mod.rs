//! Rigid bodies of particles that collide as boxes, as hulls, or as several hulls.

mod ball;
mod balls;
mod beside;
mod body;
mod bound;
mod boxes;
mod closest;
#[cfg(feature = "alloc")]
mod compound;
#[cfg(feature = "alloc")]
mod cut;
mod facets;
mod fly;
mod forms;
mod fours;
mod hull;
#[cfg(feature = "alloc")]
mod hull_buf;
mod kept;
mod lie;
mod lists;
mod made;
mod manifold;
mod members;
mod moving;
mod narrow;
mod order;
mod pack;
mod parts;
mod pass;
mod pose;
mod rigid_box;
mod scenery;
mod skin;
mod sleep;
mod solver;
mod span;
mod stand;
mod tell;
mod touch;
mod visit;

use super::{Bodies, Constraint, Demand, Share};
use crate::memory::take;
use ball::Ball;
use body::Body;
#[cfg(feature = "alloc")]
pub use compound::{CompoundBuf, CompoundError};
use forms::Forms;
pub use hull::{Hull, HullEdge, HullFace, HullList};
#[cfg(feature = "alloc")]
pub use hull_buf::{HullBuf, HullError};
use kept::{Kept, Sizes};
use manifold::{DIRECTIONS, Manifold, Manifolds};
use order::Order;
pub use rigid_box::RigidBox;
use span::Span;

/// Rigid bodies, each a few particles and a box, a convex hull or several hulls, its pieces: they fly as their particles do, all as one, and touch
/// each other, the scene's colliders and loose balls as such, with friction and elasticity.
///
/// A body has the mass, centre and inertia of its particles, and their momenta; it turns by Euler's equations as
/// [`ShapeMatching`](crate::ShapeMatching) does, and in the end its particles are put where it says. Eight equal particles at 1/√3 of the way to
/// the corners have the inertia of a solid box, those of [`Hull::particles`] that of a solid hull, others that of loaded dice. A body with a
/// fixed particle stays where it is; particles that have died no longer count. Particles of bodies should have no radius, so that no other
/// constraint takes them for balls.
///
/// Where two bodies touch is found by separating axes: face on face by clipping (four points), edge on edge by their nearest points. Against
/// colliders a body's corners count, and for each convex part of the scenery near it the place where an edge or a face comes nearest to that, or is
/// deepest in it, sought from the body's middle; and along a face what is nearest to its corners. A solid that a body's middle has got into may press it
/// out to any side. What rises from the floor under a corner by no more than a four-hundredth of the body's least side is part of
/// it, so that nothing catches on seams. Where it is found to be in scenery that stands still, by no more than a two-hundredth of that side, it
/// is not lifted: what lies across edges is met now at one place, now at another. A loose ball, a particle with a radius that belongs to no
/// body, is met at the place nearest to it; it does not spin, and while it touches a body it meets the scenery by the same impulses. Impulses at
/// these points, with those of the last sub-step to
/// begin with, keep bodies from passing into each other within the sub-step (Macklin et al., "Small Steps in Physics Simulation", SCA 2019;
/// Catto, "Soft Constraints", GDC 2011), then velocities are brought to part as elasticity wants (Müller et al., "Detailed Rigid Body Simulation
/// with Extended Position Based Dynamics", SCA 2020, section 3.6). Friction is Coulomb's. All impulses act on both at one place, so that linear
/// and angular momentum are kept to rounding. Points are gone over until what is left to change is a hundredth of what forces change in a
/// sub-step, eight times at the most.
///
/// Bodies that lie still sleep: they stay where they are, at rest, and cost little; where any scenery may move they look around in each sub-step. One falls asleep when for 5 √(r/a), r being half its size and
/// a what forces accelerate it by, neither it nor any that it touches has gone farther than 4 % of its least half side; who is awake and lies
/// still on one that sleeps finds it fixed. It wakes alone when what presses on it changes by half of that and of its weight, or one that moves
/// comes to lie against it. A blow wakes those around as well: as many contacts away as it is times faster than what forces do in a step, and
/// that times more if it is heavier. All that sleep and touch wake together when forces on one change by a thousandth, when the scenery that one
/// touches or has near it moves, comes or goes, and when what one has lain on goes; all bodies wake when any loses a particle. What creeps more
/// slowly than that stops. Without forces nothing sleeps.
///
/// What is fast is met ahead of time, but a body that turns by more than some 20° in a sub-step may be met too late. There is room for twelve
/// touching pairs a body, six more of pieces for each piece beyond its first, two for each ball and three directions of the scenery. A further one
/// goes with that which is within 26° of it, and else the deepest three count, as do the sixteen nearest parts of the scenery for each piece; what finds no
/// room is counted (`caps.contacts`).
///
/// [`Observer`](crate::Observer)s are told of each blow ([`touched`](crate::Observer::touched)): for a body its first living particle stands,
/// with the mass of the whole and the velocities of the body where it was struck.
///
/// ```
/// use pointmass::constrain::{RigidBodies, RigidBox};
/// use pointmass::shape::Plane;
/// use pointmass::{Gravity, Heap, Particle, Scene, System, Time, Vec3};
///
/// // A solid box of 0.2 m × 0.1 m × 0.1 m and 1 kg, 0.3 m above the ground.
/// let cuboid = RigidBox::new(Vec3::new(0.1, 0.05, 0.05), Vec3::Y * 0.3, 0);
/// let start = cuboid.solid(Particle { mass: 1.0, ..Particle::REST });
/// let bodies = RigidBodies::boxes([cuboid]);
/// let ground = Plane { point: Vec3::ZERO, normal: Vec3::Y };
/// let scene = Scene {
///     start: &start,
///     forces: &Gravity::EARTH,
///     colliders: &ground,
///     constraints: &bodies,
///     substeps: 10,
///     ..Scene::EMPTY
/// };
/// let mut system = System::with(Heap::new(scene.size()));
/// system.start(&scene, 1)?;
/// for frame in 1..=60 {
///     system.step_to(&scene, Time::frame(frame, 60));
/// }
/// let particles = system.particles();
/// let height = particles.position.iter().map(|x| x.y).sum::<f32>() / 8.0;
/// assert!((height - 0.05).abs() < 1e-3 && particles.velocity[0].length() < 1e-3);
/// # Ok::<(), pointmass::InsufficientMemory>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RigidBodies<L, H = ()> {
    /// The bodies.
    pub boxes: L,
    /// The hulls of those that are no boxes ([`RigidBox::hull`]).
    pub hulls: H,
    /// Loose balls that may be near bodies at a time. More fly through them, counted (`caps.contacts`).
    pub balls: u32,
}

impl<L> RigidBodies<L> {
    /// Boxes, which balls fly through.
    pub const fn boxes(boxes: L) -> Self {
        Self { boxes, hulls: (), balls: 0 }
    }
}

impl<L: AsRef<[RigidBox]>, H: HullList> RigidBodies<L, H> {
    /// The first number of any body that cannot be used, and what it has to be.
    #[must_use]
    pub fn fault(&self) -> Option<(&'static str, &'static str)> {
        let hull = |body: &RigidBox| {
            let first = usize::from(body.hull?);
            (first..first + usize::from(body.pieces)).find_map(|number| self.hulls.hull(number)?.fault())
        };
        let boxes = self.boxes.as_ref();
        boxes.iter().find_map(RigidBox::fault).or_else(|| boxes.iter().find_map(hull))
    }

    /// The numbers of them all.
    fn sizes(&self) -> Sizes {
        let boxes = self.boxes.as_ref();
        let particles = boxes.iter().fold(0, |sum: u64, body| sum.wrapping_add(u64::from(body.count)));
        let particles = usize::try_from(particles).unwrap_or(usize::MAX);
        let more =
            boxes.iter().fold(0, |sum: usize, body| sum.saturating_add(usize::from(body.pieces).saturating_sub(1)));
        Sizes { bodies: boxes.len(), particles, balls: self.balls as usize, more }
    }

    fn forms(&self) -> Forms<'_> {
        Forms { boxes: self.boxes.as_ref(), hulls: &self.hulls }
    }

    /// Wakes who sleeps and is about to be touched, or is driven otherwise than when it fell asleep; all others who sleep stay where they are.
    fn stir(&self, bodies: &mut Bodies<'_>, kept: &mut Kept<'_>, span: Span) {
        if kept.lists.awake != 0 {
            sleep::look_out(kept, span);
        }
        if lie::lie(bodies, kept, self.boxes.as_ref()) {
            sleep::rouse(kept.bodies);
            kept.lists.awake = 1;
        }
    }

    /// Moves those that are awake through a sub-step, and lets them do to each other what they do.
    fn solve(&self, bodies: &mut Bodies<'_>, kept: &mut Kept<'_>, memory: &mut [u32], span: Span) {
        members::gather(bodies, kept, self.boxes.as_ref());
        each_ball(bodies, kept, &mut |bodies, _, body, row| body.gather_ball(bodies, row));
        let len = kept.lists.pairs as usize;
        let Kept { bodies: all, pairs, scenery, .. } = kept;
        let mut manifolds = Manifolds { pairs: &mut pairs[..len], scenery };
        let mut order = Order::of(all, &mut manifolds, memory);
        let struck = solver::keep_apart(all, &manifolds, &mut order, span);
        fly::go(all, span.h);
        self.hold_back(bodies, all, span.h);
        solver::part(all, &mut manifolds, &mut order, (struck, span));
        sleep::feel(all, &pairs[..len], order.numbers, span);
        if bodies.substep.is_last() {
            sleep::settle(bodies, kept);
        }
        members::tell(bodies, kept, self.boxes.as_ref());
    }

    /// Stops at the scenery whose middle has gone through that. What consists of several pieces may have its middle in none of them.
    fn hold_back(&self, bodies: &Bodies<'_>, all: &mut [Body], h: f32) {
        for (body, of) in all[1..].iter_mut().zip(self.boxes.as_ref()) {
            if body.goes() && of.pieces <= 1 {
                scenery::hold_back(bodies, body, h);
            }
        }
    }

    /// Does something with each body, and the places of its particles.
    fn each(&self, kept: &mut Kept<'_>, mut visit: impl FnMut(&mut Body, &RigidBox, &mut [u32])) {
        let mut places = &mut *kept.places;
        for (body, of) in kept.bodies[1..].iter_mut().zip(self.boxes.as_ref()) {
            visit(body, of, take(&mut places, 3 * of.count as usize));
        }
    }
}

/// Does something with each ball that is near bodies: its number among them, itself as a body, and its row.
fn each_ball(
    bodies: &mut Bodies<'_>,
    kept: &mut Kept<'_>,
    visit: &mut dyn FnMut(&mut Bodies<'_>, usize, &mut Body, usize),
) {
    let first = kept.first_ball();
    let balls = kept.balls.iter().zip(kept.bodies[first..].iter_mut());
    for (i, (ball, body)) in balls.enumerate() {
        if let Some(row) = Ball::row(ball, bodies) {
            visit(bodies, first + i, body, row);
        }
    }
}

/// Looks where bodies meet the scenery, or will; balls that touch no body leave that to the sweep.
fn meet_scenery(bodies: &mut Bodies<'_>, kept: &mut Kept<'_>, forms: Forms<'_>) {
    let first = kept.first_ball();
    let listed = if kept.balls.is_empty() { 0 } else { kept.lists.pairs as usize };
    for pair in &kept.pairs[..listed] {
        if pair.bodies[1] as usize >= first && pair.count > 0 {
            kept.bodies[pair.bodies[1] as usize].pressed = 1;
        }
    }
    let (slots, may_move) = (kept.scenery.chunks_exact_mut(DIRECTIONS), bodies.colliders.moves());
    for (number, (body, slots)) in kept.bodies[1..].iter_mut().zip(slots).enumerate() {
        let number = number + 1;
        if body.sleeps() {
            continue;
        }
        if body.moves() && (number < first || body.pressed != 0) {
            scenery::meet(bodies, body, forms, (number as u32, may_move), slots);
        } else {
            scenery::clear(body, slots);
        }
    }
}

impl<L: AsRef<[RigidBox]> + Sync, H: HullList> Constraint for RigidBodies<L, H> {
    fn demand(&self) -> Demand {
        if self.is_empty() {
            return Demand::NONE;
        }
        let [kept, scratch] = self.sizes().demand();
        Demand { kept, scratch, finds_near: true, ..Demand::NONE }
    }

    fn is_empty(&self) -> bool {
        self.boxes.as_ref().is_empty()
    }

    fn prepare(&self, bodies: &mut Bodies<'_>, share: &mut Share<'_>) {
        let Sizes { bodies: count, particles, balls, more } = self.sizes();
        let sizes = [count, particles, balls, more];
        share.claim(*b"rigi", &sizes[..if more > 0 { 4 } else { 3 }]);
        let Some(mut kept) = Kept::of(share.kept.fixed, self.sizes()) else { return };
        let mut is_news = false;
        if bodies.substep.number == 0 {
            kept.bodies[0] = Body::world();
            self.each(&mut kept, |body, of, places| is_news |= body.look(bodies, of, places));
            if is_news {
                sleep::wake_all(kept.bodies);
            }
        }
        if bodies.substep.number == 0 || bodies.colliders.moves() {
            sleep::look_around(bodies, &mut kept);
        }
        if lists::gather(bodies, &mut kept, self.forms(), share.scratch, is_news) {
            meet_scenery(bodies, &mut kept, self.forms());
        }
    }

    fn project(&self, bodies: &mut Bodies<'_>, share: &mut Share<'_>) {
        let Some(mut kept) = Kept::of(share.kept.fixed, self.sizes()) else { return };
        let span = Span { h: bodies.substep.seconds(), step: bodies.substep.step.seconds() };
        if !(span.h > 0.0) {
            return;
        }
        let len = kept.lists.pairs as usize;
        self.stir(bodies, &mut kept, span);
        if kept.lists.awake != 0 {
            self.solve(bodies, &mut kept, share.scratch, span);
            tell_balls(bodies, &kept);
            tell::all(bodies, &kept, self.forms(), span);
        }
        if kept.lists.awake != 0 || kept.lists.counted == 0 {
            let count = |all: &[Manifold]| all.iter().filter(|manifold| presses(manifold)).count() as u32;
            let slots = kept.bodies[1..].iter().zip(kept.scenery.chunks_exact(DIRECTIONS));
            let hits = slots.filter(|(body, _)| body.met > 0).map(|(_, slots)| count(slots)).sum();
            kept.lists.presses = [count(&kept.pairs[..len]), hits];
            kept.lists.counted = 1;
        }
        let [contacts, hits] = kept.lists.presses.map(u64::from);
        bodies.report.contacts += contacts;
        bodies.report.hits += hits;
    }
}

/// Tells whether one of two presses on the other.
fn presses(manifold: &Manifold) -> bool {
    manifold.presses != 0 && manifold.count > 0
}

/// Puts balls near bodies where they are now.
fn tell_balls(bodies: &mut Bodies<'_>, kept: &Kept<'_>) {
    let first = kept.first_ball();
    let pressed = |number: usize| {
        let slots = kept.scenery.chunks(DIRECTIONS).nth(number - 1);
        slots.is_some_and(|slots| slots.iter().any(presses))
    };
    for (i, (ball, body)) in kept.balls.iter().zip(&kept.bodies[first..]).enumerate() {
        if let Some(row) = ball.row(bodies) {
            body.tell_ball(bodies, row, pressed(first + i));
        }
    }
}
