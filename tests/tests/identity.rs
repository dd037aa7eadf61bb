//! Names of particles, those that are no longer numbers, and the hash of the state.

use core::cell::Cell;
use pointmass::emit::EmitterState;
use pointmass::shape::Plane;
use pointmass::{
    Chance, Columns, Custom, Drag, Emitter, Force, Gravity, Heap, Id, Method, MutualGravity, Particle, Scene, Size,
    Slices, Spring, Storage, System, Time, Vec3,
};
use pointmass_tests::busy::{SIZE, busy};
use pointmass_tests::{Random, often, started};
use std::collections::HashMap;
use std::rc::Rc;

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
fn whoever_has_an_attribute_that_cannot_be_used_is_taken_out() {
    let bad = [
        Particle { mass: f32::INFINITY, ..Particle::REST },
        Particle { mass: 0.0, ..Particle::REST },
        Particle { mass: -1.0, ..Particle::REST },
        Particle { mass: 1e-42, ..Particle::REST },
        Particle { mass: -5.0, fixed: true, ..Particle::REST },
        Particle { mass: f32::NAN, fixed: true, ..Particle::REST },
        Particle { radius: f32::INFINITY, ..Particle::REST },
        Particle { radius: -0.1, ..Particle::REST },
        Particle { drag: f32::NAN, ..Particle::REST },
        Particle { charge: f32::INFINITY, ..Particle::REST },
        Particle { elasticity: f32::NEG_INFINITY, ..Particle::REST },
    ];
    for &method in Method::ALL {
        for bad in bad {
            let start = [Particle::REST, bad, Particle { lifetime: f32::INFINITY, ..Particle::REST }];
            let scene = Scene { start: &start, integrator: method.integrator(), ..Scene::EMPTY };
            let mut system = started(&scene, 3, 0);
            let report = system.step(&scene, Time::from_seconds(0.01));
            assert_eq!((report.died.nonfinite, system.len()), (1, 2), "{method}: {bad:?}");
        }
    }
}

#[test]
fn births_whose_range_goes_beyond_what_can_be_used_do_not_live_on() {
    let wide = |mean: f32, half_width: f32| pointmass::Varied { mean, half_width };
    let usual = || Emitter::new(pointmass_tests::point(Vec3::ZERO), 1000.0);
    let emitters = [
        Emitter { mass: wide(3e38, 3e38), ..usual() },
        Emitter { mass: wide(1.0, 3.0), ..usual() },
        Emitter { radius: wide(3e38, 3e38), ..usual() },
        Emitter { radius: wide(0.0, 1.0), ..usual() },
        Emitter { drag: wide(3e38, 3e38), ..usual() },
        Emitter { charge: wide(-3e38, 3e38), ..usual() },
    ];
    for (number, emitter) in emitters.iter().enumerate() {
        let scene = Scene { emitters: emitter, ..Scene::EMPTY };
        let mut system = started(&scene, 200, 5);
        let report = system.step(&scene, Time::from_seconds(0.1));
        assert!(report.born >= 99 && report.died.nonfinite > 10, "{number}: {report:?}");
        let p = system.particles();
        for row in 0..system.len() {
            let (mass, radius) = (p.mass[row], p.radius[row]);
            assert!(mass > 0.0 && mass < f32::INFINITY && (0.0..f32::INFINITY).contains(&radius), "{mass} {radius}");
            assert!(p.drag[row].is_finite() && p.charge[row].is_finite());
        }
    }
}

#[test]
fn what_is_not_a_number_is_not_passed_on_by_mutual_gravity() {
    not_passed_on(&[], &MutualGravity { constant: 1.0, softening: 0.1, ..MutualGravity::NEWTON });
}

#[test]
fn what_is_not_a_number_is_not_passed_on_by_springs() {
    not_passed_on(&[Spring::new([0, 1], 1.0, 1.0).damped(1.0)], &());
}

