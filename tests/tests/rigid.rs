//! Rigid bodies that collide as boxes against mechanics: they slide, bounce, collide, stack, tumble and come to rest.

use pointmass::constrain::{RigidBodies, RigidBox};
use pointmass::force::Friction;
use pointmass::index::Structure;
use pointmass::rays;
use pointmass::reap::Chance;
use pointmass::scene::{Model, SceneFile};
use pointmass::shape::{Collider, Cuboid, MeshBuf, Plane};
use pointmass::{ContactMaterial, Gravity, Heap, Measures, Method, Particle, Scene, ShapeMatching, System, Time, Vec3};
use pointmass_tests::{Random, chi_squared, f64s, gap, methods, often, run, started};

const G: f64 = 9.81;
const DOWN: Gravity = Gravity { acceleration: Vec3::new(0.0, -9.81, 0.0) };
const GROUND: Plane = Plane { point: Vec3::ZERO, normal: Vec3::Y };
/// χ² of five degrees of freedom that chance exceeds once in a hundred times.
const FAIR: f64 = 15.09;

/// Material 0 with a coefficient of friction.
const fn rough(mu: f32) -> [ContactMaterial; 1] {
    [ContactMaterial { elasticity: None, friction: Some(Friction { static_: mu, kinetic: mu }) }]
}

/// A box's particles, turning.
fn thrown(of: &RigidBox, whole: Particle, spin: Vec3) -> [Particle; 8] {
    of.solid(whole).map(|p| Particle { velocity: p.velocity + spin.cross(p.position - of.center), ..p })
}

