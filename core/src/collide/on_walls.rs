//! Two that meet while walls bear them: what one would push the other into a wall by, the wall takes up in the same instant.
//!
//! Hit by hit the wall would send it back to the other, and that into the wall again: what they come to is the limit of all these hits, which no number of them
//! reaches.

use super::meeting::{Answer, Touch};
use super::slide::Slide;
use super::sweep::RESTING;
use crate::math::length;
use crate::observe::Sliding;
use glam::Vec3;

/// The least part by which something that meets another yields of that by which it would without walls.
const YIELDS: f32 = 1e-3;

/// The part of two accelerations by which what stays in touch may seem to part or to come closer, by rounding.
const ROUNDING: f32 = 4.0 * f32::EPSILON;

/// The number of pushes that are tried for two to stay in touch.
const MOST_LOOKS: u32 = 24;

impl Touch {
    /// The answer of both where walls bear one or both; none, if these leave no way for them to yield.
    pub(super) fn answer_on_walls(&self, dt: f32, rest: f32) -> Option<Answer> {
        let (n, [wa, wb]) = (self.normal, self.inverse_mass);
        let sides = [n * wa, n * -wb];
        // How an impulse of one moves each.
        let moved = [0, 1].map(|i| {
            let (side, left) = (sides[i], self.borne[i].left_of(sides[i]));
            if left.dot(side) > YIELDS * side.dot(side) { left } else { Vec3::ZERO }
        });
        let yielding = (moved[0] - moved[1]).dot(n);
        if !(yielding > 0.0) {
            return None;
        }
        let relative = self.velocity[0] - self.velocity[1];
        let incoming = relative.dot(n);
        let outgoing = if incoming < 0.0 { -incoming * self.mixed.elasticity } else { incoming };
        let pressing = -(self.acceleration[0] - self.acceleration[1]).dot(n);
        let rests = pressing > 0.0 && 2.0 * outgoing < RESTING * dt * pressing;
        let outgoing = if rests { 0.0 } else { outgoing };
        let came = relative - n * incoming;
        let braked = self.mixed.friction.answer(came, outgoing - incoming);
        let impulse = (outgoing - incoming) / yielding;
        let shares = [wa / (wa + wb), -wb / (wa + wb)];
        let velocity =
            [0, 1].map(|i| self.velocity[i] + moved[i] * impulse + self.borne[i].left_of(braked * shares[i]));
        if !rests {
            let way = [0, 1].map(|i| (velocity[i] + self.free[i] * (0.5 * rest)) * rest);
            let ends = [0, 1].map(|i| velocity[i] + self.free[i] * rest);
            return Some(Answer { velocity, way, ends, slid: None });
        }
        let (acceleration, pressing) = self.held_together(velocity, sides);
        let slip = (velocity[0] - velocity[1]) - n * (velocity[0] - velocity[1]).dot(n);
        let drive = acceleration[0] - acceleration[1];
        let slide = Slide { velocity: slip, drive, pressing, friction: self.mixed.friction };
        let (way, end) = slide.after(rest);
        // By how much friction brakes them.
        let [back, slower] = [way - (slip + drive * (0.5 * rest)) * rest, end - (slip + drive * rest)];
        let along = [drive, way, slip, end];
        let slid = Some(Sliding { mass: 1.0 / (wa + wb), raised: Vec3::ZERO, world: along, along });
        let share = |of: Vec3, i: usize| self.borne[i].left_of(of * shares[i]);
        let ways = [0, 1].map(|i| (velocity[i] + acceleration[i] * (0.5 * rest)) * rest + share(back, i));
        let ends = [0, 1].map(|i| velocity[i] + acceleration[i] * rest + share(slower, i));
        Some(Answer { velocity, way: ways, ends, slid })
    }

