//! Any scene in the lecture's styles: what is drawn, and what is not.

use crate::tool::Folder;
use image::RgbImage;

/// A cloth, a ball, a point with a trail, a box, a spring that is far too long.
const SCENE: &str = r#"{
    "run": {"duration": 0.4, "dt": 0.02},
    "camera": {"eye": [0, 0, 6], "towards": [0, 0, -1], "up": [0, 1, 0], "xfov": 0.5},
    "background": [0, 0, 0],
    "materials": [
        {"diffuse": [1, 0, 0], "trail": {"seconds": 0.3, "width": 0.05}},
        {"diffuse": [0, 1, 0], "shape": {"form": {"box": {"min": [-1, -1, -1], "max": [1, 1, 1]}}}}
    ],
    "particles": [
        {"position": [-2, 1, 0], "velocity": [3, 0, 0], "material": 0},
        {"position": [-1, -1, 0], "radius": 0.3, "material": 1},
        {"position": [0, -1, 0], "radius": 0.2},
        {"position": [1, 1.5, 0], "fixed": true}, {"position": [2, 1.5, 0], "fixed": true}
    ],
    "springs": [{"ends": [3, 4], "rest_length": 0.5, "ks": 1}],
    "cloths": [{
        "form": {"sheet": {"corner": [0.5, -1.5, 0], "sides": [[1.5, 0, 0], [0, 1.5, 0]], "cells": [6, 6]}},
        "mass": 1, "springs": {"structural": {"ks": 10}}, "color": [0, 0, 255, 255]
    }]
}"#;

fn drawn(folder: &Folder, args: &str) -> RgbImage {
    folder.run(&format!("render a.json --out a.png --size 200x150 {args}")).fine();
    image::open(folder.path("a.png")).expect("a picture").into_rgb8()
}

/// The pixels that have much of one channel and little of the others.
fn count(image: &RgbImage, channel: usize) -> usize {
    let is = |pixel: &&image::Rgb<u8>| {
        (0..3).all(|other| other == channel || u16::from(pixel[channel]) > 2 * u16::from(pixel[other]) + 40)
    };
    image.pixels().filter(is).count()
}

#[test]
fn every_style_draws_what_it_says() {
    let folder = Folder::with("a.json", SCENE);
    let pictures = ["", "--style points", "--style sprites", "--style shapes", "--style trails", "--style lines"];
    let [own, points, sprites, shapes, trails, lines] = pictures.map(|args| drawn(&folder, args));
    // A surface: 1.5 m of a picture of 6.5 m on 200 pixels.
    assert!((1500..2600).contains(&count(&own, 2)), "{}", count(&own, 2));
    for image in [&points, &trails, &lines] {
        assert!(count(image, 2) < 1500 && count(image, 2) > 20, "{}", count(image, 2));
    }
    // A trail of 0.9 m, and of all the way in its own style.
    assert!(count(&own, 0) > 20 && count(&trails, 0) > 20, "{} {}", count(&own, 0), count(&trails, 0));
    assert!(count(&points, 0) < 12 && count(&shapes, 0) < 60);
    // A box of 0.6 m, and a puff instead.
    assert!((250..500).contains(&count(&own, 1)) && count(&shapes, 1) == count(&own, 1), "{}", count(&own, 1));
    assert!(count(&points, 1) < 12 && count(&sprites, 1) > 60);
    // The spring is drawn by its strain only where lines are asked for.
    assert!(count(&lines, 0) > 30, "{}", count(&lines, 0));
}

#[test]
fn a_style_that_is_none_is_told() {
    let folder = Folder::with("a.json", SCENE);
    folder.misuse("render a.json --out a.png", &[("--style blobs", "points, sprites, shapes, trails, lines")]);
}

