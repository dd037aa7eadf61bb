//! What touches and what is bound acts through the sides of a periodic room as it does far from them.

use pointmass::force::Force;
use pointmass::index::{IndexChoice, Periodic, Room, Structure};
use pointmass::motion::{Motion, Script};
use pointmass::{
    Attach, Constraint, ContactMaterial, Contacts, Distance, Heap, Meetings, Method, Particle, Penalty, Rope, Scene,
    Size, System, Time, Vec3,
};
use pointmass_tests::{Random, f64s, gap, is_run, is_third, started};

/// Rooms of unlike sides about the origin and far from it, and one that is open upward.
fn rooms() -> [Room; 3] {
    [
        Room::new(Vec3::splat(-2.0), Vec3::new(4.0, 5.0, 6.0)),
        Room::new(Vec3::new(50.0, -30.0, 4.0), Vec3::new(4.4, 4.0, 4.8)),
        Room::new(Vec3::ZERO, Vec3::new(4.0, 0.0, 4.0)),
    ]
}

fn ball(position: Vec3, velocity: Vec3) -> Particle {
    Particle { position, velocity, radius: 0.2, elasticity: 0.6, ..Particle::REST }
}

/// Four balls, of which the last flies into the others, unlike in mass.
fn clump() -> Vec<Particle> {
    let places = [Vec3::ZERO, Vec3::new(0.3, 0.35, 0.1), Vec3::new(-0.1, -0.5, 0.05), Vec3::new(-0.9, 0.1, 0.02)];
    let speeds = [Vec3::ZERO, Vec3::NEG_Y * 0.2, Vec3::Y * 0.1, Vec3::new(2.0, 0.1, 0.0)];
    (0..4).map(|i| Particle { mass: 1.0 + 0.5 * i as f32, ..ball(places[i], speeds[i]) }).collect()
}

/// Five on a line, 0.3 m from one to the next, that turns and drifts.
fn chain() -> Vec<Particle> {
    let place = |i: usize| Vec3::new(0.3 * (i as f32 - 2.0), 0.0, 0.0);
    let speed = |i: usize| Vec3::new(0.7, 1.5 * place(i).x, -0.4 * place(i).x + 0.2);
    (0..5).map(|i| Particle { mass: 1.0 + 0.2 * i as f32, ..ball(place(i), speed(i)) }).collect()
}

/// The same with a ball on its way.
fn chain_and_ball() -> Vec<Particle> {
    let mut all: Vec<_> = chain().into_iter().map(|p| Particle { radius: 0.1, ..p }).collect();
    all.push(Particle { radius: 0.15, ..ball(Vec3::new(0.95, 0.1, 0.05), Vec3::ZERO) });
    all
}

/// A way for particles to act on each other.
struct Bond {
    name: &'static str,
    start: Vec<Particle>,
    force: Box<dyn Force>,
    constraint: Box<dyn Constraint>,
    meetings: Meetings,
}

/// All ways, with scripts that turn about a pivot.
fn bonds(pivot: Vec3) -> Vec<Bond> {
    let rods = [0, 1, 2, 3].map(|i| Distance { damping: 0.1, ..Distance::rod([i, i + 1], 0.3) });
    let strings = [0, 1, 2, 3].map(|i| Distance { compliance: 1e-4, ..Distance::string([i, i + 1], 0.32) });
    let rope = || Rope::rigid(vec![0, 1, 2, 3, 4], vec![0.3]);
    let loose = Rope { damping: 0.2, ..Rope::string(vec![0, 1, 2, 3, 4], vec![0.31]) };
    let motion = Motion { pivot, axis: Vec3::Z, spin: 0.3, drift: Vec3::new(2.0, -1.0, 0.5), ..Motion::STILL };
    let pulled = (Attach { particles: [0, 1], motion }, [1, 2, 3].map(|i| Distance::rod([i, i + 1], 0.3)));
    let pushes = Penalty { stiffness: 5e3, damping: 5.0, reach: 0.5, ..Penalty::NONE };
    let of = |name, start: fn() -> Vec<Particle>, constraint: Box<dyn Constraint>| {
        let (force, meetings): (Box<dyn Force>, _) = (Box::new(()), Meetings::Through);
        Bond { name, start: start(), force, constraint, meetings }
    };
    vec![
        of("position", clump, Box::new(Contacts::HARD)),
        of("soft position", clump, Box::new(Contacts { compliance: 1e-4 })),
        Bond { meetings: Meetings::IMPULSE, ..of("impulse", clump, Box::new(())) },
        Bond { force: Box::new(pushes), ..of("force", clump, Box::new(())) },
        of("rods", chain, Box::new(rods)),
        of("strings", chain, Box::new(strings)),
        of("rope", chain, Box::new(rope())),
        of("loose rope", chain, Box::new(loose)),
        of("attached", chain, Box::new(pulled)),
        of("rope with contacts", chain_and_ball, Box::new((rope(), Contacts::HARD))),
    ]
}

