//! Which pixels a round brush touches on its way from one place to another.

use glam::Vec2;
use std::ops::Range;

/// A straight stroke of a round brush, in pixels.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stroke {
    pub(super) from: Vec2,
    pub(super) to: Vec2,
    pub(super) radius: f32,
}

/// How a pixel lies to a stroke.
#[derive(Clone, Copy, Debug)]
pub(super) struct Touch {
    /// The pixel's number, counted row by row.
    pub(super) pixel: usize,
    /// From the nearest place on the stroke's axis to the middle of the pixel.
    pub(super) offset: Vec2,
    /// Where that nearest place is: 0 at the stroke's beginning, 1 at its end.
    pub(super) along: f32,
}

impl Stroke {
    /// A single dab.
    pub(super) fn dab(at: Vec2, radius: f32) -> Self {
        Self { from: at, to: at, radius }
    }

    /// Calls `paint` for each pixel of a picture whose middle is within the stroke's radius.
    pub(super) fn each_pixel(&self, width: usize, height: usize, mut paint: impl FnMut(Touch)) {
        let way = self.to - self.from;
        let (low, high) = (self.from.min(self.to), self.from.max(self.to));
        let per_length = 1.0 / way.length_squared().max(1e-12);
        for y in middles(low.y - self.radius, high.y + self.radius, height) {
            let middle = y as f32 + 0.5;
            for x in self.columns(middle, way, width) {
                let out = Vec2::new(x as f32 + 0.5, middle) - self.from;
                let along = (out.dot(way) * per_length).clamp(0.0, 1.0);
                let offset = out - along * way;
                if offset.length_squared() <= self.radius * self.radius {
                    paint(Touch { pixel: y * width + x, offset, along });
                }
            }
        }
    }

    /// The columns to look at in a row: those near the part of the axis that passes close by.
    fn columns(&self, y: f32, way: Vec2, width: usize) -> Range<usize> {
        let crossing = |y: f32| {
            let t = (y - self.from.y) / way.y;
            self.from.x + t.clamp(0.0, 1.0) * way.x
        };
        let (a, b) = if way.y.abs() > 1e-3 {
            (crossing(y - self.radius), crossing(y + self.radius))
        } else {
            (self.from.x, self.to.x)
        };
        middles(a.min(b) - self.radius, a.max(b) + self.radius, width)
    }
}

/// The pixels of a row whose middles lie between two places.
pub(super) fn middles(low: f32, high: f32, count: usize) -> Range<usize> {
    // The casts send what is below zero, or not a number, to zero.
    let first = (low - 0.5).ceil() as usize;
    first..((high + 0.5).floor().max(0.0) as usize).min(count)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_pixel_in_reach_is_touched_once() {
        let (width, height) = (40, 30);
        for (from, to, radius) in [
            (Vec2::new(10.3, 9.8), Vec2::new(10.3, 9.8), 0.9),
            (Vec2::new(-5.0, 3.0), Vec2::new(55.0, 21.0), 2.5),
            (Vec2::new(20.0, 28.0), Vec2::new(20.0, -9.0), 1.2),
            (Vec2::new(33.0, 12.0), Vec2::new(4.0, 12.0004), 3.0),
            (Vec2::new(1e7, 5.0), Vec2::new(-1e7, 6.0), 2.0),
        ] {
            let mut touched = vec![0; width * height];
            Stroke { from, to, radius }.each_pixel(width, height, |touch| {
                touched[touch.pixel] += 1;
                assert!(touch.offset.length() <= radius);
            });
            if from.x.abs() > 1e6 {
                continue; // Too far off for the plain computation below.
            }
            for (pixel, count) in touched.into_iter().enumerate() {
                let at = Vec2::new((pixel % width) as f32, (pixel / width) as f32) + 0.5;
                let way = to - from;
                let t = ((at - from).dot(way) / way.length_squared().max(1e-12)).clamp(0.0, 1.0);
                let distance = at.distance(from + t * way);
                if (distance - radius).abs() > 1e-3 {
                    assert_eq!(count, i32::from(distance < radius), "{at} is {distance} away");
                }
            }
        }
    }
}
