//! Looking at pairs that may come near each other in a sub-step: eight of a kind side by side, and one by one those that have to be followed.

use super::closest::{self, FARTHEST, Kind, MARGIN, Meeting, parts};
use super::contact::Contact;
use super::eights::{Closest, apart, fastest, gap_of_boxes, gap_of_middles, seen};
use super::listing::thickness;
use super::pair::{self, Pair, are_apart, is_own};
use super::rest::Rest;
use super::waiting::Waiting;
use crate::lanes::{self, ABREAST, Eight, Kernel, LANES, Vectors, min};
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
    pub(super) rest: &'m Rest<'r>,
    /// The half thickness at all, if they are alike.
    pub(super) uniform: Option<f32>,
    pub(super) from: &'m [Vec3],
    pub(super) now: &'m [Vec3],
    /// How far each may be pushed from where it is.
    pub(super) room: &'m mut [f32],
    pub(super) contacts: &'m mut [Contact],
    /// The number of contacts, and of those that found no room.
    pub(super) count: usize,
    pub(super) lost: u64,
    /// The number of pairs that would pass each other.
    pub(super) meetings: u32,
    /// Those that have not been looked at yet, of each kind.
    pub(super) waiting: [Waiting; 2],
}

impl Look<'_, '_> {
    /// Looks at two that are kept so far apart; no number: that is not known.
    pub(super) fn at(&mut self, pair: Pair, corners: [u32; 4], wanted: f32) {
        let kind = pair.kind();
        if ABREAST < LANES {
            self.one(pair, corners, wanted);
        } else if self.waiting[kind as usize].push(pair, corners, wanted) {
            self.eight(kind);
        }
    }

    /// Looks at all that wait.
    pub(super) fn finish(&mut self) {
        for kind in [Kind::PointTriangle, Kind::EdgeEdge] {
            if ABREAST == LANES && !self.waiting[kind as usize].len.is_multiple_of(LANES) {
                self.eight(kind);
            }
        }
        self.waiting = Waiting::none();
    }

    fn eight(&mut self, kind: Kind) {
        let waiting = self.waiting[kind as usize];
        let Self { rest, uniform, from, now, .. } = *self;
        let Some(found) = lanes::run(Together { rest, uniform, from, now, kind, waiting: &waiting }) else {
            waiting.of_mask(u32::MAX).for_each(|(_, pair, corners, wanted)| self.one(pair, corners, wanted));
            return;
        };
        for (lane, pair, corners, _) in waiting.of_mask(found.near) {
            let ([x, y, z, _], [weights, distance]) = (found.gap[lane], [found.weights[lane], found.distance[lane]]);
            let closest = closest::Closest { weights, gap: Vec3::new(x, y, z) };
            let meeting = Meeting { closest, distance: [distance[0], distance[1]], meets: false };
            self.note(pair, corners, distance[2], meeting);
        }
        for (_, pair, corners, wanted) in waiting.of_mask(found.unsure) {
            self.one(pair, corners, wanted);
        }
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

/// Eight pairs of a kind in a sub-step.
struct Together<'a, 'r> {
    rest: &'a Rest<'r>,
    uniform: Option<f32>,
    from: &'a [Vec3],
    now: &'a [Vec3],
    kind: Kind,
    waiting: &'a Waiting,
}

/// What comes of them.
#[derive(Default)]
struct Found {
    /// Those that come near each other without coming together, and those that have to be followed.
    near: u32,
    unsure: u32,
    weights: [[f32; 4]; LANES],
    gap: [[f32; 4]; LANES],
    /// How far apart they are at the beginning and in the end, and are kept.
    distance: [[f32; 4]; LANES],
}

impl Kernel for Together<'_, '_> {
    /// None: one of them has to be looked at alone.
    type Output = Option<Found>;

    /// As [`Meeting::of`], as far as that goes without following the ways.
    #[inline(always)]
    fn run<F: Eight>(self, like: F) -> Self::Output {
        let (Self { rest, uniform, from, now, kind, .. }, Waiting { corners, wanted, .. }) = (&self, self.waiting);
        let (kind, budget) = (*kind, rest.facts.budget);
        let reach = |wanted: F| wanted + like.all(2.0 * budget);
        let ends = [seen(like, from, corners)?, seen(like, now, corners)?];
        let (boxes, [far, way]) = (gap_of_boxes(kind, &ends), gap_of_middles(kind, &ends));
        let fast = like.all(2.0 * FARTHEST * budget);
        let follows = fastest(kind, &ends).simd_le(fast * fast);
        // Those of whom nothing is found: a direction keeps them apart.
        let left = |reach: F| {
            let least = reach * like.all(1.0 + MARGIN);
            lanes::not(boxes.simd_gt(reach) | (follows & far.simd_gt(least * least * way)))
        };
        let [thickness, alike] = thickness(like, rest, *uniform, kind, corners);
        let mut some = left(reach(thickness));
        if !some.any() {
            return Some(Found::default());
        }
        let mut wanted = like.of(*wanted);
        if lanes::not(wanted.simd_le(thickness)).any() {
            let gap = Closest::of(kind, seen(like, rest.places, corners)?).gap;
            let half = min(like.all(0.5) * gap.length(), thickness);
            wanted = wanted.simd_le(thickness).select(wanted, alike.select(half, thickness));
        }
        let reach = reach(wanted);
        some = some & left(reach);
        if !some.any() {
            return Some(Found::default());
        }
        let first = Closest::of(kind, ends[0]);
        let begun = first.gap.length();
        let (zero, sound) = (like.all(0.0), begun.simd_lt(like.all(f32::INFINITY)));
        some = some & begun.simd_gt(zero) & sound;
        some = some & lanes::not(apart(kind, &ends[1], first.gap / begun).simd_ge(reach));
        if !some.any() {
            return Some(Found::default());
        }
        let closest = Closest::of(kind, ends[1]);
        let ended = closest.gap.length();
        let near = min(like.all(NEAR) * lanes::max(wanted, like.all(budget)), like.all(0.5) * begun);
        let straight = ended.simd_gt(near) & apart(kind, &ends[0], closest.gap / ended).simd_gt(zero);
        Some(Found {
            near: (some & straight & lanes::not(ended.simd_ge(reach))).to_bitmask(),
            unsure: (some & lanes::not(straight)).to_bitmask(),
            weights: F::rows_of(closest.weights),
            gap: Vectors::rows(closest.gap),
            distance: F::rows_of([begun, ended, wanted, zero]),
        })
    }
}
