//! What is not seen otherwise: how an index has parted points, and where surfaces give birth or take away.

use super::{Line, edges, fill};
use crate::index::SpatialIndex;
use crate::math::{frame, unit};
use crate::particles::Color;
use crate::shape::{Aabb, Surface};
use glam::Vec3;

/// The length of an arrow's head as a share of the arrow's, and half its width as a share of that.
const HEAD: f32 = 0.25;
const SLANT: f32 = 0.4;

/// The fractions of 1/φ, 1/φ², 1/φ³ with φ⁴ = φ + 1, whose multiples lie evenly in a cube: M. Roberts, "The unreasonable effectiveness of
/// quasirandom sequences" (2018).
const EVEN: [f32; 3] = [0.819_172_5, 0.671_043_6, 0.549_700_5];

/// Writes the edges of boxes, one around the points of each part (cell or leaf) into which an index has divided them, in the index's order, as
/// far as there is room; returns the number of lines and how many were left out. `points` are those that it was built from; in a periodic
/// box they lie within that.
///
/// ```
/// use pointmass::draw::{Line, cells};
/// use pointmass::index::{SpatialIndex, Structure};
/// use pointmass::Vec3;
///
/// let points = [Vec3::ZERO, Vec3::ONE, Vec3::splat(9.0)];
/// let mut memory = [0; Structure::Grid.words(3)];
/// let mut index = Structure::Grid.index(&mut memory);
/// index.build(&points, 2.0)?;
/// let mut lines = [Line::NONE; 48];
/// assert_eq!(cells(&index, &points, [255; 4], &mut lines), (12, 0)); // So few are one part: the edges of one box.
/// # Ok::<(), pointmass::index::TooSmall>(())
/// ```
pub fn cells(index: &dyn SpatialIndex, points: &[Vec3], color: Color, into: &mut [Line]) -> (usize, usize) {
    let (mut count, mut left_out) = (0, 0);
    index.parts(&mut |slots| {
        let rows = index.order().get(slots).unwrap_or_default();
        let bounds = Aabb::around(rows.iter().filter_map(|&row| points.get(row as usize).copied()));
        if bounds.min.is_finite() && bounds.max.is_finite() {
            let (written, without_room) = fill(edges(&bounds, color).into_iter(), &mut into[count..]);
            count += written;
            left_out += without_room;
        }
    });
    (count, left_out)
}

/// An arrow from a place along a way: its shaft, and the four edges of its head. Where the way is none, all are.
#[must_use]
pub fn arrow(from: Vec3, way: Vec3, color: Color) -> [Line; 5] {
    let (tip, axis) = (from + way, unit(way));
    let (x, y) = if axis == Vec3::ZERO { (Vec3::ZERO, Vec3::ZERO) } else { frame(axis) };
    let long = way.dot(axis) * HEAD;
    let barb = |side: Vec3| Line::plain([tip, tip - axis * long + side * (long * SLANT)], color);
    [Line::plain([from, tip], color), barb(x), barb(y), barb(-x), barb(-y)]
}

/// Writes arrows at so many places spread evenly over a surface, as far as there is room; returns the number of lines and how many were left
/// out. They are as long as `length` says \[m\] and point in a direction, or else along the normal: away from a source, with a length
/// below zero toward a sink.
pub fn arrows(
    surface: &impl Surface,
    direction: Option<Vec3>,
    length: f32,
    count: u32,
    color: Color,
    into: &mut [Line],
) -> (usize, usize) {
    let place = |i: u32| {
        // It stays below one: what is left of a product after its whole part.
        let part = |step: f32| (0.5 + step * i as f32) % 1.0;
        let spot = surface.sample(EVEN.map(part));
        let way = direction.map_or(spot.normal, unit) * length;
        // What leads to the surface ends there.
        if length < 0.0 { arrow(spot.point - way, way, color) } else { arrow(spot.point, way, color) }
    };
    fill((0..count).flat_map(place), into)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::length;

    #[test]
    fn an_arrow_points_where_it_should() {
        for way in [Vec3::Y * 2.0, Vec3::new(1.0, -2.0, 0.5), Vec3::X * 1e-3] {
            let [shaft, head @ ..] = arrow(Vec3::ONE, way, [255; 4]);
            assert_eq!(shaft.ends, [Vec3::ONE, Vec3::ONE + way]);
            for barb in head {
                let back = barb.ends[0] - barb.ends[1];
                assert_eq!(barb.ends[0], Vec3::ONE + way);
                assert!((back.dot(way) / length(way) / length(way) - HEAD).abs() < 1e-3, "{back}");
            }
        }
        assert!(arrow(Vec3::ONE, Vec3::ZERO, [255; 4]).iter().all(|line| line.ends == [Vec3::ONE; 2]));
    }
}
