//! Sheets that touch themselves and each other: nothing passes, layers stay layers, friction holds by its angle, momenta are kept.

mod apart;
mod cloths;
mod curved;
mod draped;
mod falling;
mod friction;
mod lists;
mod told;
mod torn;
mod under_bodies;

use cloths::{Cloths, G, cotton, crosses, square};
use pointmass::constrain::SheetContacts;
use pointmass::force::Friction;
use pointmass::material::ContactMaterial;
use pointmass::scene::{Model, SceneFile};
use pointmass::shape::{Collider, Plane, Sphere};
use pointmass::{Force, Gravity, Measures, Method, Scene, Sheet, Time, Vec3};
use pointmass_tests::{Random, every, gap, started};

#[test]
fn the_test_of_crossings_tells_them() {
    let triangle = [Vec3::ZERO, Vec3::X, Vec3::Z];
    let at = |x: f32, z: f32| [Vec3::new(x, -1.0, z), Vec3::new(x, 1e-7, z)];
    assert!(crosses(at(0.2, 0.2), triangle) && crosses(at(0.4999, 0.4999), triangle));
    assert!(!crosses(at(0.50001, 0.5), triangle) && !crosses(at(-1e-6, 0.2), triangle));
    assert!(!crosses(at(0.2, 0.2).map(|x| x - Vec3::Y), triangle));
}

/// Heaps on a floor, and over a ball: they fall onto themselves from all sides.
fn heaps(cases: &[(u32, u32, f32, Vec3, Method)], frames: u64) {
    for &(cells, substeps, size, far, method) in cases.iter().step_by(every(2)) {
        let floor = Plane { point: far, normal: Vec3::Y };
        let ball = Sphere { center: far + Vec3::Y * (0.12 * size), radius: 0.1 * size };
        let worlds: [&dyn Collider; 2] = [&floor, &(floor, ball)];
        for (number, colliders) in worlds.into_iter().enumerate() {
            let mut cloths = Cloths::default();
            for (i, lean) in [(0.0f32, 0.12f32), (1.0, -0.3)].into_iter().enumerate() {
                let center = far + Vec3::new(0.02 * lean.0, 0.3 + 0.25 * i as f32, 0.05 * lean.0) * size;
                // The first stands on edge, the second lies askew.
                let sides = if i == 0 && number == 0 {
                    [Vec3::new(0.35, 0.02, 0.03), Vec3::new(0.01, 0.4, lean.1)]
                } else {
                    [Vec3::new(0.4, 0.1 * lean.1, 0.05), Vec3::new(-0.06, lean.1 * 0.3, 0.4)]
                };
                cloths.add(&square(center, sides.map(|side| side * size), cells), cotton(size), |x| x, Vec3::ZERO);
            }
            let thickness = 0.004 * size;
            let contacts = cloths.contacts(thickness);
            let constraints = (&cloths.shells[..], contacts);
            let forces: &dyn Force = &Gravity { acceleration: Vec3::NEG_Y * (G * size) };
            let rough =
                [ContactMaterial { friction: Some(Friction { static_: 0.3, kinetic: 0.25 }), elasticity: None }];
            cloths.start.iter_mut().for_each(|particle| particle.material = Some(0));
            let integrator = method.integrator();
            let scene = Scene {
                start: &cloths.start,
                forces,
                colliders,
                materials: &rough,
                constraints: &constraints,
                substeps,
                integrator,
                ..Scene::EMPTY
            };
            let mut system = started(&scene, cloths.start.len(), 0);
            assert_eq!(cloths.crossings(system.particles().position), 0);
            for frame in 1..=frames {
                system.step_to(&scene, Time::frame(frame, 60));
                if frame % 5 == 0 {
                    let x = system.particles().position;
                    assert_eq!(x.len(), cloths.start.len());
                    let crossings = cloths.crossings(x);
                    let report = *system.totals();
                    assert!(
                        crossings == 0 && report.caps.contacts == 0,
                        "{cells} cells, {substeps} sub-steps, {size} m, {method}, world {number}, frame {frame}: {crossings} {report:?}"
                    );
                }
            }
            let report = *system.totals();
            assert!(report.contacts > 100 && report.hits > 0, "{report:?}");
            let low = system.particles().position.iter().map(|x| x.y - far.y).fold(f32::INFINITY, f32::min);
            assert!(low > 0.0, "{low}");
        }
    }
}

