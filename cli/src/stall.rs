//! Steps that are too short for where a scene is: rounding swallows what moves there.

use crate::report::words::thousands;
use pointmass::scene::Model;
use pointmass::{ForceKind, Report, Vec3};

/// The share of a scene's speeds below which nobody misses what rounding swallows.
const NEGLIGIBLE: f64 = 0.01;
/// The share of all steps of particles that may stall before it is said.
const SELDOM: f64 = 0.01;

/// The motion lost in steps of `h` \[s\] of a run of some duration \[s\], if that is worth telling: told by where particles begin
/// and by how fast they move at first or after a second's fall.
pub(crate) fn foreseen(model: &Model, h: f64, duration: f64) -> Option<String> {
    let h = h / f64::from(model.substeps);
    let free = || model.particles.iter().filter(|particle| !particle.fixed);
    let fall = gravity(model).to_array().map(f64::from).map(|g| g.abs() * duration.min(1.0));
    for axis in 0..3 {
        let start = free().map(|particle| f64::from(particle.velocity[axis].abs()));
        let fastest = start.fold(fall[axis], f64::max);
        let farthest = free().map(|particle| particle.position[axis].abs()).fold(0.0, f32::max);
        let slowest = f64::from(farthest.next_up() - farthest) / 2.0 / h;
        // The speeds from which on the core counts, too.
        let counts = slowest > f64::from(farthest / 4096.0).min(1.0 / 128.0);
        if counts && fastest > 0.0 && slowest > NEGLIGIBLE * fastest && farthest < f32::INFINITY {
            let name = ["x", "y", "z"][axis];
            return Some(format!(
                "steps of {h:.3e} s are too short at {name} = {farthest}: what is slower than {slowest:.3} m/s there stands still, since a 32-bit float has no place between; take longer steps or move the scene nearer to the origin"
            ));
        }
    }
    None
}

/// The motion lost in a run in which particles made so many steps, if that is worth telling.
pub(crate) fn told(totals: &Report, steps: f64) -> Option<String> {
    let stalled = totals.caps.stalled;
    (stalled as f64 > SELDOM * steps).then(|| {
        format!(
            "rounding swallowed motion in {} of {} steps of particles: they were too short so far from the origin; take longer steps or move the scene nearer to it",
            thousands(stalled as usize),
            thousands(steps as usize)
        )
    })
}

/// The uniform acceleration of all \[m/s²\].
pub(crate) fn gravity(model: &Model) -> Vec3 {
    let of =
        |force: &ForceKind| if let ForceKind::Gravity(gravity) = force { gravity.acceleration } else { Vec3::ZERO };
    model.forces.0.iter().map(of).sum()
}
