//! Materials in scene files: how surfaces and particles look, how they feel, and what becomes of them.

use super::SceneError;
use super::color::shown;
use super::numbers::finite;
use crate::material::{
    self, Blend, ContactMaterial, Curve, Facing, Heading, Life, MaterialList, Over, SpriteMaterial, TrailMaterial,
    Varying,
};
use crate::particles::Color;
use crate::shape::Shape;
use alloc::format;
use alloc::string::String;
use alloc::vec::Vec;

/// How a surface, or a particle, looks. Colours are red, green, blue from 0 to 1; none is below zero.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default, deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Material {
    /// Reflected from ambient light.
    pub ambient: [f32; 3],
    /// Reflected in all directions; the colour of particles.
    pub diffuse: [f32; 3],
    /// Reflected in highlights.
    pub specular: [f32; 3],
    /// Let through: the more of it, the clearer, and where it is zero opaque. What is behind, particles as well, is seen through it without refraction.
    pub transmission: [f32; 3],
    /// Emitted; the colour of particles whose diffuse colour is black.
    pub emission: [f32; 3],
    /// Exponent of the highlights.
    pub shininess: f32,
    /// Index of refraction.
    pub refraction: f32,
    /// The file of a texture.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Option::is_none"))]
    pub texture: Option<String>,
    /// The diameter particles are drawn with \[m\]; zero: that of their radius, or of points one that suits the picture.
    pub size: f32,
    /// How particles are drawn, from 0, a lit ball, to 1, a glow. Balls are as bright however strong the lights are, so that they are seen, and have their
    /// colour where these are not white.
    pub glow: f32,
    /// The picture particles are drawn with; without one they are balls or glows.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Option::is_none"))]
    pub sprite: Option<Sprite>,
    /// The shape particles are drawn as, instead of balls or glows.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Option::is_none"))]
    pub shape: Option<ParticleShape>,
    /// The trail particles leave.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Option::is_none"))]
    pub trail: Option<TrailMaterial>,
    /// How it feels to what touches it.
    #[cfg_attr(feature = "serde", serde(alias = "grip", skip_serializing_if = "ContactMaterial::is_plain"))]
    pub contact: ContactMaterial,
    /// The changes that its particles undergo over their lives.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "LifeBuf::is_plain"))]
    pub life: LifeBuf,
}

impl Default for Material {
    fn default() -> Self {
        Self {
            ambient: [0.2; 3],
            diffuse: [0.5; 3],
            specular: [0.5; 3],
            transmission: [0.0; 3],
            emission: [0.0; 3],
            shininess: 10.0,
            refraction: 1.0,
            texture: None,
            size: 0.0,
            glow: 0.0,
            sprite: None,
            shape: None,
            trail: None,
            contact: ContactMaterial::default(),
            life: LifeBuf::default(),
        }
    }
}

/// The shape that particles are drawn as.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct ParticleShape {
    /// The shape about the particle, in halves of the diameter that the particle is drawn with: a box from −1 to 1 is as wide as that.
    pub form: Shape<String>,
    /// The way it points.
    #[cfg_attr(feature = "serde", serde(default))]
    pub heading: Heading,
}

/// The picture that particles are drawn with.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Sprite {
    /// One of "puff", "flame", "spark", "leaf", "petal", "drop", "snowflake", "ring", or a .png, relative to the scene's file.
    pub picture: String,
    /// The columns and rows of frames that the picture is a flipbook of, read line by line.
    #[cfg_attr(feature = "serde", serde(default = "single"))]
    pub grid: [u8; 2],
    /// Frames a second of a particle's age, again from the first after the last; zero: all of them once over its life.
    #[cfg_attr(feature = "serde", serde(default))]
    pub rate: f32,
    /// How it is laid over what is behind it.
    #[cfg_attr(feature = "serde", serde(default))]
    pub blend: Blend,
    /// The way it faces.
    #[cfg_attr(feature = "serde", serde(default))]
    pub facing: Facing,
}

#[cfg(feature = "serde")]
fn single() -> [u8; 2] {
    [1, 1]
}

