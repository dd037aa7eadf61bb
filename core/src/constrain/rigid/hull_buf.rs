//! Convex hulls of points.

use super::hull::{CORNERS, FACES, Hull, HullEdge, HullFace, HullList, SIDES};
use crate::math::{dot, high, largest, low, unit};
use alloc::vec::Vec;
use core::fmt;
use glam::Vec3;

/// A [`Hull`] that owns its memory.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct HullBuf {
    center: Vec3,
    corners: Vec<Vec3>,
    faces: Vec<HullFace>,
    loops: Vec<u8>,
    edges: Vec<HullEdge>,
}

/// Why points have no hull that could be used.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum HullError {
    /// One is not finite, or they are more than 32-bit floats can square apart.
    NotFinite,
    /// They are in a plane, or on a line, or one.
    Flat,
    /// The hull has more than 64 corners.
    TooManyCorners,
    /// A face of the hull has more than 32 corners.
    TooManySides,
    /// Some are so near each other that rounding decides on the faces.
    Unclear,
}

impl fmt::Display for HullError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::NotFinite => "has corners that are not finite, or too far away",
            Self::Flat => "is flat: a hull needs four corners that are not in a plane",
            Self::TooManyCorners => "has more than 64 corners in its convex hull",
            Self::TooManySides => "has a face of more than 32 corners in its convex hull",
            Self::Unclear => "has corners so near each other that its convex hull cannot be told",
        })
    }
}

impl core::error::Error for HullError {}

/// Half the size of all points being 1, places within this of a plane are in it, and corners within this of each other are one.
const SAME: f32 = 2e-4;

impl HullBuf {
    /// The convex hull of points \[m\], put about its centroid: faces in a plane are one, whatever triangles a mesh had there, and what is within
    /// the 5,000th part of the size of another point, of an edge or of a face counts as lying there.
    ///
    /// The hull is wrapped face by face around its edges (Chand and Kapur, "An Algorithm for Convex Polytopes", J. ACM 17, 1970), in a time that
    /// goes with the points times the edges.
    ///
    /// # Errors
    /// If there is none, or it has more corners than a body may have.
    pub fn of(points: &[Vec3]) -> Result<Self, HullError> {
        Ok(Self::in_place(points)?.at(Vec3::ZERO))
    }

    /// It, with its centroid elsewhere in the frame of its body \[m\].
    #[must_use]
    pub fn at(self, center: Vec3) -> Self {
        Self { center, ..self }
    }

    /// The convex hull of points where they are, as a piece of a body in whose frame these are \[m\].
    ///
    /// # Errors
    /// As for [`of`](Self::of).
    pub fn in_place(points: &[Vec3]) -> Result<Self, HullError> {
        let start = (Vec3::INFINITY, Vec3::NEG_INFINITY);
        let (least, most) = points.iter().fold(start, |(l, h), &point| (low(l, point), high(h, point)));
        let (middle, size) = ((least + most) * 0.5, 0.5 * largest(most - least));
        if points.is_empty() || !points.iter().all(|point| point.is_finite()) || !(size * size < f32::INFINITY) {
            return Err(if points.is_empty() { HullError::Flat } else { HullError::NotFinite });
        }
        let mut wrapped = Wrap { points: Vec::new(), faces: Vec::new() };
        for &point in points {
            let point = (point - middle) / size;
            let is_near = |other: &Vec3| dot(point - *other, point - *other) < SAME * SAME;
            if !wrapped.points.iter().any(is_near) {
                wrapped.points.push(point);
            }
        }
        wrapped.all()?;
        let hull = wrapped.finish(size)?;
        let center = hull.center + middle;
        Ok(hull.at(center))
    }

    /// It, lent.
    #[must_use]
    pub fn lend(&self) -> Hull<'_> {
        Hull { center: self.center, corners: &self.corners, faces: &self.faces, loops: &self.loops, edges: &self.edges }
    }

    /// Stretched along the axes, about its centroid.
    ///
    /// # Errors
    /// If it becomes flat or too large.
    pub fn stretched(&self, by: Vec3) -> Result<Self, HullError> {
        let corners: Vec<_> = self.corners.iter().map(|&corner| corner * by).collect();
        Self::of(&corners)
    }
}

impl HullList for [HullBuf] {
    fn hull(&self, number: usize) -> Option<Hull<'_>> {
        self.get(number).map(HullBuf::lend)
    }
}

