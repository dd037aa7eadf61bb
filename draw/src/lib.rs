//! The software renderer: a scene of plain triangles, lights and dots in, pictures out.
//!
//! Three steps, in the order a program takes them:
//!
//! 1. Describe the unmoving part of the scene as a [`Stage`]: a [`Camera`], some [`Light`]s, and
//!    [`Piece`]s made of [`Surface`]s ([`shapes`] makes the usual ones).
//! 2. Hand it to [`Renderer::new`], which draws it once, carefully, with antialiasing and shadows.
//! 3. For every frame call [`Renderer::frame`] with what moves ([`Moving`]), which gives a picture.
//!
//! Colours are written as people write them in scene files and see them on a screen (sRGB, 0 to 1
//! or 0 to 255). They are decoded on the way in, and all arithmetic happens in linear light.
//!
//! The same stage and dots give the same bytes, whenever and on however many threads they are drawn.
//! Anything with a coordinate that is not finite is left out of the picture.
//!
#![doc = include_str!("../README.md")]

mod air;
mod backdrop;
mod billboard;
mod bloom;
mod brush;
mod camera;
mod canvas;
mod clip;
mod color;
mod contact;
mod eye;
mod lamp;
mod model;
mod panes;
mod picture;
mod raster;
mod rays;
mod render;
mod segments;
mod shade;
pub mod shapes;
mod sky;
mod sprite;
mod stage;
mod surface;
#[cfg(test)]
mod tests;

pub use air::Fog;
pub use camera::Camera;
pub use canvas::Exposure;
pub use picture::Flipbook;
pub use render::{Renderer, develop};
pub use sky::Background;
pub use stage::{Billboard, Dot, Light, Line, Material, Moving, Piece, Stage};
pub use surface::Surface;
