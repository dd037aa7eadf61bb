//! The whole step of a fountain in its steady state: births, gravity, drag, symplectic Euler, bounces off the ground,
//! deaths of age. And what is left of it where nothing is born, hit or dies.
#![allow(missing_docs)]

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use pointmass::shape::Plane;
use pointmass::{Drag, Gravity, Scene, Symplectic, Vec3};
use pointmass_bench::{Bare, FRAME, cloud, jet, started};

fn step(c: &mut Criterion) {
    let forces = (Gravity::EARTH, Drag {});
    let ground = Plane { point: Vec3::ZERO, normal: Vec3::Y };
    let mut group = c.benchmark_group("step");
    for n in [1_000u32, 10_000, 100_000, 1_000_000] {
        group.throughput(Throughput::Elements(u64::from(n)));
        if n >= 1_000_000 {
            group.sample_size(20);
        }
        let emitter = jet(n as f32);
        let fountain = Scene { emitters: &emitter, forces: &forces, colliders: &ground, ..Scene::EMPTY };
        let mut system = started(&fountain, n as usize + 1000);
        // Until as many die as are born.
        for _ in 0..150 {
            system.step(&fountain, FRAME);
        }
        group.bench_function(BenchmarkId::new("fountain", n), |b| b.iter(|| system.step(&fountain, FRAME)));

        let particles = cloud(n);
        let falling = Scene { start: &particles, forces: &forces, integrator: &Symplectic, ..Scene::EMPTY };
        let mut system = started(&falling, n as usize);
        group.bench_function(BenchmarkId::new("falling", n), |b| b.iter(|| system.step(&falling, FRAME)));

        let mut bare = Bare::new(&particles);
        group.bench_function(BenchmarkId::new("bare loop", n), |b| b.iter(|| bare.step(FRAME.seconds())));
    }
    group.finish();
}

criterion_group!(benches, step);
criterion_main!(benches);
