//! How eight times two that touch stand to each other: before impulses are sought, and when all have gone.

use super::body::Body;
use super::manifold::{Manifold, Manifolds};
use super::moving::{Moves, Moving};
use super::order::{Order, is_in_turn, is_scenery};
use super::pack::{Kept, Pack, Places, surfaces};
use super::pose::{Motion, Pose};
use super::span::{FAR, Span};
use crate::collide::RESTING;
use crate::lanes::{Eight, Kernel, Vectors, load, mask_of, max, min, negated, not, saved};
use bytemuck::Zeroable;

/// A change of the speed at which two part is too small to go over their neighbours again for: it as a share of what the forces change their speeds
/// by in a sub-step, or of the speed that they shall part with.
const SETTLED: f32 = 1e-2;
/// The share of the last sub-step's impulses that the next one begins with: all of them would let towers swing.
const AGAIN: f32 = 0.9;
/// The share of an overlap that is taken back in a sub-step.
const RECOVERY: f32 = 0.1;
/// The share of the friction there can be below which a point counts as held.
const HOLDS: f32 = 0.99;

/// Looks how all stand to each other when forces have changed their velocities, and what impulses do to them, and says how fast they shall part.
pub(super) struct Begin<'a, 'b, 'c> {
    pub(super) bodies: &'a [Body],
    pub(super) manifolds: &'a Manifolds<'c>,
    pub(super) order: &'a mut Order<'b>,
    pub(super) span: Span,
}

impl Kernel for Begin<'_, '_, '_> {
    type Output = ();
    #[inline(always)]
    fn run<F: Eight>(self, like: F) {
        let (nobody, nothing) = (Body::zeroed(), Manifold::zeroed());
        for colour in self.order.colours() {
            let range = self.order.range(colour);
            for pack in self.order.packs.get_mut(range).unwrap_or_default() {
                let all = pack.all(self.manifolds, &nothing);
                let pair = Pair::of(like, pack, (self.bodies, &nobody), is_scenery(colour));
                pair.begin(pack, &all, self.span);
            }
        }
    }
}

/// Gives all again most of what held them in the last sub-step.
pub(super) struct HoldOn<'a, 'b> {
    pub(super) order: &'a mut Order<'b>,
}

impl Kernel for HoldOn<'_, '_> {
    type Output = ();
    #[inline(always)]
    fn run<F: Eight>(self, like: F) {
        for colour in self.order.colours() {
            let range = self.order.range(colour);
            let Order { packs, moving, .. } = &mut *self.order;
            for pack in packs.get_mut(range).unwrap_or_default() {
                // Those that may share a body are called up one by one.
                let turns = if is_in_turn(colour) { pack.len() } else { 1 };
                for turn in 0..turns {
                    let called = if turns > 1 { 1 << turn } else { u32::MAX };
                    hold_on(like, moving, (pack, called, is_scenery(colour)));
                }
            }
        }
    }
}

/// Looks how all stand to each other when they have gone, and says how fast they shall part in the end; tells whether any bounces.
pub(super) struct Stand<'a, 'b> {
    pub(super) bodies: &'a mut [Body],
    pub(super) order: &'a mut Order<'b>,
    pub(super) span: Span,
}

impl Kernel for Stand<'_, '_> {
    type Output = bool;
    #[inline(always)]
    fn run<F: Eight>(self, like: F) -> bool {
        let (nobody, mut bounces) = (Body::zeroed(), false);
        for colour in self.order.colours() {
            let range = self.order.range(colour);
            for pack in self.order.packs.get_mut(range).unwrap_or_default() {
                let pair = Pair::of(like, pack, (self.bodies, &nobody), is_scenery(colour));
                let which = pair.stand_anew(pack, self.span);
                bounces |= which != 0;
                for lane in (0..pack.len()).filter(|lane| which >> lane & 1 != 0) {
                    for numbers in &pack.bodies {
                        if let Some(body) = self.bodies.get_mut(numbers[lane] as usize) {
                            body.bounces = u32::from(body.moves());
                        }
                    }
                }
            }
        }
        bounces
    }
}

