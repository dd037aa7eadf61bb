//! Drag of particles side by side after hits, as `Air` has it.

use crate::lanes::{Lanes, Vectors, max, not};

/// What falls steadily, and is braked by linear drag.
#[derive(Clone, Copy)]
pub(in crate::collide) struct Airs<F> {
    /// The acceleration of all \[m/s²\], or none.
    pub(in crate::collide) gravity: Vectors<F>,
    pub(in crate::collide) mass: F,
    pub(in crate::collide) drag: F,
    pub(in crate::collide) inverse_mass: F,
}

impl<F: Lanes> Airs<F> {
    /// The sums of the forces over the masses.
    #[inline(always)]
    fn alone(&self, velocity: Vectors<F>) -> Vectors<F> {
        let pull = Vectors([self.mass.all(0.0); 3]) + self.gravity * self.mass;
        (pull - velocity * self.drag) * self.inverse_mass
    }

    /// The mean accelerations in the rests of a step, for which those up to then are known, and with which velocities.
    #[inline(always)]
    pub(super) fn acceleration(
        &self,
        [mean, mean_velocity]: [Vectors<F>; 2],
        velocity: Vectors<F>,
        rest: F,
    ) -> Vectors<F> {
        let all = |x| rest.all(x);
        let before = self.alone(mean_velocity);
        let jump = self.alone(velocity) - before;
        let first = mean + jump;
        let square = first.dot(first);
        let again = mean + (self.alone(velocity + first * (all(0.5) * rest)) - before);
        let change = again - first;
        let z = max(all(-2.0) * change.dot(first) / square, all(0.0));
        let more = all(1.0) + z * (all(2.0 / 3.0) + z * all(1.0 / 3.0));
        let damping = more / (all(1.0) + z * (all(1.0) + z * (all(0.5) + z * all(1.0 / 6.0))));
        let solved = first + change * damping;
        let [x, y, z] = (solved * all(0.0)).0;
        Vectors::select((x + y + z).simd_eq(all(0.0)) & not(jump.is_zero()), solved, mean)
    }
}
