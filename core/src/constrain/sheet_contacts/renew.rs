//! Making lists of who may come near whom, and telling for how long they are good.

use super::super::{Bodies, Substep};
use super::closest::{Closest, Kind, apart};
use super::lists::{Kept, Work};
use super::near::{Facts, Listed, MARGIN, Near};
use super::pair::{Pair, are_apart, seen};
use super::rest::{Face, Rest};
use super::tree::{ROUNDING, Ways};
use crate::math::{dot, largest, length, max, min, sqrt};
use glam::Vec3;

/// How far anyone may leave the expected way, as a multiple of how far one may be pushed between searches.
const SKIN: f32 = 2.0;
/// How far a particle goes on average, as seen from all, until lists end, as a multiple of the same.
const STRETCH: f32 = 16.0;
/// One triangle of so many may be astray before lists are made anew.
const ASTRAY: usize = 4;
/// How far one that is not astray goes in a sub-step, as seen from all, as a multiple of the same: so far no pair can be followed in vain that
/// is as far apart as it is looked for (see `closest::STEPS`).
const FARTHEST: f32 = 50.0;
impl Near<'_> {
    /// Notes how far each has left the expected way, and whose triangles are astray; returns how many these are. None: the lists are no longer
    /// good for the sub-step.
    fn follow(&self, rest: &Rest<'_>, work: &mut Work<'_>, substep: Substep, drift: Vec3) -> Option<usize> {
        let Facts { first, horizon, skin, .. } = *self.facts;
        let since = substep.number.checked_sub(first).filter(|&since| since < horizon)? as f32;
        let farthest = FARTHEST * rest.facts.budget;
        for (i, stray) in work.strays.iter_mut().enumerate() {
            let (from, now) = (work.from[i], work.now[i]);
            let (base, going) = (self.base[i], self.going[i]);
            let (begun, way) = (from - (base + going * since), now - from - drift);
            let ended = now - (base + going * (since + 1.0));
            let square = max(dot(begun, begun), dot(ended, ended));
            let sound = dot(way, way) <= farthest * farthest && square < f32::INFINITY;
            let slack = ROUNDING * max(largest(from), largest(now));
            *stray = if sound { sqrt(square) + slack } else { f32::INFINITY };
            // Who was not there, and is not, has nobody near.
            if !(base.is_finite() || from.is_finite() && now.is_finite()) {
                *stray = 0.0;
            }
        }
        Some(work.tree.mark(rest.faces, |face| {
            face.corners.iter().any(|&i| work.strays.get(i as usize).is_some_and(|&stray| !(stray <= skin)))
        }))
    }

    /// Makes lists for the sub-steps to come: for fewer of them, if there is no room for more. Tells whether there is.
    fn make(&mut self, rest: &Rest<'_>, work: &mut Work<'_>, substep: Substep, drift: Vec3) -> bool {
        let (mut way, mut count) = (0.0, 0.0);
        for (i, (base, going)) in self.base.iter_mut().zip(&mut *self.going).enumerate() {
            *base = work.from[i];
            *going = work.now[i] - work.from[i];
            if going.is_finite() {
                way += length(*going - drift);
                count += 1.0;
            }
        }
        let left = substep.count - substep.number;
        let most = (STRETCH * rest.facts.budget * count / way).clamp(1.0, left as f32) as u32;
        let skin = SKIN * rest.facts.budget;
        for horizon in [most, 1] {
            *self.facts = Facts { first: substep.number, horizon, pairs: 0, full: 0, skin };
            match self.fill(rest, work, drift) {
                Some(pairs) => {
                    self.facts.pairs = pairs as u32;
                    return true;
                }
                None if horizon == 1 => break,
                None => {}
            }
        }
        *self.facts = Facts { horizon: 0, full: 1, ..*self.facts };
        false
    }

    /// Lists whoever may come near each other; returns how many pairs there are. None: there is no room.
    fn fill(&mut self, rest: &Rest<'_>, work: &mut Work<'_>, drift: Vec3) -> Option<usize> {
        let Facts { horizon, skin, .. } = *self.facts;
        let (ahead, skins) = (horizon as f32, 2.0 * skin);
        for (end, (base, going)) in work.searched.iter_mut().zip(self.base.iter().zip(&*self.going)) {
            *end = *base + *going * ahead;
        }
        let ways = Ways { from: self.base, to: work.searched, drift: drift * ahead };
        let half = |face: &Face| (rest.widest(face) + rest.facts.budget) * (1.0 + MARGIN) + skin;
        work.tree.fit(rest.faces, ways, half);
        let mut count = 0;
        work.tree.pairs(true, |i, j| {
            let reach = half(&rest.faces[i]) + half(&rest.faces[j]);
            Pair::all(rest.faces, [i, j], work.tree.corners(), reach, |pair, corners| {
                if let Some(listed) = expected(rest, &ways, pair, corners, skins) {
                    if let Some(place) = self.pairs.get_mut(count) {
                        *place = listed;
                    }
                    count += 1;
                }
            });
        });
        (count <= self.pairs.len()).then_some(count)
    }
}

