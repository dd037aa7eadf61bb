//! particular's Barnes-Hut method.

use particular::math::Vec3;
use particular::sequential::BarnesHutSoftened;
use particular::{ComputeMethod, ParticleSystem, ParticleTree, PointMass};

/// Accelerations under the gravitation of all on all, with a gravitational constant of 1, by the crate particular: its
/// octree, built anew, cells opened if their width exceeds `theta` of their distance; one core.
///
/// # Panics
/// If `masses` or `accelerations` are not as many as `points`.
pub fn particular_barnes_hut(
    points: &[[f32; 3]],
    masses: &[f32],
    theta: f32,
    softening: f32,
    accelerations: &mut [[f32; 3]],
) {
    assert!(points.len() == masses.len() && points.len() == accelerations.len(), "one of each for every point");
    let bodies: Vec<_> = points.iter().zip(masses).map(|(&p, &m)| PointMass::new(Vec3::from(p), m)).collect();
    let tree = ParticleTree::from(&*bodies);
    let system = ParticleSystem { affected: &bodies, massive: &tree };
    let found: Vec<Vec3> = BarnesHutSoftened { theta, softening }.compute(system);
    for (acceleration, found) in accelerations.iter_mut().zip(found) {
        *acceleration = found.into();
    }
}
