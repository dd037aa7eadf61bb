//! Death by chance: its law, its instants, and that nothing else changes them; reapers in scene files.

use pointmass::emit::Burst;
use pointmass::reap::Verdicts;
use pointmass::scene::{Model, SceneFile, schema, write_scn};
use pointmass::shape::Line;
use pointmass::{
    Cause, Chance, Emitter, Heap, Id, LifeEvent, Observer, Particle, PendingDeath, Reaper, ReaperKind, Scene, System,
    Time, Varied, Vec3,
};
use pointmass_tests::emitting::{cuts, living, play, varied};
use pointmass_tests::{CHI_99, Form, chi_squared, chi_squared_100, often, point, run, started};

/// The deaths: who, when and why.
#[derive(Default)]
struct Deaths(Vec<(Id, Time, Cause)>);

impl Observer for Deaths {
    fn died(&mut self, death: &LifeEvent, cause: Cause) {
        self.0.push((death.id, death.time, cause));
    }
}

/// The law's limit of χ² at one error in a thousand, for that many cells (Wilson and Hilferty).
fn limit(cells: usize) -> f64 {
    let k = cells as f64 - 1.0;
    let a = 2.0 / (9.0 * k);
    k * (1.0 - a + 3.09 * a.sqrt()).powi(3)
}

/// The shares that die between instants, of those who die at `rate`; the last lives beyond.
fn shares(rate: f64, ends: &[f64]) -> Vec<f64> {
    let left = |t: &f64| (-rate * t).exp();
    let before = core::iter::once(1.0).chain(ends.iter().map(left));
    before.zip(ends.iter().map(left).chain([0.0])).map(|(a, b)| a - b).collect()
}

/// Counts those who die in each of the steps that end at `ends`; the last number is of those who live beyond.
fn counts(scene: &Scene<'_>, capacity: usize, seed: u64, ends: &[f64]) -> Vec<u32> {
    let mut system = started(scene, capacity, seed);
    let mut step = |&end: &f64| system.step(scene, Time::from_seconds_f64(end) - system.time()).died.chance as u32;
    let mut counts: Vec<u32> = ends.iter().map(&mut step).collect();
    counts.push(system.len() as u32);
    counts
}

#[test]
fn survivors_follow_the_law_at_every_frame_rate() {
    let start = vec![Particle::REST; often(60_000)];
    for (seed, rate) in [(1, 0.35f32), (2, 1.0), (3, 2.9)] {
        let scene = Scene { start: &start, reapers: &Chance { rate }, ..Scene::EMPTY };
        let at_rate = |fps: u32| {
            let mut system = started(&scene, start.len(), seed);
            let mut deaths = Vec::new();
            // Twelfths of a second are ends of steps of each.
            for twelfth in 1..=24 {
                let before = system.len();
                for n in (twelfth - 1) * fps / 12 + 1..=twelfth * fps / 12 {
                    system.step(&scene, Time::frame(n.into(), fps) - system.time());
                }
                deaths.push((before - system.len()) as u32);
            }
            deaths.push(system.len() as u32);
            let chance = start.len() as u64 - system.len() as u64;
            assert_eq!((system.totals().died.chance, system.totals().died.total()), (chance, chance));
            let mut left = system.particles().serial.to_vec();
            left.sort_unstable();
            (deaths, left)
        };
        let slow = at_rate(24);
        let ends: Vec<f64> = (1..=24).map(|n| f64::from(n) / 12.0).collect();
        let chi = chi_squared(&slow.0, &shares(rate.into(), &ends));
        assert!(chi < limit(25), "{chi} at {rate}");
        // And not just as many: the same.
        assert_eq!(slow, at_rate(60));
        assert_eq!(slow, at_rate(144));
    }
}

