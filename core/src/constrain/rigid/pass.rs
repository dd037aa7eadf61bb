//! Passes over the points of all that touch: impulses that bring them to part as is wanted, and friction.
//!
//! Eight times two bodies that have nothing to do with each other go side by side. Which these are makes no difference to any of them.

use super::body::Body;
use super::manifold::{Manifold, POINTS, Point};
use super::order::Order;
use super::solver::{PASSES, SETTLED};
use crate::lanes::{Eight, Kernel, LANES, Vectors, max, min, negated};
use bytemuck::Zeroable;
use core::mem::offset_of;
use glam::Vec3;

/// All that touch, and how they are gone over.
pub(super) struct Passes<'a, 'b> {
    pub(super) bodies: &'a mut [Body],
    pub(super) order: &'a mut Order<'b>,
    /// How often at the most.
    pub(super) count: u32,
}

/// Some of those that touch, by their numbers in the order.
struct Batch {
    numbers: [usize; LANES],
    count: usize,
}

impl Kernel for Passes<'_, '_> {
    type Output = ();
    /// Goes over all so many times at the most, and over those again whose bodies have been changed since.
    #[inline(always)]
    fn run<F: Eight>(mut self, like: F) {
        // A lane that stands for nobody.
        let (nobody, nothing) = (Body::zeroed(), Manifold::zeroed());
        for body in self.bodies.iter_mut() {
            body.changed = 0;
        }
        for number in 0..self.order.len() {
            if let Some(manifold) = self.order.get_mut(number) {
                manifold.seen = 0;
            }
        }
        let mut clock = 0;
        for pass in 0..self.count {
            let before = clock;
            if pass == PASSES {
                self.leave_out();
            }
            for colour in 0..self.order.colours() {
                clock = self.over(like, (&nobody, &nothing), colour, clock);
            }
            if clock == before {
                return;
            }
        }
    }
}

impl Passes<'_, '_> {
    /// Goes over those of one colour that have something left to do, all at one tick, however many go side by side; returns the last tick.
    #[inline(always)]
    fn over<F: Eight>(&mut self, like: F, idle: (&Body, &Manifold), colour: usize, clock: u32) -> u32 {
        let mut batch = Batch { numbers: [0; LANES], count: 0 };
        let (room, mut last) = (self.order.side_by_side(colour), clock);
        for number in self.order.range(colour) {
            let Some(manifold) = self.order.get(number) else { continue };
            let [a, b] = manifold.bodies;
            if self.changed(a).max(self.changed(b)) < manifold.seen {
                continue;
            }
            last = clock + 1;
            batch.numbers[batch.count % LANES] = number;
            batch.count += 1;
            if batch.count == room {
                self.go(like, idle, &batch, last);
                batch.count = 0;
            }
        }
        if batch.count > 0 {
            self.go(like, idle, &batch, last);
        }
        last
    }

    /// Leaves out of the passes to come who does not share in a blow.
    fn leave_out(&mut self) {
        for number in 0..self.order.len() {
            if let Some(manifold) = self.order.get_mut(number).filter(|manifold| manifold.lasts == 0) {
                manifold.seen = u32::MAX;
            }
        }
    }

    #[inline(always)]
    fn changed(&self, number: u32) -> u32 {
        self.bodies.get(number as usize).map_or(0, |body| body.changed)
    }

    /// Goes over the points of a batch once, and notes at which tick of the clock that was and whether it has changed the bodies.
    #[inline(always)]
    fn go<F: Eight>(&mut self, like: F, (nobody, nothing): (&Body, &Manifold), batch: &Batch, clock: u32) {
        let mut manifolds = [nothing; LANES];
        let mut bodies = [[nobody; LANES]; 2];
        for (lane, &number) in batch.numbers.iter().enumerate().take(batch.count) {
            let Some(manifold) = self.order.get(number) else { continue };
            manifolds[lane] = manifold;
            for (bodies, &number) in bodies.iter_mut().zip(&manifold.bodies) {
                let body = self.bodies.get(number as usize).filter(|body| body.gives(manifold.rested));
                bodies[lane] = body.unwrap_or(nobody);
            }
        }
        let mut touch = Touch::of(like, &manifolds, &bodies);
        touch.press_evenly();
        for i in 0..POINTS {
            touch.press(i);
        }
        self.tell(batch, &touch, clock);
    }

