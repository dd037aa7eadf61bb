//! What acts through the sides of a periodic room, against the same among images of the particles in open space.

use pointmass::force::{Radial, State, Weight};
use pointmass::index::{Periodic, Room, Structure};
use pointmass::reap::Dense;
use pointmass::scene::{Model, SceneFile};
use pointmass::{
    Drag, Effort, Emit, Emitter, Force, Gravity, Heap, LennardJones, Method, Particle, Penalty, PowerLaw, Scene, Size,
    Spring, System, Time, Varied, Vec3, Viscosity,
};
use pointmass_tests::{Random, every, f64s, gap, point, started, structures};

const ATOMS: Radial<LennardJones> = Radial(LennardJones { epsilon: 1.0, sigma: 0.3, cutoff: 0.75 });
const SOFT: Radial<PowerLaw> =
    Radial(PowerLaw { strength: -2.0, exponent: 3, softening: 0.2, reach: 0.6, weight: Weight::Mass });
const THICK: Viscosity = Viscosity { coefficient: 3.0, reach: 0.5 };
const PUSH: Penalty = Penalty { stiffness: 50.0, damping: 0.2, reach: 0.5, ..Penalty::NONE };

/// Rooms with all sides alike, with unlike ones far from the origin, and one that is open upward.
fn rooms() -> [Room; 3] {
    [
        Room::new(Vec3::splat(-1.0), Vec3::splat(2.0)),
        Room::new(Vec3::new(500.0, -300.0, 40.0), Vec3::new(1.6, 2.5, 3.0)),
        Room::new(Vec3::ZERO, Vec3::new(2.0, 0.0, 2.0)),
    ]
}

/// Particles anywhere in a room, up to 2 m along sides that are open.
fn cloud(room: &Room, n: usize) -> Vec<Particle> {
    let mut random = Random::new(4);
    let sides = Vec3::select(room.sides().cmpgt(Vec3::ZERO), room.sides(), Vec3::splat(2.0));
    let place = |random: &mut Random| room.low() + sides * (random.vector(0.5) + 0.5);
    (0..n)
        .map(|_| Particle {
            position: room.wrap(place(&mut random)),
            velocity: random.vector(0.5),
            mass: random.magnitude(0.5, 2.0),
            radius: 0.2,
            ..Particle::REST
        })
        .collect()
}

/// The particles, and behind them all their images beside the room.
fn images(room: &Room, particles: &[Particle]) -> Vec<Particle> {
    let mut all = particles.to_vec();
    for code in (0..27).filter(|&code| code != 13) {
        let signs = [code % 3 - 1, code / 3 % 3 - 1, code / 9 - 1].map(|sign| sign as f32);
        let moved = Vec3::from_array(signs) * room.sides();
        if (0..3).all(|axis| signs[axis] == 0.0 || room.sides()[axis] > 0.0) {
            all.extend(particles.iter().map(|p| Particle { position: p.position + moved, ..*p }));
        }
    }
    all
}

fn forces(state: &State<'_>, rows: usize, force: &dyn Force) -> Vec<Vec3> {
    let mut total = vec![Vec3::ZERO; state.position.len()];
    force.add_to(state, 0..state.position.len(), &mut total);
    total.truncate(rows);
    total
}

#[test]
fn forces_act_as_among_images() {
    for room in rooms() {
        let start = cloud(&room, 150);
        let all = images(&room, &start);
        let index = Periodic { room, index: Structure::Grid };
        let closed = Scene { start: &start, index: &index, ..Scene::EMPTY };
        let open = Scene { start: &all, ..Scene::EMPTY };
        let [inside, outside] = [&closed, &open].map(|scene| started(scene, scene.start.len(), 0));
        for force in [&ATOMS as &dyn Force, &SOFT, &THICK, &PUSH] {
            let near = forces(&inside.state(&closed), 150, force);
            let far = forces(&outside.state(&open), 150, force);
            // The forces of steep laws are large where two lie close; images lie within a rounding of where they should.
            for (near, far) in near.iter().zip(&far) {
                let room = 2e-4 * (1.0 + far.length()) * (1.0 + 1e-2 * room.low().length());
                assert!(near.distance(*far) < room, "{}: {near} {far}", force.name());
            }
            let through =
                near.iter().zip(forces(&started(&closed, 150, 0).state(&Scene { index: &(), ..closed }), 150, force));
            assert!(through.filter(|(a, b)| **a != *b).count() > 20, "{} acts through sides", force.name());
            let energy = force.energy(&inside.state(&closed));
            assert!(force.name() == "viscosity" || energy != 0.0 && energy.is_finite());
        }
    }
}

