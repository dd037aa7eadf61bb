//! What flies freely for a minute: it keeps its angular momentum, gains no energy, and flips when Euler's equations say so. What is not finite
//! is counted, and harms nobody else.

use pointmass::constrain::{RigidBodies, RigidBox, Shell, ShellParams, StrandParams, Strands, mesh_hinges};
use pointmass::{Constraint, Distance, Gravity, Measures, Method, Particle, Rope, Scene, ShapeMatching, Time, Vec3};
use pointmass_tests::{Random, f64s, gap, is_run, is_third, often, run, started};

const DOWN: Gravity = Gravity { acceleration: Vec3::new(0.0, -9.81, 0.0) };
const CUBE: [u32; 8] = [0, 1, 2, 3, 4, 5, 6, 7];

fn length(a: [f64; 3]) -> f64 {
    gap(a, [0.0; 3])
}

/// How far the angular momentum has gone from the first \[share\], and by how much kinetic energy has at most grown and changed \[shares\].
fn flown(scene: &Scene<'_>, frames: u64, each: &mut dyn FnMut(&[Vec3], &Measures)) -> [f64; 3] {
    let mut system = started(scene, scene.start.len(), 0);
    let begun = Measures::of(&system, scene);
    let mut worst = [0.0f64; 3];
    for frame in 1..=frames {
        system.step_to(scene, Time::frame(frame, 60));
        let now = Measures::of(&system, scene);
        let turned = gap(now.angular_momentum, begun.angular_momentum) / length(begun.angular_momentum);
        let grown = now.energy.kinetic / begun.energy.kinetic - 1.0;
        worst = [worst[0].max(turned), worst[1].max(grown), worst[2].max(grown.abs())];
        each(system.particles().position, &now);
    }
    worst
}

/// The corners of a box about the origin, turned by a random rotation, spinning in its own frame.
fn tumbling(random: &mut Random, half: Vec3, spin: Vec3) -> Vec<Particle> {
    let x = random.direction();
    let y = x.cross(random.direction()).normalize();
    let axes = [x, y, x.cross(y)];
    let world = |v: Vec3| axes[0] * v.x + axes[1] * v.y + axes[2] * v.z;
    let sign = |i: u32, axis: u32| if i >> axis & 1 == 1 { 1.0 } else { -1.0 };
    let corner = |i: u32| {
        let r = Vec3::new(sign(i, 0), sign(i, 1), sign(i, 2)) * half;
        Particle { position: world(r), velocity: world(spin.cross(r)), mass: 0.1, ..Particle::REST }
    };
    (0..8).map(corner).collect()
}

#[test]
fn clusters_keep_their_angular_momentum_for_a_minute() {
    let mut random = Random::new(3);
    let sides = [Vec3::new(0.3, 0.2, 0.1), Vec3::splat(0.5), Vec3::new(0.02, 1.0, 0.02), Vec3::new(300.0, 200.0, 1.0)];
    let spins = [Vec3::new(0.05, 4.0, 0.0), Vec3::new(3.0, 1.0, 2.0), Vec3::new(0.0, 0.3, 9.0)];
    let (mut cases, mut failures) = (0, vec![]);
    for half in sides {
        for spin in spins {
            let start = tumbling(&mut random, half, spin);
            let body = ShapeMatching::rigid(CUBE);
            for (i, substeps) in [1, 2, 5, 10, 20, 50].into_iter().enumerate() {
                if !is_run(&mut cases) {
                    continue;
                }
                let integrator = [Method::Symplectic, Method::Verlet, Method::Rk4][i % 3].integrator();
                let scene = Scene { start: &start, constraints: &body, substeps, integrator, ..Scene::EMPTY };
                let [turned, ..] = flown(&scene, often(3600) as u64, &mut |_, _| ());
                // A needle that turns about its length has next to no moment of inertia there, of which rounding takes more.
                let most = if half == sides[2] { 3e-4 } else { 1e-4 };
                if !(turned < most) {
                    failures.push(format!("{half} {spin} in {substeps}: {turned:.1e}"));
                }
            }
        }
    }
    assert!(failures.is_empty(), "{} {failures:#?}", failures.len());
}

