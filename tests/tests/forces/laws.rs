//! The laws one by one.

use super::{UNIT, cloud, forces, sink, time_to};
use pointmass::shape::Sphere;
use pointmass::{
    Drag, Force, Gravity, Heap, Measures, Method, MutualGravity, Particle, QuadraticDrag, Scene, Spring, System, Time,
    Vec3,
};
use pointmass_tests::{Form, f64s, gap, often, point, run, started};

#[test]
fn linear_drag_and_its_landing() {
    let start = [Particle { velocity: Vec3::new(20.0, 30.0, 0.0), mass: 2.0, drag: 0.5, ..Particle::REST }];
    let forces = (Gravity::EARTH, Drag {});
    for (method, steps, tolerance) in
        [(Method::Rk4, 120, 2e-4), (Method::Verlet, 480, 4e-4), (Method::Midpoint, 480, 4e-4)]
    {
        let scene = Scene { start: &start, forces: &forces, integrator: method.integrator(), ..Scene::EMPTY };
        for (end, place) in
            [(2.0, [31.477_547_223, 30.500_978_529, 0.0]), (5.073_484_922_5, [57.496_847_645_1, 0.0, 0.0])]
        {
            let mut system = started(&scene, 1, 0);
            run(&mut system, &scene, end / f64::from(steps), steps);
            // Rounding: hundreds of steps of half an ulp of 32 or 64 m (2e-6) each, as a random walk with room; the
            // methods of order 2 add h² k²/m² v t / 12 or so.
            let off = gap(f64s(system.particles().position[0]), place);
            assert!(off < tolerance, "{method} at {end} s: {off}");
        }
    }
    // A plane stops it there: it lies still in y after the landing and goes on in x with the speed it has.
    let floor = pointmass::shape::Plane { point: Vec3::ZERO, normal: Vec3::Y };
    let start = start.map(|p| Particle { elasticity: 0.0, ..p });
    let rk4 = Method::Rk4.integrator();
    let scene = Scene { start: &start, forces: &forces, colliders: &floor, integrator: rk4, ..Scene::EMPTY };
    let mut system = started(&scene, 1, 0);
    run(&mut system, &scene, 1.0 / 60.0, 300);
    assert_eq!(system.totals().hits, 0);
    run_on(&mut system, &scene, 60);
    assert!(system.totals().hits > 0);
    let p = system.particles();
    // v decays as e^(−t/4) whether it flies or slides, so x goes on as 80 (1 − e^(−t/4)).
    let x = 80.0 * (1.0 - (-6.0f64 / 4.0).exp());
    assert!((f64::from(p.position[0].x) - x).abs() < 1e-3 && p.position[0].y.abs() < 1e-4, "{:?}", p.position[0]);
}

/// Another `frames` of 60 per second.
fn run_on(system: &mut System<Heap>, scene: &Scene<'_>, frames: u64) {
    let first = (system.time().seconds_f64() * 60.0).round() as u64;
    for i in 1..=frames {
        system.step(scene, Time::frame(first + i, 60) - system.time());
    }
}

#[test]
fn a_sink_pulls_by_its_law_whatever_the_mass() {
    let start = [0.5, 50.0].map(|mass| Particle { position: Vec3::new(0.0, 0.0, 2.0), mass, ..Particle::REST });
    let scene = Scene { start: &start, ..Scene::EMPTY };
    let system = started(&scene, 2, 0);
    for force in forces(&system, &scene, &sink(point(Vec3::ZERO))) {
        assert!((force - Vec3::NEG_Z * (10.0 / 3.0)).length() < 1e-6);
    }
    // From the surface of a sphere: 1 m within one of radius 3, and 1.5 m outside one of radius 0.5.
    for (radius, f) in [(3.0, 10.0 / 1.75), (0.5, -10.0 / (1.0 + 0.75 + 0.5625))] {
        let sphere = Form::Sphere(Sphere { center: Vec3::ZERO, radius });
        for force in forces(&system, &scene, &sink(sphere)) {
            assert!((force - Vec3::Z * f).length() < 1e-6, "{force}");
        }
    }
    // At the surface it has no direction.
    let sphere = Form::Sphere(Sphere { center: Vec3::ZERO, radius: 2.0 });
    assert_eq!(forces(&system, &scene, &sink(sphere)), [Vec3::ZERO; 2]);
}

