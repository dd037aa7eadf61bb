//! Materials over life: what physics makes of them, against closed forms; how particles look, whatever the steps; scene files.

use pointmass::draw::{Appearance, Sprite, View, appearance, sprites};
use pointmass::material::{Blend, Curve, Facing, Life, Over, SpriteMaterial, Varying};
use pointmass::scene::{Model, SceneFile};
use pointmass::{
    ContactMaterial, Drag, Emitter, Gravity, Ledger, Material, Method, Particle, QuadraticDrag, Scene, Time, Varied,
    Vec3,
};
use pointmass_tests::{often, point, started};
use std::cmp::min;

const PLAIN: Material<'static> = Material::of(ContactMaterial { elasticity: None, friction: None });

fn plain(keys: &[[f32; 2]]) -> Option<Varying<'_>> {
    Some(Varying { from: Curve { keys, over: Over::Life, smooth: false }, to: None })
}

fn of(life: Life<'_>) -> [Material<'_>; 1] {
    [Material { life, ..PLAIN }]
}

/// A particle of the material with number 0 that lives for 4 s.
const MORTAL: Particle = Particle { material: Some(0), lifetime: 4.0, ..Particle::REST };

/// Where a scene's only particle is after so many steps to 2 s, and how fast.
fn after(scene: &Scene<'_>, steps: u32) -> (Vec3, Vec3) {
    let mut system = started(scene, 1, 1);
    let end = Time::from_seconds(2.0);
    (1..=steps).for_each(|n| {
        system.step(scene, end.part(n, steps) - system.time());
    });
    (system.particles().position[0], system.particles().velocity[0])
}

/// The sum over time, over the first half of a life of 4 s, of a curve from 1 at birth to `last` at death.
fn half_of(last: f32) -> f32 {
    2.0 * (1.0 + 0.25 * (last - 1.0))
}

#[test]
fn drag_that_changes_brakes_as_its_equation_says_by_every_method() {
    for (k, last) in [(0.5f32, 4.0f32), (1.5, 0.0), (0.2, 10.0)] {
        let keys = [[0.0, 1.0], [1.0, last]];
        let materials = of(Life { drag: plain(&keys), ..Life::default() });
        let start = [Particle { velocity: Vec3::new(3.0, -1.0, 0.5), drag: k, mass: 2.0, ..MORTAL }];
        // v' = −k f(t) v / m.
        let expected = start[0].velocity * (-k * half_of(last) / 2.0).exp();
        for method in Method::ALL {
            let scene =
                Scene { start: &start, forces: &Drag {}, materials: &materials, integrator: method, ..Scene::EMPTY };
            let error = |steps: u32| (after(&scene, steps).1 - expected).length() / start[0].velocity.length();
            let (coarse, fine) = (error(60), error(240));
            assert!(fine < 0.02 && fine < 0.5 * coarse + 2e-6, "{} {k} {last}: {coarse}, {fine}", method.name());
            if method.name() == "rk4" || method.name() == "midpoint" {
                assert!(fine < 2e-5, "{} {k} {last}: {fine}", method.name());
            }
        }
    }
}

#[test]
fn what_loses_mass_falls_alike_and_is_braked_harder() {
    let (k, last) = (0.4f32, 0.25f32);
    let keys = [[0.0, 1.0], [1.0, last]];
    let materials = of(Life { mass: plain(&keys), ..Life::default() });
    let start = [Particle { velocity: Vec3::X, drag: k, ..MORTAL }];
    for method in [Method::Midpoint, Method::Rk4, Method::Verlet, Method::Symplectic, Method::Implicit] {
        let fall = Scene {
            start: &start,
            forces: &Gravity::EARTH,
            materials: &materials,
            integrator: &method,
            ..Scene::EMPTY
        };
        let same = Scene { materials: &(), ..fall };
        assert!((after(&fall, 120).1 - after(&same, 120).1).length() < 1e-4, "{}", method.name());
        // v' = −k v / m(t) with m = 1 − a t: v = (m / 1)^(k/a).
        let scene = Scene { forces: &Drag {}, ..fall };
        let a = (1.0 - last) / 4.0;
        let expected = (1.0 - 2.0 * a).powf(k / a);
        let speed = after(&scene, 480).1.x;
        assert!((speed - expected).abs() < 2e-3, "{}: {speed}, not {expected}", method.name());
    }
    // A fixed particle stays so.
    let scene = Scene {
        start: &[Particle { fixed: true, ..start[0] }],
        forces: &Gravity::EARTH,
        materials: &materials,
        ..Scene::EMPTY
    };
    assert_eq!(after(&scene, 60), (Vec3::ZERO, Vec3::ZERO));
}

