//! Rows that fall, each braked by its own drag: their accelerations, or a whole step of an Euler method in one pass.

use super::filled;
use crate::lanes::{Eight, Kernel, not};
use crate::math::{high, largest, low, max};
use glam::Vec3;

/// The steady pull that makes rows fall, each braked by its own drag.
#[derive(Clone, Copy)]
pub(crate) struct Fall<'a, const FALLS: bool, const DRAGS: bool> {
    pub(crate) g: Vec3,
    pub(crate) mass: &'a [f32],
    pub(crate) drag: &'a [f32],
    pub(crate) inverse_mass: &'a [f32],
    /// The numbers that these consist of, if that is known.
    pub(crate) common: Option<[f32; 3]>,
}

/// Finds their accelerations.
pub(crate) struct Accelerate<'a, const FALLS: bool, const DRAGS: bool> {
    pub(crate) fall: Fall<'a, FALLS, DRAGS>,
    pub(crate) velocity: &'a [Vec3],
    pub(crate) acceleration: &'a mut [Vec3],
}

/// How far rows have got in a leap, if all of them are finite: no coordinate of any place is beyond `place` \[m\] at its end, none of a
/// velocity beyond `speed` \[m/s\] at its beginning or its end, and each velocity has changed by something between the two vectors of
/// `change` \[m/s\]. Hits change velocities later.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Extents {
    pub(crate) place: f32,
    pub(crate) speed: f32,
    pub(crate) change: [Vec3; 2],
}

/// Moves their places and velocities by a step of `h` \[s\] of an Euler method: the symplectic one goes by the new velocity. Says how
/// far they get, if all of them are finite for sure.
pub(crate) struct Leap<'a, const FALLS: bool, const DRAGS: bool, const SYMPLECTIC: bool> {
    pub(crate) fall: Fall<'a, FALLS, DRAGS>,
    pub(crate) ends: [&'a mut [Vec3]; 2],
    /// Columns to keep in where they were and how fast, of all of them or of none.
    pub(crate) start: [&'a mut [Vec3]; 2],
    pub(crate) h: f32,
}

impl<const FALLS: bool, const DRAGS: bool> Kernel for Accelerate<'_, FALLS, DRAGS> {
    type Output = ();

    #[inline(always)]
    fn run<F: Eight>(self, like: F) {
        let Self { fall, velocity, acceleration } = self;
        let (g, (factors, factors_rest)) = (fall.numbers(like), fall.eights());
        let ((out, out_rest), (v, v_rest)) = (acceleration.as_chunks_mut(), velocity.as_chunks());
        for ((out, v), factors) in out.iter_mut().zip(v).zip(factors) {
            *out = stored(Fall::<FALLS, DRAGS>::of(g, loaded(like, v), factors));
        }
        if !out_rest.is_empty() {
            let last: [Vec3; 8] =
                stored(Fall::<FALLS, DRAGS>::of(g, loaded(like, &filled(v_rest)), factors_rest.each_ref()));
            out_rest.copy_from_slice(&last[..out_rest.len()]);
        }
    }
}

/// The largest numbers of eight rows after the other: of places at a leap's end, of velocities at its beginning, and of how much these
/// change; and sums that tell what is not finite. They are few enough to stay in registers.
struct Seen<F> {
    place: F,
    speed: F,
    change: F,
    sum: F,
}

impl Extents {
    /// How far these rows have got and others.
    pub(crate) fn and(self, others: Self) -> Self {
        let [least, most] = self.change;
        Self {
            place: max(self.place, others.place),
            speed: max(self.speed, others.speed),
            change: [low(least, others.change[0]), high(most, others.change[1])],
        }
    }

    /// The same with a row somewhere else, if that is finite.
    pub(crate) fn with(self, position: Vec3, velocity: Vec3) -> Option<Self> {
        let is_finite = position.is_finite() && velocity.is_finite();
        is_finite.then(|| Self { place: max(self.place, largest(position)), ..self })
    }
}

impl<F: Eight> Seen<F> {
    #[inline(always)]
    fn none(zero: F) -> Self {
        Self { place: zero, speed: zero, change: zero, sum: zero }
    }

    /// Sees eight rows at both ends of a leap. What is not finite in velocities is not in places that are gone to by them.
    #[inline(always)]
    fn see(&mut self, before: [F; 3], [to, after]: [[F; 3]; 2], is_symplectic: bool) {
        let sum = |[a, b, c]: [F; 3]| a + b + c;
        self.place = most(to).most(self.place);
        self.speed = most(before).most(self.speed);
        self.sum = self.sum + if is_symplectic { sum(to) } else { sum(to) + sum(after) };
    }

