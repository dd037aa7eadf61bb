//! A shape put elsewhere: turned, scaled, sheared and moved.

use super::{Aabb, Collider, Hit, Segment, Surface};
use crate::math::{high, length, unit};
use glam::{Mat3, Vec3};

/// A linear map and a shift.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Affine {
    /// Turning, scaling, shearing.
    pub linear: Mat3,
    /// The image of the origin \[m\].
    pub shift: Vec3,
}

/// A collider in coordinates of its own.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placed<C> {
    collider: C,
    /// Of the collider as it stands in the world.
    bounds: Aabb,
    /// To the world and back; none, if it stands where it is.
    maps: Option<(Affine, Affine)>,
    material: Option<u16>,
}

impl Affine {
    /// Everything stays where it is.
    pub const IDENTITY: Self = Self { linear: Mat3::IDENTITY, shift: Vec3::ZERO };

    /// The image of a point.
    #[must_use]
    pub fn point(&self, p: Vec3) -> Vec3 {
        self.linear * p + self.shift
    }

    /// A box around the image of a box; everything, if the box has no finite image.
    #[must_use]
    pub fn bounds(&self, bounds: &Aabb) -> Aabb {
        let Aabb { min, max } = *bounds;
        let corner = |i: u8| {
            let pick = |bit: u8, low: f32, high: f32| if i & bit == 0 { low } else { high };
            self.point(Vec3::new(pick(1, min.x, max.x), pick(2, min.y, max.y), pick(4, min.z, max.z)))
        };
        let image = Aabb::around((0..8).map(corner));
        let everything = Aabb { min: Vec3::NEG_INFINITY, max: Vec3::INFINITY };
        if min.is_finite() && max.is_finite() { image } else { everything }
    }

    /// First `inner`, then this.
    #[must_use]
    pub fn after(&self, inner: &Self) -> Self {
        Self { linear: self.linear * inner.linear, shift: self.point(inner.shift) }
    }

    /// The way back, if there is one.
    #[must_use]
    pub fn inverse(&self) -> Option<Self> {
        let linear = self.linear.inverse();
        let sound = self.linear.determinant() != 0.0 && linear.is_finite();
        sound.then(|| Self { linear, shift: -(linear * self.shift) })
    }
}

impl<C: Surface> Placed<C> {
    /// Puts `collider` where `to_world` says; `None` if that flattens space, so that there is no way back.
    #[must_use]
    pub fn new(collider: C, to_world: Affine) -> Option<Self> {
        let bounds = to_world.bounds(&collider.bounds());
        // What cancels on the way there and back is rounding that the coordinates themselves do not show.
        let reach = high(collider.bounds().min.abs(), collider.bounds().max.abs());
        let room = (to_world.linear.abs() * reach + to_world.shift.abs()) * (16.0 * f32::EPSILON);
        let bounds = Aabb { min: bounds.min - room, max: bounds.max + room };
        let to_local = to_world.inverse()?;
        let maps = (to_world != Affine::IDENTITY).then_some((to_world, to_local));
        Some(Self { collider, bounds, maps, material: None })
    }

    /// The same, made of the scene's material with this number.
    #[must_use]
    pub fn made_of(self, material: Option<u16>) -> Self {
        Self { material, ..self }
    }
}

impl<C: Collider> Collider for Placed<C> {
    fn first_hit(&self, segment: &Segment) -> Option<Hit> {
        let Some((to_world, to_local)) = &self.maps else {
            return self.collider.first_hit(segment).map(|hit| Hit { material: self.material, ..hit });
        };
        // Lines stay lines and fractions stay fractions; normals go by the inverse transpose.
        let local = Segment { from: to_local.point(segment.from), to: to_local.point(segment.to), ..*segment };
        let hit = self.collider.first_hit(&local)?;
        let columns = to_world.linear;
        let stretch = length(Vec3::new(length(columns.x_axis), length(columns.y_axis), length(columns.z_axis)));
        Some(Hit {
            normal: unit(to_local.linear.transpose() * hit.normal),
            slack: hit.slack * stretch + segment.slack(crate::math::largest(to_world.shift)),
            material: self.material,
            ..hit
        })
    }

    fn may_touch(&self, bounds: &Aabb) -> bool {
        // Its own answer is the sharper one: of a plane, say.
        if self.maps.is_none() { self.collider.may_touch(bounds) } else { self.bounds.overlaps(bounds) }
    }

    fn is_empty(&self) -> bool {
        self.collider.is_empty()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shape::Sphere;

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
