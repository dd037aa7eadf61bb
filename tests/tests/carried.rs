//! Rigid bodies go with what carries them, awake or asleep, and fall when it goes.

use pointmass::constrain::{RigidBodies, RigidBox};
use pointmass::force::Friction;
use pointmass::motion::{Key, Motion};
use pointmass::shape::{Aabb, Cuboid, Moving, Plane};
use pointmass::{ContactMaterial, Gravity, Heap, Mat3, Particle, Scene, System, Time, Vec3};
use pointmass_tests::{every, is_third, started};

const DOWN: Gravity = Gravity { acceleration: Vec3::new(0.0, -9.81, 0.0) };
const GROUND: Plane = Plane { point: Vec3::ZERO, normal: Vec3::Y };
/// A slab that is turned, of a half width that all bodies are far within.
const TABLE: Aabb = Aabb { min: Vec3::new(-2.0, -0.5, -2.0), max: Vec3::new(2.0, 0.0, 2.0) };
const PART: Particle = Particle { material: Some(0), elasticity: 0.0, ..Particle::REST };
const ROUGH: [ContactMaterial; 1] =
    [ContactMaterial { elasticity: None, friction: Some(Friction { static_: 0.5, kinetic: 0.5 }) }];

fn go(system: &mut System<Heap>, scene: &Scene<'_>, frames: u32) {
    for _ in 0..frames {
        system.step(scene, Time::frame(1, 60));
    }
}

/// The middle of a body's particles, none of which has died.
fn middle(system: &System<Heap>, of: &RigidBox) -> Vec3 {
    let rows = of.first as usize..(of.first + of.count) as usize;
    system.particles().position[rows].iter().sum::<Vec3>() / of.count as f32
}

/// Boxes on a belt that moves, one on the other, are carried along, the topmost as the lowest, however slow it is.
#[test]
fn a_belt_carries_what_lies_on_it() {
    for (count, speed, substeps) in [(1, 0.005, 10), (1, 0.2, 4), (3, 0.005, 10), (4, 0.0005, 10)] {
        let slab = Cuboid { min: Vec3::new(-2.0, -0.5, -2.0), max: Vec3::new(2.0, 0.0, 2.0) };
        let keys = [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0];
        let keys = keys.map(|time| Key { time, place: Vec3::X * speed * time, rotation: Vec3::ZERO });
        let belt = Moving::new(slab, &Aabb { min: slab.min, max: slab.max }, Motion::with_keys(keys, 0.0));
        let place = |i: u32| Vec3::Y * (0.1 + 0.2 * i as f32);
        let boxes: Vec<_> = (0..count).map(|i| RigidBox::new(Vec3::splat(0.1), place(i), 8 * i)).collect();
        let start: Vec<_> = boxes.iter().flat_map(|of| of.solid(PART)).collect();
        let bodies = RigidBodies::boxes(boxes.clone());
        let parts = Scene { start: &start, forces: &DOWN, colliders: &belt, materials: &ROUGH, ..Scene::EMPTY };
        let scene = Scene { constraints: &bodies, substeps, ..parts };
        let mut system = started(&scene, start.len(), 0);
        go(&mut system, &scene, 480);
        for of in &boxes {
            let way = middle(&system, of) - of.center;
            assert!((way - Vec3::X * speed * 8.0).length() < 0.01 * speed * 8.0 + 1e-4, "{count} {speed}: {way}");
        }
    }
}

