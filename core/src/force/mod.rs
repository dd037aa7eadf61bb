//! What pulls and pushes particles: one file a force.

mod all_pairs;
mod charge;
mod curl;
mod drag;
mod flow;
mod friction;
mod gravity;
mod inverse_square;
mod kind;
mod mutual;
mod near;
mod penalty;
mod pressure;
mod quadratic;
mod radial;
mod relaxation;
mod sink;
pub(crate) mod spring;
mod steady;
mod viscosity;
mod wind;

pub use all_pairs::AllPairs;
pub use charge::Coulomb;
pub use curl::Curl;
pub use drag::Drag;
pub use flow::{Flow, FlowKind, Gusts, Uniform, Vortex};
pub use friction::Friction;
pub use gravity::Gravity;
pub use kind::ForceKind;
pub use mutual::MutualGravity;
pub use penalty::Penalty;
pub use pressure::Pressure;
pub use quadratic::QuadraticDrag;
pub use radial::{LennardJones, Pair, PowerLaw, Radial, RadialLaw, Run, Weight};
pub use relaxation::Relaxation;
pub use sink::Sink;
pub(crate) use spring::is_broken;
pub use spring::{Drive, Held, Spring, SpringCode, SpringList, Springs};
pub use steady::Steady;
pub use viscosity::Viscosity;
pub use wind::Wind;

use crate::custom::{CustomColumns, CustomColumnsMut};
use crate::index::{Arrange, BarnesHut, Listing, Neighbours};
use crate::math::max;
use crate::particles::Id;
use crate::report::Report;
use crate::rng::later;
use crate::scene::Scene;
use crate::step::{Field, View};
use crate::time::Time;
use core::ops::Range;
use glam::Vec3;

/// A force field or an interaction.
///
/// A tuple, slice or reference of forces is a force: their sum.
pub trait Force: Sync {
    /// Adds the force \[N\] on each particle of `rows` to `total`, whose first entry is that of the first row.
    ///
    /// Rows are independent of each other, so that any division of the work gives the same bits.
    fn add_to(&self, state: &State<'_>, rows: Range<usize>, total: &mut [Vec3]);

    /// What it has to find in the state.
    fn needs(&self) -> Needs {
        Needs::default()
    }

    /// Whether the force on a particle depends on nothing but its own row and the time. A step then takes a few rows at a time
    /// through all its phases, while they are in the cache; the state has no other rows in it.
    fn is_local(&self) -> bool {
        false
    }

    /// What it comes to, if that is no more than a steady acceleration and each particle's own drag: a step then works it out in one
    /// pass over the columns, to the bits of `add_to`. Chips without an operating system do not ask.
    fn steady(&self) -> Option<Steady> {
        None
    }

    /// Changes columns of a user's own if it [needs](Needs::write) to, once in each step of `dt` \[s\], when all have moved and
    /// been held against colliders and before anybody is taken out: what burns or cools. The state is that at the step's end; its
    /// own columns of that kind are empty, as `custom` has them. Of several forces each sees what those before it have written.
    fn write(&self, state: &State<'_>, custom: &mut CustomColumnsMut<'_>, dt: f32) {
        let _ = (state, custom, dt);
    }

    /// Adds how the force on each particle changes as they move: (∂f/∂x) δx + (∂f/∂v) δv \[N\], for methods that solve for
    /// the state at a step's end. All rows at once.
    ///
    /// It has to be symmetric and must not push what is displaced any farther (negative semidefinite), so parts that do
    /// are left out. A force that leaves it out altogether is taken as constant over the step, as an explicit method would.
    fn add_jacobian(&self, state: &State<'_>, change: &Change<'_>, total: &mut [Vec3]) {
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

    /// Power \[W\] that it brings into kinetic and its own potential energy taken together: below zero for what slows
    /// things down, zero for a force that is the slope of its energy.
    #[cfg(feature = "std")]
    fn power(&self, state: &State<'_>) -> f64 {
        let _ = state;
        0.0
    }

    /// What it is called in reports.
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
pub struct Change<'a> {
    /// A vector a row.
    pub along: &'a [Vec3],
    /// How far positions go along it.
    pub position: f32,
    /// How far velocities go along it.
    pub velocity: f32,
}

/// What makes trees of masses and charges. A function, so that a program with no force that names it does not carry it about.
#[derive(Clone, Copy, Debug)]
pub struct Trees(pub(crate) Finding);

/// Calls a function with a state in which what forces have to find is found.
pub(crate) type Finding = for<'s> fn(&mut Field<'_>, &State<'s>, &mut dyn FnMut(&State<'_>));

