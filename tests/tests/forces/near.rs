//! Forces between neighbours.

use super::{cloud, forces};
use pointmass::force::{Pair, Radial, RadialLaw, State, Weight};
use pointmass::index::{IndexChoice, Nearby, Neighbours, SpatialIndex, Structure};
use pointmass::{
    Coulomb, Custom, Effort, Emit, Emitter, Force, Gravity, Heap, LennardJones, Measures, Method, Particle, PowerLaw,
    Pressure, Scene, Size, System, Time, Varied, Vec3, Viscosity,
};
use pointmass_tests::{Random, every, f64s, gap, is_third, point, run, started, structures};

const ATOMS: Radial<LennardJones> = Radial(LennardJones { epsilon: 1.0, sigma: 0.3, cutoff: 0.75 });
const SOFT: Radial<PowerLaw> =
    Radial(PowerLaw { strength: -2.0, exponent: 3, softening: 0.2, reach: 0.6, weight: Weight::Mass });
const LONG: Radial<PowerLaw> =
    Radial(PowerLaw { strength: -0.1, exponent: 1, softening: 0.3, reach: 0.9, weight: Weight::Charge });
const THICK: Viscosity = Viscosity { coefficient: 3.0, reach: 0.5 };

/// Calls `then` with a state whose points are in an index.
fn indexed(state: State<'_>, structure: Structure, reach: f32, then: impl FnOnce(&State<'_>)) {
    let mut memory = vec![0; structure.words(state.position.len())];
    let mut index = structure.index(&mut memory);
    index.build(state.position, reach).expect("there is room");
    then(&State { near: Neighbours::by(Some(&index), state.position), ..state });
}

#[test]
fn every_structure_gives_the_same_force() {
    let start = cloud(400);
    let scene = Scene { start: &start, ..Scene::EMPTY };
    let system = started(&scene, 400, 0);
    let state = system.state(&scene);
    for force in [&SOFT as &dyn Force, &THICK] {
        let plain = forces(&system, &scene, force);
        let size = plain.iter().map(|f| f.length()).fold(0.0, f32::max);
        assert!(size > 1.0, "{size}");
        for &structure in Structure::ALL {
            indexed(state, structure, force.needs().reach, |state| {
                let mut whole = vec![Vec3::ZERO; 400];
                force.add_to(state, 0..400, &mut whole);
                assert_eq!(whole, plain, "{structure}");
                // Any division of the rows gives the same bits.
                for cuts in [&[0, 1, 400][..], &[0, 100, 101, 399, 400]] {
                    let mut parts = vec![Vec3::ZERO; 400];
                    for cut in cuts.windows(2) {
                        force.add_to(state, cut[0]..cut[1], &mut parts[cut[0]..cut[1]]);
                    }
                    assert_eq!(parts, whole, "{structure}");
                }
                let energies =
                    [force.energy(state), force.energy(&State { near: Neighbours::among(state.position), ..*state })];
                assert!((energies[0] - energies[1]).abs() <= 1e-12 * energies[1].abs());
            });
        }
    }
    assert_eq!(SOFT.needs().columns(&Structure::Grid), Structure::Grid.columns());
    assert_eq!(SOFT.needs().columns(&()), 0);
}

/// One who is so far off that indices scale places down, or nowhere, makes nobody else a neighbour of others, and takes none away.
#[test]
fn who_is_far_off_changes_nobodys_neighbours() {
    for far in [1e3, 1e17, 2e18, 1e19, 1e24, 1e30, 1e37, f32::INFINITY, f32::NAN] {
        let mut places: Vec<_> = cloud(160).iter().map(|particle| particle.position).collect();
        let about = |places: &[Vec3], structure: Option<Structure>| {
            let mut lists: Vec<Vec<u32>> = vec![vec![]; places.len()];
            let mut visit = |row: usize, others: &Nearby| lists[row].extend(others.rows());
            match structure {
                None => Neighbours::among(places).of(0..places.len(), 0.6, &mut visit),
                Some(structure) => {
                    let mut memory = vec![0; structure.words(places.len())];
                    let mut index = structure.index(&mut memory);
                    index.build(places, 0.6).expect("there is room");
                    Neighbours::by(Some(&index), places).of(0..places.len(), 0.6, &mut visit);
                }
            }
            lists
        };
        let without = about(&places, None);
        places.push(Vec3::new(0.1, far, -0.2));
        for structure in Structure::ALL.iter().map(|&structure| Some(structure)).chain([None]) {
            let with = about(&places, structure);
            assert!(with[..160] == without && with[160].is_empty(), "{far} m, {structure:?}");
        }
        assert!(without.iter().any(|list| list.len() > 3) && without.iter().any(|list| list.len() < 100));
    }
}

