//! What stands still and lets light through, for what moves behind it.

use super::air::Haze;
use super::camera::Lens;
use super::raster::{Fragment, SAMPLES};
use glam::Vec3;

/// A layer of something clear before a pixel.
#[derive(Clone, Copy, Debug)]
struct Layer {
    /// The pixel's number in its strip of the picture.
    pixel: u32,
    /// The samples of the pixel that it covers, a bit each.
    samples: u8,
    /// The number of its material.
    skin: u32,
    opacity: f32,
    color: Vec3,
    depth: f32,
}

/// The layers before a strip of the picture: those of a pixel beside each other, in the order in which they have been painted, the
/// farthest first.
#[derive(Debug, Default)]
pub(super) struct Panes(Vec<Layer>);

impl Panes {
    /// Adds what a triangle shows in a pixel.
    pub(super) fn add(&mut self, pixel: usize, part: &Fragment, (skin, opacity): (usize, f32), color: Vec3) {
        if opacity > 0.0 {
            let (samples, depth) = (part.samples, Lens::depth(part.at.place));
            self.0.push(Layer { pixel: pixel as u32, samples, skin: skin as u32, opacity, color, depth });
        }
    }

    pub(super) fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Sorts them by pixels. The triangles of a thing beside each other in a pixel are one layer.
    pub(super) fn sorted(mut self) -> Self {
        self.0.sort_by_key(|layer| layer.pixel);
        self.0.dedup_by(|next, last| {
            let is_beside = last.pixel == next.pixel && last.skin == next.skin && last.samples & next.samples == 0;
            if is_beside {
                let share = next.samples.count_ones() as f32 / (last.samples | next.samples).count_ones() as f32;
                last.color = last.color.lerp(next.color, share);
                last.depth += share * (next.depth - last.depth);
                last.samples |= next.samples;
            }
            is_beside
        });
        self.0.shrink_to_fit();
        self
    }

    /// What layers before a depth do to light from there on its way through a pixel: those at the depth itself nothing, and all that they do
    /// those that are `softness` before it.
    pub(super) fn before(&self, pixel: usize, depth: f32, softness: f32) -> Haze {
        let mut haze = Haze::NONE;
        let first = self.0.partition_point(|layer| (layer.pixel as usize) < pixel);
        for layer in self.0[first..].iter().take_while(|layer| layer.pixel as usize == pixel) {
            let covered = layer.samples.count_ones() as f32 / SAMPLES.len() as f32;
            let opacity = layer.opacity * covered * ((depth - layer.depth) / softness).clamp(0.0, 1.0);
            haze = Haze {
                clear: haze.clear * (1.0 - opacity),
                light: haze.light * (1.0 - opacity) + opacity * layer.color,
            };
        }
        haze
    }
}
