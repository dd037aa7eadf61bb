//! The renderer: the backdrop once, then the moving things for each frame.

use super::backdrop::Backdrop;
use super::bloom::Bloom;
use super::camera::Lens;
use super::canvas::Canvas;
use super::clip::Frustum;
use super::color::Codec;
use super::lamp::Lamp;
use super::model::Model;
use super::rays::Rays;
use super::segments::Thread;
use super::shade::Shader;
use super::sky::Sky;
use super::sprite::Sprite;
use super::{Dot, Segment, Stage, contact};
use glam::Vec3;
use image::RgbImage;

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
}

/// Something to paint, at its depth.
enum Mover {
    Sprite(Sprite),
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
        Self { lens, frustum: Frustum::new(&lens), codec: Codec::new(), lamps, rays, backdrop, up }
    }

    /// Draws a frame.
    pub fn frame(&self, dots: &[Dot], segments: &[Segment]) -> RgbImage {
        let (width, height) = (self.lens.width, self.lens.height);
        let mut canvas = Canvas::new(&self.backdrop, width, height);
        let mut bloom = Bloom::new(width, height);

        let movers = self.back_to_front(dots, segments);
        for mover in &movers {
            if let Mover::Sprite(sprite) = mover {
                contact::paint(sprite, &self.rays, self.up, &self.lens, &mut canvas);
            }
        }
        for mover in &movers {
            match mover {
                Mover::Sprite(sprite) => sprite.paint(&mut canvas, &mut bloom, &self.lamps),
                Mover::Thread(thread) => thread.paint(&mut canvas),
            }
        }
        bloom.spread();
        canvas.develop(&bloom, &self.codec)
    }

    /// What can be seen of the moving things, the farthest first.
    fn back_to_front(&self, dots: &[Dot], segments: &[Segment]) -> Vec<Mover> {
        let Self { lens, frustum, codec, .. } = self;
        let sprites = dots.iter().filter_map(|dot| Sprite::new(dot, lens, frustum, codec));
        let threads = segments.iter().filter_map(|line| Thread::new(line, lens, frustum, codec));
        let mut movers: Vec<_> = threads.map(Mover::Thread).chain(sprites.map(Mover::Sprite)).collect();
        // Stable, so that things at one depth keep their order and pictures do not flicker.
        movers.sort_by(|a, b| b.depth().total_cmp(&a.depth()));
        movers
    }
}

impl Mover {
    fn depth(&self) -> f32 {
        match self {
            Self::Sprite(sprite) => sprite.depth,
            Self::Thread(thread) => thread.depth,
        }
    }
}
