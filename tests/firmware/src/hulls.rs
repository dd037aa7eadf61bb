//! Rigid bodies that are no boxes: a wedge and a longish octahedron are thrown onto the floor with a box and two balls.

use pointmass::constrain::{Hull, HullEdge, HullFace, RigidBodies, RigidBox};
use pointmass::force::Friction;
use pointmass::shape::Plane;
use pointmass::{ContactMaterial, Gravity, Inline, Particle, Scene, System, Time, Vec3, Verlet};

/// A prism over a triangle whose slanted sides rise by 3 in 4, about its centroid.
pub(crate) const WEDGE: Hull<'static> = Hull {
    center: Vec3::ZERO,
    corners: &[
        Vec3::new(0.24, -0.1, 0.0),
        Vec3::new(-0.12, -0.1, -0.27),
        Vec3::new(-0.12, -0.1, 0.27),
        Vec3::new(0.24, 0.1, 0.0),
        Vec3::new(-0.12, 0.1, -0.27),
        Vec3::new(-0.12, 0.1, 0.27),
    ],
    faces: &[
        HullFace { normal: Vec3::NEG_Y, offset: 0.1, first: 0, count: 3 },
        HullFace { normal: Vec3::Y, offset: 0.1, first: 3, count: 3 },
        HullFace { normal: Vec3::NEG_X, offset: 0.12, first: 6, count: 4 },
        HullFace { normal: Vec3::new(0.6, 0.0, -0.8), offset: 0.144, first: 10, count: 4 },
        HullFace { normal: Vec3::new(0.6, 0.0, 0.8), offset: 0.144, first: 14, count: 4 },
    ],
    loops: &[0, 2, 1, 3, 4, 5, 1, 2, 5, 4, 0, 1, 4, 3, 2, 0, 3, 5],
    edges: &[
        edge([0, 1], [3, 0]),
        edge([1, 2], [2, 0]),
        edge([2, 0], [4, 0]),
        edge([3, 4], [1, 3]),
        edge([4, 5], [1, 2]),
        edge([5, 3], [1, 4]),
        edge([0, 3], [4, 3]),
        edge([1, 4], [3, 2]),
        edge([2, 5], [2, 4]),
    ],
};

/// An octahedron twice as long as it is wide: each face has a normal of (1, 2, 2) / 3, but for signs.
pub(crate) const SPINDLE: Hull<'static> = Hull {
    center: Vec3::ZERO,
    corners: &[
        Vec3::new(0.24, 0.0, 0.0),
        Vec3::new(-0.24, 0.0, 0.0),
        Vec3::new(0.0, 0.12, 0.0),
        Vec3::new(0.0, -0.12, 0.0),
        Vec3::new(0.0, 0.0, 0.12),
        Vec3::new(0.0, 0.0, -0.12),
    ],
    faces: &[
        slant([1.0, 1.0, 1.0], 0),
        slant([-1.0, 1.0, 1.0], 3),
        slant([-1.0, -1.0, 1.0], 6),
        slant([1.0, -1.0, 1.0], 9),
        slant([1.0, 1.0, -1.0], 12),
        slant([-1.0, 1.0, -1.0], 15),
        slant([-1.0, -1.0, -1.0], 18),
        slant([1.0, -1.0, -1.0], 21),
    ],
    loops: &[0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4, 2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5],
    edges: &[
        edge([0, 2], [0, 4]),
        edge([2, 1], [1, 5]),
        edge([1, 3], [2, 6]),
        edge([3, 0], [3, 7]),
        edge([2, 4], [0, 1]),
        edge([1, 4], [1, 2]),
        edge([3, 4], [2, 3]),
        edge([0, 4], [3, 0]),
        edge([2, 5], [5, 4]),
        edge([1, 5], [6, 5]),
        edge([3, 5], [7, 6]),
        edge([0, 5], [4, 7]),
    ],
};

const fn edge(ends: [u8; 2], faces: [u8; 2]) -> HullEdge {
    HullEdge { ends, faces }
}

