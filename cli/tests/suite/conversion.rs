//! `convert`: nothing is lost that both formats can say, and files are found from wherever the scene now lies.

use crate::course;
use crate::scenes::{BUSY, TRIANGLE};
use crate::scn::EVERYTHING;
use crate::tool::Folder;
use pointmass::scene::SceneFile;

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
fn what_is_converted_to_and_fro_is_declared_the_same() {
    let folder = Folder::with("a.scn", EVERYTHING.replace("../c.stl", "c.off").replace("b.obj", "b.off"));
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
