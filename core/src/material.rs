//! Materials of particles and surfaces: their feel to what touches them, and the looks and properties of particles over their lives.

use crate::composed::stands_for;
use crate::force::Friction;
use crate::math::{max, sqrt};
use crate::memory::{Layout, Slices};
use crate::time::Time;
use core::ops::Range;
use glam::Vec3;

pub use crate::curve::{Age, Curve, Over, Varying};

/// How a material feels to what touches it.
///
/// Where two things touch, the coefficients that count are the geometric means of theirs; a side that says nothing
/// leaves it to the other, and where neither does there is no friction. A particle always has an elasticity of its own.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default, deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct ContactMaterial {
    /// The share of the normal speed that a particle keeps in a hit, 0 to 1.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Option::is_none"))]
    pub elasticity: Option<f32>,
    /// Dry friction.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Option::is_none"))]
    pub friction: Option<Friction>,
}

impl ContactMaterial {
    /// Tells whether it says nothing.
    #[must_use]
    pub fn is_plain(&self) -> bool {
        *self == Self::default()
    }

    /// Tells whether its numbers can be used: an elasticity from 0 to 1, coefficients of friction from 0 on.
    #[must_use]
    pub fn is_sound(&self) -> bool {
        self.fault().is_none()
    }

    /// The first number that cannot be used: which, what it is, and what it has to be.
    pub(crate) fn fault(&self) -> Option<(&'static str, f32, &'static str)> {
        let elasticity = self.elasticity.unwrap_or(0.0);
        if !(0.0..=1.0).contains(&elasticity) {
            return Some(("elasticity", elasticity, "has to be from 0 to 1"));
        }
        let Friction { static_, kinetic } = self.friction.unwrap_or(Friction::NONE);
        [("friction.static", static_), ("friction.kinetic", kinetic)]
            .into_iter()
            .find(|(_, mu)| !(0.0..f32::INFINITY).contains(mu))
            .map(|(name, mu)| (name, mu, "has to be zero or more"))
    }
}

/// A material.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Material<'a> {
    /// How it feels to what touches it.
    pub contact: ContactMaterial,
    /// The diameter that particles of it are drawn with \[m\]; zero: that of their radius.
    pub size: f32,
    /// How they are drawn, from 0, a lit ball, to 1, a glow.
    pub glow: f32,
    /// The picture they are drawn with; none: a ball or a glow.
    pub sprite: Option<SpriteMaterial>,
    /// The way the shape points that they are drawn as; none: they have no shape of their own.
    pub heading: Option<Heading>,
    /// The trail they leave; none: none.
    pub trail: Option<TrailMaterial>,
    /// Their lives, as curves.
    pub life: Life<'a>,
}

/// How particles are drawn with a picture: a flipbook of one frame or several.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpriteMaterial {
    /// Frames that the picture has, at least 1.
    pub frames: u16,
    /// Frames a second of a particle's age, again from the first after the last; zero: all of them once over its life.
    pub rate: f32,
    /// How it is laid over what is behind it.
    pub blend: Blend,
    /// The way it faces.
    pub facing: Facing,
}

/// How a picture is laid over what is behind it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "snake_case"))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub enum Blend {
    /// It covers by its opacity, the farthest first.
    #[default]
    Alpha,
    /// The same, its colours having been multiplied by the opacity before: what has light and no opacity adds light.
    Premultiplied,
    /// Its light is added, in any order.
    Additive,
    /// It covers altogether where its opacity is a half or more, and nothing elsewhere.
    Opaque,
}

/// The way a picture faces.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "snake_case"))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub enum Facing {
    /// Toward the eye.
    #[default]
    Camera,
    /// Toward the eye as far as it can while its top points along the velocity.
    Velocity,
    /// A way of its own: it turns by its rotation about an axis that is random and stays as it is, as a leaf tumbles.
    Free,
}

/// The way a shape points that a particle is drawn as.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "snake_case"))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub enum Heading {
    /// It stands as it is, turned about the world's y axis by the particle's rotation.
    #[default]
    Upright,
    /// Its y axis along the velocity, about which it is turned by the rotation.
    Velocity,
    /// It turns by its rotation about an axis that is random and stays as it is.
    Free,
}

/// The trail that particles leave: a ribbon along their way, which gets narrower and fainter with its age.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct TrailMaterial {
    /// The time after which a place on it is forgotten \[s\].
    pub seconds: f32,
    /// Its width at the particle \[m\]; zero: about a pixel all along.
    #[cfg_attr(feature = "serde", serde(default))]
    pub width: f32,
}

