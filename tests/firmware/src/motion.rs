//! What every target computes: the firmware here, the host in `tests/tests/hashes.rs`.
//!
//! A charged sheet on springs, one that swings and some that break, moved through every force by every method.

use pointmass::force::Drive;
use pointmass::{Drag, Gravity, Inline, Method, Particle, Scene, Sheet, Spring, System, Thread, Threads, Time, Vec3};

/// The hashes in the form of `all` in `expected.rs`.
pub(crate) const EXPECTED: &str = include_str!("../../motion.txt");

const SHEET: Sheet = Sheet { corner: Vec3::new(-0.5, 0.0, -0.5), sides: [Vec3::X, Vec3::Z], cells: [5, 4] };
const PARTICLES: usize = 6 * 5;
const SPRINGS: usize = 5 * 5 + 6 * 4 + 2 * 5 * 4 + 4 * 5 + 6 * 3;
const COLUMNS: usize = 20;

/// Everything that the sheet needs, none of it on the stack.
pub(crate) struct Memory {
    start: [Particle; PARTICLES],
    springs: [Spring; SPRINGS],
    system: System<Inline<PARTICLES, 0, SPRINGS, COLUMNS>>,
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

/// Calls `out` with the name of each method and the hash after a second and a half.
pub(crate) fn run(memory: &mut Memory, out: &mut dyn FnMut(&str, u64)) {
    let Memory { start, springs, system } = memory;
    weave(start, springs);
    for method in Method::ALL {
        let scene = Scene { start, springs, forces: &(Gravity::EARTH, Drag {}), integrator: method, ..Scene::EMPTY };
        if system.start(&scene, 1).is_ok() {
            for frame in 1..=90 {
                system.step(&scene, Time::frame(frame, 60) - system.time());
            }
        }
        out(method.name(), system.hash());
    }
}

fn weave(start: &mut [Particle], springs: &mut [Spring]) {
    let thread = |ks| Some(Thread { ks, kd: 0.05 });
    let threads = Threads { structural: thread(40.0), shear: thread(20.0), bend: thread(2.0) };
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