/// Checks that two sound particles survive a step beside one that is not.
fn not_passed_on(springs: &[Spring], forces: &dyn Force) {
    for x in [f32::NAN, f32::INFINITY] {
        let at = |x: f32| Particle { position: Vec3::X * x, ..Particle::REST };
        let start = [at(x), at(1.0), at(2.0)];
        for &method in Method::ALL {
            let integrator = method.integrator();
            let scene = Scene { start: &start, springs: &springs, forces, integrator, ..Scene::EMPTY };
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
                    assert!(system.remove(&Scene::EMPTY, id) && !system.remove(&Scene::EMPTY, id));
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
    assert!(system.totals().died.lifetime > 0 && system.totals().died.other > 0);
    assert_eq!(system.id(system.len()), None);
}

/// As many as are taken out at once and more, the last rows among them, with a number of each one's own.
#[test]
fn many_that_die_at_once_leave_all_others_as_they_are() {
    let custom = [Custom::new("name")];
    let scene = Scene { custom: &custom, ..Scene::EMPTY };
    let mut random = Random::new(37);
    for (count, share) in [1, 63, 64, 65, 127, 128, 129, 500].into_iter().flat_map(|n| [(n, 0.1), (n, 0.9), (n, 1.0)]) {
        let mut system = started(&scene, count, 3);
        for round in 0..3 {
            while system.len() < count {
                let lifetime = if random.between(0.0, 1.0) < share { 0.1 } else { 0.0 };
                let mass = random.between(1.0, 2.0);
                system.spawn(&Particle { mass, lifetime, ..Particle::REST }).expect("there is room");
            }
            let masses = system.particles().mass.to_vec();
            system.custom_mut(&scene).get_mut("name").expect("the scene has it").copy_from_slice(&masses);
            let all: Vec<_> = (0..count).filter_map(|row| Some((system.id(row)?, masses[row]))).collect();
            let dies = |row: usize, p: &Columns<'_>| p.dies[row] < Time::NEVER;
            let lives: Vec<_> = (0..count).filter(|&row| !dies(row, &system.particles())).map(|row| all[row]).collect();
            let report = system.step(&scene, Time::from_seconds(0.2));
            assert_eq!(
                (report.died.lifetime, system.len()),
                ((count - lives.len()) as u64, lives.len()),
                "{count}, {round}"
            );
            let dead = all.iter().filter(|one| !lives.contains(one));
            dead.for_each(|&(id, _)| assert_eq!(system.row(id), None));
            for &(id, mass) in &lives {
                let row = system.row(id).expect("it lives");
                let name = system.custom(&scene).get("name").expect("the scene has it")[row];
                assert_eq!(
                    (system.id(row), system.particles().mass[row], name),
                    (Some(id), mass, mass),
                    "{count}, {round}"
                );
            }
        }
    }
}

/// A change of memory.
type Tamper = fn(&mut Slices<'_>);

/// Memory that lets someone outside meddle with it, once, before it is next lent for changing.
struct Tampered {
    memory: Heap,
    with: Rc<Cell<Option<Tamper>>>,
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
    let hash = |tamper: Option<Tamper>| {
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
    let tampers: [(&str, Tamper); 14] = [
        ("x", |m| m.position[7].x = -m.position[7].x),
        ("y", |m| m.position[7].y += 1e-3),
        ("z", |m| m.position[0].z = f32::from_bits(m.position[0].z.to_bits() ^ 1)),
        ("velocity", |m| m.velocity[9].z += 1e-3),
        ("mass", |m| m.mass.own()[3] *= 1.5),
        ("inverse mass", |m| m.inverse_mass.own()[3] *= 1.5),
        ("drag", |m| m.drag.own()[3] += 1.5),
        ("elasticity", |m| m.elasticity.own()[3] += 0.1),
        ("born", |m| m.born[9] = m.born[9] + Time::from_ticks(1)),
        ("dies", |m| m.dies[9] = m.dies[9] + Time::SECOND - Time::from_ticks(1)),
        ("color", |m| m.color.own()[9][3] ^= 1),
        ("material", |m| m.material.own()[9] ^= 1),
        ("serial", |m| m.serial[9] += 1000),
        ("emitter_states", |m| m.emitter_states[1] = EmitterState::default()),
    ];
    for (column, tamper) in tampers {
        let (hash, done) = hash(Some(tamper));
        assert!(done && hash != plain, "{column}");
    }
    // Changes of what is no part of the state are not seen.
    assert_eq!(hash(Some(|m| m.work.fill(Vec3::NAN))).0, plain);
    assert_eq!(hash(Some(|m| m.position[29] = if m.position.len() == 30 { m.position[29] } else { Vec3::X })).0, plain);
}

#[test]
fn the_hash_sees_keys_where_they_decide_who_dies() {
    let hash = |rate: f32, tamper: Option<Tamper>| {
        busy(|scene| {
            let reapers = Chance { rate };
            let scene = Scene { reapers: &reapers, ..*scene };
            let with = Rc::new(Cell::new(None));
            let mut system = System::with(Tampered { memory: Heap::new(SIZE), with: Rc::clone(&with) });
            system.start(&scene, 42).expect("it fits");
            for i in 1..=30 {
                system.step(&scene, Time::frame(i, 60) - system.time());
            }
            assert!(system.len() > 10);
            with.set(tamper);
            system.step(&Scene::EMPTY, Time::ZERO);
            assert!(with.take().is_none());
            system.hash()
        })
    };
    let tamper: Tamper = |m| m.key[9] ^= 1;
    assert_eq!(hash(0.0, Some(tamper)), hash(0.0, None));
    assert_ne!(hash(0.01, Some(tamper)), hash(0.01, None));
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
    system.remove(&Scene::EMPTY, id);
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
        system.remove(&Scene::EMPTY, ids[first as usize]);
        system.remove(&Scene::EMPTY, ids[second as usize]);
        system
    };
    let (a, b) = (make(0, 1), make(1, 0));
    assert_ne!(a.particles().position, b.particles().position);
    assert_eq!(a.hash(), b.hash());
}
