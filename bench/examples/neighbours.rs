//! Forces between neighbours beside a mere search for all pairs, in turns:
//! `cargo run --release -p pointmass-bench --example neighbours -- [PARTICLES] [STEPS] [ROUNDS] [THREADS] [WAY]`.
//!
//! Soft balls in a box, each with some 30 neighbours within reach, that go a hundredth of the reach in a step, or the share WAY. Prints the
//! least mean time of a step with lists that last, with neighbours looked up anew in each, and of building a grid and visiting
//! all pairs in it once.

use pointmass::index::{SpatialIndex, Structure};
use pointmass::{Heap, Scene, Size, Symplectic, System};
use pointmass_bench::neighbours::{REACH, STEP, WAY, balls, repulsion};
use pointmass_bench::timed;

fn main() {
    let argument = |i: usize, default: usize| std::env::args().nth(i).and_then(|x| x.parse().ok()).unwrap_or(default);
    let (particles, steps, rounds, threads) = (argument(1, 100_000), argument(2, 100), argument(3, 5), argument(4, 1));
    let way = std::env::args().nth(5).and_then(|x| x.parse().ok()).unwrap_or(WAY);
    let (start, force) = (balls(particles, way), repulsion());
    let scene =
        Scene { start: &start, forces: &force, integrator: &Symplectic, index: &Structure::Grid, ..Scene::EMPTY };
    let systems = [scene.columns_with_lists(), scene.columns()].map(|columns| {
        let mut system = System::with(Heap::new(Size { columns, ..scene.size() }));
        system.start(&scene, 0).expect("the memory is made for the scene");
        system
    });
    let [mut listed, mut streamed] = systems;
    let mut memory = vec![0; Structure::Grid.words(particles)];
    let mut index = Structure::Grid.index(&mut memory);
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
    let mut least = [f64::INFINITY; 3];
    let mut pairs = 0;
    for _ in 0..rounds {
        let points = listed.particles().position.to_vec();
        for (system, least) in [&mut listed, &mut streamed].into_iter().zip(&mut least) {
            let all = pool.install(|| {
                timed(steps, || {
                    system.step(&scene, STEP);
                })
            });
            *least = least.min(all);
        }
        least[2] = least[2].min(timed(10, || {
            pairs = 0;
            index.build(&points, REACH).expect("there is room");
            index.pairs(REACH, &mut |_, others| pairs += others.len());
        }));
    }
    let [listed_ms, streamed_ms, pairs_ms] = least.map(|ns| ns * 1e-6);
    let each = 2.0 * pairs as f64 / particles as f64;
    let (lists, evaluations) = (listed.totals().effort.lists, listed.totals().effort.evaluations);
    println!(
        "{particles} particles, {each:.1} neighbours each, {lists} lists in {evaluations} steps, {threads} threads"
    );
    println!(
        "listed {listed_ms:.2} ms, streamed {streamed_ms:.2} ms, pairs {pairs_ms:.2} ms: {:.2}, {:.2} times",
        listed_ms / pairs_ms,
        streamed_ms / pairs_ms
    );
    assert_eq!(listed.hash(), streamed.hash(), "the same bits");
}