#[test]
fn heaps_never_pass_through_themselves() {
    heaps(
        &[
            (6, 5, 1.0, Vec3::ZERO, Method::Symplectic),
            (5, 1, 1.0, Vec3::new(30.0, 7.0, -20.0), Method::Rk4),
            (4, 20, 0.01, Vec3::new(0.3, -0.1, 0.2), Method::Verlet),
        ],
        45,
    );
}

#[test]
#[ignore = "long: minutes"]
fn large_heaps_never_pass_through_themselves() {
    heaps(
        &[
            (16, 10, 1.0, Vec3::ZERO, Method::Symplectic),
            (12, 20, 0.01, Vec3::new(0.3, -0.1, 0.2), Method::Verlet),
            (12, 1, 1.0, Vec3::new(30.0, 7.0, -20.0), Method::Rk4),
            (10, 5, 100.0, Vec3::new(-300.0, 100.0, 0.0), Method::Symplectic),
        ],
        600,
    );
}

/// A strip that is folded three times and falls onto the floor: its layers stay in order, and come to rest on each other.
fn layers(cases: &[(u32, f32, Vec3, Method)], [cells, wide]: [u32; 2], frames: u64) {
    for &(substeps, size, far, method) in cases {
        let (thickness, long) = (0.004f32, 0.2f32);
        let cells_of_all = [4 * cells, wide];
        let sheet = Sheet { corner: Vec3::ZERO, sides: [Vec3::X * (4.0 * long), Vec3::Z * 0.1], cells: cells_of_all };
        let mut cloths = Cloths::default();
        let fold = |x: Vec3| {
            let layer = (x.x / long).floor().min(3.0);
            let along = x.x - layer * long;
            let back = if layer % 2.0 == 0.0 { along } else { long - along };
            let height = (layer + along / long) * 3.0 * thickness;
            far + Vec3::new(back, height + thickness, x.z) * size
        };
        // What it weighs comes from its own size.
        cloths.add(&sheet, cotton(size), fold, Vec3::ZERO);
        let density = size * size;
        cloths.start.iter_mut().for_each(|particle| particle.mass *= density);
        let constraints = (&cloths.shells[..], cloths.contacts(thickness * size));
        let gravity = Gravity { acceleration: Vec3::NEG_Y * (G * size) };
        let floor = Plane { point: far, normal: Vec3::Y };
        let integrator = method.integrator();
        let scene = Scene {
            start: &cloths.start,
            forces: &gravity,
            colliders: &floor,
            constraints: &constraints,
            substeps,
            integrator,
            ..Scene::EMPTY
        };
        let mut system = started(&scene, cloths.start.len(), 0);
        for frame in 1..=frames {
            system.step_to(&scene, Time::frame(frame, 60));
            if frame % 30 == 0 {
                assert_eq!(cloths.crossings(system.particles().position), 0, "{method}, {size} m, frame {frame}");
            }
        }
        let all = system.particles();
        let fastest = all.velocity.iter().map(|v| v.length()).fold(0.0, f32::max) / size;
        assert!(fastest < 0.02, "{method}, {size} m: {fastest}");
        for across in 0..=wide {
            // In the middle of each layer, one over the other.
            let heights = [0, 1, 2, 3].map(|layer| {
                let along = layer * cells + cells / 2;
                (all.position[sheet.number(along, across) as usize].y - far.y) / (size * thickness)
            });
            let gaps = [heights[0], heights[1] - heights[0], heights[2] - heights[1], heights[3] - heights[2]];
            assert!((0.45..0.7).contains(&gaps[0]), "{method}, {size} m: {gaps:?}");
            assert!(gaps[1..].iter().all(|gap| (0.8..2.0).contains(gap)), "{method}, {size} m: {gaps:?}");
        }
    }
}

