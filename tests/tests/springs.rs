//! Springs: closed forms, and what becomes of them when their ends die.

use core::f64::consts::PI;
use pointmass::force::{Drive, SpringList};
use pointmass::{
    ClothSprings, Drag, Emitter, Force, Gravity, Heap, Measures, Method, Particle, Scene, Sheet, Size, Spring,
    SpringParams, System, Time, Vec3, mesh_springs,
};
use pointmass_tests::{Random, f64s, gap, icosahedron, point, run, started};

fn at(x: f32) -> Particle {
    Particle { position: Vec3::X * x, ..Particle::REST }
}

#[test]
fn two_bodies_on_a_damped_spring() {
    let start = [at(0.0), Particle { mass: 3.0, ..at(1.2) }];
    let springs = [Spring::new([0, 1], 1.0, 50.0).damped(2.0)];
    for (method, n, tolerance) in [(Method::Rk4, 60, 2e-6), (Method::Verlet, 480, 2e-5), (Method::Midpoint, 480, 2e-5)]
    {
        let integrator = method.integrator();
        let scene = Scene { start: &start, springs: &springs, integrator, ..Scene::EMPTY };
        for (t, distance) in [(0.25, 0.959_995_778_4), (0.5, 0.921_892_876_9), (1.0, 0.998_004_687_1)] {
            let mut system = started(&scene, 2, 0);
            run(&mut system, &scene, 1.0 / f64::from(n), (t * f64::from(n)) as u32);
            let p = system.particles();
            // RK4: (h ω)⁴ / 120 with h ω = 0.14, and rounding of 6e-8 at a time; order 2: (h ω)² / 12 of 0.2 m.
            let d = gap(f64s(p.position[0]), f64s(p.position[1]));
            assert!((d - distance).abs() < tolerance, "{method} at {t} s: {d}");
            let momentum = Measures::of(&system, &scene).momentum;
            assert!(gap(momentum, [0.0; 3]) < 1e-6);
        }
    }
}

#[test]
fn critical_damping_does_not_overshoot() {
    // 2 √(m k) against an anchor, 2 √(μ k) between two free bodies, μ = m / 2.
    let k = 40.0f32;
    for (fixed, critical) in [(true, 2.0 * k.sqrt()), (false, 2.0 * (0.5 * k).sqrt())] {
        for (share, overshoots) in [(0.8, true), (1.0, false), (1.5, false)] {
            let start = [Particle { fixed, ..at(0.0) }, at(1.5)];
            let springs = [Spring::new([0, 1], 1.0, k).damped(share * critical)];
            let integrator = Method::Rk4.integrator();
            let scene = Scene { start: &start, springs: &springs, integrator, ..Scene::EMPTY };
            let mut system = started(&scene, 2, 0);
            let mut shortest = f32::INFINITY;
            for i in 1..=480 {
                system.step(&scene, Time::frame(i, 240) - system.time());
                let p = system.particles();
                shortest = shortest.min((p.position[1] - p.position[0]).length());
            }
            // The bound is for rounding; the overshoot itself would be e^(−4π/3) = 1.5 % of 0.5 m.
            assert_eq!(shortest < 1.0 - 1e-5, overshoots, "{share} of critical, fixed {fixed}: {shortest}");
        }
    }
}

/// Ten masses of 0.1 kg between two fixed ends, 0.1 m apart, on springs of 100 N/m, displaced by 5 mm in mode `j`.
fn chain(j: u32) -> (Vec<Particle>, Vec<Spring>) {
    let shape = |i: u32| 0.005 * (PI * f64::from(i * j) / 11.0).sin();
    let place = |i: u32| (0.1 * f64::from(i) + if i.is_multiple_of(11) { 0.0 } else { shape(i) }) as f32;
    let start = (0..12).map(|i: u32| Particle { mass: 0.1, fixed: i.is_multiple_of(11), ..at(place(i)) }).collect();
    let springs = (0..11).map(|i| Spring::new([i, i + 1], 0.1, 100.0)).collect();
    (start, springs)
}

