//! Numbers that are none, spans of no length and of hours, and colliders that cannot make up their mind.

use core::sync::atomic::{AtomicU32, Ordering};
use pointmass::index::{IndexChoice, Structure};
use pointmass::scene::Position;
use pointmass::shape::{Collider, Cuboid, Hit, Plane, Segment};
use pointmass::{Force, Gravity, Particle, Penalty, Response, Scene, Time, Vec3};
use pointmass_tests::{Random, run, started};

fn responses() -> [Response; 3] {
    let penalty = Penalty { stiffness: 1e4, damping: 0.2, reach: 0.4, ..Penalty::NONE };
    [Response::Impulse {}, Response::Force(penalty), Response::Position(Position::default())]
}

/// Balls in a room that they nearly fill.
fn healthy() -> Vec<Particle> {
    let mut random = Random::new(81);
    (0..27)
        .map(|i| Particle {
            position: Vec3::new((i % 3) as f32, (i / 3 % 3) as f32, (i / 9) as f32) * 0.45 + 0.25,
            velocity: random.vector(1.0),
            radius: 0.2,
            elasticity: 0.3,
            ..Particle::REST
        })
        .collect()
}

/// The scene with a response.
fn with_scene<T>(
    response: &Response,
    start: &[Particle],
    index: &dyn IndexChoice,
    then: impl FnOnce(&Scene<'_>) -> T,
) -> T {
    let room = Cuboid { min: Vec3::ZERO, max: Vec3::splat(1.4) };
    let push = if let Response::Force(penalty) = response { *penalty } else { Penalty::NONE };
    let forces: &dyn Force = &(Gravity::EARTH, push);
    then(&Scene {
        start,
        forces,
        colliders: &room,
        constraints: &response.contacts(),
        substeps: response.substeps(),
        meetings: response.meetings(),
        index,
        ..Scene::EMPTY
    })
}

#[test]
fn one_that_is_no_number_harms_nobody() {
    let nan = f32::NAN;
    let inf = f32::INFINITY;
    let inside = Particle { position: Vec3::new(0.47, 0.48, 0.49), radius: 0.2, ..Particle::REST };
    let outside = Particle { position: Vec3::X * 100.0, ..inside };
    let dying = [
        Particle { position: Vec3::new(nan, 0.5, 0.5), ..inside },
        Particle { position: Vec3::new(0.5, -inf, 0.5), ..inside },
        Particle { velocity: Vec3::new(0.0, 0.0, nan), ..inside },
        Particle { velocity: Vec3::new(inf, 0.0, 0.0), ..inside },
        Particle { mass: nan, ..inside },
        Particle { mass: 0.0, ..inside },
        Particle { mass: 1e-42, ..inside },
    ];
    let ghosts = [
        Particle { radius: nan, ..inside },
        Particle { radius: inf, ..outside },
        Particle { velocity: Vec3::X * 1e30, ..outside },
        Particle { position: Vec3::X * 1e30, ..inside },
        Particle { position: Vec3::X * 3e38, velocity: Vec3::X * 3e38, ..inside },
        Particle { elasticity: nan, ..outside },
        Particle { mass: inf, ..outside },
    ];
    let healthy = healthy();
    for response in &responses() {
        for index in [&() as &dyn IndexChoice, &Structure::Grid, &Structure::Bvh] {
            let after = |start: &[Particle]| {
                with_scene(response, start, index, |scene| {
                    let mut system = started(scene, start.len(), 1);
                    run(&mut system, scene, 1.0 / 240.0, 20);
                    (system.particles().position[..27].to_vec(), *system.totals())
                })
            };
            let (want, _) = after(&healthy);
            for (i, ill) in dying.iter().chain(&ghosts).enumerate() {
                let mut start = healthy.clone();
                start.push(*ill);
                let (got, report) = after(&start);
                if i < dying.len() {
                    assert_eq!(report.died.nonfinite, 1, "{} {ill:?}", response.name());
                }
                let far = got.iter().zip(&want).map(|(a, b)| a.distance(*b)).fold(0.0, f32::max);
                // Hard balls go on to the bit; sums in another order do not.
                let bound = match response {
                    Response::Impulse {} => 0.0,
                    // For its one step it is a ball like any other, and pushes.
                    Response::Force(_) if ill.mass != 1.0 => 0.5,
                    // One so fast has all held against each other on their ways, not only at the ends of sub-steps.
                    Response::Position(_) if ill.velocity.x >= 1e30 => 0.2,
                    _ => 2e-3,
                };
                assert!(far <= bound, "{} {ill:?}: {far}", response.name());
            }
        }
    }
}

#[test]
fn any_span_can_be_a_step() {
    let start = healthy();
    for response in &responses() {
        for index in [&() as &dyn IndexChoice, &Structure::Hash] {
            with_scene(response, &start, index, |scene| {
                let mut system = started(scene, 27, 1);
                let spans = [0, 1, 7, 1 << 31, (1 << 31) + 1, 3600 << 32, 5, 100_000 << 32, u64::MAX / 2, u64::MAX];
                for ticks in spans {
                    let before = system.particles().position.to_vec();
                    system.step(scene, Time::from_ticks(ticks));
                    if ticks == 0 {
                        assert_eq!(system.particles().position, before);
                    }
                }
                assert!(system.particles().position.iter().all(|x| x.is_finite()));
            });
        }
    }
}

/// Answers every other time.
struct Fickle(AtomicU32);

impl Collider for Fickle {
    fn first_hit(&self, segment: &Segment) -> Option<Hit> {
        let odd = self.0.fetch_add(1, Ordering::Relaxed).is_multiple_of(2);
        if odd { Plane { point: Vec3::ZERO, normal: Vec3::Y }.first_hit(segment) } else { None }
    }
}

#[test]
fn a_collider_that_contradicts_itself_ends_too() {
    let start = [1, 2, 3].map(|i| Particle {
        position: Vec3::new(i as f32, 0.5, 0.0),
        velocity: Vec3::NEG_Y * 9.0,
        radius: 0.1,
        ..Particle::REST
    });
    for response in &responses() {
        let fickle = Fickle(AtomicU32::new(0));
        let scene = Scene {
            start: &start,
            colliders: &fickle,
            constraints: &response.contacts(),
            substeps: response.substeps(),
            meetings: response.meetings(),
            ..Scene::EMPTY
        };
        let mut system = started(&scene, 3, 1);
        run(&mut system, &scene, 0.1, 20);
        assert_eq!(system.len(), 3);
    }
}

/// A floor that says nothing but where paths meet it.
struct Floor;

impl Collider for Floor {
    fn first_hit(&self, segment: &Segment) -> Option<Hit> {
        Plane { point: Vec3::ZERO, normal: Vec3::Y }.first_hit(segment)
    }
}

#[test]
fn balls_stay_above_an_outsider_s_floor() {
    let start: Vec<Particle> =
        healthy().into_iter().map(|ball| Particle { velocity: ball.velocity * 3.0, ..ball }).collect();
    for response in &responses() {
        let push = if let Response::Force(penalty) = response { *penalty } else { Penalty::NONE };
        let forces = (Gravity::EARTH, push);
        let scene = Scene {
            start: &start,
            forces: &forces,
            colliders: &Floor,
            constraints: &response.contacts(),
            substeps: response.substeps(),
            meetings: response.meetings(),
            ..Scene::EMPTY
        };
        let mut system = started(&scene, 27, 1);
        run(&mut system, &scene, 1.0 / 240.0, 240);
        // The sweep keeps only half of a ball that contacts have moved from passing.
        let lowest = system.particles().position.iter().map(|x| x.y).fold(f32::INFINITY, f32::min);
        let bound = if let Response::Position(_) = response { 0.099 } else { 0.199 };
        assert!(lowest > bound, "{}: {lowest}", response.name());
    }
}

/// Those that touch in the very step in which another is no longer a number.
#[test]
fn one_that_is_no_number_harms_nobody_who_is_in_touch() {
    let ball = |y: f32| Particle { position: Vec3::new(0.7, y, 0.7), radius: 0.2, ..Particle::REST };
    for velocity in [Vec3::NAN, Vec3::X * f32::INFINITY] {
        let start = [ball(0.2), ball(0.599), Particle { velocity, ..ball(1.19) }];
        for response in responses() {
            with_scene(&response, &start, &(), |scene| {
                let mut system = started(scene, 3, 1);
                run(&mut system, scene, 1.0 / 60.0, 10);
                assert_eq!((system.len(), system.totals().died.nonfinite), (2, 1), "{response:?}");
                assert!(system.particles().position.iter().all(|x| (x.y - 0.4).abs() < 0.21), "{response:?}");
            });
        }
    }
}
