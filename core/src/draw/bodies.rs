//! Rigid bodies: where their boxes are and how they are turned, by their particles.

use super::{Instance, appearance, fill};
use crate::constrain::RigidBox;
use crate::force::State;
use crate::particles::Particle;
use glam::{Mat3, Vec3};

/// The box of a rigid body as it stands now, as an instance of the cube from −1 to 1 with the colour and material of its first particle that
/// lives. `start` is what the scene begins with. None: fewer than four particles that are not in a plane live, or it is out of sight.
///
/// The particles' places now are an affine image of those at the start, found by least squares.
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