#[test]
fn a_chain_swings_in_its_normal_modes() {
    for j in 1..=10 {
        let omega = 2.0 * 1000f64.sqrt() * (f64::from(j) * PI / 22.0).sin();
        assert!(j != 1 || (omega - 9.000_780_7).abs() < 1e-6);
        assert!(j != 10 || (omega - 62.601_804_7).abs() < 1e-6);
        let (start, springs) = chain(j);
        let integrator = Method::Rk4.integrator();
        let scene = Scene { start: &start, springs: &springs, integrator, ..Scene::EMPTY };
        let system = started(&scene, 12, 0);
        let amplitude = |system: &System<Heap>| {
            let offset = |i: usize| f64::from(system.particles().position[i].x) - 0.1 * i as f64;
            (0..12).map(|i| offset(i) * (PI * i as f64 * f64::from(j) / 11.0).sin()).sum::<f64>() / 5.5
        };
        let first = amplitude(&system);
        // A thousand steps to 5 s: RK4's phase lags by (h ω)⁵ / 120 a step, at the most 3e-4 in all. Rounding of 1 m
        // by 6e-8 a step, as a random walk, is 1e-6 of 5 mm = 4e-4.
        for quarter in [1.0, 2.5, 5.0] {
            let mut system = started(&scene, 12, 0);
            run(&mut system, &scene, 0.001, (quarter * 1000.0) as u32);
            let share = amplitude(&system) / first;
            let exact = (omega * quarter).cos();
            assert!((share - exact).abs() < 2e-3, "mode {j} at {quarter} s: {share}, not {exact}");
            assert_eq!(system.particles().position[0], start[0].position);
        }
    }
}

#[test]
fn a_chain_s_largest_verlet_step() {
    let (start, springs) = chain(10);
    for (h, holds) in [(0.99 * 0.031_948_0, true), (1.01 * 0.031_948_0, false)] {
        let integrator = Method::Verlet.integrator();
        let scene = Scene { start: &start, springs: &springs, integrator, ..Scene::EMPTY };
        let mut system = started(&scene, 12, 0);
        run(&mut system, &scene, h, 60);
        let worst = (0..system.len()).map(|i| (system.particles().position[i].x - 0.1 * i as f32).abs());
        // A hundredth beyond the limit grows by e^0.28 a step.
        assert_eq!(worst.fold(0.0, f32::max) < 0.04, holds, "{h}");
    }
}

#[test]
fn a_rope_hangs_as_low_as_its_statics_say() {
    let start: Vec<Particle> =
        (0..=20).map(|i| Particle { mass: 0.05, drag: 0.2, fixed: i % 20 == 0, ..at(0.05 * i as f32) }).collect();
    let springs: Vec<Spring> = (0..20).map(|i| Spring::new([i, i + 1], 0.06, 200.0).damped(0.5)).collect();
    for (method, frames) in [(Method::Rk4, 120), (Method::Verlet, 240), (Method::Symplectic, 240)] {
        let (forces, integrator) = ((Gravity::EARTH, Drag {}), method.integrator());
        let scene = Scene { start: &start, springs: &springs, forces: &forces, integrator, ..Scene::EMPTY };
        let mut system = started(&scene, 21, 0);
        run(&mut system, &scene, 1.0 / f64::from(frames), 30 * frames);
        let p = system.particles();
        let lowest = p.position.iter().map(|x| f64::from(-x.y)).fold(0.0, f64::max);
        // At rest all methods agree. What is left: rounding of forces of 200 N/m × 6e-8 m, and the last of the swing.
        assert!((lowest - 0.525_740_722_2).abs() < 5e-6, "{method}: {lowest}");
        let fastest = p.velocity.iter().map(|v| v.length()).fold(0.0, f32::max);
        assert!(fastest < 1e-4, "{method}: {fastest}");
        assert_eq!((p.position[0], p.position[20]), (start[0].position, start[20].position));
    }
}