#[test]
fn the_same_die_however_time_is_cut() {
    // Births of several emitters come in another order in other steps, so their serials tell nothing.
    let burst = Emitter { burst: Some(Burst { count: 40, at: 0.3, every: 0.4 }), ..varied(70.0) };
    let mortal = Emitter { lifetime: Varied { mean: 1.0, half_width: 0.6 }, ..varied(300.0) };
    let emitters = (varied(333.3), burst, mortal);
    let start: Vec<_> = (0..200).map(|i| Particle { position: Vec3::X * i as f32, ..Particle::REST }).collect();
    let reapers = (Chance { rate: 0.9 }, Chance { rate: 0.2 });
    let scene = Scene { start: &start, emitters: &emitters, reapers: &reapers, ..Scene::EMPTY };
    let serials = |system: &System<Heap>| {
        let p = system.particles();
        let mut all: Vec<_> = p.born.iter().zip(p.serial).map(|(born, serial)| (born.ticks(), *serial)).collect();
        all.sort_unstable();
        all
    };
    let cuts = cuts();
    let first = play(&scene, 3000, &cuts[0]);
    assert!(first.totals().died.chance > 500 && first.totals().died.lifetime > 50 && first.len() > 300);
    let mut other_serials = 0;
    for ends in &cuts[1..] {
        let system = play(&scene, 3000, ends);
        assert_eq!(living(&system), living(&first), "{} steps", ends.len());
        assert_eq!(system.totals().died, first.totals().died);
        other_serials += usize::from(serials(&system) != serials(&first));
    }
    assert!(other_serials > 0);
}

#[test]
fn what_is_put_in_by_hand_has_a_chance_of_its_own() {
    let jet = Emitter { lifetime: Varied::exactly(0.1), ..Emitter::new(point(Vec3::ZERO), 97.0) };
    let scene = Scene { emitters: &jet, reapers: &Chance { rate: 1.0 }, ..Scene::EMPTY };
    let left = |fps: u32| {
        let mut system = started(&scene, 700, 3);
        for second in 0..3 {
            for i in 0..200 {
                let position = Vec3::new(1.0 + i as f32, second as f32, 0.0);
                system.spawn(&Particle { position, ..Particle::REST }).expect("there is room");
            }
            for n in second * fps + 1..=(second + 1) * fps {
                system.step(&scene, Time::frame(n.into(), fps) - system.time());
            }
        }
        living(&system)
    };
    let slow = left(24);
    // There are e⁻¹, e⁻² and e⁻³ left of three times 200, 110 in all, within four standard deviations; and ten newborn.
    assert!((75..165).contains(&slow.len()), "{}", slow.len());
    assert!([60, 144].iter().all(|&fps| left(fps) == slow));
}

/// Ends of nine steps after which tenths of those who die at 1/s are gone.
fn tenths() -> Vec<f64> {
    (1..10).rev().map(|k| -(f64::from(k) / 10.0).ln()).collect()
}

/// The tenth in which each of `n` dies, by number, as a number in [0, 1).
fn deciles(scene: &Scene<'_>, n: usize) -> Vec<f64> {
    let mut system = started(scene, n, 11);
    let mut tenth = vec![9; n];
    for (i, end) in tenths().into_iter().enumerate() {
        let mut deaths = Deaths::default();
        system.step_observed(scene, Time::from_seconds_f64(end) - system.time(), &mut deaths);
        for (id, time, cause) in deaths.0 {
            assert_eq!((time, cause), (system.time(), Cause::Chance));
            tenth[id.serial() as usize] = i;
        }
    }
    tenth.into_iter().map(|tenth| (tenth as f64 + 0.5) / 10.0).collect()
}

