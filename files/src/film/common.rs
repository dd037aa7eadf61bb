//! The kinds of files have this in common.

use crate::outcome::{Failure, Outcome};
use image::codecs::png::PngEncoder;
use image::{ImageError, RgbImage};
use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::Path;

/// The failure to write to a path.
pub(super) fn cannot_write(path: &Path, error: impl std::fmt::Display) -> Failure {
    Failure::new(format!("cannot write {}: {error}", path.display()))
}

/// That of a rendering without frames.
pub(super) fn no_frames(path: &Path) -> Failure {
    cannot_write(path, "there is no frame to write")
}

/// Writes a picture.
pub(super) fn write_png(frame: &RgbImage, file: File) -> Result<(), ImageError> {
    let mut file = BufWriter::new(file);
    frame.write_with_encoder(PngEncoder::new(&mut file))?;
    Ok(file.flush()?)
}

/// The size of the first frame, which all others must have too.
#[derive(Debug, Default)]
pub(super) struct Size(Option<(u32, u32)>);

impl Size {
    /// The largest size that every format can hold.
    const LARGEST: u32 = u16::MAX as u32;

    pub(super) fn check(&mut self, frame: &RgbImage, path: &Path) -> Outcome {
        let (width, height) = frame.dimensions();
        let sides = 1..=Self::LARGEST;
        if !(sides.contains(&width) && sides.contains(&height)) {
            return Err(cannot_write(path, format!("{width} by {height} pixels are no picture")));
        }
        let first = *self.0.get_or_insert((width, height));
        let unlike = || format!("a frame is {width} by {height} pixels, but the first was {} by {}", first.0, first.1);
        if first == (width, height) { Ok(()) } else { Err(cannot_write(path, unlike())) }
    }
}
