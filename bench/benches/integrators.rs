//! A step of each method over 10,000 particles under gravity and drag, nothing to collide with.
#![allow(missing_docs)]

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use pointmass::{Drag, Gravity, Method, Scene};
use pointmass_bench::{Bare, FRAME, cloud, started};

fn integrators(c: &mut Criterion) {
    let particles = cloud(10_000);
    let mut group = c.benchmark_group("integrators");
    group.throughput(Throughput::Elements(10_000));
    for method in Method::ALL {
        let forces = (Gravity::EARTH, Drag {});
        let scene = Scene { start: &particles, forces: &forces, integrator: method.integrator(), ..Scene::EMPTY };
        let mut system = started(&scene, particles.len());
        group.bench_function(method.name(), |b| b.iter(|| system.step(&scene, FRAME)));
    }
    let mut bare = Bare::new(&particles);
    group.bench_function("bare loop", |b| b.iter(|| bare.step(FRAME.seconds())));
    group.finish();
}

criterion_group!(benches, integrators);
criterion_main!(benches);