/// The middle of a solid box and its three axes, by its corners.
fn pose(of: &RigidBox, x: &[Vec3]) -> ([f64; 3], [[f64; 3]; 3]) {
    let corners: Vec<_> = x[of.first as usize..][..8].iter().map(|x| f64s(*x)).collect();
    let middle = [0, 1, 2].map(|k| corners.iter().map(|x| x[k]).sum::<f64>() / 8.0);
    let axes = [0, 1, 2].map(|axis| {
        let side = |i: usize| if i >> axis & 1 == 1 { 1.0 } else { -1.0 };
        let sum = [0, 1, 2].map(|k| corners.iter().enumerate().map(|(i, x)| side(i) * x[k]).sum::<f64>());
        sum.map(|s| s / gap(sum, [0.0; 3]))
    });
    (middle, axes)
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// By how much two boxes overlap: the least over all fifteen axes \[m\].
fn overlap(boxes: [&RigidBox; 2], x: &[Vec3]) -> f64 {
    let [(a, u), (b, v)] = boxes.map(|of| pose(of, x));
    let halves = boxes.map(|of| f64s(of.half));
    let way = [0, 1, 2].map(|k| b[k] - a[k]);
    let edges = u.iter().flat_map(|&u| v.iter().map(move |&v| cross(u, v)));
    let axes = u.iter().chain(&v).copied().chain(edges).filter(|axis| dot(*axis, *axis) > 1e-4);
    let along = |axis: [f64; 3]| {
        let reach =
            |axes: &[[f64; 3]; 3], half: [f64; 3]| (0..3).map(|k| half[k] * dot(axes[k], axis).abs()).sum::<f64>();
        (reach(&u, halves[0]) + reach(&v, halves[1]) - dot(way, axis).abs()) / dot(axis, axis).sqrt()
    };
    axes.map(along).fold(f64::INFINITY, f64::min)
}

/// Kinetic and potential energy \[J\].
fn energy(system: &System<Heap>, scene: &Scene<'_>) -> f64 {
    let energy = Measures::of(system, scene).energy;
    energy.kinetic + energy.potential
}

/// The most by which energy has risen above its least so far, over its start; and the fastest particle in the end \[m/s\].
fn watch(system: &mut System<Heap>, scene: &Scene<'_>, frames: u64) -> (f64, f32) {
    let first = energy(system, scene);
    let (mut least, mut risen) = (first, 0f64);
    for frame in 1..=frames {
        system.step_to(scene, Time::frame(frame, 60));
        let now = energy(system, scene);
        least = least.min(now);
        risen = risen.max((now - least) / first.abs());
    }
    (risen, system.particles().velocity.iter().map(|v| v.length()).fold(0.0, f32::max))
}

#[test]
fn a_box_slides_down_a_slope_if_it_is_steeper_than_friction_holds() {
    for (i, (degrees, mu)) in
        [(20.0f32, 0.3f32), (20.0, 0.4), (35.0, 0.6), (35.0, 0.8), (50.0, 0.0)].into_iter().enumerate()
    {
        let (sin, cos) = degrees.to_radians().sin_cos();
        let (normal, half) = (Vec3::new(sin, cos, 0.0), (0.5 * degrees.to_radians()).sin_cos());
        let scale = [1.0, 0.1, 10.0][i % 3];
        let from = Vec3::new(3.0, -2.0, 1.0) * scale;
        let slope = Plane { point: from, normal };
        let method = [Method::Symplectic, Method::Verlet, Method::Rk4][i % 3];
        let cuboid = RigidBox {
            turn: [0.0, 0.0, -half.0, half.1],
            ..RigidBox::new(Vec3::new(0.1, 0.05, 0.1) * scale, from + normal * 0.05 * scale, 0)
        };
        let start = cuboid.solid(Particle { mass: 2.0, material: Some(0), ..Particle::REST });
        let (bodies, materials) = (RigidBodies::boxes([cuboid]), rough(mu));
        let forces = Gravity { acceleration: Vec3::NEG_Y * 9.81 * scale };
        let parts = Scene { start: &start, forces: &forces, colliders: &slope, materials: &materials, ..Scene::EMPTY };
        let scene = Scene { constraints: &bodies, substeps: 20, integrator: method.integrator(), ..parts };
        let mut system = started(&scene, 8, 0);
        run(&mut system, &scene, 1.0 / 60.0, 60);
        let way = gap(pose(&cuboid, system.particles().position).0, f64s(cuboid.center)) / f64::from(scale);
        let right = 0.5 * G * f64::from((sin - mu * cos).max(0.0));
        assert!((way - right).abs() < 2e-3 * right + 1e-5, "{degrees}° at {mu}, {method}: {way} m for {right}");
    }
}

#[test]
fn a_box_dropped_flat_bounces_to_e_squared_of_its_height() {
    for (elasticity, method, substeps, scale) in [
        (0.5f32, Method::Symplectic, 40, 1.0f32),
        (0.5, Method::Rk4, 10, 0.1),
        (0.8, Method::Verlet, 20, 10.0),
        (1.0, Method::Rk4, 15, 1.0),
        (0.0, Method::Rk4, 20, 1.0),
    ] {
        let cuboid = RigidBox::new(Vec3::new(0.05, 0.04, 0.06) * scale, Vec3::new(2.0, 1.04, -1.0) * scale, 0);
        let start = cuboid.solid(Particle { elasticity, material: Some(0), ..Particle::REST });
        let (bodies, materials) = (RigidBodies::boxes([cuboid]), rough(0.5));
        let forces = Gravity { acceleration: Vec3::NEG_Y * 9.81 * scale };
        let parts = Scene { start: &start, forces: &forces, colliders: &GROUND, materials: &materials, ..Scene::EMPTY };
        let scene = Scene { constraints: &bodies, substeps, integrator: method.integrator(), ..parts };
        let mut system = started(&scene, 8, 0);
        let (mut has_hit, mut top) = (false, 0f64);
        for frame in 1..=110 {
            system.step_to(&scene, Time::frame(frame, 120));
            has_hit |= system.totals().hits > 0;
            let height = pose(&cuboid, system.particles().position).0[1] / f64::from(scale) - 0.04;
            // In the time of the fall and up again.
            if has_hit && frame < 54 + (108.0 * elasticity) as u64 / 2 + 2 {
                top = top.max(if system.particles().velocity[0].y >= -0.2 * scale { height } else { 0.0 });
            }
        }
        let right = f64::from(elasticity * elasticity);
        assert!((top - right).abs() < 4e-3, "{elasticity}, {method}, {substeps}, {scale}: {top} for {right}");
    }
}

#[test]
fn two_boxes_exchange_their_momenta() {
    for (elasticity, mass, method) in [
        (1.0f32, 1.0f32, Method::Symplectic),
        (0.5, 3.0, Method::Verlet),
        (0.0, 0.2, Method::Rk4),
        (0.7, 40.0, Method::Rk4),
    ] {
        for far in [0.0, 100.0] {
            let at = Vec3::new(far, -far, 0.5 * far);
            let boxes = [
                RigidBox::new(Vec3::splat(0.05), at, 0),
                RigidBox::new(Vec3::new(0.06, 0.08, 0.07), at + Vec3::X * 0.33, 8),
            ];
            let part = Particle { elasticity, material: Some(0), ..Particle::REST };
            let mut start = boxes[0].solid(Particle { velocity: Vec3::X * 2.0, ..part }).to_vec();
            start.extend(boxes[1].solid(Particle { mass, ..part }));
            let (bodies, materials) = (RigidBodies::boxes(boxes), rough(0.5));
            let scene = Scene { start: &start, constraints: &bodies, materials: &materials, ..Scene::EMPTY };
            let scene = Scene { substeps: 12, integrator: method.integrator(), ..scene };
            let mut system = started(&scene, 16, 0);
            run(&mut system, &scene, 1.0 / 60.0, 40);
            let v = system.particles().velocity;
            let right = [2.0 * (1.0 - elasticity * mass) / (1.0 + mass), 2.0 * (1.0 + elasticity) / (1.0 + mass)];
            let rounding = 2e-5 + 2e-3 * far / 100.0;
            for (v, right) in [(v[0], right[0]), (v[8], right[1])] {
                assert!(
                    (v - Vec3::X * right).length() < rounding,
                    "{elasticity}, {mass}, {method}, {far}: {v} for {right}"
                );
            }
        }
    }
}

/// Boxes that meet anyhow, in space: momenta stay, energy falls.
#[test]
fn a_melee_keeps_its_momenta() {
    let mut random = Random::new(11);
    for elasticity in [0.0, 0.6] {
        let (mut start, mut boxes) = (Vec::new(), Vec::new());
        for i in 0..12u32 {
            let at = Vec3::new((i % 3) as f32, (i / 3 % 2) as f32, (i / 6) as f32) * 0.5 + random.vector(0.1);
            let half = Vec3::new(random.between(0.05, 0.15), random.between(0.05, 0.15), random.between(0.05, 0.15));
            let turn = core::array::from_fn(|_| random.between(-1.0, 1.0));
            let of = RigidBox { turn, ..RigidBox::new(half, at, 8 * i) };
            let velocity = (Vec3::splat(0.25) - at) * 3.0;
            let mass = random.magnitude(0.1, 3.0);
            let whole = Particle { velocity, elasticity, mass, material: Some(0), ..Particle::REST };
            start.extend(thrown(&of, whole, random.direction() * 6.0));
            boxes.push(of);
        }
        let (bodies, materials) = (RigidBodies::boxes(boxes), rough(0.4));
        let scene = Scene { start: &start, constraints: &bodies, materials: &materials, substeps: 20, ..Scene::EMPTY };
        let mut system = started(&scene, start.len(), 0);
        let before = Measures::of(&system, &scene);
        let scale = start.iter().map(|p| f64::from(p.mass * p.velocity.length())).sum::<f64>();
        let (risen, _) = watch(&mut system, &scene, 90);
        let after = Measures::of(&system, &scene);
        assert!(system.totals().contacts > 20 && system.totals().caps.contacts == 0);
        assert!(gap(before.momentum, after.momentum) < 1e-5 * scale, "{elasticity}");
        let turned = gap(before.angular_momentum, after.angular_momentum);
        assert!(turned < 1e-4 * scale, "{elasticity}: {turned} of {scale}");
        assert!(risen < 1e-4 && after.energy.kinetic < 0.9 * before.energy.kinetic, "{elasticity}: {risen}");
    }
}

/// What flies free goes as a cluster that keeps its shape does, whose flight is held against Euler's equations elsewhere.
#[test]
fn a_free_box_turns_as_a_cluster_does() {
    let of = RigidBox::new(Vec3::new(0.3, 0.2, 0.1), Vec3::new(0.0, 1.0, 0.0), 0);
    for (spin, method) in [(Vec3::new(0.05, 4.0, 0.0), Method::Rk4), (Vec3::new(3.0, 1.0, 2.0), Method::Symplectic)] {
        let start = thrown(&of, Particle { velocity: Vec3::X, ..Particle::REST }, spin);
        let (bodies, cluster) = (RigidBodies::boxes([of]), ShapeMatching::rigid([0, 1, 2, 3, 4, 5, 6, 7]));
        let parts =
            Scene { start: &start, forces: &DOWN, substeps: 20, integrator: method.integrator(), ..Scene::EMPTY };
        let scenes = [Scene { constraints: &bodies, ..parts }, Scene { constraints: &cluster, ..parts }];
        let mut systems = scenes.map(|scene| started(&scene, 8, 0));
        let spins = [0, 120].map(|frames| {
            for (system, scene) in systems.iter_mut().zip(&scenes) {
                (1..=frames).for_each(|frame| {
                    system.step_to(scene, Time::frame(frame, 60));
                });
            }
            let Measures { momentum, angular_momentum, .. } = Measures::of(&systems[0], &scenes[0]);
            let orbit = cross(pose(&of, systems[0].particles().position).0, momentum);
            [0, 1, 2].map(|k| angular_momentum[k] - orbit[k])
        });
        assert!(gap(spins[0], spins[1]) < 1e-4 * gap(spins[0], [0.0; 3]), "{method}: {spins:?}");
        for (a, b) in systems[0].particles().position.iter().zip(systems[1].particles().position) {
            assert!((*a - *b).length() < 2e-3, "{method}: {a} for {b}");
        }
    }
}

#[test]
fn a_tower_of_ten_stands() {
    let at = |i: u32| {
        Vec3::new(0.003 * ((i * 7 % 5) as f32 - 2.0), 0.05 + 0.1 * i as f32, 0.002 * ((i * 3 % 5) as f32 - 2.0))
    };
    let boxes: Vec<_> = (0..10).map(|i| RigidBox::new(Vec3::splat(0.05), at(i), 8 * i)).collect();
    let part = Particle { material: Some(0), ..Particle::REST };
    let start: Vec<_> = boxes.iter().flat_map(|of| of.solid(part)).collect();
    let (bodies, materials) = (RigidBodies::boxes(boxes), rough(0.5));
    let parts = Scene { start: &start, forces: &DOWN, colliders: &GROUND, materials: &materials, ..Scene::EMPTY };
    let scene = Scene { constraints: &bodies, substeps: 20, ..parts };
    let mut system = started(&scene, start.len(), 0);
    for frame in 1..=600 {
        system.step_to(&scene, Time::frame(frame, 60));
    }
    for of in &bodies.boxes {
        let (middle, _) = pose(of, system.particles().position);
        assert!(gap(middle, f64s(of.center)) < 5e-4, "{of:?}: {middle:?}");
    }
}

#[test]
fn stacks_come_to_rest_in_sub_steps_of_any_length() {
    let spans = [(60, 1), (144, 1), (240, 1), (480, 1), (1000, 1), (120, 2), (24, 4), (60, 4)];
    for (i, (rate, substeps)) in spans.into_iter().enumerate() {
        let (size, count) = ([1.0f32, 0.1, 4.0][i % 3], [5, 10, 3][i / 2 % 3]);
        let at = |i: u32| size * Vec3::new(0.006 * ((i * 7 % 5) as f32), 0.1 + 0.2 * i as f32, 0.0);
        let boxes: Vec<_> = (0..count).map(|i| RigidBox::new(Vec3::splat(0.1 * size), at(i), 8 * i)).collect();
        let part = Particle { material: Some(0), ..Particle::REST };
        let start: Vec<_> = boxes.iter().flat_map(|of| of.solid(part)).collect();
        let (bodies, materials) = (RigidBodies::boxes(boxes), rough(0.5));
        let parts = Scene { start: &start, forces: &DOWN, colliders: &GROUND, materials: &materials, ..Scene::EMPTY };
        for method in methods(i) {
            let scene = Scene { constraints: &bodies, substeps, integrator: method.integrator(), ..parts };
            let mut system = started(&scene, start.len(), 0);
            let mut fastest = 0.0f32;
            for frame in 1..=u64::from(4 * rate) {
                system.step_to(&scene, Time::frame(frame, rate));
                if frame > u64::from(3 * rate) {
                    fastest = system.particles().velocity.iter().fold(fastest, |most, v| most.max(v.length()));
                }
            }
            assert!(fastest < 1e-3 * size, "{rate} x {substeps}, {count} of {size} by {method}: {fastest}");
            for of in &bodies.boxes {
                let (middle, _) = pose(of, system.particles().position);
                // In one long sub-step a stack gives way by a few hundredths.
                let below = gap(middle, f64s(of.center)) / f64::from(size);
                assert!(below < 0.1, "{rate} x {substeps} by {method}: {of:?} at {middle:?}");
            }
        }
    }
}

/// A uniform rotation: a direction in four dimensions.
fn any_turn(random: &mut Random) -> [f32; 4] {
    loop {
        let turn: [f32; 4] = core::array::from_fn(|_| random.between(-1.0, 1.0));
        if (0.01..1.0).contains(&turn.iter().map(|x| x * x).sum::<f32>()) {
            return turn;
        }
    }
}

/// Half the sides of a die \[m\].
const EVEN: Vec3 = Vec3::splat(0.05);

/// Dice in rows, turned anyhow and thrown with a spin each: of such half sides, and loaded by a share of a side's weight.
fn dice(seed: u64, count: u32, apart: f32, half: Vec3, load: f32) -> (Vec<Particle>, Vec<RigidBox>) {
    let mut random = Random::new(seed);
    let (mut start, mut boxes) = (Vec::new(), Vec::new());
    let row = f64::from(count).sqrt().ceil() as u32;
    for i in 0..count {
        let at = Vec3::new((i % row) as f32 * apart, random.between(0.3, 0.8), (i / row) as f32 * apart);
        let of = RigidBox { turn: any_turn(&mut random), ..RigidBox::new(half, at, 8 * i) };
        let velocity = random.vector(0.6);
        let whole = Particle { velocity, mass: 0.1, elasticity: 0.4, material: Some(0), ..Particle::REST };
        let corners = thrown(&of, whole, random.direction() * random.between(15.0, 30.0));
        let side = |i: usize| if i >> 1 & 1 == 1 { 1.0 + load } else { 1.0 - load };
        start.extend(corners.into_iter().enumerate().map(|(i, p)| Particle { mass: p.mass * side(i), ..p }));
        boxes.push(of);
    }
    (start, boxes)
}

/// How dice have fallen, by the axis that is up and its sign; asserts that they lie on a face.
fn fallen(boxes: &[RigidBox], x: &[Vec3]) -> [u32; 6] {
    let mut counts = [0; 6];
    for of in boxes {
        let (_, axes) = pose(of, x);
        let up = axes.map(|axis| axis[1]);
        let best = (0..3).max_by(|&a, &b| up[a].abs().total_cmp(&up[b].abs())).expect("three axes");
        assert!(up[best].abs() > 0.99, "on an edge: {up:?}");
        counts[2 * best + usize::from(up[best] < 0.0)] += 1;
    }
    counts
}

/// Throws dice that do not meet each other.
fn throw(seed: u64, count: u32, (half, load): (Vec3, f32), substeps: u32) -> [u32; 6] {
    let (start, boxes) = dice(seed, count, 3.0, half, load);
    let (bodies, materials) = (RigidBodies::boxes(boxes), rough(0.5));
    let parts = Scene { start: &start, forces: &DOWN, colliders: &GROUND, materials: &materials, ..Scene::EMPTY };
    let scene = Scene { constraints: &bodies, substeps, ..parts };
    let mut system = started(&scene, start.len(), 0);
    run(&mut system, &scene, 1.0 / 60.0, 200);
    let fastest = system.particles().velocity.iter().map(|v| v.length()).fold(0.0, f32::max);
    assert!(fastest < 1e-3, "{substeps} sub-steps: {fastest} m/s");
    fallen(&bodies.boxes, system.particles().position)
}

#[test]
fn dice_are_fair_and_loaded_or_uneven_ones_are_not() {
    for substeps in [3, 4, 6, 10] {
        let counts = throw(5, 180, (EVEN, 0.0), substeps);
        assert!(chi_squared(&counts, &[1.0 / 6.0; 6]) < FAIR, "{substeps} sub-steps: {counts:?}");
        for unfair in [(EVEN, 0.75), (Vec3::new(0.05, 0.075, 0.05), 0.0)] {
            let counts = throw(6, 120, unfair, substeps);
            assert!(chi_squared(&counts, &[1.0 / 6.0; 6]) > 2.0 * FAIR, "{unfair:?}, {substeps} sub-steps: {counts:?}");
        }
    }
}

#[test]
#[ignore = "long: six thousand throws, in release"]
fn dice_are_fair_in_the_long_run() {
    for substeps in [3, 10] {
        let counts = throw(7, 6000, (EVEN, 0.0), substeps);
        assert!(chi_squared(&counts, &[1.0 / 6.0; 6]) < FAIR, "{substeps} sub-steps: {counts:?}");
        let counts = throw(8, 6000, (Vec3::new(0.05, 0.0525, 0.05), 0.0), substeps);
        assert!(chi_squared(&counts, &[1.0 / 6.0; 6]) > 2.0 * FAIR, "a side 5 % longer: {counts:?}");
    }
}

/// The ground as triangles of unlike shapes, with cells about as wide as this \[m\].
fn tiled(seed: u64, cell: f32) -> MeshBuf {
    const HALF: f32 = 3.0;
    let (mut random, cells) = (Random::new(seed), (2.0 * HALF / cell) as u32);
    let mut at = |i: u32| (i as f32 + random.between(-0.3, 0.3)) * cell - HALF;
    let mut vertices = Vec::new();
    for i in 0..=cells {
        vertices.extend((0..=cells).map(|j| Vec3::new(at(i), 0.0, at(j))));
    }
    let number = |i: u32, j: u32| i * (cells + 1) + j;
    let pair = |(i, j): (u32, u32)| {
        let [a, b, c, d] = [number(i, j), number(i, j + 1), number(i + 1, j + 1), number(i + 1, j)];
        if (i + j).is_multiple_of(2) { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] }
    };
    let triangles = (0..cells).flat_map(|i| (0..cells).map(move |j| (i, j))).flat_map(pair).collect();
    MeshBuf::new(vertices, triangles).expect("the ground is a mesh").indexed(rays::Structure::Bvh)
}

