//! The same drop of balls into a box by position, by impulse and by force, and by rapier3d in the same run:
//! `cargo run --release -p pointmass-bench --features rapier --example drop -- [BALLS] [SECONDS] [SUBSTEPS]`.
//!
//! Times are means over all steps of 1/60 s; the force takes 20 of our steps for each, as its stiffness asks.

#[cfg(feature = "rapier")]
use pointmass::Vec3;
use pointmass::index::Structure;
use pointmass::scene::Position;
use pointmass::{Gravity, Heap, Penalty, Response, Scene, Symplectic, System, Time};
use pointmass_bench::drop::{Drop, deepest};
use std::time::Instant;

/// Our steps for one of the drop's, by force.
const FORCE_STEPS: usize = 20;

fn main() {
    let argument = |i: usize, default: usize| std::env::args().nth(i).and_then(|x| x.parse().ok()).unwrap_or(default);
    let (balls, seconds) = (argument(1, 10_000), argument(2, 8));
    let substeps = argument(3, Position::default().substeps as usize) as u32;
    let drop = Drop::of(balls);
    println!("{balls} balls, {seconds} s; the drop brings {:.3} J a ball", drop.energy());
    let [response, mean, last, energy, overlap] =
        ["response", "ms a step", "last second", "energy/drop", "overlap/radius"];
    println!("{response:12}{mean:>12}{last:>14}{energy:>14}{overlap:>16}");
    let position = Response::Position(Position { substeps, ..Position::default() });
    let impulse = Response::by_name("impulse", drop.dt, drop.mass());
    let force = Response::by_name("force", drop.dt / FORCE_STEPS as f32, drop.mass());
    for response in [Some(position), impulse, force].into_iter().flatten() {
        run(&drop, &response, seconds);
    }
    #[cfg(feature = "rapier")]
    rapier(&drop, seconds);
}

fn run(drop: &Drop, response: &Response, seconds: usize) {
    let start = drop.particles();
    let (walls, materials) = (drop.walls(), drop.materials());
    let (push, steps) = match response {
        Response::Force(penalty) => (penalty.reaching(2.0 * drop.radius), FORCE_STEPS),
        _ => (Penalty::NONE, 1),
    };
    let forces = (Gravity::EARTH, push);
    let scene = Scene {
        start: &start,
        forces: &forces,
        colliders: &walls,
        materials: &materials,
        constraints: &response.contacts(),
        substeps: response.substeps(),
        meetings: response.meetings(),
        integrator: &Symplectic,
        index: &Structure::Grid,
        ..Scene::EMPTY
    };
    let mut system = System::with(Heap::new(scene.size()));
    system.start(&scene, 1).expect("the memory was made for the scene");
    let dt = Time::from_seconds(drop.dt / steps as f32);
    let times = timed(seconds, || (0..steps).for_each(|_| drop_report(system.step(&scene, dt))));
    let particles = system.particles();
    let squares: f64 = particles.velocity.iter().map(|v| f64::from(v.length_squared())).sum();
    let energy = 0.5 * f64::from(drop.mass()) * squares / start.len() as f64;
    row(response.name(), times, energy / drop.energy(), deepest(drop, particles.position) / drop.radius);
}

fn drop_report(report: pointmass::Report) {
    std::hint::black_box(report);
}

#[cfg(feature = "rapier")]
fn rapier(drop: &Drop, seconds: usize) {
    use pointmass_peers::rapier;
    let mut pile = rapier::Pile::new(&rapier::Drop {
        positions: drop.positions.iter().map(Vec3::to_array).collect(),
        radius: drop.radius,
        density: 1000.0,
        friction: drop.friction,
        elasticity: drop.elasticity,
        half_width: drop.half_width,
        dt: drop.dt,
        length_unit: 2.0 * drop.radius,
        turns: true,
    });
    let times = timed(seconds, || pile.step());
    let energy = pile.kinetic_energy() / drop.positions.len() as f64;
    let positions: Vec<Vec3> = pile.positions().into_iter().map(Vec3::from).collect();
    row("rapier3d", times, energy / drop.energy(), deepest(drop, &positions) / drop.radius);
}

/// Milliseconds of a step on average, and in the last second.
fn timed(seconds: usize, mut step: impl FnMut()) -> [f64; 2] {
    let mut timed = |steps: usize| {
        let began = Instant::now();
        (0..steps).for_each(|_| step());
        began.elapsed().as_secs_f64() * 1e3
    };
    let (first, last) = (timed(60 * seconds.saturating_sub(1)), timed(60));
    [(first + last) / (60.0 * seconds.max(1) as f64), last / 60.0]
}

fn row(name: &str, [mean, last]: [f64; 2], energy: f64, overlap: f32) {
    println!("{name:12}{mean:12.2}{last:14.2}{energy:14.1e}{overlap:16.4}");
}
