//! One flat face: what is followed the short way past it, several paths at once, has the bits of the long way.

use pointmass::Response;
use pointmass::force::Friction;
use pointmass::motion::Motion;
use pointmass::scene::Position;
use pointmass::shape::{
    Aabb, Affine, Collider, Contact, Cuboid, Cylinder, Hit, Hulls, Marks, Mesh, Moving, Placed, Plane, Ride, Scenery,
    Segment, Shape, Sphere,
};
use pointmass::{ContactMaterial, Drag, Emitter, Gravity, Heap, Integrator, Method, Particle, Scene, System, Time};
use pointmass::{Observer, Spread, Varied, Vec3};
use pointmass_tests::{Random, started};

/// A collider that does not say what of it is near.
struct Silent<C>(C);

impl<C: Collider> Collider for Silent<C> {
    fn first_hit(&self, segment: &Segment) -> Option<Hit> {
        self.0.first_hit(segment)
    }
    fn may_touch(&self, bounds: &Aabb) -> bool {
        self.0.may_touch(bounds)
    }
    fn mark_near(&self, hulls: &Hulls, marks: &mut Marks) {
        self.0.mark_near(hulls, marks);
    }
    fn contacts(&self, center: Vec3, reach: f32, at: Time, visit: &mut dyn FnMut(&Contact)) {
        self.0.contacts(center, reach, at, visit);
    }
    fn ride(&self, seat: &Segment) -> Option<Ride> {
        self.0.ride(seat)
    }
}

/// Someone who wants to know of hits, and therefore of the order in which they are found.
struct Listener(u64);

impl Observer for Listener {
    fn attention(&self) -> pointmass::Attention {
        pointmass::Attention::Events
    }
    fn hit(&mut self, _: &pointmass::Impact) {
        self.0 += 1;
    }
}

/// Particles about a plane of which some fall, some slide, some have their own ideas.
fn crowd(random: &mut Random, plane: &Plane, scale: f32, radius: f32) -> Vec<Particle> {
    crowd_of(163, random, plane, scale, radius)
}

/// So many of them, not all of the same size.
fn crowd_of(count: usize, random: &mut Random, plane: &Plane, scale: f32, radius: f32) -> Vec<Particle> {
    let up = plane.normal.normalize();
    (0..count)
        .map(|i| {
            let radius = radius * [1.0, 1.0, 0.4, 3.0][i / 5 % 4];
            let aside = random.vector(3.0 * scale);
            let height = [0.0, 1e-6, 0.01, 0.3, 1.0, -0.2][i % 6] * scale * random.between(0.5, 1.0);
            let velocity = random.vector([0.0, 0.01, 1.0, 12.0][i % 4] * scale);
            let strange = [f32::NAN, f32::INFINITY, 1e30][i % 3];
            Particle {
                position: plane.point + aside - up * aside.dot(up) + up * (height + radius),
                velocity: if i % 97 == 96 || i % 64 == 31 { velocity * strange } else { velocity },
                radius,
                drag: [0.0, 0.2, 3.0][i % 3],
                mass: random.between(0.5, 2.0),
                elasticity: [0.0, 0.5, 0.9, 1.0, random.unit()][i % 5],
                material: [None, Some(0), Some(1), Some(2)][i % 4],
                fixed: i % 41 == 40,
                lifetime: if i % 13 == 12 { 0.4 } else { 0.0 },
                ..Particle::REST
            }
        })
        .collect()
}

fn fountain(plane: &Plane, scale: f32) -> Emitter<Sphere> {
    let form = Sphere { center: plane.point + plane.normal.normalize() * (0.5 * scale), radius: 0.1 * scale };
    Emitter {
        speed: Varied { mean: 2.0 * scale, half_width: 1.0 * scale },
        spread: Spread::Uniform(1.0),
        elasticity: Varied { mean: 0.5, half_width: 0.5 },
        lifetime: Varied::exactly(0.5),
        ..Emitter::new(form, 100.0)
    }
}

