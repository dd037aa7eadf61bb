//! Soft bodies in scene files: a box or a closed mesh filled with particles, by numbers that do not depend on how many these are.

use super::SceneError;
use super::filling::{Fault, SoftForm, boxed, filled};
use super::numbers::{Checked, above_zero, finite, zero_or_more};
use crate::constrain::{Attach, ConstraintKind, ShapeMatching};
use crate::math::{cbrt, length, min, sin_cos, unit};
use crate::motion::{Motion, MotionBuf};
use crate::particles::{Color, Particle};
use crate::shape::MeshBuf;
use alloc::format;
use alloc::string::String;
use alloc::vec::Vec;
use core::f32::consts::TAU;
use glam::Vec3;

/// A jelly: a solid filled with particles that keep its shape together and give way, each as if a spring held it at its place in the shape
/// (see [`ShapeMatching`]). They follow the scene's own particles and those of all other bodies, along x first, then z, then y.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct SoftBody {
    /// What is filled.
    pub form: SoftForm,
    /// By how much it is larger than its form says.
    #[cfg_attr(feature = "serde", serde(default = "one"))]
    pub scale: f32,
    /// How far its particles lie apart \[m\], along the sides of a box as near to that as whole numbers of them allow; how far does not change what
    /// it weighs, nor how soft it is.
    pub spacing: f32,
    /// The mass of a cubic metre \[kg/m³\]; jelly and flesh have some 1,000, foam rubber 50.
    pub density: f32,
    /// How often it swings in a second where it has been squeezed or drawn out \[Hz\], the same for every size; a jelly on a plate has some 5.
    /// Where a part of it is held still, the rest then hangs by g / (2 π f)² lower. This or `give` says how soft it is.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Option::is_none"))]
    pub frequency: Option<f32>,
    /// By how many percent of its height, before it is turned, it hangs lower by its own weight on Earth where a part of it is held still; zero
    /// is rigid. This or `frequency` says how soft it is. What lies on a floor rests on its lowest particles alone, and gives way there
    /// farther: by that for each layer of them, up to the root of twice that (1 % up to 14 %).
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Option::is_none"))]
    pub give: Option<f32>,
    /// How long stresses take to fade whose strain stands still \[s\]; from 1 / (π `frequency`) on it does not swing any more.
    #[cfg_attr(feature = "serde", serde(default))]
    pub damping: f32,
    /// Where its centre of mass is \[m\].
    #[cfg_attr(feature = "schema", schemars(with = "[f32; 3]"))]
    pub position: Vec3,
    /// How it is turned about that: by the length of this \[rad\], about its direction.
    #[cfg_attr(feature = "serde", serde(default))]
    #[cfg_attr(feature = "schema", schemars(with = "[f32; 3]"))]
    pub turn: Vec3,
    /// How it moves to begin with \[m/s\].
    #[cfg_attr(feature = "serde", serde(default))]
    #[cfg_attr(feature = "schema", schemars(with = "[f32; 3]"))]
    pub velocity: Vec3,
    /// How it turns to begin with \[rad/s\].
    #[cfg_attr(feature = "serde", serde(default))]
    #[cfg_attr(feature = "schema", schemars(with = "[f32; 3]"))]
    pub spin: Vec3,
    /// Two corners of a box in the world \[m\]: those of its particles that begin in it never move.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Option::is_none"))]
    #[cfg_attr(feature = "schema", schemars(with = "Option<[[f32; 3]; 2]>"))]
    pub held: Option<[Vec3; 2]>,
    /// How those move; without it they stay.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Option::is_none"))]
    pub motion: Option<MotionBuf>,
    /// The radius of its particles \[m\]; without it 0.4 times the spacing, so that neighbours do not touch as long as it is not squeezed
    /// by a fifth (a box of few cells, which may be less wide than that, by less). Contacts by position leave balls of a rigid body alone.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Option::is_none"))]
    pub radius: Option<f32>,
    /// Coefficient of linear drag of all of it \[kg/s\].
    #[cfg_attr(feature = "serde", serde(default))]
    pub drag: f32,
    /// The share of the normal speed that its particles keep when they hit something.
    #[cfg_attr(feature = "serde", serde(default))]
    pub elasticity: f32,
    /// Number of the material in the scene, if it has one.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Option::is_none"))]
    pub material: Option<u16>,
    /// Its colour; without one, that of its material.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Option::is_none"))]
    pub color: Option<Color>,
}

