//! Listing pairs that may come near each other on the ways that are expected: eight of a kind side by side.

use super::closest::{self, Kind, MARGIN, parts};
use super::eights::{Closest, Gaps, Seen, apart, seen};
use super::near::Listed;
use super::pair::{self, Pair, are_apart};
use super::rest::Rest;
use super::tree::Ways;
use super::waiting::Waiting;
use crate::lanes::{self, ABREAST, Eight, Kernel, LANES, max, min};
use crate::math::{self, length};
use glam::Vec3;

/// Lists pairs as long as there is room.
pub(super) struct Listing<'m, 'r> {
    rest: &'m Rest<'r>,
    /// The half thickness at all, if they are alike.
    uniform: Option<f32>,
    ways: Ways<'m>,
    /// How much farther than they are looked for two are listed \[m\].
    more: f32,
    pairs: &'m mut [Listed],
    count: usize,
    /// Those of whom nothing is known yet, and those that boxes and middles do not keep apart.
    waiting: [Waiting; 2],
    close: [Waiting; 2],
}

impl<'m, 'r> Listing<'m, 'r> {
    pub(super) fn of(
        (rest, uniform): (&'m Rest<'r>, Option<f32>),
        ways: Ways<'m>,
        more: f32,
        pairs: &'m mut [Listed],
    ) -> Self {
        Self { rest, uniform, ways, more, pairs, count: 0, waiting: Waiting::none(), close: Waiting::none() }
    }

    /// Lists two, unless they are farther from each other than they are looked for, and so much more, on the expected ways.
    pub(super) fn add(&mut self, pair: Pair, corners: [u32; 4]) {
        let kind = pair.kind();
        if self.count > self.pairs.len() {
            return;
        }
        if ABREAST < LANES {
            self.one(pair, corners);
        } else if self.waiting[kind as usize].push(pair, corners, f32::NAN) {
            self.sift(kind);
        }
    }

    /// Lists those that wait; returns how many pairs there are. None: there is no room.
    pub(super) fn finish(mut self) -> Option<usize> {
        for kind in [Kind::PointTriangle, Kind::EdgeEdge] {
            if ABREAST == LANES && !self.waiting[kind as usize].len.is_multiple_of(LANES) {
                self.sift(kind);
            }
            if ABREAST == LANES && !self.close[kind as usize].len.is_multiple_of(LANES) {
                self.list(kind);
            }
        }
        (self.count <= self.pairs.len()).then_some(self.count)
    }

    fn push(&mut self, listed: Listed) {
        if let Some(place) = self.pairs.get_mut(self.count) {
            *place = listed;
        }
        self.count += 1;
    }

    /// Of eight, leaves those that boxes or middles keep apart.
    fn sift(&mut self, kind: Kind) {
        let waiting = self.waiting[kind as usize];
        let Self { rest, uniform, ways, more, .. } = *self;
        let Some((close, wanted)) = lanes::run(Sift(Expected { rest, uniform, ways, more, kind, waiting: &waiting }))
        else {
            waiting.of_mask(u32::MAX).for_each(|(_, pair, corners, _)| self.one(pair, corners));
            return;
        };
        for (lane, pair, corners, _) in waiting.of_mask(close) {
            if self.close[kind as usize].push(pair, corners, wanted[lane]) {
                self.list(kind);
            }
        }
    }

    /// Of eight, lists those that nothing keeps apart.
    fn list(&mut self, kind: Kind) {
        let waiting = self.close[kind as usize];
        let Self { rest, uniform, ways, more, .. } = *self;
        let Some((near, apart)) = lanes::run(Near(Expected { rest, uniform, ways, more, kind, waiting: &waiting }))
        else {
            waiting.of_mask(u32::MAX).for_each(|(_, pair, corners, _)| self.one(pair, corners));
            return;
        };
        for (lane, pair, _, wanted) in waiting.of_mask(near) {
            self.push(Listed { pair, apart: apart[lane], wanted });
        }
    }

    /// Lists two alone.
    fn one(&mut self, pair: Pair, corners: [u32; 4]) {
        let (kind, Self { rest, ways, .. }) = (pair.kind(), &*self);
        let ends = [pair::seen(ways.from, corners), pair::seen(ways.to, corners)];
        let far = |wanted: f32| rest.reach(wanted) * (1.0 + MARGIN) + self.more;
        let reach = far(rest.thickness(kind, corners));
        if are_apart(kind, &ends, reach) || parts(kind, &ends, reach) {
            return;
        }
        let apart = math::max(least(kind, &ends, 0), least(kind, &ends, 1));
        if apart >= reach {
            return;
        }
        let wanted = rest.wanted(kind, corners);
        if !(apart >= far(wanted)) {
            self.push(Listed { pair, apart, wanted });
        }
    }
}

