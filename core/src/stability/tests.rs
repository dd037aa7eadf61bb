use super::*;
use glam::Vec3;

/// ω = 3 rad/s throughout: nothing may depend on a unit.
const OMEGA: f64 = 3.0;

const SCHEMES: [Scheme; 7] =
    [Scheme::EULER, Scheme::MIDPOINT, Scheme::RK3, Scheme::RK4, Scheme::Symplectic, Scheme::Verlet, Scheme::Implicit];

fn damped(ratio: f64) -> Mode {
    Mode { omega2: OMEGA * OMEGA, damping: 2.0 * ratio * OMEGA }
}

/// hω at the limit.
#[track_caller]
fn limit(scheme: Scheme, ratio: f64) -> f64 {
    match scheme.largest_step(damped(ratio)) {
        Limit::Step(step) => step * OMEGA,
        other => panic!("{scheme:?} at {ratio}: {other:?}"),
    }
}

#[track_caller]
fn near(value: f64, expected: f64) {
    assert!((value / expected - 1.0).abs() < 1e-9, "{value}, not {expected}");
}

#[test]
fn limits_have_their_closed_forms() {
    near(limit(Scheme::Symplectic, 0.0), 2.0);
    near(limit(Scheme::Verlet, 0.0), 2.0);
    near(limit(Scheme::RK4, 0.0), 8f64.sqrt());
    near(limit(Scheme::RK3, 0.0), 3f64.sqrt());
    for ratio in [1e-6, 0.01, 0.3, 0.999, 1.0, 1.7, 40.0] {
        near(limit(Scheme::Symplectic, ratio), 2.0 * ((1.0f64 + ratio * ratio).sqrt() - ratio));
        let fast = ratio + (ratio * ratio - 1.0f64).max(0.0).sqrt();
        near(limit(Scheme::EULER, ratio), if ratio <= 1.0 { 2.0 * ratio } else { 2.0 / fast });
        if ratio >= 1.0 {
            near(limit(Scheme::MIDPOINT, ratio), 2.0 / fast);
            assert!((limit(Scheme::RK4, ratio) * fast - 2.785_293_563_4).abs() < 1e-9);
        }
    }
    for scheme in [Scheme::EULER, Scheme::MIDPOINT] {
        assert_eq!(scheme.largest_step(damped(0.0)), Limit::Never);
    }
    assert_eq!(Scheme::Implicit.largest_step(damped(0.0)), Limit::Unconditional);
}

#[test]
fn the_real_axis_needs_no_oscillation() {
    let drag = Mode { omega2: 0.0, damping: 4.0 };
    for (scheme, expected) in [
        (Scheme::EULER, 2.0),
        (Scheme::MIDPOINT, 2.0),
        (Scheme::RK4, 2.785_293_563_405),
        (Scheme::Symplectic, 2.0),
        (Scheme::Verlet, 2.0),
    ] {
        let Limit::Step(step) = scheme.largest_step(drag) else { panic!("{scheme:?}") };
        near(step * 4.0, expected);
    }
    for scheme in SCHEMES {
        assert_eq!(scheme.largest_step(Mode::default()), Limit::Unconditional);
        assert_eq!(scheme.largest_step(Mode { omega2: -1.0, damping: 0.0 }), Limit::Never);
        assert_eq!(scheme.largest_step(Mode { omega2: 1.0, damping: -1.0 }), Limit::Never);
        assert_eq!(scheme.largest_step(Mode { omega2: f64::NAN, damping: 0.0 }), Limit::Never);
    }
}

#[test]
fn stable_steps_are_one_interval_from_zero() {
    for scheme in SCHEMES {
        for ratio in [0.001, 0.05, 0.2, 0.4, 0.6, 0.8, 1.0, 1.5, 3.0, 10.0] {
            let Limit::Step(limit) = scheme.largest_step(damped(ratio)) else { continue };
            for i in 1..400 {
                let h = 4.0 * limit * f64::from(i) / 401.0;
                let grows = scheme.growth_rate(damped(ratio), h) > 1e-12;
                assert_eq!(grows, h > limit, "{scheme:?}, damping ratio {ratio}: {h} of {limit}");
            }
        }
    }
}

#[test]
fn growth_is_that_of_the_matrix() {
    for scheme in SCHEMES {
        for ratio in [0.0, 0.3, 2.0] {
            for h in [0.01, 0.2, 1.1] {
                let m = scheme.amplification(damped(ratio), h);
                let (mut y, mut size) = ([1.0, 0.5], 0.0);
                for _ in 0..2000 {
                    y = [m[0][0] * y[0] + m[0][1] * y[1], m[1][0] * y[0] + m[1][1] * y[1]];
                    let norm = y[0].hypot(y[1]);
                    size += norm.ln();
                    y = y.map(|y| y / norm);
                }
                let rate = scheme.growth_rate(damped(ratio), h);
                assert!((size / 2000.0 / h - rate).abs() < 2e-3 / h, "{scheme:?} {ratio} {h}: {rate}");
            }
        }
    }
    // ln(1 + h²ω²) / 2h and ln(1 + h⁴ω⁴/4) / 2h.
    near(Scheme::EULER.growth_rate(damped(0.0), 0.1), 1.09f64.ln() / 0.2);
    near(Scheme::MIDPOINT.growth_rate(damped(0.0), 0.1), (1.0 + 0.0081f64 / 4.0).ln() / 0.2);
}

