//! parry3d's `TriMesh` with its defaults, asked through `CompositeShapeRef`, which names the triangle.

use super::{FirstHit, RayPeer, step};
use parry3d::query::Ray;
use parry3d::shape::{CompositeShapeRef, TriMesh};

#[derive(Default)]
pub(crate) struct Parry(Option<TriMesh>);

impl RayPeer for Parry {
    fn name(&self) -> &'static str {
        "parry"
    }

    fn build(&mut self, vertices: &[[f32; 3]], triangles: &[[u32; 3]]) {
        let vertices = vertices.iter().map(|&vertex| vertex.into()).collect();
        self.0 = Some(TriMesh::new(vertices, triangles.to_vec()).expect("there is a triangle"));
    }

    fn bytes(&self) -> usize {
        self.0.as_ref().map_or(0, TriMesh::total_memory_size)
    }

    fn first_hits(&self, segments: &[[[f32; 3]; 2]], hits: &mut [FirstHit]) {
        let Some(mesh) = &self.0 else { return };
        for (segment, hit) in segments.iter().zip(hits) {
            let ray = Ray::new(segment[0].into(), step(segment).into());
            *hit = CompositeShapeRef(mesh).cast_local_ray(&ray, 1.0, false).map(|(triangle, time)| (time, triangle));
        }
    }
}