#[test]
fn four_layers_stay_four() {
    let cases = [
        (5, 1.0, Vec3::ZERO, Method::Symplectic),
        (20, 0.01, Vec3::splat(0.1), Method::Verlet),
        (10, 100.0, Vec3::new(-200.0, 50.0, 0.0), Method::Euler),
    ];
    layers(&cases, [4, 2], 60);
}

#[test]
fn four_layers_stay_four_for_ten_seconds() {
    let cells = if cfg!(debug_assertions) { [4, 2] } else { [6, 3] };
    layers(&[(5, 1.0, Vec3::ZERO, Method::Symplectic)], cells, 600);
}

#[test]
#[ignore = "long: minutes"]
fn four_fine_layers_stay_four_for_ten_seconds() {
    let cases = [(5, 1.0, Vec3::ZERO, Method::Symplectic), (10, 0.1, Vec3::splat(0.1), Method::Verlet)];
    layers(&cases, [16, 8], 600);
}

/// A cloth is thrown at another, flat or on edge.
#[test]
fn a_fast_cloth_does_not_pass_another() {
    let mut methods = [Method::Symplectic, Method::Rk4, Method::Verlet].into_iter().cycle();
    for (speed, substeps, size) in [(10.0f32, 1u32, 1.0f32), (30.0, 5, 1.0), (30.0, 1, 0.2), (3.0, 20, 0.01)] {
        for edgewise in [false, true] {
            let method = methods.next().expect("there is always a next one");
            let mut cloths = Cloths::default();
            let flat = [Vec3::X * 0.4, Vec3::Z * 0.4].map(|side| side * size);
            cloths.add(&square(Vec3::ZERO, flat, 5), cotton(size), |x| x, Vec3::ZERO);
            let sides = if edgewise {
                [Vec3::new(0.2, 0.03, 0.01), Vec3::new(0.02, 0.2, 0.03)]
            } else {
                [Vec3::X * 0.25, Vec3::new(0.01, 0.03, 0.25)]
            };
            let thrown = square(Vec3::new(0.017, 0.4, 0.023) * size, sides.map(|side| side * size), 4);
            cloths.add(&thrown, cotton(size), |x| x, Vec3::NEG_Y * speed);
            let constraints = (&cloths.shells[..], cloths.contacts(0.003 * size));
            let integrator = method.integrator();
            let scene = Scene { start: &cloths.start, constraints: &constraints, substeps, integrator, ..Scene::EMPTY };
            let mut system = started(&scene, cloths.start.len(), 0);
            let frames = (1.0 * size / speed * 60.0).ceil() as u64 + 3;
            for frame in 1..=frames {
                system.step_to(&scene, Time::frame(frame, 60));
                let x = system.particles().position;
                let crossings = cloths.crossings(x);
                assert_eq!(crossings, 0, "{speed} m/s, {substeps}, {size} m, {edgewise}, frame {frame}");
            }
            let (below, above) = system.particles().velocity.split_at(36);
            let mean = |of: &[Vec3]| of.iter().map(|v| v.y).sum::<f32>() / of.len() as f32;
            let report = system.totals();
            assert!(report.contacts > 0 && report.caps.contacts == 0, "{report:?}");
            // It has been stopped by the other, which goes on before it.
            assert!(mean(below) < -0.02 * speed && mean(above) > -0.98 * speed, "{} {}", mean(below), mean(above));
        }
    }
}

