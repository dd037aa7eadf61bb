//! The first triangle hit: each structure, and with the feature `peers` each of the other libraries, on a made-up knot of
//! 60,000 triangles, or on a mesh of yours: `MESH=bunny.ply cargo bench -p pointmass-bench --bench rays`.
#![allow(missing_docs)]

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use pointmass::rays::Structure;
use pointmass_cli::compare::{Made, Query, Surface, Workload};
use std::hint::black_box;

const TRIANGLES: usize = 60_000;
const SEGMENTS: usize = 10_000;

fn surface() -> (Surface, Vec<Query>) {
    let surface = match std::env::var_os("MESH") {
        Some(path) => Surface::read(path.as_ref()),
        None => Surface::made(Made::Knot, TRIANGLES),
    };
    let surface = surface.expect("MESH names a mesh");
    let queries = Query::all(&surface, SEGMENTS, None, 1);
    let is_asked = |query: &Query| matches!(query.workload, Workload::Short | Workload::Sorted | Workload::Long);
    (surface, queries.into_iter().filter(is_asked).collect())
}

fn rays(c: &mut Criterion) {
    let (surface, queries) = surface();
    let mesh = surface.mesh.view();
    let triangles = mesh.triangles().len();
    for structure in Structure::ALL.iter().copied().filter(|&structure| structure != Structure::Brute) {
        let mut memory = vec![0; structure.words(triangles)];
        let mut group = c.benchmark_group(structure.name());
        group.sample_size(10).throughput(Throughput::Elements(triangles as u64));
        group.bench_function("build", |b| {
            b.iter(|| structure.build(&mesh, &mut memory).expect("room for all").words().len());
        });
        let index = structure.build(&mesh, &mut memory).expect("room for all");
        group.throughput(Throughput::Elements(SEGMENTS as u64));
        for query in &queries {
            group.bench_function(query.workload.name(), |b| {
                b.iter(|| {
                    query.segments.iter().for_each(|segment| {
                        black_box(index.first_hit(&mesh, segment));
                    });
                });
            });
        }
        group.finish();
    }
}

#[cfg(feature = "peers")]
fn peers(c: &mut Criterion) {
    let (surface, queries) = surface();
    let vertices: Vec<_> = surface.mesh.vertices().iter().map(pointmass::Vec3::to_array).collect();
    let triangles = surface.mesh.triangles();
    let mut hits = vec![None; SEGMENTS];
    for mut peer in pointmass_peers::ray_peers() {
        let mut group = c.benchmark_group(peer.name());
        group.sample_size(10).throughput(Throughput::Elements(triangles.len() as u64));
        group.bench_function("build", |b| b.iter(|| peer.build(&vertices, triangles)));
        group.throughput(Throughput::Elements(SEGMENTS as u64));
        for query in &queries {
            let ends = |segment: &pointmass::shape::Segment| [segment.from.to_array(), segment.to.to_array()];
            let segments: Vec<_> = query.segments.iter().map(ends).collect();
            group.bench_function(query.workload.name(), |b| {
                b.iter(|| peer.first_hits(&segments, &mut hits));
            });
        }
        group.finish();
    }
}

#[cfg(not(feature = "peers"))]
fn peers(_: &mut Criterion) {}

criterion_group!(benches, rays, peers);
criterion_main!(benches);
