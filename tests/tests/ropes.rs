//! Ropes against closed forms: how long chains hang, how they swing, what they keep, and what does them no harm.

use pointmass::scene::SceneFile;
use pointmass::{Constraint, Distance, Drag, Gravity, Measures, Method, Particle, Rope, Scene, Time, Vec3};
use pointmass_tests::{Random, every, f64s, gap, is_run, is_third, often, run, started};

const G: f64 = 9.81;
const DOWN: Gravity = Gravity { acceleration: Vec3::new(0.0, -9.81, 0.0) };

/// So many links along a direction, the first end fixed.
fn chain(links: usize, length: f32, from: Vec3, way: Vec3, part: Particle) -> Vec<Particle> {
    (0..=links).map(|i| Particle { position: from + way * (i as f32 * length), fixed: i == 0, ..part }).collect()
}

fn all(start: &[Particle]) -> Vec<u32> {
    (0..start.len() as u32).collect()
}

fn lengths(x: &[Vec3]) -> Vec<f64> {
    x.windows(2).map(|pair| gap(f64s(pair[0]), f64s(pair[1]))).collect()
}

/// How far a chain is off its length, as a whole and in its worst link.
fn off(x: &[Vec3], length: f64) -> [f64; 2] {
    let lengths = lengths(x);
    let whole = lengths.iter().sum::<f64>() / (length * lengths.len() as f64) - 1.0;
    [whole.abs(), lengths.iter().map(|l| (l / length - 1.0).abs()).fold(0.0, f64::max)]
}

#[test]
fn a_soft_chain_hangs_longer_by_its_closed_form_whatever_the_sub_steps() {
    let n = 12usize;
    let cases = [(0.05f32, 0.1f32, 0.01f32), (2.0, 0.1, 1e-5), (1e-6, 1e-3, 2.0)];
    for (k, (mass, length, compliance)) in cases.into_iter().enumerate() {
        let start = chain(n, length, Vec3::ZERO, Vec3::NEG_Y, Particle { mass, drag: 0.6 * mass, ..Particle::REST });
        let ways = [(5, 0.0, false), (10, 0.0, true), (20, 0.1 * mass, false), (50, 0.0, false)];
        for (i, (substeps, damping, tether)) in ways.into_iter().enumerate() {
            let rope = Rope { compliance, damping, tether, ..Rope::rigid(all(&start), [length]) };
            // With all checks it takes long: one method for these sub-steps, others for those.
            for method in Method::ALL.iter().skip((4 * k + i) % every(9)).step_by(every(9)) {
                let forces = (DOWN, Drag {});
                let integrator = method.integrator();
                let scene =
                    Scene { start: &start, forces: &forces, constraints: &rope, substeps, integrator, ..Scene::EMPTY };
                let mut system = started(&scene, start.len(), 0);
                run(&mut system, &scene, 1.0 / 60.0, 1500);
                let n = n as f64;
                let longer = f64::from(compliance) * f64::from(mass) * G * n * (n + 1.0) / 2.0;
                let hangs = -f64::from(system.particles().position[12].y) - n * f64::from(length);
                let off = hangs / longer - 1.0;
                assert!(off.abs() < 0.01, "{method}, {substeps} sub-steps of {compliance} m/N: {off}");
            }
        }
    }
}

