//! Motion that every target computes alike: the firmware here, the host in `tests/tests/hashes.rs`.
//!
//! A charged sheet on springs, one that swings and some that break, and a balloon, moved through every force by every
//! method; then the same once more of a material that changes over their lives, and how they look.

use crate::drawing::{hash_lines, hash_solids, hash_sprites, hash_surface};
use pointmass::draw::{self, Knot, Patch, Ring, Trails, appearance};
use pointmass::force::{
    Coulomb, Curl, Drive, Gusts, LennardJones, Pressure, QuadraticDrag, Radial, Viscosity, Vortex, Wind,
};
use pointmass::index::InGrid;
use pointmass::material::{Blend, Curve, Facing, Heading, Life, Over, SpriteMaterial, TrailMaterial, Varying};
use pointmass::{
    ClothSprings, ContactMaterial, Drag, Fnv, Force, Gravity, Inline, Material, Method, Midpoint, Particle, Scene,
    Sheet, Spring, SpringParams, System, Time, Vec3,
};

/// The hashes in the form of `all` in `expected.rs`.
pub(crate) const EXPECTED: &str = include_str!("../../motion.txt");

const SHEET: Sheet = Sheet { corner: Vec3::new(-0.5, 0.0, -0.5), sides: [Vec3::X, Vec3::Z], cells: [5, 4] };
/// Particles and springs of the sheet.
const WOVEN: (usize, usize) = (6 * 5, 5 * 5 + 6 * 4 + 2 * 5 * 4 + 4 * 5 + 6 * 3);

/// The balloon is an octahedron: its corners, edges and faces.
const CORNERS: [Vec3; 6] = [Vec3::X, Vec3::NEG_X, Vec3::Y, Vec3::NEG_Y, Vec3::Z, Vec3::NEG_Z];
const EDGES: [[u32; 2]; 12] =
    [[0, 2], [0, 3], [0, 4], [0, 5], [1, 2], [1, 3], [1, 4], [1, 5], [2, 4], [2, 5], [3, 4], [3, 5]];
const FACES: [[u32; 3]; 8] = {
    let a = WOVEN.0 as u32;
    let [px, nx, py, ny, pz, nz] = [a, a + 1, a + 2, a + 3, a + 4, a + 5];
    [[px, py, pz], [py, nx, pz], [nx, ny, pz], [ny, px, pz], [py, px, nz], [nx, py, nz], [ny, nx, nz], [px, ny, nz]]
};

const PARTICLES: usize = WOVEN.0 + CORNERS.len();
const SPRINGS: usize = WOVEN.1 + EDGES.len();
/// Particles whose trails there is memory for; those of all others are counted.
const TRAILS: usize = 8;
const COLUMNS: usize = 24;
/// The columns that materials change.
const KEPT: usize = 2;

const fn curve(keys: &'static [[f32; 2]], smooth: bool) -> Curve<'static> {
    Curve { keys, over: Over::Life, smooth }
}

const fn plain(keys: &'static [[f32; 2]], smooth: bool) -> Option<Varying<'static>> {
    Some(Varying { from: curve(keys, smooth), to: None })
}

/// A material of which everything changes, drawn with a flipbook that faces so, or as a shape, and with a trail.
const fn aging(facing: Facing) -> Material<'static> {
    let sprite = SpriteMaterial { frames: 6, rate: 7.5, blend: Blend::Alpha, facing };
    let heading = match facing {
        Facing::Camera => Heading::Upright,
        Facing::Velocity => Heading::Velocity,
        Facing::Free => Heading::Free,
    };
    let trail = TrailMaterial { seconds: 0.1, width: 0.02 };
    Material { size: 0.1, sprite: Some(sprite), heading: Some(heading), trail: Some(trail), ..AGING }
}

const AGING: Material<'static> = Material {
    life: Life {
        size: plain(&[[0.0, 0.1], [0.2, 1.0], [0.7, 0.6]], true),
        color: Some(Varying {
            from: Curve { keys: &[[0.0, 1.0, 0.9, 0.2], [1.2, 0.4, 0.1, 0.0]], over: Over::Seconds, smooth: false },
            to: None,
        }),
        opacity: Some(Varying {
            from: curve(&[[0.0, 1.0], [1.0, 0.0]], false),
            to: Some(curve(&[[0.0, 0.5], [0.5, 0.7], [1.0, 0.1]], true)),
        }),
        glow: plain(&[[0.1, 0.9], [0.6, 0.2], [0.9, 0.3]], true),
        rotation: Some(Varying {
            from: curve(&[[0.0, 0.0]], false),
            to: Some(curve(&[[0.0, 1.0], [1.0, 7.0]], false)),
        }),
        drag: plain(&[[0.0, 3.0], [0.4, 1.0], [0.8, 2.5]], true),
        mass: plain(&[[0.0, 1.0], [1.0, 0.6]], false),
        buoyancy: plain(&[[0.0, 0.0], [0.3, 1.3], [1.0, 0.9]], true),
    },
    ..Material::of(ContactMaterial { elasticity: None, friction: None })
};

/// Everything that they need, none of it on the stack.
pub(crate) struct Memory {
    start: [Particle; PARTICLES],
    springs: [Spring; SPRINGS],
    system: System<Inline<PARTICLES, 0, SPRINGS, COLUMNS, KEPT>>,
}

impl Memory {
    pub(crate) const fn new() -> Self {
        Self {
            start: [Particle { mass: 0.0, elasticity: 0.0, ..Particle::REST }; PARTICLES],
            springs: [Spring::new([0; 2], 0.0, 0.0); SPRINGS],
            system: System::with(Inline::new()),
        }
    }
}

