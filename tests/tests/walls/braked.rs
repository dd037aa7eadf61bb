//! Forces brake at the velocity that a hit leaves: bounces in air have the order of the method.

use pointmass::force::{Friction, QuadraticDrag, Uniform, Wind};
use pointmass::material::{Curve, Life, Over, Varying};
use pointmass::shape::{Collider, Cuboid, Plane};
use pointmass::{
    ContactMaterial, Drag, Force, Gravity, Material, Meetings, Method, Observer, Particle, Paths, Scene, Time, Vec3,
};
use pointmass_tests::{G, f64s, gap, order, run, started};

type State = [[f64; 3]; 2];

fn moved([x, v]: State, [dx, dv]: State, h: f64) -> State {
    let each = |a: [f64; 3], b: [f64; 3]| core::array::from_fn(|k| a[k] + h * b[k]);
    [each(x, dx), each(v, dv)]
}

/// A step of Runge and Kutta's method.
fn stepped(start: State, h: f64, acceleration: &dyn Fn([f64; 3]) -> [f64; 3]) -> State {
    let rate = |[_, v]: State| [v, acceleration(v)];
    let a = rate(start);
    let b = rate(moved(start, a, 0.5 * h));
    let c = rate(moved(start, b, 0.5 * h));
    let d = rate(moved(start, c, h));
    [(a, 1.0), (b, 2.0), (c, 2.0), (d, 1.0)].into_iter().fold(start, |to, (rate, n)| moved(to, rate, n * h / 6.0))
}

/// The end of a point's way over a plane through the origin, to far below the rounding of single precision.
fn reference(start: State, until: f64, normal: [f64; 3], [e, mu]: [f64; 2], a: &dyn Fn([f64; 3]) -> [f64; 3]) -> State {
    let height = |x: [f64; 3]| x[0] * normal[0] + x[1] * normal[1] + x[2] * normal[2];
    let (mut now, mut left) = (start, until);
    while left > 1e-12 {
        let h = left.min(5e-4);
        let next = stepped(now, h, a);
        if height(next[0]) > 0.0 {
            (now, left) = (next, left - h);
            continue;
        }
        let (mut low, mut high) = (0.0, h);
        for _ in 0..50 {
            let middle = 0.5 * (low + high);
            if height(stepped(now, middle, a)[0]) > 0.0 { low = middle } else { high = middle }
        }
        let [x, v] = stepped(now, low, a);
        let closing = -height(v);
        assert!(closing > 0.05, "it does not come to rest in the time of the test");
        let along: [f64; 3] = core::array::from_fn(|k| v[k] + closing * normal[k]);
        let slip = along.map(|x| x * x).iter().sum::<f64>().sqrt();
        let kept = if slip > 0.0 { 1.0 - (mu * (1.0 + e) * closing / slip).min(1.0) } else { 0.0 };
        now = [x, core::array::from_fn(|k| kept * along[k] + e * closing * normal[k])];
        left -= low;
    }
    now
}

/// Forces, and the accelerations that they give a point of this mass.
struct Air {
    name: &'static str,
    force: Box<dyn Force>,
    acceleration: fn([f64; 3]) -> [f64; 3],
}

const MASS: f32 = 0.5;
/// The coefficients of linear drag \[kg/s\], and of quadratic \[kg/m\].
const K: f32 = 0.75;
const SQUARE: f32 = 0.25;

fn fallen(a: [f64; 3]) -> [f64; 3] {
    [a[0], a[1] - G, a[2]]
}

