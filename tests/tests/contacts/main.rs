//! Particles that have a radius meet each other: by impulse, by force, by position.

mod gas;
mod impulse;