/// Notes what all have done, for the next sub-step.
pub(super) struct Tell<'a, 'b, 'c> {
    pub(super) manifolds: &'a mut Manifolds<'c>,
    pub(super) order: &'a Order<'b>,
}

impl Kernel for Tell<'_, '_, '_> {
    type Output = ();
    #[inline(always)]
    fn run<F: Eight>(self, like: F) {
        for pack in self.order.packs.iter() {
            pack.tell(like, self.manifolds);
        }
    }
}

/// Gives those of a pack that are called up what held them.
#[inline(always)]
fn hold_on<F: Eight>(like: F, moving: &mut [Moving], (pack, called, on_scenery): (&Pack, u32, bool)) {
    let Some(mut one) = Moves::of(like, moving, &pack.pushed[0]) else { return };
    let Some(mut other) = Moves::of(like, moving, &pack.pushed[1]) else { return };
    let normal = Vectors::load(like, &pack.normal);
    for i in pack.numbers() {
        let (spots, is_there) = (&pack.spots[i], pack.is_there(like, i));
        let held = Vectors::load(like, &pack.places[i].aside);
        let impulse = (normal * load(like, &spots.pressed) + held).masked(is_there);
        if !on_scenery {
            one.push(&pack.inverse[0], Vectors::load(like, &spots.arms[0]), -impulse);
        }
        other.push(&pack.inverse[1], Vectors::load(like, &spots.arms[1]), impulse);
    }
    if !on_scenery {
        one.tell(moving, &pack.bodies[0], pack.gives[0] & called);
    }
    other.tell(moving, &pack.bodies[1], pack.gives[1] & called);
}

/// Eight times two bodies.
struct Pair<F> {
    poses: [Pose<F>; 2],
    /// Where the first, and the second, is pushed.
    gives: [F; 2],
    /// The first is the world.
    on_scenery: bool,
    /// How far on the way from the place on the first to that on the second they press on each other, as a share: he whom it moves more knows better where he
    /// is pressed. What slides goes far in a sub-step, and would be turned the more by one pressed halfway the faster it is.
    share: F,
}

/// How two stand to each other at a point.
struct Stance<F> {
    /// From the centre of each to where they press on each other \[m\].
    arms: [Vectors<F>; 2],
    /// How far apart they are, and how far the second has crept along the first \[m\].
    gap: F,
    crept: Vectors<F>,
}

impl<F: Eight> Pair<F> {
    #[inline(always)]
    fn of(like: F, pack: &Pack, (bodies, nobody): (&[Body], &Body), on_scenery: bool) -> Self {
        let everyone = pack.everyone();
        let [a, b] = [pack.side(0, bodies, everyone, nobody), pack.side(1, bodies, everyone, nobody)];
        let gives = [mask_of(like, pack.gives[0]), mask_of(like, pack.gives[1])];
        let poses = [Pose::of(like, &a), Pose::of(like, &b)];
        let [one, other] = [0, 1].map(|side| poses[side].motion.inverse_mass & gives[side]);
        let sum = one + other;
        let share =
            if on_scenery { like.all(1.0) } else { sum.simd_gt(like.all(0.0)).select(other / sum, like.all(0.5)) };
        Self { poses, gives, on_scenery, share }
    }

    #[inline(always)]
    fn stance(&self, normal: Vectors<F>, places: [Vectors<F>; 2]) -> Stance<F> {
        let [a, b] = &self.poses;
        let (from, to) = (a.point(places[0]), b.point(places[1]));
        let (way, place) = (to - from, from + (to - from) * self.share);
        let (gap, crept) = (normal.dot(way), aside(way, normal));
        Stance { arms: [place - a.center, place - b.center], gap, crept }
    }

    /// How fast they part \[m/s\], the scenery moving so.
    #[inline(always)]
    fn parting(&self, [one, other]: [Vectors<F>; 2], surface: Vectors<F>, normal: Vectors<F>) -> F {
        let [a, b] = &self.poses;
        (b.motion.at(other) - a.motion.at(one) - surface).dot(normal)
    }

