//! Convex hulls: bodies' shapes other than boxes.

use crate::math::{dot, length, max, sqrt};
use glam::{Mat3, Vec3};

/// The most corners that a hull may have.
pub(super) const CORNERS: usize = 64;
/// The most corners that a face of it may have.
pub(super) const SIDES: usize = 32;
/// The most faces that it may have: as many as triangles over so many corners.
pub(super) const FACES: usize = 2 * CORNERS - 4;

/// A convex polyhedron about its centroid, as its corners, faces and edges: on a host [`HullBuf`](super::HullBuf) finds them by the
/// corners alone. It is a body's whole form, or one of several pieces of it.
///
/// ```
/// use pointmass::constrain::HullBuf;
/// use pointmass::Vec3;
///
/// // A corner cut off a cube of 1 m.
/// let tip = HullBuf::of(&[Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z])?;
/// let hull = tip.lend();
/// assert_eq!((hull.corners.len(), hull.faces.len(), hull.edges.len()), (4, 4, 6));
/// assert!((hull.volume() - 1.0 / 6.0).abs() < 1e-6);
/// # Ok::<(), pointmass::constrain::HullError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hull<'a> {
    /// Where its centroid is in the frame of its body \[m\]: zero, where it is all of that.
    pub center: Vec3,
    /// The corners, from there \[m\], 64 at the most.
    pub corners: &'a [Vec3],
    /// The faces.
    pub faces: &'a [HullFace],
    /// The numbers of each face's corners, counterclockwise as seen from outside, one face after the other.
    pub loops: &'a [u8],
    /// The edges.
    pub edges: &'a [HullEdge],
}

/// A face of a [`Hull`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HullFace {
    /// The unit vector out of the hull.
    pub normal: Vec3,
    /// How far from the centroid it is along that \[m\].
    pub offset: f32,
    /// Where the numbers of its corners begin in the hull's loops, and how many there are, from 3 to 32.
    pub first: u16,
    /// See `first`.
    pub count: u16,
}

/// An edge of a [`Hull`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct HullEdge {
    /// The numbers of the corners at its ends.
    pub ends: [u8; 2],
    /// The numbers of the faces on its left and right, as seen from outside on the way from the first end to the second.
    pub faces: [u8; 2],
}

/// Hulls by their numbers: slices, arrays and vectors of [`Hull`] and [`HullBuf`](super::HullBuf), and `()`, which is none.
pub trait HullList: Sync {
    /// The hull with a number, if there is one.
    fn hull(&self, number: usize) -> Option<Hull<'_>>;
}

impl HullList for () {
    fn hull(&self, _: usize) -> Option<Hull<'_>> {
        None
    }
}

impl HullList for [Hull<'_>] {
    fn hull(&self, number: usize) -> Option<Hull<'_>> {
        self.get(number).copied()
    }
}

impl<const N: usize> HullList for [Hull<'_>; N] {
    fn hull(&self, number: usize) -> Option<Hull<'_>> {
        self.get(number).copied()
    }
}

impl<T: HullList + ?Sized> HullList for &T {
    fn hull(&self, number: usize) -> Option<Hull<'_>> {
        (**self).hull(number)
    }
}

