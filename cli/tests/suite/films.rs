//! Films: what they are made of, how they are read again, and from where they are seen.

use crate::scenes::{BUSY, ONE};
use crate::tool::Folder;
use image::codecs::gif::GifDecoder;
use image::codecs::png::PngDecoder;
use image::{AnimationDecoder, Frame, RgbImage};
use std::fs::{self, File};
use std::io::{BufReader, Read};

/// A picture every tenth of a second.
const SHORT: &str = "--duration 0.5 --fps 10 --size 64x48";

/// The particle that stays where it is, without which nothing would be seen.
const STILL: &str = "camera 0 0 9  0 0 -1  0 1 0  0.3  0.1 100\nparticle 1 0 0  0 0 0  1 0 0 0 0 -1\n";

/// The pictures of a film as they are, one by one.
fn pictures(folder: &Folder, scene: &str) -> Vec<RgbImage> {
    folder.run(&format!("render {scene} {SHORT} --out f%d.png")).fine();
    (0..6).map(|i| image::open(folder.path(&format!("f{i}.png"))).expect("a picture").into_rgb8()).collect()
}

fn reader(folder: &Folder, name: &str) -> BufReader<File> {
    BufReader::new(File::open(folder.path(name)).expect("a film"))
}

fn rgb(frames: Vec<Frame>) -> Vec<RgbImage> {
    let rgb = |frame: Frame| image::DynamicImage::from(frame.into_buffer()).into_rgb8();
    frames.into_iter().map(rgb).collect()
}

/// How far apart two pictures are, at most and on average.
fn difference(a: &RgbImage, b: &RgbImage) -> (u8, f64) {
    let each = || a.iter().zip(b.iter()).map(|(a, b)| a.abs_diff(*b));
    (each().max().unwrap_or(0), each().map(f64::from).sum::<f64>() / a.len() as f64)
}

/// Pictures of what `y4m` reads.
fn decoded(film: impl Read) -> Vec<RgbImage> {
    let mut decoder = y4m::decode(film).expect("a film");
    let (width, height) = (decoder.get_width(), decoder.get_height());
    assert_eq!((decoder.get_framerate().num, decoder.get_framerate().den), (10, 1));
    assert!(String::from_utf8_lossy(decoder.get_raw_params()).contains("XCOLORRANGE=FULL"));
    let mut pictures = Vec::new();
    while let Ok(frame) = decoder.read_frame() {
        let value = |plane: &[u8], at: usize| f32::from(plane[at]);
        pictures.push(RgbImage::from_fn(width as u32, height as u32, |x, y| {
            let at = y as usize * width + x as usize;
            let luma = value(frame.get_y_plane(), at);
            let (blue, red) = (value(frame.get_u_plane(), at) - 128.0, value(frame.get_v_plane(), at) - 128.0);
            let rgb = [luma + 1.402 * red, luma - 0.344_136 * blue - 0.714_136 * red, luma + 1.772 * blue];
            image::Rgb(rgb.map(|value| value.round() as u8))
        }));
    }
    pictures
}

#[test]
fn films_hold_the_pictures() {
    let folder = Folder::with("a.scn", BUSY);
    let pictures = pictures(&folder, "a.scn");
    for name in ["o.gif", "o.apng", "o.y4m"] {
        let said = folder.run(&format!("render a.scn {SHORT} --out {name}")).fine().stdout;
        assert!(said.starts_with(&format!("{name}: 6 pictures of 64 x 48 pixels, 0.60 s, ")), "{said}");
    }
    let apng = PngDecoder::new(reader(&folder, "o.apng")).and_then(PngDecoder::apng).expect("a film");
    assert_eq!(rgb(apng.into_frames().collect_frames().expect("all frames")), pictures);

    let gif = GifDecoder::new(reader(&folder, "o.gif")).expect("a film");
    let gif = rgb(gif.into_frames().collect_frames().expect("all frames"));
    assert_eq!(gif.len(), pictures.len());
    for (seen, meant) in gif.iter().zip(&pictures) {
        let (most, mean) = difference(seen, meant);
        assert!(most < 64 && mean < 3.0, "{most} {mean}");
    }
    let raw = decoded(reader(&folder, "o.y4m"));
    assert_eq!(raw.len(), pictures.len());
    // Rounding luma and chroma moves a channel by half of 1.772, and by luma's own half.
    assert!(raw.iter().zip(&pictures).all(|(seen, meant)| difference(seen, meant).0 <= 2));
    let close = raw.iter().zip(&pictures).map(|(seen, meant)| difference(seen, meant).1);
    assert!(close.fold(0.0, f64::max) < 0.5);
}