fn run(scene: &Scene<'_>, h: f64, steps: u32) -> System<Heap> {
    let mut system = System::with(Heap::new(Size { columns: scene.columns_with_lists(), ..scene.size() }));
    system.start(scene, 3).expect("it fits");
    for i in 1..=steps {
        system.step(scene, Time::from_seconds_f64(h * f64::from(i)) - system.time());
    }
    system
}

/// Wherever in a room things are, beside a side, an edge or a corner, they go on as far from all sides, for half a second.
#[test]
fn sides_are_nowhere() {
    let shifts = [Vec3::splat(0.5), Vec3::ZERO, Vec3::new(0.1, 0.0, 0.96), Vec3::new(0.98, 0.5, 0.03)];
    let mut cases = 0;
    for (i, &method) in Method::ALL.iter().enumerate() {
        for (room, (substeps, h)) in rooms().into_iter().zip([(1, 2e-3), (4, 1e-2), (12, 1.0 / 60.0)]) {
            for (k, &share) in shifts.iter().enumerate() {
                let by = room.low() + share * room.sides();
                // Scripts turn about what is beside the first that they move.
                let first = chain()[0].position;
                let pivot = room.wrap(first + by) - first;
                for (open, shifted) in bonds(Vec3::ZERO).into_iter().zip(bonds(pivot)) {
                    if !is_run(&mut cases) {
                        continue;
                    }
                    let at = |particle: &Particle| room.wrap(particle.position + by);
                    let start: Vec<_> = open.start.iter().map(|p| Particle { position: at(p), ..*p }).collect();
                    let structure = Structure::ALL[(i + k) % Structure::ALL.len()];
                    let index = Periodic { room, index: structure };
                    let scene = |bond: &'_ Bond| Scene {
                        integrator: method.integrator(),
                        substeps,
                        meetings: bond.meetings,
                        ..Scene::EMPTY
                    };
                    let far = Scene {
                        start: &open.start,
                        forces: &*open.force,
                        constraints: &*open.constraint,
                        ..scene(&open)
                    };
                    let near = Scene {
                        start: &start,
                        forces: &*shifted.force,
                        constraints: &*shifted.constraint,
                        index: &index,
                        ..scene(&shifted)
                    };
                    let steps = (0.5 / h) as u32;
                    let [outside, inside] = [&far, &near].map(|scene| run(scene, h, steps));
                    assert_eq!(inside.totals().contacts > 0, outside.totals().contacts > 0, "{}", open.name);
                    let room_for = 2e-3 * (1.0 + 0.2 * room.low().length());
                    for row in 0..start.len() {
                        let [a, b] = [&outside, &inside].map(|system| system.particles());
                        let off = room.between(room.wrap(a.position[row] + by), b.position[row]).length();
                        let what = format!("{} by {method}, {structure}, shift {k}, {room:?}", open.name);
                        assert!(off < room_for, "{off} m off: {what}");
                        let off = a.velocity[row].distance(b.velocity[row]);
                        assert!(off < 20.0 * room_for, "{off} m/s off: {what}");
                        assert_eq!(room.wrap(b.position[row]), b.position[row]);
                    }
                }
            }
        }
    }
}

