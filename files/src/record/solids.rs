//! The surfaces of rigid bodies: corners beside their particles, which follow these, and faces between them.

use super::frame::{Column, Frame, Values};
use pointmass::force::Springs;
use pointmass::scene::Model;
use pointmass::{RigidBox, Vec3};
use std::borrow::Cow;

/// The faces of a box, by its corners: whose bits say on what side of x, y and z each is.
const QUADS: [[u32; 4]; 6] = [[1, 3, 7, 5], [0, 4, 6, 2], [2, 6, 7, 3], [0, 1, 5, 4], [4, 5, 7, 6], [0, 2, 3, 1]];

/// The determinant of a body's moments, in units of their trace, below which its particles lie in a plane.
const FLAT: f64 = 1e-12;

/// A rigid body at the scene's start.
#[derive(Debug)]
pub(super) struct Solid {
    /// Its particles, by their number there, and where each was.
    members: Vec<(u32, Vec3)>,
    /// Where its corners were, and its triangles between them.
    corners: Vec<Vec3>,
    triangles: Vec<[u32; 3]>,
}

/// Corners of bodies at an instant, and what they are part of.
#[derive(Clone, Debug, Default)]
pub(super) struct Surfaces {
    /// Where each is and how fast, and the row of a particle of its body.
    corners: Vec<([Vec3; 2], u32)>,
    /// Triangles, by corners from 0.
    triangles: Vec<[u32; 3]>,
    /// The rows of all particles of these bodies.
    pub(super) members: Vec<u32>,
}

impl Solid {
    /// All of a scene.
    pub(super) fn all(model: &Model) -> Vec<Self> {
        let bodies = &model.constraints.1;
        bodies.boxes.iter().map(|of| Self::of(of, model)).collect()
    }

    fn of(body: &RigidBox, model: &Model) -> Self {
        let numbers = body.first..body.first.saturating_add(body.count);
        let members = numbers.filter_map(|number| Some((number, model.particles.get(number as usize)?.position)));
        let (corners, triangles): (Vec<_>, Vec<_>) = match model.surface(body) {
            Some(surface) => surface,
            None => {
                let side = |corner: u32, bit: u32| if corner >> bit & 1 == 1 { 1.0 } else { -1.0 };
                let corner = |i| body.half * Vec3::new(side(i, 0), side(i, 1), side(i, 2));
                let halves = QUADS.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]);
                ((0..8).map(corner).collect(), halves.collect())
            }
        };
        let turn = body.rotation();
        let corners = corners.into_iter().map(|corner| body.center + turn * corner).collect();
        Self { members: members.collect(), corners, triangles }
    }

    /// Adds its corners and faces as its particles are now, by their places in a frame, unless too many of them have died.
    pub(super) fn add(&self, springs: &Springs<'_>, now: [&[Vec3]; 2], place: &[u32], to: &mut Surfaces) {
        let rows: Vec<(usize, Vec3)> =
            self.members.iter().filter_map(|&(number, start)| Some((springs.row(number)?, start))).collect();
        let share = 1.0 / rows.len() as f32;
        let mean = |of: &dyn Fn(usize) -> Vec3| rows.iter().map(|&(row, _)| of(row) * share).sum::<Vec3>();
        let middle = now.map(|column| mean(&|row| column[row]));
        let rest: Vec3 = rows.iter().map(|&(_, start)| start * share).sum();
        // The linear map that takes its particles from where they were to where they are, and to their velocities.
        let sum = |of: &dyn Fn(usize) -> Vec3| {
            let columns = [Vec3::X, Vec3::Y, Vec3::Z];
            columns.map(|axis| rows.iter().map(|&(row, q)| of(row) * (q - rest).dot(axis)).sum::<Vec3>())
        };
        // Of slender bodies more figures count than 32 bits hold.
        let moments = |[i, j]: [usize; 2]| {
            rows.iter().map(|&(_, q)| f64::from((q - rest)[i]) * f64::from((q - rest)[j])).sum::<f64>()
        };
        let [xx, yy, zz] = [[0, 0], [1, 1], [2, 2]].map(moments);
        let [yz, zx, xy] = [[1, 2], [2, 0], [0, 1]].map(moments);
        let first = [yy * zz - yz * yz, yz * zx - xy * zz, xy * yz - yy * zx];
        let (trace, volume) = (xx + yy + zz, xx * first[0] + xy * first[1] + zx * first[2]);
        // Particles that lie in a plane do not tell where the rest of their body is.
        if !(volume > FLAT * (trace * trace * trace)) {
            return;
        }
        let second = [first[1], xx * zz - zx * zx, xy * zx - xx * yz];
        let third = [first[2], second[2], xx * yy - xy * xy];
        let inverse = [first, second, third].map(|row| Vec3::from_array(row.map(|part| (part / volume) as f32)));
        let maps = [0, 1].map(|i| sum(&|row| now[i][row] - middle[i]));
        let corner = |&corner: &Vec3| {
            let shares = inverse.map(|row| row.dot(corner - rest));
            [0, 1].map(|i| middle[i] + maps[i][0] * shares[0] + maps[i][1] * shares[1] + maps[i][2] * shares[2])
        };
        let corners: Vec<[Vec3; 2]> = self.corners.iter().map(corner).collect();
        let Some(&(first, _)) = rows.first() else { return };
        if !corners.iter().flatten().all(|place| place.is_finite()) {
            return;
        }
        let before = to.corners.len() as u32;
        to.corners.extend(corners.into_iter().map(|corner| (corner, place[first])));
        to.triangles.extend(self.triangles.iter().map(|face| face.map(|corner| before + corner)));
        to.members.extend(rows.iter().map(|&(row, _)| place[row]));
    }
}

