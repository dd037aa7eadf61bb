//! The looks that a scene asks for: what cannot be drawn so is refused, what is hardly meant is remarked on.

use crate::bad_input::refused_by;
use crate::tool::Folder;

const CAMERA: &str = r#""eye": [0, 0, 9], "towards": [0, 0, -1]"#;

#[test]
fn looks_without_a_meaning_are_refused_where_they_stand() {
    let camera = |more: &str| format!(r#"{{"particles": [{{}}], "camera": {{"eye": [0, 0, 9], {more}}}}}"#);
    let material = |more: &str| format!(r#"{{"particles": [{{}}], "materials": [{{}}, {{{more}}}]}}"#);
    let folder = Folder::new();
    for (text, error) in [
        (camera(r#""towards": [0, 0, 0]"#), "a.json:camera.towards: has to have a direction"),
        (camera(r#""up": [0, 0, 0]"#), "a.json:camera.up: has to have a direction"),
        (
            camera(r#""xfov": 0"#),
            "a.json:camera.xfov: has to be above zero and below pi / 2, half the angle in radians, not 0",
        ),
        (camera(r#""xfov": -0.4"#), "a.json:camera.xfov: has to be above zero"),
        (camera(r#""xfov": 1.6"#), "a.json:camera.xfov: has to be above zero and below pi / 2"),
        (camera(r#""near": -1"#), "a.json:camera.near: has to be zero or more, not -1"),
        (camera(r#""near": 10, "far": 1"#), "a.json:camera.far: has to be beyond near, 10 m, not 1 m"),
        (camera(r#""far": 0"#), "a.json:camera.far: has to be beyond near, 0.01 m, not 0 m"),
        (material(r#""size": -0.1"#), "a.json:materials[1].size: has to be zero or more, not -0.1"),
        (material(r#""glow": -1"#), "a.json:materials[1].glow: has to be zero or more, not -1"),
        (
            material(r#""diffuse": [1, -0.5, 0]"#),
            "a.json:materials[1].diffuse: has to be red, green, blue from 0 to 1, not -0.5",
        ),
        (r#"{"background": [-1, 0, 0]}"#.into(), "a.json:background: has to be red, green, blue from 0 to 1, not -1"),
        (
            r#"{"lights": [{"directional": {"color": [0, 0, -2], "direction": [0, -1, 0]}}]}"#.into(),
            "a.json:lights[0].color: has to be red, green, blue from 0 to 1, not -2",
        ),
    ] {
        folder.write("a.json", text);
        refused_by(&folder, "a.json", error, &["run", "render", "check", "convert"]);
    }
    folder.write("a.scn", "camera 0 0 9  0 0 -1  0 1 0  0.25  10 1\n");
    refused_by(&folder, "a.scn", "a.scn:camera.far: has to be beyond near", &["run", "render"]);
    // As in the course's scenes.
    folder.write("a.scn", "camera 0 0 15 0 0 -1  0 1 0  0.25  0 10\nparticle 0 0 9  0 0 0  1 0 0 0 0 -1\n");
    folder.run("render a.scn --duration 0 --size 8x8 --out o.png").fine();
}

#[test]
fn looks_that_are_hardly_meant_are_remarked_on() {
    let folder = Folder::new();
    for (text, remark) in [
        (r#"{"materials": [{"diffuse": [255, 0, 0]}]}"#, "a.json:materials[0].diffuse: 255 is far beyond white"),
        (r#"{"materials": [{"glow": 3}]}"#, "a.json:materials[0].glow: 3 counts as 1"),
        (r#"{"background": [0, 0, 128]}"#, "a.json:background: 128 is far beyond white"),
        (
            r#"{"lights": [{"directional": {"color": [255, 255, 255], "direction": [0, -1, 0]}}]}"#,
            "a.json:lights[0].color: 255 is drawn as 100",
        ),
        (
            r#"{"materials": [{"texture": "wood.png"}]}"#,
            "a.json:materials[0].texture: there is no texture file 'wood.png'",
        ),
        (
            r#"{"emitters": [{"shape": {"sphere": {"center": [0, 0, 0], "radius": 1}}}]}"#,
            "a.json:emitters[0].rate: neither this nor a burst says how many, so nothing is born",
        ),
    ] {
        folder.write("a.json", text);
        let answer = folder.run("run a.json --steps 1");
        assert!(answer.warnings().iter().any(|warning| warning.starts_with(remark)), "{text}: {answer:?}");
    }
    folder.write("wood.png", "");
    let sound = r#"{"materials": [{"texture": "wood.png", "emission": [1.5, 0, 0]}], "lights": [{"point":
        {"color": [60, 60, 60], "position": [0, 9, 0], "attenuation": [1, 0, 1]}}]}"#;
    folder.write("a.json", sound);
    folder.run("run a.json --steps 1").fine();
}

#[test]
fn pictures_of_what_lies_beyond_the_cameras_reach_are_warned_of() {
    let scene = |far: f32, more: &str| {
        format!(r#"{{"particles": [{{"velocity": [0, 0, 1]}}], "camera": {{{CAMERA}, "far": {far}}}{more}}}"#)
    };
    let folder = Folder::with("a.json", scene(5.0, ""));
    let answer = folder.run("render a.json --duration 1 --size 8x8 --out o.gif");
    let told = "a.json:camera.far: nothing farther than 5 m is seen, and all that is before the camera lies there, the \
                nearest 8 m away";
    assert_eq!(answer.warnings(), [told]);
    // What comes near in time, or stands there, is seen.
    let ground = r#", "scenery": [{"shape": {"plane": {"point": [0, -1, 0], "normal": [0, 1, 0]}}}]"#;
    for (far, more) in [(8.5, ""), (5.0, ground)] {
        folder.write("a.json", scene(far, more));
        folder.run("render a.json --duration 1 --size 8x8 --out o.gif").fine();
    }
}

#[test]
fn pictures_that_a_gif_does_not_show_are_not_counted() {
    let folder = Folder::with("a.json", format!(r#"{{"particles": [{{}}], "camera": {{{CAMERA}}}}}"#));
    let answer = folder.run("render a.json --duration 1 --fps 1000 --size 8x8 --out o.gif");
    assert_eq!(
        answer.warnings(),
        [
            "--fps 1000: 950 of 1001 pictures are left out: a second of a GIF shows at most 50; .apng, .mp4 and numbered \
          pictures have all of them"
        ]
    );
    assert!(answer.stdout.starts_with("o.gif: 51 pictures of 8 x 8 pixels, 1.00 s, "), "{answer:?}");
    let answer = folder.run("render a.json --duration 0.1 --fps 100 --size 8x8 --out o.apng").fine();
    assert!(answer.stdout.starts_with("o.apng: 11 pictures of 8 x 8 pixels, 0.11 s, "), "{answer:?}");
}

/// With less memory than that, the program ends with an error, not with a trace.
#[cfg(target_os = "linux")]
#[test]
fn pictures_that_there_is_no_memory_for_are_refused() {
    let folder = Folder::with("a.json", format!(r#"{{"particles": [{{}}], "camera": {{{CAMERA}}}}}"#));
    let answer = folder
        .shell("ulimit -v 4000000; $POINTMASS render a.json --duration 0 --size 8192x8192 --threads 1 --out o.png");
    assert!(answer.error().starts_with("--size 8192x8192: there is no memory for such pictures, about "), "{answer:?}");
    assert_eq!(folder.names(), ["a.json"]);
}
