//! The declared scene: everything that a scene file says, in the engine's own types.

use super::{BodyTie, Boxes, Cloth, Cord, Fog, Material, PeriodicRoom, Response, Sky, SoftBody, Tuft};
use crate::constrain::ConstraintKind;
use crate::custom::CustomBuf;
use crate::draw::StrandLight;
use crate::emit::Emitter;
use crate::force::{ForceKind, Goal, Sink, Spring};
use crate::index::Structure;
use crate::integrate::{Method, Tuning};
use crate::motion::MotionBuf;
use crate::particles::Particle;
use crate::rays;
use crate::reap::ReaperKind;
use crate::shape::Shape;
use alloc::string::String;
use alloc::vec::Vec;
use glam::Vec3;

/// Everything that a scene file says. Meshes are named by file, relative to the scene's.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default, deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct SceneFile {
    /// Where the schema of this format lies, for editors.
    #[cfg_attr(feature = "serde", serde(rename = "$schema", skip_serializing_if = "Option::is_none"))]
    pub schema: Option<String>,
    /// A description of what it shows, for people.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "String::is_empty"))]
    pub about: String,
    /// How it is run unless the command line says otherwise.
    pub run: Run,
    /// The room that it all happens in, if its opposite sides are one; without it space has no end.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Option::is_none"))]
    pub room: Option<PeriodicRoom>,
    /// The particles it begins with; springs name them by their place here, from 0.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Vec::is_empty"))]
    pub particles: Vec<Particle>,
    /// Springs between them.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Vec::is_empty"))]
    pub springs: Vec<Spring>,
    /// Sheets and meshes of springs, whose particles and springs follow those above.
    #[cfg_attr(feature = "serde", serde(alias = "fabrics", skip_serializing_if = "Vec::is_empty"))]
    pub cloths: Vec<Cloth>,
    /// Rigid boxes and other convex bodies, whose particles follow those above.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Vec::is_empty"))]
    pub boxes: Vec<Boxes>,
    /// Hair, grass, wires: elastic strands, whose particles follow those above.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Vec::is_empty"))]
    pub strands: Vec<Tuft>,
    /// Ropes, strings, cables, which bend freely and whose particles follow those above.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Vec::is_empty"))]
    pub ropes: Vec<Cord>,
    /// Jellies: boxes and closed meshes filled with particles that give way, which follow those above.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Vec::is_empty"))]
    pub soft_bodies: Vec<SoftBody>,
    /// Points of some of these bodies that are tied to the surfaces of others.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Vec::is_empty"))]
    pub ties: Vec<BodyTie>,
    /// Emitters, which bring further particles into the world.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Vec::is_empty"))]
    pub emitters: Vec<Emitter<Shape<String>, Option<MotionBuf>>>,
    /// The forces on all of them, in this order.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Vec::is_empty"))]
    pub forces: Vec<ForceKind>,
    /// How those that have a radius answer each other's touch; without it they pass through each other.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Option::is_none"))]
    pub contacts: Option<Response>,
    /// Constraints that bind them, in this order, before contacts by position.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Vec::is_empty"))]
    pub constraints: Vec<ConstraintKind>,
    /// Sinks, which pull them, after the forces, and remove those that touch them.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Vec::is_empty"))]
    pub sinks: Vec<Sink<String>>,
    /// Goals, which lead them to places of surfaces by a given time.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Vec::is_empty"))]
    pub goals: Vec<Goal<String>>,
    /// Reapers: the other rules by which they die, beside age and sinks.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Vec::is_empty"))]
    pub reapers: Vec<ReaperKind>,
    /// The numbers with names that each particle has beside the engine's own attributes.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Vec::is_empty"))]
    pub custom: Vec<CustomBuf>,
    /// The things that they bounce off and that are drawn.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Vec::is_empty"))]
    pub scenery: Vec<Item>,
    /// Transforms that parts of the scenery share.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Vec::is_empty"))]
    pub groups: Vec<Group>,
    /// Materials; others name them by their place here, from 0.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Vec::is_empty"))]
    pub materials: Vec<Material>,
    /// Lights; without any, two directional ones.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Vec::is_empty"))]
    pub lights: Vec<Light>,
    /// The camera; without one, it looks down −z at the scene from three radii away.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Option::is_none"))]
    pub camera: Option<Camera>,
    /// Light from everywhere: red, green, blue.
    pub ambient: [f32; 3],
    /// The colour behind everything; a dark one is drawn somewhat lighter toward the bottom of the picture. A `sky` of three like colours is even.
    pub background: [f32; 3],
    /// A background by elevation, in place of that colour.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Option::is_none"))]
    pub sky: Option<Sky>,
    /// Fog between the eye and what it sees; without it the air is clear.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Option::is_none"))]
    pub fog: Option<Fog>,
}

/// How a scene is run.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default, deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Run {
    /// How long \[s\].
    pub duration: f64,
    /// The step \[s\].
    pub dt: f64,
    /// Parts that each step is cut into for the method and the constraints, from 1 to 1000. Contacts by position ask for their
    /// own; the greater number counts.
    pub substeps: u32,
    /// The method.
    pub integrator: Method,
    /// The settings of adaptive and implicit methods.
    pub tuning: Tuning,
    /// How forces find the neighbours of a particle.
    pub index: Structure,
    /// How paths find what they run into among the triangles of a mesh.
    pub collision_index: rays::Structure,
    /// How often a particle may bounce in one sub-step before it waits for its end, from 1 to 10000. What slides within a
    /// surface that curves hops along it by chords, about 35 where it goes a fifteenth of its radius. By `impulse` it may meet others half as often.
    pub max_bounces: u32,
    /// The seed of all randomness.
    pub seed: u64,
    /// Particles alive at once: births beyond it are refused and counted. What the scene begins with has room in any case.
    pub capacity: u32,
}