#[cfg(feature = "serde")]
const fn one() -> f32 {
    1.0
}

/// Standard gravity \[m/s²\].
const EARTH: f32 = 9.80665;
/// The radius of particles that say none, a share of their spacing.
const RADIUS: f32 = 0.4;

/// What a soft body is made into.
pub(super) struct Jelly {
    pub(super) particles: Vec<Particle>,
    pub(super) constraints: Vec<ConstraintKind>,
}

impl SoftBody {
    /// How many particles fill it, if it is a box.
    #[must_use]
    pub fn particles(&self) -> Option<u64> {
        let SoftForm::Box(sides) = &self.form else { return None };
        let cells = boxed(*sides * self.scale, self.spacing).0;
        Some(cells.iter().fold(1, |product: u64, &n| product.saturating_mul(u64::from(n))))
    }

    /// A remark on balls that overlap where they begin: the body pulls them back to where contacts push them apart, for ever. Contacts by position leave
    /// balls of a rigid body alone.
    pub(super) fn overlap(&self, by_position: bool) -> Option<String> {
        if by_position && self.rate(1.0).is_none() {
            return None;
        }
        let apart = match self.form {
            SoftForm::Box(sides) => {
                let (cells, side) = boxed(sides * self.scale, self.spacing);
                (0..3).filter(|&axis| cells[axis] > 1).map(|axis| side[axis]).fold(f32::INFINITY, min)
            }
            SoftForm::Mesh(_) => self.spacing,
        };
        let (radius, most) = (self.radius.unwrap_or(RADIUS * self.spacing), 0.5 * apart);
        // Numbers of files are rounded.
        (radius > most * (1.0 + 1e-6)).then(|| {
            format!(
                "balls of {radius} m that are {apart} m apart overlap, so contacts push them apart without end, and may throw the body about: \
                 take {most} m or less"
            )
        })
    }

    /// The square of how fast it swings \[1/s²\], for its height \[m\]; none if it is rigid.
    fn rate(&self, height: f32) -> Option<f32> {
        let swings = |frequency: f32| (TAU * frequency) * (TAU * frequency);
        let gives = |percent: f32| EARTH / (0.01 * percent * height);
        self.frequency.map(swings).or_else(|| self.give.filter(|&percent| percent > 0.0).map(gives))
    }

