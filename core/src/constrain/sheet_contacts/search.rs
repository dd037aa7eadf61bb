//! Who comes near whom in a sub-step.

use super::super::Bodies;
use super::super::contacts::Touch;
use super::closest::{Closest, Kind, Meeting};
use super::lists::{Contact, Kept, Work};
use super::rest::{Face, Rest};
use super::tree::{Bounds, Ways};
use crate::material::of_two;
use crate::math::{high, length, low, max, min};
use crate::report::Report;
use glam::Vec3;

/// How much of the distance between two each may go before it has to be looked again: less than half of it.
const SHARE: f32 = 0.45;
/// Two that come so near to each other, as a share of their thickness, have come together.
const NEAR: f32 = 0.1;
/// The share of a gap that is missing that a sub-step gives back.
const RECOVERY: f32 = 0.2;

/// Lists whatever comes near on the way from where all were to where they are now, and says how far each may be pushed from there
/// before that changes. Contacts known before keep what they have done. Returns how many would pass each other.
pub(super) fn search(rest: &Rest<'_>, kept: &mut Kept<'_>, work: &mut Work<'_>, bodies: &mut Bodies<'_>) -> u32 {
    let known = kept.counts.contacts as usize;
    work.old[..known].copy_from_slice(&kept.contacts[..known]);
    kept.counts.contacts = 0;
    let budget = rest.facts.budget;
    work.room.fill(2.0 * SHARE * budget);
    let ways = Ways { from: work.from, to: work.now, drift: drift(work) };
    let widest = |face: &Face| face.corners.iter().fold(0.0, |most, &corner| max(half(rest, corner), most));
    work.tree.fit(rest.faces, ways, |face| widest(face) + budget);
    let mut search = Search {
        rest,
        from: work.from,
        now: work.now,
        drift: ways.drift,
        room: work.room,
        contacts: kept.contacts,
        count: &mut kept.counts.contacts,
        meetings: 0,
        report: bodies.report,
    };
    work.tree.pairs(|i, j| search.triangles(&rest.faces[i], &rest.faces[j]));
    let meetings = search.meetings;
    let contacts = &mut kept.contacts[..kept.counts.contacts as usize];
    contacts.sort_unstable_by_key(Contact::key);
    kept.counts.contacts = thin(contacts, work.now) as u32;
    let contacts = &mut kept.contacts[..kept.counts.contacts as usize];
    let old = &work.old[..known];
    for contact in contacts {
        match old.binary_search_by_key(&contact.key(), Contact::key) {
            Ok(place) => (contact.touch, contact.grip) = (old[place].touch, old[place].grip),
            Err(_) => contact.touch = touch(bodies, contact.sides().map(|side| kept.rows[side] as usize)),
        }
    }
    meetings
}

/// Leaves out points at the rim of a triangle that are nearer to another one there: in a plane they are over that one, and pushes askew
/// would brake them from triangle to triangle. Returns how many contacts are left.
fn thin(contacts: &mut [Contact], now: &[Vec3]) -> usize {
    let (mut left, mut first) = (0, 0);
    while first < contacts.len() {
        let point = contacts[first].corners[0];
        let count = contacts[first..].iter().take_while(|contact| contact.corners[0] == point).count();
        let group = &contacts[first..first + count];
        // What more there is stays.
        let idle = (0..count.min(64)).fold(0u64, |idle, i| idle | u64::from(is_idle(&group[i], group, now)) << i);
        for i in 0..count {
            if i >= 64 || idle >> i & 1 == 0 {
                contacts[left] = contacts[first + i];
                left += 1;
            }
        }
        first += count;
    }
    left
}

/// Tells whether a point is nearer to another triangle that has the corner or edge of this one which it is nearest to.
fn is_idle(contact: &Contact, others: &[Contact], now: &[Vec3]) -> bool {
    let points = |contact: &Contact| contact.split == Kind::PointTriangle.split() as u32 && !contact.meets();
    let rim = || contact.corners.iter().zip(contact.weights).skip(1).filter(|&(_, weight)| weight != 0.0);
    if !points(contact) || rim().count() == 3 {
        return false;
    }
    let far = |contact: &Contact| contact.between(|i| now[i]).dot(contact.normal);
    let own = far(contact);
    others
        .iter()
        .any(|other| points(other) && rim().all(|(corner, _)| other.corners[1..].contains(corner)) && far(other) < own)
}

