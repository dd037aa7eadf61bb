//! Motion by keys: scenery, emitters and attached particles are where the script says, by every method and step.

use pointmass::emit::Emit;
use pointmass::force::Friction;
use pointmass::motion::{Frame, Key, Motion, Script};
use pointmass::shape::{Aabb, Collider, Cuboid, Line, Moving, Segment};
use pointmass::{
    Attach, ContactMaterial, Distance, Emitter, Gravity, Method, Particle, Scene, Spread, Spring, Time, Varied, Vec3,
};
use pointmass_tests::{Random, every, methods, run, started};

const KEYS: [Key; 4] = [
    Key { time: 0.25, place: Vec3::ZERO, rotation: Vec3::ZERO },
    Key { time: 1.0, place: Vec3::new(0.5, 0.25, 0.0), rotation: Vec3::new(0.0, 1.0, 0.0) },
    Key { time: 1.75, place: Vec3::new(0.5, 0.5, -0.5), rotation: Vec3::new(0.0, 2.0, 0.25) },
    Key { time: 3.0, place: Vec3::new(-0.25, 0.0, -0.5), rotation: Vec3::new(-0.25, 4.0, 0.0) },
];

fn script() -> Motion<[Key; 4]> {
    Motion { pivot: Vec3::new(0.25, 0.0, 0.125), ..Motion::with_keys(KEYS, 0.0) }
}

#[test]
fn who_is_attached_is_where_the_script_says_by_every_method_and_step() {
    let start = [
        Particle { position: Vec3::new(1.0, 0.5, 0.0), fixed: true, ..Particle::REST },
        Particle { position: Vec3::new(0.0, -1.0, 0.25), ..Particle::REST },
        Particle { position: Vec3::new(3.0, 0.0, 0.0), ..Particle::REST },
    ];
    let attach = Attach { particles: [0, 1], motion: script() };
    // The spring pulls at both, and at one that is free.
    let springs = [Spring::new([1, 2], 1.0, 20.0).damped(0.5)];
    for method in Method::ALL {
        for (fps, substeps) in [(24, 1), (60, 5), (240, 1)] {
            let scene = Scene {
                start: &start,
                springs: &springs,
                forces: &Gravity::EARTH,
                constraints: &attach,
                substeps,
                integrator: method.integrator(),
                ..Scene::EMPTY
            };
            let mut system = started(&scene, start.len(), 1);
            for frame in 1..=3 * fps {
                system.step_to(&scene, Time::frame(u64::from(frame), fps));
                let now = script().frame(system.time());
                let there = system.particles();
                for (row, at_first) in start[..2].iter().enumerate() {
                    let place = now.world(at_first.position);
                    assert_eq!(there.position[row], place, "{method} at {fps}, frame {frame}");
                    assert_eq!(there.velocity[row], now.velocity_at(place));
                }
            }
        }
    }
}

#[test]
fn a_mass_on_a_spring_that_is_shaken_follows_the_driven_oscillator() {
    // x'' = ω² (A sin Ωt − x) from rest at x = 0: x = A ω / (ω² − Ω²) (ω sin Ωt − Ω sin ωt).
    let (stiffness, amplitude, driven) = (30.0f64, 0.2f64, 0.55f64);
    let omega = stiffness.sqrt();
    let pace = core::f64::consts::TAU * driven;
    let exact = |t: f64| {
        amplitude * omega / (omega * omega - pace * pace) * (omega * (pace * t).sin() - pace * (omega * t).sin())
    };
    let start = [
        Particle { position: Vec3::X * 50.0, fixed: true, ..Particle::REST },
        Particle { position: Vec3::X * 51.0, ..Particle::REST },
    ];
    let springs = [Spring::new([0, 1], 1.0, stiffness as f32)];
    let swing = Motion { swing: Vec3::X * amplitude as f32, frequency: driven as f32, ..Motion::STILL };
    let attach = Attach { particles: [0], motion: swing };
    for method in Method::ALL {
        let off = [120u32, 240].map(|fps| {
            let scene = Scene {
                start: &start,
                springs: &springs,
                constraints: &attach,
                substeps: 2,
                integrator: method.integrator(),
                ..Scene::EMPTY
            };
            let mut system = started(&scene, 2, 1);
            let mut worst: f64 = 0.0;
            for frame in 1..=2 * fps {
                system.step_to(&scene, Time::frame(u64::from(frame), fps));
                let x = f64::from(system.particles().position[1].x) - 51.0;
                worst = worst.max((x - exact(f64::from(frame) / f64::from(fps))).abs());
            }
            worst
        });
        let first_order =
            matches!(method, Method::Euler | Method::Symplectic | Method::Implicit | Method::LectureMidpoint);
        let most = if first_order { 0.05 } else { 1e-3 };
        assert!(off[0] < most, "{method}: {off:?}");
        assert!(off[1] < 0.7 * off[0] || off[1] < 1e-4, "{method} does not come nearer with shorter steps: {off:?}");
    }
}

