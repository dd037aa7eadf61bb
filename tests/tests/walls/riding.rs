//! Particles that rest on scenery that moves go where that takes them, for as long as friction can hold them.

use pointmass::force::Friction;
use pointmass::motion::Motion;
use pointmass::shape::{Aabb, Affine, Collider, Cuboid, Cylinder, Disc, Moving, Placed, Plane, Sphere};
use pointmass::{ContactMaterial, Contacts, Gravity, Method, Particle, Scene, Time, Vec3};
use pointmass_tests::{Form, f64s, gap, is_run, is_third, methods, run, started};

const EVERYWHERE: Aabb = Aabb { min: Vec3::NEG_INFINITY, max: Vec3::INFINITY };

/// Where particles are after `seconds`, on a surface with this coefficient of friction.
fn after(collider: &dyn Collider, mu: f32, start: &[Particle], method: Method, rate: f64, seconds: f64) -> Vec<Vec3> {
    after_touching(Scene::EMPTY, collider, mu, start, method, rate, seconds)
}

fn after_touching(
    touching: Scene<'_>,
    collider: &dyn Collider,
    mu: f32,
    start: &[Particle],
    method: Method,
    rate: f64,
    seconds: f64,
) -> Vec<Vec3> {
    let materials = [ContactMaterial { elasticity: Some(0.0), friction: Some(Friction { static_: mu, kinetic: mu }) }];
    let start: Vec<Particle> = start.iter().map(|p| Particle { material: Some(0), elasticity: 0.0, ..*p }).collect();
    let (forces, integrator) = (&Gravity::EARTH, method.integrator());
    let scene = Scene { start: &start, forces, colliders: collider, materials: &materials, integrator, ..touching };
    let mut system = started(&scene, start.len(), 0);
    run(&mut system, &scene, 1.0 / rate, (rate * seconds) as u32);
    system.particles().position.to_vec()
}

fn turning(pivot: Vec3, spin: f32) -> Moving<Disc> {
    let disc = Disc { center: pivot, normal: Vec3::Y, radius: 5.0 };
    Moving::new(disc, &EVERYWHERE, Motion { pivot, spin, ..Motion::STILL })
}

#[test]
fn on_a_disc_that_spins_it_stays_where_it_is() {
    for (i, (pivot, spin, distance)) in [
        (Vec3::ZERO, 0.25f32, 1.0f32),
        (Vec3::new(3.0, 1.0, -2.0), -0.25, 1.0),
        (Vec3::new(0.5, 0.0, 0.25), 0.15, 3.0),
        (Vec3::new(0.5, 0.0, 0.25), 0.5, 0.4),
    ]
    .into_iter()
    .enumerate()
    {
        let disc = turning(pivot, spin);
        let omega = core::f64::consts::TAU * f64::from(spin);
        let start: Vec<Particle> = [0.0f32, 0.1]
            .into_iter()
            .map(|radius| Particle {
                position: pivot + Vec3::X * distance + Vec3::Y * (radius + 1e-6),
                velocity: Vec3::Z * (-omega as f32 * distance),
                radius,
                ..Particle::REST
            })
            .collect();
        for (j, rate) in [10.0, 60.0, 1000.0].into_iter().enumerate() {
            let methods = methods(i + j).filter(|m| rate < 100.0 || matches!(m, Method::Rk4 | Method::Euler));
            for method in methods {
                for (row, x) in after(&disc, 0.5, &start, method, rate, 20.0).into_iter().enumerate() {
                    let x = x - pivot;
                    let away = f64::from(x.x).hypot(f64::from(x.z));
                    assert!(
                        (away / f64::from(distance) - 1.0).abs() < 2e-3,
                        "{method}, {rate}/s, {row}: at {away}, not {distance}"
                    );
                    let angle = (-omega * 20.0).sin_cos();
                    let turned = [angle.1, angle.0].map(|x| x * f64::from(distance));
                    let off = (f64::from(x.x) - turned[0]).hypot(f64::from(x.z) - turned[1]);
                    assert!(off < 0.02 * f64::from(distance), "{method}, {rate}/s, {row}: {x}, not {turned:?}");
                }
            }
        }
    }
}

