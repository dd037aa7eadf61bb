//! Memory, names of particles, counters, and the hash.

use core::cell::Cell;
use pointmass::emit::Burst;
use pointmass::shape::{Cuboid, Disc, Plane, Sphere};
use pointmass::{
    Columns, Drag, Emitter, Gravity, Heap, Id, Inline, Method, MutualGravity, Particle, Report, Scene, Size, Slices,
    Spread, Spring, Storage, System, Time, Varied, Vec3,
};
use pointmass_tests::{Form, Random, often, started};
use proptest::prelude::*;
use std::collections::HashMap;
use std::rc::Rc;

type Nozzle = Emitter<pointmass::shape::Mesh<'static>>;

/// Two emitters with everything varied, the second fuller than any memory here.
fn emitters() -> (Nozzle, Nozzle) {
    let varied = |mean, variance| Varied { mean, variance };
    let disc = Form::Circle(Disc { center: Vec3::Y, normal: Vec3::Y, radius: 0.2 });
    let first = Emitter {
        speed: varied(3.0, 1.0),
        spread: Spread::Uniform(0.5),
        lifetime: varied(0.6, 0.3),
        drag: varied(0.2, 0.1),
        color_variance: [9; 4],
        material: Some(3),
        ..Emitter::new(disc, 50.0)
    };
    let burst = Some(Burst { count: 10, at: 0.2, every: 0.5 });
    let sphere = Form::Sphere(Sphere { center: Vec3::new(0.5, 1.5, 0.0), radius: 0.1 });
    (first, Emitter { burst, lifetime: varied(0.3, 0.1), ..Emitter::new(sphere, 20.0) })
}

/// A ring of springs that hangs from a fixed particle; one of it dies.
fn ring() -> (Vec<Particle>, Vec<Spring>) {
    let place =
        |i: u32| Vec3::new((f64::from(i) * 0.7854).cos() as f32, 1.5, (f64::from(i) * 0.7854).sin() as f32) * 0.5;
    let particle = |i| Particle {
        position: place(i),
        mass: 0.2,
        fixed: i == 0,
        lifetime: if i == 3 { 0.8 } else { 0.0 },
        ..Particle::REST
    };
    let spring = |i| Spring { ends: [i, (i + 1) % 8], rest_length: 0.35, ks: 30.0, kd: 0.1 };
    ((0..8).map(particle).collect(), (0..8).map(spring).collect())
}

