//! A flat face and one solid before each of some points, or two.
//!
//! Every number is made as the solids make it by themselves, in the same order, and so has the same bits.

use super::hits::{Hits, Seats, Segments, Walls};
use super::walls::slack;
use crate::collide::waiting::EIGHTS;
use crate::lanes::{Eight, LANES, Lanes, PARTS, Vectors, mask_of, max, min, negated, not};
use crate::shape::{Aabb, Face, Solid};

/// The kinds that solids before some points are of: all spheres, all boxes, or either.
pub(in crate::collide) const SPHERES: u8 = 0;
pub(in crate::collide) const BOXES: u8 = 1;
pub(in crate::collide) const EITHER: u8 = 2;

/// So many solids of a kind before each point, in their order, and the face that all are on.
pub(in crate::collide) struct Things<F, const MANY: usize, const KIND: u8> {
    face: Option<Face>,
    solids: [Solids<F, KIND>; MANY],
}

/// Solids of a kind, one before each point.
#[derive(Clone, Copy)]
struct Solids<F, const KIND: u8> {
    /// Those that come after the face in their order.
    after: F,
    /// The boxes around them.
    min: Vectors<F>,
    max: Vectors<F>,
    center: Vectors<F>,
    radius: F,
    /// How far they reach from the origin.
    size: F,
    /// Those that are boxes.
    boxes: F,
}

impl<F: Lanes, const MANY: usize, const KIND: u8> Things<F, MANY, KIND> {
    /// The solids before a packet that begins with one of the eights, and a bit for each that comes after the face.
    #[inline(always)]
    pub(in crate::collide) fn of(
        like: F,
        solids: &[[[Solid; LANES]; EIGHTS]; MANY],
        after: &[u64; MANY],
        nth: usize,
        face: Option<Face>,
    ) -> Self {
        let first =
            Solids::of(like, [&solids[0][nth], &solids[0][nth + F::PARTS - 1]], (after[0] >> (LANES * nth)) as u32);
        let mut all = [first; MANY];
        for (all, (solids, after)) in all.iter_mut().zip(solids.iter().zip(after)).skip(1) {
            *all = Solids::of(like, [&solids[nth], &solids[nth + F::PARTS - 1]], (after >> (LANES * nth)) as u32);
        }
        Self { face, solids: all }
    }
}

impl<F: Lanes, const KIND: u8> Solids<F, KIND> {
    #[inline(always)]
    fn of(like: F, solids: [&[Solid; LANES]; PARTS], after: u32) -> Self {
        let [x, y, z, radius, u, v, w, size, center_x, center_y, center_z, boxes] = like.of_parts(
            #[inline(always)]
            |like, nth| columns(like, solids[nth]),
        );
        let (center, after) = (Vectors([center_x, center_y, center_z]), mask_of(like, after));
        let boxes = boxes.simd_gt(like.all(0.0));
        Self { after, min: Vectors([x, y, z]), max: Vectors([u, v, w]), center, radius, size, boxes }
    }

    /// What spheres and boxes answer, each where it is one.
    #[inline(always)]
    fn either<T>(
        &self,
        spheres: impl FnOnce() -> T,
        boxes: impl FnOnce() -> T,
        select: impl FnOnce(F, T, T) -> T,
    ) -> T {
        match KIND {
            SPHERES => spheres(),
            BOXES => boxes(),
            _ => select(self.boxes, boxes(), spheres()),
        }
    }

    /// Those that boxes may touch, as `Aabb::overlaps` says.
    #[inline(always)]
    fn may_touch(&self, low: Vectors<F>, high: Vectors<F>) -> F {
        let room = self.size.all(8.0 * f32::EPSILON);
        let [x, y, z] = axes(
            #[inline(always)]
            |axis| {
                let (low, high) = (max(self.min.0[axis], low.0[axis]), min(self.max.0[axis], high.0[axis]));
                (low - room * low.abs()).simd_le(high + room * high.abs())
            },
        );
        x & y & z
    }

