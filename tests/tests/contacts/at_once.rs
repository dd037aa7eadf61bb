//! Balls that meet several others, or others and the scenery, within one sub-step by position: each bounce leads to the next.

use std::collections::BTreeSet;

use pointmass::shape::Plane;
use pointmass::{Contacts, Gravity, Heap, Id, Impact, Method, Observer, Particle, Scene, System, Time, Vec3};
use pointmass_tests::{f64s, is_run, run, started};

const RADIUS: f32 = 0.1;
const FLOOR: Plane = Plane { point: Vec3::ZERO, normal: Vec3::Y };
const GRAVITY: Gravity = Gravity { acceleration: Vec3::new(0.0, -9.8, 0.0) };
const METHODS: [Method; 4] = [Method::Midpoint, Method::Verlet, Method::Rk4, Method::Embedded];

/// Energy with `gravity` along y [J].
fn energy(system: &System<Heap>, gravity: f64) -> f64 {
    let all = system.particles();
    let each = all.mass.iter().zip(all.velocity.iter().zip(all.position));
    each.map(|(&mass, (&v, x))| {
        f64::from(mass) * (0.5 * f64s(v).iter().map(|v| v * v).sum::<f64>() + gravity * f64::from(x.y))
    })
    .sum()
}

/// Balls over a plane, on which they fall.
fn over_a_floor(start: &[Particle], method: Method, substeps: u32) -> Scene<'_> {
    Scene {
        start,
        forces: &GRAVITY,
        constraints: &Contacts::HARD,
        integrator: method.integrator(),
        colliders: &FLOOR,
        substeps,
        ..Scene::EMPTY
    }
}

/// Balls above each other that fall on a plane meet each other while the lowest is at the plane, sooner or later within the same sub-step.
#[test]
fn a_column_that_falls_keeps_its_energy() {
    let mut cases = 0;
    for gaps in [&[0.3, 0.2][..], &[0.1, 0.02], &[0.03, 0.5, 0.31], &[0.2, 0.004, 0.1], &[0.6, 0.3, 0.07, 0.11, 0.4]] {
        for masses in [[1.0; 5], [1.0, 3.0, 0.5, 2.0, 0.8], [8.0, 4.0, 2.0, 1.0, 0.5], [0.5, 1.0, 0.4, 1.0, 2.0]] {
            for (rate, substeps) in [(60.0, 1), (60.0, 4), (60.0, 12), (144.0, 2)] {
                for method in METHODS {
                    if !is_run(&mut cases) {
                        continue;
                    }
                    let mut y = -RADIUS;
                    let start: Vec<_> = gaps
                        .iter()
                        .zip(masses)
                        .map(|(gap, mass)| {
                            y += gap + 2.0 * RADIUS;
                            let position = Vec3::Y * y;
                            Particle { position, mass, radius: RADIUS, elasticity: 1.0, ..Particle::REST }
                        })
                        .collect();
                    let scene = over_a_floor(&start, method, substeps);
                    let mut system = started(&scene, start.len(), 1);
                    let before = energy(&system, 9.8);
                    let case = format!("{gaps:?}, {masses:?}, {rate}/{substeps}, {method}");
                    for i in 1..=(4.0 * rate) as u32 {
                        system.step(&scene, Time::from_seconds_f64(f64::from(i) / rate) - system.time());
                        let now = energy(&system, 9.8);
                        assert!((now / before - 1.0).abs() < 0.02, "{case}: {now} of {before} J");
                    }
                    assert!(system.totals().hits > 0, "{case}");
                }
            }
        }
    }
}

/// All touches: who has touched whom, and how fast the two came together.
#[derive(Default)]
struct Told(Vec<(Id, Id, f32)>);

impl Observer for Told {
    fn touched(&mut self, touch: &Impact) {
        self.0.extend(touch.other.map(|other| (touch.id, other, touch.closing)));
    }
}

