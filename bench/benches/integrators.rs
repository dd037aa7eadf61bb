//! A step of each method over 10,000 particles under gravity and drag, nothing to collide with; and a stiff cloth, for which
//! one implicit step stands against a hundred explicit ones.
#![allow(missing_docs)]

use criterion::{BatchSize, Criterion, Throughput, criterion_group, criterion_main};
use pointmass::{
    ClothSprings, Drag, Gravity, Heap, Implicit, Integrator, Method, Particle, Scene, Sheet, SpringParams, Symplectic,
    System, Time, Vec3,
};
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

/// A frame of a square cloth of 64 × 64 particles and 4 kg that hangs by two corners. Its 1 MN/m are too stiff for a hundred
/// explicit sub-steps, which cost the same over a cloth a thousand times softer.
fn stiff_cloth(c: &mut Criterion) {
    let sheet = Sheet { corner: Vec3::ZERO, sides: [Vec3::X, Vec3::Z], cells: [63; 2] };
    let mut start: Vec<_> = sheet.particles(Particle { mass: 4.0 / 4096.0, ..Particle::REST }).collect();
    for corner in [0, 63] {
        start[corner].fixed = true;
    }
    let springs = |ks: f32, kd: f32| {
        let thread = Some(SpringParams { ks, kd });
        let bend = Some(SpringParams { ks: 0.01 * ks, kd: 0.01 * kd });
        sheet.springs(&ClothSprings { structural: thread, shear: thread, bend }, 0).collect::<Vec<_>>()
    };
    let (stiff, soft) = (springs(1e6, 10.0), springs(1e3, 0.01));
    let implicit = Implicit { iterations: 100, ..Implicit::USUAL };
    let cases =
        [("implicit", &implicit as &dyn Integrator, &stiff, 1), ("symplectic, 100 sub-steps", &Symplectic, &soft, 100)];
    let mut group = c.benchmark_group("stiff cloth");
    for (name, integrator, springs, substeps) in cases {
        let scene = Scene { start: &start, springs, forces: &Gravity::EARTH, integrator, ..Scene::EMPTY };
        let part = Time::from_ticks(FRAME.ticks() / substeps);
        let frame = |system: &mut System<Heap>| {
            for _ in 0..substeps {
                system.step(&scene, part);
            }
        };
        let mut system = started(&scene, start.len());
        (0..60).for_each(|_| frame(&mut system));
        group.bench_function(name, |b| b.iter_batched_ref(|| system.clone(), frame, BatchSize::LargeInput));
        assert_eq!(system.len(), start.len(), "it has exploded");
    }
    group.finish();
}

criterion_group!(benches, integrators, stiff_cloth);
criterion_main!(benches);
