//! Columns of a user's own, and what constraints keep: read and written by all who may.

use core::ops::Range;
use pointmass::constrain::{Bodies, Demand, Share, Words};
use pointmass::emit::Births;
use pointmass::force::{Needs, State, Writing};
use pointmass::index::{IndexChoice, Structure};
use pointmass::reap::Verdicts;
use pointmass::{
    Attention, Cause, Chance, Constraint, Custom, CustomColumnsMut, Drag, Emit, Emitter, Force, Gravity, Inline,
    Observer, Particle, Phase, Reaper, Relaxation, Scene, System, Time, Varied, Vec3,
};
use pointmass_tests::{point, run, started};

/// Smoke that rises where it is warm, and cools down by 2 degrees a second. Neighbours within a metre count each other.
struct Smoke;

impl Force for Smoke {
    fn add_to(&self, state: &State<'_>, rows: Range<usize>, total: &mut [Vec3]) {
        let heat = state.custom.get("heat").expect("the scene has it");
        assert_eq!(heat.len(), state.position.len());
        total.iter_mut().zip(&heat[rows]).for_each(|(total, heat)| *total += Vec3::Y * *heat);
    }
    fn is_local(&self) -> bool {
        true
    }
    fn needs(&self) -> Needs {
        Needs { write: Some(Writing::COLUMNS), ..Needs::default() }
    }
    fn write(&self, state: &State<'_>, custom: &mut CustomColumnsMut<'_>, dt: f32) {
        assert!(state.custom.get("heat").is_none_or(<[f32]>::is_empty));
        let heat = custom.get_mut("heat").expect("the scene has it");
        assert_eq!(heat.len(), state.position.len());
        heat.iter_mut().for_each(|heat| *heat -= 2.0 * dt);
    }
}

/// Takes those that are cold.
struct Cold;

impl Reaper for Cold {
    fn judge(&self, state: &State<'_>, rows: Range<usize>, verdicts: &mut Verdicts<'_>) {
        let heat = &state.custom.get("heat").expect("the scene has it")[rows];
        heat.iter().enumerate().filter(|(_, heat)| **heat < -0.1).for_each(|(nth, _)| verdicts.end(nth, Cause::Other));
    }
}

/// Births that are as warm as their number.
struct Stove;

impl Emit for Stove {
    fn count(&self) -> usize {
        1
    }
    fn emit(&self, from: Time, to: Time, births: &mut Births<'_>) {
        let number = births.claim();
        for at in births.due(number, 20.0, from, to) {
            if births.give(number, at, |_| Particle::REST).is_err() {
                continue;
            }
            let serial = births.state().id(births.state().position.len() - 1).expect("just born").serial();
            let mut custom = births.custom_mut();
            let heat = custom.get_mut("heat").expect("the scene has it");
            let last = heat.last_mut().expect("just born");
            assert_eq!(*last, 7.0, "what newborns have");
            *last = (serial % 5) as f32;
        }
    }
}

/// Counts the steps that each particle has ended, in a column of its own, and wants to know so much.
struct Clerk(Attention);

impl Observer for Clerk {
    fn attention(&self) -> Attention {
        self.0
    }
    fn after(&mut self, _: Phase, state: &State<'_>) {
        assert_eq!(state.custom.get("steps").map(<[f32]>::len), Some(state.position.len()));
    }
    fn write(&mut self, state: &State<'_>, custom: &mut CustomColumnsMut<'_>) {
        let steps = custom.get_mut("steps").expect("the scene has it");
        assert_eq!(steps.len(), state.position.len());
        steps.iter_mut().for_each(|steps| *steps += 1.0);
    }
}