#[test]
fn a_chain_hangs_on_whoever_is_attached() {
    let links = 6;
    let start: Vec<Particle> = (0..=links)
        .map(|i| Particle { position: Vec3::NEG_Y * (0.25 * i as f32), fixed: i == 0, ..Particle::REST })
        .collect();
    let rods: Vec<Distance> = (0..links).map(|i| Distance::rod([i, i + 1], 0.25)).collect();
    let attach = Attach { particles: [0], motion: script() };
    let constraints = (attach, rods);
    for method in [Method::Symplectic, Method::Rk4, Method::Verlet] {
        let scene = Scene {
            start: &start,
            forces: &Gravity::EARTH,
            constraints: &constraints,
            substeps: 40,
            integrator: method.integrator(),
            ..Scene::EMPTY
        };
        let mut system = started(&scene, start.len(), 1);
        run(&mut system, &scene, 1.0 / 60.0, 240);
        let x = system.particles().position.to_vec();
        assert!((x[0] - script().frame(system.time()).world(Vec3::ZERO)).length() == 0.0);
        for two in x.windows(2) {
            assert!(((two[1] - two[0]).length() - 0.25).abs() < 2e-3, "{method}: {x:?}");
        }
    }
}

#[test]
fn births_lie_where_the_emitter_is_at_their_instants_and_take_its_velocity_along() {
    let line = Line { from: Vec3::new(1.0, 0.0, 0.0), to: Vec3::new(1.0, 0.0, 1.0) };
    let direction = Some(Vec3::Y);
    for (inherit, speed) in [(0.0f32, 0.0f32), (1.0, 0.0), (0.5, 2.0)] {
        let emitter = Emitter {
            direction,
            spread: Spread::Uniform(0.0),
            speed: Varied::exactly(speed),
            inherit,
            ..Emitter::moving(line, 311.0, script())
        };
        let mut all: Vec<Vec<Vec3>> = Vec::new();
        for fps in [7u32, 60, 500] {
            let scene = Scene { emitters: &emitter, ..Scene::EMPTY };
            let mut system = started(&scene, 2000, 9);
            run(&mut system, &scene, 1.0 / f64::from(fps), 3 * fps);
            let (there, now) = (system.particles(), system.time());
            assert_eq!(system.len(), 933);
            for row in 0..system.len() {
                let born = there.born[row];
                let frame = script().frame(born);
                let flown = (now - born).seconds();
                let from = there.position[row] - there.velocity[row] * flown;
                let place = frame.local(from);
                let off = (place - Vec3::new(1.0, 0.0, place.z)).length();
                assert!(off < 5e-4 && (-5e-4..=1.0005).contains(&place.z), "{place} at {fps}");
                let velocity = frame.velocity_at(from) * inherit + frame.turn * Vec3::Y * speed;
                assert!((there.velocity[row] - velocity).length() < 1e-3 * (1.0 + velocity.length()), "at {fps}");
            }
            all.push(there.velocity.to_vec());
        }
        // Their instants and random numbers do not depend on the step.
        assert!(all.windows(2).all(|two| two[0] == two[1]));
        assert_eq!(emitter.count(), 1);
    }
}

