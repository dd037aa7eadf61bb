//! Ropes in scene files: by their length, weight and stiffness, whatever the number of their segments.

use super::SceneError;
use super::cloth::winds;
use super::numbers::{Checked, above_zero, finite, zero_or_more};
use super::ties::Body;
use super::tuft::{StrandAir, along};
use crate::constrain::{Attach, ConstraintKind, Rope};
use crate::draw::Lock;
use crate::force::{CylinderDrag, ForceKind};
use crate::math::length;
use crate::motion::{Motion, MotionBuf};
use crate::particles::{Color, Particle};
use alloc::format;
use alloc::vec::Vec;
use core::f32::consts::PI;
use glam::Vec3;

/// A rope, string, cable or chain that bends freely. Its particles follow the scene's own and those of cloths, boxes and strands, from one end to
/// the other; those at its ends are half as heavy as the others.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Cord {
    /// The places \[m\] along which it lies to begin with, two or more. Its points lie on that line at equal ways, and it is at rest as long as the straight
    /// segments between them are: a little shorter than the line where that bends.
    #[cfg_attr(feature = "schema", schemars(with = "Vec<[f32; 3]>"))]
    pub curve: Vec<Vec3>,
    /// The number of equal segments, from 1 to 10000; how fine it is divided does not change what it weighs, nor how far it stretches.
    pub segments: u32,
    /// Its thickness \[m\]: what it weighs by its `density`, how stiff it is by `young`, and how thick it is in the air.
    #[cfg_attr(feature = "serde", serde(default = "usual_diameter"))]
    pub diameter: f32,
    /// The mass of a cubic metre \[kg/m³\], the air between its fibres counted in; hemp and nylon rope have some 900, a steel cable 5000.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Option::is_none"))]
    pub density: Option<f32>,
    /// The mass of a metre \[kg/m\], in place of `density`.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Option::is_none"))]
    pub weight: Option<f32>,
    /// Young's modulus of it as a whole \[Pa\]; nylon rope has some 5e8, a steel cable 1e11, rubber 5e6. With neither this nor `stretch` it does not stretch.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Option::is_none"))]
    pub young: Option<f32>,
    /// By how many percent it is longer where it hangs from one end by its own weight on Earth, in place of `young`: ρ g L / (2 E).
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Option::is_none"))]
    pub stretch: Option<f32>,
    /// How long stresses take to fade whose strain stands still \[s\].
    #[cfg_attr(feature = "serde", serde(default))]
    pub damping: f32,
    /// True if it only pulls, and goes slack where its ends come together.
    #[cfg_attr(feature = "serde", serde(default))]
    pub tether: bool,
    /// The points that never move, by their number from 0 to the number of segments.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Vec::is_empty"))]
    pub fixed: Vec<u32>,
    /// How those move; without it they stay.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Option::is_none"))]
    pub motion: Option<MotionBuf>,
    /// What its first and its last point are tied to, or nothing, each at the place where it begins.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "no_ends"))]
    pub ends: [Option<Body>; 2],
    /// How the air pushes it, by its thickness and the angle of attack: that of all `wind` among the scene's forces, or still air. It takes
    /// the place of `drag`.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Option::is_none"))]
    pub air: Option<StrandAir>,
    /// Coefficient of linear drag of each metre \[kg/(s m)\].
    #[cfg_attr(feature = "serde", serde(default))]
    pub drag: f32,
    /// How it moves to begin with \[m/s\].
    #[cfg_attr(feature = "serde", serde(default))]
    #[cfg_attr(feature = "schema", schemars(with = "[f32; 3]"))]
    pub velocity: Vec3,
    /// The share of the normal speed that it keeps when it hits something.
    #[cfg_attr(feature = "serde", serde(default))]
    pub elasticity: f32,
    /// Number of the material in the scene, if it has one.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Option::is_none"))]
    pub material: Option<u16>,
    /// Its colour; without one, that of its material.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Option::is_none"))]
    pub color: Option<Color>,
    /// How wide it is drawn \[m\]; zero: as thick as it is.
    #[cfg_attr(feature = "serde", serde(default))]
    pub width: f32,
}

