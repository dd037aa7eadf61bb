//! Sheets that have nothing to do with each other: what some do is nothing to others, and what cannot be kept apart does no harm.

use super::cloths::{Cloths, cotton, square};
use pointmass::motion::Motion;
use pointmass::shape::{Moving, Sphere, Surface};
use pointmass::{Gravity, Method, Report, Scene, Time, Vec3};
use pointmass_tests::started;

/// The velocities of the particles from one on after some frames, and what was counted.
fn velocities(scene: &Scene<'_>, frames: u64, first: usize) -> (Vec<Vec3>, Report) {
    let mut system = started(scene, scene.start.len(), 0);
    for frame in 1..=frames {
        system.step_to(scene, Time::frame(frame, 60));
    }
    (system.particles().velocity[first..].to_vec(), *system.totals())
}

/// Three sheets that run into each other and a ball so fast that they have to be moved as one.
fn crash(cells: u32, speed: f32) -> Cloths {
    let mut cloths = Cloths::default();
    for (height, times, slope) in [(0.0, 1.0, 0.0), (0.2, 2.0, 0.1), (0.5, 4.0, -0.1)] {
        let sides = [Vec3::new(1.0, slope, 0.0), Vec3::Z];
        cloths.add(&square(Vec3::Y * height, sides, cells), cotton(1.0), |x| x, Vec3::NEG_Y * (times * speed));
    }
    cloths
}

#[test]
fn a_crash_of_sheets_is_nothing_to_others() {
    for (cells, speed, substeps, method) in
        [(6, 100.0, 1, Method::Symplectic), (10, 100.0, 1, Method::Verlet), (8, 40.0, 3, Method::Rk4)]
    {
        let mut cloths = crash(cells, speed);
        let first = cloths.start.len();
        let drift = Vec3::new(0.5, 0.0, 1.0);
        cloths.add(&square(Vec3::X * 50.0, [Vec3::X * 0.4, Vec3::Z * 0.4], 4), cotton(1.0), |x| x, drift);
        let ball = Sphere { center: Vec3::NEG_Y * 0.3, radius: 0.2 };
        let constraints = (&cloths.shells[..], cloths.contacts(0.2 / cells as f32));
        let integrator = method.integrator();
        let scene = Scene {
            start: &cloths.start,
            colliders: &ball,
            constraints: &constraints,
            substeps,
            integrator,
            ..Scene::EMPTY
        };
        let (others, report) = velocities(&scene, 6, first);
        let off = others.iter().map(|v| (*v - drift).length()).fold(0.0, f32::max);
        assert!(off < 1e-3 && report.effort.capped > 0, "{cells} cells, {speed} m/s: {off} m/s, {report:?}");
    }
}

#[test]
fn what_sheets_do_to_each_other_turns_no_others() {
    for (substeps, method) in [(1, Method::Rk4), (4, Method::Symplectic), (20, Method::Verlet)] {
        let mut cloths = Cloths::default();
        let flat = [Vec3::new(0.4, 0.03, 0.0), Vec3::new(0.0, 0.02, 0.4)];
        cloths.add(&square(Vec3::ZERO, flat, 6), cotton(1.0), |x| x, Vec3::X * 0.5);
        let (center, velocity) = (Vec3::new(0.22, 0.12, -0.05), Vec3::new(-1.0, -2.0, 0.3));
        cloths.add(&square(center, flat, 6), cotton(1.0), |x| x, velocity);
        let first = cloths.start.len();
        cloths.add(&square(Vec3::X * 1.5, flat, 3), cotton(1.0), |x| x, Vec3::ZERO);
        let constraints = (&cloths.shells[..], cloths.contacts(0.008));
        let integrator = method.integrator();
        let scene = Scene { start: &cloths.start, constraints: &constraints, substeps, integrator, ..Scene::EMPTY };
        let (others, report) = velocities(&scene, 24, first);
        let fastest = others.iter().map(|v| v.length()).fold(0.0, f32::max);
        assert!(fastest < 1e-5 && report.contacts > 0, "{substeps}, {method}: {fastest} m/s, {report:?}");
    }
}

