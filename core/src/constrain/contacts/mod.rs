//! Heaps: contacts held by moving particles apart, in sub-steps.

mod lists;
mod solver;
mod touch;

use super::{Bodies, Constraint, Demand, Share};
use lists::{KEPT, Kept};
pub(super) use touch::{TangentImpulse, Touch, bounce};

/// Contacts held by position, for heaps of balls: in each sub-step the integrator moves everything, then whatever overlaps is
/// moved apart, with friction and elasticity, and velocities follow. Heaps ask for some 12 sub-steps of 1/60 s
/// ([`Scene::substeps`](crate::Scene::substeps)).
///
/// Friction is Coulomb's: it takes up to the coefficient times the change of velocity by which the contact presses in the
/// sub-step, bounces counted in, whichever the method and however deep the overlap. What it holds at rest on scenery or on
/// something fixed stays where it is, to the bit.
///
/// XPBD with one iteration for each of many small steps (Macklin et al., "Small Steps in Physics Simulation", SCA 2019; Müller
/// et al., "Detailed Rigid Body Simulation with Extended Position Based Dynamics", SCA 2020). A softness in m/N is the same
/// however many sub-steps there are.
///
/// The lower one of two that rest on each other gives way less (Macklin et al., "Unified Particle Physics for Real-Time
/// Applications", SIGGRAPH 2014, section 5.3), so that overlap hardly grows with the height of a heap; momentum is
/// exact for all that meet faster than gravity makes them in a step, and where nothing drives them. In a heap a contact
/// therefore presses by less than the weight above it; friction counts in what is missing, so that a stack slides as
/// far as one ball does and what can rest on others comes to stand still (six on each other, or steps of 1/24 s, ask
/// for 12 sub-steps). Balls do not spin. Hits and contacts of this kind are counted in every sub-step, and
/// [`Observer`](crate::Observer)s are told of each touch once, as it begins ([`touched`](crate::Observer::touched)).
///
/// A bounce gives back the elasticity's share of the speed with which two touched, without what forces have added on the way that they were too close by then: at an
/// elasticity of one a ball keeps its energy however long the sub-steps are (with methods of second order on; those of first order lose some, as on
/// scenery alone).
///
/// Within a sub-step bounces lead to each other, one after the other: what falls on a ball that has just met the floor meets one that comes up, and a row of
/// balls passes a blow on to its end. Each takes no more than it finds, so that what has an elasticity of one keeps its energy, but for
/// some thousandths in crowds and long sub-steps, by the moving apart. A sub-step has room for 64 such rounds; a light ball between two that are ten times as
/// heavy may ask for more, and stops both then, which [`Effort::capped`](crate::Effort) counts. Observers are told of what a contact passes on within a sub-step as of one blow. Who meets faster than rests does is moved aside along what bears it, and not into that.
///
/// Scenery that curves is struck where a particle touches it, along the normal there. It takes the velocity across it where the ball is after the
/// sub-step, if that slides, so that nothing gains by sliding in a bowl (RATTLE: Andersen, J. Comput. Phys. 52, 1983); an edge that is level with
/// the face beside it is part of that.
///
/// Contacts are gone through from the ground up, in the same order whatever index has found them; of more than lists have room for (`caps.contacts`) the
/// nearest count. So bits do not depend on the index.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Contacts {
    /// How far a contact gives way to a force \[m/N\]: zero is hard.
    pub compliance: f32,
}

impl Contacts {
    /// Hard balls.
    pub const HARD: Self = Self { compliance: 0.0 };
}

impl Constraint for Contacts {
    fn demand(&self) -> Demand {
        Demand { step: KEPT, finds_near: true, ..Demand::NONE }
    }

    #[inline(never)]
    fn prepare(&self, bodies: &mut Bodies<'_>, share: &mut Share<'_>) {
        if let Some(mut kept) = Kept::of(share.step, share.capacity) {
            lists::gather(bodies, &mut kept);
        }
    }

    #[inline(never)]
    fn project(&self, bodies: &mut Bodies<'_>, share: &mut Share<'_>) {
        if let Some(mut kept) = Kept::of(share.step, share.capacity).filter(|_| bodies.substep.seconds() > 0.0) {
            solver::project(bodies, &mut kept, self.compliance);
        }
    }

    #[inline(never)]
    fn settle(&self, bodies: &mut Bodies<'_>, share: &mut Share<'_>) {
        if let Some(mut kept) = Kept::of(share.step, share.capacity).filter(|_| bodies.substep.seconds() > 0.0) {
            solver::settle(bodies, &mut kept, self.compliance);
        }
    }
}