    /// The accelerations of two that stay in touch, each borne by its walls unless it leaves them, and what presses them together as if there were none \[m/s²\]: by
    /// regula falsi, as a push moves each as far as the walls leave, which is piece by piece in proportion to it.
    fn held_together(&self, velocity: [Vec3; 2], sides: [Vec3; 2]) -> ([Vec3; 2], f32) {
        let borne = [0, 1].map(|i| self.borne[i].kept_by([self.velocity[i], velocity[i]]));
        // What else acts along the walls, as their friction.
        let besides = [0, 1].map(|i| self.acceleration[i] - borne[i].left_of(self.free[i]));
        let pushed = |push: f32| [0, 1].map(|i| borne[i].left_of(self.free[i] + sides[i] * push) + besides[i]);
        let parting = |accelerations: [Vec3; 2]| (accelerations[0] - accelerations[1]).dot(self.normal);
        let rate = (sides[0] - sides[1]).dot(self.normal);
        let least = ROUNDING * (length(self.free[0]) + length(self.free[1]));
        let ([mut low, mut push], mut at_low) = ([0.0, 0.0], parting(pushed(0.0)));
        let mut high = None;
        for _ in 0..MOST_LOOKS {
            push = match high {
                Some((high, at_high)) => low - at_low * ((high - low) / (at_high - at_low)),
                // None yields more than without walls.
                None => 2.0 * low - at_low / rate,
            };
            let at = parting(pushed(push));
            match () {
                () if at > least => high = Some((push, at)),
                () if at < -least => (low, at_low) = (push, at),
                () => break,
            }
        }
        (pushed(push), push * rate)
    }
}

#[cfg(test)]
mod tests {
    use super::super::borne::Borne;
    use super::*;
    use crate::force::Friction;
    use crate::material::Mixed;

    const DOWN: Vec3 = Vec3::new(0.0, -10.0, 0.0);

    /// Two in a groove of such slopes that are pressed on each other by gravity.
    fn in_a_groove(walls: [Vec3; 2], velocity: [Vec3; 2], elasticity: f32) -> Touch {
        let borne = walls.map(|normal| {
            let mut borne = Borne::NOT;
            borne.add(normal);
            borne
        });
        let mixed = Mixed { elasticity, friction: Friction::NONE };
        let acceleration = borne.map(|borne| borne.left_of(DOWN));
        let (normal, free) = (Vec3::X, [DOWN; 2]);
        Touch { normal, velocity, acceleration, free, inverse_mass: [1.0, 0.5], mixed, slack: 1e-6, borne }
    }

    #[test]
    fn two_on_slopes_that_lean_together_come_to_rest_at_once() {
        // The first comes down from the right, with the second below the left slope.
        let walls = [Vec3::new(-0.6, 0.8, 0.0), Vec3::new(0.6, 0.8, 0.0)];
        let along = [Vec3::new(-0.8, -0.6, 0.0) * 2.0, Vec3::new(0.8, -0.6, 0.0)];
        let touch = in_a_groove(walls, along, 0.0);
        let Answer { velocity, way, ends, .. } = touch.answer_on_walls(0.1, 0.1).expect("they yield along their walls");
        for (i, wall) in walls.into_iter().enumerate() {
            let least = [velocity[i], ends[i], way[i] * 10.0].map(|x| x.dot(wall));
            assert!(least.iter().all(|least| *least > -1e-5), "{least:?}");
        }
        assert!((velocity[0] - velocity[1]).dot(Vec3::X).abs() < 1e-5, "{velocity:?}");
        assert!((way[0] - way[1]).dot(Vec3::X).abs() < 1e-5, "{way:?}");
    }

    #[test]
    fn a_blow_without_loss_keeps_the_energy() {
        let walls = [Vec3::new(-0.6, 0.8, 0.0), Vec3::Y];
        let before = [Vec3::new(-4.0, -3.0, 1.0), Vec3::new(2.0, 0.0, 0.0)];
        let touch = in_a_groove(walls, before, 1.0);
        let Answer { velocity, .. } = touch.answer_on_walls(0.01, 0.01).expect("they yield");
        let energy = |v: [Vec3; 2]| 0.5 * v[0].length_squared() + v[1].length_squared();
        assert!((energy(velocity) / energy(before) - 1.0).abs() < 1e-6, "{velocity:?}");
    }
}
