//! Skies, fog and shutters of scene files: read, checked, drawn, and written again.

use crate::bad_input::refused_by;
use crate::tool::Folder;
use image::RgbImage;

/// A fast ball and a slow one, before nothing.
const SCENE: &str = r#"{
    "run": {"duration": 1, "dt": 0.05},
    "camera": {"eye": [0, 0, 6], "towards": [0, 0, -1], "up": [0, 1, 0], "xfov": 0.5 SHUTTER},
    "background": [0, 0, 0],
    "particles": [
        {"position": [-2.5, 1, 0], "velocity": [3, 0, 0], "radius": 0.15},
        {"position": [0, -1, 0], "radius": 0.15}
    ] MORE
}"#;

fn scene(shutter: &str, more: &str) -> String {
    SCENE.replace("SHUTTER", shutter).replace("MORE", more)
}

fn drawn(folder: &Folder, args: &str) -> RgbImage {
    folder.run(&format!("render a.json --out a.png --size 200x150 {args}")).fine();
    image::open(folder.path("a.png")).expect("a picture").into_rgb8()
}

/// The width of what is at least half as bright as the brightest, in the upper or the lower half. A ball on its way that is longer than its
/// diameter is as wide as the way by this measure.
fn width(image: &RgbImage, is_low: bool) -> u32 {
    let rows = if is_low { 75..150 } else { 0..75 };
    let linear = |byte: u8| (f64::from(byte) / 255.0).powf(2.2);
    let light = |x: u32| rows.clone().map(|y| linear(image[(x, y)].0[0])).sum::<f64>();
    let over: Vec<f64> = (0..200).map(|x| light(x) - light(0)).collect();
    let most = over.iter().copied().fold(0.0, f64::max);
    over.iter().filter(|&&light| light > 0.5 * most).count() as u32
}

#[test]
fn an_open_shutter_draws_ways_of_its_time_at_any_step() {
    let folder = Folder::with("a.json", scene("", ""));
    let still = width(&drawn(&folder, "--shutter 0 --fps 2"), false);
    assert_eq!(width(&drawn(&folder, "--fps 2 --style shapes"), true), still);
    // A metre takes 30.5 pixels.
    for (shutter, dt) in [(0.1, 0.05), (0.1, 0.03), (0.25, 0.5), (0.4, 0.013)] {
        let image = drawn(&folder, &format!("--shutter {shutter} --fps 2 --dt {dt}"));
        let way = f64::from(width(&image, false));
        assert!((way - 3.0 * shutter * 30.5).abs() < 1.6, "{shutter}, {dt}: {way}");
        assert_eq!(width(&image, true), still);
    }
    // Shapes are the mean of what is seen every two pixels, as is what is solid.
    for shutter in [0.1, 0.3] {
        let image = drawn(&folder, &format!("--shutter {shutter} --fps 2 --style shapes"));
        let way = f64::from(width(&image, false));
        assert!((way - 3.0 * shutter * 30.5).abs() < 2.6, "{shutter}: {way}");
        assert_eq!(width(&image, true), still);
    }
    // Puffs shed as much light as they do when they are seen at an instant.
    let light = |image: &RgbImage| {
        let linear = |byte: u8| (f64::from(byte) / 255.0).powf(2.2);
        image.pixels().map(|pixel| linear(pixel.0[0])).sum::<f64>()
    };
    let [at_once, in_time] = ["0", "0.3"].map(|s| drawn(&folder, &format!("--shutter {s} --fps 2 --style sprites")));
    assert!((light(&in_time) / light(&at_once) - 1.0).abs() < 0.03, "{} {}", light(&in_time), light(&at_once));
    assert!(width(&in_time, false) > width(&at_once, false) + 8);
    let asked = drawn(&folder, "--shutter 0.2 --fps 2");
    folder.write("a.json", scene(r#", "shutter": 0.2"#, ""));
    assert_eq!(drawn(&folder, "--fps 2"), asked);
    assert_ne!(drawn(&folder, "--fps 2 --shutter 0.1"), asked);
    folder.run("render a.json --out a.png --size 20x15 --fps 10").fine();
    let answer = folder.run("render a.json --out a.png --size 20x15 --fps 10 --shutter 0.2");
    assert!(answer.warnings()[0].contains("the shutter of 0.2"), "{answer:?}");
    let cases =
        [("--shutter=-1", "expected seconds"), ("--shutter inf", "expected seconds"), ("--shutter x", "expected")];
    folder.misuse("render a.json --out a.png", &cases);
}

#[test]
fn newborn_leave_no_way_before_their_birth() {
    let born = r#", "emitters": [{"shape": {"sphere": {"center": [-2, 1, 0], "radius": 0}}, "direction": [1, 0, 0],
        "burst": {"count": 1, "at": 0.93}, "speed": 10, "radius": 0.15}]"#;
    let folder = Folder::with("a.json", scene("", born).replace("[-2.5, 1, 0]", "[9, 9, 9]"));
    let way = f64::from(width(&drawn(&folder, "--shutter 0.3 --fps 2"), false));
    assert!((way - 0.7 * 30.5).abs() < 1.6, "{way}");
}

