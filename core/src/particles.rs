//! A particle, and the id by which it is called.

use crate::rows::are_finite;
use crate::time::Time;
use glam::Vec3;

/// Red, green, blue and opacity, each 0 to 255, in sRGB.
pub type Color = [u8; 4];

/// Opaque white.
pub const WHITE: Color = [255; 4];

/// A particle as it is put into a system.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default, deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Particle {
    /// Where it is \[m\].
    #[cfg_attr(feature = "schema", schemars(with = "[f32; 3]"))]
    pub position: Vec3,
    /// How it moves \[m/s\].
    #[cfg_attr(feature = "schema", schemars(with = "[f32; 3]"))]
    pub velocity: Vec3,
    /// Its radius \[m\]; zero: a point.
    pub radius: f32,
    /// Mass \[kg\], above zero; of a fixed particle zero will do.
    pub mass: f32,
    /// It never moves, but still attracts and pulls at its springs.
    pub fixed: bool,
    /// Coefficient of linear drag \[kg/s\], for forces that read it (`Drag`, `Wind`).
    pub drag: f32,
    /// Electric charge \[C\], for forces that read it (`Coulomb`).
    pub charge: f32,
    /// The share of the normal speed it keeps when it hits something, 0 to 1; below zero counts as zero.
    pub elasticity: f32,
    /// How long it lives \[s\]; zero or less: for ever.
    pub lifetime: f32,
    /// Number of its material in the scene from 0, if it has one.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Option::is_none"))]
    pub material: Option<u16>,
    /// Its colour; without one, that of its material.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Option::is_none"))]
    pub color: Option<Color>,
}

impl Particle {
    /// A point of 1 kg at rest in the origin, free, without drag, immortal, of elasticity 0.5.
    pub const REST: Self = Self {
        position: Vec3::ZERO,
        velocity: Vec3::ZERO,
        radius: 0.0,
        mass: 1.0,
        fixed: false,
        drag: 0.0,
        charge: 0.0,
        elasticity: 0.5,
        lifetime: 0.0,
        material: None,
        color: None,
    };

    /// Tells whether every number of it can be used: finite, the radius not below zero, the mass above zero (or fixed
    /// and not below zero).
    #[must_use]
    pub fn is_sound(&self) -> bool {
        self.lifetime.is_finite() && are_finite(&[self.position, self.velocity]) && self.is_usable()
    }

    /// Tells whether every number of it but its place, its velocity and its lifetime can be used.
    pub(crate) fn is_usable(&self) -> bool {
        let Self { mass, drag, charge, elasticity, radius, .. } = *self;
        let are_finite = are_finite(&[Vec3::new(mass, drag, charge), Vec3::new(elasticity, radius, 0.0)]);
        // The inverse of a mass below 3e-39 kg overflows.
        let is_heavy = if self.fixed { mass >= 0.0 } else { mass > 0.0 && 1.0 / mass < f32::INFINITY };
        are_finite && is_heavy && radius >= 0.0
    }
}

/// Where and how a particle begins.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Start {
    pub(crate) position: Vec3,
    pub(crate) velocity: Vec3,
    pub(crate) lifetime: f32,
    /// When.
    pub(crate) born: Time,
}

impl Start {
    /// As a particle says.
    pub(crate) fn of(particle: &Particle, born: Time) -> Self {
        let Particle { position, velocity, lifetime, .. } = *particle;
        Self { position, velocity, lifetime, born }
    }
}

impl Default for Particle {
    fn default() -> Self {
        Self::REST
    }
}

/// The name of a particle as long as it lives; never given again within 2³² births.
///
/// Ids order by slot.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Id {
    pub(crate) slot: u32,
    pub(crate) serial: u32,
}

impl Id {
    /// The number of particles that the system had taken in before it: unique over a run (of up to 2³² births), 0 for
    /// the first.
    #[must_use]
    pub const fn serial(self) -> u32 {
        self.serial
    }

    /// The place it holds while it lives, below the system's capacity; given again after its death.
    #[must_use]
    pub const fn slot(self) -> u32 {
        self.slot
    }
}

/// There is no room for another particle, or none for one like it: the memory holds for all particles what it has otherwise.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Full;

impl core::fmt::Display for Full {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str("the system is full: no room for another particle, or none for one like it")
    }
}

impl core::error::Error for Full {}
