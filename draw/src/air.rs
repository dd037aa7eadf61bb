//! The air between the eye and the things that it sees.

use super::camera::Lens;
use super::color::decode;
use super::sky::Sky;
use glam::Vec3;

/// Fog of one density: of the light from a distance d the share exp(−density · (d − from)) arrives, and its own comes instead of the
/// rest (the law of Bouguer and Beer).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fog {
    /// Its colour in sRGB; nothing for that of the background in the same direction.
    pub color: Option<Vec3>,
    /// The coefficient of extinction \[1/m\].
    pub density: f32,
    /// The distance at which it begins \[m\].
    pub from: f32,
}

/// The air, and the background that is seen through it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Air {
    pub(super) sky: Sky,
    fog: Option<Fog>,
    /// Fog's own colour in linear light.
    color: Option<Vec3>,
}

/// The air's effect on light on its way from a place to the eye.
#[derive(Clone, Copy, Debug)]
pub(super) struct Haze {
    /// The share that arrives.
    pub(super) clear: f32,
    /// The light that comes instead of the rest.
    pub(super) light: Vec3,
}

impl Air {
    pub(super) fn new(fog: Option<Fog>, sky: Sky) -> Self {
        let fog = fog.filter(|fog| fog.density > 0.0 && fog.density.is_finite() && fog.from.is_finite());
        Self { sky, fog, color: fog.and_then(|fog| fog.color).map(decode) }
    }

    /// The haze before a place in view coordinates.
    pub(super) fn before(&self, place: Vec3, lens: &Lens) -> Haze {
        let Some(fog) = self.fog else { return Haze::NONE };
        let clear = (-fog.density * (place.length() - fog.from).max(0.0)).exp();
        let color = self.color.unwrap_or_else(|| self.sky.at(lens.project(place)));
        Haze { clear, light: (1.0 - clear) * color }
    }
}

impl Haze {
    /// Nothing at all.
    pub(super) const NONE: Self = Self { clear: 1.0, light: Vec3::ZERO };

    /// The light that arrives of a colour.
    pub(super) fn through(&self, color: Vec3) -> Vec3 {
        self.clear * color + self.light
    }
}