/// Points on a line, which has no moment of inertia about itself, turn for a minute as fast as they began to.
#[test]
fn rods_keep_their_spin_for_a_minute() {
    let mut random = Random::new(13);
    for number in 0..often(24) {
        let (count, size) = ([2, 3, 10][number % 3], [1.0f32, 0.01, 100.0][number / 3 % 3]);
        let (along, omega) = ([Vec3::X, Vec3::Z, random.direction()][number % 3] * size, random.vector(9.0));
        let (place, velocity) = (random.vector(2.0 * size), random.vector(0.1 * size));
        let start: Vec<Particle> = (0..count)
            .map(|i| {
                let r = along * (i as f32 / (count - 1) as f32 - 0.5);
                Particle { position: place + r, velocity: velocity + omega.cross(r), mass: 0.1, ..Particle::REST }
            })
            .collect();
        let body = ShapeMatching::rigid((0..count).collect::<Vec<u32>>());
        let (substeps, method) =
            [(1, Method::Symplectic), (5, Method::Verlet), (20, Method::Rk4), (10, Method::Symplectic)][number % 4];
        let integrator = method.integrator();
        let scene = Scene { start: &start, constraints: &body, substeps, integrator, ..Scene::EMPTY };
        let [_, _, changed] = flown(&scene, often(3600) as u64, &mut |_, _| ());
        assert!(changed < 2e-3, "{number}: {count} along {along} in {substeps}: {changed:.1e}");
    }
}

/// A box of 1 x 2 x 3 turns about its middle axis and flips for a minute as often as Euler's equations say, whether it is a cluster or a rigid body.
#[test]
fn what_turns_about_its_middle_axis_flips_in_its_time() {
    let (half, spin) = (Vec3::new(0.5, 1.0, 1.5), Vec3::new(0.05, 4.0, 0.05));
    // Moments of inertia in proportion, by a Runge-Kutta method in double precision.
    let [a, b, c] = [1.0 + 2.25, 0.25 + 2.25, 0.25 + 1.0f64];
    let rate = |w: [f64; 3]| [(b - c) / a * w[1] * w[2], (c - a) / b * w[2] * w[0], (a - b) / c * w[0] * w[1]];
    let add = |a: [f64; 3], b: [f64; 3], h: f64| [0, 1, 2].map(|k| a[k] + h * b[k]);
    let (mut w, h, mut expected) = (f64s(spin), 1e-4, vec![]);
    for i in 0..600_000 {
        let k1 = rate(w);
        let k2 = rate(add(w, k1, h / 2.0));
        let k3 = rate(add(w, k2, h / 2.0));
        let k4 = rate(add(w, k3, h));
        let next = [0, 1, 2].map(|k| w[k] + h / 6.0 * (k1[k] + 2.0 * k2[k] + 2.0 * k3[k] + k4[k]));
        if next[1] * w[1] < 0.0 {
            expected.push(f64::from(i) * h);
        }
        w = next;
    }
    assert!(expected.len() > 5);
    let of = RigidBox::new(half, Vec3::ZERO, 0);
    let turning = |p: Particle| Particle { velocity: spin.cross(p.position), ..p };
    let solid: Vec<Particle> = of.solid(Particle::REST).map(turning).into();
    let (cluster, rigid) = (ShapeMatching::rigid(CUBE), RigidBodies::boxes([of]));
    for (name, constraint) in [("cluster", &cluster as &dyn Constraint), ("rigid body", &rigid)] {
        for substeps in [5, 10] {
            let scene = Scene { start: &solid, constraints: constraint, substeps, ..Scene::EMPTY };
            let (mut flips, mut before, mut frame) = (vec![], 1.0, 0);
            let [turned, _, changed] = flown(&scene, 3600, &mut |x, now| {
                let axis = f64s(x[2] - x[0]);
                let along = (0..3).map(|k| axis[k] * now.angular_momentum[k]).sum::<f64>();
                frame += 1;
                if along * before < 0.0 {
                    flips.push(f64::from(frame) / 60.0);
                }
                before = along;
            });
            assert!(turned < 1e-4 && changed < 1e-2, "{name} in {substeps}: {turned} {changed}");
            // Each flip hangs by the rounding and the error of those before; their mean time does not.
            let mean = |times: &[f64]| (times[times.len() - 1] - times[0]) / (times.len() - 1) as f64;
            let off = mean(&flips) / mean(&expected) - 1.0;
            assert!(off.abs() < 0.02 && flips.len().abs_diff(expected.len()) < 2, "{name} in {substeps}: {off}");
        }
    }
}

