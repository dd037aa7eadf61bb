//! Memory and its bounds: who owns it, how little there may be, and that nobody is lost.

use pointmass::constrain::{Bodies, Demand, Share, Words};
use pointmass::emit::Burst;
use pointmass::index::{IndexChoice, Room, SpatialIndex};
use pointmass::shape::Sphere;
use pointmass::{
    Constraint, Custom, CustomList, Emitter, Gravity, Heap, Inline, Likeness, Meetings, Method, MutualGravity,
    Particle, Penalty, Report, Scene, Size, Storage, System, Time, Varied, Vec3,
};
use pointmass_tests::busy::{SIZE, busy, emitters};
use pointmass_tests::{config, started};
use proptest::prelude::*;

/// The hash after every tenth of 120 frames.
fn hashes<B: Storage>(system: &mut System<B>, scene: &Scene<'_>) -> Vec<u64> {
    system.start(scene, 42).expect("it fits");
    let mut hashes = vec![system.hash()];
    for i in 1..=120 {
        system.step(scene, Time::frame(i, 60) - system.time());
        if i % 10 == 0 {
            hashes.push(system.hash());
        }
    }
    let totals = system.totals();
    assert!(totals.hits > 0 && totals.refused > 0 && totals.caps.springs > 0);
    assert!(totals.died.lifetime > 0 && totals.died.sink > 0 && totals.died.nonfinite == 0);
    assert_eq!(totals.initial + totals.born, system.len() as u64 + totals.died.total());
    hashes
}

#[test]
fn it_does_not_matter_who_owns_the_memory() {
    busy(|scene| {
        assert_eq!(Size { particles: 30, ..scene.size() }, SIZE);
        let mut inline = Inline::<30, 3, 8, 5>::new();
        let mut heap = Heap::new(SIZE);
        let expected = hashes(&mut System::with(Heap::new(SIZE)), scene);
        assert_eq!(hashes(&mut System::with(inline.clone()), scene), expected, "inline");
        assert_eq!(hashes(&mut System::with(&mut inline), scene), expected, "borrowed inline");
        assert_eq!(hashes(&mut System::with(&mut heap), scene), expected, "borrowed heap");
        assert_eq!(hashes(&mut System::with(&mut &mut heap), scene), expected, "borrowed twice");
        assert_eq!(hashes(&mut System::with(Box::new(heap.clone())), scene), expected, "boxed");
        // Memory that was in use before is as good as fresh.
        assert_eq!(hashes(&mut System::with(heap.slices()), scene), expected, "slices");
        let mut larger = Heap::new(Size { particles: 30, emitters: 9, springs: 20, columns: 7, kept: 2 });
        // More emitters are hashed, so only the particles can be compared.
        let mut system = System::with(&mut larger);
        let _ = hashes(&mut system, scene);
        let mut other = System::with(&mut heap);
        let _ = hashes(&mut other, scene);
        assert_eq!(system.particles().position, other.particles().position);
        assert_eq!(system.totals(), other.totals());
    });
}

#[test]
fn starting_again_forgets_everything() {
    busy(|scene| {
        let mut system = started(scene, 30, 7);
        let first = hashes(&mut system, scene);
        assert_eq!(hashes(&mut system, scene), first);
        // Another scene in between leaves no trace, one that does not fit either.
        system.start(&Scene { start: &[Particle::REST; 3], ..Scene::EMPTY }, 1).expect("it fits");
        system.step(&Scene::EMPTY, Time::SECOND);
        assert_eq!(hashes(&mut system, scene), first);
        let (a, b) = (emitters(), emitters());
        assert!(system.start(&Scene { emitters: &(&a, &b), ..*scene }, 1).is_err());
        assert!(system.is_empty() && system.time() == Time::ZERO && *system.totals() == Report::NOTHING);
        assert_eq!(hashes(&mut system, scene), first);
    });
}

#[test]
fn a_clone_goes_on_alike() {
    busy(|scene| {
        let mut system = started(scene, 30, 1);
        for i in 1..=40 {
            system.step(scene, Time::frame(i, 60) - system.time());
        }
        let mut twin = system.clone();
        for i in 41..=100 {
            let dt = Time::frame(i, 60) - system.time();
            assert_eq!(system.step(scene, dt), twin.step(scene, dt));
            assert_eq!(system.hash(), twin.hash());
        }
    });
}