/// A gas of balls without a wall keeps its momentum, and of elastic ones by impulses its energy, whatever index finds who is near whom, to
/// the same bits, in threads or not.
#[test]
fn a_gas_of_balls_has_no_walls() {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(3).build().expect("three threads");
    let mut cases = 0;
    for room in rooms() {
        let mut random = Random::new(11);
        let at = |i: usize| Vec3::new((i % 4) as f32, (i / 4 % 4) as f32, (i / 16) as f32) * 0.9 + 0.13;
        let start: Vec<_> = (0..64)
            .map(|i| Particle {
                elasticity: 1.0,
                radius: 0.3,
                ..ball(room.wrap(room.low() + at(i)), random.vector(3.0))
            })
            .collect();
        let momentum = |system: &System<Heap>| {
            system.particles().velocity.iter().fold([0.0; 3], |sum, v| std::array::from_fn(|i| sum[i] + f64s(*v)[i]))
        };
        let energy = |system: &System<Heap>| {
            system.particles().velocity.iter().map(|v| gap(f64s(*v), [0.0; 3]).powi(2)).sum::<f64>()
        };
        for (meetings, constraint) in [(Meetings::IMPULSE, None), (Meetings::Through, Some(Contacts::HARD))] {
            let play = |index: &dyn IndexChoice| {
                let substeps = if constraint.is_some() { 4 } else { 1 };
                let scene =
                    Scene { start: &start, meetings, constraints: &constraint, substeps, index, ..Scene::EMPTY };
                let begun = started(&scene, start.len(), 3);
                let ended = run(&scene, 4e-3, 250);
                assert!(ended.totals().contacts > 30 && ended.totals().caps.contacts == 0, "{:?}", ended.totals());
                assert!(gap(momentum(&ended), momentum(&begun)) < 2e-4, "momentum off");
                let gained = energy(&ended) / energy(&begun) - 1.0;
                assert!(constraint.is_some() || gained.abs() < 1e-4, "energy off by {gained}");
                ended.hash()
            };
            let among_all = play(&Periodic { room, index: () });
            for &structure in Structure::ALL.iter().filter(|_| is_third(&mut cases)) {
                let index = Periodic { room, index: structure };
                assert_eq!(play(&index), among_all, "{structure}");
                assert_eq!(pool.install(|| play(&index)), among_all, "{structure} in threads");
            }
            assert!(play(&()) != among_all);
        }
    }
}

/// Nothing passes through anything, however many sides it goes in a step: of two equal balls on one line the one that rests is met, and takes
/// over.
#[test]
fn who_goes_round_in_a_step_meets_what_is_on_the_way() {
    let room = Room::new(Vec3::ZERO, Vec3::splat(4.0));
    for speed in [3.0, 13.0, 27.0] {
        for h in [1e-2, 0.1, 0.25] {
            let from = Vec3::new(3.9, 1.0, 1.0);
            let start = [ball(from, Vec3::X * speed), ball(Vec3::new(1.0, 1.0, 1.0), Vec3::ZERO)];
            let start = start.map(|ball| Particle { elasticity: 1.0, ..ball });
            let index = Periodic { room, index: Structure::Grid };
            let scene = Scene { start: &start, meetings: Meetings::IMPULSE, index: &index, ..Scene::EMPTY };
            // They are 1.1 m apart through the side, and touch at 0.4 m.
            let end = Time::from_seconds(0.75 / speed);
            let mut system = started(&scene, 2, 0);
            while system.time() < end {
                system.step(&scene, Time::from_seconds(h).min(end - system.time()));
            }
            assert_eq!(system.totals().contacts, 1, "{speed} m/s, {h} s");
            let p = system.particles();
            assert!((p.velocity[1].x - speed).abs() < 1e-4 && p.velocity[0].x.abs() < 1e-4, "{:?}", p.velocity);
            assert!((p.position[0].x - 0.6).abs() < 1e-4 && (p.position[1].x - 1.05).abs() < 1e-4, "{:?}", p.position);
        }
    }
    // In one step it goes round and meets it from behind.
    let start = [ball(Vec3::new(1.0, 1.0, 1.0), Vec3::X * 30.0), ball(Vec3::new(0.5, 1.0, 1.0), Vec3::ZERO)];
    let index = Periodic { room, index: () };
    let scene = Scene { start: &start, meetings: Meetings::IMPULSE, index: &index, ..Scene::EMPTY };
    let mut system = started(&scene, 2, 0);
    system.step(&scene, Time::from_seconds(0.125));
    assert_eq!(system.totals().contacts, 1);
}

/// A chain that is closed through a side holds what presses on it: what is pulled to one side by what goes round is at rest.
/// Whoever parts so fast that another image of the other is nearer in the end has met nobody.
#[test]
fn who_parts_fast_meets_no_image() {
    let room = Room::new(Vec3::ZERO, Vec3::ONE);
    let index = Periodic { room, index: () };
    for (x, way) in [0.3, 0.9].into_iter().flat_map(|x| [0.35, 0.45, 0.55, 0.65, 0.75].map(|way| (x, way))) {
        for towards in [Vec3::X, Vec3::new(0.6, 0.8, 0.0)] {
            let ball = |place, speed| Particle { position: place, velocity: speed, radius: 0.05, ..Particle::REST };
            let at = Vec3::splat(x);
            let start = [ball(at, towards * (-0.5 * way)), ball(at + towards * 0.1005, towards * (0.5 * way))];
            let contacts = Contacts::default();
            let scene = Scene { start: &start, constraints: &contacts, index: &index, ..Scene::EMPTY };
            let system = run(&scene, 1.0, 1);
            for (row, ball) in start.iter().enumerate() {
                let apart = room.between(system.particles().position[row], ball.position + ball.velocity);
                assert!(apart.length() < 1e-5, "{x} {way} {towards}: {apart}");
            }
        }
    }
}

