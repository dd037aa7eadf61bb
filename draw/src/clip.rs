//! Cutting off what the lens cannot see.

use super::camera::Lens;
use glam::Vec3;

/// A corner of a triangle, in view coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Vertex {
    pub(super) place: Vec3,
    pub(super) normal: Vec3,
    /// The share of the light that its material returns which it does.
    pub(super) tint: Vec3,
}

impl Vertex {
    pub(super) fn lerp(self, other: Self, t: f32) -> Self {
        let lerp = |a: Vec3, b: Vec3| a.lerp(b, t);
        Self {
            place: lerp(self.place, other.place),
            normal: lerp(self.normal, other.normal),
            tint: lerp(self.tint, other.tint),
        }
    }
}

/// The planes around what a lens sees: places with `normal · place + offset ≥ 0` are inside.
#[derive(Clone, Copy, Debug)]
pub(super) struct Frustum([(Vec3, f32); 6]);

impl Frustum {
    /// The sides are a little wide of the picture: cutting there is for the sake of accuracy, as
    /// pixel coordinates in the millions leave no bits for fractions.
    pub(super) fn new(lens: &Lens) -> Self {
        let [left, right, low, high] = lens.sides(16.0).map(|side| (side, 0.0));
        Self([(Vec3::NEG_Z, -lens.near), (Vec3::Z, lens.far), left, right, low, high])
    }

    /// The part of a convex polygon that can be seen; fewer than three corners for none.
    pub(super) fn clip(&self, mut polygon: Vec<Vertex>) -> Vec<Vertex> {
        for &plane in &self.0 {
            if polygon.iter().any(|corner| height(plane, corner.place) < 0.0) {
                polygon = cut(&polygon, plane);
            }
        }
        polygon
    }

    /// The part of a line that can be seen.
    pub(super) fn clip_line(&self, mut a: Vec3, mut b: Vec3) -> Option<(Vec3, Vec3)> {
        for &plane in &self.0 {
            let (above_a, above_b) = (height(plane, a), height(plane, b));
            match (above_a >= 0.0, above_b >= 0.0) {
                (true, true) => {}
                (true, false) => b = a.lerp(b, above_a / (above_a - above_b)),
                (false, true) => a = b.lerp(a, above_b / (above_b - above_a)),
                (false, false) => return None,
            }
        }
        Some((a, b))
    }
}

fn height((normal, offset): (Vec3, f32), place: Vec3) -> f32 {
    normal.dot(place) + offset
}

/// The part of a convex polygon above a plane (Sutherland and Hodgman's method).
fn cut(polygon: &[Vertex], plane: (Vec3, f32)) -> Vec<Vertex> {
    let mut kept = Vec::with_capacity(polygon.len() + 1);
    for (corner, next) in polygon.iter().zip(polygon.iter().cycle().skip(1)) {
        let (here, there) = (height(plane, corner.place), height(plane, next.place));
        if here >= 0.0 {
            kept.push(*corner);
        }
        if (here >= 0.0) != (there >= 0.0) {
            kept.push(corner.lerp(*next, here / (here - there)));
        }
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Camera;

    fn polygon(places: [Vec3; 3]) -> Vec<Vertex> {
        places.map(|place| Vertex { place, normal: Vec3::Y, tint: Vec3::ONE }).to_vec()
    }

    #[test]
    fn crossing_the_near_plane_keeps_the_far_part() {
        let camera = Camera { near: 1.0, far: 10.0, ..Camera::default() };
        let frustum = Frustum::new(&Lens::new(&camera, 64, 48));
        let ahead = Vec3::new(0.0, 0.0, -5.0);
        let kept = frustum.clip(polygon([ahead, Vec3::new(-0.1, 0.0, 1.0), Vec3::new(0.1, 0.0, 1.0)]));
        assert!(kept.len() >= 3 && kept[0].place == ahead);
        assert!(kept.iter().all(|corner| Lens::depth(corner.place) >= 0.999));
    }

    #[test]
    fn behind_beyond_and_beside_are_gone() {
        let camera = Camera { near: 1.0, far: 10.0, ..Camera::default() };
        let frustum = Frustum::new(&Lens::new(&camera, 64, 48));
        for shift in [5.0 * Vec3::Z, -50.0 * Vec3::Z, Vec3::new(99.0, 0.0, -5.0)] {
            let gone = polygon([shift, shift + Vec3::X, shift + Vec3::Y]);
            assert!(frustum.clip(gone).len() < 3);
            assert_eq!(frustum.clip_line(shift, shift + Vec3::X), None);
        }
    }
}
