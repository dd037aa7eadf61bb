//! Mutual gravity in a star cluster (Plummer's sphere): sums over far groups, the tree built anew each time, beside all
//! pairs and, with the feature `peers`, beside the crate particular.
#![allow(missing_docs)]

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use pointmass::index::{BarnesHut, Opening};
use pointmass::{Force, MutualGravity, Particle, Scene, Vec3};
use pointmass_bench::{plummer, started};

const SOFTENING: f32 = 0.01;
const THETA: f32 = 0.5;

fn gravity(c: &mut Criterion) {
    let mut group = c.benchmark_group("gravity");
    group.sample_size(10);
    for n in [10_000, 100_000, 1_000_000] {
        let points = plummer(n);
        let masses = vec![1.0 / n as f32; n];
        group.throughput(Throughput::Elements(n as u64));
        let mut memory = vec![0; BarnesHut::words(n)];
        let mut tree = BarnesHut::new(&mut memory);
        let mut field = vec![Vec3::ZERO; n];
        // The last has the error of the first.
        for (theta, quadrupole) in [(THETA, false), (THETA, true), (0.65, true)] {
            let law = Opening { theta, softening: SOFTENING, quadrupole };
            tree.build(&points, &masses).expect("the memory was made for so many");
            let error = tree.error(law, n.div_ceil(1000));
            let name = if quadrupole { "quadrupole" } else { "monopole" };
            let name = format!("{name} {theta}");
            eprintln!("{name}, {n}: RMS error {:.2e}, largest {:.2e}", error.rms, error.largest);
            group.bench_function(format!("{name}/{n}"), |b| {
                b.iter(|| {
                    tree.build(&points, &masses).expect("the memory was made for so many");
                    tree.field(law, 0..n, &mut |row, sum| field[row] = sum)
                });
            });
        }
        // All pairs of more would take minutes.
        if n <= 100_000 {
            all_pairs(&mut group, &points);
            #[cfg(feature = "peers")]
            particular(&mut group, &points);
        }
    }
    group.finish();
}

type Group<'a> = criterion::BenchmarkGroup<'a, criterion::measurement::WallTime>;

fn all_pairs(group: &mut Group<'_>, points: &[Vec3]) {
    let n = points.len();
    let body = |&position| Particle { position, mass: 1.0 / n as f32, ..Particle::REST };
    let bodies: Vec<Particle> = points.iter().map(body).collect();
    let scene = Scene { start: &bodies, ..Scene::EMPTY };
    let system = started(&scene, n);
    let state = system.state(&scene);
    let law = MutualGravity { constant: 1.0, softening: SOFTENING, ..MutualGravity::NEWTON };
    let mut total = vec![Vec3::ZERO; n];
    group.bench_function(format!("all pairs/{n}"), |b| b.iter(|| law.add_to(&state, 0..n, &mut total)));
}

#[cfg(feature = "peers")]
fn particular(group: &mut Group<'_>, points: &[Vec3]) {
    let n = points.len();
    let at: Vec<[f32; 3]> = points.iter().map(Vec3::to_array).collect();
    let masses = vec![1.0 / n as f32; n];
    let mut out = vec![[0.0; 3]; n];
    group.bench_function(format!("particular/{n}"), |b| {
        b.iter(|| pointmass_peers::particular_barnes_hut(&at, &masses, THETA, SOFTENING, &mut out));
    });
}

criterion_group!(benches, gravity);
criterion_main!(benches);
