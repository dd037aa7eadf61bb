//! How bodies move while impulses change that: what passes go over again and again, apart from all else that is known of them.

use super::body::Body;
use super::pose::Inverse;
use crate::lanes::{ABREAST, Eight, LANES, Vectors};
use glam::Vec3;

/// How a body moves, in fours: one over its mass and its velocity; its spin and how it turns; the tick of the clock of passes at which it was changed
/// last, and a word that says nothing.
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(super) struct Moving([[f32; 4]; 3]);

impl Moving {
    /// That of a body which has not been changed yet.
    fn of(body: &Body) -> Self {
        let ([x, y, z], [l, m, n], [p, q, r]) = (body.velocity.to_array(), body.spin.to_array(), body.omega.to_array());
        Self([[body.inverse_mass, x, y, z], [l, m, n, p], [q, r, 0.0, 0.0]])
    }

    /// Says that it has not been changed.
    pub(super) fn begin(&mut self) {
        self.0[2][2] = 0.0;
    }

    /// The tick at which it was changed last.
    #[inline(always)]
    pub(super) fn changed(&self) -> f32 {
        self.0[2][2]
    }

    pub(super) fn velocity(&self) -> Vec3 {
        let [[_, x, y, z], ..] = self.0;
        Vec3::new(x, y, z)
    }

    pub(super) fn spin(&self) -> Vec3 {
        let [_, [l, m, n, _], _] = self.0;
        Vec3::new(l, m, n)
    }

    pub(super) fn omega(&self) -> Vec3 {
        let [_, [.., p], [q, r, ..]] = self.0;
        Vec3::new(p, q, r)
    }

    /// Takes but a share of what has changed it since the body moved as it does.
    pub(super) fn go_part(&mut self, body: &Body, share: f32) {
        let part = |from: Vec3, to: Vec3| (from + (to - from) * share).to_array();
        let ([x, y, z], [l, m, n]) = (part(body.velocity, self.velocity()), part(body.spin, self.spin()));
        let [p, q, r] = part(body.omega, self.omega());
        let [[inverse_mass, ..], _, [_, _, changed, last]] = self.0;
        self.0 = [[inverse_mass, x, y, z], [l, m, n, p], [q, r, changed, last]];
    }

    fn tell(&self, body: &mut Body) {
        let [[_, x, y, z], [l, m, n, p], [q, r, ..]] = self.0;
        (body.velocity, body.spin, body.omega) = (Vec3::new(x, y, z), Vec3::new(l, m, n), Vec3::new(p, q, r));
    }
}

/// Takes how all bodies move.
pub(super) fn take(all: &mut [Moving], bodies: &[Body]) {
    all.iter_mut().zip(bodies).for_each(|(moving, body)| *moving = Moving::of(body));
}

/// Lets all bodies move so.
pub(super) fn tell(all: &[Moving], bodies: &mut [Body]) {
    all.iter().zip(bodies).filter(|(_, body)| body.moves()).for_each(|(moving, body)| moving.tell(body));
}

/// Four words of each.
#[inline(always)]
fn fours(&[a, b, c, d, e, f, g, h]: &[&Moving; LANES], number: usize) -> [[f32; 4]; LANES] {
    [a.0[number], b.0[number], c.0[number], d.0[number], e.0[number], f.0[number], g.0[number], h.0[number]]
}

/// How eight bodies move.
#[derive(Clone, Copy)]
pub(super) struct Moves<F> {
    inverse_mass: F,
    velocity: Vectors<F>,
    spin: Vectors<F>,
    omega: Vectors<F>,
    changed: F,
}

impl<F: Eight> Moves<F> {
    /// Those with some numbers; none where there is no such number.
    #[inline(always)]
    pub(super) fn of(like: F, all: &[Moving], numbers: &[u32; ABREAST]) -> Option<Self> {
        let mut eight = [all.first()?; LANES];
        for (place, &number) in eight.iter_mut().zip(numbers) {
            *place = all.get(number as usize)?;
        }
        let [inverse_mass, x, y, z] = like.quads_of(fours(&eight, 0));
        let [l, m, n, p] = like.quads_of(fours(&eight, 1));
        let [q, r, changed, _] = like.quads_of(fours(&eight, 2));
        let (velocity, spin, omega) = (Vectors([x, y, z]), Vectors([l, m, n]), Vectors([p, q, r]));
        Some(Self { inverse_mass, velocity, spin, omega, changed })
    }

    /// Notes a tick where a mask says that they have been changed at it.
    #[inline(always)]
    pub(super) fn note(&mut self, is_changed: F, tick: F) {
        self.changed = is_changed.select(tick, self.changed);
    }

    /// Writes down how those of which a bit is set move now.
    #[inline(always)]
    pub(super) fn tell(&self, all: &mut [Moving], numbers: &[u32; ABREAST], which: u32) {
        let ([x, y, z], [l, m, n], [p, q, r]) = (self.velocity.0, self.spin.0, self.omega.0);
        let first = F::rows_of([self.inverse_mass, x, y, z]);
        let (second, third) = (F::rows_of([l, m, n, p]), F::rows_of([q, r, self.changed, self.changed]));
        for lane in 0..ABREAST {
            if which >> lane & 1 != 0
                && let Some(moving) = all.get_mut(numbers[lane] as usize)
            {
                *moving = Moving([first[lane], second[lane], third[lane]]);
            }
        }
    }

    /// The change of how they turn by an angular impulse over the mass.
    #[inline(always)]
    fn turned_by(inverse: &Inverse, Vectors([x, y, z]): Vectors<F>) -> Vectors<F> {
        let [a, b, c] = inverse;
        Vectors::load(x, a) * x + Vectors::load(x, b) * y + Vectors::load(x, c) * z
    }

    /// Gives them impulses \[N s\] there.
    #[inline(always)]
    pub(super) fn push(&mut self, inverse: &Inverse, arm: Vectors<F>, impulse: Vectors<F>) {
        let change = impulse * self.inverse_mass;
        let torque = arm.cross(change);
        self.velocity = self.velocity + change;
        self.spin = self.spin + torque;
        self.omega = self.omega + Self::turned_by(inverse, torque);
    }

    #[inline(always)]
    pub(super) fn at(&self, arm: Vectors<F>) -> Vectors<F> {
        self.velocity + self.omega.cross(arm)
    }

    #[inline(always)]
    pub(super) fn yielding(&self, inverse: &Inverse, arm: Vectors<F>, direction: Vectors<F>) -> F {
        let lever = arm.cross(direction);
        self.inverse_mass * (self.inverse_mass.all(1.0) + lever.dot(Self::turned_by(inverse, lever)))
    }
}
