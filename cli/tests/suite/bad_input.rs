//! Scenes and meshes that cannot be used: one line that names file and place, exit code 1, nothing written.

use crate::scenes::{ONE, TRIANGLE};
use crate::tool::Folder;
use std::fs::{self, File};

/// A scene that nobody can use, and how the error about it begins.
struct Bad<'a> {
    text: &'a [u8],
    error: &'a str,
}

const fn bad<'a>(text: &'a str, error: &'a str) -> Bad<'a> {
    Bad { text: text.as_bytes(), error }
}

/// Every command refuses the scene `name`, says `error` first, and leaves the folder as it was.
#[track_caller]
fn refused(folder: &Folder, name: &str, error: &str) {
    refused_by(folder, name, error, &["run", "render", "convert", "check"]);
}

#[track_caller]
pub(crate) fn refused_by(folder: &Folder, name: &str, error: &str, commands: &[&str]) {
    folder.write("old.csv", "old");
    let before = folder.names();
    for command in commands {
        let rest = match *command {
            "run" => "--steps 1 --out old.csv --out o.jsonl --out o.ply --out o.xyz",
            "render" => "--duration 0 --size 8x8 --out o.gif",
            "check" => "--plot o.svg",
            _ if name.ends_with("json") => "o.scn",
            _ => "o.json",
        };
        let answer = folder.run(&format!("{command} {name} {rest}"));
        let said = answer.error();
        assert!(said.starts_with(error), "{command}: said\n{said}\nnot\n{error}");
        assert_eq!(folder.names(), before, "{command}: {said}");
        assert_eq!(folder.read("old.csv"), "old", "{command}");
    }
}

#[test]
fn scn_that_is_wrong() {
    let identity = "1 0 0 0  0 1 0 0  0 0 1 0  0 0 0 1";
    let begin = format!("begin -1 {identity}\n");
    let (unclosed, twice) = (format!("\n  {begin}{begin}end"), format!("{begin}end end"));
    let flat = "begin -1  1 0 0 0  0 0 0 0  0 0 1 0  0 0 0 1  end";
    let projective = "begin -1  1 0 0 0  0 1 0 0  0 0 1 0  0 0 1 1  end";
    let no_material = format!("begin 0 {identity} end");
    let particles = format!("{ONE}{ONE}");
    let spring = |ends: &str| format!("{particles}particle_spring {ends} 1 1 1");
    let (too_far, negative, half) = (spring("0 2"), spring("-1 0"), spring("0.5 0"));
    let early = format!("particle_spring 0 1 1 1 1 {ONE}");
    let late = format!("box 0 0 0 0 1 1 1\nmaterial {} 1 1 0", "0 ".repeat(15));
    let cases = [
        bad("frobnicate", "a.scn:1:1: unknown command 'frobnicate'"),
        bad("ambient 0 0 0\n\n  wind 1 2 3", "a.scn:3:3: unknown command 'wind'"),
        bad("Particle 0 0 0", "a.scn:1:1: unknown command 'Particle'"),
        bad("{}", "a.scn:1:1: unknown command '{}'"),
        bad("particle 0 0 0 0 0", "a.scn:1:19: particle: "),
        bad("particle", "a.scn:1:9: particle: "),
        bad("\r\nparticle 0 nan 0  0 0 0  1 0 0 0 0 -1", "a.scn:2:12: particle: "),
        bad("particle 0 0 -inf  0 0 0  1 0 0 0 0 -1", "a.scn:1:14: particle: "),
        bad("particle 0 0 0  0 0 infinity  1 0 0 0 0 -1", "a.scn:1:21: particle: "),
        bad("particle 0 0 0  0 1e39 0  1 0 0 0 0 -1", "a.scn:1:19: particle: "),
        bad("particle 0 0 0  0 0 0  -1e400 0 0 0 0 -1", "a.scn:1:24: particle: "),
        bad("particle 0 0 0  0 0 0  1,5 0 0 0 0 -1", "a.scn:1:24: particle: "),
        bad("particle 0 0 0  0 0 0  0x1p3 0 0 0 0 -1", "a.scn:1:24: particle: "),
        bad("particle 0 0 0  0 0 0  0 0 0 0 0 -1", "a.scn:1:24: particle: "),
        bad("particle 0 0 0  0 0 0  -2 0 0 0 0 -1", "a.scn:1:24: particle: "),
        bad("particle 0 0 0  0 0 0  -2 1 0 0 0 -1", "a.scn:1:24: particle: "),
        bad("particle 0 0 0  0 0 0  1 yes 0 0 0 -1", "a.scn:1:26: particle: "),
        bad("particle 0 0 0  0 0 0  1 0 0 0 0 0", "a.scn:1:34: particle: "),
        bad("particle 0 0 0  0 0 0  1 0 0 0 0 -2", "a.scn:1:34: particle: "),
        bad("particle 0 0 0  0 0 0  1 0 0 0 0 99999999999999999999", "a.scn:1:34: particle: "),
        bad("particle_gravity 0 1e39 0", "a.scn:1:20: particle_gravity: "),
        bad("particle_source -1 0 0 0 0 -1  1 1 1  sphere 0 0 0 1", "a.scn:1:17: particle_source: "),
        bad("particle_source 1 0 0 0 0 -1  -1 1 1  sphere 0 0 0 1", "a.scn:1:31: particle_source: "),
        bad("particle_source 1 0 0 0 0 3  1 1 1  sphere 0 0 0 1", "a.scn:1:27: particle_source: "),
        bad("particle_source 1 0 0 0 0 -1  1 1 1  torus 0 0 0 1", "a.scn:1:38: particle_source: "),
        bad("particle_source 1 0 0 0 0 -1  1 1 1  sphere 0 0 0 -1", "a.scn:1:51: particle_source: "),
        bad("particle_source 1 0 0 0 0 -1  1 1 1  circle 0 0 0  0 0 0 1", "a.scn:1:52: particle_source: "),
        bad("particle_source 1 0 0 0 0 -1  1 1 1  mesh no.off", "a.scn:1:1: particle_source: "),
        bad("particle_source 1 0 0 0 0 -1  1 1 1", "a.scn:1:36: particle_source: "),
        bad("particle_sink 1 1 0 nan  sphere 0 0 0 1", "a.scn:1:21: particle_sink: "),
        bad("particle_sink 1 1 0 0  cone 0 0 0 1 -1", "a.scn:1:37: particle_sink: "),
        bad(&too_far, "a.scn:3:19: particle_spring: "),
        bad(&negative, "a.scn:3:17: particle_spring: "),
        bad(&half, "a.scn:3:17: particle_spring: "),
        bad(&early, "a.scn:1:19: particle_spring: "),
        bad("box 0 0 0 0 1 1 1", "a.scn:1:5: box: "),
        bad(&late, "a.scn:1:5: box: "),
        bad("sphere -1 0 0 0 -1", "a.scn:1:17: sphere: "),
        bad("mesh -1 no.off", "a.scn:1:1: mesh: "),
        bad("mesh -1 ", "a.scn:1:9: mesh: "),
        bad("circle -1 0 0 0 0 1 0 1", "a.scn:1:1: unknown command 'circle'"),
        bad("end", "a.scn:1:1: end: "),
        bad(&twice, "a.scn:2:5: end: "),
        bad(&unclosed, "a.scn:2:3: begin: "),
        bad(flat, "a.scn:1:1: begin: "),
        bad(projective, "a.scn:1:1: begin: "),
        bad(&no_material, "a.scn:1:7: begin: "),
        bad("include no.scn", "a.scn:1:1: include: "),
        bad("include", "a.scn:1:8: include: "),
        bad("camera 0 0 0", "a.scn:1:13: camera: "),
        bad("particle_gravity 0 \0 0", "a.scn:1:20: particle_gravity: "),
        Bad { text: b"ambient 0 0 0\nbackground \xff 0 0", error: "a.scn:2: " },
        Bad { text: b"\xff\xfea\0m\0", error: "a.scn:1: " },
    ];
    let folder = Folder::new();
    for Bad { text, error } in cases {
        folder.write("a.scn", text);
        refused(&folder, "a.scn", error);
    }
}

