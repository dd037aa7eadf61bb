//! Lists of who may come near whom in the sub-steps to come, for as long as all go on about as they do.
//!
//! Everyone is expected to go on by a mean of how it goes in the sub-step in which they are made and how fast it came. Two are listed unless some direction keeps them apart by more
//! than they are looked for and two skins, at both ends of the ways expected, and so all along these. Who leaves its expected way by more than a skin, as seen
//! from all, is astray: what comes near its triangles is sought anew, and when there are too many of these, lists are given up. A pair that is listed is left
//! out as long as what its corners have left their ways by cannot have brought it near.
//!
//! Where a quarter of all are astray, nobody is expected anywhere for the rest of the step: then each sub-step lists whoever is close as it looks at all for the first
//! time, and looks again at these alone, and at whom those triangles are near that have been pushed far since.
//!
//! Lists thereby find what a search of all finds, bit by bit: pairs that lists leave out are such as [`Look`](super::look::Look) finds nothing of.

use super::closest::MARGIN;
use super::pair::Pair;
use super::rest::Rest;
use crate::math::{clamp, dot, length, max, min, sqrt};
use glam::Vec3;

/// The facts known of the lists.
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(super) struct Facts {
    /// The number of the sub-step in which they were made, and for how many they are good; none: there are none.
    pub(super) first: u32,
    pub(super) horizon: u32,
    /// The number of pairs.
    pub(super) pairs: u32,
    /// Facts known besides: any of [`FULL`], [`LOST`] and [`CLOSE`].
    pub(super) state: u32,
    /// How far anyone may leave the expected way \[m\].
    pub(super) skin: f32,
}

/// Pairs found no room in this step.
pub(super) const FULL: u32 = 1;
/// Too many have left the ways that were expected in this step, and nobody is expected anywhere any more.
const LOST: u32 = 2;
/// The pairs are those that are close in the sub-step.
const CLOSE: u32 = 4;

impl Facts {
    pub(super) fn is_full(&self) -> bool {
        self.state & FULL != 0
    }

    pub(super) fn is_lost(&self) -> bool {
        self.state & LOST != 0
    }

    pub(super) fn is_close(&self) -> bool {
        self.state & CLOSE != 0
    }
}

/// Two that may come near each other.
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(super) struct Listed {
    pub(super) pair: Pair,
    /// How far apart they stay at the least as long as all are on the expected ways \[m\].
    pub(super) apart: f32,
    /// How far apart they are kept \[m\].
    pub(super) wanted: f32,
}

/// The lists, and the ways on which they are good.
pub(super) struct Near<'m> {
    pub(super) facts: &'m mut Facts,
    /// Where everyone was at the beginning of the sub-step in which they were made, and how far each is expected to go in each one \[m\].
    pub(super) base: &'m mut [Vec3],
    pub(super) going: &'m mut [Vec3],
    pub(super) pairs: &'m mut [Listed],
}

/// The least and the most that anyone may leave the expected way by, as multiples of how far one may be pushed between searches.
const SKINS: [f32; 2] = [0.5, 2.0];

/// How far anyone may be pushed until those are sought anew who are close to it, as a multiple of how far one may be pushed between searches.
const PUSHED: f32 = 0.25;

/// How far that is \[m\].
pub(super) fn pushed(rest: &Rest<'_>) -> f32 {
    PUSHED * rest.facts.budget
}

/// How far anyone may leave the expected way: no farther, if it can be, than leaves neighbours in the sheets out of the lists while these are as
/// they are at rest, as most triangles' least heights tell.
fn skin(rest: &Rest<'_>) -> f32 {
    let (mut sum, mut count) = (0.0, 0.0);
    for face in &*rest.faces {
        let [a, b, c] = face.corners.map(|corner| rest.places.get(corner as usize).copied().unwrap_or(Vec3::NAN));
        let (e, f, g) = (b - a, c - b, a - c);
        let height = length(e.cross(f)) / sqrt(max(max(dot(e, e), dot(f, f)), dot(g, g)));
        let spare = height - rest.reach(min(0.5 * height, 2.0 * rest.widest(face)));
        if spare.is_finite() {
            sum += 0.45 * spare;
            count += 1.0;
        }
    }
    let [least, most] = SKINS.map(|share| share * rest.facts.budget);
    clamp(sum / max(count, 1.0), least, most)
}

/// Pairs that there is room for, for each particle, and besides.
const ROOM: [usize; 2] = [24, 64];
/// The words of facts, of a particle, and of a pair.
const WORDS: [usize; 3] = [size_of::<Facts>() / 4, 6, size_of::<Listed>() / 4];

/// The words that lists of so many particles ask for.
pub(super) fn words(particles: usize) -> usize {
    let pairs = particles.saturating_mul(ROOM[0]).saturating_add(ROOM[1]);
    let own = particles.saturating_mul(WORDS[1]).saturating_add(WORDS[0]);
    pairs.saturating_mul(WORDS[2]).saturating_add(own)
}

impl<'m> Near<'m> {
    /// Lists in as much of that memory as is lent. None: it is too small for any.
    pub(super) fn of(lent: &'m mut [u32], particles: usize) -> Option<Self> {
        let (facts, rest) = lent.split_at_mut_checked(WORDS[0])?;
        let (base, rest) = rest.split_at_mut_checked(3 * particles)?;
        let (going, rest) = rest.split_at_mut_checked(3 * particles)?;
        let room = rest.len() / WORDS[2] * WORDS[2];
        Some(Self {
            facts: bytemuck::cast_slice_mut(facts).first_mut()?,
            base: bytemuck::cast_slice_mut(base),
            going: bytemuck::cast_slice_mut(going),
            pairs: bytemuck::cast_slice_mut(&mut rest[..room]),
        })
    }

    /// Forgets all, as a step begins.
    pub(super) fn forget(&mut self, rest: &Rest<'_>) {
        *self.facts = Facts { skin: skin(rest), ..bytemuck::Zeroable::zeroed() };
    }

    /// Gives up expecting anyone anywhere in this step.
    pub(super) fn lose(&mut self) {
        self.facts.pairs = 0;
        self.facts.state |= LOST;
    }

    /// Forgets who is close, as a sub-step begins.
    pub(super) fn part(&mut self) {
        if self.facts.is_close() {
            self.facts.pairs = 0;
            self.facts.state &= !CLOSE;
        }
    }

    /// Takes in that so many are close as all are at these places in the end.
    pub(super) fn close(&mut self, count: usize, now: &[Vec3]) {
        self.facts.pairs = count as u32;
        self.facts.state |= CLOSE;
        self.base.copy_from_slice(now);
    }

    /// All pairs of triangles that are not astray, which may come near each other in the sub-step; `strays` says how far each triangle has left its way.
    pub(super) fn pairs<'a>(&'a self, rest: &'a Rest<'_>, strays: &'a [f32]) -> impl Iterator<Item = &'a Listed> {
        let all = &self.pairs[..self.facts.pairs as usize];
        all.iter().filter(move |listed| {
            let [one, other] = listed.pair.faces().map(|face| strays[face]);
            let least = rest.reach(listed.wanted) * (1.0 + MARGIN);
            one < f32::INFINITY && other < f32::INFINITY && !(listed.apart - one - other > least)
        })
    }
}
