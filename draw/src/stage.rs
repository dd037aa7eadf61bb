//! The things that there are to draw, in plain types.

use super::{Background, Camera, Flipbook, Fog, Surface};
use glam::Vec3;
use pointmass::material::Blend;
use std::sync::Arc;

/// Everything that stands still during a rendering.
#[derive(Clone, Debug, Default)]
pub struct Stage {
    /// Where the picture is taken from.
    pub camera: Camera,
    /// The lamps that shine on the pieces.
    pub lights: Vec<Light>,
    /// Light that comes from everywhere.
    pub ambient: Vec3,
    /// The background, seen where there is nothing.
    pub background: Background,
    /// The fog in the air, if it is not clear.
    pub fog: Option<Fog>,
    /// The solid things.
    pub pieces: Vec<Piece>,
    /// The thin things.
    pub lines: Vec<Line>,
    /// The pictures of billboards.
    pub pictures: Arc<[Flipbook]>,
}

/// A surface and what it is made of.
#[derive(Clone, Debug, Default)]
pub struct Piece {
    /// The shape, in world coordinates.
    pub surface: Surface,
    /// Its material.
    pub material: Material,
    /// Whether the shape stands in for something endless, such as the ground. An endless piece
    /// melts into the background towards its horizon, and casts no shadow.
    pub endless: bool,
    /// How far toward the eye it is drawn \[m\], so that what lies on another surface shows whole.
    pub lift: f32,
}

/// An unmoving line, drawn about a pixel wide.
#[derive(Clone, Copy, Debug, Default)]
pub struct Line {
    /// One end.
    pub a: Vec3,
    /// The other end.
    pub b: Vec3,
    /// Its material.
    pub material: Material,
}

/// How a surface answers light, in the terms of Blinn and Phong. Both of its sides are lit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Material {
    /// The share of the stage's ambient light that comes back.
    pub ambient: Vec3,
    /// The share of a lamp's light that scatters evenly.
    pub diffuse: Vec3,
    /// The share of a lamp's light in the highlight.
    pub specular: Vec3,
    /// Light of its own.
    pub emission: Vec3,
    /// How tight the highlight is; larger is tighter.
    pub shininess: f32,
    /// From 0, invisible, to 1, opaque.
    pub opacity: f32,
}

/// A matt light grey.
impl Default for Material {
    fn default() -> Self {
        Self {
            ambient: Vec3::splat(0.7),
            diffuse: Vec3::splat(0.7),
            specular: Vec3::ZERO,
            emission: Vec3::ZERO,
            shininess: 10.0,
            opacity: 1.0,
        }
    }
}

/// A lamp.
///
/// An `attenuation` of `[c, l, q]` divides the light by `c + l·d + q·d²` at the distance `d`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Light {
    /// Parallel rays, like the sun's.
    Directional {
        /// Its colour and strength.
        color: Vec3,
        /// The way the light travels.
        direction: Vec3,
    },
    /// Rays in all directions from one place.
    Point {
        /// Its colour and strength.
        color: Vec3,
        /// Where it hangs.
        position: Vec3,
        /// How it fades with distance.
        attenuation: [f32; 3],
    },
    /// A cone of rays.
    Spot {
        /// Its colour and strength.
        color: Vec3,
        /// Where it hangs.
        position: Vec3,
        /// Where it points.
        direction: Vec3,
        /// How it fades with distance.
        attenuation: [f32; 3],
        /// The angle between the axis and the edge of the cone, in radians.
        cutoff: f32,
        /// How it fades off the axis: by the cosine of the angle to this power.
        dropoff: f32,
    },
}

/// A moving particle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dot {
    /// Where it is.
    pub position: Vec3,
    /// Where it was in the previous frame, to which a faint streak leads back; or where it was when the shutter opened.
    pub previous: Vec3,
    /// Red, green, blue (sRGB) and opacity.
    pub color: [u8; 4],
    /// Its diameter in metres; 0 is drawn a pixel or two wide.
    pub size: f32,
    /// From 0, a lit little ball, to 1, pure light.
    pub glow: f32,
    /// Whether it is a ball of that very size, which lies on what it touches; others may be half in it.
    pub solid: bool,
}

/// A moving picture that stands in space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Billboard {
    /// Its middle.
    pub center: Vec3,
    /// The way from there to the middle of its right side.
    pub right: Vec3,
    /// The way from there to the middle of its top.
    pub up: Vec3,
    /// Red, green, blue (sRGB) and opacity, by which its picture is multiplied.
    pub color: [u8; 4],
    /// Its picture's number on the stage.
    pub picture: usize,
    /// The frame of that.
    pub frame: u16,
    /// How it is laid over what is behind it.
    pub blend: Blend,
    /// How deep in a surface it still shows whole, in halves of its size: 0 for what is soft like smoke and half in what it lies on, more
    /// for what stands for something small.
    pub sunk: f32,
}

/// All that moves, in a frame.
#[derive(Clone, Copy, Debug, Default)]
pub struct Moving<'a> {
    /// True if particles are seen with an open shutter, evenly all along their ways from where they were before; what they cover and
    /// the light that they shed is as much as if they stood still.
    pub exposed: bool,
    /// Particles as balls and glows.
    pub dots: &'a [Dot],
    /// Particles as pictures.
    pub billboards: &'a [Billboard],
    /// Lines by themselves, such as springs.
    pub segments: &'a [pointmass::draw::Line],
    /// Lines of which each begins where one ends, such as trails.
    pub ribbons: &'a [pointmass::draw::Line],
}
