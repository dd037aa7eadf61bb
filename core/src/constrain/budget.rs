//! The energy of what nothing holds: a sub-step in which it is solved gives it none.

use super::turn::{Turn, keeping, nearest, outer, solve};
use crate::math::{dot, max, min, sqrt};
use glam::{Mat3, Vec3};

/// How often what it is deformed by in a sub-step is halved, before it is nothing.
const HALVINGS: u32 = 6;
/// Sums that go on side by side, so that rounding does not grow with the number of particles.
const SUMS: usize = 8;

/// Words that a budget is kept in.
pub(super) const WORDS: usize = 2;

/// What there is to spend: the energy of motion, beside that of the middle, and of strain, at the end of the last sub-step, and the most that it may
/// have been \[J\]. Nothing is known of it where both are zero.
///
/// Forces, contacts and other constraints give and take between two solutions, and the budget goes with that; a solution neither adds to it nor takes
/// from it. So what a method takes in one sub-step it may give back in another, and never more.
pub(super) struct Budget<'m>(pub(super) &'m mut [u32]);

impl Budget<'_> {
    /// The most that there may be at the sub-step's end, where there was so much before it was solved.
    pub(super) fn most(&self, begin: f32) -> f32 {
        match *self.0 {
            [last, most] if last | most != 0 => f32::from_bits(most) + (begin - f32::from_bits(last)),
            _ => begin,
        }
    }

    /// Keeps what there is now, and may be.
    pub(super) fn keep(&mut self, now: f32, most: f32) {
        // Which bits a NaN has depends on the machine, and these words are in the hash.
        let sound = now.is_finite() && most.is_finite();
        self.0.copy_from_slice(&if sound { [now.to_bits(), most.to_bits()] } else { [0; WORDS] });
    }

    /// Forgets it: something holds what it is of.
    pub(super) fn forget(&mut self) {
        self.0.fill(0);
    }
}

/// Particles that nothing holds, by their place in a list.
pub(super) struct Free<'m> {
    /// Inverse masses; zero for who is not there \[1/kg\].
    pub(super) weight: &'m [f32],
    /// Where they are, and how fast they go.
    pub(super) place: &'m mut [Vec3],
    pub(super) velocity: &'m mut [Vec3],
    /// A column to work with.
    pub(super) goal: &'m mut [Vec3],
}

/// How some particles move as a whole.
#[derive(Clone, Copy)]
struct Whole {
    middle: Vec3,
    drift: Vec3,
    omega: Vec3,
    /// Their angular momentum about the middle, and the sum of m r rᵀ.
    spin: Vec3,
    spread: Mat3,
    /// The energy of turning, and of all motion besides \[J\].
    turning: f32,
    rest: f32,
}

impl Whole {
    fn velocity(&self, place: Vec3) -> Vec3 {
        self.drift + self.omega.cross(place - self.middle)
    }

    /// The same where rounding has taken nothing of another's momenta.
    fn with_momenta_of(self, other: &Self) -> Self {
        Self { drift: other.drift, omega: solve(self.spread, other.spin), ..self }
    }
}

