//! pointmass: tests.
