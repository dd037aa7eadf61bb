//! A dot in the picture.

use super::Dot;
use super::bloom::Bloom;
use super::brush::Stroke;
use super::camera::Lens;
use super::canvas::Canvas;
use super::clip::Frustum;
use super::color::{Codec, luminance};
use super::lamp::Lamp;
use super::shade::smooth;
use glam::{Vec2, Vec3};

/// The radius in pixels of a dot without a size.
const POINT: f32 = 1.2;

/// The smallest radius that is drawn. What is smaller is drawn fainter instead, but not fainter
/// than [`FAINTEST`]: far dots should still be seen.
const SMALLEST: f32 = 0.8;
const FAINTEST: f32 = 0.4;

/// How deep in a surface a solid ball still shows, in radii: about as much as heaps leave, and pictures round.
const SINK: f32 = 0.1;

/// How strongly a ball's streak covers what is behind it.
const STREAK: f32 = 0.4;

/// How far light reaches beyond a dot's own radius: this many radii, and a pixel.
const HALO: f32 = 1.9;

/// How bright light is in the middle of a dot, and how much of it spreads through the lens.
const BRIGHTNESS: f32 = 2.0;
const BLOOM: f32 = 0.28;

/// A dot as the lens sees it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sprite {
    /// Where it is, in view coordinates.
    pub(super) place: Vec3,
    /// Half its size in the world; for a dot without a size, about as much as it seems to have.
    pub(super) reach: f32,
    pub(super) color: Vec3,
    pub(super) opacity: f32,
    pub(super) glow: f32,
    pub(super) depth: f32,
    /// Whether it is a ball of its very size.
    pub(super) solid: bool,
    tail_depth: f32,
    head: Vec2,
    tail: Vec2,
    radius: f32,
}

impl Sprite {
    /// Brings a dot before the lens; `None` if it cannot be seen.
    pub(super) fn new(dot: &Dot, lens: &Lens, frustum: &Frustum, codec: &Codec) -> Option<Self> {
        let place = lens.view(dot.position);
        let depth = Lens::depth(place);
        if !(place.is_finite() && (lens.near..=lens.far).contains(&depth)) {
            return None;
        }
        // A tail that is partly out of sight is cut; one that is unknown or all out of sight goes.
        let tail = lens.view(dot.previous);
        let tail = if tail.is_finite() { frustum.clip_line(tail, place) } else { None };
        let tail = tail.map_or(place, |(start, _)| start);

        let (color, opacity) = codec.decode(dot.color);
        let scale = lens.pixels_per_metre(depth);
        let (radius, faintness) = if dot.size > 0.0 {
            let radius = 0.5 * dot.size.min(1e6) * scale;
            (radius.max(SMALLEST), (radius / SMALLEST).clamp(FAINTEST, 1.0))
        } else {
            (POINT, 1.0)
        };
        let sprite = Self {
            place,
            reach: radius / scale,
            color,
            opacity: opacity * faintness,
            glow: if dot.glow > 0.0 { dot.glow.min(1.0) } else { 0.0 },
            depth,
            solid: dot.solid,
            tail_depth: Lens::depth(tail),
            head: lens.project(place),
            tail: lens.project(tail),
            radius,
        };
        (sprite.head.is_finite() && sprite.tail.is_finite() && opacity > 0.0).then_some(sprite)
    }

    /// Paints the dot and its streak.
    pub(super) fn paint(&self, canvas: &mut Canvas, bloom: &mut Bloom, lamps: &[Lamp]) {
        if self.glow < 1.0 {
            if self.head.distance(self.tail) > 1.0 {
                self.paint_streak(canvas);
            }
            self.paint_ball(canvas, lamps);
        }
        if self.glow > 0.0 {
            self.paint_glow(canvas, bloom);
        }
    }

    /// A thin tail that fades towards where the dot came from.
    fn paint_streak(&self, canvas: &mut Canvas) {
        let opacity = STREAK * self.opacity * (1.0 - self.glow);
        self.stroke(0.5).each_pixel(canvas.width, canvas.height, |touch| {
            let radius = self.radius * (0.3 + 0.6 * touch.along);
            let covered = (radius + 0.5 - touch.offset.length()).clamp(0.0, 1.0);
            let share = opacity * touch.along * covered * self.open(canvas, touch.pixel, touch.along);
            canvas.cover(touch.pixel, self.color, share);
        });
    }