#[test]
fn two_choose_independently() {
    let n = often(40_000);
    let start = vec![Particle::REST; n];
    let (one, none) = (Chance { rate: 1.0 }, Chance { rate: 0.0 });
    let by = |reapers: &dyn Reaper| deciles(&Scene { start: &start, reapers, ..Scene::EMPTY }, n);
    let [a, b, c] = [by(&one), by(&(none, one)), by(&[none, none, one])];
    for (a, b) in [(&a, &b), (&a, &c), (&b, &c)] {
        let chi = chi_squared_100(a.iter().zip(b).map(|(&a, &b)| [a, b]));
        assert!(chi < CHI_99, "{chi}");
    }
    // Nor do neighbours know of each other.
    for list in [&a, &b] {
        let chi = chi_squared_100(list.iter().zip(&list[1..]).map(|(&a, &b)| [a, b]));
        assert!(chi < CHI_99, "{chi}");
    }
    // Both together: whom either takes, at the earlier of the two instants, so that rates add up.
    let both = by(&(one, one));
    assert!(both.iter().zip(a.iter().zip(&b)).all(|(both, (a, b))| *both == a.min(*b)));
    let scene = Scene { start: &start, reapers: &[one, one], ..Scene::EMPTY };
    let ends = tenths();
    assert!(chi_squared(&counts(&scene, n, 4, &ends), &shares(2.0, &ends)) < limit(10));
}

#[test]
fn the_time_of_death_has_nothing_to_do_with_the_birth() {
    let n = often(40_000);
    let form = Form::Line(Line { from: Vec3::ZERO, to: Vec3::X });
    let burst = Some(Burst { count: n as u32, at: 0.0, every: 0.0 });
    let emitter = Emitter { burst, mass: Varied { mean: 1.5, half_width: 0.5 }, ..Emitter::new(form, 0.0) };
    let scene = Scene { emitters: &emitter, ..Scene::EMPTY };
    let mut system = started(&scene, n, 11);
    system.step(&scene, Time::ZERO);
    system.step(&scene, Time::from_ticks(1));
    let p = system.particles();
    assert_eq!(p.position.len(), n);
    // Births have their serials in their order.
    let tenths = deciles(&Scene { reapers: &Chance { rate: 1.0 }, ..scene }, n);
    let properties: [&dyn Fn(usize) -> f32; 2] = [&|i| p.mass[i] - 1.0, &|i| p.position[i].x];
    for property in properties {
        let chi = chi_squared_100((0..n).map(|i| [f64::from(property(i)).min(0.999), tenths[i]]));
        assert!(chi < CHI_99, "{chi}");
    }
}

#[test]
fn rates_from_none_to_any() {
    let start = vec![Particle::REST; 300];
    let jet = Emitter::new(point(Vec3::ZERO), 30.0);
    let plain = Scene { start: &start, emitters: &jet, ..Scene::EMPTY };
    let outcome = |rate: f32| {
        let scene = Scene { reapers: &Chance { rate }, ..plain };
        let mut system = started(&scene, 400, 1);
        run(&mut system, &scene, 0.125, 8);
        (system.len(), system.totals().died.chance, system.hash())
    };
    let mut system = started(&plain, 400, 1);
    run(&mut system, &plain, 0.125, 8);
    // Where nobody can die of it nothing is different, not even the hash.
    for rate in [0.0, -0.0, -1.0, f32::NEG_INFINITY, f32::NAN] {
        assert_eq!(outcome(rate), (330, 0, system.hash()), "{rate}");
    }
    for rate in [f32::MIN_POSITIVE, 1e-40, 1e-12] {
        assert_eq!((outcome(rate).0, outcome(rate).1), (330, 0), "{rate}");
    }
    // The newborn too go in the step of their birth.
    for rate in [1e12, 1e30, f32::MAX, f32::INFINITY] {
        assert_eq!((outcome(rate).0, outcome(rate).1), (0, 330), "{rate}");
    }
}

