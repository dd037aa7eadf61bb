//! Where paths side by side meet walls.

use super::paths::{Cubics, Paths};
use crate::collide::path::MAX_CHORDS;
use crate::collide::sweep::MAX_LOOKS;
use crate::lanes::{Lanes, Vectors, max, min, negated, not};
use crate::shape::Face;

/// Where some of them meet the face.
pub(super) struct Hits<F> {
    /// Which do.
    pub(super) are: F,
    pub(super) time: F,
    pub(super) normal: Vectors<F>,
    pub(super) slack: F,
    /// Those with something else than the face.
    pub(super) beside_face: F,
}

/// The same on the paths.
pub(super) struct Meetings<F> {
    pub(super) hits: Hits<F>,
    /// Those whose place could not be told here.
    pub(super) unclear: F,
    pub(super) place: Vectors<F>,
    pub(super) begun: F,
    pub(super) chord_from: Vectors<F>,
}

/// Walls that particles meet, all the same ones or each its own.
pub(super) trait Walls<F: Lanes> {
    /// The flat face that they are, if they are no more than that.
    fn face(&self) -> Option<&Face> {
        None
    }

    /// Where balls that go along straight pieces first meet them; if all are `POINTS`, their radius is nothing.
    fn first_hits<const POINTS: bool>(&self, piece: &Segments<F>, radius: F) -> Hits<F>;

    /// The one surface that each place is within reach of.
    fn seats(&self, place: Vectors<F>, reach: F) -> Seats<F>;
}

/// Surfaces that particles may lie on, as `Contact` has them.
pub(super) struct Seats<F> {
    /// Particles that are near one surface, and no other.
    pub(super) are: F,
    pub(super) normal: Vectors<F>,
    pub(super) distance: F,
    pub(super) slack: F,
    /// Particles of which it cannot be told here.
    pub(super) unclear: F,
}

/// Straight pieces of them.
pub(super) struct Segments<F> {
    pub(super) from: Vectors<F>,
    pub(super) to: Vectors<F>,
}

impl<F: Lanes> Segments<F> {
    #[inline(always)]
    pub(super) fn at(&self, time: F) -> Vectors<F> {
        self.from + (self.to - self.from) * time
    }

    /// Where balls that go along them first meet a face; if all are `POINTS`, their radius is nothing.
    #[inline(always)]
    pub(super) fn first_hits<const POINTS: bool>(&self, face: &Face, radius: F) -> Hits<F> {
        let Self { from, to } = *self;
        let (like, [point, normal, unit]) = (radius, face.vectors());
        let (zero, one) = (like.all(0.0), like.all(1.0));
        let (point, normal, unit) =
            (Vectors::splat(like, point), Vectors::splat(like, normal), Vectors::splat(like, unit));
        let size = like.all(face.size());
        let slack = like.all(4.0 * f32::EPSILON) * (max(from.largest(), to.largest()) + radius + size);
        let (before, after) = (normal.dot(from - point), normal.dot(to - point));
        let [falls, rises] = crossed(before, after);
        let time = min(max(before / (before - after), zero), one);
        let normal = Vectors::select(falls, unit, -unit);
        let center = Hits { are: falls | rises, time, normal, slack, beside_face: zero };
        let wide = radius.simd_gt(slack);
        if POINTS || !wide.any() {
            return center;
        }
        let start = unit.dot(from - point);
        let normal = Vectors::select(start.simd_lt(zero), -unit, unit);
        let (room, closing) = (start.abs() - radius, negated(normal.dot(to - from)));
        let time = max(room, zero) / closing;
        let touched = wide & closing.simd_gt(zero) & time.simd_le(one);
        let is_first = touched & not(center.are & center.time.simd_lt(time));
        let mut hits = center;
        hits.take(is_first, Hits { are: touched, time, normal, slack, beside_face: zero });
        hits
    }
}

/// Those whose centers come from one height to another past a plane: from above, and from below.
#[inline(always)]
fn crossed<F: Lanes>(before: F, after: F) -> [F; 2] {
    let zero = before.all(0.0);
    let falls = before.simd_ge(zero) & after.simd_le(zero) & before.simd_gt(after);
    [falls, before.simd_lt(zero) & after.simd_ge(zero)]
}

