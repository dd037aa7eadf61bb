//! Bodies go through a sub-step, and turn so that their angular momenta stay: eight side by side.

use super::super::turn::{EVEN, ROUNDING, ROUNDS, THIN};
use super::body::Body;
use super::fours::{fours, put};
use crate::lanes::{ABREAST, Eight, Kernel, LANES, Vectors, mask_of, negated, not, run};
use bytemuck::Zeroable;
use core::mem::offset_of;
use glam::Vec3;

/// Lets all go through a sub-step of `h` \[s\].
pub(super) fn go(bodies: &mut [Body], h: f32) {
    if ABREAST == 1 {
        bodies.iter_mut().for_each(|body| body.go(h));
    } else {
        run(Fly { bodies, h });
    }
}

struct Fly<'a> {
    bodies: &'a mut [Body],
    h: f32,
}

impl Kernel for Fly<'_> {
    type Output = ();
    #[inline(always)]
    fn run<F: Eight>(self, like: F) {
        let Self { bodies, h } = self;
        let (nobody, mut numbers, mut count) = (Body::zeroed(), [0; LANES], 0);
        for number in 0..=bodies.len() {
            if let Some(body) = bodies.get_mut(number).filter(|body| body.goes()) {
                body.advance(h);
                if body.spin * h == Vec3::ZERO {
                    body.face();
                } else {
                    (numbers[count % LANES], count) = (number, count + 1);
                }
            }
            if count == LANES || number == bodies.len() && count > 0 {
                turn(like, bodies, &numbers[..count], &nobody, h);
                count = 0;
            }
        }
    }
}

/// The words of a body that are read and written in fours.
const TURN: usize = offset_of!(Body, turn) / 4;
const SPIN: usize = offset_of!(Body, spin) / 4;
const OMEGA: usize = offset_of!(Body, omega) / 4;
const ROTATION: usize = offset_of!(Body, rotation) / 4;

/// Turns those with some numbers, as [`Body::go`] does with one.
#[inline(always)]
fn turn<F: Eight>(like: F, bodies: &mut [Body], numbers: &[usize], nobody: &Body, h: f32) {
    let mut all = [nobody; LANES];
    for (place, &number) in all.iter_mut().zip(numbers) {
        *place = bodies.get(number).unwrap_or(nobody);
    }
    let last = Turns(fours(like, &all, TURN));
    let [xx, xy, xz, yx] = fours(like, &all, TURN + 4);
    let [yy, yz, zx, zy] = fours(like, &all, TURN + 8);
    let [zz, a, b, c] = fours(like, &all, TURN + 12);
    let [d, e, f, g] = fours(like, &all, TURN + 16);
    let [p, q, _, _] = fours(like, &all, TURN + 20);
    let spread = Matrices([Vectors([xx, xy, xz]), Vectors([yx, yy, yz]), Vectors([zx, zy, zz])]);
    let inertia = Matrices([Vectors([a, b, c]), Vectors([d, e, f]), Vectors([g, p, q])]);
    let [i, j, k, x] = fours(like, &all, SPIN);
    let [y, z, _, _] = fours(like, &all, SPIN + 4);
    let (spin, omega, h) = (Vectors([i, j, k]), Vectors([x, y, z]), like.all(h));
    let [r, s, t, u] = fours(like, &all, ROTATION);
    let [v, w, l, m] = fours(like, &all, ROTATION + 4);
    let [n, b0, b1, b2] = fours(like, &all, ROTATION + 8);
    let rotation = Matrices([Vectors([r, s, t]), Vectors([u, v, w]), Vectors([l, m, n])]);
    let there = mask_of(like, (1 << numbers.len()) - 1);
    let (turn, found) = keeping(last, rotation.times(spread), spin * h, there);
    // As `Body::about_momentum`.
    let turn = turn.where_(found, last.on(spin * (spin.dot(omega) / spin.dot(spin)) * h));
    let rotation = turn.matrices();
    let inverse = rotation.times(inertia).times(rotation.transposed());
    let Vectors([x, y, z]) = inverse.of(spin) + Vectors([like.all(0.0); 3]);
    let [Vectors([a, b, c]), Vectors([d, e, f]), Vectors([g, p, q])] = inverse.0;
    let [Vectors([r, s, t]), Vectors([u, v, w]), Vectors([l, m, n])] = rotation.0;
    let rows = [
        (TURN, F::rows_of(turn.0)),
        (OMEGA, F::rows_of([x, y, z, a])),
        (OMEGA + 4, F::rows_of([b, c, d, e])),
        (OMEGA + 8, F::rows_of([f, g, p, q])),
        (ROTATION, F::rows_of([r, s, t, u])),
        (ROTATION + 4, F::rows_of([v, w, l, m])),
        (ROTATION + 8, F::rows_of([n, b0, b1, b2])),
    ];
    for (lane, &number) in numbers.iter().enumerate() {
        let Some(body) = bodies.get_mut(number) else { continue };
        for (first, rows) in &rows {
            put(body, *first, rows[lane]);
        }
    }
}