fn airs() -> [Air; 4] {
    const RATE: f64 = K as f64 / MASS as f64;
    let quadratic = |v: [f64; 3]| {
        let speed = v.map(|x| x * x).iter().sum::<f64>().sqrt();
        fallen(v.map(|x| -f64::from(SQUARE / MASS) * speed * x))
    };
    let wind = Wind { field: Uniform { velocity: Vec3::new(2.0, -0.5, 1.0) }, coefficient: None };
    [
        Air {
            name: "drag",
            force: Box::new((Gravity::EARTH, Drag {})),
            acceleration: |v| fallen(v.map(|x| -RATE * x)),
        },
        Air {
            name: "drag first",
            force: Box::new((Drag {}, Gravity::EARTH)),
            acceleration: |v| fallen(v.map(|x| -RATE * x)),
        },
        Air {
            name: "wind",
            force: Box::new((wind, Gravity::EARTH)),
            acceleration: |[x, y, z]| fallen([RATE * (2.0 - x), RATE * (-0.5 - y), RATE * (1.0 - z)]),
        },
        Air {
            name: "quadratic",
            force: Box::new([
                &Gravity::EARTH as &'static dyn Force,
                &QuadraticDrag { coefficient: SQUARE } as &'static dyn Force,
            ]),
            acceleration: quadratic,
        },
    ]
}

/// Points over a plane, each of which meets it at another part of a step.
fn thrown(normal: Vec3, elasticity: f32) -> Vec<Particle> {
    let along = normal.any_orthonormal_vector();
    let one = |i: u8| {
        let share = f32::from(i) / 24.0;
        Particle {
            position: normal * (0.5 + 0.3 * share) + along * share,
            velocity: along * (1.0 + share) - normal * (1.0 + 0.7 * share),
            mass: MASS,
            drag: K,
            elasticity,
            material: Some(0),
            ..Particle::REST
        }
    };
    (0..24).map(one).collect()
}

/// How far points are from where they should be \[m\], root mean square.
fn off(ends: &[Vec3], right: &[[f64; 3]]) -> f64 {
    let squares = ends.iter().zip(right).map(|(&x, &right)| gap(f64s(x), right).powi(2));
    (squares.sum::<f64>() / ends.len() as f64).sqrt()
}

#[test]
fn bounces_in_air_have_the_order_of_the_method() {
    let steps = [1.0 / 30.0, 1.0 / 60.0, 1.0 / 120.0];
    let mut case = 0_usize;
    for air in airs() {
        for (elasticity, mu) in [(0.5, 0.0), (0.9, 0.0), (0.7, 0.3)] {
            case += 1;
            let normal = [Vec3::Y, Vec3::new(0.2, 1.0, -0.1).normalize()][case % 2];
            let friction = Friction { static_: mu, kinetic: mu };
            let materials = [ContactMaterial { friction: Some(friction), elasticity: Some(elasticity) }];
            let start = thrown(normal, elasticity);
            let contact = [f64::from(elasticity), f64::from(mu)];
            let right: Vec<[f64; 3]> = start
                .iter()
                .map(|p| {
                    let start = [f64s(p.position), f64s(p.velocity)];
                    reference(start, 0.6, f64s(normal), contact, &air.acceleration)[0]
                })
                .collect();
            let floor = Plane { point: Vec3::ZERO, normal };
            let far = Cuboid { min: Vec3::splat(50.0), max: Vec3::splat(51.0) };
            let among: [&dyn Collider; 2] = [&floor, &far];
            let colliders: [&dyn Collider; 2] = [&floor, &among];
            for method in Method::ALL {
                let parts = Scene { start: &start, forces: &*air.force, materials: &materials, ..Scene::EMPTY };
                let scene = Scene { colliders: colliders[case / 2 % 2], integrator: method.integrator(), ..parts };
                let errors = steps.map(|h| {
                    let mut system = started(&scene, start.len(), 0);
                    run(&mut system, &scene, h, (0.6 / h).round() as u32);
                    off(system.particles().position, &right)
                });
                let what = format!("{method}, {}, {elasticity} {mu}: {errors:?}", air.name);
                let is_second = !matches!(method, Method::Euler | Method::Symplectic | Method::Implicit);
                // The speed after a bounce would be off by 1.5 × 1.5 × 2.5 m/s × h, and a way by half a second of that.
                let most = if is_second { [2e-3, 5e-4, 2e-4] } else { [1.0, 0.5, 0.2] };
                assert!(errors.iter().zip(most).all(|(&error, most)| error < most), "{what}");
                // What is within 0.1 mm is next to rounding.
                assert!(!is_second || errors[0] < 1e-4 || order(&steps, &errors) > 1.6, "{what}");
            }
        }
    }
}

