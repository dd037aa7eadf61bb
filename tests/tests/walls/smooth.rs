//! Smooth surfaces, whether they swing, spin or curve: nobody falls through them, and they take along nobody and give nobody energy.

use pointmass::motion::Motion;
use pointmass::shape::{Aabb, Capsule, Collider, Cylinder, Moving, Plane, Sphere};
use pointmass::{Gravity, Method, Particle, Scene, Vec3};
use pointmass_tests::{Random, every, is_run, often, run, started};

const EVERYWHERE: Aabb = Aabb { min: Vec3::NEG_INFINITY, max: Vec3::INFINITY };
const G: f32 = 9.80665;

/// Places and velocities at the end of so many steps.
fn ends(walls: &dyn Collider, weight: Vec3, start: &[Particle], method: Method, h: f64, steps: u32) -> [Vec<Vec3>; 2] {
    let forces = Gravity { acceleration: weight };
    let scene = Scene { start, forces: &forces, colliders: walls, integrator: method.integrator(), ..Scene::EMPTY };
    let mut system = started(&scene, start.len(), 1);
    run(&mut system, &scene, h, steps);
    let all = system.particles();
    [all.position.to_vec(), all.velocity.to_vec()]
}

/// Floors that swing more gently than things fall hold points and the smallest balls, wherever these are and however they lean.
#[test]
fn nobody_falls_through_floors_that_swing() {
    let mut cases = 0;
    for (i, normal) in [Vec3::Y, Vec3::new(0.6, 0.8, 0.0), Vec3::NEG_Z].into_iter().enumerate() {
        for rate in [60.0, 120.0, 240.0, 1000.0] {
            for aside in [0.0, 0.1, 1.0] {
                for radius in [0.0, 1e-6, 1e-5, 0.01] {
                    if !is_run(&mut cases) {
                        continue;
                    }
                    let u = normal.any_orthonormal_vector();
                    let floor = Plane { point: Vec3::ZERO, normal };
                    let motion = Motion { swing: normal * 0.2, frequency: 1.0, ..Motion::STILL };
                    let floor = Moving::new(floor, &EVERYWHERE, motion);
                    let elasticity = [0.0, 0.3][i % 2];
                    let start: Vec<_> = (0..20)
                        .step_by(every(4))
                        .map(|k| u * (aside + 0.005 * k as f32) + normal * (0.02 + 0.002 * k as f32))
                        .map(|position| Particle { position, radius, elasticity, ..Particle::REST })
                        .collect();
                    let steps = (rate * 2.25) as u32;
                    let method = [Method::Rk4, Method::Symplectic, Method::Verlet][i];
                    let [places, _] = ends(&floor, normal * -G, &start, method, 1.0 / rate, steps);
                    let least = places.iter().map(|x| x.dot(normal)).fold(f32::INFINITY, f32::min);
                    assert!(least > 0.2 - 1e-3, "{normal} {rate}/s {aside} {radius}: {least}");
                }
            }
        }
    }
}

/// A surface without friction that moves within itself takes nobody along: who is at rest on it stays there, who slides goes straight on.
#[test]
fn smooth_surfaces_that_move_within_themselves_take_nobody_along() {
    let mut cases = 0;
    for normal in [Vec3::Y, Vec3::new(0.48, 0.6, 0.64)] {
        let u = normal.any_orthonormal_vector();
        for motion in [
            Motion { axis: normal, spin: 1.0, ..Motion::STILL },
            Motion { axis: normal, spin: -3.0, pivot: u * 0.3, ..Motion::STILL },
            Motion { swing: u * 0.1, frequency: 1.0, ..Motion::STILL },
        ] {
            for h in [0.2, 1.0 / 60.0, 1.0 / 240.0] {
                for radius in [0.0, 0.05] {
                    if !is_run(&mut cases) {
                        continue;
                    }
                    let floor = Moving::new(Plane { point: Vec3::ZERO, normal }, &EVERYWHERE, motion);
                    let drift = normal.cross(u) * 0.3;
                    let at = |velocity| Particle {
                        position: u * 0.5 + normal * (radius + 1e-5),
                        velocity,
                        radius,
                        ..Particle::REST
                    };
                    let start = [at(Vec3::ZERO), at(drift)];
                    let steps = (2.0 / h) as u32;
                    let [places, velocities] = ends(&floor, normal * -G, &start, Method::Rk4, h, steps);
                    for (i, expected) in [Vec3::ZERO, drift].into_iter().enumerate() {
                        let aside = |v: Vec3| v - normal * v.dot(normal);
                        let way = aside(places[i] - start[i].position - expected * (h as f32 * steps as f32)).length();
                        let slip = aside(velocities[i] - expected).length();
                        assert!(way < 1e-4 && slip < 1e-4, "{motion:?} {h} {radius}: {way} m, {slip} m/s");
                    }
                }
            }
        }
    }
}

