//! Newton's second law, stepped through time: one file a method.
//!
//! | method | order | evaluations a step | energy of an undamped oscillation | choose it for |
//! |---|---|---|---|---|
//! | [`Euler`] | 1 | 1 | grows at any step | comparison alone |
//! | [`Symplectic`] | 1 | 1 | stays bounded for h ω ≤ 2 | effects with many particles |
//! | [`Midpoint`] | 2 | 2 | grows at any step, slowly | smooth motion, cheaply |
//! | [`LectureMidpoint`] | 1 or 2 | 2 | grows at any step, slowly | comparison alone |
//! | [`Verlet`] | 2 | 2 | stays bounded for h ω ≤ 2 | orbits and undamped springs over long times |
//! | [`Rk4`] | 4 | 4 | falls slightly for h ω ≤ 2√2 | accuracy; forces across the velocity |
//! | [`Adaptive`] | of the method inside | three times its | as inside | what is calm for long and wild at times |
//! | [`Embedded`] | 3 | 3, in steps of its own | within its tolerance | smooth forces, where nobody knows the step |
//! | [`Implicit`] | 1 | 1 a Newton step, and products with Jacobians | falls at any step | what is stiff and may look soft |
//!
//! With a force across the velocity (magnetic, Coriolis) both Euler methods and `Verlet` gain energy: take `Rk4` there.

mod adaptive;
mod drift;
mod embedded;
mod euler;
mod field;
mod implicit;
mod midpoint;
mod named;
mod rk4;
mod verlet;

pub use adaptive::Adaptive;
pub use drift::Drift;
pub use embedded::Embedded;
pub use euler::{Euler, Symplectic};
pub(crate) use field::Field;
pub use implicit::Implicit;
pub use midpoint::{LectureMidpoint, Midpoint};
pub use named::{Method, Tuned, Tuning, UnknownMethod};
pub use rk4::Rk4;
pub use verlet::Verlet;

use crate::composed::stands_for;
use crate::force::{Finder, Force, Perturbation, SpringForce, State};
use crate::math::{largest, max};
use crate::report::Effort;
pub(crate) use crate::rows::{add_scaled, advance_by};
use crate::time::Time;
use glam::Vec3;

/// All that an integrator may ask of the world.
pub trait Dynamics {
    /// The acceleration \[m/s²\] of every particle at `time`, were they at `position` with `velocity`.
    ///
    /// All slices are equally long. Costs one evaluation of all forces.
    fn accelerations(&mut self, time: Time, position: &[Vec3], velocity: &[Vec3], acceleration: &mut [Vec3]);

    /// Calls `then` with the forces about a state, to be asked how they change near it.
    fn linearise(&mut self, time: Time, position: &[Vec3], velocity: &[Vec3], then: &mut dyn FnMut(&Linear<'_>));

    /// Says that a method which divides the step has come so far: for those who watch.
    fn reached(&mut self, time: Time, position: &[Vec3], velocity: &[Vec3]) {
        let _ = (time, position, velocity);
    }
}

/// The forces about a state.
pub struct Linear<'a> {
    /// All of them: the scene's, and that of its springs.
    pub forces: [&'a dyn Force; 2],
    /// The state.
    pub state: State<'a>,
    /// Inverse masses \[1/kg\], by row; zero for what is fixed.
    pub inverse_mass: &'a [f32],
}

impl<'a> Linear<'a> {
    /// Those about a state.
    #[cfg_attr(one_by_one, inline(never))]
    pub(crate) fn about(state: &State<'a>, forces: [&'a dyn Force; 2], inverse_mass: &'a [f32]) -> Self {
        Self { forces, state: *state, inverse_mass }
    }

    /// The force on every particle \[N\]. Entries of `total` beyond the particles are zero, here as in what follows.
    pub fn force(&self, total: &mut [Vec3]) {
        let total = self.cleared(total);
        self.forces.iter().for_each(|part| part.add_to(&self.state, 0..total.len(), total));
    }

    /// How it changes with the state \[N\]: [`Force::add_jacobian`].
    pub fn jacobian(&self, change: &Perturbation<'_>, total: &mut [Vec3]) {
        let total = self.cleared(total);
        self.forces.iter().for_each(|part| part.add_jacobian(&self.state, change, total));
    }

    /// The diagonal of that, its sign turned round: [`Force::add_stiffness`].
    pub fn stiffness(&self, weights: [f32; 2], total: &mut [Vec3]) {
        let total = self.cleared(total);
        self.forces.iter().for_each(|part| part.add_stiffness(&self.state, weights, total));
    }

    /// As many zeros as there are particles, of those that there is room for.
    fn cleared<'t>(&self, total: &'t mut [Vec3]) -> &'t mut [Vec3] {
        total.fill(Vec3::ZERO);
        let len = total.len().min(self.inverse_mass.len());
        &mut total[..len]
    }
}