#[cfg(feature = "serde")]
const fn usual_diameter() -> f32 {
    0.01
}

#[cfg(feature = "serde")]
fn no_ends(ends: &[Option<Body>; 2]) -> bool {
    ends.iter().all(Option::is_none)
}

/// Standard gravity \[m/s²\].
const EARTH: f32 = 9.80665;

/// How long the links between places are \[m\].
fn links(places: &[Vec3]) -> Vec<f32> {
    places.windows(2).map(|ends| length(ends[1] - ends[0])).collect()
}

/// What a rope is made into.
pub(super) struct Laid {
    pub(super) particles: Vec<Particle>,
    pub(super) constraints: Vec<ConstraintKind>,
    pub(super) lock: Lock,
}

impl Cord {
    /// The number of its particles.
    #[must_use]
    pub fn particles(&self) -> u64 {
        u64::from(self.segments) + 1
    }

    /// Where its points are.
    fn places(&self) -> Vec<Vec3> {
        along(&self.curve, self.segments)
    }

    /// The mass of a metre \[kg/m\].
    fn by_metre(&self) -> f32 {
        let area = 0.25 * PI * self.diameter * self.diameter;
        self.weight.unwrap_or(self.density.unwrap_or(0.0) * area)
    }

    /// The mass of all of it \[kg\].
    pub(super) fn mass(&self) -> f32 {
        self.by_metre() * self.curve.windows(2).map(|ends| length(ends[1] - ends[0])).sum::<f32>()
    }

    /// The force that would stretch it to twice its length at rest \[N\], which is so many metres; without one it does not stretch.
    fn stiffness(&self, whole: f32) -> Option<f32> {
        let hung = |percent: f32| 0.5 * self.by_metre() * EARTH * whole / (0.01 * percent);
        let young = self.young.map(|young| young * 0.25 * PI * self.diameter * self.diameter);
        young.or_else(|| self.stretch.filter(|&percent| percent > 0.0).map(hung))
    }

    /// How far each link of a rope so long at rest \[m\] gives way \[m/N\], and what brakes that \[N s/m\].
    fn give(&self, whole: f32) -> [f32; 2] {
        // What is drawn around a corner is shorter; all links have one compliance, and together that of the whole.
        let segment = whole / self.segments as f32;
        let compliance = self.stiffness(whole).map_or(0.0, |stiffness| segment / stiffness);
        [compliance, if compliance > 0.0 { self.damping / compliance } else { 0.0 }]
    }

    /// Its particles and what binds them, the first having number `first` in the scene's start.
    pub(super) fn make(&self, first: u32) -> Laid {
        let places = self.places();
        let lengths = links(&places);
        let share = |i: usize| {
            let link = |i: Option<usize>| i.and_then(|i| lengths.get(i)).copied().unwrap_or(0.0);
            0.5 * (link(i.checked_sub(1)) + link(Some(i)))
        };
        let particle = |(i, &position): (usize, &Vec3)| Particle {
            position,
            velocity: self.velocity,
            mass: self.by_metre() * share(i),
            drag: self.drag * share(i),
            elasticity: self.elasticity,
            material: self.material,
            fixed: self.fixed.contains(&(i as u32)),
            color: self.color,
            ..Particle::REST
        };
        let particles: Vec<Particle> = places.iter().enumerate().map(particle).collect();
        let points = particles.len() as u32;
        let [compliance, damping] = self.give(lengths.iter().sum());
        let all = (first..first + points).collect();
        let rope = Rope { compliance, damping, tether: self.tether, ..Rope::rigid(all, lengths) };
        let held = self.fixed.iter().map(|&point| first + point).collect();
        let led = self.motion.clone().map(|motion| ConstraintKind::Attach(Attach { particles: held, motion }));
        let constraints = led.into_iter().chain([ConstraintKind::Rope(rope)]).collect();
        let width = if self.width > 0.0 { self.width } else { self.diameter };
        Laid { particles, constraints, lock: Lock { first, points, count: 1, width } }
    }