#[test]
fn what_is_buoyant_rises_as_its_equation_says_by_every_method() {
    let keys = [[0.0, 0.5], [1.0, 2.5]];
    let materials = of(Life { buoyancy: plain(&keys), ..Life::default() });
    let start = [MORTAL];
    let g = Gravity { acceleration: Vec3::new(1.0, -8.0, 0.5) };
    // 1 − b(t) = 0.5 − t / 2 s: v = g (t / 2 − t² / 4), which is none after 2 s; x = g (t² / 4 − t³ / 12).
    let (x, v) = (g.acceleration * (1.0 - 2.0 / 3.0), Vec3::ZERO);
    for method in Method::ALL {
        for alone in [true, false] {
            let with_drag = (g, Drag {}, QuadraticDrag { coefficient: 0.0 });
            let forces: &dyn pointmass::Force = if alone { &g } else { &with_drag };
            let scene = Scene { start: &start, forces, materials: &materials, integrator: method, ..Scene::EMPTY };
            let (at, speed) = after(&scene, 400);
            let order = if ["euler", "symplectic", "implicit", "lecture_midpoint"].contains(&method.name()) {
                0.05
            } else {
                2e-3
            };
            assert!((at - x).length() < order && (speed - v).length() < order, "{} {at} {speed}", method.name());
        }
    }
}

/// What is read is of the instant that the system has reached, however long its steps are and from the start on; the books have no other energy.
#[test]
fn drag_and_mass_are_those_of_the_instant() {
    let (heavier, slower) = ([[0.0, 0.5], [0.25, 2.0], [1.0, 1.0]], [[0.0, 3.0], [1.0, 0.0]]);
    let materials = of(Life { mass: plain(&heavier), drag: plain(&slower), ..Life::default() });
    let at = |share: f32| {
        let mass = if share < 0.25 { 0.5 + 6.0 * share } else { 2.0 - (share - 0.25) / 0.75 };
        [4.0 * mass, 0.1 * (3.0 - 3.0 * share)]
    };
    let velocity = Vec3::new(3.0, 0.0, 0.0);
    let start = [Particle { velocity, mass: 4.0, drag: 0.1, ..MORTAL }];
    for (steps, substeps) in [(1, 1), (3, 1), (7, 3), (100, 2)] {
        let scene = Scene { start: &start, materials: &materials, substeps, ..Scene::EMPTY };
        let mut system = started(&scene, 1, 1);
        let mut ledger = Ledger::new(&system, &scene);
        for step in 0..=steps {
            let [mass, drag] = at(step as f32 / steps as f32 * 0.9);
            let (is, told) = (system.particles(), format!("step {step} of {steps}"));
            assert!((is.mass[0] - mass).abs() < 1e-5 && (is.drag[0] - drag).abs() < 1e-6, "{told}: {}", is.mass[0]);
            assert!((is.inverse_mass[0] * is.mass[0] - 1.0).abs() < 1e-6, "{told}");
            let energy = 0.5 * f64::from(mass) * f64::from(velocity.length_squared());
            assert!((ledger.books().closing - energy).abs() < 1e-4, "{told}: {:?}", ledger.books());
            let next = Time::from_seconds(3.6).part(min(step + 1, steps), steps);
            system.step_to_observed(&scene, next, &mut ledger);
        }
        let books = ledger.books();
        let rest = [books.deletion, books.outside, books.remainder];
        assert!(rest.iter().all(|rest| rest.abs() < 1e-3), "{steps} steps: {books:?}");
    }
}

#[test]
fn the_ledger_has_what_carries_and_what_mass_comes_and_goes() {
    let (buoyant, lighter) = ([[0.0, 0.5], [1.0, 2.5]], [[0.0, 1.0], [1.0, 0.25]]);
    let materials = of(Life { buoyancy: plain(&buoyant), mass: plain(&lighter), ..Life::default() });
    let start = [Particle { velocity: Vec3::new(2.0, 1.0, 0.0), ..MORTAL }];
    for mass_changes in [false, true] {
        let only = of(Life { buoyancy: plain(&buoyant), ..Life::default() });
        let materials = if mass_changes { &materials } else { &only };
        let (forces, integrator) = (&Gravity::EARTH, &pointmass::Rk4);
        let scene = Scene { start: &start, forces, materials, integrator, ..Scene::EMPTY };
        let mut system = started(&scene, 1, 1);
        let mut ledger = Ledger::new(&system, &scene);
        for frame in 1..=360 {
            system.step_observed(&scene, Time::frame(frame, 120) - system.time(), &mut ledger);
        }
        let books = ledger.books();
        assert!(books.work("gravity").abs() > 1.0 && books.remainder.abs() < 2e-3, "{books:?}");
        assert!(if mass_changes { books.emission < -1.0 } else { books.emission == 0.0 }, "{books:?}");
    }
}