impl<'a> Hull<'a> {
    /// The first of its numbers that cannot be used, and what it has to be.
    #[must_use]
    pub fn fault(&self) -> Option<(&'static str, &'static str)> {
        let corner = |&number: &u8| usize::from(number) < self.corners.len();
        let face = |face: &HullFace| {
            let (first, count) = (usize::from(face.first), usize::from(face.count));
            (3..=SIDES).contains(&count)
                && first + count <= self.loops.len()
                && (dot(face.normal, face.normal) - 1.0).abs() < 1e-4
                && face.offset > 0.0
                && face.offset < f32::INFINITY
        };
        let edge = |edge: &HullEdge| {
            edge.ends.iter().all(corner) && edge.faces.iter().all(|&face| usize::from(face) < self.faces.len())
        };
        let faults = [
            (!(4..=CORNERS).contains(&self.corners.len()), "corners", "have to be from 4 to 64"),
            (!self.corners.iter().all(|corner| corner.is_finite()), "corners", "have to be finite"),
            (!self.center.is_finite(), "center", "has to be finite"),
            (!(4..=FACES).contains(&self.faces.len()), "faces", "have to be from 4 to 124"),
            (
                !self.faces.iter().all(face),
                "faces",
                "have to be of 3 to 32 corners around the origin, with unit normals",
            ),
            (!self.loops.iter().all(corner), "loops", "have to be numbers of corners"),
            (!self.edges.iter().all(edge), "edges", "have to be numbers of corners and faces"),
            (
                self.corners.len() + self.faces.len() != self.edges.len() + 2,
                "edges",
                "have to be one for each two faces",
            ),
        ];
        faults.into_iter().find(|&(wrong, ..)| wrong).map(|(_, name, message)| (name, message))
    }