impl Sprite {
    /// The pictures that need no file.
    pub const PICTURES: [&'static str; 8] = ["puff", "flame", "spark", "leaf", "petal", "drop", "snowflake", "ring"];

    fn lend(&self) -> SpriteMaterial {
        let [columns, rows] = self.grid.map(u16::from);
        SpriteMaterial { frames: (columns * rows).max(1), rate: self.rate, blend: self.blend, facing: self.facing }
    }

    /// Tells whether it can be used; `at` is where it stands.
    pub(super) fn check(&self, at: &str) -> Result<(), SceneError> {
        let is_file = self.picture.len() > 4 && self.picture.to_ascii_lowercase().ends_with(".png");
        if !is_file && !Self::PICTURES.contains(&&*self.picture) {
            let message = format!("'{}' is none: one of {}, or a .png", self.picture, Self::PICTURES.join(", "));
            return Err(SceneError::value(format!("{at}.picture"), message));
        }
        if self.grid.contains(&0) || !is_file && self.grid != [1, 1] {
            let message = "has to be columns and rows of a .png, each at least 1";
            return Err(SceneError::value(format!("{at}.grid"), message));
        }
        if !(0.0..f32::INFINITY).contains(&self.rate) {
            return Err(SceneError::value(format!("{at}.rate"), "must not be below zero, in frames a second"));
        }
        Ok(())
    }
}

/// The changes that particles undergo over their lives: see [`Life`]. A key is an instant and a value, or for colours
/// three.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default, deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct LifeBuf {
    /// A factor of the diameter they are drawn with.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Option::is_none"))]
    pub size: Option<VaryingBuf<[f32; 2]>>,
    /// Factors of red, green and blue.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Option::is_none"))]
    pub color: Option<VaryingBuf<[f32; 4]>>,
    /// A factor of their opacity, 0 to 1. Without one, those who die of age fade in the last fifth of their lives.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Option::is_none"))]
    pub opacity: Option<VaryingBuf<[f32; 2]>>,
    /// How they are drawn instead of as `glow` says, from 0, a lit ball, to 1, a glow.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Option::is_none"))]
    pub glow: Option<VaryingBuf<[f32; 2]>>,
    /// The angle by which their picture is turned anticlockwise \[rad\].
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Option::is_none"))]
    pub rotation: Option<VaryingBuf<[f32; 2]>>,
    /// A factor of their coefficient of drag.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Option::is_none"))]
    pub drag: Option<VaryingBuf<[f32; 2]>>,
    /// A factor of their mass; what they lose takes its momentum along.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Option::is_none"))]
    pub mass: Option<VaryingBuf<[f32; 2]>>,
    /// The share of their weight that what is around them carries: at 1 they float, beyond it they rise.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Option::is_none"))]
    pub buoyancy: Option<VaryingBuf<[f32; 2]>>,
}

/// A curve, or two between which each particle has its own place.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(
        untagged,
        expecting = "expected [[instant, value], ...], {\"keys\": [...], \"over\": \"life\" or \"seconds\", \"smooth\": true or false}, or {\"between\": [one, other]}"
    )
)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub enum VaryingBuf<K> {
    /// Keys over the life, with straight lines between them.
    Keys(Vec<K>),
    /// A curve.
    Curve(CurveBuf<K>),
    /// Something between two.
    Between(Sides<K>),
}

/// A curve through keys.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct CurveBuf<K> {
    /// An instant and values each, in the order of the instants.
    pub keys: Vec<K>,
    /// The measure of the instants: shares of the life, or seconds.
    #[cfg_attr(feature = "serde", serde(default))]
    pub over: Over,
    /// True if it goes from key to key along cubics that overshoot nothing, instead of straight.
    #[cfg_attr(feature = "serde", serde(default))]
    pub smooth: bool,
}

/// Two curves between which each particle has its own place.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Sides<K> {
    /// The one side and the other.
    pub between: [CurveBuf<K>; 2],
}

impl<const N: usize> CurveBuf<[f32; N]> {
    fn lend(&self) -> Curve<'_, N> {
        Curve { keys: &self.keys, over: self.over, smooth: self.smooth }
    }
}

impl<K> VaryingBuf<K> {
    /// The keys of its curve, or of both.
    pub(super) fn curves(&self) -> impl Iterator<Item = &[K]> {
        let (from, to) = match self {
            Self::Keys(keys) => (keys, None),
            Self::Curve(curve) => (&curve.keys, None),
            Self::Between(Sides { between: [from, to] }) => (&from.keys, Some(&to.keys)),
        };
        core::iter::once(from).chain(to).map(Vec::as_slice)
    }
}

impl<const N: usize> VaryingBuf<[f32; N]> {
    fn lend(&self) -> Varying<'_, N> {
        match self {
            Self::Keys(keys) => Varying { from: Curve { keys, over: Over::Life, smooth: false }, to: None },
            Self::Curve(curve) => Varying { from: curve.lend(), to: None },
            Self::Between(Sides { between: [from, to] }) => Varying { from: from.lend(), to: Some(to.lend()) },
        }
    }
}

impl LifeBuf {
    /// Tells whether there are no changes at all.
    #[must_use]
    pub fn is_plain(&self) -> bool {
        *self == Self::default()
    }

