//! Eight times two bodies that touch, while impulses between them are sought.

use super::manifold::POINTS;
use super::moving::{Moves, Moving};
use super::pack::{Pack, Spots};
use crate::lanes::{Eight, Vectors, load, mask_of, max, min, negated, not, saved};

/// The slip that friction leaves from which on a point is no longer held, as a multiple of the change of speed that is too small to go over their
/// neighbours for: what passes leave over is less and does not add up over sub-steps, as what slides does.
const SLIPS: f32 = 25.0;

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
    fn of(like: F, pack: &Pack, number: usize) -> Self {
        let Spots { arms, wanted, mass, answer, lag, rub, little, pressed, held } = &pack.spots[number];
        Self {
            is_there: pack.is_there(like, number),
            arms: [Vectors::load(like, &arms[0]), Vectors::load(like, &arms[1])],
            wanted: load(like, wanted),
            mass: load(like, mass),
            answer: [load(like, &answer[0]), load(like, &answer[1])],
            lag: [load(like, &lag[0]), load(like, &lag[1])],
            rub: [load(like, &rub[0]), load(like, &rub[1]), load(like, &rub[2])],
            little: load(like, little),
            pressed: load(like, pressed),
            held: [load(like, &held[0]), load(like, &held[1])],
        }
    }
}

/// Those of a pack, and how their bodies move.
pub(super) struct Touch<F> {
    /// How the bodies move; the first says nothing where that is the world for all.
    moves: [Moves<F>; 2],
    on_scenery: bool,
    /// Those that are gone over.
    due: F,
    normal: Vectors<F>,
    along: [Vectors<F>; 2],
    /// The coefficient of friction in force, and where it holds some point that presses, and does not.
    grip: F,
    holds: [F; 2],
    /// Where some change was large enough to go over their neighbours again.
    is_changed: F,
}

impl<F: Eight> Touch<F> {
    /// Takes the bodies of those of a pack that are due, as they move; none: there are no such bodies.
    #[inline(always)]
    pub(super) fn of(like: F, pack: &Pack, moving: &[Moving], due: u32, on_scenery: bool) -> Option<Self> {
        let second = Moves::of(like, moving, &pack.pushed[1])?;
        Some(Self {
            // Nobody asks how the scenery moves.
            moves: [if on_scenery { second } else { Moves::of(like, moving, &pack.pushed[0])? }, second],
            on_scenery,
            due: mask_of(like, due),
            normal: Vectors::load(like, &pack.normal),
            along: [Vectors::load(like, &pack.along[0]), Vectors::load(like, &pack.along[1])],
            grip: load(like, &pack.grip),
            holds: [like.all(0.0); 2],
            is_changed: like.all(0.0),
        })
    }

    /// Writes down what has been done to those of a pack that are due, at a tick of the clock.
    #[inline(always)]
    pub(super) fn end(mut self, pack: &mut Pack, moving: &mut [Moving], tick: f32) {
        self.grasp(pack);
        let (due, tick) = (self.due.to_bitmask(), self.due.all(tick));
        let [mut a, mut b] = self.moves;
        if !self.on_scenery {
            a.note(self.is_changed, tick);
            a.tell(moving, &pack.bodies[0], pack.gives[0] & due);
        }
        b.note(self.is_changed, tick);
        b.tell(moving, &pack.bodies[1], pack.gives[1] & due);
        pack.seen = saved(self.due.select(tick, load(tick, &pack.seen)));
    }

    /// Says by which friction those of a pack are held from now on. One point of several takes the slip of all, more than its share, until the
    /// others have had their turn: so they slide where none is held when all have been gone over before, and rest where one is.
    #[inline(always)]
    fn grasp(&mut self, pack: &mut Pack) {
        let [rests, slides] = [load(self.grip, &pack.friction[0]), load(self.grip, &pack.friction[1])];
        let [some, others] = self.holds;
        let again = not_zero(load(self.grip, &pack.seen)).select(slides, self.grip);
        let grip = (others & not(some)).select(again, rests);
        let is_other = self.due & not_zero(grip - self.grip);
        self.is_changed = self.is_changed | is_other;
        pack.grip = saved(is_other.select(grip, self.grip));
    }

    /// How the second moves there as seen from the first \[m/s\].
    #[inline(always)]
    fn slip(&self, [one, other]: [Vectors<F>; 2]) -> Vectors<F> {
        let [a, b] = &self.moves;
        if self.on_scenery { b.at(other) } else { b.at(other) - a.at(one) }
    }

    #[inline(always)]
    fn push(&mut self, pack: &Pack, [one, other]: [Vectors<F>; 2], impulse: Vectors<F>) {
        let [a, b] = &mut self.moves;
        if !self.on_scenery {
            a.push(&pack.inverse[0], one, -impulse);
        }
        b.push(&pack.inverse[1], other, impulse);
    }

