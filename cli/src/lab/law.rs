//! Textbook laws along x, as forces.

use core::ops::Range;
use pointmass::force::{Force, Perturbation, State};
use pointmass::{Particle, Vec3};

/// The pull on every particle along x, told by the acceleration \[m/s²\]. Computed in double precision, so that all
/// rounding is the engine's.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Law {
    /// At a place \[m\].
    pub(crate) pull: fn(f64) -> f64,
    /// How that changes with the place \[1/s²\].
    pub(crate) slope: fn(f64) -> f64,
    /// The energy whose slope it is \[J/kg\].
    pub(crate) energy: fn(f64) -> f64,
    /// The acceleration that comes on top of it at an instant \[s\], everywhere.
    pub(crate) push: Option<fn(f64) -> f64>,
}

/// x'' = −4 x.
pub(crate) const OSCILLATOR: Law = Law { pull: |x| -4.0 * x, slope: |_| -4.0, energy: |x| 2.0 * x * x, push: None };

/// x'' = −4 x + 2 cos t.
pub(crate) const DRIVEN: Law = Law { push: Some(|t| 2.0 * t.cos()), ..OSCILLATOR };

/// θ'' = −sin θ, the angle \[rad\] told as x.
pub(crate) const PENDULUM: Law = Law { pull: |x| -x.sin(), slope: |x| -x.cos(), energy: |x| 1.0 - x.cos(), push: None };

impl Law {
    fn push_at(&self, state: &State<'_>) -> f64 {
        self.push.map_or(0.0, |push| push(state.time.seconds_f64()))
    }

    /// Newtons for each metre, where it does not push away.
    fn stiffness(&self, state: &State<'_>, row: usize) -> f32 {
        let slope = (self.slope)(f64::from(state.position[row].x)).min(0.0);
        -slope as f32 * state.mass[row]
    }
}

impl Force for Law {
    fn add_to(&self, state: &State<'_>, rows: Range<usize>, total: &mut [Vec3]) {
        let push = self.push_at(state);
        for (total, row) in total.iter_mut().zip(rows) {
            let pull = (self.pull)(f64::from(state.position[row].x));
            total.x += (f64::from(state.mass[row]) * (pull + push)) as f32;
        }
    }

    fn add_jacobian(&self, state: &State<'_>, change: &Perturbation<'_>, total: &mut [Vec3]) {
        for (row, total) in total.iter_mut().enumerate() {
            total.x -= self.stiffness(state, row) * change.position * change.along[row].x;
        }
    }

    fn add_stiffness(&self, state: &State<'_>, [by_place, _]: [f32; 2], total: &mut [Vec3]) {
        for (row, total) in total.iter_mut().enumerate() {
            total.x += self.stiffness(state, row) * by_place;
        }
    }

    fn energy(&self, state: &State<'_>) -> f64 {
        let all = state.position.iter().zip(state.mass);
        all.map(|(x, &mass)| f64::from(mass) * (self.energy)(f64::from(x.x))).sum()
    }

    fn power(&self, state: &State<'_>) -> f64 {
        let push = self.push_at(state);
        state.velocity.iter().zip(state.mass).map(|(v, &mass)| f64::from(mass) * push * f64::from(v.x)).sum()
    }

    fn name(&self) -> &'static str {
        "law"
    }
}

/// Particles of 1 kg on the x axis, one for each place and speed.
pub(crate) fn on_the_axis(starts: impl IntoIterator<Item = [f32; 2]>) -> Vec<Particle> {
    let particle = |[x, v]: [f32; 2]| Particle { position: Vec3::X * x, velocity: Vec3::X * v, ..Particle::REST };
    starts.into_iter().map(particle).collect()
}
