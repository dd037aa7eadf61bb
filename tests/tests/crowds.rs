//! Births, forces and deaths that look at the same particles have them sorted into an index once.

use core::sync::atomic::{AtomicU64, Ordering};
use pointmass::force::Curl;
use pointmass::index::{IndexChoice, Periodic, Room, SpatialIndex, Structure};
use pointmass::shape::{Cuboid, Sphere};
use pointmass::{
    Chance, Dense, Drag, Emit, Emitter, Force, Heap, Integrator, Method, Particle, Reaper, Scene, Size, System, Time,
    Varied, Vec3, Viscosity, WhereSparse, Wind,
};
use pointmass_tests::often;

const THICK: Viscosity = Viscosity { coefficient: 0.2, reach: 0.2 };
const BOX: Cuboid = Cuboid { min: Vec3::ZERO, max: Vec3::ONE };
const CAPACITY: usize = 2000;

/// A choice of an index that counts how often particles are sorted in, and that can forget what it has been asked before.
struct Counted<'i> {
    index: &'i dyn IndexChoice,
    forgets: bool,
    builds: AtomicU64,
}

impl<'i> Counted<'i> {
    fn new(index: &'i dyn IndexChoice, forgets: bool) -> Self {
        Self { index, forgets, builds: AtomicU64::new(0) }
    }

    fn builds(&self) -> u64 {
        self.builds.load(Ordering::Relaxed)
    }
}

impl IndexChoice for Counted<'_> {
    fn columns(&self) -> usize {
        self.index.columns()
    }
    fn with_index(
        &self,
        memory: &mut [u32],
        points: &[Vec3],
        reach: f32,
        room: Option<&Room>,
        then: &mut dyn FnMut(Option<&dyn SpatialIndex>),
    ) {
        self.builds.fetch_add(1, Ordering::Relaxed);
        self.index.with_index(memory, points, reach, room, then);
    }
    fn reopen(&self, memory: &mut [u32], room: Option<&Room>, then: &mut dyn FnMut(&mut dyn SpatialIndex)) {
        if !self.forgets {
            self.index.reopen(memory, room, then);
        }
    }
    fn room(&self) -> Option<&Room> {
        self.index.room()
    }
    fn wrap(&self, position: &mut [Vec3]) {
        self.index.wrap(position);
    }
}

/// Particles anywhere in the box, the denser the nearer to one corner.
fn spread(count: usize) -> Vec<Particle> {
    let at = |i: usize, step: f32| (i as f32 * step).fract() * (i as f32 * step * 0.37).fract();
    let place = |i| Vec3::new(at(i, 0.618_034), at(i, 0.754_877_7), at(i, 0.569_840_3));
    (0..count).map(|i| Particle { position: place(i), velocity: place(i + 7) - 0.5, ..Particle::REST }).collect()
}

/// Emitters that fill the box where it is sparse, and pour in many at once.
fn sources() -> [Emitter<Cuboid>; 2] {
    let where_sparse = Some(WhereSparse { radius: 0.12, fewest: 8 });
    let fill = Emitter { inside: true, where_sparse, lifetime: Varied::exactly(0.3), ..Emitter::new(BOX, 6000.0) };
    let corner = Cuboid { min: Vec3::splat(0.8), max: Vec3::ONE };
    [fill, Emitter { inside: true, speed: Varied::exactly(1.0), ..Emitter::new(corner, 900.0) }]
}

const DENSE: Dense = Dense { radius: 0.15, most: 14 };

/// The hash after every step of a run with so many vectors a particle to work with, and how many were born and have died.
fn history(scene: &Scene<'_>, columns: usize, steps: u32) -> (Vec<u64>, [u64; 2]) {
    let mut system = System::with(Heap::new(Size { columns, ..scene.size_for(CAPACITY) }));
    system.start(scene, 5).expect("it fits");
    let hashes = (1..=steps).map(|i| {
        system.step(scene, Time::frame(u64::from(i), 60) - system.time());
        system.hash()
    });
    let hashes = hashes.collect();
    (hashes, [system.totals().born, system.totals().died.total()])
}

