//! Nothing passes a wall, however thin it is and however fast what comes is.

use pointmass::motion::Motion;
use pointmass::shape::{Aabb, Collider, Cuboid, MeshBuf, Moving, Plane, Segment, Triangle};
use pointmass::{Heap, Particle, Scene, Size, System, Time, Vec3};
use pointmass_tests::solids::below;
use pointmass_tests::surfaces::{Vec, cross, dot, minus, plus};
use pointmass_tests::{Random, f64s, icosahedron, often};

/// How many flights go together.
const FLEET: usize = 2000;

/// Sends `n` flights through steps of a 60th of a second each, and hands each one's start and end to `judge`.
fn fly(
    collider: &dyn Collider,
    n: usize,
    steps: u64,
    mut begin: impl FnMut() -> Particle,
    mut judge: impl FnMut(&Particle, Vec3, Vec3, Time),
) {
    let mut memory = None;
    for _ in 0..n.div_ceil(FLEET) {
        let start: std::vec::Vec<Particle> = (0..FLEET).map(|_| begin()).collect();
        let scene = Scene { start: &start, colliders: collider, ..Scene::EMPTY };
        let memory = memory.get_or_insert_with(|| Heap::new(Size { particles: FLEET, ..scene.size() }));
        let mut system = System::with(memory);
        system.start(&scene, 0).expect("the memory is made for the scene");
        for i in 1..=steps {
            system.step(&scene, Time::frame(i, 60) - system.time());
        }
        assert_eq!(system.len(), FLEET, "nobody dies");
        let particles = system.particles();
        for (row, particle) in start.iter().enumerate() {
            judge(particle, particles.position[row], particles.velocity[row], system.time());
        }
    }
}

/// A flight from near a wall at x = 0 toward it: to 10,000 m/s, by any angle, a point or a ball.
fn flight(random: &mut Random, thick: f32) -> Particle {
    let radius = if random.unit() < 0.5 { 0.0 } else { random.magnitude(1e-3, 1e-1) };
    let gap = thick + radius * 1.001 + random.magnitude(1e-4, 100.0);
    let side = if random.unit() < 0.5 { 1.0 } else { -1.0 };
    let position = Vec3::new(-side * gap, random.between(-10.0, 10.0), random.between(-10.0, 10.0));
    let aslant = random.vector(1.0) * random.magnitude(1e-3, 3.0);
    let speed = random.magnitude(1.0, 1e4);
    let velocity = (Vec3::X * side + aslant).normalize() * speed;
    Particle { position, velocity, radius, elasticity: random.unit(), ..Particle::REST }
}

/// What flights have to fear at a wall: that they end nearer to it than their radius.
fn hold_wall(name: &str, collider: &dyn Collider, thick: f64, seed: u64) {
    let mut random = Random::new(seed);
    let (mut tunnels, mut came, mut worst) = (0, 0, 0.0f64);
    let judge = |particle: &Particle, end: Vec3, velocity: Vec3, _: Time| {
        let side = f64::from(particle.position.x.signum());
        // How far its surface is from that of the wall, on the side that it came from.
        let apart = side * f64::from(end.x) - thick - f64::from(particle.radius);
        // As all of its coordinates round.
        let size = f64::from(particle.position.length() + particle.velocity.length() / 60.0);
        worst = worst.min(apart / size);
        // The wall reaches 500 m, and what is large rounds much.
        tunnels += u32::from(side * f64::from(end.x) < 0.0 || apart < -1e-6 * (size + 500.0));
        came += u32::from(velocity != particle.velocity);
    };
    fly(collider, often(300_000), 1, || flight(&mut random, thick as f32), judge);
    println!("{name}: {tunnels} tunnels, {came} hits, at worst {worst:e} of the coordinates");
    assert_eq!(tunnels, 0, "{name}");
    assert!(came as usize > often(50_000), "{name}: {came}");
}

