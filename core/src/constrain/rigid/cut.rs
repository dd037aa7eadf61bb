//! Closed surfaces cut into pieces that are about convex.
//!
//! A part is a chain of triangles. What a plane cuts off is closed by triangles from one place in the plane to each side of the cut: some of them
//! may lie outside, with others turned against them, and all sums over the part are right nevertheless. Corners of hulls are those of the
//! surface alone.

use super::hull::CORNERS;
use super::hull_buf::HullBuf;
use crate::math::{dot, high, largest, low, max, min, sin_cos_turns, sqrt, unit};
use crate::shape::enclosed::{Moments, Place, between, cross, minus};
use alloc::vec::Vec;
use glam::Vec3;

/// As many inward edges of a part are cut along at the most, for each cut.
const EDGES: usize = 24;
/// An edge that turns inward by less than this share of what turns most is left out.
const TURNS: f32 = 0.25;
/// How far an edge has to turn inward, as a share of the solid's size.
const INWARD: f32 = 1e-4;
/// As many pairs of triangles at one edge are looked at, at the most.
const MEET: usize = 6;
/// An edge counts as sharp whose normals differ by this much: some 30°. Curved surfaces are cut across, not along their triangles.
const SHARP: f32 = 0.5;
/// Corners so near a cut are in it, as a share of the solid's size: as near as hulls tell places apart.
const NEAR: f64 = 1e-4;
/// Places across a part's middle where it may be cut, along each axis.
const ACROSS: [f32; 3] = [0.5, 0.25, 0.75];
/// A part smaller than this share of another is no part.
const CRUMB: f64 = 1e-5;
/// The weight of the difference between two sides of a cut, beside what their hulls hold too much.
const BALANCE: f64 = 0.01;
/// By how much a cut has to be better than another.
const BETTER: f64 = 1e-4;
/// As many points are wrapped as they are; of more the outermost in so many directions.
const WRAPPED: usize = 200;
const DIRECTIONS: [usize; 3] = [128, 48, 24];
/// Cosines smaller than this say nothing of how far a hull is.
const ASKEW: f32 = 0.02;

/// A triangle of a part, and the unit vector out of it if it is of the surface, not of a cut.
#[derive(Clone, Copy)]
struct Face {
    corners: [Place; 3],
    out: Option<Vec3>,
}

/// A plane, by a unit vector and how far from the origin it is along that.
#[derive(Clone, Copy)]
struct Plane {
    normal: Place,
    offset: f64,
}

/// A part of a solid.
struct Part {
    faces: Vec<Face>,
    hull: HullBuf,
    /// How far its hull is from its surface \[m\].
    leaves: f32,
}

/// The hulls of the pieces that closed triangles fall into, `most` at the most, and how far any is off the surface: no more than `within` \[m\], if that
/// can be.
pub(super) fn cut(triangles: &[[Place; 3]], within: f32, most: usize) -> (Vec<HullBuf>, f32) {
    let face = |&corners: &[Place; 3]| {
        let [a, b, c] = corners;
        Face { corners, out: Some(vector_of(cross(minus(b, a), minus(c, a)))).filter(|&out| out != Vec3::ZERO) }
    };
    let faces: Vec<Face> = triangles.iter().map(face).collect();
    let size = largest(bounds(&faces).iter().copied().reduce(|low, high| high - low).unwrap_or_default());
    let Some(whole) = Part::of(faces) else { return (Vec::new(), f32::INFINITY) };
    let (mut parts, mut done) = (Vec::from([whole]), Vec::new());
    while let Some(worst) = worst(&parts).filter(|&worst| parts[worst].leaves > within) {
        if parts.len() + done.len() >= 4 * most {
            break;
        }
        let part = parts.swap_remove(worst);
        match part.halves(size) {
            Some(halves) => parts.extend(halves),
            None => done.push(part),
        }
    }
    parts.extend(done);
    join(&mut parts, within);
    let leaves = parts.iter().fold(0.0, |most, part| max(most, part.leaves));
    let is_too_many = parts.len() > most;
    let hulls = parts.into_iter().map(|part| part.hull).take(most).collect();
    (hulls, if is_too_many { max(leaves, size) } else { leaves })
}

