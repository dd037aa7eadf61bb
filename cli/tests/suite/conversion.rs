//! `convert`: nothing is lost that both formats can say, and files are found from wherever the scene now lies.

use crate::course;
use crate::scenes::{BUSY, TRIANGLE};
use crate::scn::EVERYTHING;
use crate::tool::Folder;
use pointmass::scene::{SceneFile, schema};
use serde_json::{Value, json};
use std::collections::BTreeSet;

/// A scene of several files and folders.
fn spread() -> Folder {
    let folder = Folder::with("in/root.scn", format!("{BUSY} include sub/part.scn mesh 0 meshes/a.off"));
    folder
        .write("in/sub/part.scn", "begin -1 1 0 0 3 0 1 0 0 0 0 1 0 0 0 0 1 mesh -1 own.off mesh -1 ../../far.off end");
    for mesh in ["in/meshes/a.off", "in/sub/own.off", "far.off"] {
        folder.write(mesh, TRIANGLE);
    }
    for name in ["o/keep", "o/p/q/keep", "in/sub/keep"] {
        folder.write(name, "");
    }
    folder
}

#[test]
fn a_scene_runs_the_same_in_either_format_from_any_folder() {
    let folder = spread();
    let run = folder.run("run in/root.scn --steps 60 --report json");
    assert_eq!(run.warnings().len(), 1, "the include: {run:?}");
    let hash = run.report()["hash"].as_str().expect("a hash").to_string();
    for (from, to) in [
        ("in/root.scn", "a.json"),
        ("in/root.scn", "in/a.json"),
        ("in/root.scn", "in/sub/a.json"),
        ("in/root.scn", "o/p/q/a.json"),
        ("o/p/q/a.json", "o/a.scn"),
        ("o/a.scn", "in/sub/b.scn"),
        ("in/sub/b.scn", "b.json"),
        ("b.json", "o/p/b.json"),
        ("./o/../in/../o/p/b.json", "in/meshes/c.scn"),
    ] {
        let warnings = usize::from(from == "in/root.scn");
        assert_eq!(folder.run(&format!("convert {from} {to}")).warnings().len(), warnings, "{from} {to}");
        assert_eq!(folder.hash(&format!("{to} --steps 60")), hash, "{from} {to}");
    }
}

#[test]
fn names_are_relative_to_the_output_and_no_longer_than_they_have_to_be() {
    let folder = spread();
    for (from, to) in [("in/root.scn", "o/p/q/a.json"), ("o/p/q/a.json", "o/a.scn"), ("o/a.scn", "in/sub/a.json")] {
        folder.run(&format!("convert {from} {to}")).warnings();
    }
    // What a scene came by does not matter to it.
    std::fs::remove_dir_all(folder.path("o/p")).expect("a folder of ours");
    let names = |name: &str| {
        let text = folder.read(name);
        text.split_whitespace().filter(|w| w.contains(".off")).map(|w| w.trim_matches(['"', ',']).to_string()).collect()
    };
    let expected: Vec<String> = ["../in/sub/own.off", "../far.off", "../in/meshes/a.off"].map(str::to_string).into();
    let found: Vec<String> = names("o/a.scn");
    assert_eq!(found, expected);
    let found: Vec<String> = names("in/sub/a.json");
    assert_eq!(found, ["own.off", "../../far.off", "../meshes/a.off"]);
}

