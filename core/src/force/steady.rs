//! Forces that one pass over the columns can work out: what falls, and is braked by the air.

use crate::integrate::Drift;
use crate::lanes::{run, run_at_length};
use crate::rows::{Accelerate, Extents, Fall, Leap};
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
    pub(crate) fn accelerate(self, rows: Inertia<'_>, velocity: &[Vec3], acceleration: &mut [Vec3]) {
        let Self { acceleration: g, drags } = self;
        match (g.is_some(), drags) {
            (false, false) => run(Accelerate { fall: self.fall::<false, false>(rows), velocity, acceleration }),
            (true, false) => run(Accelerate { fall: self.fall::<true, false>(rows), velocity, acceleration }),
            (false, true) => run(Accelerate { fall: self.fall::<false, true>(rows), velocity, acceleration }),
            (true, true) => run(Accelerate { fall: self.fall::<true, true>(rows), velocity, acceleration }),
        }
    }

    /// Moves rows by a step of `h` \[s\] of the symplectic or the explicit Euler method, to the bits of doing it with their accelerations.
    /// Says how far they get, and keeps where they were in as many rows as there are of `start`.
    pub(crate) fn leap(
        self,
        rows: Inertia<'_>,
        ends: Ends<'_>,
        start: Ends<'_>,
        h: f32,
        drift: Drift,
    ) -> Option<Extents> {
        match drift {
            Drift::Before => self.leap_by::<false>(rows, ends, start, h),
            Drift::After => self.leap_by::<true>(rows, ends, start, h),
        }
    }

    fn leap_by<const SYMPLECTIC: bool>(
        self,
        rows: Inertia<'_>,
        ends: Ends<'_>,
        start: Ends<'_>,
        h: f32,
    ) -> Option<Extents> {
        match (self.acceleration.is_some(), self.drags) {
            (false, false) => {
                run_at_length(Leap::<_, _, SYMPLECTIC> { fall: self.fall::<false, false>(rows), ends, start, h })
            }
            (true, false) => {
                run_at_length(Leap::<_, _, SYMPLECTIC> { fall: self.fall::<true, false>(rows), ends, start, h })
            }
            (false, true) => {
                run_at_length(Leap::<_, _, SYMPLECTIC> { fall: self.fall::<false, true>(rows), ends, start, h })
            }
            (true, true) => {
                run_at_length(Leap::<_, _, SYMPLECTIC> { fall: self.fall::<true, true>(rows), ends, start, h })
            }
        }
    }

    fn fall<const FALLS: bool, const DRAGS: bool>(self, rows: Inertia<'_>) -> Fall<'_, FALLS, DRAGS> {
        let Inertia { mass, drag, inverse_mass, common } = rows;
        Fall { g: self.acceleration.unwrap_or(Vec3::ZERO), mass, drag, inverse_mass, common }
    }
}

/// Columns of places and velocities.
pub(crate) type Ends<'a> = [&'a mut [Vec3]; 2];