/// A run of a scene by an index, with so many vectors a particle to work with; its hash after every tenth step, and its effort.
fn history(scene: &Scene<'_>, columns: usize, h: f64) -> (Vec<u64>, Effort) {
    let mut system = System::with(Heap::new(Size { particles: 420, columns, ..scene.size() }));
    system.start(scene, 3).expect("it fits");
    let hashes = (1..=40).map(|i| {
        system.step(scene, Time::from_seconds_f64(h * f64::from(i)) - system.time());
        system.hash()
    });
    (hashes.collect(), system.totals().effort)
}

/// Runs are the same to the bit whether neighbours are looked for among all, streamed from any index, or kept in lists:
/// by all methods, at slow and fast steps, while some are born and die, in threads too.
#[test]
fn however_neighbours_are_found_runs_are_the_same() {
    let start = cloud(if cfg!(debug_assertions) { 100 } else { 320 });
    let force = (SOFT, THICK, Gravity::EARTH);
    let jet = Emitter { lifetime: Varied::exactly(0.02), ..Emitter::new(point(Vec3::ZERO), 150.0) };
    let pool = rayon::ThreadPoolBuilder::new().num_threads(3).build().expect("three threads");
    let none = Scene { start: &start, forces: &force, ..Scene::EMPTY };
    let (mut listed, mut streamed) = (0, 0);
    for (i, method) in Method::ALL.iter().enumerate() {
        // With all checks it takes long: either of both steps for each method, and one structure.
        for h in [1e-3, 0.02].into_iter().skip(i / 2 % every(2)).step_by(every(2)) {
            let emitters: &dyn Emit = if i % 2 == 0 { &jet } else { &() };
            let plain = Scene { integrator: method.integrator(), emitters, ..none };
            let (expected, effort) = history(&plain, plain.columns(), h);
            assert!(effort.all_pairs > 0 && effort.lists + effort.streamed == 0);
            // All structures give the same neighbours by all methods alike.
            for &structure in structures(i) {
                let scene = Scene { index: &structure, ..plain };
                let (least, more) = (scene.columns(), scene.columns_with_lists());
                let (hashes, effort) = history(&scene, least, h);
                assert_eq!(hashes, expected, "{method}, {structure}");
                assert!(effort.all_pairs + effort.lists == 0 && effort.streamed > 0);
                let (hashes, effort) = history(&scene, more, h);
                assert_eq!(hashes, expected, "{method}, {structure}, listed");
                (listed, streamed) = (listed + effort.evaluations - effort.streamed, streamed + effort.streamed);
                if i % 2 == 1 && h < 0.01 {
                    // Lists are kept over steps.
                    assert!(
                        effort.lists > 0 && 3 * (effort.lists + effort.streamed) < effort.evaluations,
                        "{effort:?}"
                    );
                }
            }
            let scene = Scene { index: &Structure::Grid, ..plain };
            let (hashes, _) = pool.install(|| history(&scene, scene.columns_with_lists(), h));
            assert_eq!(hashes, expected, "{method} in threads");
        }
    }
    assert!(listed.min(streamed) > 1000 / every(4) as u64, "{listed} {streamed}");
}