#[test]
fn every_name_of_a_file_leads_there_from_the_new_folder() {
    let mesh = r#"{"mesh": "m.off"}"#;
    let strand = r#""segments": 2, "radius": 1e-4, "young": 1e9, "density": 1000"#;
    let body = r#""sides": [1, 1, 1], "mass": 1, "position": [0, 0, 0]"#;
    let soft = r#""spacing": 0.5, "density": 1000, "frequency": 5, "position": [0, 0, 0]"#;
    let scene = format!(
        r#"{{"$schema": "m.json", "emitters": [{{"shape": {mesh}}}], "scenery": [{{"shape": {mesh}}}],
        "sinks": [{{"shape": {mesh}, "intensity": 1, "ca": 1, "la": 0, "qa": 0}}], "goals": [{{"shape": {mesh}, "arrive": 1}}],
        "cloths": [{{"form": {mesh}, "mass": 1, "springs": {{"bend": {{"ks": 1}}}}}}], "soft_bodies": [{{"form": {mesh}, {soft}}}],
        "boxes": [{{"form": {mesh}, {body}}}, {{"form": {{"solid": {{"mesh": "m.off", "within": 0.1}}}}, {body}}}],
        "strands": [{{"form": {{"on": {{"shape": {mesh}, "count": 1, "length": 1}}}}, {strand}}}],
        "materials": [{{"texture": "m.png", "sprite": {{"picture": "m.png"}}}}, {{"shape": {{"form": {mesh}}}}},
            {{"sprite": {{"picture": "leaf"}}}}]}}"#
    );
    let folder = Folder::with("in/a.json", &scene);
    for name in ["in/m.off", "in/m.png", "in/m.json", "o/keep"] {
        folder.write(name, "");
    }
    folder.run("convert in/a.json o/b.json").fine();
    let moved = scene.replace("\"m.", "\"../in/m.");
    assert_eq!(folder.read("o/b.json"), SceneFile::from_json("", &moved).expect("a scene").to_json());
    folder.run("convert o/b.json in/c.json").fine();
    assert_eq!(folder.read("in/c.json"), SceneFile::from_json("", &scene).expect("a scene").to_json());
}

/// The least values of a schema of which each says one of its texts, with the name of that; and one that says none.
fn telling(root: &Value, schema: &Value) -> (Vec<(String, Value)>, Value) {
    if let Some(name) = schema["$ref"].as_str() {
        return telling(root, root.pointer(&name[1..]).expect("it is there"));
    }
    if let Some(forms) = schema["oneOf"].as_array().or(schema["anyOf"].as_array()) {
        let (texts, mut plain): (Vec<_>, Vec<_>) = forms.iter().map(|form| telling(root, form)).unzip();
        return (texts.concat(), plain.swap_remove(0));
    }
    if let Some(properties) = schema["properties"].as_object() {
        let needed = schema["required"].as_array().into_iter().flatten().filter_map(Value::as_str);
        let plain = needed.map(|name| (name.to_string(), telling(root, &properties[name]).1)).collect();
        let mut texts = Vec::new();
        for (name, property) in properties {
            for (mut what, value) in telling(root, property).0 {
                let mut object = Value::clone(&plain);
                object[name] = value;
                what = if what.is_empty() { name.clone() } else { format!("{name}.{what}") };
                texts.push((what, object));
            }
        }
        return (texts, plain);
    }
    let is =
        |kind: &str| schema["type"] == kind || schema["type"].as_array().is_some_and(|of| of.contains(&kind.into()));
    if is("array") {
        let (texts, plain) = telling(root, &schema["items"]);
        let least = schema["minItems"].as_u64().unwrap_or(0) as usize;
        return (texts.into_iter().map(|(what, one)| (what, json!([one]))).collect(), json!(vec![plain; least]));
    }
    let one_of = [&schema["const"], &schema["enum"][0]].into_iter().find(|value| !value.is_null());
    match one_of {
        Some(value) => (Vec::new(), value.clone()),
        None if is("string") => (vec![(String::new(), json!("mark.png"))], json!("")),
        None if is("boolean") => (Vec::new(), json!(false)),
        None if is("object") => (Vec::new(), json!({})),
        None => (Vec::new(), json!(1)),
    }
}

#[test]
fn every_text_of_a_scene_is_known_to_be_a_file_or_not() {
    let root: Value = serde_json::from_str(&schema()).expect("JSON");
    let mut others = BTreeSet::new();
    let (texts, _) = telling(&root, &root);
    assert!(texts.len() > 15, "{texts:?}");
    for (what, scene) in texts {
        let mut scene = SceneFile::from_json(&what, &scene.to_string()).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(scene.to_json().matches("mark").count(), 1, "{what}");
        scene.file_names_mut().for_each(|name| *name = name.replace("mark", "moved"));
        if scene.to_json().contains("mark") {
            others.insert(what);
        }
    }
    // Whoever adds another has to say what it is: a name of a file belongs to `SceneFile::file_names_mut`.
    assert_eq!(others, ["about", "custom.name", "forces.relaxation.column"].map(String::from).into());
}

