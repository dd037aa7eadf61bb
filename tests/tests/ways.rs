//! The short ways through a step have the bits of the long one, in scenes of all kinds: rows that leap, packets past faces, tiles, threads, and who
//! looks on change nothing.

use core::ops::Range;
use pointmass::force::{Friction, State};
use pointmass::integrate::{Drift, Dynamics, Motion};
use pointmass::shape::{
    Collider, Contact, Cuboid, Hit, Hulls, Marks, Plane, Ride, Scenery, Segment, Shape, Sphere, Surface,
};
use pointmass::{
    Attention, ContactMaterial, Drag, Emitter, Euler, Force, Gravity, Heap, Integrator, Observer, Particle,
};
use pointmass::{Scene, Spread, Symplectic, System, Time, Varied, Vec3};
use pointmass_tests::{Form, Random, often, started};

/// A collider that does not say what of it is near.
struct Silent<C>(C);

impl<C: Collider> Collider for Silent<C> {
    fn first_hit(&self, segment: &Segment) -> Option<Hit> {
        self.0.first_hit(segment)
    }
    fn may_touch(&self, bounds: &pointmass::shape::Aabb) -> bool {
        self.0.may_touch(bounds)
    }
    fn mark_near(&self, hulls: &Hulls, marks: &mut Marks) {
        self.0.mark_near(hulls, marks);
    }
    fn contacts(&self, center: Vec3, reach: f32, at: Time, visit: &mut dyn FnMut(&Contact)) {
        self.0.contacts(center, reach, at, visit);
    }
    fn carry(&self, point: Vec3, radius: f32, during: [Time; 2]) -> Vec3 {
        self.0.carry(point, radius, during)
    }
    fn carry_on(&self, way: &Segment) -> Option<Vec3> {
        self.0.carry_on(way)
    }
    fn ride(&self, seat: &Segment) -> Option<Ride> {
        self.0.ride(seat)
    }
    fn is_empty(&self) -> bool {
        self.0.is_empty()
    }
}

/// A force that does not say that it is steady.
struct Unsteady<'a>(&'a dyn Force);

impl Force for Unsteady<'_> {
    fn add_to(&self, state: &State<'_>, rows: Range<usize>, total: &mut [Vec3]) {
        self.0.add_to(state, rows, total);
    }
    fn is_local(&self) -> bool {
        self.0.is_local()
    }
}

/// A method that says as much of itself as it is told to.
struct Reticent<'a> {
    method: &'a dyn Integrator,
    is_local: bool,
    drifts: bool,
}

impl Integrator for Reticent<'_> {
    fn columns(&self) -> usize {
        self.method.columns()
    }
    fn is_local(&self) -> bool {
        self.is_local
    }
    fn drift(&self) -> Option<Drift> {
        if self.drifts { self.method.drift() } else { None }
    }
    fn advance(&self, motion: Motion<'_>, time: Time, step: Time, world: &mut dyn Dynamics) {
        self.method.advance(motion, time, step, world);
    }
}

/// Someone who wants to know of so much.
struct Onlooker(Attention);

impl Observer for Onlooker {
    fn attention(&self) -> Attention {
        self.0
    }
}

fn one_of<T: Copy>(random: &mut Random, all: &[T]) -> T {
    all[random.word() as usize % all.len()]
}