#[test]
fn a_user_column() {
    let start = [Particle::REST, Particle { position: Vec3::X, ..Particle::REST }];
    let custom = [Custom { start: &[30.0], newborn: 7.0, ..Custom::new("heat") }, Custom::new("steps")];
    let scene = Scene {
        start: &start,
        emitters: &Stove,
        forces: &(Smoke, Drag {}),
        reapers: &(Cold, Chance { rate: 0.1 }),
        custom: &custom,
        ..Scene::EMPTY
    };
    assert_eq!((scene.kept(), scene.size().kept), (2, 2));
    let mut hashes = Vec::new();
    for attention in [Attention::Nothing, Attention::Events, Attention::Phases] {
        let mut system = started(&scene, 90, 5);
        assert_eq!(system.custom(&scene).get("heat"), Some(&[30.0, 7.0][..]));
        for i in 1..=180 {
            system.step_observed(&scene, Time::frame(i, 60) - system.time(), &mut Clerk(attention));
        }
        let now = system.time();
        let (p, custom) = (system.particles(), system.custom(&scene));
        for (row, heat) in custom.column(0).iter().enumerate() {
            let given = match p.serial[row] {
                0 => 30.0,
                1 => 7.0,
                serial => (serial % 5) as f32,
            };
            // Counted in whole steps: who is born in one cools down in all of it.
            let steps = custom.column(1)[row];
            let age = (now - p.born[row]).seconds();
            assert!((steps - (age * 60.0 + 0.5)).abs() < 0.51, "{steps} steps in {age} s");
            assert!((heat - (given - 2.0 * steps / 60.0)).abs() < 1e-4, "{heat} of {given}");
            // Those that are warm have risen.
            assert!((given < 1.0) == (p.velocity[row].y <= 0.05) || age < 0.2, "{} {given}", p.velocity[row]);
        }
        assert!(system.totals().died.other > 5 && system.totals().died.chance > 3 && system.len() > 5);
        hashes.push(system.hash());
    }
    assert!(hashes.windows(2).all(|pair| pair[0] == pair[1]), "{hashes:x?}");
    // The owner writes as well, and the hash sees it; what is put in by hand has nothing yet.
    let mut system = started(&scene, 90, 5);
    let before = system.hash();
    system.custom_mut(&scene).get_mut("heat").expect("the scene has it")[1] = 1.0;
    assert_ne!(system.hash(), before);
    system.spawn(&Particle::REST).expect("there is room");
    assert_eq!(system.custom(&scene).get("heat"), Some(&[30.0, 1.0, 0.0][..]));
    assert!(system.custom(&scene).get("smoke").is_none() && system.custom(&Scene::EMPTY).count() == 0);
}

#[test]
fn columns_fit_into_a_static_and_are_asked_for() {
    let custom = [Custom { newborn: 2.0, ..Custom::new("fuel") }];
    let cooling = [Relaxation { column: "fuel", toward: 1.0, rate: 3.0 }];
    let scene = Scene { start: &[Particle::REST], forces: &cooling, custom: &custom, ..Scene::EMPTY };
    let mut small = System::with(Inline::<3, 0, 0, 1>::new());
    let insufficient_memory = small.start(&scene, 0).expect_err("it keeps nothing");
    assert!(insufficient_memory.to_string().contains("1 kept words"), "{insufficient_memory}");
    let mut system = System::with(Inline::<3, 0, 0, 1, 1>::new());
    system.start(&scene, 0).expect("it fits");
    for (n, h) in [(1, 0.5), (50, 0.01), (3, 1.0 / 6.0)] {
        system.start(&scene, 0).expect("it fits");
        (0..n).for_each(|_| {
            system.step(&scene, Time::from_seconds(h));
        });
        let fuel = system.custom(&scene).column(0)[0];
        let exact = 1.0 + (-3.0 * f64::from(n) * f64::from(h)).exp();
        assert!((f64::from(fuel) - exact).abs() < 1e-5, "{fuel} {exact}");
    }
}

