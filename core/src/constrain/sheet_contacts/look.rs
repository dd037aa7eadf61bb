//! Looking at pairs that may come near each other in a sub-step: as many of a kind side by side as registers hold, and one by one those that have to be followed.

use super::closest::{self, FARTHEST, Kind, MARGIN, Meeting, parts};
use super::contact::Contact;
use super::eights::{Closest, Gaps, Seen, apart, fastest, seen};
use super::listing::thickness;
use super::near::Listed;
use super::pair::{self, Pair, are_apart, is_own};
use super::rest::Rest;
use super::waiting::{ROOM, Waiting};
use crate::lanes::{self, ABREAST, BroadKernel, Eight, LANES, Lanes, PARTS, min};
use crate::math::{self, length};
use glam::Vec3;

/// How much of the distance between two each may go before it has to be looked again: less than half of it.
pub(super) const SHARE: f32 = 0.45;
/// Two that come so near to each other, as a share of their thickness, have come together.
const NEAR: f32 = 0.1;
/// The share of a gap that is missing that a sub-step gives back.
const RECOVERY: f32 = 0.2;

/// Looks at pairs, and lists what comes of them.
pub(super) struct Look<'m, 'r> {
    rest: &'m Rest<'r>,
    /// The half thickness at all, if they are alike.
    uniform: Option<f32>,
    from: &'m [Vec3],
    now: &'m [Vec3],
    /// How far each may be pushed from where it is.
    room: &'m mut [f32],
    contacts: &'m mut [Contact],
    /// Room for those that come near if they are pushed together by so much more, how much that is \[m\], and their number.
    close: &'m mut [Listed],
    more: f32,
    closed: usize,
    /// The number of contacts, and of those that found no room.
    pub(super) count: usize,
    pub(super) lost: u64,
    /// The number of pairs that would pass each other.
    pub(super) meetings: u32,
    /// Those that have not been looked at yet, of each kind.
    waiting: [Waiting; 2],
    /// True if each is looked at alone, in the order in which they come.
    alone: bool,
    /// The outcome for the last that have waited.
    met: [Met; PARTS],
}