/// Points that are fixed nearer to each other than they may be are not kept apart, nor does what hangs on them fly off.
#[test]
fn sheets_that_are_fixed_in_each_other_hang_all_the_same() {
    for (round, gap) in [0.0, 1e-6, 1e-4, 2e-3, 5e-3].into_iter().enumerate() {
        for cells in [3, 5] {
            let (method, substeps) = [(Method::Verlet, 20), (Method::Symplectic, 5), (Method::Rk4, 8)][round % 3];
            let mut cloths = Cloths::default();
            for place in [Vec3::ZERO, Vec3::new(0.27, 0.0, gap)] {
                let first = cloths.start.len();
                let sheet = square(place, [Vec3::X * 0.5, Vec3::NEG_Y * 0.5], cells);
                cloths.add(&sheet, cotton(3.0), |x| x, Vec3::ZERO);
                cloths.start[first..=first + cells as usize].iter_mut().for_each(|particle| particle.fixed = true);
            }
            let constraints = (&cloths.shells[..], cloths.contacts(0.006));
            let integrator = method.integrator();
            let scene = Scene {
                start: &cloths.start,
                forces: &Gravity::EARTH,
                constraints: &constraints,
                substeps,
                integrator,
                ..Scene::EMPTY
            };
            let mut system = started(&scene, cloths.start.len(), 0);
            let mut farthest = 0.0f32;
            for frame in 1..=40 {
                system.step_to(&scene, Time::frame(frame, 60));
                let x = system.particles().position;
                farthest = x.iter().zip(&cloths.start).map(|(x, p)| x.distance(p.position)).fold(farthest, f32::max);
            }
            let report = system.totals();
            let what = format!("{gap} m, {cells} cells, {method}: {farthest} m, {report:?}");
            assert!(farthest < 1.0 && report.caps.contacts == 0, "{what}");
        }
    }
}

/// A ball that comes to a sheet which lies still presses it as a sheet is pressed that comes to a ball, whatever is left of a step.
#[test]
fn what_comes_within_a_step_to_what_lies_still_is_met_in_time() {
    for (rate, substeps, method) in [(60, 20, Method::Symplectic), (30, 24, Method::Verlet), (24, 40, Method::Rk4)] {
        let gap = |is_ball: bool| {
            let mut cloths = Cloths::default();
            let sides = [Vec3::X * 0.4, Vec3::Z * 0.4];
            let velocity = if is_ball { Vec3::ZERO } else { Vec3::Y * 4.0 };
            cloths.add(&square(Vec3::ZERO, sides, 10), cotton(1.0), |x| x, velocity);
            let ball = Sphere { center: Vec3::Y * 0.3, radius: 0.1 };
            let drift = Motion { drift: if is_ball { Vec3::NEG_Y * 4.0 } else { Vec3::ZERO }, ..Motion::STILL };
            let moving = Moving::new(ball, &ball.bounds(), drift);
            let constraints = (&cloths.shells[..], cloths.contacts(0.008));
            let integrator = method.integrator();
            let scene = Scene {
                start: &cloths.start,
                colliders: &moving,
                constraints: &constraints,
                substeps,
                integrator,
                ..Scene::EMPTY
            };
            let mut system = started(&scene, cloths.start.len(), 0);
            let mut least = f32::INFINITY;
            for frame in 1..=u64::from(rate) / 12 {
                system.step_to(&scene, Time::frame(frame, rate));
                let time = system.time().seconds();
                let center = ball.center + drift.drift * time;
                least = system.particles().position.iter().map(|x| x.distance(center) - 0.1).fold(least, f32::min);
            }
            least
        };
        let [ball, sheet] = [gap(true), gap(false)];
        assert!(
            (ball - sheet).abs() < 0.4e-3 && sheet > 3e-3,
            "{rate}/s in {substeps}, {method}: {ball} and {sheet} m"
        );
    }
}

/// A step of so few units of time that some of its sub-steps would take none, in memory that others have used.
#[test]
fn steps_shorter_than_their_sub_steps_do_no_harm() {
    let others = crash(6, 30.0);
    let constraints = (&others.shells[..], others.contacts(0.03));
    let others = Scene { start: &others.start, constraints: &constraints, substeps: 20, ..Scene::EMPTY };
    let mut cloths = Cloths::default();
    for height in [0.0, 0.004] {
        cloths.add(&square(Vec3::Y * height, [Vec3::X, Vec3::Z], 5), cotton(1.0), |x| x, Vec3::ZERO);
    }
    let constraints = (&cloths.shells[..], cloths.contacts(0.005));
    let scene = Scene { start: &cloths.start, constraints: &constraints, substeps: 20, ..Scene::EMPTY };
    let mut system = started(&others, others.start.len(), 0);
    for ticks in 1..50 {
        for frame in 1..=3 {
            system.step_to(&others, Time::frame(frame, 60));
        }
        system.start(&scene, 1).expect("there is room for fewer");
        system.step(&scene, Time::from_ticks(ticks));
        assert_eq!(system.time().ticks(), ticks);
        let all = system.particles();
        assert!(all.position.iter().chain(all.velocity).all(|x| x.is_finite()), "{ticks}");
        assert_eq!(system.totals().caps.insufficient_memory, 0);
        system.start(&others, 1).expect("there is room");
    }
}
