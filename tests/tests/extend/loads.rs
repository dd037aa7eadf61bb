//! A constraint of a user's own that bears what ties lay on it: it is solved with that, and what is tied to it goes along.

use pointmass::constrain::{Bodies, Share, Tie};
use pointmass::{Constraint, Gravity, Particle, Scene, Time, Vec3};
use pointmass_tests::started;

/// Holds a particle to a place by a stiff spring, by an implicit step: Δx = −x k h² / (m + k h²), with all that it bears as m.
struct Spring {
    particle: u32,
    place: Vec3,
    stiffness: f32,
    bears: bool,
}

impl Constraint for Spring {
    fn prepare(&self, bodies: &mut Bodies<'_>, _: &mut Share<'_>) {
        if let Some(row) = bodies.row_of_start(self.particle).filter(|_| self.bears) {
            bodies.bear(row);
        }
    }

    fn project(&self, bodies: &mut Bodies<'_>, _: &mut Share<'_>) {
        let Some(row) = bodies.row_of_start(self.particle) else { return };
        let h = bodies.substep.seconds();
        let (pull, inverse) = (self.stiffness * h * h, bodies.laden_inverse(row));
        bodies.take_up(row);
        bodies.shift(row, (self.place - bodies.position[row]) * (pull * inverse / (1.0 + pull * inverse)));
        bodies.put_down(row);
    }
}

/// How low a weight hangs that is tied to a particle of a thousandth of its mass on such a spring, when that has been damped out.
fn hangs(bears: bool) -> f32 {
    let part = |mass: f32| Particle { mass, drag: 3.0, ..Particle::REST };
    let start = [part(0.001), part(1.0)];
    let spring = Spring { particle: 0, place: Vec3::ZERO, stiffness: 1000.0, bears };
    let gravity = (Gravity::EARTH, pointmass::Drag {});
    let constraints = (spring, Tie::<[u32; 1]>::rigid(1, [0]));
    let scene = Scene { start: &start, forces: &gravity, constraints: &constraints, ..Scene::EMPTY };
    let mut system = started(&scene, 2, 0);
    for frame in 1..=600 {
        system.step_to(&scene, Time::frame(frame, 60));
    }
    -system.particles().position[1].y
}

#[test]
fn constraints_bear_what_is_laid_on_their_particles() {
    let right = 9.80665 * 1.001 / 1000.0;
    let [borne, behind] = [true, false].map(hangs);
    assert!((borne - right).abs() < 1.5 * 9.8 / 3600.0, "{borne} for {right} m");
    assert!(behind > 10.0 * right, "it is met behind: {behind} m");
}
