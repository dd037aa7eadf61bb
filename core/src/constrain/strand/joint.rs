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
    /// How far the point is from where its row says, since rounding has not let it get there \[m\]: nothing where nothing holds its strand, or its ends are turned.
    pub(super) left: Vec3,
}

/// What a sub-step remembers of a joint as that began.
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(super) struct Begun {
    /// The edge's frame.
    pub(super) turn: [f32; 4],
    /// What rounding had left of the point's way \[m\].
    pub(super) left: Vec3,
}

impl Joint {
    /// What is to be remembered of it.
    pub(super) fn begun(&self) -> Begun {
        Begun { turn: self.turn, left: self.left }
    }
}

/// The words that a joint takes.
pub(super) const KEPT: usize = size_of::<Joint>() / 4;