#[test]
fn a_fixed_particle_never_moves() {
    let start = [
        Particle { fixed: true, velocity: Vec3::ONE, mass: 0.0, position: Vec3::new(0.1, 0.2, 0.3), ..Particle::REST },
        at(5.0),
    ];
    let springs = [Spring::new([0, 1], 1.0, 30.0).damped(1.0)];
    for &method in Method::ALL {
        let (forces, integrator) = ((Gravity::EARTH, Drag {}), method.integrator());
        let scene = Scene { start: &start, springs: &springs, forces: &forces, integrator, ..Scene::EMPTY };
        let mut system = started(&scene, 2, 0);
        run(&mut system, &scene, 1.0 / 60.0, 300);
        let p = system.particles();
        assert_eq!((p.position[0], p.velocity[0]), (start[0].position, Vec3::ZERO), "{method}");
        assert!((p.position[1] - start[1].position).length() > 0.1);
    }
}

#[test]
fn a_fixed_particle_outlives_whatever_pulls_at_it() {
    // The other end is so far away that the force overflows.
    let start = [Particle { fixed: true, ..at(0.0) }, at(1e30)];
    let springs = [Spring::new([0, 1], 1.0, 1e20)];
    let scene = Scene { start: &start, springs: &springs, ..Scene::EMPTY };
    let mut system = started(&scene, 2, 0);
    run(&mut system, &scene, 0.01, 3);
    let fixed = system.particles().position.iter().filter(|&&x| x == Vec3::ZERO).count();
    assert_eq!(fixed, 1, "it never moves, and so it cannot leave the numbers");
}

#[test]
fn a_spring_that_loses_an_end_is_gone_and_counted_once() {
    // 0 dies after 0.1 s, 1 and 2 together after 0.2 s, 3 and 4 live.
    let lives = [0.1, 0.2, 0.2, 0.0, 0.0];
    let start: Vec<Particle> = (0..5).map(|i| Particle { lifetime: lives[i], ..at(2.0 * i as f32) }).collect();
    let spring = |a, b| Spring::new([a, b], 1.0, 1.0);
    let springs = [spring(0, 1), spring(1, 2), spring(3, 0), spring(2, 3), spring(3, 4)];
    let scene = Scene { start: &start, springs: &springs, ..Scene::EMPTY };
    let mut system = started(&scene, 5, 0);
    let mut lost = vec![];
    for i in 1..=30 {
        let report = system.step(&scene, Time::frame(i, 60) - system.time());
        if report.caps.springs > 0 {
            lost.push((i, report.caps.springs));
        }
    }
    // With 0 go the first and third; with 1 and 2 the second, once, and the fourth.
    assert_eq!(lost, [(6, 2), (12, 2)]);
    assert_eq!(system.totals().caps.springs, 4);
    // 3 and 4 alone are left on their spring, and keep the momentum they had.
    let state = system.state(&scene);
    let mut total = [Vec3::ZERO; 2];
    state.springs.add_to(&state, 0..2, &mut total);
    let stretch = gap(f64s(state.position[0]), f64s(state.position[1])) - 1.0;
    assert!((f64::from(total[0].x.abs()) - stretch).abs() < 1e-6 && total[0] == -total[1]);
    assert!((state.springs.energy(&state) - 0.5 * stretch * stretch).abs() < 1e-6);
}

#[test]
fn a_spring_whose_end_is_removed_by_hand_is_counted_too() {
    let start = [at(0.0), at(2.0)];
    let springs = [Spring::new([0, 1], 1.0, 1.0)];
    let scene = Scene { start: &start, springs: &springs, ..Scene::EMPTY };
    let mut system = started(&scene, 2, 0);
    let id = system.id(0).expect("it is there");
    assert!(system.remove(&scene, id));
    system.step(&scene, Time::SECOND);
    assert_eq!(system.particles().position, [start[1].position]);
    assert_eq!(system.totals().caps.springs, 1);
}

#[test]
fn a_spring_from_a_particle_to_itself_does_nothing() {
    let start = [Particle { lifetime: 0.5, ..at(1.0) }];
    let springs = [Spring::new([0, 0], 1.0, 1.0).damped(1.0)];
    let scene = Scene { start: &start, springs: &springs, ..Scene::EMPTY };
    let mut system = started(&scene, 1, 0);
    system.step(&scene, Time::from_seconds(0.25));
    assert_eq!(system.particles().position, [start[0].position]);
    system.step(&scene, Time::SECOND);
    assert!(system.totals().caps.springs <= 1, "there is but one spring");
}

