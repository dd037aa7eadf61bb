//! Animated GIFs: the file, and the frames in time.

use super::Film;
use super::common::{cannot_write, no_frames};
use super::screen::Screen;
use crate::outcome::Outcome;
use crate::whole::WholeFile;
use gif::{Encoder, EncodingError, Frame, Repeat};
use image::RgbImage;
use std::fmt;
use std::io::{BufWriter, Write};
use std::path::Path;

/// The shortest time, in hundredths of a second, that a frame can be shown: browsers slow down
/// animations that ask for less.
const SHORTEST: u64 = 2;

/// An animation in the making.
#[derive(Debug)]
pub(super) struct Animation {
    file: WholeFile,
    fps: f64,
    /// How many frames were pushed, and how many of them came too fast.
    count: u64,
    left_out: u64,
    reel: Option<Reel>,
}

/// The frames from the first one on, which gives the animation its size.
struct Reel {
    encoder: Encoder<BufWriter<std::fs::File>>,
    screen: Screen,
    /// A frame, and when it begins. How long it lasts is known when the next one comes.
    waiting: (Frame<'static>, u64),
}

impl Animation {
    pub(super) fn create(path: &Path, fps: f64) -> Outcome<Self> {
        Ok(Self { file: WholeFile::create(path)?, fps, count: 0, left_out: 0, reel: None })
    }

    /// When a frame begins, in hundredths of a second. Each is rounded by itself, so that the
    /// rounding does not add up.
    fn time(&self, frame: u64) -> u64 {
        (100.0 * frame as f64 / self.fps).round() as u64
    }
}

impl Film for Animation {
    fn push(&mut self, frame: &RgbImage) -> Outcome {
        let begins = self.time(self.count);
        self.count += 1;
        let done = match &mut self.reel {
            // Of frames that come too fast, some are left out.
            Some(reel) if begins < reel.waiting.1 + SHORTEST => {
                self.left_out += 1;
                Ok(())
            }
            Some(reel) => reel.push(frame, begins),
            None => self.file.reopen().map_err(EncodingError::from).and_then(|file| {
                self.reel = Some(Reel::new(frame, BufWriter::new(file))?);
                Ok(())
            }),
        };
        done.map_err(|error| cannot_write(self.file.path(), error))
    }

    fn left_out(&self) -> u64 {
        self.left_out
    }

    fn finish(self: Box<Self>) -> Outcome {
        let ends = self.time(self.count);
        let Some(reel) = self.reel else { return Err(no_frames(self.file.path())) };
        reel.finish(ends).map_err(|error| cannot_write(self.file.path(), error))?;
        self.file.complete()
    }
}

impl Reel {
    fn new(frame: &RgbImage, output: BufWriter<std::fs::File>) -> Result<Self, EncodingError> {
        let (width, height) = frame.dimensions();
        let mut encoder = Encoder::new(output, width as u16, height as u16, &[])?;
        encoder.set_repeat(Repeat::Infinite)?;
        let mut screen = Screen::new(width, height);
        let waiting = (screen.show(frame), 0);
        Ok(Self { encoder, screen, waiting })
    }

    fn push(&mut self, frame: &RgbImage, begins: u64) -> Result<(), EncodingError> {
        self.release(begins)?;
        self.waiting = (self.screen.show(frame), begins);
        Ok(())
    }

    fn finish(mut self, ends: u64) -> Result<(), EncodingError> {
        self.release(ends.max(self.waiting.1 + SHORTEST))?;
        Ok(self.encoder.into_inner()?.flush()?)
    }

    /// Writes the waiting frame.
    fn release(&mut self, ends: u64) -> Result<(), EncodingError> {
        let (frame, begins) = &mut self.waiting;
        frame.delay = u16::try_from(ends - *begins).unwrap_or(u16::MAX);
        self.encoder.write_frame(frame)
    }
}

impl fmt::Debug for Reel {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Reel").field("screen", &self.screen).finish_non_exhaustive()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs::File;

    /// The delays of a film of some frames.
    fn delays(fps: f64, count: u32) -> Vec<u64> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("film.gif");
        let mut film = Animation::create(&path, fps).unwrap();
        for number in 0..count {
            film.push(&RgbImage::from_pixel(4, 3, image::Rgb([(9 * number) as u8; 3]))).unwrap();
        }
        let left_out = film.left_out();
        Box::new(film).finish().unwrap();
        let mut decoder = gif::Decoder::new(File::open(path).unwrap()).unwrap();
        assert_eq!(decoder.repeat(), Repeat::Infinite);
        let mut delays = Vec::new();
        while let Some(frame) = decoder.read_next_frame().unwrap() {
            delays.push(u64::from(frame.delay));
        }
        assert_eq!(left_out + delays.len() as u64, u64::from(count), "{fps}");
        delays
    }

    #[test]
    fn a_film_is_as_long_as_it_should_be() {
        // The last is longer by one frame, since a frame cannot last no time at all.
        for (fps, count, length) in
            [(25.0, 50, 200), (30.0, 60, 200), (24.0, 36, 150), (60.0, 90, 150), (7.5, 3, 40), (1000.0, 80, 10)]
        {
            let delays = delays(fps, count);
            assert_eq!(delays.iter().sum::<u64>(), length, "{fps}");
            assert!(delays.iter().all(|&delay| delay >= SHORTEST), "{fps}: {delays:?}");
        }
        assert_eq!(delays(30.0, 6), [3, 4, 3, 3, 4, 3]);
        assert_eq!(delays(0.001, 1), [u64::from(u16::MAX)]);
    }
}
