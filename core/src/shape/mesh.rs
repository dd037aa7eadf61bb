//! A triangle mesh: borrowed (`Mesh`) or owned (`MeshBuf`).

use super::plane::crossing;
use super::{Aabb, Collider, Hit, Segment, Spot, Surface, earlier};
use crate::math::{clamp, largest, length, max, sqrt, unit};
use glam::Vec3;

/// A borrowed triangle mesh, hit from both sides.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mesh<'a> {
    vertices: &'a [Vec3],
    triangles: &'a [[u32; 3]],
    /// Running sums of the triangles' areas in units of 2⁻²⁴ of the largest: whole numbers, so that a million
    /// triangles lose nothing; empty if births were not asked for.
    areas: &'a [u64],
}

/// A triangle mesh on the heap.
#[cfg(feature = "alloc")]
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MeshBuf {
    vertices: alloc::vec::Vec<Vec3>,
    triangles: alloc::vec::Vec<[u32; 3]>,
    areas: alloc::vec::Vec<u64>,
}

/// Why vertices and triangles do not make a mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BadMesh {
    /// This triangle names a vertex that is not there.
    Index {
        /// The triangle's number.
        triangle: usize,
    },
    /// This vertex has a coordinate that is not finite.
    Vertex {
        /// The vertex's number.
        vertex: usize,
    },
    /// The slice for areas is not as long as the triangles'.
    Areas,
}

impl core::fmt::Display for BadMesh {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Index { triangle } => write!(f, "triangle {triangle} names a vertex that is not there"),
            Self::Vertex { vertex } => write!(f, "vertex {vertex} is not finite"),
            Self::Areas => write!(f, "the areas need one entry for each triangle"),
        }
    }
}

impl core::error::Error for BadMesh {}

impl<'a> Mesh<'a> {
    /// A mesh over borrowed vertices \[m\], triangles, and one word of memory a triangle for choosing by area
    /// (empty, if nothing is to be born on it).
    ///
    /// # Errors
    /// If an index is out of range, a coordinate is not finite, or the areas are neither empty nor as many as the
    /// triangles.
    pub fn new(vertices: &'a [Vec3], triangles: &'a [[u32; 3]], areas: &'a mut [u64]) -> Result<Self, BadMesh> {
        check(vertices, triangles)?;
        if !areas.is_empty() {
            if areas.len() != triangles.len() {
                return Err(BadMesh::Areas);
            }
            sum_areas(vertices, triangles, areas);
        }
        Ok(Self { vertices, triangles, areas })
    }

    /// The vertices \[m\].
    #[must_use]
    pub fn vertices(&self) -> &'a [Vec3] {
        self.vertices
    }

    /// The triangles, as three numbers of vertices each.
    #[must_use]
    pub fn triangles(&self) -> &'a [[u32; 3]] {
        self.triangles
    }

    fn corners(&self) -> impl Iterator<Item = [Vec3; 3]> + 'a {
        let vertices = self.vertices;
        self.triangles.iter().map(move |t| corners(vertices, t))
    }
}

#[cfg(feature = "alloc")]
impl MeshBuf {
    /// A mesh of vertices \[m\] and triangles.
    ///
    /// # Errors
    /// If an index is out of range or a coordinate is not finite.
    pub fn new(vertices: alloc::vec::Vec<Vec3>, triangles: alloc::vec::Vec<[u32; 3]>) -> Result<Self, BadMesh> {
        check(&vertices, &triangles)?;
        let mut areas = alloc::vec![0; triangles.len()];
        sum_areas(&vertices, &triangles, &mut areas);
        Ok(Self { vertices, triangles, areas })
    }

    /// The same, borrowed.
    #[must_use]
    pub fn view(&self) -> Mesh<'_> {
        Mesh { vertices: &self.vertices, triangles: &self.triangles, areas: &self.areas }
    }
}

