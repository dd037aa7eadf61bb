//! Forces that one pass over the columns can work out: what falls, and is braked by the air.

use crate::lanes::run;
use crate::rows::Fall;
use glam::Vec3;

/// The sum of forces that are no more than a steady acceleration of all and each particle's own linear drag.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Steady {
    /// The acceleration of all \[m/s²\].
    pub acceleration: Option<Vec3>,
    /// True if each is braked by its own coefficient.
    pub drags: bool,
}

impl Steady {
    /// Both of two; none, where a sum of three could round otherwise.
    #[must_use]
    pub fn and(self, other: Self) -> Option<Self> {
        let twice = self.acceleration.is_some() && other.acceleration.is_some() || self.drags && other.drags;
        let acceleration = self.acceleration.or(other.acceleration);
        (!twice).then_some(Self { acceleration, drags: self.drags || other.drags })
    }

    /// The accelerations \[m/s²\] that it gives rows, to the bits of the forces' sums over the masses.
    pub(crate) fn accelerate(
        self,
        velocity: &[Vec3],
        mass: &[f32],
        drag: &[f32],
        inverse_mass: &[f32],
        acceleration: &mut [Vec3],
    ) {
        let g = self.acceleration.unwrap_or(Vec3::ZERO);
        match (self.acceleration.is_some(), self.drags) {
            (false, false) => run(Fall::<false, false> { g, mass, velocity, drag, inverse_mass, acceleration }),
            (true, false) => run(Fall::<true, false> { g, mass, velocity, drag, inverse_mass, acceleration }),
            (false, true) => run(Fall::<false, true> { g, mass, velocity, drag, inverse_mass, acceleration }),
            (true, true) => run(Fall::<true, true> { g, mass, velocity, drag, inverse_mass, acceleration }),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::force::{Drag, Force, Gravity, QuadraticDrag, State};
    use crate::rng::Stream;

    /// Numbers of all kinds, those that are none among them.
    fn strange(i: u32) -> f32 {
        let [u, _] = Stream::new(9, 0, i).units(0);
        [u - 0.5, 0.0, -0.0, 1e30 * u, f32::NAN, f32::INFINITY, 1e-40, -3.0 * u][i as usize % 8]
    }

    #[test]
    fn one_pass_has_the_bits_of_the_sums() {
        let gravity = |i: u32| Gravity { acceleration: Vec3::new(strange(i), -9.8, strange(i + 1)) };
        for len in 0..70_usize {
            let number = |i: usize, place: usize| strange((7 * i + place + len) as u32);
            let velocity: std::vec::Vec<Vec3> =
                (0..len).map(|i| Vec3::new(number(i, 0), number(i, 1), number(i, 2))).collect();
            let mass: std::vec::Vec<f32> = (0..len).map(|i| number(i, 3).abs()).collect();
            let drag: std::vec::Vec<f32> = (0..len).map(|i| number(i, 4)).collect();
            let inverse_mass: std::vec::Vec<f32> =
                mass.iter().enumerate().map(|(i, m)| if i % 5 == 0 { 0.0 } else { 1.0 / m }).collect();
            let state = State { velocity: &velocity, position: &velocity, mass: &mass, drag: &drag, ..State::EMPTY };
            let g = gravity(len as u32);
            for forces in [&() as &dyn Force, &g, &Drag {}, &(g, Drag {}), &(Drag {}, g), &((), (g, ()), [Drag {}])] {
                let steady = forces.steady().expect("it is steady");
                let (mut once, mut sum) = (std::vec![Vec3::ONE; len], std::vec![Vec3::ZERO; len]);
                steady.accelerate(&velocity, &mass, &drag, &inverse_mass, &mut once);
                forces.add_to(&state, 0..len, &mut sum);
                for ((once, sum), &inverse) in once.iter().zip(sum).zip(&inverse_mass) {
                    let expected = sum.to_array().map(|f| if inverse == 0.0 { 0.0 } else { f * inverse });
                    for (a, b) in once.to_array().into_iter().zip(expected) {
                        assert!(a.to_bits() == b.to_bits() || a.is_nan() && b.is_nan(), "{a} {b}");
                    }
                }
            }
        }
    }

    #[test]
    fn what_is_more_is_not_steady() {
        let (g, drag) = (Gravity::EARTH, Drag {});
        assert!((g, g).steady().is_none() && (drag, g, drag).steady().is_none());
        assert!((g, QuadraticDrag { coefficient: 0.1 }).steady().is_none());
    }
}
