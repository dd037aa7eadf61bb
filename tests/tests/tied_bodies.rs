//! Ropes and ties as scene files say them: closed forms that do not depend on how fine a rope is divided, what they keep, and what is refused.

use pointmass::constrain::{ConstraintKind, ShapeMatching, Tie, TiedRope};
use pointmass::scene::{Model, SceneFile};
use pointmass::{Constraint, Measures, Method, Particle, Rope, Scene, Time, Vec3};
use pointmass_tests::{Random, every, gap, is_run, is_third, run, started};

fn model(text: &str) -> Result<Model, String> {
    let file = SceneFile::from_json("it.json", text).map_err(|error| error.to_string())?;
    Model::load(&file, "it.json", &mut ()).map_err(|error| error.to_string())
}

/// Where all are after so many seconds.
fn after(model: &Model, seconds: f64, substeps: u32, method: Method) -> (Vec<Vec3>, Vec<Vec3>) {
    let scene = Scene { substeps, integrator: method.integrator(), ..model.scene() };
    let mut system = started(&scene, model.particles.len(), 1);
    run(&mut system, &scene, 1.0 / 60.0, (seconds * 60.0) as u32);
    (system.particles().position.to_vec(), system.particles().velocity.to_vec())
}

/// A rope that hangs is longer by ρ g L² / (2 E), or by so many percent, and by its load, however many segments it has.
#[test]
fn ropes_stretch_by_their_closed_form_however_fine_they_are() {
    for (number, segments) in [1u32, 2, 7, 40].into_iter().enumerate() {
        for (k, (what, more)) in [
            (r#""density": 1000, "young": 1e6, "diameter": 0.02"#, 1000.0 * 9.80665 * 4.0 / 2e6),
            (r#""weight": 0.5, "stretch": 1"#, 0.02),
            (r#""weight": 0.5, "stretch": 0"#, 0.0),
            (r#""density": 900"#, 0.0),
        ]
        .into_iter()
        .enumerate()
        {
            let text = format!(
                r#"{{"forces": [{{"gravity": {{"acceleration": [0, -9.80665, 0]}}}}, {{"drag": {{}}}}],
                "ropes": [{{"curve": [[0, 3, 0], [0, 2.5, 0], [0, 1, 0]], "segments": {segments}, {what}, "fixed": [0], "drag": 0.8}}]}}"#
            );
            let model = model(&text).unwrap();
            let mass: f32 = model.particles.iter().map(|p| p.mass).sum();
            let metre = [1000.0 * 1e-4 * core::f32::consts::PI, 0.5, 0.5, 900.0 * 2.5e-5 * core::f32::consts::PI][k];
            assert!((mass / (2.0 * metre) - 1.0).abs() < 1e-5, "{mass} kg");
            let method = Method::ALL[(number + 3 * k) % Method::ALL.len()];
            let (x, v) = after(&model, 12.0, 4, method);
            let longer = 2.0 - f64::from(x[segments as usize].y) - 1.0;
            assert!((longer - more).abs() < 0.01 * more + 1e-5, "{segments} segments, {what}, {method}: {longer} m");
            assert!(v.iter().all(|v| v.length() < 1e-2), "{segments} {method}: {v:?}");
        }
    }
}

/// A rope's end that `ties` tie rigidly is one of its `ends`, to the last bit, and a soft one is not.
#[test]
fn ties_of_rope_ends_are_the_ropes_own() {
    let scene = |ends: &str, ties: &str| {
        let text = format!(
            r#"{{"forces": [{{"gravity": {{"acceleration": [0, -9.80665, 0]}}}}], "ropes": [
            {{"curve": [[0, 0, 0], [1, 0, 0]], "segments": 8, "weight": 0.3, "fixed": [0]}},
            {{"curve": [[1, 0, 0], [2, 0, 0]], "segments": 8, "weight": 0.3{ends}}}]{ties}}}"#
        );
        after(&model(&text).unwrap(), 1.0, 4, Method::Symplectic)
    };
    let tied = |compliance: &str| {
        let ties = format!(r#", "ties": [{{"of": {{"rope": 1}}, "points": [0], "to": {{"rope": 0}}{compliance}}}]"#);
        scene("", &ties)
    };
    let own = scene(r#", "ends": [{"rope": 0}, null]"#, "");
    assert_eq!(tied(""), own);
    assert_ne!(tied(r#", "compliance": 1e-3"#), own);
}

/// What hangs from a rope however heavy does not stretch it, nor leave it, whichever way it is fixed on.
#[test]
fn a_rope_carries_what_it_is_tied_to() {
    let mut cases = 0;
    for (number, segments) in [1u32, 5, 40].into_iter().enumerate() {
        for (k, mass) in [1.0, 10.0, 100.0].into_iter().enumerate() {
            for aside in [0.0, 0.06] {
                // Links that are some 10,000 times as light as what hangs from them swing faster than sub-steps show.
                if !is_third(&mut cases) || segments == 40 && mass > 10.0 {
                    continue;
                }
                let text = format!(
                    r#"{{"forces": [{{"gravity": {{"acceleration": [0, -9.80665, 0]}}}}, {{"drag": {{}}}}],
                    "boxes": [{{"sides": [0.2, 0.2, 0.2], "mass": {mass}, "position": [{aside}, 0.9, 0], "drag": {}}}],
                    "ropes": [{{"curve": [[0, 2, 0], [0, 1, 0]], "segments": {segments}, "weight": 0.06, "fixed": [0],
                    "ends": [null, {{"box": 0}}], "drag": 0.06}}]}}"#,
                    3.0 * mass
                );
                let method = [Method::Symplectic, Method::Verlet, Method::Rk4][(number + k) % 3];
                let (x, v) = after(&model(&text).unwrap(), 10.0, 16, method);
                let middle = x[..8].iter().sum::<Vec3>() / 8.0;
                let end = x[8 + segments as usize];
                let name = format!("{segments} segments, {mass} kg, {aside} m aside, {method}");
                assert!((end - Vec3::Y).length() < 2e-3, "{name}: {end}");
                let arm = (0.1f32 * 0.1 + aside * aside).sqrt();
                assert!((end - middle - Vec3::Y * arm).length() < 2e-3, "{name}: {middle}");
                // What hangs from light links shows as much as half of what gravity gives it in a sub-step.
                assert!(v[..8].iter().all(|v| v.length() < 0.55 * 9.80665 / 960.0), "{name}: {v:?}");
            }
        }
    }
}

#[test]
fn ropes_between_bodies_keep_momentum() {
    let mut random = Random::new(3);
    for method in Method::ALL {
        for (substeps, compliance) in [(3u32, 0.0f32), (10, 0.0), (6, 1e-3)] {
            let corner = |i: usize| Vec3::new((i & 1) as f32, (i >> 1 & 1) as f32, (i >> 2) as f32) * 0.2;
            let spin = random.vector(1.0);
            let mut start: Vec<_> = (0..16)
                .map(|i| {
                    let position = corner(i % 8) + Vec3::X * if i < 8 { 0.0 } else { 1.0 };
                    let mass = if i < 8 { 3.0 } else { random.between(0.5, 0.6) };
                    Particle { position, velocity: spin.cross(position), mass, ..Particle::REST }
                })
                .collect();
            let link = |i: usize| Particle {
                position: Vec3::new(0.2 + 0.08 * i as f32, 0.1, 0.1),
                velocity: random.vector(0.5),
                mass: 0.02,
                ..Particle::REST
            };
            start.extend((0..=10).map(link));
            let [one, other] = [0, 8].map(|first| (first..first + 8).collect::<Vec<u32>>());
            let tie = |particle, to: &Vec<u32>| Some(Tie { compliance, ..Tie::rigid(particle, to.clone()) });
            let rope = Rope::rigid((16..27).collect::<Vec<u32>>(), vec![0.08]);
            let tied = TiedRope { rope, ends: [tie(16, &one), tie(26, &other)] };
            assert_eq!(tied.fault(), None);
            let bonds = (tied, ShapeMatching::rigid(one), ShapeMatching::rigid(other));
            let parts = Scene { start: &start, constraints: &bonds, ..Scene::EMPTY };
            let scene = Scene { substeps, integrator: method.integrator(), ..parts };
            let mut system = started(&scene, start.len(), 0);
            let before = Measures::of(&system, &scene);
            run(&mut system, &scene, 1.0 / 60.0, 1);
            let set_out = Measures::of(&system, &scene);
            run(&mut system, &scene, 1.0 / 60.0, 60);
            let now = Measures::of(&system, &scene);
            let mass: f64 = start.iter().map(|p| f64::from(p.mass)).sum();
            let lost = [gap(before.momentum, now.momentum), gap(before.angular_momentum, now.angular_momentum)];
            let name = format!("{method}, {substeps}, {compliance}");
            assert!(lost[0] < 1e-5 * mass && lost[1] < 1e-3 * mass, "{name}: {lost:?}");
            // Nothing bounds the energy of what is tied: velocities that no links allow, straight between what is heavy, pull at that in the first sub-step.
            let most = if substeps < 5 { 1.04 } else { 1.01 };
            assert!(
                set_out.energy.total() < most * before.energy.total(),
                "{name}: {:?}",
                [set_out.energy, before.energy]
            );
            assert!(now.energy.total() < 1.001 * set_out.energy.total(), "{name}: {:?}", [set_out.energy, now.energy]);
        }
    }
}

/// A box that stands on the tied end of a rope, which reaches out below it, falls over on a smooth floor and goes nowhere: the floor pushes along its normal
/// alone, though what it pushes there is not as heavy in all directions.
#[test]
fn what_stands_on_a_tied_end_is_not_driven() {
    let (mut random, mut cases) = (Random::new(12), 0);
    for substeps in [1, 4, 20] {
        for method in Method::ALL {
            let [turn, along, fast] = [(); 3].map(|()| random.vector(1.0));
            let place = random.vector(0.1);
            if !is_run(&mut cases) {
                continue;
            }
            let text = format!(
                r#"{{"forces": [{{"gravity": {{"acceleration": [0, -9.81, 0]}}}}],
                "scenery": [{{"shape": {{"plane": {{"point": [0, 0, 0], "normal": [0, 1, 0]}}}}}}],
                "boxes": [{{"sides": [0.3, 0.1, 0.2], "mass": 2, "position": [0, 0.25, 0], "turn": [{}, {}, {}], "velocity": [{}, 0, {}]}}],
                "ropes": [{{"curve": [[{}, 0.02, {}], [{}, 0.02, {}]], "segments": 6, "weight": 0.05, "diameter": 0.01,
                "ends": [{{"box": 0}}, null]}}]}}"#,
                turn.x,
                turn.y,
                turn.z,
                fast.x,
                fast.z,
                place.x,
                place.z,
                place.x + 0.5 * along.x,
                place.z + 0.5
            );
            let model = model(&text).unwrap();
            let scene = Scene { substeps, integrator: method.integrator(), ..model.scene() };
            let mut system = started(&scene, model.particles.len(), 1);
            let begun = Measures::of(&system, &scene);
            for frame in 1..=45 {
                system.step_to(&scene, Time::frame(frame, 60));
                let now = Measures::of(&system, &scene);
                let [x, _, z] = [0, 1, 2].map(|k| (now.momentum[k] - begun.momentum[k]).abs());
                let what = format!("{method}, {substeps} sub-steps, frame {frame}");
                let most = if substeps == 1 { 0.01 } else { 1e-4 };
                assert!(x.max(z) < most, "{what}: driven by {x} {z} kg m/s");
                // What falls by Euler's method gains.
                let all = if *method == Method::Euler { 1.1 } else { 1.01 };
                assert!(now.energy.total() < all * begun.energy.total(), "{what}: {:?}", now.energy);
            }
        }
    }
}