/// The life of particles: a property without a curve stays as it is.
///
/// Physics takes drag and mass as they are in the middle of each step, and buoyancy whenever a method asks for the forces.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Life<'a> {
    /// A factor of the diameter they are drawn with.
    pub size: Option<Varying<'a>>,
    /// Factors of red, green and blue.
    pub color: Option<Varying<'a, 4>>,
    /// A factor of their opacity. Without one, those who die of age fade in the last fifth of their lives.
    pub opacity: Option<Varying<'a>>,
    /// How they are drawn instead of as the material says, from 0, a lit ball, to 1, a glow.
    pub glow: Option<Varying<'a>>,
    /// The angle by which their picture is turned anticlockwise \[rad\].
    pub rotation: Option<Varying<'a>>,
    /// A factor of their coefficient of drag; below zero counts as zero.
    pub drag: Option<Varying<'a>>,
    /// A factor of their mass; what is not above zero counts as one. What they lose takes its momentum along.
    pub mass: Option<Varying<'a>>,
    /// The share of their weight that what is around them carries: at 1 they float, beyond it they rise. Uniform gravity minds it.
    pub buoyancy: Option<Varying<'a>>,
}

/// The properties that a particle has a place between two curves for: their random words, beyond all that reapers claim.
#[derive(Clone, Copy)]
#[repr(u32)]
pub(crate) enum Property {
    Size = 0x8000_0000,
    Color,
    Opacity,
    Glow,
    Rotation,
    Drag,
    Mass,
    Buoyancy,
    /// The axis of what faces a way of its own, by two words.
    AxisHeight,
    AxisAngle,
}

impl Property {
    /// The place between two curves of a particle whose random words have this name.
    pub(crate) fn between(self, key: u32) -> f32 {
        (crate::rng::later(key, self as u32) >> 8) as f32 * (1.0 / 16_777_216.0)
    }
}

impl<'a> Material<'a> {
    /// One that feels like this, and is drawn as it is.
    #[must_use]
    pub const fn of(contact: ContactMaterial) -> Self {
        let life = Life {
            size: None,
            color: None,
            opacity: None,
            glow: None,
            rotation: None,
            drag: None,
            mass: None,
            buoyancy: None,
        };
        Self { contact, size: 0.0, glow: 0.0, sprite: None, heading: None, trail: None, life }
    }
}

impl Life<'_> {
    /// Tells whether drag or mass change.
    fn ages(&self) -> bool {
        self.drag.is_some() || self.mass.is_some()
    }
}

/// The materials of a scene, by their numbers. A slice of [`Material`]s, or of [`ContactMaterial`]s alone, is one.
pub trait MaterialList: Sync {
    /// The number of materials.
    fn count(&self) -> usize;

    /// One of them.
    fn get(&self, number: usize) -> Option<Material<'_>>;

    /// How one of them feels; beyond them all, like nothing in particular.
    fn contact(&self, number: usize) -> ContactMaterial {
        self.get(number).map(|material| material.contact).unwrap_or_default()
    }

    /// The functions that a step calls for their lives; none, where it is known that there are no lives.
    fn code(&self) -> Option<MaterialCode> {
        Some(MaterialCode::ALL)
    }

    /// The function that mixes how two things feel where they touch; none, where it is known that nothing feels like anything in particular.
    fn mixing(&self) -> Option<Mixing> {
        Some(Mixing::ON_SURFACES)
    }
}

/// The function that mixes how a particle and a surface feel, so that a program without materials does not carry it about.
#[derive(Clone, Copy, Debug)]
pub struct Mixing(pub(crate) fn(&dyn MaterialList, f32, Option<u16>, Option<u16>) -> Mixed);

impl Mixing {
    /// That of contact materials.
    pub const ON_SURFACES: Self = Self(on_surface);
}

/// The functions that lives call for in a step, so that a program without lives does not carry them about.
#[derive(Clone, Copy, Debug)]
pub struct MaterialCode {
    /// Words that are kept of each particle.
    pub(crate) kept: fn(&dyn MaterialList) -> usize,
    /// Sets drags and masses of the first so many rows, in a step, of memory that is laid out so.
    pub(crate) age: fn(&dyn MaterialList, [Time; 2], usize, &Layout, &mut Slices<'_>),
    /// Tells whether anything floats.
    pub(crate) floats: fn(&dyn MaterialList) -> bool,
    /// Takes from the weights of rows, under this gravity, what carries them, if anything floats.
    pub(crate) carry: fn(&dyn MaterialList, &Floating<'_>, Range<usize>, Vec3, &mut [Vec3]),
}

/// Rows that may float.
pub(crate) struct Floating<'a> {
    pub(crate) time: Time,
    pub(crate) born: &'a [Time],
    pub(crate) dies: &'a [Time],
    pub(crate) material: &'a [u16],
    pub(crate) key: &'a [u32],
    pub(crate) mass: &'a [f32],
}

impl MaterialCode {
    /// All of it.
    pub const ALL: Self = Self { kept, age, floats, carry };
}

/// The lives of all materials of a list.
fn lives(list: &dyn MaterialList) -> impl Iterator<Item = Life<'_>> {
    (0..list.count()).filter_map(|number| list.get(number)).map(|material| material.life)
}

