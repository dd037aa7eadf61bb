//! Other libraries that a program may bring to be compared with: those that find what is near, and those that find what a
//! ray hits, behind one small trait for either. This program brings none; `pointmass-peers` does.

use crate::outcome::{Failure, Outcome};

/// A library that finds what is near.
///
/// A point is within a radius if its distance is not above it; rounding may decide otherwise than pointmass does. No
/// point is its own neighbour.
pub trait Peer {
    /// The library's name.
    fn name(&self) -> &'static str;

    /// Sorts the points in, which are finite. `reach` \[m\] is the radius that most queries will have: zelll makes its
    /// cells so large, the others do not look at it.
    fn build(&mut self, points: &[[f32; 3]], reach: f32);

    /// Bytes of what was built, counted from its parts; `None` if they are not to be known.
    fn bytes(&self) -> Option<usize>;

    /// Counts for every point the others within `radius`, in the fastest way there is; false if there is none.
    fn counts(&mut self, radius: f32, counts: &mut [u32]) -> bool;

    /// Writes every point's neighbours, one list after the other, into one buffer; their number over all points.
    fn lists(&mut self, radius: f32) -> Option<u64>;

    /// Visits every two points within `radius` of each other once; their number.
    fn pairs(&mut self, radius: f32, visit: &mut dyn FnMut(u32, u32)) -> Option<u64>;

    /// Appends for every point, in the order of the input, the distances of the `k` nearest others, ascending: `k` a
    /// point, or as many as there are others. False if there is no such query.
    fn nearest(&mut self, k: usize, distances: &mut Vec<f32>) -> bool;
}

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

/// The libraries that a program has; by default none.
#[derive(Default)]
pub struct Peers {
    /// Libraries that find what is near.
    pub of_points: Vec<Box<dyn Peer>>,
    /// Libraries that find the first triangle hit.
    pub of_meshes: Vec<Box<dyn RayPeer>>,
}

impl Peers {
    /// The peers that take part: all if they were asked for, else none.
    pub(super) fn asked(self, asked: bool) -> Outcome<Self> {
        match asked {
            false => Ok(Self::default()),
            true if self.of_points.is_empty() && self.of_meshes.is_empty() => Err(Failure::new(
                "this program has no other libraries; for --peers, run `cargo run --release -p pointmass-peers -- \
                 compare --peers` in the source of pointmass",
            )),
            true => Ok(self),
        }
    }
}

impl std::fmt::Debug for Peers {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let points = self.of_points.iter().map(|peer| peer.name());
        f.debug_list().entries(points.chain(self.of_meshes.iter().map(|peer| peer.name()))).finish()
    }
}
