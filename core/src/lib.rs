//! Particle systems that are exact, bounded and the same everywhere.
//!
//! A [`Scene`] is immutable data that says what the world does; a [`System`] is the state it is done to;
//! [`System::step`] is the only verb. Nothing allocates, nothing panics, every bound is counted in the [`Report`], and
//! the same scene, seed and step give the same bits on every target, which [`System::hash`] proves.
//!
//! Units are SI, angles are radians, y points up, and the axes are right-handed.
//!
//! ```
//! use pointmass::{Emitter, Gravity, Inline, Scene, Spread, System, Time, Varied, Vec3};
//! use pointmass::shape::{Disc, Mesh, Plane, Shape};
//!
//! let nozzle = Shape::<Mesh>::Circle(Disc { center: Vec3::ZERO, normal: Vec3::Y, radius: 0.1 });
//! let jet = Emitter {
//!     speed: Varied { mean: 6.0, variance: 0.5 },
//!     spread: Spread::Uniform(0.2),
//!     lifetime: Varied::exactly(1.5),
//!     ..Emitter::new(nozzle, 40.0)
//! };
//! let ground = Plane { point: Vec3::new(0.0, -0.1, 0.0), normal: Vec3::Y };
//! let scene = Scene { emitters: &jet, forces: &Gravity::EARTH, colliders: &ground, ..Scene::EMPTY };
//!
//! // Room for 64 particles, 1 emitter, no springs, 3 columns to work with: all in this value, none on the heap.
//! let mut fountain = System::with(Inline::<64, 1, 0, 3>::new());
//! fountain.start(&scene, 7)?;
//! for frame in 1..=120 {
//!     fountain.step(&scene, Time::frame(frame, 60) - fountain.time());
//! }
//! assert_eq!(fountain.totals().born, 80);
//! assert!(fountain.particles().position.iter().all(|x| x.y > -0.1));
//! # Ok::<(), pointmass::Unfit>(())
//! ```
//!
//! # Map
//! `system` holds the state and `view` the step; `emit` creates, `force` and `integrate` move, `collide` and `shape` collide, `retire`
//! deletes, `measure`, `ledger`, `stability` and `report` tell what happened and what will; `weave` makes cloth; `storage` owns the memory; `scene` (feature `alloc`) reads and
//! writes scene files; `stability` (feature `std`) says which steps a method stands.
//!
//! # Features
//! `alloc`: storage on the heap, declared scenes. `serde`: the domain types as data. `json`: scenes as JSON. `schema`: their
//! JSON Schema. `std`: for hosts, their faster square root, with the same bits, and
//! `Measures` in double precision. Without features: no allocation at all.

#![no_std]
#![forbid(unsafe_code)]

#[cfg(feature = "alloc")]
extern crate alloc;
#[cfg(any(test, feature = "std"))]
extern crate std;

mod collide;
pub mod emit;
mod events;
pub mod force;
mod hash;
pub mod index;
pub mod integrate;
mod lanes;
#[cfg(feature = "std")]
mod ledger;
pub mod math;
#[cfg(feature = "std")]
mod measure;
mod observe;
mod particles;
pub mod rays;
mod report;
mod retire;
pub mod rng;
mod rows;
pub mod scene;
pub mod shape;
#[cfg(feature = "std")]
pub mod stability;
mod stall;
mod storage;
mod system;
mod time;
mod view;
mod weave;

pub use collide::{Contacts, Grip, Impulse, Projection, Response};
#[doc(hidden)]
pub use collide::{Passage, Stage};
pub use emit::{Emit, Emitter, Spread, Varied};
pub use events::{Event, EventKind, Events};
pub use force::{
    AllPairs, Coulomb, Drag, Drive, Force, ForceKind, Gravity, LennardJones, MutualGravity, Penalty, PowerLaw,
    Pressure, QuadraticDrag, Radial, Sink, Spring, Viscosity, Wind,
};
pub use glam::{Mat3, Vec3};
pub use hash::Fnv;
pub use integrate::{
    Adaptive, Embedded, Euler, Implicit, Integrator, LectureMidpoint, Method, Midpoint, Rk4, Symplectic, Tuned, Tuning,
    Verlet,
};
#[cfg(feature = "std")]
pub use ledger::{Books, Ledger};
#[cfg(feature = "std")]
pub use measure::{Energy, Measures};
pub use observe::{Impact, Observer, Passing, Phase};
pub use particles::{Color, Full, Id, Particle, WHITE};
pub use report::{Caps, Died, Effort, Report};
pub use retire::{Cause, Fate};
pub use scene::{Scene, Unfit};
#[cfg(feature = "alloc")]
pub use storage::Heap;
pub use storage::{Columns, Inline, Size, Slices, Storage};
pub use system::System;
pub use time::Time;
#[cfg(feature = "alloc")]
pub use weave::mesh_springs;
pub use weave::{Sheet, Thread, Threads};

/// The README's example has to compile and run.
#[cfg(doctest)]
#[doc = include_str!("../../README.md")]
struct Readme;
