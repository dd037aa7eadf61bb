//! Drops balls into an open box by rapier3d and prints what its steps take.
//!
//! `cargo run --release -p pointmass-peers --features rapier --example pile [balls] [seconds] [length unit]`: 10,000
//! balls of 10 cm in a box 2.4 m wide, for 3 s of steps of 1/60 s, with a unit of 0.5 m, unless other numbers are given.

use pointmass_peers::rapier::{Drop, Pile};
use std::time::Instant;

fn main() {
    let mut args = std::env::args().skip(1).map(|arg| arg.parse::<f32>().expect("a number"));
    let (n, seconds) = (args.next().unwrap_or(10_000.0) as usize, args.next().unwrap_or(3.0));
    let unit = args.next().unwrap_or(0.5);
    let drop = Drop {
        positions: places(n),
        radius: RADIUS,
        density: 1000.0,
        friction: 0.3,
        elasticity: 0.2,
        half_width: 1.2,
        dt: 1.0 / 60.0,
        length_unit: unit,
        turns: true,
    };
    let begun = Instant::now();
    let mut pile = Pile::new(&drop);
    println!("{n} balls built in {:.1} ms", begun.elapsed().as_secs_f64() * 1e3);
    println!("{:>8}{:>14}{:>10}{:>14}{:>16}", "time s", "ms per step", "worst", "kinetic J", "penetration mm");
    let mut all = Vec::new();
    const EVERY: usize = 30;
    for round in 1..=(seconds / drop.dt).round() as usize / EVERY {
        let mut times: Vec<f64> = (0..EVERY).map(|_| timed(|| pile.step())).collect();
        times.sort_by(f64::total_cmp);
        let (median, worst) = (times[EVERY / 2], times[EVERY - 1]);
        let (energy, depth) = (pile.kinetic_energy(), pile.max_penetration() * 1e3);
        let time = (round * EVERY) as f32 * drop.dt;
        println!("{time:>8.2}{median:>14.2}{worst:>10.2}{energy:>14.4}{depth:>16.3}");
        all.extend(times);
    }
    all.sort_by(f64::total_cmp);
    if let Some(median) = all.get(all.len() / 2) {
        println!("median of {} steps: {median:.2} ms", all.len());
    }
}

const RADIUS: f32 = 0.05;

/// A loose lattice above the floor, each layer a little askew so that no ball stands on another.
fn places(n: usize) -> Vec<[f32; 3]> {
    const ROW: usize = 20;
    const GAP: f32 = 2.4 * RADIUS;
    let place = |i: usize| {
        let (layer, in_layer) = (i / (ROW * ROW), i % (ROW * ROW));
        let shift = 0.05 * RADIUS * ((layer * 7 % 5) as f32 - 2.0);
        let at = |k: usize| (k as f32 - (ROW - 1) as f32 / 2.0) * GAP;
        [at(in_layer % ROW) + shift, RADIUS + (layer as f32 + 0.5) * GAP, at(in_layer / ROW) - 0.5 * shift]
    };
    (0..n).map(place).collect()
}

/// The time that a piece of work takes \[ms\].
fn timed(work: impl FnOnce()) -> f64 {
    let begun = Instant::now();
    work();
    begun.elapsed().as_secs_f64() * 1e3
}
