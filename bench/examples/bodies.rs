//! Mutual gravity in Plummer's sphere, far groups as one, in turns with the crate particular:
//! `cargo run --release -p pointmass-bench --features peers --example bodies -- [BODIES] [ROUNDS] [THREADS]`.
//!
//! Prints the least time of an evaluation, the tree built anew, what that is to particular's at θ = 0.5, and the root mean square
//! of |Δa|/|a| against all pairs.

use pointmass::Vec3;
use pointmass::index::{BarnesHut, Opening};
use pointmass_bench::plummer;
use std::time::Instant;

const SOFTENING: f32 = 0.01;

fn main() {
    let argument = |i: usize, default: usize| std::env::args().nth(i).and_then(|x| x.parse().ok()).unwrap_or(default);
    let (bodies, rounds, threads) = (argument(1, 10_000), argument(2, 9), argument(3, 1));
    let points = plummer(bodies);
    let masses = vec![1.0 / bodies as f32; bodies];
    let mut memory = vec![0; BarnesHut::words(bodies)];
    let mut tree = BarnesHut::new(&mut memory);
    let mut field = vec![Vec3::ZERO; bodies];
    let laws = [(0.5, false), (0.5, true), (0.65, true), (0.8, true)].map(|(theta, quadrupole)| Opening {
        theta,
        softening: SOFTENING,
        quadrupole,
    });
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
    let (mut least, mut theirs) = ([f64::INFINITY; 4], f64::INFINITY);
    for _ in 0..rounds {
        for (law, least) in laws.iter().zip(&mut least) {
            let mut evaluate = || {
                tree.build(&points, &masses).expect("the memory was made for so many");
                tree.field(*law, 0..bodies, &mut |row, sum| field[row] = sum);
            };
            let start = Instant::now();
            if threads > 1 {
                pool.install(&mut evaluate);
            } else {
                evaluate();
            }
            *least = least.min(start.elapsed().as_secs_f64());
        }
        theirs = theirs.min(particular(&points, &masses));
    }
    println!("{bodies} bodies, {threads} threads; particular {:.1} ms", theirs * 1e3);
    for (law, least) in laws.iter().zip(least) {
        let (name, error) =
            (if law.quadrupole { "quadrupole" } else { "monopole" }, tree.error(*law, bodies.div_ceil(2000)));
        println!("{name} {}: {:.1} ms, {:.3} times, error {:.2e}", law.theta, least * 1e3, least / theirs, error.rms);
    }
}

/// Seconds that particular takes; none is known without the feature `peers`.
#[cfg(feature = "peers")]
fn particular(points: &[Vec3], masses: &[f32]) -> f64 {
    let at: Vec<[f32; 3]> = points.iter().map(Vec3::to_array).collect();
    let mut out = vec![[0.0; 3]; at.len()];
    let start = Instant::now();
    pointmass_peers::particular_barnes_hut(&at, masses, 0.5, SOFTENING, &mut out);
    start.elapsed().as_secs_f64()
}

#[cfg(not(feature = "peers"))]
fn particular(_: &[Vec3], _: &[f32]) -> f64 {
    f64::NAN
}
