//! Coulomb's friction under contacts held by position: the same with every method, step and number of sub-steps.

use pointmass::force::Friction;
use pointmass::shape::Plane;
use pointmass::{ContactMaterial, Contacts, Gravity, Particle, Scene, Vec3};
use pointmass_tests::{G, f64s, gap, methods, run, started};

/// Steps a second, sub-steps of each.
const STEPS: [(u32, u32); 6] = [(24, 1), (60, 2), (60, 12), (240, 3), (24, 50), (240, 50)];

/// A setting for particles: on a surface or on none, under one coefficient of friction for all.
struct Stage {
    mu: f32,
    gravity: Vec3,
    plane: Option<Vec3>,
    seconds: u32,
}

impl Stage {
    /// Where all are in the end and how fast, by every method, step and number of sub-steps, in debug builds by every third method for each of these.
    fn each(&self, start: &[Particle], mut see: impl FnMut(&[Vec3], &[Vec3], &str)) {
        let materials =
            [ContactMaterial { elasticity: None, friction: Some(Friction { static_: self.mu, kinetic: self.mu }) }];
        let planes: Vec<Plane> = self.plane.map(|normal| Plane { point: Vec3::ZERO, normal }).into_iter().collect();
        let forces = &Gravity { acceleration: self.gravity };
        for (i, (rate, substeps)) in STEPS.into_iter().enumerate() {
            for integrator in methods(i) {
                let colliders = &planes;
                let scene = Scene {
                    start,
                    materials: &materials,
                    forces,
                    colliders,
                    substeps,
                    constraints: &Contacts::HARD,
                    integrator: &integrator,
                    ..Scene::EMPTY
                };
                let mut system = started(&scene, start.len(), 1);
                run(&mut system, &scene, 1.0 / f64::from(rate), rate * self.seconds);
                let p = system.particles();
                see(p.position, p.velocity, &format!("{integrator}, {rate} steps of {substeps}, friction {}", self.mu));
            }
        }
    }
}

fn ball(position: Vec3, velocity: Vec3) -> Particle {
    Particle { position, velocity, radius: 0.1, elasticity: 0.0, material: Some(0), ..Particle::REST }
}

/// The normal of a slope of this tangent, down along x.
fn slope(tangent: f32) -> Vec3 {
    Vec3::new(tangent, 1.0, 0.0).normalize()
}

const DOWN: Vec3 = Vec3::new(0.0, -G as f32, 0.0);

#[test]
fn what_slides_on_a_plane_stops_after_its_way_and_stays() {
    for (mu, speed) in [(0.3, 5.0), (0.8, 2.0)] {
        let stage = Stage { mu, gravity: DOWN, plane: Some(Vec3::Y), seconds: 3 };
        let want = f64::from(speed) * f64::from(speed) / (2.0 * f64::from(mu) * G);
        stage.each(&[ball(Vec3::Y * 0.1, Vec3::X * speed)], |x, v, case| {
            let way = f64::from(x[0].x);
            // The step in which it stops ends up to a quarter of μ g h² early or late: 1.3 mm of 1/24 s.
            assert!((way / want - 1.0).abs() < 0.01, "{case}: {way}, {want}");
            assert!(v[0] == Vec3::ZERO, "{case}: {}", v[0]);
        });
    }
}

#[test]
fn what_rests_below_the_angle_of_friction_does_not_creep() {
    for (mu, tangent) in [(0.3, 0.29), (1.0, 0.5)] {
        let normal = slope(tangent);
        let start = [ball(normal * 0.1, Vec3::ZERO)];
        let stage = Stage { mu, gravity: DOWN, plane: Some(normal), seconds: 4 };
        stage.each(&start, |x, _, case| {
            let way = gap(f64s(x[0]), f64s(start[0].position));
            // To the rounding of a place in which it comes to touch.
            assert!(way < 1e-6, "{case}, slope {tangent}: {way}");
        });
    }
}

#[test]
fn what_is_on_too_steep_a_slope_slides_as_fast_as_friction_lets_it() {
    for (mu, tangent) in [(0.3, 0.35), (0.3, 1.0), (0.0, 0.5)] {
        let normal = slope(tangent);
        let stage = Stage { mu, gravity: DOWN, plane: Some(normal), seconds: 2 };
        let want = G * f64::from(normal.x - mu * normal.y) * 2.0;
        stage.each(&[ball(normal * 0.1, Vec3::ZERO)], |_, v, case| {
            let speed = f64::from(v[0].length());
            // Methods of first order may leave it in the air for the last step: a share of 1/48 of them at 24 steps a second.
            assert!((speed / want - 1.0).abs() < 0.025, "{case}, slope {tangent}: {speed}, {want}");
        });
    }
}