#[test]
fn chains_close_through_a_side() {
    let room = Room::new(Vec3::X * -7.0, Vec3::X * 4.0);
    for method in [Method::Symplectic, Method::Verlet] {
        let place = |i: u32| Vec3::X * (-7.0 + 0.5 * i as f32);
        let start: Vec<_> = (0..8)
            .map(|i| Particle { position: place(i), velocity: Vec3::new(1.0, 0.0, 0.0), ..Particle::REST })
            .collect();
        let rods: [Distance; 8] = std::array::from_fn(|i| Distance::rod([i as u32, (i as u32 + 1) % 8], 0.5));
        let rope = Rope { closed: true, ..Rope::rigid([0, 1, 2, 3, 4, 5, 6, 7], [0.5]) };
        let index = Periodic { room, index: () };
        for constraints in [&rods as &dyn Constraint, &rope] {
            let scene = Scene {
                start: &start,
                constraints,
                index: &index,
                substeps: 3,
                integrator: method.integrator(),
                ..Scene::EMPTY
            };
            let system = run(&scene, 0.01, 500);
            // All go on alike: no link is longer or shorter than it is to be, the one through the side neither.
            for row in 0..8 {
                let to = Vec3::X * (f64s(place(row))[0] + system.time().seconds_f64()) as f32;
                let off = room.between(room.wrap(to), system.particles().position[row as usize]).length();
                assert!(off < 1e-3, "{method}: {off} m off");
                assert!((system.particles().velocity[row as usize].x - 1.0).abs() < 1e-3);
            }
        }
    }
}

/// Friction in a room: a ball that lies on another, which slides away below it through a side, is taken along as far from all sides.
#[test]
fn friction_acts_through_sides() {
    let rough = [ContactMaterial {
        friction: Some(pointmass::force::Friction { static_: 0.5, kinetic: 0.5 }),
        elasticity: Some(0.0),
    }];
    let play = |room: Option<Room>, by: Vec3| {
        let fast = Particle { material: Some(0), ..ball(Vec3::ZERO, Vec3::X * 2.0) };
        let slow = Particle { material: Some(0), ..ball(Vec3::new(0.35, 0.18, 0.0), Vec3::ZERO) };
        let start = [fast, slow]
            .map(|p| Particle { position: room.map_or(p.position + by, |room| room.wrap(p.position + by)), ..p });
        let index = Periodic { room: room.unwrap_or(Room::OPEN), index: Structure::Grid };
        let scene = Scene {
            start: &start,
            materials: &rough,
            constraints: &Contacts::HARD,
            substeps: 8,
            index: &index,
            ..Scene::EMPTY
        };
        run(&scene, 1.0 / 60.0, 30).particles().velocity.to_vec()
    };
    let far = play(None, Vec3::ZERO);
    assert!(far[1].y > 0.01 && far[0].y < -0.01, "{far:?}");
    for room in rooms() {
        let near = play(Some(room), room.low());
        assert!(near.iter().zip(&far).all(|(a, b)| a.distance(*b) < 1e-2), "{near:?}, not {far:?}");
    }
}

/// A script is a frame that knows no sides: who is attached is where it leads, less whole sides.
#[test]
fn scripts_lead_through_sides() {
    let room = Room::new(Vec3::splat(-1.0), Vec3::new(2.0, 3.0, 2.5));
    let motion = Motion { drift: Vec3::new(3.0, -2.0, 0.5), swing: Vec3::Z, frequency: 0.7, ..Motion::STILL };
    let start =
        [Vec3::new(0.9, 0.0, 0.0), Vec3::new(-0.9, 0.2, 1.4)].map(|x| Particle { fixed: true, ..ball(x, Vec3::ZERO) });
    let attach = Attach { particles: [0, 1], motion };
    let index = Periodic { room, index: () };
    for (substeps, h) in [(1, 0.05), (7, 0.2)] {
        let scene = Scene { start: &start, constraints: &attach, substeps, index: &index, ..Scene::EMPTY };
        let system = run(&scene, h, (5.0 / h) as u32);
        let frame = motion.frame(system.time());
        for (row, particle) in start.iter().enumerate() {
            let off = room.between(room.wrap(frame.world(particle.position)), system.particles().position[row]);
            assert!(off.length() < 1e-4, "{off} m off");
            let place = frame.world(particle.position);
            assert!(system.particles().velocity[row].distance(frame.velocity_at(place)) < 1e-5);
        }
    }
}