/// A drop that falls as fast as the air lets it feels nothing on the mean; after the hit gravity and air act on it at once, however much
/// of its speed the air takes in a step. It had gone on without either.
#[test]
fn drops_that_fall_steadily_bounce_under_gravity_and_air() {
    for method in Method::ALL {
        for rate in [5.0_f32, 30.0, 200.0, 2000.0] {
            let fastest = 9.80665 / rate;
            for share in [0.1, 0.5, 0.9] {
                let start = [Particle {
                    position: Vec3::Y * (fastest * share / 60.0),
                    velocity: Vec3::Y * -fastest,
                    drag: rate,
                    elasticity: 0.8,
                    ..Particle::REST
                }];
                let floor = Plane { point: Vec3::ZERO, normal: Vec3::Y };
                let forces = (Gravity::EARTH, Drag {});
                let parts = Scene { start: &start, forces: &forces, colliders: &floor, ..Scene::EMPTY };
                let scene = Scene { integrator: method.integrator(), ..parts };
                let mut system = started(&scene, 1, 0);
                let report = system.step(&scene, Time::frame(1, 60));
                let p = system.particles();
                let (height, up) = (f64::from(p.position[0].y), f64::from(p.velocity[0].y) / f64::from(fastest));
                let z = f64::from(rate) * f64::from(1.0 - share) / 60.0;
                let right = 1.8 * (-z).exp() - 1.0;
                let what = format!("{method} {rate} {share}: {up}, not {right}, at {height}");
                assert!(height > 0.0, "{what}");
                // Who has come back in the step, or lies, is slow.
                let is_right = (up - right).abs() < 0.05 + 0.05 * z.min(1.0) || report.hits > 1 && up.abs() <= 1.0;
                assert!(is_right || up.abs() < 0.05 && right < 0.0, "{what}");
            }
        }
    }
}

/// Two balls that meet head on, with drag: the first order had shown in their speeds.
#[test]
fn balls_that_meet_in_air_have_the_order_of_the_method() {
    let (rate, e, gap) = (2.0_f64, 0.6_f64, 0.4_f64);
    let steps = [1.0 / 20.0, 1.0 / 40.0, 1.0 / 80.0];
    let scene_of = |method: Method, start: &[Particle], h: f64| {
        let parts = Scene { start, forces: &Drag {}, meetings: Meetings::IMPULSE, ..Scene::EMPTY };
        let scene = Scene { integrator: method.integrator(), ..parts };
        let mut system = started(&scene, 2, 0);
        run(&mut system, &scene, h, (0.5 / h).round() as u32);
        system.particles().position.iter().map(|x| f64::from(x.x)).collect::<Vec<_>>()
    };
    for method in [Method::Midpoint, Method::Verlet, Method::Rk4, Method::Adaptive, Method::Embedded] {
        let errors = steps.map(|h| {
            let mut sum = 0.0;
            for i in 0..12_u8 {
                let speed = 2.0 + f64::from(i) / 12.0;
                let ball = |x: f32, v: f32| Particle {
                    position: Vec3::X * x,
                    velocity: Vec3::X * v,
                    radius: 0.1,
                    mass: 0.25,
                    drag: 0.5,
                    elasticity: e as f32,
                    ..Particle::REST
                };
                let reach = (gap / 2.0 + 0.1) as f32;
                let ends = scene_of(method, &[ball(-reach, speed as f32), ball(reach, -speed as f32)], h);
                // Each has come 0.2 m when they meet, and has lost so much of its speed.
                let met = -(1.0 - rate * (gap / 2.0) / speed).ln() / rate;
                let back = e * speed * (-rate * met).exp() * (1.0 - (-rate * (0.5 - met)).exp()) / rate;
                sum += (ends[1] - (0.1 + back)).powi(2) + (ends[0] + 0.1 + back).powi(2);
            }
            (sum / 24.0).sqrt()
        });
        assert!(order(&steps, &errors) > 1.6 || errors[0] < 2e-5, "{method}: {errors:?}");
        assert!(errors[1] < 1e-3, "{method}: {errors:?}");
    }
}

