//! Loose balls among rigid bodies: they bounce off them, rest on them, push them and hold them up.

use pointmass::constrain::{RigidBodies, RigidBox};
use pointmass::emit::Burst;
use pointmass::force::Friction;
use pointmass::index::Structure;
use pointmass::scene::{Model, SceneFile};
use pointmass::shape::Plane;
use pointmass::{
    Attention, ContactMaterial, Contacts, Emitter, Gravity, Impact, Measures, Method, Observer, Particle, Scene, Time,
    Varied, Vec3,
};
use pointmass_tests::{Random, gap, point, run, started};

const DOWN: Gravity = Gravity { acceleration: Vec3::new(0.0, -9.81, 0.0) };
const GROUND: Plane = Plane { point: Vec3::ZERO, normal: Vec3::Y };

const fn rough(mu: f32) -> [ContactMaterial; 1] {
    [ContactMaterial { elasticity: None, friction: Some(Friction { static_: mu, kinetic: mu }) }]
}

#[test]
fn a_ball_bounces_off_a_box_to_e_squared_of_its_height_and_rests_on_it() {
    for (elasticity, method, scale, substeps) in [
        (0.5f32, Method::Rk4, 1.0f32, 10),
        (0.8, Method::Verlet, 0.01, 20),
        (1.0, Method::Rk4, 100.0, 5),
        (0.0, Method::Symplectic, 1.0, 50),
    ] {
        let at = Vec3::new(3.0, 1.0, -2.0) * scale;
        let of = RigidBox::new(Vec3::new(0.3, 0.1, 0.2) * scale, at, 0);
        let part = Particle { elasticity, material: Some(0), ..Particle::REST };
        let radius = 0.05 * scale;
        let mut start = of.solid(Particle { fixed: true, ..part }).to_vec();
        let height = at.y + 0.1 * scale + radius;
        start.push(Particle { position: at + Vec3::new(0.1, 1.15, 0.05) * scale, radius, mass: 0.3, ..part });
        let (bodies, materials) = (RigidBodies { balls: 1, ..RigidBodies::boxes([of]) }, rough(0.3));
        let forces = Gravity { acceleration: Vec3::NEG_Y * 9.81 * scale };
        let parts = Scene { start: &start, forces: &forces, materials: &materials, ..Scene::EMPTY };
        let scene = Scene { constraints: &bodies, substeps, integrator: method.integrator(), ..parts };
        let mut system = started(&scene, 9, 0);
        let (mut has_hit, mut top) = (false, 0f32);
        for frame in 1..=108 {
            system.step_to(&scene, Time::frame(frame, 120));
            has_hit |= system.totals().contacts > 0;
            let rise = (system.particles().position[8].y - height) / scale;
            if has_hit && frame < 54 + (108.0 * elasticity) as u64 / 2 + 2 {
                top = top.max(if system.particles().velocity[8].y >= -0.2 * scale { rise } else { 0.0 });
            }
        }
        let right = elasticity * elasticity;
        assert!((top - right).abs() < 6e-3, "{elasticity}, {method}, {scale}: {top} for {right}");
        if elasticity <= 0.5 {
            for frame in 109..=600 {
                system.step_to(&scene, Time::frame(frame, 120));
            }
            let (x, v) = (system.particles().position[8], system.particles().velocity[8]);
            assert!(((x.y - height) / scale).abs() < 1e-3 && v.length() < 1e-3 * scale, "{method}: {x}, {v}");
        }
    }
}

/// A ball and a box that fly in space: both momenta stay, in a blow through the middle each has what two bodies have.
#[test]
fn a_ball_and_a_box_exchange_their_momenta() {
    let mut random = Random::new(4);
    for (elasticity, mass, friction, off) in
        [(1.0f32, 1.0f32, 0.0f32, 0.0f32), (0.5, 3.0, 0.5, 0.0), (0.7, 0.2, 0.3, 0.06), (0.0, 5.0, 0.8, 0.04)]
    {
        let at = random.direction() * 2.0;
        let of = RigidBox::new(Vec3::new(0.1, 0.08, 0.12), at, 0);
        let part = Particle { elasticity, material: Some(0), ..Particle::REST };
        let mut start = of.solid(Particle { mass, ..part }).to_vec();
        let place = at + Vec3::new(-0.5, off, -off);
        start.push(Particle { position: place, velocity: Vec3::X * 2.0, radius: 0.04, ..part });
        let (bodies, materials) = (RigidBodies { balls: 3, ..RigidBodies::boxes([of]) }, rough(friction));
        let scene = Scene { start: &start, constraints: &bodies, materials: &materials, substeps: 8, ..Scene::EMPTY };
        let mut system = started(&scene, 9, 0);
        let before = Measures::of(&system, &scene);
        run(&mut system, &scene, 1.0 / 60.0, 40);
        let after = Measures::of(&system, &scene);
        assert!(system.totals().contacts > 0);
        assert!(gap(before.momentum, after.momentum) < 1e-5, "{elasticity}, {off}");
        let turned = gap(before.angular_momentum, after.angular_momentum);
        // Friction acts at the place of the touch, where the ball's own lever is lost: it does not spin.
        assert!(turned < if friction > 0.0 && off > 0.0 { 0.04 * 2.0 } else { 2e-5 }, "{elasticity}, {off}: {turned}");
        assert!(after.energy.kinetic < before.energy.kinetic * (1.0 + 1e-5));
        if off == 0.0 {
            let v = system.particles().velocity;
            let right = [2.0 * (1.0 + elasticity) / (1.0 + mass), 2.0 * (1.0 - elasticity * mass) / (1.0 + mass)];
            for (v, right) in [(v[0], right[0]), (v[8], right[1])] {
                assert!((v - Vec3::X * right).length() < 1e-4, "{elasticity}, {mass}: {v} for {right}");
            }
        }
    }
}

