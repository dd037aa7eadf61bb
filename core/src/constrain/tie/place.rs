//! The place on a body that a particle is tied to: learning it, and finding it again.

use super::super::Bodies;
use super::super::turn::{across, outer};
use super::grip::Grip;
use super::{HEAD, Tie};
use crate::index::between;
use crate::math::{dot, length, unit};
use glam::{Mat3, Vec3};

/// The share of the extent squared below which particles lie in a plane or on a line.
const FLAT: f32 = 1e-6;
/// What is added to that where they do, and rounds in which what that changes is taken back.
const RIDGE: f32 = 1e-3;
const ROUNDS: u32 = 4;

/// How far it is from the plane of its triangle \[m\].
pub(super) fn offset(place: &[u32]) -> f32 {
    place.get(HEAD - 1).map_or(0.0, |&word| f32::from_bits(word))
}

/// The shares of the body's particles, as words.
pub(super) fn weights(place: &[u32]) -> impl Iterator<Item = u32> + '_ {
    place.get(HEAD..).unwrap_or_default().iter().copied()
}

/// The normal of a triangle from its first corner: its area twice, and its direction.
fn normal(edges: [Vec3; 2]) -> (f32, Vec3) {
    let across = edges[0].cross(edges[1]);
    (length(across), unit(across))
}

impl<T: AsRef<[u32]>, W: AsRef<[f32]>> Tie<T, W> {
    /// The row of one of the body's particles.
    fn row(&self, bodies: &Bodies<'_>, number: usize) -> Option<usize> {
        bodies.row_of_start(*self.to.as_ref().get(number)?)
    }

    /// The way from the body's first particle, whose row this is, to another one's, as they were `back` \[s\] before by their velocities.
    fn way(bodies: &Bodies<'_>, first: usize, row: usize, back: f32) -> Vec3 {
        let at = |row: usize| bodies.position[row] - bodies.velocity[row] * back;
        between(bodies.near.room(), at(first), at(row))
    }

    /// The way from one of the body's particles to another.
    fn edge(&self, bodies: &Bodies<'_>, [from, to]: [usize; 2], back: f32) -> Option<Vec3> {
        Some(Self::way(bodies, self.row(bodies, from)?, self.row(bodies, to)?, back))
    }

    /// Takes the shares and the offset that are given, or those of where the particle is.
    pub(super) fn learn(&self, bodies: &Bodies<'_>, kept: &mut [u32]) {
        let Some((head, shares)) = kept.split_at_mut_checked(HEAD) else { return };
        head[1..].copy_from_slice(&[0, self.offset.to_bits()]);
        if self.weights.is_none() {
            let Some(offset) = self.measure(bodies, shares) else { return };
            head[2] = offset.to_bits();
        } else {
            shares.iter_mut().zip(self.given()).for_each(|(share, weight)| *share = weight.to_bits());
        }
        head[1] = 1;
    }

    /// Writes the shares of where the particle is; tells the offset.
    fn measure(&self, bodies: &Bodies<'_>, shares: &mut [u32]) -> Option<f32> {
        let (tied, first) = (bodies.row_of_start(self.particle)?, self.row(bodies, 0)?);
        let to = self.to.as_ref();
        let at = |number: usize| Some(Self::way(bodies, first, self.row(bodies, number)?, 0.0));
        let x = Self::way(bodies, first, tied, 0.0);
        let mut put = |number: usize, weight: f32| {
            if let Some(share) = shares.get_mut(number) {
                *share = if weight.is_finite() { weight.to_bits() } else { 0 };
            }
        };
        match to.len() {
            1 => put(0, 1.0),
            2 => {
                let edge = at(1)?;
                let along = dot(x, edge) / dot(edge, edge);
                let along = if along.is_finite() { along } else { 0.5 };
                put(0, 1.0 - along);
                put(1, along);
            }
            3 => {
                let edges = [at(1)?, at(2)?];
                let (area, normal) = normal(edges);
                let second = dot(x.cross(edges[1]), normal) / area;
                let third = dot(edges[0].cross(x), normal) / area;
                let sound = second.is_finite() && third.is_finite();
                let [second, third] = if sound { [second, third] } else { [1.0 / 3.0; 2] };
                put(0, 1.0 - second - third);
                put(1, second);
                put(2, third);
                return Some(if sound { dot(x, normal) } else { 0.0 });
            }
            count => {
                let share = 1.0 / count as f32;
                let mut center = Vec3::ZERO;
                for number in 0..count {
                    center += at(number)? * share;
                }
                let mut spread = Mat3::ZERO;
                for number in 0..count {
                    let arm = at(number)? - center;
                    spread += outer(arm * share, arm);
                }
                let along = answer(spread, x - center);
                for number in 0..count {
                    put(number, share * (1.0 + dot(at(number)? - center, along)));
                }
            }
        }
        Some(0.0)
    }

    /// The weighted mean of something of the body's particles.
    pub(super) fn mean(&self, bodies: &Bodies<'_>, place: &[u32], first: usize, of: impl Fn(usize) -> Vec3) -> Vec3 {
        let start = of(first);
        let rows = self.to.as_ref().iter().map(|&number| bodies.row_of_start(number));
        let shares = rows.zip(weights(place)).filter_map(|(row, weight)| Some((row?, f32::from_bits(weight))));
        start + shares.fold(Vec3::ZERO, |sum, (row, weight)| sum + (of(row) - start) * weight)
    }