#[test]
fn a_sink_s_circular_orbit() {
    let v = 3.651_483_7;
    let start = [Particle { position: Vec3::X * 2.0, velocity: Vec3::Y * v, mass: 0.5, ..Particle::REST }];
    let sink = sink(point(Vec3::ZERO));
    for (method, tolerance) in [(Method::Rk4, 2e-5), (Method::Verlet, 1e-3)] {
        let scene = Scene { start: &start, forces: &sink, integrator: method.integrator(), ..Scene::EMPTY };
        let mut system = started(&scene, 1, 0);
        let energy = Measures::of(&system, &scene).energy.total();
        for i in 0..often(1200) {
            system.step(&scene, Time::frame(i as u64 + 1, 120) - system.time());
            // Verlet errs by about (h ω)² / 8 = 3e-5 of radius and energy; RK4 by rounding only.
            let r = f64::from(system.particles().position[0].length());
            assert!((r - 2.0).abs() < tolerance, "{method}: {r}");
        }
        let after = Measures::of(&system, &scene).energy.total();
        assert!((after / energy - 1.0).abs() < tolerance, "{method}: {energy} becomes {after}");
    }
}

#[test]
fn a_fall_into_a_sink() {
    let at = |x: f32, fixed| Particle { position: Vec3::X * x, mass: 0.5, fixed, ..Particle::REST };
    let (start, sink) = ([at(5.0, false), at(0.0, true)], sink(point(Vec3::ZERO)));
    let scene = Scene { start: &start, forces: &sink, integrator: Method::Rk4.integrator(), ..Scene::EMPTY };
    let t = time_to(&scene, 1e-3, 1.0);
    // 1753 steps of half an ulp of 4 m at speeds of a few m/s.
    assert!((t - 1.752_789_579_7).abs() < 2e-5, "{t}");
}

#[test]
fn two_kilograms_fall_together() {
    let start = [-0.5, 0.5].map(|x| Particle { position: Vec3::X * x, ..Particle::REST });
    let integrator = Method::Rk4.integrator();
    let scene = Scene { start: &start, forces: &MutualGravity::NEWTON, integrator, ..Scene::EMPTY };
    // Steps of 400 s: in shorter ones the first ways, ½ a h², would vanish in the rounding of 0.5 m. At the end the
    // bodies close in at 2.3e-5 m/s, so that 1e-6 m of rounding is 0.05 s; and they come from rest, where it is more.
    let t = time_to(&scene, 400.0, 0.5);
    assert!((t / 78_669.333_044 - 1.0).abs() < 1e-5, "{t}");
    // The same in units in which G is 1: the time scales with √G.
    let scene = Scene { forces: &UNIT, ..scene };
    let t = time_to(&scene, 1e-3, 0.5);
    assert!((t / (78_669.333_044 * 6.674_28e-11f64.sqrt()) - 1.0).abs() < 1e-5, "{t}");
}

#[test]
fn two_bodies_on_an_ellipse_return() {
    // Masses 3 and 1, G = 1, semi-major axis 1, eccentricity 0.5: period π. They start farthest apart, at 1.5.
    let v = (4.0f32 * (2.0 / 1.5 - 1.0)).sqrt();
    let body = |mass, x, y| Particle { position: Vec3::X * x, velocity: Vec3::Y * y, mass, ..Particle::REST };
    let start = [body(3.0, 0.375, 0.25 * v), body(1.0, -1.125, -0.75 * v)];
    let scene = Scene { start: &start, forces: &UNIT, integrator: Method::Rk4.integrator(), ..Scene::EMPTY };
    let mut system = started(&scene, 2, 0);
    let before = Measures::of(&system, &scene);
    assert!((before.energy.total() + 3.0 / 2.0).abs() < 1e-6, "−G m M / 2a");
    let n = 2000;
    run(&mut system, &scene, core::f64::consts::PI / f64::from(n), n);
    let after = Measures::of(&system, &scene);
    for (row, p) in start.iter().enumerate() {
        assert!((system.particles().position[row] - p.position).length() < 1e-5);
    }
    // 2000 steps of rounding in 6e-8 of values about 1, as a random walk 3e-6.
    assert!((after.energy.total() - before.energy.total()).abs() < 1e-5);
    assert!(gap(after.angular_momentum, before.angular_momentum) < 1e-5);
}