/// A piece of scenery. All but lines are solid.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Item {
    /// Its shape.
    pub shape: Shape<String>,
    /// Its material; without one, that of its group or the next group around with one.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Option::is_none"))]
    pub material: Option<u16>,
    /// The group whose transform applies, by its place in the list of groups.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Option::is_none"))]
    pub group: Option<u32>,
    /// How it moves; without one it stands still.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Option::is_none"))]
    pub motion: Option<MotionBuf>,
}

/// A transform of scenery, inside another if it has a parent. (A flat list: nesting has no depth that could overflow.)
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Group {
    /// The rows of a 4×4 matrix; its last row has to be 0 0 0 1, and its inverse has to exist.
    pub matrix: [[f32; 4]; 4],
    /// The material of what stands inside and names none.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Option::is_none"))]
    pub material: Option<u16>,
    /// The group it stands in: an earlier one.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Option::is_none"))]
    pub parent: Option<u32>,
}

/// A light. Colours are red, green, blue; attenuation is ca, la, qa of 1 / (ca + la d + qa d²).
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "snake_case"))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub enum Light {
    /// From infinitely far.
    Directional {
        /// Colour.
        color: [f32; 3],
        /// The direction it shines in.
        direction: [f32; 3],
    },
    /// From a point.
    Point {
        /// Colour.
        color: [f32; 3],
        /// Where \[m\].
        position: [f32; 3],
        /// ca, la, qa.
        attenuation: [f32; 3],
    },
    /// From a point into a cone.
    Spot {
        /// Colour.
        color: [f32; 3],
        /// Where \[m\].
        position: [f32; 3],
        /// The middle of the cone.
        direction: [f32; 3],
        /// ca, la, qa.
        attenuation: [f32; 3],
        /// Half angle of the cone \[rad\].
        cutoff: f32,
        /// Exponent of the fall toward its edge.
        dropoff: f32,
    },
    /// From a disc.
    Area {
        /// Colour.
        color: [f32; 3],
        /// Its middle \[m\].
        position: [f32; 3],
        /// Its normal.
        direction: [f32; 3],
        /// Its radius \[m\].
        radius: f32,
        /// ca, la, qa.
        attenuation: [f32; 3],
    },
}

/// From where and how the scene is seen.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default, deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Camera {
    /// Where it stands \[m\].
    pub eye: [f32; 3],
    /// The direction it looks in.
    pub towards: [f32; 3],
    /// A direction that shall be up in the picture.
    pub up: [f32; 3],
    /// Half the horizontal angle it sees \[rad\], above zero and below π / 2.
    pub xfov: f32,
    /// Nothing nearer is seen \[m\]; zero or more.
    pub near: f32,
    /// Nothing farther is seen \[m\]; more than `near`.
    pub far: f32,
    /// How long its shutter is open before the instant of a picture \[s\], at most as long as pictures lie apart; what moves is drawn
    /// along its way of that time. Without one, films draw particles as they are then, with faint traces behind them.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Option::is_none"))]
    pub shutter: Option<f32>,
}

impl SceneFile {
    /// The number of sub-steps that a step is cut into: those of the run, or of contacts by position where these are more.
    pub(super) fn substeps(&self) -> u32 {
        self.run.substeps.max(self.contacts.map_or(1, |response| response.substeps()))
    }

    /// A scene that says nothing.
    #[must_use]
    pub fn new() -> Self {
        Self {
            schema: None,
            about: String::new(),
            run: Run::default(),
            room: None,
            particles: Vec::new(),
            springs: Vec::new(),
            cloths: Vec::new(),
            boxes: Vec::new(),
            strands: Vec::new(),
            ropes: Vec::new(),
            soft_bodies: Vec::new(),
            ties: Vec::new(),
            emitters: Vec::new(),
            forces: Vec::new(),
            contacts: None,
            constraints: Vec::new(),
            sinks: Vec::new(),
            goals: Vec::new(),
            reapers: Vec::new(),
            custom: Vec::new(),
            scenery: Vec::new(),
            groups: Vec::new(),
            materials: Vec::new(),
            lights: Vec::new(),
            camera: None,
            ambient: [0.0; 3],
            background: [0.0; 3],
            sky: None,
            fog: None,
        }
    }

    /// The light on strands for an eye at a place \[m\]: the first of the scene's lights that comes from far away, or one from above where there
    /// is none, and what there is of it everywhere.
    #[must_use]
    pub fn light_on_strands(&self, eye: Vec3) -> StrandLight {
        let far = self.lights.iter().find_map(|light| match light {
            Light::Directional { direction, .. } => Some(Vec3::from_array(*direction)),
            _ => None,
        });
        let ambient = (self.ambient.iter().sum::<f32>() / 3.0).clamp(0.0, 1.0);
        StrandLight { direction: far.unwrap_or(Vec3::new(-0.4, -0.7, -0.8)), eye, ambient, gloss: 0.25 }
    }
}

impl Default for SceneFile {
    fn default() -> Self {
        Self::new()
    }
}

impl Default for Run {
    fn default() -> Self {
        Self {
            duration: 10.0,
            dt: 1.0 / 60.0,
            substeps: 1,
            integrator: Method::Rk4,
            tuning: Tuning::DEFAULT,
            index: Structure::Grid,
            collision_index: rays::Structure::Bvh,
            max_bounces: 64,
            seed: 1,
            capacity: 65_536,
        }
    }
}

impl Default for Camera {
    fn default() -> Self {
        Self {
            eye: [0.0; 3],
            towards: [0.0, 0.0, -1.0],
            up: [0.0, 1.0, 0.0],
            xfov: 0.25,
            near: 0.01,
            far: 1000.0,
            shutter: None,
        }
    }
}
