//! What is kept apart: points and triangles, edges and edges, particles and faces of the scenery.

use super::super::contacts::{TangentImpulse, Touch};
use super::closest::Kind;
use crate::math::max;
use glam::Vec3;

/// How much farther a corner may be pushed than what touches has to part, at the most: where all others are fixed, and its share in the place that touches is
/// small, more would throw it away.
const LEVER: f32 = 4.0;

/// A point and a triangle, or two edges, that are kept apart.
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(super) struct Contact {
    pub(super) corners: [u32; 4],
    /// The number of the corners that are the first one's.
    pub(super) split: u32,
    /// The shares of the corners in the places that touch; they add up to zero.
    pub(super) weights: [f32; 4],
    /// Unit vector from the second to the first.
    pub(super) normal: Vec3,
    /// How far apart they are to be at the sub-step's end \[m\].
    pub(super) target: f32,
    /// How much of that gives a gap back that was missing \[m\].
    pub(super) recovery: f32,
    /// 1 if the two would pass each other.
    pub(super) meets: u32,
    pub(super) touch: Touch,
    pub(super) tangent: TangentImpulse,
}

impl Contact {
    pub(super) fn key(&self) -> ([u32; 4], u32) {
        (self.corners, self.split)
    }

    pub(super) fn meets(&self) -> bool {
        self.meets != 0
    }

    /// Tells whether it is other than a point over a triangle: the line between the two can lean against both sheets.
    pub(super) fn leans(&self) -> bool {
        self.split != Kind::PointTriangle.split() as u32 || self.weights.contains(&0.0)
    }

    /// The particles that stand for both.
    pub(super) fn sides(&self) -> [usize; 2] {
        let second = if self.split == Kind::PointTriangle.split() as u32 { 1 } else { 2 };
        [self.corners[0] as usize, self.corners[second] as usize]
    }

    /// How far the two move apart by a unit push \[1/kg\], or count as doing so: no less than a share of how far that moves any corner. Zero if none of them
    /// can be moved.
    pub(super) fn ease(&self, weight: &[f32]) -> f32 {
        let parts = self.corners.iter().zip(self.weights);
        let [parting, moving] = parts.fold([0.0, 0.0], |[sum, most], (&corner, share)| {
            let weight = weight[corner as usize];
            [sum + share * share * weight, max((share * weight).abs(), most)]
        });
        max(parting, moving * (1.0 / LEVER))
    }

    /// The weighted sum of something of its corners: how the first differs from the second in it.
    #[inline(always)]
    pub(super) fn between(&self, of: impl Fn(usize) -> Vec3) -> Vec3 {
        let [a, b, c, d] = self.corners;
        let [a, b, c, d] = [of(a as usize), of(b as usize), of(c as usize), of(d as usize)];
        let [_, p, q, r] = self.weights;
        (b - a) * p + (c - a) * q + (d - a) * r
    }
}

/// A face of the scenery that a particle is kept from.
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(super) struct Surface {
    pub(super) particle: u32,
    pub(super) normal: Vec3,
    /// How far along the normal the particle is to be from the origin at the sub-step's end \[m\], and at the least.
    pub(super) offset: f32,
    pub(super) limit: f32,
    /// How much of the first gives a gap back that was missing \[m\].
    pub(super) recovery: f32,
    /// How far off it is as the sub-step begins \[m\].
    pub(super) distance: f32,
    /// How it moves there \[m/s\].
    pub(super) velocity: Vec3,
    pub(super) touch: Touch,
    pub(super) tangent: TangentImpulse,
}