/// The touch of particles in two rows, which does nothing as yet.
fn touch(bodies: &Bodies<'_>, [a, b]: [usize; 2]) -> Touch {
    let of_both = [a, b].map(|row| bodies.material[row].checked_sub(1));
    let mut touch = Touch::new(of_two(bodies.materials, [bodies.elasticity[a], bodies.elasticity[b]], of_both));
    touch.begin(0.0);
    touch
}

/// The mean way of all \[m\].
fn drift(work: &Work<'_>) -> Vec3 {
    let ways = work.now.iter().zip(&*work.from).map(|(now, from)| *now - *from);
    let (sum, count) =
        ways.filter(|way| way.is_finite()).fold((Vec3::ZERO, 0.0), |(sum, count), way| (sum + way, count + 1.0));
    sum / max(count, 1.0)
}

fn half(rest: &Rest<'_>, corner: u32) -> f32 {
    rest.half.get(corner as usize).copied().unwrap_or(0.0)
}

struct Search<'m, 'r> {
    rest: &'m Rest<'r>,
    from: &'m [Vec3],
    now: &'m [Vec3],
    drift: Vec3,
    room: &'m mut [f32],
    contacts: &'m mut [Contact],
    count: &'m mut u32,
    meetings: u32,
    report: &'m mut Report,
}

impl Search<'_, '_> {
    /// The corners of one with the other, and the edges of one with those of the other, as far as they are their own, have no corner
    /// in common, and boxes around their ways are near.
    fn triangles(&mut self, one: &Face, other: &Face) {
        let [a, b] = [self.ways(one), self.ways(other)];
        let widest = |[a, b, c]: [u32; 3]| max(half(self.rest, a), max(half(self.rest, b), half(self.rest, c)));
        let reach = widest(one.corners) + widest(other.corners) + 2.0 * self.rest.facts.budget;
        self.points(one, other, &a, reach, &b);
        self.points(other, one, &b, reach, &a);
        for i in (0..3).filter(|&i| one.owns_edge(i)) {
            let ([p, q], around) = (one.edge(i), a[i].and(a[(i + 1) % 3]).wider(reach));
            for j in (0..3).filter(|&j| other.owns_edge(j)) {
                let [r, s] = other.edge(j);
                let strangers = p != r && p != s && q != r && q != s;
                if strangers && b[j].and(b[(j + 1) % 3]).overlaps(&around) {
                    self.look(Kind::EdgeEdge, [p, q, r, s], other);
                }
            }
        }
    }

    fn points(&mut self, of: &Face, with: &Face, ways: &[Bounds; 3], reach: f32, [p, q, r]: &[Bounds; 3]) {
        let (around, [a, b, c]) = (p.and(*q).and(*r).wider(reach), with.corners);
        for i in (0..3).filter(|&i| of.owns_corner(i)) {
            let corner = of.corners[i];
            if corner != a && corner != b && corner != c && ways[i].overlaps(&around) {
                self.look(Kind::PointTriangle, [corner, a, b, c], with);
            }
        }
    }

    fn ways(&self, face: &Face) -> [Bounds; 3] {
        let [a, b, c] = face.corners;
        [self.way(a), self.way(b), self.way(c)]
    }

    /// A box around the way of a particle, but for that of all together.
    fn way(&self, corner: u32) -> Bounds {
        let place = |of: &[Vec3]| of.get(corner as usize).copied().unwrap_or(Vec3::NAN);
        Bounds::EMPTY.with(place(self.from)).with(place(self.now) - self.drift)
    }

