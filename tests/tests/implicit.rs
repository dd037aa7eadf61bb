//! Implicit Euler: what is stiff stays finite, comes to rest, and costs what it may.

use pointmass::{
    ClothSprings, Coulomb, Drag, Gravity, Implicit, Measures, Particle, QuadraticDrag, Scene, Sheet, Spring,
    SpringParams, System, Time, Vec3,
};
use pointmass_tests::{Law, follow, run, started};

/// A square metre of cloth, 4 kg, flat, held by two corners, and its springs.
fn cloth(cells: u32, ks: f32, kd: f32) -> (Vec<Particle>, Vec<Spring>) {
    let thread = Some(SpringParams { ks, kd });
    let threads =
        ClothSprings { structural: thread, shear: thread, bend: Some(SpringParams { ks: 0.01 * ks, kd: 0.01 * kd }) };
    let sheet = Sheet { corner: Vec3::ZERO, sides: [Vec3::X, Vec3::Z], cells: [cells; 2] };
    let mass = 4.0 / ((cells + 1) * (cells + 1)) as f32;
    let mut particles: Vec<_> = sheet.particles(Particle { mass, drag: 0.1 * mass, ..Particle::REST }).collect();
    for corner in [0, cells] {
        particles[corner as usize].fixed = true;
    }
    (particles, sheet.springs(&threads, 0).collect())
}

#[test]
fn stiff_cloth_stays_finite_and_comes_to_rest() {
    // A smaller piece for slow builds.
    let (cells, seconds) = if cfg!(debug_assertions) { (9, 30) } else { (31, 30) };
    comes_to_rest(cells, seconds, 5e-3);
}

#[test]
#[ignore = "long: a minute of a large sheet, in release"]
fn a_large_sheet_of_stiff_cloth_comes_to_rest() {
    comes_to_rest(63, 60, 1e-3);
}

/// Hangs up a sheet of so many cells and waits: no explicit method bears a sixtieth of a second here, as the fastest mode of 63
/// has 90,000 radians a second. In the end nothing is faster than `still` \[m/s\].
fn comes_to_rest(cells: u32, seconds: u64, still: f32) {
    let (start, springs) = cloth(cells, 1e6, 10.0);
    let integrator = Implicit { iterations: 100, ..Implicit::USUAL };
    let forces = (Gravity::EARTH, Drag {});
    let scene = Scene { start: &start, springs: &springs, forces: &forces, integrator: &integrator, ..Scene::EMPTY };
    let mut system = started(&scene, start.len(), 1);
    let begin = Measures::of(&system, &scene).energy.total();
    for frame in 1..=60 * seconds {
        system.step(&scene, Time::frame(frame, 60) - system.time());
        if frame % 60 == 0 {
            assert!(Measures::of(&system, &scene).energy.total() < begin + 1e-3, "it gains energy: {frame}");
        }
    }
    let p = system.particles();
    assert_eq!(p.position.len(), start.len());
    let fastest = p.velocity.iter().map(|v| v.length()).fold(0.0, f32::max);
    assert!(fastest < still, "{fastest} m/s after {seconds} s");
    // It hangs by its corners, hardly longer than it lies.
    let lowest = p.position.iter().map(|x| x.y).fold(0.0, f32::min);
    assert!((-1.05..-0.95).contains(&lowest), "{lowest}");
    println!("{:?}", system.totals().effort);
}

#[test]
fn no_step_is_too_long() {
    for h in [0.1, 1.0, 100.0] {
        for (stiffness, damping) in [(1.0, 0.0), (1e4, 1.0), (1e8, 0.0), (0.0, 1e6)] {
            let law = Law(move |_, x: f32, v| -stiffness * x - damping * v);
            let [x, v] = follow(Implicit::USUAL, &law, [1.0, 1.0], h, 20);
            assert!(
                x.abs() < 2.1 + 20.0 * h.min(f64::from(damping.max(1.0)).recip()),
                "{h} {stiffness} {damping}: {x}"
            );
            assert!(v.abs() < 1.5, "{h} {stiffness} {damping}: {v}");
        }
    }
}

