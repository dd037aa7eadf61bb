//! Rigid bodies go with what carries them, awake or asleep, and fall when it goes.

use pointmass::constrain::{RigidBodies, RigidBox};
use pointmass::force::Friction;
use pointmass::motion::{Key, Motion};
use pointmass::shape::{Aabb, Cuboid, Moving, Plane};
use pointmass::{ContactMaterial, Gravity, Heap, Particle, Scene, System, Time, Vec3};
use pointmass_tests::started;

const DOWN: Gravity = Gravity { acceleration: Vec3::new(0.0, -9.81, 0.0) };
const GROUND: Plane = Plane { point: Vec3::ZERO, normal: Vec3::Y };
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
