//! Contacts that every target computes alike: the firmware here, the host in `tests/tests/hashes.rs`.
//!
//! Balls of many sizes, one of them pinned, fall through each other's way into a room, rub and bounce: by each response,
//! with an index and without.

use pointmass::force::{Friction, QuadraticDrag, Uniform, Wind};
use pointmass::index::{IndexChoice, Structure};
use pointmass::scene::Position;
use pointmass::shape::{Collider, Cuboid, Plane};
use pointmass::{
    ContactMaterial, Drag, Force, Gravity, Inline, Meetings, Particle, Penalty, Response, Scene, System, Time, Vec3,
};

/// The hashes in the form of `all` in `expected.rs`.
pub(crate) const EXPECTED: &str = include_str!("../../contacts.txt");

const ACROSS: usize = 4;
const PARTICLES: usize = ACROSS * ACROSS * ACROSS;
const COLUMNS: usize = 96;

/// Everything that they need, none of it on the stack.
pub(crate) struct Memory {
    start: [Particle; PARTICLES],
    system: System<Inline<PARTICLES, 0, 0, COLUMNS>>,
}

impl Memory {
    pub(crate) const fn new() -> Self {
        Self {
            start: [Particle { mass: 0.0, elasticity: 0.0, ..Particle::REST }; PARTICLES],
            system: System::with(Inline::new()),
        }
    }
}

const ROOM: Cuboid = Cuboid { min: Vec3::ZERO, max: Vec3::new(1.72, 3.0, 1.72) };

const PENALTY: Penalty =
    Penalty { stiffness: 500.0, damping: 0.1, friction: Friction { static_: 0.3, kinetic: 0.3 }, reach: 0.4 };

/// The responses by the names of their hashes, without an index and with one.
const RESPONSES: [([&str; 2], Response); 3] = [
    (["impulse", "impulse_grid"], Response::Impulse {}),
    (["force", "force_grid"], Response::Force(PENALTY)),
    (["position", "position_grid"], Response::Position(Position { substeps: 8, compliance: 1e-6 })),
];

/// Calls `out` with the name of each and the hash after a quarter of a second.
pub(crate) fn run(memory: &mut Memory, out: &mut dyn FnMut(&str, u64)) {
    let Memory { start, system } = memory;
    heap(start);
    let materials =
        [ContactMaterial { elasticity: Some(0.8), friction: Some(Friction { static_: 0.5, kinetic: 0.4 }) }];
    for (names, response) in &RESPONSES {
        let push = if let Response::Force(penalty) = response { *penalty } else { Penalty::NONE };
        let forces: &dyn Force = &(Gravity::EARTH, push);
        let indices: [&dyn IndexChoice; 2] = [&(), &Structure::Grid];
        for (name, index) in names.iter().zip(indices) {
            let scene = Scene {
                start,
                forces,
                colliders: &ROOM,
                materials: &materials,
                constraints: &response.contacts(),
                substeps: response.substeps(),
                meetings: response.meetings(),
                index,
                ..Scene::EMPTY
            };
            system.start(&scene, 1).expect("there is memory for it");
            for frame in 1..=15 {
                system.step(&scene, Time::frame(frame, 60) - system.time());
            }
            out(name, system.hash());
        }
    }
    in_air(start, system, &materials, out);
}

/// The same with drag and wind over a floor alone, where a host takes many side by side, and in the room, where they meet.
fn in_air(
    start: &mut [Particle],
    system: &mut System<Inline<PARTICLES, 0, 0, COLUMNS>>,
    materials: &[ContactMaterial; 1],
    out: &mut dyn FnMut(&str, u64),
) {
    start.iter_mut().for_each(|ball| ball.drag = 2.5 * ball.mass * ball.radius);
    let wind = Wind { field: Uniform { velocity: Vec3::new(0.5, 0.0, -0.25) }, coefficient: Some(0.5) };
    let floor = Plane { point: Vec3::ZERO, normal: Vec3::Y };
    let drag: &dyn Force = &(Gravity::EARTH, Drag {});
    let gale: &dyn Force = &(wind, Gravity::EARTH, QuadraticDrag { coefficient: 0.125 });
    let airs: [(&str, &dyn Force, &dyn Collider, Meetings); 4] = [
        ("drag", drag, &floor, Meetings::Through),
        ("drag_meetings", drag, &ROOM, Meetings::IMPULSE),
        ("wind", gale, &floor, Meetings::Through),
        ("wind_meetings", gale, &ROOM, Meetings::IMPULSE),
    ];
    for (name, forces, colliders, meetings) in airs {
        let scene = Scene { start, forces, colliders, materials, meetings, ..Scene::EMPTY };
        system.start(&scene, 1).expect("there is memory for it");
        for frame in 1..=15 {
            system.step(&scene, Time::frame(frame, 60) - system.time());
        }
        out(name, system.hash());
    }
}

/// A lattice of balls, all a little different.
fn heap(start: &mut [Particle]) {
    let along = |i: usize| (i % ACROSS) as f32 * 0.42 + 0.22;
    for (i, place) in start.iter_mut().enumerate() {
        let odd = (i * 7 % 10) as f32 * 0.1;
        *place = Particle {
            position: Vec3::new(along(i), along(i / (ACROSS * ACROSS)) + 0.2, along(i / ACROSS))
                + Vec3::new(odd, -odd, odd) * 0.02,
            velocity: Vec3::new(odd - 0.5, -2.0 * odd, 0.3) * 2.0,
            radius: 0.12 + 0.08 * odd,
            mass: 0.5 + odd,
            elasticity: 0.9 - 0.5 * odd,
            material: Some((i % 2) as u16),
            fixed: i == 5,
            ..Particle::REST
        };
    }
}
