//! Other libraries that find what is near, and such that find what a ray hits, each used as fast as its public interface
//! allows, behind the traits of `pointmass compare`, which the program here runs beside them; and, with the feature `rapier`, an engine of rigid bodies.
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
#[cfg(feature = "rapier")]
pub mod rapier_cloth;
mod rays;
mod rstar;
mod zelll;

pub use particular::particular_barnes_hut;
pub use pointmass_cli::compare::{FirstHit, Peer, RayPeer};
pub use rays::ray_peers;

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
