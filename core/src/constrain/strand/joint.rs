//! What is kept of strands from sub-step to sub-step.

use glam::Vec3;

/// What is kept of a point: of the edge from it to the next one toward the root, and of the bend at it.
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(super) struct Joint {
    /// The edge's frame: a unit quaternion.
    pub(super) turn: [f32; 4],
    /// The pull in it at the end of the last sub-step \[N\].
    pub(super) tension: f32,
    /// How long it is at rest \[m\].
    pub(super) length: f32,
    /// How it is bent and twisted at rest against the edge before.
    pub(super) rest: Vec3,
}

/// The words that a joint takes.
pub(super) const KEPT: usize = size_of::<Joint>() / 4;