/// Two as they are listed, unless they are farther from each other than they are looked for, and so much more, on the expected ways.
fn expected(rest: &Rest<'_>, ways: &Ways<'_>, pair: Pair, corners: [u32; 4], more: f32) -> Option<Listed> {
    let kind = pair.kind();
    let ends = [seen(ways.from, corners), seen(ways.to, corners)];
    let far = |wanted: f32| rest.reach(wanted) * (1.0 + MARGIN) + more;
    let reach = far(rest.thickness(kind, corners));
    if are_apart(kind, &ends, reach) {
        return None;
    }
    // Most are neighbours in a sheet, which the direction between their middles keeps apart.
    if parts(kind, &ends, middle(kind, &ends[0]), reach) {
        return None;
    }
    let mut apart = least(kind, &ends, 0);
    if apart < reach {
        apart = max(least(kind, &ends, 1), apart);
    }
    if apart >= reach {
        return None;
    }
    let wanted = rest.wanted(kind, corners);
    (!(apart >= far(wanted))).then_some(Listed { pair, apart, wanted })
}

/// The way from the middle of the second thing to that of the first, some times over.
fn middle(kind: Kind, [a, b, c, d]: &[Vec3; 4]) -> Vec3 {
    match kind {
        Kind::PointTriangle => *a * 3.0 - (*b + *c + *d),
        Kind::EdgeEdge => (*a + *b) - (*c + *d),
    }
}

/// Tells whether two things are farther than `reach` apart along a way of any length, at both ends.
fn parts(kind: Kind, ends: &[[Vec3; 4]; 2], way: Vec3, reach: f32) -> bool {
    let far = min(apart(kind, &ends[0], way), apart(kind, &ends[1], way));
    far > 0.0 && far * far > reach * reach * dot(way, way)
}

/// How far apart two things stay at the least, as the direction tells that is between them at one of both ends \[m\].
fn least(kind: Kind, ends: &[[Vec3; 4]; 2], at: usize) -> f32 {
    let gap = Closest::of(kind, ends[at]).gap;
    let direction = gap / length(gap);
    let all = min(apart(kind, &ends[0], direction), apart(kind, &ends[1], direction));
    if all > 0.0 { all } else { 0.0 }
}

/// Has lists that are good for where all are now, and the triangles marked that are astray; returns how many these are. None: there is no room
/// for lists.
pub(super) fn ready(
    rest: &Rest<'_>,
    kept: &mut Kept<'_>,
    work: &mut Work<'_>,
    bodies: &mut Bodies<'_>,
    drift: Vec3,
) -> Option<usize> {
    let substep = bodies.substep;
    let near = kept.near.as_mut().filter(|near| near.facts.full == 0)?;
    match near.follow(rest, work, substep, drift) {
        Some(astray) if astray * ASTRAY <= rest.faces.len() => return Some(astray),
        _ => {}
    }
    if !near.make(rest, work, substep, drift) {
        return None;
    }
    bodies.report.effort.lists += 1;
    near.follow(rest, work, substep, drift)
}