/// A box lies on four balls on the ground, whoever answers the balls' own touch.
#[test]
fn balls_hold_a_box_up() {
    for contacts in [None, Some(Contacts::HARD)] {
        for (radius, mass) in [(0.05f32, 0.1f32), (0.1, 1.0)] {
            let of = RigidBox::new(Vec3::new(0.3, 0.05, 0.3), Vec3::new(0.0, 2.0 * radius + 0.06, 0.0), 0);
            let part = Particle { material: Some(0), ..Particle::REST };
            let mut start = of.solid(Particle { mass: 2.0, ..part }).to_vec();
            for (x, z) in [(-0.2, -0.2), (0.2, -0.2), (-0.2, 0.2), (0.2, 0.2)] {
                start.push(Particle { position: Vec3::new(x, radius, z), radius, mass, ..part });
            }
            let (bodies, materials) = (RigidBodies { balls: 4, ..RigidBodies::boxes([of]) }, rough(0.6));
            let constraints = (&bodies, contacts);
            let parts =
                Scene { start: &start, forces: &DOWN, colliders: &GROUND, materials: &materials, ..Scene::EMPTY };
            let scene = Scene { constraints: &constraints, substeps: 20, ..parts };
            let mut system = started(&scene, 12, 0);
            run(&mut system, &scene, 1.0 / 60.0, 120);
            let x = system.particles().position;
            let middle = x[..8].iter().map(|x| x.y).sum::<f32>() / 8.0;
            assert!((middle - 2.0 * radius - 0.05).abs() < 2e-3, "{contacts:?}, {radius}: {middle}");
            for (ball, was) in x[8..].iter().zip(&start[8..]) {
                assert!((*ball - was.position).length() < 3e-3, "{contacts:?}, {radius}: {ball}");
            }
            assert!(system.particles().velocity.iter().all(|v| v.length() < 2e-3));
        }
    }
}

/// Balls poured into a tub of fixed boxes and onto a loose one: none gets out or in.
#[test]
fn balls_stay_in_a_tub_of_boxes() {
    let wall = |half: Vec3, at: Vec3, i: u32| RigidBox::new(half, at, 8 * i);
    let boxes = [
        wall(Vec3::new(0.5, 0.05, 0.5), Vec3::new(0.0, -0.05, 0.0), 0),
        wall(Vec3::new(0.05, 0.5, 0.5), Vec3::new(0.55, 0.5, 0.0), 1),
        wall(Vec3::new(0.05, 0.5, 0.5), Vec3::new(-0.55, 0.5, 0.0), 2),
        wall(Vec3::new(0.5, 0.5, 0.05), Vec3::new(0.0, 0.5, 0.55), 3),
        wall(Vec3::new(0.5, 0.5, 0.05), Vec3::new(0.0, 0.5, -0.55), 4),
        wall(Vec3::new(0.15, 0.1, 0.15), Vec3::new(0.0, 0.11, 0.0), 5),
    ];
    let part = Particle { elasticity: 0.2, material: Some(0), ..Particle::REST };
    let fixed = boxes[..5].iter().flat_map(|of| of.solid(Particle { fixed: true, ..part }));
    let mut start: Vec<_> = fixed.chain(boxes[5].solid(Particle { mass: 1.0, ..part })).collect();
    let mut random = Random::new(8);
    for i in 0..48 {
        let place = Vec3::new((i % 4) as f32 - 1.5, 2.0 + (i / 16) as f32, (i / 4 % 4) as f32 - 1.5) * 0.2;
        start.push(Particle { position: place + random.vector(0.02), radius: 0.06, mass: 0.2, ..part });
    }
    let materials = rough(0.3);
    let mut hashes = Vec::new();
    for structure in Structure::ALL {
        for threads in [1, 2] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
            let bodies = RigidBodies { balls: 48, ..RigidBodies::boxes(boxes) };
            let constraints = (&bodies, Contacts::HARD);
            let parts = Scene { start: &start, forces: &DOWN, materials: &materials, index: structure, ..Scene::EMPTY };
            let scene =
                Scene { constraints: &constraints, substeps: 10, integrator: Method::Verlet.integrator(), ..parts };
            let mut system = started(&scene, start.len(), 0);
            pool.install(|| run(&mut system, &scene, 1.0 / 60.0, 60));
            assert_eq!(system.totals().caps.contacts, 0);
            for x in &system.particles().position[48..] {
                let inside = x.x.abs() < 0.447 && x.z.abs() < 0.447 && x.y > 0.057;
                assert!(inside, "{x}");
            }
            hashes.push(system.hash());
        }
    }
    assert!(hashes.iter().all(|hash| *hash == hashes[0]), "{hashes:x?}");
}

