//! Clusters that keep their shape against the mechanics of rigid bodies: how they turn, fall, swing, tumble and rest.

use pointmass::force::Friction;
use pointmass::scene::SceneFile;
use pointmass::shape::Plane;
use pointmass::{
    ContactMaterial, Contacts, Drag, Gravity, Measures, Method, Particle, Scene, ShapeMatching, Time, Vec3,
};
use pointmass_tests::{Random, every, f64s, gap, often, run, started};

const G: f64 = 9.81;
pub(crate) const DOWN: Gravity = Gravity { acceleration: Vec3::new(0.0, -9.81, 0.0) };
pub(crate) const CUBE: [u32; 8] = [0, 1, 2, 3, 4, 5, 6, 7];

/// The corners of a box of given half sides about a place, turning and moving.
pub(crate) fn corners(at: Vec3, half: Vec3, omega: Vec3, velocity: Vec3, part: Particle) -> Vec<Particle> {
    let sign = |i: u32, axis: u32| if i >> axis & 1 == 1 { 1.0 } else { -1.0 };
    let corner = |i| {
        let r = Vec3::new(sign(i, 0), sign(i, 1), sign(i, 2)) * half;
        Particle { position: at + r, velocity: velocity + omega.cross(r), ..part }
    };
    (0..8).map(corner).collect()
}

/// Distances of all from all.
fn distances(x: &[Vec3]) -> Vec<f64> {
    x.iter().enumerate().flat_map(|(i, a)| x[..i].iter().map(move |b| gap(f64s(*a), f64s(*b)))).collect()
}

/// How far it is out of shape, a share of its greatest extent.
pub(crate) fn bent(start: &[Particle], x: &[Vec3]) -> f64 {
    let before = distances(&start.iter().map(|p| p.position).collect::<Vec<_>>());
    let greatest = before.iter().fold(0.0, |a: f64, &b| a.max(b));
    before.iter().zip(distances(x)).map(|(a, b)| (a - b).abs() / greatest).fold(0.0, f64::max)
}

fn middle(start: &[Particle], x: &[Vec3]) -> [f64; 3] {
    let mass: f64 = start.iter().map(|p| f64::from(p.mass)).sum();
    [0, 1, 2].map(|k| start.iter().zip(x).map(|(p, x)| f64::from(p.mass) * f64::from(x[k])).sum::<f64>() / mass)
}

pub(crate) fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn length(a: [f64; 3]) -> f64 {
    gap(a, [0.0; 3])
}

/// The axis of a symmetric top goes round its angular momentum at the rate L / I₁.
#[test]
fn a_symmetric_top_precesses_at_its_rate() {
    // Corners of a square prism: I₁ = I₂ = Σ m (y² + z²), and I₃ about its long side, z.
    let (half, mass) = (Vec3::new(0.1, 0.1, 0.3), 0.2);
    let [across, along] = [8.0 * 0.2 * (0.01 + 0.09), 8.0 * 0.2 * 0.02];
    let omega = Vec3::new(3.0, 0.0, 8.0);
    let spin = [across * 3.0, 0.0, along * 8.0f64];
    let l = length(spin);
    let start = corners(Vec3::ZERO, half, omega, Vec3::ZERO, Particle { mass, ..Particle::REST });
    let body = ShapeMatching::rigid(CUBE);
    for method in Method::ALL {
        let errors = [4, 8, 16].map(|substeps| {
            let integrator = method.integrator();
            let scene = Scene { start: &start, constraints: &body, substeps, integrator, ..Scene::EMPTY };
            let mut system = started(&scene, 8, 0);
            (1..=120).fold(0f64, |worst, frame| {
                system.step_to(&scene, Time::frame(frame, 60));
                let x = system.particles().position;
                let axis = f64s(x[4] - x[0]).map(|a| a / 0.6);
                // The axis turned about L by the angle L t / I₁ (Rodrigues).
                let (s, c) = (l / across * frame as f64 / 60.0).sin_cos();
                let n = spin.map(|a| a / l);
                let (turned, dot) = (cross(n, [0.0, 0.0, 1.0]), n[2]);
                let right = [0, 1, 2].map(|k| if k == 2 { c } else { 0.0 } + s * turned[k] + (1.0 - c) * dot * n[k]);
                worst.max(gap(axis, right))
            })
        });
        assert!(errors[0] < 0.01, "{method}: {errors:?}");
        assert!(errors[1] < 0.4 * errors[0] && errors[2] < 0.4 * errors[1] + 1e-5, "{method}: {errors:?}");
    }
}