/// Dice that meet in the air and on the ground: all at rest within five seconds, on a face or leaning on others, none in another.
#[test]
fn thrown_dice_come_to_rest() {
    come_to_rest(&GROUND, 0.0);
}

/// The same on triangles that are larger and smaller than they.
#[test]
fn thrown_dice_come_to_rest_on_triangles() {
    for (seed, cell) in [(1, 0.5), (2, 0.13), (3, 0.05)] {
        come_to_rest(&tiled(seed, cell), cell);
    }
}

fn come_to_rest(ground: &dyn Collider, cell: f32) {
    let cases = [
        (1, Method::Rk4, 20),
        (2, Method::Verlet, 10),
        (3, Method::Symplectic, 6),
        (4, Method::Rk4, 4),
        (5, Method::Symplectic, 4),
        (6, Method::Verlet, 3),
        (7, Method::Symplectic, 3),
    ];
    for (seed, method, substeps) in cases {
        let case = format!("{method}, {substeps} sub-steps, cells of {cell} m");
        let (mut start, boxes) = dice(seed, 27, 0.16, EVEN, 0.0);
        let middle = Vec3::new(0.4, 0.5, 0.4);
        for particle in &mut start {
            let inward = middle - particle.position;
            particle.velocity += Vec3::new(inward.x, 0.0, inward.z) * 1.5;
        }
        let (bodies, materials) = (RigidBodies::boxes(boxes), rough(0.4));
        let parts = Scene { start: &start, forces: &DOWN, colliders: ground, materials: &materials, ..Scene::EMPTY };
        let scene = Scene { constraints: &bodies, substeps, integrator: method.integrator(), ..parts };
        let mut system = started(&scene, start.len(), 0);
        let (risen, fastest) = watch(&mut system, &scene, 300);
        assert!(risen < 1e-5, "{case}: energy grew by {risen}");
        assert!(fastest < 1e-3, "{case}: {fastest} m/s");
        // On triangles that are smaller than dice there may be more places than a body has room for.
        let is_full = system.totals().caps.contacts > 0 && cell == 0.0;
        assert!(system.totals().contacts > 100 && !is_full, "{case}: {:?}", system.totals());
        let x = system.particles().position;
        for (i, a) in bodies.boxes.iter().enumerate() {
            for b in &bodies.boxes[..i] {
                let depth = overlap([a, b], x);
                assert!(depth < 0.002, "{case}: {depth} m");
            }
            let (middle, axes) = pose(a, x);
            let low = middle[1] - (0..3).map(|k| 0.05 * axes[k][1].abs()).sum::<f64>();
            assert!(low > -1e-3, "{case}: {low} m in the ground");
        }
    }
}