/// Two free sheets that run into each other askew and rub.
#[test]
fn free_sheets_keep_their_momenta() {
    for (substeps, size, far, method) in [
        (5u32, 1.0f32, Vec3::ZERO, Method::Symplectic),
        (20, 0.01, Vec3::new(0.02, 0.0, 0.01), Method::Verlet),
        (1, 1.0, Vec3::ZERO, Method::Rk4),
        (10, 50.0, Vec3::ZERO, Method::Euler),
    ] {
        let mut cloths = Cloths::default();
        let sides = [Vec3::new(0.4, 0.02, 0.0), Vec3::new(0.0, 0.05, 0.4)].map(|side| side * size);
        cloths.add(&square(far, sides, 4), cotton(size), |x| x, Vec3::Y * (0.4 * size));
        let sides = [Vec3::new(0.3, -0.04, 0.1), Vec3::new(-0.1, 0.03, 0.3)].map(|side| side * size);
        let center = far + Vec3::new(0.06, 0.08, 0.03) * size;
        cloths.add(&square(center, sides, 3), cotton(size), |x| x, Vec3::new(0.4, -0.6, 0.2) * size);
        cloths.start.iter_mut().for_each(|particle| particle.material = Some(0));
        let rough = [ContactMaterial { friction: Some(Friction { static_: 0.5, kinetic: 0.4 }), elasticity: None }];
        let constraints = (&cloths.shells[..], cloths.contacts(0.005 * size));
        let integrator = method.integrator();
        let scene = Scene {
            start: &cloths.start,
            materials: &rough,
            constraints: &constraints,
            substeps,
            integrator,
            ..Scene::EMPTY
        };
        let mut system = started(&scene, cloths.start.len(), 0);
        let before = Measures::of(&system, &scene);
        for frame in 1..=45 {
            system.step_to(&scene, Time::frame(frame, 60));
        }
        let after = Measures::of(&system, &scene);
        let mass: f64 = cloths.start.iter().map(|p| f64::from(p.mass)).sum();
        let size = f64::from(size);
        assert!(system.totals().contacts > 20, "{:?}", system.totals());
        assert_eq!(cloths.crossings(system.particles().position), 0);
        let drift = gap(before.momentum, after.momentum) / (mass * size);
        let spin = gap(before.angular_momentum, after.angular_momentum) / (mass * size * size);
        assert!(drift < 1e-5 && spin < 1e-5, "{method}, {substeps} sub-steps, {size} m: {drift:e} {spin:e}");
        assert!(after.energy.kinetic < before.energy.kinetic, "it rubs");
    }
}

/// Triangles smaller than the thickness, in a sheet at rest: they leave each other alone.
#[test]
fn a_mesh_may_be_finer_than_it_is_thick() {
    for (cells, substeps) in [(3u32, 1u32), (12, 4)] {
        let mut cloths = Cloths::default();
        cloths.add(&square(Vec3::ONE, [Vec3::X * 0.05, Vec3::Z * 0.05], cells), cotton(0.05), |x| x, Vec3::ZERO);
        let constraints = (&cloths.shells[..], cloths.contacts(0.02));
        let scene = Scene { start: &cloths.start, constraints: &constraints, substeps, ..Scene::EMPTY };
        let mut system = started(&scene, cloths.start.len(), 0);
        for frame in 1..=10 {
            system.step_to(&scene, Time::frame(frame, 60));
        }
        let fastest = system.particles().velocity.iter().map(|v| v.length()).fold(0.0, f32::max);
        assert!(fastest < 1e-4 && system.totals().contacts == 0, "{fastest} {:?}", system.totals());
    }
}

