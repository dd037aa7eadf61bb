//! Bounds on the work of meetings, which the report tells of.

use pointmass::index::{IndexChoice, Structure};
use pointmass::shape::{Cuboid, Plane};
use pointmass::{Gravity, Meetings, Particle, Scene, Time, Vec3};
use pointmass_tests::{Random, often, started};

#[test]
fn fast_billiards_go_on_if_they_may() {
    // Between walls 0.8 m apart for the middle, at 1000 m/s: 21 bounces in a sixtieth of a second, and 208 in a sixth.
    let walls = (Plane { point: Vec3::X * -0.5, normal: Vec3::X }, Plane { point: Vec3::X * 0.5, normal: Vec3::NEG_X });
    let velocity = Vec3::X * 1000.0;
    let start = [Particle { velocity, radius: 0.1, elasticity: 1.0, ..Particle::REST }];
    for meetings in [Meetings::Through, Meetings::IMPULSE] {
        for (rate, most, stops) in [(60, 8, true), (60, 22, false), (6, 100, true), (6, 210, false)] {
            // By impulse there may be half as many.
            let most = if meetings == Meetings::Through { most } else { 2 * most };
            let scene = Scene { start: &start, colliders: &walls, max_bounces: most, meetings, ..Scene::EMPTY };
            let mut system = started(&scene, 1, 1);
            let mut hits = 0;
            for i in 1..=30 {
                hits += system.step(&scene, Time::frame(i, rate) - system.time()).hits;
            }
            assert_eq!(system.totals().caps.bounces > 0, stops, "{rate}/s, {most}");
            let expected = 1000.0 * system.time().seconds() / 0.8;
            assert!(stops || (hits as f32 / expected - 1.0).abs() < 0.01, "{hits}, not {expected}");
            assert_eq!(system.particles().velocity[0].abs(), velocity);
        }
    }
}

/// Balls that all overlap each other and fly about: the hash and what was counted.
fn crowd(count: usize, index: &dyn IndexChoice) -> (u64, pointmass::Report) {
    let mut random = Random::new(71);
    let start: Vec<Particle> = (0..count)
        .map(|_| Particle {
            position: random.vector(0.3),
            velocity: random.vector(1.0),
            radius: 1.0,
            elasticity: 0.9,
            ..Particle::REST
        })
        .collect();
    let room = Cuboid { min: Vec3::splat(-3.0), max: Vec3::splat(3.0) };
    let scene = Scene { start: &start, colliders: &room, meetings: Meetings::IMPULSE, index, ..Scene::EMPTY };
    let mut system = started(&scene, count, 1);
    let report = system.step(&scene, Time::frame(1, 60));
    assert!(system.particles().position.iter().all(|x| x.is_finite()));
    (system.hash(), report)
}

#[test]
fn a_crowd_of_balls_in_one_place_is_looked_through_so_often_and_counted() {
    // Each finds all others each time; some dozen times are the most it may.
    let count = often(6000);
    let (hash, report) = crowd(count, &());
    assert!(report.caps.bounces > count as u64 / 2, "{report:?}");
    assert!(report.contacts < 33 * count as u64, "{report:?}");
    for index in [Structure::Grid, Structure::Bvh] {
        assert_eq!(crowd(count, &index).0, hash, "{index}");
    }
}

#[test]
fn points_have_nobody_to_meet() {
    // Without radii nothing is looked for, kept or changed.
    let mut random = Random::new(72);
    let start: Vec<Particle> = (0..200)
        .map(|_| Particle { position: random.vector(0.8), velocity: random.vector(3.0), ..Particle::REST })
        .collect();
    let room = Cuboid { min: Vec3::NEG_ONE, max: Vec3::ONE };
    let [with, without] = [Meetings::IMPULSE, Meetings::Through].map(|meetings| {
        let scene = Scene { start: &start, forces: &Gravity::EARTH, colliders: &room, meetings, ..Scene::EMPTY };
        let mut system = started(&scene, start.len(), 1);
        (1..=120).for_each(|i| {
            system.step(&scene, Time::frame(i, 60) - system.time());
        });
        (system.hash(), *system.totals())
    });
    assert!(with.1.hits > 300);
    assert_eq!(with, without);
}
