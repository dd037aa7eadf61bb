//! Rigid bodies that sleep: they wake when anything is done to them, and what is done to them has the effect it has on others.

use pointmass::constrain::{RigidBodies, RigidBox};
use pointmass::force::Friction;
use pointmass::motion::{Key, Motion};
use pointmass::shape::{Aabb, Cuboid, Moving, Plane};
use pointmass::{ContactMaterial, Contacts, Gravity, Heap, Particle, Scene, System, Time, Vec3};
use pointmass_tests::started;

const DOWN: Gravity = Gravity { acceleration: Vec3::new(0.0, -9.81, 0.0) };
const GROUND: Plane = Plane { point: Vec3::ZERO, normal: Vec3::Y };
const PART: Particle = Particle { material: Some(0), elasticity: 0.0, ..Particle::REST };

fn rough(mu: f32) -> [ContactMaterial; 1] {
    [ContactMaterial { elasticity: None, friction: Some(Friction { static_: mu, kinetic: mu }) }]
}

/// Goes on for so many frames.
fn go(system: &mut System<Heap>, scene: &Scene<'_>, frames: u32) {
    for _ in 0..frames {
        system.step(scene, Time::frame(1, 60));
    }
}

/// The middle of a body's particles, and their mean velocity.
fn mean(system: &System<Heap>, of: &RigidBox) -> (Vec3, Vec3) {
    let rows = of.first as usize..(of.first + of.count) as usize;
    let (x, v) = (&system.particles().position[rows.clone()], &system.particles().velocity[rows]);
    (x.iter().sum::<Vec3>() / x.len() as f32, v.iter().sum::<Vec3>() / v.len() as f32)
}

/// Two boxes on top of each other on the ground.
fn pile(scale: f32) -> [RigidBox; 2] {
    [0, 1].map(|i| RigidBox::new(Vec3::splat(0.1) * scale, Vec3::Y * (0.1 + 0.2 * i as f32) * scale, 8 * i))
}

/// Bodies that lie for long are at rest to the bit, and stay where they are to the bit.
#[test]
fn a_pile_that_lies_is_still() {
    for (scale, substeps) in [(1.0f32, 8), (0.1, 20), (5.0, 4)] {
        let boxes = pile(scale);
        let start: Vec<_> = boxes.iter().flat_map(|of| of.solid(PART)).collect();
        let (bodies, materials) = (RigidBodies::boxes(boxes), rough(0.5));
        let forces = Gravity { acceleration: Vec3::NEG_Y * 9.81 };
        let parts = Scene { start: &start, forces: &forces, colliders: &GROUND, materials: &materials, ..Scene::EMPTY };
        let scene = Scene { constraints: &bodies, substeps, ..parts };
        let mut system = started(&scene, start.len(), 0);
        go(&mut system, &scene, 360);
        let places = system.particles().position.to_vec();
        assert!(system.particles().velocity.iter().all(|v| *v == Vec3::ZERO), "{scale}");
        go(&mut system, &scene, 60);
        assert!(places == system.particles().position, "{scale}");
    }
}

/// A box slides into another that has lain there for a time or has just been put there: it makes no difference.
#[test]
fn who_is_hit_asleep_is_pushed_as_if_it_were_awake() {
    let ways = [0, 180].map(|frames| {
        let target = RigidBox::new(Vec3::splat(0.1), Vec3::new(0.0, 0.1, 0.0), 0);
        let puck = RigidBox::new(Vec3::splat(0.1), Vec3::new(-0.5, 0.1, 0.0), 8);
        let mut start = target.solid(PART).to_vec();
        start.extend(puck.solid(PART));
        let (bodies, materials) = (RigidBodies::boxes([target, puck]), rough(0.3));
        let parts = Scene { start: &start, forces: &DOWN, colliders: &GROUND, materials: &materials, ..Scene::EMPTY };
        let scene = Scene { constraints: &bodies, substeps: 10, ..parts };
        let mut system = started(&scene, start.len(), 0);
        // Frames of rest, then a kick by a force that lasts a tenth of a second: 3 m/s.
        go(&mut system, &scene, frames);
        go(&mut system, &Scene { forces: &(DOWN, Kick), ..scene }, 6);
        go(&mut system, &scene, 114);
        bodies.boxes.map(|of| mean(&system, &of).0 - of.center)
    });
    let [[a, b], [c, d]] = ways;
    assert!(a.x > 0.1 && b.x > 0.3, "{ways:?}");
    assert!((a - c).length() < 0.03 * a.length() && (b - d).length() < 0.03 * b.length(), "{ways:?}");
}

