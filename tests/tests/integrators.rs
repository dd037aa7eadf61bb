//! The five methods against their theory: stability, values, order, energy.

use pointmass::{
    Adaptive, Drag, Embedded, Euler, Gravity, Implicit, Integrator, LectureMidpoint, Measures, Method, Midpoint,
    Particle, Rk4, Scene, Symplectic, Vec3, Verlet,
};
use pointmass_tests::{G, Law, follow, often, order, run, started};

/// The largest of some thousand steps' amplitudes near the end over the largest near the beginning.
fn growth(method: Method, stiffness: f32, damping: f32, h: f64) -> f64 {
    let n = 2000;
    let law = Law(move |_, x: f32, v: f32| -stiffness * x - damping * v);
    let start = [Particle { position: Vec3::X, ..Particle::REST }];
    let scene = Scene { start: &start, forces: &law, integrator: method.integrator(), ..Scene::EMPTY };
    let mut system = started(&scene, 1, 0);
    let mut largest = |from: u32, to: u32| {
        let mut largest = 0f64;
        for i in from..to {
            let next = pointmass::Time::from_seconds_f64(h * f64::from(i + 1));
            system.step(&scene, next - system.time());
            let p = system.particles();
            let Some(x) = p.position.first() else { return f64::INFINITY };
            largest = largest.max(f64::from(x.x).hypot(f64::from(p.velocity[0].x)));
        }
        largest
    };
    let early = largest(0, 200);
    let _between = largest(200, n - 200);
    largest(n - 200, n) / early
}

/// The largest stable step, between `low` and `high`, by bisection to one in ten thousand.
fn largest_step(low: f64, high: f64, stable: impl Fn(f64) -> bool) -> f64 {
    let (mut low, mut high) = (low, high);
    while high - low > 1e-4 * high {
        let middle = 0.5 * (low + high);
        if stable(middle) { low = middle } else { high = middle }
    }
    low
}

#[test]
fn largest_step_of_pure_decay() {
    // y' = λ y is drag, y being the speed. All but RK4 are 1 + z + z²/2 or 1 + z there.
    for (method, expected) in [
        (Method::Euler, 2.0),
        (Method::Symplectic, 2.0),
        (Method::Midpoint, 2.0),
        (Method::Verlet, 2.0),
        (Method::Rk4, 2.785_293_563_4),
    ] {
        // A thousand steps tell |R| = 1 ± 1e-3, which is ± 1e-3 in h λ.
        let h = largest_step(1.0, 4.0, |h| follow(method, &Drag {}, [0.0, 1.0], h, 2000)[1].abs() < 1.0);
        assert!((h - expected).abs() < 2e-3, "{method}: {h}");
    }
}

#[test]
fn largest_step_of_an_undamped_oscillation() {
    for (method, expected) in [(Method::Symplectic, 2.0), (Method::Verlet, 2.0), (Method::Rk4, 8f64.sqrt())] {
        let h = largest_step(1.0, 4.0, |h| growth(method, 1.0, 0.0, h) < 1.5);
        assert!((h - expected).abs() < 2e-3, "{method}: {h}");
    }
    // h ω counts, whatever ω is.
    assert!(growth(Method::Verlet, 100.0, 0.0, 0.199) < 1.5 && growth(Method::Verlet, 100.0, 0.0, 0.201) > 1.5);
}

#[test]
fn explicit_euler_and_midpoint_always_grow_by_their_closed_forms() {
    // Per step |R|² = 1 + z² and 1 + z⁴/4; f32 rounding adds at most 6e-8 per step to a relative 1.
    for (method, square) in
        [(Method::Euler, (|z: f64| 1.0 + z * z) as fn(f64) -> f64), (Method::Midpoint, |z: f64| 1.0 + z.powi(4) / 4.0)]
    {
        for (h, n) in [(0.1, 1000), (0.05, 2000), (0.02, 20_000)] {
            let [x, v] = follow(method, &Law(|_, x: f32, _| -x), [1.0, 0.0], h, n);
            let expected = (f64::from(n) * square(h).ln() / 2.0).exp();
            let relative = x.hypot(v) / expected - 1.0;
            assert!(relative.abs() < 6e-8 * f64::from(n), "{method} {h}: {relative}");
            assert!(expected > 1.0);
        }
    }
}

#[test]
fn largest_step_of_a_damped_oscillation() {
    for zeta in [0.1f32, 0.3, 0.7] {
        let z = f64::from(zeta);
        for (method, expected) in [(Method::Euler, 2.0 * z), (Method::Symplectic, 2.0 * ((1.0 + z * z).sqrt() - z))] {
            let h = largest_step(0.1, 3.0, |h| growth(method, 1.0, 2.0 * zeta, h) < 1.0);
            assert!((h - expected).abs() < 2e-3 * expected, "{method} ζ = {zeta}: {h}, not {expected}");
        }
    }
}