    /// The normal of three particles as they were `back` \[s\] before, from which there is an offset; none if they have none.
    fn lift(&self, bodies: &Bodies<'_>, place: &[u32], back: f32) -> Option<Vec3> {
        let offset = offset(place);
        if offset == 0.0 {
            return Some(Vec3::ZERO);
        }
        let (area, normal) = normal([self.edge(bodies, [0, 1], back)?, self.edge(bodies, [0, 2], back)?]);
        (area > 0.0).then_some(normal * offset)
    }

    /// How far the particle is from its place.
    pub(super) fn open(&self, bodies: &Bodies<'_>, place: &[u32], [tied, first]: [usize; 2]) -> Option<Vec3> {
        let mean = self.mean(bodies, place, first, |row| Self::way(bodies, first, row, 0.0));
        Some(Self::way(bodies, first, tied, 0.0) - mean - self.lift(bodies, place, 0.0)?)
    }

    /// How fast it goes away from there.
    pub(super) fn parting(&self, bodies: &Bodies<'_>, place: &[u32], [tied, first]: [usize; 2]) -> Option<Vec3> {
        let v = &bodies.velocity;
        let mut speed = v[tied] - self.mean(bodies, place, first, |row| v[row]);
        let offset = offset(place);
        if offset != 0.0 {
            let rows = [self.row(bodies, 1)?, self.row(bodies, 2)?];
            let [one, other] = rows.map(|row| Self::way(bodies, first, row, 0.0));
            let (area, normal) = normal([one, other]);
            let turn = (v[rows[0]] - v[first]).cross(other) + one.cross(v[rows[1]] - v[first]);
            speed -= (turn - normal * dot(normal, turn)) * (offset / area);
        }
        speed.is_finite().then_some(speed)
    }

    /// The rows of the particle and of the body's first, and what an impulse at the place does to all; none if one of them is dead, or nothing moves.
    pub(super) fn grip(&self, bodies: &Bodies<'_>, place: &[u32], back: f32) -> Option<([usize; 2], Grip)> {
        let (tied, first) = (bodies.row_of_start(self.particle)?, self.row(bodies, 0)?);
        if place.get(1) != Some(&1) {
            return None;
        }
        let (mut mass, mut is_free) = (0.0, true);
        let (mut sum, mut spot) = (Vec3::ZERO, self.lift(bodies, place, back)?);
        let mut grip = Grip::new(bodies.inverse_mass[tied], back);
        if spot != Vec3::ZERO {
            let edges = [self.edge(bodies, [0, 1], back)?, self.edge(bodies, [0, 2], back)?];
            let (area, normal) = normal(edges);
            let slope = |edge: Vec3| normal.cross(edge) * (offset(place) / area);
            (grip.normal, grip.slopes) = (normal, [slope(edges[1] - edges[0]), slope(-edges[1]), slope(edges[0])]);
        }
        for (number, weight) in weights(place).enumerate() {
            let (row, weight) = (self.row(bodies, number)?, f32::from_bits(weight));
            let way = Self::way(bodies, first, row, back);
            is_free &= bodies.inverse_mass[row] > 0.0;
            mass += bodies.mass[row];
            sum += way * bodies.mass[row];
            spot += way * weight;
            grip.add(number, weight, bodies.inverse_mass[row]);
        }
        if is_free && mass > 0.0 && mass < f32::INFINITY {
            grip.center = sum / mass;
            for &number in self.to.as_ref() {
                let row = bodies.row_of_start(number)?;
                let arm = Self::way(bodies, first, row, back) - grip.center;
                grip.spread += outer(arm * (bodies.mass[row] / mass), arm);
            }
            grip.free(mass, [spot, Self::way(bodies, first, tied, back)]);
        }
        grip.moves().then_some(([tied, first], grip))
    }
}

/// x of B x = b, the least one where B is flat, whose extents squared add up to its trace.
fn answer(spread: Mat3, of: Vec3) -> Vec3 {
    let trace = spread.x_axis.x + spread.y_axis.y + spread.z_axis.z;
    if !(trace > 0.0 && trace < f32::INFINITY) {
        return Vec3::ZERO;
    }
    let [x, y, z] = [spread.x_axis, spread.y_axis, spread.z_axis].map(|column| column / trace);
    let minors = x.x * y.y - x.y * y.x + (y.y * z.z - y.z * z.y) + (z.z * x.x - z.x * x.z);
    let is_flat = !(dot(x, y.cross(z)) > FLAT * minors);
    let ridge = if is_flat { RIDGE } else { 0.0 };
    let columns = [x + Vec3::X * ridge, y + Vec3::Y * ridge, z + Vec3::Z * ridge];
    let mut sum = Vec3::ZERO;
    for _ in 0..ROUNDS {
        sum += across(columns, of / trace - Mat3::from_cols(x, y, z) * sum).unwrap_or(Vec3::ZERO);
    }
    sum
}