impl Surface for Mesh<'_> {
    fn area(&self) -> f32 {
        self.corners().map(area).sum()
    }

    fn sample(&self, u: [f32; 3]) -> Spot {
        let total = self.areas.last().copied().unwrap_or(0);
        let target = (u128::from((u[0] * 16_777_216.0) as u32) * u128::from(total) >> 24) as u64;
        let chosen = self.areas.partition_point(|&sum| sum <= target);
        let Some(triangle) = self.triangles.get(chosen) else {
            return Spot { point: Vec3::ZERO, normal: Vec3::Y };
        };
        let [a, b, c] = corners(self.vertices, triangle);
        let s = sqrt(u[1]);
        Spot { point: a * (1.0 - s) + b * (s * (1.0 - u[2])) + c * (s * u[2]), normal: unit((b - a).cross(c - a)) }
    }

    /// Looks at every triangle.
    fn nearest(&self, point: Vec3) -> Vec3 {
        let mut best = (f32::INFINITY, point);
        for corners in self.corners() {
            let candidate = nearest_on_triangle(corners, point);
            let distance = length(candidate - point);
            if distance < best.0 {
                best = (distance, candidate);
            }
        }
        best.1
    }

    fn bounds(&self) -> Aabb {
        Aabb::around(self.corners().flatten())
    }
}

impl Collider for Mesh<'_> {
    /// Looks at every triangle. Watertight: an edge shared by two triangles is judged by the same arithmetic for both.
    fn first_hit(&self, segment: &Segment) -> Option<Hit> {
        let hit = self.corners().fold(None, |best, corners| earlier(best, hit_triangle(corners, segment)))?;
        let size = largest(segment.at(hit.time));
        Some(Hit { slack: max(hit.slack, segment.slack(size)), ..hit })
    }

    fn is_empty(&self) -> bool {
        self.triangles.is_empty()
    }
}

/// Hands everything to the borrowed mesh inside.
#[cfg(feature = "alloc")]
macro_rules! through_view {
    ($($owner:ty),+) => {$(
        impl Surface for $owner {
            fn area(&self) -> f32 {
                self.view().area()
            }
            fn sample(&self, u: [f32; 3]) -> Spot {
                self.view().sample(u)
            }
            fn nearest(&self, point: Vec3) -> Vec3 {
                self.view().nearest(point)
            }
            fn bounds(&self) -> Aabb {
                self.view().bounds()
            }
        }
        impl Collider for $owner {
            fn first_hit(&self, segment: &Segment) -> Option<Hit> {
                self.view().first_hit(segment)
            }
            fn is_empty(&self) -> bool {
                self.view().is_empty()
            }
        }
    )+};
}
#[cfg(feature = "alloc")]
through_view!(MeshBuf, alloc::sync::Arc<MeshBuf>);

fn check(vertices: &[Vec3], triangles: &[[u32; 3]]) -> Result<(), BadMesh> {
    if let Some(vertex) = vertices.iter().position(|v| !v.is_finite()) {
        return Err(BadMesh::Vertex { vertex });
    }
    match triangles.iter().position(|t| t.iter().any(|&i| i as usize >= vertices.len())) {
        Some(triangle) => Err(BadMesh::Index { triangle }),
        None => Ok(()),
    }
}

/// Fills in running sums of areas; where all are zero (or overflow) every triangle counts alike.
fn sum_areas(vertices: &[Vec3], triangles: &[[u32; 3]], areas: &mut [u64]) {
    let size = |t| area(corners(vertices, t));
    let greatest = triangles.iter().map(size).fold(0.0, max);
    let usable = greatest > 0.0 && greatest < f32::INFINITY;
    let mut sum = 0;
    for (triangle, slot) in triangles.iter().zip(areas) {
        sum += if usable { (size(triangle) / greatest * 16_777_216.0) as u64 } else { 1 };
        *slot = sum;
    }
}

fn corners(vertices: &[Vec3], triangle: &[u32; 3]) -> [Vec3; 3] {
    triangle.map(|i| vertices.get(i as usize).copied().unwrap_or(Vec3::ZERO))
}

fn area([a, b, c]: [Vec3; 3]) -> f32 {
    0.5 * length((b - a).cross(c - a))
}

/// Where a segment crosses a triangle, from either side.
fn hit_triangle([a, b, c]: [Vec3; 3], segment: &Segment) -> Option<Hit> {
    let normal = (b - a).cross(c - a);
    let (time, normal) = crossing(normal, normal.dot(segment.from - a), normal.dot(segment.to - a))?;
    // The line passes inside if it goes round all three edges the same way. A cross product changes only its sign
    // when its factors change places, so the two triangles at an edge never both say no.
    let step = segment.step();
    let (p, q, r) = (a - segment.from, b - segment.from, c - segment.from);
    let (u, v, w) = (step.dot(q.cross(r)), step.dot(r.cross(p)), step.dot(p.cross(q)));
    let inside = (u >= 0.0 && v >= 0.0 && w >= 0.0) || (u <= 0.0 && v <= 0.0 && w <= 0.0);
    let size = max(largest(a), max(largest(b), largest(c)));
    inside.then(|| Hit { time, normal: unit(normal), slack: segment.slack(size) })
}