#[test]
fn a_spring_to_a_particle_that_found_no_room_is_counted() {
    let start = [at(0.0), at(2.0), at(4.0)];
    let spring = |a, b| Spring::new([a, b], 1.0, 1.0);
    let springs = [spring(0, 1), spring(1, 2), spring(7, 0)];
    let scene = Scene { start: &start, springs: &springs, ..Scene::EMPTY };
    let mut system = started(&scene, 2, 0);
    assert_eq!((system.totals().refused, system.totals().caps.springs), (1, 2));
    run(&mut system, &scene, 0.01, 10);
    // Only the first is there: both are pulled alike.
    let p = system.particles();
    assert_eq!(p.velocity[0], -p.velocity[1]);
}

#[test]
fn a_newborn_in_a_dead_one_s_place_is_not_attached() {
    let start = [Particle { lifetime: 0.1, ..at(0.0) }, Particle { mass: 2.0, ..at(2.0) }];
    let springs = [Spring::new([0, 1], 1.0, 5.0)];
    let emitter = Emitter { start: 0.5, ..Emitter::new(point(Vec3::Y * 9.0), 10.0) };
    let scene = Scene { start: &start, springs: &springs, emitters: &emitter, ..Scene::EMPTY };
    let mut system = started(&scene, 2, 0);
    run(&mut system, &scene, 1.0 / 60.0, 6);
    assert_eq!((system.len(), system.totals().caps.springs), (1, 1));
    let velocity = system.particles().velocity[0];
    run(&mut system, &scene, 1.0 / 60.0, 120);
    assert_eq!(system.len(), 2);
    let newborn = system.id(1).expect("it is there");
    assert_eq!((newborn.slot(), newborn.serial()), (0, 2), "it has the place of the dead one");
    let p = system.particles();
    assert_eq!((p.velocity[0], p.position[1], p.velocity[1]), (velocity, Vec3::Y * 9.0, Vec3::ZERO));
}

#[test]
fn a_newborn_is_not_taken_for_a_particle_that_the_start_lacks() {
    // The spring names particle 2, but the start has only 0 and 1; the first newborn comes third into the system.
    let start = [at(0.0), at(2.0)];
    let springs = [Spring::new([1, 2], 1.0, 5.0)];
    let emitter = Emitter::new(point(Vec3::Y * 9.0), 10.0);
    let scene = Scene { start: &start, springs: &springs, emitters: &emitter, ..Scene::EMPTY };
    let mut system = started(&scene, 10, 0);
    assert_eq!(system.totals().caps.springs, 1, "the spring is lost from the beginning");
    run(&mut system, &scene, 1.0 / 60.0, 60);
    assert_eq!(system.particles().velocity[1], Vec3::ZERO, "a lost spring pulls nobody");
}

#[test]
fn the_order_of_the_springs_is_a_matter_of_rounding() {
    let mut random = Random::new(8);
    let start: Vec<Particle> = (0..30).map(|_| Particle { position: random.vector(1.0), ..Particle::REST }).collect();
    let springs: Vec<Spring> =
        (0..60).map(|i| Spring::new([i % 30, (i * 11 + 1) % 30], 0.4, 9.0).damped(0.2)).collect();
    let end = |springs: &[Spring]| {
        let scene = Scene { start: &start, springs: &springs, integrator: Method::Verlet.integrator(), ..Scene::EMPTY };
        let mut system = started(&scene, 30, 0);
        run(&mut system, &scene, 1.0 / 60.0, 60);
        system.particles().position.to_vec()
    };
    let (one, mut backwards) = (end(&springs), springs.clone());
    backwards.reverse();
    let other = end(&backwards);
    // 60 steps of about 20 terms' rounding in a system that is not chaotic within a second.
    assert!(one.iter().zip(&other).all(|(a, b)| (*a - *b).length() < 1e-4));
    assert_ne!(one, other, "sums in another order round otherwise");
    // The ends may be named either way, and springs that share no end may change places, to the bit.
    let mut turned = springs.clone();
    turned.iter_mut().for_each(|s| s.ends.reverse());
    assert_eq!(end(&turned), one);
    let mut swapped = springs.clone();
    for i in 1..swapped.len() {
        let [a, b] = [swapped[i - 1], swapped[i]];
        if a.ends.iter().all(|end| !b.ends.contains(end)) {
            swapped.swap(i - 1, i);
        }
    }
    assert_ne!(swapped, springs);
    assert_eq!(end(&swapped), one);
}

