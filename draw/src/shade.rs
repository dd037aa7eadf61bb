//! The colour of a place on a surface.

use super::clip::Vertex;
use super::color::{grain, soften};
use super::eye::Eye;
use super::lamp::{Beam, Lamp};
use super::model::{Facet, Role, Skin};
use super::raster::Fragment;
use super::rays::Rays;
use glam::{Vec2, Vec3};
use std::f32::consts::TAU;

/// The share of a lamp's light that finds its way into its shadows.
const SHADOW_LIGHT: f32 = 0.22;

/// How wide lamps are, as a tangent; it makes the edges of shadows soft.
const LAMP_WIDTH: f32 = 0.04;

/// Light whose shadow nobody sees: a tenth of the darkest step of a picture's bytes, in linear light.
const FAINT: f32 = 3e-5;

/// The steepest angle, as a sine, at which an endless surface begins to melt into the background.
const MELTING: f32 = 0.16;

/// Everything that decides about colours.
#[derive(Debug)]
pub(super) struct Shader<'a> {
    pub(super) eye: &'a Eye,
    pub(super) lamps: &'a [Lamp],
    pub(super) rays: &'a Rays,
    /// The direction of the world's +y, in view coordinates.
    pub(super) up: Vec3,
}

impl Shader<'_> {
    /// The colour of a facet in a pixel.
    pub(super) fn color(&self, facet: &Facet, skin: &Skin, fragment: Fragment) -> Vec3 {
        let place = fragment.at.place;
        let eye = (-place).normalize_or(Vec3::Z);
        let light =
            if skin.role == Role::Line { self.along(skin, place) } else { self.lit(facet, skin, fragment, eye) };
        let color = self.eye.haze(place).through(soften(light));
        if skin.role == Role::Endless {
            let sky = self.eye.air.sky.at(Vec2::new(fragment.x as f32, fragment.y as f32) + 0.5);
            return sky.lerp(color, smooth(facet.flat.dot(eye).abs() / MELTING));
        }
        color
    }

    /// The light that a line returns at a place. It has no side that could face a lamp or turn away, so it takes all of every
    /// lamp's light, lest it be bright at one end and black at the other.
    fn along(&self, skin: &Skin, place: Vec3) -> Vec3 {
        let beams = self.lamps.iter().filter_map(|lamp| lamp.beam(place));
        skin.emission + skin.ambient + beams.map(|beam| beam.color * skin.diffuse).sum::<Vec3>()
    }

    /// The light that a surface returns in a pixel to an eye in a direction.
    fn lit(&self, facet: &Facet, skin: &Skin, fragment: Fragment, eye: Vec3) -> Vec3 {
        let Vertex { place, normal, tint } = fragment.at;
        // Which side is seen is up to the flat triangle: near the outline of a round thing, smooth
        // normals already point away.
        let side = if facet.flat.dot(eye) >= 0.0 { 1.0 } else { -1.0 };
        let (normal, flat) = (side * normal.normalize_or(facet.flat), side * facet.flat);
        let mut color = skin.emission + tint * skin.ambient * self.openness(normal, eye);
        for beam in self.lamps.iter().filter_map(|lamp| lamp.beam(place)) {
            let cosine = normal.dot(beam.from);
            if cosine > 0.0 {
                let half = (beam.from + eye).normalize_or(normal);
                let highlight = normal.dot(half).max(0.0).powf(skin.shininess);
                let returned = cosine * tint * skin.diffuse + highlight * skin.specular;
                let light = beam.color * returned;
                let passing =
                    if light.max_element() > FAINT { self.passing(place, flat, &beam, fragment) } else { 1.0 };
                color += (SHADOW_LIGHT + (1.0 - SHADOW_LIGHT) * passing) * light;
            }
        }
        color
    }

    /// How much of the surrounding light a surface returns: more when it faces up, or the eye, so
    /// that shapes can be told apart even where no lamp shines.
    fn openness(&self, normal: Vec3, eye: Vec3) -> f32 {
        0.6 + 0.2 * normal.dot(self.up) + 0.2 * normal.dot(eye)
    }

    /// The share of a beam that reaches a place past everything in its way.
    fn passing(&self, place: Vec3, flat: Vec3, beam: &Beam, fragment: Fragment) -> f32 {
        // Start a little outside, or the surface would stand in its own light.
        let from = place + 3e-4 * place.length() * flat;
        let turn = TAU * grain(fragment.x, fragment.y);
        self.rays.seen(from, beam.from, LAMP_WIDTH, beam.distance, turn)
    }
}

/// From 0 to 1 without a corner.
pub(super) fn smooth(t: f32) -> f32 {
    let t = t.clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}