/// Turning about its middle axis a body flips, as Euler's equations say; energy and angular momentum stay.
#[test]
fn a_body_turns_by_eulers_equations() {
    let half = [0.3f64, 0.2, 0.1];
    let square = half.map(|a| 8.0 * 0.1 * a * a);
    let inertia = [square[1] + square[2], square[0] + square[2], square[0] + square[1]];
    for omega in [[0.05, 4.0, 0.0], [3.0, 1.0, 2.0], [0.0, 0.3, 6.0]] {
        // By a Runge-Kutta method in double precision: ω in the body's frame and its three axes in the world.
        let rate = |w: [f64; 3]| {
            let [a, b, c] = inertia;
            [(b - c) / a * w[1] * w[2], (c - a) / b * w[2] * w[0], (a - b) / c * w[0] * w[1]]
        };
        let axes_rate = |w: [f64; 3], axes: [[f64; 3]; 3]| {
            let world = [0, 1, 2].map(|k| (0..3).map(|j| axes[j][k] * w[j]).sum::<f64>());
            axes.map(|axis| cross(world, axis))
        };
        let add = |a: [f64; 3], b: [f64; 3], h: f64| [0, 1, 2].map(|k| a[k] + h * b[k]);
        let (mut w, mut axes) = (omega, [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]);
        let (seconds, parts) = (4.0, 40_000);
        let h = seconds / f64::from(parts);
        for _ in 0..parts {
            let shift =
                |d: ([f64; 3], [[f64; 3]; 3]), h: f64| (add(w, d.0, h), [0, 1, 2].map(|k| add(axes[k], d.1[k], h)));
            let slope = |(w, axes)| (rate(w), axes_rate(w, axes));
            let a = slope((w, axes));
            let b = slope(shift(a, h / 2.0));
            let c = slope(shift(b, h / 2.0));
            let d = slope(shift(c, h));
            let mean = |a: f64, b: f64, c: f64, d: f64| (a + 2.0 * b + 2.0 * c + d) / 6.0;
            let dw = [0, 1, 2].map(|k| mean(a.0[k], b.0[k], c.0[k], d.0[k]));
            let da = [0, 1, 2].map(|i| [0, 1, 2].map(|k| mean(a.1[i][k], b.1[i][k], c.1[i][k], d.1[i][k])));
            (w, axes) = shift((dw, da), h);
        }
        let omega = Vec3::from_array(omega.map(|a| a as f32));
        let part = Particle { mass: 0.1, ..Particle::REST };
        let start = corners(Vec3::ZERO, Vec3::from_array(half.map(|a| a as f32)), omega, Vec3::ZERO, part);
        let body = ShapeMatching::rigid(CUBE);
        let errors = [5, 10, 20].map(|substeps| {
            let scene = Scene { start: &start, constraints: &body, substeps, ..Scene::EMPTY };
            let mut system = started(&scene, 8, 0);
            let before = Measures::of(&system, &scene);
            run(&mut system, &scene, 1.0 / 60.0, 240);
            let after = Measures::of(&system, &scene);
            let lost = (after.energy.kinetic / before.energy.kinetic - 1.0).abs();
            let turned = gap(after.angular_momentum, before.angular_momentum) / length(before.angular_momentum);
            // 4,800 sub-steps at the most, with their roundings.
            assert!(lost < 2e-4 && turned < 1e-4, "{omega} in {substeps}: {lost} {turned}");
            assert!(bent(&start, system.particles().position) < 2e-6);
            let corner = [0, 1, 2].map(|k| (0..3).map(|j| half[j] * axes[j][k]).sum::<f64>());
            gap(f64s(system.particles().position[7]), corner)
        });
        // Beside the flip's own sensitivity to rounding.
        assert!(errors[2] < 2e-3 && errors[1] < 0.35 * errors[0] + 1e-3, "{omega}: {errors:?}");
    }
}

