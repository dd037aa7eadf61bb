//! The ledger closes: what is left over is the method's own error.

use pointmass::force::{Coulomb, Friction, LennardJones, QuadraticDrag, Radial, State, Uniform, Viscosity, Wind};
use pointmass::motion::Motion;
use pointmass::shape::{Aabb, Collider, Cuboid, Cylinder, Moving, Plane};
use pointmass::{
    Adaptive, Books, Cause, ClothSprings, ContactMaterial, Drag, Emitter, Force, Gravity, Heap, Impact, Ledger,
    LifeEvent, Measures, Meetings, Method, MutualGravity, Observer, Particle, Phase, Report, Rk4, Scene, Sheet, Size,
    Spring, SpringParams, System, Time, Varied, Vec3, Verlet,
};
use pointmass_tests::busy::{SIZE, busy};
use pointmass_tests::{Random, point};

/// The books after a second in steps of `h`, and the remainder as a share of all energy that is there or has changed hands.
/// They always add up.
fn books(scene: &Scene<'_>, particles: usize, h: f64) -> (Books, f64) {
    let mut system = System::with(Heap::new(Size { particles, ..scene.size() }));
    system.start(scene, 1).expect("it fits");
    let mut ledger = Ledger::new(&system, scene);
    for i in 1..=(1.0 / h).round() as u32 {
        system.step_observed(scene, Time::from_seconds_f64(h * f64::from(i)) - system.time(), &mut ledger);
    }
    let books = ledger.books().clone();
    let change = books.closing - books.opening;
    assert!((books.total() - change).abs() <= 1e-9 * (books.turnover() + change.abs()), "{books:?}");
    let energy = Measures::of(&system, scene).energy;
    assert!((books.closing - energy.total()).abs() <= 1e-12 * energy.total().abs(), "{books:?} {energy:?}");
    let share = books.remainder.abs() / (books.turnover() + energy.kinetic + energy.potential.abs());
    (books, share)
}

/// Particles at random in a cube of 1 m, with random velocities.
fn cloud(n: usize) -> Vec<Particle> {
    let mut random = Random::new(5);
    let mut vector =
        |size: f32| Vec3::new(random.between(-size, size), random.between(-size, size), random.between(-size, size));
    (0..n)
        .map(|i| Particle {
            position: vector(0.5),
            velocity: vector(1.0),
            mass: 1.0 + i as f32 * 0.1,
            drag: 0.3,
            charge: if i % 2 == 0 { 1e-6 } else { -1e-6 },
            ..Particle::REST
        })
        .collect()
}

fn net() -> (Vec<Particle>, Vec<Spring>) {
    let thread = Some(SpringParams { ks: 50.0, kd: 0.5 });
    let threads = ClothSprings { structural: thread, shear: thread, bend: None };
    let sheet = Sheet { corner: Vec3::ZERO, sides: [Vec3::X, Vec3::Z], cells: [4, 4] };
    let mut particles: Vec<_> = sheet.particles(Particle { mass: 0.1, drag: 0.05, ..Particle::REST }).collect();
    particles[0].fixed = true;
    (particles, sheet.springs(&threads, 0).collect())
}

/// Checks that RK4's remainder falls with the fourth power of the step, or is rounding.
fn check_order(name: &str, scene: &Scene<'_>, particles: usize, steps: [f64; 2]) {
    let [coarse, fine] = steps.map(|h| books(&Scene { integrator: &Rk4, ..*scene }, particles, h));
    println!("{name}: {:.1e} {:.1e}", coarse.1, fine.1);
    assert!(fine.1 < 0.1 * coarse.1 || fine.1 < 3e-6, "{name}\n{coarse:?}\n{fine:?}");
}

