//! Every structure over pieces against looking at each of them: the identical hit, to the last bit.

mod foreign;
mod memory;
mod meshes;
mod same;