#[test]
fn a_hit_takes_as_much_of_the_slip_as_its_impulse_allows() {
    for (mu, elasticity, closing) in [(0.3, 0.5, 3.0), (0.5, 0.2, 1.0), (0.2, 1.0, 6.0)] {
        for height in [0.41, 0.4137, 0.42, 0.4285, 0.433] {
            let start = [Particle { elasticity, ..ball(Vec3::Y * height, Vec3::new(5.0, -closing, 0.0)) }];
            let stage = Stage { mu, gravity: Vec3::ZERO, plane: Some(Vec3::Y), seconds: 1 };
            let want = mu * (1.0 + elasticity) * closing;
            stage.each(&start, |_, v, case| {
                let [loss, bounce] = [5.0 - v[0].x, v[0].y];
                assert!((loss / want - 1.0).abs() < 1e-5, "{case}, from {height}: {loss}, {want}");
                assert!((bounce / (elasticity * closing) - 1.0).abs() < 1e-5, "{case}: {bounce}");
            });
        }
    }
    // A ball that is slow enough comes to rest along the surface, and no more.
    let start = [Particle { elasticity: 0.5, ..ball(Vec3::Y * 0.42, Vec3::new(1.0, -3.0, 0.0)) }];
    Stage { mu: 0.3, gravity: Vec3::ZERO, plane: Some(Vec3::Y), seconds: 1 }.each(&start, |_, v, case| {
        assert!(v[0].x.abs() < 1e-6 && (v[0].y - 1.5).abs() < 1e-5, "{case}: {}", v[0]);
    });
}

/// How far along a ball of a radius `r` (of both) something slides from its top: v v' = g sin θ − μ (g cos θ − v²/r).
fn way_on_ball(mu: f64, speed: f64, r: f64) -> f64 {
    let (mut s, mut v) = (0.0, speed);
    let h = 1e-5;
    while v > 0.0 {
        let angle: f64 = s / r;
        let a = G * angle.sin() - mu * (G * angle.cos() - v * v / r);
        s += h * (v + 0.5 * h * a).max(0.0);
        v += h * a;
    }
    r * (s / r).sin()
}

#[test]
fn what_slides_over_a_ball_stops_after_its_way() {
    for (mu, speed, radius) in [(0.3, 2.0, 50.0), (0.6, 3.0, 40.0)] {
        let below = Particle { radius, fixed: true, ..ball(Vec3::NEG_Y * radius, Vec3::ZERO) };
        let want = way_on_ball(f64::from(mu), f64::from(speed), f64::from(radius) + 0.1);
        // In either order of rows.
        for start in [[below, ball(Vec3::Y * 0.1, Vec3::X * speed)], [ball(Vec3::Y * 0.1, Vec3::X * speed), below]] {
            let row = usize::from(start[0].fixed);
            let stage = Stage { mu, gravity: DOWN, plane: None, seconds: 2 };
            stage.each(&start, |x, _, case| {
                let way = f64::from(x[row].x);
                // Explicit Euler leaves the ball along its tangent for all of a sub-step, of up to 1/24 s.
                let bound = if case.starts_with("euler") { 0.08 } else { 0.01 };
                assert!((way / want - 1.0).abs() < bound, "{case}: {way}, {want}");
            });
        }
    }
}

#[test]
fn what_rests_on_a_fixed_ball_does_not_creep() {
    for radius in [0.1, 5.0] {
        let start = [
            Particle { radius, fixed: true, ..ball(Vec3::ZERO, Vec3::ZERO) },
            ball(slope(0.25) * (radius + 0.1), Vec3::ZERO),
        ];
        Stage { mu: 0.3, gravity: DOWN, plane: None, seconds: 4 }.each(&start, |x, _, case| {
            let way = gap(f64s(x[1]), f64s(start[1].position));
            assert!(way < 2e-6, "{case} on a ball of {radius} m: {way}");
        });
    }
}

#[test]
fn what_drags_another_loses_what_that_gains() {
    // Pressed onto each other along x by opposite speeds, with slip along z: one impulse for both.
    for mass in [0.5, 1.0, 4.0] {
        let start = [
            Particle { mass, elasticity: 0.5, ..ball(Vec3::ZERO, Vec3::ZERO) },
            Particle { elasticity: 0.5, ..ball(Vec3::X * 0.21, Vec3::new(-3.0, 0.0, 0.5)) },
        ];
        Stage { mu: 0.1, gravity: Vec3::ZERO, plane: None, seconds: 1 }.each(&start, |_, v, case| {
            let total = v[0] * mass + v[1] - start[1].velocity;
            assert!(total.length() < 1e-5, "{case}: {total}");
            assert!(v[0].x * mass < -1.0, "{case}: {}", v[0]);
        });
    }
}