#[test]
fn what_works_unseen_is_shown_where_it_is_asked_for() {
    let more = r#""sinks": [{"shape": {"sphere": {"center": [-2, -1.6, 0], "radius": 0.2}}, "intensity": 0, "ca": 1, "la": 0, "qa": 0}],
        "emitters": [{"shape": {"sphere": {"center": [-2.4, 0, 0], "radius": 0.2}}, "rate": 1e-3, "color": [0, 255, 0, 255]}],
        "particles""#;
    let folder = Folder::with("a.json", SCENE.replace(r#""particles""#, more));
    let bare = drawn(&folder, "--style points");
    let shown = |what: &str| drawn(&folder, &format!("--style points --show {what}"));
    let changed =
        |image: &RgbImage, other: &RgbImage| image.pixels().zip(other.pixels()).filter(|(a, b)| a != b).count();
    // A spring far too long, a green source, a red sink, and a point that goes 0.3 m.
    assert!(count(&shown("springs"), 0) > count(&bare, 0) + 20);
    assert!(count(&shown("sources"), 1) > count(&bare, 1) + 30);
    assert!(changed(&shown("sinks"), &bare) > 60, "{}", changed(&shown("sinks"), &bare));
    assert!(count(&shown("velocities"), 0) > count(&bare, 0) + 4, "{}", count(&shown("velocities"), 0));
    for index in ["grid", "kd", "bvh", "brute"] {
        assert!(changed(&shown(&format!("index --index {index}")), &bare) > 100, "{index}");
    }
    let all = shown("index,velocities,springs,sources,sinks");
    assert!(changed(&all, &bare) > 500);
    let turned = drawn(&folder, "--style points --threads 3 --show sinks,sources,springs,velocities,index");
    assert!(turned == all, "another order of asking is another picture");
    folder.misuse(
        "render a.json --out a.png",
        &[("--show all", "index, velocities, springs, strain, sources, sinks, contacts")],
    );
}

/// The pixels of about a colour.
fn like(image: &RgbImage, color: [u8; 3]) -> usize {
    image.pixels().filter(|pixel| (0..3).all(|i| pixel[i].abs_diff(color[i]) < 60)).count()
}

#[test]
fn contacts_are_shown_where_something_lies_or_is_struck() {
    let scene = |more: &str| {
        format!(
            r#"{{
            "run": {{"duration": 0.4, "dt": 0.01, "substeps": 4}}, "background": [0, 0, 0], "ambient": [0.2, 0.2, 0.2],
            "camera": {{"eye": [0, 0.5, 5], "towards": [0, 0, -1], "up": [0, 1, 0], "xfov": 0.4}},
            "forces": [{{"gravity": {{"acceleration": [0, -9.81, 0]}}}}],
            "scenery": [{{"shape": {{"plane": {{"point": [0, 0, 0], "normal": [0, 1, 0]}}}}}}], {more}
        }}"#
        )
    };
    let [orange, blue, red] = [[250, 170, 40], [60, 200, 230], [240, 60, 60]];
    let seen = |more: &str| {
        let folder = Folder::with("a.json", scene(more));
        let image = drawn(&folder, "--style points --fps 10 --show contacts");
        let bare = drawn(&folder, "--style points --fps 10");
        [orange, blue, red].map(|color| like(&image, color).saturating_sub(like(&bare, color)))
    };
    // In the air, at rest on the ground, and on another ball.
    let ball =
        |y: f32, elasticity: f32| format!(r#"{{"position": [0, {y}, 0], "radius": 0.3, "elasticity": {elasticity}}}"#);
    let balls = |list: &str| format!(r#""contacts": {{"position": {{}}}}, "particles": [{list}]"#);
    let [lies, touches, struck] = seen(&balls(&ball(1.8, 0.0)));
    assert_eq!([lies, touches, struck], [0; 3], "a ball that falls touches nothing yet");
    let [lies, touches, struck] = seen(&balls(&ball(0.3, 0.0)));
    assert!(lies > 3 && touches == 0 && struck == 0, "{lies} {touches} {struck}");
    let [lies, touches, struck] = seen(&balls(&format!("{}, {}", ball(0.3, 0.0), ball(0.9, 0.0))));
    assert!(lies > 3 && touches > 3 && struck == 0, "{lies} {touches} {struck}");
    // It falls 0.5 m in 0.32 s and bounces, without contacts between balls as with them.
    for more in [balls(&ball(0.8, 1.0)), format!(r#""particles": [{}]"#, ball(0.8, 1.0))] {
        let [_, touches, struck] = seen(&more);
        assert!(struck > 6 && touches == 0, "{more}: {touches} {struck}");
    }
    // Two boxes, the upper on the lower; a sheet of cloth on the ground.
    let boxes = r#""boxes": [{"sides": [0.6, 0.3, 0.6], "mass": 1, "position": [0, 0.15, 0]}, {"sides": [0.3, 0.3, 0.3], "mass": 1, "position": [0, 0.45, 0]}]"#;
    let [lies, touches, struck] = seen(boxes);
    assert!(lies > 6 && touches > 6 && struck == 0, "{lies} {touches} {struck}");
    let cloth = r#""cloths": [{"form": {"sheet": {"corner": [-0.5, 0.0055, -0.5], "sides": [[1, 0, 0], [0, 0, 1]], "cells": [4, 4]}}, "density": 0.2,
        "shell": {"stretch": [1000, 1000], "shear": 100}, "thickness": 0.01}]"#;
    let [lies, ..] = seen(cloth);
    assert!(lies > 6, "{lies}");
}

/// A cloth that hangs from its upper edge by soft springs is red where it is stretched, and grey in the picture of its beginning.
#[test]
fn a_cloth_is_shown_by_its_strain() {
    let cloth = r#"{
        "run": {"duration": 0.5, "dt": 0.005}, "background": [0, 0, 0], "ambient": [1, 1, 1],
        "camera": {"eye": [0, 0, 5], "towards": [0, 0, -1], "up": [0, 1, 0], "xfov": 0.4},
        "forces": [{"gravity": {"acceleration": [0, -9.81, 0]}}, {"drag": {}}],
        "cloths": [{"form": {"sheet": {"corner": [-0.5, 0.6, 0], "sides": [[1, 0, 0], [0, -1, 0]], "cells": [4, 4]}},
            "mass": 1, "drag": 1, "fixed": [0, 1, 2, 3, 4], "springs": {"structural": {"ks": 60, "kd": 1}}}]
    }"#;
    let folder = Folder::with("a.json", cloth);
    let [plain, shown] = ["", "--show strain"].map(|args| drawn(&folder, args));
    assert_eq!(count(&plain, 0), 0);
    assert!(count(&shown, 0) > 300, "{}", count(&shown, 0));
    assert_eq!(count(&drawn(&folder, "--show strain --duration 0"), 0), 0);
}