/// The number of the part whose hull is farthest from it.
fn worst(parts: &[Part]) -> Option<usize> {
    let farther = |best: usize, other: usize| if parts[other].leaves > parts[best].leaves { other } else { best };
    (0..parts.len()).reduce(farther)
}

/// Joins parts as long as their common hulls are no farther off.
fn join(parts: &mut Vec<Part>, within: f32) {
    let (mut one, mut other) = (0, 1);
    while one + 1 < parts.len() {
        if other == parts.len() {
            (one, other) = (one + 1, one + 2);
            continue;
        }
        let touch = touch(&parts[one].faces, &parts[other].faces);
        let both = || parts[one].faces.iter().chain(&parts[other].faces).copied().collect();
        match Some(()).filter(|()| touch).and_then(|()| Part::of(both())).filter(|part| part.leaves <= within) {
            Some(joined) => {
                parts[one] = joined;
                parts.remove(other);
                // What did not fit it before may do now.
                other = one + 1;
            }
            None => other += 1,
        }
    }
}

/// Tells whether the boxes around two parts touch.
fn touch(a: &[Face], b: &[Face]) -> bool {
    let ([a, b], [c, d]) = (bounds(a), bounds(b));
    let slack = 1e-4 * largest(b - a);
    (a - slack).cmple(d).all() && c.cmple(b + slack).all()
}

fn vector_of(place: Place) -> Vec3 {
    // Tiny triangles have products too small for single precision.
    let most = place.iter().fold(f64::MIN_POSITIVE, |most, x| if x.abs() > most { x.abs() } else { most });
    unit(Vec3::from_array(place.map(|x| (x / most) as f32)))
}

fn single(place: Place) -> Vec3 {
    Vec3::from_array(place.map(|x| x as f32))
}

/// The corners of the box around the surface in a part.
fn bounds(faces: &[Face]) -> [Vec3; 2] {
    let places = faces.iter().filter(|face| face.out.is_some()).flat_map(|face| face.corners).map(single);
    places.fold([Vec3::INFINITY, Vec3::NEG_INFINITY], |[least, most], place| [low(least, place), high(most, place)])
}

impl Part {
    /// None: it has no hull.
    fn of(faces: Vec<Face>) -> Option<Self> {
        let hull = hull_of(&faces, WRAPPED)?;
        let [within, beyond] = leaves(&faces, &hull);
        let leaves = max(within, beyond);
        Some(Self { faces, hull, leaves })
    }

    /// The two parts that the best plane leaves.
    fn halves(&self, size: f32) -> Option<[Self; 2]> {
        let whole = volume(&self.faces);
        let mut best: Option<(f64, [Vec<Face>; 2])> = None;
        for plane in self.planes(size) {
            let halves = [-1.0, 1.0].map(|side| beyond(&self.faces, plane, side, f64::from(size)));
            let volumes = [volume(&halves[0]), volume(&halves[1])];
            if !volumes.iter().all(|&volume| volume > CRUMB * whole) {
                continue;
            }
            let [Some(a), Some(b)] = [hull_of(&halves[0], 0), hull_of(&halves[1], 0)] else { continue };
            let held = f64::from(a.lend().volume()) + f64::from(b.lend().volume());
            // Of cuts that leave as much between hulls and solid those count that bring them nearer to each other.
            let far = [(&halves[0], a, volumes[0]), (&halves[1], b, volumes[1])];
            let far: f64 = far.iter().map(|(half, hull, volume)| f64::from(leaves(half, hull)[0]) * volume).sum();
            let score = (held + far / f64::from(size) + BALANCE * (volumes[0] - volumes[1]).abs()) / whole;
            if best.as_ref().is_none_or(|(least, _)| score < least - BETTER) {
                best = Some((score, halves));
            }
        }
        let [a, b] = best?.1;
        Some([Self::of(a)?, Self::of(b)?])
    }

