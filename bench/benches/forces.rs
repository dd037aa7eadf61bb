//! One evaluation of each force over 10,000 particles; mutual gravity over 2,000.
#![allow(missing_docs)]

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use pointmass::shape::{Mesh, Shape, Sphere};
use pointmass::{Drag, Force, Gravity, MutualGravity, Particle, Scene, Sink, Spring, Vec3};
use pointmass_bench::{cloud, started};

fn forces(c: &mut Criterion) {
    let shape = Shape::<Mesh<'_>>::Sphere(Sphere { center: Vec3::ZERO, radius: 0.5 });
    let sink = Sink { shape, group: None, intensity: 1.0, ca: 1.0, la: 0.0, qa: 1.0, softening: 0.0 };
    let mut group = c.benchmark_group("forces");
    let mut measure = |name: &str, particles: &[Particle], springs: &[Spring], elements: u64, force: &dyn Force| {
        let scene = Scene { start: particles, springs: &springs, ..Scene::EMPTY };
        let system = started(&scene, particles.len());
        let state = system.state(&scene);
        let mut total = vec![Vec3::ZERO; particles.len()];
        group.throughput(Throughput::Elements(elements));
        group.bench_function(name, |b| {
            b.iter(|| match springs {
                [] => force.add_to(&state, 0..particles.len(), &mut total),
                _ => state.springs.add_to(&state, 0..particles.len(), &mut total),
            });
        });
    };
    let many = cloud(10_000);
    measure("gravity", &many, &[], 10_000, &Gravity::EARTH);
    measure("drag", &many, &[], 10_000, &Drag {});
    measure("gravity and drag", &many, &[], 10_000, &(Gravity::EARTH, Drag {}));
    measure("sink", &many, &[], 10_000, &sink);
    measure("mutual gravity, per pair", &many[..2000], &[], 2000 * 2000, &MutualGravity::NEWTON);
    // A net of 100 by 100.
    let spring = |a: u32, b: u32| Spring::new([a, b], 0.1, 100.0).damped(1.0);
    let net: Vec<Spring> = (0..10_000u32)
        .flat_map(|i| {
            let right = (i % 100 < 99).then(|| spring(i, i + 1));
            right.into_iter().chain((i < 9900).then(|| spring(i, i + 100)))
        })
        .collect();
    measure("springs, per spring", &many, &net, net.len() as u64, &());
    group.finish();
}

criterion_group!(benches, forces);
criterion_main!(benches);
