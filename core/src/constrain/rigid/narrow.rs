//! Where two bodies touch that are near each other: the narrow phase.

use super::beside::Gaps;
use super::body::Body;
use super::boxes::{Oriented, touching};
use super::facets::{Apart, Spots, four};
use super::forms::{Form, Forms, with_hulls};
use super::manifold::{Manifold, POINTS, Point};
use super::skin;
use crate::math::{length, min};

impl Manifold {
    /// Looks where two bodies touch that are not both boxes, or will when they have gone `reach` \[m\] against each other.
    pub(super) fn find(&mut self, [a, b]: [&Body; 2], all: Forms<'_>, reach: f32) {
        let forms = [0, 1].map(|side| all.piece(self.bodies[side], self.pieces[side]));
        self.find_pieces([a, b], forms, reach);
        if self.count > 0 && !skin::meets(self, [a, b], all) {
            self.count = 0;
        }
    }

    /// The same of a piece of each, whatever others there are.
    fn find_pieces(&mut self, [a, b]: [&Body; 2], forms: [Form<'_>; 2], reach: f32) {
        let [form, other] = forms;
        let small = min(form.small(a), other.small(b));
        if let Form::Ball = other {
            let (on, out, far) = form.nearest(a, a.place(b.center));
            let gap = far - b.radius;
            if gap > reach + small {
                self.part(gap);
                return;
            }
            let before = self.begin(small);
            self.normal = out;
            self.put([on, a.rotation * out * -b.radius], &before, f32::INFINITY, &a.rotation);
            return;
        }
        // Bodies farther apart than this are let go for as long as they stay so.
        let (far, mut is_found) = (f32::MAX, false);
        with_hulls([a, b], forms, far, &mut |apart, features| {
            is_found = true;
            self.meet([a, b], apart, [reach, small], &mut |reach, spots| apart.touching(features, reach, spots));
        });
        if !is_found {
            self.part(0.0);
        }
    }

    /// The same of two boxes, of which is known how they are apart; none: not at all.
    pub(super) fn find_boxes(&mut self, [a, b]: [&Body; 2], (gaps, lane): (&Gaps, usize), reach: f32) {
        let small = min(a.small(), b.small());
        match gaps.gap(lane) {
            Some(gap) if gap <= reach + small => {
                let [one, other] = [Oriented::of(a), Oriented::of(b)];
                let apart = gaps.apart(lane, [&one, &other]);
                let mut find = |reach: f32, spots: &mut Spots| touching([&one, &other], &apart, reach, spots);
                self.meet([a, b], &apart, [reach, small], &mut find);
            }
            gap => self.part(gap.unwrap_or(0.0)),
        }
    }

    /// Notes that they do not touch, and are so far apart \[m\].
    fn part(&mut self, gap: f32) {
        (self.count, self.spare) = (0, gap);
    }

    /// Forgets the points, and hands them out.
    fn begin(&mut self, small: f32) -> heapless::Vec<Point, POINTS> {
        let mut before = heapless::Vec::new();
        before.extend(self.points().iter().copied());
        (self.count, self.spare) = (0, small);
        before
    }

    /// Takes the places where two touch that are apart in a way, or will when they have gone `reach` \[m\] against each other, and so far as is
    /// `small` beside them: `find` adds those that are so far apart at the most.
    fn meet(
        &mut self,
        [a, b]: [&Body; 2],
        apart: &Apart,
        [reach, small]: [f32; 2],
        find: &mut dyn FnMut(f32, &mut Spots),
    ) {
        if !(apart.gap <= reach + small) {
            self.part(apart.gap);
            return;
        }
        let before = self.begin(small);
        self.normal = a.rotation.transpose() * apart.normal;
        let mut spots = Spots::new();
        find(reach + small, &mut spots);
        for [p, q] in four(apart.normal, &spots) {
            self.put([a.place(p), b.place(q)], &before, 5.0 * small, &a.rotation);
        }
    }
}

/// Tells whether two pieces of bodies that are not both boxes are within `reach` \[m\] of each other.
pub(super) fn are_near([a, b]: [&Body; 2], forms: [Form<'_>; 2], reach: f32) -> bool {
    let [one, other] = forms;
    if matches!(one, Form::Piece(_)) || matches!(other, Form::Piece(_)) {
        // Most pieces of two bodies are far from each other.
        let way = other.middle(b) - one.middle(a);
        if !(length(way) <= length(one.half(a)) + length(other.half(b)) + reach) {
            return false;
        }
    }
    if let [form, Form::Ball] = forms {
        return form.nearest(a, a.place(b.center)).2 - b.radius <= reach;
    }
    let mut is_near = false;
    with_hulls([a, b], forms, reach, &mut |_, _| is_near = true);
    is_near
}