#[test]
fn nothing_unsound_does_harm() {
    let mut random = Random::new(7);
    for round in 0..24 {
        let mut cloths = Cloths::default();
        for i in 0..3 {
            let center = Vec3::Y * (0.02 * i as f32) + random.vector(0.01);
            let sides = [Vec3::X * 0.2 + random.vector(0.05), Vec3::Z * 0.2 + random.vector(0.05)];
            cloths.add(&square(center, sides, 2), cotton(1.0), |x| x, random.vector(1.0));
        }
        let odd = round % cloths.start.len();
        match round % 8 {
            0 => cloths.start[odd].position = Vec3::NAN,
            1 => cloths.start[odd].velocity = Vec3::splat(f32::INFINITY),
            2 => cloths.start[odd].position = cloths.start[(odd + 1) % 27].position,
            3 => cloths.start.iter_mut().for_each(|p| p.position.y = 0.0),
            4 => cloths.start.iter_mut().for_each(|p| p.position = Vec3::ONE),
            5 => cloths.start[odd].position *= 1e30,
            6 => cloths.triangles.extend([[0, 0, 1], [2, 2, 2], [9, 999, 3]]),
            _ => cloths.start.iter_mut().step_by(2).for_each(|p| p.fixed = true),
        }
        let thickness = [1e-30, 0.01, 0.5, f32::NAN, 0.0][round % 5];
        let constraints = (&cloths.shells[..], cloths.contacts(thickness));
        let scene = Scene {
            start: &cloths.start,
            forces: &Gravity::EARTH,
            constraints: &constraints,
            substeps: 1 + round as u32 % 3,
            ..Scene::EMPTY
        };
        let mut system = started(&scene, cloths.start.len(), 0);
        for frame in 1..=10 {
            system.step_to(&scene, Time::frame(frame, 60));
        }
        let sound = matches!(round % 8, 2 | 3 | 6 | 7);
        let all = system.particles().position;
        assert!(!sound || all.len() == 27 && all.iter().all(|x| x.is_finite()), "{round}: {all:?}");
    }
    let contacts =
        |thickness: &'static [f32]| SheetContacts { particles: [0, 1, 2], triangles: [[0, 1, 2]], thickness };
    assert_eq!(contacts(&[0.1]).fault(), None);
    assert_eq!(contacts(&[0.0]).fault().map(|(name, _)| name), Some("thickness"));
    assert_eq!(contacts(&[]).fault().map(|(name, _)| name), Some("thickness"));
    let strange = SheetContacts { triangles: [[0, 1, 3]], ..contacts(&[0.1]) };
    assert_eq!(strange.fault().map(|(name, _)| name), Some("triangles"));
}

#[test]
fn files_let_cloths_touch_by_their_thickness() {
    let text = r#"{
        "run": {"substeps": 5},
        "forces": [{"gravity": {"acceleration": [0, -9.8, 0]}}],
        "cloths": [
            {"form": {"sheet": {"corner": [0, 0, 0], "sides": [[0.4, 0, 0], [0, 0, 0.4]], "cells": [4, 4]}}, "density": 0.3, "thickness": 0.004,
             "shell": {"stretch": [500, 500], "shear": 100}, "fixed": [0, 4, 20, 24]},
            {"form": {"sheet": {"corner": [0.1, 0.02, 0.1], "sides": [[0.2, 0, 0], [0, 0, 0.2]], "cells": [3, 3]}}, "density": 0.3, "thickness": 0.006,
             "shell": {"stretch": [500, 500], "shear": 100}},
            {"form": {"sheet": {"corner": [0.1, 0.04, 0.1], "sides": [[0.2, 0, 0], [0, 0, 0.2]], "cells": [1, 1]}}, "density": 0.3,
             "shell": {"stretch": [500, 500], "shear": 100}}
        ]
    }"#;
    let file = SceneFile::from_json("a.json", text).expect("it is sound");
    let model = Model::load(&file, "a.json", &mut ()).expect("it can be made");
    let contacts = &model.constraints.3;
    assert_eq!((contacts.particles.len(), contacts.triangles.len(), contacts.thickness.len()), (41, 50, 50));
    assert_eq!((contacts.triangles[32], contacts.thickness[31], contacts.thickness[32]), ([25, 26, 30], 0.004, 0.006));
    let mut system = model.system(0, 1).expect("there is memory");
    for frame in 1..=30 {
        system.step_to(&model.scene(), Time::frame(frame, 60));
    }
    let height = |of: core::ops::Range<usize>| system.particles().position[of].iter().map(|x| x.y).fold(0.0, f32::min);
    // What has a thickness lies on the other, and what has none has fallen through both.
    assert!(height(25..41) > -0.2 && height(41..45) < -0.5, "{} {}", height(25..41), height(41..45));
    let wrong = SceneFile::from_json("a.json", &text.replace("0.004", "0")).expect("it is a scene");
    assert!(wrong.check().is_err());
}
