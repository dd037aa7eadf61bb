//! Elastic blows of rigid bodies: at however many points they happen at once, none gives energy.

use pointmass::constrain::{HullBuf, RigidBodies, RigidBox};
use pointmass::force::Friction;
use pointmass::shape::{Collider, Cuboid, HeightField, MeshBuf, Plane, Segment, Sphere};
use pointmass::{ContactMaterial, Force, Gravity, Heap, Measures, Method, Particle, Scene, System, Time, Vec3};
use pointmass_tests::{Random, is_third, often, started};

const DOWN: Gravity = Gravity { acceleration: Vec3::new(0.0, -9.81, 0.0) };

/// A body of 0.2 kg and some 0.2 m: a box of any sides, or a stone; with its particles, as they are thrown.
fn body(
    random: &mut Random,
    hull: Option<&HullBuf>,
    at: Vec3,
    first: u32,
    elasticity: f32,
) -> (RigidBox, [Particle; 8]) {
    let half = Vec3::new(random.between(0.05, 0.15), random.between(0.05, 0.15), random.between(0.05, 0.15));
    let turn = [random.between(-1.0, 1.0), random.between(-1.0, 1.0), random.between(-1.0, 1.0), 0.5];
    let of = hull.map_or(RigidBox::new(half, at, first), |hull| RigidBox::with_hull(&hull.lend(), 0, at, first));
    let of = RigidBox { turn, ..of };
    let (velocity, spin) = (random.direction() * random.between(1.0, 4.0), random.vector(6.0));
    let whole = Particle { velocity, mass: 0.2, drag: 0.0, elasticity, material: Some(0), ..Particle::REST };
    let solid = hull.map_or_else(|| of.solid(whole), |hull| of.solid_hull(&hull.lend(), whole));
    (of, solid.map(|p| Particle { velocity: velocity + spin.cross(p.position - of.center), ..p }))
}

fn energy(system: &System<Heap>, scene: &Scene<'_>) -> f64 {
    Measures::of(system, scene).energy.total()
}

/// The most by which energy rises above that of the beginning and what the method itself `lifts` [W], and what is left in the end, as shares of that.
fn course(scene: &Scene<'_>, seconds: u32, lifts: f64) -> [f64; 2] {
    let mut system = started(scene, scene.start.len(), 1);
    let first = energy(&system, scene);
    let (mut last, mut above) = (first, 0f64);
    for frame in 1..=u64::from(60 * seconds) {
        system.step_to(scene, Time::frame(frame, 60));
        last = energy(&system, scene);
        above = above.max((last - first - lifts * system.time().seconds_f64()) / first.abs());
    }
    [above, last / first]
}

/// A room 1.8 m wide, with one thing of every kind in it.
fn rooms(heights: &[f32]) -> Vec<(&'static str, Box<dyn Collider + '_>)> {
    let room = Cuboid { min: Vec3::splat(-0.9), max: Vec3::splat(0.9) };
    let corners = [[-0.4, -0.9, -0.4], [0.4, -0.9, -0.4], [0.0, -0.9, 0.5], [0.0, -0.4, 0.0]].map(Vec3::from_array);
    let hill = MeshBuf::new(corners.to_vec(), vec![[0, 3, 1], [1, 3, 2], [2, 3, 0]]).expect("a hill is a mesh");
    let field = HeightField::new(Vec3::new(-1.2, -0.9, -1.2), 0.3, 9, heights).expect("nine by nine");
    let slope = Plane { point: Vec3::new(0.0, -0.7, 0.0), normal: Vec3::new(0.4, 1.0, 0.2).normalize() };
    let ball = Sphere { center: Vec3::new(0.0, -0.9, 0.0), radius: 0.3 };
    let block = Cuboid { min: Vec3::new(-0.25, -0.9, -0.25), max: Vec3::new(0.25, -0.6, 0.25) };
    vec![
        ("room", Box::new(room)),
        ("slope", Box::new((room, slope))),
        ("ball", Box::new((room, ball))),
        ("block", Box::new((room, block))),
        ("hill", Box::new((room, hill))),
        ("heights", Box::new((room, field))),
    ]
}

