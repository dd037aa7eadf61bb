//! A constraint of one's own: beads on a wire bent to a circle, which slide down it under gravity.
//!
//! `cargo run --release -p pointmass --example own_constraint`

use pointmass::constrain::{Bodies, Share};
use pointmass::{Constraint, Gravity, Heap, Measures, Particle, Scene, System, Time, Vec3, Verlet};

/// A circle about the z axis.
struct Wire {
    /// Its radius \[m\].
    radius: f32,
}

impl Wire {
    /// The direction away from the axis.
    fn normal(x: Vec3) -> Vec3 {
        Vec3::new(x.x, x.y, 0.0).normalize_or_zero()
    }
}

/// Whoever goes to the nearest place takes energy out of the motion in each sub-step. This keeps it, with a method that does so as well
/// (RATTLE: Andersen, "Rattle: a velocity version of the Shake algorithm", J. Comput. Phys. 52, 1983).
impl Constraint for Wire {
    /// Where the method has moved them off the wire, they go back along the direction in which the wire pressed as the sub-step began.
    /// Velocities follow what is shifted.
    fn project(&self, bodies: &mut Bodies<'_>, _: &mut Share<'_>) {
        for row in 0..bodies.len() {
            let (x, normal) = (bodies.position[row], Self::normal(bodies.before[0][row]));
            // The least λ for which |(x + λ normal) in the plane| is the radius.
            let (b, flat) = (x.dot(normal), Vec3::new(x.x, x.y, 0.0));
            let root = b * b - flat.length_squared() + self.radius * self.radius;
            if root >= 0.0 {
                bodies.shift(row, normal * (root.sqrt() - b) + Vec3::NEG_Z * x.z);
            }
        }
    }

    /// Nothing is left of the velocity across the wire.
    fn settle(&self, bodies: &mut Bodies<'_>, _: &mut Share<'_>) {
        for row in 0..bodies.len() {
            let (v, normal) = (bodies.velocity[row], Self::normal(bodies.position[row]));
            bodies.velocity[row] = v - normal * v.dot(normal) - Vec3::Z * v.z;
        }
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let bead = |angle: f32| Particle { position: Vec3::new(angle.cos(), angle.sin(), 0.0), ..Particle::REST };
    let start = [bead(0.0), bead(1.0), bead(2.5)];
    let (wire, gravity) = (Wire { radius: 1.0 }, Gravity::EARTH);
    let scene =
        Scene { start: &start, forces: &gravity, constraints: &wire, substeps: 4, integrator: &Verlet, ..Scene::EMPTY };
    let mut system = System::with(Heap::new(scene.size()));
    system.start(&scene, 1)?;
    let before = Measures::of(&system, &scene).energy.total();
    for frame in 1..=120 {
        system.step_to(&scene, Time::frame(frame, 60));
    }
    let after = Measures::of(&system, &scene).energy.total();
    let off = system.particles().position.iter().map(|x| (x.length() - 1.0).abs()).fold(0.0, f32::max);
    println!("two seconds later {off:.1e} m off the wire; energy {before:.3} J and {after:.3} J");
    assert!(off < 1e-5 && (after / before - 1.0).abs() < 1e-3);
    Ok(())
}