/// As many balls leave a row that touch each other as have come, as fast, whatever the order of the rows.
#[test]
fn a_cradle_passes_on_what_comes() {
    let mut cases = 0;
    for coming in 1..5_usize {
        for (rate, substeps) in [(24.0, 1), (60.0, 1), (60.0, 12), (144.0, 2)] {
            for row in [[0, 1, 2, 3, 4, 5], [5, 4, 3, 2, 1, 0], [2, 0, 5, 3, 1, 4], [1, 4, 0, 3, 5, 2]] {
                for speed in [0.1, 3.0] {
                    if !is_run(&mut cases) {
                        continue;
                    }
                    let ball = |i: usize| {
                        let is_coming = i < coming;
                        let x = 2.0 * RADIUS * i as f32 - if is_coming { 0.05 * speed } else { 0.0 };
                        let velocity = Vec3::X * if is_coming { speed } else { 0.0 };
                        Particle { position: Vec3::X * x, velocity, radius: RADIUS, elasticity: 1.0, ..Particle::REST }
                    };
                    let mut start = vec![Particle::REST; 6];
                    (0..6).for_each(|i| start[row[i]] = ball(i));
                    let scene = Scene { start: &start, constraints: &Contacts::HARD, substeps, ..Scene::EMPTY };
                    let mut system = started(&scene, 6, 1);
                    let mut told = Told::default();
                    for i in 1..=(0.5 * rate) as u32 {
                        let dt = Time::from_seconds_f64(f64::from(i) / rate) - system.time();
                        system.step_observed(&scene, dt, &mut told);
                    }
                    let velocity = system.particles().velocity;
                    let case = format!("{coming} at {speed} m/s, {rate}/{substeps}, {row:?}");
                    // Each two beside each other, from either side, by as fast as they came together: several blows within a sub-step as one.
                    told.0.retain(|(_, _, closing)| *closing > 0.01 * speed);
                    let all: BTreeSet<_> = told.0.iter().map(|&(id, other, _)| [id, other]).collect();
                    assert_eq!(all.len(), 10, "{case}: {:?}", told.0);
                    for (_, _, closing) in &told.0 {
                        let blows = closing / speed;
                        assert!(blows > 0.5 && (blows - blows.round()).abs() < 1e-3, "{case}: {:?}", told.0);
                    }
                    for i in 0..6 {
                        let want = if i >= 6 - coming { speed } else { 0.0 };
                        let off = (velocity[row[i]] - Vec3::X * want).length();
                        assert!(off < 1e-4 * speed, "{case}: ball {i} at {}", velocity[row[i]]);
                    }
                }
            }
        }
    }
}

/// A column at rest shows less speed than a third of what all get in a sub-step, however much heavier what is above is, and twenty balls in one sub-step are pressed into each other by no more than a
/// fifth of one.
#[test]
fn a_column_at_rest_shows_hardly_any_speed() {
    let mut cases = 0;
    for masses in [&[1.0, 100.0][..], &[1.0, 1.0, 8.0], &[8.0, 1.0, 1.0], &[1.0, 1.0, 1.0, 1.0, 20.0], &[1.0; 20]] {
        for elasticity in [0.0, 0.5] {
            for substeps in [1, 4, 12] {
                for &method in Method::ALL.iter().filter(|&&method| method != Method::Euler) {
                    if !is_run(&mut cases) {
                        continue;
                    }
                    let start: Vec<_> = (0_u8..)
                        .zip(masses)
                        .map(|(i, &mass)| Particle {
                            position: Vec3::Y * (RADIUS * (1.0 + 2.0 * f32::from(i))),
                            mass,
                            radius: RADIUS,
                            elasticity,
                            ..Particle::REST
                        })
                        .collect();
                    let scene = over_a_floor(&start, method, substeps);
                    let mut system = started(&scene, start.len(), 1);
                    run(&mut system, &scene, 1.0 / 60.0, 360);
                    let particles = system.particles();
                    let fastest = particles.velocity.iter().map(|v| v.length()).fold(0.0, f32::max);
                    let case = format!("{masses:?}, {elasticity}, {substeps}, {method}");
                    assert!(fastest < 0.3 * 9.8 / (60 * substeps) as f32, "{case}: {fastest} m/s");
                    let sunk =
                        (start[masses.len() - 1].position.y - particles.position[masses.len() - 1].y) / (2.0 * RADIUS);
                    assert!(masses.len() < 20 || sunk < 0.2, "{case}: pressed by {sunk} of a ball");
                }
            }
        }
    }
}

/// Balls that lose some at each bounce never have more than before, and come to rest.
#[test]
fn a_column_that_loses_some_comes_to_rest() {
    let mut cases = 0;
    for elasticity in [0.0, 0.3, 0.6] {
        for (rate, substeps) in [(24.0, 12), (60.0, 4), (60.0, 12)] {
            for method in METHODS {
                for mass in [1.0, 8.0] {
                    if !is_run(&mut cases) {
                        continue;
                    }
                    let start = [(0.2, 1.0), (0.45, 1.0), (0.9, mass)].map(|(y, mass)| Particle {
                        position: Vec3::Y * y,
                        mass,
                        radius: RADIUS,
                        elasticity,
                        ..Particle::REST
                    });
                    let scene = over_a_floor(&start, method, substeps);
                    let mut system = started(&scene, 3, 1);
                    let mut least = energy(&system, 9.8);
                    // What the blow has pressed into each other rises again.
                    let slack = 0.0125 * least;
                    let case = format!("{elasticity}, {rate}/{substeps}, {method}, {mass} kg above");
                    for i in 1..=(6.0 * rate) as u32 {
                        system.step(&scene, Time::from_seconds_f64(f64::from(i) / rate) - system.time());
                        let now = energy(&system, 9.8);
                        assert!(now < least + slack, "{case}: {now} after {least} J");
                        least = now.min(least);
                    }
                    let fastest = system.particles().velocity.iter().map(|v| v.length()).fold(0.0, f32::max);
                    assert!(fastest < 1e-3, "{case}: {fastest} m/s");
                }
            }
        }
    }
}
