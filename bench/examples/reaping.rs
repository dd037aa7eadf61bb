//! Steps of nothing but deaths, for `valgrind --tool=callgrind`: `reaping PARTICLES STEPS REAPERS`, each at 0.1/s.

use pointmass::{Chance, Scene, Symplectic, Time};
use pointmass_bench::{cloud, started};

fn main() {
    let mut numbers = std::env::args().skip(1).map(|text| text.parse().expect("a whole number"));
    let mut next = || numbers.next().expect("particles, steps and reapers");
    let (particles, steps, reapers) = (cloud(next()), next(), vec![Chance { rate: 0.1 }; next() as usize]);
    let scene = Scene { start: &particles, reapers: &reapers, integrator: &Symplectic, ..Scene::EMPTY };
    let mut system = started(&scene, particles.len());
    for step in 1..=steps {
        system.step(&scene, Time::frame(step.into(), 60) - system.time());
    }
    println!("{} live, {:016x}", system.len(), system.hash());
}