#[test]
fn scenery_by_keys_does_what_a_script_of_ones_own_does() {
    let slab = || Cuboid { min: Vec3::new(-1.0, -0.2, -1.0), max: Vec3::new(1.0, 0.0, 1.0) };
    let bounds = Aabb { min: slab().min, max: slab().max };
    let rise = Vec3::new(0.25, 0.5, 0.0);
    let keys = [Key::default(), Key { time: 4.0, place: rise * 4.0, rotation: Vec3::ZERO }];
    /// From rest to rest by a cubic.
    struct Lift(Vec3);
    impl Script for Lift {
        fn frame(&self, at: Time) -> Frame {
            let s = (at.seconds() * 0.25).min(1.0);
            Frame {
                place: self.0 * (s * s * (3.0 - 2.0 * s)),
                velocity: self.0 * (6.0 * s * (1.0 - s) * 0.25),
                acceleration: self.0 * ((6.0 - 12.0 * s) * 0.0625),
                bend: 6.0 * 0.0625 * self.0.length(),
                ..Frame::STILL
            }
        }
    }
    let start: Vec<Particle> = [0.0f32, 0.05]
        .into_iter()
        .map(|radius| Particle { position: Vec3::new(0.1, 1.0, -0.2), radius, elasticity: 0.8, ..Particle::REST })
        .collect();
    let materials = [ContactMaterial { elasticity: None, friction: Some(Friction { static_: 0.5, kinetic: 0.4 }) }];
    for method in Method::ALL {
        let by_keys = Moving::new(slab(), &bounds, Motion::with_keys(keys, 0.0));
        let by_script = Moving::new(slab(), &bounds, Lift(rise * 4.0));
        let ends = [&by_keys as &dyn pointmass::shape::Collider, &by_script].map(|colliders| {
            let scene = Scene {
                start: &start,
                forces: &Gravity::EARTH,
                colliders,
                materials: &materials,
                integrator: method.integrator(),
                ..Scene::EMPTY
            };
            let mut system = started(&scene, start.len(), 0);
            run(&mut system, &scene, 1.0 / 60.0, 200);
            system.particles().position.to_vec()
        });
        for (a, b) in ends[0].iter().zip(&ends[1]) {
            assert!((*a - *b).length() < 1e-3 && a.y > 0.5, "{method}: {a}, {b}");
        }
    }
}

#[test]
fn what_is_in_a_box_that_is_swung_and_turned_by_keys_stays_in_it() {
    // A room thrown about, up to two, four and sixteen turns a second.
    for (round, turns) in [0.5, 1.0, 4.0].into_iter().enumerate() {
        stays_in_a_room_that_turns(turns, round);
    }
}

fn stays_in_a_room_that_turns(turns: f32, round: usize) {
    let keys: Vec<Key> = (0..12)
        .map(|i| Key {
            time: 0.25 * i as f32,
            place: Vec3::new((i % 3) as f32, (i % 2) as f32, (i % 5) as f32 * 0.5) * 0.8,
            rotation: Vec3::new(0.7 * i as f32, (i % 4) as f32, -0.4 * i as f32) * turns,
        })
        // It ends as it began.
        .chain([Key { time: 3.25, ..Key::default() }])
        .collect();
    let script = Motion { pivot: Vec3::new(0.2, 0.0, -0.1), ..Motion::with_keys(&keys[..], 3.25) };
    let walls = Cuboid { min: Vec3::NEG_ONE, max: Vec3::ONE };
    let room = Moving::new(walls, &Aabb { min: walls.min, max: walls.max }, script);
    let start: Vec<Particle> = (0..64)
        .step_by(every(3))
        .map(|i| Particle {
            position: Vec3::new((i % 4) as f32, (i / 4 % 4) as f32, (i / 16) as f32) * 0.4 - 0.6,
            radius: if i % 2 == 0 { 0.0 } else { 0.05 },
            elasticity: 0.6,
            ..Particle::REST
        })
        .collect();
    for (i, method) in methods(round).enumerate() {
        // With all checks it takes long: every other method at 25 frames a second, the rest at 60.
        let rates = if cfg!(debug_assertions) { &[25u32, 60][i % 2..=i % 2] } else { &[25, 60] };
        for &fps in rates {
            let scene = Scene {
                start: &start,
                forces: &Gravity::EARTH,
                colliders: &room,
                max_bounces: 32,
                integrator: method.integrator(),
                ..Scene::EMPTY
            };
            let mut system = started(&scene, start.len(), 0);
            for frame in 1..=4 * fps {
                system.step_to(&scene, Time::frame(u64::from(frame), fps));
                let now = script.frame(system.time());
                for (row, &x) in system.particles().position.iter().enumerate() {
                    let local = now.local(x);
                    assert!(
                        local.abs().max_element() < 1.0 + 1e-3,
                        "{turns}, {method}, {fps}, {frame}, {row}: {local}"
                    );
                }
            }
        }
    }
}

