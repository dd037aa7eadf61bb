//! Turbulence without sources: curl noise.

use super::Flow;
use crate::math::floor;
use crate::rng::threefry;
use crate::time::Time;
use glam::Vec3;

/// A turbulent flow that neither gathers nor spreads: the curl of a vector potential of gradient noise (Bridson, Houriham
/// and Nordenstam, "Curl-Noise for Procedural Fluid Flow", SIGGRAPH 2007; Perlin, "Improving Noise", 2002).
///
/// The derivatives are taken by formula, so that what flows into any region flows out of it. Its pattern repeats every 256
/// `scale`s.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Curl {
    /// Root mean square of the speed \[m/s\].
    pub speed: f32,
    /// About the size of an eddy \[m\]: the side of the noise's cells.
    pub scale: f32,
    /// The velocity at which the whole pattern is carried along \[m/s\]; it adds nothing to that of the air.
    #[cfg_attr(feature = "serde", serde(default))]
    #[cfg_attr(feature = "schema", schemars(with = "[f32; 3]"))]
    pub drift: Vec3,
    /// Every seed has a pattern of its own.
    #[cfg_attr(feature = "serde", serde(default))]
    pub seed: u32,
}

/// Cells after which the pattern repeats: a power of two.
const CELLS: u32 = 256;

/// One over the root mean square of the curl below, in cells: the mean over a cell of what eight corners add to it.
const NORMAL: f32 = 0.813_241_3;

impl Flow for Curl {
    fn velocity(&self, place: Vec3, time: Time) -> Vec3 {
        // Turns of the whole pattern, so that it is as smooth late as early.
        let passed = (self.drift / (self.scale * CELLS as f32)).to_array().map(|rate| time.turns(rate));
        curl(place / self.scale - Vec3::from_array(passed) * CELLS as f32, self.seed) * (self.speed * NORMAL)
    }
}

/// The curl of the potential at a place in cells.
fn curl(place: Vec3, seed: u32) -> Vec3 {
    let cell = Vec3::new(floor(place.x), floor(place.y), floor(place.z));
    let inside = place - cell;
    let [fade, slope] = [inside.to_array().map(fade), inside.to_array().map(slope)];
    // ∂ of each of the three noises along each axis.
    let mut gradients = [Vec3::ZERO; 3];
    for corner in 0..8u32 {
        let offset = [corner & 1, corner >> 1 & 1, corner >> 2];
        let vectors = vectors(core::array::from_fn(|axis| (cell[axis] as i32 as u32).wrapping_add(offset[axis])), seed);
        let from = inside - Vec3::from_array(offset.map(|offset| offset as f32));
        let (weight, change): ([f32; 3], [f32; 3]) = (
            core::array::from_fn(|axis| if offset[axis] == 1 { fade[axis] } else { 1.0 - fade[axis] }),
            core::array::from_fn(|axis| if offset[axis] == 1 { slope[axis] } else { -slope[axis] }),
        );
        let whole = weight[0] * weight[1] * weight[2];
        let slopes = Vec3::new(
            change[0] * weight[1] * weight[2],
            weight[0] * change[1] * weight[2],
            weight[0] * weight[1] * change[2],
        );
        for (gradient, vector) in gradients.iter_mut().zip(vectors) {
            *gradient += vector * whole + slopes * vector.dot(from);
        }
    }
    let [x, y, z] = gradients;
    Vec3::new(z.y - y.z, x.z - z.x, y.x - x.y)
}

/// Perlin's fade from 0 to 1, whose first two derivatives vanish at both ends.
fn fade(t: f32) -> f32 {
    t * t * t * (t * (t * 6.0 - 15.0) + 10.0)
}

/// How fast it rises.
fn slope(t: f32) -> f32 {
    30.0 * t * t * (t - 1.0) * (t - 1.0)
}

/// The gradients of the three noises at a corner: nine numbers of seven bits from −1 to 1.
fn vectors(corner: [u32; 3], seed: u32) -> [Vec3; 3] {
    let [x, y, z] = corner.map(|x| x % CELLS);
    let [low, high] = threefry([seed, 0x6375_726C], [x, y * CELLS + z]);
    let mut bits = u64::from(low) | u64::from(high) << 32;
    core::array::from_fn(|_| {
        Vec3::from_array(core::array::from_fn(|_| {
            let number = (bits & 127) as f32 * (2.0 / 127.0) - 1.0;
            bits >>= 7;
            number
        }))
    })
}
