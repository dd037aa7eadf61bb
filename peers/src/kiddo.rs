//! kiddo's `ImmutableKdTree` with its defaults: leaves of 32 points, nodes in Eytzinger's order.
//!
//! Its join of two trees is meant for this work, but slower than single queries unless it is built with its nightly
//! `simd` code. Queries go through `visit` with a scratch stack, which allocate nothing.

use crate::{Peer, room};
use kiddo::{Eytzinger, ImmutableKdTree, QueryScratch, SquaredEuclidean};
use std::cell::Cell;
use std::hint::black_box;
use std::num::NonZero;

type Metric = SquaredEuclidean<f32>;
type Tree = ImmutableKdTree<f32, 3>;
type Scratch = QueryScratch<Eytzinger, f32, 3>;

#[derive(Default)]
pub(crate) struct Kiddo {
    tree: Option<(Tree, Scratch)>,
    list: Vec<u32>,
}

impl Peer for Kiddo {
    fn name(&self) -> &'static str {
        "kiddo"
    }

    fn build(&mut self, points: &[[f32; 3]], _: f32) {
        let tree = Tree::new_from_slice(points).expect("fewer than 2³² points");
        let scratch = tree.create_scratch::<Metric>();
        self.tree = Some((tree, scratch));
    }

    fn bytes(&self) -> Option<usize> {
        let (tree, _) = self.tree.as_ref()?;
        // Coordinates and numbers, where each leaf begins and ends, and a number for each node of a full binary tree.
        let leaves = tree.leaf_count();
        Some(tree.size() * 16 + leaves * size_of::<(usize, usize)>() + leaves.next_power_of_two() * 4)
    }

    fn counts(&mut self, radius: f32, counts: &mut [u32]) -> bool {
        let Some((tree, _)) = &self.tree else { return false };
        for (row, place) in tree.iter() {
            counts[row as usize] = count(tree, &place, radius * radius).saturating_sub(1);
        }
        true
    }

    fn lists(&mut self, radius: f32) -> Option<u64> {
        let (tree, scratch) = self.tree.as_mut()?;
        let mut total = 0;
        for (row, place) in tree.iter() {
            self.list.clear();
            let query = tree.query(&place).within::<Metric>(radius * radius).unsorted().without_distances();
            query.with_scratch(scratch).visit(|near| {
                if near.item != row {
                    self.list.push(near.item);
                }
            });
            total += black_box(&self.list).len() as u64;
        }
        Some(total)
    }

    fn pairs(&mut self, radius: f32, visit: &mut dyn FnMut(u32, u32)) -> Option<u64> {
        let (tree, scratch) = self.tree.as_mut()?;
        let mut total = 0;
        for (row, place) in tree.iter() {
            let query = tree.query(&place).within::<Metric>(radius * radius).unsorted().without_distances();
            query.with_scratch(scratch).visit(|near| {
                if near.item > row {
                    total += 1;
                    visit(row, near.item);
                }
            });
        }
        Some(total)
    }

    fn nearest(&mut self, k: usize, distances: &mut Vec<f32>) -> bool {
        let Some((tree, scratch)) = &mut self.tree else { return false };
        let (distances, k) = room(distances, tree.size(), k);
        let most = NonZero::<usize>::MIN.saturating_add(k);
        for (row, place) in tree.iter() {
            let query = tree.query(&place).nearest_n::<Metric>(most).without_items();
            let found = query.with_scratch(scratch).execute();
            // The point itself is the nearest, or as near as the nearest.
            for (distance, near) in distances[row as usize * k..].iter_mut().zip(&found[1..]) {
                *distance = near.distance.sqrt();
            }
        }
        true
    }
}

/// Counts the points within a distance, the point itself among them.
///
/// The counter is a `Cell`, shared: compilers make vector code of the leaves' loops then, 2.6 times as fast as with a
/// counter that the visitor borrows.
#[inline(never)]
fn count(tree: &Tree, place: &[f32; 3], square: f32) -> u32 {
    let count = Cell::new(0);
    let query = tree.query(place).within::<Metric>(square).unsorted().without_items().without_distances();
    query.visit(|_| count.set(count.get() + 1));
    count.get()
}