/// Makes linear systems of a scene's forces. A function, so that a program without a method that asks for them does not carry it about.
#[derive(Clone, Copy, Debug)]
pub struct Linearising(pub(crate) Linearise);

type Linearise = fn(&mut Finder<'_>, &dyn Force, Option<SpringForce>, Now<'_>, &mut dyn FnMut(&Linear<'_>));

/// Where all are at an instant, and how fast.
pub(crate) struct Now<'a> {
    pub(crate) time: Time,
    pub(crate) position: &'a [Vec3],
    pub(crate) velocity: &'a [Vec3],
}

impl Linearising {
    /// Of all forces, springs included.
    pub const FORCES: Self = Self(linearise);
}

fn linearise(
    finder: &mut Finder<'_>,
    forces: &dyn Force,
    springs: Option<SpringForce>,
    Now { time, position, velocity }: Now<'_>,
    then: &mut dyn FnMut(&Linear<'_>),
) {
    let inverse_mass = &finder.attributes.inverse_mass[..position.len()];
    finder.with_state(time, position, velocity, &mut |state| {
        let springs: &dyn Force = springs.map_or(&(), |force| force(&state.springs));
        then(&Linear::about(state, [forces, springs], inverse_mass));
    });
}

/// A method to solve the equations of motion. It keeps no state of its own.
///
/// ```
/// use pointmass::integrate::{Dynamics, Motion};
/// use pointmass::{Gravity, Heap, Integrator, Particle, Scene, System, Time};
///
/// /// Kicks, then drifts.
/// struct Kick;
///
/// impl Integrator for Kick {
///     fn columns(&self) -> usize {
///         1
///     }
///     fn advance(&self, motion: Motion<'_>, time: Time, step: Time, world: &mut dyn Dynamics) {
///         let Motion { position, velocity, work, .. } = motion;
///         let [acceleration] = work.take();
///         world.accelerations(time, position, velocity, acceleration);
///         for ((x, v), &a) in position.iter_mut().zip(velocity).zip(&*acceleration) {
///             *v += a * step.seconds();
///             *x += *v * step.seconds();
///         }
///     }
/// }
///
/// let scene = Scene { start: &[Particle::REST], forces: &Gravity::EARTH, integrator: &Kick, ..Scene::EMPTY };
/// let mut system = System::with(Heap::new(scene.size()));
/// system.start(&scene, 1)?;
/// system.step(&scene, Time::from_seconds(0.5));
/// assert!((system.particles().velocity[0].y + 4.903).abs() < 1e-3);
/// # Ok::<(), pointmass::InsufficientMemory>(())
/// ```
pub trait Integrator: Sync {
    /// Vectors it needs to work with for each particle.
    fn columns(&self) -> usize;

    /// Tells whether it needs `Motion::start`, the state at the step's beginning.
    fn needs_start(&self) -> bool {
        false
    }

    /// Tells whether it moves each particle by what is in its own row, so that rows may be moved a few at a time.
    fn is_local(&self) -> bool {
        false
    }

    /// The Euler method that it is, if it is one: under forces that one pass over the columns can work out, that pass then moves
    /// everything, to the bits of [`advance`](Self::advance).
    fn drift(&self) -> Option<Drift> {
        None
    }

    /// The share of a step at which it takes the forces that go by velocities: 0 as the step begins, 1 as it ends, and ½ on an average of both. Who is
    /// held by constraints begins each sub-step so much slower by what these have taken of his velocity in the one before, so that forces act as on
    /// whoever stays. A scene with constraints keeps three words more of each particle where this is above zero.
    fn lead(&self) -> f32 {
        0.0
    }

    /// The function behind [`Dynamics::linearise`], which a method that never asks for it need not hand out: without it, nothing is
    /// linearised, and a chip is spared the code.
    fn linearising(&self) -> Option<Linearising> {
        Some(Linearising::FORCES)
    }

    /// Moves everything from `time` to `time` + `step`.
    fn advance(&self, motion: Motion<'_>, time: Time, step: Time, world: &mut dyn Dynamics);
}

/// The state that an integrator moves. All slices are equally long.
#[derive(Debug)]
pub struct Motion<'a> {
    /// Positions \[m\].
    pub position: &'a mut [Vec3],
    /// Velocities \[m/s\].
    pub velocity: &'a mut [Vec3],
    /// Positions and velocities at the beginning of the step; empty unless the integrator asked for them.
    pub start: [&'a [Vec3]; 2],
    /// Columns to work with.
    pub work: Work<'a>,
    /// The step that a method which chooses its own would begin with; zero: it has to find one. The system keeps it from
    /// step to step, and drops it where something was hit, was born or died.
    pub hint: &'a mut Time,
    /// The counters of the method.
    pub effort: &'a mut Effort,
}

/// Columns of vectors to work with, one for each particle.
#[derive(Debug)]
pub struct Work<'a> {
    pub(crate) memory: &'a mut [Vec3],
    pub(crate) stride: usize,
    pub(crate) len: usize,
}

impl<'a> Work<'a> {
    /// The first `N` columns; what they hold is left over from earlier use. Columns that do not exist are empty.
    #[must_use]
    pub fn take<const N: usize>(self) -> [&'a mut [Vec3]; N] {
        self.split().0
    }

    /// The first `N` columns and the others, for a method that another is built on.
    #[must_use]
    pub fn split<const N: usize>(self) -> ([&'a mut [Vec3]; N], Self) {
        let Self { mut memory, stride, len } = self;
        let columns = core::array::from_fn(|_| {
            let (column, rest) = core::mem::take(&mut memory).split_at_mut_checked(stride).unwrap_or_default();
            memory = rest;
            column.get_mut(..len).unwrap_or_default()
        });
        (columns, Self { memory, stride, len })
    }

    /// The same columns, lent on.
    #[must_use]
    pub fn again(&mut self) -> Work<'_> {
        Work { memory: self.memory, stride: self.stride, len: self.len }
    }
}

stands_for! {
    Integrator {
        fn columns(&self) -> usize {
            (**self).columns()
        }
        fn needs_start(&self) -> bool {
            (**self).needs_start()
        }
        fn is_local(&self) -> bool {
            (**self).is_local()
        }
        fn drift(&self) -> Option<Drift> {
            (**self).drift()
        }
        fn lead(&self) -> f32 {
            (**self).lead()
        }
        fn advance(&self, motion: Motion<'_>, time: Time, step: Time, world: &mut dyn Dynamics) {
            (**self).advance(motion, time, step, world);
        }
    }
}

/// The shortest step that leads on.
const TICK: Time = Time::from_ticks(1);

/// A step of `h`, or all that is `left` where that is not noticeably more: no step is made of rounding.
fn cut(h: Time, left: Time) -> Time {
    if left - h <= Time::from_ticks(h.ticks() >> 8) { left } else { h }
}

/// The largest difference of two states \[m\]: of positions, and of velocities times the step, as far as it is more than
/// rounding. What flies beyond all numbers in both alike does not differ; what is undefined differs infinitely. Rows that
/// are not `sound` are left out.
fn difference([xa, va]: [&[Vec3]; 2], [xb, vb]: [&[Vec3]; 2], h: f32, sound: impl Fn(usize) -> bool) -> f32 {
    let between = |a: Vec3, b: Vec3| Vec3::select(a.cmpeq(b), Vec3::ZERO, a - b);
    let apart = |gap: Vec3, b: Vec3| largest(gap) - 4.0 * f32::EPSILON * largest(b);
    let mut most = 0.0;
    for (row, ((&xa, &va), (&xb, &vb))) in xa.iter().zip(va).zip(xb.iter().zip(vb)).enumerate() {
        let (x, v) = (between(xa, xb), between(va, vb));
        // The largest coordinate may overlook one that is not a number.
        let finite = x.is_finite() && v.is_finite();
        let gap = if finite { max(apart(x, xb), h * apart(v, vb)) } else { f32::INFINITY };
        if !(gap <= most) && sound(row) {
            most = gap;
        }
    }
    most
}
