//! A fountain over the ground and nothing else: what a small chip pays for it.
//!
//! Runs ten seconds of it and exits with 0 if all that was born is accounted for and nobody is below the ground.

#![no_std]
#![no_main]

// Linked for its critical section.
#[cfg(target_arch = "arm")]
use cortex_m as _;

use pointmass::shape::{Disc, Plane};
use pointmass::{
    Alike, Common, Drag, Emitter, Gravity, Particle, Scene, Slices, Spread, Storage, Symplectic, System, Time, Varied,
    Vec3,
};
use semihosting::process;
use static_cell::ConstStaticCell;

/// Drops at once.
const DROPS: usize = 64;

/// What a drop is like, which is not kept of each.
struct Drop;

impl Common for Drop {
    const PARTICLE: Particle = Particle { drag: 0.1, elasticity: 0.4, ..Particle::REST };
}

/// Fresh memory is all zeros: it lies in .bss and costs no flash.
static MEMORY: ConstStaticCell<Alike<Drop, DROPS, 1, 3>> = ConstStaticCell::new(Alike::new());

/// Vectors to work with aside, a drop takes no more.
const _: () = assert!(size_of::<Alike<Drop, 1000, 0, 0>>() <= 60 * 1000);

#[cfg_attr(target_arch = "arm", cortex_m_rt::entry)]
#[cfg_attr(target_arch = "riscv32", riscv_rt::entry)]
fn main() -> ! {
    let nozzle = Disc { center: Vec3::new(0.0, 0.1, 0.0), normal: Vec3::Y, radius: 0.05 };
    let emitter = Emitter {
        speed: Varied { mean: 4.0, half_width: 0.5 },
        spread: Spread::Uniform(0.3),
        lifetime: Varied { mean: 1.5, half_width: 0.3 },
        ..Emitter::new(nozzle, 35.0).giving_birth_to(&Drop::PARTICLE)
    };
    let ground = Plane { point: Vec3::ZERO, normal: Vec3::Y };
    let forces = (Gravity::EARTH, Drag {});
    let scene =
        Scene { emitters: &emitter, forces: &forces, colliders: &ground, integrator: &Symplectic, ..Scene::EMPTY };
    let mut system: System<Slices<'_>> = System::with(MEMORY.take().slices());
    let mut right = system.start(&scene, 1).is_ok();
    for frame in 1..=300 {
        system.step(&scene, Time::frame(frame, 30) - system.time());
    }
    let totals = system.totals();
    right &= totals.born > 340 && totals.hits > 100 && totals.refused == 0;
    right &= totals.born == totals.died.total() + system.len() as u64;
    right &= system.state(&scene).position.iter().all(|x| x.y >= 0.0);
    process::exit(i32::from(!right))
}

#[panic_handler]
fn stop(_: &core::panic::PanicInfo<'_>) -> ! {
    process::exit(101)
}