    /// Those that places lie strictly inside of.
    #[inline(always)]
    fn contain(&self, place: Vectors<F>) -> F {
        self.either(
            #[inline(always)]
            || {
                let offset = place - self.center;
                offset.dot(offset).simd_lt(self.radius * self.radius)
            },
            #[inline(always)]
            || {
                let [x, y, z] = axes(
                    #[inline(always)]
                    |axis| place.0[axis].simd_gt(self.min.0[axis]) & place.0[axis].simd_lt(self.max.0[axis]),
                );
                x & y & z
            },
            F::select,
        )
    }

    /// Where points that go along straight pieces first hit the solids, from outside or from inside, as `convex::first_hit` has it.
    #[inline(always)]
    fn hits(&self, piece: &Segments<F>) -> Hits<F> {
        let (like, &Segments { from, to }) = (self.size, piece);
        let (all, zero, one) = (|x| like.all(x), like.all(0.0), like.all(1.0));
        let step = to - from;
        let (starts, ends) = (self.contain(from), self.contain(to));
        let slack = all(4.0 * f32::EPSILON) * (max(from.largest(), to.largest()) + self.size);
        let room = max(low(from, to).largest(), high(from, to).largest()) * all(8.0 * f32::EPSILON);
        let (least, most) = (low(from, to), high(from, to));
        let room = Vectors([room, room, room]);
        let asked = self.may_touch(least - room, most + room) & not(step.is_zero() | (starts & ends));
        let Span { are, enter, leave, normal } = self.span(from, step, starts);
        let time = min(max(starts.select(leave, enter), zero), one);
        // Straight through. A start within rounding of the surface may seem inside the span: it enters if the entrance is the nearer end.
        let ahead = enter.simd_gt(zero) | negated(enter).simd_lt(leave);
        let through = ahead & enter.simd_le(one);
        // The line may just miss where the ends differ.
        let hits = asked & ((are & (starts | ends | through)) | (not(are) & (starts ^ ends)));
        let faces = step.dot(normal).simd_lt(zero) & are;
        let normal = if (hits & not(faces)).any() {
            Vectors::select(faces, normal, self.grazed(from, step, starts))
        } else {
            normal
        };
        let are_all = all(f32::from_bits(u32::MAX));
        Hits { are: hits, time: time & are, normal, slack, beside_face: are_all }
    }

    /// Normals toward lines that run within rounding of the surface.
    #[inline(always)]
    fn grazed(&self, from: Vectors<F>, step: Vectors<F>, starts: F) -> Vectors<F> {
        let back = -step.unit();
        let round = || {
            let normal = (from - self.center).unit();
            Vectors::select(normal.is_zero(), back, Vectors::select(starts, -normal, normal))
        };
        self.either(round, || back, Vectors::select)
    }

    /// Where lines run inside, and the outward normals where they enter, or where they leave for those that are asked for that; turned
    /// inward there.
    #[inline(always)]
    fn span(&self, from: Vectors<F>, step: Vectors<F>, leaves: F) -> Span<F> {
        self.either(
            #[inline(always)]
            || self.sphere_span(from, step, leaves),
            #[inline(always)]
            || self.box_span(from, step, leaves),
            Span::select,
        )
    }

    #[inline(always)]
    fn sphere_span(&self, from: Vectors<F>, step: Vectors<F>, leaves: F) -> Span<F> {
        let offset = from - self.center;
        let square = step.dot(step);
        let middle = negated(offset.dot(step)) / square;
        let nearest = offset + step * middle;
        let rest = self.radius * self.radius - nearest.dot(nearest);
        let half = (rest / square).sqrt();
        let (enter, leave) = (middle - half, middle + half);
        let normal = (offset + step * leaves.select(leave, enter)).unit();
        Span { are: rest.simd_gt(self.size.all(0.0)), enter, leave, normal: Vectors::select(leaves, -normal, normal) }
    }

