//! Predictions, held against the engine itself.

mod hold;

use super::bounds::Bounds;
use super::modes::{How, Spectrum};
use super::net::Net;
use pointmass::scene::{Model, SceneFile};
use pointmass::stability::{Limit, Mode};
use pointmass::{Drag, ForceKind, Heap, Method, Particle, Spring, System, Time, Vec3};

/// Particles and springs without gravity, made ready.
fn model(particles: Vec<Particle>, springs: Vec<Spring>) -> Model {
    let file = SceneFile { particles, springs, forces: vec![ForceKind::Drag(Drag {})], ..SceneFile::new() };
    Model::load(&file, "", &mut crate::load::Disk).expect("a sound scene")
}

/// A row of particles a metre apart, the first fixed, with these masses, stiffnesses, dampings and drag.
fn row(masses: &[f32], ks: &[f32], kd: &[f32], drag: f32) -> Model {
    let place = |i: usize| Vec3::X * i as f32;
    let particle = |(i, &mass): (usize, &f32)| Particle {
        position: place(i),
        mass,
        fixed: i == 0,
        // Only some are braked, so that drag does not go with mass.
        drag: if i % 2 == 0 { drag } else { 0.0 },
        ..Particle::REST
    };
    let spring = |i: usize| Spring { kd: kd[i], ..Spring::new([i as u32, i as u32 + 1], 1.0, ks[i]) };
    let springs = (0..masses.len() - 1).map(spring).collect();
    model(masses.iter().enumerate().map(particle).collect(), springs)
}

/// True if a small push along the springs grows when the engine steps by `h` \[s\].
fn grows(model: &Model, method: Method, h: f64) -> bool {
    const STEPS: usize = 4000;
    let mut model = model.clone();
    model.integrator = method.into();
    let mut noise = 0.4f32;
    let mut some = || {
        noise = (noise * 997.0 + 0.618).fract();
        1e-3 * (noise - 0.5)
    };
    let springs = model.springs.clone();
    for spring in springs {
        let [a, b] = spring.ends.map(|end| end as usize);
        let along = (model.particles[b].position - model.particles[a].position).normalize();
        model.particles[b].position += along * some();
    }
    let mut system = System::with(Heap::new(model.size(model.particles.len().max(100))));
    system.start(&model.scene(), 1).expect("room");
    let fastest = |system: &System<Heap>| system.particles().velocity.iter().map(|v| v.length()).fold(0.0, f32::max);
    let mut first = 0.0f32;
    for step in 1..=STEPS {
        system.step(&model.scene(), Time::from_seconds_f64(h));
        if step <= 8 {
            first = first.max(fastest(&system));
        }
        if system.totals().died.nonfinite > 0 || (step > 8 && fastest(&system) > 100.0 * first) {
            return true;
        }
    }
    false
}

/// Predicted limits are the engine's, within 2 %.
#[track_caller]
fn holds(model: &Model, expected: How, methods: &[Method]) {
    let spectrum = Spectrum::of(&model.particles, &model.springs).expect("springs");
    assert_eq!(spectrum.how, expected);
    for &method in methods {
        match spectrum.largest_step(method) {
            Limit::Step(step) => {
                assert!(!grows(model, method, 0.98 * step), "{method} grows at 0.98 of {step}");
                assert!(grows(model, method, 1.02 * step), "{method} does not grow at 1.02 of {step}");
            }
            other => panic!("{method}: {other:?}"),
        }
    }
}

/// The methods that take steps as they come, and have a longest; and those of them that need no damping.
const ALL: [Method; 6] =
    [Method::Euler, Method::Symplectic, Method::Midpoint, Method::LectureMidpoint, Method::Verlet, Method::Rk4];
const LASTING: [Method; 3] = [Method::Symplectic, Method::Verlet, Method::Rk4];

#[test]
fn an_undamped_chain() {
    let chain = row(&[0.1; 12], &[100.0; 11], &[0.0; 11], 0.0);
    holds(&chain, How::Independent, &LASTING);
    // Fixed at both ends it is known: ω = 2 √(k/m) sin(jπ/22).
    let mut chain = row(&[0.1; 12], &[100.0; 11], &[0.0; 11], 0.0);
    chain.particles[11].fixed = true;
    let spectrum = Spectrum::of(&chain.particles, &chain.springs).expect("springs");
    let mut found: Vec<f64> = spectrum.modes.iter().map(|mode| mode.omega2.sqrt()).collect();
    found.sort_by(f64::total_cmp);
    for (j, omega) in (1..).zip(&found) {
        let known = 2.0 * 1000f64.sqrt() * (f64::from(j) * std::f64::consts::PI / 22.0).sin();
        assert!((omega / known - 1.0).abs() < 1e-6, "{j}: {omega}, not {known}");
    }
    assert_eq!(found.len(), 10);
    let Limit::Step(step) = spectrum.largest_step(Method::Verlet) else { panic!() };
    assert!((step - 0.031_948_0).abs() < 1e-7, "{step}");
    assert_eq!(spectrum.largest_step(Method::Euler), Limit::Never);
}