/// A bob up to a hundred thousand times as heavy as each of the links that hold it, which by far swing too fast for the sub-steps: lengths are kept, or
/// the report says that they are not met, and even then links hardly stretch. No energy comes of it.
#[test]
fn light_links_hold_heavy_bobs() {
    let cases = [1.0f32, 10.0, 1e3, 1e5].into_iter().flat_map(|ratio| [3, 10, 50, 128].map(|links| (ratio, links)));
    let mut number = 0;
    for (i, (ratio, links)) in cases.enumerate() {
        for (j, substeps) in [1u32, 5, 20].into_iter().enumerate() {
            let way = [Vec3::new(-0.093, -0.995, 0.035), Vec3::new(0.8, -0.6, 0.0), Vec3::X][(i + j) % 3].normalize();
            let scale = [1.0f32, 0.02, 50.0][(i / 3 + j) % 3];
            for method in [Method::Rk4, Method::Symplectic, Method::Verlet, Method::Midpoint] {
                if !is_run(&mut number) {
                    continue;
                }
                let length = scale / links as f32;
                let mut start = chain(links, length, Vec3::ZERO, way, Particle { mass: 1.0 / ratio, ..Particle::REST });
                start[links].mass = 1.0;
                let rope = Rope::rigid(all(&start), [length]);
                let forces = Gravity { acceleration: Vec3::NEG_Y * 9.81 * scale };
                let parts = Scene { start: &start, forces: &forces, constraints: &rope, ..Scene::EMPTY };
                let scene = Scene { substeps, integrator: method.integrator(), ..parts };
                let mut system = started(&scene, start.len(), 0);
                let begun = Measures::of(&system, &scene).energy.total();
                let mut longest = 0f64;
                for frame in 1..=often(60).max(12) as u64 {
                    system.step_to(&scene, Time::frame(frame, 60));
                    longest = longest.max(off(system.particles().position, f64::from(length))[1]);
                }
                let name = format!("{method}: {links} links, {ratio}, {substeps} sub-steps, {scale} m");
                let capped = system.totals().effort.capped;
                assert!(longest < if capped > 0 { 2e-2 } else { 1.2e-3 }, "{name}: {longest}");
                assert!(ratio > 10.0 || substeps < 5 || capped == 0, "{name}: {capped}");
                let gained = Measures::of(&system, &scene).energy.total() - begun;
                let mass = 1.0 + links as f64 / f64::from(ratio);
                assert!(gained < 0.02 * mass * G * f64::from(scale * scale), "{name}: {gained} J");
            }
        }
    }
}

/// Soft links answer weight by what it is, whatever the method shows of it within a sub-step.
#[test]
fn what_hangs_still_on_soft_links_shows_no_speed() {
    let mut cases = 0;
    for (mass, length, compliance) in [(0.1f32, 0.1f32, 0.01f32), (2.0, 0.5, 1e-3)] {
        for links in [1usize, 5] {
            let part = Particle { mass, drag: 2.0 * mass, ..Particle::REST };
            let start = chain(links, length, Vec3::ZERO, Vec3::NEG_Y, part);
            let rope = Rope { compliance, ..Rope::rigid(all(&start), [length]) };
            let rod = Distance { compliance, ..Distance::rod([0, 1], length) };
            let kinds: [&dyn Constraint; 2] = [&rope, &rod];
            for constraint in &kinds[..if links == 1 { 2 } else { 1 }] {
                for method in Method::ALL {
                    for substeps in [1, 5, 20] {
                        if !is_run(&mut cases) {
                            continue;
                        }
                        let forces = (DOWN, Drag {});
                        let parts = Scene { start: &start, forces: &forces, constraints: constraint, ..Scene::EMPTY };
                        let scene = Scene { substeps, integrator: method.integrator(), ..parts };
                        let mut system = started(&scene, start.len(), 0);
                        run(&mut system, &scene, 1.0 / 60.0, 1800);
                        let speed = system.particles().velocity.iter().fold(0f32, |most, v| most.max(v.length()));
                        let rate = 60.0 * substeps as f32;
                        let (falls, rounding) = (9.81 / rate, 4.0 * f32::EPSILON * links as f32 * length * rate);
                        assert!(speed < 0.01 * falls + rounding, "{method} {links} {substeps}: {speed} of {falls} m/s");
                    }
                }
            }
        }
    }
}