#[test]
fn what_is_left_is_the_method_s_error_whatever_acts() {
    let start = cloud(20);
    let wind = Wind { field: Uniform { velocity: Vec3::X * 3.0 }, coefficient: Some(0.2) };
    let forces: [(&str, &dyn Force); 8] = [
        ("gravity", &Gravity::EARTH),
        ("drag", &(Gravity::EARTH, Drag {})),
        ("quadratic drag", &(Gravity::EARTH, QuadraticDrag { coefficient: 0.3 })),
        ("wind", &(Gravity::EARTH, wind)),
        ("mutual gravity", &MutualGravity { constant: 0.05, softening: 0.2, ..MutualGravity::NEWTON }),
        ("charge", &Coulomb { softening: 0.2, ..Coulomb::default() }),
        ("viscosity", &Viscosity { coefficient: 0.2, reach: 10.0 }),
        ("neighbours", &Radial(LennardJones { epsilon: 1e-3, sigma: 0.05, cutoff: 0.5 })),
    ];
    for (name, forces) in forces {
        let scene = Scene { start: &start, forces, ..Scene::EMPTY };
        check_order(name, &scene, 20, [1.0 / 60.0, 1.0 / 240.0]);
    }
    let (start, springs) = net();
    let scene = Scene { start: &start, springs: &springs, forces: &(Gravity::EARTH, Drag {}), ..Scene::EMPTY };
    check_order("net", &scene, start.len(), [1.0 / 60.0, 1.0 / 240.0]);
    let drive = Some(pointmass::force::Drive { amplitude: 0.3, frequency: 1.5, phase: 0.0 });
    let driven: Vec<_> = springs.iter().map(|&spring| Spring { drive, ..spring }).collect();
    let scene = Scene { springs: &driven, ..scene };
    check_order("driven net", &scene, start.len(), [1.0 / 60.0, 1.0 / 240.0]);
    assert!(books(&scene, start.len(), 1.0 / 240.0).0.work("spring drives") > 0.1);
}

#[test]
fn every_cause_has_its_entry() {
    busy(|scene| {
        let (mut books, share) = books(&Scene { integrator: &Rk4, ..*scene }, SIZE.particles, 1.0 / 240.0);
        assert!(books.emission > 0.0 && books.restitution < 0.0 && books.deletion != 0.0, "{books:?}");
        assert!(books.work("drag") < 0.0 && books.work("spring damping") < 0.0, "{books:?}");
        books.work.sort_unstable_by_key(|(name, _)| *name);
        assert!(books.work.windows(2).all(|pair| pair[0].0 != pair[1].0), "{books:?}");
        assert!(share < 2e-3, "{books:?}");
    });
}

#[test]
fn what_should_conserve_leaves_rounding() {
    // Falling by Verlet, and bouncing without loss in a box.
    let start = cloud(20);
    let elastic: Vec<_> = start.iter().map(|p| Particle { elasticity: 1.0, ..*p }).collect();
    let inside = Cuboid { min: Vec3::splat(-0.6), max: Vec3::splat(0.6) };
    let falling = Scene { start: &start, forces: &Gravity::EARTH, integrator: &Verlet, ..Scene::EMPTY };
    let bouncing = Scene { start: &elastic, colliders: &inside, ..falling };
    let flying = Scene { forces: &(), ..bouncing };
    for (scene, bound) in [(falling, 5e-6), (bouncing, 5e-6), (flying, 5e-6)] {
        let (books, share) = books(&scene, 20, 1.0 / 240.0);
        assert!(share < bound && books.restitution.abs() < 1e-6 * books.opening.abs(), "{share} {books:?}");
    }
}

#[test]
fn euler_s_drift_is_the_remainder() {
    // Per kilogram and second g² h / 2, gained by explicit and lost by symplectic Euler.
    let start = [Particle { mass: 2.0, velocity: Vec3::ONE, ..Particle::REST }];
    for (method, sign) in [(Method::Euler, 1.0), (Method::Symplectic, -1.0)] {
        let scene = Scene { start: &start, forces: &Gravity::EARTH, integrator: &method, ..Scene::EMPTY };
        let (books, _) = books(&scene, 1, 0.01);
        let expected = sign * 2.0 * 9.80665f64.powi(2) * 0.01 / 2.0;
        assert!((books.remainder - expected).abs() < 1e-3, "{method}: {} not {expected}", books.remainder);
    }
}