#[test]
fn long_times() {
    let n = often(20_000);
    let start = vec![Particle::REST; n];
    // Mean lifetimes of twelve days and of eighty years.
    for (rate, unit) in [(1e-6, 1e5), (4e-10, 2.5e8)] {
        let ends: Vec<f64> = (1..=15).map(|k| f64::from(k) * unit).collect();
        let scene = Scene { start: &start, reapers: &Chance { rate }, ..Scene::EMPTY };
        let chi = chi_squared(&counts(&scene, n, 8, &ends), &shares(f64::from(rate), &ends));
        assert!(chi < limit(16), "{chi} at {rate}");
    }
    // Three years after the beginning, in steps of a millisecond: time itself is as exact as ever.
    let burst = Some(Burst { count: n as u32, at: 1e8, every: 0.0 });
    let late = Emitter { burst, ..Emitter::new(point(Vec3::ZERO), 0.0) };
    let scene = Scene { emitters: &late, reapers: &Chance { rate: 100.0 }, ..Scene::EMPTY };
    let ends: Vec<f64> = core::iter::once(1e8).chain((1..=20).map(|k| 1e8 + f64::from(k) * 1e-3)).collect();
    let ages: Vec<f64> = (1..=20).map(|k| f64::from(k) * 1e-3).collect();
    let deaths = counts(&scene, n, 8, &ends);
    let chi = chi_squared(&deaths[1..], &shares(100.0, &ages));
    assert!(deaths[0] == 0 && chi < limit(21), "{chi}");
}

#[test]
fn of_age_and_chance_the_earlier_counts() {
    let jet = Emitter { lifetime: Varied::exactly(0.5), ..Emitter::new(point(Vec3::ZERO), 2000.0) };
    let old = Emitter { stop: Some(4.0), ..jet };
    let scene = Scene { emitters: &old, reapers: &Chance { rate: 2.0 }, ..Scene::EMPTY };
    let of = |ends: &[Time]| {
        let mut system = started(&scene, 9000, 6);
        let mut deaths = Deaths::default();
        let mut born = std::collections::BTreeMap::new();
        for &end in ends {
            system.step_observed(&scene, end - system.time(), &mut deaths);
            let p = system.particles();
            born.extend((0..system.len()).map(|i| (system.id(i), p.born[i])));
        }
        for (id, time, cause) in &deaths.0 {
            // At the end of the step: its own instant lies in it.
            let before = ends[..ends.iter().position(|end| end == time).expect("the end of a step")].last();
            let Some(born) = born.get(&Some(*id)) else { continue };
            let age = (*before.unwrap_or(&Time::ZERO) - *born).seconds();
            assert!(if *cause == Cause::Lifetime { (*time - *born).seconds() > 0.4999 } else { age < 0.5 }, "{age}");
        }
        assert!(system.is_empty());
        let died = system.totals().died;
        assert_eq!((died.chance + died.lifetime, deaths.0.len()), (8000, 8000));
        died
    };
    let frames: Vec<Time> = (1..=300).map(|n| Time::frame(n, 60)).collect();
    let died = of(&frames);
    let chi = chi_squared(&[died.chance as u32, died.lifetime as u32], &[1.0 - (-1f64).exp(), (-1f64).exp()]);
    assert!(chi < limit(2), "{died:?}");
    // All of it within one step: counted as with sixty a second.
    assert_eq!(of(&[Time::from_seconds(5.0)]), died);
    assert_eq!(of(&[Time::from_seconds(0.7), Time::from_seconds(5.0)]), died);
}

#[test]
fn rows_can_be_divided() {
    let start = vec![Particle::REST; 1000];
    let scene = Scene { start: &start, ..Scene::EMPTY };
    let mut system = started(&scene, 1000, 2);
    system.step(&scene, Time::from_seconds(0.8));
    let state = system.state(&scene);
    let reapers = [Chance { rate: 0.7 }, Chance { rate: 0.0 }, Chance { rate: 0.4 }];
    let mut whole = [PendingDeath::Lives; 1000];
    reapers.judge(&state, 0..1000, &mut Verdicts::on(&mut whole));
    assert!(
        (500..700).contains(&whole.iter().filter(|pending_death| pending_death.cause() == Some(Cause::Chance)).count())
    );
    for size in [1, 7, 64, 999] {
        let mut parts = [PendingDeath::Lives; 1000];
        for (i, part) in parts.chunks_mut(size).enumerate() {
            reapers.judge(&state, i * size..i * size + part.len(), &mut Verdicts::on(part));
        }
        assert_eq!(parts, whole, "{size}");
    }
}