#[test]
fn no_blow_gives_energy() {
    let mut random = Random::new(91);
    let points: Vec<_> = (0..30).map(|_| random.direction() * random.between(0.09, 0.12)).collect();
    let stone = [HullBuf::of(&points).expect("a stone")];
    let heights: Vec<f32> = (0..81).map(|_| random.between(0.0, 0.25)).collect();
    let (mut cases, mut failures) = (0, vec![]);
    for round in 0..often(600) {
        if !is_third(&mut cases) {
            continue;
        }
        let rooms = rooms(&heights);
        let (at, room) = &rooms[round % rooms.len()];
        let elasticity = [0.5, 0.9, 1.0][random.word() as usize % 3];
        let substeps = 1 + (random.word() % 20) as u32;
        let count = 1 + (random.word() % 4) as u32;
        let mu = if random.unit() < 0.5 { 0.0 } else { random.unit() };
        let method = Method::ALL[random.word() as usize % Method::ALL.len()];
        let (mut start, mut bodies) = (vec![], vec![]);
        for i in 0..count {
            let hull = (random.unit() < 0.4).then_some(&stone[0]);
            let place = Vec3::new(0.4 * i as f32 - 0.6, 0.3, random.between(-0.3, 0.3));
            let (of, solid) = body(&mut random, hull, place, 8 * i, elasticity);
            start.extend(solid);
            bodies.push(of);
        }
        let bodies = RigidBodies { boxes: bodies, hulls: &stone, balls: 0 };
        let friction = Some(Friction { static_: mu, kinetic: mu });
        let materials = [ContactMaterial { elasticity: Some(elasticity), friction }];
        let falls = random.unit() < 0.5;
        let scene = Scene {
            start: &start,
            forces: if falls { &DOWN as &dyn Force } else { &() },
            colliders: &**room,
            materials: &materials,
            constraints: &bodies,
            integrator: method.integrator(),
            substeps,
            ..Scene::EMPTY
        };
        // Explicit Euler goes by the velocity of a step's beginning, and so gives whatever falls m (g h)² / 2 in each step.
        let lags = falls && method == Method::Euler;
        let h = 1.0 / (60.0 * f64::from(substeps));
        let lifts = if lags { 0.5 * 0.2 * f64::from(count) * 9.81 * 9.81 * h } else { 0.0 };
        let [above, _] = course(&scene, 4, lifts);
        if !(above < 0.01) {
            let what = format!("{at}, {count} bodies, e {elasticity}, mu {mu}");
            failures.push(format!("{what}, {substeps} sub-steps, {}, falls {falls}: {above}", method.name()));
        }
    }
    assert!(failures.is_empty(), "{failures:#?}");
}

