//! Filling triangles, eight samples to a pixel.

use super::camera::Lens;
use super::clip::Vertex;
use glam::{Vec2, Vec3};

/// Where a pixel is looked at: eight places with no row and no column in common. The first four lie
/// in different quarters.
pub(super) const SAMPLES: [Vec2; 8] = [
    Vec2::new(9.0 / 16.0, 5.0 / 16.0),
    Vec2::new(7.0 / 16.0, 11.0 / 16.0),
    Vec2::new(13.0 / 16.0, 9.0 / 16.0),
    Vec2::new(5.0 / 16.0, 3.0 / 16.0),
    Vec2::new(3.0 / 16.0, 13.0 / 16.0),
    Vec2::new(1.0 / 16.0, 7.0 / 16.0),
    Vec2::new(11.0 / 16.0, 15.0 / 16.0),
    Vec2::new(15.0 / 16.0, 1.0 / 16.0),
];

/// Surfaces whose depths differ by less than this share lie in the same plane.
const COPLANAR: f32 = 1e-5;

/// The colour and depth that one of a pixel's samples sees.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sample {
    pub(super) color: Vec3,
    pub(super) depth: f32,
}

/// A strip of the picture, all samples of each pixel next to each other.
#[derive(Debug)]
pub(super) struct Band {
    pub(super) top: usize,
    pub(super) rows: usize,
    pub(super) width: usize,
    pub(super) samples: Vec<[Sample; SAMPLES.len()]>,
}

/// A triangle placed in the picture.
#[derive(Clone, Copy, Debug)]
pub(super) struct Triangle {
    points: [Vec2; 3],
    corners: [Vertex; 3],
    /// One over the depth; unlike the depth, it is linear across the picture.
    nearness: [f32; 3],
    /// Twice the area, positive whichever way the triangle turns.
    area: f32,
}

/// A pixel's share of a triangle, to be coloured.
#[derive(Clone, Copy, Debug)]
pub(super) struct Fragment {
    pub(super) x: usize,
    pub(super) y: usize,
    pub(super) at: Vertex,
    /// The samples of the pixel that it has, a bit each.
    pub(super) samples: u8,
}

impl Triangle {
    /// Places a triangle that lies in front of the eye; `None` if it is seen from its edge.
    pub(super) fn new(mut corners: [Vertex; 3], lens: &Lens) -> Option<Self> {
        let mut points = corners.map(|corner| lens.project(corner.place));
        let mut area = (points[1] - points[0]).perp_dot(points[2] - points[0]);
        if area < 0.0 {
            corners.swap(1, 2);
            points.swap(1, 2);
            area = -area;
        }
        let nearness = corners.map(|corner| 1.0 / Lens::depth(corner.place));
        (area > 0.0 && area.is_finite()).then_some(Self { points, corners, nearness, area })
    }

    /// The rows and columns it may touch, cut to a picture.
    fn bounds(&self) -> (Vec2, Vec2) {
        let [a, b, c] = self.points;
        (a.min(b).min(c), a.max(b).max(c))
    }

    /// The weights of the corners at a point of the picture; `None` outside.
    fn weights(&self, point: Vec2) -> Option<[f32; 3]> {
        let [a, b, c] = self.points;
        let weight = |from: Vec2, to: Vec2| {
            let (side, out) = (to - from, point - from);
            let weight = side.perp_dot(out);
            // A point on an edge belongs to one of the two triangles that share it.
            let inside = weight > 0.0 || weight == 0.0 && (side.y < 0.0 || side.y == 0.0 && side.x > 0.0);
            inside.then_some(weight / self.area)
        };
        Some([weight(b, c)?, weight(c, a)?, weight(a, b)?])
    }

    fn depth(&self, weights: [f32; 3]) -> f32 {
        1.0 / (0..3).map(|corner| weights[corner] * self.nearness[corner]).sum::<f32>()
    }

    /// The place, normal and tint at some weights, as perspective has it.
    fn vertex(&self, weights: [f32; 3]) -> Vertex {
        let depth = self.depth(weights);
        let mut vertex = Vertex { place: Vec3::ZERO, normal: Vec3::ZERO, tint: Vec3::ZERO };
        for ((corner, weight), nearness) in self.corners.iter().zip(weights).zip(self.nearness) {
            let share = weight * nearness * depth;
            vertex.place += share * corner.place;
            vertex.normal += share * corner.normal;
            vertex.tint += share * corner.tint;
        }
        vertex
    }
}

impl Band {
    /// An empty strip, filled with the colour of each column and row.
    pub(super) fn new(top: usize, rows: usize, width: usize, sky: impl Fn(usize, usize) -> Vec3) -> Self {
        let empty = |x, y| [Sample { color: sky(x, y), depth: f32::INFINITY }; SAMPLES.len()];
        let places = (top..top + rows).flat_map(|y| (0..width).map(move |x| (x, y)));
        let samples = places.map(|(x, y)| empty(x, y)).collect();
        Self { top, rows, width, samples }
    }