/// Calls `out` with the name of each method and the hash after a second and a half, or half a second by the one that takes many steps to a frame.
pub(crate) fn run(memory: &mut Memory, out: &mut dyn FnMut(&str, u64)) {
    let Memory { start, springs, system } = memory;
    tie(start, springs);
    blow(&mut start[WOVEN.0..], &mut springs[WOVEN.1..]);
    for method in Method::ALL {
        let scene = Scene { start, springs, forces: &forces(), integrator: method, index: &InGrid, ..Scene::EMPTY };
        system.start(&scene, 1).expect("there is memory for it");
        let frames = if *method == Method::Adaptive { 30 } else { 90 };
        for frame in 1..=frames {
            system.step(&scene, Time::frame(frame, 60) - system.time());
        }
        out(method.name(), system.hash());
    }
    out("lives", grow_old(start, springs, system));
}

/// The hash of the same by midpoint over most of their lives, and of how they look then.
fn grow_old(
    start: &mut [Particle],
    springs: &[Spring],
    system: &mut System<Inline<PARTICLES, 0, SPRINGS, COLUMNS, KEPT>>,
) -> u64 {
    for (number, particle) in start.iter_mut().enumerate() {
        (particle.material, particle.lifetime) = (Some(number as u16 % 3), 1.5 + 0.125 * (number % 5) as f32);
    }
    let (forces, materials) = (&forces(), &[Facing::Free, Facing::Velocity, Facing::Camera].map(aging));
    let base = Scene { start, forces, integrator: &Midpoint, index: &InGrid, materials, ..Scene::EMPTY };
    let scene = Scene { springs: &springs, ..base };
    let mut hash = Fnv::new();
    let (mut rings, mut knots) = ([Ring::NONE; TRAILS], [Knot::NONE; 6 * TRAILS]);
    let mut trails = Trails::new(&mut rings, &mut knots, None);
    system.start(&scene, 1).expect("there is memory for it");
    for frame in 1..=88 {
        system.step(&scene, Time::frame(frame, 60) - system.time());
        let state = system.state(&scene);
        for look in (0..system.len()).filter_map(|row| appearance(&state, row)) {
            [look.diameter, look.scale, look.glow, look.rotation].into_iter().for_each(|x| hash.float(x));
            hash.bytes(&look.color);
        }
        hash_sprites::<PARTICLES>(&state, &mut hash);
        hash.long(trails.look(&state) as u64);
        hash_lines(|into| trails.lines(&state, into), &mut hash);
        hash_lines(|into| draw::springs(&state, 0.2, into), &mut hash);
        hash_lines(|into| draw::velocities(&state, 0.1, into), &mut hash);
        hash_lines(|into| draw::links(&state, EDGES.into_iter(), [255; 4], into), &mut hash);
        hash_solids::<PARTICLES>(&state, &mut hash);
        let own = FACES.map(|face| face.map(|corner| corner - WOVEN.0 as u32));
        let balloon = Patch { first: WOVEN.0 as u32, count: CORNERS.len() as u32, triangles: &own };
        hash_surface::<{ CORNERS.len() }, { FACES.len() }>(&state, &balloon, &mut hash);
    }
    hash.long(system.hash());
    hash.finish()
}

fn forces() -> impl Force {
    let field = (
        Gusts { velocity: Vec3::X * 2.0, amplitude: 0.5, frequency: 0.8 },
        Vortex { center: Vec3::ZERO, axis: Vec3::Y, speed: 1.0, core: 0.4 },
        Curl { speed: 1.0, scale: 0.7, drift: Vec3::Z, seed: 3 },
    );
    let air = (Wind { field, coefficient: Some(0.004) }, QuadraticDrag { coefficient: 0.002 }, Drag {});
    let near =
        (Radial(LennardJones { epsilon: 1e-4, sigma: 0.15, cutoff: 0.4 }), Viscosity { coefficient: 5.0, reach: 0.4 });
    let charge = Coulomb { softening: 0.05, ..Coulomb::default() };
    (Gravity::EARTH, air, near, charge, Pressure { triangles: FACES, amount: 0.02, outside: 0.5 })
}

fn tie(start: &mut [Particle], springs: &mut [Spring]) {
    let thread = |ks| Some(SpringParams { ks, kd: 0.05 });
    let threads = ClothSprings { structural: thread(40.0), shear: thread(20.0), bend: thread(2.0) };
    let like = Particle { mass: 0.02, drag: 0.01, ..Particle::REST };
    for ((row, place), particle) in (0..).zip(start.iter_mut()).zip(SHEET.particles(like)) {
        let charge = if row % 2 == 0 { 1e-7 } else { -1e-7 };
        *place = Particle { charge, fixed: row == 0 || row == 5, ..particle };
    }
    for ((number, place), spring) in (0..).zip(springs.iter_mut()).zip(SHEET.springs(&threads, 0)) {
        let drive = (number == 7).then_some(Drive { amplitude: 0.3, frequency: 1.7, phase: 0.1 });
        *place = Spring { drive, breaks_at: (number % 9 == 0).then_some(1.25), ..spring };
    }
}

fn blow(start: &mut [Particle], springs: &mut [Spring]) {
    let middle = Vec3::new(0.3, 1.0, 0.2);
    for (place, corner) in start.iter_mut().zip(CORNERS) {
        *place = Particle { position: middle + corner * 0.2, mass: 0.01, drag: 0.005, ..Particle::REST };
    }
    for (place, edge) in springs.iter_mut().zip(EDGES) {
        *place = Spring::new(edge.map(|corner| WOVEN.0 as u32 + corner), 0.28, 10.0).damped(0.02);
    }
}
