//! A scene in which everything happens.

use crate::Form;
use pointmass::emit::Burst;
use pointmass::math::sin_cos_turns;
use pointmass::shape::{Cuboid, Disc, Plane, Sphere};
use pointmass::{
    Drag, Emitter, Gravity, Meetings, Method, MutualGravity, Particle, Scene, Size, Spread, Spring, Varied, Vec3,
};

type Nozzle = Emitter<Form>;

/// Two emitters with everything varied, the second fuller than any memory here.
pub fn emitters() -> (Nozzle, Nozzle) {
    let varied = |mean, half_width| Varied { mean, half_width };
    let disc = Form::Circle(Disc { center: Vec3::Y, normal: Vec3::Y, radius: 0.2 });
    let first = Emitter {
        speed: varied(3.0, 1.0),
        spread: Spread::Uniform(0.5),
        lifetime: varied(0.6, 0.3),
        drag: varied(0.2, 0.1),
        color_half_width: [9; 4],
        material: Some(3),
        ..Emitter::new(disc, 50.0)
    };
    let burst = Some(Burst { count: 10, at: 0.2, every: 0.5 });
    let sphere = Form::Sphere(Sphere { center: Vec3::new(0.5, 1.5, 0.0), radius: 0.1 });
    (first, Emitter { burst, lifetime: varied(0.3, 0.1), ..Emitter::new(sphere, 20.0) })
}

/// A ring of springs that hangs from a fixed particle; one of it dies.
fn ring() -> (Vec<Particle>, Vec<Spring>) {
    let place = |i: u32| {
        let (s, c) = sin_cos_turns(i as f32 / 8.0);
        Vec3::new(c, 1.5, s) * 0.5
    };
    let particle = |i| Particle {
        position: place(i),
        mass: 0.2,
        fixed: i == 0,
        lifetime: if i == 3 { 0.8 } else { 0.0 },
        ..Particle::REST
    };
    let spring = |i| Spring::new([i, (i + 1) % 8], 0.35, 30.0).damped(0.1);
    ((0..8).map(particle).collect(), (0..8).map(spring).collect())
}

/// Calls `act` with a scene in which everything happens: it needs 3 emitters, 8 springs and 5 columns.
pub fn busy<T>(act: impl FnOnce(&Scene<'_>) -> T) -> T {
    let (start, springs) = ring();
    let emitters = emitters();
    let forces = (Gravity::EARTH, Drag {}, MutualGravity { constant: 0.02, softening: 0.05, ..MutualGravity::NEWTON });
    let ground = Plane { point: Vec3::ZERO, normal: Vec3::new(0.1, 1.0, 0.0) };
    let box_ = Cuboid { min: Vec3::new(0.6, 0.2, -0.2), max: Vec3::new(0.9, 0.5, 0.2) };
    let sink = Sphere { center: Vec3::new(-0.4, 0.0, 0.0), radius: 0.3 };
    act(&Scene {
        start: &start,
        springs: &springs,
        emitters: &emitters,
        forces: &forces,
        colliders: &(ground, box_),
        materials: &(),
        constraints: &(),
        substeps: 1,
        paths: Scene::EMPTY.paths,
        meetings: Meetings::Through,
        max_bounces: Scene::EMPTY.max_bounces,
        sinks: &sink,
        reapers: &(),
        custom: &(),
        integrator: Method::Rk4.integrator(),
        index: &(),
    })
}

/// Memory for it that is too small for all its births.
pub const SIZE: Size = Size { particles: 30, emitters: 3, springs: 8, columns: 5, kept: 0 };