impl<'m, 'r> Look<'m, 'r> {
    pub(super) fn new(
        (rest, uniform): (&'m Rest<'r>, Option<f32>),
        [from, now]: [&'m [Vec3]; 2],
        room: &'m mut [f32],
        contacts: &'m mut [Contact],
        (close, more): (&'m mut [Listed], f32),
        alone: bool,
    ) -> Self {
        let (count, lost, meetings, closed) = (0, 0, 0, 0);
        let waiting = Waiting::none();
        let met = Default::default();
        Self {
            rest,
            uniform,
            from,
            now,
            room,
            contacts,
            close,
            more,
            closed,
            count,
            lost,
            meetings,
            waiting,
            alone,
            met,
        }
    }

    /// Looks at two that are kept so far apart; no number: that is not known.
    pub(super) fn at(&mut self, pair: Pair, corners: [u32; 4], wanted: f32) {
        let kind = pair.kind();
        if ABREAST < LANES || self.alone {
            self.one(pair, corners, wanted);
        } else if self.waiting[kind as usize].push(pair, corners, wanted) {
            self.all(kind);
        }
    }

    /// Looks at all that wait.
    pub(super) fn finish(&mut self) {
        for kind in [Kind::PointTriangle, Kind::EdgeEdge] {
            if ABREAST == LANES && !self.waiting[kind as usize].len.is_multiple_of(ROOM) {
                self.all(kind);
            }
        }
        self.waiting = Waiting::none();
    }

    /// Looks at all of a kind that wait.
    fn all(&mut self, kind: Kind) {
        let waiting = self.waiting[kind as usize];
        let Self { rest, uniform, from, now, more, .. } = *self;
        let together = Together { rest, uniform, from, now, more, kind, waiting: &waiting };
        let Some([near, unsure, close]) = lanes::run_broad(Meet(together, &mut self.met)) else {
            for (_, pair, corners, wanted) in waiting.of_mask(u32::MAX) {
                self.keep(pair, wanted);
                self.one(pair, corners, wanted);
            }
            return;
        };
        if !self.close.is_empty() {
            waiting.of_mask(close).for_each(|(lane, pair, ..)| {
                self.keep(pair, self.met[lane / LANES].wanted[lane % LANES]);
            });
        }
        for (lane, pair, corners, _) in waiting.of_mask(near) {
            let met = &self.met[lane / LANES];
            let lane = lane % LANES;
            let ([x, y, z, begun], weights, wanted) = (met.gap[lane], met.weights[lane], met.wanted[lane]);
            let closest = closest::Closest { weights, gap: Vec3::new(x, y, z) };
            let meeting = Meeting { closest, distance: [begun, met.ended[lane]], meets: false };
            self.note(pair, corners, wanted, meeting);
        }
        for (_, pair, corners, wanted) in waiting.of_mask(unsure) {
            self.one(pair, corners, wanted);
        }
    }

    /// Lists two that are close.
    fn keep(&mut self, pair: Pair, wanted: f32) {
        if let Some(place) = self.close.get_mut(self.closed) {
            *place = Listed { pair, apart: 0.0, wanted };
        }
        self.closed += 1;
    }

    /// The number of those that are close; none, if there was no room for them.
    pub(super) fn closed(&self) -> Option<usize> {
        Some(self.closed).filter(|&count| !self.close.is_empty() && count <= self.close.len())
    }

    /// Looks at two alone.
    fn one(&mut self, pair: Pair, corners: [u32; 4], wanted: f32) {
        let (kind, rest) = (pair.kind(), self.rest);
        let ends = [pair::seen(self.from, corners), pair::seen(self.now, corners)];
        let fast = 2.0 * FARTHEST * rest.facts.budget;
        let follows = closest::fastest(kind, &ends) <= fast * fast;
        // Nothing is found of those that a direction keeps apart.
        let is_left =
            |reach: f32| !(are_apart(kind, &ends, reach) || follows && parts(kind, &ends, reach * (1.0 + MARGIN)));
        let thickness = rest.thickness(kind, corners);
        if !is_left(rest.reach(thickness)) {
            return;
        }
        let wanted = if wanted <= thickness { wanted } else { rest.wanted(kind, corners) };
        let reach = rest.reach(wanted);
        if !is_left(reach) {
            return;
        }
        if let Some(meeting) = Meeting::of(kind, &ends, reach, NEAR * math::max(wanted, rest.facts.budget)) {
            self.note(pair, corners, wanted, meeting);
        }
    }

    fn note(&mut self, pair: Pair, corners: [u32; 4], wanted: f32, meeting: Meeting) {
        let Meeting { closest, distance: [begun, ended], meets } = meeting;
        let kind = pair.kind();
        if !meets && ended >= self.rest.reach(wanted) {
            return;
        }
        for corner in corners {
            let room = &mut self.room[corner as usize];
            *room = math::min(SHARE * ended, *room);
        }
        self.meetings += u32::from(meets);
        if !meets && !is_own(kind, &closest.weights, &self.rest.faces[pair.faces()[1]]) {
            return;
        }
        let normal = closest.gap / length(closest.gap);
        if !normal.is_finite() {
            return;
        }
        let Some(place) = self.contacts.get_mut(self.count) else {
            self.lost += 1;
            return;
        };
        self.count += 1;
        let recovery = RECOVERY * math::max(wanted - begun, 0.0);
        let target = if begun < wanted { begun + recovery } else { wanted };
        let (split, weights, meets) = (kind.split() as u32, closest.weights, u32::from(meets));
        let (touch, tangent) = (bytemuck::Zeroable::zeroed(), bytemuck::Zeroable::zeroed());
        *place = Contact { corners, split, weights, normal, target, recovery, meets, touch, tangent };
    }
}

/// Pairs of a kind in a sub-step.
struct Together<'a, 'r> {
    rest: &'a Rest<'r>,
    uniform: Option<f32>,
    from: &'a [Vec3],
    now: &'a [Vec3],
    more: f32,
    kind: Kind,
    waiting: &'a Waiting,
}

impl Together<'_, '_> {
    /// The corners of some from one eight on at both ends; none, if one of them has to be looked at alone.
    #[inline(always)]
    fn ends<F: Lanes>(&self, like: F, first: usize) -> Option<[Seen<F>; 2]> {
        let corners = &self.waiting.corners[first..];
        Some([seen(like, self.from, corners)?, seen(like, self.now, corners)?])
    }

    /// The bounds that are found at first glance: a direction that keeps them apart counts where they are not too fast.
    #[inline(always)]
    fn gaps<F: Lanes>(&self, like: F, ends: &[Seen<F>; 2]) -> Gaps<F> {
        let fast = like.all(2.0 * FARTHEST * self.rest.facts.budget);
        Gaps::of(self.kind, ends).masked(fastest(self.kind, ends).simd_le(fast * fast))
    }

    /// How far apart two may be at the most that are looked at.
    #[inline(always)]
    fn reach<F: Lanes>(&self, wanted: F) -> F {
        wanted + wanted.all(2.0 * self.rest.facts.budget)
    }

    /// Those that something may be found of, if they are kept so far apart.
    #[inline(always)]
    fn left<F: Lanes>(&self, gaps: &Gaps<F>, wanted: F) -> F {
        let reach = self.reach(wanted);
        gaps.left(reach, reach * wanted.all(1.0 + MARGIN))
    }

    /// How far apart two may be at the most that are close.
    #[inline(always)]
    fn far<F: Lanes>(&self, wanted: F) -> F {
        self.reach(wanted) * wanted.all(1.0 + MARGIN) + wanted.all(self.more)
    }
}

/// The outcome for those of eight that come near each other.
#[derive(Default)]
struct Met {
    weights: [[f32; 4]; LANES],
    /// The ways between them in the end, and how far apart they are at the beginning.
    gap: [[f32; 4]; LANES],
    ended: [f32; LANES],
    /// How far apart they are kept.
    wanted: [f32; LANES],
}

/// Finds those of them that come near each other without coming together, and those that have to be followed.
struct Meet<'a, 'r>(Together<'a, 'r>, &'a mut [Met; PARTS]);

impl Meet<'_, '_> {
    /// As [`Meeting::of`], as far as that goes without following the ways, of some from one eight on.
    #[inline(always)]
    fn some<F: Lanes>(&mut self, like: F, first: usize) -> Option<[u32; 3]> {
        let Self(this, met) = self;
        let (kind, budget, corners) = (this.kind, this.rest.facts.budget, &this.waiting.corners[first..]);
        let ends = this.ends(like, first)?;
        let gaps = this.gaps(like, &ends);
        let [thickness, alike] = thickness(like, this.rest, this.uniform, kind, corners);
        let far = this.far(thickness);
        let mut close = gaps.left(far, far);
        if !close.any() {
            return Some([0; 3]);
        }
        let [mut wanted] = like.of_parts(
            #[inline(always)]
            |like, nth| [like.of(this.waiting.wanted[first + nth])],
        );
        if lanes::not(wanted.simd_le(thickness)).any() {
            let gap = Closest::of(kind, seen(like, this.rest.places, corners)?).gap;
            let half = min(like.all(0.5) * gap.length(), thickness);
            wanted = wanted.simd_le(thickness).select(wanted, alike.select(half, thickness));
        }
        for (nth, met) in met[first..].iter_mut().enumerate().take(F::PARTS) {
            met.wanted = wanted.part(nth).to_array();
        }
        let (reach, far) = (this.reach(wanted), this.far(wanted));
        close = close & gaps.left(far, far);
        let mut some = close & this.left(&gaps, wanted);
        if !close.any() {
            return Some([0; 3]);
        }
        let start = Closest::of(kind, ends[0]);
        let begun = start.gap.length();
        let (zero, sound) = (like.all(0.0), begun.simd_lt(like.all(f32::INFINITY)));
        some = some & begun.simd_gt(zero) & sound;
        let still = apart(kind, &ends[1], start.gap / begun);
        some = some & lanes::not(still.simd_ge(reach));
        close = close & lanes::not(min(begun, still).simd_ge(far));
        if !some.any() {
            return Some([0, 0, close.to_bitmask()]);
        }
        let closest = Closest::of(kind, ends[1]);
        let ended = closest.gap.length();
        let near = min(like.all(NEAR) * lanes::max(wanted, like.all(budget)), like.all(0.5) * begun);
        let straight = ended.simd_gt(near) & apart(kind, &ends[0], closest.gap / ended).simd_gt(zero);
        let [x, y, z] = closest.gap.0;
        let [a, b, c, d] = closest.weights;
        for (nth, met) in met[first..].iter_mut().enumerate().take(F::PARTS) {
            met.weights = Eight::rows_of([a.part(nth), b.part(nth), c.part(nth), d.part(nth)]);
            met.gap = Eight::rows_of([x.part(nth), y.part(nth), z.part(nth), begun.part(nth)]);
            met.ended = ended.part(nth).to_array();
        }
        let near = some & straight & lanes::not(ended.simd_ge(reach));
        Some([near.to_bitmask(), (some & lanes::not(straight)).to_bitmask(), close.to_bitmask()])
    }
}

impl BroadKernel for Meet<'_, '_> {
    /// None: one of them has to be looked at alone.
    type Output = Option<[u32; 3]>;

    #[inline(always)]
    fn run<F: Lanes>(mut self, like: F) -> Self::Output {
        let mut found = [0; 3];
        for first in (0..PARTS).step_by(F::PARTS) {
            for (found, some) in found.iter_mut().zip(self.some(like, first)?) {
                *found |= some << (LANES * first);
            }
        }
        Some(found)
    }
}
