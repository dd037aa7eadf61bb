//! Births: how many, when, where, with what; and how long they live.

use pointmass::emit::Burst;
use pointmass::shape::{Disc, Sphere};
use pointmass::{Emit, Emitter, Gravity, Heap, Method, Particle, Scene, Spread, System, Time, Varied, Vec3};
use pointmass_tests::{Form, G, KS, Random, f64s, gap, ks, often, point, started};

/// A run of 2.5 s cut into steps in many ways; every cut ends at the same instant.
fn cuts() -> Vec<Vec<Time>> {
    let end = Time::from_seconds(2.5);
    let mut all: Vec<Vec<Time>> =
        [24, 30, 60, 144].map(|fps| (1..=fps * 5 / 2).map(|n| Time::frame(n.into(), fps)).collect()).into();
    all.push(vec![end]);
    let mut random = Random::new(1);
    for longest in [0.01, 0.3] {
        let (mut ends, mut now) = (vec![], Time::ZERO);
        while now < end {
            now = (now + Time::from_seconds(random.between(0.0, longest)) + Time::from_ticks(1)).min(end);
            ends.push(now);
        }
        all.push(ends);
    }
    all
}

fn play(scene: &Scene<'_>, capacity: usize, ends: &[Time]) -> System<Heap> {
    let mut system = started(scene, capacity, 5);
    for &end in ends {
        system.step(scene, end - system.time());
    }
    system
}

/// Instant, bits of the place, bits of the velocity of all who live, in that order.
type Birth = (u64, [u32; 3], [u32; 3]);

fn living(system: &System<Heap>) -> Vec<Birth> {
    let p = system.particles();
    let row = |i: usize| {
        let bits = |v: Vec3| v.to_array().map(f32::to_bits);
        (p.born[i].ticks(), bits(p.position[i]), bits(p.velocity[i]))
    };
    let mut births: Vec<Birth> = (0..system.len()).map(row).collect();
    births.sort_unstable();
    births
}

fn sphere() -> Form {
    Form::Sphere(Sphere { center: Vec3::new(1.0, -2.0, 0.5), radius: 0.7 })
}

/// Births on a sphere with every property varied, but at rest: they stay where they were born.
fn varied(rate: f32) -> Emitter<pointmass::shape::Mesh<'static>> {
    let varied = |mean| Varied { mean, variance: 0.25 * mean };
    Emitter {
        mass: varied(2.0),
        drag: varied(0.5),
        elasticity: varied(0.4),
        spread: Spread::Uniform(0.4),
        color: Some([128; 4]),
        color_variance: [50, 60, 70, 80],
        ..Emitter::new(sphere(), rate)
    }
}

#[test]
fn births_number_the_floor_of_rate_times_time_after_every_step() {
    for rate in [0.3f32, 1.0, 7.5, 40.0, 59.94, 1234.567] {
        let emitter = Emitter::new(sphere(), rate);
        let scene = Scene { emitters: &emitter, ..Scene::EMPTY };
        // Both factors are whole numbers of 2⁻³², and so the product is exact.
        let exact = |t: Time| ((f64::from(rate) * 4_294_967_296.0) as u128 * u128::from(t.ticks()) >> 64) as u64;
        for ends in cuts() {
            let mut system = started(&scene, 4000, 5);
            for end in ends {
                system.step(&scene, end - system.time());
                assert_eq!(system.totals().born, exact(end), "{rate}/s until {end:?}");
            }
        }
    }
}

#[test]
fn births_are_the_same_however_time_is_cut() {
    let still = varied(59.94);
    let flying =
        Emitter { speed: Varied { mean: 3.0, variance: 1.0 }, velocity: Vec3::X, inherit: 0.5, ..varied(40.0) };
    for emitter in [&still, &flying] {
        let scene = Scene { emitters: emitter, ..Scene::EMPTY };
        let all: Vec<Vec<Birth>> = cuts().iter().map(|ends| living(&play(&scene, 4000, ends))).collect();
        let rate = (f64::from(emitter.rate) * 4_294_967_296.0) as u128;
        for (k, birth) in (1u128..).zip(&all[0]) {
            // The k-th birth comes at the first tick that is not before k / rate.
            assert_eq!(u128::from(birth.0), (k << 64).div_ceil(rate));
        }
        for births in &all[1..] {
            assert_eq!(births.len(), all[0].len());
            for (a, b) in births.iter().zip(&all[0]) {
                assert_eq!((a.0, a.2), (b.0, b.2));
                // Those that fly come to the same place but for the rounding of each step's way: 360 steps of at most
                // half an ulp of 8 m each.
                let place = |birth: &Birth| birth.1.map(|bits| f64::from(f32::from_bits(bits)));
                let tolerance = if emitter.speed.mean == 0.0 { 0.0 } else { 360.0 * 2.4e-7 };
                assert!(gap(place(a), place(b)) <= tolerance);
            }
        }
    }
}