    /// Writes down how the bodies of a batch move now, and what presses on them.
    #[inline(always)]
    fn tell<F: Eight>(&mut self, batch: &Batch, touch: &Touch<F>, clock: u32) {
        let changed = touch.is_changed.to_bitmask();
        for (side, motion) in touch.motions.iter().enumerate() {
            let (velocity, spin, omega) = (motion.velocity.rows(), motion.spin.rows(), motion.omega.rows());
            for (lane, &number) in batch.numbers.iter().enumerate().take(batch.count) {
                let Some(manifold) = self.order.get(number) else { continue };
                let body = self.bodies.get_mut(manifold.bodies[side] as usize);
                let Some(body) = body.filter(|body| body.gives(manifold.rested)) else { continue };
                body.velocity = vector(velocity[lane]);
                body.spin = vector(spin[lane]);
                body.omega = vector(omega[lane]);
                if changed >> lane & 1 != 0 {
                    body.changed = clock;
                }
            }
        }
        for (i, spot) in touch.spots.iter().enumerate() {
            let forces = F::vectors_of([spot.pressed, spot.held[0], spot.held[1]]);
            for (forces, &number) in forces.iter().zip(&batch.numbers).take(batch.count) {
                let Some(manifold) = self.order.get_mut(number) else { continue };
                manifold.seen = clock;
                let point = &mut manifold.points[i];
                [point.pressed, point.held_along[0], point.held_along[1], _] = *forces;
            }
        }
    }
}

#[inline(always)]
fn vector([x, y, z, _]: [f32; 4]) -> Vec3 {
    Vec3::new(x, y, z)
}

/// Four words of a thing, as numbers.
#[inline(always)]
fn four<T: bytemuck::Pod>(of: &T, first: usize) -> [f32; 4] {
    let words: &[f32] = bytemuck::cast_slice(core::slice::from_ref(of));
    words.get(first..).and_then(|words| words.first_chunk()).copied().unwrap_or([0.0; 4])
}

/// How bodies move, while impulses change that.
#[derive(Clone, Copy)]
struct Motion<F> {
    inverse_mass: F,
    velocity: Vectors<F>,
    spin: Vectors<F>,
    omega: Vectors<F>,
    inverse: [Vectors<F>; 3],
}

impl<F: Eight> Motion<F> {
    #[inline(always)]
    fn of(like: F, bodies: &[&Body; LANES]) -> Self {
        let mut rows = [[[0.0; 4]; LANES]; 5];
        for (lane, &body) in bodies.iter().enumerate() {
            for (k, row) in rows.iter_mut().enumerate() {
                row[lane] = four(body, offset_of!(Body, inverse_mass) / 4 + 4 * k);
            }
        }
        let [a, b, c, d, e] = rows;
        let [inverse_mass, x, y, z] = like.quads_of(a);
        let [l, m, n, p] = like.quads_of(b);
        let [q, r, xx, xy] = like.quads_of(c);
        let [xz, yx, yy, yz] = like.quads_of(d);
        let [zx, zy, zz, _] = like.quads_of(e);
        Self {
            inverse_mass,
            velocity: Vectors([x, y, z]),
            spin: Vectors([l, m, n]),
            omega: Vectors([p, q, r]),
            inverse: [Vectors([xx, xy, xz]), Vectors([yx, yy, yz]), Vectors([zx, zy, zz])],
        }
    }

    /// The change of their spins by an angular impulse over the mass.
    #[inline(always)]
    fn turned_by(&self, Vectors([x, y, z]): Vectors<F>) -> Vectors<F> {
        let [a, b, c] = self.inverse;
        a * x + b * y + c * z
    }

    /// Gives them impulses \[N s\] there.
    #[inline(always)]
    fn push(&mut self, arm: Vectors<F>, impulse: Vectors<F>) {
        let change = impulse * self.inverse_mass;
        let torque = arm.cross(change);
        self.velocity = self.velocity + change;
        self.spin = self.spin + torque;
        self.omega = self.omega + self.turned_by(torque);
    }

    #[inline(always)]
    fn at(&self, arm: Vectors<F>) -> Vectors<F> {
        self.velocity + self.omega.cross(arm)
    }

