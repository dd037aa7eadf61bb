//! Other libraries that find the first triangle of a mesh that a segment hits.
//!
//! Each keeps its triangles in the form and order that its documentation recommends for speed. Single core, `f32`.

mod bvh;
mod obvhs;
mod parry;

use crate::{FirstHit, RayPeer};

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
