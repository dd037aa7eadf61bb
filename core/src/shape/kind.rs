//! Any of the shapes.

#[cfg(feature = "alloc")]
use super::HeightFieldBuf;
use super::{
    Aabb, Affine, Capsule, Collider, Cone, Contact, Cuboid, Cylinder, Disc, Facing, Hit, Hulls, Line, Mapped, Marks,
    Plane, Segment, Sphere, Spot, Surface, Triangle,
};
use crate::time::Time;
use glam::Vec3;

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
    /// A cylinder about any axis with half a sphere at either end.
    Capsule(Capsule),
    /// A triangle mesh.
    Mesh(M),
    /// One triangle.
    Triangle(Triangle),
    /// An infinite plane, hit from both sides.
    Plane(Plane),
    /// Ground: heights over a grid.
    #[cfg(feature = "alloc")]
    #[cfg_attr(feature = "serde", serde(rename = "heightfield"))]
    HeightField(HeightFieldBuf),
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
            Shape::Capsule($s) => $call,
            Shape::Mesh($s) => $call,
            Shape::Triangle($s) => $call,
            Shape::Plane($s) => $call,
            #[cfg(feature = "alloc")]
            Shape::HeightField($s) => $call,
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
    fn around(&self) -> [Vec3; 4] {
        each!(self, s => s.around())
    }
    fn is_inside(&self, point: Vec3) -> bool {
        each!(self, s => s.is_inside(point))
    }
}

impl<M: Collider> Collider for Shape<M> {
    fn moves(&self) -> bool {
        each!(self, s => s.moves())
    }
    fn first_hit(&self, segment: &Segment) -> Option<Hit> {
        each!(self, s => s.first_hit(segment))
    }
    fn may_touch(&self, bounds: &Aabb) -> bool {
        each!(self, s => s.may_touch(bounds))
    }
    fn mark_near(&self, hulls: &Hulls, marks: &mut Marks) {
        each!(self, s => s.mark_near(hulls, marks));
    }
    fn facing(&self, bounds: &Aabb) -> Facing {
        each!(self, s => s.facing(bounds))
    }
    #[cfg(feature = "alloc")]
    fn solid(&self) -> Option<super::Solid> {
        each!(self, s => s.solid())
    }
    fn contacts(&self, center: Vec3, reach: f32, at: Time, visit: &mut dyn FnMut(&Contact)) {
        each!(self, s => s.contacts(center, reach, at, visit));
    }
    fn contacts_of(&self, faces: &[u32], center: Vec3, reach: f32, at: Time, visit: &mut dyn FnMut(&Contact)) {
        each!(self, s => s.contacts_of(faces, center, reach, at, visit));
    }
}

impl<M: Mapped> Mapped for Shape<M> {
    fn image(&self, map: &Affine, bounds: &Aabb, visit: &mut dyn FnMut(u32, &dyn Collider)) {
        each!(self, s => s.image(map, bounds, visit));
    }
}

impl<M> Shape<M> {
    /// Tells whether balls meet it as it is where `map` puts it. Squashed spheres and circles, and cylinders and cones
    /// with bases that are not round, they meet as their centres alone would.
    #[must_use]
    pub fn meets_balls(&self, map: &Affine) -> bool {
        match self {
            Self::Sphere(_) | Self::Circle(_) | Self::Capsule(_) => map.keeps_shapes(),
            Self::Cylinder(_) | Self::Cone(_) => map.keeps_shapes() || map.keeps_bases(),
            _ => true,
        }
    }

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
            Self::Capsule(s) => Shape::Capsule(*s),
            Self::Mesh(m) => Shape::Mesh(f(m)?),
            Self::Triangle(s) => Shape::Triangle(*s),
            Self::Plane(s) => Shape::Plane(*s),
            #[cfg(feature = "alloc")]
            Self::HeightField(s) => Shape::HeightField(s.clone()),
        })
    }
}
