//! What pulls and pushes particles: one file a force.

mod all_pairs;
mod drag;
mod gravity;
mod kind;
mod mutual;
mod sink;
pub(crate) mod spring;

pub use all_pairs::AllPairs;
pub use drag::Drag;
pub use gravity::Gravity;
pub use kind::ForceKind;
pub use mutual::MutualGravity;
pub use sink::Sink;
pub use spring::{Spring, Springs};

use crate::index::BarnesHut;
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

    /// Potential energy \[J\]; zero for forces that have none. For reports: in double precision, and so with the
    /// feature `std` only, since a chip without such hardware would carry its emulation about for nothing.
    #[cfg(feature = "std")]
    fn energy(&self, state: &State<'_>) -> f64 {
        let _ = state;
        0.0
    }
}

/// Sorts points with weights into memory; none if there is too little.
pub type Grow = for<'m> fn(&'m mut [u32], &[Vec3], &[f32]) -> Option<BarnesHut<'m>>;

/// What forces have to find in the state, beyond the particles.
#[derive(Clone, Copy, Debug, Default)]
pub struct Needs {
    /// [`State::tree`], and what makes it: [`BarnesHut::grow`]. A function, so that a program with no force that names it
    /// does not carry it about.
    pub tree: Option<Grow>,
}

impl Needs {
    /// What two forces need.
    #[must_use]
    pub fn and(self, other: Self) -> Self {
        Self { tree: self.tree.or(other.tree) }
    }

    /// Vectors for each particle that it takes to work it out.
    #[must_use]
    pub const fn columns(self) -> usize {
        if self.tree.is_some() { BarnesHut::COLUMNS } else { 0 }
    }
}

/// The particles as a force sees them: one entry a row.
#[derive(Clone, Copy, Debug)]
pub struct State<'a> {
    /// The instant.
    pub time: Time,
    /// Positions \[m\].
    pub position: &'a [Vec3],
    /// Velocities \[m/s\].
    pub velocity: &'a [Vec3],
    /// Masses \[kg\].
    pub mass: &'a [f32],
    /// Coefficients of linear drag \[kg/s\].
    pub drag: &'a [f32],
    /// The springs between them.
    pub springs: Springs<'a>,
    /// Their masses in a tree, while a step is made, if a force needs it and there are at least 128 of them.
    pub tree: Option<&'a BarnesHut<'a>>,
}

impl Force for () {
    fn add_to(&self, _: &State<'_>, _: Range<usize>, _: &mut [Vec3]) {}
}

impl<T: Force + ?Sized> Force for &T {
    fn add_to(&self, state: &State<'_>, rows: Range<usize>, total: &mut [Vec3]) {
        (**self).add_to(state, rows, total);
    }
    fn needs(&self) -> Needs {
        (**self).needs()
    }
    #[cfg(feature = "std")]
    fn energy(&self, state: &State<'_>) -> f64 {
        (**self).energy(state)
    }
}

impl<T: Force> Force for [T] {
    fn add_to(&self, state: &State<'_>, rows: Range<usize>, total: &mut [Vec3]) {
        for force in self {
            force.add_to(state, rows.clone(), total);
        }
    }
    fn needs(&self) -> Needs {
        self.iter().fold(Needs::default(), |needs, force| needs.and(force.needs()))
    }
    #[cfg(feature = "std")]
    fn energy(&self, state: &State<'_>) -> f64 {
        self.iter().map(|force| force.energy(state)).sum()
    }
}

/// Everything that holds a slice is what the slice is.
macro_rules! lists {
    ($($(#[$when:meta])* [$($generics:tt)*] $list:ty;)+) => {$(
        $(#[$when])*
        impl<$($generics)*> Force for $list {
            fn add_to(&self, state: &State<'_>, rows: Range<usize>, total: &mut [Vec3]) {
                self.as_slice().add_to(state, rows, total);
            }
            fn needs(&self) -> Needs {
                self.as_slice().needs()
            }
            #[cfg(feature = "std")]
            fn energy(&self, state: &State<'_>) -> f64 {
                self.as_slice().energy(state)
            }
        }
    )+};
}
lists! {
    [T: Force, const N: usize] [T; N];
    [T: Force, const N: usize] heapless::Vec<T, N>;
    #[cfg(feature = "alloc")]
    [T: Force] alloc::vec::Vec<T>;
}

macro_rules! tuples {
    ($($name:ident)+) => {
        impl<$($name: Force),+> Force for ($($name,)+) {
            fn add_to(&self, state: &State<'_>, rows: Range<usize>, total: &mut [Vec3]) {
                #[allow(non_snake_case)]
                let ($($name,)+) = self;
                $($name.add_to(state, rows.clone(), total);)+
            }
            fn needs(&self) -> Needs {
                #[allow(non_snake_case)]
                let ($($name,)+) = self;
                Needs::default()$(.and($name.needs()))+
            }
            #[cfg(feature = "std")]
            fn energy(&self, state: &State<'_>) -> f64 {
                #[allow(non_snake_case)]
                let ($($name,)+) = self;
                0.0 $(+ $name.energy(state))+
            }
        }
    };
}
tuples!(A);
tuples!(A B);
tuples!(A B C);
tuples!(A B C D);
tuples!(A B C D E);
tuples!(A B C D E F);
