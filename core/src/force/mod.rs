//! Forces that pull and push particles: one file a force.

mod aerodynamics;
mod all_pairs;
mod attributes;
mod charge;
mod curl;
mod cylinder_drag;
mod drag;
mod flow;
mod flow_kind;
mod friction;
mod goal;
mod gravity;
mod inverse_square;
mod kind;
mod mutual;
mod near;
mod needs;
mod penalty;
mod pressure;
mod quadratic;
mod radial;
mod relaxation;
mod sink;
mod spring;
mod spring_force;
mod state;
mod steady;
mod viscosity;
mod watched;
mod wind;

pub use aerodynamics::Aerodynamics;
pub use all_pairs::AllPairs;
pub(crate) use attributes::Attributes;
pub use charge::Coulomb;
pub use curl::Curl;
pub use cylinder_drag::CylinderDrag;
pub use drag::Drag;
pub use flow::{Flow, Gusts, Uniform, Vortex};
pub use flow_kind::FlowKind;
pub use friction::Friction;
pub use goal::Goal;
pub use gravity::Gravity;
pub use kind::ForceKind;
pub use mutual::MutualGravity;
pub use needs::{BuildTrees, Listing, Needs, Telling, Writing};
pub(crate) use needs::{Finder, Told, Written};
pub use penalty::Penalty;
pub use pressure::Pressure;
pub use quadratic::QuadraticDrag;
pub use radial::{LennardJones, Pair, PowerLaw, Radial, RadialLaw, Run, Weight};
pub use relaxation::Relaxation;
pub use sink::Sink;
pub(crate) use spring::is_broken;
pub use spring::{Drive, Held, Spring, Springs};
pub(crate) use spring_force::SpringForce;
pub use spring_force::{SpringCode, SpringList};
pub(crate) use state::Backdrop;
pub use state::State;
pub use steady::Steady;
pub(crate) use steady::{Ends, Inertia};
pub use viscosity::Viscosity;
pub use watched::Watched;
pub use wind::Wind;

use crate::composed::{composed, each, stands_for};
use crate::custom::CustomColumnsMut;
use core::ops::Range;
use glam::Vec3;