/// A run of a scene with so many vectors a particle to work with; its hash after every fourth step, and its effort.
fn history(scene: &Scene<'_>, columns: usize, h: f64) -> (Vec<u64>, Effort) {
    let mut system = System::with(Heap::new(Size { particles: 420, columns, ..scene.size() }));
    system.start(scene, 3).expect("it fits");
    let hashes = (1..=20).map(|i| {
        system.step(scene, Time::from_seconds_f64(h * f64::from(i)) - system.time());
        system.hash()
    });
    (hashes.step_by(4).collect(), system.totals().effort)
}

/// Runs are the same to the bit whether neighbours are looked for among all, streamed from any index, or kept in lists, while
/// particles leave at one side and come in at the other, and some are born and die.
#[test]
fn however_neighbours_are_found_runs_in_a_room_are_the_same() {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(3).build().expect("three threads");
    let (mut listed, mut streamed) = (0, 0);
    for (i, method) in Method::ALL.iter().enumerate() {
        for room in [rooms()[i % 3], rooms()[(i + 1) % 3]].into_iter().step_by(every(2)) {
            let mut start = cloud(&room, 160);
            start.iter_mut().for_each(|particle| particle.velocity *= 20.0);
            let force = (SOFT, THICK, Gravity { acceleration: Vec3::X });
            let middle = room.low() + 0.5 * room.sides();
            let jet = Emitter { lifetime: Varied::exactly(0.02), ..Emitter::new(point(middle), 150.0) };
            let none = Scene { start: &start, forces: &force, ..Scene::EMPTY };
            let h = if room.low() == Vec3::ZERO { 0.02 } else { 1e-3 };
            let emitters: &dyn Emit = if i % 2 == 0 { &jet } else { &() };
            let all = Periodic { room, index: () };
            let plain = Scene { integrator: method.integrator(), emitters, index: &all, ..none };
            let (expected, effort) = history(&plain, plain.columns(), h);
            assert!(effort.all_pairs > 0 && effort.lists + effort.streamed == 0);
            for &structure in structures(i) {
                let index = Periodic { room, index: structure };
                let scene = Scene { index: &index, ..plain };
                let (hashes, effort) = history(&scene, scene.columns(), h);
                assert_eq!(hashes, expected, "{method}, {structure}, {room:?}");
                assert!(effort.all_pairs + effort.lists == 0 && effort.streamed > 0);
                let (hashes, effort) = history(&scene, scene.columns_with_lists(), h);
                assert_eq!(hashes, expected, "{method}, {structure}, listed, {room:?}");
                (listed, streamed) = (listed + effort.evaluations - effort.streamed, streamed + effort.streamed);
            }
            let index = Periodic { room, index: Structure::Kd };
            let scene = Scene { index: &index, ..plain };
            let (hashes, _) = pool.install(|| history(&scene, scene.columns_with_lists(), h));
            assert_eq!(hashes, expected, "{method} in threads");
        }
    }
    assert!(listed > 300 && streamed > 100, "{listed} {streamed}");
}

/// Lists are kept while particles go through sides: who is wrapped has not gone far.
#[test]
fn lists_last_through_sides() {
    let room = Room::new(Vec3::ZERO, Vec3::splat(3.0));
    let start: Vec<_> = cloud(&room, 400).into_iter().map(|p| Particle { velocity: Vec3::X * 3.0, ..p }).collect();
    let index = Periodic { room, index: Structure::Hash };
    let scene = Scene { start: &start, forces: &(THICK, Drag {}), index: &index, ..Scene::EMPTY };
    let (_, effort) = history(&scene, scene.columns_with_lists(), 1e-3);
    assert!(effort.lists > 0 && 3 * (effort.lists + effort.streamed) < effort.evaluations, "{effort:?}");
}