/// Materials of a list that are at hand: a list makes each that it is asked for, which takes longer than to look at it, and rows often have the same few.
pub(crate) struct Palette<'a> {
    list: &'a dyn MaterialList,
    /// Some of them with their numbers, each in its place.
    at_hand: [Option<(u16, Material<'a>)>; AT_HAND],
}

/// The number of materials at hand: on chips, which have little room on the stack, one.
const AT_HAND: usize = if cfg!(one_by_one) { 1 } else { 4 };

impl<'a> Palette<'a> {
    pub(crate) fn of(list: &'a dyn MaterialList) -> Self {
        Self { list, at_hand: [None; AT_HAND] }
    }

    /// The material with a number as columns have it: one more than in the list, and zero for none, which is as plain as one beyond the last.
    pub(crate) fn get(&mut self, number: u16) -> &Material<'a> {
        let list = self.list;
        let found = |index: u16| list.get(usize::from(index));
        let place = &mut self.at_hand[usize::from(number) % AT_HAND];
        if place.as_ref().is_some_and(|(own, _)| *own != number) {
            *place = None;
        }
        &place.get_or_insert_with(|| (number, number.checked_sub(1).and_then(found).unwrap_or_default())).1
    }
}

fn kept(list: &dyn MaterialList) -> usize {
    if lives(list).any(|life| life.ages()) { 2 } else { 0 }
}

fn floats(list: &dyn MaterialList) -> bool {
    lives(list).any(|life| life.buoyancy.is_some())
}

/// Sets drags and masses to what they are in the middle of each row's part of a step.
fn age(list: &dyn MaterialList, [from, to]: [Time; 2], len: usize, layout: &Layout, memory: &mut Slices<'_>) {
    let Slices { born, dies, material, key, drag, mass, inverse_mass, kept, .. } = memory;
    let (drag, mass, inverse_mass) = (drag.own(), mass.own(), inverse_mass.own());
    let [own_drag, own_mass] = layout.ageing(kept);
    let mut palette = Palette::of(list);
    for row in 0..len {
        let life = &palette.get(material[row]).life;
        if !life.ages() {
            continue;
        }
        let first = if born[row] > from { born[row] } else { from };
        let now = Age::of(born[row], dies[row], to - (to - first).part(1, 2));
        if let Some(curve) = &life.drag {
            let factor = curve.value(1, now, Property::Drag.between(key[row]));
            drag[row] = remembered(&mut own_drag[row], drag[row]) * max(factor, 0.0);
        }
        if let Some(curve) = &life.mass {
            let factor = curve.value(1, now, Property::Mass.between(key[row]));
            mass[row] = remembered(&mut own_mass[row], mass[row]) * if factor > 0.0 { factor } else { 1.0 };
            // A fixed particle stays so.
            if inverse_mass[row] != 0.0 {
                inverse_mass[row] = 1.0 / mass[row];
            }
        }
    }
}

/// A number of before the first change, of which the bits are kept from then on. Those of zero say that it is not known, and find it
/// to be zero again.
fn remembered(bits: &mut u32, now: f32) -> f32 {
    if *bits == 0 {
        *bits = now.to_bits();
    }
    f32::from_bits(*bits)
}

fn carry(list: &dyn MaterialList, rows: &Floating<'_>, range: Range<usize>, gravity: Vec3, total: &mut [Vec3]) {
    if !floats(list) {
        return;
    }
    let mut palette = Palette::of(list);
    for (total, row) in total.iter_mut().zip(range) {
        let number = rows.material.get(row).copied().unwrap_or(0);
        let Some(curve) = &palette.get(number).life.buoyancy else { continue };
        let age = Age::of(rows.born[row], rows.dies[row], rows.time);
        let share = curve.value(1, age, Property::Buoyancy.between(rows.key[row]));
        *total -= gravity * (rows.mass[row] * share);
    }
}

impl MaterialList for () {
    fn count(&self) -> usize {
        0
    }
    fn get(&self, _: usize) -> Option<Material<'_>> {
        None
    }
    fn contact(&self, _: usize) -> ContactMaterial {
        ContactMaterial::default()
    }
    fn code(&self) -> Option<MaterialCode> {
        None
    }
    fn mixing(&self) -> Option<Mixing> {
        None
    }
}

