//! bvh's `Bvh`, traversed with a query of our own: a segment that ends at the best hit so far. The crate's own rays have
//! no end, and its iterator in the order of distance cannot be told of hits, so it looks at more.
//!
//! Its stack holds 32 nodes: a tree that is deeper would make it panic.

use super::{FirstHit, RayPeer, corners, step};
use bvh::aabb::{Aabb, Bounded, IntersectsAabb};
use bvh::bounding_hierarchy::BHShape;
use bvh::bvh::BvhNode;
use std::cell::Cell;

#[derive(Default)]
pub(crate) struct Bvh {
    tree: Option<bvh::bvh::Bvh<f32, 3>>,
    faces: Vec<Face>,
}

struct Face {
    corners: [[f32; 3]; 3],
    number: u32,
    node: usize,
}

impl Bounded<f32, 3> for Face {
    fn aabb(&self) -> Aabb<f32, 3> {
        let [a, b, c] = self.corners;
        let each = |of: fn(f32, f32) -> f32| -> [f32; 3] { std::array::from_fn(|i| of(of(a[i], b[i]), c[i])) };
        Aabb::with_bounds(each(f32::min).into(), each(f32::max).into())
    }
}

impl BHShape<f32, 3> for Face {
    fn set_bh_node_index(&mut self, node: usize) {
        self.node = node;
    }

    fn bh_node_index(&self) -> usize {
        self.node
    }
}

/// A segment up to its best hit so far.
struct Segment {
    from: [f32; 3],
    step: [f32; 3],
    inverse: [f32; 3],
    end: Cell<f32>,
}

impl IntersectsAabb<f32, 3> for Segment {
    /// Slabs (Kay and Kajiya, SIGGRAPH 1986).
    fn intersects_aabb(&self, bounds: &Aabb<f32, 3>) -> bool {
        let (mut enter, mut leave) = (0.0f32, self.end.get());
        for i in 0..3 {
            let [a, b] = [bounds.min[i], bounds.max[i]].map(|side| (side - self.from[i]) * self.inverse[i]);
            // Where a slab's side is in the path's plane, that is no number, which `min` and `max` leave out.
            enter = enter.max(a.min(b));
            leave = leave.min(a.max(b));
        }
        enter <= leave
    }
}

impl Segment {
    /// The fraction at which it meets a triangle, from either side (Möller and Trumbore, Journal of Graphics Tools 2,
    /// 1997); the crate's own function meets front sides alone.
    fn meets(&self, [a, b, c]: &[[f32; 3]; 3]) -> Option<f32> {
        let (ab, ac, offset) = (minus(b, a), minus(c, a), minus(&self.from, a));
        let p = cross(&self.step, &ac);
        let inverse = 1.0 / dot(&ab, &p);
        let u = dot(&offset, &p) * inverse;
        let q = cross(&offset, &ab);
        let v = dot(&self.step, &q) * inverse;
        let time = dot(&ac, &q) * inverse;
        // Parallel to the plane, none of them is a number below infinity.
        (u >= 0.0 && v >= 0.0 && u + v <= 1.0 && time >= 0.0).then_some(time)
    }
}

fn minus(a: &[f32; 3], b: &[f32; 3]) -> [f32; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn dot(a: &[f32; 3], b: &[f32; 3]) -> f32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: &[f32; 3], b: &[f32; 3]) -> [f32; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

impl RayPeer for Bvh {
    fn name(&self) -> &'static str {
        "bvh-crate"
    }

    fn build(&mut self, vertices: &[[f32; 3]], triangles: &[[u32; 3]]) {
        let faces = corners(vertices, triangles).zip(0..);
        self.faces = faces.map(|(corners, number)| Face { corners, number, node: 0 }).collect();
        self.tree = Some(bvh::bvh::Bvh::build(&mut self.faces));
    }

    fn bytes(&self) -> usize {
        let nodes = self.tree.as_ref().map_or(0, |tree| tree.nodes.len());
        nodes * size_of::<BvhNode<f32, 3>>() + size_of_val(&*self.faces)
    }

    fn first_hits(&self, segments: &[[[f32; 3]; 2]], hits: &mut [FirstHit]) {
        let Some(tree) = &self.tree else { return };
        for (ends, hit) in segments.iter().zip(hits) {
            let step = step(ends);
            let segment = Segment { from: ends[0], step, inverse: step.map(|x| 1.0 / x), end: Cell::new(1.0) };
            *hit = None;
            for face in tree.traverse_iterator(&segment, &self.faces) {
                if let Some(time) = segment.meets(&face.corners).filter(|time| *time < segment.end.get()) {
                    segment.end.set(time);
                    *hit = Some((time, face.number));
                }
            }
        }
    }
}
