//! The renderer: the backdrop once, then the moving things for each frame.

use super::backdrop::Backdrop;
use super::billboard::Placed;
use super::bloom::Bloom;
use super::canvas::{Canvas, Exposure};
use super::color::{CODEC, grain};
use super::contact::{self, Caster};
use super::eye::Eye;
use super::lamp::Lamp;
use super::model::Model;
use super::rays::Rays;
use super::segments::Wire;
use super::shade::Shader;
use super::sprite::Sprite;
use super::{Flipbook, Moving, Stage};
use glam::Vec3;
use image::RgbImage;
use pointmass::material::Blend;
use std::sync::Arc;

/// Draws pictures of one stage.
#[derive(Debug)]
pub struct Renderer {
    eye: Eye,
    lamps: Vec<Lamp>,
    rays: Rays,
    backdrop: Backdrop,
    /// The direction of the world's +y, in view coordinates.
    up: Vec3,
    pictures: Arc<[Flipbook]>,
}

/// The picture that is the mean of some of one size, in linear light.
pub fn develop(exposures: &[Exposure]) -> RgbImage {
    let Some((first, others)) = exposures.split_first() else { return RgbImage::default() };
    let mut sum = first.colors.clone();
    for other in others {
        sum.iter_mut().zip(&other.colors).for_each(|(sum, color)| *sum += color);
    }
    let share = 1.0 / exposures.len() as f32;
    let pixel = |(at, color): (usize, &Vec3)| CODEC.encode(color * share, grain(at % first.width, at / first.width));
    let bytes = sum.iter().enumerate().flat_map(pixel).collect();
    // The bytes are exactly as many as the picture has; an empty one is as good as any other.
    RgbImage::from_raw(first.width as u32, first.height as u32, bytes).unwrap_or_default()
}

/// Something to paint, at its depth.
enum Mover<'a> {
    Sprite(Sprite),
    Billboard(Placed<'a>),
    Wire(Wire),
}

impl Renderer {
    /// Draws everything that stands still, for pictures of a size in pixels.
    pub fn new(stage: &Stage, width: u32, height: u32) -> Self {
        let eye = Eye::new(stage, width, height);
        let lens = &eye.lens;
        let lamps: Vec<_> = stage.lights.iter().filter_map(|light| Lamp::new(light, lens)).collect();
        let model = Model::new(stage, lens);
        let rays = Rays::new(&model, lens);
        let up = lens.turn.y_axis;
        let backdrop = Backdrop::new(&model, &Shader { eye: &eye, lamps: &lamps, rays: &rays, up });
        Self { eye, lamps, rays, backdrop, up, pictures: stage.pictures.clone() }
    }

    /// Draws a frame.
    pub fn frame(&self, moving: &Moving<'_>) -> RgbImage {
        develop(&[self.expose(moving)])
    }

    /// Draws a frame, to be developed alone or with others.
    pub fn expose(&self, moving: &Moving<'_>) -> Exposure {
        let lens = &self.eye.lens;
        let mut canvas = Canvas::new(&self.backdrop, lens.width, lens.height);
        let mut bloom = Bloom::new(lens.width, lens.height);

        let movers = self.movers(moving);
        let order = back_to_front(&movers);
        for caster in order.iter().filter_map(|&at| movers[at as usize].caster()) {
            contact::paint(&caster, &self.rays, self.up, lens, &mut canvas);
        }
        for &at in &order {
            match &movers[at as usize] {
                Mover::Sprite(sprite) => sprite.paint(&mut canvas, &mut bloom, &self.lamps),
                Mover::Billboard(board) => board.paint(&mut canvas),
                Mover::Wire(wire) => wire.paint(&mut canvas),
            }
        }
        bloom.spread();
        canvas.expose(&bloom)
    }

    /// The moving things that can be seen.
    fn movers(&self, moving: &Moving<'_>) -> Vec<Mover<'_>> {
        let Self { eye, pictures, .. } = self;
        let sprites = moving.dots.iter().filter_map(|dot| Sprite::new(dot, moving.exposed, eye));
        let boards = moving.billboards.iter().filter_map(|board| Placed::new(board, pictures, eye));
        let lines = moving.segments.iter().filter_map(|line| Wire::new(line, false, eye));
        let wires = lines.chain(Wire::ribbons(moving.ribbons, eye)).map(Mover::Wire);
        wires.chain(sprites.map(Mover::Sprite)).chain(boards.map(Mover::Billboard)).collect()
    }
}

/// The numbers of movers in the order to draw them, the farthest first; those at one depth keep their order, so that pictures do not
/// flicker.
fn back_to_front(movers: &[Mover<'_>]) -> Vec<u32> {
    // Depths are above zero, and such numbers are in the order of their bits.
    let mut order: Vec<_> = movers.iter().zip(0..).map(|(mover, at)| (!mover.depth().to_bits(), at)).collect();
    order.sort_unstable();
    order.into_iter().map(|(_, at)| at).collect()
}

impl Mover<'_> {
    fn depth(&self) -> f32 {
        match self {
            Self::Sprite(sprite) => sprite.depth,
            Self::Billboard(board) => board.depth,
            Self::Wire(wire) => wire.depth,
        }
    }

    /// The shadow or light that it casts on the ground under it; lines cast none.
    fn caster(&self) -> Option<Caster> {
        match self {
            Self::Sprite(sprite) => {
                let Sprite { place, reach, opacity, glow, color, haze, .. } = *sprite;
                Some(Caster { place, reach, opacity: opacity * haze.clear, glow, color })
            }
            Self::Billboard(board) => {
                let glow = f32::from(u8::from(board.blend == Blend::Additive));
                // A picture covers about half of its square.
                let Placed { place, reach, opacity, color, haze, .. } = *board;
                Some(Caster { place, reach, opacity: 0.5 * opacity * haze.clear, glow, color })
            }
            Self::Wire(_) => None,
        }
    }
}