    /// Tells how far all of them have got, whose velocities have changed by no more than `beside` from `change`.
    #[inline(always)]
    fn extents(&self, change: Vec3, beside: f32) -> Option<Extents> {
        let nought = self.sum.to_array().into_iter().fold(0.0, |nought, x| nought + x * 0.0);
        let most = largest(change) + beside;
        // The room is for rounding.
        let beside = beside + 16.0 * f32::EPSILON * most + f32::MIN_POSITIVE;
        let speed = (self.speed.largest_lane() + most) * (1.0 + 32.0 * f32::EPSILON) + f32::MIN_POSITIVE;
        let change = [change - beside, change + beside];
        (nought == 0.0).then(|| Extents { place: self.place.largest_lane(), speed, change })
    }
}

/// The largest of three times eight numbers, whatever their signs.
#[inline(always)]
fn most<F: Eight>([a, b, c]: [F; 3]) -> F {
    a.abs().most(b.abs()).most(c.abs())
}

impl<const FALLS: bool, const DRAGS: bool, const SYMPLECTIC: bool> Kernel for Leap<'_, FALLS, DRAGS, SYMPLECTIC> {
    type Output = Option<Extents>;

    #[inline(always)]
    fn run<F: Eight>(self, like: F) -> Self::Output {
        let (g, h, numbers) = (self.fall.g, self.h, self.fall.numbers(like));
        let Some(factors) = self.fall.of_all() else {
            let seen = self.go::<F, false>(
                like,
                #[inline(always)]
                |v, factors| Fall::<FALLS, DRAGS>::of(numbers, v, factors),
            );
            return seen.extents(Vec3::ZERO, seen.change.largest_lane());
        };
        let [m, k, inverse] = [like.all(factors[0]), like.all(factors[1]), like.all(factors[2])];
        let pull = Fall::<FALLS, DRAGS>::pull(numbers, [m; 3]);
        let seen = self.go::<F, true>(
            like,
            #[inline(always)]
            |v, _| Fall::<FALLS, DRAGS>::rate(pull, v, [k; 3], [inverse; 3]),
        );
        // The fastest of all is braked the most.
        let brakes = if DRAGS { factors[1].abs() * seen.speed.largest_lane() } else { 0.0 };
        let steady = if FALLS { g * factors[0] } else { Vec3::ZERO };
        seen.extents(steady * (factors[2] * h), brakes * (factors[2] * h).abs())
    }
}

impl<const FALLS: bool, const DRAGS: bool, const SYMPLECTIC: bool> Leap<'_, FALLS, DRAGS, SYMPLECTIC> {
    /// The whole of it, where velocities of eight rows with such factors change at a `rate`. How much they do is only looked at if that is
    /// not `ALIKE` for all.
    #[inline(always)]
    fn go<F: Eight, const ALIKE: bool>(self, like: F, rate: impl Fn([F; 3], Factors<'_>) -> [F; 3]) -> Seen<F> {
        let Self { fall, ends: [position, velocity], start: [start_x, start_v], h } = self;
        let ((factors, factors_rest), h) = (fall.eights(), like.all(h));
        let ((x, x_rest), (v, v_rest)) = (position.as_chunks_mut(), velocity.as_chunks_mut());
        let ((x0, x0_rest), (v0, v0_rest)) = (start_x.as_chunks_mut(), start_v.as_chunks_mut());
        let (mut seen, eights) = (Seen::none(like.all(0.0)), x.iter_mut().zip(v).zip(factors));
        if x0.is_empty() {
            for ((x, v), factors) in eights {
                Self::eight::<F, ALIKE>(&rate, [x, v], None, factors, h, &mut seen);
            }
        } else {
            for (((x, v), factors), start) in eights.zip(x0.iter_mut().zip(v0)) {
                Self::eight::<F, ALIKE>(&rate, [x, v], Some(start), factors, h, &mut seen);
            }
        }
        if !x_rest.is_empty() {
            x0_rest.iter_mut().zip(&*x_rest).for_each(|(x0, x)| *x0 = *x);
            v0_rest.iter_mut().zip(&*v_rest).for_each(|(v0, v)| *v0 = *v);
            let [mut x, mut v] = [filled(x_rest), filled(v_rest)];
            Self::eight::<F, ALIKE>(&rate, [&mut x, &mut v], None, factors_rest.each_ref(), h, &mut seen);
            x_rest.copy_from_slice(&x[..x_rest.len()]);
            v_rest.copy_from_slice(&v[..v_rest.len()]);
        }
        seen
    }

    #[inline(always)]
    fn eight<F: Eight, const ALIKE: bool>(
        rate: &impl Fn([F; 3], Factors<'_>) -> [F; 3],
        [x, v]: [&mut [Vec3; 8]; 2],
        start: Option<(&mut [Vec3; 8], &mut [Vec3; 8])>,
        factors: Factors<'_>,
        h: F,
        seen: &mut Seen<F>,
    ) {
        let [from, before] = [loaded(h, x), loaded(h, v)];
        if let Some((x0, v0)) = start {
            [*x0, *v0] = [stored(from), stored(before)];
        }
        let rate = rate(before, factors);
        let (mut to, mut after) = (from, before);
        let change = [rate[0] * h, rate[1] * h, rate[2] * h];
        if !ALIKE {
            seen.change = most(change).most(seen.change);
        }
        for i in 0..3 {
            after[i] = before[i] + change[i];
            to[i] = from[i] + if SYMPLECTIC { after[i] } else { before[i] } * h;
        }
        seen.see(before, [to, after], SYMPLECTIC);
        [*x, *v] = [stored(to), stored(after)];
    }
}

/// Eight factors of each kind.
type Factors<'a> = [&'a [f32; 8]; 3];