impl Free<'_> {
    /// Visits those who are there: place in the list, mass, where and how fast.
    fn each(&self, mut visit: impl FnMut(usize, f32, Vec3, Vec3)) {
        let all = self.weight.iter().zip(&*self.place).zip(&*self.velocity);
        for (number, ((&weight, &x), &v)) in all.enumerate() {
            if weight > 0.0 {
                visit(number, 1.0 / weight, x, v);
            }
        }
    }

    fn whole(&self) -> Whole {
        let mut first = None;
        let (mut mass, mut middle, mut drift) = (0.0, Vec3::ZERO, Vec3::ZERO);
        self.each(|_, m, x, v| {
            let (origin, slide) = *first.get_or_insert((x, v));
            mass += m;
            middle += (x - origin) * m;
            drift += (v - slide) * m;
        });
        let (origin, slide) = first.unwrap_or_default();
        let (middle, drift) = (origin + middle / mass, slide + drift / mass);
        let (mut spin, mut spread) = (Vec3::ZERO, Mat3::ZERO);
        self.each(|_, m, x, v| {
            let arm = x - middle;
            spin += arm.cross(v - drift) * m;
            spread += outer(arm * m, arm);
        });
        let mut whole = Whole { middle, drift, omega: solve(spread, spin), spin, spread, turning: 0.0, rest: 0.0 };
        let mut sums = [[0.0; SUMS]; 2];
        self.each(|number, m, x, v| {
            let turning = whole.omega.cross(x - middle);
            let rest = v - drift - turning;
            for (sums, part) in sums.iter_mut().zip([turning, rest]) {
                sums[number % SUMS] += 0.5 * m * dot(part, part);
            }
        });
        [whole.turning, whole.rest] = sums.map(|sums| sums.iter().sum());
        whole
    }

    /// The energy of their motion, beside that of their middle \[J\].
    pub(super) fn moving(&self) -> f32 {
        let whole = self.whole();
        whole.turning + whole.rest
    }

    /// Where they would be if they went through a sub-step as a rigid body, from where they were: by the rotation that keeps their angular momentum, as
    /// with [`ShapeMatching`](super::ShapeMatching).
    fn aim(&mut self, h: f32, whole: Whole, begin: impl Fn(usize) -> Vec3) {
        let (mut mass, mut rest, mut first) = (0.0, Vec3::ZERO, None);
        self.each(|number, m, _, _| {
            let origin = *first.get_or_insert(begin(number));
            mass += m;
            rest += (begin(number) - origin) * m;
        });
        let rest = first.unwrap_or_default() + rest / mass;
        let (mut from, mut to, mut torque) = (Mat3::ZERO, Mat3::ZERO, Vec3::ZERO);
        self.each(|number, m, x, v| {
            let (q, x) = ((begin(number) - rest) * m, x - whole.middle);
            let y = x - (v - whole.drift) * h;
            from += outer(y, q);
            to += outer(x, q);
            torque += y.cross(x) * m;
        });
        let turn = keeping(Turn::NONE, from, torque, None).unwrap_or_else(|| nearest(Turn::NONE, to, None)).matrix();
        for (number, goal) in self.goal.iter_mut().enumerate().filter(|&(number, _)| self.weight[number] > 0.0) {
            *goal = whole.middle + turn * (begin(number) - rest);
        }
    }

    /// Brings them so much nearer to where they would be as a rigid body.
    fn stiffen(&mut self, share: f32, h: f32) {
        for ((place, velocity), &goal) in self.place.iter_mut().zip(&mut *self.velocity).zip(&*self.goal) {
            let by = (goal - *place) * share;
            *place += by;
            *velocity += by * (1.0 / h);
        }
    }

    /// Takes out of how they deform, on their way through a sub-step of `h` \[s\] and in their velocities, what they have more than `most` \[J\] on that
    /// account: halves of it, until strain leaves some of `most` for motion, then as much of what is no motion of a rigid body as is too much. Both
    /// momenta stay, and as rigid bodies they have no more than they began with. `stored` tells the energy of strain where they are.
    pub(super) fn hold_back(
        &mut self,
        h: f32,
        most: f32,
        begin: impl Fn(usize) -> Vec3,
        mut stored: impl FnMut(&[Vec3]) -> f32,
    ) {
        let before = self.whole();
        self.aim(h, before, begin);
        let (mut whole, mut left) = (before, 0.0);
        for halvings in 0..=HALVINGS + 1 {
            if halvings > 0 {
                self.stiffen(if halvings <= HALVINGS { 0.5 } else { 1.0 }, h);
                whole = self.whole();
            }
            left = most - stored(self.place) - whole.turning;
            if left >= 0.0 {
                break;
            }
        }
        let share = sqrt(min(max(left, 0.0) / whole.rest, 1.0));
        let share = if share >= 0.0 { share } else { 1.0 };
        let kept = whole.with_momenta_of(&before);
        for (&place, velocity) in self.place.iter().zip(&mut *self.velocity) {
            *velocity = kept.velocity(place) + (*velocity - whole.velocity(place)) * share;
        }
    }
}
