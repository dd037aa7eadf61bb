//! A particle that rests on a surface: it slides, stops and stays by Coulomb's law.

use crate::force::Friction;
use crate::math::{self, dot, length, over, plus, scaled, unit};
use glam::Vec3;

/// How something moves along a surface that presses back, for a while: all vectors lie in the surface.
#[derive(Clone, Copy, Debug)]
pub(super) struct Slide {
    /// Its velocity along the surface \[m/s\].
    pub(super) velocity: Vec3,
    /// The acceleration that drives it along the surface \[m/s²\].
    pub(super) drive: Vec3,
    /// The acceleration that presses it onto the surface \[m/s²\].
    pub(super) pressing: f32,
    pub(super) friction: Friction,
}

impl Slide {
    /// The way it goes in `time` \[s\] and the velocity it has then: braked against its motion, at rest for as long as the
    /// drive is not above what friction can hold, else driven by what is left.
    pub(super) fn after(&self, time: f32) -> (Vec3, Vec3) {
        let speed = length(self.velocity);
        if speed == 0.0 {
            return self.starting(time);
        }
        let held = self.friction.kinetic * self.pressing;
        let going = |acceleration: Vec3| {
            let way = scaled(math::along(self.velocity, acceleration, 0.5 * time), time);
            (way, math::along(self.velocity, acceleration, time))
        };
        if !(held > 0.0) {
            return going(self.drive);
        }
        let along = over(self.velocity, speed);
        let acceleration = math::along(self.drive, along, -held);
        let braking = -dot(acceleration, along);
        if braking * time > speed {
            let until = speed / braking;
            let way = scaled(math::along(self.velocity, acceleration, 0.5 * until), until);
            // The rest beside the old direction is what the drive has turned it to: friction takes that up anew.
            let (rest, velocity) = self.starting(time - until);
            return (plus(way, rest), velocity);
        }
        // Friction is against the motion all along. Told by the direction at the end it only ever shortens a velocity;
        // by that at the beginning it would throw a slow one from side to side.
        let along = unit(math::along(self.velocity, self.drive, time));
        going(math::along(self.drive, along, -held))
    }

    fn starting(&self, time: f32) -> (Vec3, Vec3) {
        let pull = length(self.drive);
        if pull <= self.friction.static_ * self.pressing || !(pull > 0.0) {
            return (Vec3::ZERO, Vec3::ZERO);
        }
        let left = pull - self.friction.kinetic * self.pressing;
        // Where the sliding coefficient is the larger one, it only creeps loose.
        let acceleration = scaled(self.drive, if left > 0.0 { left } else { 0.0 } / pull);
        (scaled(acceleration, 0.5 * time * time), scaled(acceleration, time))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn slide(velocity: f32, drive: f32, pressing: f32) -> Slide {
        let friction = Friction { static_: 0.5, kinetic: 0.4 };
        Slide { velocity: Vec3::X * velocity, drive: Vec3::X * drive, pressing, friction }
    }

    #[test]
    fn it_brakes_stops_and_stays() {
        // 4 m/s² of braking: 2 m/s is gone after half a second and half a metre.
        let (way, velocity) = slide(2.0, 0.0, 10.0).after(0.25);
        assert!((way.x - 0.375).abs() < 1e-6 && (velocity.x - 1.0).abs() < 1e-6);
        let (way, velocity) = slide(2.0, 0.0, 10.0).after(3.0);
        assert!((way.x - 0.5).abs() < 1e-6 && velocity == Vec3::ZERO);
    }

    #[test]
    fn it_stays_below_the_resting_coefficient_and_slides_above() {
        assert_eq!(slide(0.0, 4.9, 10.0).after(1.0), (Vec3::ZERO, Vec3::ZERO));
        let (way, velocity) = slide(0.0, 5.1, 10.0).after(1.0);
        assert!((way.x - 0.55).abs() < 1e-6 && (velocity.x - 1.1).abs() < 1e-6);
    }

    #[test]
    fn up_a_slope_it_stops_and_comes_back() {
        // Braked by 6 + 4 m/s² it stops after 0.2 s and 0.2 m, then slides back with 6 − 4.
        let (way, velocity) = slide(2.0, -6.0, 10.0).after(1.2);
        assert!((way.x - (0.2 - 1.0)).abs() < 1e-6 && (velocity.x + 2.0).abs() < 1e-6);
    }

    #[test]
    fn without_friction_it_only_falls_along() {
        let free = Slide { friction: Friction::NONE, ..slide(1.0, -2.0, 10.0) };
        let (way, velocity) = free.after(1.0);
        assert!(way.x.abs() < 1e-6 && (velocity.x + 1.0).abs() < 1e-6);
    }
}
