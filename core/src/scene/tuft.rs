//! Strands in scene files: hair and grass that grow on a surface, wires and cables along curves.

use super::Body;
use super::cloth::winds;
#[cfg(feature = "serde")]
use super::numbers::usual_poisson;
use crate::constrain::{Attach, ConstraintKind, StrandParams, Strands};
use crate::draw::Lock;
use crate::force::{CylinderDrag, ForceKind};
use crate::math::{frame, length, sin_cos, sqrt, unit};
use crate::motion::MotionBuf;
use crate::particles::{Color, Particle};
use crate::rng::Stream;
use crate::shape::{MeshBuf, Shape, Surface};
use alloc::boxed::Box;
use alloc::string::String;
use alloc::sync::Arc;
use alloc::vec::Vec;
use core::f32::consts::{PI, TAU};
use glam::Vec3;

/// Round elastic strands, many alike, at rest in the form in which they begin. Their particles follow the scene's own and those of cloths and
/// boxes, each strand from its root to its tip.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Tuft {
    /// Where they are.
    pub form: Growth,
    /// The number of equal segments of each, from 1 to 10000; how fine it is divided does not change what it does.
    pub segments: u32,
    /// The radius of a strand \[m\]; hair has 4e-5.
    pub radius: f32,
    /// Young's modulus \[Pa\]; hair has 4e9, steel 2e11, rubber 5e6.
    pub young: f32,
    /// Poisson's ratio, from 0 to 0.5: it says how stiff it is against being twisted.
    #[cfg_attr(feature = "serde", serde(default = "usual_poisson"))]
    pub poisson: f32,
    /// The mass of a cubic metre \[kg/m³\]; hair has 1300.
    pub density: f32,
    /// How long stresses take to fade whose strain stands still \[s\].
    #[cfg_attr(feature = "serde", serde(default))]
    pub damping: f32,
    /// The points of a curve that never move, by their number from 0; of strands that grow on a surface the roots never do.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Vec::is_empty"))]
    pub fixed: Vec<u32>,
    /// True if the first and the last segment do not turn about themselves, though their ends are free to move.
    #[cfg_attr(feature = "serde", serde(default))]
    pub held: [bool; 2],
    /// How fast the first and the last segment are turned about themselves \[rad/s\], right-handed about the direction from the root to the tip. It takes an
    /// end that is `held`, or clamped by two neighbours that are fixed; of strands that grow on a surface the roots are.
    #[cfg_attr(feature = "serde", serde(default))]
    pub turning: [f32; 2],
    /// How the roots, and all that is fixed, move; without it they stay.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Option::is_none"))]
    pub motion: Option<MotionBuf>,
    /// The body to whose surface the roots, and all that is fixed, are tied in place of being fixed, each where it begins: hair on a cloth.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Option::is_none"))]
    pub attach: Option<Body>,
    /// How the air pushes it, by its thickness and the angle of attack: that of all `wind` among the scene's forces, or still air. It takes
    /// the place of `drag`.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Option::is_none"))]
    pub air: Option<StrandAir>,
    /// Coefficient of linear drag of each metre \[kg/(s m)\], the same across and along; fine hair in air has about 1e-4.
    #[cfg_attr(feature = "serde", serde(default))]
    pub drag: f32,
    /// The share of the normal speed that they keep when they hit something.
    #[cfg_attr(feature = "serde", serde(default))]
    pub elasticity: f32,
    /// Number of the material in the scene, if they have one.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Option::is_none"))]
    pub material: Option<u16>,
    /// Their colours, one after the other and again from the first; without any, that of their material.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Vec::is_empty"))]
    pub colors: Vec<Color>,
    /// How wide they are drawn \[m\]; zero: as wide as they are. One strand may stand for a lock of many.
    #[cfg_attr(feature = "serde", serde(default))]
    pub width: f32,
}

/// Air around strands: see [`CylinderDrag`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default, deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct StrandAir {
    /// How thick a strand is in the wind \[m\]; without it twice its radius. A lock of many may be thicker than one strand of it.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Option::is_none"))]
    pub diameter: Option<f32>,
    /// Its density \[kg/m³\].
    pub density: f32,
    /// Its dynamic viscosity \[Pa s\].
    pub viscosity: f32,
    /// The coefficient of friction of fast flow along a strand.
    pub friction: f32,
}

impl Default for StrandAir {
    fn default() -> Self {
        let CylinderDrag { density, viscosity, friction, .. } = CylinderDrag::still((), 0.0);
        Self { diameter: None, density, viscosity, friction }
    }
}

