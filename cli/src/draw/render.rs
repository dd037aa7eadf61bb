//! The renderer: the backdrop once, then the moving things for each frame.

use super::backdrop::Backdrop;
use super::billboard::Placed;
use super::bloom::Bloom;
use super::camera::Lens;
use super::canvas::Canvas;
use super::clip::Frustum;
use super::color::Codec;
use super::contact::{self, Caster};
use super::lamp::Lamp;
use super::model::Model;
use super::rays::Rays;
use super::segments::Thread;
use super::shade::Shader;
use super::sky::Sky;
use super::sprite::Sprite;
use super::{Flipbook, Moving, Stage};
use glam::Vec3;
use image::RgbImage;
use pointmass::material::Blend;
use std::sync::Arc;

/// Draws pictures of one stage.
#[derive(Debug)]
pub struct Renderer {
    lens: Lens,
    frustum: Frustum,
    codec: Codec,
    lamps: Vec<Lamp>,
    rays: Rays,
    backdrop: Backdrop,
    /// The direction of the world's +y, in view coordinates.
    up: Vec3,
    pictures: Arc<[Flipbook]>,
}

/// Something to paint, at its depth.
enum Mover<'a> {
    Sprite(Sprite),
    Billboard(Placed<'a>),
    Thread(Thread),
}

impl Renderer {
    /// Draws everything that stands still, for pictures of a size in pixels.
    pub fn new(stage: &Stage, width: u32, height: u32) -> Self {
        let lens = Lens::new(&stage.camera, width as usize, height as usize);
        let lamps: Vec<_> = stage.lights.iter().filter_map(|light| Lamp::new(light, &lens)).collect();
        let model = Model::new(stage, &lens);
        let rays = Rays::new(&model, &lens);
        let up = lens.turn.y_axis;
        let sky = Sky::new(stage.background, lens.height);
        let backdrop = Backdrop::new(&lens, &model, &Shader { sky, lamps: &lamps, rays: &rays, up });
        let pictures = stage.pictures.clone();
        Self { lens, frustum: Frustum::new(&lens), codec: Codec::new(), lamps, rays, backdrop, up, pictures }
    }

    /// Draws a frame.
    pub fn frame(&self, moving: &Moving<'_>) -> RgbImage {
        let (width, height) = (self.lens.width, self.lens.height);
        let mut canvas = Canvas::new(&self.backdrop, width, height);
        let mut bloom = Bloom::new(width, height);

        let movers = self.back_to_front(moving);
        for caster in movers.iter().filter_map(Mover::caster) {
            contact::paint(&caster, &self.rays, self.up, &self.lens, &mut canvas);
        }
        for mover in &movers {
            match mover {
                Mover::Sprite(sprite) => sprite.paint(&mut canvas, &mut bloom, &self.lamps),
                Mover::Billboard(board) => board.paint(&mut canvas),
                Mover::Thread(thread) => thread.paint(&mut canvas),
            }
        }
        bloom.spread();
        canvas.develop(&bloom, &self.codec)
    }

    /// The moving things that can be seen, the farthest first.
    fn back_to_front(&self, moving: &Moving<'_>) -> Vec<Mover<'_>> {
        let Self { lens, frustum, codec, pictures, .. } = self;
        let sprites = moving.dots.iter().filter_map(|dot| Sprite::new(dot, lens, frustum, codec));
        let boards = moving.billboards.iter().filter_map(|board| Placed::new(board, pictures, lens, codec));
        let lines = moving.segments.iter().map(|line| (line, false));
        let lines = lines.chain(moving.ribbons.iter().map(|line| (line, true)));
        let threads = lines.filter_map(|(line, joined)| Thread::new(line, joined, lens, frustum, codec));
        let threads = threads.map(Mover::Thread);
        let mut movers: Vec<_> =
            threads.chain(sprites.map(Mover::Sprite)).chain(boards.map(Mover::Billboard)).collect();
        // Stable, so that things at one depth keep their order and pictures do not flicker.
        movers.sort_by(|a, b| b.depth().total_cmp(&a.depth()));
        movers
    }
}

impl Mover<'_> {
    fn depth(&self) -> f32 {
        match self {
            Self::Sprite(sprite) => sprite.depth,
            Self::Billboard(board) => board.depth,
            Self::Thread(thread) => thread.depth,
        }
    }

    /// The shadow or light that it casts on the ground under it; lines cast none.
    fn caster(&self) -> Option<Caster> {
        match self {
            Self::Sprite(sprite) => {
                let Sprite { place, reach, opacity, glow, color, .. } = *sprite;
                Some(Caster { place, reach, opacity, glow, color })
            }
            Self::Billboard(board) => {
                let glow = f32::from(u8::from(board.blend == Blend::Additive));
                // A picture covers about half of its square.
                let Placed { place, reach, opacity, color, .. } = *board;
                Some(Caster { place, reach, opacity: 0.5 * opacity, glow, color })
            }
            Self::Thread(_) => None,
        }
    }
}