    fn lend(&self) -> Life<'_> {
        fn lent<const N: usize>(curve: Option<&VaryingBuf<[f32; N]>>) -> Option<Varying<'_, N>> {
            curve.map(VaryingBuf::lend)
        }
        Life {
            size: lent(self.size.as_ref()),
            color: lent(self.color.as_ref()),
            opacity: lent(self.opacity.as_ref()),
            glow: lent(self.glow.as_ref()),
            rotation: lent(self.rotation.as_ref()),
            drag: lent(self.drag.as_ref()),
            mass: lent(self.mass.as_ref()),
            buoyancy: lent(self.buoyancy.as_ref()),
        }
    }

    /// The names of the curves that change from key to key over shares of a life.
    pub(super) fn over_lives(&self) -> impl Iterator<Item = &'static str> {
        fn changes<const N: usize>(curve: Option<&VaryingBuf<[f32; N]>>) -> bool {
            let varies = |Curve { keys, over, .. }: Curve<'_, N>| {
                over == Over::Life && keys.windows(2).any(|pair| pair[0][1..] != pair[1][1..])
            };
            curve.map(VaryingBuf::lend).is_some_and(|Varying { from, to }| varies(from) || to.is_some_and(varies))
        }
        let Self { size, color, opacity, glow, rotation, drag, mass, buoyancy } = self;
        let plain = [
            ("size", size),
            ("opacity", opacity),
            ("glow", glow),
            ("rotation", rotation),
            ("drag", drag),
            ("mass", mass),
            ("buoyancy", buoyancy),
        ];
        let plain = plain.into_iter().map(|(name, curve)| (name, changes(curve.as_ref())));
        plain.chain([("color", changes(color.as_ref()))]).filter(|(_, changes)| *changes).map(|(name, _)| name)
    }

    /// Checks that its curves can be used; `at` is where they stand.
    pub(super) fn check(&self, at: &str) -> Result<(), SceneError> {
        const ANY: f32 = f32::MAX;
        let life = self.lend();
        let plain = [
            ("size", life.size, [0.0, ANY]),
            ("opacity", life.opacity, [0.0, 1.0]),
            ("glow", life.glow, [0.0, 1.0]),
            ("rotation", life.rotation, [-ANY, ANY]),
            ("drag", life.drag, [0.0, ANY]),
            ("mass", life.mass, [f32::MIN_POSITIVE, ANY]),
            ("buoyancy", life.buoyancy, [-ANY, ANY]),
        ];
        for (name, curve, range) in plain {
            check_varying(&format!("{at}.{name}"), curve, range)?;
        }
        check_varying(&format!("{at}.color"), life.color, [0.0, ANY])
    }
}

fn check_varying<const N: usize>(at: &str, curve: Option<Varying<'_, N>>, range: [f32; 2]) -> Result<(), SceneError> {
    let Some(Varying { from, to }) = curve else { return Ok(()) };
    check_curve(at, from, range)?;
    to.map_or(Ok(()), |to| check_curve(at, to, range))
}

/// Checks that keys are there, in order, and within a range.
fn check_curve<const N: usize>(at: &str, curve: Curve<'_, N>, [least, most]: [f32; 2]) -> Result<(), SceneError> {
    let refuse = |message| Err(SceneError::value(at, message));
    if curve.keys.is_empty() {
        return refuse("has no keys: [[instant, value], ...]".into());
    }
    for (i, key) in curve.keys.iter().enumerate() {
        finite(at, key)?;
        let instant = key[0];
        if i > 0 && instant < curve.keys[i - 1][0] {
            return refuse(format!(
                "key {i} is at {instant}, before the one in front of it, at {}",
                curve.keys[i - 1][0]
            ));
        }
        if curve.over == Over::Life && !(0.0..=1.0).contains(&instant) {
            return refuse(format!(
                "key {i} is at {instant}, but a life goes from 0 to 1; instants in seconds need \"over\": \"seconds\""
            ));
        }
        if let Some(value) = key[1..].iter().find(|value| !(least..=most).contains(*value)) {
            let meant = match (least, most) {
                (f32::MIN_POSITIVE, _) => "has to be above zero",
                (_, 1.0) => "has to be from 0 to 1",
                _ => "has to be zero or more",
            };
            return refuse(format!("key {i} {meant}, not {value}"));
        }
    }
    Ok(())
}

impl Material {
    /// The colour of particles of this material: diffuse, or emitted where that is black.
    #[must_use]
    pub fn color(&self) -> Color {
        shown(self.diffuse, self.emission)
    }
}

/// A scene's materials, as particles have them.
impl MaterialList for Vec<Material> {
    fn count(&self) -> usize {
        self.len()
    }
    fn get(&self, number: usize) -> Option<material::Material<'_>> {
        let Material { contact, size, glow, sprite, shape, trail, life, .. } = self.as_slice().get(number)?;
        Some(material::Material {
            contact: *contact,
            size: *size,
            glow: *glow,
            sprite: sprite.as_ref().map(Sprite::lend),
            heading: shape.as_ref().map(|shape| shape.heading),
            trail: *trail,
            life: life.lend(),
        })
    }
    fn contact(&self, number: usize) -> ContactMaterial {
        self.as_slice().get(number).map(|material| material.contact).unwrap_or_default()
    }
}
