//! The sky is seen where there is nothing.

use super::color::{decode, luminance};
use glam::Vec3;

/// The background: its own colour at the top, and when that is dark, a breath of light lower down,
/// so that the picture has some depth.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sky {
    top: Vec3,
    lift: Vec3,
    height: f32,
}

impl Sky {
    pub(super) fn new(background: Vec3, height: usize) -> Self {
        const LIFT: Vec3 = Vec3::new(0.0085, 0.0105, 0.0165);
        let top = decode(background);
        let darkness = (1.0 - 8.0 * luminance(top)).max(0.0);
        Self { top, lift: darkness * (LIFT + 0.8 * top), height: height.max(1) as f32 }
    }

    /// The colour at a height in the picture, in pixels from the top.
    pub(super) fn at(&self, y: f32) -> Vec3 {
        let down = (y / self.height).clamp(0.0, 1.0);
        self.top + down * down * (3.0 - 2.0 * down) * self.lift
    }
}