#[test]
fn the_short_way_has_the_bits_of_the_long_one() {
    let mut random = Random::new(2611);
    let friction =
        |static_, kinetic| ContactMaterial { friction: Some(Friction { static_, kinetic }), elasticity: None };
    let materials = [friction(0.5, 0.4), friction(0.0, 0.0), ContactMaterial { elasticity: Some(0.3), friction: None }];
    let (mut hits, count) = (0, if cfg!(debug_assertions) { 14 } else { 54 });
    for (number, method) in Method::ALL.iter().cycle().take(count).enumerate() {
        let scale = [1.0, 1e-3, 40.0][number % 3];
        let far = [0.0, 0.0, 1e3][number / 3 % 3] * scale;
        let normals = [Vec3::Y, Vec3::NEG_Y, Vec3::Y * 3.0, random.direction() * 0.7, Vec3::NEG_X, Vec3::Z * 0.1];
        let normal = normals[number / 2 % 6];
        let plane = Plane { point: random.vector(far), normal };
        let radius = [0.0, 0.0, 0.02, 1e-7][number / 4 % 4] * scale;
        // More than fit into a block or a tile, and fewer.
        let start = crowd_of([163, 163, 700, 31][number % 4], &mut random, &plane, scale, radius);
        let emitter = fountain(&plane, scale);
        let down = if normal.y == 0.0 { -normal.normalize() } else { Vec3::NEG_Y };
        let gravity = Gravity { acceleration: (down * 9.8 + random.vector(2.0)) * scale };
        let max_bounces = [8, 8, 1, 2, 0, 3, 4][number % 7];
        let materials = if number % 2 == 0 { &materials[..] } else { &[] };
        let integrator: &dyn Integrator = method.integrator();
        let base = Scene {
            start: &start,
            emitters: &emitter,
            forces: &(gravity, Drag {}),
            materials: &materials,
            integrator,
            max_bounces,
            substeps: [1, 3][number / 7 % 2],
            ..Scene::EMPTY
        };
        let dt = Time::from_seconds([1.0 / 60.0, 1.0 / 24.0, 1.0 / 144.0, 0.2][number / 5 % 4]);
        let faced = Scene { colliders: &plane, ..base };
        let silent = Silent(plane);
        let plain = Scene { colliders: &silent, ..base };
        let mut systems: [System<Heap>; 3] = [&faced, &plain, &faced].map(|scene| started(scene, 1_000, 5));
        for step in 0..24 {
            let [short, long, told] = &mut systems;
            let (a, b) = (short.step(&faced, dt), long.step(&plain, dt));
            let mut listener = Listener(0);
            let c = told.step_observed(&faced, dt, &mut listener);
            assert_eq!([a.hits, a.caps.bounces], [b.hits, b.caps.bounces], "{number} {step}");
            assert_eq!((a.hits, a.caps, listener.0), (c.hits, c.caps, c.hits), "{number} {step}");
            let same = short.particles().position.iter().zip(long.particles().position);
            for (row, (x, y)) in same.enumerate() {
                assert_eq!(
                    x.to_array().map(f32::to_bits),
                    y.to_array().map(f32::to_bits),
                    "{number} {step} {row} {method}"
                );
            }
            assert_eq!([short.hash(), told.hash()], [long.hash(); 2], "{number} {step} {method}");
            hits += a.hits;
        }
    }
    assert!(hits > 500 * count as u64, "{hits}");
}

/// A sink takes what touches it wherever that is, over a ground as elsewhere.
#[test]
fn sinks_beside_a_face_take_who_touches_them() {
    let ground = Plane { point: Vec3::ZERO, normal: Vec3::Y };
    let sink = Sphere { center: Vec3::Y * 5.0, radius: 1.0 };
    let mut random = Random::new(79);
    let mut start = crowd(&mut random, &ground, 1.0, 0.0);
    start.push(Particle { position: Vec3::new(-3.0, 5.0, 0.0), velocity: Vec3::X * 60.0, ..Particle::REST });
    let silent = Silent(ground);
    let base = Scene { start: &start, sinks: &sink, forces: &Gravity::EARTH, ..Scene::EMPTY };
    let (faced, plain) = (Scene { colliders: &ground, ..base }, Scene { colliders: &silent, ..base });
    let mut systems: [System<Heap>; 2] = [&faced, &plain].map(|scene| started(scene, 400, 5));
    for step in 0..60 {
        let [short, long] = &mut systems;
        short.step(&faced, Time::frame(1, 60));
        long.step(&plain, Time::frame(1, 60));
        assert_eq!(short.hash(), long.hash(), "{step}");
    }
    assert!(systems[0].totals().died.sink > 0);
}