/// Where strands are.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "snake_case"))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub enum Growth {
    /// One strand along a line through these places \[m\], in equal segments.
    Curve(#[cfg_attr(feature = "schema", schemars(with = "Vec<[f32; 3]>"))] Vec<Vec3>),
    /// Many that grow on a surface.
    On(Box<Field>),
}

/// Strands that grow on a surface, each clamped at its root, which two fixed points hold, one of them a segment beneath.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Field {
    /// The surface.
    pub shape: Shape<String>,
    /// Two corners of a box in which their roots are; without it these are anywhere on the surface \[m\].
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Option::is_none"))]
    #[cfg_attr(feature = "schema", schemars(with = "Option<[[f32; 3]; 2]>"))]
    pub within: Option<[Vec3; 2]>,
    /// How many there are.
    pub count: u32,
    /// How long they are, along the strand \[m\].
    pub length: f32,
    /// What is added to the unit normal of the surface to find the direction in which they grow.
    #[cfg_attr(feature = "serde", serde(default))]
    #[cfg_attr(feature = "schema", schemars(with = "[f32; 3]"))]
    pub lean: Vec3,
    /// How much that differs by chance along each axis, evenly between less and more.
    #[cfg_attr(feature = "serde", serde(default))]
    pub spread: f32,
    /// Curls: the radius of the coils at rest, and the way along them from one to the next \[m\].
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Option::is_none"))]
    pub curl: Option<Curl>,
    /// Another number makes other places.
    #[cfg_attr(feature = "serde", serde(default))]
    pub seed: u32,
}

/// A strand that is coiled at rest.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Curl {
    /// The radius of its coils \[m\].
    pub radius: f32,
    /// The way from one coil to the next along their axis \[m\].
    pub pitch: f32,
}

/// How often a place outside the box is tried again.
const TRIES: u32 = 64;

/// What a tuft is made into.
pub(super) struct Grown {
    pub(super) particles: Vec<Particle>,
    pub(super) constraints: Vec<ConstraintKind>,
    pub(super) lock: Lock,
    /// What is fixed, or would be if it was not attached.
    pub(super) roots: Vec<u32>,
}

impl Tuft {
    /// The number of particles that it makes at the most.
    #[must_use]
    pub fn particles(&self) -> u64 {
        let segments = u64::from(self.segments);
        match &self.form {
            Growth::Curve(_) => segments + 1,
            Growth::On(field) => u64::from(field.count).saturating_mul(segments + 2),
        }
    }

    /// Its particles and what binds them, the first having number `first` in the scene's start; `shape` is that on which it grows.
    pub(super) fn make(&self, shape: Option<&Shape<Arc<MeshBuf>>>, first: u32) -> Grown {
        let strands: Vec<Vec<Vec3>> = match (&self.form, shape) {
            (Growth::Curve(places), _) => alloc::vec![along(places, self.segments)],
            (Growth::On(field), Some(shape)) => {
                field.roots(shape).map(|root| field.grow(root, self.segments)).collect()
            }
            (Growth::On(_), None) => Vec::new(),
        };
        let roots = if matches!(self.form, Growth::On(_)) { &[0, 1][..] } else { &self.fixed };
        let points = strands.first().map_or(0, Vec::len) as u32;
        let mut particles = Vec::with_capacity(strands.len() * points as usize);
        let mut fixed = Vec::new();
        for (number, places) in strands.iter().enumerate() {
            let color = (!self.colors.is_empty()).then(|| self.colors[number % self.colors.len()]);
            for (i, &position) in places.iter().enumerate() {
                let edge = |a: usize, b: usize| match (places.get(a), places.get(b)) {
                    (Some(&a), Some(&b)) => length(b - a),
                    _ => 0.0,
                };
                let share = 0.5 * (edge(i.wrapping_sub(1), i) + edge(i, i + 1));
                let is_root = roots.contains(&(i as u32));
                if is_root {
                    fixed.push(first + particles.len() as u32);
                }
                particles.push(Particle {
                    position,
                    mass: self.density * PI * self.radius * self.radius * share,
                    drag: self.drag * share,
                    elasticity: self.elasticity,
                    material: self.material,
                    fixed: is_root && self.attach.is_none(),
                    color,
                    ..Particle::REST
                });
            }
        }
        let params =
            StrandParams { damping: self.damping, ..StrandParams::round(self.radius, self.young, self.poisson) };
        let all = (first..first + particles.len() as u32).collect();
        let led = |motion| ConstraintKind::Attach(Attach { particles: fixed.clone(), motion });
        let attached = self.motion.clone().map(led);
        let bound = Strands { held: self.held, turning: self.turning, ..Strands::of(all, alloc::vec![points], params) };
        let strands_of = ConstraintKind::Strands(bound);
        let width = if self.width > 0.0 { self.width } else { 2.0 * self.radius };
        let lock = Lock { first, points, count: strands.len() as u32, width };
        Grown { particles, constraints: attached.into_iter().chain([strands_of]).collect(), lock, roots: fixed }
    }

