//! Hard balls.

use pointmass::shape::Cuboid;
use pointmass::{Gravity, Meetings, Particle, Scene, Time, Vec3};
use pointmass_tests::started;

fn ball(x: f32, vx: f32) -> Particle {
    Particle { position: Vec3::X * x, velocity: Vec3::X * vx, radius: 0.5, elasticity: 1.0, ..Particle::REST }
}

/// Velocities along x after a second of balls on a line.
fn after_a_second(start: &[Particle]) -> Vec<f32> {
    let scene = Scene { start, meetings: Meetings::IMPULSE, ..Scene::EMPTY };
    let mut system = started(&scene, start.len(), 1);
    for frame in 1..=60 {
        system.step(&scene, Time::frame(frame, 60) - system.time());
    }
    assert_eq!(system.totals().caps.bounces, 0);
    system.particles().velocity.iter().map(|v| v.x).collect()
}

#[test]
fn as_many_leave_the_cradle_as_come_in() {
    for coming in 1..=3 {
        let balls: Vec<Particle> =
            (0..5).map(|i| if i < coming { ball(i as f32 - 1.3, 2.0) } else { ball(i as f32, 0.0) }).collect();
        let velocity = after_a_second(&balls);
        for (i, v) in velocity.iter().enumerate() {
            let want = if i >= 5 - coming { 2.0 } else { 0.0 };
            assert!((v - want).abs() < 1e-5, "{coming} coming: {velocity:?}");
        }
    }
}

#[test]
fn each_hit_of_a_dull_cradle_passes_on_its_share() {
    let balls: Vec<Particle> = (0..5)
        .map(|i| Particle { elasticity: 0.9, ..ball(i as f32 * 1.01 - 0.3, if i == 0 { 2.0 } else { 0.0 }) })
        .collect();
    let last = after_a_second(&balls)[4];
    assert!((last / 2.0 - 0.81450625).abs() < 1e-5, "{last}");
}

#[test]
fn a_bullet_does_not_pass_through_a_ball() {
    for speed in [10.0, 1000.0, 1e5] {
        let start = [ball(-5.0, speed), Particle { mass: 3.0, ..ball(0.0, 0.0) }];
        let velocity = after_a_second(&start);
        assert!((velocity[0] + 0.5 * speed).abs() < 1e-5 * speed, "{velocity:?}");
        assert!((velocity[1] - 0.5 * speed).abs() < 1e-5 * speed, "{velocity:?}");
    }
}

#[test]
fn fixed_balls_stay() {
    let start = [ball(-3.0, 9.0), Particle { fixed: true, ..ball(0.0, 0.0) }];
    let velocity = after_a_second(&start);
    assert_eq!(velocity[1], 0.0);
    assert!((velocity[0] + 9.0).abs() < 1e-5);
}

#[test]
fn a_tower_of_balls_stands() {
    let start: Vec<Particle> =
        (0..4).map(|i| Particle { position: Vec3::Y * (0.5 + i as f32), elasticity: 0.3, ..ball(0.0, 0.0) }).collect();
    let floor = Cuboid { min: Vec3::new(-9.0, -1.0, -9.0), max: Vec3::new(9.0, 0.0, 9.0) };
    let forces = Gravity::EARTH;
    let scene =
        Scene { start: &start, forces: &forces, colliders: &floor, meetings: Meetings::IMPULSE, ..Scene::EMPTY };
    let mut system = started(&scene, 4, 1);
    for frame in 1..=600 {
        system.step(&scene, Time::frame(frame, 60) - system.time());
    }
    for (i, position) in system.particles().position.iter().enumerate() {
        assert!((position.y - 0.5 - i as f32).abs() < 2e-3, "{i}: {position} {:?}", system.totals());
    }
}