#[test]
fn a_scene_file_says_keys_for_all_three_and_reads_back_what_it_wrote() {
    use pointmass::scene::{Model, SceneFile};
    let text = r#"{
        "particles": [{"position": [0, 1, 0], "fixed": true}],
        "constraints": [{"attach": {"particles": [0], "motion": {"keys": [{"time": 0}, {"time": 1, "place": [2, 0, 0]}]}}}],
        "emitters": [{"shape": {"sphere": {"center": [0, 0, 0], "radius": 0.1}}, "rate": 10, "fixed": true,
            "motion": {"keys": [{"time": 0}, {"time": 1, "place": [0, 0, 7]}]}}],
        "scenery": [{"shape": {"sphere": {"center": [0, 0, 0], "radius": 1}},
            "motion": {"spin": 1, "keys": [{"time": 0, "rotation": [0, 0, 1]}, {"time": 2, "place": [1, 0, 0]}], "period": 2}}]
    }"#;
    let file = SceneFile::from_json("keys.json", text).expect("it is sound");
    assert_eq!(SceneFile::from_json("again.json", &file.to_json()).expect("it is sound"), file);
    let model = Model::load(&file, "keys.json", &mut ()).expect("it loads");
    let mut system = model.system(100, 1).expect("there is memory");
    system.step_to(&model.scene(), Time::from_seconds(1.0));
    let x = &system.particles().position;
    assert_eq!(x[0], Vec3::new(2.0, 1.0, 0.0));
    assert!(x[1].z < 1.0 && x[10].z > 6.8, "{x:?}");
    for (from, to, at) in [
        (r#""time": 1, "place": [2"#, r#""time": -1, "place": [2"#, "constraints[0].attach.motion"),
        (r#""time": 1, "place": [0, 0, 7]"#, r#""time": 0"#, "emitters[0].motion"),
        (r#""period": 2"#, r#""period": 1"#, "scenery[0].motion"),
        (r#""particles": [0],"#, r#""particles": [3],"#, "constraints[0]"),
    ] {
        let bad = text.replacen(from, to, 1);
        assert_ne!(bad, text);
        let file = SceneFile::from_json("bad.json", &bad);
        let error =
            file.and_then(|file| Model::load(&file, "bad.json", &mut ()).map(|_| ())).expect_err(to).to_string();
        assert!(error.contains(at), "{to}: {error}");
    }
}

/// Goes as another script does, of which nobody knows how far that leads.
struct Anywhere<'a>(&'a Motion<[Key; 4]>);

impl Script for Anywhere<'_> {
    fn frame(&self, at: Time) -> Frame {
        self.0.frame(at)
    }
}

#[test]
fn what_is_known_to_have_gone_elsewhere_is_met_as_if_it_were_not_known() {
    let mut random = Random::new(5);
    let (mut hits, mut near) = (0, 0);
    for round in 0..40_u8 {
        // Some drift fast, some are far from the origin, and some only turn.
        let far = random.vector(1.0) * [0.0, 10.0, 1e4][usize::from(round % 3)];
        let drift = random.vector(1.0) * [0.0, 1.0, 300.0][usize::from(round / 3 % 3)];
        let motion = Motion {
            pivot: far,
            drift,
            spin: random.between(-1.0, 1.0),
            axis: Vec3::new(0.2, 1.0, 0.1),
            swing: random.vector(0.5),
            frequency: 0.7,
            ..Motion::with_keys(KEYS, if round % 2 == 0 { 3.0 } else { 0.0 })
        };
        let half = Vec3::new(0.3, 0.05, 0.2);
        let slab = Cuboid { min: far - half, max: far + half };
        let bounds = Aabb { min: slab.min, max: slab.max };
        let (known, unknown) = (Moving::new(slab, &bounds, &motion), Moving::new(slab, &bounds, Anywhere(&motion)));
        for _ in 0..400 {
            let start = Time::from_seconds(random.between(0.0, 9.0));
            let during = [start, start + Time::from_seconds(random.between(1e-3, 0.05))];
            let frame = motion.frame(start);
            let from = frame.place + random.vector(1.0);
            let to = from + random.vector(0.5) + drift * (during[1] - during[0]).seconds();
            let segment = Segment { from, to, radius: [0.0, 0.1][usize::from(round & 1)], during };
            assert_eq!(known.first_hit(&segment), unknown.first_hit(&segment), "{round}: {segment:?}");
            hits += u32::from(known.first_hit(&segment).is_some());
            let [mut those, mut others] = [Vec::new(), Vec::new()];
            let reach = random.between(0.0, 1.0);
            known.contacts(from, reach, start, &mut |contact| those.push(*contact));
            unknown.contacts(from, reach, start, &mut |contact| others.push(*contact));
            assert_eq!(those, others, "{round}: {from} {reach}");
            near += u32::from(!those.is_empty());
        }
    }
    assert!(hits > 300 && near > 3000, "{hits} {near}");
}