/// Where nothing brakes nothing has changed: a bounce has the bits that it has without forces that never act.
#[test]
fn what_no_air_brakes_bounces_to_the_same_bits() {
    let start = thrown(Vec3::Y, 0.8);
    let floor = Plane { point: Vec3::ZERO, normal: Vec3::Y };
    let nothing = QuadraticDrag { coefficient: 0.0 };
    let ends = |forces: &dyn Force, paths: Paths| {
        let parts = Scene { start: &start, forces, colliders: &floor, paths, ..Scene::EMPTY };
        let mut system = started(&parts, start.len(), 0);
        run(&mut system, &parts, 1.0 / 60.0, 90);
        system.hash()
    };
    for paths in [Paths::CURVED, Paths::STRAIGHT] {
        assert_eq!(ends(&Gravity::EARTH, paths), ends(&(Gravity::EARTH, nothing), paths));
    }
}

/// Wants to be told of all, for which each is followed by itself.
struct Watching;

impl Observer for Watching {}

#[test]
fn who_is_watched_bounces_to_the_same_bits_in_any_air() {
    let mut start = thrown(Vec3::Y, 0.6);
    start.iter_mut().enumerate().for_each(|(i, point)| (point.drag, point.lifetime) = (0.25 * i as f32, 4.0));
    let floor = Plane { point: Vec3::ZERO, normal: Vec3::Y };
    let keys = [[0.0, 0.1], [1.0, 0.7]];
    let rising = Varying { from: Curve { keys: &keys, over: Over::Life, smooth: false }, to: None };
    let plain = Material::of(ContactMaterial { elasticity: None, friction: None });
    let floating = Material { life: Life { buoyancy: Some(rising), ..Life::default() }, ..plain };
    for air in airs() {
        for material in [plain, floating] {
            for method in Method::ALL {
                let materials = [material];
                let parts = Scene { start: &start, forces: &*air.force, colliders: &floor, ..Scene::EMPTY };
                let scene = Scene { materials: &materials, integrator: method.integrator(), ..parts };
                let [mut alone, mut watched] = [(); 2].map(|()| started(&scene, start.len(), 0));
                for frame in 1..=90 {
                    alone.step_to(&scene, Time::frame(frame, 60));
                    let rest = Time::frame(frame, 60) - watched.time();
                    watched.step_observed(&scene, rest, &mut Watching);
                }
                let (a, b) = (alone.particles(), watched.particles());
                assert_eq!(a.position, b.position, "{method}, {}", air.name);
                assert_eq!(a.velocity, b.velocity, "{method}, {}", air.name);
            }
        }
    }
}

/// However strongly air brakes, it leaves nobody faster than the hit did, and linear drag turns nobody round.
#[test]
fn air_as_thick_as_may_be_only_brakes() {
    let floor = Plane { point: Vec3::ZERO, normal: Vec3::Y };
    for method in [Method::Embedded, Method::Adaptive, Method::Implicit] {
        for share in [0.1, 0.5, 0.9] {
            for strength in [1e-2, 1.0, 1e2, 1e4] {
                let forces: [&dyn Force; 2] = [&Drag {}, &QuadraticDrag { coefficient: strength }];
                for force in forces {
                    let start = [Particle {
                        position: Vec3::Y * (3.0 * share / 60.0),
                        velocity: Vec3::new(2.0, -3.0, 0.0),
                        drag: strength,
                        elasticity: 0.8,
                        ..Particle::REST
                    }];
                    let scene = Scene { start: &start, forces: force, colliders: &floor, ..Scene::EMPTY };
                    let scene = Scene { integrator: method.integrator(), ..scene };
                    let mut system = started(&scene, 1, 0);
                    system.step(&scene, Time::frame(1, 60));
                    let (x, v) = (system.particles().position[0], system.particles().velocity[0]);
                    let what = format!("{method} {strength} {share}: {x} {v}");
                    assert!(x.y > 0.0 && v.length() < 3.61, "{what}");
                    assert!(v.x >= -1e-5 && v.x <= 2.0 || force.steady().is_none(), "{what}");
                }
            }
        }
    }
}
