//! What can be run and is hardly meant, told by name; unknown commands, and files that are called otherwise.

use crate::scenes::{ONE, TRIANGLE};
use crate::tool::Folder;

/// The warnings of the commands that do what a scene says.
#[track_caller]
fn warned(folder: &Folder, scene: &str, words: &[&str]) {
    for args in [
        format!("run {scene} --steps 2"),
        format!("render {scene} --duration 0 --size 8x8 --out o.png"),
        format!("check {scene}"),
        format!("lab {scene} --duration 0.1 --integrators verlet"),
    ] {
        let answer = folder.run(&args);
        let warnings = answer.warnings();
        for word in words {
            assert!(warnings.iter().any(|warning| warning.contains(word)), "{args} does not say {word}: {warnings:?}");
        }
    }
}

#[test]
fn json_that_is_hardly_meant_is_remarked_on_by_name() {
    let shape = r#""shape": {"sphere": {"center": [0, 0, 0], "radius": 1}}"#;
    let sheet = r#"{"sheet": {"corner": [0, 0, 0], "sides": [[1, 0, 0], [0, 0, 1]], "cells": [2, 2]}}"#;
    let emitter = |rest: &str| format!(r#"{{"emitters": [{{{shape}, "rate": 1, {rest}}}]}}"#);
    let folder = Folder::new();
    for (text, words) in [
        (r#"{"particles": [{}, {"elasticity": 1.01}]}"#.into(), "a.json:particles[1].elasticity: 1.01 is above 1"),
        (r#"{"particles": [{"elasticity": -0.1}]}"#.into(), "a.json:particles[0].elasticity: -0.1 is below 0"),
        (emitter(r#""elasticity": {"mean": 0.75, "half_width": 0.5}"#), "a.json:emitters[0].elasticity: 1.25 is above"),
        (emitter(r#""elasticity": {"mean": 0.25, "half_width": 0.5}"#), "a.json:emitters[0].elasticity: -0.25 is below"),
        (emitter(r#""spread": {"uniform": 3.2}"#), "a.json:emitters[0].spread: 3.2 rad is not from 0 to π"),
        (emitter(r#""spread": {"uniform": -1}"#), "a.json:emitters[0].spread: -1 rad is not from 0 to π"),
        (
            emitter(r#""lifetime": {"mean": 1, "half_width": 1.5}"#),
            "a.json:emitters[0].lifetime: -0.5 s is the least of it",
        ),
        (
            r#"{"particles": [{}, {"drag": 2}, {"drag": 1}], "forces": [{"gravity": {"acceleration": [0, -1, 0]}}]}"#.into(),
            "a.json:particles[1].drag: 2 brakes nobody",
        ),
        (
            r#"{"particles": [{"drag": 1}], "forces": [{"drag": {}}, {"wind": {"field": [{"uniform": {"velocity": [1, 0, 0]}}]}}]}"#.into(),
            "a.json:forces[0].drag: wind brakes by the same coefficients",
        ),
        (
            r#"{"room": {"low": [-1, -1, -1], "sides": [2, 2, 2]}, "scenery": [
                {"shape": {"box": {"min": [-2, -2, -2], "max": [2, -0.9, 2]}}},
                {"shape": {"box": {"min": [-1.2, -1, -1], "max": [-0.6, 1, 1]}}}]}"#
                .into(),
            "a.json:scenery[1].shape: it reaches out of the room along x, and does not act through its sides",
        ),
        (
            r#"{"forces": [{"gravity": {"acceleration": [0, -9.81, 0]}}], "boxes": [
                {"sides": [0.2, 0.2, 0.2], "mass": 1, "position": [0, 0.1, 0]},
                {"sides": [0.2, 0.2, 0.2], "mass": 10, "position": [0, 0.3, 0]}]}"#
                .into(),
            "a.json:boxes: bodies of 10 kg sink into those of 1 kg that bear them, and through them at last; run.substeps of 2 are enough",
        ),
        (
            r#"{"forces": [{"gravity": {"acceleration": [0, -9.81, 0]}}], "boxes": [
                {"sides": [0.2, 0.2, 0.2], "mass": 1e-18, "position": [0, 0.1, 0]},
                {"sides": [0.2, 0.2, 0.2], "mass": 1e18, "position": [0, 0.3, 0]}]}"#
                .into(),
            "and through them at last; no number of sub-steps is enough, of which run.substeps may say 1000",
        ),
        (
            format!(
                r#"{{"forces": [{{"gravity": {{"acceleration": [0, -9.81, 0]}}}}], "run": {{"substeps": 4}},
                "particles": [{{"position": [0.5, 0.2, 0.5], "radius": 0.1, "mass": 20}}],
                "cloths": [{{"form": {sheet}, "mass": 0.01, "fixed": [0, 2, 6, 8], "thickness": 0.02,
                "shell": {{"stretch": [2000, 2000], "shear": 1000, "bending": 0}}}}]}}"#
            ),
            "a.json:cloths[0].thickness: what weighs 20 kg sinks into it, whose points weigh 0.0011111111 kg each, or falls through; run.substeps of 25 are enough",
        ),
        (
            format!(
                r#"{{"contacts": {{"position": {{}}}}, "particles": [{{"radius": 0.2, "position": [0.5, 1, 0.5]}}],
                "cloths": [{{"form": {sheet}, "mass": 1, "fixed": [0, 2, 6, 8], "thickness": 0.02,
                "shell": {{"stretch": [2000, 2000], "shear": 1000, "bending": 0}}}}]}}"#
            ),
            "a.json:cloths[0].thickness: balls of a radius of 0.2 m may slip through it: they meet its particles alone, which are 0.5 m apart; from 0.49497473 m on they do not, or in cells of 0.20203052 m",
        ),
        (
            format!(
                r#"{{"forces": [{{"gravity": {{"acceleration": [0, -9.81, 0]}}}}], "run": {{"substeps": 4}}, "cloths": [
                {{"form": {sheet}, "mass": 5, "thickness": 0.02, "shell": {{"stretch": [2000, 2000], "shear": 1000, "bending": 0}}}},
                {{"form": {sheet}, "mass": 0.2, "fixed": [0, 2, 6, 8], "thickness": 0.02,
                "shell": {{"stretch": [2000, 2000], "shear": 1000, "bending": 0}}}}]}}"#
            ),
            "a.json:cloths[1].thickness: a sheet whose points weigh 0.5555556 kg sinks into it",
        ),
        (
            r#"{"forces": [{"gravity": {"acceleration": [0, -9.81, 0]}}], "cloths": [{"fixed": [0, 1, 2, 3],
                "form": {"sheet": {"corner": [0, 0, 0], "sides": [[0.3, 0, 0], [0, 0, 0.03]], "cells": [10, 1]}},
                "isotropic": {"young": 7e10, "poisson": 0.35, "thickness": 1e-3, "density": 2700}}]}"#
                .into(),
            "a.json:cloths[0]: it is so stiff that what it stretches by as it bends in a sub-step outweighs it: it hangs too far, or shakes; run.substeps of 12 are enough",
        ),
        (emitter(r#""start": 2, "stop": 1.5"#), "a.json:emitters[0].stop: 1.5 s is not after start, 2 s"),
        (
            r#"{"particles": [{"radius": 0.1, "mass": 1000}, {"radius": 0.1, "position": [1, 0, 0]}], "contacts": {"position": {}}}"#.into(),
            "a.json:contacts.position: balls of 1000 kg weigh more than 50 times as much as those of 1 kg",
        ),
        (
            r#"{"forces": [{"gravity": {"acceleration": [0, -9.81, 0]}}], "contacts": {"position": {}}, "run": {"dt": 0.016666666},
                "particles": [{"radius": 1e-4}, {"radius": 0.1, "position": [1, 0, 0]}]}"#
                .into(),
            "a.json:contacts.position: gravity moves balls of 0.0001 m by 0.19 of their radius in a sub-step: in heaps they sink into each other, and wander; run.substeps of 37 are enough",
        ),
        (
            r#"{"boxes": [{"sides": [1, 1, 1], "mass": 1, "position": [0, 0, 0], "count": [2, 0, 1]}]}"#.into(),
            "a.json:boxes[0].count: 0 of them along an axis are none at all",
        ),
        (
            r#"{"boxes": [{"sides": [1, 1, 1], "mass": 1, "position": [0, 0, 0], "fixed": true, "velocity": [1, 0, 0]}]}"#.into(),
            "a.json:boxes[0].velocity: they are fixed, and stay where they are",
        ),
        (
            r#"{"lights": [{"directional": {"color": [1, 1, 1], "direction": [0, 0, 0]}}]}"#.into(),
            "a.json:lights[0].direction: 0 is no direction to shine in",
        ),
        (
            emitter(r#""where_sparse": {"radius": 0, "fewest": 3}"#),
            "a.json:emitters[0].where_sparse.radius: nobody is within 0 m, so that it is sparse everywhere",
        ),
        (
            r#"{"particles": [{}, {}], "springs": [{"ends": [1, 1], "rest_length": 1, "ks": 1}]}"#.into(),
            "a.json:springs[0].ends: the spring joins particle 1 to itself",
        ),
        (
            format!(r#"{{"cloths": [{{"form": {sheet}, "mass": 1, "elasticity": 2, "springs": {{"bend": {{"ks": 1}}}}}}]}}"#),
            "a.json:cloths[0].elasticity: 2 is above 1",
        ),
        (
            r#"{"ropes": [{"curve": [[0, 0, 0], [1, 0, 0]], "segments": 2, "weight": 1, "elasticity": 1.5}]}"#.into(),
            "a.json:ropes[0].elasticity: 1.5 is above 1",
        ),
        (
            r#"{"strands": [{"form": {"curve": [[0, 0, 0], [0, 1, 0]]}, "segments": 2, "radius": 1e-3, "young": 1e6, "density": 1000,
                "elasticity": -0.5}]}"#
                .into(),
            "a.json:strands[0].elasticity: -0.5 is below 0",
        ),
        (
            r#"{"boxes": [{"sides": [1, 1, 1], "mass": 1, "position": [0, 0, 0]},
                {"sides": [1, 1, 1], "mass": 1, "position": [5, 0, 0], "elasticity": 2}]}"#
                .into(),
            "a.json:boxes[1].elasticity: 2 is above 1",
        ),
        (
            r#"{"run": {"capacity": 2}, "particles": [{}, {}, {}]}"#.into(),
            "a.json:run.capacity: 2 is less than the 3 particles that the scene begins with, which have room all the same",
        ),
        (
            r#"{"materials": [{"contact": {"friction": {"static": 0.1, "kinetic": 0.2}}}]}"#.into(),
            "a.json:materials[0].contact.friction.static: 0.1 is below kinetic, 0.2",
        ),
        (
            r#"{"particles": [{"radius": 1}], "contacts": {"force": {"stiffness": 1, "friction": {"static": 0, "kinetic": 1}}}}"#
                .into(),
            "a.json:contacts.force.friction.static: 0 is below kinetic, 1",
        ),
        (
            r#"{"particles": [{}, {}], "springs": [{"ends": [0, 1], "rest_length": 1, "ks": -5, "kd": 0}]}"#.into(),
            "a.json:springs[0].ks: -5 is below 0",
        ),
        (
            r#"{"boxes": [{"sides": [1, 1, 1], "mass": 1, "position": [0, 0, 0], "count": [1, 2, 1], "spacing": [1, 0, 1]}]}"#.into(),
            "a.json:boxes[0].spacing: 0 along y puts them into each other",
        ),
        (
            r#"{"boxes": [{"sides": [1, 1, 1], "mass": 1, "position": [0, 0, 0]}, {"sides": [2, 1, 1], "mass": 1, "position": [-0.0, 0, 0]}]}"#.into(),
            "a.json:boxes[1].position: it is that of boxes[0]",
        ),
        (
            r#"{"scenery": [{"shape": {"triangle": {"corners": [[0, 0, 0], [1, 1, 1], [2, 2, 2]]}}}]}"#.into(),
            "a.json:scenery[0].shape.triangle: its corners lie on a line",
        ),
        (
            r#"{"particles": [{}, {}], "constraints": [{"distance": {"ends": [1, 1], "length": 1}}]}"#.into(),
            "a.json:constraints[0].distance.ends: it holds particle 1 to itself",
        ),
        (
            r#"{"strands": [{"form": {"curve": [[0, 0, 0], [0, 1, 0]]}, "segments": 2, "radius": 1e-3, "young": 1e6, "density": 1000,
                "motion": {"keys": [{"time": 0}, {"time": 1, "place": [1, 0, 0]}]}}]}"#
                .into(),
            "a.json:strands[0].motion: none of its points is fixed",
        ),
        (
            format!(r#"{{"particles": [{{}}], "sinks": [{{{shape}, "intensity": 1, "ca": 0, "la": 0, "qa": 0}}]}}"#),
            "a.json:sinks[0].intensity: it divides by ca, la and qa",
        ),
        (
            format!(r#"{{"particles": [{{}}], "sinks": [{{{shape}, "intensity": 1, "ca": 0, "la": 0, "qa": 1}}]}}"#),
            "a.json:sinks[0].ca: 0 leaves its pull without bound",
        ),
        (
            r#"{"particles": [{}], "reapers": [{"dense": {"radius": 0, "most": 1}}]}"#.into(),
            "a.json:reapers[0].dense.radius: nobody is within 0 m",
        ),
        (
            r#"{"particles": [{}], "goals": [{"shape": {"plane": {"point": [0, 0, 0], "normal": [0, 1, 0]}}, "arrive": 1}]}"#.into(),
            "a.json:goals[0].shape: a plane is infinite",
        ),
    ] {
        folder.write("a.json", &text);
        warned(&folder, "a.json", &[words]);
    }
    let fine =
        r#""elasticity": {"mean": 0.5, "half_width": 0.5}, "spread": {"uniform": 3.14159274}, "start": 1, "stop": 2"#;
    folder.write("a.json", emitter(fine));
    folder.run("run a.json --steps 2").fine();
}