/// The point of a triangle nearest to `p` (Ericson, "Real-Time Collision Detection", 5.1.5).
fn nearest_on_triangle([a, b, c]: [Vec3; 3], p: Vec3) -> Vec3 {
    let (ab, ac, ap) = (b - a, c - a, p - a);
    let (d1, d2) = (ab.dot(ap), ac.dot(ap));
    if d1 <= 0.0 && d2 <= 0.0 {
        return a;
    }
    let bp = p - b;
    let (d3, d4) = (ab.dot(bp), ac.dot(bp));
    if d3 >= 0.0 && d4 <= d3 {
        return b;
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        return a + ab * clamp(d1 / (d1 - d3), 0.0, 1.0);
    }
    let cp = p - c;
    let (d5, d6) = (ab.dot(cp), ac.dot(cp));
    if d6 >= 0.0 && d5 <= d6 {
        return c;
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        return a + ac * clamp(d2 / (d2 - d6), 0.0, 1.0);
    }
    let va = d3 * d6 - d5 * d4;
    if va <= 0.0 && d4 >= d3 && d5 >= d6 {
        return b + (c - b) * clamp((d4 - d3) / ((d4 - d3) + (d5 - d6)), 0.0, 1.0);
    }
    let sum = 1.0 / (va + vb + vc);
    a + ab * (vb * sum) + ac * (vc * sum)
}

#[cfg(all(test, feature = "alloc"))]
mod tests {
    use super::*;
    use crate::rng::Stream;
    use alloc::vec;

    fn octahedron() -> MeshBuf {
        let vertices = vec![Vec3::X, -Vec3::X, Vec3::Y, -Vec3::Y, Vec3::Z, -Vec3::Z];
        let mut triangles = vec![];
        for x in [0, 1] {
            for y in [2, 3] {
                for z in [4, 5] {
                    let even = (x + y + z) % 2 == 0;
                    triangles.push(if even { [x, y, z] } else { [x, z, y] });
                }
            }
        }
        MeshBuf::new(vertices, triangles).expect("an octahedron is a mesh")
    }

    #[test]
    fn no_path_slips_between_triangles() {
        let mesh = octahedron();
        for i in 0..20_000 {
            let s = Stream::new(3, 0, i);
            let [x, y] = s.units(0);
            let [z, w] = s.units(1);
            let out = unit(Vec3::new(x - 0.5, y - 0.5, z - 0.5)) * 3.0;
            // A third of the paths aim at a vertex, a third at an edge.
            let target = match i % 3 {
                0 => mesh.vertices[i as usize % 6],
                1 => Vec3::X * w + Vec3::Y * (1.0 - w),
                _ => Vec3::ZERO,
            };
            let inside = target * 0.5;
            let hit = mesh.first_hit(&Segment { from: inside, to: inside + out });
            assert!(hit.is_some(), "from {inside} towards {out}");
        }
    }

    #[test]
    fn nearest_agrees_with_samples() {
        let mesh = octahedron();
        let draw = |i| {
            let s = Stream::new(9, 9, i);
            [s.units(0)[0], s.units(0)[1], s.units(1)[0]]
        };
        for i in 0..100 {
            let p = Vec3::from(draw(i)) * 4.0 - 2.0;
            let distance = length(mesh.nearest(p) - p);
            let best = (0..4000).map(|k| length(mesh.sample(draw(k)).point - p)).fold(9.0, f32::min);
            assert!(distance <= best + 1e-6 && best - distance < 0.1, "{p}");
        }
    }

    #[test]
    fn bad_meshes_are_refused() {
        assert_eq!(MeshBuf::new(vec![Vec3::X], vec![[0, 0, 1]]), Err(BadMesh::Index { triangle: 0 }));
        assert_eq!(MeshBuf::new(vec![Vec3::NAN], vec![]), Err(BadMesh::Vertex { vertex: 0 }));
        let vertices = [Vec3::X, Vec3::Y, Vec3::Z];
        assert_eq!(Mesh::new(&vertices, &[[0, 1, 2]], &mut [0; 2]), Err(BadMesh::Areas));
    }

    #[test]
    fn an_empty_mesh_harms_nobody() {
        let mesh = MeshBuf::default();
        assert!(mesh.is_empty());
        assert_eq!(mesh.nearest(Vec3::X), Vec3::X);
        let _ = mesh.sample([0.5; 3]);
    }
}