#[test]
fn bursts_are_the_same_however_time_is_cut() {
    for (at, every) in [(0.0, 0.0), (0.5, 0.0), (0.0, 0.25), (0.3, 0.7), (1.0, 1.0 / 60.0), (2.5, 0.0), (0.0, 2.5)] {
        let emitter =
            Emitter { speed: Varied::exactly(1.0), burst: Some(Burst { count: 7, at, every }), ..varied(0.0) };
        let scene = Scene { emitters: &emitter, ..Scene::EMPTY };
        let [first, step] = [at, every].map(|t| Time::from_seconds(t).ticks());
        let end = Time::from_seconds(2.5).ticks();
        let instants: Vec<u64> = if step == 0 {
            [first].into_iter().filter(|&t| t < end).collect()
        } else {
            (0..).map(|k| first + k * step).take_while(|&t| t < end).collect()
        };
        let all: Vec<Vec<Birth>> = cuts().iter().map(|ends| living(&play(&scene, 2000, ends))).collect();
        let born: Vec<u64> = all[0].iter().map(|birth| birth.0).collect();
        assert_eq!(born, instants.iter().flat_map(|&t| [t; 7]).collect::<Vec<u64>>(), "at {at} every {every}");
        for births in &all {
            let marks = |births: &[Birth]| births.iter().map(|b| (b.0, b.2)).collect::<Vec<_>>();
            let (mut a, mut b) = (marks(births), marks(&all[0]));
            a.sort_unstable();
            b.sort_unstable();
            assert!(a == b, "at {at} every {every}");
        }
    }
}

#[test]
fn a_burst_beside_a_rate_is_the_same_however_time_is_cut() {
    let burst = Some(Burst { count: 5, at: 0.51, every: 0.4 });
    let emitter = Emitter { speed: Varied::exactly(1.0), burst, ..varied(33.0) };
    let scene = Scene { emitters: &emitter, ..Scene::EMPTY };
    let marks = |ends: &Vec<Time>| {
        let mut marks: Vec<_> = living(&play(&scene, 2000, ends)).iter().map(|b| (b.0, b.2)).collect();
        marks.sort_unstable();
        marks
    };
    let all: Vec<_> = cuts().iter().map(marks).collect();
    for births in &all {
        let instants = |births: &[(u64, [u32; 3])]| births.iter().map(|b| b.0).collect::<Vec<_>>();
        assert_eq!(instants(births), instants(&all[0]));
        assert!(births == &all[0], "the same instants, but other velocities");
    }
}

#[test]
fn a_step_longer_than_a_life_leaves_those_who_still_live() {
    let emitter = Emitter { lifetime: Varied { mean: 0.2, variance: 0.1 }, ..varied(200.0) };
    let scene = Scene { emitters: &emitter, ..Scene::EMPTY };
    let all: Vec<System<Heap>> = cuts().iter().map(|ends| play(&scene, 1000, ends)).collect();
    assert!(all[0].len() > 20);
    for system in &all {
        assert_eq!(living(system), living(&all[0]));
        assert_eq!((system.totals().born, system.totals().died.lifetime), (500, 500 - system.len() as u64));
    }
}

#[test]
fn what_finds_no_room_is_counted() {
    for capacity in [0, 1, 3, 10] {
        for lifetime in [0.0, 0.07] {
            let burst = Some(Burst { count: 6, at: 0.2, every: 0.5 });
            let emitter = Emitter { burst, lifetime: Varied::exactly(lifetime), ..varied(37.0) };
            let scene = Scene { emitters: &emitter, ..Scene::EMPTY };
            for ends in cuts() {
                let system = play(&scene, capacity, &ends);
                let totals = system.totals();
                // 2.5 s × 37/s, and six at 0.2, 0.7, 1.2, 1.7, 2.2 s.
                assert_eq!(totals.born + totals.refused, 92 + 30, "capacity {capacity}");
                assert_eq!(totals.born, system.len() as u64 + totals.died.total());
                assert!(system.len() <= capacity);
            }
        }
    }
}