#[test]
fn ropes_that_cannot_be_met_are_counted() {
    // Held at both ends, a little nearer than they are long or a little farther apart; whatever a whip does is met.
    for (span, lack) in [(0.9f32, false), (1.1, true)] {
        let mut start = chain(10, 0.1 * span, Vec3::ZERO, Vec3::X, Particle { mass: 0.1, ..Particle::REST });
        start[10].fixed = true;
        let rope = Rope::rigid(all(&start), [0.1]);
        for (substeps, method) in [(1, Method::Symplectic), (7, Method::Verlet)] {
            let integrator = method.integrator();
            let scene =
                Scene { start: &start, forces: &DOWN, constraints: &rope, substeps, integrator, ..Scene::EMPTY };
            let mut system = started(&scene, start.len(), 0);
            let frames = often(30).max(10) as u32;
            run(&mut system, &scene, 1.0 / 60.0, frames);
            let expected = if lack { u64::from(frames * substeps) } else { 0 };
            assert_eq!(system.totals().effort.capped, expected, "{span} {substeps} {method}");
        }
    }
}

/// A metre of 128 links: hanging straight, falling from the level, hung far from the origin and with a weight at its end.
#[test]
fn a_rigid_chain_of_128_links_is_as_long_as_it_should_be() {
    let (length, mut cases) = (1.0 / 128.0, 0);
    for (from, way, weight) in [
        (Vec3::ZERO, Vec3::NEG_Y, 1.0),
        (Vec3::ZERO, Vec3::X, 1.0),
        (Vec3::new(30.0, -7.0, 4.0), Vec3::new(0.8, -0.6, 0.0), 1.0),
        (Vec3::ZERO, Vec3::NEG_Y, 10_000.0),
    ] {
        let mut start = chain(128, length, from, way, Particle { mass: 0.01, ..Particle::REST });
        start[128].mass *= weight;
        let rope = Rope::rigid(all(&start), [length]);
        for substeps in [5, 20, 50] {
            for method in [Method::Symplectic, Method::Verlet, Method::Rk4, Method::Implicit] {
                if !is_third(&mut cases) {
                    continue;
                }
                let integrator = method.integrator();
                let scene =
                    Scene { start: &start, forces: &DOWN, constraints: &rope, substeps, integrator, ..Scene::EMPTY };
                let mut system = started(&scene, start.len(), 0);
                for frame in 1..=often(90) as u64 {
                    system.step_to(&scene, Time::frame(frame, 60));
                    let [whole, worst] = off(system.particles().position, f64::from(length));
                    // Far from the origin places are no finer than 2e-6 m, a part in 4,000 of a link.
                    let rounding = 3.0 * f64::from(f32::EPSILON * from.length() / length);
                    assert!(
                        whole < 1e-4 && worst < 3e-4 + rounding,
                        "{method} {substeps} frame {frame}: {whole} {worst}"
                    );
                }
            }
        }
    }
}

#[test]
fn a_free_rope_keeps_both_momenta_to_rounding() {
    let (mut random, mut cases) = (Random::new(8), 0);
    for (scale, far, soft) in [(1.0f32, 0.0f32, 0.0f32), (1e-5, 0.0, 0.0), (300.0, 0.0, 1e-3), (1.0, 40.0, 0.0)] {
        let start: Vec<Particle> = (0..24)
            .map(|i| Particle {
                position: Vec3::new(0.1 * i as f32 + far, far, 0.02 * random.unit()) * scale,
                velocity: (Vec3::new(0.3, (i as f32 - 11.5) * 0.15, 0.1) + random.vector(0.1)) * scale,
                mass: random.magnitude(0.01, 3.0),
                ..Particle::REST
            })
            .collect();
        let between: Vec<f32> =
            lengths(&start.iter().map(|p| p.position).collect::<Vec<_>>()).iter().map(|&l| l as f32).collect();
        for (compliance, tether, closed) in [(0.0, false, false), (soft, false, true), (soft, true, false)] {
            let mut between = between.clone();
            if closed {
                between.push((start[0].position - start[23].position).length());
            }
            let rope = Rope { compliance, tether, closed, damping: 0.05, ..Rope::rigid(all(&start), between) };
            for method in [Method::Symplectic, Method::Verlet, Method::Euler, Method::Rk4] {
                if !is_third(&mut cases) {
                    continue;
                }
                let integrator = method.integrator();
                let scene = Scene { start: &start, constraints: &rope, substeps: 20, integrator, ..Scene::EMPTY };
                let mut system = started(&scene, start.len(), 0);
                let before = Measures::of(&system, &scene);
                let seconds = 4.0;
                run(&mut system, &scene, 1.0 / 60.0, often(240) as u32);
                let after = Measures::of(&system, &scene);
                let (mass, scale) = (start.iter().map(|p| f64::from(p.mass)).sum::<f64>(), f64::from(scale));
                // 4,800 sub-steps, each with its roundings of velocities; of places, far from the origin.
                let slow = gap(before.momentum, after.momentum) / (mass * scale);
                assert!(slow < 2e-5, "{method} at {scale} m: {slow}");
                let about = |m: &Measures, t: f64| {
                    // About where the middle would be.
                    let p = m.momentum;
                    let c = [0, 1, 2].map(|k| {
                        start.iter().map(|b| f64::from(b.mass) * f64::from(b.position[k])).sum::<f64>() / mass
                            + p[k] / mass * t
                    });
                    let l = m.angular_momentum;
                    [
                        l[0] - (c[1] * p[2] - c[2] * p[1]),
                        l[1] - (c[2] * p[0] - c[0] * p[2]),
                        l[2] - (c[0] * p[1] - c[1] * p[0]),
                    ]
                };
                let t = system.time().seconds_f64();
                let turn = gap(about(&before, 0.0), about(&after, t)) / gap(about(&before, 0.0), [0.0; 3]);
                let rounding = 1e-4 + 2e-4 * f64::from(far);
                assert!(turn < rounding, "{method} at {scale} m, {far}: {turn} in {seconds} s");
            }
        }
    }
}