    #[inline(always)]
    fn yielding(&self, arm: Vectors<F>, direction: Vectors<F>) -> F {
        let lever = arm.cross(direction);
        self.inverse_mass * (self.inverse_mass.all(1.0) + lever.dot(self.turned_by(lever)))
    }
}

/// One point of each two.
#[derive(Clone, Copy)]
struct Spot<F> {
    /// Where there is such a point.
    is_there: F,
    arms: [Vectors<F>; 2],
    /// How fast they shall part, the scenery's own speed included.
    wanted: F,
    mass: F,
    answer: [F; 2],
    lag: [F; 2],
    rub: [F; 3],
    /// The change of speed that is too small to go over their neighbours for.
    little: F,
    pressed: F,
    held: [F; 2],
}

impl<F: Eight> Spot<F> {
    #[inline(always)]
    fn of(like: F, manifolds: &[&Manifold; LANES], i: usize) -> Self {
        let (mut rows, mut count) = ([[[0.0; 4]; LANES]; 5], [0.0; LANES]);
        for (lane, manifold) in manifolds.iter().enumerate() {
            count[lane] = manifold.count as f32;
            for (k, row) in rows.iter_mut().enumerate() {
                row[lane] = four(&manifold.points[i], offset_of!(Point, arms) / 4 + 4 * k);
            }
        }
        let [a, b, c, d, e] = rows;
        let [ax, ay, az, bx] = like.quads_of(a);
        let [by, bz, wanted, mass] = like.quads_of(b);
        let [p, q, s, t] = like.quads_of(c);
        let [uu, uv, vv, driven] = like.quads_of(d);
        let [pressed, u, v, lift] = like.quads_of(e);
        Self {
            is_there: like.of(count).simd_gt(like.all(i as f32)),
            arms: [Vectors([ax, ay, az]), Vectors([bx, by, bz])],
            wanted: wanted + lift,
            mass,
            answer: [p, q],
            lag: [s, t],
            rub: [uu, uv, vv],
            little: max(max(wanted, like.all(0.0)), driven) * like.all(SETTLED),
            pressed,
            held: [u, v],
        }
    }
}

/// Eight times two bodies that touch, while impulses between them are sought.
struct Touch<F> {
    motions: [Motion<F>; 2],
    normal: Vectors<F>,
    along: [Vectors<F>; 2],
    friction: [F; 2],
    spots: [Spot<F>; POINTS],
    /// Where some change was large enough to go over their neighbours again.
    is_changed: F,
}

impl<F: Eight> Touch<F> {
    #[inline(always)]
    fn of(like: F, manifolds: &[&Manifold; LANES], bodies: &[[&Body; LANES]; 2]) -> Self {
        let mut rows = [[[0.0; 4]; LANES]; 3];
        for (lane, &manifold) in manifolds.iter().enumerate() {
            for (k, row) in rows.iter_mut().enumerate() {
                row[lane] = four(manifold, offset_of!(Manifold, axis) / 4 + 4 * k);
            }
        }
        let [a, b, c] = rows;
        let [x, y, z, ux] = like.quads_of(a);
        let [uy, uz, vx, vy] = like.quads_of(b);
        let [vz, sticks, slides, _] = like.quads_of(c);
        Self {
            motions: [Motion::of(like, &bodies[0]), Motion::of(like, &bodies[1])],
            normal: Vectors([x, y, z]),
            along: [Vectors([ux, uy, uz]), Vectors([vx, vy, vz])],
            friction: [sticks, slides],
            spots: [
                Spot::of(like, manifolds, 0),
                Spot::of(like, manifolds, 1),
                Spot::of(like, manifolds, 2),
                Spot::of(like, manifolds, 3),
            ],
            is_changed: like.all(0.0),
        }
    }

    /// How the second moves there as seen from the first \[m/s\].
    #[inline(always)]
    fn slip(&self, [one, other]: [Vectors<F>; 2]) -> Vectors<F> {
        let [a, b] = &self.motions;
        b.at(other) - a.at(one)
    }

    #[inline(always)]
    fn push(&mut self, [one, other]: [Vectors<F>; 2], impulse: Vectors<F>) {
        let [a, b] = &mut self.motions;
        a.push(one, -impulse);
        b.push(other, impulse);
    }