#[test]
fn those_that_find_no_room_use_up_their_numbers() {
    // Whoever is born is the same in a small system as in a large one.
    let emitter = Emitter { lifetime: Varied::exactly(0.1), ..varied(100.0) };
    let scene = Scene { emitters: &emitter, ..Scene::EMPTY };
    let ends: Vec<Time> = (1..=15).map(|n| Time::frame(n, 30)).collect();
    let (small, large) = (play(&scene, 3, &ends), play(&Scene { ..scene }, 100, &ends));
    let all = living(&large);
    assert!(small.totals().refused > 0 && !small.is_empty());
    assert!(living(&small).iter().all(|birth| all.contains(birth)));
}

#[test]
fn an_emitter_works_between_its_start_and_its_stop() {
    for (start, stop) in [(0.5f32, Some(1.25f32)), (0.0, Some(0.01)), (1.0, None), (3.0, None), (1.0, Some(0.5))] {
        let emitter = Emitter { start, stop, ..varied(80.0) };
        let scene = Scene { emitters: &emitter, ..Scene::EMPTY };
        let last = stop.unwrap_or(2.5).min(2.5);
        let expected = (f64::from(last - start).max(0.0) * 80.0).floor();
        let all: Vec<Vec<Birth>> = cuts().iter().map(|ends| living(&play(&scene, 1000, ends))).collect();
        assert_eq!(all[0].len() as f64, expected, "{start} to {stop:?}");
        assert!(all.iter().all(|births| births == &all[0]));
        if let Some(first) = all[0].first() {
            assert_eq!(first.0, Time::from_seconds(start).ticks() + (1 << 32) / 80 + 1);
        }
    }
}

#[test]
fn a_new_rate_goes_on_from_what_was_owed() {
    let (slow, fast) = (varied(10.0), varied(20.0));
    let [slow, fast] = [&slow, &fast].map(|emitters| Scene { emitters, ..Scene::EMPTY });
    let mut system = started(&slow, 100, 5);
    system.step(&slow, Time::from_seconds(0.5625));
    assert_eq!(system.totals().born, 5);
    // 0.625 of a birth is owed; the rest takes 0.375 / 20 s.
    system.step(&fast, Time::from_seconds(0.0187));
    assert_eq!(system.totals().born, 5);
    system.step(&fast, Time::from_seconds(0.0001));
    assert_eq!(system.totals().born, 6);
}

#[test]
fn hostile_numbers_stay_bounded() {
    let values = [1e30, f32::INFINITY, f32::NEG_INFINITY, f32::NAN, -5.0, 0.0, -0.0, f32::MIN_POSITIVE, 1e-9];
    for x in values {
        let emitters = [
            varied(x),
            Emitter { start: x, ..varied(100.0) },
            Emitter { stop: Some(x), ..varied(100.0) },
            Emitter { burst: Some(Burst { count: 9, at: x, every: 0.1 }), ..varied(1.0) },
            Emitter { burst: Some(Burst { count: 9, at: 0.0, every: x }), ..varied(1.0) },
            Emitter { speed: Varied::exactly(x), ..varied(50.0) },
            Emitter { direction: Some(Vec3::splat(x)), ..varied(50.0) },
            Emitter {
                mass: Varied { mean: x, variance: x },
                lifetime: Varied { mean: x, variance: x },
                ..varied(50.0)
            },
            Emitter { spread: Spread::Uniform(x), ..varied(50.0) },
            Emitter { spread: Spread::Lecture(x), ..varied(50.0) },
        ];
        for emitter in &emitters {
            let scene = Scene { emitters: emitter, forces: &Gravity::EARTH, ..Scene::EMPTY };
            for capacity in [0, 1, 20] {
                let mut system = started(&scene, capacity, 1);
                for dt in [0.0, 0.02, 1.0, 100.0] {
                    system.step(&scene, Time::from_seconds(dt));
                    let totals = system.totals();
                    assert_eq!(totals.born, system.len() as u64 + totals.died.total());
                    assert!(system.particles().position.iter().all(|x| x.is_finite()));
                }
            }
        }
    }
}

