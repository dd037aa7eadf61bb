//! Other libraries that find the first triangle of a mesh that a segment hits, behind one small trait.
//!
//! Each keeps its triangles in the form and order that its documentation recommends for speed. Single core, `f32`.

mod bvh;
mod obvhs;
mod parry;

/// Where a segment first meets a mesh: the fraction of the segment that is free, and the triangle.
pub type FirstHit = Option<(f32, u32)>;

/// A library that finds the first triangle hit.
///
/// Both sides of a triangle are hit. Rounding may decide otherwise than pointmass does, at edges above all: none of the
/// libraries promises that no segment slips between two triangles.
pub trait RayPeer {
    /// The library's name.
    fn name(&self) -> &'static str;

    /// Builds from vertices, which are finite, and triangles, of which there is one at least and which name vertices
    /// that are there.
    fn build(&mut self, vertices: &[[f32; 3]], triangles: &[[u32; 3]]);

    /// Bytes of what was built, triangles and all, counted from its parts.
    fn bytes(&self) -> usize;

    /// The first hits of as many segments, each from its first end, which differs from the second, to that. In one
    /// call, so that none is made through a table of functions for each of them.
    fn first_hits(&self, segments: &[[[f32; 3]; 2]], hits: &mut [FirstHit]);
}

/// All libraries, in each of the ways that are worth a look.
#[must_use]
pub fn ray_peers() -> Vec<Box<dyn RayPeer>> {
    vec![
        Box::new(parry::Parry::default()),
        Box::new(bvh::Bvh::default()),
        Box::new(obvhs::Binary::default()),
        Box::new(obvhs::Wide::default()),
    ]
}

/// The corners of all triangles.
fn corners(vertices: &[[f32; 3]], triangles: &[[u32; 3]]) -> impl Iterator<Item = [[f32; 3]; 3]> {
    triangles.iter().map(|triangle| triangle.map(|corner| vertices[corner as usize]))
}

/// From one end to the other.
fn step([from, to]: &[[f32; 3]; 2]) -> [f32; 3] {
    [to[0] - from[0], to[1] - from[1], to[2] - from[2]]
}
