//! The picture while it is being painted.

use super::air::Haze;
use super::backdrop::{Backdrop, DEPTHS};
use super::bloom::Bloom;
use super::color::luminance;
use glam::Vec3;

/// A copy of the backdrop's colours to paint on, and its depths to hide behind.
#[derive(Debug)]
pub(super) struct Canvas<'a> {
    pub(super) width: usize,
    pub(super) height: usize,
    backdrop: &'a Backdrop,
    pixels: Vec<Pixel>,
}

/// A picture in linear light, of one instant.
#[derive(Clone, Debug)]
pub struct Exposure {
    pub(super) width: usize,
    pub(super) height: usize,
    pub(super) colors: Vec<Vec3>,
}

/// Paint, which covers what is under it, and light, which adds up and is only bent into the range
/// of a picture at the end.
#[derive(Clone, Copy, Debug)]
struct Pixel {
    color: Vec3,
    light: Light,
}

/// Light in whole numbers of 2⁻²⁰, so that sums of it do not depend on the order.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Light([u32; 3]);

impl Light {
    const ONE: f32 = 1_048_576.0;

    /// Casts send what is below zero, or not a number, to zero; sums stop at 4095.
    fn add(&mut self, light: Vec3) {
        for (sum, more) in self.0.iter_mut().zip((light * Self::ONE + 0.5).to_array()) {
            *sum = sum.saturating_add(more as u32);
        }
    }

    fn get(self) -> Vec3 {
        Vec3::from(self.0.map(|sum| sum as f32)) * (1.0 / Self::ONE)
    }

    /// Leaves as much of it as comes through something of an opacity.
    fn behind(&mut self, opacity: f32) {
        if self.0 != [0; 3] {
            let left = self.get() * (1.0 - opacity);
            self.0 = [0; 3];
            self.add(left);
        }
    }
}

impl<'a> Canvas<'a> {
    pub(super) fn new(backdrop: &'a Backdrop, width: usize, height: usize) -> Self {
        let blank = |&color: &Vec3| Pixel { color, light: Light::default() };
        let pixels = backdrop.colors.iter().map(blank).collect();
        Self { width, height, backdrop, pixels }
    }

    /// How much of a pixel is open to something at a depth: 1 as long as the backdrop is behind
    /// `depth`, falling to 0 where the backdrop is `softness` in front of it.
    pub(super) fn open(&self, pixel: usize, depth: f32, softness: f32) -> f32 {
        let depths = &self.backdrop.depths[pixel];
        let nearer = |a: f32, b: f32| if a < b { a } else { b };
        let [a, b, c, d] = *depths;
        if nearer(nearer(a, b), nearer(c, d)) >= depth {
            return 1.0;
        }
        let share = |&wall: &f32| (1.0 + (wall - depth) / softness).clamp(0.0, 1.0);
        depths.iter().map(share).sum::<f32>() / DEPTHS as f32
    }

    /// What the clear things before a depth do to light from there: nothing where they are behind `depth`, and all where they are `softness`
    /// in front of it. Of a colour c that is laid over what is there, less comes through and theirs is added, as it has been to what is there.
    pub(super) fn before(&self, pixel: usize, depth: f32, softness: f32) -> Haze {
        self.backdrop.before(pixel, depth, softness)
    }

    /// The share of a pixel's samples whose depth is about `depth`.
    pub(super) fn lies_at(&self, pixel: usize, depth: f32, tolerance: f32) -> f32 {
        let near = self.backdrop.depths[pixel].iter().filter(|&&wall| (wall - depth).abs() < tolerance);
        near.count() as f32 / DEPTHS as f32
    }

    /// Lays paint over a pixel.
    pub(super) fn cover(&mut self, pixel: usize, color: Vec3, opacity: f32) {
        let pixel = &mut self.pixels[pixel];
        pixel.color = pixel.color.lerp(color, opacity);
        pixel.light.behind(opacity);
    }

    /// Lays over a pixel what has been multiplied by its opacity.
    pub(super) fn over(&mut self, pixel: usize, color: Vec3, opacity: f32) {
        let pixel = &mut self.pixels[pixel];
        pixel.color = pixel.color * (1.0 - opacity) + color;
        pixel.light.behind(opacity);
    }

    /// Adds light to a pixel, to the same sum in any order.
    pub(super) fn add(&mut self, pixel: usize, light: Vec3) {
        self.pixels[pixel].light.add(light);
    }

    /// Sheds light on a pixel, of which a share arrives. What is bright already cannot show light; there the same amount of
    /// paint is laid on instead, and no more of it arrives than of the light.
    pub(super) fn shine(&mut self, pixel: usize, color: Vec3, strength: f32, clear: f32) {
        let pixel = &mut self.pixels[pixel];
        let bright = (luminance(pixel.color) * strength).min(1.0);
        pixel.color = pixel.color.lerp(color, clear * bright);
        pixel.light.add(strength * (clear * color));
    }

    /// Lets a surface return some more or less of the light that falls on it.
    pub(super) fn tint(&mut self, pixel: usize, factor: Vec3) {
        self.pixels[pixel].color *= factor;
    }

    /// The finished picture, in linear light.
    pub(super) fn expose(&self, bloom: &Bloom) -> Exposure {
        let mut colors = Vec::with_capacity(self.pixels.len());
        for y in 0..self.height {
            let shine = bloom.row(y);
            for (x, pixel) in self.pixels[y * self.width..][..self.width].iter().enumerate() {
                let light = pixel.light.get() + shine.as_ref().map_or(Vec3::ZERO, |shine| shine(x));
                colors.push(expose(pixel.color, light));
            }
        }
        Exposure { width: self.width, height: self.height, colors }
    }
}

/// Adds light to a colour without ever going past white: colours no light falls on stay exactly as
/// they are, and strong light of any colour turns white in the end, as flames do in photographs.
fn expose(color: Vec3, light: Vec3) -> Vec3 {
    if light == Vec3::ZERO {
        return color;
    }
    let light = light + 0.12 * (light.max_element() - 1.0).max(0.0);
    1.0 - (1.0 - color.min(Vec3::ONE)) / (1.0 + light)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn light_adds_up_gently() {
        let color = Vec3::new(0.2, 0.4, 0.6);
        assert_eq!(expose(color, Vec3::ZERO), color);
        let mut last = color;
        for step in 1..100 {
            let lit = expose(color, Vec3::splat(0.2 * step as f32));
            assert!(lit.cmpgt(last).all() && lit.max_element() < 1.0);
            last = lit;
        }
        assert!(last.min_element() > 0.95);
    }
}