/// Another scene, whose step works in the memory of the lists, ends them; one that does not fit changes nothing.
#[test]
fn lists_are_not_kept_over_other_scenes() {
    let start = cloud(400);
    let listed = Scene { start: &start, forces: &SOFT, index: &Structure::Grid, ..Scene::EMPTY };
    let local = Scene { start: &start, forces: &Gravity::EARTH, ..Scene::EMPTY };
    let wide = Scene { start: &start, forces: &THICK, integrator: Method::Implicit.integrator(), ..Scene::EMPTY };
    let custom = [Custom::new("heat")];
    let insufficient_memory = Scene { custom: &custom, ..local };
    let run = |columns: usize| {
        let mut system = System::with(Heap::new(Size { particles: 500, columns, ..listed.size() }));
        system.start(&listed, 0).expect("it fits");
        for (i, scene) in [&listed, &local, &listed, &listed, &wide, &listed, &insufficient_memory, &listed]
            .iter()
            .cycle()
            .take(40)
            .enumerate()
        {
            system.step(scene, Time::from_seconds(1e-4));
            if i % 7 == 6 {
                system.spawn(&Particle { position: Vec3::Y, ..Particle::REST }).expect("there is room");
            }
        }
        assert_eq!(system.totals().caps.insufficient_memory, 5);
        (system.hash(), system.totals().effort)
    };
    let [(few, _), (many, effort)] = [wide.columns().max(listed.columns()), 90].map(run);
    assert_eq!(few, many);
    assert!(effort.lists > 4 && effort.evaluations > effort.lists + effort.streamed + effort.all_pairs, "{effort:?}");
}

/// Too little memory for lists is none; a row with more neighbours than the stack has room for still comes in order.
#[test]
fn crowds_are_listed_or_not_to_the_same_bits() {
    let at = |i: u32| Vec3::new((i % 29) as f32, (i % 31) as f32, (i % 37) as f32) * 0.01;
    let start: Vec<_> = (0..700).map(|i| Particle { position: at(i), ..Particle::REST }).collect();
    let scene = Scene { start: &start, forces: &SOFT, index: &Structure::Kd, ..Scene::EMPTY };
    let run = |scene: &Scene<'_>, columns: usize| {
        let mut system = System::with(Heap::new(Size { columns, ..scene.size() }));
        system.start(scene, 0).expect("it fits");
        (0..4).for_each(|_| {
            system.step(scene, Time::from_seconds(1e-4));
        });
        (system.hash(), system.totals().effort)
    };
    let (expected, _) = run(&Scene { index: &(), ..scene }, scene.columns());
    for (columns, is_listed) in [(0, false), (1, false), (3, false), (22, false), (500, true)] {
        let (hash, effort) = run(&scene, scene.columns() + columns);
        assert_eq!((hash, effort.lists > 0), (expected, is_listed), "{columns}: {effort:?}");
    }
}

