//! Births: 1,000 in a step, each with 9 random properties, and the deaths that make room for them.
#![allow(missing_docs)]

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use pointmass::shape::{Cone, Cuboid, Cylinder, Disc, Line, Mesh, Shape, Sphere};
use pointmass::{Emitter, Scene, Varied, Vec3};
use pointmass_bench::{FRAME, jet, started};

fn births(c: &mut Criterion) {
    let center = Vec3::ZERO;
    let shapes: [(&str, Shape<Mesh<'static>>); 6] = [
        ("line", Shape::Line(Line { from: -Vec3::X, to: Vec3::X })),
        ("box", Shape::Box(Cuboid { min: -Vec3::ONE, max: Vec3::ONE })),
        ("circle", Shape::Circle(Disc { center, normal: Vec3::Y, radius: 1.0 })),
        ("sphere", Shape::Sphere(Sphere { center, radius: 1.0 })),
        ("cylinder", Shape::Cylinder(Cylinder { center, radius: 1.0, height: 2.0 })),
        ("cone", Shape::Cone(Cone { center, radius: 1.0, height: 2.0 })),
    ];
    let mut group = c.benchmark_group("births");
    group.throughput(Throughput::Elements(1000));
    for (name, shape) in shapes {
        let varied = Varied { mean: 1.0, half_width: 0.1 };
        let emitter = Emitter {
            shape,
            rate: 60_000.0,
            mass: varied,
            elasticity: varied,
            // They die in the step that gives birth to them.
            lifetime: Varied::exactly(1e-6),
            ..jet(0.0)
        };
        let scene = Scene { emitters: &emitter, ..Scene::EMPTY };
        let mut system = started(&scene, 2000);
        group.bench_function(name, |b| b.iter(|| system.step(&scene, FRAME)));
    }
    group.finish();
}

criterion_group!(benches, births);
criterion_main!(benches);
