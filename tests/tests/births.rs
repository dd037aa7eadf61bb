//! Births: what they bring with them, how they fly, and how long they live.

use pointmass::emit::Burst;
use pointmass::rng::Stream;
use pointmass::shape::{Disc, Line, Plane};
use pointmass::{
    Attention, Cause, Emit, Emitter, Gravity, Jet, LifeEvent, Meetings, Method, Observer, Particle, Scene, Spread,
    Time, Varied, Vec3,
};
use pointmass_tests::emitting::{cuts, play, varied};
use pointmass_tests::{Form, G, KS, Random, chi_squared, f64s, gap, ks, often, point, started, turn};

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
    let varied = |mean, half_width| Varied { mean, half_width };
    let emitter = Emitter {
        speed: varied(3.0, 1.0),
        mass: varied(2.0, 0.5),
        drag: varied(0.5, 0.5),
        elasticity: varied(0.6, 0.1),
        lifetime: varied(10.0, 9.0),
        color: Some([100, 128, 150, 128]),
        color_half_width: [100, 64, 30, 127],
        burst: Some(Burst { count: n as u32, at: 0.0, every: 0.0 }),
        ..Emitter::new(point(Vec3::ZERO), 0.0)
    };
    let scene = Scene { emitters: &emitter, ..Scene::EMPTY };
    let mut system = started(&scene, n, 3);
    system.step(&scene, Time::from_ticks(1));
    let p = system.particles();
    let uniform = |values: Vec<f64>, of: Varied, what: &str| {
        let (low, width) = (f64::from(of.mean - of.half_width), f64::from(2.0 * of.half_width));
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
        let (mean, half_width) = ([100u8, 128, 150, 128][channel], emitter.color_half_width[channel]);
        let (low, high) = (mean - half_width, mean.saturating_add(half_width));
        // Rounding gives the two ends half a share each, so every inner value has 1 in 2 × half-width.
        let mut counts = vec![0u32; usize::from(high - low) + 1];
        p.color.iter().for_each(|c| counts[usize::from(c[channel] - low)] += 1);
        let share = 0.5 / f64::from(half_width);
        let mut shares = vec![share; counts.len()];
        (shares[0], shares[counts.len() - 1]) = (0.5 * share, 0.5 * share);
        // χ² of k degrees stays below k + 3.1 √(2k) + 7 but once in a thousand times.
        let k = (counts.len() - 1) as f64;
        let chi = chi_squared(&counts, &shares);
        assert!(chi < k + 3.1 * (2.0 * k).sqrt() + 7.0, "channel {channel}: {chi} of {k}");
    }
}

#[test]
fn properties_are_independent_of_each_other() {
    let n = often(100_000);
    let varied = Varied { mean: 0.5, half_width: 0.5 };
    let (mass, lifetime) = (Varied { mean: 1.5, ..varied }, Varied { mean: 1.5, ..varied });
    let burst = Some(Burst { count: n as u32, at: 0.0, every: 0.0 });
    let shape = Form::Line(Line { from: Vec3::ZERO, to: Vec3::X });
    let emitter = Emitter {
        speed: varied,
        direction: Some(Vec3::Y),
        spread: Spread::Uniform(core::f32::consts::PI),
        mass,
        drag: varied,
        elasticity: varied,
        lifetime,
        color: Some([128; 4]),
        color_half_width: [127; 4],
        burst,
        ..Emitter::new(shape, 0.0)
    };
    let scene = Scene { emitters: &emitter, ..Scene::EMPTY };
    let mut system = started(&scene, n, 3);
    system.step(&scene, Time::from_ticks(1));
    let p = system.particles();
    // Every property of a birth, in [0, 1).
    let properties = |i: usize| -> [f64; 12] {
        let v = f64s(p.velocity[i]);
        let speed = gap(v, [0.0; 3]);
        let colors = p.color[i].map(|c| f64::from(c) / 256.0);
        [
            f64::from(p.position[i].x),
            speed,
            (v[1] / speed + 1.0) / 2.0,
            turn(v[0], v[2]),
            f64::from(p.mass[i]) - 1.0,
            f64::from(p.drag[i]),
            f64::from(p.elasticity[i]),
            p.dies[i].seconds_f64() - 1.0,
            colors[0],
            colors[1],
            colors[2],
            colors[3],
        ]
    };
    let all: Vec<[f64; 12]> = (0..n).map(properties).collect();
    for i in 0..12 {
        for j in 0..i {
            let mut counts = [[0u32; 8]; 8];
            let cell = |x: f64| ((x * 8.0) as usize).min(7);
            all.iter().for_each(|x| counts[cell(x[i])][cell(x[j])] += 1);
            // Against the product of the margins, since a colour's ends hold half a share; 49 degrees of freedom, once
            // in 1e5 times above 104.
            let row = |k: usize| counts[k].iter().sum::<u32>();
            let column = |k: usize| counts.iter().map(|row| row[k]).sum::<u32>();
            let shares: Vec<f64> =
                (0..64).map(|k| f64::from(row(k / 8)) * f64::from(column(k % 8)) / (n as f64).powi(2)).collect();
            let chi = chi_squared(counts.as_flattened(), &shares);
            assert!(chi < 104.0, "properties {i} and {j}: {chi}");
        }
    }
}