/// A particle about a plane, with numbers of all kinds where things are `wild`.
fn particle(random: &mut Random, plane: &Plane, [scale, radius]: [f32; 2], wild: bool) -> Particle {
    let r = random;
    let (up, aside) = (plane.normal.normalize(), r.vector(3.0 * scale));
    let height = one_of(r, &[0.0, 0.0, 1e-6, 0.01, 0.3, 1.0, -0.2]) * scale * r.between(0.5, 1.0);
    let speed = one_of(r, &[0.0, 0.01, 1.0, 12.0]) * scale;
    let is_odd = |r: &mut Random| wild && r.word().is_multiple_of(40);
    let strange = if is_odd(r) { one_of(r, &[f32::NAN, f32::INFINITY, 1e3, 1e-40]) } else { 1.0 };
    let radius = radius * one_of(r, &[1.0, 1.0, 0.4, 3.0]);
    Particle {
        position: plane.point + aside - up * aside.dot(up) + up * (height + radius),
        velocity: r.vector(speed) * strange,
        radius: if is_odd(r) { one_of(r, &[0.0, 1e-30, 1e20]) } else { radius },
        drag: one_of(r, &[0.0, 0.2, 3.0, 1e-3, 1e6]),
        mass: if is_odd(r) { one_of(r, &[1e-38, 1e38, 0.0, f32::INFINITY, -1.0]) } else { r.between(0.5, 2.0) },
        elasticity: one_of(r, &[0.0, 0.5, 0.9, 1.0, 1.5, f32::NAN, -0.1, 0.3, 0.7]),
        material: one_of(r, &[None, Some(0), Some(1), Some(9)]),
        fixed: r.word().is_multiple_of(41),
        lifetime: one_of(r, &[0.0, 0.0, 0.0, -1.0, f32::NAN, f32::INFINITY, 1e-9, 1e30, 0.1, 0.3, 0.5]),
        ..Particle::REST
    }
}

/// Balls and boxes about a place, some of them in each other.
fn things(random: &mut Random, plane: &Plane, scale: f32) -> Vec<Form> {
    let count = random.word() % 40;
    let thing = |i: u64| {
        let low = plane.point + random.vector(3.0 * scale);
        match i % 3 {
            0 => Shape::Sphere(Sphere { center: low, radius: random.between(0.05, 0.4) * scale }),
            1 => Shape::Box(Cuboid { min: low, max: low + Vec3::new(0.4, 0.2, 0.5) * scale }),
            _ if i == 8 => Shape::Plane(*plane),
            _ => Shape::Sphere(Sphere { center: low, radius: 0.1 * scale }),
        }
    };
    (0..count).map(thing).collect()
}

fn fountain(random: &mut Random, plane: &Plane, scale: f32) -> Emitter<Sphere> {
    let form = Sphere { center: plane.point + plane.normal.normalize() * (0.5 * scale), radius: 0.1 * scale };
    Emitter {
        speed: Varied { mean: 2.0 * scale, half_width: scale },
        spread: Spread::Uniform(1.0),
        elasticity: Varied { mean: 0.5, half_width: 0.5 },
        radius: Varied::exactly(one_of(random, &[0.0, 0.0, 0.02, 0.15]) * scale),
        lifetime: Varied { mean: one_of(random, &[0.0, 0.01, 0.5]), half_width: one_of(random, &[0.0, 0.3]) },
        ..Emitter::new(form, one_of(random, &[0.0, 100.0, 2000.0]))
    }
}