/// What lets forces write, likewise.
#[derive(Clone, Copy, Debug)]
pub struct Writing(pub(crate) Write);

type Write = fn(&mut View<'_>, &Scene<'_>, [Time; 2], &mut Report);

impl Trees {
    /// Those of Barnes and Hut, by [`BarnesHut::grow`].
    pub const GROWN: Self = Self(|field, state, then| field.with_trees(state, then));
}

impl Writing {
    /// Once in each step, at its end.
    pub const AT_END: Self = Self(write);
}

fn write(view: &mut View<'_>, scene: &Scene<'_>, span: [Time; 2], report: &mut Report) {
    view.write(scene, span, report);
}

/// What forces have to find in the state, beyond the particles.
#[derive(Clone, Copy, Debug, Default)]
pub struct Needs {
    /// [`State::mass_tree`], and what makes it.
    pub mass_tree: Option<Trees>,
    /// [`State::charge_tree`], and what makes it.
    pub charge_tree: Option<Trees>,
    /// The radius within which [`State::near`] is asked for neighbours \[m\]; zero: it is not.
    pub reach: f32,
    /// What finds them: [`Listing::KEPT`]. A function, likewise; without it all pairs are looked at, which is counted.
    pub lists: Option<Listing>,
    /// To change columns of a user's own, by [`Force::write`]; without it a force is not asked to.
    pub write: Option<Writing>,
}

impl Needs {
    /// Neighbours within a radius \[m\], in lists where there is memory for them.
    #[must_use]
    pub fn within(reach: f32) -> Self {
        Self { reach: max(reach, 0.0), lists: Some(Listing::KEPT), ..Self::default() }
    }

    /// What two forces need.
    #[must_use]
    pub fn and(self, other: Self) -> Self {
        Self {
            mass_tree: self.mass_tree.or(other.mass_tree),
            charge_tree: self.charge_tree.or(other.charge_tree),
            reach: max(self.reach, other.reach),
            lists: self.lists.or(other.lists),
            write: self.write.or(other.write),
        }
    }

    /// Vectors for each particle that the trees take.
    #[must_use]
    pub const fn tree_columns(self) -> usize {
        BarnesHut::COLUMNS * (self.mass_tree.is_some() as usize + self.charge_tree.is_some() as usize)
    }

    /// Vectors for each particle that it takes to work it all out, neighbours by `index`.
    #[must_use]
    pub fn columns(self, index: &dyn Arrange) -> usize {
        self.tree_columns() + if self.reach > 0.0 { index.columns() } else { 0 }
    }
}

/// The particles as forces and reapers see them: one entry a row.
#[derive(Clone, Copy)]
pub struct State<'a> {
    /// The instant.
    pub time: Time,
    /// Positions \[m\].
    pub position: &'a [Vec3],
    /// Velocities \[m/s\].
    pub velocity: &'a [Vec3],
    /// Radii \[m\].
    pub radius: &'a [f32],
    /// Masses \[kg\].
    pub mass: &'a [f32],
    /// Coefficients of linear drag \[kg/s\].
    pub drag: &'a [f32],
    /// Charges \[C\].
    pub charge: &'a [f32],
    /// When they were born.
    pub born: &'a [Time],
    /// When they die of age; [`Time::NEVER`]: never.
    pub dies: &'a [Time],
    /// The slots they hold; see [`id`](State::id).
    pub slot: &'a [u32],
    /// What their random numbers are drawn by; see [`word`](State::word).
    pub key: &'a [u32],
    /// Columns of a user's own.
    pub custom: CustomColumns<'a>,
    /// The springs between them.
    pub springs: Springs<'a>,
    /// The neighbours of each.
    pub near: Neighbours<'a>,
    /// Their masses in a tree, while a step is made, if a force needs it and there are at least 128 of them.
    pub mass_tree: Option<&'a BarnesHut<'a>>,
    /// Their charges in a tree, likewise.
    pub charge_tree: Option<&'a BarnesHut<'a>>,
}