#[test]
fn counting_what_finds_no_room_never_overflows() {
    let burst = Some(Burst { count: u32::MAX, at: 0.0, every: 1e-9 });
    let emitter = Emitter { burst, ..varied(1e30) };
    let scene = Scene { emitters: &emitter, ..Scene::EMPTY };
    let mut system = started(&scene, 2, 1);
    let mut before = 0;
    for dt in [Time::SECOND, Time::from_seconds(3.0), Time::from_seconds(1e6), Time::SECOND, Time::NEVER] {
        system.step(&scene, dt);
        // It may stand still at the largest number there is, but not start again.
        assert!(system.totals().refused >= before, "{} after {before}", system.totals().refused);
        before = system.totals().refused;
    }
}

#[test]
fn newborns_fly_ballistically_from_the_instant_of_birth() {
    let (origin, v) = (Vec3::new(1.0, 2.0, -3.0), Vec3::new(4.0, 7.0, 0.0));
    let emitter = Emitter {
        speed: Varied::exactly(v.length()),
        direction: Some(v),
        burst: Some(Burst { count: 1, at: 0.0, every: 0.11 }),
        ..Emitter::new(point(origin), 30.0)
    };
    let mut hashes = vec![];
    for &method in Method::ALL {
        let integrator = method.integrator();
        let scene = Scene { emitters: &emitter, forces: &Gravity::EARTH, integrator, ..Scene::EMPTY };
        let mut system = started(&scene, 100, 1);
        system.step(&scene, Time::from_seconds(0.5));
        assert_eq!(system.len(), 15 + 5);
        let p = system.particles();
        for i in 0..system.len() {
            let t = 0.5 - p.born[i].seconds_f64();
            let [x, y, z] = f64s(origin);
            let place = [x + 4.0 * t, y + 7.0 * t - 0.5 * G * t * t, z];
            // A few ulps of 4 m and of 7 m/s.
            assert!(gap(f64s(p.position[i]), place) < 2e-6, "{method}");
            assert!(gap(f64s(p.velocity[i]), [4.0, 7.0 - G * t, 0.0]) < 2e-6, "{method}");
        }
        hashes.push(system.hash());
    }
    assert!(hashes.iter().all(|&hash| hash == hashes[0]), "the method has no part in a newborn's first step");
}

#[test]
fn births_follow_a_moving_emitter_and_take_their_share_of_its_velocity() {
    let velocity = Vec3::new(3.0, 0.0, -1.0);
    for inherit in [0.0, 0.25, 1.0] {
        let shape = Form::Circle(Disc { center: Vec3::Y, normal: Vec3::Y, radius: 0.0 });
        let emitter = Emitter { velocity, inherit, speed: Varied::exactly(2.0), ..Emitter::new(shape, 10.0) };
        let scene = Scene { emitters: &emitter, ..Scene::EMPTY };
        let system = play(&scene, 100, &cuts()[2]);
        let p = system.particles();
        for i in 0..system.len() {
            let v = velocity * inherit + Vec3::Y * 2.0;
            assert!((p.velocity[i] - v).length() < 1e-6);
            let birth = p.born[i].seconds_f64();
            let place: [f64; 3] =
                core::array::from_fn(|k| f64s(Vec3::Y)[k] + f64s(velocity)[k] * birth + f64s(v)[k] * (2.5 - birth));
            // 150 steps, each rounded to half an ulp of up to 8 m.
            assert!(gap(f64s(p.position[i]), place) < 150.0 * 2.4e-7);
        }
    }
}

