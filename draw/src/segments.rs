//! Moving lines in the picture, such as springs, and ribbons made of them, such as trails.

use super::brush::Stroke;
use super::camera::Lens;
use super::canvas::Canvas;
use super::color::CODEC;
use super::eye::Eye;
use glam::{Vec2, Vec3};
use pointmass::draw::Line;

/// Half the width of a line, in pixels; what is narrower is drawn fainter instead.
const RADIUS: f32 = 0.6;

/// How far in front of a surface it may be seen from behind, as a share of its depth: enough for a
/// line that lies on the surface.
const LIFT: f32 = 0.004;

/// A line as the lens sees it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Wire {
    /// How far away its farther end is, so that a dot on either end lies on top.
    pub(super) depth: f32,
    ends: [End; 2],
    /// True if another line goes on from either end, so that it has none.
    joined: bool,
}

/// An end of a line.
#[derive(Clone, Copy, Debug)]
struct End {
    at: Vec2,
    /// One over the depth, which is what changes evenly across the picture.
    nearness: f32,
    /// Half its width, in pixels.
    radius: f32,
    color: Vec3,
    opacity: f32,
}

impl Wire {
    /// Brings a line before the lens; `None` if it cannot be seen.
    pub(super) fn new(line: &Line, joined: bool, eye: &Eye) -> Option<Self> {
        let Eye { lens, frustum, .. } = eye;
        let [a, b] = line.ends;
        if !(a.is_finite() && b.is_finite()) {
            return None;
        }
        let [a, b] = [a, b].map(|end| lens.view(end));
        let (from, to) = frustum.clip_line(a, b)?;
        // What is cut off takes its share of the width and the colour along.
        let share = |place: Vec3| place.distance(a) / a.distance(b).max(f32::MIN_POSITIVE);
        let ends = [from, to].map(|place| End::new(line, place, share(place), eye));
        let is_seen = ends.iter().any(|end| end.opacity > 0.0);
        is_seen.then_some(Self { depth: Lens::depth(from).max(Lens::depth(to)), ends, joined })
    }

    /// Paints the line.
    pub(super) fn paint(&self, canvas: &mut Canvas) {
        let [a, b] = self.ends;
        let way = b.at - a.at;
        let stroke = Stroke { from: a.at, to: b.at, radius: a.radius.max(b.radius) + 0.5 };
        stroke.each_pixel(canvas.width, canvas.height, |touch| {
            // Joined lines have butt ends, each pixel along them belonging to one, so that nothing is painted twice.
            let is_next = touch.along >= 1.0 || touch.along <= 0.0 && touch.offset.dot(way) < 0.0;
            if self.joined && is_next {
                return;
            }
            let between = |of: fn(&End) -> f32| of(&a) + touch.along * (of(&b) - of(&a));
            let covered = (between(|end| end.radius) + 0.5 - touch.offset.length()).clamp(0.0, 1.0);
            let depth = 1.0 / between(|end| end.nearness);
            let open = canvas.open(touch.pixel, (1.0 - LIFT) * depth, LIFT * depth);
            let opacity = between(|end| end.opacity);
            canvas.cover(touch.pixel, a.color.lerp(b.color, touch.along), opacity * covered * open);
        });
    }
}

impl End {
    /// The end of the visible part of a line, a share of the way along it.
    fn new(line: &Line, place: Vec3, share: f32, eye: &Eye) -> Self {
        let Eye { lens, .. } = eye;
        let [(from, opaque), (to, faint)] = line.colors.map(|color| CODEC.decode(color));
        let depth = Lens::depth(place);
        let [start, end] = line.widths.map(|width| 0.5 * width * lens.pixels_per_metre(depth));
        let radius = start + share * (end - start);
        let thinness = if line.widths == [0.0; 2] { 1.0 } else { (radius / RADIUS).clamp(0.0, 1.0) };
        Self {
            at: lens.project(place),
            nearness: 1.0 / depth,
            radius: radius.clamp(RADIUS, 1e4),
            color: eye.haze(place).through(from.lerp(to, share)),
            opacity: (opaque + share * (faint - opaque)) * thinness,
        }
    }
}