#[test]
fn a_chain_damped_as_it_is_stiff() {
    for kd in [1.5, 12.0] {
        let masses = [1.0, 0.5, 2.0, 1.0, 0.7, 1.0];
        holds(&row(&masses, &[50.0; 5], &[kd; 5], 0.0), How::Independent, &ALL);
    }
}

#[test]
fn a_chain_damped_unequally() {
    let masses = [1.0, 0.5, 2.0, 1.0, 0.7, 1.0];
    let chain = row(&masses, &[50.0, 80.0, 20.0, 50.0, 100.0], &[4.0, 1.0, 8.0, 6.0, 2.0], 1.0);
    holds(&chain, How::Coupled, &ALL);
    let loose = row(&masses, &[50.0, 80.0, 20.0, 50.0, 100.0], &[0.4, 0.0, 0.1, 0.0, 0.2], 0.5);
    holds(&loose, How::Coupled, &LASTING);
}

#[test]
fn a_frame_in_space() {
    let corners = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z, Vec3::new(1.0, 1.0, 0.5)];
    let particle = |(i, &position)| Particle { position, mass: 1.0 + i as f32, ..Particle::REST };
    let ends = (0..5u32).flat_map(|b| (0..b).map(move |a| [a, b]));
    let spring = |ends: [u32; 2]| {
        let rest_length = (corners[ends[0] as usize] - corners[ends[1] as usize]).length();
        Spring { kd: 10.0, ..Spring::new(ends, rest_length, 200.0) }
    };
    let frame = model(corners.iter().enumerate().map(particle).collect(), ends.map(spring).collect());
    holds(&frame, How::Independent, &ALL);
}

/// The bound of a scene is the engine's: nothing grows a little below it, and something beyond it by such a factor.
#[track_caller]
fn bounds(scene: &str, methods: &[Method], beyond: f64) {
    let file = SceneFile::from_json("a.json", scene).expect("a scene");
    let model = Model::load(&file, "", &mut crate::load::Disk).expect("a sound scene");
    for &method in methods {
        let Limit::Step(step) = Bounds::of(&model).largest_step(method) else { panic!("{method}: no step") };
        assert!(!grows(&model, method, 0.98 * step), "{method} grows at 0.98 of {step}: {scene}");
        assert!(grows(&model, method, beyond * step), "{method} does not grow at {beyond} of {step}: {scene}");
    }
}