/// A force field or an interaction.
///
/// A tuple, slice, option, reference or box of forces is a force: their sum.
///
/// ```
/// use core::ops::Range;
/// use pointmass::force::State;
/// use pointmass::{Force, Gravity, Heap, Particle, Scene, System, Time, Vec3};
///
/// /// Pulls all toward the y axis, 3 N for each metre.
/// struct Rail;
///
/// impl Force for Rail {
///     fn add_to(&self, state: &State<'_>, rows: Range<usize>, total: &mut [Vec3]) {
///         for (total, x) in total.iter_mut().zip(&state.position[rows]) {
///             *total -= Vec3::new(x.x, 0.0, x.z) * 3.0;
///         }
///     }
/// }
///
/// let start = [Particle { position: Vec3::X, ..Particle::REST }];
/// let scene = Scene { start: &start, forces: &(Gravity::EARTH, Rail), ..Scene::EMPTY };
/// let mut system = System::with(Heap::new(scene.size()));
/// system.start(&scene, 1)?;
/// system.step(&scene, Time::from_seconds(0.125));
/// assert!(system.particles().velocity[0].x < -0.3);
/// # Ok::<(), pointmass::InsufficientMemory>(())
/// ```
pub trait Force: Sync {
    /// Adds the force \[N\] on each particle of `rows` to `total`, whose first entry is that of the first row.
    ///
    /// Rows are independent of each other, so that any division of the work gives the same bits. Roots are the same on all machines;
    /// other functions are where they come from [`math`](crate::math), and not from `std`.
    fn add_to(&self, state: &State<'_>, rows: Range<usize>, total: &mut [Vec3]);

    /// The parts of the state that it has to find there; by default neither neighbours nor trees.
    fn needs(&self) -> Needs {
        Needs::default()
    }

    /// Tells whether the force on a particle depends on nothing but its own row and the time. By default it says no, which is always
    /// right; yes is for speed. A step then takes a few
    /// rows at a time through all its phases, while they are in the cache; the state has no other rows in it. After a hit it is asked
    /// again, for that row alone, so that what brakes a particle does so at its new velocity; nobody counts that.
    fn is_local(&self) -> bool {
        false
    }

    /// Tells whether it goes by where particles are, or how fast they go. By default it says yes, which is always right; no spares methods what they do
    /// for whom constraints hold ([`Integrator::lead`](crate::Integrator::lead)).
    fn depends_on_motion(&self) -> bool {
        true
    }

    /// The force as a steady acceleration and each particle's own drag, if it comes to no more than that: a step then
    /// works it out in one pass over the columns, to the bits of `add_to`. Chips without an operating system do not
    /// ask.
    fn steady(&self) -> Option<Steady> {
        None
    }

    /// Changes columns of a user's own if it [needs](Needs::write) to, once in each step of `dt` \[s\], when all have moved and
    /// been held against colliders and before anybody is taken out: what burns or cools. The state is that at the step's end; its
    /// own columns of that kind are empty, as `custom` has them. Who was [`born`](State::born) within the step has lived through a part of
    /// it. Of several forces each sees what those before it have written. Where the scene has no such columns nobody is asked.
    fn write(&self, state: &State<'_>, custom: &mut CustomColumnsMut<'_>, dt: f32) {
        let _ = (state, custom, dt);
    }

    /// Tells whoever watches of those who have come to touch in a sub-step, if it [needs](Needs::tell) to: at the end of each, when all have moved and
    /// been held against colliders. Where nobody watches, it is not asked.
    fn tell(&self, watched: &mut Watched<'_>) {
        let _ = watched;
    }

    /// Adds how the force on each particle changes as they move: (∂f/∂x) δx + (∂f/∂v) δv \[N\], for methods that solve for
    /// the state at a step's end. All rows at once.
    ///
    /// It has to be symmetric and must not push what is displaced any farther (negative semidefinite). Nobody checks that: whoever writes
    /// it leaves out the parts that are not so, and all of it for a force across the way, such as a swirl. A force without one, as by default, is
    /// taken as constant over each of the solver's steps.
    fn add_jacobian(&self, state: &State<'_>, change: &Perturbation<'_>, total: &mut [Vec3]) {
        let _ = (state, change, total);
    }

    /// Adds the diagonal of −(`weights[0]` ∂f/∂x + `weights[1]` ∂f/∂v), by row: what the solver is preconditioned with. Any
    /// numbers of zero and more will do; good ones save iterations.
    fn add_stiffness(&self, state: &State<'_>, weights: [f32; 2], total: &mut [Vec3]) {
        let _ = (state, weights, total);
    }

    /// Potential energy \[J\]; zero for forces that have none. For reports: in double precision, and so with the
    /// feature `std` only, since a chip without such hardware would carry its emulation about for nothing.
    #[cfg(feature = "std")]
    fn energy(&self, state: &State<'_>) -> f64 {
        let _ = state;
        0.0
    }

    /// The power \[W\] that it brings into kinetic and its own potential energy taken together: below zero for what slows
    /// things down. Zero by default, which is right for a force that is the slope of its [`energy`](Self::energy). A force without one
    /// has to return the sum of F·v; where it does not, its work turns up in the ledger's remainder.
    #[cfg(feature = "std")]
    fn power(&self, state: &State<'_>) -> f64 {
        let _ = state;
        0.0
    }

    /// Its name in reports, by which forces are told apart there; by default "force".
    #[cfg(feature = "std")]
    fn name(&self) -> &'static str {
        "force"
    }

    /// Visits every part with its name, energy and power.
    #[cfg(feature = "std")]
    fn account(&self, state: &State<'_>, visit: &mut dyn FnMut(Entry)) {
        visit(Entry { name: self.name(), energy: self.energy(state), power: self.power(state) });
    }
}

/// A force in the accounts.
#[cfg(feature = "std")]
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Entry {
    /// Its name.
    pub name: &'static str,
    /// Its potential energy \[J\].
    pub energy: f64,
    /// The power \[W\] that it brings into the system.
    pub power: f64,
}

/// A small change of the particles: δx = `position` × `along`, δv = `velocity` × `along`.
#[derive(Clone, Copy, Debug)]
pub struct Perturbation<'a> {
    /// A vector a row.
    pub along: &'a [Vec3],
    /// How far positions go along it.
    pub position: f32,
    /// How far velocities go along it.
    pub velocity: f32,
}

