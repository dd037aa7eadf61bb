//! Two bodies that touch, or a body and the scenery: where, and what they have done to each other.

use super::span::Span;
use crate::material::Mixed;
use crate::math::{dot, max, min};
use core::mem::offset_of;
use glam::{Mat3, Vec3};

/// Where two touch. What a sub-step changes of it comes first, in fours.
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(super) struct Point {
    /// The impulse that keeps them apart, and that of friction on the second, in the world \[N s\].
    pub(super) pressed: f32,
    pub(super) held: Vec3,
    /// The change that forces make to the speed of either in a sub-step \[m/s\].
    pub(super) driven: f32,
    /// How far the second has crept along the first since friction has held them there, in the world \[m\].
    pub(super) crept: Vec3,
    /// From the centre of each to where they press on each other \[m\].
    pub(super) arms: [Vec3; 2],
    /// The place on each, in its box's frame \[m\].
    pub(super) places: [Vec3; 2],
    /// How the scenery moves there, in the mean over the sub-step, and how fast along the normal \[m/s\].
    pub(super) surface: Vec3,
    pub(super) lift: f32,
}

impl Point {
    /// The speed below which the two come together by their weight, not by a blow \[m/s\].
    pub(super) fn calm(&self, span: Span) -> f32 {
        self.driven * span.calm()
    }
}

/// Points that two have at the most.
pub(super) const POINTS: usize = 4;

/// Directions that one body can be pressed in by the scenery at a time.
pub(super) const DIRECTIONS: usize = 3;

/// Two bodies, and the pieces of each of them, by their numbers: lists are in this order.
pub(super) type Key = ([u32; 2], [u8; 2]);

/// Two that may touch.
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(super) struct Manifold {
    /// Their numbers, the lower first; zero: the world.
    pub(super) bodies: [u32; 2],
    /// How far they may go against each other before where they touch is looked for again \[m\].
    pub(super) spare: f32,
    /// How many points there are.
    pub(super) count: u32,
    /// Its place in the order.
    pub(super) colour: u32,
    /// 1 if they have touched since before one of them fell asleep, which is fixed for the other now.
    pub(super) rested: u8,
    /// 1 if one presses on the other.
    pub(super) presses: u8,
    /// Which of the pieces of each it is that may touch, by their numbers.
    pub(super) pieces: [u8; 2],
    /// The force of the first on the second, and its torque about the first's centre, when one of them fell asleep \[N, N m\].
    pub(super) loads: [Vec3; 2],
    /// The normal in the world.
    pub(super) axis: Vec3,
    /// From the first to the second, in the first's frame. What follows up to the friction is read in one go.
    pub(super) normal: Vec3,
    pub(super) elasticity: f32,
    pub(super) friction: [f32; 2],
    /// The coefficient of friction that is in force: of what rests, or of what slides.
    pub(super) grip: f32,
    pub(super) points: [Point; POINTS],
}

impl Manifold {
    /// Two that touch nowhere yet.
    pub(super) fn of((bodies, pieces): Key, mixed: Mixed) -> Self {
        let Mixed { elasticity, friction } = mixed;
        let elasticity = min(max(elasticity, 0.0), 1.0);
        let friction = [max(friction.static_, friction.kinetic), friction.kinetic];
        Self { bodies, pieces, elasticity, friction, grip: friction[0], ..bytemuck::Zeroable::zeroed() }
    }

    /// Who it is of.
    pub(super) fn key(&self) -> Key {
        (self.bodies, self.pieces)
    }

    /// Takes what is known of another pair: the places that it has, not those beyond.
    pub(super) fn take(&mut self, other: &Self) {
        let words = (offset_of!(Self, points) + size_of_val(other.points())) / 4;
        let to: &mut [u32] = bytemuck::cast_slice_mut(core::slice::from_mut(self));
        let from: &[u32] = bytemuck::cast_slice(core::slice::from_ref(other));
        to[..words].copy_from_slice(&from[..words]);
    }

    /// Its points.
    pub(super) fn points(&self) -> &[Point] {
        &self.points[..(self.count as usize).min(4)]
    }

    /// The mean force of the first on the second in a sub-step of `h` \[s\], and its torque about the first's centre \[N, N m\].
    pub(super) fn load(&self, h: f32) -> [Vec3; 2] {
        let mut sum = [Vec3::ZERO; 2];
        for point in self.points() {
            let force = (self.axis * point.pressed + point.held) * (1.0 / h);
            sum = [sum[0] + force, sum[1] + point.arms[0].cross(force)];
        }
        sum
    }

    /// Puts a point in, with what a point of before near it has done. `axes` are those of the first's frame.
    pub(super) fn put(&mut self, places: [Vec3; 2], before: &[Point], near: f32, axes: &Mat3) {
        let is_near = |point: &&Point| {
            let way = point.places[1] - places[1];
            dot(way, way) <= near * near
        };
        let Some(place) = self.points.get_mut(self.count as usize) else { return };
        self.count += 1;
        if let Some(point) = before.iter().find(is_near) {
            *place = *point;
            place.places = [places[0] - axes.transpose() * point.crept, places[1]];
        } else {
            *place = Point { places, ..bytemuck::Zeroable::zeroed() };
        }
    }
}

/// Pairs, and what touches the scenery: so many for each body as it can be pressed in directions.
pub(super) struct Manifolds<'a> {
    pub(super) pairs: &'a mut [Manifold],
    pub(super) scenery: &'a mut [Manifold],
}

impl Manifolds<'_> {
    /// Those of the scenery are numbered after the pairs.
    #[inline(always)]
    pub(super) fn get(&self, number: u32) -> Option<&Manifold> {
        let number = number as usize;
        self.pairs.get(number).or_else(|| self.scenery.get(number.wrapping_sub(self.pairs.len())))
    }

    #[inline(always)]
    pub(super) fn get_mut(&mut self, number: u32) -> Option<&mut Manifold> {
        let (number, pairs) = (number as usize, self.pairs.len());
        self.pairs.get_mut(number).or_else(|| self.scenery.get_mut(number.wrapping_sub(pairs)))
    }
}
