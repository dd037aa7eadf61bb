//! What cannot be used harms nobody: no panic, and rows that are no numbers are taken out and counted.

use pointmass::motion::{Key, Motion};
use pointmass::shape::{
    Aabb, Affine, Capsule, Collider, Cone, Cuboid, Cylinder, Disc, Line, MeshBuf, Moving, Placed, Plane, Segment,
    Sphere, Triangle,
};
use pointmass::{Gravity, Mat3, Particle, Scene, Time, Vec3};
use pointmass_tests::{Form, Random, started};

/// Numbers of all kinds, good and bad.
const NUMBERS: [f32; 14] =
    [0.0, -0.0, 1.0, -1.0, 0.5, 1e-20, 1e20, -1e20, 1e-38, 1e-45, f32::MAX, f32::NAN, f32::INFINITY, f32::NEG_INFINITY];

fn number(random: &mut Random) -> f32 {
    NUMBERS[random.word() as usize % NUMBERS.len()]
}

fn vector(random: &mut Random) -> Vec3 {
    Vec3::new(number(random), number(random), number(random))
}

fn shape(random: &mut Random) -> Form {
    let (a, b, x, y) = (vector(random), vector(random), number(random), number(random));
    match random.word() % 9 {
        8 => Form::Capsule(Capsule { from: a, to: b, radius: x }),
        0 => Form::Box(Cuboid { min: a, max: b }),
        1 => Form::Sphere(Sphere { center: a, radius: x }),
        2 => Form::Cylinder(Cylinder { center: a, radius: x, height: y }),
        3 => Form::Cone(Cone { center: a, radius: x, height: y }),
        4 => Form::Circle(Disc { center: a, normal: b, radius: x }),
        5 => Form::Triangle(Triangle { corners: [a, b, vector(random)] }),
        6 => Form::Plane(Plane { point: a, normal: b }),
        _ => Form::Line(Line { from: a, to: b }),
    }
}

#[test]
fn nothing_panics_whatever_a_shape_and_a_path_are() {
    let mut random = Random::new(101);
    for _ in 0..pointmass_tests::often(200_000) {
        let form = shape(&mut random);
        let during = [Time::ZERO, Time::from_seconds(number(&mut random))];
        let segment =
            Segment { from: vector(&mut random), to: vector(&mut random), radius: number(&mut random), during };
        let motion = Motion {
            pivot: vector(&mut random),
            axis: vector(&mut random),
            spin: number(&mut random),
            swing: vector(&mut random),
            frequency: number(&mut random),
            phase: number(&mut random),
            drift: vector(&mut random),
            keys: [(); 3].map(|()| Key {
                time: number(&mut random),
                place: vector(&mut random),
                rotation: vector(&mut random),
            }),
            period: number(&mut random),
        };
        let linear = Mat3::from_cols(vector(&mut random), vector(&mut random), vector(&mut random));
        let placed = Placed::new(form.clone(), Affine { linear, shift: vector(&mut random) });
        let bounds = Aabb { min: vector(&mut random), max: vector(&mut random) };
        let moving = Moving::new(form.clone(), &bounds, motion);
        let mut all: Vec<&dyn Collider> = vec![&form, &moving];
        all.extend(placed.iter().map(|placed| placed as &dyn Collider));
        for collider in all {
            if let Some(hit) = collider.first_hit(&segment) {
                assert!((0.0..=1.0).contains(&hit.time), "{form:?} {segment:?} {hit:?}");
            }
            collider.contacts(segment.from, segment.radius, during[1], &mut |contact| {
                assert!(contact.distance <= segment.radius, "{form:?} {segment:?} {contact:?}");
            });
            let _ = collider.may_touch(&bounds);
        }
    }
}

#[test]
fn poisoned_rows_are_taken_out_and_counted() {
    let floor = Plane { point: Vec3::ZERO, normal: Vec3::Y };
    let ball = Sphere { center: Vec3::Y, radius: 0.5 };
    let degenerate = MeshBuf::new(vec![Vec3::ZERO, Vec3::X], vec![[0, 0, 1], [1, 1, 1]]).expect("a mesh of nothing");
    let inverted = Cuboid { min: Vec3::ONE, max: -Vec3::ONE };
    for scale in [1e-20f32, 1.0, 1e20] {
        let map = Affine { linear: Mat3::from_diagonal(Vec3::splat(scale)), shift: Vec3::ZERO };
        // A scale that cannot be undone is none.
        let placed = Placed::new(inverted, map).map_or(Placed::new(inverted, Affine::IDENTITY), Some);
        let colliders = (floor, ball, degenerate.view(), inverted, placed.expect("one of them can be undone"));
        let mut start = vec![];
        for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
            for axis in [Vec3::X, Vec3::Y, Vec3::Z] {
                let poison = Vec3::ONE + axis * bad;
                start.push(Particle { position: poison, radius: 0.1, ..Particle::REST });
                start.push(Particle { position: Vec3::Y * 3.0, velocity: poison, ..Particle::REST });
            }
        }
        let poisoned = start.len();
        for radius in [0.0, 1e-20, 0.1, 1e20, f32::MAX] {
            start.push(Particle { position: Vec3::Y * 3.0, velocity: Vec3::NEG_Y, radius, ..Particle::REST });
        }
        let scene = Scene { start: &start, forces: &Gravity::EARTH, colliders: &colliders, ..Scene::EMPTY };
        let mut system = started(&scene, start.len(), 0);
        for i in 1..=30 {
            system.step(&scene, Time::frame(i, 60) - system.time());
            let p = system.particles();
            assert!(p.position.iter().chain(p.velocity).all(|v| v.is_finite()));
        }
        let gone = system.totals().died.nonfinite + system.totals().refused;
        assert_eq!((system.len(), gone), (start.len() - poisoned, poisoned as u64), "scale {scale}");
    }
}