#[test]
fn what_is_smaller_than_a_box_holds_it_up() {
    let text = |shape: &str| {
        format!(
            r#"{{"run": {{"substeps": 20}}, "forces": [{{"gravity": {{"acceleration": [0, -9.81, 0]}}}}],
            "materials": [{{"contact": {{"friction": {{"static": 0.6, "kinetic": 0.6}}}}}}],
            "scenery": [{{"shape": {shape}, "material": 0}}],
            "boxes": [{{"sides": [1, 0.2, 1], "mass": 3, "position": [0, 0.35, 0], "material": 0}}]}}"#
        )
    };
    for shape in [
        r#"{"box": {"min": [-0.1, -0.3, -0.1], "max": [0.1, 0.2, 0.1]}}"#,
        r#"{"sphere": {"center": [0, 0.1, 0], "radius": 0.1}}"#,
    ] {
        let file = SceneFile::from_json("it", &text(shape)).unwrap_or_else(|error| panic!("{error}"));
        let model = Model::load(&file, "it", &mut ()).unwrap_or_else(|error| panic!("{error}"));
        let mut system = model.system(8, 1).expect("memory");
        run(&mut system, &model.scene(), 1.0 / 60.0, 60);
        let (middle, _) = pose(&model.constraints.1.boxes[0], system.particles().position);
        assert!((middle[1] - 0.3).abs() < 5e-3, "{shape}: {middle:?}");
    }
}

