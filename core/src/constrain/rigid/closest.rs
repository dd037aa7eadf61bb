//! Where a body comes nearest to the scenery: not only its corners meet that, but edges that cross what is round, and faces.

use super::body::Body;
use super::forms::Form;
use crate::math::{dot, largest, length, max, min};
use crate::shape::{Collider, Contact};
use crate::time::Time;
use glam::Vec3;

/// How often the scenery is asked in a round where it is nearest to a place of the body, at the most, behind the first time.
const ASKED: u32 = 16;
/// Rounds at the most.
const ROUNDS: u32 = 4;
/// The share of the way to the tangent plane of the scenery that a step leaves.
const LEFT: f32 = 0.1;
/// How much nearer the two may be than the place that has been found, as a share of a length that is small beside the body.
const NEARLY: f32 = 0.05;
/// The cosine of the least angle by which the normal turns where a surface comes to be seen from its other side.
const OTHER_SIDE: f32 = -0.9;
/// By how much the normals of what is round differ in two places at the least.
const TURNED: f32 = 1e-5;

/// A place of the scenery and the place on a piece of a body that is nearest to it, in its frame.
#[derive(Clone, Copy)]
pub(super) struct Near {
    pub(super) contact: Contact,
    pub(super) on: Vec3,
    /// How deep the body has gone into it \[m\], or zero.
    pub(super) depth: f32,
    /// True if the normal is another there than where the scenery is nearest to the body's middle: what is flat is the same everywhere.
    pub(super) turned: bool,
}

/// A piece of a body among the scenery.
pub(super) struct Over<'a> {
    pub(super) form: &'a Form<'a>,
    pub(super) body: &'a Body,
    pub(super) colliders: &'a dyn Collider,
    pub(super) at: Time,
    /// The triangles of a mesh that are one part of the scenery: those that begin where one of them is nearest to the body's middle.
    pub(super) faces: &'a [u32],
}

/// A place of the body in the world, and the place of the scenery that is nearest to it where that is put aside.
#[derive(Clone, Copy)]
struct Spot {
    place: Vec3,
    contact: Contact,
}

impl Over<'_> {
    /// The place where a part of the scenery, if that is convex, is nearest to the body, or the body deepest in it, from the place that is nearest to the body's
    /// middle; none if it is farther off than `reach` \[m\].
    ///
    /// It is where the two are farthest apart of all directions. Surfaces are seen from both sides, so the scenery is asked as if the body were put aside, as
    /// far along the best direction yet as the two overlap in that: there it is all beyond a tangent plane of the scenery. The place where it is nearest then
    /// tells a better direction, until none is.
    pub(super) fn closest(&self, from: Contact, reach: f32) -> Option<Near> {
        let small = self.form.small(self.body);
        let (mut spot, mut gap) = (Spot { place: from.point, contact: from }, self.gap(&from));
        if gap > reach {
            return None;
        }
        let least = NEARLY * small;
        for round in 0..ROUNDS {
            let aside = spot.contact.normal * max(small - gap, 0.0);
            let Some(begin) = self.ask(self.project(spot.contact.point - aside), aside, &spot.contact) else {
                break;
            };
            let next = self.descend(begin, aside, least);
            let farther = self.gap(&next.contact) - gap;
            if gap + farther > reach {
                return None;
            }
            // Of two that are as good the later one has been put aside along the better direction.
            if round == 0 || farther > -least {
                (spot, gap) = (next, gap + farther);
            }
            if aside == Vec3::ZERO || round > 0 && !(farther > least) {
                break;
            }
        }
        let (on, ..) = self.form.nearest(self.body, self.body.place(spot.place));
        let rounding = f32::EPSILON * largest(from.point) / small;
        let turned = length(spot.contact.normal - from.normal) > TURNED + 4.0 * rounding;
        Some(Near { contact: spot.contact, on, depth: max(-gap, 0.0), turned })
    }

    /// Goes to the place of the body put aside that is nearest to the scenery. How far off that is is convex over the body: it is minimised by projected
    /// gradients with the steps of Barzilai and Borwein ("Two-Point Step Size Gradient Methods", IMA J. Numer. Anal. 8, 1988). No place of the body is nearer
    /// along a normal than its farthest corner against that (Frank and Wolfe, Naval Res. Logist. Q. 3, 1956), which tells where to end.
    fn descend(&self, from: Spot, aside: Vec3, least: f32) -> Spot {
        let longest = 4.0 * length(self.form.half(self.body));
        let (mut spot, mut best, mut step) = (from, from, longest);
        for _ in 0..ASKED {
            let Contact { normal, distance, .. } = spot.contact;
            if dot(normal, spot.place - self.farthest(normal)) <= least {
                return spot;
            }
            let way = self.project(spot.place - normal * step) - spot.place;
            let share = min((1.0 - LEFT) * distance / max(-dot(normal, way), f32::MIN_POSITIVE), 1.0);
            let Some(next) = self.ask(spot.place + way * share, aside, &spot.contact) else { break };
            let (way, turned) = (next.place - spot.place, next.contact.normal - normal);
            let (square, bent) = (dot(way, way), dot(way, turned));
            step = if bent > 0.0 { min(square / bent, longest) } else { longest };
            best = if next.contact.distance < best.contact.distance { next } else { best };
            spot = next;
        }
        best
    }

    /// Asks for the place of the scenery nearest to a place of the body put aside, of the part of it that another place is on, and as seen from that side
    /// of it.
    fn ask(&self, place: Vec3, aside: Vec3, other: &Contact) -> Option<Spot> {
        let Contact { point, normal, .. } = *other;
        let at = place + aside;
        // What is flat goes on in its plane.
        let foot = at - normal * dot(normal, at - point);
        let mut nearest = None::<(f32, Contact)>;
        // No farther than the other place is, but for rounding.
        let reach = length(at - point) + self.form.small(self.body);
        self.colliders.contacts_of(self.faces, at, reach, self.at, &mut |contact| {
            let far = match self.faces {
                [_, _, ..] => contact.distance,
                _ => min(length(contact.point - point), length(contact.point - foot)),
            };
            let is_nearer = nearest.is_none_or(|(least, _)| far < least);
            if is_nearer && dot(contact.normal, normal) > OTHER_SIDE {
                nearest = Some((far, *contact));
            }
        });
        nearest.map(|(_, contact)| Spot { place, contact })
    }

    /// How far the body is off the tangent plane of the scenery at a place \[m\].
    pub(super) fn gap(&self, contact: &Contact) -> f32 {
        dot(contact.normal, self.farthest(contact.normal) - contact.point)
    }

    /// The corner of the body that is farthest against a direction, in the world.
    fn farthest(&self, normal: Vec3) -> Vec3 {
        self.body.point(self.form.farthest(self.body, -(self.body.rotation.transpose() * normal)))
    }

    /// The place of the body that is nearest to one in the world.
    fn project(&self, place: Vec3) -> Vec3 {
        let (on, _, out) = self.form.nearest(self.body, self.body.place(place));
        if out > 0.0 { self.body.point(on) } else { place }
    }
}