#[test]
fn pictures_are_the_same_on_any_number_of_threads() {
    let folder = Folder::with("a.scn", BUSY);
    for name in ["o.gif", "o.apng", "o.png"] {
        let film = |threads: u32| {
            folder.run(&format!("render a.scn {SHORT} --threads {threads} --out {name}")).fine();
            fs::read(folder.path(name)).expect("a film")
        };
        let one = film(1);
        assert!([2, 5].into_iter().all(|threads| film(threads) == one), "{name}");
    }
}

#[cfg(unix)]
#[test]
fn films_go_into_pipes_and_other_programs() {
    let folder = Folder::with("a.scn", BUSY);
    folder.run(&format!("render a.scn {SHORT} --out o.y4m")).fine();
    let film = fs::read(folder.path("o.y4m")).expect("a film");
    let answer = folder.shell(&format!("$POINTMASS render a.scn {SHORT} --out - > piped"));
    assert_eq!((answer.code, answer.stdout.as_str()), (0, ""));
    assert_eq!(answer.stderr, "written: 6 pictures of 64 x 48 pixels, 0.60 s\n");
    assert_eq!(fs::read(folder.path("piped")).ok().as_ref(), Some(&film));

    // A reader that goes away is no error, and nothing is said.
    let long = "--duration 400 --fps 10 --size 64x48";
    let answer = folder.shell(&format!("{{ $POINTMASS render a.scn {long} --out -; echo $? > code; }} | head -c 9"));
    assert_eq!((answer.stdout.as_str(), answer.stderr.as_str()), ("YUV4MPEG2", ""));
    assert_eq!(folder.read("code"), "0\n");

    // What packs them is whatever is called ffmpeg.
    let packer = |script: &str| {
        folder.write("bin/ffmpeg", format!("#!/bin/sh\n{script}\n"));
        assert_eq!(folder.shell("chmod +x bin/ffmpeg").code, 0);
    };
    let packed =
        |path: &str, name: &str| folder.shell(&format!("PATH={path} $POINTMASS render a.scn {SHORT} --out {name}"));
    packer("for last; do :; done; cat > \"$last\"");
    for name in ["o.mp4", "o.webm"] {
        packed("bin:$PATH", name).fine();
        assert_eq!(fs::read(folder.path(name)).ok().as_ref(), Some(&film), "{name}");
    }
    packer("echo it is Sunday >&2; exit 1");
    let names = folder.names();
    assert!(packed("bin:$PATH", "new.mp4").error().contains("new.mp4: ffmpeg: it is Sunday"));
    packer("cat > /dev/null; echo too late >&2; exit 1");
    assert!(packed("bin:$PATH", "new.mp4").error().contains("new.mp4: ffmpeg: too late"));
    let missing = packed("nowhere", "new.mp4");
    assert!(missing.error().contains("ffmpeg packs videos and is not installed; install it"), "{missing:?}");
    assert_eq!(folder.names(), names);
}

#[test]
fn the_eye_comes_back_after_a_turn() {
    let folder = Folder::with("a.scn", STILL);
    let film = |options: &str| -> Vec<Vec<u8>> {
        folder.run(&format!("render a.scn {SHORT} {options} --out f%d.png")).fine();
        (0..6).map(|i| fs::read(folder.path(&format!("f{i}.png"))).expect("a picture")).collect()
    };
    let (still, turned, back) = (film(""), film("--orbit 1"), film("--orbit -2"));
    assert!(still.iter().all(|picture| *picture == still[0]));
    for film in [turned, back] {
        assert_eq!((&film[0], &film[5]), (&still[0], &still[0]));
        assert!(film[1..5].iter().all(|picture| *picture != still[0]));
    }
}