/// Bodies that go by up to a hundred of their sizes in a sub-step, on a plane and in a room, alone and among others.
#[test]
fn no_speed_gives_energy() {
    let mut random = Random::new(96);
    let points: Vec<_> = (0..30).map(|_| random.direction() * random.between(0.09, 0.12)).collect();
    let stone = [HullBuf::of(&points).expect("a stone")];
    let (mut cases, mut failures) = (0, vec![]);
    for round in 0..often(1500) {
        if !is_third(&mut cases) {
            continue;
        }
        let plane = Plane { point: Vec3::ZERO, normal: Vec3::Y };
        let room = Cuboid { min: Vec3::new(-1.5, 0.0, -1.5), max: Vec3::new(1.5, 2.0, 1.5) };
        let floor: &dyn Collider = if round % 2 == 0 { &plane } else { &room };
        let elasticity = [0.0, 0.5, 1.0][random.word() as usize % 3];
        let substeps = 1 + (random.word() % 8) as u32;
        let sizes = 10f32.powf(random.between(-0.5, 2.0));
        let speed = sizes * 0.2 * 60.0 * substeps as f32;
        let count = 1 + (random.word() % 5) as u32;
        let mu = if random.unit() < 0.5 { 0.0 } else { random.unit() };
        let method = Method::ALL[1 + random.word() as usize % (Method::ALL.len() - 1)];
        let (mut start, mut bodies) = (vec![], vec![]);
        for i in 0..count {
            let hull = (random.unit() < 0.4).then_some(&stone[0]);
            let place = Vec3::new(random.between(-0.2, 0.2), 0.25 + 0.3 * i as f32, random.between(-0.2, 0.2));
            let (of, solid) = body(&mut random, hull, place, 8 * i, elasticity);
            let pace = random.direction() * Vec3::new(1.0, 0.1, 1.0) * speed;
            start.extend(solid.map(|p| Particle { velocity: p.velocity + pace, ..p }));
            bodies.push(of);
        }
        let bodies = RigidBodies { boxes: bodies, hulls: &stone, balls: 0 };
        let friction = Some(Friction { static_: mu, kinetic: mu });
        let materials = [ContactMaterial { elasticity: Some(elasticity), friction }];
        let scene = Scene {
            start: &start,
            forces: &DOWN,
            colliders: floor,
            materials: &materials,
            constraints: &bodies,
            integrator: method.integrator(),
            substeps,
            ..Scene::EMPTY
        };
        let [above, _] = course(&scene, 1, 0.0);
        if !(above < 1e-3) {
            let what = format!("{count} bodies, e {elasticity}, mu {mu}, {sizes} sizes in one of {substeps} sub-steps");
            failures.push(format!("{what}, {}: {above}", method.name()));
        }
    }
    assert!(failures.is_empty(), "{failures:#?}");
}

/// Boxes are thrown on a smooth floor: how fast they slide along it makes no difference to how they bounce and tumble.
#[test]
fn boxes_bounce_on_a_smooth_floor_alike_however_fast_they_slide() {
    let mut random = Random::new(97);
    let floor = Plane { point: Vec3::ZERO, normal: Vec3::Y };
    for round in 0..often(300) {
        let elasticity = [0.0, 0.5][round % 2];
        let at = Vec3::Y * 0.27;
        let (of, solid) = body(&mut random, None, at, 0, elasticity);
        let solid = solid.map(|p| Particle { velocity: p.velocity * Vec3::new(0.3, 0.3, 0.3), ..p });
        let substeps = 1 + (random.word() % 8) as u32;
        let method = Method::ALL[random.word() as usize % Method::ALL.len()];
        let fast = 0.1 * 60.0 * substeps as f32 * 10f32.powf(random.between(-1.0, 1.5));
        let [slow, quick] = [0.0, fast].map(|speed| {
            let start = solid.map(|p| Particle { velocity: p.velocity + Vec3::X * speed, ..p });
            let bodies = RigidBodies::boxes([of]);
            let scene = Scene {
                start: &start,
                forces: &DOWN,
                colliders: &floor,
                constraints: &bodies,
                integrator: method.integrator(),
                substeps,
                ..Scene::EMPTY
            };
            let mut system = started(&scene, 8, 1);
            let heights = (1..=15).map(|frame| {
                system.step_to(&scene, Time::frame(frame, 60));
                system.particles().position.iter().map(|x| x.y).collect::<Vec<_>>()
            });
            heights.collect::<Vec<_>>().concat()
        });
        let apart = slow.iter().zip(&quick).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
        assert!(apart < 1e-4, "{fast} m/s, {substeps} sub-steps, e {elasticity}, {}: {apart} m", method.name());
    }
}

