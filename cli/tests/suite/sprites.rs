//! Particles as pictures, pictures as meshes, and motion by keys: what cannot be used is told by its place, what can is drawn.

use crate::bad_input::refused_by;
use crate::tool::Folder;
use image::{Rgba, RgbaImage};

#[test]
fn sprites_and_keys_that_are_wrong() {
    let sprite = |sprite: &str| format!(r#"{{"materials": [{{"sprite": {sprite}}}]}}"#);
    let moved = |motion: &str| {
        format!(
            r#"{{"scenery": [{{"shape": {{"sphere": {{"center": [0, 0, 0], "radius": 1}}}}, "motion": {motion}}}]}}"#
        )
    };
    let cases = [
        (sprite(r#"{"picture": "smoke"}"#), "a.json:materials[0].sprite.picture: 'smoke' is none: one of puff, flame"),
        (sprite(r#"{"picture": ".png"}"#), "a.json:materials[0].sprite.picture: '.png' is none"),
        (
            sprite(r#"{"picture": "puff", "grid": [2, 1]}"#),
            "a.json:materials[0].sprite.grid: has to be columns and rows",
        ),
        (
            sprite(r#"{"picture": "a.png", "grid": [0, 1]}"#),
            "a.json:materials[0].sprite.grid: has to be columns and rows",
        ),
        (sprite(r#"{"picture": "a.png", "rate": -1}"#), "a.json:materials[0].sprite.rate: must not be below zero"),
        (sprite(r#"{"picture": "puff", "blend": "mix"}"#), "a.json:1:"),
        (
            moved(r#"{"keys": [{"time": 1}, {"time": 1}]}"#),
            "a.json:scenery[0].motion: its keys have to be in the order",
        ),
        (moved(r#"{"keys": [{"time": -1}]}"#), "a.json:scenery[0].motion: its keys have to be in the order"),
        (moved(r#"{"keys": [{"time": 2}], "period": 1}"#), "a.json:scenery[0].motion: its keys have to lie within"),
        (moved(r#"{"period": -1}"#), "a.json:scenery[0].motion: its keys have to be finite, and its period"),
    ];
    let folder = Folder::new();
    for (text, error) in cases {
        folder.write("a.json", &text);
        refused_by(&folder, "a.json", error, &["run", "render", "convert", "check"]);
    }
}

#[test]
fn what_scn_cannot_say_of_them_is_warned_of() {
    let folder = Folder::new();
    let motion = r#"{"keys": [{"time": 0}, {"time": 1, "place": [1, 0, 0]}]}"#;
    let sphere = r#"{"sphere": {"center": [0, 0, 0], "radius": 1}}"#;
    folder.write(
        "a.json",
        format!(
            r#"{{"particles": [{{}}], "constraints": [{{"attach": {{"particles": [0], "motion": {motion}}}}}],
                "materials": [{{"sprite": {{"picture": "puff"}}}}, {{"shape": {{"form": {sphere}}}, "trail": {{"seconds": 1}}}}], "scenery": [{{"shape": {sphere}, "motion": {motion}}}],
                "emitters": [{{"shape": {sphere}, "motion": {motion}}}]}}"#
        ),
    );
    let answer = folder.run("convert a.json a.scn");
    let warnings = answer.warnings();
    for left_out in [
        "constraints: ",
        "materials: .scn has no sprites",
        "materials: .scn has no shapes",
        "materials: .scn has no trails",
        "scenery[0].motion: ",
        "emitters[0]: ",
    ] {
        let about = warnings.iter().filter(|warning| warning.starts_with(left_out) && warning.contains("left out"));
        assert_eq!(about.count(), 1, "{left_out}: {warnings:#?}");
    }
}

#[test]
fn pictures_that_cannot_be_read_spoil_only_what_needs_them() {
    let folder = Folder::new();
    folder.write("small.png", "no picture");
    folder.write("a.json", r#"{"materials": [{"sprite": {"picture": "small.png", "grid": [4, 4]}}]}"#);
    refused_by(&folder, "a.json", "small.png: materials[0].sprite.picture: ", &["render"]);
    assert_eq!(folder.run("run a.json --steps 1").code, 0);
    RgbaImage::from_pixel(3, 8, Rgba([255; 4])).save(folder.path("small.png")).expect("it is written");
    refused_by(&folder, "a.json", "small.png: materials[0].sprite.picture: has 3 x 8 pixels, too few", &["render"]);
    folder.write("b.json", r#"{"scenery": [{"shape": {"mesh": "small.png"}}]}"#);
    refused_by(&folder, "b.json", "b.json:scenery[0].shape: small.png: has no ink", &["run", "render", "check"]);
}

#[test]
fn a_flipbook_from_a_file_is_drawn_frame_by_frame() {
    let folder = Folder::new();
    // Four frames of one colour each.
    let colors = [[255, 0, 0, 255], [0, 255, 0, 255], [0, 0, 255, 255], [255, 255, 255, 255]];
    let book = RgbaImage::from_fn(16, 16, |x, y| Rgba(colors[(x / 8 + y / 8 * 2) as usize]));
    book.save(folder.path("book.png")).expect("it is written");
    folder.write(
        "a.json",
        r#"{"particles": [{"position": [0, 0, -3], "material": 0}], "background": [0, 0, 0],
            "camera": {"eye": [0, 0, 0], "towards": [0, 0, -1], "up": [0, 1, 0], "xfov": 0.3, "near": 0.1, "far": 10},
            "materials": [{"size": 1, "diffuse": [1, 1, 1], "sprite": {"picture": "book.png", "grid": [2, 2], "rate": 2}}]}"#,
    );
    folder.run("render a.json --out %02d.png --size 40x30 --fps 2 --duration 2.5").fine();
    for number in 0..=5usize {
        let picture = image::open(folder.path(&format!("{number:02}.png"))).expect("a picture").into_rgba8();
        assert_eq!(picture[(20, 15)].0, colors[number % 4], "picture {number}");
    }
}
