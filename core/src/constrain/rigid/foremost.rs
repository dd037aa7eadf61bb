//! Where a face of a body first meets what is round: a sphere is nearest to the body's middle in another place than that on which a face lies.

use super::body::Body;
use super::forms::Form;
use crate::math::{dot, largest, length, max, min, sqrt};
use crate::shape::{Collider, Contact};
use crate::time::Time;
use glam::Vec3;

/// The tangent of half the angle up to which a face and what it is on lie alike.
const ALIKE: f32 = 1e-4;
/// The least step that tells more than rounding, as a share of the body's size.
const LEAST: f32 = 1e-5;
/// By how much the normals of what is round differ in two places at the least.
const TURNED: f32 = 1e-5;
/// By how much steps get shorter at the least.
const SHORTER: f32 = 0.995;
/// How often steps are taken for the first of a row that gets shorter alike.
const ROWS: u32 = 2;

/// A place of the scenery as a body sees it: where that is next to it on a piece, the way out there, and how far apart they are \[m\].
#[derive(Clone, Copy)]
pub(super) struct Seen {
    pub(super) contact: Contact,
    pub(super) on: Vec3,
    pub(super) out: Vec3,
    pub(super) distance: f32,
}

impl Seen {
    /// A place as seen from a piece of a body.
    pub(super) fn of(form: &Form<'_>, body: &Body, contact: Contact) -> Self {
        let (on, out, distance) = form.nearest(body, body.place(contact.point));
        Self { contact, on, out, distance }
    }

    /// The direction in which the scenery would press on the body there.
    pub(super) fn normal(&self, body: &Body) -> Vec3 {
        body.rotation * -self.out
    }

    /// The tangent of half the angle between the body's surface and the scenery's: what is round rises by that share of how far away it is highest.
    pub(super) fn leans(&self, body: &Body) -> f32 {
        let cosine = dot(self.normal(body), self.contact.normal);
        sqrt(max(1.0 - cosine, 0.0) / max(1.0 + cosine, f32::EPSILON))
    }
}

/// A piece of a body among the scenery.
pub(super) struct Over<'a> {
    pub(super) form: &'a Form<'a>,
    pub(super) body: &'a Body,
    pub(super) colliders: &'a dyn Collider,
    pub(super) at: Time,
}

impl Over<'_> {
    /// The place that a face meets first, from one that is nearest to the body's middle, and whether that is another.
    ///
    /// That is the one nearest to the face from far above. From a sphere of radius R seen from a height H steps there get shorter by R / (R + H), so that two of them
    /// tell where they end (Steffensen's method).
    pub(super) fn foremost(&self, from: Seen) -> (Seen, bool) {
        let mut best = from;
        if !(from.leans(self.body) > ALIKE) {
            return (best, false);
        }
        let size = length(self.form.half(self.body));
        let least = LEAST * size + 4.0 * f32::EPSILON * largest(from.contact.point);
        for _ in 0..ROWS {
            let Some(next) = self.next(&best, best.contact.point, size) else { break };
            let Some(last) = self.next(&next, next.contact.point, size) else { break };
            let [first, second] = [next.contact.point - best.contact.point, last.contact.point - next.contact.point];
            let shorter = length(second) / length(first);
            // What is flat has one normal everywhere, and along what is straight steps stay as long as they are.
            let turned = length(next.contact.normal - best.contact.normal);
            if !(length(first) > least && turned > TURNED && shorter < SHORTER) {
                break;
            }
            let ahead = min(shorter / (1.0 - shorter), 2.0 * size / length(second));
            let end = if ahead.is_finite() { last.contact.point + second * ahead } else { last.contact.point };
            let (before, end) = (best.distance, self.next(&last, end, size));
            for seen in [Some(next), Some(last), end].into_iter().flatten() {
                best = if seen.distance < best.distance && dot(seen.out, from.out) > 0.0 { seen } else { best };
            }
            if !(best.distance < before) {
                break;
            }
        }
        (best, best.distance < from.distance)
    }

    /// The place nearest to one above the face, of the same part of the scenery.
    fn next(&self, seen: &Seen, place: Vec3, above: f32) -> Option<Seen> {
        let (on, ..) = self.form.nearest(self.body, self.body.place(place));
        let eye = self.body.point(on) + seen.normal(self.body) * above;
        let mut nearest = None::<(f32, Contact)>;
        self.colliders.contacts(
            eye,
            above + 2.0 * length(self.body.point(on) - place) + seen.distance.abs(),
            self.at,
            &mut |contact| {
                let far = length(contact.point - place);
                if nearest.is_none_or(|(least, _)| far < least) {
                    nearest = Some((far, *contact));
                }
            },
        );
        nearest.map(|(_, contact)| Seen::of(self.form, self.body, contact))
    }
}
