//! Remarks on a declared scene: things that it can say, but hardly means.

mod births;
mod contact;
mod forces;
mod idle;
pub(super) mod load;
mod look;
mod place;

use super::{Boxes, Cloth, Cord, Item, PeriodicRoom, Response, Run, SceneFile, SoftBody, Tuft};
use crate::emit::Varied;
use crate::force::Friction;
use crate::shape::{Aabb, Shape, Surface};
use alloc::format;
use alloc::string::String;
use alloc::vec::Vec;
use core::fmt::Arguments;
use glam::Vec3;

/// As many as are told: a large file may have one in every line.
pub(super) const MOST: usize = 1000;

/// Sub-steps that a step may have.
pub(super) const MOST_SUBSTEPS: u32 = 1000;

impl SceneFile {
    /// Remarks on what can be run but is hardly meant, each by its path in the file; the first thousand.
    #[must_use]
    pub fn remarks(&self) -> Vec<String> {
        let mut remarks = Vec::new();
        let mut add = |at: Arguments<'_>, remark: Option<String>| {
            let told = remark.filter(|_| remarks.len() < MOST);
            remarks.extend(told.map(|text| format!("{at}: {text}")));
        };
        add(format_args!("run.capacity"), self.odd_capacity());
        self.add_elasticities(&mut add);
        self.add_springs(&mut add);
        for (i, body) in self.soft_bodies.iter().enumerate() {
            add(
                format_args!("soft_bodies[{i}].radius"),
                self.contacts.and_then(|contacts| body.overlap(contacts.contacts().is_some())),
            );
        }
        self.add_emitters(&mut add);
        add(format_args!("contacts.position"), self.uneven_balls());
        add(format_args!("contacts.position"), self.fine_balls());
        add(format_args!("contacts.impulse"), self.pressed_in());
        add(format_args!("boxes"), self.uneven_boxes());
        self.add_heaps(&mut add);
        for (i, cloth) in self.cloths.iter().enumerate() {
            add(format_args!("cloths[{i}].thickness"), self.heavy_on_cloth(cloth));
            add(format_args!("cloths[{i}].thickness"), self.lets_through(cloth));
            add(format_args!("cloths[{i}]"), self.long_for_plate(cloth));
        }
        for (i, cord) in self.ropes.iter().enumerate() {
            add(format_args!("ropes[{i}].ends"), self.hung_on_sheet(cord));
        }
        for (i, tie) in self.ties.iter().enumerate() {
            add(format_args!("ties[{i}]"), self.sewn_to_sheet(tie));
        }
        // All such ropes are of one kind to whoever reads it.
        if let Some((i, remark)) = self.hung_in_turn() {
            add(format_args!("ropes[{i}].ends"), Some(remark));
        }
        if let Some(Response::Force(penalty)) = self.contacts {
            add(format_args!("contacts.force.friction.static"), odd_friction(penalty.friction));
            add(format_args!("contacts.force.damping"), self.unasked_elasticity());
        }
        for (i, material) in self.materials.iter().enumerate() {
            let friction = material.contact.friction.unwrap_or(Friction::NONE);
            add(format_args!("materials[{i}].contact.friction.static"), odd_friction(friction));
        }
        for (i, item) in self.scenery.iter().enumerate() {
            add(format_args!("scenery[{i}].shape"), self.reaches_out(item));
            add(format_args!("scenery[{i}].shape.triangle"), thin(&item.shape));
        }
        self.add_idle(&mut add);
        self.add_colors(&mut add);
        self.add_unread(&mut add);
        self.add_forces(&mut add);
        self.add_sunk(&mut add);
        self.add_far(&mut add);
        remarks
    }

    /// Remarks on springs.
    fn add_springs(&self, add: &mut impl FnMut(Arguments<'_>, Option<String>)) {
        for (i, spring) in self.springs.iter().enumerate() {
            add(format_args!("springs[{i}].ends"), odd_ends(spring.ends));
            add(format_args!("springs[{i}].ks"), odd_strength(spring.ks));
            add(format_args!("springs[{i}].kd"), odd_strength(spring.kd));
            let length = spring.rest_length;
            let shorter = || format!("{length} m is below 0: it pulls, by so much more, even where its ends meet");
            add(format_args!("springs[{i}].rest_length"), (length < 0.0).then(shorter));
        }
    }

    /// A remark on what reaches out of the room through one side and not through the opposite one, where it would come in again.
    fn reaches_out(&self, item: &Item) -> Option<String> {
        let stands = item.group.is_none() && item.motion.is_none();
        let Aabb { min, max } = stands.then(|| finite_bounds(&item.shape))??;
        let PeriodicRoom { low, sides } = self.room?;
        let names = ["x", "y", "z"].into_iter().zip(min.to_array().into_iter().zip(max.to_array()));
        let mut axes = names.zip(low.into_iter().zip(sides));
        let (name, _) = axes
            .find(|&((_, (min, max)), (low, side))| {
                let touches = side > 0.0 && max > low && min < low + side;
                touches && (min < low) != (max > low + side) && max - min < side
            })?
            .0;
        Some(format!(
            "it reaches out of the room along {name}, and does not act through its sides; put another one where it comes in again"
        ))
    }

    /// Remarks on the elasticity of what the scene begins with.
    fn add_elasticities(&self, add: &mut impl FnMut(Arguments<'_>, Option<String>)) {
        let mut look = |list: &str, i: usize, elasticity: f32| {
            add(format_args!("{list}[{i}].elasticity"), odd_elasticity(Varied::exactly(elasticity)));
        };
        // A fixed particle hits nothing.
        let free = self.particles.iter().enumerate().filter(|(_, particle)| !particle.fixed);
        free.for_each(|(i, particle)| look("particles", i, particle.elasticity));
        self.cloths.iter().enumerate().for_each(|(i, cloth)| look("cloths", i, cloth.elasticity));
        self.boxes.iter().enumerate().for_each(|(i, boxes)| look("boxes", i, boxes.elasticity));
        self.strands.iter().enumerate().for_each(|(i, tuft)| look("strands", i, tuft.elasticity));
        self.ropes.iter().enumerate().for_each(|(i, cord)| look("ropes", i, cord.elasticity));
        self.soft_bodies.iter().enumerate().for_each(|(i, body)| look("soft_bodies", i, body.elasticity));
    }

    /// A remark on room for fewer than there are from the beginning. As many as are usual may not have been said at all.
    fn odd_capacity(&self) -> Option<String> {
        let (capacity, (least, is_all)) = (self.run.capacity, self.least_start());
        if capacity == Run::default().capacity || u64::from(capacity) >= least {
            return None;
        }
        let more = if is_all { "" } else { " and more" };
        let message = format!(
            "{capacity} is less than the {least} particles{more} that the scene begins with, which have room all the same; take no less"
        );
        Some(message)
    }

    /// The particles that it begins with, as far as they are known before meshes have been read, and whether those are all.
    fn least_start(&self) -> (u64, bool) {
        let cloths = self.cloths.iter().map(Cloth::count);
        let bodies = self.soft_bodies.iter().map(SoftBody::particles);
        let known = self.boxes.iter().map(Boxes::particles).chain(self.strands.iter().map(Tuft::particles));
        let known = known.chain(self.ropes.iter().map(Cord::particles)).map(Some);
        let own = (self.particles.len() as u64, true);
        known
            .chain(cloths)
            .chain(bodies)
            .fold(own, |(sum, is_all), more| (sum.saturating_add(more.unwrap_or(0)), is_all && more.is_some()))
    }
}

/// A remark on a triangle without an area.
fn thin(shape: &Shape<String>) -> Option<String> {
    let Shape::Triangle(triangle) = shape else { return None };
    let [a, b, c] = triangle.corners;
    ((b - a).cross(c - a) == Vec3::ZERO).then(|| "its corners lie on a line, so nothing hits it".into())
}

/// The bounds of a shape that needs no file and is finite.
fn finite_bounds(shape: &Shape<String>) -> Option<Aabb> {
    match shape {
        Shape::Box(cuboid) => Some(cuboid.bounds()),
        Shape::Circle(disc) => Some(disc.bounds()),
        Shape::Sphere(sphere) => Some(sphere.bounds()),
        Shape::Cylinder(cylinder) => Some(cylinder.bounds()),
        Shape::Cone(cone) => Some(cone.bounds()),
        Shape::Capsule(capsule) => Some(capsule.bounds()),
        Shape::Triangle(triangle) => Some(triangle.bounds()),
        Shape::Mesh(_) | Shape::Line(_) | Shape::Plane(_) | Shape::HeightField(_) => None,
    }
}

/// A remark on an odd share of the speed that hits leave.
pub(super) fn odd_elasticity(Varied { mean, half_width }: Varied) -> Option<String> {
    /// The error that sums of decimals may have.
    const ROUNDING: f32 = 1e-6;
    let (least, most) = (mean - half_width.abs(), mean + half_width.abs());
    if most > 1.0 + ROUNDING {
        return Some(format!("{most} is above 1, so hits add energy"));
    }
    (least < -ROUNDING).then(|| format!("{least} is below 0, which counts as 0: hits leave nothing of a speed"))
}

/// A remark on odd ends of a spring.
fn odd_ends([a, b]: [u32; 2]) -> Option<String> {
    (a == b).then(|| format!("the spring joins particle {a} to itself, so it does nothing"))
}

/// A remark on an odd stiffness or damping of a spring.
fn odd_strength(number: f32) -> Option<String> {
    (number < 0.0).then(|| format!("{number} is below 0, so the spring gains energy without bound"))
}

fn odd_friction(Friction { static_, kinetic }: Friction) -> Option<String> {
    let odd = static_ < kinetic;
    odd.then(|| format!("{static_} is below kinetic, {kinetic}, though what rests is held more than what slides"))
}
