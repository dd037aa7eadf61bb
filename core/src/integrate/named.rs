//! The methods by name.

use super::{
    Adaptive, Drift, Dynamics, Embedded, Euler, Implicit, Integrator, LectureMidpoint, Midpoint, Motion, Rk4,
    Symplectic, Verlet,
};
use crate::named::by_name;
use crate::time::Time;

/// Declares the methods that have a name.
macro_rules! methods {
    ($($(#[$doc:meta])* $method:ident = $name:literal, $integrator:expr;)+) => {
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

            /// The integrator itself, with the usual settings.
            #[must_use]
            pub const fn integrator(self) -> &'static dyn Integrator {
                match self { $(Self::$method => const { &$integrator },)+ }
            }
        }
    };
}

methods! {
    /// Explicit Euler.
    Euler = "euler", Euler;
    /// Symplectic Euler.
    Symplectic = "symplectic", Symplectic;
    /// The midpoint method.
    Midpoint = "midpoint", Midpoint;
    /// The midpoint method as the lecture prints it: of order 1 where forces depend on time.
    LectureMidpoint = "lecture_midpoint", LectureMidpoint;
    /// Velocity Verlet.
    Verlet = "verlet", Verlet;
    /// The classical Runge-Kutta method of fourth order.
    Rk4 = "rk4", Rk4;
    /// Step doubling around another method.
    Adaptive = "adaptive", Adaptive::around(Rk4);
    /// Bogacki and Shampine's embedded pair of orders 3 and 2, with steps of its own choice.
    Embedded = "embedded", Embedded::USUAL;
    /// Implicit Euler.
    Implicit = "implicit", Implicit::USUAL;
}

/// The settings of methods that choose their own steps, and of those that solve for the step's end.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default, deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Tuning {
    /// Adaptive and embedded: the error that an inner step may make \[m\].
    pub tolerance: f32,
    /// Adaptive and embedded: the smallest inner step \[s\].
    pub smallest: f32,
    /// Adaptive and embedded: how many inner steps may be tried in one step.
    pub attempts: u32,
    /// Adaptive: the method inside, one that takes steps as they come.
    pub inner: Method,
    /// Implicit: Newton steps, each solving the linearised system.
    pub newton: u32,
    /// Implicit: iterations at the most for each of them.
    pub iterations: u32,
    /// Implicit: the residual that is small enough, as a share of what it begins with.
    pub residual: f32,
}

impl Tuning {
    /// The usual settings.
    pub const DEFAULT: Self = Self {
        tolerance: Embedded::USUAL.tolerance,
        smallest: 1e-6,
        attempts: Embedded::USUAL.attempts,
        inner: Method::Rk4,
        newton: Implicit::USUAL.newton,
        iterations: Implicit::USUAL.iterations,
        residual: Implicit::USUAL.residual,
    };
}

impl Default for Tuning {
    fn default() -> Self {
        Self::DEFAULT
    }
}

/// A method chosen at run time, with its settings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tuned {
    /// The method.
    pub method: Method,
    /// Its settings.
    pub tuning: Tuning,
}

impl Tuned {
    /// Hands the integrator to `then`, and returns what that makes of it.
    fn with<R>(&self, then: impl FnOnce(&dyn Integrator) -> R) -> R {
        let Tuning { tolerance, smallest, attempts, inner, newton, iterations, residual } = self.tuning;
        let smallest = Time::from_seconds(smallest);
        match self.method {
            Method::Adaptive => {
                // One that chooses its own steps has none to double.
                let inner = if inner.chooses_steps() { &Rk4 } else { inner.integrator() };
                then(&Adaptive { inner, tolerance, smallest, attempts })
            }
            Method::Embedded => then(&Embedded { tolerance, smallest, attempts }),
            Method::Implicit => then(&Implicit { newton, iterations, residual }),
            method => then(method.integrator()),
        }
    }
}

impl Integrator for Method {
    fn columns(&self) -> usize {
        self.integrator().columns()
    }
    fn needs_start(&self) -> bool {
        self.integrator().needs_start()
    }
    fn is_local(&self) -> bool {
        self.integrator().is_local()
    }
    fn drift(&self) -> Option<Drift> {
        self.integrator().drift()
    }
    fn lead(&self) -> f32 {
        self.integrator().lead()
    }
    fn advance(&self, motion: Motion<'_>, time: Time, step: Time, world: &mut dyn Dynamics) {
        self.integrator().advance(motion, time, step, world);
    }
}

impl From<Method> for Tuned {
    fn from(method: Method) -> Self {
        Self { method, tuning: Tuning::DEFAULT }
    }
}

impl Method {
    /// Tells whether it divides a step as it sees fit.
    #[must_use]
    pub const fn chooses_steps(self) -> bool {
        matches!(self, Self::Adaptive | Self::Embedded)
    }
}

impl Integrator for Tuned {
    fn columns(&self) -> usize {
        self.with(|integrator| integrator.columns())
    }
    fn needs_start(&self) -> bool {
        self.with(|integrator| integrator.needs_start())
    }
    fn is_local(&self) -> bool {
        self.with(|integrator| integrator.is_local())
    }
    fn drift(&self) -> Option<Drift> {
        self.with(|integrator| integrator.drift())
    }
    fn lead(&self) -> f32 {
        self.with(|integrator| integrator.lead())
    }
    fn advance(&self, motion: Motion<'_>, time: Time, step: Time, world: &mut dyn Dynamics) {
        self.with(|integrator| integrator.advance(motion, time, step, world));
    }
}

by_name!(Method, UnknownMethod, "integrator");