/// Who flies freely is where its way leads, less whole sides; distances and energies do not tell where the room's corner lies.
#[test]
fn flights_are_wrapped_and_corners_do_not_matter() {
    for room in rooms() {
        let start = cloud(&room, 40);
        let index = Periodic { room, index: Structure::Octree };
        for h in [0.01, 0.3] {
            let scene = Scene { start: &start, index: &index, ..Scene::EMPTY };
            let mut system = started(&scene, 40, 0);
            for i in 1..=200 {
                system.step(&scene, Time::from_seconds_f64(h * f64::from(i)) - system.time());
            }
            let t = system.time().seconds_f64();
            for (row, from) in start.iter().enumerate() {
                let at = f64s(system.particles().position[row]);
                let size = f64::from(room.low().length() + from.velocity.length() * t as f32) + 4.0;
                assert!(system.particles().velocity[row] == from.velocity);
                for (axis, at) in at.into_iter().enumerate() {
                    let (side, low) = (f64::from(room.sides()[axis]), f64::from(room.low()[axis]));
                    let way = f64s(from.position)[axis] + f64s(from.velocity)[axis] * t;
                    let wrapped = if side > 0.0 { low + (way - low).rem_euclid(side) } else { way };
                    let off = (wrapped - at).abs();
                    // Beside a side rounding may put it on the other.
                    let off = if side > 0.0 { off.min((off - side).abs()) } else { off };
                    assert!(off < 200.0 * 6e-8 * size + 1e-5, "{off} m off");
                    assert!(side == 0.0 || (low - 1e-4..low + side + 1e-4).contains(&at));
                }
            }
        }
    }
    // The same crowd, moved and wrapped anew.
    let energy = |by: Vec3| {
        let room = Room::new(Vec3::ZERO, Vec3::splat(2.0));
        let mut start = cloud(&room, 200);
        start.iter_mut().for_each(|particle| particle.position = room.wrap(particle.position + by));
        let index = Periodic { room, index: Structure::Bvh };
        let scene = Scene { start: &start, index: &index, ..Scene::EMPTY };
        SOFT.energy(&started(&scene, 200, 0).state(&scene))
    };
    let all = [Vec3::ZERO, Vec3::splat(0.7), Vec3::new(-0.3, 1.9, 55.5)].map(energy);
    assert!(all.iter().all(|energy| (energy / all[0] - 1.0).abs() < 1e-4), "{all:?}");
}

/// A ring of N masses and springs through one side swings in its n-th mode at 2 √(k/m) sin(π n/N).
#[test]
fn waves_go_round_through_a_side() {
    let (count, stiffness, mass) = (24, 40.0, 0.1);
    for (n, low) in [(1, 0.0), (2, -30.0), (5, 3.0)] {
        let room = Room::new(Vec3::X * low, Vec3::X * 6.0);
        let turn = |i: u32| std::f64::consts::TAU * f64::from(i * n) / f64::from(count);
        let place = |i: u32| low + 0.25 * i as f32 + 0.004 * turn(i).sin() as f32;
        let start: Vec<_> =
            (0..count).map(|i| Particle { position: room.wrap(Vec3::X * place(i)), mass, ..Particle::REST }).collect();
        let springs: Vec<_> = (0..count).map(|i| Spring::new([i, (i + 1) % count], 0.25, stiffness)).collect();
        let index = Periodic { room, index: () };
        let scene = Scene {
            start: &start,
            springs: &springs,
            integrator: Method::Verlet.integrator(),
            index: &index,
            ..Scene::EMPTY
        };
        let mut system = started(&scene, count as usize, 0);
        let frequency = 2.0 * f64::from(stiffness / mass).sqrt() * (turn(1) / 2.0).sin();
        let h = 0.04 / frequency;
        // The mode's share: after half a swing it is the other way round, after a quarter it is nothing.
        let mut share = |until: f64| {
            while system.time().seconds_f64() < until - 0.5 * h {
                system.step(&scene, Time::from_seconds_f64(h));
            }
            let p = system.particles();
            let off = |i: u32| {
                let rest = Vec3::X * (low + 0.25 * i as f32);
                f64::from(room.between(rest, p.position[i as usize]).x)
            };
            (0..count).map(|i| off(i) * turn(i).sin()).sum::<f64>() / (0.002 * f64::from(count))
        };
        let swing = std::f64::consts::TAU / frequency;
        for (part, expected) in [(0.25, 0.0), (0.5, -1.0), (0.75, 0.0), (1.0, 1.0)] {
            let found = share(part * swing);
            let room = 0.02 + 1e-3 * f64::from(low.abs());
            assert!((found - expected).abs() < room, "mode {n} after {part}: {found}, not {expected}");
        }
        assert!(scene.springs.list().len() == 24);
    }
}

