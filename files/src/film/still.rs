//! A single picture.

use super::Film;
use super::common::{cannot_write, no_frames, write_png};
use crate::outcome::Outcome;
use crate::whole::WholeFile;
use image::RgbImage;

/// A picture in the making.
#[derive(Debug)]
pub(super) struct Still {
    pub(super) file: WholeFile,
    pub(super) last: Option<RgbImage>,
}

impl Film for Still {
    fn push(&mut self, frame: &RgbImage) -> Outcome {
        self.last = Some(frame.clone());
        Ok(())
    }

    fn finish(self: Box<Self>) -> Outcome {
        let Some(frame) = self.last else { return Err(no_frames(self.file.path())) };
        let written = self.file.reopen().map_err(Into::into).and_then(|file| write_png(&frame, file));
        written.map_err(|error| cannot_write(self.file.path(), error))?;
        self.file.complete()
    }

    fn keeps_only_last(&self) -> bool {
        true
    }
}