/// Whoever goes back to a copy comes to the same end, in the columns that there are.
#[test]
fn one_goes_back_to_a_clone() {
    busy(|scene| {
        let mut system = started(scene, 30, 1);
        let run = |system: &mut System<Heap>, frames: std::ops::RangeInclusive<u64>| {
            for i in frames {
                system.step_to(scene, Time::frame(i, 60));
            }
            (system.hash(), *system.totals())
        };
        run(&mut system, 1..=40);
        let saved = system.try_clone().expect("a little memory");
        let places = system.particles().position.as_ptr();
        let end = run(&mut system, 41..=100);
        assert_ne!(end.0, saved.hash());
        system.clone_from(&saved);
        assert_eq!((system.hash(), system.time()), (saved.hash(), saved.time()));
        assert_eq!(run(&mut system, 41..=100), end);
        assert_eq!(system.particles().position.as_ptr(), places);
        // Memory of another size, and without some columns, becomes like it.
        let small = Size { particles: 3, ..Size::default() };
        let mut other = System::with(Heap::alike(small, &Likeness::default()).expect("a little memory"));
        other.clone_from(&saved);
        assert_eq!(run(&mut other, 41..=100), end);
    });
}

#[test]
fn room_for_nobody() {
    let (first, second) = emitters();
    let emitters = (first, second);
    let scene = Scene { emitters: &emitters, forces: &Gravity::EARTH, ..Scene::EMPTY };
    fn none<B: Storage>(memory: B, scene: &Scene<'_>) {
        let mut system = System::with(memory);
        system.start(scene, 1).expect("it fits");
        for i in 1..=60 {
            system.step(scene, Time::frame(i, 60) - system.time());
        }
        assert_eq!((system.capacity(), system.len(), system.totals().born), (0, 0, 0));
        // 50 and 20 a second, and ten at 0.2 and 0.7 s.
        assert_eq!(system.totals().refused, 50 + 20 + 20);
        assert!(system.spawn(&Particle::REST).is_err() && system.totals().refused == 91);
        let _ = system.hash();
    }
    none(Heap::new(Size { particles: 0, ..SIZE }), &scene);
    none(Inline::<0, 3, 0, 0>::new(), &scene);
    none(&mut Inline::<0, 3, 8, 5>::new(), &scene);
    let mut empty = System::with(Inline::<0, 0, 0, 0>::new());
    empty.start(&Scene::EMPTY, 0).expect("it fits");
    assert_eq!(empty.step(&Scene::EMPTY, Time::SECOND), Report::NOTHING);
}

#[test]
fn a_step_that_does_not_fit_is_counted_and_changes_nothing() {
    busy(|scene| {
        for size in [Size { emitters: 2, ..SIZE }, Size { springs: 7, ..SIZE }, Size { columns: 4, ..SIZE }] {
            let small = Scene { start: &[Particle { velocity: Vec3::X, ..Particle::REST }], ..Scene::EMPTY };
            let mut system = System::with(Heap::new(size));
            let error = system.start(scene, 1).expect_err("it does not fit");
            assert_eq!((error.need, error.have), (scene.size_for(size.particles), size));
            assert!(error.to_string().contains("needs 3 emitters, 8 springs, 5 columns"));
            assert!(system.is_empty());
            system.start(&small, 1).expect("it fits");
            system.step(&small, Time::SECOND);
            let before = (system.particles().position.to_vec(), system.time(), system.len());
            let report = system.step(scene, Time::SECOND);
            let mut expected = Report::NOTHING;
            expected.caps.insufficient_memory = 1;
            assert_eq!(report, expected);
            assert_eq!((system.particles().position.to_vec(), system.time(), system.len()), before);
            assert_eq!(system.totals().caps.insufficient_memory, 1);
            // It goes on with what fits.
            system.step(&small, Time::SECOND);
            assert_eq!(system.particles().position, [Vec3::X * 2.0]);
        }
    });
}