/// A crystal of atoms (face-centred cubic) in a room has the energy of its shells of neighbours, and no force on any.
#[test]
fn a_crystal_has_no_surface() {
    let (cells, a) = (3, 0.5_f32);
    let basis = [[0.0, 0.0, 0.0], [0.5, 0.5, 0.0], [0.5, 0.0, 0.5], [0.0, 0.5, 0.5]].map(Vec3::from_array);
    for low in [Vec3::ZERO, Vec3::new(20.0, -7.0, 0.3)] {
        let mut start = Vec::new();
        for code in 0..cells * cells * cells {
            let cell = Vec3::new((code % cells) as f32, (code / cells % cells) as f32, (code / cells / cells) as f32);
            start.extend(basis.map(|at| Particle { position: low + (cell + at) * a, ..Particle::REST }));
        }
        let room = Room::new(low, Vec3::splat(a * cells as f32));
        let (sigma, cutoff) = (0.33_f64, 0.74_f64);
        let atoms = Radial(LennardJones { epsilon: 1.0, sigma: sigma as f32, cutoff: cutoff as f32 });
        // Numbers of neighbours of an atom at distances squared of 1/2, 1, 3/2, 2 sides squared.
        let shells = [(12.0, 0.5), (6.0, 1.0), (24.0, 1.5), (12.0, 2.0)];
        let at = |square: f64| {
            let s6 = (sigma * sigma / square).powi(3);
            4.0 * s6 * (s6 - 1.0)
        };
        let within = shells.iter().map(|(n, square)| (n, square * f64::from(a * a))).filter(|s| s.1 < cutoff * cutoff);
        let each: f64 = within.map(|(n, square)| 0.5 * n * (at(square) - at(cutoff * cutoff))).sum();
        for structure in [Structure::Brute, Structure::Grid, Structure::Kd] {
            let index = Periodic { room, index: structure };
            let scene = Scene { start: &start, forces: &atoms, index: &index, ..Scene::EMPTY };
            let system = started(&scene, start.len(), 0);
            let state = system.state(&scene);
            let energy = atoms.energy(&state) / start.len() as f64;
            assert!((energy / each - 1.0).abs() < 1e-4, "{energy} J, not {each} J");
            let most = forces(&state, start.len(), &atoms).iter().map(|force| force.length()).fold(0.0, f32::max);
            assert!(most < 2e-2, "{most} N");
        }
    }
}

/// A gas keeps its energy and momentum over thousands of steps, going through all sides.
#[test]
fn a_gas_keeps_energy_and_momentum() {
    let room = Room::new(Vec3::splat(-5.0), Vec3::new(6.0, 7.0, 8.0));
    // Nobody begins closer than the law is soft.
    let at = |i: u32| Vec3::new((i % 5) as f32, (i / 5 % 5) as f32, (i / 25) as f32) * 1.2;
    let mut random = Random::new(8);
    let start: Vec<_> = (0..125)
        .map(|i| Particle { position: room.wrap(at(i)), velocity: random.vector(1.5), ..Particle::REST })
        .collect();
    let law = Radial(LennardJones { epsilon: 0.3, sigma: 1.0, cutoff: 2.9 });
    let index = Periodic { room, index: Structure::Grid };
    let scene =
        Scene { start: &start, forces: &law, integrator: Method::Verlet.integrator(), index: &index, ..Scene::EMPTY };
    let mut system = started(&scene, 125, 0);
    let energy = |system: &System<Heap>| {
        let state = system.state(&scene);
        let kinetic: f64 = state.velocity.iter().map(|v| 0.5 * gap(f64s(*v), [0.0; 3]).powi(2)).sum();
        kinetic + law.energy(&state)
    };
    let momentum = |system: &System<Heap>| {
        system.particles().velocity.iter().fold([0.0; 3], |sum, v| std::array::from_fn(|i| sum[i] + f64s(*v)[i]))
    };
    let (before, p0) = (energy(&system), momentum(&system));
    let mut through = 0;
    for _ in 0..1000 {
        let from = system.particles().position.to_vec();
        system.step(&scene, Time::from_seconds(2e-3));
        let jumped = from.iter().zip(system.particles().position).filter(|(a, b)| a.distance(**b) > 3.0);
        through += jumped.count();
    }
    assert!(through > 50, "{through} went through a side");
    let drift = (energy(&system) - before).abs() / before.abs().max(100.0);
    assert!(drift < 2e-3, "energy off by {drift}");
    assert!(gap(momentum(&system), p0) < 1e-3, "momentum off");
}