/// Eight matrices, by their columns. Products are taken in glam's order.
#[derive(Clone, Copy)]
struct Matrices<F>([Vectors<F>; 3]);

impl<F: Eight> Matrices<F> {
    #[inline(always)]
    fn of(self, Vectors([x, y, z]): Vectors<F>) -> Vectors<F> {
        let [a, b, c] = self.0;
        a * x + b * y + c * z
    }

    #[inline(always)]
    fn times(self, Self([x, y, z]): Self) -> Self {
        Self([self.of(x), self.of(y), self.of(z)])
    }

    #[inline(always)]
    fn transposed(self) -> Self {
        let [Vectors([a, b, c]), Vectors([d, e, f]), Vectors([g, h, i])] = self.0;
        Self([Vectors([a, d, g]), Vectors([b, e, h]), Vectors([c, f, i])])
    }
}

/// Eight rotations: unit quaternions x, y, z, w, as [`Turn`](super::super::turn::Turn).
#[derive(Clone, Copy)]
struct Turns<F>([F; 4]);

impl<F: Eight> Turns<F> {
    /// Those where a mask holds, others elsewhere.
    #[inline(always)]
    fn where_(self, mask: F, Self([p, q, r, s]): Self) -> Self {
        let [x, y, z, w] = self.0;
        Self([mask.select(x, p), mask.select(y, q), mask.select(z, r), mask.select(w, s)])
    }

    /// As [`Turn::on`](super::super::turn::Turn::on).
    #[inline(always)]
    fn on(self, angle: Vectors<F>) -> Self {
        let [x, y, z, w] = self.0;
        let (v, half) = (Vectors([x, y, z]), angle * w.all(0.5));
        let turned = half * w + v + half.cross(v);
        let real = w - half.dot(v);
        let norm = w.all(1.0) / (turned.dot(turned) + real * real).sqrt();
        let Vectors([x, y, z]) = turned * norm;
        let is_one = norm.simd_gt(w.all(0.0)) & norm.simd_lt(w.all(f32::INFINITY));
        Self([x, y, z, real * norm]).where_(is_one, self)
    }

    #[inline(always)]
    fn matrices(self) -> Matrices<F> {
        let [x, y, z, w] = self.0;
        let (one, two) = (x.all(1.0), x.all(2.0));
        Matrices([
            Vectors([one - two * (y * y + z * z), two * (x * y + w * z), two * (x * z - w * y)]),
            Vectors([two * (x * y - w * z), one - two * (x * x + z * z), two * (y * z + w * x)]),
            Vectors([two * (x * z + w * y), two * (y * z - w * x), one - two * (x * x + y * y)]),
        ])
    }
}

/// As [`keeping`](super::super::turn::keeping) about no axis of those that are there, and where it gets there.
#[inline(always)]
fn keeping<F: Eight>(last: Turns<F>, from: Matrices<F>, torque: Vectors<F>, there: F) -> (Turns<F>, F) {
    let zero = there.all(0.0);
    let (mut turn, mut before, mut goes_on, mut found) = (last, there.all(f32::INFINITY), there, zero);
    for _ in 0..ROUNDS[0] {
        let sum = from.times(turn.matrices().transposed());
        let [Vectors([xx, xy, xz]), Vectors([yx, yy, yz]), Vectors([zx, zy, zz])] = sum.0;
        goes_on = goes_on & (xx + yy + zz).simd_ge(zero);
        let has = Vectors([zy - yz, xz - zx, yx - xy]);
        let angle = solve(sum.transposed(), torque - has);
        let size = angle.dot(angle);
        let nearer = size.simd_lt(before) & size.simd_lt(there.all(4.0));
        // Rounding goes to and fro.
        let is_even = before.simd_lt(there.all(EVEN));
        found = found | goes_on & not(nearer) & is_even;
        goes_on = goes_on & nearer;
        turn = turn.on(angle).where_(goes_on, turn);
        before = goes_on.select(size, before);
        let is_there = goes_on & size.simd_lt(there.all(ROUNDING * ROUNDING));
        found = found | is_there;
        goes_on = goes_on & not(is_there);
        if !goes_on.any() {
            break;
        }
    }
    (turn, found | goes_on & before.simd_lt(there.all(EVEN)))
}