#[test]
fn a_free_cluster_falls_as_a_point_does_and_keeps_its_momenta() {
    let mut random = Random::new(5);
    for (scale, far, compliance) in
        [(1.0f32, 0.0f32, 0.0f32), (1e-6, 0.0, 0.0), (2000.0, 0.0, 0.0), (1.0, 50.0, 0.0), (1.0, 0.0, 1e-3)]
    {
        let start: Vec<Particle> = (0..14)
            .map(|_| {
                let r = random.vector(0.5);
                let velocity = (Vec3::new(1.0, 2.0, -0.5) + Vec3::new(2.0, 1.0, 3.0).cross(r)) * scale;
                let mass = random.magnitude(0.02, 2.0) * scale;
                Particle { position: (r + Vec3::X * far) * scale, velocity, mass, ..Particle::REST }
            })
            .collect();
        let body = ShapeMatching {
            compliance: compliance / scale,
            damping: 0.1,
            ..ShapeMatching::rigid((0..14).collect::<Vec<u32>>())
        };
        let mass: f64 = start.iter().map(|p| f64::from(p.mass)).sum();
        for method in Method::ALL {
            let integrator = method.integrator();
            let free = Scene { start: &start, constraints: &body, substeps: 16, integrator, ..Scene::EMPTY };
            let mut system = started(&free, 14, 0);
            let before = Measures::of(&system, &free);
            let from = middle(&start, system.particles().position);
            run(&mut system, &free, 1.0 / 60.0, 120);
            let after = Measures::of(&system, &free);
            let scale = f64::from(scale);
            let slow = gap(before.momentum, after.momentum) / length(before.momentum);
            assert!(slow < 1e-4, "{method} at {scale} m: {slow}");
            let to = middle(&start, system.particles().position);
            let spin = |m: &Measures, c: [f64; 3]| {
                let orbit = cross(c, m.momentum);
                [0, 1, 2].map(|k| m.angular_momentum[k] - orbit[k])
            };
            let turned = gap(spin(&before, from), spin(&after, to)) / length(spin(&before, from));
            assert!(turned < 2e-4 * f64::from(1.0 + far), "{method} at {scale} m, {far}: {turned}");
            // The middle goes where a point goes.
            let way = gap(to, [0, 1, 2].map(|k| from[k] + 2.0 * before.momentum[k] / mass)) / scale;
            assert!(way < 1e-4 * f64::from(1.0 + far), "{method} at {scale} m: {way}");
            if compliance == 0.0 {
                let rounding = 1e-5 + 3.0 * f64::from(f32::EPSILON * far);
                assert!(bent(&start, system.particles().position) < rounding, "{method} at {scale} m");
            }
        }
        // And falls as one falls.
        let heavy = Gravity { acceleration: Vec3::NEG_Y * scale };
        let point = [Particle {
            position: start[0].position,
            velocity: Vec3::from_array(middle_velocity(&start)),
            ..Particle::REST
        }];
        for method in Method::ALL {
            let integrator = method.integrator();
            let scene =
                Scene { start: &start, forces: &heavy, constraints: &body, substeps: 16, integrator, ..Scene::EMPTY };
            let alone = Scene { start: &point, constraints: &(), ..scene };
            let [mut a, mut b] = [started(&scene, 14, 0), started(&alone, 1, 0)];
            let from = middle(&start, a.particles().position);
            run(&mut a, &scene, 1.0 / 60.0, 60);
            run(&mut b, &alone, 1.0 / 60.0, 60);
            let to = middle(&start, a.particles().position);
            let fallen = f64s(b.particles().position[0] - start[0].position);
            let off = gap([0, 1, 2].map(|k| to[k] - from[k]), fallen) / f64::from(scale);
            assert!(off < 1e-4 * f64::from(1.0 + far), "{method} at {scale} m: {off}");
        }
    }
}

fn middle_velocity(start: &[Particle]) -> [f32; 3] {
    let mass: f64 = start.iter().map(|p| f64::from(p.mass)).sum();
    [0, 1, 2].map(|k| (start.iter().map(|p| f64::from(p.mass) * f64::from(p.velocity[k])).sum::<f64>() / mass) as f32)
}