#[test]
fn json_that_is_wrong() {
    let sphere = r#""shape": {"sphere": {"center": [0, 0, 0], "radius": 1}}"#;
    let emitter = |rest: &str| {
        let born = if rest.contains("rate") || rest.contains("burst") { "" } else { r#""rate": 1, "# };
        format!(r#"{{"emitters": [{{{sphere}, {born}{rest}}}]}}"#)
    };
    let emitters = [
        ("\"rate\": -1", "a.json:emitters[0].rate: "),
        ("\"burst\": {\"count\": 1, \"every\": -1}", "a.json:emitters[0].burst.every: "),
        ("\"rate\": \"fast\"", "a.json:1:"),
        ("\"wind\": 1", "a.json:1:"),
        ("\"speed\": null", "a.json:1:"),
        ("\"speed\": {\"mean\": 1, \"half_width\": 1e39}", "a.json:"),
        ("\"mass\": 0", "a.json:emitters[0].mass: "),
        ("\"mass\": {\"mean\": 1, \"half_width\": 1}", "a.json:emitters[0].mass: "),
        ("\"material\": 0", "a.json:emitters[0].material: "),
        ("\"material\": -1", "a.json:1:"),
        ("\"direction\": [0, 0, 0]", "a.json:emitters[0].direction: "),
        ("\"spread\": {\"normal\": 1}", "a.json:1:"),
        ("\"color\": [256, 0, 0, 0]", "a.json:1:"),
    ]
    .map(|(rest, error)| (emitter(rest), error));
    let matrix = |last: &str| format!(r#"{{"groups": [{{"matrix": [[1,0,0,0],[0,1,0,0],[0,0,1,0],{last}]}}]}}"#);
    let deep = "[".repeat(100_000);
    let (deep, deep_number) = (format!("{{\"about\": {deep}"), emitter(&format!("\"speed\": {deep}")));
    let others = [
        (String::new(), "a.json: there is nothing in it"),
        ("   \n".into(), "a.json:"),
        ("{".into(), "a.json:1:1: "),
        ("{}}".into(), "a.json:1:3: "),
        ("null".into(), "a.json:1:4: a scene is an object, not null"),
        ("7".into(), "a.json:1:1: a scene is an object, not integer `7`"),
        ("\"a scene\"".into(), "a.json:1:"),
        ("particle_gravity 0 0 0".into(), "a.json:1:1: "),
        (r#"{"wind": 1}"#.into(), "a.json:1:7: unknown field `wind`"),
        ("{\n \"particles\": [{\"mas\": 1}]}".into(), "a.json:2:21: unknown field `mas`"),
        (r#"{"particles": {}}"#.into(), "a.json:1:"),
        (r#"{"particles": [], "particles": []}"#.into(), "a.json:1:"),
        (r#"{"particles": [{"mass": NaN}]}"#.into(), "a.json:1:"),
        (r#"{"particles": [{"mass": 1e39}]}"#.into(), "a.json:"),
        (r#"{"particles": [{"mass": 1e400}]}"#.into(), "a.json:"),
        (r#"{"particles": [{"mass": "1"}]}"#.into(), "a.json:1:"),
        (
            r#"{"particles": [{}, {"mass": -1}]}"#.into(),
            "a.json:particles[1].mass: has to be above zero (3e-39 kg at least) unless",
        ),
        (
            r#"{"particles": [{"mass": 0}]}"#.into(),
            "a.json:particles[0].mass: has to be above zero (3e-39 kg at least) unless",
        ),
        (
            r#"{"particles": [{"mass": 1e-39}]}"#.into(),
            "a.json:particles[0].mass: has to be above zero (3e-39 kg at least) unless",
        ),
        (
            r#"{"particles": [{"mass": -1, "fixed": true}]}"#.into(),
            "a.json:particles[0].mass: has to be zero or more, not -1",
        ),
        (r#"{"particles": [{"position": [1, 2]}]}"#.into(), "a.json:1:"),
        (
            r#"{"particles": [{"position": [1, 2, 3, 4]}]}"#.into(),
            "a.json:1:39: this goes on where it has to end: the list before has all the entries",
        ),
        (r#"{"particles": [{"fixed": 1}]}"#.into(), "a.json:1:"),
        (r#"{"particles": [{"material": 0}]}"#.into(), "a.json:particles[0].material: "),
        (
            r#"{"particles": [{}], "springs": [{"ends": [0, 1], "rest_length": 1, "ks": 1, "kd": 1}]}"#.into(),
            "a.json:springs[0]: ",
        ),
        (r#"{"scenery": [{"shape": {"torus": {}}}]}"#.into(), "a.json:1:"),
        (
            r#"{"scenery": [{"shape": {"plane": {"point": [0,0,0], "normal": [0,0,0]}}}]}"#.into(),
            "a.json:scenery[0].shape: ",
        ),
        (
            r#"{"scenery": [{"shape": {"sphere": {"center": [0,0,0], "radius": -1}}}]}"#.into(),
            "a.json:scenery[0].shape: ",
        ),
        (
            r#"{"scenery": [{"shape": {"sphere": {"center": [0,0,0], "radius": 1}}, "group": 0}]}"#.into(),
            "a.json:scenery[0].group: ",
        ),
        (matrix("[0,0,0,0]"), "a.json:groups[0].matrix: "),
        (matrix("[0,0,1,1]"), "a.json:groups[0].matrix: "),
        (matrix("[0,0,0,1]").replace("1]]", "1]], \"parent\": 0"), "a.json:groups[0].parent: "),
        (r#"{"run": {"dt": 0}}"#.into(), "a.json:run.dt: "),
        (r#"{"run": {"dt": -1}}"#.into(), "a.json:run.dt: "),
        (r#"{"run": {"duration": -1}}"#.into(), "a.json:run.duration: "),
        (r#"{"run": {"duration": 1e300}}"#.into(), "a.json:run.duration: "),
        (r#"{"run": {"integrator": "leapfrog"}}"#.into(), "a.json:1:"),
        (r#"{"run": {"seed": -1}}"#.into(), "a.json:1:"),
        (r#"{"run": {"capacity": 4294967296}}"#.into(), "a.json:1:"),
        (r#"{"camera": {"eye": [0, 0, 1e39]}}"#.into(), "a.json:"),
        (r#"{"lights": [{"laser": {}}]}"#.into(), "a.json:1:"),
        ("{\"about\": \"two\nlines\"}".into(), "a.json:"),
        ("{\"about\": \"\\ud800\"}".into(), "a.json:1:"),
        ("{}\0".into(), "a.json:1:3: "),
        (deep, "a.json:1:"),
        (deep_number, "a.json:1:"),
    ];
    let folder = Folder::new();
    for (text, error) in emitters.iter().chain(&others) {
        folder.write("a.json", text);
        refused(&folder, "a.json", error);
    }
    folder.write("a.json", b"{\"about\":\n \"\xff\"}");
    refused(&folder, "a.json", "a.json:2: ");
}

#[test]
fn springs_fabrics_and_forces_that_are_wrong() {
    let run = |rest: &str| format!(r#"{{"run": {{{rest}}}}}"#);
    let spring = |rest: &str| {
        format!(r#"{{"particles": [{{}}, {{}}], "springs": [{{"ends": [0, 1], "rest_length": 1, {rest}}}]}}"#)
    };
    let cloth = |form: &str, threads: &str, rest: &str| {
        format!(r#"{{"cloths": [{{"form": {form}, "springs": {{{threads}}}, "mass": {rest}}}]}}"#)
    };
    let sheet = |cells: &str| {
        format!(r#"{{"sheet": {{"corner": [0, 0, 0], "sides": [[1, 0, 0], [0, 0, 1]], "cells": {cells}}}}}"#)
    };
    let (two, soft) = (sheet("[2, 2]"), r#""structural": {"ks": 1}"#);
    let far = two.replace("[1, 0, 0]", "[3e38, 0, 0]").replace("\"corner\": [0", "\"corner\": [3e38");
    let thin = two.replace("[0, 0, 1]", "[2, 0, 0]");
    let force = |force: &str| format!(r#"{{"particles": [{{}}], "forces": [{{{force}}}]}}"#);
    let cases = [
        (run(r#""dt": 1e30"#), "a.json:run.dt: has to be from 1e-9 s to below 2^31 s, not 1e30 s"),
        (run(r#""duration": 1e30"#), "a.json:run.duration: has to be from zero to below 2^31 s, not 1e30 s"),
        (run(r#""tuning": {"inner": "adaptive"}"#), "a.json:run.tuning.inner: has to be a method that takes steps"),
        (run(r#""tuning": {"tolerance": 0}"#), "a.json:run.tuning.tolerance: has to be above zero, not 0"),
        (spring(r#""ks": null"#), "a.json:1:81: springs[0].ks: invalid type: null, expected a number"),
        (spring(r#""ks": 1e39"#), "a.json:1:81: springs[0].ks: number out of range: the largest is 3.4e38"),
        (spring(r#""ks": 1, "breaks_at": 0.5"#), "a.json:springs[0].breaks_at: has to be above one, a length over"),
        (cloth(&two, "", "1"), "a.json:cloths[0].springs: has to name structural, shear or bend springs"),
        (cloth(&two, r#""bend": {"ks": -2}"#, "1"), "a.json:cloths[0].springs.bend.ks: has to be zero or more, not -2"),
        (cloth(&two, soft, "-1"), "a.json:cloths[0].mass: has to be above zero, not -1"),
        (
            cloth(&two, soft, "0"),
            "a.json:cloths[0].mass: is missing, or zero: say it, in kg, or the cloth's density, in kg/m²",
        ),
        (cloth(&two, soft, "1e-38"), "a.json:cloths[0].mass: leaves 1.1"),
        (cloth(&two, soft, r#"1, "gas": {"amount": 1}"#), "a.json:cloths[0].gas: a sheet has no inside"),
        (cloth(&two, soft, r#"1, "fixed": [9]"#), "a.json:cloths[0].fixed: particle 9 is out of range; there are 9,"),
        (cloth(&two, soft, r#"1, "breaks_at": 1"#), "a.json:cloths[0].breaks_at: has to be above one, a length over"),
        (cloth(&far, soft, "1"), "a.json:cloths[0].form: reaches beyond the range of a 32-bit float"),
        (cloth(&thin, soft, "1"), "a.json:cloths[0].form: its sides have to be longer than zero and not parallel"),
        (
            cloth(&sheet("[0, 4]"), soft, r#"0, "density": 1"#),
            "a.json:cloths[0].form.sheet.cells: has to be 1 at least along both sides, not [0, 4]",
        ),
        (
            cloth(&sheet("[4, 0]"), "", r#"1, "shell": {"stretch": [10, 10], "shear": 1}"#),
            "a.json:cloths[0].form.sheet.cells: has to be 1 at least along both sides, not [4, 0]",
        ),
        (cloth(&sheet("[1000000, 1000000]"), soft, "1"), "a.json:cloths[0].form: makes 1000002000001 particles; "),
        (cloth(&sheet("[8000, 8000]"), soft, "1"), "a.json:cloths[0].form: makes 64016001 particles; "),
        (cloth(&sheet("[4294967295, 4294967295]"), soft, "1"), "a.json:cloths[0].form: makes 18446744073709551615 "),
        (force(r#""mutual_gravity": {"softening": -1}"#), "a.json:forces[0].softening: has to be zero or more, not -1"),
        (
            force(r#""mutual_gravity": {"softening": 1e30}"#),
            "a.json:forces[0].softening: has to be 1e18 m at most, not 1e30",
        ),
    ];
    let folder = Folder::new();
    for (text, error) in cases {
        folder.write("a.json", &text);
        refused_by(&folder, "a.json", error, &["run", "render", "check"]);
    }
    // A row of particles that somebody weighs is a cloth, if a narrow one.
    folder.write("a.json", cloth(&sheet("[4, 0]"), soft, "1"));
    assert_eq!(folder.report("a.json --steps 1")["live"], 5);
}

/// A list that is too long is refused where it goes on, and so is what comes after a scene.
#[test]
fn lists_that_go_on_are_refused_where_they_do() {
    for (text, place) in [
        (r#"{"springs": [{"ends": [0, 1, 2]}]}"#, "1:"),
        ("{\"about\": \"ü\",\n \"springs\": [{\"ends\": [0, 1,\n 2]}]}", ""),
        (r#"{"background": [0, 0, 0, 1]}"#, "1:"),
        (r#"{} {}"#, "1:"),
    ] {
        let folder = Folder::with("a.json", text);
        let said = folder.run("run a.json").error().to_string();
        assert!(
            said.contains(&format!("a.json:{place}")) && said.contains("goes on where it has to end"),
            "{text}: {said}"
        );
    }
}

#[test]
fn balls_contacts_and_motion_that_are_wrong() {
    let ball = |rest: &str| format!(r#"{{"particles": [{{"radius": 0.1}}], {rest}}}"#);
    let contact = |contact: &str| ball(&format!(r#""materials": [{{"contact": {{{contact}}}}}]"#));
    let sphere = r#""shape": {"sphere": {"center": [9, 0, 0], "radius": 1}}"#;
    let cases = [
        (r#"{"particles": [{"radius": -0.1}]}"#.into(), "a.json:particles[0].radius: has to be zero or more, not -0.1"),
        (
            format!(r#"{{"emitters": [{{{sphere}, "rate": 1, "radius": {{"mean": 1, "half_width": 2}}}}]}}"#),
            "a.json:emitters[0].radius: must not be below zero, the half_width counted in",
        ),
        (
            format!(r#"{{"emitters": [{{{sphere}, "rate": 1, "fixed": true, "mass": -5}}]}}"#),
            "a.json:emitters[0].mass: must not be below zero, the half_width counted in",
        ),
        (
            format!(r#"{{"emitters": [{{{sphere}, "rate": 1, "mass": {{"mean": 3e38, "half_width": 2e38}}}}]}}"#),
            "a.json:emitters[0].mass: 3e38 ± 2e38 goes beyond the range",
        ),
        (
            format!(r#"{{"emitters": [{{{sphere}, "rate": 1, "lifetime": {{"mean": -3e38, "half_width": -2e38}}}}]}}"#),
            "a.json:emitters[0].lifetime: -3e38 ± -2e38 goes beyond",
        ),
        (ball(r#""contacts": "impulse""#), "a.json:1:55: contacts: a name alone, where its settings should follow"),
        (
            ball(r#""contacts": {"glue": {}}"#),
            "a.json:1:52: contacts.glue: unknown variant `glue`, expected one of `impulse`, `force`",
        ),
        (ball(r#""contacts": {"force": {}}"#), "a.json:1:57: contacts.force: missing field `stiffness`"),
        (ball(r#""contacts": {"force": {"stiffness": 0}}"#), "a.json:contacts.force.stiffness: has to be above zero"),
        (
            ball(r#""contacts": {"position": {"substeps": 0}}"#),
            "a.json:contacts.position.substeps: has to be from 1 to",
        ),
        (contact(r#""elasticity": 1.5"#), "a.json:materials[0].contact.elasticity: has to be from 0 to 1, not 1.5"),
        (
            contact(r#""friction": 0.5"#),
            "a.json:1:75: materials[0].contact.friction: invalid type: floating point `0.5`, expected {\"static\": ",
        ),
        (
            contact(r#""friction": {"static": 1, "kinetic": -1}"#),
            "a.json:materials[0].contact.friction.kinetic: has to be zero or more, not -1",
        ),
        (
            ball(&format!(r#""scenery": [{{{sphere}, "motion": {{"axis": [0, 0, 0], "spin": 1}}}}]"#)),
            "a.json:scenery[0].motion: its numbers have to be finite, and its axis to have a direction",
        ),
    ];
    let folder = Folder::new();
    for (text, error) in cases {
        folder.write("a.json", &text);
        refused_by(&folder, "a.json", error, &["run", "render", "check"]);
    }
}

#[test]
fn groups_of_emitters_and_sinks_that_are_wrong() {
    let tilted = "[1, 0, 0, 0], [0, 0.8, -0.6, 0], [0, 0.6, 0.8, 0], [0, 0, 0, 1]";
    let squashed = "[1, 0, 0, 0], [0, 2, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]";
    let sphere = r#"{"sphere": {"center": [9, 0, 0], "radius": 1}}"#;
    let cone = r#"{"cone": {"center": [0, 0, 0], "radius": 1, "height": 1}}"#;
    let scene = |matrix: &str, kind: &str, shape: &str, group: u8| {
        let pull = if kind == "sinks" { r#", "intensity": 1, "ca": 1, "la": 0, "qa": 0"# } else { r#", "rate": 1"# };
        format!(r#"{{"groups": [{{"matrix": [{matrix}]}}], "{kind}": [{{"group": {group}, "shape": {shape}{pull}}}]}}"#)
    };
    let cases = [
        (scene(tilted, "emitters", sphere, 1), "a.json:emitters[0].group: 1 is out of range; there are 1, from 0"),
        (scene(tilted, "sinks", sphere, 7), "a.json:sinks[0].group: 7 is out of range; there are 1, from 0"),
        (
            scene(squashed, "emitters", sphere, 0),
            "a.json:emitters[0].group: its groups squash what is round: put a mesh",
        ),
        (
            scene(tilted, "sinks", cone, 0),
            "a.json:sinks[0].group: its groups tilt or squash what stands upright: put a",
        ),
    ];
    let folder = Folder::new();
    for (text, error) in cases {
        folder.write("a.json", &text);
        refused_by(&folder, "a.json", error, &["run", "render", "check"]);
    }
}

#[test]
fn json_of_the_wrong_type_is_not_taken_for_a_scene() {
    // A list, where there should be an object with names.
    for text in ["[]", "[null]", r#"{"run": 1}"#, r#"{"particles": {}}"#, r#"{"camera": 1}"#] {
        let folder = Folder::with("a.json", text);
        refused(&folder, "a.json", "a.json:1:");
    }
}

/// Gas stays in closed meshes alone whose triangles hang together and are seen from outside.
#[test]
fn gas_is_held_by_closed_meshes() {
    let corners = "0 0 0\n1 0 0\n0 1 0\n0 0 1\n";
    let faces = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
    let off = |corners: &str, faces: &[[usize; 3]]| {
        let lines: String = faces.iter().map(|[a, b, c]| format!("3 {a} {b} {c}\n")).collect();
        format!("OFF\n{} {} 0\n{corners}{lines}", corners.lines().count(), faces.len())
    };
    let turned = faces.map(|[a, b, c]| [a, c, b]);
    let twice: String =
        faces.iter().flatten().map(|&corner| format!("{}\n", corners.lines().nth(corner).unwrap_or(""))).collect();
    let apart = [0, 3, 6, 9].map(|first| [first, first + 1, first + 2]);
    for (mesh, why) in [
        (off(corners, &faces), None),
        (off(corners, &faces[..3]), Some("a triangle is missing there")),
        (off(corners, &turned), Some("inside out")),
        (off(&twice, &apart), Some("12 edges of this mesh have corners of their own")),
    ] {
        let scene = |gas: &str| {
            format!(
                r#"{{"cloths": [{{"form": {{"mesh": "m.off"}}, "mass": 1, "springs": {{"structural": {{"ks": 9}}}}{gas}}}]}}"#
            )
        };
        let folder = Folder::with("m.off", &mesh);
        folder.write("gas.json", scene(r#", "gas": {"amount": 1}"#));
        folder.write("empty.json", scene(""));
        folder.run("run empty.json --steps 1").fine();
        let answer = folder.run("run gas.json --steps 1");
        match why {
            None => drop(answer.fine()),
            Some(why) => {
                let said = answer.error();
                assert!(said.contains("gas.json:cloths[0].gas: needs ") && said.contains(why), "{mesh}: {said}");
            }
        }
    }
}

#[test]
fn an_error_is_one_short_line_whatever_a_name_holds() {
    let long = "a".repeat(100_000);
    for name in ["a\\nb", "a\\r\\nb", "\\u001b[31mred", &long] {
        for text in [
            format!(r#"{{"{name}": 1}}"#),
            format!(r#"{{"run": {{"integrator": "{name}"}}}}"#),
            format!(r#"{{"scenery": [{{"shape": {{"mesh": "{name}.off"}}}}]}}"#),
            format!(r#"{{"scenery": [{{"shape": {{"{name}": 1}}}}]}}"#),
        ] {
            let folder = Folder::with("a.json", &text);
            let answer = folder.run("run a.json --steps 1");
            let said = answer.error();
            assert!(said.len() < 1000 && !said.contains(char::is_control), "{text}: {said:?}");
        }
    }
    for name in ["\u{1b}[31m", &long] {
        for command in ["mesh -1", "include", ""] {
            let folder = Folder::with("a.scn", format!("{command} {name}"));
            let answer = folder.run("run a.scn --steps 1");
            let said = answer.error();
            assert!(said.len() < 1000 && !said.contains(char::is_control), "{command} {name}: {said:?}");
        }
    }
}

#[test]
fn unknown_fields_are_errors_at_every_depth() {
    let sphere = r#""shape": {"sphere": {"center": [0, 0, 0], "radius": 1, "x": 0}}"#;
    let speed = r#""shape": {"mesh": "m.off"}, "speed": {"mean": 1, "half_width": 0, "x": 0}"#;
    let cases = [
        r#"{"run": {"x": 0}}"#.to_string(),
        r#"{"particles": [{"x": 0}]}"#.into(),
        r#"{"springs": [{"ends": [0, 0], "rest_length": 1, "ks": 1, "kd": 1, "x": 0}]}"#.into(),
        format!(r#"{{"emitters": [{{{sphere}}}]}}"#),
        format!(r#"{{"emitters": [{{{speed}}}]}}"#),
        r#"{"emitters": [{"shape": {"mesh": "m.off"}, "burst": {"count": 1, "x": 0}}]}"#.into(),
        r#"{"forces": [{"drag": {"x": 0}}]}"#.into(),
        r#"{"forces": [{"gravity": {"acceleration": [0, 0, 0], "x": 0}}]}"#.into(),
        r#"{"forces": [{"mutual_gravity": {"x": 0}}]}"#.into(),
        r#"{"sinks": [{"shape": {"mesh": "m.off"}, "intensity": 1, "ca": 1, "la": 0, "qa": 0, "x": 0}]}"#.into(),
        r#"{"scenery": [{"shape": {"mesh": "m.off"}, "x": 0}]}"#.into(),
        r#"{"groups": [{"matrix": [[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]], "x": 0}]}"#.into(),
        r#"{"materials": [{"x": 0}]}"#.into(),
        r#"{"lights": [{"directional": {"color": [1,1,1], "direction": [0,0,1], "x": 0}}]}"#.into(),
        r#"{"camera": {"x": 0}}"#.into(),
    ];
    for text in cases {
        let folder = Folder::with("a.json", &text);
        folder.write("m.off", TRIANGLE);
        let answer = folder.run("run a.json --steps 0");
        assert!(answer.code == 1 && answer.error().contains("`x`"), "{text}: {answer:?}");
    }
}

#[test]
fn meshes_that_are_wrong() {
    let folder = Folder::with("scenery.scn", "sphere -1 0 0 0 1\nmesh -1 m.off");
    folder.write("source.scn", "particle_source 1 0 0 0 0 -1  1 1 1  mesh m.off");
    folder.write("sink.scn", "particle_sink 1 1 0 0  mesh m.off");
    folder.write("scenery.json", r#"{"scenery": [{"shape": {"mesh": "m.off"}}]}"#);
    for (mesh, error) in [
        (TRIANGLE.replace("3 0 1 2", "3 0 1 3"), "m.off:6: "),
        (TRIANGLE.replace("3 0 1 2", "3 0 1 -1"), "m.off:6: "),
        (TRIANGLE.replace("3 0 1 2", "3 0 1 4294967296"), "m.off:6: "),
        (TRIANGLE.replace("1 0 0", "1 nan 0"), "m.off:4: "),
        (TRIANGLE.replace("1 0 0", "1 1e39 0"), "m.off:4: "),
        (TRIANGLE.replace("3 0 1 2\n", ""), "m.off:2: "),
        (TRIANGLE.replace("3 1 0", "3 1000000000000 0"), "m.off:2: "),
        (TRIANGLE.replace("OFF", "PLY"), "m.off:1: "),
        (String::new(), "m.off: "),
    ] {
        folder.write("m.off", &mesh);
        for (scene, place) in [
            ("scenery.scn", "scenery.scn:scenery[1].shape: "),
            ("source.scn", "source.scn:emitters[0].shape: "),
            ("sink.scn", "sink.scn:sinks[0].shape: "),
            ("scenery.json", "scenery.json:scenery[0].shape: "),
        ] {
            refused_by(&folder, scene, &format!("{place}{error}"), &["run", "render"]);
        }
    }
    fs::remove_file(folder.path("m.off")).expect("the mesh is there");
    refused(&folder, "scenery.scn", "scenery.scn:2:1: mesh: ");
    refused_by(&folder, "scenery.json", "scenery.json:scenery[0].shape: m.off: ", &["run", "render"]);
    fs::create_dir(folder.path("m.off")).expect("a folder of that name");
    refused(&folder, "scenery.scn", "scenery.scn:2:1: mesh: ");
    refused_by(&folder, "scenery.json", "scenery.json:scenery[0].shape: m.off: ", &["run", "render"]);
    folder.write("other.scn", "mesh -1 other.scn");
    refused_by(&folder, "other.scn", "other.scn:scenery[0].shape: other.scn: ", &["run", "render"]);
}

#[test]
fn includes_that_are_wrong() {
    let folder = Folder::new();
    for name in ["a.scn", "./a.scn", "sub/../a.scn", "sub/.././a.scn", "./././a.scn"] {
        folder.write("sub/keep", "");
        folder.write("a.scn", format!("ambient 0 0 0\n include {name}"));
        refused(&folder, "a.scn", "a.scn:2:2: include: ");
    }
    for (inner, error) in [
        ("include ../a.scn", "sub/b.scn:1:1: include: "),
        ("include .././sub/../a.scn", "sub/b.scn:1:1: include: "),
        ("include b.scn", "sub/b.scn:1:1: include: "),
        ("include ../sub/b.scn", "sub/b.scn:1:1: include: "),
        ("include c.scn", "sub/c.scn:2:1: include: "),
        ("include no.scn", "sub/b.scn:1:1: include: "),
        ("include ../sub", "sub/b.scn:1:1: include: "),
        ("\n frob", "sub/b.scn:2:2: unknown command 'frob'"),
        ("end", "sub/b.scn:1:1: end: "),
        ("begin -1 1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1", "sub/b.scn:1:1: begin: "),
        ("sphere 1 0 0 0 1", "sub/b.scn:1:8: sphere: "),
        ("mesh -1 m.off", "sub/b.scn:1:1: mesh: "),
        ("particle_spring 0 0 1 1 1", "sub/b.scn:1:17: particle_spring: "),
    ] {
        folder.write("a.scn", format!("{ONE}material {} 1 1 0 include sub/b.scn", "0 ".repeat(15)));
        folder.write("sub/b.scn", inner);
        folder.write("sub/c.scn", "\ninclude .././a.scn");
        folder.write("m.off", TRIANGLE);
        refused(&folder, "a.scn", error);
    }
    // The same by the other way to the first file.
    folder.write("sub/b.scn", "include ../a.scn");
    refused(&folder, "./a.scn", "sub/b.scn:1:1: include: ");
    refused(&folder, "sub/../a.scn", "sub/b.scn:1:1: include: ");
    let absolute = folder.path("a.scn");
    refused(
        &folder,
        absolute.to_str().expect("a plain name"),
        folder.path("sub/b.scn").to_str().expect("a plain name"),
    );
    // Two that each include the next twice.
    for i in 0..40 {
        folder.write(&format!("{i}.scn"), format!("include {0}.scn include {0}.scn", i + 1));
    }
    folder.write("40.scn", "");
    refused(&folder, "0.scn", "");
}

#[test]
fn files_that_are_no_scenes() {
    let folder = Folder::new();
    fs::create_dir(folder.path("a.scn")).expect("a folder");
    fs::create_dir(folder.path("a.json")).expect("a folder");
    refused(&folder, "a.scn", "a.scn: ");
    refused(&folder, "a.json", "a.json: ");
    refused(&folder, "no.scn", "no.scn: ");
    refused(&folder, "no/no.json", "no/no.json: ");
    for name in ["big.scn", "big.json", "big.off"] {
        // Only its length is real.
        let file = File::create(folder.path(name)).expect("a file");
        file.set_len((256 << 20) + 1).expect("a sparse file");
    }
    refused(&folder, "big.scn", "big.scn: ");
    refused(&folder, "big.json", "big.json: ");
    folder.write("mesh.scn", "mesh -1 big.off");
    refused_by(&folder, "mesh.scn", "mesh.scn:scenery[0].shape: big.off: ", &["run", "render"]);
    folder.write("include.scn", "\ninclude big.scn");
    refused(&folder, "include.scn", "include.scn:2:1: include: big.scn: ");
    if cfg!(unix) {
        refused(&folder, "/dev/zero", "/dev/zero: ");
    }
}

#[test]
fn what_is_unusual_but_right() {
    let folder = Folder::new();
    // An empty text has no commands, but an empty file is no JSON.
    for text in ["", "\u{feff}", "# nothing", " \r\n\t "] {
        folder.write("a.scn", text);
        assert_eq!(folder.report("a.scn --steps 1")["live"], 0, "{text:?}");
    }
    folder.write("a.scn", "\u{feff}# one\r\nparticle 0 0 0\r\n 0 0 0 # two\r\n 1E-6 +1 .5 5. -0 -1\r\n#three");
    folder.write("a.json", "\u{feff}{\r\n\"particles\": [\r\n{}]\r\n}");
    for name in ["a.scn", "a.json"] {
        assert_eq!(folder.report(&format!("{name} --steps 1"))["live"], 1, "{name}");
    }
}

#[test]
fn groups_may_be_1024_deep() {
    let begin = "begin -1  1 0 0 0.001  0 1 0 0  0 0 1 0  0 0 0 1\n";
    let text = |depth: usize| format!("{}sphere -1 0 0 0 1\n{}{ONE}", begin.repeat(depth), "end\n".repeat(depth));
    let folder = Folder::with("a.scn", text(1024));
    folder.write("o/keep", "");
    let hash = folder.hash("a.scn --steps 5");
    folder.run("convert a.scn o/a.json").fine();
    folder.run("convert o/a.json o/a.scn").fine();
    folder.run("convert o/a.scn o/b.json").fine();
    assert_eq!(folder.read("o/a.json"), folder.read("o/b.json"));
    assert_eq!([folder.hash("o/a.json --steps 5"), folder.hash("o/a.scn --steps 5")], [hash.clone(), hash]);
    folder.write("b.scn", text(1025));
    refused(&folder, "b.scn", "b.scn:1025:1: begin: ");
    // Half of them around an include, half in it.
    folder.write("inner.scn", text(512));
    folder.write("outer.scn", format!("{}include inner.scn {}", begin.repeat(512), "end ".repeat(512)));
    assert_eq!(folder.run("run outer.scn --steps 1").warnings().len(), 1);
    folder.write("inner.scn", text(513));
    refused(&folder, "outer.scn", "inner.scn:513:1: begin: ");
}
