//! What holds together, computed alike by every target: the firmware here, the host in `tests/tests/hashes.rs`.
//!
//! A rope that hangs from a nail, a ring of soft links, a die, a jelly, a sheet, two boxes and a bent wire are thrown onto the floor, one
//! after the other, and all but the wire at once; then two cloths of an uneven mesh, sheets in the wind and on each other, and hulls.

use crate::cloth;
use crate::drawing::{hash_bodies, hash_strands, hash_surface};
use crate::{hulls, sheets};
use pointmass::constrain::{
    Attach, Contacts, Distance, Hinge, RigidBodies, RigidBox, Rope, ShapeMatching, Shell, ShellParams, StrandParams,
    Strands, Tie,
};
use pointmass::draw::{Lock, Patch};
use pointmass::index::Structure;
use pointmass::motion::Motion;
use pointmass::shape::Plane;
use pointmass::{Constraint, Drag, Fnv, Gravity, Inline, Particle, Scene, Sheet, System, Time, Vec3, Verlet};

/// The hashes in the form of `all` in `expected.rs`.
pub(crate) const EXPECTED: &str = include_str!("../../bonds.txt");

const ROPE: [u32; 12] = [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11];
const RING: [u32; 8] = [12, 13, 14, 15, 16, 17, 18, 19];
const DIE: [u32; 8] = [20, 21, 22, 23, 24, 25, 26, 27];
const JELLY: [u32; 8] = [28, 29, 30, 31, 32, 33, 34, 35];
const SHEET: Sheet = Sheet {
    corner: Vec3::new(-0.2, 0.6, 0.3),
    sides: [Vec3::new(0.3, 0.1, 0.0), Vec3::new(0.0, 0.05, 0.2)],
    cells: [3, 2],
};
/// Particles before those of the sheet, and its own, with its triangles and hinges.
const LOOSE: usize = 36;
const WOVEN: usize = 12;
const FACES: usize = 12;
const HINGES: usize = 13;
/// Where a corner of the die is, and one of the jelly.
const THROWN: [Vec3; 2] = [Vec3::new(0.4, 0.5, 0.5), Vec3::new(0.3, 0.9, 0.45)];
const PARTICLES: usize = LOOSE + WOVEN;
const COLUMNS: usize = 73;
const KEPT: usize = 28;

/// Everything that they need, none of it on the stack.
pub(crate) struct Memory {
    start: [Particle; PARTICLES],
    system: System<Inline<PARTICLES, 0, 0, COLUMNS, KEPT>>,
    cloth: cloth::Memory,
    sheets: sheets::Memory,
    hulls: hulls::Memory,
}

impl Memory {
    pub(crate) const fn new() -> Self {
        Self {
            start: [Particle { mass: 0.0, elasticity: 0.0, ..Particle::REST }; PARTICLES],
            system: System::with(Inline::new()),
            cloth: cloth::Memory::new(),
            sheets: sheets::Memory::new(),
            hulls: hulls::Memory::new(),
        }
    }
}

/// Calls `out` with the name of each and the hash after most of a second, or less where sheets and hulls have files of their own; and with those of boxes, a surface and a strand as they are drawn
/// then.
pub(crate) fn run(memory: &mut Memory, out: &mut dyn FnMut(&str, u64)) {
    let Memory { start, system, cloth, sheets, hulls } = memory;
    throw(start);
    let rope = Rope { damping: 0.02, ..Rope::rigid(ROPE, [0.1]) };
    let ring = Rope { compliance: 1e-4, closed: true, ..Rope::rigid(RING, [0.12]) };
    let die = ShapeMatching::rigid(DIE);
    let jelly = ShapeMatching { compliance: 2e-3, damping: 0.5, ..ShapeMatching::rigid(JELLY) };
    let sheet = sheet();
    let chest = |place: Vec3, first| RigidBox::new(Vec3::splat(0.1), place + 0.1, first);
    let chests = RigidBodies::boxes([chest(THROWN[0], DIE[0]), chest(THROWN[1], JELLY[0])]);
    let tether = Distance { compliance: 1e-3, ..Distance::string([11, 20], 0.3) };
    let hand = Attach {
        particles: [0],
        motion: Motion { spin: 0.7, pivot: Vec3::new(0.0, 1.0, 0.1), axis: Vec3::Y, ..Motion::STILL },
    };
    let all = &(hand, (tether, rope, ring), (die, jelly), sheet, Contacts::HARD);
    let wire = StrandParams { damping: 1e-3, ..StrandParams::round(2e-3, 3e9, 0.3) };
    let wire = Strands { twist: 1.0, ..Strands::of(RING, [8], wire) };
    let button = Tie { compliance: 1e-3, damping: 0.3, ..Tie::rigid(JELLY[7], [DIE[0], DIE[1], DIE[2]]) };
    let tied = &(rope, die, Tie::rigid(ROPE[11], DIE), button);
    let bonds: [(&str, &dyn Constraint); 10] = [
        ("rope", &rope),
        ("ring", &ring),
        ("die", &die),
        ("jelly", &jelly),
        ("tether", &tether),
        ("sheet", &sheet),
        ("chests", &chests),
        ("wire", &wire),
        ("tied", tied),
        ("bonds", all),
    ];
    let floor = Plane { point: Vec3::ZERO, normal: Vec3::Y };
    for (name, constraints) in bonds {
        let scene = above(&floor, start, constraints);
        system.start(&scene, 1).expect("there is memory for it");
        for frame in 1..=50 {
            system.step(&scene, Time::frame(frame, 60) - system.time());
        }
        out(name, system.hash());
        let (state, mut hash) = (system.state(&scene), Fnv::new());
        let drawn = match name {
            "chests" => {
                hash_bodies(&state, &chests.boxes, start, &mut hash);
                "boxes"
            }
            "sheet" => {
                let patch = Patch { first: LOOSE as u32, count: WOVEN as u32, triangles: &sheet.triangles };
                hash_surface::<WOVEN, FACES>(&state, &patch, &mut hash);
                "surface"
            }
            "wire" => {
                hash_strands(&state, &Lock { first: RING[0], points: 8, count: 1, width: 2e-3 }, &mut hash);
                "strand"
            }
            _ => continue,
        };
        out(drawn, hash.finish());
    }
    cloth::run(cloth, out);
    sheets::run(sheets, out);
    hulls::run(hulls, out);
}

