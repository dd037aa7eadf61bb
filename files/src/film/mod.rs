//! Where the pictures go: a film, a PNG or a numbered sequence of PNGs, by the name of the file.
//!
//! Files appear whole or not at all. It is put together under a passing name in the
//! same folder and renamed at the end; a rendering that is broken off leaves nothing behind.

mod animation;
mod apng;
mod common;
mod palette;
mod raw;
mod screen;
mod sequence;
mod still;
mod thrift;
mod video;
mod yuv;

use crate::outcome::Outcome;
use crate::pattern::{self, Pattern};
use crate::whole::{Series, WholeFile, is_standard};
use animation::Animation;
use apng::Apng;
use common::{Size, cannot_write};
use image::RgbImage;
use raw::Raw;
use sequence::Sequence;
use std::path::{Path, PathBuf};
use still::Still;
use video::{Packing, Video};

/// Takes the frames of a rendering, and writes them.
///
/// Errors are sentences that name the file and say what to do.
#[derive(Debug)]
pub struct Sink {
    film: Box<dyn Film>,
    path: PathBuf,
    size: Size,
}

/// A format that frames are written in, all of one size.
trait Film: std::fmt::Debug + Send {
    fn push(&mut self, frame: &RgbImage) -> Outcome;

    /// Completes the file and gives it its name.
    fn finish(self: Box<Self>) -> Outcome;

    fn keeps_only_last(&self) -> bool {
        false
    }

    fn is_abandoned(&self) -> bool {
        false
    }

    /// The frames that came too fast to be shown.
    fn left_out(&self) -> u64 {
        0
    }
}

impl Sink {
    /// Prepares to write `path`, one of
    ///
    /// - `FILE.gif`, an animation that repeats for ever, in about the right colours,
    /// - `FILE.apng`, the same to the bit, in a larger file,
    /// - `FILE.mp4` or `FILE.webm`, a video, where the program ffmpeg is installed,
    /// - `FILE.y4m`, a film for other programs, or `-`, the same on standard output,
    /// - `FILE.png`, a single picture, the last one pushed,
    /// - `DIR/%04d.png` (or `%d`, or any width), a sequence numbered from 0. The last folder is
    ///   created if it is missing.
    ///
    /// There are `fps` frames to a second, and `frames` in all.
    pub fn create(path: &Path, fps: f64, frames: u32) -> Outcome<Self> {
        if !(fps.is_finite() && fps > 0.0) {
            return Err(cannot_write(path, format!("{fps} frames per second make no film")));
        }
        let extension = path.extension().and_then(|extension| extension.to_str()).unwrap_or("");
        let pattern = Pattern::parse(path).map_err(|error| cannot_write(path, error))?;
        let film: Box<dyn Film> = match (pattern, extension.to_ascii_lowercase().as_str()) {
            (Some(pattern), "png") => {
                Box::new(Sequence { path: path.into(), pattern, series: Series::create(path, true)? })
            }
            (Some(_), _) => return Err(cannot_write(path, "numbered pictures must end in .png")),
            (None, "png") => Box::new(Still { file: WholeFile::create(path)?, last: None }),
            (None, "gif") => Box::new(Animation::create(path, fps)?),
            (None, "apng") => Box::new(Apng::create(path, fps, frames)?),
            (None, "mp4") => Box::new(Video::create(path, fps, Packing::Mp4)?),
            (None, "webm") => Box::new(Video::create(path, fps, Packing::Webm)?),
            (None, extension) if extension == "y4m" || is_standard(path) => Box::new(Raw::create(path, fps)?),
            (None, _) => {
                let known = "its name must end in .gif, .apng, .mp4, .webm, .y4m or .png, or be like DIR/%04d.png";
                return Err(cannot_write(path, known));
            }
        };
        let path = if is_standard(path) { "standard output".into() } else { path.to_owned() };
        Ok(Self { film, path, size: Size::default() })
    }

    /// Whether only the last frame counts, so that the others need not be drawn.
    pub fn keeps_only_last(&self) -> bool {
        self.film.keeps_only_last()
    }

    /// Tells whether nobody reads what is written any more, so that no further frame need be drawn.
    pub fn is_abandoned(&self) -> bool {
        self.film.is_abandoned()
    }

    /// How many of the frames so far are left out, because they come faster than the format shows any: those of a GIF beyond 50 a second.
    pub fn left_out(&self) -> u64 {
        self.film.left_out()
    }

    /// Takes the next frame. All frames must have the same size.
    pub fn push(&mut self, frame: &RgbImage) -> Outcome {
        self.size.check(frame, &self.path)?;
        self.film.push(frame)
    }

    /// Completes what is written and gives it its name. It is an error if there was no frame.
    pub fn finish(self) -> Outcome {
        self.film.finish()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    fn names(folder: &Path) -> Vec<String> {
        let mut names: Vec<_> =
            fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }

    #[test]
    fn nothing_is_left_of_what_is_not_finished() {
        let folder = tempfile::tempdir().unwrap();
        for name in ["a.gif", "a.apng", "a.y4m", "a.png", "frames/%d.png"] {
            let path = folder.path().join(name);
            let mut sink = Sink::create(&path, 25.0, 1).unwrap();
            sink.push(&RgbImage::new(8, 6)).unwrap();
            drop(sink);
            assert_eq!(names(folder.path()), [""; 0], "{name}");
            let error = Sink::create(&path, 25.0, 1).unwrap().finish().unwrap_err().to_string();
            assert!(error.contains(name), "{error}");
            assert_eq!(names(folder.path()), [""; 0], "{name}");
        }
    }

    #[test]
    fn what_is_finished_is_there() {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("a.gif"), "an older file").unwrap();
        for name in ["a.gif", "a.PNG", "frames/%02d.png"] {
            let mut sink = Sink::create(&folder.path().join(name), 25.0, 2).unwrap();
            assert_eq!(sink.keeps_only_last(), name == "a.PNG");
            for shade in [10, 200] {
                sink.push(&RgbImage::from_pixel(8, 6, image::Rgb([shade; 3]))).unwrap();
            }
            sink.finish().unwrap();
        }
        assert_eq!(names(folder.path()), ["a.PNG", "a.gif", "frames"]);
        assert_eq!(names(&folder.path().join("frames")), ["00.png", "01.png"]);
        let shade = |name| image::open(folder.path().join(name)).unwrap().to_rgb8()[(7, 5)].0;
        assert_eq!(shade("a.gif"), [10; 3]);
        assert_eq!(shade("a.PNG"), [200; 3]);
        assert_eq!(shade("frames/01.png"), [200; 3]);
    }

    #[test]
    fn errors_name_the_path() {
        let folder = tempfile::tempdir().unwrap();
        for name in [
            "nowhere/a.gif",
            "nowhere/a.apng",
            "nowhere/a.mp4",
            "nowhere/a.png",
            "no/where/%d.png",
            "a.avi",
            "a",
            "%d.gif",
            "%s.png",
        ] {
            let error = Sink::create(&folder.path().join(name), 25.0, 2).unwrap_err().to_string();
            assert!(error.contains(name), "{error}");
        }
        let path = folder.path().join("a.gif");
        for fps in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(Sink::create(&path, fps, 1).is_err());
        }
        for name in ["a.gif", "a.apng", "a.y4m", "%d.png"] {
            let mut sink = Sink::create(&folder.path().join(name), 25.0, 2).unwrap();
            sink.push(&RgbImage::new(8, 6)).unwrap();
            assert!(sink.push(&RgbImage::new(6, 8)).unwrap_err().to_string().contains(name));
        }
    }
}