/// About one or two that are fixed it swings in the time of a physical pendulum; three hold it.
#[test]
fn who_is_fixed_is_a_pivot() {
    // A board that hangs by its upper edge: I = Σ m r² about the edge, at a distance d of the middle of those that move.
    let at =
        |x: f32, y: f32, fixed: bool| Particle { position: Vec3::new(x, y, 0.0), fixed, mass: 0.3, ..Particle::REST };
    let tilt = 0.05f32;
    let hang = |parts: &[(f32, f32, bool)]| -> Vec<Particle> {
        let turn = |p: Particle| {
            let (s, c) = tilt.sin_cos();
            Particle { position: Vec3::new(p.position.x, p.position.y * c, -p.position.y * s), ..p }
        };
        parts.iter().map(|&(x, y, fixed)| turn(at(x, y, fixed))).collect()
    };
    let cases = [
        hang(&[(0.0, 0.0, true), (0.0, -0.5, false), (0.0, -1.0, false)]),
        hang(&[(-0.5, 0.0, true), (0.5, 0.0, true), (-0.5, -0.5, false), (0.5, -0.5, false), (0.0, -1.0, false)]),
    ];
    for start in cases {
        let free: Vec<f64> = start
            .iter()
            .filter(|p| !p.fixed)
            .map(|p| f64::from(p.position.length_squared() - p.position.x * p.position.x))
            .collect();
        let (moment, first) = (free.iter().sum::<f64>(), free.iter().map(|r| r.sqrt()).sum::<f64>());
        let omega = (G * first / moment).sqrt() * (1.0 - f64::from(tilt * tilt) / 16.0);
        let numbers: Vec<u32> = (0..start.len() as u32).collect();
        let body = ShapeMatching::rigid(numbers);
        for method in [Method::Symplectic, Method::Verlet, Method::Rk4] {
            let integrator = method.integrator();
            let scene =
                Scene { start: &start, forces: &DOWN, constraints: &body, substeps: 20, integrator, ..Scene::EMPTY };
            let mut system = started(&scene, start.len(), 0);
            let last = start.len() - 1;
            for frame in 1..=180 {
                system.step_to(&scene, Time::frame(frame, 60));
                let x = system.particles().position;
                let right = f64::from(start[last].position.z) * (omega * frame as f64 / 60.0).cos();
                assert!((f64::from(x[last].z) - right).abs() < 1e-3, "{method} {frame}: {} for {right}", x[last].z);
                for (x, p) in x.iter().zip(&start).filter(|(_, p)| p.fixed) {
                    assert_eq!(*x, p.position);
                }
                assert!(bent(&start, x) < 1e-4, "{method} {frame}: {}", bent(&start, x));
            }
        }
    }
    let mut start = corners(Vec3::ZERO, Vec3::splat(0.2), Vec3::ZERO, Vec3::ZERO, Particle::REST);
    for corner in [0, 1, 2] {
        start[corner].fixed = true;
    }
    let body = ShapeMatching::rigid(CUBE);
    let scene = Scene { start: &start, forces: &DOWN, constraints: &body, substeps: 10, ..Scene::EMPTY };
    let mut system = started(&scene, 8, 0);
    run(&mut system, &scene, 1.0 / 60.0, 300);
    for (x, p) in system.particles().position.iter().zip(&start) {
        assert!(x.distance(p.position) < 1e-3, "{x} for {}", p.position);
    }
}

/// Held by four corners, the others hang lower by α M g, whatever the sub-steps and however they share the mass.
#[test]
fn a_soft_cluster_gives_way_by_its_compliance() {
    let part = Particle { drag: 0.3, ..Particle::REST };
    let mut start = corners(Vec3::ZERO, Vec3::splat(0.5), Vec3::ZERO, Vec3::ZERO, part);
    for (i, corner) in start.iter_mut().enumerate() {
        corner.fixed = i < 4;
        corner.mass = [0.2, 0.5, 1.0, 0.1][i % 4];
    }
    let longer = |compliance: f32| f64::from(compliance) * 1.8 * G;
    for (compliance, substeps, damping) in
        [(1e-3f32, 5, 1.0f32), (1e-3, 20, 0.0), (0.01, 50, 2.0), (1e-5, 10, 0.0)].into_iter().step_by(every(3))
    {
        let body = ShapeMatching { compliance, damping, ..ShapeMatching::rigid(CUBE) };
        let forces = (DOWN, Drag {});
        let scene = Scene { start: &start, forces: &forces, constraints: &body, substeps, ..Scene::EMPTY };
        let mut system = started(&scene, 8, 0);
        run(&mut system, &scene, 1.0 / 60.0, 1500);
        for (p, x) in start.iter().zip(system.particles().position).filter(|(p, _)| !p.fixed) {
            let fallen = f64::from(p.position.y - x.y);
            assert!((fallen / longer(compliance) - 1.0).abs() < 0.01, "{compliance} in {substeps}: {fallen}");
        }
    }
}