impl<'a> State<'a> {
    /// Nobody.
    pub(crate) const EMPTY: State<'static> = State {
        time: Time::ZERO,
        position: &[],
        velocity: &[],
        radius: &[],
        mass: &[],
        drag: &[],
        charge: &[],
        born: &[],
        dies: &[],
        slot: &[],
        key: &[],
        custom: CustomColumns::NONE,
        springs: Springs {
            springs: &[],
            code: None,
            start: 0,
            serial: &[],
            row_of: &[],
            last_spring: &[],
            incident: &[],
        },
        near: Neighbours::among(&[]),
        mass_tree: None,
        charge_tree: None,
    };

    /// The first of these particles, as many as there are places, at other places with other velocities; what was sorted by
    /// place is left out.
    pub(crate) fn moved<'s>(&self, time: Time, position: &'s [Vec3], velocity: &'s [Vec3]) -> State<'s>
    where
        'a: 's,
    {
        let len = position.len();
        State {
            time,
            position,
            velocity,
            radius: &self.radius[..len],
            mass: &self.mass[..len],
            drag: &self.drag[..len],
            charge: &self.charge[..len],
            born: &self.born[..len],
            dies: &self.dies[..len],
            slot: &self.slot[..len],
            key: &self.key[..len],
            custom: self.custom.rows(0..len),
            springs: Springs { serial: &self.springs.serial[..len], ..self.springs },
            near: Neighbours::among(position),
            mass_tree: None,
            charge_tree: None,
        }
    }

    /// What they are besides places and velocities, some rows of it.
    pub(crate) fn attributes_of(&self, rows: Range<usize>) -> Self {
        Self {
            position: &[],
            velocity: &[],
            radius: &self.radius[rows.clone()],
            mass: &self.mass[rows.clone()],
            drag: &self.drag[rows.clone()],
            charge: &self.charge[rows.clone()],
            born: &self.born[rows.clone()],
            dies: &self.dies[rows.clone()],
            slot: &self.slot[rows.clone()],
            key: &self.key[rows.clone()],
            custom: self.custom.rows(rows.clone()),
            springs: Springs { serial: &self.springs.serial[rows], ..self.springs },
            ..*self
        }
    }

    /// How many particles lie within `radius` \[m\] of a place, whoever lies there included: by the index, or by looking at all.
    #[must_use]
    pub fn count_within(&self, place: Vec3, radius: f32) -> u64 {
        self.near.count_within(place, radius)
    }

    /// The particle in a row.
    #[must_use]
    pub fn id(&self, row: usize) -> Option<Id> {
        Some(Id { slot: *self.slot.get(row)?, serial: *self.springs.serial.get(row)? })
    }

    /// A random word of the particle in a row, the `place`-th that it has beside those of its birth: the same as long as it
    /// lives, and however time is cut into steps.
    ///
    /// It belongs to the emitter's number and the birth's number there, of what is put in without an emitter to the number
    /// in which it was put in. (Serials and slots will not do for that: in which order the births of several emitters come in
    /// depends on the steps.)
    #[must_use]
    pub fn word(&self, row: usize, place: u32) -> Option<u32> {
        Some(later(*self.key.get(row)?, place))
    }
}