/// A scene of a box of 1 kg on a metre of rope, and how much energy it has got in each second of 10, as a share of what it swings with.
struct Swing {
    down: Vec3,
    /// Where the rope is fixed, and which way it goes to begin with.
    at: Vec3,
    along: Vec3,
    /// The middle of the box, its sides and how it is turned.
    middle: Vec3,
    sides: Vec3,
    turn: Vec3,
    segments: u32,
    weight: f32,
}

impl Swing {
    fn gains(&self, [fps, substeps]: [u32; 2], method: Method) -> Vec<f64> {
        let list = |v: Vec3| format!("{:?}", v.to_array());
        let text = format!(
            r#"{{"forces": [{{"gravity": {{"acceleration": {}}}}}],
            "ropes": [{{"curve": [{}, {}], "segments": {}, "weight": {}, "fixed": [0], "ends": [null, {{"box": 0}}]}}],
            "boxes": [{{"sides": {}, "mass": 1, "position": {}, "turn": {}}}]}}"#,
            list(self.down * 9.81),
            list(self.at),
            list(self.at + self.along),
            self.segments,
            self.weight,
            list(self.sides),
            list(self.middle),
            list(self.turn),
        );
        let model = model(&text).unwrap();
        let scene = Scene { substeps, integrator: method.integrator(), ..model.scene() };
        let mut system = started(&scene, model.particles.len(), 1);
        let before = Measures::of(&system, &scene).energy.total();
        let swings = 9.81 * f64::from(1.0 - self.along.dot(self.down));
        let second = |second: u32| {
            for frame in 1..=fps {
                system.step_to(&scene, Time::frame(u64::from(second * fps + frame), fps));
            }
            (Measures::of(&system, &scene).energy.total() - before) / swings
        };
        (0..10).map(second).collect()
    }
}

