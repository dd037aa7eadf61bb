//! The load that a particle bears beside its own mass, so that who solves for many of them at once feels how heavy that is.

use crate::memory::LOAD_WORDS;
use glam::Vec3;

/// The load of a particle in a sub-step.
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(crate) struct Load {
    /// How heavy all of it is \[kg\].
    pub(super) mass: f32,
    /// The sum of the masses by how far each is beside the particle, as the sub-step began \[kg m\].
    pub(super) moment: Vec3,
    /// How far the particle has been moved with it \[m\], and how much faster \[m/s\].
    pub(super) by: [Vec3; 2],
    /// One if a constraint solves for the particle and others at once, two if it bears what is laid on it besides; and the number of those that hold it, or
    /// the body that it is the first of.
    pub(super) solved: u32,
    pub(super) holders: u32,
    /// One if the particle has been moved to where its velocity leads.
    pub(super) caught_up: u32,
}

const _: () = assert!(size_of::<Load>() == 4 * LOAD_WORDS);