/// With `Verlet` a chain of four swings as one of double precision does, the nearer the shorter the steps, and keeps its energy.
#[test]
fn energy_comes_back_with_the_square_of_the_step() {
    let length = 0.25;
    let mut start = chain(4, length, Vec3::ZERO, Vec3::X, Particle { mass: 0.3, ..Particle::REST });
    start[3].mass = 1.0;
    let rope = Rope::rigid(all(&start), [length]);
    let worst = [4, 8, 16].map(|substeps| {
        let scene = Scene {
            start: &start,
            forces: &DOWN,
            constraints: &rope,
            substeps,
            integrator: Method::Verlet.integrator(),
            ..Scene::EMPTY
        };
        let mut system = started(&scene, start.len(), 0);
        let before = Measures::of(&system, &scene).energy.total();
        (1..=45).fold(0f64, |worst, frame| {
            system.step_to(&scene, Time::frame(frame, 60));
            worst.max((Measures::of(&system, &scene).energy.total() - before).abs())
        })
    });
    // It turns over some 5 J.
    assert!(worst[0] < 0.1 && worst[1] < 0.4 * worst[0] && worst[2] < 0.4 * worst[1], "{worst:?}");
}

/// 1.2 m of rope over 1 m sag by 0.2923437976 m.
#[test]
fn a_rope_between_two_hooks_hangs_in_a_catenary() {
    let (links, frames) = if cfg!(debug_assertions) { (48, 600) } else { (96, 900) };
    let length = 1.2 / links as f32;
    for tether in [false, true] {
        let mut start: Vec<Particle> = (0..=links)
            .map(|i| {
                let s = i as f32 / links as f32;
                // A tent with sides of 0.6 m.
                let y = -0.331_662_5 * (1.0 - (2.0 * s - 1.0).abs());
                Particle { position: Vec3::new(s, y, 0.0), mass: 0.01, drag: 0.02, ..Particle::REST }
            })
            .collect();
        start[0].fixed = true;
        start[links].fixed = true;
        let rope = Rope { tether, ..Rope::rigid(all(&start), [length]) };
        let forces = (DOWN, Drag {});
        // With all checks it takes long: one of both for each.
        for method in [Method::Symplectic, Method::Rk4] {
            if cfg!(debug_assertions) && tether == (method == Method::Rk4) {
                continue;
            }
            let integrator = method.integrator();
            let scene =
                Scene { start: &start, forces: &forces, constraints: &rope, substeps: 10, integrator, ..Scene::EMPTY };
            let mut system = started(&scene, start.len(), 0);
            run(&mut system, &scene, 1.0 / 60.0, frames);
            let sag = -f64::from(system.particles().position[links / 2].y);
            assert!((sag - 0.292_343_797_6).abs() < 1e-4, "{method}: {sag}");
        }
    }
}