impl Frame {
    /// The particles with the corners of bodies behind them, which have what the first particle of their body has, but for place and velocity, and
    /// but for what sums up over a body, which its particles have; and all faces.
    pub(super) fn with_surfaces(&self) -> Cow<'_, Self> {
        let Surfaces { corners, triangles, .. } = &self.surfaces;
        if corners.is_empty() {
            return Cow::Borrowed(self);
        }
        let mut frame = self.clone();
        frame.columns.iter_mut().for_each(|column| extend(column, corners));
        frame.colors.extend(corners.iter().map(|&(_, row)| self.colors[row as usize]));
        let first = self.len as u32;
        frame.faces.extend(triangles.iter().map(|face| face.map(|corner| first + corner)));
        frame.len += corners.len();
        Cow::Owned(frame)
    }

    /// How many vertices of a frame with corners are particles.
    pub(super) fn particles(&self) -> usize {
        self.len - self.surfaces.corners.len()
    }

    /// The remark that there are others; nothing, where all are particles.
    pub(super) fn remark(&self) -> Option<String> {
        let count = self.particles();
        (count < self.len).then(|| format!("{count} particles, then corners of bodies"))
    }
}

/// Puts the values of corners behind those of particles.
fn extend(column: &mut Column, corners: &[([Vec3; 2], u32)]) {
    const AXES: [&str; 6] = ["x", "y", "z", "vx", "vy", "vz"];
    const SUMS: [&str; 3] = ["mass", "drag", "charge"];
    let axis = AXES.iter().position(|name| *name == column.name);
    if let (Some(axis), Values::Single(values)) = (axis, &mut column.values) {
        values.extend(corners.iter().map(|(corner, _)| corner[axis / 3][axis % 3]));
        return;
    }
    if let (true, Values::Single(values)) = (SUMS.contains(&column.name.as_str()), &mut column.values) {
        values.resize(values.len() + corners.len(), 0.0);
        return;
    }
    let rows = corners.iter().map(|&(_, row)| row as usize);
    match &mut column.values {
        Values::Single(values) => rows.for_each(|row| values.push(values[row])),
        Values::Double(values) => rows.for_each(|row| values.push(values[row])),
        Values::Unsigned(values) => rows.for_each(|row| values.push(values[row])),
        Values::Signed(values) => rows.for_each(|row| values.push(values[row])),
        Values::Byte(values) => rows.for_each(|row| values.push(values[row])),
    }
}