#[test]
fn what_is_converted_to_and_fro_is_declared_the_same() {
    // Every source gives birth in time, and within a right angle, lest that be remarked on.
    let scene = EVERYTHING.replace("  4 5 6  sphere", "  4 5 .6  sphere");
    let scene = scene.replace("0 0 0 -1  0 0 0  ", "0 0 0 -1  1e-3 0 0  ").replace("-1  0 -1 0  ", "-1  1e-3 -1 0  ");
    let folder = Folder::with("a.scn", scene.replace("../c.stl", "c.off").replace("b.obj", "b.off"));
    for mesh in ["meshes/a.off", "meshes/b.off", "c.off", "look/wood.png"] {
        folder.write(mesh, TRIANGLE);
    }
    folder.run("convert a.scn a.json").fine();
    folder.run("convert a.json b.scn").fine();
    folder.run("convert b.scn b.json").fine();
    folder.run("convert b.json c.json").fine();
    folder.run("convert b.scn c.scn").fine();
    assert_eq!(folder.read("a.json"), folder.read("b.json"));
    assert_eq!(folder.read("a.json"), folder.read("c.json"));
    assert_eq!(folder.read("b.scn"), folder.read("c.scn"));
    let hashes = ["a.scn", "a.json", "b.scn"].map(|name| folder.hash(&format!("{name} --steps 30")));
    assert!(hashes.iter().all(|hash| *hash == hashes[0]), "{hashes:?}");
    // In place.
    folder.run("convert b.scn b.scn").fine();
    folder.run("convert b.json b.json").fine();
    assert_eq!((folder.read("b.scn"), folder.read("b.json")), (folder.read("c.scn"), folder.read("a.json")));
}

