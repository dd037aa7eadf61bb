//! Balls held by position on balls: a contact holds by all the weight above it, what can rest stands still, and no index
//! makes a difference.

use pointmass::force::{Friction, Spring};
use pointmass::index::Structure;
use pointmass::shape::{Affine, Collider, Cuboid, Placed, Plane};
use pointmass::{ContactMaterial, Contacts, Gravity, Method, Particle, Scene, Vec3};
use pointmass_tests::{G, Random, methods, run, started};

/// Steps a second, sub-steps of each.
const STEPS: [(u32, u32); 4] = [(24, 6), (60, 4), (60, 12), (240, 20)];

fn rubbing(friction: f32) -> ContactMaterial {
    ContactMaterial { elasticity: None, friction: Some(Friction { static_: friction, kinetic: friction }) }
}

fn ball(position: Vec3, radius: f32) -> Particle {
    Particle { position, radius, elasticity: 0.0, material: Some(0), ..Particle::REST }
}

/// Balls on each other that slide together over a floor.
struct Stack<'a> {
    masses: &'a [f32],
    speed: f32,
    /// With the floor. The balls hold on to each other by 1.
    friction: f32,
}

impl Stack<'_> {
    /// How far each gets, as a share of v²/2μg.
    fn ways(&self, method: Method, (rate, substeps): (u32, u32)) -> Vec<f64> {
        const RADIUS: f32 = 0.1;
        let materials = [rubbing(1.0), rubbing(self.friction * self.friction)];
        let floor = Plane { point: Vec3::ZERO, normal: Vec3::Y };
        let floor = Placed::new(floor, Affine::IDENTITY).expect("a map that leaves all as it is").made_of(Some(1));
        let place = |i: usize| Vec3::Y * (RADIUS * (1.0 + 2.0 * i as f32));
        let balls = self.masses.iter().enumerate();
        let start: Vec<_> = balls
            .map(|(i, &mass)| Particle { mass, velocity: Vec3::X * self.speed, ..ball(place(i), RADIUS) })
            .collect();
        let scene = Scene {
            start: &start,
            materials: &materials,
            forces: &Gravity { acceleration: Vec3::NEG_Y * G as f32 },
            colliders: &floor,
            substeps,
            constraints: &Contacts::HARD,
            integrator: &method,
            ..Scene::EMPTY
        };
        let mut system = started(&scene, start.len(), 1);
        run(&mut system, &scene, 1.0 / f64::from(rate), 2 * rate);
        let want = f64::from(self.speed).powi(2) / (2.0 * f64::from(self.friction) * G);
        system.particles().position.iter().map(|x| f64::from(x.x) / want).collect()
    }
}

#[test]
fn a_stack_slides_as_far_as_one_ball() {
    let mut round = 0;
    for (masses, bound) in
        [(&[1.0, 1.0][..], 0.02), (&[4.0, 1.0], 0.02), (&[1.0, 4.0], 0.03), (&[1.0, 1.0, 1.0], 0.1), (&[1.0; 6], 0.7)]
    {
        for (speed, friction) in [(3.0, 0.3), (2.0, 0.5)] {
            for steps in STEPS {
                round += 1;
                for method in methods(round) {
                    // A stack that follows sub-steps only slowly, being heavy or high, gets there with more of them.
                    let bound = if steps.1 >= 12 { 0.2 * bound } else { bound };
                    for way in (Stack { masses, speed, friction }).ways(method, steps) {
                        assert!((way - 1.0).abs() < bound, "{masses:?}, {friction}, {method}, {steps:?}: {way}");
                    }
                }
            }
        }
    }
}

#[test]
fn a_pyramid_settles_and_then_stands_still() {
    let mut round = 0;
    for (friction, radius, origin) in [(0.3, 0.1, Vec3::ZERO), (0.8, 2.0, Vec3::new(5.0, 0.0, -3.0))] {
        let materials = [rubbing(friction)];
        let floor = Plane { point: Vec3::ZERO, normal: Vec3::Y };
        let corners = [(-1.0, -1.0), (1.0, -1.0), (-1.0, 1.0), (1.0, 1.0)].map(|(x, z)| Vec3::new(x, 1.0, z));
        let places = corners.into_iter().chain([Vec3::Y * (1.0 + 2f32.sqrt())]);
        let start: Vec<_> = places.map(|place| ball(origin + place * radius, radius)).collect();
        for (rate, substeps) in [(24, 1), (60, 2), (60, 12), (240, 20)] {
            round += 1;
            for method in methods(round) {
                let scene = Scene {
                    start: &start,
                    materials: &materials,
                    forces: &Gravity::EARTH,
                    colliders: &floor,
                    substeps,
                    constraints: &Contacts::HARD,
                    integrator: &method,
                    ..Scene::EMPTY
                };
                let mut system = started(&scene, start.len(), 1);
                let case = format!("{method}, {rate} steps of {substeps}, friction {friction}, radius {radius}");
                run(&mut system, &scene, 1.0 / f64::from(rate), 10 * rate);
                let settled = system.particles().position.to_vec();
                let moved = settled.iter().zip(&start).map(|(x, ball)| x.distance(ball.position)).fold(0.0, f32::max);
                // It gives way by more the farther all fall in a sub-step.
                let bound = 0.6 / substeps as f32;
                assert!(moved < bound * radius, "{case}: {moved}");
                run(&mut system, &scene, 1.0 / f64::from(rate), 6 * rate);
                assert_eq!(system.particles().position, settled, "{case}");
            }
        }
    }
}