    /// Changes the impulses of all points that press, or should, by the same: what presses evenly, as a box that lies flat, is done with at
    /// once, whatever the order of points.
    #[inline(always)]
    pub(super) fn press_evenly(&mut self, pack: &mut Pack) {
        let like = self.grip;
        let (zero, one) = (like.all(0.0), like.all(1.0));
        let (mut lack, mut least, mut number, mut little) = (zero, like.all(f32::INFINITY), zero, zero);
        let mut levers = [Vectors([zero; 3]); 2];
        let mut all = [zero; POINTS];
        for i in pack.numbers() {
            let spot = Spot::of(like, pack, i);
            let missing = spot.wanted - self.slip(spot.arms).dot(self.normal);
            let counts = spot.is_there & (missing.simd_gt(zero) | spot.pressed.simd_gt(zero));
            all[i] = counts;
            lack = lack + (missing & counts);
            least = counts.select(min(least, spot.pressed), least);
            number = number + (one & counts);
            little = little + (spot.little & counts);
            levers[0] = levers[0] + spot.arms[0].masked(counts);
            levers[1] = levers[1] + spot.arms[1].masked(counts);
        }
        let counts = number.simd_gt(one) & self.due;
        if !counts.any() {
            return;
        }
        let share = one / number;
        let mean = [levers[0] * share, levers[1] * share];
        let [a, b] = &self.moves;
        let other = b.yielding(&pack.inverse[1], mean[1], self.normal);
        let yielding = if self.on_scenery { other } else { a.yielding(&pack.inverse[0], mean[0], self.normal) + other };
        let each = max(lack / (number * number * yielding), negated(least));
        let counts = counts & each.abs().simd_lt(like.all(f32::INFINITY)) & not_zero(each);
        for i in pack.numbers() {
            let pressed = &mut pack.spots[i].pressed;
            *pressed = saved(load(like, pressed) + (each & counts & all[i]));
        }
        let impulse = (self.normal * (each * number)).masked(counts);
        self.push(pack, [mean[0].masked(counts), mean[1].masked(counts)], impulse);
        // The lack without its sign: what is not a number counts.
        let is_small = (lack * lack).simd_le(little * little);
        self.is_changed = self.is_changed | (counts & not(is_small));
    }

    /// Brings the speed at which they part at a point to what is wanted, as far as pushing alone does it; then takes from their slip, and from
    /// what they lag behind the scenery and where they were held, what Coulomb's friction can.
    #[inline(always)]
    pub(super) fn press(&mut self, pack: &mut Pack, i: usize) {
        let like = self.grip;
        let (zero, one) = (like.all(0.0), like.all(1.0));
        let Spot { is_there, arms, wanted, mass, answer, lag, rub, little, pressed, held } = Spot::of(like, pack, i);
        let slip = self.slip(arms);
        let new = max(pressed + (wanted - slip.dot(self.normal)) * mass, zero);
        let impulse = new - pressed;
        let u = slip.dot(self.along[0]) + answer[0] * impulse + lag[0];
        let v = slip.dot(self.along[1]) + answer[1] * impulse + lag[1];
        let (square, yields) = (u * u + v * v, rub[0] * (u * u) + rub[1] * (u * v) + rub[2] * (v * v));
        let rubs = (square / yields) & square.simd_gt(zero);
        let [x, y] = [held[0] - u * rubs, held[1] - v * rubs];
        let presses = new.simd_gt(zero);
        let (square, most) = (x * x + y * y, (self.grip * new) & presses);
        let size = square.sqrt();
        let share = size.simd_gt(most).select(most / size, one);
        let (x, y) = (x * share, y * share);
        let (presses, is_held) = (presses & is_there, not((size - most).simd_gt(little * rubs * like.all(SLIPS))));
        self.holds = [self.holds[0] | (presses & is_held), self.holds[1] | (presses & not(is_held))];
        let change = self.normal * impulse + self.along[0] * (x - held[0]) + self.along[1] * (y - held[1]);
        // What is no number is left out.
        let far = change.dot(change);
        let counts = is_there & self.due & far.simd_lt(like.all(f32::INFINITY)) & not_zero(far);
        let spots = &mut pack.spots[i];
        spots.pressed = saved(counts.select(new, pressed));
        spots.held = [saved(counts.select(x, held[0])), saved(counts.select(y, held[1]))];
        self.push(pack, arms, change.masked(counts));
        let little = little * mass;
        self.is_changed = self.is_changed | (counts & far.simd_gt(little * little));
    }
}

/// Where a number is not zero.
#[inline(always)]
fn not_zero<F: Eight>(x: F) -> F {
    x.abs().simd_gt(x.all(0.0))
}