/// Lists are made, and sums divided, by any number of threads to the same bits, and just as often: where points are spread evenly, in no order
/// or along an axis, so that each thread finds the near of its own rows alone; where all the near are on one thread's share; where one flies off
/// in any share of the rows, so that lists end; and where there is hardly room for them, or a little too little.
#[test]
fn lists_made_in_threads_are_the_same() {
    let spread: Vec<_> = cloud(9000).into_iter().map(|at| Particle { position: at.position * 3.0, ..at }).collect();
    let mut sorted = spread.clone();
    sorted.sort_by(|a, b| a.position.x.total_cmp(&b.position.x));
    let shift = |i: usize| if i < 4500 { 1.0 } else { 30.0 };
    let uneven: Vec<_> =
        spread.iter().enumerate().map(|(i, at)| Particle { position: at.position * shift(i), ..*at }).collect();
    let hasty = |row: usize| {
        let mut start = spread.clone();
        start[row].velocity = Vec3::X * 300.0;
        start
    };
    let starts = [spread.clone(), sorted, uneven, hasty(3), hasty(4499), hasty(4500), hasty(8999)];
    let pools =
        [1, 2, 3, 8].map(|threads| rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads"));
    let [one, two, three, eight] = pools.each_ref();
    let mut listed = vec![];
    let mut cases = 0;
    let both = starts.iter().map(|start| (start, &SOFT)).chain([(&starts[0], &LONG), (&starts[2], &LONG)]);
    for (start, force) in both.step_by(every(4)) {
        let scene = Scene { start, forces: force, index: &Structure::Grid, ..Scene::EMPTY };
        // Some steps with so much memory, each in a pool, in turns.
        let run = |more: usize, steps: usize, pools: &[&rayon::ThreadPool]| {
            let mut system = System::with(Heap::new(Size { columns: scene.columns() + more, ..scene.size() }));
            system.start(&scene, 0).expect("it fits");
            for pool in pools.iter().cycle().take(steps) {
                pool.install(|| system.step(&scene, Time::from_seconds(1e-4)));
            }
            let Effort { lists, streamed, all_pairs, .. } = system.totals().effort;
            (system.hash(), [lists, streamed, all_pairs])
        };
        // The least memory in which lists have room.
        let (mut too_few, mut enough) = (0, 256);
        while enough - too_few > 1 {
            let middle = usize::midpoint(too_few, enough);
            *(if run(middle, 1, &[one]).1[0] > 0 { &mut enough } else { &mut too_few }) = middle;
        }
        let (expected, _) = run(0, 6, &[one]);
        for more in [too_few, enough, enough + enough / 8] {
            let (hash, effort) = run(more, 6, &[one]);
            assert_eq!(hash, expected, "{more} columns");
            for pools in [&[two][..], &[eight], &[three, one, eight, two]] {
                if !is_third(&mut cases) {
                    continue;
                }
                let threads: Vec<_> = pools.iter().map(|pool| pool.current_num_threads()).collect();
                assert_eq!(run(more, 6, pools), (expected, effort), "{more} columns, {threads:?} threads");
            }
            listed.push(effort[0]);
        }
    }
    // There have been none, lists that lasted, and lists that did not.
    assert!([0, 1, 2].iter().all(|count| listed.contains(count)), "{listed:?}");
}

/// Who is nowhere has no list, and takes none away from others.
#[test]
fn the_lost_keep_nobody_from_being_listed() {
    for count in [1, 7, 14, 15, 16, 17, 40] {
        let mut start = cloud(count);
        start.resize(60, Particle { position: Vec3::splat(f32::NAN), ..Particle::REST });
        let scene = Scene { start: &start, forces: &SOFT, index: &Structure::Grid, ..Scene::EMPTY };
        let run = |scene: &Scene<'_>, columns: usize| {
            let mut system = System::with(Heap::new(Size { columns, ..scene.size() }));
            system.start(scene, 0).expect("it fits");
            system.step(scene, Time::from_seconds(1e-4));
            (system.hash(), system.totals().effort.lists)
        };
        let expected = run(&Scene { index: &(), ..scene }, scene.columns()).0;
        assert_eq!(run(&scene, scene.columns() + 500), (expected, 1), "{count} who are somewhere");
    }
}