#[test]
fn nothing_breaks_a_cluster() {
    let at = |x: f32, y: f32, z: f32| Particle {
        position: Vec3::new(x, y, z),
        velocity: Vec3::new(y, z, x),
        ..Particle::REST
    };
    let brief = |p: Particle| Particle { lifetime: 0.2, ..p };
    let fixed = |p: Particle| Particle { fixed: true, velocity: Vec3::ZERO, ..p };
    let starts: [Vec<Particle>; 9] = [
        vec![at(1.0, 2.0, 3.0)],
        vec![at(0.0, 0.0, 0.0), at(1.0, 0.0, 0.0)],
        vec![at(0.0, 0.0, 0.0), at(1.0, 0.0, 0.0), at(2.5, 0.0, 0.0)],
        vec![at(0.0, 1e-4, 0.0), at(1.0, 0.0, 0.0), at(2.5, 0.0, 0.0), at(3.0, 0.0, -1e-4)],
        vec![at(0.0, 0.0, 0.0), at(1.0, 0.0, 0.0), at(0.0, 1.0, 0.0), at(1.3, 1.0, 0.0)],
        vec![at(0.0, 0.0, 0.0); 4],
        vec![at(0.0, 0.0, 0.0), brief(at(1.0, 0.0, 0.0)), at(0.0, 1.0, 0.0), brief(at(0.0, 0.0, 1.0))],
        vec![fixed(at(0.0, 0.0, 0.0)), fixed(at(1.0, 0.0, 0.0)), brief(at(0.0, 1.0, 0.0))],
        vec![
            Particle { mass: 1e-9, ..at(0.0, 0.0, 0.0) },
            Particle { mass: 1e9, ..at(1.0, 0.0, 0.0) },
            at(0.0, 1.0, 1.0),
        ],
    ];
    for start in &starts {
        let numbers: Vec<u32> = (0..start.len() as u32).collect();
        for (compliance, damping) in [(0.0, 0.0), (1e-3, 0.5)] {
            let body = ShapeMatching { compliance, damping, ..ShapeMatching::rigid(numbers.clone()) };
            for method in Method::ALL {
                for substeps in [1, 12] {
                    let integrator = method.integrator();
                    let scene = Scene { start, constraints: &body, substeps, integrator, ..Scene::EMPTY };
                    let mut system = started(&scene, start.len(), 0);
                    let before = Measures::of(&system, &scene);
                    run(&mut system, &scene, 1.0 / 60.0, 60);
                    let there = system.particles();
                    assert_eq!(system.totals().died.nonfinite, 0);
                    for (x, v) in there.position.iter().zip(there.velocity) {
                        assert!(x.is_finite() && v.length() < 10.0, "{start:?} {method}: {x} {v}");
                    }
                    if there.position.len() == start.len() && !start[0].fixed {
                        let off = gap(Measures::of(&system, &scene).momentum, before.momentum);
                        let sum: f64 = start.iter().map(|p| f64::from(p.mass)).sum();
                        assert!(off < 1e-4 * sum, "{start:?} {method}: {off}");
                    }
                }
            }
        }
    }
    let start = [at(0.0, 0.0, 0.0), at(1.0, 0.0, 0.0)];
    for particles in [&[][..], &[0], &[7, 8], &[0, u32::MAX], &[1, 1, 1]] {
        let scene = Scene { start: &start, constraints: &ShapeMatching::rigid(particles), ..Scene::EMPTY };
        let mut system = started(&scene, 2, 0);
        run(&mut system, &scene, 1.0 / 60.0, 30);
        assert!(system.particles().position.iter().all(|x| x.is_finite()));
    }
}

/// Turned by any angle in a step, and knocked out of shape: it is rigid again after each.
#[test]
fn it_is_rigid_however_fast_it_turns() {
    let mut random = Random::new(11);
    for speed in [1.0f32, 50.0, 400.0, 3000.0] {
        for _ in 0..often(20) {
            let half = Vec3::new(random.between(0.02, 0.3), random.between(0.02, 0.3), random.between(0.02, 0.3));
            let mut start = corners(Vec3::ZERO, half, random.direction() * speed, Vec3::ZERO, Particle::REST);
            start.iter_mut().for_each(|p| p.velocity += random.vector(0.1 * speed));
            let body = ShapeMatching::rigid(CUBE);
            let scene = Scene { start: &start, constraints: &body, substeps: 2, ..Scene::EMPTY };
            let mut system = started(&scene, 8, 0);
            let before = Measures::of(&system, &scene);
            run(&mut system, &scene, 1.0 / 60.0, 30);
            let after = Measures::of(&system, &scene);
            assert!(bent(&start, system.particles().position) < 2e-5, "{speed}");
            assert!(after.energy.kinetic < 1.001 * before.energy.kinetic, "{speed}");
            let turned = gap(after.angular_momentum, before.angular_momentum) / length(before.angular_momentum);
            assert!(turned < 1e-4 + 1e-6 * f64::from(speed), "{speed}: {turned}");
        }
    }
}