impl<F: Lanes> Seats<F> {
    /// Has others besides, where there may have been any before: only one at a place is a seat. Two may be a crease.
    #[inline(always)]
    pub(super) fn join(&mut self, others: Self, are_any: &mut F) {
        let are = others.are & not(*are_any);
        self.normal = Vectors::select(are, others.normal, self.normal);
        self.distance = are.select(others.distance, self.distance);
        self.slack = are.select(others.slack, self.slack);
        self.are = (self.are & not(others.are)) | are;
        self.unclear = self.unclear | others.unclear | (others.are & *are_any);
        *are_any = *are_any | others.are;
    }
}

impl<F: Lanes> Hits<F> {
    /// Takes some from others.
    #[inline(always)]
    pub(super) fn take(&mut self, mask: F, others: Self) {
        self.are = self.are | mask;
        self.time = mask.select(others.time, self.time);
        self.normal = Vectors::select(mask, others.normal, self.normal);
        self.slack = mask.select(others.slack, self.slack);
        self.beside_face = mask.select(others.beside_face, self.beside_face);
    }
}

impl<F: Lanes> Meetings<F> {
    fn none(place: Vectors<F>, unclear: F) -> Self {
        let zero = unclear.all(0.0);
        let hits = Hits { are: zero, time: zero, normal: Vectors([zero; 3]), slack: zero, beside_face: zero };
        Self { hits, unclear, place, begun: zero, chord_from: place }
    }

    /// Takes those that chords have found before `end` to their instants on the paths.
    #[inline(always)]
    fn put_on_path<const POINTS: bool>(
        &mut self,
        paths: &Paths<F>,
        cubics: &Cubics<F>,
        walls: &impl Walls<F>,
        radius: F,
        end: F,
    ) {
        let all = |x| radius.all(x);
        let found = self.place;
        let time = cubics.crossings(&self.hits, found, [self.begun, end]);
        let place = cubics.at(time);
        let is_far = (place - found).length().simd_gt(all(16.0) * self.hits.slack) & self.hits.are;
        self.hits.time = time;
        self.place = place;
        if !is_far.any() {
            return;
        }
        // A place far along the surface from that on the chord asks for the surface there.
        let reach = (end - self.begun) * all(1.0 / 16.0);
        let [from, to] = [max(time - reach, self.begun), min(time + reach, end)];
        let begin = Vectors::select(from.simd_eq(all(0.0)), paths.x0, cubics.at(from));
        let piece = Segments { from: begin, to: Vectors::select(to.simd_eq(all(1.0)), paths.x1, cubics.at(to)) };
        let near = walls.first_hits::<POINTS>(&piece, radius);
        let are = is_far & near.are & near.normal.dot(self.hits.normal).simd_gt(all(0.0));
        self.unclear = self.unclear | (is_far & not(are));
        let nearby = piece.at(near.time);
        let height = (nearby - found).dot(self.hits.normal).abs();
        let is_flat = (near.normal - self.hits.normal).is_zero() & height.simd_le(all(0.5) * near.slack);
        let is_other = are & not(is_flat);
        self.hits.take(are, Hits { time, ..near });
        if is_other.any() {
            let time = cubics.crossings(&near, nearby, [from, to]);
            self.place = Vectors::select(is_other, cubics.at(time), self.place);
            self.hits.time = is_other.select(time, self.hits.time);
        }
    }
}

impl<F: Lanes> Paths<F> {
    /// Where those who are asked for first meet walls.
    #[inline(always)]
    pub(super) fn first_meetings<const POINTS: bool>(
        &self,
        cubics: &Cubics<F>,
        walls: &impl Walls<F>,
        radius: F,
        asked: F,
    ) -> Meetings<F> {
        match walls.face() {
            Some(face) if POINTS => self.meetings_of_points(cubics, face, asked),
            _ => self.meetings_on_chords::<POINTS>(cubics, walls, radius, asked),
        }
    }