#[test]
fn an_oscillation_after_ten_seconds() {
    for (method, expected) in [
        (Method::Euler, 1.264_885_813_1),
        (Method::Midpoint, 0.378_467_403_7),
        (Method::Rk4, 0.408_096_657_1),
        (Method::Symplectic, 0.354_578_224_8),
        (Method::Implicit, 0.172_892_663_6),
        (Method::Verlet, 0.400_451_500_1),
    ] {
        let [x, _] = follow(method, &Law(|_, x: f32, _| -4.0 * x), [1.0, 0.0], 0.05, 200);
        // 200 steps, each rounded to half an ulp of at most 2: a random walk of 1e-7 √200, with room.
        assert!((x - expected).abs() < 4e-6, "{method}: {x}");
    }
}

/// The end of x'' = `law` in double precision: RK4 in steps of a millisecond, which errs by about 1e-12.
fn exact(law: impl Fn(f64, f64, f64) -> f64, [x, v]: [f64; 2], end: f64) -> [f64; 2] {
    let n = (end * 1000.0).round() as u32;
    let h = end / f64::from(n);
    let (mut x, mut v) = (x, v);
    for i in 0..n {
        let t = f64::from(i) * h;
        let (k1, l1) = (v, law(t, x, v));
        let (k2, l2) = (v + h / 2.0 * l1, law(t + h / 2.0, x + h / 2.0 * k1, v + h / 2.0 * l1));
        let (k3, l3) = (v + h / 2.0 * l2, law(t + h / 2.0, x + h / 2.0 * k2, v + h / 2.0 * l2));
        let (k4, l4) = (v + h * l3, law(t + h, x + h * k3, v + h * l3));
        x += h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
        v += h / 6.0 * (l1 + 2.0 * l2 + 2.0 * l3 + l4);
    }
    [x, v]
}

/// Starts all over the plane of place and speed, in numbers that an f32 holds.
fn starts() -> Vec<[f64; 2]> {
    (0..64).map(|i| [f64::from(i % 8) * 0.1875 - 0.65625, f64::from(i / 8) * 0.125 - 0.4375]).collect()
}

/// The errors of place and speed after 4 s in `n` steps, from every start.
fn errors<F, D>(integrator: &dyn Integrator, law: F, double: D, n: u32) -> Vec<f64>
where
    F: Fn(f32, f32, f32) -> f32 + Sync,
    D: Fn(f64, f64, f64) -> f64 + Copy,
{
    let begin =
        |[x, v]: [f64; 2]| Particle { position: Vec3::X * x as f32, velocity: Vec3::X * v as f32, ..Particle::REST };
    let start: Vec<Particle> = starts().into_iter().map(begin).collect();
    let law = Law(law);
    let scene = Scene { start: &start, forces: &law, integrator, ..Scene::EMPTY };
    let mut system = started(&scene, start.len(), 0);
    run(&mut system, &scene, 4.0 / f64::from(n), n);
    let p = system.particles();
    let error = |(i, start): (usize, [f64; 2])| {
        let [x, v] = exact(double, start, 4.0);
        [f64::from(p.position[i].x) - x, f64::from(p.velocity[i].x) - v]
    };
    starts().into_iter().enumerate().flat_map(error).collect()
}

/// A method, its order, and numbers of steps that are fine enough for the leading term of the error and coarse enough for
/// that to be well above the rounding of f32.
struct Case {
    name: &'static str,
    integrator: &'static dyn Integrator,
    order: f64,
    steps: [u32; 4],
}

const FINE: [u32; 4] = [640, 1280, 2560, 5120];
const MEDIUM: [u32; 4] = [80, 120, 160, 240];
const COARSE: [u32; 4] = [12, 16, 24, 32];

/// The adaptive ones tolerate anything here, so that they take steps as they come.
const CASES: [Case; 9] = [
    Case { name: "euler", integrator: &Euler, order: 1.0, steps: FINE },
    Case { name: "symplectic", integrator: &Symplectic, order: 1.0, steps: FINE },
    Case { name: "midpoint", integrator: &Midpoint, order: 2.0, steps: MEDIUM },
    Case { name: "verlet", integrator: &Verlet, order: 2.0, steps: MEDIUM },
    Case { name: "rk4", integrator: &Rk4, order: 4.0, steps: COARSE },
    Case { name: "implicit", integrator: &Implicit::USUAL, order: 1.0, steps: FINE },
    Case {
        name: "embedded",
        integrator: &Embedded { tolerance: f32::INFINITY, ..Embedded::USUAL },
        order: 3.0,
        steps: [24, 32, 48, 64],
    },
    Case {
        name: "adaptive(euler)",
        integrator: &Adaptive { tolerance: f32::INFINITY, ..Adaptive::around(Euler) },
        order: 1.0,
        steps: FINE,
    },
    Case {
        name: "adaptive(midpoint)",
        integrator: &Adaptive { tolerance: f32::INFINITY, ..Adaptive::around(Midpoint) },
        order: 2.0,
        steps: [40, 60, 80, 120],
    },
];