#[test]
fn a_property_s_variance_leaves_the_others_alone() {
    let base = Emitter {
        speed: Varied { mean: 3.0, half_width: 1.0 },
        lifetime: Varied { mean: 50.0, half_width: 9.0 },
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
    let double = |v: Varied| Varied { mean: v.mean, half_width: 1.5 * v.half_width };
    let none = |v: Varied| Varied::exactly(v.mean);
    for change in [double as fn(Varied) -> Varied, none] {
        let changed = [
            Emitter { speed: change(base.speed), ..base.clone() },
            Emitter { mass: change(base.mass), ..base.clone() },
            Emitter { drag: change(base.drag), ..base.clone() },
            Emitter { elasticity: change(base.elasticity), ..base.clone() },
            Emitter { lifetime: change(base.lifetime), ..base.clone() },
            Emitter { color_half_width: [0, 0, 0, 9], ..base.clone() },
            Emitter {
                spread: Spread::Uniform(change(Varied { mean: 0.0, half_width: 0.4 }).half_width),
                ..base.clone()
            },
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

/// Whenever they come and however long they have: nobody outlives a step's end, and nobody goes before.
#[test]
fn each_dies_when_its_time_has_come_among_others_of_any_age() {
    let lives = |u: f32| match u {
        u if u < 0.2 => 0.0,
        u if u < 0.6 => 40.0 * u,
        u => 0.2 / u,
    };
    for (seed, step) in [(1, 0.01), (2, 1.0 / 60.0), (3, 0.3), (4, 5.0)] {
        let scene = Scene { forces: &Gravity::EARTH, ..Scene::EMPTY };
        let mut system = started(&scene, 60, seed);
        let (mut died, mut copy) = (0, None);
        for n in 0..600_u32 {
            let [u, w] = Stream::new(seed, 0, n).units(0);
            if w < 0.3 {
                _ = system.spawn(&Particle { lifetime: lives(u), ..Particle::REST });
            }
            if w > 0.98 {
                let first = system.id(0);
                first.map(|id| system.remove(&scene, id));
            }
            // A system that goes on from a copy knows as much.
            match n {
                200 => copy = Some(system.clone()),
                250 => system = copy.take().expect("it was made"),
                400 => system.start(&scene, seed).expect("it fits"),
                _ => {}
            }
            let end = system.time() + Time::from_seconds(step);
            let due = system.particles().dies.iter().filter(|&&dies| dies <= end).count() as u64;
            let report = system.step(&scene, Time::from_seconds(step));
            assert_eq!(report.died.lifetime, due, "{step} s, step {n}");
            assert!(system.particles().dies.iter().all(|&dies| dies > end));
            died += due;
        }
        assert!(died > 50, "{died}");
    }
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

/// Who is born on a surface at the very end of a sub-step leaves that one, and no other that is a hair's breadth away.
#[test]
fn who_is_born_where_a_sub_step_ends_is_let_through_one_surface() {
    // Rounding is about a micrometre there.
    let at = Vec3::new(1.0, 0.0, 0.3);
    for gap in [4.5e-6f32, 6e-6, 1e-5] {
        let walls = [at, at + Vec3::Y * gap].map(|point| Plane { point, normal: Vec3::Y });
        for radius in [0.0, 1e-9] {
            let particle = Particle { radius, ..Particle::REST };
            let way = Varied::exactly(1.0);
            let source = Emitter { speed: way, direction: Some(Vec3::Y), ..Emitter::new(point(at), 256.0) };
            let source = source.giving_birth_to(&particle);
            for (kind, meetings) in [Meetings::Through, Meetings::IMPULSE].into_iter().enumerate() {
                for substeps in [1, 2, 4] {
                    let scene = Scene { emitters: &source, colliders: &walls, meetings, substeps, ..Scene::EMPTY };
                    let mut system = started(&scene, 100, 1);
                    (0..4).for_each(|_| {
                        system.step(&scene, Time::from_ticks(1 << 26));
                    });
                    let out = system.particles().position.iter().filter(|x| x.y > 2.0 * gap).count();
                    assert_eq!((system.len(), out), (16, 0), "{gap} m, {kind}, {substeps} sub-steps");
                }
            }
        }
    }
}

#[test]
fn a_jet_gives_the_births_of_an_emitter_of_which_no_more_is_asked() {
    let mut random = Random::new(77);
    for seed in 0..often(100) {
        let shape = Disc { center: random.vector(3.0), normal: random.direction(), radius: random.between(0.0, 2.0) };
        let varied = |mean, half_width| Varied { mean, half_width };
        let (speed, lifetime) = (varied(random.unit(), random.unit()), varied(random.between(0.0, 2.0), random.unit()));
        let angle = if seed % 5 == 0 { 0.0 } else { random.between(0.0, 3.0) };
        let newborn =
            Particle { drag: random.unit(), mass: 0.5 + random.unit(), radius: random.unit(), ..Particle::REST };
        let rate = random.magnitude(1.0, 1000.0);
        let jet = Jet { speed, angle, lifetime, ..Jet::new(shape, rate, newborn) };
        let emitter = Emitter {
            radius: Varied::exactly(newborn.radius),
            speed,
            lifetime,
            spread: Spread::Uniform(angle),
            ..Emitter::new(shape, rate).giving_birth_to(&newborn)
        };
        let [a, b]: [&dyn Emit; 2] = [&jet, &emitter];
        let [a, b] = [a, b].map(|emitters| {
            let scene = Scene { emitters, forces: &Gravity::EARTH, ..Scene::EMPTY };
            let mut system = started(&scene, 100, seed as u64);
            let hashes: Vec<u64> = (1..=50)
                .map(|frame| {
                    system.step_to(&scene, Time::frame(frame, 60));
                    system.hash()
                })
                .collect();
            (hashes, *system.totals())
        });
        assert_eq!(a, b, "{jet:?}");
    }
}

/// Counts the births and deaths that it is told of.
struct Registrar {
    attention: Attention,
    births: u64,
    deaths: u64,
}

impl Observer for Registrar {
    fn attention(&self) -> Attention {
        self.attention
    }
    fn born(&mut self, _: &LifeEvent) {
        self.births += 1;
    }
    fn died(&mut self, _: &LifeEvent, _: Cause) {
        self.deaths += 1;
    }
}

/// On hosts.
#[test]
fn who_listens_is_told_of_births_and_deaths_and_nothing_else_changes() {
    for (number, &method) in Method::ALL.iter().enumerate() {
        let substeps = [1, 3, 10][number % 3];
        let mut fountain =
            Emitter { speed: Varied { mean: 3.0, half_width: 1.0 }, ..Emitter::new(point(Vec3::ZERO), 300.0) };
        fountain.lifetime = Varied { mean: 0.3, half_width: 0.2 };
        let start = [Particle { lifetime: 0.2, ..Particle::REST }, Particle::REST];
        let floor = Plane { point: Vec3::NEG_Y, normal: Vec3::Y };
        let scene = Scene {
            start: &start,
            emitters: &fountain,
            forces: &Gravity::EARTH,
            colliders: &floor,
            substeps,
            integrator: method.integrator(),
            ..Scene::EMPTY
        };
        let mut unseen = started(&scene, 400, 3);
        (1..=40).for_each(|frame| {
            unseen.step_to(&scene, Time::frame(frame, 60));
        });
        for attention in [Attention::Nothing, Attention::Events, Attention::Phases] {
            let mut system = started(&scene, 400, 3);
            let mut registrar = Registrar { attention, births: 0, deaths: 0 };
            for frame in 1..=40 {
                system.step_observed(&scene, Time::frame(frame, 60) - system.time(), &mut registrar);
            }
            let name = format!("{method}, {attention:?}");
            let totals = *system.totals();
            let (born, died) = (totals.born, totals.died.lifetime);
            assert!(born > 100 && died > 20, "{name}: {totals:?}");
            assert_eq!(system.hash(), unseen.hash(), "{name}");
            // Whoever wants to know nothing may be told all the same, as programs are that should be small.
            let told = [registrar.births, registrar.deaths];
            assert!(told == [born, died] || told == [0, 0] && attention == Attention::Nothing, "{name}: {told:?}");
        }
    }
}
