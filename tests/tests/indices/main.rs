//! Every index against looking at every pair: the same rows, the same distances, to the last bit.

mod awkward;
mod expected;
mod memory;
mod periodic;
mod random;
mod sets;

const INF: f32 = f32::INFINITY;