/// With lists made or streamed, whatever the structure: one build for the start, and one for the end of each step, which serves the next one's
/// births, the flight of its newborn and its forces.
#[test]
fn a_state_is_sorted_once() {
    let (start, emitters, steps) = (spread(600), sources(), if cfg!(debug_assertions) { 15 } else { 40 });
    let base = Scene { start: &start, emitters: &emitters, reapers: &DENSE, forces: &THICK, ..Scene::EMPTY };
    for (i, structure) in Structure::ALL.iter().enumerate() {
        // In debug builds, each structure in one of the ways.
        for is_listed in [false, true].into_iter().filter(|&way| !cfg!(debug_assertions) || way == (i % 2 == 0)) {
            let builds = |forgets: bool| {
                let counted = Counted::new(structure, forgets);
                let scene = Scene { index: &counted, ..base };
                let columns = if is_listed { scene.columns_with_lists() } else { scene.columns() };
                let (hashes, [born, died]) = history(&scene, columns, steps);
                assert!(born.min(died) > 25 * u64::from(steps), "{born} born, {died} dead");
                (counted.builds(), hashes)
            };
            let ((once, hashes), (often, expected)) = (builds(false), builds(true));
            assert_eq!(once, u64::from(steps) + 1, "{structure}");
            // Those who ask are births, forces and deaths.
            assert!(often >= 3 * u64::from(steps), "{structure}: {often}");
            assert_eq!(hashes, expected, "{structure}");
        }
    }
}

