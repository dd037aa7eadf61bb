//! Rigid bodies: where their boxes are and how they are turned, by their particles.

use super::{Instance, appearance, fill};
use crate::constrain::RigidBox;
use crate::force::State;
use crate::math::{dot, frame, unit};
use crate::particles::Particle;
use glam::{Mat3, Vec3};

/// How far the axes of an affine image may be from those of a turn, in squares of their lengths: more than rounding makes of it.
const SHEAR: f32 = 0.1;

/// The square of the sine below which particles are on a line.
const LINE: f32 = 1e-8;

/// The box of a rigid body as it stands now, as an instance of the cube from −1 to 1 with the colour and material of its first particle that
/// lives. `start` is what the scene begins with. None: no particle lives, or it is out of sight.
///
/// The particles' places now are an affine image of those at the start, found by least squares. Where too few live for that, or such as are in a
/// plane, it is turned as these are; about a line on which all are it has not turned since the start.
#[must_use]
pub fn body(state: &State<'_>, body: &RigidBox, start: &[Particle]) -> Option<Instance> {
    let turn = body.rotation();
    let members = (body.first..body.first.saturating_add(body.count)).filter_map(|number| {
        let row = state.springs.row(number)?;
        let place = turn.transpose() * (start.get(number as usize)?.position - body.center);
        Some((row, place))
    });
    let (mut count, mut mean, mut rest) = (0.0, Vec3::ZERO, Vec3::ZERO);
    for (row, place) in members.clone() {
        (count, mean, rest) = (count + 1.0, mean + state.position[row], rest + place);
    }
    let (mean, rest) = (mean / count, rest / count);
    let (mut to, mut spread) = (Mat3::ZERO, Mat3::ZERO);
    for (row, place) in members.clone() {
        let (x, q) = (state.position[row] - mean, place - rest);
        to += Mat3::from_cols(x * q.x, x * q.y, x * q.z);
        spread += Mat3::from_cols(q * q.x, q * q.y, q * q.z);
    }
    let Mat3 { x_axis: a, y_axis: b, z_axis: c } = spread;
    let rotation = to * (Mat3::from_cols(b.cross(c), c.cross(a), a.cross(b)).transpose() * (1.0 / a.dot(b.cross(c))));
    let ways = members.clone().map(|(row, place)| (place - rest, state.position[row] - mean));
    let rotation = if is_turn(rotation) { rotation } else { turned(ways, turn) };
    let center = mean - rotation * rest;
    let (row, _) = members.clone().next()?;
    let color = appearance(state, row)?.color;
    let axes =
        Mat3::from_cols(rotation.x_axis * body.half.x, rotation.y_axis * body.half.y, rotation.z_axis * body.half.z);
    let material = state.material.get(row).and_then(|number| number.checked_sub(1)).unwrap_or(u16::MAX);
    (color[3] > 0 && (axes.x_axis + axes.y_axis + axes.z_axis + center).is_finite()).then_some(Instance {
        center,
        axes,
        color,
        material,
    })
}

/// Tells whether a linear map is a turn, but for rounding.
fn is_turn(map: Mat3) -> bool {
    let Mat3 { x_axis: x, y_axis: y, z_axis: z } = map;
    let lengths = [dot(x, x) - 1.0, dot(y, y) - 1.0, dot(z, z) - 1.0];
    let slants = [dot(x, y), dot(y, z), dot(z, x)];
    lengths.into_iter().chain(slants).all(|off| off.abs() < SHEAR) && dot(x, y.cross(z)) > 0.0
}

/// The turn that takes ways within a body to what they are now: the longest to its direction, and the one farthest off it to that side. Where all
/// are on a line, the one that brings this to its direction on the shortest way from how the body was turned at the start.
fn turned(ways: impl Iterator<Item = (Vec3, Vec3)> + Clone, start: Mat3) -> Mat3 {
    let none = (Vec3::ZERO, Vec3::ZERO);
    let longer = |a: (Vec3, Vec3), b: (Vec3, Vec3)| if dot(b.0, b.0) > dot(a.0, a.0) { b } else { a };
    let (own, now) = ways.clone().fold(none, longer);
    let (side, turned_side) = ways.map(|(q, x)| (own.cross(q), now.cross(x))).fold(none, longer);
    let square = dot(own, own);
    if dot(side, side) > LINE * (square * square) {
        return frame_of(unit(now), unit(turned_side)) * frame_of(unit(own), unit(side)).transpose();
    }
    let (from, to) = (start * unit(own), unit(now));
    let axis = unit(from.cross(to));
    // Along the same line to and fro there are many shortest ways.
    let axis = if axis == Vec3::ZERO { frame(to).0 } else { axis };
    if to == Vec3::ZERO { start } else { frame_of(to, axis) * frame_of(from, axis).transpose() * start }
}

/// A turn whose first axes are the given ones, square to each other.
fn frame_of(x: Vec3, y: Vec3) -> Mat3 {
    Mat3::from_cols(x, y, x.cross(y))
}

/// Writes the boxes of all bodies that can be seen, in their order, as far as there is room; returns their number and how many were left out.
///
/// ```
/// use pointmass::constrain::{RigidBodies, RigidBox};
/// use pointmass::draw::{Instance, bodies};
/// use pointmass::{Heap, Particle, Scene, System, Time, Vec3};
///
/// // A quarter turn about z in half a second.
/// let cuboid = RigidBox::new(Vec3::new(0.3, 0.2, 0.1), Vec3::ZERO, 0);
/// let spin = Vec3::Z * core::f32::consts::PI;
/// let start = cuboid.solid(Particle::REST).map(|p| Particle { velocity: spin.cross(p.position), ..p });
/// let boxes = RigidBodies::boxes([cuboid]);
/// let scene = Scene { start: &start, constraints: &boxes, substeps: 20, ..Scene::EMPTY };
/// let mut system = System::with(Heap::new(scene.size()));
/// system.start(&scene, 1)?;
/// (1..=30).for_each(|frame| drop(system.step_to(&scene, Time::frame(frame, 60))));
/// let mut drawn = [Instance::NONE; 1];
/// assert_eq!(bodies(&system.state(&scene), &boxes.boxes, &start, &mut drawn), (1, 0));
/// assert!((drawn[0].axes.x_axis - Vec3::Y * 0.3).length() < 1e-3);
/// # Ok::<(), pointmass::InsufficientMemory>(())
/// ```
pub fn bodies(state: &State<'_>, list: &[RigidBox], start: &[Particle], into: &mut [Instance]) -> (usize, usize) {
    fill(list.iter().filter_map(|one| body(state, one, start)), into)
}