#[test]
fn two_atoms_rest_and_swing_where_they_should() {
    let (epsilon, sigma) = (2.0, 0.5);
    let law = Radial(LennardJones { epsilon, sigma, cutoff: 5.0 });
    let rest = 2f64.powf(1.0 / 6.0) * f64::from(sigma);
    let pair = |d: f64| [0.0, d as f32].map(|x| Particle { position: Vec3::X * x, mass: 3.0, ..Particle::REST });
    let scene = Scene { forces: &law, integrator: Method::Rk4.integrator(), ..Scene::EMPTY };
    let still = pair(rest);
    let system = started(&Scene { start: &still, ..scene }, 2, 0);
    // An ulp of the distance, 6e-8, times the stiffness 57.1 ε / σ², and the roundings of 24 ε / σ.
    let force = forces(&system, &scene, &law)[0].x;
    assert!(force.abs() < 1e-4, "{force}");
    let energy = law.energy(&system.state(&scene));
    assert!((energy + 2.0 - 8.0 * (0.1f64.powi(6) - 0.1f64.powi(12))).abs() < 1e-6, "{energy}");
    // ω² = k / μ with k = 72 ε / (2^{1/3} σ²), μ = m / 2. A swing of 1 % shifts it by about 1e-3.
    let omega = (72.0 * 2.0 / (2f64.cbrt() * 0.25) / 1.5).sqrt();
    let pushed = pair(rest * 1.002);
    let scene = Scene { start: &pushed, ..scene };
    let mut system = started(&scene, 2, 0);
    let h = 2.0 * core::f64::consts::PI / omega / 500.0;
    let (mut crossings, mut last) = (vec![], 1.0);
    for i in 1..=5000u32 {
        system.step(&scene, Time::from_seconds_f64(h * f64::from(i)) - system.time());
        let p = system.particles().position;
        let x = gap(f64s(p[0]), f64s(p[1])) - rest;
        if x < 0.0 && last >= 0.0 {
            crossings.push(system.time().seconds_f64() + h * x / (last - x));
        }
        last = x;
    }
    let period = (crossings[crossings.len() - 1] - crossings[0]) / (crossings.len() - 1) as f64;
    assert!((period * omega / (2.0 * core::f64::consts::PI) - 1.0).abs() < 1e-3, "{period}");
    // Apart from the cutoff nothing is lost, even in a swing far out.
    let wide = pair(rest * 1.5);
    let scene = Scene { start: &wide, ..scene };
    let mut system = started(&scene, 2, 0);
    let before = Measures::of(&system, &scene).energy.total();
    run(&mut system, &scene, h / 4.0, 20_000);
    let after = Measures::of(&system, &scene).energy.total();
    assert!((after - before).abs() < 1e-4 * before.abs(), "{before} becomes {after}");
}

#[test]
fn a_power_law_is_its_formula() {
    let place = Vec3::new(0.3, 0.4, 0.0);
    let start = [(Vec3::ZERO, 2.0, 3.0), (place, 5.0, -7.0)].map(|(position, mass, charge)| Particle {
        position,
        mass,
        charge,
        ..Particle::REST
    });
    let scene = Scene { start: &start, ..Scene::EMPTY };
    let system = started(&scene, 2, 0);
    for (weight, w) in [(Weight::One, 1.0), (Weight::Mass, 10.0), (Weight::Charge, -21.0)] {
        for exponent in 0..=12u8 {
            let law = Radial(PowerLaw { strength: 0.5, exponent, softening: 1.2, reach: 2.0, weight });
            let d = 0.25f64 + 1.44;
            let expected = 0.5 * w / d.sqrt().powi(i32::from(exponent) + 1);
            let [a, b] = forces(&system, &scene, &law)[..] else { panic!("two") };
            assert!(gap(f64s(a), f64s(place).map(|x| x * expected)) < 1e-5 * expected.abs(), "{exponent}");
            assert_eq!(a, -b);
        }
    }
    let beyond = Radial(PowerLaw { strength: 1.0, exponent: 2, softening: 0.0, reach: 0.499, weight: Weight::One });
    assert_eq!(forces(&system, &scene, &beyond), [Vec3::ZERO; 2]);
}

/// Balls of 1 m that push each other apart as springs do.
struct Contact;

impl RadialLaw for Contact {
    fn reach(&self) -> f32 {
        0.5
    }
    fn pull(&self, square: f32, pair: &Pair) -> f32 {
        let d = square.sqrt();
        pair.mass[0] * pair.mass[1] * (d - 0.5) / d
    }
    fn energy(&self, square: f64, pair: &Pair) -> f64 {
        0.5 * f64::from(pair.mass[0]) * f64::from(pair.mass[1]) * (square.sqrt() - 0.5).powi(2)
    }
}

