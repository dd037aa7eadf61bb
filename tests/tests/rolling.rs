//! What is round and rough rolls down a slope without slipping, as slowly as its inertia says: g sin α / (1 + I / (m r²)).

use pointmass::force::Friction;
use pointmass::shape::Plane;
use pointmass::{ContactMaterial, Contacts, Gravity, Method, Particle, Scene, ShapeMatching, Time, Vec3};
use pointmass_tests::{is_run, started};

const G: f32 = 9.81;

/// A drum: two rings of balls that are held together and do not spin, of radius 1 with so many balls each of such a radius.
fn drum(count: u32, ball: f32, up: Vec3, down: Vec3) -> Vec<Particle> {
    let (axis, part) =
        (up.cross(down), Particle { radius: ball, elasticity: 0.0, material: Some(0), ..Particle::REST });
    let place = |i: u32| {
        let (sin, cos) = (core::f32::consts::TAU * (i / 2) as f32 / count as f32).sin_cos();
        up * (1.0 + ball - cos) + down * sin + axis * if i.is_multiple_of(2) { -0.5 } else { 0.5 }
    };
    (0..2 * count).map(|i| Particle { position: place(i), ..part }).collect()
}

/// A drum, a slope, and how long steps are.
struct Roll {
    degrees: f32,
    size: f32,
    method: Method,
    substeps: u32,
    /// The balls of a rim, and how large each is, in radii of the drum.
    count: u32,
    ball: f32,
}

impl Roll {
    /// Rolls for a fifth of a turn, in the time that its inertia takes, with `constraints` that hold it together.
    fn goes_as_its_inertia_says(&self, name: &str, contacts: Option<Contacts>) {
        let Self { degrees, size, method, substeps, count, ball } = *self;
        let (sin, cos) = degrees.to_radians().sin_cos();
        let (up, down) = (Vec3::new(sin, cos, 0.0), Vec3::new(cos, -sin, 0.0));
        let mut start = drum(count, ball, up, down);
        for particle in &mut start {
            (particle.position, particle.radius) = (particle.position * size, particle.radius * size);
        }
        let begun = up * ((1.0 + ball) * size);
        let body = ShapeMatching::rigid((0..start.len() as u32).collect::<Vec<_>>());
        let constraints = (&body, contacts);
        let mu = Friction { static_: 0.8, kinetic: 0.8 };
        let materials = [ContactMaterial { elasticity: None, friction: Some(mu) }];
        let slope = Plane { point: Vec3::ZERO, normal: up };
        // Gravity grows with the size, so that all of them take as long.
        let scene = Scene {
            start: &start,
            forces: &Gravity { acceleration: Vec3::NEG_Y * (G * size) },
            colliders: &slope,
            materials: &materials,
            constraints: &constraints,
            substeps,
            integrator: method.integrator(),
            ..Scene::EMPTY
        };
        let mut system = started(&scene, start.len(), 0);
        // All of its mass is as far from the axis as it rolls.
        let acceleration = 0.5 * G * sin;
        // As long as it takes for a fifth of a turn.
        let frames = (60.0 * (2.0 * 0.2 * core::f32::consts::TAU / acceleration).sqrt()).round() as u64;
        for frame in 1..=frames {
            system.step_to(&scene, Time::frame(frame, 60));
        }
        let places = system.particles().position;
        let middle = places.iter().sum::<Vec3>() / places.len() as f32;
        let (way, time) = ((middle - begun).dot(down) / size, frames as f32 / 60.0);
        let right = 0.5 * acceleration * time * time;
        let name = format!("{name}: {count} of {ball}, {degrees}°, {size} m, {method}, {substeps}");
        assert!((way / right - 1.0).abs() < 0.05, "{name}: {way} radii for {right}");
        // It has turned as far as it has gone: about the centres of balls, or about where these touch the slope.
        let arm = (places[0] + places[1]) * 0.5 - middle;
        let rolled = way / (-arm.dot(down)).atan2(-arm.dot(up));
        assert!((0.98..1.01 + 2.0 * ball).contains(&rolled), "{name}: {rolled} radii for each radian");
        assert!((middle - begun).dot(up).abs() < 0.01 * size, "{name}: it stays on the slope");
    }
}

const ROLLS: [Roll; 4] = [
    Roll { degrees: 10.0, size: 0.2, method: Method::Symplectic, substeps: 20, count: 48, ball: 0.05 },
    Roll { degrees: 20.0, size: 0.01, method: Method::Verlet, substeps: 10, count: 48, ball: 0.05 },
    Roll { degrees: 5.0, size: 30.0, method: Method::Rk4, substeps: 20, count: 48, ball: 0.05 },
    Roll { degrees: 25.0, size: 1.0, method: Method::Midpoint, substeps: 40, count: 48, ball: 0.05 },
];

/// Balls on the rim make a drum that is nearly round: as it goes on, it loses a little at each. Balls do not spin by themselves.
#[test]
fn a_drum_of_balls_rolls_as_its_inertia_says() {
    for roll in ROLLS {
        roll.goes_as_its_inertia_says("held apart", Some(Contacts::HARD));
        roll.goes_as_its_inertia_says("by itself", None);
    }
}

/// Points on the rim, and balls that overlap: however small or large, and in few sub-steps.
#[test]
fn a_drum_of_points_rolls_as_its_inertia_says() {
    let mut cases = 0;
    for (count, ball) in [(256, 0.0), (128, 0.0), (64, 0.08)] {
        for roll in ROLLS {
            for substeps in [5, 20] {
                if !is_run(&mut cases) {
                    continue;
                }
                let roll = Roll { count, ball, substeps, ..roll };
                roll.goes_as_its_inertia_says("by itself", None);
                roll.goes_as_its_inertia_says("with contacts", Some(Contacts::HARD));
            }
        }
    }
}
