//! A triangle mesh: borrowed (`Mesh`) or owned (`MeshBuf`).

use super::{Aabb, Affine, Collider, Contact, Hit, Hulls, Mapped, Marks, Segment, Spot, Surface, Triangle};
use crate::math::{high, largest, length, max, power_to_one};
use crate::rays::{Index, Pieces, Unsound};
#[cfg(feature = "alloc")]
use crate::rays::{IndexBuf, Structure};
use crate::time::Time;
use glam::Vec3;

/// A borrowed triangle mesh, hit from both sides.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mesh<'a> {
    bounds: Aabb,
    vertices: &'a [Vec3],
    triangles: &'a [[u32; 3]],
    /// Running sums of the triangles' areas in units of 2⁻³⁶ of the largest: whole numbers, so that a million
    /// triangles lose nothing; empty if births were not asked for.
    areas: &'a [u64],
    index: Index<'a>,
}

/// A triangle mesh on the heap.
#[cfg(feature = "alloc")]
#[derive(Clone, Debug, PartialEq)]
pub struct MeshBuf {
    bounds: Aabb,
    vertices: alloc::vec::Vec<Vec3>,
    triangles: alloc::vec::Vec<[u32; 3]>,
    areas: alloc::vec::Vec<u64>,
    index: IndexBuf,
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
        Ok(Self { bounds: Aabb::around(vertices.iter().copied()), vertices, triangles, areas, index: Index::BRUTE })
    }

    /// The same with an index of its triangles, built before, perhaps at another time: paths no longer look at all of
    /// them. Looks at each triangle once.
    ///
    /// # Errors
    /// If the index was built from other triangles.
    pub fn with_index(self, index: Index<'a>) -> Result<Self, Unsound> {
        if index.is_of(&self) { Ok(Self { index, ..self }) } else { Err(Unsound) }
    }

    /// The index of its triangles.
    #[must_use]
    pub fn index(&self) -> Index<'a> {
        self.index
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

    /// The triangle with a number.
    #[inline(always)]
    fn face(&self, number: usize) -> Option<Triangle> {
        let [a, b, c] = self.triangles.get(number)?.map(|corner| self.vertices.get(corner as usize).copied());
        Some(Triangle { corners: [a?, b?, c?] })
    }

    fn faces(&self) -> impl Iterator<Item = Triangle> + 'a {
        let vertices = self.vertices;
        self.triangles.iter().map(move |t| face(vertices, t))
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
        let bounds = Aabb::around(vertices.iter().copied());
        let mut areas = alloc::vec![0; triangles.len()];
        sum_areas(&vertices, &triangles, &mut areas);
        Ok(Self { bounds, vertices, triangles, areas, index: IndexBuf::default() })
    }

    /// The same with an index of its triangles, if they are more than a few.
    #[must_use]
    pub(crate) fn organised(self, structure: Structure) -> Self {
        /// Triangles that are looked at sooner than an index of them.
        const FEW: usize = 8;
        if self.triangles.len() <= FEW { self } else { self.indexed(structure) }
    }

    /// The same with an index of its triangles, so that paths no longer look at all of them.
    #[must_use]
    pub fn indexed(mut self, structure: Structure) -> Self {
        self.index = IndexBuf::new(structure, &self.view());
        self
    }

    /// The index of its triangles; [`Index::BRUTE`] as long as it has none.
    #[must_use]
    pub fn index(&self) -> Index<'_> {
        self.index.view()
    }

    /// The vertices \[m\].
    #[must_use]
    pub fn vertices(&self) -> &[Vec3] {
        &self.vertices
    }

    /// The triangles, by their corners' places among the vertices.
    #[must_use]
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// The same, borrowed.
    #[must_use]
    pub fn view(&self) -> Mesh<'_> {
        let index = self.index();
        Mesh { bounds: self.bounds, vertices: &self.vertices, triangles: &self.triangles, areas: &self.areas, index }
    }
}

/// A way out of meshes, along no axis, so that it hardly ever runs along a face.
const OUT: Vec3 = Vec3::new(0.836_516, 0.481_754, 0.261_214);