#[test]
fn a_users_own_law() {
    let mut start = cloud(200);
    start[100].position += Vec3::splat(0.1);
    let index = Structure::Kd;
    let scene = Scene {
        start: &start[..199],
        forces: &Radial(&Contact),
        index: &index,
        integrator: Method::Verlet.integrator(),
        ..Scene::EMPTY
    };
    let mut system = started(&scene, 199, 0);
    let before = Measures::of(&system, &scene);
    run(&mut system, &scene, 5e-4, 400);
    let after = Measures::of(&system, &scene);
    assert!(before.energy.potential > 1.0);
    assert!((after.energy.total() / before.energy.total() - 1.0).abs() < 1e-3, "{before:?} {after:?}");
}

#[test]
fn neighbours_conserve_momentum() {
    let start: Vec<Particle> = cloud(200)[..199].to_vec();
    for force in [&SOFT as &dyn Force, &THICK, &(SOFT, THICK)] {
        for structure in [Structure::Grid, Structure::Bvh] {
            let scene = Scene { start: &start, forces: force, index: &structure, ..Scene::EMPTY };
            let mut system = started(&scene, 199, 0);
            let before = Measures::of(&system, &scene);
            run(&mut system, &scene, 1e-3, 200);
            let after = Measures::of(&system, &scene);
            let p = system.particles();
            let size: f64 = (0..199).map(|i| f64::from(p.mass[i] * p.velocity[i].length())).sum();
            // 200 steps of rounding, as a random walk.
            let off = gap(before.momentum, after.momentum) / size;
            assert!(off < 1e-6, "{structure}: {off}");
        }
    }
}

#[test]
fn viscosity_takes_kinetic_energy_and_never_gives_it() {
    let start: Vec<Particle> = cloud(200)[..199].to_vec();
    let scene = Scene { start: &start, forces: &THICK, index: &Structure::Grid, ..Scene::EMPTY };
    for method in [Method::Rk4, Method::Implicit] {
        let scene = Scene { integrator: method.integrator(), ..scene };
        let mut system = started(&scene, 199, 0);
        let mut last = Measures::of(&system, &scene).energy.kinetic;
        let first = last;
        for i in 1..=100u32 {
            system.step(&scene, Time::from_seconds_f64(1e-3 * f64::from(i)) - system.time());
            let now = Measures::of(&system, &scene).energy.kinetic;
            assert!(now <= last, "{method}: {now} after {last}");
            last = now;
        }
        assert!(last < 0.7 * first, "{method}: {first} becomes {last}");
    }
}

#[test]
fn a_shear_layer_decays_as_its_graph_says() {
    // Two rings of 24, one in the other, that slide along their axis: every particle sees the same neighbours.
    let n = 24;
    let on = |radius: f32, speed: f32| {
        (0..n).map(move |i| {
            let (s, c) = (core::f32::consts::TAU * i as f32 / n as f32).sin_cos();
            Particle { position: Vec3::new(c, s, 0.0) * radius, velocity: Vec3::Z * speed, mass: 2.0, ..Particle::REST }
        })
    };
    let start: Vec<Particle> = on(1.0, 1e-3).chain(on(1.2, -1e-3)).collect();
    let weight = |a: &Particle, b: &Particle| (1.0 - gap(f64s(a.position), f64s(b.position)) / 0.5).max(0.0);
    // m dv/dt = μ m² Σ W (v₂ − v₁), with v₂ − v₁ = −2 v across and 0 along.
    let rate = 3.0 * 2.0 * 2.0 * start[n..].iter().map(|other| weight(&start[0], other)).sum::<f64>();
    let scene = Scene { start: &start, forces: &THICK, integrator: Method::Rk4.integrator(), ..Scene::EMPTY };
    let mut system = started(&scene, 2 * n, 0);
    run(&mut system, &scene, 1e-3, 100);
    let expected = 1e-3 * (-0.1 * rate).exp();
    assert!(expected < 5e-4, "{rate}");
    for (i, v) in system.particles().velocity.iter().enumerate() {
        let along = if i < n { expected } else { -expected };
        assert!(gap(f64s(*v), [0.0, 0.0, along]) < 2e-6 * expected + 1e-9, "{i}: {v} {along}");
    }
}

