//! Constraints that bind particles together and keep them apart: the trait, one file a constraint.
//!
//! A step is cut into sub-steps ([`Scene::substeps`](crate::Scene::substeps)). In each the method moves everything by the
//! forces, then constraints move positions to where they are met, by few at a time, with velocities following: extended
//! position-based dynamics with one iteration for each of many small steps (Macklin, Müller and Chentanez, "XPBD",
//! MIG 2016; Macklin et al., "Small Steps in Physics Simulation", SCA 2019).

mod attach;
mod bearing;
mod bisect;
mod bodies;
mod budget;
mod contacts;
#[cfg(feature = "alloc")]
mod declared;
mod distance;
mod inertia;
#[cfg(feature = "alloc")]
mod kind;
mod lead;
mod load;
mod moved;
mod rate;
mod rigid;
mod rope;
mod shape_matching;
mod sheet_contacts;
mod shell;
mod strain_limits;
mod strand;
mod thread;
mod tie;
mod turn;
mod union;
mod walls;
mod whole;

pub use attach::Attach;
pub use bodies::{Around, Bodies, Near, Share, Substep};
pub(crate) use bodies::{CARRIED, DONE, SHIFTED, TOUCHING};
pub use contacts::Contacts;
pub use distance::Distance;
#[cfg(feature = "alloc")]
pub use kind::ConstraintKind;
pub(crate) use moved::{Moment, Moved};
#[cfg(feature = "alloc")]
pub use rigid::{CompoundBuf, CompoundError, HullBuf, HullError};
pub use rigid::{Hull, HullEdge, HullFace, HullList, RigidBodies, RigidBox};
pub use rope::Rope;
pub use shape_matching::ShapeMatching;
pub use sheet_contacts::SheetContacts;
pub use shell::{Shell, ShellParams};
pub use strain_limits::{StrainLimitParams, StrainLimits};
pub use strand::{StrandParams, Strands};
pub use tie::{Tie, TiedRope};
#[cfg(feature = "alloc")]
pub(crate) use union::{root, unite};

pub use crate::cloth::Hinge;
#[cfg(feature = "alloc")]
pub use crate::cloth::mesh_hinges;
pub use crate::memory::{Demand, Kept, Words};

use crate::composed::{composed, each, stands_for};
use crate::observe::Phase;

/// Something that the places and velocities of particles have to satisfy.
///
/// A tuple, slice, option, reference or box of constraints is a constraint: all of them, one after the other in each phase. Every
/// constraint sees what those before it have done.
///
/// Newborns come under it in the step after that of their birth. Colliders act at the end of each sub-step: what they stop
/// may be off the constraint, and has the velocity that they leave it, until the next. (Shells and contacts of sheets meet the scenery by
/// themselves.)
///
/// Whatever goes to the nearest place that satisfies it takes energy out of the motion, the less the shorter the sub-steps. To keep it, go
/// back along the direction of the sub-step's beginning ([`Bodies::before`]), take what violates the constraint out of velocities in
/// [`settle`](Constraint::settle), and use `Verlet` (RATTLE); the example `own_constraint` does so.
///
/// ```
/// use pointmass::constrain::{Bodies, Share};
/// use pointmass::{Constraint, Gravity, Heap, Particle, Scene, System, Time, Vec3};
///
/// /// Keeps all on the plane z = 0.
/// struct Flat;
///
/// impl Constraint for Flat {
///     fn project(&self, bodies: &mut Bodies<'_>, _: &mut Share<'_>) {
///         for row in 0..bodies.len() {
///             // Velocities follow what is shifted.
///             bodies.shift(row, Vec3::NEG_Z * bodies.position[row].z);
///         }
///     }
/// }
///
/// let start = [Particle { velocity: Vec3::new(1.0, 0.0, 5.0), ..Particle::REST }];
/// let scene = Scene { start: &start, forces: &Gravity::EARTH, constraints: &Flat, substeps: 4, ..Scene::EMPTY };
/// let mut system = System::with(Heap::new(scene.size()));
/// system.start(&scene, 1)?;
/// system.step(&scene, Time::frame(1, 60));
/// assert!(system.particles().position[0].z == 0.0 && system.particles().velocity[0].z.abs() < 1e-6);
/// # Ok::<(), pointmass::InsufficientMemory>(())
/// ```
pub trait Constraint: Sync {
    /// The memory it works in; by default none.
    fn demand(&self) -> Demand {
        Demand::NONE
    }

