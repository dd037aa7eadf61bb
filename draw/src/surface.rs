//! Triangles with normals.

use super::color::decode;
use glam::{Mat3, Vec3};

/// A shape made of triangles.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Surface {
    /// The corners.
    pub vertices: Vec<Vec3>,
    /// One unit normal for each corner, or none at all for flat triangles.
    pub normals: Vec<Vec3>,
    /// One colour (sRGB, 0 to 1) for each corner, by which that of the material is multiplied, or none at all.
    pub tints: Vec<Vec3>,
    /// Three indices into `vertices` each, counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
}

impl Surface {
    /// The surface after `linear`, then `translation`. Normals turn with the inverse transpose, and
    /// a mirrored surface keeps its outside out.
    #[must_use]
    pub fn transformed(&self, linear: Mat3, translation: Vec3) -> Self {
        let mirrored = linear.determinant() < 0.0;
        let for_normals = cofactors(linear) * if mirrored { -1.0 } else { 1.0 };
        Self {
            vertices: self.vertices.iter().map(|&at| linear * at + translation).collect(),
            normals: self.normals.iter().map(|&normal| (for_normals * normal).normalize_or(normal)).collect(),
            tints: self.tints.clone(),
            triangles: self.triangles.iter().map(|&[a, b, c]| if mirrored { [a, c, b] } else { [a, b, c] }).collect(),
        }
    }

    /// The corners of each triangle, their normals and their tints in linear light, without the triangles that cannot be drawn:
    /// a missing corner, a coordinate that is not finite, no area.
    pub(super) fn corners(&self) -> impl Iterator<Item = ([Vec3; 3], [Vec3; 3], [Vec3; 3])> {
        self.triangles.iter().filter_map(|indices| {
            let [a, b, c] = indices.map(|index| self.vertices.get(index as usize).copied());
            let corners = [a?, b?, c?];
            let flat = (corners[1] - corners[0]).cross(corners[2] - corners[0]).try_normalize()?;
            let normals = indices.map(|index| {
                let given = self.normals.get(index as usize).copied();
                given.and_then(Vec3::try_normalize).unwrap_or(flat)
            });
            let tints = indices.map(|index| self.tints.get(index as usize).map_or(Vec3::ONE, |tint| decode(*tint)));
            corners.iter().all(|corner| corner.is_finite()).then_some((corners, normals, tints))
        })
    }

    /// Tells whether it has an inside: the normals of a closed surface, by its areas, are nothing in all.
    pub(super) fn is_closed(&self) -> bool {
        /// The share of the area that rounding, and a hole nobody sees, leave.
        const LEAK: f32 = 1e-3;
        let areas = self.corners().map(|([a, b, c], ..)| (b - a).cross(c - a));
        let (sum, all) = areas.fold((Vec3::ZERO, 0.0), |(sum, all), area| (sum + area, all + area.length()));
        sum.length() <= LEAK * all
    }

    /// The area of all triangles together.
    pub fn area(&self) -> f32 {
        self.corners().map(|([a, b, c], ..)| 0.5 * (b - a).cross(c - a).length()).sum()
    }
}

/// The inverse transpose times the determinant: the same directions, and no division by zero for
/// shapes that are squashed flat.
fn cofactors(m: Mat3) -> Mat3 {
    Mat3::from_cols(m.y_axis.cross(m.z_axis), m.z_axis.cross(m.x_axis), m.x_axis.cross(m.y_axis))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shapes;

    #[test]
    fn normals_stay_square_to_the_surface() {
        let lean = Mat3::from_cols(Vec3::new(2.0, 0.3, 0.0), Vec3::new(1.0, 0.5, 0.0), Vec3::Z);
        let mirror = Mat3::from_diagonal(Vec3::new(-1.0, 1.0, 1.0));
        for linear in [lean, mirror * lean] {
            let leant = shapes::sphere(Vec3::ZERO, 1.0).transformed(linear, Vec3::X);
            for ([a, b, c], normals, _) in leant.corners() {
                let flat = (b - a).cross(c - a).normalize();
                for normal in normals {
                    assert!((normal.length() - 1.0).abs() < 1e-5);
                    assert!(normal.dot(flat) > 0.9, "{normal} against {flat}");
                }
            }
        }
    }

    #[test]
    fn what_cannot_be_drawn_is_left_out() {
        let surface = Surface {
            vertices: vec![Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::splat(f32::NAN)],
            normals: vec![],
            tints: vec![],
            triangles: vec![[0, 1, 2], [0, 1, 3], [0, 1, 9], [0, 1, 1]],
        };
        assert_eq!(surface.corners().count(), 1);
        assert_eq!(surface.area(), 0.5);
    }
}
