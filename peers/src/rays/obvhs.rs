//! obvhs: its binary tree and its compressed tree of eight branches, both with the preset `medium_build`, which is about
//! as fast to build as Embree's and faster to ask than the quicker ones. Triangles are kept in the order of the leaves.

use super::{FirstHit, RayPeer, corners, step};
use obvhs::BvhBuildParams;
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::builder::build_bvh2_from_tris;
use obvhs::cwbvh::CwBvh;
use obvhs::cwbvh::builder::build_cwbvh_from_tris;
use obvhs::cwbvh::node::CwBvhNode;
use obvhs::ray::{Ray, RayHit};
use obvhs::triangle::Triangle;
use std::time::Duration;

/// The binary tree.
#[derive(Default)]
pub(crate) struct Binary(Bvh2, Vec<Triangle>);

/// The tree of eight branches.
#[derive(Default)]
pub(crate) struct Wide(CwBvh, Vec<Triangle>);

fn all(vertices: &[[f32; 3]], triangles: &[[u32; 3]]) -> Vec<Triangle> {
    let triangle = |[a, b, c]: [[f32; 3]; 3]| Triangle { v0: a.into(), v1: b.into(), v2: c.into() };
    corners(vertices, triangles).map(triangle).collect()
}

fn ordered(triangles: &[Triangle], order: &[u32]) -> Vec<Triangle> {
    order.iter().map(|&place| triangles[place as usize]).collect()
}

/// Hands every segment to a tree's `ray_traverse`, and reads its answer.
macro_rules! first_hits {
    ($tree:expr, $triangles:expr, $segments:expr, $hits:expr) => {
        for (segment, hit) in $segments.iter().zip($hits) {
            let ray = Ray::new(segment[0].into(), step(segment).into(), 0.0, 1.0);
            let mut found = RayHit::none();
            let is_hit = $tree.ray_traverse(ray, &mut found, |ray, place| $triangles[place].intersect(ray));
            *hit = is_hit.then(|| (found.t, $tree.primitive_indices[found.primitive_id as usize]));
        }
    };
}

impl RayPeer for Binary {
    fn name(&self) -> &'static str {
        "obvhs-2"
    }

    fn build(&mut self, vertices: &[[f32; 3]], triangles: &[[u32; 3]]) {
        let triangles = all(vertices, triangles);
        let tree = build_bvh2_from_tris(&triangles, BvhBuildParams::medium_build(), &mut Duration::default());
        *self = Self(tree, Vec::new());
        self.1 = ordered(&triangles, &self.0.primitive_indices);
    }

    fn bytes(&self) -> usize {
        size_of_val(&*self.0.nodes) + size_of_val(&*self.0.primitive_indices) + size_of_val(&*self.1)
    }

    fn first_hits(&self, segments: &[[[f32; 3]; 2]], hits: &mut [FirstHit]) {
        first_hits!(self.0, self.1, segments, hits);
    }
}

impl RayPeer for Wide {
    fn name(&self) -> &'static str {
        "obvhs-8"
    }

    fn build(&mut self, vertices: &[[f32; 3]], triangles: &[[u32; 3]]) {
        let triangles = all(vertices, triangles);
        let tree = build_cwbvh_from_tris(&triangles, BvhBuildParams::medium_build(), &mut Duration::default());
        *self = Self(tree, Vec::new());
        self.1 = ordered(&triangles, &self.0.primitive_indices);
    }

    fn bytes(&self) -> usize {
        self.0.nodes.len() * size_of::<CwBvhNode>() + size_of_val(&*self.0.primitive_indices) + size_of_val(&*self.1)
    }

    fn first_hits(&self, segments: &[[[f32; 3]; 2]], hits: &mut [FirstHit]) {
        first_hits!(self.0, self.1, segments, hits);
    }
}
