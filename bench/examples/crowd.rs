//! Steps in which births, forces and deaths ask who is near, for `valgrind --tool=callgrind`:
//! `cargo run --release -p pointmass-bench --example crowd -- SIDE STEPS STRUCTURE [apart]`.
//!
//! A cube of so many times the reach in which particles drag each other along; some are born where they are sparse, and die where they are dense.
//! `apart` has all who ask sort the particles anew.

use pointmass::force::Curl;
use pointmass::index::{IndexChoice, Room, SpatialIndex, Structure};
use pointmass::shape::Cuboid;
use pointmass::{Dense, Emitter, Heap, Scene, System, Time, Vec3, Viscosity, WhereSparse, Wind};

const REACH: f32 = 0.1;

/// An index that nobody takes up again.
struct Apart(Structure);

impl IndexChoice for Apart {
    fn columns(&self) -> usize {
        self.0.columns()
    }
    fn with_index(
        &self,
        memory: &mut [u32],
        points: &[Vec3],
        reach: f32,
        room: Option<&Room>,
        then: &mut dyn FnMut(Option<&dyn SpatialIndex>),
    ) {
        self.0.with_index(memory, points, reach, room, then);
    }
}

fn main() {
    let argument = |i: usize| std::env::args().nth(i).expect("a side, steps and a structure");
    let number = |i| argument(i).parse::<u32>().expect("a whole number");
    let (side, steps, structure) = (number(1) as f32 * REACH, number(2), argument(3));
    let structure: Structure = structure.parse().expect("a structure's name");
    let apart = Apart(structure);
    let index: &dyn IndexChoice = if std::env::args().len() > 4 { &apart } else { &structure };
    let stir = Wind { field: Curl { speed: 0.2, scale: 0.3, drift: Vec3::ZERO, seed: 1 }, coefficient: Some(2.0) };
    let room = Cuboid { min: Vec3::ZERO, max: Vec3::splat(side) };
    let volume = (side / REACH).powi(3);
    let where_sparse = Some(WhereSparse { radius: REACH, fewest: 20 });
    let fill = Emitter { inside: true, where_sparse, ..Emitter::new(room, 60.0 * volume) };
    let scene = Scene {
        emitters: &fill,
        forces: &(stir, Viscosity { coefficient: 0.5, reach: REACH }),
        colliders: &room,
        reapers: &Dense { radius: REACH, most: 24 },
        index,
        ..Scene::EMPTY
    };
    let mut system = System::with(Heap::new(scene.size_for((8.0 * volume) as usize)));
    system.start(&scene, 1).expect("the memory is made for the scene");
    for step in 1..=u64::from(steps) {
        system.step(&scene, Time::frame(step, 60) - system.time());
    }
    let totals = system.totals();
    println!("{} live, {} born, {} dead, {:016x}", system.len(), totals.born, totals.died.total(), system.hash());
}
