//! A force of one's own: a magnet that pulls all toward a line, and says what energy that stores.
//!
//! `cargo run --release -p pointmass --example own_force`

use core::ops::Range;
use pointmass::force::State;
use pointmass::{Force, Heap, Measures, Particle, Scene, System, Time, Vec3, Verlet};

/// Pulls toward the y axis with `stiffness` \[N/m\].
struct Rail {
    stiffness: f32,
}

impl Force for Rail {
    fn add_to(&self, state: &State<'_>, rows: Range<usize>, total: &mut [Vec3]) {
        for (total, x) in total.iter_mut().zip(&state.position[rows]) {
            *total -= Vec3::new(x.x, 0.0, x.z) * self.stiffness;
        }
    }

    /// Nobody looks at another, so that a step may take rows a few at a time, and on all threads.
    fn is_local(&self) -> bool {
        true
    }

    fn energy(&self, state: &State<'_>) -> f64 {
        let off = |x: &Vec3| f64::from(x.x * x.x + x.z * x.z);
        0.5 * f64::from(self.stiffness) * state.position.iter().map(off).sum::<f64>()
    }

    fn name(&self) -> &'static str {
        "rail"
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let start = [Particle { position: Vec3::X, velocity: Vec3::new(0.0, 0.1, 2.0), ..Particle::REST }];
    let scene = Scene { start: &start, forces: &Rail { stiffness: 4.0 }, integrator: &Verlet, ..Scene::EMPTY };
    let mut system = System::with(Heap::new(scene.size()));
    system.start(&scene, 1)?;
    let before = Measures::of(&system, &scene).energy.total();
    // A turn takes 2 π √(m / stiffness) = π seconds.
    for n in 1..=1000 {
        system.step_to(&scene, Time::from_seconds_f64(std::f64::consts::PI * f64::from(n) / 1000.0));
    }
    let after = Measures::of(&system, &scene).energy.total();
    let back = system.particles().position[0];
    println!("after a turn at {back:.4}, energy {before:.6} J and {after:.6} J");
    assert!((back.x - 1.0).abs() < 1e-4 && (after / before - 1.0).abs() < 1e-5);
    Ok(())
}