/// Particles in air that fall on a floor.
fn above<'s>(floor: &'s Plane, start: &'s [Particle], constraints: &'s dyn Constraint) -> Scene<'s> {
    Scene {
        start,
        forces: &(Gravity::EARTH, Drag {}),
        colliders: floor,
        constraints,
        substeps: 6,
        integrator: &Verlet,
        index: &Structure::Grid,
        ..Scene::EMPTY
    }
}

/// A sheet of stiff paper.
fn sheet() -> Shell<[u32; WOVEN], [[u32; 3]; FACES], [Hinge; HINGES]> {
    let (mut triangles, mut hinges) = ([[0; 3]; FACES], [Hinge { edge: [0; 2], far: [0; 2], faces: [0; 2] }; HINGES]);
    triangles.iter_mut().zip(SHEET.triangles()).for_each(|(to, from)| *to = from);
    hinges.iter_mut().zip(SHEET.hinges()).for_each(|(to, from)| *to = from);
    let particles = core::array::from_fn(|i| (LOOSE + i) as u32);
    let params = ShellParams { stretch: [100.0, 80.0], shear: 30.0, bending: 1e-3, damping: 1e-3 };
    Shell { particles, triangles, hinges, warp: Vec3::X, params }
}

/// A rope from its nail, a ring, two lots of the corners of a box, and a sheet, all a little different.
fn throw(start: &mut [Particle]) {
    for (i, place) in start.iter_mut().enumerate() {
        let odd = (i * 7 % 10) as f32 * 0.1;
        let (position, velocity) = match i {
            0..12 => (Vec3::new(0.1 * i as f32, 1.3, 0.0), Vec3::ZERO),
            12..20 => {
                let round = [
                    [1.0, 0.0],
                    [0.7, 0.7],
                    [0.0, 1.0],
                    [-0.7, 0.7],
                    [-1.0, 0.0],
                    [-0.7, -0.7],
                    [0.0, -1.0],
                    [0.7, -0.7],
                ];
                let [x, z] = round[i - 12];
                (Vec3::new(0.15 * x + 1.5, 0.8 + 0.1 * x, 0.15 * z), Vec3::new(-1.0, 1.0 + z, 0.3))
            }
            LOOSE.. => (SHEET.positions().nth(i - LOOSE).unwrap_or(Vec3::ZERO), Vec3::new(odd, 0.0, 1.0 - odd)),
            _ => {
                let corner = Vec3::new((i & 1) as f32, (i >> 1 & 1) as f32, (i >> 2 & 1) as f32) * 0.2;
                let place = THROWN[usize::from(i >= 28)];
                (place + corner, Vec3::new(1.0, 0.5, -1.0).cross(corner) * 12.0)
            }
        };
        *place = Particle {
            position,
            velocity,
            radius: 0.03 + 0.01 * odd,
            mass: 0.1 + 0.05 * odd,
            drag: 0.01 * odd,
            elasticity: 0.2 + 0.3 * odd,
            fixed: i == 0,
            ..Particle::REST
        };
    }
}
