//! The same throw of dice on a table by `RigidBodies`, and by rapier3d in the same run:
//! `cargo run --release -p pointmass-bench --features rapier --example dice -- [DICE] [SECONDS] [SUBSTEPS] [WHO] [CELLS]`.
//!
//! Times are means over steps of 1/60 s. WHO is `ours`, `rapier`, `awake` (rapier3d without sleeping) or `all`: with one of them alone instructions
//! can be counted, as the difference of two runs of other lengths. The table is a plane, or a mesh of so many CELLS a side.

use pointmass::index::Structure;
use pointmass::rays;
use pointmass::shape::{Collider, MeshBuf, Plane};
use pointmass::{Gravity, Scene, Symplectic, Time, Vec3};
use pointmass_bench::dice::{Pose, Throw, deepest, table};
use pointmass_bench::started;
use std::time::Instant;

fn main() {
    let argument = |i: usize, default: usize| std::env::args().nth(i).and_then(|x| x.parse().ok()).unwrap_or(default);
    let (dice, seconds, substeps) = (argument(1, 1200), argument(2, 5), argument(3, 10) as u32);
    let who = std::env::args().nth(4).unwrap_or_else(|| "all".into());
    let (throw, cells) = (Throw::of(dice), argument(5, 0) as u32);
    println!("{dice} dice, {seconds} s");
    println!("{:28}{:>12}{:>14}{:>16}{:>16}", "", "ms a step", "last second", "fastest m/s", "overlap/side");
    if who == "all" || who == "ours" {
        ours(&throw, seconds, substeps, cells);
    }
    #[cfg(feature = "rapier")]
    for (name, sleeps) in [("rapier", true), ("awake", false)] {
        if who == "all" || who == name {
            rapier(&throw, seconds, sleeps, cells);
        }
    }
}

fn ours(throw: &Throw, seconds: usize, substeps: u32, cells: u32) {
    let (start, bodies) = throw.bodies();
    let materials = throw.materials();
    let table: Box<dyn Collider> = match cells {
        0 => Box::new(Plane { point: Vec3::ZERO, normal: Vec3::Y }),
        cells => {
            let (vertices, triangles) = table(cells);
            Box::new(MeshBuf::new(vertices, triangles).expect("a table is a mesh").indexed(rays::Structure::Bvh))
        }
    };
    let scene = Scene {
        start: &start,
        forces: &Gravity::EARTH,
        colliders: &*table,
        materials: &materials,
        constraints: &bodies,
        substeps,
        integrator: &Symplectic,
        index: &Structure::Grid,
        ..Scene::EMPTY
    };
    let mut system = started(&scene, start.len());
    let dt = Time::frame(1, 60);
    let times = timed(seconds, || {
        std::hint::black_box(system.step(&scene, dt));
    });
    let particles = system.particles();
    let fastest = particles.velocity.iter().map(|v| v.length()).fold(0.0, f32::max);
    row(&format!("{substeps} sub-steps"), times, fastest, throw, &throw.poses(particles.position));
    let caps = system.totals().caps.contacts;
    if caps > 0 {
        println!("{caps} contacts found no room");
    }
}

#[cfg(feature = "rapier")]
fn rapier(throw: &Throw, seconds: usize, sleeps: bool, cells: u32) {
    use pointmass_peers::rapier::{Cuboids, Die};
    let die = |die: &pointmass_bench::dice::Die| Die {
        place: die.place.to_array(),
        turn: die.turn.to_array(),
        velocity: die.velocity.to_array(),
        spin: die.spin.to_array(),
    };
    let dice: Vec<_> = throw.dice.iter().map(die).collect();
    let (vertices, triangles) = table(cells);
    let mesh = (vertices.iter().map(Vec3::to_array).collect::<Vec<_>>(), triangles);
    let touch = [throw.friction, throw.elasticity];
    let mut cuboids = Cuboids::new(&dice, throw.half, throw.mass, touch, sleeps, (cells > 0).then_some(&mesh));
    let times = timed(seconds, || cuboids.step());
    let poses: Vec<_> = cuboids.poses().map(|(place, axes)| (Vec3::from(place), axes.map(Vec3::from))).collect();
    row(if sleeps { "rapier3d" } else { "rapier3d, never sleeping" }, times, cuboids.fastest(), throw, &poses);
}

/// Milliseconds of a step on average, and in the last second.
fn timed(seconds: usize, mut step: impl FnMut()) -> [f64; 2] {
    let mut timed = |steps: usize| {
        let began = Instant::now();
        (0..steps).for_each(|_| step());
        began.elapsed().as_secs_f64() * 1e3
    };
    let (first, last) = (timed(60 * seconds.saturating_sub(1)), timed(60.min(60 * seconds)));
    [(first + last) / (60.0 * seconds.max(1) as f64), last / 60.0]
}

fn row(name: &str, [mean, last]: [f64; 2], fastest: f32, throw: &Throw, poses: &[Pose]) {
    let overlap = deepest(throw.half, poses) / (2.0 * throw.half);
    println!("{name:28}{mean:12.2}{last:14.2}{fastest:16.4}{overlap:16.4}");
}