/// Two boxes that begin in each other part as fast as they did, or as their elasticity says where they meet, whatever the sub-step: contacts push and do not hold.
#[test]
fn what_overlaps_parts_as_fast_as_it_should() {
    let mut random = Random::new(98);
    for round in 0..often(600) {
        let substeps = [1, 4, 20, 400][round % 4];
        let side = random.magnitude(0.01, 3.0);
        let overlap = side * random.between(1e-3, 0.05);
        let elasticity = [0.0, 0.5, 1.0][random.word() as usize % 3];
        let parting = random.between(-1.0, 1.0) * side;
        let along = random.direction();
        let turn = [0.0, -along.z, along.y, 1.0 + along.x];
        let (mut start, mut boxes) = (vec![], vec![]);
        for way in [-0.5, 0.5] {
            let of = RigidBox::new(Vec3::splat(0.5 * side), along * (way * (side - overlap)), 8 * boxes.len() as u32);
            let of = RigidBox { turn, ..of };
            start.extend(of.solid(Particle {
                velocity: along * (way * parting),
                mass: 0.5,
                elasticity,
                ..Particle::REST
            }));
            boxes.push(of);
        }
        let bodies = RigidBodies::boxes(boxes);
        let method = Method::ALL[random.word() as usize % Method::ALL.len()];
        let scene =
            Scene { start: &start, constraints: &bodies, integrator: method.integrator(), substeps, ..Scene::EMPTY };
        let mut system = started(&scene, 16, 1);
        for frame in 1..=3 {
            system.step_to(&scene, Time::frame(frame, 60));
            let v = system.particles().velocity;
            let middle = |first: usize| v[first..first + 8].iter().sum::<Vec3>() / 8.0;
            let now = (middle(8) - middle(0)).dot(along);
            let wanted = if parting < 0.0 { -parting * elasticity } else { parting };
            assert!(
                (now - wanted).abs() < 1e-3 * side,
                "{side} m, {overlap} m deep, e {elasticity}, {substeps} sub-steps: {parting} to {now} m/s"
            );
        }
    }
}

/// Boxes that hit a wall with one corner, smoothly.
#[test]
fn a_corner_gives_back_all_of_it() {
    let mut random = Random::new(92);
    let wall = Plane { point: Vec3::ZERO, normal: Vec3::Y };
    for _ in 0..often(600) {
        let at = Vec3::Y * random.between(0.35, 0.5);
        let (of, solid) = body(&mut random, None, at, 0, 1.0);
        let down = Vec3::NEG_Y * random.between(1.0, 3.0);
        let middle = solid.iter().map(|p| p.velocity).sum::<Vec3>() / 8.0;
        let spin = random.between(0.1, 0.3);
        let start = solid.map(|p| Particle { velocity: (p.velocity - middle) * spin + down, ..p });
        let bodies = RigidBodies::boxes([of]);
        let materials = [ContactMaterial { elasticity: Some(1.0), friction: None }];
        let substeps = 1 + (random.word() % 20) as u32;
        let scene = Scene {
            start: &start,
            colliders: &wall,
            materials: &materials,
            constraints: &bodies,
            substeps,
            ..Scene::EMPTY
        };
        let [above, left] = course(&scene, 1, 0.0);
        assert!(left > 0.9 && above < 0.01, "{substeps} sub-steps: {left} {above}");
    }
}

