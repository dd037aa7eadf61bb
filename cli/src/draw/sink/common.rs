//! The kinds of files have this in common.

use image::codecs::png::PngEncoder;
use image::{ImageError, RgbImage};
use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::Path;

/// The sentence that says what went wrong with a path.
pub(super) fn cannot_write(path: &Path, error: &dyn std::error::Error) -> String {
    format!("cannot write {}: {error}", path.display())
}

/// The sentence for a rendering without frames.
pub(super) fn no_frames(path: &Path) -> String {
    format!("cannot write {}: there is no frame to write", path.display())
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

    pub(super) fn check(&mut self, frame: &RgbImage, path: &Path) -> Result<(), String> {
        let (width, height) = frame.dimensions();
        let (path, sides) = (path.display(), 1..=Self::LARGEST);
        if !(sides.contains(&width) && sides.contains(&height)) {
            return Err(format!("cannot write {path}: {width} by {height} pixels are no picture"));
        }
        match *self.0.get_or_insert((width, height)) {
            first if first == (width, height) => Ok(()),
            first => Err(format!(
                "cannot write {path}: a frame is {width} by {height} pixels, but the first was {} by {}",
                first.0, first.1
            )),
        }
    }
}