#[test]
fn a_life_is_the_same_however_it_is_cut_into_births_and_deaths() {
    // Newborns have had only a part of their step, and rows move when others die.
    let keys = [[0.0, 2.0], [1.0, 0.0]];
    let materials = of(Life { drag: plain(&keys), ..Life::default() });
    let shape = point(Vec3::ZERO);
    let emitter = Emitter {
        speed: Varied::exactly(3.0),
        drag: Varied::exactly(0.7),
        lifetime: Varied { mean: 1.2, half_width: 0.6 },
        material: Some(0),
        ..Emitter::new(shape, 90.0)
    };
    let scene = Scene {
        emitters: &emitter,
        forces: &Drag {},
        materials: &materials,
        integrator: &pointmass::Rk4,
        ..Scene::EMPTY
    };
    for fps in [30u32, 61, 144] {
        let mut system = started(&scene, 400, 7);
        for frame in 1..=3 * u64::from(fps) {
            system.step(&scene, Time::frame(frame, fps) - system.time());
        }
        let state = system.state(&scene);
        assert!(system.totals().died.total() > 50 && system.len() > 50);
        for row in 0..system.len() {
            let (age, life) = ((state.time - state.born[row]).seconds(), (state.dies[row] - state.born[row]).seconds());
            // ∫ 2 (1 − t / life) dt.
            let speed = 3.0 * (-0.7 * (2.0 * age - age * age / life)).exp();
            let is = state.velocity[row].length();
            let rough = 6.0 / fps as f32 / fps as f32;
            assert!((is - speed).abs() < 1e-4 + 3.0 * rough, "{fps}: {is}, not {speed}, at {age} of {life}");
        }
    }
}

/// How a scene's first particle looks at an instant, stepped there in so many steps.
fn look(scene: &Scene<'_>, seconds: f32, steps: u32) -> Option<Appearance> {
    let mut system = started(scene, scene.start.len(), 3);
    let end = Time::from_seconds(seconds);
    (1..=steps).for_each(|n| {
        system.step(scene, end.part(n, steps) - system.time());
    });
    appearance(&system.state(scene), 0)
}

#[test]
fn who_dies_of_age_fades_unless_something_else_is_said() {
    let start = [MORTAL];
    let scene = Scene { start: &start, ..Scene::EMPTY };
    let opacity = |scene: &Scene<'_>, at| look(scene, at, 7).map(|look| look.color[3]);
    assert_eq!([0.0, 1.0, 3.19].map(|at| opacity(&scene, at)), [Some(255); 3]);
    assert!(opacity(&scene, 3.6).is_some_and(|half| half.abs_diff(128) <= 1));
    assert_eq!(opacity(&scene, 3.999), Some(0));
    assert_eq!(opacity(&scene, 4.0), None);
    let keys = [[0.0, 0.5], [1.0, 0.5]];
    let materials = of(Life { opacity: plain(&keys), ..Life::default() });
    assert_eq!(opacity(&Scene { materials: &materials, ..scene }, 3.999), Some(128));
    let immortal = [Particle { lifetime: 0.0, ..MORTAL }];
    assert_eq!(opacity(&Scene { start: &immortal, ..scene }, 1e6), Some(255));
}