#[test]
fn a_damped_link_swings_down_by_its_logarithmic_decrement() {
    let (mass, compliance) = (0.5f64, 0.02f64);
    let omega = (1.0 / (mass * compliance)).sqrt();
    for zeta in [0.05, 0.2] {
        let damping = (2.0 * zeta * (mass / compliance).sqrt()) as f32;
        let hook = Particle { fixed: true, ..Particle::REST };
        let start = [hook, Particle { position: Vec3::X * 1.1, mass: mass as f32, ..Particle::REST }];
        let rope = Rope { compliance: compliance as f32, damping, ..Rope::rigid([0, 1], [1.0]) };
        let scene = Scene { start: &start, constraints: &rope, substeps: 1000, ..Scene::EMPTY };
        let mut system = started(&scene, 2, 0);
        // After each whole period of the damped oscillation.
        let period = core::f64::consts::TAU / (omega * f64::sqrt(1.0 - zeta * zeta));
        run(&mut system, &scene, period, 1);
        let decrement = (0.1 / (f64::from(system.particles().position[1].x) - 1.0)).ln();
        let right = core::f64::consts::TAU * zeta / (1.0 - zeta * zeta).sqrt();
        // The implicit step's own damping is ωh/2 = π/1000 to each: 0.02 in a period.
        assert!((decrement - right).abs() < 0.025, "{zeta}: {decrement}, not {right}");
    }
}

#[test]
fn a_string_is_slack_until_it_is_taut() {
    let start = chain(10, 0.05, Vec3::ZERO, Vec3::X, Particle { mass: 0.1, ..Particle::REST });
    let string = Rope::string(all(&start), [0.1]);
    for method in Method::ALL {
        let integrator = method.integrator();
        let scene =
            Scene { start: &start, forces: &DOWN, constraints: &string, substeps: 20, integrator, ..Scene::EMPTY };
        let mut system = started(&scene, start.len(), 0);
        let free = Scene { constraints: &(), ..scene };
        let mut falling = started(&free, start.len(), 0);
        for frame in 1..=180 {
            system.step_to(&scene, Time::frame(frame, 60));
            falling.step_to(&free, Time::frame(frame, 60));
            let x = system.particles().position;
            assert!(lengths(x).iter().all(|&l| l < 0.100_05), "{method} {frame}: {:?}", lengths(x));
            if frame <= 6 {
                // Its end falls freely until the first of the links is taut, after 0.13 s.
                assert_eq!(x[10], falling.particles().position[10], "{method}");
            }
        }
    }
}

/// A hoop that spins carries its own tension, whichever of its links closes it.
#[test]
fn a_closed_rope_spins() {
    for n in [3usize, 4, 5, 64] {
        for first in [0, 1, n / 2] {
            let start: Vec<Particle> = (0..n)
                .map(|i| {
                    let (s, c) = (core::f64::consts::TAU * ((i + first) % n) as f64 / n as f64).sin_cos();
                    let (position, velocity) =
                        (Vec3::new(c as f32, s as f32, 0.0), Vec3::new(-s as f32, c as f32, 0.0) * 3.0);
                    Particle { position, velocity, mass: 0.2, ..Particle::REST }
                })
                .collect();
            let side = 2.0 * (core::f64::consts::PI / n as f64).sin();
            let rope = Rope { closed: true, ..Rope::rigid(all(&start), [side as f32]) };
            let integrator = Method::Verlet.integrator();
            let scene = Scene { start: &start, constraints: &rope, substeps: 10, integrator, ..Scene::EMPTY };
            let mut system = started(&scene, n, 0);
            for frame in 1..=60 {
                system.step_to(&scene, Time::frame(frame, 60));
                for (x, v) in system.particles().position.iter().zip(system.particles().velocity) {
                    assert!(
                        (x.length() - 1.0).abs() < 2e-3 && (v.length() - 3.0).abs() < 6e-3,
                        "{n}, frame {frame}: {x} {v}"
                    );
                }
            }
        }
    }
}