/// Keeps words that are not for particles, and works in others.
struct Keeper;

impl Constraint for Keeper {
    fn demand(&self) -> Demand {
        let words = |fixed| Words { per_row: 1, fixed };
        Demand { kept: words(1000), step: words(900), scratch: words(90), ..Demand::NONE }
    }

    fn project(&self, bodies: &mut Bodies<'_>, share: &mut Share<'_>) {
        assert_eq!(share.kept.fixed.len(), 1000);
        share.kept.fixed[999] += 1;
        for row in 0..bodies.len() {
            bodies.shift(row, Vec3::NEG_Y * bodies.position[row].y);
        }
    }
}

#[test]
fn what_is_not_for_particles_is_judged_by_how_many_there_may_be() {
    for (start, particles) in [(0, 1), (0, 500), (3, 3), (3, 40), (200, 200), (200, 7)] {
        let start = vec![Particle::REST; start];
        let ball = Sphere { center: Vec3::Y, radius: 0.1 };
        let source = Emitter { lifetime: Varied::exactly(0.5), ..Emitter::new(ball, 60.0) };
        let scene = Scene { start: &start, emitters: &source, constraints: &Keeper, substeps: 3, ..Scene::EMPTY };
        let size = scene.size_for(particles);
        // No more than what is asked for, but what rounding up to whole columns adds.
        assert!(size.kept * particles <= 1000 + 3 * particles, "{size:?}");
        let run = |size: Size| {
            let mut system = System::with(Heap::new(size));
            system.start(&scene, 1).expect("it fits");
            for i in 1..=30 {
                system.step_to(&scene, Time::frame(i, 60));
            }
            assert_eq!(system.totals().caps.insufficient_memory, 0);
            system.hash()
        };
        assert_eq!(run(size), run(Size { columns: size.columns + 9, kept: size.kept + 4, ..size }));
        for less in [Size { columns: size.columns - 1, ..size }, Size { kept: size.kept - 1, ..size }] {
            let refused = System::with(Heap::new(less)).start(&scene, 1).expect_err("it does not fit");
            assert_eq!(refused.need, size);
        }
    }
}

#[test]
fn an_empty_system_is_all_zeros() {
    // Written out, an empty system must show no digit but 0, no minus, and of its pending deaths only the first.
    let text = format!("{:?}", System::with(Inline::<2, 2, 2, 2>::new())).replace("Vec3", "");
    assert!(text.contains("position") && text.contains("row_of"));
    assert!(!text.contains(|c: char| ('1'..='9').contains(&c) || c == '-'), "{text}");
    assert!(!text.contains("true") && !text.contains("Some") && !text.contains("Sink"), "{text}");
    assert_eq!(pointmass::PendingDeath::Lives as u8, 0);
}

#[test]
fn those_beyond_the_capacity_are_refused_and_counted() {
    let start = [Particle::REST; 10];
    let scene = Scene { start: &start, ..Scene::EMPTY };
    for capacity in 0..=12 {
        let system = started(&scene, capacity, 0);
        assert_eq!(system.len(), capacity.min(10));
        assert_eq!(
            (system.totals().initial, system.totals().refused),
            (capacity.min(10) as u64, 10 - capacity.min(10) as u64)
        );
    }
}

/// As many columns as a number can count, which no memory has.
struct Everything;

impl CustomList for Everything {
    fn count(&self) -> usize {
        usize::MAX
    }
    fn get(&self, _: usize) -> Option<Custom<'_>> {
        Some(Custom::new("all"))
    }
}

impl IndexChoice for Everything {
    fn columns(&self) -> usize {
        usize::MAX
    }
    fn with_index(
        &self,
        _: &mut [u32],
        _: &[Vec3],
        _: f32,
        _: Option<&Room>,
        then: &mut dyn FnMut(Option<&dyn SpatialIndex>),
    ) {
        then(None);
    }
}

impl Constraint for Everything {
    fn demand(&self) -> Demand {
        let all = Words { per_row: usize::MAX, fixed: usize::MAX };
        Demand { kept: all, step: all, scratch: all, finds_near: true, ..Demand::NONE }
    }
    fn project(&self, _: &mut Bodies<'_>, _: &mut Share<'_>) {}
}