/// Checks every method's order on x'' = `law`, which must be given in both precisions.
fn check_orders<F, D>(law: F, double: D)
where
    F: Fn(f32, f32, f32) -> f32 + Sync + Copy,
    D: Fn(f64, f64, f64) -> f64 + Copy,
{
    for Case { name, integrator, order, steps } in &CASES {
        let p = measured(*integrator, *steps, law, double);
        println!("{name}: {p:.3}");
        assert!((p - order).abs() < 0.05, "{name}: {p}");
    }
}

/// The order that a method shows.
fn measured<F, D>(integrator: &dyn Integrator, steps: [u32; 4], law: F, double: D) -> f64
where
    F: Fn(f32, f32, f32) -> f32 + Sync + Copy,
    D: Fn(f64, f64, f64) -> f64 + Copy,
{
    let size = |n| errors(integrator, law, double, n).iter().map(|e| e * e).sum::<f64>().sqrt();
    order(&steps.map(|n| 4.0 / f64::from(n)), &steps.map(size))
}

#[test]
fn order_on_a_pendulum() {
    check_orders(|_, x, _| -x.sin(), |_, x, _| -x.sin());
}

#[test]
fn order_with_a_force_that_depends_on_time() {
    check_orders(|t, x, _| 0.5 * t.cos() - x.sin(), |t, x, _| 0.5 * t.cos() - x.sin());
}

#[test]
fn the_lecture_s_midpoint_falls_to_order_1_with_such_a_force() {
    let order = |law: fn(f32, f32) -> f32, double: fn(f64, f64) -> f64| {
        measured(&LectureMidpoint, FINE, move |t, x, _| law(t, x), move |t, x, _| double(t, x))
    };
    let p = order(|t, x| 0.5 * t.cos() - x.sin(), |t, x| 0.5 * t.cos() - x.sin());
    assert!((p - 1.0).abs() < 0.05, "{p}");
    let still = measured(&LectureMidpoint, MEDIUM, |_, x, _| -x.sin(), |_, x, _| -x.sin());
    assert!((still - 2.0).abs() < 0.05, "{still}");
}

#[test]
fn order_with_a_force_that_depends_on_velocity() {
    // Verlet is given v + h a for the second evaluation; with v + h/2 a or the old v it would fall to order 1.
    check_orders(|_, x, v| -x.sin() - 0.2 * v - 0.1 * v * v, |_, x, v| -x.sin() - 0.2 * v - 0.1 * v * v);
}

#[test]
fn energy_drift_in_free_fall() {
    for (method, drift) in [
        (Method::Euler, 0.5),
        (Method::Symplectic, -0.5),
        (Method::Midpoint, 0.0),
        (Method::Verlet, 0.0),
        (Method::Rk4, 0.0),
    ] {
        for (h, mass) in [(1.0 / 60.0, 1.0), (1.0 / 120.0, 3.0)] {
            let start = [Particle { velocity: Vec3::new(1.0, 5.0, 0.0), mass, ..Particle::REST }];
            let integrator = method.integrator();
            let scene = Scene { start: &start, forces: &Gravity::EARTH, integrator, ..Scene::EMPTY };
            let mut system = started(&scene, 1, 0);
            let before = Measures::of(&system, &scene).energy.total();
            run(&mut system, &scene, h, (2.0 / h).round() as u32);
            let measures = Measures::of(&system, &scene);
            // J/kg after two seconds, at −9.6 m and −14.6 m/s: at the worst all of 240 steps round by half an ulp
            // (4.8e-7) the same way, which is g × 1.2e-4 m and 14.6 m/s × 1.2e-4 m/s.
            let change = (measures.energy.total() - before) / f64::from(mass);
            assert!((change - 2.0 * drift * G * G * h).abs() < 3e-3, "{method}: {change}");
            assert!(
                (measures.energy.kinetic - 0.5 * f64::from(mass) * (1.0 + (5.0 - 2.0 * G).powi(2))).abs()
                    < 3e-3 * f64::from(mass)
            );
        }
    }
}

#[test]
fn an_oscillation_s_energy_stays_bounded_for_long() {
    // Symplectic methods: the error neither grows nor shrinks, order h ω / 2 and (h ω)² / 8 of the energy.
    let n = often(1_000_000) as u32;
    for (method, bound) in [(Method::Symplectic, 0.06), (Method::Verlet, 0.004)] {
        let [x, v] = follow(method, &Law(|_, x: f32, _| -x), [1.0, 0.0], 0.1, n);
        let energy = x * x + v * v;
        assert!((energy - 1.0).abs() < bound, "{method}: {energy}");
    }
}

#[test]
fn methods_have_names() {
    for &method in Method::ALL {
        assert_eq!(method.name().parse(), Ok(method));
        assert_eq!(method.to_string(), method.name());
    }
    assert_eq!(Method::ALL.len(), 9);
    assert!("rk5".parse::<Method>().is_err() && "".parse::<Method>().is_err());
}
