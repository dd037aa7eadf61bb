//! The lecture's shapes. Every file holds one: where births lie on it, how far it is, and where a path first hits it.

mod cone;
mod convex;
mod cuboid;
mod cylinder;
mod disc;
mod line;
mod mesh;
mod place;
mod plane;
mod revolve;
mod sphere;
mod triangle;

pub use cone::Cone;
pub use cuboid::Cuboid;
pub use cylinder::Cylinder;
pub use disc::Disc;
pub use line::Line;
#[cfg(feature = "alloc")]
pub use mesh::MeshBuf;
pub use mesh::{BadMesh, Mesh};
pub use place::{Affine, Placed};
pub use plane::Plane;
pub use sphere::Sphere;
pub use triangle::Triangle;

use crate::math::{high, largest, low, max};
use glam::Vec3;

/// A surface (or a line) in space.
pub trait Surface {
    /// Area \[m²\]; of a line its length \[m\], of a plane infinity.
    fn area(&self) -> f32;

    /// The point and normal that three numbers uniform in [0, 1) pick, uniformly by area.
    fn sample(&self, u: [f32; 3]) -> Spot;

    /// The point of the surface nearest to `point`; where several are, one of them.
    fn nearest(&self, point: Vec3) -> Vec3;

    /// The smallest axis-aligned box around it.
    fn bounds(&self) -> Aabb;
}

/// Something that a moving point can run into.
///
/// A tuple, slice or reference of colliders is a collider: the earliest hit is its hit.
pub trait Collider: Sync {
    /// Where `segment` first meets it, if it does.
    ///
    /// A point that starts on the surface and leaves it does not hit it; a closed solid's surface belongs to the
    /// outside. No path whose two ends lie on different sides goes unnoticed, however the arithmetic rounds.
    fn first_hit(&self, segment: &Segment) -> Option<Hit>;

    /// Whether a path inside `bounds` might meet it. May say yes too often, never no wrongly: it spares the search.
    fn may_touch(&self, bounds: &Aabb) -> bool {
        let _ = bounds;
        true
    }

    /// Whether it is known that nothing can ever hit it.
    fn is_empty(&self) -> bool {
        false
    }
}

/// A point on a surface and the direction away from it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spot {
    /// Where \[m\].
    pub point: Vec3,
    /// Unit outward normal.
    pub normal: Vec3,
}

/// A straight piece of a particle's path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Segment {
    /// Its beginning \[m\].
    pub from: Vec3,
    /// Its end \[m\].
    pub to: Vec3,
}

/// Where a segment meets a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// The fraction of the segment that is free, in [0, 1].
    pub time: f32,
    /// Unit normal of the surface, on the side that the segment comes from.
    pub normal: Vec3,
    /// How far from the computed point the surface may really be \[m\]: a few units in the last place of the
    /// coordinates involved, never an absolute epsilon.
    pub slack: f32,
}

/// An axis-aligned box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aabb {
    /// Least coordinates \[m\].
    pub min: Vec3,
    /// Greatest coordinates \[m\].
    pub max: Vec3,
}

/// Any of the lecture's shapes; `M` is how a mesh is held: borrowed, shared, or still the name of a file.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "snake_case"))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub enum Shape<M> {
    /// A straight line between two points.
    Line(Line),
    /// The surface of an axis-aligned box.
    Box(Cuboid),
    /// A filled disc.
    Circle(Disc),
    /// The surface of a sphere.
    Sphere(Sphere),
    /// A cylinder about the y axis, with its caps.
    Cylinder(Cylinder),
    /// A cone about the y axis, with its base.
    Cone(Cone),
    /// A triangle mesh.
    Mesh(M),
    /// One triangle.
    Triangle(Triangle),
    /// An infinite plane, hit from both sides.
    Plane(Plane),
}

impl Segment {
    /// From one end to the other \[m\].
    #[inline]
    #[must_use]
    pub fn step(&self) -> Vec3 {
        self.to - self.from
    }

    /// The point at a fraction of it.
    #[inline]
    #[must_use]
    pub fn at(&self, time: f32) -> Vec3 {
        self.from + self.step() * time
    }

    /// A bound on the rounding error of a distance between it and something of extent `size` around the origin.
    #[inline]
    pub(crate) fn slack(&self, size: f32) -> f32 {
        4.0 * f32::EPSILON * (max(largest(self.from), largest(self.to)) + size)
    }
}

