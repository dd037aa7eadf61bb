//! The usual shapes as triangles, smooth where the shape is smooth.

use super::Surface;
use glam::{Mat3, Quat, Vec3};
use std::f32::consts::{PI, TAU};

/// How many flat sides stand in for a circle.
const SIDES: u32 = 96;

/// A box with its sides along the axes.
pub fn cuboid(center: Vec3, size: Vec3) -> Surface {
    let mut surface = Surface::default();
    let half = 0.5 * size;
    for (normal, right) in [
        (Vec3::X, Vec3::NEG_Z),
        (Vec3::NEG_X, Vec3::Z),
        (Vec3::Y, Vec3::X),
        (Vec3::NEG_Y, Vec3::X),
        (Vec3::Z, Vec3::X),
        (Vec3::NEG_Z, Vec3::NEG_X),
    ] {
        let up = normal.cross(right);
        let face = [-right - up, right - up, right + up, up - right];
        surface.fan(face.map(|side| center + half * (normal + side)), normal);
    }
    surface
}

/// A ball.
pub fn sphere(center: Vec3, radius: f32) -> Surface {
    let outline = (0..=SIDES / 2).map(|step| {
        let (sin, cos) = (PI * step as f32 / (SIDES / 2) as f32).sin_cos();
        // Both poles lie on the axis exactly, so that their empty triangles are recognised.
        let sin = if step == SIDES / 2 { 0.0 } else { sin };
        Rib { radius: radius * sin, height: radius * cos, out: sin, up: cos }
    });
    Surface::turned(center, outline)
}

/// A cylinder between two points with half a sphere at either end.
pub fn capsule(from: Vec3, to: Vec3, radius: f32) -> Surface {
    let half = 0.5 * (to - from).length();
    let outline = (0..=SIDES / 2).flat_map(|step| {
        let (sin, cos) = (PI * step as f32 / (SIDES / 2) as f32).sin_cos();
        let sin = if step == SIDES / 2 { 0.0 } else { sin };
        let rib = |height| Rib { radius: radius * sin, height: radius * cos + height, out: sin, up: cos };
        // The ring in the middle is there twice: once at either end.
        let upper = (step <= SIDES / 4).then(|| rib(half));
        upper.into_iter().chain((step >= SIDES / 4).then(|| rib(-half)))
    });
    let turn = Mat3::from_quat(Quat::from_rotation_arc(Vec3::Y, (to - from).normalize_or(Vec3::Y)));
    Surface::turned(Vec3::ZERO, outline).transformed(turn, 0.5 * (from + to))
}

/// A closed upright cylinder; `center` is half way up.
pub fn cylinder(center: Vec3, radius: f32, height: f32) -> Surface {
    let rib = |height| Rib { radius, height, out: 1.0, up: 0.0 };
    let mut surface = Surface::turned(center, [rib(0.5 * height), rib(-0.5 * height)]);
    surface.append(disc(center + 0.5 * height * Vec3::Y, Vec3::Y, radius));
    surface.append(disc(center - 0.5 * height * Vec3::Y, Vec3::NEG_Y, radius));
    surface
}

/// A closed upright cone; `center` is half way between the base, below, and the apex.
pub fn cone(center: Vec3, radius: f32, height: f32) -> Surface {
    let slope = Vec3::new(height, radius, 0.0).normalize_or(Vec3::X);
    let rib = |radius, height| Rib { radius, height, out: slope.x, up: slope.y };
    let mut surface = Surface::turned(center, [rib(0.0, 0.5 * height), rib(radius, -0.5 * height)]);
    surface.append(disc(center - 0.5 * height * Vec3::Y, Vec3::NEG_Y, radius));
    surface
}

/// A flat round plate.
pub fn disc(center: Vec3, normal: Vec3, radius: f32) -> Surface {
    let normal = normal.normalize_or(Vec3::Y);
    let turn = Quat::from_rotation_arc(Vec3::Z, normal);
    let vertices = (0..SIDES).map(|step| center + radius * (turn * around(step))).collect();
    // One triangle in the middle and ever smaller ones around it: unlike slivers, they stay apart.
    let third = SIDES / 3;
    let mut triangles = vec![[0, third, 2 * third]];
    let halves = std::iter::successors(Some(third / 2), |half| Some(half / 2)).take_while(|&half| half > 0);
    for half in halves {
        let corners = (0..SIDES).step_by(2 * half as usize);
        triangles.extend(corners.map(|at| [at, at + half, (at + 2 * half) % SIDES]));
    }
    Surface { vertices, normals: vec![normal; SIDES as usize], tints: Vec::new(), triangles }
}

/// A square of a plane through `point`, reaching `reach` to each side. See
/// [`Piece::endless`](super::Piece::endless) for one that should look boundless.
pub fn plane(point: Vec3, normal: Vec3, reach: f32) -> Surface {
    let normal = normal.normalize_or(Vec3::Y);
    let (right, up) = normal.any_orthonormal_pair();
    let mut surface = Surface::default();
    let corners = [-right - up, right - up, right + up, up - right];
    surface.fan(corners.map(|corner| point + reach * corner), normal);
    surface
}