    #[inline(always)]
    fn parting_before(&self, [one, other]: [Vectors<F>; 2], surface: Vectors<F>, normal: Vectors<F>) -> F {
        let [a, b] = &self.poses;
        (b.at_before(other) - a.at_before(one) - surface).dot(normal)
    }

    /// Fills a pack.
    #[inline(always)]
    fn begin(&self, pack: &mut Pack, all: &[&Manifold; crate::lanes::LANES], span: Span) {
        let [a, b] = &self.poses;
        let like = a.motion.inverse_mass;
        let (within, elasticity, [sticks, slides, grip]) = surfaces(like, all);
        let normal = a.turned(within);
        let u = across(normal);
        let along = [u, normal.cross(u)];
        (pack.within, pack.normal) = (within.saved(), normal.saved());
        pack.along = [along[0].saved(), along[1].saved()];
        (pack.friction, pack.grip) = ([saved(sticks), saved(slides)], saved(grip));
        pack.inverse = [a.motion.inverse(), b.motion.inverse()];
        // What forces make of the speed of either in a sub-step.
        let driven = max(max(like.all(0.0), a.gained()), b.gained());
        let holds = like.all(HOLDS) * grip;
        pack.blows = 0;
        for i in pack.numbers() {
            let kept = self.let_slide(Kept::of(like, all, i), normal, holds);
            let stance = self.stance(normal, kept.places);
            self.weigh(pack, i, (&stance, &kept), [along[0], along[1], normal], span);
            let is_blow = self.expect(pack, i, (&stance, &kept), (normal, along), [driven, elasticity], span);
            pack.blows |= (is_blow & pack.is_there(like, i)).to_bitmask();
        }
    }

    /// Takes the places where points are that slide, or do not touch, for those where friction begins to hold them.
    #[inline(always)]
    fn let_slide(&self, kept: Kept<F>, normal: Vectors<F>, holds: F) -> Kept<F> {
        let [a, b] = &self.poses;
        let [on, off] = kept.places;
        let slides = not(kept.held.length().simd_lt(holds * kept.pressed));
        let way = b.point(off) - a.point(on);
        let moved = on + a.turned_back(aside(way, normal));
        Kept { places: [Vectors::select(slides, moved, on), off], ..kept }
    }

    /// The changes of the velocity at a point that impulses there make, as [`yields`], of both bodies together.
    #[inline(always)]
    fn yielding(&self, arms: [Vectors<F>; 2], directions: [Vectors<F>; 3]) -> [F; 6] {
        let zero = arms[0].0[0].all(0.0);
        let [a, b] = [
            yields(&self.poses[0].motion, self.gives[0], arms[0], directions),
            yields(&self.poses[1].motion, self.gives[1], arms[1], directions),
        ];
        core::array::from_fn(|k| if self.on_scenery { zero + b[k] } else { zero + a[k] + b[k] })
    }

    /// Finds what impulses at each point do to the speeds there; what has crept is taken back in so many sub-steps.
    #[inline(always)]
    fn weigh(
        &self,
        pack: &mut Pack,
        i: usize,
        (stance, kept): (&Stance<F>, &Kept<F>),
        directions: [Vectors<F>; 3],
        span: Span,
    ) {
        let like = stance.gap;
        let yields = self.yielding(stance.arms, directions);
        let back = like.all(RECOVERY / span.h);
        let [mut s, mut t] = [stance.crept.dot(directions[0]) * back, stance.crept.dot(directions[1]) * back];
        let moves = not(kept.surface.is_zero());
        if self.on_scenery && moves.any() {
            s = moves.select(s - kept.surface.dot(directions[0]), s);
            t = moves.select(t - kept.surface.dot(directions[1]), t);
        }
        let spots = &mut pack.spots[i];
        spots.arms = [stance.arms[0].saved(), stance.arms[1].saved()];
        spots.weigh(yields);
        spots.lag = [saved(s), saved(t)];
        let places = &mut pack.places[i];
        places.places = [kept.places[0].saved(), kept.places[1].saved()];
        (places.surface, places.lift) = (kept.surface.saved(), saved(kept.lift));
    }

