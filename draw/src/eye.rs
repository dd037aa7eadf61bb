//! All that decides how a moving thing looks from where the picture is taken.

use super::Stage;
use super::air::{Air, Haze};
use super::camera::Lens;
use super::clip::Frustum;
use super::sky::Sky;
use glam::Vec3;

/// The lens, what it cuts off, and the air before it.
#[derive(Debug)]
pub(super) struct Eye {
    pub(super) lens: Lens,
    pub(super) frustum: Frustum,
    pub(super) air: Air,
}

impl Eye {
    /// The eye of a stage's camera, for pictures of a size in pixels.
    pub(super) fn new(stage: &Stage, width: u32, height: u32) -> Self {
        let lens = Lens::new(&stage.camera, width as usize, height as usize);
        let air = Air::new(stage.fog, Sky::new(stage.background, &lens));
        Self { lens, frustum: Frustum::new(&lens), air }
    }

    /// The haze before a place in view coordinates.
    pub(super) fn haze(&self, place: Vec3) -> Haze {
        self.air.before(place, &self.lens)
    }
}