/// Whenever in a step somebody is born, what relaxes is what the closed form says at its age.
#[test]
fn the_newborn_relax_for_as_long_as_they_live() {
    const RATE: f32 = 1.3;
    let jet = Emitter { lifetime: Varied { mean: 1.5, half_width: 1.0 }, ..Emitter::new(point(Vec3::ZERO), 97.0) };
    let custom = [Custom { start: &[50.0], newborn: 300.0, ..Custom::new("heat") }];
    let cooling = Relaxation { column: "heat", toward: 20.0, rate: RATE };
    for (fps, substeps) in [(24, 1), (24, 5), (60, 1), (60, 5), (240, 1), (240, 5)] {
        let scene = Scene {
            start: &[Particle::REST],
            emitters: &jet,
            forces: &(&cooling, Gravity::EARTH),
            custom: &custom,
            substeps,
            ..Scene::EMPTY
        };
        let mut system = started(&scene, 300, 3);
        for step in 1..=2 * fps {
            system.step(&scene, Time::frame(step.into(), fps) - system.time());
            let (p, heat) = (system.particles(), system.custom(&scene).column(0));
            for (row, &heat) in heat.iter().enumerate() {
                let first = if p.serial[row] == 0 { 50.0 } else { 300.0 };
                let age = (system.time() - p.born[row]).seconds_f64();
                let exact = 20.0 + (first - 20.0) * (-f64::from(RATE) * age).exp();
                // A step errs by some 4e-5 of roundings, and that fades within 1 / 1.3 s, which is 185 steps at the most. Who relaxed for half a step
                // too long would be off by 0.75 at the least.
                assert!(
                    (f64::from(heat) - exact).abs() < 0.01,
                    "{heat}, not {exact}, at {age} s in steps of 1/{fps} s"
                );
            }
        }
        let totals = system.totals();
        assert!(totals.born > 180 && totals.died.lifetime > 30, "{totals:?}");
    }
}

/// Keeps of each particle how often it has been asked for it and who that was, and altogether how often; wears a column
/// of the scene's out.
struct Wear;

impl Constraint for Wear {
    fn demand(&self) -> Demand {
        Demand { kept: Words { per_row: 2, fixed: 2 }, ..Demand::NONE }
    }
    fn project(&self, bodies: &mut Bodies<'_>, share: &mut Share<'_>) {
        let (times, who) = share.kept.rows.split_at_mut(share.capacity);
        assert_eq!((who.len(), share.kept.fixed.len()), (share.capacity, 2));
        for row in 0..bodies.len() {
            let name = bodies.id(row).expect("a row that is there").serial() + 1;
            assert!(if times[row] == 0 { who[row] == 0 } else { who[row] == name }, "it goes with its particle");
            times[row] += 1;
            who[row] = name;
            bodies.custom.get_mut("worn").expect("the scene has it")[row] += 0.5;
            assert_eq!(bodies.custom.read().column(0)[row], 0.5 * times[row] as f32);
        }
        share.kept.fixed[1] += 1;
        let step = share.kept.fixed[1].div_ceil(bodies.substep.count);
        assert_eq!(share.kept.fixed[1], (step - 1) * bodies.substep.count + bodies.substep.number + 1);
    }
}

/// Kept memory is zero at a birth, goes with its particle, differs for two of a kind, and is hashed.
#[test]
fn what_constraints_keep() {
    let jet = Emitter { lifetime: Varied { mean: 0.5, half_width: 0.3 }, ..Emitter::new(point(Vec3::ZERO), 60.0) };
    let custom = [Custom::new("worn")];
    let both = Scene {
        emitters: &jet,
        forces: &Gravity::EARTH,
        constraints: &Wear,
        custom: &custom,
        substeps: 3,
        ..Scene::EMPTY
    };
    let mut hashes = Vec::new();
    for index in [&() as &dyn IndexChoice, &Structure::Kd] {
        let scene = Scene { index, ..both };
        let mut system = started(&scene, 70, 2);
        run(&mut system, &scene, 1.0 / 60.0, 120);
        assert!(system.totals().died.lifetime > 50);
        let worn = system.custom(&scene).get("worn").expect("the scene has it");
        let age = |row: usize| (system.time() - system.particles().born[row]).seconds();
        for (row, worn) in worn.iter().enumerate() {
            // Constraints do not see those who are born in the step.
            assert!((worn - 1.5 * (age(row) * 60.0).floor()).abs() < 1.6, "{worn} at {}", age(row));
        }
        hashes.push(system.hash());
    }
    assert_eq!(hashes[0], hashes[1]);
    assert_eq!(Scene { start: &[Particle::REST; 2], ..both }.kept(), 1 + 2 + 1);
    // Which differs without what is kept.
    struct Nothing;
    impl Constraint for Nothing {
        fn project(&self, bodies: &mut Bodies<'_>, _: &mut Share<'_>) {
            bodies.custom.column_mut(0).iter_mut().for_each(|worn| *worn += 0.5);
        }
    }
    let scene = Scene { constraints: &Nothing, ..both };
    let mut system = started(&scene, 70, 2);
    run(&mut system, &scene, 1.0 / 60.0, 120);
    assert_ne!(system.hash(), hashes[0]);
}