/// What is drawn of ropes, strands and links has the colour of its strain: grey as it begins, red where it hangs stretched by a tenth or more.
#[test]
fn ropes_strands_and_links_are_shown_by_their_strain() {
    let scene = |what: &str| {
        format!(
            r#"{{
            "run": {{"duration": 2, "dt": 0.01, "substeps": 4}}, "background": [0, 0, 0], "ambient": [1, 1, 1],
            "camera": {{"eye": [0, 0, 5], "towards": [0, 0, -1], "up": [0, 1, 0], "xfov": 0.4}},
            "forces": [{{"gravity": {{"acceleration": [0, -9.81, 0]}}}}], {what}
        }}"#
        )
    };
    let [grey, red] = [[170, 170, 180], [235, 70, 50]];
    // Each is a metre long and hangs by its upper end; where it is soft it is stretched by more than a tenth there.
    let rope = |stretch: &str| {
        format!(
            r#""ropes": [{{"curve": [[0, 1, 0], [0, 0, 0]], "segments": 10, "weight": 1, {stretch} "damping": 0.5, "drag": 1, "fixed": [0],
            "width": 0.05}}]"#
        )
    };
    let strand = |young: f32| {
        format!(
            r#""strands": [{{"form": {{"curve": [[0, 1, 0], [0, 0, 0]]}}, "segments": 10, "radius": 0.01, "density": 3000, "young": {young},
            "damping": 0.5, "drag": 1, "fixed": [0, 1], "width": 0.05}}]"#
        )
    };
    let rod = |compliance: f32| {
        format!(
            r#""particles": [{{"position": [0, 1, 0], "fixed": true}}, {{"position": [0, 0, 0], "mass": 1}}],
            "constraints": [{{"distance": {{"ends": [0, 1], "length": 1, "compliance": {compliance}, "damping": 3}}}}]"#
        )
    };
    // The rod is about a pixel wide.
    for (soft, stiff, least) in
        [(rope(r#""stretch": 15,"#), rope(""), 40), (strand(1.5e5), strand(3e9), 40), (rod(1.0 / 80.0), rod(0.0), 8)]
    {
        let seen = |what: &str, args: &str| {
            let image = drawn(&Folder::with("a.json", scene(what)), args);
            [grey, red].map(|color| like(&image, color))
        };
        let [_, plain] = seen(&soft, "");
        let [_, stretched] = seen(&soft, "--show strain");
        assert!(plain == 0 && stretched > least, "{soft}: {plain} {stretched}");
        for (what, args) in [(&stiff, "--show strain"), (&soft, "--show strain --duration 0")] {
            let [slack, stretched] = seen(what, args);
            assert!(slack > least && stretched == 0, "{what}: {slack} {stretched}");
        }
    }
}

/// Rods between particles of ropes are drawn, and so are those from there to others; a rope's own links are not drawn twice.
#[test]
fn rods_are_drawn_whatever_they_begin_at() {
    let rope = r#""ropes": [{"curve": [[-1, 1, 0], [-1, -1, 0]], "segments": 4, "weight": 1, "fixed": [0, 1, 2, 3, 4], "width": 0.001,
        "color": [0, 0, 0, 255]}]"#;
    let scene = |ends: [u32; 2]| {
        let rod = format!(r#""constraints": [{{"distance": {{"ends": [{}, {}], "length": 2}}}}],"#, ends[0], ends[1]);
        let rod = if ends[0] == ends[1] { "" } else { &rod };
        format!(
            r#"{{
            "run": {{"duration": 0}}, "background": [0, 0, 0], "ambient": [1, 1, 1],
            "camera": {{"eye": [0, 0, 5], "towards": [0, 0, -1], "up": [0, 1, 0], "xfov": 0.4}},
            "particles": [{{"position": [1, 0, 0], "fixed": true, "color": [0, 0, 0, 255]}}], {rod} {rope}
        }}"#
        )
    };
    let seen = |ends| like(&drawn(&Folder::with("a.json", scene(ends)), ""), [170, 170, 180]);
    assert_eq!(seen([0, 0]), 0);
    let [to, from, within] = [[0, 3], [3, 0], [1, 5]].map(seen);
    assert!(to > 20 && from > 20 && within > 20, "{to} {from} {within}");
}

