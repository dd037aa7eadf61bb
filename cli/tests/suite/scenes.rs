//! Scenes that several tests run.

/// Initial particles with springs, births, deaths of both kinds, bounces: a bit of everything.
pub(crate) const BUSY: &str = "\
material 0 0 0  1 0 0  0 0 0  0 0 0  0 0 0  1 1 0
particle_gravity 0 -9.8 0
particle  0 1 0   1 0 0   1 0 0.1 0.5 0   0
particle  0 2 0   0 0 0   2 1 0.0 0.5 0  -1
particle  0 3 0   0 0 1   1 0 0.0 0.9 0.3 0
particle_spring 0 1 1 10 0.1
box -1  -5 -1 -5  5 0 5
particle_source 1 0 0 0.5 0.4  0  50 1 0.3  sphere 0 3 0 0.5
particle_source 1 0 0 0.8 0   -1  20 1 0.3  circle 2 1 0 0 1 0 0.3
particle_sink 5 1 0 1  sphere 2 0.5 0 0.3
";

/// 300 births per second that never die and never move.
pub(crate) const SOURCE: &str = "particle_source 1 0 0 0 0 -1  300 0 0  box 0 0 0 9 9 9\n";

/// One particle that moves steadily along x.
pub(crate) const ONE: &str = "particle 1 2 3  0.5 0 0  1 0 0 0 0 -1\n";

/// A triangle.
pub(crate) const TRIANGLE: &str = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