/// How far apart two things stay at the least, as the direction tells that is between them at one of both ends \[m\].
fn least(kind: Kind, ends: &[[Vec3; 4]; 2], at: usize) -> f32 {
    let gap = closest::Closest::of(kind, ends[at]).gap;
    let direction = gap / length(gap);
    let all = math::min(closest::apart(kind, &ends[0], direction), closest::apart(kind, &ends[1], direction));
    if all > 0.0 { all } else { 0.0 }
}

/// Eight pairs of a kind on the ways that are expected.
struct Expected<'a, 'r> {
    rest: &'a Rest<'r>,
    uniform: Option<f32>,
    ways: Ways<'a>,
    more: f32,
    kind: Kind,
    waiting: &'a Waiting,
}

impl Expected<'_, '_> {
    /// Their corners at both ends; none, if one of them has to be looked at alone.
    #[inline(always)]
    fn ends<F: Eight>(&self, like: F) -> Option<[Seen<F>; 2]> {
        let corners = &self.waiting.corners;
        Some([seen(like, self.ways.from, corners)?, seen(like, self.ways.to, corners)?])
    }
}

/// Finds those of them that neither boxes nor the direction between their middles keep apart, and how far apart they are to be.
struct Sift<'a, 'r>(Expected<'a, 'r>);

impl Kernel for Sift<'_, '_> {
    /// None: one of them has to be looked at alone.
    type Output = Option<(u32, [f32; LANES])>;

    #[inline(always)]
    fn run<F: Eight>(self, like: F) -> Self::Output {
        let ends = self.0.ends(like)?;
        let Expected { rest, uniform, more, kind, waiting: Waiting { corners, .. }, .. } = self.0;
        let gaps = Gaps::of(kind, &ends);
        let [thickness, alike] = thickness(like, rest, uniform, kind, corners);
        let reach = far(thickness, rest, more);
        let some = gaps.left(reach, reach);
        if !some.any() {
            return Some((0, [0.0; LANES]));
        }
        let gap = Closest::of(kind, seen(like, rest.places, corners)?).gap;
        let wanted = alike.select(min(like.all(0.5) * gap.length(), thickness), thickness);
        let reach = far(wanted, rest, more);
        Some(((some & gaps.left(reach, reach)).to_bitmask(), wanted.to_array()))
    }
}

/// Finds those of them that may come near each other, and how far apart they stay at the least.
struct Near<'a, 'r>(Expected<'a, 'r>);

impl Kernel for Near<'_, '_> {
    /// None: one of them has to be looked at alone.
    type Output = Option<(u32, [f32; LANES])>;

    #[inline(always)]
    fn run<F: Eight>(self, like: F) -> Self::Output {
        let ends = self.0.ends(like)?;
        let Expected { rest, more, kind, waiting, .. } = self.0;
        let apart = max(least_of(kind, &ends, 0), least_of(kind, &ends, 1));
        let is_far = apart.simd_ge(far(like.of(waiting.wanted), rest, more));
        Some((lanes::not(is_far).to_bitmask(), apart.to_array()))
    }
}

/// How far apart two may be at the most that are listed.
#[inline(always)]
fn far<F: Eight>(wanted: F, rest: &Rest<'_>, more: f32) -> F {
    (wanted + wanted.all(2.0 * rest.facts.budget)) * wanted.all(1.0 + MARGIN) + wanted.all(more)
}

/// How far apart eight are kept unless they are of one sheet, and a mask of those that are; half that far at each, where all are alike.
#[inline(always)]
pub(super) fn thickness<F: Eight>(
    like: F,
    rest: &Rest<'_>,
    uniform: Option<f32>,
    kind: Kind,
    corners: &[[u32; 4]; LANES],
) -> [F; 2] {
    if let Some(half) = uniform {
        return [like.all(half + half), like.all(f32::from_bits(u32::MAX))];
    }
    let (mut thickness, mut alike) = ([0.0; LANES], [0.0; LANES]);
    for (lane, &corners) in corners.iter().enumerate() {
        thickness[lane] = rest.thickness(kind, corners);
        alike[lane] = f32::from_bits(if rest.are_of_one_sheet(kind, corners) { u32::MAX } else { 0 });
    }
    [like.of(thickness), like.of(alike)]
}

/// As [`least`].
#[inline(always)]
fn least_of<F: Eight>(kind: Kind, ends: &[Seen<F>; 2], at: usize) -> F {
    let gap = Closest::of(kind, ends[at]).gap;
    let direction = gap / gap.length();
    let all = min(apart(kind, &ends[0], direction), apart(kind, &ends[1], direction));
    all & all.simd_gt(all.all(0.0))
}