#[test]
fn varied_properties_are_uniform_about_their_means() {
    let n = often(100_000);
    let varied = |mean, variance| Varied { mean, variance };
    let emitter = Emitter {
        speed: varied(3.0, 1.0),
        mass: varied(2.0, 0.5),
        drag: varied(0.5, 0.5),
        elasticity: varied(0.6, 0.1),
        lifetime: varied(10.0, 9.0),
        color: Some([100, 128, 150, 128]),
        color_variance: [100, 64, 30, 127],
        burst: Some(Burst { count: n as u32, at: 0.0, every: 0.0 }),
        ..Emitter::new(point(Vec3::ZERO), 0.0)
    };
    let scene = Scene { emitters: &emitter, ..Scene::EMPTY };
    let mut system = started(&scene, n, 3);
    system.step(&scene, Time::from_ticks(1));
    let p = system.particles();
    let uniform = |values: Vec<f64>, of: Varied, what: &str| {
        let (low, width) = (f64::from(of.mean - of.variance), f64::from(2.0 * of.variance));
        let d = ks(values.iter().copied(), |x| ((x - low) / width).clamp(0.0, 1.0));
        assert!(d < KS, "{what}: {d}");
        assert!(values.iter().all(|x| (low - 1e-5..=low + width + 1e-5).contains(x)), "{what}");
    };
    let floats = |values: &[f32]| values.iter().copied().map(f64::from).collect();
    uniform(p.velocity.iter().map(|v| f64::from(v.length())).collect(), emitter.speed, "speed");
    uniform(floats(p.mass), emitter.mass, "mass");
    uniform(floats(p.drag), emitter.drag, "drag");
    uniform(floats(p.elasticity), emitter.elasticity, "elasticity");
    uniform(p.dies.iter().map(|t| t.seconds_f64()).collect(), emitter.lifetime, "lifetime");
    for channel in 0..4 {
        let (mean, variance) = ([100u8, 128, 150, 128][channel], emitter.color_variance[channel]);
        let (low, high) = (mean - variance, mean.saturating_add(variance));
        // Rounding gives the two ends half a share each, so every inner value has 1 in 2 × variance.
        let mut counts = vec![0u32; usize::from(high - low) + 1];
        p.color.iter().for_each(|c| counts[usize::from(c[channel] - low)] += 1);
        let share = 0.5 / f64::from(variance);
        let mut shares = vec![share; counts.len()];
        (shares[0], shares[counts.len() - 1]) = (0.5 * share, 0.5 * share);
        // χ² of k degrees stays below k + 3.1 √(2k) + 7 but once in a thousand times.
        let k = (counts.len() - 1) as f64;
        let chi = pointmass_tests::chi_squared(&counts, &shares);
        assert!(chi < k + 3.1 * (2.0 * k).sqrt() + 7.0, "channel {channel}: {chi} of {k}");
    }
}

#[test]
fn a_property_s_variance_leaves_the_others_alone() {
    let base = Emitter {
        speed: Varied { mean: 3.0, variance: 1.0 },
        lifetime: Varied { mean: 50.0, variance: 9.0 },
        ..varied(100.0)
    };
    let columns = |emitter: &dyn Emit| -> Vec<Vec<u64>> {
        let scene = Scene { emitters: emitter, ..Scene::EMPTY };
        let mut system = started(&scene, 200, 9);
        system.step(&scene, Time::SECOND);
        let p = system.particles();
        let bits = |column: &[f32]| column.iter().map(|x| u64::from(x.to_bits())).collect();
        let direction = |v: &Vec3| (v.normalize() * 1000.0).round().to_array().map(|x| x as i64 as u64);
        vec![
            p.velocity.iter().map(|v| (f64::from(v.length()) * 1e5).round() as u64).collect(),
            bits(p.mass),
            bits(p.drag),
            bits(p.elasticity),
            p.dies.iter().map(|t| t.ticks()).collect(),
            p.color.iter().map(|&c| u32::from_le_bytes(c).into()).collect(),
            p.velocity.iter().flat_map(direction).collect(),
            p.born.iter().map(|t| t.ticks()).collect(),
        ]
    };
    let before = columns(&base);
    let double = |v: Varied| Varied { mean: v.mean, variance: 1.5 * v.variance };
    let none = |v: Varied| Varied::exactly(v.mean);
    for change in [double as fn(Varied) -> Varied, none] {
        let changed = [
            Emitter { speed: change(base.speed), ..base.clone() },
            Emitter { mass: change(base.mass), ..base.clone() },
            Emitter { drag: change(base.drag), ..base.clone() },
            Emitter { elasticity: change(base.elasticity), ..base.clone() },
            Emitter { lifetime: change(base.lifetime), ..base.clone() },
            Emitter { color_variance: [0, 0, 0, 9], ..base.clone() },
            Emitter { spread: Spread::Uniform(change(Varied { mean: 0.0, variance: 0.4 }).variance), ..base.clone() },
        ];
        for (i, emitter) in changed.iter().enumerate() {
            let after = columns(emitter);
            for k in 0..before.len() {
                assert_eq!(before[k] != after[k], k == i, "property {k} when {i} changes");
            }
        }
    }
}