stands_for! {
    MaterialList {
        fn count(&self) -> usize {
            (**self).count()
        }
        fn get(&self, number: usize) -> Option<Material<'_>> {
            (**self).get(number)
        }
        fn contact(&self, number: usize) -> ContactMaterial {
            (**self).contact(number)
        }
        fn code(&self) -> Option<MaterialCode> {
            (**self).code()
        }
        fn mixing(&self) -> Option<Mixing> {
            (**self).mixing()
        }
    }
}

impl MaterialList for [ContactMaterial] {
    fn count(&self) -> usize {
        self.len()
    }
    fn get(&self, number: usize) -> Option<Material<'_>> {
        <[_]>::get(self, number).map(|&contact| Material::of(contact))
    }
    fn code(&self) -> Option<MaterialCode> {
        None
    }
}

impl MaterialList for [Material<'_>] {
    fn count(&self) -> usize {
        self.len()
    }
    fn get(&self, number: usize) -> Option<Material<'_>> {
        <[_]>::get(self, number).copied()
    }
}

/// Everything that holds a slice is what the slice is.
macro_rules! lists {
    ($($(#[$when:meta])* [$($generics:tt)*] $list:ty;)+) => {$(
        $(#[$when])*
        impl<$($generics)*> MaterialList for $list {
            fn count(&self) -> usize {
                self.len()
            }
            fn get(&self, number: usize) -> Option<Material<'_>> {
                MaterialList::get(self.as_slice(), number)
            }
            fn code(&self) -> Option<MaterialCode> {
                self.as_slice().code()
            }
        }
    )+};
}
lists! {
    [const N: usize] [ContactMaterial; N];
    [const N: usize] [Material<'_>; N];
    #[cfg(feature = "alloc")]
    [] alloc::vec::Vec<ContactMaterial>;
    #[cfg(feature = "alloc")]
    [] alloc::vec::Vec<Material<'_>>;
}

/// The elasticity and friction between two things that touch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Mixed {
    pub(crate) elasticity: f32,
    pub(crate) friction: Friction,
}

/// The material with a number, of all.
fn of(materials: &dyn MaterialList, material: Option<u16>) -> ContactMaterial {
    material.map(|number| materials.contact(usize::from(number))).unwrap_or_default()
}

/// A particle of this elasticity and material on a surface of that material.
pub(crate) fn on_surface(
    materials: &dyn MaterialList,
    elasticity: f32,
    own: Option<u16>,
    surface: Option<u16>,
) -> Mixed {
    let (surface, elasticity) = (of(materials, surface), max(elasticity, 0.0));
    let elasticity = surface.elasticity.map_or(elasticity, |other| sqrt(elasticity * max(other, 0.0)));
    Mixed { elasticity, friction: friction(of(materials, own), surface) }
}

/// Two particles with their elasticities and materials.
pub(crate) fn of_two(materials: &dyn MaterialList, elasticity: [f32; 2], material: [Option<u16>; 2]) -> Mixed {
    // An elasticity that is no number bounces nobody.
    let [a, b] = elasticity.map(|elasticity| max(elasticity, 0.0));
    // Two that are alike keep just theirs, to the bit.
    let elasticity = if a == b { a } else { sqrt(a * b) };
    Mixed { elasticity, friction: friction(of(materials, material[0]), of(materials, material[1])) }
}

fn friction(a: ContactMaterial, b: ContactMaterial) -> Friction {
    match (a.friction, b.friction) {
        (Some(a), Some(b)) => Friction { static_: sqrt(a.static_ * b.static_), kinetic: sqrt(a.kinetic * b.kinetic) },
        (a, b) => a.or(b).unwrap_or(Friction::NONE),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_side_that_says_nothing_leaves_it_to_the_other() {
        let rubber = Friction { static_: 0.9, kinetic: 0.8 };
        let ice = Friction { static_: 0.1, kinetic: 0.05 };
        let mixed = |friction| ContactMaterial { elasticity: None, friction };
        let materials = [
            mixed(Some(rubber)),
            mixed(Some(ice)),
            mixed(None),
            ContactMaterial { elasticity: Some(0.4), friction: None },
        ];
        let on = |own, surface| on_surface(&materials, 0.9, own, surface);
        assert_eq!(on(None, None), Mixed { elasticity: 0.9, friction: Friction::NONE });
        assert_eq!(on(Some(0), Some(2)).friction, rubber);
        assert_eq!(on(Some(7), Some(1)).friction, ice);
        assert!((on(Some(0), Some(1)).friction.static_ - 0.3).abs() < 1e-6);
        assert!((on(None, Some(3)).elasticity - 0.6).abs() < 1e-6);
        assert_eq!(of_two(&materials, [0.9, 0.9], [None, None]).elasticity, 0.9);
        assert!((of_two(&materials, [0.9, 0.4], [None, Some(0)]).elasticity - 0.6).abs() < 1e-6);
    }
}