#[test]
fn any_number_of_threads_and_any_index_gives_the_same_bits() {
    let (start, boxes) = dice(9, 20, 0.14, EVEN, 0.0);
    let (bodies, materials) = (RigidBodies::boxes(boxes), rough(0.4));
    let parts = Scene { start: &start, forces: &DOWN, colliders: &GROUND, materials: &materials, ..Scene::EMPTY };
    let mut hashes = Vec::new();
    for structure in Structure::ALL {
        for threads in [1, 2, 8] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
            let scene = Scene { constraints: &bodies, substeps: 8, index: structure, ..parts };
            let mut system = started(&scene, start.len(), 0);
            pool.install(|| run(&mut system, &scene, 1.0 / 60.0, 40));
            assert!(system.totals().contacts > 0 && system.totals().hits > 0);
            hashes.push(system.hash());
        }
    }
    assert!(hashes.iter().all(|hash| *hash == hashes[0]), "{hashes:x?}");
}

/// Whatever boxes there are: nothing panics, and who is sound stays so.
/// Of bodies that share particles the last one has its way, however many are told side by side: its particles keep their distances.
#[test]
fn the_last_of_bodies_that_share_particles_has_its_way() {
    for (offset, count) in [(4, 8), (8, 16), (2, 8), (4, 4), (12, 16)] {
        let at = |first: u32| RigidBox { count, ..RigidBox::new(Vec3::splat(0.1), Vec3::ZERO, first) };
        let boxes = [at(0), at(offset)];
        let mut random = Random::new(u64::from(offset + count));
        let particle = |_| Particle { position: random.vector(0.1), velocity: random.vector(1.0), ..Particle::REST };
        let start: Vec<_> = (0..offset + count).map(particle).collect();
        let bodies = RigidBodies::boxes(boxes);
        let scene = Scene { start: &start, constraints: &bodies, substeps: 4, ..Scene::EMPTY };
        let mut system = started(&scene, start.len(), 0);
        run(&mut system, &scene, 1.0 / 60.0, 30);
        let (x, last) = (system.particles().position, offset as usize..(offset + count) as usize);
        for (i, j) in last.clone().flat_map(|i| (last.start..i).map(move |j| (i, j))) {
            let (now, first) = (x[i].distance(x[j]), start[i].position.distance(start[j].position));
            assert!((now - first).abs() < 1e-5, "{offset}, {count}: {i} and {j} are {now} m apart, not {first} m");
        }
    }
}

