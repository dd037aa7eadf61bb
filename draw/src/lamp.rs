//! Lamps as the lens sees them, and what they send to a place.

use super::Light;
use super::camera::Lens;
use super::color::decode;
use glam::Vec3;

/// The angle in which a spot light ends, in radians.
const EDGE: f32 = 0.01;

/// A light in view coordinates, with linear colour and unit directions.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lamp(Light);

/// Light that arrives somewhere.
#[derive(Clone, Copy, Debug)]
pub(super) struct Beam {
    /// The direction it comes from.
    pub(super) from: Vec3,
    /// How far away its lamp is.
    pub(super) distance: f32,
    /// Its colour and strength.
    pub(super) color: Vec3,
}

impl Lamp {
    /// Brings a light before the lens; `None` for one that cannot shine.
    pub(super) fn new(light: &Light, lens: &Lens) -> Option<Self> {
        let turn = |direction: Vec3| (lens.turn * direction).try_normalize();
        let place = |position: Vec3| position.is_finite().then(|| lens.view(position));
        Some(Self(match *light {
            Light::Directional { color, direction } => {
                Light::Directional { color: decode(color), direction: turn(direction)? }
            }
            Light::Point { color, position, attenuation } => {
                Light::Point { color: decode(color), position: place(position)?, attenuation }
            }
            Light::Spot { color, position, direction, attenuation, cutoff, dropoff } => Light::Spot {
                color: decode(color),
                position: place(position)?,
                direction: turn(direction)?,
                attenuation,
                cutoff,
                dropoff,
            },
        }))
    }

    /// The light that reaches `place` if nothing stands in the way.
    pub(super) fn beam(&self, place: Vec3) -> Option<Beam> {
        match self.0 {
            Light::Directional { color, direction } => Some(Beam { from: -direction, distance: f32::INFINITY, color }),
            Light::Point { color, position, attenuation } => Beam::between(position, place, color, attenuation),
            Light::Spot { color, position, direction, attenuation, cutoff, dropoff } => {
                let beam = Beam::between(position, place, color, attenuation)?;
                let cosine = -beam.from.dot(direction);
                // The edge is a little soft, or it would show every pixel.
                let inside = ((cutoff - cosine.clamp(0.0, 1.0).acos()) / EDGE).min(1.0);
                let strength = inside * cosine.max(0.0).powf(dropoff.max(0.0));
                (strength > 0.0).then(|| Beam { color: strength * beam.color, ..beam })
            }
        }
    }
}

impl Beam {
    fn between(lamp: Vec3, place: Vec3, color: Vec3, [c, l, q]: [f32; 3]) -> Option<Self> {
        let (from, distance) = (lamp - place).try_normalize().zip(Some(lamp.distance(place)))?;
        let divisor = c + distance * (l + distance * q);
        // A divisor of nothing is how scene files leave attenuation out.
        let color = if divisor > 0.0 { color / divisor } else { color };
        Some(Self { from, distance, color })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Camera;

    fn red(light: Light, place: Vec3) -> Option<f32> {
        let lens = Lens::new(&Camera::default(), 64, 48);
        Lamp::new(&light, &lens)?.beam(place).map(|beam| beam.color.x)
    }

    #[test]
    fn point_lights_fade_with_distance() {
        let light = Light::Point { color: Vec3::ONE, position: Vec3::ZERO, attenuation: [1.0, 0.5, 0.25] };
        assert_eq!(red(light, Vec3::new(0.0, 0.0, -2.0)), Some(1.0 / 3.0));
    }

    #[test]
    fn spots_end_at_their_cutoff() {
        let light = Light::Spot {
            color: Vec3::ONE,
            position: Vec3::ZERO,
            direction: Vec3::NEG_Z,
            attenuation: [1.0, 0.0, 0.0],
            cutoff: 0.5,
            dropoff: 2.0,
        };
        let at = |angle: f32| red(light, Vec3::new(angle.sin(), 0.0, -angle.cos()));
        assert!((at(0.4).unwrap() - 0.4f32.cos().powi(2)).abs() < 1e-5);
        assert_eq!(at(0.51), None);
    }

    #[test]
    fn a_light_without_direction_is_left_out() {
        assert_eq!(red(Light::Directional { color: Vec3::ONE, direction: Vec3::ZERO }, Vec3::X), None);
    }
}