    /// Tells whether an end, the root or the tip, is clamped by two neighbours that are fixed.
    pub(super) fn is_clamped(&self, end: usize) -> bool {
        let is_fixed = |number: u32| self.fixed.contains(&number);
        match (&self.form, end) {
            _ if self.attach.is_some() => false,
            (Growth::On(_), _) => end == 0,
            (Growth::Curve(_), 0) => is_fixed(0) && is_fixed(1),
            (Growth::Curve(_), _) => is_fixed(self.segments) && is_fixed(self.segments.saturating_sub(1)),
        }
    }

    /// The push of the air on what it is made into: on all segments but those beneath the surface on which it grows.
    pub(super) fn air_drag(&self, lock: &Lock, forces: &[ForceKind]) -> Option<ForceKind> {
        let StrandAir { diameter, density, viscosity, friction } = self.air?;
        let hidden = u32::from(matches!(self.form, Growth::On(_)));
        let strands = (0..lock.count).map(|number| lock.first + number * lock.points);
        let segments = strands.flat_map(|root| (root + hidden..root + lock.points - 1).map(|point| [point, point + 1]));
        let (segments, diameter) = (segments.collect(), diameter.unwrap_or(2.0 * self.radius));
        let field = winds(forces);
        Some(ForceKind::CylinderDrag(CylinderDrag { segments, field, diameter, density, viscosity, friction }))
    }
}

impl Field {
    /// Where each begins and in what direction it grows, and a number of its own.
    fn roots<'a>(&'a self, shape: &'a Shape<Arc<MeshBuf>>) -> impl Iterator<Item = (Vec3, Vec3, f32)> + 'a {
        (0..self.count).filter_map(move |number| {
            let stream = Stream::new(u64::from(self.seed), u32::MAX - 1, number);
            let inside = |place: Vec3| {
                self.within.is_none_or(|[a, b]| place.cmpge(a.min(b)).all() && place.cmple(a.max(b)).all())
            };
            let spots = (0..TRIES).map(|attempt| {
                let ([x, y], [z, _]) = (stream.units(2 * attempt + 4), stream.units(2 * attempt + 5));
                shape.sample([x, y, z])
            });
            let spot = spots.into_iter().find(|spot| inside(spot.point))?;
            let ([x, y], [z, phase]) = (stream.units(0), stream.units(1));
            let way = spot.normal + self.lean + (Vec3::new(x, y, z) * 2.0 - 1.0) * self.spread;
            let direction = unit(way);
            Some((spot.point, if direction == Vec3::ZERO { spot.normal } else { direction }, phase))
        })
    }

    /// The points of a strand, the first a segment beneath its root.
    fn grow(&self, (root, direction, phase): (Vec3, Vec3, f32), segments: u32) -> Vec<Vec3> {
        let segment = self.length / segments as f32;
        let (first, second) = frame(direction);
        let Curl { radius, pitch } = self.curl.unwrap_or(Curl { radius: 0.0, pitch: 1.0 });
        // The length of a coil, and where on it the strand begins.
        let coil = sqrt(pitch * pitch + (TAU * radius) * (TAU * radius));
        let around = |far: f32| {
            let (sin, cos) = sin_cos((far / coil + phase) * TAU);
            (first * cos + second * sin) * radius
        };
        let place = |i: u32| {
            let far = segment * i as f32;
            root + direction * (far * pitch / coil) + around(far) - around(0.0)
        };
        core::iter::once(root - direction * segment).chain((0..=segments).map(place)).collect()
    }
}

/// Places at equal ways along a line through others.
pub(super) fn along(places: &[Vec3], segments: u32) -> Vec<Vec3> {
    let way: f32 = places.windows(2).map(|ends| length(ends[1] - ends[0])).sum();
    let place = |i: u32| {
        let mut rest = way * (i as f32 / segments as f32);
        for ends in places.windows(2) {
            let far = length(ends[1] - ends[0]);
            if rest < far {
                return ends[0] + (ends[1] - ends[0]) * (rest / far);
            }
            rest -= far;
        }
        places.last().copied().unwrap_or(Vec3::ZERO)
    };
    (0..=segments).map(place).collect()
}