#[test]
fn hostile_bodies_do_no_harm() {
    let part = Particle { material: Some(0), ..Particle::REST };
    let sound = RigidBox::new(Vec3::splat(0.1), Vec3::new(0.0, 0.1, 0.0), 0);
    let others = [
        RigidBox::new(Vec3::splat(0.1), Vec3::new(0.0, 0.1, 0.0), 8),
        RigidBox::new(Vec3::new(0.1, 0.0, 0.1), Vec3::new(0.1, 0.3, 0.0), 8),
        RigidBox::new(Vec3::NAN, Vec3::new(0.1, 0.3, 0.0), 8),
        RigidBox::new(Vec3::splat(f32::INFINITY), Vec3::new(0.1, 0.3, 0.0), 8),
        RigidBox { turn: [0.0; 4], ..RigidBox::new(Vec3::splat(0.1), Vec3::splat(0.15), 8) },
        RigidBox { turn: [f32::NAN; 4], ..RigidBox::new(Vec3::splat(0.1), Vec3::splat(0.15), 8) },
        RigidBox { count: 1, ..RigidBox::new(Vec3::splat(0.1), Vec3::splat(0.15), 8) },
        RigidBox { count: 99, ..RigidBox::new(Vec3::splat(1e-20), Vec3::splat(0.15), 8) },
        RigidBox { count: 0, ..RigidBox::new(Vec3::splat(0.1), Vec3::splat(0.15), u32::MAX) },
        RigidBox { first: 0, ..RigidBox::new(Vec3::splat(0.1), Vec3::splat(0.15), 0) },
    ];
    let deaths = Chance { rate: 2.0 };
    for other in others {
        for (velocity, fixed, dies) in [
            (Vec3::ZERO, false, false),
            (Vec3::splat(1e5), false, false),
            (Vec3::splat(1e30), false, true),
            (Vec3::splat(f32::NAN), false, false),
            (Vec3::ZERO, true, true),
        ] {
            let mut start = sound.solid(part).to_vec();
            let shape = RigidBox::new(Vec3::splat(0.1), other.center, 8);
            start.extend(shape.solid(Particle { velocity, fixed, ..part }));
            let (bodies, materials) = (RigidBodies::boxes([sound, other]), rough(0.5));
            let parts =
                Scene { start: &start, forces: &DOWN, colliders: &GROUND, materials: &materials, ..Scene::EMPTY };
            let scene = Scene { constraints: &bodies, substeps: 4, ..parts };
            let scene = if dies { Scene { reapers: &deaths, ..scene } } else { scene };
            let mut system = started(&scene, 16, 1);
            run(&mut system, &scene, 1.0 / 60.0, 60);
            assert!(system.particles().position.iter().all(|x| x.is_finite()), "{other:?} at {velocity}");
        }
    }
}

