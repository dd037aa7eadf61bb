//! Particles that have a radius meet each other: by impulse, by force, by position.

mod askew;
mod at_once;
mod bounds;
mod bowls;
mod drums;
mod elastic;
mod events;
mod fast;
mod force;
mod friction;
mod funnels;
mod gas;
mod impulse;
mod meetings;
mod poison;
mod position;
mod resting;
mod stacks;
mod told;