/// Runs are the same to the bit whether one index serves all, each has its own or there is none: by all methods and many reapers, in rooms, with
/// sub-steps, in tiles, in threads.
#[test]
fn one_index_gives_the_bits_of_many() {
    let (start, emitters) = (spread(300), sources());
    let stir = Wind { field: Curl { speed: 0.4, scale: 0.3, drift: Vec3::ZERO, seed: 1 }, coefficient: Some(2.0) };
    let (forces, reapers) = ((THICK, &stir, Drag {}), (DENSE, Chance { rate: 0.5 }));
    let sink = Sphere { center: Vec3::splat(0.5), radius: 0.1 };
    let none = Scene {
        start: &start,
        emitters: &emitters,
        forces: &forces,
        reapers: &reapers,
        colliders: &BOX,
        sinks: &sink,
        ..Scene::EMPTY
    };
    let alone = Chance { rate: 2.0 };
    let verlet: &dyn Integrator = Method::Verlet.integrator();
    let scenes: &[(&str, Scene<'_>)] = &[
        ("euler", none),
        ("verlet", Scene { integrator: verlet, ..none }),
        ("runge-kutta", Scene { integrator: Method::Rk4.integrator(), ..none }),
        ("implicit", Scene { integrator: Method::Implicit.integrator(), ..none }),
        ("sub-steps", Scene { substeps: 3, ..none }),
        ("tiles", Scene { forces: &stir as &dyn Force, ..none }),
        ("births alone", Scene { reapers: &() as &dyn Reaper, ..none }),
        ("births and chance", Scene { reapers: &alone, ..none }),
        ("deaths alone", Scene { emitters: &emitters[1] as &dyn Emit, ..none }),
        ("still", Scene { integrator: verlet, emitters: &() as &dyn Emit, colliders: &(), sinks: &(), ..none }),
    ];
    let pool = rayon::ThreadPoolBuilder::new().num_threads(3).build().expect("three threads");
    let room = Room::new(Vec3::ZERO, Vec3::splat(1.25));
    let steps = often(20) as u32;
    let structures = [Structure::Grid, Structure::Hash, Structure::Bsp, Structure::Kd].into_iter().cycle();
    let [mut once, mut each] = [0; 2];
    for ((name, scene), structure) in scenes.iter().zip(structures) {
        for room in [None, Some(room)] {
            let index_in = |index: Structure| Periodic { room: room.unwrap_or(Room::OPEN), index };
            let all = Periodic { room: room.unwrap_or(Room::OPEN), index: () };
            let plain = Scene { index: &all, ..*scene };
            let (expected, _) = history(&plain, plain.columns(), steps);
            let index = index_in(structure);
            for forgets in [false, true] {
                let counted = Counted::new(&index, forgets);
                let scene = Scene { index: &counted, ..*scene };
                let (hashes, _) = history(&scene, scene.columns(), steps);
                assert_eq!(hashes, expected, "{name}, {structure}, streamed, {room:?}");
                let (hashes, _) = history(&scene, scene.columns_with_lists(), steps);
                assert_eq!(hashes, expected, "{name}, {structure}, listed, {room:?}");
                *if forgets { &mut each } else { &mut once } += counted.builds();
            }
            let scene = Scene { index: &index, ..*scene };
            let (hashes, _) = pool.install(|| history(&scene, scene.columns_with_lists(), steps));
            assert_eq!(hashes, expected, "{name}, {structure}, in threads, {room:?}");
        }
    }
    assert!(3 * once < 2 * each, "{once} of {each}");
}

/// An index is not taken for one of another state: of other scenes, structures and rooms, or where particles are put in and taken out by hand.
#[test]
fn an_index_is_not_taken_for_another() {
    let (start, emitters) = (spread(500), sources());
    let wide = Periodic { room: Room::new(Vec3::ZERO, Vec3::splat(1.25)), index: Structure::Grid };
    let narrow = Periodic { room: Room::new(Vec3::ZERO, Vec3::new(1.2, 1.3, 0.0)), index: Structure::Grid };
    let base = Scene { start: &start, emitters: &emitters, reapers: &DENSE, forces: &THICK, ..Scene::EMPTY };
    let choices = |own: bool| -> [Box<dyn IndexChoice>; 6] {
        let all = |periodic: &Periodic<Structure>| Periodic { room: periodic.room, index: () };
        if own {
            let [grid, hash, kd, octree] =
                [Structure::Grid, Structure::Hash, Structure::Kd, Structure::Octree].map(|index| Box::new(index) as _);
            [grid, hash, Box::new(wide), Box::new(narrow), kd, octree]
        } else {
            [Box::new(()), Box::new(()), Box::new(all(&wide)), Box::new(all(&narrow)), Box::new(()), Box::new(())]
        }
    };
    let rounds = if cfg!(debug_assertions) { 1 } else { 2 };
    let run = |own: bool| -> Vec<u64> {
        let choices = choices(own);
        let implicit = Method::Implicit.integrator();
        let scenes: Vec<Scene<'_>> = choices
            .iter()
            .flat_map(|index| {
                let scene = Scene { index: &**index, ..base };
                // Those in which nobody asks at a step's ends work in the same memory.
                let apart = Scene { emitters: &(), reapers: &(), integrator: implicit, ..scene };
                [scene, Scene { forces: &Drag {}, ..scene }, scene, apart, scene, scene]
            })
            .collect();
        let columns = scenes.iter().map(Scene::columns_with_lists).max().expect("there are some");
        let mut system = System::with(Heap::new(Size { columns, ..base.size_for(CAPACITY) }));
        system.start(&base, 3).expect("it fits");
        let mut hashes = Vec::new();
        for i in 0..rounds * scenes.len() as u64 {
            // By a step that leads from one scene to the next, and by another that does not.
            let scene = &scenes[(7 * i / 2) as usize % scenes.len()];
            system.step(scene, Time::frame(i + 1, 60) - system.time());
            if i % 3 == 1 {
                let ids = [0, system.len() / 2].map(|row| system.id(row).expect("it lives"));
                ids.iter().for_each(|&id| assert!(system.remove(scene, id)));
                // Into the slot of one who has just gone, where he was or elsewhere.
                let position = if i % 2 == 0 { start[0].position } else { Vec3::splat(0.4) };
                system.spawn(&Particle { position, ..Particle::REST }).expect("there is room");
            }
            hashes.push(system.hash());
        }
        assert!(system.totals().born > 500 && system.totals().caps.insufficient_memory == 0);
        hashes
    };
    assert_eq!(run(true), run(false));
}

/// Where there is room for nobody, nobody is born, and nothing goes wrong.
#[test]
fn without_room_all_births_are_refused() {
    let emitters = sources();
    let sink = Sphere { center: Vec3::splat(0.5), radius: 0.1 };
    let scene = Scene {
        emitters: &emitters,
        forces: &THICK,
        reapers: &DENSE,
        colliders: &BOX,
        sinks: &sink,
        substeps: 2,
        ..Scene::EMPTY
    };
    let mut system = System::with(Heap::new(scene.size_for(0)));
    system.start(&scene, 5).expect("it fits");
    let report = system.step(&scene, Time::frame(1, 60));
    assert_eq!((report.born, system.len()), (0, 0));
    assert!(report.refused > 0);
}