#[test]
fn the_factor_of_both_rates_is_the_determinant() {
    for scheme in [Scheme::EULER, Scheme::MIDPOINT, Scheme::RK4, Scheme::Implicit] {
        for ratio in [0.0, 0.4, 1.0, 2.5] {
            let (h, mode) = (0.3, damped(ratio));
            let [a, b] = mode.rates().map(|[re, im]| scheme.factor([h * re, h * im]).expect("a factor"));
            let [[m, n], [o, p]] = scheme.amplification(mode, h);
            near(a * b, (m * p - n * o).abs());
        }
    }
    assert_eq!(Scheme::Verlet.factor([0.0; 2]), None);
}

/// The course's rope: 20 springs of 100 N/m and 20 N s/m between particles of 1 kg, the first of them fixed.
fn rope(kd: f32) -> (Vec<Particle>, Vec<Spring>) {
    let particle = |i: u8| Particle { position: Vec3::X * f32::from(i), fixed: i == 0, ..Particle::REST };
    let spring = |i: u32| Spring { kd, ..Spring::new([i, i + 1], 1.0, 100.0) };
    ((0..=20).map(particle).collect(), (0..20).map(spring).collect())
}

#[test]
fn the_bound_of_all_poses_needs_no_eigenvalues() {
    let (particles, springs) = rope(20.0);
    let poses = Poses::of(&particles, &springs, true);
    for (method, expected) in
        [(Method::Euler, 26.79), (Method::Midpoint, 26.79), (Method::Symplectic, 23.61), (Method::Rk4, 37.32)]
    {
        let Limit::Step(step) = poses.largest_step(method) else { panic!("{method}") };
        assert!((step * 1e3 - expected).abs() < 0.005, "{method}: {step}");
    }
    near(poses.fastest(), 20.0);
    near(poses.growth_across(Method::Euler, 0.01), 1.04f64.ln() / 0.02);
    assert_eq!(poses.growth_across(Method::Rk4, 0.01), 0.0);
    let (particles, springs) = rope(0.0);
    let poses = Poses::of(&particles, &springs, true);
    assert_eq!(poses.largest_step(Method::Euler), Limit::Never);
    let Limit::Step(step) = poses.largest_step(Method::Verlet) else { panic!() };
    near(step, 0.1);
}

#[test]
fn unequal_springs_are_bounded_by_the_worst_they_allow() {
    let free = Particle::REST;
    let fixed = Particle { fixed: true, ..free };
    let stiff = Spring::new([0, 1], 1.0, 400.0);
    let damper = Spring { kd: 80.0, ..Spring::new([1, 2], 1.0, 0.0) };
    let poses = Poses::of(&[fixed, free, fixed], &[stiff, damper], false);
    // At a right angle they are two modes: 20 rad/s without damping, and 80/s of damping alone.
    assert_eq!(poses.largest_step(Method::Euler), Limit::Never);
    let Limit::Step(step) = poses.largest_step(Method::Rk4) else { panic!() };
    near(step * 80.0, 2.785_293_563_405);
    // Drag damps a spring that does not damp itself, if drag acts.
    let slow = Particle { drag: 4.0, ..free };
    let poses = |drag| Poses::of(&[fixed, slow], &[stiff], drag).largest_step(Method::Euler);
    assert_eq!(poses(false), Limit::Never);
    let Limit::Step(step) = poses(true) else { panic!() };
    near(step, 0.01);
}

#[test]
fn what_is_odd_bounds_nothing_or_everything() {
    let stuck = Spring::new([0, 0], 1.0, 1e9);
    let lost = Spring { ends: [0, 7], ..stuck };
    let none = Poses::of(&[Particle::REST], &[stuck, lost], true);
    assert_eq!(none.largest_step(Method::Symplectic), Limit::Unconditional);
    let pulling = Spring { ends: [0, 1], ..stuck };
    let pushing = Spring { ks: -1.0, ..pulling };
    assert_eq!(Poses::of(&[Particle::REST; 2], &[pulling, pushing], true).largest_step(Method::Rk4), Limit::Never);
    assert!(Limit::Unconditional.admits(1.0) && Limit::Step(1.0).admits(1.0) && !Limit::Never.admits(0.0));
}

#[test]
fn paths_are_followed_up_to_a_step() {
    // Seven hundredths of a second on earth.
    near(longest_followed_step(9.80665), 8.0 * (8.0 * f64::from(1e-4f32) / 9.80665).sqrt());
}