impl<const N: usize> HullList for [HullBuf; N] {
    fn hull(&self, number: usize) -> Option<Hull<'_>> {
        self.as_slice().hull(number)
    }
}

impl HullList for Vec<HullBuf> {
    fn hull(&self, number: usize) -> Option<Hull<'_>> {
        self.as_slice().hull(number)
    }
}

/// Points about the origin, and the faces around them found so far, each as the numbers of its corners.
struct Wrap {
    points: Vec<Vec3>,
    faces: Vec<Vec<usize>>,
}

impl Wrap {
    /// Finds all faces.
    fn all(&mut self) -> Result<(), HullError> {
        let lowest = |a: &usize, b: &usize| {
            let [a, b] = [a, b].map(|&number| self.points[number].to_array());
            a.partial_cmp(&b).unwrap_or(core::cmp::Ordering::Equal)
        };
        let first = (0..self.points.len()).min_by(lowest).ok_or(HullError::Flat)?;
        // A line through the lowest point across x touches the hull, and so does the plane that is wrapped around it. If that is no face, an edge is
        // in it.
        let second = self.beyond(first, Vec3::Z).ok_or(HullError::Flat)?;
        let side = self.points[second] - self.points[first];
        match self.add(first, side, unit(Vec3::Z.cross(side))) {
            Err(HullError::Flat) => self.wrap(first, side)?,
            added => added?,
        }
        let (mut number, mut side) = (0, 0);
        while let Some(face) = self.faces.get(number) {
            let Some(&from) = face.get(side) else {
                (number, side) = (number + 1, 0);
                continue;
            };
            let to = face[(side + 1) % face.len()];
            side += 1;
            if !self.faces.iter().any(|face| has(face, [to, from])) {
                self.wrap(to, self.points[from] - self.points[to])?;
                if self.faces.last().is_none_or(|face| !has(face, [to, from])) {
                    return Err(HullError::Unclear);
                }
            }
        }
        Ok(())
    }

    /// The point that makes a plane with the line through another one beyond which, to the right of the line, there is none: of several that
    /// farthest from the line.
    fn beyond(&self, from: usize, along: Vec3) -> Option<usize> {
        let origin = self.points[from];
        let along = unit(along);
        let aside = |point: Vec3| {
            let way = point - origin;
            let way = way - along * dot(way, along);
            (dot(way, way) > SAME * SAME).then_some(way)
        };
        let mut best: Option<(usize, Vec3)> = None;
        for (number, &point) in self.points.iter().enumerate() {
            let Some(way) = aside(point) else { continue };
            if best.is_none_or(|(_, before)| dot(along.cross(before), way) > 0.0) {
                best = Some((number, way));
            }
        }
        let (mut number, first) = best?;
        let (normal, mut farthest) = (unit(along.cross(first)), 0.0);
        for (other, &point) in self.points.iter().enumerate() {
            let Some(way) = aside(point) else { continue };
            if dot(normal, way) > -SAME && dot(way, first) > 0.0 && dot(way, way) > farthest {
                (number, farthest) = (other, dot(way, way));
            }
        }
        Some(number)
    }

    /// Adds the face to the left of an edge through a point.
    fn wrap(&mut self, from: usize, along: Vec3) -> Result<(), HullError> {
        let third = self.beyond(from, along).ok_or(HullError::Flat)?;
        self.add(from, along, unit(along.cross(self.points[third] - self.points[from])))
    }

    /// Adds the face in a plane, through a point and along a direction in it.
    fn add(&mut self, on: usize, side: Vec3, normal: Vec3) -> Result<(), HullError> {
        if self.faces.len() == FACES {
            return Err(HullError::TooManyCorners);
        }
        let origin = self.points[on];
        let is_in = |&number: &usize| dot(normal, self.points[number] - origin) > -SAME;
        let in_plane: Vec<_> = (0..self.points.len()).filter(is_in).collect();
        let face = self.around(&in_plane, side, normal)?;
        self.faces.push(face);
        Ok(())
    }