    /// Tells whether it constrains nothing, which by default it denies: a scene of such constraints keeps no memory for them.
    fn is_empty(&self) -> bool {
        false
    }

    /// The function that a step calls to have it met; none, where it is known that it constrains nothing. The default is right for all others.
    fn code(&self) -> Option<ConstraintCode> {
        Some(ConstraintCode::ALL)
    }

    /// Says at a step's beginning, before any constraint looks on, which particles it holds in their places to each other ([`Bodies::bind`]): others
    /// leave those alone. It is called if anybody [demands](Demand::binds) so.
    fn bind(&self, bodies: &mut Bodies<'_>) {
        let _ = bodies;
    }

    /// Looks on before the method moves everything through a sub-step: to list who may touch whom, for instance.
    fn prepare(&self, bodies: &mut Bodies<'_>, share: &mut Share<'_>) {
        let _ = (bodies, share);
    }

    /// Looks on when the method has moved everything, before any constraint moves anybody: to take back what the method does beyond where velocities
    /// lead, for instance.
    fn begin(&self, bodies: &mut Bodies<'_>, share: &mut Share<'_>) {
        let _ = (bodies, share);
    }

    /// Moves particles to where they satisfy it, when the method has moved them: by [`Bodies::shift`], so that their
    /// velocities follow.
    fn project(&self, bodies: &mut Bodies<'_>, share: &mut Share<'_>);

    /// Tells whether it may be [asked again](Constraint::project_again), as members of lists are; those of tuples are asked once.
    fn repeats(&self) -> bool {
        false
    }

    /// Moves particles again, if others have since moved them from where they satisfy it, and tells whether it has. In a list those that repeat and come
    /// one after the other are asked by turns until nobody has moved anything, or some times at the most: what is left shows in the next sub-step.
    fn project_again(&self, bodies: &mut Bodies<'_>, share: &mut Share<'_>) -> bool {
        let _ = (bodies, share);
        false
    }

    /// Changes velocities at a sub-step's end, when all have been projected: restitution, friction, viscosity.
    fn settle(&self, bodies: &mut Bodies<'_>, share: &mut Share<'_>) {
        let _ = (bodies, share);
    }
}

