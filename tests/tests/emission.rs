//! Births: how many, and when, however time is cut into steps.

use pointmass::emit::{Births, Burst};
use pointmass::{Emit, Emitter, Gravity, Heap, Particle, Scene, Spread, System, Time, Varied, Vec3};
use pointmass_tests::emitting::{Birth, cuts, living, play, sphere, varied};
use pointmass_tests::{gap, started};

#[test]
fn births_number_the_floor_of_rate_times_time_after_every_step() {
    for rate in [0.3f32, 1.0, 7.5, 40.0, 59.94, 1234.567] {
        let emitter = Emitter::new(sphere(), rate);
        let scene = Scene { emitters: &emitter, ..Scene::EMPTY };
        // Both factors are whole numbers of 2⁻³², and so the product is exact.
        let exact = |t: Time| (((f64::from(rate) * 4_294_967_296.0) as u128 * u128::from(t.ticks())) >> 64) as u64;
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
        Emitter { speed: Varied { mean: 3.0, half_width: 1.0 }, velocity: Vec3::X, inherit: 0.5, ..varied(40.0) };
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
    let emitter = Emitter { lifetime: Varied { mean: 0.2, half_width: 0.1 }, ..varied(200.0) };
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
                mass: Varied { mean: x, half_width: x },
                lifetime: Varied { mean: x, half_width: x },
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

/// An emitter that brings about births by as many numbers as it likes, of which it says it has one.
struct Greedy {
    numbers: usize,
    way: usize,
}

impl Emit for Greedy {
    fn count(&self) -> usize {
        1
    }
    fn emit(&self, from: Time, to: Time, births: &mut Births<'_>) {
        for _ in 0..self.numbers {
            let number = births.claim();
            let due = births.due(number, 7.5, from, to);
            if self.way == 0 {
                births.refuse(number, due.left());
                continue;
            }
            for at in due {
                match self.way {
                    1 => births.offer(number, at, |_, _| Some(Particle::REST)),
                    _ => assert_eq!(births.give(number, at, |_| Particle::REST).is_ok(), number == 0),
                }
            }
        }
    }
}

/// Whoever is born by a number that there is no memory for is refused, and counted, however time is cut.
#[test]
fn births_by_numbers_beyond_the_memory_are_refused() {
    for (way, steps) in [(0, 1), (0, 60), (1, 1), (1, 60), (2, 1), (2, 7), (2, 60)] {
        let emitter = Greedy { numbers: 3, way };
        let scene = Scene { emitters: &emitter, ..Scene::EMPTY };
        let mut system = started(&scene, 100, 1);
        for step in 1..=steps {
            system.step_to(&scene, Time::frame(step, steps as u32).part(4, 1));
        }
        let (born, all) = (system.totals().born, system.totals().born + system.totals().refused);
        assert_eq!((born, all), (if way == 0 { 0 } else { 30 }, 90), "{way} in {steps} steps");
    }
    // Those of the engine have their numbers in any list: of too few none is left out uncounted.
    let emitter = Burst { count: 5, at: 0.0, every: 0.0 };
    let lists = Uncounted(Emitter { burst: Some(emitter), ..Emitter::new(sphere(), 10.0) });
    let scene = Scene { emitters: &lists, ..Scene::EMPTY };
    let mut system = started(&scene, 100, 1);
    let report = system.step(&scene, Time::SECOND);
    assert_eq!((report.born, report.refused), (10, 5));
}

/// An emitter with a burst, which takes two numbers, of which it says one.
struct Uncounted<E>(E);

impl<E: Emit> Emit for Uncounted<E> {
    fn count(&self) -> usize {
        1
    }
    fn emit(&self, from: Time, to: Time, births: &mut Births<'_>) {
        self.0.emit(from, to, births);
    }
}