/// Boxes swing on ropes, and rock about their ends, as long as one looks, in whatever paces a sub-step is gone through: all that the rope pulls in one at once would drive what
/// turns, or brake it.
#[test]
fn boxes_swing_and_rock_on_ropes_for_ever() {
    let mut cases = 0;
    for (substeps, most_lost) in [(1, 0.05), (2, 0.02), (4, 0.003)] {
        for segments in [3, 10, 20] {
            for tilt in [0.0f32, 0.6] {
                for method in [Method::Verlet, Method::Midpoint, Method::Rk4] {
                    if !is_run(&mut cases) {
                        continue;
                    }
                    let way = |angle: f32| Vec3::new(angle.sin(), -angle.cos(), 0.0);
                    let (along, at) = (way(0.5), Vec3::new(1.0, 2.0, -1.0));
                    let (middle, turn) = (at + along + way(0.5 + tilt) * 0.05, Vec3::Z * (0.5 + tilt));
                    let (down, sides) = (-Vec3::Y, Vec3::splat(0.1));
                    let swing = Swing { down, at, along, middle, sides, turn, segments, weight: 0.01 };
                    for gained in swing.gains([60, substeps], method) {
                        let name = format!("{substeps} sub-steps, {segments} segments, {tilt}, {method}");
                        assert!(gained < 0.005 && gained > -most_lost, "{name}: {gained}");
                    }
                }
            }
        }
    }
}

