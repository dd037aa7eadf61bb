//! Lists of who may come near whom change no bit of what happens.

use super::cloths::{Cloths, G, cotton, square};
use pointmass::constrain::{Bodies, Demand, Share};
use pointmass::force::Friction;
use pointmass::material::ContactMaterial;
use pointmass::motion::{Key, Motion};
use pointmass::shape::{Collider, Moving, Plane, Sphere, Surface};
use pointmass::{Constraint, Force, Gravity, Method, Scene, Time, Vec3};
use pointmass_tests::{Random, every, started};

/// A constraint to which less memory is lent for a step than it asks for.
struct Lent<C> {
    constraint: C,
    /// The words that it is short of.
    short: usize,
}

impl<C> Lent<C> {
    fn lend(&self, share: &mut Share<'_>, then: impl FnOnce(&C, &mut Share<'_>)) {
        let Share { kept, step, scratch, capacity } = share;
        let kept = pointmass::constrain::Kept { rows: kept.rows, fixed: kept.fixed };
        let left = step.len().saturating_sub(self.short);
        then(&self.constraint, &mut Share { kept, step: &mut step[..left], scratch, capacity: *capacity });
    }
}

impl<C: Constraint> Constraint for Lent<C> {
    fn demand(&self) -> Demand {
        self.constraint.demand()
    }
    fn prepare(&self, bodies: &mut Bodies<'_>, share: &mut Share<'_>) {
        self.lend(share, |constraint, share| constraint.prepare(bodies, share));
    }
    fn project(&self, bodies: &mut Bodies<'_>, share: &mut Share<'_>) {
        self.lend(share, |constraint, share| constraint.project(bodies, share));
    }
    fn settle(&self, bodies: &mut Bodies<'_>, share: &mut Share<'_>) {
        self.lend(share, |constraint, share| constraint.settle(bodies, share));
    }
}

/// The words that lists of so many particles ask for, as far as each holds a pair.
fn lists(particles: usize) -> usize {
    particles * (24 * 4 + 6) + 64 * 4 + 5
}

/// Three sheets: one that falls flat, one that falls crumpled, and one held at an edge in the way of both.
fn cloths(size: f32, far: Vec3, cells: u32, seed: u64) -> Cloths {
    let mut cloths = Cloths::default();
    let mut random = Random::new(seed);
    let flat = square(far + Vec3::Y * (0.35 * size), [Vec3::X, Vec3::Z].map(|side| side * (0.4 * size)), cells);
    cloths.add(&flat, cotton(size), |x| x, Vec3::new(0.3, -0.5, 0.0) * size);
    let sides = [Vec3::new(0.35, 0.1, 0.0), Vec3::new(0.0, 0.15, 0.35)].map(|side| side * size);
    let crumpled = |x: Vec3| {
        let from = (x - far) / size;
        // Folds as of a curtain, and a little of everything.
        far + Vec3::new(0.6 * from.x, from.y + 0.04 * (40.0 * from.x).sin(), from.z) * size
            + random.vector(0.002 * size)
    };
    let crumpled = std::cell::RefCell::new(crumpled);
    let center = far + Vec3::new(0.03, 0.6, 0.02) * size;
    cloths.add(&square(center, sides, cells), cotton(size), |x| (crumpled.borrow_mut())(x), Vec3::NEG_Y * size);
    let first = cloths.start.len();
    let held = square(far + Vec3::Y * (0.2 * size), [Vec3::X, Vec3::Z].map(|side| side * (0.3 * size)), cells);
    cloths.add(&held, cotton(size), |x| x, Vec3::ZERO);
    cloths.start[first..=first + cells as usize].iter_mut().for_each(|particle| particle.fixed = true);
    cloths.start.iter_mut().for_each(|particle| particle.material = Some(0));
    cloths
}

/// The hash after each frame and what has been counted, with so many words less than asked for.
fn run(cloths: &Cloths, size: f32, far: Vec3, (substeps, method): (u32, Method), short: usize) -> (Vec<u64>, [u64; 3]) {
    let constraint = cloths.contacts(0.006 * size);
    let constraints = (&cloths.shells[..], Lent { constraint, short });
    let forces: &dyn Force = &Gravity { acceleration: Vec3::NEG_Y * (G * size) };
    let rough = [ContactMaterial { friction: Some(Friction { static_: 0.4, kinetic: 0.3 }), elasticity: None }];
    let keys = [(0.0f32, Vec3::ZERO), (0.2, Vec3::Y * (0.1 * size)), (0.5, Vec3::X * (0.2 * size))];
    let keys = keys.map(|(time, place)| Key { time, place, ..Key::default() });
    let ball = Sphere { center: far + Vec3::Y * (0.06 * size), radius: 0.1 * size };
    let moving = Moving::new(ball, &ball.bounds(), Motion::with_keys(keys, 0.0));
    let colliders: &dyn Collider = &(Plane { point: far, normal: Vec3::Y }, moving);
    let integrator = method.integrator();
    let scene = Scene {
        start: &cloths.start,
        forces,
        colliders,
        materials: &rough,
        constraints: &constraints,
        substeps,
        integrator,
        ..Scene::EMPTY
    };
    let mut system = started(&scene, cloths.start.len(), 0);
    let hashes = (1..=24).map(|frame| {
        system.step_to(&scene, Time::frame(frame, 60));
        system.hash()
    });
    let hashes = hashes.collect();
    let report = *system.totals();
    assert!(report.contacts > 50 && report.hits > 0, "{report:?}");
    (hashes, [report.effort.lists, report.effort.streamed, report.caps.contacts])
}

#[test]
fn lists_give_what_a_search_of_all_gives() {
    for (number, (substeps, method, size, far, cells)) in [
        (1u32, Method::Rk4, 1.0f32, Vec3::ZERO, 6u32),
        (5, Method::Symplectic, 1.0, Vec3::new(30.0, 7.0, -20.0), 7),
        (10, Method::Verlet, 0.01, Vec3::new(0.3, -0.1, 0.2), 6),
        (20, Method::Euler, 50.0, Vec3::ZERO, 5),
    ]
    .into_iter()
    .enumerate()
    .step_by(every(3))
    {
        let cloths = cloths(size, far, cells, number as u64);
        let particles = cloths.start.len();
        let (listed, [lists_made, searches, lost]) = run(&cloths, size, far, (substeps, method), 0);
        assert!(lists_made > 0 && searches < lists_made && lost == 0, "{lists_made} {searches} {lost}");
        // Memory for none, and for a few pairs only: for so many that lists of a single sub-step may find room, which are made more often.
        let none = lists(particles);
        for short in [none, none - 6 * particles - 5 * particles] {
            let (anew, [made, searched, _]) = run(&cloths, size, far, (substeps, method), short);
            assert!(searched > searches && (short < none || made == 0), "{number}: {made} {searched}");
            assert_eq!(anew, listed, "{number}, {short} words short");
        }
    }
}