#[test]
fn a_driven_spring_follows_its_drive_for_ever() {
    // So stiff and damped that its length is its rest length; after a day and a half the phase is as right as at once.
    let drive = Some(Drive { amplitude: 0.25, frequency: 1.0, phase: 0.25 });
    let spring = Spring { drive, ..Spring::new([0, 1], 2.0, 1e4).damped(200.0) };
    for seconds in [0.0, 0.125, 0.5, 1e5, 131_072.25] {
        let time = Time::from_seconds_f64(seconds);
        let expected = 2.0 * (1.0 + 0.25 * (std::f64::consts::TAU * (seconds.fract() + 0.25)).sin());
        assert!((f64::from(spring.rest(time)) - expected).abs() < 1e-6, "{seconds}");
    }
    let start = [Particle { fixed: true, ..Particle::REST }, at(2.5)];
    let scene = Scene { start: &start, springs: &[spring], integrator: &Method::Rk4, ..Scene::EMPTY };
    let mut system = started(&scene, 2, 0);
    run(&mut system, &scene, 1e-3, 5000);
    let length = system.particles().position[1].x;
    assert!((length - 2.5).abs() < 0.01, "{length}");
}

#[test]
fn a_spring_breaks_once_and_for_ever() {
    let weak = Spring { breaks_at: Some(1.5), ..Spring::new([0, 1], 1.0, 100.0) };
    let strong = Spring { breaks_at: Some(9.0), ..Spring::new([1, 2], 1.0, 100.0) };
    let start = [at(0.0), at(1.0), Particle { velocity: Vec3::X * 24.0, ..at(2.0) }];
    let scene = Scene { start: &start, springs: &[weak, strong], integrator: &Method::Rk4, ..Scene::EMPTY };
    let mut system = started(&scene, 3, 0);
    let mut breaks = vec![];
    for frame in 1..=600 {
        if system.step(&scene, Time::frame(frame, 600) - system.time()).broken > 0 {
            breaks.push(frame);
        }
        let p = system.particles();
        let stretched = p.position[1].x - p.position[0].x > 1.5;
        assert!(!stretched || !breaks.is_empty(), "{frame}");
    }
    assert_eq!((breaks.len(), system.totals().broken, system.totals().caps.springs), (1, 1, 0));
    let springs = system.state(&scene).springs;
    assert_eq!([0, 1].map(|number| springs.is_broken(number)), [true, false]);
    assert_eq!(springs.ends().collect::<Vec<_>>(), [[1, 2]]);
    // Its end is free now: it goes on as it went.
    let v = system.particles().velocity[0];
    system.step(&scene, Time::SECOND);
    assert_eq!(system.particles().velocity[0], v);
    // The fingerprint sees it, and a new start mends it.
    let (hash, time) = (system.hash(), system.time());
    system.start(&scene, 0).expect("it fits");
    assert!(!system.state(&scene).springs.is_broken(0) && hash != system.hash() && time > Time::ZERO);
}