/// Boxes on ropes are not thrown about, wherever the rope is tied to them, whichever way they hang, and however light it is for them. Those that rock by much of a
/// radian in a sub-step come to rest against the rope.
#[test]
fn boxes_on_ropes_gain_no_energy() {
    let (mut random, mut cases) = (Random::new(17), 0);
    for (fps, substeps) in [(60u32, 1u32), (60, 4), (144, 1), (24, 4), (240, 2)] {
        for segments in [1u32, 3, 20] {
            for weight in [0.01f32, 0.2] {
                for method in [Method::Symplectic, Method::Verlet, Method::Midpoint, Method::Rk4] {
                    let angle = random.between(0.2, 0.8);
                    let [down, across, at] = [random.direction(), random.direction(), random.vector(10.0)];
                    let along = down * angle.cos() + (across - down * across.dot(down)).normalize() * angle.sin();
                    let sides = Vec3::from_array([(); 3].map(|()| random.between(0.05, 0.2)));
                    let middle = at + along * (1.0 + 0.5 * sides.length()) + random.vector(0.4) * sides;
                    let turn = random.vector(3.0);
                    if !is_run(&mut cases) {
                        continue;
                    }
                    let swing = Swing { down, at, along, middle, sides, turn, segments, weight };
                    for gained in swing.gains([fps, substeps], method) {
                        let name = format!("{fps} x {substeps} a second, {segments} of {weight} kg/m, {method}");
                        assert!(gained < 0.1 && gained > -0.5, "{name}: {gained}");
                    }
                }
            }
        }
    }
}

/// A rope whose ends are tied to nothing is that rope, to the bit, and asks for the same memory; where they are tied nothing is kept of the rope.
#[test]
fn a_rope_that_is_tied_to_nothing_is_a_rope() {
    let mut random = Random::new(8);
    for (number, compliance) in [0.0, 1e-5, 1e-3].into_iter().enumerate() {
        let link = |i: usize| Particle {
            position: Vec3::new(0.08 * i as f32, 0.1, 0.1),
            velocity: random.vector(2.0),
            mass: 0.02,
            ..Particle::REST
        };
        let start: Vec<Particle> = (0..9).map(link).collect();
        let rope = Rope { compliance, ..Rope::rigid((0..9).collect::<Vec<u32>>(), vec![0.08]) };
        let loose = TiedRope::<_, _, Vec<u32>> { rope: rope.clone(), ends: [None, None] };
        assert_eq!(loose.demand(), rope.demand());
        let after = |constraints: &dyn Constraint| {
            let scene = Scene { start: &start, constraints, substeps: 1 + 2 * number as u32, ..Scene::EMPTY };
            let mut system = started(&scene, start.len(), 0);
            run(&mut system, &scene, 1.0 / 60.0, 60);
            system.hash()
        };
        assert_eq!(after(&loose), after(&rope));
        let tie = Tie::rigid(0, vec![9]);
        let kept = tie.demand().kept;
        assert_eq!(TiedRope { rope, ends: [Some(tie), None] }.demand().kept, kept);
    }
}

/// Points of bodies go with the place on others at which they began.
#[test]
fn what_is_tied_goes_with_its_place() {
    let text = r#"{"forces": [{"gravity": {"acceleration": [0, -9.80665, 0]}}],
        "particles": [{"position": [0.13, 0.02, 0.21], "mass": 0.01}],
        "cloths": [{"form": {"sheet": {"corner": [0, 0, 0], "sides": [[0.4, 0, 0], [0, 0, 0.4]], "cells": [6, 6]}},
            "density": 0.3, "shell": {"stretch": [3000, 3000], "shear": 1000, "bending": 1e-4, "damping": 0.01}, "fixed": [0, 6]}],
        "boxes": [{"sides": [0.1, 0.1, 0.1], "mass": 0.5, "position": [0.2, 0.05, 0.45]}],
        "strands": [{"form": {"on": {"shape": {"triangle": {"corners": [[0.1, 0, 0.1], [0.1, 0, 0.3], [0.3, 0, 0.3]]}}, "count": 5, "length": 0.05}},
            "segments": 4, "radius": 2e-4, "young": 1e8, "density": 1000, "damping": 0.01, "drag": 1e-4, "attach": {"cloth": 0}}],
        "ropes": [{"curve": [[0.2, 0.1, 0.45], [0.2, 0.5, 0.45]], "segments": 8, "weight": 0.01, "ends": [{"box": 0}, null]}],
        "ties": [{"of": {"cloth": 0}, "points": [42, 45, 48], "to": {"box": 0}}, {"points": [0], "to": {"cloth": 0}}]}"#;
    let model = model(text).unwrap();
    let count = |of: fn(&ConstraintKind) -> bool| model.constraints.0.iter().filter(|kind| of(kind)).count();
    // Two points of each strand, three of the cloth, and a button; the rope has its own.
    assert_eq!(count(|kind| matches!(kind, ConstraintKind::Tie(_))), 14);
    assert_eq!(count(|kind| matches!(kind, ConstraintKind::TiedRope(_))), 1);
    let ways = [(Method::Symplectic, 10), (Method::Rk4, 15), (Method::Verlet, 12)];
    for (method, substeps) in ways.into_iter().step_by(every(2)) {
        let scene = Scene { substeps, integrator: method.integrator(), ..model.scene() };
        let mut system = started(&scene, model.particles.len(), 1);
        run(&mut system, &scene, 1.0 / 60.0, 90);
        let x = system.particles().position;
        assert!(x.iter().all(|x| x.is_finite()), "{method}");
        // A button keeps its distances to the corners of the triangle that it is on, which hardly stretches.
        let start = |i: usize| model.particles[i].position;
        for kind in &model.constraints.0 {
            let ConstraintKind::Tie(tie) = kind else { continue };
            for &corner in &tie.to {
                let [now, then] = [
                    x[tie.particle as usize].distance(x[corner as usize]),
                    start(tie.particle as usize).distance(start(corner as usize)),
                ];
                assert!(
                    (now - then).abs() < 5e-3 + 0.1 * then,
                    "{method}, {} to {corner}: {now} m, {then} m",
                    tie.particle
                );
            }
        }
    }
}

