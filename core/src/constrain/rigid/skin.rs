//! The surface of bodies of several pieces: of what touches a piece only what is on the outside of all of them counts, so that nothing is caught by
//! the seams between them.

use super::body::Body;
use super::forms::{Form, Forms};
use super::manifold::Manifold;
use crate::math::{dot, min};
use glam::Vec3;

/// How far off a piece a place is held against the others, as a share of its least half side.
const OFF: f32 = 0.02;
/// How near another piece may be to a place off an edge or corner, as a share of how far off that is: the cosine of some 8°.
const NEARER: f32 = 0.99;
/// By how much of the way to the middle of a face its corners are drawn in.
const WITHIN: f32 = 0.05;
/// The cosine of the angle within which a direction is that of a face.
const ALONG: f32 = 0.9999;

/// Tells whether two touch at the surface of both: at one place at least, if it has several.
pub(super) fn meets(manifold: &Manifold, bodies: [&Body; 2], forms: Forms<'_>) -> bool {
    let [a, b] = bodies;
    let normal = manifold.normal;
    let outward = [normal, -(b.rotation.transpose() * (a.rotation * normal))];
    (0..2).all(|side| {
        let whose = (manifold.bodies[side], manifold.pieces[side]);
        let shows = |place: Vec3| shows(forms, bodies[side], whose, [place, outward[side]]);
        forms.count(whose.0) == 1 || manifold.points().iter().any(|point| shows(point.places[side]))
    })
}

/// Tells whether a place on a piece of a body, told by their numbers, is on the surface of all its pieces as seen from a direction: no other is
/// nearer to where that leads. All of a face counts as such unless others cover it wholly, and so do its sides.
pub(super) fn shows(forms: Forms<'_>, body: &Body, (number, piece): (u32, u8), [on, out]: [Vec3; 2]) -> bool {
    let Form::Piece(hull) = forms.piece(number, piece) else { return true };
    let Vec3 { x, y, z } = hull.half();
    let off = OFF * min(x, min(y, z));
    let others = || (0..forms.count(number)).filter(|&other| other != piece).map(|other| forms.piece(number, other));
    let is_near = |place: Vec3, far: f32| {
        others().any(|other| may_be_near(&other, place, far) && other.nearest(body, place).2 < far)
    };
    let Some(face) = hull.faces.iter().find(|face| dot(face.normal, out) > ALONG) else {
        return !is_near(on + out * off, NEARER * off);
    };
    let corners = hull.polygon(face);
    let middle = corners.clone().sum::<Vec3>() / f32::from(face.count);
    let within = corners.map(|corner| corner + (middle - corner) * WITHIN).chain([middle]);
    within.map(|place| hull.center + place + face.normal * off).any(|place| !is_near(place, 0.0))
}

/// Tells whether a place may be so near a piece \[m\].
fn may_be_near(form: &Form<'_>, place: Vec3, far: f32) -> bool {
    let Form::Piece(hull) = form else { return true };
    ((place - hull.center).abs() - hull.half()).cmple(Vec3::splat(far)).all()
}