/// Cloth on cloth is shown where one is as far from the other as both are thick, and not where they are apart, nor unless it is asked for.
#[test]
fn contacts_of_cloth_with_cloth_are_shown() {
    let scene = |height: f32, thickness: f32| {
        let sheet = |y: f32, more: &str| {
            format!(
                r#"{{"form": {{"sheet": {{"corner": [-0.5, {y}, -0.3], "sides": [[1, 0, 0], [0, 0, 0.6]], "cells": [4, 3]}}}}, "density": 0.2,
                "shell": {{"stretch": [1000, 1000], "shear": 100}}, "thickness": {thickness}{more}}}"#
            )
        };
        let fixed = format!(r#", "fixed": {:?}"#, (0..20).collect::<Vec<_>>());
        format!(
            r#"{{
            "run": {{"duration": 0.1, "dt": 0.01}}, "background": [0, 0, 0], "ambient": [0.2, 0.2, 0.2],
            "camera": {{"eye": [0, 0.5, 5], "towards": [0, 0, -1], "up": [0, 1, 0], "xfov": 0.4}},
            "forces": [{{"gravity": {{"acceleration": [0, -9.81, 0]}}}}],
            "cloths": [{}, {}]
        }}"#,
            sheet(0.0, &fixed),
            sheet(height, "")
        )
    };
    let seen = |height: f32, thickness: f32, args: &str| {
        let image = drawn(&Folder::with("a.json", scene(height, thickness)), args);
        like(&image, [60, 200, 230])
    };
    assert_eq!(seen(0.0101, 0.01, ""), 0);
    let touching = seen(0.0101, 0.01, "--show contacts");
    assert!(touching > 20, "{touching}");
    assert_eq!(seen(0.3, 0.01, "--show contacts"), 0);
}