#[test]
fn a_further_emitter_leaves_the_first_alone() {
    let first = Emitter { speed: Varied::exactly(1.0), material: Some(1), ..varied(70.0) };
    let second = Emitter { speed: Varied::exactly(1.0), material: Some(2), ..varied(90.0) };
    let births = |emitters: &dyn Emit, material: u16| {
        let scene = Scene { emitters, ..Scene::EMPTY };
        let system = play(&scene, 1000, &cuts()[1]);
        let p = system.particles();
        let mine = (0..system.len()).filter(|&i| p.material[i] == material + 1);
        mine.map(|i| (p.born[i].ticks(), p.mass[i].to_bits(), p.velocity[i].to_array().map(f32::to_bits)))
            .collect::<Vec<_>>()
    };
    let alone = births(&first, 1);
    assert_eq!(alone.len(), 175);
    assert_eq!(births(&(&first, &second), 1), alone);
    assert_eq!(births(&[&first as &dyn Emit, &(&second, &second)], 1), alone);
    // And the two are not alike.
    let other = births(&(&first, Emitter { material: Some(3), ..first.clone() }), 3);
    assert!(other.len() == alone.len() && other.iter().zip(&alone).all(|(a, b)| a.0 == b.0 && a.2 != b.2));
}

#[test]
fn a_seed_makes_a_run() {
    let emitter = varied(50.0);
    let scene = Scene { emitters: &emitter, ..Scene::EMPTY };
    let hash = |seed| {
        let mut system = started(&scene, 100, seed);
        system.step(&scene, Time::SECOND);
        system.particles().position.iter().map(|x| x.to_array().map(f32::to_bits)).collect::<Vec<_>>()
    };
    assert_eq!(hash(1), hash(1));
    for other in [0, 2, 1 << 32, 1 << 63 | 1] {
        assert!(hash(1).iter().zip(&hash(other)).all(|(a, b)| a != b), "{other}");
    }
}

#[test]
fn a_particle_dies_with_the_first_step_that_ends_after_its_life() {
    for (a, b) in [(1, 10), (1, 4), (1, 60), (1, 3), (3, 10), (7, 10), (1, 1), (11, 10), (1, 1000), (19, 10)] {
        for fps in [24, 30, 60, 144] {
            dies_in_time(a, b, fps);
        }
    }
}

#[test]
fn a_very_short_life_ends_in_time_too() {
    for fps in [250, 400, 500, 600, 1000, 3000] {
        for frames in [1, 2, 3] {
            dies_in_time(frames, fps, fps);
        }
    }
}

/// A life of `a` / `b` seconds ends with the frame that whole numbers say.
fn dies_in_time(a: u64, b: u64, fps: u64) {
    let start = [Particle { lifetime: (a as f64 / b as f64) as f32, ..Particle::REST }];
    let scene = Scene { start: &start, ..Scene::EMPTY };
    let mut system = started(&scene, 1, 0);
    let died = (1..1000).find(|&n| {
        let report = system.step(&scene, Time::frame(n, fps as u32) - system.time());
        report.died.lifetime == 1
    });
    assert_eq!(died, Some((a * fps).div_ceil(b)), "{a}/{b} s at {fps} frames/s");
    assert!(system.is_empty());
}

#[test]
fn a_lifetime_of_zero_or_less_is_for_ever() {
    let start = [0.0, -0.0, -1.0, f32::NEG_INFINITY, f32::NAN, f32::INFINITY, 1e30]
        .map(|lifetime| Particle { lifetime, ..Particle::REST });
    let scene = Scene { start: &start, ..Scene::EMPTY };
    let mut system = started(&scene, start.len(), 0);
    for _ in 0..100 {
        system.step(&scene, Time::from_seconds(1e6));
    }
    assert_eq!(system.len(), start.len());
}
