#![doc = include_str!("../README.md")]
//!
//! # Map
//! [`System`] holds the state, `step` moves it on. [`emit`] creates; [`force`] and [`integrate`] move, [`constrain`] binds; `collide` and
//! [`shape`] collide, with [`rays`] to find what a path meets first and [`index`] to find what is near; [`reap`] deletes. [`Report`], and with
//! the feature `std` [`Measures`], [`Ledger`] and [`stability`], tell what happened and what will. [`Sheet`] makes cloth. [`Storage`] is the
//! memory. [`scene`] reads and writes scene files.

#![no_std]
#![forbid(unsafe_code)]

#[cfg(feature = "alloc")]
extern crate alloc;
#[cfg(any(test, feature = "std"))]
extern crate std;

mod cloth;
mod collide;
mod composed;
pub mod constrain;
mod curve;
mod custom;
mod division;
pub mod draw;
pub mod emit;
mod events;
pub mod force;
mod hash;
pub mod index;
pub mod integrate;
mod lanes;
mod least;
#[cfg(feature = "std")]
mod ledger;
pub mod material;
pub mod math;
#[cfg(feature = "std")]
mod measure;
mod memory;
pub mod motion;
mod named;
mod observe;
mod particles;
pub mod rays;
pub mod reap;
mod report;
pub mod rng;
mod rows;
pub mod scene;
pub mod shape;
#[cfg(feature = "std")]
pub mod stability;
mod stall;
mod step;
mod system;
mod time;

#[cfg(feature = "alloc")]
pub use cloth::mesh_springs;
pub use cloth::{ClothSprings, Sheet, SpringParams};
pub use collide::{Impulse, Meetings, Paths};
#[cfg(feature = "alloc")]
pub use constrain::ConstraintKind;
pub use constrain::{
    Attach, Constraint, Contacts, Distance, RigidBodies, RigidBox, Rope, ShapeMatching, SheetContacts, Shell,
    ShellParams, StrainLimitParams, StrainLimits, StrandParams, Strands, Tie,
};
#[cfg(feature = "alloc")]
pub use custom::CustomBuf;
pub use custom::{Custom, CustomColumns, CustomColumnsMut, CustomList};
pub use emit::{Emit, Emitter, Jet, Spread, Varied, WhereSparse};
pub use events::{Event, EventKind, Events};
pub use force::{
    Aerodynamics, AllPairs, Coulomb, CylinderDrag, Drag, Drive, Force, ForceKind, Goal, Gravity, LennardJones,
    MutualGravity, Penalty, PowerLaw, Pressure, QuadraticDrag, Radial, Relaxation, Sink, Spring, SpringList, Viscosity,
    Wind,
};
pub use glam::{Mat3, Vec3};
pub use hash::Fnv;
pub use integrate::{
    Adaptive, Embedded, Euler, Implicit, Integrator, LectureMidpoint, Method, Midpoint, Rk4, Symplectic, Tuned, Tuning,
    Verlet,
};
#[cfg(feature = "std")]
pub use ledger::{Books, Ledger};
pub use material::{ContactMaterial, Material, MaterialList};
#[cfg(feature = "std")]
pub use measure::{Energy, Measures};
#[cfg(feature = "alloc")]
pub use memory::Heap;
pub use memory::{Alike, Column, Columns, Common, Inline, Likeness, Own, Size, Slices, Storage};
pub use observe::{Attention, Impact, LifeEvent, Observer, Phase, Sliding};
pub use particles::{Color, Full, Id, Particle, WHITE};
pub use reap::{Cause, Chance, Dense, PendingDeath, Reaper, ReaperKind};
pub use report::{Caps, Died, Effort, Report};
pub use scene::{InsufficientMemory, Response, Scene};
pub use system::System;
pub use time::Time;
