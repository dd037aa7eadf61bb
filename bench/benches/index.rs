//! Queries for the near among 100,000 points, uniform in a unit cube: each structure, and with the feature `peers` each
//! of the other libraries, with a radius that has 30 neighbours.
#![allow(missing_docs)]

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use pointmass::Vec3;
use pointmass::index::{Neighbour, SpatialIndex, Structure};
use pointmass::rng::Stream;
use std::hint::black_box;

const POINTS: u32 = 100_000;
const RADIUS: f32 = 0.0415;

fn points() -> Vec<Vec3> {
    let point = |i| {
        let stream = Stream::new(1, 0, i);
        let ([x, y], [z, _]) = (stream.units(0), stream.units(1));
        Vec3::new(x, y, z)
    };
    (0..POINTS).map(point).collect()
}

fn index(c: &mut Criterion) {
    let points = points();
    let moved: Vec<Vec3> = points.iter().map(|point| *point + (*point - 0.5) * (0.1 * RADIUS)).collect();
    let mut counts = vec![0; points.len()];
    let mut found = [Neighbour::default(); 8];
    for structure in Structure::ALL.iter().copied().filter(|&structure| structure != Structure::Brute) {
        let mut memory = vec![0; structure.words(points.len())];
        let mut index = structure.index(&mut memory);
        let mut group = c.benchmark_group(structure.name());
        group.sample_size(10).throughput(Throughput::Elements(u64::from(POINTS)));
        group.bench_function("build", |b| b.iter(|| index.build(&points, RADIUS).expect("room for all")));
        group.bench_function("count", |b| b.iter(|| index.counts(RADIUS, &mut counts)));
        group.bench_function("lists", |b| {
            b.iter(|| {
                index.neighbours(RADIUS, &mut |row, others| {
                    black_box((row, others));
                })
            });
        });
        group.bench_function("pairs", |b| {
            b.iter(|| {
                let mut sum = 0;
                index.pairs(RADIUS, &mut |row, others| {
                    sum += others.iter().map(|other| u64::from(row ^ other)).sum::<u64>();
                });
                sum
            });
        });
        group.bench_function("8 nearest", |b| {
            b.iter(|| {
                index.all_nearest(f32::INFINITY, &mut found, &mut |row, near| {
                    black_box((row, near));
                })
            });
        });
        // The last, since it leaves the boxes of trees where the points have gone.
        group.bench_function("refit", |b| b.iter(|| index.refit(&moved).expect("room for all")));
        group.finish();
    }
}

#[cfg(feature = "peers")]
fn peers(c: &mut Criterion) {
    let points: Vec<_> = points().iter().map(Vec3::to_array).collect();
    let mut counts = vec![0; points.len()];
    let mut distances = Vec::with_capacity(points.len() * 8);
    for mut peer in pointmass_peers::peers() {
        let mut group = c.benchmark_group(peer.name());
        group.sample_size(10).throughput(Throughput::Elements(u64::from(POINTS)));
        group.bench_function("build", |b| b.iter(|| peer.build(&points, RADIUS)));
        // Each is asked once whether it has such a query.
        if peer.counts(RADIUS, &mut counts) {
            group.bench_function("count", |b| b.iter(|| peer.counts(RADIUS, &mut counts)));
        }
        if peer.lists(RADIUS).is_some() {
            group.bench_function("lists", |b| b.iter(|| peer.lists(RADIUS)));
        }
        if peer.pairs(RADIUS, &mut |_, _| ()).is_some() {
            group.bench_function("pairs", |b| {
                b.iter(|| {
                    let mut sum = 0;
                    peer.pairs(RADIUS, &mut |row, other| sum += u64::from(row ^ other));
                    sum
                });
            });
        }
        if peer.nearest(8, &mut distances) {
            group.bench_function("8 nearest", |b| {
                b.iter(|| {
                    distances.clear();
                    peer.nearest(8, &mut distances)
                });
            });
        }
        group.finish();
    }
}

#[cfg(not(feature = "peers"))]
fn peers(_: &mut Criterion) {}

criterion_group!(benches, index, peers);
criterion_main!(benches);