/// Chains that cannot be met or have nothing to go by do no harm: all stays finite and slow.
#[test]
fn nothing_breaks_a_rope() {
    let at = |x: f32, fixed: bool| Particle { position: Vec3::X * x, fixed, ..Particle::REST };
    let brief = Particle { lifetime: 0.2, ..at(0.2, false) };
    let loose = |x: f32| at(x, false);
    let starts: [&[Particle]; 8] = [
        // Too long and too short between two that are fixed; all fixed; all in one place.
        &[at(0.0, true), loose(1.0), loose(2.0), at(3.0, true)],
        &[at(0.0, true), loose(0.01), loose(0.02), at(0.03, true)],
        &[at(0.0, true), at(0.1, true), at(0.2, true), at(0.7, true)],
        &[loose(0.0), loose(0.0), loose(0.0), loose(0.0)],
        // One that dies, and with it both of its links.
        &[at(0.0, true), loose(0.1), brief, loose(0.3)],
        &[brief, brief, brief, brief],
        // Masses very unlike, and lengths.
        &[at(0.0, true), Particle { mass: 1e-6, ..loose(0.1) }, Particle { mass: 1e4, ..loose(0.2) }, loose(0.3)],
        &[loose(0.0), loose(1e-20), loose(1e-7), loose(5.0)],
    ];
    let mut cases = 0;
    for start in starts {
        for (length, tether, closed, compliance) in [
            (0.1f32, false, false, 0.0f32),
            (0.1, true, true, 0.0),
            (0.0, false, true, 0.0),
            (0.1, true, false, 1e-4),
            (7.0, false, true, 0.0),
        ] {
            let rope = Rope { compliance, damping: 0.1, tether, closed, ..Rope::rigid([0, 1, 2, 3], [length]) };
            for method in Method::ALL {
                for substeps in [1, 9] {
                    if !is_run(&mut cases) {
                        continue;
                    }
                    let integrator = method.integrator();
                    let scene =
                        Scene { start, forces: &DOWN, constraints: &rope, substeps, integrator, ..Scene::EMPTY };
                    let mut system = started(&scene, 4, 0);
                    run(&mut system, &scene, 1.0 / 60.0, often(60).max(20) as u32);
                    let there = system.particles();
                    for (x, v) in there.position.iter().zip(there.velocity) {
                        assert!(
                            x.is_finite() && v.length() < 1500.0,
                            "{start:?} {length} {method} {substeps}: {x} {v}"
                        );
                    }
                    assert!(there.position.len() as u64 == 4 - system.totals().died.total());
                    assert_eq!(system.totals().died.nonfinite, 0);
                }
            }
        }
    }
    // Names of nobody, too few names, no lengths at all.
    let start = [loose(0.0), loose(0.1)];
    for particles in [&[][..], &[0], &[0, 7], &[9, 1, 0, u32::MAX], &[0, 0], &[0, 1, 0, 1]] {
        for lengths in [&[][..], &[0.1, 0.2, 0.3, 0.4]] {
            let rope = Rope { closed: true, ..Rope::rigid(particles, lengths) };
            let scene = Scene { start: &start, constraints: &rope, substeps: 3, ..Scene::EMPTY };
            let mut system = started(&scene, 2, 0);
            run(&mut system, &scene, 1.0 / 60.0, 30);
            assert!(system.particles().position.iter().all(|x| x.is_finite()));
        }
    }
}

