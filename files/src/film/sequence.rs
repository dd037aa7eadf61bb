//! A numbered sequence of pictures.

use super::Film;
use super::common::{cannot_write, no_frames, write_png};
use super::pattern::Pattern;
use crate::outcome::Outcome;
use crate::whole::{Series, folder_of, publish};
use image::RgbImage;
use std::path::PathBuf;

/// A sequence in the making.
#[derive(Debug)]
pub(super) struct Sequence {
    pub(super) path: PathBuf,
    pub(super) pattern: Pattern,
    pub(super) series: Series,
}

impl Film for Sequence {
    fn push(&mut self, frame: &RgbImage) -> Outcome {
        let path = folder_of(&self.path).join(self.pattern.name(self.series.len()));
        let file = self.series.next(path).map_err(|error| cannot_write(&self.path, error))?;
        write_png(frame, file).map_err(|error| cannot_write(&self.path, error))
    }

    fn finish(self: Box<Self>) -> Outcome {
        match self.series.len() {
            0 => Err(no_frames(&self.path)),
            _ => publish(&self.series.close()?),
        }
    }
}
