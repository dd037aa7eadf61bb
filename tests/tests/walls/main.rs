//! Walls that stand and walls that move: that nothing passes them, and how points and balls bounce, rest and slide.

mod balls;
mod blocks;
mod bounces;
mod braked;
mod creases;
mod elastic;
mod heights;
mod lying;
mod moving;
mod nearest;
mod needles;
mod poison;
mod riding;
mod scenes;
mod smooth;
mod tunnels;
mod turning;