    /// How far apart two are kept: in one sheet no farther than half of what they are at rest.
    fn wanted(&self, kind: Kind, corners: [u32; 4], thickness: f32) -> f32 {
        let sheet = |corner: u32| self.rest.sheet.get(corner as usize);
        if sheet(corners[0]) != sheet(corners[kind.split()]) {
            return thickness;
        }
        let places = corners.map(|corner| self.rest.places[corner as usize] - self.rest.places[corners[0] as usize]);
        min(0.5 * length(Closest::of(kind, places).gap), thickness)
    }

    /// Lists the two if they come near, `with` being the triangle that the second belongs to.
    fn look(&mut self, kind: Kind, corners: [u32; 4], with: &Face) {
        let [first, second] = [corners[0], corners[kind.split()]];
        let (thickness, budget) = (half(self.rest, first) + half(self.rest, second), self.rest.facts.budget);
        let reach = thickness + 2.0 * budget;
        let [a, b, c, d] = corners;
        let seen = |of: &[Vec3]| {
            let place = |corner: u32| of[corner as usize] - of[a as usize];
            [place(a), place(b), place(c), place(d)]
        };
        let ends = [seen(self.from), seen(self.now)];
        if are_apart(kind, &ends, reach) {
            return;
        }
        let Some(meeting) = Meeting::of(kind, &ends, reach, NEAR * thickness) else { return };
        let thickness = self.wanted(kind, corners, thickness);
        let Meeting { closest, distance: [begun, ended], meets } = meeting;
        if !meets && ended >= thickness + 2.0 * budget {
            return;
        }
        for corner in corners {
            let room = &mut self.room[corner as usize];
            *room = min(SHARE * ended, *room);
        }
        self.meetings += u32::from(meets);
        if !meets && !is_own(kind, &closest.weights, with) {
            return;
        }
        let recovery = RECOVERY * max(thickness - begun, 0.0);
        let target = if begun < thickness { begun + recovery } else { thickness };
        let normal = closest.gap / length(closest.gap);
        if !normal.is_finite() {
            return;
        }
        match self.contacts.get_mut(*self.count as usize) {
            Some(place) => {
                let (split, weights, meets) = (kind.split() as u32, closest.weights, u32::from(meets));
                let (touch, grip) = (bytemuck::Zeroable::zeroed(), bytemuck::Zeroable::zeroed());
                *place = Contact { corners, split, weights, normal, target, recovery, meets, touch, grip };
                *self.count += 1;
            }
            None => self.report.caps.contacts += 1,
        }
    }
}

/// Tells whether boxes around two things at both ends are farther than `reach` from each other.
fn are_apart(kind: Kind, [begun, ended]: &[[Vec3; 4]; 2], reach: f32) -> bool {
    let around = |i: usize| (low(begun[i], ended[i]), high(begun[i], ended[i]));
    let join = |a: (Vec3, Vec3), b: (Vec3, Vec3)| (low(a.0, b.0), high(a.1, b.1));
    let ((a, b), (c, d)) = match kind {
        Kind::PointTriangle => (around(0), join(join(around(1), around(2)), around(3))),
        Kind::EdgeEdge => (join(around(0), around(1)), join(around(2), around(3))),
    };
    let gap = high(a - d, c - b);
    gap.x > reach || gap.y > reach || gap.z > reach
}

/// Tells whether the nearest place is the triangle's own: where others share it, they are as near, and one of them does for all. Edges
/// touch where they cross; at their ends points do.
fn is_own(kind: Kind, weights: &[f32; 4], with: &Face) -> bool {
    let [_, a, b, c] = weights.map(|weight| weight != 0.0);
    match (kind, [a, b, c]) {
        (Kind::EdgeEdge, [a, b, c]) => weights[0] != 0.0 && a && b && c,
        (_, [true, false, false]) => with.owns_corner(0),
        (_, [false, true, false]) => with.owns_corner(1),
        (_, [false, false, true]) => with.owns_corner(2),
        (_, [true, true, false]) => with.owns_edge(0),
        (_, [false, true, true]) => with.owns_edge(1),
        (_, [true, false, true]) => with.owns_edge(2),
        _ => true,
    }
}