#[test]
fn on_a_disc_that_spins_it_stays_where_it_is_by_position() {
    for (i, (pivot, spin, distance, radius)) in
        [(Vec3::ZERO, 0.25f32, 1.0f32, 0.05f32), (Vec3::new(3.0, 1.0, -2.0), -0.15, 3.0, 0.2)].into_iter().enumerate()
    {
        let disc = turning(pivot, spin);
        let omega = core::f32::consts::TAU * spin;
        let start = [Particle {
            position: pivot + Vec3::X * distance + Vec3::Y * radius,
            velocity: Vec3::Z * (-omega * distance),
            radius,
            ..Particle::REST
        }];
        for (j, (rate, substeps)) in [(10.0, 12), (60.0, 12), (60.0, 1), (24.0, 40)].into_iter().enumerate() {
            let touching = Scene { substeps, constraints: &Contacts::HARD, ..Scene::EMPTY };
            for method in methods(i + j) {
                let x = after_touching(touching, &disc, 0.5, &start, method, rate, 20.0)[0] - pivot;
                let away = x.x.hypot(x.z) / distance;
                // Chords of the arc are trapezoids in time: they stray by a part in 24 of the fourth power of the angle.
                assert!((away - 1.0).abs() < 2e-3, "{method}, {rate}/s in {substeps}: at {away}");
                let (sin, cos) = (-omega * 20.0).sin_cos();
                let off = (x - Vec3::new(cos * distance, radius, sin * distance)).length() / distance;
                assert!(off < 0.05, "{method}, {rate}/s in {substeps}: {x}, off by {off}");
            }
        }
    }
}

#[test]
fn what_slides_stops_where_friction_stops_it_whatever_the_method() {
    // v² / 2µg on the level, from any height: also where a step of explicit Euler ends as high as it began.
    for (mu, speed, radius, height) in [(0.3f32, 5.0f32, 0.1f32, 0.0f32), (0.5, 3.0, 0.0, 7.0), (0.2, 2.0, 0.25, -4.0)]
    {
        let floor = Plane { point: Vec3::Y * height, normal: Vec3::Y };
        let position = Vec3::Y * (height + radius);
        let start = [Particle { position, velocity: Vec3::X * speed, radius, ..Particle::REST }];
        let wanted = speed * speed / (2.0 * mu * 9.80665);
        for rate in [24.0, 60.0, 144.0] {
            for &method in Method::ALL {
                let x = after(&floor, mu, &start, method, rate, 4.0)[0];
                assert!((x.x / wanted - 1.0).abs() < 1e-3, "{method}, {rate}/s: {x}, not {wanted}");
            }
        }
    }
}

#[test]
fn on_a_disc_that_spins_too_fast_it_slips() {
    // ω² R beyond µ g, by a tenth; and short of it by a tenth.
    let omega = core::f32::consts::TAU * 0.25;
    for (share, slips) in [(1.1f32, true), (0.9, false)] {
        let mu = omega * omega / (share * 9.80665);
        let start = [Particle { position: Vec3::new(1.0, 1e-6, 0.0), velocity: Vec3::Z * -omega, ..Particle::REST }];
        for rate in [10.0, 60.0, 1000.0] {
            for method in [Method::Verlet, Method::Rk4, Method::Symplectic] {
                let x = after(&turning(Vec3::ZERO, 0.25), mu, &start, method, rate, 3.0)[0];
                let away = x.x.hypot(x.z);
                assert_eq!(away > 1.05, slips, "{method}, {rate}/s, µ {mu}: at {away}");
            }
        }
    }
}