/// A box asleep on balls that are held, or on a box that lies on loose balls and so is awake, falls when these die.
#[test]
fn who_sleeps_on_what_dies_or_falls_falls() {
    for (fixed, count) in [(true, 1), (false, 2)] {
        for scale in [1.0, 0.3, 3.0] {
            let boxes: Vec<_> = (0..count)
                .map(|i| (Vec3::new(0.2, 0.05, 0.2) * scale, Vec3::Y * (0.25 + 0.1 * i as f32) * scale, 8 * i))
                .map(|(half, center, first)| RigidBox::new(half, center, first))
                .collect();
            let mut start: Vec<_> = boxes.iter().flat_map(|of| of.solid(PART)).collect();
            for (x, z) in [(-0.15, -0.15), (0.15, -0.15), (0.15, 0.15), (-0.15, 0.15)] {
                let position = Vec3::new(x, 0.1, z) * scale;
                start.push(Particle { position, radius: 0.1 * scale, lifetime: 5.0, fixed, ..PART });
            }
            let bodies = RigidBodies { boxes: boxes.clone(), hulls: (), balls: 8 };
            let parts = Scene { start: &start, forces: &DOWN, colliders: &GROUND, materials: &ROUGH, ..Scene::EMPTY };
            let scene = Scene { constraints: &bodies, substeps: 10, ..parts };
            let mut system = started(&scene, start.len(), 0);
            go(&mut system, &scene, 299);
            go(&mut system, &scene, 90);
            for of in &boxes {
                let fell = of.center.y - middle(&system, of).y;
                assert!((fell - 0.2 * scale).abs() < 0.01 * scale, "{fixed} {count} {scale}: {fell}");
            }
        }
    }
}

/// Boxes on a table as large as `scale` says, each told by half its sides and its middle.
#[derive(Clone, Copy)]
struct OnTable<'a> {
    boxes: &'a [(Vec3, Vec3)],
    scale: f32,
    substeps: u32,
    /// They start as fast as a table that turns about y does there \[rad/s\].
    spin: f32,
}

impl OnTable<'_> {
    /// Where the particles of the boxes start, those of one after the other, and are in the end; the number of contacts that found no place.
    fn run(&self, motion: Motion<Vec<Key>>, frames: u32) -> (Vec<Vec3>, Vec<Vec3>, u64) {
        let Self { boxes, scale, substeps, spin } = *self;
        let (min, max) = (TABLE.min * scale, TABLE.max * scale);
        let table = Moving::new(Cuboid { min, max }, &Aabb { min, max }, motion);
        let boxes: Vec<_> = boxes
            .iter()
            .zip((0..).step_by(8))
            .map(|(&(half, center), first)| RigidBox::new(half * scale, center * scale, first))
            .collect();
        let mut start: Vec<_> = boxes.iter().flat_map(|of| of.solid(PART)).collect();
        for particle in &mut start {
            particle.velocity = (Vec3::Y * spin).cross(particle.position);
        }
        let bodies = RigidBodies::boxes(boxes);
        let parts = Scene { start: &start, forces: &DOWN, colliders: &table, materials: &ROUGH, ..Scene::EMPTY };
        let scene = Scene { constraints: &bodies, substeps, ..parts };
        let mut system = started(&scene, start.len(), 0);
        let mut left_out = 0;
        for _ in 0..frames {
            left_out += system.step(&scene, Time::frame(1, 60)).caps.contacts;
        }
        let places = start.iter().map(|particle| particle.position).collect();
        (places, system.particles().position.to_vec(), left_out)
    }
}

const CENTRED: [(Vec3, Vec3); 1] = [(Vec3::splat(0.1), Vec3::new(0.0, 0.1, 0.0))];
const APART: [(Vec3, Vec3); 3] = [
    (Vec3::splat(0.1), Vec3::new(0.7, 0.1, 0.2)),
    (Vec3::new(0.3, 0.05, 0.2), Vec3::new(-0.4, 0.05, 0.1)),
    (Vec3::new(0.05, 0.1, 0.05), Vec3::new(0.05, 0.1, -0.8)),
];
const STACKED: [(Vec3, Vec3); 2] =
    [(Vec3::splat(0.1), Vec3::new(0.3, 0.1, 0.0)), (Vec3::new(0.08, 0.05, 0.08), Vec3::new(0.32, 0.25, 0.01))];

fn spinning(spin: f32) -> Motion<Vec<Key>> {
    Motion { spin: spin / std::f32::consts::TAU, ..Motion::with_keys(Vec::new(), 0.0) }
}