#[test]
fn no_flight_passes_a_wall_of_a_millimetre() {
    let far = 500.0;
    hold_wall("box", &Cuboid { min: Vec3::new(-5e-4, -far, -far), max: Vec3::new(5e-4, far, far) }, 5e-4, 71);
    hold_wall("plane", &Plane { point: Vec3::ZERO, normal: Vec3::X }, 0.0, 72);
    let [a, b, c, d] = [(-far, -far), (far, -far), (far, far), (-far, far)].map(|(y, z)| Vec3::new(0.0, y, z));
    let pair = [Triangle { corners: [a, b, c] }, Triangle { corners: [a, c, d] }];
    hold_wall("pair of triangles", &pair, 0.0, 73);
}

#[test]
fn no_flight_leaves_or_enters_a_closed_mesh() {
    let (vertices, triangles) = icosahedron();
    let corner = |i: u32| f64s(vertices[i as usize]);
    let faces: std::vec::Vec<(Vec, Vec)> = triangles
        .iter()
        .map(|t| (corner(t[0]), cross(minus(corner(t[1]), corner(t[0])), minus(corner(t[2]), corner(t[0])))))
        .collect();
    let depth = |x: Vec| faces.iter().map(|&(p, n)| below(x, p, n)).fold(f64::INFINITY, f64::min);
    let mesh = MeshBuf::new(vertices.clone(), triangles.clone()).expect("an icosahedron is a mesh");
    let mut random = Random::new(74);
    let begin = || {
        let t = triangles[random.word() as usize % triangles.len()].map(|i| vertices[i as usize]);
        // At a vertex, at an edge, or at any place of a face.
        let target = match random.word() % 3 {
            0 => t[0],
            1 => t[0].lerp(t[1], random.unit()),
            _ => t[0].lerp(t[1], random.unit()).lerp(t[2], random.unit()),
        };
        let radius = if random.unit() < 0.5 { 0.0 } else { random.magnitude(1e-4, 3e-2) };
        let position = if random.unit() < 0.5 {
            random.direction() * random.between(0.0, 0.7)
        } else {
            random.direction() * random.magnitude(1.1, 10.0)
        };
        let velocity = (target - position).normalize() * random.magnitude(100.0, 1e4);
        Particle { position, velocity, radius, elasticity: random.unit() * 0.1, ..Particle::REST }
    };
    let (mut tunnels, mut hits) = (0, 0);
    let judge = |particle: &Particle, end: Vec3, velocity: Vec3, _: Time| {
        let (from, to, radius) = (f64s(particle.position), f64s(end), f64::from(particle.radius));
        let margin = 1e-6 * (1.0 + f64::from(particle.velocity.length()) / 60.0);
        let (before, after) = (depth(from), depth(to));
        if velocity == particle.velocity {
            // Undisturbed: the ball stays within what is inside, the centre outside of it.
            let deepest = (0..=64).map(|i| depth(plus(from, minus(to, from), f64::from(i) / 64.0)));
            let through = before < 0.0 && deepest.fold(f64::NEG_INFINITY, f64::max) > margin;
            tunnels += u32::from(through || (before > 0.0 && after < radius - margin));
        } else {
            hits += 1;
            tunnels += u32::from((before > 0.0) != (after > 0.0) && after.abs() > margin);
        }
    };
    fly(&mesh, often(200_000), 1, begin, judge);
    assert_eq!(tunnels, 0);
    assert!(hits > often(100_000), "{hits}");
}

/// Where a motion has brought the frame of what moves, in double precision: a point of the world, told there.
pub(crate) fn told(motion: &Motion, x: Vec, instant: Time) -> Vec {
    let t = instant.ticks() as f64 / 4_294_967_296.0;
    let turn = |turns: f64| (turns - turns.floor()) * core::f64::consts::TAU;
    let sway = turn(f64::from(motion.frequency) * t + f64::from(motion.phase)).sin();
    let place = plus(plus(f64s(motion.pivot), f64s(motion.swing), sway), f64s(motion.drift), t);
    let (sin, cos) = turn(-f64::from(motion.spin) * t).sin_cos();
    let axis = f64s(motion.axis.normalize());
    let v = minus(x, place);
    let turned = plus(plus(v.map(|x| x * cos), cross(axis, v), sin), axis, dot(axis, v) * (1.0 - cos));
    plus(turned, f64s(motion.pivot), 1.0)
}