/// Counts who is told of.
#[derive(Default)]
struct Blows(Vec<Impact>);

impl Observer for Blows {
    fn attention(&self) -> Attention {
        Attention::Events
    }
    fn touched(&mut self, touch: &Impact) {
        self.0.push(*touch);
    }
}

#[test]
fn observers_are_told_of_each_blow_once() {
    let of = RigidBox::new(Vec3::splat(0.1), Vec3::new(0.0, 0.1, 0.0), 0);
    let part = Particle { elasticity: 0.5, ..Particle::REST };
    let mut start = of.solid(Particle { mass: 4.0, ..part }).to_vec();
    start.push(Particle { position: Vec3::new(0.0, 1.25, 0.0), radius: 0.05, ..part });
    let bodies = RigidBodies { balls: 1, ..RigidBodies::boxes([of]) };
    let parts = Scene { start: &start, forces: &DOWN, colliders: &GROUND, ..Scene::EMPTY };
    let scene = Scene { constraints: &bodies, substeps: 10, ..parts };
    let (mut system, mut blows) = (started(&scene, 9, 0), Blows::default());
    // One fall of 1 m takes 0.45 s, the first bounce as long.
    for frame in 1..=40 {
        system.step_observed(&scene, Time::frame(frame, 60) - system.time(), &mut blows);
    }
    let fall = (2.0f32 * 9.81).sqrt();
    let of_ball: Vec<_> = blows.0.iter().filter(|blow| blow.row == 8).collect();
    assert_eq!(of_ball.len(), 1, "{:?}", blows.0);
    let blow = of_ball[0];
    assert!((blow.closing - fall).abs() < 0.1 && blow.other.is_some() && blow.normal.y > 0.999, "{blow:?}");
    assert!((blow.place - Vec3::new(0.0, 0.2, 0.0)).length() < 0.06, "{blow:?}");
    let of_box: Vec<_> = blows.0.iter().filter(|blow| blow.row == 0 && blow.other.is_some()).collect();
    assert_eq!((of_box.len(), of_box[0].mass), (1, 4.0), "{:?}", blows.0);
}

#[test]
fn more_balls_than_there_is_room_for_are_counted() {
    let of = RigidBox::new(Vec3::new(0.5, 0.1, 0.5), Vec3::ZERO, 0);
    let mut start = of.solid(Particle { fixed: true, ..Particle::REST }).to_vec();
    let ball = |i: i32| Particle { position: Vec3::new(0.2 * i as f32, 0.3, 0.0), radius: 0.05, ..Particle::REST };
    start.extend([-1, 0, 1].map(ball));
    for (balls, fallen) in [(0, 3), (2, 1), (3, 0), (99, 0)] {
        let bodies = RigidBodies { balls, ..RigidBodies::boxes([of]) };
        let scene = Scene { start: &start, forces: &DOWN, constraints: &bodies, substeps: 8, ..Scene::EMPTY };
        let mut system = started(&scene, 11, 0);
        run(&mut system, &scene, 1.0 / 60.0, 60);
        let through = system.particles().position[8..].iter().filter(|x| x.y < 0.0).count();
        assert_eq!(through, fallen, "room for {balls}");
        assert_eq!(system.totals().caps.contacts > 0, balls == 2, "{:?}", system.totals());
    }
}