/// Who broke is kept with the state: a copy of a system made while springs break goes on as the system does, to the bit, whoever has died
/// meanwhile and whichever row became whose; so does one that goes on with the same springs in other scenes.
#[test]
fn springs_that_broke_stay_broken_in_a_copy() {
    let start: Vec<_> = (0..40)
        .map(|i| Particle {
            velocity: Vec3::X * (0.4 * (i * i % 17) as f32),
            lifetime: if i % 7 == 3 { 0.9 } else { 0.0 },
            ..at(i as f32)
        })
        .collect();
    let springs: Vec<_> = (0..39)
        .map(|i| Spring { breaks_at: (i % 2 == 0).then_some(1.2), ..Spring::new([i, i + 1], 1.0, 30.0) })
        .collect();
    for method in Method::ALL {
        for fps in [30, 120] {
            let scene = Scene { start: &start, springs: &springs, integrator: method.integrator(), ..Scene::EMPTY };
            let mut system = started(&scene, start.len(), 0);
            let mut copies = vec![];
            for frame in 1..=2 * fps {
                if frame % (fps / 5) == 0 {
                    copies.push((frame, system.clone()));
                }
                system.step_to(&scene, Time::frame(u64::from(frame), fps));
            }
            let broken = |system: &System<Heap>| {
                let table = system.state(&scene).springs;
                (0..39).filter(|&number| table.is_broken(number)).collect::<Vec<_>>()
            };
            let last = broken(&system);
            assert!(last.len() > 3 && last.len() as u64 == system.totals().broken, "{method}: {last:?}");
            let mut some_were_broken = 0;
            for (next, mut copy) in copies {
                let before = broken(&copy);
                assert_eq!(before.len() as u64, copy.totals().broken);
                some_were_broken += usize::from(!before.is_empty() && before.len() < last.len());
                // Seen by a scene in which nothing can break them, they are as broken.
                let calm = Scene { forces: &(), ..scene };
                assert_eq!(copy.state(&calm).springs.held().count(), copy.state(&scene).springs.held().count());
                for frame in next..=2 * fps {
                    copy.step_to(&scene, Time::frame(u64::from(frame), fps));
                    let now = broken(&copy);
                    assert!(before.iter().all(|number| now.contains(number)), "{method}: mended");
                }
                assert_eq!((copy.hash(), broken(&copy)), (system.hash(), last.clone()), "{method}, {next} of {fps}");
            }
            assert!(some_were_broken > 0, "{method}");
        }
    }
}

/// Two systems that differ in who broke alone differ in their fingerprints.
#[test]
fn fingerprints_tell_which_springs_broke() {
    let start = [at(0.0), at(2.0), at(4.0), at(6.0)];
    let hashes = [[true, false, false], [false, true, false], [false, false, true], [false; 3]].map(|weak| {
        // They pull with no force.
        let spring = |i: u32| Spring {
            breaks_at: Some(if weak[i as usize] { 1.5 } else { 9.0 }),
            ..Spring::new([i, i + 1], 1.0, 0.0)
        };
        let springs = [0, 1, 2].map(spring);
        let scene = Scene { start: &start, springs: &springs, ..Scene::EMPTY };
        let mut system = started(&scene, 4, 0);
        let broken = system.step(&scene, Time::SECOND).broken;
        assert_eq!(broken, weak.iter().map(|&weak| u64::from(weak)).sum::<u64>());
        system.hash()
    });
    assert!((0..4).all(|i| (0..i).all(|j| hashes[i] != hashes[j])));
}

#[test]
fn a_sheet_has_the_springs_it_should() {
    let thread = Some(SpringParams { ks: 10.0, kd: 0.1 });
    let threads = ClothSprings { structural: thread, shear: thread, bend: thread };
    let sheet = Sheet { corner: Vec3::ONE, sides: [Vec3::X * 2.0, Vec3::Z * 3.0], cells: [4, 6] };
    let places: Vec<Vec3> = sheet.positions().collect();
    let springs: Vec<Spring> = sheet.springs(&threads, 100).collect();
    assert_eq!((places.len(), places[0], places[34]), (35, Vec3::ONE, Vec3::new(3.0, 1.0, 4.0)));
    let structural = 4 * 7 + 5 * 6;
    assert_eq!(springs.len(), structural + 2 * 4 * 6 + 3 * 7 + 5 * 5);
    let mut seen = std::collections::BTreeSet::new();
    for spring in springs {
        let [a, b] = spring.ends.map(|end| (end - 100) as usize);
        assert!((places[a].distance(places[b]) - spring.rest_length).abs() < 1e-6);
        assert!(spring.rest_length <= 1.0 + 1e-6 && a != b && seen.insert((a.min(b), a.max(b))));
    }
    assert_eq!(sheet.triangles().count(), 48);
    let flat = Sheet { cells: [3, 0], ..sheet };
    assert_eq!((flat.positions().count(), flat.springs(&threads, 0).count()), (4, 3 + 2));
}