/// Dice of eight balls, thrown on the ground: they tumble, and come to rest with no ball in the ground.
#[test]
fn dice_come_to_rest_on_the_ground() {
    let ground = Plane { point: Vec3::ZERO, normal: Vec3::Y };
    let mut random = Random::new(3);
    for (method, substeps) in
        [(Method::Symplectic, 20), (Method::Verlet, 30), (Method::Rk4, 20), (Method::Implicit, 40)]
            .into_iter()
            .step_by(every(2))
    {
        let (mut start, mut dice) = (Vec::new(), Vec::new());
        for i in 0..3u32 {
            let part = Particle { radius: 0.05, mass: 0.02, elasticity: 0.3, material: Some(0), ..Particle::REST };
            let place = Vec3::new(0.6 * i as f32, 0.7, 0.0);
            let velocity = Vec3::new(0.5, -1.0, 0.3);
            start.extend(corners(place, Vec3::splat(0.07), random.direction() * 9.0, velocity, part));
            dice.push(ShapeMatching::rigid(CUBE.map(|corner| 8 * i + corner)));
        }
        let forces = (DOWN, Drag {});
        for particle in &mut start {
            particle.drag = 0.002;
        }
        let constraints = (dice.as_slice(), Contacts::HARD);
        let integrator = method.integrator();
        let materials = [ContactMaterial { elasticity: None, friction: Some(Friction { static_: 0.5, kinetic: 0.4 }) }];
        let parts = Scene { start: &start, forces: &forces, colliders: &ground, materials: &materials, ..Scene::EMPTY };
        let scene = Scene { constraints: &constraints, substeps, integrator, ..parts };
        let mut system = started(&scene, start.len(), 0);
        for frame in 1..=480 {
            system.step_to(&scene, Time::frame(frame, 60));
            let there = system.particles();
            for x in there.position {
                assert!(x.y > 0.05 - 1e-3, "{method}, frame {frame}: {x}");
            }
            for die in 0..3 {
                let rows = 8 * die..8 * die + 8;
                // Who hits the ground hands the blow on within some eight sub-steps.
                let bent = bent(&start[rows.clone()], &there.position[rows]);
                assert!(bent < 0.15, "{method}, frame {frame}: {bent}");
            }
        }
        let fastest = system.particles().velocity.iter().map(|v| v.length()).fold(0.0, f32::max);
        assert!(fastest < 0.05, "{method}: {fastest} m/s");
        // On a side of theirs: four balls on the ground, four above them.
        for die in 0..3 {
            let low = system.particles().position[8 * die..8 * die + 8].iter().filter(|x| x.y < 0.06).count();
            assert_eq!(low, 4, "{method}");
        }
    }
}

#[test]
fn files_name_clusters_and_say_what_is_wrong_with_them() {
    let file = |cluster: &str| {
        let particles = r#"[{"position": [0, 0, 0]}, {"position": [1, 0, 0]}, {"position": [2, 0, 0]}]"#;
        SceneFile::from_json(
            "it",
            &format!(r#"{{"particles": {particles}, "constraints": [{{"cluster": {cluster}}}]}}"#),
        )
        .and_then(|scene| scene.check().map(|()| scene))
    };
    let sound =
        file(r#"{"particles": [0, 1, 2], "compliance": 1e-4, "damping": 2}"#).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(SceneFile::from_json("again", &sound.to_json()), Ok(sound));
    for (cluster, what) in [
        (r#"{"particles": [0]}"#, "constraints[0].cluster.particles"),
        (r#"{"particles": [0, 1, 0]}"#, "twice"),
        (r#"{"particles": [0, 3]}"#, "particle 3 is out of range"),
        (r#"{"particles": [0, 1], "compliance": -1}"#, "m/N"),
        (r#"{"particles": [0, 1], "damping": -1}"#, "N s/m"),
        (r#"{"particles": [0, 1], "stiffness": 1}"#, "stiffness"),
    ] {
        let error = file(cluster).expect_err(cluster).to_string();
        assert!(error.contains(what), "{cluster}: {error}");
    }
}