    /// The push of the air on what it is made into.
    pub(super) fn air_drag(&self, lock: &Lock, forces: &[ForceKind]) -> Option<ForceKind> {
        let StrandAir { diameter, density, viscosity, friction } = self.air?;
        let segments = (lock.first..lock.first + lock.points - 1).map(|point| [point, point + 1]).collect();
        let (field, diameter) = (winds(forces), diameter.unwrap_or(self.diameter));
        Some(ForceKind::CylinderDrag(CylinderDrag { segments, field, diameter, density, viscosity, friction }))
    }

    /// Checks all of it but its material and what its ends are tied to.
    pub(super) fn check(&self, at: &str) -> Checked {
        let refuse = |field: &str, message: &str| Err(SceneError::value(format!("{at}.{field}"), message));
        if !(1..=10_000).contains(&self.segments) {
            return refuse("segments", &format!("has to be from 1 to 10000, not {}", self.segments));
        }
        finite(&format!("{at}.curve"), &self.curve.iter().flat_map(Vec3::to_array).collect::<Vec<_>>())?;
        let way: f32 = links(&self.curve).iter().sum();
        if !(way > 0.0 && way.is_finite()) {
            return refuse("curve", "has to lead through two places at least that are not the same");
        }
        let whole: f32 = links(&self.places()).iter().sum();
        if !(whole > 0.0) {
            return refuse("segments", "has to be more: all points would lie in one place of a curve that leads back");
        }
        match (self.density, self.weight) {
            (Some(_), Some(_)) => return refuse("weight", "say either weight, in kg/m, or density, in kg/m³"),
            (None, None) => return refuse("density", "is missing: say density, in kg/m³, or weight, in kg/m"),
            (density, weight) => {
                above_zero(&format!("{at}.density"), density.unwrap_or(1.0))?;
                above_zero(&format!("{at}.weight"), weight.unwrap_or(1.0))?;
            }
        }
        if self.young.is_some() && self.stretch.is_some() {
            return refuse("stretch", "say either stretch, in percent, or young, in Pa");
        }
        above_zero(&format!("{at}.young"), self.young.unwrap_or(1.0))?;
        above_zero(&format!("{at}.diameter"), self.diameter)?;
        let stretch = self.stretch.unwrap_or(0.0);
        for (name, number) in
            [("stretch", stretch), ("damping", self.damping), ("drag", self.drag), ("width", self.width)]
        {
            zero_or_more(&format!("{at}.{name}"), number)?;
        }
        if let Some(air) = &self.air {
            air.check(at, self.drag)?;
        }
        let [compliance, brake] = self.give(whole);
        if compliance.is_finite() && !brake.is_finite() {
            return refuse("damping", "is more than 32-bit floats can tell for so stiff a rope; take less");
        }
        if !compliance.is_finite() {
            let field = if self.young.is_some() { "young" } else { "stretch" };
            let than = if field == "young" { "more" } else { "less" };
            let message = format!("makes it softer than 32-bit floats can tell; take {than}, or a heavier rope");
            return refuse(field, &message);
        }
        finite(&format!("{at}.elasticity"), &[self.elasticity])?;
        finite(&format!("{at}.velocity"), &self.velocity.to_array())?;
        self.check_held(at)
    }

    /// Checks what leads it, which of its points are fixed, and that nothing else holds these.
    fn check_held(&self, at: &str) -> Checked {
        let refuse = |field: &str, message: &str| Err(SceneError::value(format!("{at}.{field}"), message));
        if let Some(message) = self.motion.as_ref().and_then(Motion::fault) {
            return refuse("motion", message);
        }
        if let Some(number) = self.fixed.iter().find(|&&number| number > self.segments) {
            return refuse("fixed", &format!("point {number} is out of range; the last is {}", self.segments));
        }
        for (i, end) in [0, self.segments].into_iter().enumerate() {
            if self.ends[i].is_some() && self.fixed.contains(&end) {
                return refuse("ends", &format!("point {end} is fixed, so nothing else can hold it; say either"));
            }
        }
        Ok(())
    }
}
