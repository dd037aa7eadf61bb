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
    /// The way to the next point as the last sub-step's solution has left it \[m\].
    pub(super) was: Vec3,
}

/// A joint as a sub-step began, as far as that is remembered.
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(super) struct Begun {
    /// The edge's frame.
    pub(super) turn: [f32; 4],
    /// The part of the point's way that rounding had left \[m\].
    pub(super) left: Vec3,
    /// The way to the next point as the last solution has left it \[m\].
    pub(super) was: Vec3,
}

impl Joint {
    /// The part of it that is remembered.
    pub(super) fn begun(&self) -> Begun {
        Begun { turn: self.turn, left: self.left, was: self.was }
    }
}

/// The words that a joint takes.
pub(super) const KEPT: usize = size_of::<Joint>() / 4;