/// Boxes on a table that turns go round with it, all their particles, and stay as high above it as they were.
#[test]
fn a_turntable_carries_what_lies_on_it() {
    for (boxes, spin, substeps, scale) in [
        (&CENTRED[..], 0.01, 10, 1.0),
        (&CENTRED, 0.2, 4, 1.0),
        (&CENTRED, 1.0, 20, 0.1),
        (&APART, 0.01, 4, 1.0),
        (&APART, 0.2, 10, 0.1),
        (&APART, 1.0, 4, 1.0),
        (&APART, 1.0, 20, 1.0),
        (&STACKED, 0.01, 20, 1.0),
        (&STACKED, 0.2, 10, 1.0),
        (&STACKED, 1.0, 4, 0.1),
    ]
    .into_iter()
    .step_by(every(3))
    {
        let case = format!("{} boxes, {spin} rad/s, {substeps} sub-steps, scale {scale}", boxes.len());
        let (start, end, left_out) = OnTable { boxes, scale, substeps, spin }.run(spinning(spin), 600);
        assert_eq!(left_out, 0, "{case}");
        let turn = Mat3::from_rotation_y(spin * 10.0);
        for (from, to) in start.into_iter().zip(end) {
            let (off, way) = (to - turn * from, 10.0 * spin * from.with_y(0.0).length());
            assert!(off.y.abs() < 5e-4 * scale, "{case}: {off}");
            assert!(off.length() < 0.01 * way + 2e-4 * scale, "{case}: {off} after {way}");
        }
    }
}

/// Boxes stay where they are on a table that tilts, as long as friction holds them, and slide off when it does no longer.
#[test]
fn a_table_that_tilts_carries_what_lies_on_it() {
    let mut cases = 0;
    for (boxes, substeps, scale) in [(&CENTRED[..], 10, 1.0), (&APART, 4, 1.0), (&APART, 20, 0.1)] {
        for (angle, holds) in [(0.1, true), (0.35, true), (0.7, false)] {
            if !is_third(&mut cases) {
                continue;
            }
            let case = format!("{} boxes, {substeps} sub-steps, scale {scale}, {angle} rad", boxes.len());
            let key = |time, tilt| Key { time, place: Vec3::ZERO, rotation: Vec3::Z * tilt };
            let motion = Motion::with_keys(vec![key(0.0, 0.0), key(5.0, angle), key(20.0, angle)], 0.0);
            let (start, end, left_out) = OnTable { boxes, scale, substeps, spin: 0.0 }.run(motion, 600);
            assert_eq!(left_out, 0, "{case}");
            let back = Mat3::from_rotation_z(-angle);
            for (from, to) in start.into_iter().zip(end) {
                let off = back * to - from;
                if holds {
                    assert!(off.length() < 2e-3 * scale, "{case}: {off}");
                } else {
                    assert!(off.x < -scale, "{case}: {off}");
                }
            }
        }
    }
}

/// Boxes slide off a table that turns faster than friction can keep them on it.
#[test]
fn a_turntable_that_is_too_fast_sheds_what_lies_on_it() {
    for (boxes, substeps, scale) in [(&APART[..], 4, 1.0), (&APART, 20, 0.3), (&STACKED, 10, 1.0)] {
        let case = format!("{} boxes, {substeps} sub-steps, scale {scale}", boxes.len());
        let (_, end, left_out) = OnTable { boxes, scale, substeps, spin: 0.0 }.run(spinning(5.0 / scale.sqrt()), 300);
        assert_eq!(left_out, 0, "{case}");
        for place in end {
            assert!(place.y < -scale, "{case}: {place}");
        }
    }
}

/// A box asleep in the middle of a table wakes when that begins to turn, where its middle is not moved by it, and goes round with it.
#[test]
fn who_sleeps_on_an_axis_turns() {
    for (substeps, scale, angle) in [(10, 1.0, 0.5), (4, 0.3, 0.05)] {
        let key = |time, turn| Key { time, place: Vec3::ZERO, rotation: Vec3::Y * turn };
        let motion = Motion::with_keys(vec![key(0.0, 0.0), key(4.0, 0.0), key(8.0, angle), key(20.0, angle)], 0.0);
        let (start, end, _) = OnTable { boxes: &CENTRED, scale, substeps, spin: 0.0 }.run(motion, 600);
        for (from, to) in start.into_iter().zip(end) {
            let (off, way) = (to - Mat3::from_rotation_y(angle) * from, angle * from.length());
            assert!(off.length() < 0.01 * way + 1e-4 * scale, "{substeps} {scale} {angle}: {off} after {way}");
        }
    }
}
