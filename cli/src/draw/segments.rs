//! Moving lines in the picture.

use super::Segment;
use super::brush::Stroke;
use super::camera::Lens;
use super::canvas::Canvas;
use super::clip::Frustum;
use super::color::Codec;
use glam::{Vec2, Vec3};

/// Half the width of a line, in pixels.
const RADIUS: f32 = 0.6;

/// How far in front of a surface it may be seen from behind, as a share of its depth: enough for a
/// line that lies on the surface.
const LIFT: f32 = 0.004;

/// A segment as the lens sees it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Thread {
    /// How far away its farther end is, so that a dot on either end lies on top.
    pub(super) depth: f32,
    ends: [Vec2; 2],
    nearness: [f32; 2],
    color: Vec3,
    opacity: f32,
}

impl Thread {
    /// Brings a segment before the lens; `None` if it cannot be seen.
    pub(super) fn new(segment: &Segment, lens: &Lens, frustum: &Frustum, codec: &Codec) -> Option<Self> {
        if !(segment.a.is_finite() && segment.b.is_finite()) {
            return None;
        }
        let (a, b) = frustum.clip_line(lens.view(segment.a), lens.view(segment.b))?;
        let (color, opacity) = codec.decode(segment.color);
        Some(Self {
            depth: Lens::depth(a).max(Lens::depth(b)),
            ends: [a, b].map(|end| lens.project(end)),
            nearness: [a, b].map(|end| 1.0 / Lens::depth(end)),
            color,
            opacity,
        })
    }

    /// Paints the line.
    pub(super) fn paint(&self, canvas: &mut Canvas) {
        let stroke = Stroke { from: self.ends[0], to: self.ends[1], radius: RADIUS + 0.5 };
        let [near_a, near_b] = self.nearness;
        stroke.each_pixel(canvas.width, canvas.height, |touch| {
            let covered = (stroke.radius - touch.offset.length()).clamp(0.0, 1.0);
            // One over the depth is what changes evenly across the picture.
            let depth = 1.0 / (near_a + touch.along * (near_b - near_a));
            let open = canvas.open(touch.pixel, (1.0 - LIFT) * depth, LIFT * depth);
            canvas.cover(touch.pixel, self.color, self.opacity * covered * open);
        });
    }
}
