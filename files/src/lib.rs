#![doc = include_str!("../README.md")]

pub mod disk;
mod fault;
pub mod film;
pub mod formats;
pub mod instant;
pub mod meshes;
pub mod outcome;
pub mod pattern;
pub mod points;
pub mod record;
pub mod temporary;
pub mod whole;
