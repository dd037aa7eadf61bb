//! A constraint of one's own: beads on a wire bent to a circle, which slide down it under gravity.
//!
//! `cargo run --release -p pointmass --example own_constraint`

use pointmass::constrain::{Bodies, Share};
use pointmass::{Constraint, Gravity, Heap, Measures, Particle, Scene, System, Time, Vec3};

/// A circle about the z axis.
struct Wire {
    /// Its radius \[m\].
    radius: f32,
}

impl Constraint for Wire {
    /// Where the method has moved them off the wire, they go to the nearest place on it. Velocities follow what is shifted.
    fn project(&self, bodies: &mut Bodies<'_>, _: &mut Share<'_>) {
        for row in 0..bodies.len() {
            let x = bodies.position[row];
            let flat = Vec3::new(x.x, x.y, 0.0);
            if flat.length() > 0.0 {
                bodies.shift(row, flat * (self.radius / flat.length()) - x);
            }
        }
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let bead = |angle: f32| Particle { position: Vec3::new(angle.cos(), angle.sin(), 0.0), ..Particle::REST };
    let start = [bead(0.0), bead(1.0), bead(2.5)];
    let (wire, gravity) = (Wire { radius: 1.0 }, Gravity::EARTH);
    let scene = Scene { start: &start, forces: &gravity, constraints: &wire, substeps: 50, ..Scene::EMPTY };
    let mut system = System::with(Heap::new(scene.size()));
    system.start(&scene, 1)?;
    let before = Measures::of(&system, &scene).energy.total();
    for frame in 1..=120 {
        system.step_to(&scene, Time::frame(frame, 60));
    }
    let after = Measures::of(&system, &scene).energy.total();
    let off = system.particles().position.iter().map(|x| (x.length() - 1.0).abs()).fold(0.0, f32::max);
    println!("two seconds later {off:.1e} m off the wire; energy {before:.3} J and {after:.3} J");
    assert!(off < 1e-5 && (after / before - 1.0).abs() < 0.05);
    Ok(())
}