#[test]
fn mutual_gravity_is_the_direct_sum() {
    for n in [2, 7, 8, 9, 63, 100] {
        let start = cloud(n);
        let scene = Scene { start: &start, ..Scene::EMPTY };
        let system = started(&scene, n, 0);
        for (constant, softening) in [(1.0, 0.0), (6.674_28e-11, 0.0), (1.0, 0.05)] {
            let law = MutualGravity { constant, softening, ..MutualGravity::NEWTON };
            for (i, force) in forces(&system, &scene, &law).into_iter().enumerate() {
                let (mut sum, mut size) = ([0.0; 3], 0.0);
                for other in &start {
                    let d: [f64; 3] = core::array::from_fn(|k| f64s(other.position)[k] - f64s(start[i].position)[k]);
                    let r2 = d.iter().map(|d| d * d).sum::<f64>() + f64::from(softening).powi(2);
                    if gap(d, [0.0; 3]) > 0.0 {
                        let w = f64::from(constant) * f64::from(start[i].mass) * f64::from(other.mass) / r2.powf(1.5);
                        (0..3).for_each(|k| sum[k] += w * d[k]);
                        size += w * gap(d, [0.0; 3]);
                    }
                }
                // Some ten roundings of each term, and those of the sum: 20 ulps of the sum of magnitudes.
                assert!(gap(f64s(force), sum) <= 20.0 * 6e-8 * size, "{n}, row {i}: {force} {sum:?}");
            }
        }
    }
}

#[test]
fn particles_that_coincide_do_not_act_on_each_other() {
    for softening in [0.0, 0.1] {
        let law = MutualGravity { constant: 1.0, softening, ..MutualGravity::NEWTON };
        let here = Particle { position: Vec3::new(0.1, 0.2, 0.3), ..Particle::REST };
        let start = [here; 9];
        let scene = Scene { start: &start, forces: &law, ..Scene::EMPTY };
        let mut system = started(&scene, 9, 0);
        assert_eq!(forces(&system, &scene, &law), [Vec3::ZERO; 9]);
        run(&mut system, &scene, 0.1, 10);
        assert!(system.particles().position.iter().all(|&x| x == here.position));
    }
}

#[test]
fn forces_of_pairs_conserve_momentum() {
    let mut start = cloud(50);
    start[49].fixed = false;
    let springs: Vec<Spring> =
        (0..120).map(|i| Spring::new([i % 50, (i * 7 + 3) % 50], 0.5, 20.0).damped(0.5)).collect();
    let law = MutualGravity { constant: 0.05, softening: 0.1, ..MutualGravity::NEWTON };
    for &method in Method::ALL {
        for (forces, springs) in [(&law as &dyn Force, &[][..]), (&() as &dyn Force, &springs)] {
            let scene =
                Scene { start: &start, springs: &springs, forces, integrator: method.integrator(), ..Scene::EMPTY };
            let mut system = started(&scene, 50, 0);
            let before = Measures::of(&system, &scene);
            run(&mut system, &scene, 1.0 / 120.0, 240);
            let after = Measures::of(&system, &scene);
            let size: f64 = (0..50)
                .map(|i| {
                    let p = system.particles();
                    f64::from(p.mass[i] * p.velocity[i].length())
                })
                .sum();
            // Each step rounds every velocity by up to 6e-8 of it: 240 of them, as a random walk; solving adds up more.
            let off = gap(before.momentum, after.momentum) / size;
            let bound = if method == Method::Implicit { 1e-5 } else { 1e-6 };
            assert!(off < bound, "{method}: {off} of all momentum");
            // Forces along the line between two bodies leave it alone, where kicks and drifts take turns.
            if matches!(method, Method::Symplectic | Method::Verlet) {
                let off = gap(before.angular_momentum, after.angular_momentum) / size;
                assert!(off < 1e-6, "{method}: {off} of all angular momentum");
            }
        }
    }
}