#[test]
fn on_whatever_moves_it_goes_along() {
    // A slab that lies level, or turned about z by 15 degrees, and moves in some way.
    let level = Affine::IDENTITY;
    let (sin, cos) = 15f32.to_radians().sin_cos();
    let tilt = Affine {
        linear: pointmass::Mat3::from_cols(Vec3::new(cos, sin, 0.0), Vec3::new(-sin, cos, 0.0), Vec3::Z),
        shift: Vec3::ZERO,
    };
    let slab = Cuboid { min: Vec3::new(-4.0, -0.5, -4.0), max: Vec3::new(4.0, 0.0, 4.0) };
    let motions = [
        Motion { drift: Vec3::new(1.0, 0.25, -0.5), ..Motion::STILL },
        Motion { swing: Vec3::new(0.3, 0.05, -0.1), frequency: 0.4, ..Motion::STILL },
        Motion { swing: Vec3::Y * 0.1, frequency: 0.7, phase: 0.25, ..Motion::STILL },
        Motion {
            pivot: Vec3::new(1.0, 0.0, 1.0),
            spin: 0.2,
            drift: Vec3::X * 0.5,
            swing: Vec3::Z * 0.2,
            frequency: 0.3,
            ..Motion::STILL
        },
        // It rocks too slowly to throw off anything: a turn in 100 s about a level axis.
        Motion { axis: Vec3::Z, spin: -0.01, pivot: Vec3::Y * -1.0, ..Motion::STILL },
    ];
    let mut cases = 0;
    for map in [level, tilt] {
        let placed = Placed::new(slab, map).expect("it only turns");
        for (i, motion) in motions.iter().enumerate() {
            let moving = Moving::new(&placed, &EVERYWHERE, *motion);
            let speed = |x: Vec3| {
                let h = Time::from_seconds(1e-2);
                (motion.at(h).point(x) - motion.at(Time::ZERO).point(x)) * 100.0
            };
            let start: Vec<Particle> = [0.0f32, 0.1]
                .into_iter()
                .map(|radius| {
                    let local = motion.at(Time::ZERO).point(map.point(Vec3::new(0.8, radius + 1e-6, -0.4)));
                    Particle {
                        position: local,
                        velocity: speed(map.point(Vec3::new(0.8, radius, -0.4))),
                        radius,
                        ..Particle::REST
                    }
                })
                .collect();
            for rate in [10.0, 60.0, 400.0] {
                let methods = [Method::Verlet, Method::Rk4, Method::Symplectic];
                for method in methods.into_iter().filter(|_| is_third(&mut cases)) {
                    for (begun, x) in start.iter().zip(after(&moving, 0.9, &start, method, rate, 5.0)) {
                        let first = motion.at(Time::ZERO);
                        let back = first.inverse().expect("it only moves").point(begun.position);
                        let there = motion.at(Time::from_seconds(5.0)).point(back);
                        let off = gap(f64s(x), f64s(there));
                        assert!(
                            off < 1e-2,
                            "motion {i}, {method}, {rate}/s, radius {}: {off} from {there}",
                            begun.radius
                        );
                    }
                }
            }
        }
    }
}

#[test]
fn what_slides_in_a_smooth_drum_that_spins_gains_nothing() {
    let center = Vec3::new(0.3, -1.0, 2.0);
    let (mut cases, mut failures) = (0, vec![]);
    for is_round in [false, true] {
        for (size, spin) in [(1.0f32, 0.1f32), (1.0, -0.3), (1.0, 2.0), (4.0, -1.0), (0.2, 3.0)] {
            for elasticity in [0.0, 0.3, 0.8, 1.0] {
                for (method, rate) in [
                    (Method::Verlet, 60.0),
                    (Method::Symplectic, 60.0),
                    (Method::Rk4, 240.0),
                    (Method::Midpoint, 100.0),
                ] {
                    if !is_run(&mut cases) {
                        continue;
                    }
                    let motion = Motion { pivot: center, spin, ..Motion::STILL };
                    let radius = 0.5 * size;
                    let (sphere, cylinder) = (Sphere { center, radius }, Cylinder { center, radius, height: size });
                    let shape = if is_round { Form::Sphere(sphere) } else { Form::Cylinder(cylinder) };
                    let drum = Moving::new(&shape, &EVERYWHERE, motion);
                    // It is let go 60 degrees from the lowest place; the drum's axis lies.
                    let position = center + Vec3::new(0.75f32.sqrt(), 0.0, -0.5) * (0.499_998 * size);
                    let start = [Particle { position, elasticity, ..Particle::REST }];
                    let forces = &Gravity { acceleration: Vec3::NEG_Z * 9.81 };
                    let integrator = method.integrator();
                    let scene = Scene { start: &start, forces, colliders: &drum, integrator, ..Scene::EMPTY };
                    let mut system = started(&scene, 1, 0);
                    run(&mut system, &scene, 1.0 / rate, (3.0 * rate) as u32);
                    let particles = system.particles();
                    let (x, v) = (f64s(particles.position[0]), f64s(particles.velocity[0]));
                    let depth = 0.25 * 9.81 * f64::from(size);
                    let gained = (0.5 * gap(v, [0.0; 3]).powi(2) + 9.81 * (x[2] - f64::from(position.z))) / depth;
                    // The symplectic Euler method falls farther than it gets faster.
                    let least = if method == Method::Symplectic { -0.2 } else { -0.1 };
                    if !(least..0.01).contains(&gained) {
                        failures.push(format!("{shape:?}, {spin}/s, e {elasticity}, {method}, {rate}/s: {gained:.3}"));
                    }
                }
            }
        }
    }
    assert!(failures.is_empty(), "{} {failures:#?}", failures.len());
}
