//! A dot in the picture.

use super::Dot;
use super::air::Haze;
use super::bloom::Bloom;
use super::brush::{Stroke, Touch};
use super::camera::Lens;
use super::canvas::Canvas;
use super::color::CODEC;
use super::color::luminance;
use super::eye::Eye;
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

/// A glow at a square of a distance from its middle, from 0 to 1 at its edge: a bright heart in a soft halo.
fn fall(out: f32) -> f32 {
    let near = (1.0 - out) * (1.0 - out);
    0.5 * near + 0.5 * near * near * near
}

/// How far before its middle a ball's face is at a place on it, from the middle, 0, to the outline, 1: in radii.
fn bulge(at: Vec2) -> f32 {
    (1.0 - at.length_squared()).max(0.0).sqrt()
}

/// The straight way of a dot in the picture while the shutter is open.
struct Way {
    direction: Vec2,
    /// In pixels.
    length: f32,
}

impl Way {
    fn new(from: Vec2, to: Vec2) -> Self {
        let length = from.distance(to);
        Self { direction: (to - from) / length, length }
    }

    /// How far along the way a pixel is, from 0 at its beginning to 1 at its end and beyond, and how it lies beside it.
    fn nearest(&self, touch: &Touch) -> (f32, Vec2) {
        let past = touch.offset.dot(self.direction);
        (touch.along + past / self.length, touch.offset - past * self.direction)
    }

    /// The part of the time in which a circle is over a pixel that lies so far along the way and beside it.
    fn within(&self, radius: f32, along: f32, beside: f32) -> Option<(f32, f32)> {
        let half = (radius * radius - beside * beside).max(0.0).sqrt() / self.length;
        let (from, to) = ((along - half).max(0.0), (along + half).min(1.0));
        (from < to).then_some((from, to))
    }
}

/// The light on a ball. It is as strong whatever the lamps do, and some of it is white and comes from beside the eye, because a ball is there to be seen.
struct Key {
    /// Where it mostly comes from.
    from: Vec3,
    /// Its colour, the largest channel of which is 1.
    tint: Vec3,
}

impl Key {
    fn new(lamps: &[Lamp], place: Vec3) -> Self {
        let beams = || lamps.iter().filter_map(|lamp| lamp.beam(place));
        let sum: Vec3 = beams().map(|beam| luminance(beam.color) * beam.from).sum();
        let from = (sum.normalize_or_zero() + Vec3::new(-0.25, 0.4, 0.5)).normalize_or(Vec3::Z);
        let light: Vec3 = beams().map(|beam| beam.color).sum();
        let most = light.max_element();
        Self { from, tint: if most > 0.0 { light / most } else { Vec3::ONE } }
    }
}

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
    /// The share of its way that is in sight, or all of it.
    seen: f32,
    /// The haze before it.
    pub(super) haze: Haze,
    /// True if its way is that of an open shutter.
    pub(super) exposed: bool,
}

