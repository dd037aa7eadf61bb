//! Surfaces: where points lie on them, and which of these is nearest.

use super::Aabb;
use glam::Vec3;

/// A surface (or a line) in space.
pub trait Surface {
    /// Area \[m²\]; of a line its length \[m\], of a plane infinity.
    fn area(&self) -> f32;

    /// The point and normal that three numbers uniform in [0, 1) pick, uniformly by area.
    fn sample(&self, u: [f32; 3]) -> Spot;

    /// The point of the surface nearest to `point`; where several are, one of them.
    fn nearest(&self, point: Vec3) -> Vec3;

    /// The smallest axis-aligned box around it.
    fn bounds(&self) -> Aabb;

    /// A corner of a box around it, and the three sides of that from there, as small as they can easily be, in whatever directions. Places in it are sought
    /// there. By default that of its bounds.
    fn around(&self) -> [Vec3; 4] {
        let Aabb { min, max } = self.bounds();
        let sides = max - min;
        [min, Vec3::X * sides.x, Vec3::Y * sides.y, Vec3::Z * sides.z]
    }

    /// Tells whether a point lies inside the space that it encloses; open surfaces enclose nothing.
    fn is_inside(&self, point: Vec3) -> bool {
        let _ = point;
        false
    }
}

/// A point on a surface and the direction away from it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spot {
    /// Where \[m\].
    pub point: Vec3,
    /// Unit outward normal.
    pub normal: Vec3,
}