#[test]
fn remarks_on_long_sub_steps_count_those_of_contacts() {
    let folder = Folder::new();
    let scene = |contacts: &str| {
        format!(
            r#"{{"forces": [{{"gravity": {{"acceleration": [0, -9.81, 0]}}}}], {contacts} "boxes": [
            {{"sides": [0.2, 0.2, 0.2], "mass": 1, "position": [0, 0.1, 0]}},
            {{"sides": [0.2, 0.2, 0.2], "mass": 10, "position": [0, 0.3, 0]}}]}}"#
        )
    };
    for (contacts, sinks) in [("", true), (r#""contacts": {"position": {"substeps": 4}},"#, false)] {
        folder.write("a.json", scene(contacts));
        let answer = folder.run("run a.json --steps 1");
        assert_eq!(answer.warnings().iter().any(|warning| warning.contains("sink into")), sinks, "{contacts}");
    }
}

/// Balls that meet by impulse and may lie on each other on rigid bodies are remarked on, and a single one is not, nor those that meet by position, or where nothing is rigid.
#[test]
fn balls_by_impulse_above_boxes_are_remarked_on() {
    let folder = Folder::new();
    let (ball, other) = (r#"{"position": [0, 1, 0], "radius": 0.1}"#, r#"{"position": [0, 2, 0], "radius": 0.1}"#);
    let (one, two) = (format!("[{ball}]"), format!("[{ball}, {other}]"));
    let (bodies, none) = (r#"[{"sides": [1, 1, 1], "mass": 1, "position": [0, 0, 0]}]"#, "[]");
    for (contacts, particles, boxes, told) in [
        ("impulse", &two, bodies, true),
        ("impulse", &one, bodies, false),
        ("impulse", &two, none, false),
        ("position", &two, bodies, false),
    ] {
        folder.write(
            "a.json",
            format!(r#"{{"contacts": {{"{contacts}": {{}}}}, "particles": {particles}, "boxes": {boxes}}}"#),
        );
        let answer = folder.run("run a.json --steps 1");
        let is_told = answer.warnings().iter().any(|warning| warning.contains("pressed into the boxes"));
        assert_eq!(is_told, told, "{contacts} {particles} {boxes}");
    }
}

/// Where two ropes pull at one body, as many sub-steps are named as leave no remark, more for small ones and for what is heavy below them, and none where there is one rope, or
/// nothing pulls, or nothing turns fast.
#[test]
fn bodies_on_two_ropes_are_remarked_on() {
    let folder = Folder::new();
    let scene = |substeps: u32, second: &str, gravity: &str, [side, below]: [f32; 2]| {
        format!(
            r#"{{"run": {{"substeps": {substeps}}}, "forces": [{gravity}], "boxes": [{{"sides": [{side}, {side}, {side}], "mass": 1, "position": [0, -1.1, 0]}},
            {{"sides": [0.2, 0.2, 0.2], "mass": {below}, "position": [0, -2.1, 0]}}],
            "ropes": [{{"curve": [[0, 0, 0], [0, -1, 0]], "segments": 5, "weight": 0.01, "fixed": [0], "ends": [null, {{"box": 0}}]}},
            {{"curve": [[0, 0, 0], [0, -1, 0]], "segments": 5, "weight": 0.01, "ends": {second}}}]}}"#
        )
    };
    let pulls = r#"{"gravity": {"acceleration": [0, -9.81, 0]}}"#;
    let told = |substeps: u32, second: &str, gravity: &str, sizes: [f32; 2]| {
        folder.write("a.json", scene(substeps, second, gravity, sizes));
        let answer = folder.run("run a.json --steps 1");
        let told = answer.warnings().into_iter().find(|warning| warning.contains("another rope pulls at too"));
        told.map(|text| {
            text.split("run.substeps of ").nth(1).unwrap().split(' ').next().unwrap().parse::<u32>().unwrap()
        })
    };
    let (alone, beside, below) = ("[null, null]", r#"[null, {"box": 0}]"#, r#"[{"box": 1}, {"box": 0}]"#);
    assert_eq!(told(1, alone, pulls, [0.01, 100.0]), None);
    assert_eq!(told(1, beside, "", [0.01, 100.0]), None);
    assert_eq!(told(1, beside, pulls, [0.2, 100.0]), None);
    assert_eq!(told(1, below, pulls, [0.2, 1.0]), None);
    let mut last = 1;
    for (second, sizes) in [(beside, [0.01, 1.0]), (below, [0.2, 50.0]), (below, [0.01, 50.0])] {
        let enough = told(1, second, pulls, sizes).unwrap();
        assert!(enough > last, "{second} {sizes:?}: {enough}");
        assert_eq!(told(enough, second, pulls, sizes), None, "{enough}");
        assert_eq!(told(enough - 1, second, pulls, sizes), Some(enough));
        last = enough;
    }
}

/// Remarks on steps that are too long go by those that are made, whatever the file says.
#[test]
fn remarks_on_steps_go_by_the_command_line() {
    let folder = Folder::new();
    let scene = r#"{"forces": [{"gravity": {"acceleration": [0, -9.81, 0]}}], "contacts": {"position": {}},
        "particles": [{"radius": 1e-4}, {"radius": 0.1, "position": [1, 0, 0]}]}"#;
    folder.write("a.json", scene);
    let told = |command: &str| folder.run(command).stderr.contains("of their radius in a sub-step");
    for (arguments, is_told) in [
        ("--dt 1/60", true),
        ("--dt 1/60 --substeps 2", false),
        ("--dt 1/240", false),
        ("--dt 1/30 --substeps 2", true),
        ("--dt 1/60 --substeps auto", true),
    ] {
        assert_eq!(told(&format!("run a.json --steps 1 {arguments}")), is_told, "{arguments}");
    }
    assert!(told("check a.json --dt 1/60") && !told("check a.json --dt 1/240"));
}