#[test]
fn a_lossy_bounce_is_booked_as_such() {
    let ball = [Particle { position: Vec3::Y, elasticity: 0.8, ..Particle::REST }];
    let ground = Plane { point: Vec3::ZERO, normal: Vec3::Y };
    let scene =
        Scene { start: &ball, forces: &Gravity::EARTH, colliders: &ground, integrator: &Verlet, ..Scene::EMPTY };
    // One impact in the first second, at √(2g): it takes (1 − e²) m g h.
    let (books, _) = books(&scene, 1, 1.0 / 60.0);
    assert!((books.restitution + 0.36 * 9.80665).abs() < 0.01 && books.remainder.abs() < 0.01, "{books:?}");
}

#[test]
fn inner_steps_are_seen() {
    // Two steps a second of many inner ones: their work cannot be told from the ends.
    let (start, springs) = net();
    let integrator = Adaptive { tolerance: 1e-6, ..Adaptive::around(Rk4) };
    let scene = Scene {
        start: &start,
        springs: &springs,
        forces: &(Gravity::EARTH, Drag {}),
        integrator: &integrator,
        ..Scene::EMPTY
    };
    let (books, share) = books(&scene, start.len(), 0.5);
    assert!(books.work("drag") < -0.01 && share < 1e-4, "{books:?}");
}

#[test]
fn births_breaks_and_hands_have_theirs() {
    let start = [Particle::REST, Particle { position: Vec3::X, velocity: Vec3::X * 30.0, ..Particle::REST }];
    let springs = [Spring { breaks_at: Some(1.5), ..Spring::new([0, 1], 1.0, 100.0) }];
    let jet = Emitter { speed: Varied::exactly(2.0), ..Emitter::new(point(Vec3::Y * 9.0), 50.0) };
    let scene = Scene { start: &start, springs: &springs, emitters: &jet, integrator: &Rk4, ..Scene::EMPTY };
    let (books, share) = books(&scene, 100, 1.0 / 240.0);
    // Fifty births of 1 kg at 2 m/s; the spring holds k (0.5 m)² / 2 and a little more when it breaks.
    assert!((books.emission - 100.0).abs() < 1e-3, "{books:?}");
    assert!((-20.0..-12.5).contains(&books.breaking) && share < 1e-4, "{books:?}");

    let mut system = System::with(Heap::new(Size { particles: 3, ..scene.size() }));
    let scene = Scene { emitters: &(), springs: &(), ..scene };
    system.start(&scene, 1).expect("it fits");
    let mut ledger = Ledger::new(&system, &scene);
    system.spawn(&Particle { velocity: Vec3::Y * 4.0, ..Particle::REST }).expect("there is room");
    system.step_observed(&scene, Time::SECOND, &mut ledger);
    assert_eq!(ledger.books().outside, 8.0);
}

#[test]
fn one_beyond_all_numbers_does_not_spoil_the_books() {
    let start = [Particle::REST, Particle { position: Vec3::X, velocity: Vec3::splat(1e30), ..Particle::REST }];
    let law = pointmass_tests::Law(|t, x: f32, _| if t > 0.5 && x > 1e20 { f32::INFINITY } else { -x.min(1.0) });
    let scene = Scene { start: &start, forces: &law, integrator: &Rk4, ..Scene::EMPTY };
    let mut system = System::with(Heap::new(scene.size()));
    system.start(&scene, 1).expect("it fits");
    let mut ledger = Ledger::new(&system, &scene);
    for _ in 0..60 {
        system.step_observed(&scene, Time::frame(1, 60), &mut ledger);
    }
    assert_eq!(system.totals().died.nonfinite, 1);
    let books = ledger.books();
    assert!(books.total().is_finite() && books.deletion < -1e59 && books.closing < 1.0, "{books:?}");
}

const MATERIAL: [ContactMaterial; 1] =
    [ContactMaterial { elasticity: None, friction: Some(Friction { static_: 0.4, kinetic: 0.3 }) }];

