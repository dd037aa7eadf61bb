//! The forces that a file can name.

#[cfg(feature = "std")]
use super::Entry;
#[cfg(feature = "alloc")]
use super::{Aerodynamics, CylinderDrag, FlowKind, Pressure, Relaxation, Wind};
use super::{Coulomb, Drag, Force, Gravity, LennardJones, MutualGravity, PowerLaw, QuadraticDrag, Radial, Viscosity};
use super::{Needs, Perturbation, State, same_as};
use crate::custom::CustomColumnsMut;
#[cfg(feature = "alloc")]
use alloc::string::String;
#[cfg(feature = "alloc")]
use alloc::vec::Vec;
use core::ops::Range;
use glam::Vec3;

/// Declares the forces that have a name.
macro_rules! kinds {
    ($($(#[doc = $doc:literal])* $kind:ident = $name:literal, $force:ty $(, if $feature:literal)?;)+) => {
        /// A force that acts on all particles, as files name it.
        #[derive(Clone, Debug, PartialEq)]
        #[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
        #[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
        pub enum ForceKind {
            $($(#[doc = $doc])* $(#[cfg(feature = $feature)])? #[cfg_attr(feature = "serde", serde(rename = $name))] $kind($force),)+
        }

        impl ForceKind {
            /// The name that files give it.
            #[must_use]
            pub const fn kind(&self) -> &'static str {
                match self { $($(#[cfg(feature = $feature)])? Self::$kind(_) => $name,)+ }
            }

            /// The force itself.
            fn get(&self) -> &dyn Force {
                match self { $($(#[cfg(feature = $feature)])? Self::$kind(force) => force,)+ }
            }
        }
    };
}

kinds! {
    /// Uniform gravity.
    Gravity = "gravity", Gravity;
    /// Linear drag with each particle's own coefficient.
    Drag = "drag", Drag;
    /// Every two particles attract each other.
    MutualGravity = "mutual_gravity", MutualGravity;
    /// Drag that grows with the square of the speed.
    QuadraticDrag = "quadratic_drag", QuadraticDrag;
    /// Charges attract and repel each other.
    Coulomb = "coulomb", Coulomb;
    /// Air that moves, and drags along.
    Wind = "wind", Wind<Vec<FlowKind>>, if "alloc";
    /// Neighbours attract each other, and repel each other where they are close.
    LennardJones = "lennard_jones", Radial<LennardJones>;
    /// Neighbours act on each other by a power of their distance.
    PowerLaw = "power_law", Radial<PowerLaw>;
    /// Neighbours drag each other along.
    Viscosity = "viscosity", Viscosity;
    /// A column of a user's own comes to rest.
    Relaxation = "relaxation", Relaxation<String>, if "alloc";
    /// Gas in a closed mesh of particles.
    Pressure = "pressure", Pressure<Vec<[u32; 3]>>, if "alloc";
    /// Lift and drag of triangles in the air.
    Aerodynamics = "aerodynamics", Aerodynamics<Vec<[u32; 3]>, Vec<FlowKind>>, if "alloc";
    /// Drag of what is long and thin, by the segment.
    CylinderDrag = "cylinder_drag", CylinderDrag<Vec<[u32; 2]>, Vec<FlowKind>>, if "alloc";
}

impl Force for ForceKind {
    same_as!(this => this.get());
}