#[test]
fn what_cannot_be_so_is_refused_by_name() {
    let with = |rope: &str, more: &str| {
        model(&format!(
            r#"{{"particles": [{{}}], "boxes": [{{"sides": [1, 1, 1], "mass": 1, "position": [0, 0, 0]}}],
            "ropes": [{{"curve": [[0, 2, 0], [0, 1, 0]], "segments": 4{rope}}}]{more}}}"#
        ))
        .map(|_| String::new())
        .unwrap_or_else(|error| error)
    };
    assert_eq!(
        with(r#", "weight": 1, "ends": [{"box": 0}, null]"#, r#", "ties": [{"points": [0], "to": {"rope": 0}}]"#)
            .as_str()
            .lines()
            .count(),
        1
    );
    let cases = [
        ("", "", "ropes[0].density: is missing"),
        (r#", "weight": 1, "density": 1"#, "", "ropes[0].weight: say either"),
        (r#", "weight": 0"#, "", "ropes[0].weight: has to be above zero"),
        (r#", "weight": 1, "young": 1, "stretch": 1"#, "", "ropes[0].stretch: say either"),
        (r#", "weight": 1, "stretch": -1"#, "", "ropes[0].stretch: has to be zero or more"),
        (
            r#", "weight": 1e-6, "stretch": 1e38"#,
            "",
            "ropes[0].stretch: makes it softer than 32-bit floats can tell; take less",
        ),
        (
            r#", "weight": 1, "young": 1e-44"#,
            "",
            "ropes[0].young: makes it softer than 32-bit floats can tell; take more",
        ),
        (
            r#", "weight": 1"#,
            r#", "cloths": [{"form": {"sheet": {"corner": [0, 0, 0], "sides": [[1, 0, 0], [0, 1, 0]], "cells": [4, 0]}},
            "mass": 1, "springs": {"structural": {"ks": 1}}}], "ties": [{"points": [0], "to": {"cloth": 0}}]"#,
            "ties[0].to: it has no triangle to be tied to; a sheet needs cells along both of its sides",
        ),
        (
            r#", "weight": 1"#,
            r#", "cloths": [{"form": {"sheet": {"corner": [0, 0, 0], "sides": [[1, 0, 0], [0, 1, 0]], "cells": [4, 0]}},
            "mass": 1, "springs": {"structural": {"ks": 1}}}], "ties": [{"of": {"cloth": 0}, "points": [5], "to": {"box": 0}}]"#,
            "ties[0].points[0]: point 5 is out of range; there are 5",
        ),
        (r#", "weight": 1, "fixed": [5]"#, "", "ropes[0].fixed: point 5 is out of range; the last is 4"),
        (r#", "weight": 1, "fixed": [0], "ends": [{"box": 0}, null]"#, "", "ropes[0].ends: point 0 is fixed"),
        (r#", "weight": 1, "ends": [{"box": 1}, null]"#, "", "ropes[0].ends[0]: box 1 is out of range; there are 1"),
        (r#", "weight": 1, "ends": [{"rope": 0}, null]"#, "", "ropes[0].ends[0]: it is a part of that body"),
        (
            r#", "weight": 1"#,
            r#", "ties": [{"points": [1], "to": {"box": 0}}]"#,
            "ties[0].points[0]: point 1 is out of range; there are 1",
        ),
        (r#", "weight": 1"#, r#", "ties": [{"points": [], "to": {"box": 0}}]"#, "ties[0].points: has to name"),
        (
            r#", "weight": 1"#,
            r#", "ties": [{"points": [0], "to": {"cloth": 0}}]"#,
            "ties[0].to: cloth 0 is out of range; there are 0",
        ),
        (
            r#", "weight": 1"#,
            r#", "ties": [{"of": {"strand": 2}, "points": [0], "to": {"box": 0}}]"#,
            "ties[0].of: strand 2 is out of range",
        ),
        (
            r#", "weight": 1"#,
            r#", "ties": [{"of": {"box": 0}, "points": [0], "to": {"box": 0}}]"#,
            "ties[0].to: is the body that is to be tied",
        ),
        (
            r#", "weight": 1"#,
            r#", "ties": [{"points": [0], "to": {"rope": 0}}]"#,
            "ties[0].points[0]: the point begins 1.0 m beside its line",
        ),
        (
            r#", "weight": 1"#,
            r#", "ties": [{"points": [0], "to": {"box": 0}, "compliance": -1}]"#,
            "ties[0].compliance: has to be zero or more",
        ),
        (
            r#", "weight": 1"#,
            r#", "constraints": [{"tie": {"particle": 0, "to": [99]}}]"#,
            "constraints[0]: particle 99 is out of range",
        ),
    ];
    for (rope, more, message) in cases {
        let said = with(rope, more);
        assert!(said.contains(message), "{rope} {more}: {said}");
    }
}

/// Strands are attached to bodies that come later in the file as well.
#[test]
fn strands_grow_on_ropes() {
    let text = r#"{"forces": [{"gravity": {"acceleration": [0, -9.80665, 0]}}, {"drag": {}}],
        "strands": [{"form": {"curve": [[0.5, 1, 0], [0.5, 0.8, 0]]}, "segments": 4, "fixed": [0], "attach": {"rope": 0},
            "radius": 1e-3, "young": 1e6, "density": 1000}],
        "ropes": [{"curve": [[0, 1, 0], [1, 1, 0]], "segments": 10, "weight": 0.1, "fixed": [0, 10], "drag": 0.2}]}"#;
    let model = model(text).unwrap();
    assert!(model.constraints.0.iter().any(|constraint| matches!(constraint, ConstraintKind::Tie(_))));
    let (x, _) = after(&model, 2.0, 10, Method::Symplectic);
    let root = (0..5).map(|i| x[i]).max_by(|a, b| a.y.total_cmp(&b.y)).unwrap();
    assert!(root.distance(x[5 + 5]) < 1e-2, "{root}, {}", x[10]);
}

/// Where a rope bends it is as long as its segments: all that it weighs and how it gives way goes by that length.
#[test]
fn bent_ropes_weigh_and_give_way_by_the_length_of_their_links() {
    for segments in [1, 2, 3, 7, 100] {
        let text = format!(
            r#"{{"ropes": [{{"curve": [[0, 0, 0], [1, 0, 0], [1, 0.7, 0], [1, 0.7, 2]], "segments": {segments}, "weight": 0.3, "young": 1e6, "diameter": 0.02}}]}}"#
        );
        let model = model(&text).unwrap();
        let links = model.particles.windows(2).map(|ends| ends[0].position.distance(ends[1].position));
        let whole: f32 = links.sum();
        let ConstraintKind::Rope(rope) = &model.constraints.0[0] else { panic!("{:?}", model.constraints.0) };
        let mass: f32 = model.particles.iter().map(|p| p.mass).sum();
        let stiffness = 1e6 * core::f32::consts::PI * 1e-4;
        assert!((rope.lengths.iter().sum::<f32>() / whole - 1.0).abs() < 1e-5);
        assert!((mass / (0.3 * whole) - 1.0).abs() < 1e-5, "{segments}: {mass} kg");
        let gives = rope.compliance * segments as f32;
        assert!((gives * stiffness / whole - 1.0).abs() < 1e-5, "{segments}: {gives} m/N, {whole} m");
    }
}

/// What is tied to a cloth is tied to the nearest of its triangles.
#[test]
fn ties_find_the_nearest_triangle() {
    let mut random = Random::new(11);
    for (cells, far) in [([1, 1], 0.0), ([13, 9], 0.0), ([40, 31], 300.0)] {
        let places: Vec<Vec3> = (0..60)
            .map(|i| random.vector(0.7) * Vec3::new(1.0, if i % 3 == 0 { 0.0 } else { 1.0 }, 1.0) + Vec3::X * far)
            .collect();
        let particles: Vec<_> =
            places.iter().map(|p| format!(r#"{{"position": [{}, {}, {}]}}"#, p.x, p.y, p.z)).collect();
        let text = format!(
            r#"{{"particles": [{}], "cloths": [
            {{"form": {{"sheet": {{"corner": [5, 0, 0], "sides": [[1, 0, 0], [0, 1, 0]], "cells": [2, 3]}}}}, "mass": 1, "springs": {{"structural": {{"ks": 1}}}}}},
            {{"form": {{"sheet": {{"corner": [{}, 0, -0.5], "sides": [[1, 0.1, 0], [0, -0.2, 1]], "cells": {cells:?}}}}},
            "mass": 1, "springs": {{"structural": {{"ks": 1}}}}}}], "ties": [{{"points": {:?}, "to": {{"cloth": 1}}}}]}}"#,
            particles.join(","),
            far - 0.5,
            (0..60).collect::<Vec<u32>>()
        );
        let model = model(&text).unwrap();
        let patch = &model.patches[1];
        let distance = |corners: [u32; 3], place: Vec3| {
            let corners = corners.map(|corner| model.particles[corner as usize].position);
            f64::from(
                pointmass::shape::Surface::nearest(&pointmass::shape::Triangle { corners }, place).distance(place),
            )
        };
        let ties = model.constraints.0.iter().filter_map(|one| match one {
            ConstraintKind::Tie(tie) => Some(tie),
            _ => None,
        });
        let mut count = 0;
        for (tie, &place) in ties.zip(&places) {
            let found = distance(tie.to[..].try_into().unwrap(), place);
            let all = patch.triangles.iter().map(|corners| distance(corners.map(|corner| patch.first + corner), place));
            let least = all.fold(f64::INFINITY, f64::min);
            assert!(found <= least + 1e-7 * f64::from(1.0 + far), "{cells:?} {place}: {found} m, not {least}");
            count += 1;
        }
        assert_eq!(count, 60);
    }
}

#[test]
fn tied_ropes_that_name_a_particle_twice_are_refused() {
    let rope = |particles: [u32; 3]| Rope::rigid(particles.to_vec(), vec![1.0]);
    let to = |to: &[u32]| [None, Some(Tie::rigid(2, to.to_vec()))];
    let tied = |rope, ends| TiedRope { rope, ends }.fault();
    assert_eq!(tied(rope([0, 1, 2]), to(&[3, 4, 5])), None);
    assert_eq!(tied(rope([1, 1, 2]), to(&[3, 4, 5])), Some(("particles", "must not name a particle twice")));
    assert_eq!(tied(rope([0, 1, 2]), to(&[3, 4, 3])), Some(("ends", "must not name a particle of a body twice")));
}

#[test]
fn strands_that_are_attached_by_nothing_are_remarked_on() {
    let remarks = |fixed: &str| {
        let text = format!(
            r#"{{"strands": [{{"form": {{"curve": [[0.5, 1, 0], [0.5, 0.8, 0]]}}, "segments": 4, "attach": {{"rope": 0}}, {fixed}
            "radius": 1e-3, "young": 1e6, "density": 1000}}],
            "ropes": [{{"curve": [[0, 1, 0], [1, 1, 0]], "segments": 10, "weight": 0.1}}]}}"#
        );
        SceneFile::from_json("it.json", &text).unwrap().remarks()
    };
    assert_eq!(remarks(r#""fixed": [0],"#), [""; 0]);
    assert_eq!(
        remarks(""),
        ["strands[0].attach: none of its points is fixed, so nothing of it is tied; name them in fixed"]
    );
}

/// Sheets feel ropes only when these have been solved: how far they give way by that is told, and who may be driven by it.
#[test]
fn ropes_on_sheets_are_remarked_on() {
    let remarks = |cells: u32, substeps: u32, rope: &str, ties: &str| {
        let text = format!(
            r#"{{"run": {{"substeps": {substeps}}}, "forces": [{{"gravity": {{"acceleration": [0, -9.81, 0]}}}}],
            "cloths": [{{"form": {{"sheet": {{"corner": [0, 0, 0], "sides": [[0.5, 0, 0], [0, -0.5, 0]], "cells": [{cells}, {cells}]}}}},
                "density": 0.2, "shell": {{"stretch": [1000, 1000], "shear": 60}}, "fixed": [0, {cells}]}}],
            "ropes": [{{"segments": 10, "weight": 0.07, {rope}}}]{ties}}}"#
        );
        SceneFile::from_json("it.json", &text).unwrap().remarks()
    };
    let hung = r#""curve": [[0.25, -0.5, 0], [0.25, -1, 0]], "ends": [{"cloth": 0}, null]"#;
    for (cells, substeps, is_told) in [(12, 4, true), (12, 40, false), (4, 20, false), (24, 40, true)] {
        let told = remarks(cells, substeps, hung, "");
        assert_eq!(
            told.iter().any(|remark| remark.starts_with("ropes[0].ends: it bears 0.035 kg")),
            is_told,
            "{told:?}"
        );
    }
    let sewn = r#""curve": [[0, -0.5, 0], [0.5, -0.5, 0]]"#;
    for (points, more, is_told) in
        [("0, 5, 10", "", true), ("3", "", false), ("0, 5, 10", r#", "compliance": 1e-4"#, false)]
    {
        let ties = format!(r#", "ties": [{{"of": {{"rope": 0}}, "points": [{points}], "to": {{"cloth": 0}}{more}}}]"#);
        let told = remarks(6, 4, sewn, &ties);
        assert_eq!(told.iter().any(|remark| remark.starts_with("ties[0]: a rope that is sewn")), is_told, "{told:?}");
    }
}

/// How far a load of so many newtons a metre stretches a sheet, by Saint-Venant and Kirchhoff: k (1 + e) (e + e² / 2).
fn strain_under(pull: f64, stretch: f64) -> f64 {
    let (mut least, mut most) = (0.0f64, 10.0);
    for _ in 0..60 {
        let e = 0.5 * (least + most);
        let bears = stretch * (1.0 + e) * (e + 0.5 * e * e);
        *if bears < pull { &mut least } else { &mut most } = e;
    }
    least
}

/// How low what hangs from something of 1 m holds a box that is tied to it, where drag has brought it to rest.
fn low(hangs: &str, of: &str, mass: f64, substeps: u32, method: Method) -> f64 {
    let text = format!(
        r#"{{"forces": [{{"gravity": {{"acceleration": [0, -9.81, 0]}}}}, {{"drag": {{}}}}], {hangs},
        "boxes": [{{"sides": [0.2, 0.1, 0.1], "mass": {mass}, "position": [0, -1.05, 0], "drag": {}}}],
        "ties": [{{"of": {of}, "to": {{"box": 0}}}}]}}"#,
        2.0 * mass,
    );
    let model = model(&text).unwrap();
    let (x, _) = after(&model, 4.0, substeps, method);
    // What hangs comes first or last, and the box has eight corners.
    let of_box = if of.contains("cloth") { x.len() - 8..x.len() } else { 0..8 };
    let others = x.iter().enumerate().filter(|(i, _)| !of_box.contains(i)).map(|(_, x)| -f64::from(x.y));
    others.fold(0.0, f64::max)
}