#[test]
fn the_gravest_cause_counts() {
    let all = [Cause::Lifetime, Cause::Other, Cause::Density, Cause::Chance, Cause::Sink, Cause::Nonfinite];
    for (i, &a) in all.iter().enumerate() {
        for (j, &b) in all.iter().enumerate() {
            let mut pending_deaths = [PendingDeath::Lives; 2];
            let mut verdicts = Verdicts::on(&mut pending_deaths);
            verdicts.end(1, a);
            verdicts.end(1, b);
            verdicts.end(2, b);
            assert_eq!(pending_deaths.map(PendingDeath::cause), [None, Some(all[i.max(j)])]);
        }
    }
}

#[test]
fn files_say_it() {
    let text = r#"{"particles": [{}, {}], "reapers": [{"chance": {"rate": 0.5}}, {"chance": {"rate": 2}}]}"#;
    let file = SceneFile::from_json("a.json", text).expect("it is well-formed");
    file.check().expect("it is sound");
    let rates = [0.5, 2.0].map(|rate| Chance { rate });
    assert_eq!(file.reapers, rates.map(ReaperKind::Chance));
    assert!(file.reapers.iter().all(|reaper| reaper.kind() == "chance"));
    assert_eq!(SceneFile::from_json("b.json", &file.to_json()), Ok(file.clone()));
    assert!(!SceneFile::new().to_json().contains("reapers"));
    // It does what the program's own list does.
    let model = Model::load(&file, "a.json", &mut ()).expect("it can be run");
    let scene = model.scene();
    let own = Scene { reapers: &rates, ..scene };
    let hash = |scene: &Scene<'_>| {
        let mut system = started(scene, 2, 77);
        run(&mut system, scene, 0.05, 20);
        assert!(system.totals().died.chance > 0);
        system.hash()
    };
    assert_eq!(hash(&scene), hash(&own));
    // The schema knows it, .scn does not.
    let said = schema();
    assert!(["reapers", "ReaperKind", "\"chance\""].iter().all(|word| said.contains(word)));
    let (_, warnings) = write_scn(&file);
    assert_eq!(warnings.iter().filter(|warning| warning.starts_with("reapers: ")).count(), 1, "{warnings:?}");
}

#[test]
fn files_are_refused_by_what_is_wrong() {
    let read = |reapers: &str| SceneFile::from_json("a.json", &format!("{{\"reapers\": {reapers}}}"));
    for (reapers, words) in [
        (r#"[{"chance": {}}]"#, "missing field `rate`"),
        (r#"[{"chance": {"rate": 1, "half_life": 2}}]"#, "unknown field `half_life`"),
        (r#"[{"chance": {"rate": 1e39}}]"#, "number out of range"),
        (r#"[{"chance": {"rate": "often"}}]"#, "invalid type"),
        (r#"[{"plague": {"rate": 1}}]"#, "unknown variant `plague`"),
        (r#"["chance"]"#, "a name alone"),
        (r#"{"chance": {"rate": 1}}"#, "invalid type"),
    ] {
        let error = read(reapers).expect_err("it is wrong").to_string();
        assert!(error.starts_with("a.json:1:") && error.contains(words), "{error}");
    }
    let file = read(r#"[{"chance": {"rate": 0}}, {"chance": {"rate": -0.25}}]"#).expect("it is well-formed");
    let error = file.check().expect_err("it is below zero").to_string();
    assert!(error.contains("reapers[1].rate: has to be zero or more, not -0.25"), "{error}");
    for rate in [f32::NAN, f32::INFINITY] {
        let file = SceneFile { reapers: vec![ReaperKind::Chance(Chance { rate })], ..SceneFile::new() };
        let error = file.check().expect_err("it is no number").to_string();
        assert!(error.contains("reapers[0].rate: has to be finite"), "{error}");
    }
}