impl Surface for Mesh<'_> {
    fn area(&self) -> f32 {
        self.faces().map(|face| face.area()).sum()
    }

    fn sample(&self, u: [f32; 3]) -> Spot {
        let total = self.areas.last().copied().unwrap_or(0);
        let target = ((u128::from((u[0] * 16_777_216.0) as u32) * u128::from(total)) >> 24) as u64;
        let chosen = self.areas.partition_point(|&sum| sum <= target);
        let Some(triangle) = self.triangles.get(chosen) else {
            return Spot { point: Vec3::ZERO, normal: Vec3::Y };
        };
        face(self.vertices, triangle).sample(u)
    }

    /// Through its index: of places as near that of the lowest triangle. The point itself, if there are no triangles, or
    /// all are farther than squares can tell.
    fn nearest(&self, point: Vec3) -> Vec3 {
        let place = |piece| self.face(piece).map_or(point, |face: Triangle| face.nearest(point));
        self.index.nearest(self, point, place).0.unwrap_or(point)
    }

    fn bounds(&self) -> Aabb {
        self.bounds
    }

    /// By how often a straight way out crosses it; beyond 64 times it is taken for outside.
    fn is_inside(&self, point: Vec3) -> bool {
        let out = OUT * (2.0 * length(self.bounds.max - self.bounds.min));
        let (mut from, to) = (point, point + out);
        for crossings in 0..64 {
            let segment = Segment::new(from, to);
            let Some(hit) = self.first_hit(&segment) else { return crossings % 2 == 1 };
            from = segment.at(hit.time) + OUT * (4.0 * hit.slack);
        }
        false
    }
}

impl Pieces for Mesh<'_> {
    fn count(&self) -> usize {
        self.triangles.len()
    }

    #[inline(always)]
    fn box_of(&self, piece: usize) -> Aabb {
        self.face(piece).map_or(Aabb::EMPTY, |face| face.bounds())
    }

    #[inline(always)]
    fn hit(&self, piece: usize, segment: &Segment) -> Option<Hit> {
        Some(Hit { face: piece as u32, ..self.face(piece)?.first_hit(segment)? })
    }

    fn reach(&self) -> f32 {
        if self.triangles.is_empty() { 0.0 } else { max(largest(self.bounds.min), largest(self.bounds.max)) }
    }
}

impl Collider for Mesh<'_> {
    fn moves(&self) -> bool {
        false
    }

    /// Finds the first hit; of hits at one time, that of the lower triangle. Watertight: an edge shared by two
    /// triangles is judged by the same arithmetic for both.
    fn first_hit(&self, segment: &Segment) -> Option<Hit> {
        self.index.first_hit(self, segment)
    }

    fn may_touch(&self, bounds: &Aabb) -> bool {
        self.bounds.with_slack().overlaps(bounds)
    }

    fn mark_near(&self, hulls: &Hulls, marks: &mut Marks) {
        hulls.near_box(&self.bounds, marks);
    }

    fn contacts(&self, center: Vec3, reach: f32, _: Time, visit: &mut dyn FnMut(&Contact)) {
        let bounds = Aabb { min: center - reach, max: center + reach }.with_slack();
        self.index.near(self, &bounds, &mut |piece| {
            if let Some(face) = self.face(piece) {
                face.contact(center, reach, piece as u32).iter().for_each(&mut *visit);
            }
        });
    }

    fn contacts_of(&self, faces: &[u32], center: Vec3, reach: f32, _: Time, visit: &mut dyn FnMut(&Contact)) {
        let contact = |&face: &u32| self.face(face as usize)?.contact(center, reach, face);
        faces.iter().filter_map(contact).for_each(|contact| visit(&contact));
    }

    fn is_empty(&self) -> bool {
        self.triangles.is_empty()
    }
}