    #[inline(always)]
    fn box_span(&self, from: Vectors<F>, step: Vectors<F>, leaves: F) -> Span<F> {
        let (all, zero) = (|x| from.0[0].all(x), from.0[0].all(0.0));
        let (mut enter, mut leave) = (all(f32::NEG_INFINITY), all(f32::INFINITY));
        let mut are = zero.simd_eq(zero);
        // The axes across which they enter and leave.
        let (mut entered, mut left) = (all(3.0), all(3.0));
        for axis in 0..3 {
            let (x, dx, least, most) = (from.0[axis], step.0[axis], self.min.0[axis], self.max.0[axis]);
            let (a, b) = ((least - x) / dx, (most - x) / dx);
            let (rises, stays) = (dx.simd_gt(zero), dx.simd_eq(zero));
            let first = stays.select(all(f32::NEG_INFINITY), rises.select(a, b));
            let last = stays.select(all(f32::INFINITY), rises.select(b, a));
            let (is_later, is_sooner) = (first.simd_gt(enter), last.simd_lt(leave));
            // The first axis begins with its own numbers, whatever they are.
            let (is_later, is_sooner) = if axis == 0 { (not(stays), not(stays)) } else { (is_later, is_sooner) };
            entered = is_later.select(all(axis as f32), entered);
            left = is_sooner.select(all(axis as f32), left);
            (enter, leave) = (is_later.select(first, enter), is_sooner.select(last, leave));
            let is_between = least.simd_lt(x) & x.simd_lt(most);
            are = are & (not(stays) | is_between) & if axis == 0 { are } else { enter.simd_le(leave) };
        }
        let across = leaves.select(left, entered);
        let is_across = axes(
            #[inline(always)]
            |axis| across.simd_eq(all(axis as f32)),
        );
        let [x, y, z] = axes(
            #[inline(always)]
            |axis| step.0[axis].simd_gt(zero) & is_across[axis],
        );
        // Against the step; zeros have the sign as well.
        let sign = all(-0.0) & (x | y | z);
        let normal = axes(
            #[inline(always)]
            |axis| (all(1.0) & is_across[axis]) ^ sign,
        );
        Span { are, enter, leave, normal: Vectors(normal) }
    }

    /// The ways to places outside from the nearest places of the solids, and how far the walls are from places inside, about.
    #[inline(always)]
    fn gaps(&self, place: Vectors<F>) -> (Vectors<F>, F) {
        let zero = self.size.all(0.0);
        self.either(
            #[inline(always)]
            || {
                let offset = place - self.center;
                let length = offset.length();
                (offset.unit() * max(length - self.radius, zero), self.radius - length)
            },
            #[inline(always)]
            || {
                let gap = axes(
                    #[inline(always)]
                    |axis| max(place.0[axis] - self.max.0[axis], zero) - max(self.min.0[axis] - place.0[axis], zero),
                );
                let [x, y, z] = axes(
                    #[inline(always)]
                    |axis| (place.0[axis] - self.min.0[axis]).least(self.max.0[axis] - place.0[axis]),
                );
                (Vectors(gap), x.least(y).least(z))
            },
            #[inline(always)]
            |mask, (gap, wall), (other_gap, other)| (Vectors::select(mask, gap, other_gap), mask.select(wall, other)),
        )
    }

    /// The seats on them, of which it cannot be told for points inside that are near a wall: they may be near several.
    #[inline(always)]
    fn seats(&self, place: Vectors<F>, reach: F) -> Seats<F> {
        let (gap, wall) = self.gaps(place);
        let normal = gap.unit();
        let distance = gap.dot(normal);
        let reaches = Vectors([reach, reach, reach]);
        let is_within = self.contain(place);
        let is_near = self.may_touch(place - reaches, place + reaches)
            & distance.simd_le(reach)
            & not(normal.is_zero() | is_within);
        let unclear = is_within & not(wall.simd_gt(reach.all(1.001) * reach));
        let slack = slack(place, distance, self.size);
        Seats { are: is_near & not(unclear), normal, distance, slack, unclear }
    }
}

