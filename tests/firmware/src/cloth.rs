//! A cloth large enough for graphs and for rows that go eight side by side, as uneven as meshes get: a hub of many spokes with two rings around it,
//! a fin on an edge that three triangles share then, a tail one triangle wide, a triangle that is there twice, and a particle in none.

use pointmass::constrain::{Hinge, Shell, ShellParams};
use pointmass::force::Friction;
use pointmass::shape::Plane;
use pointmass::{ContactMaterial, Drag, Gravity, Inline, Particle, Scene, System, Time, Vec3, Verlet};

/// Spokes of the hub, and particles of each ring.
const SPOKES: usize = 18;
const TAIL: usize = 6;
/// The hub, both rings, the fin's corner, the tail, and one in no triangle.
const PARTICLES: usize = 1 + 2 * SPOKES + 1 + TAIL + 1;
/// The first of the outer ring, and the corner of the fin.
const OUTER: usize = 1 + SPOKES;
const FIN: usize = 1 + 2 * SPOKES;
const TRIANGLES: usize = 3 * SPOKES + 1 + TAIL + 1;
const HINGES: usize = 3 * TRIANGLES / 2;
const COLUMNS: usize = 192;
const KEPT: usize = 256;

/// What it needs, none of it on the stack.
pub(crate) struct Memory {
    start: [Particle; PARTICLES],
    places: [u32; PARTICLES],
    triangles: [[u32; 3]; TRIANGLES],
    hinges: [Hinge; HINGES],
    system: System<Inline<PARTICLES, 0, 0, COLUMNS, KEPT>>,
}

impl Memory {
    pub(crate) const fn new() -> Self {
        Self {
            start: [Particle { mass: 0.0, elasticity: 0.0, ..Particle::REST }; PARTICLES],
            places: [0; PARTICLES],
            triangles: [[0; 3]; TRIANGLES],
            hinges: [Hinge { edge: [0; 2], far: [0; 2], faces: [0; 2] }; HINGES],
            system: System::with(Inline::new()),
        }
    }
}

/// Calls `out` with the name of each and the hash after a fifth of a second: of one that bends easily, and of one that is as hard to bend as to
/// stretch. Both hang from a corner, and have been thrown onto the floor.
pub(crate) fn run(memory: &mut Memory, out: &mut dyn FnMut(&str, u64)) {
    let Memory { start, places, triangles, hinges, system } = memory;
    lay(start);
    places.iter_mut().enumerate().for_each(|(i, place)| *place = i as u32);
    mesh(triangles);
    let hinges = find(triangles, hinges);
    let materials =
        [ContactMaterial { elasticity: Some(0.1), friction: Some(Friction { static_: 0.5, kinetic: 0.4 }) }];
    let floor = Plane { point: Vec3::ZERO, normal: Vec3::Y };
    for (name, bending) in [("cloth", 1e-5), ("card", 0.05)] {
        let params = ShellParams { stretch: [300.0, 200.0], shear: 80.0, bending, damping: 1e-3 };
        let shell = Shell { particles: &places[..], triangles: &triangles[..], hinges, warp: Vec3::X, params };
        let scene = Scene {
            start,
            forces: &(Gravity::EARTH, Drag {}),
            colliders: &floor,
            materials: &materials,
            constraints: &shell,
            substeps: 3,
            integrator: &Verlet,
            ..Scene::EMPTY
        };
        system.start(&scene, 1).expect("there is memory for it");
        for frame in 1..=12 {
            system.step(&scene, Time::frame(frame, 60) - system.time());
        }
        out(name, system.hash());
    }
}

/// One of so many around the hub, where spokes are closer on one side than on the other, and so far from it.
fn round(i: usize, far: f32) -> Vec3 {
    // Halves of a square's rim, uneven enough; sines would be those of the host.
    let t = i as f32 / SPOKES as f32;
    let t = t * (0.6 + 0.4 * t) * 4.0;
    let [x, z] = match t as u32 {
        0 => [1.0 - t, t],
        1 => [1.0 - t, 2.0 - t],
        2 => [t - 3.0, 2.0 - t],
        _ => [t - 3.0, t - 4.0],
    };
    Vec3::new(x, 0.3 * x + 0.1 * z, z) * far
}

/// The particles: the hub's neighbours first, from one side to the other.
fn lay(start: &mut [Particle]) {
    let middle = Vec3::new(0.0, 0.35, 0.0);
    for (i, place) in start.iter_mut().enumerate() {
        let odd = (i * 7 % 10) as f32 * 0.1;
        let position = match i {
            0 => middle,
            1..=SPOKES => middle + round(i - 1, 0.2 + 0.03 * odd),
            FIN => middle + Vec3::new(0.15, 0.2, 0.12),
            OUTER..FIN => middle + round(i - OUTER, 0.4 + 0.05 * odd),
            _ => middle + Vec3::new(0.55 + 0.06 * (i - FIN) as f32, 0.15, if i % 2 == 0 { 0.05 } else { -0.05 }),
        };
        *place = Particle {
            position,
            velocity: Vec3::new(0.3 * odd, -3.0, 0.5 - odd),
            radius: 0.0,
            mass: 0.002 + 0.001 * odd,
            drag: 0.001 * odd,
            material: Some(0),
            fixed: i == OUTER,
            ..Particle::REST
        };
    }
}

fn mesh(triangles: &mut [[u32; 3]; TRIANGLES]) {
    for i in 0..SPOKES {
        let [this, next] = [1 + i, 1 + (i + 1) % SPOKES].map(|number| number as u32);
        let out = SPOKES as u32;
        triangles[3 * i] = [0, next, this];
        triangles[3 * i + 1] = [this, next, next + out];
        triangles[3 * i + 2] = [this, next + out, this + out];
    }
    let rest = &mut triangles[3 * SPOKES..];
    rest[0] = [1, 2, FIN as u32];
    // From two of the outer ring on.
    let mut last = [OUTER as u32, OUTER as u32 + 1];
    for (i, corners) in rest[1..=TAIL].iter_mut().enumerate() {
        let next = (FIN + 1 + i) as u32;
        *corners = if i % 2 == 0 { [last[0], last[1], next] } else { [last[1], last[0], next] };
        last = [last[1], next];
    }
    rest[TAIL + 1] = rest[TAIL];
}

/// The edges that two triangles share.
fn find<'h>(triangles: &[[u32; 3]], hinges: &'h mut [Hinge]) -> &'h [Hinge] {
    let sides = || {
        let of =
            |(face, &[a, b, c]): (usize, &[u32; 3])| [[a, b, c], [b, c, a], [c, a, b]].map(|side| (face as u32, side));
        triangles.iter().enumerate().flat_map(of)
    };
    let mut count = 0;
    for (face, [a, b, far]) in sides() {
        let same = |&(_, [c, d, _]): &(u32, [u32; 3])| [a, b] == [c, d] || [a, b] == [d, c];
        let mut others = sides().filter(same).filter(|&(other, _)| other != face);
        if let (Some((other, [.., across])), None) = (others.next(), others.next())
            && face < other
            && far != across
        {
            hinges[count] = Hinge { edge: [a, b], far: [far, across], faces: [face, other] };
            count += 1;
        }
    }
    &hinges[..count]
}