impl Sprite {
    /// Brings a dot before the lens; `None` if it cannot be seen.
    pub(super) fn new(dot: &Dot, exposed: bool, eye: &Eye) -> Option<Self> {
        let Eye { lens, frustum, .. } = eye;
        let place = lens.view(dot.position);
        let depth = Lens::depth(place);
        if !(place.is_finite() && (lens.near..=lens.far).contains(&depth)) {
            return None;
        }
        // A tail that is partly out of sight is cut; one that is unknown or all out of sight goes.
        let tail = lens.view(dot.previous);
        let tail = if tail.is_finite() { frustum.clip_line(tail, place) } else { None };
        let tail = tail.map_or(place, |(start, _)| start);
        let way = place.distance(lens.view(dot.previous));

        let (color, opacity) = CODEC.decode(dot.color);
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
            seen: if way > 0.0 && tail != place { place.distance(tail) / way } else { 1.0 },
            haze: eye.haze(place),
            exposed,
        };
        (sprite.head.is_finite() && sprite.tail.is_finite() && opacity > 0.0).then_some(sprite)
    }

    /// Paints the dot and its streak.
    pub(super) fn paint(&self, canvas: &mut Canvas, bloom: &mut Bloom, lamps: &[Lamp]) {
        if self.exposed && self.head.distance(self.tail) > 0.25 {
            if self.glow < 1.0 {
                self.paint_way(canvas, lamps);
            }
            if self.glow > 0.0 {
                self.paint_shining_way(canvas, bloom);
            }
            return;
        }
        if self.glow < 1.0 {
            if !self.exposed && self.head.distance(self.tail) > 1.0 {
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
            let panes = self.panes(canvas, &touch);
            canvas.cover(touch.pixel, panes.through(self.haze.through(self.color)), share);
        });
    }

    /// A little ball, or a disc where there are too few pixels to tell.
    fn paint_ball(&self, canvas: &mut Canvas, lamps: &[Lamp]) {
        let opacity = self.opacity * (1.0 - self.glow);
        let roundness = smooth((self.radius - 1.0) / 2.0);
        let key = Key::new(lamps, self.place);
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
                let at = touch.offset / self.radius;
                let color = if roundness > 0.0 { self.color.lerp(self.ball(at, &key), roundness) } else { self.color };
                let share = share * self.thickness(at, roundness);
                let panes = if self.solid {
                    canvas.before(touch.pixel, self.depth - bulge(at) * self.reach, SINK * self.reach)
                } else {
                    self.panes(canvas, &touch)
                };
                canvas.cover(touch.pixel, panes.through(self.haze.through(color)), share);
            }
        });
    }

    /// The colour of a ball at a place on its face, from the middle, 0, to the outline, 1.
    fn ball(&self, at: Vec2, key: &Key) -> Vec3 {
        let normal = Vec3::new(at.x, -at.y, bulge(at));
        let lit = 0.5 + 0.5 * normal.dot(key.from);
        let half = (key.from + Vec3::Z).normalize_or(Vec3::Z);
        let shine = normal.dot(half).max(0.0).powi(32);
        self.color * (0.22 + 0.86 * lit * lit * key.tint) + 0.3 * shine * self.opacity * key.tint
    }

    /// How much of a clear ball's opacity there is at a place on its face. It is of a stuff of which a ray passes less the farther out
    /// it goes: of what takes all but 1 − α of the light along a diameter, a chord takes all but (1 − α)^(chord / diameter).
    fn thickness(&self, at: Vec2, roundness: f32) -> f32 {
        if self.opacity >= 1.0 || roundness == 0.0 {
            return 1.0;
        }
        let chord = (1.0 - at.length_squared()).max(0.0).sqrt();
        let taken = 1.0 - (1.0 - self.opacity).powf(chord);
        1.0 + roundness * (taken / self.opacity - 1.0)
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
            let out = |offset: Vec2| (offset.length_squared() / (stroke.radius * stroke.radius)).min(1.0);
            let light = if length > 1.0 {
                // All of it is where it is now, and its trace fades from there.
                let from_head = touch.offset - (1.0 - touch.along) * (self.head - self.tail);
                (touch.along * touch.along * fall(out(touch.offset))).max(fall(out(from_head)))
            } else {
                fall(out(touch.offset))
            };
            let share = strength * light * self.open(canvas, touch.pixel, touch.along);
            shed += self.shed(canvas, &touch, share);
        });
        bloom.shine(self.tail.lerp(self.head, 0.7), BLOOM * shed * self.haze.clear * self.color);
    }

    /// A ball on its way while the shutter is open: each pixel is covered for the part of that time in which the ball is over it, so that
    /// what is covered in all is as much as by a ball that stands still (Reeves 1983: lines in place of points).
    fn paint_way(&self, canvas: &mut Canvas, lamps: &[Lamp]) {
        /// The still ball's soft edge, as the mean of so many sharp ones.
        const EDGES: u8 = 4;
        let opacity = self.seen * self.opacity * (1.0 - self.glow);
        let roundness = smooth((self.radius - 1.0) / 2.0);
        let key = Key::new(lamps, self.place);
        let way = Way::new(self.tail, self.head);
        self.stroke(0.5).each_pixel(canvas.width, canvas.height, |touch| {
            let (along, beside) = way.nearest(&touch);
            let radius = |edge: u8| self.radius - 0.5 + (f32::from(edge) + 0.5) / f32::from(EDGES);
            let passing =
                |edge: u8| way.within(radius(edge), along, beside.length()).map_or(0.0, |(from, to)| to - from);
            let covered = (0..EDGES).map(passing).sum::<f32>() / f32::from(EDGES);
            let clear = self.thickness((beside / self.radius).clamp_length_max(1.0), roundness);
            let share = opacity * clear * covered * self.open(canvas, touch.pixel, touch.along);
            if share > 0.0 {
                // The mean of two instants while it passes, at the places of Gauss and Legendre.
                let (from, to) = way.within(self.radius, along, beside.length()).unwrap_or((along, along));
                let face = |place: f32| {
                    let gone = 0.5 * (from + to) + 0.5 * (to - from) * place - along;
                    self.ball(((beside - gone * way.length * way.direction) / self.radius).clamp_length_max(1.0), &key)
                };
                let ball = || 0.5 * (face(-0.577_350_3) + face(0.577_350_3));
                let color = if roundness > 0.0 { self.color.lerp(ball(), roundness) } else { self.color };
                let panes = self.panes(canvas, &touch);
                canvas.cover(touch.pixel, panes.through(self.haze.through(color)), share);
            }
        });
    }

    /// The same for light: each pixel gets the mean of what a still glow at each instant would shed on it.
    fn paint_shining_way(&self, canvas: &mut Canvas, bloom: &mut Bloom) {
        /// Places and weights of Gauss and Legendre on −1 to 1, exact for a polynomial of the seventh degree, which light along a way is.
        const GAUSS: [(f32, f32); 4] = [
            (-0.861_136_3, 0.347_854_8),
            (-0.339_981_04, 0.652_145_2),
            (0.339_981_04, 0.652_145_2),
            (0.861_136_3, 0.347_854_8),
        ];
        let stroke = self.stroke((HALO - 1.0) * self.radius + 1.0);
        let strength = BRIGHTNESS * self.seen * self.opacity * self.glow;
        let way = Way::new(self.tail, self.head);
        let mut shed = 0.0;
        stroke.each_pixel(canvas.width, canvas.height, |touch| {
            let (along, beside) = way.nearest(&touch);
            let Some((from, to)) = way.within(stroke.radius, along, beside.length()) else { return };
            let light = |(place, weight): (f32, f32)| {
                let off = (0.5 * (from + to) + 0.5 * (to - from) * place - along) * way.length;
                let out = (beside.length_squared() + off * off) / (stroke.radius * stroke.radius);
                weight * fall(out)
            };
            let mean = 0.5 * (to - from) * GAUSS.into_iter().map(light).sum::<f32>();
            let share = strength * mean * self.open(canvas, touch.pixel, touch.along);
            shed += self.shed(canvas, &touch, share);
        });
        bloom.shine(self.tail.midpoint(self.head), BLOOM * shed * self.haze.clear * self.color);
    }

    fn stroke(&self, wider: f32) -> Stroke {
        Stroke { from: self.tail, to: self.head, radius: self.radius + wider }
    }

    /// Sheds light on a pixel, as far as air and what is clear let it through; returns what the latter does.
    fn shed(&self, canvas: &mut Canvas, touch: &Touch, share: f32) -> f32 {
        let clear = self.panes(canvas, touch).clear;
        canvas.shine(touch.pixel, self.color, share, self.haze.clear * clear);
        share * clear
    }

    fn depth_at(&self, along: f32) -> f32 {
        self.tail_depth + along * (self.depth - self.tail_depth)
    }

    /// The clear things before a place along its streak. What lies on glass is before it.
    fn panes(&self, canvas: &Canvas, touch: &Touch) -> Haze {
        canvas.before(touch.pixel, self.depth_at(touch.along), 0.5 * self.reach)
    }

    /// How much of a pixel is open to the dot at a place along its streak. Dots that lie on a
    /// surface are half in it, and yet should be seen whole; the more so the more they glow.
    fn open(&self, canvas: &Canvas, pixel: usize, along: f32) -> f32 {
        let depth = self.depth_at(along);
        canvas.open(pixel, depth - (1.5 + 2.5 * self.glow) * self.reach, self.reach)
    }

    /// How much of a pixel is open to a place on a solid ball's face, from the middle, 0, to the outline, 1.
    fn open_to_face(&self, canvas: &Canvas, pixel: usize, at: Vec2) -> f32 {
        canvas.open(pixel, self.depth - (bulge(at) + SINK) * self.reach, SINK * self.reach)
    }
}
