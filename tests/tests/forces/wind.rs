//! Air that moves.

use super::{cloud, forces};
use pointmass::force::{Curl, Flow, FlowKind, Gusts, Uniform, Vortex};
use pointmass::{Drag, Method, Particle, Scene, Time, Vec3, Wind};
use pointmass_tests::{Random, f64s, gap, often, run, started};

const TURBULENCE: Curl = Curl { speed: 2.0, scale: 0.5, drift: Vec3::ZERO, seed: 7 };

#[test]
fn speeds_tend_to_the_winds_and_never_pass_it() {
    let w = Vec3::new(3.0, -1.0, 2.0);
    let start = [Particle { mass: 2.0, drag: 0.5, ..Particle::REST }];
    for (coefficient, k) in [(None, 0.5), (Some(4.0), 4.0)] {
        let wind = Wind { field: Uniform { velocity: w }, coefficient };
        for &method in Method::ALL {
            let scene = Scene { start: &start, forces: &wind, integrator: method.integrator(), ..Scene::EMPTY };
            let mut system = started(&scene, 1, 0);
            let mut last = 0.0;
            for i in 1..=400u32 {
                system.step(&scene, Time::from_seconds_f64(0.05 * f64::from(i)) - system.time());
                let speed = system.particles().velocity[0].length();
                assert!(speed >= last && speed <= w.length() * (1.0 + 1e-6), "{method}: {speed} after {last}");
                last = speed;
            }
            assert!(last > w.length() * 0.99, "{method}: {last}");
        }
        let rk4 = Method::Rk4.integrator();
        let scene = Scene { start: &start, forces: &wind, integrator: rk4, ..Scene::EMPTY };
        let mut system = started(&scene, 1, 0);
        run(&mut system, &scene, 0.01, 100);
        let v = f64s(w).map(|w| w * (1.0 - (-k / 2.0f64).exp()));
        assert!(gap(f64s(system.particles().velocity[0]), v) < 2e-6);
    }
}

#[test]
fn still_air_is_drag_to_the_bit() {
    let start = cloud(33);
    let scene = Scene { start: &start, ..Scene::EMPTY };
    let system = started(&scene, 33, 0);
    let drag = forces(&system, &scene, &Drag {});
    assert_eq!(forces(&system, &scene, &Wind { field: (), coefficient: None }), drag);
    let still = Uniform { velocity: Vec3::ZERO };
    assert_eq!(forces(&system, &scene, &Wind { field: [still, still], coefficient: None }), drag);
}

#[test]
fn gusts_swing_about_their_mean_within_their_bounds() {
    let gusts = Gusts { velocity: Vec3::X * 4.0, amplitude: 0.5, frequency: 0.3 };
    let (mut low, mut high, mut sum) = (f32::INFINITY, f32::NEG_INFINITY, 0.0);
    let n = 20_000u32;
    for i in 0..n {
        let time = Time::from_seconds_f64(f64::from(i) * 0.037);
        let w = gusts.velocity(Vec3::ZERO, time);
        assert_eq!((Some(w), w.y, w.z), (gusts.everywhere(time), 0.0, 0.0));
        (low, high, sum) = (low.min(w.x), high.max(w.x), sum + f64::from(w.x));
    }
    assert!((2.0..2.2).contains(&low) && (5.8..=6.0).contains(&high), "{low} to {high}");
    assert!((sum / f64::from(n) - 4.0).abs() < 0.02, "{sum}");
    // It is as smooth after a year as at the beginning.
    let year = Time::from_seconds_f64(3.2e7);
    let step = gusts.velocity(Vec3::ZERO, year + Time::from_seconds(1e-3)) - gusts.velocity(Vec3::ZERO, year);
    assert!(step.length() < 1e-2 && step.length() > 0.0, "{step}");
}

#[test]
fn a_vortex_turns_about_its_axis() {
    let vortex = Vortex { center: Vec3::X, axis: Vec3::Y * 3.0, speed: 5.0, core: 0.5 };
    let at = |r: f32, y: f32| vortex.velocity(Vec3::new(1.0 + r, y, 0.0), Time::ZERO);
    assert_eq!(at(0.0, 7.0), Vec3::ZERO);
    for r in [0.01f32, 0.1, 0.5, 1.0, 30.0] {
        let speed = 10.0 * (r / 0.5) / (1.0 + (r / 0.5).powi(2));
        assert!((at(r, 2.0) - Vec3::NEG_Z * speed).length() < 1e-5 * speed, "{}", at(r, 2.0));
        assert!(at(r, 0.0).length() <= 5.0 * (1.0 + 1e-6));
    }
    let none = Vortex { core: 0.0, ..vortex };
    assert_eq!(none.velocity(Vec3::X, Time::ZERO), Vec3::ZERO);
}

