//! Animated PNGs: every picture to the bit, and of each only the part that has changed.

use super::Film;
use super::common::{cannot_write, no_frames};
use crate::outcome::Outcome;
use crate::whole::WholeFile;
use image::RgbImage;
use image::imageops::crop_imm;
use png::{BitDepth, ColorType, Encoder, EncodingError, Writer};
use std::fmt;
use std::fs::File;
use std::path::Path;

/// An animation in the making.
#[derive(Debug)]
pub(super) struct Apng {
    file: WholeFile,
    /// The part of a second that a frame is shown, as numerator and denominator.
    delay: (u16, u16),
    /// The number of frames that there are going to be; the file begins with that.
    frames: u32,
    reel: Option<Reel>,
}

/// The frames from the first one on, which gives the animation its size.
struct Reel {
    writer: Writer<File>,
    before: RgbImage,
}

impl Apng {
    pub(super) fn create(path: &Path, fps: f64, frames: u32) -> Outcome<Self> {
        let file = WholeFile::create(path)?;
        // Rates are whole numbers, or have as many digits as fit.
        let unit = if fps.fract() == 0.0 && fps <= 65535.0 { 1.0 } else { (60_000.0 / fps).clamp(1.0, 1000.0).floor() };
        let delay = (unit as u16, (unit * fps).round().clamp(1.0, 65535.0) as u16);
        Ok(Self { file, delay, frames, reel: None })
    }

    fn add(&mut self, frame: &RgbImage) -> Result<(), EncodingError> {
        if let Some(reel) = &mut self.reel {
            return reel.push(frame);
        }
        let (width, height) = frame.dimensions();
        let mut encoder = Encoder::new(self.file.reopen()?, width, height);
        encoder.set_color(ColorType::Rgb);
        encoder.set_depth(BitDepth::Eight);
        encoder.set_animated(self.frames, 0)?;
        encoder.set_frame_delay(self.delay.0, self.delay.1)?;
        let mut writer = encoder.write_header()?;
        writer.write_image_data(frame)?;
        self.reel = Some(Reel { writer, before: frame.clone() });
        Ok(())
    }
}

impl Film for Apng {
    fn push(&mut self, frame: &RgbImage) -> Outcome {
        self.add(frame).map_err(|error| cannot_write(self.file.path(), error))
    }

    fn finish(self: Box<Self>) -> Outcome {
        let Some(reel) = self.reel else { return Err(no_frames(self.file.path())) };
        reel.writer.finish().map_err(|error| cannot_write(self.file.path(), error))?;
        self.file.complete()
    }
}

impl Reel {
    fn push(&mut self, frame: &RgbImage) -> Result<(), EncodingError> {
        let [left, top, width, height] = changes(&self.before, frame);
        self.writer.reset_frame_position()?;
        self.writer.set_frame_dimension(width, height)?;
        self.writer.set_frame_position(left, top)?;
        self.writer.write_image_data(&crop_imm(frame, left, top, width, height).to_image())?;
        self.before.clone_from(frame);
        Ok(())
    }
}

/// The left and the top edge, the width and the height of what has changed; a pixel if nothing has.
fn changes(before: &RgbImage, now: &RgbImage) -> [u32; 4] {
    let pixels = before.enumerate_pixels().zip(now.pixels());
    let changed = pixels.filter(|((_, _, before), now)| before != now).map(|((x, y, _), _)| [x, y]);
    let around = |[low, high]: [[u32; 2]; 2], [x, y]: [u32; 2]| {
        [[low[0].min(x), low[1].min(y)], [high[0].max(x + 1), high[1].max(y + 1)]]
    };
    let [low, high] = changed.fold([[u32::MAX; 2], [0; 2]], around);
    if high == [0; 2] { [0, 0, 1, 1] } else { [low[0], low[1], high[0] - low[0], high[1] - low[1]] }
}

impl fmt::Debug for Reel {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Reel").finish_non_exhaustive()
    }
}