/// A path near one face of many things goes the short way, too.
#[test]
fn a_floor_among_other_things_has_the_same_bits() {
    let mut random = Random::new(77);
    let floor = Plane { point: Vec3::ZERO, normal: Vec3::Y };
    for number in 0..12 {
        let radius = [0.0, 0.05][number % 2];
        let start = crowd(&mut random, &floor, 1.0, radius);
        let balls: Vec<Sphere> =
            (0..6).map(|_| Sphere { center: random.vector(3.0), radius: random.between(0.1, 0.6) }).collect();
        let low = random.vector(2.0);
        let chest = Cuboid { min: low, max: low + Vec3::new(0.5, 0.3, 0.8) };
        let things = (floor, &balls[..], chest);
        let silent = Silent((floor, &balls[..], chest));
        let base = Scene {
            start: &start,
            forces: &(Gravity::EARTH, Drag {}),
            integrator: &pointmass::Symplectic,
            ..Scene::EMPTY
        };
        let (faced, plain) = (Scene { colliders: &things, ..base }, Scene { colliders: &silent, ..base });
        let mut systems: [System<Heap>; 2] = [&faced, &plain].map(|scene| started(scene, 400, 5));
        for step in 0..120 {
            let [short, long] = &mut systems;
            let dt = Time::from_seconds([1.0 / 60.0, 1.0 / 24.0][number / 2 % 2]);
            let (a, b) = (short.step(&faced, dt), long.step(&plain, dt));
            assert_eq!((a.hits, short.hash()), (b.hits, long.hash()), "{number} {step}");
        }
    }
}

/// Many things behind an index of their boxes are what the list of them is.
#[test]
fn scenery_has_the_bits_of_the_list() {
    let mut random = Random::new(78);
    for number in 0..6 {
        let radius = [0.0, 0.05][number % 2];
        let mut things: Vec<Moving<Placed<Shape<Mesh<'_>>>>> = Vec::new();
        let mut boxes = Vec::new();
        for i in 0..60 {
            let low = random.vector(4.0);
            let form = match i % 3 {
                0 => Shape::Sphere(Sphere { center: low, radius: random.between(0.05, 0.4) }),
                1 => Shape::Box(Cuboid { min: low, max: low + Vec3::new(0.4, 0.2, 0.5) }),
                _ if i == 8 || i == 44 => Shape::Plane(Plane { point: Vec3::NEG_Y * i as f32 * 0.1, normal: Vec3::Y }),
                _ => Shape::Cylinder(Cylinder { center: low, radius: 0.2, height: 0.7 }),
            };
            let placed =
                Placed::new(form, Affine::IDENTITY).expect("it stands as it is").made_of((i % 4 == 0).then_some(0));
            let swing = if i % 7 == 6 { random.vector(0.5) } else { Vec3::ZERO };
            let moving =
                Moving::new(placed.clone(), &placed.bounds(), Motion { swing, frequency: 0.7, ..Motion::STILL });
            boxes.push(moving.reach());
            things.push(moving);
        }
        let floor = Plane { point: Vec3::ZERO, normal: Vec3::Y };
        let start = crowd(&mut random, &floor, 1.0, radius);
        let materials =
            [ContactMaterial { friction: Some(Friction { static_: 0.5, kinetic: 0.4 }), elasticity: Some(0.4) }];
        let scenery = Scenery::new(things.iter().cloned().zip(boxes).collect());
        let response = [Response::Position(Position::default()), Response::Impulse {}][number / 2 % 2];
        let base = Scene { start: &start, forces: &(Gravity::EARTH, Drag {}), materials: &materials, ..Scene::EMPTY };
        let method: &dyn Integrator = if number < 3 { &pointmass::Symplectic } else { &pointmass::Euler };
        let base = Scene { integrator: method, ..base };
        let contacts = response.contacts();
        let base =
            if number < 4 { base } else { Scene { constraints: &contacts, meetings: response.meetings(), ..base } };
        let (sorted, listed) = (Scene { colliders: &scenery, ..base }, Scene { colliders: &things, ..base });
        let mut systems: [System<Heap>; 2] = [&sorted, &listed].map(|scene| started(scene, 400, 5));
        for step in 0..60 {
            let [a, b] = &mut systems;
            let dt = Time::from_seconds(1.0 / 60.0);
            let (x, y) = (a.step(&sorted, dt), b.step(&listed, dt));
            assert_eq!((x.hits, a.hash()), (y.hits, b.hash()), "{number} {step}");
        }
        assert!(systems[0].totals().hits > 300);
    }
}