/// A blow to the first of a row that has fallen asleep goes through to the last, as through one that has just been put there.
#[test]
fn a_row_that_is_struck_asleep_moves_as_if_it_were_awake() {
    let ways = [0, 180].map(|frames| {
        let at = |x: f32, i: u32| RigidBox::new(Vec3::splat(0.1), Vec3::new(x, 0.1, 0.0), 8 * i);
        let boxes = [at(-0.5, 0), at(0.0, 1), at(0.2, 2), at(0.4, 3), at(0.6, 4), at(0.8, 5)];
        let start: Vec<_> = boxes.iter().flat_map(|of| of.solid(PART)).collect();
        let (bodies, materials) = (RigidBodies::boxes(boxes), rough(0.1));
        let parts = Scene { start: &start, forces: &DOWN, colliders: &GROUND, materials: &materials, ..Scene::EMPTY };
        let scene = Scene { constraints: &bodies, substeps: 10, ..parts };
        let mut system = started(&scene, start.len(), 0);
        go(&mut system, &scene, frames);
        go(&mut system, &Scene { forces: &(DOWN, Kick), ..scene }, 6);
        go(&mut system, &scene, 114);
        bodies.boxes.map(|of| mean(&system, &of).0 - of.center)
    });
    for (a, b) in ways[0].iter().zip(&ways[1]) {
        assert!(a.x > 0.05 && (*a - *b).length() < 0.03 * ways[0][0].length(), "{ways:?}");
    }
}

/// A box that sleeps over an edge tips when another comes to lie on it, however gently, by which both have their weight beyond the edge.
#[test]
fn what_is_loaded_asleep_tips() {
    let slab = Cuboid { min: Vec3::new(-1.0, -0.2, -1.0), max: Vec3::new(0.03, 0.0, 1.0) };
    for frames in [0, 120] {
        let boxes = [(0.0, 0.1), (0.09, 0.301)].map(|(x, y)| RigidBox::new(Vec3::splat(0.1), Vec3::new(x, y, 0.0), 0));
        let boxes = [boxes[0], RigidBox { first: 8, ..boxes[1] }];
        let start: Vec<_> = boxes.iter().flat_map(|of| of.solid(PART)).collect();
        let (bodies, materials) = (RigidBodies::boxes(boxes), rough(0.8));
        let parts = Scene { start: &start, colliders: &slab, materials: &materials, ..Scene::EMPTY };
        let scene = Scene { forces: &DOWN, constraints: &bodies, substeps: 10, ..parts };
        let mut system = started(&scene, start.len(), 0);
        go(&mut system, &Scene { forces: &(DOWN, Lift), ..scene }, frames);
        assert!(mean(&system, &boxes[1]).0.y > 0.3, "{frames}");
        go(&mut system, &scene, 120);
        assert!(mean(&system, &boxes[0]).0.y < 0.0, "{frames}: {}", mean(&system, &boxes[0]).0);
    }
}

/// It carries what is above 0.2 m.
#[derive(Debug)]
struct Lift;

impl pointmass::Force for Lift {
    fn add_to(&self, state: &pointmass::force::State<'_>, rows: core::ops::Range<usize>, forces: &mut [Vec3]) {
        for (row, force) in rows.zip(forces) {
            if state.position[row].y > 0.2 {
                *force += Vec3::Y * 9.81 * state.mass[row];
            }
        }
    }
}

/// It pushes what is left of −0.15 m along x by 30 m/s².
#[derive(Debug)]
struct Kick;

impl pointmass::Force for Kick {
    fn add_to(&self, state: &pointmass::force::State<'_>, rows: core::ops::Range<usize>, forces: &mut [Vec3]) {
        for (row, force) in rows.zip(forces) {
            if state.position[row].x < -0.15 {
                *force += Vec3::X * 30.0 * state.mass[row];
            }
        }
    }
}

/// Gravity that leans over wakes a pile, which then slides as one that never slept.
#[test]
fn other_forces_wake() {
    let boxes = pile(1.0);
    let start: Vec<_> = boxes.iter().flat_map(|of| of.solid(PART)).collect();
    let (bodies, materials) = (RigidBodies::boxes(boxes), rough(0.2));
    let parts = Scene { start: &start, forces: &DOWN, colliders: &GROUND, materials: &materials, ..Scene::EMPTY };
    let scene = Scene { constraints: &bodies, substeps: 10, ..parts };
    let lean = Gravity { acceleration: Vec3::new(3.0, -9.81, 0.0) };
    let mut system = started(&scene, start.len(), 0);
    go(&mut system, &scene, 240);
    assert!(system.particles().velocity.iter().all(|v| *v == Vec3::ZERO));
    go(&mut system, &Scene { forces: &lean, ..scene }, 60);
    let right = 0.5 * (3.0 - 0.2 * 9.81);
    for of in &bodies.boxes {
        let way = mean(&system, of).0 - of.center;
        assert!((way.x - right).abs() < 0.02 * right, "{way} for {right}");
    }
}

