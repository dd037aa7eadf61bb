//! A shape put elsewhere: turned, scaled, sheared and moved.

use super::collider::contacts_among;
use super::{Aabb, Affine, Collider, Contact, Facing, Hit, Hulls, Mapped, Marks, Segment, Surface, earlier};
use crate::math::{high, largest, length, unit};
use crate::time::Time;
use glam::Vec3;

/// A collider in coordinates of its own.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placed<C> {
    collider: C,
    /// The box around the collider as it stands in the world.
    bounds: Aabb,
    /// To the world and back; none, if it stands where it is.
    maps: Option<(Affine, Affine)>,
    /// How much longer all lengths are in the world, and within which share of them; none, if directions differ.
    scale: Option<[f32; 2]>,
    material: Option<u16>,
}

/// A velocity in the world; that of what is at rest stays as it is, the signs of its zeros too.
fn carried(to_world: &Affine, velocity: Vec3) -> Vec3 {
    if velocity == Vec3::ZERO { velocity } else { to_world.linear * velocity }
}

impl<C: Surface> Placed<C> {
    /// Puts `collider` where `to_world` says; `None` if that flattens space, so that there is no way back.
    #[must_use]
    pub fn new(collider: C, to_world: Affine) -> Option<Self> {
        let bounds = to_world.bounds(&collider.bounds());
        // Terms that cancel on the way there and back leave rounding that the coordinates themselves do not show.
        let reach = high(collider.bounds().min.abs(), collider.bounds().max.abs());
        let room = (to_world.linear.abs() * reach + to_world.shift.abs()) * (16.0 * f32::EPSILON);
        let bounds = Aabb { min: bounds.min - room, max: bounds.max + room };
        let to_local = to_world.inverse()?;
        let maps = (to_world != Affine::IDENTITY).then_some((to_world, to_local));
        Some(Self { collider, bounds, maps, scale: to_world.scale(), material: None })
    }

    /// A box around it in the world.
    #[must_use]
    pub fn bounds(&self) -> Aabb {
        self.bounds
    }

    /// The same, made of the scene's material with this number.
    #[must_use]
    pub fn made_of(self, material: Option<u16>) -> Self {
        Self { material, ..self }
    }
}

impl<C: Mapped> Placed<C> {
    /// Visits the contacts of all faces of a collider, or of some; under a map that does not keep shapes, those of its image.
    fn visit(&self, faces: Option<&[u32]>, (center, reach): (Vec3, f32), at: Time, visit: &mut dyn FnMut(&Contact)) {
        let Some((to_world, to_local)) = &self.maps else {
            let mut made = |contact: &Contact| visit(&Contact { material: self.material, ..*contact });
            return contacts_among(&self.collider, faces, (center, reach), at, &mut made);
        };
        let Some([scale, _]) = self.scale else {
            let near = Aabb { min: center - reach, max: center + reach }.with_slack();
            return self.collider.image(to_world, &near, &mut |face, image| {
                if faces.is_none_or(|faces| faces.contains(&face)) {
                    let made = &mut |contact: &Contact| visit(&Contact { material: self.material, face, ..*contact });
                    image.contacts(center, reach, at, made);
                }
            });
        };
        let around = (to_local.point(center), reach / scale);
        contacts_among(&self.collider, faces, around, at, &mut |contact| {
            let normal = unit(to_local.linear.transpose() * contact.normal);
            let distance = contact.distance * scale;
            let point = center - normal * distance;
            let velocity = carried(to_world, contact.velocity);
            let slack = contact.slack * scale + Segment::new(center, center).slack(largest(to_world.shift));
            visit(&Contact { point, normal, distance, slack, velocity, material: self.material, face: contact.face });
        });
    }
}

impl<C: Mapped> Collider for Placed<C> {
    fn moves(&self) -> bool {
        self.collider.moves()
    }

    fn first_hit(&self, segment: &Segment) -> Option<Hit> {
        let Some(maps @ (to_world, _)) = &self.maps else {
            return self.collider.first_hit(segment).map(|hit| Hit { material: self.material, ..hit });
        };
        let Some([scale, error]) = self.scale else {
            // A ball is round in the world only, so that is where the image is met; here its centre, as a last resort.
            let center = self.hit_in(maps, segment, 0.0, 0.0);
            return if segment.radius > 0.0 { earlier(self.image_hit(to_world, segment), center) } else { center };
        };
        self.hit_in(maps, segment, segment.radius / scale, segment.radius * error)
    }

    fn contacts(&self, center: Vec3, reach: f32, at: Time, visit: &mut dyn FnMut(&Contact)) {
        self.visit(None, (center, reach), at, visit);
    }

    fn contacts_of(&self, faces: &[u32], center: Vec3, reach: f32, at: Time, visit: &mut dyn FnMut(&Contact)) {
        self.visit(Some(faces), (center, reach), at, visit);
    }