impl Force for () {
    fn add_to(&self, _: &State<'_>, _: Range<usize>, _: &mut [Vec3]) {}
    fn is_local(&self) -> bool {
        true
    }
    fn depends_on_motion(&self) -> bool {
        false
    }
    #[cfg(not(target_os = "none"))]
    fn steady(&self) -> Option<Steady> {
        Some(Steady::default())
    }
    #[cfg(feature = "std")]
    fn account(&self, _: &State<'_>, _: &mut dyn FnMut(Entry)) {}
}

/// The methods of a force that has parts and is their sum.
macro_rules! sum_of {
    ($parts:tt) => {
        fn add_to(&self, state: &State<'_>, rows: Range<usize>, total: &mut [Vec3]) {
            each!(self, $parts, part => {
                part.add_to(state, rows.clone(), total);
            });
        }
        fn write(&self, state: &State<'_>, custom: &mut CustomColumnsMut<'_>, dt: f32) {
            each!(self, $parts, part => {
                part.write(state, custom, dt);
            });
        }
        fn tell(&self, watched: &mut Watched<'_>) {
            each!(self, $parts, part => {
                part.tell(watched);
            });
        }
        fn add_jacobian(&self, state: &State<'_>, change: &Perturbation<'_>, total: &mut [Vec3]) {
            each!(self, $parts, part => {
                part.add_jacobian(state, change, total);
            });
        }
        fn add_stiffness(&self, state: &State<'_>, weights: [f32; 2], total: &mut [Vec3]) {
            each!(self, $parts, part => {
                part.add_stiffness(state, weights, total);
            });
        }
        fn needs(&self) -> Needs {
            let mut needs = Needs::default();
            each!(self, $parts, part => {
                needs = needs.and(part.needs());
            });
            needs
        }
        fn depends_on_motion(&self) -> bool {
            each!(self, $parts, part => {
                if part.depends_on_motion() {
                    return true;
                }
            });
            false
        }
        fn is_local(&self) -> bool {
            each!(self, $parts, part => {
                if !part.is_local() {
                    return false;
                }
            });
            true
        }
        #[cfg(not(target_os = "none"))]
        fn steady(&self) -> Option<Steady> {
            let mut all = Steady::default();
            each!(self, $parts, part => {
                all = all.and(part.steady()?)?;
            });
            Some(all)
        }
        #[cfg(feature = "std")]
        fn energy(&self, state: &State<'_>) -> f64 {
            let mut sum = 0.0;
            each!(self, $parts, part => {
                sum += part.energy(state);
            });
            sum
        }
        #[cfg(feature = "std")]
        fn power(&self, state: &State<'_>) -> f64 {
            let mut sum = 0.0;
            each!(self, $parts, part => {
                sum += part.power(state);
            });
            sum
        }
        #[cfg(feature = "std")]
        fn account(&self, state: &State<'_>, visit: &mut dyn FnMut(Entry)) {
            each!(self, $parts, part => {
                part.account(state, visit);
            });
        }
    };
}

/// The methods of a force that stands for another force.
macro_rules! same_as {
    ($this:ident => $force:expr) => {
        fn add_to(&self, state: &State<'_>, rows: Range<usize>, total: &mut [Vec3]) {
            let $this = self;
            $force.add_to(state, rows, total);
        }
        fn needs(&self) -> Needs {
            let $this = self;
            $force.needs()
        }
        fn is_local(&self) -> bool {
            let $this = self;
            $force.is_local()
        }
        fn depends_on_motion(&self) -> bool {
            let $this = self;
            $force.depends_on_motion()
        }
        #[cfg(not(target_os = "none"))]
        fn steady(&self) -> Option<$crate::force::Steady> {
            let $this = self;
            $force.steady()
        }
        fn write(&self, state: &State<'_>, custom: &mut CustomColumnsMut<'_>, dt: f32) {
            let $this = self;
            $force.write(state, custom, dt);
        }
        fn tell(&self, watched: &mut $crate::force::Watched<'_>) {
            let $this = self;
            $force.tell(watched);
        }
        fn add_jacobian(&self, state: &State<'_>, change: &Perturbation<'_>, total: &mut [Vec3]) {
            let $this = self;
            $force.add_jacobian(state, change, total);
        }
        fn add_stiffness(&self, state: &State<'_>, weights: [f32; 2], total: &mut [Vec3]) {
            let $this = self;
            $force.add_stiffness(state, weights, total);
        }
        #[cfg(feature = "std")]
        fn energy(&self, state: &State<'_>) -> f64 {
            let $this = self;
            $force.energy(state)
        }
        #[cfg(feature = "std")]
        fn power(&self, state: &State<'_>) -> f64 {
            let $this = self;
            $force.power(state)
        }
        #[cfg(feature = "std")]
        fn name(&self) -> &'static str {
            let $this = self;
            $force.name()
        }
        #[cfg(feature = "std")]
        fn account(&self, state: &State<'_>, visit: &mut dyn FnMut(Entry)) {
            let $this = self;
            $force.account(state, visit);
        }
    };
}

use same_as;

stands_for! {
    Force {
        same_as!(this => **this);
    }
}

composed!(Force by sum_of);