#[test]
fn friction_has_its_line() {
    // 5 m/s on level ground: all of 12.5 J, by sliding alone and after a lossy impact, on a slope, and against the floor of a room.
    let (sin, cos) = 0.2f32.sin_cos();
    let slopes = [Vec3::Y, Vec3::new(sin, cos, 0.0)];
    for method in [Method::Midpoint, Method::Verlet, Method::Rk4] {
        for normal in slopes {
            for (radius, down) in [(0.0f32, 0.0f32), (0.1, -3.0)] {
                let velocity = Vec3::new(cos, -sin, 0.0) * if normal == Vec3::Y { 0.0 } else { 5.0 } + Vec3::Z * 5.0;
                let block = Particle {
                    position: normal * (radius + 1e-6),
                    velocity: velocity + normal * down,
                    radius,
                    elasticity: 0.5,
                    material: Some(0),
                    ..Particle::REST
                };
                let ground = Plane { point: Vec3::ZERO, normal };
                let start = [block];
                let scene = Scene {
                    start: &start,
                    forces: &Gravity::EARTH,
                    colliders: &ground,
                    materials: &MATERIAL,
                    integrator: &method,
                    ..Scene::EMPTY
                };
                for h in [1.0 / 60.0, 1.0 / 240.0] {
                    let (books, share) = books(&scene, 1, h);
                    assert!(books.friction < -4.0 && books.scenery.abs() < 1e-4, "{method}: {books:?}");
                    assert!(share < 1e-5 && (down < 0.0) == (books.restitution < -1.0), "{method}, {share}: {books:?}");
                }
            }
        }
    }
}

/// A slide into something is booked no farther than that, on the floor of a room, along the crease at a wall's foot, and round that of a tank.
#[test]
fn slides_end_where_something_stops_them() {
    let room = Cuboid { min: Vec3::splat(-0.5), max: Vec3::splat(0.5) };
    let tank = Cylinder { center: Vec3::ZERO, radius: 0.5, height: 1.0 };
    let down = Gravity { acceleration: Vec3::new(-0.9, -9.0, -1.7) };
    for method in [Method::Midpoint, Method::Verlet, Method::Rk4] {
        for (walls, name) in [(&room as &dyn Collider, "room"), (&tank, "tank")] {
            for (radius, elasticity, x) in [(0.0f32, 0.0, 0.3), (0.0, 0.7, -0.499), (0.1, 0.5, -0.399), (0.1, 0.0, 0.0)]
            {
                let position = Vec3::new(x, -0.4999 + radius, 0.0);
                let (velocity, material) = (Vec3::new(1.7, 0.0, 4.3), Some(0));
                let start = [Particle { position, velocity, radius, elasticity, material, ..Particle::REST }];
                let scene = Scene {
                    start: &start,
                    forces: &down,
                    colliders: walls,
                    materials: &MATERIAL,
                    integrator: &method,
                    ..Scene::EMPTY
                };
                for h in [1.0 / 24.0, 1.0 / 60.0, 1.0 / 240.0] {
                    let (books, share) = books(&scene, 1, h);
                    assert!(share < 1e-5, "{name} {method} by {h}, {radius} m, {elasticity}: {share} {books:?}");
                }
            }
        }
    }
}

#[test]
fn what_scenery_lifts_and_drags_along_has_its_line() {
    let slab = Cuboid { min: Vec3::new(-9.0, -1.0, -9.0), max: Vec3::new(9.0, 0.0, 9.0) };
    let all = Aabb { min: Vec3::NEG_INFINITY, max: Vec3::INFINITY };
    // Lifted by 2 m: its weight times that, and its speed. Dragged up to 2 m/s: as much is lost as is gained.
    for (drift, gained, lost) in [(Vec3::Y * 2.0, 2.0 * 9.80665 * 2.0 + 4.0, 0.0), (Vec3::X * 2.0, 8.0, -4.0)] {
        let moving = Moving::new(slab, &all, Motion { drift, ..Motion::STILL });
        let start =
            [Particle { position: Vec3::Y * 1e-6, mass: 2.0, elasticity: 0.0, material: Some(0), ..Particle::REST }];
        let scene = Scene {
            start: &start,
            forces: &Gravity::EARTH,
            colliders: &moving,
            materials: &MATERIAL,
            integrator: &Verlet,
            ..Scene::EMPTY
        };
        let (books, share) = books(&scene, 1, 1.0 / 60.0);
        // The energy of what it brings to rest at once is lost in the hit: half of what that takes.
        let sum = books.scenery + books.restitution + books.friction;
        assert!((books.friction - lost).abs() < 0.01 * gained, "{books:?}");
        let hit = if drift.y > 0.0 { -4.0 } else { 0.0 };
        assert!(
            (books.scenery - gained + hit).abs() < 0.02 * gained && (sum - gained - lost).abs() < 0.02 * gained,
            "{books:?}"
        );
        assert!(share < 2e-4, "{share}: {books:?}");
    }
    // A block that rides on a disc that spins: nothing comes and nothing goes but what friction needs to begin with.
    let disc = Moving::new(slab, &all, Motion { spin: 0.15, ..Motion::STILL });
    let start =
        [Particle { position: Vec3::new(1.0, 1e-6, 0.0), elasticity: 0.0, material: Some(0), ..Particle::REST }];
    let scene = Scene {
        start: &start,
        forces: &Gravity::EARTH,
        colliders: &disc,
        materials: &MATERIAL,
        integrator: &Rk4,
        ..Scene::EMPTY
    };
    let (books, share) = books(&scene, 1, 1.0 / 240.0);
    assert!(books.scenery > 0.3 && books.friction < -0.3 && share < 1e-3, "{share}: {books:?}");
}

