//! The looks of particles: the same to whatever draws them.
//!
//! What there is to draw is written as plain lists into memory that the caller lends: [`sprites`] (pictures that stand in space),
//! [`solids`] (shapes), [`trails`](Trails::lines), [`springs`] and [`velocities`] (lines), [`surface`] (cloth), [`cells`]
//! and [`arrows`] (what is not seen otherwise). The same bits on every
//! machine; what finds no room is counted.

mod bodies;
mod debug;
mod line;
mod solid;
mod sprite;
mod strand;
mod surface;
mod trail;

pub use bodies::{bodies, body};
pub use debug::{arrow, arrows, cells};
pub use line::{Line, edges, links, links_by_strain, springs, strained, velocities};
pub use solid::{Instance, solid, solids};
pub use sprite::{Sprite, View, back_to_front, sprite, sprites};
pub use strand::{Lock, StrandLight, strands};
pub use surface::{Patch, Vertex, strains, surface};
pub use trail::{Knot, Ring, Trails};

use crate::force::State;
use crate::material::{Age, Material, Palette, Property, SpriteMaterial, Varying};
use crate::math::{max, min};
use crate::particles::{Color, WHITE};
use crate::time::Time;

/// How a particle looks at an instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Appearance {
    /// The diameter it is drawn with \[m\]; zero: it is a point, which takes whatever suits the picture.
    pub diameter: f32,
    /// The factor of that size which is in `diameter` already, for points.
    pub scale: f32,
    /// True if it is drawn with its own radius: a body, no mark.
    pub solid: bool,
    /// Its colour, with the opacity it has now.
    pub color: Color,
    /// How it is drawn, from 0, a lit ball, to 1, a glow.
    pub glow: f32,
    /// The angle by which its picture is turned anticlockwise \[rad\].
    pub rotation: f32,
    /// The frame of its picture's flipbook, from 0.
    pub frame: u16,
}

/// The share of a life in which those fade of whose opacity nothing is said.
const FADING: f32 = 0.2;

/// How the particle in a row looks at the state's instant: by its material, its age, and the words that are its own. The same bits
/// on every machine. Nobody is there beyond the last row.
///
/// ```
/// use pointmass::{Heap, Particle, Scene, Size, System, Time, draw};
///
/// let start = [Particle { radius: 0.5, lifetime: 2.0, ..Particle::REST }];
/// let scene = Scene { start: &start, ..Scene::EMPTY };
/// let mut system = System::with(Heap::new(scene.size()));
/// system.start(&scene, 1)?;
/// system.step(&scene, Time::from_seconds(1.8));
/// let look = draw::appearance(&system.state(&scene), 0).expect("it lives");
/// assert_eq!((look.diameter, look.color[3]), (1.0, 127)); // Half of its last fifth is over.
/// # Ok::<(), pointmass::InsufficientMemory>(())
/// ```
#[must_use]
pub fn appearance(state: &State<'_>, row: usize) -> Option<Appearance> {
    Looks::of(state).appearance(row)
}

/// Looks at particles one after the other: the same as [`appearance`] of each, several times as fast where those who follow each other are often of
/// the same few materials, which are at hand then.
#[allow(missing_debug_implementations)]
pub struct Looks<'s, 'a> {
    state: &'s State<'a>,
    palette: Palette<'a>,
}

impl<'s, 'a> Looks<'s, 'a> {
    /// The looks of a state's particles.
    #[must_use]
    pub fn of(state: &'s State<'a>) -> Self {
        Self { state, palette: Palette::of(state.materials) }
    }

    /// The material of the particle in a row, and its number, if it has one.
    fn material(&mut self, row: usize) -> Option<(u16, &Material<'a>)> {
        let number = *self.state.material.get(row)?;
        Some((number.checked_sub(1)?, self.palette.get(number)))
    }

    /// The colour of the particle in a row.
    fn color(&mut self, row: usize) -> Option<Color> {
        Some(self.appearance(row)?.color)
    }

