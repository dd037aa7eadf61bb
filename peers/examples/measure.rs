//! Prints what the libraries take, in ns per point, median of five.
//!
//! `cargo run --release -p pointmass-peers --example measure [number of points]`: points uniform in the unit cube, a
//! radius for 30 neighbours, 100,000 points unless another number is given.

use pointmass_peers::{particular_barnes_hut, peers};
use std::hint::black_box;
use std::time::Instant;

fn main() {
    let n: u32 = std::env::args().nth(1).map_or(100_000, |n| n.parse().expect("a number of points"));
    let points: Vec<[f32; 3]> = {
        let mut unit = generator();
        (0..n).map(|_| [unit(), unit(), unit()]).collect()
    };
    let radius = (30.0 / (n as f32 * 4.0 / 3.0 * std::f32::consts::PI)).cbrt();
    println!("{n} points, radius {radius:.4}; ns per point, but bytes");
    let columns = ["build", "count", "lists", "pairs", "8 nearest", "bytes", "neighbours"];
    println!("{:10}{}", "", columns.map(|column| format!("{column:>11}")).concat());
    for mut peer in peers() {
        let mut counts = vec![0; points.len()];
        let mut distances = Vec::with_capacity(points.len() * 8);
        let mut seen = 0;
        let mut cells = vec![
            Some(median(|| peer.build(&points, radius))),
            timed(|| peer.counts(radius, &mut counts).then_some(())),
            timed(|| peer.lists(radius)),
            timed(|| peer.pairs(radius, &mut |a, b| seen += u64::from(a ^ b))),
            timed(|| {
                distances.clear();
                peer.nearest(8, &mut distances).then_some(())
            }),
        ];
        cells.iter_mut().for_each(|cell: &mut Option<f64>| *cell = cell.map(|seconds| seconds * 1e9));
        cells.push(peer.bytes().map(|bytes| bytes as f64));
        cells.push(Some(counts.iter().map(|&count| f64::from(count)).sum()));
        let text = |cell: Option<f64>| cell.map_or("-".into(), |total| format!("{:.1}", total / f64::from(n)));
        let line: String = cells.into_iter().map(|cell| format!("{:>11}", text(cell))).collect();
        println!("{:10}{line}", peer.name());
        black_box((seen, distances));
    }
    for n in [10_000, 100_000] {
        let (points, masses) = plummer(n);
        let mut accelerations = vec![[0.0; 3]; points.len()];
        let seconds = median(|| particular_barnes_hut(&points, &masses, 0.5, 0.01, &mut accelerations));
        println!("particular's Barnes-Hut, θ = 0.5, Plummer sphere of {n}: {:.0} ms", seconds * 1e3);
    }
}

/// Median of five, in seconds.
fn median(mut work: impl FnMut()) -> f64 {
    let mut times: [f64; 5] = std::array::from_fn(|_| {
        let start = Instant::now();
        work();
        start.elapsed().as_secs_f64()
    });
    times.sort_by(f64::total_cmp);
    times[2]
}

/// The same of work that may not be offered.
fn timed<T>(mut work: impl FnMut() -> Option<T>) -> Option<f64> {
    black_box(work())?;
    Some(median(|| drop(black_box(work()))))
}

/// Numbers in [0, 1).
fn generator() -> impl FnMut() -> f32 {
    let mut state = 1u64;
    move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 40) as f32 / 16_777_216.0
    }
}

/// A Plummer sphere of total mass and scale length 1, without its outermost hundredth.
fn plummer(n: u32) -> (Vec<[f32; 3]>, Vec<f32>) {
    let mut unit = generator();
    let mut place = || {
        let inside = 0.99 * (unit() + f32::MIN_POSITIVE);
        let radius = 1.0 / (inside.powf(-2.0 / 3.0) - 1.0).sqrt();
        let (height, angle) = (2.0 * unit() - 1.0, std::f32::consts::TAU * unit());
        let across = (1.0 - height * height).sqrt();
        [across * angle.cos(), across * angle.sin(), height].map(|x| x * radius)
    };
    ((0..n).map(|_| place()).collect(), vec![1.0 / n as f32; n as usize])
}
