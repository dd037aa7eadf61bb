//! The lecture's shapes. Every file holds one: where births lie on it, how far it is, and where a path first hits it.

mod aabb;
mod affine;
mod ball;
mod capsule;
#[cfg(feature = "alloc")]
mod cells;
mod clearance;
mod collider;
mod cone;
mod convex;
mod crease;
mod cuboid;
mod cylinder;
mod disc;
#[cfg(feature = "alloc")]
pub(crate) mod enclosed;
mod exact;
mod facing;
mod heightfield;
#[cfg(feature = "alloc")]
mod heights;
mod hit;
mod hulls;
mod kind;
mod line;
mod mesh;
#[cfg(feature = "alloc")]
mod moved;
mod moving;
mod place;
mod plane;
mod revolve;
#[cfg(feature = "alloc")]
mod scenery;
mod segment;
mod sliver;
mod solid;
mod sphere;
mod surface;
mod triangle;

pub use aabb::Aabb;
pub use affine::Affine;
pub use capsule::Capsule;
pub use clearance::Clearance;
pub(crate) use clearance::NEAREST;
pub use collider::{Collider, Few, Many, Mapped};
pub use cone::Cone;
pub use crease::Crease;
pub(crate) use crease::is_level;
pub use cuboid::Cuboid;
pub use cylinder::Cylinder;
pub use disc::Disc;
#[cfg(feature = "alloc")]
pub use enclosed::NotSolid;
pub use facing::{Face, Facing};
pub use heightfield::{BadHeights, HeightField};
#[cfg(feature = "alloc")]
pub use heights::{HeightFieldBuf, Heights};
pub(crate) use hit::earlier;
pub use hit::{Contact, Hit, Ride};
pub use hulls::{Hulls, Marks};
pub use kind::Shape;
pub use line::Line;
#[cfg(feature = "alloc")]
pub use mesh::MeshBuf;
pub use mesh::{BadMesh, Mesh};
pub use moving::Moving;
pub use place::Placed;
pub use plane::Plane;
#[cfg(feature = "alloc")]
pub use scenery::Scenery;
pub use segment::Segment;
pub use solid::Solid;
pub use sphere::Sphere;
pub use surface::{Spot, Surface};
pub use triangle::Triangle;

#[cfg(test)]
mod tests;
