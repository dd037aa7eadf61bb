//! Creases, in which surfaces meet that something leans on at once.

use super::Contact;
use crate::math::{along, dot, is_zero, length, minus, plus, scaled, unit};
use glam::Vec3;

/// The largest number of surfaces that something leans on in a crease.
const MOST: usize = 4;

/// The least square of the sine between two surfaces: others are one.
const FLAT: f32 = 1e-6;

/// The largest cosine between two surfaces of a crease: from one side of those that open farther to the other nobody is driven for long.
const OPEN: f32 = 0.7;

/// The largest cosine between two surfaces that stand at right angles: whoever leans on an edge from the side of a surface is farther aside.
const SQUARE: f32 = 0.05;

/// How far a place on one surface may seem to be off another by rounding \[slacks\].
const LEVEL: f32 = 0.5;

/// The share of an acceleration that may lead into a surface by rounding.
const ROUNDING: f32 = 1e-4;

/// A line in which two surfaces meet, or a corner of more, that something leans into: all that drives it into them they bear, as they stand still.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crease {
    /// The unit vector along the line; zero in a corner, from which nothing leads on.
    pub along: Vec3,
    /// Two of the surfaces, those of the line.
    pub sides: [Contact; 2],
    /// How hard each of them presses back \[m/s²\], and from how hard the other would be pressed alone \[m/s²\]: what slides along the one comes to the other
    /// with that acceleration.
    pub pressing: [f32; 2],
    /// See `pressing`.
    pub closing: [f32; 2],
}

/// Surfaces that something leans on at once.
pub(crate) struct Leans {
    on: heapless::Vec<Contact, MOST>,
    /// True if there are more of them, or one moves.
    are_others: bool,
}

impl Leans {
    pub(crate) const NONE: Self = Self { on: heapless::Vec::new(), are_others: false };

    /// Leans on one more, but not on an edge of a surface on which it leans, as those are of the triangles of a mesh.
    pub(crate) fn add(&mut self, contact: &Contact) {
        self.are_others |= !is_zero(contact.velocity);
        if self.on.iter().any(|other| is_edge(contact, other)) {
            return;
        }
        self.on.retain(|other| !is_edge(other, contact));
        self.are_others |= self.on.push(*contact).is_err();
    }

    /// The crease that an acceleration presses it into: that along which no third surface is in the way of what is left of it. The sharpest of all, if that is not known.
    pub(crate) fn crease(&self, acceleration: Option<Vec3>) -> Option<Crease> {
        match acceleration {
            _ if self.are_others => None,
            Some(acceleration) => self.pressed(acceleration),
            None => self.sharpest(),
        }
    }

    #[inline(never)]
    fn pressed(&self, acceleration: Vec3) -> Option<Crease> {
        let (on, mut corner) = (&self.on[..], None);
        for (i, a) in on.iter().enumerate() {
            for b in &on[..i] {
                if closing(a, b, acceleration).is_none() {
                    continue;
                }
                let line = unit(a.normal.cross(b.normal));
                let left = scaled(line, dot(line, acceleration));
                let mut others = on.iter().filter(|other| ![a.normal, b.normal].contains(&other.normal));
                if others.all(|other| !leads_into(left, other)) {
                    return between(a, b, line, acceleration);
                }
                corner = Some([a, b]);
            }
        }
        // It may lean on one of them alone.
        let slides = |on_one: &Contact| {
            let left = along(acceleration, on_one.normal, -dot(acceleration, on_one.normal));
            leads_into(acceleration, on_one) && on.iter().all(|other| !leads_into(left, other))
        };
        corner.filter(|_| !on.iter().any(slides)).and_then(|[a, b]| between(a, b, Vec3::ZERO, acceleration))
    }

    /// The sharpest crease, pressed into both sides alike.
    #[inline(never)]
    fn sharpest(&self) -> Option<Crease> {
        let (mut sharpest, mut least) = (None, OPEN);
        for (i, a) in self.on.iter().enumerate() {
            for b in &self.on[..i] {
                let cosine = dot(a.normal, b.normal);
                if cosine < least {
                    (sharpest, least) = (Some([a, b]), cosine);
                }
            }
        }
        let [a, b] = sharpest?;
        let into = scaled(plus(a.normal, b.normal), -1.0);
        between(a, b, unit(a.normal.cross(b.normal)), into)
    }
}

/// The crease between two surfaces that leads along such a line, if both are pressed.
fn between(a: &Contact, b: &Contact, along: Vec3, acceleration: Vec3) -> Option<Crease> {
    let closing = closing(a, b, acceleration)?;
    let cosine = dot(a.normal, b.normal);
    let across = 1.0 - cosine * cosine;
    Some(Crease { along, sides: [*a, *b], pressing: closing.map(|closing| closing / across), closing })
}

/// How hard either of two surfaces that meet would be pressed by what slides along the other \[m/s²\], if both are pressed.
fn closing(a: &Contact, b: &Contact, acceleration: Vec3) -> Option<[f32; 2]> {
    let cosine = dot(a.normal, b.normal);
    let across = 1.0 - cosine * cosine;
    let [on_a, on_b] = [a, b].map(|side| -dot(acceleration, side.normal));
    let closing = [on_a - cosine * on_b, on_b - cosine * on_a];
    let are_two = across > FLAT && cosine < OPEN;
    (are_two && closing[0] > 0.0 && closing[1] > 0.0).then_some(closing)
}

/// Tells whether one is the same surface as another, or an edge of that: what leans on it does so at a place of the other, or past its end.
fn is_edge(one: &Contact, of: &Contact) -> bool {
    let cosine = dot(one.normal, of.normal);
    cosine > SQUARE && 1.0 - cosine * cosine <= FLAT || is_level(one, of, LEVEL)
}

/// Tells whether what leans on one does so at a place that is level with the other to so many slacks: on that it then leans as well.
pub(crate) fn is_level(one: &Contact, of: &Contact, slacks: f32) -> bool {
    let off = dot(minus(one.point, of.point), of.normal);
    dot(one.normal, of.normal) > SQUARE && off.abs() <= slacks * of.slack
}

/// Tells whether what is left of an acceleration leads into a surface by more than rounding.
fn leads_into(left: Vec3, side: &Contact) -> bool {
    dot(left, side.normal) < -ROUNDING * length(left)
}