#[test]
fn looks_follow_their_curves_and_nothing_else() {
    let (size, tint) = ([[0.0, 0.5], [2.0, 2.5]], [[0.0, 1.0, 0.5, 0.0], [1.0, 0.0, 0.5, 1.0]]);
    let life = Life {
        size: Some(Varying { from: Curve { keys: &size, over: Over::Seconds, smooth: false }, to: None }),
        color: Some(Varying { from: Curve { keys: &tint, over: Over::Life, smooth: false }, to: None }),
        glow: plain(&[[0.0, 1.0], [0.5, 0.0]]),
        rotation: plain(&[[0.0, -1.0], [1.0, 3.0]]),
        ..Life::default()
    };
    let start = [Particle { radius: 0.5, color: Some([200, 100, 40, 255]), ..MORTAL }];
    let (marked, of_its_own) = ([Material { size: 0.2, glow: 0.7, life, ..PLAIN }], [Material { glow: 0.7, ..PLAIN }]);
    for steps in [1, 3, 60] {
        let scene = Scene { start: &start, materials: &marked, ..Scene::EMPTY };
        let seen = look(&scene, 1.0, steps).expect("it lives");
        assert!((seen.diameter - 0.3).abs() < 1e-6 && (seen.scale - 1.5).abs() < 1e-6 && !seen.solid, "{seen:?}");
        assert_eq!(seen.color, [150, 50, 10, 255]);
        assert!((seen.glow - 0.5).abs() < 1e-6 && seen.rotation.abs() < 1e-6, "{seen:?}");
        let seen = look(&Scene { materials: &of_its_own, ..scene }, 1.0, steps).expect("it lives");
        let as_it_is = Appearance {
            diameter: 1.0,
            scale: 1.0,
            solid: true,
            color: [200, 100, 40, 255],
            glow: 0.7,
            rotation: 0.0,
            frame: 0,
        };
        assert_eq!(seen, as_it_is);
    }
}

#[test]
fn each_has_a_place_of_its_own_between_two_curves() {
    let side = |keys| Curve { keys, over: Over::Life, smooth: false };
    let between = Some(Varying { from: side(&[[0.0, 0.0]]), to: Some(side(&[[0.0, 1.0]])) });
    let materials = of(Life { size: between, rotation: between, ..Life::default() });
    let start = vec![Particle { radius: 0.5, ..MORTAL }; often(40_000)];
    let scene = Scene { start: &start, materials: &materials, ..Scene::EMPTY };
    let mut system = started(&scene, start.len(), 11);
    let looks = |system: &pointmass::System<pointmass::Heap>| {
        let state = system.state(&scene);
        (0..system.len()).filter_map(|row| appearance(&state, row)).collect::<Vec<_>>()
    };
    let first = looks(&system);
    let n = first.len() as f64;
    // The sum of uniform numbers, and the product of two that have nothing to do with each other.
    let mean = |of: &dyn Fn(&Appearance) -> f32| first.iter().map(|look| f64::from(of(look))).sum::<f64>() / n;
    let (size, turn) = (mean(&|look| look.scale), mean(&|look| look.rotation));
    let both = mean(&|look| (look.scale - 0.5) * (look.rotation - 0.5));
    let five = 5.0 / n.sqrt();
    assert!((size - 0.5).abs() < 0.289 * five && (turn - 0.5).abs() < 0.289 * five && both.abs() < five / 12.0);
    let mut sorted: Vec<f32> = first.iter().map(|look| look.scale).collect();
    sorted.sort_by(f32::total_cmp);
    let off = sorted.iter().enumerate().map(|(i, x)| (f64::from(*x) - (i as f64 + 0.5) / n).abs()).fold(0.0, f64::max);
    assert!(off < 1.95 / n.sqrt(), "Kolmogorov and Smirnov: {off}");
    system.step(&scene, Time::from_seconds(0.5));
    assert_eq!(looks(&system), first);
}

