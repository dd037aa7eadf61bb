//! Moving lines in the picture, such as springs, and ribbons made of them, such as trails.

use super::brush::{Stroke, Touch};
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
    /// True if it is a part of a ribbon, whose ends are cut off straight.
    joined: bool,
    /// The axes of the parts before and behind it that begin and end where it ends and begins, in the picture.
    beside: [Option<[Vec2; 2]>; 2],
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
        let depth = Lens::depth(from).max(Lens::depth(to));
        is_seen.then_some(Self { depth, ends, joined, beside: [None; 2] })
    }

    /// The parts of ribbons. Where one goes on from where another ends, both know of each other.
    pub(super) fn ribbons(lines: &[Line], eye: &Eye) -> Vec<Self> {
        let mut parts: Vec<_> = lines.iter().map(|line| Self::new(line, true, eye)).collect();
        for (number, two) in lines.windows(2).enumerate() {
            if let ([Some(one), Some(other)], true) = (&mut parts[number..][..2], two[0].ends[1] == two[1].ends[0]) {
                (one.beside[1], other.beside[0]) = (Some(other.axis()), Some(one.axis()));
            }
        }
        parts.into_iter().flatten().collect()
    }

    fn axis(&self) -> [Vec2; 2] {
        self.ends.map(|end| end.at)
    }

    /// Paints the line.
    pub(super) fn paint(&self, canvas: &mut Canvas) {
        let [a, b] = self.ends;
        let stroke = Stroke { from: a.at, to: b.at, radius: a.radius.max(b.radius) + 0.5 };
        stroke.each_pixel(canvas.width, canvas.height, |touch| {
            if self.joined && !self.owns(&touch, canvas.width) {
                return;
            }
            let between = |of: fn(&End) -> f32| of(&a) + touch.along * (of(&b) - of(&a));
            let covered = (between(|end| end.radius) + 0.5 - touch.offset.length()).clamp(0.0, 1.0);
            let depth = 1.0 / between(|end| end.nearness);
            let open = canvas.open(touch.pixel, (1.0 - LIFT) * depth, LIFT * depth);
            let opacity = between(|end| end.opacity);
            let color = canvas
                .before(touch.pixel, (1.0 - LIFT) * depth, LIFT * depth)
                .through(a.color.lerp(b.color, touch.along));
            canvas.cover(touch.pixel, color, opacity * covered * open);
        });
    }
}

impl Wire {
    /// Tells whether a pixel is a part of a ribbon's own, so that nothing is painted twice: it is nearer to it than to the part before, and no
    /// farther than from the one behind. Where none goes on the ribbon ends straight; where one does, bends are round.
    fn owns(&self, touch: &Touch, width: usize) -> bool {
        let [a, b] = self.axis();
        let place = Vec2::new((touch.pixel % width) as f32, (touch.pixel / width) as f32) + 0.5;
        let own = apart(place, [a, b]);
        let [before, behind] = self.beside;
        let begins = match before {
            Some(axis) => own < apart(place, axis),
            None => touch.along > 0.0 || touch.offset.dot(b - a) >= 0.0,
        };
        begins && behind.map_or(touch.along < 1.0, |axis| own <= apart(place, axis))
    }
}

/// The square of the distance of a place from a line between two ends.
fn apart(place: Vec2, [a, b]: [Vec2; 2]) -> f32 {
    let (out, way) = (place - a, b - a);
    let along = (out.dot(way) / way.length_squared().max(1e-12)).clamp(0.0, 1.0);
    (out - along * way).length_squared()
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