/// The end of a whip is faster than any sub-step can follow: it is slowed, and never driven.
#[test]
fn whips_gain_nothing() {
    let length = 1.0 / 64.0;
    for way in [Vec3::X, Vec3::new(0.6, 0.8, 0.0)] {
        let start = chain(64, length, Vec3::ZERO, way, Particle { mass: 0.01, ..Particle::REST });
        let rope = Rope::rigid(all(&start), [length]);
        for (substeps, method) in
            [(1, Method::Symplectic), (2, Method::Rk4), (5, Method::Verlet), (20, Method::Symplectic)]
        {
            let integrator = method.integrator();
            let scene =
                Scene { start: &start, forces: &DOWN, constraints: &rope, substeps, integrator, ..Scene::EMPTY };
            let mut system = started(&scene, start.len(), 0);
            let before = Measures::of(&system, &scene).energy.total();
            for frame in 1..=often(240) as u64 {
                system.step_to(&scene, Time::frame(frame, 60));
                // What is slowed by half a sub-step more than it has been: velocities of a method of first order are as old as that.
                let old = if method == Method::Symplectic { 0.5 / (60.0 * f64::from(substeps)) } else { 0.0 };
                let falls: f64 = system.particles().velocity.iter().map(|v| -f64::from(v.y) * 0.01 * G).sum();
                let gained = Measures::of(&system, &scene).energy.total() - before + old * falls;
                assert!(gained < 0.01, "{method} in {substeps}, frame {frame}: {gained} J of some 6");
            }
        }
    }
}

/// A rope of one link is a rod, and one that is its own chain of rods hangs as they do with many sub-steps.
#[test]
fn ropes_agree_with_rods() {
    let start = chain(3, 0.2, Vec3::ZERO, Vec3::X, Particle { mass: 0.1, ..Particle::REST });
    let rope = Rope::rigid(all(&start), [0.2]);
    let rods = [0, 1, 2].map(|i| Distance::rod([i, i + 1], 0.2));
    let scene = Scene { start: &start, forces: &DOWN, constraints: &rope, substeps: 200, ..Scene::EMPTY };
    let others = Scene { constraints: &rods, ..scene };
    let [mut a, mut b] = [started(&scene, 4, 0), started(&others, 4, 0)];
    run(&mut a, &scene, 1.0 / 60.0, 30);
    run(&mut b, &others, 1.0 / 60.0, 30);
    for (x, y) in a.particles().position.iter().zip(b.particles().position) {
        assert!(x.distance(*y) < 0.02, "{x} {y}");
    }
}

#[test]
fn files_name_ropes_and_say_what_is_wrong_with_them() {
    let file = |rope: &str| {
        let particles = r#"[{"position": [0, 0, 0]}, {"position": [1, 0, 0]}, {"position": [2, 0, 0]}]"#;
        SceneFile::from_json("it", &format!(r#"{{"particles": {particles}, "constraints": [{{"rope": {rope}}}]}}"#))
            .and_then(|scene| scene.check().map(|()| scene))
    };
    let sound = file(
        r#"{"particles": [0, 1, 2], "lengths": [1], "compliance": 1e-4, "damping": 2, "tether": true, "closed": true}"#,
    );
    let sound = sound.unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(SceneFile::from_json("again", &sound.to_json()), Ok(sound));
    for (rope, what) in [
        (r#"{"particles": [0], "lengths": [1]}"#, "constraints[0].rope.particles"),
        (r#"{"particles": [0, 1], "lengths": [1], "closed": true}"#, "three particles"),
        (r#"{"particles": [0, 1, 0], "lengths": [1]}"#, "twice"),
        (r#"{"particles": [0, 3], "lengths": [1]}"#, "particle 3 is out of range"),
        (r#"{"particles": [0, 1], "lengths": []}"#, "constraints[0].rope.lengths"),
        (r#"{"particles": [0, 1], "lengths": [1, 1]}"#, "more lengths"),
        (r#"{"particles": [0, 1], "lengths": [-1]}"#, "below zero"),
        (r#"{"particles": [0, 1], "lengths": [1], "compliance": -1}"#, "m/N"),
        (r#"{"particles": [0, 1], "lengths": [1], "damping": -1}"#, "N s/m"),
        (r#"{"particles": [0, 1], "length": [1]}"#, "length"),
    ] {
        let error = file(rope).expect_err(rope).to_string();
        assert!(error.contains(what), "{rope}: {error}");
    }
}
