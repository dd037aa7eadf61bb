//! Steps on two threads beside the same on one, in turns:
//! `cargo run --release -p pointmass-bench --example threads -- [ROUNDS] [THREADS]`.
//!
//! The fountain of the example `fountain`, Plummer's sphere under its own gravity by Barnes and Hut, and the soft balls of the
//! example `neighbours`, few and many. Prints the least time of a step on one thread, and how many times as fast
//! more are. Both end in the same bits.

use pointmass::index::Structure;
use pointmass::shape::Plane;
use pointmass::{Drag, Gravity, Heap, MutualGravity, Particle, Scene, Size, Symplectic, System, Time, Vec3, Verlet};
use pointmass_bench::neighbours::{STEP, WAY, balls, repulsion};
use pointmass_bench::{FILLING, FRAME, high_jet, plummer, started, timed};
use rayon::ThreadPool;

/// Steps of a particle of the fountain in a round; of what takes longer there are fewer.
const WORK: usize = 4_000_000;

fn main() {
    let argument = |i: usize, default: usize| std::env::args().nth(i).and_then(|x| x.parse().ok()).unwrap_or(default);
    let (rounds, threads) = (argument(1, 5), argument(2, 2));
    let pools = [1, threads].map(|threads| {
        rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("the machine gives out threads")
    });
    for particles in [1_000, 10_000, 100_000, 1_000_000] {
        fountain(particles, rounds, &pools);
    }
    for particles in [1_000, 10_000, 100_000] {
        gravity(particles, rounds, &pools);
        neighbours(particles, rounds, &pools);
    }
}

fn fountain(particles: usize, rounds: usize, pools: &[ThreadPool; 2]) {
    let (forces, emitter) = ((Gravity::EARTH, Drag {}), high_jet(particles as f32));
    let ground = Plane { point: Vec3::ZERO, normal: Vec3::Y };
    let scene =
        Scene { emitters: &emitter, forces: &forces, colliders: &ground, integrator: &Symplectic, ..Scene::EMPTY };
    let mut system = started(&scene, particles + particles / 8 + 64);
    (0..FILLING).for_each(|_| {
        system.step(&scene, FRAME);
    });
    compare("fountain", &scene, &system, FRAME, [(WORK / particles).max(8), rounds], pools);
}

fn gravity(particles: usize, rounds: usize, pools: &[ThreadPool; 2]) {
    let mass = 1.0 / particles as f32;
    let start: Vec<Particle> =
        plummer(particles).into_iter().map(|position| Particle { position, mass, ..Particle::REST }).collect();
    let forces = MutualGravity { constant: 1.0, softening: 0.01, theta: 0.65, quadrupole: true };
    let scene = Scene { start: &start, forces: &forces, integrator: &Verlet, ..Scene::EMPTY };
    let steps = (WORK / 200 / particles).max(2);
    compare("gravity", &scene, &started(&scene, particles), Time::from_ticks(1 << 20), [steps, rounds], pools);
}

fn neighbours(particles: usize, rounds: usize, pools: &[ThreadPool; 2]) {
    let (start, forces) = (balls(particles, WAY), repulsion());
    let scene =
        Scene { start: &start, forces: &forces, integrator: &Symplectic, index: &Structure::Grid, ..Scene::EMPTY };
    let mut system = System::with(Heap::new(Size { columns: scene.columns_with_lists(), ..scene.size() }));
    system.start(&scene, 0).expect("the memory is made for the scene");
    compare("neighbours", &scene, &system, STEP, [(WORK / 20 / particles).max(20), rounds], pools);
}

/// Steps a system on one thread and on more, in turns, as many steps in each of so many rounds.
fn compare(
    name: &str,
    scene: &Scene<'_>,
    system: &System<Heap>,
    step: Time,
    [steps, rounds]: [usize; 2],
    pools: &[ThreadPool; 2],
) {
    let mut systems = [system.clone(), system.clone()];
    let (mut least, mut ratios) = ([f64::INFINITY; 2], vec![]);
    for _ in 0..rounds {
        let mut taken = [0.0; 2];
        for (i, (system, pool)) in systems.iter_mut().zip(pools).enumerate() {
            taken[i] = pool.install(|| {
                timed(steps, || {
                    system.step(scene, step);
                })
            });
            least[i] = least[i].min(taken[i]);
        }
        ratios.push(taken[0] / taken[1]);
    }
    assert_eq!(systems[0].hash(), systems[1].hash(), "the same bits");
    ratios.sort_by(f64::total_cmp);
    let count = systems[0].len();
    println!(
        "{name} of {count}: {:.3} ms on one thread, {:.3} ms on {}: {:.2} times as fast ({:.2} to {:.2} in {rounds} rounds)",
        least[0] * 1e-6,
        least[1] * 1e-6,
        pools[1].current_num_threads(),
        least[0] / least[1],
        ratios.first().copied().unwrap_or(f64::NAN),
        ratios.last().copied().unwrap_or(f64::NAN),
    );
}