/// Rigid ropes gain no energy, whether they spin or whirl, and none, rigid or soft, loses angular momentum, however short the sub-steps whose rounding
/// adds up.
#[test]
fn free_ropes_keep_their_momenta_and_their_energy() {
    let (mut random, mut cases) = (Random::new(8), 0);
    for (links, whirl, compliance) in
        [(1usize, 0.0f32, 0.0f32), (3, 0.0, 0.0), (12, 0.0, 0.0), (12, 0.3, 0.0), (1, 0.1, 1e-5), (4, 0.1, 1e-5)]
    {
        let part = |i: usize| {
            let position = Vec3::X * (0.1 * i as f32);
            let velocity = Vec3::Z.cross(position) * 3.0 + random.vector(whirl) * Vec3::new(0.0, 1.0, 1.0);
            Particle { position, velocity, mass: 0.1 * random.between(0.5, 1.5), ..Particle::REST }
        };
        let mut start: Vec<Particle> = (0..=links).map(part).collect();
        let mass: f32 = start.iter().map(|p| p.mass).sum();
        let mean = |of: fn(&Particle) -> Vec3| start.iter().map(|p| of(p) * p.mass).sum::<Vec3>() / mass;
        let (x, v) = (mean(|p| p.position), mean(|p| p.velocity));
        start.iter_mut().for_each(|p| (p.position, p.velocity) = (p.position - x, p.velocity - v));
        let rope = Rope { compliance, ..Rope::rigid((0..=links as u32).collect::<Vec<_>>(), [0.1]) };
        for (i, substeps) in [1u32, 2, 5, 20, 50].into_iter().enumerate() {
            if !is_third(&mut cases) {
                continue;
            }
            let integrator = [Method::Symplectic, Method::Verlet, Method::Rk4][i % 3].integrator();
            let scene = Scene { start: &start, constraints: &rope, substeps, integrator, ..Scene::EMPTY };
            let frames = often(3600) as u64;
            let [turned, grown, _] = flown(&scene, frames, &mut |_, _| ());
            // What is straight has no motion beside that of a rigid body from which it could pay for what rounding gives.
            let rounding = 4.0 * f64::from(f32::EPSILON) * (frames as f64 * f64::from(substeps)).sqrt();
            let case = format!("{links} links, {whirl} m/s, {compliance} m/N in {substeps}");
            assert!(turned < 1e-4, "{case}: {turned}");
            // The energy that soft links are strained by is counted where theirs is the question (`rope_energy`).
            assert!(compliance > 0.0 || grown < 1e-5 + rounding, "{case}: {grown}");
        }
    }
}

/// One particle of four is not finite, in its place or its velocity, or all are in one place, or links have no length: whoever is not finite dies and is
/// counted, and the others stay finite.
#[test]
fn what_is_not_finite_is_counted_and_harms_nobody() {
    let rope = |length: f32| Rope { closed: true, ..Rope::rigid([0u32, 1, 2, 3], [length]) };
    let rods = |length: f32| [0u32, 1, 2].map(|i| Distance::rod([i, i + 1], length));
    let (ropes, rods) = ([rope(0.1), rope(0.0)], [rods(0.1), rods(0.0)]);
    let cluster = ShapeMatching::rigid([0u32, 1, 2, 3]);
    let soft = ShapeMatching { compliance: 1e-3, ..cluster };
    let yielding = Rope { compliance: 1e-4, damping: 0.1, ..rope(0.1) };
    let strand =
        Strands::of([0u32, 1, 2, 3], [4], StrandParams { damping: 0.01, ..StrandParams::round(1e-3, 1e9, 0.3) });
    let params = ShellParams { stretch: [1e3; 2], shear: 3e2, bending: 1e-4, damping: 1e-3 };
    let triangles = [[0u32, 1, 2], [2, 1, 3]];
    let shell = Shell { particles: [0u32, 1, 2, 3], triangles, hinges: mesh_hinges(&triangles), warp: Vec3::X, params };
    let bonds: [&dyn Constraint; 9] =
        [&ropes[0], &ropes[1], &rods[0], &rods[1], &cluster, &soft, &yielding, &strand, &shell];
    for (i, bond) in bonds.into_iter().enumerate() {
        for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 0.0] {
            for (who, speed) in [(0, false), (1, true), (3, false)] {
                let mut start =
                    [0, 1, 2, 3].map(|i| Particle { position: Vec3::X * (0.1 * i as f32), ..Particle::REST });
                if bad == 0.0 {
                    start.iter_mut().for_each(|p| p.position = Vec3::ONE);
                } else if speed {
                    start[who].velocity = Vec3::new(0.0, bad, 0.0);
                } else {
                    start[who].position = Vec3::new(bad, 0.0, 0.0);
                }
                for (method, substeps) in [(Method::Symplectic, 1), (Method::Verlet, 5)] {
                    let parts = Scene { start: &start, forces: &DOWN, constraints: bond, ..Scene::EMPTY };
                    let scene = Scene { substeps, integrator: method.integrator(), ..parts };
                    let mut system = started(&scene, 4, 0);
                    run(&mut system, &scene, 1.0 / 60.0, 30);
                    let (there, died) = (system.particles(), system.totals().died);
                    let lost = u64::from(bad != 0.0);
                    assert_eq!((there.position.len() as u64, died.nonfinite), (4 - lost, lost), "{i} {bad} {who}");
                    assert!(there.position.iter().chain(there.velocity).all(|v| v.is_finite()), "{i} {bad} {who}");
                }
            }
        }
    }
}
