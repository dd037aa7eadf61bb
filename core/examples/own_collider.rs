//! A collider of one's own: a bowl in the form of a paraboloid, in which balls bounce.
//!
//! `cargo run --release -p pointmass --example own_collider`

use pointmass::shape::{Collider, Hit, Segment};
use pointmass::{Gravity, Heap, Measures, Particle, Scene, System, Time, Vec3, Verlet};

/// y = x² + z², from above.
struct Bowl;

impl Bowl {
    fn height(p: Vec3) -> f32 {
        p.y - p.x * p.x - p.z * p.z
    }
}

impl Collider for Bowl {
    /// The first place where a segment goes through, with the normal toward where it came from, and how far that may be off by
    /// rounding.
    fn first_hit(&self, segment: &Segment) -> Option<Hit> {
        if !(Self::height(segment.from) > 0.0 && Self::height(segment.to) <= 0.0) {
            return None;
        }
        let (mut above, mut below) = (0.0, 1.0);
        for _ in 0..30 {
            let middle = 0.5 * (above + below);
            if Self::height(segment.at(middle)) > 0.0 { above = middle } else { below = middle }
        }
        let p = segment.at(above);
        Some(Hit::new(above, Vec3::new(-2.0 * p.x, 1.0, -2.0 * p.z).normalize(), 1e-6))
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let drop = |x: f32| Particle { position: Vec3::new(x, 2.0, 0.3), elasticity: 1.0, ..Particle::REST };
    let start = [-0.8, -0.1, 0.5, 1.1].map(drop);
    let scene = Scene { start: &start, forces: &Gravity::EARTH, colliders: &Bowl, integrator: &Verlet, ..Scene::EMPTY };
    let mut system = System::with(Heap::new(scene.size()));
    system.start(&scene, 1)?;
    let before = Measures::of(&system, &scene).energy.total();
    for frame in 1..=600 {
        system.step_to(&scene, Time::frame(frame, 60));
    }
    let after = Measures::of(&system, &scene).energy.total();
    println!("{} hits in ten seconds; energy {before:.3} J and {after:.3} J", system.totals().hits);
    assert!(system.particles().position.iter().all(|&x| Bowl::height(x) > 0.0) && (after / before - 1.0).abs() < 0.01);
    Ok(())
}
