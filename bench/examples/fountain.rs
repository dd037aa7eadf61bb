//! A fountain over the ground, the same among a hundred spheres and boxes, and what falls freely, beside the least that a loop can do, in turns:
//! `cargo run --release -p pointmass-bench --example fountain -- [PARTICLES] [STEPS] [ROUNDS] [among]`.
//!
//! 10 m/s, a drag of 0.2/s, lives of 3 to 5 s, a restitution of 0.5: in a step about a tenth of the particles touch the
//! ground. Prints the least time a particle and step of all rounds, and what our step is to the loop's. With ROUNDS 0 the
//! steps are done once and nothing else, over the ground or `among` the spheres and boxes: for counting instructions, as the
//! difference of two runs of unlike many STEPS.

use pointmass::rng::Stream;
use pointmass::shape::{Cuboid, Mesh, Plane, Scenery, Shape, Sphere, Surface};
use pointmass::{Drag, Gravity, Heap, Scene, Symplectic, System, Vec3};
use pointmass_bench::{Bare, FILLING, FRAME, cloud, high_jet, started, timed};

fn main() {
    let argument = |i: usize, default: usize| std::env::args().nth(i).and_then(|x| x.parse().ok()).unwrap_or(default);
    let (particles, steps, rounds) = (argument(1, 100_000), argument(2, 20), argument(3, 16));
    let (forces, emitter) = ((Gravity::EARTH, Drag {}), high_jet(particles as f32));
    let ground = Plane { point: Vec3::ZERO, normal: Vec3::Y };
    let scene =
        Scene { emitters: &emitter, forces: &forces, colliders: &ground, integrator: &Symplectic, ..Scene::EMPTY };
    let mut system = started(&scene, particles + particles / 8 + 64);
    (0..FILLING).for_each(|_| {
        system.step(&scene, FRAME);
    });
    let things = things();
    let among = Scene { colliders: &things, ..scene };
    if rounds == 0 {
        let scene = if std::env::args().any(|argument| argument == "among") { &among } else { &scene };
        (0..steps).for_each(|_| {
            system.step(scene, FRAME);
        });
    }
    let mut bare = Bare::new(&cloud(system.len() as u32));
    let (mut ours, mut least, mut hits) = (f64::INFINITY, f64::INFINITY, 0);
    for _ in 0..rounds {
        let before = system.totals().hits;
        ours = ours.min(
            timed(steps, || {
                system.step(&scene, FRAME);
            }) / system.len() as f64,
        );
        hits = system.totals().hits - before;
        least = least.min(timed(steps, || bare.step(FRAME.seconds())) / bare.columns[0].len() as f64);
    }
    let share = hits as f64 / (steps * system.len()) as f64;
    println!("{} particles, {:.1} % hit in a step, hash {:016x}", system.len(), 100.0 * share, system.hash());
    println!("fountain {ours:.2} ns, bare loop {least:.2} ns, {:.1} times", ours / least);
    if rounds > 0 {
        println!(
            "among 100 spheres and boxes {:.1} times one plane",
            cluttered([&scene, &among], &system, steps, rounds)
        );
        falling(particles, steps, rounds);
    }
}

/// The ground, and a hundred spheres and boxes that lie about on it.
fn things() -> Scenery<Shape<Mesh<'static>>> {
    let thing = |i: u32| {
        let ([x, z], [size, _]) = (Stream::new(3, 0, i).units(0), Stream::new(3, 0, i).units(1));
        let (center, size) = (Vec3::new(8.0 * x - 4.0, 0.0, 8.0 * z - 4.0), 0.1 + 0.2 * size);
        let ball = Shape::Sphere(Sphere { center, radius: size });
        let chest = Shape::Box(Cuboid { min: center - size, max: center + size });
        if i.is_multiple_of(2) { ball } else { chest }
    };
    let ground: Shape<Mesh<'_>> = Shape::Plane(Plane { point: Vec3::ZERO, normal: Vec3::Y });
    let things = core::iter::once(ground).chain((0..100).map(thing));
    Scenery::new(things.map(|thing| (thing.clone(), thing.bounds())).collect())
}

/// The fountain in the second scene in turns with that in the first: what a particle and step takes there to what it takes here.
fn cluttered(scenes: [&Scene<'_>; 2], filled: &System<Heap>, steps: usize, rounds: usize) -> f64 {
    let mut systems = scenes.map(|scene| (scene, filled.clone()));
    let mut least = [f64::INFINITY; 2];
    for _ in 0..rounds {
        for ((scene, system), least) in systems.iter_mut().zip(&mut least) {
            let taken = timed(steps, || {
                system.step(scene, FRAME);
            });
            *least = least.min(taken / system.len() as f64);
        }
    }
    least[1] / least[0]
}

/// The same without births, deaths and ground, beside the loop.
fn falling(particles: usize, steps: usize, rounds: usize) {
    let start = cloud(particles as u32);
    let scene = Scene { start: &start, forces: &(Gravity::EARTH, Drag {}), integrator: &Symplectic, ..Scene::EMPTY };
    let (mut system, mut bare) = (started(&scene, particles), Bare::new(&start));
    let (mut ours, mut least) = (f64::INFINITY, f64::INFINITY);
    for _ in 0..rounds {
        ours = ours.min(timed(steps, || {
            system.step(&scene, FRAME);
        }));
        least = least.min(timed(steps, || bare.step(FRAME.seconds())));
    }
    let [ours, least] = [ours, least].map(|all| all / particles as f64);
    println!("falling {ours:.2} ns, bare loop {least:.2} ns, {:.1} times", ours / least);
}