    /// Says how fast two that come together shall part: the elastic answer to the speed at which they meet, u² = u₀² + 2 a s over the gap s, so that
    /// a bounce neither gains nor loses by when in the sub-step it happens. Where it would be over within a part of the step, they stay together. Returns
    /// where they come to a blow.
    #[inline(always)]
    fn expect(
        &self,
        pack: &mut Pack,
        i: usize,
        (stance, kept): (&Stance<F>, &Kept<F>),
        (normal, along): (Vectors<F>, [Vectors<F>; 2]),
        [driven, elasticity]: [F; 2],
        span: Span,
    ) -> F {
        let &Stance { arms, gap, .. } = stance;
        let (zero, two, h) = (gap.all(0.0), gap.all(2.0), gap.all(span.h));
        let before = negated(self.parting_before(arms, kept.surface, normal));
        let now = negated(self.parting(arms, kept.surface, normal));
        let meets = max(before * before + two * (now - before) / h * gap, zero).sqrt();
        let bounce = (elasticity * meets) & now.simd_gt(zero);
        let rests = (two * bounce * h).simd_lt(gap.all(RESTING * span.step) * driven);
        let recovery = gap.simd_gt(zero).select(gap.all(1.0), gap.all(RECOVERY));
        let wanted = negated(gap) * recovery / h;
        // What held the last sub-step says nothing of a blow.
        let is_blow = max(now.abs(), before.abs()).simd_gt(calm(driven, span));
        let again = gap.all(AGAIN);
        let pressed = (kept.pressed * again) & not(is_blow);
        let held = aside(kept.held.masked(not(is_blow)), normal) * again;
        let spots = &mut pack.spots[i];
        (spots.wanted, spots.little) = (saved(wanted + kept.lift), saved(little(wanted, driven)));
        spots.pressed = saved(pressed);
        spots.held = [saved(held.dot(along[0])), saved(held.dot(along[1]))];
        let Places { driven: kept_driven, bounce: kept_bounce, aside, .. } = &mut pack.places[i];
        (*kept_driven, *kept_bounce, *aside) = (saved(driven), saved(bounce & not(rests)), held.saved());
        is_blow
    }

    /// Where one of both has turned far in the sub-step.
    #[inline(always)]
    fn turned_far(&self, span: Span) -> F {
        let like = self.gives[0];
        let most = like.all(FAR / (span.h * span.h));
        let [a, b] = [0, 1].map(|k| self.poses[k].motion.omega);
        let [a, b] = [a.dot(a).simd_gt(most) & self.gives[0], b.dot(b).simd_gt(most) & self.gives[1]];
        if self.on_scenery { b } else { a | b }
    }

    /// Where one has slid so far along the other in the sub-step that it is pressed elsewhere.
    #[inline(always)]
    fn slid_far(&self, &Stance { arms: [one, other], crept, .. }: &Stance<F>) -> F {
        let like = self.share;
        let slid = crept.dot(crept).simd_gt(min(one.dot(one), other.dot(other)) * like.all(FAR));
        if self.on_scenery { like.all(0.0) } else { slid }
    }