/// The lower corners of eight solids' boxes and the radii of balls in their place, the upper corners and how far each reaches from the
/// origin, and the centers and whether they are boxes.
#[inline(always)]
fn columns<F: Eight>(like: F, solids: &[Solid; LANES]) -> [F; 12] {
    let (mut min, mut max, mut center) = ([[0.0; 4]; LANES], [[0.0; 4]; LANES], [[0.0; 4]; LANES]);
    for (i, solid) in solids.iter().enumerate() {
        let Aabb { min: low, max: high } = solid.bounds();
        let (middle, radius) = solid.ball();
        min[i] = [low.x, low.y, low.z, radius];
        max[i] = [high.x, high.y, high.z, solid.reach()];
        center[i] = [middle.x, middle.y, middle.z, f32::from(matches!(solid, Solid::Box(_)))];
    }
    let ([x, y, z, radius], [u, v, w, size]) = (like.quads_of(min), like.quads_of(max));
    let [a, b, c, d] = like.quads_of(center);
    [x, y, z, radius, u, v, w, size, a, b, c, d]
}

/// The parts of lines inside solids.
struct Span<F> {
    are: F,
    enter: F,
    leave: F,
    normal: Vectors<F>,
}

impl<F: Lanes> Span<F> {
    #[inline(always)]
    fn select(mask: F, a: Self, b: Self) -> Self {
        let [are, enter, leave] =
            [mask.select(a.are, b.are), mask.select(a.enter, b.enter), mask.select(a.leave, b.leave)];
        Self { are, enter, leave, normal: Vectors::select(mask, a.normal, b.normal) }
    }
}

/// A number for each axis.
#[inline(always)]
fn axes<F>(of: impl Fn(usize) -> F) -> [F; 3] {
    [of(0), of(1), of(2)]
}

#[inline(always)]
fn low<F: Lanes>(a: Vectors<F>, b: Vectors<F>) -> Vectors<F> {
    Vectors(axes(
        #[inline(always)]
        |axis| min(a.0[axis], b.0[axis]),
    ))
}

#[inline(always)]
fn high<F: Lanes>(a: Vectors<F>, b: Vectors<F>) -> Vectors<F> {
    Vectors(axes(
        #[inline(always)]
        |axis| max(a.0[axis], b.0[axis]),
    ))
}

impl<F: Lanes, const MANY: usize, const KIND: u8> Walls<F> for Things<F, MANY, KIND> {
    #[inline(always)]
    fn first_hits<const POINTS: bool>(&self, piece: &Segments<F>, radius: F) -> Hits<F> {
        let (mut things, mut after) = (self.solids[0].hits(piece), self.solids[0].after);
        for solids in &self.solids[1..] {
            let others = solids.hits(piece);
            let is_earlier = others.are & (others.time.simd_lt(things.time) | not(things.are));
            after = is_earlier.select(solids.after, after);
            things.take(is_earlier, others);
        }
        let Some(face) = &self.face else { return things };
        let mut hits = piece.first_hits::<POINTS>(face, radius);
        // The first in their order, unless the other is earlier.
        let is_earlier = after.select(things.time.simd_lt(hits.time), not(hits.time.simd_lt(things.time)));
        hits.take(things.are & (is_earlier | not(hits.are)), things);
        hits
    }

    #[inline(always)]
    fn seats(&self, place: Vectors<F>, reach: F) -> Seats<F> {
        let mut seats = self.solids[0].seats(place, reach);
        let mut are_any = seats.are;
        for solids in &self.solids[1..] {
            seats.join(solids.seats(place, reach), &mut are_any);
        }
        if let Some(face) = &self.face {
            seats.join(face.seats(place, reach), &mut are_any);
        }
        seats.are = seats.are & not(seats.unclear);
        seats
    }
}