#[test]
fn files_name_boxes_and_say_what_is_wrong_with_them() {
    let file = |boxes: &str| {
        SceneFile::from_json("it", &format!(r#"{{"boxes": [{boxes}]}}"#))
            .and_then(|scene| scene.check().map(|()| scene))
    };
    let many = r#"{"sides": [0.1, 0.2, 0.3], "mass": 2, "position": [0, 1, 0], "count": [2, 3, 4], "turn": [0, 1.5707964, 0],
        "scatter": {"velocity": 1}, "load": [0, 0.5, 0], "spin": [0, 0, 3]}"#;
    let sound = file(many).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(SceneFile::from_json("again", &sound.to_json()), Ok(sound.clone()));
    let model = Model::load(&sound, "it", &mut ()).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!((model.particles.len(), model.constraints.1.boxes.len()), (192, 24));
    let mass: f32 = model.particles.iter().map(|p| p.mass).sum();
    assert!((mass - 48.0).abs() < 1e-3, "{mass}");
    // A quarter turn about y puts the long side along x.
    let reach = model.particles[..8].iter().map(|p| p.position.x.abs()).fold(0.0, f32::max);
    assert!((reach - 0.15 / 3f32.sqrt()).abs() < 1e-4, "{reach}");
    for (boxes, what) in [
        (r#"{"sides": [0.1, 0, 0.3], "mass": 2, "position": [0, 1, 0]}"#, "boxes[0].sides"),
        (r#"{"sides": [1, 1, 1], "mass": -2, "position": [0, 1, 0]}"#, "boxes[0].mass"),
        (r#"{"sides": [1, 1, 1], "mass": 2, "position": [0, 1, 0], "load": [0, 1, 0]}"#, "boxes[0].load"),
        (r#"{"sides": [1, 1, 1], "mass": 2, "position": [0, 1, 0], "count": [9999, 9999, 1]}"#, "boxes[0].count"),
        (r#"{"sides": [1, 1, 1], "mass": 2, "position": [0, 1, 0], "material": 0}"#, "material"),
        (r#"{"sides": [1, 1, 1], "mass": 2, "position": [0, 1, 0], "scatter": {"turn": -1}}"#, "scatter.turn"),
    ] {
        let error = file(boxes).expect_err(boxes).to_string();
        assert!(error.contains(what), "{boxes}: {error}");
    }
}

/// The same pairs, of more than there is room for, are left out whatever index finds them.
#[test]
fn who_finds_no_room_hangs_on_no_index() {
    let mut random = Random::new(3);
    let mut start = Vec::new();
    let boxes: Vec<_> = (0..60)
        .map(|_| {
            let first = start.len() as u32;
            let middle = random.vector(0.05);
            start.extend((0..8).map(|i| {
                let sign = |bit: u32| if i >> bit & 1 == 1 { 0.05 } else { -0.05 };
                Particle { position: middle + Vec3::new(sign(0), sign(1), sign(2)), mass: 0.1, ..Particle::REST }
            }));
            RigidBox::new(Vec3::splat(0.1), Vec3::ZERO, first)
        })
        .collect();
    let bodies = RigidBodies::boxes(boxes);
    let run = |structure: Structure| {
        let scene = Scene { start: &start, constraints: &bodies, substeps: 4, index: &structure, ..Scene::EMPTY };
        let mut system = started(&scene, start.len(), 0);
        run(&mut system, &scene, 1.0 / 60.0, 4);
        (system.hash(), system.totals().caps.contacts)
    };
    let want = run(Structure::Brute);
    assert!(want.1 > 0);
    for structure in Structure::ALL {
        assert_eq!(run(*structure), want, "{structure}");
    }
}

/// A box that flies free for a minute keeps its energy and its angular momentum, about its middle axis too, where it flips again and again.
#[test]
fn a_box_that_flies_free_for_a_minute_keeps_energy_and_angular_momentum() {
    let half = 0.5 * Vec3::new(0.1, 0.2, 0.3) / 3f32.sqrt();
    for (i, spin) in [Vec3::Y * 6.0, Vec3::new(0.1, 0.05, 5.0), Vec3::new(3.0, -4.0, 2.0)].into_iter().enumerate() {
        for (k, substeps) in [1u32, 4, 20].into_iter().enumerate() {
            // Those of a corner: the axis of the middle moment of inertia is the second.
            let spin = if i == 0 { spin + Vec3::new(0.02, 0.0, 0.01) } else { spin };
            let corner = |i: u32| {
                let sign = |bit: u32| if i >> bit & 1 == 1 { 1.0 } else { -1.0 };
                let position = half * Vec3::new(sign(0), sign(1), sign(2));
                Particle { position, velocity: spin.cross(position), mass: 0.25, ..Particle::REST }
            };
            let start: Vec<_> = (0..8).map(corner).collect();
            let bodies = RigidBodies::boxes([RigidBox::new(Vec3::new(0.1, 0.2, 0.3), Vec3::ZERO, 0)]);
            let method = Method::ALL[(2 * i + k) % Method::ALL.len()];
            let parts = Scene { start: &start, constraints: &bodies, substeps, ..Scene::EMPTY };
            let scene = Scene { integrator: method.integrator(), ..parts };
            let mut system = started(&scene, 8, 0);
            let begun = Measures::of(&system, &scene);
            for frame in 1..=3600 {
                system.step_to(&scene, Time::frame(frame, 60));
                let now = Measures::of(&system, &scene);
                let turned = gap(now.angular_momentum, begun.angular_momentum) / gap(begun.angular_momentum, [0.0; 3]);
                let gained = now.energy.kinetic / begun.energy.kinetic - 1.0;
                let what = format!("{spin}, {method} in {substeps}, frame {frame}");
                assert!(turned < 1e-4 && gained.abs() < 1e-2, "{what}: {turned}, {gained}");
            }
        }
    }
}

/// However few sub-steps there are, nobody falls through the ground, and nothing gets more energy than it has fallen for: in one sub-step the smallest fall by
/// several times their size, and turn by a radian and more.
/// How far the lowest corner of cubes of eight particles is below zero, as a share of their side \[m\].
fn depth(system: &System<Heap>, side: f32) -> f32 {
    let middle = |of: &[Vec3]| of.iter().map(|x| x.y).sum::<f32>() / 8.0;
    let lowest = |of: &[Vec3]| of.iter().map(|x| x.y).fold(f32::INFINITY, f32::min);
    // Particles stand for a solid cube where its corners would stand for a hollow one.
    let corners =
        system.particles().position.chunks(8).map(|of| middle(of) + 3.0f32.sqrt() * (lowest(of) - middle(of)));
    -corners.fold(f32::INFINITY, f32::min) / side
}

#[test]
fn dice_that_come_down_by_half_their_size_in_a_sub_step_stop_at_the_ground() {
    let mut random = Random::new(43);
    let slab = Cuboid { min: Vec3::new(-9.0, -2.0, -9.0), max: Vec3::new(9.0, 0.0, 9.0) };
    let grounds: [&dyn Collider; 2] = [&GROUND, &slab];
    let mut deepest = 0.0f32;
    for round in 0..often(120) {
        let (side, rate, substeps) =
            [(0.016, 60, 4), (0.05, 60, 1), (0.05, 60, 2), (0.1, 24, 4), (0.3, 24, 2), (0.002, 60, 12)][round % 6];
        let method = Method::ALL[round % Method::ALL.len()];
        let (mut start, mut boxes) = (vec![], vec![]);
        let drop = 0.5 * (0.6 * side * (rate * substeps) as f32).powi(2) / G as f32;
        for number in 0..6 {
            let (axis, half) = (random.direction(), random.between(0.0, 1.5));
            let [x, y, z] = (axis * half.sin()).to_array();
            let middle = Vec3::new(3.0 * side * number as f32, side + random.between(0.8, 1.0) * drop, 0.0);
            let of = RigidBox {
                turn: [x, y, z, half.cos()],
                ..RigidBox::new(Vec3::splat(side), middle, start.len() as u32)
            };
            let whole = Particle {
                position: middle,
                velocity: random.vector(1.0),
                mass: 0.01,
                elasticity: random.between(0.0, 0.6),
                ..Particle::REST
            };
            start.extend(thrown(&of, whole, random.vector(10.0)));
            boxes.push(of);
        }
        let (bodies, materials) = (RigidBodies::boxes(boxes), rough(0.4));
        let parts = Scene { start: &start, forces: &DOWN, colliders: grounds[round / 6 % 2], ..Scene::EMPTY };
        let integrator = method.integrator();
        let scene = Scene { constraints: &bodies, materials: &materials, substeps, integrator, ..parts };
        let mut system = started(&scene, start.len(), 0);
        for frame in 1..=3 * u64::from(rate) {
            system.step_to(&scene, Time::frame(frame, rate));
            let depth = depth(&system, side);
            deepest = deepest.max(depth);
            assert!(depth < 0.08, "{round}: {side} m, {rate}/s in {substeps}, {method}, frame {frame}: {depth}");
        }
    }
    assert!(deepest > -0.01, "none of them came down: {deepest}");
}

#[test]
fn the_smallest_of_dice_in_the_longest_steps_stay_above_the_ground() {
    let mut random = Random::new(41);
    let mut failures = vec![];
    for round in 0..often(600) {
        let side = [0.016f32, 0.002, 0.005, 0.05, 0.001][round % 5];
        let (rate, substeps) = [(24, 1), (60, 1), (24, 2), (60, 3), (24, 3)][round / 5 % 5];
        let method = Method::ALL[round % Method::ALL.len()];
        let count = [1, 3, 12][round % 3];
        let drop = random.between(1.0, 4.0) * side;
        let (mut start, mut boxes) = (vec![], vec![]);
        for number in 0..count {
            let (axis, half) = (random.direction(), random.between(0.0, 1.5));
            let [x, y, z] = (axis * half.sin()).to_array();
            let middle = Vec3::new(random.between(-1.0, 1.0) * side, drop + 2.0 * side * number as f32, 0.0);
            let of = RigidBox {
                turn: [x, y, z, half.cos()],
                ..RigidBox::new(Vec3::splat(side), middle, start.len() as u32)
            };
            let whole =
                Particle { position: middle, velocity: random.vector(0.5) * side, mass: 0.01, ..Particle::REST };
            start.extend(thrown(&of, whole, random.vector(5.0)));
            boxes.push(of);
        }
        let slab = Cuboid { min: Vec3::new(-9.0, -2.0, -9.0), max: Vec3::new(9.0, 0.0, 9.0) };
        let grounds: [&dyn Collider; 2] = [&GROUND, &slab];
        let (bodies, materials) = (RigidBodies::boxes(boxes), rough(0.4));
        let parts = Scene { start: &start, forces: &DOWN, colliders: grounds[round % 2], ..Scene::EMPTY };
        let integrator = method.integrator();
        let scene = Scene { constraints: &bodies, materials: &materials, substeps, integrator, ..parts };
        let mut system = started(&scene, start.len(), 0);
        let begun = Measures::of(&system, &scene).energy.total();
        let what = format!("{count} of {side} m, {rate}/s in {substeps}, {method}, {round}");
        for frame in 1..=2 * u64::from(rate) {
            system.step_to(&scene, Time::frame(frame, rate));
            let energy = Measures::of(&system, &scene).energy;
            let middles = system.particles().position.chunks(8).map(|x| x.iter().map(|x| x.y).sum::<f32>() / 8.0);
            let lowest = middles.fold(f32::INFINITY, f32::min);
            // Explicit Euler's method gains as things fall. What falls by several times its size in a sub-step may be thrown by what forces give in some.
            let h = 1.0 / f64::from(rate) / f64::from(substeps);
            let is_bounded = method != Method::Euler && G * h * h < 4.0 * f64::from(side);
            let most = begun + start.len() as f64 * 0.01 / 8.0 * 0.5 * (G * h).powi(2);
            if !((energy.total() <= most || !is_bounded) && lowest > 0.0) {
                failures
                    .push(format!("{what}, frame {frame}: {} of {begun} J, a middle at {lowest} m", energy.total()));
                break;
            }
        }
    }
    assert!(failures.is_empty(), "{} {failures:#?}", failures.len());
}