/// A mesh with flat triangles.
pub fn mesh(vertices: &[Vec3], triangles: &[[u32; 3]]) -> Surface {
    Surface { vertices: vertices.to_vec(), triangles: triangles.to_vec(), ..Surface::default() }
}

/// A place on the outline of a turned shape, and its normal.
struct Rib {
    radius: f32,
    height: f32,
    out: f32,
    up: f32,
}

impl Surface {
    /// The surface that a lathe makes of an outline given from top to bottom.
    fn turned(center: Vec3, outline: impl IntoIterator<Item = Rib>) -> Self {
        let mut surface = Self::default();
        for (row, rib) in outline.into_iter().enumerate() {
            for step in 0..SIDES {
                let Vec3 { x, y: z, .. } = around(step);
                surface.vertices.push(center + Vec3::new(rib.radius * x, rib.height, -rib.radius * z));
                surface.normals.push(Vec3::new(rib.out * x, rib.up, -rib.out * z));
            }
            for step in (0..SIDES).filter(|_| row > 0) {
                let next = (step + 1) % SIDES;
                let below = row as u32 * SIDES;
                let above = below - SIDES;
                surface.triangles.push([above + step, below + step, below + next]);
                surface.triangles.push([above + step, below + next, above + next]);
            }
        }
        surface
    }

    /// Adds a flat polygon, given counter-clockwise.
    fn fan(&mut self, rim: impl IntoIterator<Item = Vec3>, normal: Vec3) {
        let first = self.vertices.len() as u32;
        self.vertices.extend(rim);
        let end = self.vertices.len() as u32;
        self.normals.resize(self.vertices.len(), normal);
        self.triangles.extend((first + 1..end.max(1) - 1).map(|next| [first, next, next + 1]));
    }

    /// Adds another surface.
    fn append(&mut self, other: Self) {
        let first = self.vertices.len() as u32;
        self.vertices.extend(other.vertices);
        self.normals.extend(other.normals);
        self.triangles.extend(other.triangles.iter().map(|corners| corners.map(|c| c + first)));
    }
}

/// A place on the unit circle in the xy plane.
fn around(step: u32) -> Vec3 {
    let (sin, cos) = (TAU * step as f32 / SIDES as f32).sin_cos();
    Vec3::new(cos, sin, 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    const CENTER: Vec3 = Vec3::new(1.0, -2.0, 0.5);

    #[test]
    fn areas_are_those_of_geometry() {
        let (r, h) = (1.5f32, 2.0f32);
        for (name, surface, area) in [
            ("box", cuboid(CENTER, Vec3::new(1.0, 2.0, 3.0)), 22.0),
            ("sphere", sphere(CENTER, r), 4.0 * PI * r * r),
            ("cylinder", cylinder(CENTER, r, h), TAU * r * (r + h)),
            ("cone", cone(CENTER, r, h), PI * r * (r + r.hypot(h))),
            ("disc", disc(CENTER, Vec3::ONE, r), PI * r * r),
            ("plane", plane(CENTER, Vec3::ONE, 5.0), 100.0),
        ] {
            let error = surface.area() / area - 1.0;
            assert!(error.abs() < 2e-3, "{name}: off by {error}");
        }
    }

    #[test]
    fn solids_face_outwards() {
        for surface in [
            cuboid(CENTER, Vec3::new(1.0, 2.0, 3.0)),
            sphere(CENTER, 2.0),
            cylinder(CENTER, 1.0, 3.0),
            cone(CENTER, 1.0, 3.0),
        ] {
            assert_eq!(surface.normals.len(), surface.vertices.len());
            for ([a, b, c], normals, _) in surface.corners() {
                let flat = (b - a).cross(c - a);
                assert!(flat.dot(a + b + c - 3.0 * CENTER) > 0.0);
                assert!(normals.iter().all(|normal| normal.dot(flat) > 0.0));
            }
        }
    }

    #[test]
    fn plates_face_their_normal() {
        for normal in [Vec3::Y, Vec3::NEG_Y, Vec3::NEG_Z, Vec3::new(1.0, 2.0, -3.0)] {
            for surface in [disc(CENTER, normal, 1.0), plane(CENTER, normal, 1.0)] {
                for ([a, b, c], ..) in surface.corners() {
                    assert!((b - a).cross(c - a).dot(normal) > 0.0);
                }
            }
        }
    }

    #[test]
    fn a_cone_points_up() {
        let cone = cone(CENTER, 1.0, 3.0);
        let top = cone.vertices.iter().map(|at| at.y).fold(f32::MIN, f32::max);
        let apex = cone.vertices.iter().filter(|at| at.y == top);
        assert_eq!(top, CENTER.y + 1.5);
        assert!(apex.clone().count() > 0 && apex.clone().all(|at| at.with_y(0.0) == CENTER.with_y(0.0)));
    }
}
