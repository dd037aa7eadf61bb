//! A fountain over the ground and nothing else, as the smallest of programs has it: all that it is is known when it is built.

use pointmass::shape::{Disc, Plane};
use pointmass::{Alike, Common, Drag, Gravity, Jet, Particle, Paths, Scene, System, Time, Varied, Vec3};

/// Drops at once.
const DROPS: usize = 64;

/// What a drop is like, which is not kept of each.
pub(super) struct Drop;

impl Common for Drop {
    const PARTICLE: Particle = Particle { drag: 0.1, elasticity: 0.4, ..Particle::REST };
}

/// Memory for all of them.
pub(super) type Memory = Alike<Drop, DROPS, 1, 3>;

/// Vectors to work with aside, a drop takes no more.
const _: () = assert!(size_of::<Alike<Drop, 1000, 0, 0>>() <= 60 * 1000);

static NOZZLE: Jet<Disc> = Jet {
    speed: Varied { mean: 4.0, half_width: 0.5 },
    angle: 0.3,
    lifetime: Varied { mean: 1.5, half_width: 0.3 },
    ..Jet::new(Disc { center: Vec3::new(0.0, 0.1, 0.0), normal: Vec3::Y, radius: 0.05 }, 35.0, Drop::PARTICLE)
};

/// In flash, where the compiler sees what there is: what no part of it names is not linked.
static SCENE: Scene<'static> = Scene {
    emitters: &NOZZLE,
    forces: &(Gravity::EARTH, Drag {}),
    colliders: &Plane { point: Vec3::ZERO, normal: Vec3::Y },
    paths: Paths::STRAIGHT,
    ..Scene::EMPTY
};

/// The bits of all places after ten seconds, on every target.
const EXPECTED: u32 = 672_178_608;

/// Runs ten seconds of it and tells whether all that was born is accounted for, nobody is below the ground, and all are where they are to be.
pub(super) fn run(memory: &mut Memory) -> Result<(), u32> {
    let mut system = System::with(memory);
    let mut right = system.start(&SCENE, 1).is_ok();
    for frame in 1..=300 {
        system.step(&SCENE, Time::frame(frame, 30) - system.time());
    }
    let (totals, drops) = (system.totals(), system.particles().position.iter());
    right &= totals.born > 340 && totals.hits > 100 && totals.refused == 0;
    right &= totals.born == totals.died.total() + system.len() as u64;
    right &= drops.clone().all(|x| x.y >= 0.0);
    let bits = drops.flat_map(pointmass::Vec3::to_array).fold(0, |bits: u32, x| bits.rotate_left(1) ^ x.to_bits());
    if right && bits == EXPECTED { Ok(()) } else { Err(bits) }
}