/// The columns of some rows that tell how they fall.
#[derive(Clone, Copy)]
pub(crate) struct Inertia<'a> {
    pub(crate) mass: &'a [f32],
    pub(crate) drag: &'a [f32],
    pub(crate) inverse_mass: &'a [f32],
    /// The numbers that these consist of, if that is known.
    pub(crate) common: Option<[f32; 3]>,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::force::{Drag, Force, Gravity, QuadraticDrag, State};
    use crate::math::max;
    use crate::rng::Stream;
    use crate::rows::{add_scaled, farthest, flat};

    /// Numbers of all kinds, those that are none among them.
    fn strange(i: u32) -> f32 {
        let [u, _] = Stream::new(9, 0, i).units(0);
        [u - 0.5, 0.0, -0.0, 1e30 * u, f32::NAN, f32::INFINITY, 1e-40, -3.0 * u][i as usize % 8]
    }

    /// Bits, of whatever is a number.
    fn is_same(a: &[Vec3], b: &[Vec3]) -> bool {
        let bits = |x: &f32| if x.is_nan() { None } else { Some(x.to_bits()) };
        flat(a).iter().map(bits).eq(flat(b).iter().map(bits))
    }

    #[test]
    fn one_pass_has_the_bits_of_the_sums() {
        let gravity = |i: u32| Gravity { acceleration: Vec3::new(strange(i), -9.8, strange(i + 1)) };
        for len in 0..70_usize {
            let number = |i: usize, place: usize| strange((7 * i + place + len) as u32);
            let velocity: std::vec::Vec<Vec3> =
                (0..len).map(|i| Vec3::new(number(i, 0), number(i, 1), number(i, 2))).collect();
            // In some of these all are alike.
            let row = |i: usize| if len % 3 == 0 { 0 } else { i };
            let mass: std::vec::Vec<f32> = (0..len).map(|i| number(row(i), 3).abs()).collect();
            let drag: std::vec::Vec<f32> = (0..len).map(|i| number(row(i), 4)).collect();
            let is_fixed = |i: usize| len % 6 != 0 && row(i).is_multiple_of(5);
            let inverse_mass: std::vec::Vec<f32> =
                mass.iter().enumerate().map(|(i, m)| if is_fixed(i) { 0.0 } else { 1.0 / m }).collect();
            let state = State { velocity: &velocity, position: &velocity, mass: &mass, drag: &drag, ..State::EMPTY };
            let g = gravity(len as u32);
            for forces in [&() as &dyn Force, &g, &Drag {}, &(g, Drag {}), &(Drag {}, g), &((), (g, ()), [Drag {}])] {
                let steady = forces.steady().expect("it is steady");
                let (mut once, mut sum) = (std::vec![Vec3::ONE; len], std::vec![Vec3::ZERO; len]);
                let first = [&mass, &drag, &inverse_mass].map(|column| column.first().copied());
                let common = if let ([Some(m), Some(k), Some(inverse)], true) = (first, len % 12 == 0) {
                    Some([m, k, inverse])
                } else {
                    None
                };
                let rows = Inertia { mass: &mass, drag: &drag, inverse_mass: &inverse_mass, common };
                steady.accelerate(rows, &velocity, &mut once);
                forces.add_to(&state, 0..len, &mut sum);
                for (sum, &inverse) in sum.iter_mut().zip(&inverse_mass) {
                    *sum = if inverse == 0.0 { Vec3::ZERO } else { *sum * inverse };
                }
                assert!(is_same(&once, &sum), "{once:?} {sum:?}");
                for (drift, keeps) in [Drift::Before, Drift::After].into_iter().zip([len % 2, 1]) {
                    let (mut x, mut v) = (velocity.clone(), velocity.clone());
                    let [mut start_x, mut start_v] = [(); 2].map(|()| std::vec![Vec3::ONE; keeps * len]);
                    let reached = steady.leap(rows, [&mut x, &mut v], [&mut start_x, &mut start_v], 0.3, drift);
                    let kept = &velocity[..keeps * len];
                    assert!(is_same(&start_x, kept) && is_same(&start_v, kept));
                    if let Some(Extents { place, speed, change }) = reached {
                        assert!(flat(&x).iter().chain(flat(&v)).all(|number| number.is_finite()));
                        assert_eq!(place, farthest(&x));
                        let (before, after) = (farthest(&velocity), farthest(&v));
                        let most = max(farthest(&change[..1]), farthest(&change[1..]));
                        assert!(speed >= max(before, after) && speed <= 1.000_01 * (before + most) + 1e-37);
                        for (v0, v1) in velocity.iter().zip(&v) {
                            let (apart, rounding) = (*v1 - *v0, Vec3::splat(1e-6 * speed));
                            assert!(apart.cmpge(change[0] - rounding).all() && apart.cmple(change[1] + rounding).all());
                        }
                    }
                    let (mut place, mut after) = (velocity.clone(), velocity.clone());
                    add_scaled(&mut after, 0.3, &once);
                    add_scaled(&mut place, 0.3, if drift == Drift::After { &after } else { &velocity });
                    assert!(is_same(&x, &place) && is_same(&v, &after), "{len} {drift:?}");
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