#[test]
fn a_mesh_has_a_spring_for_every_edge_and_one_over_it() {
    let (vertices, triangles) = icosahedron();
    let threads = ClothSprings { structural: Some(SpringParams { ks: 5.0, kd: 0.0 }), ..ClothSprings::default() };
    assert_eq!(mesh_springs(&vertices, &triangles, &threads, 0).len(), 30);
    let threads = ClothSprings { bend: threads.structural, ..threads };
    let springs = mesh_springs(&vertices, &triangles, &threads, 7);
    assert_eq!(springs.len(), 60);
    for spring in springs {
        let [a, b] = spring.ends.map(|end| vertices[end as usize - 7]);
        assert!((a.distance(b) - spring.rest_length).abs() < 1e-6 && spring.rest_length > 0.5);
    }
}

#[test]
fn springs_that_broke_are_found_among_many() {
    // All at one particle, one of them from it to itself.
    let start: Vec<_> = (0..60).map(|i| at(i as f32)).collect();
    let springs: Vec<_> = (0..60)
        .map(|i| Spring {
            breaks_at: Some(if i % 3 == 0 { 1.5 } else { 9.0 }),
            ..Spring::new([0, i], 0.5 * i as f32, 1e-3)
        })
        .collect();
    let scene = Scene { start: &start, springs: &springs, ..Scene::EMPTY };
    let mut system = started(&scene, start.len(), 0);
    assert_eq!(system.step(&scene, Time::frame(1, 60)).broken, 19);
    let table = system.state(&scene).springs;
    assert!((0..60).all(|number| table.is_broken(number) == (number > 0 && number % 3 == 0)));
    assert_eq!(table.held().count(), 40);
    assert_eq!(system.step(&scene, Time::frame(1, 60)).broken, 0);
}

#[test]
fn springs_that_broke_in_an_earlier_scene_leave_no_trace() {
    let start = [at(0.0), at(1.0), at(2.0)];
    let springs = [0, 1].map(|i| Spring { breaks_at: Some(1.5), ..Spring::new([i, i + 1], 0.5, 1.0) });
    let many = Scene { start: &start, springs: &springs, ..Scene::EMPTY };
    let none = Scene { springs: &(), ..many };
    let mut used = started(&many, 3, 0);
    let mut fresh = used.clone();
    assert_eq!(used.step(&many, Time::frame(1, 60)).broken, 2);
    for system in [&mut used, &mut fresh] {
        system.start(&none, 0).expect("it fits");
    }
    assert_eq!(used.hash(), fresh.hash());
}

