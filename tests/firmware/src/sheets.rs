//! Sheets in the wind and on each other: a flag whose triangles the air pushes, as a shell and on springs; and a strip that stands on the floor
//! and folds onto itself while a sheet falls on both.

use pointmass::constrain::{Hinge, SheetContacts, Shell, ShellParams};
use pointmass::force::{Aerodynamics, Curl, Friction, Gusts};
use pointmass::integrate::Implicit;
use pointmass::shape::Plane;
use pointmass::{
    ClothSprings, ContactMaterial, Gravity, Inline, Particle, Scene, Sheet, Spring, SpringParams, System, Time, Vec3,
    Verlet,
};

/// Six rows of five, held along the first of each.
const FLAG: Sheet = Sheet {
    corner: Vec3::new(0.0, 1.0, 0.0),
    sides: [Vec3::new(0.4, 0.02, 0.05), Vec3::new(0.03, -0.45, 0.0)],
    cells: [4, 5],
};
const STRIP: Sheet = Sheet {
    corner: Vec3::new(0.0, 0.02, 0.0),
    sides: [Vec3::new(0.12, 0.01, 0.0), Vec3::new(0.0, 0.5, 0.15)],
    cells: [1, 8],
};
const COVER: Sheet = Sheet {
    corner: Vec3::new(-0.15, 0.62, -0.15),
    sides: [Vec3::new(0.4, 0.05, 0.0), Vec3::new(0.02, -0.05, 0.4)],
    cells: [3, 3],
};
const THICK: [f32; 1] = [0.02];

const PARTICLES: usize = 34;
const TRIANGLES: usize = 40;
const HINGES: usize = 51;
const SPRINGS: usize = 49;
const COLUMNS: usize = 290;
const KEPT: usize = 91;

const _: () = assert!(points(FLAG) <= PARTICLES && points(STRIP) + points(COVER) == PARTICLES);

/// What they need, none of it on the stack.
pub(crate) struct Memory {
    start: [Particle; PARTICLES],
    places: [u32; PARTICLES],
    triangles: [[u32; 3]; TRIANGLES],
    hinges: [Hinge; HINGES],
    springs: [Spring; SPRINGS],
    system: System<Inline<PARTICLES, 0, SPRINGS, COLUMNS, KEPT>>,
}

impl Memory {
    pub(crate) const fn new() -> Self {
        Self {
            start: [Particle { mass: 0.0, elasticity: 0.0, ..Particle::REST }; PARTICLES],
            places: [0; PARTICLES],
            triangles: [[0; 3]; TRIANGLES],
            hinges: [Hinge { edge: [0; 2], far: [0; 2], faces: [0; 2] }; HINGES],
            springs: [Spring::new([0; 2], 0.0, 0.0); SPRINGS],
            system: System::with(Inline::new()),
        }
    }
}

/// Calls `out` with the name of each and the hash after less than half a second.
pub(crate) fn run(memory: &mut Memory, out: &mut dyn FnMut(&str, u64)) {
    memory.places.iter_mut().enumerate().for_each(|(i, place)| *place = i as u32);
    fly(memory, out);
    fold(memory, out);
}