/// Points and balls that slide in bowls, troughs and pipes without friction keep their energy by methods of second order, whatever their size, place, and
/// elasticity, but for how high rounding has them set off.
#[test]
fn what_slides_in_a_bowl_keeps_its_energy() {
    let mut cases = 0;
    for (size, far, share) in
        [(0.01f32, 0.0f32, 0.0f32), (1.0, 0.0, 0.0), (1.0, 0.0, 0.1), (1.0, 3.0, 0.0), (100.0, 30.0, 0.2)]
    {
        let (center, radius, reach) = (Vec3::Y * far, size * share, size * (1.0 - share));
        let bowl = Sphere { center, radius: size };
        let trough = Cylinder { center, radius: size, height: 4.0 * size };
        let pipe = Capsule { from: center - Vec3::Y * size, to: center + Vec3::Y * size, radius: size };
        for walls in [&bowl as &dyn Collider, &trough, &pipe] {
            for method in [Method::Rk4, Method::Midpoint, Method::Verlet, Method::Adaptive] {
                for rate in [60.0, 240.0, 1000.0] {
                    if !is_run(&mut cases) {
                        continue;
                    }
                    let angles = [(0.1f32, 0.0f32), (0.1, 0.5), (0.8, 0.0), (0.8, 0.9), (1.4, 0.5)];
                    let at = |angle: f32| center + Vec3::new(-angle.cos(), 0.0, angle.sin()) * (reach * 0.999_99);
                    let start = angles.map(|(angle, elasticity)| Particle {
                        position: at(angle),
                        radius,
                        elasticity,
                        ..Particle::REST
                    });
                    let h = f64::from(size).sqrt() / rate;
                    let [places, velocities] = ends(walls, Vec3::NEG_X * G, &start, method, h, (10.0 * rate) as u32);
                    let energy = |x: Vec3, v: Vec3| 0.5 * v.length_squared() + G * (x.x + reach);
                    for (i, (begun, (from, elasticity))) in start.iter().zip(angles).enumerate() {
                        let whole = energy(begun.position, Vec3::ZERO);
                        let off = (energy(places[i], velocities[i]) - whole).abs();
                        let raised = G * 8.0 * f32::EPSILON * (far + 3.0 * size) + 1e-5 * G * size;
                        let case =
                            format!("{size} m at {far}, {radius}, {from} rad, {elasticity}, {method:?} at {rate}");
                        assert!(off < 0.04 * whole + 2.0 * raised, "{case}: off by {} of all", off / whole);
                    }
                }
            }
        }
    }
}

/// Flat walls turn nobody: who hits one under a small angle, however near it he begins, keeps his speed along it, as he does along a corner of two.
#[test]
fn flat_walls_turn_nobody() {
    let mut random = Random::new(83);
    let mut hits = 0;
    for round in 0..often(4000) {
        let far = [0.0f32, 40.0, 1000.0, 1e5][round % 4];
        let (home, normal) = (Vec3::X * far, random.direction());
        let (floor, u) = (Plane { point: home, normal }, normal.any_orthonormal_vector());
        let (angle, slack) = (random.magnitude(1e-3, 0.5), 8.0 * f32::EPSILON * (far + 1.0));
        let along = u * angle.cos();
        let start = Particle {
            position: home + normal * (slack * random.magnitude(1.0, 100.0)),
            velocity: along - normal * angle.sin(),
            elasticity: [0.0, 0.3, 0.8][round % 3],
            ..Particle::REST
        };
        let h = f64::from(random.magnitude(0.01, 1.0));
        let [_, velocities] = ends(&floor, Vec3::ZERO, &[start], Method::Rk4, h, 1);
        hits += u32::from(velocities[0] != start.velocity);
        let v = velocities[0] - normal * velocities[0].dot(normal);
        assert!((v - along).length() < 1e-5, "{far} {angle} {start:?}: {v} for {along}");
    }
    assert!(hits as usize > often(4000) / 4, "{hits}");
    for (degrees, far) in [1.0f32, 5.0, 10.0].into_iter().flat_map(|degrees| [(degrees, 0.0), (degrees, 40.0)]) {
        let (sin, cos) = degrees.to_radians().sin_cos();
        let home = Vec3::X * far;
        let corner = (Plane { point: home, normal: Vec3::Y }, Plane { point: home, normal: Vec3::new(sin, -cos, 0.0) });
        for (rate, elasticity) in [(60.0, 0.0), (240.0, 0.3)] {
            let position = home + Vec3::new(1.0, 0.5 * sin, 0.0);
            let start = Particle { position, velocity: Vec3::new(-5.0, 0.0, 1.0), elasticity, ..Particle::REST };
            for weight in [Vec3::ZERO, Vec3::NEG_Y * G] {
                let [_, velocities] = ends(&corner, weight, &[start], Method::Rk4, 1.0 / rate, rate as u32);
                let z = velocities[0].z;
                assert!((z - 1.0).abs() < 1e-3, "{degrees} degrees at {far}, {elasticity}: {z}");
            }
        }
    }
}