#[test]
fn a_sheet_beyond_all_numbers_is_refused() {
    let most = u32::MAX;
    let sheet = format!(r#"{{"corner": [0, 0, 0], "sides": [[1, 0, 0], [0, 0, 1]], "cells": [{most}, {most}]}}"#);
    let cloth = format!(r#"{{"form": {{"sheet": {sheet}}}, "mass": 1, "springs": {{"structural": {{"ks": 1}}}}}}"#);
    let text = format!(r#"{{"cloths": [{cloth}, {cloth}]}}"#);
    let file = pointmass::scene::SceneFile::from_json("a.json", &text).expect("it is well-formed");
    let error = file.check().expect_err("it is too large").to_string();
    assert!(error.contains("cloths[0].form"), "{error}");
}

/// A system that goes on with other springs has those, as if it had begun with them.
#[test]
fn a_system_goes_on_with_other_springs() {
    let start = [0.0, 1.0, 2.5].map(at);
    let spring = |a, b| Spring::new([a, b], 0.5, 10.0);
    let lists = [
        vec![spring(0, 1), spring(1, 2)],
        vec![spring(1, 2), spring(0, 1)],
        vec![spring(1, 2)],
        vec![spring(0, 2), spring(1, 2)],
        vec![spring(2, 0), spring(1, 2)],
        vec![spring(0, 1), spring(0, 1)],
        vec![spring(0, 1), spring(2, 7)],
        vec![],
    ];
    for first in &lists {
        for then in lists.iter().filter(|then| !then.is_empty()) {
            let scene = Scene { start: &start, springs: then, ..Scene::EMPTY };
            let began = Scene { springs: first, ..scene };
            let room = |scene: &Scene<'_>| {
                let mut system = System::with(Heap::new(Size { springs: 2, ..scene.size() }));
                system.start(scene, 0).expect("there is room");
                system
            };
            let (mut system, mut fresh) = (room(&began), room(&scene));
            let lost = u64::from(then[then.len() - 1].ends[1] == 7);
            let is_other = first.iter().map(|spring| spring.ends).ne(then.iter().map(|spring| spring.ends));
            let report = system.step(&scene, Time::frame(1, 60));
            assert_eq!(report.caps.springs, if is_other { lost } else { 0 }, "{first:?}, {then:?}");
            fresh.step(&scene, Time::frame(1, 60));
            assert_eq!(system.particles().velocity, fresh.particles().velocity, "{first:?}, {then:?}");
            let momentum = Measures::of(&system, &scene).momentum;
            assert!(gap(momentum, [0.0; 3]) < 1e-6, "{first:?}, {then:?}: {momentum:?}");
        }
    }
}

/// What broke stays broken while only what springs are made of changes, or while a scene has none; in another list nothing is broken.
#[test]
fn springs_stay_broken_while_their_list_is_the_same() {
    let start = [0.0, 2.0, 2.5].map(at);
    let weak = [0, 1].map(|i| Spring { breaks_at: Some(1.5), ..Spring::new([i, i + 1], 1.0, 1.0) });
    let scene = Scene { start: &start, springs: &weak, ..Scene::EMPTY };
    let mut system = started(&scene, 3, 0);
    assert_eq!(system.step(&scene, Time::frame(1, 60)).broken, 1);
    let stiffer = weak.map(|spring| Spring { ks: 2.0, rest_length: 1.1, ..spring });
    let none: [Spring; 0] = [];
    for springs in [&stiffer as &dyn SpringList, &(), &none, &stiffer] {
        system.step(&Scene { springs, ..scene }, Time::frame(1, 60));
        assert!(system.state(&scene).springs.is_broken(0) && !system.state(&scene).springs.is_broken(1));
    }
    let other = [weak[1], Spring { breaks_at: Some(9.0), ..weak[0] }];
    let other = Scene { springs: &other, ..scene };
    assert_eq!(system.step(&other, Time::frame(1, 60)).broken, 0);
    assert!([0, 1].iter().all(|&number| !system.state(&other).springs.is_broken(number)));
}

#[test]
fn numbers_of_sheets_and_meshes_stop_at_the_largest() {
    let params = Some(SpringParams { ks: 1.0, kd: 0.0 });
    let springs = ClothSprings { structural: params, shear: params, bend: params };
    for cells in [[2, 3], [u32::MAX, 1], [1, u32::MAX], [65_536, 65_536], [u32::MAX; 2]] {
        let sheet = Sheet { corner: Vec3::ZERO, sides: [Vec3::X, Vec3::Z], cells };
        assert_eq!(sheet.number(u32::MAX, u32::MAX), u32::MAX);
        let all = sheet.springs(&springs, u32::MAX - 1).take(9).flat_map(|spring| spring.ends).collect::<Vec<_>>();
        assert!(all.len() == 18 && all.iter().all(|&end| end >= u32::MAX - 1), "{cells:?}: {all:?}");
        assert!(sheet.triangles().take(9).count() > 0 && sheet.hinges().take(9).count() > 0, "{cells:?}");
    }
    let (vertices, triangles) = ([Vec3::ZERO, Vec3::X, Vec3::Y], [[0, 1, 2]]);
    let ends = mesh_springs(&vertices, &triangles, &springs, u32::MAX - 1).iter().flat_map(|s| s.ends).max();
    assert_eq!(ends, Some(u32::MAX));
}