/// Calls `act` with a scene in which everything happens: it needs 2 emitters, 8 springs and 5 columns.
fn busy<T>(act: impl FnOnce(&Scene<'_>) -> T) -> T {
    let (start, springs) = ring();
    let emitters = emitters();
    let forces = (Gravity::EARTH, Drag {}, MutualGravity { constant: 0.02, softening: 0.05 });
    let ground = Plane { point: Vec3::ZERO, normal: Vec3::new(0.1, 1.0, 0.0) };
    let box_ = Cuboid { min: Vec3::new(0.6, 0.2, -0.2), max: Vec3::new(0.9, 0.5, 0.2) };
    let sink = Sphere { center: Vec3::new(-0.4, 0.0, 0.0), radius: 0.3 };
    act(&Scene {
        start: &start,
        springs: &springs,
        emitters: &emitters,
        forces: &forces,
        colliders: &(ground, box_),
        sinks: &sink,
        integrator: Method::Rk4.integrator(),
    })
}

/// The hash after every tenth of 120 frames.
fn hashes<B: Storage>(system: &mut System<B>, scene: &Scene<'_>) -> Vec<u64> {
    system.start(scene, 42).expect("it fits");
    let mut hashes = vec![system.hash()];
    for i in 1..=120 {
        system.step(scene, Time::frame(i, 60) - system.time());
        if i % 10 == 0 {
            hashes.push(system.hash());
        }
    }
    let totals = system.totals();
    assert!(totals.hits > 0 && totals.refused > 0 && totals.caps.springs > 0);
    assert!(totals.died.lifetime > 0 && totals.died.sink > 0 && totals.died.nonfinite == 0);
    assert_eq!(totals.initial + totals.born, system.len() as u64 + totals.died.total());
    hashes
}

const SIZE: Size = Size { particles: 30, emitters: 2, springs: 8, columns: 5 };

#[test]
fn it_does_not_matter_who_owns_the_memory() {
    busy(|scene| {
        assert_eq!(Size { particles: 30, ..scene.size() }, SIZE);
        let mut inline = Inline::<30, 2, 8, 5>::new();
        let mut heap = Heap::new(SIZE);
        let expected = hashes(&mut System::with(Heap::new(SIZE)), scene);
        assert_eq!(hashes(&mut System::with(inline.clone()), scene), expected, "inline");
        assert_eq!(hashes(&mut System::with(&mut inline), scene), expected, "borrowed inline");
        assert_eq!(hashes(&mut System::with(&mut heap), scene), expected, "borrowed heap");
        assert_eq!(hashes(&mut System::with(&mut &mut heap), scene), expected, "borrowed twice");
        assert_eq!(hashes(&mut System::with(Box::new(heap.clone())), scene), expected, "boxed");
        // Memory that was in use before is as good as fresh.
        assert_eq!(hashes(&mut System::with(heap.slices()), scene), expected, "slices");
        let mut larger = Heap::new(Size { particles: 30, emitters: 9, springs: 20, columns: 7 });
        // More tallies are hashed, so only the particles can be compared.
        let mut system = System::with(&mut larger);
        let _ = hashes(&mut system, scene);
        let mut other = System::with(&mut heap);
        let _ = hashes(&mut other, scene);
        assert_eq!(system.particles().position, other.particles().position);
        assert_eq!(system.totals(), other.totals());
    });
}

#[test]
fn starting_again_forgets_everything() {
    busy(|scene| {
        let mut system = started(scene, 30, 7);
        let first = hashes(&mut system, scene);
        assert_eq!(hashes(&mut system, scene), first);
        // Another scene in between leaves no trace, one that does not fit either.
        system.start(&Scene { start: &[Particle::REST; 3], ..Scene::EMPTY }, 1).expect("it fits");
        system.step(&Scene::EMPTY, Time::SECOND);
        assert_eq!(hashes(&mut system, scene), first);
        let (a, b) = (emitters(), emitters());
        assert!(system.start(&Scene { emitters: &(&a, &b), ..*scene }, 1).is_err());
        assert!(system.is_empty() && system.time() == Time::ZERO && *system.totals() == Report::NOTHING);
        assert_eq!(hashes(&mut system, scene), first);
    });
}

#[test]
fn a_clone_goes_on_alike() {
    busy(|scene| {
        let mut system = started(scene, 30, 1);
        for i in 1..=40 {
            system.step(scene, Time::frame(i, 60) - system.time());
        }
        let mut twin = system.clone();
        for i in 41..=100 {
            let dt = Time::frame(i, 60) - system.time();
            assert_eq!(system.step(scene, dt), twin.step(scene, dt));
            assert_eq!(system.hash(), twin.hash());
        }
    });
}

#[test]
fn room_for_nobody() {
    let (first, second) = emitters();
    let emitters = (first, second);
    let scene = Scene { emitters: &emitters, forces: &Gravity::EARTH, ..Scene::EMPTY };
    fn none<B: Storage>(memory: B, scene: &Scene<'_>) {
        let mut system = System::with(memory);
        system.start(scene, 1).expect("it fits");
        for i in 1..=60 {
            system.step(scene, Time::frame(i, 60) - system.time());
        }
        assert_eq!((system.capacity(), system.len(), system.totals().born), (0, 0, 0));
        // 50 and 20 a second, and ten at 0.2 and 0.7 s.
        assert_eq!(system.totals().refused, 50 + 20 + 20);
        assert!(system.spawn(&Particle::REST).is_err() && system.totals().refused == 91);
        let _ = system.hash();
    }
    none(Heap::new(Size { particles: 0, ..SIZE }), &scene);
    none(Inline::<0, 2, 0, 0>::new(), &scene);
    none(&mut Inline::<0, 2, 8, 5>::new(), &scene);
    let mut empty = System::with(Inline::<0, 0, 0, 0>::new());
    empty.start(&Scene::EMPTY, 0).expect("it fits");
    assert_eq!(empty.step(&Scene::EMPTY, Time::SECOND), Report::NOTHING);
}

#[test]
fn a_step_that_does_not_fit_is_counted_and_changes_nothing() {
    busy(|scene| {
        for size in [Size { emitters: 1, ..SIZE }, Size { springs: 7, ..SIZE }, Size { columns: 4, ..SIZE }] {
            let small = Scene { start: &[Particle { velocity: Vec3::X, ..Particle::REST }], ..Scene::EMPTY };
            let mut system = System::with(Heap::new(size));
            let error = system.start(scene, 1).expect_err("it does not fit");
            assert_eq!((error.need, error.have), (scene.size(), size));
            assert!(error.to_string().contains("needs 2 emitters, 8 springs and 5 columns"));
            assert!(system.is_empty());
            system.start(&small, 1).expect("it fits");
            system.step(&small, Time::SECOND);
            let before = (system.particles().position.to_vec(), system.time(), system.len());
            let report = system.step(scene, Time::SECOND);
            let mut expected = Report::NOTHING;
            expected.caps.unfit = 1;
            assert_eq!(report, expected);
            assert_eq!((system.particles().position.to_vec(), system.time(), system.len()), before);
            assert_eq!(system.totals().caps.unfit, 1);
            // It goes on with what fits.
            system.step(&small, Time::SECOND);
            assert_eq!(system.particles().position, [Vec3::X * 2.0]);
        }
    });
}

#[test]
fn an_empty_system_is_all_zeros() {
    // Written out, an empty system must show no digit but 0, no minus, and of its fates only the first.
    let text = format!("{:?}", System::with(Inline::<2, 2, 2, 2>::new())).replace("Vec3", "");
    assert!(text.contains("position") && text.contains("row_of"));
    assert!(!text.contains(|c: char| ('1'..='9').contains(&c) || c == '-'), "{text}");
    assert!(!text.contains("true") && !text.contains("Some") && !text.contains("Sink"), "{text}");
    assert_eq!(pointmass::Fate::Lives as u8, 0);
}

#[test]
fn those_beyond_the_capacity_are_refused_and_counted() {
    let start = [Particle::REST; 10];
    let scene = Scene { start: &start, ..Scene::EMPTY };
    for capacity in 0..=12 {
        let system = started(&scene, capacity, 0);
        assert_eq!(system.len(), capacity.min(10));
        assert_eq!(
            (system.totals().initial, system.totals().refused),
            (capacity.min(10) as u64, 10 - capacity.min(10) as u64)
        );
    }
}

#[test]
fn what_is_not_a_number_is_removed_and_harms_nobody() {
    let (nan, inf) = (f32::NAN, f32::INFINITY);
    let sound = |x: f32| Particle { position: Vec3::new(x, 1.0, 0.0), velocity: Vec3::Z, ..Particle::REST };
    let bad = [
        Particle { position: Vec3::new(0.0, nan, 0.0), ..Particle::REST },
        Particle { position: Vec3::new(inf, 0.0, 0.0), ..Particle::REST },
        Particle { velocity: Vec3::new(0.0, 0.0, -inf), ..Particle::REST },
        Particle { velocity: Vec3::splat(nan), ..Particle::REST },
        Particle { mass: nan, ..Particle::REST },
        Particle { mass: 0.0, ..Particle::REST },
        Particle { drag: nan, velocity: Vec3::X, ..Particle::REST },
        Particle { mass: -0.0, fixed: true, position: Vec3::NAN, ..Particle::REST },
        Particle { position: Vec3::splat(3e38), velocity: Vec3::splat(3e38), ..Particle::REST },
    ];
    let forces = (Gravity::EARTH, Drag {});
    let ground = Plane { point: Vec3::ZERO, normal: Vec3::Y };
    for &method in Method::ALL {
        let integrator = method.integrator();
        let scene = Scene { forces: &forces, colliders: &ground, sinks: &ground, integrator, ..Scene::EMPTY };
        let run = |start: &[Particle]| {
            let mut system = started(&Scene { start, ..scene }, 30, 0);
            for i in 1..=20 {
                system.step(&scene, Time::frame(i, 60) - system.time());
            }
            let p = system.particles();
            let mut places: Vec<_> = p.position.iter().map(|x| x.to_array().map(f32::to_bits)).collect();
            places.sort_unstable();
            (places, *system.totals())
        };
        let alone: Vec<Particle> = (0..8).map(|i| sound(i as f32)).collect();
        let (expected, _) = run(&alone);
        assert_eq!(expected.len(), 8);
        for bad in bad {
            for at in [0, 4, 8] {
                let mut start = alone.clone();
                start.insert(at, bad);
                let (places, totals) = run(&start);
                assert_eq!(places, expected, "{method}: beside {bad:?}");
                assert_eq!(totals.died.nonfinite, 1, "{method}: {bad:?}");
            }
        }
    }
}

#[test]
fn what_is_not_a_number_is_not_passed_on_by_mutual_gravity() {
    not_passed_on(&[], &MutualGravity { constant: 1.0, softening: 0.1 });
}

#[test]
fn what_is_not_a_number_is_not_passed_on_by_springs() {
    not_passed_on(&[Spring { ends: [0, 1], rest_length: 1.0, ks: 1.0, kd: 1.0 }], &());
}

/// Of two sound particles and one that is not, the sound survive a step.
fn not_passed_on(springs: &[Spring], forces: &dyn pointmass::Force) {
    for x in [f32::NAN, f32::INFINITY] {
        let at = |x: f32| Particle { position: Vec3::X * x, ..Particle::REST };
        let start = [at(x), at(1.0), at(2.0)];
        for &method in Method::ALL {
            let integrator = method.integrator();
            let scene = Scene { start: &start, springs, forces, integrator, ..Scene::EMPTY };
            let mut system = started(&scene, 3, 0);
            let report = system.step(&scene, Time::from_seconds(0.01));
            assert_eq!((report.died.nonfinite, system.len()), (1, 2), "{method}, beside {x}");
        }
    }
}

#[test]
fn ids_stay_with_their_particles() {
    // Against a plain map from serial numbers to masses, over random births, deaths and removals.
    let mut random = Random::new(31);
    let mut system = System::with(Heap::new(Size { particles: 20, columns: 1, ..Size::default() }));
    let mut known: HashMap<u32, (Id, f32)> = HashMap::new();
    let mut dead: Vec<Id> = vec![];
    for round in 0..often(20_000) {
        match random.word() % 4 {
            0 | 1 => {
                let mass = 1.0 + round as f32;
                let lifetime = random.between(-0.5, 0.5);
                match system.spawn(&Particle { mass, lifetime, ..Particle::REST }) {
                    Ok(id) => assert!(known.insert(id.serial(), (id, mass)).is_none(), "a name is given once"),
                    Err(full) => {
                        assert_eq!(system.len(), 20);
                        assert!(full.to_string().contains("full"));
                    }
                }
            }
            2 => {
                let some =
                    known.values().map(|k| k.0).min_by_key(|id| (id.serial().wrapping_mul(0x9e37_79b9), id.slot()));
                if let Some(id) = some {
                    assert!(system.remove(id) && !system.remove(id));
                    known.remove(&id.serial());
                    dead.push(id);
                }
            }
            _ => {
                system.step(&Scene::EMPTY, Time::from_seconds(0.02));
                let gone: Vec<u32> =
                    known.iter().filter(|(_, (id, _))| system.row(*id).is_none()).map(|(&serial, _)| serial).collect();
                dead.extend(gone.iter().filter_map(|serial| known.remove(serial)).map(|(id, _)| id));
            }
        }
        assert_eq!(system.len(), known.len());
        for (id, mass) in known.values() {
            let row = system.row(*id).expect("it lives");
            assert_eq!((system.particles().mass[row], system.id(row)), (*mass, Some(*id)));
            assert!((id.slot() as usize) < 20);
        }
        assert!(dead.iter().rev().take(50).all(|&id| system.row(id).is_none()));
        let totals = system.totals();
        assert_eq!(totals.born, system.len() as u64 + totals.died.total());
        assert_eq!(totals.died.total(), dead.len() as u64);
    }
    assert!(system.totals().died.lifetime > 0 && system.totals().died.chance > 0);
    assert_eq!(system.id(system.len()), None);
}

/// Memory that lets someone outside meddle with it, once, before it is next lent for changing.
struct Tampered {
    memory: Heap,
    with: Rc<Cell<Option<fn(&mut Slices<'_>)>>>,
}

impl Storage for Tampered {
    fn slices(&mut self) -> Slices<'_> {
        let mut slices = self.memory.slices();
        if let Some(tamper) = self.with.take() {
            tamper(&mut slices);
        }
        slices
    }
    fn columns(&self) -> Columns<'_> {
        self.memory.columns()
    }
}