    /// The planes that it may be cut by: those of the faces at its inward edges, those between them, and across its middle.
    fn planes(&self, size: f32) -> Vec<Plane> {
        let mut planes = Vec::new();
        let edges = inward(&self.faces, INWARD * size);
        let sharpest = edges.iter().fold(0.0, |most, edge| max(most, edge.0));
        let sharp: Vec<_> = edges.iter().filter(|edge| edge.0 >= TURNS * sharpest).collect();
        let through = |normal: Vec3, place: Place| {
            let normal = normal.to_array().map(f64::from);
            Plane { normal, offset: crate::shape::enclosed::dot(normal, place) }
        };
        for &&(_, place, [a, b]) in sharp.iter().step_by(sharp.len().div_ceil(EDGES).max(1)) {
            let turns = a - b;
            if dot(turns, turns) > SHARP * SHARP {
                planes.extend([a, b].map(|normal| through(normal, place)));
            }
            planes.push(through(unit(turns), place));
        }
        let [least, most] = bounds(&self.faces);
        for axis in [Vec3::X, Vec3::Y, Vec3::Z] {
            for share in ACROSS {
                planes.push(through(axis, (least + (most - least) * share).to_array().map(f64::from)));
            }
        }
        planes
    }
}

/// The edges of a surface that turn inward, farther than `least` \[m\]: how much that counts, a place on each, and the normals beside it.
fn inward(faces: &[Face], least: f32) -> Vec<(f32, Place, [Vec3; 2])> {
    // Both zeros are one place.
    let key = |place: Place| place.map(|x| (x + 0.0).to_bits());
    let mut sides = Vec::new();
    for (number, face) in faces.iter().enumerate().filter(|(_, face)| face.out.is_some()) {
        for i in 0..3 {
            let ends = [face.corners[i], face.corners[(i + 1) % 3]].map(key);
            sides.push(([ends[0].min(ends[1]), ends[0].max(ends[1])], number, i));
        }
    }
    sides.sort_unstable();
    let mut edges = Vec::new();
    for pair in sides.chunk_by(|a, b| a.0 == b.0) {
        // Where solids touch along an edge, more than two meet.
        let all = |i: usize| pair.iter().skip(i + 1).map(move |other| (pair[i], *other));
        for ((_, a, i), (_, b, j)) in (0..pair.len()).flat_map(all).take(MEET) {
            let (a, b) = (&faces[a], &faces[b]);
            let ((Some(one), Some(other)), from) = ((a.out, b.out), a.corners[i]) else { continue };
            let rises = dot(one, single(minus(b.corners[(j + 2) % 3], from)));
            let along = single(minus(a.corners[(i + 1) % 3], from));
            let turns = one - other;
            if rises > least {
                edges.push((sqrt(dot(along, along)) * sqrt(dot(turns, turns)), from, [one, other]));
            }
        }
    }
    edges
}

fn volume(faces: &[Face]) -> f64 {
    Moments::of(faces.iter().map(|face| face.corners)).volume
}

/// What lies on one side of a plane, −1 or 1, of a part of a solid of this size.
fn beyond(faces: &[Face], plane: Plane, side: f64, size: f64) -> Vec<Face> {
    let far = |place: Place| {
        let far = crate::shape::enclosed::dot(plane.normal, place) - plane.offset;
        if far.abs() <= NEAR * size { 0.0 } else { far }
    };
    let (mut kept, mut middle) = (Vec::new(), None);
    for face in faces {
        let fars = face.corners.map(far);
        if fars == [0.0; 3] {
            flat(face, single(plane.normal), side, &mut kept);
            continue;
        }
        let (polygon, crossed) = clipped(face.corners, fars, side);
        // What only touches the plane from the other side is no part of this one's surface.
        if fars.iter().any(|far| far * side > 0.0) {
            for i in 1..polygon.len().saturating_sub(1) {
                kept.push(Face { corners: [polygon[0], polygon[i], polygon[i + 1]], out: face.out });
            }
        }
        if let Some([leaves, enters]) = crossed {
            let middle = *middle.get_or_insert(enters);
            kept.push(Face { corners: [middle, enters, leaves], out: None });
        }
    }
    kept
}

/// Adds a triangle that lies in the plane of a cut: to the surface of the side that it closes. Cuts count what is in their plane to the upper side.
fn flat(face: &Face, normal: Vec3, side: f64, kept: &mut Vec<Face>) {
    let closes_lower = face.out.is_some_and(|out| dot(out, normal) > 0.0);
    let [a, b, c] = face.corners;
    match (side > 0.0, closes_lower) {
        (true, false) => kept.push(*face),
        (true, true) => kept.push(Face { out: None, ..*face }),
        (false, true) => kept.extend([*face, Face { corners: [a, c, b], out: None }]),
        (false, false) => {}
    }
}