/// A flag in gusts: as a shell, and on springs by the implicit method, which asks for the slope of the air's push.
fn fly(memory: &mut Memory, out: &mut dyn FnMut(&str, u64)) {
    let Memory { start, places, triangles, hinges, springs, system } = memory;
    let start = &mut start[..points(FLAG)];
    for (i, (place, position)) in start.iter_mut().zip(FLAG.positions()).enumerate() {
        let mass = 0.002 + 0.0003 * (i % 4) as f32;
        let column = i as u32 % (FLAG.cells[0] + 1);
        *place = Particle { position, mass, fixed: column == 0, ..Particle::REST };
    }
    let (faces, folds) = net(&[FLAG], triangles, hinges);
    let threads = ClothSprings { structural: Some(SpringParams { ks: 80.0, kd: 0.01 }), ..ClothSprings::default() };
    springs.iter_mut().zip(FLAG.springs(&threads, 0)).for_each(|(to, from)| *to = from);
    let breeze = (
        Gusts { velocity: Vec3::new(5.0, 0.0, 1.5), amplitude: 0.5, frequency: 1.2 },
        Curl { speed: 1.0, scale: 0.3, drift: Vec3::X * 4.0, seed: 5 },
    );
    let air = Aerodynamics { lift: 1.0, friction: 0.02, ..Aerodynamics::still(faces) }.within(breeze);
    let forces = &(Gravity::EARTH, air);
    let params = ShellParams { stretch: [300.0, 200.0], shear: 40.0, bending: 2e-5, damping: 1e-3 };
    let particles = &places[..start.len()];
    let shell = Shell { particles, triangles: faces, hinges: folds, warp: Vec3::X, params };
    let base = Scene { start, forces, ..Scene::EMPTY };
    let flag = Scene { constraints: &shell, substeps: 3, integrator: &Verlet, ..base };
    let sail = Scene { springs: &&springs[..], integrator: &Implicit::USUAL, ..base };
    for (name, scene) in [("flag", flag), ("sail", sail)] {
        out(name, last(system, &scene, 24));
    }
}

/// A strip that folds onto itself, and a sheet that falls on it.
fn fold(memory: &mut Memory, out: &mut dyn FnMut(&str, u64)) {
    let Memory { start, places, triangles, hinges, system, .. } = memory;
    for (i, (place, position)) in start.iter_mut().zip(STRIP.positions().chain(COVER.positions())).enumerate() {
        let odd = (i * 7 % 10) as f32 * 0.1;
        let velocity = Vec3::new(0.1 * odd, -0.3, 0.2 - 0.3 * odd);
        *place = Particle { position, velocity, mass: 0.002 + 0.001 * odd, material: Some(0), ..Particle::REST };
    }
    let (faces, folds) = net(&[STRIP, COVER], triangles, hinges);
    let params = ShellParams { stretch: [300.0, 200.0], shear: 60.0, bending: 2e-5, damping: 2e-3 };
    let shell = Shell { particles: &places[..], triangles: faces, hinges: folds, warp: Vec3::X, params };
    let contacts = SheetContacts { particles: &places[..], triangles: faces, thickness: THICK };
    let materials =
        [ContactMaterial { elasticity: Some(0.1), friction: Some(Friction { static_: 0.4, kinetic: 0.3 }) }];
    let scene = Scene {
        start,
        forces: &Gravity::EARTH,
        colliders: &Plane { point: Vec3::ZERO, normal: Vec3::Y },
        materials: &materials,
        constraints: &(shell, contacts),
        substeps: 4,
        integrator: &Verlet,
        ..Scene::EMPTY
    };
    out("layers", last(system, &scene, 20));
}

/// The hash after so many 60ths of a second.
fn last(system: &mut System<Inline<PARTICLES, 0, SPRINGS, COLUMNS, KEPT>>, scene: &Scene<'_>, frames: u64) -> u64 {
    system.start(scene, 1).expect("there is memory for it");
    for frame in 1..=frames {
        system.step(scene, Time::frame(frame, 60) - system.time());
    }
    system.hash()
}

/// The particles of a sheet.
const fn points(sheet: Sheet) -> usize {
    ((sheet.cells[0] + 1) * (sheet.cells[1] + 1)) as usize
}

/// The triangles and hinges of sheets one after the other.
fn net<'m>(sheets: &[Sheet], triangles: &'m mut [[u32; 3]], hinges: &'m mut [Hinge]) -> (&'m [[u32; 3]], &'m [Hinge]) {
    let (mut first, [mut faces, mut folds]) = (0, [0; 2]);
    for sheet in sheets {
        let base = faces as u32;
        for hinge in sheet.hinges() {
            let Hinge { edge, far, faces } = hinge;
            let edge = edge.map(|corner| corner + first);
            hinges[folds] = Hinge { edge, far: far.map(|corner| corner + first), faces: faces.map(|face| face + base) };
            folds += 1;
        }
        for corners in sheet.triangles() {
            triangles[faces] = corners.map(|corner| corner + first);
            faces += 1;
        }
        first += points(*sheet) as u32;
    }
    (&triangles[..faces], &hinges[..folds])
}
