//! Balls by impulse in funnels: two that touch push each other into its sides, which push back in the same instant, and go on.

use pointmass::force::Friction;
use pointmass::shape::Plane;
use pointmass::{ContactMaterial, Gravity, Meetings, Method, Particle, Scene, Time, Vec3};
use pointmass_tests::{Random, often, started};

const G: f32 = 9.8;
const RADIUS: f32 = 0.12;

/// Funnels of so many flat sides around `home`, as steep as that \[rad\].
fn sides(count: u16, slope: f32, home: Vec3) -> Vec<Plane> {
    let about = |i: u16| f32::from(i) / f32::from(count) * core::f32::consts::TAU;
    let normal = |a: f32| Vec3::new(-slope.sin() * a.cos(), slope.cos(), -slope.sin() * a.sin());
    (0..count).map(|i| Plane { point: home, normal: normal(about(i)) }).collect()
}

/// The steps in which somebody who tells of a speed stays where he is, and how far the energy rises above the least before, a share of that at the beginning.
fn stuck(scene: &Scene<'_>, h: f64, floor: f32) -> (u32, f32) {
    let mut system = started(scene, scene.start.len(), 1);
    let (mut before, mut stuck) = (vec![], 0);
    let (mut opening, mut least, mut risen) = (0.0, f32::INFINITY, 0.0f32);
    for i in 0..=(6.0 / h).round() as u32 {
        system.step(scene, Time::from_seconds_f64(h * f64::from(i)) - system.time());
        let all = system.particles();
        let now: Vec<_> = all.position.iter().zip(all.velocity).map(|(&x, v)| (x, v.length())).collect();
        let is_stuck = |((from, came), (to, goes)): &(&(Vec3, f32), &(Vec3, f32))| {
            let speed = came.min(*goes);
            speed > 0.1 && from.distance(*to) < 0.05 * speed * h as f32
        };
        stuck += before.iter().zip(&now).filter(is_stuck).count() as u32;
        let energy = now.iter().map(|(x, speed)| 0.5 * speed * speed + G * (x.y - floor)).sum::<f32>();
        opening = if i == 0 { energy } else { opening };
        least = least.min(energy);
        risen = risen.max(energy - least);
        before = now;
    }
    (stuck, risen / opening)
}

#[test]
fn balls_that_push_each_other_into_walls_go_on() {
    let mut random = Random::new(5);
    let (mut stuck_steps, mut cases) = (0, 0);
    for case in 0..often(120) {
        let mut any = |count: usize| random.word() as usize % count;
        let (count, slope) = ([3, 4, 8][any(3)], [0.3, 0.6][any(2)]);
        let (elasticity, mu) = ([0.0, 0.0, 0.3][any(3)], [0.0, 0.0, 0.2][any(3)]);
        let (rate, balls) = ([24.0, 60.0, 144.0][any(3)], [2, 2, 3][any(3)]);
        let method = Method::ALL[any(Method::ALL.len())];
        // Explicit Euler gains in flight.
        if method == Method::Euler {
            continue;
        }
        let home = Vec3::ONE * [0.0, 0.0, 20.0][any(3)];
        let ball = |i: u16| {
            let position = home + random.vector(0.3).with_y(1.2 + 0.3 * f32::from(i));
            let velocity = random.vector(1.0);
            Particle { position, velocity, radius: RADIUS, elasticity, material: Some(0), ..Particle::REST }
        };
        let start: Vec<_> = (0..balls).map(ball).collect();
        let walls = sides(count, slope, home);
        let friction = Some(Friction { static_: mu, kinetic: mu });
        let scene = Scene {
            start: &start,
            forces: &Gravity { acceleration: Vec3::NEG_Y * G },
            colliders: &walls.as_slice(),
            integrator: &method,
            meetings: Meetings::IMPULSE,
            materials: &[ContactMaterial { elasticity: None, friction }],
            ..Scene::EMPTY
        };
        let (stuck, risen) = stuck(&scene, 1.0 / rate, home.y);
        let name =
            format!("{case}: {balls} balls, {count} sides, {slope}, {elasticity}, {mu}, {method}, {rate}, {home}");
        assert!(stuck < 12, "{name}: stuck for {stuck} steps");
        // What is set apart along slopes is raised for nothing.
        assert!(risen < 0.03, "{name}: {risen}");
        (stuck_steps, cases) = (stuck_steps + stuck, cases + 1);
    }
    assert!(stuck_steps <= cases, "{stuck_steps} steps in {cases} cases");
}