/// How damped a sheet is does not count where all is at rest: with the load in each sub-step it had been drawn out by as much more.
#[test]
fn damped_sheets_bear_what_is_tied_to_them_as_their_material_says() {
    for (number, (stretch, mass)) in [(200.0f64, 1.0f64), (200.0, 0.4), (2000.0, 1.0)].into_iter().enumerate() {
        for (k, damping) in [0.004, 0.05, 0.4].into_iter().enumerate() {
            let ways = if cfg!(debug_assertions) { &[12][..usize::from(number == k)] } else { &[12, 20, 40] };
            for &substeps in ways {
                let hangs = format!(
                    r#""cloths": [{{"form": {{"sheet": {{"corner": [-0.1, 0, 0], "sides": [[0.2, 0, 0], [0, -1, 0]], "cells": [2, 10]}}}},
                    "density": 0.2, "fixed": [0, 1, 2],
                    "shell": {{"stretch": [{stretch}, {stretch}], "shear": {}, "bending": 1e-4, "damping": {damping}}}}}]"#,
                    stretch / 3.0,
                );
                let method = [Method::Symplectic, Method::Verlet, Method::Implicit][(number + k) % 3];
                let low = low(&hangs, r#"{"cloth": 0}, "points": [30, 31, 32]"#, mass, substeps, method);
                // Half of the sheet's own weight is beneath its middle.
                let off = low - 1.0 - strain_under((mass + 0.02) * 9.81 / 0.2, stretch);
                let case = format!("{stretch} N/m, {mass} kg, {damping} s, {method} in {substeps}");
                assert!(off.abs() < 0.03, "{case}: {low}, off by {off}");
            }
        }
    }
}

