//! Films for other programs, in a file or on standard output.

use super::Film;
use super::common::{cannot_write, no_frames};
use super::yuv::Yuv;
use crate::outcome::Outcome;
use crate::whole::{WholeFile, is_standard};
use image::RgbImage;
use std::io::{self, ErrorKind, Write};
use std::path::{Path, PathBuf};

/// A film in the making.
#[derive(Debug)]
pub(super) struct Raw {
    path: PathBuf,
    /// Nothing on standard output, which gets the pictures as they come.
    file: Option<WholeFile>,
    fps: f64,
    /// True once nobody reads standard output any more.
    abandoned: bool,
    reel: Option<Yuv<Box<dyn Write + Send>>>,
}

impl Raw {
    /// A film in a file, or on standard output for `-`.
    pub(super) fn create(path: &Path, fps: f64) -> Outcome<Self> {
        let is_file = !is_standard(path);
        let file = is_file.then(|| WholeFile::create(path)).transpose()?;
        let path = if is_file { path } else { Path::new("standard output") };
        Ok(Self { path: path.to_owned(), file, fps, abandoned: false, reel: None })
    }

    fn add(&mut self, frame: &RgbImage) -> io::Result<()> {
        let mut reel = match self.reel.take() {
            Some(reel) => reel,
            None => Yuv::begin(self.output()?, frame, self.fps)?,
        };
        reel.push(frame)?;
        self.reel = Some(reel);
        Ok(())
    }

    fn output(&self) -> io::Result<Box<dyn Write + Send>> {
        Ok(match &self.file {
            // Planes are large; there is nothing to gather.
            Some(file) => Box::new(file.reopen()?),
            None => Box::new(io::stdout()),
        })
    }
}

impl Film for Raw {
    fn push(&mut self, frame: &RgbImage) -> Outcome {
        match self.add(frame) {
            Err(error) if self.file.is_none() && error.kind() == ErrorKind::BrokenPipe => self.abandoned = true,
            added => added.map_err(|error| cannot_write(&self.path, error))?,
        }
        Ok(())
    }

    /// Its reader may have gone away, which is no error.
    fn is_abandoned(&self) -> bool {
        self.abandoned
    }

    fn finish(self: Box<Self>) -> Outcome {
        if self.abandoned {
            return Ok(());
        }
        if self.reel.is_none() {
            return Err(no_frames(&self.path));
        }
        match self.file {
            Some(file) => file.complete(),
            None => io::stdout().flush().map_err(|error| cannot_write(&self.path, error)),
        }
    }
}