/// Ropes between a sheet and what is heavy for its points are remarked on, with as many sub-steps as leave no remark: those that are heavy or bear a box, and those that hold the sheet. What is tied is
/// not, as sheets feel that.
#[test]
fn ropes_that_pull_at_light_points_of_sheets_are_remarked_on() {
    let folder = Folder::new();
    let told = |substeps: u32, fixed: &str, mass: f32, bond: &str| {
        let scene = format!(
            r#"{{"run": {{"substeps": {substeps}}}, "forces": [{{"gravity": {{"acceleration": [0, -9.81, 0]}}}}],
            "cloths": [{{"form": {{"sheet": {{"corner": [0, 1, 0], "sides": [[1, 0, 0], [0, -1, 0]], "cells": [9, 9]}}}},
                "density": 0.2, "fixed": {fixed}, "shell": {{"stretch": [3000, 3000], "shear": 600, "bending": 1e-5}}}}],
            "boxes": [{{"sides": [0.1, 0.1, 0.1], "mass": {mass}, "position": [0, -0.35, 0]}}], {bond}}}"#
        );
        folder.write("a.json", scene);
        let answer = folder.run("run a.json --steps 1");
        let told = answer.warnings().into_iter().find(|warning| warning.contains("at a point of a sheet"));
        told.map(|text| {
            text.split("run.substeps of ").nth(1).unwrap().split(' ').next().unwrap().parse::<u32>().unwrap()
        })
    };
    let rope = r#""curve": [[0, 0, 0], [0, -0.3, 0]], "segments": 4, "diameter": 0.01, "density": 900"#;
    let load = format!(r#""ropes": [{{{rope}, "ends": [{{"cloth": 0}}, {{"box": 0}}]}}]"#);
    let hook = r#""curve": [[0, 1.3, 0], [0, 1, 0]], "segments": 4, "diameter": 0.01, "density": 900"#;
    let held = format!(r#""ropes": [{{{hook}, "fixed": [0], "ends": [null, {{"cloth": 0}}]}}]"#);
    for (bond, fixed) in [(&load, "[0, 9]"), (&held, "[]")] {
        let enough = told(1, fixed, 0.5, bond).unwrap();
        assert!(enough > 5, "{bond}: {enough}");
        assert_eq!(told(enough, fixed, 0.5, bond), None, "{bond}");
        assert_eq!(told(enough - 1, fixed, 0.5, bond), Some(enough), "{bond}");
    }
    assert_eq!(told(1, "[0, 9]", 0.5, &held), None, "it is held by others");
    assert!(told(1, "[0, 9]", 1e-4, &load).unwrap() < 10, "the rope alone is heavier than a point");
    assert_eq!(told(1, "[0, 9]", 1e-4, &load.replace("900", "1")), None, "it is light");
    let tied = r#""ties": [{"of": {"cloth": 0}, "points": [90, 99], "to": {"box": 0}}]"#;
    assert_eq!(told(1, "[0, 9]", 0.5, tied), None);
}

/// Whatever it begins with, a scene is remarked on if its capacity is less than all of that, and only then.
#[test]
fn a_capacity_below_the_beginning_is_remarked_on() {
    let sheet = r#"{"sheet": {"corner": [0, 0, 9], "sides": [[1, 0, 0], [0, 0, 1]], "cells": [2, 3]}}"#;
    let cloth = format!(r#""cloths": [{{"form": {sheet}, "mass": 1, "springs": {{"bend": {{"ks": 1}}}}}}]"#);
    let grass = r#""on": {"shape": {"sphere": {"center": [0, 0, -9], "radius": 1}}, "count": 3, "length": 1}"#;
    let folder = Folder::new();
    for begin in [
        r#""particles": [{}, {}, {}]"#,
        &cloth,
        r#""boxes": [{"sides": [1, 1, 1], "mass": 1, "position": [0, 0, 0], "count": [1, 2, 1]}]"#,
        &format!(
            r#""strands": [{{"form": {{{grass}}}, "segments": 4, "radius": 1e-3, "young": 1e6, "density": 1000}}]"#
        ),
        r#""ropes": [{"curve": [[0, 0, 0], [1, 0, 0]], "segments": 5, "weight": 1}]"#,
        r#""soft_bodies": [{"form": {"box": [1, 1, 1]}, "spacing": 0.5, "density": 100, "frequency": 5, "position": [0, 0, 0]}]"#,
    ] {
        folder.write("a.json", format!("{{{begin}}}"));
        let live = folder.report("a.json --steps 0")["live"].as_u64().expect("a number");
        for (capacity, is_odd) in [(live - 1, true), (live, false), (live + 1, false)] {
            folder.write("a.json", format!(r#"{{"run": {{"capacity": {capacity}}}, {begin}}}"#));
            let answer = folder.run("run a.json --steps 0 --report json");
            let said = format!("a.json:run.capacity: {capacity} is less than the {live} particles that the scene");
            assert_eq!(answer.report()["live"], live, "{begin}");
            assert_eq!(
                answer.warnings().iter().filter(|line| line.starts_with(&said)).count(),
                usize::from(is_odd),
                "{answer:?}"
            );
            assert_eq!(answer.warnings().len(), usize::from(is_odd), "{answer:?}");
        }
    }
}

#[test]
fn scn_that_is_hardly_meant_is_remarked_on_where_it_stands() {
    let text = "\nparticle 0 0 0 0 0 0 1 0 0 1.5 0 -1\n particle_source 1 0 0 -1 0 -1  1 1 4  sphere 0 0 0 1\n\
                particle_spring 0 0 1 -1 -2";
    let folder = Folder::with("a.scn", text);
    warned(
        &folder,
        "a.scn",
        &[
            "a.scn:2:1: particle: elasticity: 1.5 is above 1",
            "a.scn:3:2: particle_source: elasticity: -1 is below 0",
            "a.scn:4:1: particle_spring: ends: the spring joins particle 0 to itself",
            "a.scn:4:1: particle_spring: ks: -1 is below 0",
            "a.scn:4:1: particle_spring: kd: -2 is below 0",
        ],
    );
}

#[test]
fn unknown_commands_are_skipped_on_request_and_counted() {
    let text =
        format!("player 0 1 2\n   jump 5\n  # box\n\n  7 particle 8\nenemy 3 sphere\n{ONE}boss\n  {ONE}player 1");
    let folder = Folder::with("a.scn", &text);
    for args in ["run a.scn --steps 1", "check a.scn", "convert a.scn o.json", "lab a.scn", "compare --scene a.scn"] {
        let error = folder.run(args).error().to_string();
        assert!(
            error.starts_with("a.scn:1:1: unknown command 'player'") && error.contains("--skip-unknown"),
            "{error}"
        );
    }
    let expected = [
        "a.scn: 4 unknown commands passed over",
        "a.scn:1:1: unknown command 'player' is passed over",
        "a.scn:6:1: unknown command 'enemy' is passed over",
        "a.scn:8:1: unknown command 'boss' is passed over",
        "a.scn:10:1: unknown command 'player' is passed over",
    ];
    for args in [
        "run a.scn --steps 1 --report json",
        "render a.scn --duration 0 --size 8x8 --out o.png",
        "check a.scn",
        "convert a.scn o.json",
        "compare --scene a.scn --at 0 --n 2 --repeat 1 --structures kd",
    ] {
        let answer = folder.run(&format!("{args} --skip-unknown"));
        assert_eq!(answer.warnings(), expected, "{args}");
        if args.starts_with("run") {
            assert_eq!(answer.report()["live"], 2);
        }
    }
    // In an included file too, with its name.
    folder.write("in/b.scn", "ambient 0 0 0\ncoin 3");
    folder.write("b.scn", "include in/b.scn");
    assert!(
        folder
            .run("run b.scn --steps 1 --skip-unknown")
            .warnings()
            .contains(&"in/b.scn:2:1: unknown command 'coin' is passed over")
    );
    // A shape that is unknown is an error all the same.
    folder.write("c.scn", "particle_sink 1 1 1 1 torus 0 0 0 1");
    folder.run("run c.scn --skip-unknown").error();
}

#[test]
fn a_file_in_other_letters_is_suggested() {
    let folder = Folder::with("cube.off", TRIANGLE);
    folder.write("Parts/Cube.OFF", TRIANGLE);
    for (text, meant) in [
        ("mesh -1 Cube.off", "; did you mean cube.off?"),
        ("particle_sink 1 1 0 0 mesh CUBE.OFF", "; did you mean cube.off?"),
        ("mesh -1 parts/cube.off", "; did you mean Parts/Cube.OFF?"),
        ("include A.SCN", "; did you mean a.scn?"),
    ] {
        folder.write("a.scn", text);
        let answer = folder.run("run a.scn --steps 1");
        assert!(answer.error().ends_with(meant), "{text}: {answer:?}");
    }
    folder.write("a.json", r#"{"scenery": [{"shape": {"mesh": "Cube.off"}}]}"#);
    for (args, meant) in [
        ("run a.json --steps 1", "; did you mean cube.off? (line 1)"),
        ("run A.json", "; did you mean a.json?"),
        ("check Parts/../A.json", "; did you mean a.json?"),
        ("compare --mesh CUBE.off --repeat 1", "; did you mean cube.off?"),
    ] {
        assert!(folder.run(args).error().ends_with(meant), "{args}: {:?}", folder.run(args));
    }
    folder.write("a.scn", "mesh -1 cub.off");
    assert!(!folder.run("run a.scn").error().contains("did you mean"));
}

#[test]
fn what_is_called_like_no_scene_is_none() {
    let folder = Folder::with("README.md", ONE);
    folder.write("scene", "{}");
    for args in
        ["run README.md", "check README.md", "render scene --out o.gif", "convert scene o.json", "lab README.md"]
    {
        let answer = folder.run(args);
        assert!(answer.error().contains("expected a scene, whose name ends in .json or .scn"), "{args}: {answer:?}");
    }
    if cfg!(unix) {
        // What comes through a pipe has no name.
        folder.write("a.json", r#"{"particles": [{}]}"#);
        folder.write("a.scn", ONE);
        for name in ["a.json", "a.scn"] {
            folder.shell(&format!("cat {name} | $POINTMASS run /dev/stdin --steps 1")).fine();
        }
    }
}

#[test]
fn no_name_reaches_a_terminal_with_codes_in_it() {
    let folder = Folder::new();
    for odd in ["a\u{1b}[31m", "b\u{9b}31m", "c\u{7}\r", "d\u{202e}"] {
        folder.write(&format!("{odd}.json"), r#"{"particles": [{"elasticity": 2}, {"position": [1, 0, 0]}]}"#);
        folder.write(&format!("{odd}.csv"), "x,y,z\n1,2,3\n4,5,6\n");
        let scene = format!("{odd}.json");
        for args in [
            &["run", &scene, "--steps", "1"][..],
            &["run", &scene, "--steps", "1", "--report", "json"],
            &["check", &scene],
            &["check", &scene, "--report", "json"],
            &["run", &format!("{odd}.off")],
            &["run", &format!("no{scene}")],
            &["run", &scene, "--out", odd],
            &["render", &scene, "--out", odd],
            &["compare", "--points", &format!("{odd}.csv"), "--repeat", "1", "--structures", "kd"],
            &["compare", "--scene", &scene, "--at", "0", "--repeat", "1", "--structures", "kd"],
            &["lab", &scene, "--duration", "0.1", "--integrators", "verlet"],
            &["lab", odd],
        ] {
            let answer = folder.run_with(args);
            let said = answer.stdout.clone() + &answer.stderr;
            let codes = |c: &char| c.is_control() && *c != '\n' || *c == '\u{202e}';
            assert!(!said.is_empty() && said.chars().find(codes).is_none(), "{args:?}: {said:?}");
            if args.contains(&"json") {
                assert_eq!(answer.report()["scene"], *scene, "{said}");
            }
        }
    }
}
