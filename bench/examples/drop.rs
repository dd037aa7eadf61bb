//! `cargo run --release -p pointmass-bench --example drop -- [BALLS] [SECONDS] [SUBSTEPS]`: the same drop of balls into a box, by
//! impulse, by force and by position, and by other engines with `--features peers`.

use pointmass::index::Structure;
use pointmass::{Gravity, Heap, Penalty, Projection, Response, Scene, Symplectic, System, Time, Vec3};
use pointmass_bench::drop::{Drop, deepest};
use std::time::Instant;

fn main() {
    let argument = |i: usize, default: usize| std::env::args().nth(i).and_then(|x| x.parse().ok()).unwrap_or(default);
    let (balls, seconds, substeps) = (argument(1, 10_000), argument(2, 10), argument(3, 20));
    let only = std::env::args().nth(4);
    let drop = Drop::of(balls);
    println!("{balls} balls, {seconds} s; a drop's energy is {:.3} J a ball", drop.energy());
    println!(
        "{:10} {:>10} {:>12} {:>14} {:>12}  {}",
        "response", "ms a step", "ms at rest", "KE / drop", "overlap %r", "notes"
    );
    let position = Response::Position(Projection { substeps: substeps as u32, ..Projection::default() });
    let force = Response::by_name("force", drop.dt / 20.0, drop.mass());
    let impulse = Response::by_name("impulse", drop.dt, drop.mass());
    for response in [Some(position), impulse, force].into_iter().flatten() {
        if only.as_ref().is_none_or(|only| only == response.name()) {
            run(&drop, &response, seconds);
        }
    }
}

fn run(drop: &Drop, response: &Response, seconds: usize) {
    let start = drop.particles();
    let (walls, grips) = (drop.walls(), drop.grips());
    let (push, cuts) = match response {
        Response::Force(penalty) => (penalty.reaching(2.0 * drop.radius), 20),
        _ => (Penalty::NONE, 1),
    };
    let forces = (Gravity::EARTH, push);
    let scene = Scene {
        start: &start,
        forces: &forces,
        colliders: &walls,
        grips: &grips,
        contacts: response,
        integrator: &Symplectic,
        index: &Structure::Grid,
        ..Scene::EMPTY
    };
    let mut system = System::with(Heap::new(scene.size()));
    system.start(&scene, 1).expect("it fits");
    let dt = Time::from_seconds(drop.dt / cuts as f32);
    let steps = seconds * 60;
    let (mut all, mut rest) = (0.0, 0.0);
    let energy = |v: &[Vec3]| {
        v.iter().map(|v| 0.5 * f64::from(drop.mass()) * f64::from(v.length_squared())).sum::<f64>() / v.len() as f64
    };
    let verbose = std::env::var_os("VERBOSE").is_some();
    for step in 0..steps {
        let began = Instant::now();
        for _ in 0..cuts {
            system.step(&scene, dt);
        }
        let took = began.elapsed().as_secs_f64() * 1e3;
        all += took;
        if step + 60 >= steps {
            rest += took / 60.0;
        }
        if verbose && step % std::env::var("EVERY").map_or(60, |x| x.parse().unwrap()) == 0 {
            let particles = system.particles();
            println!(
                "  {step} {:.2} {:.2e} {:.2} {}",
                took,
                energy(particles.velocity) / drop.energy(),
                100.0 * deepest(drop, particles.position) / drop.radius,
                system.totals().contacts
            );
        }
    }
    let particles = system.particles();
    if verbose {
        let mut fast: Vec<_> =
            particles.velocity.iter().zip(particles.position).map(|(v, x)| (v.length(), *v, *x)).collect();
        fast.sort_by(|a, b| b.0.total_cmp(&a.0));
        for i in [0, 1, 2, 3, 5, 10, 30, 100, 300, 1000, 3000, 6000, 9000] {
            println!("    {i} {:?}", fast[i]);
        }
    }
    println!(
        "{:10} {:10.2} {:12.2} {:14.2e} {:12.2}  {:?}",
        response.name(),
        all / steps as f64,
        rest,
        energy(particles.velocity) / drop.energy(),
        100.0 * deepest(drop, particles.position) / drop.radius,
        system.totals().caps
    );
}