#[test]
fn drag_and_mass_over_a_life() {
    let scene = |life: &str, particles: &str, forces: &str| {
        let materials = format!(r#"[{{}}, {{"life": {life}}}]"#);
        format!(r#"{{"forces": [{forces}], "materials": {materials}, {particles}}}"#)
    };
    let both = r#"{"drag": {"keys": [[0, 1], [0.05, 4]], "over": "seconds"},
        "mass": {"keys": [[0, 1], [0.07, 0.5]], "over": "seconds", "smooth": true}}"#;
    // The second is braked more at birth.
    let two =
        r#""particles": [{"velocity": [1, 0, 0], "drag": 2, "material": 1}, {"velocity": [1, 0, 0], "drag": 15}]"#;
    bounds(&scene(both, two, r#"{"drag": {}}"#), &ALL, 1.02);
    // A wind's own coefficient has the mass alone to change.
    bounds(&scene(both, two, r#"{"wind": {"field": [], "coefficient": 9}}"#), &ALL, 1.02);
    let born = r#""emitters": [{"shape": {"sphere": {"center": [0, 0, 0], "radius": 1}}, "burst": {"count": 90, "at": 0}, "speed": 1,
        "drag": 3, "mass": {"mean": 2, "half_width": 0.01}, "material": 1}]"#;
    let sides = r#"{"drag": {"between": [{"keys": [[0, 2]]}, {"keys": [[0, 9]]}]}}"#;
    bounds(&scene(sides, born, r#"{"drag": {}}"#), &ALL, 1.06);
    let hung = r#""particles": [{"fixed": true}, {"position": [1, 0, 0], "material": 1}],
        "springs": [{"ends": [0, 1], "rest_length": 1, "ks": 100, "kd": 4}]"#;
    bounds(&scene(r#"{"mass": {"keys": [[0, 1], [0.1, 0.25]], "over": "seconds"}}"#, hung, ""), &ALL, 1.02);
    // It grows heavy, and what is heavy grows slowly.
    bounds(&scene(r#"{"mass": {"keys": [[20, 1], [30, 4]], "over": "seconds"}}"#, hung, ""), &ALL, 1.1);
    // What damps a spring ceases to.
    let loose = hung.replace("\"kd\": 4", "\"kd\": 0").replace("\"material\": 1", "\"material\": 1, \"drag\": 20");
    let fades = r#"{"drag": {"keys": [[0, 1], [0.1, 0.2]], "over": "seconds"}}"#;
    bounds(&scene(fades, &loose, r#"{"drag": {}}"#), &[Method::Euler], 1.06);
}

#[test]
fn what_is_heavier_stands_longer_steps() {
    for method in ALL {
        for (k, c) in (0..40).flat_map(|i| (0..40).map(move |j| (f64::from(i), 0.2 * f64::from(j)))) {
            let step = |inverse: f64| Mode { omega2: k * inverse, damping: c * inverse }.largest_step(method);
            let Limit::Step(light) = step(1.0) else { continue };
            assert!(
                [0.9, 0.5, 0.1, 0.01].iter().all(|&inverse| step(inverse).admits(light * (1.0 - 1e-9))),
                "{method}: {k} {c}"
            );
        }
    }
}

#[test]
fn goals_hold_as_springs_do() {
    let scene = |goals: &str, rest: &str| {
        let led = r#"{"position": [1, 0, 0], "velocity": [0, 1, 0], "mass": 0.2, "drag": 1, "material": 0}"#;
        let particles = format!(r#""particles": [{{"fixed": true}}, {led}]"#);
        format!(r#"{{"materials": [{{}}, {{}}], "goals": [{goals}], {particles}{rest}}}"#)
    };
    let goal = |settle: f64, more: &str| {
        let place = r#"{"line": {"from": [1, 0, 0], "to": [1, 0.001, 0]}}"#;
        format!(r#"{{"shape": {place}, "arrive": 0, "settle": {settle}{more}}}"#)
    };
    let [soft, hard] = [goal(0.1, ""), goal(0.03, "")];
    bounds(&scene(&soft, ""), &ALL, 1.02);
    bounds(&scene(&format!("{soft}, {hard}, {soft}"), ""), &ALL, 1.02);
    bounds(&scene(&soft, r#", "forces": [{"drag": {}}]"#), &ALL, 1.02);
    let spring = r#", "forces": [{"drag": {}}], "springs": [{"ends": [0, 1], "rest_length": 1, "ks": 200}]"#;
    let file = SceneFile::from_json("a.json", &scene(&soft, spring)).expect("a scene");
    let model = Model::load(&file, "", &mut crate::load::Disk).expect("a sound scene");
    for method in LASTING {
        let Some(goals) = Bounds::of(&model).goals else { panic!("goals") };
        let Limit::Step(step) = goals.largest_step(method) else { panic!("{method}") };
        assert!(!grows(&model, method, 0.98 * step), "{method} grows at 0.98 of {step}");
        assert!(grows(&model, method, 1.02 * step), "{method} does not grow at 1.02 of {step}");
    }
    let limit = |goals: &str| {
        let file = SceneFile::from_json("a.json", &scene(goals, "")).expect("a scene");
        let model = Model::load(&file, "", &mut crate::load::Disk).expect("a sound scene");
        Bounds::of(&model).goals.map(|goals| (goals.part.place.clone(), goals.largest_step(Method::Symplectic)))
    };
    // Who is of another material is not led, and one goal after the other holds no more than each alone.
    assert_eq!(limit(&goal(0.01, r#", "material": 1"#)), None);
    assert_eq!(limit(&format!("{soft}, {}", goal(0.01, r#", "material": 1"#))), limit(&soft));
    let [early, late] =
        [goal(0.1, r#", "release": 1"#), goal(0.1, r#", "start": 1"#).replace("\"arrive\": 0", "\"arrive\": 2")];
    assert_eq!(limit(&format!("{early}, {late}")), limit(&soft));
    assert_eq!(limit(&format!("{soft}, {hard}")).map(|(place, _)| place), Some("goals[1]".into()));
}

/// Air blows the harder at whoever is light and large: as much as the law has it, wherever it comes from, whatever the mesh.
#[test]
fn air_brakes_surfaces_and_segments() {
    let drag = |file: &str, method: Method| {
        let file = SceneFile::from_json("a.json", file).expect("a scene");
        Bounds::of(&Model::load(&file, "", &mut crate::load::Disk).expect("a sound scene")).drag_step(method)
    };
    for (cells, density, wind) in [(1, 0.1, 4.0), (5, 0.02, 16.0)] {
        let sheet = |up: &str| {
            format!(
                r#"{{"forces": [{{"wind": {{"field": [{{"uniform": {{"velocity": {up}}}}}]}}}}], "cloths": [{{"form": {{"sheet": {{"corner": [0, 0, 0],
                    "sides": [[1, 0, 0], [0, 0, 1]], "cells": [{cells}, {cells}]}}}}, "density": {density}, "air": {{}},
                    "shell": {{"stretch": [1000, 1000], "shear": 300, "bending": 1e-5}}}}]}}"#
            )
        };
        for up in [format!("[0, {wind}, 0]"), format!("[{wind}, 0, 0]")] {
            let Limit::Step(step) = drag(&sheet(&up), Method::Symplectic) else { panic!("{up}") };
            assert!((step * 1.2 * 1.2 * wind / density / 2.0 - 1.0).abs() < 1e-4, "{cells} {up}: {step}");
            assert_eq!(drag(&sheet(&up), Method::Implicit), Limit::Unconditional);
        }
    }
    let hair = |curve: &str| {
        format!(
            r#"{{"forces": [{{"wind": {{"field": [{{"uniform": {{"velocity": [0, 9, 0]}}}}]}}}}], "strands": [{{"form": {{"curve": {curve}}}, "segments": 8, "radius": 5e-5, "young": 4e9, "density": 1300,
                "air": {{}}}}]}}"#
        )
    };
    let [level, upright] = ["[[0, 0, 0], [0.2, 0, 0]]", "[[0, 0, 0], [0, 0.2, 0]]"].map(|curve| {
        let Limit::Step(step) = drag(&hair(curve), Method::Symplectic) else { panic!("{curve}") };
        step
    });
    assert!((level / upright - 1.0).abs() < 1e-4 && level < 0.02 && level > 0.005, "{level} {upright}");
}

/// In steps that are just short enough gas fills a mesh as in far shorter ones; in far longer ones it does not.
#[test]
fn gas_bounds_the_step() {
    let filled = |amount: f64, outside: f64, method: Method, share: f64| {
        let text = format!(
            r#"{{"cloths": [{{"form": {{"mesh": "../scenes/assets/knot.off"}}, "density": 1,
                "gas": {{"amount": {amount}, "outside": {outside}}},
                "shell": {{"stretch": [3000, 3000], "shear": 1000, "bending": 1e-5, "damping": 0.02}}}}]}}"#
        );
        let file = SceneFile::from_json("a.json", &text).expect("a scene");
        let mut model = Model::load(&file, "a.json", &mut crate::load::Disk).expect("a sound scene");
        let gas = Bounds::of(&model).gas.expect("gas");
        let Limit::Step(limit) = gas.largest_step(method) else { panic!("{method}") };
        model.integrator = method.into();
        let mut system = System::with(Heap::new(model.size(model.particles.len())));
        system.start(&model.scene(), 1).expect("room");
        let steps = (0.15 / (share * limit)).ceil();
        for _ in 0..steps as u32 {
            system.step(&model.scene(), Time::from_seconds_f64(0.15 / steps));
        }
        let x = system.particles().position;
        let middle = x.iter().copied().sum::<Vec3>() / x.len() as f32;
        (limit, x.iter().map(|x| (*x - middle).length()).sum::<f32>() / x.len() as f32)
    };
    for (amount, outside, method) in [(40.0, 0.0, Method::Symplectic), (2000.0, 9000.0, Method::Verlet)] {
        let (limit, right) = filled(amount, outside, method, 0.4);
        let (_, just) = filled(amount, outside, method, 0.9);
        assert!((just / right - 1.0).abs() < 0.05, "{method}, steps of {limit} s: {just}, not {right}");
        let (_, far) = filled(amount, outside, method, 3.0);
        assert!((far / right - 1.0).abs() > 0.2, "{method}, steps of three times {limit} s: {far}");
    }
}

#[test]
fn what_is_too_large_is_taken_at_its_extreme() {
    let n = 320;
    let long = row(&vec![1.0; n], &vec![100.0; n - 1], &vec![20.0; n - 1], 0.0);
    let spectrum = Spectrum::of(&long.particles, &long.springs).expect("springs");
    assert_eq!(spectrum.how, How::Extreme);
    // ω² tends to 4 k/m: damping ratio 2, the fastest rate 20 (2 + √3).
    let fast = 20.0 * (2.0 + 3f64.sqrt());
    for (method, known) in [
        (Method::Euler, 2.0 / fast),
        (Method::Symplectic, 0.1 * (5f64.sqrt() - 2.0)),
        (Method::Rk4, 2.785_293_563 / fast),
    ] {
        let Limit::Step(step) = spectrum.largest_step(method) else { panic!("{method}") };
        assert!((step / known - 1.0).abs() < 2e-3, "{method}: {step}, not {known}");
    }
}

#[test]
fn what_a_single_direction_allows_is_no_less_than_what_all_do() {
    let mut noise = 0.4f32;
    let mut between = |low: f32, high: f32| {
        noise = (noise * 997.0 + 0.618).fract();
        low * (high / low).powf(noise)
    };
    for n in 5..11 {
        let particle = |_| {
            let position = Vec3::new(between(1.0, 3.0), between(1.0, 3.0), between(1.0, 3.0));
            Particle { position, mass: between(0.1, 3.0), drag: between(0.01, 3.0), ..Particle::REST }
        };
        let particles: Vec<_> = (0..n).map(particle).collect();
        let ends = (0..3 * n).map(|i| [(i % n) as u32, ((7 * i + i / n + 1) % n) as u32]).filter(|[a, b]| a != b);
        let spring = |ends| Spring { kd: between(0.1, 20.0), ..Spring::new(ends, 1.0, between(10.0, 300.0)) };
        let springs: Vec<_> = ends.map(spring).collect();
        let (spectrum, net) = (Spectrum::of(&particles, &springs).expect("springs"), Net::of(&particles, &springs));
        assert_eq!(spectrum.how, How::Coupled);
        for method in [Method::Euler, Method::Symplectic, Method::Midpoint, Method::Rk4] {
            let both = [spectrum.largest_step(method), net.critical_step(method)];
            let [Limit::Step(all), Limit::Step(one)] = both else { panic!("{method}: {both:?}") };
            // A direction is no mode, so that it may be a little less.
            assert!(one > 0.97 * all, "{n} {method}: {one} for {all}");
        }
    }
}

#[test]
fn springs_that_hold_nothing_have_no_modes() {
    let none = |particles: &[Particle], springs: &[Spring]| Spectrum::of(particles, springs).is_none();
    let spring = Spring { kd: 1.0, ..Spring::new([0, 1], 1.0, 1.0) };
    let fixed = Particle { fixed: true, ..Particle::REST };
    assert!(none(&[Particle::REST], &[]));
    assert!(none(&[fixed, Particle { position: Vec3::X, ..fixed }], &[spring]));
    // Two in one place have no direction.
    assert!(none(&[Particle::REST; 2], &[spring]));
}

#[test]
fn the_course_s_scenes() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared/scenes/course");
    if !folder.is_dir() {
        println!("skipped: the course's scenes are not at {}", folder.display());
        return;
    }
    for (name, known) in [
        ("rope", [26.97, 26.97, 23.74, 37.55]),
        ("swirl", [50.4, 50.4, 50.2, 70.2]),
        ("tetra", [26.8, 26.8, 23.6, 37.3]),
    ] {
        let path = folder.join(format!("{name}.scn"));
        let mut file = crate::load::scene(&path).expect("a scene");
        file.forces = vec![ForceKind::Drag(Drag {})];
        file.particles.iter_mut().for_each(|particle| particle.velocity = Vec3::ZERO);
        let model = Model::load(&file, &path.to_string_lossy(), &mut crate::load::Disk).expect("a sound scene");
        let spectrum = Spectrum::of(&model.particles, &model.springs).expect("springs");
        for (method, known) in [Method::Euler, Method::Midpoint, Method::Symplectic, Method::Rk4].into_iter().zip(known)
        {
            let Limit::Step(step) = spectrum.largest_step(method) else { panic!("{name} {method}") };
            assert!((step * 1e3 / known - 1.0).abs() < 2e-3, "{name} {method}: {step}, not {known} ms");
        }
        holds(&model, How::Independent, &ALL);
    }
}