#[test]
fn files_say_lives_in_three_ways_and_what_is_wrong_with_them_is_told() {
    let with = |life: &str| {
        format!(r#"{{"materials": [{{"life": {{{life}}}}}], "particles": [{{"material": 0, "lifetime": 2}}]}}"#)
    };
    let file = |life: &str| SceneFile::from_json("a.json", &with(life)).and_then(|scene| scene.check().map(|()| scene));
    let scene = file(
        r#""size": [[0, 1], [1, 3]], "color": [[0, 1, 1, 1], [1, 0, 0, 0]],
        "drag": {"keys": [[0, 1], [9, 2]], "over": "seconds", "smooth": true},
        "rotation": {"between": [{"keys": [[0, 0]]}, {"keys": [[0, 6.25]]}]}"#,
    )
    .expect("all three ways");
    assert_eq!(SceneFile::from_json("", &scene.to_json()), Ok(scene.clone()));
    let model = Model::load(&scene, "a.json", &mut ()).expect("it can be run");
    let mut system = started(&model.scene(), 1, 1);
    system.step(&model.scene(), Time::from_seconds(1.0));
    let seen = appearance(&system.state(&model.scene()), 0).expect("it lives");
    assert!(seen.scale == 2.0 && (0.0..6.25).contains(&seen.rotation), "{seen:?}");
    for (life, told) in [
        (r#""size": []"#, "materials[0].life.size: has no keys"),
        (r#""size": [[0, 1], [0.5, -1]]"#, "materials[0].life.size: key 1 has to be zero or more, not -1"),
        (r#""opacity": [[0, 1.5]]"#, "materials[0].life.opacity: key 0 has to be from 0 to 1, not 1.5"),
        (r#""mass": [[0, 0]]"#, "materials[0].life.mass: key 0 has to be above zero, not 0"),
        (
            r#""glow": [[0.5, 1], [0.25, 1]]"#,
            "materials[0].life.glow: key 1 is at 0.25, before the one in front of it, at 0.5",
        ),
        (r#""drag": [[0, 1], [3, 1]]"#, r#"materials[0].life.drag: key 1 is at 3, but a life goes from 0 to 1"#),
        (r#""color": [[0, 1]]"#, "expected [[instant, value], ...]"),
        (r#""drag": {"keys": [[0, 1]], "Over": "life"}"#, "expected [[instant, value], ...]"),
        (r#""Size": [[0, 1]]"#, "unknown field `Size`"),
    ] {
        let error = file(life).expect_err(life).to_string();
        assert!(error.contains(told), "{life}: {error}");
    }
}

#[test]
fn a_flipbook_shows_the_frame_of_its_rate_or_all_over_its_life() {
    let frames = |frames, rate| SpriteMaterial { frames, rate, blend: Blend::Alpha, facing: Facing::Camera };
    for (sprite, over) in
        [(frames(6, 7.5), false), (frames(12, 0.0), true), (frames(1, 100.0), false), (frames(0, 0.0), true)]
    {
        let materials = [Material { size: 0.1, sprite: Some(sprite), ..Material::of(ContactMaterial::default()) }];
        let start = [Particle { lifetime: 4.0, material: Some(0), ..Particle::REST }];
        let scene = Scene { start: &start, materials: &materials, ..Scene::EMPTY };
        for at in [0.0f32, 0.1, 0.25, 0.75, 1.875, 2.5, 3.3, 3.99] {
            let count = f32::from(sprite.frames.max(1));
            let exact = if over { (at / 4.0 * count).floor() } else { (at * sprite.rate).floor() % count };
            assert_eq!(look(&scene, at, 3).map(|look| f32::from(look.frame)), Some(exact), "{sprite:?} at {at}");
        }
    }
}

#[test]
fn only_who_has_a_picture_and_can_be_seen_is_in_the_list_and_what_finds_no_room_is_counted() {
    let sprite = SpriteMaterial { frames: 1, rate: 0.0, blend: Blend::Additive, facing: Facing::Velocity };
    let plain = Material { size: 0.1, ..Material::of(ContactMaterial::default()) };
    let materials = [plain, Material { sprite: Some(sprite), ..plain }];
    let start: Vec<_> = (0..60u16)
        .map(|i| Particle {
            position: Vec3::new(f32::from(i), 0.0, 0.0),
            velocity: Vec3::new(0.0, 1.0, f32::from(i) * 0.1),
            material: (i % 3).checked_sub(1),
            color: Some([200, 100, 50, if i % 5 == 0 { 0 } else { 255 }]),
            ..Particle::REST
        })
        .collect();
    let scene = Scene { start: &start, materials: &materials, ..Scene::EMPTY };
    let system = started(&scene, start.len(), 1);
    let view = View { eye: Vec3::new(5.0, 3.0, 20.0), up: Vec3::Y };
    let mut list = [Sprite::NONE; 100];
    let (count, left_out) = sprites(&system.state(&scene), &view, &mut list);
    assert_eq!((count, left_out), (16, 0));
    for sprite in &list[..count] {
        let row = sprite.center.x as usize;
        assert!(row % 3 == 2 && !row.is_multiple_of(5) && sprite.material == 1 && sprite.blend == Blend::Additive);
        // Its top is along the velocity as it is seen, and it faces the eye as far as it can.
        let toward = (view.eye - sprite.center).normalize();
        let seen = start[row].velocity.reject_from(toward).normalize();
        assert!((sprite.up.normalize() - seen).length() < 1e-5 && (sprite.up.length() - 0.05).abs() < 1e-6);
        assert!(sprite.right.cross(sprite.up).normalize().dot(toward) > 1.0 - 1e-5);
    }
    assert_eq!(sprites(&system.state(&scene), &view, &mut list[..7]), (7, 9));
}