    /// The corners of a face, in order.
    pub fn polygon(&self, face: &HullFace) -> impl Iterator<Item = Vec3> + Clone + use<'a> {
        let first = usize::from(face.first);
        let (loops, corners) = (self.loops, self.corners);
        let numbers = loops.get(first..first + usize::from(face.count)).unwrap_or_default();
        numbers.iter().filter_map(move |&number| corners.get(usize::from(number)).copied())
    }

    /// The triangles that a face falls into, all from its first corner: to draw it, for instance.
    pub fn triangles(&self, face: &HullFace) -> impl Iterator<Item = [Vec3; 3]> + use<'a> {
        let corners = self.polygon(face);
        let pairs = corners.clone().skip(1).zip(corners.clone().skip(2));
        corners.take(1).flat_map(move |first| pairs.clone().map(move |(a, b)| [first, a, b]))
    }

    /// The tetrahedra that it falls into from the origin: six times the volume of each, and its other corners.
    fn tetrahedra(&self) -> impl Iterator<Item = (f32, [Vec3; 3])> + use<'a> {
        let hull = *self;
        let triangles = hull.faces.iter().flat_map(move |face| hull.triangles(face));
        triangles.map(|[a, b, c]| (dot(a, b.cross(c)), [a, b, c]))
    }

    /// Its volume \[m³\].
    #[must_use]
    pub fn volume(&self) -> f32 {
        self.tetrahedra().map(|(six, _)| six).sum::<f32>() / 6.0
    }

    /// Where the centroid of its corners is from `center` \[m\]: there, but for rounding.
    #[must_use]
    pub fn centroid(&self) -> Vec3 {
        let (mut volume, mut sum) = (0.0, Vec3::ZERO);
        for (six, [a, b, c]) in self.tetrahedra() {
            volume += six;
            sum += (a + b + c) * six;
        }
        sum * (0.25 / volume)
    }

    /// How far it reaches from its centroid along each axis \[m\].
    #[must_use]
    pub fn half(&self) -> Vec3 {
        self.corners.iter().fold(Vec3::ZERO, |most, corner| crate::math::high(most, corner.abs()))
    }

    /// Σ m x xᵀ over its mass, about its centroid \[m²\]: of a tetrahedron with a corner at the origin V/20 (s sᵀ + Σ x xᵀ), s being the sum of the
    /// other corners x (Tonon, "Explicit Exact Formulas for the 3-D Tetrahedron Inertia Tensor", J. Math. Stat. 1, 2005).
    pub(super) fn spread(&self) -> Mat3 {
        let outer = |a: Vec3, b: Vec3| Mat3::from_cols(a * b.x, a * b.y, a * b.z);
        let (mut volume, mut sum) = (0.0, Mat3::ZERO);
        for (six, [a, b, c]) in self.tetrahedra() {
            let s = a + b + c;
            volume += six;
            sum += outer(s * six, s) + outer(a * six, a) + outer(b * six, b) + outer(c * six, c);
        }
        sum * (0.05 / volume)
    }

    /// Eight places about its centroid \[m\] at which eight equal particles have its inertia: L (±1, ±1, ±1), where L Lᵀ is its Σ m x xᵀ over its
    /// mass (Cholesky). Of a box they are 1/√3 of the way to the corners.
    #[must_use]
    pub fn particles(&self) -> [Vec3; 8] {
        eight(self.spread())
    }

    /// The corner that is farthest in a direction.
    pub(super) fn farthest(&self, toward: Vec3) -> Vec3 {
        let mut best = (Vec3::ZERO, f32::NEG_INFINITY);
        for &corner in self.corners {
            let far = dot(corner, toward);
            if far > best.1 {
                best = (corner, far);
            }
        }
        best.0
    }

    /// The place on its surface that is nearest to a place \[m\], the way out there, and how far out the place is \[m\]: below zero inside.
    pub(super) fn nearest(&self, place: Vec3) -> (Vec3, Vec3, f32) {
        let mut best = (place, Vec3::Y, f32::NEG_INFINITY);
        for face in self.faces {
            let out = dot(face.normal, place) - face.offset;
            if out > best.2 {
                best = (place - face.normal * out, face.normal, out);
            }
        }
        if !(best.2 > 0.0) {
            return best;
        }
        // Outside, the nearest place is on a face that is seen from there.
        let mut least = f32::INFINITY;
        for face in self.faces.iter().filter(|face| dot(face.normal, place) > face.offset) {
            let on = self.nearest_of(face, place);
            let way = place - on;
            let far = dot(way, way);
            if far < least {
                least = far;
                best = (on, face.normal, sqrt(far));
            }
        }
        let (on, normal, far) = best;
        let way = place - on;
        let out = way * (1.0 / length(way));
        (on, if out.is_finite() { out } else { normal }, far)
    }

    /// The place of a face that is nearest to a place.
    fn nearest_of(&self, face: &HullFace, place: Vec3) -> Vec3 {
        let mut best = (place - face.normal * (dot(face.normal, place) - face.offset), f32::INFINITY);
        let corners = self.polygon(face);
        let ends = corners.clone().zip(corners.clone().skip(1).chain(corners.take(1)));
        for (from, to) in ends {
            let side = to - from;
            if dot(side.cross(face.normal), place - from) > 0.0 {
                // Beyond this side.
                let share = crate::math::clamp(dot(place - from, side) / dot(side, side), 0.0, 1.0);
                let on = from + side * share;
                let far = dot(place - on, place - on);
                if far < best.1 {
                    best = (on, far);
                }
            }
        }
        best.0
    }
}

/// Eight places about the origin \[m\] at which eight equal particles have a Σ m x xᵀ over their mass \[m²\]: L (±1, ±1, ±1), L Lᵀ being that
/// (Cholesky).
pub(super) fn eight(Mat3 { x_axis: x, y_axis: y, z_axis: z }: Mat3) -> [Vec3; 8] {
    let root = |square: f32| sqrt(max(square, f32::MIN_POSITIVE));
    let a = root(x.x);
    let (b, c) = (x.y / a, x.z / a);
    let d = root(y.y - b * b);
    let e = (y.z - c * b) / d;
    let f = root(z.z - c * c - e * e);
    let columns = Mat3::from_cols(Vec3::new(a, b, c), Vec3::new(0.0, d, e), Vec3::new(0.0, 0.0, f));
    core::array::from_fn(|i| columns * corner(Vec3::ONE, i as u32))
}

/// The corner of a box with a number from 0 to 7, from its middle along its own axes \[m\].
pub(super) fn corner(half: Vec3, number: u32) -> Vec3 {
    let side = |bit: u32| if number >> bit & 1 == 1 { 1.0 } else { -1.0 };
    half * Vec3::new(side(0), side(1), side(2))
}
