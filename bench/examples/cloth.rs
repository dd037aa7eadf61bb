//! A cloth of so many cells a side falls over a ball, with contacts or without, for so many frames: `cloth 40 60 on`. It prints the time of a
//! frame, what happened, and the hash, so that callgrind can count its instructions.

use pointmass::constrain::{SheetContacts, Shell, ShellParams};
use pointmass::shape::{Plane, Sphere};
use pointmass::{Constraint, Gravity, Heap, Particle, Scene, Sheet, Size, System, Time, Vec3};
use std::time::Instant;

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let number = |i: usize, usual: u32| arguments.get(i).and_then(|text| text.parse().ok()).unwrap_or(usual);
    let (cells, frames) = (number(0, 40), number(1, 60));
    let sheet = Sheet { corner: Vec3::new(-0.5, 0.32, -0.5), sides: [Vec3::X, Vec3::Z], cells: [cells; 2] };
    let count = (cells + 1) * (cells + 1);
    let thread = Particle { mass: 0.2 / count as f32, elasticity: 0.0, ..Particle::REST };
    let start: Vec<Particle> = sheet.particles(thread).collect();
    let (particles, triangles): (Vec<u32>, Vec<_>) = ((0..count).collect(), sheet.triangles().collect());
    let contacts = SheetContacts { particles: particles.clone(), triangles: triangles.clone(), thickness: [0.004] };
    let params = ShellParams { stretch: [500.0; 2], shear: 200.0, bending: 1e-5, damping: 2e-3 };
    let shell = Shell { particles, triangles, hinges: sheet.hinges().collect::<Vec<_>>(), warp: Vec3::X, params };
    let colliders =
        (Plane { point: Vec3::ZERO, normal: Vec3::Y }, Sphere { center: Vec3::new(0.0, 0.2, 0.0), radius: 0.1 });
    let (with, without) = ((&shell, &contacts), (&shell,));
    let touches = arguments.get(2).is_some_and(|text| text == "on");
    let constraints: &dyn Constraint = if touches { &with } else { &without };
    let scene = Scene {
        start: &start,
        forces: &Gravity::EARTH,
        colliders: &colliders,
        constraints: &constraints,
        substeps: 5,
        ..Scene::EMPTY
    };
    let mut system = System::with(Heap::new(Size { particles: count as usize, ..scene.size() }));
    system.start(&scene, 0).expect("the memory is made for the scene");
    let begun = Instant::now();
    for frame in 1..=frames {
        system.step_to(&scene, Time::frame(u64::from(frame), 60));
    }
    println!("{:?} a frame", begun.elapsed() / frames.max(1));
    println!("{:?}", system.totals());
    println!("{:016x}", system.hash());
}