#[test]
fn what_is_not_a_number_harms_no_neighbour() {
    let nan = f32::NAN;
    let at = |x: f32| Particle { position: Vec3::new(x, 0.1 * x * x, 0.2), charge: 1e-6, ..Particle::REST };
    let bad = [
        Particle { position: Vec3::new(nan, 0.0, 0.0), ..at(0.0) },
        Particle { position: Vec3::new(0.0, f32::INFINITY, 0.0), ..at(0.0) },
        Particle { velocity: Vec3::splat(nan), ..at(0.05) },
        Particle { velocity: Vec3::X * f32::INFINITY, ..at(0.05) },
        Particle { mass: nan, ..at(0.05) },
        Particle { charge: nan, ..at(0.05) },
    ];
    let charged = Radial(PowerLaw { weight: Weight::Charge, ..SOFT.0 });
    let pressure = Pressure { triangles: [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]], amount: 1.0, outside: 0.1 };
    let forces: [&dyn Force; 6] = [&ATOMS, &SOFT, &charged, &THICK, &Coulomb::VACUUM, &pressure];
    for (i, force) in forces.into_iter().enumerate() {
        for bad in bad {
            let start = [bad, at(0.3), at(0.6), Particle { position: Vec3::Z, ..at(0.0) }];
            for &method in Method::ALL {
                for index in [&() as &dyn IndexChoice, &Structure::Grid] {
                    let integrator = method.integrator();
                    let scene = Scene { start: &start, forces: force, index, integrator, ..Scene::EMPTY };
                    let mut system = started(&scene, 4, 0);
                    for step in 1..=3 {
                        system.step(&scene, Time::frame(step, 100) - system.time());
                    }
                    assert!(system.len() >= 3, "{i}, {method}: beside {bad:?}");
                    assert!(system.particles().position.iter().all(|x| x.is_finite()));
                }
            }
        }
    }
}

#[test]
fn any_exponent_goes() {
    let law = Radial(PowerLaw { exponent: u8::MAX, ..SOFT.0 });
    let start = [0.0, 0.4].map(|x| Particle { position: Vec3::X * x, ..Particle::REST });
    let scene = Scene { start: &start, forces: &law, integrator: &Method::Implicit, ..Scene::EMPTY };
    let mut system = started(&scene, 2, 0);
    system.step(&scene, Time::frame(1, 60));
    assert_eq!(system.len(), 2);
}

/// A particle that has more neighbours than are sorted at once has all of them, in their order, by any index.
#[test]
fn a_crowd_has_all_its_neighbours_in_their_order() {
    let mut random = Random::new(17);
    for (count, reach) in [(600, 2.0), (1_300, 0.9), (1_024, 2.0), (513, 2.0)] {
        let places: Vec<Vec3> = (0..count).map(|_| random.vector(0.5)).collect();
        let (rows, mut most) = (0..count / 8, 0);
        let mut want: Vec<(usize, Vec<u32>)> = vec![];
        Neighbours::among(&places).of(rows.clone(), reach, &mut |row, others| {
            if want.last().is_none_or(|last| last.0 != row) {
                want.push((row, vec![]));
            }
            want.last_mut().expect("it has just come").1.extend(others.rows());
        });
        for &structure in Structure::ALL {
            let mut memory = vec![0; structure.words(count)];
            let mut index = structure.index(&mut memory);
            index.build(&places, reach).expect("there is room");
            let mut found: Vec<(usize, Vec<u32>)> = vec![];
            Neighbours::by(Some(&index), &places).of(rows.clone(), reach, &mut |row, others| {
                if found.last().is_none_or(|last| last.0 != row) {
                    found.push((row, vec![]));
                }
                found.last_mut().expect("it has just come").1.extend(others.rows());
            });
            found.sort_by_key(|(row, _)| *row);
            assert!(found == want, "{count} within {reach} m, {structure}");
            most = found.iter().map(|(_, others)| others.len()).fold(most, usize::max);
        }
        assert!(most > 512 || count == 513 && most == 512, "{most}");
    }
}