    /// Changes the impulses of all points that press, or should, by the same: what presses evenly, as a box that lies flat, is done with at
    /// once, whatever the order of points.
    #[inline(always)]
    fn press_evenly(&mut self) {
        let like = self.friction[0];
        let (zero, one) = (like.all(0.0), like.all(1.0));
        let (mut lack, mut least, mut number, mut little) = (zero, like.all(f32::INFINITY), zero, zero);
        let mut levers = [Vectors([zero; 3]); 2];
        let mut all = [zero; POINTS];
        for (spot, counts) in self.spots.iter().zip(&mut all) {
            let missing = spot.wanted - self.slip(spot.arms).dot(self.normal);
            *counts = spot.is_there & (missing.simd_gt(zero) | spot.pressed.simd_gt(zero));
            lack = lack + (missing & *counts);
            least = counts.select(min(least, spot.pressed), least);
            number = number + (one & *counts);
            little = little + (spot.little & *counts);
            levers[0] = levers[0] + spot.arms[0].masked(*counts);
            levers[1] = levers[1] + spot.arms[1].masked(*counts);
        }
        let share = one / number;
        let mean = [levers[0] * share, levers[1] * share];
        let [a, b] = &self.motions;
        let yielding = a.yielding(mean[0], self.normal) + b.yielding(mean[1], self.normal);
        let each = max(lack / (number * number * yielding), negated(least));
        let counts = number.simd_gt(one) & each.abs().simd_lt(like.all(f32::INFINITY)) & not_zero(each);
        for (spot, point) in self.spots.iter_mut().zip(all) {
            spot.pressed = spot.pressed + (each & counts & point);
        }
        self.push([mean[0].masked(counts), mean[1].masked(counts)], (self.normal * (each * number)).masked(counts));
        // The lack without its sign: what is not a number counts.
        let is_small = (lack * lack).simd_le(little * little);
        self.is_changed = self.is_changed | (counts & crate::lanes::not(is_small));
    }

    /// Brings the speed at which they part at a point to what is wanted, as far as pushing alone does it; then takes from their slip, and from
    /// what they lag behind the scenery and where they were held, what Coulomb's friction can.
    #[inline(always)]
    fn press(&mut self, i: usize) {
        let like = self.friction[0];
        let (zero, one) = (like.all(0.0), like.all(1.0));
        let Spot { is_there, arms, wanted, mass, answer, lag, rub, little, pressed, held } = self.spots[i];
        let slip = self.slip(arms);
        let new = max(pressed + (wanted - slip.dot(self.normal)) * mass, zero);
        let impulse = new - pressed;
        let u = slip.dot(self.along[0]) + answer[0] * impulse + lag[0];
        let v = slip.dot(self.along[1]) + answer[1] * impulse + lag[1];
        let (square, yields) = (u * u + v * v, rub[0] * (u * u) + rub[1] * (u * v) + rub[2] * (v * v));
        let rubs = (square / yields) & square.simd_gt(zero);
        let [x, y] = [held[0] - u * rubs, held[1] - v * rubs];
        let (square, sticks) = (x * x + y * y, self.friction[0] * new);
        let is_held = square.simd_le(sticks * sticks);
        let size = is_held.select(one, square.sqrt());
        let share = is_held.select(one, min(self.friction[1] * new, size) / size);
        let (x, y) = (x * share, y * share);
        let change = self.normal * impulse + self.along[0] * (x - held[0]) + self.along[1] * (y - held[1]);
        // What is no number is left out.
        let far = change.dot(change);
        let counts = is_there & far.simd_lt(like.all(f32::INFINITY)) & not_zero(far);
        let spot = &mut self.spots[i];
        spot.pressed = counts.select(new, pressed);
        spot.held = [counts.select(x, held[0]), counts.select(y, held[1])];
        self.push(arms, change.masked(counts));
        let little = little * mass;
        self.is_changed = self.is_changed | (counts & far.simd_gt(little * little));
    }
}

/// Where a number is not zero.
#[inline(always)]
fn not_zero<F: Eight>(x: F) -> F {
    x.abs().simd_gt(x.all(0.0))
}
