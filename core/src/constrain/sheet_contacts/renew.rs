//! Making lists of who may come near whom, and telling for how long they are good.

use super::super::{Bodies, Substep};
use super::bounds::ROUNDING;
use super::closest::{FARTHEST, MARGIN};
use super::listing::Listing;
use super::lists::{Kept, Work};
use super::near::{FULL, Facts, Near, pushed};
use super::rest::Rest;
use super::tree::Ways;
use crate::lanes::{ABREAST, LANES};
use crate::math::{dot, largest, length, max, sqrt};
use glam::Vec3;

/// How far a particle goes on average, as seen from all, until lists end, as a multiple of how far one may be pushed between
/// searches.
const STRETCH: f32 = 16.0;
/// One triangle of so many may be astray before lists are given up.
const ASTRAY: usize = 4;

impl Near<'_> {
    /// How far off its expected way one is at both ends of a sub-step that comes so many after the first.
    fn off(&self, i: usize, since: f32, [from, now]: [Vec3; 2]) -> [Vec3; 2] {
        let (base, going) = (self.base[i], self.going[i]);
        [from - (base + going * since), now - (base + going * (since + 1.0))]
    }

    /// How far off all are on average, which brings nobody near anybody.
    fn shared(&self, work: &Work<'_>, since: f32) -> [Vec3; 2] {
        let ([mut begun, mut ended], mut count) = ([Vec3::ZERO; 2], 0.0);
        for (i, (&from, &now)) in work.from.iter().zip(&*work.now).enumerate() {
            let off = self.off(i, since, [from, now]);
            if off[0].is_finite() && off[1].is_finite() {
                (begun, ended, count) = (begun + off[0], ended + off[1], count + 1.0);
            }
        }
        [begun, ended].map(|sum| sum / max(count, 1.0))
    }

    /// Notes how far each has left the expected way, as seen from all, and whose triangles are astray; returns how many these are. None: the
    /// lists are no longer good for the sub-step.
    fn follow(&self, rest: &Rest<'_>, work: &mut Work<'_>, substep: Substep, drift: Vec3) -> Option<usize> {
        let Facts { first, horizon, skin, .. } = *self.facts;
        let since = substep.number.checked_sub(first).filter(|&since| since < horizon)? as f32;
        let all = self.shared(work, since);
        let shared = max(largest(all[0]), largest(all[1]));
        let square = |i: usize, ends: [Vec3; 2]| {
            let off = self.off(i, since, ends);
            let (begun, ended) = (off[0] - all[0], off[1] - all[1]);
            max(dot(begun, begun), dot(ended, ended))
        };
        Some(self.mark(rest, work, drift, [skin, shared], square))
    }

    /// The same by how far all have been pushed since those were listed that are close.
    pub(super) fn follow_close(&self, rest: &Rest<'_>, work: &mut Work<'_>, drift: Vec3) -> usize {
        let square = |i: usize, [_, now]: [Vec3; 2]| {
            let off = now - self.base[i];
            dot(off, off)
        };
        self.mark(rest, work, drift, [pushed(rest), 0.0], square)
    }

    /// Notes how far each is off, of which it is told the square, and whose triangles are astray: by more than a skin; returns how many these are.
    fn mark(
        &self,
        rest: &Rest<'_>,
        work: &mut Work<'_>,
        drift: Vec3,
        [skin, shared]: [f32; 2],
        square: impl Fn(usize, [Vec3; 2]) -> f32,
    ) -> usize {
        let farthest = FARTHEST * rest.facts.budget;
        for (i, stray) in work.strays.iter_mut().enumerate() {
            let (from, now) = (work.from[i], work.now[i]);
            let (square, way) = (square(i, [from, now]), now - from - drift);
            let sound = dot(way, way) <= farthest * farthest && square < f32::INFINITY;
            let slack = ROUNDING * max(max(largest(from), largest(now)), shared);
            *stray = if sound { sqrt(square) + slack } else { f32::INFINITY };
            // Who was not there, and is not, has nobody near.
            if !(self.base[i].is_finite() || from.is_finite() && now.is_finite()) {
                *stray = 0.0;
            }
        }
        work.tree.mark(rest.faces, |face| {
            let stray = |i: u32| work.strays.get(i as usize).copied().unwrap_or(0.0);
            let most = face.corners.iter().fold(0.0, |most, &i| max(stray(i), most));
            if most <= skin { most } else { f32::INFINITY }
        })
    }

    /// Makes lists for the sub-steps to come: for fewer of them, if there is no room for more. Tells whether there is.
    ///
    /// Everyone is expected halfway between two ways: that by its `velocity` as the sub-step began, on which contacts keep what they hold, and that which
    /// it goes in the sub-step, as what nothing holds goes on.
    fn make(
        &mut self,
        rest: (&Rest<'_>, Option<f32>),
        work: &mut Work<'_>,
        (substep, drift): (Substep, Vec3),
        velocity: impl Fn(usize) -> Vec3,
    ) -> bool {
        let (mut way, mut count) = (0.0, 0.0);
        for (i, (base, going)) in self.base.iter_mut().zip(&mut *self.going).enumerate() {
            *base = work.from[i];
            *going = 0.5 * (work.now[i] - work.from[i] + velocity(i) * substep.seconds());
            if going.is_finite() {
                way += length(*going - drift);
                count += 1.0;
            }
        }
        let left = substep.count - substep.number;
        let most = (STRETCH * rest.0.facts.budget * count / way).clamp(1.0, left as f32) as u32;
        let skin = self.facts.skin;
        for (horizon, skin) in [(most, skin), (1, 0.25 * skin)] {
            *self.facts = Facts { first: substep.number, horizon, skin, ..bytemuck::Zeroable::zeroed() };
            if let Some(pairs) = self.fill(rest, work) {
                self.facts.pairs = pairs as u32;
                return true;
            }
        }
        *self.facts = Facts { horizon: 0, state: FULL, ..*self.facts };
        false
    }

    /// Lists whoever may come near each other; returns how many pairs there are. None: there is no room.
    fn fill(&mut self, (rest, uniform): (&Rest<'_>, Option<f32>), work: &mut Work<'_>) -> Option<usize> {
        let Facts { horizon, skin, .. } = *self.facts;
        let ahead = horizon as f32;
        for (end, (base, going)) in work.searched.iter_mut().zip(self.base.iter().zip(&*self.going)) {
            *end = *base + *going * ahead;
        }
        let ways = Ways { from: self.base, to: work.searched };
        work.tree.fit((rest, uniform), ways, |half| (half + rest.facts.budget) * (1.0 + MARGIN) + skin);
        let mut listing = Listing::of((rest, uniform), ways, 2.0 * skin, self.pairs);
        work.tree.pairs(rest.faces, true, |pair, corners| listing.add(pair, corners));
        listing.finish()
    }
}

/// Has lists that are good for where all are now, and the triangles marked that are astray; returns how many these are. None: there are no lists.
pub(super) fn ready(
    rest: &Rest<'_>,
    kept: &mut Kept<'_>,
    work: &mut Work<'_>,
    bodies: &mut Bodies<'_>,
    drift: Vec3,
) -> Option<usize> {
    let substep = bodies.substep;
    let uniform = kept.counts.uniform();
    let Kept { near, rows, .. } = kept;
    let near = near.as_mut()?;
    let few = |astray: &usize| astray * ASTRAY <= rest.faces.len();
    if near.facts.is_close() {
        let astray = Some(near.follow_close(rest, work, drift)).filter(few);
        if astray.is_none() {
            near.part();
        }
        return astray;
    }
    if near.facts.is_full() || near.facts.is_lost() {
        return None;
    }
    match near.follow(rest, work, substep, drift) {
        Some(astray) if few(&astray) => return Some(astray),
        Some(_) if ABREAST == LANES => {
            near.lose();
            return None;
        }
        _ => {}
    }
    let velocity = |i: usize| bodies.before[1].get(rows[i] as usize).copied().unwrap_or(Vec3::ZERO);
    if !near.make((rest, uniform), work, (substep, drift), velocity) {
        return None;
    }
    bodies.report.effort.lists += 1;
    near.follow(rest, work, substep, drift)
}
