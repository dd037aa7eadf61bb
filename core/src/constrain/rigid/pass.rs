//! One pass over the points of two bodies that touch: impulses that bring them to part as is wanted, and friction.

use super::body::Body;
use super::manifold::{Manifold, Point};
use super::solver::SETTLED;
use crate::math::{dot, max, min, sqrt};
use glam::{Mat3, Vec3};

/// How a body moves, while impulses change that.
#[derive(Clone, Copy)]
struct Motion {
    inverse_mass: f32,
    velocity: Vec3,
    spin: Vec3,
    omega: Vec3,
    inverse: Mat3,
}

impl Motion {
    fn of(body: &Body) -> Self {
        let Body { inverse_mass, velocity, spin, omega, inverse, .. } = *body;
        Self { inverse_mass, velocity, spin, omega, inverse }
    }

    /// Gives it an impulse \[N s\] there.
    #[inline(always)]
    fn push(&mut self, arm: Vec3, impulse: Vec3) {
        let change = impulse * self.inverse_mass;
        let torque = arm.cross(change);
        self.velocity += change;
        self.spin += torque;
        self.omega += self.inverse * torque;
    }

    fn at(&self, arm: Vec3) -> Vec3 {
        self.velocity + self.omega.cross(arm)
    }

    fn yielding(&self, arm: Vec3, direction: Vec3) -> f32 {
        let lever = arm.cross(direction);
        self.inverse_mass * (1.0 + lever.dot(self.inverse * lever))
    }

    fn tell(&self, body: &mut Body) {
        (body.velocity, body.spin, body.omega) = (self.velocity, self.spin, self.omega);
    }
}

/// Two bodies that touch, while impulses between them are sought.
struct Touch<'a> {
    motions: [Motion; 2],
    normal: Vec3,
    along: [Vec3; 2],
    surface: Vec3,
    friction: [f32; 2],
    points: &'a mut [Point],
    /// True if some change was large enough to go over their neighbours again.
    is_changed: bool,
}

/// Goes over the points of two bodies once, and notes at which tick of the clock that was and whether it has changed the bodies.
pub(super) fn over(bodies: &mut [Body], manifold: &mut Manifold, back: f32, clock: u32) {
    let numbers = manifold.bodies.map(|number| number as usize);
    let Ok([a, b]) = bodies.get_disjoint_mut(numbers) else { return };
    let Manifold { axis, along, surface, friction, .. } = *manifold;
    manifold.seen = clock;
    let points = &mut manifold.points[..(manifold.count as usize).min(4)];
    let motions = [Motion::of(a), Motion::of(b)];
    let mut touch = Touch { motions, normal: axis, along, surface, friction, points, is_changed: false };
    touch.press_evenly();
    let has_friction = friction[0] + friction[1] > 0.0;
    for i in 0..touch.points.len() {
        touch.press(i, has_friction.then_some(back));
    }
    for (body, motion) in [a, b].into_iter().zip(&touch.motions) {
        if motion.inverse_mass > 0.0 {
            motion.tell(body);
            if touch.is_changed {
                body.changed = clock;
            }
        }
    }
}

impl Touch<'_> {
    /// How the second moves there as seen from the first \[m/s\].
    #[inline(always)]
    fn slip(&self, arms: [Vec3; 2]) -> Vec3 {
        let [a, b] = &self.motions;
        b.at(arms[1]) - a.at(arms[0]) - self.surface
    }

    #[inline(always)]
    fn push(&mut self, arms: [Vec3; 2], impulse: Vec3) {
        let [a, b] = &mut self.motions;
        a.push(arms[0], -impulse);
        b.push(arms[1], impulse);
    }

    /// Changes the impulses of all points that press, or should, by the same: what presses evenly, as a box that lies flat, is done with at
    /// once, whatever the order of points.
    fn press_evenly(&mut self) {
        let (mut lack, mut least, mut levers, mut number) = (0.0, f32::INFINITY, [Vec3::ZERO; 2], 0.0);
        let (mut counts, mut little) = ([false; 4], 0.0);
        for (point, counts) in self.points.iter().zip(&mut counts) {
            let missing = point.wanted - dot(self.slip(point.arms), self.normal);
            *counts = missing > 0.0 || point.pressed > 0.0;
            if *counts {
                (lack, least, number) = (lack + missing, min(least, point.pressed), number + 1.0);
                levers[0] += point.arms[0];
                levers[1] += point.arms[1];
                little += max(max(point.wanted, 0.0), point.driven) * SETTLED;
            }
        }
        if !(number > 1.0) {
            return;
        }
        let mean = levers.map(|lever| lever * (1.0 / number));
        let [a, b] = &self.motions;
        let yielding = a.yielding(mean[0], self.normal) + b.yielding(mean[1], self.normal);
        let each = max(lack / (number * number * yielding), -least);
        if each.is_finite() && each != 0.0 {
            for (point, _) in self.points.iter_mut().zip(counts).filter(|&(_, counts)| counts) {
                point.pressed += each;
            }
            self.push(mean, self.normal * (each * number));
            // The lack without its sign: what is not a number counts.
            self.is_changed |= !(lack * lack <= little * little);
        }
    }

    /// Brings the speed at which they part at a point to what is wanted, as far as pushing alone does it; then takes from their slip, and from
    /// what they have crept at so many times a second, what Coulomb's friction can.
    #[inline(always)]
    fn press(&mut self, i: usize, back: Option<f32>) {
        let Some(point) = self.points.get_mut(i).map(|point| *point) else { return };
        let Point { pressed, held, arms, wanted, answer, crept, .. } = point;
        let slip = self.slip(arms);
        let new = max(pressed + (wanted - dot(slip, self.normal)) * point.mass, 0.0);
        let impulse = new - pressed;
        let (mut holds, mut change) = (held, self.normal * impulse);
        let mut counts = max(max(wanted, 0.0), point.driven) * SETTLED;
        counts = if counts < f32::INFINITY { counts * point.mass } else { 0.0 };
        if let Some(back) = back {
            let slip = slip + answer * impulse + crept * back;
            let [u, v] = self.along.map(|along| dot(slip, along));
            let [uu, uv, vv] = point.rub;
            let (square, yields) = (u * u + v * v, uu * u * u + uv * u * v + vv * v * v);
            let mass = if square > 0.0 { square / yields } else { 0.0 };
            let [x, y] = [dot(held, self.along[0]) - u * mass, dot(held, self.along[1]) - v * mass];
            let (square, sticks) = (x * x + y * y, self.friction[0] * new);
            let size = if square <= sticks * sticks { 1.0 } else { sqrt(square) };
            let share = if square <= sticks * sticks { 1.0 } else { min(self.friction[1] * new, size) / size };
            holds = (self.along[0] * x + self.along[1] * y) * share;
            change += holds - held;
        }
        if change.is_finite() && change != Vec3::ZERO {
            (self.points[i].pressed, self.points[i].held) = (new, holds);
            self.push(arms, change);
            self.is_changed |= !(dot(change, change) <= counts * counts);
        }
    }
}