/// A table that begins to tilt, sink or slide after what lies on it has fallen asleep takes it along or lets it go.
#[test]
fn scenery_that_begins_to_move_wakes() {
    let still = Key { time: 3.0, place: Vec3::ZERO, rotation: Vec3::ZERO };
    for (place, rotation) in [(Vec3::ZERO, Vec3::Z * 0.6), (Vec3::NEG_Y * 0.5, Vec3::ZERO), (Vec3::X * 0.5, Vec3::ZERO)]
    {
        let keys = [still, Key { time: 4.0, place, rotation }];
        let slab = Cuboid { min: Vec3::new(-2.0, -0.5, -2.0), max: Vec3::new(2.0, 0.0, 2.0) };
        let bounds = Aabb { min: slab.min, max: slab.max };
        let table = Moving::new(slab, &bounds, Motion::with_keys(keys, 0.0));
        let boxes = pile(0.5);
        let start: Vec<_> = boxes.iter().flat_map(|of| of.solid(PART)).collect();
        let (bodies, materials) = (RigidBodies::boxes(boxes), rough(0.2));
        let parts = Scene { start: &start, forces: &DOWN, colliders: &table, materials: &materials, ..Scene::EMPTY };
        let scene = Scene { constraints: &bodies, substeps: 10, ..parts };
        let mut system = started(&scene, start.len(), 0);
        go(&mut system, &scene, 175);
        assert!(system.particles().velocity.iter().all(|v| *v == Vec3::ZERO), "{place}, {rotation}");
        go(&mut system, &scene, 65);
        for of in &bodies.boxes {
            let (x, _) = mean(&system, of);
            let way = x - of.center;
            assert!(way.length() > 0.1, "{place}, {rotation}: {way}");
            if rotation == Vec3::ZERO && place.y < 0.0 {
                assert!((way - place).length() < 0.02, "{place}: {way}");
            }
        }
    }
}

/// A body that lies on another falls when that dies or is taken away.
#[test]
fn who_lies_on_what_goes_away_falls() {
    let boxes = pile(1.0);
    let start: Vec<_> = boxes.iter().flat_map(|of| of.solid(PART)).collect();
    let (bodies, materials) = (RigidBodies::boxes(boxes), rough(0.5));
    let parts = Scene { start: &start, forces: &DOWN, colliders: &GROUND, materials: &materials, ..Scene::EMPTY };
    let scene = Scene { constraints: &bodies, substeps: 10, ..parts };
    let mut system = started(&scene, start.len(), 0);
    go(&mut system, &scene, 240);
    // The same without the ground.
    go(&mut system, &Scene { colliders: &(), ..scene }, 60);
    for of in &bodies.boxes {
        let way = mean(&system, of).0 - of.center;
        assert!((way.y + 0.5 * 9.81).abs() < 0.1, "{way}");
    }
}

/// Where nothing drives bodies they never sleep: one that drifts slowly past another keeps its momentum for ever.
#[test]
fn nothing_sleeps_in_space() {
    let boxes = [0, 1].map(|i| RigidBox::new(Vec3::splat(0.1), Vec3::X * 0.2 * i as f32, 8 * i));
    let velocity = Vec3::X * 1e-4;
    let start: Vec<_> = boxes.iter().flat_map(|of| of.solid(Particle { velocity, ..PART })).collect();
    let (bodies, materials) = (RigidBodies::boxes(boxes), rough(0.5));
    let scene = Scene { start: &start, constraints: &bodies, materials: &materials, substeps: 4, ..Scene::EMPTY };
    let mut system = started(&scene, start.len(), 0);
    go(&mut system, &scene, 1200);
    for of in &bodies.boxes {
        let (x, v) = mean(&system, of);
        assert!((v - velocity).length() < 1e-6 && (x - of.center - velocity * 20.0).length() < 1e-4, "{x}, {v}");
    }
}