#[test]
fn flows_are_closed_under_sums() {
    let (u, v) = (Uniform { velocity: Vec3::Y }, Vortex { center: Vec3::ZERO, axis: Vec3::Z, speed: 1.0, core: 1.0 });
    let (at, now) = (Vec3::new(0.3, 0.4, 0.5), Time::SECOND);
    let both = u.velocity(at, now) + v.velocity(at, now);
    let kinds = [FlowKind::Uniform(u), FlowKind::Vortex(v)];
    let flows: [&dyn Flow; 6] = [&(u, v), &kinds, &&kinds[..], &kinds.to_vec(), &(&u, ((), v)), &[&u as &dyn Flow, &v]];
    for flow in flows {
        assert_eq!((flow.velocity(at, now), flow.everywhere(now)), (both, None));
    }
    assert_eq!((u, u).everywhere(now), Some(Vec3::Y * 2.0));
    assert_eq!(().everywhere(now), Some(Vec3::ZERO));
}

/// ∂ of the flow's velocity along each axis, by central differences over 2 `h`.
fn slopes(flow: &Curl, at: Vec3, h: f32) -> [[f64; 3]; 3] {
    core::array::from_fn(|axis| {
        let (mut low, mut high) = (at, at);
        low[axis] -= h;
        high[axis] += h;
        let width = f64::from(high[axis]) - f64::from(low[axis]);
        let (a, b) = (f64s(flow.velocity(low, Time::ZERO)), f64s(flow.velocity(high, Time::ZERO)));
        core::array::from_fn(|k| (b[k] - a[k]) / width)
    })
}

#[test]
fn curl_noise_neither_gathers_nor_spreads() {
    let mut random = Random::new(5);
    let (mut divergence, mut size) = (0.0, 0.0);
    for _ in 0..often(20_000) {
        let at = random.vector(3.0);
        let [x, y, z] = slopes(&TURBULENCE, at, 1.0 / 1024.0);
        divergence += (x[0] + y[1] + z[2]).powi(2);
        size += [x, y, z].as_flattened().iter().map(|x| x * x).sum::<f64>();
    }
    // The rest is rounding, 2 m/s × 6e-8 × 1024, and h² of the third derivatives.
    let share = (divergence / size).sqrt();
    assert!(share < 3e-4, "{share}");
}

#[test]
fn curl_noise_has_the_speed_it_says_in_all_directions() {
    let mut random = Random::new(6);
    let n = often(200_000);
    let (mut mean, mut square) = ([0.0; 3], [0.0; 3]);
    for _ in 0..n {
        let v = f64s(TURBULENCE.velocity(random.vector(60.0), Time::ZERO));
        (0..3).for_each(|k| mean[k] += v[k] / n as f64);
        (0..3).for_each(|k| square[k] += v[k] * v[k] / n as f64);
    }
    let rms = square.iter().sum::<f64>().sqrt();
    assert!((rms / 2.0 - 1.0).abs() < 0.02, "{rms}");
    assert!(square.iter().all(|s| (s / (4.0 / 3.0) - 1.0).abs() < 0.05), "{square:?}");
    assert!(mean.iter().all(|m| m.abs() < 0.05), "{mean:?}");
}

#[test]
fn curl_noise_is_smooth_repeats_and_drifts() {
    let mut random = Random::new(7);
    let drifting = Curl { drift: Vec3::new(0.5, -2.0, 0.125), ..TURBULENCE };
    for _ in 0..2000 {
        let at = random.vector(4.0);
        let v = TURBULENCE.velocity(at, Time::ZERO);
        assert!(gap(f64s(TURBULENCE.velocity(at + Vec3::splat(1e-4), Time::ZERO)), f64s(v)) < 2e-2, "{at}");
        // Across the side of a cell.
        let side = Vec3::new((at.x * 2.0).round() / 2.0, at.y, at.z);
        let [a, b] = [-1e-5, 1e-5].map(|d| TURBULENCE.velocity(side + Vec3::X * d, Time::ZERO));
        assert!((a - b).length() < 1e-3, "{side}: {a} {b}");
        // 256 cells of 0.5 m on, as exact as the place there.
        let again = TURBULENCE.velocity(at + Vec3::Z * 128.0, Time::ZERO);
        assert!((again - v).length() < 2e-3, "{at}: {v} {again}");
        let later = drifting.velocity(at + drifting.drift * 3.0, Time::from_seconds(3.0));
        assert!((later - v).length() < 2e-3, "{at}: {v} {later}");
        assert_ne!(Curl { seed: 8, ..TURBULENCE }.velocity(at, Time::ZERO), v);
    }
}

#[test]
fn leaves_in_turbulence_go_with_it() {
    // Light ones follow the air; the mean of their squared speeds comes near to that of the air.
    let mut random = Random::new(9);
    let start: Vec<Particle> =
        (0..300).map(|_| Particle { position: random.vector(3.0), mass: 0.01, drag: 1.0, ..Particle::REST }).collect();
    let wind = Wind { field: TURBULENCE, coefficient: None };
    let scene = Scene { start: &start, forces: &wind, integrator: Method::Rk4.integrator(), ..Scene::EMPTY };
    let mut system = started(&scene, 300, 0);
    run(&mut system, &scene, 0.01, 100);
    let square = system.particles().velocity.iter().map(|v| f64::from(v.length_squared())).sum::<f64>() / 300.0;
    assert!((1.6..2.4).contains(&square.sqrt()), "{square}");
}
