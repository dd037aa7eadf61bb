//! A picture that stands in space, in the picture.

use super::Billboard;
use super::air::Haze;
use super::brush::middles;
use super::camera::Lens;
use super::canvas::Canvas;
use super::color::CODEC;
use super::eye::Eye;
use super::picture::{Flipbook, Frame};
use glam::{Mat2, Vec2, Vec3, Vec4};
use pointmass::material::Blend;
use std::ops::Range;

/// The least half width of a picture that is drawn, in pixels; what is smaller is drawn fainter instead.
const SMALLEST: f32 = 0.7;

/// A billboard as the lens sees it.
pub(super) struct Placed<'a> {
    /// Where it is, in view coordinates.
    pub(super) place: Vec3,
    /// Half its size in the world.
    pub(super) reach: f32,
    pub(super) opacity: f32,
    pub(super) color: Vec3,
    pub(super) depth: f32,
    pub(super) blend: Blend,
    frame: Frame<'a>,
    middle: Vec2,
    /// From pixels to the picture's own measure, −1 to 1.
    flatten: Mat2,
    /// Half its width and its height, in pixels.
    half: Vec2,
    /// How far it reaches to the sides and up and down, in pixels.
    extent: Vec2,
    /// How deep in a surface it still shows whole, in halves of its size.
    sunk: f32,
    /// The haze before it.
    pub(super) haze: Haze,
}

impl<'a> Placed<'a> {
    /// Brings a billboard before the lens; `None` if it cannot be seen.
    pub(super) fn new(board: &Billboard, pictures: &'a [Flipbook], eye: &Eye) -> Option<Self> {
        let Eye { lens, .. } = eye;
        let frame = pictures.get(board.picture)?.frame(board.frame)?;
        let place = lens.view(board.center);
        let depth = Lens::depth(place);
        let reach = board.right.length().max(board.up.length());
        if !(place.is_finite() && reach.is_finite() && (lens.near..=lens.far).contains(&depth)) {
            return None;
        }
        let scale = lens.pixels_per_metre(depth);
        // Its sides in the picture, as if all of it were as far as its middle.
        let side = |way: Vec3| (lens.turn * way).truncate() * Vec2::new(scale, -scale);
        let (right, up) = (side(board.right), side(board.up));
        let half = right.length().max(up.length());
        let (faint, grown) = ((half / SMALLEST).min(1.0), (SMALLEST / half).max(1.0));
        let (right, up) = (right * grown, up * grown);
        // What is seen from its edge alone is a line.
        let lie = Mat2::from_cols(right, up);
        let thin = lie.determinant().abs() < 0.02 * half * half * grown * grown;
        let lie = if thin { Mat2::from_cols(right + 0.02 * up.perp(), up + 0.02 * right.perp()) } else { lie };
        let (color, opacity) = CODEC.decode(board.color);
        let placed = Self {
            place,
            reach,
            opacity: opacity * faint * faint,
            color,
            depth,
            blend: board.blend,
            frame,
            middle: lens.project(place),
            flatten: lie.inverse(),
            half: Vec2::new(right.length(), up.length()),
            extent: right.abs() + up.abs() + 1.0,
            sunk: board.sunk,
            haze: eye.haze(place),
        };
        let seen =
            placed.middle.is_finite() && placed.flatten.is_finite() && placed.half.max_element() < 1e5 && opacity > 0.0;
        seen.then_some(placed)
    }

    /// Paints it, softly where it stands in something.
    pub(super) fn paint(&self, canvas: &mut Canvas) {
        let look = self.frame.at_width(2.0 * self.half.max_element());
        let softness = if self.blend == Blend::Opaque { 0.1 * self.reach } else { self.reach };
        let depth = self.depth + softness - self.sunk * self.reach;
        let (reach, margin) = (1.0 + 0.5 / self.half, self.extent);
        for y in middles(self.middle.y - margin.y, self.middle.y + margin.y, canvas.height) {
            let down = y as f32 + 0.5 - self.middle.y;
            let row = Row { start: self.flatten.y_axis * down, step: self.flatten.x_axis, middle: self.middle.x };
            for x in row.columns(reach, canvas.width) {
                let at = row.at(x);
                // The part of the pixel that lies within its sides.
                let within = ((Vec2::ONE - at.abs()) * self.half + 0.5).clamp(Vec2::ZERO, Vec2::ONE);
                let texel = look(at);
                if texel.w > 0.0 || texel != Vec4::ZERO {
                    let pixel = y * canvas.width + x;
                    let share = self.opacity * within.x * within.y * canvas.open(pixel, depth, 2.0 * softness);
                    let panes = canvas.before(pixel, depth, 2.0 * softness);
                    self.lay(canvas, pixel, (texel, panes), share);
                }
            }
        }
    }

    /// Lays a share of a texel, which is seen through some panes, over a pixel.
    fn lay(&self, canvas: &mut Canvas, pixel: usize, (texel, panes): (Vec4, Haze), share: f32) {
        let (color, opacity) = (texel.truncate() * self.color, texel.w);
        let color = [self.haze, panes].into_iter().fold(color, |color, haze| {
            let light = if self.blend == Blend::Additive { Vec3::ZERO } else { opacity * haze.light };
            color * haze.clear + light
        });
        match self.blend {
            Blend::Alpha | Blend::Premultiplied => canvas.over(pixel, color * share, opacity * share),
            Blend::Additive => canvas.add(pixel, color * share),
            Blend::Opaque => {
                let there = ((opacity - 0.5) * 4.0 + 0.5).clamp(0.0, 1.0) * share;
                canvas.over(pixel, color / opacity.max(1e-3) * there, there);
            }
        }
    }
}

/// A row of pixels in a picture's own measure, which changes evenly along it.
struct Row {
    /// The place straight above or below the picture's middle, and the change from pixel to pixel.
    start: Vec2,
    step: Vec2,
    /// Where that middle is, in pixels.
    middle: f32,
}

impl Row {
    /// The place of the middle of a pixel.
    fn at(&self, x: usize) -> Vec2 {
        self.start + self.step * (x as f32 + 0.5 - self.middle)
    }

    /// The pixels that lie within a reach of the picture's middle, in both directions.
    fn columns(&self, reach: Vec2, width: usize) -> Range<usize> {
        let (mut low, mut high) = (f32::NEG_INFINITY, f32::INFINITY);
        for (start, step, reach) in [(self.start.x, self.step.x, reach.x), (self.start.y, self.step.y, reach.y)] {
            if step.abs() > 1e-9 {
                let (a, b) = ((-reach - start) / step, (reach - start) / step);
                (low, high) = (low.max(a.min(b)), high.min(a.max(b)));
            } else if start.abs() > reach {
                return 0..0;
            }
        }
        middles(self.middle + low, self.middle + high, width)
    }
}
