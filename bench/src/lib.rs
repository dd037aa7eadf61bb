//! pointmass: bench.