#[test]
fn no_flight_leaves_or_enters_a_rotating_box() {
    let cuboid = Cuboid { min: Vec3::new(-60.0, -45.0, -50.0), max: Vec3::new(50.0, 40.0, 70.0) };
    let motions = [
        Motion { axis: Vec3::new(1.0, 2.0, -1.0), spin: 0.3, ..Motion::STILL },
        Motion { axis: Vec3::Y, spin: -1.0, swing: Vec3::new(3.0, -1.0, 0.5), frequency: 0.7, ..Motion::STILL },
        Motion { axis: Vec3::Z, spin: 0.1, pivot: Vec3::new(20.0, 0.0, 5.0), drift: Vec3::X * 30.0, ..Motion::STILL },
    ];
    let depth = |x: Vec| {
        let (min, max) = (f64s(cuboid.min), f64s(cuboid.max));
        (0..3).map(|i| (x[i] - min[i]).min(max[i] - x[i])).fold(f64::INFINITY, f64::min)
    };
    for motion in motions {
        let collider = Moving::new(cuboid, &Aabb { min: cuboid.min, max: cuboid.max }, motion);
        let mut random = Random::new(75);
        let begin = || {
            let radius = if random.unit() < 0.5 { 0.0 } else { random.magnitude(1e-3, 1.0) };
            let inside = random.unit() < 0.5;
            let position = if inside { random.vector(20.0) } else { random.direction() * random.between(110.0, 200.0) };
            let target = random.vector(40.0);
            let velocity = if inside { random.direction() } else { (target - position).normalize() };
            let velocity = velocity * random.magnitude(10.0, 1e4);
            Particle { position, velocity, radius, elasticity: random.unit(), ..Particle::REST }
        };
        let (mut tunnels, mut hits, mut worst) = (0, 0, 0.0f64);
        let judge = |particle: &Particle, end: Vec3, velocity: Vec3, instant: Time| {
            let before = depth(told(&motion, f64s(particle.position), Time::ZERO));
            let after = depth(told(&motion, f64s(end), instant));
            // A turn is known to 2⁻²⁴, and the ways of a step are as long as 170 m.
            if velocity != particle.velocity {
                hits += 1;
                let out = if before > 0.0 { -after } else { after };
                worst = worst.max(out);
                tunnels += u32::from(out > 1e-3);
            } else if before > 0.0 {
                tunnels += u32::from(after < -1e-3);
            } else {
                let path = |i: u32| {
                    let (s, t) = (f64::from(i) / 64.0, instant.ticks() / 64 * u64::from(i));
                    let x = plus(f64s(particle.position), minus(f64s(end), f64s(particle.position)), s);
                    depth(told(&motion, x, Time::from_ticks(t)))
                };
                // Of an arc its chords miss what is less.
                tunnels += u32::from((0..=64).map(path).fold(f64::NEG_INFINITY, f64::max) > 0.5);
            }
        };
        fly(&collider, often(70_000), 3, begin, judge);
        println!("{motion:?}: {tunnels} tunnels, {hits} hits, {worst:e} m");
        assert_eq!(tunnels, 0, "{motion:?}");
        assert!(hits > often(15_000), "{hits}");
    }
}

#[test]
fn however_long_a_wall_has_turned_it_stops_what_comes() {
    // After eleven days at 60 turns a second the pose is as exact as at first.
    let wall = Cuboid { min: Vec3::new(-5e-4, -1.0, -1.0), max: Vec3::new(5e-4, 1.0, 1.0) };
    let motion = Motion { axis: Vec3::Y, spin: 60.0, ..Motion::STILL };
    let collider = Moving::new(wall, &Aabb { min: wall.min, max: wall.max }, motion);
    let late = Time::from_seconds_f64(1e6);
    for i in 0..600 {
        let during = [late + Time::frame(i, 600), late + Time::frame(i, 600) + Time::from_ticks(1000)];
        // Straight across where the wall is now.
        let at = motion.at(during[0]).linear;
        let segment = Segment { during, ..Segment::new(at * Vec3::new(0.3, 0.2, 0.4), at * Vec3::new(-0.3, 0.2, 0.4)) };
        let hit = collider.first_hit(&segment).expect("it goes across");
        assert!((hit.normal - at * Vec3::X).length() < 1e-3);
    }
}