#[test]
fn what_scn_cannot_say_is_warned_of() {
    let sphere = r#""shape": {"sphere": {"center": [0, 0, 0], "radius": 1}}"#;
    let sink = r#""intensity": 1, "ca": 1, "la": 0, "qa": 0"#;
    let triangle = r#""shape": {"triangle": {"corners": [[0,0,0],[1,0,0],[0,1,0]]}}"#;
    let plane = r#""shape": {"plane": {"point": [0, 0, 0], "normal": [0, 1, 0]}}"#;
    let circle = r#""shape": {"circle": {"center": [0, 0, 0], "normal": [0, 1, 0], "radius": 1}}"#;
    let emitter = |rest: &str| format!(r#""emitters": [{{{sphere}, {rest}}}]"#);
    let cases = [
        (r#""about": "a scene""#.to_string(), "about"),
        (r#""about": "a scene\nof two lines\r\nor three\rparticle""#.into(), "about"),
        (r#""run": {"duration": 3}"#.into(), "run"),
        (r#""run": {"dt": 0.001}"#.into(), "run"),
        (r#""run": {"integrator": "euler"}"#.into(), "run"),
        (r#""run": {"seed": 2}"#.into(), "run"),
        (r#""run": {"capacity": 2}"#.into(), "run"),
        (r#""particles": [{"color": [1, 2, 3, 4]}]"#.into(), "particles"),
        (r#""materials": [{"size": 1}]"#.into(), "materials"),
        (r#""materials": [{"glow": 1}]"#.into(), "materials"),
        (emitter(r#""burst": {"count": 1}"#), "emitters[0]"),
        (emitter(r#""start": 1"#), "emitters[0]"),
        (emitter(r#""stop": 1"#), "emitters[0]"),
        (emitter(r#""direction": [0, 1, 0]"#), "emitters[0]"),
        (emitter(r#""velocity": [0, 1, 0]"#), "emitters[0]"),
        (emitter(r#""spread": {"uniform": 1}"#), "emitters[0]"),
        (emitter(r#""color": [1, 2, 3, 4]"#), "emitters[0]"),
        (emitter(r#""color_half_width": [1, 2, 3, 4]"#), "emitters[0]"),
        (emitter(r#""speed": {"mean": 1, "half_width": 1}"#), "emitters[0]"),
        (emitter(r#""mass": {"mean": 2, "half_width": 1}"#), "emitters[0]"),
        (emitter(r#""lifetime": {"mean": 2, "half_width": 1}"#), "emitters[0]"),
        (format!(r#""emitters": [{{{triangle}}}]"#), "emitters[0]"),
        (format!(r#""sinks": [{{{triangle}, {sink}}}]"#), "sinks[0]"),
        (format!(r#""sinks": [{{{plane}, {sink}}}]"#), "sinks[0]"),
        (format!(r#""scenery": [{{{plane}}}]"#), "scenery[0]"),
        (format!(r#""scenery": [{{{circle}}}]"#), "scenery[0]"),
        (r#""reapers": [{"chance": {"rate": 1}}]"#.into(), "reapers"),
        (r#""forces": []"#.into(), "forces"),
        (r#""forces": [{"drag": {}}]"#.into(), "forces"),
        (r#""forces": [{"mutual_gravity": {}}]"#.into(), "forces"),
        (r#""forces": [{"drag": {}}, {"mutual_gravity": {"softening": 1}}]"#.into(), "forces"),
        (r#""forces": [{"drag": {}}, {"mutual_gravity": {"constant": 1}}]"#.into(), "forces"),
        (r#""forces": [{"drag": {}}, {"drag": {}}, {"mutual_gravity": {}}]"#.into(), "forces"),
        (r#""$schema": "scene.schema.json""#.into(), "$schema"),
    ];
    let always = r#""forces": [{"drag": {}}, {"mutual_gravity": {}}]"#;
    let folder = Folder::new();
    let complete =
        |text: &str| if text.contains("forces") { format!("{{{text}}}") } else { format!("{{{always}, {text}}}") };
    for (text, about) in cases {
        folder.write("a.json", complete(&text));
        let answer = folder.run("convert a.json a.scn");
        let warnings = answer.warnings();
        assert!(!warnings.is_empty() && warnings.iter().all(|w| w.starts_with(about)), "{text}: {warnings:?}");
        // What is left can be read, and holds nothing new.
        folder.run("convert a.scn b.json").fine();
        let back = SceneFile::from_json("b.json", &folder.read("b.json")).expect("a scene");
        assert!(back.particles.len() <= 1 && back.emitters.len() <= 1, "{text}");
    }
    for text in [
        r#""particles": [{}]"#.to_string(),
        format!(r#""scenery": [{{{triangle}}}, {{{sphere}}}]"#),
        emitter(r#""speed": 3"#),
    ] {
        folder.write("a.json", complete(&text));
        folder.run("convert a.json a.scn").fine();
    }
}

#[test]
fn every_thing_left_out_has_a_warning_of_its_own() {
    let emitter = |rest: &str| format!(r#"{{"shape": {{"sphere": {{"center": [0, 0, 0], "radius": 1}}}}, {rest}}}"#);
    let emitters = [
        r#""burst": {"count": 1}, "speed": {"mean": 1, "half_width": 1}"#,
        r#""direction": [0, 1, 0], "color": [1, 2, 3, 4]"#,
        r#""spread": {"uniform": 1}"#,
    ]
    .map(emitter)
    .join(", ");
    let folder = Folder::with(
        "a.json",
        format!(r#"{{"about": "x", "run": {{"seed": 3}}, "forces": [], "emitters": [{emitters}]}}"#),
    );
    let answer = folder.run("convert a.json a.scn");
    let warnings = answer.warnings();
    // Forces: no drag and no attraction; emitters: two, two and one.
    assert_eq!(warnings.len(), 9, "{warnings:#?}");
}

#[test]
fn the_course_is_converted_without_loss() {
    let folder = Folder::new();
    let Some(scenes) = course::copy_into(&folder, "in") else { return };
    folder.write("o/keep", "");
    for scene in scenes {
        let run = "--steps 40 --dt 0.02";
        folder.run(&format!("convert in/{scene}.scn o/{scene}.json")).fine();
        folder.run(&format!("convert o/{scene}.json o/{scene}.scn")).fine();
        folder.run(&format!("convert o/{scene}.scn o/{scene}2.json")).fine();
        assert_eq!(folder.read(&format!("o/{scene}.json")), folder.read(&format!("o/{scene}2.json")), "{scene}");
        let hash = folder.hash(&format!("in/{scene}.scn {run}"));
        for twin in [format!("o/{scene}.json"), format!("o/{scene}.scn")] {
            assert_eq!(folder.hash(&format!("{twin} {run}")), hash, "{twin}");
        }
    }
}
