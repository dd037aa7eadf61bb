//! Newton's second law, stepped through time: one file a method.

mod euler;
mod midpoint;
mod rk4;
mod verlet;

pub use euler::{Euler, Symplectic};
pub use midpoint::Midpoint;
pub use rk4::Rk4;
pub use verlet::Verlet;

pub(crate) use crate::rows::{add_scaled, advance_by};
use crate::time::Time;
use glam::Vec3;

/// All that an integrator may ask of the world.
pub trait Dynamics {
    /// The acceleration \[m/s²\] of every particle at `time`, were they at `position` with `velocity`.
    ///
    /// All slices are equally long. Costs one evaluation of all forces.
    fn accelerations(&mut self, time: Time, position: &[Vec3], velocity: &[Vec3], acceleration: &mut [Vec3]);
}

/// A method to solve the equations of motion. It keeps no state of its own.
pub trait Integrator: Sync {
    /// Vectors it needs to work with for each particle.
    fn columns(&self) -> usize;

    /// Whether it needs `Motion::start`, the state at the step's beginning.
    fn needs_start(&self) -> bool {
        false
    }

    /// Moves everything from `time` to `time` + `step`.
    fn advance(&self, motion: Motion<'_>, time: Time, step: Time, world: &mut dyn Dynamics);
}

/// What an integrator moves. All slices are equally long.
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
        let Self { mut memory, stride, len } = self;
        core::array::from_fn(|_| {
            let (column, rest) = core::mem::take(&mut memory).split_at_mut_checked(stride).unwrap_or_default();
            memory = rest;
            column.get_mut(..len).unwrap_or_default()
        })
    }
}

impl<T: Integrator + ?Sized> Integrator for &T {
    fn columns(&self) -> usize {
        (**self).columns()
    }
    fn needs_start(&self) -> bool {
        (**self).needs_start()
    }
    fn advance(&self, motion: Motion<'_>, time: Time, step: Time, world: &mut dyn Dynamics) {
        (**self).advance(motion, time, step, world);
    }
}

/// Declares the methods that have a name.
macro_rules! methods {
    ($($(#[$doc:meta])* $method:ident = $name:literal,)+) => {
        /// An integrator by its name, as files and the command line say it.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        #[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
        #[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
        pub enum Method {
            $($(#[$doc])* #[cfg_attr(feature = "serde", serde(rename = $name))] $method,)+
        }

        impl Method {
            /// All of them.
            pub const ALL: &'static [Self] = &[$(Self::$method),+];

            /// Its name.
            #[must_use]
            pub const fn name(self) -> &'static str {
                match self { $(Self::$method => $name,)+ }
            }

            /// The integrator itself.
            #[must_use]
            pub const fn integrator(self) -> &'static dyn Integrator {
                match self { $(Self::$method => &$method,)+ }
            }
        }
    };
}

methods! {
    /// Explicit Euler.
    Euler = "euler",
    /// Symplectic Euler.
    Symplectic = "symplectic",
    /// The midpoint method.
    Midpoint = "midpoint",
    /// Velocity Verlet.
    Verlet = "verlet",
    /// The classical Runge-Kutta method of fourth order.
    Rk4 = "rk4",
}

impl core::fmt::Display for Method {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str(self.name())
    }
}

/// There is no integrator of that name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct UnknownMethod;

impl core::fmt::Display for UnknownMethod {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str("unknown integrator; there are")?;
        Method::ALL.iter().try_for_each(|method| write!(f, " {method}"))
    }
}

impl core::error::Error for UnknownMethod {}

impl core::str::FromStr for Method {
    type Err = UnknownMethod;
    fn from_str(name: &str) -> Result<Self, UnknownMethod> {
        Self::ALL.iter().copied().find(|method| method.name() == name).ok_or(UnknownMethod)
    }
}