#[test]
fn a_heap_falls_to_the_same_bits_whatever_the_index() {
    let mut random = Random::new(7);
    let start: Vec<_> = (0..200)
        .map(|i| {
            let cell = Vec3::new((i % 6) as f32, (i / 36) as f32, (i / 6 % 6) as f32) + 0.5;
            let radius = random.between(0.03, 0.05);
            let velocity = random.vector(1.0);
            Particle { velocity, elasticity: 0.3, ..ball(cell * 0.11 + random.vector(0.004), radius) }
        })
        .collect();
    let (materials, room) = ([rubbing(0.4)], Cuboid { min: Vec3::ZERO, max: Vec3::new(0.7, 9.0, 0.7) });
    let hash = |structure: Structure| {
        let scene = Scene {
            start: &start,
            materials: &materials,
            forces: &Gravity::EARTH,
            colliders: &room as &dyn Collider,
            substeps: 8,
            constraints: &Contacts::HARD,
            index: &structure,
            ..Scene::EMPTY
        };
        let mut system = started(&scene, start.len(), 1);
        run(&mut system, &scene, 1.0 / 60.0, 90);
        assert!(system.totals().contacts > 10_000 && system.totals().caps.contacts == 0, "{:?}", system.totals());
        system.hash()
    };
    let want = hash(Structure::Brute);
    for structure in Structure::ALL {
        assert_eq!(hash(*structure), want, "{structure}");
    }
}

/// The nearest of more contacts than there is room for count, and which these are hangs on no index.
#[test]
fn who_finds_no_room_is_the_same_whatever_the_index() {
    let mut random = Random::new(29);
    let mut crowd = |count: usize, wide: f32| -> Vec<Particle> {
        let one = |_| Particle { elasticity: 0.2, ..ball(random.vector(wide), random.between(0.03, 0.05)) };
        (0..count).map(one).collect()
    };
    for start in [crowd(200, 0.06), crowd(60, 0.02), crowd(400, 0.1)] {
        let run = |structure: Structure| {
            let (constraints, index) = (&Contacts::HARD, &structure);
            let scene = Scene { start: &start, substeps: 4, constraints, index, ..Scene::EMPTY };
            let mut system = started(&scene, start.len(), 1);
            run(&mut system, &scene, 1.0 / 60.0, 8);
            (system.hash(), system.totals().caps.contacts)
        };
        let want = run(Structure::Brute);
        assert!(want.1 > 0, "{} balls find room", start.len());
        for structure in Structure::ALL {
            assert_eq!(run(*structure), want, "{structure}");
        }
    }
}

/// Balls that lie on each other are borne by those below, whatever somebody does who touches nobody.
#[test]
fn a_stack_stands_whatever_goes_on_elsewhere() {
    let mut round = 0;
    for mass in [0.001f32, 4.0, 100.0] {
        for (rate, substeps) in STEPS {
            // Those that choose their steps do so by whoever is farthest off.
            let steady = Method::ALL.iter().filter(|method| !method.chooses_steps());
            let method = *steady.cycle().nth(round).expect("there is always a next one");
            round += 1;
            let run = |masses: &[f32]| {
                let mut start: Vec<_> = (0..6).map(|i| ball(Vec3::Y * (0.1 + 0.2 * i as f32), 0.1)).collect();
                // It hangs on a spring far away, wide or a point.
                let others = masses.iter().map(|&mass| Particle {
                    mass,
                    radius: if round % 2 == 0 { 0.2 } else { 0.0 },
                    ..ball(Vec3::new(50.0, 8.0, 0.0), 0.0)
                });
                start.extend(others);
                let nail = start.len() as u32;
                start.push(Particle { fixed: true, radius: 0.0, ..ball(Vec3::new(50.0, 10.0, 0.0), 0.0) });
                let springs = [Spring::new([nail - 1, nail], 1.0, 50.0 * mass)];
                let springs = if masses.is_empty() { &springs[..0] } else { &springs[..] };
                let floor = Plane { point: Vec3::ZERO, normal: Vec3::Y };
                let scene = Scene {
                    start: &start,
                    materials: &[rubbing(0.5)],
                    forces: &Gravity { acceleration: Vec3::NEG_Y * G as f32 },
                    springs: &springs,
                    colliders: &floor,
                    substeps,
                    constraints: &Contacts::HARD,
                    integrator: &method,
                    ..Scene::EMPTY
                };
                let mut system = started(&scene, start.len(), 1);
                pointmass_tests::run(&mut system, &scene, 1.0 / f64::from(rate), 2 * rate);
                system.particles().position[..6].to_vec()
            };
            let (alone, beside) = (run(&[]), run(&[mass]));
            let off = alone.iter().zip(&beside).map(|(a, b)| a.distance(*b)).fold(0.0, f32::max);
            assert!(off < 1e-6, "{mass} kg, {rate}/s in {substeps}, {method}: {off} m");
        }
    }
}