#[test]
fn two_equal_bodies_mirror_each_other_to_the_bit() {
    let body = |s: f32| Particle {
        position: Vec3::new(0.3, 0.7, -0.2) * s,
        velocity: Vec3::new(0.5, -0.1, 0.3) * s,
        ..Particle::REST
    };
    let start = [body(1.0), body(-1.0)];
    let springs = [Spring::new([0, 1], 1.0, 7.3).damped(0.3)];
    for &method in Method::ALL {
        let scene =
            Scene { start: &start, springs: &springs, forces: &UNIT, integrator: method.integrator(), ..Scene::EMPTY };
        let mut system = started(&scene, 2, 0);
        run(&mut system, &scene, 0.01, 500);
        let p = system.particles();
        assert_eq!((p.position[0], p.velocity[0]), (-p.position[1], -p.velocity[1]), "{method}");
        assert_eq!(Measures::of(&system, &scene).momentum, [0.0; 3]);
    }
}

#[test]
fn quadratic_drag_and_the_speed_it_ends_with() {
    let start = [Particle { mass: 0.1, ..Particle::REST }];
    let forces = (Gravity::EARTH, QuadraticDrag { coefficient: 0.02 });
    for (method, steps, tolerance) in
        [(Method::Rk4, 200, 3e-6), (Method::Verlet, 1000, 2e-5), (Method::Implicit, 8000, 5e-4)]
    {
        let scene = Scene { start: &start, forces: &forces, integrator: method.integrator(), ..Scene::EMPTY };
        let mut system = started(&scene, 1, 0);
        run(&mut system, &scene, 2.0 / f64::from(steps), steps);
        // Half an ulp of 7 m/s is 2.4e-7; Verlet errs by about h²/12 of it, implicit Euler by h/2.
        let v = f64::from(system.particles().velocity[0].y);
        assert!((v + 6.950_875_305_7).abs() < tolerance, "{method}: {v}");
        run_on(&mut system, &scene, 600);
        let v = f64::from(system.particles().velocity[0].y);
        // It stays where what a step adds, h 2 k/m |v| times what is missing, is half an ulp: 5e-6 off.
        assert!((v + 7.002_374_597_2).abs() < 1e-5, "{method}: {v}");
    }
}

#[test]
fn a_softened_sink_has_no_jump_at_its_surface() {
    let soft = pointmass::Sink { softening: 0.1, ..sink(point(Vec3::ZERO)) };
    let start = [0.0f32, 1e-4, 0.1, 3.0].map(|x| Particle { position: Vec3::X * x, ..Particle::REST });
    let scene = Scene { start: &start, ..Scene::EMPTY };
    let system = started(&scene, 4, 0);
    let pulls = forces(&system, &scene, &soft);
    for (p, pull) in start.iter().zip(&pulls) {
        let (x, d) = (f64::from(p.position.x), f64::from(p.position.x).hypot(0.1));
        let law = -10.0 / (1.0 + 0.5 * d + 0.25 * d * d) * x / d;
        assert!((f64::from(pull.x) - law).abs() < 1e-5, "{x}: {pull} {law}");
    }
    assert_eq!(pulls[0], Vec3::ZERO);
    // It swings through the point, without losing energy.
    let start = [Particle { position: Vec3::X, ..Particle::REST }];
    let scene = Scene { start: &start, forces: &soft, integrator: Method::Rk4.integrator(), ..Scene::EMPTY };
    let mut system = started(&scene, 1, 0);
    let before = Measures::of(&system, &scene).energy.total();
    run(&mut system, &scene, 1e-3, 5000);
    let after = Measures::of(&system, &scene).energy.total();
    // 5000 roundings of speeds of 4 m/s, and h⁴ of what bends within 0.1 m.
    assert!((after / before - 1.0).abs() < 1e-4, "{before} becomes {after}");
}
