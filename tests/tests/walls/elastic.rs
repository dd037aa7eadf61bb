//! Elastic bounces keep their energy for minutes, whatever they bounce off.

use pointmass::shape::{Collider, Cuboid, Plane, Sphere, Triangle};
use pointmass::{Gravity, Method, Particle, Scene, Vec3};
use pointmass_tests::{G, Random, every, f64s, run, started};

/// Methods that conserve energy in free fall.
const CONSERVING: [Method; 3] = [Method::Midpoint, Method::Verlet, Method::Rk4];

/// Heights of fall \[m\].
const HEIGHTS: [f32; 9] = [0.01, 0.023, 0.1, 0.37, 1.0, 2.9, 10.0, 31.0, 100.0];

/// Kinetic energy and that of the height above a level, for each kilogram \[J\].
fn energy(x: Vec3, v: Vec3, gravity: f64, level: f64) -> f64 {
    0.5 * f64s(v).iter().map(|v| v * v).sum::<f64>() + gravity * (f64::from(x.y) - level)
}

/// Checks that what flies above a level keeps its energy for five minutes: to 1e-4 of it in 60 steps a second, to 1e-3 in
/// seven. Each bounce may round the speed by a unit in its last place, which counts where it bounces thousands of times.
fn check(name: &str, collider: &dyn Collider, start: &[Particle], gravity: f64, level: f64) {
    let forces = Gravity { acceleration: Vec3::NEG_Y * gravity as f32 };
    let height = |particle: &Particle| level + f64::from(particle.radius);
    let before: Vec<f64> =
        start.iter().map(|begun| energy(begun.position, begun.velocity, gravity, height(begun))).collect();
    for (i, (rate, share)) in [(60.0, 1e-4), (7.0, 1e-3)].into_iter().enumerate() {
        for method in CONSERVING.into_iter().skip(i % every(2)).step_by(every(2)) {
            let integrator = method.integrator();
            let scene = Scene { start, forces: &forces, colliders: collider, integrator, ..Scene::EMPTY };
            let mut system = started(&scene, start.len(), 1);
            run(&mut system, &scene, 1.0 / rate, (300.0 * rate) as u32);
            let p = system.particles();
            for (row, begun) in start.iter().enumerate() {
                let after = energy(p.position[row], p.velocity[row], gravity, height(begun));
                let drift = after / before[row] - 1.0;
                // Up and down again from half a metre takes 0.6 s.
                let bounces = 300.0 * gravity / (8.0 * before[row]).sqrt();
                let rounding = if bounces > 500.0 { 2.4e-7 * bounces } else { 0.0 };
                assert!(
                    drift.abs() < share + rounding,
                    "{name}, {method}, {rate} steps/s: {drift} of {} from {begun:?}",
                    before[row]
                );
            }
            assert_eq!(system.totals().caps.bounces, 0);
        }
    }
}

fn falling(height: f32, radius: f32, aside: f32) -> Particle {
    let position = Vec3::new(aside, height + radius, -0.25);
    Particle { position, radius, elasticity: 1.0, ..Particle::REST }
}

#[test]
fn on_level_ground() {
    let plane = Plane { point: Vec3::ZERO, normal: Vec3::Y };
    let slab = Cuboid { min: Vec3::new(-2000.0, -1.0, -2000.0), max: Vec3::new(2000.0, 0.0, 2000.0) };
    let corner = Vec3::new(-4.0, 0.0, -4.0);
    let triangle = Triangle { corners: [corner, corner + Vec3::Z * 16.0, corner + Vec3::X * 16.0] };
    let fall = |places: &[(f32, f32)], heights: &[f32]| -> Vec<Particle> {
        let from = |&height: &f32| places.iter().map(move |&(radius, aside)| falling(height, radius, aside));
        heights.iter().flat_map(from).collect()
    };
    let near = fall(&[(0.0, 0.5), (0.1, 0.5)], &HEIGHTS);
    // At 1000 m the rounding of places counts for less from 0.1 m on.
    let far = fall(&[(0.0, 1000.0), (0.3, 1000.0)], &HEIGHTS[2..]);
    for gravity in [G, 1.62, 24.8] {
        check("plane", &plane, &near, gravity, 0.0);
    }
    check("plane far away", &plane, &far, G, 0.0);
    check("box", &slab, &far, G, 0.0);
    check("triangle", &triangle, &near, G, 0.0);
}

#[test]
fn in_valleys_rooms_and_bowls() {
    // A valley of two slopes of 20 and 35 degrees, which meet at the origin.
    let slope = |degrees: f32| {
        let (sin, cos) = degrees.to_radians().sin_cos();
        Plane { point: Vec3::ZERO, normal: Vec3::new(sin, cos, 0.0) }
    };
    let valley = (slope(20.0), slope(-35.0));
    let room = Cuboid { min: Vec3::new(-3.0, 0.0, -2.0), max: Vec3::new(3.0, 4.0, 2.0) };
    let bowl = Sphere { center: Vec3::Y * 3.0, radius: 3.0 };
    let mut random = Random::new(43);
    let thrown: Vec<Particle> = (0..12)
        .map(|i| Particle {
            position: Vec3::Y * 2.5 + random.vector(0.4),
            velocity: random.vector(4.0),
            radius: if i % 2 == 0 { 0.0 } else { random.between(0.05, 0.4) },
            elasticity: 1.0,
            ..Particle::REST
        })
        .collect();
    let hollows: [(&str, &dyn Collider); 3] = [("valley", &valley), ("room", &room), ("bowl", &bowl)];
    for (name, hollow) in hollows {
        check(name, hollow, &thrown, G, 0.0);
    }
}