const fn slant([x, y, z]: [f32; 3], first: u16) -> HullFace {
    HullFace { normal: Vec3::new(x / 3.0, y * 2.0 / 3.0, z * 2.0 / 3.0), offset: 0.08, first, count: 3 }
}

/// Three bodies of eight, and two balls.
const PARTICLES: usize = 26;
const BALLS: usize = 2;
const COLUMNS: usize = 192;
const KEPT: usize = 131;

/// What they need, none of it on the stack.
pub(crate) struct Memory {
    start: [Particle; PARTICLES],
    system: System<Inline<PARTICLES, 0, 0, COLUMNS, KEPT>>,
}

impl Memory {
    pub(crate) const fn new() -> Self {
        Self {
            start: [Particle { mass: 0.0, elasticity: 0.0, ..Particle::REST }; PARTICLES],
            system: System::with(Inline::new()),
        }
    }
}

/// Calls `out` with the name and the hash after a second and a half.
pub(crate) fn run(memory: &mut Memory, out: &mut dyn FnMut(&str, u64)) {
    let Memory { start, system } = memory;
    let turned = |body: RigidBox, turn: [f32; 4]| RigidBox { turn, ..body };
    let boxes = [
        turned(RigidBox::with_hull(&WEDGE, 0, Vec3::new(0.0, 0.35, 0.0), 0), [0.1, 0.2, 0.3, 0.9]),
        turned(RigidBox::with_hull(&SPINDLE, 1, Vec3::new(0.05, 0.8, 0.1), 8), [0.5, -0.3, 0.1, 0.7]),
        turned(RigidBox::new(Vec3::new(0.15, 0.1, 0.12), Vec3::new(0.1, 1.2, -0.05), 16), [0.0, 0.4, 0.2, 0.8]),
    ];
    throw(start, &boxes);
    let bodies = RigidBodies { boxes, hulls: [WEDGE, SPINDLE], balls: BALLS as u32 };
    let materials = [ContactMaterial { elasticity: None, friction: Some(Friction { static_: 0.7, kinetic: 0.6 }) }];
    let scene = Scene {
        start,
        forces: &Gravity::EARTH,
        colliders: &Plane { point: Vec3::ZERO, normal: Vec3::Y },
        materials: &materials,
        constraints: &bodies,
        substeps: 6,
        integrator: &Verlet,
        ..Scene::EMPTY
    };
    system.start(&scene, 1).expect("there is memory for it");
    for frame in 1..=90 {
        system.step(&scene, Time::frame(frame, 60) - system.time());
    }
    out("hulls", system.hash());
}

/// The bodies' particles, each body in a spin of its own, then the balls.
fn throw(start: &mut [Particle], boxes: &[RigidBox; 3]) {
    let like = Particle { mass: 0.6, elasticity: 0.3, material: Some(0), ..Particle::REST };
    let members = [
        boxes[0].solid_hull(&WEDGE, like),
        boxes[1].solid_hull(&SPINDLE, Particle { mass: 0.3, ..like }),
        boxes[2].solid(Particle { mass: 0.8, elasticity: 0.1, ..like }),
    ];
    let spins = [Vec3::new(1.0, -1.0, 0.5), Vec3::new(-1.0, 2.0, 1.0), Vec3::new(0.5, 3.0, -1.0)];
    for (i, (place, member)) in start.iter_mut().zip(members.into_iter().flatten()).enumerate() {
        let velocity = spins[i / 8].cross(member.position - boxes[i / 8].center);
        *place = Particle { velocity, ..member };
    }
    for (i, place) in start[PARTICLES - BALLS..].iter_mut().enumerate() {
        let position = Vec3::new(0.12 - 0.2 * i as f32, 0.6 + 0.5 * i as f32, 0.1);
        *place = Particle { position, radius: 0.06, mass: 0.1, elasticity: 0.7, material: Some(0), ..Particle::REST };
    }
}
