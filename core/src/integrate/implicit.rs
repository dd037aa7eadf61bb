//! Implicit Euler.

use super::{Dynamics, Integrator, Linear, Motion, advance_by};
use crate::force::Perturbation;
use crate::lanes::dot;
use crate::report::Effort;
use crate::rows::add_scaled;
use crate::time::Time;
use glam::Vec3;

/// Implicit Euler: v += h a, x += h v with the acceleration and the velocity of the step's end, found by Newton's method
/// (Baraff and Witkin, "Large Steps in Cloth Simulation", SIGGRAPH 1998).
///
/// Order 1, stable at any step; fast motion is damped the more, the longer the step. For what is stiff and may look soft: cloth, hair, thick
/// springs at sixty steps a second. Each Newton step costs one evaluation and as many products with the forces' Jacobian as conjugate gradients
/// take, preconditioned by its diagonal. Forces that give no Jacobian are taken as constant over each Newton step: with one they act as in an
/// explicit method, with several they are iterated, which diverges, uncounted, where h² times their slope over the mass is more than one. Nothing
/// is allocated; a solution that is cut off is still a step toward it, and counted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Implicit {
    /// Newton steps; one solves a linear system exactly, and that of springs well enough.
    pub newton: u32,
    /// Iterations of conjugate gradients at the most for each Newton step.
    pub iterations: u32,
    /// The residual at which a solution is good enough, as a share of what it begins with.
    pub residual: f32,
}

impl Implicit {
    /// One Newton step, 200 iterations, a residual of 1e-4.
    pub const USUAL: Self = Self { newton: 1, iterations: 200, residual: 1e-4 };
}

impl Default for Implicit {
    fn default() -> Self {
        Self::USUAL
    }
}

impl Integrator for Implicit {
    fn columns(&self) -> usize {
        5
    }

    fn needs_start(&self) -> bool {
        true
    }

    fn lead(&self) -> f32 {
        1.0
    }

    fn advance(&self, motion: Motion<'_>, time: Time, step: Time, world: &mut dyn Dynamics) {
        let Motion { position: x, velocity: v, start: [x0, v0], work, effort, .. } = motion;
        let [r, p, q, correction, inverse_diagonal] = work.take();
        let h = step.seconds();
        for newton in 0..self.newton.max(1) {
            let mut solver = Solver { limits: self, h, r, p, q, correction, inverse_diagonal };
            world.linearise(time + step, x, v, &mut |system| {
                // The first Newton step linearises where the step begins, later ones where the last one ended.
                solver.right_hand_side(system, v0, newton == 0);
                solver.solve(system, effort);
            });
            add_scaled(v, 1.0, correction);
            advance_by(x, x0, h, v);
        }
    }
}

/// By how much a system is made smaller whose residual has no square: 2⁻⁹⁶.
const SMALL: f32 = 1.0 / (1u128 << 96) as f32;

/// Solves (M − h ∂f/∂v − h² ∂f/∂x) δv = r for the correction δv.
struct Solver<'a> {
    limits: &'a Implicit,
    h: f32,
    r: &'a mut [Vec3],
    p: &'a mut [Vec3],
    q: &'a mut [Vec3],
    correction: &'a mut [Vec3],
    /// Zero where nothing is solved for.
    inverse_diagonal: &'a mut [Vec3],
}

impl Solver<'_> {
    /// r = M (v₀ − v) + h f; if the forces are those at the step's beginning, and not where `v` leads, with their change on
    /// the way, h² (∂f/∂x) v, as well.
    fn right_hand_side(&mut self, system: &Linear<'_>, v0: &[Vec3], at_start: bool) {
        let (h, v) = (self.h, system.state.velocity);
        system.force(self.r);
        if at_start {
            system.jacobian(&Perturbation { along: v, position: h, velocity: 0.0 }, self.q);
            add_scaled(self.r, 1.0, self.q);
        }
        system.stiffness([h * h, h], self.inverse_diagonal);
        for (i, &w) in system.inverse_mass.iter().enumerate() {
            let mass = 1.0 / w;
            let (r, diagonal) = (self.r[i] * h + (v0[i] - v[i]) * mass, self.inverse_diagonal[i] + mass);
            let free = w > 0.0 && w < f32::INFINITY && r.is_finite() && diagonal.is_finite();
            self.r[i] = if free { r } else { Vec3::ZERO };
            self.inverse_diagonal[i] = if free { diagonal.recip() } else { Vec3::ZERO };
        }
    }

    /// Conjugate gradients from zero (Shewchuk, "An Introduction to the Conjugate Gradient Method Without the Agonizing
    /// Pain", 1994, B3). Sums run in eight lanes, the same on every machine.
    fn solve(&mut self, system: &Linear<'_>, effort: &mut Effort) {
        self.correction.fill(Vec3::ZERO);
        self.precondition(0.0);
        let mut first = dot(self.r, self.p);
        // Where squares are beyond an `f32`, all is solved so many times smaller: one that is driven very far holds nobody
        // up.
        let scale = if first < f32::INFINITY { 1.0 } else { SMALL };
        if scale < 1.0 {
            self.r.iter_mut().for_each(|r| *r *= scale);
            self.precondition(0.0);
            first = dot(self.r, self.p);
        }
        let enough = first * self.limits.residual * self.limits.residual;
        // Not a number is not enough, but nothing can be done about it.
        let solved = |left: f32| left >= 0.0 && left <= enough;
        let mut left = first;
        let mut iterations = 0;
        while !solved(left) && iterations < self.limits.iterations {
            self.apply(system);
            let curvature = dot(self.p, self.q);
            if !(curvature > 0.0 && curvature < f32::INFINITY) {
                break;
            }
            add_scaled(self.correction, left / curvature, self.p);
            add_scaled(self.r, -left / curvature, self.q);
            let before = left;
            left = self.weighed_residual();
            self.precondition(left / before);
            iterations += 1;
        }
        for ((correction, inverse), &w) in
            self.correction.iter_mut().zip(&*self.inverse_diagonal).zip(system.inverse_mass)
        {
            // A particle kept out of the system because it is not finite goes at the end of the step.
            if *inverse == Vec3::ZERO && w != 0.0 {
                *correction = Vec3::NAN;
            } else if scale < 1.0 {
                *correction /= scale;
            }
        }
        effort.solved(iterations, if first > 0.0 { crate::math::sqrt(left / first) } else { 0.0 }, !solved(left));
    }

    /// p = z + β p, z being the preconditioned residual.
    fn precondition(&mut self, beta: f32) {
        for ((p, r), inverse) in self.p.iter_mut().zip(&*self.r).zip(&*self.inverse_diagonal) {
            *p = if beta > 0.0 { *r * *inverse + *p * beta } else { *r * *inverse };
        }
    }

    /// r · z.
    fn weighed_residual(&mut self) -> f32 {
        for ((q, r), inverse) in self.q.iter_mut().zip(&*self.r).zip(&*self.inverse_diagonal) {
            *q = *r * *inverse;
        }
        dot(self.r, self.q)
    }

    /// q = (M − h ∂f/∂v − h² ∂f/∂x) p, zero where nothing moves.
    fn apply(&mut self, system: &Linear<'_>) {
        let h = self.h;
        system.jacobian(&Perturbation { along: self.p, position: h * h, velocity: h }, self.q);
        for (((q, p), &w), inverse) in
            self.q.iter_mut().zip(&*self.p).zip(system.inverse_mass).zip(&*self.inverse_diagonal)
        {
            *q = if *inverse == Vec3::ZERO { Vec3::ZERO } else { *p / w - *q };
        }
    }
}
