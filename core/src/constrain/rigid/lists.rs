//! The list of bodies that may touch each other, made anew when one has gone far.

use super::super::{Bodies, Words};
use super::body::Body;
use super::manifold::{Manifold, are_near};
use super::scenery::{DIRECTIONS, leash};
use crate::material::of_two;
use crate::math::{length, max};
use crate::memory::{take, take_vectors};

/// Pairs of near bodies that there is room for, for each body.
const PAIRS: usize = 8;
/// Pairs of bodies whose balls are near that there is room for, for each body.
const CANDIDATES: usize = 24;

/// The rest that is kept of them.
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(super) struct Lists {
    /// Pairs in the list.
    pub(super) pairs: u32,
    /// 1 if there is a list.
    known: u32,
}

/// The memory of bodies in its parts.
pub(super) struct Kept<'a> {
    pub(super) lists: &'a mut Lists,
    /// The world, then the bodies.
    pub(super) bodies: &'a mut [Body],
    pub(super) pairs: &'a mut [Manifold],
    /// So many for each body as it can be pressed in directions.
    pub(super) scenery: &'a mut [Manifold],
    /// The places of all particles, of one body after the other.
    pub(super) places: &'a mut [u32],
}

/// Words of a thing.
const fn words<T>() -> usize {
    size_of::<T>() / 4
}

/// How many pairs there is room for.
fn room(count: usize) -> usize {
    count.saturating_mul(PAIRS).min(count.saturating_mul(count.saturating_sub(1)) / 2)
}

/// The words kept for so many bodies of so many particles in all, and those to work with.
pub(super) fn demand(count: usize, particles: usize) -> [Words; 2] {
    let each = |count: usize, words: usize| count.saturating_mul(words);
    let kept = words::<Lists>()
        .saturating_add(each(count.saturating_add(1), words::<Body>()))
        .saturating_add(each(room(count), words::<Manifold>()))
        .saturating_add(each(count, DIRECTIONS * words::<Manifold>()))
        .saturating_add(each(particles, 3));
    let scratch = each(room(count), words::<Manifold>()).saturating_add(each(count, 3 + 2 * CANDIDATES));
    [kept, scratch].map(|fixed| Words { per_row: 0, fixed })
}

impl<'a> Kept<'a> {
    /// None: the memory is too small.
    pub(super) fn of(mut memory: &'a mut [u32], count: usize) -> Option<Self> {
        let lists = bytemuck::try_cast_slice_mut(take(&mut memory, words::<Lists>())).ok()?.first_mut()?;
        let bodies = bytemuck::try_cast_slice_mut(take(&mut memory, (count + 1) * words::<Body>())).ok()?;
        let pairs = bytemuck::try_cast_slice_mut(take(&mut memory, room(count) * words::<Manifold>())).ok()?;
        let scenery = take(&mut memory, count * DIRECTIONS * words::<Manifold>());
        let scenery = bytemuck::try_cast_slice_mut(scenery).ok()?;
        Some(Self { lists, bodies, pairs, scenery, places: memory })
    }
}

/// Lists all that may touch before one of them has gone as far as it may, and looks where they do.
pub(super) fn gather(bodies: &mut Bodies<'_>, kept: &mut Kept<'_>, scratch: &mut [u32], is_news: bool) {
    let (h, step) = (bodies.substep.seconds(), bodies.substep.step.seconds());
    let mut is_over = is_news || kept.lists.known == 0;
    for body in kept.bodies.iter_mut().filter(|body| body.moves()) {
        body.leash -= body.speed() * h;
        is_over |= !(body.leash >= body.speed() * h);
    }
    if is_over {
        for body in kept.bodies.iter_mut() {
            body.leash = if body.moves() { leash(body, step) } else { 0.0 };
        }
        list(bodies, kept, scratch);
    }
    let Kept { lists, bodies: all, pairs, .. } = kept;
    for pair in &mut pairs[..lists.pairs as usize] {
        let [a, b] = pair.bodies.map(|number| &all[number as usize]);
        let way = (length(a.velocity - b.velocity) + length(a.omega) * a.radius + length(b.omega) * b.radius) * h;
        if pair.spare <= if pair.count == 0 { 2.0 * way } else { way } {
            pair.find(a, b, 2.0 * way);
        }
        pair.spare -= way;
    }
}

/// Makes the list. Those that were in the list before go on with what they have.
fn list(bodies: &mut Bodies<'_>, kept: &mut Kept<'_>, scratch: &mut [u32]) {
    let Kept { lists, bodies: all, pairs, .. } = kept;
    let count = all.len() - 1;
    let (mut rest, mut widest) = (scratch, 0.0);
    let middles = take_vectors(&mut rest, count);
    for (middle, body) in middles.iter_mut().zip(&all[1..]) {
        *middle = if body.is_there() { body.center } else { glam::Vec3::NAN };
        if body.is_there() && body.radius + body.leash < f32::INFINITY {
            widest = max(widest, body.radius + body.leash);
        }
    }
    let candidates: &mut [[u32; 2]] = bytemuck::cast_slice_mut(take(&mut rest, 2 * CANDIDATES * count));
    let mut found = 0;
    let report = &mut *bodies.report;
    bodies.near.pairs(middles, 2.0 * widest, &mut |row, other| {
        let [a, b] = [row.min(other) + 1, row.max(other) + 1];
        let [one, two] = [a, b].map(|number| &all[number as usize]);
        let reach = one.radius + two.radius + one.leash + two.leash;
        if !(one.moves() || two.moves()) || !(length(one.center - two.center) <= reach) {
            return;
        }
        match candidates.get_mut(found) {
            Some(place) => *place = [a, b],
            None => report.caps.contacts += 1,
        }
        found += 1;
    });
    let found = found.min(candidates.len());
    let candidates = &mut candidates[..found];
    candidates.sort_unstable();
    // The old list, beside the new one.
    let old = lists.pairs as usize;
    let room = rest.len() - rest.len() % words::<Manifold>();
    let before: &mut [Manifold] = bytemuck::cast_slice_mut(&mut rest[..room]);
    let Some(before) = before.get_mut(..old) else { return };
    before.copy_from_slice(&pairs[..old]);
    let (mut before, mut len) = (before.iter().peekable(), 0);
    for &key in &*candidates {
        while before.peek().is_some_and(|pair| pair.bodies < key) {
            before.next();
        }
        let known = before.peek().filter(|pair| pair.bodies == key);
        let [a, b] = key.map(|number| &all[number as usize]);
        let holds = known.is_some_and(|pair| pair.count > 0);
        if !holds && !are_near(a, b, a.leash + b.leash) {
            continue;
        }
        let Some(place) = pairs.get_mut(len) else {
            bodies.report.caps.contacts += 1;
            continue;
        };
        len += 1;
        *place = known.map_or_else(
            || {
                let materials = [a.material, b.material].map(|number| (number as u16).checked_sub(1));
                Manifold::of(key, of_two(bodies.materials, [a.elasticity, b.elasticity], materials))
            },
            |pair| **pair,
        );
    }
    (lists.pairs, lists.known) = (len as u32, 1);
}
