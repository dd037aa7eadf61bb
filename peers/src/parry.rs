//! parry3d's `Bvh` over the boxes of single points, traversed with the distance of a node's box from the query.

use crate::Peer;
use parry3d::bounding_volume::Aabb;
use parry3d::math::Vector;
use parry3d::partitioning::{Bvh, BvhBuildStrategy, BvhNode, TraversalAction};
use std::hint::black_box;

#[derive(Default)]
pub(crate) struct Parry {
    tree: Bvh,
    list: Vec<u32>,
}

impl Parry {
    /// All points in the order of the tree: their rows and places.
    fn each(&self, mut visit: impl FnMut(u32, Vector)) {
        self.tree.traverse(|node| {
            if let Some(row) = node.leaf_data() {
                visit(row, node.mins());
            }
            TraversalAction::Continue
        });
    }

    /// The rows of all points within a distance.
    fn within(&self, place: Vector, square: f32, mut visit: impl FnMut(u32)) {
        self.tree.traverse(|node| {
            let outside = (node.mins() - place).max(place - node.maxs()).max(Vector::ZERO);
            if !(outside.length_squared() <= square) {
                return TraversalAction::Prune;
            }
            if let Some(row) = node.leaf_data() {
                visit(row);
            }
            TraversalAction::Continue
        });
    }
}

impl Peer for Parry {
    fn name(&self) -> &'static str {
        "parry"
    }

    fn build(&mut self, points: &[[f32; 3]], _: f32) {
        let boxes = points.iter().map(|&place| Aabb::new(place.into(), place.into()));
        self.tree = Bvh::from_iter(BvhBuildStrategy::Binned, boxes.enumerate());
    }

    fn bytes(&self) -> Option<usize> {
        Some(self.tree.total_memory_size())
    }

    fn counts(&mut self, radius: f32, counts: &mut [u32]) -> bool {
        self.each(|row, place| {
            let mut count = 0;
            self.within(place, radius * radius, |_| count += 1);
            counts[row as usize] = u32::saturating_sub(count, 1);
        });
        true
    }

    fn lists(&mut self, radius: f32) -> Option<u64> {
        let mut list = std::mem::take(&mut self.list);
        let mut total = 0;
        self.each(|row, place| {
            list.clear();
            self.within(place, radius * radius, |other| {
                if other != row {
                    list.push(other);
                }
            });
            total += black_box(&list).len() as u64;
        });
        self.list = list;
        Some(total)
    }

    fn pairs(&mut self, radius: f32, visit: &mut dyn FnMut(u32, u32)) -> Option<u64> {
        let square = radius * radius;
        let near = |a: &BvhNode, b: &BvhNode| {
            let between = (a.mins() - b.maxs()).max(b.mins() - a.maxs()).max(Vector::ZERO);
            between.length_squared() <= square
        };
        let mut total = 0;
        // Each pair comes in both orders. Two points alone come unasked.
        let apart = match (self.tree.leaf_count(), self.tree.leaf_node(0), self.tree.leaf_node(1)) {
            (2, Some(a), Some(b)) => !near(a, b),
            _ => false,
        };
        for (a, b) in self.tree.leaf_pairs(&self.tree, near) {
            if a < b && !apart {
                total += 1;
                visit(a, b);
            }
        }
        Some(total)
    }

    fn nearest(&mut self, _: usize, _: &mut Vec<f32>) -> bool {
        false
    }
}
