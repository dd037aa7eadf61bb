//! Listing pairs that may come near each other on the ways that are expected: as many of a kind side by side as registers hold.

use super::closest::{self, Kind, MARGIN, parts};
use super::eights::{Closest, Gaps, Seen, apart, seen};
use super::near::Listed;
use super::pair::{self, Pair, are_apart};
use super::rest::Rest;
use super::tree::Ways;
use super::waiting::{ROOM, Waiting};
use crate::lanes::{self, ABREAST, BroadKernel, Eight, LANES, Lanes, PARTS, max, min};
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
            if ABREAST == LANES && !self.waiting[kind as usize].len.is_multiple_of(ROOM) {
                self.sift(kind);
            }
            if ABREAST == LANES && !self.close[kind as usize].len.is_multiple_of(ROOM) {
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

    /// Leaves those of all that wait that boxes or middles keep apart.
    fn sift(&mut self, kind: Kind) {
        let waiting = self.waiting[kind as usize];
        let Self { rest, uniform, ways, more, .. } = *self;
        let expected = Expected { rest, uniform, ways, more, kind, waiting: &waiting };
        let Some(Chosen { mask, numbers }) = lanes::run_broad(Sift(expected)) else {
            waiting.of_mask(u32::MAX).for_each(|(_, pair, corners, _)| self.one(pair, corners));
            return;
        };
        for (lane, pair, corners, _) in waiting.of_mask(mask) {
            if self.close[kind as usize].push(pair, corners, numbers.as_flattened()[lane]) {
                self.list(kind);
            }
        }
    }

    /// Lists those of the close that nothing keeps apart.
    fn list(&mut self, kind: Kind) {
        let waiting = self.close[kind as usize];
        let Self { rest, uniform, ways, more, .. } = *self;
        let expected = Expected { rest, uniform, ways, more, kind, waiting: &waiting };
        let Some(Chosen { mask, numbers }) = lanes::run_broad(Near(expected)) else {
            waiting.of_mask(u32::MAX).for_each(|(_, pair, corners, _)| self.one(pair, corners));
            return;
        };
        for (lane, pair, _, wanted) in waiting.of_mask(mask) {
            self.push(Listed { pair, apart: numbers.as_flattened()[lane], wanted });
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

/// Pairs of a kind on the ways that are expected.
struct Expected<'a, 'r> {
    rest: &'a Rest<'r>,
    uniform: Option<f32>,
    ways: Ways<'a>,
    more: f32,
    kind: Kind,
    waiting: &'a Waiting,
}

impl Expected<'_, '_> {
    /// The corners of some from one eight on at both ends; none, if one of them has to be looked at alone.
    #[inline(always)]
    fn ends<F: Lanes>(&self, like: F, first: usize) -> Option<[Seen<F>; 2]> {
        let corners = &self.waiting.corners[first..];
        Some([seen(like, self.ways.from, corners)?, seen(like, self.ways.to, corners)?])
    }
}

/// Those that are chosen, and a number for each of all.
#[derive(Default)]
struct Chosen {
    mask: u32,
    numbers: [[f32; LANES]; PARTS],
}

impl Chosen {
    /// Adds what a mask says of some from one eight on.
    #[inline(always)]
    fn add<F: Lanes>(&mut self, first: usize, mask: F, numbers: F) {
        self.mask |= mask.to_bitmask() << (LANES * first);
        for (nth, eight) in self.numbers[first..].iter_mut().enumerate().take(F::PARTS) {
            *eight = numbers.part(nth).to_array();
        }
    }
}

/// Finds those of them that neither boxes nor the direction between their middles keep apart, and how far apart they are to be.
struct Sift<'a, 'r>(Expected<'a, 'r>);

impl Sift<'_, '_> {
    /// The same of some from one eight on.
    #[inline(always)]
    fn some<F: Lanes>(&self, like: F, first: usize) -> Option<(F, F)> {
        let ends = self.0.ends(like, first)?;
        let Expected { rest, uniform, more, kind, waiting: Waiting { corners, .. }, .. } = self.0;
        let gaps = Gaps::of(kind, &ends);
        let [thickness, alike] = thickness(like, rest, uniform, kind, &corners[first..]);
        let reach = far(thickness, rest, more);
        let some = gaps.left(reach, reach);
        if !some.any() {
            return Some((some, thickness));
        }
        let gap = Closest::of(kind, seen(like, rest.places, &corners[first..])?).gap;
        let wanted = alike.select(min(like.all(0.5) * gap.length(), thickness), thickness);
        let reach = far(wanted, rest, more);
        Some((some & gaps.left(reach, reach), wanted))
    }
}

impl BroadKernel for Sift<'_, '_> {
    type Output = Option<Chosen>;

    #[inline(always)]
    fn run<F: Lanes>(self, like: F) -> Self::Output {
        let mut chosen = Chosen::default();
        for first in (0..PARTS).step_by(F::PARTS) {
            let (close, wanted) = self.some(like, first)?;
            chosen.add(first, close, wanted);
        }
        Some(chosen)
    }
}

/// Finds those of them that may come near each other, and how far apart they stay at the least.
struct Near<'a, 'r>(Expected<'a, 'r>);

impl BroadKernel for Near<'_, '_> {
    type Output = Option<Chosen>;

    #[inline(always)]
    fn run<F: Lanes>(self, like: F) -> Self::Output {
        let mut chosen = Chosen::default();
        let Expected { rest, more, kind, waiting, .. } = self.0;
        for first in (0..PARTS).step_by(F::PARTS) {
            let ends = self.0.ends(like, first)?;
            let apart = max(least_of(kind, &ends, 0), least_of(kind, &ends, 1));
            let [wanted] = like.of_parts(
                #[inline(always)]
                |like, nth| [like.of(waiting.wanted[first + nth])],
            );
            chosen.add(first, lanes::not(apart.simd_ge(far(wanted, rest, more))), apart);
        }
        Some(chosen)
    }
}

/// How far apart two may be at the most that are listed.
#[inline(always)]
fn far<F: Lanes>(wanted: F, rest: &Rest<'_>, more: f32) -> F {
    (wanted + wanted.all(2.0 * rest.facts.budget)) * wanted.all(1.0 + MARGIN) + wanted.all(more)
}

/// How far apart some are kept unless they are of one sheet, and a mask of those that are; half that far at each, where all are alike.
#[inline(always)]
pub(super) fn thickness<F: Lanes>(
    like: F,
    rest: &Rest<'_>,
    uniform: Option<f32>,
    kind: Kind,
    corners: &[[[u32; 4]; LANES]],
) -> [F; 2] {
    if let Some(half) = uniform {
        return [like.all(half + half), like.all(f32::from_bits(u32::MAX))];
    }
    like.of_parts(
        #[inline(always)]
        |like, nth| {
            let (mut thickness, mut alike) = ([0.0; LANES], [0.0; LANES]);
            for (lane, &corners) in corners[nth].iter().enumerate() {
                thickness[lane] = rest.thickness(kind, corners);
                alike[lane] = f32::from_bits(if rest.are_of_one_sheet(kind, corners) { u32::MAX } else { 0 });
            }
            [like.of(thickness), like.of(alike)]
        },
    )
}

/// As [`least`].
#[inline(always)]
fn least_of<F: Lanes>(kind: Kind, ends: &[Seen<F>; 2], at: usize) -> F {
    let gap = Closest::of(kind, ends[at]).gap;
    let direction = gap / gap.length();
    let all = min(apart(kind, &ends[0], direction), apart(kind, &ends[1], direction));
    all & all.simd_gt(all.all(0.0))
}