    /// How the particle in a row looks; nobody is there beyond the last.
    pub fn appearance(&mut self, row: usize) -> Option<Appearance> {
        let state = self.state;
        let (&radius, &key, &[red, green, blue, alpha]) =
            (state.radius.get(row)?, state.key.get(row)?, state.color.get(row).unwrap_or(&WHITE));
        let (&born, &dies) = (state.born.get(row)?, state.dies.get(row)?);
        let own = self.palette.get(state.material.get(row).copied().unwrap_or(0));
        let (life, age) = (&own.life, Age::of(born, dies, state.time));
        let value = |curve: &Option<Varying<'_>>, property| {
            curve.as_ref().map(|curve| curve.value(1, age, place_between(curve, property, key)))
        };
        let scale = max(value(&life.size, Property::Size).unwrap_or(1.0), 0.0);
        let opacity = value(&life.opacity, Property::Opacity).unwrap_or_else(|| fading(dies, age));
        let [red, green, blue] = match &life.color {
            None => [red, green, blue],
            Some(curve) => {
                let between = place_between(curve, Property::Color, key);
                [(red, 1), (green, 2), (blue, 3)]
                    .map(|(channel, number)| faded(channel, curve.value(number, age, between)))
            }
        };
        let solid = !(own.size > 0.0) && radius > 0.0;
        Some(Appearance {
            diameter: if own.size > 0.0 { own.size * scale } else { 2.0 * radius * scale },
            scale,
            solid,
            color: [red, green, blue, faded(alpha, opacity)],
            glow: value(&life.glow, Property::Glow).unwrap_or(own.glow),
            rotation: value(&life.rotation, Property::Rotation).unwrap_or(0.0),
            frame: own.sprite.map_or(0, |sprite| frame(&sprite, age)),
        })
    }

    /// Tells whether the particle in a row is drawn as a point or a ball: it can be seen, and not as a [`Sprite`] or an [`Instance`].
    pub fn is_dot(&mut self, row: usize) -> bool {
        let is_own = |of: (u16, &Material<'_>)| of.1.sprite.is_some() || of.1.heading.is_some();
        let has_own = self.material(row).is_some_and(is_own);
        let Some(Appearance { diameter, scale, color, .. }) = self.appearance(row) else { return false };
        let has_size = if diameter > 0.0 { !has_own } else { self.state.radius[row] == 0.0 && scale > 0.0 };
        has_size && color[3] > 0
    }
}

/// Where a particle is between the two curves of a property, if there are two.
fn place_between<const N: usize>(curve: &Varying<'_, N>, property: Property, key: u32) -> f32 {
    if curve.to.is_some() { property.between(key) } else { 0.0 }
}

/// The opacity at an age of those who die of it.
fn fading(dies: Time, age: Age) -> f32 {
    if dies == Time::NEVER { 1.0 } else { min((1.0 - age.life) * (1.0 / FADING), 1.0) }
}

/// The frame of a flipbook at an age.
fn frame(sprite: &SpriteMaterial, age: Age) -> u16 {
    let count = sprite.frames.max(1);
    if sprite.rate > 0.0 {
        // The casts round down and saturate.
        ((age.seconds * sprite.rate) as u32 % u32::from(count)) as u16
    } else {
        ((age.life * f32::from(count)) as u16).min(count - 1)
    }
}

/// A channel times a factor, rounded.
fn faded(channel: u8, factor: f32) -> u8 {
    (f32::from(channel) * factor + 0.5) as u8
}

/// Writes a list as far as there is room; returns the number of entries and how many were left out.
fn fill<T>(list: impl Iterator<Item = T>, into: &mut [T]) -> (usize, usize) {
    let (mut count, mut left_out) = (0, 0);
    for entry in list {
        match into.get_mut(count) {
            Some(room) => {
                *room = entry;
                count += 1;
            }
            None => left_out += 1,
        }
    }
    (count, left_out)
}
