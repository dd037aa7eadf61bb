//! The energy of what nothing holds: a sub-step in which it is solved gives it none.

use super::turn::{Turn, keeping_by, nearest, outer, solve_thin};
use crate::math::{dot, max, min, sqrt};
use glam::{Mat3, Vec3};

/// How often the way to where it would be as a rigid body is halved.
const HALVINGS: u32 = 6;
/// The least share of what is no motion of a rigid body that is left without that.
const LEAST: f32 = 0.5;
/// Sums that go on side by side, so that rounding does not grow with the number of particles.
const SUMS: usize = 8;

/// How many times what there is a budget is at the most.
const SLACK: f32 = 2.0;

/// Words that a budget is kept in.
pub(super) const WORDS: usize = 2;

/// What there is to spend: the energy of motion, beside that of the middle, and of strain, at the end of the last sub-step, and the most that it may
/// have been \[J\]. Nothing is known of it where both are zero.
///
/// Forces, contacts and other constraints give and take between two solutions, and the budget goes with that; a solution neither adds to it nor takes
/// from it. So what a method takes in one sub-step it may give back in another, and never more; of what it has taken long ago, as from a load that
/// solutions bear, as much as there is now.
pub(super) struct Budget<'m>(pub(super) &'m mut [u32]);

impl Budget<'_> {
    /// The most that there may be at the sub-step's end, where there was so much before it was solved.
    pub(super) fn most(&self, begin: f32) -> f32 {
        let kept = match *self.0 {
            [last, most, ..] if last | most != 0 => f32::from_bits(most) + (begin - f32::from_bits(last)),
            _ => begin,
        };
        min(kept, SLACK * begin)
    }

    /// Keeps what there is now, and may be.
    pub(super) fn keep(&mut self, now: f32, most: f32) {
        // Which bits a NaN has depends on the machine, and these words are in the hash.
        let sound = now.is_finite() && most.is_finite();
        let words = if sound { [now.to_bits(), most.to_bits()] } else { [0; WORDS] };
        self.0.iter_mut().zip(words).for_each(|(kept, word)| *kept = word);
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
    /// The energy of turning, of all motion besides, and what both have together: nothing but where all are near one line \[J\].
    turning: f32,
    rest: f32,
    both: f32,
}

impl Whole {
    fn velocity(&self, place: Vec3) -> Vec3 {
        self.drift + self.omega.cross(place - self.middle)
    }

    /// The energy of motion beside that of the middle, where so much is left of what is no motion of a rigid body \[J\].
    fn energy(&self, share: f32) -> f32 {
        self.turning + share * (self.both + share * self.rest)
    }

    /// How much of that may be left where there is so much energy for it, and turning: the larger root.
    fn share(&self, left: f32) -> f32 {
        let half = 0.5 * self.both;
        let share = (sqrt(max(half * half + self.rest * left, 0.0)) - half) / self.rest;
        if share >= 0.0 { min(share, 1.0) } else { 1.0 }
    }

    /// The same where rounding has taken nothing of another's momenta.
    fn with_momenta_of(self, other: &Self) -> Self {
        Self { drift: other.drift, omega: solve_thin(self.spread, other.spin), ..self }
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
        let mut whole =
            Whole { middle, drift, omega: solve_thin(spread, spin), spin, spread, turning: 0.0, rest: 0.0, both: 0.0 };
        let mut sums = [[0.0; SUMS]; 3];
        self.each(|number, m, x, v| {
            let turning = whole.omega.cross(x - middle);
            let rest = v - drift - turning;
            for (sums, [a, b]) in sums.iter_mut().zip([[turning; 2], [rest; 2], [turning * 2.0, rest]]) {
                sums[number % SUMS] += 0.5 * m * dot(a, b);
            }
        });
        [whole.turning, whole.rest, whole.both] = sums.map(|sums| sums.iter().sum());
        whole
    }

    /// The energy of their motion, beside that of their middle \[J\].
    pub(super) fn moving(&self) -> f32 {
        self.whole().energy(1.0)
    }

    /// Where they would be if they went through a sub-step as a rigid body, from where they were: by the rotation that keeps their angular momentum, as
    /// with [`ShapeMatching`](super::ShapeMatching).
    fn aim(&mut self, h: f32, whole: Whole, begin: impl Fn(usize) -> Vec3) -> Turn {
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
        let turn =
            keeping_by(solve_thin, Turn::NONE, (from, torque), None).unwrap_or_else(|| nearest(Turn::NONE, to, None));
        let rotation = turn.matrix();
        for (number, goal) in self.goal.iter_mut().enumerate().filter(|&(number, _)| self.weight[number] > 0.0) {
            *goal = whole.middle + rotation * (begin(number) - rest);
        }
        turn
    }

    /// Leaves such a share of their ways from where they would be as a rigid body.
    fn stiffen(&mut self, share: f32, h: f32) {
        for ((place, velocity), &goal) in self.place.iter_mut().zip(&mut *self.velocity).zip(&*self.goal) {
            let to = goal + (*place - goal) * share;
            *velocity += (to - *place) * (1.0 / h);
            *place = to;
        }
    }

    /// Takes out of how they deform what they have more than `most` \[J\] on that account: as much as is too much of what is no motion of a rigid body;
    /// where that would be most of it, of the ways as well on which they deform in a sub-step of `h` \[s\]. Both momenta stay, and as rigid bodies they
    /// have no more than they began with. `stored` tells the energy of strain where they are, and where they have been brought nearer to where a rigid
    /// body would be, how that has turned. That is told at the end as well.
    pub(super) fn hold_back(
        &mut self,
        h: f32,
        most: f32,
        begin: impl Fn(usize) -> Vec3,
        mut stored: impl FnMut(&[Vec3], Option<Turn>) -> f32,
    ) -> Option<Turn> {
        let before = self.whole();
        let (mut whole, mut left) = (before, most - stored(self.place, None) - before.turning);
        let mut turned = None;
        if !(left >= 0.0 && whole.share(left) >= LEAST) {
            turned = Some(self.aim(h, before, begin));
            let (mut now, mut least, mut far) = (1.0, 0.0, 1.0);
            for _ in 0..HALVINGS {
                let next = 0.5 * (least + far);
                self.stiffen(next / now, h);
                now = next;
                let fits = stored(self.place, turned) + self.whole().energy(1.0) <= most;
                *if fits { &mut least } else { &mut far } = now;
            }
            self.stiffen(least / now, h);
            whole = self.whole();
            left = most - stored(self.place, turned) - whole.turning;
        }
        let share = whole.share(max(left, 0.0));
        let kept = whole.with_momenta_of(&before);
        for (&place, velocity) in self.place.iter().zip(&mut *self.velocity) {
            *velocity = kept.velocity(place) + (*velocity - whole.velocity(place)) * share;
        }
        turned
    }
}