#[test]
fn cameras_are_where_they_are_put() {
    let folder = Folder::with("a.scn", STILL);
    let picture = |options: &str| {
        folder.run(&format!("render a.scn {SHORT} {options} --out o.png")).fine();
        fs::read(folder.path("o.png")).expect("a picture")
    };
    assert_eq!(picture("--camera 0,0,9:0,0,0"), picture(""));
    assert_ne!(picture("--camera 0,0,9:0.5,0,0"), picture(""));
    folder.misuse(
        "render a.scn --out o.gif",
        &[
            ("--camera 1,2", "expected X,Y,Z or X,Y,Z:TX,TY,TZ in metres"),
            ("--camera 1,2,3:4", "expected X,Y,Z or X,Y,Z:TX,TY,TZ in metres"),
            ("--camera nan,2,3", "expected X,Y,Z or X,Y,Z:TX,TY,TZ in metres"),
            ("--camera 1,2,nan", "expected X,Y,Z or X,Y,Z:TX,TY,TZ in metres"),
            ("--camera 1,2,1e30", "expected X,Y,Z or X,Y,Z:TX,TY,TZ in metres"),
            ("--camera 1,2,3:1,2,3", "the eye cannot look at where it is"),
            ("--camera 1,2,3 --fit", "cannot be used with"),
            ("--orbit round", "expected a number"),
            ("--orbit inf", "expected turns"),
        ],
    );
}

#[test]
fn names_that_no_film_can_have_are_told() {
    let folder = Folder::with("a.scn", STILL);
    let cases = [
        ("--out f/%s.png", "a % in a name must be the place of the number, as in %04d or %d"),
        ("--out %d%d.png", "a % in a name must be the place of the number, as in %04d or %d"),
        ("--out %d.gif", "numbered pictures end in .png"),
        ("--out f.avi", "expected a name that ends in"),
    ];
    folder.misuse("render a.scn", &cases);
    assert_eq!(folder.names(), ["a.scn"]);
}

#[cfg(target_os = "linux")]
#[test]
fn a_place_where_no_file_can_be_made_is_told_without_the_passing_name() {
    let folder = Folder::with("a.scn", STILL);
    for name in ["/proc/x.gif", "/proc/%d.png"] {
        let answer = folder.run(&format!("render a.scn {SHORT} --out {name}"));
        let error = answer.error();
        assert!(error.starts_with(&format!("{name}: no file can be made in /proc: ")), "{error}");
        assert!(!error.contains(".pointmass"), "{error}");
    }
}

#[test]
fn a_camera_that_nobody_placed_shows_the_whole_run() {
    // It leaves the place where it begins far behind.
    let folder = Folder::with("a.scn", ONE);
    let light = |picture: &RgbImage| {
        let bright = picture.enumerate_pixels().filter(|(_, _, pixel)| pixel.0.into_iter().max() > Some(100));
        let columns: Vec<u32> = bright.map(|(x, _, _)| x).collect();
        columns.iter().sum::<u32>() as f32 / columns.len() as f32
    };
    for (name, scene) in [("a.scn", ONE.to_string()), ("b.scn", format!("{STILL}{ONE}"))] {
        folder.write(name, scene);
        folder.run(&format!("render {name} --duration 50 --fps 1 --size 64x48 --fit --out f%d.png")).fine();
        let places: Vec<f32> = [0, 25, 50]
            .map(|i| light(&image::open(folder.path(&format!("f{i}.png"))).expect("a picture").into_rgb8()))
            .to_vec();
        assert!(places.iter().all(|place| (0.0..64.0).contains(place)), "{name}: {places:?}");
        assert!(places[0] < places[1] && places[1] < places[2], "{name}: {places:?}");
    }
}