/// However a wall comes at who lies still, within sub-steps or many steps, and from wherever: it takes him along, asleep or awake.
#[test]
fn a_wall_that_comes_takes_along_who_lies_still() {
    for (fast, size) in [0.6f32, 1.5, 3.0, 8.0].into_iter().flat_map(|v| [0.01, 0.3].map(|size| (v, size))) {
        for (rate, substeps, rests, gap) in
            [(60, 20, 60, 0.3f32), (60, 20, 60, 0.51), (60, 20, 0, 0.93), (24, 40, 30, 0.7), (240, 5, 240, 0.2)]
        {
            let of = RigidBox::new(Vec3::splat(size), Vec3::Y * size, 0);
            let start = of.solid(PART);
            // Beside it when it has lain there for some time, and on into the step by a part of that.
            let (frames, fast) = (rests + rate, fast * (size / 0.01).sqrt());
            let face = -size - fast * ((rests as f32 + 10.0 + gap) / rate as f32);
            let wall =
                Cuboid { min: Vec3::new(face - size, 0.0, -3.0 * size), max: Vec3::new(face, 4.0 * size, 3.0 * size) };
            let wall = Moving::new(
                wall,
                &Aabb { min: wall.min, max: wall.max },
                Motion { drift: Vec3::X * fast, ..Motion::STILL },
            );
            let (bodies, materials) = (RigidBodies::boxes([of]), rough(0.3));
            let scene = Scene {
                start: &start,
                forces: &DOWN,
                colliders: &(GROUND, wall),
                materials: &materials,
                constraints: &bodies,
                substeps,
                ..Scene::EMPTY
            };
            let mut system = started(&scene, start.len(), 0);
            for frame in 1..=u64::from(frames) {
                system.step_to(&scene, Time::frame(frame, rate));
            }
            let face = face + fast * (frames as f32 / rate as f32);
            let (place, _) = mean(&system, &of);
            assert!(
                place.x > face + 0.5 * size,
                "{fast} m/s, {size} m, {rate} Hz, {substeps}, {gap}: {place} behind {face}"
            );
        }
    }
}

/// A floor that moves within a step does so to who lies on it within a sub-step: he stays on one that swings, at its turning points too.
#[test]
fn a_floor_that_moves_is_felt_in_sub_steps() {
    for (rate, substeps) in [(24u32, 20u32), (60, 8), (240, 2)] {
        for (swing, phase) in [(0.1f32, 0.0), (0.1, 0.25), (0.05, 0.75)] {
            let slab = Cuboid { min: Vec3::new(-2.0, -0.2, -2.0), max: Vec3::new(2.0, 0.0, 2.0) };
            // Half of what gravity holds down, at turning points that are steps' instants.
            let frequency = (0.5 * 9.81 / swing).sqrt() / core::f32::consts::TAU;
            let frequency = (frequency * 8.0).floor() / 8.0;
            let motion = Motion { swing: Vec3::Y * swing, frequency, phase, ..Motion::STILL };
            let floor = |t: f32| swing * (core::f32::consts::TAU * (frequency * t + phase)).sin();
            let of = RigidBox::new(Vec3::splat(0.1), Vec3::Y * (0.1 + floor(0.0)), 0);
            let ball = Particle { radius: 0.1, position: Vec3::new(1.0, 0.1 + floor(0.0), 0.0), ..PART };
            let start: Vec<_> = of.solid(PART).into_iter().chain([ball]).collect();
            let slab = Moving::new(slab, &Aabb { min: slab.min, max: slab.max }, motion);
            let (bodies, materials) = (RigidBodies::boxes([of]), rough(0.3));
            let contacts = Contacts::default();
            let scene = Scene {
                start: &start,
                forces: &DOWN,
                colliders: &slab,
                materials: &materials,
                constraints: &(bodies, contacts),
                substeps,
                ..Scene::EMPTY
            };
            let mut system = started(&scene, start.len(), 0);
            let h = 1.0 / (rate as f32 * substeps as f32);
            for frame in 1..=u64::from(4 * rate) {
                system.step_to(&scene, Time::frame(frame, rate));
                let at = floor(frame as f32 / rate as f32);
                let gaps =
                    [mean(&system, &of).0.y, system.particles().position[start.len() - 1].y].map(|y| y - 0.1 - at);
                let most = 4.0 * 9.81 * h * h + 2e-4;
                assert!(
                    gaps.iter().all(|gap| gap.abs() < most),
                    "{rate} Hz, {substeps}, {swing} m, {phase}, frame {frame}: {gaps:?} of {most}"
                );
            }
        }
    }
}