/// How far each round of that turns, by Cramer's rule.
#[inline(always)]
fn solve<F: Eight>(b: Matrices<F>, change: Vectors<F>) -> Vectors<F> {
    let [Vectors([xx, xy, xz]), Vectors([yx, yy, yz]), Vectors([zx, zy, zz])] = b.0;
    let (trace, zero, thin, infinite) = (xx + yy + zz, xx.all(0.0), xx.all(THIN), xx.all(f32::INFINITY));
    let has_one = trace.simd_gt(zero) & trace.simd_lt(infinite);
    let change = change / trace;
    let x = Vectors([yy + zz, negated(xy), negated(xz)]) / trace;
    let y = Vectors([negated(yx), xx + zz, negated(yz)]) / trace;
    let z = Vectors([negated(zx), negated(zy), xx + yy]) / trace;
    let is_plain = x.dot(y.cross(z)).simd_gt(thin);
    let x = Vectors::select(is_plain, x, x + Vectors([thin, zero, zero]));
    let y = Vectors::select(is_plain, y, y + Vectors([zero, thin, zero]));
    let z = Vectors::select(is_plain, z, z + Vectors([zero, zero, thin]));
    let determinant = x.dot(y.cross(z));
    let answer = Vectors([change.dot(y.cross(z)), change.dot(z.cross(x)), change.dot(x.cross(y))]) / determinant;
    let [p, q, r] = answer.0;
    let is_finite = p.abs().simd_lt(infinite) & q.abs().simd_lt(infinite) & r.abs().simd_lt(infinite);
    answer.masked(has_one & is_finite)
}

#[cfg(test)]
mod tests {
    use super::super::body::MOVING;
    use super::*;
    use crate::rng::Stream;
    use glam::Mat3;

    /// A body of some sides that flies and turns somehow.
    fn thrown(serial: u32) -> Body {
        let stream = Stream::new(7, 0, serial);
        let vector = |place: u32| {
            let ([x, y], [z, _]) = (stream.units(place), stream.units(place + 1));
            Vec3::new(x, y, z) - 0.5
        };
        // From cubes to needles and sheets; some at rest, and some that turn too fast for any rotation to keep what they have.
        let thin = [1.0, 0.1, 1e-3, 1e-6][serial as usize % 4];
        let sides = Vec3::new(1.0, thin, [1.0, thin][serial as usize / 4 % 2]) * (vector(0).abs() + 0.1);
        let by = [0.0, 1e-20, 1.0, 50.0, 1e4][serial as usize % 5];
        let squares = sides * sides;
        let inverse = Vec3::ONE / (Vec3::splat(squares.x + squares.y + squares.z) - squares);
        Body {
            state: MOVING,
            velocity: vector(2),
            omega: vector(4) * by,
            spin: vector(6) * by * sum(squares),
            spread: Mat3::from_diagonal(squares),
            inverse_inertia: Mat3::from_diagonal(inverse),
            turn: crate::constrain::turn::Turn::NONE.on(vector(8) * 4.0).0,
            ..Body::zeroed()
        }
    }

    fn sum(squares: Vec3) -> f32 {
        squares.x + squares.y + squares.z
    }

    /// Chips take them one by one: the words are the same.
    #[test]
    fn eight_at_once_go_as_each_by_itself() {
        let mut bodies: [Body; 203] = core::array::from_fn(|serial| thrown(serial as u32));
        let mut singly = bodies;
        for step in 0..20 {
            let h = [1.0 / 60.0, 1e-3][step % 2];
            go(&mut bodies, h);
            singly.iter_mut().for_each(|body| body.go(h));
            for (number, pair) in bodies.iter().zip(&singly).enumerate() {
                assert_eq!(bytemuck::bytes_of(pair.0), bytemuck::bytes_of(pair.1), "body {number} after step {step}");
            }
        }
    }
}