impl<'a, const FALLS: bool, const DRAGS: bool> Fall<'a, FALLS, DRAGS> {
    /// The steady acceleration, number by number, as those of rows follow one another.
    #[inline(always)]
    fn numbers<F: Eight>(&self, like: F) -> [F; 3] {
        loaded(like, &[self.g; 8])
    }

    /// The factors of eight rows after the other, and of what rows are left.
    #[inline(always)]
    fn eights(&self) -> (impl Iterator<Item = Factors<'a>> + use<'a, FALLS, DRAGS>, [[f32; 8]; 3]) {
        let [(m, m_rest), (k, k_rest), (inverse, inverse_rest)] =
            [self.mass.as_chunks(), self.drag.as_chunks(), self.inverse_mass.as_chunks()];
        let eights = m.iter().zip(k).zip(inverse).map(
            #[inline(always)]
            |((m, k), inverse)| [m, k, inverse],
        );
        (eights, [filled(m_rest), filled(k_rest), filled(inverse_rest)])
    }

    /// The factors, if they are the same for all rows and nobody is fixed, as where one emitter feeds a fountain.
    #[inline(always)]
    fn of_all(&self) -> Option<[f32; 3]> {
        let factors = match self.common {
            Some(factors) => factors,
            None => [same(self.mass)?, same(self.drag)?, same(self.inverse_mass)?],
        };
        (factors[2] != 0.0).then_some(factors)
    }

    /// The sum of forces over the mass, for eight rows: number by number, as they follow one another. What is fixed stays so under a
    /// force beyond an f32.
    #[inline(always)]
    fn of<F: Eight>(g: [F; 3], v: [F; 3], factors: Factors<'_>) -> [F; 3] {
        let (like, zero) = (g[0], g[0].all(0.0));
        let [m, k, inverse] =
            [like.of(*factors[0]).thrice(), like.of(*factors[1]).thrice(), like.of(*factors[2]).thrice()];
        let mut rate = Self::rate(Self::pull(g, m), v, k, inverse);
        for i in 0..3 {
            rate[i] = rate[i] & not(inverse[i].simd_eq(zero));
        }
        rate
    }

    /// The steady part of the forces, and the sum of both parts over the mass.
    #[inline(always)]
    fn pull<F: Eight>(g: [F; 3], m: [F; 3]) -> [F; 3] {
        let zero = g[0].all(0.0);
        if FALLS { [zero + g[0] * m[0], zero + g[1] * m[1], zero + g[2] * m[2]] } else { [zero; 3] }
    }

    #[inline(always)]
    fn rate<F: Eight>(pull: [F; 3], v: [F; 3], k: [F; 3], inverse: [F; 3]) -> [F; 3] {
        let mut rate = pull;
        for i in 0..3 {
            let force = if DRAGS { pull[i] - v[i] * k[i] } else { pull[i] };
            rate[i] = force * inverse[i];
        }
        rate
    }
}

/// The number that a column consists of, if it is one.
#[inline(always)]
fn same(column: &[f32]) -> Option<f32> {
    let first = *column.first()?;
    let (chunks, rest) = column.as_chunks::<64>();
    for chunk in chunks {
        let mut differ = 0;
        for x in chunk {
            differ |= x.to_bits() ^ first.to_bits();
        }
        if differ != 0 {
            return None;
        }
    }
    let mut differ = 0;
    for x in rest {
        differ |= x.to_bits() ^ first.to_bits();
    }
    (differ == 0).then_some(first)
}

/// Eight vectors, number by number, in registers.
#[inline(always)]
fn loaded<F: Eight>(like: F, vectors: &[Vec3; 8]) -> [F; 3] {
    let [a, b, c]: [[f32; 8]; 3] = bytemuck::cast(*vectors);
    [like.of(a), like.of(b), like.of(c)]
}

/// The same back.
#[inline(always)]
fn stored<F: Eight>([a, b, c]: [F; 3]) -> [Vec3; 8] {
    bytemuck::cast([a.to_array(), b.to_array(), c.to_array()])
}