    /// Its particles and what binds them, the first having number `first` in the scene's start; `mesh` is that of its form.
    pub(super) fn make(&self, mesh: Option<&MeshBuf>, first: u32) -> Result<Jelly, Fault> {
        let filling = filled(&self.form, mesh, self.scale, self.spacing)?;
        let count = filling.places.len();
        if count < 2 {
            let few = cbrt(0.125 * filling.volume);
            let message = format!(
                "leaves room for {count} of its particles, of which there have to be two: take {few:?} m or less"
            );
            return Err(("spacing", message));
        }
        let (sin, cos) = sin_cos(length(self.turn));
        let axis = unit(self.turn);
        let turned = |v: Vec3| v * cos + axis.cross(v) * sin + axis * (axis.dot(v) * (1.0 - cos));
        let holds =
            |place: Vec3| self.held.is_some_and(|[a, b]| place.cmpge(a.min(b)).all() && place.cmple(a.max(b)).all());
        let mass = self.density * filling.volume;
        let particle = |&place: &Vec3| {
            let arm = turned(place);
            Particle {
                position: self.position + arm,
                velocity: self.velocity + self.spin.cross(arm),
                radius: self.radius.unwrap_or(RADIUS * self.spacing),
                mass: mass / count as f32,
                drag: self.drag / count as f32,
                elasticity: self.elasticity,
                material: self.material,
                fixed: holds(self.position + arm),
                color: self.color,
                ..Particle::REST
            }
        };
        let particles: Vec<Particle> = filling.places.iter().map(particle).collect();
        let numbers = || (first..).zip(&particles);
        let held: Vec<u32> = numbers().filter(|(_, one)| one.fixed).map(|(number, _)| number).collect();
        match (self.held, held.len()) {
            (Some(_), 0) => return Err(("held", "has none of its particles in it, which begin elsewhere".into())),
            (_, held) if held == count => {
                return Err(("held", "has all of its particles in it, so nothing of it would move".into()));
            }
            _ => {}
        }
        // The cluster shares its compliance among those that move.
        let moves = mass * ((count - held.len()) as f32 / count as f32);
        let stiffness = self.rate(filling.size.y).map(|rate| moves * rate);
        let (compliance, damping) =
            stiffness.map_or((0.0, 0.0), |stiffness| (1.0 / stiffness, self.damping * stiffness));
        if !(compliance.is_finite() && damping.is_finite()) {
            let field = if self.give.is_some() { "give" } else { "frequency" };
            let than = if compliance.is_finite() { "stiffer" } else { "softer" };
            return Err((field, format!("makes it {than} than 32-bit floats can tell, for {moves:e} kg")));
        }
        let all = numbers().map(|(number, _)| number).collect();
        let cluster = ConstraintKind::Cluster(ShapeMatching { particles: all, compliance, damping });
        let led = self.motion.clone().map(|motion| ConstraintKind::Attach(Attach { particles: held, motion }));
        Ok(Jelly { constraints: led.into_iter().chain([cluster]).collect(), particles })
    }

    /// Checks all of it but its material and what its mesh says.
    pub(super) fn check(&self, at: &str) -> Checked {
        let refuse = |field: &str, message: &str| Err(SceneError::value(format!("{at}.{field}"), message));
        if let SoftForm::Box(sides) = &self.form {
            sides.to_array().into_iter().try_for_each(|side| above_zero(&format!("{at}.form.box"), side))?;
        }
        for (name, number) in [("scale", self.scale), ("spacing", self.spacing), ("density", self.density)] {
            above_zero(&format!("{at}.{name}"), number)?;
        }
        match (self.frequency, self.give) {
            (Some(_), Some(_)) => return refuse("give", "say either give, in percent, or frequency, in Hz"),
            (None, None) => return refuse("give", "is missing: say give, in percent, or frequency, in Hz"),
            (frequency, give) => {
                above_zero(&format!("{at}.frequency"), frequency.unwrap_or(1.0))?;
                zero_or_more(&format!("{at}.give"), give.unwrap_or(1.0))?;
            }
        }
        let radius = self.radius.unwrap_or(0.0);
        for (name, number) in [("damping", self.damping), ("radius", radius), ("drag", self.drag)] {
            zero_or_more(&format!("{at}.{name}"), number)?;
        }
        for (name, vector) in
            [("position", self.position), ("turn", self.turn), ("velocity", self.velocity), ("spin", self.spin)]
        {
            finite(&format!("{at}.{name}"), &vector.to_array())?;
        }
        for corner in self.held.into_iter().flatten() {
            finite(&format!("{at}.held"), &corner.to_array())?;
        }
        finite(&format!("{at}.elasticity"), &[self.elasticity])?;
        if let Some(message) = self.motion.as_ref().and_then(Motion::fault) {
            return refuse("motion", message);
        }
        if self.motion.is_some() && self.held.is_none() {
            return refuse("motion", "leads what is held; say held, two corners of a box around it");
        }
        Ok(())
    }
}