impl Aabb {
    /// Nothing: joining it with anything gives that.
    pub const EMPTY: Self = Self { min: Vec3::INFINITY, max: Vec3::NEG_INFINITY };

    /// The box around points.
    #[must_use]
    pub fn around(points: impl IntoIterator<Item = Vec3>) -> Self {
        points.into_iter().fold(Self::EMPTY, |b, p| Self { min: b.min.min(p), max: b.max.max(p) })
    }

    /// The box around two boxes.
    #[must_use]
    pub fn join(self, other: Self) -> Self {
        Self { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    /// Whether the two share a point, rounding errors of a few units in the last place allowed for.
    #[inline]
    #[must_use]
    pub fn overlaps(&self, other: &Self) -> bool {
        let room = 8.0 * f32::EPSILON;
        let (low, high) = (high(self.min, other.min), low(self.max, other.max));
        low.x - room * low.x.abs() <= high.x + room * high.x.abs()
            && low.y - room * low.y.abs() <= high.y + room * high.y.abs()
            && low.z - room * low.z.abs() <= high.z + room * high.z.abs()
    }

    /// The middle \[m\].
    #[must_use]
    pub fn center(&self) -> Vec3 {
        (self.min + self.max) * 0.5
    }

    /// Half the diagonal \[m\].
    #[must_use]
    pub fn radius(&self) -> f32 {
        crate::math::length(self.max - self.min) * 0.5
    }
}

/// Hands a call to whichever shape it is.
macro_rules! each {
    ($shape:expr, $s:ident => $call:expr) => {
        match $shape {
            Shape::Line($s) => $call,
            Shape::Box($s) => $call,
            Shape::Circle($s) => $call,
            Shape::Sphere($s) => $call,
            Shape::Cylinder($s) => $call,
            Shape::Cone($s) => $call,
            Shape::Mesh($s) => $call,
            Shape::Triangle($s) => $call,
            Shape::Plane($s) => $call,
        }
    };
}

impl<M: Surface> Surface for Shape<M> {
    fn area(&self) -> f32 {
        each!(self, s => s.area())
    }
    fn sample(&self, u: [f32; 3]) -> Spot {
        each!(self, s => s.sample(u))
    }
    fn nearest(&self, point: Vec3) -> Vec3 {
        each!(self, s => s.nearest(point))
    }
    fn bounds(&self) -> Aabb {
        each!(self, s => s.bounds())
    }
}

impl<M: Collider> Collider for Shape<M> {
    fn first_hit(&self, segment: &Segment) -> Option<Hit> {
        each!(self, s => s.first_hit(segment))
    }
    fn may_touch(&self, bounds: &Aabb) -> bool {
        each!(self, s => s.may_touch(bounds))
    }
}

impl<M> Shape<M> {
    /// The same shape with its mesh, if it is one, held in another way.
    ///
    /// # Errors
    /// Whatever `f` says.
    pub fn with_mesh<N, E>(&self, f: impl FnOnce(&M) -> Result<N, E>) -> Result<Shape<N>, E> {
        Ok(match self {
            Self::Line(s) => Shape::Line(*s),
            Self::Box(s) => Shape::Box(*s),
            Self::Circle(s) => Shape::Circle(*s),
            Self::Sphere(s) => Shape::Sphere(*s),
            Self::Cylinder(s) => Shape::Cylinder(*s),
            Self::Cone(s) => Shape::Cone(*s),
            Self::Mesh(m) => Shape::Mesh(f(m)?),
            Self::Triangle(s) => Shape::Triangle(*s),
            Self::Plane(s) => Shape::Plane(*s),
        })
    }
}

impl Collider for () {
    fn first_hit(&self, _: &Segment) -> Option<Hit> {
        None
    }
    fn may_touch(&self, _: &Aabb) -> bool {
        false
    }
    fn is_empty(&self) -> bool {
        true
    }
}

impl<T: Collider + ?Sized> Collider for &T {
    fn first_hit(&self, segment: &Segment) -> Option<Hit> {
        (**self).first_hit(segment)
    }
    fn may_touch(&self, bounds: &Aabb) -> bool {
        (**self).may_touch(bounds)
    }
    fn is_empty(&self) -> bool {
        (**self).is_empty()
    }
}

impl<T: Collider> Collider for [T] {
    fn first_hit(&self, segment: &Segment) -> Option<Hit> {
        self.iter().fold(None, |best, c| earlier(best, c.first_hit(segment)))
    }
    fn may_touch(&self, bounds: &Aabb) -> bool {
        self.iter().any(|c| c.may_touch(bounds))
    }
    fn is_empty(&self) -> bool {
        self.iter().all(Collider::is_empty)
    }
}

/// Everything that holds a slice is what the slice is.
macro_rules! lists {
    ($($(#[$when:meta])* [$($generics:tt)*] $list:ty;)+) => {$(
        $(#[$when])*
        impl<$($generics)*> Collider for $list {
            fn first_hit(&self, segment: &Segment) -> Option<Hit> {
                self.as_slice().first_hit(segment)
            }
            fn may_touch(&self, bounds: &Aabb) -> bool {
                self.as_slice().may_touch(bounds)
            }
            fn is_empty(&self) -> bool {
                self.iter().all(Collider::is_empty)
            }
        }
    )+};
}
lists! {
    [T: Collider, const N: usize] [T; N];
    [T: Collider, const N: usize] heapless::Vec<T, N>;
    #[cfg(feature = "alloc")]
    [T: Collider] alloc::vec::Vec<T>;
}

macro_rules! tuples {
    ($($name:ident)+) => {
        impl<$($name: Collider),+> Collider for ($($name,)+) {
            fn first_hit(&self, segment: &Segment) -> Option<Hit> {
                #[allow(non_snake_case)]
                let ($($name,)+) = self;
                let mut best = None;
                $(best = earlier(best, $name.first_hit(segment));)+
                best
            }
            fn may_touch(&self, bounds: &Aabb) -> bool {
                #[allow(non_snake_case)]
                let ($($name,)+) = self;
                $($name.may_touch(bounds))||+
            }
            fn is_empty(&self) -> bool {
                #[allow(non_snake_case)]
                let ($($name,)+) = self;
                $($name.is_empty())&&+
            }
        }
    };
}
tuples!(A);
tuples!(A B);
tuples!(A B C);
tuples!(A B C D);
tuples!(A B C D E);
tuples!(A B C D E F);

/// The earlier of two hits, the first where they tie.
pub(crate) fn earlier(a: Option<Hit>, b: Option<Hit>) -> Option<Hit> {
    match (a, b) {
        (Some(x), Some(y)) => Some(if y.time < x.time { y } else { x }),
        (a, b) => a.or(b),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rng::Stream;
    use proptest::prelude::*;

    fn all() -> [Shape<Mesh<'static>>; 5] {
        let center = Vec3::new(0.3, -0.2, 0.5);
        [
            Shape::Box(Cuboid { min: Vec3::new(-0.5, -0.4, -0.3), max: Vec3::new(0.6, 0.7, 0.2) }),
            Shape::Sphere(Sphere { center, radius: 0.7 }),
            Shape::Cylinder(Cylinder { center, radius: 0.5, height: 1.2 }),
            Shape::Cone(Cone { center, radius: 0.6, height: 1.1 }),
            Shape::Circle(Disc { center, normal: Vec3::new(1.0, 2.0, -3.0), radius: 0.8 }),
        ]
    }

    fn numbers(i: u32) -> [f32; 3] {
        let stream = Stream::new(1, 2, i);
        [stream.units(0)[0], stream.units(0)[1], stream.units(1)[0]]
    }

    #[test]
    fn samples_lie_on_the_surface_and_normals_point_away() {
        for shape in all() {
            for i in 0..2000 {
                let spot = shape.sample(numbers(i));
                assert!((shape.nearest(spot.point) - spot.point).length() < 1e-6, "{shape:?} {spot:?}");
                assert!((spot.normal.length() - 1.0).abs() < 1e-6);
                let off = spot.point + spot.normal * 1e-3;
                assert!(((shape.nearest(off) - off).length() - 1e-3).abs() < 1e-5, "{shape:?} {spot:?}");
            }
        }
    }

    #[test]
    fn nearest_is_no_farther_than_any_sample() {
        for shape in all() {
            for i in 0..200 {
                let [x, y, z] = numbers(i + 5000);
                let point = Vec3::new(x, y, z) * 3.0 - 1.5;
                let distance = (shape.nearest(point) - point).length();
                let best = (0..3000).map(|k| (shape.sample(numbers(k)).point - point).length()).fold(9.0, f32::min);
                assert!(distance <= best + 1e-6, "{shape:?} {point}: {distance} > {best}");
                assert!(best - distance < 0.15, "{shape:?} {point}: {distance} far below {best}");
            }
        }
    }

    #[test]
    fn bounds_hold_every_sample_tightly() {
        for shape in all() {
            let b = shape.bounds();
            let seen = Aabb::around((0..20_000).map(|i| shape.sample(numbers(i)).point));
            assert!(seen.min.cmpge(b.min - 1e-6).all() && seen.max.cmple(b.max + 1e-6).all(), "{shape:?}");
            assert!((seen.max - b.max).length() < 0.1 && (seen.min - b.min).length() < 0.1, "{shape:?} {seen:?} {b:?}");
        }
    }

    proptest! {
        /// A path's hit lies on the surface, faces the start, and the way to it is free.
        #[test]
        fn a_hit_is_on_the_surface_and_the_way_to_it_is_free(
            from in prop::array::uniform3(-2.0f32..2.0), to in prop::array::uniform3(-2.0f32..2.0)
        ) {
            let segment = Segment { from: from.into(), to: to.into() };
            for shape in all() {
                let Some(hit) = shape.first_hit(&segment) else { continue };
                prop_assert!((0.0..=1.0).contains(&hit.time));
                let point = segment.at(hit.time);
                prop_assert!((shape.nearest(point) - point).length() < 1e-5, "{shape:?} {segment:?} {hit:?}");
                prop_assert!(segment.step().dot(hit.normal) < 1e-6);
                let before = Segment { from: segment.from, to: segment.at(hit.time) + hit.normal * 1e-5 };
                if hit.time > 1e-3 {
                    let again = shape.first_hit(&before);
                    prop_assert!(again.is_none_or(|h| h.time > 0.999), "{shape:?} {segment:?} {hit:?} {again:?}");
                }
            }
        }

        /// However a path is cut, its pieces together hit what the whole hits.
        #[test]
        fn a_path_cut_in_two_hits_all_the_same(
            from in prop::array::uniform3(-2.0f32..2.0), to in prop::array::uniform3(-2.0f32..2.0), cut in 0.0f32..1.0
        ) {
            let whole = Segment { from: from.into(), to: to.into() };
            let middle = whole.at(cut);
            for shape in all() {
                let Some(hit) = shape.first_hit(&whole) else { continue };
                // A graze within rounding may be judged either way.
                if hit.normal.dot(crate::math::unit(whole.step())) > -0.02 { continue }
                let first = shape.first_hit(&Segment { from: whole.from, to: middle });
                let second = shape.first_hit(&Segment { from: middle, to: whole.to });
                prop_assert!(first.is_some() || second.is_some(), "{shape:?} {whole:?} {middle}");
            }
        }
    }

    #[test]
    fn a_particle_on_the_surface_that_leaves_does_not_hit_it() {
        for shape in all() {
            for i in 0..2000 {
                let spot = shape.sample(numbers(i));
                // Set off by the rounding error, as the response does it.
                let from = spot.point + spot.normal * 2e-6;
                let away = Segment { from, to: from + spot.normal };
                assert_eq!(shape.first_hit(&away), None, "{shape:?} {spot:?}");
                let inward = Segment { from, to: from - spot.normal * 0.1 };
                let hit = shape.first_hit(&inward).expect("a path into the surface hits it");
                assert!(hit.time < 1e-4, "{shape:?} {hit:?}");
            }
        }
    }

    #[test]
    fn lists_of_colliders_are_colliders() {
        let near = Plane { point: Vec3::Y, normal: Vec3::Y };
        let far = Plane { point: Vec3::ZERO, normal: Vec3::Y };
        let down = Segment { from: Vec3::Y * 2.0, to: -Vec3::Y };
        let hit = |c: &dyn Collider| c.first_hit(&down).map(|h| h.time);
        assert_eq!(hit(&()), None);
        assert_eq!(hit(&(far, near)), hit(&near));
        assert_eq!(hit(&[far, near]), hit(&near));
        assert_eq!(hit(&(far, (), &near as &dyn Collider)), hit(&near));
        assert!(().is_empty() && ((), ()).is_empty() && !(far, ()).is_empty());
    }
}
