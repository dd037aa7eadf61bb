//! The same without a heap: all memory is a `static`, which is zeros until it is used and takes no flash.
//!
//! Firmware would be `#![no_std]`, and lend the memory from a cell of its own (the crate `static_cell` has some); the engine's part is
//! the same. `cargo run --release -p pointmass --example no_std_fountain`

use pointmass::shape::{Disc, Mesh, Plane, Shape};
use pointmass::{Drag, Emitter, Gravity, Inline, InsufficientMemory, Scene, Spread, System, Time, Varied, Vec3};
use std::sync::Mutex;

/// Room for 64 particles, 1 emitter, no springs, and 3 columns of vectors to work with: what `Scene::size` says.
type Fountain = System<Inline<64, 1, 0, 3>>;

static FOUNTAIN: Mutex<Fountain> = Mutex::new(System::with(Inline::new()));

fn run(fountain: &mut Fountain, mut draw: impl FnMut(&[Vec3])) -> Result<u64, InsufficientMemory> {
    let nozzle = Shape::<Mesh>::Circle(Disc { center: Vec3::Y * 0.1, normal: Vec3::Y, radius: 0.05 });
    let jet = Emitter {
        speed: Varied { mean: 4.0, half_width: 0.5 },
        spread: Spread::Uniform(0.3),
        lifetime: Varied::exactly(1.5),
        ..Emitter::new(nozzle, 40.0)
    };
    let ground = Plane { point: Vec3::ZERO, normal: Vec3::Y };
    let scene = Scene { emitters: &jet, forces: &(Gravity::EARTH, Drag {}), colliders: &ground, ..Scene::EMPTY };
    fountain.start(&scene, 7)?;
    for frame in 1..=120 {
        fountain.step_to(&scene, Time::frame(frame, 60));
        draw(fountain.particles().position);
    }
    Ok(fountain.hash())
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut fountain = FOUNTAIN.lock().map_err(|_| "somebody else has panicked")?;
    let mut lit = 0;
    let hash = run(&mut fountain, |drops| lit += drops.len())?;
    println!("{} bytes, {lit} dots drawn, hash {hash:016x}", size_of::<Fountain>());
    Ok(())
}