    fn may_touch(&self, bounds: &Aabb) -> bool {
        // Its own answer is the sharper one: of a plane, say.
        if self.maps.is_none() { self.collider.may_touch(bounds) } else { self.bounds.with_slack().overlaps(bounds) }
    }

    fn mark_near(&self, hulls: &Hulls, marks: &mut Marks) {
        if self.maps.is_none() { self.collider.mark_near(hulls, marks) } else { hulls.near_box(&self.bounds, marks) }
    }

    fn facing(&self, bounds: &Aabb) -> Facing {
        match self.maps {
            None => self.collider.facing(bounds).made_of(self.material),
            Some(_) if self.may_touch(bounds) => Facing::Several,
            Some(_) => Facing::Nothing,
        }
    }

    #[cfg(feature = "alloc")]
    fn solid(&self) -> Option<super::Solid> {
        if self.maps.is_none() && self.material.is_none() { self.collider.solid() } else { None }
    }

    fn is_empty(&self) -> bool {
        self.collider.is_empty()
    }
}

impl<C: Mapped> Placed<C> {
    /// The first hit in the collider's own coordinates, where the ball has this `radius` and is round within `error`.
    fn hit_in(&self, maps: &(Affine, Affine), segment: &Segment, radius: f32, error: f32) -> Option<Hit> {
        let (to_world, to_local) = maps;
        // Lines stay lines and fractions stay fractions; normals go by the inverse transpose.
        let local = Segment { from: to_local.point(segment.from), to: to_local.point(segment.to), radius, ..*segment };
        let hit = self.collider.first_hit(&local)?;
        Some(Hit {
            normal: unit(to_local.linear.transpose() * hit.normal),
            slack: hit.slack * length(to_world.lengths().into()) + segment.slack(largest(to_world.shift)) + error,
            velocity: carried(to_world, hit.velocity),
            material: self.material,
            ..hit
        })
    }

    /// The first hit of a ball on the image.
    fn image_hit(&self, to_world: &Affine, segment: &Segment) -> Option<Hit> {
        let mut best = None;
        self.collider.image(to_world, &segment.bounds(), &mut |face, image| {
            let hit = image.first_hit(segment).map(|hit| Hit { face, material: self.material, ..hit });
            best = earlier(best, hit);
        });
        best
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shape::Sphere;
    use glam::Mat3;

    #[test]
    fn a_squashed_sphere_is_hit_where_the_ellipsoid_is() {
        let map = Affine { linear: Mat3::from_diagonal(Vec3::new(2.0, 1.0, 0.5)), shift: Vec3::new(1.0, 0.0, 0.0) };
        let unit_sphere = Sphere { center: Vec3::ZERO, radius: 1.0 };
        let placed = Placed::new(unit_sphere, map).expect("it can be undone");
        let hit = placed.first_hit(&Segment::new(Vec3::new(5.0, 0.0, 0.0), Vec3::new(1.0, 0.0, 0.0)));
        let hit = hit.expect("it goes in");
        assert!((hit.time - 0.5).abs() < 1e-6 && (hit.normal - Vec3::X).length() < 1e-6);
        // At (1 + √2, √½, 0) the normal is along (x/4, y, 0).
        let p = Vec3::new(core::f32::consts::SQRT_2, core::f32::consts::FRAC_1_SQRT_2, 0.0);
        let normal = unit(Vec3::new(p.x / 4.0, p.y, 0.0));
        let p = p + Vec3::X;
        let hit = placed.first_hit(&Segment::new(p + normal, p - normal)).expect("it goes in");
        assert!((hit.time - 0.5).abs() < 1e-6 && (hit.normal - normal).length() < 1e-5);
    }

    #[test]
    fn a_flattening_map_is_refused() {
        let flat = Affine { linear: Mat3::from_diagonal(Vec3::new(1.0, 0.0, 1.0)), shift: Vec3::ZERO };
        assert_eq!(Placed::new(Sphere { center: Vec3::ZERO, radius: 1.0 }, flat), None);
    }

    #[test]
    fn maps_compose_and_invert() {
        let a = Affine { linear: Mat3::from_cols(Vec3::Y, -Vec3::X, Vec3::Z), shift: Vec3::new(1.0, 2.0, 3.0) };
        let b = Affine { linear: Mat3::from_diagonal(Vec3::new(2.0, -3.0, 0.5)), shift: Vec3::new(-1.0, 0.5, 0.0) };
        let p = Vec3::new(0.3, -0.7, 1.9);
        assert!((a.after(&b).point(p) - a.point(b.point(p))).length() < 1e-6);
        let back = a.after(&b).inverse().expect("it can be undone");
        assert!((back.point(a.after(&b).point(p)) - p).length() < 1e-6);
    }
}