impl Mapped for Mesh<'_> {
    fn image(&self, map: &Affine, bounds: &Aabb, visit: &mut dyn FnMut(u32, &dyn Collider)) {
        let mut show = |number: usize| {
            let image =
                self.face(number).map(|face| Triangle { corners: face.corners.map(|corner| map.point(corner)) });
            if let Some(image) = image.filter(|image| image.bounds().overlaps(bounds)) {
                visit(number as u32, &image);
            }
        };
        match map.inverse() {
            Some(back) => {
                // As much room as the way there and back may cost.
                let far = high(bounds.min.abs(), bounds.max.abs());
                let own = high(self.bounds.min.abs(), self.bounds.max.abs());
                let room = (back.linear.abs() * (far + map.linear.abs() * own + map.shift.abs()) + back.shift.abs())
                    * (32.0 * f32::EPSILON);
                let local = back.bounds(bounds);
                self.index.near(self, &Aabb { min: local.min - room, max: local.max + room }, &mut show);
            }
            None => (0..self.triangles.len()).for_each(show),
        }
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
            fn is_inside(&self, point: Vec3) -> bool {
                self.view().is_inside(point)
            }
        }
        impl Collider for $owner {
            fn moves(&self) -> bool {
                false
            }
            fn first_hit(&self, segment: &Segment) -> Option<Hit> {
                self.view().first_hit(segment)
            }
            fn may_touch(&self, bounds: &Aabb) -> bool {
                self.view().may_touch(bounds)
            }
            fn mark_near(&self, hulls: &Hulls, marks: &mut Marks) {
                self.view().mark_near(hulls, marks);
            }
            fn contacts(&self, center: Vec3, reach: f32, at: Time, visit: &mut dyn FnMut(&Contact)) {
                self.view().contacts(center, reach, at, visit);
            }
            fn contacts_of(&self, faces: &[u32], center: Vec3, reach: f32, at: Time, visit: &mut dyn FnMut(&Contact)) {
                self.view().contacts_of(faces, center, reach, at, visit);
            }
            fn is_empty(&self) -> bool {
                self.view().is_empty()
            }
        }
        impl Mapped for $owner {
            fn image(&self, map: &Affine, bounds: &Aabb, visit: &mut dyn FnMut(u32, &dyn Collider)) {
                self.view().image(map, bounds, visit);
            }
        }
    )+};
}
#[cfg(feature = "alloc")]
through_view!(MeshBuf, alloc::sync::Arc<MeshBuf>, super::HeightFieldBuf);

fn check(vertices: &[Vec3], triangles: &[[u32; 3]]) -> Result<(), BadMesh> {
    if let Some(vertex) = vertices.iter().position(|v| !v.is_finite()) {
        return Err(BadMesh::Vertex { vertex });
    }
    match triangles.iter().position(|t| t.iter().any(|&i| i as usize >= vertices.len())) {
        Some(triangle) => Err(BadMesh::Index { triangle }),
        None => Ok(()),
    }
}

/// The area of the largest triangle in running sums; 2³⁶, so that 2²⁸ triangles cannot overflow the sum.
const UNIT: f32 = 68_719_476_736.0;

/// Fills in running sums of areas; where all are zero every triangle counts alike.
fn sum_areas(vertices: &[Vec3], triangles: &[[u32; 3]], areas: &mut [u64]) {
    // With the largest coordinate about one, no area is beyond an `f32`, whatever the vertices.
    let scale = power_to_one(vertices.iter().fold(0.0, |most, vertex| max(largest(*vertex), most)));
    let size = |t| face(vertices, t).scaled(scale).area();
    let greatest = triangles.iter().map(size).fold(0.0, max);
    let usable = greatest > 0.0;
    let mut sum = 0;
    for (triangle, slot) in triangles.iter().zip(areas) {
        sum += if usable { (size(triangle) / greatest * UNIT) as u64 } else { 1 };
        *slot = sum;
    }
}

fn face(vertices: &[Vec3], triangle: &[u32; 3]) -> Triangle {
    Triangle { corners: triangle.map(|i| vertices.get(i as usize).copied().unwrap_or(Vec3::ZERO)) }
}

#[cfg(all(test, feature = "alloc"))]
mod tests {
    use super::*;
    use crate::math::{length, unit};
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
            let hit = mesh.first_hit(&Segment::new(inside, inside + out));
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
        let mesh = MeshBuf::new(vec![], vec![]).expect("nothing is wrong with nothing");
        assert!(mesh.is_empty());
        assert_eq!(mesh.nearest(Vec3::X), Vec3::X);
        let _ = mesh.sample([0.5; 3]);
    }
}