#[test]
fn newton_s_method_finds_the_end_of_the_step() {
    // v₁ = v₀ + h a(x₀ + h v₁): one Newton step leaves the curvature of the force, more of them rounding.
    let h = 0.5f64;
    let left = |newton: u32| {
        let [x, v] = follow(
            Implicit { newton, residual: 1e-6, ..Implicit::USUAL },
            &Law(|_, x: f32, _| -x.sin()),
            [1.0, 0.5],
            h,
            1,
        );
        assert!((x - 1.0 - h * v).abs() < 1e-6);
        (v - 0.5 + h * x.sin()).abs()
    };
    let [one, two, four] = [1, 2, 4].map(left);
    assert!(one > 1e-4 && two < 0.1 * one && four < 1e-5, "{one} {two} {four}");
}

#[test]
fn a_solution_that_is_cut_off_is_counted() {
    let (start, springs) = cloth(15, 1e6, 0.0);
    let effort = |iterations| {
        let integrator = Implicit { iterations, ..Implicit::USUAL };
        let scene = Scene {
            start: &start,
            springs: &springs,
            forces: &Gravity::EARTH,
            integrator: &integrator,
            ..Scene::EMPTY
        };
        let mut system: System<_> = started(&scene, start.len(), 1);
        run(&mut system, &scene, 1.0 / 60.0, 30);
        assert_eq!(system.len(), start.len());
        system.totals().effort
    };
    let (few, many) = (effort(3), effort(2000));
    assert!(few.capped > 20 && few.iterations <= 90 && few.residual > 1e-2, "{few:?}");
    assert!(many.capped < few.capped && many.residual < few.residual, "{many:?}");
    assert_eq!((few.solves, few.evaluations), (30, 30));
}

#[test]
fn one_that_is_driven_very_far_holds_nobody_up() {
    // Squares of such forces are beyond an f32; the others fall all the same.
    let charge = |x: f32| Particle { position: Vec3::X * x, charge: 1.0, ..Particle::REST };
    let fast = Particle { velocity: Vec3::X * 1e18, ..Particle::REST };
    let still = Particle { position: Vec3::Y, ..Particle::REST };
    for start in [[charge(0.0), charge(1e-7), still], [fast, fast, still]] {
        let forces = (Gravity::EARTH, Coulomb::VACUUM, QuadraticDrag { coefficient: 1e-3 });
        let scene = Scene { start: &start, forces: &forces, integrator: &Implicit::USUAL, ..Scene::EMPTY };
        let mut system = started(&scene, 3, 0);
        let report = system.step(&scene, Time::SECOND);
        let v = system.particles().velocity;
        assert!((v[2].y + 9.80665).abs() < 0.2, "{v:?}");
        assert_ne!(v[0].x, start[0].velocity.x);
        assert_eq!((system.len(), report.effort.capped), (3, 0));
    }
}

#[test]
fn what_cannot_be_solved_is_counted() {
    let start = [Particle::REST];
    let integrator = Implicit { residual: f32::NAN, ..Implicit::USUAL };
    let scene = Scene { start: &start, forces: &Gravity::EARTH, integrator: &integrator, ..Scene::EMPTY };
    let mut system = started(&scene, 1, 0);
    let report = system.step(&scene, Time::SECOND);
    assert_eq!(report.effort.capped, 1, "{:?}", report.effort);
}

#[test]
fn a_rope_that_does_not_stretch_hangs_as_a_catenary() {
    // 1.2 m over a span of 1 m: sag 0.2923437976 m. Five newtons stretch each of sixty pieces by a part in 10⁴, which is
    // 0.1 mm of sag; that they are straight is less.
    let (n, length) = (60, 1.2 / 60.0);
    let place = |i: u32| {
        let s = i as f32 / n as f32;
        Vec3::new(s, -1.2 * s * (1.0 - s), 0.0)
    };
    let body =
        |i: u32| Particle { position: place(i), mass: 0.01, drag: 0.02, fixed: i == 0 || i == n, ..Particle::REST };
    let start: Vec<_> = (0..=n).map(body).collect();
    let springs: Vec<_> = (0..n).map(|i| Spring::new([i, i + 1], length, 2e6).damped(1.0)).collect();
    let forces = (Gravity::EARTH, Drag {});
    let scene =
        Scene { start: &start, springs: &springs, forces: &forces, integrator: &Implicit::USUAL, ..Scene::EMPTY };
    let mut system = started(&scene, start.len(), 1);
    run(&mut system, &scene, 1.0 / 60.0, 1200);
    let p = system.particles();
    let fastest = p.velocity.iter().map(|v| v.length()).fold(0.0, f32::max);
    let sag = -p.position.iter().map(|x| x.y).fold(0.0, f32::min);
    assert!(fastest < 1e-3 && (sag - 0.292_343_8).abs() < 2e-4, "{sag} {fastest}");
}