#[test]
fn friction_of_hard_balls_has_its_line() {
    let ball = |x: f32, y: f32, v: f32| Particle {
        position: Vec3::new(x, y, 0.0),
        velocity: Vec3::X * v,
        radius: 0.5,
        mass: 1.5 + v,
        elasticity: 0.7,
        material: Some(0),
        ..Particle::REST
    };
    // A glancing hit, and a ball that slides down another that is fixed.
    let pair = [ball(-2.0, 0.6, 4.0), ball(0.0, 0.0, 0.0)];
    let perched =
        [Particle { fixed: true, ..ball(0.0, 0.0, 0.0) }, Particle { elasticity: 0.0, ..ball(0.6, 0.8, 0.0) }];
    let hitting =
        Scene { start: &pair, materials: &MATERIAL, meetings: Meetings::IMPULSE, integrator: &Verlet, ..Scene::EMPTY };
    let kinetic = Scene { start: &perched, forces: &Gravity::EARTH, ..hitting };
    for (name, scene, least, bound) in [("hit", hitting, -0.5, 1e-5), ("slide", kinetic, -0.05, 1e-3)] {
        let (books, share) = books(&scene, 2, 1.0 / 240.0);
        assert!(books.friction < least && books.scenery.abs() < 1e-4 && share < bound, "{name} {share}: {books:?}");
    }
}

/// Counts calls.
#[derive(Default)]
struct Counter([usize; 4]);

impl Observer for Counter {
    fn after(&mut self, _: Phase, _: &State<'_>) {
        self.0[0] += 1;
    }
    fn hit(&mut self, _: &Impact) {
        self.0[1] += 1;
    }
    fn born(&mut self, _: &LifeEvent) {
        self.0[2] += 1;
    }
    fn died(&mut self, _: &LifeEvent, _: Cause) {
        self.0[3] += 1;
    }
}

#[test]
fn two_may_watch_as_one() {
    busy(|scene| {
        let watched = |by: &mut dyn FnMut(&mut System<Heap>, Time) -> Report| {
            let mut system = System::with(Heap::new(SIZE));
            system.start(scene, 3).expect("it fits");
            for i in 1..=90 {
                by(&mut system, Time::frame(i, 60));
            }
            system.hash()
        };
        let mut system = System::with(Heap::new(SIZE));
        system.start(scene, 3).expect("it fits");
        let alone = || (Ledger::new(&system, scene), Counter::default());
        let ((mut ledger, mut counter), mut both) = (alone(), alone());
        let unseen = watched(&mut |system, instant| system.step_to(scene, instant));
        let one = watched(&mut |system, instant| system.step_to_observed(scene, instant, &mut ledger));
        let other = watched(&mut |system, instant| system.step_to_observed(scene, instant, &mut counter));
        let two = watched(&mut |system, instant| system.step_to_observed(scene, instant, &mut both));
        assert_eq!([one, other, two], [unseen; 3]);
        assert_eq!((ledger.books(), counter.0), (both.0.books(), both.1.0));
        assert!(counter.0.iter().all(|&calls| calls > 0), "{:?}", counter.0);
    });
}
