//! The facts that scene files, checks and pictures ask of a constraint, whatever its kind.

use super::Constraint;
use crate::particles::Particle;
use alloc::boxed::Box;

/// A constraint that scene files can name.
pub(super) trait Declared: Constraint {
    /// The name of its kind, in small letters.
    fn name(&self) -> &'static str;

    /// How a sub-step solves it, in words.
    fn solved(&self) -> &'static str;

    /// The first of its numbers that cannot be used, and what it has to be.
    fn fault(&self) -> Option<(&'static str, &'static str)>;

    /// The particles of the scene's start that it binds, in up to three lists; the first of all is a part of what it holds.
    fn ends(&self) -> [&[u32]; 3];

    /// The number of things that it holds together, each by itself.
    fn count(&self) -> usize {
        1
    }

    /// The pairs of particles that it joins by straight links. By default it joins none.
    fn links(&self) -> Box<dyn Iterator<Item = [u32; 2]> + '_> {
        Box::new(core::iter::empty())
    }

    /// How long each of these links is at rest \[m\], and for ever the last of these; nothing, where that is as they begin.
    fn lengths(&self) -> &[f32] {
        &[]
    }

    /// The triangles of the surface that it makes of particles. By default it makes none.
    fn triangles(&self) -> Box<dyn Iterator<Item = [u32; 3]> + '_> {
        Box::new(core::iter::empty())
    }

    /// The part of it that acts along straight ways alone, and so not through the sides of a periodic room. By default all of it acts along the shortest.
    fn straight(&self) -> Option<&'static str> {
        None
    }

    /// True if it puts particles where a script says, whatever pulls at them.
    fn leads(&self) -> bool {
        false
    }

    /// True if all its particles hang together: who holds some of them holds all.
    fn is_body(&self) -> bool {
        false
    }

    /// True if it is solved by iterations (conjugate gradients) until little is left.
    fn iterates(&self) -> bool {
        false
    }

    /// α: how far a part of it gives way to a force \[m/N\]; zero is rigid.
    fn compliance(&self) -> f32 {
        0.0
    }

    /// True if its links only pull.
    fn is_tether(&self) -> bool {
        false
    }

    /// The stiffness of the stiffest of its parts \[N/m\], as particles start; none where it is rigid.
    fn stiffness(&self, _start: &[Particle]) -> Option<f64> {
        stiffness(self.compliance())
    }

    /// The inverse of the mass that the fastest oscillation of such a part moves \[1/kg\]. By default that of the lightest, four times, since
    /// beside a part that is stretched those beside it are pressed.
    fn inverse_mass(&self, start: &[Particle]) -> f64 {
        4.0 * self.ends().into_iter().flatten().map(|&end| inverse_mass(start, end)).fold(0.0, f64::max)
    }

    /// The share by which its own weight stretches it, were it hung from what is fixed of it, in gravity of so much \[m/s²\]; none where that
    /// is not known, or follows from its links.
    fn hung(&self, _start: &[Particle], _gravity: f32) -> Option<f64> {
        None
    }
}

/// The stiffness of what gives way so far \[N/m\]; none where that is rigid.
pub(super) fn stiffness(compliance: f32) -> Option<f64> {
    (compliance > 0.0).then(|| 1.0 / f64::from(compliance))
}

/// The inverse mass of a particle of the start \[1/kg\]: zero, if it is fixed.
pub(super) fn inverse_mass(start: &[Particle], number: u32) -> f64 {
    match start.get(number as usize) {
        Some(particle) if !particle.fixed => 1.0 / f64::from(particle.mass),
        _ => 0.0,
    }
}

/// Tells whether a list names a particle twice.
pub(super) fn names_twice(particles: &[u32]) -> bool {
    let mut sorted = particles.to_vec();
    sorted.sort_unstable();
    sorted.windows(2).any(|pair| pair[0] == pair[1])
}

/// The fault of a list of particles that names one twice.
pub(super) fn twice(particles: &[u32]) -> Option<(&'static str, &'static str)> {
    names_twice(particles).then_some(("particles", "must not name a particle twice"))
}