/// Boxes fall on ground so rough that it has more faces around them than a body is pressed by at a time: their middles stay above it.
#[test]
fn rough_ground_holds_boxes() {
    let mut random = Random::new(93);
    for round in 0..often(600) {
        let spacing = random.between(0.1, 0.3);
        let heights: Vec<f32> = (0..625).map(|_| random.between(0.0, spacing)).collect();
        let half = 12.0 * spacing;
        let ground = HeightField::new(Vec3::new(-half, 0.0, -half), spacing, 25, &heights).expect("25 by 25");
        let elasticity = [0.0, 0.5, 0.9][random.word() as usize % 3];
        let substeps = 5 + (random.word() % 20) as u32;
        let mu = random.unit();
        let (of, solid) = body(&mut random, None, Vec3::Y * 0.6, 0, elasticity);
        let start = solid.map(|p| Particle { velocity: p.velocity * 0.25, ..p });
        let bodies = RigidBodies::boxes([of]);
        let friction = Some(Friction { static_: mu, kinetic: mu });
        let materials = [ContactMaterial { elasticity: Some(elasticity), friction }];
        let scene = Scene {
            start: &start,
            forces: &DOWN,
            colliders: &ground,
            materials: &materials,
            constraints: &bodies,
            integrator: Method::ALL[1 + round % (Method::ALL.len() - 1)].integrator(),
            substeps,
            ..Scene::EMPTY
        };
        let mut system = started(&scene, 8, 1);
        for frame in 1..=90 {
            system.step_to(&scene, Time::frame(frame, 60));
            let middle = system.particles().position.iter().sum::<Vec3>() / 8.0;
            let sideways = middle.x.abs().max(middle.z.abs());
            if sideways > half - spacing {
                break;
            }
            let down = Segment::new(Vec3 { y: 2.0, ..middle }, Vec3 { y: -1.0, ..middle });
            let hit = ground.first_hit(&down).expect("there is ground");
            let above = middle.y - down.at(hit.time).y;
            assert!(above > 0.0, "round {round}, {substeps} sub-steps, e {elasticity}, spacing {spacing}: {above}");
        }
    }
}

/// Boxes fall on saddles of wide cells, where they lie across ridges and valleys: most of them have come to rest after eight seconds. A place that is found late,
/// when a box has sunk into it, lifts it again and again.
#[test]
fn boxes_come_to_rest_on_saddles() {
    let mut random = Random::new(95);
    let (count, mut restless) = (often(1000), 0);
    for round in 0..count {
        let height = |i: usize| 0.05 * ((i % 21) as f32 - 10.0).powi(2) - 0.05 * ((i / 21) as f32 - 10.0).powi(2);
        let heights: Vec<f32> = (0..441).map(height).collect();
        let ground = HeightField::new(Vec3::new(-10.0, 0.0, -10.0), 1.0, 21, &heights).expect("21 by 21");
        let half = Vec3::from([0; 3].map(|_| random.between(0.12, 0.35)));
        let turn = [random.between(-0.3, 0.3), random.between(-0.3, 0.3), random.between(-0.3, 0.3), 1.0];
        let at = Vec3::new(random.between(-0.4, 0.4), 1.0, random.between(-0.4, 0.4));
        let of = RigidBox { turn, ..RigidBox::new(half, at, 0) };
        let elasticity = [0.0, 0.5][round % 2];
        let start = of.solid(Particle { mass: 0.5, elasticity, material: Some(0), ..Particle::REST });
        let bodies = RigidBodies::boxes([of]);
        let materials = [ContactMaterial { elasticity: None, friction: Some(Friction { static_: 0.6, kinetic: 0.5 }) }];
        let method = Method::ALL[1 + round % (Method::ALL.len() - 1)];
        let scene = Scene {
            start: &start,
            forces: &DOWN,
            colliders: &ground,
            materials: &materials,
            constraints: &bodies,
            integrator: method.integrator(),
            substeps: [5, 10, 20][round / 2 % 3],
            ..Scene::EMPTY
        };
        let (mut system, mut fastest) = (started(&scene, 8, 1), 0.0f32);
        for frame in 1..=480 {
            system.step_to(&scene, Time::frame(frame, 60));
            let speeds = system.particles().velocity.iter().map(|v| v.length());
            fastest = if frame > 420 { speeds.fold(fastest, f32::max) } else { 0.0 };
        }
        restless += usize::from(fastest > 1e-3);
    }
    assert!(restless * 16 <= count, "{restless} of {count}");
}
