//! Drag of particles side by side after hits, as `Air` has it.

use crate::collide::air::ROUNDING;
use crate::lanes::{Lanes, Vectors, max, negated, not};

/// Particles that fall steadily, and are braked by linear drag.
#[derive(Clone, Copy)]
pub(in crate::collide) struct Airs<F> {
    /// The acceleration of all \[m/s²\], or none.
    pub(in crate::collide) gravity: Vectors<F>,
    pub(in crate::collide) mass: F,
    pub(in crate::collide) drag: F,
    pub(in crate::collide) inverse_mass: F,
}

/// Accelerations of paths that go on with other velocities: those with which they begin, and their means in the rest of the step.
#[derive(Clone, Copy)]
pub(super) struct Onwards<F> {
    pub(super) first: Vectors<F>,
    pub(super) mean: Vectors<F>,
}

impl<F: Lanes> Onwards<F> {
    /// The means of what surfaces of these normals keep from moving across them.
    #[inline(always)]
    pub(super) fn held(&self, normal: Vectors<F>) -> Vectors<F> {
        let more = self.first - self.mean;
        Vectors::select(more.is_zero(), self.mean, self.mean + normal * more.dot(normal))
    }
}

impl<F: Lanes> Airs<F> {
    /// The sums of the forces over the masses.
    #[inline(always)]
    fn alone(&self, velocity: Vectors<F>) -> Vectors<F> {
        let pull = Vectors([self.mass.all(0.0); 3]) + self.gravity * self.mass;
        (pull - velocity * self.drag) * self.inverse_mass
    }

    /// The accelerations with which paths go on with these velocities, of which the mean velocities and accelerations so far are known.
    #[inline(always)]
    pub(super) fn onward(&self, [past, acceleration]: [Vectors<F>; 2], velocity: Vectors<F>, rest: F) -> Onwards<F> {
        let (all, zero) = (|x| rest.all(x), rest.all(0.0));
        let (jump, change) = (self.alone(velocity) - self.alone(past), velocity - past);
        let first = acceleration + jump;
        let z = max(negated(jump.dot(change)) / change.dot(change), zero) * rest;
        let mean = first / (all(1.0) / (all(1.0) + z * (all(0.5) + z * all(1.0 / 6.0))) + z);
        let fastest = max(velocity.length(), past.length()) + acceleration.length() * rest;
        let is_slow = (velocity + mean * rest).length().simd_le(all(ROUNDING) * fastest);
        let [a, b, c] = (first * zero).0;
        let are = not(jump.is_zero()) & is_slow & (a + b + c).simd_eq(zero);
        Onwards { first: Vectors::select(are, first, acceleration), mean: Vectors::select(are, mean, acceleration) }
    }
}