/// By the symplectic Euler method, which falls farther than it gets faster, they gain none.
#[test]
fn what_slides_in_a_bowl_gains_no_energy() {
    let walls = Sphere { center: Vec3::ZERO, radius: 1.0 };
    for (radius, h) in [0.0f32, 0.1].into_iter().flat_map(|r| [1.0 / 30.0, 1.0 / 60.0, 1.0 / 240.0].map(|h| (r, h))) {
        let reach = 1.0 - radius;
        let at = |angle: f32| Vec3::new(-angle.cos(), 0.0, angle.sin()) * (reach * 0.999_99);
        let start = [0.1, 0.3, 0.9].map(|angle| Particle { position: at(angle), radius, ..Particle::REST });
        let [places, velocities] = ends(&walls, Vec3::NEG_X * G, &start, Method::Symplectic, h, (5.0 / h) as u32);
        for (i, begun) in start.iter().enumerate() {
            let energy = |x: Vec3, v: Vec3| 0.5 * v.length_squared() + G * (x.x + reach);
            let share = energy(places[i], velocities[i]) / energy(begun.position, Vec3::ZERO);
            assert!((0.8..1.05).contains(&share), "{h} {radius} {i}: {share}");
        }
    }
}

/// Points and balls that slide round in a pipe in no gravity go on as fast, however narrow that is for how far its walls reach.
#[test]
fn what_slides_round_goes_on_as_fast() {
    for (size, length, speed) in [(0.1f32, 1.0, 2.0f32), (1.0, 4.0, 2.0), (1.0, 4.0, 8.0), (1000.0, 4000.0, 50.0)] {
        let pipe = Cylinder { center: Vec3::ZERO, radius: size, height: length };
        for (radius, elasticity) in [(0.0, 0.0), (0.0, 0.5), (0.1 * size, 0.0), (0.1 * size, 0.9)] {
            for rate in [60.0, 240.0, 1000.0] {
                let place = Vec3::X * (0.999_99 * (size - radius));
                let start =
                    Particle { position: place, velocity: Vec3::Z * speed, radius, elasticity, ..Particle::REST };
                let [_, velocities] = ends(&pipe, Vec3::ZERO, &[start], Method::Rk4, 1.0 / rate, (2.0 * rate) as u32);
                let left = velocities[0].length() / speed;
                assert!((left - 1.0).abs() < 0.03, "{size} m, {radius}, {elasticity} at {rate}: {left} of its speed");
            }
        }
    }
}

/// The angle of a pendulum of this length \[m\] a time after it has been let go at another, by RK4 in small steps.
fn pendulum(length: f64, from: f64, seconds: f64) -> f64 {
    let (steps, pull) = (20_000, f64::from(G) / length);
    let h = seconds / f64::from(steps);
    let slope = |[angle, speed]: [f64; 2]| [speed, -pull * angle.sin()];
    let on = |a: [f64; 2], b: [f64; 2], by: f64| [a[0] + b[0] * by, a[1] + b[1] * by];
    let mut state = [from, 0.0];
    for _ in 0..steps {
        let a = slope(state);
        let b = slope(on(state, a, 0.5 * h));
        let c = slope(on(state, b, 0.5 * h));
        let d = slope(on(state, c, h));
        state = on(on(on(on(state, a, h / 6.0), b, h / 3.0), c, h / 3.0), d, h / 6.0);
    }
    state[0]
}

/// Points and balls that slide in a bowl or a trough without friction swing as pendulums do, however large that is: a step leads all of their way.
#[test]
fn what_slides_in_a_bowl_swings_as_a_pendulum() {
    let mut cases = 0;
    for (size, share) in [(0.01f32, 0.0f32), (1.0, 0.0), (1.0, 0.1), (100.0, 0.2)] {
        let bowl = Sphere { center: Vec3::ZERO, radius: size };
        let trough = Cylinder { center: Vec3::ZERO, radius: size, height: 4.0 * size };
        for walls in [&bowl as &dyn Collider, &trough] {
            for (rate, method) in
                [(60.0, Method::Rk4), (60.0, Method::Verlet), (120.0, Method::Midpoint), (240.0, Method::Symplectic)]
            {
                if !is_run(&mut cases) {
                    continue;
                }
                let (radius, reach) = (share * size, size * (1.0 - share));
                let angles = [(0.3f32, 0.0f32), (0.8, 0.0), (0.8, 0.5), (1.4, 0.8)];
                let at = |angle: f32| Vec3::new(-angle.cos(), 0.0, angle.sin()) * (reach * 0.999_99);
                let start = angles.map(|(angle, elasticity)| Particle {
                    position: at(angle),
                    radius,
                    elasticity,
                    ..Particle::REST
                });
                // As long against a swing whatever the size.
                let h = f64::from(size).sqrt() / rate;
                let steps = (4.3 * rate) as u32;
                let [places, _] = ends(walls, Vec3::NEG_X * G, &start, method, h, steps);
                for ((from, elasticity), x) in angles.into_iter().zip(places) {
                    let expected = pendulum(f64::from(reach), f64::from(from), h * f64::from(steps));
                    let off = f64::from(x.z.atan2(-x.x)) - expected;
                    let case = format!("{size} m, {radius}, {from} rad, {elasticity}, {method} at {rate}");
                    assert!(off.abs() < 0.05 * f64::from(from), "{case}: off by {off} from {expected}");
                }
            }
        }
    }
}
