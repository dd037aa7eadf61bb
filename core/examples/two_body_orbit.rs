//! Two bodies about each other, and the ledger of their energy: what each method loses, and to what.
//!
//! `cargo run --release -p pointmass --example two_body_orbit`

use pointmass::{Heap, Ledger, Measures, Method, MutualGravity, Particle, Scene, System, Time, Vec3};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // An ellipse of eccentricity 0.5 about a body of G M = 1 m³/s², which takes 2 π seconds.
    let start = [
        Particle { fixed: true, ..Particle::REST },
        Particle { position: Vec3::X * 0.5, velocity: Vec3::Y * 3f32.sqrt(), ..Particle::REST },
    ];
    let gravity = MutualGravity { constant: 1.0, ..MutualGravity::NEWTON };
    for method in [Method::Euler, Method::Symplectic, Method::Verlet, Method::Rk4] {
        let scene = Scene { start: &start, forces: &gravity, integrator: &method, ..Scene::EMPTY };
        let mut system = System::with(Heap::new(scene.size()));
        system.start(&scene, 1)?;
        let mut ledger = Ledger::new(&system, &scene);
        for n in 1..=500 {
            let instant = Time::from_seconds_f64(std::f64::consts::TAU * f64::from(n) / 500.0);
            system.step_observed(&scene, instant - system.time(), &mut ledger);
        }
        let off = (system.particles().position[1] - start[1].position).length();
        let error = ledger.books().remainder;
        let total = Measures::of(&system, &scene).energy.total();
        println!(
            "{:10} {off:.1e} m off after a turn; energy {total:+.6} J, of which {error:+.1e} J by the method",
            method.name()
        );
    }
    Ok(())
}