/// Takes systems that go the long way, and several short ones, through the same steps, while particles come and go by hand.
fn compare(random: &mut Random, scenes: [&Scene<'_>; 6], new: &[Particle], number: usize) -> u64 {
    let r = random;
    let capacity = one_of(r, &[scenes[0].start.len() + 200, scenes[0].start.len(), scenes[0].start.len() / 2, 1, 0]);
    let mut systems: [System<Heap>; 6] = scenes.map(|scene| started(scene, capacity, 5));
    let usual = one_of(r, &[1.0 / 60.0, 1.0 / 24.0, 1.0 / 144.0, 0.2, 1e-6]);
    for step in 0..12 {
        let late = one_of(r, &[1.0, 5.0]);
        let seconds = one_of(r, &[usual, usual, usual, usual, usual, usual, 0.0, 3e-10, 0.1, late]);
        let dt = Time::from_seconds(seconds);
        let (comes, goes, row) = (r.word().is_multiple_of(2), r.word().is_multiple_of(2), r.word() as usize);
        let mut ways = systems.iter_mut().zip(scenes).enumerate().map(|(way, (system, scene))| {
            if comes && !new.is_empty() {
                let _ = system.spawn(&new[row % new.len()]);
            }
            if let Some(id) = system.id(row % system.len().max(1)).filter(|_| goes) {
                system.remove(scene, id);
            }
            let report = match way {
                4 => system.step_observed(scene, dt, &mut Onlooker(Attention::Events)),
                5 => system.step_observed(scene, dt, &mut Onlooker(Attention::Phases)),
                _ => system.step(scene, dt),
            };
            (system.hash(), report)
        });
        let long = ways.next().expect("there are six");
        for (way, short) in ways.enumerate() {
            assert_eq!(short, long, "scene {number}, step {step}, way {}", way + 1);
        }
    }
    systems[0].totals().hits
}

#[test]
fn short_ways_have_the_bits_of_the_long_one() {
    let (mut hits, count) = (0, if cfg!(debug_assertions) { 170 } else { 5_000 });
    // One that lies on a plane, on its other side by rounding.
    for number in (0..count).chain([1_090]) {
        let r = &mut Random::new(7919 * number as u64 + 13);
        let scale = one_of(r, &[1.0, 1.0, 1.0, 1e-3, 40.0, 1e-6, 1e3]);
        let far = one_of(r, &[0.0, 0.0, 1.0, 1e3]) * scale;
        let normals = [Vec3::Y, Vec3::Y, Vec3::NEG_Y * 3.0, Vec3::X * -0.1, Vec3::Z, r.direction() * 0.7];
        let plane = Plane { point: r.vector(far), normal: one_of(r, &normals) };
        let sizes = [scale, one_of(r, &[0.0, 0.0, 0.02, 1e-7, 0.2]) * scale];
        let (wild, len) = (r.word().is_multiple_of(2), one_of(r, &[0, 1, 2, 7, 31, 64, 65, 163, 300, 1281]));
        let mut start: Vec<Particle> = (0..len + 4).map(|_| particle(r, &plane, sizes, wild)).collect();
        if r.word().is_multiple_of(3) {
            // All but one fall alike, or all.
            let (one, odd) = (start[0], one_of(r, &[None, Some(0), Some(len / 2), Some(len + 1)]));
            for (_, other) in start.iter_mut().enumerate().filter(|(i, _)| Some(*i) != odd) {
                *other = Particle { mass: one.mass, drag: one.drag, fixed: one.fixed, ..*other };
            }
        }
        let new = start.split_off(len);
        let down = plane.normal.normalize() * -9.8 * scale;
        let askew = down + r.vector(2.0 * scale);
        let g = Gravity { acceleration: one_of(r, &[Vec3::ZERO, down * 1e3, -down, askew, askew, askew]) };
        let (both, turned) = ((g, Drag {}), (Drag {}, g));
        let forces = one_of(r, &[&() as &dyn Force, &g, &Drag {}, &both, &turned, &both]);
        let method = one_of(r, &[&Euler as &dyn Integrator, &Symplectic, &Symplectic]);
        let friction = ContactMaterial { friction: Some(Friction { static_: 0.5, kinetic: 0.4 }), elasticity: None };
        let materials = &[friction, ContactMaterial { elasticity: Some(0.3), friction: None }];
        let list = things(r, &plane, scale);
        let scenery = Scenery::new(list.iter().map(|thing| (thing.clone(), thing.bounds())).collect());
        let sides: [(&dyn Collider, &dyn Collider); 4] =
            [(&(), &()), (&plane, &Silent(plane)), (&plane, &Silent(plane)), (&scenery, &Silent(&list))];
        let (colliders, silent) = one_of(r, &sides);
        let drain = Plane { point: plane.point + down * 0.01, ..plane };
        let sinks = one_of(r, &[&() as &dyn Collider, &(), &drain]);
        let base = Scene { start: &start, forces, colliders, sinks, integrator: method, ..Scene::EMPTY };
        let base = if wild { base } else { Scene { materials, ..base } };
        let emitter = fountain(r, &plane, scale);
        let base = if r.word().is_multiple_of(2) { base } else { Scene { emitters: &emitter, ..base } };
        let (max_bounces, substeps) = (one_of(r, &[8, 8, 8, 1, 2, 0, 3, 4, 5]), one_of(r, &[1, 1, 1, 1, 3, 0]));
        let fast = Scene { max_bounces, substeps, ..base };
        let says = |is_local, drifts| Reticent { method, is_local, drifts };
        let (local, apart, forces) = (says(true, false), says(false, true), Unsteady(forces));
        let long = Scene { forces: &forces, colliders: silent, integrator: &local, ..fast };
        let (stepped, phased) = (Scene { integrator: &local, ..fast }, Scene { integrator: &apart, ..fast });
        hits += compare(r, [&long, &fast, &stepped, &phased, &fast, &fast], &new, number);
    }
    assert!(hits > 50 * count as u64, "{hits}");
}

/// Points and balls that lie, slide, bounce and graze among spheres and boxes, inside of them too, wherever that is: whatever goes eight at a time
/// has the bits of what goes one by one.
#[test]
fn who_goes_among_things_has_the_bits_of_the_long_way() {
    let (mut hits, count) = (0, often(150));
    // In one a point slides on the inside of a sphere as a step ends.
    for number in (0..count).chain([23]) {
        let r = &mut Random::new(104_729 * number as u64 + 7);
        let scale = one_of(r, &[1.0, 1.0, 1e-3, 40.0]);
        let far = one_of(r, &[0.0, 1.0, 1e3]) * scale;
        let normals = [Vec3::Y, Vec3::Y, Vec3::X * 2.0, r.direction()];
        let plane = Plane { point: r.vector(far), normal: one_of(r, &normals) };
        let up = plane.normal.normalize();
        let sizes = [scale, one_of(r, &[0.0, 0.0, 0.0, 0.02, 0.2]) * scale];
        let tame = |r: &mut Random| Particle {
            elasticity: one_of(r, &[0.0, 0.5, 0.9, 1.0, 0.3]),
            drag: one_of(r, &[0.0, 0.2]),
            mass: 1.0,
            lifetime: 0.0,
            ..particle(r, &plane, sizes, false)
        };
        let start: Vec<Particle> = (0..one_of(r, &[9, 150, 500])).map(|_| tame(r)).collect();
        let thing = |i: u64, r: &mut Random| {
            let aside = r.vector(3.0 * scale);
            let center = plane.point + aside - up * aside.dot(up) + up * (r.between(-0.2, 0.3) * scale);
            let size = r.between(0.05, 0.4) * scale * one_of(r, &[1.0, 1.0, 0.1, 4.0]);
            match i % 2 {
                0 => Shape::Sphere(Sphere { center, radius: size }),
                _ => Shape::Box(Cuboid { min: center - size, max: center + Vec3::new(1.0, 0.3, 2.0) * size }),
            }
        };
        let (many, ground) = (one_of(r, &[1, 5, 30, 90]), r.word() % 4);
        let list: Vec<Form> = (0..many).map(|i| if i == ground { Shape::Plane(plane) } else { thing(i, r) }).collect();
        let scenery = Scenery::new(list.iter().map(|thing| (thing.clone(), thing.bounds())).collect());
        let askew = up * -9.8 * scale + r.vector(1.0 * scale);
        let g = Gravity { acceleration: one_of(r, &[up * -9.8 * scale, up * -9.8 * scale, askew]) };
        let forces = (g, Drag {});
        let method = one_of(r, &[&Euler as &dyn Integrator, &Symplectic, &Symplectic]);
        let friction = ContactMaterial { friction: Some(Friction { static_: 0.5, kinetic: 0.4 }), elasticity: None };
        let materials = [friction, ContactMaterial { elasticity: Some(0.3), friction: None }];
        let fast = Scene { start: &start, forces: &forces, colliders: &scenery, integrator: method, ..Scene::EMPTY };
        let max_bounces = one_of(r, &[8, 8, 8, 2, 4]);
        let fast = if number.is_multiple_of(4) { Scene { materials: &materials, ..fast } } else { fast };
        let fast = Scene { max_bounces, ..fast };
        let stepped = Reticent { method, is_local: true, drifts: false };
        let (silent, long) = (Silent(&list), Unsteady(&forces));
        let long = Scene { forces: &long, colliders: &silent, integrator: &stepped, ..fast };
        let slow = Scene { integrator: &stepped, ..fast };
        let scenes = [&long, &fast, &slow];
        let mut systems = scenes.map(|scene| started(scene, start.len(), 5));
        let dt = Time::from_seconds(one_of(r, &[1.0 / 60.0, 1.0 / 60.0, 1.0 / 24.0, 1.0 / 200.0]));
        for step in 0..40 {
            let mut ways =
                systems.iter_mut().zip(scenes).map(|(system, scene)| (system.step(scene, dt), system.hash()));
            let long = ways.next().expect("there are three");
            for (way, short) in ways.enumerate() {
                assert_eq!(short, long, "scene {number}, step {step}, way {way}");
            }
        }
        hits += systems[0].totals().hits;
    }
    assert!(hits > 200 * count as u64, "{hits}");
}

/// At the end of all time nothing moves, and just before it only as far as that, whichever way rows go.
#[test]
fn no_way_leads_beyond_the_end_of_time() {
    let ground = Plane { point: Vec3::ZERO, normal: Vec3::Y };
    let start = [Particle { position: Vec3::Y, velocity: Vec3::X, ..Particle::REST }];
    for method in [&Euler as &dyn Integrator, &Symplectic] {
        let long = Reticent { method, is_local: true, drifts: false };
        let fast = Scene { forces: &Gravity::EARTH, colliders: &ground, integrator: method, ..Scene::EMPTY };
        let ends = [&fast, &Scene { integrator: &long, ..fast }].map(|scene| {
            let mut system = started(scene, 1, 0);
            let before = Time::from_seconds(0.25);
            system.step(&Scene::EMPTY, Time::NEVER - before);
            let _ = system.spawn(&start[0]);
            for _ in 0..3 {
                system.step(scene, Time::from_seconds(1.0 / 6.0));
            }
            (system.particles().position[0], system.hash())
        });
        assert_eq!(ends[0], ends[1]);
        assert!((ends[0].0.x - 0.25).abs() < 1e-6, "{}", ends[0].0);
    }
}

/// Balls are born so near to things that they touch them in the step of their birth, over a ground that has no end.
#[test]
fn newborn_balls_meet_things_whoever_looks_on() {
    let ground = Plane { point: Vec3::ZERO, normal: Vec3::Y };
    let mut hits = 0;
    for (number, radius) in [0.0, 0.18, 0.2, 0.21].into_iter().enumerate() {
        for scale in [1.0, 1e-3, 40.0] {
            let around = |i: usize| {
                let at = Vec3::new([0.32, -0.62, 0.0][i], 0.6, [0.0, 0.0, 0.32][i]) * scale;
                Shape::Box(Cuboid { min: at, max: at + Vec3::splat(0.3 * scale) })
            };
            let list = [around(0), Shape::Plane(ground), around(1), around(2)];
            let scenery = Scenery::new(list.iter().map(|thing: &Form| (thing.clone(), thing.bounds())).collect());
            let form = Sphere { center: Vec3::Y * 0.75 * scale, radius: 0.1 * scale };
            let emitter = Emitter {
                speed: Varied { mean: 2.0 * scale, half_width: scale },
                spread: Spread::Uniform(1.5),
                radius: Varied::exactly(radius * scale),
                elasticity: Varied::exactly(0.5),
                ..Emitter::new(form, 900.0)
            };
            let g = Gravity { acceleration: Vec3::NEG_Y * 9.8 * scale };
            let scene = Scene { emitters: &emitter, forces: &g, colliders: &scenery, ..Scene::EMPTY };
            let [mut unseen, mut seen] = [started(&scene, 400, 5), started(&scene, 400, 5)];
            for step in 1..=20 {
                let reports = [
                    unseen.step_to(&scene, Time::frame(step, 60)),
                    seen.step_to_observed(&scene, Time::frame(step, 60), &mut Onlooker(Attention::Phases)),
                ];
                assert_eq!((reports[0], unseen.hash()), (reports[1], seen.hash()), "{number}, {scale}, step {step}");
            }
            hits += seen.totals().hits;
        }
    }
    assert!(hits > 500, "{hits}");
}