impl Force for () {
    fn add_to(&self, _: &State<'_>, _: Range<usize>, _: &mut [Vec3]) {}
    fn is_local(&self) -> bool {
        true
    }
    #[cfg(not(target_os = "none"))]
    fn steady(&self) -> Option<Steady> {
        Some(Steady::default())
    }
    #[cfg(feature = "std")]
    fn account(&self, _: &State<'_>, _: &mut dyn FnMut(Entry)) {}
}

/// What has parts is their sum.
macro_rules! sum_of {
    ($this:ident => $parts:expr) => {
        fn add_to(&self, state: &State<'_>, rows: Range<usize>, total: &mut [Vec3]) {
            let $this = self;
            for part in $parts {
                part.add_to(state, rows.clone(), total);
            }
        }
        fn write(&self, state: &State<'_>, custom: &mut CustomColumnsMut<'_>, dt: f32) {
            let $this = self;
            for part in $parts {
                part.write(state, custom, dt);
            }
        }
        fn add_jacobian(&self, state: &State<'_>, change: &Change<'_>, total: &mut [Vec3]) {
            let $this = self;
            for part in $parts {
                part.add_jacobian(state, change, total);
            }
        }
        fn add_stiffness(&self, state: &State<'_>, weights: [f32; 2], total: &mut [Vec3]) {
            let $this = self;
            for part in $parts {
                part.add_stiffness(state, weights, total);
            }
        }
        fn needs(&self) -> Needs {
            let $this = self;
            let mut needs = Needs::default();
            for part in $parts {
                needs = needs.and(part.needs());
            }
            needs
        }
        fn is_local(&self) -> bool {
            let $this = self;
            $parts.into_iter().all(|part| part.is_local())
        }
        #[cfg(not(target_os = "none"))]
        fn steady(&self) -> Option<Steady> {
            let $this = self;
            let mut all = Steady::default();
            for part in $parts {
                all = all.and(part.steady()?)?;
            }
            Some(all)
        }
        #[cfg(feature = "std")]
        fn energy(&self, state: &State<'_>) -> f64 {
            let $this = self;
            let mut sum = 0.0;
            for part in $parts {
                sum += part.energy(state);
            }
            sum
        }
        #[cfg(feature = "std")]
        fn power(&self, state: &State<'_>) -> f64 {
            let $this = self;
            let mut sum = 0.0;
            for part in $parts {
                sum += part.power(state);
            }
            sum
        }
        #[cfg(feature = "std")]
        fn account(&self, state: &State<'_>, visit: &mut dyn FnMut(Entry)) {
            let $this = self;
            for part in $parts {
                part.account(state, visit);
            }
        }
    };
}

/// What stands for another force is that force.
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
        #[cfg(not(target_os = "none"))]
        fn steady(&self) -> Option<Steady> {
            let $this = self;
            $force.steady()
        }
        fn write(&self, state: &State<'_>, custom: &mut CustomColumnsMut<'_>, dt: f32) {
            let $this = self;
            $force.write(state, custom, dt);
        }
        fn add_jacobian(&self, state: &State<'_>, change: &Change<'_>, total: &mut [Vec3]) {
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

impl<T: Force + ?Sized> Force for &T {
    same_as!(this => **this);
}

impl Force for ForceKind {
    same_as!(this => this.get());
}

impl<T: Force> Force for [T] {
    sum_of!(this => this);
}

impl<T: Force, const N: usize> Force for [T; N] {
    sum_of!(this => this);
}

impl<T: Force, const N: usize> Force for heapless::Vec<T, N> {
    sum_of!(this => this);
}

#[cfg(feature = "alloc")]
impl<T: Force> Force for alloc::vec::Vec<T> {
    sum_of!(this => this);
}

macro_rules! tuples {
    ($($name:ident)+) => {
        impl<$($name: Force),+> Force for ($($name,)+) {
            sum_of!(this => {
                #[allow(non_snake_case)]
                let ($($name,)+) = this;
                [$($name as &dyn Force),+]
            });
        }
    };
}
tuples!(A);
tuples!(A B);
tuples!(A B C);
tuples!(A B C D);
tuples!(A B C D E);
tuples!(A B C D E F);
