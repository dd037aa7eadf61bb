//! What an impulse between a particle and a place on a body does to all of them.

use super::super::rope::Held;
use super::super::turn::{across, inverse, solve};
use crate::math::{dot, largest, length, max, sqrt};
use glam::{Mat3, Vec3};

/// How far beside its place a body is pulled at the most, a share of its radius of gyration.
const BESIDE: f32 = 0.5;

/// What a particle and a body that it is tied to do when they are pulled together: each by the gradient of C, and the body by a couple more, so that
/// both forces act along one line where the particle is away from its place.
#[derive(Clone, Copy)]
pub(super) struct Grip {
    /// The inverse mass of the particle \[1/kg\], and the place's: how far an impulse moves it by the body's particles' own shares.
    pub(super) own: f32,
    shared: Mat3,
    /// The inverse mass of the body as a whole \[1/kg\]; zero: some of it is fixed, and no momentum to be kept.
    whole: f32,
    /// Its centre of mass, from its first particle \[m\], and Σ m r rᵀ over its mass.
    pub(super) center: Vec3,
    pub(super) spread: Mat3,
    /// The place, from there, and how far beside it the body is pulled: at the particle.
    arm: Vec3,
    beside: Vec3,
    /// Of a triangle with an offset: its normal, and the offset times the slope of each corner's share.
    pub(super) normal: Vec3,
    pub(super) slopes: [Vec3; 3],
    /// True if the body is to move as a rigid one.
    is_one: bool,
    /// For how long their velocities are taken back to find where all were \[s\].
    pub(super) back: f32,
}

impl Grip {
    /// That of a particle with such an inverse mass, alone.
    pub(super) fn new(own: f32, back: f32) -> Self {
        let [center, arm, beside, normal] = [Vec3::ZERO; 4];
        let [shared, spread] = [Mat3::ZERO; 2];
        let (whole, is_one, slopes) = (0.0, false, [Vec3::ZERO; 3]);
        Self { own, shared, whole, center, spread, arm, beside, normal, slopes, is_one, back }
    }

    /// Adds one of the body's particles, with its share and its inverse mass.
    pub(super) fn add(&mut self, number: usize, weight: f32, inverse: f32) {
        let column = |axis: Vec3| {
            let given = self.given(number, weight, axis) * inverse;
            given * weight - self.slope(number) * dot(self.normal, given)
        };
        let [x, y, z] = [Vec3::X, Vec3::Y, Vec3::Z].map(column);
        self.shared += Mat3::from_cols(x, y, z);
    }

    /// Says that it is free, and how heavy; where its place is, and the particle, from its first particle.
    pub(super) fn free(&mut self, mass: f32, [place, particle]: [Vec3; 2]) {
        let trace = self.spread.x_axis.x + self.spread.y_axis.y + self.spread.z_axis.z;
        let most = BESIDE * sqrt(max(trace, 0.0));
        let beside = particle - place;
        let far = length(beside);
        self.beside = if far <= most { beside } else { beside * (most / far) };
        (self.whole, self.arm) = (1.0 / mass, place - self.center);
        if !self.beside.is_finite() {
            self.beside = Vec3::ZERO;
        }
    }

    /// That of the body as a rigid one, where it is free: it then moves without being deformed.
    pub(super) fn as_one(mut self) -> Self {
        if self.whole > 0.0 {
            (self.shared, self.beside) = (Mat3::from_diagonal(Vec3::splat(self.whole)), self.arm);
            self.is_one = true;
        }
        self
    }

    /// Tells whether anything moves.
    pub(super) fn moves(&self) -> bool {
        self.own + (self.shared.x_axis.x + self.shared.y_axis.y + self.shared.z_axis.z) > 0.0
    }

    /// How large it is \[m\].
    pub(super) fn size(&self) -> f32 {
        max(largest(self.arm), largest(self.center))
    }

    fn slope(&self, number: usize) -> Vec3 {
        self.slopes.get(number).copied().unwrap_or(Vec3::ZERO)
    }

    /// The part of an impulse that one of the body's particles takes.
    fn given(&self, number: usize, weight: f32, pull: Vec3) -> Vec3 {
        pull * weight - self.normal * dot(self.slope(number), pull)
    }

    /// How the body turns by the couple of an impulse \[kg m\] that acts beside its place.
    pub(super) fn turn(&self, pull: Vec3) -> Vec3 {
        solve(self.spread, self.beside.cross(pull) * self.whole)
    }

    /// How far a particle of the body goes under an impulse whose couple turns it so: the particle with a number, `arm` from the centre.
    pub(super) fn moved(&self, (number, weight, inverse): (usize, f32, f32), pull: Vec3, turn: [Vec3; 2]) -> Vec3 {
        let [turn, arm] = turn;
        let given = if self.is_one { pull * self.whole } else { self.given(number, weight, pull) * inverse };
        given + turn.cross(arm)
    }

    /// How far an impulse \[kg m\] moves the body's place.
    pub(super) fn given_way(&self, pull: Vec3) -> Vec3 {
        self.shared * pull + self.turn(pull).cross(self.arm)
    }

    /// How heavy the place is at the least, in any direction \[kg\]: infinitely, if nothing moves it.
    pub(super) fn least_mass(&self) -> f32 {
        let ways = [Vec3::X, Vec3::Y, Vec3::Z].map(|axis| self.given_way(axis).abs());
        1.0 / (ways[0] + ways[1] + ways[2]).max_element()
    }

    /// How heavy the place is for a particle of such a mass \[kg\] that is joined to it; none if that is no number.
    pub(super) fn held(&self, own: f32) -> Option<Held> {
        let [x, y, z] = [Vec3::X, Vec3::Y, Vec3::Z].map(|axis| self.given_way(axis));
        let way = Mat3::from_cols(x, y, z);
        if way == Mat3::ZERO {
            return Some(Held { mass: Mat3::ZERO, inverse: Mat3::ZERO });
        }
        // What rounding has left askew would take energy, or give some.
        let mass = inverse((way + way.transpose()) * 0.5)?;
        Some(Held { mass, inverse: inverse(mass + Mat3::from_diagonal(Vec3::splat(own)))? })
    }

    /// The impulse that moves the particle against its place by this \[m\], with so much softness \[1/kg\]; none if nothing does.
    pub(super) fn answer(&self, soft: f32, by: Vec3) -> Option<Vec3> {
        let columns = [Vec3::X, Vec3::Y, Vec3::Z].map(|axis| axis * (self.own + soft) + self.given_way(axis));
        let scale = columns[0].x + columns[1].y + columns[2].z;
        across(columns.map(|column| column / scale), by / scale)
    }
}