    /// The corners of the convex polygon around points in a plane, counterclockwise about its normal.
    fn around(&self, points: &[usize], side: Vec3, normal: Vec3) -> Result<Vec<usize>, HullError> {
        let u = unit(side);
        let v = normal.cross(u);
        let least = |along: Vec3, of: &mut dyn Iterator<Item = usize>| {
            of.map(|number| (number, dot(along, self.points[number])))
                .reduce(|best, other| if other.1 < best.1 { other } else { best })
        };
        let (_, back) = least(u, &mut points.iter().copied()).ok_or(HullError::Unclear)?;
        let is_back = |number: &usize| dot(u, self.points[*number]) < back + SAME;
        let (first, _) = least(v, &mut points.iter().copied().filter(is_back)).ok_or(HullError::Unclear)?;
        let (mut corners, mut last) = (Vec::from([first]), first);
        loop {
            let next = self.next(points, last, normal).ok_or(HullError::Unclear)?;
            if next == first {
                break;
            }
            if corners.contains(&next) {
                return Err(HullError::Unclear);
            }
            if corners.len() == SIDES {
                return Err(HullError::TooManySides);
            }
            corners.push(next);
            last = next;
        }
        if corners.len() < 3 { Err(HullError::Flat) } else { Ok(corners) }
    }

    /// The next corner of a polygon: the point with no other on the right of the way there, of several the farthest.
    fn next(&self, points: &[usize], from: usize, normal: Vec3) -> Option<usize> {
        let origin = self.points[from];
        let others = || points.iter().copied().filter(|&number| number != from);
        let mut best: Option<(usize, Vec3)> = None;
        for number in others() {
            let way = self.points[number] - origin;
            if best.is_none_or(|(_, before)| dot(normal, before.cross(way)) < 0.0) {
                best = Some((number, way));
            }
        }
        let (mut number, way) = best?;
        let (left, along, mut farthest) = (normal.cross(unit(way)), way, 0.0);
        for other in others() {
            let way = self.points[other] - origin;
            if dot(left, way) < SAME && dot(along, way) > farthest {
                (number, farthest) = (other, dot(along, way));
            }
        }
        Some(number)
    }

    /// Numbers what belongs to the hull, and puts it about its centroid in its true size.
    fn finish(self, size: f32) -> Result<HullBuf, HullError> {
        let mut used: Vec<usize> = self.faces.iter().flatten().copied().collect();
        used.sort_unstable();
        used.dedup();
        if used.len() > CORNERS {
            return Err(HullError::TooManyCorners);
        }
        let mut hull =
            HullBuf { corners: used.iter().map(|&number| self.points[number] * size).collect(), ..HullBuf::default() };
        for (number, face) in self.faces.iter().enumerate() {
            let first = hull.loops.len() as u16;
            let numbers = face.iter().map(|corner| used.partition_point(|other| other < corner) as u8);
            hull.loops.extend(numbers);
            hull.faces.push(HullFace { normal: Vec3::ZERO, offset: 0.0, first, count: face.len() as u16 });
            let ends = face.iter().zip(face.iter().cycle().skip(1));
            for (&from, &to) in ends.filter(|(from, to)| from < to) {
                let other = self.faces.iter().position(|face| has(face, [to, from])).ok_or(HullError::Unclear)?;
                let ends = [from, to].map(|end| used.partition_point(|&other| other < end) as u8);
                hull.edges.push(HullEdge { ends, faces: [number, other].map(|face| face as u8) });
            }
        }
        // Twice, since the first time what is far from the origin comes with rounding.
        for _ in 0..2 {
            let centroid = hull.lend().centroid();
            hull.corners.iter_mut().for_each(|corner| *corner -= centroid);
            hull.center += centroid;
        }
        for number in 0..hull.faces.len() {
            let (normal, offset) = plane(hull.lend().polygon(&hull.faces[number]));
            (hull.faces[number].normal, hull.faces[number].offset) = (normal, offset);
        }
        let flat = !(hull.lend().volume() > SAME * size * size * size);
        match hull.lend().fault() {
            _ if flat => Err(HullError::Flat),
            Some(_) => Err(HullError::Unclear),
            None => Ok(hull),
        }
    }
}

/// Tells whether a polygon has a side from a corner to another.
fn has(face: &[usize], [from, to]: [usize; 2]) -> bool {
    face.iter().zip(face.iter().cycle().skip(1)).any(|(&a, &b)| [a, b] == [from, to])
}

/// The plane of a polygon that is about flat: its unit normal (Newell's), and how far from the origin its farthest corner is along it.
fn plane(corners: impl Iterator<Item = Vec3> + Clone) -> (Vec3, f32) {
    let first = corners.clone().next().unwrap_or(Vec3::ZERO);
    let ways = corners.clone().map(|corner| corner - first);
    let normal = unit(ways.clone().zip(ways.skip(1)).map(|(a, b)| a.cross(b)).sum::<Vec3>());
    (normal, corners.map(|corner| dot(normal, corner)).fold(f32::NEG_INFINITY, crate::math::max))
}