/// A heavy ball lies between a wall and the ground until its life is over; one that is born in its place just before moves as if it had not been
/// there.
#[test]
fn who_takes_the_place_of_a_dead_ball_takes_nothing_of_what_held_that() {
    for (mass, radius, pull, substeps, method) in [
        (50.0, 0.05, 2.0, 8, Method::Symplectic),
        (3.0, 0.1, 0.0, 4, Method::Rk4),
        (500.0, 0.02, 20.0, 20, Method::Verlet),
    ] {
        let wall = RigidBox::new(Vec3::new(0.1, 0.2, 0.5), Vec3::new(-0.1, 0.2, 0.0), 0);
        let place = Vec3::new(radius, radius, 0.0);
        let after = |before: Vec3| {
            let part = Particle { elasticity: 0.0, material: Some(0), ..Particle::REST };
            let mut start = wall.solid(Particle { fixed: true, ..part }).to_vec();
            start.push(Particle { position: before, radius, mass, lifetime: 0.195, ..part });
            let emitter = Emitter {
                burst: Some(Burst { count: 1, at: 0.19, every: 0.0 }),
                radius: Varied::exactly(radius),
                mass: Varied::exactly(0.1),
                elasticity: Varied::exactly(0.0),
                material: Some(0),
                ..Emitter::new(point(place), 0.0)
            };
            let (bodies, materials) = (RigidBodies { balls: 1, ..RigidBodies::boxes([wall]) }, rough(0.5));
            // Toward the wall, and along both: friction holds it, or not.
            let forces = Gravity { acceleration: Vec3::new(-4.0, -9.81, pull) };
            let parts =
                Scene { start: &start, forces: &forces, colliders: &GROUND, materials: &materials, ..Scene::EMPTY };
            let scene =
                Scene { constraints: &bodies, emitters: &emitter, substeps, integrator: method.integrator(), ..parts };
            let mut system = started(&scene, 12, 0);
            let steps = (1..=24).map(|frame| {
                system.step_to(&scene, Time::frame(frame, 60));
                let particles = system.particles();
                (system.len(), particles.position[8..].to_vec(), particles.velocity[8..].to_vec())
            });
            steps.skip(11).collect::<Vec<_>>()
        };
        let (there, elsewhere) = (after(place), after(place + Vec3::X * 10.0));
        assert!(there.iter().all(|(len, ..)| *len == 9), "one has died, one was born");
        assert_eq!(there, elsewhere, "{mass} kg, {radius} m, {method}");
    }
}

/// Whatever flies about, nothing panics, and who is sound stays so.
#[test]
fn hostile_balls_do_no_harm() {
    let of = RigidBox::new(Vec3::splat(0.1), Vec3::new(0.0, 0.1, 0.0), 0);
    for (radius, position, velocity, mass) in [
        (f32::INFINITY, Vec3::Y, Vec3::ZERO, 1.0),
        (1e30, Vec3::Y, Vec3::ZERO, 1.0),
        (1e-30, Vec3::new(0.0, 0.2, 0.0), Vec3::NEG_Y, 1.0),
        (0.1, Vec3::NAN, Vec3::ZERO, 1.0),
        (0.1, Vec3::Y, Vec3::splat(1e30), 1.0),
        (0.1, Vec3::Y, Vec3::splat(f32::NAN), 1.0),
        (0.1, Vec3::new(0.0, 0.1, 0.0), Vec3::ZERO, 1e-30),
        (0.1, Vec3::new(0.0, 0.1, 0.0), Vec3::ZERO, 1e30),
        (f32::NAN, Vec3::new(0.0, 0.1, 0.0), Vec3::ZERO, 1.0),
    ] {
        let mut start = of.solid(Particle::REST).to_vec();
        start.push(Particle { radius, position, velocity, mass, ..Particle::REST });
        let bodies = RigidBodies { balls: 4, ..RigidBodies::boxes([of]) };
        let parts = Scene { start: &start, forces: &DOWN, colliders: &GROUND, ..Scene::EMPTY };
        let scene = Scene { constraints: &bodies, substeps: 4, ..parts };
        let mut system = started(&scene, 9, 0);
        run(&mut system, &scene, 1.0 / 60.0, 30);
        let x = system.particles().position;
        assert!(x.iter().all(|x| x.is_finite()), "{radius}, {position}, {velocity}, {mass}: {x:?}");
    }
}

#[test]
fn files_let_balls_and_boxes_meet() {
    let text = r#"{"run": {"substeps": 10, "capacity": 40}, "forces": [{"gravity": {"acceleration": [0, -9.81, 0]}}],
        "boxes": [{"sides": [1, 0.2, 1], "mass": 3, "position": [0, 0.1, 0], "fixed": true}],
        "particles": [{"position": [0.1, 0.6, 0.2], "radius": 0.1, "elasticity": 0}]}"#;
    let file = SceneFile::from_json("it", text).unwrap_or_else(|error| panic!("{error}"));
    let model = Model::load(&file, "it", &mut ()).unwrap_or_else(|error| panic!("{error}"));
    let mut system = model.system(40, 1).expect("memory");
    run(&mut system, &model.scene(), 1.0 / 60.0, 90);
    let x = system.particles().position[0];
    assert!((x - Vec3::new(0.1, 0.3, 0.2)).length() < 2e-3, "{x}");
}