    /// The same of points, of which it is enough to know on which side of the face each chord ends.
    #[inline(always)]
    fn meetings_of_points(&self, cubics: &Cubics<F>, face: &Face, asked: F) -> Meetings<F> {
        let (all, zero) = (|x| asked.all(x), asked.all(0.0));
        let chords = asked.select(cubics.chords(), all(1.0));
        let unclear = chords.simd_gt(all(MAX_CHORDS as f32));
        let [point, normal, _] = face.vectors();
        let (point, normal) = (Vectors::splat(asked, point), Vectors::splat(asked, normal));
        let most = crate::math::max(chords.largest_lane(), 1.0);
        let (mut before, mut are, mut begun) = (normal.dot(self.x0 - point), zero, zero);
        for i in 0..(most as u8).min(MAX_CHORDS as u8) {
            let [begins, ends] = [all(f32::from(i)), all(f32::from(i + 1))];
            let after = normal.dot(self.end_of(cubics, ends, chords) - point);
            let [falls, rises] = crossed(before, after);
            let crossed = (falls | rises) & asked & begins.simd_lt(chords) & not(are | unclear);
            (are, begun, before) = (are | crossed, crossed.select(begins, begun), after);
        }
        if !are.any() {
            return Meetings::none(self.x0, unclear);
        }
        let ends = begun + all(1.0);
        let from = Vectors::select(begun.simd_eq(zero), self.x0, self.end_of(cubics, begun, chords));
        let piece = Segments { from, to: self.end_of(cubics, ends, chords) };
        let hits = piece.first_hits::<true>(face, zero);
        let (time, normal) = ((begun + hits.time) / chords, hits.normal.masked(are));
        let place = piece.at(hits.time);
        let hits = Hits { are, time, normal, ..hits };
        let mut found = Meetings { hits, unclear, place, begun: begun / chords, chord_from: from };
        found.put_on_path::<true>(self, cubics, face, zero, (ends / chords) & are);
        found
    }

    /// The ends of chords with these numbers, from one to as many as there are.
    #[inline(always)]
    fn end_of(&self, cubics: &Cubics<F>, number: F, chords: F) -> Vectors<F> {
        Vectors::select(number.simd_eq(chords), self.x1, cubics.at(number / chords))
    }

    #[inline(always)]
    fn meetings_on_chords<const POINTS: bool>(
        &self,
        cubics: &Cubics<F>,
        walls: &impl Walls<F>,
        radius: F,
        asked: F,
    ) -> Meetings<F> {
        let all = |x| radius.all(x);
        let chords = asked.select(cubics.chords(), all(1.0));
        let unclear = chords.simd_gt(all(MAX_CHORDS as f32));
        let mut found = Meetings::none(self.x0, unclear);
        let mut end = all(0.0);
        let (mut from, most) = (self.x0, crate::math::max(chords.largest_lane(), 1.0));
        for i in 0..(most as u8).min(MAX_CHORDS as u8) {
            let (begun, ends) = (all(f32::from(i)), all(f32::from(i + 1)));
            let share = ends / chords;
            let to = Vectors::select(ends.simd_eq(chords), self.x1, cubics.at(share));
            let piece = Segments { from, to };
            let open = asked & begun.simd_lt(chords) & not(found.hits.are | unclear);
            let hits = walls.first_hits::<POINTS>(&piece, radius);
            let are = hits.are & open;
            if are.any() {
                found.chord_from = Vectors::select(are, from, found.chord_from);
                found.begun = are.select(begun / chords, found.begun);
                found.place = Vectors::select(are, piece.at(hits.time), found.place);
                end = are.select(share, end);
                let time = (begun + hits.time) / chords;
                found.hits.take(are, Hits { time, ..hits });
            }
            from = to;
        }
        if found.hits.are.any() {
            found.put_on_path::<POINTS>(self, cubics, walls, radius, end);
        }
        found
    }
}

impl<F: Lanes> Cubics<F> {
    /// When they cross the planes that touch the surface at places where they are hit, between two instants, from the side of the
    /// normal to the other.
    #[inline(always)]
    fn crossings(&self, hits: &Hits<F>, place: Vectors<F>, [begun, end]: [F; 2]) -> F {
        let [c1, c2, c3] = self.coefficients;
        let (c1, c2, c3) = (c1.dot(hits.normal), c2.dot(hits.normal), c3.dot(hits.normal));
        let c0 = (self.start - place).dot(hits.normal);
        let all = |x| end.all(x);
        let (mut low, mut high, mut s, mut sought) = (begun, end, end, hits.are);
        for _ in 0..MAX_LOOKS {
            let height = c0 + (c1 + (c2 + c3 * s) * s) * s;
            let slope = c1 + (all(2.0) * c2 + all(3.0) * c3 * s) * s;
            let above = height.simd_gt(all(0.0));
            (low, high) = (above.select(s, low), above.select(high, s));
            let newton = s - height / slope;
            let is_between = newton.simd_ge(low) & newton.simd_le(high);
            let next = sought.select(is_between.select(newton, all(0.5) * (low + high)), s);
            let moved = (next - s).abs().simd_gt(all(f32::EPSILON) * end);
            s = next;
            sought = sought & moved;
            if !sought.any() {
                break;
            }
        }
        s
    }
}
