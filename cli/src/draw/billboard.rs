//! A picture that stands in space, in the picture.

use super::Billboard;
use super::brush::Stroke;
use super::camera::Lens;
use super::canvas::Canvas;
use super::color::Codec;
use super::picture::{Flipbook, Frame};
use glam::{Mat2, Vec2, Vec3, Vec4};
use pointmass::material::Blend;

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
}

impl<'a> Placed<'a> {
    /// Brings a billboard before the lens; `None` if it cannot be seen.
    pub(super) fn new(board: &Billboard, pictures: &'a [Flipbook], lens: &Lens, codec: &Codec) -> Option<Self> {
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
        let (color, opacity) = codec.decode(board.color);
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
        };
        let seen =
            placed.middle.is_finite() && placed.flatten.is_finite() && placed.half.max_element() < 1e5 && opacity > 0.0;
        seen.then_some(placed)
    }

    /// Paints it, softly where it stands in something.
    pub(super) fn paint(&self, canvas: &mut Canvas) {
        let look = self.frame.at_width(2.0 * self.half.max_element());
        let softness = if self.blend == Blend::Opaque { 0.1 * self.reach } else { self.reach };
        let dab = Stroke::dab(self.middle, self.half.length() + 1.0);
        dab.each_pixel(canvas.width, canvas.height, |touch| {
            let at = self.flatten * touch.offset;
            // The part of the pixel that lies within its sides.
            let within = ((Vec2::ONE - at.abs()) * self.half + 0.5).clamp(Vec2::ZERO, Vec2::ONE);
            let texel = if within.min_element() > 0.0 { look(at) } else { Vec4::ZERO };
            if texel == Vec4::ZERO {
                return;
            }
            let share =
                self.opacity * within.x * within.y * canvas.open(touch.pixel, self.depth + softness, 2.0 * softness);
            let (color, opacity) = (texel.truncate() * self.color, texel.w);
            match self.blend {
                Blend::Alpha | Blend::Premultiplied => canvas.over(touch.pixel, color * share, opacity * share),
                Blend::Additive => canvas.add(touch.pixel, color * share),
                Blend::Opaque => {
                    let there = ((opacity - 0.5) * 4.0 + 0.5).clamp(0.0, 1.0) * share;
                    canvas.over(touch.pixel, color / opacity.max(1e-3) * there, there);
                }
            }
        });
    }
}
