//! The picture of everything that stands still.

use super::air::Haze;
use super::camera::Lens;
use super::clip::Frustum;
use super::model::{Facet, Model};
use super::panes::Panes;
use super::raster::{Band, SAMPLES, Sample, Triangle};
use super::shade::Shader;
use glam::{Vec2, Vec3};
use rayon::prelude::*;

/// How many rows are drawn at a time; all samples of so many fit into the processor's cache.
const BAND: usize = 16;

/// How many of a pixel's depths are kept.
pub(super) const DEPTHS: usize = 4;

/// Linear colours, and depths to draw moving things into, row by row.
#[derive(Debug)]
pub(super) struct Backdrop {
    pub(super) colors: Vec<Vec3>,
    width: usize,
    /// The depths of a few samples of each pixel; infinite where there is nothing.
    pub(super) depths: Vec<[f32; DEPTHS]>,
    /// What lets light through, for each band of rows; no bands where there is nothing of that.
    panes: Vec<Panes>,
}

impl Backdrop {
    /// Draws a model, on all threads of the pool that it is called in. Bands know nothing of each other, so the picture does not
    /// depend on how many there are.
    pub(super) fn new(model: &Model, shader: &Shader) -> Self {
        let lens = &shader.eye.lens;
        let count = lens.width * lens.height;
        let mut colors = vec![Vec3::ZERO; count];
        let mut depths = vec![[f32::INFINITY; DEPTHS]; count];

        let visible = in_order(lens, model);
        let size = (BAND * lens.width).max(1);
        let bands = colors.par_chunks_mut(size).zip(depths.par_chunks_mut(size)).enumerate();
        let panes = bands.map(|(number, (colors, depths))| {
            let rows = colors.len() / lens.width;
            let sky = |x, y| shader.eye.air.sky.at(Vec2::new(x as f32, y as f32) + 0.5);
            let mut panes = Panes::default();
            let mut band = Band::new(BAND * number, rows, lens.width, sky);
            let opaque = visible.iter().filter(|(facet, _)| model.skins[facet.skin].opacity >= 1.0);
            opaque.for_each(|(_, triangle)| band.hide(triangle));
            for (facet, triangle) in &visible {
                let skin = &model.skins[facet.skin];
                band.paint(triangle, skin.opacity, |part| {
                    let color = shader.color(facet, skin, part);
                    if skin.opacity < 1.0 {
                        let pixel = (part.y - BAND * number) * lens.width + part.x;
                        panes.add(pixel, &part, (facet.skin, skin.opacity), color);
                    }
                    color
                });
            }
            for ((color, depth), samples) in colors.iter_mut().zip(depths).zip(&band.samples) {
                *color = mean(samples);
                *depth = std::array::from_fn(|at| samples[at].depth);
            }
            panes.sorted()
        });
        let mut panes: Vec<_> = panes.collect();
        if panes.iter().all(Panes::is_empty) {
            panes.clear();
        }
        Self { colors, width: lens.width, depths, panes }
    }

    /// What the clear things before a depth do to light from there on its way through a pixel.
    pub(super) fn before(&self, pixel: usize, depth: f32, softness: f32) -> Haze {
        if self.panes.is_empty() {
            return Haze::NONE;
        }
        let size = BAND * self.width;
        self.panes[pixel / size].before(pixel % size, depth, softness)
    }
}

/// The triangles in the picture in the order to draw them: what is opaque, then what is not, from
/// the back to the front.
fn in_order<'a>(lens: &Lens, model: &'a Model) -> Vec<(&'a Facet, Triangle)> {
    let is_opaque = |facet: &&Facet| model.skins[facet.skin].opacity >= 1.0;
    let (opaque, mut clear): (Vec<&Facet>, Vec<&Facet>) = model.facets.iter().partition(is_opaque);
    clear.sort_by(|a, b| b.depth().total_cmp(&a.depth()));
    let frustum = Frustum::new(lens);
    let mut visible = Vec::new();
    for facet in opaque.into_iter().chain(clear) {
        let polygon = frustum.clip(facet.corners.to_vec());
        for side in polygon.windows(2).skip(1) {
            let triangle = Triangle::new([polygon[0], side[0], side[1]], lens);
            visible.extend(triangle.map(|triangle| (facet, triangle)));
        }
    }
    visible
}

fn mean(samples: &[Sample; SAMPLES.len()]) -> Vec3 {
    samples.iter().map(|sample| sample.color).sum::<Vec3>() / samples.len() as f32
}