/// The part of a triangle on one side of a plane that its corners are so far from, and where its own sides leave that side and come back.
fn clipped(corners: [Place; 3], fars: [f64; 3], side: f64) -> (heapless::Vec<Place, 4>, Option<[Place; 2]>) {
    let is_in = |far: f64| if side > 0.0 { far >= 0.0 } else { far < 0.0 };
    let crossing = |inner: usize, outer: usize| match (fars[inner], fars[outer]) {
        (_, 0.0) => corners[outer],
        (0.0, _) => corners[inner],
        (near, far) => between(corners[inner], corners[outer], near / (near - far)),
    };
    let (mut polygon, mut leaves, mut enters) = (heapless::Vec::new(), None, None);
    for i in 0..3 {
        let j = (i + 1) % 3;
        if is_in(fars[i]) {
            let _ = polygon.push(corners[i]);
        }
        match (is_in(fars[i]), is_in(fars[j])) {
            (true, false) => {
                leaves = Some(crossing(i, j));
                polygon.extend(leaves);
            }
            (false, true) => {
                enters = Some(crossing(j, i));
                polygon.extend(enters);
            }
            _ => {}
        }
    }
    (polygon, leaves.zip(enters).map(|(leaves, enters)| [leaves, enters]))
}

/// The hull of the surface in a part: of all of its corners, if they are no more than `most`, or of the outermost.
fn hull_of(faces: &[Face], most: usize) -> Option<HullBuf> {
    let mut points: Vec<[u32; 3]> = faces
        .iter()
        .filter(|face| face.out.is_some())
        .flat_map(|face| face.corners)
        .map(|place| single(place).to_array().map(|x| (x + 0.0).to_bits()))
        .collect();
    points.sort_unstable();
    points.dedup();
    let points: Vec<Vec3> = points.into_iter().map(|place| Vec3::from_array(place.map(f32::from_bits))).collect();
    if points.len() <= most
        && let Ok(hull) = HullBuf::in_place(&points)
    {
        return Some(hull);
    }
    let few = DIRECTIONS.iter().filter(|&&count| most > 0 || count <= CORNERS);
    few.filter_map(|&count| HullBuf::in_place(&outermost(&points, count)).ok()).next()
}

/// The points that are farthest out in so many directions, which wind evenly around a sphere.
fn outermost(points: &[Vec3], directions: usize) -> Vec<Vec3> {
    let mut numbers: Vec<usize> = (0..directions)
        .filter_map(|i| {
            let height = 1.0 - (2 * i + 1) as f32 / directions as f32;
            let (sin, cos) = sin_cos_turns(i as f32 * 0.381_966);
            let aside = sqrt(max(1.0 - height * height, 0.0));
            let along = Vec3::new(aside * cos, height, aside * sin);
            let farther =
                |best: usize, other: usize| if dot(along, points[other] - points[best]) > 0.0 { other } else { best };
            (0..points.len()).reduce(farther)
        })
        .collect();
    numbers.sort_unstable();
    numbers.dedup();
    numbers.into_iter().map(|number| points[number]).collect()
}

/// How far a surface is from the hull around it \[m\]: on the way straight out of it, at the corners and in the middle of each triangle; and how far
/// its corners are beyond that.
fn leaves(faces: &[Face], hull: &HullBuf) -> [f32; 2] {
    let hull = hull.lend();
    let (mut most, mut beyond) = (0.0, 0.0);
    for face in faces {
        let Some(out) = face.out else { continue };
        let corners = face.corners.map(|corner| single(corner) - hull.center);
        let middle = (corners[0] + corners[1] + corners[2]) / 3.0;
        for place in corners.into_iter().chain([middle]) {
            let mut exit = f32::INFINITY;
            for face in hull.faces {
                let (along, far) = (dot(face.normal, out), face.offset - dot(face.normal, place));
                beyond = max(beyond, -far);
                if along > ASKEW {
                    exit = min(exit, far / along);
                }
            }
            most = max(most, exit);
        }
    }
    [most, beyond]
}
