//! Other libraries that find what is near, and such that find what a ray hits, each used as fast as its public interface
//! allows, behind one small trait for either; and, with the feature `rapier`, an engine of rigid bodies.
//!
//! Each asks its questions from the points in the order its own structure has them, where that is to be had: what is
//! near in space is then near in memory. Single core, `f32`, no code that needs a nightly compiler.

mod kiddo;
#[cfg(nanoflann)]
mod nanoflann;
mod parry;
mod particular;
#[cfg(feature = "rapier")]
pub mod rapier;
mod rays;
mod rstar;
mod zelll;

pub use particular::particular_barnes_hut;
pub use rays::{FirstHit, RayPeer, ray_peers};

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

/// All libraries that this build has: nanoflann only where its header was found.
#[must_use]
pub fn peers() -> Vec<Box<dyn Peer>> {
    vec![
        Box::new(kiddo::Kiddo::default()),
        Box::new(rstar::Rstar::default()),
        Box::new(zelll::Zelll::default()),
        Box::new(parry::Parry::default()),
        #[cfg(nanoflann)]
        Box::new(nanoflann::Nanoflann::default()),
    ]
}

/// The square of a distance, added in the order of pointmass.
fn square_distance(a: [f32; 3], b: [f32; 3]) -> f32 {
    let [x, y, z] = [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
    x * x + y * y + z * z
}

/// Makes room for `k` distances of each of `points` points, or as many as there are others: the new part and how many
/// a point has.
fn room(distances: &mut Vec<f32>, points: usize, k: usize) -> (&mut [f32], usize) {
    let k = k.min(points.saturating_sub(1));
    let start = distances.len();
    distances.resize(start + points * k, 0.0);
    (&mut distances[start..], k)
}