    /// Hides what is behind a triangle from what is painted later.
    pub(super) fn hide(&mut self, triangle: &Triangle) {
        self.each_pixel(triangle, |_, _, samples, weights| {
            for (sample, weights) in samples.iter_mut().zip(weights) {
                let depth = weights.map_or(f32::INFINITY, |weights| triangle.depth(weights));
                sample.depth = sample.depth.min(depth);
            }
        });
    }

    /// Paints a triangle where nothing hides it. `shade` is asked once for each pixel.
    pub(super) fn paint(&mut self, triangle: &Triangle, opacity: f32, mut shade: impl FnMut(Fragment) -> Vec3) {
        self.each_pixel(triangle, |x, y, samples, weights| {
            let (mut sum, mut count) = ([0.0; 3], 0.0);
            let hits = std::array::from_fn::<_, { SAMPLES.len() }, _>(|at| {
                let seen = |weights: &_| triangle.depth(*weights) <= samples[at].depth * (1.0 + COPLANAR);
                let Some(weights) = weights[at].filter(seen) else { return false };
                sum = [0, 1, 2].map(|at| sum[at] + weights[at]);
                count += 1.0;
                true
            });
            if count > 0.0 {
                // The middle of the samples that hit is always inside the triangle.
                let at = triangle.vertex(sum.map(|weight| weight / count));
                let covered = hits.iter().rev().fold(0, |bits, &hit| bits << 1 | u8::from(hit));
                let color = shade(Fragment { x, y, at, samples: covered });
                for (sample, _) in samples.iter_mut().zip(hits).filter(|(_, hit)| *hit) {
                    sample.color = sample.color.lerp(color, opacity);
                }
            }
        });
    }

    /// Visits the pixels a triangle may touch, with its weights at each sample.
    fn each_pixel(
        &mut self,
        triangle: &Triangle,
        mut visit: impl FnMut(usize, usize, &mut [Sample; SAMPLES.len()], [Option<[f32; 3]>; SAMPLES.len()]),
    ) {
        let (low, high) = triangle.bounds();
        let rows = within(low.y, high.y, self.top, self.top + self.rows);
        let columns = within(low.x, high.x, 0, self.width);
        for y in rows {
            for x in columns.clone() {
                let corner = Vec2::new(x as f32, y as f32);
                let samples = &mut self.samples[(y - self.top) * self.width + x];
                visit(x, y, samples, SAMPLES.map(|offset| triangle.weights(corner + offset)));
            }
        }
    }
}

/// The whole numbers from `low` to `high` that are also from `first` to before `end`.
fn within(low: f32, high: f32, first: usize, end: usize) -> std::ops::Range<usize> {
    // The casts send what is below zero to zero.
    (low.floor() as usize).max(first)..(high.ceil() as usize).min(end)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Camera;

    const SIZE: usize = 16;

    fn band() -> Band {
        Band::new(0, SIZE, SIZE, |_, _| Vec3::ZERO)
    }

    /// Two triangles that fill the picture at a depth.
    fn wall(depth: f32) -> [Triangle; 2] {
        let lens = Lens::new(&Camera::default(), SIZE, SIZE);
        let corner = |x, y| Vertex { place: depth * Vec3::new(x, y, -1.0), normal: Vec3::Z, tint: Vec3::ONE };
        let [a, b, c, d] = [corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
        [[a, b, c], [a, c, d]].map(|corners| Triangle::new(corners, &lens).unwrap())
    }

    #[test]
    fn triangles_that_share_an_edge_fill_each_sample_once() {
        let mut band = band();
        for triangle in &wall(3.0) {
            band.paint(triangle, 0.5, |_| Vec3::ONE);
        }
        for sample in band.samples.iter().flatten() {
            assert_eq!(sample.color, Vec3::splat(0.5));
        }
    }

    #[test]
    fn the_nearer_one_shows_in_either_order() {
        for depths in [[2.0, 3.0], [3.0, 2.0]] {
            let mut band = band();
            depths.iter().flat_map(|&depth| wall(depth)).for_each(|triangle| band.hide(&triangle));
            for depth in depths {
                for triangle in &wall(depth) {
                    band.paint(triangle, 1.0, |_| Vec3::splat(depth));
                }
            }
            for sample in band.samples.iter().flatten() {
                assert_eq!(sample.color, Vec3::splat(2.0));
                assert!((sample.depth - 2.0).abs() < 1e-5);
            }
        }
    }

    #[test]
    fn places_are_right_in_perspective() {
        let lens = Lens::new(&Camera::default(), SIZE, SIZE);
        let corners = [[-9.0, -1.0, -2.0], [9.0, -1.0, -2.0], [0.0, 1.0, -30.0]];
        let corners = corners.map(|at| Vertex { place: Vec3::from_array(at), normal: Vec3::Y, tint: Vec3::ONE });
        let triangle = Triangle::new(corners, &lens).unwrap();
        band().paint(&triangle, 1.0, |fragment| {
            let error = lens.project(fragment.at.place) - Vec2::new(fragment.x as f32, fragment.y as f32);
            assert!(error.min_element() >= 0.0 && error.max_element() <= 1.0, "{error}");
            assert!((fragment.at.place.y + 1.0 - 2.0 * (-2.0 - fragment.at.place.z) / 28.0).abs() < 1e-4);
            Vec3::ONE
        });
    }
}