/// The same of strands.
#[test]
fn damped_strands_bear_what_is_tied_to_them_as_their_material_says() {
    for (number, (stretch, mass)) in [(40.0f64, 1.0f64), (40.0, 0.3), (4000.0, 1.0)].into_iter().enumerate() {
        for (k, damping) in [0.0, 0.004, 0.05, 0.4].into_iter().enumerate() {
            for &substeps in if cfg!(debug_assertions) { &[16][..] } else { &[16, 60] } {
                let radius = 0.005f64;
                let area = core::f64::consts::PI * radius * radius;
                let hangs = format!(
                    r#""strands": [{{"form": {{"curve": [[0, 0, 0], [0, -1, 0]]}}, "segments": 10, "radius": {radius}, "young": {},
                    "density": 500, "fixed": [0], "damping": {damping}}}]"#,
                    stretch / area,
                );
                let method = [Method::Symplectic, Method::Verlet, Method::Implicit][(number + k) % 3];
                let low = low(&hangs, r#"{"strand": 0}, "points": [10]"#, mass, substeps, method);
                let off = low - 1.0 - (mass + 250.0 * area) * 9.81 / stretch;
                let case = format!("{stretch} N, {mass} kg, {damping} s, {method} in {substeps}");
                assert!(off.abs() < 0.01, "{case}: {low}, off by {off}");
            }
        }
    }
}