    /// A little ball, or a disc where there are too few pixels to tell.
    fn paint_ball(&self, canvas: &mut Canvas, lamps: &[Lamp]) {
        let opacity = self.opacity * (1.0 - self.glow);
        let roundness = smooth((self.radius - 1.0) / 2.0);
        let key = self.key(lamps);
        let dab = Stroke::dab(self.head, self.radius + 0.5);
        dab.each_pixel(canvas.width, canvas.height, |touch| {
            let covered = (self.radius + 0.5 - touch.offset.length()).clamp(0.0, 1.0);
            let open = if self.solid {
                self.open_to_face(canvas, touch.pixel, touch.offset / self.radius)
            } else {
                self.open(canvas, touch.pixel, 1.0)
            };
            let share = opacity * covered * open;
            if share > 0.0 {
                let color = if roundness > 0.0 {
                    self.color.lerp(self.ball(touch.offset / self.radius, key), roundness)
                } else {
                    self.color
                };
                canvas.cover(touch.pixel, color, share);
            }
        });
    }

    /// The colour of a ball at a place on its face, from the middle, 0, to the outline, 1.
    fn ball(&self, at: Vec2, key: Vec3) -> Vec3 {
        let normal = Vec3::new(at.x, -at.y, (1.0 - at.length_squared()).max(0.0).sqrt());
        let lit = 0.5 + 0.5 * normal.dot(key);
        let half = (key + Vec3::Z).normalize_or(Vec3::Z);
        let shine = normal.dot(half).max(0.0).powi(32);
        self.color * (0.22 + 0.86 * lit * lit) + 0.3 * shine
    }

    /// Where the light on a ball mostly comes from. Some always comes from beside the eye, because
    /// a ball is there to be seen.
    fn key(&self, lamps: &[Lamp]) -> Vec3 {
        let beams = lamps.iter().filter_map(|lamp| lamp.beam(self.place));
        let sum: Vec3 = beams.map(|beam| luminance(beam.color) * beam.from).sum();
        (sum.normalize_or_zero() + Vec3::new(-0.25, 0.4, 0.5)).normalize_or(Vec3::Z)
    }

    /// Light, spread along the way the dot came. The longer the way, the fainter, but not as much
    /// as would be right: a fast dot should still be seen.
    fn paint_glow(&self, canvas: &mut Canvas, bloom: &mut Bloom) {
        let stroke = self.stroke((HALO - 1.0) * self.radius + 1.0);
        let length = self.head.distance(self.tail);
        let spread = (1.0 + 0.5 * length / stroke.radius).sqrt();
        let strength = BRIGHTNESS * self.opacity * self.glow / spread;
        let mut shed = 0.0;
        stroke.each_pixel(canvas.width, canvas.height, |touch| {
            let out = touch.offset.length_squared() / (stroke.radius * stroke.radius);
            let near = (1.0 - out) * (1.0 - out);
            // A bright heart in a soft halo.
            let fall = 0.5 * near + 0.5 * near * near * near;
            let fade = if length > 1.0 { touch.along * touch.along } else { 1.0 };
            let share = strength * fade * fall * self.open(canvas, touch.pixel, touch.along);
            canvas.shine(touch.pixel, self.color, share);
            shed += share;
        });
        bloom.shine(self.tail.lerp(self.head, 0.7), BLOOM * shed * self.color);
    }

    fn stroke(&self, wider: f32) -> Stroke {
        Stroke { from: self.tail, to: self.head, radius: self.radius + wider }
    }

    /// How much of a pixel is open to the dot at a place along its streak. Dots that lie on a
    /// surface are half in it, and yet should be seen whole; the more so the more they glow.
    fn open(&self, canvas: &Canvas, pixel: usize, along: f32) -> f32 {
        let depth = self.tail_depth + along * (self.depth - self.tail_depth);
        canvas.open(pixel, depth - (1.5 + 2.5 * self.glow) * self.reach, self.reach)
    }

    /// How much of a pixel is open to a place on a solid ball's face, from the middle, 0, to the outline, 1.
    fn open_to_face(&self, canvas: &Canvas, pixel: usize, at: Vec2) -> f32 {
        let bulge = (1.0 - at.length_squared()).max(0.0).sqrt();
        canvas.open(pixel, self.depth - (bulge + SINK) * self.reach, SINK * self.reach)
    }
}