/// Births where few are, and deaths where many are, count neighbours through the sides, by any index.
#[test]
fn crowds_are_counted_through_sides() {
    let room = Room::new(Vec3::ZERO, Vec3::splat(2.0));
    let start = cloud(&room, 200);
    let count = |system: &System<Heap>, scene: &Scene<'_>| {
        let state = system.state(scene);
        state.position.iter().map(|x| state.count_within(*x, 0.5)).collect::<Vec<_>>()
    };
    let all = images(&room, &start);
    let open = Scene { start: &all, ..Scene::EMPTY };
    let expected = &count(&started(&open, all.len(), 0), &open)[..200];
    let index = Periodic { room, index: Structure::Grid };
    let closed = Scene { start: &start, index: &index, ..Scene::EMPTY };
    let found = count(&started(&closed, 200, 0), &closed);
    // An image may lie on the other side of the radius by a rounding.
    assert!(found.iter().zip(expected).filter(|(a, b)| a != b).count() <= 1);
    let run = |index: &dyn pointmass::index::IndexChoice| {
        let reapers = Dense { radius: 0.5, most: 12 };
        let scene = Scene { start: &start, reapers: &reapers, index, ..Scene::EMPTY };
        let mut system = started(&scene, 200, 1);
        for _ in 0..10 {
            system.step(&scene, Time::frame(1, 30));
        }
        (system.hash(), system.len())
    };
    let among_all = run(&Periodic { room, index: () });
    for &structure in Structure::ALL {
        assert_eq!(run(&Periodic { room, index: structure }), among_all, "{structure}");
    }
    assert!(among_all != run(&()) && among_all.1 < 200);
}

/// Files name the room; what cannot act through its sides is refused by name.
#[test]
fn files_have_rooms() {
    let load = |text: &str| {
        let file = SceneFile::from_json("r.json", text).map_err(|error| error.to_string())?;
        Model::load(&file, "r.json", &mut ()).map_err(|error| error.to_string())
    };
    let near = r#""forces": [{"power_law": {"strength": 1, "exponent": 2, "reach": 0.5}}]"#;
    let model = load(&format!(
        r#"{{"room": {{"sides": [2, 0, 2]}}, "particles": [{{"position": [1.9, 0, 0.1], "velocity": [1, 0, 0]}}], {near}}}"#
    ));
    let model = model.expect("it is sound");
    let mut system = model.system(1, 1).expect("there is memory");
    system.step_to(&model.scene(), Time::from_seconds(0.5));
    assert!((system.particles().position[0].x - 0.4).abs() < 1e-5);
    for (text, part) in [
        (r#"{"room": {"sides": [0, 0, 0]}}"#, "room.sides"),
        (r#"{"room": {"sides": [1, -2, 0]}}"#, "room.sides"),
        (r#"{"room": {"sides": [1, 1, 1]}, "forces": [{"mutual_gravity": {"constant": 1}}]}"#, "forces[0]"),
        (
            r#"{"room": {"sides": [1, 1, 1]}, "particles": [{"position": [0, 0, 0], "radius": 0.3}], "contacts": {"impulse": {}}}"#,
            "0.6",
        ),
        (
            r#"{"room": {"sides": [1, 1, 1]}, "particles": [{"position": [0, 0, 0], "radius": 0.3}], "contacts": {"position": {}}}"#,
            "0.6",
        ),
        (
            r#"{"room": {"sides": [9, 1, 9]}, "forces": [{"lennard_jones": {"epsilon": 1, "sigma": 0.2, "cutoff": 0.5}}]}"#,
            "0.5",
        ),
        (
            r#"{"room": {"sides": [1, 1, 1]}, "particles": [{"position": [0, 0, 0]}, {"position": [0.5, 0, 0]}], "constraints": [{"distance": {"ends": [0, 1], "length": 1}}]}"#,
            "constraints[0]",
        ),
        (
            r#"{"room": {"sides": [1, 1, 1]}, "particles": [{"position": [0, 0, 0]}, {"position": [0.5, 0, 0]}], "constraints": [{"rope": {"particles": [0, 1], "lengths": [0.6]}}]}"#,
            "constraints[0]",
        ),
        (
            r#"{"room": {"sides": [9, 9, 9]}, "particles": [{"position": [0, 0, 0]}, {"position": [0.5, 0, 0]}], "constraints": [{"cluster": {"particles": [0, 1]}}]}"#,
            "clusters",
        ),
        (
            r#"{"room": {"sides": [9, 1, 9]}, "particles": [{"position": [0, 0, 0]}, {"position": [0.5, 0, 0]}], "springs": [{"ends": [0, 1], "rest_length": 2, "ks": 1}]}"#,
            "springs[0]",
        ),
        (r#"{"room": {"sides": [1, 1, 1]}, "forces": [{"coulomb": {"constant": 1}}]}"#, "forces[0]"),
    ] {
        let error = load(text).expect_err(text);
        assert!(error.contains(part), "{error}");
    }
}