/// The function that constraints call for in a step. A program without constraints does not carry it about.
#[derive(Clone, Copy, Debug)]
pub struct ConstraintCode(pub(crate) fn(&dyn Constraint, &mut Moved<'_>, Moment, Substep));

impl ConstraintCode {
    /// All of it.
    pub const ALL: Self = Self(constrain);
}

/// Lets constraints move what the method has moved, or look on before, and says how far that has come.
fn constrain(constraints: &dyn Constraint, moved: &mut Moved<'_>, moment: Moment, substep: Substep) {
    let ([_, end], mut all_pairs) = (substep.during, 0);
    match moment {
        Moment::Before => {
            let (mut bodies, mut share) = moved.lend(substep, &mut all_pairs);
            if substep.number == 0 && !bodies.bound.is_empty() {
                bodies.bound.fill(0);
                constraints.bind(&mut bodies);
            }
            bodies.loads.fill(bytemuck::Zeroable::zeroed());
            constraints.prepare(&mut bodies, &mut share);
            moved.lead();
        }
        Moment::After => {
            moved.take_back_lead(substep.seconds());
            moved.tell(Phase::Advance, end);
            moved.tell(Phase::Project, end);
            let (mut bodies, mut share) = moved.lend(substep, &mut all_pairs);
            bodies.postponed.fill(glam::Vec3::ZERO);
            constraints.begin(&mut bodies, &mut share);
            constraints.project(&mut bodies, &mut share);
            constraints.settle(&mut bodies, &mut share);
            moved.keep_lead();
            moved.tell(Phase::Constrain, end);
        }
    }
    moved.report.effort.all_pairs += all_pairs;
}

impl Constraint for () {
    fn is_empty(&self) -> bool {
        true
    }
    fn code(&self) -> Option<ConstraintCode> {
        None
    }
    fn project(&self, _: &mut Bodies<'_>, _: &mut Share<'_>) {}
}

stands_for! {
    Constraint {
        fn demand(&self) -> Demand {
            (**self).demand()
        }
        fn is_empty(&self) -> bool {
            (**self).is_empty()
        }
        fn code(&self) -> Option<ConstraintCode> {
            (**self).code()
        }
        fn bind(&self, bodies: &mut Bodies<'_>) {
            (**self).bind(bodies);
        }
        fn prepare(&self, bodies: &mut Bodies<'_>, share: &mut Share<'_>) {
            (**self).prepare(bodies, share);
        }
        fn begin(&self, bodies: &mut Bodies<'_>, share: &mut Share<'_>) {
            (**self).begin(bodies, share);
        }
        fn project(&self, bodies: &mut Bodies<'_>, share: &mut Share<'_>) {
            (**self).project(bodies, share);
        }
        fn repeats(&self) -> bool {
            (**self).repeats()
        }
        fn project_again(&self, bodies: &mut Bodies<'_>, share: &mut Share<'_>) -> bool {
            (**self).project_again(bodies, share)
        }
        fn settle(&self, bodies: &mut Bodies<'_>, share: &mut Share<'_>) {
            (**self).settle(bodies, share);
        }
    }
}

/// Constraints of a list that repeat are asked again so many times at the most.
const AGAIN: u32 = 63;

/// Projects a list, one after the other; those that repeat until nobody has moved anything, before one comes that does not.
fn project_list<'c, T: Constraint + 'c>(
    list: impl Iterator<Item = &'c T> + Clone,
    bodies: &mut Bodies<'_>,
    share: &mut Share<'_>,
) {
    let (mut next, mut is_done) = (0, false);
    while !is_done {
        let (mut shares, mut run) = (share.parts(), next..next);
        is_done = true;
        for (number, part) in list.clone().enumerate() {
            let mut own = shares.next(part.demand());
            if number < next {
                continue;
            }
            if !part.repeats() {
                if run.len() > 1 {
                    is_done = false;
                    break;
                }
                run.start = number + 1;
            }
            part.project(bodies, &mut own);
            (next, run.end) = (number + 1, number + 1);
        }
        project_again(list.clone(), run, bodies, share);
    }
}

/// Asks those of a list with such numbers again, until nobody has moved anything.
fn project_again<'c, T: Constraint + 'c>(
    list: impl Iterator<Item = &'c T> + Clone,
    run: core::ops::Range<usize>,
    bodies: &mut Bodies<'_>,
    share: &mut Share<'_>,
) {
    let mut is_any = run.len() > 1;
    for _ in 0..AGAIN {
        if !is_any {
            return;
        }
        is_any = false;
        let mut shares = share.parts();
        for (number, part) in list.clone().enumerate().take(run.end) {
            let mut own = shares.next(part.demand());
            is_any |= run.contains(&number) && part.project_again(bodies, &mut own);
        }
    }
    bodies.report.effort.capped += u64::from(is_any);
}

/// The methods of a constraint that has parts: it does what they do, each in its own share of the memory.
macro_rules! all_of {
    ($parts:tt) => {
        fn demand(&self) -> Demand {
            let mut sum = Demand::NONE;
            each!(self, $parts, part => {
                sum = sum.and(part.demand());
            });
            sum
        }
        fn is_empty(&self) -> bool {
            each!(self, $parts, part => {
                if !part.is_empty() {
                    return false;
                }
            });
            true
        }
        fn bind(&self, bodies: &mut Bodies<'_>) {
            each!(self, $parts, part => {
                part.bind(bodies);
            });
        }
        all_of!(@phase prepare, $parts);
        all_of!(@phase begin, $parts);
        all_of!(@project $parts);
        all_of!(@phase settle, $parts);
    };
    (@project []) => {
        fn project(&self, bodies: &mut Bodies<'_>, share: &mut Share<'_>) {
            project_list(self.iter(), bodies, share);
        }
    };
    (@project $parts:tt) => {
        all_of!(@phase project, $parts);
    };
    (@phase $phase:ident, $parts:tt) => {
        fn $phase(&self, bodies: &mut Bodies<'_>, share: &mut Share<'_>) {
            let mut shares = share.parts();
            each!(self, $parts, part => {
                part.$phase(bodies, &mut shares.next(part.demand()));
            });
        }
    };
}

composed!(Constraint by all_of);