#[test]
fn skies_and_fog_are_drawn_and_what_is_wrong_with_them_is_told() {
    let sky = r#", "sky": {"zenith": [0, 0, 1], "horizon": [1, 1, 1], "ground": [0, 1, 0]}"#;
    let folder = Folder::with("a.json", scene("", sky));
    let image = drawn(&folder, "");
    let [top, middle, bottom] = [0, 75, 149].map(|y| image[(5, y)].0);
    assert!(
        top[2] > top[0] + 20 && middle.iter().all(|&c| c > 250) && bottom[1] > bottom[0] + 20,
        "{top:?} {bottom:?}"
    );
    // What stands in thick fog without a colour is not seen; with one it has that.
    folder.write("a.json", scene("", &format!(r#"{sky}, "fog": {{"density": 5}}"#)));
    let hidden = drawn(&folder, "");
    assert!(image.iter().zip(hidden.iter()).filter(|(a, b)| a.abs_diff(**b) > 12).count() > 20);
    folder.write("a.json", scene("", r#", "fog": {"density": 5, "color": [1, 0, 0]}"#));
    let red = drawn(&folder, "");
    assert!(red.pixels().any(|pixel| pixel.0[0] > 200 && pixel.0[1] < 30));

    for (more, error) in [
        (r#", "fog": {"density": -1}"#, "a.json:fog.density: has to be zero or more"),
        (r#", "fog": {"density": 1, "from": -2}"#, "a.json:fog.from: has to be zero or more"),
        (r#", "fog": {}"#, "a.json:"),
        (r#", "sky": {"zenith": [0, 0, 1]}"#, "a.json:"),
    ] {
        folder.write("a.json", scene("", more));
        refused_by(&folder, "a.json", error, &["run", "render", "convert"]);
    }
    folder.write("a.json", scene(r#", "shutter": -0.1"#, ""));
    refused_by(&folder, "a.json", "a.json:camera.shutter: has to be zero or more", &["run", "render"]);
    folder.write("a.json", scene(r#", "shutter": 0.1"#, &format!(r#"{sky}, "fog": {{"density": 1}}"#)));
    let answer = folder.run("convert a.json a.scn");
    let warned = |about: &str| answer.warnings().iter().any(|warning| warning.starts_with(about));
    assert!(warned("camera: .scn has no shutter") && warned("sky and fog: "), "{answer:?}");
    folder.run("convert a.json b.json").fine();
    folder.run("convert b.json c.json").fine();
    assert_eq!(folder.read("b.json"), folder.read("c.json"));
    assert!(folder.read("b.json").contains("\"shutter\": 0.1"));
}
