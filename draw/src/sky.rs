//! The sky is seen where there is nothing.

use super::camera::Lens;
use super::color::{decode, luminance};
use glam::{Vec2, Vec3};

/// The background behind everything.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Background {
    /// One colour, in sRGB; a dark one has a breath of light lower down, so that the picture has some depth.
    Plain(Vec3),
    /// Colours by the elevation e of the line of sight, in sRGB: that of the horizon gives way to that of the zenith by
    /// 1 − (1 − sin e)³, and below to that of the ground by 1 − (1 + sin e)³.
    Gradient {
        /// Straight up.
        zenith: Vec3,
        /// All around.
        horizon: Vec3,
        /// Straight down.
        ground: Vec3,
    },
}

/// Black.
impl Default for Background {
    fn default() -> Self {
        Self::Plain(Vec3::ZERO)
    }
}

/// The background as a lens sees it, in linear light.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sky {
    lens: Lens,
    colors: Colors,
}

#[derive(Clone, Copy, Debug)]
enum Colors {
    /// The colour at the top of the picture, and what comes to it toward the bottom.
    Plain {
        top: Vec3,
        lift: Vec3,
    },
    Gradient {
        zenith: Vec3,
        horizon: Vec3,
        ground: Vec3,
    },
}

impl Sky {
    pub(super) fn new(background: Background, lens: &Lens) -> Self {
        const LIFT: Vec3 = Vec3::new(0.0085, 0.0105, 0.0165);
        let colors = match background {
            Background::Plain(color) => {
                let top = decode(color);
                let darkness = (1.0 - 8.0 * luminance(top)).max(0.0);
                Colors::Plain { top, lift: darkness * (LIFT + 0.8 * top) }
            }
            Background::Gradient { zenith, horizon, ground } => {
                Colors::Gradient { zenith: decode(zenith), horizon: decode(horizon), ground: decode(ground) }
            }
        };
        Self { lens: *lens, colors }
    }

    /// The colour at a place of the picture, in pixels from the top left corner.
    pub(super) fn at(&self, place: Vec2) -> Vec3 {
        match self.colors {
            Colors::Plain { top, lift } => {
                let down = (place.y / self.lens.height.max(1) as f32).clamp(0.0, 1.0);
                top + down * down * (3.0 - 2.0 * down) * lift
            }
            Colors::Gradient { zenith, horizon, ground } => {
                let sine = self.lens.ray(place).normalize().dot(self.lens.turn.y_axis);
                let left = 1.0 - sine.abs();
                horizon.lerp(if sine > 0.0 { zenith } else { ground }, 1.0 - left * left * left)
            }
        }
    }
}