    /// Follows the bodies' places when they have gone, and leaves out of how far apart they are, and of what has crept, the way that the scenery has
    /// gone; lets them slip as it moves from now on, and no longer back. Returns a bit for each that bounces.
    #[inline(always)]
    fn stand_anew(&self, pack: &mut Pack, span: Span) -> u32 {
        let like = self.gives[0];
        let normal = self.poses[0].turned(Vectors::load(like, &pack.within));
        let along = [Vectors::load(like, &pack.along[0]), Vectors::load(like, &pack.along[1])];
        pack.normal = normal.saved();
        pack.inverse = [self.poses[0].motion.inverse(), self.poses[1].motion.inverse()];
        let (zero, h, mut bounces) = (like.all(0.0), like.all(span.h), 0);
        let far = self.turned_far(span);
        for i in pack.numbers() {
            let is_there = pack.is_there(like, i);
            let (spots, places) = (&mut pack.spots[i], &mut pack.places[i]);
            let [on, off] = &places.places;
            let mut stance = self.stance(normal, [Vectors::load(like, on), Vectors::load(like, off)]);
            let (surface, lift) = (Vectors::load(like, &places.surface), load(like, &places.lift));
            let moves = not(surface.is_zero());
            spots.lag = [saved(zero), saved(zero)];
            if self.on_scenery && moves.any() {
                stance.gap = moves.select(stance.gap - lift * h, stance.gap);
                stance.crept = Vectors::select(moves, stance.crept - aside(surface, normal) * h, stance.crept);
                let lag = [negated(surface.dot(along[0])), negated(surface.dot(along[1]))];
                spots.lag = [saved(lag[0] & moves), saved(lag[1] & moves)];
            }
            let closing = negated(self.parting(stance.arms, surface, normal));
            let (driven, bounce) = (load(like, &places.driven), load(like, &places.bounce));
            let touches = load(like, &spots.pressed).simd_gt(zero) | stance.gap.simd_le(zero);
            // Who does not touch yet closes the gap in the next sub-step at the most, or meets for a blow then.
            let is_calm = closing.simd_le(calm(driven, span));
            let ahead = is_calm.select(negated(stance.gap) / h, like.all(f32::NEG_INFINITY));
            let wanted = touches.select(bounce, ahead);
            spots.arms = [stance.arms[0].saved(), stance.arms[1].saved()];
            let far = far | self.slid_far(&stance);
            if far.any() {
                // By what impulses did before they went, passes would drive them on and on.
                let anew = self.yielding(stance.arms, [along[0], along[1], normal]);
                spots.weigh_where(far, anew);
            }
            (spots.wanted, spots.little) = (saved(wanted + lift), saved(little(wanted, driven)));
            places.aside = stance.crept.saved();
            bounces |= (is_there & wanted.simd_gt(zero)).to_bitmask();
        }
        bounces & pack.everyone()
    }
}

/// How impulses at a point of bodies along one of three directions u, v, n, which are square to each other, change the velocity there along another
/// \[1/kg\]: uu, vv, nn, uv, un, vn; zero where they are not pushed.
#[inline(always)]
fn yields<F: Eight>(of: &Motion<F>, gives: F, arm: Vectors<F>, [u, v, n]: [Vectors<F>; 3]) -> [F; 6] {
    let [u, v, n] = [arm.cross(u), arm.cross(v), arm.cross(n)];
    let [iu, iv, i_n] = [of.turned_by(u), of.turned_by(v), of.turned_by(n)];
    let (one, mass) = (gives.all(1.0), of.inverse_mass & gives);
    let [uu, vv, nn] = [one + u.dot(iu), one + v.dot(iv), one + n.dot(i_n)];
    [uu * mass, vv * mass, nn * mass, v.dot(iu) * mass, n.dot(iu) * mass, n.dot(iv) * mass]
}

/// The part of vectors that lies along a surface.
#[inline(always)]
fn aside<F: Eight>(v: Vectors<F>, normal: Vectors<F>) -> Vectors<F> {
    v - normal * v.dot(normal)
}

/// Unit vectors across others.
#[inline(always)]
fn across<F: Eight>(normal: Vectors<F>) -> Vectors<F> {
    let [x, y, z] = normal.0;
    let zero = x.all(0.0);
    let (one, other) = (Vectors([zero, negated(z), y]), Vectors([negated(y), x, zero]));
    let side = Vectors::select(x.abs().simd_lt(x.all(0.6)), one, other);
    side * (x.all(1.0) / side.length())
}

/// The speed below which two come together by their weight, not by a blow \[m/s\].
#[inline(always)]
fn calm<F: Eight>(driven: F, span: Span) -> F {
    driven * driven.all(span.calm())
}

/// The change of the speed at which two part that is too small to go over their neighbours again for \[m/s\].
#[inline(always)]
fn little<F: Eight>(wanted: F, driven: F) -> F {
    max(max(wanted, wanted.all(0.0)), driven) * wanted.all(SETTLED)
}