/// What no memory is enough for is refused, and a step of it is counted.
#[test]
fn demands_beyond_all_numbers_are_refused() {
    let start = [Particle::REST; 3];
    let scene = Scene { start: &start, ..Scene::EMPTY };
    assert_eq!(scene.size_for(usize::MAX).particles, usize::MAX);
    let balls = Scene { meetings: Meetings::IMPULSE, index: &Everything, ..scene };
    let penalty = Penalty { stiffness: 1.0, damping: 0.0, friction: Default::default(), reach: 1.0 };
    let touching = Scene { forces: &penalty, index: &Everything, ..scene };
    let (custom, held) = (Scene { custom: &Everything, ..scene }, Scene { constraints: &Everything, ..scene });
    for beyond in [custom, balls, touching, held, Scene { index: &Everything, custom: &Everything, ..held }] {
        let mut system = started(&scene, 3, 0);
        assert!(beyond.size().columns > 1_000_000 || beyond.size().kept > 1_000_000);
        assert_eq!(system.step(&beyond, Time::SECOND).caps.insufficient_memory, 1);
        assert_eq!(system.custom(&beyond).get("all").map_or(0, <[f32]>::len), 0);
        assert_eq!(system.custom_mut(&beyond).get_mut("all").map_or(0, |values| values.len()), 0);
        assert!(system.start(&beyond, 0).is_err());
    }
}

proptest! {
    #![proptest_config(config!(300))]

    /// However a world is made and stepped, nobody appears or vanishes uncounted, and no number is left unsound.
    #[test]
    fn nobody_is_lost(
        capacity in 0usize..60,
        rates in prop::array::uniform2(prop_oneof![0.0f32..300.0, Just(1e12f32)]),
        burst in 0u32..100,
        every in 0.0f32..0.4,
        lifetime in -0.5f32..1.0,
        gravity in prop::array::uniform3(-1e3f32..1e3),
        constant in prop_oneof![-1.0f32..1.0, Just(1e30f32)],
        method in 0usize..5,
        seed in any::<u64>(),
        steps in prop::collection::vec(prop_oneof![0.0f32..0.1, 0.0f32..2.0, Just(0.0f32), Just(1e4f32)], 1..12),
    ) {
        let (first, second) = emitters();
        let burst = Some(Burst { count: burst, at: 0.05, every });
        let lifetime = Varied { mean: lifetime, half_width: 0.2 };
        let emitters = (Emitter { rate: rates[0], burst, lifetime, ..first }, Emitter { rate: rates[1], ..second });
        let (gravity, mutual) =
            (Gravity { acceleration: gravity.into() }, MutualGravity { constant, softening: 0.01, ..MutualGravity::NEWTON });
        let integrator = Method::ALL[method].integrator();
        busy(|scene| {
            let forces = (gravity, mutual);
            let scene = Scene { emitters: &emitters, forces: &forces, integrator, ..*scene };
            let mut system = started(&scene, capacity, seed);
            let mut sum = *system.totals();
            for (i, &dt) in steps.iter().enumerate() {
                let before = system.len() as u64;
                let report = system.step(&scene, Time::from_seconds(dt));
                sum += report;
                prop_assert_eq!(before + report.born, system.len() as u64 + report.died.total());
                prop_assert!(report.hits <= 8 * capacity as u64);
                if let Some(id) = system.id(2 * i) {
                    prop_assert!(system.remove(&scene, id));
                    sum.died.other += 1;
                    sum.caps.springs = system.totals().caps.springs;
                }
                prop_assert_eq!(system.totals(), &sum);
                let p = system.particles();
                prop_assert!(p.position.iter().chain(p.velocity).all(|v| v.is_finite()));
                prop_assert!(p.dies.iter().all(|&dies| dies > system.time()));
                prop_assert!(p.born.iter().all(|&born| born <= system.time()));
            }
            let totals = system.totals();
            prop_assert_eq!(totals.initial + totals.born, system.len() as u64 + totals.died.total());
            Ok(())
        })?;
    }
}