#[test]
fn the_hash_sees_every_column() {
    let hash = |tamper: Option<fn(&mut Slices<'_>)>| {
        busy(|scene| {
            let with = Rc::new(Cell::new(None));
            let mut system = System::with(Tampered { memory: Heap::new(SIZE), with: Rc::clone(&with) });
            system.start(scene, 42).expect("it fits");
            for i in 1..=30 {
                system.step(scene, Time::frame(i, 60) - system.time());
            }
            assert!(system.len() > 10);
            with.set(tamper);
            // A step of nothing, which lends the memory and changes nothing.
            system.step(&Scene::EMPTY, Time::ZERO);
            (system.hash(), with.take().is_none())
        })
    };
    let (plain, _) = hash(None);
    let tampers: [(&str, fn(&mut Slices<'_>)); 14] = [
        ("x", |m| m.position[7].x = -m.position[7].x),
        ("y", |m| m.position[7].y += 1e-3),
        ("z", |m| m.position[0].z = f32::from_bits(m.position[0].z.to_bits() ^ 1)),
        ("velocity", |m| m.velocity[9].z += 1e-3),
        ("mass", |m| m.mass[3] *= 1.5),
        ("inverse mass", |m| m.inverse_mass[3] *= 1.5),
        ("drag", |m| m.drag[3] += 1.5),
        ("elasticity", |m| m.elasticity[3] += 0.1),
        ("born", |m| m.born[9] = m.born[9] + Time::from_ticks(1)),
        ("dies", |m| m.dies[9] = m.dies[9] + Time::SECOND - Time::from_ticks(1)),
        ("color", |m| m.color[9][3] ^= 1),
        ("material", |m| m.material[9] ^= 1),
        ("serial", |m| m.serial[9] += 1000),
        ("tallies", |m| m.tallies[1] = pointmass::emit::Tally::default()),
    ];
    for (column, tamper) in tampers {
        let (hash, done) = hash(Some(tamper));
        assert!(done && hash != plain, "{column}");
    }
    // What is no part of the state is not seen.
    assert_eq!(hash(Some(|m| m.work.fill(Vec3::NAN))).0, plain);
    assert_eq!(hash(Some(|m| m.position[29] = if m.position.len() == 30 { m.position[29] } else { Vec3::X })).0, plain);
}

#[test]
fn the_hash_sees_time_seed_and_counters() {
    let mut system = started(&Scene::EMPTY, 1, 0);
    let mut seen = vec![system.hash()];
    let mut news = |system: &System<Heap>| {
        assert!(!seen.contains(&system.hash()));
        seen.push(system.hash());
    };
    system.step(&Scene::EMPTY, Time::from_ticks(1));
    news(&system);
    let id = system.spawn(&Particle::REST).expect("there is room");
    news(&system);
    assert!(system.spawn(&Particle::REST).is_err());
    news(&system);
    system.remove(id);
    news(&system);
    system.start(&Scene::EMPTY, 1).expect("it fits");
    news(&system);
}

#[test]
fn the_hash_goes_by_names_not_by_rows() {
    // The same particles by another history of deaths lie in other rows.
    let particle = |i: u32| Particle { position: Vec3::X * i as f32, ..Particle::REST };
    let make = |first: u32, second: u32| {
        let mut system = System::with(Heap::new(Size { particles: 6, columns: 1, ..Size::default() }));
        let ids: Vec<Id> = (0..6).map(|i| system.spawn(&particle(i)).expect("there is room")).collect();
        system.remove(ids[first as usize]);
        system.remove(ids[second as usize]);
        system
    };
    let (a, b) = (make(0, 1), make(1, 0));
    assert_ne!(a.particles().position, b.particles().position);
    assert_eq!(a.hash(), b.hash());
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: often(300) as u32,
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    /// However a world is made and stepped, nobody appears or vanishes uncounted, and no number is left unsound.
    #[test]
    fn nobody_is_lost(
        capacity in 0usize..60,
        rates in prop::array::uniform2(prop_oneof![0.0f32..300.0, Just(1e12f32)]),
        burst in 0u32..100,
        every in 0.0f32..0.4,
        lifetime in -0.5f32..1.0,
        gravity in prop::array::uniform3(-1e3f32..1e3),
        constant in prop_oneof![-1.0f32..1.0, Just(1e30f32)],
        method in 0usize..5,
        seed in any::<u64>(),
        steps in prop::collection::vec(prop_oneof![0.0f32..0.1, 0.0f32..2.0, Just(0.0f32), Just(1e4f32)], 1..12),
    ) {
        let (first, second) = emitters();
        let burst = Some(Burst { count: burst, at: 0.05, every });
        let lifetime = Varied { mean: lifetime, variance: 0.2 };
        let emitters = (Emitter { rate: rates[0], burst, lifetime, ..first }, Emitter { rate: rates[1], ..second });
        let (gravity, mutual) =
            (Gravity { acceleration: gravity.into() }, MutualGravity { constant, softening: 0.01 });
        let integrator = Method::ALL[method].integrator();
        busy(|scene| {
            let forces = (gravity, mutual);
            let scene = Scene { emitters: &emitters, forces: &forces, integrator, ..*scene };
            let mut system = started(&scene, capacity, seed);
            let mut sum = *system.totals();
            for (i, &dt) in steps.iter().enumerate() {
                let before = system.len() as u64;
                let report = system.step(&scene, Time::from_seconds(dt));
                sum += report;
                prop_assert_eq!(before + report.born, system.len() as u64 + report.died.total());
                prop_assert!(report.hits <= 8 * capacity as u64);
                if i % 3 == 2 {
                    if let Some(id) = system.id(i) {
                        prop_assert!(system.remove(id));
                        sum.died.chance += 1;
                    }
                }
                prop_assert_eq!(system.totals(), &sum);
                let p = system.particles();
                prop_assert!(p.position.iter().chain(p.velocity).all(|v| v.is_finite()));
                prop_assert!(p.dies.iter().all(|&dies| dies > system.time()));
                prop_assert!(p.born.iter().all(|&born| born <= system.time()));
            }
            let totals = system.totals();
            prop_assert_eq!(totals.initial + totals.born, system.len() as u64 + totals.died.total());
            Ok(())
        })?;
    }
}
